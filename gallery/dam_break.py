"""A dam breaks: water runs against a square column and splashes up the far wall."""
import numpy as np

import mpm
import style

long, wide, high = 1.6, 0.5, 0.7
column = np.array([[0.95, 0.19, 0.0], [1.07, 0.31, 0.6]])

run = style.Run()
h = wide / run.pick(22, 8)
cells = np.rint(np.array([long, wide, high]) / h).astype(int)
grid = run.context.grid(dim=3, cells=cells, spacing=h)
sound = 10 / np.sqrt(7) * np.sqrt(2 * 9.81 * 0.4)  # 3.8 times the speed of the front: the density changes by 7 %
fluid = run.context.material("newtonian_fluid", density=1000, bulk_modulus=1000 * sound ** 2, viscosity=1e-3, tension=0)
water = run.context.particles(grid, fluid).fill_box((0, 0, 0), (0.5, wide, 0.4))

stepper = run.context.stepper(grid, water, transfer=mpm.APIC, gravity=(0, 0, -9.81))
for face in (mpm.X_MIN, mpm.X_MAX, mpm.Y_MIN, mpm.Y_MAX, mpm.Z_MIN, mpm.Z_MAX):
    stepper.wall(face, mpm.WALL_SLIP)
half = (column[1] - column[0]) / 2
stepper.add(run.context.obstacle(mpm.SHAPE_BOX, size=half, position=column.mean(axis=0)))

view = style.View3(-62, 26, (0.8, 0.25, 0.2), 1.75, floor=0.0, grain=0.05, boxes=[(*column, style.GREY)])


def draw(size):
    return view.draw(size, water["position"], style.colours("water", style.speed(water), (0, 3)), 0.5 * h)


run.bar = ("water", "speed, m/s", 0, 3)
run.advance(stepper, 1.2, 32, draw, still=0.5)
run.save()
