// Generated from the headers of libmpm by `make api`; not to be edited.
using System;
using System.Runtime.InteropServices;

namespace Mpm {
  /// <summary>All constants of the headers: `using static Mpm.Constants;` makes them known by their names.</summary>
  public static class Constants {
    // Status values.
    /// <summary>the call did what it was asked to.</summary>
    public const int MPM_OK = 0;
    /// <summary>a callback, a law or contact asked for a smaller step.</summary>
    public const int MPM_CUT_DT = 1;
    /// <summary>det F &lt;= 0 at a particle.</summary>
    public const int MPM_INVERTED = 2;
    /// <summary>a NaN or an infinity appeared.</summary>
    public const int MPM_NONFINITE = 3;
    /// <summary>the Newton iteration did not converge.</summary>
    public const int MPM_NOT_CONVERGED = 4;
    /// <summary>the linear system is singular, or indefinite beyond repair.</summary>
    public const int MPM_SINGULAR = 5;
    /// <summary>a particle would leave through a face that does not let it.</summary>
    public const int MPM_OFF_GRID = 6;
    /// <summary>the progress callback ended the call.</summary>
    public const int MPM_CANCELLED = 7;
    /// <summary>an argument is NULL, out of range or inconsistent.</summary>
    public const int MPM_E_ARG = -1;
    /// <summary>the allocator returned NULL.</summary>
    public const int MPM_E_NOMEM = -2;
    /// <summary>not allowed now: objects live, views are out, or a step is begun.</summary>
    public const int MPM_E_STATE = -3;
    /// <summary>a callback returned &lt; 0, or the host's executor failed.</summary>
    public const int MPM_E_CALLBACK = -4;
    /// <summary>this version does not offer the combination or the extension.</summary>
    public const int MPM_E_UNSUPPORTED = -5;
    /// <summary>there is no such name, id or index; the text lists the nearest names.</summary>
    public const int MPM_E_NOT_FOUND = -6;
    /// <summary>a file could not be opened, read or written.</summary>
    public const int MPM_E_IO = -7;
    /// <summary>data are damaged, of another kind, or from an unlike setup.</summary>
    public const int MPM_E_FORMAT = -8;
    /// <summary>the library itself is at fault.</summary>
    public const int MPM_E_INTERNAL = -99;

    // Basis functions of the grid.
    /// <summary>piecewise linear functions, 2h wide: Steffen et al. 2008, eqs 17-18.</summary>
    public const int MPM_LINEAR = 1;
    /// <summary>Quadratic B-splines, 3h wide: Steffen et al. 2008, eq. 21; MPoint theory, eqs 24-27.</summary>
    public const int MPM_BSPLINE2 = 2;
    /// <summary>cubic B-splines, 4h wide: Steffen et al. 2008, eqs 22-23.</summary>
    public const int MPM_BSPLINE3 = 3;
    /// <summary>GIMP on domains of edges "size", at most a cell: Steffen et al. 2008, eqs 26-29.</summary>
    public const int MPM_GIMP = 16;
    /// <summary>GIMP on domains that all have edges of smoothing * spacing.</summary>
    public const int MPM_UGIMP = 17;
    /// <summary>GIMP on domains of edges "size" * |F_ii|, at most a cell; depends on the axes.</summary>
    public const int MPM_CPGIMP = 18;

    // What B-splines do at the faces of the grid: Steffen et al. 2008, section 3.2.
    /// <summary>splines are the same everywhere, with nodes outside the faces.</summary>
    public const int MPM_BOUNDARY_GHOST = 0;
    /// <summary>Knots are repeated degree + 1 times at the faces, where one function alone is then 1.</summary>
    public const int MPM_BOUNDARY_OPEN_KNOT = 1;

    // What lies across the plane of a 2-D grid.
    /// <summary>a slab of unit thickness that keeps its thickness.</summary>
    public const int MPM_PLANE_STRAIN = 0;
    /// <summary>A body of revolution: axis 0 is the radius r &gt;= 0, axis 1 the axis z.</summary>
    public const int MPM_AXISYMMETRIC = 1;
    /// <summary>A sheet of unit thickness at the start, without a stress across it: F33, which the library finds,
    /// makes it thinner and thicker.</summary>
    public const int MPM_PLANE_STRESS = 2;

    // Time integration scheme.
    /// <summary>Explicit, with stresses updated last: MPoint theory, eqs 28-44; Steffen et al. 2008, eqs
    /// 1-10.</summary>
    public const int MPM_USL = 1;
    /// <summary>Explicit, with stresses updated first, by the strain from the velocities at the start of the step:
    /// Guilkey, An Introduction to the MPM, eqs 2-10.</summary>
    public const int MPM_USF = 2;
    /// <summary>As MPM_USL, but velocities are projected a second time before stresses are updated.</summary>
    public const int MPM_MUSL = 3;
    /// <summary>Implicit, by Newmark's rule: Guilkey &amp; Weiss 2003, eqs 11-16, generalised to any beta and
    /// gamma.</summary>
    public const int MPM_NEWMARK = 16;

    // Transfer of velocity between particles and grid.
    /// <summary>FLIP, PIC, and their blend by the field flip: MPoint theory, eqs 34-36.</summary>
    public const int MPM_FLIP = 1;
    /// <summary>affine, with the inertia of each axis and particle, for any basis: Jiang et al. 2015.</summary>
    public const int MPM_APIC = 2;
    /// <summary>projects the velocity gradient too (MPoint theory, eq. 29); PIC update (eq. 35).</summary>
    public const int MPM_TPIC = 3;
    /// <summary>projects the velocity gradient too (MPoint theory, eq. 29); FLIP blend (eq. 36).</summary>
    public const int MPM_TFLIP = 4;
    /// <summary>affine projection with the FLIP blend.</summary>
    public const int MPM_AFLIP = 5;
    /// <summary>XPIC(m), where m is xpic_order: Hammerquist &amp; Nairn 2017.</summary>
    public const int MPM_XPIC = 6;
    /// <summary>Affine by moving least squares, with constant inertia and one fused matrix, for quadratic and cubic
    /// B-splines with ghosts or periodic axes: Hu et al. 2018.</summary>
    public const int MPM_APIC_MLS = 7;
    /// <summary>FMPM(k), where k is xpic_order: nodal velocities by the first k terms of a series for the inverse of
    /// the full mass matrix: Nairn &amp; Hammerquist 2021.</summary>
    public const int MPM_FMPM = 8;

    // Instruction set of the kernels.
    /// <summary>the best one that both the processor and the library have.</summary>
    public const int MPM_ISA_BEST = 0;
    /// <summary>the one that the library was compiled for.</summary>
    public const int MPM_ISA_BASELINE = 1;
    /// <summary>AVX2 with FMA, on x86-64.</summary>
    public const int MPM_ISA_AVX2 = 2;
    /// <summary>AVX-512 (F, DQ, VL), on x86-64.</summary>
    public const int MPM_ISA_AVX512 = 3;
    /// <summary>NEON with FMA, on aarch64.</summary>
    public const int MPM_ISA_NEON = 4;
    /// <summary>the baseline by its promise: the same bits on every platform (mpm.h, Results).</summary>
    public const int MPM_ISA_PORTABLE = MPM_ISA_BASELINE;

    // Level of a log text.
    /// <summary>the host should look at it.</summary>
    public const int MPM_LOG_WARNING = 1;
    /// <summary>a rare event: a choice made at creation, or growth of storage.</summary>
    public const int MPM_LOG_INFO = 2;
    /// <summary>a text in every step.</summary>
    public const int MPM_LOG_DEBUG = 3;

    // Remedy against volumetric locking: MPoint theory, eqs 47-53, carried to the deformation gradient.
    /// <summary>there is no remedy.</summary>
    public const int MPM_LOCKING_NONE = 0;
    /// <summary>The law sees the dilation averaged over the cell, weighted by volume.</summary>
    public const int MPM_LOCKING_CELL_AVERAGE = 1;

    // Form of a law's tangent.
    /// <summary>6 x 6 components, in Voigt's notation.</summary>
    public const int MPM_TANGENT_MINOR_SYMMETRIC = 36;
    /// <summary>9 x 9 components.</summary>
    public const int MPM_TANGENT_GENERAL = 81;

    // Faces of the grid.
    /// <summary>lower face across x.</summary>
    public const int MPM_X_MIN = 0;
    /// <summary>upper face across x.</summary>
    public const int MPM_X_MAX = 1;
    /// <summary>lower face across y.</summary>
    public const int MPM_Y_MIN = 2;
    /// <summary>upper face across y.</summary>
    public const int MPM_Y_MAX = 3;
    /// <summary>lower face across z.</summary>
    public const int MPM_Z_MIN = 4;
    /// <summary>upper face across z.</summary>
    public const int MPM_Z_MAX = 5;

    // What a face of the grid does.
    /// <summary>default: a step in which a particle would leave fails with MPM_OFF_GRID; none with total_lagrangian =
    /// 1, where "position" may leave the box.</summary>
    public const int MPM_WALL_NONE = 0;
    /// <summary>a particle that leaves is removed; refused with total_lagrangian = 1.</summary>
    public const int MPM_WALL_OPEN = 1;
    /// <summary>velocities at the face are zero: it pushes and pulls.</summary>
    public const int MPM_WALL_FIXED = 2;
    /// <summary>a symmetry plane: it pushes and pulls, without tangential force.</summary>
    public const int MPM_WALL_SLIP = 3;
    /// <summary>the plane of the face as a fixed obstacle with Coulomb friction (obstacle.h): it pushes, never
    /// pulls.</summary>
    public const int MPM_WALL_FRICTION = 4;
    /// <summary>contact of the nodes on the face with Coulomb friction: MPM_WALL_FRICTION as it was in
    /// 0.1.0.</summary>
    public const int MPM_WALL_FRICTION_NODES = 5;

    // What a surface prescribes of the motion of the material at its markers.
    /// <summary>default: the material carries the markers along.</summary>
    public const int MPM_PRESCRIBES_NOTHING = 0;
    /// <summary>all components: the material sticks to the surface.</summary>
    public const int MPM_PRESCRIBES_VELOCITY = 1;
    /// <summary>that along the area vector: the material slides without friction.</summary>
    public const int MPM_PRESCRIBES_NORMAL = 2;

    // Where in an explicit step a node hook runs.
    /// <summary>mass and velocity are projected, forces are not yet known.</summary>
    public const int MPM_AFTER_P2G = 1;
    /// <summary>internal and external forces are complete.</summary>
    public const int MPM_AFTER_FORCES = 2;
    /// <summary>velocity is updated, and walls and prescribed velocities have acted on it.</summary>
    public const int MPM_AFTER_VELOCITY = 3;

    // Access to mapped memory.
    /// <summary>the host reads.</summary>
    public const int MPM_READ = 1;
    /// <summary>the host writes.</summary>
    public const int MPM_WRITE = 2;

    // Type of a field's elements.
    /// <summary>double.</summary>
    public const int MPM_F64 = 1;
    /// <summary>int64_t.</summary>
    public const int MPM_I64 = 2;
    /// <summary>uint8_t.</summary>
    public const int MPM_U8 = 3;

    // Order of the particles in mpm_particles_get_f32().
    /// <summary>by ascending id.</summary>
    public const int MPM_BY_ID = 1;
    /// <summary>as they lie in memory, without inert slots; changes when they are sorted anew.</summary>
    public const int MPM_LIBRARY_ORDER = 2;

    // Linear solver of an implicit step.
    /// <summary>the library chooses by size, stencil, symmetry and inertia; with a transport as parallel.h
    /// says.</summary>
    public const int MPM_SOLVER_AUTO = 0;
    /// <summary>conjugate gradients, for symmetric positive definite systems.</summary>
    public const int MPM_SOLVER_CG = 1;
    /// <summary>conjugate gradients with geometric multigrid, for the same systems.</summary>
    public const int MPM_SOLVER_MULTIGRID_CG = 2;
    /// <summary>a direct solver, for symmetric systems that may be indefinite.</summary>
    public const int MPM_SOLVER_LDLT = 3;
    /// <summary>GMRES, for systems that are not symmetric.</summary>
    public const int MPM_SOLVER_GMRES = 4;
    /// <summary>the callback of mpm_stepper_set_linear_solver().</summary>
    public const int MPM_SOLVER_HOST = 100;

    // How much of an exchange its receivers know beforehand.
    /// <summary>both sides know who sends to whom: partners send and receive.</summary>
    public const int MPM_EXCHANGE_KNOWN = 1;
    /// <summary>receivers do not know from whom: particles that move, changes of the pattern.</summary>
    public const int MPM_EXCHANGE_SPARSE = 2;

    // What mpm_reduce_fn does.
    /// <summary>the largest of all parts.</summary>
    public const int MPM_REDUCE_MAX = 1;
    /// <summary>the sum, modulo 2^64.</summary>
    public const int MPM_REDUCE_SUM = 2;

    // How two bodies meet: mpm_contact_desc.kind.
    /// <summary>they push each other and never pull, with Coulomb friction (default).</summary>
    public const int MPM_CONTACT_UNILATERAL = 0;
    /// <summary>they pass through each other.</summary>
    public const int MPM_CONTACT_NONE = 1;
    /// <summary>neither slip nor separation at nodes that both have.</summary>
    public const int MPM_CONTACT_TIED = 2;

    // How the normal at a node is found: mpm_contact_desc.normal.
    /// <summary>of the plane that separates the particles best: logistic regression.</summary>
    public const int MPM_NORMAL_LOGISTIC = 0;
    /// <summary>of Fisher's linear discriminant: one pass, for smooth surfaces.</summary>
    public const int MPM_NORMAL_DISCRIMINANT = 1;
    /// <summary>of the mean gradient of volume: for comparison with other codes.</summary>
    public const int MPM_NORMAL_GRADIENT = 2;
    /// <summary>mpm_contact_desc.direction.</summary>
    public const int MPM_NORMAL_FIXED = 3;

    // How it is found that bodies touch: mpm_contact_desc.detection.
    /// <summary>MPM_DETECT_GAP, but MPM_DETECT_VELOCITY with MPM_NORMAL_GRADIENT, whose directions are too far off to
    /// measure a gap along them.</summary>
    public const int MPM_DETECT_DEFAULT = 0;
    /// <summary>by the gap between their particles.</summary>
    public const int MPM_DETECT_GAP = 1;
    /// <summary>by velocity alone: wherever they share a node and approach each other.</summary>
    public const int MPM_DETECT_VELOCITY = 2;

    // In place of a body: all of them.
    /// <summary>any body that has no closer rule; all of them in reports.</summary>
    public const int MPM_BODY_ANY = -1;

    // Shapes: mpm_obstacle_desc.shape.
    /// <summary>a half-space; outward normal: axis y, in 1-D x.</summary>
    public const int MPM_SHAPE_PLANE = 1;
    /// <summary>size[0]: radius; in 2-D a disc.</summary>
    public const int MPM_SHAPE_SPHERE = 2;
    /// <summary>around axis z; size[0]: radius, size[1]: half length. 3-D only.</summary>
    public const int MPM_SHAPE_CYLINDER = 3;
    /// <summary>around axis z; size[0]: radius, size[1]: half length without caps. 3-D only.</summary>
    public const int MPM_SHAPE_CAPSULE = 4;
    /// <summary>size: half edges; in 2-D a rectangle.</summary>
    public const int MPM_SHAPE_BOX = 5;
    /// <summary>what mpm_obstacle_desc.distance says.</summary>
    public const int MPM_SHAPE_DISTANCE = 64;

    // How an obstacle moves: mpm_obstacle_desc.motion.
    /// <summary>not at all (default).</summary>
    public const int MPM_MOTION_FIXED = 0;
    /// <summary>by its velocities, which the host may change from step to step.</summary>
    public const int MPM_MOTION_PRESCRIBED = 1;
    /// <summary>as a rigid body under contact, gravity and the host's load.</summary>
    public const int MPM_MOTION_FREE = 2;

    // What a batch of mpm_adaption_fn is about.
    /// <summary>particles that are to be split.</summary>
    public const int MPM_ADAPT_SPLIT = 0;
    /// <summary>pairs that are to become one particle.</summary>
    public const int MPM_ADAPT_MERGE = 1;

    // How the nodes conduct.
    /// <summary>By the temperatures at the start of the step.</summary>
    public const int MPM_CONDUCTION_EXPLICIT = 0;
    /// <summary>By those at its end (backward Euler), found by conjugate gradients: any step will do.</summary>
    public const int MPM_CONDUCTION_IMPLICIT = 1;

    // What a face of the grid does to heat.
    /// <summary>lets none through.</summary>
    public const int MPM_HEAT_WALL_INSULATED = 0;
    /// <summary>material at it has a prescribed temperature.</summary>
    public const int MPM_HEAT_WALL_TEMPERATURE = 1;
  }

  /// <summary>Starts an exchange and returns before it is done. out: ascending by part, never this one. most: of each
  /// partner, a bound on what comes from it, [count]; NULL with MPM_EXCHANGE_SPARSE.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int SendFn(IntPtr user, int exchange, int count, Message* @out, long* most);

  /// <summary>Ends the exchange: all that was sent to this part, ascending by part.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int ReceiveFn(IntPtr user, int* count, Message** @in);

  /// <summary>values[count] of all parts into each of them (collective).</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int ReduceFn(IntPtr user, int op, long count, long* values);

  /// <summary>all[parts]: value of each part (collective).</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int GatherFn(IntPtr user, long value, long* all);

  /// <summary>For transports that move only when called: called up to eight times between send and receive of a sum
  /// on nodes, after each group of the blocks whose sums are made meanwhile.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate void TransportPollFn(IntPtr user);

  /// <summary>A task of the library, which the host's executor calls with the task_data that it was given and a
  /// number k.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate void TaskFn(IntPtr task_data, long k);

  /// <summary>The host's executor.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int ParallelForFn(IntPtr user, long count, TaskFn task, IntPtr task_data);

  /// <summary>Returns memory of at least so many bytes at a multiple of alignment, a power of two; or NULL if there
  /// is none.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate IntPtr ContextDescAllocFn(IntPtr user, UIntPtr bytes, UIntPtr alignment);

  /// <summary>Takes back memory from alloc, with the same bytes and alignment.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate void ContextDescReleaseFn(IntPtr user, IntPtr memory, UIntPtr bytes, UIntPtr alignment);

  /// <summary>Takes a finished text without newline, with a level MPM_LOG_*.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate void ContextDescLogFn(IntPtr user, int level, byte* text);

  /// <summary>A law (mt).</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int StressFn(IntPtr user, MaterialBatch* batch);

  /// <summary>The tangent of a law (mt), for implicit steps.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int TangentFn(IntPtr user, MaterialBatch* batch, double* tangent, int* symmetric);

  /// <summary>Called with user when the material is destroyed, not when create fails; may be NULL
  /// (default).</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate void MaterialDescReleaseUserFn(IntPtr user);

  /// <summary>Tells which of n points are inside a body: the callback writes inside[i] = 1 or 0 for the point with
  /// the coordinates position[c * ld + i], c &lt; dim.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int InsideFn(IntPtr user, int dim, long n, long ld, double* position, byte* inside);

  /// <summary>Solves matrix * solution = rhs.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int SolveFn(IntPtr user, IntPtr matrix, double* rhs, double* solution, double tolerance,
      long* iterations);

  /// <summary>Gives a vector per particle (mt): the callback does add[c * ld + i] += value for c &lt; dim, because
  /// several sources add to the same array.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int ParticleFn(IntPtr user, ParticleBatch* batch, double* add);

  /// <summary>Prescribes nodal velocities (mt).</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int VelocityFn(IntPtr user, NodeBatch* batch, byte* prescribed, double* velocity);

  /// <summary>Reads and changes the nodal velocity[dim][ld] and force[dim][ld] at a stage of an explicit step
  /// (mt).</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int NodeFn(IntPtr user, NodeBatch* batch, double* velocity, double* force);

  /// <summary>Watches steps.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int ProgressFn(IntPtr user, StepInfo* info);

  /// <summary>Sets the coefficients of friction of nodes (mt): friction[ld], preset to that of the pair of bodies,
  /// may be changed to any finite value &gt;= 0; it then also is that of sticking.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int FrictionFn(IntPtr user, ContactBatch* batch, double* friction);

  /// <summary>Gives distances of points (mt).</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int DistanceFn(IntPtr user, DistanceBatch* batch);

  /// <summary>Gives the mean velocity[3] and angular velocity[3] of the step from t over dt; both are preset to the
  /// present ones.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int MotionFn(IntPtr user, double t, double dt, double* velocity, double* angular_velocity);

  /// <summary>Gives tractions: the callback does add[c * ld + i] += force per present area of marker i, c &lt;
  /// dim.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int TractionFn(IntPtr user, MarkerBatch* batch, double* add);

  /// <summary>Gives velocities: the callback does add[c * ld + i] += mean velocity of marker i over the step that
  /// begins at batch-&gt;t, c &lt; dim.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int MarkerVelocityFn(IntPtr user, MarkerBatch* batch, double* add);

  /// <summary>Says which of them are left as they are: accept[i], [ld], is 1, and the callback writes 0 to keep the
  /// i-th from it.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int AdaptionFn(IntPtr user, AdaptionBatch* batch, byte* accept);

  /// <summary>Heat sources: writes power[i], [ld], power per present volume, at the time batch-&gt;t: the start of
  /// the step, and with implicit conduction its end.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int HeatFn(IntPtr user, ParticleBatch* batch, double* power);

  /// <summary>Takes the next bytes of an output, in the order in which a file would have them: for archives, sockets,
  /// browsers.</summary>
  [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
  public unsafe delegate int WriteFn(IntPtr user, IntPtr data, long bytes);

  /// <summary>A named number.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct Param {
    /// <summary>one of the names that mpm_material_model_param() lists.</summary>
    public IntPtr name;
    /// <summary>the value, in the host's units.</summary>
    public double value;
  }

  /// <summary>Memory of the library, lent to the host until mpm_view_release().</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct View {
    /// <summary>sizeof(mpm_view) of the caller.</summary>
    public uint struct_size;
    /// <summary>MPM_F64, MPM_I64 or MPM_U8.</summary>
    public int type;
    /// <summary>stored components of an item; tensors may be compact, see particles.h.</summary>
    public int components;
    /// <summary>MPM_READ, MPM_WRITE or both, as asked for.</summary>
    public int access;
    /// <summary>number of items, inert slots included.</summary>
    public long count;
    /// <summary>distance from item i to item i + 1, in elements.</summary>
    public long item_stride;
    /// <summary>distance from component c to component c + 1, in elements.</summary>
    public long component_stride;
    /// <summary>address of component 0 of item 0; NULL once released.</summary>
    public IntPtr data;
    /// <summary>for the library's use; NULL once released.</summary>
    public IntPtr owner;

    /// <summary>Ready to be filled: zeros, and struct_size.</summary>
    public static View Empty() {
      var it = new View();
      it.struct_size = (uint)sizeof(View);
      return it;
    }
  }

  /// <summary>Bytes for, or from, another part.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct Message {
    /// <summary>to whom, or from whom.</summary>
    public int part;
    /// <summary>0; not looked at in what arrives.</summary>
    public int reserved;
    /// <summary>how many; 0 is sent too where the partner is known.</summary>
    public long bytes;
    /// <summary>out: the library's, unchanged until mpm_receive_fn returns; in: the host's, at a multiple of 64,
    /// valid until the next mpm_send_fn.</summary>
    public IntPtr data;
  }

  /// <summary>Ways between the parts.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct Transport {
    /// <summary>sizeof(mpm_transport) of the caller.</summary>
    public uint struct_size;
    /// <summary>of this context, 0 ... parts - 1.</summary>
    public int part;
    /// <summary>how many there are.</summary>
    public int parts;
    /// <summary>0.</summary>
    public int reserved;
    /// <summary>required, as the three that follow.</summary>
    public IntPtr send;
    /// <summary>ends what send started.</summary>
    public IntPtr receive;
    /// <summary>maxima and sums of integers.</summary>
    public IntPtr reduce;
    /// <summary>one integer of each part.</summary>
    public IntPtr gather;
    /// <summary>For transports that move only when called: called up to eight times between send and receive of a sum
    /// on nodes, after each group of the blocks whose sums are made meanwhile.</summary>
    public IntPtr poll;
    /// <summary>passed to all of them.</summary>
    public IntPtr user;
  }

  /// <summary>How blocks of the grid are given to parts.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct BalanceDesc {
    /// <summary>sizeof(mpm_balance_desc) of the caller.</summary>
    public uint struct_size;
    /// <summary>0 (default): a block weighs what its particles and block_weight come to. 1: the seconds that a part
    /// has spent in steps since blocks were last given to parts, those of waiting left out, are what its blocks weigh
    /// together, each in proportion to that.</summary>
    public int measure;
    /// <summary>Blocks are given to parts anew, at a sort, when the largest weight of a part is this many times the
    /// mean, at least 1; infinity: never.</summary>
    public double limit;
    /// <summary>What a block costs beside its particles, in particles, from 0 to 1e6.</summary>
    public double block_weight;

    /// <summary>The library's defaults.</summary>
    public static BalanceDesc Default() {
      var it = new BalanceDesc();
      MpmException.Check(Native.mpm_balance_desc_init(&it, (uint)sizeof(BalanceDesc)), IntPtr.Zero);
      return it;
    }
  }

  /// <summary>What one part does of a problem, and what that costs.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct ParallelInfo {
    /// <summary>sizeof(mpm_parallel_info) of the caller.</summary>
    public uint struct_size;
    /// <summary>parts that share nodes with this one.</summary>
    public int neighbours;
    /// <summary>with particles of this part.</summary>
    public long blocks;
    /// <summary>of them beside blocks of other parts.</summary>
    public long boundary;
    /// <summary>blocks of other parts beside them.</summary>
    public long ghosts;
    /// <summary>sent for sums on nodes.</summary>
    public long bytes_nodes;
    /// <summary>sent for particles that moved to another part.</summary>
    public long bytes_moved;
    /// <summary>such particles.</summary>
    public long moved;
    /// <summary>how often blocks were given to parts anew.</summary>
    public long cuts;
    /// <summary>largest weight of a part over the mean at the last sort, the same on all parts.</summary>
    public double imbalance;
    /// <summary>packing what is sent, and unpacking particles.</summary>
    public double seconds_packing;
    /// <summary>in receive.</summary>
    public double seconds_waiting;
    /// <summary>in reduce and gather.</summary>
    public double seconds_reducing;

    /// <summary>Ready to be filled: zeros, and struct_size.</summary>
    public static ParallelInfo Empty() {
      var it = new ParallelInfo();
      it.struct_size = (uint)sizeof(ParallelInfo);
      return it;
    }
  }

  /// <summary>Services of the host.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct ContextDesc {
    /// <summary>sizeof(mpm_context_desc) of the caller.</summary>
    public uint struct_size;
    /// <summary>Number of threads, 0 to 1024.</summary>
    public int concurrency;
    /// <summary>Instruction set of the kernels: MPM_ISA_BEST (default) or the one to be used, which creation refuses
    /// with MPM_E_UNSUPPORTED if processor or library lacks it.</summary>
    public int isa;
    /// <summary>1: the library calls the host from the calling thread only, also where a callback is marked
    /// (mt).</summary>
    public int serial_callbacks;
    /// <summary>Returns memory of at least so many bytes at a multiple of alignment, a power of two; or NULL if there
    /// is none.</summary>
    public IntPtr alloc;
    /// <summary>Takes back memory from alloc, with the same bytes and alignment.</summary>
    public IntPtr release;
    /// <summary>first argument of alloc and release.</summary>
    public IntPtr alloc_user;
    /// <summary>The host's executor, which takes the place of the pool; concurrency then says for how many threads
    /// the work is cut.</summary>
    public IntPtr parallel_for;
    /// <summary>first argument of parallel_for.</summary>
    public IntPtr parallel_user;
    /// <summary>Takes a finished text without newline, with a level MPM_LOG_*.</summary>
    public IntPtr log;
    /// <summary>first argument of log.</summary>
    public IntPtr log_user;
    /// <summary>The host's memory for a sentence that says why mpm_context_create() has failed: it is cut to fit, and
    /// ends with a zero; after MPM_OK it is as before.</summary>
    public IntPtr error_text;
    /// <summary>size of error_text in bytes; 0 exactly where error_text is NULL.</summary>
    public ulong error_bytes;
    /// <summary>The ways to the other parts of the problem, read during mpm_context_create() and copied, or NULL
    /// (default): there is one part.</summary>
    public Transport* transport;

    /// <summary>The library's defaults.</summary>
    public static ContextDesc Default() {
      var it = new ContextDesc();
      MpmException.Check(Native.mpm_context_desc_init(&it, (uint)sizeof(ContextDesc)), IntPtr.Zero);
      return it;
    }
  }

  /// <summary>Box, cells and basis of a grid.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct GridDesc {
    /// <summary>sizeof(mpm_grid_desc) of the caller.</summary>
    public uint struct_size;
    /// <summary>1 (uniaxial strain), 2 (see geometry) or 3 (default).</summary>
    public int dim;
    /// <summary>MPM_LINEAR to MPM_CPGIMP; default MPM_BSPLINE2.</summary>
    public int basis;
    /// <summary>for B-splines: MPM_BOUNDARY_GHOST (default) or MPM_BOUNDARY_OPEN_KNOT.</summary>
    public int boundary_basis;
    /// <summary>1: the axis is periodic; default 0.</summary>
    public fixed int periodic[3];
    /// <summary>for dim 2: an MPM_PLANE_STRAIN (default) ...</summary>
    public int geometry;
    /// <summary>cells along each axis, 1 to 6291456; memory follows the material.</summary>
    public fixed long cells[3];
    /// <summary>lower corner of the box, length; default 0.</summary>
    public fixed double origin[3];
    /// <summary>edges of a cell, length, &gt; 0; the upper corner is origin + cells * spacing.</summary>
    public fixed double spacing[3];
    /// <summary>for MPM_UGIMP: edge of a particle's domain / spacing, in (0, 1]; default 0.5.</summary>
    public double smoothing;
    /// <summary>1: a total Lagrangian grid (de Vaucorbeil, Nguyen &amp; Hutchinson 2020).</summary>
    public int total_lagrangian;
    /// <summary>0.</summary>
    public int reserved;

    /// <summary>The library's defaults.</summary>
    public static GridDesc Default() {
      var it = new GridDesc();
      MpmException.Check(Native.mpm_grid_desc_init(&it, (uint)sizeof(GridDesc)), IntPtr.Zero);
      return it;
    }
  }

  /// <summary>Particles that a law is asked about.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct MaterialBatch {
    /// <summary>sizeof(mpm_material_batch) of the library; see mpm.h.</summary>
    public uint struct_size;
    /// <summary>number of state variables of a particle.</summary>
    public int state_count;
    /// <summary>number of particles, inert slots included.</summary>
    public long n;
    /// <summary>distance from component c to c + 1, in elements; &gt;= n.</summary>
    public long ld;
    /// <summary>time at the end of the step.</summary>
    public double t;
    /// <summary>size of the step; 0: the state as it is, see mpm_stress_fn.</summary>
    public double dt;
    /// <summary>[ld] ids, &lt; 0 for inert slots.</summary>
    public long* id;
    /// <summary>[9][ld] deformation gradient at the end of the step.</summary>
    public double* F;
    /// <summary>[9][ld] deformation gradient of this step alone: F = F_inc F_old.</summary>
    public double* F_inc;
    /// <summary>[9][ld] velocity gradient (F_inc - I) / dt, 1/time; 0 when dt is 0.</summary>
    public double* L;
    /// <summary>[6][ld] Cauchy stress before the step.</summary>
    public double* stress;
    /// <summary>[state_count][ld] state variables before the step.</summary>
    public double* state;
    /// <summary>[6][ld] out: Cauchy stress after the step.</summary>
    public double* stress_new;
    /// <summary>[state_count][ld] out: state variables after the step.</summary>
    public double* state_new;
    /// <summary>[ld] out: speed of the fastest elastic wave now, length/time.</summary>
    public double* wave_speed;
    /// <summary>[ld] out, preset 0: length^2/time, limits the explicit dt.</summary>
    public double* kinematic_viscosity;
    /// <summary>[ld] out, preset NaN (not known): strain energy per initial volume.</summary>
    public double* energy;
    /// <summary>[dim][ld] position at the start of the step.</summary>
    public double* position;
    /// <summary>argument of mpm_batch_field().</summary>
    public IntPtr lookup;

    /// <summary>Ready to be filled: zeros, and struct_size.</summary>
    public static MaterialBatch Empty() {
      var it = new MaterialBatch();
      it.struct_size = (uint)sizeof(MaterialBatch);
      return it;
    }
  }

  /// <summary>A law of the host.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct MaterialDesc {
    /// <summary>sizeof(mpm_material_desc) of the caller.</summary>
    public uint struct_size;
    /// <summary>number of state variables of a particle, 0 to 64; default 0.</summary>
    public int state_count;
    /// <summary>MPM_TANGENT_MINOR_SYMMETRIC (default) or MPM_TANGENT_GENERAL.</summary>
    public int tangent_form;
    /// <summary>0.</summary>
    public int reserved;
    /// <summary>mass per initial volume, &gt; 0; the host must set it.</summary>
    public double density;
    /// <summary>the law; the host must set it.</summary>
    public IntPtr stress;
    /// <summary>NULL (default): stresses are differenced, in the general form.</summary>
    public IntPtr tangent;
    /// <summary>first argument of stress, tangent and release_user.</summary>
    public IntPtr user;
    /// <summary>Called with user when the material is destroyed, not when create fails; may be NULL
    /// (default).</summary>
    public IntPtr release_user;
    /// <summary>[state_count] state of a new particle, copied; NULL (default): zeros.</summary>
    public double* state_initial;

    /// <summary>The library's defaults.</summary>
    public static MaterialDesc Default() {
      var it = new MaterialDesc();
      MpmException.Check(Native.mpm_material_desc_init(&it, (uint)sizeof(MaterialDesc)), IntPtr.Zero);
      return it;
    }
  }

  /// <summary>A linear system.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct OperatorInfo {
    /// <summary>sizeof(mpm_operator_info) of the caller.</summary>
    public uint struct_size;
    /// <summary>number of rows of a node on which nothing is prescribed.</summary>
    public int block;
    /// <summary>1 if the matrix is symmetric, else 0.</summary>
    public int symmetric;
    /// <summary>1 if the matrix is expected to be positive definite, which is not checked.</summary>
    public int positive_definite;
    /// <summary>number of local rows and of local columns.</summary>
    public long rows;
    /// <summary>number of stored entries, all of them in owned rows.</summary>
    public long nonzeros;
    /// <summary>a hash of nodes, axes and columns, below 2^53, equal on all parts.</summary>
    public long pattern_id;
    /// <summary>distance from component c to c + 1 of position, in elements; &gt;= rows.</summary>
    public long ld;
    /// <summary>[rows] number of the node of each row, as in mpm_step_info.node.</summary>
    public long* node;
    /// <summary>[rows] axis of each row.</summary>
    public int* component;
    /// <summary>[dim][ld] position of the node of each row, for near-null spaces.</summary>
    public double* position;
    /// <summary>number of the first owned row over all parts; 0 with one part.</summary>
    public long first_row;
    /// <summary>number of rows that this part owns; rows with one part.</summary>
    public long owned_rows;
    /// <summary>number of rows of all parts together.</summary>
    public long all_rows;
    /// <summary>[rows] number of each local row over all parts.</summary>
    public long* number;

    /// <summary>Ready to be filled: zeros, and struct_size.</summary>
    public static OperatorInfo Empty() {
      var it = new OperatorInfo();
      it.struct_size = (uint)sizeof(OperatorInfo);
      return it;
    }
  }

  /// <summary>Options of a stepper.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct StepperDesc {
    /// <summary>sizeof(mpm_stepper_desc) of the caller.</summary>
    public uint struct_size;
    /// <summary>MPM_USL (default), MPM_USF, MPM_MUSL or MPM_NEWMARK.</summary>
    public int scheme;
    /// <summary>MPM_FLIP (default) to MPM_FMPM.</summary>
    public int transfer;
    /// <summary>Order m of MPM_XPIC, 1 (PIC) to 5, or k of MPM_FMPM, 1 (PIC) to 32; default 2.</summary>
    public int xpic_order;
    /// <summary>Order of the update of positions; v is the updated nodal velocity and w a weight.</summary>
    public int position_order;
    /// <summary>MPM_LOCKING_NONE (default) or, in 2-D and 3-D, MPM_LOCKING_CELL_AVERAGE.</summary>
    public int locking_remedy;
    /// <summary>1: keeps "reference_position" and shows it to callbacks; default 0.</summary>
    public int reference_positions;
    /// <summary>1: MPM_NEWMARK drops the inertia, so that each step ends in equilibrium under the forces at its
    /// end.</summary>
    public int quasi_static;
    /// <summary>1: particle velocities are those at t_n - dt/2 (Steffen et al. 2008, eqs 11-15), and so is the
    /// kinetic energy; default 0.</summary>
    public int staggered;
    /// <summary>Acceleration of nodes whose velocity the host or a particle prescribes.</summary>
    public int boundary_zero_acceleration;
    /// <summary>Share of FLIP per step for MPM_FLIP, MPM_TFLIP and MPM_AFLIP, and between the steps that xpic_every
    /// counts, from 1 (default, FLIP) to 0 (PIC).</summary>
    public double flip;
    /// <summary>Rate beta &gt;= 0, 1/time, of a blend that does not depend on dt (MPoint theory, eqs 58-59), for the
    /// transfers of flip: the step's share of FLIP is flip * max(0, 1 - beta dt).</summary>
    public double pic_damping;
    /// <summary>acceleration of all particles, length/time^2; default 0.</summary>
    public fixed double gravity[3];
    /// <summary>Newmark's beta: default 1/4, as Guilkey &amp; Weiss 2003, eqs 14-15.</summary>
    public double newmark_beta;
    /// <summary>Newmark's gamma: default 1/2, as there; larger values damp high frequencies.</summary>
    public double newmark_gamma;
    /// <summary>Newton iterations end when the displacement increment is at most this share of the largest of the
    /// step, both measured by the diagonal of the stiffness, in which light nodes count little (Guilkey &amp; Weiss
    /// 2003, eq. 13, eps_d), and the next two bounds hold as well.</summary>
    public double newton_tolerance_displacement;
    /// <summary>They end when the increment times the residual is at most this share of the first of the step (eps_e
    /// in the same eq. 13), and the other two bounds hold.</summary>
    public double newton_tolerance_energy;
    /// <summary>They end when the norm of the residual is at most this share of a scale that includes reactions, and
    /// the other two bounds hold.</summary>
    public double newton_tolerance_residual;
    /// <summary>Norm of the residual, a force, up to which its bound holds whatever the scale.</summary>
    public double newton_residual_floor;
    /// <summary>iterations after which a step is MPM_NOT_CONVERGED; default 20.</summary>
    public int newton_max_iterations;
    /// <summary>MPM_SOLVER_AUTO (default) to MPM_SOLVER_HOST.</summary>
    public int linear_solver;
    /// <summary>||K x - b|| / ||b||; 0 (default): the Newton iteration chooses it.</summary>
    public double linear_tolerance;
    /// <summary>most iterations of a linear solve; 0 (default): the solver chooses.</summary>
    public int linear_max_iterations;
    /// <summary>1: with MPM_MUSL particles move by the projected velocities, which strain them too: x += dt sum w v,
    /// with the v of the second projection.</summary>
    public int projected_positions;
    /// <summary>Local damping alpha of Cundall 1987, in [0, 1); default 0.</summary>
    public double local_damping;
    /// <summary>Damping in proportion to mass, a &gt;= 0 in 1/time; default 0: the force -a m v on nodes, for a share
    /// of a / (2 omega) of critical damping.</summary>
    public double mass_damping;
    /// <summary>For MPM_XPIC and MPM_FMPM: every so many steps are of the order xpic_order, those whose number
    /// (mpm_step_info::step, counted from 1 or on from mpm_stepper_set_time()) is a multiple of this; all others are
    /// those of MPM_FLIP, with flip and pic_damping.</summary>
    public int xpic_every;
    /// <summary>0.</summary>
    public int reserved;

    /// <summary>The library's defaults.</summary>
    public static StepperDesc Default() {
      var it = new StepperDesc();
      MpmException.Check(Native.mpm_stepper_desc_init(&it, (uint)sizeof(StepperDesc)), IntPtr.Zero);
      return it;
    }
  }

  /// <summary>What a step did, or the state as it is.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct StepInfo {
    /// <summary>sizeof(mpm_step_info) of the caller.</summary>
    public uint struct_size;
    /// <summary>status of the failure, MPM_OK if there was none.</summary>
    public int cause;
    /// <summary>what a callback returned when it was not 0, else 0.</summary>
    public int callback_status;
    /// <summary>linear solves of the step; 0 for explicit schemes, and at rest.</summary>
    public int newton_iterations;
    /// <summary>MPM_SOLVER_* that was used; 0 for explicit schemes.</summary>
    public int linear_solver;
    /// <summary>Set of the first failure, numbered in order of mpm_stepper_add(), or -1.</summary>
    public int set;
    /// <summary>number of committed steps, counted on from mpm_stepper_set_time().</summary>
    public long step;
    /// <summary>Number of nodes with mass in the step; of one that failed before they were counted, that of the step
    /// before.</summary>
    public long active_nodes;
    /// <summary>particles that left through MPM_WALL_OPEN since the stepper was made.</summary>
    public long removed;
    /// <summary>how often particles were sorted anew since the stepper was made.</summary>
    public long resorts;
    /// <summary>id of the particle that failed, or -1.</summary>
    public long particle;
    /// <summary>Node that failed, or -1: its lexicographic number over the grid with one ghost layer per side,
    /// ((ix+1)*(cells_y+3)+(iy+1))*(cells_z+3)+(iz+1) with unused axes left out.</summary>
    public long node;
    /// <summary>iterations of the linear solver, summed over the step.</summary>
    public long linear_iterations;
    /// <summary>time of the state.</summary>
    public double t;
    /// <summary>size of the step that was tried; 0 before the first.</summary>
    public double dt;
    /// <summary>After success the stable dt of the new state, or with MPM_NEWMARK 2 dt if there were at most 4
    /// iterations and else dt.</summary>
    public double dt_suggested;
    /// <summary>last relative residual of the Newton iteration; 0 for explicit schemes.</summary>
    public double residual;
    /// <summary>sum m v.v / 2.</summary>
    public double kinetic_energy;
    /// <summary>sum energy * initial_volume; NaN when a law has none.</summary>
    public double strain_energy;
    /// <summary>Work during the step of gravity, acceleration and force callbacks, applied_force, surfaces, node
    /// hooks, prescribed nodal velocities and prescribed particles.</summary>
    public double external_work;
    /// <summary>(kinetic + strain) before the step + external_work - (kinetic + strain) after; NaN where the strain
    /// energy is.</summary>
    public double dissipation;
    /// <summary>sum m v; along the radius of MPM_AXISYMMETRIC 0.</summary>
    public fixed double momentum[3];
    /// <summary>sum m x cross v; in 2-D about z, in [2]; in 1-D and MPM_AXISYMMETRIC 0.</summary>
    public fixed double angular_momentum[3];
    /// <summary>Sum of external_work over all committed steps since the stepper was made or its time was
    /// set.</summary>
    public double external_work_total;
    /// <summary>sum m tr(C D C^T) / 2: kinetic energy of the matrices that APIC, APIC_MLS, TPIC, TFLIP and AFLIP
    /// carry (C is "velocity_gradient", D the second moments of the basis), whose angular momentum is part of
    /// angular_momentum.</summary>
    public double affine_kinetic_energy;
    /// <summary>Energy that contact of bodies, obstacles and MPM_WALL_FRICTION took in the step, from the velocities
    /// that the nodes would have without it: never negative.</summary>
    public double contact_dissipation;
    /// <summary>nodes at which these gave each other an impulse.</summary>
    public long contact_nodes;
    /// <summary>velocity field of `node`; 0 where there is none.</summary>
    public int body;
    /// <summary>0.</summary>
    public int reserved;
    /// <summary>Energy that local_damping and mass_damping took in the step: a part of `dissipation`.</summary>
    public double damping_dissipation;
    /// <summary>Sum of damping_dissipation over all committed steps since the stepper was made or its time was
    /// set.</summary>
    public double damping_dissipation_total;

    /// <summary>Ready to be filled: zeros, and struct_size.</summary>
    public static StepInfo Empty() {
      var it = new StepInfo();
      it.struct_size = (uint)sizeof(StepInfo);
      return it;
    }
  }

  /// <summary>Particles of one set for which a force is wanted.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct ParticleBatch {
    /// <summary>sizeof(mpm_particle_batch) of the library; see mpm.h.</summary>
    public uint struct_size;
    /// <summary>dimension of the grid.</summary>
    public int dim;
    /// <summary>number of particles, inert slots included.</summary>
    public long n;
    /// <summary>distance from component c to c + 1, in elements; &gt;= n.</summary>
    public long ld;
    /// <summary>Time for which the value is wanted: the start of the step.</summary>
    public double t;
    /// <summary>size of the step.</summary>
    public double dt;
    /// <summary>[ld] ids, &lt; 0 for inert slots.</summary>
    public long* id;
    /// <summary>[dim][ld] at the start of the step, wrapped on periodic axes unless total_lagrangian = 1.</summary>
    public double* position;
    /// <summary>[dim][ld], or NULL without reference_positions; never NULL with total_lagrangian = 1.</summary>
    public double* reference_position;
    /// <summary>[dim][ld] at the start of the step.</summary>
    public double* velocity;
    /// <summary>[ld].</summary>
    public double* mass;
    /// <summary>[ld] at the start of the step.</summary>
    public double* volume;
    /// <summary>the set, for comparison only: no call takes it in a callback.</summary>
    public IntPtr particles;
    /// <summary>argument of mpm_batch_field().</summary>
    public IntPtr lookup;
  }

  /// <summary>Active nodes of the grid.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct NodeBatch {
    /// <summary>sizeof(mpm_node_batch) of the library; see mpm.h.</summary>
    public uint struct_size;
    /// <summary>dimension of the grid.</summary>
    public int dim;
    /// <summary>velocity field of the nodes; see mpm_stepper_set_body().</summary>
    public int body;
    /// <summary>0.</summary>
    public int reserved;
    /// <summary>number of nodes.</summary>
    public long n;
    /// <summary>distance from component c to c + 1, in elements; &gt;= n.</summary>
    public long ld;
    /// <summary>time for which the value is wanted.</summary>
    public double t;
    /// <summary>size of the step.</summary>
    public double dt;
    /// <summary>[dim][ld] index of the basis function, from -1 to cells + 1.</summary>
    public long* index;
    /// <summary>[dim][ld] origin + index * spacing; with open knots the Greville points.</summary>
    public double* position;
    /// <summary>[ld].</summary>
    public double* mass;
    /// <summary>[ld] 1 on exactly one of the parts that have the node, for sums of the host, else 0; all 1 with one
    /// part: see parallel.h.</summary>
    public byte* owned;
  }

  /// <summary>How mpm_advance() chooses its sub-steps.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct AdvanceDesc {
    /// <summary>sizeof(mpm_advance_desc) of the caller.</summary>
    public uint struct_size;
    /// <summary>most cuts of one sub-step before the call gives up; 0 (default): 60.</summary>
    public int max_cuts;
    /// <summary>time to reach, not before the present one.</summary>
    public double t_end;
    /// <summary>Explicit: share of mpm_stable_dt(), in (0, 1], or 0 (default since 0.2.0, was 0.5): two thirds of the
    /// largest share at which bodies were found to stay bounded, by basis and scheme: with all transfers in 1-D and
    /// 2-D (of MPM_XPIC order 2, of MPM_FMPM 2 and 8), with MPM_FLIP in 3-D.</summary>
    public double cfl;
    /// <summary>most that the first sub-step takes; 0 (default): the controller's dt.</summary>
    public double dt_first;
    /// <summary>size below which sub-steps are not cut; 0 (default): no bound.</summary>
    public double dt_min;
    /// <summary>size of the largest sub-step; 0 (default): no bound.</summary>
    public double dt_max;
    /// <summary>most sub-steps of this call; 0 (default): no limit.</summary>
    public long max_steps;

    /// <summary>The library's defaults.</summary>
    public static AdvanceDesc Default() {
      var it = new AdvanceDesc();
      MpmException.Check(Native.mpm_advance_desc_init(&it, (uint)sizeof(AdvanceDesc)), IntPtr.Zero);
      return it;
    }
  }

  /// <summary>Seconds of wall-clock time spent in steps since creation or the last reset, by stage.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct Profile {
    /// <summary>sizeof(mpm_profile) of the caller.</summary>
    public uint struct_size;
    /// <summary>0.</summary>
    public int reserved;
    /// <summary>sorting particles, activating nodes.</summary>
    public double sort;
    /// <summary>weights, particles to grid.</summary>
    public double p2g;
    /// <summary>nodal update, walls, prescribed velocities.</summary>
    public double grid;
    /// <summary>grid to particles.</summary>
    public double g2p;
    /// <summary>laws within g2p and assembly, from samples; their tangents are in assembly.</summary>
    public double law;
    /// <summary>residual and matrix.</summary>
    public double assembly;
    /// <summary>factorisation, set-up of preconditioners.</summary>
    public double factor;
    /// <summary>linear solves.</summary>
    public double solve;
    /// <summary>the host's callbacks.</summary>
    public double callbacks;
    /// <summary>whole steps.</summary>
    public double total;
    /// <summary>weights of the basis within p2g and g2p, from samples.</summary>
    public double weights;

    /// <summary>Ready to be filled: zeros, and struct_size.</summary>
    public static Profile Empty() {
      var it = new Profile();
      it.struct_size = (uint)sizeof(Profile);
      return it;
    }
  }

  /// <summary>How two bodies meet.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct ContactDesc {
    /// <summary>sizeof(mpm_contact_desc) of the caller.</summary>
    public uint struct_size;
    /// <summary>an MPM_CONTACT_...; default MPM_CONTACT_UNILATERAL.</summary>
    public int kind;
    /// <summary>an MPM_NORMAL_...; default MPM_NORMAL_LOGISTIC.</summary>
    public int normal;
    /// <summary>an MPM_DETECT_...; default MPM_DETECT_DEFAULT.</summary>
    public int detection;
    /// <summary>Coulomb's coefficient of sliding, &gt;= 0; default 0.</summary>
    public double friction;
    /// <summary>that of sticking, &gt;= friction; 0 (default): the same as friction.</summary>
    public double friction_static;
    /// <summary>largest tensile traction while the gap is closed, stress, &gt;= 0; default 0.</summary>
    public double adhesion;
    /// <summary>distance that the surfaces keep, length; &lt; 0: overlap is let be; default 0.</summary>
    public double offset;
    /// <summary>MPM_NORMAL_FIXED: unit normal, from the first body to the second.</summary>
    public fixed double direction[3];

    /// <summary>The library's defaults.</summary>
    public static ContactDesc Default() {
      var it = new ContactDesc();
      MpmException.Check(Native.mpm_contact_desc_init(&it, (uint)sizeof(ContactDesc)), IntPtr.Zero);
      return it;
    }
  }

  /// <summary>What two bodies did to each other in the last step, and since then.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct ContactInfo {
    /// <summary>sizeof(mpm_contact_info) of the caller.</summary>
    public uint struct_size;
    /// <summary>1: an impulse was given.</summary>
    public int touching;
    /// <summary>nodes at which both have mass.</summary>
    public long nodes;
    /// <summary>of these, with an impulse.</summary>
    public long closed;
    /// <summary>of these, without slip.</summary>
    public long stuck;
    /// <summary>nodes that were left out: there is no normal, or both bodies are held.</summary>
    public long ambiguous;
    /// <summary>on the second body, force.</summary>
    public fixed double force[3];
    /// <summary>of the same about the origin; in 2-D in component 2; of MPM_AXISYMMETRIC without meaning.</summary>
    public fixed double torque[3];
    /// <summary>sum of the nodes' normal forces, &gt;= 0 without adhesion.</summary>
    public double normal_force;
    /// <summary>of closed nodes, length^(dim - 1); of MPM_AXISYMMETRIC times radius.</summary>
    public double area;
    /// <summary>largest normal force over area of a node, stress: rows of nodes on both sides of a surface share them
    /// unevenly, and it may be twice what the surface has.</summary>
    public double pressure_max;
    /// <summary>smallest gap that was measured, length; &lt; 0: overlap; infinity if none was.</summary>
    public double gap;
    /// <summary>friction and closing in the step; see contact_dissipation of mpm_step_info.</summary>
    public double dissipation;
    /// <summary>of it, by friction.</summary>
    public double friction_work;
    /// <summary>on the second body over all committed steps since the stepper was made or mpm_stepper_set_time() was
    /// called, mass length/time.</summary>
    public fixed double impulse[3];

    /// <summary>Ready to be filled: zeros, and struct_size.</summary>
    public static ContactInfo Empty() {
      var it = new ContactInfo();
      it.struct_size = (uint)sizeof(ContactInfo);
      return it;
    }
  }

  /// <summary>Nodes at which two bodies touch, for mpm_friction_fn.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct ContactBatch {
    /// <summary>sizeof(mpm_contact_batch) of the library; see mpm.h.</summary>
    public uint struct_size;
    /// <summary>dimension of the grid.</summary>
    public int dim;
    /// <summary>the first body, the lower number.</summary>
    public int body_a;
    /// <summary>the second body.</summary>
    public int body_b;
    /// <summary>number of nodes.</summary>
    public long n;
    /// <summary>distance from component c to c + 1, in elements; &gt;= n.</summary>
    public long ld;
    /// <summary>time at the start of the step.</summary>
    public double t;
    /// <summary>size of the step.</summary>
    public double dt;
    /// <summary>[dim][ld] of the nodes.</summary>
    public double* position;
    /// <summary>[dim][ld] unit normal, from the first body to the second.</summary>
    public double* normal;
    /// <summary>[ld] length.</summary>
    public double* gap;
    /// <summary>[ld] length^(dim - 1); of MPM_AXISYMMETRIC times radius.</summary>
    public double* area;
    /// <summary>[dim][ld] tangential velocity of the second body relative to the first, before the impulse.</summary>
    public double* slip;
    /// <summary>[ld] normal traction of the frictionless impulse, stress.</summary>
    public double* pressure;
  }

  /// <summary>Points whose distance from an obstacle is asked for.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct DistanceBatch {
    /// <summary>sizeof(mpm_distance_batch) of the library; see mpm.h.</summary>
    public uint struct_size;
    /// <summary>dimension of the grid.</summary>
    public int dim;
    /// <summary>number of points.</summary>
    public long n;
    /// <summary>distance from component c to c + 1, in elements; &gt;= n.</summary>
    public long ld;
    /// <summary>time at the start of the step; in implicit steps with contact a second time that at its end, for
    /// particles and the pose of that time.</summary>
    public double t;
    /// <summary>[dim][ld].</summary>
    public double* position;
    /// <summary>[ld] to be set: signed distance, &gt; 0 outside.</summary>
    public double* distance;
    /// <summary>[dim][ld] to be set: unit gradient of the distance.</summary>
    public double* normal;
    /// <summary>[dim][ld] preset to 0: of the surface there, beside the rigid motion.</summary>
    public double* velocity;
  }

  /// <summary>An obstacle.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct ObstacleDesc {
    /// <summary>sizeof(mpm_obstacle_desc) of the caller.</summary>
    public uint struct_size;
    /// <summary>an MPM_SHAPE_...; no default.</summary>
    public int shape;
    /// <summary>an MPM_MOTION_...; default MPM_MOTION_FIXED.</summary>
    public int motion;
    /// <summary>1: the material is inside (drum, container); default 0.</summary>
    public int inside;
    /// <summary>see MPM_SHAPE_PLANE ..., length.</summary>
    public fixed double size[3];
    /// <summary>of the centre, which of a free one is that of mass.</summary>
    public fixed double position[3];
    /// <summary>unit quaternion w, x, y, z that turns axes of the body into those of space; default 1, 0, 0,
    /// 0.</summary>
    public fixed double orientation[4];
    /// <summary>of the centre; default 0.</summary>
    public fixed double velocity[3];
    /// <summary>in space, 1/time; in 2-D component 2; default 0.</summary>
    public fixed double angular_velocity[3];
    /// <summary>of a free one, &gt; 0; in 2-D per depth, in 1-D per area.</summary>
    public double mass;
    /// <summary>of a free one: tensor about the centre in axes of the body, row by row, symmetric and positive
    /// definite; in 2-D component 8 alone; not in 1-D.</summary>
    public fixed double inertia[9];
    /// <summary>kind, friction, friction_static, adhesion and offset count: how it meets the material.</summary>
    public ContactDesc* contact;
    /// <summary>of MPM_SHAPE_DISTANCE.</summary>
    public IntPtr distance;
    /// <summary>its first argument.</summary>
    public IntPtr user;
    /// <summary>of MPM_SHAPE_DISTANCE, in axes of the body from its centre: the obstacle and all.</summary>
    public fixed double lower[3];
    /// <summary>within two spacings of it lie in this box.</summary>
    public fixed double upper[3];

    /// <summary>The library's defaults.</summary>
    public static ObstacleDesc Default() {
      var it = new ObstacleDesc();
      MpmException.Check(Native.mpm_obstacle_desc_init(&it, (uint)sizeof(ObstacleDesc)), IntPtr.Zero);
      return it;
    }
  }

  /// <summary>Loads of all markers of a surface, and what it prescribes.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct SurfaceDesc {
    /// <summary>sizeof(mpm_surface_desc) of the caller.</summary>
    public uint struct_size;
    /// <summary>velocity field that it loads and moves with (mpm_stepper_set_body()); default 0.</summary>
    public int body;
    /// <summary>force/area against the normal, on the present area: it follows the surface.</summary>
    public double pressure;
    /// <summary>force per present area, in a fixed direction.</summary>
    public fixed double traction[3];
    /// <summary>force per area at the time when the marker was added: a dead load.</summary>
    public fixed double dead_traction[3];
    /// <summary>Length &gt; 0: markers with a longer edge are split in two at the end of a step, so that a surface
    /// that stretches has no dents.</summary>
    public double max_spacing;
    /// <summary>MPM_PRESCRIBES_...: what of the motion of the material the markers prescribe.</summary>
    public int prescribes;
    /// <summary>0.</summary>
    public int reserved;
    /// <summary>length/time: how the markers of a surface that prescribes move.</summary>
    public fixed double velocity[3];
    /// <summary>implicit steps: stiffness of the springs in modulus / spacing, &gt; 0; default 100.</summary>
    public double penalty;
    /// <summary>Implicit steps, force/area &gt;= 0: the modulus of the springs.</summary>
    public double modulus;

    /// <summary>The library's defaults.</summary>
    public static SurfaceDesc Default() {
      var it = new SurfaceDesc();
      MpmException.Check(Native.mpm_surface_desc_init(&it, (uint)sizeof(SurfaceDesc)), IntPtr.Zero);
      return it;
    }
  }

  /// <summary>Markers for which tractions are wanted.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct MarkerBatch {
    /// <summary>sizeof(mpm_marker_batch) of the library; see mpm.h.</summary>
    public uint struct_size;
    /// <summary>dimension of the grid.</summary>
    public int dim;
    /// <summary>number of markers.</summary>
    public long n;
    /// <summary>distance from component c to c + 1, in elements; &gt;= n.</summary>
    public long ld;
    /// <summary>time for which the value is wanted: the start of the step, or the end of an implicit one.</summary>
    public double t;
    /// <summary>size of the step.</summary>
    public double dt;
    /// <summary>[ld] ids, ascending.</summary>
    public long* id;
    /// <summary>[dim][ld].</summary>
    public double* position;
    /// <summary>[dim][ld] area vectors.</summary>
    public double* area;
    /// <summary>[ld] area when the marker was added.</summary>
    public double* reference_area;
    /// <summary>[dim][ld] since the marker was added.</summary>
    public double* displacement;
    /// <summary>[dim][ld] of the material there, in the last step.</summary>
    public double* velocity;
  }

  /// <summary>Particles that are to be split, or pairs that are to be merged.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct AdaptionBatch {
    /// <summary>sizeof(mpm_adaption_batch) of the library; see mpm.h.</summary>
    public uint struct_size;
    /// <summary>MPM_ADAPT_SPLIT or MPM_ADAPT_MERGE.</summary>
    public int what;
    /// <summary>how many.</summary>
    public long n;
    /// <summary>distance from component c to c + 1 of position, in elements; &gt;= n.</summary>
    public long ld;
    /// <summary>dimension of the grid.</summary>
    public int dim;
    /// <summary>0.</summary>
    public int reserved;
    /// <summary>[ld] ids, ascending; of pairs that of the particle that stays.</summary>
    public long* id;
    /// <summary>[ld] ids of the particles that go; NULL where particles are split.</summary>
    public long* other;
    /// <summary>[dim][ld] of the particle, or of the one that stays.</summary>
    public double* position;
  }

  /// <summary>How a set adapts.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct AdaptionDesc {
    /// <summary>sizeof(mpm_adaption_desc) of the caller.</summary>
    public uint struct_size;
    /// <summary>steps from one adaption to the next; default 10; 0: by mpm_stepper_adapt() alone.</summary>
    public int every;
    /// <summary>Edges of domains that are longer than this are halved.</summary>
    public double split_edge;
    /// <summary>No edge becomes shorter than this by splitting.</summary>
    public double least_edge;
    /// <summary>In a cell that has particles, but fewer of the set than this, they are split along their longest
    /// edges until there are so many.</summary>
    public int min_per_cell;
    /// <summary>In a cell with more particles of the set pairs are merged until there are so many: in the order of
    /// ids, each particle with the nearest that is alike.</summary>
    public int max_per_cell;
    /// <summary>Pairs lie no further apart than this.</summary>
    public double merge_distance;
    /// <summary>Pairs are alike when their deformation gradients differ by at most this share of the larger one, in
    /// the norm of Frobenius, their stresses by this share of density c^2, and their velocities by this share of c,
    /// the wave speed of the law; with laws of the host, stresses by this share of the larger one, and velocities are
    /// not looked at.</summary>
    public double merge_tolerance;
    /// <summary>Nothing is split beyond this number of particles in the set.</summary>
    public long most_particles;
    /// <summary>NULL (default): all are accepted.</summary>
    public IntPtr accept;
    /// <summary>is passed to accept.</summary>
    public IntPtr user;

    /// <summary>The library's defaults.</summary>
    public static AdaptionDesc Default() {
      var it = new AdaptionDesc();
      MpmException.Check(Native.mpm_adaption_desc_init(&it, (uint)sizeof(AdaptionDesc)), IntPtr.Zero);
      return it;
    }
  }

  /// <summary>What adaption has done to a set, in all steps since it was first described for it or the time was
  /// set.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct AdaptionInfo {
    /// <summary>sizeof(mpm_adaption_info) of the caller.</summary>
    public uint struct_size;
    /// <summary>0.</summary>
    public int reserved;
    /// <summary>particles that were split.</summary>
    public long splits;
    /// <summary>particles that came by it.</summary>
    public long added;
    /// <summary>pairs that became one.</summary>
    public long merges;
    /// <summary>kinetic energy before, less that after: &gt;= 0 of merges; splits with a matrix &lt; 0.</summary>
    public double kinetic_loss;
    /// <summary>the same of the matrices: what they give to velocities, and what is lost.</summary>
    public double affine_loss;
    /// <summary>the same of the strain energy, in merges; laws of the host are not counted.</summary>
    public double strain_loss;
    /// <summary>Angular momentum before, less that after: of merges without a matrix. 0 of
    /// MPM_AXISYMMETRIC.</summary>
    public fixed double angular_momentum_loss[3];

    /// <summary>Ready to be filled: zeros, and struct_size.</summary>
    public static AdaptionInfo Empty() {
      var it = new AdaptionInfo();
      it.struct_size = (uint)sizeof(AdaptionInfo);
      return it;
    }
  }

  /// <summary>The heat of a set.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct HeatDesc {
    /// <summary>sizeof(mpm_heat_desc) of the caller.</summary>
    public uint struct_size;
    /// <summary>0.</summary>
    public int reserved;
    /// <summary>energy / (mass temperature), &gt; 0.</summary>
    public double specific_heat;
    /// <summary>power / (length temperature), &gt;= 0.</summary>
    public double conductivity;
    /// <summary>linear, 1/temperature.</summary>
    public double expansion;
    /// <summary>T0, at which F = I is free of stress.</summary>
    public double reference_temperature;
    /// <summary>Share of the work that the material dissipates which becomes heat, 0 to 1.</summary>
    public double dissipated_share;
    /// <summary>NULL (default): there is none.</summary>
    public IntPtr source;
    /// <summary>is passed to source.</summary>
    public IntPtr user;

    /// <summary>The library's defaults.</summary>
    public static HeatDesc Default() {
      var it = new HeatDesc();
      MpmException.Check(Native.mpm_heat_desc_init(&it, (uint)sizeof(HeatDesc)), IntPtr.Zero);
      return it;
    }
  }

  /// <summary>Where heat came from, in the last step and in all steps since the first set was described or the time
  /// was set: gained = sum of walls + sources + surfaces + dissipated, to rounding, and with implicit conduction to
  /// the tolerance.</summary>
  [StructLayout(LayoutKind.Sequential)]
  public unsafe partial struct HeatInfo {
    /// <summary>sizeof(mpm_heat_info) of the caller.</summary>
    public uint struct_size;
    /// <summary>of the last step's conjugate gradients.</summary>
    public int iterations;
    /// <summary>sum of mass specific_heat temperature now, of all sets that are described.</summary>
    public double heat;
    /// <summary>what particles took up in the last step.</summary>
    public double gained;
    /// <summary>through the faces, from MPM_X_MIN, into the material.</summary>
    public fixed double walls[6];
    /// <summary>of the callbacks.</summary>
    public double sources;
    /// <summary>through surfaces, into the material.</summary>
    public double surfaces;
    /// <summary>dissipated work that became heat.</summary>
    public double dissipated;
    /// <summary>the same in all steps, and so with those below.</summary>
    public double gained_total;
    /// <summary>through the faces.</summary>
    public fixed double walls_total[6];
    /// <summary>of the callbacks.</summary>
    public double sources_total;
    /// <summary>through surfaces.</summary>
    public double surfaces_total;
    /// <summary>dissipated work.</summary>
    public double dissipated_total;

    /// <summary>Ready to be filled: zeros, and struct_size.</summary>
    public static HeatInfo Empty() {
      var it = new HeatInfo();
      it.struct_size = (uint)sizeof(HeatInfo);
      return it;
    }
  }

  /// <summary>The functions of C.</summary>
  public static unsafe class Native {
#if MPM_STATIC // the library is part of the program, as Unity has it on iOS and WebGL
    public const string Library = "__Internal";
#else
    public const string Library = "mpm";
#endif
    /// <summary>Version of the headers that this was made from, to be compared with mpm_version().</summary>
    public const uint Version = 0x000100;

    /// <summary>The version of the library that runs, as 0xMMmmpp, to be compared with MPM_VERSION.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern uint mpm_version();

    /// <summary>The name of a status constant, such as "MPM_E_ARG", or "unknown status" for any other
    /// value.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern IntPtr mpm_status_name(int status);

    /// <summary>What a status says, in a sentence without names and values: for calls that have no context to keep a
    /// text, as those on NULL.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern IntPtr mpm_status_text(int status);

    /// <summary>Gives back the memory of a view that mpm_particles_map() or mpm_grid_map() filled.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_view_release(View* view);

    /// <summary>Number of this part and how many there are; 0 and 1 without a transport.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_context_part(IntPtr context, int* part, int* parts);

    /// <summary>Particles of a set on all parts (collective). mpm_particles_count() is that of this part.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_total(IntPtr particles, long* n);

    /// <summary>Fills desc with the defaults. struct_size is sizeof(mpm_balance_desc) of the caller; no byte beyond
    /// is written.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_balance_desc_init(BalanceDesc* desc, uint struct_size);

    /// <summary>Sets how blocks are given to parts, from the next sort of particles on (collective); desc NULL: by
    /// the defaults.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_set_balance(IntPtr stepper, BalanceDesc* desc);

    /// <summary>Tells what this part does, as of the last step; 1 in reset starts the counts anew.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_parallel_info(IntPtr stepper, int reset, ParallelInfo* info);

    /// <summary>Tells how many bytes mpm_particles_pack() needs for n particles of the set, with the fields that it
    /// has now.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_packed_size(IntPtr particles, long n, long* bytes);

    /// <summary>Packs n particles into a buffer, for hosts that move them themselves: between sets, programs,
    /// machines.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_pack(IntPtr particles, long n, long* ids, IntPtr buffer, long capacity);

    /// <summary>Adds packed particles to a set, bit by bit: all or none.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_unpack(IntPtr particles, IntPtr buffer, long bytes);

    /// <summary>Fills desc with the defaults. struct_size is sizeof(mpm_context_desc) of the caller; no byte beyond
    /// is written.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_context_desc_init(ContextDesc* desc, uint struct_size);

    /// <summary>Makes a context. desc is copied and may be NULL for the defaults. *out is NULL unless MPM_OK is
    /// returned.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_context_create(ContextDesc* desc, IntPtr* @out);

    /// <summary>Tells how many bytes the context and its objects hold now, and the most that they ever
    /// held.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_context_memory(IntPtr context, long* bytes, long* peak_bytes);

    /// <summary>Ends the pool and frees the context.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_context_destroy(IntPtr context);

    /// <summary>Gives one or two sentences, with the offending names and values, on the last call on this context or
    /// its objects that did not return MPM_OK.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern IntPtr mpm_last_error(IntPtr context);

    /// <summary>Makes text the sentence of mpm_last_error() and returns status: for libraries that stand on this one
    /// and refuse a call of their own on a context, as mpm_umat.h does. text is copied, and cut after some 1000
    /// bytes.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_set_last_error(IntPtr context, int status, byte* text);

    /// <summary>Fills desc with the defaults; cells and spacing are 0, and the host must set them. struct_size is
    /// sizeof(mpm_grid_desc) of the caller; no byte beyond is written.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_grid_desc_init(GridDesc* desc, uint struct_size);

    /// <summary>Makes a grid. desc is copied.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_grid_create(IntPtr context, GridDesc* desc, IntPtr* @out);

    /// <summary>Frees the grid.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_grid_destroy(IntPtr grid);

    /// <summary>Makes a material from a built-in law.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_material_create(IntPtr context, byte* model, Param* @params, int count, IntPtr*
        @out);

    /// <summary>The number of built-in laws.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_material_model_count();

    /// <summary>The name of the built-in law with number index, 0 &lt;= index &lt; mpm_material_model_count(), or
    /// NULL for another index.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern IntPtr mpm_material_model_name(int index);

    /// <summary>Describes the parameter with number index (from 0) of a built-in law: its name, its unit as a
    /// dimension (such as "stress"), one line of text, its default (NaN if it must be given) and its range [low,
    /// high].</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_material_model_param(byte* model, int index, byte** name, byte** unit, byte** text,
        double* value_default, double* low, double* high);

    /// <summary>The number of state variables of a particle of a built-in law, or -1 where there is no such
    /// model.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_material_state_count(byte* model);

    /// <summary>Describes the state variable with number index (from 0) of a built-in law: its name, such as
    /// "plastic_strain", its unit as a dimension and one line of text.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_material_state_name(byte* model, int index, byte** name, byte** unit, byte** text);

    /// <summary>Lends a field of the set that a batch belongs to, built in or the host's own.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_batch_field(IntPtr lookup, byte* field, IntPtr* data, long* component_stride);

    /// <summary>Fills desc with the defaults; the host must set density and stress. struct_size is
    /// sizeof(mpm_material_desc) of the caller; no byte beyond is written.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_material_desc_init(MaterialDesc* desc, uint struct_size);

    /// <summary>Makes a material from a law of the host. desc is copied. *out is NULL unless MPM_OK is
    /// returned.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_material_create_custom(IntPtr context, MaterialDesc* desc, IntPtr* @out);

    /// <summary>Runs a material, built in or the host's, without a grid: what a step does to its particles, for n
    /// items of the caller.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_material_update(IntPtr material, MaterialBatch* batch, double* tangent, int*
        symmetric);

    /// <summary>Frees the material and calls release_user.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_material_destroy(IntPtr material);

    /// <summary>Makes an empty set on a grid, of one material; both outlive it. *out is NULL unless MPM_OK is
    /// returned.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_create(IntPtr context, IntPtr grid, IntPtr material, IntPtr* @out);

    /// <summary>Frees the set.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_destroy(IntPtr particles);

    /// <summary>Adds n particles with F = I, zero stress and the law's initial state: all or none.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_add(IntPtr particles, long n, double* position, double* velocity, double*
        volume, double* size, long* ids, long* first_id);

    /// <summary>Fills the box from lower[dim] to upper[dim] with particles at rest on a lattice aligned with the
    /// cells, with per_cell[dim] particles along each axis of a cell, wherever the centre is inside.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_fill_box(IntPtr particles, double* lower, double* upper, int* per_cell,
        long* first_id, long* count);

    /// <summary>Fills a ball (2-D: disc, 1-D: interval) around centre[dim] of a radius &gt; 0, as
    /// mpm_particles_fill_box() fills a box.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_fill_ball(IntPtr particles, double* centre, double radius, int* per_cell,
        long* first_id, long* count);

    /// <summary>Fills that part of a box which the callback accepts, as mpm_particles_fill_box() fills the
    /// whole.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_fill(IntPtr particles, double* lower, double* upper, int* per_cell,
        InsideFn inside, IntPtr user, long* first_id, long* count);

    /// <summary>Fills what a mesh encloses, as mpm_particles_fill_box() fills a box: triangles in 3-D, edges in
    /// 2-D.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_fill_mesh(IntPtr particles, long n, double* position, long elements, long*
        corner, int* per_cell, long* first_id, long* count);

    /// <summary>Removes the n particles with the given ids: all or none.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_remove(IntPtr particles, long n, long* ids);

    /// <summary>The number of particles, inert slots not counted; 0 for NULL.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern long mpm_particles_count(IntPtr particles);

    /// <summary>Describes the field with number index (from 0): its name, its type (MPM_F64, MPM_I64 or MPM_U8), the
    /// components of copies, and whether the host may write it.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_field_info(IntPtr particles, int index, byte** field, int* type, int*
        components, int* writable);

    /// <summary>Adds a field of the host, zero in every particle.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_add_field(IntPtr particles, byte* field, int type, int components);

    /// <summary>Says of a field of the host that its values are amounts, as mass is, and not densities: particles
    /// that are split share them, and merged ones have the sum.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_set_extensive(IntPtr particles, byte* field, int extensive);

    /// <summary>Lends a field in library order, with its stored components and with inert slots (id &lt; 0); a map of
    /// "id" tells which is which. access is MPM_READ, MPM_WRITE or both.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_map(IntPtr particles, byte* field, int access, View* view);

    /// <summary>Copies a field of n particles into out, [components][n] with ld = n; tensors are full. ids are [n],
    /// or NULL for all particles by ascending id, where n is mpm_particles_count(). type and components must match
    /// the full field, to guard the host's buffer.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_get(IntPtr particles, byte* field, int type, int components, long n, long*
        ids, IntPtr @out);

    /// <summary>Copies count named fields of all particles into floats for renderers: particles one after the other,
    /// without inert slots, of each the components of the first field, then those of the second, and so on.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_get_f32(IntPtr particles, int count, byte** fields, int order, long n,
        float* @out);

    /// <summary>Copies values into a field, laid out as in mpm_particles_get(): all or none.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_set(IntPtr particles, byte* field, int type, int components, long n, long*
        ids, IntPtr values);

    /// <summary>Sets a field to one value[components] in every particle of the set.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_set_all(IntPtr particles, byte* field, int type, int components, IntPtr
        value);

    /// <summary>Gives all particles the stress of ground at rest below a level surface: along `axis` the pressure of
    /// the weight above, surcharge + density * |gravity| * depth with the material's density, and K0 times that
    /// across it; no shear.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_set_geostatic(IntPtr particles, int axis, double gravity, double surface,
        double K0, double surcharge);

    /// <summary>Makes the present state the one from which all deformation counts: deformation_gradient becomes I,
    /// initial_volume the present volume, dilation_ratio 1, and reference_position, where there is one, the present
    /// (unwrapped) position.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_particles_reset_reference(IntPtr particles);

    /// <summary>Describes the system.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_operator_get_info(IntPtr matrix, OperatorInfo* info);

    /// <summary>Computes y = matrix * x on owned rows.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_operator_apply(IntPtr matrix, double* x, double* y);

    /// <summary>Lends the matrix by compressed rows, with both triangles and with columns in ascending order: row r
    /// has the entries (*row_start)[r] to (*row_start)[r + 1] - 1 of *column and *value.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_operator_csr(IntPtr matrix, long** row_start, int** column, double** value);

    /// <summary>Fills desc with the defaults. struct_size is sizeof(mpm_stepper_desc) of the caller; no byte beyond
    /// is written.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_desc_init(StepperDesc* desc, uint struct_size);

    /// <summary>Makes a stepper at t = 0 and step 0, without sets, with MPM_WALL_NONE on all faces (the axis of
    /// MPM_AXISYMMETRIC has MPM_WALL_SLIP). desc is copied and may be NULL for the defaults.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_create(IntPtr context, IntPtr grid, StepperDesc* desc, IntPtr* @out);

    /// <summary>Frees the stepper.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_destroy(IntPtr stepper);

    /// <summary>Adds a set to the time loop.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_add(IntPtr stepper, IntPtr particles);

    /// <summary>Takes a set out of the time loop.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_remove(IntPtr stepper, IntPtr particles);

    /// <summary>Replaces the options between steps.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_configure(IntPtr stepper, StepperDesc* desc);

    /// <summary>Sets the time and the number of steps counted.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_set_time(IntPtr stepper, double t, long step);

    /// <summary>Moves the prescribed particles of a set (platens, pistons). mean_velocity (mt) is called at the start
    /// of a step for the particles of the set, unless none is prescribed, and adds the mean velocity u of the coming
    /// step to zeros; what it gives to other particles is ignored.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_set_motion(IntPtr stepper, IntPtr particles, ParticleFn mean_velocity, IntPtr
        user);

    /// <summary>Sets what a face (MPM_X_MIN to MPM_Z_MAX) does: kind is one of MPM_WALL_NONE to
    /// MPM_WALL_FRICTION_NODES. friction is the Coulomb coefficient, &gt;= 0, of the last two, and is not used
    /// otherwise.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_set_wall(IntPtr stepper, int face, int kind, double friction);

    /// <summary>Sets the callback that adds accelerations of particles, length/time^2 (b of MPoint theory, eq.
    /// 21).</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_set_acceleration(IntPtr stepper, ParticleFn fn, IntPtr user);

    /// <summary>Sets the callback that adds forces on particles, mass length/time^2 (f^app of MPoint theory, eq.
    /// 21).</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_set_force(IntPtr stepper, ParticleFn fn, IntPtr user);

    /// <summary>Sets the callback that prescribes nodal velocities, length/time.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_set_velocity_bc(IntPtr stepper, VelocityFn fn, IntPtr user);

    /// <summary>Sets the hook of a stage, one of MPM_AFTER_P2G to MPM_AFTER_VELOCITY.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_set_node_hook(IntPtr stepper, int stage, NodeFn fn, IntPtr user);

    /// <summary>Sets the solver of MPM_SOLVER_HOST: see operator.h.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_set_linear_solver(IntPtr stepper, SolveFn fn, IntPtr user);

    /// <summary>Sets the progress callback, which runs on the calling thread.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_set_progress(IntPtr stepper, ProgressFn fn, IntPtr user);

    /// <summary>Gives the stable dt of an explicit step from the present state, at CFL number 1 (MPoint theory, eqs
    /// 45-46): 1 / max over particles and axes of (|v_k| + c) / h_k, where c is the law's current wave speed, and at
    /// most h^2 / (2 dim nu) where a law reports a kinematic viscosity nu; h is the smallest spacing.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stable_dt(IntPtr stepper, double* dt);

    /// <summary>Makes one step of size dt &gt; 0.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_step(IntPtr stepper, double dt, StepInfo* info);

    /// <summary>Fills desc with the defaults; the host must set t_end. struct_size is sizeof(mpm_advance_desc) of the
    /// caller; no byte beyond is written.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_advance_desc_init(AdvanceDesc* desc, uint struct_size);

    /// <summary>Steps to t_end exactly.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_advance(IntPtr stepper, AdvanceDesc* desc, StepInfo* info);

    /// <summary>Copies the times into out, then sets them to zero if reset is not 0.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_profile(IntPtr stepper, int reset, Profile* @out);

    /// <summary>Gives the info of the state as it is, also before the first step.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_info(IntPtr stepper, StepInfo* info);

    /// <summary>Gives the history of the last implicit step: ||residual|| / scale (the scale includes reactions) from
    /// before the first solve to the converged or failed end. *count tells how many values there are; the first
    /// capacity of them are copied into residual, which may be NULL when capacity is 0.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_residuals(IntPtr stepper, int capacity, double* residual, int* count);

    /// <summary>Makes the first part of an explicit step in parts: particles to grid, and forces.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_step_begin(IntPtr stepper, double dt);

    /// <summary>Makes the second part: nodal velocities, walls, prescribed velocities.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_step_grid(IntPtr stepper);

    /// <summary>Makes the last part: grid to particles, stress, commit. info may be NULL.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_step_end(IntPtr stepper, StepInfo* info);

    /// <summary>Drops the step that was begun; particles and time are as before it.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_step_abort(IntPtr stepper);

    /// <summary>Lends a field of the active nodes: of a staged step while one is under way, of the last step
    /// otherwise.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_grid_map(IntPtr stepper, int body, byte* field, int access, View* view);

    /// <summary>Gives the force[dim] that the wall at a face exerts on the material: the mean over the last step, or
    /// with MPM_NEWMARK the one at its end, but for friction walls.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_wall_reaction(IntPtr stepper, int face, double* force);

    /// <summary>Gives the force[dim] that the prescribed particles of a set exert on the material, on the axes on
    /// which they are prescribed: the mean over the last step, or with MPM_NEWMARK the one at its end.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_particles_reaction(IntPtr stepper, IntPtr prescribed, double* force);

    /// <summary>Gives the impulse[dim] of the wall at a face on the material, mass * length/time: the sum of
    /// mpm_stepper_wall_reaction() times the time over which it acted, over all committed steps since the stepper was
    /// made or mpm_stepper_set_time() was called; 0 before the first.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_wall_impulse(IntPtr stepper, int face, double* impulse);

    /// <summary>Gives the impulse[dim] of the prescribed particles of a set on the material, the sum of
    /// mpm_stepper_particles_reaction() in the same way.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_particles_impulse(IntPtr stepper, IntPtr prescribed, double* impulse);

    /// <summary>Puts a set into a body: 0 &lt;= body &lt; 4096, at first 0.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_set_body(IntPtr stepper, IntPtr particles, int body);

    /// <summary>Gives the body of a set.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_body(IntPtr stepper, IntPtr particles, int* body);

    /// <summary>Fills desc with the defaults. struct_size is sizeof(mpm_contact_desc) of the caller; no byte beyond
    /// is written.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_contact_desc_init(ContactDesc* desc, uint struct_size);

    /// <summary>Sets how two bodies meet; desc is copied.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_set_contact(IntPtr stepper, int body_a, int body_b, ContactDesc* desc);

    /// <summary>Sets the callback for coefficients of friction.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_set_friction(IntPtr stepper, FrictionFn fn, IntPtr user);

    /// <summary>Gives what two bodies did in the last step; for body_a MPM_BODY_ANY the sum over all others, on
    /// body_b; the other way round what they suffered.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_contact_info(IntPtr stepper, int body_a, int body_b, ContactInfo* info);

    /// <summary>Fills desc with the defaults. struct_size is sizeof(mpm_obstacle_desc) of the caller; no byte beyond
    /// is written.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_obstacle_desc_init(ObstacleDesc* desc, uint struct_size);

    /// <summary>Makes an obstacle.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_obstacle_create(IntPtr context, ObstacleDesc* desc, IntPtr* @out);

    /// <summary>Frees an obstacle; NULL is let pass.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_obstacle_destroy(IntPtr obstacle);

    /// <summary>Puts an obstacle into a stepper, with those that are there in the order of adding.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_add_obstacle(IntPtr stepper, IntPtr obstacle);

    /// <summary>Takes an obstacle out, and what it has reported.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_remove_obstacle(IntPtr stepper, IntPtr obstacle);

    /// <summary>Sets how an obstacle moves in each step, for MPM_MOTION_PRESCRIBED (MPM_E_UNSUPPORTED with
    /// others).</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_obstacle_set_motion(IntPtr obstacle, MotionFn fn, IntPtr user);

    /// <summary>Sets how an obstacle meets the material, as mpm_obstacle_desc.contact does.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_obstacle_set_contact(IntPtr obstacle, ContactDesc* contact);

    /// <summary>Puts an obstacle somewhere: position[3], orientation[4], velocity[3] and angular_velocity[3] as in
    /// mpm_obstacle_desc, each NULL to keep it.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_obstacle_set_pose(IntPtr obstacle, double* position, double* orientation, double*
        velocity, double* angular_velocity);

    /// <summary>Gives where an obstacle is and how it moves; each may be NULL.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_obstacle_get_pose(IntPtr obstacle, double* position, double* orientation, double*
        velocity, double* angular_velocity);

    /// <summary>Sets the force[3] and the torque[3] about its centre that act on a free obstacle beside gravity and
    /// contact, until they are set anew; each NULL to keep it.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_obstacle_set_load(IntPtr obstacle, double* force, double* torque);

    /// <summary>Gives what a body and an obstacle did to each other in the last step; body MPM_BODY_ANY: all of them.
    /// force and impulse are on the material, -force is on the obstacle; torque is that on the obstacle, about its
    /// centre; nodes are those that could be constrained.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_obstacle_contact_info(IntPtr obstacle, int body, ContactInfo* info);

    /// <summary>Fills desc with the defaults. struct_size is sizeof(mpm_surface_desc) of the caller; no byte beyond
    /// is written.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_surface_desc_init(SurfaceDesc* desc, uint struct_size);

    /// <summary>Makes a surface without markers on a grid, which outlives it. desc is copied and may be NULL for the
    /// defaults. *out is NULL unless MPM_OK is returned.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_surface_create(IntPtr context, IntPtr grid, SurfaceDesc* desc, IntPtr* @out);

    /// <summary>Frees a surface; NULL is let pass.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_surface_destroy(IntPtr surface);

    /// <summary>Replaces loads and options between steps.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_surface_configure(IntPtr surface, SurfaceDesc* desc);

    /// <summary>Sets the callback that adds tractions.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_surface_set_traction(IntPtr surface, TractionFn fn, IntPtr user);

    /// <summary>Sets the callback that adds to the velocities with which a surface that prescribes moves.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_surface_set_velocity(IntPtr surface, MarkerVelocityFn fn, IntPtr user);

    /// <summary>Adds n markers.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_surface_add(IntPtr surface, long n, double* position, double* area, long* first_id);

    /// <summary>Adds markers along the line through n points, position[2][n]; closed 1: back to the first.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_surface_add_polyline(IntPtr surface, long n, double* position, int closed, double
        spacing, long* first_id, long* count);

    /// <summary>Adds markers on triangles: position[3][n] of their corners, and corner[3 * i], corner[3 * i + 1],
    /// corner[3 * i + 2] the numbers of those of triangle i, counter-clockwise as seen from outside the
    /// material.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_surface_add_triangles(IntPtr surface, long n, double* position, long triangles, long*
        corner, double spacing, long* first_id, long* count);

    /// <summary>Removes the n markers with the given ids: all or none.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_surface_remove(IntPtr surface, long n, long* ids);

    /// <summary>Splits markers until no edge is longer than spacing &gt; 0: total area, its moment and the loads are
    /// kept, but for the moment where a half would lie beyond a face of the grid: it is put onto the face.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_surface_refine(IntPtr surface, double spacing, long* added);

    /// <summary>The number of markers; 0 for NULL.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern long mpm_surface_count(IntPtr surface);

    /// <summary>Copies a field of n markers into out, [components][n]. ids are [n], or NULL for all markers by
    /// ascending id, where n is mpm_surface_count(). type and components must match the field. | field             |
    /// type | components | what it is                                              | set |
    /// |-------------------|------|------------|---------------------------------------------------------|-----| |
    /// "id"              | I64  | 1          |                                                         |     | |
    /// "position"        | F64  | dim        | length                                                  | yes | |
    /// "area"            | F64  | dim        | area vector, out of the material                        | yes | |
    /// "reference_area"  | F64  | 1          | area when it was added or set                           |     | |
    /// "displacement"    | F64  | dim        | since it was added, across periodic axes too            | yes | |
    /// "velocity"        | F64  | dim        | of the material there, in the last step                 |     | |
    /// "force"           | F64  | dim        | on the material, in the last step                       |     | |
    /// "pressure"        | F64  | 1          | of this marker, beside mpm_surface_desc.pressure        | yes | |
    /// "traction"        | F64  | dim        | likewise                                                | yes | |
    /// "dead_traction"   | F64  | dim        | likewise                                                | yes | |
    /// "prescribed_velocity" | F64 | dim     | of this marker, beside mpm_surface_desc.velocity        | yes | |
    /// "reaction"        | F64  | dim        | force of what is prescribed on the material, last step  |     | |
    /// "gap"             | F64  | dim        | implicit steps: way of the material off what it should  |     |
    /// MPM_E_NOT_FOUND: there is no such field or id.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_surface_get(IntPtr surface, byte* field, int type, int components, long n, long* ids,
        IntPtr @out);

    /// <summary>Copies values into a field, laid out as in mpm_surface_get(): all or none.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_surface_set(IntPtr surface, byte* field, int type, int components, long n, long* ids,
        IntPtr values);

    /// <summary>Puts a surface into a stepper.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_add_surface(IntPtr stepper, IntPtr surface);

    /// <summary>Takes a surface out; it keeps its markers.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_remove_surface(IntPtr stepper, IntPtr surface);

    /// <summary>Gives the force[dim] by which what a surface prescribes acts on the material: the mean over the last
    /// step, the sum of "reaction" over the markers; 0 for a surface that prescribes nothing.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_surface_reaction(IntPtr stepper, IntPtr surface, double* force);

    /// <summary>Gives the impulse[dim] of it on the material, mass * length/time: the sum of
    /// mpm_stepper_surface_reaction() times the time over which it acted, over all committed steps since the surface
    /// was added or mpm_stepper_set_time() was called.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_surface_impulse(IntPtr stepper, IntPtr surface, double* impulse);

    /// <summary>Fills desc with the defaults. struct_size is sizeof(mpm_adaption_desc) of the caller; no byte beyond
    /// is written.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_adaption_desc_init(AdaptionDesc* desc, uint struct_size);

    /// <summary>Describes how a set of the stepper adapts, for the steps that follow; NULL: no longer.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_set_adaption(IntPtr stepper, IntPtr particles, AdaptionDesc* desc);

    /// <summary>Adapts all sets that are described, now and whatever `every` is.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_adapt(IntPtr stepper);

    /// <summary>Tells what adaption has done to a set.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_adaption_info(IntPtr stepper, IntPtr particles, AdaptionInfo* info);

    /// <summary>Fills desc with the defaults. struct_size is sizeof(mpm_heat_desc) of the caller; no byte beyond is
    /// written.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_heat_desc_init(HeatDesc* desc, uint struct_size);

    /// <summary>Describes the heat of a set of the stepper, for the steps that follow; NULL: it has none any more,
    /// and its fields stay as fields of the host.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_set_heat(IntPtr stepper, IntPtr particles, HeatDesc* desc);

    /// <summary>Chooses how the nodes conduct, from MPM_CONDUCTION_EXPLICIT (as made) on. tolerance: of the residual
    /// of conjugate gradients, relative to the right-hand side; &gt; 0 and &lt; 1; not read with explicit
    /// conduction.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_set_conduction(IntPtr stepper, int conduction, double tolerance);

    /// <summary>Says what a face does to heat, whatever kind of wall it has. kind: MPM_HEAT_WALL_...; the temperature
    /// is not read of insulated ones, which all faces are from the start.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_set_heat_wall(IntPtr stepper, int face, int kind, double temperature);

    /// <summary>Heats what lies below a surface, per area of its markers: flux + film (ambient - temperature of the
    /// material), power/area into the material; film is &gt;= 0.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_surface_set_heat(IntPtr surface, double flux, double film, double ambient);

    /// <summary>Tells where heat came from.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_stepper_heat_info(IntPtr stepper, HeatInfo* info);

    /// <summary>Tells how many bytes mpm_state_save() needs now; of several parts, those of this part's piece
    /// (collective).</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_state_size(IntPtr stepper, long* bytes);

    /// <summary>Writes the state into the host's buffer of capacity bytes; of several parts, this part's piece
    /// (collective).</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_state_save(IntPtr stepper, IntPtr buffer, long capacity);

    /// <summary>Replaces the state by one saved with mpm_state_save(), of so many bytes; the buffer is read during
    /// the call.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_state_load(IntPtr stepper, IntPtr buffer, long bytes);

    /// <summary>Replaces the state by one in pieces (collective).</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_state_load_pieces(IntPtr stepper, int count, IntPtr* piece, long* bytes);

    /// <summary>Writes the state into a file, as mpm_state_save() does into memory, and waits for the storage: path
    /// holds the old state or the new one.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_state_save_file(IntPtr stepper, byte* path);

    /// <summary>Gives the bytes of mpm_state_save() to a callback.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_state_save_to(IntPtr stepper, WriteFn write, IntPtr user);

    /// <summary>Replaces the state by one from a file.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_state_load_file(IntPtr stepper, byte* path);

    /// <summary>Gives a hash of time, step, every field of every set, the pose of every obstacle and every marker of
    /// surfaces.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_state_hash(IntPtr stepper, ulong* hash);

    /// <summary>Writes a set as VTK poly data (.vtp, appended raw): points in order of ascending id, and count named
    /// fields as point data, with full tensors and, in 2-D and 3-D, with three components per vector.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_write_particles(IntPtr particles, byte* path, int count, byte** fields);

    /// <summary>Gives the bytes of the file that mpm_write_particles() would write to a callback, with memory for one
    /// piece.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_write_particles_to(IntPtr particles, WriteFn write, IntPtr user, int count, byte**
        fields);

    /// <summary>Writes nodal fields of the last step, or of a staged step while one is under way, over the box of the
    /// active nodes: as VTK image data (.vti, appended raw), or with open knots, whose nodes are not evenly spaced at
    /// the faces, as a rectilinear grid (.vtr).</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_write_grid(IntPtr stepper, byte* path, int count, byte** fields);

    /// <summary>Does as mpm_write_grid() for the nodes of one body; that one writes those of body 0.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_write_body_grid(IntPtr stepper, int body, byte* path, int count, byte** fields);

    /// <summary>Gives the bytes of the file that mpm_write_body_grid() would write to a callback.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_write_grid_to(IntPtr stepper, int body, WriteFn write, IntPtr user, int count, byte**
        fields);

    /// <summary>Starts a series in a new file at path, where it replaces an old one. *out is NULL unless MPM_OK is
    /// returned.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_series_open(IntPtr context, byte* path, IntPtr* @out);

    /// <summary>Appends an output file to the series at time t. file is its path as it is to stand in the series:
    /// relative to the series' own file.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_series_append(IntPtr series, double t, byte* file);

    /// <summary>Ends the series and frees it.</summary>
    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
    public static extern int mpm_series_close(IntPtr series);
  }
}
