/* G2P: what the particles of one block take from its tile. */
#ifndef MPMI_GATHER_H
#define MPMI_GATHER_H

#include "transfer/streams.h"
#include "transfer/weights.h"

/* Forms of the gather: how many values nodes have, and what particles take from them. */
enum {
  MPMI_GATHER_4,        /* 4 values: velocity and L */
  MPMI_GATHER_4_AFFINE, /* 4 values: velocity, L and C */
  MPMI_GATHER_4_MLS,    /* 4 values: velocity, and in the place of L the C of the MLS form */
  MPMI_GATHER_8,        /* 8 values: velocity, its change and L */
  MPMI_GATHER_8_AFFINE, /* 8 values: velocity, its change, L and C */
  MPMI_GATHER_FORMS
};

/* Holds the gathered quantities of a batch, [components][ld] each; L and C full 3x3: columns that the grid
 * does not have are left alone, rows are zero. */
typedef struct mpmi_gather {
  mpmi_axis axis[3];
  mpmi_weights_fn weights;
  int32_t need;
  mpmi_points points;
  const double *initial_volume; /* a hole has none: everything gathered for it is 0 */
  const double *tile;
  int64_t ld;
  double *v, *dv, *L, *C; /* [3], [3], [9], [9]; outputs, slot `begin` at 0 */
  mpmi_streams streams;
} mpmi_gather;
typedef void (*mpmi_gather_fn)(const mpmi_gather *job, int64_t begin, int64_t n);

#endif
