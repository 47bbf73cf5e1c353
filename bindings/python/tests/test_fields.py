"""Fields by id, views of the library's memory, and what ends them."""
import gc
import unittest
import warnings

import mpm
import numpy as np
from scenes import block


class Fields(unittest.TestCase):
    def test_copies_come_back(self):
        one, _ = block()
        n = len(one)
        self.assertEqual(one["position"].shape, (n, 2))
        self.assertEqual(one["mass"].shape, (n,))
        self.assertEqual(one["deformation_gradient"].shape, (n, 3, 3))
        self.assertEqual(one["stress"].shape, (n, 6))
        rng = np.random.default_rng(1)
        v = rng.normal(size=(n, 2))
        one["velocity"] = v
        np.testing.assert_array_equal(one["velocity"], v)
        F = np.eye(3) + 0.01 * rng.normal(size=(n, 3, 3)) * np.array([[1, 1, 0], [1, 1, 0], [0, 0, 1]])
        one["deformation_gradient"] = F
        np.testing.assert_array_equal(one["deformation_gradient"], F)
        one.set("velocity", [7.0, 8.0], ids=one.ids[3:5])
        np.testing.assert_array_equal(one.get("velocity", ids=one.ids[3:6]), [[7, 8], [7, 8], v[5]])
        one["velocity"] = 0.5
        self.assertTrue((one["velocity"] == 0.5).all())
        one["deformation_gradient"] = np.diag([1.1, 1.0, 1.0])
        self.assertTrue((one["deformation_gradient"] == np.diag([1.1, 1.0, 1.0])).all())

    def test_strain_of_a_tensor_is_not_transposed(self):
        one, _ = block()
        F = np.array([[1.0, 0.2, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
        one["deformation_gradient"] = F
        stored = one.view("deformation_gradient")  # xx xy yx yy zz
        self.assertEqual(stored.shape[1], 5)
        np.testing.assert_array_equal(stored[one.view("id") >= 0][0], [1.0, 0.2, 0.0, 1.0, 1.0])

    def test_own_fields(self):
        one, stepper = block()
        one.add_field("colour", dtype=np.uint8)
        one.add_field("history", components=3)
        one["colour"] = np.arange(len(one)) % 7
        one["history"] = np.outer(np.arange(len(one)), [1.0, 2.0, 3.0])
        stepper.step(1e-3)
        np.testing.assert_array_equal(one["colour"], np.arange(len(one)) % 7)
        self.assertEqual(one["history"][5, 2], 15.0)
        self.assertEqual(one.fields["colour"], (np.dtype(np.uint8), 1, True))
        with self.assertRaises(TypeError):
            one.add_field("bad", dtype=np.float32)

    def test_adding_and_removing(self):
        one, _ = block()
        n = len(one)
        ids = one.add([[0.1, 0.1], [0.15, 0.1]], 1e-3, velocity=[1.0, 2.0])
        self.assertEqual(list(ids), [n, n + 1])
        np.testing.assert_array_equal(one.get("velocity", ids), [[1, 2], [1, 2]])
        one.remove(ids)
        self.assertEqual(len(one), n)
        with self.assertRaises(mpm.Error) as caught:
            one.remove(ids)
        self.assertEqual(caught.exception.status, mpm.E_NOT_FOUND)

    def test_errors_have_the_sentence(self):
        one, _ = block()
        with self.assertRaisesRegex(mpm.Error, "E_NOT_FOUND.*velocity"):
            one["velocty"]
        with self.assertRaises(ValueError):
            one["velocity"] = np.zeros((3, 2))
        with self.assertRaisesRegex(mpm.Error, "E_ARG"):
            one["position"] = 17.0
        with self.assertRaisesRegex(mpm.Error, "neo_hookian.*neo_hookean"):
            one.context.material("neo_hookian", E=1)
        with self.assertRaisesRegex(TypeError, "no option 'gravitty'.*gravity"):
            one.context.stepper(one.grid, gravitty=1)


class Views(unittest.TestCase):
    def test_a_view_is_the_memory(self):
        one, stepper = block()
        v = one.view("velocity", write=True)
        v[...] = 0.25
        del v
        self.assertTrue((one["velocity"] == 0.25).all())
        x = one.view("position")
        self.assertFalse(x.flags.writeable)
        with self.assertRaises(ValueError):
            x[0, 0] = 1.0

    def test_steps_wait_for_the_last_array(self):
        one, stepper = block()
        x = one.view("position")
        part = x[3:9, 0]
        with self.assertRaises(mpm.Error) as caught:
            stepper.step(1e-3)
        self.assertEqual(caught.exception.status, mpm.E_STATE)
        del x
        with self.assertRaises(mpm.Error):
            stepper.step(1e-3)
        kept = part.copy()
        del part
        stepper.step(1e-3)
        self.assertEqual(len(kept), 6)

    def test_a_view_keeps_what_it_shows(self):
        one, stepper = block()
        x = one.view("position")
        before = x.copy()
        del one, stepper
        gc.collect()
        np.testing.assert_array_equal(x, before)

    def test_an_empty_set(self):
        context = mpm.Context()
        grid = context.grid(dim=2, cells=4, spacing=0.25)
        one = context.particles(grid, context.material("neo_hookean", E=1, nu=0.3, density=1))
        self.assertEqual(one["velocity"].shape, (0, 2))
        self.assertEqual(one.view("velocity").shape, (0, 2))

    def test_bad_values_are_told(self):
        one, stepper = block()
        v = one.view("velocity", write=True)
        v[np.flatnonzero(one.view("id") == 5)[0], 0] = np.nan
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            del v
        self.assertIn("E_ARG", str(told[0].message))
        with self.assertRaisesRegex(mpm.Error, "E_STATE"):
            stepper.step(1e-3)
        one.set("velocity", 0.0, ids=[5])
        stepper.step(1e-3)

    def test_numbers_that_do_not_fit(self):
        """Nothing is cut off, wraps around or is spread where that was not meant."""
        one, stepper = block()
        one.add_field("colour", dtype=np.int64)
        one.set("colour", [1.0, 2.0], ids=[0, 1])
        self.assertEqual(list(one.get("colour", [0, 1])), [1, 2])
        for name, value in (("colour", 1.5), ("prescribed", 256), ("prescribed", -1)):
            with self.assertRaisesRegex(ValueError, "not all held"):
                one[name] = value
            with self.assertRaisesRegex(ValueError, "not all held"):
                one[name] = np.broadcast_to(value, one[name].shape)
        with self.assertRaisesRegex(TypeError, "per_cell.*whole"):
            one.fill_box(0.0, 0.1, per_cell=2.9)
        with self.assertRaisesRegex(ValueError, r"\(3, 1\)"):
            one.add(np.full((3, 1), 0.5), 1e-4)
        with self.assertRaisesRegex(ValueError, r"\(3, 1\)"):
            one.add(np.full((3, 2), 0.5), 1e-4, velocity=np.zeros((3, 1)))
        context = one.context
        for call in (lambda: context.grid(dim=2 + 2**32, cells=4, spacing=1), lambda: stepper.advance(1.0, max_steps=2**64),
                     lambda: context.grid(dim=2, cells=(4, 2**64), spacing=1), lambda: mpm.Context(concurrency=2**32)):
            with self.assertRaisesRegex(OverflowError, "dim|max_steps|cells|concurrency"):
                call()
        with self.assertRaisesRegex(Exception, "beyond an integer of 4 bytes"):
            stepper.wall(2**32, mpm.WALL_SLIP)
        with self.assertRaisesRegex(TypeError, "Stepper: flip = '1'"):
            stepper.configure(flip="1")
        with self.assertRaisesRegex(TypeError, "neo_hookean: E = '1e4' is no number"):
            context.material("neo_hookean", E="1e4", nu=0.3, density=1e3)
        self.assertEqual(len(one), 144)

    def test_masks_are_no_ids(self):
        one, stepper = block()
        mask = np.arange(len(one)) == 3
        for ids in (mask, [0.0, 2.9]):
            for call in (one.remove, lambda ids: one.set("velocity", 1.0, ids=ids), lambda ids: one.get("mass", ids=ids)):
                with self.assertRaisesRegex(TypeError, "whole numbers"):
                    call(ids)
        count = len(one)
        one.remove(np.flatnonzero(mask))
        self.assertEqual(len(one), count - 1)
        one.remove([])

    def test_nodes_without_sets(self):
        one, stepper = block(flip=0)
        stepper.remove(one)
        stepper.step(1e-3)
        self.assertEqual(len(stepper.nodes("mass")), 0)
        stepper.close()

    def test_nodes(self):
        one, stepper = block(flip=0)
        stepper.step(1e-3)
        mass = stepper.nodes("mass")
        self.assertEqual(stepper.nodes("owned").sum(), len(mass))
        self.assertAlmostEqual(mass.sum(), one["mass"].sum(), places=9)
        with self.assertRaises(mpm.Error):
            stepper.step(1e-3)
        del mass
        stepper.begin(1e-3)
        v = stepper.nodes("velocity", write=True)
        v[:, 1] = 2.0
        del v
        stepper.update_grid()
        stepper.end()
        np.testing.assert_allclose(one["velocity"][:, 1], 2.0, rtol=1e-12)


if __name__ == "__main__":
    unittest.main()
