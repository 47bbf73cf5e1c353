/* G2P: what the particles of one block take from its tile. */
#ifndef MPMI_GATHER_H
#define MPMI_GATHER_H

#include "material/deformation.h"
#include "transfer/box.h"
#include "transfer/move.h"
#include "transfer/streams.h"
#include "transfer/weights.h"

/* Forms of the gather: what particles take. */
enum {
  MPMI_GATHER_MEAN,          /* velocity */
  MPMI_GATHER_PLAIN,         /* velocity and L */
  MPMI_GATHER_AFFINE,        /* velocity, L and C, where D is the same for all particles */
  MPMI_GATHER_AFFINE_VARIED, /* the same where each has its own D */
  MPMI_GATHER_MLS,           /* velocity, and in the place of L the C of the MLS form */
  MPMI_GATHER_CHANGE,        /* velocity and its change */
  MPMI_GATHER_BOTH,          /* velocity, its change and L */
  MPMI_GATHER_BOTH_AFFINE,   /* velocity, its change, L and C; D as above */
  MPMI_GATHER_BOTH_AFFINE_VARIED,
  MPMI_GATHER_FORMS
};
/* Tells whether a form takes L and C. */
static inline int32_t mpmi_gathers_C(int32_t form) {
  return form == MPMI_GATHER_AFFINE || form == MPMI_GATHER_AFFINE_VARIED || form == MPMI_GATHER_BOTH_AFFINE ||
         form == MPMI_GATHER_BOTH_AFFINE_VARIED;
}
/* Tells whether a form takes L. */
static inline int32_t mpmi_gathers_L(int32_t form) {
  return form != MPMI_GATHER_MEAN && form != MPMI_GATHER_MLS && form != MPMI_GATHER_CHANGE;
}
/* Tells whether a form takes the change of velocity. */
static inline int32_t mpmi_gathers_change(int32_t form) {
  return form >= MPMI_GATHER_CHANGE;
}
/* Returns what the tile takes of nodes: below three axes a velocity and its change are four values. */
static inline int32_t mpmi_gather_takes(int32_t dim, int32_t form) {
  return !mpmi_gathers_change(form) ? MPMI_TAKE_HALF : dim < 3 ? MPMI_TAKE_PAIRS : MPMI_TAKE_ALL;
}

/* A batch of particles, and what becomes of what is gathered for them. `move` and `deform` work on it while
 * it is in registers, where they are not NULL. Rows are stored for those that read them later, of the
 * components that the grid has and from the first particle of the batch on: v and dv as [3][ld] unless v is
 * NULL, L and C as full 3x3 by rows of their own, L unless it has none. */
typedef struct mpmi_gather {
  mpmi_axis axis[3];
  mpmi_weights_fn weights;
  int32_t need;
  mpmi_points points;
  const double *initial_volume; /* a hole has none: everything gathered for it is 0 */
  const double *tile;
  int64_t ld;
  double *v, *dv, *L[9], *C[9];
  const mpmi_move *move;
  const mpmi_deform *deform;
  mpmi_streams streams;
} mpmi_gather;

/* Flags of what was moved and deformed. */
typedef struct mpmi_taken {
  uint32_t moved, deformed;
} mpmi_taken;
typedef mpmi_taken (*mpmi_gather_fn)(const mpmi_gather *job, int64_t begin, int64_t n);

#endif
