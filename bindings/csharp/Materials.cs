// Constitutive laws, and what is known of them.
using System;
using System.Collections.Generic;
using static Mpm.Constants;

namespace Mpm {
  /// <summary>A constitutive law with its parameters.</summary>
  public sealed unsafe class Material : Handle {
    /// <summary>A law that is built in, with parameters by name.</summary>
    public Material(Context context, string model, IDictionary<string, double> parameters)
        : base(Create(context, model, parameters)) {
      StateCount = StateVariables(model).Length;
    }
    /// <summary>A law of the host, with the state of a new particle; form is MPM_TANGENT_MINOR_SYMMETRIC or
    /// MPM_TANGENT_GENERAL.</summary>
    public Material(Context context, double density, StressFunction stress, double[] state = null, TangentFunction tangent = null,
        int form = MPM_TANGENT_MINOR_SYMMETRIC)
        : base(Create(context, density, stress, state ?? new double[0], tangent, form)) {
      StateCount = state == null ? 0 : state.Length;
    }
    /// <summary>The number of state variables of a particle.</summary>
    public int StateCount { get; }

    static Node Create(Context context, string model, IDictionary<string, double> parameters) {
      var node = new Node(context.node.Core, Native.mpm_material_destroy, context.node);
      var keys = new List<string>(parameters.Keys);
      using (var names = new Names(keys.ToArray())) {
        var list = new Param[keys.Count];
        for (int k = 0; k < list.Length; k++) list[k] = new Param { name = names.Pointers[k], value = parameters[keys[k]] };
        return Make(node, made => {
          fixed (byte* name = Text.Bytes(model)) fixed (Param* first = list)
            return Native.mpm_material_create(context.Pointer, name, first, list.Length, made);
        });
      }
    }
    static Node Create(Context context, double density, StressFunction stress, double[] state, TangentFunction tangent, int form) {
      if (stress == null) throw new ArgumentNullException("stress");
      var node = new Node(context.node.Core, Native.mpm_material_destroy, context.node);
      var slot = new Slot(node.Core, stress, tangent);
      node.Put("law", slot);
      var desc = MaterialDesc.Default();
      desc.density = density;
      desc.state_count = state.Length;
      desc.stress = Trampolines.Address(Trampolines.Stress);
      desc.tangent_form = form;
      if (tangent != null)
        desc.tangent = Trampolines.Address(form == MPM_TANGENT_GENERAL ? Trampolines.Tangent81 : Trampolines.Tangent36);
      desc.user = slot.User;
      return Make(node, made => {
        var law = desc;
        fixed (double* initial = state) {
          law.state_initial = initial;
          return Native.mpm_material_create_custom(context.Pointer, &law, made);
        }
      });
    }
    /// <summary>The names of the laws that are built in.</summary>
    public static string[] Models() {
      var names = new string[Native.mpm_material_model_count()];
      for (int k = 0; k < names.Length; k++) names[k] = Text.Of(Native.mpm_material_model_name(k));
      return names;
    }
    /// <summary>The parameters of a law that is built in.</summary>
    public static Parameter[] Parameters(string model) {
      var found = new List<Parameter>();
      fixed (byte* of = Known(model)) {
        byte* name, unit, text;
        double preset, low, high;
        while (Native.mpm_material_model_param(of, found.Count, &name, &unit, &text, &preset, &low, &high) == MPM_OK)
          found.Add(new Parameter(Text.Of((IntPtr)name), Text.Of((IntPtr)unit), Text.Of((IntPtr)text), preset, low, high));
      }
      return found.ToArray();
    }
    /// <summary>The names of the state variables of a law that is built in.</summary>
    public static string[] StateVariables(string model) {
      var found = new List<string>();
      fixed (byte* of = Known(model)) {
        byte* name;
        while (Native.mpm_material_state_name(of, found.Count, &name, null, null) == MPM_OK) found.Add(Text.Of((IntPtr)name));
      }
      return found.ToArray();
    }
    static byte[] Known(string model) {
      var name = Text.Bytes(model);
      fixed (byte* of = name)
        if (Native.mpm_material_state_count(of) < 0) throw new MpmException(MPM_E_NOT_FOUND, "no model \"" + model + "\"");
      return name;
    }

    /// <summary>Leads n items through a step to time t without a grid, to fit parameters: F and increment are [9][n], stress is
    /// [6][n], state [StateCount][n] and position [3][n]. With dt = 0 the answer is the state as it is.</summary>
    public Updated Update(double t, double dt, double[] F, double[] increment, double[] stress, double[] state = null,
        long[] ids = null, double[] position = null, bool tangent = false) {
      int n = F.Length / 9;
      state = state ?? new double[0];
      Fits("F", F.Length, 9 * n);
      Fits("increment", increment.Length, 9 * n);
      Fits("stress", stress.Length, 6 * n);
      Fits("state", state.Length, StateCount * n);
      if (ids != null) Fits("ids", ids.Length, n);
      if (position != null) Fits("position", position.Length, 3 * n);
      var after = new Updated(n, StateCount, tangent);
      Call(p => {
        fixed (double* f = F, df = increment, s = stress, old = state, at = position, s1 = after.Stress, new1 = after.State)
        fixed (double* speed = after.WaveSpeed, viscosity = after.KinematicViscosity, energy = after.Energy, c = after.Tangent)
        fixed (long* id = ids) {
          var batch = MaterialBatch.Empty();
          batch.state_count = StateCount;
          batch.n = batch.ld = n;
          batch.t = t;
          batch.dt = dt;
          batch.id = id;
          batch.F = f;
          batch.F_inc = df;
          batch.stress = s;
          batch.state = old;
          batch.stress_new = s1;
          batch.state_new = new1;
          batch.wave_speed = speed;
          batch.kinematic_viscosity = viscosity;
          batch.energy = energy;
          batch.position = at;
          int symmetric = 0, status = Native.mpm_material_update(p, &batch, c, &symmetric);
          after.Symmetric = symmetric != 0;
          return status;
        }
      });
      return after;
    }
  }

  /// <summary>A parameter of a law that is built in.</summary>
  public sealed class Parameter {
    public string Name { get; }
    /// <summary>Its unit as a dimension, such as "stress".</summary>
    public string Unit { get; }
    public string Text { get; }
    /// <summary>Its default; NaN where it must be given.</summary>
    public double Default { get; }
    public double Low { get; }
    public double High { get; }

    internal Parameter(string name, string unit, string text, double preset, double low, double high) {
      Name = name;
      Unit = unit;
      Text = text;
      Default = preset;
      Low = low;
      High = high;
    }
  }

  /// <summary>What a law has made of n items.</summary>
  public sealed class Updated {
    /// <summary>Cauchy stress, [6][n].</summary>
    public double[] Stress { get; }
    /// <summary>State variables, [StateCount][n].</summary>
    public double[] State { get; }
    public double[] WaveSpeed { get; }
    public double[] KinematicViscosity { get; }
    /// <summary>Strain energy per initial volume; NaN where the law does not know it.</summary>
    public double[] Energy { get; }
    /// <summary>The tangent in the general form, [81][n]; null where it was not asked for.</summary>
    public double[] Tangent { get; }
    /// <summary>Whether the tangent has major symmetry at every item.</summary>
    public bool Symmetric { get; internal set; }

    internal Updated(int n, int states, bool tangent) {
      Stress = new double[6 * n];
      State = new double[states * n];
      WaveSpeed = new double[n];
      KinematicViscosity = new double[n];
      Energy = new double[n];
      Tangent = tangent ? new double[81 * n] : null;
    }
  }
}
