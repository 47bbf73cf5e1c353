#include "particles/thermal.h"
#include "particles/builtin_fields.h"

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
