/* New velocity and position of particles from what was gathered. */
#include "simd/chunk.h"
#include "simd/rounding.h"
#include "transfer/move.h"

/*   FLIP/PIC blend  v = a (v_p + sum w dv) + (1 - a) sum w v     MPoint theory eq. 36
 *   affine, PIC     v = sum w v
 *   XPIC            v = sum w v + correction                     stages/xpic.c
 *   position        x = x_p + dt sum w v                         Guilkey eq. 10, Steffen et al. 2008 eq. 10
 *   second order    x = x_p + dt sum w (v - dv / 2)              MPoint theory eq. 37, its misprint mended
 */
MPMI_INLINE uint32_t move(int32_t dim, const mpmi_move *job, int64_t n) {
  const double dt = job->dt, flip = job->flip, pic = 1.0 - flip;
  mpmi_lanes bad = {0.0};
  mpmi_mask outside = {0}, left = {0};
  for (int32_t k = 0; k < dim; ++k) {
    const double low = job->low[k], high = job->high[k], centre = job->centre[k], half = job->half[k];
    const double period = job->period[k], inverse = job->inverse_period[k];
    const double *v_bar = job->v_bar + k * job->ld, *dv = job->dv + k * job->ld;
    for (int64_t s = 0; s < mpmi_whole_chunks(n); s += MPMI_LANES) {
      const mpmi_lanes mean = mpmi_lanes_load(v_bar + s);
      mpmi_lanes v = mean;
      if (job->rule == MPMI_MOVE_BLEND)
        v = flip * (mpmi_lanes_load(job->v_old[k] + s) + mpmi_lanes_load(dv + s)) + pic * mean;
      if (job->rule == MPMI_MOVE_CORRECT) v = mean + mpmi_lanes_load(job->v_new[k] + s);
      mpmi_lanes path = mean;
      if (job->lag > 0.0) path -= job->lag * mpmi_lanes_load(dv + s);
      const mpmi_lanes x = mpmi_lanes_load(job->x_old[k] + s) + dt * path;
      mpmi_lanes_store(job->v_new[k] + s, v);
      mpmi_lanes_store(job->x_new[k] + s, x);
      mpmi_lanes away = x - centre;
      away -= period * mpmi_lanes_round(away * inverse);
      bad += (v - v) + (x - x);
      outside |= (x < low) | (x > high);
      left |= mpmi_lanes_abs(away) > half;
    }
  }
  return (mpmi_lanes_sum(bad) == 0.0 ? 0u : (uint32_t)MPMI_NONFINITE) |
         mpmi_lanes_any(outside, MPMI_OUTSIDE) | mpmi_lanes_any(left, MPMI_LEFT_TILE);
}

#define MOVE(dim)                                                                                            \
  uint32_t KERNEL(move_##dim)(const mpmi_move *job, int64_t n);                                              \
  uint32_t KERNEL(move_##dim)(const mpmi_move *job, int64_t n) {                                             \
    return move(dim, job, n);                                                                                \
  }
MOVE(1)
MOVE(2)
MOVE(3)
