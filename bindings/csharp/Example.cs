// Two elastic disks that collide under a force of the host: the scene that the example of every language makes, with the
// same bits. It prints the number of particles, the time and the hash of the state.
using System;
using System.Collections.Generic;
using System.Globalization;
using Mpm;
using static Mpm.Constants;

static class Example {
  // Bends the way of particles: the force is 0.05 x downwards per mass.
  static int Pull(ref ParticleBatch batch, Columns add) {
    Columns mass = batch.Mass, position = batch.Position;
    for (long i = 0; i < batch.n; i++) add[i, 1] += mass[i, 0] * (-0.05 * position[i, 0]);
    return MPM_OK;
  }

  static void Main() {
    using (var context = new Context(threads: 2, isa: MPM_ISA_PORTABLE))
    using (var grid = new Grid(context, Grid.Box(new long[] { 40, 40 }, new[] { 0.025, 0.025 })))
    using (var jelly = new Material(context, "neo_hookean",
        new Dictionary<string, double> { { "E", 1e3 }, { "nu", 0.3 }, { "density", 1e3 } })) {
      Func<double, double, Particles> disk = (centre, velocity) => {
        var set = new Particles(context, grid, jelly);
        set.FillBall(new[] { centre, centre }, 0.15, new[] { 2, 2 });
        set.SetAll("velocity", velocity, velocity);
        return set;
      };
      var options = StepperDesc.Default();
      options.scheme = MPM_MUSL;
      options.projected_positions = 1;
      using (var left = disk(0.2, 0.5))
      using (var right = disk(0.8, -0.5))
      using (var stepper = new Stepper(context, grid, options)) {
        stepper.Add(left);
        stepper.Add(right);
        stepper.SetForce(Pull);
        for (int step = 0; step < 400; step++) stepper.Step(2e-3);
        Console.WriteLine("particles {0}", left.Count + right.Count);
        Console.WriteLine(string.Format(CultureInfo.InvariantCulture, "time {0:F6}", stepper.Info().t));
        Console.WriteLine("hash {0:x16}", stepper.Hash());
      }
    }
  }
}
