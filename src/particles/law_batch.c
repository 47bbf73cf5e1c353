#include "particles/law_batch.h"

#include <math.h>
#include <string.h>

#include "material/dilation.h"
#include "particles/thermal.h"
#include "simd/elementary.h"

enum { FIXED_ROWS = 9 + 9 + 9 + 6 + 6 + 1 + 1 + 1 + 1 + 3 };

int64_t mpmi_law_batch_length(const mpm_material *material) {
  return material->law ? MPMI_BATCH_OWN : MPMI_BATCH_HOST;
}

size_t mpmi_law_batch_bytes(const mpm_material *material) {
  const int64_t rows = FIXED_ROWS + 2 * material->state_count;
  return mpmi_bytes(rows * mpmi_law_batch_length(material), sizeof(double));
}

/* Presets what a law need not fill: no viscosity, energy unknown. */
static void preset_optional(mpmi_law_batch *b, int64_t n) {
  for (int64_t p = 0; p < n; ++p) {
    b->viscosity[p] = 0.0;
    b->energy[p] = (double)NAN;
  }
}

void mpmi_law_batch_bind(mpmi_law_batch *b, const mpm_material *material, void *memory) {
  const int64_t ld = mpmi_law_batch_length(material);
  double *at = memory;
  b->ld = ld;
  b->fault = (mpmi_law_fault){MPM_OK, -1, ""};
  b->stored = b->squares = 0;
  b->F = at, at += 9 * ld;
  b->F_inc = at, at += 9 * ld;
  b->L = at, at += 9 * ld;
  b->stress = at, at += 6 * ld;
  b->stress_new = at, at += 6 * ld;
  b->wave_speed = at, at += ld;
  b->viscosity = at, at += ld;
  b->energy = at, at += ld;
  b->growth = at, at += ld;
  b->position = at, at += 3 * ld;
  b->state = at, at += material->state_count * ld;
  b->state_new = at;
  memset(b->F, 0, (size_t)(b->wave_speed - b->F) * sizeof(double));
  for (int32_t e = 0; e < 9; e += 4)
    for (int64_t p = 0; p < ld; ++p) b->F[e * ld + p] = b->F_inc[e * ld + p] = 1.0;
  memset(b->wave_speed, 0, (size_t)ld * sizeof(double));
  preset_optional(b, ld);
  b->batch = (mpm_material_batch){.struct_size = sizeof b->batch,
                                  .state_count = material->state_count,
                                  .ld = ld,
                                  .F = b->F,
                                  .F_inc = b->F_inc,
                                  .L = b->L,
                                  .stress = b->stress,
                                  .state = b->state,
                                  .stress_new = b->stress_new,
                                  .state_new = b->state_new,
                                  .wave_speed = b->wave_speed,
                                  .kinematic_viscosity = b->viscosity,
                                  .energy = b->energy,
                                  .position = b->position,
                                  .lookup = &b->lookup};
}

static void copy_batch_rows(double *to, int64_t to_ld, const double *from, int64_t from_ld, int32_t rows,
                            int64_t n) {
  for (int32_t r = 0; r < rows; ++r) memcpy(to + r * to_ld, from + r * from_ld, (size_t)n * sizeof(double));
}

void mpmi_law_batch_load(mpmi_law_batch *b, const mpm_particles *set, int64_t begin, int64_t n, double t,
                         double dt) {
  const int32_t dim = set->grid->dim;
  const mpm_material *material = set->material;
  b->lookup = (mpmi_lookup){set, begin};
  b->batch.n = n;
  b->batch.t = t;
  b->batch.dt = dt;
  b->batch.id = mpmi_i64(set, MPMI_ID, 0) + begin;
  /* With dt = 0 the law is asked for the state as it is, whose stress may be viscous. */
  if (!mpmi_material_stress_from_F(material) || dt == 0.0)
    copy_batch_rows(b->stress, b->ld, mpmi_f64(set, MPMI_STRESS, 0) + begin, set->ld,
                    mpmi_stress_components(dim), n);
  if (material->state_count)
    copy_batch_rows(b->state, b->ld, mpmi_f64(set, MPMI_STATE, 0) + begin, set->ld, material->state_count, n);
  if (!material->law)
    copy_batch_rows(b->position, b->ld, mpmi_f64(set, MPMI_POSITION, 0) + begin, set->ld, dim, n);
}

/* Expansion: the law sees F / exp(a (T - T0)) in the place of F. */
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

void mpmi_law_batch_load_F(mpmi_law_batch *b, const mpm_particles *set, int64_t begin, int64_t n) {
  const int32_t dim = set->grid->dim, *map = mpmi_tensor_map(dim);
  const double *F = mpmi_f64(set, MPMI_F, 0) + begin;
  for (int32_t c = 0; c < mpmi_tensor_components(dim); ++c)
    memcpy(b->F + map[c] * b->ld, F + c * set->ld, (size_t)n * sizeof(double));
  if (set->field[MPMI_DILATION_RATIO].present)
    mpmi_dilation_of(set->context->isa)
        ->scale[mpmi_strain_dim(set->grid)](b->F, b->ld, mpmi_f64(set, MPMI_DILATION_RATIO, 0) + begin, n);
  if (mpmi_expands(set)) mpmi_expand_state(b, set, begin, n);
}

/* A negative speed or viscosity would not bound the step, and an infinite energy would spoil all sums. What
 * is not finite beyond that is found with the stress. */
static void look(mpmi_law_batch *b, int64_t p) {
  mpmi_law_fault *fault = &b->fault;
  if (fault->cause) return;
  fault->particle = b->batch.id[p];
  if (b->wave_speed[p] < 0.0)
    fault->cause = MPM_E_CALLBACK, fault->what = "the material's wave speed is negative";
  else if (b->viscosity[p] < 0.0)
    fault->cause = MPM_E_CALLBACK, fault->what = "the material's kinematic viscosity is negative";
  else if (isinf(b->energy[p]))
    fault->cause = MPM_NONFINITE, fault->what = "the material's energy is infinite";
}

/* A built-in law refuses particles by what it gives for the squares of their wave speeds; inert slots are
 * none of its concern. Other negative squares are those of states without waves, and found with the stress.
 */
static mpm_status find_refused(mpmi_law_batch *b, const mpmi_law *law) {
  for (int64_t p = 0; law->refusal_count && p < b->batch.n; ++p) {
    if (!(b->wave_speed[p] < 0.0)) continue;
    const double refused = -1.0 - b->wave_speed[p];
    if (b->batch.id[p] < 0) {
      b->wave_speed[p] = 0.0;
    } else if (!b->fault.cause && refused >= 0.0 && refused < law->refusal_count) {
      const mpmi_law_refusal *refusal = &law->refusal[(int32_t)refused];
      b->fault = (mpmi_law_fault){refusal->cause, b->batch.id[p], refusal->what};
    }
  }
  return b->fault.cause;
}

/* A built-in law gives the squares of wave speeds; the root of a negative one is no number. */
static void take_roots(mpmi_law_batch *b) {
  for (int64_t p = 0; p < b->batch.n; ++p) b->wave_speed[p] = sqrt(b->wave_speed[p]);
}

mpm_status mpmi_law_batch_run(mpmi_law_batch *b, const mpm_material *material, int32_t dim) {
  b->fault.cause = MPM_OK;
  if (!material->law) preset_optional(b, b->batch.n);
  mpm_status status = MPM_OK;
  if (b->stored && dim == 2)
    mpmi_material_evaluate_stored(material, &b->batch);
  else
    status = mpmi_material_evaluate(material, dim, &b->batch);
  if (status) return status;
  if (material->law) {
    if (find_refused(b, material->law)) return b->fault.cause;
    if (!b->squares) take_roots(b);
    return MPM_OK;
  }
  /* Whatever the host made of inert slots must not get into sums. */
  for (int64_t p = 0; p < b->batch.n; ++p) {
    if (b->batch.id[p] >= 0) {
      look(b, p);
      continue;
    }
    for (int32_t c = 0; c < 6; ++c) b->stress_new[c * b->ld + p] = 0.0;
    for (int32_t c = 0; c < material->state_count; ++c) b->state_new[c * b->ld + p] = b->state[c * b->ld + p];
    b->wave_speed[p] = b->viscosity[p] = 0.0;
  }
  return b->fault.cause;
}

void mpmi_law_batch_store(const mpmi_law_batch *b, mpm_particles *set, int32_t copy, int64_t begin,
                          int64_t n) {
  copy_batch_rows(mpmi_f64(set, MPMI_STRESS, copy) + begin, set->ld, b->stress_new, b->ld,
                  mpmi_stress_components(set->grid->dim), n);
  if (set->material->state_count)
    copy_batch_rows(mpmi_f64(set, MPMI_STATE, copy) + begin, set->ld, b->state_new, b->ld,
                    set->material->state_count, n);
}

void mpmi_law_batch_recall(mpmi_law_batch *b, const mpm_particles *set, int32_t copy, int64_t begin,
                           int64_t n) {
  copy_batch_rows(b->stress_new, b->ld, mpmi_f64(set, MPMI_STRESS, copy) + begin, set->ld,
                  mpmi_stress_components(set->grid->dim), n);
}

mpm_status mpm_batch_field(const void *lookup, const char *field, const void **data,
                           int64_t *component_stride) {
  if (!lookup || !field || !data || !component_stride) return MPM_E_ARG;
  const mpmi_lookup *at = lookup;
  const int32_t f = mpmi_find_field(at->set, field);
  if (f < 0) return MPM_E_NOT_FOUND;
  if (!at->set->field[f].present) return MPM_E_STATE;
  *data =
      (const char *)at->set->field[f].data[0] + (size_t)at->begin * mpmi_type_size(at->set->field[f].type);
  *component_stride = at->set->ld;
  return MPM_OK;
}
