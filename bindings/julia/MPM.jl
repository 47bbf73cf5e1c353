# Generated from the headers of libmpm by `make api`; not to be edited.
"""
libmpm, the Material Point Method, from Julia: the functions, structs and constants of its headers, by their names there.
bindings/julia/README.md says how C and Julia differ.
"""
module MPM

"The library: the variable MPM_LIBRARY names another file."
const libmpm = get(ENV, "MPM_LIBRARY", "libmpm")

"A call was not done: the status of C, and the library's sentence."
struct MpmError <: Exception
    status::Int32
    text::String
end
Base.showerror(io::IO, error::MpmError) = print(io, error.text, " (", unsafe_string(mpm_status_name(error.status)), ")")

"Throws MpmError where a call on a context was not done."
function check(context, status)
    if status != MPM_OK
        throw(MpmError(status, unsafe_string(mpm_last_error(context))))
    end
    return nothing
end

"An array that C lends in a batch: [components][ld], of which the first n items count, as a matrix of ld rows."
function columns(data, ld, components)
    return unsafe_wrap(Array, Ptr{eltype(data)}(data), (Int(ld), Int(components)))
end

"A struct whose bytes are all 0."
function zeroed(::Type{T}) where {T}
    it = T()
    GC.@preserve it begin
        ccall(:memset, Ptr{Cvoid}, (Ptr{Cvoid}, Cint, Csize_t), pointer_from_objref(it), 0, sizeof(T))
    end
    return it
end

"Version of the headers that the module was made from, to be compared with mpm_version()."
const MPM_VERSION = 0x000100

# Status values. After a positive one the state is as it was before the call. A smaller dt may cure 1..5.
const MPM_OK = Int32(0) # the call did what it was asked to
const MPM_CUT_DT = Int32(1) # a callback, a law or contact asked for a smaller step
const MPM_INVERTED = Int32(2) # det F <= 0 at a particle
const MPM_NONFINITE = Int32(3) # a NaN or an infinity appeared
const MPM_NOT_CONVERGED = Int32(4) # the Newton iteration did not converge
const MPM_SINGULAR = Int32(5) # the linear system is singular, or indefinite beyond repair
const MPM_OFF_GRID = Int32(6) # a particle would leave through a face that does not let it
const MPM_CANCELLED = Int32(7) # the progress callback ended the call
const MPM_E_ARG = Int32(-1) # an argument is NULL, out of range or inconsistent
const MPM_E_NOMEM = Int32(-2) # the allocator returned NULL
const MPM_E_STATE = Int32(-3) # not allowed now
const MPM_E_CALLBACK = Int32(-4) # a callback returned < 0, or the host's executor failed
const MPM_E_UNSUPPORTED = Int32(-5) # this version does not offer the combination or the extension
const MPM_E_NOT_FOUND = Int32(-6) # there is no such name, id or index; the text lists the nearest names
const MPM_E_IO = Int32(-7) # a file could not be opened, read or written
const MPM_E_FORMAT = Int32(-8) # data are damaged, of another kind, or from an unlike setup
const MPM_E_INTERNAL = Int32(-99) # the library itself is at fault

# Basis functions of the grid. Here h is the edge of a cell.
const MPM_LINEAR = Int32(1) # piecewise linear functions, 2h wide
const MPM_BSPLINE2 = Int32(2) # Quadratic B-splines, 3h wide
const MPM_BSPLINE3 = Int32(3) # cubic B-splines, 4h wide
const MPM_GIMP = Int32(16) # GIMP on domains of edges "size", at most a cell
const MPM_UGIMP = Int32(17) # GIMP on domains that all have edges of smoothing * spacing
const MPM_CPGIMP = Int32(18) # GIMP on domains of edges "size" * |F_ii|, at most a cell; depends on the axes

# What B-splines do at the faces of the grid: Steffen et al. 2008, section 3.2.
const MPM_BOUNDARY_GHOST = Int32(0) # splines are the same everywhere, with nodes outside the faces
const MPM_BOUNDARY_OPEN_KNOT = Int32(1) # Knots are repeated degree + 1 times at the faces, where one function alone is then 1

# What lies across the plane of a 2-D grid.
const MPM_PLANE_STRAIN = Int32(0) # a slab of unit thickness that keeps its thickness
const MPM_AXISYMMETRIC = Int32(1) # A body of revolution
const MPM_PLANE_STRESS = Int32(2) # A sheet of unit thickness at the start, without a stress across it

# Time integration scheme.
const MPM_USL = Int32(1) # Explicit, with stresses updated last
const MPM_USF = Int32(2) # Explicit, with stresses updated first, by the strain from the velocities at the start of the step
const MPM_MUSL = Int32(3) # As MPM_USL, but velocities are projected a second time before stresses are updated.
const MPM_NEWMARK = Int32(16) # Implicit, by Newmark's rule

# Transfer of velocity between particles and grid.
const MPM_FLIP = Int32(1) # FLIP, PIC, and their blend by the field flip
const MPM_APIC = Int32(2) # affine, with the inertia of each axis and particle, for any basis
const MPM_TPIC = Int32(3) # projects the velocity gradient too (MPoint theory, eq
const MPM_TFLIP = Int32(4) # projects the velocity gradient too (MPoint theory, eq
const MPM_AFLIP = Int32(5) # affine projection with the FLIP blend
const MPM_XPIC = Int32(6) # XPIC(m), where m is xpic_order
const MPM_APIC_MLS = Int32(7) # Affine by moving least squares, with constant inertia and one fused matrix, for quadratic and cubic B-splines with ghosts or periodic axes
const MPM_FMPM = Int32(8) # FMPM(k), where k is xpic_order

# Instruction set of the kernels. Results of two sets agree to round-off, those of one set to the bit.
const MPM_ISA_BEST = Int32(0) # the best one that both the processor and the library have
const MPM_ISA_BASELINE = Int32(1) # the one that the library was compiled for
const MPM_ISA_AVX2 = Int32(2) # AVX2 with FMA, on x86-64
const MPM_ISA_AVX512 = Int32(3) # AVX-512 (F, DQ, VL), on x86-64
const MPM_ISA_NEON = Int32(4) # NEON with FMA, on aarch64
const MPM_ISA_PORTABLE = MPM_ISA_BASELINE # the baseline by its promise

# Level of a log text.
const MPM_LOG_WARNING = Int32(1) # the host should look at it
const MPM_LOG_INFO = Int32(2) # a rare event
const MPM_LOG_DEBUG = Int32(3) # a text in every step

# Remedy against volumetric locking: MPoint theory, eqs 47-53, carried to the deformation gradient.
const MPM_LOCKING_NONE = Int32(0) # there is no remedy
const MPM_LOCKING_CELL_AVERAGE = Int32(1) # The law sees the dilation averaged over the cell, weighted by volume

# Form of a law's tangent. The value is the number of components. See mpm_tangent_fn.
const MPM_TANGENT_MINOR_SYMMETRIC = Int32(36) # 6 x 6 components, in Voigt's notation
const MPM_TANGENT_GENERAL = Int32(81) # 9 x 9 components

# Faces of the grid.
const MPM_X_MIN = Int32(0) # lower face across x
const MPM_X_MAX = Int32(1) # upper face across x
const MPM_Y_MIN = Int32(2) # lower face across y
const MPM_Y_MAX = Int32(3) # upper face across y
const MPM_Z_MIN = Int32(4) # lower face across z
const MPM_Z_MAX = Int32(5) # upper face across z

# What a face of the grid does.
const MPM_WALL_NONE = Int32(0) # default
const MPM_WALL_OPEN = Int32(1) # a particle that leaves is removed; refused with total_lagrangian = 1
const MPM_WALL_FIXED = Int32(2) # velocities at the face are zero
const MPM_WALL_SLIP = Int32(3) # a symmetry plane
const MPM_WALL_FRICTION = Int32(4) # the plane of the face as a fixed obstacle with Coulomb friction (obstacle.h)
const MPM_WALL_FRICTION_NODES = Int32(5) # contact of the nodes on the face with Coulomb friction

# What a surface prescribes of the motion of the material at its markers. See mpm_surface_desc.
const MPM_PRESCRIBES_NOTHING = Int32(0) # default
const MPM_PRESCRIBES_VELOCITY = Int32(1) # all components
const MPM_PRESCRIBES_NORMAL = Int32(2) # that along the area vector

# Where in an explicit step a node hook runs.
const MPM_AFTER_P2G = Int32(1) # mass and velocity are projected, forces are not yet known
const MPM_AFTER_FORCES = Int32(2) # internal and external forces are complete
const MPM_AFTER_VELOCITY = Int32(3) # velocity is updated, and walls and prescribed velocities have acted on it

# Access to mapped memory. The values may be combined with |.
const MPM_READ = Int32(1) # the host reads
const MPM_WRITE = Int32(2) # the host writes

# Type of a field's elements.
const MPM_F64 = Int32(1) # double
const MPM_I64 = Int32(2) # int64_t
const MPM_U8 = Int32(3) # uint8_t

# Order of the particles in mpm_particles_get_f32().
const MPM_BY_ID = Int32(1) # by ascending id
const MPM_LIBRARY_ORDER = Int32(2) # as they lie in memory, without inert slots; changes when they are sorted anew

# Linear solver of an implicit step.
const MPM_SOLVER_AUTO = Int32(0) # the library chooses by size, stencil, symmetry and inertia; with a transport as parallel.h says
const MPM_SOLVER_CG = Int32(1) # conjugate gradients, for symmetric positive definite systems
const MPM_SOLVER_MULTIGRID_CG = Int32(2) # conjugate gradients with geometric multigrid, for the same systems
const MPM_SOLVER_LDLT = Int32(3) # a direct solver, for symmetric systems that may be indefinite
const MPM_SOLVER_GMRES = Int32(4) # GMRES, for systems that are not symmetric
const MPM_SOLVER_HOST = Int32(100) # the callback of mpm_stepper_set_linear_solver()

# How much of an exchange its receivers know beforehand.
const MPM_EXCHANGE_KNOWN = Int32(1) # both sides know who sends to whom
const MPM_EXCHANGE_SPARSE = Int32(2) # receivers do not know from whom

# What mpm_reduce_fn does. There is no sum of floating-point numbers: it would depend on the parts.
const MPM_REDUCE_MAX = Int32(1) # the largest of all parts
const MPM_REDUCE_SUM = Int32(2) # the sum, modulo 2^64

# How two bodies meet: mpm_contact_desc.kind.
const MPM_CONTACT_UNILATERAL = Int32(0) # they push each other and never pull, with Coulomb friction (default)
const MPM_CONTACT_NONE = Int32(1) # they pass through each other
const MPM_CONTACT_TIED = Int32(2) # neither slip nor separation at nodes that both have

# How the normal at a node is found: mpm_contact_desc.normal. One plane parts two bodies at a node: what is thinner
# than two cells and lies between two faces of one other body is gripped by it.
const MPM_NORMAL_LOGISTIC = Int32(0) # of the plane that separates the particles best
const MPM_NORMAL_DISCRIMINANT = Int32(1) # of Fisher's linear discriminant
const MPM_NORMAL_GRADIENT = Int32(2) # of the mean gradient of volume
const MPM_NORMAL_FIXED = Int32(3) # mpm_contact_desc.direction

# How it is found that bodies touch: mpm_contact_desc.detection.
const MPM_DETECT_DEFAULT = Int32(0) # MPM_DETECT_GAP, but MPM_DETECT_VELOCITY with MPM_NORMAL_GRADIENT, whose directions are too far off to measure a gap along them
const MPM_DETECT_GAP = Int32(1) # by the gap between their particles
const MPM_DETECT_VELOCITY = Int32(2) # by velocity alone

# In place of a body: all of them.
const MPM_BODY_ANY = Int32(-1) # any body that has no closer rule; all of them in reports

# Shapes: mpm_obstacle_desc.shape. Lengths are mpm_obstacle_desc.size; axes are those of the body.
const MPM_SHAPE_PLANE = Int32(1) # a half-space; outward normal
const MPM_SHAPE_SPHERE = Int32(2) # size[0]
const MPM_SHAPE_CYLINDER = Int32(3) # around axis z; size[0]
const MPM_SHAPE_CAPSULE = Int32(4) # around axis z; size[0]
const MPM_SHAPE_BOX = Int32(5) # size
const MPM_SHAPE_DISTANCE = Int32(64) # what mpm_obstacle_desc.distance says

# How an obstacle moves: mpm_obstacle_desc.motion.
const MPM_MOTION_FIXED = Int32(0) # not at all (default)
const MPM_MOTION_PRESCRIBED = Int32(1) # by its velocities, which the host may change from step to step
const MPM_MOTION_FREE = Int32(2) # as a rigid body under contact, gravity and the host's load

# What a batch of mpm_adaption_fn is about.
const MPM_ADAPT_SPLIT = Int32(0) # particles that are to be split
const MPM_ADAPT_MERGE = Int32(1) # pairs that are to become one particle

# How the nodes conduct.
const MPM_CONDUCTION_EXPLICIT = Int32(0) # By the temperatures at the start of the step
const MPM_CONDUCTION_IMPLICIT = Int32(1) # By those at its end (backward Euler), found by conjugate gradients

# What a face of the grid does to heat.
const MPM_HEAT_WALL_INSULATED = Int32(0) # lets none through
const MPM_HEAT_WALL_TEMPERATURE = Int32(1) # material at it has a prescribed temperature

"""
A context holds the services of the host (memory, threads, log) and the text of the last error. Every other object is
made with one. See context.h.
"""
mutable struct mpm_context end

"""
A background grid has a dimension, bounds, spacings, a basis and periodic axes. See grid.h.
"""
mutable struct mpm_grid end

"""
A material is one constitutive law with its parameters. Any number of sets share it. See material.h.
"""
mutable struct mpm_material end

"""
A set holds particles of one material on one grid. See particles.h.
"""
mutable struct mpm_particles end

"""
A stepper is one time loop with a grid, sets of particles, a scheme, walls and forces. See stepper.h.
"""
mutable struct mpm_stepper end

"""
The linear system of an implicit step, which the library lends to the host's solver. See operator.h.
"""
mutable struct mpm_operator end

"""
A rigid body without particles. It belongs to a context, and may be in one stepper at a time.
"""
mutable struct mpm_obstacle end

"""
Markers of a surface. It belongs to a grid, and may be in one stepper at a time.
"""
mutable struct mpm_surface end

"""
A time series of output files (.pvd); its file is valid on disk after every append.
"""
mutable struct mpm_series end

"""
A named number. The library reads the name during the call only. The struct is closed: it has no struct_size and gets
no further fields.
"""
struct mpm_param
    name::Ptr{UInt8}
    value::Float64
end

"""
Memory of the library, lent to the host until mpm_view_release(). Component c of item i is ((T *)data)[i * item_stride
+ c * component_stride], where T is the type that `type` names. The host sets struct_size before the call that fills
the view, and changes no field afterwards.
"""
mutable struct mpm_view
    struct_size::UInt32
    type_::Int32
    components::Int32
    access::Int32
    count::Int64
    item_stride::Int64
    component_stride::Int64
    data::Ptr{Cvoid}
    owner::Ptr{Cvoid}
    mpm_view() = new()
end
Base.cconvert(::Type{Ptr{mpm_view}}, it::mpm_view) = it
Base.unsafe_convert(::Type{Ptr{mpm_view}}, it::mpm_view) = Ptr{mpm_view}(pointer_from_objref(it))

"""
Bytes for, or from, another part.
"""
mutable struct mpm_message
    part::Int32
    reserved::Int32
    bytes::Int64
    data::Ptr{Cvoid}
    mpm_message() = new()
end
Base.cconvert(::Type{Ptr{mpm_message}}, it::mpm_message) = it
Base.unsafe_convert(::Type{Ptr{mpm_message}}, it::mpm_message) = Ptr{mpm_message}(pointer_from_objref(it))

"""
Ways between the parts. All are called on the calling thread. Once one has failed, every collective call of the
context returns MPM_E_CALLBACK.
"""
mutable struct mpm_transport
    struct_size::UInt32
    part::Int32
    parts::Int32
    reserved::Int32
    send::Ptr{Cvoid}
    receive::Ptr{Cvoid}
    reduce::Ptr{Cvoid}
    gather::Ptr{Cvoid}
    poll::Ptr{Cvoid}
    user::Ptr{Cvoid}
    mpm_transport() = new()
end
Base.cconvert(::Type{Ptr{mpm_transport}}, it::mpm_transport) = it
Base.unsafe_convert(::Type{Ptr{mpm_transport}}, it::mpm_transport) = Ptr{mpm_transport}(pointer_from_objref(it))

"""
How blocks of the grid are given to parts. Fill it with mpm_balance_desc_init(); all 0 are the defaults.
"""
mutable struct mpm_balance_desc
    struct_size::UInt32
    measure::Int32
    limit::Float64
    block_weight::Float64
    mpm_balance_desc() = new()
end
Base.cconvert(::Type{Ptr{mpm_balance_desc}}, it::mpm_balance_desc) = it
Base.unsafe_convert(::Type{Ptr{mpm_balance_desc}}, it::mpm_balance_desc) = Ptr{mpm_balance_desc}(pointer_from_objref(it))

"""
What one part does of a problem, and what that costs. Counts are of this part, since the stepper was made or they were
last reset; the caller sets struct_size.
"""
mutable struct mpm_parallel_info
    struct_size::UInt32
    neighbours::Int32
    blocks::Int64
    boundary::Int64
    ghosts::Int64
    bytes_nodes::Int64
    bytes_moved::Int64
    moved::Int64
    cuts::Int64
    imbalance::Float64
    seconds_packing::Float64
    seconds_waiting::Float64
    seconds_reducing::Float64
    mpm_parallel_info() = new()
end
Base.cconvert(::Type{Ptr{mpm_parallel_info}}, it::mpm_parallel_info) = it
Base.unsafe_convert(::Type{Ptr{mpm_parallel_info}}, it::mpm_parallel_info) = Ptr{mpm_parallel_info}(pointer_from_objref(it))

"""
Services of the host. Fill the struct with mpm_context_desc_init(), then change what is wanted.
"""
mutable struct mpm_context_desc
    struct_size::UInt32
    concurrency::Int32
    isa::Int32
    serial_callbacks::Int32
    alloc::Ptr{Cvoid}
    release::Ptr{Cvoid}
    alloc_user::Ptr{Cvoid}
    parallel_for::Ptr{Cvoid}
    parallel_user::Ptr{Cvoid}
    log::Ptr{Cvoid}
    log_user::Ptr{Cvoid}
    error_text::Ptr{UInt8}
    error_bytes::UInt64
    transport::Ptr{mpm_transport}
    mpm_context_desc() = new()
end
Base.cconvert(::Type{Ptr{mpm_context_desc}}, it::mpm_context_desc) = it
Base.unsafe_convert(::Type{Ptr{mpm_context_desc}}, it::mpm_context_desc) = Ptr{mpm_context_desc}(pointer_from_objref(it))

"""
Box, cells and basis of a grid. Fill the struct with mpm_grid_desc_init(). Entries of axes beyond dim are ignored.
"""
mutable struct mpm_grid_desc
    struct_size::UInt32
    dim::Int32
    basis::Int32
    boundary_basis::Int32
    periodic::NTuple{3, Int32}
    geometry::Int32
    cells::NTuple{3, Int64}
    origin::NTuple{3, Float64}
    spacing::NTuple{3, Float64}
    smoothing::Float64
    total_lagrangian::Int32
    reserved::Int32
    mpm_grid_desc() = new()
end
Base.cconvert(::Type{Ptr{mpm_grid_desc}}, it::mpm_grid_desc) = it
Base.unsafe_convert(::Type{Ptr{mpm_grid_desc}}, it::mpm_grid_desc) = Ptr{mpm_grid_desc}(pointer_from_objref(it))

"""
Particles that a law is asked about. Arrays are [components][ld], of which the first n items of each component count.
Tensors are full: F, F_inc and L have component 3 * row + column, stresses xx yy zz xy yz xz. In callbacks the memory
belongs to the library and is valid during the call, and output arrays do not overlap input arrays.
"""
mutable struct mpm_material_batch
    struct_size::UInt32
    state_count::Int32
    n::Int64
    ld::Int64
    t::Float64
    dt::Float64
    id::Ptr{Int64}
    F::Ptr{Float64}
    F_inc::Ptr{Float64}
    L::Ptr{Float64}
    stress::Ptr{Float64}
    state::Ptr{Float64}
    stress_new::Ptr{Float64}
    state_new::Ptr{Float64}
    wave_speed::Ptr{Float64}
    kinematic_viscosity::Ptr{Float64}
    energy::Ptr{Float64}
    position::Ptr{Float64}
    lookup::Ptr{Cvoid}
    mpm_material_batch() = new()
end
Base.cconvert(::Type{Ptr{mpm_material_batch}}, it::mpm_material_batch) = it
Base.unsafe_convert(::Type{Ptr{mpm_material_batch}}, it::mpm_material_batch) = Ptr{mpm_material_batch}(pointer_from_objref(it))

"""
A law of the host. Fill the struct with mpm_material_desc_init().
"""
mutable struct mpm_material_desc
    struct_size::UInt32
    state_count::Int32
    tangent_form::Int32
    reserved::Int32
    density::Float64
    stress::Ptr{Cvoid}
    tangent::Ptr{Cvoid}
    user::Ptr{Cvoid}
    release_user::Ptr{Cvoid}
    state_initial::Ptr{Float64}
    mpm_material_desc() = new()
end
Base.cconvert(::Type{Ptr{mpm_material_desc}}, it::mpm_material_desc) = it
Base.unsafe_convert(::Type{Ptr{mpm_material_desc}}, it::mpm_material_desc) = Ptr{mpm_material_desc}(pointer_from_objref(it))

"""
A linear system. The caller sets struct_size. The arrays belong to the library and are valid until the solve callback
returns. A row is one component of one node; nodes and components whose displacement is prescribed have none. Rows of
one node follow each other, by ascending component.

With several parts a row is owned by exactly one part. Local rows 0 to owned_rows - 1 are those that this part owns,
in the order of nodes that it has; they are numbered first_row, first_row + 1, ... over all parts, part by part.
Behind them stand rows that other parts own, those alone that columns of owned rows name: they have number, node,
component and position, and no entries of their own. Every vector has owned_rows entries. With one part all rows are
owned, and number[i] is i.

What a solver has made of a pattern serves as long as pattern_id is the same, of another stepper too.
"""
mutable struct mpm_operator_info
    struct_size::UInt32
    block::Int32
    symmetric::Int32
    positive_definite::Int32
    rows::Int64
    nonzeros::Int64
    pattern_id::Int64
    ld::Int64
    node::Ptr{Int64}
    component::Ptr{Int32}
    position::Ptr{Float64}
    first_row::Int64
    owned_rows::Int64
    all_rows::Int64
    number::Ptr{Int64}
    mpm_operator_info() = new()
end
Base.cconvert(::Type{Ptr{mpm_operator_info}}, it::mpm_operator_info) = it
Base.unsafe_convert(::Type{Ptr{mpm_operator_info}}, it::mpm_operator_info) = Ptr{mpm_operator_info}(pointer_from_objref(it))

"""
Options of a stepper. Fill the struct with mpm_stepper_desc_init(), then change what is wanted.
"""
mutable struct mpm_stepper_desc
    struct_size::UInt32
    scheme::Int32
    transfer::Int32
    xpic_order::Int32
    position_order::Int32
    locking_remedy::Int32
    reference_positions::Int32
    quasi_static::Int32
    staggered::Int32
    boundary_zero_acceleration::Int32
    flip::Float64
    pic_damping::Float64
    gravity::NTuple{3, Float64}
    newmark_beta::Float64
    newmark_gamma::Float64
    newton_tolerance_displacement::Float64
    newton_tolerance_energy::Float64
    newton_tolerance_residual::Float64
    newton_residual_floor::Float64
    newton_max_iterations::Int32
    linear_solver::Int32
    linear_tolerance::Float64
    linear_max_iterations::Int32
    projected_positions::Int32
    local_damping::Float64
    mass_damping::Float64
    xpic_every::Int32
    reserved::Int32
    mpm_stepper_desc() = new()
end
Base.cconvert(::Type{Ptr{mpm_stepper_desc}}, it::mpm_stepper_desc) = it
Base.unsafe_convert(::Type{Ptr{mpm_stepper_desc}}, it::mpm_stepper_desc) = Ptr{mpm_stepper_desc}(pointer_from_objref(it))

"""
What a step did, or the state as it is. The caller sets struct_size. Energies and momenta are the particles'; the
angular momentum is about the origin and includes the part of the matrices that transfers carry
(\"velocity_gradient\"). Entries of unused axes are 0. After a failed step the sums are those of the state that was
kept. Units are the host's: energies force * length, momenta mass * length/time.
"""
mutable struct mpm_step_info
    struct_size::UInt32
    cause::Int32
    callback_status::Int32
    newton_iterations::Int32
    linear_solver::Int32
    set::Int32
    step::Int64
    active_nodes::Int64
    removed::Int64
    resorts::Int64
    particle::Int64
    node::Int64
    linear_iterations::Int64
    t::Float64
    dt::Float64
    dt_suggested::Float64
    residual::Float64
    kinetic_energy::Float64
    strain_energy::Float64
    external_work::Float64
    dissipation::Float64
    momentum::NTuple{3, Float64}
    angular_momentum::NTuple{3, Float64}
    external_work_total::Float64
    affine_kinetic_energy::Float64
    contact_dissipation::Float64
    contact_nodes::Int64
    body::Int32
    reserved::Int32
    damping_dissipation::Float64
    damping_dissipation_total::Float64
    mpm_step_info() = new()
end
Base.cconvert(::Type{Ptr{mpm_step_info}}, it::mpm_step_info) = it
Base.unsafe_convert(::Type{Ptr{mpm_step_info}}, it::mpm_step_info) = Ptr{mpm_step_info}(pointer_from_objref(it))

"""
Particles of one set for which a force is wanted. Arrays are [components][ld], of which the first n items of each
component count. The memory belongs to the library and is valid during the call.
"""
struct mpm_particle_batch
    struct_size::UInt32
    dim::Int32
    n::Int64
    ld::Int64
    t::Float64
    dt::Float64
    id::Ptr{Int64}
    position::Ptr{Float64}
    reference_position::Ptr{Float64}
    velocity::Ptr{Float64}
    mass::Ptr{Float64}
    volume::Ptr{Float64}
    particles::Ptr{mpm_particles}
    lookup::Ptr{Cvoid}
end

"""
Active nodes of the grid. Arrays are [components][ld], of which the first n items of each component count. The memory
belongs to the library and is valid during the call.
"""
struct mpm_node_batch
    struct_size::UInt32
    dim::Int32
    body::Int32
    reserved::Int32
    n::Int64
    ld::Int64
    t::Float64
    dt::Float64
    index::Ptr{Int64}
    position::Ptr{Float64}
    mass::Ptr{Float64}
    owned::Ptr{UInt8}
end

"""
How mpm_advance() chooses its sub-steps. Fill the struct with mpm_advance_desc_init().
"""
mutable struct mpm_advance_desc
    struct_size::UInt32
    max_cuts::Int32
    t_end::Float64
    cfl::Float64
    dt_first::Float64
    dt_min::Float64
    dt_max::Float64
    max_steps::Int64
    mpm_advance_desc() = new()
end
Base.cconvert(::Type{Ptr{mpm_advance_desc}}, it::mpm_advance_desc) = it
Base.unsafe_convert(::Type{Ptr{mpm_advance_desc}}, it::mpm_advance_desc) = Ptr{mpm_advance_desc}(pointer_from_objref(it))

"""
Seconds of wall-clock time spent in steps since creation or the last reset, by stage. The caller sets struct_size.
"""
mutable struct mpm_profile
    struct_size::UInt32
    reserved::Int32
    sort::Float64
    p2g::Float64
    grid::Float64
    g2p::Float64
    law::Float64
    assembly::Float64
    factor::Float64
    solve::Float64
    callbacks::Float64
    total::Float64
    weights::Float64
    mpm_profile() = new()
end
Base.cconvert(::Type{Ptr{mpm_profile}}, it::mpm_profile) = it
Base.unsafe_convert(::Type{Ptr{mpm_profile}}, it::mpm_profile) = Ptr{mpm_profile}(pointer_from_objref(it))

"""
How two bodies meet. Fill it with mpm_contact_desc_init().
"""
mutable struct mpm_contact_desc
    struct_size::UInt32
    kind::Int32
    normal::Int32
    detection::Int32
    friction::Float64
    friction_static::Float64
    adhesion::Float64
    offset::Float64
    direction::NTuple{3, Float64}
    mpm_contact_desc() = new()
end
Base.cconvert(::Type{Ptr{mpm_contact_desc}}, it::mpm_contact_desc) = it
Base.unsafe_convert(::Type{Ptr{mpm_contact_desc}}, it::mpm_contact_desc) = Ptr{mpm_contact_desc}(pointer_from_objref(it))

"""
What two bodies did to each other in the last step, and since then. The caller sets struct_size. Forces are means over
the step.
"""
mutable struct mpm_contact_info
    struct_size::UInt32
    touching::Int32
    nodes::Int64
    closed::Int64
    stuck::Int64
    ambiguous::Int64
    force::NTuple{3, Float64}
    torque::NTuple{3, Float64}
    normal_force::Float64
    area::Float64
    pressure_max::Float64
    gap::Float64
    dissipation::Float64
    friction_work::Float64
    impulse::NTuple{3, Float64}
    mpm_contact_info() = new()
end
Base.cconvert(::Type{Ptr{mpm_contact_info}}, it::mpm_contact_info) = it
Base.unsafe_convert(::Type{Ptr{mpm_contact_info}}, it::mpm_contact_info) = Ptr{mpm_contact_info}(pointer_from_objref(it))

"""
Nodes at which two bodies touch, for mpm_friction_fn. Arrays belong to the library.
"""
struct mpm_contact_batch
    struct_size::UInt32
    dim::Int32
    body_a::Int32
    body_b::Int32
    n::Int64
    ld::Int64
    t::Float64
    dt::Float64
    position::Ptr{Float64}
    normal::Ptr{Float64}
    gap::Ptr{Float64}
    area::Ptr{Float64}
    slip::Ptr{Float64}
    pressure::Ptr{Float64}
end

"""
Points whose distance from an obstacle is asked for. All is in the axes of the body, from its centre; in space these
are the same until it moves. Arrays belong to the library.
"""
struct mpm_distance_batch
    struct_size::UInt32
    dim::Int32
    n::Int64
    ld::Int64
    t::Float64
    position::Ptr{Float64}
    distance::Ptr{Float64}
    normal::Ptr{Float64}
    velocity::Ptr{Float64}
end

"""
An obstacle. Fill it with mpm_obstacle_desc_init().
"""
mutable struct mpm_obstacle_desc
    struct_size::UInt32
    shape::Int32
    motion::Int32
    inside::Int32
    size::NTuple{3, Float64}
    position::NTuple{3, Float64}
    orientation::NTuple{4, Float64}
    velocity::NTuple{3, Float64}
    angular_velocity::NTuple{3, Float64}
    mass::Float64
    inertia::NTuple{9, Float64}
    contact::Ptr{mpm_contact_desc}
    distance::Ptr{Cvoid}
    user::Ptr{Cvoid}
    lower::NTuple{3, Float64}
    upper::NTuple{3, Float64}
    mpm_obstacle_desc() = new()
end
Base.cconvert(::Type{Ptr{mpm_obstacle_desc}}, it::mpm_obstacle_desc) = it
Base.unsafe_convert(::Type{Ptr{mpm_obstacle_desc}}, it::mpm_obstacle_desc) = Ptr{mpm_obstacle_desc}(pointer_from_objref(it))

"""
Loads of all markers of a surface, and what it prescribes. What markers carry by themselves (\"pressure\",
\"traction\", \"dead_traction\", \"prescribed_velocity\") and what the callbacks give comes on top. Fill it with
mpm_surface_desc_init().
"""
mutable struct mpm_surface_desc
    struct_size::UInt32
    body::Int32
    pressure::Float64
    traction::NTuple{3, Float64}
    dead_traction::NTuple{3, Float64}
    max_spacing::Float64
    prescribes::Int32
    reserved::Int32
    velocity::NTuple{3, Float64}
    penalty::Float64
    modulus::Float64
    mpm_surface_desc() = new()
end
Base.cconvert(::Type{Ptr{mpm_surface_desc}}, it::mpm_surface_desc) = it
Base.unsafe_convert(::Type{Ptr{mpm_surface_desc}}, it::mpm_surface_desc) = Ptr{mpm_surface_desc}(pointer_from_objref(it))

"""
Markers for which tractions are wanted. Arrays are [components][ld], belong to the library and are valid during the
call.
"""
struct mpm_marker_batch
    struct_size::UInt32
    dim::Int32
    n::Int64
    ld::Int64
    t::Float64
    dt::Float64
    id::Ptr{Int64}
    position::Ptr{Float64}
    area::Ptr{Float64}
    reference_area::Ptr{Float64}
    displacement::Ptr{Float64}
    velocity::Ptr{Float64}
end

"""
Particles that are to be split, or pairs that are to be merged. Arrays belong to the library and are valid during the
call.
"""
struct mpm_adaption_batch
    struct_size::UInt32
    what::Int32
    n::Int64
    ld::Int64
    dim::Int32
    reserved::Int32
    id::Ptr{Int64}
    other::Ptr{Int64}
    position::Ptr{Float64}
end

"""
How a set adapts. Fill it with mpm_adaption_desc_init(), after which nothing is split and nothing merged. Lengths are
counted in cells: an edge (a, b, c) has the length |(a/h_x, b/h_y, c/h_z)|.
"""
mutable struct mpm_adaption_desc
    struct_size::UInt32
    every::Int32
    split_edge::Float64
    least_edge::Float64
    min_per_cell::Int32
    max_per_cell::Int32
    merge_distance::Float64
    merge_tolerance::Float64
    most_particles::Int64
    accept::Ptr{Cvoid}
    user::Ptr{Cvoid}
    mpm_adaption_desc() = new()
end
Base.cconvert(::Type{Ptr{mpm_adaption_desc}}, it::mpm_adaption_desc) = it
Base.unsafe_convert(::Type{Ptr{mpm_adaption_desc}}, it::mpm_adaption_desc) = Ptr{mpm_adaption_desc}(pointer_from_objref(it))

"""
What adaption has done to a set, in all steps since it was first described for it or the time was set.
"""
mutable struct mpm_adaption_info
    struct_size::UInt32
    reserved::Int32
    splits::Int64
    added::Int64
    merges::Int64
    kinetic_loss::Float64
    affine_loss::Float64
    strain_loss::Float64
    angular_momentum_loss::NTuple{3, Float64}
    mpm_adaption_info() = new()
end
Base.cconvert(::Type{Ptr{mpm_adaption_info}}, it::mpm_adaption_info) = it
Base.unsafe_convert(::Type{Ptr{mpm_adaption_info}}, it::mpm_adaption_info) = Ptr{mpm_adaption_info}(pointer_from_objref(it))

"""
The heat of a set. Fill it with mpm_heat_desc_init().
"""
mutable struct mpm_heat_desc
    struct_size::UInt32
    reserved::Int32
    specific_heat::Float64
    conductivity::Float64
    expansion::Float64
    reference_temperature::Float64
    dissipated_share::Float64
    source::Ptr{Cvoid}
    user::Ptr{Cvoid}
    mpm_heat_desc() = new()
end
Base.cconvert(::Type{Ptr{mpm_heat_desc}}, it::mpm_heat_desc) = it
Base.unsafe_convert(::Type{Ptr{mpm_heat_desc}}, it::mpm_heat_desc) = Ptr{mpm_heat_desc}(pointer_from_objref(it))

"""
Where heat came from, in the last step and in all steps since the first set was described or the time was set: gained
= sum of walls + sources + surfaces + dissipated, to rounding, and with implicit conduction to the tolerance. All are
energies.
"""
mutable struct mpm_heat_info
    struct_size::UInt32
    iterations::Int32
    heat::Float64
    gained::Float64
    walls::NTuple{6, Float64}
    sources::Float64
    surfaces::Float64
    dissipated::Float64
    gained_total::Float64
    walls_total::NTuple{6, Float64}
    sources_total::Float64
    surfaces_total::Float64
    dissipated_total::Float64
    mpm_heat_info() = new()
end
Base.cconvert(::Type{Ptr{mpm_heat_info}}, it::mpm_heat_info) = it
Base.unsafe_convert(::Type{Ptr{mpm_heat_info}}, it::mpm_heat_info) = Ptr{mpm_heat_info}(pointer_from_objref(it))

# Callbacks: what @cfunction(f, result, (arguments,)) takes for each type of C.

"""
Starts an exchange and returns before it is done. out: ascending by part, never this one. most: of each partner, a
bound on what comes from it, [count]; NULL with MPM_EXCHANGE_SPARSE. Returns 0, or < 0: then the context is unusable
(MPM_E_CALLBACK), for the other parts are lost.

f(user, exchange, count, out, most): @cfunction(f, Int32, (Ptr{Cvoid}, Int32, Int32, Ptr{mpm_message}, Ptr{Int64}))
"""
const mpm_send_fn = Ptr{Cvoid}

"""
Ends the exchange: all that was sent to this part, ascending by part. Returns as mpm_send_fn.

f(user, count, in): @cfunction(f, Int32, (Ptr{Cvoid}, Ptr{Int32}, Ptr{Ptr{mpm_message}}))
"""
const mpm_receive_fn = Ptr{Cvoid}

"""
values[count] of all parts into each of them (collective). Returns as mpm_send_fn.

f(user, op, count, values): @cfunction(f, Int32, (Ptr{Cvoid}, Int32, Int64, Ptr{Int64}))
"""
const mpm_reduce_fn = Ptr{Cvoid}

"""
all[parts]: value of each part (collective). Only when particles are added, sets adapt, implicit steps number their
unknowns or pieces of a state are loaded. Returns as mpm_send_fn.

f(user, value, all): @cfunction(f, Int32, (Ptr{Cvoid}, Int64, Ptr{Int64}))
"""
const mpm_gather_fn = Ptr{Cvoid}

"""
For transports that move only when called: called up to eight times between send and receive of a sum on nodes, after
each group of the blocks whose sums are made meanwhile. May be NULL.

f(user): @cfunction(f, Cvoid, (Ptr{Cvoid},))
"""
const mpm_transport_poll_fn = Ptr{Cvoid}

"""
A task of the library, which the host's executor calls with the task_data that it was given and a number k. A task
neither throws nor blocks, and may run on any thread.

f(task_data, k): @cfunction(f, Cvoid, (Ptr{Cvoid}, Int64))
"""
const mpm_task_fn = Ptr{Cvoid}

"""
The host's executor. It runs task(task_data, k) exactly once for each k in [0, count), in any order, on any threads,
and returns when all are done. The library calls it on the calling thread, and its results do not depend on order and
threads. A return other than 0 makes the call that needed it fail with MPM_E_CALLBACK.

f(user, count, task, task_data): @cfunction(f, Int32, (Ptr{Cvoid}, Int64, Ptr{Cvoid}, Ptr{Cvoid}))
"""
const mpm_parallel_for_fn = Ptr{Cvoid}

"""
Returns memory of at least so many bytes at a multiple of alignment, a power of two; or NULL if there is none. Default
NULL: the C library's memory is used. alloc and release are set together. Called on the calling thread only.

f(user, bytes, alignment): @cfunction(f, Ptr{Cvoid}, (Ptr{Cvoid}, Csize_t, Csize_t))
"""
const mpm_context_desc_alloc_fn = Ptr{Cvoid}

"""
Takes back memory from alloc, with the same bytes and alignment. Called on the calling thread only.

f(user, memory, bytes, alignment): @cfunction(f, Cvoid, (Ptr{Cvoid}, Ptr{Cvoid}, Csize_t, Csize_t))
"""
const mpm_context_desc_release_fn = Ptr{Cvoid}

"""
Takes a finished text without newline, with a level MPM_LOG_*. The text is valid during the call. Default NULL: the
library is silent, since it never writes to the standard streams. Called on the calling thread only.

f(user, level, text): @cfunction(f, Cvoid, (Ptr{Cvoid}, Int32, Ptr{UInt8}))
"""
const mpm_context_desc_log_fn = Ptr{Cvoid}

"""
A law (mt). It reads the state before the step and the deformation of the step, and writes stress_new, state_new and
wave_speed of all n items, and kinematic_viscosity and energy where it has them. A wave speed or a viscosity below 0
stops the step or the call that asked (MPM_E_CALLBACK), and an infinite energy or any other value that is not finite
is MPM_NONFINITE; both name the particle. The law may be called several times for one step, and nothing that it writes
counts before the step is committed: it keeps no state of its own.

With dt = 0, F_inc = I and L = 0 the library asks for stress, wave speed and energy of the state as it is: the law
returns the stress that belongs to that state.

Returns 0, a value > 0 to ask for a smaller dt (MPM_CUT_DT), or a value < 0 to stop (MPM_E_CALLBACK).

f(user, batch): @cfunction(f, Int32, (Ptr{Cvoid}, Ptr{mpm_material_batch}))
"""
const mpm_stress_fn = Ptr{Cvoid}

"""
The tangent of a law (mt), for implicit steps. It is called after the law on the same batch, with the law's outputs in
place, and writes tangent[component * ld + i], a stress, in the form that tangent_form names. With tau = J stress and
the variation dF = L F, c is the derivative of the Lie derivative of tau: c_ijkl = d tau_ij / d L_kl - delta_ik tau_jl
- delta_jk tau_il.

- MPM_TANGENT_MINOR_SYMMETRIC has component 6 * row + column, where rows and columns are xx yy zz xy yz xz, and
  columns are for engineering shear.
- MPM_TANGENT_GENERAL has component 9 * (3 * i + j) + 3 * k + l.

Into *symmetric the callback writes 1 if c has major symmetry (c_ijkl = c_klij) at every item, 0 otherwise. Returns as
mpm_stress_fn does.

f(user, batch, tangent, symmetric): @cfunction(f, Int32, (Ptr{Cvoid}, Ptr{mpm_material_batch}, Ptr{Float64},
Ptr{Int32}))
"""
const mpm_tangent_fn = Ptr{Cvoid}

"""
Called with user when the material is destroyed, not when create fails; may be NULL (default).

f(user): @cfunction(f, Cvoid, (Ptr{Cvoid},))
"""
const mpm_material_desc_release_user_fn = Ptr{Cvoid}

"""
Tells which of n points are inside a body: the callback writes inside[i] = 1 or 0 for the point with the coordinates
position[c * ld + i], c < dim. It runs on the calling thread. A return other than 0 ends the fill with MPM_E_CALLBACK;
nothing is then added.

f(user, dim, n, ld, position, inside): @cfunction(f, Int32, (Ptr{Cvoid}, Int32, Int64, Int64, Ptr{Float64},
Ptr{UInt8}))
"""
const mpm_inside_fn = Ptr{Cvoid}

"""
Solves matrix * solution = rhs. Runs on the calling thread. Both vectors have as many entries as
mpm_operator_get_info() reports owned rows, and solution is preset to the best guess known. The host writes the
solution, and into *iterations the number that linear_iterations is to count.

- tolerance: the wanted ||matrix * solution - rhs|| / ||rhs||.

Returns 0, a value > 0 if the system was not solved (MPM_CUT_DT), or a value < 0 to stop (MPM_E_CALLBACK).

With several parts (parallel.h) it is called on all of them, and solves the system of all rows together: each part
lends the rows that it owns, complete, with the right-hand side on them, and takes its part of the solution. Where the
solver returns another value than 0 on a part, all parts have the outcome of the lowest such; of the iterations the
largest number counts. The residual is checked over all parts. A solver that waits for its other parts ends on all of
them when it ends on one.

f(user, matrix, rhs, solution, tolerance, iterations): @cfunction(f, Int32, (Ptr{Cvoid}, Ptr{mpm_operator},
Ptr{Float64}, Ptr{Float64}, Float64, Ptr{Int64}))
"""
const mpm_solve_fn = Ptr{Cvoid}

"""
Gives a vector per particle (mt): the callback does add[c * ld + i] += value for c < dim, because several sources add
to the same array. Returns 0, a value > 0 to ask for a smaller dt (MPM_CUT_DT), or a value < 0 to stop
(MPM_E_CALLBACK).

f(user, batch, add): @cfunction(f, Int32, (Ptr{Cvoid}, Ptr{mpm_particle_batch}, Ptr{Float64}))
"""
const mpm_particle_fn = Ptr{Cvoid}

"""
Prescribes nodal velocities (mt). For the nodes and axes to hold, the callback sets prescribed[c * ld + i] = 1 (preset
0), and velocity[c * ld + i] to the mean velocity of the step, so that the displacement increment is dt * velocity in
every scheme. Where several prescribe one node and axis, the first of these wins: this callback, prescribed particles
(their mean weighted by mass), walls; the reaction counts for the winner. The callback is asked once per step, in the
first projection of particles onto nodes; further projections keep to the answer. Returns as mpm_particle_fn does.

f(user, batch, prescribed, velocity): @cfunction(f, Int32, (Ptr{Cvoid}, Ptr{mpm_node_batch}, Ptr{UInt8},
Ptr{Float64}))
"""
const mpm_velocity_fn = Ptr{Cvoid}

"""
Reads and changes the nodal velocity[dim][ld] and force[dim][ld] at a stage of an explicit step (mt). The hook is
shown every node that moves by itself: periodic images and mirrored ghosts are counted in with the node that they
follow, in mass, velocity and force, and what is written acts on all of them.

- MPM_AFTER_P2G: velocity is the projected one and force is zero; what is written is added to the force.
- MPM_AFTER_FORCES: velocity is the same; force is the whole of it, and may be replaced.
- MPM_AFTER_VELOCITY: velocity is the updated one, under walls and prescribed velocities, which do not act again; a
  change is an impulse of mass times change. force, reactions included, is for reading: what is written there is
  ignored.

A change of the projected velocity moves particles, and is given to them as far as the transfer takes nodal
velocities: not with MPM_FLIP and flip = 1. Values that are left as they are change no bit; with MPM_APIC_MLS a hook
keeps forces apart, as steps in parts do. Hooks run in the projection that has the forces: not in the second one of
MPM_MUSL, and not in the first one of MPM_USF, which gives the strain, so that they act on the strain of later steps
only. Their work, impulse times new nodal velocity, is part of external_work. MPM_NONFINITE names the node. Returns as
mpm_particle_fn does.

f(user, batch, velocity, force): @cfunction(f, Int32, (Ptr{Cvoid}, Ptr{mpm_node_batch}, Ptr{Float64}, Ptr{Float64}))
"""
const mpm_node_fn = Ptr{Cvoid}

"""
Watches steps. It is called on the calling thread at least once in each step before the step is committed, and after
each Newton iteration, with what is known so far; info belongs to the library. Returns 0 to go on, a value > 0 to end
the call with MPM_CANCELLED, or a value < 0 to end it with MPM_E_CALLBACK; the step is then not committed.

f(user, info): @cfunction(f, Int32, (Ptr{Cvoid}, Ptr{mpm_step_info}))
"""
const mpm_progress_fn = Ptr{Cvoid}

"""
Sets the coefficients of friction of nodes (mt): friction[ld], preset to that of the pair of bodies, may be changed to
any finite value >= 0; it then also is that of sticking. It is asked once in a step, with MPM_USF twice: first with
the forces of the old stress. Returns as mpm_particle_fn does.

f(user, batch, friction): @cfunction(f, Int32, (Ptr{Cvoid}, Ptr{mpm_contact_batch}, Ptr{Float64}))
"""
const mpm_friction_fn = Ptr{Cvoid}

"""
Gives distances of points (mt). Points are particles, and nodes of blocks that are near the obstacle, also those
without material: nodes lie in the grid or up to one spacing beyond its faces, and of a grid with total_lagrangian = 1
where the material has taken them. On periodic axes a point is the image nearest to the centre. Returns as
mpm_particle_fn does. A value that is not finite, or a normal whose length is not 1 to 1e-6, ends the step:
MPM_NONFINITE, MPM_E_CALLBACK.

f(user, batch): @cfunction(f, Int32, (Ptr{Cvoid}, Ptr{mpm_distance_batch}))
"""
const mpm_distance_fn = Ptr{Cvoid}

"""
Gives the mean velocity[3] and angular velocity[3] of the step from t over dt; both are preset to the present ones. It
is called once per step, on the thread of the call. Returns as mpm_particle_fn does.

f(user, t, dt, velocity, angular_velocity): @cfunction(f, Int32, (Ptr{Cvoid}, Float64, Float64, Ptr{Float64},
Ptr{Float64}))
"""
const mpm_motion_fn = Ptr{Cvoid}

"""
Gives tractions: the callback does add[c * ld + i] += force per present area of marker i, c < dim. It runs on the
thread of the call, once per step. Returns as mpm_particle_fn does. A value that is not finite ends the step:
MPM_NONFINITE.

f(user, batch, add): @cfunction(f, Int32, (Ptr{Cvoid}, Ptr{mpm_marker_batch}, Ptr{Float64}))
"""
const mpm_traction_fn = Ptr{Cvoid}

"""
Gives velocities: the callback does add[c * ld + i] += mean velocity of marker i over the step that begins at
batch->t, c < dim. It runs on the thread of the call, once per step, for surfaces that prescribe. Returns as
mpm_particle_fn does. A value that is not finite ends the step: MPM_NONFINITE.

f(user, batch, add): @cfunction(f, Int32, (Ptr{Cvoid}, Ptr{mpm_marker_batch}, Ptr{Float64}))
"""
const mpm_marker_velocity_fn = Ptr{Cvoid}

"""
Says which of them are left as they are: accept[i], [ld], is 1, and the callback writes 0 to keep the i-th from it. It
runs on the thread of the call. Returns as mpm_particle_fn does.

f(user, batch, accept): @cfunction(f, Int32, (Ptr{Cvoid}, Ptr{mpm_adaption_batch}, Ptr{UInt8}))
"""
const mpm_adaption_fn = Ptr{Cvoid}

"""
Heat sources: writes power[i], [ld], power per present volume, at the time batch->t: the start of the step, and with
implicit conduction its end. It runs as mpm_particle_fn does, on all threads, and returns as that does. A value that
is not finite ends the step: MPM_NONFINITE.

f(user, batch, power): @cfunction(f, Int32, (Ptr{Cvoid}, Ptr{mpm_particle_batch}, Ptr{Float64}))
"""
const mpm_heat_fn = Ptr{Cvoid}

"""
Takes the next bytes of an output, in the order in which a file would have them: for archives, sockets, browsers. All
pieces have 65536 bytes, but for the last one, which has fewer or as many; data are lent for the time of the call. It
runs on the calling thread. A return other than 0 ends the output with MPM_E_CALLBACK, and mpm_last_error() tells what
was returned and after how many bytes; mpm_step_info.callback_status stays that of the last step. Since 0.2.0.

f(user, data, bytes): @cfunction(f, Int32, (Ptr{Cvoid}, Ptr{Cvoid}, Int64))
"""
const mpm_write_fn = Ptr{Cvoid}

"""
The version of the library that runs, as 0xMMmmpp, to be compared with MPM_VERSION. May be called from any thread at
any time.
"""
function mpm_version()
    return ccall((:mpm_version, libmpm), UInt32, ())
end

"""
The name of a status constant, such as \"MPM_E_ARG\", or \"unknown status\" for any other value. The text is static,
and the pointer is never NULL. May be called from any thread at any time.
"""
function mpm_status_name(status)
    return ccall((:mpm_status_name, libmpm), Ptr{UInt8}, (Int32,), status)
end

"""
What a status says, in a sentence without names and values: for calls that have no context to keep a text, as those on
NULL. Static, and never NULL: see mpm_last_error() for more. May be called from any thread at any time.
"""
function mpm_status_text(status)
    return ccall((:mpm_status_text, libmpm), Ptr{UInt8}, (Int32,), status)
end

"""
Gives back the memory of a view that mpm_particles_map() or mpm_grid_map() filled. Afterwards its data and owner are
NULL. What the host wrote through a view with MPM_WRITE takes effect now. Memory of a view without it is not to be
changed: whatever is written there harms no step beyond its numbers, and a library built with MPM_DEBUG notices.

- MPM_E_ARG: view is NULL, or the host wrote values that are not finite or give det F <= 0. In the second case the
  view is released all the same, and the set refuses to step (MPM_E_STATE) until the values are repaired; bad nodal
  values are dropped.
- MPM_E_STATE: the view is not lent, or no longer; or, with MPM_DEBUG, it was lent for reading and its memory has
  changed: it is then released all the same. A view that was never filled has no context to keep a text.
"""
function mpm_view_release(view)
    return ccall((:mpm_view_release, libmpm), Int32, (Ptr{mpm_view},), view)
end

"""
Number of this part and how many there are; 0 and 1 without a transport. Pointers may be NULL.
"""
function mpm_context_part(context, part, parts)
    return ccall((:mpm_context_part, libmpm), Int32, (Ptr{mpm_context}, Ptr{Int32}, Ptr{Int32}), context, part, parts)
end

"""
Particles of a set on all parts (collective). mpm_particles_count() is that of this part.
"""
function mpm_particles_total(particles, n)
    return ccall((:mpm_particles_total, libmpm), Int32, (Ptr{mpm_particles}, Ptr{Int64}), particles, n)
end

"""
Fills desc with the defaults. struct_size is sizeof(mpm_balance_desc) of the caller; no byte beyond is written.
MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
"""
function mpm_balance_desc_init(desc, struct_size)
    return ccall((:mpm_balance_desc_init, libmpm), Int32, (Ptr{mpm_balance_desc}, UInt32), desc, struct_size)
end

"""
Sets how blocks are given to parts, from the next sort of particles on (collective); desc NULL: by the defaults.
Results do not depend on it, bit by bit. Not part of a saved state: the host sets it again. With one part it is
checked and does nothing. MPM_E_ARG: a value is out of range, or another one is given on another part. MPM_E_STATE: a
step is under way. Since 0.2.0.
"""
function mpm_stepper_set_balance(stepper, desc)
    return ccall((:mpm_stepper_set_balance, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_balance_desc}), stepper, desc)
end

"""
Tells what this part does, as of the last step; 1 in reset starts the counts anew. MPM_E_ARG: info is NULL or its
struct_size is bad. With one part nothing is exchanged: all but blocks and imbalance, 1, is 0.
"""
function mpm_stepper_parallel_info(stepper, reset, info)
    return ccall((:mpm_stepper_parallel_info, libmpm), Int32, (Ptr{mpm_stepper}, Int32, Ptr{mpm_parallel_info}),
        stepper, reset, info)
end

"""
Tells how many bytes mpm_particles_pack() needs for n particles of the set, with the fields that it has now.
MPM_E_ARG: n is negative or beyond 2^32 - 2, or bytes is NULL. Since 0.2.0.
"""
function mpm_particles_packed_size(particles, n, bytes)
    return ccall((:mpm_particles_packed_size, libmpm), Int32, (Ptr{mpm_particles}, Int64, Ptr{Int64}),
        particles, n, bytes)
end

"""
Packs n particles into a buffer, for hosts that move them themselves: between sets, programs, machines. They have
every field in use, bit by bit, with ids, images and the host's fields, and what says of which law they are. The order
of bytes is the same on all machines. The particles stay in the set.

- ids: [n], each once, in this order; NULL for all particles by ascending id, where n is mpm_particles_count().
- buffer: of `capacity` bytes, of which those of mpm_particles_packed_size() are written; anywhere.

Of a problem in several parts these are particles of this part, and no other part takes part. MPM_E_NOT_FOUND: an id
is not in the set. MPM_E_ARG: capacity is too small, an id is given twice, n does not match or buffer is NULL.
MPM_E_STATE: a staged step is under way, a view of the set is out for writing, or a value that was written through one
is bad. Since 0.2.0.
"""
function mpm_particles_pack(particles, n, ids, buffer, capacity)
    return ccall((:mpm_particles_pack, libmpm), Int32, (Ptr{mpm_particles}, Int64, Ptr{Int64}, Ptr{Cvoid}, Int64),
        particles, n, ids, buffer, capacity)
end

"""
Adds packed particles to a set, bit by bit: all or none. The law is not asked: stress, state variables and volume come
along. Fields that the set has and the buffer lacks have the values of new particles. Grids may have other cells and
bases, if the particles lie inside.

Of a problem in several parts they are added to this part, and no other part takes part; the next step brings them
home. MPM_E_FORMAT: the buffer is damaged; it is of another law, or of other parameters, dimension, geometry or kind
of grid, or counts images of other periods; or it has fields that the set has not: of the host, of another type, or
\"reference_position\" and \"dilation_ratio\" where no stepper keeps them. MPM_E_ARG: an id is in use, or a particle
lies outside the grid, which the text names; or buffer is NULL. MPM_E_STATE: as for all that changes a set. Since
0.2.0.
"""
function mpm_particles_unpack(particles, buffer, bytes)
    return ccall((:mpm_particles_unpack, libmpm), Int32, (Ptr{mpm_particles}, Ptr{Cvoid}, Int64),
        particles, buffer, bytes)
end

"""
Fills desc with the defaults. struct_size is sizeof(mpm_context_desc) of the caller; no byte beyond is written.
MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
"""
function mpm_context_desc_init(desc, struct_size)
    return ccall((:mpm_context_desc_init, libmpm), Int32, (Ptr{mpm_context_desc}, UInt32), desc, struct_size)
end

"""
Makes a context. desc is copied and may be NULL for the defaults. *out is NULL unless MPM_OK is returned. The host
ends the context with mpm_context_destroy(). There is no context to ask why a call has failed: the sentence goes to
error_text, and to log with MPM_LOG_WARNING, as far as desc sets them.

- MPM_E_ARG: a value is bad, only one of alloc and release or of error_text and error_bytes is set, or the variable
  MPM_ISA has an unknown value.
- MPM_E_NOMEM: memory or threads are not to be had.
- MPM_E_UNSUPPORTED: the instruction set is not available, the build has no threads, or desc sets a field that this
  version of the library does not know.
"""
function mpm_context_create(desc, out)
    return ccall((:mpm_context_create, libmpm), Int32, (Ptr{mpm_context_desc}, Ptr{Ptr{mpm_context}}), desc, out)
end

"""
Tells how many bytes the context and its objects hold now, and the most that they ever held. Either output pointer may
be NULL. Any thread, any time while the context lives, also in callbacks.
"""
function mpm_context_memory(context, bytes, peak_bytes)
    return ccall((:mpm_context_memory, libmpm), Int32, (Ptr{mpm_context}, Ptr{Int64}, Ptr{Int64}),
        context, bytes, peak_bytes)
end

"""
Ends the pool and frees the context. NULL is fine. MPM_E_STATE while objects made with it live, and in its own
callbacks.
"""
function mpm_context_destroy(context)
    return ccall((:mpm_context_destroy, libmpm), Int32, (Ptr{mpm_context},), context)
end

"""
Gives one or two sentences, with the offending names and values, on the last call on this context or its objects that
did not return MPM_OK. Calls that succeed leave them as they are, so that a host may clean up and log first and ask
then; \"\" while no call has failed. The text belongs to the library and is valid until the next call on the context.
Of NULL, and of a handle of another kind, a sentence that says so: the calls that get no further than to such a handle
have no other. A context that was destroyed must not be given to this or any other call. May be called in callbacks,
too, on the thread of the call.
"""
function mpm_last_error(context)
    return ccall((:mpm_last_error, libmpm), Ptr{UInt8}, (Ptr{mpm_context},), context)
end

"""
Makes text the sentence of mpm_last_error() and returns status: for libraries that stand on this one and refuse a call
of their own on a context, as mpm_umat.h does. text is copied, and cut after some 1000 bytes. MPM_E_ARG: status is
MPM_OK, or text is NULL; the sentence then says that.
"""
function mpm_set_last_error(context, status, text)
    return ccall((:mpm_set_last_error, libmpm), Int32, (Ptr{mpm_context}, Int32, Cstring), context, status, text)
end

"""
Fills desc with the defaults; cells and spacing are 0, and the host must set them. struct_size is
sizeof(mpm_grid_desc) of the caller; no byte beyond is written. MPM_E_ARG: it is smaller than the first released
struct. Any thread, any time.
"""
function mpm_grid_desc_init(desc, struct_size)
    return ccall((:mpm_grid_desc_init, libmpm), Int32, (Ptr{mpm_grid_desc}, UInt32), desc, struct_size)
end

"""
Makes a grid. desc is copied. Any number of sets and steppers share the grid, which outlives them. *out is NULL unless
MPM_OK is returned. MPM_E_ARG: a value is bad, or there are more nodes than 64-bit numbers can name.
MPM_E_UNSUPPORTED: open knots are asked for with a basis other than MPM_BSPLINE2 and MPM_BSPLINE3; MPM_AXISYMMETRIC
and MPM_PLANE_STRESS with a dim other than 2, the former with a periodic first axis.
"""
function mpm_grid_create(context, desc, out)
    return ccall((:mpm_grid_create, libmpm), Int32, (Ptr{mpm_context}, Ptr{mpm_grid_desc}, Ptr{Ptr{mpm_grid}}),
        context, desc, out)
end

"""
Frees the grid. NULL is fine. MPM_E_STATE while sets or steppers on it live.
"""
function mpm_grid_destroy(grid)
    return ccall((:mpm_grid_destroy, libmpm), Int32, (Ptr{mpm_grid},), grid)
end

"""
Makes a material from a built-in law. In the table stresses are Cauchy stresses, and J = det F.

| model                   | parameters                              | law                                 |
|-------------------------|-----------------------------------------|-------------------------------------|
| \"linear_elastic\"        | E, nu, density                          | hypoelastic: with F_inc = V R,      |
|                         |                                         | stress' = R stress R^T + C : ln V   |
| \"neo_hookean\"           | E, nu, density                          | Steffen et al. 2008, eq. 46         |
| \"neo_hookean_decoupled\" | mu, kappa, density                      | Guilkey & Weiss 2003, eq. 20        |
| \"j2\"                    | E, nu, density, yield_stress, hardening | linear_elastic with von Mises yield |
|                         |                                         | and linear isotropic hardening      |
| \"newtonian_fluid\"       | density, bulk_modulus, gamma,           | p = bulk_modulus / gamma            |
|                         | viscosity, tension                      | (J^-gamma - 1), dynamic viscosity;  |
|                         |                                         | tension 0 cuts off p < 0            |
| \"rigid\"                 | density                                 | no stress; moves as prescribed      |
| \"drucker_prager\"        | E, nu, density, phi, psi, cohesion,     | elastic in the logarithmic strain;  |
|                         | cone, tension_cutoff, hardening,        | yields at q = M p + k: sand, gravel |
|                         | cohesion_residual, close_gaps           | and other soils; opens in tension   |
| \"mohr_coulomb\"          | those of drucker_prager without cone    | the same by the planes of           |
|                         |                                         | Mohr-Coulomb; phi = 0 is Tresca     |
| \"herschel_bulkley\"      | density, bulk_modulus, gamma,           | p of newtonian_fluid; elastic in    |
|                         | shear_modulus, yield_shear,             | shear up to yield_shear, then flow: |
|                         | consistency, n, tension                 | + consistency (shear rate)^n        |
| \"snow\"                  | E, nu, density, hardening,              | Stomakhin et al. 2013: elastic      |
|                         | critical_compression, critical_stretch, | stretches within bounds, hardens by |
|                         | hardening_max                           | compaction                          |
| \"mu_i\"                  | E, nu, density, mu_s, mu_2, I_0,        | Jop et al. 2006: grains that flow   |
|                         | grain_diameter, grain_density           | with friction mu(I); no tension     |
| \"cam_clay\"              | density, kappa, lambda, M, mu0, alpha,  | modified Cam-clay in the logarithmic|
|                         | p_ref, pc0, p_min                       | strain; needs an initial stress     |

params are count pairs of name and value in any order, which are copied; parameters that are not named take their
defaults. mpm_material_model_param() lists units, defaults and ranges. *out is NULL unless MPM_OK is returned.
MPM_E_NOT_FOUND: there is no such model or parameter. MPM_E_ARG: a value is out of range, a name is given twice,
values do not go together, or a parameter without default is missing.
"""
function mpm_material_create(context, model, params, count, out)
    return ccall((:mpm_material_create, libmpm), Int32, (Ptr{mpm_context}, Cstring, Ptr{mpm_param}, Int32, Ptr{Ptr{mpm_material}}),
        context, model, params, count, out)
end

"""
The number of built-in laws. Any thread, any time.
"""
function mpm_material_model_count()
    return ccall((:mpm_material_model_count, libmpm), Int32, ())
end

"""
The name of the built-in law with number index, 0 <= index < mpm_material_model_count(), or NULL for another index.
The text is static. Any thread, any time.
"""
function mpm_material_model_name(index)
    return ccall((:mpm_material_model_name, libmpm), Ptr{UInt8}, (Int32,), index)
end

"""
Describes the parameter with number index (from 0) of a built-in law: its name, its unit as a dimension (such as
\"stress\"), one line of text, its default (NaN if it must be given) and its range [low, high]. Texts are static, and
output pointers may be NULL. MPM_E_NOT_FOUND: there is no such model, or index is past the last parameter. Any thread,
any time.
"""
function mpm_material_model_param(model, index, name, unit, text, value_default, low, high)
    return ccall((:mpm_material_model_param, libmpm), Int32, (Cstring, Int32, Ptr{Ptr{UInt8}}, Ptr{Ptr{UInt8}}, Ptr{Ptr{UInt8}}, Ptr{Float64}, Ptr{Float64}, Ptr{Float64}),
        model, index, name, unit, text, value_default, low, high)
end

"""
The number of state variables of a particle of a built-in law, or -1 where there is no such model. They are the
components of the field \"state\". Any thread, any time.
"""
function mpm_material_state_count(model)
    return ccall((:mpm_material_state_count, libmpm), Int32, (Cstring,), model)
end

"""
Describes the state variable with number index (from 0) of a built-in law: its name, such as \"plastic_strain\", its
unit as a dimension and one line of text. Texts are static, and output pointers may be NULL. MPM_E_NOT_FOUND: there is
no such model, or index is past the last variable. Any thread, any time.
"""
function mpm_material_state_name(model, index, name, unit, text)
    return ccall((:mpm_material_state_name, libmpm), Int32, (Cstring, Int32, Ptr{Ptr{UInt8}}, Ptr{Ptr{UInt8}}, Ptr{Ptr{UInt8}}),
        model, index, name, unit, text)
end

"""
Lends a field of the set that a batch belongs to, built in or the host's own. It is aligned with the batch and valid
during the callback: component c of item i is (*data)[c * *component_stride + i], in elements of the field's type.
Nothing is copied, so tensors have their stored components, as in views. lookup is that of the batch. May be called
from any thread on which a callback runs. MPM_E_NOT_FOUND: there is no such field. MPM_E_STATE: the field is optional,
and the set does not have it now.
"""
function mpm_batch_field(lookup, field, data, component_stride)
    return ccall((:mpm_batch_field, libmpm), Int32, (Ptr{Cvoid}, Cstring, Ptr{Ptr{Cvoid}}, Ptr{Int64}),
        lookup, field, data, component_stride)
end

"""
Fills desc with the defaults; the host must set density and stress. struct_size is sizeof(mpm_material_desc) of the
caller; no byte beyond is written. MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
"""
function mpm_material_desc_init(desc, struct_size)
    return ccall((:mpm_material_desc_init, libmpm), Int32, (Ptr{mpm_material_desc}, UInt32), desc, struct_size)
end

"""
Makes a material from a law of the host. desc is copied. *out is NULL unless MPM_OK is returned. MPM_E_ARG: a value is
bad, or stress is NULL.
"""
function mpm_material_create_custom(context, desc, out)
    return ccall((:mpm_material_create_custom, libmpm), Int32, (Ptr{mpm_context}, Ptr{mpm_material_desc}, Ptr{Ptr{mpm_material}}),
        context, desc, out)
end

"""
Runs a material, built in or the host's, without a grid: what a step does to its particles, for n items of the caller.
It is how parameters are fitted to tests of the laboratory.

The caller fills batch: struct_size, state_count (that of the material), n, ld, t, dt, F (at the end of the step),
F_inc, stress and state before the step, and the arrays for stress_new and state_new, all in the forms of
mpm_material_batch. These may be NULL: id (items then have ids from 0; items with ids < 0 are inert, and what their
outputs hold is not said), L (made of F_inc and dt; what is given must be (F_inc - I) / dt), position ([3][ld];
zeros), wave_speed, kinematic_viscosity and energy (not wanted), state and state_new of a law without state. lookup is
not used: a law of the host gets NULL. Outputs may be the arrays of inputs: stress_new that of stress, say. With dt =
0 the answer is the state as it is, see mpm_stress_fn, whatever F_inc and L are.

tangent is NULL or [81][ld], and receives the tangent of the step in the general form of mpm_tangent_fn; dt must be >
0 then. Into *symmetric goes 1 if it has major symmetry at every item, else 0; it may be NULL, and is left alone
without a tangent.

Bits are those of a 3-D step on the same instruction set. The calling thread does all the work, as for other calls of
the context. MPM_E_ARG: an array is NULL, a number is out of range, or L and F_inc disagree. MPM_NONFINITE: a value
that is given or that comes out is not finite. MPM_INVERTED: det F or det F_inc is not positive. MPM_CUT_DT and
MPM_E_CALLBACK: as in a step. What is wrong with an item names it, what a law returned the items that it was asked
about. After a failure items before these may have been written.
"""
function mpm_material_update(material, batch, tangent, symmetric)
    return ccall((:mpm_material_update, libmpm), Int32, (Ptr{mpm_material}, Ptr{mpm_material_batch}, Ptr{Float64}, Ptr{Int32}),
        material, batch, tangent, symmetric)
end

"""
Frees the material and calls release_user. NULL is fine. MPM_E_STATE while sets of it live.
"""
function mpm_material_destroy(material)
    return ccall((:mpm_material_destroy, libmpm), Int32, (Ptr{mpm_material},), material)
end

"""
Makes an empty set on a grid, of one material; both outlive it. *out is NULL unless MPM_OK is returned. MPM_E_ARG:
grid or material are of another context. MPM_E_UNSUPPORTED: a fluid on an MPM_CPGIMP grid; a fluid, snow, clay or mu_i
on an MPM_PLANE_STRESS grid; a fluid where total_lagrangian = 1.
"""
function mpm_particles_create(context, grid, material, out)
    return ccall((:mpm_particles_create, libmpm), Int32, (Ptr{mpm_context}, Ptr{mpm_grid}, Ptr{mpm_material}, Ptr{Ptr{mpm_particles}}),
        context, grid, material, out)
end

"""
Frees the set. NULL is fine. MPM_E_STATE while a stepper holds it or a view of it is out.
"""
function mpm_particles_destroy(particles)
    return ccall((:mpm_particles_destroy, libmpm), Int32, (Ptr{mpm_particles},), particles)
end

"""
Adds n particles with F = I, zero stress and the law's initial state: all or none. The arrays are copied; position,
velocity and size are [dim][n] with ld = n.

- position: a length, inside the grid; on a periodic axis one outside is wrapped, and its images are counted. With
  total_lagrangian = 1 the wrapped place is that in the grid, \"reference_position\" and \"position\" alike.
- velocity: length/time; NULL for zeros.
- volume: [n] initial volume, of the undeformed material, > 0; mass = density * volume.
- size: full initial edge lengths of the domain, > 0; NULL for a cube (2-D: square) of that volume. MPM_GIMP and
  MPM_CPGIMP use it; on other grids it is kept as given.
- ids: [n] the host's own ids, >= 0 and unique in the set; NULL to number on from the largest so far. A set holds
  fewer than 2^32 particles.
- first_id: the first of the ids is written to it; may be NULL.

MPM_E_ARG: a value is not finite, a position is outside the grid, a volume or size is <= 0, or an id is negative or in
use.
"""
function mpm_particles_add(particles, n, position, velocity, volume, size, ids, first_id)
    return ccall((:mpm_particles_add, libmpm), Int32, (Ptr{mpm_particles}, Int64, Ptr{Float64}, Ptr{Float64}, Ptr{Float64}, Ptr{Float64}, Ptr{Int64}, Ptr{Int64}),
        particles, n, position, velocity, volume, size, ids, first_id)
end

"""
Fills the box from lower[dim] to upper[dim] with particles at rest on a lattice aligned with the cells, with
per_cell[dim] particles along each axis of a cell, wherever the centre is inside. Each has the volume and the size of
one lattice cell, so that domains of GIMP fill the body. The ids of the new particles are *first_id to *first_id +
*count - 1; both pointers may be NULL.

What a shape has beyond the grid is left out, on periodic axes too, as symmetry planes want it: *count tells how many
particles there are. That holds for all fills. per_cell is 1 to 64, and a box has at most 2^32 lattice points, in the
shape or not.

MPM_E_ARG: a bound is not finite, lower >= upper on an axis, the box does not meet the grid, or a limit is exceeded.
"""
function mpm_particles_fill_box(particles, lower, upper, per_cell, first_id, count)
    return ccall((:mpm_particles_fill_box, libmpm), Int32, (Ptr{mpm_particles}, Ptr{Float64}, Ptr{Float64}, Ptr{Int32}, Ptr{Int64}, Ptr{Int64}),
        particles, lower, upper, per_cell, first_id, count)
end

"""
Fills a ball (2-D: disc, 1-D: interval) around centre[dim] of a radius > 0, as mpm_particles_fill_box() fills a box.
The centre lies in the grid.
"""
function mpm_particles_fill_ball(particles, centre, radius, per_cell, first_id, count)
    return ccall((:mpm_particles_fill_ball, libmpm), Int32, (Ptr{mpm_particles}, Ptr{Float64}, Float64, Ptr{Int32}, Ptr{Int64}, Ptr{Int64}),
        particles, centre, radius, per_cell, first_id, count)
end

"""
Fills that part of a box which the callback accepts, as mpm_particles_fill_box() fills the whole.
"""
function mpm_particles_fill(particles, lower, upper, per_cell, inside, user, first_id, count)
    return ccall((:mpm_particles_fill, libmpm), Int32, (Ptr{mpm_particles}, Ptr{Float64}, Ptr{Float64}, Ptr{Int32}, Ptr{Cvoid}, Ptr{Cvoid}, Ptr{Int64}, Ptr{Int64}),
        particles, lower, upper, per_cell, inside, user, first_id, count)
end

"""
Fills what a mesh encloses, as mpm_particles_fill_box() fills a box: triangles in 3-D, edges in 2-D.

- position: [dim][n] of the points; n is 1 to 2^31 - 1.
- corner: corner[dim * i + j] is the number of corner j of element i, of `elements`, 1 to 2^31 - 1. In 3-D the corners
  go counter-clockwise as seen from outside, in 2-D the outline goes counter-clockwise round the body. A mesh that is
  turned inside out encloses the same. Shells within that are turned the other way bound cavities.
- Points with the same coordinates are one point, so that triangles as files hold them need no sorting out.

A particle comes wherever the generalised winding number is above 1/2 or below -1/2 (Jacobson, Kavan & Sorkine-Hornung
2013, Robust inside-outside segmentation using generalized winding numbers, ACM Trans. Graph. 32(4), 33). Bodies that
overlap are filled once. Holes do no harm as long as they are small beside the body, but a mesh without any costs far
less time. A lattice point on the mesh itself may be in or out. The mesh is read during the call only.

MPM_E_ARG: a position is not finite, a corner does not exist, the mesh is flat or does not meet the grid, or a limit
is exceeded. MPM_E_UNSUPPORTED: the grid is 1-D. Nothing is then added.
"""
function mpm_particles_fill_mesh(particles, n, position, elements, corner, per_cell, first_id, count)
    return ccall((:mpm_particles_fill_mesh, libmpm), Int32, (Ptr{mpm_particles}, Int64, Ptr{Float64}, Int64, Ptr{Int64}, Ptr{Int32}, Ptr{Int64}, Ptr{Int64}),
        particles, n, position, elements, corner, per_cell, first_id, count)
end

"""
Removes the n particles with the given ids: all or none. MPM_E_NOT_FOUND: an id is not in the set. MPM_E_ARG: an id is
given twice.
"""
function mpm_particles_remove(particles, n, ids)
    return ccall((:mpm_particles_remove, libmpm), Int32, (Ptr{mpm_particles}, Int64, Ptr{Int64}), particles, n, ids)
end

"""
The number of particles, inert slots not counted; 0 for NULL.
"""
function mpm_particles_count(particles)
    return ccall((:mpm_particles_count, libmpm), Int64, (Ptr{mpm_particles},), particles)
end

"""
Describes the field with number index (from 0): its name, its type (MPM_F64, MPM_I64 or MPM_U8), the components of
copies, and whether the host may write it. The name belongs to the library and is valid while the set lives; output
pointers may be NULL. MPM_E_NOT_FOUND: index is past the last field.
"""
function mpm_particles_field_info(particles, index, field, type_, components, writable)
    return ccall((:mpm_particles_field_info, libmpm), Int32, (Ptr{mpm_particles}, Int32, Ptr{Ptr{UInt8}}, Ptr{Int32}, Ptr{Int32}, Ptr{Int32}),
        particles, index, field, type_, components, writable)
end

"""
Adds a field of the host, zero in every particle. It travels with the particles, is saved with them, and reaches
callbacks through mpm_batch_field(). The name has 1 to 47 characters of a-z, 0-9 and _; type is MPM_F64, MPM_I64 or
MPM_U8; components are 1 to 64. A set has at most 64 fields, the 17 of the table included. MPM_E_ARG: the name is bad
or taken, or a value is. MPM_E_STATE: there is no room for one more.
"""
function mpm_particles_add_field(particles, field, type_, components)
    return ccall((:mpm_particles_add_field, libmpm), Int32, (Ptr{mpm_particles}, Cstring, Int32, Int32),
        particles, field, type_, components)
end

"""
Says of a field of the host that its values are amounts, as mass is, and not densities: particles that are split share
them, and merged ones have the sum. Of other fields they have the same value, and merged ones the mean by initial
volume. The field is of type MPM_F64; values of other types are those of the heavier particle. extensive is 0 (as
added) or 1. MPM_E_NOT_FOUND: there is no such field. MPM_E_ARG: the field is not the host's, or of another type.
MPM_E_STATE: as for all that changes a set.
"""
function mpm_particles_set_extensive(particles, field, extensive)
    return ccall((:mpm_particles_set_extensive, libmpm), Int32, (Ptr{mpm_particles}, Cstring, Int32),
        particles, field, extensive)
end

"""
Lends a field in library order, with its stored components and with inert slots (id < 0); a map of \"id\" tells which
is which. access is MPM_READ, MPM_WRITE or both. The caller sets the view's struct_size. Until mpm_view_release()
steps return MPM_E_STATE. Of a set at most 64 views are out at once. A view without MPM_WRITE is for reading: see
mpm_view_release() for what becomes of changes. MPM_E_NOT_FOUND: there is no such field. MPM_E_ARG: MPM_WRITE is asked
for on a field that is not writable. MPM_E_STATE: 64 views are out.
"""
function mpm_particles_map(particles, field, access, view)
    return ccall((:mpm_particles_map, libmpm), Int32, (Ptr{mpm_particles}, Cstring, Int32, Ptr{mpm_view}),
        particles, field, access, view)
end

"""
Copies a field of n particles into out, [components][n] with ld = n; tensors are full. ids are [n], or NULL for all
particles by ascending id, where n is mpm_particles_count(). type and components must match the full field, to guard
the host's buffer. MPM_E_NOT_FOUND: there is no such field or id. MPM_E_ARG: type, components or n do not match.
"""
function mpm_particles_get(particles, field, type_, components, n, ids, out)
    return ccall((:mpm_particles_get, libmpm), Int32, (Ptr{mpm_particles}, Cstring, Int32, Int32, Int64, Ptr{Int64}, Ptr{Cvoid}),
        particles, field, type_, components, n, ids, out)
end

"""
Copies count named fields of all particles into floats for renderers: particles one after the other, without inert
slots, of each the components of the first field, then those of the second, and so on. Components are those of
mpm_particles_get(), with full tensors and dim components per vector, and out has n times the sum of them.

- order: MPM_BY_ID, or MPM_LIBRARY_ORDER, which is faster: it reads memory from front to back and needs no index of
  the ids. In it a particle may have another place after each step; the field \"id\" tells them apart.
- n: mpm_particles_count(), to guard the host's buffer.

Values are rounded to the nearest float. Those that no float can hold become infinities with their sign (from about
3.4e38 on), those below the smallest float (1.4e-45) become 0. Integers are exact up to 2^24 = 16777216.

MPM_E_NOT_FOUND: there is no such field. MPM_E_ARG: count is < 1, a field is named twice, or order or n is none of
these. Else as mpm_particles_get(); views may be out. Since 0.2.0.
"""
function mpm_particles_get_f32(particles, count, fields, order, n, out)
    return ccall((:mpm_particles_get_f32, libmpm), Int32, (Ptr{mpm_particles}, Int32, Ptr{Cstring}, Int32, Int64, Ptr{Cfloat}),
        particles, count, fields, order, n, out)
end

"""
Copies values into a field, laid out as in mpm_particles_get(): all or none. Errors are those of mpm_particles_get(),
and MPM_E_ARG: a value is not finite or gives det F <= 0, a position is outside the grid, or the field is not
writable.
"""
function mpm_particles_set(particles, field, type_, components, n, ids, values)
    return ccall((:mpm_particles_set, libmpm), Int32, (Ptr{mpm_particles}, Cstring, Int32, Int32, Int64, Ptr{Int64}, Ptr{Cvoid}),
        particles, field, type_, components, n, ids, values)
end

"""
Sets a field to one value[components] in every particle of the set. Errors are those of mpm_particles_set().
"""
function mpm_particles_set_all(particles, field, type_, components, value)
    return ccall((:mpm_particles_set_all, libmpm), Int32, (Ptr{mpm_particles}, Cstring, Int32, Int32, Ptr{Cvoid}),
        particles, field, type_, components, value)
end

"""
Gives all particles the stress of ground at rest below a level surface: along `axis` the pressure of the weight above,
surcharge + density * |gravity| * depth with the material's density, and K0 times that across it; no shear. Each layer
is a set, whose surface is its top and whose surcharge the weight of what lies on it.

- gravity: acceleration along the axis, length/time^2, with its sign, as in mpm_stepper_desc: with a negative one the
  ground lies below the surface in the sense of falling coordinates. Not 0.
- surface: coordinate of the surface on the axis, a length. No particle may lie above it.
- K0: horizontal over vertical stress, >= 0: nu / (1 - nu) is what an elastic column has that was never strained
  across, 1 - sin(phi) what sand has. One that a law cannot bear is no error: its first step returns the stress to the
  yield surface.
- surcharge: pressure on the surface, a stress >= 0. It must also be applied, or the ground heaves.

Positions, velocities, masses, state variables and present volumes stay. Where stress is the state of the law,
deformation_gradient becomes I and initial_volume the present volume. Where stress follows from deformation_gradient,
that becomes the diagonal one that has the stress, up to rounding, and initial_volume the present volume over its
determinant; in 1-D, where nothing is stored across, the stress across is then that of the law, whatever K0 is.
herschel_bulkley gets the mean of the stress so, and its deviator as it is given. dilation_ratio becomes 1, and with
MPM_CPGIMP the field \"size\" what keeps the domains as they are.

The set is unchanged on failure. MPM_E_ARG: a value is bad or not finite, the axis is periodic, a particle lies above
the surface, or no deformation has the stress; the particle is named. MPM_E_UNSUPPORTED: the law is \"rigid\", or
\"snow\", whose stress takes more than a deformation; it is \"newtonian_fluid\" and K0 is not 1; or, of the host's
laws, one that asked with dt = 0 does not answer with the stress that it has; the grid is MPM_PLANE_STRESS, or axis
the radius of MPM_AXISYMMETRIC; total_lagrangian = 1 and the stress follows from deformation_gradient, or the ground
has already deformed. MPM_E_CALLBACK: that law failed. MPM_E_STATE: as for all that changes a set. Since 0.2.0.
"""
function mpm_particles_set_geostatic(particles, axis, gravity, surface, K0, surcharge)
    return ccall((:mpm_particles_set_geostatic, libmpm), Int32, (Ptr{mpm_particles}, Int32, Float64, Float64, Float64, Float64),
        particles, axis, gravity, surface, K0, surcharge)
end

"""
Makes the present state the one from which all deformation counts: deformation_gradient becomes I, initial_volume the
present volume, dilation_ratio 1, and reference_position, where there is one, the present (unwrapped) position. With
MPM_CPGIMP and of MPM_AXISYMMETRIC edges in \"size\" become the present ones. Of MPM_PLANE_STRESS F33 stays. Mass,
velocity, Cauchy stress and state variables stay. With total_lagrangian = 1 particles are then in the grid where they
are now, and velocity_gradient is over these positions.

Laws that store Cauchy stress and work with tau = J stress (drucker_prager, mohr_coulomb, mu_i, cam_clay) find J = 1
from then on: elastic strain, energy per initial volume and cohesion count by the present volume, which differ by the
factor J from before; a stress on the yield surface may lie off it by as much, and the next step returns it.

The set is unchanged on failure. MPM_E_ARG: total_lagrangian = 1 and a particle is outside the box. MPM_E_UNSUPPORTED:
the stress of the law, or its mean, follows from deformation_gradient, which must stay; or a law of the host, asked
with dt = 0, does not answer with the stress that it has. MPM_E_CALLBACK: that law failed. MPM_E_STATE: as for all
that changes a set, and with total_lagrangian = 1 while a surface of its stepper has markers, whose places count from
the old reference. Since 0.2.0.
"""
function mpm_particles_reset_reference(particles)
    return ccall((:mpm_particles_reset_reference, libmpm), Int32, (Ptr{mpm_particles},), particles)
end

"""
Describes the system. This call and the two below may be made from within the solve callback only, one at a time; at
other times they return MPM_E_STATE. It waits for no other part. MPM_E_UNSUPPORTED: there are several parts, and
struct_size is that of a release without number.
"""
function mpm_operator_get_info(matrix, info)
    return ccall((:mpm_operator_get_info, libmpm), Int32, (Ptr{mpm_operator}, Ptr{mpm_operator_info}), matrix, info)
end

"""
Computes y = matrix * x on owned rows. Both vectors have owned_rows entries and do not overlap.

With several parts it is (collective): x of rows that others own comes from them. It fails on all parts that make it
when one is refused, and with MPM_E_STATE when the solver has returned on a part, so that nobody waits.
"""
function mpm_operator_apply(matrix, x, y)
    return ccall((:mpm_operator_apply, libmpm), Int32, (Ptr{mpm_operator}, Ptr{Float64}, Ptr{Float64}), matrix, x, y)
end

"""
Lends the matrix by compressed rows, with both triangles and with columns in ascending order: row r has the entries
(*row_start)[r] to (*row_start)[r + 1] - 1 of *column and *value. Columns are local ones, and number of
mpm_operator_info has those over all parts; rows that others own are empty. The arrays belong to the library and are
valid until the solve callback returns. It waits for no other part. MPM_E_NOMEM: there is no memory for them.
"""
function mpm_operator_csr(matrix, row_start, column, value)
    return ccall((:mpm_operator_csr, libmpm), Int32, (Ptr{mpm_operator}, Ptr{Ptr{Int64}}, Ptr{Ptr{Int32}}, Ptr{Ptr{Float64}}),
        matrix, row_start, column, value)
end

"""
Fills desc with the defaults. struct_size is sizeof(mpm_stepper_desc) of the caller; no byte beyond is written.
MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
"""
function mpm_stepper_desc_init(desc, struct_size)
    return ccall((:mpm_stepper_desc_init, libmpm), Int32, (Ptr{mpm_stepper_desc}, UInt32), desc, struct_size)
end

"""
Makes a stepper at t = 0 and step 0, without sets, with MPM_WALL_NONE on all faces (the axis of MPM_AXISYMMETRIC has
MPM_WALL_SLIP). desc is copied and may be NULL for the defaults. The grid outlives the stepper. *out is NULL unless
MPM_OK is returned. MPM_E_ARG: a value is bad, or the grid is of another context. MPM_E_UNSUPPORTED: the combination
is not offered; the error text says what to use instead.
"""
function mpm_stepper_create(context, grid, desc, out)
    return ccall((:mpm_stepper_create, libmpm), Int32, (Ptr{mpm_context}, Ptr{mpm_grid}, Ptr{mpm_stepper_desc}, Ptr{Ptr{mpm_stepper}}),
        context, grid, desc, out)
end

"""
Frees the stepper. Its sets live on and are free for another. NULL is fine. MPM_E_STATE while a view of its nodal
fields is out or a staged step is under way.
"""
function mpm_stepper_destroy(stepper)
    return ccall((:mpm_stepper_destroy, libmpm), Int32, (Ptr{mpm_stepper},), stepper)
end

"""
Adds a set to the time loop. The host keeps owning it, and cannot destroy it while it is in. All sets of a body share
one velocity field; this one comes into body 0. MPM_E_STATE: the set is in a stepper already. MPM_E_ARG: it is on
another grid.
"""
function mpm_stepper_add(stepper, particles)
    return ccall((:mpm_stepper_add, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_particles}), stepper, particles)
end

"""
Takes a set out of the time loop. MPM_E_NOT_FOUND: it is not in this stepper.
"""
function mpm_stepper_remove(stepper, particles)
    return ccall((:mpm_stepper_remove, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_particles}), stepper, particles)
end

"""
Replaces the options between steps. Any field may change, the scheme too; desc is copied. Errors are those of
mpm_stepper_create(), and MPM_E_STATE during a staged step.
"""
function mpm_stepper_configure(stepper, desc)
    return ccall((:mpm_stepper_configure, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_stepper_desc}), stepper, desc)
end

"""
Sets the time and the number of steps counted. Sums over steps (mpm_stepper_wall_impulse(),
mpm_stepper_particles_impulse(), external_work_total) start anew from 0. MPM_E_ARG: t is not finite, or step < 0.
"""
function mpm_stepper_set_time(stepper, t, step)
    return ccall((:mpm_stepper_set_time, libmpm), Int32, (Ptr{mpm_stepper}, Float64, Int64), stepper, t, step)
end

"""
Moves the prescribed particles of a set (platens, pistons). mean_velocity (mt) is called at the start of a step for
the particles of the set, unless none is prescribed, and adds the mean velocity u of the coming step to zeros; what it
gives to other particles is ignored. NULL takes the callback away: the particles keep their velocity.

On its prescribed axes a particle moves by dt u and ends with the velocity u, with every transfer; the nodes to which
it gives mass move with u too, or with the mean of several by that mass. On other axes, and in deformation and stress,
it is a particle like others. MPM_NONFINITE names the particle. A state does not hold the callback: after one has been
loaded that had it, no step is made (MPM_E_STATE) until it has been set, before loading or after, or answered by NULL
after it. MPM_E_NOT_FOUND: the set is not in this stepper.
"""
function mpm_stepper_set_motion(stepper, particles, mean_velocity, user)
    return ccall((:mpm_stepper_set_motion, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_particles}, Ptr{Cvoid}, Ptr{Cvoid}),
        stepper, particles, mean_velocity, user)
end

"""
Sets what a face (MPM_X_MIN to MPM_Z_MAX) does: kind is one of MPM_WALL_NONE to MPM_WALL_FRICTION_NODES. friction is
the Coulomb coefficient, >= 0, of the last two, and is not used otherwise. Such a wall is unilateral: its normal
impulse only pushes, and its tangential impulse is at most friction times that; but for a node that parts and touches
again and again in the iterations of an implicit step, which is then held in it and may be pulled. MPM_E_ARG: the grid
does not have the face, the face is periodic, or a value is bad. MPM_E_UNSUPPORTED: MPM_WALL_FRICTION_NODES with
MPM_NEWMARK; MPM_WALL_OPEN with total_lagrangian = 1; on the axis of MPM_AXISYMMETRIC another kind than MPM_WALL_SLIP.
"""
function mpm_stepper_set_wall(stepper, face, kind, friction)
    return ccall((:mpm_stepper_set_wall, libmpm), Int32, (Ptr{mpm_stepper}, Int32, Int32, Float64),
        stepper, face, kind, friction)
end

"""
Sets the callback that adds accelerations of particles, length/time^2 (b of MPoint theory, eq. 21). It is called for
every set. NULL takes it away.
"""
function mpm_stepper_set_acceleration(stepper, fn, user)
    return ccall((:mpm_stepper_set_acceleration, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{Cvoid}, Ptr{Cvoid}),
        stepper, fn, user)
end

"""
Sets the callback that adds forces on particles, mass length/time^2 (f^app of MPoint theory, eq. 21). It is called for
every set. NULL takes it away.
"""
function mpm_stepper_set_force(stepper, fn, user)
    return ccall((:mpm_stepper_set_force, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{Cvoid}, Ptr{Cvoid}),
        stepper, fn, user)
end

"""
Sets the callback that prescribes nodal velocities, length/time. NULL takes it away.
"""
function mpm_stepper_set_velocity_bc(stepper, fn, user)
    return ccall((:mpm_stepper_set_velocity_bc, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{Cvoid}, Ptr{Cvoid}),
        stepper, fn, user)
end

"""
Sets the hook of a stage, one of MPM_AFTER_P2G to MPM_AFTER_VELOCITY. NULL takes it away. In a step in parts all hooks
run in mpm_step_grid(), after what the host has written itself. MPM_E_ARG: there is no such stage. MPM_E_UNSUPPORTED
with MPM_NEWMARK.
"""
function mpm_stepper_set_node_hook(stepper, stage, fn, user)
    return ccall((:mpm_stepper_set_node_hook, libmpm), Int32, (Ptr{mpm_stepper}, Int32, Ptr{Cvoid}, Ptr{Cvoid}),
        stepper, stage, fn, user)
end

"""
Sets the solver of MPM_SOLVER_HOST: see operator.h. NULL takes it away.
"""
function mpm_stepper_set_linear_solver(stepper, fn, user)
    return ccall((:mpm_stepper_set_linear_solver, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{Cvoid}, Ptr{Cvoid}),
        stepper, fn, user)
end

"""
Sets the progress callback, which runs on the calling thread. NULL takes it away.
"""
function mpm_stepper_set_progress(stepper, fn, user)
    return ccall((:mpm_stepper_set_progress, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{Cvoid}, Ptr{Cvoid}),
        stepper, fn, user)
end

"""
Gives the stable dt of an explicit step from the present state, at CFL number 1 (MPoint theory, eqs 45-46): 1 / max
over particles and axes of (|v_k| + c) / h_k, where c is the law's current wave speed, and at most h^2 / (2 dim nu)
where a law reports a kinematic viscosity nu; h is the smallest spacing. Explicit steps want a share of it. It is
infinite where nothing moves and no law has waves. Obstacles that move count by the speed of their fastest point. The
call runs the laws. MPM_E_STATE: there are no particles, or a view is out.
"""
function mpm_stable_dt(stepper, dt)
    return ccall((:mpm_stable_dt, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{Float64}), stepper, dt)
end

"""
Makes one step of size dt > 0. After any status but MPM_OK particles and time are bit-identical to before. info may be
NULL; it is filled on success and on failure.

- MPM_CUT_DT, MPM_INVERTED, MPM_NONFINITE, MPM_NOT_CONVERGED, MPM_SINGULAR: a smaller dt may do.
- MPM_OFF_GRID: a particle would leave through a face that does not let it. In implicit steps a smaller dt may do here
  as well.
- MPM_CANCELLED: the progress callback ended the step.
- MPM_E_ARG: dt is not finite or not > 0.
- MPM_E_CALLBACK: a callback or the host's executor failed.
- MPM_E_STATE: a view is out, a staged step is under way, a set has values to be repaired, or the state that was
  loaded had a motion callback that is not set.
"""
function mpm_step(stepper, dt, info)
    return ccall((:mpm_step, libmpm), Int32, (Ptr{mpm_stepper}, Float64, Ptr{mpm_step_info}), stepper, dt, info)
end

"""
Fills desc with the defaults; the host must set t_end. struct_size is sizeof(mpm_advance_desc) of the caller; no byte
beyond is written. MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
"""
function mpm_advance_desc_init(desc, struct_size)
    return ccall((:mpm_advance_desc_init, libmpm), Int32, (Ptr{mpm_advance_desc}, UInt32), desc, struct_size)
end

"""
Steps to t_end exactly. Statuses 1..5 cut dt to 0.6 of it and try again, and success lets it grow; the controller's dt
is part of the saved state. In implicit steps MPM_OFF_GRID cuts as well, but no more than 20 times before the time
comes to where one of these steps would have ended: a body that moves out by itself does so in steps of any length. On
failure the state is that of the last committed sub-step, and the status is the cause. After max_cuts cuts in a row
(60: dt is 5e-14 of what it was), or where another would go below dt_min or no longer move the time, the call gives
up, and mpm_last_error() says so and why the last try failed; the next call begins with the dt of before the cuts.
info may be NULL; it is that of the last sub-step tried. The call returns MPM_OK with t < t_end when max_steps ran
out. Errors are those of mpm_step(); MPM_E_ARG: t_end is before the present time, or a value is bad.
"""
function mpm_advance(stepper, desc, info)
    return ccall((:mpm_advance, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_advance_desc}, Ptr{mpm_step_info}),
        stepper, desc, info)
end

"""
Copies the times into out, then sets them to zero if reset is not 0. They cost the steps one clock read per stage.
"""
function mpm_stepper_profile(stepper, reset, out)
    return ccall((:mpm_stepper_profile, libmpm), Int32, (Ptr{mpm_stepper}, Int32, Ptr{mpm_profile}),
        stepper, reset, out)
end

"""
Gives the info of the state as it is, also before the first step. What belongs to a step is that of the last one.
MPM_E_STATE while a set is mapped for writing.
"""
function mpm_stepper_info(stepper, info)
    return ccall((:mpm_stepper_info, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_step_info}), stepper, info)
end

"""
Gives the history of the last implicit step: ||residual|| / scale (the scale includes reactions) from before the first
solve to the converged or failed end. *count tells how many values there are; the first capacity of them are copied
into residual, which may be NULL when capacity is 0. The history is kept until the next step; *count is 0 after
explicit ones.
"""
function mpm_stepper_residuals(stepper, capacity, residual, count)
    return ccall((:mpm_stepper_residuals, libmpm), Int32, (Ptr{mpm_stepper}, Int32, Ptr{Float64}, Ptr{Int32}),
        stepper, capacity, residual, count)
end

"""
Makes the first part of an explicit step in parts: particles to grid, and forces. With MPM_USF strain and stress of
the step come before them, for which the callbacks of prescribed velocities are asked here. Until mpm_step_end() or
mpm_step_abort() the host may map nodal fields between the parts, and change \"velocity\" and \"force\". Errors are
those of mpm_step(), and MPM_E_UNSUPPORTED with MPM_NEWMARK. A part that fails with any status but MPM_E_STATE or
MPM_E_ARG aborts the step.
"""
function mpm_step_begin(stepper, dt)
    return ccall((:mpm_step_begin, libmpm), Int32, (Ptr{mpm_stepper}, Float64), stepper, dt)
end

"""
Makes the second part: nodal velocities, walls, prescribed velocities. MPM_E_STATE unless it follows mpm_step_begin().
"""
function mpm_step_grid(stepper)
    return ccall((:mpm_step_grid, libmpm), Int32, (Ptr{mpm_stepper},), stepper)
end

"""
Makes the last part: grid to particles, stress, commit. info may be NULL. MPM_E_STATE unless it follows
mpm_step_grid(). The three parts in a row give the same bits as mpm_step(), except with MPM_APIC_MLS, where a whole
step fuses force and momentum: there they agree to rounding.
"""
function mpm_step_end(stepper, info)
    return ccall((:mpm_step_end, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_step_info}), stepper, info)
end

"""
Drops the step that was begun; particles and time are as before it. MPM_E_STATE: none was begun, or a view of nodal
fields is out.
"""
function mpm_step_abort(stepper)
    return ccall((:mpm_step_abort, libmpm), Int32, (Ptr{mpm_stepper},), stepper)
end

"""
Lends a field of the active nodes: of a staged step while one is under way, of the last step otherwise. The view's
struct_size is set by the caller. Until mpm_view_release() steps and their parts return MPM_E_STATE. Periodic images
and mirrored ghosts are listed beside the nodes that they follow.

| field                              | type | components | what it is                                    |
|------------------------------------|------|------------|-----------------------------------------------|
| \"index\"                            | I64  | dim        | as in mpm_node_batch                          |
| \"mass\"                             | F64  | 1          | nodal mass                                    |
| \"position\" \"velocity\"              | F64  | dim        | length, length/time                           |
| \"force\" \"acceleration\"             | F64  | dim        | internal and external force; length/time^2    |
| \"reaction\"                         | F64  | dim        | force of walls and prescribed velocities      |
| \"contact_force\"                    | F64  | dim        | force of other bodies and of obstacles        |
| \"contact_normal\"                   | F64  | dim        | unit, away from the body, where it meets them |
| \"contact_gap\" \"contact_area\"       | F64  | 1          | length, infinite where it meets nothing       |
| \"temperature\"                      | F64  | 1          | at the end of the step, where sets have heat  |
| \"owned\"                            | U8   | 1          | as in mpm_node_batch                          |

- body: velocity field, of which there is one for each body (mpm_stepper_set_body()).
- MPM_E_STATE: nothing has been stepped yet, or MPM_WRITE is asked for outside a staged step.
- MPM_E_NOT_FOUND: there is no such field or body.
- MPM_E_ARG: MPM_WRITE is asked for on a field other than \"velocity\" and \"force\".
- MPM_E_UNSUPPORTED: \"force\" or \"acceleration\" after a whole step of MPM_APIC_MLS, which does not keep them; a
  staged step and MPM_APIC do.
"""
function mpm_grid_map(stepper, body, field, access, view)
    return ccall((:mpm_grid_map, libmpm), Int32, (Ptr{mpm_stepper}, Int32, Cstring, Int32, Ptr{mpm_view}),
        stepper, body, field, access, view)
end

"""
Gives the force[dim] that the wall at a face exerts on the material: the mean over the last step, or with MPM_NEWMARK
the one at its end, but for friction walls. MPM_E_ARG: there is no such face. MPM_E_STATE before the first step.
"""
function mpm_stepper_wall_reaction(stepper, face, force)
    return ccall((:mpm_stepper_wall_reaction, libmpm), Int32, (Ptr{mpm_stepper}, Int32, Ptr{Float64}),
        stepper, face, force)
end

"""
Gives the force[dim] that the prescribed particles of a set exert on the material, on the axes on which they are
prescribed: the mean over the last step, or with MPM_NEWMARK the one at its end. It is what holds them, less their own
inertia, weight and external forces; 0 for a set without such particles. What a body of its own gives others through
contact is not in it: mpm_stepper_contact_info() has that. MPM_E_NOT_FOUND: the set is not in this stepper.
MPM_E_STATE before the first step.
"""
function mpm_stepper_particles_reaction(stepper, prescribed, force)
    return ccall((:mpm_stepper_particles_reaction, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_particles}, Ptr{Float64}),
        stepper, prescribed, force)
end

"""
Gives the impulse[dim] of the wall at a face on the material, mass * length/time: the sum of
mpm_stepper_wall_reaction() times the time over which it acted, over all committed steps since the stepper was made or
mpm_stepper_set_time() was called; 0 before the first. A host that uses mpm_advance() measures forces by it: the
difference of two calls over the time between them is the mean force. With MPM_NEWMARK a step adds dt times the force
at its end, and with `staggered` the mean of two dt times its force. Steps that fail add nothing, and a saved state
holds it. MPM_E_ARG: there is no such face.
"""
function mpm_stepper_wall_impulse(stepper, face, impulse)
    return ccall((:mpm_stepper_wall_impulse, libmpm), Int32, (Ptr{mpm_stepper}, Int32, Ptr{Float64}),
        stepper, face, impulse)
end

"""
Gives the impulse[dim] of the prescribed particles of a set on the material, the sum of
mpm_stepper_particles_reaction() in the same way. It is 0 when a set is added, and forgotten when it is removed.
MPM_E_NOT_FOUND: the set is not in this stepper.
"""
function mpm_stepper_particles_impulse(stepper, prescribed, impulse)
    return ccall((:mpm_stepper_particles_impulse, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_particles}, Ptr{Float64}),
        stepper, prescribed, impulse)
end

"""
Puts a set into a body: 0 <= body < 4096, at first 0. Between steps, also with particles in it. Sets of one body share
one velocity field. MPM_E_NOT_FOUND: the set is not in this stepper. MPM_E_ARG: there is no such body.
MPM_E_UNSUPPORTED: with MPM_NEWMARK, bodies that touch with adhesion, or by MPM_SOLVER_MULTIGRID_CG; with
total_lagrangian = 1 another body than 0, because bodies touch at nodes that both have. MPM_E_STATE during a staged
step, or while a view of nodal fields is out; there are no nodal fields then until the next step.
"""
function mpm_stepper_set_body(stepper, particles, body)
    return ccall((:mpm_stepper_set_body, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_particles}, Int32),
        stepper, particles, body)
end

"""
Gives the body of a set. MPM_E_NOT_FOUND: it is not in this stepper.
"""
function mpm_stepper_body(stepper, particles, body)
    return ccall((:mpm_stepper_body, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_particles}, Ptr{Int32}),
        stepper, particles, body)
end

"""
Fills desc with the defaults. struct_size is sizeof(mpm_contact_desc) of the caller; no byte beyond is written.
MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
"""
function mpm_contact_desc_init(desc, struct_size)
    return ccall((:mpm_contact_desc_init, libmpm), Int32, (Ptr{mpm_contact_desc}, UInt32), desc, struct_size)
end

"""
Sets how two bodies meet; desc is copied. The order of the bodies matters for `direction` alone. With MPM_BODY_ANY for
one body: how the other meets those that have no rule of their own with it; for both: how all meet that have no closer
rule. Of the rules of two bodies each with MPM_BODY_ANY, that of the lower number counts. A later call replaces an
earlier one for the same pair; NULL takes the rule back. Without any rule the defaults of mpm_contact_desc_init()
hold. A saved state holds the rules. MPM_E_ARG: a value is bad. MPM_E_UNSUPPORTED: adhesion with detection by
velocity; with MPM_NEWMARK, adhesion, or MPM_SOLVER_MULTIGRID_CG, of bodies that there are. MPM_E_STATE during a
staged step.
"""
function mpm_stepper_set_contact(stepper, body_a, body_b, desc)
    return ccall((:mpm_stepper_set_contact, libmpm), Int32, (Ptr{mpm_stepper}, Int32, Int32, Ptr{mpm_contact_desc}),
        stepper, body_a, body_b, desc)
end

"""
Sets the callback for coefficients of friction. NULL takes it away. The host sets it again after it has loaded a state
into another stepper. MPM_E_UNSUPPORTED with MPM_NEWMARK.
"""
function mpm_stepper_set_friction(stepper, fn, user)
    return ccall((:mpm_stepper_set_friction, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{Cvoid}, Ptr{Cvoid}),
        stepper, fn, user)
end

"""
Gives what two bodies did in the last step; for body_a MPM_BODY_ANY the sum over all others, on body_b; the other way
round what they suffered. Bodies that never were near each other have zeros, and an infinite gap. MPM_E_ARG: the
bodies are the same or there is no such body. MPM_E_STATE before the first step.
"""
function mpm_stepper_contact_info(stepper, body_a, body_b, info)
    return ccall((:mpm_stepper_contact_info, libmpm), Int32, (Ptr{mpm_stepper}, Int32, Int32, Ptr{mpm_contact_info}),
        stepper, body_a, body_b, info)
end

"""
Fills desc with the defaults. struct_size is sizeof(mpm_obstacle_desc) of the caller; no byte beyond is written.
MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
"""
function mpm_obstacle_desc_init(desc, struct_size)
    return ccall((:mpm_obstacle_desc_init, libmpm), Int32, (Ptr{mpm_obstacle_desc}, UInt32), desc, struct_size)
end

"""
Makes an obstacle. The desc is copied. *out becomes NULL on failure. MPM_E_ARG: a value is bad. MPM_E_UNSUPPORTED:
velocities of a fixed one, bounds of one that the material is inside of.
"""
function mpm_obstacle_create(context, desc, out)
    return ccall((:mpm_obstacle_create, libmpm), Int32, (Ptr{mpm_context}, Ptr{mpm_obstacle_desc}, Ptr{Ptr{mpm_obstacle}}),
        context, desc, out)
end

"""
Frees an obstacle; NULL is let pass. MPM_E_STATE: a stepper holds it.
"""
function mpm_obstacle_destroy(obstacle)
    return ccall((:mpm_obstacle_destroy, libmpm), Int32, (Ptr{mpm_obstacle},), obstacle)
end

"""
Puts an obstacle into a stepper, with those that are there in the order of adding. MPM_E_STATE: it is in a stepper
already, or a step is under way. MPM_E_UNSUPPORTED: the shape does not exist in the dimension of the grid; it is free,
and the grid MPM_AXISYMMETRIC or the scheme MPM_NEWMARK, which refuses the adhesion of an obstacle in the step.
MPM_E_ARG: it is turned out of a 2-D or 1-D grid, or moves out of it.
"""
function mpm_stepper_add_obstacle(stepper, obstacle)
    return ccall((:mpm_stepper_add_obstacle, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_obstacle}), stepper, obstacle)
end

"""
Takes an obstacle out, and what it has reported. MPM_E_NOT_FOUND: it is not in this stepper.
"""
function mpm_stepper_remove_obstacle(stepper, obstacle)
    return ccall((:mpm_stepper_remove_obstacle, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_obstacle}),
        stepper, obstacle)
end

"""
Sets how an obstacle moves in each step, for MPM_MOTION_PRESCRIBED (MPM_E_UNSUPPORTED with others). NULL: it keeps its
velocities. A state does not hold it: after one has been loaded that had it, no step is made (MPM_E_STATE) until it
has been set, before loading or after, or answered by NULL after it. MPM_E_STATE during a staged step.
"""
function mpm_obstacle_set_motion(obstacle, fn, user)
    return ccall((:mpm_obstacle_set_motion, libmpm), Int32, (Ptr{mpm_obstacle}, Ptr{Cvoid}, Ptr{Cvoid}),
        obstacle, fn, user)
end

"""
Sets how an obstacle meets the material, as mpm_obstacle_desc.contact does. MPM_E_ARG: a value is bad; nothing is
changed. MPM_E_STATE during a staged step.
"""
function mpm_obstacle_set_contact(obstacle, contact)
    return ccall((:mpm_obstacle_set_contact, libmpm), Int32, (Ptr{mpm_obstacle}, Ptr{mpm_contact_desc}),
        obstacle, contact)
end

"""
Puts an obstacle somewhere: position[3], orientation[4], velocity[3] and angular_velocity[3] as in mpm_obstacle_desc,
each NULL to keep it. MPM_E_ARG: a value is bad; nothing is changed. MPM_E_UNSUPPORTED: a velocity other than 0 of a
fixed one. MPM_E_STATE during a staged step.
"""
function mpm_obstacle_set_pose(obstacle, position, orientation, velocity, angular_velocity)
    return ccall((:mpm_obstacle_set_pose, libmpm), Int32, (Ptr{mpm_obstacle}, Ptr{Float64}, Ptr{Float64}, Ptr{Float64}, Ptr{Float64}),
        obstacle, position, orientation, velocity, angular_velocity)
end

"""
Gives where an obstacle is and how it moves; each may be NULL.
"""
function mpm_obstacle_get_pose(obstacle, position, orientation, velocity, angular_velocity)
    return ccall((:mpm_obstacle_get_pose, libmpm), Int32, (Ptr{mpm_obstacle}, Ptr{Float64}, Ptr{Float64}, Ptr{Float64}, Ptr{Float64}),
        obstacle, position, orientation, velocity, angular_velocity)
end

"""
Sets the force[3] and the torque[3] about its centre that act on a free obstacle beside gravity and contact, until
they are set anew; each NULL to keep it. MPM_E_UNSUPPORTED: it is not free. MPM_E_STATE during a staged step.
"""
function mpm_obstacle_set_load(obstacle, force, torque)
    return ccall((:mpm_obstacle_set_load, libmpm), Int32, (Ptr{mpm_obstacle}, Ptr{Float64}, Ptr{Float64}),
        obstacle, force, torque)
end

"""
Gives what a body and an obstacle did to each other in the last step; body MPM_BODY_ANY: all of them. force and
impulse are on the material, -force is on the obstacle; torque is that on the obstacle, about its centre; nodes are
those that could be constrained. MPM_E_STATE: it is in no stepper, or that has made no step yet.
"""
function mpm_obstacle_contact_info(obstacle, body, info)
    return ccall((:mpm_obstacle_contact_info, libmpm), Int32, (Ptr{mpm_obstacle}, Int32, Ptr{mpm_contact_info}),
        obstacle, body, info)
end

"""
Fills desc with the defaults. struct_size is sizeof(mpm_surface_desc) of the caller; no byte beyond is written.
MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
"""
function mpm_surface_desc_init(desc, struct_size)
    return ccall((:mpm_surface_desc_init, libmpm), Int32, (Ptr{mpm_surface_desc}, UInt32), desc, struct_size)
end

"""
Makes a surface without markers on a grid, which outlives it. desc is copied and may be NULL for the defaults. *out is
NULL unless MPM_OK is returned. MPM_E_ARG: a value is bad, or the grid is of another context.
"""
function mpm_surface_create(context, grid, desc, out)
    return ccall((:mpm_surface_create, libmpm), Int32, (Ptr{mpm_context}, Ptr{mpm_grid}, Ptr{mpm_surface_desc}, Ptr{Ptr{mpm_surface}}),
        context, grid, desc, out)
end

"""
Frees a surface; NULL is let pass. MPM_E_STATE: a stepper holds it.
"""
function mpm_surface_destroy(surface)
    return ccall((:mpm_surface_destroy, libmpm), Int32, (Ptr{mpm_surface},), surface)
end

"""
Replaces loads and options between steps. Errors are those of mpm_surface_create(), and MPM_E_STATE during a staged
step.
"""
function mpm_surface_configure(surface, desc)
    return ccall((:mpm_surface_configure, libmpm), Int32, (Ptr{mpm_surface}, Ptr{mpm_surface_desc}), surface, desc)
end

"""
Sets the callback that adds tractions. NULL takes it away. The host sets it again after it has loaded a state.
MPM_E_STATE during a staged step.
"""
function mpm_surface_set_traction(surface, fn, user)
    return ccall((:mpm_surface_set_traction, libmpm), Int32, (Ptr{mpm_surface}, Ptr{Cvoid}, Ptr{Cvoid}),
        surface, fn, user)
end

"""
Sets the callback that adds to the velocities with which a surface that prescribes moves. NULL takes it away. The host
sets it again after it has loaded a state. MPM_E_STATE during a staged step.
"""
function mpm_surface_set_velocity(surface, fn, user)
    return ccall((:mpm_surface_set_velocity, libmpm), Int32, (Ptr{mpm_surface}, Ptr{Cvoid}, Ptr{Cvoid}),
        surface, fn, user)
end

"""
Adds n markers.

- position: [dim][n], in the grid; on periodic axes it is wrapped.
- area: [dim][n] area vectors, out of the material; NULL for markers without area, which follow the material and carry
  nothing.
- first_id: ids go up by one from the largest so far; the first is written to it. May be NULL.

In 3-D a marker counts as a square when it is split. MPM_E_ARG: a value is not finite, a position is outside the grid,
the surface would have more than 2^28 markers, or the edge of a ring, which is its area over its radius, would reach
beyond the axis; nothing is added. MPM_E_STATE during a staged step.
"""
function mpm_surface_add(surface, n, position, area, first_id)
    return ccall((:mpm_surface_add, libmpm), Int32, (Ptr{mpm_surface}, Int64, Ptr{Float64}, Ptr{Float64}, Ptr{Int64}),
        surface, n, position, area, first_id)
end

"""
Adds markers along the line through n points, position[2][n]; closed 1: back to the first. The material lies on the
left of the line, so that the outline of a body goes round counter-clockwise. Each edge is divided into equal parts no
longer than spacing > 0, with a marker in the middle of each: half a spacing of the grid is right. *first_id and
*count, which may be NULL, tell of the markers. MPM_E_UNSUPPORTED: the grid is not 2-D. MPM_E_ARG: a closed line has
one or two points, and so no inside. Else as mpm_surface_add().
"""
function mpm_surface_add_polyline(surface, n, position, closed, spacing, first_id, count)
    return ccall((:mpm_surface_add_polyline, libmpm), Int32, (Ptr{mpm_surface}, Int64, Ptr{Float64}, Int32, Float64, Ptr{Int64}, Ptr{Int64}),
        surface, n, position, closed, spacing, first_id, count)
end

"""
Adds markers on triangles: position[3][n] of their corners, and corner[3 * i], corner[3 * i + 1], corner[3 * i + 2]
the numbers of those of triangle i, counter-clockwise as seen from outside the material. Each triangle is divided into
k^2 equal ones with edges no longer than spacing, with a marker in the middle of each. MPM_E_UNSUPPORTED: the grid is
not 3-D. MPM_E_ARG: there is no such corner. Else as mpm_surface_add_polyline().
"""
function mpm_surface_add_triangles(surface, n, position, triangles, corner, spacing, first_id, count)
    return ccall((:mpm_surface_add_triangles, libmpm), Int32, (Ptr{mpm_surface}, Int64, Ptr{Float64}, Int64, Ptr{Int64}, Float64, Ptr{Int64}, Ptr{Int64}),
        surface, n, position, triangles, corner, spacing, first_id, count)
end

"""
Removes the n markers with the given ids: all or none. MPM_E_NOT_FOUND: an id is not in the surface. MPM_E_ARG: an id
is given twice. MPM_E_STATE during a staged step.
"""
function mpm_surface_remove(surface, n, ids)
    return ccall((:mpm_surface_remove, libmpm), Int32, (Ptr{mpm_surface}, Int64, Ptr{Int64}), surface, n, ids)
end

"""
Splits markers until no edge is longer than spacing > 0: total area, its moment and the loads are kept, but for the
moment where a half would lie beyond a face of the grid: it is put onto the face. One half keeps the id, the other
gets a new one. *added, which may be NULL, tells how many came. MPM_E_ARG: spacing is bad, or more than 2^28 markers
would come of it. MPM_E_STATE during a staged step.
"""
function mpm_surface_refine(surface, spacing, added)
    return ccall((:mpm_surface_refine, libmpm), Int32, (Ptr{mpm_surface}, Float64, Ptr{Int64}),
        surface, spacing, added)
end

"""
The number of markers; 0 for NULL.
"""
function mpm_surface_count(surface)
    return ccall((:mpm_surface_count, libmpm), Int64, (Ptr{mpm_surface},), surface)
end

"""
Copies a field of n markers into out, [components][n]. ids are [n], or NULL for all markers by ascending id, where n
is mpm_surface_count(). type and components must match the field.

| field             | type | components | what it is                                              | set |
|-------------------|------|------------|---------------------------------------------------------|-----|
| \"id\"              | I64  | 1          |                                                         |     |
| \"position\"        | F64  | dim        | length                                                  | yes |
| \"area\"            | F64  | dim        | area vector, out of the material                        | yes |
| \"reference_area\"  | F64  | 1          | area when it was added or set                           |     |
| \"displacement\"    | F64  | dim        | since it was added, across periodic axes too            | yes |
| \"velocity\"        | F64  | dim        | of the material there, in the last step                 |     |
| \"force\"           | F64  | dim        | on the material, in the last step                       |     |
| \"pressure\"        | F64  | 1          | of this marker, beside mpm_surface_desc.pressure        | yes |
| \"traction\"        | F64  | dim        | likewise                                                | yes |
| \"dead_traction\"   | F64  | dim        | likewise                                                | yes |
| \"prescribed_velocity\" | F64 | dim     | of this marker, beside mpm_surface_desc.velocity        | yes |
| \"reaction\"        | F64  | dim        | force of what is prescribed on the material, last step  |     |
| \"gap\"             | F64  | dim        | implicit steps: way of the material off what it should  |     |

MPM_E_NOT_FOUND: there is no such field or id. MPM_E_ARG: type, components or n do not match.
"""
function mpm_surface_get(surface, field, type_, components, n, ids, out)
    return ccall((:mpm_surface_get, libmpm), Int32, (Ptr{mpm_surface}, Cstring, Int32, Int32, Int64, Ptr{Int64}, Ptr{Cvoid}),
        surface, field, type_, components, n, ids, out)
end

"""
Copies values into a field, laid out as in mpm_surface_get(): all or none. Setting \"area\" makes it the reference.
Errors are those of mpm_surface_get(), and MPM_E_ARG: a value is not finite, a position is outside the grid, or the
field cannot be set. MPM_E_STATE during a staged step. MPM_E_UNSUPPORTED: \"position\" or \"area\" with
total_lagrangian = 1, whose weights keep to the markers that were added: add others.
"""
function mpm_surface_set(surface, field, type_, components, n, ids, values)
    return ccall((:mpm_surface_set, libmpm), Int32, (Ptr{mpm_surface}, Cstring, Int32, Int32, Int64, Ptr{Int64}, Ptr{Cvoid}),
        surface, field, type_, components, n, ids, values)
end

"""
Puts a surface into a stepper. In each step its markers load the nodes of mpm_surface_desc.body and move with them, or
as they prescribe; the work is part of mpm_step_info.external_work. Markers that go through MPM_WALL_OPEN are removed.
Steps end with

- MPM_OFF_GRID: a marker would leave through a face that does not let it;
- MPM_NONFINITE: its load, what it prescribes or its new position is not finite;
- MPM_E_STATE: a marker with a load has no material around it.

The text names marker and surface, the number of which counts the surfaces of the stepper from 0. MPM_E_STATE: it is
in a stepper already, or a step is under way. MPM_E_ARG: it is on another grid.

In implicit steps forces are those at the end of the step, on the areas that surfaces then have. Pressure and traction
make the stiffness unsymmetric, so that the solvers for symmetric matrices are not offered; what is prescribed, and
loads of markers that prescribe, keep it symmetric.
"""
function mpm_stepper_add_surface(stepper, surface)
    return ccall((:mpm_stepper_add_surface, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_surface}), stepper, surface)
end

"""
Takes a surface out; it keeps its markers. MPM_E_NOT_FOUND: it is not in this stepper.
"""
function mpm_stepper_remove_surface(stepper, surface)
    return ccall((:mpm_stepper_remove_surface, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_surface}), stepper, surface)
end

"""
Gives the force[dim] by which what a surface prescribes acts on the material: the mean over the last step, the sum of
\"reaction\" over the markers; 0 for a surface that prescribes nothing. Loads are no part of it. MPM_E_NOT_FOUND: it
is not in this stepper. MPM_E_STATE before the first step.
"""
function mpm_stepper_surface_reaction(stepper, surface, force)
    return ccall((:mpm_stepper_surface_reaction, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_surface}, Ptr{Float64}),
        stepper, surface, force)
end

"""
Gives the impulse[dim] of it on the material, mass * length/time: the sum of mpm_stepper_surface_reaction() times the
time over which it acted, over all committed steps since the surface was added or mpm_stepper_set_time() was called. A
saved state holds it. MPM_E_NOT_FOUND: the surface is not in this stepper.
"""
function mpm_stepper_surface_impulse(stepper, surface, impulse)
    return ccall((:mpm_stepper_surface_impulse, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_surface}, Ptr{Float64}),
        stepper, surface, impulse)
end

"""
Fills desc with the defaults. struct_size is sizeof(mpm_adaption_desc) of the caller; no byte beyond is written.
MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
"""
function mpm_adaption_desc_init(desc, struct_size)
    return ccall((:mpm_adaption_desc_init, libmpm), Int32, (Ptr{mpm_adaption_desc}, UInt32), desc, struct_size)
end

"""
Describes how a set of the stepper adapts, for the steps that follow; NULL: no longer. The set then keeps the field
\"size\". Not part of a saved state: the host sets it again. MPM_E_NOT_FOUND: the set is not in the stepper.
MPM_E_ARG: a value is bad or particles is NULL; an edge could be split that would be shorter than least_edge
(split_edge < 2 least_edge), or max_per_cell < 2 min_per_cell. MPM_E_UNSUPPORTED: total_lagrangian = 1, where material
does not come apart, or the law is \"rigid\". MPM_E_STATE: a step is under way, or a view of the set is out.
"""
function mpm_stepper_set_adaption(stepper, particles, desc)
    return ccall((:mpm_stepper_set_adaption, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_particles}, Ptr{mpm_adaption_desc}),
        stepper, particles, desc)
end

"""
Adapts all sets that are described, now and whatever `every` is. Sets are unchanged on failure. MPM_E_CALLBACK,
MPM_CUT_DT: accept returned an error. MPM_E_STATE: a step is under way, a view of a set is out, or a value that was
written through one is bad.
"""
function mpm_stepper_adapt(stepper)
    return ccall((:mpm_stepper_adapt, libmpm), Int32, (Ptr{mpm_stepper},), stepper)
end

"""
Tells what adaption has done to a set. MPM_E_NOT_FOUND: it is not in the stepper. MPM_E_ARG: particles or info is
NULL.
"""
function mpm_stepper_adaption_info(stepper, particles, info)
    return ccall((:mpm_stepper_adaption_info, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_particles}, Ptr{mpm_adaption_info}),
        stepper, particles, info)
end

"""
Fills desc with the defaults. struct_size is sizeof(mpm_heat_desc) of the caller; no byte beyond is written.
MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.
"""
function mpm_heat_desc_init(desc, struct_size)
    return ccall((:mpm_heat_desc_init, libmpm), Int32, (Ptr{mpm_heat_desc}, UInt32), desc, struct_size)
end

"""
Describes the heat of a set of the stepper, for the steps that follow; NULL: it has none any more, and its fields stay
as fields of the host. Not part of a saved state, but the fields are: the host describes before it loads.
MPM_E_NOT_FOUND: the set is not in the stepper. MPM_E_ARG: particles is NULL, a value is bad, or the set has a field
\"temperature\" or \"stress_temperature\" of another type or with more components. MPM_E_UNSUPPORTED: expansion is not
0 on MPM_PLANE_STRESS or with the law \"rigid\"; dissipated_share is not 0 with \"rigid\" or a law of the host.
MPM_E_STATE: a step is under way, a view of the set is out, or the set has no room for another field.
"""
function mpm_stepper_set_heat(stepper, particles, desc)
    return ccall((:mpm_stepper_set_heat, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_particles}, Ptr{mpm_heat_desc}),
        stepper, particles, desc)
end

"""
Chooses how the nodes conduct, from MPM_CONDUCTION_EXPLICIT (as made) on. tolerance: of the residual of conjugate
gradients, relative to the right-hand side; > 0 and < 1; not read with explicit conduction. MPM_E_ARG: a value is bad.
MPM_E_STATE: a step is under way.
"""
function mpm_stepper_set_conduction(stepper, conduction, tolerance)
    return ccall((:mpm_stepper_set_conduction, libmpm), Int32, (Ptr{mpm_stepper}, Int32, Float64),
        stepper, conduction, tolerance)
end

"""
Says what a face does to heat, whatever kind of wall it has. kind: MPM_HEAT_WALL_...; the temperature is not read of
insulated ones, which all faces are from the start. Call it again where the temperature changes: that change, at first
from what the material there has, reaches the particles in the next step; material that comes to the face later is
heated by conduction alone. Where two such faces meet, that of the lower axis prescribes the edge. Not part of a saved
state. MPM_E_ARG: a value is bad, or the axis is periodic. MPM_E_UNSUPPORTED: the face is the axis of
MPM_AXISYMMETRIC, through which nothing flows. MPM_E_STATE: a step is under way.
"""
function mpm_stepper_set_heat_wall(stepper, face, kind, temperature)
    return ccall((:mpm_stepper_set_heat_wall, libmpm), Int32, (Ptr{mpm_stepper}, Int32, Int32, Float64),
        stepper, face, kind, temperature)
end

"""
Heats what lies below a surface, per area of its markers: flux + film (ambient - temperature of the material),
power/area into the material; film is >= 0. All 0 (as made): no heat. Not part of a saved state. MPM_E_ARG: a value is
bad. MPM_E_STATE: a step is under way.
"""
function mpm_surface_set_heat(surface, flux, film, ambient)
    return ccall((:mpm_surface_set_heat, libmpm), Int32, (Ptr{mpm_surface}, Float64, Float64, Float64),
        surface, flux, film, ambient)
end

"""
Tells where heat came from. MPM_E_ARG: info is NULL. MPM_E_STATE: a step is under way, or no set was ever described.
"""
function mpm_stepper_heat_info(stepper, info)
    return ccall((:mpm_stepper_heat_info, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{mpm_heat_info}), stepper, info)
end

"""
Tells how many bytes mpm_state_save() needs now; of several parts, those of this part's piece (collective).
"""
function mpm_state_size(stepper, bytes)
    return ccall((:mpm_state_size, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{Int64}), stepper, bytes)
end

"""
Writes the state into the host's buffer of capacity bytes; of several parts, this part's piece (collective).
MPM_E_ARG: the capacity is too small. MPM_E_STATE: a view is out for writing, or a staged step is under way.
"""
function mpm_state_save(stepper, buffer, capacity)
    return ccall((:mpm_state_save, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{Cvoid}, Int64), stepper, buffer, capacity)
end

"""
Replaces the state by one saved with mpm_state_save(), of so many bytes; the buffer is read during the call.
MPM_E_FORMAT: the bytes are no state, or it is damaged, of a later format, or saved from an unlike setup; the error
text names the first difference; or they are one piece of several. MPM_E_STATE: a view is out, or a staged step is
under way. MPM_E_UNSUPPORTED: the context is one of several parts, which load by mpm_state_load_pieces().
"""
function mpm_state_load(stepper, buffer, bytes)
    return ccall((:mpm_state_load, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{Cvoid}, Int64), stepper, buffer, bytes)
end

"""
Replaces the state by one in pieces (collective). Each part gives count of them, piece[i] of bytes[i] bytes: part 0
the first few, part 1 those after them, and so on, in the order of the parts that saved them; count may be 0, and then
piece and bytes may be NULL. How many parts saved the state and how many load it does not matter, one among them:
continuing has the bits of not having stopped. What mpm_state_save() of one part wrote, in any version, is the only
piece of its state. Pieces are read during the call and need no alignment. On failure, which all parts return, no
part's objects have changed.

- MPM_E_ARG: pieces are missing, given twice, out of order, or of different states, which their marks tell; no part
  gives one; or an argument is wrong.
- MPM_E_FORMAT: as in mpm_state_load(); the text names the piece by its number in `piece`.
- MPM_E_STATE: a view is out, or a staged step is under way.

Since 0.2.0.
"""
function mpm_state_load_pieces(stepper, count, piece, bytes)
    return ccall((:mpm_state_load_pieces, libmpm), Int32, (Ptr{mpm_stepper}, Int32, Ptr{Ptr{Cvoid}}, Ptr{Int64}),
        stepper, count, piece, bytes)
end

"""
Writes the state into a file, as mpm_state_save() does into memory, and waits for the storage: path holds the old
state or the new one. Of several parts, each writes its piece under a path of its own (collective); where one of them
could not, others may have replaced their files. MPM_E_IO: the file could not be written.
"""
function mpm_state_save_file(stepper, path)
    return ccall((:mpm_state_save_file, libmpm), Int32, (Ptr{mpm_stepper}, Cstring), stepper, path)
end

"""
Gives the bytes of mpm_state_save() to a callback. They are made twice, because the first of them hold a checksum of
all others; memory for 65536 bytes is enough. Of several parts, each gives its piece (collective). MPM_E_CALLBACK: the
callback refused. MPM_E_STATE: as in mpm_state_save(); or what was written through a view for reading changed the
state while it went out. Since 0.2.0.
"""
function mpm_state_save_to(stepper, write, user)
    return ccall((:mpm_state_save_to, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{Cvoid}, Ptr{Cvoid}),
        stepper, write, user)
end

"""
Replaces the state by one from a file. Errors are those of mpm_state_load(), and MPM_E_IO: the file could not be read.
"""
function mpm_state_load_file(stepper, path)
    return ccall((:mpm_state_load_file, libmpm), Int32, (Ptr{mpm_stepper}, Cstring), stepper, path)
end

"""
Gives a hash of time, step, every field of every set, the pose of every obstacle and every marker of surfaces. It does
not depend on library order, on threads or on optional fields that are not in use: states that are equal by id have
equal hashes.
"""
function mpm_state_hash(stepper, hash)
    return ccall((:mpm_state_hash, libmpm), Int32, (Ptr{mpm_stepper}, Ptr{UInt64}), stepper, hash)
end

"""
Writes a set as VTK poly data (.vtp, appended raw): points in order of ascending id, and count named fields as point
data, with full tensors and, in 2-D and 3-D, with three components per vector. With count 0, when fields may be NULL,
it writes every field in use but \"position\", which the points are. path is UTF-8. MPM_E_NOT_FOUND: there is no such
field. MPM_E_ARG: a field is named twice. MPM_E_IO: the file could not be written.
"""
function mpm_write_particles(particles, path, count, fields)
    return ccall((:mpm_write_particles, libmpm), Int32, (Ptr{mpm_particles}, Cstring, Int32, Ptr{Cstring}),
        particles, path, count, fields)
end

"""
Gives the bytes of the file that mpm_write_particles() would write to a callback, with memory for one piece. Errors
are the same, but for the path, and with MPM_E_CALLBACK, when the callback refused, in the place of MPM_E_IO. Since
0.2.0.
"""
function mpm_write_particles_to(particles, write, user, count, fields)
    return ccall((:mpm_write_particles_to, libmpm), Int32, (Ptr{mpm_particles}, Ptr{Cvoid}, Ptr{Cvoid}, Int32, Ptr{Cstring}),
        particles, write, user, count, fields)
end

"""
Writes nodal fields of the last step, or of a staged step while one is under way, over the box of the active nodes: as
VTK image data (.vti, appended raw), or with open knots, whose nodes are not evenly spaced at the faces, as a
rectilinear grid (.vtr). Fields are named as in mpm_grid_map(); vectors have three components in 2-D and 3-D. Extents
are indices of nodes; where no node is active values are zero. With count 0, when fields may be NULL, it writes every
field that the step has kept but \"position\", which is that of the points, and \"owned\". Memory follows the active
nodes; long runs of zeros take no room on storage that knows holes.

- MPM_E_NOT_FOUND: there is no such field, or no set is in body 0.
- MPM_E_STATE: nothing has been stepped yet.
- MPM_E_UNSUPPORTED: as in mpm_grid_map().
- MPM_E_ARG: a field is named twice, the path ends with the other kind's suffix, or the box has more nodes than a file
  can hold.
- MPM_E_IO: the file could not be written.
"""
function mpm_write_grid(stepper, path, count, fields)
    return ccall((:mpm_write_grid, libmpm), Int32, (Ptr{mpm_stepper}, Cstring, Int32, Ptr{Cstring}),
        stepper, path, count, fields)
end

"""
Does as mpm_write_grid() for the nodes of one body; that one writes those of body 0. MPM_E_NOT_FOUND: no set of the
stepper is in the body.
"""
function mpm_write_body_grid(stepper, body, path, count, fields)
    return ccall((:mpm_write_body_grid, libmpm), Int32, (Ptr{mpm_stepper}, Int32, Cstring, Int32, Ptr{Cstring}),
        stepper, body, path, count, fields)
end

"""
Gives the bytes of the file that mpm_write_body_grid() would write to a callback. They are those of a .vtr file if the
grid has boundary_basis = MPM_BOUNDARY_OPEN_KNOT and an axis that is not periodic, else those of a .vti file; the
second line names the kind, RectilinearGrid or ImageData. Zeros between bodies far apart are all given, however many
they are. Memory follows the active nodes, and one piece is added. Errors are the same, but for the path, and with
MPM_E_CALLBACK, when the callback refused, in the place of MPM_E_IO. Since 0.2.0.
"""
function mpm_write_grid_to(stepper, body, write, user, count, fields)
    return ccall((:mpm_write_grid_to, libmpm), Int32, (Ptr{mpm_stepper}, Int32, Ptr{Cvoid}, Ptr{Cvoid}, Int32, Ptr{Cstring}),
        stepper, body, write, user, count, fields)
end

"""
Starts a series in a new file at path, where it replaces an old one. *out is NULL unless MPM_OK is returned. MPM_E_IO:
the file could not be written.
"""
function mpm_series_open(context, path, out)
    return ccall((:mpm_series_open, libmpm), Int32, (Ptr{mpm_context}, Cstring, Ptr{Ptr{mpm_series}}),
        context, path, out)
end

"""
Appends an output file to the series at time t. file is its path as it is to stand in the series: relative to the
series' own file. MPM_E_IO: the file could not be written.
"""
function mpm_series_append(series, t, file)
    return ccall((:mpm_series_append, libmpm), Int32, (Ptr{mpm_series}, Float64, Cstring), series, t, file)
end

"""
Ends the series and frees it. Its file stays. NULL is fine.
"""
function mpm_series_close(series)
    return ccall((:mpm_series_close, libmpm), Int32, (Ptr{mpm_series},), series)
end

"A struct that is ready: a descriptor has the library's defaults, others their struct_size and zeros."
function ready(::Type{T}) where {T}
    it = zeroed(T)
    if hasfield(T, :struct_size)
        it.struct_size = UInt32(sizeof(T))
    end
    return it
end
function ready(::Type{mpm_balance_desc})
    it = zeroed(mpm_balance_desc)
    status = mpm_balance_desc_init(it, UInt32(sizeof(mpm_balance_desc)))
    status == MPM_OK || error("mpm_balance_desc_init: libmpm is older than the module")
    return it
end
function ready(::Type{mpm_context_desc})
    it = zeroed(mpm_context_desc)
    status = mpm_context_desc_init(it, UInt32(sizeof(mpm_context_desc)))
    status == MPM_OK || error("mpm_context_desc_init: libmpm is older than the module")
    return it
end
function ready(::Type{mpm_grid_desc})
    it = zeroed(mpm_grid_desc)
    status = mpm_grid_desc_init(it, UInt32(sizeof(mpm_grid_desc)))
    status == MPM_OK || error("mpm_grid_desc_init: libmpm is older than the module")
    return it
end
function ready(::Type{mpm_material_desc})
    it = zeroed(mpm_material_desc)
    status = mpm_material_desc_init(it, UInt32(sizeof(mpm_material_desc)))
    status == MPM_OK || error("mpm_material_desc_init: libmpm is older than the module")
    return it
end
function ready(::Type{mpm_stepper_desc})
    it = zeroed(mpm_stepper_desc)
    status = mpm_stepper_desc_init(it, UInt32(sizeof(mpm_stepper_desc)))
    status == MPM_OK || error("mpm_stepper_desc_init: libmpm is older than the module")
    return it
end
function ready(::Type{mpm_advance_desc})
    it = zeroed(mpm_advance_desc)
    status = mpm_advance_desc_init(it, UInt32(sizeof(mpm_advance_desc)))
    status == MPM_OK || error("mpm_advance_desc_init: libmpm is older than the module")
    return it
end
function ready(::Type{mpm_contact_desc})
    it = zeroed(mpm_contact_desc)
    status = mpm_contact_desc_init(it, UInt32(sizeof(mpm_contact_desc)))
    status == MPM_OK || error("mpm_contact_desc_init: libmpm is older than the module")
    return it
end
function ready(::Type{mpm_obstacle_desc})
    it = zeroed(mpm_obstacle_desc)
    status = mpm_obstacle_desc_init(it, UInt32(sizeof(mpm_obstacle_desc)))
    status == MPM_OK || error("mpm_obstacle_desc_init: libmpm is older than the module")
    return it
end
function ready(::Type{mpm_surface_desc})
    it = zeroed(mpm_surface_desc)
    status = mpm_surface_desc_init(it, UInt32(sizeof(mpm_surface_desc)))
    status == MPM_OK || error("mpm_surface_desc_init: libmpm is older than the module")
    return it
end
function ready(::Type{mpm_adaption_desc})
    it = zeroed(mpm_adaption_desc)
    status = mpm_adaption_desc_init(it, UInt32(sizeof(mpm_adaption_desc)))
    status == MPM_OK || error("mpm_adaption_desc_init: libmpm is older than the module")
    return it
end
function ready(::Type{mpm_heat_desc})
    it = zeroed(mpm_heat_desc)
    status = mpm_heat_desc_init(it, UInt32(sizeof(mpm_heat_desc)))
    status == MPM_OK || error("mpm_heat_desc_init: libmpm is older than the module")
    return it
end

export check, columns, ready, MpmError, MPM_OK, MPM_CUT_DT, MPM_INVERTED, MPM_NONFINITE, MPM_NOT_CONVERGED,
    MPM_SINGULAR, MPM_OFF_GRID, MPM_CANCELLED, MPM_E_ARG, MPM_E_NOMEM, MPM_E_STATE, MPM_E_CALLBACK, MPM_E_UNSUPPORTED,
    MPM_E_NOT_FOUND, MPM_E_IO, MPM_E_FORMAT, MPM_E_INTERNAL, MPM_LINEAR, MPM_BSPLINE2, MPM_BSPLINE3, MPM_GIMP,
    MPM_UGIMP, MPM_CPGIMP, MPM_BOUNDARY_GHOST, MPM_BOUNDARY_OPEN_KNOT, MPM_PLANE_STRAIN, MPM_AXISYMMETRIC,
    MPM_PLANE_STRESS, MPM_USL, MPM_USF, MPM_MUSL, MPM_NEWMARK, MPM_FLIP, MPM_APIC, MPM_TPIC, MPM_TFLIP, MPM_AFLIP,
    MPM_XPIC, MPM_APIC_MLS, MPM_FMPM, MPM_ISA_BEST, MPM_ISA_BASELINE, MPM_ISA_AVX2, MPM_ISA_AVX512, MPM_ISA_NEON,
    MPM_ISA_PORTABLE, MPM_LOG_WARNING, MPM_LOG_INFO, MPM_LOG_DEBUG, MPM_LOCKING_NONE, MPM_LOCKING_CELL_AVERAGE,
    MPM_TANGENT_MINOR_SYMMETRIC, MPM_TANGENT_GENERAL, MPM_X_MIN, MPM_X_MAX, MPM_Y_MIN, MPM_Y_MAX, MPM_Z_MIN,
    MPM_Z_MAX, MPM_WALL_NONE, MPM_WALL_OPEN, MPM_WALL_FIXED, MPM_WALL_SLIP, MPM_WALL_FRICTION,
    MPM_WALL_FRICTION_NODES, MPM_PRESCRIBES_NOTHING, MPM_PRESCRIBES_VELOCITY, MPM_PRESCRIBES_NORMAL, MPM_AFTER_P2G,
    MPM_AFTER_FORCES, MPM_AFTER_VELOCITY, MPM_READ, MPM_WRITE, MPM_F64, MPM_I64, MPM_U8, MPM_BY_ID, MPM_LIBRARY_ORDER,
    MPM_SOLVER_AUTO, MPM_SOLVER_CG, MPM_SOLVER_MULTIGRID_CG, MPM_SOLVER_LDLT, MPM_SOLVER_GMRES, MPM_SOLVER_HOST,
    MPM_EXCHANGE_KNOWN, MPM_EXCHANGE_SPARSE, MPM_REDUCE_MAX, MPM_REDUCE_SUM, MPM_CONTACT_UNILATERAL, MPM_CONTACT_NONE,
    MPM_CONTACT_TIED, MPM_NORMAL_LOGISTIC, MPM_NORMAL_DISCRIMINANT, MPM_NORMAL_GRADIENT, MPM_NORMAL_FIXED,
    MPM_DETECT_DEFAULT, MPM_DETECT_GAP, MPM_DETECT_VELOCITY, MPM_BODY_ANY, MPM_SHAPE_PLANE, MPM_SHAPE_SPHERE,
    MPM_SHAPE_CYLINDER, MPM_SHAPE_CAPSULE, MPM_SHAPE_BOX, MPM_SHAPE_DISTANCE, MPM_MOTION_FIXED, MPM_MOTION_PRESCRIBED,
    MPM_MOTION_FREE, MPM_ADAPT_SPLIT, MPM_ADAPT_MERGE, MPM_CONDUCTION_EXPLICIT, MPM_CONDUCTION_IMPLICIT,
    MPM_HEAT_WALL_INSULATED, MPM_HEAT_WALL_TEMPERATURE, mpm_context, mpm_grid, mpm_material, mpm_particles,
    mpm_stepper, mpm_operator, mpm_obstacle, mpm_surface, mpm_series, mpm_param, mpm_view, mpm_message, mpm_transport,
    mpm_balance_desc, mpm_parallel_info, mpm_context_desc, mpm_grid_desc, mpm_material_batch, mpm_material_desc,
    mpm_operator_info, mpm_stepper_desc, mpm_step_info, mpm_particle_batch, mpm_node_batch, mpm_advance_desc,
    mpm_profile, mpm_contact_desc, mpm_contact_info, mpm_contact_batch, mpm_distance_batch, mpm_obstacle_desc,
    mpm_surface_desc, mpm_marker_batch, mpm_adaption_batch, mpm_adaption_desc, mpm_adaption_info, mpm_heat_desc,
    mpm_heat_info, mpm_version, mpm_status_name, mpm_status_text, mpm_view_release, mpm_context_part,
    mpm_particles_total, mpm_balance_desc_init, mpm_stepper_set_balance, mpm_stepper_parallel_info,
    mpm_particles_packed_size, mpm_particles_pack, mpm_particles_unpack, mpm_context_desc_init, mpm_context_create,
    mpm_context_memory, mpm_context_destroy, mpm_last_error, mpm_set_last_error, mpm_grid_desc_init, mpm_grid_create,
    mpm_grid_destroy, mpm_material_create, mpm_material_model_count, mpm_material_model_name,
    mpm_material_model_param, mpm_material_state_count, mpm_material_state_name, mpm_batch_field,
    mpm_material_desc_init, mpm_material_create_custom, mpm_material_update, mpm_material_destroy,
    mpm_particles_create, mpm_particles_destroy, mpm_particles_add, mpm_particles_fill_box, mpm_particles_fill_ball,
    mpm_particles_fill, mpm_particles_fill_mesh, mpm_particles_remove, mpm_particles_count, mpm_particles_field_info,
    mpm_particles_add_field, mpm_particles_set_extensive, mpm_particles_map, mpm_particles_get, mpm_particles_get_f32,
    mpm_particles_set, mpm_particles_set_all, mpm_particles_set_geostatic, mpm_particles_reset_reference,
    mpm_operator_get_info, mpm_operator_apply, mpm_operator_csr, mpm_stepper_desc_init, mpm_stepper_create,
    mpm_stepper_destroy, mpm_stepper_add, mpm_stepper_remove, mpm_stepper_configure, mpm_stepper_set_time,
    mpm_stepper_set_motion, mpm_stepper_set_wall, mpm_stepper_set_acceleration, mpm_stepper_set_force,
    mpm_stepper_set_velocity_bc, mpm_stepper_set_node_hook, mpm_stepper_set_linear_solver, mpm_stepper_set_progress,
    mpm_stable_dt, mpm_step, mpm_advance_desc_init, mpm_advance, mpm_stepper_profile, mpm_stepper_info,
    mpm_stepper_residuals, mpm_step_begin, mpm_step_grid, mpm_step_end, mpm_step_abort, mpm_grid_map,
    mpm_stepper_wall_reaction, mpm_stepper_particles_reaction, mpm_stepper_wall_impulse,
    mpm_stepper_particles_impulse, mpm_stepper_set_body, mpm_stepper_body, mpm_contact_desc_init,
    mpm_stepper_set_contact, mpm_stepper_set_friction, mpm_stepper_contact_info, mpm_obstacle_desc_init,
    mpm_obstacle_create, mpm_obstacle_destroy, mpm_stepper_add_obstacle, mpm_stepper_remove_obstacle,
    mpm_obstacle_set_motion, mpm_obstacle_set_contact, mpm_obstacle_set_pose, mpm_obstacle_get_pose,
    mpm_obstacle_set_load, mpm_obstacle_contact_info, mpm_surface_desc_init, mpm_surface_create, mpm_surface_destroy,
    mpm_surface_configure, mpm_surface_set_traction, mpm_surface_set_velocity, mpm_surface_add,
    mpm_surface_add_polyline, mpm_surface_add_triangles, mpm_surface_remove, mpm_surface_refine, mpm_surface_count,
    mpm_surface_get, mpm_surface_set, mpm_stepper_add_surface, mpm_stepper_remove_surface,
    mpm_stepper_surface_reaction, mpm_stepper_surface_impulse, mpm_adaption_desc_init, mpm_stepper_set_adaption,
    mpm_stepper_adapt, mpm_stepper_adaption_info, mpm_heat_desc_init, mpm_stepper_set_heat,
    mpm_stepper_set_conduction, mpm_stepper_set_heat_wall, mpm_surface_set_heat, mpm_stepper_heat_info,
    mpm_state_size, mpm_state_save, mpm_state_load, mpm_state_load_pieces, mpm_state_save_file, mpm_state_save_to,
    mpm_state_load_file, mpm_state_hash, mpm_write_particles, mpm_write_particles_to, mpm_write_grid,
    mpm_write_body_grid, mpm_write_grid_to, mpm_series_open, mpm_series_append, mpm_series_close

end
