"""Functions of Python that the library calls: what they see, what they give, what they raise."""
import gc
import signal
import threading
import unittest
import weakref

import mpm
import numpy as np
from scenes import block

try:
    import mpm.numba as compiled
except ImportError:
    compiled = None


class Trouble(Exception):
    pass


class Callbacks(unittest.TestCase):
    def test_force(self):
        one, stepper = block()
        seen = []

        def force(batch, add):
            seen.append((batch.particles, batch.position.shape, batch.dt, (batch.id >= 0).sum()))
            add[:, 0] += 3.0 * batch.mass

        stepper.set_force(force)
        stepper.step(1e-3)
        self.assertIs(seen[0][0], one)
        self.assertEqual(sum(s[3] for s in seen), len(one))
        np.testing.assert_allclose(one["velocity"][:, 0], 3e-3, rtol=1e-9)
        stepper.set_force(None)
        stepper.step(1e-3)
        np.testing.assert_allclose(stepper.info.momentum[0], 3e-3 * one["mass"].sum(), rtol=1e-9)

    def test_heat(self):
        one, stepper = block()
        seen = []

        def source(batch, power):
            seen.append((batch.particles, power.shape, batch.position.shape[0]))
            power[:] = 4.0

        stepper.set_heat(one, source, specific_heat=2.0, reference_temperature=10.0)
        stepper.set_conduction(mpm.CONDUCTION_IMPLICIT)
        self.assertEqual(one["temperature"][0], 10.0)
        stepper.step(1e-4)
        self.assertIs(seen[0][0], one)
        self.assertEqual(seen[0][1], (seen[0][2],))
        info = stepper.heat_info()
        np.testing.assert_allclose(info.sources, 4e-4 * one["volume"].sum(), rtol=1e-6)
        np.testing.assert_allclose(info.gained, info.sources, rtol=1e-9)
        stepper.set_heat_wall(mpm.X_MIN, mpm.HEAT_WALL_TEMPERATURE, 12.0)

        def fail(batch, power):
            raise Trouble("heat")

        stepper.set_heat(one, fail, specific_heat=2.0)
        with self.assertRaises(Trouble):
            stepper.step(1e-4)
        stepper.set_heat(one)
        stepper.step(1e-4)

    def test_adaption(self):
        one, stepper = block()
        one.add_field("heat")
        one.set_extensive("heat")
        one["heat"] = np.ones(len(one))
        count, seen = len(one), []

        def choose(batch, accept):
            seen.append((batch.what, batch.position.shape, batch.other, batch.id.copy()))
            accept[:] = batch.id == 0

        stepper.set_adaption(one, choose, split_edge=1e-3, least_edge=1e-4)
        stepper.adapt()
        parts = 2**one["position"].shape[1]
        self.assertEqual(len(one), count + parts - 1)
        self.assertEqual(sum(len(s[3]) for s in seen), count)
        self.assertEqual(seen[0][0], mpm.ADAPT_SPLIT)
        self.assertIsNone(seen[0][2])
        info = stepper.adaption_info(one)
        self.assertEqual((info.splits, info.added, info.merges), (1, parts - 1, 0))
        self.assertEqual(one["heat"][0], 1.0 / parts)

        def fail(batch, accept):
            raise Trouble("adaption")

        stepper.set_adaption(one, fail, split_edge=1e-3, least_edge=1e-4, every=1)
        with self.assertRaises(Trouble):
            stepper.step(1e-4)
        stepper.set_adaption(one)
        stepper.step(1e-4)
        self.assertEqual(len(one), count + parts - 1)

    def test_exceptions_arrive(self):
        one, stepper = block()
        before = stepper.hash

        def force(batch, add):
            raise Trouble("here")

        stepper.set_force(force)
        with self.assertRaisesRegex(Trouble, "here"):
            stepper.step(1e-3)
        self.assertEqual(stepper.hash, before)
        with self.assertRaises(Trouble):
            stepper.advance(0.1)
        stepper.set_force(None)
        stepper.step(1e-3)

    def test_interrupts_arrive(self):
        _, stepper = block()

        def watch(info):
            if info.step == 3:
                raise KeyboardInterrupt

        stepper.set_progress(watch)
        with self.assertRaises(KeyboardInterrupt):
            stepper.advance(10.0)
        self.assertEqual(stepper.info.step, 2)  # the third was not committed

    def test_signals_arrive_wherever_they_come(self):
        """The interpreter raises what a signal asks for at the entry of a callback, where no `try` of that has begun."""

        def ring(*_):
            raise Trouble("rung")

        def force(batch, add):
            add[:, 0] += batch.mass

        old = signal.signal(signal.SIGALRM, ring)
        try:
            for after in range(12):
                one, stepper = block()
                stepper.set_force(force if after % 3 else None)
                signal.setitimer(signal.ITIMER_REAL, 0.011 + 0.0013 * after)
                with self.assertRaisesRegex(Trouble, "rung"):
                    stepper.advance(1e3, dt_max=1e-5)
                info = stepper.info
                wanted = info.t * one["mass"].sum() if after % 3 else 0.0
                np.testing.assert_allclose(info.momentum[0], wanted, rtol=1e-9, atol=1e-12)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            signal.signal(signal.SIGALRM, old)

    def test_each_thread_gets_its_own(self):
        """A call that comes from another thread while a step is under way is refused, and says that, whatever a callback of
        that step has raised: one set's does, and the next set's waits for the other thread."""
        one, stepper = block()
        stepper.add(one.context.particles(one.grid, one.material).fill_box([0.1, 0.1], [0.2, 0.2]))
        told, raised = [], []

        def other():
            try:
                stepper.step(1e-3)
            except Exception as raised:
                told.append(raised)

        def force(batch, add):
            if raised and not told:
                thread = threading.Thread(target=other)
                thread.start()
                thread.join()
            raised.append(batch.particles)
            raise Trouble("mine")

        stepper.set_force(force)
        with self.assertRaisesRegex(Trouble, "mine"):
            stepper.step(1e-3)
        self.assertEqual([getattr(one, "status", one) for one in told], [mpm.E_STATE])

    def test_raised_arrays_arrive(self):
        _, stepper = block()
        at = []

        def force(batch, add):
            at.append(batch.position.copy())
            raise Trouble(batch.position)

        stepper.set_force(force)
        with self.assertRaises(Trouble) as caught:
            stepper.step(1e-3)
        np.testing.assert_array_equal(caught.exception.args[0], at[0])

    def test_what_is_no_function(self):
        _, stepper = block()
        with self.assertRaisesRegex(TypeError, "5 is no function"):
            stepper.set_force(5)
        with self.assertRaisesRegex(TypeError, "5 is no function"):
            stepper.set_progress(5)

    def test_vectors_on_lines(self):
        """On a line vectors have an axis of one component, as those that are written have."""
        one, stepper = block(dim=1)
        shapes = set()

        def force(batch, add):
            shapes.add((batch.position.shape == add.shape, batch.velocity.ndim, batch.mass.ndim, batch.id.ndim))
            add[...] += batch.mass[:, None]

        def hook(batch, velocity, force):
            shapes.add((batch.position.shape == velocity.shape, batch.index.ndim, batch.mass.ndim, batch.owned.ndim))

        stepper.set_force(force)
        stepper.set_node_hook(mpm.AFTER_FORCES, hook)
        stepper.step(1e-3)
        self.assertEqual(shapes, {(True, 2, 1, 1)})
        np.testing.assert_allclose(stepper.info.momentum[0], 1e-3 * one["mass"].sum(), rtol=1e-9)

    def test_what_is_removed_is_let_go(self):
        one, stepper = block()
        other = one.context.particles(one.grid, one.material)
        stepper.add(other)
        stepper.set_motion(other, lambda batch, add: None)
        gone = weakref.ref(other)
        stepper.remove(other)
        del other
        gc.collect()
        self.assertIsNone(gone())

    def test_views_that_die_in_callbacks(self):
        one, stepper = block()
        other = one.context.particles(one.grid, one.material).fill_box([0.1, 0.1], [0.2, 0.2])
        views = [other.view("velocity", write=True)]
        views[0][...] = 0.5
        stepper.set_force(lambda batch, add: views.clear())
        with self.assertRaisesRegex(mpm.Error, "E_STATE"):
            other.remove(other.ids[:1])
        stepper.step(1e-3)
        other.remove(other.ids[:1])
        self.assertTrue((other["velocity"] == 0.5).all())

    def test_progress_cancels(self):
        _, stepper = block()
        stepper.set_progress(lambda info: info.step == 3)
        with self.assertRaises(mpm.StepError) as caught:
            stepper.advance(10.0)
        self.assertEqual(caught.exception.status, mpm.CANCELLED)
        self.assertEqual(caught.exception.info.step, 2)
        self.assertFalse(caught.exception.smaller_dt_may_do)

    def test_a_smaller_dt_is_asked_for(self):
        _, stepper = block()
        stepper.set_force(lambda batch, add: 1 if batch.dt > 1e-4 else 0)
        with self.assertRaises(mpm.StepError) as caught:
            stepper.step(1e-3)
        self.assertEqual(caught.exception.status, mpm.CUT_DT)
        self.assertTrue(caught.exception.smaller_dt_may_do)
        self.assertLessEqual(stepper.advance(1e-3).dt, 1e-4)

    def test_kept_arrays_stay(self):
        """They keep their values, whatever becomes of the state; what is written to them later goes nowhere."""
        one, stepper = block()
        _, other = block()
        one["velocity"] = (0.5, 0.25)
        other.sets[0]["velocity"] = (0.5, 0.25)
        kept, copies = [], []

        def push(batch, add):
            add[:, 0] += batch.mass

        def force(batch, add):
            push(batch, add)
            arrays = (batch.position, batch.velocity, batch.mass, batch.id, batch.field("stress"),
                      batch.position[1:], add)
            kept.append(arrays)
            copies.append([array.copy() for array in arrays])

        stepper.set_force(force)
        stepper.step(1e-3)
        stepper.set_force(push)
        other.set_force(push)
        other.step(1e-3)
        for arrays in kept:
            self.assertFalse(any(array.flags.writeable for array in arrays[:-1]))
            np.testing.assert_array_equal(arrays[-1][:, 0], arrays[2])
            arrays[-1][...] = np.nan
        for arrays in copies:
            arrays[-1][...] = np.nan
        for each in stepper, other:
            for _ in range(20):
                each.step(1e-3)
        self.assertEqual(stepper.hash, other.hash)
        stepper.close()
        one.close()
        for arrays, same in zip(kept, copies):
            for array, copy in zip(arrays, same):
                np.testing.assert_array_equal(array, copy)

    def test_kept_batches_are_empty(self):
        _, stepper = block()
        kept = []
        stepper.set_force(lambda batch, add: kept.append((batch, batch.mass)[0]))
        stepper.step(1e-3)
        for name in ("mass", "position", "n"):
            with self.assertRaises(AttributeError):
                getattr(kept[0], name)

    def test_fields_in_batches(self):
        one, stepper = block()
        one.add_field("charge")
        one["charge"] = np.arange(len(one)) * 1.0
        total = []

        def force(batch, add):
            live = batch.id >= 0
            total.append(batch.field("charge")[live].sum())
            self.assertEqual(batch.field("stress").shape, (batch.n, 4))
            with self.assertRaises(LookupError):
                batch.field("chargee")

        stepper.set_force(force)
        stepper.step(1e-3)
        self.assertEqual(sum(total), one["charge"].sum())

    def test_nodes(self):
        one, stepper = block()

        def hold(batch, prescribed, velocity):
            low = batch.position[:, 1] < 0.3
            prescribed[low, :] = 1
            velocity[low, 0] = 0.5

        stepper.set_velocity_bc(hold)
        stepper.step(1e-3)
        low = one["position"][:, 1] < 0.26
        np.testing.assert_allclose(one["velocity"][low, 0], 0.5, rtol=1e-9)
        stepper.set_velocity_bc(None)
        one["velocity"] = 0.0
        stepper.set_node_hook(mpm.AFTER_FORCES, lambda batch, velocity, force: force.__setitem__(
            (slice(None), 1), force[:, 1] + 2.0 * batch.mass * batch.owned))
        stepper.step(1e-3)
        np.testing.assert_allclose(stepper.info.momentum[1], 2e-3 * one["mass"].sum(), rtol=1e-9)

    def test_motion(self):
        one, stepper = block()
        one.set("prescribed", [1, 1], ids=one.ids[one["position"][:, 0] < 0.4])
        stepper.set_motion(one, lambda batch, add: add.__setitem__((slice(None), 1), 0.25))
        stepper.step(1e-3)
        moved = one["velocity"][one["prescribed"][:, 0] == 1]
        self.assertGreater(len(moved), 10)
        np.testing.assert_allclose(moved, np.tile([0, 0.25], (len(moved), 1)), rtol=1e-12)
        self.assertGreater(stepper.particles_impulse(one)[1], 0.0)


def neo_hookean(E=1e4, nu=0.3, density=1e3):
    """Steffen et al. 2008, eq. 46, as a function for numpy."""
    mu, lam = E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))

    def stress(batch):
        F = batch.F
        J = np.linalg.det(F)
        b = F @ F.transpose(0, 2, 1)
        s = (mu * (b - np.eye(3)) + lam * np.log(J)[:, None, None] * np.eye(3)) / J[:, None, None]
        for to, (i, j) in enumerate(((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))):
            batch.stress_new[:, to] = s[:, i, j]
        batch.wave_speed[:] = np.sqrt((lam + 2 * mu) / density)

    return stress


class Laws(unittest.TestCase):
    def compare(self, scheme, law, steps, dt, **options):
        sets = []
        for law_of in (None, law):
            one, stepper = block(dim=2, cells=8, law_of=law_of, scheme=scheme, **options)
            x = one["position"]
            one["velocity"] = np.column_stack([0.3 * (x[:, 1] - 0.5), -0.2 * (x[:, 0] - 0.5)])
            for _ in range(steps):
                stepper.step(dt)
            sets.append(one)
        np.testing.assert_allclose(sets[1]["position"], sets[0]["position"], rtol=1e-9)
        np.testing.assert_allclose(sets[1]["stress"], sets[0]["stress"], rtol=1e-6, atol=1e-5)

    def test_explicit(self):
        self.compare(mpm.MUSL, lambda context: context.law(neo_hookean(), 1e3), 50, 2e-3)

    def test_implicit_with_differences(self):
        self.compare(mpm.NEWMARK, lambda context: context.law(neo_hookean(), 1e3), 3, 2e-2)

    def test_tangent(self):
        asked = []

        def tangent(batch, c):
            asked.append(c.shape)
            mu, lam, eye = 1e4 / 2.6, 3e3 / (1.3 * 0.4), np.eye(3)
            ln_J = np.log(np.linalg.det(batch.F))
            twice = (mu - lam * ln_J)[:, None, None, None, None]
            c[...] = lam * np.einsum("ij,kl->ijkl", eye, eye) + twice * (
                np.einsum("ik,jl->ijkl", eye, eye) + np.einsum("il,jk->ijkl", eye, eye))
            return True

        self.compare(mpm.NEWMARK, lambda context: context.law(neo_hookean(), 1e3, tangent=tangent), 3, 2e-2)
        self.assertEqual(asked[0][1:], (3, 3, 3, 3))

    def test_state_variables(self):
        def stress(batch):
            self.assertEqual(batch.state.shape, (batch.n, 2))
            batch.state_new[...] = batch.state
            batch.state_new[:, 0] += batch.dt
            batch.stress_new[...] = 0.0
            batch.wave_speed[...] = 1.0

        one, stepper = block(law_of=lambda context: context.law(stress, 1e3, state_initial=[1.0, 5.0]))
        stepper.step(1e-3)
        np.testing.assert_array_equal(one["state"], np.tile([1.001, 5.0], (len(one), 1)))

    def test_exceptions_of_laws(self):
        def stress(batch):
            raise Trouble("in a law")

        one, stepper = block(law_of=lambda context: context.law(stress, 1e3))
        with self.assertRaisesRegex(Trouble, "in a law"):
            stepper.step(1e-3)

    def test_driver(self):
        context = mpm.Context()
        law = context.law(neo_hookean(), 1e3)
        built_in = context.material("neo_hookean", E=1e4, nu=0.3, density=1e3)
        F = np.eye(3) + 0.1 * np.random.default_rng(2).normal(size=(20, 3, 3))
        answers = [m.update(F, F, tangent=True) for m in (law, built_in)]
        np.testing.assert_allclose(answers[0].stress, answers[1].stress, rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(answers[0].tangent, answers[1].tangent, rtol=1e-4, atol=1.0)
        self.assertTrue(answers[1].symmetric)


@unittest.skipIf(compiled is None, "there is no numba")
class Compiled(unittest.TestCase):
    def test_force(self):
        def pull(batch, add):
            for i in range(batch.n):
                add[i, 1] += batch.mass[i] * (-0.05 * batch.position[i, 0])

        hashes = []
        for fn in (pull, compiled.particles(pull)):
            one, stepper = block(context=mpm.Context(isa=mpm.ISA_PORTABLE))
            stepper.set_force(fn)
            for _ in range(5):
                stepper.step(1e-3)
            hashes.append(stepper.hash)
        self.assertEqual(*hashes)

    def test_law(self):
        mu, lam = 1e4 / 2.6, 3e3 / (1.3 * 0.4)

        def law(batch):
            for i in range(batch.n):
                F = batch.F[i]
                J = F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0]
                J *= F[2, 2]
                at = 0
                for a, b in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)):
                    s = 0.0
                    for k in range(3):
                        s += F[a, k] * F[b, k]
                    if a == b:
                        s = mu * (s - 1.0) + lam * np.log(J)
                    else:
                        s = mu * s
                    batch.stress_new[i, at] = s / J
                    at += 1
                batch.wave_speed[i] = np.sqrt((lam + 2 * mu) / 1e3)

        Laws.compare(self, mpm.MUSL, lambda context: context.law(compiled.stress(law), 1e3), 50, 2e-3)

    def test_compiled_code_stays(self):
        def lift(batch, add):
            for i in range(batch.n):
                add[i, 1] += 2.0 * batch.mass[i]

        fn = compiled.particles(lift)
        gone = weakref.ref(fn)
        one, stepper = block()
        stepper.set_force(fn)
        del fn
        gc.collect()
        self.assertIsNotNone(gone())
        stepper.step(1e-3)
        np.testing.assert_allclose(stepper.info.momentum[1], 2e-3 * one["mass"].sum(), rtol=1e-9)
        stepper.set_force(None)
        gc.collect()
        self.assertIsNone(gone())

    def test_kinds_are_told_apart(self):
        @compiled.node_hook
        def lift(batch, velocity, force):
            pass

        _, stepper = block()
        for wrong in (stepper.set_force, stepper.set_velocity_bc):
            with self.assertRaisesRegex(TypeError, "node_hook"):
                wrong(lift)
        stepper.set_node_hook(mpm.AFTER_FORCES, lift)
        stepper.step(1e-3)

    def test_exception_ends_the_step(self):
        @compiled.particles
        def bad(batch, add):
            raise ValueError("lost")

        _, stepper = block()
        stepper.set_force(bad)
        with self.assertRaises(mpm.Error) as caught:
            stepper.step(1e-3)
        self.assertEqual(caught.exception.status, mpm.E_CALLBACK)

    def test_nodes(self):
        @compiled.velocity_bc
        def hold(batch, prescribed, velocity):
            for i in range(batch.n):
                if batch.position[i, 1] < 0.3:
                    prescribed[i, 0] = 1
                    velocity[i, 0] = 0.5

        @compiled.node_hook
        def lift(batch, velocity, force):
            for i in range(batch.n):
                force[i, 1] += 2.0 * batch.mass[i] * batch.owned[i]

        one, stepper = block()
        stepper.set_velocity_bc(hold)
        stepper.set_node_hook(mpm.AFTER_FORCES, lift)
        stepper.step(1e-3)
        np.testing.assert_allclose(one["velocity"][one["position"][:, 1] < 0.26, 0], 0.5, rtol=1e-9)
        np.testing.assert_allclose(stepper.info.momentum[1], 2e-3 * one["mass"].sum(), rtol=1e-9)


class Solver(unittest.TestCase):
    def test_dense(self):
        seen = []

        def solve(system, rhs, guess, tolerance):
            indptr, indices, data = system.matrix
            dense = np.zeros((system.rows, system.rows))
            for row in range(system.rows):
                dense[row, indices[indptr[row]:indptr[row + 1]]] = data[indptr[row]:indptr[row + 1]]
            np.testing.assert_allclose(system.apply(rhs), dense @ rhs, rtol=1e-9, atol=1e-9)
            with self.assertRaisesRegex(ValueError, r"\(1,\)"):
                system.apply(np.zeros(1))
            seen.append(system.position.shape)
            return np.linalg.solve(dense, rhs)

        positions = []
        for solver in (mpm.SOLVER_HOST, mpm.SOLVER_LDLT):
            one, stepper = block(cells=6, scheme=mpm.NEWMARK, linear_solver=solver, gravity=(0, -10))
            stepper.wall(mpm.Y_MIN, mpm.WALL_FIXED)
            if solver == mpm.SOLVER_HOST:
                stepper.set_linear_solver(solve)
            stepper.step(1e-2)
            positions.append(one["position"])
        np.testing.assert_allclose(positions[0], positions[1], rtol=1e-10)
        self.assertEqual(seen[0][1], 2)
        self.assertGreater(len(stepper.residuals()), 0)

    def test_kept_systems_are_refused(self):
        kept = []

        def solve(system, rhs, guess, tolerance):
            kept.append(system)

        one, stepper = block(cells=6, scheme=mpm.NEWMARK, linear_solver=mpm.SOLVER_HOST, gravity=(0, -10))
        stepper.set_linear_solver(solve)
        with self.assertRaises(mpm.StepError):
            stepper.step(1e-2)
        with self.assertRaisesRegex(mpm.Error, "E_ARG"):  # its memory goes with the stepper
            kept[0].apply(np.zeros(kept[0].rows))
        with self.assertRaisesRegex(mpm.Error, "E_ARG"):
            kept[0].matrix
        self.assertEqual(kept[0].position.shape, (kept[0].rows, 2))

    def test_exceptions(self):
        def solve(system, rhs, guess, tolerance):
            raise Trouble("no solver")

        _, stepper = block(cells=6, scheme=mpm.NEWMARK, linear_solver=mpm.SOLVER_HOST, gravity=(0, -10))
        stepper.set_linear_solver(solve)
        with self.assertRaisesRegex(Trouble, "no solver"):
            stepper.step(1e-2)


if __name__ == "__main__":
    unittest.main()
