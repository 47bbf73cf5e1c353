/* New velocity and position of particles from what was gathered, as many at a time as a register holds.
 *
 *   FLIP/PIC blend  v = a (v_p + sum w dv) + (1 - a) sum w v     MPoint theory eq. 36
 *   affine, PIC     v = sum w v
 *   XPIC, FMPM      v = sum w v + correction                     stages/xpic.c
 *   position        x = x_p + dt sum w v                         Guilkey eq. 10, Steffen et al. 2008 eq. 10
 *   second order    x = x_p + dt sum w (v - dv / 2)              MPoint theory eq. 37, its misprint mended
 *
 * With projected positions this is done in two passes: the first leaves out dt sum w v, the second adds it.
 */
#ifndef MPMI_MOVE_H
#define MPMI_MOVE_H

#include "simd/flags.h"
#include "simd/rounding.h"

/* How a particle's velocity follows from what was gathered. */
enum {
  MPMI_MOVE_SET,     /* v = v_bar */
  MPMI_MOVE_BLEND,   /* v = flip (v_old + dv) + (1 - flip) v_bar */
  MPMI_MOVE_CORRECT, /* v = v_bar + what v_new holds: XPIC, FMPM */
  MPMI_MOVE_PLACE    /* v stays what v_new holds */
};

/* New velocity and position of a batch. */
typedef struct mpmi_move {
  int32_t rule;
  int32_t stays; /* 1: v_bar does not change the position */
  double dt, flip;
  double lag; /* share of dv in the position: 1/2 for the second-order update, else 0 */
  int64_t ld;
  const double *v_bar, *dv;          /* gathered, [3][ld] */
  const double *x_old[3], *v_old[3]; /* at the batch's first slot */
  double *x_new[3], *v_new[3];
  double centre[3], half[3];           /* where particles may be: |x - centre| <= half */
  double low[3], high[3];              /* bounds of the grid */
  int32_t within[3];                   /* 1: of these the former are within the latter, and nothing wraps */
  double period[3], inverse_period[3]; /* lengths; 0 when not periodic */
} mpmi_move;
typedef uint32_t (*mpmi_move_fn)(const mpmi_move *job, int64_t n);

/* What is known of the particles that have moved: bad is 0 where all is finite, outside the largest way
 * beyond a face of the grid, but for axes of which `within` says that it is astray, astray that beyond the
 * bounds. */
typedef struct mpmi_moved {
  mpmi_lanes bad, outside, astray;
} mpmi_moved;

MPMI_INLINE mpmi_moved mpmi_nothing_moved(void) {
  const mpmi_lanes zero = {0.0};
  return (mpmi_moved){zero, zero, zero};
}

/* Looks where particles have come along an axis. */
MPMI_INLINE void mpmi_look_where(const mpmi_move *job, int32_t axis, mpmi_lanes x, mpmi_moved *t) {
  mpmi_lanes away = x - job->centre[axis];
  if (!job->within[axis]) {
    away -= job->period[axis] * mpmi_lanes_round(away * job->inverse_period[axis]);
    t->outside = mpmi_lanes_max(t->outside, mpmi_lanes_max(job->low[axis] - x, x - job->high[axis]));
  }
  t->astray = mpmi_lanes_max(t->astray, mpmi_lanes_abs(away) - job->half[axis]);
}

/* Moves the particles from slot s of the batch on; v_bar and dv by axis. */
MPMI_INLINE void mpmi_move_lanes(int32_t dim, const mpmi_move *job, int64_t s, const mpmi_lanes *v_bar,
                                 const mpmi_lanes *dv, mpmi_moved *t) {
  const double dt = job->dt, flip = job->flip, pic = 1.0 - flip, lag = job->lag;
  mpmi_lanes v[3], path[3];
  for (int32_t k = 0; k < dim; ++k) v[k] = path[k] = v_bar[k];
  if (job->stays)
    for (int32_t k = 0; k < dim; ++k) path[k] = (mpmi_lanes){0.0};
  if (job->rule == MPMI_MOVE_PLACE)
    for (int32_t k = 0; k < dim; ++k) v[k] = mpmi_lanes_load(job->v_new[k] + s);
  if (job->rule == MPMI_MOVE_BLEND)
    for (int32_t k = 0; k < dim; ++k)
      v[k] = flip * (mpmi_lanes_load(job->v_old[k] + s) + dv[k]) + pic * v_bar[k];
  if (job->rule == MPMI_MOVE_CORRECT)
    for (int32_t k = 0; k < dim; ++k) v[k] = v_bar[k] + mpmi_lanes_load(job->v_new[k] + s);
  if (lag > 0.0)
    for (int32_t k = 0; k < dim; ++k) path[k] -= lag * dv[k];
  for (int32_t k = 0; k < dim; ++k) {
    const mpmi_lanes x = mpmi_lanes_load(job->x_old[k] + s) + dt * path[k];
    mpmi_lanes_store(job->v_new[k] + s, v[k]);
    mpmi_lanes_store(job->x_new[k] + s, x);
    t->bad += 0.0 * v[k];
    t->bad += 0.0 * x;
    mpmi_look_where(job, k, x, t);
  }
}

MPMI_INLINE uint32_t mpmi_move_flags(const mpmi_moved *t) {
  return (mpmi_lanes_sum(t->bad) == 0.0 ? 0u : (uint32_t)MPMI_NONFINITE) |
         (mpmi_lanes_largest(t->outside) > 0.0 ? (uint32_t)MPMI_OUTSIDE : 0u) |
         (mpmi_lanes_largest(t->astray) > 0.0 ? (uint32_t)(MPMI_LEFT_BOUNDS | MPMI_OUTSIDE) : 0u);
}

#endif
