/* New velocity and position of particles. */
#ifndef MPMI_MOVE_H
#define MPMI_MOVE_H

#include "simd/flags.h"

/* How a particle's velocity follows from what was gathered. */
enum {
  MPMI_MOVE_SET,    /* v = v_bar */
  MPMI_MOVE_BLEND,  /* v = flip (v_old + dv) + (1 - flip) v_bar */
  MPMI_MOVE_CORRECT /* v = v_bar + what v_new holds: XPIC */
};

/* New velocity and position of a batch. */
typedef struct mpmi_move {
  int32_t rule;
  double dt, flip;
  double lag; /* share of dv in the position: 1/2 for the second-order update, else 0 */
  int64_t ld;
  const double *v_bar, *dv;          /* gathered, [3][ld] */
  const double *x_old[3], *v_old[3]; /* at the batch's first slot */
  double *x_new[3], *v_new[3];
  double centre[3], half[3];           /* where particles may be: |x - centre| <= half */
  double low[3], high[3];              /* bounds of the grid */
  double period[3], inverse_period[3]; /* lengths; 0 when not periodic */
} mpmi_move;
typedef uint32_t (*mpmi_move_fn)(const mpmi_move *job, int64_t n);

#endif
