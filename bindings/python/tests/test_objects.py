"""Lifetimes, contact, obstacles, surfaces, saved states, files, pictures."""
import copy
import gc
import io
import os
import pickle
import resource
import tempfile
import threading
import unittest

import mpm
import numpy as np
from scenes import block


class Filling(unittest.TestCase):
    def test_shape_of_ones_own(self):
        context = mpm.Context()
        grid = context.grid(dim=3, cells=20, spacing=0.05)
        one = context.particles(grid, context.material("rigid", density=1e3))
        told = []

        def inside(x):
            told.append(x[np.abs(x - 0.5).max(axis=1) < 0.2])
            return np.abs(x - 0.5).max(axis=1) < 0.2

        one.fill((0.0, 0.0, 0.0), (1.0, 1.0, 1.0), inside)
        self.assertEqual(len(one), 16 ** 3)
        np.testing.assert_array_equal(one["position"], np.concatenate(told))


    def test_meshes(self):
        context = mpm.Context()
        corners = np.array([[x, y, z] for x in (0.3, 0.7) for y in (0.3, 0.7) for z in (0.3, 0.7)])
        faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
                 [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
        grid = context.grid(dim=3, cells=20, spacing=0.05)
        law = context.material("rigid", density=1e3)
        box = context.particles(grid, law).fill_box(corners[0], corners[7])
        mesh = context.particles(grid, law).fill_mesh(corners, faces)
        np.testing.assert_array_equal(mesh["position"], box["position"])
        for bad in ((corners[:, :2], faces), (corners, np.array(faces)[:, :2]), (corners, np.array(faces) + 0.5)):
            with self.assertRaises(ValueError):
                mesh.fill_mesh(*bad)
        with self.assertRaisesRegex(mpm.Error, "corner 8"):
            mesh.fill_mesh(corners, [[0, 1, 8]])
        self.assertEqual(len(mesh), len(box))


class Lifetimes(unittest.TestCase):
    def test_any_order_of_ends(self):
        for order in ((0, 1, 2, 3, 4), (4, 3, 2, 1, 0), (2, 4, 0, 3, 1), (1, 0, 4, 2, 3)):
            context = mpm.Context()
            grid = context.grid(dim=2, cells=8, spacing=0.125)
            material = context.material("neo_hookean", E=1e4, nu=0.3, density=1e3)
            one = context.particles(grid, material).fill_box(0.25, 0.75)
            things = [context, grid, material, one, context.stepper(grid, one)]
            del context, grid, material, one
            estate = things[0]._estate
            for index in order:
                things[index] = None
            self.assertEqual(len(estate.waiting), 0)

    def test_circles_are_collected(self):
        one, stepper = block()
        estate = one.context._estate
        stepper.set_force(lambda batch, add, held=stepper: None)
        one.circle, stepper.circle = stepper, one
        del one, stepper
        gc.collect()
        self.assertEqual(len(estate.waiting), 0)

    def test_close(self):
        one, stepper = block()
        with self.assertRaises(mpm.Error) as caught:
            one.close()
        self.assertEqual(caught.exception.status, mpm.E_STATE)
        stepper.step(1e-3)
        stepper.close()
        one.close()
        with self.assertRaisesRegex(Exception, "this Particles is closed"):
            len(one)

    def test_soak(self):
        def force(batch, add):
            add += batch.velocity

        def round_of_work():
            one, stepper = block(cells=8)
            stepper.set_force(force)
            for _ in range(5):
                stepper.step(1e-3)
                one.view("position").sum()
                one["velocity"]
            stepper.load(stepper.save())

        def resident():
            with open("/proc/self/statm", encoding="ascii") as file:
                return int(file.read().split()[1]) * resource.getpagesize()

        for _ in range(30):
            round_of_work()
        gc.collect()
        before = resident()
        for _ in range(150):
            round_of_work()
        gc.collect()
        self.assertLess(resident() - before, 3 << 20)

    def test_with(self):
        """An object ends with its block, or as soon as no other needs it."""
        with mpm.Context() as context:
            estate = context._estate
            with block(context=context)[1] as stepper:
                stepper.step(1e-3)
                one = stepper.sets[0]
            with self.assertRaisesRegex(Exception, "this Stepper is closed"):
                stepper.step(1e-3)
        self.assertGreater(len(estate.waiting), 0)
        self.assertGreater(one["mass"].sum(), 0.0)
        del one, stepper
        gc.collect()
        self.assertEqual(len(estate.waiting), 0)

    def test_ends_on_many_threads(self):
        """Each object is destroyed once, whatever thread does it."""
        context = mpm.Context()
        grid = context.grid(dim=2, cells=4, spacing=0.25)
        law = context.material("neo_hookean", E=1e4, nu=0.3, density=1e3)
        for _ in range(20):
            things = [context.particles(grid, law) for _ in range(40)]
            chunks = [things[at::4] for at in range(4)]
            things.clear()
            threads = [threading.Thread(target=chunk.clear) for chunk in chunks]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
        context.memory()
        self.assertEqual(len(context._estate.waiting), 0)

    def test_logs_that_raise(self):
        """What a log raises comes out of the call that it is told of."""
        armed = [True]

        def log(level, text):
            if armed:
                raise LookupError(text)

        with self.assertRaisesRegex(LookupError, "context"):
            mpm.Context(log=log)
        armed.clear()
        context = mpm.Context(log=log)
        grid = context.grid(dim=2, cells=8, spacing=0.125)
        held = context.memory()[0]
        context._raised[threading.get_ident()] = LookupError("said")  # as if it had been said while the next was made
        with self.assertRaisesRegex(LookupError, "said"):
            context.grid(dim=2, cells=8, spacing=0.125)
        self.assertEqual(context.memory()[0], held)
        self.assertEqual(grid.dim, 2)

    def test_log(self):
        told = []
        context = mpm.Context(log=lambda level, text: told.append((level, text)))
        block(context=context)[1].step(1e-3)
        self.assertTrue(all(isinstance(level, mpm._api.Log) for level, _ in told))

    def test_contexts_say_why(self):
        with self.assertRaisesRegex(mpm.Error, "E_ARG.*concurrency"):
            mpm.Context(concurrency=-3)


class Few:
    """A file that takes a few bytes at once, as raw files may."""

    def __init__(self):
        self.taken = []

    def write(self, data):
        self.taken.append(bytes(data[:997]))
        return len(self.taken[-1])


class Contact(unittest.TestCase):
    def test_bodies(self):
        context = mpm.Context()
        grid = context.grid(dim=2, cells=20, spacing=0.05)
        material = context.material("neo_hookean", E=1e4, nu=0.3, density=1e3)
        left = context.particles(grid, material).fill_box((0.1, 0.3), (0.45, 0.7))
        right = context.particles(grid, material).fill_box((0.5, 0.3), (0.85, 0.7))
        left["velocity"] = (0.5, 0.0)
        stepper = context.stepper(grid, left, right)
        stepper.set_body(right, 1)
        stepper.set_contact(0, 1, friction=0.2)
        asked = []
        stepper.set_friction(lambda batch, friction: asked.append((batch.gap.copy(), friction.copy())))
        while not stepper.info.t or not stepper.contact_info(0, 1).touching:
            stepper.step(1e-3)
        self.assertEqual(stepper.body(right), 1)
        self.assertGreater(stepper.contact_info(0, 1).force[0], 0.0)
        self.assertTrue((asked[-1][1] == 0.2).all())
        with self.assertRaises(mpm.Error):
            stepper.contact_info(0, 5000)

    def test_obstacles(self):
        one, stepper = block(gravity=(0, -10))
        floor = one.context.obstacle(mpm.SHAPE_PLANE, position=(0, 0.2), contact={"friction": 0.5})
        ball = one.context.obstacle(mpm.SHAPE_SPHERE, size=0.05, position=(0.5, 0.85), motion=mpm.MOTION_FREE, mass=2.0,
                                    inertia=np.diag([0, 0, 1e-3]))
        stepper.add(floor, ball)
        ball.set_load(force=(0, -20, 0))
        for _ in range(200):
            stepper.step(1e-3)
        self.assertGreater(floor.contact_info().impulse[1], 0.0)
        self.assertLess(ball.position[1], 0.85)
        self.assertAlmostEqual(np.linalg.norm(ball.orientation), 1.0)
        self.assertEqual(stepper.obstacles, (floor, ball))
        stepper.remove(ball)
        with self.assertRaises(mpm.Error):
            ball.set_pose(orientation=(0, 0, 0, 0))

    def test_distances_and_motion(self):
        one, stepper = block()

        def slab(batch):
            batch.distance[:] = batch.position[:, 1]
            batch.normal[...] = (0.0, 1.0)

        lift = one.context.obstacle(mpm.SHAPE_DISTANCE, distance=slab, position=(0.5, 0.2), motion=mpm.MOTION_PRESCRIBED)
        lift.set_motion(lambda t, dt: ((0.0, 0.5, 0.0), None))
        stepper.add(lift)
        for _ in range(200):
            stepper.step(1e-3)
        self.assertAlmostEqual(lift.position[1], 0.3, places=9)
        self.assertGreater(one["velocity"][:, 1].mean(), 0.1)


class Surfaces(unittest.TestCase):
    def test_pressure_on_a_face(self):
        for dim in (1, 2, 3):
            one, stepper = block(dim=dim)
            face = one.context.surface(stepper.grid, pressure=40.0)
            low, high = 0.25, 0.75
            if dim == 1:
                self.assertEqual(face.add(high, 1.0), range(1))
            elif dim == 2:
                self.assertEqual(face.add_polyline([(high, low), (high, high)], 1 / 24), range(12))
            else:
                corners = [(high, low, low), (high, high, low), (high, high, high), (high, low, high)]
                face.add_triangles(corners, [(0, 1, 2), (0, 2, 3)], 1 / 24)
            area = 0.5 ** (dim - 1)
            np.testing.assert_allclose(face["area"].reshape(-1, dim).sum(axis=0), [area] + [0.0] * (dim - 1), atol=1e-15)
            stepper.add(face)
            self.assertEqual((stepper.surfaces, stepper.obstacles), ((face,), ()))
            force = np.array([-40.0 * area] + [0.0] * (dim - 1))
            stepper.step(1e-4)
            np.testing.assert_allclose(face["force"].reshape(-1, dim).sum(axis=0), force, rtol=1e-12, atol=1e-12)
            np.testing.assert_allclose(stepper.info.momentum[:dim], 1e-4 * force, rtol=1e-9, atol=1e-14)
            face.configure(pressure=0.0, dead_traction=[3.0] + [0.0] * (dim - 1))
            self.assertEqual((face.option("pressure"), face.option("dead_traction")[0]), (0.0, 3.0))
            stepper.step(1e-4)
            np.testing.assert_allclose(face["force"].reshape(-1, dim).sum(axis=0), -3.0 * force / 40.0, rtol=1e-12, atol=1e-12)

    def test_markers(self):
        one, stepper = block()
        face = one.context.surface(stepper.grid)
        made = face.add_polyline([(0.25, 0.25), (0.75, 0.25), (0.75, 0.75), (0.25, 0.75)], 0.125, closed=True)
        self.assertEqual((made, len(face)), (range(16), 16))
        self.assertEqual(face.add((0.5, 0.5)), range(16, 17))
        self.assertEqual(face.add([(0.4, 0.5), (0.6, 0.5)], (0.0, 0.1)), range(17, 19))
        np.testing.assert_array_equal(face.get("area", 18), [(0.0, 0.1)])
        np.testing.assert_array_equal(face.ids, np.arange(19))
        np.testing.assert_array_equal(face.get("position", [16, 18]), [(0.5, 0.5), (0.6, 0.5)])
        self.assertEqual((face["area"].shape, face["reference_area"].shape, face["id"].dtype), ((19, 2), (19,), np.int64))
        face.remove([16, 17, 18])
        with self.assertRaisesRegex(mpm.Error, "E_NOT_FOUND.*16"):
            face.remove(16)
        face["pressure"] = 5.0
        face.set("pressure", [1.0, 2.0], ids=[3, 1])
        self.assertEqual(list(face["pressure"][:4]), [5.0, 2.0, 5.0, 1.0])
        face["traction"] = (1.0, 2.0)
        face.set("traction", [(3.0, 4.0)], ids=2)
        np.testing.assert_array_equal(face["traction"][1:4], [(1, 2), (3, 4), (1, 2)])
        whole = face["area"].copy()
        self.assertEqual(face.refine(0.07), 16)
        np.testing.assert_array_equal(face.get("area", range(16)), 0.5 * whole)
        np.testing.assert_allclose(face["area"].sum(axis=0), 0.0, atol=1e-15)
        with self.assertRaisesRegex(mpm.Error, "E_NOT_FOUND.*force"):
            face["forse"]
        for field, values in (("force", (0, 0)), ("id", 0), ("pressure", np.nan), ("position", (-1.0, 0.5))):
            with self.assertRaisesRegex(mpm.Error, "E_ARG"):
                face[field] = values
        for values in (np.zeros((5, 2)), np.zeros((32, 3))):
            with self.assertRaises(ValueError):
                face["traction"] = values
        with self.assertRaisesRegex(mpm.Error, "E_UNSUPPORTED"):
            face.add_triangles(np.zeros((3, 3)), [(0, 1, 2)], 1.0)
        with self.assertRaises(ValueError):
            face.add_triangles(np.zeros((3, 3)), [(0.0, 1.0, 2.0)], 1.0)
        with self.assertRaisesRegex(mpm.Error, "E_ARG.*pressure"):
            one.context.surface(stepper.grid, pressure=np.inf)
        with self.assertRaisesRegex(TypeError, "max_spacing"):
            one.context.surface(stepper.grid, spacing=0.1)
        with self.assertRaises(ValueError):
            face.configure(traction=(1.0, 2.0, 3.0))

    def test_tractions(self):
        one, stepper = block()
        face = one.context.surface(stepper.grid)
        face.add_polyline([(0.75, 0.25), (0.75, 0.75)], 1 / 24)
        stepper.add(face)
        asked = []

        def pull(batch, add):
            asked.append((batch.n, batch.dim, batch.t, batch.dt, batch.id.copy(), batch.area.copy(), batch.position.shape,
                          batch.displacement.shape, batch.velocity.shape, batch.reference_area.sum()))
            add[:, 0] += 12.0

        face.set_traction(pull)
        stepper.step(1e-4)
        np.testing.assert_allclose(face["force"].sum(axis=0), (6.0, 0.0), rtol=1e-12, atol=1e-15)
        self.assertEqual(len(asked), 1)
        self.assertEqual(asked[0][:4] + asked[0][6:9], (12, 2, 0.0, 1e-4, (12, 2), (12, 2), (12, 2)))
        np.testing.assert_array_equal(asked[0][4], face.ids)
        self.assertAlmostEqual(asked[0][5][:, 0].sum(), 0.5)
        self.assertAlmostEqual(asked[0][9], 0.5)
        before = stepper.hash

        def refuse(batch, add):
            add[:, 0] += 1.0
            raise KeyError("no traction")

        face.set_traction(refuse)
        with self.assertRaisesRegex(KeyError, "no traction"):
            stepper.step(1e-4)
        self.assertEqual(stepper.hash, before)
        face.set_traction(lambda batch, add: 1)
        with self.assertRaises(mpm.StepError) as caught:
            stepper.step(1e-4)
        self.assertEqual(caught.exception.status, mpm.CUT_DT)
        face.set_traction(None)
        stepper.step(1e-4)

    def test_what_is_prescribed(self):
        one, stepper = block()
        face = one.context.surface(stepper.grid, prescribes=mpm.PRESCRIBES_VELOCITY, velocity=(0.5, 0.0))
        face.add_polyline([(0.75, 0.25), (0.75, 0.75)], 1 / 24)
        stepper.add(face)
        face["prescribed_velocity"] = (0.25, 0.0)
        face.set_velocity(lambda batch, add: add.__setitem__((slice(None), 1), batch.t + 2.0))
        before = stepper.info.momentum
        stepper.step(1e-4)
        np.testing.assert_allclose(face["displacement"], np.tile((0.75e-4, 2e-4), (12, 1)), rtol=1e-12)
        force = stepper.surface_reaction(face)
        self.assertGreater(force[1], 0.0)
        np.testing.assert_allclose(face["reaction"].sum(axis=0), force, rtol=1e-9)
        np.testing.assert_allclose(stepper.surface_impulse(face), 1e-4 * force, rtol=1e-12)
        np.testing.assert_allclose(np.subtract(stepper.info.momentum, before)[:2], 1e-4 * force, rtol=1e-9)

        def refuse(batch, add):
            raise KeyError("no velocity")

        face.set_velocity(refuse)
        with self.assertRaisesRegex(KeyError, "no velocity"):
            stepper.step(1e-4)
        face.set_velocity(None)
        stepper.step(1e-4)

    def test_coming_and_going(self):
        one, stepper = block()
        face = one.context.surface(stepper.grid, pressure=10.0)
        face.add((0.75, 0.5), (0.5, 0.0))
        stepper.add(face)
        for call in (face.close, lambda: stepper.add(face)):
            with self.assertRaisesRegex(mpm.Error, "E_STATE"):
                call()
        state = stepper.save()
        stepper.step(1e-3)
        ahead, moved = stepper.hash, face["displacement"]
        stepper.load(state)
        self.assertEqual(face["displacement"][0, 0], 0.0)
        stepper.step(1e-3)
        self.assertEqual(stepper.hash, ahead)
        stepper.remove(face)
        self.assertEqual(stepper.surfaces, ())
        with self.assertRaisesRegex(mpm.Error, "E_NOT_FOUND"):
            stepper.remove(face)
        np.testing.assert_array_equal(face["displacement"], moved)
        before = stepper.info.momentum
        stepper.step(1e-3)
        np.testing.assert_allclose(stepper.info.momentum, before, rtol=1e-9, atol=1e-18)
        face.close()
        with self.assertRaisesRegex(Exception, "this Surface is closed"):
            len(face)

    def test_any_order_of_ends(self):
        for order in ((0, 1, 2, 3), (3, 2, 1, 0), (2, 0, 3, 1), (1, 3, 0, 2)):
            one, stepper = block(cells=8)
            estate = one.context._estate
            face = one.context.surface(stepper.grid)
            face.set_traction(lambda batch, add, held=(stepper, face): None)
            stepper.add(face)
            things = [one, stepper, face, stepper.grid]
            del one, stepper, face
            for index in order:
                things[index] = None
            gc.collect()
            self.assertEqual(len(estate.waiting), 0)


class States(unittest.TestCase):
    def test_restart(self):
        one, stepper = block(gravity=(0, -10))
        one["velocity"] = (0.1, 0.2)
        stepper.step(1e-3)
        state = stepper.save()
        with tempfile.TemporaryDirectory() as folder:
            stepper.save(f"{folder}/state")
            stepper.step(1e-3)
            ahead = stepper.hash
            for saved in (state, f"{folder}/state"):
                stepper.load(saved)
                stepper.step(1e-3)
                self.assertEqual(stepper.hash, ahead)
            stepper.load_pieces([state])
            stepper.step(1e-3)
            self.assertEqual(stepper.hash, ahead)
            with self.assertRaisesRegex(mpm.Error, "no part gives a piece"):
                stepper.load_pieces([])
            with self.assertRaisesRegex(mpm.Error, r"given twice"):
                stepper.load_pieces([state, state])
            with self.assertRaisesRegex(mpm.Error, "E_FORMAT"):
                stepper.load(state[:100])
            with self.assertRaisesRegex(mpm.Error, "E_IO"):
                stepper.save(f"{folder}/none/state")

    def test_files(self):
        one, stepper = block()
        stepper.step(1e-3)
        with tempfile.TemporaryDirectory() as folder:
            one.write(f"{folder}/a.vtp", "velocity", "stress")
            stepper.write_grid(f"{folder}/a.vti")
            series = one.context.series(f"{folder}/a.pvd")
            series.append(0.001, "a.vtp")
            series.close()
            with open(f"{folder}/a.pvd", encoding="utf-8") as file:
                self.assertIn("a.vtp", file.read())
            self.assertGreater(os.path.getsize(f"{folder}/a.vti"), 1000)

    def test_open_files(self):
        one, stepper = block()
        stepper.step(1e-3)
        with tempfile.TemporaryDirectory() as folder:
            for name, write in (("a.vtp", lambda to: one.write(to, "velocity")),
                                ("a.vti", lambda to: stepper.write_grid(to, "mass")), ("state", stepper.save)):
                write(f"{folder}/{name}")
                memory = io.BytesIO()
                write(memory)
                with open(f"{folder}/{name}", "rb") as file:
                    self.assertEqual(memory.getvalue(), file.read())
                few = Few()
                write(few)
                self.assertEqual(b"".join(few.taken), memory.getvalue())
            moved = stepper.hash
            stepper.step(1e-3)
            with open(f"{folder}/state", "rb") as file:
                stepper.load(file)
            self.assertEqual(stepper.hash, moved)
            odd = os.fsencode(folder) + b"/\xff.state"  # a name that is no text
            stepper.save(odd)
            stepper.load(os.fsdecode(odd))
        with self.assertRaises(io.UnsupportedOperation):
            with open("/dev/null", "rb") as file:
                stepper.save(file)

    def test_floats(self):
        one, _ = block()
        one["velocity"] = np.arange(2.0 * len(one)).reshape(-1, 2)
        packed = one.get_f32("position", "velocity", order=mpm.BY_ID)
        np.testing.assert_array_equal(packed, np.hstack([one["position"], one["velocity"]]).astype(np.float32))
        mixed = one.context.particles(one.grid, one.material)
        mixed.add([[0.1, 0.1], [0.2, 0.1], [0.3, 0.1]], 1e-4, ids=[7, 3, 5])
        np.testing.assert_array_equal(mixed.get_f32("id", "mass")[:, 0], [3, 5, 7])
        np.testing.assert_array_equal(mixed.get_f32("id", "mass", order=mpm.LIBRARY_ORDER)[:, 0], [7, 3, 5])
        with self.assertRaises(mpm.Error):
            one.get_f32("position", order=7)

    def test_packed(self):
        one, _ = block()
        other, _ = block()
        for each in one, other:
            each.add_field("colour", 3, np.uint8)
        one["colour"] = np.arange(3 * len(one)).reshape(-1, 3) % 251
        some = one.ids[::3]
        packed = one.pack(some)
        with self.assertRaisesRegex(mpm.Error, "is in use"):
            other.unpack(packed)
        other.remove(other.ids)
        other.unpack(packed)
        np.testing.assert_array_equal(other.ids, some)
        for field in "position", "mass", "colour":
            np.testing.assert_array_equal(other[field], one.get(field, some))
        other.remove(some)
        other.unpack(bytearray(one.pack()))
        self.assertEqual(other.pack(), one.pack())
        with self.assertRaisesRegex(mpm.Error, "damaged"):
            other.unpack(packed[:-1] + bytes([packed[-1] ^ 1]))

    def test_reports(self):
        one, stepper = block(gravity=(0, -10), pic_damping=10.0)
        stepper.wall(mpm.Y_MIN, mpm.WALL_SLIP)
        info = stepper.advance(0.01, cfl=0.3)
        self.assertAlmostEqual(info.t, 0.01)
        self.assertAlmostEqual(info.momentum[1], -0.1 * one["mass"].sum(), places=6)
        self.assertGreater(stepper.stable_dt(), 0.0)
        self.assertGreater(stepper.profile()["total"], 0.0)
        self.assertEqual(stepper.wall_impulse(mpm.Y_MIN).shape, (2,))
        stepper.configure(gravity=(0, 0))
        self.assertEqual(stepper.option("gravity"), (0, 0, 0))
        self.assertEqual(stepper.option("pic_damping"), 10.0)
        stepper.set_time(5.0, 7)
        self.assertEqual((stepper.t, stepper.info.step), (5.0, 7))
        one.set_geostatic(1, -10.0, 0.8, 0.5)
        self.assertLess(one["stress"][:, 1].max(), 0.0)

    def test_models(self):
        models = mpm.models()
        self.assertIsNone(models["neo_hookean"]["E"]["default"])
        self.assertEqual(models["j2"][None][0][0], "plastic_strain")


class Copies(unittest.TestCase):
    def test_errors_and_infos(self):
        one, stepper = block()
        info = stepper.step(1e-3)
        for made in (pickle.loads(pickle.dumps(info)), copy.copy(info), copy.deepcopy(info)):
            self.assertEqual((made.t, made.kinetic_energy), (info.t, info.kinetic_energy))
        one.set("velocity", (1e6, 0.0))
        with self.assertRaises(mpm.StepError) as caught:
            stepper.step(1e-3)
        for made in (pickle.loads(pickle.dumps(caught.exception)), copy.copy(caught.exception)):
            self.assertIs(type(made), mpm.StepError)
            self.assertEqual((str(made), made.status, made.text),
                             (str(caught.exception), caught.exception.status, caught.exception.text))
            self.assertEqual(made.info.cause, caught.exception.info.cause)


class Pictures(unittest.TestCase):
    def test_all_dimensions(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("there is no matplotlib")
        matplotlib.use("Agg")
        import mpm.plot
        for dim in (1, 2, 3):
            one, stepper = block(dim=dim, cells=6)
            stepper.step(1e-3)
            for by in ("speed", "pressure", "mises", "mass", np.arange(len(one))):
                axes = mpm.plot.draw(one, by=by)
            with tempfile.TemporaryDirectory() as folder:
                axes.figure.savefig(f"{folder}/a.png")
                self.assertGreater(os.path.getsize(f"{folder}/a.png"), 3000)
            matplotlib.pyplot.close("all")


if __name__ == "__main__":
    unittest.main()
