"""A knot of jelly, filled from a mesh of triangles, falls on a floor."""
import numpy as np

import mpm
import style

size, along, around = 0.6, 160, 20  # and how many points the tube has along and around itself

run = style.Run()
h = size / run.pick(48, 20)


def middle_line(t):
    """A trefoil knot."""
    return np.stack([np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t), -np.sin(3 * t)], axis=-1)


t, b = (np.linspace(0, 2 * np.pi, n, endpoint=False) for n in (along, around))
tangent = middle_line(t + 1e-4) - middle_line(t - 1e-4)
across = np.cross(tangent, (0, 0, 1))
across /= np.linalg.norm(across, axis=1)[:, None]
upward = np.cross(across, tangent)
upward /= np.linalg.norm(upward, axis=1)[:, None]
points = middle_line(t)[:, None] + 0.55 * (np.cos(b)[:, None] * across[:, None] + np.sin(b)[:, None] * upward[:, None])
points = points.reshape(-1, 3)
scale = size / np.ptp(points, axis=0).max()
tilt = np.radians(35)
points = scale * points @ np.array([[1, 0, 0], [0, np.cos(tilt), np.sin(tilt)], [0, -np.sin(tilt), np.cos(tilt)]])
points += (0, 0, 0.15 - points[:, 2].min())
i, j = (v.ravel() for v in np.meshgrid(np.arange(along), np.arange(around), indexing="ij"))
at = lambda di, dj: (i + di) % along * around + (j + dj) % around
triangles = np.concatenate([np.stack([at(0, 0), at(1, 0), at(1, 1)], axis=1), np.stack([at(0, 0), at(1, 1), at(0, 1)], axis=1)])

cells = np.rint(np.array([1.4, 1.4, 1.0]) / h).astype(int)
grid = run.context.grid(dim=3, cells=cells, spacing=h, origin=(-cells[0] * h / 2, -cells[1] * h / 2, -3 * h))
jelly = run.context.material("neo_hookean", E=2e4, nu=0.3, density=1000)
knot = run.context.particles(grid, jelly).fill_mesh(points, triangles)
stepper = run.context.stepper(grid, knot, scheme=mpm.MUSL, transfer=mpm.APIC, gravity=(0, 0, -9.81))
half = np.sqrt(0.5)
stepper.add(run.context.obstacle(mpm.SHAPE_PLANE, orientation=(half, half, 0, 0), contact={"friction": 0.4}))  # z = 0

view = style.View3(-60, 24, (0, 0, 0.28), 1.4, floor=0.0, grain=0.1)


def draw(size):
    tint = style.colours("strain", style.mises(knot), (0, 1e4))
    return view.draw(size, knot["position"], tint, 0.4 * h)


run.bar = ("strain", "von Mises stress, kPa", 0, 10)
run.advance(stepper, 0.8, 34, draw, still=0.5, cfl=0.4)
run.save()
