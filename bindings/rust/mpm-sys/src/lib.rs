// Generated from the headers of libmpm by `make api`; not to be edited.
//! The interface of libmpm as C has it: functions, structs, constants and types of callbacks, by their names there. The
//! crate `mpm` is the safe layer over it.
//!
//! What holds for all of it stands in `mpm/mpm.h`; the comments here are those of the headers.
#![allow(non_camel_case_types, non_snake_case)]
#![allow(unknown_lints, rustdoc::all, clippy::doc_lazy_continuation, clippy::doc_overindented_list_items)]
#![allow(clippy::too_long_first_doc_paragraph, clippy::type_complexity)]

use std::marker::{PhantomData, PhantomPinned};
use std::mem::size_of;
use std::os::raw::{c_char, c_void};

pub use constants::*;

/// The result of a call: 0 if it was done; see `constants::MPM_OK` and the others.
pub type mpm_status = i32;

/// All constants of the headers.
pub mod constants {
    /// Version of the headers that the crate was made from, to be compared with `mpm_version()`.
    pub const MPM_VERSION: u32 = 0x000100;

    // Status values.

    /// the call did what it was asked to
    pub const MPM_OK: i32 = 0;
    /// a callback, a law or contact asked for a smaller step
    pub const MPM_CUT_DT: i32 = 1;
    /// det F <= 0 at a particle
    pub const MPM_INVERTED: i32 = 2;
    /// a NaN or an infinity appeared
    pub const MPM_NONFINITE: i32 = 3;
    /// the Newton iteration did not converge
    pub const MPM_NOT_CONVERGED: i32 = 4;
    /// the linear system is singular, or indefinite beyond repair
    pub const MPM_SINGULAR: i32 = 5;
    /// a particle would leave through a face that does not let it
    pub const MPM_OFF_GRID: i32 = 6;
    /// the progress callback ended the call
    pub const MPM_CANCELLED: i32 = 7;
    /// an argument is NULL, out of range or inconsistent
    pub const MPM_E_ARG: i32 = -1;
    /// the allocator returned NULL
    pub const MPM_E_NOMEM: i32 = -2;
    /// not allowed now: objects live, views are out, or a step is begun
    pub const MPM_E_STATE: i32 = -3;
    /// a callback returned < 0, or the host's executor failed
    pub const MPM_E_CALLBACK: i32 = -4;
    /// this version does not offer the combination or the extension
    pub const MPM_E_UNSUPPORTED: i32 = -5;
    /// there is no such name, id or index; the text lists the nearest names
    pub const MPM_E_NOT_FOUND: i32 = -6;
    /// a file could not be opened, read or written
    pub const MPM_E_IO: i32 = -7;
    /// data are damaged, of another kind, or from an unlike setup
    pub const MPM_E_FORMAT: i32 = -8;
    /// the library itself is at fault
    pub const MPM_E_INTERNAL: i32 = -99;

    // Basis functions of the grid.

    /// piecewise linear functions, 2h wide: Steffen et al. 2008, eqs 17-18
    pub const MPM_LINEAR: i32 = 1;
    /// Quadratic B-splines, 3h wide: Steffen et al. 2008, eq. 21; MPoint theory, eqs 24-27.
    pub const MPM_BSPLINE2: i32 = 2;
    /// cubic B-splines, 4h wide: Steffen et al. 2008, eqs 22-23
    pub const MPM_BSPLINE3: i32 = 3;
    /// GIMP on domains of edges "size", at most a cell: Steffen et al. 2008, eqs 26-29
    pub const MPM_GIMP: i32 = 16;
    /// GIMP on domains that all have edges of smoothing * spacing
    pub const MPM_UGIMP: i32 = 17;
    /// GIMP on domains of edges "size" * |F_ii|, at most a cell; depends on the axes
    pub const MPM_CPGIMP: i32 = 18;

    // What B-splines do at the faces of the grid: Steffen et al. 2008, section 3.2.

    /// splines are the same everywhere, with nodes outside the faces
    pub const MPM_BOUNDARY_GHOST: i32 = 0;
    /// Knots are repeated degree + 1 times at the faces, where one function alone is then 1. There are no nodes outside:
    /// the cells + degree nodes of an axis stand at the Greville points. Periodic axes keep plain splines.
    pub const MPM_BOUNDARY_OPEN_KNOT: i32 = 1;

    // What lies across the plane of a 2-D grid.

    /// a slab of unit thickness that keeps its thickness
    pub const MPM_PLANE_STRAIN: i32 = 0;
    /// A body of revolution: axis 0 is the radius r >= 0, axis 1 the axis z. What is extensive (volume, mass, force,
    /// energy) is that of one radian: of the whole ring it is 2 pi times as much. The axis r = 0 is a slip wall by
    /// itself. Sulsky & Schreyer 1996, section 3; Nairn & Guilkey 2015. Since 0.2.0.
    pub const MPM_AXISYMMETRIC: i32 = 1;
    /// A sheet of unit thickness at the start, without a stress across it: F33, which the library finds, makes it thinner
    /// and thicker. Solids alone, without the locking remedy. Since 0.2.0.
    pub const MPM_PLANE_STRESS: i32 = 2;

    // Time integration scheme.

    /// Explicit, with stresses updated last: MPoint theory, eqs 28-44; Steffen et al. 2008, eqs 1-10.
    pub const MPM_USL: i32 = 1;
    /// Explicit, with stresses updated first, by the strain from the velocities at the start of the step: Guilkey, An
    /// Introduction to the MPM, eqs 2-10.
    pub const MPM_USF: i32 = 2;
    /// As MPM_USL, but velocities are projected a second time before stresses are updated.
    pub const MPM_MUSL: i32 = 3;
    /// Implicit, by Newmark's rule: Guilkey & Weiss 2003, eqs 11-16, generalised to any beta and gamma.
    pub const MPM_NEWMARK: i32 = 16;

    // Transfer of velocity between particles and grid.

    /// FLIP, PIC, and their blend by the field flip: MPoint theory, eqs 34-36
    pub const MPM_FLIP: i32 = 1;
    /// affine, with the inertia of each axis and particle, for any basis: Jiang et al. 2015
    pub const MPM_APIC: i32 = 2;
    /// projects the velocity gradient too (MPoint theory, eq. 29); PIC update (eq. 35)
    pub const MPM_TPIC: i32 = 3;
    /// projects the velocity gradient too (MPoint theory, eq. 29); FLIP blend (eq. 36)
    pub const MPM_TFLIP: i32 = 4;
    /// affine projection with the FLIP blend
    pub const MPM_AFLIP: i32 = 5;
    /// XPIC(m), where m is xpic_order: Hammerquist & Nairn 2017
    pub const MPM_XPIC: i32 = 6;
    /// Affine by moving least squares, with constant inertia and one fused matrix, for quadratic and cubic B-splines with
    /// ghosts or periodic axes: Hu et al. 2018.
    pub const MPM_APIC_MLS: i32 = 7;
    /// FMPM(k), where k is xpic_order: nodal velocities by the first k terms of a series for the inverse of the full mass
    /// matrix: Nairn & Hammerquist 2021. Since 0.2.0.
    pub const MPM_FMPM: i32 = 8;

    // Instruction set of the kernels.

    /// the best one that both the processor and the library have
    pub const MPM_ISA_BEST: i32 = 0;
    /// the one that the library was compiled for
    pub const MPM_ISA_BASELINE: i32 = 1;
    /// AVX2 with FMA, on x86-64
    pub const MPM_ISA_AVX2: i32 = 2;
    /// AVX-512 (F, DQ, VL), on x86-64
    pub const MPM_ISA_AVX512: i32 = 3;
    /// NEON with FMA, on aarch64
    pub const MPM_ISA_NEON: i32 = 4;
    /// the baseline by its promise: the same bits on every platform (mpm.h, Results)
    pub const MPM_ISA_PORTABLE: i32 = MPM_ISA_BASELINE;

    // Level of a log text.

    /// the host should look at it
    pub const MPM_LOG_WARNING: i32 = 1;
    /// a rare event: a choice made at creation, or growth of storage
    pub const MPM_LOG_INFO: i32 = 2;
    /// a text in every step
    pub const MPM_LOG_DEBUG: i32 = 3;

    // Remedy against volumetric locking: MPoint theory, eqs 47-53, carried to the deformation gradient.

    /// there is no remedy
    pub const MPM_LOCKING_NONE: i32 = 0;
    /// The law sees the dilation averaged over the cell, weighted by volume. Of sets whose law makes pressure by shear
    /// ("drucker_prager", "mohr_coulomb", "cam_clay") that is the mean of such sets alone, and forces have their pressure
    /// averaged over the cell, which does the same work (Hughes 1980).
    pub const MPM_LOCKING_CELL_AVERAGE: i32 = 1;

    // Form of a law's tangent.

    /// 6 x 6 components, in Voigt's notation
    pub const MPM_TANGENT_MINOR_SYMMETRIC: i32 = 36;
    /// 9 x 9 components
    pub const MPM_TANGENT_GENERAL: i32 = 81;

    // Faces of the grid.

    /// lower face across x
    pub const MPM_X_MIN: i32 = 0;
    /// upper face across x
    pub const MPM_X_MAX: i32 = 1;
    /// lower face across y
    pub const MPM_Y_MIN: i32 = 2;
    /// upper face across y
    pub const MPM_Y_MAX: i32 = 3;
    /// lower face across z
    pub const MPM_Z_MIN: i32 = 4;
    /// upper face across z
    pub const MPM_Z_MAX: i32 = 5;

    // What a face of the grid does.

    /// default: a step in which a particle would leave fails with MPM_OFF_GRID; none with total_lagrangian = 1, where
    /// "position" may leave the box
    pub const MPM_WALL_NONE: i32 = 0;
    /// a particle that leaves is removed; refused with total_lagrangian = 1
    pub const MPM_WALL_OPEN: i32 = 1;
    /// velocities at the face are zero: it pushes and pulls
    pub const MPM_WALL_FIXED: i32 = 2;
    /// a symmetry plane: it pushes and pulls, without tangential force
    pub const MPM_WALL_SLIP: i32 = 3;
    /// the plane of the face as a fixed obstacle with Coulomb friction (obstacle.h): it pushes, never pulls. What comes
    /// through between nodes, by less than half a cell, it stops particle by particle
    pub const MPM_WALL_FRICTION: i32 = 4;
    /// contact of the nodes on the face with Coulomb friction: MPM_WALL_FRICTION as it was in 0.1.0. Material feels it
    /// about a cell and a half before its particles are there; with total_lagrangian = 1 it is that of the material that
    /// was there
    pub const MPM_WALL_FRICTION_NODES: i32 = 5;

    // What a surface prescribes of the motion of the material at its markers.

    /// default: the material carries the markers along
    pub const MPM_PRESCRIBES_NOTHING: i32 = 0;
    /// all components: the material sticks to the surface
    pub const MPM_PRESCRIBES_VELOCITY: i32 = 1;
    /// that along the area vector: the material slides without friction
    pub const MPM_PRESCRIBES_NORMAL: i32 = 2;

    // Where in an explicit step a node hook runs.

    /// mass and velocity are projected, forces are not yet known
    pub const MPM_AFTER_P2G: i32 = 1;
    /// internal and external forces are complete
    pub const MPM_AFTER_FORCES: i32 = 2;
    /// velocity is updated, and walls and prescribed velocities have acted on it
    pub const MPM_AFTER_VELOCITY: i32 = 3;

    // Access to mapped memory.

    /// the host reads
    pub const MPM_READ: i32 = 1;
    /// the host writes
    pub const MPM_WRITE: i32 = 2;

    // Type of a field's elements.

    /// double
    pub const MPM_F64: i32 = 1;
    /// int64_t
    pub const MPM_I64: i32 = 2;
    /// uint8_t
    pub const MPM_U8: i32 = 3;

    // Order of the particles in mpm_particles_get_f32().

    /// by ascending id
    pub const MPM_BY_ID: i32 = 1;
    /// as they lie in memory, without inert slots; changes when they are sorted anew
    pub const MPM_LIBRARY_ORDER: i32 = 2;

    // Linear solver of an implicit step.

    /// the library chooses by size, stencil, symmetry and inertia; with a transport as parallel.h says
    pub const MPM_SOLVER_AUTO: i32 = 0;
    /// conjugate gradients, for symmetric positive definite systems
    pub const MPM_SOLVER_CG: i32 = 1;
    /// conjugate gradients with geometric multigrid, for the same systems
    pub const MPM_SOLVER_MULTIGRID_CG: i32 = 2;
    /// a direct solver, for symmetric systems that may be indefinite
    pub const MPM_SOLVER_LDLT: i32 = 3;
    /// GMRES, for systems that are not symmetric
    pub const MPM_SOLVER_GMRES: i32 = 4;
    /// the callback of mpm_stepper_set_linear_solver()
    pub const MPM_SOLVER_HOST: i32 = 100;

    // How much of an exchange its receivers know beforehand.

    /// both sides know who sends to whom: partners send and receive
    pub const MPM_EXCHANGE_KNOWN: i32 = 1;
    /// receivers do not know from whom: particles that move, changes of the pattern
    pub const MPM_EXCHANGE_SPARSE: i32 = 2;

    // What mpm_reduce_fn does.

    /// the largest of all parts
    pub const MPM_REDUCE_MAX: i32 = 1;
    /// the sum, modulo 2^64
    pub const MPM_REDUCE_SUM: i32 = 2;

    // How two bodies meet: mpm_contact_desc.kind.

    /// they push each other and never pull, with Coulomb friction (default)
    pub const MPM_CONTACT_UNILATERAL: i32 = 0;
    /// they pass through each other
    pub const MPM_CONTACT_NONE: i32 = 1;
    /// neither slip nor separation at nodes that both have
    pub const MPM_CONTACT_TIED: i32 = 2;

    // How the normal at a node is found: mpm_contact_desc.normal.

    /// of the plane that separates the particles best: logistic regression
    pub const MPM_NORMAL_LOGISTIC: i32 = 0;
    /// of Fisher's linear discriminant: one pass, for smooth surfaces
    pub const MPM_NORMAL_DISCRIMINANT: i32 = 1;
    /// of the mean gradient of volume: for comparison with other codes
    pub const MPM_NORMAL_GRADIENT: i32 = 2;
    /// mpm_contact_desc.direction
    pub const MPM_NORMAL_FIXED: i32 = 3;

    // How it is found that bodies touch: mpm_contact_desc.detection.

    /// MPM_DETECT_GAP, but MPM_DETECT_VELOCITY with MPM_NORMAL_GRADIENT, whose directions are too far off to measure a
    /// gap along them
    pub const MPM_DETECT_DEFAULT: i32 = 0;
    /// by the gap between their particles
    pub const MPM_DETECT_GAP: i32 = 1;
    /// by velocity alone: wherever they share a node and approach each other
    pub const MPM_DETECT_VELOCITY: i32 = 2;

    // In place of a body: all of them.

    /// any body that has no closer rule; all of them in reports
    pub const MPM_BODY_ANY: i32 = -1;

    // Shapes: mpm_obstacle_desc.shape.

    /// a half-space; outward normal: axis y, in 1-D x. No size
    pub const MPM_SHAPE_PLANE: i32 = 1;
    /// size[0]: radius; in 2-D a disc. Not in 1-D
    pub const MPM_SHAPE_SPHERE: i32 = 2;
    /// around axis z; size[0]: radius, size[1]: half length. 3-D only
    pub const MPM_SHAPE_CYLINDER: i32 = 3;
    /// around axis z; size[0]: radius, size[1]: half length without caps. 3-D only
    pub const MPM_SHAPE_CAPSULE: i32 = 4;
    /// size: half edges; in 2-D a rectangle. Not in 1-D
    pub const MPM_SHAPE_BOX: i32 = 5;
    /// what mpm_obstacle_desc.distance says
    pub const MPM_SHAPE_DISTANCE: i32 = 64;

    // How an obstacle moves: mpm_obstacle_desc.motion.

    /// not at all (default)
    pub const MPM_MOTION_FIXED: i32 = 0;
    /// by its velocities, which the host may change from step to step
    pub const MPM_MOTION_PRESCRIBED: i32 = 1;
    /// as a rigid body under contact, gravity and the host's load
    pub const MPM_MOTION_FREE: i32 = 2;

    // What a batch of mpm_adaption_fn is about.

    /// particles that are to be split
    pub const MPM_ADAPT_SPLIT: i32 = 0;
    /// pairs that are to become one particle
    pub const MPM_ADAPT_MERGE: i32 = 1;

    // How the nodes conduct.

    /// By the temperatures at the start of the step. Steps longer than 1 / (2 diffusivity sum 1 / h_k^2), h_k the
    /// spacings, are refused with MPM_CUT_DT, and mpm_stable_dt() takes the bound into account; with total_lagrangian = 1
    /// spacings are those that the deformation has made of them. So are steps in which a film of mpm_surface_set_heat()
    /// would take more from a particle than its difference to the ambient, of which mpm_stable_dt() knows nothing.
    pub const MPM_CONDUCTION_EXPLICIT: i32 = 0;
    /// By those at its end (backward Euler), found by conjugate gradients: any step will do.
    pub const MPM_CONDUCTION_IMPLICIT: i32 = 1;

    // What a face of the grid does to heat.

    /// lets none through
    pub const MPM_HEAT_WALL_INSULATED: i32 = 0;
    /// material at it has a prescribed temperature
    pub const MPM_HEAT_WALL_TEMPERATURE: i32 = 1;
}

/// A context holds the services of the host (memory, threads, log) and the text of the last error. Every other object is
/// made with one. See context.h.
#[repr(C)]
pub struct mpm_context {
    _opaque: [u8; 0],
    _neither_sent_nor_moved: PhantomData<(*mut u8, PhantomPinned)>,
}

/// A background grid has a dimension, bounds, spacings, a basis and periodic axes. See grid.h.
#[repr(C)]
pub struct mpm_grid {
    _opaque: [u8; 0],
    _neither_sent_nor_moved: PhantomData<(*mut u8, PhantomPinned)>,
}

/// A material is one constitutive law with its parameters. Any number of sets share it. See material.h.
#[repr(C)]
pub struct mpm_material {
    _opaque: [u8; 0],
    _neither_sent_nor_moved: PhantomData<(*mut u8, PhantomPinned)>,
}

/// A set holds particles of one material on one grid. See particles.h.
#[repr(C)]
pub struct mpm_particles {
    _opaque: [u8; 0],
    _neither_sent_nor_moved: PhantomData<(*mut u8, PhantomPinned)>,
}

/// A stepper is one time loop with a grid, sets of particles, a scheme, walls and forces. See stepper.h.
#[repr(C)]
pub struct mpm_stepper {
    _opaque: [u8; 0],
    _neither_sent_nor_moved: PhantomData<(*mut u8, PhantomPinned)>,
}

/// The linear system of an implicit step, which the library lends to the host's solver. See operator.h.
#[repr(C)]
pub struct mpm_operator {
    _opaque: [u8; 0],
    _neither_sent_nor_moved: PhantomData<(*mut u8, PhantomPinned)>,
}

/// A rigid body without particles. It belongs to a context, and may be in one stepper at a time.
#[repr(C)]
pub struct mpm_obstacle {
    _opaque: [u8; 0],
    _neither_sent_nor_moved: PhantomData<(*mut u8, PhantomPinned)>,
}

/// Markers of a surface. It belongs to a grid, and may be in one stepper at a time.
#[repr(C)]
pub struct mpm_surface {
    _opaque: [u8; 0],
    _neither_sent_nor_moved: PhantomData<(*mut u8, PhantomPinned)>,
}

/// A time series of output files (.pvd); its file is valid on disk after every append.
#[repr(C)]
pub struct mpm_series {
    _opaque: [u8; 0],
    _neither_sent_nor_moved: PhantomData<(*mut u8, PhantomPinned)>,
}

/// Starts an exchange and returns before it is done. out: ascending by part, never this one. most: of each partner, a
/// bound on what comes from it, [count]; NULL with MPM_EXCHANGE_SPARSE. Returns 0, or < 0: then the context is unusable
/// (MPM_E_CALLBACK), for the other parts are lost.
pub type mpm_send_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    exchange: i32,
    count: i32,
    out: *const mpm_message,
    most: *const i64,
) -> mpm_status>;

/// Ends the exchange: all that was sent to this part, ascending by part. Returns as mpm_send_fn.
pub type mpm_receive_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    count: *mut i32,
    r#in: *mut *const mpm_message,
) -> mpm_status>;

/// values[count] of all parts into each of them (collective). Returns as mpm_send_fn.
pub type mpm_reduce_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    op: i32,
    count: i64,
    values: *mut i64,
) -> mpm_status>;

/// all[parts]: value of each part (collective). Only when particles are added, sets adapt, implicit steps number their
/// unknowns or pieces of a state are loaded. Returns as mpm_send_fn.
pub type mpm_gather_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    value: i64,
    all: *mut i64,
) -> mpm_status>;

/// For transports that move only when called: called up to eight times between send and receive of a sum on nodes, after
/// each group of the blocks whose sums are made meanwhile. May be NULL.
pub type mpm_transport_poll_fn = Option<unsafe extern "C" fn(user: *mut c_void)>;

/// A task of the library, which the host's executor calls with the task_data that it was given and a number k. A task
/// neither throws nor blocks, and may run on any thread.
pub type mpm_task_fn = Option<unsafe extern "C" fn(task_data: *mut c_void, k: i64)>;

/// The host's executor. It runs task(task_data, k) exactly once for each k in [0, count), in any order, on any threads,
/// and returns when all are done. The library calls it on the calling thread, and its results do not depend on order and
/// threads. A return other than 0 makes the call that needed it fail with MPM_E_CALLBACK.
pub type mpm_parallel_for_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    count: i64,
    task: mpm_task_fn,
    task_data: *mut c_void,
) -> mpm_status>;

/// Returns memory of at least so many bytes at a multiple of alignment, a power of two; or NULL if there is none. Default
/// NULL: the C library's memory is used. alloc and release are set together. Called on the calling thread only.
pub type mpm_context_desc_alloc_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    bytes: usize,
    alignment: usize,
) -> *mut c_void>;

/// Takes back memory from alloc, with the same bytes and alignment. Called on the calling thread only.
pub type mpm_context_desc_release_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    memory: *mut c_void,
    bytes: usize,
    alignment: usize,
)>;

/// Takes a finished text without newline, with a level MPM_LOG_*. The text is valid during the call. Default NULL: the
/// library is silent, since it never writes to the standard streams. Called on the calling thread only.
pub type mpm_context_desc_log_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    level: i32,
    text: *const c_char,
)>;

/// A law (mt). It reads the state before the step and the deformation of the step, and writes stress_new, state_new and
/// wave_speed of all n items, and kinematic_viscosity and energy where it has them. A wave speed or a viscosity below 0
/// stops the step or the call that asked (MPM_E_CALLBACK), and an infinite energy or any other value that is not finite
/// is MPM_NONFINITE; both name the particle. The law may be called several times for one step, and nothing that it writes
/// counts before the step is committed: it keeps no state of its own.
///
/// With dt = 0, F_inc = I and L = 0 the library asks for stress, wave speed and energy of the state as it is: the law
/// returns the stress that belongs to that state.
///
/// Returns 0, a value > 0 to ask for a smaller dt (MPM_CUT_DT), or a value < 0 to stop (MPM_E_CALLBACK).
pub type mpm_stress_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    batch: *const mpm_material_batch,
) -> mpm_status>;

/// The tangent of a law (mt), for implicit steps. It is called after the law on the same batch, with the law's outputs in
/// place, and writes tangent[component * ld + i], a stress, in the form that tangent_form names. With tau = J stress and
/// the variation dF = L F, c is the derivative of the Lie derivative of tau: c_ijkl = d tau_ij / d L_kl - delta_ik tau_jl
/// - delta_jk tau_il.
///
/// - MPM_TANGENT_MINOR_SYMMETRIC has component 6 * row + column, where rows and columns are xx yy zz xy yz xz, and
///   columns are for engineering shear.
/// - MPM_TANGENT_GENERAL has component 9 * (3 * i + j) + 3 * k + l.
///
/// Into *symmetric the callback writes 1 if c has major symmetry (c_ijkl = c_klij) at every item, 0 otherwise. Returns as
/// mpm_stress_fn does.
pub type mpm_tangent_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    batch: *const mpm_material_batch,
    tangent: *mut f64,
    symmetric: *mut i32,
) -> mpm_status>;

/// Called with user when the material is destroyed, not when create fails; may be NULL (default).
pub type mpm_material_desc_release_user_fn = Option<unsafe extern "C" fn(user: *mut c_void)>;

/// Tells which of n points are inside a body: the callback writes inside[i] = 1 or 0 for the point with the coordinates
/// position[c * ld + i], c < dim. It runs on the calling thread. A return other than 0 ends the fill with MPM_E_CALLBACK;
/// nothing is then added.
pub type mpm_inside_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    dim: i32,
    n: i64,
    ld: i64,
    position: *const f64,
    inside: *mut u8,
) -> mpm_status>;

/// Solves matrix * solution = rhs. Runs on the calling thread. Both vectors have as many entries as
/// mpm_operator_get_info() reports owned rows, and solution is preset to the best guess known. The host writes the
/// solution, and into *iterations the number that linear_iterations is to count.
///
/// - tolerance: the wanted ||matrix * solution - rhs|| / ||rhs||.
///
/// Returns 0, a value > 0 if the system was not solved (MPM_CUT_DT), or a value < 0 to stop (MPM_E_CALLBACK).
///
/// With several parts (parallel.h) it is called on all of them, and solves the system of all rows together: each part
/// lends the rows that it owns, complete, with the right-hand side on them, and takes its part of the solution. Where the
/// solver returns another value than 0 on a part, all parts have the outcome of the lowest such; of the iterations the
/// largest number counts. The residual is checked over all parts. A solver that waits for its other parts ends on all of
/// them when it ends on one.
pub type mpm_solve_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    matrix: *const mpm_operator,
    rhs: *const f64,
    solution: *mut f64,
    tolerance: f64,
    iterations: *mut i64,
) -> mpm_status>;

/// Gives a vector per particle (mt): the callback does add[c * ld + i] += value for c < dim, because several sources add
/// to the same array. Returns 0, a value > 0 to ask for a smaller dt (MPM_CUT_DT), or a value < 0 to stop
/// (MPM_E_CALLBACK).
pub type mpm_particle_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    batch: *const mpm_particle_batch,
    add: *mut f64,
) -> mpm_status>;

/// Prescribes nodal velocities (mt). For the nodes and axes to hold, the callback sets prescribed[c * ld + i] = 1 (preset
/// 0), and velocity[c * ld + i] to the mean velocity of the step, so that the displacement increment is dt * velocity in
/// every scheme. Where several prescribe one node and axis, the first of these wins: this callback, prescribed particles
/// (their mean weighted by mass), walls; the reaction counts for the winner. The callback is asked once per step, in the
/// first projection of particles onto nodes; further projections keep to the answer. Returns as mpm_particle_fn does.
pub type mpm_velocity_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    batch: *const mpm_node_batch,
    prescribed: *mut u8,
    velocity: *mut f64,
) -> mpm_status>;

/// Reads and changes the nodal velocity[dim][ld] and force[dim][ld] at a stage of an explicit step (mt). The hook is
/// shown every node that moves by itself: periodic images and mirrored ghosts are counted in with the node that they
/// follow, in mass, velocity and force, and what is written acts on all of them.
///
/// - MPM_AFTER_P2G: velocity is the projected one and force is zero; what is written is added to the force.
/// - MPM_AFTER_FORCES: velocity is the same; force is the whole of it, and may be replaced.
/// - MPM_AFTER_VELOCITY: velocity is the updated one, under walls and prescribed velocities, which do not act again; a
///   change is an impulse of mass times change. force, reactions included, is for reading: what is written there is
///   ignored.
///
/// A change of the projected velocity moves particles, and is given to them as far as the transfer takes nodal
/// velocities: not with MPM_FLIP and flip = 1. Values that are left as they are change no bit; with MPM_APIC_MLS a hook
/// keeps forces apart, as steps in parts do. Hooks run in the projection that has the forces: not in the second one of
/// MPM_MUSL, and not in the first one of MPM_USF, which gives the strain, so that they act on the strain of later steps
/// only. Their work, impulse times new nodal velocity, is part of external_work. MPM_NONFINITE names the node. Returns as
/// mpm_particle_fn does.
pub type mpm_node_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    batch: *const mpm_node_batch,
    velocity: *mut f64,
    force: *mut f64,
) -> mpm_status>;

/// Watches steps. It is called on the calling thread at least once in each step before the step is committed, and after
/// each Newton iteration, with what is known so far; info belongs to the library. Returns 0 to go on, a value > 0 to end
/// the call with MPM_CANCELLED, or a value < 0 to end it with MPM_E_CALLBACK; the step is then not committed.
pub type mpm_progress_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    info: *const mpm_step_info,
) -> mpm_status>;

/// Sets the coefficients of friction of nodes (mt): friction[ld], preset to that of the pair of bodies, may be changed to
/// any finite value >= 0; it then also is that of sticking. It is asked once in a step, with MPM_USF twice: first with
/// the forces of the old stress. Returns as mpm_particle_fn does.
pub type mpm_friction_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    batch: *const mpm_contact_batch,
    friction: *mut f64,
) -> mpm_status>;

/// Gives distances of points (mt). Points are particles, and nodes of blocks that are near the obstacle, also those
/// without material: nodes lie in the grid or up to one spacing beyond its faces, and of a grid with total_lagrangian = 1
/// where the material has taken them. On periodic axes a point is the image nearest to the centre. Returns as
/// mpm_particle_fn does. A value that is not finite, or a normal whose length is not 1 to 1e-6, ends the step:
/// MPM_NONFINITE, MPM_E_CALLBACK.
pub type mpm_distance_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    batch: *const mpm_distance_batch,
) -> mpm_status>;

/// Gives the mean velocity[3] and angular velocity[3] of the step from t over dt; both are preset to the present ones. It
/// is called once per step, on the thread of the call. Returns as mpm_particle_fn does.
pub type mpm_motion_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    t: f64,
    dt: f64,
    velocity: *mut f64,
    angular_velocity: *mut f64,
) -> mpm_status>;

/// Gives tractions: the callback does add[c * ld + i] += force per present area of marker i, c < dim. It runs on the
/// thread of the call, once per step. Returns as mpm_particle_fn does. A value that is not finite ends the step:
/// MPM_NONFINITE.
pub type mpm_traction_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    batch: *const mpm_marker_batch,
    add: *mut f64,
) -> mpm_status>;

/// Gives velocities: the callback does add[c * ld + i] += mean velocity of marker i over the step that begins at
/// batch->t, c < dim. It runs on the thread of the call, once per step, for surfaces that prescribe. Returns as
/// mpm_particle_fn does. A value that is not finite ends the step: MPM_NONFINITE.
pub type mpm_marker_velocity_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    batch: *const mpm_marker_batch,
    add: *mut f64,
) -> mpm_status>;

/// Says which of them are left as they are: accept[i], [ld], is 1, and the callback writes 0 to keep the i-th from it. It
/// runs on the thread of the call. Returns as mpm_particle_fn does.
pub type mpm_adaption_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    batch: *const mpm_adaption_batch,
    accept: *mut u8,
) -> mpm_status>;

/// Heat sources: writes power[i], [ld], power per present volume, at the time batch->t: the start of the step, and with
/// implicit conduction its end. It runs as mpm_particle_fn does, on all threads, and returns as that does. A value that
/// is not finite ends the step: MPM_NONFINITE.
pub type mpm_heat_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    batch: *const mpm_particle_batch,
    power: *mut f64,
) -> mpm_status>;

/// Takes the next bytes of an output, in the order in which a file would have them: for archives, sockets, browsers. All
/// pieces have 65536 bytes, but for the last one, which has fewer or as many; data are lent for the time of the call. It
/// runs on the calling thread. A return other than 0 ends the output with MPM_E_CALLBACK, and mpm_last_error() tells what
/// was returned and after how many bytes; mpm_step_info.callback_status stays that of the last step. Since 0.2.0.
pub type mpm_write_fn = Option<unsafe extern "C" fn(
    user: *mut c_void,
    data: *const c_void,
    bytes: i64,
) -> mpm_status>;

/// A named number. The library reads the name during the call only. The struct is closed: it has no struct_size and gets
/// no further fields.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_param {
    /// one of the names that mpm_material_model_param() lists
    pub name: *const c_char,
    /// the value, in the host's units
    pub value: f64,
}

/// Memory of the library, lent to the host until mpm_view_release(). Component c of item i is ((T *)data)[i * item_stride
/// + c * component_stride], where T is the type that `type` names. The host sets struct_size before the call that fills
/// the view, and changes no field afterwards.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_view {
    /// sizeof(mpm_view) of the caller
    pub struct_size: u32,
    /// MPM_F64, MPM_I64 or MPM_U8
    pub r#type: i32,
    /// stored components of an item; tensors may be compact, see particles.h
    pub components: i32,
    /// MPM_READ, MPM_WRITE or both, as asked for
    pub access: i32,
    /// number of items, inert slots included
    pub count: i64,
    /// distance from item i to item i + 1, in elements
    pub item_stride: i64,
    /// distance from component c to component c + 1, in elements
    pub component_stride: i64,
    /// address of component 0 of item 0; NULL once released
    pub data: *mut c_void,
    /// for the library's use; NULL once released
    pub owner: *mut c_void,
}

impl Default for mpm_view {
    /// Ready to be filled: zeros, and `struct_size`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field.
        let mut out: Self = unsafe { std::mem::zeroed() };
        out.struct_size = size_of::<Self>() as u32;
        out
    }
}

/// Bytes for, or from, another part.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_message {
    /// to whom, or from whom
    pub part: i32,
    /// 0; not looked at in what arrives
    pub reserved: i32,
    /// how many; 0 is sent too where the partner is known
    pub bytes: i64,
    /// out: the library's, unchanged until mpm_receive_fn returns; in: the host's, at a multiple of 64, valid until the
    /// next mpm_send_fn.
    pub data: *mut c_void,
}

/// Ways between the parts. All are called on the calling thread. Once one has failed, every collective call of the
/// context returns MPM_E_CALLBACK.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_transport {
    /// sizeof(mpm_transport) of the caller
    pub struct_size: u32,
    /// of this context, 0 ... parts - 1
    pub part: i32,
    /// how many there are
    pub parts: i32,
    /// 0
    pub reserved: i32,
    /// required, as the three that follow
    pub send: mpm_send_fn,
    /// ends what send started
    pub receive: mpm_receive_fn,
    /// maxima and sums of integers
    pub reduce: mpm_reduce_fn,
    /// one integer of each part
    pub gather: mpm_gather_fn,
    /// For transports that move only when called: called up to eight times between send and receive of a sum on nodes,
    /// after each group of the blocks whose sums are made meanwhile. May be NULL.
    pub poll: mpm_transport_poll_fn,
    /// passed to all of them
    pub user: *mut c_void,
}

/// How blocks of the grid are given to parts. Fill it with mpm_balance_desc_init(); all 0 are the defaults.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_balance_desc {
    /// sizeof(mpm_balance_desc) of the caller
    pub struct_size: u32,
    /// 0 (default): a block weighs what its particles and block_weight come to. 1: the seconds that a part has spent in
    /// steps since blocks were last given to parts, those of waiting left out, are what its blocks weigh together, each
    /// in proportion to that.
    pub measure: i32,
    /// Blocks are given to parts anew, at a sort, when the largest weight of a part is this many times the mean, at least
    /// 1; infinity: never. 0 (default): 1.1, and only when the steps since the last time would have gained more by it
    /// than it costs to move the particles.
    pub limit: f64,
    /// What a block costs beside its particles, in particles, from 0 to 1e6. 0 (default): 60, about what the sums of its
    /// nodes take.
    pub block_weight: f64,
}

impl Default for mpm_balance_desc {
    /// The library's defaults: `mpm_balance_desc_init()`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field, and the library writes as many bytes as it is told.
        unsafe {
            let mut out: Self = std::mem::zeroed();
            let status = mpm_balance_desc_init(&mut out, size_of::<Self>() as u32);
            assert_eq!(status, MPM_OK, "mpm_balance_desc_init");
            out
        }
    }
}

/// What one part does of a problem, and what that costs. Counts are of this part, since the stepper was made or they were
/// last reset; the caller sets struct_size.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_parallel_info {
    /// sizeof(mpm_parallel_info) of the caller
    pub struct_size: u32,
    /// parts that share nodes with this one
    pub neighbours: i32,
    /// with particles of this part
    pub blocks: i64,
    /// of them beside blocks of other parts
    pub boundary: i64,
    /// blocks of other parts beside them
    pub ghosts: i64,
    /// sent for sums on nodes
    pub bytes_nodes: i64,
    /// sent for particles that moved to another part
    pub bytes_moved: i64,
    /// such particles
    pub moved: i64,
    /// how often blocks were given to parts anew
    pub cuts: i64,
    /// largest weight of a part over the mean at the last sort, the same on all parts
    pub imbalance: f64,
    /// packing what is sent, and unpacking particles
    pub seconds_packing: f64,
    /// in receive
    pub seconds_waiting: f64,
    /// in reduce and gather
    pub seconds_reducing: f64,
}

impl Default for mpm_parallel_info {
    /// Ready to be filled: zeros, and `struct_size`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field.
        let mut out: Self = unsafe { std::mem::zeroed() };
        out.struct_size = size_of::<Self>() as u32;
        out
    }
}

/// Services of the host. Fill the struct with mpm_context_desc_init(), then change what is wanted.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_context_desc {
    /// sizeof(mpm_context_desc) of the caller
    pub struct_size: u32,
    /// Number of threads, 0 to 1024. 1 (default): the calling thread only; N: a pool of N threads, the calling one
    /// included; 0: one per processor. The pool belongs to the context; its threads sleep when idle, after they have
    /// looked for work for 100 microseconds, and rest in steps that are over sooner without them. Results do not depend
    /// on the number. A build without threads (MPM_NO_THREADS) takes 0 and 1, or any number with parallel_for, else
    /// MPM_E_UNSUPPORTED.
    ///
    /// A process that fork() makes between two calls has the context and its objects, but none of the pool's threads:
    /// there everything runs on the calling thread, with the same results, and destroying frees as ever.
    pub concurrency: i32,
    /// Instruction set of the kernels: MPM_ISA_BEST (default) or the one to be used, which creation refuses with
    /// MPM_E_UNSUPPORTED if processor or library lacks it. With MPM_ISA_BEST the environment variable MPM_ISA (portable
    /// or baseline, avx2, avx512, neon) decides where it is set; it is read once, at creation.
    pub isa: i32,
    /// 1: the library calls the host from the calling thread only, also where a callback is marked (mt). Default 0.
    pub serial_callbacks: i32,
    /// Returns memory of at least so many bytes at a multiple of alignment, a power of two; or NULL if there is none.
    /// Default NULL: the C library's memory is used. alloc and release are set together. Called on the calling thread
    /// only.
    pub alloc: mpm_context_desc_alloc_fn,
    /// Takes back memory from alloc, with the same bytes and alignment. Called on the calling thread only.
    pub release: mpm_context_desc_release_fn,
    /// first argument of alloc and release
    pub alloc_user: *mut c_void,
    /// The host's executor, which takes the place of the pool; concurrency then says for how many threads the work is
    /// cut. Default NULL: there is none.
    pub parallel_for: mpm_parallel_for_fn,
    /// first argument of parallel_for
    pub parallel_user: *mut c_void,
    /// Takes a finished text without newline, with a level MPM_LOG_*. The text is valid during the call. Default NULL:
    /// the library is silent, since it never writes to the standard streams. Called on the calling thread only.
    pub log: mpm_context_desc_log_fn,
    /// first argument of log
    pub log_user: *mut c_void,
    /// The host's memory for a sentence that says why mpm_context_create() has failed: it is cut to fit, and ends with a
    /// zero; after MPM_OK it is as before. Used during that call only. Default NULL: there is none.
    pub error_text: *mut c_char,
    /// size of error_text in bytes; 0 exactly where error_text is NULL
    pub error_bytes: u64,
    /// The ways to the other parts of the problem, read during mpm_context_create() and copied, or NULL (default): there
    /// is one part. See parallel.h, which says what is collective then; mpm_context_create() is, and all parts need the
    /// same version and instruction set.
    pub transport: *const mpm_transport,
}

impl Default for mpm_context_desc {
    /// The library's defaults: `mpm_context_desc_init()`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field, and the library writes as many bytes as it is told.
        unsafe {
            let mut out: Self = std::mem::zeroed();
            let status = mpm_context_desc_init(&mut out, size_of::<Self>() as u32);
            assert_eq!(status, MPM_OK, "mpm_context_desc_init");
            out
        }
    }
}

/// Box, cells and basis of a grid. Fill the struct with mpm_grid_desc_init(). Entries of axes beyond dim are ignored.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_grid_desc {
    /// sizeof(mpm_grid_desc) of the caller
    pub struct_size: u32,
    /// 1 (uniaxial strain), 2 (see geometry) or 3 (default)
    pub dim: i32,
    /// MPM_LINEAR to MPM_CPGIMP; default MPM_BSPLINE2
    pub basis: i32,
    /// for B-splines: MPM_BOUNDARY_GHOST (default) or MPM_BOUNDARY_OPEN_KNOT
    pub boundary_basis: i32,
    /// 1: the axis is periodic; default 0
    pub periodic: [i32; 3],
    /// for dim 2: an MPM_PLANE_STRAIN (default) ... MPM_PLANE_STRESS. Since 0.2.0
    pub geometry: i32,
    /// cells along each axis, 1 to 6291456; memory follows the material
    pub cells: [i64; 3],
    /// lower corner of the box, length; default 0
    pub origin: [f64; 3],
    /// edges of a cell, length, > 0; the upper corner is origin + cells * spacing
    pub spacing: [f64; 3],
    /// for MPM_UGIMP: edge of a particle's domain / spacing, in (0, 1]; default 0.5
    pub smoothing: f64,
    /// 1: a total Lagrangian grid (de Vaucorbeil, Nguyen & Hutchinson 2020). Its cells hold the material as it was before
    /// it deformed: weights follow from "reference_position" and stay what they are. Nothing is sorted anew, particles do
    /// not cross cells, and material that is drawn out does not come apart. "position" may leave the box. Walls,
    /// prescribed velocities, node hooks and nodal fields are those of nodes at their places in the box, and so is
    /// MPM_WALL_FRICTION_NODES; obstacles and MPM_WALL_FRICTION meet particles where they are now. For solids of one
    /// body: fluids, contact between bodies and MPM_WALL_OPEN are refused. 0 (default): weights follow from "position".
    /// Since 0.2.0
    pub total_lagrangian: i32,
    /// 0
    pub reserved: i32,
}

impl Default for mpm_grid_desc {
    /// The library's defaults: `mpm_grid_desc_init()`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field, and the library writes as many bytes as it is told.
        unsafe {
            let mut out: Self = std::mem::zeroed();
            let status = mpm_grid_desc_init(&mut out, size_of::<Self>() as u32);
            assert_eq!(status, MPM_OK, "mpm_grid_desc_init");
            out
        }
    }
}

/// Particles that a law is asked about. Arrays are [components][ld], of which the first n items of each component count.
/// Tensors are full: F, F_inc and L have component 3 * row + column, stresses xx yy zz xy yz xz. In callbacks the memory
/// belongs to the library and is valid during the call, and output arrays do not overlap input arrays.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_material_batch {
    /// sizeof(mpm_material_batch) of the library; see mpm.h
    pub struct_size: u32,
    /// number of state variables of a particle
    pub state_count: i32,
    /// number of particles, inert slots included
    pub n: i64,
    /// distance from component c to c + 1, in elements; >= n
    pub ld: i64,
    /// time at the end of the step
    pub t: f64,
    /// size of the step; 0: the state as it is, see mpm_stress_fn
    pub dt: f64,
    /// [ld] ids, < 0 for inert slots
    pub id: *const i64,
    /// [9][ld] deformation gradient at the end of the step
    pub F: *const f64,
    /// [9][ld] deformation gradient of this step alone: F = F_inc F_old
    pub F_inc: *const f64,
    /// [9][ld] velocity gradient (F_inc - I) / dt, 1/time; 0 when dt is 0
    pub L: *const f64,
    /// [6][ld] Cauchy stress before the step
    pub stress: *const f64,
    /// [state_count][ld] state variables before the step
    pub state: *const f64,
    /// [6][ld] out: Cauchy stress after the step
    pub stress_new: *mut f64,
    /// [state_count][ld] out: state variables after the step
    pub state_new: *mut f64,
    /// [ld] out: speed of the fastest elastic wave now, length/time
    pub wave_speed: *mut f64,
    /// [ld] out, preset 0: length^2/time, limits the explicit dt
    pub kinematic_viscosity: *mut f64,
    /// [ld] out, preset NaN (not known): strain energy per initial volume
    pub energy: *mut f64,
    /// [dim][ld] position at the start of the step
    pub position: *const f64,
    /// argument of mpm_batch_field()
    pub lookup: *const c_void,
}

impl Default for mpm_material_batch {
    /// Ready to be filled: zeros, and `struct_size`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field.
        let mut out: Self = unsafe { std::mem::zeroed() };
        out.struct_size = size_of::<Self>() as u32;
        out
    }
}

/// A law of the host. Fill the struct with mpm_material_desc_init().
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_material_desc {
    /// sizeof(mpm_material_desc) of the caller
    pub struct_size: u32,
    /// number of state variables of a particle, 0 to 64; default 0
    pub state_count: i32,
    /// MPM_TANGENT_MINOR_SYMMETRIC (default) or MPM_TANGENT_GENERAL
    pub tangent_form: i32,
    /// 0
    pub reserved: i32,
    /// mass per initial volume, > 0; the host must set it
    pub density: f64,
    /// the law; the host must set it
    pub stress: mpm_stress_fn,
    /// NULL (default): stresses are differenced, in the general form
    pub tangent: mpm_tangent_fn,
    /// first argument of stress, tangent and release_user
    pub user: *mut c_void,
    /// Called with user when the material is destroyed, not when create fails; may be NULL (default).
    pub release_user: mpm_material_desc_release_user_fn,
    /// [state_count] state of a new particle, copied; NULL (default): zeros
    pub state_initial: *const f64,
}

impl Default for mpm_material_desc {
    /// The library's defaults: `mpm_material_desc_init()`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field, and the library writes as many bytes as it is told.
        unsafe {
            let mut out: Self = std::mem::zeroed();
            let status = mpm_material_desc_init(&mut out, size_of::<Self>() as u32);
            assert_eq!(status, MPM_OK, "mpm_material_desc_init");
            out
        }
    }
}

/// A linear system. The caller sets struct_size. The arrays belong to the library and are valid until the solve callback
/// returns. A row is one component of one node; nodes and components whose displacement is prescribed have none. Rows of
/// one node follow each other, by ascending component.
///
/// With several parts a row is owned by exactly one part. Local rows 0 to owned_rows - 1 are those that this part owns,
/// in the order of nodes that it has; they are numbered first_row, first_row + 1, ... over all parts, part by part.
/// Behind them stand rows that other parts own, those alone that columns of owned rows name: they have number, node,
/// component and position, and no entries of their own. Every vector has owned_rows entries. With one part all rows are
/// owned, and number[i] is i.
///
/// What a solver has made of a pattern serves as long as pattern_id is the same, of another stepper too.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_operator_info {
    /// sizeof(mpm_operator_info) of the caller
    pub struct_size: u32,
    /// number of rows of a node on which nothing is prescribed
    pub block: i32,
    /// 1 if the matrix is symmetric, else 0
    pub symmetric: i32,
    /// 1 if the matrix is expected to be positive definite, which is not checked
    pub positive_definite: i32,
    /// number of local rows and of local columns
    pub rows: i64,
    /// number of stored entries, all of them in owned rows
    pub nonzeros: i64,
    /// a hash of nodes, axes and columns, below 2^53, equal on all parts
    pub pattern_id: i64,
    /// distance from component c to c + 1 of position, in elements; >= rows
    pub ld: i64,
    /// [rows] number of the node of each row, as in mpm_step_info.node
    pub node: *const i64,
    /// [rows] axis of each row
    pub component: *const i32,
    /// [dim][ld] position of the node of each row, for near-null spaces
    pub position: *const f64,
    /// number of the first owned row over all parts; 0 with one part
    pub first_row: i64,
    /// number of rows that this part owns; rows with one part
    pub owned_rows: i64,
    /// number of rows of all parts together
    pub all_rows: i64,
    /// [rows] number of each local row over all parts
    pub number: *const i64,
}

impl Default for mpm_operator_info {
    /// Ready to be filled: zeros, and `struct_size`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field.
        let mut out: Self = unsafe { std::mem::zeroed() };
        out.struct_size = size_of::<Self>() as u32;
        out
    }
}

/// Options of a stepper. Fill the struct with mpm_stepper_desc_init(), then change what is wanted.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_stepper_desc {
    /// sizeof(mpm_stepper_desc) of the caller
    pub struct_size: u32,
    /// MPM_USL (default), MPM_USF, MPM_MUSL or MPM_NEWMARK
    pub scheme: i32,
    /// MPM_FLIP (default) to MPM_FMPM. MPM_NEWMARK takes MPM_FLIP with flip = 1 only.
    pub transfer: i32,
    /// Order m of MPM_XPIC, 1 (PIC) to 5, or k of MPM_FMPM, 1 (PIC) to 32; default 2. Each order above the first projects
    /// and gathers once more. These corrections obey fixed and slip walls and periodic axes, those of MPM_FMPM prescribed
    /// velocities as well; contact acts before them, with its whole impulse.
    pub xpic_order: i32,
    /// Order of the update of positions; v is the updated nodal velocity and w a weight. 1 (default): x += dt sum w v
    /// (Steffen et al. 2008, eq. 10). 2: x += dt sum w v - dt^2 / 2 sum w a, which is exact under constant acceleration
    /// (MPoint theory, eq. 37, where the last term is misprinted); it is not for staggered steps, which have that order
    /// with 1. MPM_NEWMARK moves particles by the displacements that it solves for, whatever the order.
    pub position_order: i32,
    /// MPM_LOCKING_NONE (default) or, in 2-D and 3-D, MPM_LOCKING_CELL_AVERAGE. With the latter the sets of the stepper
    /// have the field "dilation_ratio". Not with MPM_PLANE_STRESS.
    pub locking_remedy: i32,
    /// 1: keeps "reference_position" and shows it to callbacks; default 0. With total_lagrangian = 1 that is so anyway
    pub reference_positions: i32,
    /// 1: MPM_NEWMARK drops the inertia, so that each step ends in equilibrium under the forces at its end. Velocities
    /// are then displacements over dt, and accelerations are zero. Default 0. MPM_E_UNSUPPORTED with other schemes.
    pub quasi_static: i32,
    /// 1: particle velocities are those at t_n - dt/2 (Steffen et al. 2008, eqs 11-15), and so is the kinetic energy;
    /// default 0. The host sets velocities of that time, because the library does not shift them. Forces change
    /// velocities over the mean of this dt and the one before, in the first step over its dt, so that dt may change.
    /// Positions and strain follow over dt. MPM_E_UNSUPPORTED with position_order = 2.
    pub staggered: i32,
    /// Acceleration of nodes whose velocity the host or a particle prescribes. 0 (default): the one that brings them from
    /// the projected to the prescribed velocity (Steffen et al. 2008, eq. 30), or with MPM_NEWMARK that of its rule; 1:
    /// zero. Nodes that walls hold have none in either case: a slip wall is a symmetry plane, on which the projected
    /// velocity is zero too.
    pub boundary_zero_acceleration: i32,
    /// Share of FLIP per step for MPM_FLIP, MPM_TFLIP and MPM_AFLIP, and between the steps that xpic_every counts, from 1
    /// (default, FLIP) to 0 (PIC).
    pub flip: f64,
    /// Rate beta >= 0, 1/time, of a blend that does not depend on dt (MPoint theory, eqs 58-59), for the transfers of
    /// flip: the step's share of FLIP is flip * max(0, 1 - beta dt). Default 0.
    pub pic_damping: f64,
    /// acceleration of all particles, length/time^2; default 0. Of MPM_AXISYMMETRIC along the axis alone
    pub gravity: [f64; 3],
    /// Newmark's beta: default 1/4, as Guilkey & Weiss 2003, eqs 14-15
    pub newmark_beta: f64,
    /// Newmark's gamma: default 1/2, as there; larger values damp high frequencies
    pub newmark_gamma: f64,
    /// Newton iterations end when the displacement increment is at most this share of the largest of the step, both
    /// measured by the diagonal of the stiffness, in which light nodes count little (Guilkey & Weiss 2003, eq. 13,
    /// eps_d), and the next two bounds hold as well. Default 1e-8.
    pub newton_tolerance_displacement: f64,
    /// They end when the increment times the residual is at most this share of the first of the step (eps_e in the same
    /// eq. 13), and the other two bounds hold. Default 1e-14.
    pub newton_tolerance_energy: f64,
    /// They end when the norm of the residual is at most this share of a scale that includes reactions, and the other two
    /// bounds hold. Default 1e-8.
    pub newton_tolerance_residual: f64,
    /// Norm of the residual, a force, up to which its bound holds whatever the scale. Default 0.
    pub newton_residual_floor: f64,
    /// iterations after which a step is MPM_NOT_CONVERGED; default 20
    pub newton_max_iterations: i32,
    /// MPM_SOLVER_AUTO (default) to MPM_SOLVER_HOST
    pub linear_solver: i32,
    /// ||K x - b|| / ||b||; 0 (default): the Newton iteration chooses it
    pub linear_tolerance: f64,
    /// most iterations of a linear solve; 0 (default): the solver chooses
    pub linear_max_iterations: i32,
    /// 1: with MPM_MUSL particles move by the projected velocities, which strain them too: x += dt sum w v, with the v of
    /// the second projection. Bodies in sustained tension, whose particles otherwise move by more than they are strained
    /// by (theory, section 11.1), are stable then, but for a nearly incompressible one whose volume is forced to grow. 0
    /// (default): they move by the updated velocities, as Sulsky et al. 1995. MPM_E_UNSUPPORTED with other schemes, which
    /// have no such velocities after the update. Since 0.2.0, in the place of `reserved`.
    pub projected_positions: i32,
    /// Local damping alpha of Cundall 1987, in [0, 1); default 0. In explicit steps each component of a node's whole
    /// unbalanced force f, ties to images and the hook MPM_AFTER_FORCES counted in, becomes f - alpha |f| sign(v), where
    /// v is the projected velocity. Bodies come to rest under dead loads, and reactions are those of the material: what
    /// walls or prescribed velocities hold is not damped, and contact acts after it. It also slows free fall and rigid
    /// motion, to (1 - alpha) g. MPM_E_UNSUPPORTED with MPM_NEWMARK. Since 0.2.0.
    pub local_damping: f64,
    /// Damping in proportion to mass, a >= 0 in 1/time; default 0: the force -a m v on nodes, for a share of a / (2
    /// omega) of critical damping. In explicit steps v is the mean of the velocities before and after, by which the
    /// stable dt stays as it is; with MPM_NEWMARK it is that at the end of the step. It acts where local_damping does.
    /// MPM_E_UNSUPPORTED with quasi_static. Since 0.2.0.
    pub mass_damping: f64,
    /// For MPM_XPIC and MPM_FMPM: every so many steps are of the order xpic_order, those whose number
    /// (mpm_step_info::step, counted from 1 or on from mpm_stepper_set_time()) is a multiple of this; all others are
    /// those of MPM_FLIP, with flip and pic_damping. Steps that fail have no number, and a loaded state goes on with its
    /// own. 1, and 0 (default), which means 1: every step is of that order. MPM_E_UNSUPPORTED: above 2 with MPM_FMPM of
    /// an order above 1 and MPM_USF or MPM_MUSL, where waves grow. Since 0.2.0.
    pub xpic_every: i32,
    /// 0
    pub reserved: i32,
}

impl Default for mpm_stepper_desc {
    /// The library's defaults: `mpm_stepper_desc_init()`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field, and the library writes as many bytes as it is told.
        unsafe {
            let mut out: Self = std::mem::zeroed();
            let status = mpm_stepper_desc_init(&mut out, size_of::<Self>() as u32);
            assert_eq!(status, MPM_OK, "mpm_stepper_desc_init");
            out
        }
    }
}

/// What a step did, or the state as it is. The caller sets struct_size. Energies and momenta are the particles'; the
/// angular momentum is about the origin and includes the part of the matrices that transfers carry ("velocity_gradient").
/// Entries of unused axes are 0. After a failed step the sums are those of the state that was kept. Units are the host's:
/// energies force * length, momenta mass * length/time.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_step_info {
    /// sizeof(mpm_step_info) of the caller
    pub struct_size: u32,
    /// status of the failure, MPM_OK if there was none
    pub cause: i32,
    /// what a callback returned when it was not 0, else 0
    pub callback_status: i32,
    /// linear solves of the step; 0 for explicit schemes, and at rest
    pub newton_iterations: i32,
    /// MPM_SOLVER_* that was used; 0 for explicit schemes
    pub linear_solver: i32,
    /// Set of the first failure, numbered in order of mpm_stepper_add(), or -1. The first is the smallest (set, particle)
    /// of those that failed, so that reports repeat.
    pub set: i32,
    /// number of committed steps, counted on from mpm_stepper_set_time()
    pub step: i64,
    /// Number of nodes with mass in the step; of one that failed before they were counted, that of the step before.
    pub active_nodes: i64,
    /// particles that left through MPM_WALL_OPEN since the stepper was made
    pub removed: i64,
    /// how often particles were sorted anew since the stepper was made
    pub resorts: i64,
    /// id of the particle that failed, or -1
    pub particle: i64,
    /// Node that failed, or -1: its lexicographic number over the grid with one ghost layer per side,
    /// ((ix+1)*(cells_y+3)+(iy+1))*(cells_z+3)+(iz+1) with unused axes left out.
    pub node: i64,
    /// iterations of the linear solver, summed over the step
    pub linear_iterations: i64,
    /// time of the state
    pub t: f64,
    /// size of the step that was tried; 0 before the first
    pub dt: f64,
    /// After success the stable dt of the new state, or with MPM_NEWMARK 2 dt if there were at most 4 iterations and else
    /// dt. After a failure 0.6 dt.
    pub dt_suggested: f64,
    /// last relative residual of the Newton iteration; 0 for explicit schemes
    pub residual: f64,
    /// sum m v.v / 2
    pub kinetic_energy: f64,
    /// sum energy * initial_volume; NaN when a law has none
    pub strain_energy: f64,
    /// Work during the step of gravity, acceleration and force callbacks, applied_force, surfaces, node hooks, prescribed
    /// nodal velocities and prescribed particles.
    pub external_work: f64,
    /// (kinetic + strain) before the step + external_work - (kinetic + strain) after; NaN where the strain energy is.
    pub dissipation: f64,
    /// sum m v; along the radius of MPM_AXISYMMETRIC 0
    pub momentum: [f64; 3],
    /// sum m x cross v; in 2-D about z, in [2]; in 1-D and MPM_AXISYMMETRIC 0
    pub angular_momentum: [f64; 3],
    /// Sum of external_work over all committed steps since the stepper was made or its time was set.
    pub external_work_total: f64,
    /// sum m tr(C D C^T) / 2: kinetic energy of the matrices that APIC, APIC_MLS, TPIC, TFLIP and AFLIP carry (C is
    /// "velocity_gradient", D the second moments of the basis), whose angular momentum is part of angular_momentum. It is
    /// not part of kinetic_energy. 0 with other transfers.
    pub affine_kinetic_energy: f64,
    /// Energy that contact of bodies, obstacles and MPM_WALL_FRICTION took in the step, from the velocities that the
    /// nodes would have without it: never negative. In explicit steps forces drive bodies that press on each other
    /// together in every step, and contact takes that again: its sum over steps has a part that goes with dt and is no
    /// loss. What is lost is `dissipation`.
    pub contact_dissipation: f64,
    /// nodes at which these gave each other an impulse
    pub contact_nodes: i64,
    /// velocity field of `node`; 0 where there is none
    pub body: i32,
    /// 0
    pub reserved: i32,
    /// Energy that local_damping and mass_damping took in the step: a part of `dissipation`. It is their force times the
    /// mean of the nodes' velocities before and after, so that it is negative at nodes that turn.
    pub damping_dissipation: f64,
    /// Sum of damping_dissipation over all committed steps since the stepper was made or its time was set.
    pub damping_dissipation_total: f64,
}

impl Default for mpm_step_info {
    /// Ready to be filled: zeros, and `struct_size`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field.
        let mut out: Self = unsafe { std::mem::zeroed() };
        out.struct_size = size_of::<Self>() as u32;
        out
    }
}

/// Particles of one set for which a force is wanted. Arrays are [components][ld], of which the first n items of each
/// component count. The memory belongs to the library and is valid during the call.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_particle_batch {
    /// sizeof(mpm_particle_batch) of the library; see mpm.h
    pub struct_size: u32,
    /// dimension of the grid
    pub dim: i32,
    /// number of particles, inert slots included
    pub n: i64,
    /// distance from component c to c + 1, in elements; >= n
    pub ld: i64,
    /// Time for which the value is wanted: the start of the step. Forces of MPM_NEWMARK are wanted for its end, and for
    /// the start where accelerations are to be found.
    pub t: f64,
    /// size of the step
    pub dt: f64,
    /// [ld] ids, < 0 for inert slots
    pub id: *const i64,
    /// [dim][ld] at the start of the step, wrapped on periodic axes unless total_lagrangian = 1
    pub position: *const f64,
    /// [dim][ld], or NULL without reference_positions; never NULL with total_lagrangian = 1
    pub reference_position: *const f64,
    /// [dim][ld] at the start of the step
    pub velocity: *const f64,
    /// [ld]
    pub mass: *const f64,
    /// [ld] at the start of the step
    pub volume: *const f64,
    /// the set, for comparison only: no call takes it in a callback
    pub particles: *const mpm_particles,
    /// argument of mpm_batch_field()
    pub lookup: *const c_void,
}

/// Active nodes of the grid. Arrays are [components][ld], of which the first n items of each component count. The memory
/// belongs to the library and is valid during the call.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_node_batch {
    /// sizeof(mpm_node_batch) of the library; see mpm.h
    pub struct_size: u32,
    /// dimension of the grid
    pub dim: i32,
    /// velocity field of the nodes; see mpm_stepper_set_body()
    pub body: i32,
    /// 0
    pub reserved: i32,
    /// number of nodes
    pub n: i64,
    /// distance from component c to c + 1, in elements; >= n
    pub ld: i64,
    /// time for which the value is wanted
    pub t: f64,
    /// size of the step
    pub dt: f64,
    /// [dim][ld] index of the basis function, from -1 to cells + 1. Ghosts lie outside 0 to cells. Open knots have no
    /// ghosts, and other functions at these indices: go by position.
    pub index: *const i64,
    /// [dim][ld] origin + index * spacing; with open knots the Greville points
    pub position: *const f64,
    /// [ld]
    pub mass: *const f64,
    /// [ld] 1 on exactly one of the parts that have the node, for sums of the host, else 0; all 1 with one part: see
    /// parallel.h. Since 0.2.0.
    pub owned: *const u8,
}

/// How mpm_advance() chooses its sub-steps. Fill the struct with mpm_advance_desc_init().
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_advance_desc {
    /// sizeof(mpm_advance_desc) of the caller
    pub struct_size: u32,
    /// most cuts of one sub-step before the call gives up; 0 (default): 60
    pub max_cuts: i32,
    /// time to reach, not before the present one
    pub t_end: f64,
    /// Explicit: share of mpm_stable_dt(), in (0, 1], or 0 (default since 0.2.0, was 0.5): two thirds of the largest
    /// share at which bodies were found to stay bounded, by basis and scheme: with all transfers in 1-D and 2-D (of
    /// MPM_XPIC order 2, of MPM_FMPM 2 and 8), with MPM_FLIP in 3-D. With MPM_USL that is 0.40 on MPM_LINEAR and
    /// MPM_BSPLINE2, 0.60 on MPM_BSPLINE3, 0.27 with GIMP; with MPM_MUSL and MPM_USF 0.60, 0.67, 0.67 and 0.47, but 0.33
    /// with MPM_CPGIMP and MPM_USF. Implicit: ignored.
    pub cfl: f64,
    /// most that the first sub-step takes; 0 (default): the controller's dt
    pub dt_first: f64,
    /// size below which sub-steps are not cut; 0 (default): no bound
    pub dt_min: f64,
    /// size of the largest sub-step; 0 (default): no bound
    pub dt_max: f64,
    /// most sub-steps of this call; 0 (default): no limit
    pub max_steps: i64,
}

impl Default for mpm_advance_desc {
    /// The library's defaults: `mpm_advance_desc_init()`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field, and the library writes as many bytes as it is told.
        unsafe {
            let mut out: Self = std::mem::zeroed();
            let status = mpm_advance_desc_init(&mut out, size_of::<Self>() as u32);
            assert_eq!(status, MPM_OK, "mpm_advance_desc_init");
            out
        }
    }
}

/// Seconds of wall-clock time spent in steps since creation or the last reset, by stage. The caller sets struct_size.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_profile {
    /// sizeof(mpm_profile) of the caller
    pub struct_size: u32,
    /// 0
    pub reserved: i32,
    /// sorting particles, activating nodes
    pub sort: f64,
    /// weights, particles to grid
    pub p2g: f64,
    /// nodal update, walls, prescribed velocities
    pub grid: f64,
    /// grid to particles
    pub g2p: f64,
    /// laws within g2p and assembly, from samples; their tangents are in assembly
    pub law: f64,
    /// residual and matrix
    pub assembly: f64,
    /// factorisation, set-up of preconditioners
    pub factor: f64,
    /// linear solves
    pub solve: f64,
    /// the host's callbacks
    pub callbacks: f64,
    /// whole steps
    pub total: f64,
    /// weights of the basis within p2g and g2p, from samples
    pub weights: f64,
}

impl Default for mpm_profile {
    /// Ready to be filled: zeros, and `struct_size`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field.
        let mut out: Self = unsafe { std::mem::zeroed() };
        out.struct_size = size_of::<Self>() as u32;
        out
    }
}

/// How two bodies meet. Fill it with mpm_contact_desc_init().
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_contact_desc {
    /// sizeof(mpm_contact_desc) of the caller
    pub struct_size: u32,
    /// an MPM_CONTACT_...; default MPM_CONTACT_UNILATERAL
    pub kind: i32,
    /// an MPM_NORMAL_...; default MPM_NORMAL_LOGISTIC
    pub normal: i32,
    /// an MPM_DETECT_...; default MPM_DETECT_DEFAULT
    pub detection: i32,
    /// Coulomb's coefficient of sliding, >= 0; default 0
    pub friction: f64,
    /// that of sticking, >= friction; 0 (default): the same as friction
    pub friction_static: f64,
    /// largest tensile traction while the gap is closed, stress, >= 0; default 0. Not with detection by velocity, which
    /// knows no gap
    pub adhesion: f64,
    /// distance that the surfaces keep, length; < 0: overlap is let be; default 0. Bodies see each other from about a
    /// cell on: more than that they do not keep
    pub offset: f64,
    /// MPM_NORMAL_FIXED: unit normal, from the first body to the second
    pub direction: [f64; 3],
}

impl Default for mpm_contact_desc {
    /// The library's defaults: `mpm_contact_desc_init()`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field, and the library writes as many bytes as it is told.
        unsafe {
            let mut out: Self = std::mem::zeroed();
            let status = mpm_contact_desc_init(&mut out, size_of::<Self>() as u32);
            assert_eq!(status, MPM_OK, "mpm_contact_desc_init");
            out
        }
    }
}

/// What two bodies did to each other in the last step, and since then. The caller sets struct_size. Forces are means over
/// the step.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_contact_info {
    /// sizeof(mpm_contact_info) of the caller
    pub struct_size: u32,
    /// 1: an impulse was given
    pub touching: i32,
    /// nodes at which both have mass
    pub nodes: i64,
    /// of these, with an impulse
    pub closed: i64,
    /// of these, without slip
    pub stuck: i64,
    /// nodes that were left out: there is no normal, or both bodies are held
    pub ambiguous: i64,
    /// on the second body, force
    pub force: [f64; 3],
    /// of the same about the origin; in 2-D in component 2; of MPM_AXISYMMETRIC without meaning
    pub torque: [f64; 3],
    /// sum of the nodes' normal forces, >= 0 without adhesion
    pub normal_force: f64,
    /// of closed nodes, length^(dim - 1); of MPM_AXISYMMETRIC times radius
    pub area: f64,
    /// largest normal force over area of a node, stress: rows of nodes on both sides of a surface share them unevenly,
    /// and it may be twice what the surface has
    pub pressure_max: f64,
    /// smallest gap that was measured, length; < 0: overlap; infinity if none was
    pub gap: f64,
    /// friction and closing in the step; see contact_dissipation of mpm_step_info
    pub dissipation: f64,
    /// of it, by friction
    pub friction_work: f64,
    /// on the second body over all committed steps since the stepper was made or mpm_stepper_set_time() was called, mass
    /// length/time
    pub impulse: [f64; 3],
}

impl Default for mpm_contact_info {
    /// Ready to be filled: zeros, and `struct_size`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field.
        let mut out: Self = unsafe { std::mem::zeroed() };
        out.struct_size = size_of::<Self>() as u32;
        out
    }
}

/// Nodes at which two bodies touch, for mpm_friction_fn. Arrays belong to the library.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_contact_batch {
    /// sizeof(mpm_contact_batch) of the library; see mpm.h
    pub struct_size: u32,
    /// dimension of the grid
    pub dim: i32,
    /// the first body, the lower number
    pub body_a: i32,
    /// the second body
    pub body_b: i32,
    /// number of nodes
    pub n: i64,
    /// distance from component c to c + 1, in elements; >= n
    pub ld: i64,
    /// time at the start of the step
    pub t: f64,
    /// size of the step
    pub dt: f64,
    /// [dim][ld] of the nodes
    pub position: *const f64,
    /// [dim][ld] unit normal, from the first body to the second
    pub normal: *const f64,
    /// [ld] length
    pub gap: *const f64,
    /// [ld] length^(dim - 1); of MPM_AXISYMMETRIC times radius
    pub area: *const f64,
    /// [dim][ld] tangential velocity of the second body relative to the first, before the impulse
    pub slip: *const f64,
    /// [ld] normal traction of the frictionless impulse, stress
    pub pressure: *const f64,
}

/// Points whose distance from an obstacle is asked for. All is in the axes of the body, from its centre; in space these
/// are the same until it moves. Arrays belong to the library.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_distance_batch {
    /// sizeof(mpm_distance_batch) of the library; see mpm.h
    pub struct_size: u32,
    /// dimension of the grid
    pub dim: i32,
    /// number of points
    pub n: i64,
    /// distance from component c to c + 1, in elements; >= n
    pub ld: i64,
    /// time at the start of the step; in implicit steps with contact a second time that at its end, for particles and the
    /// pose of that time
    pub t: f64,
    /// [dim][ld]
    pub position: *const f64,
    /// [ld] to be set: signed distance, > 0 outside. It must be right up to two spacings, and the offset of the
    /// obstacle's rule, off the surface; farther out it may be smaller than it is, but not than that
    pub distance: *mut f64,
    /// [dim][ld] to be set: unit gradient of the distance
    pub normal: *mut f64,
    /// [dim][ld] preset to 0: of the surface there, beside the rigid motion. NULL for points at which it is not asked for
    pub velocity: *mut f64,
}

/// An obstacle. Fill it with mpm_obstacle_desc_init().
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_obstacle_desc {
    /// sizeof(mpm_obstacle_desc) of the caller
    pub struct_size: u32,
    /// an MPM_SHAPE_...; no default
    pub shape: i32,
    /// an MPM_MOTION_...; default MPM_MOTION_FIXED
    pub motion: i32,
    /// 1: the material is inside (drum, container); default 0
    pub inside: i32,
    /// see MPM_SHAPE_PLANE ..., length
    pub size: [f64; 3],
    /// of the centre, which of a free one is that of mass
    pub position: [f64; 3],
    /// unit quaternion w, x, y, z that turns axes of the body into those of space; default 1, 0, 0, 0
    pub orientation: [f64; 4],
    /// of the centre; default 0
    pub velocity: [f64; 3],
    /// in space, 1/time; in 2-D component 2; default 0
    pub angular_velocity: [f64; 3],
    /// of a free one, > 0; in 2-D per depth, in 1-D per area
    pub mass: f64,
    /// of a free one: tensor about the centre in axes of the body, row by row, symmetric and positive definite; in 2-D
    /// component 8 alone; not in 1-D
    pub inertia: [f64; 9],
    /// kind, friction, friction_static, adhesion and offset count: how it meets the material. Copied. NULL (default):
    /// those of mpm_contact_desc_init().
    pub contact: *const mpm_contact_desc,
    /// of MPM_SHAPE_DISTANCE
    pub distance: mpm_distance_fn,
    /// its first argument
    pub user: *mut c_void,
    /// of MPM_SHAPE_DISTANCE, in axes of the body from its centre: the obstacle and all
    pub lower: [f64; 3],
    /// within two spacings of it lie in this box. Equal (default): it may be anywhere
    pub upper: [f64; 3],
}

impl Default for mpm_obstacle_desc {
    /// The library's defaults: `mpm_obstacle_desc_init()`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field, and the library writes as many bytes as it is told.
        unsafe {
            let mut out: Self = std::mem::zeroed();
            let status = mpm_obstacle_desc_init(&mut out, size_of::<Self>() as u32);
            assert_eq!(status, MPM_OK, "mpm_obstacle_desc_init");
            out
        }
    }
}

/// Loads of all markers of a surface, and what it prescribes. What markers carry by themselves ("pressure", "traction",
/// "dead_traction", "prescribed_velocity") and what the callbacks give comes on top. Fill it with
/// mpm_surface_desc_init().
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_surface_desc {
    /// sizeof(mpm_surface_desc) of the caller
    pub struct_size: u32,
    /// velocity field that it loads and moves with (mpm_stepper_set_body()); default 0
    pub body: i32,
    /// force/area against the normal, on the present area: it follows the surface
    pub pressure: f64,
    /// force per present area, in a fixed direction
    pub traction: [f64; 3],
    /// force per area at the time when the marker was added: a dead load
    pub dead_traction: [f64; 3],
    /// Length > 0: markers with a longer edge are split in two at the end of a step, so that a surface that stretches has
    /// no dents. Half a spacing is right. 0 (default): they are not.
    pub max_spacing: f64,
    /// MPM_PRESCRIBES_...: what of the motion of the material the markers prescribe. Markers without area prescribe
    /// nothing. Default MPM_PRESCRIBES_NOTHING.
    pub prescribes: i32,
    /// 0
    pub reserved: i32,
    /// length/time: how the markers of a surface that prescribes move
    pub velocity: [f64; 3],
    /// implicit steps: stiffness of the springs in modulus / spacing, > 0; default 100
    pub penalty: f64,
    /// Implicit steps, force/area >= 0: the modulus of the springs. 0 (default): in each step the largest of density
    /// times wave speed squared among the particles of the body, which is lambda + 2 mu.
    pub modulus: f64,
}

impl Default for mpm_surface_desc {
    /// The library's defaults: `mpm_surface_desc_init()`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field, and the library writes as many bytes as it is told.
        unsafe {
            let mut out: Self = std::mem::zeroed();
            let status = mpm_surface_desc_init(&mut out, size_of::<Self>() as u32);
            assert_eq!(status, MPM_OK, "mpm_surface_desc_init");
            out
        }
    }
}

/// Markers for which tractions are wanted. Arrays are [components][ld], belong to the library and are valid during the
/// call.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_marker_batch {
    /// sizeof(mpm_marker_batch) of the library; see mpm.h
    pub struct_size: u32,
    /// dimension of the grid
    pub dim: i32,
    /// number of markers
    pub n: i64,
    /// distance from component c to c + 1, in elements; >= n
    pub ld: i64,
    /// time for which the value is wanted: the start of the step, or the end of an implicit one
    pub t: f64,
    /// size of the step
    pub dt: f64,
    /// [ld] ids, ascending
    pub id: *const i64,
    /// [dim][ld]
    pub position: *const f64,
    /// [dim][ld] area vectors
    pub area: *const f64,
    /// [ld] area when the marker was added
    pub reference_area: *const f64,
    /// [dim][ld] since the marker was added
    pub displacement: *const f64,
    /// [dim][ld] of the material there, in the last step
    pub velocity: *const f64,
}

/// Particles that are to be split, or pairs that are to be merged. Arrays belong to the library and are valid during the
/// call.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_adaption_batch {
    /// sizeof(mpm_adaption_batch) of the library; see mpm.h
    pub struct_size: u32,
    /// MPM_ADAPT_SPLIT or MPM_ADAPT_MERGE
    pub what: i32,
    /// how many
    pub n: i64,
    /// distance from component c to c + 1 of position, in elements; >= n
    pub ld: i64,
    /// dimension of the grid
    pub dim: i32,
    /// 0
    pub reserved: i32,
    /// [ld] ids, ascending; of pairs that of the particle that stays
    pub id: *const i64,
    /// [ld] ids of the particles that go; NULL where particles are split
    pub other: *const i64,
    /// [dim][ld] of the particle, or of the one that stays
    pub position: *const f64,
}

/// How a set adapts. Fill it with mpm_adaption_desc_init(), after which nothing is split and nothing merged. Lengths are
/// counted in cells: an edge (a, b, c) has the length |(a/h_x, b/h_y, c/h_z)|.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_adaption_desc {
    /// sizeof(mpm_adaption_desc) of the caller
    pub struct_size: u32,
    /// steps from one adaption to the next; default 10; 0: by mpm_stepper_adapt() alone
    pub every: i32,
    /// Edges of domains that are longer than this are halved. 0 (default): none are. With quadratic splines, two
    /// particles per cell and axis and a transfer that carries a matrix, 0.52 keeps material together however far it is
    /// drawn.
    pub split_edge: f64,
    /// No edge becomes shorter than this by splitting. Default 0.125.
    pub least_edge: f64,
    /// In a cell that has particles, but fewer of the set than this, they are split along their longest edges until there
    /// are so many. 0 (default): not. For fluids, whose deformation gradient has no shape.
    pub min_per_cell: i32,
    /// In a cell with more particles of the set pairs are merged until there are so many: in the order of ids, each
    /// particle with the nearest that is alike. 0 (default): none are. At least twice min_per_cell.
    pub max_per_cell: i32,
    /// Pairs lie no further apart than this. Default 0.25.
    pub merge_distance: f64,
    /// Pairs are alike when their deformation gradients differ by at most this share of the larger one, in the norm of
    /// Frobenius, their stresses by this share of density c^2, and their velocities by this share of c, the wave speed of
    /// the law; with laws of the host, stresses by this share of the larger one, and velocities are not looked at.
    /// Default 0.02.
    pub merge_tolerance: f64,
    /// Nothing is split beyond this number of particles in the set. 0 (default): there is no such bound.
    pub most_particles: i64,
    /// NULL (default): all are accepted
    pub accept: mpm_adaption_fn,
    /// is passed to accept
    pub user: *mut c_void,
}

impl Default for mpm_adaption_desc {
    /// The library's defaults: `mpm_adaption_desc_init()`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field, and the library writes as many bytes as it is told.
        unsafe {
            let mut out: Self = std::mem::zeroed();
            let status = mpm_adaption_desc_init(&mut out, size_of::<Self>() as u32);
            assert_eq!(status, MPM_OK, "mpm_adaption_desc_init");
            out
        }
    }
}

/// What adaption has done to a set, in all steps since it was first described for it or the time was set.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_adaption_info {
    /// sizeof(mpm_adaption_info) of the caller
    pub struct_size: u32,
    /// 0
    pub reserved: i32,
    /// particles that were split
    pub splits: i64,
    /// particles that came by it
    pub added: i64,
    /// pairs that became one
    pub merges: i64,
    /// kinetic energy before, less that after: >= 0 of merges; splits with a matrix < 0
    pub kinetic_loss: f64,
    /// the same of the matrices: what they give to velocities, and what is lost
    pub affine_loss: f64,
    /// the same of the strain energy, in merges; laws of the host are not counted
    pub strain_loss: f64,
    /// Angular momentum before, less that after: of merges without a matrix. 0 of MPM_AXISYMMETRIC.
    pub angular_momentum_loss: [f64; 3],
}

impl Default for mpm_adaption_info {
    /// Ready to be filled: zeros, and `struct_size`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field.
        let mut out: Self = unsafe { std::mem::zeroed() };
        out.struct_size = size_of::<Self>() as u32;
        out
    }
}

/// The heat of a set. Fill it with mpm_heat_desc_init().
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_heat_desc {
    /// sizeof(mpm_heat_desc) of the caller
    pub struct_size: u32,
    /// 0
    pub reserved: i32,
    /// energy / (mass temperature), > 0. Must be given.
    pub specific_heat: f64,
    /// power / (length temperature), >= 0. Default 0: no heat is conducted.
    pub conductivity: f64,
    /// linear, 1/temperature. Default 0. The law sees F / exp(expansion (T - T0)).
    pub expansion: f64,
    /// T0, at which F = I is free of stress. Default 0. Particles that are added have this temperature.
    pub reference_temperature: f64,
    /// Share of the work that the material dissipates which becomes heat, 0 to 1. Default 0. It is the work of the stress
    /// less the change of strain energy; it heats the particle itself, at the end of the step.
    pub dissipated_share: f64,
    /// NULL (default): there is none
    pub source: mpm_heat_fn,
    /// is passed to source
    pub user: *mut c_void,
}

impl Default for mpm_heat_desc {
    /// The library's defaults: `mpm_heat_desc_init()`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field, and the library writes as many bytes as it is told.
        unsafe {
            let mut out: Self = std::mem::zeroed();
            let status = mpm_heat_desc_init(&mut out, size_of::<Self>() as u32);
            assert_eq!(status, MPM_OK, "mpm_heat_desc_init");
            out
        }
    }
}

/// Where heat came from, in the last step and in all steps since the first set was described or the time was set: gained
/// = sum of walls + sources + surfaces + dissipated, to rounding, and with implicit conduction to the tolerance. All are
/// energies.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct mpm_heat_info {
    /// sizeof(mpm_heat_info) of the caller
    pub struct_size: u32,
    /// of the last step's conjugate gradients
    pub iterations: i32,
    /// sum of mass specific_heat temperature now, of all sets that are described
    pub heat: f64,
    /// what particles took up in the last step
    pub gained: f64,
    /// through the faces, from MPM_X_MIN, into the material
    pub walls: [f64; 6],
    /// of the callbacks
    pub sources: f64,
    /// through surfaces, into the material
    pub surfaces: f64,
    /// dissipated work that became heat
    pub dissipated: f64,
    /// the same in all steps, and so with those below
    pub gained_total: f64,
    /// through the faces
    pub walls_total: [f64; 6],
    /// of the callbacks
    pub sources_total: f64,
    /// through surfaces
    pub surfaces_total: f64,
    /// dissipated work
    pub dissipated_total: f64,
}

impl Default for mpm_heat_info {
    /// Ready to be filled: zeros, and `struct_size`.
    fn default() -> Self {
        // SAFETY: zeros are a value of every field.
        let mut out: Self = unsafe { std::mem::zeroed() };
        out.struct_size = size_of::<Self>() as u32;
        out
    }
}

extern "C" {
    /// The version of the library that runs, as 0xMMmmpp, to be compared with MPM_VERSION. May be called from any thread
    /// at any time.
    pub fn mpm_version() -> u32;

    /// The name of a status constant, such as "MPM_E_ARG", or "unknown status" for any other value. The text is static,
    /// and the pointer is never NULL. May be called from any thread at any time.
    pub fn mpm_status_name(status: mpm_status) -> *const c_char;

    /// What a status says, in a sentence without names and values: for calls that have no context to keep a text, as
    /// those on NULL. Static, and never NULL: see mpm_last_error() for more. May be called from any thread at any time.
    pub fn mpm_status_text(status: mpm_status) -> *const c_char;

    /// Gives back the memory of a view that mpm_particles_map() or mpm_grid_map() filled. Afterwards its data and owner
    /// are NULL. What the host wrote through a view with MPM_WRITE takes effect now. Memory of a view without it is not
    /// to be changed: whatever is written there harms no step beyond its numbers, and a library built with MPM_DEBUG
    /// notices.
    ///
    /// - MPM_E_ARG: view is NULL, or the host wrote values that are not finite or give det F <= 0. In the second case the
    ///   view is released all the same, and the set refuses to step (MPM_E_STATE) until the values are repaired; bad
    ///   nodal values are dropped.
    /// - MPM_E_STATE: the view is not lent, or no longer; or, with MPM_DEBUG, it was lent for reading and its memory has
    ///   changed: it is then released all the same. A view that was never filled has no context to keep a text.
    pub fn mpm_view_release(view: *mut mpm_view) -> mpm_status;

    /// Number of this part and how many there are; 0 and 1 without a transport. Pointers may be NULL.
    pub fn mpm_context_part(
        context: *const mpm_context,
        part: *mut i32,
        parts: *mut i32,
    ) -> mpm_status;

    /// Particles of a set on all parts (collective). mpm_particles_count() is that of this part.
    pub fn mpm_particles_total(particles: *const mpm_particles, n: *mut i64) -> mpm_status;

    /// Fills desc with the defaults. struct_size is sizeof(mpm_balance_desc) of the caller; no byte beyond is written.
    /// MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
    pub fn mpm_balance_desc_init(desc: *mut mpm_balance_desc, struct_size: u32) -> mpm_status;

    /// Sets how blocks are given to parts, from the next sort of particles on (collective); desc NULL: by the defaults.
    /// Results do not depend on it, bit by bit. Not part of a saved state: the host sets it again. With one part it is
    /// checked and does nothing. MPM_E_ARG: a value is out of range, or another one is given on another part.
    /// MPM_E_STATE: a step is under way. Since 0.2.0.
    pub fn mpm_stepper_set_balance(
        stepper: *mut mpm_stepper,
        desc: *const mpm_balance_desc,
    ) -> mpm_status;

    /// Tells what this part does, as of the last step; 1 in reset starts the counts anew. MPM_E_ARG: info is NULL or its
    /// struct_size is bad. With one part nothing is exchanged: all but blocks and imbalance, 1, is 0.
    pub fn mpm_stepper_parallel_info(
        stepper: *mut mpm_stepper,
        reset: i32,
        info: *mut mpm_parallel_info,
    ) -> mpm_status;

    /// Tells how many bytes mpm_particles_pack() needs for n particles of the set, with the fields that it has now.
    /// MPM_E_ARG: n is negative or beyond 2^32 - 2, or bytes is NULL. Since 0.2.0.
    pub fn mpm_particles_packed_size(
        particles: *const mpm_particles,
        n: i64,
        bytes: *mut i64,
    ) -> mpm_status;

    /// Packs n particles into a buffer, for hosts that move them themselves: between sets, programs, machines. They have
    /// every field in use, bit by bit, with ids, images and the host's fields, and what says of which law they are. The
    /// order of bytes is the same on all machines. The particles stay in the set.
    ///
    /// - ids: [n], each once, in this order; NULL for all particles by ascending id, where n is mpm_particles_count().
    /// - buffer: of `capacity` bytes, of which those of mpm_particles_packed_size() are written; anywhere.
    ///
    /// Of a problem in several parts these are particles of this part, and no other part takes part. MPM_E_NOT_FOUND: an
    /// id is not in the set. MPM_E_ARG: capacity is too small, an id is given twice, n does not match or buffer is NULL.
    /// MPM_E_STATE: a staged step is under way, a view of the set is out for writing, or a value that was written through
    /// one is bad. Since 0.2.0.
    pub fn mpm_particles_pack(
        particles: *const mpm_particles,
        n: i64,
        ids: *const i64,
        buffer: *mut c_void,
        capacity: i64,
    ) -> mpm_status;

    /// Adds packed particles to a set, bit by bit: all or none. The law is not asked: stress, state variables and volume
    /// come along. Fields that the set has and the buffer lacks have the values of new particles. Grids may have other
    /// cells and bases, if the particles lie inside.
    ///
    /// Of a problem in several parts they are added to this part, and no other part takes part; the next step brings them
    /// home. MPM_E_FORMAT: the buffer is damaged; it is of another law, or of other parameters, dimension, geometry or
    /// kind of grid, or counts images of other periods; or it has fields that the set has not: of the host, of another
    /// type, or "reference_position" and "dilation_ratio" where no stepper keeps them. MPM_E_ARG: an id is in use, or a
    /// particle lies outside the grid, which the text names; or buffer is NULL. MPM_E_STATE: as for all that changes a
    /// set. Since 0.2.0.
    pub fn mpm_particles_unpack(
        particles: *mut mpm_particles,
        buffer: *const c_void,
        bytes: i64,
    ) -> mpm_status;

    /// Fills desc with the defaults. struct_size is sizeof(mpm_context_desc) of the caller; no byte beyond is written.
    /// MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
    pub fn mpm_context_desc_init(desc: *mut mpm_context_desc, struct_size: u32) -> mpm_status;

    /// Makes a context. desc is copied and may be NULL for the defaults. *out is NULL unless MPM_OK is returned. The host
    /// ends the context with mpm_context_destroy(). There is no context to ask why a call has failed: the sentence goes
    /// to error_text, and to log with MPM_LOG_WARNING, as far as desc sets them.
    ///
    /// - MPM_E_ARG: a value is bad, only one of alloc and release or of error_text and error_bytes is set, or the
    ///   variable MPM_ISA has an unknown value.
    /// - MPM_E_NOMEM: memory or threads are not to be had.
    /// - MPM_E_UNSUPPORTED: the instruction set is not available, the build has no threads, or desc sets a field that
    ///   this version of the library does not know.
    pub fn mpm_context_create(
        desc: *const mpm_context_desc,
        out: *mut *mut mpm_context,
    ) -> mpm_status;

    /// Tells how many bytes the context and its objects hold now, and the most that they ever held. Either output pointer
    /// may be NULL. Any thread, any time while the context lives, also in callbacks.
    pub fn mpm_context_memory(
        context: *const mpm_context,
        bytes: *mut i64,
        peak_bytes: *mut i64,
    ) -> mpm_status;

    /// Ends the pool and frees the context. NULL is fine. MPM_E_STATE while objects made with it live, and in its own
    /// callbacks.
    pub fn mpm_context_destroy(context: *mut mpm_context) -> mpm_status;

    /// Gives one or two sentences, with the offending names and values, on the last call on this context or its objects
    /// that did not return MPM_OK. Calls that succeed leave them as they are, so that a host may clean up and log first
    /// and ask then; "" while no call has failed. The text belongs to the library and is valid until the next call on the
    /// context. Of NULL, and of a handle of another kind, a sentence that says so: the calls that get no further than to
    /// such a handle have no other. A context that was destroyed must not be given to this or any other call. May be
    /// called in callbacks, too, on the thread of the call.
    pub fn mpm_last_error(context: *const mpm_context) -> *const c_char;

    /// Makes text the sentence of mpm_last_error() and returns status: for libraries that stand on this one and refuse a
    /// call of their own on a context, as mpm_umat.h does. text is copied, and cut after some 1000 bytes. MPM_E_ARG:
    /// status is MPM_OK, or text is NULL; the sentence then says that.
    pub fn mpm_set_last_error(
        context: *mut mpm_context,
        status: mpm_status,
        text: *const c_char,
    ) -> mpm_status;

    /// Fills desc with the defaults; cells and spacing are 0, and the host must set them. struct_size is
    /// sizeof(mpm_grid_desc) of the caller; no byte beyond is written. MPM_E_ARG: it is smaller than the first released
    /// struct. Any thread, any time.
    pub fn mpm_grid_desc_init(desc: *mut mpm_grid_desc, struct_size: u32) -> mpm_status;

    /// Makes a grid. desc is copied. Any number of sets and steppers share the grid, which outlives them. *out is NULL
    /// unless MPM_OK is returned. MPM_E_ARG: a value is bad, or there are more nodes than 64-bit numbers can name.
    /// MPM_E_UNSUPPORTED: open knots are asked for with a basis other than MPM_BSPLINE2 and MPM_BSPLINE3;
    /// MPM_AXISYMMETRIC and MPM_PLANE_STRESS with a dim other than 2, the former with a periodic first axis.
    pub fn mpm_grid_create(
        context: *mut mpm_context,
        desc: *const mpm_grid_desc,
        out: *mut *mut mpm_grid,
    ) -> mpm_status;

    /// Frees the grid. NULL is fine. MPM_E_STATE while sets or steppers on it live.
    pub fn mpm_grid_destroy(grid: *mut mpm_grid) -> mpm_status;

    /// Makes a material from a built-in law. In the table stresses are Cauchy stresses, and J = det F.
    ///
    /// | model                   | parameters                              | law                                 |
    /// |-------------------------|-----------------------------------------|-------------------------------------|
    /// | "linear_elastic"        | E, nu, density                          | hypoelastic: with F_inc = V R,      |
    /// |                         |                                         | stress' = R stress R^T + C : ln V   |
    /// | "neo_hookean"           | E, nu, density                          | Steffen et al. 2008, eq. 46         |
    /// | "neo_hookean_decoupled" | mu, kappa, density                      | Guilkey & Weiss 2003, eq. 20        |
    /// | "j2"                    | E, nu, density, yield_stress, hardening | linear_elastic with von Mises yield |
    /// |                         |                                         | and linear isotropic hardening      |
    /// | "newtonian_fluid"       | density, bulk_modulus, gamma,           | p = bulk_modulus / gamma            |
    /// |                         | viscosity, tension                      | (J^-gamma - 1), dynamic viscosity;  |
    /// |                         |                                         | tension 0 cuts off p < 0            |
    /// | "rigid"                 | density                                 | no stress; moves as prescribed      |
    /// | "drucker_prager"        | E, nu, density, phi, psi, cohesion,     | elastic in the logarithmic strain;  |
    /// |                         | cone, tension_cutoff, hardening,        | yields at q = M p + k: sand, gravel |
    /// |                         | cohesion_residual, close_gaps           | and other soils; opens in tension   |
    /// | "mohr_coulomb"          | those of drucker_prager without cone    | the same by the planes of           |
    /// |                         |                                         | Mohr-Coulomb; phi = 0 is Tresca     |
    /// | "herschel_bulkley"      | density, bulk_modulus, gamma,           | p of newtonian_fluid; elastic in    |
    /// |                         | shear_modulus, yield_shear,             | shear up to yield_shear, then flow: |
    /// |                         | consistency, n, tension                 | + consistency (shear rate)^n        |
    /// | "snow"                  | E, nu, density, hardening,              | Stomakhin et al. 2013: elastic      |
    /// |                         | critical_compression, critical_stretch, | stretches within bounds, hardens by |
    /// |                         | hardening_max                           | compaction                          |
    /// | "mu_i"                  | E, nu, density, mu_s, mu_2, I_0,        | Jop et al. 2006: grains that flow   |
    /// |                         | grain_diameter, grain_density           | with friction mu(I); no tension     |
    /// | "cam_clay"              | density, kappa, lambda, M, mu0, alpha,  | modified Cam-clay in the logarithmic|
    /// |                         | p_ref, pc0, p_min                       | strain; needs an initial stress     |
    ///
    /// params are count pairs of name and value in any order, which are copied; parameters that are not named take their
    /// defaults. mpm_material_model_param() lists units, defaults and ranges. *out is NULL unless MPM_OK is returned.
    /// MPM_E_NOT_FOUND: there is no such model or parameter. MPM_E_ARG: a value is out of range, a name is given twice,
    /// values do not go together, or a parameter without default is missing.
    pub fn mpm_material_create(
        context: *mut mpm_context,
        model: *const c_char,
        params: *const mpm_param,
        count: i32,
        out: *mut *mut mpm_material,
    ) -> mpm_status;

    /// The number of built-in laws. Any thread, any time.
    pub fn mpm_material_model_count() -> i32;

    /// The name of the built-in law with number index, 0 <= index < mpm_material_model_count(), or NULL for another
    /// index. The text is static. Any thread, any time.
    pub fn mpm_material_model_name(index: i32) -> *const c_char;

    /// Describes the parameter with number index (from 0) of a built-in law: its name, its unit as a dimension (such as
    /// "stress"), one line of text, its default (NaN if it must be given) and its range [low, high]. Texts are static,
    /// and output pointers may be NULL. MPM_E_NOT_FOUND: there is no such model, or index is past the last parameter. Any
    /// thread, any time.
    pub fn mpm_material_model_param(
        model: *const c_char,
        index: i32,
        name: *mut *const c_char,
        unit: *mut *const c_char,
        text: *mut *const c_char,
        value_default: *mut f64,
        low: *mut f64,
        high: *mut f64,
    ) -> mpm_status;

    /// The number of state variables of a particle of a built-in law, or -1 where there is no such model. They are the
    /// components of the field "state". Any thread, any time.
    pub fn mpm_material_state_count(model: *const c_char) -> i32;

    /// Describes the state variable with number index (from 0) of a built-in law: its name, such as "plastic_strain", its
    /// unit as a dimension and one line of text. Texts are static, and output pointers may be NULL. MPM_E_NOT_FOUND:
    /// there is no such model, or index is past the last variable. Any thread, any time.
    pub fn mpm_material_state_name(
        model: *const c_char,
        index: i32,
        name: *mut *const c_char,
        unit: *mut *const c_char,
        text: *mut *const c_char,
    ) -> mpm_status;

    /// Lends a field of the set that a batch belongs to, built in or the host's own. It is aligned with the batch and
    /// valid during the callback: component c of item i is (*data)[c * *component_stride + i], in elements of the field's
    /// type. Nothing is copied, so tensors have their stored components, as in views. lookup is that of the batch. May be
    /// called from any thread on which a callback runs. MPM_E_NOT_FOUND: there is no such field. MPM_E_STATE: the field
    /// is optional, and the set does not have it now.
    pub fn mpm_batch_field(
        lookup: *const c_void,
        field: *const c_char,
        data: *mut *const c_void,
        component_stride: *mut i64,
    ) -> mpm_status;

    /// Fills desc with the defaults; the host must set density and stress. struct_size is sizeof(mpm_material_desc) of
    /// the caller; no byte beyond is written. MPM_E_ARG: it is smaller than the first released struct. Any thread, any
    /// time.
    pub fn mpm_material_desc_init(desc: *mut mpm_material_desc, struct_size: u32) -> mpm_status;

    /// Makes a material from a law of the host. desc is copied. *out is NULL unless MPM_OK is returned. MPM_E_ARG: a
    /// value is bad, or stress is NULL.
    pub fn mpm_material_create_custom(
        context: *mut mpm_context,
        desc: *const mpm_material_desc,
        out: *mut *mut mpm_material,
    ) -> mpm_status;

    /// Runs a material, built in or the host's, without a grid: what a step does to its particles, for n items of the
    /// caller. It is how parameters are fitted to tests of the laboratory.
    ///
    /// The caller fills batch: struct_size, state_count (that of the material), n, ld, t, dt, F (at the end of the step),
    /// F_inc, stress and state before the step, and the arrays for stress_new and state_new, all in the forms of
    /// mpm_material_batch. These may be NULL: id (items then have ids from 0; items with ids < 0 are inert, and what
    /// their outputs hold is not said), L (made of F_inc and dt; what is given must be (F_inc - I) / dt), position
    /// ([3][ld]; zeros), wave_speed, kinematic_viscosity and energy (not wanted), state and state_new of a law without
    /// state. lookup is not used: a law of the host gets NULL. Outputs may be the arrays of inputs: stress_new that of
    /// stress, say. With dt = 0 the answer is the state as it is, see mpm_stress_fn, whatever F_inc and L are.
    ///
    /// tangent is NULL or [81][ld], and receives the tangent of the step in the general form of mpm_tangent_fn; dt must
    /// be > 0 then. Into *symmetric goes 1 if it has major symmetry at every item, else 0; it may be NULL, and is left
    /// alone without a tangent.
    ///
    /// Bits are those of a 3-D step on the same instruction set. The calling thread does all the work, as for other calls
    /// of the context. MPM_E_ARG: an array is NULL, a number is out of range, or L and F_inc disagree. MPM_NONFINITE: a
    /// value that is given or that comes out is not finite. MPM_INVERTED: det F or det F_inc is not positive. MPM_CUT_DT
    /// and MPM_E_CALLBACK: as in a step. What is wrong with an item names it, what a law returned the items that it was
    /// asked about. After a failure items before these may have been written.
    pub fn mpm_material_update(
        material: *const mpm_material,
        batch: *const mpm_material_batch,
        tangent: *mut f64,
        symmetric: *mut i32,
    ) -> mpm_status;

    /// Frees the material and calls release_user. NULL is fine. MPM_E_STATE while sets of it live.
    pub fn mpm_material_destroy(material: *mut mpm_material) -> mpm_status;

    /// Makes an empty set on a grid, of one material; both outlive it. *out is NULL unless MPM_OK is returned. MPM_E_ARG:
    /// grid or material are of another context. MPM_E_UNSUPPORTED: a fluid on an MPM_CPGIMP grid; a fluid, snow, clay or
    /// mu_i on an MPM_PLANE_STRESS grid; a fluid where total_lagrangian = 1.
    pub fn mpm_particles_create(
        context: *mut mpm_context,
        grid: *mut mpm_grid,
        material: *mut mpm_material,
        out: *mut *mut mpm_particles,
    ) -> mpm_status;

    /// Frees the set. NULL is fine. MPM_E_STATE while a stepper holds it or a view of it is out.
    pub fn mpm_particles_destroy(particles: *mut mpm_particles) -> mpm_status;

    /// Adds n particles with F = I, zero stress and the law's initial state: all or none. The arrays are copied;
    /// position, velocity and size are [dim][n] with ld = n.
    ///
    /// - position: a length, inside the grid; on a periodic axis one outside is wrapped, and its images are counted. With
    ///   total_lagrangian = 1 the wrapped place is that in the grid, "reference_position" and "position" alike.
    /// - velocity: length/time; NULL for zeros.
    /// - volume: [n] initial volume, of the undeformed material, > 0; mass = density * volume.
    /// - size: full initial edge lengths of the domain, > 0; NULL for a cube (2-D: square) of that volume. MPM_GIMP and
    ///   MPM_CPGIMP use it; on other grids it is kept as given.
    /// - ids: [n] the host's own ids, >= 0 and unique in the set; NULL to number on from the largest so far. A set holds
    ///   fewer than 2^32 particles.
    /// - first_id: the first of the ids is written to it; may be NULL.
    ///
    /// MPM_E_ARG: a value is not finite, a position is outside the grid, a volume or size is <= 0, or an id is negative
    /// or in use.
    pub fn mpm_particles_add(
        particles: *mut mpm_particles,
        n: i64,
        position: *const f64,
        velocity: *const f64,
        volume: *const f64,
        size: *const f64,
        ids: *const i64,
        first_id: *mut i64,
    ) -> mpm_status;

    /// Fills the box from lower[dim] to upper[dim] with particles at rest on a lattice aligned with the cells, with
    /// per_cell[dim] particles along each axis of a cell, wherever the centre is inside. Each has the volume and the size
    /// of one lattice cell, so that domains of GIMP fill the body. The ids of the new particles are *first_id to
    /// *first_id + *count - 1; both pointers may be NULL.
    ///
    /// What a shape has beyond the grid is left out, on periodic axes too, as symmetry planes want it: *count tells how
    /// many particles there are. That holds for all fills. per_cell is 1 to 64, and a box has at most 2^32 lattice
    /// points, in the shape or not.
    ///
    /// MPM_E_ARG: a bound is not finite, lower >= upper on an axis, the box does not meet the grid, or a limit is
    /// exceeded.
    pub fn mpm_particles_fill_box(
        particles: *mut mpm_particles,
        lower: *const f64,
        upper: *const f64,
        per_cell: *const i32,
        first_id: *mut i64,
        count: *mut i64,
    ) -> mpm_status;

    /// Fills a ball (2-D: disc, 1-D: interval) around centre[dim] of a radius > 0, as mpm_particles_fill_box() fills a
    /// box. The centre lies in the grid.
    pub fn mpm_particles_fill_ball(
        particles: *mut mpm_particles,
        centre: *const f64,
        radius: f64,
        per_cell: *const i32,
        first_id: *mut i64,
        count: *mut i64,
    ) -> mpm_status;

    /// Fills that part of a box which the callback accepts, as mpm_particles_fill_box() fills the whole.
    pub fn mpm_particles_fill(
        particles: *mut mpm_particles,
        lower: *const f64,
        upper: *const f64,
        per_cell: *const i32,
        inside: mpm_inside_fn,
        user: *mut c_void,
        first_id: *mut i64,
        count: *mut i64,
    ) -> mpm_status;

    /// Fills what a mesh encloses, as mpm_particles_fill_box() fills a box: triangles in 3-D, edges in 2-D.
    ///
    /// - position: [dim][n] of the points; n is 1 to 2^31 - 1.
    /// - corner: corner[dim * i + j] is the number of corner j of element i, of `elements`, 1 to 2^31 - 1. In 3-D the
    ///   corners go counter-clockwise as seen from outside, in 2-D the outline goes counter-clockwise round the body. A
    ///   mesh that is turned inside out encloses the same. Shells within that are turned the other way bound cavities.
    /// - Points with the same coordinates are one point, so that triangles as files hold them need no sorting out.
    ///
    /// A particle comes wherever the generalised winding number is above 1/2 or below -1/2 (Jacobson, Kavan &
    /// Sorkine-Hornung 2013, Robust inside-outside segmentation using generalized winding numbers, ACM Trans. Graph.
    /// 32(4), 33). Bodies that overlap are filled once. Holes do no harm as long as they are small beside the body, but a
    /// mesh without any costs far less time. A lattice point on the mesh itself may be in or out. The mesh is read during
    /// the call only.
    ///
    /// MPM_E_ARG: a position is not finite, a corner does not exist, the mesh is flat or does not meet the grid, or a
    /// limit is exceeded. MPM_E_UNSUPPORTED: the grid is 1-D. Nothing is then added.
    pub fn mpm_particles_fill_mesh(
        particles: *mut mpm_particles,
        n: i64,
        position: *const f64,
        elements: i64,
        corner: *const i64,
        per_cell: *const i32,
        first_id: *mut i64,
        count: *mut i64,
    ) -> mpm_status;

    /// Removes the n particles with the given ids: all or none. MPM_E_NOT_FOUND: an id is not in the set. MPM_E_ARG: an
    /// id is given twice.
    pub fn mpm_particles_remove(
        particles: *mut mpm_particles,
        n: i64,
        ids: *const i64,
    ) -> mpm_status;

    /// The number of particles, inert slots not counted; 0 for NULL.
    pub fn mpm_particles_count(particles: *const mpm_particles) -> i64;

    /// Describes the field with number index (from 0): its name, its type (MPM_F64, MPM_I64 or MPM_U8), the components of
    /// copies, and whether the host may write it. The name belongs to the library and is valid while the set lives;
    /// output pointers may be NULL. MPM_E_NOT_FOUND: index is past the last field.
    pub fn mpm_particles_field_info(
        particles: *const mpm_particles,
        index: i32,
        field: *mut *const c_char,
        r#type: *mut i32,
        components: *mut i32,
        writable: *mut i32,
    ) -> mpm_status;

    /// Adds a field of the host, zero in every particle. It travels with the particles, is saved with them, and reaches
    /// callbacks through mpm_batch_field(). The name has 1 to 47 characters of a-z, 0-9 and _; type is MPM_F64, MPM_I64
    /// or MPM_U8; components are 1 to 64. A set has at most 64 fields, the 17 of the table included. MPM_E_ARG: the name
    /// is bad or taken, or a value is. MPM_E_STATE: there is no room for one more.
    pub fn mpm_particles_add_field(
        particles: *mut mpm_particles,
        field: *const c_char,
        r#type: i32,
        components: i32,
    ) -> mpm_status;

    /// Says of a field of the host that its values are amounts, as mass is, and not densities: particles that are split
    /// share them, and merged ones have the sum. Of other fields they have the same value, and merged ones the mean by
    /// initial volume. The field is of type MPM_F64; values of other types are those of the heavier particle. extensive
    /// is 0 (as added) or 1. MPM_E_NOT_FOUND: there is no such field. MPM_E_ARG: the field is not the host's, or of
    /// another type. MPM_E_STATE: as for all that changes a set.
    pub fn mpm_particles_set_extensive(
        particles: *mut mpm_particles,
        field: *const c_char,
        extensive: i32,
    ) -> mpm_status;

    /// Lends a field in library order, with its stored components and with inert slots (id < 0); a map of "id" tells
    /// which is which. access is MPM_READ, MPM_WRITE or both. The caller sets the view's struct_size. Until
    /// mpm_view_release() steps return MPM_E_STATE. Of a set at most 64 views are out at once. A view without MPM_WRITE
    /// is for reading: see mpm_view_release() for what becomes of changes. MPM_E_NOT_FOUND: there is no such field.
    /// MPM_E_ARG: MPM_WRITE is asked for on a field that is not writable. MPM_E_STATE: 64 views are out.
    pub fn mpm_particles_map(
        particles: *mut mpm_particles,
        field: *const c_char,
        access: i32,
        view: *mut mpm_view,
    ) -> mpm_status;

    /// Copies a field of n particles into out, [components][n] with ld = n; tensors are full. ids are [n], or NULL for
    /// all particles by ascending id, where n is mpm_particles_count(). type and components must match the full field, to
    /// guard the host's buffer. MPM_E_NOT_FOUND: there is no such field or id. MPM_E_ARG: type, components or n do not
    /// match.
    pub fn mpm_particles_get(
        particles: *const mpm_particles,
        field: *const c_char,
        r#type: i32,
        components: i32,
        n: i64,
        ids: *const i64,
        out: *mut c_void,
    ) -> mpm_status;

    /// Copies count named fields of all particles into floats for renderers: particles one after the other, without inert
    /// slots, of each the components of the first field, then those of the second, and so on. Components are those of
    /// mpm_particles_get(), with full tensors and dim components per vector, and out has n times the sum of them.
    ///
    /// - order: MPM_BY_ID, or MPM_LIBRARY_ORDER, which is faster: it reads memory from front to back and needs no index
    ///   of the ids. In it a particle may have another place after each step; the field "id" tells them apart.
    /// - n: mpm_particles_count(), to guard the host's buffer.
    ///
    /// Values are rounded to the nearest float. Those that no float can hold become infinities with their sign (from
    /// about 3.4e38 on), those below the smallest float (1.4e-45) become 0. Integers are exact up to 2^24 = 16777216.
    ///
    /// MPM_E_NOT_FOUND: there is no such field. MPM_E_ARG: count is < 1, a field is named twice, or order or n is none of
    /// these. Else as mpm_particles_get(); views may be out. Since 0.2.0.
    pub fn mpm_particles_get_f32(
        particles: *const mpm_particles,
        count: i32,
        fields: *const *const c_char,
        order: i32,
        n: i64,
        out: *mut f32,
    ) -> mpm_status;

    /// Copies values into a field, laid out as in mpm_particles_get(): all or none. Errors are those of
    /// mpm_particles_get(), and MPM_E_ARG: a value is not finite or gives det F <= 0, a position is outside the grid, or
    /// the field is not writable.
    pub fn mpm_particles_set(
        particles: *mut mpm_particles,
        field: *const c_char,
        r#type: i32,
        components: i32,
        n: i64,
        ids: *const i64,
        values: *const c_void,
    ) -> mpm_status;

    /// Sets a field to one value[components] in every particle of the set. Errors are those of mpm_particles_set().
    pub fn mpm_particles_set_all(
        particles: *mut mpm_particles,
        field: *const c_char,
        r#type: i32,
        components: i32,
        value: *const c_void,
    ) -> mpm_status;

    /// Gives all particles the stress of ground at rest below a level surface: along `axis` the pressure of the weight
    /// above, surcharge + density * |gravity| * depth with the material's density, and K0 times that across it; no shear.
    /// Each layer is a set, whose surface is its top and whose surcharge the weight of what lies on it.
    ///
    /// - gravity: acceleration along the axis, length/time^2, with its sign, as in mpm_stepper_desc: with a negative one
    ///   the ground lies below the surface in the sense of falling coordinates. Not 0.
    /// - surface: coordinate of the surface on the axis, a length. No particle may lie above it.
    /// - K0: horizontal over vertical stress, >= 0: nu / (1 - nu) is what an elastic column has that was never strained
    ///   across, 1 - sin(phi) what sand has. One that a law cannot bear is no error: its first step returns the stress to
    ///   the yield surface.
    /// - surcharge: pressure on the surface, a stress >= 0. It must also be applied, or the ground heaves.
    ///
    /// Positions, velocities, masses, state variables and present volumes stay. Where stress is the state of the law,
    /// deformation_gradient becomes I and initial_volume the present volume. Where stress follows from
    /// deformation_gradient, that becomes the diagonal one that has the stress, up to rounding, and initial_volume the
    /// present volume over its determinant; in 1-D, where nothing is stored across, the stress across is then that of the
    /// law, whatever K0 is. herschel_bulkley gets the mean of the stress so, and its deviator as it is given.
    /// dilation_ratio becomes 1, and with MPM_CPGIMP the field "size" what keeps the domains as they are.
    ///
    /// The set is unchanged on failure. MPM_E_ARG: a value is bad or not finite, the axis is periodic, a particle lies
    /// above the surface, or no deformation has the stress; the particle is named. MPM_E_UNSUPPORTED: the law is "rigid",
    /// or "snow", whose stress takes more than a deformation; it is "newtonian_fluid" and K0 is not 1; or, of the host's
    /// laws, one that asked with dt = 0 does not answer with the stress that it has; the grid is MPM_PLANE_STRESS, or
    /// axis the radius of MPM_AXISYMMETRIC; total_lagrangian = 1 and the stress follows from deformation_gradient, or the
    /// ground has already deformed. MPM_E_CALLBACK: that law failed. MPM_E_STATE: as for all that changes a set. Since
    /// 0.2.0.
    pub fn mpm_particles_set_geostatic(
        particles: *mut mpm_particles,
        axis: i32,
        gravity: f64,
        surface: f64,
        K0: f64,
        surcharge: f64,
    ) -> mpm_status;

    /// Makes the present state the one from which all deformation counts: deformation_gradient becomes I, initial_volume
    /// the present volume, dilation_ratio 1, and reference_position, where there is one, the present (unwrapped)
    /// position. With MPM_CPGIMP and of MPM_AXISYMMETRIC edges in "size" become the present ones. Of MPM_PLANE_STRESS F33
    /// stays. Mass, velocity, Cauchy stress and state variables stay. With total_lagrangian = 1 particles are then in the
    /// grid where they are now, and velocity_gradient is over these positions.
    ///
    /// Laws that store Cauchy stress and work with tau = J stress (drucker_prager, mohr_coulomb, mu_i, cam_clay) find J =
    /// 1 from then on: elastic strain, energy per initial volume and cohesion count by the present volume, which differ
    /// by the factor J from before; a stress on the yield surface may lie off it by as much, and the next step returns
    /// it.
    ///
    /// The set is unchanged on failure. MPM_E_ARG: total_lagrangian = 1 and a particle is outside the box.
    /// MPM_E_UNSUPPORTED: the stress of the law, or its mean, follows from deformation_gradient, which must stay; or a
    /// law of the host, asked with dt = 0, does not answer with the stress that it has. MPM_E_CALLBACK: that law failed.
    /// MPM_E_STATE: as for all that changes a set, and with total_lagrangian = 1 while a surface of its stepper has
    /// markers, whose places count from the old reference. Since 0.2.0.
    pub fn mpm_particles_reset_reference(particles: *mut mpm_particles) -> mpm_status;

    /// Describes the system. This call and the two below may be made from within the solve callback only, one at a time;
    /// at other times they return MPM_E_STATE. It waits for no other part. MPM_E_UNSUPPORTED: there are several parts,
    /// and struct_size is that of a release without number.
    pub fn mpm_operator_get_info(
        matrix: *const mpm_operator,
        info: *mut mpm_operator_info,
    ) -> mpm_status;

    /// Computes y = matrix * x on owned rows. Both vectors have owned_rows entries and do not overlap.
    ///
    /// With several parts it is (collective): x of rows that others own comes from them. It fails on all parts that make
    /// it when one is refused, and with MPM_E_STATE when the solver has returned on a part, so that nobody waits.
    pub fn mpm_operator_apply(
        matrix: *const mpm_operator,
        x: *const f64,
        y: *mut f64,
    ) -> mpm_status;

    /// Lends the matrix by compressed rows, with both triangles and with columns in ascending order: row r has the
    /// entries (*row_start)[r] to (*row_start)[r + 1] - 1 of *column and *value. Columns are local ones, and number of
    /// mpm_operator_info has those over all parts; rows that others own are empty. The arrays belong to the library and
    /// are valid until the solve callback returns. It waits for no other part. MPM_E_NOMEM: there is no memory for them.
    pub fn mpm_operator_csr(
        matrix: *const mpm_operator,
        row_start: *mut *const i64,
        column: *mut *const i32,
        value: *mut *const f64,
    ) -> mpm_status;

    /// Fills desc with the defaults. struct_size is sizeof(mpm_stepper_desc) of the caller; no byte beyond is written.
    /// MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
    pub fn mpm_stepper_desc_init(desc: *mut mpm_stepper_desc, struct_size: u32) -> mpm_status;

    /// Makes a stepper at t = 0 and step 0, without sets, with MPM_WALL_NONE on all faces (the axis of MPM_AXISYMMETRIC
    /// has MPM_WALL_SLIP). desc is copied and may be NULL for the defaults. The grid outlives the stepper. *out is NULL
    /// unless MPM_OK is returned. MPM_E_ARG: a value is bad, or the grid is of another context. MPM_E_UNSUPPORTED: the
    /// combination is not offered; the error text says what to use instead.
    pub fn mpm_stepper_create(
        context: *mut mpm_context,
        grid: *mut mpm_grid,
        desc: *const mpm_stepper_desc,
        out: *mut *mut mpm_stepper,
    ) -> mpm_status;

    /// Frees the stepper. Its sets live on and are free for another. NULL is fine. MPM_E_STATE while a view of its nodal
    /// fields is out or a staged step is under way.
    pub fn mpm_stepper_destroy(stepper: *mut mpm_stepper) -> mpm_status;

    /// Adds a set to the time loop. The host keeps owning it, and cannot destroy it while it is in. All sets of a body
    /// share one velocity field; this one comes into body 0. MPM_E_STATE: the set is in a stepper already. MPM_E_ARG: it
    /// is on another grid.
    pub fn mpm_stepper_add(stepper: *mut mpm_stepper, particles: *mut mpm_particles) -> mpm_status;

    /// Takes a set out of the time loop. MPM_E_NOT_FOUND: it is not in this stepper.
    pub fn mpm_stepper_remove(
        stepper: *mut mpm_stepper,
        particles: *mut mpm_particles,
    ) -> mpm_status;

    /// Replaces the options between steps. Any field may change, the scheme too; desc is copied. Errors are those of
    /// mpm_stepper_create(), and MPM_E_STATE during a staged step.
    pub fn mpm_stepper_configure(
        stepper: *mut mpm_stepper,
        desc: *const mpm_stepper_desc,
    ) -> mpm_status;

    /// Sets the time and the number of steps counted. Sums over steps (mpm_stepper_wall_impulse(),
    /// mpm_stepper_particles_impulse(), external_work_total) start anew from 0. MPM_E_ARG: t is not finite, or step < 0.
    pub fn mpm_stepper_set_time(stepper: *mut mpm_stepper, t: f64, step: i64) -> mpm_status;

    /// Moves the prescribed particles of a set (platens, pistons). mean_velocity (mt) is called at the start of a step
    /// for the particles of the set, unless none is prescribed, and adds the mean velocity u of the coming step to zeros;
    /// what it gives to other particles is ignored. NULL takes the callback away: the particles keep their velocity.
    ///
    /// On its prescribed axes a particle moves by dt u and ends with the velocity u, with every transfer; the nodes to
    /// which it gives mass move with u too, or with the mean of several by that mass. On other axes, and in deformation
    /// and stress, it is a particle like others. MPM_NONFINITE names the particle. A state does not hold the callback:
    /// after one has been loaded that had it, no step is made (MPM_E_STATE) until it has been set, before loading or
    /// after, or answered by NULL after it. MPM_E_NOT_FOUND: the set is not in this stepper.
    pub fn mpm_stepper_set_motion(
        stepper: *mut mpm_stepper,
        particles: *mut mpm_particles,
        mean_velocity: mpm_particle_fn,
        user: *mut c_void,
    ) -> mpm_status;

    /// Sets what a face (MPM_X_MIN to MPM_Z_MAX) does: kind is one of MPM_WALL_NONE to MPM_WALL_FRICTION_NODES. friction
    /// is the Coulomb coefficient, >= 0, of the last two, and is not used otherwise. Such a wall is unilateral: its
    /// normal impulse only pushes, and its tangential impulse is at most friction times that; but for a node that parts
    /// and touches again and again in the iterations of an implicit step, which is then held in it and may be pulled.
    /// MPM_E_ARG: the grid does not have the face, the face is periodic, or a value is bad. MPM_E_UNSUPPORTED:
    /// MPM_WALL_FRICTION_NODES with MPM_NEWMARK; MPM_WALL_OPEN with total_lagrangian = 1; on the axis of MPM_AXISYMMETRIC
    /// another kind than MPM_WALL_SLIP.
    pub fn mpm_stepper_set_wall(
        stepper: *mut mpm_stepper,
        face: i32,
        kind: i32,
        friction: f64,
    ) -> mpm_status;

    /// Sets the callback that adds accelerations of particles, length/time^2 (b of MPoint theory, eq. 21). It is called
    /// for every set. NULL takes it away.
    pub fn mpm_stepper_set_acceleration(
        stepper: *mut mpm_stepper,
        r#fn: mpm_particle_fn,
        user: *mut c_void,
    ) -> mpm_status;

    /// Sets the callback that adds forces on particles, mass length/time^2 (f^app of MPoint theory, eq. 21). It is called
    /// for every set. NULL takes it away.
    pub fn mpm_stepper_set_force(
        stepper: *mut mpm_stepper,
        r#fn: mpm_particle_fn,
        user: *mut c_void,
    ) -> mpm_status;

    /// Sets the callback that prescribes nodal velocities, length/time. NULL takes it away.
    pub fn mpm_stepper_set_velocity_bc(
        stepper: *mut mpm_stepper,
        r#fn: mpm_velocity_fn,
        user: *mut c_void,
    ) -> mpm_status;

    /// Sets the hook of a stage, one of MPM_AFTER_P2G to MPM_AFTER_VELOCITY. NULL takes it away. In a step in parts all
    /// hooks run in mpm_step_grid(), after what the host has written itself. MPM_E_ARG: there is no such stage.
    /// MPM_E_UNSUPPORTED with MPM_NEWMARK.
    pub fn mpm_stepper_set_node_hook(
        stepper: *mut mpm_stepper,
        stage: i32,
        r#fn: mpm_node_fn,
        user: *mut c_void,
    ) -> mpm_status;

    /// Sets the solver of MPM_SOLVER_HOST: see operator.h. NULL takes it away.
    pub fn mpm_stepper_set_linear_solver(
        stepper: *mut mpm_stepper,
        r#fn: mpm_solve_fn,
        user: *mut c_void,
    ) -> mpm_status;

    /// Sets the progress callback, which runs on the calling thread. NULL takes it away.
    pub fn mpm_stepper_set_progress(
        stepper: *mut mpm_stepper,
        r#fn: mpm_progress_fn,
        user: *mut c_void,
    ) -> mpm_status;

    /// Gives the stable dt of an explicit step from the present state, at CFL number 1 (MPoint theory, eqs 45-46): 1 /
    /// max over particles and axes of (|v_k| + c) / h_k, where c is the law's current wave speed, and at most h^2 / (2
    /// dim nu) where a law reports a kinematic viscosity nu; h is the smallest spacing. Explicit steps want a share of
    /// it. It is infinite where nothing moves and no law has waves. Obstacles that move count by the speed of their
    /// fastest point. The call runs the laws. MPM_E_STATE: there are no particles, or a view is out.
    pub fn mpm_stable_dt(stepper: *mut mpm_stepper, dt: *mut f64) -> mpm_status;

    /// Makes one step of size dt > 0. After any status but MPM_OK particles and time are bit-identical to before. info
    /// may be NULL; it is filled on success and on failure.
    ///
    /// - MPM_CUT_DT, MPM_INVERTED, MPM_NONFINITE, MPM_NOT_CONVERGED, MPM_SINGULAR: a smaller dt may do.
    /// - MPM_OFF_GRID: a particle would leave through a face that does not let it. In implicit steps a smaller dt may do
    ///   here as well.
    /// - MPM_CANCELLED: the progress callback ended the step.
    /// - MPM_E_ARG: dt is not finite or not > 0.
    /// - MPM_E_CALLBACK: a callback or the host's executor failed.
    /// - MPM_E_STATE: a view is out, a staged step is under way, a set has values to be repaired, or the state that was
    ///   loaded had a motion callback that is not set.
    pub fn mpm_step(stepper: *mut mpm_stepper, dt: f64, info: *mut mpm_step_info) -> mpm_status;

    /// Fills desc with the defaults; the host must set t_end. struct_size is sizeof(mpm_advance_desc) of the caller; no
    /// byte beyond is written. MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
    pub fn mpm_advance_desc_init(desc: *mut mpm_advance_desc, struct_size: u32) -> mpm_status;

    /// Steps to t_end exactly. Statuses 1..5 cut dt to 0.6 of it and try again, and success lets it grow; the
    /// controller's dt is part of the saved state. In implicit steps MPM_OFF_GRID cuts as well, but no more than 20 times
    /// before the time comes to where one of these steps would have ended: a body that moves out by itself does so in
    /// steps of any length. On failure the state is that of the last committed sub-step, and the status is the cause.
    /// After max_cuts cuts in a row (60: dt is 5e-14 of what it was), or where another would go below dt_min or no longer
    /// move the time, the call gives up, and mpm_last_error() says so and why the last try failed; the next call begins
    /// with the dt of before the cuts. info may be NULL; it is that of the last sub-step tried. The call returns MPM_OK
    /// with t < t_end when max_steps ran out. Errors are those of mpm_step(); MPM_E_ARG: t_end is before the present
    /// time, or a value is bad.
    pub fn mpm_advance(
        stepper: *mut mpm_stepper,
        desc: *const mpm_advance_desc,
        info: *mut mpm_step_info,
    ) -> mpm_status;

    /// Copies the times into out, then sets them to zero if reset is not 0. They cost the steps one clock read per stage.
    pub fn mpm_stepper_profile(
        stepper: *mut mpm_stepper,
        reset: i32,
        out: *mut mpm_profile,
    ) -> mpm_status;

    /// Gives the info of the state as it is, also before the first step. What belongs to a step is that of the last one.
    /// MPM_E_STATE while a set is mapped for writing.
    pub fn mpm_stepper_info(stepper: *const mpm_stepper, info: *mut mpm_step_info) -> mpm_status;

    /// Gives the history of the last implicit step: ||residual|| / scale (the scale includes reactions) from before the
    /// first solve to the converged or failed end. *count tells how many values there are; the first capacity of them are
    /// copied into residual, which may be NULL when capacity is 0. The history is kept until the next step; *count is 0
    /// after explicit ones.
    pub fn mpm_stepper_residuals(
        stepper: *const mpm_stepper,
        capacity: i32,
        residual: *mut f64,
        count: *mut i32,
    ) -> mpm_status;

    /// Makes the first part of an explicit step in parts: particles to grid, and forces. With MPM_USF strain and stress
    /// of the step come before them, for which the callbacks of prescribed velocities are asked here. Until
    /// mpm_step_end() or mpm_step_abort() the host may map nodal fields between the parts, and change "velocity" and
    /// "force". Errors are those of mpm_step(), and MPM_E_UNSUPPORTED with MPM_NEWMARK. A part that fails with any status
    /// but MPM_E_STATE or MPM_E_ARG aborts the step.
    pub fn mpm_step_begin(stepper: *mut mpm_stepper, dt: f64) -> mpm_status;

    /// Makes the second part: nodal velocities, walls, prescribed velocities. MPM_E_STATE unless it follows
    /// mpm_step_begin().
    pub fn mpm_step_grid(stepper: *mut mpm_stepper) -> mpm_status;

    /// Makes the last part: grid to particles, stress, commit. info may be NULL. MPM_E_STATE unless it follows
    /// mpm_step_grid(). The three parts in a row give the same bits as mpm_step(), except with MPM_APIC_MLS, where a
    /// whole step fuses force and momentum: there they agree to rounding.
    pub fn mpm_step_end(stepper: *mut mpm_stepper, info: *mut mpm_step_info) -> mpm_status;

    /// Drops the step that was begun; particles and time are as before it. MPM_E_STATE: none was begun, or a view of
    /// nodal fields is out.
    pub fn mpm_step_abort(stepper: *mut mpm_stepper) -> mpm_status;

    /// Lends a field of the active nodes: of a staged step while one is under way, of the last step otherwise. The view's
    /// struct_size is set by the caller. Until mpm_view_release() steps and their parts return MPM_E_STATE. Periodic
    /// images and mirrored ghosts are listed beside the nodes that they follow.
    ///
    /// | field                              | type | components | what it is                                    |
    /// |------------------------------------|------|------------|-----------------------------------------------|
    /// | "index"                            | I64  | dim        | as in mpm_node_batch                          |
    /// | "mass"                             | F64  | 1          | nodal mass                                    |
    /// | "position" "velocity"              | F64  | dim        | length, length/time                           |
    /// | "force" "acceleration"             | F64  | dim        | internal and external force; length/time^2    |
    /// | "reaction"                         | F64  | dim        | force of walls and prescribed velocities      |
    /// | "contact_force"                    | F64  | dim        | force of other bodies and of obstacles        |
    /// | "contact_normal"                   | F64  | dim        | unit, away from the body, where it meets them |
    /// | "contact_gap" "contact_area"       | F64  | 1          | length, infinite where it meets nothing       |
    /// | "temperature"                      | F64  | 1          | at the end of the step, where sets have heat  |
    /// | "owned"                            | U8   | 1          | as in mpm_node_batch                          |
    ///
    /// - body: velocity field, of which there is one for each body (mpm_stepper_set_body()).
    /// - MPM_E_STATE: nothing has been stepped yet, or MPM_WRITE is asked for outside a staged step.
    /// - MPM_E_NOT_FOUND: there is no such field or body.
    /// - MPM_E_ARG: MPM_WRITE is asked for on a field other than "velocity" and "force".
    /// - MPM_E_UNSUPPORTED: "force" or "acceleration" after a whole step of MPM_APIC_MLS, which does not keep them; a
    ///   staged step and MPM_APIC do.
    pub fn mpm_grid_map(
        stepper: *mut mpm_stepper,
        body: i32,
        field: *const c_char,
        access: i32,
        view: *mut mpm_view,
    ) -> mpm_status;

    /// Gives the force[dim] that the wall at a face exerts on the material: the mean over the last step, or with
    /// MPM_NEWMARK the one at its end, but for friction walls. MPM_E_ARG: there is no such face. MPM_E_STATE before the
    /// first step.
    pub fn mpm_stepper_wall_reaction(
        stepper: *const mpm_stepper,
        face: i32,
        force: *mut f64,
    ) -> mpm_status;

    /// Gives the force[dim] that the prescribed particles of a set exert on the material, on the axes on which they are
    /// prescribed: the mean over the last step, or with MPM_NEWMARK the one at its end. It is what holds them, less their
    /// own inertia, weight and external forces; 0 for a set without such particles. What a body of its own gives others
    /// through contact is not in it: mpm_stepper_contact_info() has that. MPM_E_NOT_FOUND: the set is not in this
    /// stepper. MPM_E_STATE before the first step.
    pub fn mpm_stepper_particles_reaction(
        stepper: *const mpm_stepper,
        prescribed: *const mpm_particles,
        force: *mut f64,
    ) -> mpm_status;

    /// Gives the impulse[dim] of the wall at a face on the material, mass * length/time: the sum of
    /// mpm_stepper_wall_reaction() times the time over which it acted, over all committed steps since the stepper was
    /// made or mpm_stepper_set_time() was called; 0 before the first. A host that uses mpm_advance() measures forces by
    /// it: the difference of two calls over the time between them is the mean force. With MPM_NEWMARK a step adds dt
    /// times the force at its end, and with `staggered` the mean of two dt times its force. Steps that fail add nothing,
    /// and a saved state holds it. MPM_E_ARG: there is no such face.
    pub fn mpm_stepper_wall_impulse(
        stepper: *const mpm_stepper,
        face: i32,
        impulse: *mut f64,
    ) -> mpm_status;

    /// Gives the impulse[dim] of the prescribed particles of a set on the material, the sum of
    /// mpm_stepper_particles_reaction() in the same way. It is 0 when a set is added, and forgotten when it is removed.
    /// MPM_E_NOT_FOUND: the set is not in this stepper.
    pub fn mpm_stepper_particles_impulse(
        stepper: *const mpm_stepper,
        prescribed: *const mpm_particles,
        impulse: *mut f64,
    ) -> mpm_status;

    /// Puts a set into a body: 0 <= body < 4096, at first 0. Between steps, also with particles in it. Sets of one body
    /// share one velocity field. MPM_E_NOT_FOUND: the set is not in this stepper. MPM_E_ARG: there is no such body.
    /// MPM_E_UNSUPPORTED: with MPM_NEWMARK, bodies that touch with adhesion, or by MPM_SOLVER_MULTIGRID_CG; with
    /// total_lagrangian = 1 another body than 0, because bodies touch at nodes that both have. MPM_E_STATE during a
    /// staged step, or while a view of nodal fields is out; there are no nodal fields then until the next step.
    pub fn mpm_stepper_set_body(
        stepper: *mut mpm_stepper,
        particles: *mut mpm_particles,
        body: i32,
    ) -> mpm_status;

    /// Gives the body of a set. MPM_E_NOT_FOUND: it is not in this stepper.
    pub fn mpm_stepper_body(
        stepper: *const mpm_stepper,
        particles: *const mpm_particles,
        body: *mut i32,
    ) -> mpm_status;

    /// Fills desc with the defaults. struct_size is sizeof(mpm_contact_desc) of the caller; no byte beyond is written.
    /// MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
    pub fn mpm_contact_desc_init(desc: *mut mpm_contact_desc, struct_size: u32) -> mpm_status;

    /// Sets how two bodies meet; desc is copied. The order of the bodies matters for `direction` alone. With MPM_BODY_ANY
    /// for one body: how the other meets those that have no rule of their own with it; for both: how all meet that have
    /// no closer rule. Of the rules of two bodies each with MPM_BODY_ANY, that of the lower number counts. A later call
    /// replaces an earlier one for the same pair; NULL takes the rule back. Without any rule the defaults of
    /// mpm_contact_desc_init() hold. A saved state holds the rules. MPM_E_ARG: a value is bad. MPM_E_UNSUPPORTED:
    /// adhesion with detection by velocity; with MPM_NEWMARK, adhesion, or MPM_SOLVER_MULTIGRID_CG, of bodies that there
    /// are. MPM_E_STATE during a staged step.
    pub fn mpm_stepper_set_contact(
        stepper: *mut mpm_stepper,
        body_a: i32,
        body_b: i32,
        desc: *const mpm_contact_desc,
    ) -> mpm_status;

    /// Sets the callback for coefficients of friction. NULL takes it away. The host sets it again after it has loaded a
    /// state into another stepper. MPM_E_UNSUPPORTED with MPM_NEWMARK.
    pub fn mpm_stepper_set_friction(
        stepper: *mut mpm_stepper,
        r#fn: mpm_friction_fn,
        user: *mut c_void,
    ) -> mpm_status;

    /// Gives what two bodies did in the last step; for body_a MPM_BODY_ANY the sum over all others, on body_b; the other
    /// way round what they suffered. Bodies that never were near each other have zeros, and an infinite gap. MPM_E_ARG:
    /// the bodies are the same or there is no such body. MPM_E_STATE before the first step.
    pub fn mpm_stepper_contact_info(
        stepper: *const mpm_stepper,
        body_a: i32,
        body_b: i32,
        info: *mut mpm_contact_info,
    ) -> mpm_status;

    /// Fills desc with the defaults. struct_size is sizeof(mpm_obstacle_desc) of the caller; no byte beyond is written.
    /// MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
    pub fn mpm_obstacle_desc_init(desc: *mut mpm_obstacle_desc, struct_size: u32) -> mpm_status;

    /// Makes an obstacle. The desc is copied. *out becomes NULL on failure. MPM_E_ARG: a value is bad. MPM_E_UNSUPPORTED:
    /// velocities of a fixed one, bounds of one that the material is inside of.
    pub fn mpm_obstacle_create(
        context: *mut mpm_context,
        desc: *const mpm_obstacle_desc,
        out: *mut *mut mpm_obstacle,
    ) -> mpm_status;

    /// Frees an obstacle; NULL is let pass. MPM_E_STATE: a stepper holds it.
    pub fn mpm_obstacle_destroy(obstacle: *mut mpm_obstacle) -> mpm_status;

    /// Puts an obstacle into a stepper, with those that are there in the order of adding. MPM_E_STATE: it is in a stepper
    /// already, or a step is under way. MPM_E_UNSUPPORTED: the shape does not exist in the dimension of the grid; it is
    /// free, and the grid MPM_AXISYMMETRIC or the scheme MPM_NEWMARK, which refuses the adhesion of an obstacle in the
    /// step. MPM_E_ARG: it is turned out of a 2-D or 1-D grid, or moves out of it.
    pub fn mpm_stepper_add_obstacle(
        stepper: *mut mpm_stepper,
        obstacle: *mut mpm_obstacle,
    ) -> mpm_status;

    /// Takes an obstacle out, and what it has reported. MPM_E_NOT_FOUND: it is not in this stepper.
    pub fn mpm_stepper_remove_obstacle(
        stepper: *mut mpm_stepper,
        obstacle: *mut mpm_obstacle,
    ) -> mpm_status;

    /// Sets how an obstacle moves in each step, for MPM_MOTION_PRESCRIBED (MPM_E_UNSUPPORTED with others). NULL: it keeps
    /// its velocities. A state does not hold it: after one has been loaded that had it, no step is made (MPM_E_STATE)
    /// until it has been set, before loading or after, or answered by NULL after it. MPM_E_STATE during a staged step.
    pub fn mpm_obstacle_set_motion(
        obstacle: *mut mpm_obstacle,
        r#fn: mpm_motion_fn,
        user: *mut c_void,
    ) -> mpm_status;

    /// Sets how an obstacle meets the material, as mpm_obstacle_desc.contact does. MPM_E_ARG: a value is bad; nothing is
    /// changed. MPM_E_STATE during a staged step.
    pub fn mpm_obstacle_set_contact(
        obstacle: *mut mpm_obstacle,
        contact: *const mpm_contact_desc,
    ) -> mpm_status;

    /// Puts an obstacle somewhere: position[3], orientation[4], velocity[3] and angular_velocity[3] as in
    /// mpm_obstacle_desc, each NULL to keep it. MPM_E_ARG: a value is bad; nothing is changed. MPM_E_UNSUPPORTED: a
    /// velocity other than 0 of a fixed one. MPM_E_STATE during a staged step.
    pub fn mpm_obstacle_set_pose(
        obstacle: *mut mpm_obstacle,
        position: *const f64,
        orientation: *const f64,
        velocity: *const f64,
        angular_velocity: *const f64,
    ) -> mpm_status;

    /// Gives where an obstacle is and how it moves; each may be NULL.
    pub fn mpm_obstacle_get_pose(
        obstacle: *const mpm_obstacle,
        position: *mut f64,
        orientation: *mut f64,
        velocity: *mut f64,
        angular_velocity: *mut f64,
    ) -> mpm_status;

    /// Sets the force[3] and the torque[3] about its centre that act on a free obstacle beside gravity and contact, until
    /// they are set anew; each NULL to keep it. MPM_E_UNSUPPORTED: it is not free. MPM_E_STATE during a staged step.
    pub fn mpm_obstacle_set_load(
        obstacle: *mut mpm_obstacle,
        force: *const f64,
        torque: *const f64,
    ) -> mpm_status;

    /// Gives what a body and an obstacle did to each other in the last step; body MPM_BODY_ANY: all of them. force and
    /// impulse are on the material, -force is on the obstacle; torque is that on the obstacle, about its centre; nodes
    /// are those that could be constrained. MPM_E_STATE: it is in no stepper, or that has made no step yet.
    pub fn mpm_obstacle_contact_info(
        obstacle: *const mpm_obstacle,
        body: i32,
        info: *mut mpm_contact_info,
    ) -> mpm_status;

    /// Fills desc with the defaults. struct_size is sizeof(mpm_surface_desc) of the caller; no byte beyond is written.
    /// MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
    pub fn mpm_surface_desc_init(desc: *mut mpm_surface_desc, struct_size: u32) -> mpm_status;

    /// Makes a surface without markers on a grid, which outlives it. desc is copied and may be NULL for the defaults.
    /// *out is NULL unless MPM_OK is returned. MPM_E_ARG: a value is bad, or the grid is of another context.
    pub fn mpm_surface_create(
        context: *mut mpm_context,
        grid: *mut mpm_grid,
        desc: *const mpm_surface_desc,
        out: *mut *mut mpm_surface,
    ) -> mpm_status;

    /// Frees a surface; NULL is let pass. MPM_E_STATE: a stepper holds it.
    pub fn mpm_surface_destroy(surface: *mut mpm_surface) -> mpm_status;

    /// Replaces loads and options between steps. Errors are those of mpm_surface_create(), and MPM_E_STATE during a
    /// staged step.
    pub fn mpm_surface_configure(
        surface: *mut mpm_surface,
        desc: *const mpm_surface_desc,
    ) -> mpm_status;

    /// Sets the callback that adds tractions. NULL takes it away. The host sets it again after it has loaded a state.
    /// MPM_E_STATE during a staged step.
    pub fn mpm_surface_set_traction(
        surface: *mut mpm_surface,
        r#fn: mpm_traction_fn,
        user: *mut c_void,
    ) -> mpm_status;

    /// Sets the callback that adds to the velocities with which a surface that prescribes moves. NULL takes it away. The
    /// host sets it again after it has loaded a state. MPM_E_STATE during a staged step.
    pub fn mpm_surface_set_velocity(
        surface: *mut mpm_surface,
        r#fn: mpm_marker_velocity_fn,
        user: *mut c_void,
    ) -> mpm_status;

    /// Adds n markers.
    ///
    /// - position: [dim][n], in the grid; on periodic axes it is wrapped.
    /// - area: [dim][n] area vectors, out of the material; NULL for markers without area, which follow the material and
    ///   carry nothing.
    /// - first_id: ids go up by one from the largest so far; the first is written to it. May be NULL.
    ///
    /// In 3-D a marker counts as a square when it is split. MPM_E_ARG: a value is not finite, a position is outside the
    /// grid, the surface would have more than 2^28 markers, or the edge of a ring, which is its area over its radius,
    /// would reach beyond the axis; nothing is added. MPM_E_STATE during a staged step.
    pub fn mpm_surface_add(
        surface: *mut mpm_surface,
        n: i64,
        position: *const f64,
        area: *const f64,
        first_id: *mut i64,
    ) -> mpm_status;

    /// Adds markers along the line through n points, position[2][n]; closed 1: back to the first. The material lies on
    /// the left of the line, so that the outline of a body goes round counter-clockwise. Each edge is divided into equal
    /// parts no longer than spacing > 0, with a marker in the middle of each: half a spacing of the grid is right.
    /// *first_id and *count, which may be NULL, tell of the markers. MPM_E_UNSUPPORTED: the grid is not 2-D. MPM_E_ARG: a
    /// closed line has one or two points, and so no inside. Else as mpm_surface_add().
    pub fn mpm_surface_add_polyline(
        surface: *mut mpm_surface,
        n: i64,
        position: *const f64,
        closed: i32,
        spacing: f64,
        first_id: *mut i64,
        count: *mut i64,
    ) -> mpm_status;

    /// Adds markers on triangles: position[3][n] of their corners, and corner[3 * i], corner[3 * i + 1], corner[3 * i +
    /// 2] the numbers of those of triangle i, counter-clockwise as seen from outside the material. Each triangle is
    /// divided into k^2 equal ones with edges no longer than spacing, with a marker in the middle of each.
    /// MPM_E_UNSUPPORTED: the grid is not 3-D. MPM_E_ARG: there is no such corner. Else as mpm_surface_add_polyline().
    pub fn mpm_surface_add_triangles(
        surface: *mut mpm_surface,
        n: i64,
        position: *const f64,
        triangles: i64,
        corner: *const i64,
        spacing: f64,
        first_id: *mut i64,
        count: *mut i64,
    ) -> mpm_status;

    /// Removes the n markers with the given ids: all or none. MPM_E_NOT_FOUND: an id is not in the surface. MPM_E_ARG: an
    /// id is given twice. MPM_E_STATE during a staged step.
    pub fn mpm_surface_remove(surface: *mut mpm_surface, n: i64, ids: *const i64) -> mpm_status;

    /// Splits markers until no edge is longer than spacing > 0: total area, its moment and the loads are kept, but for
    /// the moment where a half would lie beyond a face of the grid: it is put onto the face. One half keeps the id, the
    /// other gets a new one. *added, which may be NULL, tells how many came. MPM_E_ARG: spacing is bad, or more than 2^28
    /// markers would come of it. MPM_E_STATE during a staged step.
    pub fn mpm_surface_refine(
        surface: *mut mpm_surface,
        spacing: f64,
        added: *mut i64,
    ) -> mpm_status;

    /// The number of markers; 0 for NULL.
    pub fn mpm_surface_count(surface: *const mpm_surface) -> i64;

    /// Copies a field of n markers into out, [components][n]. ids are [n], or NULL for all markers by ascending id, where
    /// n is mpm_surface_count(). type and components must match the field.
    ///
    /// | field             | type | components | what it is                                              | set |
    /// |-------------------|------|------------|---------------------------------------------------------|-----|
    /// | "id"              | I64  | 1          |                                                         |     |
    /// | "position"        | F64  | dim        | length                                                  | yes |
    /// | "area"            | F64  | dim        | area vector, out of the material                        | yes |
    /// | "reference_area"  | F64  | 1          | area when it was added or set                           |     |
    /// | "displacement"    | F64  | dim        | since it was added, across periodic axes too            | yes |
    /// | "velocity"        | F64  | dim        | of the material there, in the last step                 |     |
    /// | "force"           | F64  | dim        | on the material, in the last step                       |     |
    /// | "pressure"        | F64  | 1          | of this marker, beside mpm_surface_desc.pressure        | yes |
    /// | "traction"        | F64  | dim        | likewise                                                | yes |
    /// | "dead_traction"   | F64  | dim        | likewise                                                | yes |
    /// | "prescribed_velocity" | F64 | dim     | of this marker, beside mpm_surface_desc.velocity        | yes |
    /// | "reaction"        | F64  | dim        | force of what is prescribed on the material, last step  |     |
    /// | "gap"             | F64  | dim        | implicit steps: way of the material off what it should  |     |
    ///
    /// MPM_E_NOT_FOUND: there is no such field or id. MPM_E_ARG: type, components or n do not match.
    pub fn mpm_surface_get(
        surface: *const mpm_surface,
        field: *const c_char,
        r#type: i32,
        components: i32,
        n: i64,
        ids: *const i64,
        out: *mut c_void,
    ) -> mpm_status;

    /// Copies values into a field, laid out as in mpm_surface_get(): all or none. Setting "area" makes it the reference.
    /// Errors are those of mpm_surface_get(), and MPM_E_ARG: a value is not finite, a position is outside the grid, or
    /// the field cannot be set. MPM_E_STATE during a staged step. MPM_E_UNSUPPORTED: "position" or "area" with
    /// total_lagrangian = 1, whose weights keep to the markers that were added: add others.
    pub fn mpm_surface_set(
        surface: *mut mpm_surface,
        field: *const c_char,
        r#type: i32,
        components: i32,
        n: i64,
        ids: *const i64,
        values: *const c_void,
    ) -> mpm_status;

    /// Puts a surface into a stepper. In each step its markers load the nodes of mpm_surface_desc.body and move with
    /// them, or as they prescribe; the work is part of mpm_step_info.external_work. Markers that go through MPM_WALL_OPEN
    /// are removed. Steps end with
    ///
    /// - MPM_OFF_GRID: a marker would leave through a face that does not let it;
    /// - MPM_NONFINITE: its load, what it prescribes or its new position is not finite;
    /// - MPM_E_STATE: a marker with a load has no material around it.
    ///
    /// The text names marker and surface, the number of which counts the surfaces of the stepper from 0. MPM_E_STATE: it
    /// is in a stepper already, or a step is under way. MPM_E_ARG: it is on another grid.
    ///
    /// In implicit steps forces are those at the end of the step, on the areas that surfaces then have. Pressure and
    /// traction make the stiffness unsymmetric, so that the solvers for symmetric matrices are not offered; what is
    /// prescribed, and loads of markers that prescribe, keep it symmetric.
    pub fn mpm_stepper_add_surface(
        stepper: *mut mpm_stepper,
        surface: *mut mpm_surface,
    ) -> mpm_status;

    /// Takes a surface out; it keeps its markers. MPM_E_NOT_FOUND: it is not in this stepper.
    pub fn mpm_stepper_remove_surface(
        stepper: *mut mpm_stepper,
        surface: *mut mpm_surface,
    ) -> mpm_status;

    /// Gives the force[dim] by which what a surface prescribes acts on the material: the mean over the last step, the sum
    /// of "reaction" over the markers; 0 for a surface that prescribes nothing. Loads are no part of it. MPM_E_NOT_FOUND:
    /// it is not in this stepper. MPM_E_STATE before the first step.
    pub fn mpm_stepper_surface_reaction(
        stepper: *const mpm_stepper,
        surface: *const mpm_surface,
        force: *mut f64,
    ) -> mpm_status;

    /// Gives the impulse[dim] of it on the material, mass * length/time: the sum of mpm_stepper_surface_reaction() times
    /// the time over which it acted, over all committed steps since the surface was added or mpm_stepper_set_time() was
    /// called. A saved state holds it. MPM_E_NOT_FOUND: the surface is not in this stepper.
    pub fn mpm_stepper_surface_impulse(
        stepper: *const mpm_stepper,
        surface: *const mpm_surface,
        impulse: *mut f64,
    ) -> mpm_status;

    /// Fills desc with the defaults. struct_size is sizeof(mpm_adaption_desc) of the caller; no byte beyond is written.
    /// MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
    pub fn mpm_adaption_desc_init(desc: *mut mpm_adaption_desc, struct_size: u32) -> mpm_status;

    /// Describes how a set of the stepper adapts, for the steps that follow; NULL: no longer. The set then keeps the
    /// field "size". Not part of a saved state: the host sets it again. MPM_E_NOT_FOUND: the set is not in the stepper.
    /// MPM_E_ARG: a value is bad or particles is NULL; an edge could be split that would be shorter than least_edge
    /// (split_edge < 2 least_edge), or max_per_cell < 2 min_per_cell. MPM_E_UNSUPPORTED: total_lagrangian = 1, where
    /// material does not come apart, or the law is "rigid". MPM_E_STATE: a step is under way, or a view of the set is
    /// out.
    pub fn mpm_stepper_set_adaption(
        stepper: *mut mpm_stepper,
        particles: *mut mpm_particles,
        desc: *const mpm_adaption_desc,
    ) -> mpm_status;

    /// Adapts all sets that are described, now and whatever `every` is. Sets are unchanged on failure. MPM_E_CALLBACK,
    /// MPM_CUT_DT: accept returned an error. MPM_E_STATE: a step is under way, a view of a set is out, or a value that
    /// was written through one is bad.
    pub fn mpm_stepper_adapt(stepper: *mut mpm_stepper) -> mpm_status;

    /// Tells what adaption has done to a set. MPM_E_NOT_FOUND: it is not in the stepper. MPM_E_ARG: particles or info is
    /// NULL.
    pub fn mpm_stepper_adaption_info(
        stepper: *const mpm_stepper,
        particles: *const mpm_particles,
        info: *mut mpm_adaption_info,
    ) -> mpm_status;

    /// Fills desc with the defaults. struct_size is sizeof(mpm_heat_desc) of the caller; no byte beyond is written.
    /// MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
    pub fn mpm_heat_desc_init(desc: *mut mpm_heat_desc, struct_size: u32) -> mpm_status;

    /// Describes the heat of a set of the stepper, for the steps that follow; NULL: it has none any more, and its fields
    /// stay as fields of the host. Not part of a saved state, but the fields are: the host describes before it loads.
    /// MPM_E_NOT_FOUND: the set is not in the stepper. MPM_E_ARG: particles is NULL, a value is bad, or the set has a
    /// field "temperature" or "stress_temperature" of another type or with more components. MPM_E_UNSUPPORTED: expansion
    /// is not 0 on MPM_PLANE_STRESS or with the law "rigid"; dissipated_share is not 0 with "rigid" or a law of the host.
    /// MPM_E_STATE: a step is under way, a view of the set is out, or the set has no room for another field.
    pub fn mpm_stepper_set_heat(
        stepper: *mut mpm_stepper,
        particles: *mut mpm_particles,
        desc: *const mpm_heat_desc,
    ) -> mpm_status;

    /// Chooses how the nodes conduct, from MPM_CONDUCTION_EXPLICIT (as made) on. tolerance: of the residual of conjugate
    /// gradients, relative to the right-hand side; > 0 and < 1; not read with explicit conduction. MPM_E_ARG: a value is
    /// bad. MPM_E_STATE: a step is under way.
    pub fn mpm_stepper_set_conduction(
        stepper: *mut mpm_stepper,
        conduction: i32,
        tolerance: f64,
    ) -> mpm_status;

    /// Says what a face does to heat, whatever kind of wall it has. kind: MPM_HEAT_WALL_...; the temperature is not read
    /// of insulated ones, which all faces are from the start. Call it again where the temperature changes: that change,
    /// at first from what the material there has, reaches the particles in the next step; material that comes to the face
    /// later is heated by conduction alone. Where two such faces meet, that of the lower axis prescribes the edge. Not
    /// part of a saved state. MPM_E_ARG: a value is bad, or the axis is periodic. MPM_E_UNSUPPORTED: the face is the axis
    /// of MPM_AXISYMMETRIC, through which nothing flows. MPM_E_STATE: a step is under way.
    pub fn mpm_stepper_set_heat_wall(
        stepper: *mut mpm_stepper,
        face: i32,
        kind: i32,
        temperature: f64,
    ) -> mpm_status;

    /// Heats what lies below a surface, per area of its markers: flux + film (ambient - temperature of the material),
    /// power/area into the material; film is >= 0. All 0 (as made): no heat. Not part of a saved state. MPM_E_ARG: a
    /// value is bad. MPM_E_STATE: a step is under way.
    pub fn mpm_surface_set_heat(
        surface: *mut mpm_surface,
        flux: f64,
        film: f64,
        ambient: f64,
    ) -> mpm_status;

    /// Tells where heat came from. MPM_E_ARG: info is NULL. MPM_E_STATE: a step is under way, or no set was ever
    /// described.
    pub fn mpm_stepper_heat_info(
        stepper: *const mpm_stepper,
        info: *mut mpm_heat_info,
    ) -> mpm_status;

    /// Tells how many bytes mpm_state_save() needs now; of several parts, those of this part's piece (collective).
    pub fn mpm_state_size(stepper: *const mpm_stepper, bytes: *mut i64) -> mpm_status;

    /// Writes the state into the host's buffer of capacity bytes; of several parts, this part's piece (collective).
    /// MPM_E_ARG: the capacity is too small. MPM_E_STATE: a view is out for writing, or a staged step is under way.
    pub fn mpm_state_save(
        stepper: *const mpm_stepper,
        buffer: *mut c_void,
        capacity: i64,
    ) -> mpm_status;

    /// Replaces the state by one saved with mpm_state_save(), of so many bytes; the buffer is read during the call.
    /// MPM_E_FORMAT: the bytes are no state, or it is damaged, of a later format, or saved from an unlike setup; the
    /// error text names the first difference; or they are one piece of several. MPM_E_STATE: a view is out, or a staged
    /// step is under way. MPM_E_UNSUPPORTED: the context is one of several parts, which load by mpm_state_load_pieces().
    pub fn mpm_state_load(
        stepper: *mut mpm_stepper,
        buffer: *const c_void,
        bytes: i64,
    ) -> mpm_status;

    /// Replaces the state by one in pieces (collective). Each part gives count of them, piece[i] of bytes[i] bytes: part
    /// 0 the first few, part 1 those after them, and so on, in the order of the parts that saved them; count may be 0,
    /// and then piece and bytes may be NULL. How many parts saved the state and how many load it does not matter, one
    /// among them: continuing has the bits of not having stopped. What mpm_state_save() of one part wrote, in any
    /// version, is the only piece of its state. Pieces are read during the call and need no alignment. On failure, which
    /// all parts return, no part's objects have changed.
    ///
    /// - MPM_E_ARG: pieces are missing, given twice, out of order, or of different states, which their marks tell; no
    ///   part gives one; or an argument is wrong.
    /// - MPM_E_FORMAT: as in mpm_state_load(); the text names the piece by its number in `piece`.
    /// - MPM_E_STATE: a view is out, or a staged step is under way.
    ///
    /// Since 0.2.0.
    pub fn mpm_state_load_pieces(
        stepper: *mut mpm_stepper,
        count: i32,
        piece: *const *const c_void,
        bytes: *const i64,
    ) -> mpm_status;

    /// Writes the state into a file, as mpm_state_save() does into memory, and waits for the storage: path holds the old
    /// state or the new one. Of several parts, each writes its piece under a path of its own (collective); where one of
    /// them could not, others may have replaced their files. MPM_E_IO: the file could not be written.
    pub fn mpm_state_save_file(stepper: *const mpm_stepper, path: *const c_char) -> mpm_status;

    /// Gives the bytes of mpm_state_save() to a callback. They are made twice, because the first of them hold a checksum
    /// of all others; memory for 65536 bytes is enough. Of several parts, each gives its piece (collective).
    /// MPM_E_CALLBACK: the callback refused. MPM_E_STATE: as in mpm_state_save(); or what was written through a view for
    /// reading changed the state while it went out. Since 0.2.0.
    pub fn mpm_state_save_to(
        stepper: *const mpm_stepper,
        write: mpm_write_fn,
        user: *mut c_void,
    ) -> mpm_status;

    /// Replaces the state by one from a file. Errors are those of mpm_state_load(), and MPM_E_IO: the file could not be
    /// read.
    pub fn mpm_state_load_file(stepper: *mut mpm_stepper, path: *const c_char) -> mpm_status;

    /// Gives a hash of time, step, every field of every set, the pose of every obstacle and every marker of surfaces. It
    /// does not depend on library order, on threads or on optional fields that are not in use: states that are equal by
    /// id have equal hashes.
    pub fn mpm_state_hash(stepper: *const mpm_stepper, hash: *mut u64) -> mpm_status;

    /// Writes a set as VTK poly data (.vtp, appended raw): points in order of ascending id, and count named fields as
    /// point data, with full tensors and, in 2-D and 3-D, with three components per vector. With count 0, when fields may
    /// be NULL, it writes every field in use but "position", which the points are. path is UTF-8. MPM_E_NOT_FOUND: there
    /// is no such field. MPM_E_ARG: a field is named twice. MPM_E_IO: the file could not be written.
    pub fn mpm_write_particles(
        particles: *const mpm_particles,
        path: *const c_char,
        count: i32,
        fields: *const *const c_char,
    ) -> mpm_status;

    /// Gives the bytes of the file that mpm_write_particles() would write to a callback, with memory for one piece.
    /// Errors are the same, but for the path, and with MPM_E_CALLBACK, when the callback refused, in the place of
    /// MPM_E_IO. Since 0.2.0.
    pub fn mpm_write_particles_to(
        particles: *const mpm_particles,
        write: mpm_write_fn,
        user: *mut c_void,
        count: i32,
        fields: *const *const c_char,
    ) -> mpm_status;

    /// Writes nodal fields of the last step, or of a staged step while one is under way, over the box of the active
    /// nodes: as VTK image data (.vti, appended raw), or with open knots, whose nodes are not evenly spaced at the faces,
    /// as a rectilinear grid (.vtr). Fields are named as in mpm_grid_map(); vectors have three components in 2-D and 3-D.
    /// Extents are indices of nodes; where no node is active values are zero. With count 0, when fields may be NULL, it
    /// writes every field that the step has kept but "position", which is that of the points, and "owned". Memory follows
    /// the active nodes; long runs of zeros take no room on storage that knows holes.
    ///
    /// - MPM_E_NOT_FOUND: there is no such field, or no set is in body 0.
    /// - MPM_E_STATE: nothing has been stepped yet.
    /// - MPM_E_UNSUPPORTED: as in mpm_grid_map().
    /// - MPM_E_ARG: a field is named twice, the path ends with the other kind's suffix, or the box has more nodes than a
    ///   file can hold.
    /// - MPM_E_IO: the file could not be written.
    pub fn mpm_write_grid(
        stepper: *mut mpm_stepper,
        path: *const c_char,
        count: i32,
        fields: *const *const c_char,
    ) -> mpm_status;

    /// Does as mpm_write_grid() for the nodes of one body; that one writes those of body 0. MPM_E_NOT_FOUND: no set of
    /// the stepper is in the body.
    pub fn mpm_write_body_grid(
        stepper: *mut mpm_stepper,
        body: i32,
        path: *const c_char,
        count: i32,
        fields: *const *const c_char,
    ) -> mpm_status;

    /// Gives the bytes of the file that mpm_write_body_grid() would write to a callback. They are those of a .vtr file if
    /// the grid has boundary_basis = MPM_BOUNDARY_OPEN_KNOT and an axis that is not periodic, else those of a .vti file;
    /// the second line names the kind, RectilinearGrid or ImageData. Zeros between bodies far apart are all given,
    /// however many they are. Memory follows the active nodes, and one piece is added. Errors are the same, but for the
    /// path, and with MPM_E_CALLBACK, when the callback refused, in the place of MPM_E_IO. Since 0.2.0.
    pub fn mpm_write_grid_to(
        stepper: *mut mpm_stepper,
        body: i32,
        write: mpm_write_fn,
        user: *mut c_void,
        count: i32,
        fields: *const *const c_char,
    ) -> mpm_status;

    /// Starts a series in a new file at path, where it replaces an old one. *out is NULL unless MPM_OK is returned.
    /// MPM_E_IO: the file could not be written.
    pub fn mpm_series_open(
        context: *mut mpm_context,
        path: *const c_char,
        out: *mut *mut mpm_series,
    ) -> mpm_status;

    /// Appends an output file to the series at time t. file is its path as it is to stand in the series: relative to the
    /// series' own file. MPM_E_IO: the file could not be written.
    pub fn mpm_series_append(series: *mut mpm_series, t: f64, file: *const c_char) -> mpm_status;

    /// Ends the series and frees it. Its file stays. NULL is fine.
    pub fn mpm_series_close(series: *mut mpm_series) -> mpm_status;
}
