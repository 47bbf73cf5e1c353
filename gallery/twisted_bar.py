"""A rubber bar is twisted by two turns and let go: on a total Lagrangian grid, whose cells it never leaves."""
import numpy as np

import mpm
import style

side, length, turns, twisting = 0.1, 0.5, 2.0, 0.8  # twisting: seconds until it is let go

run = style.Run()
h = side / run.pick(8, 4)
cells = np.rint(np.array([side, side, length]) / h).astype(int)
grid = run.context.grid(dim=3, cells=cells, spacing=h, origin=(-side / 2, -side / 2, 0), total_lagrangian=1)
rubber = run.context.material("neo_hookean", E=2e5, nu=0.35, density=1000)
bar = run.context.particles(grid, rubber).fill_box((-side / 2, -side / 2, 0), (side / 2, side / 2, length))
stepper = run.context.stepper(grid, bar, scheme=mpm.MUSL, transfer=mpm.FLIP, flip=0.995)


def angle(t):
    return 2 * np.pi * turns * min(t, twisting) / twisting


def hold(batch, prescribed, velocity):
    """The lower end rests; the upper one turns until it is let go. Nodes have the places that they had at the start."""
    x = batch.position
    low, high = x[:, 2] < 0.5 * h, x[:, 2] > length - 0.5 * h
    prescribed[low] = 1
    if batch.t < twisting:
        prescribed[high] = 1
        a, b = angle(batch.t), angle(batch.t + batch.dt)
        change = np.array([[np.cos(b) - np.cos(a), np.sin(a) - np.sin(b)], [np.sin(b) - np.sin(a), np.cos(b) - np.cos(a)]])
        velocity[high, :2] = x[high, :2] @ change.T / batch.dt


stepper.set_velocity_bc(hold)
tint = np.where((np.floor(bar["reference_position"][:, 2] / (length / 10)).astype(int) % 2 == 0)[:, None],
                style.rgb("#2f7fb8"), style.rgb("#e8a33d"))
view = style.View3(-55, 16, (0.06, 0.06, 0.62 * length), 1.3, floor=0.0, grain=0.05)


def draw(size):
    return view.draw(size, bar["position"], tint, 0.45 * h)


run.advance(stepper, 1.4, 44, draw, still=0.56, cfl=0.5)
run.save()
