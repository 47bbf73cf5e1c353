/**
 * @file stepper.h
 * The time loop: schemes, walls and forces, steps, what they report, the step in parts, and nodal fields.
 */
#ifndef MPM_STEPPER_H
#define MPM_STEPPER_H

#include <mpm/operator.h>
#include <mpm/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Options of a stepper. Fill the struct with mpm_stepper_desc_init(), then change what is wanted. */
typedef struct mpm_stepper_desc {
  uint32_t struct_size; /**< sizeof(mpm_stepper_desc) of the caller */
  int32_t scheme;       /**< MPM_USL (default), MPM_USF, MPM_MUSL or MPM_NEWMARK */
  /** MPM_FLIP (default) to MPM_FMPM. MPM_NEWMARK takes MPM_FLIP with flip = 1 only. */
  int32_t transfer;
  /** Order m of MPM_XPIC, 1 (PIC) to 5, or k of MPM_FMPM, 1 (PIC) to 32; default 2. Each order above the
   * first projects and gathers once more. These corrections obey fixed and slip walls and periodic axes,
   * those of MPM_FMPM prescribed velocities as well; contact acts before them, with its whole impulse. */
  int32_t xpic_order;
  /** Order of the update of positions; v is the updated nodal velocity and w a weight. 1 (default): x += dt
   * sum w v (Steffen et al. 2008, eq. 10). 2: x += dt sum w v - dt^2 / 2 sum w a, which is exact under
   * constant acceleration (MPoint theory, eq. 37, where the last term is misprinted); it is not for staggered
   * steps, which have that order with 1. MPM_NEWMARK moves particles by the displacements that it solves for,
   * whatever the order. */
  int32_t position_order;
  /** MPM_LOCKING_NONE (default) or, in 2-D and 3-D, MPM_LOCKING_CELL_AVERAGE. With the latter the sets of the
   * stepper have the field "dilation_ratio". Not with MPM_PLANE_STRESS. */
  int32_t locking_remedy;
  int32_t reference_positions; /**< 1: keeps "reference_position" and shows it to callbacks; default 0.
                                    With total_lagrangian = 1 that is so anyway */
  /** 1: MPM_NEWMARK drops the inertia, so that each step ends in equilibrium under the forces at its end.
   * Velocities are then displacements over dt, and accelerations are zero. Default 0. MPM_E_UNSUPPORTED with
   * other schemes. */
  int32_t quasi_static;
  /** 1: particle velocities are those at t_n - dt/2 (Steffen et al. 2008, eqs 11-15), and so is the kinetic
   * energy; default 0. The host sets velocities of that time, because the library does not shift them. Forces
   * change velocities over the mean of this dt and the one before, in the first step over its dt, so that dt
   * may change. Positions and strain follow over dt. MPM_E_UNSUPPORTED with position_order = 2. */
  int32_t staggered;
  /** Acceleration of nodes whose velocity the host or a particle prescribes. 0 (default): the one that brings
   * them from the projected to the prescribed velocity (Steffen et al. 2008, eq. 30), or with MPM_NEWMARK
   * that of its rule; 1: zero. Nodes that walls hold have none in either case: a slip wall is a symmetry
   * plane, on which the projected velocity is zero too. */
  int32_t boundary_zero_acceleration;
  /** Share of FLIP per step for MPM_FLIP, MPM_TFLIP and MPM_AFLIP, and between the steps that xpic_every
   * counts, from 1 (default, FLIP) to 0 (PIC). */
  double flip;
  /** Rate beta >= 0, 1/time, of a blend that does not depend on dt (MPoint theory, eqs 58-59), for the
   * transfers of flip: the step's share of FLIP is flip * max(0, 1 - beta dt). Default 0. */
  double pic_damping;
  double gravity[3];    /**< acceleration of all particles, length/time^2; default 0. Of
                               MPM_AXISYMMETRIC along the axis alone */
  double newmark_beta;  /**< Newmark's beta: default 1/4, as Guilkey & Weiss 2003, eqs 14-15 */
  double newmark_gamma; /**< Newmark's gamma: default 1/2, as there; larger values damp high frequencies */
  /** Newton iterations end when the displacement increment is at most this share of the largest of the step,
   * both measured by the diagonal of the stiffness, in which light nodes count little (Guilkey & Weiss 2003,
   * eq. 13, eps_d), and the next two bounds hold as well. Default 1e-8. */
  double newton_tolerance_displacement;
  /** They end when the increment times the residual is at most this share of the first of the step (eps_e in
   * the same eq. 13), and the other two bounds hold. Default 1e-14. */
  double newton_tolerance_energy;
  /** They end when the norm of the residual is at most this share of a scale that includes reactions, and the
   * other two bounds hold. Default 1e-8. */
  double newton_tolerance_residual;
  /** Norm of the residual, a force, up to which its bound holds whatever the scale. Default 0. */
  double newton_residual_floor;
  int32_t newton_max_iterations; /**< iterations after which a step is MPM_NOT_CONVERGED; default 20 */
  int32_t linear_solver;         /**< MPM_SOLVER_AUTO (default) to MPM_SOLVER_HOST */
  double linear_tolerance;       /**< ||K x - b|| / ||b||; 0 (default): the Newton iteration chooses it */
  int32_t linear_max_iterations; /**< most iterations of a linear solve; 0 (default): the solver chooses */
  /** 1: with MPM_MUSL particles move by the projected velocities, which strain them too: x += dt sum w v,
   * with the v of the second projection. Bodies in sustained tension, whose particles otherwise move by
   * more than they are strained by (theory, section 11.1), are stable then, but for a nearly incompressible
   * one whose volume is forced to grow. 0 (default): they move by the updated velocities, as Sulsky et al.
   * 1995. MPM_E_UNSUPPORTED with other schemes, which have no such velocities after the update. Since 0.2.0,
   * in the place of `reserved`. */
  int32_t projected_positions;
  /** Local damping alpha of Cundall 1987, in [0, 1); default 0. In explicit steps each component of a node's
   * whole unbalanced force f, ties to images and the hook MPM_AFTER_FORCES counted in, becomes
   * f - alpha |f| sign(v), where v is the projected velocity. Bodies come to rest under dead loads, and
   * reactions are those of the material: what walls or prescribed velocities hold is not damped, and contact
   * acts after it. It also slows free fall and rigid motion, to (1 - alpha) g. MPM_E_UNSUPPORTED with
   * MPM_NEWMARK. Since 0.2.0. */
  double local_damping;
  /** Damping in proportion to mass, a >= 0 in 1/time; default 0: the force -a m v on nodes, for a share of
   * a / (2 omega) of critical damping. In explicit steps v is the mean of the velocities before and after, by
   * which the stable dt stays as it is; with MPM_NEWMARK it is that at the end of the step. It acts where
   * local_damping does. MPM_E_UNSUPPORTED with quasi_static. Since 0.2.0. */
  double mass_damping;
  /** For MPM_XPIC and MPM_FMPM: every so many steps are of the order xpic_order, those whose number
   * (mpm_step_info::step, counted from 1 or on from mpm_stepper_set_time()) is a multiple of this; all others
   * are those of MPM_FLIP, with flip and pic_damping. Steps that fail have no number, and a loaded state goes
   * on with its own. 1, and 0 (default), which means 1: every step is of that order. MPM_E_UNSUPPORTED: above
   * 2 with MPM_FMPM of an order above 1 and MPM_USF or MPM_MUSL, where waves grow. Since 0.2.0. */
  int32_t xpic_every;
  int32_t reserved; /**< 0 */
} mpm_stepper_desc;

/**
 * What a step did, or the state as it is. The caller sets struct_size. Energies and momenta are the
 * particles'; the angular momentum is about the origin and includes the part of the matrices that transfers
 * carry ("velocity_gradient"). Entries of unused axes are 0. After a failed step the sums are those of the
 * state that was kept. Units are the host's: energies force * length, momenta mass * length/time.
 */
typedef struct mpm_step_info {
  uint32_t struct_size;      /**< sizeof(mpm_step_info) of the caller */
  int32_t cause;             /**< status of the failure, MPM_OK if there was none */
  int32_t callback_status;   /**< what a callback returned when it was not 0, else 0 */
  int32_t newton_iterations; /**< linear solves of the step; 0 for explicit schemes, and at rest */
  int32_t linear_solver;     /**< MPM_SOLVER_* that was used; 0 for explicit schemes */
  /** Set of the first failure, numbered in order of mpm_stepper_add(), or -1. The first is the smallest
   * (set, particle) of those that failed, so that reports repeat. */
  int32_t set;
  int64_t step; /**< number of committed steps, counted on from mpm_stepper_set_time() */
  /** Number of nodes with mass in the step; of one that failed before they were counted, that of the step
   * before. */
  int64_t active_nodes;
  int64_t removed;  /**< particles that left through MPM_WALL_OPEN since the stepper was made */
  int64_t resorts;  /**< how often particles were sorted anew since the stepper was made */
  int64_t particle; /**< id of the particle that failed, or -1 */
  /** Node that failed, or -1: its lexicographic number over the grid with one ghost layer per side,
   * ((ix+1)*(cells_y+3)+(iy+1))*(cells_z+3)+(iz+1) with unused axes left out. */
  int64_t node;
  int64_t linear_iterations; /**< iterations of the linear solver, summed over the step */
  double t;                  /**< time of the state */
  double dt;                 /**< size of the step that was tried; 0 before the first */
  /** After success the stable dt of the new state, or with MPM_NEWMARK 2 dt if there were at most 4
   * iterations and else dt. After a failure 0.6 dt. */
  double dt_suggested;
  double residual;       /**< last relative residual of the Newton iteration; 0 for explicit schemes */
  double kinetic_energy; /**< sum m v.v / 2 */
  double strain_energy;  /**< sum energy * initial_volume; NaN when a law has none */
  /** Work during the step of gravity, acceleration and force callbacks, applied_force, surfaces, node hooks,
   * prescribed nodal velocities and prescribed particles. */
  double external_work;
  /** (kinetic + strain) before the step + external_work - (kinetic + strain) after; NaN where the strain
   * energy is. */
  double dissipation;
  double momentum[3];         /**< sum m v; along the radius of MPM_AXISYMMETRIC 0 */
  double angular_momentum[3]; /**< sum m x cross v; in 2-D about z, in [2]; in 1-D and MPM_AXISYMMETRIC 0 */
  /** Sum of external_work over all committed steps since the stepper was made or its time was set. */
  double external_work_total;
  /** sum m tr(C D C^T) / 2: kinetic energy of the matrices that APIC, APIC_MLS, TPIC, TFLIP and AFLIP carry
   * (C is "velocity_gradient", D the second moments of the basis), whose angular momentum is part of
   * angular_momentum. It is not part of kinetic_energy. 0 with other transfers. */
  double affine_kinetic_energy;
  /** Energy that contact of bodies, obstacles and MPM_WALL_FRICTION took in the step, from the velocities
   * that the nodes would have without it: never negative. In explicit steps forces drive bodies that press on
   * each other together in every step, and contact takes that again: its sum over steps has a part that goes
   * with dt and is no loss. What is lost is `dissipation`. */
  double contact_dissipation;
  int64_t contact_nodes; /**< nodes at which these gave each other an impulse */
  int32_t body;          /**< velocity field of `node`; 0 where there is none */
  int32_t reserved;      /**< 0 */
  /** Energy that local_damping and mass_damping took in the step: a part of `dissipation`. It is their force
   * times the mean of the nodes' velocities before and after, so that it is negative at nodes that turn. */
  double damping_dissipation;
  /** Sum of damping_dissipation over all committed steps since the stepper was made or its time was set. */
  double damping_dissipation_total;
} mpm_step_info;

/**
 * Particles of one set for which a force is wanted. Arrays are [components][ld], of which the first n items
 * of each component count. The memory belongs to the library and is valid during the call.
 */
typedef struct mpm_particle_batch {
  uint32_t struct_size; /**< sizeof(mpm_particle_batch) of the library; see mpm.h */
  int32_t dim;          /**< dimension of the grid */
  int64_t n;            /**< number of particles, inert slots included */
  int64_t ld;           /**< distance from component c to c + 1, in elements; >= n */
  /** Time for which the value is wanted: the start of the step. Forces of MPM_NEWMARK are wanted for its end,
   * and for the start where accelerations are to be found. */
  double t;
  double dt;         /**< size of the step */
  const int64_t *id; /**< [ld] ids, < 0 for inert slots */
  /** [dim][ld] at the start of the step, wrapped on periodic axes unless total_lagrangian = 1 */
  const double *position;
  const double *reference_position; /**< [dim][ld], or NULL without reference_positions; never NULL with
                                         total_lagrangian = 1 */
  const double *velocity;           /**< [dim][ld] at the start of the step */
  const double *mass;               /**< [ld] */
  const double *volume;             /**< [ld] at the start of the step */
  const mpm_particles *particles;   /**< the set, for comparison only: no call takes it in a callback */
  const void *lookup;               /**< argument of mpm_batch_field() */
} mpm_particle_batch;

/**
 * Active nodes of the grid. Arrays are [components][ld], of which the first n items of each component count.
 * The memory belongs to the library and is valid during the call.
 */
typedef struct mpm_node_batch {
  uint32_t struct_size; /**< sizeof(mpm_node_batch) of the library; see mpm.h */
  int32_t dim;          /**< dimension of the grid */
  int32_t body;         /**< velocity field of the nodes; see mpm_stepper_set_body() */
  int32_t reserved;     /**< 0 */
  int64_t n;            /**< number of nodes */
  int64_t ld;           /**< distance from component c to c + 1, in elements; >= n */
  double t;             /**< time for which the value is wanted */
  double dt;            /**< size of the step */
  /** [dim][ld] index of the basis function, from -1 to cells + 1. Ghosts lie outside 0 to cells. Open knots
   * have no ghosts, and other functions at these indices: go by position. */
  const int64_t *index;
  const double *position; /**< [dim][ld] origin + index * spacing; with open knots the Greville points */
  const double *mass;     /**< [ld] */
  /** [ld] 1 on exactly one of the parts that have the node, for sums of the host, else 0; all 1 with one
   * part: see parallel.h. Since 0.2.0. */
  const uint8_t *owned;
} mpm_node_batch;

/** Gives a vector per particle (mt): the callback does add[c * ld + i] += value for c < dim, because several
 * sources add to the same array. Returns 0, a value > 0 to ask for a smaller dt (MPM_CUT_DT), or a value < 0
 * to stop (MPM_E_CALLBACK). */
typedef mpm_status (*mpm_particle_fn)(void *user, const mpm_particle_batch *batch, double *add);

/**
 * Prescribes nodal velocities (mt). For the nodes and axes to hold, the callback sets prescribed[c * ld + i]
 * = 1 (preset 0), and velocity[c * ld + i] to the mean velocity of the step, so that the displacement
 * increment is dt * velocity in every scheme. Where several prescribe one node and axis, the first of these
 * wins: this callback, prescribed particles (their mean weighted by mass), walls; the reaction counts for
 * the winner. The callback is asked once per step, in the first projection of particles onto nodes; further
 * projections keep to the answer. Returns as mpm_particle_fn does.
 */
typedef mpm_status (*mpm_velocity_fn)(void *user, const mpm_node_batch *batch, uint8_t *prescribed,
                                      double *velocity);

/**
 * Reads and changes the nodal velocity[dim][ld] and force[dim][ld] at a stage of an explicit step (mt). The
 * hook is shown every node that moves by itself: periodic images and mirrored ghosts are counted in with the
 * node that they follow, in mass, velocity and force, and what is written acts on all of them.
 *
 * - MPM_AFTER_P2G: velocity is the projected one and force is zero; what is written is added to the force.
 * - MPM_AFTER_FORCES: velocity is the same; force is the whole of it, and may be replaced.
 * - MPM_AFTER_VELOCITY: velocity is the updated one, under walls and prescribed velocities, which do not act
 *   again; a change is an impulse of mass times change. force, reactions included, is for reading: what is
 *   written there is ignored.
 *
 * A change of the projected velocity moves particles, and is given to them as far as the transfer takes nodal
 * velocities: not with MPM_FLIP and flip = 1. Values that are left as they are change no bit; with
 * MPM_APIC_MLS a hook keeps forces apart, as steps in parts do. Hooks run in the projection that has the
 * forces: not in the second one of MPM_MUSL, and not in the first one of MPM_USF, which gives the strain, so
 * that they act on the strain of later steps only. Their work, impulse times new nodal velocity, is part of
 * external_work. MPM_NONFINITE names the node. Returns as mpm_particle_fn does.
 */
typedef mpm_status (*mpm_node_fn)(void *user, const mpm_node_batch *batch, double *velocity, double *force);

/** Watches steps. It is called on the calling thread at least once in each step before the step is committed,
 * and after each Newton iteration, with what is known so far; info belongs to the library. Returns 0 to go
 * on, a value > 0 to end the call with MPM_CANCELLED, or a value < 0 to end it with MPM_E_CALLBACK; the step
 * is then not committed. */
typedef mpm_status (*mpm_progress_fn)(void *user, const mpm_step_info *info);

/** Fills desc with the defaults. struct_size is sizeof(mpm_stepper_desc) of the caller; no byte beyond is
 * written. MPM_E_ARG: it is smaller than the first released struct. Any thread, any time. */
MPM_API mpm_status mpm_stepper_desc_init(mpm_stepper_desc *desc, uint32_t struct_size);

/** Makes a stepper at t = 0 and step 0, without sets, with MPM_WALL_NONE on all faces (the
 * axis of MPM_AXISYMMETRIC has MPM_WALL_SLIP). desc is copied and
 * may be NULL for the defaults. The grid outlives the stepper. *out is NULL unless MPM_OK is returned.
 * MPM_E_ARG: a value is bad, or the grid is of another context. MPM_E_UNSUPPORTED: the combination is not
 * offered; the error text says what to use instead. */
MPM_API mpm_status mpm_stepper_create(mpm_context *context, mpm_grid *grid, const mpm_stepper_desc *desc,
                                      mpm_stepper **out);

/** Frees the stepper. Its sets live on and are free for another. NULL is fine. MPM_E_STATE while a view of
 * its nodal fields is out or a staged step is under way. */
MPM_API mpm_status mpm_stepper_destroy(mpm_stepper *stepper);

/** Adds a set to the time loop. The host keeps owning it, and cannot destroy it while it is in. All sets
 * of a body share one velocity field; this one comes into body 0. MPM_E_STATE: the set is in a stepper
 * already. MPM_E_ARG: it is on another grid. */
MPM_API mpm_status mpm_stepper_add(mpm_stepper *stepper, mpm_particles *particles);

/** Takes a set out of the time loop. MPM_E_NOT_FOUND: it is not in this stepper. */
MPM_API mpm_status mpm_stepper_remove(mpm_stepper *stepper, mpm_particles *particles);

/** Replaces the options between steps. Any field may change, the scheme too; desc is copied. Errors are those
 * of mpm_stepper_create(), and MPM_E_STATE during a staged step. */
MPM_API mpm_status mpm_stepper_configure(mpm_stepper *stepper, const mpm_stepper_desc *desc);

/** Sets the time and the number of steps counted. Sums over steps (mpm_stepper_wall_impulse(),
 * mpm_stepper_particles_impulse(), external_work_total) start anew from 0. MPM_E_ARG: t is not finite, or
 * step < 0. */
MPM_API mpm_status mpm_stepper_set_time(mpm_stepper *stepper, double t, int64_t step);

/**
 * Moves the prescribed particles of a set (platens, pistons). mean_velocity (mt) is called at the start of a
 * step for the particles of the set, unless none is prescribed, and adds the mean velocity u of the coming
 * step to zeros; what it gives to other particles is ignored. NULL takes the callback away: the particles
 * keep their velocity.
 *
 * On its prescribed axes a particle moves by dt u and ends with the velocity u, with every transfer; the
 * nodes to which it gives mass move with u too, or with the mean of several by that mass. On other axes, and
 * in deformation and stress, it is a particle like others. MPM_NONFINITE names the particle. A state does not
 * hold the callback: after one has been loaded that had it, no step is made (MPM_E_STATE) until it has been
 * set, before loading or after, or answered by NULL after it. MPM_E_NOT_FOUND: the set is not in this
 * stepper.
 */
MPM_API mpm_status mpm_stepper_set_motion(mpm_stepper *stepper, mpm_particles *particles,
                                          mpm_particle_fn mean_velocity, void *user);

/** Sets what a face (MPM_X_MIN to MPM_Z_MAX) does: kind is one of MPM_WALL_NONE to MPM_WALL_FRICTION_NODES.
 * friction is the Coulomb coefficient, >= 0, of the last two, and is not used otherwise. Such a wall is
 * unilateral: its normal impulse only pushes, and its tangential impulse is at most friction times that; but
 * for a node that parts and touches again and again in the iterations of an implicit step, which is then held
 * in it and may be pulled. MPM_E_ARG: the grid does not have the face, the face is periodic, or a value is
 * bad. MPM_E_UNSUPPORTED: MPM_WALL_FRICTION_NODES with MPM_NEWMARK; MPM_WALL_OPEN with total_lagrangian = 1;
 * on the axis of MPM_AXISYMMETRIC another kind than MPM_WALL_SLIP. */
MPM_API mpm_status mpm_stepper_set_wall(mpm_stepper *stepper, int32_t face, int32_t kind, double friction);

/** Sets the callback that adds accelerations of particles, length/time^2 (b of MPoint theory, eq. 21). It is
 * called for every set. NULL takes it away. */
MPM_API mpm_status mpm_stepper_set_acceleration(mpm_stepper *stepper, mpm_particle_fn fn, void *user);

/** Sets the callback that adds forces on particles, mass length/time^2 (f^app of MPoint theory, eq. 21). It
 * is called for every set. NULL takes it away. */
MPM_API mpm_status mpm_stepper_set_force(mpm_stepper *stepper, mpm_particle_fn fn, void *user);

/** Sets the callback that prescribes nodal velocities, length/time. NULL takes it away. */
MPM_API mpm_status mpm_stepper_set_velocity_bc(mpm_stepper *stepper, mpm_velocity_fn fn, void *user);

/** Sets the hook of a stage, one of MPM_AFTER_P2G to MPM_AFTER_VELOCITY. NULL takes it away. In a step in
 * parts all hooks run in mpm_step_grid(), after what the host has written itself. MPM_E_ARG: there is no such
 * stage. MPM_E_UNSUPPORTED with MPM_NEWMARK. */
MPM_API mpm_status mpm_stepper_set_node_hook(mpm_stepper *stepper, int32_t stage, mpm_node_fn fn, void *user);

/** Sets the solver of MPM_SOLVER_HOST: see operator.h. NULL takes it away. */
MPM_API mpm_status mpm_stepper_set_linear_solver(mpm_stepper *stepper, mpm_solve_fn fn, void *user);

/** Sets the progress callback, which runs on the calling thread. NULL takes it away. */
MPM_API mpm_status mpm_stepper_set_progress(mpm_stepper *stepper, mpm_progress_fn fn, void *user);

/**
 * Gives the stable dt of an explicit step from the present state, at CFL number 1 (MPoint theory, eqs 45-46):
 * 1 / max over particles and axes of (|v_k| + c) / h_k, where c is the law's current wave speed, and at most
 * h^2 / (2 dim nu) where a law reports a kinematic viscosity nu; h is the smallest spacing. Explicit steps
 * want a share of it. It is infinite where nothing moves and no law has waves. Obstacles that move count by
 * the speed of their fastest point. The call runs the laws.
 * MPM_E_STATE: there are no particles, or a view is out.
 */
MPM_API mpm_status mpm_stable_dt(mpm_stepper *stepper, double *dt);

/**
 * Makes one step of size dt > 0. After any status but MPM_OK particles and time are bit-identical to before.
 * info may be NULL; it is filled on success and on failure.
 *
 * - MPM_CUT_DT, MPM_INVERTED, MPM_NONFINITE, MPM_NOT_CONVERGED, MPM_SINGULAR: a smaller dt may do.
 * - MPM_OFF_GRID: a particle would leave through a face that does not let it. In implicit steps a smaller dt
 *   may do here as well.
 * - MPM_CANCELLED: the progress callback ended the step.
 * - MPM_E_ARG: dt is not finite or not > 0.
 * - MPM_E_CALLBACK: a callback or the host's executor failed.
 * - MPM_E_STATE: a view is out, a staged step is under way, a set has values to be repaired, or the state
 *   that was loaded had a motion callback that is not set.
 */
MPM_API mpm_status mpm_step(mpm_stepper *stepper, double dt, mpm_step_info *info);

/** How mpm_advance() chooses its sub-steps. Fill the struct with mpm_advance_desc_init(). */
typedef struct mpm_advance_desc {
  uint32_t struct_size; /**< sizeof(mpm_advance_desc) of the caller */
  int32_t max_cuts;     /**< most cuts of one sub-step before the call gives up; 0 (default): 60 */
  double t_end;         /**< time to reach, not before the present one */
  /** Explicit: share of mpm_stable_dt(), in (0, 1], or 0 (default since 0.2.0, was 0.5): two thirds of the
   * largest share at which bodies were found to stay bounded, by basis and scheme: with all transfers in 1-D
   * and 2-D (of MPM_XPIC order 2, of MPM_FMPM 2 and 8), with MPM_FLIP in 3-D. With MPM_USL that is 0.40
   * on MPM_LINEAR and MPM_BSPLINE2, 0.60 on MPM_BSPLINE3, 0.27 with GIMP; with MPM_MUSL and MPM_USF 0.60,
   * 0.67, 0.67 and 0.47, but 0.33 with MPM_CPGIMP and MPM_USF. Implicit: ignored. */
  double cfl;
  double dt_first;   /**< most that the first sub-step takes; 0 (default): the controller's dt */
  double dt_min;     /**< size below which sub-steps are not cut; 0 (default): no bound */
  double dt_max;     /**< size of the largest sub-step; 0 (default): no bound */
  int64_t max_steps; /**< most sub-steps of this call; 0 (default): no limit */
} mpm_advance_desc;

/** Fills desc with the defaults; the host must set t_end. struct_size is sizeof(mpm_advance_desc) of the
 * caller; no byte beyond is written. MPM_E_ARG: it is smaller than the first released struct. Any thread, any
 * time. */
MPM_API mpm_status mpm_advance_desc_init(mpm_advance_desc *desc, uint32_t struct_size);

/**
 * Steps to t_end exactly. Statuses 1..5 cut dt to 0.6 of it and try again, and success lets it grow; the
 * controller's dt is part of the saved state. In implicit steps MPM_OFF_GRID cuts as well, but no more than
 * 20 times before the time comes to where one of these steps would have ended: a body that moves out by
 * itself does so in steps of any length. On failure the state is that of the last committed sub-step, and
 * the status is the cause. After max_cuts cuts in a row (60: dt is 5e-14 of what it was), or where another
 * would go below dt_min or no longer move the time, the call gives up, and mpm_last_error() says so and why
 * the last try failed; the next call begins with the dt of before the cuts. info may be NULL; it is that of
 * the last sub-step tried. The call returns MPM_OK with t < t_end when max_steps ran out. Errors are those
 * of mpm_step(); MPM_E_ARG: t_end is before the present time, or a value is bad.
 */
MPM_API mpm_status mpm_advance(mpm_stepper *stepper, const mpm_advance_desc *desc, mpm_step_info *info);

/** Seconds of wall-clock time spent in steps since creation or the last reset, by stage. The caller sets
 * struct_size. */
typedef struct mpm_profile {
  uint32_t struct_size; /**< sizeof(mpm_profile) of the caller */
  int32_t reserved;     /**< 0 */
  double sort;          /**< sorting particles, activating nodes */
  double p2g;           /**< weights, particles to grid */
  double grid;          /**< nodal update, walls, prescribed velocities */
  double g2p;           /**< grid to particles */
  double law;           /**< laws within g2p and assembly, from samples; their tangents are in assembly */
  double assembly;      /**< residual and matrix */
  double factor;        /**< factorisation, set-up of preconditioners */
  double solve;         /**< linear solves */
  double callbacks;     /**< the host's callbacks */
  double total;         /**< whole steps */
  double weights;       /**< weights of the basis within p2g and g2p, from samples */
} mpm_profile;

/** Copies the times into out, then sets them to zero if reset is not 0. They cost the steps one clock read
 * per stage. */
MPM_API mpm_status mpm_stepper_profile(mpm_stepper *stepper, int32_t reset, mpm_profile *out);

/** Gives the info of the state as it is, also before the first step. What belongs to a step is that of the
 * last one. MPM_E_STATE while a set is mapped for writing. */
MPM_API mpm_status mpm_stepper_info(const mpm_stepper *stepper, mpm_step_info *info);

/** Gives the history of the last implicit step: ||residual|| / scale (the scale includes reactions) from
 * before the first solve to the converged or failed end. *count tells how many values there are; the first
 * capacity of them are copied into residual, which may be NULL when capacity is 0. The history is kept until
 * the next step; *count is 0 after explicit ones. */
MPM_API mpm_status mpm_stepper_residuals(const mpm_stepper *stepper, int32_t capacity, double *residual,
                                         int32_t *count);

/** Makes the first part of an explicit step in parts: particles to grid, and forces. With MPM_USF strain and
 * stress of the step come before them, for which the callbacks of prescribed velocities are asked here. Until
 * mpm_step_end() or mpm_step_abort() the host may map nodal fields between the parts, and change "velocity"
 * and "force". Errors are those of mpm_step(), and MPM_E_UNSUPPORTED with MPM_NEWMARK. A part that fails with
 * any status but MPM_E_STATE or MPM_E_ARG aborts the step. */
MPM_API mpm_status mpm_step_begin(mpm_stepper *stepper, double dt);

/** Makes the second part: nodal velocities, walls, prescribed velocities. MPM_E_STATE unless it follows
 * mpm_step_begin(). */
MPM_API mpm_status mpm_step_grid(mpm_stepper *stepper);

/** Makes the last part: grid to particles, stress, commit. info may be NULL. MPM_E_STATE unless it follows
 * mpm_step_grid(). The three parts in a row give the same bits as mpm_step(), except with MPM_APIC_MLS, where
 * a whole step fuses force and momentum: there they agree to rounding. */
MPM_API mpm_status mpm_step_end(mpm_stepper *stepper, mpm_step_info *info);

/** Drops the step that was begun; particles and time are as before it. MPM_E_STATE: none was begun, or a view
 * of nodal fields is out. */
MPM_API mpm_status mpm_step_abort(mpm_stepper *stepper);

/**
 * Lends a field of the active nodes: of a staged step while one is under way, of the last step otherwise. The
 * view's struct_size is set by the caller. Until mpm_view_release() steps and their parts return MPM_E_STATE.
 * Periodic images and mirrored ghosts are listed beside the nodes that they follow.
 *
 * | field                              | type | components | what it is                                    |
 * |------------------------------------|------|------------|-----------------------------------------------|
 * | "index"                            | I64  | dim        | as in mpm_node_batch                          |
 * | "mass"                             | F64  | 1          | nodal mass                                    |
 * | "position" "velocity"              | F64  | dim        | length, length/time                           |
 * | "force" "acceleration"             | F64  | dim        | internal and external force; length/time^2    |
 * | "reaction"                         | F64  | dim        | force of walls and prescribed velocities      |
 * | "contact_force"                    | F64  | dim        | force of other bodies and of obstacles        |
 * | "contact_normal"                   | F64  | dim        | unit, away from the body, where it meets them |
 * | "contact_gap" "contact_area"       | F64  | 1          | length, infinite where it meets nothing       |
 * | "temperature"                      | F64  | 1          | at the end of the step, where sets have heat  |
 * | "owned"                            | U8   | 1          | as in mpm_node_batch                          |
 *
 * - body: velocity field, of which there is one for each body (mpm_stepper_set_body()).
 * - MPM_E_STATE: nothing has been stepped yet, or MPM_WRITE is asked for outside a staged step.
 * - MPM_E_NOT_FOUND: there is no such field or body.
 * - MPM_E_ARG: MPM_WRITE is asked for on a field other than "velocity" and "force".
 * - MPM_E_UNSUPPORTED: "force" or "acceleration" after a whole step of MPM_APIC_MLS, which does not keep
 *   them; a staged step and MPM_APIC do.
 */
MPM_API mpm_status mpm_grid_map(mpm_stepper *stepper, int32_t body, const char *field, int32_t access,
                                mpm_view *view);

/** Gives the force[dim] that the wall at a face exerts on the material: the mean over the last step, or with
 * MPM_NEWMARK the one at its end, but for friction walls. MPM_E_ARG: there is no such face. MPM_E_STATE
 * before the first step. */
MPM_API mpm_status mpm_stepper_wall_reaction(const mpm_stepper *stepper, int32_t face, double *force);

/** Gives the force[dim] that the prescribed particles of a set exert on the material, on the axes on which
 * they are prescribed: the mean over the last step, or with MPM_NEWMARK the one at its end. It is what holds
 * them, less their own inertia, weight and external forces; 0 for a set without such particles. What a body
 * of its own gives others through contact is not in it: mpm_stepper_contact_info() has that.
 * MPM_E_NOT_FOUND: the set is not in this stepper. MPM_E_STATE before the first step. */
MPM_API mpm_status mpm_stepper_particles_reaction(const mpm_stepper *stepper, const mpm_particles *prescribed,
                                                  double *force);

/** Gives the impulse[dim] of the wall at a face on the material, mass * length/time: the sum of
 * mpm_stepper_wall_reaction() times the time over which it acted, over all committed steps since the stepper
 * was made or mpm_stepper_set_time() was called; 0 before the first. A host that uses mpm_advance() measures
 * forces by it: the difference of two calls over the time between them is the mean force. With MPM_NEWMARK
 * a step adds dt times the force at its end, and with `staggered` the mean of two dt times its force. Steps
 * that fail add nothing, and a saved state holds it. MPM_E_ARG: there is no such face. */
MPM_API mpm_status mpm_stepper_wall_impulse(const mpm_stepper *stepper, int32_t face, double *impulse);

/** Gives the impulse[dim] of the prescribed particles of a set on the material, the sum of
 * mpm_stepper_particles_reaction() in the same way. It is 0 when a set is added, and forgotten when it is
 * removed. MPM_E_NOT_FOUND: the set is not in this stepper. */
MPM_API mpm_status mpm_stepper_particles_impulse(const mpm_stepper *stepper, const mpm_particles *prescribed,
                                                 double *impulse);

#ifdef __cplusplus
}
#endif

#endif
