"""Obstacles and friction walls: blocks and discs on slopes, impacts, plates, free bodies."""
from plot import axes, loglog, plot, read, slope, ticks
from plot_cases import rows


@plot
def obstacle_slope():
    figure, ax = axes(3)
    blocks, discs = read("obstacle_slope_block"), read("obstacle_slope_disc")
    for basis in ("linear", "quadratic", "cubic"):
        at = rows(blocks, case="slides", name=f"plane ({basis})")
        ax[0].plot(at["shift"], [float(w) / float(e) for w, e in zip(at["way"], at["exact"])], "o-", label=basis)
    ax[0].axhline(1, color="k", linewidth=0.8)
    ax[0].set_xlabel("place of the plane in its cell / h")
    ax[0].set_ylabel("way of the block / exact, friction 0.3")
    ax[0].legend()
    for k, support in enumerate(("plane", "turned plane", "friction wall", "rigid body")):
        for case, value, mark in (("rolls", "way", "o-"), ("slides", "spin", "s--")):
            at = rows(discs, case=case, support=support)
            exact = at["exact" if value == "way" else "exact_spin"]
            worst = {}
            for h, v, e in zip(at["h"], at[value], exact):
                worst[h] = max(worst.get(h, 0), abs(v / e - 1))
            ax[1].plot([0.4 / h for h in worst], list(worst.values()), f"C{k}{mark}", label=f"{support}: {value}, disc {case}")
    loglog(ax[1], "R / h", "error / exact")
    slope(ax[1], (10, 20), 0.3, -1)
    ticks(ax[1], (10, 20))
    ax[1].legend(fontsize=7)
    for k, support in enumerate(("plane", "rigid body")):
        at = rows(discs, case="rolls settled", support=support)
        for value, exact, mark in (("way", "exact", "o-"), ("spin", "exact_spin", "s--")):
            worst = {}
            for h, v, e in zip(at["h"], at[value], at[exact]):
                worst[h] = max(worst.get(h, 0), abs(v / e - 1))
            ax[2].plot([0.4 / h for h in worst], list(worst.values()), f"C{k}{mark}", label=f"{support}: {value}, settled disc rolls")
    loglog(ax[2], "R / h", "error / exact")
    slope(ax[2], (10, 40), 0.2, -1)
    ticks(ax[2], (10, 20, 40))
    ax[2].legend(fontsize=7)
    return figure


@plot
def obstacle_impact():
    figure, ax = axes(2)
    table, data = read("obstacle_impact"), read("obstacle_impact_plates")
    for support in ("plane", "friction wall"):
        at = rows(table, case=support)
        ax[0].plot([1 / n for n in at["cells"]], [0.909 - r for r in at["rebound"]], "o", label=support)
    ax[0].set_xlim(0)
    ax[0].set_ylim(0)
    ax[0].set_xlabel("h")
    ax[0].set_ylabel("0.909 - rebound / speed")
    ax[0].legend()
    ax[1].plot(data["t"], [-v for v in data["upper"]], label="upper plate, driven")
    ax[1].plot(data["t"], data["lower"], label="lower plate, fixed")
    ax[1].set_xlabel("t")
    ax[1].set_ylabel("force on the disc")
    ax[1].legend()
    return figure


def hertz():
    """Force and depth over their largest, by time over that of the contact: w'' = -5/4 (2.9432)^2 w^(3/2)."""
    w, v, dt = 0.0, 2.9432, 1e-3
    t, depth, force = [0.0], [0.0], [0.0]
    while w >= 0:
        v -= dt * 1.25 * 2.9432 ** 2 * max(w, 0) ** 1.5
        w += dt * v
        t.append(t[-1] + dt)
        depth.append(max(w, 0))
        force.append(max(w, 0) ** 1.5)
    return t, depth, force


@plot
def obstacle_hertz():
    figure, ax = axes(2)
    data = read("obstacle_hertz")
    t, *exact = hertz()
    for panel, key, of in zip(ax, ("depth", "force"), exact):
        panel.plot([0.3691 * v for v in t], of, "k-", linewidth=1, label="Hertz")
        for name in ("plane", "friction wall", "lattice on a plane"):
            at = rows(data, case=name)
            panel.plot(at["t"], at[key], linewidth=0.8, label=name)
        panel.set_ylim(0)
        panel.set_xlim(0)
        panel.set_xlabel("t")
        panel.set_ylabel(f"{key} / largest of Hertz")
        panel.legend()
    return figure


@plot
def obstacle_free():
    figure, ax = axes()
    data = read("obstacle_free_tumble")
    for key in ("energy", "attitude"):
        ax.plot(data["dt"], data[key], "o-", label=key)
    loglog(ax, "dt", "largest error to t = 4")
    slope(ax, (0.005, 0.02), 2e-6, 2)
    ticks(ax, data["dt"])
    ax.legend()
    return figure
