/* Implicit steps: Newton's method for the displacements of the nodes over one step (Guilkey & Weiss 2003,
 * section 3).
 *
 *   newmark.c              one step: the state on nodes, the iterations, the new state of the particles
 *   newton.c               the iterations: residual, increment, line search, convergence
 *   unknowns.c             active nodes, their numbering, who holds them
 *   extension.c            which of them move with others
 *   pattern.c              the pattern of the matrix
 *   assembly.c             forces and stiffness of all particles
 *   particle_stiffness.c   what one batch of particles adds to them
 *   locking_stiffness.c    what the remedy against volumetric locking adds to the stiffness
 *   surface_loads.c        forces of surfaces, and the stiffness of those that follow them
 *   surface_springs.c      forces and stiffness of surfaces that prescribe velocities
 *   condense.c             rows that move with others leave the system
 *   active_set.c           contact: which touches of bodies are closed
 *   contact_stiffness.c    their forces, and what they add to the matrix
 *   contact_limits.c       bodies in contact that slide or come to overlap too far
 *   contact_outcome.c      what contact did in the step
 *   trouble.c              what steps that fail tell
 *   reactions.c            what walls, the host and prescribed particles exert
 *   vote.c                 several parts: failures, sums and maxima of all of them
 *   shared_rows.c          whose rows are whose
 *   shared_stiffness.c     the stiffness of particles of other parts
 *   balance.c              memory
 *
 * Vectors have matrix.rows * dim entries, one row per node that moves by itself; what happens at its periodic
 * images and mirrored ghosts is folded into it with their signs (grid/constraints.h). */
#ifndef MPMI_BALANCE_H
#define MPMI_BALANCE_H

#include "linalg/solver.h"
#include "stages/batch.h"

/* A node in the stencil of a particle, and the row that it moves with. */
typedef struct mpmi_active_node {
  int64_t slot;
  int32_t row;
  int32_t plain; /* all signs are 1 */
  double sign[3];
} mpmi_active_node;

enum {
  MPMI_U,        /* displacement over the step */
  MPMI_V0,       /* velocity at its start */
  MPMI_A0,       /* acceleration at its start */
  MPMI_TARGET,   /* displacement of held components */
  MPMI_EXTERNAL, /* external force, at its end */
  MPMI_INTERNAL, /* internal force of the displacements as they are */
  MPMI_CONTACT,  /* force of contact, as it is */
  MPMI_SPRINGS,  /* force of surfaces that prescribe, as it is */
  MPMI_RESIDUAL, /* internal + inertia - external - contact - springs */
  MPMI_RHS,      /* right-hand side of the linear system */
  MPMI_DIAGONAL, /* sizes of the diagonal entries of the matrix */
  MPMI_DU,       /* increment of the displacement */
  MPMI_TERMS,    /* terms of the sum that is being made */
  MPMI_START,    /* displacement before the increment */
  MPMI_VECTORS
};

/* The nodes of a stencil: where they lie in a tile, and among the offsets that couple. */
enum { MPMI_MOST_NODES = MPMI_STENCIL_NODES(3, MPMI_MAX_WIDTH) };
typedef struct mpmi_stencil {
  int32_t count, in_tile[MPMI_MOST_NODES], offset[MPMI_MOST_NODES];
} mpmi_stencil;

/* A touch that may close, as a constraint on the displacements of the step. Forces are on the second
 * party. */
typedef struct mpmi_constraint {
  int64_t touch;
  int64_t coupling[2]; /* the entries of the matrix that couple the rows; -1: not complete here */
  int32_t row[2];      /* -1: of a party that is moved from outside */
  int32_t closed, stuck;
  int32_t changes, slips;    /* how often either has changed */
  int32_t turned, smooth;    /* friction has been turned round; there is none in this step */
  int32_t stalls, gives_way; /* iterations without coming closer; it stays open in this step */
  int32_t slow;              /* it has come closer, but hardly as it should have */
  double missed;             /* by how much it was not closed in the iteration before */
  int32_t free[3];           /* components in which a party moves by itself */
  double moves[3];           /* relative displacement by what is moved from outside */
  double allowed;            /* how far the parties may approach, >= 0 */
  double nodal_stiffness;
  int32_t light;    /* hardly anything is there that resists: what it misses is rounding */
  double stiffness; /* of the augmented Lagrangian */
  double force[3], start[3], target[3]; /* as it is, before the increment, after all of it */
} mpmi_constraint;

/* An outer row moves with inner ones; its terms end where those of the next one begin. */
typedef struct mpmi_outer {
  int32_t row, end;
  int32_t in_contact; /* it may touch something, and moves by itself in this step */
} mpmi_outer;
typedef struct mpmi_outer_term {
  int32_t row;
  double share[3]; /* by component: what a slip wall mirrors has the other sign across it */
  int32_t face[3]; /* of that wall, or -1 */
} mpmi_outer_term;

/* What one task assembles with; component arrays have the length of the longest batch. */
typedef struct mpmi_newton_work {
  mpmi_batch batch;                      /* the particles at hand */
  double *tile;                          /* forces on the nodes of the block at hand, 4 each */
  double *F_inc, *nominal, *inverse, *h; /* [9] each */
  double *stiffness, *tangent;           /* [81] each */
  double *weight;                        /* [1] */
  double *k, *q;                         /* [9], [1]: of the locking remedy with averaged pressure */
  void *tangent_scratch;
  double *K;            /* stiffness of one stencil */
  int32_t *tile_active; /* active node at each place of the tile, or -1 */
  int32_t symmetric;
} mpmi_newton_work;

/* What one of several parts knows of its rows. */
typedef struct mpmi_shared_rows {
  uint64_t *key;          /* [rows] of the block of the node */
  int32_t *place;         /* [rows] which of the bodies and nodes there it is */
  int32_t *owner, *home;  /* [rows] the part that owns it, that numbers it */
  uint8_t *wanted, *kept; /* [rows] 1: its values count here; it is to be complete */
  int64_t key_capacity, place_capacity, owner_capacity, home_capacity, wanted_capacity, kept_capacity;
  int32_t is_shared; /* all parts know whose rows are whose, as they are now */
} mpmi_shared_rows;

/* The stiffness of the particles of blocks that parts share, as it is sent (shared_stiffness.c). */
typedef struct mpmi_shared_stiffness {
  double *record;    /* of own blocks at the edge of the part */
  int64_t *start;    /* [boundary + 1] where each begins */
  const double **at; /* [blocks] where the record of a block is, own or come, or NULL */
  int64_t record_capacity, start_capacity, at_capacity;
} mpmi_shared_stiffness;

typedef struct mpmi_newton {
  mpmi_matrix matrix;
  mpmi_rows *shared; /* NULL: there is one part */
  mpmi_shared_rows rows_of;
  mpmi_shared_stiffness stiffness_of;
  int64_t batch_length; /* of the longest batch */
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
  int64_t outer_count, outer_capacity, term_count, term_capacity;
  mpmi_outer *outer;
  mpmi_outer_term *term;
  int64_t outer_of_capacity, led_start_capacity, led_capacity, master_capacity, copies_capacity,
      columns_capacity;
  int32_t *outer_of;        /* [rows] outer row, or -1 */
  int64_t *led_start, *led; /* outer rows by the inner ones that they move with */
  int64_t *master;          /* [rows] slot of the node behind a row */
  double *copies;           /* [rows] mpmi_copies_of */
  int32_t *columns;         /* [tasks] those of a row that is being listed */
  int64_t diagonal_capacity;
  int64_t *diagonal; /* [rows] entry */
  int64_t mass_capacity;
  double *mass; /* [rows] */
  int64_t vector_capacity;
  double *vector[MPMI_VECTORS];
  double *vector_memory;
  /* On nodes: internal force of the displacements as they are; external force, and what tells that a node has
   * stiffness. */
  mpmi_nodal force, external;
  int64_t cell_capacity, cell_node_capacity;
  double *cell;           /* by row of the lower corner of a cell: sums of the locking remedy */
  int32_t *cell_node;     /* active nodes of its stencils, or -1 */
  int64_t version;        /* of the layout that the pattern was made for; -1: none */
  int32_t couples_bodies; /* nodes of several bodies at one index are coupled, on this part */
  void *work_memory;
  size_t work_bytes;
  mpmi_newton_work *work; /* [tasks] */
  int64_t constraint_count, constraint_capacity;
  mpmi_constraint *constraint;
  int32_t touches, several_fields; /* some part has constraints; some part couples bodies */
  int32_t knows_stiffness;         /* constraints have got their stiffness in this step */
  int32_t carries_loads;           /* external forces act on held nodes that have no unknown, on this part */
  int32_t has_springs;             /* surfaces prescribe how some of the material moves */
  int32_t springs_measure;         /* and their springs have got their stiffness in this step */
  int32_t history_capacity, history_count;
  double *history;
} mpmi_newton;

/* An implicit step under way: the balance of forces on its nodes. */
typedef struct mpmi_balance {
  mpmi_step *step;
  const mpmi_settings *settings; /* of the step */
  const mpmi_layout *layout;     /* of the step */
  mpmi_nodes *nodes;
  mpmi_newton *newton;
  /* What the iterations have taken so far: */
  int32_t iterations, solver_used;
  int64_t linear_iterations;
  double factor_seconds, solve_seconds;
} mpmi_balance;

/* Returns how many nodes along an axis couple: those of a stencil, or with the locking remedy those of all
 * stencils of a cell. */
static inline int32_t mpmi_coupling_span(const mpmi_settings *settings) {
  return settings->grid->width + (settings->desc.locking_remedy ? settings->grid->centred : 0);
}

/* Writes the offset from a node of number `index` of those that couple with it, in the order of `place`. */
static inline void mpmi_offset_of(const mpmi_balance *balance, int32_t index, int32_t *offset) {
  const int32_t span = mpmi_coupling_span(balance->settings), reach = 2 * span - 1;
  for (int32_t k = balance->settings->grid->dim - 1; k >= 0; --k) {
    offset[k] = index % reach - (span - 1);
    index /= reach;
  }
}

/* Finds the places of the nodes of a cube of `width` in one of `edge`, the last axis fastest; returns how
 * many there are. */
static inline int32_t mpmi_cube_places(int32_t dim, int32_t width, int32_t edge, int32_t *place) {
  int32_t count = 1;
  place[0] = 0;
  for (int32_t axis = 0; axis < dim; ++axis, count *= width)
    for (int32_t n = count - 1; n >= 0; --n)
      for (int32_t k = width - 1; k >= 0; --k) place[n * width + k] = place[n] * edge + k;
  return count;
}

/* These values of matrix.held say who holds a component; one that nobody holds is an unknown, unless it moves
 * with those of inner rows. */
enum { MPMI_ROW_FREE, MPMI_ROW_PRESCRIBED, MPMI_ROW_WALL, MPMI_ROW_OUTER };
static inline int32_t mpmi_is_held(uint8_t held) {
  return held == MPMI_ROW_PRESCRIBED || held == MPMI_ROW_WALL;
}

/* Returns the slot of the node that one moves with as its image or ghost: itself for most. */
static inline int64_t mpmi_master_of(const mpmi_balance *balance, int64_t slot) {
  const int32_t tie = balance->layout->constraints.tie_of[slot];
  return tie < 0 ? slot : balance->layout->constraints.tie[tie].master;
}

/* Returns who holds a component of a node that moves by itself. */
static inline uint8_t mpmi_holder_of(const mpmi_balance *balance, int64_t slot, int32_t c) {
  const mpmi_constraints *constraints = &balance->layout->constraints;
  const int32_t tie = constraints->tie_of[slot];
  if (mpmi_moved_by(balance->nodes, constraints, slot, c)) return MPMI_ROW_PRESCRIBED;
  return tie >= 0 && constraints->tie[tie].zero[c] ? MPMI_ROW_WALL : MPMI_ROW_FREE;
}

/* Returns e = a dt (2 beta - gamma) / 2, or 0 where 2 beta < gamma: e dt (v' - v) is what a displacement has
 * beyond Newmark's rule. So damping moves by half of its impulse, as a force of contact does, and what rests
 * in contact stays at rest. */
static inline double mpmi_damping_excess(const mpmi_balance *balance) {
  const mpm_stepper_desc *desc = &balance->settings->desc;
  const double beyond = 2.0 * desc->newmark_beta - desc->newmark_gamma;
  return beyond > 0.0 ? 0.5 * desc->mass_damping * balance->step->dt * beyond : 0.0;
}

/* Returns the weight of the acceleration at the end in the displacement of a component that is damped. */
static inline double mpmi_damped_beta(const mpmi_balance *balance) {
  const mpm_stepper_desc *desc = &balance->settings->desc;
  return desc->newmark_beta + mpmi_damping_excess(balance) * desc->newmark_gamma;
}

/* Returns the acceleration that belongs to a displacement, by component of the vectors; on walls it is 0. */
static inline double mpmi_newmark_acceleration(const mpmi_balance *balance, int64_t at) {
  const mpmi_newton *newton = balance->newton;
  const double beta = balance->settings->desc.newmark_beta, gamma = balance->settings->desc.newmark_gamma;
  const double dt = balance->step->dt;
  const uint8_t held = newton->matrix.held[at];
  const double excess = mpmi_is_held(held) ? 0.0 : mpmi_damping_excess(balance);
  if (held == MPMI_ROW_WALL ||
      (held == MPMI_ROW_PRESCRIBED && balance->settings->desc.boundary_zero_acceleration))
    return 0.0;
  return (newton->vector[MPMI_U][at] - dt * newton->vector[MPMI_V0][at] -
          dt * dt * (0.5 - beta + excess * (1.0 - gamma)) * newton->vector[MPMI_A0][at]) /
         ((beta + excess * gamma) * dt * dt);
}

/* Returns the mean acceleration over the step that belongs to a displacement. */
static inline double mpmi_mean_acceleration(const mpmi_balance *balance, int64_t at) {
  const double gamma = balance->settings->desc.newmark_gamma;
  return (1.0 - gamma) * balance->newton->vector[MPMI_A0][at] +
         gamma * mpmi_newmark_acceleration(balance, at);
}

/* Returns the velocity at the end of the step that belongs to a displacement. */
static inline double mpmi_newmark_velocity(const mpmi_balance *balance, int64_t at) {
  return balance->newton->vector[MPMI_V0][at] + balance->step->dt * mpmi_mean_acceleration(balance, at);
}

/* Returns what damping adds to the acceleration of a component in the balance, for a velocity: nothing where
 * it is held, so that reactions are those of the material. */
static inline double mpmi_damping_acceleration(const mpmi_balance *balance, int64_t at, double velocity) {
  const int32_t held = mpmi_is_held(balance->newton->matrix.held[at]);
  return held ? 0.0 : balance->settings->desc.mass_damping * velocity;
}

/* Returns the inertia per mass at the end of the step, damping with it. */
static inline double mpmi_newmark_inertia(const mpmi_balance *balance, int64_t at) {
  const double acceleration = mpmi_newmark_acceleration(balance, at);
  if (!(balance->settings->desc.mass_damping > 0.0)) return acceleration;
  return acceleration + mpmi_damping_acceleration(balance, at, mpmi_newmark_velocity(balance, at));
}

/* Makes and frees the memory of implicit steps, which stays with the stepper. */
mpm_status mpmi_newton_create(const mpmi_settings *settings, mpmi_newton **out);
void mpmi_newton_free(mpmi_newton *newton, const mpmi_settings *settings); /* NULL is fine */
/* Makes room for what does not depend on the unknowns of a step, and forgets the step before. */
mpm_status mpmi_balance_prepare(mpmi_balance *balance);

/* ---- vote.c ------------------------------------------------------------------------------------------ */
/* With several parts: all have made so many exchanges of tiles since the last vote, or have failed; all
 * return the status of the first failure. With one: returns the status. */
mpm_status mpmi_vote(const mpmi_balance *balance, mpm_status status, int64_t exchanges);
/* Returns how many exchanges internal forces take. */
int64_t mpmi_force_exchanges(const mpmi_balance *balance);
/* Makes numbers that are not below 0, at most four, the largest of all parts. */
mpm_status mpmi_largest_of_parts(const mpmi_balance *balance, int32_t count, double *values);
/* Finds who has the first of some places, by so many whole numbers, the first of them before the others:
 * is_first: 1 where this part has one and it is that; all get its numbers. */
mpm_status mpmi_first_of_parts(const mpmi_balance *balance, int32_t count, int64_t *number,
                               int32_t *is_first);
/* Return the sum and the largest of the entries of a vector, over the rows of all parts; the sum is exact, so
 * that its bits do not depend on the parts. Not a number where the other parts are lost, which the next vote
 * tells. */
double mpmi_sum_rows(const mpmi_balance *balance, const double *term);
double mpmi_largest_in_rows(const mpmi_balance *balance, const double *term);

/* ---- shared_rows.c ----------------------------------------------------------------------------------- */
/* These do nothing with one part. Finds whose the numbered rows are. */
mpm_status mpmi_shared_rows_find(mpmi_balance *balance, int64_t rows);
/* Finds which are to be complete; newton->place still has the rows around each node. */
void mpmi_shared_rows_keep(mpmi_balance *balance);
/* Lets the parts know whose rows are whose, where they have changed on some part (collective); status: what
 * has happened before. */
mpm_status mpmi_shared_rows_agree(mpmi_balance *balance, int32_t changed, mpm_status status);
/* Returns 0 for rows of which only the diagonal is kept. */
static inline int32_t mpmi_is_kept(const mpmi_newton *newton, int64_t row) {
  return !newton->shared || newton->rows_of.kept[row];
}

/* ---- shared_stiffness.c ------------------------------------------------------------------------------ */
/* Makes room for what boundary blocks have to send, and empties it. */
mpm_status mpmi_shared_stiffness_begin(mpmi_balance *balance);
/* Records the stiffness of a batch in such a block. */
void mpmi_shared_stiffness_record(mpmi_balance *balance, mpmi_batch *b);
/* Sends the records to the partners, and takes theirs (collective). */
mpm_status mpmi_shared_stiffness_exchange(mpmi_balance *balance);
/* Adds what has been recorded of a block, an own one or a ghost, to the matrix, by a task. */
void mpmi_shared_stiffness_add(mpmi_balance *balance, int32_t task, int64_t block);

/* ---- unknowns.c -------------------------------------------------------------------------------------- */
/* Finds active nodes, rows and held components, from the masses and from the external forces, whose fourth
 * value is > 0 where a node has stiffness. */
mpm_status mpmi_unknowns_find(mpmi_balance *balance);
/* Sums nodal forces over the nodes that move with each row. */
void mpmi_unknowns_fold(const mpmi_balance *balance, const mpmi_nodal *forces, double *vector);

/* ---- pattern.c --------------------------------------------------------------------------------------- */
/* Makes the pattern for the active nodes as numbered, with so many rows. */
mpm_status mpmi_make_pattern(mpmi_balance *balance, int64_t rows);

/* ---- assembly.c -------------------------------------------------------------------------------------- */
/* Computes the external forces; their fourth value tells the nodes that have stiffness. */
mpm_status mpmi_external_forces(mpmi_balance *balance);
/* Computes the stress of the displacements u, and the internal force that it makes. Fails as the law does. */
mpm_status mpmi_internal_forces(mpmi_balance *balance, const double *u);
/* Computes the internal force of the stress that the particles have at the start of the step. */
mpm_status mpmi_start_forces(mpmi_balance *balance);
/* Computes the stress of the displacements u, and the stiffness at them. Fails as the law does. */
mpm_status mpmi_stiffness(mpmi_balance *balance, const double *u);

/* ---- particle_stiffness.c ---------------------------------------------------------------------------- */
/* Prepares the kernel that spreads a set's external forces, or with a nominal stress the internal ones. */
mpmi_force_scatter mpmi_force_scatter_of(const mpmi_balance *balance, int32_t m, double *tile);
/* Finds the active node at each place of the tile of a block, or -1. */
void mpmi_tile_of_unknowns(const mpmi_balance *balance, int64_t block, int32_t *to);
/* Keeps the new F of a batch as the increment by which gradients are pushed forward: those of a total
 * Lagrangian grid are over reference positions. */
void mpmi_keep_whole_F(const mpmi_balance *balance, const mpmi_batch *b);
/* Adds the internal forces of a batch to the tile of its task. */
void mpmi_add_forces(mpmi_balance *balance, mpmi_batch *b);
/* Puts the stiffness of a batch into the memory of its task; 0: it has none, or the law fails. */
int32_t mpmi_find_stiffness(mpmi_balance *balance, mpmi_batch *b);
/* Does so and adds it to the matrix. */
void mpmi_add_stiffness(mpmi_balance *balance, mpmi_batch *b);

/* ---- locking_stiffness.c ----------------------------------------------------------------------------- */
/* Makes room for the sums of all cells, and clears them. */
mpm_status mpmi_locking_stiffness_begin(mpmi_balance *balance);
/* Puts the part of theta that each particle of a batch has into the tangent, in place, and makes h [9][ld],
 * for what couples the particles of a cell. */
void mpmi_locking_stiffness_local(int32_t dim, const mpmi_law_batch *law, const double *weight,
                                  const double *volume, double *tangent, double *h);
/* The same for particles whose pressure is averaged too, with k and q; their stress becomes that of the
 * volume that the law sees. Arrays hold a batch, tensors by ld, but for nodal_stress. */
typedef struct mpmi_paired_local {
  int64_t ld, n, nodal_ld;
  const double *volume, *initial_volume, *ratio, *nodal_stress;
  double *stress, *tangent, *h, *k, *q;
} mpmi_paired_local;
void mpmi_paired_stiffness_local(int32_t dim, const mpmi_paired_local *of);
/* Holds what a particle gives to its cell: weight h F_inc^-T, F_inc^-1 with the components 3 * row + column,
 * and its new volume; where pressures are averaged weight k F_inc^-T and weight q. */
typedef struct mpmi_locking_particle {
  double h[9], inverse[9], volume, k[9], q;
  double hoop; /* of a ring 1 / r */
  int32_t paired;
} mpmi_locking_particle;
/* Returns that of the particle q of a batch, whose stiffness has been found. */
mpmi_locking_particle mpmi_locking_particle_of(const mpmi_balance *balance, const mpmi_newton_work *work,
                                               const mpmi_batch *b, int64_t q);
/* Particles whose stiffness is in the memory of a task, wherever they come from: points and ids at slot 0,
 * stiffness with leading dimension ld from slot `begin` on; who knows what each gives to its cell. */
typedef struct mpmi_stiff_particles mpmi_stiff_particles;
struct mpmi_stiff_particles {
  const mpmi_axis *axis;
  mpmi_points points;
  const int64_t *id; /* < 0: none */
  int64_t begin, n, ld;
  mpmi_locking_particle (*in_cell)(const mpmi_stiff_particles *of, const mpmi_balance *balance,
                                   const mpmi_newton_work *work, int64_t q);
  const mpmi_batch *batch; /* or */
  const double *record;
  int64_t record_ld;
};
/* Adds the stiffness of particles to the matrix, and what they give to their cells. */
void mpmi_add_stencils(mpmi_balance *balance, mpmi_newton_work *work, const mpmi_stiff_particles *of);
/* Adds particle p of a chunk to the sums of the cell whose lower corner is at this place of the tile. */
void mpmi_locking_stiffness_add(mpmi_balance *balance, const mpmi_newton_work *work, const mpmi_weights *W,
                                int64_t p, int32_t cell_place, const mpmi_locking_particle *of);
/* Adds to the matrix what couples the particles of each cell. */
void mpmi_locking_stiffness_end(mpmi_balance *balance);

/* ---- surface_loads.c --------------------------------------------------------------------------------- */
/* Finds the nodes around the markers of surfaces. */
mpm_status mpmi_surface_loads_find(mpmi_balance *balance);
/* Takes the forces of surfaces, on their areas by the nodes' displacements, off the internal forces. */
mpm_status mpmi_surface_loads_add(mpmi_balance *balance);
/* Adds to the matrix how these forces turn and grow with the areas. */
mpm_status mpmi_surface_loads_stiffen(mpmi_balance *balance);

/* ---- newton.c ---------------------------------------------------------------------------------------- */
/* Finds the displacements of the step, in vector[MPMI_U]; forces and stress are then those of them. */
mpm_status mpmi_newton_solve(mpmi_balance *balance);

/* ---- reactions.c ------------------------------------------------------------------------------------- */
/* Records the impulses of what holds nodes; then gives the prescribed particles their share. */
mpm_status mpmi_record_reactions(mpmi_balance *balance);

#endif
