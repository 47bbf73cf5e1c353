"""Sand runs through an hourglass, at a rate that hardly depends on how much is above."""
import numpy as np

import mpm
import style

width, neck, chamber, fill, top, thick = 0.2, 0.04, 0.2, 0.36, 0.42, 0.01

run = style.Run()
h = neck / run.pick(7, 3)
grid = run.context.grid(dim=2, cells=(round(width / h), round(top / h)), spacing=h)
soil = run.context.material("drucker_prager", E=2e5, nu=0.3, density=2000, phi=30, cone=2)  # the cone of plane strain
sand = run.context.particles(grid, soil)
sand.fill((0, chamber), (width, fill), lambda x: x[:, 1] > chamber + np.abs(x[:, 0] - width / 2) - neck / 2 + h / 2)

stepper = run.context.stepper(grid, sand, scheme=mpm.MUSL, transfer=mpm.APIC, gravity=(0, -9.81))
for face in (mpm.X_MIN, mpm.X_MAX):
    stepper.wall(face, mpm.WALL_FRICTION, 0.4)
stepper.wall(mpm.Y_MIN, mpm.WALL_FIXED)

# The funnel: two boxes whose upper faces end at the neck.
half, funnel = 0.5 * (width - neck) / np.sqrt(2) + thick, []
for side in (-1, 1):
    centre = np.array([width / 2 + side * (neck / 2 + np.sqrt(0.5) * (half + thick)), chamber + np.sqrt(0.5) * (half - thick)])
    stepper.add(run.context.obstacle(mpm.SHAPE_BOX, size=(half, thick), position=centre, contact={"friction": 0.4},
                                     orientation=(np.cos(side * np.pi / 8), 0, 0, np.sin(side * np.pi / 8))))
    along, across = np.array([1, side]) * half / np.sqrt(2), np.array([-side, 1]) * thick / np.sqrt(2)
    funnel.append((centre + [-along - across, along - across, along + across, -along + across], style.GREY))

layer = np.floor(sand["position"][:, 1] / 0.02) % 2
tint = np.where(layer[:, None] > 0, style.rgb("#e3b873"), style.rgb("#a8703c"))
glass = [(style.box((x - 0.05, -0.05), (x + 0.05, top)), (1, 1, 1)) for x in (-0.056, width + 0.056)]
glass += [(style.box((x - 0.003, -0.006), (x + 0.003, top)), style.GREY) for x in (-0.003, width + 0.003)]
glass.append((style.box((0, -0.006), (width, 0)), style.GREY))
view = style.View2((-0.02, -0.012), width + 0.04)

run.size = (250, 480)
run.advance(stepper, run.pick(1.9, 1.0), 40, lambda size: view.draw(size, [(sand, tint)], funnel + glass), still=0.3)
run.save()
