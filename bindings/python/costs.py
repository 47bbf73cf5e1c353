"""What calls and callbacks cost from Python: best of many, by turns, with 20 000 particles on one thread."""
import time

import mpm
import numpy as np


def make(callback=None, law=None, n=140):
    context = mpm.Context()
    grid = context.grid(dim=2, cells=200, spacing=1 / 200)
    material = context.law(law, 1e3) if law else context.material("neo_hookean", E=1e3, nu=0.3, density=1e3)
    one = context.particles(grid, material).fill_box(0.1, 0.1 + n / 400)
    stepper = context.stepper(grid, one, transfer=mpm.APIC_MLS)
    stepper.set_force(callback)
    for _ in range(20):
        stepper.step(1e-4)
    return one, stepper


def best(work, tries=200):
    times = []
    for _ in range(tries):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return 1e6 * min(times)


def numpy_pull(batch, add):
    add[:, 1] += batch.mass * (-0.05 * batch.position[:, 0])


def loop_pull(batch, add):
    for i in range(batch.n):
        add[i, 1] += batch.mass[i] * (-0.05 * batch.position[i, 0])


MU, LAMBDA = 1e3 / 2.6, 300 / (1.3 * 0.4)


def numpy_law(batch):
    F = batch.F
    J = np.linalg.det(F)
    s = (MU * (F @ F.transpose(0, 2, 1) - np.eye(3)) + LAMBDA * np.log(J)[:, None, None] * np.eye(3)) / J[:, None, None]
    for to, (i, j) in enumerate(((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))):
        batch.stress_new[:, to] = s[:, i, j]
    batch.wave_speed[:] = 1.16


def loop_law(batch):
    for p in range(batch.n):
        F = batch.F[p]
        J = (F[0, 0] * F[1, 1] - F[0, 1] * F[1, 0]) * F[2, 2]
        pressure = LAMBDA * np.log(J)
        at = 0
        for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)):
            s = MU * (F[i, 0] * F[j, 0] + F[i, 1] * F[j, 1] + F[i, 2] * F[j, 2])
            if i == j:
                s += pressure - MU
            batch.stress_new[p, at] = s / J
            at += 1
        batch.wave_speed[p] = 1.16


def main():
    one, stepper = make()
    print(f"{len(one)} particles; microseconds")
    print(f"a call (len)                     {best(lambda: len(one), 5000):8.2f}")
    print(f"view of positions, and its end   {best(lambda: one.view('position'), 5000):8.2f}")
    print(f"copy of positions by id          {best(lambda: one['position']):8.1f}")
    kinds = {"step": make(), "force, numpy": make(numpy_pull), "law, numpy": make(law=numpy_law)}
    small = {"step, 100 particles": make(n=10), "force, numpy, 100": make(numpy_pull, n=10)}
    try:
        import mpm.numba
        kinds["force, numba"] = make(mpm.numba.particles(loop_pull))
        kinds["law, numba"] = make(law=mpm.numba.stress(loop_law))
    except ImportError:
        print("numba is not there")
    for group in (small, kinds):
        times = {name: [] for name in group}
        for _ in range(40):
            for name, (_, each) in group.items():  # five in a row: the caches are as in a simulation, not those of others
                times[name].append(best(lambda: each.step(1e-4), 5))
        base = min(next(iter(times.values())))
        for name, all_of_them in times.items():
            print(f"{name:32} {min(all_of_them):8.1f}  {100 * (min(all_of_them) / base - 1):+5.0f} %")


if __name__ == "__main__":
    main()
