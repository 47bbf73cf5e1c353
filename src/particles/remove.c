/* Particles that are taken out leave inert slots until the next sort closes the gaps. */
#include "particles/particles.h"

/* Marks the particles by the complement of their ids, which is negative. So an id that is given twice is
 * not found the second time. Returns how many were marked before the first bad one. */
static int64_t mark(const mpm_particles *set, int64_t n, const int64_t *ids, int64_t *id) {
  for (int64_t i = 0; i < n; ++i) {
    int64_t slot = mpmi_index_find(set, ids[i]);
    if (slot < 0 || id[slot] < 0) return i;
    id[slot] = ~id[slot];
  }
  return n;
}

mpm_status mpm_particles_remove(mpm_particles *particles, int64_t n, const int64_t *ids) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  mpm_context *context = particles->context;
  mpm_status status = mpmi_particles_changeable(particles);
  if (status) return status;
  if (n < 0) return mpmi_fail(context, MPM_E_ARG, "n is %lld, must be >= 0", (long long)n);
  if (n == 0) return MPM_OK;
  if (!ids) return mpmi_fail(context, MPM_E_ARG, "ids is NULL");
  status = mpmi_index_build(particles);
  if (status) return status;
  int64_t *id = mpmi_i64(particles, MPMI_ID, 0);
  int64_t marked = mark(particles, n, ids, id);
  for (int64_t i = 0; i < marked; ++i) {
    int64_t slot = mpmi_index_find(particles, ids[i]);
    if (marked == n)
      mpmi_make_holes(particles, slot, slot + 1);
    else
      id[slot] = ~id[slot];
  }
  if (marked < n) {
    int32_t twice = mpmi_index_find(particles, ids[marked]) >= 0;
    return mpmi_fail(context, twice ? MPM_E_ARG : MPM_E_NOT_FOUND,
                     twice ? "id %lld is given twice" : "the set has no particle with id %lld",
                     (long long)ids[marked]);
  }
  particles->count -= n;
  particles->dirty |= MPMI_DIRTY_SUMS;
  /* what is left of a cluster goes behind the others in the next sort, which must come before the next step:
   * results are not to depend on when something else gives reason to sort */
  if (mpmi_is_total_lagrangian(particles->grid)) particles->dirty |= MPMI_DIRTY_PLACE;
  mpmi_index_drop(particles);
  return MPM_OK;
}
