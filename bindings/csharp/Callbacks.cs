// Functions of the host: how C calls them, and what they are shown.
using System;
using System.Runtime.InteropServices;
using static Mpm.Constants;

namespace Mpm {
  // What they return is a status: MPM_OK, or MPM_CUT_DT to ask for a smaller step. An exception ends the call that ran the
  // function, and comes out of it. What C marks (mt) runs on several threads at once, unless the context has SerialCallbacks.

  /// <summary>(mt) Adds to add[i, c] of each particle.</summary>
  public delegate int ParticleFunction(ref ParticleBatch batch, Columns add);
  /// <summary>(mt) Prescribes nodal velocities: prescribed[i, c] = 1, and velocity[i, c].</summary>
  public delegate int VelocityFunction(ref NodeBatch batch, ByteColumns prescribed, Columns velocity);
  /// <summary>(mt) Changes nodal velocity and force.</summary>
  public delegate int NodeFunction(ref NodeBatch batch, Columns velocity, Columns force);
  /// <summary>(mt) Sets friction[i, 0] of nodes where bodies touch.</summary>
  public delegate int FrictionFunction(ref ContactBatch batch, Columns friction);
  /// <summary>Keeps particles and pairs as they are by accept[i, 0] = 0, which is 1.</summary>
  public delegate int AdaptionFunction(ref AdaptionBatch batch, ByteColumns accept);
  /// <summary>(mt) Heats particles: power[i, 0] is power per present volume.</summary>
  public delegate int HeatFunction(ref ParticleBatch batch, Columns power);
  /// <summary>Watches steps; a status above 0 ends the call with MPM_CANCELLED.</summary>
  public delegate int ProgressFunction(ref StepInfo info);
  /// <summary>(mt) Gives distances and normals of points.</summary>
  public delegate int DistanceFunction(ref DistanceBatch batch);
  /// <summary>Gives velocity[0, c] and angularVelocity[0, c] of the step, which are preset to the present ones.</summary>
  public delegate int MotionFunction(double t, double dt, Columns velocity, Columns angularVelocity);
  /// <summary>Adds forces per present area to add[i, c] of each marker. It runs once per step.</summary>
  public delegate int TractionFunction(ref MarkerBatch batch, Columns add);
  public delegate int MarkerVelocityFunction(ref MarkerBatch batch, Columns add);
  /// <summary>(mt) A law: writes batch.NewStress, NewState and WaveSpeed.</summary>
  public delegate int StressFunction(ref MaterialBatch batch);
  /// <summary>(mt) The tangent of a law; symmetric becomes 1 if it is.</summary>
  public delegate int TangentFunction(ref MaterialBatch batch, Columns tangent, ref int symmetric);
  /// <summary>Sets inside[i, 0] to 1 for points in the body.</summary>
  public delegate int InsideFunction(Columns position, ByteColumns inside);
  /// <summary>Solves the linear system of an implicit step.</summary>
  public delegate int SolveFunction(LinearSystem system, ref long iterations);

  /// <summary>What a function of the host is shown, until it returns: from then on the number is another. A
  /// thread has one for each of the functions that it is in, and takes it again.</summary>
  internal sealed unsafe class Lease {
    [ThreadStatic] static Lease innermost;
    readonly Lease outer;
    Lease inner;
    void* data;
    long items;
    double time;
    public int Number;

    Lease(Lease outer) {
      this.outer = outer;
    }
    /// <summary>Begins a function that is shown a batch, which array, length and time tell from others.
    /// </summary>
    public static Lease Begin(void* data = null, long items = 0, double time = 0) {
      var around = innermost ?? new Lease(null);
      var lease = around.inner ?? (around.inner = new Lease(around));
      lease.data = data;
      lease.items = items;
      lease.time = time;
      return innermost = lease;
    }
    public void End() {
      Number++;
      innermost = outer;
    }
    /// <summary>That of a batch, also of a copy of it.</summary>
    public static Lease Of(void* data, long items, double time) {
      for (var lease = innermost; lease != null; lease = lease.outer)
        if (lease.data == data && lease.items == items && lease.time == time) return lease;
      throw Over("batch");
    }
    public static Exception Over(string what) {
      return new ObjectDisposedException(what, "the function that was shown this " + what +
        " has returned, or is on another thread: copy what is to be kept");
    }
  }

  /// <summary>An array of C: component c of item i is [i, c]. It ends with the function that is shown it:
  /// later accesses throw.</summary>
  public unsafe struct Columns {
    readonly Lease lease;
    readonly int number;
    readonly double* data;
    readonly long ld;
    readonly bool writable;
    /// <summary>The number of items.</summary>
    public readonly long Count;
    /// <summary>The number of components.</summary>
    public readonly int Components;

    internal Columns(Lease lease, double* data, long ld, long count, int components, bool writable = true) {
      this.lease = lease;
      number = lease.Number;
      this.data = data;
      this.ld = ld;
      this.writable = writable;
      Count = data == null ? 0 : count;
      Components = components;
    }
    double* At(long item, int component) {
      if ((ulong)item >= (ulong)Count || (uint)component >= (uint)Components)
        throw new IndexOutOfRangeException();
      if (lease.Number != number) throw Lease.Over("array");
      return data + component * ld + item;
    }
    public double this[long item, int component] {
      get { return *At(item, component); }
      set {
        if (!writable) throw new InvalidOperationException("the array is for reading");
        *At(item, component) = value;
      }
    }
    /// <summary>Whether there is an array: some are optional.</summary>
    public bool Exists { get { return data != null; } }
    /// <summary>The address of a component of the first item, for loops that want no checks; those of its other items follow.
    /// </summary>
    public double* Pointer(int component) {
      if (!writable) throw new InvalidOperationException("the array is for reading; the batch has its pointer");
      return At(0, component);
    }
  }

  /// <summary>The same of bytes.</summary>
  public unsafe struct ByteColumns {
    readonly Lease lease;
    readonly int number;
    readonly byte* data;
    readonly long ld;
    public readonly long Count;
    public readonly int Components;

    internal ByteColumns(Lease lease, byte* data, long ld, long count, int components) {
      this.lease = lease;
      number = lease.Number;
      this.data = data;
      this.ld = ld;
      Count = count;
      Components = components;
    }
    byte* At(long item, int component) {
      if ((ulong)item >= (ulong)Count || (uint)component >= (uint)Components)
        throw new IndexOutOfRangeException();
      if (lease.Number != number) throw Lease.Over("array");
      return data + component * ld + item;
    }
    public byte this[long item, int component] {
      get { return *At(item, component); }
      set { *At(item, component) = value; }
    }
  }

  public unsafe partial struct ParticleBatch {
    public Columns Position { get { return Shown(position, dim); } }
    public Columns ReferencePosition { get { return Shown(reference_position, dim); } }
    public Columns Velocity { get { return Shown(velocity, dim); } }
    public Columns Mass { get { return Shown(mass, 1); } }
    public Columns Volume { get { return Shown(volume, 1); } }
    Columns Shown(double* data, int components) {
      return new Columns(Lease.Of(position, n, t), data, ld, n, components, false);
    }
  }

  public unsafe partial struct NodeBatch {
    public Columns Position { get { return Shown(position, dim); } }
    public Columns Mass { get { return Shown(mass, 1); } }
    public ByteColumns Owned { get { return new ByteColumns(Lease.Of(position, n, t), owned, ld, n, 1); } }
    Columns Shown(double* data, int components) {
      return new Columns(Lease.Of(position, n, t), data, ld, n, components, false);
    }
  }

  public unsafe partial struct ContactBatch {
    public Columns Position { get { return Shown(position, dim); } }
    public Columns Normal { get { return Shown(normal, dim); } }
    public Columns Gap { get { return Shown(gap, 1); } }
    public Columns Area { get { return Shown(area, 1); } }
    public Columns Slip { get { return Shown(slip, dim); } }
    public Columns Pressure { get { return Shown(pressure, 1); } }
    Columns Shown(double* data, int components) {
      return new Columns(Lease.Of(position, n, t), data, ld, n, components, false);
    }
  }

  public unsafe partial struct AdaptionBatch {
    public Columns Position { get { return Shown(position, dim); } }
    Columns Shown(double* data, int components) {
      return new Columns(Lease.Of(position, n, 0), data, ld, n, components, false);
    }
  }

  public unsafe partial struct DistanceBatch {
    public Columns Position { get { return Shown(position, dim, false); } }
    public Columns Distance { get { return Shown(distance, 1, true); } }
    public Columns Normal { get { return Shown(normal, dim, true); } }
    public Columns Velocity { get { return Shown(velocity, dim, true); } }
    Columns Shown(double* data, int components, bool writable) {
      return new Columns(Lease.Of(position, n, t), data, ld, n, components, writable);
    }
  }

  public unsafe partial struct MarkerBatch {
    public Columns Position { get { return Shown(position, dim); } }
    public Columns Area { get { return Shown(area, dim); } }
    public Columns ReferenceArea { get { return Shown(reference_area, 1); } }
    public Columns Displacement { get { return Shown(displacement, dim); } }
    public Columns Velocity { get { return Shown(velocity, dim); } }
    Columns Shown(double* data, int components) {
      return new Columns(Lease.Of(position, n, t), data, ld, n, components, false);
    }
  }

  public unsafe partial struct MaterialBatch {
    public Columns DeformationGradient { get { return Shown(F, 9, false); } }
    public Columns Increment { get { return Shown(F_inc, 9, false); } }
    public Columns VelocityGradient { get { return Shown(L, 9, false); } }
    public Columns Stress { get { return Shown(stress, 6, false); } }
    public Columns State { get { return Shown(state, state_count, false); } }
    public Columns NewStress { get { return Shown(stress_new, 6, true); } }
    public Columns NewState { get { return Shown(state_new, state_count, true); } }
    public Columns WaveSpeed { get { return Shown(wave_speed, 1, true); } }
    public Columns KinematicViscosity { get { return Shown(kinematic_viscosity, 1, true); } }
    public Columns Energy { get { return Shown(energy, 1, true); } }
    Columns Shown(double* data, int components, bool writable) {
      return new Columns(Lease.Of(F, n, t), data, ld, n, components, writable);
    }
  }

  /// <summary>The linear system of an implicit step, valid during the call of the host's solver.</summary>
  public unsafe struct LinearSystem {
    readonly Lease lease;
    readonly int number;
    readonly IntPtr matrix;
    readonly double* rhs, solution;
    /// <summary>The struct of C.</summary>
    public readonly OperatorInfo Info;
    /// <summary>The wanted ||matrix * solution - rhs|| / ||rhs||.</summary>
    public readonly double Tolerance;

    internal LinearSystem(Lease lease, IntPtr matrix, double* rhs, double* solution, double tolerance) {
      this.lease = lease;
      number = lease.Number;
      this.matrix = matrix;
      this.rhs = rhs;
      this.solution = solution;
      Tolerance = tolerance;
      var info = OperatorInfo.Empty();
      MpmException.Check(Native.mpm_operator_get_info(matrix, &info), IntPtr.Zero);
      Info = info;
    }
    public long Rows { get { return Info.rows; } }
    public Columns RightHandSide { get { return new Columns(Shown(), rhs, Rows, Rows, 1, false); } }
    public Columns Solution { get { return new Columns(Shown(), solution, Rows, Rows, 1); } }
    Lease Shown() {
      if (lease.Number != number) throw Lease.Over("system");
      return lease;
    }
    /// <summary>Computes y = matrix * x.</summary>
    public void Apply(double[] x, double[] y) {
      Shown();
      if (x.Length != Rows || y.Length != Rows) throw new ArgumentException("x and y have as many entries as the system");
      fixed (double* from = x, to = y) MpmException.Check(Native.mpm_operator_apply(matrix, from, to), IntPtr.Zero);
    }
    /// <summary>Copies the matrix by compressed rows: row r has the entries start[r] to start[r + 1] - 1 of column, in ascending
    /// order, and of value.</summary>
    public void Csr(out long[] start, out int[] column, out double[] value) {
      Shown();
      long* starts;
      int* columns;
      double* values;
      MpmException.Check(Native.mpm_operator_csr(matrix, &starts, &columns, &values), IntPtr.Zero);
      start = new long[Rows + 1];
      Marshal.Copy((IntPtr)starts, start, 0, start.Length);
      column = new int[Info.nonzeros];
      Marshal.Copy((IntPtr)columns, column, 0, column.Length);
      value = new double[Info.nonzeros];
      Marshal.Copy((IntPtr)values, value, 0, value.Length);
    }
  }

  /// <summary>Marks functions that C calls, for compilers that translate ahead of time: IL2CPP goes by the name.</summary>
  [AttributeUsage(AttributeTargets.Method)]
  internal sealed class MonoPInvokeCallbackAttribute : Attribute {
    public MonoPInvokeCallbackAttribute(Type type) {}
  }

  /// <summary>A function of the host where C finds it. What C has is weak: the object that it was given to keeps it, so
  /// that a function which refers to that object does not keep both for ever.</summary>
  internal sealed class Slot {
    public readonly Core Core;
    public readonly Delegate Function;
    /// <summary>A second function with the same first argument.</summary>
    public readonly Delegate Second;
    GCHandle handle;

    public Slot(Core core, Delegate function, Delegate second = null) {
      Core = core;
      Function = function;
      Second = second;
      handle = GCHandle.Alloc(this, GCHandleType.Weak);
    }
    /// <summary>The first argument of the callback.</summary>
    public IntPtr User { get { return GCHandle.ToIntPtr(handle); } }
    public static Slot Of(IntPtr user) {
      return (Slot)GCHandle.FromIntPtr(user).Target;
    }
    public void Free() {
      if (handle.IsAllocated) handle.Free();
    }
  }

  /// <summary>What C calls: each runs the host's function and keeps what it throws.</summary>
  internal static unsafe class Trampolines {
    public static readonly ParticleFn Particles = OnParticles;
    public static readonly VelocityFn Velocity = OnVelocity;
    public static readonly NodeFn Nodes = OnNodes;
    public static readonly FrictionFn Friction = OnFriction;
    public static readonly AdaptionFn Adaption = OnAdaption;
    public static readonly HeatFn Heat = OnHeat;
    public static readonly ProgressFn Progress = OnProgress;
    public static readonly DistanceFn Distance = OnDistance;
    public static readonly MotionFn Motion = OnMotion;
    public static readonly TractionFn Traction = OnTraction;
    public static readonly MarkerVelocityFn MarkerVelocity = OnMarkerVelocity;
    public static readonly StressFn Stress = OnStress;
    public static readonly TangentFn Tangent36 = OnTangent36, Tangent81 = OnTangent81;
    public static readonly InsideFn Inside = OnInside;
    public static readonly SolveFn Solve = OnSolve;
    public static readonly WriteFn Write = OnWrite;
    public static readonly ContextDescLogFn Log = OnLog;

    [MonoPInvokeCallback(typeof(ParticleFn))]
    static int OnParticles(IntPtr user, ParticleBatch* batch, double* add) {
      var slot = Slot.Of(user);
      var lease = Lease.Begin(batch->position, batch->n, batch->t);
      try {
        return ((ParticleFunction)slot.Function)(ref *batch,
          new Columns(lease, add, batch->ld, batch->n, batch->dim));
      } catch (Exception exception) {
        return slot.Core.Keep(exception);
      } finally {
        lease.End();
      }
    }

    [MonoPInvokeCallback(typeof(VelocityFn))]
    static int OnVelocity(IntPtr user, NodeBatch* batch, byte* prescribed, double* velocity) {
      var slot = Slot.Of(user);
      var lease = Lease.Begin(batch->position, batch->n, batch->t);
      try {
        return ((VelocityFunction)slot.Function)(ref *batch,
          new ByteColumns(lease, prescribed, batch->ld, batch->n, batch->dim),
          new Columns(lease, velocity, batch->ld, batch->n, batch->dim));
      } catch (Exception exception) {
        return slot.Core.Keep(exception);
      } finally {
        lease.End();
      }
    }

    [MonoPInvokeCallback(typeof(NodeFn))]
    static int OnNodes(IntPtr user, NodeBatch* batch, double* velocity, double* force) {
      var slot = Slot.Of(user);
      var lease = Lease.Begin(batch->position, batch->n, batch->t);
      try {
        return ((NodeFunction)slot.Function)(ref *batch,
          new Columns(lease, velocity, batch->ld, batch->n, batch->dim),
          new Columns(lease, force, batch->ld, batch->n, batch->dim));
      } catch (Exception exception) {
        return slot.Core.Keep(exception);
      } finally {
        lease.End();
      }
    }

    [MonoPInvokeCallback(typeof(FrictionFn))]
    static int OnFriction(IntPtr user, ContactBatch* batch, double* friction) {
      var slot = Slot.Of(user);
      var lease = Lease.Begin(batch->position, batch->n, batch->t);
      try {
        return ((FrictionFunction)slot.Function)(ref *batch,
          new Columns(lease, friction, batch->ld, batch->n, 1));
      } catch (Exception exception) {
        return slot.Core.Keep(exception);
      } finally {
        lease.End();
      }
    }

    [MonoPInvokeCallback(typeof(AdaptionFn))]
    static int OnAdaption(IntPtr user, AdaptionBatch* batch, byte* accept) {
      var slot = Slot.Of(user);
      var lease = Lease.Begin(batch->position, batch->n);
      try {
        return ((AdaptionFunction)slot.Function)(ref *batch,
          new ByteColumns(lease, accept, batch->ld, batch->n, 1));
      } catch (Exception exception) {
        return slot.Core.Keep(exception);
      } finally {
        lease.End();
      }
    }

    [MonoPInvokeCallback(typeof(HeatFn))]
    static int OnHeat(IntPtr user, ParticleBatch* batch, double* power) {
      var slot = Slot.Of(user);
      var lease = Lease.Begin(batch->position, batch->n, batch->t);
      try {
        return ((HeatFunction)slot.Function)(ref *batch, new Columns(lease, power, batch->ld, batch->n, 1));
      } catch (Exception exception) {
        return slot.Core.Keep(exception);
      } finally {
        lease.End();
      }
    }

    [MonoPInvokeCallback(typeof(ProgressFn))]
    static int OnProgress(IntPtr user, StepInfo* info) {
      var slot = Slot.Of(user);
      try {
        return ((ProgressFunction)slot.Function)(ref *info);
      } catch (Exception exception) {
        return slot.Core.Keep(exception);
      }
    }

    [MonoPInvokeCallback(typeof(DistanceFn))]
    static int OnDistance(IntPtr user, DistanceBatch* batch) {
      var slot = Slot.Of(user);
      var lease = Lease.Begin(batch->position, batch->n, batch->t);
      try {
        return ((DistanceFunction)slot.Function)(ref *batch);
      } catch (Exception exception) {
        return slot.Core.Keep(exception);
      } finally {
        lease.End();
      }
    }

    [MonoPInvokeCallback(typeof(MotionFn))]
    static int OnMotion(IntPtr user, double t, double dt, double* velocity, double* angular_velocity) {
      var slot = Slot.Of(user);
      var lease = Lease.Begin();
      try {
        return ((MotionFunction)slot.Function)(t, dt, new Columns(lease, velocity, 1, 1, 3),
          new Columns(lease, angular_velocity, 1, 1, 3));
      } catch (Exception exception) {
        return slot.Core.Keep(exception);
      } finally {
        lease.End();
      }
    }

    [MonoPInvokeCallback(typeof(TractionFn))]
    static int OnTraction(IntPtr user, MarkerBatch* batch, double* add) {
      var slot = Slot.Of(user);
      var lease = Lease.Begin(batch->position, batch->n, batch->t);
      try {
        return ((TractionFunction)slot.Function)(ref *batch,
          new Columns(lease, add, batch->ld, batch->n, batch->dim));
      } catch (Exception exception) {
        return slot.Core.Keep(exception);
      } finally {
        lease.End();
      }
    }
    [MonoPInvokeCallback(typeof(MarkerVelocityFn))]
    static int OnMarkerVelocity(IntPtr user, MarkerBatch* batch, double* add) {
      var slot = Slot.Of(user);
      var lease = Lease.Begin(batch->position, batch->n, batch->t);
      try {
        return ((MarkerVelocityFunction)slot.Function)(ref *batch,
          new Columns(lease, add, batch->ld, batch->n, batch->dim));
      } catch (Exception exception) {
        return slot.Core.Keep(exception);
      } finally {
        lease.End();
      }
    }

    [MonoPInvokeCallback(typeof(StressFn))]
    static int OnStress(IntPtr user, MaterialBatch* batch) {
      var slot = Slot.Of(user);
      var lease = Lease.Begin(batch->F, batch->n, batch->t);
      try {
        return ((StressFunction)slot.Function)(ref *batch);
      } catch (Exception exception) {
        return slot.Core.Keep(exception);
      } finally {
        lease.End();
      }
    }

    [MonoPInvokeCallback(typeof(TangentFn))]
    static int OnTangent36(IntPtr user, MaterialBatch* batch, double* tangent, int* symmetric) {
      return OnTangent(user, batch, tangent, symmetric, 36);
    }

    [MonoPInvokeCallback(typeof(TangentFn))]
    static int OnTangent81(IntPtr user, MaterialBatch* batch, double* tangent, int* symmetric) {
      return OnTangent(user, batch, tangent, symmetric, 81);
    }

    static int OnTangent(IntPtr user, MaterialBatch* batch, double* tangent, int* symmetric, int components) {
      var slot = Slot.Of(user);
      var lease = Lease.Begin(batch->F, batch->n, batch->t);
      try {
        return ((TangentFunction)slot.Second)(ref *batch,
          new Columns(lease, tangent, batch->ld, batch->n, components), ref *symmetric);
      } catch (Exception exception) {
        return slot.Core.Keep(exception);
      } finally {
        lease.End();
      }
    }

    [MonoPInvokeCallback(typeof(InsideFn))]
    static int OnInside(IntPtr user, int dim, long n, long ld, double* position, byte* inside) {
      var slot = Slot.Of(user);
      var lease = Lease.Begin();
      try {
        return ((InsideFunction)slot.Function)(new Columns(lease, position, ld, n, dim, false),
          new ByteColumns(lease, inside, n, n, 1));
      } catch (Exception exception) {
        return slot.Core.Keep(exception);
      } finally {
        lease.End();
      }
    }

    [MonoPInvokeCallback(typeof(SolveFn))]
    static int OnSolve(IntPtr user, IntPtr matrix, double* rhs, double* solution, double tolerance, long* iterations) {
      var slot = Slot.Of(user);
      var lease = Lease.Begin();
      try {
        return ((SolveFunction)slot.Function)(
          new LinearSystem(lease, matrix, rhs, solution, tolerance), ref *iterations);
      } catch (Exception exception) {
        return slot.Core.Keep(exception);
      } finally {
        lease.End();
      }
    }

    [MonoPInvokeCallback(typeof(WriteFn))]
    static int OnWrite(IntPtr user, IntPtr data, long bytes) {
      var slot = Slot.Of(user);
      try {
        var piece = new byte[bytes];
        Marshal.Copy(data, piece, 0, piece.Length);
        ((Action<byte[]>)slot.Function)(piece);
        return MPM_OK;
      } catch (Exception exception) {
        return slot.Core.Keep(exception);
      }
    }

    [MonoPInvokeCallback(typeof(ContextDescLogFn))]
    static void OnLog(IntPtr user, int level, byte* text) {
      var slot = Slot.Of(user);
      try {
        ((Action<int, string>)slot.Function)(level, Text.Of((IntPtr)text));
      } catch (Exception exception) {
        slot.Core.KeepLogged(exception);
      }
    }

    /// <summary>The address of a trampoline, for a field of a struct.</summary>
    public static IntPtr Address(Delegate trampoline) {
      return Marshal.GetFunctionPointerForDelegate(trampoline);
    }
  }
}
