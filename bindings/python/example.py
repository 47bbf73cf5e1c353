"""The scene of bindings/example.c in Python: two elastic disks that collide under a force of the host."""
import mpm


def pull(batch, add):
    add[:, 1] += batch.mass * (-0.05 * batch.position[:, 0])


context = mpm.Context(isa=mpm.ISA_PORTABLE, concurrency=2)
grid = context.grid(dim=2, cells=40, spacing=0.025)
jelly = context.material("neo_hookean", E=1e3, nu=0.3, density=1e3)
left = context.particles(grid, jelly).fill_ball((0.2, 0.2), 0.15)
right = context.particles(grid, jelly).fill_ball((0.8, 0.8), 0.15)
left["velocity"] = 0.5
right["velocity"] = -0.5
stepper = context.stepper(grid, left, right, scheme=mpm.MUSL, projected_positions=1)
stepper.set_force(pull)
for _ in range(400):
    stepper.step(2e-3)
print(f"particles {len(left) + len(right)}\ntime {stepper.t:.6f}\nhash {stepper.hash:016x}")
