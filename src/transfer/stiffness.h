/* Implicit steps: what a particle has to do with the nodes of its stencil. Arrays are [components][ld] of a
 * batch, tensors full, component 3 * i + K; those that the grid does not have are not looked at. */
#ifndef MPMI_STIFFNESS_H
#define MPMI_STIFFNESS_H

#include "transfer/weights.h"

typedef struct mpmi_push {
  int64_t ld;
  const double *F_inc;   /* [9] of the step, from the displacements as they are */
  const double *stress;  /* [6] Cauchy, xx yy zz xy yz xz */
  const double *volume;  /* new, as F has it */
  const double *weight;  /* of the tangent: initial volume, less what the locking remedy makes of it */
  const double *tangent; /* [81] as mpm_tangent_fn has it, or NULL */
  double *inverse;       /* [9] out: F_inc^-1 */
  double *nominal;       /* [9] out: V sigma F_inc^-T, by which G gives the internal force */
  double *stiffness; /* [81] out: G_a . stiffness . G_b is the stiffness between two nodes; 9 * (3 * i + K)
                        + (3 * j + L) */
} mpmi_push;
typedef void (*mpmi_push_fn)(const mpmi_push *job, int64_t n);

/* Forces of particles [begin, begin + n) on the nodes of a tile with 4 values: the internal one, or the
 * external one with sum of V0 |G|^2, which tells the nodes that have stiffness. */
typedef struct mpmi_force_scatter {
  mpmi_axis axis[3];
  mpmi_weights_fn weights;
  mpmi_points points;
  int64_t ld; /* leading dimension of nominal */
  /* With nominal [9] it is the internal force; with NULL the external one, from mass, initial_volume and
   * force, which stand at slot 0. force may be NULL. */
  const double *nominal;
  const double *mass, *initial_volume, *force[3];
  double gravity[3];
  int32_t hoop;    /* particles are rings: x[0] is their radius */
  int32_t deforms; /* 0: its particles have no stiffness */
  double *tile;
} mpmi_force_scatter;
typedef void (*mpmi_force_scatter_fn)(const mpmi_force_scatter *job, int64_t begin, int64_t n);

/* Nodes of a stencil, rounded up for rows of a dense matrix: entry (i, a) by (j, b) of a stencil's stiffness
 * is K[(i * nodes + a) * dim * nodes + j * nodes + b]. */
#define MPMI_STENCIL_NODES(dim, width)                                                                       \
  ((((dim) > 2 ? (width) * (width) * (width) : (dim) > 1 ? (width) * (width) : (width)) + 3) / 4 * 4)
/* Adds to K the stiffness of particle p of a chunk. W holds its weights and gradients; stiffness points at
 * its first component of mpmi_push. hoop: of rings 1 / r, else 0. */
typedef void (*mpmi_stiffness_fn)(int32_t width, const mpmi_weights *W, int64_t p, const double *stiffness,
                                  int64_t ld, double hoop, double *K);

#endif
