"""Three blocks stand at rest, found by implicit steps; a driven disc then pushes the top one over in explicit ones."""
import numpy as np

import mpm
import style

wide, tall, radius, speed = 0.32, 0.4, 0.15, 1.0

run = style.Run()
h = run.pick(0.04, 0.08)
grid = run.context.grid(dim=2, cells=np.rint(np.array([3.6, 1.76]) / h).astype(int), spacing=h, origin=(-0.6, -4 * h))
rubber = run.context.material("neo_hookean", E=1e6, nu=0.3, density=1000)
blocks = [run.context.particles(grid, rubber).fill_box((0, k * tall), (wide, (k + 1) * tall)) for k in range(3)]
floor = run.context.obstacle(mpm.SHAPE_PLANE, contact={"friction": 0.5})
disc = run.context.obstacle(mpm.SHAPE_SPHERE, size=radius, position=(-radius - 0.02, 1.1), motion=mpm.MOTION_PRESCRIBED,
                            contact={"friction": 0.5})
implicit = dict(scheme=mpm.NEWMARK, quasi_static=1)
stepper = run.context.stepper(grid, *blocks, gravity=(0, -10), **implicit)
for number, block in enumerate(blocks):
    stepper.set_body(block, number)
stepper.set_contact(friction=0.5)
stepper.add(floor, disc)

for _ in range(2):  # to equilibrium; the second step finds the friction of the first one's shortening
    stepper.step(1.0)
for block in blocks:
    block["velocity"] = 0
stepper.configure(scheme=mpm.MUSL, quasi_static=0, transfer=mpm.APIC)
stepper.set_time(0.0)
disc.set_pose(velocity=(speed, 0, 0))
view = style.View2((-0.5, -0.12), 1.85)


def draw(size):
    sets = [(block, style.rgb(tint)) for block, tint in zip(blocks, style.BODIES)]
    shapes = [(style.disc(disc.position[:2], radius), style.GREY), (style.box((-0.5, -0.02), (1.5, 0)), style.GREY)]
    return view.draw(size, sets, shapes)


run.size = (400, 330)
run.advance(stepper, 1.1, 45, draw, still=0.62)
run.save()
