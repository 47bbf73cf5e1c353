// What calls and callbacks cost from C#: the scene of costs.c, with arrays that check their indices, and by pointers.
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Globalization;
using Mpm;
using static Mpm.Constants;

static unsafe class Costs {
  const double Mu = 1e3 / 2.6, Lambda = 300 / (1.3 * 0.4);
  static readonly int[] row = { 0, 3, 6, 0, 3, 0 }, column = { 0, 3, 6, 3, 6, 6 };

  static int Pull(ref ParticleBatch batch, Columns add) {
    Columns mass = batch.Mass, position = batch.Position;
    for (long i = 0; i < batch.n; i++) add[i, 1] += mass[i, 0] * (-0.05 * position[i, 0]);
    return MPM_OK;
  }
  static int PullByPointers(ref ParticleBatch batch, Columns add) {
    double* mass = batch.mass, x = batch.position, down = add.Pointer(1);
    for (long i = 0; i < batch.n; i++) down[i] += mass[i] * (-0.05 * x[i]);
    return MPM_OK;
  }
  static int NeoHookean(ref MaterialBatch batch) {
    Columns F = batch.DeformationGradient, stress = batch.NewStress, speed = batch.WaveSpeed;
    for (long p = 0; p < batch.n; p++) {
      double J = (F[p, 0] * F[p, 4] - F[p, 1] * F[p, 3]) * F[p, 8], pressure = Lambda * Math.Log(J) - Mu;
      for (int c = 0; c < 6; c++) {
        int i = row[c], j = column[c];
        double s = Mu * (F[p, i] * F[p, j] + F[p, i + 1] * F[p, j + 1] + F[p, i + 2] * F[p, j + 2]);
        stress[p, c] = (c < 3 ? s + pressure : s) / J;
      }
      speed[p, 0] = 1.16;
    }
    return MPM_OK;
  }
  static int NeoHookeanByPointers(ref MaterialBatch batch) {
    long ld = batch.ld;
    for (long p = 0; p < batch.n; p++) {
      double* F = batch.F + p;
      double J = (F[0] * F[4 * ld] - F[ld] * F[3 * ld]) * F[8 * ld], pressure = Lambda * Math.Log(J) - Mu;
      for (int c = 0; c < 6; c++) {
        double* x = F + row[c] * ld, y = F + column[c] * ld;
        double s = Mu * (x[0] * y[0] + x[ld] * y[ld] + x[2 * ld] * y[2 * ld]);
        batch.stress_new[c * ld + p] = (c < 3 ? s + pressure : s) / J;
      }
      batch.wave_speed[p] = 1.16;
    }
    return MPM_OK;
  }

  static Stepper Make(ParticleFunction force, StressFunction law, out Particles set) {
    var context = new Context();
    var grid = new Grid(context, Grid.Box(new long[] { 200, 200 }, new[] { 1.0 / 200, 1.0 / 200 }));
    var material = law != null ? new Material(context, 1e3, law) : new Material(context, "neo_hookean",
      new Dictionary<string, double> { { "E", 1e3 }, { "nu", 0.3 }, { "density", 1e3 } });
    set = new Particles(context, grid, material);
    set.FillBox(new[] { 0.1, 0.1 }, new[] { 0.45, 0.45 }, new[] { 2, 2 });
    var options = StepperDesc.Default();
    options.transfer = MPM_APIC_MLS;
    var stepper = new Stepper(context, grid, options);
    stepper.Add(set);
    stepper.SetForce(force);
    for (int k = 0; k < 20; k++) stepper.Step(1e-4);
    return stepper;
  }
  static double Best(int tries, int calls, Action work) {
    double least = double.PositiveInfinity;
    for (int k = 0; k < tries; k++) {
      long start = Stopwatch.GetTimestamp();
      for (int i = 0; i < calls; i++) work();
      least = Math.Min(least, (Stopwatch.GetTimestamp() - start) / (double)Stopwatch.Frequency / calls);
    }
    return least;
  }

  static void Main() {
    Particles set, other;
    var kinds = new[] { Make(null, null, out set), Make(Pull, null, out other), Make(PullByPointers, null, out other),
      Make(null, NeoHookean, out other), Make(null, NeoHookeanByPointers, out other) };
    long sum = 0;
    double count = Best(200, 1000, () => sum += set.Count), view = Best(200, 100, () => set.Map("position").Dispose());
    var us = new double[kinds.Length];
    for (int k = 0; k < us.Length; k++) us[k] = double.PositiveInfinity;
    for (int round = 0; round < 40; round++)
      for (int k = 0; k < us.Length; k++) us[k] = Math.Min(us[k], 1e6 * Best(5, 1, () => kinds[k].Step(1e-4)));
    Console.WriteLine(string.Format(CultureInfo.InvariantCulture,
      "{0} particles: count {1:F0} ns, view {2:F0} ns, step {3:F0} us, force +{4:F0} us, by pointers +{5:F0} us, law +{6:F0} us, " +
      "by pointers +{7:F0} us", set.Count, 1e9 * count, 1e9 * view, us[0], us[1] - us[0], us[2] - us[0], us[3] - us[0], us[4] - us[0]));
    GC.KeepAlive(kinds);
  }
}
