// The time loop, obstacles, surfaces, states and files.
using System;
using System.IO;
using System.Runtime.InteropServices;
using static Mpm.Constants;

namespace Mpm {
  /// <summary>A rigid body without particles.</summary>
  public sealed unsafe class Obstacle : Handle {
    /// <summary>Makes an obstacle; distance is that of MPM_SHAPE_DISTANCE.</summary>
    public Obstacle(Context context, ObstacleDesc desc, ContactDesc? contact = null, DistanceFunction distance = null)
        : base(Create(context, desc, contact, distance)) {}
    static Node Create(Context context, ObstacleDesc desc, ContactDesc? contact, DistanceFunction distance) {
      var node = new Node(context.node.Core, Native.mpm_obstacle_destroy, context.node);
      desc.struct_size = (uint)sizeof(ObstacleDesc);
      if (distance != null) {
        var slot = new Slot(node.Core, distance);
        node.Put("distance", slot);
        desc.distance = Trampolines.Address(Trampolines.Distance);
        desc.user = slot.User;
      }
      return Make(node, made => {
        var body = desc;
        var rule = contact ?? ContactDesc.Default();
        rule.struct_size = (uint)sizeof(ContactDesc);
        body.contact = contact.HasValue ? &rule : null;
        return Native.mpm_obstacle_create(context.Pointer, &body, made);
      });
    }
    /// <summary>Sets how it moves in each step; null: it keeps its velocities.</summary>
    public void SetMotion(MotionFunction motion) {
      var slot = motion == null ? null : new Slot(node.Core, motion);
      Stepper.Install(this, "motion", slot, p => Native.mpm_obstacle_set_motion(p, slot == null ? null : Trampolines.Motion,
        slot == null ? IntPtr.Zero : slot.User));
    }
    public void SetContact(ContactDesc contact) {
      contact.struct_size = (uint)sizeof(ContactDesc);
      Call(p => {
        var rule = contact;
        return Native.mpm_obstacle_set_contact(p, &rule);
      });
    }
    /// <summary>Puts it somewhere; null keeps what it is: position[3], orientation[4], velocity[3], angularVelocity[3].</summary>
    public void SetPose(double[] position = null, double[] orientation = null, double[] velocity = null,
        double[] angularVelocity = null) {
      Length(position, 3);
      Length(orientation, 4);
      Length(velocity, 3);
      Length(angularVelocity, 3);
      Call(p => {
        fixed (double* x = position, q = orientation, v = velocity, w = angularVelocity)
          return Native.mpm_obstacle_set_pose(p, x, q, v, w);
      });
    }
    /// <summary>Where it is, and how it moves.</summary>
    public void GetPose(out double[] position, out double[] orientation, out double[] velocity, out double[] angularVelocity) {
      double[] at = new double[3], turned = new double[4], speed = new double[3], spin = new double[3];
      Call(p => {
        fixed (double* x = at, q = turned, v = speed, w = spin) return Native.mpm_obstacle_get_pose(p, x, q, v, w);
      });
      position = at;
      orientation = turned;
      velocity = speed;
      angularVelocity = spin;
    }
    public void SetLoad(double[] force, double[] torque) {
      Length(force, 3);
      Length(torque, 3);
      Call(p => {
        fixed (double* f = force, m = torque) return Native.mpm_obstacle_set_load(p, f, m);
      });
    }
    public ContactInfo ContactInfo(int body = MPM_BODY_ANY) {
      var info = Mpm.ContactInfo.Empty();
      Call(p => {
        var found = Mpm.ContactInfo.Empty();
        int status = Native.mpm_obstacle_contact_info(p, body, &found);
        info = found;
        return status;
      });
      return info;
    }
    static void Length(double[] values, int should) {
      if (values != null && values.Length != should) throw new ArgumentException("an array has " + should + " numbers");
    }
  }

  /// <summary>Markers that the material carries along, and that load it. Vectors have as many components as the grid has
  /// dimensions. Area vectors, area times normal, point out of the material; they and forces are per thickness in 2-D, and of
  /// one radian on a grid that is MPM_AXISYMMETRIC. Pressures and tractions are forces per area. A bad value is MPM_E_ARG, a
  /// field or an id that there is not MPM_E_NOT_FOUND, and what the dimension of the grid does not have MPM_E_UNSUPPORTED; then
  /// nothing has changed.</summary>
  public sealed unsafe class Surface : Handle {
    public int Dim { get; }

    /// <summary>Makes a surface without markers.</summary>
    public Surface(Context context, Grid grid, SurfaceDesc desc) : base(Create(context, grid, desc)) {
      Dim = grid.Dim;
    }
    static Node Create(Context context, Grid grid, SurfaceDesc desc) {
      desc.struct_size = (uint)sizeof(SurfaceDesc);
      var node = new Node(context.node.Core, Native.mpm_surface_destroy, context.node, grid.node);
      return Make(node, made => {
        var loads = desc;
        return Native.mpm_surface_create(context.Pointer, grid.Pointer, &loads, made);
      });
    }
    /// <summary>Replaces loads and options between steps. Loads of all markers come on top of those that markers carry by
    /// themselves.</summary>
    public void Configure(SurfaceDesc desc) {
      desc.struct_size = (uint)sizeof(SurfaceDesc);
      Call(p => {
        var loads = desc;
        return Native.mpm_surface_configure(p, &loads);
      });
    }
    /// <summary>Sets what adds tractions in each step; null takes it away. An exception comes out of the step, and a value that
    /// is not finite ends it with MPM_NONFINITE.</summary>
    public void SetTraction(TractionFunction traction) {
      var slot = traction == null ? null : new Slot(node.Core, traction);
      Stepper.Install(this, "traction", slot, p => Native.mpm_surface_set_traction(p,
        slot == null ? null : Trampolines.Traction, slot == null ? IntPtr.Zero : slot.User));
    }

    /// <summary>Sets what adds velocities of the markers in each step, where the surface prescribes; null takes it away. An
    /// exception comes out of the step, and a value that is not finite ends it with MPM_NONFINITE.</summary>
    public void SetVelocity(MarkerVelocityFunction velocity) {
      var slot = velocity == null ? null : new Slot(node.Core, velocity);
      Stepper.Install(this, "velocity", slot, p => Native.mpm_surface_set_velocity(p,
        slot == null ? null : Trampolines.MarkerVelocity, slot == null ? IntPtr.Zero : slot.User));
    }

    /// <summary>Heats what lies below: flux + film * (ambient - temperature), power per area into the
    /// material; all 0 as made.</summary>
    public void SetHeat(double flux, double film = 0, double ambient = 0) {
      Call(p => Native.mpm_surface_set_heat(p, flux, film, ambient));
    }

    /// <summary>The number of markers. May be called in callbacks.</summary>
    public long Count { get { return Native.mpm_surface_count(Pointer); } }

    /// <summary>Adds markers at position, which is [dim][n] as the area vectors are; without area they follow the material
    /// and carry nothing. Gives the first id.</summary>
    public long Add(double[] position, double[] area = null) {
      long first = 0;
      int n = position.Length / Dim;
      Fits("position", position.Length, n * Dim);
      if (area != null) Fits("area", area.Length, position.Length);
      Call(p => {
        long id;
        fixed (double* x = position, a = area) {
          int status = Native.mpm_surface_add(p, n, x, a, &id);
          first = id;
          return status;
        }
      });
      return first;
    }
    /// <summary>Adds markers along the line through points, [2][n], with the material on its left; closed: back to the first.
    /// Edges are divided into equal parts no longer than spacing; half a spacing of the grid is right. 2-D only. Gives the
    /// first id.</summary>
    public long AddPolyline(double[] position, bool closed, double spacing, out long count) {
      long first = 0, made = 0;
      int n = position.Length / 2;
      Fits("position", position.Length, n * 2);
      Call(p => {
        long id, number;
        fixed (double* x = position) {
          int status = Native.mpm_surface_add_polyline(p, n, x, closed ? 1 : 0, spacing, &id, &number);
          first = id;
          made = number;
          return status;
        }
      });
      count = made;
      return first;
    }
    /// <summary>Adds markers on triangles: position is [3][n], corner [triangles][3] with numbers of points, counter-clockwise
    /// as seen from outside. Each is divided into equal ones with edges no longer than spacing. 3-D only. Gives the first
    /// id.</summary>
    public long AddTriangles(double[] position, long[] corner, double spacing, out long count) {
      long first = 0, made = 0;
      int n = position.Length / 3, triangles = corner.Length / 3;
      Fits("position", position.Length, n * 3);
      Fits("corner", corner.Length, triangles * 3);
      Call(p => {
        long id, number;
        fixed (double* x = position) fixed (long* of = corner) {
          int status = Native.mpm_surface_add_triangles(p, n, x, triangles, of, spacing, &id, &number);
          first = id;
          made = number;
          return status;
        }
      });
      count = made;
      return first;
    }
    /// <summary>Removes markers by id: all or none.</summary>
    public void Remove(long[] ids) {
      Call(p => {
        fixed (long* first = ids) return Native.mpm_surface_remove(p, ids.Length, first);
      });
    }
    /// <summary>Splits markers until no edge is longer than the spacing; total area and loads are kept. Gives how many
    /// came.</summary>
    public long Refine(double spacing) {
      long added = 0;
      Call(p => {
        long n;
        int status = Native.mpm_surface_refine(p, spacing, &n);
        added = n;
        return status;
      });
      return added;
    }

    int ComponentsOf(string field) {
      return field == "id" || field == "reference_area" || field == "pressure" ? 1 : Dim;
    }
    /// <summary>Copies a field, of all markers by ascending id or of some: [components][n]. "id" is of long, all others are of
    /// double: "reference_area" and "pressure" with one component; "position", "area", "displacement", "velocity", "force",
    /// "traction", "dead_traction", "prescribed_velocity", "reaction" and "gap" with one for each axis. Force, reaction and
    /// velocity are those of the last step.</summary>
    public T[] Get<T>(string field, long[] ids = null) {
      return Copied<T>(Native.mpm_surface_get, field, ComponentsOf(field), Count, ids);
    }
    /// <summary>Sets a field, laid out as in Get: all or none. Ids, reference areas, velocities and forces cannot be set; areas
    /// that are become those of reference.</summary>
    public void Set<T>(string field, T[] values, long[] ids = null) {
      Overwritten(Native.mpm_surface_set, field, values, ComponentsOf(field), Count, ids);
    }
  }

  /// <summary>A time loop with a grid, sets of particles, a scheme, walls and forces.</summary>
  public sealed unsafe class Stepper : Handle {
    public Stepper(Context context, Grid grid, StepperDesc desc) : base(Create(context, grid, desc)) {}
    static Node Create(Context context, Grid grid, StepperDesc desc) {
      desc.struct_size = (uint)sizeof(StepperDesc);
      var node = new Node(context.node.Core, p => {
        int status = Native.mpm_stepper_destroy(p);
        if (status == MPM_OK) return status;
        Native.mpm_step_abort(p);
        return Native.mpm_stepper_destroy(p);
      }, context.node, grid.node);
      return Make(node, made => {
        var options = desc;
        return Native.mpm_stepper_create(context.Pointer, grid.Pointer, &options, made);
      });
    }

    public void Configure(StepperDesc desc) {
      desc.struct_size = (uint)sizeof(StepperDesc);
      Call(p => {
        var options = desc;
        return Native.mpm_stepper_configure(p, &options);
      });
    }
    public void Add(Particles set) {
      Call(p => Native.mpm_stepper_add(p, set.Pointer));
      node.Hold(set.node);
    }
    public void Remove(Particles set) {
      Call(p => Native.mpm_stepper_remove(p, set.Pointer));
      node.Put(MotionOf(set), null);
      node.Put(AdaptionOf(set), null);
      node.Put(HeatOf(set), null);
      node.LetGo(set.node);
    }
    public void Add(Obstacle obstacle) {
      Call(p => Native.mpm_stepper_add_obstacle(p, obstacle.Pointer));
      node.Hold(obstacle.node);
    }
    public void Remove(Obstacle obstacle) {
      Call(p => Native.mpm_stepper_remove_obstacle(p, obstacle.Pointer));
      node.LetGo(obstacle.node);
    }
    /// <summary>Puts a surface in, which has to be on the same grid, and keeps it alive. Steps end with MPM_OFF_GRID where a
    /// marker would leave the grid, and with MPM_E_STATE where one with a load has no material around it.</summary>
    public void Add(Surface surface) {
      Call(p => Native.mpm_stepper_add_surface(p, surface.Pointer));
      node.Hold(surface.node);
    }
    /// <summary>Takes a surface out; it keeps its markers.</summary>
    public void Remove(Surface surface) {
      Call(p => Native.mpm_stepper_remove_surface(p, surface.Pointer));
      node.LetGo(surface.node);
    }
    public void SetTime(double t, long step) {
      Call(p => Native.mpm_stepper_set_time(p, t, step));
    }
    public void SetWall(int face, int kind, double friction = 0) {
      Call(p => Native.mpm_stepper_set_wall(p, face, kind, friction));
    }
    public void SetBody(Particles set, int body) {
      Call(p => Native.mpm_stepper_set_body(p, set.Pointer, body));
    }
    /// <summary>The body that a set is in.</summary>
    public int BodyOf(Particles set) {
      int body = 0;
      Call(p => {
        int found;
        int status = Native.mpm_stepper_body(p, set.Pointer, &found);
        body = found;
        return status;
      });
      return body;
    }
    /// <summary>Sets how two bodies meet; null takes the rule back.</summary>
    public void SetContact(int bodyA, int bodyB, ContactDesc? contact) {
      Call(p => {
        var rule = contact ?? ContactDesc.Default();
        rule.struct_size = (uint)sizeof(ContactDesc);
        return Native.mpm_stepper_set_contact(p, bodyA, bodyB, contact.HasValue ? &rule : null);
      });
    }
    public ContactInfo ContactInfo(int bodyA, int bodyB) {
      var info = Mpm.ContactInfo.Empty();
      Call(p => {
        var found = Mpm.ContactInfo.Empty();
        int status = Native.mpm_stepper_contact_info(p, bodyA, bodyB, &found);
        info = found;
        return status;
      });
      return info;
    }

    /// <summary>Describes how a set is split and merged; null: no longer. A function in the descriptor is not called: it is
    /// `accept` that keeps particles as they are.</summary>
    public void SetAdaption(Particles set, AdaptionDesc? adaption, AdaptionFunction accept = null) {
      var desc = adaption ?? AdaptionDesc.Default();
      desc.struct_size = (uint)sizeof(AdaptionDesc);
      Install(AdaptionOf(set), accept, (p, user) => {
        var options = desc;
        options.accept = user == IntPtr.Zero ? IntPtr.Zero : Trampolines.Address(Trampolines.Adaption);
        options.user = user;
        return Native.mpm_stepper_set_adaption(p, set.Pointer, adaption.HasValue ? &options : null);
      });
    }
    /// <summary>Splits and merges now, whatever the descriptors say of steps.</summary>
    public void Adapt() {
      Call(p => Native.mpm_stepper_adapt(p), true);
    }
    /// <summary>What splitting and merging have done to a set.</summary>
    public AdaptionInfo AdaptionInfo(Particles set) {
      var info = Mpm.AdaptionInfo.Empty();
      Call(p => {
        var found = Mpm.AdaptionInfo.Empty();
        int status = Native.mpm_stepper_adaption_info(p, set.Pointer, &found);
        info = found;
        return status;
      });
      return info;
    }

    /// <summary>Describes the heat of a set, which has the field "temperature" from then on; null: it has no
    /// heat any more. A function in the descriptor is not called: it is `source` that heats.</summary>
    public void SetHeat(Particles set, HeatDesc? heat, HeatFunction source = null) {
      var desc = heat ?? HeatDesc.Default();
      desc.struct_size = (uint)sizeof(HeatDesc);
      Install(HeatOf(set), source, (p, user) => {
        var options = desc;
        options.source = user == IntPtr.Zero ? IntPtr.Zero : Trampolines.Address(Trampolines.Heat);
        options.user = user;
        return Native.mpm_stepper_set_heat(p, set.Pointer, heat.HasValue ? &options : null);
      });
    }
    /// <summary>Chooses how the nodes conduct: MPM_CONDUCTION_EXPLICIT, or MPM_CONDUCTION_IMPLICIT to a
    /// tolerance.</summary>
    public void SetConduction(int conduction, double tolerance = 1e-9) {
      Call(p => Native.mpm_stepper_set_conduction(p, conduction, tolerance));
    }
    /// <summary>Says what a face does to heat: MPM_HEAT_WALL_INSULATED, or MPM_HEAT_WALL_TEMPERATURE with
    /// its temperature.</summary>
    public void SetHeatWall(int face, int kind, double temperature = 0) {
      Call(p => Native.mpm_stepper_set_heat_wall(p, face, kind, temperature));
    }
    /// <summary>Where heat came from, in the last step and in all.</summary>
    public HeatInfo HeatInfo() {
      var info = Mpm.HeatInfo.Empty();
      Call(p => {
        var found = Mpm.HeatInfo.Empty();
        int status = Native.mpm_stepper_heat_info(p, &found);
        info = found;
        return status;
      });
      return info;
    }

    // Functions of the host; null takes one away. Each is kept alive while C may call it.

    public void SetForce(ParticleFunction function) {
      Install("force", function, (p, user) => Native.mpm_stepper_set_force(p, Fn(Trampolines.Particles, user), user));
    }
    public void SetAcceleration(ParticleFunction function) {
      Install("acceleration", function,
        (p, user) => Native.mpm_stepper_set_acceleration(p, Fn(Trampolines.Particles, user), user));
    }
    public void SetVelocityBc(VelocityFunction function) {
      Install("velocity", function, (p, user) => Native.mpm_stepper_set_velocity_bc(p, Fn(Trampolines.Velocity, user), user));
    }
    public void SetNodeHook(int stage, NodeFunction function) {
      Install("hook" + stage, function,
        (p, user) => Native.mpm_stepper_set_node_hook(p, stage, Fn(Trampolines.Nodes, user), user));
    }
    public void SetFriction(FrictionFunction function) {
      Install("friction", function, (p, user) => Native.mpm_stepper_set_friction(p, Fn(Trampolines.Friction, user), user));
    }
    public void SetLinearSolver(SolveFunction function) {
      Install("solver", function, (p, user) => Native.mpm_stepper_set_linear_solver(p, Fn(Trampolines.Solve, user), user));
    }
    public void SetProgress(ProgressFunction function) {
      Install("progress", function, (p, user) => Native.mpm_stepper_set_progress(p, Fn(Trampolines.Progress, user), user));
    }
    /// <summary>Moves the prescribed particles of a set.</summary>
    public void SetMotion(Particles set, ParticleFunction function) {
      Install(MotionOf(set), function,
        (p, user) => Native.mpm_stepper_set_motion(p, set.Pointer, Fn(Trampolines.Particles, user), user));
    }
    static string MotionOf(Particles set) {
      return "motion" + set.Pointer;
    }
    static string AdaptionOf(Particles set) {
      return "adaption" + set.Pointer;
    }
    static string HeatOf(Particles set) {
      return "heat" + set.Pointer;
    }
    static T Fn<T>(T trampoline, IntPtr user) where T : class {
      return user == IntPtr.Zero ? null : trampoline;
    }
    void Install(string name, Delegate function, Func<IntPtr, IntPtr, int> set) {
      var slot = function == null ? null : new Slot(node.Core, function);
      Install(this, name, slot, p => set(p, slot == null ? IntPtr.Zero : slot.User));
    }
    /// <summary>The old function goes only once the library has taken the new one.</summary>
    internal static void Install(Handle on, string name, Slot slot, Func<IntPtr, int> set) {
      try {
        on.Call(set);
      } catch {
        if (slot != null) slot.Free();
        throw;
      }
      on.node.Put(name, slot);
    }

    public double StableDt() {
      double dt = 0;
      Call(p => {
        double found;
        int status = Native.mpm_stable_dt(p, &found);
        dt = found;
        return status;
      }, true);
      return dt;
    }
    /// <summary>Makes a step. After an exception particles and time are as before, to the bit.</summary>
    public void Step(double dt) {
      Call(p => Native.mpm_step(p, dt, null), true);
    }
    /// <summary>Steps to a time exactly, with sub-steps of the library's choice.</summary>
    public void Advance(double t) {
      var desc = AdvanceDesc.Default();
      desc.t_end = t;
      Advance(desc);
    }
    public void Advance(AdvanceDesc desc) {
      desc.struct_size = (uint)sizeof(AdvanceDesc);
      Call(p => {
        var run = desc;
        return Native.mpm_advance(p, &run, null);
      }, true);
    }
    // The step in parts.
    public void Begin(double dt) {
      Call(p => Native.mpm_step_begin(p, dt), true);
    }
    public void StepGrid() {
      Call(Native.mpm_step_grid, true);
    }
    public void End() {
      Call(p => Native.mpm_step_end(p, null), true);
    }
    public void Abort() {
      Call(Native.mpm_step_abort);
    }
    /// <summary>The state as it is, and what belongs to the last step, also where that has failed.</summary>
    public StepInfo Info() {
      var info = StepInfo.Empty();
      Call(p => {
        var found = StepInfo.Empty();
        int status = Native.mpm_stepper_info(p, &found);
        info = found;
        return status;
      });
      return info;
    }
    public Profile Profile(bool reset = false) {
      var times = Mpm.Profile.Empty();
      Call(p => {
        var found = Mpm.Profile.Empty();
        int status = Native.mpm_stepper_profile(p, reset ? 1 : 0, &found);
        times = found;
        return status;
      });
      return times;
    }
    /// <summary>The residuals of the last implicit step.</summary>
    public double[] Residuals() {
      double[] values = null;
      Call(p => {
        int n;
        int status = Native.mpm_stepper_residuals(p, 0, null, &n);
        if (status != MPM_OK) return status;
        values = new double[n];
        fixed (double* first = values) return Native.mpm_stepper_residuals(p, n, first, &n);
      });
      return values;
    }
    /// <summary>Lends a nodal field of a body. Steps are refused until the view is disposed of.</summary>
    public FieldView Map(string field, int body = 0, int access = MPM_READ) {
      return new FieldView(this, access, (p, view) => {
        fixed (byte* name = Text.Bytes(field)) return Native.mpm_grid_map(p, body, name, access, view);
      });
    }
    public double[] WallReaction(int face) {
      return Vector((p, out3) => Native.mpm_stepper_wall_reaction(p, face, out3));
    }
    public double[] WallImpulse(int face) {
      return Vector((p, out3) => Native.mpm_stepper_wall_impulse(p, face, out3));
    }
    public double[] ParticlesReaction(Particles set) {
      return Vector((p, out3) => Native.mpm_stepper_particles_reaction(p, set.Pointer, out3));
    }
    public double[] ParticlesImpulse(Particles set) {
      return Vector((p, out3) => Native.mpm_stepper_particles_impulse(p, set.Pointer, out3));
    }
    public double[] SurfaceReaction(Surface surface) {
      return Vector((p, out3) => Native.mpm_stepper_surface_reaction(p, surface.Pointer, out3));
    }
    public double[] SurfaceImpulse(Surface surface) {
      return Vector((p, out3) => Native.mpm_stepper_surface_impulse(p, surface.Pointer, out3));
    }
    delegate int ToVector(IntPtr pointer, double* vector);
    double[] Vector(ToVector call) {
      var vector = new double[3];
      Call(p => {
        fixed (double* first = vector) return call(p, first);
      });
      return vector;
    }

    public byte[] Save() {
      byte[] state = null;
      Call(p => {
        long bytes;
        int status = Native.mpm_state_size(p, &bytes);
        if (status != MPM_OK) return status;
        state = new byte[bytes];
        fixed (byte* first = state) return Native.mpm_state_save(p, (IntPtr)first, bytes);
      });
      return state;
    }
    /// <summary>Gives a stream the bytes of Save(), without holding them all. What the stream throws comes out.</summary>
    public void SaveTo(Stream stream) {
      Streamed(stream, (p, user) => Native.mpm_state_save_to(p, Trampolines.Write, user));
    }
    public void Load(byte[] state) {
      Call(p => {
        fixed (byte* first = state) return Native.mpm_state_load(p, (IntPtr)first, state.Length);
      });
    }
    public void SaveFile(string path) {
      Call(p => {
        fixed (byte* file = Text.Bytes(path)) return Native.mpm_state_save_file(p, file);
      });
    }
    public void LoadFile(string path) {
      Call(p => {
        fixed (byte* file = Text.Bytes(path)) return Native.mpm_state_load_file(p, file);
      });
    }
    /// <summary>A hash of the state.</summary>
    public ulong Hash() {
      ulong hash = 0;
      Call(p => {
        ulong found;
        int status = Native.mpm_state_hash(p, &found);
        hash = found;
        return status;
      });
      return hash;
    }
    /// <summary>Writes a .vti file (with open knots a .vtr file) with nodal fields of a body; with none named all.</summary>
    public void WriteGrid(string path, int body = 0, params string[] fields) {
      using (var names = new Names(fields))
        Call(p => {
          fixed (byte* file = Text.Bytes(path)) fixed (IntPtr* first = names.Pointers)
            return Native.mpm_write_body_grid(p, body, file, fields.Length, (byte**)first);
        });
    }
    /// <summary>Gives a stream the bytes of that file.</summary>
    public void WriteGridTo(Stream stream, int body = 0, params string[] fields) {
      using (var names = new Names(fields))
        Streamed(stream, (p, user) => {
          fixed (IntPtr* first = names.Pointers)
            return Native.mpm_write_grid_to(p, body, Trampolines.Write, user, fields.Length, (byte**)first);
        });
    }
  }

  /// <summary>A time series of output files (.pvd), whole on disk after every append.</summary>
  public sealed unsafe class Series : Handle {
    public Series(Context context, string path) : base(Create(context, path)) {}
    static Node Create(Context context, string path) {
      var node = new Node(context.node.Core, Native.mpm_series_close, context.node);
      return Make(node, made => {
        fixed (byte* file = Text.Bytes(path)) return Native.mpm_series_open(context.Pointer, file, made);
      });
    }
    public void Append(double t, string path) {
      Call(p => {
        fixed (byte* file = Text.Bytes(path)) return Native.mpm_series_append(p, t, file);
      });
    }
  }
}
