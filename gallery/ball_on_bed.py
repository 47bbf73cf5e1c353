"""A rigid ball falls on a bed of soft rubber, a quarter of which is cut away, and is thrown back."""
import numpy as np

import mpm
import style

side, deep, radius, mass = 0.8, 0.24, 0.12, 12.0

run = style.Run()
h = side / run.pick(20, 10)
grid = run.context.grid(dim=3, cells=np.rint(np.array([side, side, 0.8]) / h).astype(int), spacing=h, origin=(-0.4, -0.4, 0))
rubber = run.context.material("neo_hookean", E=2e4, nu=0.3, density=1000)
bed = run.context.particles(grid, rubber).fill_box((-0.4, -0.4, 0), (0.4, 0.4, deep))
stepper = run.context.stepper(grid, bed, scheme=mpm.MUSL, transfer=mpm.APIC, gravity=(0, 0, -9.81))
stepper.wall(mpm.Z_MIN, mpm.WALL_FIXED)
for face in (mpm.X_MIN, mpm.X_MAX, mpm.Y_MIN, mpm.Y_MAX):
    stepper.wall(face, mpm.WALL_SLIP)
ball = run.context.obstacle(mpm.SHAPE_SPHERE, size=radius, position=(0, 0, 0.55), motion=mpm.MOTION_FREE, mass=mass,
                            velocity=(0, 0, -1.0), inertia=np.eye(3) * 0.4 * mass * radius ** 2, contact={"friction": 0.3})
stepper.add(ball)

start = bed["position"]
shown = ~((start[:, 0] > 0) & (start[:, 1] < 0))
view = style.View3(-45, 24, (0, 0, 0.30), 1.5, floor=0.0, grain=0.2)


def draw(size):
    tint = style.colours("strain", style.mises(bed)[shown], (0, 8e3))
    return view.draw(size, bed["position"][shown], tint, 0.4 * h, balls=[(ball.position, radius, style.rgb("#5a6470"))])


run.bar = ("strain", "von Mises stress, kPa", 0, 8)
run.panels(stepper, (0.02, 0.16, 0.24, 0.4), draw, columns=2)
run.save()
