/* The stepper: one grid, its nodes, many sets, one scheme. A step is a sequence of stages, one file each:
 *
 *   topology.c   sort particles into blocks, find active nodes and constraints, cut the work
 *   forces.c     external forces on particles; prescribed.c: velocities of prescribed ones
 *   p2g.c        particles -> nodes
 *   nodes.c      momentum -> velocity on free nodes
 *   boundary.c   velocity callback, walls, periodic images; hooks.c, contact.c
 *   xpic.c       corrections of the nodal velocities for XPIC
 *   locking.c    cell averages of the dilation, for the locking remedy
 *   g2p.c        nodes -> particles: velocity, position, deformation gradient, stress
 *   commit.c     the new state becomes the state, or is dropped
 *
 * step.c strings them together; newton.h has the stages of implicit steps. */
#ifndef MPMI_STEPPER_H
#define MPMI_STEPPER_H

#include "grid/constraints.h"
#include "particles/law_batch.h"
#include "particles/sort.h"
#include "transfer/kernels.h"

typedef struct mpmi_newton mpmi_newton; /* newton.h */

typedef struct mpmi_member {
  mpm_particles *set;
  mpmi_arrangement now, next; /* slots by block: of the last sort; of the one being made */
  mpmi_sorting sorting;
  double *force; /* [dim][force_ld] external force beside gravity, or NULL */
  int64_t force_ld;
  mpm_particle_fn motion; /* of prescribed particles, or NULL: they keep their velocity */
  void *motion_user;
  int32_t prescribed; /* some are in the step under way */
  double *mean;       /* [dim][mean_ld] their mean velocities where there is a motion, or NULL */
  int64_t mean_ld;
  double reaction[3]; /* impulse of prescribed particles on the material in the last step */
} mpmi_member;

/* The first failure: smallest (set, particle), then node. */
typedef struct mpmi_failure {
  mpm_status cause;
  int32_t callback_status, set;
  int64_t particle, node;
  const char *what;
} mpmi_failure;

/* What one task works with; there are as many as tasks at a time. */
typedef struct mpmi_scratch {
  double *tile, *gathered; /* tile of one block; v, dv, C of one batch */
  double *cells;           /* tile of cell sums, for the locking remedy */
  size_t cells_bytes;
  void *batch_memory;
  mpmi_failure failure;
  int32_t left_tile, removes;
  int32_t holes_restored; /* sums over the particles may not be finite */
  int64_t active;         /* nodes with mass */
  double law_seconds, weights_seconds;
  int64_t blocks_seen; /* for sampling */
} mpmi_scratch;

/* Prescribed particles of one set in one block: impulse on the material, work of moving them. */
typedef struct mpmi_prescribed_part {
  double impulse[3], work;
} mpmi_prescribed_part;

/* Prescribed particles of a step (prescribed.h). */
typedef struct mpmi_prescription {
  int32_t any;    /* in some set: then */
  double *sums;   /* [8 per node] their momentum and mass by axis; then the impulse on them by mass */
  uint8_t *block; /* [blocks] flags */
  mpmi_prescribed_part *part; /* [blocks][members] */
  int64_t sums_capacity, block_capacity, part_capacity;
} mpmi_prescription;

/* Blocks with particles, cut into tasks: task k has list[bound[k]] ... list[bound[k + 1] - 1]. */
typedef struct mpmi_cut {
  int32_t *list;
  int64_t count;
  int64_t *bound; /* [tasks + 1] */
} mpmi_cut;

enum { MPMI_COLOURS = 8, MPMI_TIE_STATE = 13 };
enum { MPMI_IDLE, MPMI_RUNNING, MPMI_BEGUN, MPMI_SOLVED }; /* phase of the step */

/* Seconds by stage, in the order of mpm_profile. */
enum {
  MPMI_TIME_SORT,
  MPMI_TIME_P2G,
  MPMI_TIME_GRID,
  MPMI_TIME_G2P,
  MPMI_TIME_LAW,
  MPMI_TIME_CALLBACKS,
  MPMI_TIME_TOTAL,
  MPMI_TIME_WEIGHTS,
  MPMI_TIME_ASSEMBLY,
  MPMI_TIME_FACTOR,
  MPMI_TIME_SOLVE,
  MPMI_TIMES
};

/* Sums over particles that belong to a state. */
typedef struct mpmi_energies {
  int32_t valid;
  mpmi_sums sums;
} mpmi_energies;

struct mpm_stepper {
  uint32_t magic;
  int32_t phase, mapped, walls_changed;
  mpm_context *context;
  mpm_grid *grid;
  mpm_stepper_desc desc;
  const mpmi_kernels *kernels;
  int32_t member_count, member_capacity;
  mpmi_member *member;
  double t, dt;
  double velocity_dt; /* over which forces change velocities: dt, or staggered the mean of two steps */
  double previous_dt; /* of the last step, for the next one's mean; 0: none */
  int64_t step, resorts, removed;
  int64_t wide_domains; /* of GIMP, at the last sort */
  double controller_dt; /* of mpm_advance; 0: none yet */

  mpmi_wall wall[6];
  mpm_particle_fn acceleration, force;
  void *acceleration_user, *force_user;
  mpm_velocity_fn velocity_bc;
  void *velocity_bc_user;
  mpm_node_fn hook[3]; /* by stage, from MPM_AFTER_P2G */
  void *hook_user[3];
  mpm_progress_fn progress;
  void *progress_user;
  mpm_solve_fn solver;
  void *solver_user;

  mpmi_blocks blocks, next_blocks;
  mpmi_constraints constraints, next_constraints;
  int64_t topology;     /* counts changes of blocks and constraints */
  int32_t *list_memory; /* of all cuts */
  int64_t list_capacity;
  int64_t *bound_memory;
  mpmi_cut cut, colour[MPMI_COLOURS];
  mpmi_scratch *scratch; /* [tasks] */
  int32_t tasks;
  void *scratch_memory;
  size_t scratch_bytes;
  mpmi_sums *block_sums; /* [blocks] of the step; added up in block order */
  int64_t block_sums_capacity;

  /* Nodes: values doubles each, [p m f .] then [v m dv .]. The other projections go into again, [p m] then [v
   * m]. extra, 4 each: the sum of the corrections of XPIC, the cell sums of the locking remedy. */
  int32_t values;
  int64_t node_capacity, again_capacity, extra_capacity; /* in doubles */
  double *node, *again, *extra;
  int64_t impulse_capacity;
  int32_t impulses; /* something can give nodes an impulse: then */
  double
      *impulse; /* [6 per node] given by walls and prescribed velocities; change of the increment by them */
  int64_t held_capacity;
  int32_t holds;      /* something may prescribe velocities of nodes: then */
  uint8_t *held;      /* [3 per node] who prescribes a component, boundary.h */
  double *held_value; /* [3 per node] */
  int64_t block_work_capacity, hook_impulse_capacity;
  double *block_work;   /* [blocks] of the host on nodes, by the part of the boundary stage at hand */
  double *hook_impulse; /* [3 per node] where there are hooks */
  mpmi_prescription prescription;
  mpmi_newton *newton; /* of implicit steps, or NULL */
  double *tie_state;   /* [ties][MPMI_TIE_STATE], boundary.c */
  int64_t tie_state_capacity;
  double mass_cut;
  int32_t nodes_valid; /* nodal fields of the last step can be shown */
  double nodes_dt;

  double impulse_by_face[6][3]; /* of the last step */
  double impulse_in_step[6][3]; /* of the one under way */
  double prescribed_work, reaction_dt;
  int32_t has_reactions;
  mpmi_failure failure;
  mpmi_energies energies; /* of the present state */
  mpm_step_info last;     /* of the last step */
  int32_t staged;         /* nodes keep force apart from momentum */
  double seconds[MPMI_TIMES];
  int32_t profiled;
  mpmi_view_record view[8];
  void *view_memory[8];
  size_t view_bytes[8];
  int64_t *active; /* slots of active nodes shown by the views */
  int64_t active_count, active_capacity;
};

/* What a transfer is made of: particles may give the nodes an affine velocity, with C or with the gradient L
 * (Taylor); and take back a blend of increment and velocity, or the velocity. */
static inline int32_t mpmi_is_affine(const mpm_stepper *s) {
  return s->desc.transfer != MPM_FLIP && s->desc.transfer != MPM_XPIC;
}
static inline int32_t mpmi_is_taylor(const mpm_stepper *s) {
  return s->desc.transfer == MPM_TPIC || s->desc.transfer == MPM_TFLIP;
}
static inline int32_t mpmi_is_mls(const mpm_stepper *s) {
  return s->desc.transfer == MPM_APIC_MLS;
}
static inline int32_t mpmi_is_blend(const mpm_stepper *s) {
  return s->desc.transfer == MPM_FLIP || s->desc.transfer == MPM_TFLIP || s->desc.transfer == MPM_AFLIP;
}
/* Does XPIC have corrections? Of order 1 it is PIC. */
static inline int32_t mpmi_corrects(const mpm_stepper *s) {
  return s->desc.transfer == MPM_XPIC && s->desc.xpic_order > 1;
}
/* Share of FLIP in the blend of a step, 0 for the other transfers. */
double mpmi_flip_share(const mpm_stepper *s);

static inline int32_t mpmi_has_hooks(const mpm_stepper *s) {
  return s->hook[0] || s->hook[1] || s->hook[2];
}

/* Errors (failure.c): failures of tasks are collected, the first decides. */
void mpmi_failure_clear(mpmi_failure *failure);
void mpmi_failure_take(mpmi_failure *first, const mpmi_failure *other);
/* Status of the step from the first failure among the scratches, with its sentence; MPM_OK when none. */
mpm_status mpmi_stepper_failure(mpm_stepper *s);
/* What a callback's status makes of the step: > 0 cuts dt, < 0 stops it. */
mpm_status mpmi_callback_cause(mpm_status status);

/* topology.c: everything that depends on where the particles are. Cannot be half done. */
mpm_status mpmi_stepper_prepare(mpm_stepper *s);
/* Only the sorting, when particles have moved out of their tiles. */
mpm_status mpmi_stepper_sort(mpm_stepper *s);
/* Like mpmi_reserve, with room for more where it has to grow. */
mpm_status mpmi_reserve_roomy(mpm_context *context, void **at, int64_t *capacity, int64_t wanted,
                              size_t size);
/* MPM_E_STATE while the set holds bad values that the host wrote through a view. */
mpm_status mpmi_usable(mpm_particles *set);
void mpmi_stepper_free_topology(mpm_stepper *s);
/* The work of a sorted state: cuts, nodes, constraints, scratch; used by prepare and by loading a state. */
mpm_status mpmi_stepper_adopt(mpm_stepper *s);

/* Stages. */
mpm_status mpmi_stage_forces(mpm_stepper *s, double t, double dt); /* external, at time t */
/* A projection of particles onto nodes and what is done with it there. Beside the one with the forces there
 * are those of velocity alone: before it for the strain of USF, after it for the strain of MUSL, and for the
 * corrections of XPIC. They go into other nodes; only those of the corrections book reactions. */
enum {
  MPMI_PROJECT_FORCES, /* momentum and force */
  MPMI_PROJECT_STRAIN, /* momentum, from the velocities at the start of the step */
  MPMI_PROJECT_TOUCH,  /* momentum and force at the start of the step, to find the contacts that are closed */
  MPMI_PROJECT_AGAIN,  /* momentum, from the new velocities */
  MPMI_PROJECT_CORRECT,      /* momentum without its affine part, from the second copy of the velocities */
  MPMI_PROJECT_ACCELERATION, /* mass times acceleration, from the second copy; for implicit steps */
  MPMI_PROJECTIONS
};
static inline int32_t mpmi_projects_forces(int32_t projection) {
  return projection == MPMI_PROJECT_FORCES || projection == MPMI_PROJECT_TOUCH;
}
static inline int32_t mpmi_is_implicit(const mpm_stepper *s) {
  return s->desc.scheme == MPM_NEWMARK;
}
/* Is the new stress there before the particles move? */
static inline int32_t mpmi_deforms_first(const mpm_stepper *s) {
  return s->desc.scheme == MPM_USF || mpmi_is_implicit(s);
}
/* The first projection of a step asks the host for prescribed velocities; later ones keep to the answer. */
static inline int32_t mpmi_asks_host(const mpm_stepper *s, int32_t projection) {
  return projection == (mpmi_deforms_first(s) ? MPMI_PROJECT_STRAIN : MPMI_PROJECT_FORCES);
}
mpm_status mpmi_stage_p2g(mpm_stepper *s, int32_t projection);
mpm_status mpmi_stage_nodes(mpm_stepper *s, int32_t projection);
/* share: of these velocities in what particles get; reactions are booked by it. */
mpm_status mpmi_stage_boundary(mpm_stepper *s, int32_t projection, double dt, double share);
/* Only finds who holds which nodes, in held and held_value; for implicit steps. */
mpm_status mpmi_stage_hold(mpm_stepper *s, double dt);
/* G2P_PROBE gathers nodal velocities into the second copy of the particles' and does nothing else;
 * G2P_DILATION measures what the locking remedy averages. */
enum {
  MPMI_G2P_MOVE = 1,
  MPMI_G2P_DEFORM = 2,
  MPMI_G2P_PROBE = 4,
  MPMI_G2P_DILATION = 8,
  /* implicit steps (newton.h): with DEFORM, forces and stiffness of the new stress on the nodes; and the
   * particles' accelerations from the nodes */
  MPMI_G2P_FORCES = 16,
  MPMI_G2P_STIFFNESS = 32,
  MPMI_G2P_ACCELERATION = 64
};
mpm_status mpmi_stage_g2p(mpm_stepper *s, int32_t what, const double *nodes, int32_t values, double dt);
/* locking.c: cell averages of the dilation that these nodal velocities make, for the pass that deforms. */
mpm_status mpmi_stage_locking(mpm_stepper *s, const double *nodes, int32_t values, double dt);
/* xpic.c: the corrections of XPIC, left in the second copy of the particles' velocities. */
mpm_status mpmi_stage_xpic(mpm_stepper *s);
/* Velocities of prescribed particles in the step. */
mpm_status mpmi_stage_motion(mpm_stepper *s, double dt);
/* Memory of the boundary stage; who will hold nodes. */
mpm_status mpmi_boundary_prepare(mpm_stepper *s);
void mpmi_boundary_free(mpm_stepper *s);
/* After a batch was moved as any other: prescribed particles of it move as they must. Returns flags of move.
 */
uint32_t mpmi_prescribed_move(mpm_stepper *s, int32_t m, int64_t block, const mpmi_move *move, int64_t begin,
                              int64_t n);
void mpmi_prescribed_commit(mpm_stepper *s);
void mpmi_prescribed_forget(mpm_stepper *s, mpmi_member *member); /* memory of a member */
void mpmi_commit(mpm_stepper *s, double dt);
void mpmi_roll_back(mpm_stepper *s);
/* Volumes, of which there is one copy, by a copy of F. */
void mpmi_make_volumes(mpm_stepper *s, int32_t copy);

/* forces.c: particles for the host's callbacks, in batches that are long because calling costs. */
enum { MPMI_PARTICLE_BATCH = 2048 };
mpm_particle_batch mpmi_particle_batch(const mpm_stepper *s, const mpm_particles *set, int64_t begin,
                                       int64_t n, double t, double dt, const mpmi_lookup *lookup);

/* tile.c: the nodes of a block and its halo. */
void mpmi_tile_load(const mpm_stepper *s, int64_t block, const double *nodes, int32_t node_values,
                    int32_t tile_values, double *tile);
/* Prefetches the nodes that the block shares with its neighbours [begin, end), itself among them. */
void mpmi_tile_fetch(const mpm_stepper *s, int64_t block, const double *nodes, int32_t values, int32_t begin,
                     int32_t end);
/* Adds the tile to the nodes and leaves it clean. */
void mpmi_tile_add(const mpm_stepper *s, int64_t block, double *nodes, int32_t values, double *tile);
int32_t mpmi_tile_nodes(const mpm_grid *grid);
/* Axes of the basis as seen from a block. */
void mpmi_block_axes(const mpm_grid *grid, const int32_t *coord, mpmi_axis *axis);
/* Where the particles of a set are, and how large; copy: of position and deformation gradient. */
mpmi_points mpmi_points_of(const mpm_particles *set, int32_t copy);

/* Runs task over [0, count), on this thread when the host's callbacks must stay on it. */
mpm_status mpmi_run_tasks(mpm_stepper *s, int32_t calls_host, int64_t count, mpm_task_fn task, void *data);

/* MPM_E_STATE while a step is under way. */
mpm_status mpmi_stepper_idle(mpm_stepper *s);

/* energy.c: energies of the present state, from the last step or summed over the particles. */
mpm_status mpmi_stepper_energies(mpm_stepper *s);
double mpmi_stable_dt_of(const mpm_stepper *s, const mpmi_sums *sums);
void mpmi_add_sums(mpmi_sums *sum, const mpmi_sums *other);
/* Gives the job the second moments of the basis at n particles, for the affine part of the angular momentum;
 * copy: of their positions. buffer: [3][ld]. */
void mpmi_sums_moments(const mpm_stepper *s, const mpm_particles *set, int32_t copy, int64_t begin, int64_t n,
                       int64_t ld, double *buffer, mpmi_sums_job *job);
/* Everything of the info that does not depend on how the step went. */
void mpmi_fill_info(const mpm_stepper *s, mpm_step_info *info);

/* profile.c */
/* Now and then makes the weights of a block once more, to know how long that takes. */
void mpmi_sample_weights(const mpm_stepper *s, mpmi_scratch *scratch, const mpmi_axis *axis, int32_t need,
                         const mpmi_points *points, int64_t begin, int64_t end);

/* Adds the seconds since *from to a stage and restarts the clock. */
void mpmi_lap(mpm_stepper *s, int32_t stage, double *from);
/* The law runs inside the tasks of a stage: its share of their time is moved from there. */
void mpmi_book_samples(mpm_stepper *s, int32_t stage);

/* step.c */
mpm_status mpmi_step(mpm_stepper *s, double dt);

#endif
