"""A round column of sand collapses. A quarter is not drawn, so that its layers show which sand has slid, and which stays."""
import numpy as np

import mpm
import style

radius, height = 0.1, 0.16

run = style.Run()
h = radius / run.pick(10, 4)
cells = np.ceil(np.array([0.64, 0.64, 0.2]) / h).astype(int)
grid = run.context.grid(dim=3, cells=cells, spacing=h, origin=(-cells[0] * h / 2, -cells[1] * h / 2, 0))
soil = run.context.material("drucker_prager", E=5e5, nu=0.3, density=2000, phi=30)
sand = run.context.particles(grid, soil)
sand.fill((-radius, -radius, 0), (radius, radius, height), lambda x: np.hypot(x[:, 0], x[:, 1]) < radius)
sand.set_geostatic(2, -9.81, height, 0.5)

stepper = run.context.stepper(grid, sand, transfer=mpm.APIC, gravity=(0, 0, -9.81))
stepper.wall(mpm.Z_MIN, mpm.WALL_FRICTION, 0.6)

layer = np.floor(sand["position"][:, 2] / (height / 6)) % 2  # of the column as it stood
tint = np.where(layer[:, None] > 0, style.rgb("#e3b873"), style.rgb("#a8703c"))
shown = ~((sand["position"][:, 0] > 0) & (sand["position"][:, 1] < 0))
view = style.View3(-48, 24, (0, 0, 0.06), 0.5, floor=0.0, grain=0.5)


def draw(size):
    return view.draw(size, sand["position"][shown], tint[shown], 0.36 * h)


run.advance(stepper, 0.35, 30, draw, still=0.5)
run.save()
