// Generated from the headers of libmpm by `make api`; not to be edited. Classes: libmpm.d.ts.in.
/// <reference lib="esnext.disposable" />
// Options, reports and batches have the names that C has. Counts are numbers, ids and hashes BigInts. Whatever a call
// is not able to do, it throws an MpmError with the library's sentence, and what a callback throws comes out of the
// call that ran it. Arrays that are lent have no entries after the function to which they were lent has returned.

export interface Constants {
  /** the call did what it was asked to */
  readonly MPM_OK: 0;
  /** a callback, a law or contact asked for a smaller step */
  readonly MPM_CUT_DT: 1;
  /** det F <= 0 at a particle */
  readonly MPM_INVERTED: 2;
  /** a NaN or an infinity appeared */
  readonly MPM_NONFINITE: 3;
  /** the Newton iteration did not converge */
  readonly MPM_NOT_CONVERGED: 4;
  /** the linear system is singular, or indefinite beyond repair */
  readonly MPM_SINGULAR: 5;
  /** a particle would leave through a face that does not let it */
  readonly MPM_OFF_GRID: 6;
  /** the progress callback ended the call */
  readonly MPM_CANCELLED: 7;
  /** an argument is NULL, out of range or inconsistent */
  readonly MPM_E_ARG: -1;
  /** the allocator returned NULL */
  readonly MPM_E_NOMEM: -2;
  /** not allowed now: objects live, views are out, or a step is begun */
  readonly MPM_E_STATE: -3;
  /** a callback returned < 0, or the host's executor failed */
  readonly MPM_E_CALLBACK: -4;
  /** this version does not offer the combination or the extension */
  readonly MPM_E_UNSUPPORTED: -5;
  /** there is no such name, id or index; the text lists the nearest names */
  readonly MPM_E_NOT_FOUND: -6;
  /** a file could not be opened, read or written */
  readonly MPM_E_IO: -7;
  /** data are damaged, of another kind, or from an unlike setup */
  readonly MPM_E_FORMAT: -8;
  /** the library itself is at fault */
  readonly MPM_E_INTERNAL: -99;
  /** piecewise linear functions, 2h wide: Steffen et al. 2008, eqs 17-18 */
  readonly MPM_LINEAR: 1;
  /** Quadratic B-splines, 3h wide: Steffen et al. 2008, eq. 21; MPoint theory, eqs 24-27. */
  readonly MPM_BSPLINE2: 2;
  /** cubic B-splines, 4h wide: Steffen et al. 2008, eqs 22-23 */
  readonly MPM_BSPLINE3: 3;
  /** GIMP on domains of edges "size", at most a cell: Steffen et al. 2008, eqs 26-29 */
  readonly MPM_GIMP: 16;
  /** GIMP on domains that all have edges of smoothing * spacing */
  readonly MPM_UGIMP: 17;
  /** GIMP on domains of edges "size" * |F_ii|, at most a cell; depends on the axes */
  readonly MPM_CPGIMP: 18;
  /** splines are the same everywhere, with nodes outside the faces */
  readonly MPM_BOUNDARY_GHOST: 0;
  /**
   * Knots are repeated degree + 1 times at the faces, where one function alone is then 1. There are no nodes
   * outside: the cells + degree nodes of an axis stand at the Greville points. Periodic axes keep plain
   * splines.
   */
  readonly MPM_BOUNDARY_OPEN_KNOT: 1;
  /** a slab of unit thickness that keeps its thickness */
  readonly MPM_PLANE_STRAIN: 0;
  /**
   * A body of revolution: axis 0 is the radius r >= 0, axis 1 the axis z. What is extensive (volume, mass,
   * force, energy) is that of one radian: of the whole ring it is 2 pi times as much. The axis r = 0 is a
   * slip wall by itself. Sulsky & Schreyer 1996, section 3; Nairn & Guilkey 2015. Since 0.2.0.
   */
  readonly MPM_AXISYMMETRIC: 1;
  /**
   * A sheet of unit thickness at the start, without a stress across it: F33, which the library finds, makes
   * it thinner and thicker. Solids alone, without the locking remedy. Since 0.2.0.
   */
  readonly MPM_PLANE_STRESS: 2;
  /** Explicit, with stresses updated last: MPoint theory, eqs 28-44; Steffen et al. 2008, eqs 1-10. */
  readonly MPM_USL: 1;
  /**
   * Explicit, with stresses updated first, by the strain from the velocities at the start of the step:
   * Guilkey, An Introduction to the MPM, eqs 2-10.
   */
  readonly MPM_USF: 2;
  /** As MPM_USL, but velocities are projected a second time before stresses are updated. */
  readonly MPM_MUSL: 3;
  /** Implicit, by Newmark's rule: Guilkey & Weiss 2003, eqs 11-16, generalised to any beta and gamma. */
  readonly MPM_NEWMARK: 16;
  /** FLIP, PIC, and their blend by the field flip: MPoint theory, eqs 34-36 */
  readonly MPM_FLIP: 1;
  /** affine, with the inertia of each axis and particle, for any basis: Jiang et al. 2015 */
  readonly MPM_APIC: 2;
  /** projects the velocity gradient too (MPoint theory, eq. 29); PIC update (eq. 35) */
  readonly MPM_TPIC: 3;
  /** projects the velocity gradient too (MPoint theory, eq. 29); FLIP blend (eq. 36) */
  readonly MPM_TFLIP: 4;
  /** affine projection with the FLIP blend */
  readonly MPM_AFLIP: 5;
  /** XPIC(m), where m is xpic_order: Hammerquist & Nairn 2017 */
  readonly MPM_XPIC: 6;
  /**
   * Affine by moving least squares, with constant inertia and one fused matrix, for quadratic and cubic
   * B-splines with ghosts or periodic axes: Hu et al. 2018.
   */
  readonly MPM_APIC_MLS: 7;
  /**
   * FMPM(k), where k is xpic_order: nodal velocities by the first k terms of a series for the inverse of the
   * full mass matrix: Nairn & Hammerquist 2021. Since 0.2.0.
   */
  readonly MPM_FMPM: 8;
  /** the best one that both the processor and the library have */
  readonly MPM_ISA_BEST: 0;
  /** the one that the library was compiled for */
  readonly MPM_ISA_BASELINE: 1;
  /** AVX2 with FMA, on x86-64 */
  readonly MPM_ISA_AVX2: 2;
  /** AVX-512 (F, DQ, VL), on x86-64 */
  readonly MPM_ISA_AVX512: 3;
  /** NEON with FMA, on aarch64 */
  readonly MPM_ISA_NEON: 4;
  /** the baseline by its promise: the same bits on every platform (mpm.h, Results) */
  readonly MPM_ISA_PORTABLE: 1;
  /** the host should look at it */
  readonly MPM_LOG_WARNING: 1;
  /** a rare event: a choice made at creation, or growth of storage */
  readonly MPM_LOG_INFO: 2;
  /** a text in every step */
  readonly MPM_LOG_DEBUG: 3;
  /** there is no remedy */
  readonly MPM_LOCKING_NONE: 0;
  /**
   * The law sees the dilation averaged over the cell, weighted by volume. Of sets whose law makes pressure by
   * shear ("drucker_prager", "mohr_coulomb", "cam_clay") that is the mean of such sets alone, and forces have
   * their pressure averaged over the cell, which does the same work (Hughes 1980).
   */
  readonly MPM_LOCKING_CELL_AVERAGE: 1;
  /** 6 x 6 components, in Voigt's notation */
  readonly MPM_TANGENT_MINOR_SYMMETRIC: 36;
  /** 9 x 9 components */
  readonly MPM_TANGENT_GENERAL: 81;
  /** lower face across x */
  readonly MPM_X_MIN: 0;
  /** upper face across x */
  readonly MPM_X_MAX: 1;
  /** lower face across y */
  readonly MPM_Y_MIN: 2;
  /** upper face across y */
  readonly MPM_Y_MAX: 3;
  /** lower face across z */
  readonly MPM_Z_MIN: 4;
  /** upper face across z */
  readonly MPM_Z_MAX: 5;
  /**
   * default: a step in which a particle would leave fails with MPM_OFF_GRID; none with total_lagrangian = 1,
   * where "position" may leave the box
   */
  readonly MPM_WALL_NONE: 0;
  /** a particle that leaves is removed; refused with total_lagrangian = 1 */
  readonly MPM_WALL_OPEN: 1;
  /** velocities at the face are zero: it pushes and pulls */
  readonly MPM_WALL_FIXED: 2;
  /** a symmetry plane: it pushes and pulls, without tangential force */
  readonly MPM_WALL_SLIP: 3;
  /**
   * the plane of the face as a fixed obstacle with Coulomb friction (obstacle.h): it pushes, never pulls.
   * What comes through between nodes, by less than half a cell, it stops particle by particle
   */
  readonly MPM_WALL_FRICTION: 4;
  /**
   * contact of the nodes on the face with Coulomb friction: MPM_WALL_FRICTION as it was in 0.1.0. Material
   * feels it about a cell and a half before its particles are there; with total_lagrangian = 1 it is that of
   * the material that was there
   */
  readonly MPM_WALL_FRICTION_NODES: 5;
  /** default: the material carries the markers along */
  readonly MPM_PRESCRIBES_NOTHING: 0;
  /** all components: the material sticks to the surface */
  readonly MPM_PRESCRIBES_VELOCITY: 1;
  /** that along the area vector: the material slides without friction */
  readonly MPM_PRESCRIBES_NORMAL: 2;
  /** mass and velocity are projected, forces are not yet known */
  readonly MPM_AFTER_P2G: 1;
  /** internal and external forces are complete */
  readonly MPM_AFTER_FORCES: 2;
  /** velocity is updated, and walls and prescribed velocities have acted on it */
  readonly MPM_AFTER_VELOCITY: 3;
  /** the host reads */
  readonly MPM_READ: 1;
  /** the host writes */
  readonly MPM_WRITE: 2;
  /** double */
  readonly MPM_F64: 1;
  /** int64_t */
  readonly MPM_I64: 2;
  /** uint8_t */
  readonly MPM_U8: 3;
  /** by ascending id */
  readonly MPM_BY_ID: 1;
  /** as they lie in memory, without inert slots; changes when they are sorted anew */
  readonly MPM_LIBRARY_ORDER: 2;
  /** the library chooses by size, stencil, symmetry and inertia; with a transport as parallel.h says */
  readonly MPM_SOLVER_AUTO: 0;
  /** conjugate gradients, for symmetric positive definite systems */
  readonly MPM_SOLVER_CG: 1;
  /** conjugate gradients with geometric multigrid, for the same systems */
  readonly MPM_SOLVER_MULTIGRID_CG: 2;
  /** a direct solver, for symmetric systems that may be indefinite */
  readonly MPM_SOLVER_LDLT: 3;
  /** GMRES, for systems that are not symmetric */
  readonly MPM_SOLVER_GMRES: 4;
  /** the callback of mpm_stepper_set_linear_solver() */
  readonly MPM_SOLVER_HOST: 100;
  /** both sides know who sends to whom: partners send and receive */
  readonly MPM_EXCHANGE_KNOWN: 1;
  /** receivers do not know from whom: particles that move, changes of the pattern */
  readonly MPM_EXCHANGE_SPARSE: 2;
  /** the largest of all parts */
  readonly MPM_REDUCE_MAX: 1;
  /** the sum, modulo 2^64 */
  readonly MPM_REDUCE_SUM: 2;
  /** they push each other and never pull, with Coulomb friction (default) */
  readonly MPM_CONTACT_UNILATERAL: 0;
  /** they pass through each other */
  readonly MPM_CONTACT_NONE: 1;
  /** neither slip nor separation at nodes that both have */
  readonly MPM_CONTACT_TIED: 2;
  /** of the plane that separates the particles best: logistic regression */
  readonly MPM_NORMAL_LOGISTIC: 0;
  /** of Fisher's linear discriminant: one pass, for smooth surfaces */
  readonly MPM_NORMAL_DISCRIMINANT: 1;
  /** of the mean gradient of volume: for comparison with other codes */
  readonly MPM_NORMAL_GRADIENT: 2;
  /** mpm_contact_desc.direction */
  readonly MPM_NORMAL_FIXED: 3;
  /**
   * MPM_DETECT_GAP, but MPM_DETECT_VELOCITY with MPM_NORMAL_GRADIENT, whose directions are too far off to
   * measure a gap along them
   */
  readonly MPM_DETECT_DEFAULT: 0;
  /** by the gap between their particles */
  readonly MPM_DETECT_GAP: 1;
  /** by velocity alone: wherever they share a node and approach each other */
  readonly MPM_DETECT_VELOCITY: 2;
  /** any body that has no closer rule; all of them in reports */
  readonly MPM_BODY_ANY: -1;
  /** a half-space; outward normal: axis y, in 1-D x. No size */
  readonly MPM_SHAPE_PLANE: 1;
  /** size[0]: radius; in 2-D a disc. Not in 1-D */
  readonly MPM_SHAPE_SPHERE: 2;
  /** around axis z; size[0]: radius, size[1]: half length. 3-D only */
  readonly MPM_SHAPE_CYLINDER: 3;
  /** around axis z; size[0]: radius, size[1]: half length without caps. 3-D only */
  readonly MPM_SHAPE_CAPSULE: 4;
  /** size: half edges; in 2-D a rectangle. Not in 1-D */
  readonly MPM_SHAPE_BOX: 5;
  /** what mpm_obstacle_desc.distance says */
  readonly MPM_SHAPE_DISTANCE: 64;
  /** not at all (default) */
  readonly MPM_MOTION_FIXED: 0;
  /** by its velocities, which the host may change from step to step */
  readonly MPM_MOTION_PRESCRIBED: 1;
  /** as a rigid body under contact, gravity and the host's load */
  readonly MPM_MOTION_FREE: 2;
  /** particles that are to be split */
  readonly MPM_ADAPT_SPLIT: 0;
  /** pairs that are to become one particle */
  readonly MPM_ADAPT_MERGE: 1;
  /**
   * By the temperatures at the start of the step. Steps longer than 1 / (2 diffusivity sum 1 / h_k^2), h_k
   * the spacings, are refused with MPM_CUT_DT, and mpm_stable_dt() takes the bound into account; with
   * total_lagrangian = 1 spacings are those that the deformation has made of them. So are steps in which a
   * film of mpm_surface_set_heat() would take more from a particle than its difference to the ambient, of
   * which mpm_stable_dt() knows nothing.
   */
  readonly MPM_CONDUCTION_EXPLICIT: 0;
  /** By those at its end (backward Euler), found by conjugate gradients: any step will do. */
  readonly MPM_CONDUCTION_IMPLICIT: 1;
  /** lets none through */
  readonly MPM_HEAT_WALL_INSULATED: 0;
  /** material at it has a prescribed temperature */
  readonly MPM_HEAT_WALL_TEMPERATURE: 1;
}
/** All constants of the library, under their names in C. */
export const C: Constants;

/**
 * How blocks of the grid are given to parts. Fill it with mpm_balance_desc_init(); all 0 are the defaults.
 */
export interface BalanceDesc {
  /**
   * 0 (default): a block weighs what its particles and block_weight come to. 1: the seconds that a part has
   * spent in steps since blocks were last given to parts, those of waiting left out, are what its blocks
   * weigh together, each in proportion to that.
   */
  measure?: number | boolean;
  /**
   * Blocks are given to parts anew, at a sort, when the largest weight of a part is this many times the mean,
   * at least 1; infinity: never. 0 (default): 1.1, and only when the steps since the last time would have
   * gained more by it than it costs to move the particles.
   */
  limit?: number;
  /**
   * What a block costs beside its particles, in particles, from 0 to 1e6. 0 (default): 60, about what the
   * sums of its nodes take.
   */
  block_weight?: number;
}
/** Services of the host. */
export interface ContextDesc {
  /**
   * Number of threads, 0 to 1024. 1 (default): the calling thread only; N: a pool of N threads, the calling
   * one included; 0: one per processor. The pool belongs to the context; its threads sleep when idle, after
   * they have looked for work for 100 microseconds, and rest in steps that are over sooner without them.
   * Results do not depend on the number. A build without threads (MPM_NO_THREADS) takes 0 and 1, or any
   * number with parallel_for, else MPM_E_UNSUPPORTED.
   *
   * A process that fork() makes between two calls has the context and its objects, but none of the pool's
   * threads: there everything runs on the calling thread, with the same results, and destroying frees as
   * ever.
   */
  concurrency?: number | boolean;
  /**
   * Instruction set of the kernels: MPM_ISA_BEST (default) or the one to be used, which creation refuses with
   * MPM_E_UNSUPPORTED if processor or library lacks it. With MPM_ISA_BEST the environment variable MPM_ISA
   * (portable or baseline, avx2, avx512, neon) decides where it is set; it is read once, at creation.
   */
  isa?: number | boolean;
  /**
   * 1: the library calls the host from the calling thread only, also where a callback is marked (mt). Default
   * 0.
   */
  serial_callbacks?: number | boolean;
  /** size of error_text in bytes; 0 exactly where error_text is NULL */
  error_bytes?: bigint;
}
/** Box, cells and basis of a grid. Entries of axes beyond dim are ignored. */
export interface GridDesc {
  /** 1 (uniaxial strain), 2 (see geometry) or 3 (default) */
  dim?: number | boolean;
  /** MPM_LINEAR to MPM_CPGIMP; default MPM_BSPLINE2 */
  basis?: number | boolean;
  /** for B-splines: MPM_BOUNDARY_GHOST (default) or MPM_BOUNDARY_OPEN_KNOT */
  boundary_basis?: number | boolean;
  /** 1: the axis is periodic; default 0 */
  periodic?: ArrayLike<number>;
  /** for dim 2: an MPM_PLANE_STRAIN (default) ... MPM_PLANE_STRESS. Since 0.2.0 */
  geometry?: number | boolean;
  /** cells along each axis, 1 to 6291456; memory follows the material */
  cells?: ArrayLike<number>;
  /** lower corner of the box, length; default 0 */
  origin?: ArrayLike<number>;
  /** edges of a cell, length, > 0; the upper corner is origin + cells * spacing */
  spacing?: ArrayLike<number>;
  /** for MPM_UGIMP: edge of a particle's domain / spacing, in (0, 1]; default 0.5 */
  smoothing?: number;
  /**
   * 1: a total Lagrangian grid (de Vaucorbeil, Nguyen & Hutchinson 2020). Its cells hold the material as it
   * was before it deformed: weights follow from "reference_position" and stay what they are. Nothing is
   * sorted anew, particles do not cross cells, and material that is drawn out does not come apart. "position"
   * may leave the box. Walls, prescribed velocities, node hooks and nodal fields are those of nodes at their
   * places in the box, and so is MPM_WALL_FRICTION_NODES; obstacles and MPM_WALL_FRICTION meet particles
   * where they are now. For solids of one body: fluids, contact between bodies and MPM_WALL_OPEN are refused.
   * 0 (default): weights follow from "position". Since 0.2.0
   */
  total_lagrangian?: number | boolean;
}
/** A law of the host. */
export interface MaterialDesc {
  /** number of state variables of a particle, 0 to 64; default 0 */
  state_count?: number | boolean;
  /** MPM_TANGENT_MINOR_SYMMETRIC (default) or MPM_TANGENT_GENERAL */
  tangent_form?: number | boolean;
  /** mass per initial volume, > 0; the host must set it */
  density?: number;
}
/** Options of a stepper. */
export interface StepperDesc {
  /** MPM_USL (default), MPM_USF, MPM_MUSL or MPM_NEWMARK */
  scheme?: number | boolean;
  /** MPM_FLIP (default) to MPM_FMPM. MPM_NEWMARK takes MPM_FLIP with flip = 1 only. */
  transfer?: number | boolean;
  /**
   * Order m of MPM_XPIC, 1 (PIC) to 5, or k of MPM_FMPM, 1 (PIC) to 32; default 2. Each order above the first
   * projects and gathers once more. These corrections obey fixed and slip walls and periodic axes, those of
   * MPM_FMPM prescribed velocities as well; contact acts before them, with its whole impulse.
   */
  xpic_order?: number | boolean;
  /**
   * Order of the update of positions; v is the updated nodal velocity and w a weight. 1 (default): x += dt
   * sum w v (Steffen et al. 2008, eq. 10). 2: x += dt sum w v - dt^2 / 2 sum w a, which is exact under
   * constant acceleration (MPoint theory, eq. 37, where the last term is misprinted); it is not for staggered
   * steps, which have that order with 1. MPM_NEWMARK moves particles by the displacements that it solves for,
   * whatever the order.
   */
  position_order?: number | boolean;
  /**
   * MPM_LOCKING_NONE (default) or, in 2-D and 3-D, MPM_LOCKING_CELL_AVERAGE. With the latter the sets of the
   * stepper have the field "dilation_ratio". Not with MPM_PLANE_STRESS.
   */
  locking_remedy?: number | boolean;
  /**
   * 1: keeps "reference_position" and shows it to callbacks; default 0. With total_lagrangian = 1 that is so
   * anyway
   */
  reference_positions?: number | boolean;
  /**
   * 1: MPM_NEWMARK drops the inertia, so that each step ends in equilibrium under the forces at its end.
   * Velocities are then displacements over dt, and accelerations are zero. Default 0. MPM_E_UNSUPPORTED with
   * other schemes.
   */
  quasi_static?: number | boolean;
  /**
   * 1: particle velocities are those at t_n - dt/2 (Steffen et al. 2008, eqs 11-15), and so is the kinetic
   * energy; default 0. The host sets velocities of that time, because the library does not shift them. Forces
   * change velocities over the mean of this dt and the one before, in the first step over its dt, so that dt
   * may change. Positions and strain follow over dt. MPM_E_UNSUPPORTED with position_order = 2.
   */
  staggered?: number | boolean;
  /**
   * Acceleration of nodes whose velocity the host or a particle prescribes. 0 (default): the one that brings
   * them from the projected to the prescribed velocity (Steffen et al. 2008, eq. 30), or with MPM_NEWMARK
   * that of its rule; 1: zero. Nodes that walls hold have none in either case: a slip wall is a symmetry
   * plane, on which the projected velocity is zero too.
   */
  boundary_zero_acceleration?: number | boolean;
  /**
   * Share of FLIP per step for MPM_FLIP, MPM_TFLIP and MPM_AFLIP, and between the steps that xpic_every
   * counts, from 1 (default, FLIP) to 0 (PIC).
   */
  flip?: number;
  /**
   * Rate beta >= 0, 1/time, of a blend that does not depend on dt (MPoint theory, eqs 58-59), for the
   * transfers of flip: the step's share of FLIP is flip * max(0, 1 - beta dt). Default 0.
   */
  pic_damping?: number;
  /** acceleration of all particles, length/time^2; default 0. Of MPM_AXISYMMETRIC along the axis alone */
  gravity?: ArrayLike<number>;
  /** Newmark's beta: default 1/4, as Guilkey & Weiss 2003, eqs 14-15 */
  newmark_beta?: number;
  /** Newmark's gamma: default 1/2, as there; larger values damp high frequencies */
  newmark_gamma?: number;
  /**
   * Newton iterations end when the displacement increment is at most this share of the largest of the step,
   * both measured by the diagonal of the stiffness, in which light nodes count little (Guilkey & Weiss 2003,
   * eq. 13, eps_d), and the next two bounds hold as well. Default 1e-8.
   */
  newton_tolerance_displacement?: number;
  /**
   * They end when the increment times the residual is at most this share of the first of the step (eps_e in
   * the same eq. 13), and the other two bounds hold. Default 1e-14.
   */
  newton_tolerance_energy?: number;
  /**
   * They end when the norm of the residual is at most this share of a scale that includes reactions, and the
   * other two bounds hold. Default 1e-8.
   */
  newton_tolerance_residual?: number;
  /** Norm of the residual, a force, up to which its bound holds whatever the scale. Default 0. */
  newton_residual_floor?: number;
  /** iterations after which a step is MPM_NOT_CONVERGED; default 20 */
  newton_max_iterations?: number | boolean;
  /** MPM_SOLVER_AUTO (default) to MPM_SOLVER_HOST */
  linear_solver?: number | boolean;
  /** ||K x - b|| / ||b||; 0 (default): the Newton iteration chooses it */
  linear_tolerance?: number;
  /** most iterations of a linear solve; 0 (default): the solver chooses */
  linear_max_iterations?: number | boolean;
  /**
   * 1: with MPM_MUSL particles move by the projected velocities, which strain them too: x += dt sum w v, with
   * the v of the second projection. Bodies in sustained tension, whose particles otherwise move by more than
   * they are strained by (theory, section 11.1), are stable then, but for a nearly incompressible one whose
   * volume is forced to grow. 0 (default): they move by the updated velocities, as Sulsky et al. 1995.
   * MPM_E_UNSUPPORTED with other schemes, which have no such velocities after the update. Since 0.2.0, in the
   * place of `reserved`.
   */
  projected_positions?: number | boolean;
  /**
   * Local damping alpha of Cundall 1987, in [0, 1); default 0. In explicit steps each component of a node's
   * whole unbalanced force f, ties to images and the hook MPM_AFTER_FORCES counted in, becomes f - alpha |f|
   * sign(v), where v is the projected velocity. Bodies come to rest under dead loads, and reactions are those
   * of the material: what walls or prescribed velocities hold is not damped, and contact acts after it. It
   * also slows free fall and rigid motion, to (1 - alpha) g. MPM_E_UNSUPPORTED with MPM_NEWMARK. Since 0.2.0.
   */
  local_damping?: number;
  /**
   * Damping in proportion to mass, a >= 0 in 1/time; default 0: the force -a m v on nodes, for a share of a /
   * (2 omega) of critical damping. In explicit steps v is the mean of the velocities before and after, by
   * which the stable dt stays as it is; with MPM_NEWMARK it is that at the end of the step. It acts where
   * local_damping does. MPM_E_UNSUPPORTED with quasi_static. Since 0.2.0.
   */
  mass_damping?: number;
  /**
   * For MPM_XPIC and MPM_FMPM: every so many steps are of the order xpic_order, those whose number
   * (mpm_step_info::step, counted from 1 or on from mpm_stepper_set_time()) is a multiple of this; all others
   * are those of MPM_FLIP, with flip and pic_damping. Steps that fail have no number, and a loaded state goes
   * on with its own. 1, and 0 (default), which means 1: every step is of that order. MPM_E_UNSUPPORTED: above
   * 2 with MPM_FMPM of an order above 1 and MPM_USF or MPM_MUSL, where waves grow. Since 0.2.0.
   */
  xpic_every?: number | boolean;
}
/** How mpm_advance() chooses its sub-steps. */
export interface AdvanceDesc {
  /** most cuts of one sub-step before the call gives up; 0 (default): 60 */
  max_cuts?: number | boolean;
  /** time to reach, not before the present one */
  t_end?: number;
  /**
   * Explicit: share of mpm_stable_dt(), in (0, 1], or 0 (default since 0.2.0, was 0.5): two thirds of the
   * largest share at which bodies were found to stay bounded, by basis and scheme: with all transfers in 1-D
   * and 2-D (of MPM_XPIC order 2, of MPM_FMPM 2 and 8), with MPM_FLIP in 3-D. With MPM_USL that is 0.40 on
   * MPM_LINEAR and MPM_BSPLINE2, 0.60 on MPM_BSPLINE3, 0.27 with GIMP; with MPM_MUSL and MPM_USF 0.60, 0.67,
   * 0.67 and 0.47, but 0.33 with MPM_CPGIMP and MPM_USF. Implicit: ignored.
   */
  cfl?: number;
  /** most that the first sub-step takes; 0 (default): the controller's dt */
  dt_first?: number;
  /** size below which sub-steps are not cut; 0 (default): no bound */
  dt_min?: number;
  /** size of the largest sub-step; 0 (default): no bound */
  dt_max?: number;
  /** most sub-steps of this call; 0 (default): no limit */
  max_steps?: number;
}
/** How two bodies meet. */
export interface ContactDesc {
  /** an MPM_CONTACT_...; default MPM_CONTACT_UNILATERAL */
  kind?: number | boolean;
  /** an MPM_NORMAL_...; default MPM_NORMAL_LOGISTIC */
  normal?: number | boolean;
  /** an MPM_DETECT_...; default MPM_DETECT_DEFAULT */
  detection?: number | boolean;
  /** Coulomb's coefficient of sliding, >= 0; default 0 */
  friction?: number;
  /** that of sticking, >= friction; 0 (default): the same as friction */
  friction_static?: number;
  /**
   * largest tensile traction while the gap is closed, stress, >= 0; default 0. Not with detection by
   * velocity, which knows no gap
   */
  adhesion?: number;
  /**
   * distance that the surfaces keep, length; < 0: overlap is let be; default 0. Bodies see each other from
   * about a cell on: more than that they do not keep
   */
  offset?: number;
  /** MPM_NORMAL_FIXED: unit normal, from the first body to the second */
  direction?: ArrayLike<number>;
}
/** An obstacle. */
export interface ObstacleDesc {
  /** an MPM_SHAPE_...; no default */
  shape?: number | boolean;
  /** an MPM_MOTION_...; default MPM_MOTION_FIXED */
  motion?: number | boolean;
  /** 1: the material is inside (drum, container); default 0 */
  inside?: number | boolean;
  /** see MPM_SHAPE_PLANE ..., length */
  size?: ArrayLike<number>;
  /** of the centre, which of a free one is that of mass */
  position?: ArrayLike<number>;
  /** unit quaternion w, x, y, z that turns axes of the body into those of space; default 1, 0, 0, 0 */
  orientation?: ArrayLike<number>;
  /** of the centre; default 0 */
  velocity?: ArrayLike<number>;
  /** in space, 1/time; in 2-D component 2; default 0 */
  angular_velocity?: ArrayLike<number>;
  /** of a free one, > 0; in 2-D per depth, in 1-D per area */
  mass?: number;
  /**
   * of a free one: tensor about the centre in axes of the body, row by row, symmetric and positive definite;
   * in 2-D component 8 alone; not in 1-D
   */
  inertia?: ArrayLike<number>;
  /** of MPM_SHAPE_DISTANCE, in axes of the body from its centre: the obstacle and all */
  lower?: ArrayLike<number>;
  /** within two spacings of it lie in this box. Equal (default): it may be anywhere */
  upper?: ArrayLike<number>;
}
/**
 * Loads of all markers of a surface, and what it prescribes. What markers carry by themselves ("pressure",
 * "traction", "dead_traction", "prescribed_velocity") and what the callbacks give comes on top.
 */
export interface SurfaceDesc {
  /** velocity field that it loads and moves with (mpm_stepper_set_body()); default 0 */
  body?: number | boolean;
  /** force/area against the normal, on the present area: it follows the surface */
  pressure?: number;
  /** force per present area, in a fixed direction */
  traction?: ArrayLike<number>;
  /** force per area at the time when the marker was added: a dead load */
  dead_traction?: ArrayLike<number>;
  /**
   * Length > 0: markers with a longer edge are split in two at the end of a step, so that a surface that
   * stretches has no dents. Half a spacing is right. 0 (default): they are not.
   */
  max_spacing?: number;
  /**
   * MPM_PRESCRIBES_...: what of the motion of the material the markers prescribe. Markers without area
   * prescribe nothing. Default MPM_PRESCRIBES_NOTHING.
   */
  prescribes?: number | boolean;
  /** length/time: how the markers of a surface that prescribes move */
  velocity?: ArrayLike<number>;
  /** implicit steps: stiffness of the springs in modulus / spacing, > 0; default 100 */
  penalty?: number;
  /**
   * Implicit steps, force/area >= 0: the modulus of the springs. 0 (default): in each step the largest of
   * density times wave speed squared among the particles of the body, which is lambda + 2 mu.
   */
  modulus?: number;
}
/**
 * How a set adapts. Fill it with mpm_adaption_desc_init(), after which nothing is split and nothing merged.
 * Lengths are counted in cells: an edge (a, b, c) has the length |(a/h_x, b/h_y, c/h_z)|.
 */
export interface AdaptionDesc {
  /** steps from one adaption to the next; default 10; 0: by mpm_stepper_adapt() alone */
  every?: number | boolean;
  /**
   * Edges of domains that are longer than this are halved. 0 (default): none are. With quadratic splines, two
   * particles per cell and axis and a transfer that carries a matrix, 0.52 keeps material together however
   * far it is drawn.
   */
  split_edge?: number;
  /** No edge becomes shorter than this by splitting. Default 0.125. */
  least_edge?: number;
  /**
   * In a cell that has particles, but fewer of the set than this, they are split along their longest edges
   * until there are so many. 0 (default): not. For fluids, whose deformation gradient has no shape.
   */
  min_per_cell?: number | boolean;
  /**
   * In a cell with more particles of the set pairs are merged until there are so many: in the order of ids,
   * each particle with the nearest that is alike. 0 (default): none are. At least twice min_per_cell.
   */
  max_per_cell?: number | boolean;
  /** Pairs lie no further apart than this. Default 0.25. */
  merge_distance?: number;
  /**
   * Pairs are alike when their deformation gradients differ by at most this share of the larger one, in the
   * norm of Frobenius, their stresses by this share of density c^2, and their velocities by this share of c,
   * the wave speed of the law; with laws of the host, stresses by this share of the larger one, and
   * velocities are not looked at. Default 0.02.
   */
  merge_tolerance?: number;
  /** Nothing is split beyond this number of particles in the set. 0 (default): there is no such bound. */
  most_particles?: number;
}
/** The heat of a set. */
export interface HeatDesc {
  /** energy / (mass temperature), > 0. Must be given. */
  specific_heat?: number;
  /** power / (length temperature), >= 0. Default 0: no heat is conducted. */
  conductivity?: number;
  /** linear, 1/temperature. Default 0. The law sees F / exp(expansion (T - T0)). */
  expansion?: number;
  /** T0, at which F = I is free of stress. Default 0. Particles that are added have this temperature. */
  reference_temperature?: number;
  /**
   * Share of the work that the material dissipates which becomes heat, 0 to 1. Default 0. It is the work of
   * the stress less the change of strain energy; it heats the particle itself, at the end of the step.
   */
  dissipated_share?: number;
}
/**
 * A linear system. The arrays belong to the library and are valid until the solve callback returns. A row is
 * one component of one node; nodes and components whose displacement is prescribed have none. Rows of one
 * node follow each other, by ascending component.
 *
 * With several parts a row is owned by exactly one part. Local rows 0 to owned_rows - 1 are those that this
 * part owns, in the order of nodes that it has; they are numbered first_row, first_row + 1, ... over all
 * parts, part by part. Behind them stand rows that other parts own, those alone that columns of owned rows
 * name: they have number, node, component and position, and no entries of their own. Every vector has
 * owned_rows entries. With one part all rows are owned, and number[i] is i.
 *
 * What a solver has made of a pattern serves as long as pattern_id is the same, of another stepper too.
 */
export interface OperatorInfo {
  /** number of rows of a node on which nothing is prescribed */
  block: number;
  /** 1 if the matrix is symmetric, else 0 */
  symmetric: number;
  /** 1 if the matrix is expected to be positive definite, which is not checked */
  positive_definite: number;
  /** number of local rows and of local columns */
  rows: number;
  /** number of stored entries, all of them in owned rows */
  nonzeros: number;
  /** a hash of nodes, axes and columns, below 2^53, equal on all parts */
  pattern_id: number;
  /** distance from component c to c + 1 of position, in elements; >= rows */
  ld: number;
  /** number of the first owned row over all parts; 0 with one part */
  first_row: number;
  /** number of rows that this part owns; rows with one part */
  owned_rows: number;
  /** number of rows of all parts together */
  all_rows: number;
}
/**
 * What a step did, or the state as it is. Energies and momenta are the particles'; the angular momentum is
 * about the origin and includes the part of the matrices that transfers carry ("velocity_gradient"). Entries
 * of unused axes are 0. After a failed step the sums are those of the state that was kept. Units are the
 * host's: energies force * length, momenta mass * length/time.
 */
export interface StepInfo {
  /** status of the failure, MPM_OK if there was none */
  cause: number;
  /** what a callback returned when it was not 0, else 0 */
  callback_status: number;
  /** linear solves of the step; 0 for explicit schemes, and at rest */
  newton_iterations: number;
  /** MPM_SOLVER_* that was used; 0 for explicit schemes */
  linear_solver: number;
  /**
   * Set of the first failure, numbered in order of mpm_stepper_add(), or -1. The first is the smallest (set,
   * particle) of those that failed, so that reports repeat.
   */
  set: number;
  /** number of committed steps, counted on from mpm_stepper_set_time() */
  step: number;
  /**
   * Number of nodes with mass in the step; of one that failed before they were counted, that of the step
   * before.
   */
  active_nodes: number;
  /** particles that left through MPM_WALL_OPEN since the stepper was made */
  removed: number;
  /** how often particles were sorted anew since the stepper was made */
  resorts: number;
  /** id of the particle that failed, or -1 */
  particle: bigint;
  /**
   * Node that failed, or -1: its lexicographic number over the grid with one ghost layer per side,
   * ((ix+1)*(cells_y+3)+(iy+1))*(cells_z+3)+(iz+1) with unused axes left out.
   */
  node: number;
  /** iterations of the linear solver, summed over the step */
  linear_iterations: number;
  /** time of the state */
  t: number;
  /** size of the step that was tried; 0 before the first */
  dt: number;
  /**
   * After success the stable dt of the new state, or with MPM_NEWMARK 2 dt if there were at most 4 iterations
   * and else dt. After a failure 0.6 dt.
   */
  dt_suggested: number;
  /** last relative residual of the Newton iteration; 0 for explicit schemes */
  residual: number;
  /** sum m v.v / 2 */
  kinetic_energy: number;
  /** sum energy * initial_volume; NaN when a law has none */
  strain_energy: number;
  /**
   * Work during the step of gravity, acceleration and force callbacks, applied_force, surfaces, node hooks,
   * prescribed nodal velocities and prescribed particles.
   */
  external_work: number;
  /**
   * (kinetic + strain) before the step + external_work - (kinetic + strain) after; NaN where the strain
   * energy is.
   */
  dissipation: number;
  /** sum m v; along the radius of MPM_AXISYMMETRIC 0 */
  momentum: number[];
  /** sum m x cross v; in 2-D about z, in [2]; in 1-D and MPM_AXISYMMETRIC 0 */
  angular_momentum: number[];
  /** Sum of external_work over all committed steps since the stepper was made or its time was set. */
  external_work_total: number;
  /**
   * sum m tr(C D C^T) / 2: kinetic energy of the matrices that APIC, APIC_MLS, TPIC, TFLIP and AFLIP carry (C
   * is "velocity_gradient", D the second moments of the basis), whose angular momentum is part of
   * angular_momentum. It is not part of kinetic_energy. 0 with other transfers.
   */
  affine_kinetic_energy: number;
  /**
   * Energy that contact of bodies, obstacles and MPM_WALL_FRICTION took in the step, from the velocities that
   * the nodes would have without it: never negative. In explicit steps forces drive bodies that press on each
   * other together in every step, and contact takes that again: its sum over steps has a part that goes with
   * dt and is no loss. What is lost is `dissipation`.
   */
  contact_dissipation: number;
  /** nodes at which these gave each other an impulse */
  contact_nodes: number;
  /** velocity field of `node`; 0 where there is none */
  body: number;
  /**
   * Energy that local_damping and mass_damping took in the step: a part of `dissipation`. It is their force
   * times the mean of the nodes' velocities before and after, so that it is negative at nodes that turn.
   */
  damping_dissipation: number;
  /** Sum of damping_dissipation over all committed steps since the stepper was made or its time was set. */
  damping_dissipation_total: number;
}
/** Seconds of wall-clock time spent in steps since creation or the last reset, by stage. */
export interface Profile {
  /** sorting particles, activating nodes */
  sort: number;
  /** weights, particles to grid */
  p2g: number;
  /** nodal update, walls, prescribed velocities */
  grid: number;
  /** grid to particles */
  g2p: number;
  /** laws within g2p and assembly, from samples; their tangents are in assembly */
  law: number;
  /** residual and matrix */
  assembly: number;
  /** factorisation, set-up of preconditioners */
  factor: number;
  /** linear solves */
  solve: number;
  /** the host's callbacks */
  callbacks: number;
  /** whole steps */
  total: number;
  /** weights of the basis within p2g and g2p, from samples */
  weights: number;
}
/** What two bodies did to each other in the last step, and since then. Forces are means over the step. */
export interface ContactInfo {
  /** 1: an impulse was given */
  touching: number;
  /** nodes at which both have mass */
  nodes: number;
  /** of these, with an impulse */
  closed: number;
  /** of these, without slip */
  stuck: number;
  /** nodes that were left out: there is no normal, or both bodies are held */
  ambiguous: number;
  /** on the second body, force */
  force: number[];
  /** of the same about the origin; in 2-D in component 2; of MPM_AXISYMMETRIC without meaning */
  torque: number[];
  /** sum of the nodes' normal forces, >= 0 without adhesion */
  normal_force: number;
  /** of closed nodes, length^(dim - 1); of MPM_AXISYMMETRIC times radius */
  area: number;
  /**
   * largest normal force over area of a node, stress: rows of nodes on both sides of a surface share them
   * unevenly, and it may be twice what the surface has
   */
  pressure_max: number;
  /** smallest gap that was measured, length; < 0: overlap; infinity if none was */
  gap: number;
  /** friction and closing in the step; see contact_dissipation of mpm_step_info */
  dissipation: number;
  /** of it, by friction */
  friction_work: number;
  /**
   * on the second body over all committed steps since the stepper was made or mpm_stepper_set_time() was
   * called, mass length/time
   */
  impulse: number[];
}
/** What adaption has done to a set, in all steps since it was first described for it or the time was set. */
export interface AdaptionInfo {
  /** particles that were split */
  splits: number;
  /** particles that came by it */
  added: number;
  /** pairs that became one */
  merges: number;
  /** kinetic energy before, less that after: >= 0 of merges; splits with a matrix < 0 */
  kinetic_loss: number;
  /** the same of the matrices: what they give to velocities, and what is lost */
  affine_loss: number;
  /** the same of the strain energy, in merges; laws of the host are not counted */
  strain_loss: number;
  /** Angular momentum before, less that after: of merges without a matrix. 0 of MPM_AXISYMMETRIC. */
  angular_momentum_loss: number[];
}
/**
 * Where heat came from, in the last step and in all steps since the first set was described or the time was
 * set: gained = sum of walls + sources + surfaces + dissipated, to rounding, and with implicit conduction to
 * the tolerance. All are energies.
 */
export interface HeatInfo {
  /** of the last step's conjugate gradients */
  iterations: number;
  /** sum of mass specific_heat temperature now, of all sets that are described */
  heat: number;
  /** what particles took up in the last step */
  gained: number;
  /** through the faces, from MPM_X_MIN, into the material */
  walls: number[];
  /** of the callbacks */
  sources: number;
  /** through surfaces, into the material */
  surfaces: number;
  /** dissipated work that became heat */
  dissipated: number;
  /** the same in all steps, and so with those below */
  gained_total: number;
  /** through the faces */
  walls_total: number[];
  /** of the callbacks */
  sources_total: number;
  /** through surfaces */
  surfaces_total: number;
  /** dissipated work */
  dissipated_total: number;
}

/** What a call says that was not done. After a positive status everything is as it was before. */
export class MpmError extends Error {
  /** One of the constants from MPM_CUT_DT to MPM_E_INTERNAL. */
  readonly status: number;
  /** Its name, such as "MPM_E_ARG". */
  readonly code: string;
  /** Whether a smaller dt may do: the status is 1 to 5. */
  readonly retryable: boolean;
  /** What the step did that failed, where the call was one of a step. */
  readonly info?: StepInfo;
  constructor(status: number, code: string, text: string);
}

/** What a callback returns: nothing or 0 to go on, a status > 0 to ask for a smaller dt (MPM_CUT_DT), one < 0 to stop. */
export type Answer = number | void;
/** A vector for each axis: arrays of x, y and z of all items. */
export type Components = Float64Array[];

/** What a batch knows beside its numbers. It is of use during the call of its callback alone. */
export interface Lent {
  /** Lends a field of the set that the batch belongs to, with its stored components; see mpm_batch_field(). The caller
   * names components and type, because the library does not tell them here. Not for nodes, contacts,
   * distances and markers. */
  field(name: string, components?: number): Float64Array[];
  field(name: string, components: number, kind: 'i64'): BigInt64Array[];
  field(name: string, components: number, kind: 'u8'): Uint8Array[];
}
/**
 * Particles that a law is asked about. Arrays are [components][ld], of which the first n items of each
 * component count. Tensors are full: F, F_inc and L have component 3 * row + column, stresses xx yy zz xy yz
 * xz. In callbacks the memory belongs to the library and is valid during the call, and output arrays do not
 * overlap input arrays.
 */
export interface MaterialBatch {
  /** number of state variables of a particle */
  readonly state_count: number;
  /** number of particles, inert slots included */
  readonly n: number;
  /** distance from component c to c + 1, in elements; >= n */
  readonly ld: number;
  /** time at the end of the step */
  readonly t: number;
  /** size of the step; 0: the state as it is, see mpm_stress_fn */
  readonly dt: number;
  /** [ld] ids, < 0 for inert slots */
  readonly id: BigInt64Array;
  /** [9][ld] deformation gradient at the end of the step */
  readonly F: Float64Array[];
  /** [9][ld] deformation gradient of this step alone: F = F_inc F_old */
  readonly F_inc: Float64Array[];
  /** [9][ld] velocity gradient (F_inc - I) / dt, 1/time; 0 when dt is 0 */
  readonly L: Float64Array[];
  /** [6][ld] Cauchy stress before the step */
  readonly stress: Float64Array[];
  /** [state_count][ld] state variables before the step */
  readonly state: Float64Array[];
  /** [6][ld] out: Cauchy stress after the step */
  readonly stress_new: Float64Array[];
  /** [state_count][ld] out: state variables after the step */
  readonly state_new: Float64Array[];
  /** [ld] out: speed of the fastest elastic wave now, length/time */
  readonly wave_speed: Float64Array;
  /** [ld] out, preset 0: length^2/time, limits the explicit dt */
  readonly kinematic_viscosity: Float64Array;
  /** [ld] out, preset NaN (not known): strain energy per initial volume */
  readonly energy: Float64Array;
  /** [dim][ld] position at the start of the step */
  position(dim: number): Float64Array[];
}
/**
 * Particles of one set for which a force is wanted. Arrays are [components][ld], of which the first n items
 * of each component count. The memory belongs to the library and is valid during the call.
 */
export interface ParticleBatch {
  /** dimension of the grid */
  readonly dim: number;
  /** number of particles, inert slots included */
  readonly n: number;
  /** distance from component c to c + 1, in elements; >= n */
  readonly ld: number;
  /**
   * Time for which the value is wanted: the start of the step. Forces of MPM_NEWMARK are wanted for its end,
   * and for the start where accelerations are to be found.
   */
  readonly t: number;
  /** size of the step */
  readonly dt: number;
  /** [ld] ids, < 0 for inert slots */
  readonly id: BigInt64Array;
  /** [dim][ld] at the start of the step, wrapped on periodic axes unless total_lagrangian = 1 */
  readonly position: Float64Array[];
  /** [dim][ld], or NULL without reference_positions; never NULL with total_lagrangian = 1 */
  readonly reference_position: Float64Array[] | undefined;
  /** [dim][ld] at the start of the step */
  readonly velocity: Float64Array[];
  /** [ld] */
  readonly mass: Float64Array;
  /** [ld] at the start of the step */
  readonly volume: Float64Array;
}
/**
 * Active nodes of the grid. Arrays are [components][ld], of which the first n items of each component count.
 * The memory belongs to the library and is valid during the call.
 */
export interface NodeBatch {
  /** dimension of the grid */
  readonly dim: number;
  /** velocity field of the nodes; see mpm_stepper_set_body() */
  readonly body: number;
  /** number of nodes */
  readonly n: number;
  /** distance from component c to c + 1, in elements; >= n */
  readonly ld: number;
  /** time for which the value is wanted */
  readonly t: number;
  /** size of the step */
  readonly dt: number;
  /**
   * [dim][ld] index of the basis function, from -1 to cells + 1. Ghosts lie outside 0 to cells. Open knots
   * have no ghosts, and other functions at these indices: go by position.
   */
  readonly index: BigInt64Array[];
  /** [dim][ld] origin + index * spacing; with open knots the Greville points */
  readonly position: Float64Array[];
  /** [ld] */
  readonly mass: Float64Array;
  /**
   * [ld] 1 on exactly one of the parts that have the node, for sums of the host, else 0; all 1 with one part:
   * see parallel.h. Since 0.2.0.
   */
  readonly owned: Uint8Array;
}
/** Nodes at which two bodies touch, for mpm_friction_fn. Arrays belong to the library. */
export interface ContactBatch {
  /** dimension of the grid */
  readonly dim: number;
  /** the first body, the lower number */
  readonly body_a: number;
  /** the second body */
  readonly body_b: number;
  /** number of nodes */
  readonly n: number;
  /** distance from component c to c + 1, in elements; >= n */
  readonly ld: number;
  /** time at the start of the step */
  readonly t: number;
  /** size of the step */
  readonly dt: number;
  /** [dim][ld] of the nodes */
  readonly position: Float64Array[];
  /** [dim][ld] unit normal, from the first body to the second */
  readonly normal: Float64Array[];
  /** [ld] length */
  readonly gap: Float64Array;
  /** [ld] length^(dim - 1); of MPM_AXISYMMETRIC times radius */
  readonly area: Float64Array;
  /** [dim][ld] tangential velocity of the second body relative to the first, before the impulse */
  readonly slip: Float64Array[];
  /** [ld] normal traction of the frictionless impulse, stress */
  readonly pressure: Float64Array;
}
/**
 * Points whose distance from an obstacle is asked for. All is in the axes of the body, from its centre; in
 * space these are the same until it moves. Arrays belong to the library.
 */
export interface DistanceBatch {
  /** dimension of the grid */
  readonly dim: number;
  /** number of points */
  readonly n: number;
  /** distance from component c to c + 1, in elements; >= n */
  readonly ld: number;
  /**
   * time at the start of the step; in implicit steps with contact a second time that at its end, for
   * particles and the pose of that time
   */
  readonly t: number;
  /** [dim][ld] */
  readonly position: Float64Array[];
  /**
   * [ld] to be set: signed distance, > 0 outside. It must be right up to two spacings, and the offset of the
   * obstacle's rule, off the surface; farther out it may be smaller than it is, but not than that
   */
  readonly distance: Float64Array;
  /** [dim][ld] to be set: unit gradient of the distance */
  readonly normal: Float64Array[];
  /**
   * [dim][ld] preset to 0: of the surface there, beside the rigid motion. NULL for points at which it is not
   * asked for
   */
  readonly velocity: Float64Array[] | undefined;
}
/**
 * Markers for which tractions are wanted. Arrays are [components][ld], belong to the library and are valid
 * during the call.
 */
export interface MarkerBatch {
  /** dimension of the grid */
  readonly dim: number;
  /** number of markers */
  readonly n: number;
  /** distance from component c to c + 1, in elements; >= n */
  readonly ld: number;
  /** time for which the value is wanted: the start of the step, or the end of an implicit one */
  readonly t: number;
  /** size of the step */
  readonly dt: number;
  /** [ld] ids, ascending */
  readonly id: BigInt64Array;
  /** [dim][ld] */
  readonly position: Float64Array[];
  /** [dim][ld] area vectors */
  readonly area: Float64Array[];
  /** [ld] area when the marker was added */
  readonly reference_area: Float64Array;
  /** [dim][ld] since the marker was added */
  readonly displacement: Float64Array[];
  /** [dim][ld] of the material there, in the last step */
  readonly velocity: Float64Array[];
}
/**
 * Particles that are to be split, or pairs that are to be merged. Arrays belong to the library and are valid
 * during the call.
 */
export interface AdaptionBatch {
  /** MPM_ADAPT_SPLIT or MPM_ADAPT_MERGE */
  readonly what: number;
  /** how many */
  readonly n: number;
  /** distance from component c to c + 1 of position, in elements; >= n */
  readonly ld: number;
  /** dimension of the grid */
  readonly dim: number;
  /** [ld] ids, ascending; of pairs that of the particle that stays */
  readonly id: BigInt64Array;
  /** [ld] ids of the particles that go; NULL where particles are split */
  readonly other: BigInt64Array | undefined;
  /** [dim][ld] of the particle, or of the one that stays */
  readonly position: Float64Array[];
}

/**
 * add[c][i] += value for axis c and particle i.
 *
 * Gives a vector per particle (mt): the callback does add[c * ld + i] += value for c < dim, because several
 * sources add to the same array. Returns 0, a value > 0 to ask for a smaller dt (MPM_CUT_DT), or a value < 0
 * to stop (MPM_E_CALLBACK).
 */
export type ParticleFunction = (batch: ParticleBatch & Lent, add: Components) => Answer;
/**
 * prescribed[c][i] = 1 and velocity[c][i] = value for axis c and node i.
 *
 * Prescribes nodal velocities (mt). For the nodes and axes to hold, the callback sets prescribed[c * ld + i]
 * = 1 (preset 0), and velocity[c * ld + i] to the mean velocity of the step, so that the displacement
 * increment is dt * velocity in every scheme. Where several prescribe one node and axis, the first of these
 * wins: this callback, prescribed particles (their mean weighted by mass), walls; the reaction counts for the
 * winner. The callback is asked once per step, in the first projection of particles onto nodes; further
 * projections keep to the answer. Returns as mpm_particle_fn does.
 */
export type VelocityFunction = (batch: NodeBatch, prescribed: Uint8Array[], velocity: Components) => Answer;
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
export type NodeFunction = (batch: NodeBatch, velocity: Components, force: Components) => Answer;
/**
 * Sets the coefficients of friction of nodes (mt): friction[ld], preset to that of the pair of bodies, may be
 * changed to any finite value >= 0; it then also is that of sticking. It is asked once in a step, with
 * MPM_USF twice: first with the forces of the old stress. Returns as mpm_particle_fn does.
 */
export type FrictionFunction = (batch: ContactBatch, friction: Float64Array) => Answer;
/**
 * Says which of them are left as they are: accept[i], [ld], is 1, and the callback writes 0 to keep the i-th
 * from it. It runs on the thread of the call. Returns as mpm_particle_fn does.
 */
export type AdaptionFunction = (batch: AdaptionBatch, accept: Uint8Array) => Answer;
/**
 * Heat sources: writes power[i], [ld], power per present volume, at the time batch->t: the start of the step,
 * and with implicit conduction its end. It runs as mpm_particle_fn does, on all threads, and returns as that
 * does. A value that is not finite ends the step: MPM_NONFINITE.
 */
export type HeatFunction = (batch: ParticleBatch & Lent, power: Float64Array) => Answer;
/**
 * Gives distances of points (mt). Points are particles, and nodes of blocks that are near the obstacle, also
 * those without material: nodes lie in the grid or up to one spacing beyond its faces, and of a grid with
 * total_lagrangian = 1 where the material has taken them. On periodic axes a point is the image nearest to
 * the centre. Returns as mpm_particle_fn does. A value that is not finite, or a normal whose length is not 1
 * to 1e-6, ends the step: MPM_NONFINITE, MPM_E_CALLBACK.
 */
export type DistanceFunction = (batch: DistanceBatch) => Answer;
/**
 * add[c][i] += value for axis c and marker i.
 *
 * Gives tractions: the callback does add[c * ld + i] += force per present area of marker i, c < dim. It runs
 * on the thread of the call, once per step. Returns as mpm_particle_fn does. A value that is not finite ends
 * the step: MPM_NONFINITE.
 */
export type TractionFunction = (batch: MarkerBatch, add: Components) => Answer;
/**
 * add[c][i] += value for axis c and marker i.
 *
 * Gives velocities: the callback does add[c * ld + i] += mean velocity of marker i over the step that begins
 * at batch->t, c < dim. It runs on the thread of the call, once per step, for surfaces that prescribe.
 * Returns as mpm_particle_fn does. A value that is not finite ends the step: MPM_NONFINITE.
 */
export type MarkerVelocityFunction = (batch: MarkerBatch, add: Components) => Answer;
/**
 * Watches steps. It is called on the calling thread at least once in each step before the step is committed,
 * and after each Newton iteration, with what is known so far; info belongs to the library. Returns 0 to go
 * on, a value > 0 to end the call with MPM_CANCELLED, or a value < 0 to end it with MPM_E_CALLBACK; the step
 * is then not committed.
 */
export type ProgressFunction = (info: StepInfo) => Answer;
/**
 * Gives the mean velocity[3] and angular velocity[3] of the step from t over dt; both are preset to the
 * present ones. It is called once per step, on the thread of the call. Returns as mpm_particle_fn does.
 */
export type MotionFunction = (t: number, dt: number, velocity: Float64Array, angular_velocity: Float64Array) => Answer;
/**
 * Tells which of n points are inside a body: the callback writes inside[i] = 1 or 0 for the point with the
 * coordinates position[c * ld + i], c < dim. It runs on the calling thread. A return other than 0 ends the
 * fill with MPM_E_CALLBACK; nothing is then added.
 */
export type InsideFunction = (position: Components, inside: Uint8Array) => Answer;
/**
 * A law (mt). It reads the state before the step and the deformation of the step, and writes stress_new,
 * state_new and wave_speed of all n items, and kinematic_viscosity and energy where it has them. A wave speed
 * or a viscosity below 0 stops the step or the call that asked (MPM_E_CALLBACK), and an infinite energy or
 * any other value that is not finite is MPM_NONFINITE; both name the particle. The law may be called several
 * times for one step, and nothing that it writes counts before the step is committed: it keeps no state of
 * its own.
 *
 * With dt = 0, F_inc = I and L = 0 the library asks for stress, wave speed and energy of the state as it is:
 * the law returns the stress that belongs to that state.
 *
 * Returns 0, a value > 0 to ask for a smaller dt (MPM_CUT_DT), or a value < 0 to stop (MPM_E_CALLBACK).
 */
export type StressFunction = (batch: MaterialBatch & Lent) => Answer;
/**
 * Returns whether c has major symmetry at every item.
 *
 * The tangent of a law (mt), for implicit steps. It is called after the law on the same batch, with the law's
 * outputs in place, and writes tangent[component * ld + i], a stress, in the form that tangent_form names.
 * With tau = J stress and the variation dF = L F, c is the derivative of the Lie derivative of tau: c_ijkl =
 * d tau_ij / d L_kl - delta_ik tau_jl - delta_jk tau_il.
 *
 * - MPM_TANGENT_MINOR_SYMMETRIC has component 6 * row + column, where rows and columns are xx yy zz xy yz xz,
 *   and columns are for engineering shear.
 * - MPM_TANGENT_GENERAL has component 9 * (3 * i + j) + 3 * k + l.
 *
 * Into *symmetric the callback writes 1 if c has major symmetry (c_ijkl = c_klij) at every item, 0 otherwise.
 * Returns as mpm_stress_fn does.
 */
export type TangentFunction = (batch: MaterialBatch & Lent, tangent: Components) => boolean | Answer;
/**
 * Vectors are copies; solution is read when the function returns. It returns the number of iterations, or
 * false if the system was not solved.
 *
 * Solves matrix * solution = rhs. Runs on the calling thread. Both vectors have as many entries as
 * mpm_operator_get_info() reports owned rows, and solution is preset to the best guess known. The host writes
 * the solution, and into *iterations the number that linear_iterations is to count.
 *
 * - tolerance: the wanted ||matrix * solution - rhs|| / ||rhs||.
 *
 * Returns 0, a value > 0 if the system was not solved (MPM_CUT_DT), or a value < 0 to stop (MPM_E_CALLBACK).
 *
 * With several parts (parallel.h) it is called on all of them, and solves the system of all rows together:
 * each part lends the rows that it owns, complete, with the right-hand side on them, and takes its part of
 * the solution. Where the solver returns another value than 0 on a part, all parts have the outcome of the
 * lowest such; of the iterations the largest number counts. The residual is checked over all parts. A solver
 * that waits for its other parts ends on all of them when it ends on one.
 */
export type SolveFunction = (matrix: System, rhs: Float64Array, solution: Float64Array, tolerance: number) => number | boolean | void;

/**
 * A linear system. The caller sets struct_size. The arrays belong to the library and are valid until the
 * solve callback returns. A row is one component of one node; nodes and components whose displacement is
 * prescribed have none. Rows of one node follow each other, by ascending component.
 *
 * With several parts a row is owned by exactly one part. Local rows 0 to owned_rows - 1 are those that this
 * part owns, in the order of nodes that it has; they are numbered first_row, first_row + 1, ... over all
 * parts, part by part. Behind them stand rows that other parts own, those alone that columns of owned rows
 * name: they have number, node, component and position, and no entries of their own. Every vector has
 * owned_rows entries. With one part all rows are owned, and number[i] is i.
 *
 * What a solver has made of a pattern serves as long as pattern_id is the same, of another stepper too.
 */
export interface System extends OperatorInfo {
  /** [rows] number of the node of each row, as in mpm_step_info.node */
  readonly node: BigInt64Array;
  /** [rows] axis of each row */
  readonly component: Int32Array;
  /** [dim][ld] position of the node of each row, for near-null spaces */
  readonly position: Components;
  /**
   * Computes y = matrix * x on owned rows. Both vectors have owned_rows entries and do not overlap.
   *
   * With several parts it is (collective): x of rows that others own comes from them. It fails on all parts
   * that make it when one is refused, and with MPM_E_STATE when the solver has returned on a part, so that
   * nobody waits.
   */
  apply(x: ArrayLike<number>): Float64Array;
  /** A copy of the matrix by compressed rows, with both triangles: row r has the entries row_start[r] to row_start[r + 1] - 1. */
  csr(): { row_start: BigInt64Array; column: Int32Array; value: Float64Array };
}

/** Services of the host. */
export interface ContextOptions extends ContextDesc {
  /**
   * Takes a finished text without newline, with a level MPM_LOG_*. The text is valid during the call. Default
   * NULL: the library is silent, since it never writes to the standard streams. Called on the calling thread
   * only.
   */
  log?: (level: number, text: string) => void;
}
/** A law of the host. */
export interface LawOptions extends MaterialDesc {
  /** the law; the host must set it */
  stress: StressFunction;
  /** NULL (default): stresses are differenced, in the general form */
  tangent?: TangentFunction;
  /** State variables of a new particle, as many as there are. Default: zeros, state_count of them. */
  state_initial?: ArrayLike<number>;
}
/** An obstacle. */
export interface ObstacleOptions extends ObstacleDesc {
  /**
   * kind, friction, friction_static, adhesion and offset count: how it meets the material. Copied. NULL
   * (default): those of mpm_contact_desc_init().
   */
  contact?: ContactDesc;
  /** of MPM_SHAPE_DISTANCE */
  distance?: DistanceFunction;
}
/** Items for Material.update(): arrays are [components][n]. */
export interface Items {
  n: number;
  t?: number;
  dt: number;
  id?: ArrayLike<number | bigint>;
  F: ArrayLike<number>;
  F_inc: ArrayLike<number>;
  L?: ArrayLike<number>;
  stress: ArrayLike<number>;
  state?: ArrayLike<number>;
  position?: ArrayLike<number>;
  /** Whether the tangent is wanted. */
  tangent?: boolean;
}
export interface Updated {
  stress_new: Float64Array;
  state_new: Float64Array;
  wave_speed: Float64Array;
  kinematic_viscosity: Float64Array;
  energy: Float64Array;
  /** [81][n] in the general form, where it was wanted. */
  tangent?: Float64Array;
  symmetric?: boolean;
}
/** New particles: arrays are [dim][n], and volume has n entries. */
export interface NewParticles {
  position: ArrayLike<number>;
  velocity?: ArrayLike<number>;
  volume: ArrayLike<number>;
  size?: ArrayLike<number>;
  ids?: ArrayLike<number | bigint>;
}
/** New markers: arrays are [dim][n]. Without area they follow the material and carry nothing. */
export interface NewMarkers {
  position: ArrayLike<number>;
  area?: ArrayLike<number>;
}
export interface Filled {
  first_id: bigint;
  count: number;
}
export interface Field {
  name: string;
  /** MPM_F64, MPM_I64 or MPM_U8. */
  type: number;
  /** Components of copies: tensors are full. */
  components: number;
  writable: boolean;
}
export type FieldArray = Float64Array | BigInt64Array | Uint8Array;

/** An object of the library. It is freed by dispose(), or when it is collected; what it needs stays until then. */
interface Handle {
  /** Frees the object, once nothing else needs it. It is of no use afterwards; a second call does nothing. */
  dispose(): void;
  readonly disposed: boolean;
  [Symbol.dispose](): void;
}

/**
 * A context holds the services of the host (memory, threads, log) and the text of the last error. Every other
 * object is made with one. See context.h.
 */
export class Context implements Handle {
  private constructor();
  dispose(): void;
  readonly disposed: boolean;
  [Symbol.dispose](): void;
  /**
   * Tells how many bytes the context and its objects hold now, and the most that they ever held. Either
   * output pointer may be NULL. Any thread, any time while the context lives, also in callbacks.
   */
  memory(): { bytes: number; peak_bytes: number };
  /**
   * Gives one or two sentences, with the offending names and values, on the last call on this context or its
   * objects that did not return MPM_OK. Calls that succeed leave them as they are, so that a host may clean
   * up and log first and ask then; "" while no call has failed. The text belongs to the library and is valid
   * until the next call on the context. Of NULL, and of a handle of another kind, a sentence that says so:
   * the calls that get no further than to such a handle have no other. A context that was destroyed must not
   * be given to this or any other call. May be called in callbacks, too, on the thread of the call.
   */
  lastError(): string;
  /**
   * Makes a grid. desc is copied. Any number of sets and steppers share the grid, which outlives them. *out
   * is NULL unless MPM_OK is returned. MPM_E_ARG: a value is bad, or there are more nodes than 64-bit numbers
   * can name. MPM_E_UNSUPPORTED: open knots are asked for with a basis other than MPM_BSPLINE2 and
   * MPM_BSPLINE3; MPM_AXISYMMETRIC and MPM_PLANE_STRESS with a dim other than 2, the former with a periodic
   * first axis.
   */
  grid(desc: GridDesc): Grid;
  /**
   * Makes a material from a built-in law. In the table stresses are Cauchy stresses, and J = det F.
   *
   * | model                   | parameters                              | law                                 |
   * |-------------------------|-----------------------------------------|-------------------------------------|
   * | "linear_elastic"        | E, nu, density                          | hypoelastic: with F_inc = V R,      |
   * |                         |                                         | stress' = R stress R^T + C : ln V   |
   * | "neo_hookean"           | E, nu, density                          | Steffen et al. 2008, eq. 46         |
   * | "neo_hookean_decoupled" | mu, kappa, density                      | Guilkey & Weiss 2003, eq. 20        |
   * | "j2"                    | E, nu, density, yield_stress, hardening | linear_elastic with von Mises yield |
   * |                         |                                         | and linear isotropic hardening      |
   * | "newtonian_fluid"       | density, bulk_modulus, gamma,           | p = bulk_modulus / gamma            |
   * |                         | viscosity, tension                      | (J^-gamma - 1), dynamic viscosity;  |
   * |                         |                                         | tension 0 cuts off p < 0            |
   * | "rigid"                 | density                                 | no stress; moves as prescribed      |
   * | "drucker_prager"        | E, nu, density, phi, psi, cohesion,     | elastic in the logarithmic strain;  |
   * |                         | cone, tension_cutoff, hardening,        | yields at q = M p + k: sand, gravel |
   * |                         | cohesion_residual, close_gaps           | and other soils; opens in tension   |
   * | "mohr_coulomb"          | those of drucker_prager without cone    | the same by the planes of           |
   * |                         |                                         | Mohr-Coulomb; phi = 0 is Tresca     |
   * | "herschel_bulkley"      | density, bulk_modulus, gamma,           | p of newtonian_fluid; elastic in    |
   * |                         | shear_modulus, yield_shear,             | shear up to yield_shear, then flow: |
   * |                         | consistency, n, tension                 | + consistency (shear rate)^n        |
   * | "snow"                  | E, nu, density, hardening,              | Stomakhin et al. 2013: elastic      |
   * |                         | critical_compression, critical_stretch, | stretches within bounds, hardens by |
   * |                         | hardening_max                           | compaction                          |
   * | "mu_i"                  | E, nu, density, mu_s, mu_2, I_0,        | Jop et al. 2006: grains that flow   |
   * |                         | grain_diameter, grain_density           | with friction mu(I); no tension     |
   * | "cam_clay"              | density, kappa, lambda, M, mu0, alpha,  | modified Cam-clay in the logarithmic|
   * |                         | p_ref, pc0, p_min                       | strain; needs an initial stress     |
   *
   * params are count pairs of name and value in any order, which are copied; parameters that are not named
   * take their defaults. mpm_material_model_param() lists units, defaults and ranges. *out is NULL unless
   * MPM_OK is returned. MPM_E_NOT_FOUND: there is no such model or parameter. MPM_E_ARG: a value is out of
   * range, a name is given twice, values do not go together, or a parameter without default is missing.
   */
  material(model: string, params: Record<string, number>): Material;
  /**
   * Makes a material from a law of the host. desc is copied. *out is NULL unless MPM_OK is returned.
   * MPM_E_ARG: a value is bad, or stress is NULL.
   */
  law(desc: LawOptions): Material;
  /**
   * Makes an empty set on a grid, of one material; both outlive it. *out is NULL unless MPM_OK is returned.
   * MPM_E_ARG: grid or material are of another context. MPM_E_UNSUPPORTED: a fluid on an MPM_CPGIMP grid; a
   * fluid, snow, clay or mu_i on an MPM_PLANE_STRESS grid; a fluid where total_lagrangian = 1.
   */
  particles(grid: Grid, material: Material): Particles;
  /**
   * Makes an obstacle. The desc is copied. *out becomes NULL on failure. MPM_E_ARG: a value is bad.
   * MPM_E_UNSUPPORTED: velocities of a fixed one, bounds of one that the material is inside of.
   */
  obstacle(desc: ObstacleOptions): Obstacle;
  /**
   * Makes a surface without markers on a grid, which outlives it. desc is copied and may be NULL for the
   * defaults. *out is NULL unless MPM_OK is returned. MPM_E_ARG: a value is bad, or the grid is of another
   * context.
   */
  surface(grid: Grid, desc?: SurfaceDesc): Surface;
  /**
   * Makes a stepper at t = 0 and step 0, without sets, with MPM_WALL_NONE on all faces (the axis of
   * MPM_AXISYMMETRIC has MPM_WALL_SLIP). desc is copied and may be NULL for the defaults. The grid outlives
   * the stepper. *out is NULL unless MPM_OK is returned. MPM_E_ARG: a value is bad, or the grid is of another
   * context. MPM_E_UNSUPPORTED: the combination is not offered; the error text says what to use instead.
   */
  stepper(grid: Grid, desc?: StepperDesc): Stepper;
}

/** A background grid has a dimension, bounds, spacings, a basis and periodic axes. See grid.h. */
export class Grid implements Handle {
  private constructor();
  dispose(): void;
  readonly disposed: boolean;
  [Symbol.dispose](): void;
  readonly dim: number;
}

/** A material is one constitutive law with its parameters. Any number of sets share it. See material.h. */
export class Material implements Handle {
  private constructor();
  dispose(): void;
  readonly disposed: boolean;
  [Symbol.dispose](): void;
  /** State variables of a particle. */
  readonly stateCount: number;
  /**
   * Outputs are new arrays.
   *
   * Runs a material, built in or the host's, without a grid: what a step does to its particles, for n items
   * of the caller. It is how parameters are fitted to tests of the laboratory.
   *
   * The caller fills batch: struct_size, state_count (that of the material), n, ld, t, dt, F (at the end of
   * the step), F_inc, stress and state before the step, and the arrays for stress_new and state_new, all in
   * the forms of mpm_material_batch. These may be NULL: id (items then have ids from 0; items with ids < 0
   * are inert, and what their outputs hold is not said), L (made of F_inc and dt; what is given must be
   * (F_inc - I) / dt), position ([3][ld]; zeros), wave_speed, kinematic_viscosity and energy (not wanted),
   * state and state_new of a law without state. lookup is not used: a law of the host gets NULL. Outputs may
   * be the arrays of inputs: stress_new that of stress, say. With dt = 0 the answer is the state as it is,
   * see mpm_stress_fn, whatever F_inc and L are.
   *
   * tangent is NULL or [81][ld], and receives the tangent of the step in the general form of mpm_tangent_fn;
   * dt must be > 0 then. Into *symmetric goes 1 if it has major symmetry at every item, else 0; it may be
   * NULL, and is left alone without a tangent.
   *
   * Bits are those of a 3-D step on the same instruction set. The calling thread does all the work, as for
   * other calls of the context. MPM_E_ARG: an array is NULL, a number is out of range, or L and F_inc
   * disagree. MPM_NONFINITE: a value that is given or that comes out is not finite. MPM_INVERTED: det F or
   * det F_inc is not positive. MPM_CUT_DT and MPM_E_CALLBACK: as in a step. What is wrong with an item names
   * it, what a law returned the items that it was asked about. After a failure items before these may have
   * been written.
   */
  update(items: Items): Updated;
}

/** A set holds particles of one material on one grid. See particles.h. */
export class Particles implements Handle {
  private constructor();
  dispose(): void;
  readonly disposed: boolean;
  [Symbol.dispose](): void;
  readonly grid: Grid;
  readonly material: Material;
  /** The number of particles, inert slots not counted; 0 for NULL. */
  readonly count: number;
  /**
   * Fills the box from lower[dim] to upper[dim] with particles at rest on a lattice aligned with the cells,
   * with per_cell[dim] particles along each axis of a cell, wherever the centre is inside. Each has the
   * volume and the size of one lattice cell, so that domains of GIMP fill the body. The ids of the new
   * particles are *first_id to *first_id + *count - 1; both pointers may be NULL.
   *
   * What a shape has beyond the grid is left out, on periodic axes too, as symmetry planes want it: *count
   * tells how many particles there are. That holds for all fills. per_cell is 1 to 64, and a box has at most
   * 2^32 lattice points, in the shape or not.
   *
   * MPM_E_ARG: a bound is not finite, lower >= upper on an axis, the box does not meet the grid, or a limit
   * is exceeded.
   */
  fillBox(lower: ArrayLike<number>, upper: ArrayLike<number>, perCell: ArrayLike<number>): Filled;
  /**
   * Fills a ball (2-D: disc, 1-D: interval) around centre[dim] of a radius > 0, as mpm_particles_fill_box()
   * fills a box. The centre lies in the grid.
   */
  fillBall(centre: ArrayLike<number>, radius: number, perCell: ArrayLike<number>): Filled;
  /**
   * Fills what a mesh encloses, as mpm_particles_fill_box() fills a box: triangles in 3-D, edges in 2-D.
   *
   * - position: [dim][n] of the points; n is 1 to 2^31 - 1.
   * - corner: corner[dim * i + j] is the number of corner j of element i, of `elements`, 1 to 2^31 - 1. In
   *   3-D the corners go counter-clockwise as seen from outside, in 2-D the outline goes counter-clockwise
   *   round the body. A mesh that is turned inside out encloses the same. Shells within that are turned the
   *   other way bound cavities.
   * - Points with the same coordinates are one point, so that triangles as files hold them need no sorting
   *   out.
   *
   * A particle comes wherever the generalised winding number is above 1/2 or below -1/2 (Jacobson, Kavan &
   * Sorkine-Hornung 2013, Robust inside-outside segmentation using generalized winding numbers, ACM Trans.
   * Graph. 32(4), 33). Bodies that overlap are filled once. Holes do no harm as long as they are small beside
   * the body, but a mesh without any costs far less time. A lattice point on the mesh itself may be in or
   * out. The mesh is read during the call only.
   *
   * MPM_E_ARG: a position is not finite, a corner does not exist, the mesh is flat or does not meet the grid,
   * or a limit is exceeded. MPM_E_UNSUPPORTED: the grid is 1-D. Nothing is then added.
   */
  fillMesh(position: ArrayLike<number>, corner: ArrayLike<number | bigint>, perCell: ArrayLike<number>): Filled;
  /** Fills that part of a box which the callback accepts, as mpm_particles_fill_box() fills the whole. */
  fill(lower: ArrayLike<number>, upper: ArrayLike<number>, perCell: ArrayLike<number>, inside: InsideFunction): Filled;
  /**
   * Returns the first id.
   *
   * Adds n particles with F = I, zero stress and the law's initial state: all or none. The arrays are copied;
   * position, velocity and size are [dim][n] with ld = n.
   *
   * - position: a length, inside the grid; on a periodic axis one outside is wrapped, and its images are
   *   counted. With total_lagrangian = 1 the wrapped place is that in the grid, "reference_position" and
   *   "position" alike.
   * - velocity: length/time; NULL for zeros.
   * - volume: [n] initial volume, of the undeformed material, > 0; mass = density * volume.
   * - size: full initial edge lengths of the domain, > 0; NULL for a cube (2-D: square) of that volume.
   *   MPM_GIMP and MPM_CPGIMP use it; on other grids it is kept as given.
   * - ids: [n] the host's own ids, >= 0 and unique in the set; NULL to number on from the largest so far. A
   *   set holds fewer than 2^32 particles.
   * - first_id: the first of the ids is written to it; may be NULL.
   *
   * MPM_E_ARG: a value is not finite, a position is outside the grid, a volume or size is <= 0, or an id is
   * negative or in use.
   */
  add(particles: NewParticles): bigint;
  /**
   * Removes the n particles with the given ids: all or none. MPM_E_NOT_FOUND: an id is not in the set.
   * MPM_E_ARG: an id is given twice.
   */
  remove(ids: ArrayLike<number | bigint>): void;
  /**
   * All particles by ascending id, or those with these ids in this order, as bytes for `unpack`.
   *
   * Packs n particles into a buffer, for hosts that move them themselves: between sets, programs, machines.
   * They have every field in use, bit by bit, with ids, images and the host's fields, and what says of which
   * law they are. The order of bytes is the same on all machines. The particles stay in the set.
   *
   * - ids: [n], each once, in this order; NULL for all particles by ascending id, where n is
   *   mpm_particles_count().
   * - buffer: of `capacity` bytes, of which those of mpm_particles_packed_size() are written; anywhere.
   *
   * Of a problem in several parts these are particles of this part, and no other part takes part.
   * MPM_E_NOT_FOUND: an id is not in the set. MPM_E_ARG: capacity is too small, an id is given twice, n does
   * not match or buffer is NULL. MPM_E_STATE: a staged step is under way, a view of the set is out for
   * writing, or a value that was written through one is bad. Since 0.2.0.
   */
  pack(ids?: ArrayLike<number | bigint>): Uint8Array;
  /**
   * Takes what `pack` has given, of this set or of another.
   *
   * Adds packed particles to a set, bit by bit: all or none. The law is not asked: stress, state variables
   * and volume come along. Fields that the set has and the buffer lacks have the values of new particles.
   * Grids may have other cells and bases, if the particles lie inside.
   *
   * Of a problem in several parts they are added to this part, and no other part takes part; the next step
   * brings them home. MPM_E_FORMAT: the buffer is damaged; it is of another law, or of other parameters,
   * dimension, geometry or kind of grid, or counts images of other periods; or it has fields that the set has
   * not: of the host, of another type, or "reference_position" and "dilation_ratio" where no stepper keeps
   * them. MPM_E_ARG: an id is in use, or a particle lies outside the grid, which the text names; or buffer is
   * NULL. MPM_E_STATE: as for all that changes a set. Since 0.2.0.
   */
  unpack(packed: Uint8Array): void;
  /** The fields of the set, those of the host included. */
  fields(): Field[];
  /**
   * Adds a field of the host, zero in every particle. It travels with the particles, is saved with them, and
   * reaches callbacks through mpm_batch_field(). The name has 1 to 47 characters of a-z, 0-9 and _; type is
   * MPM_F64, MPM_I64 or MPM_U8; components are 1 to 64. A set has at most 64 fields, the 17 of the table
   * included. MPM_E_ARG: the name is bad or taken, or a value is. MPM_E_STATE: there is no room for one more.
   */
  addField(name: string, type: number, components?: number): void;
  /**
   * The field goes to a function, as an array for each stored component, and is given back when that returns.
   * The arrays have no entries then. The result is the function's.
   *
   * Lends a field in library order, with its stored components and with inert slots (id < 0); a map of "id"
   * tells which is which. access is MPM_READ, MPM_WRITE or both. The caller sets the view's struct_size.
   * Until mpm_view_release() steps return MPM_E_STATE. Of a set at most 64 views are out at once. A view
   * without MPM_WRITE is for reading: see mpm_view_release() for what becomes of changes. MPM_E_NOT_FOUND:
   * there is no such field. MPM_E_ARG: MPM_WRITE is asked for on a field that is not writable. MPM_E_STATE:
   * 64 views are out.
   */
  map<T>(field: string, access: number, use: (components: Float64Array[], count: number) => T): T;
  map<A extends FieldArray, T>(field: string, access: number, use: (components: A[], count: number) => T): T;
  /**
   * Returns a new array, a BigInt64Array for MPM_I64 and a Uint8Array for MPM_U8.
   *
   * Copies a field of n particles into out, [components][n] with ld = n; tensors are full. ids are [n], or
   * NULL for all particles by ascending id, where n is mpm_particles_count(). type and components must match
   * the full field, to guard the host's buffer. MPM_E_NOT_FOUND: there is no such field or id. MPM_E_ARG:
   * type, components or n do not match.
   */
  get(field: 'id' | 'image', ids?: ArrayLike<number | bigint>): BigInt64Array;
  get(field: 'prescribed', ids?: ArrayLike<number | bigint>): Uint8Array;
  get(field: string, ids?: ArrayLike<number | bigint>): Float64Array;
  get<A extends FieldArray>(field: string, ids?: ArrayLike<number | bigint>): A;
  /**
   * Copies values into a field, laid out as in mpm_particles_get(): all or none. Errors are those of
   * mpm_particles_get(), and MPM_E_ARG: a value is not finite or gives det F <= 0, a position is outside the
   * grid, or the field is not writable.
   */
  set(field: string, values: ArrayLike<number | bigint>, ids?: ArrayLike<number | bigint>): void;
  /**
   * A field of one component also takes a number.
   *
   * Sets a field to one value[components] in every particle of the set. Errors are those of
   * mpm_particles_set().
   */
  setAll(field: string, value: ArrayLike<number | bigint> | number | bigint): void;
  /**
   * Gives all particles the stress of ground at rest below a level surface: along `axis` the pressure of the
   * weight above, surcharge + density * |gravity| * depth with the material's density, and K0 times that
   * across it; no shear. Each layer is a set, whose surface is its top and whose surcharge the weight of what
   * lies on it.
   *
   * - gravity: acceleration along the axis, length/time^2, with its sign, as in mpm_stepper_desc: with a
   *   negative one the ground lies below the surface in the sense of falling coordinates. Not 0.
   * - surface: coordinate of the surface on the axis, a length. No particle may lie above it.
   * - K0: horizontal over vertical stress, >= 0: nu / (1 - nu) is what an elastic column has that was never
   *   strained across, 1 - sin(phi) what sand has. One that a law cannot bear is no error: its first step
   *   returns the stress to the yield surface.
   * - surcharge: pressure on the surface, a stress >= 0. It must also be applied, or the ground heaves.
   *
   * Positions, velocities, masses, state variables and present volumes stay. Where stress is the state of the
   * law, deformation_gradient becomes I and initial_volume the present volume. Where stress follows from
   * deformation_gradient, that becomes the diagonal one that has the stress, up to rounding, and
   * initial_volume the present volume over its determinant; in 1-D, where nothing is stored across, the
   * stress across is then that of the law, whatever K0 is. herschel_bulkley gets the mean of the stress so,
   * and its deviator as it is given. dilation_ratio becomes 1, and with MPM_CPGIMP the field "size" what
   * keeps the domains as they are.
   *
   * The set is unchanged on failure. MPM_E_ARG: a value is bad or not finite, the axis is periodic, a
   * particle lies above the surface, or no deformation has the stress; the particle is named.
   * MPM_E_UNSUPPORTED: the law is "rigid", or "snow", whose stress takes more than a deformation; it is
   * "newtonian_fluid" and K0 is not 1; or, of the host's laws, one that asked with dt = 0 does not answer
   * with the stress that it has; the grid is MPM_PLANE_STRESS, or axis the radius of MPM_AXISYMMETRIC;
   * total_lagrangian = 1 and the stress follows from deformation_gradient, or the ground has already
   * deformed. MPM_E_CALLBACK: that law failed. MPM_E_STATE: as for all that changes a set. Since 0.2.0.
   */
  setGeostatic(axis: number, gravity: number, surface: number, K0: number, surcharge?: number): void;
  /**
   * Makes the present state the one from which all deformation counts: deformation_gradient becomes I,
   * initial_volume the present volume, dilation_ratio 1, and reference_position, where there is one, the
   * present (unwrapped) position. With MPM_CPGIMP and of MPM_AXISYMMETRIC edges in "size" become the present
   * ones. Of MPM_PLANE_STRESS F33 stays. Mass, velocity, Cauchy stress and state variables stay. With
   * total_lagrangian = 1 particles are then in the grid where they are now, and velocity_gradient is over
   * these positions.
   *
   * Laws that store Cauchy stress and work with tau = J stress (drucker_prager, mohr_coulomb, mu_i, cam_clay)
   * find J = 1 from then on: elastic strain, energy per initial volume and cohesion count by the present
   * volume, which differ by the factor J from before; a stress on the yield surface may lie off it by as
   * much, and the next step returns it.
   *
   * The set is unchanged on failure. MPM_E_ARG: total_lagrangian = 1 and a particle is outside the box.
   * MPM_E_UNSUPPORTED: the stress of the law, or its mean, follows from deformation_gradient, which must
   * stay; or a law of the host, asked with dt = 0, does not answer with the stress that it has.
   * MPM_E_CALLBACK: that law failed. MPM_E_STATE: as for all that changes a set, and with total_lagrangian =
   * 1 while a surface of its stepper has markers, whose places count from the old reference. Since 0.2.0.
   */
  resetReference(): void;
  /**
   * Fields of all particles as floats for renderers: particles one after the other, of each the components of
   * all fields, with full tensors. Particles are in the order of their ids, or in that which `order` names.
   *
   * Copies count named fields of all particles into floats for renderers: particles one after the other,
   * without inert slots, of each the components of the first field, then those of the second, and so on.
   * Components are those of mpm_particles_get(), with full tensors and dim components per vector, and out has
   * n times the sum of them.
   *
   * - order: MPM_BY_ID, or MPM_LIBRARY_ORDER, which is faster: it reads memory from front to back and needs
   *   no index of the ids. In it a particle may have another place after each step; the field "id" tells them
   *   apart.
   * - n: mpm_particles_count(), to guard the host's buffer.
   *
   * Values are rounded to the nearest float. Those that no float can hold become infinities with their sign
   * (from about 3.4e38 on), those below the smallest float (1.4e-45) become 0. Integers are exact up to 2^24
   * = 16777216.
   *
   * MPM_E_NOT_FOUND: there is no such field. MPM_E_ARG: count is < 1, a field is named twice, or order or n
   * is none of these. Else as mpm_particles_get(); views may be out. Since 0.2.0.
   */
  toFloat32(fields?: string[], order?: number): Float32Array;
  /**
   * The bytes of a file of VTK (.vtp) with the fields, by default all in use.
   *
   * Gives the bytes of the file that mpm_write_particles() would write to a callback, with memory for one
   * piece. Errors are the same, but for the path, and with MPM_E_CALLBACK, when the callback refused, in the
   * place of MPM_E_IO. Since 0.2.0.
   */
  toVtp(fields?: string[]): Uint8Array;
}

/** A rigid body without particles. It belongs to a context, and may be in one stepper at a time. */
export class Obstacle implements Handle {
  private constructor();
  dispose(): void;
  readonly disposed: boolean;
  [Symbol.dispose](): void;
  /**
   * Sets how an obstacle moves in each step, for MPM_MOTION_PRESCRIBED (MPM_E_UNSUPPORTED with others). NULL:
   * it keeps its velocities. A state does not hold it: after one has been loaded that had it, no step is made
   * (MPM_E_STATE) until it has been set, before loading or after, or answered by NULL after it. MPM_E_STATE
   * during a staged step.
   */
  setMotion(motion: MotionFunction | null): void;
  /**
   * Sets how an obstacle meets the material, as mpm_obstacle_desc.contact does. MPM_E_ARG: a value is bad;
   * nothing is changed. MPM_E_STATE during a staged step.
   */
  setContact(contact: ContactDesc | null): void;
  /**
   * Puts an obstacle somewhere: position[3], orientation[4], velocity[3] and angular_velocity[3] as in
   * mpm_obstacle_desc, each NULL to keep it. MPM_E_ARG: a value is bad; nothing is changed.
   * MPM_E_UNSUPPORTED: a velocity other than 0 of a fixed one. MPM_E_STATE during a staged step.
   */
  setPose(pose: Partial<Record<'position' | 'orientation' | 'velocity' | 'angular_velocity', ArrayLike<number>>>): void;
  /** Gives where an obstacle is and how it moves; each may be NULL. */
  pose(): Record<'position' | 'orientation' | 'velocity' | 'angular_velocity', number[]>;
  /**
   * Sets the force[3] and the torque[3] about its centre that act on a free obstacle beside gravity and
   * contact, until they are set anew; each NULL to keep it. MPM_E_UNSUPPORTED: it is not free. MPM_E_STATE
   * during a staged step.
   */
  setLoad(load: { force?: ArrayLike<number>; torque?: ArrayLike<number> }): void;
  /**
   * By default of all bodies.
   *
   * Gives what a body and an obstacle did to each other in the last step; body MPM_BODY_ANY: all of them.
   * force and impulse are on the material, -force is on the obstacle; torque is that on the obstacle, about
   * its centre; nodes are those that could be constrained. MPM_E_STATE: it is in no stepper, or that has made
   * no step yet.
   */
  contactInfo(body?: number): ContactInfo;
}

/** Markers of a surface. It belongs to a grid, and may be in one stepper at a time. */
export class Surface implements Handle {
  private constructor();
  dispose(): void;
  readonly disposed: boolean;
  [Symbol.dispose](): void;
  readonly grid: Grid;
  /**
   * Options that are left out take their defaults.
   *
   * Replaces loads and options between steps. Errors are those of mpm_surface_create(), and MPM_E_STATE
   * during a staged step.
   */
  configure(desc?: SurfaceDesc): void;
  /**
   * Sets the callback that adds tractions. NULL takes it away. The host sets it again after it has loaded a
   * state. MPM_E_STATE during a staged step.
   */
  setTraction(run: TractionFunction | null): void;
  /**
   * Sets the callback that adds to the velocities with which a surface that prescribes moves. NULL takes it
   * away. The host sets it again after it has loaded a state. MPM_E_STATE during a staged step.
   */
  setVelocity(run: MarkerVelocityFunction | null): void;
  /**
   * Heats what lies below a surface, per area of its markers: flux + film (ambient - temperature of the
   * material), power/area into the material; film is >= 0. All 0 (as made): no heat. Not part of a saved
   * state. MPM_E_ARG: a value is bad. MPM_E_STATE: a step is under way.
   */
  setHeat(flux: number, film?: number, ambient?: number): void;
  /** The number of markers; 0 for NULL. */
  readonly count: number;
  /**
   * Returns the first id.
   *
   * Adds n markers.
   *
   * - position: [dim][n], in the grid; on periodic axes it is wrapped.
   * - area: [dim][n] area vectors, out of the material; NULL for markers without area, which follow the
   *   material and carry nothing.
   * - first_id: ids go up by one from the largest so far; the first is written to it. May be NULL.
   *
   * In 3-D a marker counts as a square when it is split. MPM_E_ARG: a value is not finite, a position is
   * outside the grid, the surface would have more than 2^28 markers, or the edge of a ring, which is its area
   * over its radius, would reach beyond the axis; nothing is added. MPM_E_STATE during a staged step.
   */
  add(markers: NewMarkers): bigint;
  /**
   * Adds markers along the line through n points, position[2][n]; closed 1: back to the first. The material
   * lies on the left of the line, so that the outline of a body goes round counter-clockwise. Each edge is
   * divided into equal parts no longer than spacing > 0, with a marker in the middle of each: half a spacing
   * of the grid is right. *first_id and *count, which may be NULL, tell of the markers. MPM_E_UNSUPPORTED:
   * the grid is not 2-D. MPM_E_ARG: a closed line has one or two points, and so no inside. Else as
   * mpm_surface_add().
   */
  addPolyline(position: ArrayLike<number>, closed: boolean, spacing: number): Filled;
  /**
   * Adds markers on triangles: position[3][n] of their corners, and corner[3 * i], corner[3 * i + 1],
   * corner[3 * i + 2] the numbers of those of triangle i, counter-clockwise as seen from outside the
   * material. Each triangle is divided into k^2 equal ones with edges no longer than spacing, with a marker
   * in the middle of each. MPM_E_UNSUPPORTED: the grid is not 3-D. MPM_E_ARG: there is no such corner. Else
   * as mpm_surface_add_polyline().
   */
  addTriangles(position: ArrayLike<number>, corner: ArrayLike<number | bigint>, spacing: number): Filled;
  /**
   * Removes the n markers with the given ids: all or none. MPM_E_NOT_FOUND: an id is not in the surface.
   * MPM_E_ARG: an id is given twice. MPM_E_STATE during a staged step.
   */
  remove(ids: ArrayLike<number | bigint>): void;
  /**
   * Returns how many markers came.
   *
   * Splits markers until no edge is longer than spacing > 0: total area, its moment and the loads are kept,
   * but for the moment where a half would lie beyond a face of the grid: it is put onto the face. One half
   * keeps the id, the other gets a new one. *added, which may be NULL, tells how many came. MPM_E_ARG:
   * spacing is bad, or more than 2^28 markers would come of it. MPM_E_STATE during a staged step.
   */
  refine(spacing: number): number;
  /**
   * Returns a new array.
   *
   * Copies a field of n markers into out, [components][n]. ids are [n], or NULL for all markers by ascending
   * id, where n is mpm_surface_count(). type and components must match the field.
   *
   * | field             | type | components | what it is                                              | set |
   * |-------------------|------|------------|---------------------------------------------------------|-----|
   * | "id"              | I64  | 1          |                                                         |     |
   * | "position"        | F64  | dim        | length                                                  | yes |
   * | "area"            | F64  | dim        | area vector, out of the material                        | yes |
   * | "reference_area"  | F64  | 1          | area when it was added or set                           |     |
   * | "displacement"    | F64  | dim        | since it was added, across periodic axes too            | yes |
   * | "velocity"        | F64  | dim        | of the material there, in the last step                 |     |
   * | "force"           | F64  | dim        | on the material, in the last step                       |     |
   * | "pressure"        | F64  | 1          | of this marker, beside mpm_surface_desc.pressure        | yes |
   * | "traction"        | F64  | dim        | likewise                                                | yes |
   * | "dead_traction"   | F64  | dim        | likewise                                                | yes |
   * | "prescribed_velocity" | F64 | dim     | of this marker, beside mpm_surface_desc.velocity        | yes |
   * | "reaction"        | F64  | dim        | force of what is prescribed on the material, last step  |     |
   * | "gap"             | F64  | dim        | implicit steps: way of the material off what it should  |     |
   *
   * MPM_E_NOT_FOUND: there is no such field or id. MPM_E_ARG: type, components or n do not match.
   */
  get(field: 'id', ids?: ArrayLike<number | bigint>): BigInt64Array;
  get(field: string, ids?: ArrayLike<number | bigint>): Float64Array;
  /**
   * Copies values into a field, laid out as in mpm_surface_get(): all or none. Setting "area" makes it the
   * reference. Errors are those of mpm_surface_get(), and MPM_E_ARG: a value is not finite, a position is
   * outside the grid, or the field cannot be set. MPM_E_STATE during a staged step. MPM_E_UNSUPPORTED:
   * "position" or "area" with total_lagrangian = 1, whose weights keep to the markers that were added: add
   * others.
   */
  set(field: string, values: ArrayLike<number>, ids?: ArrayLike<number | bigint>): void;
}

/** A stepper is one time loop with a grid, sets of particles, a scheme, walls and forces. See stepper.h. */
export class Stepper implements Handle {
  private constructor();
  dispose(): void;
  readonly disposed: boolean;
  [Symbol.dispose](): void;
  readonly grid: Grid;
  /**
   * Returns the stepper.
   *
   * Adds a set to the time loop. The host keeps owning it, and cannot destroy it while it is in. All sets of
   * a body share one velocity field; this one comes into body 0. MPM_E_STATE: the set is in a stepper
   * already. MPM_E_ARG: it is on another grid.
   */
  add(set: Particles): this;
  /** Takes a set out of the time loop. MPM_E_NOT_FOUND: it is not in this stepper. */
  remove(set: Particles): void;
  /**
   * Returns the stepper.
   *
   * Puts an obstacle into a stepper, with those that are there in the order of adding. MPM_E_STATE: it is in
   * a stepper already, or a step is under way. MPM_E_UNSUPPORTED: the shape does not exist in the dimension
   * of the grid; it is free, and the grid MPM_AXISYMMETRIC or the scheme MPM_NEWMARK, which refuses the
   * adhesion of an obstacle in the step. MPM_E_ARG: it is turned out of a 2-D or 1-D grid, or moves out of
   * it.
   */
  addObstacle(obstacle: Obstacle): this;
  /** Takes an obstacle out, and what it has reported. MPM_E_NOT_FOUND: it is not in this stepper. */
  removeObstacle(obstacle: Obstacle): void;
  /**
   * Returns the stepper.
   *
   * Puts a surface into a stepper. In each step its markers load the nodes of mpm_surface_desc.body and move
   * with them, or as they prescribe; the work is part of mpm_step_info.external_work. Markers that go through
   * MPM_WALL_OPEN are removed. Steps end with
   *
   * - MPM_OFF_GRID: a marker would leave through a face that does not let it;
   * - MPM_NONFINITE: its load, what it prescribes or its new position is not finite;
   * - MPM_E_STATE: a marker with a load has no material around it.
   *
   * The text names marker and surface, the number of which counts the surfaces of the stepper from 0.
   * MPM_E_STATE: it is in a stepper already, or a step is under way. MPM_E_ARG: it is on another grid.
   *
   * In implicit steps forces are those at the end of the step, on the areas that surfaces then have. Pressure
   * and traction make the stiffness unsymmetric, so that the solvers for symmetric matrices are not offered;
   * what is prescribed, and loads of markers that prescribe, keep it symmetric.
   */
  addSurface(surface: Surface): this;
  /** Takes a surface out; it keeps its markers. MPM_E_NOT_FOUND: it is not in this stepper. */
  removeSurface(surface: Surface): void;
  /**
   * Options that are left out take their defaults.
   *
   * Replaces the options between steps. Any field may change, the scheme too; desc is copied. Errors are
   * those of mpm_stepper_create(), and MPM_E_STATE during a staged step.
   */
  configure(desc?: StepperDesc): void;
  /**
   * Sets the time and the number of steps counted. Sums over steps (mpm_stepper_wall_impulse(),
   * mpm_stepper_particles_impulse(), external_work_total) start anew from 0. MPM_E_ARG: t is not finite, or
   * step < 0.
   */
  setTime(t: number, step?: number): void;
  /**
   * Sets what a face (MPM_X_MIN to MPM_Z_MAX) does: kind is one of MPM_WALL_NONE to MPM_WALL_FRICTION_NODES.
   * friction is the Coulomb coefficient, >= 0, of the last two, and is not used otherwise. Such a wall is
   * unilateral: its normal impulse only pushes, and its tangential impulse is at most friction times that;
   * but for a node that parts and touches again and again in the iterations of an implicit step, which is
   * then held in it and may be pulled. MPM_E_ARG: the grid does not have the face, the face is periodic, or a
   * value is bad. MPM_E_UNSUPPORTED: MPM_WALL_FRICTION_NODES with MPM_NEWMARK; MPM_WALL_OPEN with
   * total_lagrangian = 1; on the axis of MPM_AXISYMMETRIC another kind than MPM_WALL_SLIP.
   */
  setWall(face: number, kind: number, friction?: number): this;
  /**
   * Puts a set into a body: 0 <= body < 4096, at first 0. Between steps, also with particles in it. Sets of
   * one body share one velocity field. MPM_E_NOT_FOUND: the set is not in this stepper. MPM_E_ARG: there is
   * no such body. MPM_E_UNSUPPORTED: with MPM_NEWMARK, bodies that touch with adhesion, or by
   * MPM_SOLVER_MULTIGRID_CG; with total_lagrangian = 1 another body than 0, because bodies touch at nodes
   * that both have. MPM_E_STATE during a staged step, or while a view of nodal fields is out; there are no
   * nodal fields then until the next step.
   */
  setBody(set: Particles, body: number): this;
  /** Gives the body of a set. MPM_E_NOT_FOUND: it is not in this stepper. */
  body(set: Particles): number;
  /**
   * Sets how two bodies meet; desc is copied. The order of the bodies matters for `direction` alone. With
   * MPM_BODY_ANY for one body: how the other meets those that have no rule of their own with it; for both:
   * how all meet that have no closer rule. Of the rules of two bodies each with MPM_BODY_ANY, that of the
   * lower number counts. A later call replaces an earlier one for the same pair; NULL takes the rule back.
   * Without any rule the defaults of mpm_contact_desc_init() hold. A saved state holds the rules. MPM_E_ARG:
   * a value is bad. MPM_E_UNSUPPORTED: adhesion with detection by velocity; with MPM_NEWMARK, adhesion, or
   * MPM_SOLVER_MULTIGRID_CG, of bodies that there are. MPM_E_STATE during a staged step.
   */
  setContact(bodyA: number, bodyB: number, contact: ContactDesc | null): this;
  /**
   * null describes it no longer.
   *
   * Describes how a set of the stepper adapts, for the steps that follow; NULL: no longer. The set then keeps
   * the field "size". Not part of a saved state: the host sets it again. MPM_E_NOT_FOUND: the set is not in
   * the stepper. MPM_E_ARG: a value is bad or particles is NULL; an edge could be split that would be shorter
   * than least_edge (split_edge < 2 least_edge), or max_per_cell < 2 min_per_cell. MPM_E_UNSUPPORTED:
   * total_lagrangian = 1, where material does not come apart, or the law is "rigid". MPM_E_STATE: a step is
   * under way, or a view of the set is out.
   */
  setAdaption(set: Particles, desc: AdaptionDesc | null, accept?: AdaptionFunction | null): this;
  /**
   * Adapts all sets that are described, now and whatever `every` is. Sets are unchanged on failure.
   * MPM_E_CALLBACK, MPM_CUT_DT: accept returned an error. MPM_E_STATE: a step is under way, a view of a set
   * is out, or a value that was written through one is bad.
   */
  adapt(): void;
  /**
   * Tells what adaption has done to a set. MPM_E_NOT_FOUND: it is not in the stepper. MPM_E_ARG: particles or
   * info is NULL.
   */
  adaptionInfo(set: Particles): AdaptionInfo;
  /**
   * null describes it no longer. `source` writes power per volume; without it there is none. The set has the
   * field "temperature" from then on.
   *
   * Describes the heat of a set of the stepper, for the steps that follow; NULL: it has none any more, and
   * its fields stay as fields of the host. Not part of a saved state, but the fields are: the host describes
   * before it loads. MPM_E_NOT_FOUND: the set is not in the stepper. MPM_E_ARG: particles is NULL, a value is
   * bad, or the set has a field "temperature" or "stress_temperature" of another type or with more
   * components. MPM_E_UNSUPPORTED: expansion is not 0 on MPM_PLANE_STRESS or with the law "rigid";
   * dissipated_share is not 0 with "rigid" or a law of the host. MPM_E_STATE: a step is under way, a view of
   * the set is out, or the set has no room for another field.
   */
  setHeat(set: Particles, desc: HeatDesc | null, source?: HeatFunction | null): this;
  /**
   * The tolerance is 1e-9 by default.
   *
   * Chooses how the nodes conduct, from MPM_CONDUCTION_EXPLICIT (as made) on. tolerance: of the residual of
   * conjugate gradients, relative to the right-hand side; > 0 and < 1; not read with explicit conduction.
   * MPM_E_ARG: a value is bad. MPM_E_STATE: a step is under way.
   */
  setConduction(conduction: number, tolerance?: number): this;
  /**
   * Says what a face does to heat, whatever kind of wall it has. kind: MPM_HEAT_WALL_...; the temperature is
   * not read of insulated ones, which all faces are from the start. Call it again where the temperature
   * changes: that change, at first from what the material there has, reaches the particles in the next step;
   * material that comes to the face later is heated by conduction alone. Where two such faces meet, that of
   * the lower axis prescribes the edge. Not part of a saved state. MPM_E_ARG: a value is bad, or the axis is
   * periodic. MPM_E_UNSUPPORTED: the face is the axis of MPM_AXISYMMETRIC, through which nothing flows.
   * MPM_E_STATE: a step is under way.
   */
  setHeatWall(face: number, kind: number, temperature?: number): this;
  /**
   * Tells where heat came from. MPM_E_ARG: info is NULL. MPM_E_STATE: a step is under way, or no set was ever
   * described.
   */
  heatInfo(): HeatInfo;
  /**
   * Sets the callback that adds accelerations of particles, length/time^2 (b of MPoint theory, eq. 21). It is
   * called for every set. NULL takes it away.
   */
  setAcceleration(run: ParticleFunction | null): this;
  /**
   * Sets the callback that adds forces on particles, mass length/time^2 (f^app of MPoint theory, eq. 21). It
   * is called for every set. NULL takes it away.
   */
  setForce(run: ParticleFunction | null): this;
  /** Sets the callback that prescribes nodal velocities, length/time. NULL takes it away. */
  setVelocityBc(run: VelocityFunction | null): this;
  /**
   * Sets the hook of a stage, one of MPM_AFTER_P2G to MPM_AFTER_VELOCITY. NULL takes it away. In a step in
   * parts all hooks run in mpm_step_grid(), after what the host has written itself. MPM_E_ARG: there is no
   * such stage. MPM_E_UNSUPPORTED with MPM_NEWMARK.
   */
  setNodeHook(stage: number, run: NodeFunction | null): this;
  /**
   * Moves the prescribed particles of a set (platens, pistons). mean_velocity (mt) is called at the start of
   * a step for the particles of the set, unless none is prescribed, and adds the mean velocity u of the
   * coming step to zeros; what it gives to other particles is ignored. NULL takes the callback away: the
   * particles keep their velocity.
   *
   * On its prescribed axes a particle moves by dt u and ends with the velocity u, with every transfer; the
   * nodes to which it gives mass move with u too, or with the mean of several by that mass. On other axes,
   * and in deformation and stress, it is a particle like others. MPM_NONFINITE names the particle. A state
   * does not hold the callback: after one has been loaded that had it, no step is made (MPM_E_STATE) until it
   * has been set, before loading or after, or answered by NULL after it. MPM_E_NOT_FOUND: the set is not in
   * this stepper.
   */
  setMotion(set: Particles, run: ParticleFunction | null): this;
  /**
   * Sets the callback for coefficients of friction. NULL takes it away. The host sets it again after it has
   * loaded a state into another stepper. MPM_E_UNSUPPORTED with MPM_NEWMARK.
   */
  setFriction(run: FrictionFunction | null): this;
  /** Sets the progress callback, which runs on the calling thread. NULL takes it away. */
  setProgress(run: ProgressFunction | null): this;
  /** Sets the solver of MPM_SOLVER_HOST: see operator.h. NULL takes it away. */
  setLinearSolver(run: SolveFunction | null): this;
  /**
   * Gives the stable dt of an explicit step from the present state, at CFL number 1 (MPoint theory, eqs
   * 45-46): 1 / max over particles and axes of (|v_k| + c) / h_k, where c is the law's current wave speed,
   * and at most h^2 / (2 dim nu) where a law reports a kinematic viscosity nu; h is the smallest spacing.
   * Explicit steps want a share of it. It is infinite where nothing moves and no law has waves. Obstacles
   * that move count by the speed of their fastest point. The call runs the laws. MPM_E_STATE: there are no
   * particles, or a view is out.
   */
  stableDt(): number;
  /**
   * Makes one step of size dt > 0. After any status but MPM_OK particles and time are bit-identical to
   * before. info may be NULL; it is filled on success and on failure.
   *
   * - MPM_CUT_DT, MPM_INVERTED, MPM_NONFINITE, MPM_NOT_CONVERGED, MPM_SINGULAR: a smaller dt may do.
   * - MPM_OFF_GRID: a particle would leave through a face that does not let it. In implicit steps a smaller
   *   dt may do here as well.
   * - MPM_CANCELLED: the progress callback ended the step.
   * - MPM_E_ARG: dt is not finite or not > 0.
   * - MPM_E_CALLBACK: a callback or the host's executor failed.
   * - MPM_E_STATE: a view is out, a staged step is under way, a set has values to be repaired, or the state
   *   that was loaded had a motion callback that is not set.
   */
  step(dt: number): StepInfo;
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
  advance(tEnd: number, options?: Omit<AdvanceDesc, 't_end'>): StepInfo;
  /**
   * Makes the first part of an explicit step in parts: particles to grid, and forces. With MPM_USF strain and
   * stress of the step come before them, for which the callbacks of prescribed velocities are asked here.
   * Until mpm_step_end() or mpm_step_abort() the host may map nodal fields between the parts, and change
   * "velocity" and "force". Errors are those of mpm_step(), and MPM_E_UNSUPPORTED with MPM_NEWMARK. A part
   * that fails with any status but MPM_E_STATE or MPM_E_ARG aborts the step.
   */
  stepBegin(dt: number): void;
  /**
   * Makes the second part: nodal velocities, walls, prescribed velocities. MPM_E_STATE unless it follows
   * mpm_step_begin().
   */
  stepGrid(): void;
  /**
   * Makes the last part: grid to particles, stress, commit. info may be NULL. MPM_E_STATE unless it follows
   * mpm_step_grid(). The three parts in a row give the same bits as mpm_step(), except with MPM_APIC_MLS,
   * where a whole step fuses force and momentum: there they agree to rounding.
   */
  stepEnd(): StepInfo;
  /**
   * Drops the step that was begun; particles and time are as before it. MPM_E_STATE: none was begun, or a
   * view of nodal fields is out.
   */
  stepAbort(): void;
  /**
   * Gives the info of the state as it is, also before the first step. What belongs to a step is that of the
   * last one. MPM_E_STATE while a set is mapped for writing.
   */
  info(): StepInfo;
  /**
   * Copies the times into out, then sets them to zero if reset is not 0. They cost the steps one clock read
   * per stage.
   */
  profile(reset?: boolean): Profile;
  /**
   * Gives the history of the last implicit step: ||residual|| / scale (the scale includes reactions) from
   * before the first solve to the converged or failed end. *count tells how many values there are; the first
   * capacity of them are copied into residual, which may be NULL when capacity is 0. The history is kept
   * until the next step; *count is 0 after explicit ones.
   */
  residuals(): number[];
  /**
   * Gives what two bodies did in the last step; for body_a MPM_BODY_ANY the sum over all others, on body_b;
   * the other way round what they suffered. Bodies that never were near each other have zeros, and an
   * infinite gap. MPM_E_ARG: the bodies are the same or there is no such body. MPM_E_STATE before the first
   * step.
   */
  contactInfo(bodyA: number, bodyB: number): ContactInfo;
  /**
   * Gives the force[dim] that the wall at a face exerts on the material: the mean over the last step, or with
   * MPM_NEWMARK the one at its end, but for friction walls. MPM_E_ARG: there is no such face. MPM_E_STATE
   * before the first step.
   */
  wallReaction(face: number): number[];
  /**
   * Gives the impulse[dim] of the wall at a face on the material, mass * length/time: the sum of
   * mpm_stepper_wall_reaction() times the time over which it acted, over all committed steps since the
   * stepper was made or mpm_stepper_set_time() was called; 0 before the first. A host that uses mpm_advance()
   * measures forces by it: the difference of two calls over the time between them is the mean force. With
   * MPM_NEWMARK a step adds dt times the force at its end, and with `staggered` the mean of two dt times its
   * force. Steps that fail add nothing, and a saved state holds it. MPM_E_ARG: there is no such face.
   */
  wallImpulse(face: number): number[];
  /**
   * Gives the force[dim] that the prescribed particles of a set exert on the material, on the axes on which
   * they are prescribed: the mean over the last step, or with MPM_NEWMARK the one at its end. It is what
   * holds them, less their own inertia, weight and external forces; 0 for a set without such particles. What
   * a body of its own gives others through contact is not in it: mpm_stepper_contact_info() has that.
   * MPM_E_NOT_FOUND: the set is not in this stepper. MPM_E_STATE before the first step.
   */
  particlesReaction(set: Particles): number[];
  /**
   * Gives the impulse[dim] of the prescribed particles of a set on the material, the sum of
   * mpm_stepper_particles_reaction() in the same way. It is 0 when a set is added, and forgotten when it is
   * removed. MPM_E_NOT_FOUND: the set is not in this stepper.
   */
  particlesImpulse(set: Particles): number[];
  /**
   * Gives the force[dim] by which what a surface prescribes acts on the material: the mean over the last
   * step, the sum of "reaction" over the markers; 0 for a surface that prescribes nothing. Loads are no part
   * of it. MPM_E_NOT_FOUND: it is not in this stepper. MPM_E_STATE before the first step.
   */
  surfaceReaction(surface: Surface): number[];
  /**
   * Gives the impulse[dim] of it on the material, mass * length/time: the sum of
   * mpm_stepper_surface_reaction() times the time over which it acted, over all committed steps since the
   * surface was added or mpm_stepper_set_time() was called. A saved state holds it. MPM_E_NOT_FOUND: the
   * surface is not in this stepper.
   */
  surfaceImpulse(surface: Surface): number[];
  /**
   * The field goes to a function as Particles.map() lends one; body is 0 by default.
   *
   * Lends a field of the active nodes: of a staged step while one is under way, of the last step otherwise.
   * The view's struct_size is set by the caller. Until mpm_view_release() steps and their parts return
   * MPM_E_STATE. Periodic images and mirrored ghosts are listed beside the nodes that they follow.
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
  map<T>(field: string, access: number, use: (components: Float64Array[], count: number) => T, body?: number): T;
  map<A extends FieldArray, T>(field: string, access: number, use: (components: A[], count: number) => T, body?: number): T;
  /**
   * Writes the state into the host's buffer of capacity bytes; of several parts, this part's piece
   * (collective). MPM_E_ARG: the capacity is too small. MPM_E_STATE: a view is out for writing, or a staged
   * step is under way.
   */
  save(): Uint8Array;
  /**
   * Replaces the state by one saved with mpm_state_save(), of so many bytes; the buffer is read during the
   * call. MPM_E_FORMAT: the bytes are no state, or it is damaged, of a later format, or saved from an unlike
   * setup; the error text names the first difference; or they are one piece of several. MPM_E_STATE: a view
   * is out, or a staged step is under way. MPM_E_UNSUPPORTED: the context is one of several parts, which load
   * by mpm_state_load_pieces().
   */
  load(state: ArrayLike<number>): void;
  /**
   * Gives a hash of time, step, every field of every set, the pose of every obstacle and every marker of
   * surfaces. It does not depend on library order, on threads or on optional fields that are not in use:
   * states that are equal by id have equal hashes.
   */
  hash(): bigint;
  /**
   * The bytes of a file of VTK (.vti, .vtr) with nodal fields, by default all that there are; body is 0 by
   * default.
   *
   * Gives the bytes of the file that mpm_write_body_grid() would write to a callback. They are those of a
   * .vtr file if the grid has boundary_basis = MPM_BOUNDARY_OPEN_KNOT and an axis that is not periodic, else
   * those of a .vti file; the second line names the kind, RectilinearGrid or ImageData. Zeros between bodies
   * far apart are all given, however many they are. Memory follows the active nodes, and one piece is added.
   * Errors are the same, but for the path, and with MPM_E_CALLBACK, when the callback refused, in the place
   * of MPM_E_IO. Since 0.2.0.
   */
  toVti(fields?: string[], body?: number): Uint8Array;
}

/** The functions of C as WebAssembly exports them: pointers are numbers, 64-bit integers BigInts. For what the classes
 * lack; who calls them keeps their rules. */
export interface Raw {
  mpm_version(): number;
  mpm_status_name(status: number): number;
  mpm_status_text(status: number): number;
  mpm_view_release(view: number): number;
  mpm_context_part(context: number, part: number, parts: number): number;
  mpm_particles_total(particles: number, n: number): number;
  mpm_balance_desc_init(desc: number, struct_size: number): number;
  mpm_stepper_set_balance(stepper: number, desc: number): number;
  mpm_stepper_parallel_info(stepper: number, reset: number, info: number): number;
  mpm_particles_packed_size(particles: number, n: bigint, bytes: number): number;
  mpm_particles_pack(particles: number, n: bigint, ids: number, buffer: number, capacity: bigint): number;
  mpm_particles_unpack(particles: number, buffer: number, bytes: bigint): number;
  mpm_context_desc_init(desc: number, struct_size: number): number;
  mpm_context_create(desc: number, out: number): number;
  mpm_context_memory(context: number, bytes: number, peak_bytes: number): number;
  mpm_context_destroy(context: number): number;
  mpm_last_error(context: number): number;
  mpm_set_last_error(context: number, status: number, text: number): number;
  mpm_grid_desc_init(desc: number, struct_size: number): number;
  mpm_grid_create(context: number, desc: number, out: number): number;
  mpm_grid_destroy(grid: number): number;
  mpm_material_create(context: number, model: number, params: number, count: number, out: number): number;
  mpm_material_model_count(): number;
  mpm_material_model_name(index: number): number;
  mpm_material_model_param(model: number, index: number, name: number, unit: number, text: number, value_default: number, low: number, high: number): number;
  mpm_material_state_count(model: number): number;
  mpm_material_state_name(model: number, index: number, name: number, unit: number, text: number): number;
  mpm_batch_field(lookup: number, field: number, data: number, component_stride: number): number;
  mpm_material_desc_init(desc: number, struct_size: number): number;
  mpm_material_create_custom(context: number, desc: number, out: number): number;
  mpm_material_update(material: number, batch: number, tangent: number, symmetric: number): number;
  mpm_material_destroy(material: number): number;
  mpm_particles_create(context: number, grid: number, material: number, out: number): number;
  mpm_particles_destroy(particles: number): number;
  mpm_particles_add(particles: number, n: bigint, position: number, velocity: number, volume: number, size: number, ids: number, first_id: number): number;
  mpm_particles_fill_box(particles: number, lower: number, upper: number, per_cell: number, first_id: number, count: number): number;
  mpm_particles_fill_ball(particles: number, centre: number, radius: number, per_cell: number, first_id: number, count: number): number;
  mpm_particles_fill(particles: number, lower: number, upper: number, per_cell: number, inside: number, user: number, first_id: number, count: number): number;
  mpm_particles_fill_mesh(particles: number, n: bigint, position: number, elements: bigint, corner: number, per_cell: number, first_id: number, count: number): number;
  mpm_particles_remove(particles: number, n: bigint, ids: number): number;
  mpm_particles_count(particles: number): bigint;
  mpm_particles_field_info(particles: number, index: number, field: number, type: number, components: number, writable: number): number;
  mpm_particles_add_field(particles: number, field: number, type: number, components: number): number;
  mpm_particles_set_extensive(particles: number, field: number, extensive: number): number;
  mpm_particles_map(particles: number, field: number, access: number, view: number): number;
  mpm_particles_get(particles: number, field: number, type: number, components: number, n: bigint, ids: number, out: number): number;
  mpm_particles_get_f32(particles: number, count: number, fields: number, order: number, n: bigint, out: number): number;
  mpm_particles_set(particles: number, field: number, type: number, components: number, n: bigint, ids: number, values: number): number;
  mpm_particles_set_all(particles: number, field: number, type: number, components: number, value: number): number;
  mpm_particles_set_geostatic(particles: number, axis: number, gravity: number, surface: number, K0: number, surcharge: number): number;
  mpm_particles_reset_reference(particles: number): number;
  mpm_operator_get_info(matrix: number, info: number): number;
  mpm_operator_apply(matrix: number, x: number, y: number): number;
  mpm_operator_csr(matrix: number, row_start: number, column: number, value: number): number;
  mpm_stepper_desc_init(desc: number, struct_size: number): number;
  mpm_stepper_create(context: number, grid: number, desc: number, out: number): number;
  mpm_stepper_destroy(stepper: number): number;
  mpm_stepper_add(stepper: number, particles: number): number;
  mpm_stepper_remove(stepper: number, particles: number): number;
  mpm_stepper_configure(stepper: number, desc: number): number;
  mpm_stepper_set_time(stepper: number, t: number, step: bigint): number;
  mpm_stepper_set_motion(stepper: number, particles: number, mean_velocity: number, user: number): number;
  mpm_stepper_set_wall(stepper: number, face: number, kind: number, friction: number): number;
  mpm_stepper_set_acceleration(stepper: number, fn: number, user: number): number;
  mpm_stepper_set_force(stepper: number, fn: number, user: number): number;
  mpm_stepper_set_velocity_bc(stepper: number, fn: number, user: number): number;
  mpm_stepper_set_node_hook(stepper: number, stage: number, fn: number, user: number): number;
  mpm_stepper_set_linear_solver(stepper: number, fn: number, user: number): number;
  mpm_stepper_set_progress(stepper: number, fn: number, user: number): number;
  mpm_stable_dt(stepper: number, dt: number): number;
  mpm_step(stepper: number, dt: number, info: number): number;
  mpm_advance_desc_init(desc: number, struct_size: number): number;
  mpm_advance(stepper: number, desc: number, info: number): number;
  mpm_stepper_profile(stepper: number, reset: number, out: number): number;
  mpm_stepper_info(stepper: number, info: number): number;
  mpm_stepper_residuals(stepper: number, capacity: number, residual: number, count: number): number;
  mpm_step_begin(stepper: number, dt: number): number;
  mpm_step_grid(stepper: number): number;
  mpm_step_end(stepper: number, info: number): number;
  mpm_step_abort(stepper: number): number;
  mpm_grid_map(stepper: number, body: number, field: number, access: number, view: number): number;
  mpm_stepper_wall_reaction(stepper: number, face: number, force: number): number;
  mpm_stepper_particles_reaction(stepper: number, prescribed: number, force: number): number;
  mpm_stepper_wall_impulse(stepper: number, face: number, impulse: number): number;
  mpm_stepper_particles_impulse(stepper: number, prescribed: number, impulse: number): number;
  mpm_stepper_set_body(stepper: number, particles: number, body: number): number;
  mpm_stepper_body(stepper: number, particles: number, body: number): number;
  mpm_contact_desc_init(desc: number, struct_size: number): number;
  mpm_stepper_set_contact(stepper: number, body_a: number, body_b: number, desc: number): number;
  mpm_stepper_set_friction(stepper: number, fn: number, user: number): number;
  mpm_stepper_contact_info(stepper: number, body_a: number, body_b: number, info: number): number;
  mpm_obstacle_desc_init(desc: number, struct_size: number): number;
  mpm_obstacle_create(context: number, desc: number, out: number): number;
  mpm_obstacle_destroy(obstacle: number): number;
  mpm_stepper_add_obstacle(stepper: number, obstacle: number): number;
  mpm_stepper_remove_obstacle(stepper: number, obstacle: number): number;
  mpm_obstacle_set_motion(obstacle: number, fn: number, user: number): number;
  mpm_obstacle_set_contact(obstacle: number, contact: number): number;
  mpm_obstacle_set_pose(obstacle: number, position: number, orientation: number, velocity: number, angular_velocity: number): number;
  mpm_obstacle_get_pose(obstacle: number, position: number, orientation: number, velocity: number, angular_velocity: number): number;
  mpm_obstacle_set_load(obstacle: number, force: number, torque: number): number;
  mpm_obstacle_contact_info(obstacle: number, body: number, info: number): number;
  mpm_surface_desc_init(desc: number, struct_size: number): number;
  mpm_surface_create(context: number, grid: number, desc: number, out: number): number;
  mpm_surface_destroy(surface: number): number;
  mpm_surface_configure(surface: number, desc: number): number;
  mpm_surface_set_traction(surface: number, fn: number, user: number): number;
  mpm_surface_set_velocity(surface: number, fn: number, user: number): number;
  mpm_surface_add(surface: number, n: bigint, position: number, area: number, first_id: number): number;
  mpm_surface_add_polyline(surface: number, n: bigint, position: number, closed: number, spacing: number, first_id: number, count: number): number;
  mpm_surface_add_triangles(surface: number, n: bigint, position: number, triangles: bigint, corner: number, spacing: number, first_id: number, count: number): number;
  mpm_surface_remove(surface: number, n: bigint, ids: number): number;
  mpm_surface_refine(surface: number, spacing: number, added: number): number;
  mpm_surface_count(surface: number): bigint;
  mpm_surface_get(surface: number, field: number, type: number, components: number, n: bigint, ids: number, out: number): number;
  mpm_surface_set(surface: number, field: number, type: number, components: number, n: bigint, ids: number, values: number): number;
  mpm_stepper_add_surface(stepper: number, surface: number): number;
  mpm_stepper_remove_surface(stepper: number, surface: number): number;
  mpm_stepper_surface_reaction(stepper: number, surface: number, force: number): number;
  mpm_stepper_surface_impulse(stepper: number, surface: number, impulse: number): number;
  mpm_adaption_desc_init(desc: number, struct_size: number): number;
  mpm_stepper_set_adaption(stepper: number, particles: number, desc: number): number;
  mpm_stepper_adapt(stepper: number): number;
  mpm_stepper_adaption_info(stepper: number, particles: number, info: number): number;
  mpm_heat_desc_init(desc: number, struct_size: number): number;
  mpm_stepper_set_heat(stepper: number, particles: number, desc: number): number;
  mpm_stepper_set_conduction(stepper: number, conduction: number, tolerance: number): number;
  mpm_stepper_set_heat_wall(stepper: number, face: number, kind: number, temperature: number): number;
  mpm_surface_set_heat(surface: number, flux: number, film: number, ambient: number): number;
  mpm_stepper_heat_info(stepper: number, info: number): number;
  mpm_state_size(stepper: number, bytes: number): number;
  mpm_state_save(stepper: number, buffer: number, capacity: bigint): number;
  mpm_state_load(stepper: number, buffer: number, bytes: bigint): number;
  mpm_state_load_pieces(stepper: number, count: number, piece: number, bytes: number): number;
  mpm_state_save_file(stepper: number, path: number): number;
  mpm_state_save_to(stepper: number, write: number, user: number): number;
  mpm_state_load_file(stepper: number, path: number): number;
  mpm_state_hash(stepper: number, hash: number): number;
  mpm_write_particles(particles: number, path: number, count: number, fields: number): number;
  mpm_write_particles_to(particles: number, write: number, user: number, count: number, fields: number): number;
  mpm_write_grid(stepper: number, path: number, count: number, fields: number): number;
  mpm_write_body_grid(stepper: number, body: number, path: number, count: number, fields: number): number;
  mpm_write_grid_to(stepper: number, body: number, write: number, user: number, count: number, fields: number): number;
  mpm_series_open(context: number, path: number, out: number): number;
  mpm_series_append(series: number, t: number, file: number): number;
  mpm_series_close(series: number): number;
}

/** One instance of the library, with a memory of its own. */
export interface Mpm {
  readonly C: Constants;
  /** The version of the library, such as "0.2.0". */
  readonly version: string;
  /** The compiled module: load() takes it, in a worker too. */
  readonly module: WebAssembly.Module;
  readonly raw: Raw & { memory: WebAssembly.Memory; malloc(bytes: number): number; free(at: number): void };
  /**
   * Makes a context. desc is copied and may be NULL for the defaults. *out is NULL unless MPM_OK is returned.
   * The host ends the context with mpm_context_destroy(). There is no context to ask why a call has failed:
   * the sentence goes to error_text, and to log with MPM_LOG_WARNING, as far as desc sets them.
   *
   * - MPM_E_ARG: a value is bad, only one of alloc and release or of error_text and error_bytes is set, or
   *   the variable MPM_ISA has an unknown value.
   * - MPM_E_NOMEM: memory or threads are not to be had.
   * - MPM_E_UNSUPPORTED: the instruction set is not available, the build has no threads, or desc sets a field
   *   that this version of the library does not know.
   */
  context(desc?: ContextOptions): Context;
  /** The names of the built-in laws. */
  models(): string[];
  /** The parameters of a built-in law: unit, text, default (NaN if it must be given) and range. */
  parameters(model: string): { name: string; unit: string; text: string; value_default: number; low: number; high: number }[];
  /** The state variables of a built-in law. */
  stateVariables(model: string): { name: string; unit: string; text: string }[];
}

/** Makes an instance of the library, from a URL, a path, the bytes of a binary or a compiled module. By default from
 * the binary beside this module: libmpm.simd.wasm where load.simd() says so, else libmpm.wasm. They give the same bits. */
export function load(source?: string | URL | ArrayBuffer | ArrayBufferView | WebAssembly.Module): Promise<Mpm>;
export namespace load {
  /** Whether vectors of WebAssembly are known here. */
  function simd(): boolean;
}
