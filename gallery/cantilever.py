"""A cantilever of rubber bends under more and more load: quasi-static implicit steps, each of which ends in equilibrium."""
import numpy as np
from PIL import Image

import mpm
import style

length, depth = 4.0, 0.5

run = style.Run()
h = depth / run.pick(6, 3)
grid = run.context.grid(dim=2, cells=(round(4.8 / h), round(4.8 / h)), spacing=h, origin=(-4 * h, -4))
rubber = run.context.material("neo_hookean", E=1e6, nu=0.3, density=1000)
beam = run.context.particles(grid, rubber).fill_box((0, 0), (length, depth))
stepper = run.context.stepper(grid, beam, scheme=mpm.NEWMARK, quasi_static=1)


def clamp(batch, prescribed, velocity):
    x, y = batch.position.T
    held = (x < 0.01 * h) & (y > -1.01 * h) & (y < depth + 1.01 * h)
    prescribed[held], velocity[held] = 1, 0


stepper.set_velocity_bc(clamp)
view = style.View2((-0.8, -2.75), 6.3)
size, pictures = (960, 600 - run.strip()), []
loads = run.pick(np.linspace(0, 3, 13), np.linspace(0, 0.25, 2))  # weights of the beam, in m/s^2
for load in loads:
    if load:
        stepper.configure(gravity=(0, -load))
        stepper.step(1.0)
    if len(pictures) == 0 or load in (0.25, 0.75, 1.5, 3.0):
        tint = style.colours("strain", style.mises(beam), (0, 2e5))
        wall = [(style.box((-0.25, -0.3), (0, depth + 0.3)), style.GREY)]
        pictures.append(view.draw(size, [(beam, tint)], wall))

# One over the other: the darkest of all pictures at each pixel.
over = Image.fromarray(np.min([np.asarray(p) for p in pictures], axis=0))
run.bar = ("strain", "von Mises stress, kPa", 0, 200)
run.count(stepper)
run.save(run.caption(run.padded(over), text="gravity 0, 0.25, 0.75, 1.5 and 3 m/s²"))
