/* New velocity and position of a batch whose gathered velocities lie in rows. */
#include "simd/chunk.h"
#include "transfer/move.h"

MPMI_INLINE uint32_t move(int32_t dim, const mpmi_move *job, int64_t n) {
  mpmi_moved moved = mpmi_nothing_moved();
  for (int64_t s = 0; s < mpmi_whole_chunks(n); s += MPMI_LANES) {
    mpmi_lanes v_bar[3], dv[3];
    for (int32_t k = 0; k < dim; ++k) {
      v_bar[k] = mpmi_lanes_load(job->v_bar + k * job->ld + s);
      dv[k] = mpmi_lanes_load(job->dv + k * job->ld + s);
    }
    mpmi_move_lanes(dim, job, s, v_bar, dv, &moved);
  }
  return mpmi_move_flags(&moved);
}

/* Looks where particles have come that have moved. */
MPMI_INLINE uint32_t look(int32_t dim, const mpmi_move *job, int64_t n) {
  mpmi_moved moved = mpmi_nothing_moved();
  for (int64_t s = 0; s < mpmi_whole_chunks(n); s += MPMI_LANES)
    for (int32_t k = 0; k < dim; ++k) mpmi_look_where(job, k, mpmi_lanes_load(job->x_new[k] + s), &moved);
  return mpmi_move_flags(&moved);
}

#define MOVE(dim)                                                                                            \
  uint32_t KERNEL(move_##dim)(const mpmi_move *job, int64_t n);                                              \
  uint32_t KERNEL(move_##dim)(const mpmi_move *job, int64_t n) {                                             \
    return move(dim, job, n);                                                                                \
  }                                                                                                          \
  uint32_t KERNEL(look_##dim)(const mpmi_move *job, int64_t n);                                              \
  uint32_t KERNEL(look_##dim)(const mpmi_move *job, int64_t n) {                                             \
    return look(dim, job, n);                                                                                \
  }
MOVE(1)
MOVE(2)
MOVE(3)
