"""Generated from the headers of libmpm by `make api`; not to be edited.

Structs, types of callbacks and prototypes for ctypes, and the constants without their prefix."""
from ctypes import (CFUNCTYPE, POINTER, Structure, c_char, c_char_p, c_double, c_int32, c_int64, c_size_t, c_uint8, c_uint32,
                    c_uint64, c_void_p)
from enum import IntEnum, IntFlag

#: Version of the headers that this was made from.
VERSION = 0x000100


class Status(IntEnum):
    """Status values. After a positive one the state is as it was before the call. A smaller dt may cure 1..5."""

    #: the call did what it was asked to
    OK = 0
    #: a callback, a law or contact asked for a smaller step
    CUT_DT = 1
    #: det F <= 0 at a particle
    INVERTED = 2
    #: a NaN or an infinity appeared
    NONFINITE = 3
    #: the Newton iteration did not converge
    NOT_CONVERGED = 4
    #: the linear system is singular, or indefinite beyond repair
    SINGULAR = 5
    #: a particle would leave through a face that does not let it
    OFF_GRID = 6
    #: the progress callback ended the call
    CANCELLED = 7
    #: an argument is NULL, out of range or inconsistent
    E_ARG = -1
    #: the allocator returned NULL
    E_NOMEM = -2
    #: not allowed now: objects live, views are out, or a step is begun
    E_STATE = -3
    #: a callback returned < 0, or the host's executor failed
    E_CALLBACK = -4
    #: this version does not offer the combination or the extension
    E_UNSUPPORTED = -5
    #: there is no such name, id or index; the text lists the nearest names
    E_NOT_FOUND = -6
    #: a file could not be opened, read or written
    E_IO = -7
    #: data are damaged, of another kind, or from an unlike setup
    E_FORMAT = -8
    #: the library itself is at fault
    E_INTERNAL = -99


class Basis(IntEnum):
    """Basis functions of the grid. Here h is the edge of a cell."""

    #: piecewise linear functions, 2h wide: Steffen et al. 2008, eqs 17-18
    LINEAR = 1
    #: Quadratic B-splines, 3h wide: Steffen et al. 2008, eq. 21; MPoint theory, eqs 24-27.
    BSPLINE2 = 2
    #: cubic B-splines, 4h wide: Steffen et al. 2008, eqs 22-23
    BSPLINE3 = 3
    #: GIMP on domains of edges "size", at most a cell: Steffen et al. 2008, eqs 26-29
    GIMP = 16
    #: GIMP on domains that all have edges of smoothing * spacing
    UGIMP = 17
    #: GIMP on domains of edges "size" * |F_ii|, at most a cell; depends on the axes
    CPGIMP = 18


class BoundaryBasis(IntEnum):
    """What B-splines do at the faces of the grid: Steffen et al. 2008, section 3.2."""

    #: splines are the same everywhere, with nodes outside the faces
    BOUNDARY_GHOST = 0
    #: Knots are repeated degree + 1 times at the faces, where one function alone is then 1. There are no nodes
    #: outside: the cells + degree nodes of an axis stand at the Greville points. Periodic axes keep plain splines.
    BOUNDARY_OPEN_KNOT = 1


class Geometry(IntEnum):
    """What lies across the plane of a 2-D grid."""

    #: a slab of unit thickness that keeps its thickness
    PLANE_STRAIN = 0
    #: A body of revolution: axis 0 is the radius r >= 0, axis 1 the axis z. What is extensive (volume, mass, force,
    #: energy) is that of one radian: of the whole ring it is 2 pi times as much. The axis r = 0 is a slip wall by
    #: itself. Sulsky & Schreyer 1996, section 3; Nairn & Guilkey 2015. Since 0.2.0.
    AXISYMMETRIC = 1
    #: A sheet of unit thickness at the start, without a stress across it: F33, which the library finds, makes it
    #: thinner and thicker. Solids alone, without the locking remedy. Since 0.2.0.
    PLANE_STRESS = 2


class Scheme(IntEnum):
    """Time integration scheme."""

    #: Explicit, with stresses updated last: MPoint theory, eqs 28-44; Steffen et al. 2008, eqs 1-10.
    USL = 1
    #: Explicit, with stresses updated first, by the strain from the velocities at the start of the step: Guilkey,
    #: An Introduction to the MPM, eqs 2-10.
    USF = 2
    #: As MPM_USL, but velocities are projected a second time before stresses are updated.
    MUSL = 3
    #: Implicit, by Newmark's rule: Guilkey & Weiss 2003, eqs 11-16, generalised to any beta and gamma.
    NEWMARK = 16


class Transfer(IntEnum):
    """Transfer of velocity between particles and grid."""

    #: FLIP, PIC, and their blend by the field flip: MPoint theory, eqs 34-36
    FLIP = 1
    #: affine, with the inertia of each axis and particle, for any basis: Jiang et al. 2015
    APIC = 2
    #: projects the velocity gradient too (MPoint theory, eq. 29); PIC update (eq. 35)
    TPIC = 3
    #: projects the velocity gradient too (MPoint theory, eq. 29); FLIP blend (eq. 36)
    TFLIP = 4
    #: affine projection with the FLIP blend
    AFLIP = 5
    #: XPIC(m), where m is xpic_order: Hammerquist & Nairn 2017
    XPIC = 6
    #: Affine by moving least squares, with constant inertia and one fused matrix, for quadratic and cubic B-splines
    #: with ghosts or periodic axes: Hu et al. 2018.
    APIC_MLS = 7
    #: FMPM(k), where k is xpic_order: nodal velocities by the first k terms of a series for the inverse of the full
    #: mass matrix: Nairn & Hammerquist 2021. Since 0.2.0.
    FMPM = 8


class Isa(IntEnum):
    """Instruction set of the kernels. Results of two sets agree to round-off, those of one set to the bit."""

    #: the best one that both the processor and the library have
    ISA_BEST = 0
    #: the one that the library was compiled for
    ISA_BASELINE = 1
    #: AVX2 with FMA, on x86-64
    ISA_AVX2 = 2
    #: AVX-512 (F, DQ, VL), on x86-64
    ISA_AVX512 = 3
    #: NEON with FMA, on aarch64
    ISA_NEON = 4
    #: the baseline by its promise: the same bits on every platform (mpm.h, Results)
    ISA_PORTABLE = 1


class Log(IntEnum):
    """Level of a log text."""

    #: the host should look at it
    LOG_WARNING = 1
    #: a rare event: a choice made at creation, or growth of storage
    LOG_INFO = 2
    #: a text in every step
    LOG_DEBUG = 3


class Locking(IntEnum):
    """Remedy against volumetric locking: MPoint theory, eqs 47-53, carried to the deformation gradient."""

    #: there is no remedy
    LOCKING_NONE = 0
    #: The law sees the dilation averaged over the cell, weighted by volume. Of sets whose law makes pressure by
    #: shear ("drucker_prager", "mohr_coulomb", "cam_clay") that is the mean of such sets alone, and forces have
    #: their pressure averaged over the cell, which does the same work (Hughes 1980).
    LOCKING_CELL_AVERAGE = 1


class TangentForm(IntEnum):
    """Form of a law's tangent. The value is the number of components. See mpm_tangent_fn."""

    #: 6 x 6 components, in Voigt's notation
    TANGENT_MINOR_SYMMETRIC = 36
    #: 9 x 9 components
    TANGENT_GENERAL = 81


class Face(IntEnum):
    """Faces of the grid."""

    #: lower face across x
    X_MIN = 0
    #: upper face across x
    X_MAX = 1
    #: lower face across y
    Y_MIN = 2
    #: upper face across y
    Y_MAX = 3
    #: lower face across z
    Z_MIN = 4
    #: upper face across z
    Z_MAX = 5


class Wall(IntEnum):
    """What a face of the grid does."""

    #: default: a step in which a particle would leave fails with MPM_OFF_GRID; none with total_lagrangian = 1,
    #: where "position" may leave the box
    WALL_NONE = 0
    #: a particle that leaves is removed; refused with total_lagrangian = 1
    WALL_OPEN = 1
    #: velocities at the face are zero: it pushes and pulls
    WALL_FIXED = 2
    #: a symmetry plane: it pushes and pulls, without tangential force
    WALL_SLIP = 3
    #: the plane of the face as a fixed obstacle with Coulomb friction (obstacle.h): it pushes, never pulls. What
    #: comes through between nodes, by less than half a cell, it stops particle by particle
    WALL_FRICTION = 4
    #: contact of the nodes on the face with Coulomb friction: MPM_WALL_FRICTION as it was in 0.1.0. Material feels
    #: it about a cell and a half before its particles are there; with total_lagrangian = 1 it is that of the
    #: material that was there
    WALL_FRICTION_NODES = 5


class Prescribes(IntEnum):
    """What a surface prescribes of the motion of the material at its markers. See mpm_surface_desc."""

    #: default: the material carries the markers along
    PRESCRIBES_NOTHING = 0
    #: all components: the material sticks to the surface
    PRESCRIBES_VELOCITY = 1
    #: that along the area vector: the material slides without friction
    PRESCRIBES_NORMAL = 2


class Stage(IntEnum):
    """Where in an explicit step a node hook runs."""

    #: mass and velocity are projected, forces are not yet known
    AFTER_P2G = 1
    #: internal and external forces are complete
    AFTER_FORCES = 2
    #: velocity is updated, and walls and prescribed velocities have acted on it
    AFTER_VELOCITY = 3


class Access(IntFlag):
    """Access to mapped memory. The values may be combined with |."""

    #: the host reads
    READ = 1
    #: the host writes
    WRITE = 2


class FieldType(IntEnum):
    """Type of a field's elements."""

    #: double
    F64 = 1
    #: int64_t
    I64 = 2
    #: uint8_t
    U8 = 3


class Order(IntEnum):
    """Order of the particles in mpm_particles_get_f32()."""

    #: by ascending id
    BY_ID = 1
    #: as they lie in memory, without inert slots; changes when they are sorted anew
    LIBRARY_ORDER = 2


class Solver(IntEnum):
    """Linear solver of an implicit step."""

    #: the library chooses by size, stencil, symmetry and inertia; with a transport as parallel.h says
    SOLVER_AUTO = 0
    #: conjugate gradients, for symmetric positive definite systems
    SOLVER_CG = 1
    #: conjugate gradients with geometric multigrid, for the same systems
    SOLVER_MULTIGRID_CG = 2
    #: a direct solver, for symmetric systems that may be indefinite
    SOLVER_LDLT = 3
    #: GMRES, for systems that are not symmetric
    SOLVER_GMRES = 4
    #: the callback of mpm_stepper_set_linear_solver()
    SOLVER_HOST = 100


class Exchange(IntEnum):
    """How much of an exchange its receivers know beforehand."""

    #: both sides know who sends to whom: partners send and receive
    EXCHANGE_KNOWN = 1
    #: receivers do not know from whom: particles that move, changes of the pattern
    EXCHANGE_SPARSE = 2


class Reduce(IntEnum):
    """What mpm_reduce_fn does. There is no sum of floating-point numbers: it would depend on the parts."""

    #: the largest of all parts
    REDUCE_MAX = 1
    #: the sum, modulo 2^64
    REDUCE_SUM = 2


class Contact(IntEnum):
    """How two bodies meet: mpm_contact_desc.kind."""

    #: they push each other and never pull, with Coulomb friction (default)
    CONTACT_UNILATERAL = 0
    #: they pass through each other
    CONTACT_NONE = 1
    #: neither slip nor separation at nodes that both have
    CONTACT_TIED = 2


class Normal(IntEnum):
    """How the normal at a node is found: mpm_contact_desc.normal. One plane parts two bodies at a node: what is
    thinner than two cells and lies between two faces of one other body is gripped by it."""

    #: of the plane that separates the particles best: logistic regression
    NORMAL_LOGISTIC = 0
    #: of Fisher's linear discriminant: one pass, for smooth surfaces
    NORMAL_DISCRIMINANT = 1
    #: of the mean gradient of volume: for comparison with other codes
    NORMAL_GRADIENT = 2
    #: mpm_contact_desc.direction
    NORMAL_FIXED = 3


class Detection(IntEnum):
    """How it is found that bodies touch: mpm_contact_desc.detection."""

    #: MPM_DETECT_GAP, but MPM_DETECT_VELOCITY with MPM_NORMAL_GRADIENT, whose directions are too far off to measure
    #: a gap along them
    DETECT_DEFAULT = 0
    #: by the gap between their particles
    DETECT_GAP = 1
    #: by velocity alone: wherever they share a node and approach each other
    DETECT_VELOCITY = 2


class Body(IntEnum):
    """In place of a body: all of them."""

    #: any body that has no closer rule; all of them in reports
    BODY_ANY = -1


class Shape(IntEnum):
    """Shapes: mpm_obstacle_desc.shape. Lengths are mpm_obstacle_desc.size; axes are those of the body."""

    #: a half-space; outward normal: axis y, in 1-D x. No size
    SHAPE_PLANE = 1
    #: size[0]: radius; in 2-D a disc. Not in 1-D
    SHAPE_SPHERE = 2
    #: around axis z; size[0]: radius, size[1]: half length. 3-D only
    SHAPE_CYLINDER = 3
    #: around axis z; size[0]: radius, size[1]: half length without caps. 3-D only
    SHAPE_CAPSULE = 4
    #: size: half edges; in 2-D a rectangle. Not in 1-D
    SHAPE_BOX = 5
    #: what mpm_obstacle_desc.distance says
    SHAPE_DISTANCE = 64


class Motion(IntEnum):
    """How an obstacle moves: mpm_obstacle_desc.motion."""

    #: not at all (default)
    MOTION_FIXED = 0
    #: by its velocities, which the host may change from step to step
    MOTION_PRESCRIBED = 1
    #: as a rigid body under contact, gravity and the host's load
    MOTION_FREE = 2


class Adapt(IntEnum):
    """What a batch of mpm_adaption_fn is about."""

    #: particles that are to be split
    ADAPT_SPLIT = 0
    #: pairs that are to become one particle
    ADAPT_MERGE = 1


class Conduction(IntEnum):
    """How the nodes conduct."""

    #: By the temperatures at the start of the step. Steps longer than 1 / (2 diffusivity sum 1 / h_k^2), h_k the
    #: spacings, are refused with MPM_CUT_DT, and mpm_stable_dt() takes the bound into account; with
    #: total_lagrangian = 1 spacings are those that the deformation has made of them. So are steps in which a film
    #: of mpm_surface_set_heat() would take more from a particle than its difference to the ambient, of which
    #: mpm_stable_dt() knows nothing.
    CONDUCTION_EXPLICIT = 0
    #: By those at its end (backward Euler), found by conjugate gradients: any step will do.
    CONDUCTION_IMPLICIT = 1


class HeatWall(IntEnum):
    """What a face of the grid does to heat."""

    #: lets none through
    HEAT_WALL_INSULATED = 0
    #: material at it has a prescribed temperature
    HEAT_WALL_TEMPERATURE = 1


OK = Status.OK
CUT_DT = Status.CUT_DT
INVERTED = Status.INVERTED
NONFINITE = Status.NONFINITE
NOT_CONVERGED = Status.NOT_CONVERGED
SINGULAR = Status.SINGULAR
OFF_GRID = Status.OFF_GRID
CANCELLED = Status.CANCELLED
E_ARG = Status.E_ARG
E_NOMEM = Status.E_NOMEM
E_STATE = Status.E_STATE
E_CALLBACK = Status.E_CALLBACK
E_UNSUPPORTED = Status.E_UNSUPPORTED
E_NOT_FOUND = Status.E_NOT_FOUND
E_IO = Status.E_IO
E_FORMAT = Status.E_FORMAT
E_INTERNAL = Status.E_INTERNAL
LINEAR = Basis.LINEAR
BSPLINE2 = Basis.BSPLINE2
BSPLINE3 = Basis.BSPLINE3
GIMP = Basis.GIMP
UGIMP = Basis.UGIMP
CPGIMP = Basis.CPGIMP
BOUNDARY_GHOST = BoundaryBasis.BOUNDARY_GHOST
BOUNDARY_OPEN_KNOT = BoundaryBasis.BOUNDARY_OPEN_KNOT
PLANE_STRAIN = Geometry.PLANE_STRAIN
AXISYMMETRIC = Geometry.AXISYMMETRIC
PLANE_STRESS = Geometry.PLANE_STRESS
USL = Scheme.USL
USF = Scheme.USF
MUSL = Scheme.MUSL
NEWMARK = Scheme.NEWMARK
FLIP = Transfer.FLIP
APIC = Transfer.APIC
TPIC = Transfer.TPIC
TFLIP = Transfer.TFLIP
AFLIP = Transfer.AFLIP
XPIC = Transfer.XPIC
APIC_MLS = Transfer.APIC_MLS
FMPM = Transfer.FMPM
ISA_BEST = Isa.ISA_BEST
ISA_BASELINE = Isa.ISA_BASELINE
ISA_AVX2 = Isa.ISA_AVX2
ISA_AVX512 = Isa.ISA_AVX512
ISA_NEON = Isa.ISA_NEON
ISA_PORTABLE = Isa.ISA_PORTABLE
LOG_WARNING = Log.LOG_WARNING
LOG_INFO = Log.LOG_INFO
LOG_DEBUG = Log.LOG_DEBUG
LOCKING_NONE = Locking.LOCKING_NONE
LOCKING_CELL_AVERAGE = Locking.LOCKING_CELL_AVERAGE
TANGENT_MINOR_SYMMETRIC = TangentForm.TANGENT_MINOR_SYMMETRIC
TANGENT_GENERAL = TangentForm.TANGENT_GENERAL
X_MIN = Face.X_MIN
X_MAX = Face.X_MAX
Y_MIN = Face.Y_MIN
Y_MAX = Face.Y_MAX
Z_MIN = Face.Z_MIN
Z_MAX = Face.Z_MAX
WALL_NONE = Wall.WALL_NONE
WALL_OPEN = Wall.WALL_OPEN
WALL_FIXED = Wall.WALL_FIXED
WALL_SLIP = Wall.WALL_SLIP
WALL_FRICTION = Wall.WALL_FRICTION
WALL_FRICTION_NODES = Wall.WALL_FRICTION_NODES
PRESCRIBES_NOTHING = Prescribes.PRESCRIBES_NOTHING
PRESCRIBES_VELOCITY = Prescribes.PRESCRIBES_VELOCITY
PRESCRIBES_NORMAL = Prescribes.PRESCRIBES_NORMAL
AFTER_P2G = Stage.AFTER_P2G
AFTER_FORCES = Stage.AFTER_FORCES
AFTER_VELOCITY = Stage.AFTER_VELOCITY
READ = Access.READ
WRITE = Access.WRITE
F64 = FieldType.F64
I64 = FieldType.I64
U8 = FieldType.U8
BY_ID = Order.BY_ID
LIBRARY_ORDER = Order.LIBRARY_ORDER
SOLVER_AUTO = Solver.SOLVER_AUTO
SOLVER_CG = Solver.SOLVER_CG
SOLVER_MULTIGRID_CG = Solver.SOLVER_MULTIGRID_CG
SOLVER_LDLT = Solver.SOLVER_LDLT
SOLVER_GMRES = Solver.SOLVER_GMRES
SOLVER_HOST = Solver.SOLVER_HOST
EXCHANGE_KNOWN = Exchange.EXCHANGE_KNOWN
EXCHANGE_SPARSE = Exchange.EXCHANGE_SPARSE
REDUCE_MAX = Reduce.REDUCE_MAX
REDUCE_SUM = Reduce.REDUCE_SUM
CONTACT_UNILATERAL = Contact.CONTACT_UNILATERAL
CONTACT_NONE = Contact.CONTACT_NONE
CONTACT_TIED = Contact.CONTACT_TIED
NORMAL_LOGISTIC = Normal.NORMAL_LOGISTIC
NORMAL_DISCRIMINANT = Normal.NORMAL_DISCRIMINANT
NORMAL_GRADIENT = Normal.NORMAL_GRADIENT
NORMAL_FIXED = Normal.NORMAL_FIXED
DETECT_DEFAULT = Detection.DETECT_DEFAULT
DETECT_GAP = Detection.DETECT_GAP
DETECT_VELOCITY = Detection.DETECT_VELOCITY
BODY_ANY = Body.BODY_ANY
SHAPE_PLANE = Shape.SHAPE_PLANE
SHAPE_SPHERE = Shape.SHAPE_SPHERE
SHAPE_CYLINDER = Shape.SHAPE_CYLINDER
SHAPE_CAPSULE = Shape.SHAPE_CAPSULE
SHAPE_BOX = Shape.SHAPE_BOX
SHAPE_DISTANCE = Shape.SHAPE_DISTANCE
MOTION_FIXED = Motion.MOTION_FIXED
MOTION_PRESCRIBED = Motion.MOTION_PRESCRIBED
MOTION_FREE = Motion.MOTION_FREE
ADAPT_SPLIT = Adapt.ADAPT_SPLIT
ADAPT_MERGE = Adapt.ADAPT_MERGE
CONDUCTION_EXPLICIT = Conduction.CONDUCTION_EXPLICIT
CONDUCTION_IMPLICIT = Conduction.CONDUCTION_IMPLICIT
HEAT_WALL_INSULATED = HeatWall.HEAT_WALL_INSULATED
HEAT_WALL_TEMPERATURE = HeatWall.HEAT_WALL_TEMPERATURE

#: Names of all constants.
CONSTANTS = """
    OK CUT_DT INVERTED NONFINITE NOT_CONVERGED SINGULAR OFF_GRID CANCELLED E_ARG E_NOMEM E_STATE E_CALLBACK
    E_UNSUPPORTED E_NOT_FOUND E_IO E_FORMAT E_INTERNAL LINEAR BSPLINE2 BSPLINE3 GIMP UGIMP CPGIMP BOUNDARY_GHOST
    BOUNDARY_OPEN_KNOT PLANE_STRAIN AXISYMMETRIC PLANE_STRESS USL USF MUSL NEWMARK FLIP APIC TPIC TFLIP AFLIP XPIC
    APIC_MLS FMPM ISA_BEST ISA_BASELINE ISA_AVX2 ISA_AVX512 ISA_NEON ISA_PORTABLE LOG_WARNING LOG_INFO LOG_DEBUG
    LOCKING_NONE LOCKING_CELL_AVERAGE TANGENT_MINOR_SYMMETRIC TANGENT_GENERAL X_MIN X_MAX Y_MIN Y_MAX Z_MIN Z_MAX
    WALL_NONE WALL_OPEN WALL_FIXED WALL_SLIP WALL_FRICTION WALL_FRICTION_NODES PRESCRIBES_NOTHING PRESCRIBES_VELOCITY
    PRESCRIBES_NORMAL AFTER_P2G AFTER_FORCES AFTER_VELOCITY READ WRITE F64 I64 U8 BY_ID LIBRARY_ORDER SOLVER_AUTO
    SOLVER_CG SOLVER_MULTIGRID_CG SOLVER_LDLT SOLVER_GMRES SOLVER_HOST EXCHANGE_KNOWN EXCHANGE_SPARSE REDUCE_MAX
    REDUCE_SUM CONTACT_UNILATERAL CONTACT_NONE CONTACT_TIED NORMAL_LOGISTIC NORMAL_DISCRIMINANT NORMAL_GRADIENT
    NORMAL_FIXED DETECT_DEFAULT DETECT_GAP DETECT_VELOCITY BODY_ANY SHAPE_PLANE SHAPE_SPHERE SHAPE_CYLINDER
    SHAPE_CAPSULE SHAPE_BOX SHAPE_DISTANCE MOTION_FIXED MOTION_PRESCRIBED MOTION_FREE ADAPT_SPLIT ADAPT_MERGE
    CONDUCTION_EXPLICIT CONDUCTION_IMPLICIT HEAT_WALL_INSULATED HEAT_WALL_TEMPERATURE
""".split()


reduce_fn = CFUNCTYPE(c_int32, c_void_p, c_int32, c_int64, c_void_p)

gather_fn = CFUNCTYPE(c_int32, c_void_p, c_int64, c_void_p)

transport_poll_fn = CFUNCTYPE(None, c_void_p)

task_fn = CFUNCTYPE(None, c_void_p, c_int64)

parallel_for_fn = CFUNCTYPE(c_int32, c_void_p, c_int64, task_fn, c_void_p)

context_desc_alloc_fn = CFUNCTYPE(c_void_p, c_void_p, c_size_t, c_size_t)

context_desc_release_fn = CFUNCTYPE(None, c_void_p, c_void_p, c_size_t, c_size_t)

context_desc_log_fn = CFUNCTYPE(None, c_void_p, c_int32, c_char_p)

material_desc_release_user_fn = CFUNCTYPE(None, c_void_p)

inside_fn = CFUNCTYPE(c_int32, c_void_p, c_int32, c_int64, c_int64, c_void_p, c_void_p)

solve_fn = CFUNCTYPE(c_int32, c_void_p, c_void_p, c_void_p, c_void_p, c_double, c_void_p)

motion_fn = CFUNCTYPE(c_int32, c_void_p, c_double, c_double, c_void_p, c_void_p)

write_fn = CFUNCTYPE(c_int32, c_void_p, c_void_p, c_int64)

class param(Structure):
    """A named number. The library reads the name during the call only. The struct is closed: it has no struct_size
    and gets no further fields."""

    _fields_ = [
        ("name", c_char_p),
        ("value", c_double),
    ]


class view(Structure):
    """Memory of the library, lent to the host until mpm_view_release(). Component c of item i is ((T *)data)[i *
    item_stride + c * component_stride], where T is the type that `type` names. The host sets struct_size before the
    call that fills the view, and changes no field afterwards."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("type", c_int32),
        ("components", c_int32),
        ("access", c_int32),
        ("count", c_int64),
        ("item_stride", c_int64),
        ("component_stride", c_int64),
        ("data", c_void_p),
        ("owner", c_void_p),
    ]


class message(Structure):
    """Bytes for, or from, another part."""

    _fields_ = [
        ("part", c_int32),
        ("reserved", c_int32),
        ("bytes", c_int64),
        ("data", c_void_p),
    ]


class balance_desc(Structure):
    """How blocks of the grid are given to parts. Fill it with mpm_balance_desc_init(); all 0 are the defaults."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("measure", c_int32),
        ("limit", c_double),
        ("block_weight", c_double),
    ]


class parallel_info(Structure):
    """What one part does of a problem, and what that costs. Counts are of this part, since the stepper was made or
    they were last reset; the caller sets struct_size."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("neighbours", c_int32),
        ("blocks", c_int64),
        ("boundary", c_int64),
        ("ghosts", c_int64),
        ("bytes_nodes", c_int64),
        ("bytes_moved", c_int64),
        ("moved", c_int64),
        ("cuts", c_int64),
        ("imbalance", c_double),
        ("seconds_packing", c_double),
        ("seconds_waiting", c_double),
        ("seconds_reducing", c_double),
    ]


class grid_desc(Structure):
    """Box, cells and basis of a grid. Fill the struct with mpm_grid_desc_init(). Entries of axes beyond dim are
    ignored."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("dim", c_int32),
        ("basis", c_int32),
        ("boundary_basis", c_int32),
        ("periodic", c_int32 * 3),
        ("geometry", c_int32),
        ("cells", c_int64 * 3),
        ("origin", c_double * 3),
        ("spacing", c_double * 3),
        ("smoothing", c_double),
        ("total_lagrangian", c_int32),
        ("reserved", c_int32),
    ]


class material_batch(Structure):
    """Particles that a law is asked about. Arrays are [components][ld], of which the first n items of each component
    count. Tensors are full: F, F_inc and L have component 3 * row + column, stresses xx yy zz xy yz xz. In callbacks
    the memory belongs to the library and is valid during the call, and output arrays do not overlap input arrays."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("state_count", c_int32),
        ("n", c_int64),
        ("ld", c_int64),
        ("t", c_double),
        ("dt", c_double),
        ("id", c_void_p),
        ("F", c_void_p),
        ("F_inc", c_void_p),
        ("L", c_void_p),
        ("stress", c_void_p),
        ("state", c_void_p),
        ("stress_new", c_void_p),
        ("state_new", c_void_p),
        ("wave_speed", c_void_p),
        ("kinematic_viscosity", c_void_p),
        ("energy", c_void_p),
        ("position", c_void_p),
        ("lookup", c_void_p),
    ]


class operator_info(Structure):
    """A linear system. The caller sets struct_size. The arrays belong to the library and are valid until the solve
    callback returns. A row is one component of one node; nodes and components whose displacement is prescribed have
    none. Rows of one node follow each other, by ascending component.

    With several parts a row is owned by exactly one part. Local rows 0 to owned_rows - 1 are those that this part
    owns, in the order of nodes that it has; they are numbered first_row, first_row + 1, ... over all parts, part by
    part. Behind them stand rows that other parts own, those alone that columns of owned rows name: they have number,
    node, component and position, and no entries of their own. Every vector has owned_rows entries. With one part all
    rows are owned, and number[i] is i.

    What a solver has made of a pattern serves as long as pattern_id is the same, of another stepper too."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("block", c_int32),
        ("symmetric", c_int32),
        ("positive_definite", c_int32),
        ("rows", c_int64),
        ("nonzeros", c_int64),
        ("pattern_id", c_int64),
        ("ld", c_int64),
        ("node", c_void_p),
        ("component", c_void_p),
        ("position", c_void_p),
        ("first_row", c_int64),
        ("owned_rows", c_int64),
        ("all_rows", c_int64),
        ("number", c_void_p),
    ]


class stepper_desc(Structure):
    """Options of a stepper. Fill the struct with mpm_stepper_desc_init(), then change what is wanted."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("scheme", c_int32),
        ("transfer", c_int32),
        ("xpic_order", c_int32),
        ("position_order", c_int32),
        ("locking_remedy", c_int32),
        ("reference_positions", c_int32),
        ("quasi_static", c_int32),
        ("staggered", c_int32),
        ("boundary_zero_acceleration", c_int32),
        ("flip", c_double),
        ("pic_damping", c_double),
        ("gravity", c_double * 3),
        ("newmark_beta", c_double),
        ("newmark_gamma", c_double),
        ("newton_tolerance_displacement", c_double),
        ("newton_tolerance_energy", c_double),
        ("newton_tolerance_residual", c_double),
        ("newton_residual_floor", c_double),
        ("newton_max_iterations", c_int32),
        ("linear_solver", c_int32),
        ("linear_tolerance", c_double),
        ("linear_max_iterations", c_int32),
        ("projected_positions", c_int32),
        ("local_damping", c_double),
        ("mass_damping", c_double),
        ("xpic_every", c_int32),
        ("reserved", c_int32),
    ]


class step_info(Structure):
    """What a step did, or the state as it is. The caller sets struct_size. Energies and momenta are the particles';
    the angular momentum is about the origin and includes the part of the matrices that transfers carry
    ("velocity_gradient"). Entries of unused axes are 0. After a failed step the sums are those of the state that was
    kept. Units are the host's: energies force * length, momenta mass * length/time."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("cause", c_int32),
        ("callback_status", c_int32),
        ("newton_iterations", c_int32),
        ("linear_solver", c_int32),
        ("set", c_int32),
        ("step", c_int64),
        ("active_nodes", c_int64),
        ("removed", c_int64),
        ("resorts", c_int64),
        ("particle", c_int64),
        ("node", c_int64),
        ("linear_iterations", c_int64),
        ("t", c_double),
        ("dt", c_double),
        ("dt_suggested", c_double),
        ("residual", c_double),
        ("kinetic_energy", c_double),
        ("strain_energy", c_double),
        ("external_work", c_double),
        ("dissipation", c_double),
        ("momentum", c_double * 3),
        ("angular_momentum", c_double * 3),
        ("external_work_total", c_double),
        ("affine_kinetic_energy", c_double),
        ("contact_dissipation", c_double),
        ("contact_nodes", c_int64),
        ("body", c_int32),
        ("reserved", c_int32),
        ("damping_dissipation", c_double),
        ("damping_dissipation_total", c_double),
    ]


class particle_batch(Structure):
    """Particles of one set for which a force is wanted. Arrays are [components][ld], of which the first n items of
    each component count. The memory belongs to the library and is valid during the call."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("dim", c_int32),
        ("n", c_int64),
        ("ld", c_int64),
        ("t", c_double),
        ("dt", c_double),
        ("id", c_void_p),
        ("position", c_void_p),
        ("reference_position", c_void_p),
        ("velocity", c_void_p),
        ("mass", c_void_p),
        ("volume", c_void_p),
        ("particles", c_void_p),
        ("lookup", c_void_p),
    ]


class node_batch(Structure):
    """Active nodes of the grid. Arrays are [components][ld], of which the first n items of each component count. The
    memory belongs to the library and is valid during the call."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("dim", c_int32),
        ("body", c_int32),
        ("reserved", c_int32),
        ("n", c_int64),
        ("ld", c_int64),
        ("t", c_double),
        ("dt", c_double),
        ("index", c_void_p),
        ("position", c_void_p),
        ("mass", c_void_p),
        ("owned", c_void_p),
    ]


class advance_desc(Structure):
    """How mpm_advance() chooses its sub-steps. Fill the struct with mpm_advance_desc_init()."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("max_cuts", c_int32),
        ("t_end", c_double),
        ("cfl", c_double),
        ("dt_first", c_double),
        ("dt_min", c_double),
        ("dt_max", c_double),
        ("max_steps", c_int64),
    ]


class profile(Structure):
    """Seconds of wall-clock time spent in steps since creation or the last reset, by stage. The caller sets
    struct_size."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("reserved", c_int32),
        ("sort", c_double),
        ("p2g", c_double),
        ("grid", c_double),
        ("g2p", c_double),
        ("law", c_double),
        ("assembly", c_double),
        ("factor", c_double),
        ("solve", c_double),
        ("callbacks", c_double),
        ("total", c_double),
        ("weights", c_double),
    ]


class contact_desc(Structure):
    """How two bodies meet. Fill it with mpm_contact_desc_init()."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("kind", c_int32),
        ("normal", c_int32),
        ("detection", c_int32),
        ("friction", c_double),
        ("friction_static", c_double),
        ("adhesion", c_double),
        ("offset", c_double),
        ("direction", c_double * 3),
    ]


class contact_info(Structure):
    """What two bodies did to each other in the last step, and since then. The caller sets struct_size. Forces are
    means over the step."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("touching", c_int32),
        ("nodes", c_int64),
        ("closed", c_int64),
        ("stuck", c_int64),
        ("ambiguous", c_int64),
        ("force", c_double * 3),
        ("torque", c_double * 3),
        ("normal_force", c_double),
        ("area", c_double),
        ("pressure_max", c_double),
        ("gap", c_double),
        ("dissipation", c_double),
        ("friction_work", c_double),
        ("impulse", c_double * 3),
    ]


class contact_batch(Structure):
    """Nodes at which two bodies touch, for mpm_friction_fn. Arrays belong to the library."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("dim", c_int32),
        ("body_a", c_int32),
        ("body_b", c_int32),
        ("n", c_int64),
        ("ld", c_int64),
        ("t", c_double),
        ("dt", c_double),
        ("position", c_void_p),
        ("normal", c_void_p),
        ("gap", c_void_p),
        ("area", c_void_p),
        ("slip", c_void_p),
        ("pressure", c_void_p),
    ]


class distance_batch(Structure):
    """Points whose distance from an obstacle is asked for. All is in the axes of the body, from its centre; in space
    these are the same until it moves. Arrays belong to the library."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("dim", c_int32),
        ("n", c_int64),
        ("ld", c_int64),
        ("t", c_double),
        ("position", c_void_p),
        ("distance", c_void_p),
        ("normal", c_void_p),
        ("velocity", c_void_p),
    ]


class surface_desc(Structure):
    """Loads of all markers of a surface, and what it prescribes. What markers carry by themselves ("pressure",
    "traction", "dead_traction", "prescribed_velocity") and what the callbacks give comes on top. Fill it with
    mpm_surface_desc_init()."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("body", c_int32),
        ("pressure", c_double),
        ("traction", c_double * 3),
        ("dead_traction", c_double * 3),
        ("max_spacing", c_double),
        ("prescribes", c_int32),
        ("reserved", c_int32),
        ("velocity", c_double * 3),
        ("penalty", c_double),
        ("modulus", c_double),
    ]


class marker_batch(Structure):
    """Markers for which tractions are wanted. Arrays are [components][ld], belong to the library and are valid during
    the call."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("dim", c_int32),
        ("n", c_int64),
        ("ld", c_int64),
        ("t", c_double),
        ("dt", c_double),
        ("id", c_void_p),
        ("position", c_void_p),
        ("area", c_void_p),
        ("reference_area", c_void_p),
        ("displacement", c_void_p),
        ("velocity", c_void_p),
    ]


class adaption_batch(Structure):
    """Particles that are to be split, or pairs that are to be merged. Arrays belong to the library and are valid
    during the call."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("what", c_int32),
        ("n", c_int64),
        ("ld", c_int64),
        ("dim", c_int32),
        ("reserved", c_int32),
        ("id", c_void_p),
        ("other", c_void_p),
        ("position", c_void_p),
    ]


class adaption_info(Structure):
    """What adaption has done to a set, in all steps since it was first described for it or the time was set."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("reserved", c_int32),
        ("splits", c_int64),
        ("added", c_int64),
        ("merges", c_int64),
        ("kinetic_loss", c_double),
        ("affine_loss", c_double),
        ("strain_loss", c_double),
        ("angular_momentum_loss", c_double * 3),
    ]


class heat_info(Structure):
    """Where heat came from, in the last step and in all steps since the first set was described or the time was set:
    gained = sum of walls + sources + surfaces + dissipated, to rounding, and with implicit conduction to the
    tolerance. All are energies."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("iterations", c_int32),
        ("heat", c_double),
        ("gained", c_double),
        ("walls", c_double * 6),
        ("sources", c_double),
        ("surfaces", c_double),
        ("dissipated", c_double),
        ("gained_total", c_double),
        ("walls_total", c_double * 6),
        ("sources_total", c_double),
        ("surfaces_total", c_double),
        ("dissipated_total", c_double),
    ]


send_fn = CFUNCTYPE(c_int32, c_void_p, c_int32, c_int32, POINTER(message), c_void_p)

receive_fn = CFUNCTYPE(c_int32, c_void_p, c_void_p, c_void_p)

stress_fn = CFUNCTYPE(c_int32, c_void_p, POINTER(material_batch))

tangent_fn = CFUNCTYPE(c_int32, c_void_p, POINTER(material_batch), c_void_p, c_void_p)

particle_fn = CFUNCTYPE(c_int32, c_void_p, POINTER(particle_batch), c_void_p)

velocity_fn = CFUNCTYPE(c_int32, c_void_p, POINTER(node_batch), c_void_p, c_void_p)

node_fn = CFUNCTYPE(c_int32, c_void_p, POINTER(node_batch), c_void_p, c_void_p)

progress_fn = CFUNCTYPE(c_int32, c_void_p, POINTER(step_info))

friction_fn = CFUNCTYPE(c_int32, c_void_p, POINTER(contact_batch), c_void_p)

distance_fn = CFUNCTYPE(c_int32, c_void_p, POINTER(distance_batch))

traction_fn = CFUNCTYPE(c_int32, c_void_p, POINTER(marker_batch), c_void_p)

marker_velocity_fn = CFUNCTYPE(c_int32, c_void_p, POINTER(marker_batch), c_void_p)

adaption_fn = CFUNCTYPE(c_int32, c_void_p, POINTER(adaption_batch), c_void_p)

heat_fn = CFUNCTYPE(c_int32, c_void_p, POINTER(particle_batch), c_void_p)

class transport(Structure):
    """Ways between the parts. All are called on the calling thread. Once one has failed, every collective call of the
    context returns MPM_E_CALLBACK."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("part", c_int32),
        ("parts", c_int32),
        ("reserved", c_int32),
        ("send", send_fn),
        ("receive", receive_fn),
        ("reduce", reduce_fn),
        ("gather", gather_fn),
        ("poll", transport_poll_fn),
        ("user", c_void_p),
    ]


class context_desc(Structure):
    """Services of the host. Fill the struct with mpm_context_desc_init(), then change what is wanted."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("concurrency", c_int32),
        ("isa", c_int32),
        ("serial_callbacks", c_int32),
        ("alloc", context_desc_alloc_fn),
        ("release", context_desc_release_fn),
        ("alloc_user", c_void_p),
        ("parallel_for", parallel_for_fn),
        ("parallel_user", c_void_p),
        ("log", context_desc_log_fn),
        ("log_user", c_void_p),
        ("error_text", c_void_p),
        ("error_bytes", c_uint64),
        ("transport", POINTER(transport)),
    ]


class material_desc(Structure):
    """A law of the host. Fill the struct with mpm_material_desc_init()."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("state_count", c_int32),
        ("tangent_form", c_int32),
        ("reserved", c_int32),
        ("density", c_double),
        ("stress", stress_fn),
        ("tangent", tangent_fn),
        ("user", c_void_p),
        ("release_user", material_desc_release_user_fn),
        ("state_initial", c_void_p),
    ]


class obstacle_desc(Structure):
    """An obstacle. Fill it with mpm_obstacle_desc_init()."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("shape", c_int32),
        ("motion", c_int32),
        ("inside", c_int32),
        ("size", c_double * 3),
        ("position", c_double * 3),
        ("orientation", c_double * 4),
        ("velocity", c_double * 3),
        ("angular_velocity", c_double * 3),
        ("mass", c_double),
        ("inertia", c_double * 9),
        ("contact", POINTER(contact_desc)),
        ("distance", distance_fn),
        ("user", c_void_p),
        ("lower", c_double * 3),
        ("upper", c_double * 3),
    ]


class adaption_desc(Structure):
    """How a set adapts. Fill it with mpm_adaption_desc_init(), after which nothing is split and nothing merged.
    Lengths are counted in cells: an edge (a, b, c) has the length |(a/h_x, b/h_y, c/h_z)|."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("every", c_int32),
        ("split_edge", c_double),
        ("least_edge", c_double),
        ("min_per_cell", c_int32),
        ("max_per_cell", c_int32),
        ("merge_distance", c_double),
        ("merge_tolerance", c_double),
        ("most_particles", c_int64),
        ("accept", adaption_fn),
        ("user", c_void_p),
    ]


class heat_desc(Structure):
    """The heat of a set. Fill it with mpm_heat_desc_init()."""

    _fields_ = [
        ("struct_size", c_uint32),
        ("reserved", c_int32),
        ("specific_heat", c_double),
        ("conductivity", c_double),
        ("expansion", c_double),
        ("reference_temperature", c_double),
        ("dissipated_share", c_double),
        ("source", heat_fn),
        ("user", c_void_p),
    ]


#: Sizes of the structs for pointers of 8 and of 4 bytes.
SIZES = {
    param: (16, 16),
    view: (56, 48),
    message: (24, 24),
    transport: (64, 40),
    balance_desc: (24, 24),
    parallel_info: (96, 96),
    context_desc: (96, 64),
    grid_desc: (120, 120),
    material_batch: (144, 96),
    material_desc: (64, 48),
    operator_info: (104, 96),
    stepper_desc: (176, 176),
    step_info: (248, 248),
    particle_batch: (104, 72),
    node_batch: (80, 64),
    advance_desc: (56, 56),
    profile: (96, 96),
    contact_desc: (72, 72),
    contact_info: (160, 160),
    contact_batch: (96, 72),
    distance_batch: (64, 48),
    obstacle_desc: (296, 288),
    surface_desc: (120, 120),
    marker_batch: (88, 64),
    adaption_batch: (56, 48),
    adaption_desc: (72, 64),
    adaption_info: (80, 80),
    heat_desc: (64, 56),
    heat_info: (176, 176),
}

#: Result and arguments of every function.
FUNCTIONS = {
    "mpm_version": (c_uint32, []),
    "mpm_status_name": (c_char_p, [c_int32]),
    "mpm_status_text": (c_char_p, [c_int32]),
    "mpm_view_release": (c_int32, [POINTER(view)]),
    "mpm_context_part": (c_int32, [c_void_p, c_void_p, c_void_p]),
    "mpm_particles_total": (c_int32, [c_void_p, c_void_p]),
    "mpm_balance_desc_init": (c_int32, [POINTER(balance_desc), c_uint32]),
    "mpm_stepper_set_balance": (c_int32, [c_void_p, POINTER(balance_desc)]),
    "mpm_stepper_parallel_info": (c_int32, [c_void_p, c_int32, POINTER(parallel_info)]),
    "mpm_particles_packed_size": (c_int32, [c_void_p, c_int64, c_void_p]),
    "mpm_particles_pack": (c_int32, [c_void_p, c_int64, c_void_p, c_void_p, c_int64]),
    "mpm_particles_unpack": (c_int32, [c_void_p, c_void_p, c_int64]),
    "mpm_context_desc_init": (c_int32, [POINTER(context_desc), c_uint32]),
    "mpm_context_create": (c_int32, [POINTER(context_desc), c_void_p]),
    "mpm_context_memory": (c_int32, [c_void_p, c_void_p, c_void_p]),
    "mpm_context_destroy": (c_int32, [c_void_p]),
    "mpm_last_error": (c_char_p, [c_void_p]),
    "mpm_set_last_error": (c_int32, [c_void_p, c_int32, c_char_p]),
    "mpm_grid_desc_init": (c_int32, [POINTER(grid_desc), c_uint32]),
    "mpm_grid_create": (c_int32, [c_void_p, POINTER(grid_desc), c_void_p]),
    "mpm_grid_destroy": (c_int32, [c_void_p]),
    "mpm_material_create": (c_int32, [c_void_p, c_char_p, POINTER(param), c_int32, c_void_p]),
    "mpm_material_model_count": (c_int32, []),
    "mpm_material_model_name": (c_char_p, [c_int32]),
    "mpm_material_model_param": (c_int32, [c_char_p, c_int32, c_void_p, c_void_p, c_void_p, c_void_p, c_void_p, c_void_p]),
    "mpm_material_state_count": (c_int32, [c_char_p]),
    "mpm_material_state_name": (c_int32, [c_char_p, c_int32, c_void_p, c_void_p, c_void_p]),
    "mpm_batch_field": (c_int32, [c_void_p, c_char_p, c_void_p, c_void_p]),
    "mpm_material_desc_init": (c_int32, [POINTER(material_desc), c_uint32]),
    "mpm_material_create_custom": (c_int32, [c_void_p, POINTER(material_desc), c_void_p]),
    "mpm_material_update": (c_int32, [c_void_p, POINTER(material_batch), c_void_p, c_void_p]),
    "mpm_material_destroy": (c_int32, [c_void_p]),
    "mpm_particles_create": (c_int32, [c_void_p, c_void_p, c_void_p, c_void_p]),
    "mpm_particles_destroy": (c_int32, [c_void_p]),
    "mpm_particles_add": (c_int32, [c_void_p, c_int64, c_void_p, c_void_p, c_void_p, c_void_p, c_void_p, c_void_p]),
    "mpm_particles_fill_box": (c_int32, [c_void_p, c_void_p, c_void_p, c_void_p, c_void_p, c_void_p]),
    "mpm_particles_fill_ball": (c_int32, [c_void_p, c_void_p, c_double, c_void_p, c_void_p, c_void_p]),
    "mpm_particles_fill": (c_int32, [c_void_p, c_void_p, c_void_p, c_void_p, inside_fn, c_void_p, c_void_p, c_void_p]),
    "mpm_particles_fill_mesh": (c_int32, [c_void_p, c_int64, c_void_p, c_int64, c_void_p, c_void_p, c_void_p, c_void_p]),
    "mpm_particles_remove": (c_int32, [c_void_p, c_int64, c_void_p]),
    "mpm_particles_count": (c_int64, [c_void_p]),
    "mpm_particles_field_info": (c_int32, [c_void_p, c_int32, c_void_p, c_void_p, c_void_p, c_void_p]),
    "mpm_particles_add_field": (c_int32, [c_void_p, c_char_p, c_int32, c_int32]),
    "mpm_particles_set_extensive": (c_int32, [c_void_p, c_char_p, c_int32]),
    "mpm_particles_map": (c_int32, [c_void_p, c_char_p, c_int32, POINTER(view)]),
    "mpm_particles_get": (c_int32, [c_void_p, c_char_p, c_int32, c_int32, c_int64, c_void_p, c_void_p]),
    "mpm_particles_get_f32": (c_int32, [c_void_p, c_int32, c_void_p, c_int32, c_int64, c_void_p]),
    "mpm_particles_set": (c_int32, [c_void_p, c_char_p, c_int32, c_int32, c_int64, c_void_p, c_void_p]),
    "mpm_particles_set_all": (c_int32, [c_void_p, c_char_p, c_int32, c_int32, c_void_p]),
    "mpm_particles_set_geostatic": (c_int32, [c_void_p, c_int32, c_double, c_double, c_double, c_double]),
    "mpm_particles_reset_reference": (c_int32, [c_void_p]),
    "mpm_operator_get_info": (c_int32, [c_void_p, POINTER(operator_info)]),
    "mpm_operator_apply": (c_int32, [c_void_p, c_void_p, c_void_p]),
    "mpm_operator_csr": (c_int32, [c_void_p, c_void_p, c_void_p, c_void_p]),
    "mpm_stepper_desc_init": (c_int32, [POINTER(stepper_desc), c_uint32]),
    "mpm_stepper_create": (c_int32, [c_void_p, c_void_p, POINTER(stepper_desc), c_void_p]),
    "mpm_stepper_destroy": (c_int32, [c_void_p]),
    "mpm_stepper_add": (c_int32, [c_void_p, c_void_p]),
    "mpm_stepper_remove": (c_int32, [c_void_p, c_void_p]),
    "mpm_stepper_configure": (c_int32, [c_void_p, POINTER(stepper_desc)]),
    "mpm_stepper_set_time": (c_int32, [c_void_p, c_double, c_int64]),
    "mpm_stepper_set_motion": (c_int32, [c_void_p, c_void_p, particle_fn, c_void_p]),
    "mpm_stepper_set_wall": (c_int32, [c_void_p, c_int32, c_int32, c_double]),
    "mpm_stepper_set_acceleration": (c_int32, [c_void_p, particle_fn, c_void_p]),
    "mpm_stepper_set_force": (c_int32, [c_void_p, particle_fn, c_void_p]),
    "mpm_stepper_set_velocity_bc": (c_int32, [c_void_p, velocity_fn, c_void_p]),
    "mpm_stepper_set_node_hook": (c_int32, [c_void_p, c_int32, node_fn, c_void_p]),
    "mpm_stepper_set_linear_solver": (c_int32, [c_void_p, solve_fn, c_void_p]),
    "mpm_stepper_set_progress": (c_int32, [c_void_p, progress_fn, c_void_p]),
    "mpm_stable_dt": (c_int32, [c_void_p, c_void_p]),
    "mpm_step": (c_int32, [c_void_p, c_double, POINTER(step_info)]),
    "mpm_advance_desc_init": (c_int32, [POINTER(advance_desc), c_uint32]),
    "mpm_advance": (c_int32, [c_void_p, POINTER(advance_desc), POINTER(step_info)]),
    "mpm_stepper_profile": (c_int32, [c_void_p, c_int32, POINTER(profile)]),
    "mpm_stepper_info": (c_int32, [c_void_p, POINTER(step_info)]),
    "mpm_stepper_residuals": (c_int32, [c_void_p, c_int32, c_void_p, c_void_p]),
    "mpm_step_begin": (c_int32, [c_void_p, c_double]),
    "mpm_step_grid": (c_int32, [c_void_p]),
    "mpm_step_end": (c_int32, [c_void_p, POINTER(step_info)]),
    "mpm_step_abort": (c_int32, [c_void_p]),
    "mpm_grid_map": (c_int32, [c_void_p, c_int32, c_char_p, c_int32, POINTER(view)]),
    "mpm_stepper_wall_reaction": (c_int32, [c_void_p, c_int32, c_void_p]),
    "mpm_stepper_particles_reaction": (c_int32, [c_void_p, c_void_p, c_void_p]),
    "mpm_stepper_wall_impulse": (c_int32, [c_void_p, c_int32, c_void_p]),
    "mpm_stepper_particles_impulse": (c_int32, [c_void_p, c_void_p, c_void_p]),
    "mpm_stepper_set_body": (c_int32, [c_void_p, c_void_p, c_int32]),
    "mpm_stepper_body": (c_int32, [c_void_p, c_void_p, c_void_p]),
    "mpm_contact_desc_init": (c_int32, [POINTER(contact_desc), c_uint32]),
    "mpm_stepper_set_contact": (c_int32, [c_void_p, c_int32, c_int32, POINTER(contact_desc)]),
    "mpm_stepper_set_friction": (c_int32, [c_void_p, friction_fn, c_void_p]),
    "mpm_stepper_contact_info": (c_int32, [c_void_p, c_int32, c_int32, POINTER(contact_info)]),
    "mpm_obstacle_desc_init": (c_int32, [POINTER(obstacle_desc), c_uint32]),
    "mpm_obstacle_create": (c_int32, [c_void_p, POINTER(obstacle_desc), c_void_p]),
    "mpm_obstacle_destroy": (c_int32, [c_void_p]),
    "mpm_stepper_add_obstacle": (c_int32, [c_void_p, c_void_p]),
    "mpm_stepper_remove_obstacle": (c_int32, [c_void_p, c_void_p]),
    "mpm_obstacle_set_motion": (c_int32, [c_void_p, motion_fn, c_void_p]),
    "mpm_obstacle_set_contact": (c_int32, [c_void_p, POINTER(contact_desc)]),
    "mpm_obstacle_set_pose": (c_int32, [c_void_p, c_void_p, c_void_p, c_void_p, c_void_p]),
    "mpm_obstacle_get_pose": (c_int32, [c_void_p, c_void_p, c_void_p, c_void_p, c_void_p]),
    "mpm_obstacle_set_load": (c_int32, [c_void_p, c_void_p, c_void_p]),
    "mpm_obstacle_contact_info": (c_int32, [c_void_p, c_int32, POINTER(contact_info)]),
    "mpm_surface_desc_init": (c_int32, [POINTER(surface_desc), c_uint32]),
    "mpm_surface_create": (c_int32, [c_void_p, c_void_p, POINTER(surface_desc), c_void_p]),
    "mpm_surface_destroy": (c_int32, [c_void_p]),
    "mpm_surface_configure": (c_int32, [c_void_p, POINTER(surface_desc)]),
    "mpm_surface_set_traction": (c_int32, [c_void_p, traction_fn, c_void_p]),
    "mpm_surface_set_velocity": (c_int32, [c_void_p, marker_velocity_fn, c_void_p]),
    "mpm_surface_add": (c_int32, [c_void_p, c_int64, c_void_p, c_void_p, c_void_p]),
    "mpm_surface_add_polyline": (c_int32, [c_void_p, c_int64, c_void_p, c_int32, c_double, c_void_p, c_void_p]),
    "mpm_surface_add_triangles": (c_int32, [c_void_p, c_int64, c_void_p, c_int64, c_void_p, c_double, c_void_p, c_void_p]),
    "mpm_surface_remove": (c_int32, [c_void_p, c_int64, c_void_p]),
    "mpm_surface_refine": (c_int32, [c_void_p, c_double, c_void_p]),
    "mpm_surface_count": (c_int64, [c_void_p]),
    "mpm_surface_get": (c_int32, [c_void_p, c_char_p, c_int32, c_int32, c_int64, c_void_p, c_void_p]),
    "mpm_surface_set": (c_int32, [c_void_p, c_char_p, c_int32, c_int32, c_int64, c_void_p, c_void_p]),
    "mpm_stepper_add_surface": (c_int32, [c_void_p, c_void_p]),
    "mpm_stepper_remove_surface": (c_int32, [c_void_p, c_void_p]),
    "mpm_stepper_surface_reaction": (c_int32, [c_void_p, c_void_p, c_void_p]),
    "mpm_stepper_surface_impulse": (c_int32, [c_void_p, c_void_p, c_void_p]),
    "mpm_adaption_desc_init": (c_int32, [POINTER(adaption_desc), c_uint32]),
    "mpm_stepper_set_adaption": (c_int32, [c_void_p, c_void_p, POINTER(adaption_desc)]),
    "mpm_stepper_adapt": (c_int32, [c_void_p]),
    "mpm_stepper_adaption_info": (c_int32, [c_void_p, c_void_p, POINTER(adaption_info)]),
    "mpm_heat_desc_init": (c_int32, [POINTER(heat_desc), c_uint32]),
    "mpm_stepper_set_heat": (c_int32, [c_void_p, c_void_p, POINTER(heat_desc)]),
    "mpm_stepper_set_conduction": (c_int32, [c_void_p, c_int32, c_double]),
    "mpm_stepper_set_heat_wall": (c_int32, [c_void_p, c_int32, c_int32, c_double]),
    "mpm_surface_set_heat": (c_int32, [c_void_p, c_double, c_double, c_double]),
    "mpm_stepper_heat_info": (c_int32, [c_void_p, POINTER(heat_info)]),
    "mpm_state_size": (c_int32, [c_void_p, c_void_p]),
    "mpm_state_save": (c_int32, [c_void_p, c_void_p, c_int64]),
    "mpm_state_load": (c_int32, [c_void_p, c_void_p, c_int64]),
    "mpm_state_load_pieces": (c_int32, [c_void_p, c_int32, c_void_p, c_void_p]),
    "mpm_state_save_file": (c_int32, [c_void_p, c_char_p]),
    "mpm_state_save_to": (c_int32, [c_void_p, write_fn, c_void_p]),
    "mpm_state_load_file": (c_int32, [c_void_p, c_char_p]),
    "mpm_state_hash": (c_int32, [c_void_p, c_void_p]),
    "mpm_write_particles": (c_int32, [c_void_p, c_char_p, c_int32, c_void_p]),
    "mpm_write_particles_to": (c_int32, [c_void_p, write_fn, c_void_p, c_int32, c_void_p]),
    "mpm_write_grid": (c_int32, [c_void_p, c_char_p, c_int32, c_void_p]),
    "mpm_write_body_grid": (c_int32, [c_void_p, c_int32, c_char_p, c_int32, c_void_p]),
    "mpm_write_grid_to": (c_int32, [c_void_p, c_int32, write_fn, c_void_p, c_int32, c_void_p]),
    "mpm_series_open": (c_int32, [c_void_p, c_char_p, c_void_p]),
    "mpm_series_append": (c_int32, [c_void_p, c_double, c_char_p]),
    "mpm_series_close": (c_int32, [c_void_p]),
}

#: What the headers say about every function.
DOCS = {
    "mpm_version": """uint32_t mpm_version()

The version of the library that runs, as 0xMMmmpp, to be compared with MPM_VERSION. May be called from any thread at
any time.""",
    "mpm_status_name": """const char *mpm_status_name(mpm_status status)

The name of a status constant, such as "MPM_E_ARG", or "unknown status" for any other value. The text is static, and
the pointer is never NULL. May be called from any thread at any time.""",
    "mpm_status_text": """const char *mpm_status_text(mpm_status status)

What a status says, in a sentence without names and values: for calls that have no context to keep a text, as those on
NULL. Static, and never NULL: see mpm_last_error() for more. May be called from any thread at any time.""",
    "mpm_view_release": """mpm_status mpm_view_release(mpm_view *view)

Gives back the memory of a view that mpm_particles_map() or mpm_grid_map() filled. Afterwards its data and owner are
NULL. What the host wrote through a view with MPM_WRITE takes effect now. Memory of a view without it is not to be
changed: whatever is written there harms no step beyond its numbers, and a library built with MPM_DEBUG notices.

- MPM_E_ARG: view is NULL, or the host wrote values that are not finite or give det F <= 0. In the second case the
  view is released all the same, and the set refuses to step (MPM_E_STATE) until the values are repaired; bad nodal
  values are dropped.
- MPM_E_STATE: the view is not lent, or no longer; or, with MPM_DEBUG, it was lent for reading and its memory has
  changed: it is then released all the same. A view that was never filled has no context to keep a text.""",
    "mpm_context_part": """mpm_status mpm_context_part(const mpm_context *context, int32_t *part, int32_t *parts)

Number of this part and how many there are; 0 and 1 without a transport. Pointers may be NULL.""",
    "mpm_particles_total": """mpm_status mpm_particles_total(const mpm_particles *particles, int64_t *n)

Particles of a set on all parts (collective). mpm_particles_count() is that of this part.""",
    "mpm_balance_desc_init": """mpm_status mpm_balance_desc_init(mpm_balance_desc *desc, uint32_t struct_size)

Fills desc with the defaults. struct_size is sizeof(mpm_balance_desc) of the caller; no byte beyond is written.
MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.""",
    "mpm_stepper_set_balance": """mpm_status mpm_stepper_set_balance(mpm_stepper *stepper, const mpm_balance_desc *desc)

Sets how blocks are given to parts, from the next sort of particles on (collective); desc NULL: by the defaults.
Results do not depend on it, bit by bit. Not part of a saved state: the host sets it again. With one part it is
checked and does nothing. MPM_E_ARG: a value is out of range, or another one is given on another part. MPM_E_STATE: a
step is under way. Since 0.2.0.""",
    "mpm_stepper_parallel_info": """mpm_status mpm_stepper_parallel_info(mpm_stepper *stepper, int32_t reset, mpm_parallel_info *info)

Tells what this part does, as of the last step; 1 in reset starts the counts anew. MPM_E_ARG: info is NULL or its
struct_size is bad. With one part nothing is exchanged: all but blocks and imbalance, 1, is 0.""",
    "mpm_particles_packed_size": """mpm_status mpm_particles_packed_size(const mpm_particles *particles, int64_t n, int64_t *bytes)

Tells how many bytes mpm_particles_pack() needs for n particles of the set, with the fields that it has now.
MPM_E_ARG: n is negative or beyond 2^32 - 2, or bytes is NULL. Since 0.2.0.""",
    "mpm_particles_pack": """mpm_status mpm_particles_pack(const mpm_particles *particles, int64_t n, const int64_t *ids, void *buffer, int64_t
capacity)

Packs n particles into a buffer, for hosts that move them themselves: between sets, programs, machines. They have
every field in use, bit by bit, with ids, images and the host's fields, and what says of which law they are. The order
of bytes is the same on all machines. The particles stay in the set.

- ids: [n], each once, in this order; NULL for all particles by ascending id, where n is mpm_particles_count().
- buffer: of `capacity` bytes, of which those of mpm_particles_packed_size() are written; anywhere.

Of a problem in several parts these are particles of this part, and no other part takes part. MPM_E_NOT_FOUND: an id
is not in the set. MPM_E_ARG: capacity is too small, an id is given twice, n does not match or buffer is NULL.
MPM_E_STATE: a staged step is under way, a view of the set is out for writing, or a value that was written through one
is bad. Since 0.2.0.""",
    "mpm_particles_unpack": """mpm_status mpm_particles_unpack(mpm_particles *particles, const void *buffer, int64_t bytes)

Adds packed particles to a set, bit by bit: all or none. The law is not asked: stress, state variables and volume come
along. Fields that the set has and the buffer lacks have the values of new particles. Grids may have other cells and
bases, if the particles lie inside.

Of a problem in several parts they are added to this part, and no other part takes part; the next step brings them
home. MPM_E_FORMAT: the buffer is damaged; it is of another law, or of other parameters, dimension, geometry or kind
of grid, or counts images of other periods; or it has fields that the set has not: of the host, of another type, or
"reference_position" and "dilation_ratio" where no stepper keeps them. MPM_E_ARG: an id is in use, or a particle lies
outside the grid, which the text names; or buffer is NULL. MPM_E_STATE: as for all that changes a set. Since 0.2.0.""",
    "mpm_context_desc_init": """mpm_status mpm_context_desc_init(mpm_context_desc *desc, uint32_t struct_size)

Fills desc with the defaults. struct_size is sizeof(mpm_context_desc) of the caller; no byte beyond is written.
MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.""",
    "mpm_context_create": """mpm_status mpm_context_create(const mpm_context_desc *desc, mpm_context **out)

Makes a context. desc is copied and may be NULL for the defaults. *out is NULL unless MPM_OK is returned. The host
ends the context with mpm_context_destroy(). There is no context to ask why a call has failed: the sentence goes to
error_text, and to log with MPM_LOG_WARNING, as far as desc sets them.

- MPM_E_ARG: a value is bad, only one of alloc and release or of error_text and error_bytes is set, or the variable
  MPM_ISA has an unknown value.
- MPM_E_NOMEM: memory or threads are not to be had.
- MPM_E_UNSUPPORTED: the instruction set is not available, the build has no threads, or desc sets a field that this
  version of the library does not know.""",
    "mpm_context_memory": """mpm_status mpm_context_memory(const mpm_context *context, int64_t *bytes, int64_t *peak_bytes)

Tells how many bytes the context and its objects hold now, and the most that they ever held. Either output pointer may
be NULL. Any thread, any time while the context lives, also in callbacks.""",
    "mpm_context_destroy": """mpm_status mpm_context_destroy(mpm_context *context)

Ends the pool and frees the context. NULL is fine. MPM_E_STATE while objects made with it live, and in its own
callbacks.""",
    "mpm_last_error": """const char *mpm_last_error(const mpm_context *context)

Gives one or two sentences, with the offending names and values, on the last call on this context or its objects that
did not return MPM_OK. Calls that succeed leave them as they are, so that a host may clean up and log first and ask
then; "" while no call has failed. The text belongs to the library and is valid until the next call on the context. Of
NULL, and of a handle of another kind, a sentence that says so: the calls that get no further than to such a handle
have no other. A context that was destroyed must not be given to this or any other call. May be called in callbacks,
too, on the thread of the call.""",
    "mpm_set_last_error": """mpm_status mpm_set_last_error(mpm_context *context, mpm_status status, const char *text)

Makes text the sentence of mpm_last_error() and returns status: for libraries that stand on this one and refuse a call
of their own on a context, as mpm_umat.h does. text is copied, and cut after some 1000 bytes. MPM_E_ARG: status is
MPM_OK, or text is NULL; the sentence then says that.""",
    "mpm_grid_desc_init": """mpm_status mpm_grid_desc_init(mpm_grid_desc *desc, uint32_t struct_size)

Fills desc with the defaults; cells and spacing are 0, and the host must set them. struct_size is
sizeof(mpm_grid_desc) of the caller; no byte beyond is written. MPM_E_ARG: it is smaller than the first released
struct. Any thread, any time.""",
    "mpm_grid_create": """mpm_status mpm_grid_create(mpm_context *context, const mpm_grid_desc *desc, mpm_grid **out)

Makes a grid. desc is copied. Any number of sets and steppers share the grid, which outlives them. *out is NULL unless
MPM_OK is returned. MPM_E_ARG: a value is bad, or there are more nodes than 64-bit numbers can name.
MPM_E_UNSUPPORTED: open knots are asked for with a basis other than MPM_BSPLINE2 and MPM_BSPLINE3; MPM_AXISYMMETRIC
and MPM_PLANE_STRESS with a dim other than 2, the former with a periodic first axis.""",
    "mpm_grid_destroy": """mpm_status mpm_grid_destroy(mpm_grid *grid)

Frees the grid. NULL is fine. MPM_E_STATE while sets or steppers on it live.""",
    "mpm_material_create": """mpm_status mpm_material_create(mpm_context *context, const char *model, const mpm_param *params, int32_t count,
mpm_material **out)

Makes a material from a built-in law. In the table stresses are Cauchy stresses, and J = det F.

| model                   | parameters                              | law                                 |
|-------------------------|-----------------------------------------|-------------------------------------|
| "linear_elastic"        | E, nu, density                          | hypoelastic: with F_inc = V R,      |
|                         |                                         | stress' = R stress R^T + C : ln V   |
| "neo_hookean"           | E, nu, density                          | Steffen et al. 2008, eq. 46         |
| "neo_hookean_decoupled" | mu, kappa, density                      | Guilkey & Weiss 2003, eq. 20        |
| "j2"                    | E, nu, density, yield_stress, hardening | linear_elastic with von Mises yield |
|                         |                                         | and linear isotropic hardening      |
| "newtonian_fluid"       | density, bulk_modulus, gamma,           | p = bulk_modulus / gamma            |
|                         | viscosity, tension                      | (J^-gamma - 1), dynamic viscosity;  |
|                         |                                         | tension 0 cuts off p < 0            |
| "rigid"                 | density                                 | no stress; moves as prescribed      |
| "drucker_prager"        | E, nu, density, phi, psi, cohesion,     | elastic in the logarithmic strain;  |
|                         | cone, tension_cutoff, hardening,        | yields at q = M p + k: sand, gravel |
|                         | cohesion_residual, close_gaps           | and other soils; opens in tension   |
| "mohr_coulomb"          | those of drucker_prager without cone    | the same by the planes of           |
|                         |                                         | Mohr-Coulomb; phi = 0 is Tresca     |
| "herschel_bulkley"      | density, bulk_modulus, gamma,           | p of newtonian_fluid; elastic in    |
|                         | shear_modulus, yield_shear,             | shear up to yield_shear, then flow: |
|                         | consistency, n, tension                 | + consistency (shear rate)^n        |
| "snow"                  | E, nu, density, hardening,              | Stomakhin et al. 2013: elastic      |
|                         | critical_compression, critical_stretch, | stretches within bounds, hardens by |
|                         | hardening_max                           | compaction                          |
| "mu_i"                  | E, nu, density, mu_s, mu_2, I_0,        | Jop et al. 2006: grains that flow   |
|                         | grain_diameter, grain_density           | with friction mu(I); no tension     |
| "cam_clay"              | density, kappa, lambda, M, mu0, alpha,  | modified Cam-clay in the logarithmic|
|                         | p_ref, pc0, p_min                       | strain; needs an initial stress     |

params are count pairs of name and value in any order, which are copied; parameters that are not named take their
defaults. mpm_material_model_param() lists units, defaults and ranges. *out is NULL unless MPM_OK is returned.
MPM_E_NOT_FOUND: there is no such model or parameter. MPM_E_ARG: a value is out of range, a name is given twice,
values do not go together, or a parameter without default is missing.""",
    "mpm_material_model_count": """int32_t mpm_material_model_count()

The number of built-in laws. Any thread, any time.""",
    "mpm_material_model_name": """const char *mpm_material_model_name(int32_t index)

The name of the built-in law with number index, 0 <= index < mpm_material_model_count(), or NULL for another index.
The text is static. Any thread, any time.""",
    "mpm_material_model_param": """mpm_status mpm_material_model_param(const char *model, int32_t index, const char **name, const char **unit, const char
**text, double *value_default, double *low, double *high)

Describes the parameter with number index (from 0) of a built-in law: its name, its unit as a dimension (such as
"stress"), one line of text, its default (NaN if it must be given) and its range [low, high]. Texts are static, and
output pointers may be NULL. MPM_E_NOT_FOUND: there is no such model, or index is past the last parameter. Any thread,
any time.""",
    "mpm_material_state_count": """int32_t mpm_material_state_count(const char *model)

The number of state variables of a particle of a built-in law, or -1 where there is no such model. They are the
components of the field "state". Any thread, any time.""",
    "mpm_material_state_name": """mpm_status mpm_material_state_name(const char *model, int32_t index, const char **name, const char **unit, const char
**text)

Describes the state variable with number index (from 0) of a built-in law: its name, such as "plastic_strain", its
unit as a dimension and one line of text. Texts are static, and output pointers may be NULL. MPM_E_NOT_FOUND: there is
no such model, or index is past the last variable. Any thread, any time.""",
    "mpm_batch_field": """mpm_status mpm_batch_field(const void *lookup, const char *field, const void **data, int64_t *component_stride)

Lends a field of the set that a batch belongs to, built in or the host's own. It is aligned with the batch and valid
during the callback: component c of item i is (*data)[c * *component_stride + i], in elements of the field's type.
Nothing is copied, so tensors have their stored components, as in views. lookup is that of the batch. May be called
from any thread on which a callback runs. MPM_E_NOT_FOUND: there is no such field. MPM_E_STATE: the field is optional,
and the set does not have it now.""",
    "mpm_material_desc_init": """mpm_status mpm_material_desc_init(mpm_material_desc *desc, uint32_t struct_size)

Fills desc with the defaults; the host must set density and stress. struct_size is sizeof(mpm_material_desc) of the
caller; no byte beyond is written. MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.""",
    "mpm_material_create_custom": """mpm_status mpm_material_create_custom(mpm_context *context, const mpm_material_desc *desc, mpm_material **out)

Makes a material from a law of the host. desc is copied. *out is NULL unless MPM_OK is returned. MPM_E_ARG: a value is
bad, or stress is NULL.""",
    "mpm_material_update": """mpm_status mpm_material_update(const mpm_material *material, const mpm_material_batch *batch, double *tangent, int32_t
*symmetric)

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
about. After a failure items before these may have been written.""",
    "mpm_material_destroy": """mpm_status mpm_material_destroy(mpm_material *material)

Frees the material and calls release_user. NULL is fine. MPM_E_STATE while sets of it live.""",
    "mpm_particles_create": """mpm_status mpm_particles_create(mpm_context *context, mpm_grid *grid, mpm_material *material, mpm_particles **out)

Makes an empty set on a grid, of one material; both outlive it. *out is NULL unless MPM_OK is returned. MPM_E_ARG:
grid or material are of another context. MPM_E_UNSUPPORTED: a fluid on an MPM_CPGIMP grid; a fluid, snow, clay or mu_i
on an MPM_PLANE_STRESS grid; a fluid where total_lagrangian = 1.""",
    "mpm_particles_destroy": """mpm_status mpm_particles_destroy(mpm_particles *particles)

Frees the set. NULL is fine. MPM_E_STATE while a stepper holds it or a view of it is out.""",
    "mpm_particles_add": """mpm_status mpm_particles_add(mpm_particles *particles, int64_t n, const double *position, const double *velocity,
const double *volume, const double *size, const int64_t *ids, int64_t *first_id)

Adds n particles with F = I, zero stress and the law's initial state: all or none. The arrays are copied; position,
velocity and size are [dim][n] with ld = n.

- position: a length, inside the grid; on a periodic axis one outside is wrapped, and its images are counted. With
  total_lagrangian = 1 the wrapped place is that in the grid, "reference_position" and "position" alike.
- velocity: length/time; NULL for zeros.
- volume: [n] initial volume, of the undeformed material, > 0; mass = density * volume.
- size: full initial edge lengths of the domain, > 0; NULL for a cube (2-D: square) of that volume. MPM_GIMP and
  MPM_CPGIMP use it; on other grids it is kept as given.
- ids: [n] the host's own ids, >= 0 and unique in the set; NULL to number on from the largest so far. A set holds
  fewer than 2^32 particles.
- first_id: the first of the ids is written to it; may be NULL.

MPM_E_ARG: a value is not finite, a position is outside the grid, a volume or size is <= 0, or an id is negative or in
use.""",
    "mpm_particles_fill_box": """mpm_status mpm_particles_fill_box(mpm_particles *particles, const double *lower, const double *upper, const int32_t
*per_cell, int64_t *first_id, int64_t *count)

Fills the box from lower[dim] to upper[dim] with particles at rest on a lattice aligned with the cells, with
per_cell[dim] particles along each axis of a cell, wherever the centre is inside. Each has the volume and the size of
one lattice cell, so that domains of GIMP fill the body. The ids of the new particles are *first_id to *first_id +
*count - 1; both pointers may be NULL.

What a shape has beyond the grid is left out, on periodic axes too, as symmetry planes want it: *count tells how many
particles there are. That holds for all fills. per_cell is 1 to 64, and a box has at most 2^32 lattice points, in the
shape or not.

MPM_E_ARG: a bound is not finite, lower >= upper on an axis, the box does not meet the grid, or a limit is exceeded.""",
    "mpm_particles_fill_ball": """mpm_status mpm_particles_fill_ball(mpm_particles *particles, const double *centre, double radius, const int32_t
*per_cell, int64_t *first_id, int64_t *count)

Fills a ball (2-D: disc, 1-D: interval) around centre[dim] of a radius > 0, as mpm_particles_fill_box() fills a box.
The centre lies in the grid.""",
    "mpm_particles_fill": """mpm_status mpm_particles_fill(mpm_particles *particles, const double *lower, const double *upper, const int32_t
*per_cell, mpm_inside_fn inside, void *user, int64_t *first_id, int64_t *count)

Fills that part of a box which the callback accepts, as mpm_particles_fill_box() fills the whole.""",
    "mpm_particles_fill_mesh": """mpm_status mpm_particles_fill_mesh(mpm_particles *particles, int64_t n, const double *position, int64_t elements,
const int64_t *corner, const int32_t *per_cell, int64_t *first_id, int64_t *count)

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
is exceeded. MPM_E_UNSUPPORTED: the grid is 1-D. Nothing is then added.""",
    "mpm_particles_remove": """mpm_status mpm_particles_remove(mpm_particles *particles, int64_t n, const int64_t *ids)

Removes the n particles with the given ids: all or none. MPM_E_NOT_FOUND: an id is not in the set. MPM_E_ARG: an id is
given twice.""",
    "mpm_particles_count": """int64_t mpm_particles_count(const mpm_particles *particles)

The number of particles, inert slots not counted; 0 for NULL.""",
    "mpm_particles_field_info": """mpm_status mpm_particles_field_info(const mpm_particles *particles, int32_t index, const char **field, int32_t *type,
int32_t *components, int32_t *writable)

Describes the field with number index (from 0): its name, its type (MPM_F64, MPM_I64 or MPM_U8), the components of
copies, and whether the host may write it. The name belongs to the library and is valid while the set lives; output
pointers may be NULL. MPM_E_NOT_FOUND: index is past the last field.""",
    "mpm_particles_add_field": """mpm_status mpm_particles_add_field(mpm_particles *particles, const char *field, int32_t type, int32_t components)

Adds a field of the host, zero in every particle. It travels with the particles, is saved with them, and reaches
callbacks through mpm_batch_field(). The name has 1 to 47 characters of a-z, 0-9 and _; type is MPM_F64, MPM_I64 or
MPM_U8; components are 1 to 64. A set has at most 64 fields, the 17 of the table included. MPM_E_ARG: the name is bad
or taken, or a value is. MPM_E_STATE: there is no room for one more.""",
    "mpm_particles_set_extensive": """mpm_status mpm_particles_set_extensive(mpm_particles *particles, const char *field, int32_t extensive)

Says of a field of the host that its values are amounts, as mass is, and not densities: particles that are split share
them, and merged ones have the sum. Of other fields they have the same value, and merged ones the mean by initial
volume. The field is of type MPM_F64; values of other types are those of the heavier particle. extensive is 0 (as
added) or 1. MPM_E_NOT_FOUND: there is no such field. MPM_E_ARG: the field is not the host's, or of another type.
MPM_E_STATE: as for all that changes a set.""",
    "mpm_particles_map": """mpm_status mpm_particles_map(mpm_particles *particles, const char *field, int32_t access, mpm_view *view)

Lends a field in library order, with its stored components and with inert slots (id < 0); a map of "id" tells which is
which. access is MPM_READ, MPM_WRITE or both. The caller sets the view's struct_size. Until mpm_view_release() steps
return MPM_E_STATE. Of a set at most 64 views are out at once. A view without MPM_WRITE is for reading: see
mpm_view_release() for what becomes of changes. MPM_E_NOT_FOUND: there is no such field. MPM_E_ARG: MPM_WRITE is asked
for on a field that is not writable. MPM_E_STATE: 64 views are out.""",
    "mpm_particles_get": """mpm_status mpm_particles_get(const mpm_particles *particles, const char *field, int32_t type, int32_t components,
int64_t n, const int64_t *ids, void *out)

Copies a field of n particles into out, [components][n] with ld = n; tensors are full. ids are [n], or NULL for all
particles by ascending id, where n is mpm_particles_count(). type and components must match the full field, to guard
the host's buffer. MPM_E_NOT_FOUND: there is no such field or id. MPM_E_ARG: type, components or n do not match.""",
    "mpm_particles_get_f32": """mpm_status mpm_particles_get_f32(const mpm_particles *particles, int32_t count, const char *const *fields, int32_t
order, int64_t n, float *out)

Copies count named fields of all particles into floats for renderers: particles one after the other, without inert
slots, of each the components of the first field, then those of the second, and so on. Components are those of
mpm_particles_get(), with full tensors and dim components per vector, and out has n times the sum of them.

- order: MPM_BY_ID, or MPM_LIBRARY_ORDER, which is faster: it reads memory from front to back and needs no index of
  the ids. In it a particle may have another place after each step; the field "id" tells them apart.
- n: mpm_particles_count(), to guard the host's buffer.

Values are rounded to the nearest float. Those that no float can hold become infinities with their sign (from about
3.4e38 on), those below the smallest float (1.4e-45) become 0. Integers are exact up to 2^24 = 16777216.

MPM_E_NOT_FOUND: there is no such field. MPM_E_ARG: count is < 1, a field is named twice, or order or n is none of
these. Else as mpm_particles_get(); views may be out. Since 0.2.0.""",
    "mpm_particles_set": """mpm_status mpm_particles_set(mpm_particles *particles, const char *field, int32_t type, int32_t components, int64_t n,
const int64_t *ids, const void *values)

Copies values into a field, laid out as in mpm_particles_get(): all or none. Errors are those of mpm_particles_get(),
and MPM_E_ARG: a value is not finite or gives det F <= 0, a position is outside the grid, or the field is not
writable.""",
    "mpm_particles_set_all": """mpm_status mpm_particles_set_all(mpm_particles *particles, const char *field, int32_t type, int32_t components, const
void *value)

Sets a field to one value[components] in every particle of the set. Errors are those of mpm_particles_set().""",
    "mpm_particles_set_geostatic": """mpm_status mpm_particles_set_geostatic(mpm_particles *particles, int32_t axis, double gravity, double surface, double
K0, double surcharge)

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
MPM_CPGIMP the field "size" what keeps the domains as they are.

The set is unchanged on failure. MPM_E_ARG: a value is bad or not finite, the axis is periodic, a particle lies above
the surface, or no deformation has the stress; the particle is named. MPM_E_UNSUPPORTED: the law is "rigid", or
"snow", whose stress takes more than a deformation; it is "newtonian_fluid" and K0 is not 1; or, of the host's laws,
one that asked with dt = 0 does not answer with the stress that it has; the grid is MPM_PLANE_STRESS, or axis the
radius of MPM_AXISYMMETRIC; total_lagrangian = 1 and the stress follows from deformation_gradient, or the ground has
already deformed. MPM_E_CALLBACK: that law failed. MPM_E_STATE: as for all that changes a set. Since 0.2.0.""",
    "mpm_particles_reset_reference": """mpm_status mpm_particles_reset_reference(mpm_particles *particles)

Makes the present state the one from which all deformation counts: deformation_gradient becomes I, initial_volume the
present volume, dilation_ratio 1, and reference_position, where there is one, the present (unwrapped) position. With
MPM_CPGIMP and of MPM_AXISYMMETRIC edges in "size" become the present ones. Of MPM_PLANE_STRESS F33 stays. Mass,
velocity, Cauchy stress and state variables stay. With total_lagrangian = 1 particles are then in the grid where they
are now, and velocity_gradient is over these positions.

Laws that store Cauchy stress and work with tau = J stress (drucker_prager, mohr_coulomb, mu_i, cam_clay) find J = 1
from then on: elastic strain, energy per initial volume and cohesion count by the present volume, which differ by the
factor J from before; a stress on the yield surface may lie off it by as much, and the next step returns it.

The set is unchanged on failure. MPM_E_ARG: total_lagrangian = 1 and a particle is outside the box. MPM_E_UNSUPPORTED:
the stress of the law, or its mean, follows from deformation_gradient, which must stay; or a law of the host, asked
with dt = 0, does not answer with the stress that it has. MPM_E_CALLBACK: that law failed. MPM_E_STATE: as for all
that changes a set, and with total_lagrangian = 1 while a surface of its stepper has markers, whose places count from
the old reference. Since 0.2.0.""",
    "mpm_operator_get_info": """mpm_status mpm_operator_get_info(const mpm_operator *matrix, mpm_operator_info *info)

Describes the system. This call and the two below may be made from within the solve callback only, one at a time; at
other times they return MPM_E_STATE. It waits for no other part. MPM_E_UNSUPPORTED: there are several parts, and
struct_size is that of a release without number.""",
    "mpm_operator_apply": """mpm_status mpm_operator_apply(const mpm_operator *matrix, const double *x, double *y)

Computes y = matrix * x on owned rows. Both vectors have owned_rows entries and do not overlap.

With several parts it is (collective): x of rows that others own comes from them. It fails on all parts that make it
when one is refused, and with MPM_E_STATE when the solver has returned on a part, so that nobody waits.""",
    "mpm_operator_csr": """mpm_status mpm_operator_csr(const mpm_operator *matrix, const int64_t **row_start, const int32_t **column, const
double **value)

Lends the matrix by compressed rows, with both triangles and with columns in ascending order: row r has the entries
(*row_start)[r] to (*row_start)[r + 1] - 1 of *column and *value. Columns are local ones, and number of
mpm_operator_info has those over all parts; rows that others own are empty. The arrays belong to the library and are
valid until the solve callback returns. It waits for no other part. MPM_E_NOMEM: there is no memory for them.""",
    "mpm_stepper_desc_init": """mpm_status mpm_stepper_desc_init(mpm_stepper_desc *desc, uint32_t struct_size)

Fills desc with the defaults. struct_size is sizeof(mpm_stepper_desc) of the caller; no byte beyond is written.
MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.""",
    "mpm_stepper_create": """mpm_status mpm_stepper_create(mpm_context *context, mpm_grid *grid, const mpm_stepper_desc *desc, mpm_stepper **out)

Makes a stepper at t = 0 and step 0, without sets, with MPM_WALL_NONE on all faces (the axis of MPM_AXISYMMETRIC has
MPM_WALL_SLIP). desc is copied and may be NULL for the defaults. The grid outlives the stepper. *out is NULL unless
MPM_OK is returned. MPM_E_ARG: a value is bad, or the grid is of another context. MPM_E_UNSUPPORTED: the combination
is not offered; the error text says what to use instead.""",
    "mpm_stepper_destroy": """mpm_status mpm_stepper_destroy(mpm_stepper *stepper)

Frees the stepper. Its sets live on and are free for another. NULL is fine. MPM_E_STATE while a view of its nodal
fields is out or a staged step is under way.""",
    "mpm_stepper_add": """mpm_status mpm_stepper_add(mpm_stepper *stepper, mpm_particles *particles)

Adds a set to the time loop. The host keeps owning it, and cannot destroy it while it is in. All sets of a body share
one velocity field; this one comes into body 0. MPM_E_STATE: the set is in a stepper already. MPM_E_ARG: it is on
another grid.""",
    "mpm_stepper_remove": """mpm_status mpm_stepper_remove(mpm_stepper *stepper, mpm_particles *particles)

Takes a set out of the time loop. MPM_E_NOT_FOUND: it is not in this stepper.""",
    "mpm_stepper_configure": """mpm_status mpm_stepper_configure(mpm_stepper *stepper, const mpm_stepper_desc *desc)

Replaces the options between steps. Any field may change, the scheme too; desc is copied. Errors are those of
mpm_stepper_create(), and MPM_E_STATE during a staged step.""",
    "mpm_stepper_set_time": """mpm_status mpm_stepper_set_time(mpm_stepper *stepper, double t, int64_t step)

Sets the time and the number of steps counted. Sums over steps (mpm_stepper_wall_impulse(),
mpm_stepper_particles_impulse(), external_work_total) start anew from 0. MPM_E_ARG: t is not finite, or step < 0.""",
    "mpm_stepper_set_motion": """mpm_status mpm_stepper_set_motion(mpm_stepper *stepper, mpm_particles *particles, mpm_particle_fn mean_velocity, void
*user)

Moves the prescribed particles of a set (platens, pistons). mean_velocity (mt) is called at the start of a step for
the particles of the set, unless none is prescribed, and adds the mean velocity u of the coming step to zeros; what it
gives to other particles is ignored. NULL takes the callback away: the particles keep their velocity.

On its prescribed axes a particle moves by dt u and ends with the velocity u, with every transfer; the nodes to which
it gives mass move with u too, or with the mean of several by that mass. On other axes, and in deformation and stress,
it is a particle like others. MPM_NONFINITE names the particle. A state does not hold the callback: after one has been
loaded that had it, no step is made (MPM_E_STATE) until it has been set, before loading or after, or answered by NULL
after it. MPM_E_NOT_FOUND: the set is not in this stepper.""",
    "mpm_stepper_set_wall": """mpm_status mpm_stepper_set_wall(mpm_stepper *stepper, int32_t face, int32_t kind, double friction)

Sets what a face (MPM_X_MIN to MPM_Z_MAX) does: kind is one of MPM_WALL_NONE to MPM_WALL_FRICTION_NODES. friction is
the Coulomb coefficient, >= 0, of the last two, and is not used otherwise. Such a wall is unilateral: its normal
impulse only pushes, and its tangential impulse is at most friction times that; but for a node that parts and touches
again and again in the iterations of an implicit step, which is then held in it and may be pulled. MPM_E_ARG: the grid
does not have the face, the face is periodic, or a value is bad. MPM_E_UNSUPPORTED: MPM_WALL_FRICTION_NODES with
MPM_NEWMARK; MPM_WALL_OPEN with total_lagrangian = 1; on the axis of MPM_AXISYMMETRIC another kind than MPM_WALL_SLIP.""",
    "mpm_stepper_set_acceleration": """mpm_status mpm_stepper_set_acceleration(mpm_stepper *stepper, mpm_particle_fn fn, void *user)

Sets the callback that adds accelerations of particles, length/time^2 (b of MPoint theory, eq. 21). It is called for
every set. NULL takes it away.""",
    "mpm_stepper_set_force": """mpm_status mpm_stepper_set_force(mpm_stepper *stepper, mpm_particle_fn fn, void *user)

Sets the callback that adds forces on particles, mass length/time^2 (f^app of MPoint theory, eq. 21). It is called for
every set. NULL takes it away.""",
    "mpm_stepper_set_velocity_bc": """mpm_status mpm_stepper_set_velocity_bc(mpm_stepper *stepper, mpm_velocity_fn fn, void *user)

Sets the callback that prescribes nodal velocities, length/time. NULL takes it away.""",
    "mpm_stepper_set_node_hook": """mpm_status mpm_stepper_set_node_hook(mpm_stepper *stepper, int32_t stage, mpm_node_fn fn, void *user)

Sets the hook of a stage, one of MPM_AFTER_P2G to MPM_AFTER_VELOCITY. NULL takes it away. In a step in parts all hooks
run in mpm_step_grid(), after what the host has written itself. MPM_E_ARG: there is no such stage. MPM_E_UNSUPPORTED
with MPM_NEWMARK.""",
    "mpm_stepper_set_linear_solver": """mpm_status mpm_stepper_set_linear_solver(mpm_stepper *stepper, mpm_solve_fn fn, void *user)

Sets the solver of MPM_SOLVER_HOST: see operator.h. NULL takes it away.""",
    "mpm_stepper_set_progress": """mpm_status mpm_stepper_set_progress(mpm_stepper *stepper, mpm_progress_fn fn, void *user)

Sets the progress callback, which runs on the calling thread. NULL takes it away.""",
    "mpm_stable_dt": """mpm_status mpm_stable_dt(mpm_stepper *stepper, double *dt)

Gives the stable dt of an explicit step from the present state, at CFL number 1 (MPoint theory, eqs 45-46): 1 / max
over particles and axes of (|v_k| + c) / h_k, where c is the law's current wave speed, and at most h^2 / (2 dim nu)
where a law reports a kinematic viscosity nu; h is the smallest spacing. Explicit steps want a share of it. It is
infinite where nothing moves and no law has waves. Obstacles that move count by the speed of their fastest point. The
call runs the laws. MPM_E_STATE: there are no particles, or a view is out.""",
    "mpm_step": """mpm_status mpm_step(mpm_stepper *stepper, double dt, mpm_step_info *info)

Makes one step of size dt > 0. After any status but MPM_OK particles and time are bit-identical to before. info may be
NULL; it is filled on success and on failure.

- MPM_CUT_DT, MPM_INVERTED, MPM_NONFINITE, MPM_NOT_CONVERGED, MPM_SINGULAR: a smaller dt may do.
- MPM_OFF_GRID: a particle would leave through a face that does not let it. In implicit steps a smaller dt may do here
  as well.
- MPM_CANCELLED: the progress callback ended the step.
- MPM_E_ARG: dt is not finite or not > 0.
- MPM_E_CALLBACK: a callback or the host's executor failed.
- MPM_E_STATE: a view is out, a staged step is under way, a set has values to be repaired, or the state that was
  loaded had a motion callback that is not set.""",
    "mpm_advance_desc_init": """mpm_status mpm_advance_desc_init(mpm_advance_desc *desc, uint32_t struct_size)

Fills desc with the defaults; the host must set t_end. struct_size is sizeof(mpm_advance_desc) of the caller; no byte
beyond is written. MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.""",
    "mpm_advance": """mpm_status mpm_advance(mpm_stepper *stepper, const mpm_advance_desc *desc, mpm_step_info *info)

Steps to t_end exactly. Statuses 1..5 cut dt to 0.6 of it and try again, and success lets it grow; the controller's dt
is part of the saved state. In implicit steps MPM_OFF_GRID cuts as well, but no more than 20 times before the time
comes to where one of these steps would have ended: a body that moves out by itself does so in steps of any length. On
failure the state is that of the last committed sub-step, and the status is the cause. After max_cuts cuts in a row
(60: dt is 5e-14 of what it was), or where another would go below dt_min or no longer move the time, the call gives
up, and mpm_last_error() says so and why the last try failed; the next call begins with the dt of before the cuts.
info may be NULL; it is that of the last sub-step tried. The call returns MPM_OK with t < t_end when max_steps ran
out. Errors are those of mpm_step(); MPM_E_ARG: t_end is before the present time, or a value is bad.""",
    "mpm_stepper_profile": """mpm_status mpm_stepper_profile(mpm_stepper *stepper, int32_t reset, mpm_profile *out)

Copies the times into out, then sets them to zero if reset is not 0. They cost the steps one clock read per stage.""",
    "mpm_stepper_info": """mpm_status mpm_stepper_info(const mpm_stepper *stepper, mpm_step_info *info)

Gives the info of the state as it is, also before the first step. What belongs to a step is that of the last one.
MPM_E_STATE while a set is mapped for writing.""",
    "mpm_stepper_residuals": """mpm_status mpm_stepper_residuals(const mpm_stepper *stepper, int32_t capacity, double *residual, int32_t *count)

Gives the history of the last implicit step: ||residual|| / scale (the scale includes reactions) from before the first
solve to the converged or failed end. *count tells how many values there are; the first capacity of them are copied
into residual, which may be NULL when capacity is 0. The history is kept until the next step; *count is 0 after
explicit ones.""",
    "mpm_step_begin": """mpm_status mpm_step_begin(mpm_stepper *stepper, double dt)

Makes the first part of an explicit step in parts: particles to grid, and forces. With MPM_USF strain and stress of
the step come before them, for which the callbacks of prescribed velocities are asked here. Until mpm_step_end() or
mpm_step_abort() the host may map nodal fields between the parts, and change "velocity" and "force". Errors are those
of mpm_step(), and MPM_E_UNSUPPORTED with MPM_NEWMARK. A part that fails with any status but MPM_E_STATE or MPM_E_ARG
aborts the step.""",
    "mpm_step_grid": """mpm_status mpm_step_grid(mpm_stepper *stepper)

Makes the second part: nodal velocities, walls, prescribed velocities. MPM_E_STATE unless it follows mpm_step_begin().""",
    "mpm_step_end": """mpm_status mpm_step_end(mpm_stepper *stepper, mpm_step_info *info)

Makes the last part: grid to particles, stress, commit. info may be NULL. MPM_E_STATE unless it follows
mpm_step_grid(). The three parts in a row give the same bits as mpm_step(), except with MPM_APIC_MLS, where a whole
step fuses force and momentum: there they agree to rounding.""",
    "mpm_step_abort": """mpm_status mpm_step_abort(mpm_stepper *stepper)

Drops the step that was begun; particles and time are as before it. MPM_E_STATE: none was begun, or a view of nodal
fields is out.""",
    "mpm_grid_map": """mpm_status mpm_grid_map(mpm_stepper *stepper, int32_t body, const char *field, int32_t access, mpm_view *view)

Lends a field of the active nodes: of a staged step while one is under way, of the last step otherwise. The view's
struct_size is set by the caller. Until mpm_view_release() steps and their parts return MPM_E_STATE. Periodic images
and mirrored ghosts are listed beside the nodes that they follow.

| field                              | type | components | what it is                                    |
|------------------------------------|------|------------|-----------------------------------------------|
| "index"                            | I64  | dim        | as in mpm_node_batch                          |
| "mass"                             | F64  | 1          | nodal mass                                    |
| "position" "velocity"              | F64  | dim        | length, length/time                           |
| "force" "acceleration"             | F64  | dim        | internal and external force; length/time^2    |
| "reaction"                         | F64  | dim        | force of walls and prescribed velocities      |
| "contact_force"                    | F64  | dim        | force of other bodies and of obstacles        |
| "contact_normal"                   | F64  | dim        | unit, away from the body, where it meets them |
| "contact_gap" "contact_area"       | F64  | 1          | length, infinite where it meets nothing       |
| "temperature"                      | F64  | 1          | at the end of the step, where sets have heat  |
| "owned"                            | U8   | 1          | as in mpm_node_batch                          |

- body: velocity field, of which there is one for each body (mpm_stepper_set_body()).
- MPM_E_STATE: nothing has been stepped yet, or MPM_WRITE is asked for outside a staged step.
- MPM_E_NOT_FOUND: there is no such field or body.
- MPM_E_ARG: MPM_WRITE is asked for on a field other than "velocity" and "force".
- MPM_E_UNSUPPORTED: "force" or "acceleration" after a whole step of MPM_APIC_MLS, which does not keep them; a staged
  step and MPM_APIC do.""",
    "mpm_stepper_wall_reaction": """mpm_status mpm_stepper_wall_reaction(const mpm_stepper *stepper, int32_t face, double *force)

Gives the force[dim] that the wall at a face exerts on the material: the mean over the last step, or with MPM_NEWMARK
the one at its end, but for friction walls. MPM_E_ARG: there is no such face. MPM_E_STATE before the first step.""",
    "mpm_stepper_particles_reaction": """mpm_status mpm_stepper_particles_reaction(const mpm_stepper *stepper, const mpm_particles *prescribed, double *force)

Gives the force[dim] that the prescribed particles of a set exert on the material, on the axes on which they are
prescribed: the mean over the last step, or with MPM_NEWMARK the one at its end. It is what holds them, less their own
inertia, weight and external forces; 0 for a set without such particles. What a body of its own gives others through
contact is not in it: mpm_stepper_contact_info() has that. MPM_E_NOT_FOUND: the set is not in this stepper.
MPM_E_STATE before the first step.""",
    "mpm_stepper_wall_impulse": """mpm_status mpm_stepper_wall_impulse(const mpm_stepper *stepper, int32_t face, double *impulse)

Gives the impulse[dim] of the wall at a face on the material, mass * length/time: the sum of
mpm_stepper_wall_reaction() times the time over which it acted, over all committed steps since the stepper was made or
mpm_stepper_set_time() was called; 0 before the first. A host that uses mpm_advance() measures forces by it: the
difference of two calls over the time between them is the mean force. With MPM_NEWMARK a step adds dt times the force
at its end, and with `staggered` the mean of two dt times its force. Steps that fail add nothing, and a saved state
holds it. MPM_E_ARG: there is no such face.""",
    "mpm_stepper_particles_impulse": """mpm_status mpm_stepper_particles_impulse(const mpm_stepper *stepper, const mpm_particles *prescribed, double *impulse)

Gives the impulse[dim] of the prescribed particles of a set on the material, the sum of
mpm_stepper_particles_reaction() in the same way. It is 0 when a set is added, and forgotten when it is removed.
MPM_E_NOT_FOUND: the set is not in this stepper.""",
    "mpm_stepper_set_body": """mpm_status mpm_stepper_set_body(mpm_stepper *stepper, mpm_particles *particles, int32_t body)

Puts a set into a body: 0 <= body < 4096, at first 0. Between steps, also with particles in it. Sets of one body share
one velocity field. MPM_E_NOT_FOUND: the set is not in this stepper. MPM_E_ARG: there is no such body.
MPM_E_UNSUPPORTED: with MPM_NEWMARK, bodies that touch with adhesion, or by MPM_SOLVER_MULTIGRID_CG; with
total_lagrangian = 1 another body than 0, because bodies touch at nodes that both have. MPM_E_STATE during a staged
step, or while a view of nodal fields is out; there are no nodal fields then until the next step.""",
    "mpm_stepper_body": """mpm_status mpm_stepper_body(const mpm_stepper *stepper, const mpm_particles *particles, int32_t *body)

Gives the body of a set. MPM_E_NOT_FOUND: it is not in this stepper.""",
    "mpm_contact_desc_init": """mpm_status mpm_contact_desc_init(mpm_contact_desc *desc, uint32_t struct_size)

Fills desc with the defaults. struct_size is sizeof(mpm_contact_desc) of the caller; no byte beyond is written.
MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.""",
    "mpm_stepper_set_contact": """mpm_status mpm_stepper_set_contact(mpm_stepper *stepper, int32_t body_a, int32_t body_b, const mpm_contact_desc *desc)

Sets how two bodies meet; desc is copied. The order of the bodies matters for `direction` alone. With MPM_BODY_ANY for
one body: how the other meets those that have no rule of their own with it; for both: how all meet that have no closer
rule. Of the rules of two bodies each with MPM_BODY_ANY, that of the lower number counts. A later call replaces an
earlier one for the same pair; NULL takes the rule back. Without any rule the defaults of mpm_contact_desc_init()
hold. A saved state holds the rules. MPM_E_ARG: a value is bad. MPM_E_UNSUPPORTED: adhesion with detection by
velocity; with MPM_NEWMARK, adhesion, or MPM_SOLVER_MULTIGRID_CG, of bodies that there are. MPM_E_STATE during a
staged step.""",
    "mpm_stepper_set_friction": """mpm_status mpm_stepper_set_friction(mpm_stepper *stepper, mpm_friction_fn fn, void *user)

Sets the callback for coefficients of friction. NULL takes it away. The host sets it again after it has loaded a state
into another stepper. MPM_E_UNSUPPORTED with MPM_NEWMARK.""",
    "mpm_stepper_contact_info": """mpm_status mpm_stepper_contact_info(const mpm_stepper *stepper, int32_t body_a, int32_t body_b, mpm_contact_info
*info)

Gives what two bodies did in the last step; for body_a MPM_BODY_ANY the sum over all others, on body_b; the other way
round what they suffered. Bodies that never were near each other have zeros, and an infinite gap. MPM_E_ARG: the
bodies are the same or there is no such body. MPM_E_STATE before the first step.""",
    "mpm_obstacle_desc_init": """mpm_status mpm_obstacle_desc_init(mpm_obstacle_desc *desc, uint32_t struct_size)

Fills desc with the defaults. struct_size is sizeof(mpm_obstacle_desc) of the caller; no byte beyond is written.
MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.""",
    "mpm_obstacle_create": """mpm_status mpm_obstacle_create(mpm_context *context, const mpm_obstacle_desc *desc, mpm_obstacle **out)

Makes an obstacle. The desc is copied. *out becomes NULL on failure. MPM_E_ARG: a value is bad. MPM_E_UNSUPPORTED:
velocities of a fixed one, bounds of one that the material is inside of.""",
    "mpm_obstacle_destroy": """mpm_status mpm_obstacle_destroy(mpm_obstacle *obstacle)

Frees an obstacle; NULL is let pass. MPM_E_STATE: a stepper holds it.""",
    "mpm_stepper_add_obstacle": """mpm_status mpm_stepper_add_obstacle(mpm_stepper *stepper, mpm_obstacle *obstacle)

Puts an obstacle into a stepper, with those that are there in the order of adding. MPM_E_STATE: it is in a stepper
already, or a step is under way. MPM_E_UNSUPPORTED: the shape does not exist in the dimension of the grid; it is free,
and the grid MPM_AXISYMMETRIC or the scheme MPM_NEWMARK, which refuses the adhesion of an obstacle in the step.
MPM_E_ARG: it is turned out of a 2-D or 1-D grid, or moves out of it.""",
    "mpm_stepper_remove_obstacle": """mpm_status mpm_stepper_remove_obstacle(mpm_stepper *stepper, mpm_obstacle *obstacle)

Takes an obstacle out, and what it has reported. MPM_E_NOT_FOUND: it is not in this stepper.""",
    "mpm_obstacle_set_motion": """mpm_status mpm_obstacle_set_motion(mpm_obstacle *obstacle, mpm_motion_fn fn, void *user)

Sets how an obstacle moves in each step, for MPM_MOTION_PRESCRIBED (MPM_E_UNSUPPORTED with others). NULL: it keeps its
velocities. A state does not hold it: after one has been loaded that had it, no step is made (MPM_E_STATE) until it
has been set, before loading or after, or answered by NULL after it. MPM_E_STATE during a staged step.""",
    "mpm_obstacle_set_contact": """mpm_status mpm_obstacle_set_contact(mpm_obstacle *obstacle, const mpm_contact_desc *contact)

Sets how an obstacle meets the material, as mpm_obstacle_desc.contact does. MPM_E_ARG: a value is bad; nothing is
changed. MPM_E_STATE during a staged step.""",
    "mpm_obstacle_set_pose": """mpm_status mpm_obstacle_set_pose(mpm_obstacle *obstacle, const double *position, const double *orientation, const
double *velocity, const double *angular_velocity)

Puts an obstacle somewhere: position[3], orientation[4], velocity[3] and angular_velocity[3] as in mpm_obstacle_desc,
each NULL to keep it. MPM_E_ARG: a value is bad; nothing is changed. MPM_E_UNSUPPORTED: a velocity other than 0 of a
fixed one. MPM_E_STATE during a staged step.""",
    "mpm_obstacle_get_pose": """mpm_status mpm_obstacle_get_pose(const mpm_obstacle *obstacle, double *position, double *orientation, double
*velocity, double *angular_velocity)

Gives where an obstacle is and how it moves; each may be NULL.""",
    "mpm_obstacle_set_load": """mpm_status mpm_obstacle_set_load(mpm_obstacle *obstacle, const double *force, const double *torque)

Sets the force[3] and the torque[3] about its centre that act on a free obstacle beside gravity and contact, until
they are set anew; each NULL to keep it. MPM_E_UNSUPPORTED: it is not free. MPM_E_STATE during a staged step.""",
    "mpm_obstacle_contact_info": """mpm_status mpm_obstacle_contact_info(const mpm_obstacle *obstacle, int32_t body, mpm_contact_info *info)

Gives what a body and an obstacle did to each other in the last step; body MPM_BODY_ANY: all of them. force and
impulse are on the material, -force is on the obstacle; torque is that on the obstacle, about its centre; nodes are
those that could be constrained. MPM_E_STATE: it is in no stepper, or that has made no step yet.""",
    "mpm_surface_desc_init": """mpm_status mpm_surface_desc_init(mpm_surface_desc *desc, uint32_t struct_size)

Fills desc with the defaults. struct_size is sizeof(mpm_surface_desc) of the caller; no byte beyond is written.
MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.""",
    "mpm_surface_create": """mpm_status mpm_surface_create(mpm_context *context, mpm_grid *grid, const mpm_surface_desc *desc, mpm_surface **out)

Makes a surface without markers on a grid, which outlives it. desc is copied and may be NULL for the defaults. *out is
NULL unless MPM_OK is returned. MPM_E_ARG: a value is bad, or the grid is of another context.""",
    "mpm_surface_destroy": """mpm_status mpm_surface_destroy(mpm_surface *surface)

Frees a surface; NULL is let pass. MPM_E_STATE: a stepper holds it.""",
    "mpm_surface_configure": """mpm_status mpm_surface_configure(mpm_surface *surface, const mpm_surface_desc *desc)

Replaces loads and options between steps. Errors are those of mpm_surface_create(), and MPM_E_STATE during a staged
step.""",
    "mpm_surface_set_traction": """mpm_status mpm_surface_set_traction(mpm_surface *surface, mpm_traction_fn fn, void *user)

Sets the callback that adds tractions. NULL takes it away. The host sets it again after it has loaded a state.
MPM_E_STATE during a staged step.""",
    "mpm_surface_set_velocity": """mpm_status mpm_surface_set_velocity(mpm_surface *surface, mpm_marker_velocity_fn fn, void *user)

Sets the callback that adds to the velocities with which a surface that prescribes moves. NULL takes it away. The host
sets it again after it has loaded a state. MPM_E_STATE during a staged step.""",
    "mpm_surface_add": """mpm_status mpm_surface_add(mpm_surface *surface, int64_t n, const double *position, const double *area, int64_t
*first_id)

Adds n markers.

- position: [dim][n], in the grid; on periodic axes it is wrapped.
- area: [dim][n] area vectors, out of the material; NULL for markers without area, which follow the material and carry
  nothing.
- first_id: ids go up by one from the largest so far; the first is written to it. May be NULL.

In 3-D a marker counts as a square when it is split. MPM_E_ARG: a value is not finite, a position is outside the grid,
the surface would have more than 2^28 markers, or the edge of a ring, which is its area over its radius, would reach
beyond the axis; nothing is added. MPM_E_STATE during a staged step.""",
    "mpm_surface_add_polyline": """mpm_status mpm_surface_add_polyline(mpm_surface *surface, int64_t n, const double *position, int32_t closed, double
spacing, int64_t *first_id, int64_t *count)

Adds markers along the line through n points, position[2][n]; closed 1: back to the first. The material lies on the
left of the line, so that the outline of a body goes round counter-clockwise. Each edge is divided into equal parts no
longer than spacing > 0, with a marker in the middle of each: half a spacing of the grid is right. *first_id and
*count, which may be NULL, tell of the markers. MPM_E_UNSUPPORTED: the grid is not 2-D. MPM_E_ARG: a closed line has
one or two points, and so no inside. Else as mpm_surface_add().""",
    "mpm_surface_add_triangles": """mpm_status mpm_surface_add_triangles(mpm_surface *surface, int64_t n, const double *position, int64_t triangles, const
int64_t *corner, double spacing, int64_t *first_id, int64_t *count)

Adds markers on triangles: position[3][n] of their corners, and corner[3 * i], corner[3 * i + 1], corner[3 * i + 2]
the numbers of those of triangle i, counter-clockwise as seen from outside the material. Each triangle is divided into
k^2 equal ones with edges no longer than spacing, with a marker in the middle of each. MPM_E_UNSUPPORTED: the grid is
not 3-D. MPM_E_ARG: there is no such corner. Else as mpm_surface_add_polyline().""",
    "mpm_surface_remove": """mpm_status mpm_surface_remove(mpm_surface *surface, int64_t n, const int64_t *ids)

Removes the n markers with the given ids: all or none. MPM_E_NOT_FOUND: an id is not in the surface. MPM_E_ARG: an id
is given twice. MPM_E_STATE during a staged step.""",
    "mpm_surface_refine": """mpm_status mpm_surface_refine(mpm_surface *surface, double spacing, int64_t *added)

Splits markers until no edge is longer than spacing > 0: total area, its moment and the loads are kept, but for the
moment where a half would lie beyond a face of the grid: it is put onto the face. One half keeps the id, the other
gets a new one. *added, which may be NULL, tells how many came. MPM_E_ARG: spacing is bad, or more than 2^28 markers
would come of it. MPM_E_STATE during a staged step.""",
    "mpm_surface_count": """int64_t mpm_surface_count(const mpm_surface *surface)

The number of markers; 0 for NULL.""",
    "mpm_surface_get": """mpm_status mpm_surface_get(const mpm_surface *surface, const char *field, int32_t type, int32_t components, int64_t n,
const int64_t *ids, void *out)

Copies a field of n markers into out, [components][n]. ids are [n], or NULL for all markers by ascending id, where n
is mpm_surface_count(). type and components must match the field.

| field             | type | components | what it is                                              | set |
|-------------------|------|------------|---------------------------------------------------------|-----|
| "id"              | I64  | 1          |                                                         |     |
| "position"        | F64  | dim        | length                                                  | yes |
| "area"            | F64  | dim        | area vector, out of the material                        | yes |
| "reference_area"  | F64  | 1          | area when it was added or set                           |     |
| "displacement"    | F64  | dim        | since it was added, across periodic axes too            | yes |
| "velocity"        | F64  | dim        | of the material there, in the last step                 |     |
| "force"           | F64  | dim        | on the material, in the last step                       |     |
| "pressure"        | F64  | 1          | of this marker, beside mpm_surface_desc.pressure        | yes |
| "traction"        | F64  | dim        | likewise                                                | yes |
| "dead_traction"   | F64  | dim        | likewise                                                | yes |
| "prescribed_velocity" | F64 | dim     | of this marker, beside mpm_surface_desc.velocity        | yes |
| "reaction"        | F64  | dim        | force of what is prescribed on the material, last step  |     |
| "gap"             | F64  | dim        | implicit steps: way of the material off what it should  |     |

MPM_E_NOT_FOUND: there is no such field or id. MPM_E_ARG: type, components or n do not match.""",
    "mpm_surface_set": """mpm_status mpm_surface_set(mpm_surface *surface, const char *field, int32_t type, int32_t components, int64_t n, const
int64_t *ids, const void *values)

Copies values into a field, laid out as in mpm_surface_get(): all or none. Setting "area" makes it the reference.
Errors are those of mpm_surface_get(), and MPM_E_ARG: a value is not finite, a position is outside the grid, or the
field cannot be set. MPM_E_STATE during a staged step. MPM_E_UNSUPPORTED: "position" or "area" with total_lagrangian =
1, whose weights keep to the markers that were added: add others.""",
    "mpm_stepper_add_surface": """mpm_status mpm_stepper_add_surface(mpm_stepper *stepper, mpm_surface *surface)

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
loads of markers that prescribe, keep it symmetric.""",
    "mpm_stepper_remove_surface": """mpm_status mpm_stepper_remove_surface(mpm_stepper *stepper, mpm_surface *surface)

Takes a surface out; it keeps its markers. MPM_E_NOT_FOUND: it is not in this stepper.""",
    "mpm_stepper_surface_reaction": """mpm_status mpm_stepper_surface_reaction(const mpm_stepper *stepper, const mpm_surface *surface, double *force)

Gives the force[dim] by which what a surface prescribes acts on the material: the mean over the last step, the sum of
"reaction" over the markers; 0 for a surface that prescribes nothing. Loads are no part of it. MPM_E_NOT_FOUND: it is
not in this stepper. MPM_E_STATE before the first step.""",
    "mpm_stepper_surface_impulse": """mpm_status mpm_stepper_surface_impulse(const mpm_stepper *stepper, const mpm_surface *surface, double *impulse)

Gives the impulse[dim] of it on the material, mass * length/time: the sum of mpm_stepper_surface_reaction() times the
time over which it acted, over all committed steps since the surface was added or mpm_stepper_set_time() was called. A
saved state holds it. MPM_E_NOT_FOUND: the surface is not in this stepper.""",
    "mpm_adaption_desc_init": """mpm_status mpm_adaption_desc_init(mpm_adaption_desc *desc, uint32_t struct_size)

Fills desc with the defaults. struct_size is sizeof(mpm_adaption_desc) of the caller; no byte beyond is written.
MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.""",
    "mpm_stepper_set_adaption": """mpm_status mpm_stepper_set_adaption(mpm_stepper *stepper, mpm_particles *particles, const mpm_adaption_desc *desc)

Describes how a set of the stepper adapts, for the steps that follow; NULL: no longer. The set then keeps the field
"size". Not part of a saved state: the host sets it again. MPM_E_NOT_FOUND: the set is not in the stepper. MPM_E_ARG:
a value is bad or particles is NULL; an edge could be split that would be shorter than least_edge (split_edge < 2
least_edge), or max_per_cell < 2 min_per_cell. MPM_E_UNSUPPORTED: total_lagrangian = 1, where material does not come
apart, or the law is "rigid". MPM_E_STATE: a step is under way, or a view of the set is out.""",
    "mpm_stepper_adapt": """mpm_status mpm_stepper_adapt(mpm_stepper *stepper)

Adapts all sets that are described, now and whatever `every` is. Sets are unchanged on failure. MPM_E_CALLBACK,
MPM_CUT_DT: accept returned an error. MPM_E_STATE: a step is under way, a view of a set is out, or a value that was
written through one is bad.""",
    "mpm_stepper_adaption_info": """mpm_status mpm_stepper_adaption_info(const mpm_stepper *stepper, const mpm_particles *particles, mpm_adaption_info
*info)

Tells what adaption has done to a set. MPM_E_NOT_FOUND: it is not in the stepper. MPM_E_ARG: particles or info is
NULL.""",
    "mpm_heat_desc_init": """mpm_status mpm_heat_desc_init(mpm_heat_desc *desc, uint32_t struct_size)

Fills desc with the defaults. struct_size is sizeof(mpm_heat_desc) of the caller; no byte beyond is written.
MPM_E_ARG: it is smaller than the first released struct. Any thread, any time.""",
    "mpm_stepper_set_heat": """mpm_status mpm_stepper_set_heat(mpm_stepper *stepper, mpm_particles *particles, const mpm_heat_desc *desc)

Describes the heat of a set of the stepper, for the steps that follow; NULL: it has none any more, and its fields stay
as fields of the host. Not part of a saved state, but the fields are: the host describes before it loads.
MPM_E_NOT_FOUND: the set is not in the stepper. MPM_E_ARG: particles is NULL, a value is bad, or the set has a field
"temperature" or "stress_temperature" of another type or with more components. MPM_E_UNSUPPORTED: expansion is not 0
on MPM_PLANE_STRESS or with the law "rigid"; dissipated_share is not 0 with "rigid" or a law of the host. MPM_E_STATE:
a step is under way, a view of the set is out, or the set has no room for another field.""",
    "mpm_stepper_set_conduction": """mpm_status mpm_stepper_set_conduction(mpm_stepper *stepper, int32_t conduction, double tolerance)

Chooses how the nodes conduct, from MPM_CONDUCTION_EXPLICIT (as made) on. tolerance: of the residual of conjugate
gradients, relative to the right-hand side; > 0 and < 1; not read with explicit conduction. MPM_E_ARG: a value is bad.
MPM_E_STATE: a step is under way.""",
    "mpm_stepper_set_heat_wall": """mpm_status mpm_stepper_set_heat_wall(mpm_stepper *stepper, int32_t face, int32_t kind, double temperature)

Says what a face does to heat, whatever kind of wall it has. kind: MPM_HEAT_WALL_...; the temperature is not read of
insulated ones, which all faces are from the start. Call it again where the temperature changes: that change, at first
from what the material there has, reaches the particles in the next step; material that comes to the face later is
heated by conduction alone. Where two such faces meet, that of the lower axis prescribes the edge. Not part of a saved
state. MPM_E_ARG: a value is bad, or the axis is periodic. MPM_E_UNSUPPORTED: the face is the axis of
MPM_AXISYMMETRIC, through which nothing flows. MPM_E_STATE: a step is under way.""",
    "mpm_surface_set_heat": """mpm_status mpm_surface_set_heat(mpm_surface *surface, double flux, double film, double ambient)

Heats what lies below a surface, per area of its markers: flux + film (ambient - temperature of the material),
power/area into the material; film is >= 0. All 0 (as made): no heat. Not part of a saved state. MPM_E_ARG: a value is
bad. MPM_E_STATE: a step is under way.""",
    "mpm_stepper_heat_info": """mpm_status mpm_stepper_heat_info(const mpm_stepper *stepper, mpm_heat_info *info)

Tells where heat came from. MPM_E_ARG: info is NULL. MPM_E_STATE: a step is under way, or no set was ever described.""",
    "mpm_state_size": """mpm_status mpm_state_size(const mpm_stepper *stepper, int64_t *bytes)

Tells how many bytes mpm_state_save() needs now; of several parts, those of this part's piece (collective).""",
    "mpm_state_save": """mpm_status mpm_state_save(const mpm_stepper *stepper, void *buffer, int64_t capacity)

Writes the state into the host's buffer of capacity bytes; of several parts, this part's piece (collective).
MPM_E_ARG: the capacity is too small. MPM_E_STATE: a view is out for writing, or a staged step is under way.""",
    "mpm_state_load": """mpm_status mpm_state_load(mpm_stepper *stepper, const void *buffer, int64_t bytes)

Replaces the state by one saved with mpm_state_save(), of so many bytes; the buffer is read during the call.
MPM_E_FORMAT: the bytes are no state, or it is damaged, of a later format, or saved from an unlike setup; the error
text names the first difference; or they are one piece of several. MPM_E_STATE: a view is out, or a staged step is
under way. MPM_E_UNSUPPORTED: the context is one of several parts, which load by mpm_state_load_pieces().""",
    "mpm_state_load_pieces": """mpm_status mpm_state_load_pieces(mpm_stepper *stepper, int32_t count, const void *const *piece, const int64_t *bytes)

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

Since 0.2.0.""",
    "mpm_state_save_file": """mpm_status mpm_state_save_file(const mpm_stepper *stepper, const char *path)

Writes the state into a file, as mpm_state_save() does into memory, and waits for the storage: path holds the old
state or the new one. Of several parts, each writes its piece under a path of its own (collective); where one of them
could not, others may have replaced their files. MPM_E_IO: the file could not be written.""",
    "mpm_state_save_to": """mpm_status mpm_state_save_to(const mpm_stepper *stepper, mpm_write_fn write, void *user)

Gives the bytes of mpm_state_save() to a callback. They are made twice, because the first of them hold a checksum of
all others; memory for 65536 bytes is enough. Of several parts, each gives its piece (collective). MPM_E_CALLBACK: the
callback refused. MPM_E_STATE: as in mpm_state_save(); or what was written through a view for reading changed the
state while it went out. Since 0.2.0.""",
    "mpm_state_load_file": """mpm_status mpm_state_load_file(mpm_stepper *stepper, const char *path)

Replaces the state by one from a file. Errors are those of mpm_state_load(), and MPM_E_IO: the file could not be read.""",
    "mpm_state_hash": """mpm_status mpm_state_hash(const mpm_stepper *stepper, uint64_t *hash)

Gives a hash of time, step, every field of every set, the pose of every obstacle and every marker of surfaces. It does
not depend on library order, on threads or on optional fields that are not in use: states that are equal by id have
equal hashes.""",
    "mpm_write_particles": """mpm_status mpm_write_particles(const mpm_particles *particles, const char *path, int32_t count, const char *const
*fields)

Writes a set as VTK poly data (.vtp, appended raw): points in order of ascending id, and count named fields as point
data, with full tensors and, in 2-D and 3-D, with three components per vector. With count 0, when fields may be NULL,
it writes every field in use but "position", which the points are. path is UTF-8. MPM_E_NOT_FOUND: there is no such
field. MPM_E_ARG: a field is named twice. MPM_E_IO: the file could not be written.""",
    "mpm_write_particles_to": """mpm_status mpm_write_particles_to(const mpm_particles *particles, mpm_write_fn write, void *user, int32_t count, const
char *const *fields)

Gives the bytes of the file that mpm_write_particles() would write to a callback, with memory for one piece. Errors
are the same, but for the path, and with MPM_E_CALLBACK, when the callback refused, in the place of MPM_E_IO. Since
0.2.0.""",
    "mpm_write_grid": """mpm_status mpm_write_grid(mpm_stepper *stepper, const char *path, int32_t count, const char *const *fields)

Writes nodal fields of the last step, or of a staged step while one is under way, over the box of the active nodes: as
VTK image data (.vti, appended raw), or with open knots, whose nodes are not evenly spaced at the faces, as a
rectilinear grid (.vtr). Fields are named as in mpm_grid_map(); vectors have three components in 2-D and 3-D. Extents
are indices of nodes; where no node is active values are zero. With count 0, when fields may be NULL, it writes every
field that the step has kept but "position", which is that of the points, and "owned". Memory follows the active
nodes; long runs of zeros take no room on storage that knows holes.

- MPM_E_NOT_FOUND: there is no such field, or no set is in body 0.
- MPM_E_STATE: nothing has been stepped yet.
- MPM_E_UNSUPPORTED: as in mpm_grid_map().
- MPM_E_ARG: a field is named twice, the path ends with the other kind's suffix, or the box has more nodes than a file
  can hold.
- MPM_E_IO: the file could not be written.""",
    "mpm_write_body_grid": """mpm_status mpm_write_body_grid(mpm_stepper *stepper, int32_t body, const char *path, int32_t count, const char *const
*fields)

Does as mpm_write_grid() for the nodes of one body; that one writes those of body 0. MPM_E_NOT_FOUND: no set of the
stepper is in the body.""",
    "mpm_write_grid_to": """mpm_status mpm_write_grid_to(mpm_stepper *stepper, int32_t body, mpm_write_fn write, void *user, int32_t count, const
char *const *fields)

Gives the bytes of the file that mpm_write_body_grid() would write to a callback. They are those of a .vtr file if the
grid has boundary_basis = MPM_BOUNDARY_OPEN_KNOT and an axis that is not periodic, else those of a .vti file; the
second line names the kind, RectilinearGrid or ImageData. Zeros between bodies far apart are all given, however many
they are. Memory follows the active nodes, and one piece is added. Errors are the same, but for the path, and with
MPM_E_CALLBACK, when the callback refused, in the place of MPM_E_IO. Since 0.2.0.""",
    "mpm_series_open": """mpm_status mpm_series_open(mpm_context *context, const char *path, mpm_series **out)

Starts a series in a new file at path, where it replaces an old one. *out is NULL unless MPM_OK is returned. MPM_E_IO:
the file could not be written.""",
    "mpm_series_append": """mpm_status mpm_series_append(mpm_series *series, double t, const char *file)

Appends an output file to the series at time t. file is its path as it is to stand in the series: relative to the
series' own file. MPM_E_IO: the file could not be written.""",
    "mpm_series_close": """mpm_status mpm_series_close(mpm_series *series)

Ends the series and frees it. Its file stays. NULL is fine.""",
}
