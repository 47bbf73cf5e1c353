/* The present state of particles becomes the one that their deformation starts from. */
#include "particles/reference.h"
#include "particles/thermal.h"

#include <math.h>
#include <string.h>

#include "material/pull_back.h"
#include "particles/builtin_fields.h"
#include "particles/law_batch.h"
#include "particles/values.h"

/* ---- for all who set a reference ----------------------------------------------------------------------- */
void mpmi_reference_begin(mpm_particles *set) {
  for (int32_t c = 0; c < set->field[MPMI_F].components; ++c) {
    const double value = mpmi_unstored_value(MPMI_F, mpmi_tensor_map(set->grid->dim)[c]);
    for (int64_t s = 0; s < set->slots; ++s) mpmi_f64(set, MPMI_F, 1)[c * set->ld + s] = value;
  }
  /* sheets stay as thin as they are, and the initial volume that of unit thickness */
  if (mpmi_is_plane_stress(set->grid) && set->slots)
    memcpy(mpmi_f64(set, MPMI_F, 1) + 4 * set->ld, mpmi_f64(set, MPMI_F, 0) + 4 * set->ld,
           (size_t)set->slots * sizeof(double));
}

/* Refuses what the law of the host made of the stress that it was shown. */
static mpm_status compare(const mpm_particles *set, const mpmi_law_batch *b) {
  const int32_t rows = mpmi_stress_components(set->grid->dim);
  for (int64_t p = 0; p < b->batch.n; ++p) {
    double largest = 0.0, unlike = 0.0;
    for (int32_t c = 0; c < rows && b->batch.id[p] >= 0; ++c) {
      const double given = b->stress[c * b->ld + p], kept = b->stress_new[c * b->ld + p];
      largest = fmax(largest, fabs(given));
      unlike += fabs(kept - given);
    }
    if (!(unlike <= 1e-9 * largest))
      return mpmi_fail(
          set->context, MPM_E_UNSUPPORTED,
          "asked with F = I and dt = 0, the law of the host does not answer with the stress that "
          "the particle with id %lld is given: its stress is not its state; set what it follows "
          "from",
          (long long)b->batch.id[p]);
  }
  return MPM_OK;
}

static mpm_status ask_host(mpm_particles *set, mpmi_law_batch *b, int64_t begin, int64_t n) {
  mpmi_law_batch_load(b, set, begin, n, set->stepper ? set->owner->time(set->stepper) : 0.0, 0.0);
  for (int32_t c = 0; c < mpmi_stress_components(set->grid->dim); ++c)
    memcpy(b->stress + c * b->ld, mpmi_f64(set, MPMI_STRESS, 1) + c * set->ld + begin,
           (size_t)n * sizeof(double));
  for (int32_t e = 0; e < 9 && mpmi_expands(set); e += 4)
    for (int64_t p = 0; p < n; ++p) b->F[e * b->ld + p] = 1.0;
  if (mpmi_expands(set)) mpmi_expand_state(b, set, begin, n);
  const mpm_status status = mpmi_law_batch_run_in(b, set);
  if (b->fault.cause)
    return mpmi_fail(set->context, b->fault.cause, "%s at particle %lld, when asked with F = I",
                     b->fault.what, (long long)b->fault.particle);
  if (status)
    return mpmi_fail(set->context, MPM_E_CALLBACK, "the material returned %d when asked with F = I",
                     (int)status);
  return compare(set, b);
}

mpm_status mpmi_reference_fits_host(mpm_particles *set) {
  if (set->material->law || !set->slots) return MPM_OK;
  const size_t bytes = mpmi_law_batch_bytes(set->material);
  void *memory = mpmi_alloc(set->context, bytes);
  if (!memory) return MPM_E_NOMEM;
  mpmi_law_batch b;
  mpmi_law_batch_bind(&b, set->material, memory);
  mpm_status status = MPM_OK;
  for (int64_t s = 0; s < set->slots && !status; s += b.ld)
    status = ask_host(set, &b, s, set->slots - s < b.ld ? set->slots - s : b.ld);
  mpmi_free(set->context, memory, bytes);
  return status;
}

/* Where F stretches domains, or sections of rings, their edges are divided by as much as it stretches them
 * more. */
static void keep_domains(mpm_particles *set) {
  if (set->grid->domains != MPMI_DOMAINS_STRETCHED && !mpmi_is_axisymmetric(set->grid)) return;
  for (int32_t k = 0; k < set->grid->dim; ++k) {
    const int32_t stored = mpmi_stored_component(set, MPMI_F, 4 * k);
    double *size = mpmi_f64(set, MPMI_SIZE, 0) + k * set->ld;
    const double *before = mpmi_f64(set, MPMI_F, 0) + stored * set->ld;
    const double *after = mpmi_f64(set, MPMI_F, 1) + stored * set->ld;
    for (int64_t s = 0; s < set->slots; ++s) size[s] *= fabs(before[s] / after[s]);
  }
}

void mpmi_reference_take(mpm_particles *set) {
  const size_t row = (size_t)set->slots * sizeof(double);
  double *initial = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0);
  if (!set->slots) return;
  keep_domains(set);
  memcpy(initial, mpmi_f64(set, MPMI_VOLUME, 0), row);
  for (int32_t c = 0; c < set->field[MPMI_F].components; ++c) {
    const double *F = mpmi_f64(set, MPMI_F, 1) + c * set->ld;
    const int32_t entry = mpmi_tensor_map(set->grid->dim)[c];
    for (int64_t s = 0; s < set->slots && entry % 4 == 0; ++s) initial[s] /= F[s]; /* F is diagonal */
    memcpy(mpmi_f64(set, MPMI_F, 0) + c * set->ld, F, row);
  }
  for (int64_t s = 0; s < set->slots && set->field[MPMI_DILATION_RATIO].present; ++s)
    mpmi_f64(set, MPMI_DILATION_RATIO, 0)[s] = 1.0;
  mpmi_field_written(set, MPMI_F);
}

/* ---- total Lagrangian grids ---------------------------------------------------------------------------- */
/* Refuses positions that have no place in the grid, and surfaces, which would stay where the body was. */
static mpm_status check_places(const mpm_particles *set) {
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  mpm_status status = MPM_OK;
  if (mpmi_is_total_lagrangian(set->grid) && set->stepper && set->owner->has_markers(set->stepper))
    return mpmi_fail(set->context, MPM_E_STATE,
                     "the stepper has surfaces, whose markers keep to the reference as it was, and "
                     "total_lagrangian is 1: take them out, and put new markers in after");
  for (int64_t s = 0; s < set->slots && !status && mpmi_is_total_lagrangian(set->grid); ++s)
    if (id[s] >= 0)
      status = mpmi_check_value(set, MPMI_REFERENCE, mpmi_f64(set, MPMI_POSITION, 0) + s, set->ld,
                                (mpmi_who){"id", id[s]});
  return status;
}

/* Turns the matrices of transfers, which are over reference positions, into those over the present ones. */
static void turn_gradients(mpm_particles *set) {
  const int32_t dim = set->grid->dim, rows = mpmi_gradient_components(dim);
  double *L = mpmi_f64(set, MPMI_L, 0), buffer[9 * MPMI_CHUNK];
  for (int64_t s = 0; s < set->slots && set->field[MPMI_L].present; s += MPMI_CHUNK) {
    const double *F[9] = {NULL};
    mpmi_point_at(set, MPMI_F, 0, s, F);
    for (int32_t c = 0; c < rows; ++c)
      memcpy(buffer + mpmi_gradient_map(dim)[c] * MPMI_CHUNK, L + c * set->ld + s, MPMI_CHUNK * sizeof *L);
    mpmi_pull_back_of(set->context->isa)->spatial[dim](F, MPMI_CHUNK, buffer, MPMI_CHUNK);
    for (int32_t c = 0; c < rows; ++c)
      memcpy(L + c * set->ld + s, buffer + mpmi_gradient_map(dim)[c] * MPMI_CHUNK, MPMI_CHUNK * sizeof *L);
  }
}

/* Begins displacements anew. On a total Lagrangian grid particles are then where they were not before. */
static void take_places(mpm_particles *set) {
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  for (int32_t k = 0; k < set->grid->dim && set->field[MPMI_REFERENCE].present; ++k)
    for (int64_t s = 0; s < set->slots; ++s)
      mpmi_f64(set, MPMI_REFERENCE, 0)[k * set->ld + s] = mpmi_absent_value(set, MPMI_REFERENCE, k, s);
  if (!mpmi_is_total_lagrangian(set->grid)) return;
  for (int64_t s = 0; s < set->slots; ++s) {
    if (id[s] >= 0) mpmi_wrap_slot(set, MPMI_REFERENCE, s);
    for (int32_t k = 0; k < set->grid->dim; ++k)
      mpmi_f64(set, MPMI_POSITION, 0)[k * set->ld + s] = mpmi_f64(set, MPMI_REFERENCE, 0)[k * set->ld + s];
  }
  set->dirty |= MPMI_DIRTY_PLACE;
}

/* ---- the call ------------------------------------------------------------------------------------------ */
static mpm_status can_reset(const mpm_particles *set) {
  const mpmi_law *law = set->material->law;
  if (!law || (!law->stress_from_F && law->rest == MPMI_REST_BY_KIND)) return MPM_OK;
  return mpmi_fail(set->context, MPM_E_UNSUPPORTED,
                   "what %s does follows from deformation_gradient, which must stay as it is: to begin "
                   "displacements anew, set reference_position",
                   law->name);
}

mpm_status mpm_particles_reset_reference(mpm_particles *particles) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  mpm_status status = mpmi_particles_changeable(particles);
  if (!status) status = can_reset(particles);
  if (!status) status = mpmi_particles_check_suspects(particles);
  if (!status) status = mpmi_particles_refresh(particles);
  if (!status) status = check_places(particles);
  if (status || !particles->slots) return status;
  mpmi_reference_begin(particles);
  for (int32_t c = 0; c < mpmi_stress_components(particles->grid->dim); ++c)
    memcpy(mpmi_f64(particles, MPMI_STRESS, 1) + c * particles->ld,
           mpmi_f64(particles, MPMI_STRESS, 0) + c * particles->ld,
           (size_t)particles->slots * sizeof(double));
  if ((status = mpmi_reference_fits_host(particles))) return status;
  if (mpmi_is_total_lagrangian(particles->grid)) turn_gradients(particles);
  mpmi_reference_take(particles);
  take_places(particles);
  return MPM_OK;
}
