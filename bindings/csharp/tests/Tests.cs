// What the classes promise: exceptions, lifetimes, views, callbacks.
using System;
using System.Collections.Generic;
using System.IO;
using System.Runtime.CompilerServices;
using System.Threading;
using Mpm;
using static Mpm.Constants;

namespace Mpm {
  static class Tests {
    static int failures;

    static void Is(object found, object should, string what) {
      if (Equals(found, should)) return;
      Console.Error.WriteLine("{0}: {1}, not {2}", what, found, should);
      failures++;
    }
    static void Near(double found, double should, string what) {
      if (Math.Abs(found - should) <= 1e-9 * Math.Max(1, Math.Abs(should))) return;
      Is(found, should, what);
    }
    static T Throws<T>(Action run, string what) where T : Exception {
      try {
        run();
      } catch (T exception) {
        return exception;
      }
      Console.Error.WriteLine("{0}: nothing was thrown", what);
      failures++;
      return null;
    }
    static void Refuses(int status, string word, Action run) {
      var exception = Throws<MpmException>(run, word);
      if (exception == null) return;
      Is(exception.Status, status, "status of: " + exception.Message);
      Is(exception.Name.StartsWith("MPM_"), true, "its name: " + exception.Name);
      Is(exception.Message.Contains(word), true, "'" + word + "' in: " + exception.Message);
    }

    static readonly Dictionary<string, double> jelly =
      new Dictionary<string, double> { { "E", 1e4 }, { "nu", 0.3 }, { "density", 1e3 } };

    sealed class Scene : IDisposable {
      public readonly Context Context;
      public readonly Grid Grid;
      public readonly Material Material;
      public readonly Particles Set;
      public readonly Stepper Stepper;

      public Scene(int threads = 1, Action<int, string> log = null, Func<Context, Material> law = null, int scheme = MPM_USL,
          int solver = MPM_SOLVER_AUTO, bool serial = true) {
        Context = new Context(threads, serialCallbacks: serial, log: log);
        Grid = new Grid(Context, Mpm.Grid.Box(new long[] { 10, 10 }, new[] { 0.1, 0.1 }));
        Material = law == null ? new Material(Context, "neo_hookean", jelly) : law(Context);
        Set = new Particles(Context, Grid, Material);
        Set.FillBox(new[] { 0.3, 0.3 }, new[] { 0.7, 0.7 }, new[] { 2, 2 });
        var options = StepperDesc.Default();
        options.scheme = scheme;
        options.linear_solver = solver;
        unsafe {
          options.gravity[1] = -9.81;
        }
        Stepper = new Stepper(Context, Grid, options);
        Stepper.Add(Set);
      }
      public void Dispose() {
        // the order does not matter
        Context.Dispose();
        Material.Dispose();
        Stepper.Dispose();
        Grid.Dispose();
        Set.Dispose();
      }
    }

    static void Errors() {
      using (var scene = new Scene()) {
        Refuses(MPM_E_NOT_FOUND, "neo_hookean", () => new Material(scene.Context, "neo_hookian", jelly));
        Refuses(MPM_E_NOT_FOUND, "velocity", () => scene.Set.Get<double>("velocty"));
        Refuses(MPM_E_ARG, "-1", () => new Context(-1));
        Throws<ArgumentException>(() => scene.Set.FillBox(new[] { 0.1 }, new[] { 0.9, 0.9 }, new[] { 2, 2 }), "lengths");
        Throws<ArgumentException>(() => scene.Set.FillMesh(new[] { 0.1, 0.9, 0.1 }, new long[] { 0, 1 }, new[] { 2, 2 }), "points");
        Throws<ArgumentException>(() => scene.Set.Get<float>("velocity"), "type");
        scene.Stepper.Dispose();
        Throws<ObjectDisposedException>(() => scene.Stepper.Step(1e-3), "disposed");
        Refuses(MPM_E_ARG, "F64", () => scene.Set.Get<long>("velocity"));
      }
      Is(Array.IndexOf(Material.Models(), "drucker_prager") >= 0, true, "models");
    }

    static void Fields() {
      using (var scene = new Scene()) {
        var set = scene.Set;
        Is(set.Count, 64L, "count");
        set.Add(new[] { 0.1, 0.2, 0.1, 0.2 }, new[] { 1e-3, 1e-3 }, new[] { 1.0, 2, 3, 4 }, ids: new long[] { 900, 901 });
        Is(string.Join(" ", set.Get<double>("velocity", new long[] { 901, 900 })), "2 1 4 3", "velocities by id");
        set.AddField<byte>("colour", 3);
        set.Set("colour", new byte[] { 1, 2, 3 }, new long[] { 900 });
        Is(set.Get<byte>("colour", new long[] { 900 })[2], (byte)3, "own field");
        Throws<ArgumentException>(() => set.Set("colour", new byte[] { 1 }, new long[] { 900 }), "length");
        using (var x = set.Map("position")) using (var id = set.Map("id")) {
          long at = 0;
          while (id.Integer(at, 0) != 901) at++;
          Near(x[at, 0], 0.2, "x");
          Throws<InvalidOperationException>(() => x[at, 0] = 1, "writing into a view for reading");
          Throws<InvalidOperationException>(() => x.Integer(at, 0), "integers of doubles");
          Throws<IndexOutOfRangeException>(() => Is(x[x.Count, 0], 0, ""), "index");
          Refuses(MPM_E_STATE, "view", () => scene.Stepper.Step(1e-3));
        }
        set.Remove(new long[] { 900, 901 });
        var v = set.Map("velocity", MPM_READ | MPM_WRITE);
        for (long i = 0; i < v.Count; i++) v[i, 0] = 2;
        v.Dispose();
        Throws<ObjectDisposedException>(() => v[0, 0] = 1, "a view that was given back");
        Near(set.Get<double>("velocity")[63], 2, "what was written");
        var bad = set.Map("position", MPM_READ | MPM_WRITE);
        bad[0, 0] = double.NaN;
        Refuses(MPM_E_ARG, "nan", bad.Dispose);
        using (var lambda = new Scene())
          Is(lambda.Set.Fill(new[] { 0.1, 0.1 }, new[] { 0.25, 0.25 }, new[] { 2, 2 }, (x, inside) => {
            for (long i = 0; i < x.Count; i++) inside[i, 0] = (byte)(x[i, 0] < x[i, 1] ? 1 : 0);
            return MPM_OK;
          }), 3L, "a triangle");
        using (var meshed = new Scene())
          Is(meshed.Set.FillMesh(new[] { 0.1, 0.26, 0.1, 0.1, 0.1, 0.26 }, new long[] { 0, 1, 1, 2, 2, 0 },
            new[] { 4, 4 }) > 0, true, "what a mesh encloses");
      }
    }

    sealed class Own : Exception {}

    static void Callbacks() {
      using (var scene = new Scene()) {
        var stepper = scene.Stepper;
        stepper.SetForce((ref ParticleBatch batch, Columns add) => { throw new Own(); });
        ulong before = stepper.Hash();
        Throws<Own>(() => stepper.Step(1e-3), "the exception of a force");
        Is(stepper.Hash(), before, "the state after it");
        Is(stepper.Info().cause, MPM_E_CALLBACK, "its cause");
        stepper.SetForce((ref ParticleBatch batch, Columns add) => MPM_CUT_DT);
        var cut = Throws<MpmException>(() => stepper.Step(1e-3), "a smaller step");
        Is(cut.WantsSmallerStep, true, "a smaller step");
        stepper.SetForce((ref ParticleBatch batch, Columns add) => {
          batch.Mass.ToString();
          var mass = batch.Mass;
          mass[0, 0] = 1;
          return MPM_OK;
        });
        Throws<InvalidOperationException>(() => stepper.Step(1e-3), "writing into an input");
        stepper.SetForce((ref ParticleBatch batch, Columns add) => {
          unsafe {
            return batch.Mass.Pointer(0) == null ? 1 : MPM_OK;
          }
        });
        Throws<InvalidOperationException>(() => stepper.Step(1e-3), "the address of an input");
        stepper.SetForce((ref ParticleBatch batch, Columns add) => {
          unsafe {
            var along = add.Pointer(0);
            for (long i = 0; i < batch.n; i++) along[i] += 3 * batch.Mass[i, 0];
          }
          return MPM_OK;
        });
        GC.Collect();
        GC.WaitForPendingFinalizers();
        stepper.Step(1e-2);
        unsafe {
          var info = stepper.Info();
          Near(info.momentum[0], 160 * 3e-2, "momentum");
        }
        stepper.SetForce(null);
        stepper.SetProgress((ref StepInfo info) => {
          new Grid(scene.Context, GridDesc.Default());
          return MPM_OK;
        });
        Refuses(MPM_E_STATE, "under way", () => stepper.Step(1e-3));
        stepper.SetProgress((ref StepInfo info) => 1);
        Refuses(MPM_CANCELLED, "", () => stepper.Step(1e-3));
        stepper.SetProgress(null);
        stepper.SetNodeHook(MPM_AFTER_FORCES, (ref NodeBatch batch, Columns velocity, Columns force) => {
          for (long i = 0; i < batch.n; i++) force[i, 1] += 9.81 * batch.Mass[i, 0] * batch.Owned[i, 0];
          return MPM_OK;
        });
        Refuses(MPM_E_ARG, "stage", () => stepper.SetNodeHook(9, (ref NodeBatch batch, Columns velocity, Columns force) => 0));
        stepper.SetVelocityBc((ref NodeBatch batch, ByteColumns prescribed, Columns velocity) => {
          for (long i = 0; i < batch.n; i++) {
            prescribed[i, 0] = 1;
            velocity[i, 0] = 0.25;
          }
          return MPM_OK;
        });
        stepper.Step(1e-3);
        using (var v = stepper.Map("velocity")) Near(v[0, 0], 0.25, "a prescribed velocity");
        stepper.SetMotion(scene.Set, (ref ParticleBatch batch, Columns add) => MPM_OK);
        stepper.Remove(scene.Set);
        stepper.Add(scene.Set);
        stepper.Step(1e-3);
      }
      var log = new List<string>();
      using (new Scene(log: (level, text) => log.Add(text))) Is(log.Count > 0, true, "the log");
      Throws<Own>(() => new Context(log: (level, text) => { throw new Own(); }), "the exception of a log");
    }

    static void Threads() {
      using (var scene = new Scene(threads: 3, serial: false)) {
        int calls = 0;
        scene.Stepper.SetAcceleration((ref ParticleBatch batch, Columns add) => {
          Interlocked.Increment(ref calls);
          for (long i = 0; i < batch.n; i++) add[i, 0] += 1;
          return MPM_OK;
        });
        scene.Stepper.Advance(0.05);
        Is(calls > 0, true, "calls on threads of the pool");
        var refused = 0;
        var other = new Thread(() => {
          for (int k = 0; k < 100; k++)
            try {
              scene.Stepper.Step(1e-4);
            } catch (MpmException exception) {
              if (exception.Status == MPM_E_STATE) Interlocked.Increment(ref refused);
            }
        });
        other.Start();
        for (int k = 0; k < 100; k++)
          try {
            scene.Stepper.Step(1e-4);
          } catch (MpmException exception) {
            if (exception.Status == MPM_E_STATE) Interlocked.Increment(ref refused);
          }
        other.Join();
        Is(refused < 200, true, "two threads at once");
      }
    }

    /// <summary>What was shown to a function ends with it, and later accesses throw.</summary>
    static void Kept() {
      Columns add = default(Columns), mass = add, velocity = add, hooked = add, moved = add, points = add;
      ByteColumns prescribed = default(ByteColumns), inside = prescribed;
      ParticleBatch particles = default(ParticleBatch), first = particles;
      var nodes = default(NodeBatch);
      using (var scene = new Scene()) {
        int calls = 0;
        scene.Stepper.SetForce((ref ParticleBatch batch, Columns more) => {
          if (calls++ == 0) {
            first = batch;
          } else {
            Throws<ObjectDisposedException>(() => first.Mass.ToString(), "a batch of the first step");
            Throws<ObjectDisposedException>(() => mass[0, 0].ToString(), "masses of the step before");
          }
          particles = batch;
          add = more;
          mass = particles.Mass; // of a copy
          double found = 0;
          var other = new Thread(() => found = mass[0, 0]);
          other.Start();
          other.Join();
          Near(found, batch.Mass[0, 0], "an array on another thread");
          using (var inner = new Scene()) {
            inner.Stepper.SetForce((ref ParticleBatch its, Columns _) => {
              Near(particles.Mass[0, 0], found, "a batch of the function around");
              return its.Mass.Count == its.n ? MPM_OK : 1;
            });
            inner.Stepper.Step(1e-3);
          }
          more[0, 0] += 0 * particles.Mass[0, 0];
          return MPM_OK;
        });
        scene.Stepper.SetVelocityBc((ref NodeBatch batch, ByteColumns held, Columns v) => {
          nodes = batch;
          prescribed = held;
          velocity = v;
          held[0, 0] = batch.Owned[0, 0];
          return MPM_OK;
        });
        scene.Stepper.SetNodeHook(MPM_AFTER_FORCES, (ref NodeBatch batch, Columns v, Columns force) => {
          hooked = force;
          return MPM_OK;
        });
        scene.Stepper.Step(1e-3);
        scene.Stepper.Step(1e-3);
        var desc = ObstacleDesc.Default();
        desc.shape = MPM_SHAPE_SPHERE;
        desc.motion = MPM_MOTION_PRESCRIBED;
        unsafe {
          desc.size[0] = 0.05;
          desc.position[0] = desc.position[1] = 0.1;
        }
        using (var ball = new Obstacle(scene.Context, desc)) {
          ball.SetMotion((t, dt, v, spin) => {
            moved = v;
            return MPM_OK;
          });
          scene.Stepper.Add(ball);
          scene.Stepper.Step(1e-3);
          scene.Stepper.Remove(ball);
        }
        using (var set = new Particles(scene.Context, scene.Grid, scene.Material))
          set.Fill(new[] { 0.1, 0.1 }, new[] { 0.2, 0.2 }, new[] { 2, 2 }, (x, yes) => {
            points = x;
            inside = yes;
            yes[0, 0] = (byte)(x[0, 0] > 0 ? 1 : 0);
            return MPM_OK;
          });
        foreach (var array in new[] { add, mass, velocity, hooked, moved, points }) {
          Is(array.Count > 0, true, "an array that was shown");
          Throws<ObjectDisposedException>(() => array[0, 0].ToString(), "an array that was kept");
        }
        Throws<ObjectDisposedException>(() => add[0, 0] = 1, "writing into an array that was kept");
        unsafe {
          Throws<ObjectDisposedException>(() => Is(add.Pointer(0) == null, true, ""), "its address");
        }
        foreach (var array in new[] { prescribed, inside })
          Throws<ObjectDisposedException>(() => array[0, 0].ToString(), "bytes that were kept");
        var gone = Throws<ObjectDisposedException>(() => particles.Mass.ToString(), "a batch that was kept");
        Is(gone.Message.Contains("has returned"), true, gone.Message);
        Throws<ObjectDisposedException>(() => nodes.Owned.ToString(), "nodes that were kept");
      }

      var system = default(LinearSystem);
      using (var scene = new Scene(scheme: MPM_NEWMARK, solver: MPM_SOLVER_HOST)) {
        scene.Stepper.SetLinearSolver((LinearSystem shown, ref long iterations) => {
          system = shown;
          Is(shown.RightHandSide.Count, shown.Rows, "a right-hand side");
          return MPM_CUT_DT;
        });
        Throws<MpmException>(() => scene.Stepper.Step(1e-3), "no solution");
      }
      long[] start;
      int[] column;
      double[] value, x0 = new double[system.Rows];
      Throws<ObjectDisposedException>(() => system.RightHandSide.ToString(), "a kept right-hand side");
      Throws<ObjectDisposedException>(() => system.Solution.ToString(), "a solution that was kept");
      Throws<ObjectDisposedException>(() => system.Apply(x0, x0), "a matrix that was kept");
      Throws<ObjectDisposedException>(() => system.Csr(out start, out column, out value), "its rows");
    }

    /// <summary>A bar from 0 to 1 that the grid insulates, so soft that sound bounds no step. Its specific heat 3
    /// and its density 2 make the diffusivity 0.2.</summary>
    static void Bar(Action<Stepper, Particles, HeatDesc> run) {
      var soft = new Dictionary<string, double> { { "E", 1e-6 }, { "nu", 0.3 }, { "density", 2 } };
      using (var context = new Context())
      using (var grid = new Grid(context, Grid.Box(new long[] { 20 }, new[] { 0.05 })))
      using (var material = new Material(context, "neo_hookean", soft))
      using (var set = new Particles(context, grid, material))
      using (var stepper = new Stepper(context, grid, StepperDesc.Default())) {
        set.FillBox(new[] { 0.0 }, new[] { 1.0 }, new[] { 2 });
        stepper.Add(set);
        var heat = HeatDesc.Default();
        heat.specific_heat = 3;
        heat.conductivity = 1.2;
        run(stepper, set, heat);
      }
    }
    static unsafe void Heat() {
      Bar((stepper, bar, heat) => {
        Refuses(MPM_E_STATE, "no set has heat", () => stepper.HeatInfo());
        Refuses(MPM_E_ARG, "specific_heat", () => stepper.SetHeat(bar, HeatDesc.Default()));
        stepper.SetHeat(bar, heat);
        var cosine = Array.ConvertAll(bar.Get<double>("position"), x => Math.Cos(Math.PI * x));
        bar.Set("temperature", cosine);
        double before = stepper.HeatInfo().heat, decay = Math.Exp(-0.2 * Math.PI * Math.PI * 0.5);
        stepper.Advance(0.5);
        var found = bar.Get<double>("temperature");
        for (int i = 0; i < found.Length; i++)
          Is(Math.Abs(found[i] - decay * cosine[i]) < 0.01, true, "a cosine that decays");
        Near(stepper.HeatInfo().heat, before, "the heat of an insulated bar");
      });
      Bar((stepper, bar, heat) => {
        stepper.SetHeat(bar, heat);
        stepper.SetConduction(MPM_CONDUCTION_IMPLICIT, 1e-12);
        stepper.SetHeatWall(MPM_X_MIN, MPM_HEAT_WALL_TEMPERATURE, 10);
        stepper.SetHeatWall(MPM_X_MAX, MPM_HEAT_WALL_TEMPERATURE, 20);
        for (int k = 0; k < 200; k++) stepper.Step(0.1);
        double[] x = bar.Get<double>("position"), found = bar.Get<double>("temperature");
        for (int i = 0; i < x.Length; i++)
          Is(Math.Abs(found[i] - 10 - 10 * x[i]) < 1e-6, true, "a bar between two temperatures");
        var info = stepper.HeatInfo();
        double flow = 1.2 * 10 * 0.1; // Fourier's law for the time of a step
        Near(Math.Round(info.walls[0], 6), -flow, "what goes out");
        Near(Math.Round(info.walls[1], 6), flow, "what goes in");
      });
      Bar((stepper, bar, heat) => {
        stepper.SetHeat(bar, heat, (ref ParticleBatch batch, Columns power) => {
          for (long i = 0; i < batch.n; i++) power[i, 0] = 12;
          return MPM_OK;
        });
        GC.Collect();
        GC.WaitForPendingFinalizers();
        for (int k = 0; k < 10; k++) stepper.Step(5e-3);
        Near(bar.Get<double>("temperature")[7], 12 * 0.05 / 6, "a bar that is heated");
        Near(stepper.HeatInfo().sources_total, 12 * 0.05, "the heat of the source");
        stepper.SetHeat(bar, heat, (ref ParticleBatch batch, Columns power) => { throw new Own(); });
        Throws<Own>(() => stepper.Step(5e-3), "the exception of a source");
        stepper.Remove(bar);
        stepper.Add(bar);
        stepper.Step(5e-3);
        stepper.SetHeat(bar, null);
      });
      using (var scene = new Scene())
      using (var face = new Surface(scene.Context, scene.Grid, SurfaceDesc.Default())) {
        var heat = HeatDesc.Default();
        heat.specific_heat = 3;
        scene.Stepper.SetHeat(scene.Set, heat);
        face.Add(new[] { 0.7, 0.5 }, new[] { 0.4, 0.0 });
        scene.Stepper.Add(face);
        face.SetHeat(5);
        Refuses(MPM_E_ARG, "film", () => face.SetHeat(0, -1));
        scene.Stepper.Step(1e-3);
        Near(scene.Stepper.HeatInfo().surfaces * 1e3, 5 * 0.4, "the heat of a surface");
        scene.Stepper.Remove(face);
      }
      StressFunction none = (ref MaterialBatch batch) => MPM_OK;
      using (var scene = new Scene(law: context => new Material(context, 1e3, none))) {
        var heat = HeatDesc.Default();
        heat.specific_heat = 3;
        heat.dissipated_share = 0.5;
        Refuses(MPM_E_UNSUPPORTED, "what a law of the host dissipates is not known",
          () => scene.Stepper.SetHeat(scene.Set, heat));
      }
    }

    sealed class Least : Exception {
      public readonly long Id;
      public Least(long id) {
        Id = id;
      }
    }

    /// <summary>Of the exceptions of several threads that of the first particles comes out.</summary>
    static void First() {
      using (var context = new Context(4, serialCallbacks: false))
      using (var grid = new Grid(context, Grid.Box(new long[] { 100, 100 }, new[] { 0.1, 0.1 })))
      using (var material = new Material(context, "neo_hookean", jelly))
      using (var set = new Particles(context, grid, material))
      using (var stepper = new Stepper(context, grid, StepperDesc.Default())) {
        set.FillBox(new[] { 1.0, 1.0 }, new[] { 9.0, 9.0 }, new[] { 2, 2 });
        stepper.Add(set);
        stepper.SetForce((ref ParticleBatch batch, Columns add) => {
          long least = long.MaxValue;
          unsafe {
            for (long i = 0; i < batch.n; i++)
              if (batch.id[i] >= 0) least = Math.Min(least, batch.id[i]);
          }
          throw new Least(least);
        });
        for (int k = 0; k < 10; k++) Is(Throws<Least>(() => stepper.Step(1e-3), "least").Id, 0L, "the first particle");
      }
    }

    static void Laws() {
      StressFunction spring = (ref MaterialBatch batch) => {
        Columns F = batch.DeformationGradient, stress = batch.NewStress, speed = batch.WaveSpeed;
        Columns old = batch.State, state = batch.NewState;
        for (long i = 0; i < batch.n; i++) {
          for (int c = 0; c < 6; c++) stress[i, c] = 0;
          stress[i, 0] = 400 * (F[i, 0] - 1);
          speed[i, 0] = 2;
          state[i, 0] = old[i, 0] + batch.dt;
        }
        return MPM_OK;
      };
      using (var scene = new Scene(law: context => new Material(context, 100, spring, new[] { 5.0 }))) {
        scene.Stepper.Step(1e-2);
        Near(scene.Set.Get<double>("state")[0], 5.01, "the state of a law");
      }
      Scene direct = new Scene(scheme: MPM_NEWMARK), host = new Scene(scheme: MPM_NEWMARK, solver: MPM_SOLVER_HOST);
      host.Stepper.SetLinearSolver((LinearSystem system, ref long iterations) => {
        long n = system.Rows;
        double[] x = new double[n], r = new double[n], p = new double[n], ap = new double[n];
        double rr = 0;
        long[] start;
        int[] column;
        double[] value;
        system.Csr(out start, out column, out value);
        for (long i = 0; i < n; i++) p[i] = 1 + i % 7;
        system.Apply(p, ap);
        for (long i = 0; i < n; i++) {
          double sum = 0, scale = 0;
          for (long k = start[i]; k < start[i + 1]; k++) {
            sum += value[k] * p[column[k]];
            scale += Math.Abs(value[k] * p[column[k]]);
          }
          Is(Math.Abs(sum - ap[i]) <= 1e-12 * scale, true, "a row of the matrix");
        }
        for (long i = 0; i < n; i++) {
          p[i] = r[i] = system.RightHandSide[i, 0];
          rr += r[i] * r[i];
        }
        for (double goal = 1e-24 * rr; rr > goal && iterations < 2000; iterations++) {
          system.Apply(p, ap);
          double pap = 0, next = 0;
          for (long i = 0; i < n; i++) pap += p[i] * ap[i];
          for (long i = 0; i < n; i++) {
            x[i] += rr / pap * p[i];
            r[i] -= rr / pap * ap[i];
            next += r[i] * r[i];
          }
          for (long i = 0; i < n; i++) p[i] = r[i] + next / rr * p[i];
          rr = next;
        }
        var solution = system.Solution;
        for (long i = 0; i < n; i++) solution[i, 0] = x[i];
        return MPM_OK;
      });
      foreach (var scene in new[] { direct, host }) {
        scene.Stepper.SetWall(MPM_Y_MIN, MPM_WALL_FIXED);
        scene.Stepper.Step(0.02);
      }
      Is(host.Stepper.Info().linear_iterations > 0 && host.Stepper.Residuals().Length > 0, true, "the host has solved");
      Is(Math.Abs(host.Stepper.Info().kinetic_energy / direct.Stepper.Info().kinetic_energy - 1) < 1e-7, true, "and rightly");
      direct.Dispose();
      host.Dispose();
    }

    /// <summary>A law without a grid: small shear, and a stretch whose energy is known.</summary>
    static unsafe void Updates() {
      var density = Array.Find(Material.Parameters("neo_hookean"), each => each.Name == "density");
      Is(double.IsNaN(density.Default) && density.Unit.Contains("mass") && density.Low >= 0, true, "a parameter");
      Is(Material.StateVariables("j2")[0], "plastic_strain", "a state variable");
      Refuses(MPM_E_NOT_FOUND, "sponge", () => Material.Parameters("sponge"));
      double[] F = new double[18], one = new double[18];
      for (int k = 0; k < 3; k++)
        for (int i = 0; i < 2; i++) F[8 * k + i] = one[8 * k + i] = 1;
      F[2] = one[2] = 1e-3; // F_xy of the first item
      using (var context = new Context())
      using (var law = new Material(context, "neo_hookean", jelly)) {
        Is(law.StateCount, 0, "state variables");
        var after = law.Update(0.1, 0.1, F, one, new double[12], tangent: true);
        Is(Math.Abs(after.Stress[6] / (1e4 / 2.6 * 1e-3) - 1) < 1e-2 && after.Stress[7] == 0, true, "the stress of a shear");
        Is(after.WaveSpeed[0] > 3 && after.Energy[0] > 0 && after.Symmetric && Math.Abs(after.Tangent[1] / (1e4 * 0.7 / (1.3 * 0.4)) - 1) < 1e-9, true, "a tangent");
        Is(law.Update(0.1, 0.1, F, one, new double[12]).Tangent, (object)null, "no tangent");
        Throws<ArgumentException>(() => law.Update(0.1, 0.1, F, one, new double[11]), "stress");
        Throws<ArgumentException>(() => law.Update(0.1, 0.1, F, one, new double[12], new double[1]), "state");
        F[0] = F[1] = -1;
        Refuses(MPM_INVERTED, "", () => law.Update(0.1, 0.1, F, one, new double[12]));
      }
      StressFunction old = (ref MaterialBatch batch) => {
        Columns state = batch.State, next = batch.NewState, stress = batch.NewStress, speed = batch.WaveSpeed;
        for (long i = 0; i < batch.n; i++) {
          next[i, 0] = state[i, 0] + batch.dt;
          stress[i, 0] = batch.position[2 * batch.ld + i];
          speed[i, 0] = 1;
        }
        return MPM_OK;
      };
      using (var context = new Context())
      using (var law = new Material(context, 100, old, new[] { 5.0 })) {
        F[0] = F[1] = 1;
        var after = law.Update(1, 0.25, F, one, new double[12], new[] { 3.0, 4 }, position: new[] { 0, 0, 0, 0, 7.0, 8 });
        Is(string.Join(" ", after.State) + " " + after.Stress[1], "3.25 4.25 8", "a law of the host");
      }
    }

    static unsafe void Obstacles() {
      using (var scene = new Scene()) {
        var desc = ObstacleDesc.Default();
        desc.shape = MPM_SHAPE_DISTANCE;
        desc.motion = MPM_MOTION_PRESCRIBED;
        desc.position[0] = 0.5;
        desc.position[1] = 0.28;
        var rule = ContactDesc.Default();
        rule.friction = 0.3;
        var floor = new Obstacle(scene.Context, desc, rule, (ref DistanceBatch batch) => {
          Columns x = batch.Position, distance = batch.Distance, normal = batch.Normal;
          for (long i = 0; i < batch.n; i++) {
            distance[i, 0] = x[i, 1];
            normal[i, 0] = 0;
            normal[i, 1] = 1;
          }
          return MPM_OK;
        });
        scene.Stepper.Add(floor);
        floor.SetMotion((t, dt, velocity, spin) => {
          velocity[0, 1] = 0.1;
          return MPM_OK;
        });
        scene.Stepper.Advance(0.2);
        double[] position, orientation, speed, turn;
        floor.GetPose(out position, out orientation, out speed, out turn);
        Near(position[1], 0.3, "where the floor is");
        var info = floor.ContactInfo();
        Is(info.closed > 0 && info.impulse[1] > 0, true, "contact");
        Refuses(MPM_E_UNSUPPORTED, "MPM_MOTION_FREE", () => floor.SetLoad(new double[3], new double[3]));
        scene.Stepper.SetBody(scene.Set, 2);
        Is(scene.Stepper.BodyOf(scene.Set), 2, "the body of a set");
        scene.Stepper.SetContact(2, 3, rule);
        scene.Stepper.SetContact(2, 3, null);
        floor.Dispose();
        scene.Stepper.Step(1e-3);
      }
    }

    static void Adaption() {
      using (var scene = new Scene()) {
        var stepper = scene.Stepper;
        long first = scene.Set.Count;
        var halves = AdaptionDesc.Default();
        halves.every = 0;
        halves.split_edge = 0.4;
        stepper.SetAdaption(scene.Set, halves);
        stepper.Adapt();
        var info = stepper.AdaptionInfo(scene.Set);
        Is(scene.Set.Count, 4 * first, "particles that were split in both directions");
        Is(info.splits + " " + info.added, first + " " + 3 * first, "what was split");
        var merging = AdaptionDesc.Default();
        merging.every = 0;
        merging.max_per_cell = 1;
        merging.merge_distance = 0.3;
        long pairs = 0;
        stepper.SetAdaption(scene.Set, merging, (ref AdaptionBatch batch, ByteColumns accept) => {
          pairs = accept.Count;
          Is(batch.what == MPM_ADAPT_MERGE && batch.Position.Count == pairs && batch.Position[0, 1] > 0.3, true, "a batch");
          accept[0, 0] = 0;
          return MPM_OK;
        });
        stepper.Adapt();
        Is(pairs > 10 && stepper.AdaptionInfo(scene.Set).merges == pairs - 1, true, "one pair stays");
        var before = stepper.Hash();
        stepper.SetAdaption(scene.Set, merging, (ref AdaptionBatch batch, ByteColumns accept) => {
          throw new InvalidOperationException("as they are");
        });
        Throws<InvalidOperationException>(() => stepper.Adapt(), "as they are");
        halves.split_edge = 0.2;
        Refuses(MPM_E_ARG, "split_edge", () => stepper.SetAdaption(scene.Set, halves));
        Throws<InvalidOperationException>(() => stepper.Adapt(), "as they are");
        stepper.SetAdaption(scene.Set, null);
        stepper.Adapt();
        Is(stepper.Hash(), before, "the state");
        stepper.Remove(scene.Set);
        Refuses(MPM_E_NOT_FOUND, "", () => stepper.AdaptionInfo(scene.Set));
      }
    }

    static double Sum(double[] values, long first, long count) {
      double sum = 0;
      for (long i = first; i < first + count; i++) sum += values[i];
      return sum;
    }

    static unsafe void Surfaces() {
      using (var scene = new Scene()) {
        scene.Stepper.Configure(StepperDesc.Default());
        var desc = SurfaceDesc.Default();
        desc.pressure = 40;
        var face = new Surface(scene.Context, scene.Grid, desc);
        long count;
        Is(face.AddPolyline(new[] { 0.7, 0.7, 0.3, 0.7 }, false, 0.051, out count), 0L, "the first marker");
        Is(count == 8 && face.Count == 8, true, "markers on a line");
        Is(face.Add(new[] { 0.5, 0.6, 0.5, 0.6 }, new[] { 0.0, 0.1, 0.2, 0.3 }), 8L, "ids of markers");
        Is(face.Add(new[] { 0.5, 0.5 }), 10L, "a marker without area");
        Is(string.Join(" ", face.Get<double>("area", new long[] { 9, 8, 10 })), "0.1 0 0 0.3 0.2 0", "areas by id");
        Is(face.Get<long>("id")[10], 10L, "ids");
        face.Remove(new long[] { 8, 9, 10 });
        Refuses(MPM_E_NOT_FOUND, "8", () => face.Remove(new long[] { 8 }));
        face.Set("pressure", new[] { 5.0, 7.0 }, new long[] { 3, 1 });
        var pressures = face.Get<double>("pressure");
        Is(pressures[1] == 7 && pressures[2] == 0 && pressures[3] == 5, true, "pressures by id");
        face.Set("pressure", new double[8]);
        Is(face.Refine(0.026), 8L, "markers that were split");
        Near(Sum(face.Get<double>("area"), 0, 16), 0.4, "their area");
        Throws<ArgumentException>(() => face.Add(new[] { 0.5 }), "position");
        Throws<ArgumentException>(() => face.Add(new[] { 0.5, 0.5 }, new double[4]), "area");
        Throws<ArgumentException>(() => face.Set("traction", new double[16]), "values");
        Throws<ArgumentException>(() => face.Get<float>("force"), "type");
        Refuses(MPM_E_ARG, "inside the grid", () => face.Add(new[] { -0.5, 0.5 }));
        Refuses(MPM_E_ARG, "force", () => face.Set("force", new double[32]));
        Refuses(MPM_E_ARG, "F64", () => face.Get<long>("force"));
        Refuses(MPM_E_NOT_FOUND, "force", () => face.Get<double>("forse"));
        Refuses(MPM_E_ARG, "spacing", () => face.Refine(-1));
        Refuses(MPM_E_UNSUPPORTED, "", () => face.AddTriangles(new double[9], new long[] { 0, 1, 2 }, 0.1, out count));
        var bad = desc;
        bad.pressure = double.NaN;
        Refuses(MPM_E_ARG, "pressure", () => face.Configure(bad));
        Refuses(MPM_E_ARG, "pressure", () => new Surface(scene.Context, scene.Grid, bad));

        scene.Stepper.Add(face);
        Refuses(MPM_E_STATE, "this stepper", () => scene.Stepper.Add(face));
        scene.Stepper.Step(1e-4);
        var force = face.Get<double>("force");
        Near(Sum(force, 0, 16), -16, "the force of a pressure");
        Near(Sum(force, 16, 16), 0, "the force along the face");
        var info = scene.Stepper.Info();
        Near(info.momentum[0], -16e-4, "its momentum");
        desc = SurfaceDesc.Default();
        desc.dead_traction[1] = 30;
        face.Configure(desc);
        scene.Stepper.Step(1e-4);
        force = face.Get<double>("force");
        Near(Sum(force, 0, 16), 0, "the force that is gone");
        Near(Sum(force, 16, 16), 12, "the force of a dead load");
        face.Configure(SurfaceDesc.Default());

        int calls = 0;
        face.SetTraction((ref MarkerBatch batch, Columns add) => {
          calls++;
          Near(Sum(new[] { batch.ReferenceArea[0, 0], batch.ReferenceArea[15, 0] }, 0, 2), 0.05, "areas in a batch");
          Is(batch.n == 16 && batch.Position[0, 0] > 0.6 && batch.Area[0, 0] > 0.02 && batch.Velocity[0, 1] > 0
            && batch.Displacement[0, 0] < 0 && batch.id[15] == 18, true, "a batch");
          for (long i = 0; i < batch.n; i++) add[i, 0] += 10;
          return MPM_OK;
        });
        GC.Collect();
        GC.WaitForPendingFinalizers();
        scene.Stepper.Step(1e-4);
        Is(calls, 1, "calls in a step");
        Is(Math.Abs(Sum(face.Get<double>("force"), 0, 16) - 4) < 1e-3, true, "the force of tractions");
        ulong before = scene.Stepper.Hash();
        face.SetTraction((ref MarkerBatch batch, Columns add) => { throw new Own(); });
        Throws<Own>(() => scene.Stepper.Step(1e-4), "the exception of a traction");
        Is(scene.Stepper.Hash(), before, "the state after it");
        face.SetTraction((ref MarkerBatch batch, Columns add) => {
          var area = batch.Area;
          area[0, 0] = 1;
          return MPM_OK;
        });
        Throws<InvalidOperationException>(() => scene.Stepper.Step(1e-4), "writing into an input");
        face.SetTraction((ref MarkerBatch batch, Columns add) => MPM_CUT_DT);
        Is(Throws<MpmException>(() => scene.Stepper.Step(1e-4), "a smaller step").WantsSmallerStep, true, "a smaller step");
        face.SetTraction(null);
        scene.Stepper.Step(1e-4);

        scene.Stepper.Remove(face);
        Refuses(MPM_E_NOT_FOUND, "surface", () => scene.Stepper.Remove(face));
        Is(face.Count == 16 && face.Get<double>("displacement")[0] < 0, true, "markers of one that was taken out");
        scene.Stepper.Add(face);
        face.SetTraction((ref MarkerBatch batch, Columns add) => {
          calls++;
          return MPM_OK;
        });
        face.Dispose();
        Throws<ObjectDisposedException>(() => face.Refine(0.1), "a surface that was disposed of");
        scene.Stepper.Step(1e-4);
        Is(calls, 2, "the stepper keeps a surface");
      }
      using (var context = new Context())
      using (var grid = new Grid(context, Grid.Box(new long[] { 8, 8, 8 }, new[] { 0.125, 0.125, 0.125 })))
      using (var material = new Material(context, "neo_hookean", jelly))
      using (var set = new Particles(context, grid, material))
      using (var stepper = new Stepper(context, grid, StepperDesc.Default())) {
        set.FillBox(new[] { 0.25, 0.25, 0.25 }, new[] { 0.75, 0.75, 0.75 }, new[] { 2, 2, 2 });
        stepper.Add(set);
        var desc = SurfaceDesc.Default();
        desc.pressure = 8;
        var top = new Surface(context, grid, desc);
        long count;
        var corners = new[] { 0.25, 0.75, 0.75, 0.25, 0.25, 0.25, 0.75, 0.75, 0.75, 0.75, 0.75, 0.75 };
        top.AddTriangles(corners, new long[] { 0, 1, 2, 0, 2, 3 }, 0.2, out count);
        Is(top.Count, count, "markers on triangles");
        Refuses(MPM_E_ARG, "corner", () => top.AddTriangles(corners, new long[] { 0, 1, 4 }, 0.2, out count));
        stepper.Add(top);
        stepper.Step(1e-4);
        Near(Sum(top.Get<double>("force"), 2 * top.Count, top.Count), -2, "the force on a top");
        top.Dispose();
      }
    }

    static void Files(string folder) {
      using (var scene = new Scene()) {
        scene.Stepper.Advance(0.01);
        var state = scene.Stepper.Save();
        ulong hash = scene.Stepper.Hash();
        scene.Stepper.SaveFile(Path.Combine(folder, "state"));
        scene.Stepper.Advance(0.02);
        Is(scene.Stepper.Hash() == hash, false, "another hash");
        scene.Stepper.Load(state);
        Is(scene.Stepper.Hash(), hash, "the hash of the state");
        scene.Stepper.LoadFile(Path.Combine(folder, "state"));
        scene.Stepper.Begin(1e-3);
        scene.Stepper.StepGrid();
        scene.Stepper.Abort();
        Is(scene.Stepper.Hash(), hash, "after a step that was dropped");
        scene.Stepper.Begin(1e-3);
        scene.Stepper.StepGrid();
        scene.Stepper.End();
        scene.Stepper.WriteGrid(Path.Combine(folder, "grid.vti"), 0, "mass");
        scene.Set.Write(Path.Combine(folder, "\u00e4.vtp"), "velocity");
        using (var series = new Series(scene.Context, Path.Combine(folder, "all.pvd"))) series.Append(0.01, "\u00e4.vtp");
        Is(File.ReadAllText(Path.Combine(folder, "all.pvd")).Contains("\u00e4.vtp"), true, "a path in UTF-8");
        Refuses(MPM_E_IO, "nowhere", () => scene.Set.Write("/nowhere/a.vtp"));
      }
    }

    /// <summary>A stream that is full after 100 bytes.</summary>
    sealed class Full : MemoryStream {
      public override void Write(byte[] bytes, int offset, int count) {
        if (Length + count > 100) throw new Own();
        base.Write(bytes, offset, count);
      }
    }
    static bool Same(byte[] found, byte[] should) {
      return found.Length == should.Length && Array.FindIndex(found, 0, found.Length, b => b != 0) >= 0
        && Convert.ToBase64String(found) == Convert.ToBase64String(should);
    }
    static void Output(string folder) {
      using (var scene = new Scene()) {
        scene.Stepper.Advance(0.01);
        var set = scene.Set;
        double[] v = set.Get<double>("velocity"), m = set.Get<double>("mass");
        var floats = set.GetF32(MPM_BY_ID, "velocity", "mass");
        long n = set.Count;
        Is(floats.Length, (int)(3 * n), "the number of floats");
        for (long i = 0; i < n; i++)
          Is(floats[3 * i] == (float)v[i] && floats[3 * i + 1] == (float)v[n + i] && floats[3 * i + 2] == (float)m[i], true, "floats");
        var ids = set.GetF32(MPM_LIBRARY_ORDER, "id");
        Array.Sort(ids);
        for (long i = 0; i < n; i++) Is(ids[i], (float)i, "ids in library order");
        Refuses(MPM_E_NOT_FOUND, "velocity", () => set.GetF32(MPM_BY_ID, "velocty"));
        Refuses(MPM_E_ARG, "", () => set.GetF32(7, "mass"));

        byte[] all = set.Pack(), some = set.Pack(new long[] { 3, 1 });
        Refuses(MPM_E_ARG, "is in use", () => set.Unpack(some));
        set.Remove(new long[] { 1, 3 });
        set.Unpack(some);
        Is(Same(set.Pack(), all), true, "particles that were packed");
        some[some.Length - 1] ^= 1;
        Refuses(MPM_E_FORMAT, "damaged", () => set.Unpack(some));

        MemoryStream state = new MemoryStream(), vtp = new MemoryStream(), vti = new MemoryStream();
        scene.Stepper.SaveTo(state);
        Is(Same(state.ToArray(), scene.Stepper.Save()), true, "a state in a stream");
        set.WriteTo(vtp, "velocity");
        set.Write(Path.Combine(folder, "file.vtp"), "velocity");
        Is(Same(vtp.ToArray(), File.ReadAllBytes(Path.Combine(folder, "file.vtp"))), true, "particles in a stream");
        scene.Stepper.WriteGridTo(vti, 0, "mass");
        scene.Stepper.WriteGrid(Path.Combine(folder, "file.vti"), 0, "mass");
        Is(Same(vti.ToArray(), File.ReadAllBytes(Path.Combine(folder, "file.vti"))), true, "nodes in a stream");
        Throws<Own>(() => scene.Stepper.SaveTo(new Full()), "a full stream");
        Throws<ArgumentNullException>(() => set.WriteTo(null), "no stream");
        Is(Same(state.ToArray(), scene.Stepper.Save()), true, "the state after that");
        Refuses(MPM_E_NOT_FOUND, "mas", () => scene.Stepper.WriteGridTo(vti, 0, "mas"));
      }
    }

    [MethodImpl(MethodImplOptions.NoInlining)]
    static WeakReference Forgotten() {
      var token = new object();
      var scene = new Scene(log: (level, text) => token.ToString());
      scene.Stepper.SetForce((ref ParticleBatch batch, Columns add) => MPM_OK);
      scene.Stepper.Step(1e-3);
      scene.Set.Map("position");
      return new WeakReference(token);
    }
    [MethodImpl(MethodImplOptions.NoInlining)]
    static WeakReference Disposed() {
      var token = new object();
      using (var scene = new Scene(log: (level, text) => token.ToString())) scene.Stepper.Step(1e-3);
      return new WeakReference(token);
    }
    sealed class Simulation {
      public readonly object Token = new object();
      readonly Scene scene = new Scene();
      public Simulation() {
        scene.Stepper.SetForce(Pull);
        scene.Stepper.Step(1e-3);
      }
      int Pull(ref ParticleBatch batch, Columns add) {
        return scene.Stepper == null || Token == null ? MPM_E_ARG : MPM_OK;
      }
    }
    /// <summary>A function that refers to the object to which it was given.</summary>
    [MethodImpl(MethodImplOptions.NoInlining)]
    static WeakReference InACircle() {
      return new WeakReference(new Simulation().Token);
    }
    /// <summary>What the collector's thread frees stands in the way of no call.</summary>
    static void Collected() {
      using (var scene = new Scene()) {
        for (int k = 0; k < 400; k++) {
          new Particles(scene.Context, scene.Grid, scene.Material).FillBox(new[] { 0.3, 0.3 }, new[] { 0.7, 0.7 }, new[] { 2, 2 });
          if (k % 10 == 0) GC.Collect();
          scene.Stepper.Step(1e-6);
        }
      }
    }
    /// <summary>A view that is disposed of in a callback is given back after it, and no ids are none.</summary>
    static void Late() {
      using (var scene = new Scene())
      using (var other = new Particles(scene.Context, scene.Grid, scene.Material)) {
        other.FillBox(new[] { 0.3, 0.3 }, new[] { 0.7, 0.7 }, new[] { 2, 2 });
        var view = scene.Set.Map("velocity");
        other.Fill(new[] { 0.8, 0.8 }, new[] { 0.9, 0.9 }, new[] { 2, 2 }, (points, inside) => {
          view.Dispose();
          return MPM_OK;
        });
        scene.Stepper.Step(1e-3);
        Is(scene.Set.Get<double>("mass", new long[0]).Length, 0, "no ids");
        scene.Set.Set("mass", new double[0], new long[0]);
      }
      var told = 0;
      Throws<Own>(() => new Scene(log: (level, text) => {
        told++;
        throw new Own();
      }), "a log that throws");
      Is(told, 1, "calls of the log");
    }
    /// <summary>An exception of a callback comes out where it stopped the call, and not where a smaller step was made.</summary>
    static void Cut() {
      using (var scene = new Scene())
      using (var other = new Particles(scene.Context, scene.Grid, scene.Material)) {
        other.FillBox(new[] { 0.8, 0.8 }, new[] { 0.9, 0.9 }, new[] { 2, 2 });
        scene.Stepper.Add(other);
        var late = other.Pointer;
        var thrown = 0;
        scene.Stepper.SetForce((ref ParticleBatch batch, Columns add) => {
          if (batch.dt <= 1e-4) return MPM_OK;
          if (batch.particles != late) return MPM_CUT_DT;
          thrown++;
          throw new Own();
        });
        var go = AdvanceDesc.Default();
        go.t_end = 1e-3;
        scene.Stepper.Advance(go);
        Is(scene.Stepper.Info().t >= 1e-3, true, "the time");
        Is(thrown > 0, true, "exceptions of tries with a larger step");
      }
    }
    /// <summary>The token dies when C has let go of the context, whose log holds it.</summary>
    static void Lifetimes() {
      Collected();
      Late();
      Cut();
      foreach (Func<WeakReference> make in new Func<WeakReference>[] { Forgotten, Disposed, InACircle }) {
        var tokens = new List<WeakReference>();
        for (int k = 0; k < 60; k++) tokens.Add(make());
        for (int k = 0; k < 10; k++) {
          GC.Collect();
          GC.WaitForPendingFinalizers();
        }
        // the collector is conservative, and may take old numbers on the stack for pointers
        Is(tokens.FindAll(token => token.IsAlive).Count <= 3, true, "contexts are freed: " + make.Method.Name);
      }
    }

    static int Main(string[] arguments) {
      failures += Layout.Check();
      Errors();
      Fields();
      Callbacks();
      Kept();
      Heat();
      Threads();
      First();
      Laws();
      Updates();
      Obstacles();
      Adaption();
      Surfaces();
      Files(arguments[0]);
      Output(arguments[0]);
      Lifetimes();
      Console.WriteLine(failures == 0 ? "all is well" : failures + " failures");
      return failures == 0 ? 0 : 1;
    }
  }
}
