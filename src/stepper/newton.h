/* Implicit steps: Newton's method for the displacements of the nodes over one step (Guilkey & Weiss 2003,
 * section 3).
 *
 *   newmark.c    one step: the state on nodes, the iterations, the new state of the particles
 *   newton.c     the iterations: residual, increment, line search, convergence
 *   unknowns.c   active nodes, their numbering, who holds them
 *   pattern.c    the pattern of the matrix
 *   assembly.c   forces and stiffness, block by block and colour by colour
 *   assemble_batch.c  what one batch of particles adds to them
 *   reactions.c  what walls, the host and prescribed particles exert
 *
 * Vectors have matrix.rows * dim entries, one row per node that moves by itself; what happens at its periodic
 * images and mirrored ghosts is folded into it with their signs (grid/constraints.h). */
#ifndef MPMI_NEWTON_H
#define MPMI_NEWTON_H

#include "linalg/solver.h"
#include "stepper/stepper.h"

/* A node in the stencil of a particle, and the row that it moves with. */
typedef struct mpmi_active_node {
  int64_t slot;
  int32_t row;
  int32_t plain; /* all signs are 1 */
  double sign[3];
} mpmi_active_node;

enum {
  MPMI_U,        /* displacement over the step */
  MPMI_V0,       /* velocity and acceleration at its start */
  MPMI_A0,       /* */
  MPMI_TARGET,   /* displacement of held components */
  MPMI_EXTERNAL, /* external force, at its end */
  MPMI_INTERNAL, /* internal force of the displacements as they are */
  MPMI_RESIDUAL, /* internal + inertia - external */
  MPMI_RHS,
  MPMI_DIAGONAL, /* of the matrix, sizes */
  MPMI_DU,
  MPMI_START, /* displacement before the increment */
  MPMI_VECTORS
};

/* The nodes of a stencil: where they lie in a tile, and among the offsets that couple. */
enum { MPMI_MOST_NODES = MPMI_STENCIL_NODES(3, MPMI_MAX_WIDTH) };
typedef struct mpmi_stencil {
  int32_t count, in_tile[MPMI_MOST_NODES], offset[MPMI_MOST_NODES];
} mpmi_stencil;

/* What one task assembles with; component arrays have the length of the longest batch. */
typedef struct mpmi_newton_work {
  double *tile; /* forces on the nodes of one block, 4 each */
  double *F_inc, *nominal, *stiffness, *tangent, *weight, *h, *inverse;
  /* [9] [9] [81] [81] [1] [9] [9] */
  void *tangent_scratch;
  double *K;            /* stiffness of one stencil */
  int32_t *tile_active; /* active node at each place of the tile, or -1 */
  int32_t symmetric;
} mpmi_newton_work;

typedef struct mpmi_newton {
  mpmi_matrix matrix;
  mpmi_solver *solver;
  int64_t active_count, active_capacity;
  mpmi_active_node *active;
  int64_t map_capacity;
  int32_t *active_of; /* [slots] active node, or -1 */
  mpmi_stencil stencil;
  int32_t offsets; /* nodes that share a stencil with one, itself among them */
  int64_t place_capacity;
  int32_t *place; /* [active][offsets] entry of the matrix that couples a node with the one that far away */
  int64_t members_capacity, members_start_capacity;
  int64_t *members_start, *members; /* active nodes by row */
  int64_t diagonal_capacity;
  int64_t *diagonal; /* [rows] entry */
  int64_t mass_capacity;
  double *mass; /* [rows] */
  int64_t vector_capacity;
  double *vector[MPMI_VECTORS];
  double *vector_memory;
  int64_t force_capacity, external_capacity;
  double *force, *external; /* [4 per slot] internal of the displacements as they are; external, stiffness */
  int64_t cell_capacity, cell_node_capacity;
  double *cell;       /* by row of the lower corner of a cell: sums of the locking remedy */
  int32_t *cell_node; /* active nodes of its stencils, or -1 */
  int64_t topology;   /* of the stepper, that the pattern was made for; -1: none */
  void *work_memory;
  size_t work_bytes;
  mpmi_newton_work *work; /* [tasks] */
  int32_t history_capacity, history_count;
  double *history;
  int32_t iterations, solver_used;
  int64_t linear_iterations;
  double factor_seconds, solve_seconds;
} mpmi_newton;

static inline int32_t mpmi_is_dynamic(const mpm_stepper *s) {
  return !s->desc.quasi_static;
}

/* Nodes along an axis that couple: of a stencil, or with the locking remedy of all stencils of a cell. */
static inline int32_t mpmi_coupling_span(const mpm_stepper *s) {
  return s->grid->width + (s->desc.locking_remedy ? s->grid->centred : 0);
}

/* Places of the nodes of a cube of `width` in one of `edge`, the last axis fastest; how many there are. */
static inline int32_t mpmi_cube_places(int32_t dim, int32_t width, int32_t edge, int32_t *place) {
  int32_t count = 1;
  place[0] = 0;
  for (int32_t axis = 0; axis < dim; ++axis, count *= width)
    for (int32_t n = count - 1; n >= 0; --n)
      for (int32_t k = width - 1; k >= 0; --k) place[n * width + k] = place[n] * edge + k;
  return count;
}

/* newmark.c */
mpm_status mpmi_newmark_step(mpm_stepper *s, double dt);
/* The dt to try after a step that went well. */
double mpmi_next_dt(const mpm_stepper *s, double dt);

/* newton_memory.c */
mpm_status mpmi_newton_prepare(mpm_stepper *s);
void mpmi_newton_free(mpm_stepper *s);

/* newton.c: displacements of the step in vector[MPMI_U], forces and stress in place. */
mpm_status mpmi_newton_solve(mpm_stepper *s, double dt);
/* matrix.held: by whom; none but the last two is an unknown. */
enum { MPMI_ROW_FREE, MPMI_ROW_PRESCRIBED, MPMI_ROW_WALL };
/* Acceleration that belongs to a displacement, by component of the vectors; on walls there is none. */
static inline double mpmi_newmark_acceleration(const mpm_stepper *s, double dt, int64_t at) {
  const mpmi_newton *w = s->newton;
  const double beta = s->desc.newmark_beta;
  const uint8_t held = w->matrix.held[at];
  if (held == MPMI_ROW_WALL || (held && s->desc.boundary_zero_acceleration)) return 0.0;
  return (w->vector[MPMI_U][at] - dt * w->vector[MPMI_V0][at] -
          dt * dt * (0.5 - beta) * w->vector[MPMI_A0][at]) /
         (beta * dt * dt);
}

/* unknowns.c: from the masses in s->node and the external forces, whose fourth value tells the nodes that
 * have stiffness. */
mpm_status mpmi_unknowns_find(mpm_stepper *s);
/* Sums of nodal forces, 4 values each, over the nodes that move with each row. */
void mpmi_unknowns_fold(const mpm_stepper *s, const double *forces, double *vector);

/* pattern.c: of the active nodes as they are numbered. */
mpm_status mpmi_make_pattern(mpm_stepper *s, int64_t rows);

/* assembly.c */
void mpmi_stencil_find(const mpm_stepper *s, mpmi_stencil *to);
mpm_status mpmi_external_forces(mpm_stepper *s);
/* Stress and internal force of the displacements u; the stiffness at them. Fail as the law does. */
mpm_status mpmi_internal_forces(mpm_stepper *s, const double *u, double dt);
mpm_status mpmi_stiffness(mpm_stepper *s, const double *u, double dt);
/* Does the tile of a block reach over the end of a periodic axis? */
int32_t mpmi_at_seam(const mpm_stepper *s, int64_t block);
/* Called from the pass over the particles: what one batch adds, its law having run. */
void mpmi_assemble_begin(mpm_stepper *s, int32_t task, int32_t what, int64_t block);
void mpmi_assemble_batch(mpm_stepper *s, int32_t task, int32_t what, int32_t m, const mpmi_law_batch *law,
                         const mpmi_axis *axis, int64_t begin, int64_t n);
void mpmi_assemble_end(mpm_stepper *s, int32_t task, int32_t what, int64_t block);

/* locking_stiffness.c: what the locking remedy adds to the stiffness. First everything to zero; then of each
 * batch the local part, in place, with h [9][ld] for what couples the particles of a cell: */
mpm_status mpmi_locking_stiffness_begin(mpm_stepper *s);
void mpmi_locking_stiffness_local(const mpm_stepper *s, const mpmi_law_batch *law, const double *weight,
                                  const double *volume, double *tangent, double *h);
/* of each particle: weight h F_inc^-T, F_inc^-1 and its new volume, components 3 * row + column; */
typedef struct mpmi_locking_particle {
  double h[9], inverse[9], volume;
} mpmi_locking_particle;
void mpmi_locking_stiffness_add(mpm_stepper *s, const mpmi_newton_work *work, const mpmi_weights *W,
                                int64_t p, int32_t cell_place, const mpmi_locking_particle *of);
/* and at last the cells into the matrix. */
void mpmi_locking_stiffness_end(mpm_stepper *s);

/* reactions.c: impulses of what holds nodes, from the residual; then the prescribed particles' share. */
mpm_status mpmi_book_reactions(mpm_stepper *s, double dt);

#endif
