/* The specialised kernels of the method: weights, scatter (P2G), update of nodes, gather (G2P), advance,
 * sums over particles, and boxes of nodes to and from tiles.
 *
 * Kernels work on slots in groups of 16 and in chunks; they see one block at a time with its tile: a
 * private copy of the block's nodes plus halo. Tile nodes hold `values` doubles: 4 [px py pz m] or 8 [px py
 * pz m fx fy fz 0] when scattering, and [vx vy vz m] or [vx vy vz m dvx dvy dvz 0] when gathering, where v is
 * the updated nodal velocity and dv its change over the step. The last axis runs fastest.
 *
 * Specialised by dim x stencil width x form x instruction set. A basis family enters through its weights
 * alone. */
#ifndef MPMI_KERNELS_H
#define MPMI_KERNELS_H

#include "grid/blocks.h"
#include "material/material.h"
#include "simd/chunk.h"

enum { MPMI_MAX_WIDTH = 4 };
#define MPMI_TILE_EDGE(dim, width) (MPMI_BLOCK_EDGE(dim) + 2 * MPMI_RING + (width)-1)

/* One axis of the basis as seen from one block. */
typedef struct mpmi_axis {
  double origin, spacing, inverse_spacing;
  double last_cell;              /* the last one has particles on the upper face too */
  double first_knot, last_knot;  /* in cells: open knot vectors are repeated there; else far away */
  double domain;                 /* edge of the particle domains in cells, where particles have none */
  double period, inverse_period; /* in cells; 0 when the axis is not periodic */
  double tile_base;              /* node at the corner of the tile */
  double middle; /* of the valid first nodes, relative to tile_base: picks the periodic image */
} mpmi_axis;

/* Where particles are, each array at slot 0, and for GIMP the edges of their domains: size, or NULL for one
 * size for all, times |stretch|, or NULL for 1. */
typedef struct mpmi_points {
  const double *x[3], *size[3], *stretch[3];
} mpmi_points;

/* Weights of a chunk along each axis: w basis; g second weight of the first-order terms: the gradient, or u /
 * D in the MLS form; u = w (x_i - x_p), with inverse_moment = 1 / sum w (x_i - x_p)^2, or 0 where that
 * vanishes. first: from the particle to the first node of its stencil, in cells. node: that node's place in
 * the tile. */
typedef struct mpmi_weights {
  _Alignas(64) double w[3][MPMI_MAX_WIDTH][MPMI_CHUNK];
  double g[3][MPMI_MAX_WIDTH][MPMI_CHUNK];
  double u[3][MPMI_MAX_WIDTH][MPMI_CHUNK];
  double inverse_moment[3][MPMI_CHUNK], first[3][MPMI_CHUNK];
  int32_t node[MPMI_CHUNK];
} mpmi_weights;

/* What a transfer needs beside w and first. */
enum {
  MPMI_NEED_GRADIENT = 1, /* g */
  MPMI_NEED_MOMENT = 2,   /* u and inverse_moment */
  MPMI_NEED_MLS = 4,      /* these, and g = u / D in place of the gradient */
  MPMI_NO_PLACE = 8       /* but not node: the particles may lie anywhere */
};

/* Weights of n (a multiple of 16, at most a chunk) particles along all axes: one function per basis and dim;
 * everything else is common. */
typedef void (*mpmi_weights_fn)(const mpmi_axis *axis, int32_t need, const mpmi_points *points, int64_t begin,
                                int64_t n, mpmi_weights *out);

/* Forms of the scatter: 4 values (momentum and mass; the fused MLS force may ride on the momentum) or 8
 * (force apart), with or without the affine part of the velocity; UNEVEN: of nodes that are not a spacing
 * apart. */
enum {
  MPMI_SCATTER_4,
  MPMI_SCATTER_4_AFFINE,
  MPMI_SCATTER_4_UNEVEN,
  MPMI_SCATTER_8,
  MPMI_SCATTER_8_AFFINE,
  MPMI_SCATTER_FORMS
};
/* Forms of the gather: 4 values: velocity and L; and C beside L; C of the MLS form in place of L; 8 values:
 * velocity, its change and L; and C. */
enum {
  MPMI_GATHER_4,
  MPMI_GATHER_4_AFFINE,
  MPMI_GATHER_4_MLS,
  MPMI_GATHER_8,
  MPMI_GATHER_8_AFFINE,
  MPMI_GATHER_FORMS
};

/* Component arrays, each at slot 0, that the chunk after the present one will touch. */
enum { MPMI_MAX_STREAMS = 64 };
typedef struct mpmi_streams {
  int32_t count;
  const double *at[MPMI_MAX_STREAMS];
} mpmi_streams;

/* Component arrays of a set, each at slot 0. */
typedef struct mpmi_scatter {
  mpmi_axis axis[3];
  mpmi_weights_fn weights;
  int32_t need;
  mpmi_points points;
  const double *v[3], *mass, *volume;
  const double *stress[6]; /* by (xx yy zz xy yz xz) */
  const double *affine[9]; /* row * 3 + column; for the affine forms */
  const double *force[3];  /* external force on the particle beside gravity, or NULL */
  double gravity[3];
  double fused_dt; /* form 4 affine: time that the force acts on the momentum; 0: no force */
  double *tile;
  mpmi_streams streams;
} mpmi_scatter;
typedef void (*mpmi_scatter_fn)(const mpmi_scatter *job, int64_t begin, int64_t end);

/* Gathered quantities of a batch, [components][ld] each; L and C full 3x3: columns that the grid
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

/* Flags that advance kernels return for a batch: something to look at, particle by particle. */
enum { MPMI_LEFT_TILE = 1, MPMI_OUTSIDE = 2, MPMI_NONFINITE = 4, MPMI_NOT_POSITIVE = 8 };

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
  double centre[3], half[3];           /* of the loose tile */
  double low[3], high[3];              /* bounds of the grid */
  double period[3], inverse_period[3]; /* lengths; 0 when not periodic */
} mpmi_move;
typedef uint32_t (*mpmi_move_fn)(const mpmi_move *job, int64_t n);

/* F_new from F_old and L, as the material's kinematics want it; F_inc when asked for. Full and compact F. */
typedef struct mpmi_deform {
  double dt;
  int64_t ld;
  const double *L;        /* [9][ld] */
  double *F, *F_inc;      /* [9][ld] out; F_inc may be NULL */
  const double *F_old[9]; /* stored components */
  double *F_new[9];
} mpmi_deform;
typedef void (*mpmi_deform_fn)(const mpmi_deform *job, int64_t n);
/* volume = det F * initial volume from stored components: the one place where volumes are made, so that they
 * can be made again with the same bits. Returns MPMI_NOT_POSITIVE / MPMI_NONFINITE. */
typedef uint32_t (*mpmi_volume_fn)(const double *const *F, const double *initial_volume, double *volume,
                                   int64_t n);

/* Sums over a batch: energies, momenta and the largest rate (|v_k| + c) / h_k. A job looks at what the law
 * gave, at the motion, or at both. */
enum { MPMI_SUMS_LAW = 1, MPMI_SUMS_MOTION = 2 };
typedef struct mpmi_sums {
  double kinetic, strain, work, rate, viscous_rate;
  double momentum[3], angular[3];
} mpmi_sums;
typedef struct mpmi_sums_job {
  int32_t what;
  int64_t ld; /* of wave_speed ... */
  const double *x[3], *v[3], *mass, *initial_volume;
  const double *wave_speed, *kinematic_viscosity, *energy; /* [ld] of the batch */
  const double *affine[9];                                 /* or NULL: of APIC, for the angular momentum */
  const double *force[3];                                  /* external force or NULL, */
  const double *x_old[3]; /* and old position: work over the step; NULL: no work */
  double gravity[3], period[3], inverse_period[3];
  double inverse_spacing[3], viscous_factor; /* 2 dim / h_min^2 */
  const double *moment[3];   /* sum w (x_i - x)^2 of each particle along each axis, or NULL: */
  double constant_moment[3]; /* the same for all */
  const double *checked[2];  /* [checked_rows][ld] further values that must be finite */
  int32_t checked_rows[2];
} mpmi_sums_job;
typedef uint32_t (*mpmi_sums_fn)(const mpmi_sums_job *job, int64_t n, mpmi_sums *sums); /* adds to sums */

/* A box of nodes in a tile and in the nodes of one block; strides of the two outer axes in nodes. */
typedef struct mpmi_box {
  double *tile, *nodes;
  int32_t count[3], tile_stride[2], node_stride[2];
} mpmi_box;
/* nodes += tile, tile = 0, both with `values` per node. */
typedef void (*mpmi_add_box_fn)(int32_t values, const mpmi_box *box);
/* Prefetches the nodes. */
typedef void (*mpmi_fetch_box_fn)(int32_t values, const mpmi_box *box);
/* tile = nodes: 8 from 8, or 4 from 4 or from the first half of 8. */
typedef void (*mpmi_load_box_fn)(int32_t values, int32_t node_values, const mpmi_box *box);

/* Momenta and forces of `count` nodes to velocities and increments; returns how many have mass. */
typedef int64_t (*mpmi_update_fn)(int32_t values, double *nodes, int64_t count, double cut, double dt);

/* Implicit steps: what a particle has to do with the nodes of its stencil (stiffness.c). Arrays are
 * [components][ld] of a batch, tensors full, component 3 * i + K; those that the grid does not have are not
 * looked at. */
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
  int64_t ld;                                     /* of nominal */
  const double *nominal;                          /* [9] at 0, or NULL: then */
  const double *mass, *initial_volume, *force[3]; /* at slot 0; force beside gravity, or NULL */
  double gravity[3];
  int32_t deforms; /* 0: gives no stiffness */
  double *tile;
} mpmi_force_scatter;
typedef void (*mpmi_force_scatter_fn)(const mpmi_force_scatter *job, int64_t begin, int64_t n);

/* Nodes of a stencil, rounded up for rows of a dense matrix: entry (i, a) by (j, b) of a stencil's stiffness
 * is K[(i * nodes + a) * dim * nodes + j * nodes + b]. */
#define MPMI_STENCIL_NODES(dim, width)                                                                       \
  ((((dim) > 2 ? (width) * (width) * (width) : (dim) > 1 ? (width) * (width) : (width)) + 3) / 4 * 4)
/* Adds particle p of a chunk, whose weights and gradients are at hand; stiffness: its first component. */
typedef void (*mpmi_stiffness_fn)(int32_t width, const mpmi_weights *W, int64_t p, const double *stiffness,
                                  int64_t ld, double *K);

typedef struct mpmi_kernels {
  mpmi_weights_fn weights[MPMI_FAMILIES][4];                          /* by family of the basis, dim */
  mpmi_scatter_fn scatter[4][MPMI_MAX_WIDTH + 1][MPMI_SCATTER_FORMS]; /* by dim, width, form */
  mpmi_gather_fn gather[4][MPMI_MAX_WIDTH + 1][MPMI_GATHER_FORMS];
  mpmi_add_box_fn add_box;
  mpmi_fetch_box_fn fetch_box;
  mpmi_load_box_fn load_box;
  mpmi_update_fn update;
  mpmi_move_fn move[4];
  mpmi_deform_fn deform[MPMI_F_KINDS][4];
  mpmi_volume_fn volume[4];
  mpmi_sums_fn sums[4];
  mpmi_push_fn push[4];
  mpmi_force_scatter_fn force_scatter[4][MPMI_MAX_WIDTH + 1];
  mpmi_stiffness_fn stiffness[4];
} mpmi_kernels;

const mpmi_kernels *mpmi_kernels_of(int32_t isa);

#endif
