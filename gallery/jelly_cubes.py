"""Cubes of jelly fall on each other: each is a body with a velocity field of its own, and they meet with friction."""
import numpy as np

import mpm
import style

side = 0.2

run = style.Run()
h = side / run.pick(10, 4)
cells = np.rint(np.array([2.4, 2.4, 1.5]) / h).astype(int)
grid = run.context.grid(dim=3, cells=cells, spacing=h, origin=(-cells[0] * h / 2, -cells[1] * h / 2, -3 * h))
jelly = run.context.material("neo_hookean", E=3e4, nu=0.35, density=1000)
stepper = run.context.stepper(grid, scheme=mpm.MUSL, transfer=mpm.APIC, gravity=(0, 0, -9.81))
half = np.sqrt(0.5)
stepper.add(run.context.obstacle(mpm.SHAPE_PLANE, orientation=(half, half, 0, 0), contact={"friction": 0.5}))  # z = 0

# The centre of each cube, and how it is turned about the vertical axis and about x, in degrees.
places = [((-0.14, 0.0, 0.105), 8, 0), ((0.14, 0.02, 0.105), -10, 0), ((0.02, 0.0, 0.42), 35, 25), ((-0.06, 0.05, 0.76), 50, -30),
          ((0.08, -0.04, 1.1), 15, 40)]
cubes, tints = [], []
for number, (centre, yaw, tilt) in enumerate(places):
    (c, s), (d, e) = ((np.cos(a), np.sin(a)) for a in np.radians([yaw, tilt]))
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ np.array([[1, 0, 0], [0, d, -e], [0, e, d]])
    middle, reach = np.array(centre), np.full(3, 0.9 * side)
    cube = run.context.particles(grid, jelly)
    cube.fill(middle - reach, middle + reach, lambda x: (np.abs((x - middle) @ turn) < side / 2).all(axis=1))
    stepper.add(cube)
    stepper.set_body(cube, number)
    cubes.append(cube)
    tints.append(np.broadcast_to(style.rgb(style.BODIES[number]), (len(cube), 3)))
stepper.set_contact(friction=0.4)

view = style.View3(-60, 20, (0.02, 0.0, 0.35), 1.95, floor=0.0, grain=0.1)
tint = np.concatenate(tints)


def draw(size):
    return view.draw(size, np.concatenate([cube["position"] for cube in cubes]), tint, 0.42 * h)


run.advance(stepper, 0.95, 32, draw, still=0.45, cfl=0.4)
run.save()
