! Generated from the headers of libmpm by `make api`; not to be edited.
!> libmpm from Fortran: the functions, types and constants of its headers, by their names there. The headers say what
!! they mean; bindings/fortran/README.md says how C and Fortran differ.
module mpm
  use, intrinsic :: iso_c_binding
  implicit none
  public

  !> Version of the headers that the module was made from, to be compared with mpm_version().
  integer(c_int32_t), parameter :: MPM_VERSION_OF_MODULE = 256_c_int32_t

  !> Status values.
  !> the call did what it was asked to.
  integer(c_int32_t), parameter :: MPM_OK = 0_c_int32_t
  !> a callback, a law or contact asked for a smaller step.
  integer(c_int32_t), parameter :: MPM_CUT_DT = 1_c_int32_t
  !> det F <= 0 at a particle.
  integer(c_int32_t), parameter :: MPM_INVERTED = 2_c_int32_t
  !> a NaN or an infinity appeared.
  integer(c_int32_t), parameter :: MPM_NONFINITE = 3_c_int32_t
  !> the Newton iteration did not converge.
  integer(c_int32_t), parameter :: MPM_NOT_CONVERGED = 4_c_int32_t
  !> the linear system is singular, or indefinite beyond repair.
  integer(c_int32_t), parameter :: MPM_SINGULAR = 5_c_int32_t
  !> a particle would leave through a face that does not let it.
  integer(c_int32_t), parameter :: MPM_OFF_GRID = 6_c_int32_t
  !> the progress callback ended the call.
  integer(c_int32_t), parameter :: MPM_CANCELLED = 7_c_int32_t
  !> an argument is NULL, out of range or inconsistent.
  integer(c_int32_t), parameter :: MPM_E_ARG = -1_c_int32_t
  !> the allocator returned NULL.
  integer(c_int32_t), parameter :: MPM_E_NOMEM = -2_c_int32_t
  !> not allowed now: objects live, views are out, or a step is begun.
  integer(c_int32_t), parameter :: MPM_E_STATE = -3_c_int32_t
  !> a callback returned < 0, or the host's executor failed.
  integer(c_int32_t), parameter :: MPM_E_CALLBACK = -4_c_int32_t
  !> this version does not offer the combination or the extension.
  integer(c_int32_t), parameter :: MPM_E_UNSUPPORTED = -5_c_int32_t
  !> there is no such name, id or index; the text lists the nearest names.
  integer(c_int32_t), parameter :: MPM_E_NOT_FOUND = -6_c_int32_t
  !> a file could not be opened, read or written.
  integer(c_int32_t), parameter :: MPM_E_IO = -7_c_int32_t
  !> data are damaged, of another kind, or from an unlike setup.
  integer(c_int32_t), parameter :: MPM_E_FORMAT = -8_c_int32_t
  !> the library itself is at fault.
  integer(c_int32_t), parameter :: MPM_E_INTERNAL = -99_c_int32_t

  !> Basis functions of the grid.
  !> piecewise linear functions, 2h wide: Steffen et al. 2008, eqs 17-18.
  integer(c_int32_t), parameter :: MPM_LINEAR = 1_c_int32_t
  !> Quadratic B-splines, 3h wide: Steffen et al. 2008, eq. 21; MPoint theory, eqs 24-27.
  integer(c_int32_t), parameter :: MPM_BSPLINE2 = 2_c_int32_t
  !> cubic B-splines, 4h wide: Steffen et al. 2008, eqs 22-23.
  integer(c_int32_t), parameter :: MPM_BSPLINE3 = 3_c_int32_t
  !> GIMP on domains of edges "size", at most a cell: Steffen et al. 2008, eqs 26-29.
  integer(c_int32_t), parameter :: MPM_GIMP = 16_c_int32_t
  !> GIMP on domains that all have edges of smoothing * spacing.
  integer(c_int32_t), parameter :: MPM_UGIMP = 17_c_int32_t
  !> GIMP on domains of edges "size" * |F_ii|, at most a cell; depends on the axes.
  integer(c_int32_t), parameter :: MPM_CPGIMP = 18_c_int32_t

  !> What B-splines do at the faces of the grid: Steffen et al. 2008, section 3.2.
  !> splines are the same everywhere, with nodes outside the faces.
  integer(c_int32_t), parameter :: MPM_BOUNDARY_GHOST = 0_c_int32_t
  !> Knots are repeated degree + 1 times at the faces, where one function alone is then 1.
  integer(c_int32_t), parameter :: MPM_BOUNDARY_OPEN_KNOT = 1_c_int32_t

  !> What lies across the plane of a 2-D grid.
  !> a slab of unit thickness that keeps its thickness.
  integer(c_int32_t), parameter :: MPM_PLANE_STRAIN = 0_c_int32_t
  !> A body of revolution: axis 0 is the radius r >= 0, axis 1 the axis z.
  integer(c_int32_t), parameter :: MPM_AXISYMMETRIC = 1_c_int32_t
  !> A sheet of unit thickness at the start, without a stress across it: F33, which the library finds, makes it thinner
  !! and thicker.
  integer(c_int32_t), parameter :: MPM_PLANE_STRESS = 2_c_int32_t

  !> Time integration scheme.
  !> Explicit, with stresses updated last: MPoint theory, eqs 28-44; Steffen et al. 2008, eqs 1-10.
  integer(c_int32_t), parameter :: MPM_USL = 1_c_int32_t
  !> Explicit, with stresses updated first, by the strain from the velocities at the start of the step: Guilkey, An
  !! Introduction to the MPM, eqs 2-10.
  integer(c_int32_t), parameter :: MPM_USF = 2_c_int32_t
  !> As MPM_USL, but velocities are projected a second time before stresses are updated.
  integer(c_int32_t), parameter :: MPM_MUSL = 3_c_int32_t
  !> Implicit, by Newmark's rule: Guilkey & Weiss 2003, eqs 11-16, generalised to any beta and gamma.
  integer(c_int32_t), parameter :: MPM_NEWMARK = 16_c_int32_t

  !> Transfer of velocity between particles and grid.
  !> FLIP, PIC, and their blend by the field flip: MPoint theory, eqs 34-36.
  integer(c_int32_t), parameter :: MPM_FLIP = 1_c_int32_t
  !> affine, with the inertia of each axis and particle, for any basis: Jiang et al. 2015.
  integer(c_int32_t), parameter :: MPM_APIC = 2_c_int32_t
  !> projects the velocity gradient too (MPoint theory, eq. 29); PIC update (eq. 35).
  integer(c_int32_t), parameter :: MPM_TPIC = 3_c_int32_t
  !> projects the velocity gradient too (MPoint theory, eq. 29); FLIP blend (eq. 36).
  integer(c_int32_t), parameter :: MPM_TFLIP = 4_c_int32_t
  !> affine projection with the FLIP blend.
  integer(c_int32_t), parameter :: MPM_AFLIP = 5_c_int32_t
  !> XPIC(m), where m is xpic_order: Hammerquist & Nairn 2017.
  integer(c_int32_t), parameter :: MPM_XPIC = 6_c_int32_t
  !> Affine by moving least squares, with constant inertia and one fused matrix, for quadratic and cubic B-splines with
  !! ghosts or periodic axes: Hu et al. 2018.
  integer(c_int32_t), parameter :: MPM_APIC_MLS = 7_c_int32_t
  !> FMPM(k), where k is xpic_order: nodal velocities by the first k terms of a series for the inverse of the full mass
  !! matrix: Nairn & Hammerquist 2021.
  integer(c_int32_t), parameter :: MPM_FMPM = 8_c_int32_t

  !> Instruction set of the kernels.
  !> the best one that both the processor and the library have.
  integer(c_int32_t), parameter :: MPM_ISA_BEST = 0_c_int32_t
  !> the one that the library was compiled for.
  integer(c_int32_t), parameter :: MPM_ISA_BASELINE = 1_c_int32_t
  !> AVX2 with FMA, on x86-64.
  integer(c_int32_t), parameter :: MPM_ISA_AVX2 = 2_c_int32_t
  !> AVX-512 (F, DQ, VL), on x86-64.
  integer(c_int32_t), parameter :: MPM_ISA_AVX512 = 3_c_int32_t
  !> NEON with FMA, on aarch64.
  integer(c_int32_t), parameter :: MPM_ISA_NEON = 4_c_int32_t
  !> the baseline by its promise: the same bits on every platform (mpm.h, Results).
  integer(c_int32_t), parameter :: MPM_ISA_PORTABLE = MPM_ISA_BASELINE

  !> Level of a log text.
  !> the host should look at it.
  integer(c_int32_t), parameter :: MPM_LOG_WARNING = 1_c_int32_t
  !> a rare event: a choice made at creation, or growth of storage.
  integer(c_int32_t), parameter :: MPM_LOG_INFO = 2_c_int32_t
  !> a text in every step.
  integer(c_int32_t), parameter :: MPM_LOG_DEBUG = 3_c_int32_t

  !> Remedy against volumetric locking: MPoint theory, eqs 47-53, carried to the deformation gradient.
  !> there is no remedy.
  integer(c_int32_t), parameter :: MPM_LOCKING_NONE = 0_c_int32_t
  !> The law sees the dilation averaged over the cell, weighted by volume.
  integer(c_int32_t), parameter :: MPM_LOCKING_CELL_AVERAGE = 1_c_int32_t

  !> Form of a law's tangent.
  !> 6 x 6 components, in Voigt's notation.
  integer(c_int32_t), parameter :: MPM_TANGENT_MINOR_SYMMETRIC = 36_c_int32_t
  !> 9 x 9 components.
  integer(c_int32_t), parameter :: MPM_TANGENT_GENERAL = 81_c_int32_t

  !> Faces of the grid.
  !> lower face across x.
  integer(c_int32_t), parameter :: MPM_X_MIN = 0_c_int32_t
  !> upper face across x.
  integer(c_int32_t), parameter :: MPM_X_MAX = 1_c_int32_t
  !> lower face across y.
  integer(c_int32_t), parameter :: MPM_Y_MIN = 2_c_int32_t
  !> upper face across y.
  integer(c_int32_t), parameter :: MPM_Y_MAX = 3_c_int32_t
  !> lower face across z.
  integer(c_int32_t), parameter :: MPM_Z_MIN = 4_c_int32_t
  !> upper face across z.
  integer(c_int32_t), parameter :: MPM_Z_MAX = 5_c_int32_t

  !> What a face of the grid does.
  !> default: a step in which a particle would leave fails with MPM_OFF_GRID; none with total_lagrangian = 1, where
  !! "position" may leave the box.
  integer(c_int32_t), parameter :: MPM_WALL_NONE = 0_c_int32_t
  !> a particle that leaves is removed; refused with total_lagrangian = 1.
  integer(c_int32_t), parameter :: MPM_WALL_OPEN = 1_c_int32_t
  !> velocities at the face are zero: it pushes and pulls.
  integer(c_int32_t), parameter :: MPM_WALL_FIXED = 2_c_int32_t
  !> a symmetry plane: it pushes and pulls, without tangential force.
  integer(c_int32_t), parameter :: MPM_WALL_SLIP = 3_c_int32_t
  !> the plane of the face as a fixed obstacle with Coulomb friction (obstacle.h): it pushes, never pulls.
  integer(c_int32_t), parameter :: MPM_WALL_FRICTION = 4_c_int32_t
  !> contact of the nodes on the face with Coulomb friction: MPM_WALL_FRICTION as it was in 0.1.0.
  integer(c_int32_t), parameter :: MPM_WALL_FRICTION_NODES = 5_c_int32_t

  !> What a surface prescribes of the motion of the material at its markers.
  !> default: the material carries the markers along.
  integer(c_int32_t), parameter :: MPM_PRESCRIBES_NOTHING = 0_c_int32_t
  !> all components: the material sticks to the surface.
  integer(c_int32_t), parameter :: MPM_PRESCRIBES_VELOCITY = 1_c_int32_t
  !> that along the area vector: the material slides without friction.
  integer(c_int32_t), parameter :: MPM_PRESCRIBES_NORMAL = 2_c_int32_t

  !> Where in an explicit step a node hook runs.
  !> mass and velocity are projected, forces are not yet known.
  integer(c_int32_t), parameter :: MPM_AFTER_P2G = 1_c_int32_t
  !> internal and external forces are complete.
  integer(c_int32_t), parameter :: MPM_AFTER_FORCES = 2_c_int32_t
  !> velocity is updated, and walls and prescribed velocities have acted on it.
  integer(c_int32_t), parameter :: MPM_AFTER_VELOCITY = 3_c_int32_t

  !> Access to mapped memory.
  !> the host reads.
  integer(c_int32_t), parameter :: MPM_READ = 1_c_int32_t
  !> the host writes.
  integer(c_int32_t), parameter :: MPM_WRITE = 2_c_int32_t

  !> Type of a field's elements.
  !> double.
  integer(c_int32_t), parameter :: MPM_F64 = 1_c_int32_t
  !> int64_t.
  integer(c_int32_t), parameter :: MPM_I64 = 2_c_int32_t
  !> uint8_t.
  integer(c_int32_t), parameter :: MPM_U8 = 3_c_int32_t

  !> Order of the particles in mpm_particles_get_f32().
  !> by ascending id.
  integer(c_int32_t), parameter :: MPM_BY_ID = 1_c_int32_t
  !> as they lie in memory, without inert slots; changes when they are sorted anew.
  integer(c_int32_t), parameter :: MPM_LIBRARY_ORDER = 2_c_int32_t

  !> Linear solver of an implicit step.
  !> the library chooses by size, stencil, symmetry and inertia; with a transport as parallel.h says.
  integer(c_int32_t), parameter :: MPM_SOLVER_AUTO = 0_c_int32_t
  !> conjugate gradients, for symmetric positive definite systems.
  integer(c_int32_t), parameter :: MPM_SOLVER_CG = 1_c_int32_t
  !> conjugate gradients with geometric multigrid, for the same systems.
  integer(c_int32_t), parameter :: MPM_SOLVER_MULTIGRID_CG = 2_c_int32_t
  !> a direct solver, for symmetric systems that may be indefinite.
  integer(c_int32_t), parameter :: MPM_SOLVER_LDLT = 3_c_int32_t
  !> GMRES, for systems that are not symmetric.
  integer(c_int32_t), parameter :: MPM_SOLVER_GMRES = 4_c_int32_t
  !> the callback of mpm_stepper_set_linear_solver().
  integer(c_int32_t), parameter :: MPM_SOLVER_HOST = 100_c_int32_t

  !> How much of an exchange its receivers know beforehand.
  !> both sides know who sends to whom: partners send and receive.
  integer(c_int32_t), parameter :: MPM_EXCHANGE_KNOWN = 1_c_int32_t
  !> receivers do not know from whom: particles that move, changes of the pattern.
  integer(c_int32_t), parameter :: MPM_EXCHANGE_SPARSE = 2_c_int32_t

  !> What mpm_reduce_fn does.
  !> the largest of all parts.
  integer(c_int32_t), parameter :: MPM_REDUCE_MAX = 1_c_int32_t
  !> the sum, modulo 2^64.
  integer(c_int32_t), parameter :: MPM_REDUCE_SUM = 2_c_int32_t

  !> How two bodies meet: mpm_contact_desc.kind.
  !> they push each other and never pull, with Coulomb friction (default).
  integer(c_int32_t), parameter :: MPM_CONTACT_UNILATERAL = 0_c_int32_t
  !> they pass through each other.
  integer(c_int32_t), parameter :: MPM_CONTACT_NONE = 1_c_int32_t
  !> neither slip nor separation at nodes that both have.
  integer(c_int32_t), parameter :: MPM_CONTACT_TIED = 2_c_int32_t

  !> How the normal at a node is found: mpm_contact_desc.normal.
  !> of the plane that separates the particles best: logistic regression.
  integer(c_int32_t), parameter :: MPM_NORMAL_LOGISTIC = 0_c_int32_t
  !> of Fisher's linear discriminant: one pass, for smooth surfaces.
  integer(c_int32_t), parameter :: MPM_NORMAL_DISCRIMINANT = 1_c_int32_t
  !> of the mean gradient of volume: for comparison with other codes.
  integer(c_int32_t), parameter :: MPM_NORMAL_GRADIENT = 2_c_int32_t
  !> mpm_contact_desc.direction.
  integer(c_int32_t), parameter :: MPM_NORMAL_FIXED = 3_c_int32_t

  !> How it is found that bodies touch: mpm_contact_desc.detection.
  !> MPM_DETECT_GAP, but MPM_DETECT_VELOCITY with MPM_NORMAL_GRADIENT, whose directions are too far off to measure a gap
  !! along them.
  integer(c_int32_t), parameter :: MPM_DETECT_DEFAULT = 0_c_int32_t
  !> by the gap between their particles.
  integer(c_int32_t), parameter :: MPM_DETECT_GAP = 1_c_int32_t
  !> by velocity alone: wherever they share a node and approach each other.
  integer(c_int32_t), parameter :: MPM_DETECT_VELOCITY = 2_c_int32_t

  !> In place of a body: all of them.
  !> any body that has no closer rule; all of them in reports.
  integer(c_int32_t), parameter :: MPM_BODY_ANY = -1_c_int32_t

  !> Shapes: mpm_obstacle_desc.shape.
  !> a half-space; outward normal: axis y, in 1-D x.
  integer(c_int32_t), parameter :: MPM_SHAPE_PLANE = 1_c_int32_t
  !> size[0]: radius; in 2-D a disc.
  integer(c_int32_t), parameter :: MPM_SHAPE_SPHERE = 2_c_int32_t
  !> around axis z; size[0]: radius, size[1]: half length. 3-D only.
  integer(c_int32_t), parameter :: MPM_SHAPE_CYLINDER = 3_c_int32_t
  !> around axis z; size[0]: radius, size[1]: half length without caps. 3-D only.
  integer(c_int32_t), parameter :: MPM_SHAPE_CAPSULE = 4_c_int32_t
  !> size: half edges; in 2-D a rectangle.
  integer(c_int32_t), parameter :: MPM_SHAPE_BOX = 5_c_int32_t
  !> what mpm_obstacle_desc.distance says.
  integer(c_int32_t), parameter :: MPM_SHAPE_DISTANCE = 64_c_int32_t

  !> How an obstacle moves: mpm_obstacle_desc.motion.
  !> not at all (default).
  integer(c_int32_t), parameter :: MPM_MOTION_FIXED = 0_c_int32_t
  !> by its velocities, which the host may change from step to step.
  integer(c_int32_t), parameter :: MPM_MOTION_PRESCRIBED = 1_c_int32_t
  !> as a rigid body under contact, gravity and the host's load.
  integer(c_int32_t), parameter :: MPM_MOTION_FREE = 2_c_int32_t

  !> What a batch of mpm_adaption_fn is about.
  !> particles that are to be split.
  integer(c_int32_t), parameter :: MPM_ADAPT_SPLIT = 0_c_int32_t
  !> pairs that are to become one particle.
  integer(c_int32_t), parameter :: MPM_ADAPT_MERGE = 1_c_int32_t

  !> How the nodes conduct.
  !> By the temperatures at the start of the step.
  integer(c_int32_t), parameter :: MPM_CONDUCTION_EXPLICIT = 0_c_int32_t
  !> By those at its end (backward Euler), found by conjugate gradients: any step will do.
  integer(c_int32_t), parameter :: MPM_CONDUCTION_IMPLICIT = 1_c_int32_t

  !> What a face of the grid does to heat.
  !> lets none through.
  integer(c_int32_t), parameter :: MPM_HEAT_WALL_INSULATED = 0_c_int32_t
  !> material at it has a prescribed temperature.
  integer(c_int32_t), parameter :: MPM_HEAT_WALL_TEMPERATURE = 1_c_int32_t

  !> A named number.
  type, bind(c) :: mpm_param
    !> one of the names that mpm_material_model_param() lists.
    type(c_ptr) :: name
    !> the value, in the host's units.
    real(c_double) :: value
  end type mpm_param

  !> Memory of the library, lent to the host until mpm_view_release().
  type, bind(c) :: mpm_view
    !> sizeof(mpm_view) of the caller.
    integer(c_int32_t) :: struct_size
    !> MPM_F64, MPM_I64 or MPM_U8.
    integer(c_int32_t) :: type
    !> stored components of an item; tensors may be compact, see particles.h.
    integer(c_int32_t) :: components
    !> MPM_READ, MPM_WRITE or both, as asked for.
    integer(c_int32_t) :: access
    !> number of items, inert slots included.
    integer(c_int64_t) :: count
    !> distance from item i to item i + 1, in elements.
    integer(c_int64_t) :: item_stride
    !> distance from component c to component c + 1, in elements.
    integer(c_int64_t) :: component_stride
    !> address of component 0 of item 0; NULL once released.
    type(c_ptr) :: data
    !> for the library's use; NULL once released.
    type(c_ptr) :: owner
  end type mpm_view

  !> Bytes for, or from, another part.
  type, bind(c) :: mpm_message
    !> to whom, or from whom.
    integer(c_int32_t) :: part
    !> 0; not looked at in what arrives.
    integer(c_int32_t) :: reserved
    !> how many; 0 is sent too where the partner is known.
    integer(c_int64_t) :: bytes
    !> out: the library's, unchanged until mpm_receive_fn returns; in: the host's, at a multiple of 64, valid until the
    !! next mpm_send_fn.
    type(c_ptr) :: data
  end type mpm_message

  !> Ways between the parts.
  type, bind(c) :: mpm_transport
    !> sizeof(mpm_transport) of the caller.
    integer(c_int32_t) :: struct_size
    !> of this context, 0 ... parts - 1.
    integer(c_int32_t) :: part
    !> how many there are.
    integer(c_int32_t) :: parts
    !> 0.
    integer(c_int32_t) :: reserved
    !> required, as the three that follow.
    type(c_funptr) :: send
    !> ends what send started.
    type(c_funptr) :: receive
    !> maxima and sums of integers.
    type(c_funptr) :: reduce
    !> one integer of each part.
    type(c_funptr) :: gather
    !> For transports that move only when called: called up to eight times between send and receive of a sum on nodes,
    !! after each group of the blocks whose sums are made meanwhile.
    type(c_funptr) :: poll
    !> passed to all of them.
    type(c_ptr) :: user
  end type mpm_transport

  !> How blocks of the grid are given to parts.
  type, bind(c) :: mpm_balance_desc
    !> sizeof(mpm_balance_desc) of the caller.
    integer(c_int32_t) :: struct_size
    !> 0 (default): a block weighs what its particles and block_weight come to. 1: the seconds that a part has spent in
    !! steps since blocks were last given to parts, those of waiting left out, are what its blocks weigh together, each
    !! in proportion to that.
    integer(c_int32_t) :: measure
    !> Blocks are given to parts anew, at a sort, when the largest weight of a part is this many times the mean, at
    !! least 1; infinity: never.
    real(c_double) :: limit
    !> What a block costs beside its particles, in particles, from 0 to 1e6.
    real(c_double) :: block_weight
  end type mpm_balance_desc

  !> What one part does of a problem, and what that costs.
  type, bind(c) :: mpm_parallel_info
    !> sizeof(mpm_parallel_info) of the caller.
    integer(c_int32_t) :: struct_size
    !> parts that share nodes with this one.
    integer(c_int32_t) :: neighbours
    !> with particles of this part.
    integer(c_int64_t) :: blocks
    !> of them beside blocks of other parts.
    integer(c_int64_t) :: boundary
    !> blocks of other parts beside them.
    integer(c_int64_t) :: ghosts
    !> sent for sums on nodes.
    integer(c_int64_t) :: bytes_nodes
    !> sent for particles that moved to another part.
    integer(c_int64_t) :: bytes_moved
    !> such particles.
    integer(c_int64_t) :: moved
    !> how often blocks were given to parts anew.
    integer(c_int64_t) :: cuts
    !> largest weight of a part over the mean at the last sort, the same on all parts.
    real(c_double) :: imbalance
    !> packing what is sent, and unpacking particles.
    real(c_double) :: seconds_packing
    !> in receive.
    real(c_double) :: seconds_waiting
    !> in reduce and gather.
    real(c_double) :: seconds_reducing
  end type mpm_parallel_info

  !> Services of the host.
  type, bind(c) :: mpm_context_desc
    !> sizeof(mpm_context_desc) of the caller.
    integer(c_int32_t) :: struct_size
    !> Number of threads, 0 to 1024.
    integer(c_int32_t) :: concurrency
    !> Instruction set of the kernels: MPM_ISA_BEST (default) or the one to be used, which creation refuses with
    !! MPM_E_UNSUPPORTED if processor or library lacks it.
    integer(c_int32_t) :: isa
    !> 1: the library calls the host from the calling thread only, also where a callback is marked (mt).
    integer(c_int32_t) :: serial_callbacks
    !> Returns memory of at least so many bytes at a multiple of alignment, a power of two; or NULL if there is none.
    type(c_funptr) :: alloc
    !> Takes back memory from alloc, with the same bytes and alignment.
    type(c_funptr) :: release
    !> first argument of alloc and release.
    type(c_ptr) :: alloc_user
    !> The host's executor, which takes the place of the pool; concurrency then says for how many threads the work is
    !! cut.
    type(c_funptr) :: parallel_for
    !> first argument of parallel_for.
    type(c_ptr) :: parallel_user
    !> Takes a finished text without newline, with a level MPM_LOG_*.
    type(c_funptr) :: log
    !> first argument of log.
    type(c_ptr) :: log_user
    !> The host's memory for a sentence that says why mpm_context_create() has failed: it is cut to fit, and ends with a
    !! zero; after MPM_OK it is as before.
    type(c_ptr) :: error_text
    !> size of error_text in bytes; 0 exactly where error_text is NULL.
    integer(c_int64_t) :: error_bytes
    !> The ways to the other parts of the problem, read during mpm_context_create() and copied, or NULL (default): there
    !! is one part.
    type(c_ptr) :: transport
  end type mpm_context_desc

  !> Box, cells and basis of a grid.
  type, bind(c) :: mpm_grid_desc
    !> sizeof(mpm_grid_desc) of the caller.
    integer(c_int32_t) :: struct_size
    !> 1 (uniaxial strain), 2 (see geometry) or 3 (default).
    integer(c_int32_t) :: dim
    !> MPM_LINEAR to MPM_CPGIMP; default MPM_BSPLINE2.
    integer(c_int32_t) :: basis
    !> for B-splines: MPM_BOUNDARY_GHOST (default) or MPM_BOUNDARY_OPEN_KNOT.
    integer(c_int32_t) :: boundary_basis
    !> 1: the axis is periodic; default 0.
    integer(c_int32_t) :: periodic(3)
    !> for dim 2: an MPM_PLANE_STRAIN (default) ...
    integer(c_int32_t) :: geometry
    !> cells along each axis, 1 to 6291456; memory follows the material.
    integer(c_int64_t) :: cells(3)
    !> lower corner of the box, length; default 0.
    real(c_double) :: origin(3)
    !> edges of a cell, length, > 0; the upper corner is origin + cells * spacing.
    real(c_double) :: spacing(3)
    !> for MPM_UGIMP: edge of a particle's domain / spacing, in (0, 1]; default 0.5.
    real(c_double) :: smoothing
    !> 1: a total Lagrangian grid (de Vaucorbeil, Nguyen & Hutchinson 2020).
    integer(c_int32_t) :: total_lagrangian
    !> 0.
    integer(c_int32_t) :: reserved
  end type mpm_grid_desc

  !> Particles that a law is asked about.
  type, bind(c) :: mpm_material_batch
    !> sizeof(mpm_material_batch) of the library; see mpm.h.
    integer(c_int32_t) :: struct_size
    !> number of state variables of a particle.
    integer(c_int32_t) :: state_count
    !> number of particles, inert slots included.
    integer(c_int64_t) :: n
    !> distance from component c to c + 1, in elements; >= n.
    integer(c_int64_t) :: ld
    !> time at the end of the step.
    real(c_double) :: t
    !> size of the step; 0: the state as it is, see mpm_stress_fn.
    real(c_double) :: dt
    !> [ld] ids, < 0 for inert slots.
    type(c_ptr) :: id
    !> [9][ld] deformation gradient at the end of the step.
    type(c_ptr) :: F
    !> [9][ld] deformation gradient of this step alone: F = F_inc F_old.
    type(c_ptr) :: F_inc
    !> [9][ld] velocity gradient (F_inc - I) / dt, 1/time; 0 when dt is 0.
    type(c_ptr) :: L
    !> [6][ld] Cauchy stress before the step.
    type(c_ptr) :: stress
    !> [state_count][ld] state variables before the step.
    type(c_ptr) :: state
    !> [6][ld] out: Cauchy stress after the step.
    type(c_ptr) :: stress_new
    !> [state_count][ld] out: state variables after the step.
    type(c_ptr) :: state_new
    !> [ld] out: speed of the fastest elastic wave now, length/time.
    type(c_ptr) :: wave_speed
    !> [ld] out, preset 0: length^2/time, limits the explicit dt.
    type(c_ptr) :: kinematic_viscosity
    !> [ld] out, preset NaN (not known): strain energy per initial volume.
    type(c_ptr) :: energy
    !> [dim][ld] position at the start of the step.
    type(c_ptr) :: position
    !> argument of mpm_batch_field().
    type(c_ptr) :: lookup
  end type mpm_material_batch

  !> A law of the host.
  type, bind(c) :: mpm_material_desc
    !> sizeof(mpm_material_desc) of the caller.
    integer(c_int32_t) :: struct_size
    !> number of state variables of a particle, 0 to 64; default 0.
    integer(c_int32_t) :: state_count
    !> MPM_TANGENT_MINOR_SYMMETRIC (default) or MPM_TANGENT_GENERAL.
    integer(c_int32_t) :: tangent_form
    !> 0.
    integer(c_int32_t) :: reserved
    !> mass per initial volume, > 0; the host must set it.
    real(c_double) :: density
    !> the law; the host must set it.
    type(c_funptr) :: stress
    !> NULL (default): stresses are differenced, in the general form.
    type(c_funptr) :: tangent
    !> first argument of stress, tangent and release_user.
    type(c_ptr) :: user
    !> Called with user when the material is destroyed, not when create fails; may be NULL (default).
    type(c_funptr) :: release_user
    !> [state_count] state of a new particle, copied; NULL (default): zeros.
    type(c_ptr) :: state_initial
  end type mpm_material_desc

  !> A linear system.
  type, bind(c) :: mpm_operator_info
    !> sizeof(mpm_operator_info) of the caller.
    integer(c_int32_t) :: struct_size
    !> number of rows of a node on which nothing is prescribed.
    integer(c_int32_t) :: block
    !> 1 if the matrix is symmetric, else 0.
    integer(c_int32_t) :: symmetric
    !> 1 if the matrix is expected to be positive definite, which is not checked.
    integer(c_int32_t) :: positive_definite
    !> number of local rows and of local columns.
    integer(c_int64_t) :: rows
    !> number of stored entries, all of them in owned rows.
    integer(c_int64_t) :: nonzeros
    !> a hash of nodes, axes and columns, below 2^53, equal on all parts.
    integer(c_int64_t) :: pattern_id
    !> distance from component c to c + 1 of position, in elements; >= rows.
    integer(c_int64_t) :: ld
    !> [rows] number of the node of each row, as in mpm_step_info.node.
    type(c_ptr) :: node
    !> [rows] axis of each row.
    type(c_ptr) :: component
    !> [dim][ld] position of the node of each row, for near-null spaces.
    type(c_ptr) :: position
    !> number of the first owned row over all parts; 0 with one part.
    integer(c_int64_t) :: first_row
    !> number of rows that this part owns; rows with one part.
    integer(c_int64_t) :: owned_rows
    !> number of rows of all parts together.
    integer(c_int64_t) :: all_rows
    !> [rows] number of each local row over all parts.
    type(c_ptr) :: number
  end type mpm_operator_info

  !> Options of a stepper.
  type, bind(c) :: mpm_stepper_desc
    !> sizeof(mpm_stepper_desc) of the caller.
    integer(c_int32_t) :: struct_size
    !> MPM_USL (default), MPM_USF, MPM_MUSL or MPM_NEWMARK.
    integer(c_int32_t) :: scheme
    !> MPM_FLIP (default) to MPM_FMPM.
    integer(c_int32_t) :: transfer
    !> Order m of MPM_XPIC, 1 (PIC) to 5, or k of MPM_FMPM, 1 (PIC) to 32; default 2.
    integer(c_int32_t) :: xpic_order
    !> Order of the update of positions; v is the updated nodal velocity and w a weight.
    integer(c_int32_t) :: position_order
    !> MPM_LOCKING_NONE (default) or, in 2-D and 3-D, MPM_LOCKING_CELL_AVERAGE.
    integer(c_int32_t) :: locking_remedy
    !> 1: keeps "reference_position" and shows it to callbacks; default 0.
    integer(c_int32_t) :: reference_positions
    !> 1: MPM_NEWMARK drops the inertia, so that each step ends in equilibrium under the forces at its end.
    integer(c_int32_t) :: quasi_static
    !> 1: particle velocities are those at t_n - dt/2 (Steffen et al. 2008, eqs 11-15), and so is the kinetic energy;
    !! default 0.
    integer(c_int32_t) :: staggered
    !> Acceleration of nodes whose velocity the host or a particle prescribes.
    integer(c_int32_t) :: boundary_zero_acceleration
    !> Share of FLIP per step for MPM_FLIP, MPM_TFLIP and MPM_AFLIP, and between the steps that xpic_every counts, from
    !! 1 (default, FLIP) to 0 (PIC).
    real(c_double) :: flip
    !> Rate beta >= 0, 1/time, of a blend that does not depend on dt (MPoint theory, eqs 58-59), for the transfers of
    !! flip: the step's share of FLIP is flip * max(0, 1 - beta dt).
    real(c_double) :: pic_damping
    !> acceleration of all particles, length/time^2; default 0.
    real(c_double) :: gravity(3)
    !> Newmark's beta: default 1/4, as Guilkey & Weiss 2003, eqs 14-15.
    real(c_double) :: newmark_beta
    !> Newmark's gamma: default 1/2, as there; larger values damp high frequencies.
    real(c_double) :: newmark_gamma
    !> Newton iterations end when the displacement increment is at most this share of the largest of the step, both
    !! measured by the diagonal of the stiffness, in which light nodes count little (Guilkey & Weiss 2003, eq. 13,
    !! eps_d), and the next two bounds hold as well.
    real(c_double) :: newton_tolerance_displacement
    !> They end when the increment times the residual is at most this share of the first of the step (eps_e in the same
    !! eq. 13), and the other two bounds hold.
    real(c_double) :: newton_tolerance_energy
    !> They end when the norm of the residual is at most this share of a scale that includes reactions, and the other
    !! two bounds hold.
    real(c_double) :: newton_tolerance_residual
    !> Norm of the residual, a force, up to which its bound holds whatever the scale.
    real(c_double) :: newton_residual_floor
    !> iterations after which a step is MPM_NOT_CONVERGED; default 20.
    integer(c_int32_t) :: newton_max_iterations
    !> MPM_SOLVER_AUTO (default) to MPM_SOLVER_HOST.
    integer(c_int32_t) :: linear_solver
    !> ||K x - b|| / ||b||; 0 (default): the Newton iteration chooses it.
    real(c_double) :: linear_tolerance
    !> most iterations of a linear solve; 0 (default): the solver chooses.
    integer(c_int32_t) :: linear_max_iterations
    !> 1: with MPM_MUSL particles move by the projected velocities, which strain them too: x += dt sum w v, with the v
    !! of the second projection.
    integer(c_int32_t) :: projected_positions
    !> Local damping alpha of Cundall 1987, in [0, 1); default 0.
    real(c_double) :: local_damping
    !> Damping in proportion to mass, a >= 0 in 1/time; default 0: the force -a m v on nodes, for a share of a / (2
    !! omega) of critical damping.
    real(c_double) :: mass_damping
    !> For MPM_XPIC and MPM_FMPM: every so many steps are of the order xpic_order, those whose number
    !! (mpm_step_info::step, counted from 1 or on from mpm_stepper_set_time()) is a multiple of this; all others are
    !! those of MPM_FLIP, with flip and pic_damping.
    integer(c_int32_t) :: xpic_every
    !> 0.
    integer(c_int32_t) :: reserved
  end type mpm_stepper_desc

  !> What a step did, or the state as it is.
  type, bind(c) :: mpm_step_info
    !> sizeof(mpm_step_info) of the caller.
    integer(c_int32_t) :: struct_size
    !> status of the failure, MPM_OK if there was none.
    integer(c_int32_t) :: cause
    !> what a callback returned when it was not 0, else 0.
    integer(c_int32_t) :: callback_status
    !> linear solves of the step; 0 for explicit schemes, and at rest.
    integer(c_int32_t) :: newton_iterations
    !> MPM_SOLVER_* that was used; 0 for explicit schemes.
    integer(c_int32_t) :: linear_solver
    !> Set of the first failure, numbered in order of mpm_stepper_add(), or -1.
    integer(c_int32_t) :: set
    !> number of committed steps, counted on from mpm_stepper_set_time().
    integer(c_int64_t) :: step
    !> Number of nodes with mass in the step; of one that failed before they were counted, that of the step before.
    integer(c_int64_t) :: active_nodes
    !> particles that left through MPM_WALL_OPEN since the stepper was made.
    integer(c_int64_t) :: removed
    !> how often particles were sorted anew since the stepper was made.
    integer(c_int64_t) :: resorts
    !> id of the particle that failed, or -1.
    integer(c_int64_t) :: particle
    !> Node that failed, or -1: its lexicographic number over the grid with one ghost layer per side,
    !! ((ix+1)*(cells_y+3)+(iy+1))*(cells_z+3)+(iz+1) with unused axes left out.
    integer(c_int64_t) :: node
    !> iterations of the linear solver, summed over the step.
    integer(c_int64_t) :: linear_iterations
    !> time of the state.
    real(c_double) :: t
    !> size of the step that was tried; 0 before the first.
    real(c_double) :: dt
    !> After success the stable dt of the new state, or with MPM_NEWMARK 2 dt if there were at most 4 iterations and
    !! else dt.
    real(c_double) :: dt_suggested
    !> last relative residual of the Newton iteration; 0 for explicit schemes.
    real(c_double) :: residual
    !> sum m v.v / 2.
    real(c_double) :: kinetic_energy
    !> sum energy * initial_volume; NaN when a law has none.
    real(c_double) :: strain_energy
    !> Work during the step of gravity, acceleration and force callbacks, applied_force, surfaces, node hooks,
    !! prescribed nodal velocities and prescribed particles.
    real(c_double) :: external_work
    !> (kinetic + strain) before the step + external_work - (kinetic + strain) after; NaN where the strain energy is.
    real(c_double) :: dissipation
    !> sum m v; along the radius of MPM_AXISYMMETRIC 0.
    real(c_double) :: momentum(3)
    !> sum m x cross v; in 2-D about z, in [2]; in 1-D and MPM_AXISYMMETRIC 0.
    real(c_double) :: angular_momentum(3)
    !> Sum of external_work over all committed steps since the stepper was made or its time was set.
    real(c_double) :: external_work_total
    !> sum m tr(C D C^T) / 2: kinetic energy of the matrices that APIC, APIC_MLS, TPIC, TFLIP and AFLIP carry (C is
    !! "velocity_gradient", D the second moments of the basis), whose angular momentum is part of angular_momentum.
    real(c_double) :: affine_kinetic_energy
    !> Energy that contact of bodies, obstacles and MPM_WALL_FRICTION took in the step, from the velocities that the
    !! nodes would have without it: never negative.
    real(c_double) :: contact_dissipation
    !> nodes at which these gave each other an impulse.
    integer(c_int64_t) :: contact_nodes
    !> velocity field of `node`; 0 where there is none.
    integer(c_int32_t) :: body
    !> 0.
    integer(c_int32_t) :: reserved
    !> Energy that local_damping and mass_damping took in the step: a part of `dissipation`.
    real(c_double) :: damping_dissipation
    !> Sum of damping_dissipation over all committed steps since the stepper was made or its time was set.
    real(c_double) :: damping_dissipation_total
  end type mpm_step_info

  !> Particles of one set for which a force is wanted.
  type, bind(c) :: mpm_particle_batch
    !> sizeof(mpm_particle_batch) of the library; see mpm.h.
    integer(c_int32_t) :: struct_size
    !> dimension of the grid.
    integer(c_int32_t) :: dim
    !> number of particles, inert slots included.
    integer(c_int64_t) :: n
    !> distance from component c to c + 1, in elements; >= n.
    integer(c_int64_t) :: ld
    !> Time for which the value is wanted: the start of the step.
    real(c_double) :: t
    !> size of the step.
    real(c_double) :: dt
    !> [ld] ids, < 0 for inert slots.
    type(c_ptr) :: id
    !> [dim][ld] at the start of the step, wrapped on periodic axes unless total_lagrangian = 1.
    type(c_ptr) :: position
    !> [dim][ld], or NULL without reference_positions; never NULL with total_lagrangian = 1.
    type(c_ptr) :: reference_position
    !> [dim][ld] at the start of the step.
    type(c_ptr) :: velocity
    !> [ld].
    type(c_ptr) :: mass
    !> [ld] at the start of the step.
    type(c_ptr) :: volume
    !> the set, for comparison only: no call takes it in a callback.
    type(c_ptr) :: particles
    !> argument of mpm_batch_field().
    type(c_ptr) :: lookup
  end type mpm_particle_batch

  !> Active nodes of the grid.
  type, bind(c) :: mpm_node_batch
    !> sizeof(mpm_node_batch) of the library; see mpm.h.
    integer(c_int32_t) :: struct_size
    !> dimension of the grid.
    integer(c_int32_t) :: dim
    !> velocity field of the nodes; see mpm_stepper_set_body().
    integer(c_int32_t) :: body
    !> 0.
    integer(c_int32_t) :: reserved
    !> number of nodes.
    integer(c_int64_t) :: n
    !> distance from component c to c + 1, in elements; >= n.
    integer(c_int64_t) :: ld
    !> time for which the value is wanted.
    real(c_double) :: t
    !> size of the step.
    real(c_double) :: dt
    !> [dim][ld] index of the basis function, from -1 to cells + 1.
    type(c_ptr) :: index
    !> [dim][ld] origin + index * spacing; with open knots the Greville points.
    type(c_ptr) :: position
    !> [ld].
    type(c_ptr) :: mass
    !> [ld] 1 on exactly one of the parts that have the node, for sums of the host, else 0; all 1 with one part: see
    !! parallel.h.
    type(c_ptr) :: owned
  end type mpm_node_batch

  !> How mpm_advance() chooses its sub-steps.
  type, bind(c) :: mpm_advance_desc
    !> sizeof(mpm_advance_desc) of the caller.
    integer(c_int32_t) :: struct_size
    !> most cuts of one sub-step before the call gives up; 0 (default): 60.
    integer(c_int32_t) :: max_cuts
    !> time to reach, not before the present one.
    real(c_double) :: t_end
    !> Explicit: share of mpm_stable_dt(), in (0, 1], or 0 (default since 0.2.0, was 0.5): two thirds of the largest
    !! share at which bodies were found to stay bounded, by basis and scheme: with all transfers in 1-D and 2-D (of
    !! MPM_XPIC order 2, of MPM_FMPM 2 and 8), with MPM_FLIP in 3-D.
    real(c_double) :: cfl
    !> most that the first sub-step takes; 0 (default): the controller's dt.
    real(c_double) :: dt_first
    !> size below which sub-steps are not cut; 0 (default): no bound.
    real(c_double) :: dt_min
    !> size of the largest sub-step; 0 (default): no bound.
    real(c_double) :: dt_max
    !> most sub-steps of this call; 0 (default): no limit.
    integer(c_int64_t) :: max_steps
  end type mpm_advance_desc

  !> Seconds of wall-clock time spent in steps since creation or the last reset, by stage.
  type, bind(c) :: mpm_profile
    !> sizeof(mpm_profile) of the caller.
    integer(c_int32_t) :: struct_size
    !> 0.
    integer(c_int32_t) :: reserved
    !> sorting particles, activating nodes.
    real(c_double) :: sort
    !> weights, particles to grid.
    real(c_double) :: p2g
    !> nodal update, walls, prescribed velocities.
    real(c_double) :: grid
    !> grid to particles.
    real(c_double) :: g2p
    !> laws within g2p and assembly, from samples; their tangents are in assembly.
    real(c_double) :: law
    !> residual and matrix.
    real(c_double) :: assembly
    !> factorisation, set-up of preconditioners.
    real(c_double) :: factor
    !> linear solves.
    real(c_double) :: solve
    !> the host's callbacks.
    real(c_double) :: callbacks
    !> whole steps.
    real(c_double) :: total
    !> weights of the basis within p2g and g2p, from samples.
    real(c_double) :: weights
  end type mpm_profile

  !> How two bodies meet.
  type, bind(c) :: mpm_contact_desc
    !> sizeof(mpm_contact_desc) of the caller.
    integer(c_int32_t) :: struct_size
    !> an MPM_CONTACT_...; default MPM_CONTACT_UNILATERAL.
    integer(c_int32_t) :: kind
    !> an MPM_NORMAL_...; default MPM_NORMAL_LOGISTIC.
    integer(c_int32_t) :: normal
    !> an MPM_DETECT_...; default MPM_DETECT_DEFAULT.
    integer(c_int32_t) :: detection
    !> Coulomb's coefficient of sliding, >= 0; default 0.
    real(c_double) :: friction
    !> that of sticking, >= friction; 0 (default): the same as friction.
    real(c_double) :: friction_static
    !> largest tensile traction while the gap is closed, stress, >= 0; default 0.
    real(c_double) :: adhesion
    !> distance that the surfaces keep, length; < 0: overlap is let be; default 0.
    real(c_double) :: offset
    !> MPM_NORMAL_FIXED: unit normal, from the first body to the second.
    real(c_double) :: direction(3)
  end type mpm_contact_desc

  !> What two bodies did to each other in the last step, and since then.
  type, bind(c) :: mpm_contact_info
    !> sizeof(mpm_contact_info) of the caller.
    integer(c_int32_t) :: struct_size
    !> 1: an impulse was given.
    integer(c_int32_t) :: touching
    !> nodes at which both have mass.
    integer(c_int64_t) :: nodes
    !> of these, with an impulse.
    integer(c_int64_t) :: closed
    !> of these, without slip.
    integer(c_int64_t) :: stuck
    !> nodes that were left out: there is no normal, or both bodies are held.
    integer(c_int64_t) :: ambiguous
    !> on the second body, force.
    real(c_double) :: force(3)
    !> of the same about the origin; in 2-D in component 2; of MPM_AXISYMMETRIC without meaning.
    real(c_double) :: torque(3)
    !> sum of the nodes' normal forces, >= 0 without adhesion.
    real(c_double) :: normal_force
    !> of closed nodes, length^(dim - 1); of MPM_AXISYMMETRIC times radius.
    real(c_double) :: area
    !> largest normal force over area of a node, stress: rows of nodes on both sides of a surface share them unevenly,
    !! and it may be twice what the surface has.
    real(c_double) :: pressure_max
    !> smallest gap that was measured, length; < 0: overlap; infinity if none was.
    real(c_double) :: gap
    !> friction and closing in the step; see contact_dissipation of mpm_step_info.
    real(c_double) :: dissipation
    !> of it, by friction.
    real(c_double) :: friction_work
    !> on the second body over all committed steps since the stepper was made or mpm_stepper_set_time() was called, mass
    !! length/time.
    real(c_double) :: impulse(3)
  end type mpm_contact_info

  !> Nodes at which two bodies touch, for mpm_friction_fn.
  type, bind(c) :: mpm_contact_batch
    !> sizeof(mpm_contact_batch) of the library; see mpm.h.
    integer(c_int32_t) :: struct_size
    !> dimension of the grid.
    integer(c_int32_t) :: dim
    !> the first body, the lower number.
    integer(c_int32_t) :: body_a
    !> the second body.
    integer(c_int32_t) :: body_b
    !> number of nodes.
    integer(c_int64_t) :: n
    !> distance from component c to c + 1, in elements; >= n.
    integer(c_int64_t) :: ld
    !> time at the start of the step.
    real(c_double) :: t
    !> size of the step.
    real(c_double) :: dt
    !> [dim][ld] of the nodes.
    type(c_ptr) :: position
    !> [dim][ld] unit normal, from the first body to the second.
    type(c_ptr) :: normal
    !> [ld] length.
    type(c_ptr) :: gap
    !> [ld] length^(dim - 1); of MPM_AXISYMMETRIC times radius.
    type(c_ptr) :: area
    !> [dim][ld] tangential velocity of the second body relative to the first, before the impulse.
    type(c_ptr) :: slip
    !> [ld] normal traction of the frictionless impulse, stress.
    type(c_ptr) :: pressure
  end type mpm_contact_batch

  !> Points whose distance from an obstacle is asked for.
  type, bind(c) :: mpm_distance_batch
    !> sizeof(mpm_distance_batch) of the library; see mpm.h.
    integer(c_int32_t) :: struct_size
    !> dimension of the grid.
    integer(c_int32_t) :: dim
    !> number of points.
    integer(c_int64_t) :: n
    !> distance from component c to c + 1, in elements; >= n.
    integer(c_int64_t) :: ld
    !> time at the start of the step; in implicit steps with contact a second time that at its end, for particles and
    !! the pose of that time.
    real(c_double) :: t
    !> [dim][ld].
    type(c_ptr) :: position
    !> [ld] to be set: signed distance, > 0 outside.
    type(c_ptr) :: distance
    !> [dim][ld] to be set: unit gradient of the distance.
    type(c_ptr) :: normal
    !> [dim][ld] preset to 0: of the surface there, beside the rigid motion.
    type(c_ptr) :: velocity
  end type mpm_distance_batch

  !> An obstacle.
  type, bind(c) :: mpm_obstacle_desc
    !> sizeof(mpm_obstacle_desc) of the caller.
    integer(c_int32_t) :: struct_size
    !> an MPM_SHAPE_...; no default.
    integer(c_int32_t) :: shape
    !> an MPM_MOTION_...; default MPM_MOTION_FIXED.
    integer(c_int32_t) :: motion
    !> 1: the material is inside (drum, container); default 0.
    integer(c_int32_t) :: inside
    !> see MPM_SHAPE_PLANE ..., length.
    real(c_double) :: size(3)
    !> of the centre, which of a free one is that of mass.
    real(c_double) :: position(3)
    !> unit quaternion w, x, y, z that turns axes of the body into those of space; default 1, 0, 0, 0.
    real(c_double) :: orientation(4)
    !> of the centre; default 0.
    real(c_double) :: velocity(3)
    !> in space, 1/time; in 2-D component 2; default 0.
    real(c_double) :: angular_velocity(3)
    !> of a free one, > 0; in 2-D per depth, in 1-D per area.
    real(c_double) :: mass
    !> of a free one: tensor about the centre in axes of the body, row by row, symmetric and positive definite; in 2-D
    !! component 8 alone; not in 1-D.
    real(c_double) :: inertia(9)
    !> kind, friction, friction_static, adhesion and offset count: how it meets the material.
    type(c_ptr) :: contact
    !> of MPM_SHAPE_DISTANCE.
    type(c_funptr) :: distance
    !> its first argument.
    type(c_ptr) :: user
    !> of MPM_SHAPE_DISTANCE, in axes of the body from its centre: the obstacle and all.
    real(c_double) :: lower(3)
    !> within two spacings of it lie in this box.
    real(c_double) :: upper(3)
  end type mpm_obstacle_desc

  !> Loads of all markers of a surface, and what it prescribes.
  type, bind(c) :: mpm_surface_desc
    !> sizeof(mpm_surface_desc) of the caller.
    integer(c_int32_t) :: struct_size
    !> velocity field that it loads and moves with (mpm_stepper_set_body()); default 0.
    integer(c_int32_t) :: body
    !> force/area against the normal, on the present area: it follows the surface.
    real(c_double) :: pressure
    !> force per present area, in a fixed direction.
    real(c_double) :: traction(3)
    !> force per area at the time when the marker was added: a dead load.
    real(c_double) :: dead_traction(3)
    !> Length > 0: markers with a longer edge are split in two at the end of a step, so that a surface that stretches
    !! has no dents.
    real(c_double) :: max_spacing
    !> MPM_PRESCRIBES_...: what of the motion of the material the markers prescribe.
    integer(c_int32_t) :: prescribes
    !> 0.
    integer(c_int32_t) :: reserved
    !> length/time: how the markers of a surface that prescribes move.
    real(c_double) :: velocity(3)
    !> implicit steps: stiffness of the springs in modulus / spacing, > 0; default 100.
    real(c_double) :: penalty
    !> Implicit steps, force/area >= 0: the modulus of the springs.
    real(c_double) :: modulus
  end type mpm_surface_desc

  !> Markers for which tractions are wanted.
  type, bind(c) :: mpm_marker_batch
    !> sizeof(mpm_marker_batch) of the library; see mpm.h.
    integer(c_int32_t) :: struct_size
    !> dimension of the grid.
    integer(c_int32_t) :: dim
    !> number of markers.
    integer(c_int64_t) :: n
    !> distance from component c to c + 1, in elements; >= n.
    integer(c_int64_t) :: ld
    !> time for which the value is wanted: the start of the step, or the end of an implicit one.
    real(c_double) :: t
    !> size of the step.
    real(c_double) :: dt
    !> [ld] ids, ascending.
    type(c_ptr) :: id
    !> [dim][ld].
    type(c_ptr) :: position
    !> [dim][ld] area vectors.
    type(c_ptr) :: area
    !> [ld] area when the marker was added.
    type(c_ptr) :: reference_area
    !> [dim][ld] since the marker was added.
    type(c_ptr) :: displacement
    !> [dim][ld] of the material there, in the last step.
    type(c_ptr) :: velocity
  end type mpm_marker_batch

  !> Particles that are to be split, or pairs that are to be merged.
  type, bind(c) :: mpm_adaption_batch
    !> sizeof(mpm_adaption_batch) of the library; see mpm.h.
    integer(c_int32_t) :: struct_size
    !> MPM_ADAPT_SPLIT or MPM_ADAPT_MERGE.
    integer(c_int32_t) :: what
    !> how many.
    integer(c_int64_t) :: n
    !> distance from component c to c + 1 of position, in elements; >= n.
    integer(c_int64_t) :: ld
    !> dimension of the grid.
    integer(c_int32_t) :: dim
    !> 0.
    integer(c_int32_t) :: reserved
    !> [ld] ids, ascending; of pairs that of the particle that stays.
    type(c_ptr) :: id
    !> [ld] ids of the particles that go; NULL where particles are split.
    type(c_ptr) :: other
    !> [dim][ld] of the particle, or of the one that stays.
    type(c_ptr) :: position
  end type mpm_adaption_batch

  !> How a set adapts.
  type, bind(c) :: mpm_adaption_desc
    !> sizeof(mpm_adaption_desc) of the caller.
    integer(c_int32_t) :: struct_size
    !> steps from one adaption to the next; default 10; 0: by mpm_stepper_adapt() alone.
    integer(c_int32_t) :: every
    !> Edges of domains that are longer than this are halved.
    real(c_double) :: split_edge
    !> No edge becomes shorter than this by splitting.
    real(c_double) :: least_edge
    !> In a cell that has particles, but fewer of the set than this, they are split along their longest edges until
    !! there are so many.
    integer(c_int32_t) :: min_per_cell
    !> In a cell with more particles of the set pairs are merged until there are so many: in the order of ids, each
    !! particle with the nearest that is alike.
    integer(c_int32_t) :: max_per_cell
    !> Pairs lie no further apart than this.
    real(c_double) :: merge_distance
    !> Pairs are alike when their deformation gradients differ by at most this share of the larger one, in the norm of
    !! Frobenius, their stresses by this share of density c^2, and their velocities by this share of c, the wave speed
    !! of the law; with laws of the host, stresses by this share of the larger one, and velocities are not looked at.
    real(c_double) :: merge_tolerance
    !> Nothing is split beyond this number of particles in the set.
    integer(c_int64_t) :: most_particles
    !> NULL (default): all are accepted.
    type(c_funptr) :: accept
    !> is passed to accept.
    type(c_ptr) :: user
  end type mpm_adaption_desc

  !> What adaption has done to a set, in all steps since it was first described for it or the time was set.
  type, bind(c) :: mpm_adaption_info
    !> sizeof(mpm_adaption_info) of the caller.
    integer(c_int32_t) :: struct_size
    !> 0.
    integer(c_int32_t) :: reserved
    !> particles that were split.
    integer(c_int64_t) :: splits
    !> particles that came by it.
    integer(c_int64_t) :: added
    !> pairs that became one.
    integer(c_int64_t) :: merges
    !> kinetic energy before, less that after: >= 0 of merges; splits with a matrix < 0.
    real(c_double) :: kinetic_loss
    !> the same of the matrices: what they give to velocities, and what is lost.
    real(c_double) :: affine_loss
    !> the same of the strain energy, in merges; laws of the host are not counted.
    real(c_double) :: strain_loss
    !> Angular momentum before, less that after: of merges without a matrix. 0 of MPM_AXISYMMETRIC.
    real(c_double) :: angular_momentum_loss(3)
  end type mpm_adaption_info

  !> The heat of a set.
  type, bind(c) :: mpm_heat_desc
    !> sizeof(mpm_heat_desc) of the caller.
    integer(c_int32_t) :: struct_size
    !> 0.
    integer(c_int32_t) :: reserved
    !> energy / (mass temperature), > 0.
    real(c_double) :: specific_heat
    !> power / (length temperature), >= 0.
    real(c_double) :: conductivity
    !> linear, 1/temperature.
    real(c_double) :: expansion
    !> T0, at which F = I is free of stress.
    real(c_double) :: reference_temperature
    !> Share of the work that the material dissipates which becomes heat, 0 to 1.
    real(c_double) :: dissipated_share
    !> NULL (default): there is none.
    type(c_funptr) :: source
    !> is passed to source.
    type(c_ptr) :: user
  end type mpm_heat_desc

  !> Where heat came from, in the last step and in all steps since the first set was described or the time was set:
  !! gained = sum of walls + sources + surfaces + dissipated, to rounding, and with implicit conduction to the
  !! tolerance.
  type, bind(c) :: mpm_heat_info
    !> sizeof(mpm_heat_info) of the caller.
    integer(c_int32_t) :: struct_size
    !> of the last step's conjugate gradients.
    integer(c_int32_t) :: iterations
    !> sum of mass specific_heat temperature now, of all sets that are described.
    real(c_double) :: heat
    !> what particles took up in the last step.
    real(c_double) :: gained
    !> through the faces, from MPM_X_MIN, into the material.
    real(c_double) :: walls(6)
    !> of the callbacks.
    real(c_double) :: sources
    !> through surfaces, into the material.
    real(c_double) :: surfaces
    !> dissipated work that became heat.
    real(c_double) :: dissipated
    !> the same in all steps, and so with those below.
    real(c_double) :: gained_total
    !> through the faces.
    real(c_double) :: walls_total(6)
    !> of the callbacks.
    real(c_double) :: sources_total
    !> through surfaces.
    real(c_double) :: surfaces_total
    !> dissipated work.
    real(c_double) :: dissipated_total
  end type mpm_heat_info

  ! Callbacks of the host: c_funloc() of a procedure of such an interface is what arguments and fields take.
  abstract interface
    !> Starts an exchange and returns before it is done. out: ascending by part, never this one. most: of each partner,
    !! a bound on what comes from it, [count]; NULL with MPM_EXCHANGE_SPARSE.
    function mpm_send_fn(user, exchange, count, out, most) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      integer(c_int32_t), value :: exchange
      integer(c_int32_t), value :: count
      type(mpm_message), intent(in) :: out
      integer(c_int64_t), intent(in) :: most(*)
      integer(c_int32_t) :: answer
    end function mpm_send_fn

    !> Ends the exchange: all that was sent to this part, ascending by part.
    function mpm_receive_fn(user, count, in) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      integer(c_int32_t), intent(inout) :: count
      type(c_ptr), intent(out) :: in
      integer(c_int32_t) :: answer
    end function mpm_receive_fn

    !> values[count] of all parts into each of them (collective).
    function mpm_reduce_fn(user, op, count, values) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      integer(c_int32_t), value :: op
      integer(c_int64_t), value :: count
      integer(c_int64_t), intent(inout) :: values(*)
      integer(c_int32_t) :: answer
    end function mpm_reduce_fn

    !> all[parts]: value of each part (collective).
    function mpm_gather_fn(user, value, all) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      integer(c_int64_t), value :: value
      integer(c_int64_t), intent(inout) :: all(*)
      integer(c_int32_t) :: answer
    end function mpm_gather_fn

    !> For transports that move only when called: called up to eight times between send and receive of a sum on nodes,
    !! after each group of the blocks whose sums are made meanwhile.
    subroutine mpm_transport_poll_fn(user) bind(c)
      import
      type(c_ptr), value :: user
    end subroutine mpm_transport_poll_fn

    !> A task of the library, which the host's executor calls with the task_data that it was given and a number k.
    subroutine mpm_task_fn(task_data, k) bind(c)
      import
      type(c_ptr), value :: task_data
      integer(c_int64_t), value :: k
    end subroutine mpm_task_fn

    !> The host's executor.
    function mpm_parallel_for_fn(user, count, task, task_data) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      integer(c_int64_t), value :: count
      type(c_funptr), value :: task
      type(c_ptr), value :: task_data
      integer(c_int32_t) :: answer
    end function mpm_parallel_for_fn

    !> Returns memory of at least so many bytes at a multiple of alignment, a power of two; or NULL if there is none.
    function mpm_context_desc_alloc_fn(user, bytes, alignment) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      integer(c_size_t), value :: bytes
      integer(c_size_t), value :: alignment
      type(c_ptr) :: answer
    end function mpm_context_desc_alloc_fn

    !> Takes back memory from alloc, with the same bytes and alignment.
    subroutine mpm_context_desc_release_fn(user, memory, bytes, alignment) bind(c)
      import
      type(c_ptr), value :: user
      type(c_ptr), value :: memory
      integer(c_size_t), value :: bytes
      integer(c_size_t), value :: alignment
    end subroutine mpm_context_desc_release_fn

    !> Takes a finished text without newline, with a level MPM_LOG_*.
    subroutine mpm_context_desc_log_fn(user, level, text) bind(c)
      import
      type(c_ptr), value :: user
      integer(c_int32_t), value :: level
      character(kind=c_char), intent(in) :: text(*)
    end subroutine mpm_context_desc_log_fn

    !> A law (mt).
    function mpm_stress_fn(user, batch) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      type(mpm_material_batch), intent(in) :: batch
      integer(c_int32_t) :: answer
    end function mpm_stress_fn

    !> The tangent of a law (mt), for implicit steps.
    function mpm_tangent_fn(user, batch, tangent, symmetric) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      type(mpm_material_batch), intent(in) :: batch
      real(c_double), intent(inout) :: tangent(*)
      integer(c_int32_t), intent(inout) :: symmetric
      integer(c_int32_t) :: answer
    end function mpm_tangent_fn

    !> Called with user when the material is destroyed, not when create fails; may be NULL (default).
    subroutine mpm_material_desc_release_user_fn(user) bind(c)
      import
      type(c_ptr), value :: user
    end subroutine mpm_material_desc_release_user_fn

    !> Tells which of n points are inside a body: the callback writes inside[i] = 1 or 0 for the point with the
    !! coordinates position[c * ld + i], c < dim.
    function mpm_inside_fn(user, dim, n, ld, position, inside) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      integer(c_int32_t), value :: dim
      integer(c_int64_t), value :: n
      integer(c_int64_t), value :: ld
      real(c_double), intent(in) :: position(*)
      integer(c_int8_t), intent(inout) :: inside(*)
      integer(c_int32_t) :: answer
    end function mpm_inside_fn

    !> Solves matrix * solution = rhs.
    function mpm_solve_fn(user, matrix, rhs, solution, tolerance, iterations) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      type(c_ptr), value :: matrix
      real(c_double), intent(in) :: rhs(*)
      real(c_double), intent(inout) :: solution(*)
      real(c_double), value :: tolerance
      integer(c_int64_t), intent(inout) :: iterations
      integer(c_int32_t) :: answer
    end function mpm_solve_fn

    !> Gives a vector per particle (mt): the callback does add[c * ld + i] += value for c < dim, because several sources
    !! add to the same array.
    function mpm_particle_fn(user, batch, add) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      type(mpm_particle_batch), intent(in) :: batch
      real(c_double), intent(inout) :: add(*)
      integer(c_int32_t) :: answer
    end function mpm_particle_fn

    !> Prescribes nodal velocities (mt).
    function mpm_velocity_fn(user, batch, prescribed, velocity) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      type(mpm_node_batch), intent(in) :: batch
      integer(c_int8_t), intent(inout) :: prescribed(*)
      real(c_double), intent(inout) :: velocity(*)
      integer(c_int32_t) :: answer
    end function mpm_velocity_fn

    !> Reads and changes the nodal velocity[dim][ld] and force[dim][ld] at a stage of an explicit step (mt).
    function mpm_node_fn(user, batch, velocity, force) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      type(mpm_node_batch), intent(in) :: batch
      real(c_double), intent(inout) :: velocity(*)
      real(c_double), intent(inout) :: force(*)
      integer(c_int32_t) :: answer
    end function mpm_node_fn

    !> Watches steps.
    function mpm_progress_fn(user, info) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      type(mpm_step_info), intent(in) :: info
      integer(c_int32_t) :: answer
    end function mpm_progress_fn

    !> Sets the coefficients of friction of nodes (mt): friction[ld], preset to that of the pair of bodies, may be
    !! changed to any finite value >= 0; it then also is that of sticking.
    function mpm_friction_fn(user, batch, friction) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      type(mpm_contact_batch), intent(in) :: batch
      real(c_double), intent(inout) :: friction(*)
      integer(c_int32_t) :: answer
    end function mpm_friction_fn

    !> Gives distances of points (mt).
    function mpm_distance_fn(user, batch) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      type(mpm_distance_batch), intent(in) :: batch
      integer(c_int32_t) :: answer
    end function mpm_distance_fn

    !> Gives the mean velocity[3] and angular velocity[3] of the step from t over dt; both are preset to the present
    !! ones.
    function mpm_motion_fn(user, t, dt, velocity, angular_velocity) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      real(c_double), value :: t
      real(c_double), value :: dt
      real(c_double), intent(inout) :: velocity(*)
      real(c_double), intent(inout) :: angular_velocity(*)
      integer(c_int32_t) :: answer
    end function mpm_motion_fn

    !> Gives tractions: the callback does add[c * ld + i] += force per present area of marker i, c < dim.
    function mpm_traction_fn(user, batch, add) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      type(mpm_marker_batch), intent(in) :: batch
      real(c_double), intent(inout) :: add(*)
      integer(c_int32_t) :: answer
    end function mpm_traction_fn

    !> Gives velocities: the callback does add[c * ld + i] += mean velocity of marker i over the step that begins at
    !! batch->t, c < dim.
    function mpm_marker_velocity_fn(user, batch, add) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      type(mpm_marker_batch), intent(in) :: batch
      real(c_double), intent(inout) :: add(*)
      integer(c_int32_t) :: answer
    end function mpm_marker_velocity_fn

    !> Says which of them are left as they are: accept[i], [ld], is 1, and the callback writes 0 to keep the i-th from
    !! it.
    function mpm_adaption_fn(user, batch, accept) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      type(mpm_adaption_batch), intent(in) :: batch
      integer(c_int8_t), intent(inout) :: accept(*)
      integer(c_int32_t) :: answer
    end function mpm_adaption_fn

    !> Heat sources: writes power[i], [ld], power per present volume, at the time batch->t: the start of the step, and
    !! with implicit conduction its end.
    function mpm_heat_fn(user, batch, power) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      type(mpm_particle_batch), intent(in) :: batch
      real(c_double), intent(inout) :: power(*)
      integer(c_int32_t) :: answer
    end function mpm_heat_fn

    !> Takes the next bytes of an output, in the order in which a file would have them: for archives, sockets, browsers.
    function mpm_write_fn(user, data, bytes) bind(c) result(answer)
      import
      type(c_ptr), value :: user
      type(*), intent(in) :: data(*)
      integer(c_int64_t), value :: bytes
      integer(c_int32_t) :: answer
    end function mpm_write_fn

  end interface

  interface
    !> The version of the library that runs, as 0xMMmmpp, to be compared with MPM_VERSION.
    function mpm_version() bind(c, name="mpm_version") result(answer)
      import
      integer(c_int32_t) :: answer
    end function mpm_version

    !> The name of a status constant, such as "MPM_E_ARG", or "unknown status" for any other value.
    function mpm_status_name(status) bind(c, name="mpm_status_name") result(answer)
      import
      integer(c_int32_t), value :: status
      type(c_ptr) :: answer
    end function mpm_status_name

    !> What a status says, in a sentence without names and values: for calls that have no context to keep a text, as
    !! those on NULL.
    function mpm_status_text(status) bind(c, name="mpm_status_text") result(answer)
      import
      integer(c_int32_t), value :: status
      type(c_ptr) :: answer
    end function mpm_status_text

    !> Gives back the memory of a view that mpm_particles_map() or mpm_grid_map() filled.
    function mpm_view_release(view) bind(c, name="mpm_view_release") result(answer)
      import
      type(mpm_view), intent(inout) :: view
      integer(c_int32_t) :: answer
    end function mpm_view_release

    !> Number of this part and how many there are; 0 and 1 without a transport.
    function mpm_context_part(context, part, parts) bind(c, name="mpm_context_part") result(answer)
      import
      type(c_ptr), value :: context
      integer(c_int32_t), intent(inout), optional :: part
      integer(c_int32_t), intent(inout), optional :: parts
      integer(c_int32_t) :: answer
    end function mpm_context_part

    !> Particles of a set on all parts (collective). mpm_particles_count() is that of this part.
    function mpm_particles_total(particles, n) bind(c, name="mpm_particles_total") result(answer)
      import
      type(c_ptr), value :: particles
      integer(c_int64_t), intent(inout) :: n
      integer(c_int32_t) :: answer
    end function mpm_particles_total

    !> Fills desc with the defaults. struct_size is sizeof(mpm_balance_desc) of the caller; no byte beyond is written.
    function mpm_balance_desc_init(desc, struct_size) bind(c, name="mpm_balance_desc_init") result(answer)
      import
      type(mpm_balance_desc), intent(inout) :: desc
      integer(c_int32_t), value :: struct_size
      integer(c_int32_t) :: answer
    end function mpm_balance_desc_init

    !> Sets how blocks are given to parts, from the next sort of particles on (collective); desc NULL: by the defaults.
    function mpm_stepper_set_balance(stepper, desc) bind(c, name="mpm_stepper_set_balance") result(answer)
      import
      type(c_ptr), value :: stepper
      type(mpm_balance_desc), intent(in), optional :: desc
      integer(c_int32_t) :: answer
    end function mpm_stepper_set_balance

    !> Tells what this part does, as of the last step; 1 in reset starts the counts anew.
    function mpm_stepper_parallel_info(stepper, reset, info) bind(c, name="mpm_stepper_parallel_info") result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t), value :: reset
      type(mpm_parallel_info), intent(inout) :: info
      integer(c_int32_t) :: answer
    end function mpm_stepper_parallel_info

    !> Tells how many bytes mpm_particles_pack() needs for n particles of the set, with the fields that it has now.
    function mpm_particles_packed_size(particles, n, bytes) bind(c, name="mpm_particles_packed_size") result(answer)
      import
      type(c_ptr), value :: particles
      integer(c_int64_t), value :: n
      integer(c_int64_t), intent(inout) :: bytes
      integer(c_int32_t) :: answer
    end function mpm_particles_packed_size

    !> Packs n particles into a buffer, for hosts that move them themselves: between sets, programs, machines.
    function mpm_particles_pack(particles, n, ids, buffer, capacity) bind(c, name="mpm_particles_pack") result(answer)
      import
      type(c_ptr), value :: particles
      integer(c_int64_t), value :: n
      integer(c_int64_t), intent(in), optional :: ids(*)
      type(*), intent(inout) :: buffer(*)
      integer(c_int64_t), value :: capacity
      integer(c_int32_t) :: answer
    end function mpm_particles_pack

    !> Adds packed particles to a set, bit by bit: all or none.
    function mpm_particles_unpack(particles, buffer, bytes) bind(c, name="mpm_particles_unpack") result(answer)
      import
      type(c_ptr), value :: particles
      type(*), intent(in) :: buffer(*)
      integer(c_int64_t), value :: bytes
      integer(c_int32_t) :: answer
    end function mpm_particles_unpack

    !> Fills desc with the defaults. struct_size is sizeof(mpm_context_desc) of the caller; no byte beyond is written.
    function mpm_context_desc_init(desc, struct_size) bind(c, name="mpm_context_desc_init") result(answer)
      import
      type(mpm_context_desc), intent(inout) :: desc
      integer(c_int32_t), value :: struct_size
      integer(c_int32_t) :: answer
    end function mpm_context_desc_init

    !> Makes a context. desc is copied and may be NULL for the defaults. *out is NULL unless MPM_OK is returned.
    function mpm_context_create(desc, out) bind(c, name="mpm_context_create") result(answer)
      import
      type(mpm_context_desc), intent(in), optional :: desc
      type(c_ptr), intent(out) :: out
      integer(c_int32_t) :: answer
    end function mpm_context_create

    !> Tells how many bytes the context and its objects hold now, and the most that they ever held.
    function mpm_context_memory(context, bytes, peak_bytes) bind(c, name="mpm_context_memory") result(answer)
      import
      type(c_ptr), value :: context
      integer(c_int64_t), intent(inout), optional :: bytes
      integer(c_int64_t), intent(inout), optional :: peak_bytes
      integer(c_int32_t) :: answer
    end function mpm_context_memory

    !> Ends the pool and frees the context.
    function mpm_context_destroy(context) bind(c, name="mpm_context_destroy") result(answer)
      import
      type(c_ptr), value :: context
      integer(c_int32_t) :: answer
    end function mpm_context_destroy

    !> Gives one or two sentences, with the offending names and values, on the last call on this context or its objects
    !! that did not return MPM_OK.
    function mpm_last_error(context) bind(c, name="mpm_last_error") result(answer)
      import
      type(c_ptr), value :: context
      type(c_ptr) :: answer
    end function mpm_last_error

    !> Makes text the sentence of mpm_last_error() and returns status: for libraries that stand on this one and refuse a
    !! call of their own on a context, as mpm_umat.h does. text is copied, and cut after some 1000 bytes.
    function mpm_set_last_error(context, status, text) bind(c, name="mpm_set_last_error") result(answer)
      import
      type(c_ptr), value :: context
      integer(c_int32_t), value :: status
      character(kind=c_char), intent(in) :: text(*)
      integer(c_int32_t) :: answer
    end function mpm_set_last_error

    !> Fills desc with the defaults; cells and spacing are 0, and the host must set them. struct_size is
    !! sizeof(mpm_grid_desc) of the caller; no byte beyond is written.
    function mpm_grid_desc_init(desc, struct_size) bind(c, name="mpm_grid_desc_init") result(answer)
      import
      type(mpm_grid_desc), intent(inout) :: desc
      integer(c_int32_t), value :: struct_size
      integer(c_int32_t) :: answer
    end function mpm_grid_desc_init

    !> Makes a grid. desc is copied.
    function mpm_grid_create(context, desc, out) bind(c, name="mpm_grid_create") result(answer)
      import
      type(c_ptr), value :: context
      type(mpm_grid_desc), intent(in) :: desc
      type(c_ptr), intent(out) :: out
      integer(c_int32_t) :: answer
    end function mpm_grid_create

    !> Frees the grid.
    function mpm_grid_destroy(grid) bind(c, name="mpm_grid_destroy") result(answer)
      import
      type(c_ptr), value :: grid
      integer(c_int32_t) :: answer
    end function mpm_grid_destroy

    !> Makes a material from a built-in law.
    function mpm_material_create(context, model, params, count, out) bind(c, name="mpm_material_create") &
        result(answer)
      import
      type(c_ptr), value :: context
      character(kind=c_char), intent(in) :: model(*)
      type(mpm_param), intent(in), optional :: params(*)
      integer(c_int32_t), value :: count
      type(c_ptr), intent(out) :: out
      integer(c_int32_t) :: answer
    end function mpm_material_create

    !> The number of built-in laws.
    function mpm_material_model_count() bind(c, name="mpm_material_model_count") result(answer)
      import
      integer(c_int32_t) :: answer
    end function mpm_material_model_count

    !> The name of the built-in law with number index, 0 <= index < mpm_material_model_count(), or NULL for another
    !! index.
    function mpm_material_model_name(index) bind(c, name="mpm_material_model_name") result(answer)
      import
      integer(c_int32_t), value :: index
      type(c_ptr) :: answer
    end function mpm_material_model_name

    !> Describes the parameter with number index (from 0) of a built-in law: its name, its unit as a dimension (such as
    !! "stress"), one line of text, its default (NaN if it must be given) and its range [low, high].
    function mpm_material_model_param(model, index, name, unit, text, value_default, low, high) bind(c, &
        name="mpm_material_model_param") result(answer)
      import
      character(kind=c_char), intent(in) :: model(*)
      integer(c_int32_t), value :: index
      type(c_ptr), intent(out), optional :: name
      type(c_ptr), intent(out), optional :: unit
      type(c_ptr), intent(out), optional :: text
      real(c_double), intent(inout), optional :: value_default
      real(c_double), intent(inout), optional :: low
      real(c_double), intent(inout), optional :: high
      integer(c_int32_t) :: answer
    end function mpm_material_model_param

    !> The number of state variables of a particle of a built-in law, or -1 where there is no such model.
    function mpm_material_state_count(model) bind(c, name="mpm_material_state_count") result(answer)
      import
      character(kind=c_char), intent(in) :: model(*)
      integer(c_int32_t) :: answer
    end function mpm_material_state_count

    !> Describes the state variable with number index (from 0) of a built-in law: its name, such as "plastic_strain",
    !! its unit as a dimension and one line of text.
    function mpm_material_state_name(model, index, name, unit, text) bind(c, name="mpm_material_state_name") &
        result(answer)
      import
      character(kind=c_char), intent(in) :: model(*)
      integer(c_int32_t), value :: index
      type(c_ptr), intent(out), optional :: name
      type(c_ptr), intent(out), optional :: unit
      type(c_ptr), intent(out), optional :: text
      integer(c_int32_t) :: answer
    end function mpm_material_state_name

    !> Lends a field of the set that a batch belongs to, built in or the host's own.
    function mpm_batch_field(lookup, field, data, component_stride) bind(c, name="mpm_batch_field") result(answer)
      import
      type(c_ptr), value :: lookup
      character(kind=c_char), intent(in) :: field(*)
      type(c_ptr), intent(out) :: data
      integer(c_int64_t), intent(inout) :: component_stride
      integer(c_int32_t) :: answer
    end function mpm_batch_field

    !> Fills desc with the defaults; the host must set density and stress. struct_size is sizeof(mpm_material_desc) of
    !! the caller; no byte beyond is written.
    function mpm_material_desc_init(desc, struct_size) bind(c, name="mpm_material_desc_init") result(answer)
      import
      type(mpm_material_desc), intent(inout) :: desc
      integer(c_int32_t), value :: struct_size
      integer(c_int32_t) :: answer
    end function mpm_material_desc_init

    !> Makes a material from a law of the host. desc is copied. *out is NULL unless MPM_OK is returned.
    function mpm_material_create_custom(context, desc, out) bind(c, name="mpm_material_create_custom") result(answer)
      import
      type(c_ptr), value :: context
      type(mpm_material_desc), intent(in) :: desc
      type(c_ptr), intent(out) :: out
      integer(c_int32_t) :: answer
    end function mpm_material_create_custom

    !> Runs a material, built in or the host's, without a grid: what a step does to its particles, for n items of the
    !! caller.
    function mpm_material_update(material, batch, tangent, symmetric) bind(c, name="mpm_material_update") &
        result(answer)
      import
      type(c_ptr), value :: material
      type(mpm_material_batch), intent(in) :: batch
      real(c_double), intent(inout), optional :: tangent(*)
      integer(c_int32_t), intent(inout), optional :: symmetric
      integer(c_int32_t) :: answer
    end function mpm_material_update

    !> Frees the material and calls release_user.
    function mpm_material_destroy(material) bind(c, name="mpm_material_destroy") result(answer)
      import
      type(c_ptr), value :: material
      integer(c_int32_t) :: answer
    end function mpm_material_destroy

    !> Makes an empty set on a grid, of one material; both outlive it. *out is NULL unless MPM_OK is returned.
    function mpm_particles_create(context, grid, material, out) bind(c, name="mpm_particles_create") result(answer)
      import
      type(c_ptr), value :: context
      type(c_ptr), value :: grid
      type(c_ptr), value :: material
      type(c_ptr), intent(out) :: out
      integer(c_int32_t) :: answer
    end function mpm_particles_create

    !> Frees the set.
    function mpm_particles_destroy(particles) bind(c, name="mpm_particles_destroy") result(answer)
      import
      type(c_ptr), value :: particles
      integer(c_int32_t) :: answer
    end function mpm_particles_destroy

    !> Adds n particles with F = I, zero stress and the law's initial state: all or none.
    function mpm_particles_add(particles, n, position, velocity, volume, size, ids, first_id) bind(c, &
        name="mpm_particles_add") result(answer)
      import
      type(c_ptr), value :: particles
      integer(c_int64_t), value :: n
      real(c_double), intent(in) :: position(*)
      real(c_double), intent(in), optional :: velocity(*)
      real(c_double), intent(in) :: volume(*)
      real(c_double), intent(in), optional :: size(*)
      integer(c_int64_t), intent(in), optional :: ids(*)
      integer(c_int64_t), intent(inout), optional :: first_id
      integer(c_int32_t) :: answer
    end function mpm_particles_add

    !> Fills the box from lower[dim] to upper[dim] with particles at rest on a lattice aligned with the cells, with
    !! per_cell[dim] particles along each axis of a cell, wherever the centre is inside.
    function mpm_particles_fill_box(particles, lower, upper, per_cell, first_id, count) bind(c, &
        name="mpm_particles_fill_box") result(answer)
      import
      type(c_ptr), value :: particles
      real(c_double), intent(in) :: lower(*)
      real(c_double), intent(in) :: upper(*)
      integer(c_int32_t), intent(in) :: per_cell(*)
      integer(c_int64_t), intent(inout), optional :: first_id
      integer(c_int64_t), intent(inout), optional :: count
      integer(c_int32_t) :: answer
    end function mpm_particles_fill_box

    !> Fills a ball (2-D: disc, 1-D: interval) around centre[dim] of a radius > 0, as mpm_particles_fill_box() fills a
    !! box.
    function mpm_particles_fill_ball(particles, centre, radius, per_cell, first_id, count) bind(c, &
        name="mpm_particles_fill_ball") result(answer)
      import
      type(c_ptr), value :: particles
      real(c_double), intent(in) :: centre(*)
      real(c_double), value :: radius
      integer(c_int32_t), intent(in) :: per_cell(*)
      integer(c_int64_t), intent(inout), optional :: first_id
      integer(c_int64_t), intent(inout), optional :: count
      integer(c_int32_t) :: answer
    end function mpm_particles_fill_ball

    !> Fills that part of a box which the callback accepts, as mpm_particles_fill_box() fills the whole.
    function mpm_particles_fill(particles, lower, upper, per_cell, inside, user, first_id, count) bind(c, &
        name="mpm_particles_fill") result(answer)
      import
      type(c_ptr), value :: particles
      real(c_double), intent(in) :: lower(*)
      real(c_double), intent(in) :: upper(*)
      integer(c_int32_t), intent(in) :: per_cell(*)
      type(c_funptr), value :: inside
      type(c_ptr), value :: user
      integer(c_int64_t), intent(inout), optional :: first_id
      integer(c_int64_t), intent(inout), optional :: count
      integer(c_int32_t) :: answer
    end function mpm_particles_fill

    !> Fills what a mesh encloses, as mpm_particles_fill_box() fills a box: triangles in 3-D, edges in 2-D.
    function mpm_particles_fill_mesh(particles, n, position, elements, corner, per_cell, first_id, count) bind(c, &
        name="mpm_particles_fill_mesh") result(answer)
      import
      type(c_ptr), value :: particles
      integer(c_int64_t), value :: n
      real(c_double), intent(in) :: position(*)
      integer(c_int64_t), value :: elements
      integer(c_int64_t), intent(in) :: corner(*)
      integer(c_int32_t), intent(in) :: per_cell(*)
      integer(c_int64_t), intent(inout), optional :: first_id
      integer(c_int64_t), intent(inout), optional :: count
      integer(c_int32_t) :: answer
    end function mpm_particles_fill_mesh

    !> Removes the n particles with the given ids: all or none.
    function mpm_particles_remove(particles, n, ids) bind(c, name="mpm_particles_remove") result(answer)
      import
      type(c_ptr), value :: particles
      integer(c_int64_t), value :: n
      integer(c_int64_t), intent(in) :: ids(*)
      integer(c_int32_t) :: answer
    end function mpm_particles_remove

    !> The number of particles, inert slots not counted; 0 for NULL.
    function mpm_particles_count(particles) bind(c, name="mpm_particles_count") result(answer)
      import
      type(c_ptr), value :: particles
      integer(c_int64_t) :: answer
    end function mpm_particles_count

    !> Describes the field with number index (from 0): its name, its type (MPM_F64, MPM_I64 or MPM_U8), the components
    !! of copies, and whether the host may write it.
    function mpm_particles_field_info(particles, index, field, type, components, writable) bind(c, &
        name="mpm_particles_field_info") result(answer)
      import
      type(c_ptr), value :: particles
      integer(c_int32_t), value :: index
      type(c_ptr), intent(out), optional :: field
      integer(c_int32_t), intent(inout), optional :: type
      integer(c_int32_t), intent(inout), optional :: components
      integer(c_int32_t), intent(inout), optional :: writable
      integer(c_int32_t) :: answer
    end function mpm_particles_field_info

    !> Adds a field of the host, zero in every particle.
    function mpm_particles_add_field(particles, field, type, components) bind(c, name="mpm_particles_add_field") &
        result(answer)
      import
      type(c_ptr), value :: particles
      character(kind=c_char), intent(in) :: field(*)
      integer(c_int32_t), value :: type
      integer(c_int32_t), value :: components
      integer(c_int32_t) :: answer
    end function mpm_particles_add_field

    !> Says of a field of the host that its values are amounts, as mass is, and not densities: particles that are split
    !! share them, and merged ones have the sum.
    function mpm_particles_set_extensive(particles, field, extensive) bind(c, name="mpm_particles_set_extensive") &
        result(answer)
      import
      type(c_ptr), value :: particles
      character(kind=c_char), intent(in) :: field(*)
      integer(c_int32_t), value :: extensive
      integer(c_int32_t) :: answer
    end function mpm_particles_set_extensive

    !> Lends a field in library order, with its stored components and with inert slots (id < 0); a map of "id" tells
    !! which is which. access is MPM_READ, MPM_WRITE or both.
    function mpm_particles_map(particles, field, access, view) bind(c, name="mpm_particles_map") result(answer)
      import
      type(c_ptr), value :: particles
      character(kind=c_char), intent(in) :: field(*)
      integer(c_int32_t), value :: access
      type(mpm_view), intent(inout) :: view
      integer(c_int32_t) :: answer
    end function mpm_particles_map

    !> Copies a field of n particles into out, [components][n] with ld = n; tensors are full. ids are [n], or NULL for
    !! all particles by ascending id, where n is mpm_particles_count(). type and components must match the full field,
    !! to guard the host's buffer.
    function mpm_particles_get(particles, field, type, components, n, ids, out) bind(c, name="mpm_particles_get") &
        result(answer)
      import
      type(c_ptr), value :: particles
      character(kind=c_char), intent(in) :: field(*)
      integer(c_int32_t), value :: type
      integer(c_int32_t), value :: components
      integer(c_int64_t), value :: n
      integer(c_int64_t), intent(in), optional :: ids(*)
      type(*), intent(inout) :: out(*)
      integer(c_int32_t) :: answer
    end function mpm_particles_get

    !> Copies count named fields of all particles into floats for renderers: particles one after the other, without
    !! inert slots, of each the components of the first field, then those of the second, and so on.
    function mpm_particles_get_f32(particles, count, fields, order, n, out) bind(c, name="mpm_particles_get_f32") &
        result(answer)
      import
      type(c_ptr), value :: particles
      integer(c_int32_t), value :: count
      type(c_ptr), intent(in) :: fields(*)
      integer(c_int32_t), value :: order
      integer(c_int64_t), value :: n
      real(c_float), intent(inout) :: out(*)
      integer(c_int32_t) :: answer
    end function mpm_particles_get_f32

    !> Copies values into a field, laid out as in mpm_particles_get(): all or none.
    function mpm_particles_set(particles, field, type, components, n, ids, values) bind(c, name="mpm_particles_set") &
        result(answer)
      import
      type(c_ptr), value :: particles
      character(kind=c_char), intent(in) :: field(*)
      integer(c_int32_t), value :: type
      integer(c_int32_t), value :: components
      integer(c_int64_t), value :: n
      integer(c_int64_t), intent(in), optional :: ids(*)
      type(*), intent(in) :: values(*)
      integer(c_int32_t) :: answer
    end function mpm_particles_set

    !> Sets a field to one value[components] in every particle of the set.
    function mpm_particles_set_all(particles, field, type, components, value) bind(c, name="mpm_particles_set_all") &
        result(answer)
      import
      type(c_ptr), value :: particles
      character(kind=c_char), intent(in) :: field(*)
      integer(c_int32_t), value :: type
      integer(c_int32_t), value :: components
      type(*), intent(in) :: value(*)
      integer(c_int32_t) :: answer
    end function mpm_particles_set_all

    !> Gives all particles the stress of ground at rest below a level surface: along `axis` the pressure of the weight
    !! above, surcharge + density * |gravity| * depth with the material's density, and K0 times that across it; no
    !! shear.
    function mpm_particles_set_geostatic(particles, axis, gravity, surface, K0, surcharge) bind(c, &
        name="mpm_particles_set_geostatic") result(answer)
      import
      type(c_ptr), value :: particles
      integer(c_int32_t), value :: axis
      real(c_double), value :: gravity
      real(c_double), value :: surface
      real(c_double), value :: K0
      real(c_double), value :: surcharge
      integer(c_int32_t) :: answer
    end function mpm_particles_set_geostatic

    !> Makes the present state the one from which all deformation counts: deformation_gradient becomes I, initial_volume
    !! the present volume, dilation_ratio 1, and reference_position, where there is one, the present (unwrapped)
    !! position.
    function mpm_particles_reset_reference(particles) bind(c, name="mpm_particles_reset_reference") result(answer)
      import
      type(c_ptr), value :: particles
      integer(c_int32_t) :: answer
    end function mpm_particles_reset_reference

    !> Describes the system.
    function mpm_operator_get_info(matrix, info) bind(c, name="mpm_operator_get_info") result(answer)
      import
      type(c_ptr), value :: matrix
      type(mpm_operator_info), intent(inout) :: info
      integer(c_int32_t) :: answer
    end function mpm_operator_get_info

    !> Computes y = matrix * x on owned rows.
    function mpm_operator_apply(matrix, x, y) bind(c, name="mpm_operator_apply") result(answer)
      import
      type(c_ptr), value :: matrix
      real(c_double), intent(in) :: x(*)
      real(c_double), intent(inout) :: y(*)
      integer(c_int32_t) :: answer
    end function mpm_operator_apply

    !> Lends the matrix by compressed rows, with both triangles and with columns in ascending order: row r has the
    !! entries (*row_start)[r] to (*row_start)[r + 1] - 1 of *column and *value.
    function mpm_operator_csr(matrix, row_start, column, value) bind(c, name="mpm_operator_csr") result(answer)
      import
      type(c_ptr), value :: matrix
      type(c_ptr), intent(out) :: row_start
      type(c_ptr), intent(out) :: column
      type(c_ptr), intent(out) :: value
      integer(c_int32_t) :: answer
    end function mpm_operator_csr

    !> Fills desc with the defaults. struct_size is sizeof(mpm_stepper_desc) of the caller; no byte beyond is written.
    function mpm_stepper_desc_init(desc, struct_size) bind(c, name="mpm_stepper_desc_init") result(answer)
      import
      type(mpm_stepper_desc), intent(inout) :: desc
      integer(c_int32_t), value :: struct_size
      integer(c_int32_t) :: answer
    end function mpm_stepper_desc_init

    !> Makes a stepper at t = 0 and step 0, without sets, with MPM_WALL_NONE on all faces (the axis of MPM_AXISYMMETRIC
    !! has MPM_WALL_SLIP). desc is copied and may be NULL for the defaults.
    function mpm_stepper_create(context, grid, desc, out) bind(c, name="mpm_stepper_create") result(answer)
      import
      type(c_ptr), value :: context
      type(c_ptr), value :: grid
      type(mpm_stepper_desc), intent(in), optional :: desc
      type(c_ptr), intent(out) :: out
      integer(c_int32_t) :: answer
    end function mpm_stepper_create

    !> Frees the stepper.
    function mpm_stepper_destroy(stepper) bind(c, name="mpm_stepper_destroy") result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t) :: answer
    end function mpm_stepper_destroy

    !> Adds a set to the time loop.
    function mpm_stepper_add(stepper, particles) bind(c, name="mpm_stepper_add") result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_ptr), value :: particles
      integer(c_int32_t) :: answer
    end function mpm_stepper_add

    !> Takes a set out of the time loop.
    function mpm_stepper_remove(stepper, particles) bind(c, name="mpm_stepper_remove") result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_ptr), value :: particles
      integer(c_int32_t) :: answer
    end function mpm_stepper_remove

    !> Replaces the options between steps.
    function mpm_stepper_configure(stepper, desc) bind(c, name="mpm_stepper_configure") result(answer)
      import
      type(c_ptr), value :: stepper
      type(mpm_stepper_desc), intent(in) :: desc
      integer(c_int32_t) :: answer
    end function mpm_stepper_configure

    !> Sets the time and the number of steps counted.
    function mpm_stepper_set_time(stepper, t, step) bind(c, name="mpm_stepper_set_time") result(answer)
      import
      type(c_ptr), value :: stepper
      real(c_double), value :: t
      integer(c_int64_t), value :: step
      integer(c_int32_t) :: answer
    end function mpm_stepper_set_time

    !> Moves the prescribed particles of a set (platens, pistons). mean_velocity (mt) is called at the start of a step
    !! for the particles of the set, unless none is prescribed, and adds the mean velocity u of the coming step to
    !! zeros; what it gives to other particles is ignored.
    function mpm_stepper_set_motion(stepper, particles, mean_velocity, user) bind(c, name="mpm_stepper_set_motion") &
        result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_ptr), value :: particles
      type(c_funptr), value :: mean_velocity
      type(c_ptr), value :: user
      integer(c_int32_t) :: answer
    end function mpm_stepper_set_motion

    !> Sets what a face (MPM_X_MIN to MPM_Z_MAX) does: kind is one of MPM_WALL_NONE to MPM_WALL_FRICTION_NODES. friction
    !! is the Coulomb coefficient, >= 0, of the last two, and is not used otherwise.
    function mpm_stepper_set_wall(stepper, face, kind, friction) bind(c, name="mpm_stepper_set_wall") result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t), value :: face
      integer(c_int32_t), value :: kind
      real(c_double), value :: friction
      integer(c_int32_t) :: answer
    end function mpm_stepper_set_wall

    !> Sets the callback that adds accelerations of particles, length/time^2 (b of MPoint theory, eq. 21).
    function mpm_stepper_set_acceleration(stepper, fn, user) bind(c, name="mpm_stepper_set_acceleration") &
        result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_funptr), value :: fn
      type(c_ptr), value :: user
      integer(c_int32_t) :: answer
    end function mpm_stepper_set_acceleration

    !> Sets the callback that adds forces on particles, mass length/time^2 (f^app of MPoint theory, eq. 21).
    function mpm_stepper_set_force(stepper, fn, user) bind(c, name="mpm_stepper_set_force") result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_funptr), value :: fn
      type(c_ptr), value :: user
      integer(c_int32_t) :: answer
    end function mpm_stepper_set_force

    !> Sets the callback that prescribes nodal velocities, length/time.
    function mpm_stepper_set_velocity_bc(stepper, fn, user) bind(c, name="mpm_stepper_set_velocity_bc") result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_funptr), value :: fn
      type(c_ptr), value :: user
      integer(c_int32_t) :: answer
    end function mpm_stepper_set_velocity_bc

    !> Sets the hook of a stage, one of MPM_AFTER_P2G to MPM_AFTER_VELOCITY.
    function mpm_stepper_set_node_hook(stepper, stage, fn, user) bind(c, name="mpm_stepper_set_node_hook") &
        result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t), value :: stage
      type(c_funptr), value :: fn
      type(c_ptr), value :: user
      integer(c_int32_t) :: answer
    end function mpm_stepper_set_node_hook

    !> Sets the solver of MPM_SOLVER_HOST: see operator.h.
    function mpm_stepper_set_linear_solver(stepper, fn, user) bind(c, name="mpm_stepper_set_linear_solver") &
        result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_funptr), value :: fn
      type(c_ptr), value :: user
      integer(c_int32_t) :: answer
    end function mpm_stepper_set_linear_solver

    !> Sets the progress callback, which runs on the calling thread.
    function mpm_stepper_set_progress(stepper, fn, user) bind(c, name="mpm_stepper_set_progress") result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_funptr), value :: fn
      type(c_ptr), value :: user
      integer(c_int32_t) :: answer
    end function mpm_stepper_set_progress

    !> Gives the stable dt of an explicit step from the present state, at CFL number 1 (MPoint theory, eqs 45-46): 1 /
    !! max over particles and axes of (|v_k| + c) / h_k, where c is the law's current wave speed, and at most h^2 / (2
    !! dim nu) where a law reports a kinematic viscosity nu; h is the smallest spacing.
    function mpm_stable_dt(stepper, dt) bind(c, name="mpm_stable_dt") result(answer)
      import
      type(c_ptr), value :: stepper
      real(c_double), intent(inout) :: dt
      integer(c_int32_t) :: answer
    end function mpm_stable_dt

    !> Makes one step of size dt > 0.
    function mpm_step(stepper, dt, info) bind(c, name="mpm_step") result(answer)
      import
      type(c_ptr), value :: stepper
      real(c_double), value :: dt
      type(mpm_step_info), intent(inout), optional :: info
      integer(c_int32_t) :: answer
    end function mpm_step

    !> Fills desc with the defaults; the host must set t_end. struct_size is sizeof(mpm_advance_desc) of the caller; no
    !! byte beyond is written.
    function mpm_advance_desc_init(desc, struct_size) bind(c, name="mpm_advance_desc_init") result(answer)
      import
      type(mpm_advance_desc), intent(inout) :: desc
      integer(c_int32_t), value :: struct_size
      integer(c_int32_t) :: answer
    end function mpm_advance_desc_init

    !> Steps to t_end exactly.
    function mpm_advance(stepper, desc, info) bind(c, name="mpm_advance") result(answer)
      import
      type(c_ptr), value :: stepper
      type(mpm_advance_desc), intent(in) :: desc
      type(mpm_step_info), intent(inout), optional :: info
      integer(c_int32_t) :: answer
    end function mpm_advance

    !> Copies the times into out, then sets them to zero if reset is not 0.
    function mpm_stepper_profile(stepper, reset, out) bind(c, name="mpm_stepper_profile") result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t), value :: reset
      type(mpm_profile), intent(inout) :: out
      integer(c_int32_t) :: answer
    end function mpm_stepper_profile

    !> Gives the info of the state as it is, also before the first step.
    function mpm_stepper_info(stepper, info) bind(c, name="mpm_stepper_info") result(answer)
      import
      type(c_ptr), value :: stepper
      type(mpm_step_info), intent(inout) :: info
      integer(c_int32_t) :: answer
    end function mpm_stepper_info

    !> Gives the history of the last implicit step: ||residual|| / scale (the scale includes reactions) from before the
    !! first solve to the converged or failed end. *count tells how many values there are; the first capacity of them
    !! are copied into residual, which may be NULL when capacity is 0.
    function mpm_stepper_residuals(stepper, capacity, residual, count) bind(c, name="mpm_stepper_residuals") &
        result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t), value :: capacity
      real(c_double), intent(inout), optional :: residual(*)
      integer(c_int32_t), intent(inout) :: count
      integer(c_int32_t) :: answer
    end function mpm_stepper_residuals

    !> Makes the first part of an explicit step in parts: particles to grid, and forces.
    function mpm_step_begin(stepper, dt) bind(c, name="mpm_step_begin") result(answer)
      import
      type(c_ptr), value :: stepper
      real(c_double), value :: dt
      integer(c_int32_t) :: answer
    end function mpm_step_begin

    !> Makes the second part: nodal velocities, walls, prescribed velocities.
    function mpm_step_grid(stepper) bind(c, name="mpm_step_grid") result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t) :: answer
    end function mpm_step_grid

    !> Makes the last part: grid to particles, stress, commit. info may be NULL.
    function mpm_step_end(stepper, info) bind(c, name="mpm_step_end") result(answer)
      import
      type(c_ptr), value :: stepper
      type(mpm_step_info), intent(inout), optional :: info
      integer(c_int32_t) :: answer
    end function mpm_step_end

    !> Drops the step that was begun; particles and time are as before it.
    function mpm_step_abort(stepper) bind(c, name="mpm_step_abort") result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t) :: answer
    end function mpm_step_abort

    !> Lends a field of the active nodes: of a staged step while one is under way, of the last step otherwise.
    function mpm_grid_map(stepper, body, field, access, view) bind(c, name="mpm_grid_map") result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t), value :: body
      character(kind=c_char), intent(in) :: field(*)
      integer(c_int32_t), value :: access
      type(mpm_view), intent(inout) :: view
      integer(c_int32_t) :: answer
    end function mpm_grid_map

    !> Gives the force[dim] that the wall at a face exerts on the material: the mean over the last step, or with
    !! MPM_NEWMARK the one at its end, but for friction walls.
    function mpm_stepper_wall_reaction(stepper, face, force) bind(c, name="mpm_stepper_wall_reaction") result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t), value :: face
      real(c_double), intent(inout) :: force(*)
      integer(c_int32_t) :: answer
    end function mpm_stepper_wall_reaction

    !> Gives the force[dim] that the prescribed particles of a set exert on the material, on the axes on which they are
    !! prescribed: the mean over the last step, or with MPM_NEWMARK the one at its end.
    function mpm_stepper_particles_reaction(stepper, prescribed, force) bind(c, name="mpm_stepper_particles_reaction") &
        result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_ptr), value :: prescribed
      real(c_double), intent(inout) :: force(*)
      integer(c_int32_t) :: answer
    end function mpm_stepper_particles_reaction

    !> Gives the impulse[dim] of the wall at a face on the material, mass * length/time: the sum of
    !! mpm_stepper_wall_reaction() times the time over which it acted, over all committed steps since the stepper was
    !! made or mpm_stepper_set_time() was called; 0 before the first.
    function mpm_stepper_wall_impulse(stepper, face, impulse) bind(c, name="mpm_stepper_wall_impulse") result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t), value :: face
      real(c_double), intent(inout) :: impulse(*)
      integer(c_int32_t) :: answer
    end function mpm_stepper_wall_impulse

    !> Gives the impulse[dim] of the prescribed particles of a set on the material, the sum of
    !! mpm_stepper_particles_reaction() in the same way.
    function mpm_stepper_particles_impulse(stepper, prescribed, impulse) bind(c, name="mpm_stepper_particles_impulse") &
        result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_ptr), value :: prescribed
      real(c_double), intent(inout) :: impulse(*)
      integer(c_int32_t) :: answer
    end function mpm_stepper_particles_impulse

    !> Puts a set into a body: 0 <= body < 4096, at first 0.
    function mpm_stepper_set_body(stepper, particles, body) bind(c, name="mpm_stepper_set_body") result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_ptr), value :: particles
      integer(c_int32_t), value :: body
      integer(c_int32_t) :: answer
    end function mpm_stepper_set_body

    !> Gives the body of a set.
    function mpm_stepper_body(stepper, particles, body) bind(c, name="mpm_stepper_body") result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_ptr), value :: particles
      integer(c_int32_t), intent(inout) :: body
      integer(c_int32_t) :: answer
    end function mpm_stepper_body

    !> Fills desc with the defaults. struct_size is sizeof(mpm_contact_desc) of the caller; no byte beyond is written.
    function mpm_contact_desc_init(desc, struct_size) bind(c, name="mpm_contact_desc_init") result(answer)
      import
      type(mpm_contact_desc), intent(inout) :: desc
      integer(c_int32_t), value :: struct_size
      integer(c_int32_t) :: answer
    end function mpm_contact_desc_init

    !> Sets how two bodies meet; desc is copied.
    function mpm_stepper_set_contact(stepper, body_a, body_b, desc) bind(c, name="mpm_stepper_set_contact") &
        result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t), value :: body_a
      integer(c_int32_t), value :: body_b
      type(mpm_contact_desc), intent(in), optional :: desc
      integer(c_int32_t) :: answer
    end function mpm_stepper_set_contact

    !> Sets the callback for coefficients of friction.
    function mpm_stepper_set_friction(stepper, fn, user) bind(c, name="mpm_stepper_set_friction") result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_funptr), value :: fn
      type(c_ptr), value :: user
      integer(c_int32_t) :: answer
    end function mpm_stepper_set_friction

    !> Gives what two bodies did in the last step; for body_a MPM_BODY_ANY the sum over all others, on body_b; the other
    !! way round what they suffered.
    function mpm_stepper_contact_info(stepper, body_a, body_b, info) bind(c, name="mpm_stepper_contact_info") &
        result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t), value :: body_a
      integer(c_int32_t), value :: body_b
      type(mpm_contact_info), intent(inout) :: info
      integer(c_int32_t) :: answer
    end function mpm_stepper_contact_info

    !> Fills desc with the defaults. struct_size is sizeof(mpm_obstacle_desc) of the caller; no byte beyond is written.
    function mpm_obstacle_desc_init(desc, struct_size) bind(c, name="mpm_obstacle_desc_init") result(answer)
      import
      type(mpm_obstacle_desc), intent(inout) :: desc
      integer(c_int32_t), value :: struct_size
      integer(c_int32_t) :: answer
    end function mpm_obstacle_desc_init

    !> Makes an obstacle.
    function mpm_obstacle_create(context, desc, out) bind(c, name="mpm_obstacle_create") result(answer)
      import
      type(c_ptr), value :: context
      type(mpm_obstacle_desc), intent(in) :: desc
      type(c_ptr), intent(out) :: out
      integer(c_int32_t) :: answer
    end function mpm_obstacle_create

    !> Frees an obstacle; NULL is let pass.
    function mpm_obstacle_destroy(obstacle) bind(c, name="mpm_obstacle_destroy") result(answer)
      import
      type(c_ptr), value :: obstacle
      integer(c_int32_t) :: answer
    end function mpm_obstacle_destroy

    !> Puts an obstacle into a stepper, with those that are there in the order of adding.
    function mpm_stepper_add_obstacle(stepper, obstacle) bind(c, name="mpm_stepper_add_obstacle") result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_ptr), value :: obstacle
      integer(c_int32_t) :: answer
    end function mpm_stepper_add_obstacle

    !> Takes an obstacle out, and what it has reported.
    function mpm_stepper_remove_obstacle(stepper, obstacle) bind(c, name="mpm_stepper_remove_obstacle") result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_ptr), value :: obstacle
      integer(c_int32_t) :: answer
    end function mpm_stepper_remove_obstacle

    !> Sets how an obstacle moves in each step, for MPM_MOTION_PRESCRIBED (MPM_E_UNSUPPORTED with others).
    function mpm_obstacle_set_motion(obstacle, fn, user) bind(c, name="mpm_obstacle_set_motion") result(answer)
      import
      type(c_ptr), value :: obstacle
      type(c_funptr), value :: fn
      type(c_ptr), value :: user
      integer(c_int32_t) :: answer
    end function mpm_obstacle_set_motion

    !> Sets how an obstacle meets the material, as mpm_obstacle_desc.contact does.
    function mpm_obstacle_set_contact(obstacle, contact) bind(c, name="mpm_obstacle_set_contact") result(answer)
      import
      type(c_ptr), value :: obstacle
      type(mpm_contact_desc), intent(in) :: contact
      integer(c_int32_t) :: answer
    end function mpm_obstacle_set_contact

    !> Puts an obstacle somewhere: position[3], orientation[4], velocity[3] and angular_velocity[3] as in
    !! mpm_obstacle_desc, each NULL to keep it.
    function mpm_obstacle_set_pose(obstacle, position, orientation, velocity, angular_velocity) bind(c, &
        name="mpm_obstacle_set_pose") result(answer)
      import
      type(c_ptr), value :: obstacle
      real(c_double), intent(in), optional :: position(*)
      real(c_double), intent(in), optional :: orientation(*)
      real(c_double), intent(in), optional :: velocity(*)
      real(c_double), intent(in), optional :: angular_velocity(*)
      integer(c_int32_t) :: answer
    end function mpm_obstacle_set_pose

    !> Gives where an obstacle is and how it moves; each may be NULL.
    function mpm_obstacle_get_pose(obstacle, position, orientation, velocity, angular_velocity) bind(c, &
        name="mpm_obstacle_get_pose") result(answer)
      import
      type(c_ptr), value :: obstacle
      real(c_double), intent(inout), optional :: position(*)
      real(c_double), intent(inout), optional :: orientation(*)
      real(c_double), intent(inout), optional :: velocity(*)
      real(c_double), intent(inout), optional :: angular_velocity(*)
      integer(c_int32_t) :: answer
    end function mpm_obstacle_get_pose

    !> Sets the force[3] and the torque[3] about its centre that act on a free obstacle beside gravity and contact,
    !! until they are set anew; each NULL to keep it.
    function mpm_obstacle_set_load(obstacle, force, torque) bind(c, name="mpm_obstacle_set_load") result(answer)
      import
      type(c_ptr), value :: obstacle
      real(c_double), intent(in), optional :: force(*)
      real(c_double), intent(in), optional :: torque(*)
      integer(c_int32_t) :: answer
    end function mpm_obstacle_set_load

    !> Gives what a body and an obstacle did to each other in the last step; body MPM_BODY_ANY: all of them. force and
    !! impulse are on the material, -force is on the obstacle; torque is that on the obstacle, about its centre; nodes
    !! are those that could be constrained.
    function mpm_obstacle_contact_info(obstacle, body, info) bind(c, name="mpm_obstacle_contact_info") result(answer)
      import
      type(c_ptr), value :: obstacle
      integer(c_int32_t), value :: body
      type(mpm_contact_info), intent(inout) :: info
      integer(c_int32_t) :: answer
    end function mpm_obstacle_contact_info

    !> Fills desc with the defaults. struct_size is sizeof(mpm_surface_desc) of the caller; no byte beyond is written.
    function mpm_surface_desc_init(desc, struct_size) bind(c, name="mpm_surface_desc_init") result(answer)
      import
      type(mpm_surface_desc), intent(inout) :: desc
      integer(c_int32_t), value :: struct_size
      integer(c_int32_t) :: answer
    end function mpm_surface_desc_init

    !> Makes a surface without markers on a grid, which outlives it. desc is copied and may be NULL for the defaults.
    !! *out is NULL unless MPM_OK is returned.
    function mpm_surface_create(context, grid, desc, out) bind(c, name="mpm_surface_create") result(answer)
      import
      type(c_ptr), value :: context
      type(c_ptr), value :: grid
      type(mpm_surface_desc), intent(in), optional :: desc
      type(c_ptr), intent(out) :: out
      integer(c_int32_t) :: answer
    end function mpm_surface_create

    !> Frees a surface; NULL is let pass.
    function mpm_surface_destroy(surface) bind(c, name="mpm_surface_destroy") result(answer)
      import
      type(c_ptr), value :: surface
      integer(c_int32_t) :: answer
    end function mpm_surface_destroy

    !> Replaces loads and options between steps.
    function mpm_surface_configure(surface, desc) bind(c, name="mpm_surface_configure") result(answer)
      import
      type(c_ptr), value :: surface
      type(mpm_surface_desc), intent(in) :: desc
      integer(c_int32_t) :: answer
    end function mpm_surface_configure

    !> Sets the callback that adds tractions.
    function mpm_surface_set_traction(surface, fn, user) bind(c, name="mpm_surface_set_traction") result(answer)
      import
      type(c_ptr), value :: surface
      type(c_funptr), value :: fn
      type(c_ptr), value :: user
      integer(c_int32_t) :: answer
    end function mpm_surface_set_traction

    !> Sets the callback that adds to the velocities with which a surface that prescribes moves.
    function mpm_surface_set_velocity(surface, fn, user) bind(c, name="mpm_surface_set_velocity") result(answer)
      import
      type(c_ptr), value :: surface
      type(c_funptr), value :: fn
      type(c_ptr), value :: user
      integer(c_int32_t) :: answer
    end function mpm_surface_set_velocity

    !> Adds n markers.
    function mpm_surface_add(surface, n, position, area, first_id) bind(c, name="mpm_surface_add") result(answer)
      import
      type(c_ptr), value :: surface
      integer(c_int64_t), value :: n
      real(c_double), intent(in) :: position(*)
      real(c_double), intent(in), optional :: area(*)
      integer(c_int64_t), intent(inout), optional :: first_id
      integer(c_int32_t) :: answer
    end function mpm_surface_add

    !> Adds markers along the line through n points, position[2][n]; closed 1: back to the first.
    function mpm_surface_add_polyline(surface, n, position, closed, spacing, first_id, count) bind(c, &
        name="mpm_surface_add_polyline") result(answer)
      import
      type(c_ptr), value :: surface
      integer(c_int64_t), value :: n
      real(c_double), intent(in) :: position(*)
      integer(c_int32_t), value :: closed
      real(c_double), value :: spacing
      integer(c_int64_t), intent(inout), optional :: first_id
      integer(c_int64_t), intent(inout), optional :: count
      integer(c_int32_t) :: answer
    end function mpm_surface_add_polyline

    !> Adds markers on triangles: position[3][n] of their corners, and corner[3 * i], corner[3 * i + 1], corner[3 * i +
    !! 2] the numbers of those of triangle i, counter-clockwise as seen from outside the material.
    function mpm_surface_add_triangles(surface, n, position, triangles, corner, spacing, first_id, count) bind(c, &
        name="mpm_surface_add_triangles") result(answer)
      import
      type(c_ptr), value :: surface
      integer(c_int64_t), value :: n
      real(c_double), intent(in) :: position(*)
      integer(c_int64_t), value :: triangles
      integer(c_int64_t), intent(in) :: corner(*)
      real(c_double), value :: spacing
      integer(c_int64_t), intent(inout), optional :: first_id
      integer(c_int64_t), intent(inout), optional :: count
      integer(c_int32_t) :: answer
    end function mpm_surface_add_triangles

    !> Removes the n markers with the given ids: all or none.
    function mpm_surface_remove(surface, n, ids) bind(c, name="mpm_surface_remove") result(answer)
      import
      type(c_ptr), value :: surface
      integer(c_int64_t), value :: n
      integer(c_int64_t), intent(in) :: ids(*)
      integer(c_int32_t) :: answer
    end function mpm_surface_remove

    !> Splits markers until no edge is longer than spacing > 0: total area, its moment and the loads are kept, but for
    !! the moment where a half would lie beyond a face of the grid: it is put onto the face.
    function mpm_surface_refine(surface, spacing, added) bind(c, name="mpm_surface_refine") result(answer)
      import
      type(c_ptr), value :: surface
      real(c_double), value :: spacing
      integer(c_int64_t), intent(inout), optional :: added
      integer(c_int32_t) :: answer
    end function mpm_surface_refine

    !> The number of markers; 0 for NULL.
    function mpm_surface_count(surface) bind(c, name="mpm_surface_count") result(answer)
      import
      type(c_ptr), value :: surface
      integer(c_int64_t) :: answer
    end function mpm_surface_count

    !> Copies a field of n markers into out, [components][n]. ids are [n], or NULL for all markers by ascending id,
    !! where n is mpm_surface_count(). type and components must match the field. | field             | type | components
    !! | what it is                                              | set |
    !! |-------------------|------|------------|---------------------------------------------------------|-----| | "id"
    !! | I64  | 1          |                                                         |     | | "position"        | F64
    !! | dim        | length                                                  | yes | | "area"            | F64  | dim
    !! | area vector, out of the material                        | yes | | "reference_area"  | F64  | 1          | area
    !! when it was added or set                           |     | | "displacement"    | F64  | dim        | since it was
    !! added, across periodic axes too            | yes | | "velocity"        | F64  | dim        | of the material
    !! there, in the last step                 |     | | "force"           | F64  | dim        | on the material, in the
    !! last step                       |     | | "pressure"        | F64  | 1          | of this marker, beside
    !! mpm_surface_desc.pressure        | yes | | "traction"        | F64  | dim        | likewise
    !! | yes | | "dead_traction"   | F64  | dim        | likewise                                                | yes |
    !! | "prescribed_velocity" | F64 | dim     | of this marker, beside mpm_surface_desc.velocity        | yes | |
    !! "reaction"        | F64  | dim        | force of what is prescribed on the material, last step  |     | | "gap"
    !! | F64  | dim        | implicit steps: way of the material off what it should  |     | MPM_E_NOT_FOUND: there is
    !! no such field or id.
    function mpm_surface_get(surface, field, type, components, n, ids, out) bind(c, name="mpm_surface_get") &
        result(answer)
      import
      type(c_ptr), value :: surface
      character(kind=c_char), intent(in) :: field(*)
      integer(c_int32_t), value :: type
      integer(c_int32_t), value :: components
      integer(c_int64_t), value :: n
      integer(c_int64_t), intent(in), optional :: ids(*)
      type(*), intent(inout) :: out(*)
      integer(c_int32_t) :: answer
    end function mpm_surface_get

    !> Copies values into a field, laid out as in mpm_surface_get(): all or none.
    function mpm_surface_set(surface, field, type, components, n, ids, values) bind(c, name="mpm_surface_set") &
        result(answer)
      import
      type(c_ptr), value :: surface
      character(kind=c_char), intent(in) :: field(*)
      integer(c_int32_t), value :: type
      integer(c_int32_t), value :: components
      integer(c_int64_t), value :: n
      integer(c_int64_t), intent(in), optional :: ids(*)
      type(*), intent(in) :: values(*)
      integer(c_int32_t) :: answer
    end function mpm_surface_set

    !> Puts a surface into a stepper.
    function mpm_stepper_add_surface(stepper, surface) bind(c, name="mpm_stepper_add_surface") result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_ptr), value :: surface
      integer(c_int32_t) :: answer
    end function mpm_stepper_add_surface

    !> Takes a surface out; it keeps its markers.
    function mpm_stepper_remove_surface(stepper, surface) bind(c, name="mpm_stepper_remove_surface") result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_ptr), value :: surface
      integer(c_int32_t) :: answer
    end function mpm_stepper_remove_surface

    !> Gives the force[dim] by which what a surface prescribes acts on the material: the mean over the last step, the
    !! sum of "reaction" over the markers; 0 for a surface that prescribes nothing.
    function mpm_stepper_surface_reaction(stepper, surface, force) bind(c, name="mpm_stepper_surface_reaction") &
        result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_ptr), value :: surface
      real(c_double), intent(inout) :: force(*)
      integer(c_int32_t) :: answer
    end function mpm_stepper_surface_reaction

    !> Gives the impulse[dim] of it on the material, mass * length/time: the sum of mpm_stepper_surface_reaction() times
    !! the time over which it acted, over all committed steps since the surface was added or mpm_stepper_set_time() was
    !! called.
    function mpm_stepper_surface_impulse(stepper, surface, impulse) bind(c, name="mpm_stepper_surface_impulse") &
        result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_ptr), value :: surface
      real(c_double), intent(inout) :: impulse(*)
      integer(c_int32_t) :: answer
    end function mpm_stepper_surface_impulse

    !> Fills desc with the defaults. struct_size is sizeof(mpm_adaption_desc) of the caller; no byte beyond is written.
    function mpm_adaption_desc_init(desc, struct_size) bind(c, name="mpm_adaption_desc_init") result(answer)
      import
      type(mpm_adaption_desc), intent(inout) :: desc
      integer(c_int32_t), value :: struct_size
      integer(c_int32_t) :: answer
    end function mpm_adaption_desc_init

    !> Describes how a set of the stepper adapts, for the steps that follow; NULL: no longer.
    function mpm_stepper_set_adaption(stepper, particles, desc) bind(c, name="mpm_stepper_set_adaption") &
        result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_ptr), value :: particles
      type(mpm_adaption_desc), intent(in), optional :: desc
      integer(c_int32_t) :: answer
    end function mpm_stepper_set_adaption

    !> Adapts all sets that are described, now and whatever `every` is.
    function mpm_stepper_adapt(stepper) bind(c, name="mpm_stepper_adapt") result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t) :: answer
    end function mpm_stepper_adapt

    !> Tells what adaption has done to a set.
    function mpm_stepper_adaption_info(stepper, particles, info) bind(c, name="mpm_stepper_adaption_info") &
        result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_ptr), value :: particles
      type(mpm_adaption_info), intent(inout) :: info
      integer(c_int32_t) :: answer
    end function mpm_stepper_adaption_info

    !> Fills desc with the defaults. struct_size is sizeof(mpm_heat_desc) of the caller; no byte beyond is written.
    function mpm_heat_desc_init(desc, struct_size) bind(c, name="mpm_heat_desc_init") result(answer)
      import
      type(mpm_heat_desc), intent(inout) :: desc
      integer(c_int32_t), value :: struct_size
      integer(c_int32_t) :: answer
    end function mpm_heat_desc_init

    !> Describes the heat of a set of the stepper, for the steps that follow; NULL: it has none any more, and its fields
    !! stay as fields of the host.
    function mpm_stepper_set_heat(stepper, particles, desc) bind(c, name="mpm_stepper_set_heat") result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_ptr), value :: particles
      type(mpm_heat_desc), intent(in), optional :: desc
      integer(c_int32_t) :: answer
    end function mpm_stepper_set_heat

    !> Chooses how the nodes conduct, from MPM_CONDUCTION_EXPLICIT (as made) on. tolerance: of the residual of conjugate
    !! gradients, relative to the right-hand side; > 0 and < 1; not read with explicit conduction.
    function mpm_stepper_set_conduction(stepper, conduction, tolerance) bind(c, name="mpm_stepper_set_conduction") &
        result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t), value :: conduction
      real(c_double), value :: tolerance
      integer(c_int32_t) :: answer
    end function mpm_stepper_set_conduction

    !> Says what a face does to heat, whatever kind of wall it has. kind: MPM_HEAT_WALL_...; the temperature is not read
    !! of insulated ones, which all faces are from the start.
    function mpm_stepper_set_heat_wall(stepper, face, kind, temperature) bind(c, name="mpm_stepper_set_heat_wall") &
        result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t), value :: face
      integer(c_int32_t), value :: kind
      real(c_double), value :: temperature
      integer(c_int32_t) :: answer
    end function mpm_stepper_set_heat_wall

    !> Heats what lies below a surface, per area of its markers: flux + film (ambient - temperature of the material),
    !! power/area into the material; film is >= 0.
    function mpm_surface_set_heat(surface, flux, film, ambient) bind(c, name="mpm_surface_set_heat") result(answer)
      import
      type(c_ptr), value :: surface
      real(c_double), value :: flux
      real(c_double), value :: film
      real(c_double), value :: ambient
      integer(c_int32_t) :: answer
    end function mpm_surface_set_heat

    !> Tells where heat came from.
    function mpm_stepper_heat_info(stepper, info) bind(c, name="mpm_stepper_heat_info") result(answer)
      import
      type(c_ptr), value :: stepper
      type(mpm_heat_info), intent(inout) :: info
      integer(c_int32_t) :: answer
    end function mpm_stepper_heat_info

    !> Tells how many bytes mpm_state_save() needs now; of several parts, those of this part's piece (collective).
    function mpm_state_size(stepper, bytes) bind(c, name="mpm_state_size") result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int64_t), intent(inout) :: bytes
      integer(c_int32_t) :: answer
    end function mpm_state_size

    !> Writes the state into the host's buffer of capacity bytes; of several parts, this part's piece (collective).
    function mpm_state_save(stepper, buffer, capacity) bind(c, name="mpm_state_save") result(answer)
      import
      type(c_ptr), value :: stepper
      type(*), intent(inout) :: buffer(*)
      integer(c_int64_t), value :: capacity
      integer(c_int32_t) :: answer
    end function mpm_state_save

    !> Replaces the state by one saved with mpm_state_save(), of so many bytes; the buffer is read during the call.
    function mpm_state_load(stepper, buffer, bytes) bind(c, name="mpm_state_load") result(answer)
      import
      type(c_ptr), value :: stepper
      type(*), intent(in) :: buffer(*)
      integer(c_int64_t), value :: bytes
      integer(c_int32_t) :: answer
    end function mpm_state_load

    !> Replaces the state by one in pieces (collective).
    function mpm_state_load_pieces(stepper, count, piece, bytes) bind(c, name="mpm_state_load_pieces") result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t), value :: count
      type(c_ptr), intent(in), optional :: piece(*)
      integer(c_int64_t), intent(in), optional :: bytes(*)
      integer(c_int32_t) :: answer
    end function mpm_state_load_pieces

    !> Writes the state into a file, as mpm_state_save() does into memory, and waits for the storage: path holds the old
    !! state or the new one.
    function mpm_state_save_file(stepper, path) bind(c, name="mpm_state_save_file") result(answer)
      import
      type(c_ptr), value :: stepper
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int32_t) :: answer
    end function mpm_state_save_file

    !> Gives the bytes of mpm_state_save() to a callback.
    function mpm_state_save_to(stepper, write, user) bind(c, name="mpm_state_save_to") result(answer)
      import
      type(c_ptr), value :: stepper
      type(c_funptr), value :: write
      type(c_ptr), value :: user
      integer(c_int32_t) :: answer
    end function mpm_state_save_to

    !> Replaces the state by one from a file.
    function mpm_state_load_file(stepper, path) bind(c, name="mpm_state_load_file") result(answer)
      import
      type(c_ptr), value :: stepper
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int32_t) :: answer
    end function mpm_state_load_file

    !> Gives a hash of time, step, every field of every set, the pose of every obstacle and every marker of surfaces.
    function mpm_state_hash(stepper, hash) bind(c, name="mpm_state_hash") result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int64_t), intent(inout) :: hash
      integer(c_int32_t) :: answer
    end function mpm_state_hash

    !> Writes a set as VTK poly data (.vtp, appended raw): points in order of ascending id, and count named fields as
    !! point data, with full tensors and, in 2-D and 3-D, with three components per vector.
    function mpm_write_particles(particles, path, count, fields) bind(c, name="mpm_write_particles") result(answer)
      import
      type(c_ptr), value :: particles
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int32_t), value :: count
      type(c_ptr), intent(in), optional :: fields(*)
      integer(c_int32_t) :: answer
    end function mpm_write_particles

    !> Gives the bytes of the file that mpm_write_particles() would write to a callback, with memory for one piece.
    function mpm_write_particles_to(particles, write, user, count, fields) bind(c, name="mpm_write_particles_to") &
        result(answer)
      import
      type(c_ptr), value :: particles
      type(c_funptr), value :: write
      type(c_ptr), value :: user
      integer(c_int32_t), value :: count
      type(c_ptr), intent(in), optional :: fields(*)
      integer(c_int32_t) :: answer
    end function mpm_write_particles_to

    !> Writes nodal fields of the last step, or of a staged step while one is under way, over the box of the active
    !! nodes: as VTK image data (.vti, appended raw), or with open knots, whose nodes are not evenly spaced at the
    !! faces, as a rectilinear grid (.vtr).
    function mpm_write_grid(stepper, path, count, fields) bind(c, name="mpm_write_grid") result(answer)
      import
      type(c_ptr), value :: stepper
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int32_t), value :: count
      type(c_ptr), intent(in), optional :: fields(*)
      integer(c_int32_t) :: answer
    end function mpm_write_grid

    !> Does as mpm_write_grid() for the nodes of one body; that one writes those of body 0.
    function mpm_write_body_grid(stepper, body, path, count, fields) bind(c, name="mpm_write_body_grid") &
        result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t), value :: body
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int32_t), value :: count
      type(c_ptr), intent(in), optional :: fields(*)
      integer(c_int32_t) :: answer
    end function mpm_write_body_grid

    !> Gives the bytes of the file that mpm_write_body_grid() would write to a callback.
    function mpm_write_grid_to(stepper, body, write, user, count, fields) bind(c, name="mpm_write_grid_to") &
        result(answer)
      import
      type(c_ptr), value :: stepper
      integer(c_int32_t), value :: body
      type(c_funptr), value :: write
      type(c_ptr), value :: user
      integer(c_int32_t), value :: count
      type(c_ptr), intent(in), optional :: fields(*)
      integer(c_int32_t) :: answer
    end function mpm_write_grid_to

    !> Starts a series in a new file at path, where it replaces an old one. *out is NULL unless MPM_OK is returned.
    function mpm_series_open(context, path, out) bind(c, name="mpm_series_open") result(answer)
      import
      type(c_ptr), value :: context
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr), intent(out) :: out
      integer(c_int32_t) :: answer
    end function mpm_series_open

    !> Appends an output file to the series at time t. file is its path as it is to stand in the series: relative to the
    !! series' own file.
    function mpm_series_append(series, t, file) bind(c, name="mpm_series_append") result(answer)
      import
      type(c_ptr), value :: series
      real(c_double), value :: t
      character(kind=c_char), intent(in) :: file(*)
      integer(c_int32_t) :: answer
    end function mpm_series_append

    !> Ends the series and frees it.
    function mpm_series_close(series) bind(c, name="mpm_series_close") result(answer)
      import
      type(c_ptr), value :: series
      integer(c_int32_t) :: answer
    end function mpm_series_close

  end interface

  !> Readies a struct: a descriptor gets the library's defaults, an output its struct_size and zeros.
  interface mpm_init
    module procedure init_mpm_view
    module procedure init_mpm_balance_desc
    module procedure init_mpm_parallel_info
    module procedure init_mpm_context_desc
    module procedure init_mpm_grid_desc
    module procedure init_mpm_material_batch
    module procedure init_mpm_material_desc
    module procedure init_mpm_operator_info
    module procedure init_mpm_stepper_desc
    module procedure init_mpm_step_info
    module procedure init_mpm_advance_desc
    module procedure init_mpm_profile
    module procedure init_mpm_contact_desc
    module procedure init_mpm_contact_info
    module procedure init_mpm_obstacle_desc
    module procedure init_mpm_surface_desc
    module procedure init_mpm_adaption_desc
    module procedure init_mpm_adaption_info
    module procedure init_mpm_heat_desc
    module procedure init_mpm_heat_info
  end interface mpm_init

  private :: init_mpm_view, init_mpm_balance_desc, init_mpm_parallel_info, init_mpm_context_desc, init_mpm_grid_desc, &
      init_mpm_material_batch, init_mpm_material_desc, init_mpm_operator_info, init_mpm_stepper_desc, &
      init_mpm_step_info, init_mpm_advance_desc, init_mpm_profile, init_mpm_contact_desc, init_mpm_contact_info, &
      init_mpm_obstacle_desc, init_mpm_surface_desc, init_mpm_adaption_desc, init_mpm_adaption_info, &
      init_mpm_heat_desc, init_mpm_heat_info

contains

  subroutine init_mpm_view(it)
    type(mpm_view), intent(out) :: it
    it%struct_size = int(c_sizeof(it), c_int32_t)
    it%type = 0
    it%components = 0
    it%access = 0
    it%count = 0
    it%item_stride = 0
    it%component_stride = 0
    it%data = c_null_ptr
    it%owner = c_null_ptr
  end subroutine init_mpm_view

  subroutine init_mpm_balance_desc(it)
    type(mpm_balance_desc), intent(out) :: it
    if (mpm_balance_desc_init(it, int(c_sizeof(it), c_int32_t)) /= MPM_OK) error stop "libmpm is older than the module mpm"
  end subroutine init_mpm_balance_desc

  subroutine init_mpm_parallel_info(it)
    type(mpm_parallel_info), intent(out) :: it
    it%struct_size = int(c_sizeof(it), c_int32_t)
    it%neighbours = 0
    it%blocks = 0
    it%boundary = 0
    it%ghosts = 0
    it%bytes_nodes = 0
    it%bytes_moved = 0
    it%moved = 0
    it%cuts = 0
    it%imbalance = 0.0_c_double
    it%seconds_packing = 0.0_c_double
    it%seconds_waiting = 0.0_c_double
    it%seconds_reducing = 0.0_c_double
  end subroutine init_mpm_parallel_info

  subroutine init_mpm_context_desc(it)
    type(mpm_context_desc), intent(out) :: it
    if (mpm_context_desc_init(it, int(c_sizeof(it), c_int32_t)) /= MPM_OK) error stop "libmpm is older than the module mpm"
  end subroutine init_mpm_context_desc

  subroutine init_mpm_grid_desc(it)
    type(mpm_grid_desc), intent(out) :: it
    if (mpm_grid_desc_init(it, int(c_sizeof(it), c_int32_t)) /= MPM_OK) error stop "libmpm is older than the module mpm"
  end subroutine init_mpm_grid_desc

  subroutine init_mpm_material_batch(it)
    type(mpm_material_batch), intent(out) :: it
    it%struct_size = int(c_sizeof(it), c_int32_t)
    it%state_count = 0
    it%n = 0
    it%ld = 0
    it%t = 0.0_c_double
    it%dt = 0.0_c_double
    it%id = c_null_ptr
    it%F = c_null_ptr
    it%F_inc = c_null_ptr
    it%L = c_null_ptr
    it%stress = c_null_ptr
    it%state = c_null_ptr
    it%stress_new = c_null_ptr
    it%state_new = c_null_ptr
    it%wave_speed = c_null_ptr
    it%kinematic_viscosity = c_null_ptr
    it%energy = c_null_ptr
    it%position = c_null_ptr
    it%lookup = c_null_ptr
  end subroutine init_mpm_material_batch

  subroutine init_mpm_material_desc(it)
    type(mpm_material_desc), intent(out) :: it
    if (mpm_material_desc_init(it, int(c_sizeof(it), c_int32_t)) /= MPM_OK) error stop "libmpm is older than the module mpm"
  end subroutine init_mpm_material_desc

  subroutine init_mpm_operator_info(it)
    type(mpm_operator_info), intent(out) :: it
    it%struct_size = int(c_sizeof(it), c_int32_t)
    it%block = 0
    it%symmetric = 0
    it%positive_definite = 0
    it%rows = 0
    it%nonzeros = 0
    it%pattern_id = 0
    it%ld = 0
    it%node = c_null_ptr
    it%component = c_null_ptr
    it%position = c_null_ptr
    it%first_row = 0
    it%owned_rows = 0
    it%all_rows = 0
    it%number = c_null_ptr
  end subroutine init_mpm_operator_info

  subroutine init_mpm_stepper_desc(it)
    type(mpm_stepper_desc), intent(out) :: it
    if (mpm_stepper_desc_init(it, int(c_sizeof(it), c_int32_t)) /= MPM_OK) error stop "libmpm is older than the module mpm"
  end subroutine init_mpm_stepper_desc

  subroutine init_mpm_step_info(it)
    type(mpm_step_info), intent(out) :: it
    it%struct_size = int(c_sizeof(it), c_int32_t)
    it%cause = 0
    it%callback_status = 0
    it%newton_iterations = 0
    it%linear_solver = 0
    it%set = 0
    it%step = 0
    it%active_nodes = 0
    it%removed = 0
    it%resorts = 0
    it%particle = 0
    it%node = 0
    it%linear_iterations = 0
    it%t = 0.0_c_double
    it%dt = 0.0_c_double
    it%dt_suggested = 0.0_c_double
    it%residual = 0.0_c_double
    it%kinetic_energy = 0.0_c_double
    it%strain_energy = 0.0_c_double
    it%external_work = 0.0_c_double
    it%dissipation = 0.0_c_double
    it%momentum = 0.0_c_double
    it%angular_momentum = 0.0_c_double
    it%external_work_total = 0.0_c_double
    it%affine_kinetic_energy = 0.0_c_double
    it%contact_dissipation = 0.0_c_double
    it%contact_nodes = 0
    it%body = 0
    it%reserved = 0
    it%damping_dissipation = 0.0_c_double
    it%damping_dissipation_total = 0.0_c_double
  end subroutine init_mpm_step_info

  subroutine init_mpm_advance_desc(it)
    type(mpm_advance_desc), intent(out) :: it
    if (mpm_advance_desc_init(it, int(c_sizeof(it), c_int32_t)) /= MPM_OK) error stop "libmpm is older than the module mpm"
  end subroutine init_mpm_advance_desc

  subroutine init_mpm_profile(it)
    type(mpm_profile), intent(out) :: it
    it%struct_size = int(c_sizeof(it), c_int32_t)
    it%reserved = 0
    it%sort = 0.0_c_double
    it%p2g = 0.0_c_double
    it%grid = 0.0_c_double
    it%g2p = 0.0_c_double
    it%law = 0.0_c_double
    it%assembly = 0.0_c_double
    it%factor = 0.0_c_double
    it%solve = 0.0_c_double
    it%callbacks = 0.0_c_double
    it%total = 0.0_c_double
    it%weights = 0.0_c_double
  end subroutine init_mpm_profile

  subroutine init_mpm_contact_desc(it)
    type(mpm_contact_desc), intent(out) :: it
    if (mpm_contact_desc_init(it, int(c_sizeof(it), c_int32_t)) /= MPM_OK) error stop "libmpm is older than the module mpm"
  end subroutine init_mpm_contact_desc

  subroutine init_mpm_contact_info(it)
    type(mpm_contact_info), intent(out) :: it
    it%struct_size = int(c_sizeof(it), c_int32_t)
    it%touching = 0
    it%nodes = 0
    it%closed = 0
    it%stuck = 0
    it%ambiguous = 0
    it%force = 0.0_c_double
    it%torque = 0.0_c_double
    it%normal_force = 0.0_c_double
    it%area = 0.0_c_double
    it%pressure_max = 0.0_c_double
    it%gap = 0.0_c_double
    it%dissipation = 0.0_c_double
    it%friction_work = 0.0_c_double
    it%impulse = 0.0_c_double
  end subroutine init_mpm_contact_info

  subroutine init_mpm_obstacle_desc(it)
    type(mpm_obstacle_desc), intent(out) :: it
    if (mpm_obstacle_desc_init(it, int(c_sizeof(it), c_int32_t)) /= MPM_OK) error stop "libmpm is older than the module mpm"
  end subroutine init_mpm_obstacle_desc

  subroutine init_mpm_surface_desc(it)
    type(mpm_surface_desc), intent(out) :: it
    if (mpm_surface_desc_init(it, int(c_sizeof(it), c_int32_t)) /= MPM_OK) error stop "libmpm is older than the module mpm"
  end subroutine init_mpm_surface_desc

  subroutine init_mpm_adaption_desc(it)
    type(mpm_adaption_desc), intent(out) :: it
    if (mpm_adaption_desc_init(it, int(c_sizeof(it), c_int32_t)) /= MPM_OK) error stop "libmpm is older than the module mpm"
  end subroutine init_mpm_adaption_desc

  subroutine init_mpm_adaption_info(it)
    type(mpm_adaption_info), intent(out) :: it
    it%struct_size = int(c_sizeof(it), c_int32_t)
    it%reserved = 0
    it%splits = 0
    it%added = 0
    it%merges = 0
    it%kinetic_loss = 0.0_c_double
    it%affine_loss = 0.0_c_double
    it%strain_loss = 0.0_c_double
    it%angular_momentum_loss = 0.0_c_double
  end subroutine init_mpm_adaption_info

  subroutine init_mpm_heat_desc(it)
    type(mpm_heat_desc), intent(out) :: it
    if (mpm_heat_desc_init(it, int(c_sizeof(it), c_int32_t)) /= MPM_OK) error stop "libmpm is older than the module mpm"
  end subroutine init_mpm_heat_desc

  subroutine init_mpm_heat_info(it)
    type(mpm_heat_info), intent(out) :: it
    it%struct_size = int(c_sizeof(it), c_int32_t)
    it%iterations = 0
    it%heat = 0.0_c_double
    it%gained = 0.0_c_double
    it%walls = 0.0_c_double
    it%sources = 0.0_c_double
    it%surfaces = 0.0_c_double
    it%dissipated = 0.0_c_double
    it%gained_total = 0.0_c_double
    it%walls_total = 0.0_c_double
    it%sources_total = 0.0_c_double
    it%surfaces_total = 0.0_c_double
    it%dissipated_total = 0.0_c_double
  end subroutine init_mpm_heat_info

end module mpm
