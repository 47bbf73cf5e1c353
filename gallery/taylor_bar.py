"""A copper bar hits a wall at 227 m/s: before, during and after, cut open. A quarter is computed, and drawn three times."""
import numpy as np

import mpm
import style

radius, length, speed = 3.2e-3, 32.4e-3, 227.0

run = style.Run()
n = run.pick(6, 3)
h = radius / n
grid = run.context.grid(dim=3, cells=(3 * n, 3 * n, round(length / h) + 1), spacing=(h, h, length / round(length / h)))
metal = run.context.material("j2", E=117e9, nu=0.35, density=8930, yield_stress=400e6, hardening=100e6)
copper = run.context.particles(grid, metal)
copper.fill((0, 0, 0), (radius, radius, length), lambda x: np.hypot(x[:, 0], x[:, 1]) < radius)
copper["velocity"] = (0, 0, -speed)

stepper = run.context.stepper(grid, copper)
for face in (mpm.X_MIN, mpm.Y_MIN, mpm.Z_MIN):  # two planes of symmetry, and the wall
    stepper.wall(face, mpm.WALL_SLIP)

view = style.View3(-45, 15, (0, 0, 0.0152), 0.0232, floor=0.0, grain=0.2)
mirrors = np.array([[1, 1, 1], [-1, 1, 1], [-1, -1, 1]])


def draw(size):
    x = np.concatenate([copper["position"] * m for m in mirrors])
    tint = style.colours("strain", copper["state"], (0, 2))
    return view.draw(size, x, np.tile(tint, (3, 1)), 0.33 * h)


run.milli, run.bar = True, ("strain", "plastic strain", 0, 2)
run.panels(stepper, (0, 20e-6, 80e-6), draw, columns=3, cfl=0.4)
run.save()
