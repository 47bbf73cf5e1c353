"""A paddle wheel stirs mud, which flows where it is pushed hard enough and stands elsewhere: colours show its layers."""
import numpy as np

import mpm
import style

wide, deep, high, turn = 0.6, 0.24, 0.45, 3.0  # turn: radians in a second
hub, arm, thick = np.array([0.3, 0.2]), 0.13, 0.012

run = style.Run()
h = run.pick(0.01, 0.03)
grid = run.context.grid(dim=2, cells=np.rint(np.array([wide, high]) / h).astype(int), spacing=h)
paste = run.context.material("herschel_bulkley", density=1300, bulk_modulus=2e5, gamma=1, shear_modulus=2e4, yield_shear=150,
                             consistency=20, n=0.6, tension=0)


def outside(x):
    """Where the wheel is not at the start."""
    dx, dy = (x - hub).T
    return (np.minimum(np.abs(dx), np.abs(dy)) > thick + h / 4) | (np.hypot(dx, dy) > arm + h / 4)


mud = run.context.particles(grid, paste).fill((0, 0), (wide, deep), outside)
stepper = run.context.stepper(grid, mud, transfer=mpm.APIC, gravity=(0, -9.81))
for face in (mpm.X_MIN, mpm.X_MAX, mpm.Y_MIN):
    stepper.wall(face, mpm.WALL_FIXED)
paddles = []
for quarter in (0, 1):
    half = np.pi / 4 * quarter
    paddles.append(run.context.obstacle(mpm.SHAPE_BOX, size=(arm, thick), position=hub, motion=mpm.MOTION_PRESCRIBED,
                                        orientation=(np.cos(half), 0, 0, np.sin(half)), angular_velocity=(0, 0, -turn),
                                        contact={"friction": 0.3}))
stepper.add(*paddles)

bands = np.array([style.rgb(c) for c in ("#6b4a2c", "#b98a55", "#8d6238", "#dcb88a")])
tint = bands[np.floor(mud["position"][:, 1] / 0.03).astype(int) % 4]
view = style.View2((-0.1, -0.03), wide + 0.2)
basin = [(style.box((-0.015, -0.015), (wide + 0.015, 0.36)), style.GREY), (style.box((0, 0), (wide, 0.5)), (1, 1, 1))]


def draw(size):
    corners = np.array([[-arm, -thick], [arm, -thick], [arm, thick], [-arm, thick]])
    shapes = list(basin)
    for one in paddles:
        w, z = one.orientation[[0, 3]]
        c, s = w * w - z * z, 2 * w * z
        shapes.append((hub + corners @ np.array([[c, s], [-s, c]]), style.rgb("#5a6470")))
    return view.draw(size, [(mud, tint)], shapes)


run.advance(stepper, 3.0, 36, draw, still=0.6)
run.save()
