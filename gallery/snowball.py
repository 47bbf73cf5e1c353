"""A snowball bursts on a post: snow that is pressed becomes hard, snow that is stretched falls apart."""
import numpy as np

import mpm
import style

radius, high = 0.1, 0.5
post = np.array([[0.12, -0.025, 0.0], [0.17, 0.025, 0.48]])

run = style.Run()
h = 2 * radius / run.pick(22, 8)
cells = np.rint(np.array([0.8, 0.8, high]) / h).astype(int)
grid = run.context.grid(dim=3, cells=cells, spacing=h, origin=(-0.2, -cells[1] * h / 2, 0))
law = run.context.material("snow", E=1.4e5, nu=0.2, density=400, critical_stretch=0.0025, hardening=7)
snow = run.context.particles(grid, law).fill_ball((0, 0, 0.3), radius)
snow["position"] += np.random.default_rng(1).uniform(-0.12, 0.12, (len(snow), 3)) * h  # no lattice shows
snow["velocity"] = (20, 0, 1)

stepper = run.context.stepper(grid, snow, transfer=mpm.APIC, gravity=(0, 0, -9.81))
stepper.wall(mpm.Z_MIN, mpm.WALL_FRICTION, 0.5)
for face in (mpm.X_MIN, mpm.X_MAX, mpm.Y_MIN, mpm.Y_MAX, mpm.Z_MAX):
    stepper.wall(face, mpm.WALL_OPEN)
stepper.add(run.context.obstacle(mpm.SHAPE_BOX, size=(post[1] - post[0]) / 2, position=post.mean(axis=0),
                                 contact={"friction": 0.3}))
view = style.View3(-118, 20, (0.22, 0, 0.24), 0.95, floor=0.0, grain=0.4,
                   boxes=[(*post, style.GREY)])


def draw(size):
    tint = style.colours("snow", style.speed(snow), (20, 0))
    return view.draw(size, snow["position"], tint, 0.36 * h)


run.milli, run.bar = True, ("snow", "speed, m/s", 20, 0)
run.advance(stepper, 0.036, 30, draw, still=0.55)
run.save()
