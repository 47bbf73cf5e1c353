/**
 * @file stepper.h
 * The time loop: schemes, walls and forces, steps, what they report, the step in parts, nodal fields, and the
 * linear system of implicit steps for hosts that solve it themselves.
 */
#ifndef MPM_STEPPER_H
#define MPM_STEPPER_H

#include <mpm/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How to step. Fill with mpm_stepper_desc_init(), then change what is wanted. */
typedef struct mpm_stepper_desc {
  uint32_t struct_size; /**< sizeof(mpm_stepper_desc) of the caller */
  int32_t scheme;       /**< MPM_USL (default), MPM_USF, MPM_MUSL or MPM_NEWMARK */
  int32_t transfer;     /**< MPM_FLIP (default) ... MPM_APIC_MLS; MPM_NEWMARK: MPM_FLIP with flip = 1 */
  /** Order m of MPM_XPIC, 1 (PIC) ... 5; default 2. Each order above the first projects and gathers once
   * more; these corrections obey fixed and slip walls and periodic axes. */
  int32_t xpic_order;
  /** 1 (default): x += dt sum w v (Steffen et al. 2008, eq. 10); 2: x += dt sum w v - dt^2 / 2 sum w a,
   * exact under constant acceleration (MPoint theory, eq. 37, where the last term is misprinted). v:
   * updated nodal velocity. 2 is not for staggered steps, which have that order with 1. MPM_NEWMARK moves
   * particles by the displacements that it solves for, whatever the order. */
  int32_t position_order;
  /** MPM_LOCKING_NONE (default) or, in 2-D and 3-D, MPM_LOCKING_CELL_AVERAGE: then the sets of the stepper
   * have the field "dilation_ratio". */
  int32_t locking_remedy;
  int32_t reference_positions; /**< 1: keep "reference_position" and pass it to callbacks; default 0 */
  /** MPM_NEWMARK: 1 drops the inertia: each step ends in equilibrium under the forces at its end. Velocities
   * are then displacements over dt, accelerations zero. Default 0. MPM_E_UNSUPPORTED with other schemes. */
  int32_t quasi_static;
  /** 1: particle velocities are those at t_n - dt/2 (Steffen et al. 2008, eqs 11-15), and so is the kinetic
   * energy; default 0. The host sets them so: the library does not shift velocities. Forces change them over
   * the mean of this step and the one before, in the first step over its dt, so that dt may change. Positions
   * and strain follow over dt. MPM_E_UNSUPPORTED with position_order = 2. */
  int32_t staggered;
  /** Acceleration of nodes whose velocity the host or a particle prescribes. 0 (default): that which brings
   * them from the projected to the prescribed velocity (Steffen et al. 2008, eq. 30), or with MPM_NEWMARK
   * that of its rule; 1: zero. Nodes that walls hold have none in either case: a slip wall is a symmetry
   * plane, on which the projected velocity is zero too. */
  int32_t boundary_zero_acceleration;
  double flip; /**< per step, 1 (default) FLIP ... 0 PIC; MPM_FLIP, MPM_TFLIP, MPM_AFLIP */
  /** Rate beta >= 0, 1/time, of a blend free of dt (MPoint theory, eqs 58-59), for the transfers of flip: the
   * step's share of FLIP is flip * max(0, 1 - beta dt). Default 0. */
  double pic_damping;
  double gravity[3];    /**< acceleration of all particles, length/time^2; default 0 */
  double newmark_beta;  /**< default 1/4; with gamma 1/2 as Guilkey & Weiss 2003, eqs 14-15 */
  double newmark_gamma; /**< default 1/2; larger values damp high frequencies */
  /** Bound on the displacement increment against the largest of the step, both measured by the diagonal of
   * the stiffness, in which light nodes count little: Guilkey & Weiss 2003, eq. 13, eps_d. Newton iterations
   * end when the bounds on displacement, energy and residual hold together. Default 1e-8. */
  double newton_tolerance_displacement;
  double newton_tolerance_energy;   /**< on increment times residual: the same, eps_e; default 1e-14 */
  double newton_tolerance_residual; /**< on the residual over a scale that includes reactions; default 1e-8 */
  double newton_residual_floor;     /**< norm of nodal forces up to which the residual holds; default 0 */
  int32_t newton_max_iterations;    /**< then MPM_NOT_CONVERGED; default 20 */
  int32_t linear_solver;            /**< MPM_SOLVER_AUTO (default) ... MPM_SOLVER_HOST */
  double linear_tolerance;          /**< ||K x - b|| / ||b||; 0 (default): chosen by the Newton iteration */
  int32_t linear_max_iterations;    /**< 0 (default): chosen by the solver */
  int32_t reserved;                 /**< 0 */
} mpm_stepper_desc;

/**
 * What a step did, or the state as it is. The caller sets struct_size. Energies and momenta are the
 * particles'; the angular momentum is about the origin and includes the part of the matrices that transfers
 * carry ("velocity_gradient"). Entries of unused axes are 0. After a failed step the sums are those of the
 * state that was kept.
 */
typedef struct mpm_step_info {
  uint32_t struct_size;      /**< sizeof(mpm_step_info) of the caller */
  int32_t cause;             /**< status of the failure, MPM_OK if none */
  int32_t callback_status;   /**< what a callback returned when it was not 0, else 0 */
  int32_t newton_iterations; /**< linear solves of the step; 0 for explicit schemes, and at rest */
  int32_t linear_solver;     /**< MPM_SOLVER_* that was used; 0 for explicit schemes */
  /** Set of the first failure, numbered in order of mpm_stepper_add(), or -1. The first is the smallest
   * (set, particle) of those that failed, so that reports repeat. */
  int32_t set;
  int64_t step;         /**< steps committed, counted on from mpm_stepper_set_time() */
  int64_t active_nodes; /**< nodes with mass in the step */
  int64_t removed;      /**< particles that left through MPM_WALL_OPEN since creation of the stepper */
  int64_t resorts;      /**< how often particles were sorted anew since creation of the stepper */
  int64_t particle;     /**< id of the particle that failed, or -1 */
  /** Node that failed, or -1: its lexicographic number over the grid with one ghost layer per side,
   * ((ix+1)*(cells_y+3)+(iy+1))*(cells_z+3)+(iz+1) with unused axes left out. */
  int64_t node;
  int64_t linear_iterations; /**< of the linear solver, summed over the step */
  double t;                  /**< time of the state */
  double dt;                 /**< of the step that was tried; 0 before the first */
  /** After success the stable dt of the new state; with MPM_NEWMARK 2 dt after at most 4 iterations, else dt.
   * After a failure 0.6 dt. */
  double dt_suggested;
  double residual;       /**< last relative residual of the Newton iteration; 0 for explicit schemes */
  double kinetic_energy; /**< sum m v.v / 2 */
  double strain_energy;  /**< sum energy * initial_volume; NaN when a law has none */
  /** Work during the step of gravity, acceleration and force callbacks, applied_force, node hooks, prescribed
   * nodal velocities and prescribed particles. */
  double external_work;
  /** (kinetic + strain) before the step + external_work - (kinetic + strain) after; NaN where the strain
   * energy is. */
  double dissipation;
  double momentum[3];         /**< sum m v */
  double angular_momentum[3]; /**< sum m x cross v; 2-D: about z, in [2]; 1-D: 0 */
} mpm_step_info;

/**
 * Particles of one set that a force is wanted for. Arrays are [components][ld], of which the first n items of
 * each component count; the memory is the library's and valid during the call.
 */
typedef struct mpm_particle_batch {
  uint32_t struct_size;             /**< sizeof(mpm_particle_batch) of the library */
  int32_t dim;                      /**< dimension of the grid */
  int64_t n;                        /**< particles, inert slots included */
  int64_t ld;                       /**< from component c to c + 1, in elements; >= n */
  double t;                         /**< time for which the value is wanted: start of the step; forces of
                                       MPM_NEWMARK: its end, and the start where accelerations are to be found */
  double dt;                        /**< of the step */
  const int64_t *id;                /**< [ld] ids, < 0 for inert slots */
  const double *position;           /**< [dim][ld] at the start of the step, wrapped on periodic axes */
  const double *reference_position; /**< [dim][ld], or NULL without reference_positions */
  const double *velocity;           /**< [dim][ld] at the start of the step */
  const double *mass;               /**< [ld] */
  const double *volume;             /**< [ld] at the start of the step */
  const mpm_particles *particles;   /**< the set, for comparison; it must not be called */
  const void *lookup;               /**< for mpm_batch_field() */
} mpm_particle_batch;

/**
 * Active nodes of the grid. Arrays are [components][ld], of which the first n items of each component count;
 * the memory is the library's and valid during the call.
 */
typedef struct mpm_node_batch {
  uint32_t struct_size;   /**< sizeof(mpm_node_batch) of the library */
  int32_t dim;            /**< dimension of the grid */
  int32_t body;           /**< velocity field of the nodes; 0 for now */
  int32_t reserved;       /**< 0 */
  int64_t n;              /**< nodes */
  int64_t ld;             /**< from component c to c + 1, in elements; >= n */
  double t;               /**< time for which the value is wanted */
  double dt;              /**< of the step */
  const int64_t *index;   /**< [dim][ld] of the basis function, -1 ... cells + 1. Ghosts lie outside 0 ...
                             cells; open knots have none, and other functions there: go by position */
  const double *position; /**< [dim][ld] origin + index * spacing; open knots: the Greville points */
  const double *mass;     /**< [ld] */
} mpm_node_batch;

/** A vector per particle (mt): add[c * ld + i] += value, c < dim; several sources add to the same array.
 * Returns 0; > 0 to ask for a smaller dt (MPM_CUT_DT); < 0 to stop (MPM_E_CALLBACK). */
typedef mpm_status (*mpm_particle_fn)(void *user, const mpm_particle_batch *batch, double *add);

/**
 * Prescribes nodal velocities (mt). On the nodes and axes to hold, set prescribed[c * ld + i] = 1 (preset 0)
 * and velocity[c * ld + i] = mean velocity of the step, so that the displacement increment is dt * velocity
 * in every scheme. Where several prescribe one node and axis, the first of these wins: this callback,
 * prescribed particles (their mass-weighted mean), walls; the reaction is booked to the winner. Asked once
 * per step, in the first projection of particles onto nodes; further ones keep to the answer. Returns as
 * mpm_particle_fn.
 */
typedef mpm_status (*mpm_velocity_fn)(void *user, const mpm_node_batch *batch, uint8_t *prescribed,
                                      double *velocity);

/**
 * Reads and changes the nodal velocity[dim][ld] and force[dim][ld] at a stage of an explicit step (mt). It is
 * shown every node that moves by itself: periodic images and mirrored ghosts are counted in with the node
 * that they follow, in mass, velocity and force, and what is written acts on all of them.
 *
 * - MPM_AFTER_P2G: velocity is the projected one, force is zero; what is written is added to the force.
 * - MPM_AFTER_FORCES: the same velocity; force is the whole of it, and may be replaced.
 * - MPM_AFTER_VELOCITY: velocity is the updated one, under walls and prescribed velocities, which do not act
 *   again; a change is an impulse of mass times change. force, reactions included, is for reading: what is
 *   written there is ignored.
 *
 * A change of the projected velocity moves particles, and is given to them as far as the transfer takes nodal
 * velocities: not with MPM_FLIP and flip = 1. Values that are left as they are change no bit; with
 * MPM_APIC_MLS a hook keeps forces apart, as steps in parts do. Hooks run in the projection that has the
 * forces: not in the second one of MPM_MUSL, and not in the first one of MPM_USF, which gives the strain, so
 * that they act on the strain of later steps only. Work: impulse times new nodal velocity, in external_work.
 * MPM_NONFINITE names the node. Returns as mpm_particle_fn.
 */
typedef mpm_status (*mpm_node_fn)(void *user, const mpm_node_batch *batch, double *velocity, double *force);

/** Called at least once in each step before it is committed, and after each Newton iteration, with what is
 * known so far. Returns 0 to go on; > 0 to end the call with MPM_CANCELLED, < 0 with MPM_E_CALLBACK; the
 * step is then not committed. */
typedef mpm_status (*mpm_progress_fn)(void *user, const mpm_step_info *info);

/**
 * Solves matrix * solution = rhs; both have the rows of mpm_operator_get_info(), solution is preset to the
 * best guess known. tolerance: wanted ||K x - b|| / ||b||. *iterations: what is to be counted in
 * linear_iterations. Returns 0; > 0 if not solved (MPM_CUT_DT); < 0 to stop (MPM_E_CALLBACK).
 */
typedef mpm_status (*mpm_solve_fn)(void *user, const mpm_operator *matrix, const double *rhs,
                                   double *solution, double tolerance, int64_t *iterations);

/** Fills desc with the defaults. struct_size: sizeof(mpm_stepper_desc) of the caller. MPM_E_ARG if it is
 * smaller than the first released struct. */
MPM_API mpm_status mpm_stepper_desc_init(mpm_stepper_desc *desc, uint32_t struct_size);

/** Makes a stepper at t = 0 and step 0, without sets, with MPM_WALL_NONE on all faces. desc is copied and
 * may be NULL for the defaults. *out is NULL unless MPM_OK is returned. MPM_E_ARG: a bad value, or a grid
 * of another context. MPM_E_UNSUPPORTED: a combination that is not offered; the error text says what to
 * use instead. */
MPM_API mpm_status mpm_stepper_create(mpm_context *context, mpm_grid *grid, const mpm_stepper_desc *desc,
                                      mpm_stepper **out);

/** Frees the stepper; its sets live on and are free for another. MPM_E_STATE while a view of its nodal
 * fields is out or a staged step is under way. NULL is fine. */
MPM_API mpm_status mpm_stepper_destroy(mpm_stepper *stepper);

/** Adds a set to the time loop; the host keeps owning it. All sets share one velocity field. MPM_E_STATE:
 * the set is in a stepper already. MPM_E_ARG: it is on another grid. */
MPM_API mpm_status mpm_stepper_add(mpm_stepper *stepper, mpm_particles *particles);

/** Takes a set out of the time loop. MPM_E_NOT_FOUND: it is not in this stepper. */
MPM_API mpm_status mpm_stepper_remove(mpm_stepper *stepper, mpm_particles *particles);

/** Replaces the descriptor between steps; any field may change, the scheme too. Errors as
 * mpm_stepper_create(), and MPM_E_STATE during a staged step. */
MPM_API mpm_status mpm_stepper_configure(mpm_stepper *stepper, const mpm_stepper_desc *desc);

/** Sets the time and the number of steps counted. MPM_E_ARG: t not finite or step < 0. */
MPM_API mpm_status mpm_stepper_set_time(mpm_stepper *stepper, double t, int64_t step);

/**
 * Moves the prescribed particles of a set (platens, pistons): mean_velocity (mt) adds the mean velocity u of
 * the coming step to zeros and is called at its start for the particles of the set, unless none is
 * prescribed; what it gives to others is ignored. NULL: none; they keep their velocity.
 *
 * On its prescribed axes a particle moves by dt u and ends with the velocity u, with every transfer; the
 * nodes to which it gives mass move with u too, or with the mean of several by that mass. On other axes, and
 * in deformation and stress, it is a particle like others. MPM_NONFINITE names the particle. Set again after
 * loading a state. MPM_E_NOT_FOUND: the set is not in this stepper.
 */
MPM_API mpm_status mpm_stepper_set_motion(mpm_stepper *stepper, mpm_particles *particles,
                                          mpm_particle_fn mean_velocity, void *user);

/** Sets what a face (MPM_X_MIN ...) does: kind is MPM_WALL_NONE ... MPM_WALL_FRICTION. friction: the
 * Coulomb coefficient, >= 0, for MPM_WALL_FRICTION; otherwise not used. Such a wall is unilateral: its
 * normal impulse only pushes, and its tangential impulse is at most friction times that. MPM_E_ARG: a
 * face that the grid does not have, a periodic one, or a bad value. MPM_E_UNSUPPORTED: friction with
 * MPM_NEWMARK. */
MPM_API mpm_status mpm_stepper_set_wall(mpm_stepper *stepper, int32_t face, int32_t kind, double friction);

/** Sets the callback that adds accelerations of particles, length/time^2 (b of MPoint theory, eq. 21). It is
 * called for every set; NULL: none. */
MPM_API mpm_status mpm_stepper_set_acceleration(mpm_stepper *stepper, mpm_particle_fn fn, void *user);

/** Sets the callback that adds forces on particles, mass length/time^2 (f^app of MPoint theory, eq. 21). It
 * is called for every set; NULL: none. */
MPM_API mpm_status mpm_stepper_set_force(mpm_stepper *stepper, mpm_particle_fn fn, void *user);

/** Sets the callback that prescribes nodal velocities; NULL: none. */
MPM_API mpm_status mpm_stepper_set_velocity_bc(mpm_stepper *stepper, mpm_velocity_fn fn, void *user);

/** Sets the hook of a stage, MPM_AFTER_P2G ... MPM_AFTER_VELOCITY; NULL: none. In a step in parts all run in
 * mpm_step_grid(), after what the host has written itself. MPM_E_ARG: no such stage. MPM_E_UNSUPPORTED with
 * MPM_NEWMARK. */
MPM_API mpm_status mpm_stepper_set_node_hook(mpm_stepper *stepper, int32_t stage, mpm_node_fn fn, void *user);

/** Sets the solver of MPM_SOLVER_HOST; NULL: none. */
MPM_API mpm_status mpm_stepper_set_linear_solver(mpm_stepper *stepper, mpm_solve_fn fn, void *user);

/** Sets the progress callback; NULL: none. It runs on the calling thread. */
MPM_API mpm_status mpm_stepper_set_progress(mpm_stepper *stepper, mpm_progress_fn fn, void *user);

/**
 * Stable dt of an explicit step from the present state, at CFL number 1 (MPoint theory, eqs 45-46):
 * 1 / max over particles and axes of (|v_k| + c) / h_k, where c is the law's current wave speed, and at most
 * h^2 / (2 dim nu) where a law reports a kinematic viscosity nu; h is the smallest spacing. Explicit steps
 * want a share of it. Infinite where nothing moves and no law has waves. Calls the laws. MPM_E_STATE if there
 * are no particles or a view is out.
 */
MPM_API mpm_status mpm_stable_dt(mpm_stepper *stepper, double *dt);

/**
 * One step of size dt > 0. Any status but MPM_OK leaves particles and time bit-identical to before. info may
 * be NULL; it is filled on success and on failure.
 *
 * - MPM_CUT_DT, MPM_INVERTED, MPM_NONFINITE, MPM_NOT_CONVERGED, MPM_SINGULAR: try a smaller dt.
 * - MPM_OFF_GRID: a particle would leave through an MPM_WALL_NONE face.
 * - MPM_CANCELLED: by the progress callback.
 * - MPM_E_ARG: dt not finite or not > 0.
 * - MPM_E_CALLBACK: a callback or the host's executor failed.
 * - MPM_E_STATE: a view is out, a staged step is under way, or a set has values to be repaired.
 */
MPM_API mpm_status mpm_step(mpm_stepper *stepper, double dt, mpm_step_info *info);

/** How mpm_advance() chooses its sub-steps. */
typedef struct mpm_advance_desc {
  uint32_t struct_size; /**< sizeof(mpm_advance_desc) of the caller */
  int32_t reserved;     /**< 0 */
  double t_end;         /**< time to reach, not before the present one */
  double cfl;           /**< explicit: share of mpm_stable_dt(), in (0, 1], default 0.5; implicit: ignored */
  double dt_first;      /**< most that the first sub-step takes; 0 (default): the controller's */
  double dt_min;        /**< sub-steps are not cut below it; 0 (default): no bound */
  double dt_max;        /**< largest sub-step; 0 (default): no bound */
  int64_t max_steps;    /**< sub-steps of this call; 0 (default): no limit */
} mpm_advance_desc;

/** Fills desc with the defaults; t_end must be set. struct_size: sizeof(mpm_advance_desc) of the caller.
 * MPM_E_ARG if it is smaller than the first released struct. */
MPM_API mpm_status mpm_advance_desc_init(mpm_advance_desc *desc, uint32_t struct_size);

/**
 * Steps to t_end exactly. Statuses 1..5 cut dt to 0.6 of it and try again, success lets it grow; the
 * controller's dt is part of the saved state. On failure the state is that of the last committed sub-step,
 * and the status is its cause. info may be NULL; it is that of the last sub-step tried. MPM_OK with t < t_end
 * when max_steps ran out. Errors as mpm_step(); MPM_E_ARG: t_end before the present time, or a bad value.
 */
MPM_API mpm_status mpm_advance(mpm_stepper *stepper, const mpm_advance_desc *desc, mpm_step_info *info);

/** Wall-clock seconds spent in steps since creation or the last reset, by stage. The caller sets
 * struct_size. */
typedef struct mpm_profile {
  uint32_t struct_size; /**< sizeof(mpm_profile) of the caller */
  int32_t reserved;     /**< 0 */
  double sort;          /**< sorting particles, activating nodes */
  double p2g;           /**< weights, particles to grid */
  double grid;          /**< nodal update, walls, prescribed velocities */
  double g2p;           /**< grid to particles */
  double law;           /**< laws within g2p and assembly: from samples; their tangents are assembly */
  double assembly;      /**< residual and matrix */
  double factor;        /**< factorisation, set-up of preconditioners */
  double solve;         /**< linear solves */
  double callbacks;     /**< the host's callbacks */
  double total;         /**< whole steps */
  double weights;       /**< of p2g and g2p, weights of the basis: from samples */
} mpm_profile;

/** Copies the times into out, then sets them to zero if reset is not 0. Costs the steps one clock read per
 * stage. */
MPM_API mpm_status mpm_stepper_profile(mpm_stepper *stepper, int32_t reset, mpm_profile *out);

/** The info of the state as it is, also before the first step; what belongs to a step is that of the last
 * one. MPM_E_STATE while a set is mapped for writing. */
MPM_API mpm_status mpm_stepper_info(const mpm_stepper *stepper, mpm_step_info *info);

/** History of the last implicit step: ||residual|| / scale (the scale includes reactions) from before the
 * first solve to the converged or failed end. *count: how many there are; the first capacity of them are
 * copied into residual, which may be NULL when capacity is 0. Kept until the next step; *count is 0 after
 * explicit ones. */
MPM_API mpm_status mpm_stepper_residuals(const mpm_stepper *stepper, int32_t capacity, double *residual,
                                         int32_t *count);

/** First part of an explicit step in parts: particles to grid, and forces; with MPM_USF before them strain
 * and stress of the step, for which the callbacks of prescribed velocities are asked here. Until
 * mpm_step_end() or mpm_step_abort() the host may map nodal fields between the parts, and change "velocity"
 * and "force". Errors as mpm_step(); MPM_E_UNSUPPORTED with MPM_NEWMARK. A part that fails with any status
 * but MPM_E_STATE or MPM_E_ARG aborts the step. */
MPM_API mpm_status mpm_step_begin(mpm_stepper *stepper, double dt);

/** Second part: nodal velocities, walls, prescribed velocities. MPM_E_STATE unless it follows
 * mpm_step_begin(). */
MPM_API mpm_status mpm_step_grid(mpm_stepper *stepper);

/** Last part: grid to particles, stress, commit. info may be NULL. MPM_E_STATE unless it follows
 * mpm_step_grid(). The three parts in a row give the same bits as mpm_step(), except with MPM_APIC_MLS, where
 * a whole step fuses force and momentum: there they agree to rounding. */
MPM_API mpm_status mpm_step_end(mpm_stepper *stepper, mpm_step_info *info);

/** Drops the step that was begun; particles and time are as before it. MPM_E_STATE if none was, or a view
 * of nodal fields is out. */
MPM_API mpm_status mpm_step_abort(mpm_stepper *stepper);

/**
 * Lends a field of the active nodes, of a staged step while one is under way and of the last step otherwise:
 * "index" (I64, dim components), "mass" (1), "position" "velocity" "force" "acceleration" "reaction" (F64,
 * dim). body: velocity field, 0. "reaction" is the force by which walls and prescribed velocities act on a
 * node. Until mpm_view_release() steps and their parts return MPM_E_STATE. The view's struct_size is set by
 * the caller. Periodic images and mirrored ghosts are listed beside the nodes that they follow. MPM_E_STATE:
 * nothing stepped yet, or MPM_WRITE outside a staged step. MPM_E_NOT_FOUND: unknown field or body. MPM_E_ARG:
 * MPM_WRITE on a field other than "velocity" and "force". MPM_E_UNSUPPORTED: "force" or "acceleration" after
 * a whole step of MPM_APIC_MLS, which does not keep them: use a staged step, or MPM_APIC.
 */
MPM_API mpm_status mpm_grid_map(mpm_stepper *stepper, int32_t body, const char *field, int32_t access,
                                mpm_view *view);

/** force[dim]: that which the wall at a face exerts on the material, mean over the last step; with
 * MPM_NEWMARK that at its end. MPM_E_ARG: no such face. MPM_E_STATE before the first step. */
MPM_API mpm_status mpm_stepper_wall_reaction(const mpm_stepper *stepper, int32_t face, double *force);

/** force[dim]: that which the prescribed particles of a set exert on the material, mean over the last step,
 * with MPM_NEWMARK at its end, on the axes on which they are prescribed: what holds them, less their own
 * inertia, weight and external forces. 0 for a set without such particles. MPM_E_NOT_FOUND: the set is not in
 * this stepper. MPM_E_STATE before the first step. */
MPM_API mpm_status mpm_stepper_particles_reaction(const mpm_stepper *stepper, const mpm_particles *prescribed,
                                                  double *force);

/** A linear system. The caller sets struct_size; the arrays are the library's and valid until the solve
 * callback returns. */
typedef struct mpm_operator_info {
  uint32_t struct_size;      /**< sizeof(mpm_operator_info) of the caller */
  int32_t block;             /**< rows per node where none is prescribed */
  int32_t symmetric;         /**< 1: the matrix is symmetric */
  int32_t positive_definite; /**< 1: expected to be positive definite, which is not checked */
  int64_t rows;              /**< rows and columns; prescribed ones are eliminated */
  int64_t nonzeros;          /**< stored entries */
  int64_t pattern_id;        /**< equal while the sparsity is */
  int64_t ld;                /**< from component c to c + 1 of position, in elements; >= rows */
  const int64_t *node;       /**< [rows] number of the node of each row, as mpm_step_info.node */
  const int32_t *component;  /**< [rows] axis of each row */
  const double *position;    /**< [dim][ld] position of the node of each row, for near-null spaces */
} mpm_operator_info;

/** Describes the system. Callable from within the solve callback only, as are the two functions below. */
MPM_API mpm_status mpm_operator_get_info(const mpm_operator *matrix, mpm_operator_info *info);

/** y = matrix * x; both have the rows of the system and do not overlap. */
MPM_API mpm_status mpm_operator_apply(const mpm_operator *matrix, const double *x, double *y);

/** Lends the matrix by compressed rows, both triangles, columns ascending: row r has the entries
 * (*row_start)[r] ... (*row_start)[r + 1] - 1. The library's memory, valid until the solve callback
 * returns. */
MPM_API mpm_status mpm_operator_csr(const mpm_operator *matrix, const int64_t **row_start,
                                    const int32_t **column, const double **value);

#ifdef __cplusplus
}
#endif

#endif
