"""One scene with 1, 2 and 7 threads: the numbers under the pictures are hashes of all bits of the final states."""
import numpy as np

import mpm
import style

run = style.Run()
h = run.pick(0.0125, 0.05)
view = style.View2((-0.02, -0.03), 1.04)


def splash(threads):
    """A block of water falls on a round obstacle."""
    context = mpm.Context(concurrency=threads)
    grid = context.grid(dim=2, cells=round(1 / h), spacing=h)
    fluid = context.material("newtonian_fluid", density=1000, bulk_modulus=1e5, viscosity=0.1, tension=0)
    water = context.particles(grid, fluid).fill_box((0.3, 0.5), (0.7, 0.8))
    post = context.obstacle(mpm.SHAPE_SPHERE, size=0.1, position=(0.45, 0.22))
    stepper = context.stepper(grid, water, post, transfer=mpm.APIC, gravity=(0, -9.81))
    for face in (mpm.X_MIN, mpm.X_MAX, mpm.Y_MIN, mpm.Y_MAX):
        stepper.wall(face, mpm.WALL_SLIP)
    stepper.advance(run.pick(0.36, 0.02))
    return water, stepper


pictures, hashes = [], []
for threads in (1, 2, 7):
    water, stepper = splash(threads)
    tint = style.colours("water", style.speed(water), (0, 3))
    shapes = [(style.box((-0.02, -0.02), (1.02, 0)), style.GREY), (style.disc((0.45, 0.22), 0.1), style.GREY)]
    picture = run.padded(view.draw((320, 250), [(water, tint)], shapes))
    hashes.append(stepper.hash)
    pictures.append(run.caption(picture, text=f"{threads} thread{'s' * (threads > 1)}: {stepper.hash:016x}", bar=False, unit=1.5))
if len(set(hashes)) > 1:
    raise RuntimeError(f"the states differ: {hashes}")
run.bar = ("water", "speed, m/s", 0, 3)
run.count(stepper)
run.save(run.sheet(pictures, 3))
