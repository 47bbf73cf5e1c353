/* Volume and stress are brought up to date after the host has set F or the initial volume. */
#include "material/deformation.h"
#include "particles/law_batch.h"

#include <string.h>

void mpmi_particles_make_volumes(mpm_particles *set, int32_t copy) {
  const double *F[9];
  if (!set->slots) return;
  mpmi_point_at(set, MPMI_F, copy, 0, F);
  mpmi_deformation_of(set->context->isa)
      ->volume[set->grid->dim](F, mpmi_f64(set, MPMI_INITIAL_VOLUME, 0), mpmi_f64(set, MPMI_VOLUME, 0),
                               set->slots);
}

/* The law is asked for the state as it is: F_inc = I, dt = 0. Stresses go to the second copy first, so
 * that nothing changes when the law refuses. */
mpm_status mpmi_particles_refresh(mpm_particles *set) {
  if (!set->slots) set->dirty &= ~(uint32_t)MPMI_DIRTY_STRESS;
  if (!(set->dirty & MPMI_DIRTY_STRESS)) return MPM_OK;
  const int32_t dim = set->grid->dim;
  const size_t bytes = mpmi_law_batch_bytes(set->material);
  void *memory = mpmi_alloc(set->context, bytes);
  if (!memory) return MPM_E_NOMEM;
  mpmi_law_batch b;
  mpmi_law_batch_bind(&b, set->material, memory);
  mpm_status status = MPM_OK;
  const double t = set->stepper ? set->owner->time(set->stepper) : 0.0;
  const int32_t sheets = mpmi_is_plane_stress(set->grid);
  const int32_t keeps_stress = set->material->law && !mpmi_material_stress_from_F(set->material) &&
                               !mpmi_material_mean_from_F(set->material);
  for (int64_t s = 0; s < set->slots && !keeps_stress && !status; s += b.ld) {
    const int64_t n = set->slots - s < b.ld ? set->slots - s : b.ld;
    mpmi_law_batch_load(&b, set, s, n, t, 0.0);
    mpmi_law_batch_load_F(&b, set, s, n);
    status = mpmi_law_batch_run_in(&b, set);
    if (!status) mpmi_law_batch_store(&b, set, 1, s, n);
    if (!status && sheets)
      memcpy(mpmi_f64(set, MPMI_F, 1) + 4 * set->ld + s, b.F + 8 * b.ld, (size_t)n * sizeof(double));
  }
  mpmi_free(set->context, memory, bytes);
  if (b.fault.cause)
    return mpmi_fail(set->context, b.fault.cause,
                     "%s at particle %lld, when asked for the stress of the given F", b.fault.what,
                     (long long)b.fault.particle);
  if (status)
    return mpmi_fail(set->context, MPM_E_CALLBACK,
                     "the material returned %d when asked for the stress of the given F", (int)status);
  /* The stress is copied and not swapped, because a view of it may be out. */
  if (!keeps_stress && sheets)
    memcpy(mpmi_f64(set, MPMI_F, 0) + 4 * set->ld, mpmi_f64(set, MPMI_F, 1) + 4 * set->ld,
           (size_t)set->slots * sizeof(double));
  if (!keeps_stress)
    for (int32_t c = 0; c < mpmi_stress_components(dim); ++c)
      memcpy(mpmi_f64(set, MPMI_STRESS, 0) + c * set->ld, mpmi_f64(set, MPMI_STRESS, 1) + c * set->ld,
             (size_t)set->slots * sizeof(double));
  mpmi_particles_make_volumes(set, 0);
  set->dirty &= ~(uint32_t)MPMI_DIRTY_STRESS;
  return MPM_OK;
}
