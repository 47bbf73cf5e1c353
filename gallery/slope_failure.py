"""A slope of softening soil fails as its weight grows: bands of shear, then blocks that slide."""
import numpy as np

import mpm
import style

height, crest, base, length, grow = 10.0, 12.0, 4.0, 40.0, 10.0

run = style.Run()
h = height / run.pick(24, 8)
grid = run.context.grid(dim=2, cells=(round(length / h), round((base + height) / h) + 4), spacing=h)
clay = run.context.material("mohr_coulomb", E=1e7, nu=0.35, density=2000, phi=20, cohesion=1e4, cohesion_residual=2e3,
                            hardening=-4e4)
soil = run.context.particles(grid, clay)
soil.fill((0, 0), (length, base + height), lambda x: (x[:, 1] < base) | (x[:, 1] - base < crest + height - x[:, 0]))

stepper = run.context.stepper(grid, soil, scheme=mpm.MUSL, pic_damping=2.0)
stepper.wall(mpm.X_MIN, mpm.WALL_SLIP).wall(mpm.X_MAX, mpm.WALL_SLIP).wall(mpm.Y_MIN, mpm.WALL_FIXED)


def weigh(batch, add):
    add[:, 1] -= 9.81 * min(batch.t / grow, 1.0)


stepper.set_acceleration(weigh)

view = style.View2((0, -0.3), length)


def draw(size):
    return view.draw(size, [(soil, style.colours("strain", soil["state"][:, 0], (0, 1)))])


run.size, run.bar = (560, 320), ("strain", "plastic strain", 0, 1)
run.panels(stepper, (8.6, 9.6, 10.6, 14.0), draw, columns=2, cfl=0.4)
run.save()
