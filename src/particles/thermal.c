#include "particles/thermal.h"
#include "particles/builtin_fields.h"
#include "simd/elementary.h"

#include <string.h>

/* ---- fields -------------------------------------------------------------------------------------------- */
/* Finds a field by name, or adds it with the reference temperature in every particle. */
static mpm_status make_field(mpm_particles *set, const char *name, double reference, int32_t *field) {
  *field = mpmi_find_field(set, name);
  if (*field >= 0 && set->field[*field].type == MPM_F64 && set->field[*field].components == 1) return MPM_OK;
  if (*field >= 0)
    return mpmi_fail(
        set->context, MPM_E_ARG,
        "the set has a field \"%s\" that is not of type MPM_F64 with one component: heat needs the "
        "name",
        name);
  if (set->field_count == MPMI_MAX_FIELDS)
    return mpmi_fail(set->context, MPM_E_STATE, "the set has %d fields: there is no room for \"%s\"",
                     (int)MPMI_MAX_FIELDS, name);
  mpmi_field *at = &set->field[set->field_count];
  memset(at, 0, sizeof *at);
  memcpy(at->name, name, strlen(name) + 1);
  at->type = MPM_F64;
  at->components = at->full_components = at->writable = 1;
  const mpm_status status = mpmi_field_make_present(set, set->field_count);
  if (status) return status;
  *field = set->field_count++;
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  for (int64_t slot = 0; slot < set->slots; ++slot)
    if (id[slot] >= 0) mpmi_f64(set, *field, 0)[slot] = reference;
  return MPM_OK;
}

/* The law is asked anew for what follows from F. */
static void change(mpm_particles *set, double expansion, double reference) {
  mpmi_thermal *of = &set->thermal;
  if (expansion == of->expansion && (expansion == 0.0 || reference == of->reference)) {
    of->reference = reference;
    return;
  }
  of->expansion = expansion;
  of->reference = reference;
  set->dirty |= MPMI_DIRTY_STRESS | MPMI_DIRTY_SUMS;
}

mpm_status mpmi_thermal_make(mpm_particles *set, double expansion, double reference) {
  const int32_t had = set->field_count;
  mpmi_thermal *of = &set->thermal;
  int32_t temperature, stress_temperature = of->stress_temperature;
  mpm_status status = make_field(set, "temperature", reference, &temperature);
  if (!status && expansion != 0.0)
    status = make_field(set, "stress_temperature", reference, &stress_temperature);
  if (status) {
    while (set->field_count > had) mpmi_field_make_absent(set, --set->field_count);
    return status;
  }
  of->temperature = temperature;
  of->stress_temperature = stress_temperature;
  set->field[temperature].extensive = 0;
  if (stress_temperature) set->field[stress_temperature].extensive = 0;
  change(set, expansion, reference);
  return MPM_OK;
}

void mpmi_thermal_drop(mpm_particles *set) {
  change(set, 0.0, 0.0);
  set->thermal.temperature = 0;
}

void mpmi_thermal_start(mpm_particles *set, int64_t begin, int64_t end) {
  const mpmi_thermal *of = &set->thermal;
  for (int64_t slot = begin; slot < end && of->temperature; ++slot) {
    mpmi_f64(set, of->temperature, 0)[slot] = of->reference;
    if (of->stress_temperature) mpmi_f64(set, of->stress_temperature, 0)[slot] = of->reference;
  }
}

/* ---- expansion ----------------------------------------------------------------------------------------- */
void mpmi_expand_lane(mpmi_law_batch *b, const mpm_particles *set, int64_t p, double T) {
  const double strain = set->thermal.expansion * (T - set->thermal.reference), shrink = mpmi_exp(-strain);
  for (int32_t e = 0; e < 9; ++e) {
    double *F = b->F + e * b->ld + p;
    /* along axes that a 1-D grid does not have there is no entry of its own */
    *F = set->grid->dim == 1 && e % 4 == 0 && e > 0 ? shrink : *F * shrink;
  }
  b->growth[p] = mpmi_exp(3.0 * strain);
}

void mpmi_expand_state(mpmi_law_batch *b, const mpm_particles *set, int64_t begin, int64_t n) {
  const double *T = mpmi_stress_temperature(set, 0) + begin;
  for (int64_t p = 0; p < n; ++p) mpmi_expand_lane(b, set, p, T[p]);
}

void mpmi_expand_step(mpmi_law_batch *b, const mpm_particles *set, int64_t begin, int64_t n, double dt,
                      int32_t has_increments) {
  const double *before = mpmi_stress_temperature(set, 0) + begin,
               *now = mpmi_stress_temperature(set, 1) + begin;
  const int32_t dim = mpmi_strain_dim(set->grid);
  for (int64_t p = 0; p < n; ++p) {
    const double change = mpmi_expm1(-set->thermal.expansion * (now[p] - before[p]));
    mpmi_expand_lane(b, set, p, now[p]);
    for (int32_t e = 0; e < 9; ++e) {
      /* axes that the grid does not have keep what the batch before left there */
      const int32_t own = e / 3 < dim && e % 3 < dim;
      const double unit = e % 4 ? 0.0 : 1.0, L = own ? b->L[e * b->ld + p] : 0.0;
      b->L[e * b->ld + p] = L + change * L + unit * change / dt;
      if (!has_increments) continue;
      const double F_inc = own ? b->F_inc[e * b->ld + p] : unit;
      b->F_inc[e * b->ld + p] = F_inc + change * F_inc;
    }
  }
}
