"""Contact of bodies: a slab, a stack, a row of discs, a corner, a rod that bores; all scenes by all methods."""
from plot import axes, loglog, plot, read, slope, ticks
from plot_cases import rows


@plot
def contact_slab():
    figure, ax = axes(2)
    data = read("contact_slab")
    for case, label in (("slides", "slides down the slope"), ("stops", "stops on the level")):
        at = rows(data, case=case)
        ways = [float(w) / float(e) for w, e in zip(at["way"], at["exact"])]
        ax[0].plot([1 / c for c in at["cells"]], ways, "o", label=label)
    ax[0].axhline(1, color="k", linewidth=0.8)
    ax[0].set_xlim(0)
    ax[0].set_xlabel("h")
    ax[0].set_ylabel("way of the block / exact")
    ax[0].legend()
    for case, key, label in (("rests", "way", "creep on the slope, 0.5 s"), ("stops", "range", "on the level, 1 to 1.5 s")):
        at = rows(data, case=case)
        ax[1].plot([1 / c for c in at["cells"]], [1e3 * float(v) for v in at[key]], "o", label=label)
    ax[1].set_xlim(0)
    ax[1].set_ylim(0)
    ax[1].set_xlabel("h")
    ax[1].set_ylabel("moves at rest, mm")
    ax[1].legend()
    return figure


@plot
def contact_release():
    figure, ax = axes(2)
    data = read("contact_release")
    for panel, push in zip(ax, (0.05, 0.1)):
        for name in ("linear", "GIMP", "quadratic", "cubic"):
            at = rows(data, name=name, push=push)
            if at["shift"]:
                panel.plot(at["shift"], [1e3 * way for way in at["way"]], "o-", label=name)
        panel.axhline(1e3 * rows(data, name="elements", push=push)["way"][0], color="k", linewidth=0.8)
        panel.axhline(1e3 * 0.5 * push**2 / 1.06217783, color="k", linewidth=0.8, linestyle="--")
        panel.set_xlabel("place of the floor in its cell / h (full: elements, dashed: rigid)")
        panel.set_ylabel(f"way in 0.5 s / mm, pushed by {push} m/s")
        panel.legend()
    return figure


@plot
def contact_stack():
    figure, ax = axes(2)
    data = read("contact_stack")
    for floor in ("on a body", "on a plane"):
        at = rows(data, floor=floor)
        ax[0].plot(at["t"], at["kinetic"], label=floor)
        ax[1].plot(at["t"], at["drift"], label=floor)
    for panel, label in zip(ax, ("kinetic energy / that of gravity", "largest drift of a block / height")):
        panel.set_xlabel("t")
        panel.set_ylabel(label)
        panel.set_ylim(0)
        panel.legend()
    return figure


@plot
def contact_row():
    figure, ax = axes()
    data = read("contact_row")
    for cells, line in ((10, "--"), (20, "-")):
        at = rows(data, cells=cells)
        for k, disc in enumerate(("first", "second", "third", "last")):
            ax.plot(at["t"], at[disc], f"C{k}{line}", label=f"{disc} disc" if cells == 20 else None)
    ax.set_xlabel("t (dashed: h = 1/10, full: 1/20)")
    ax.set_ylabel("speed / first speed of the first disc")
    ax.legend()
    return figure


@plot
def contact_corner():
    figure, ax = axes()
    data = read("contact_corner")
    for place in (0, 0.37):
        at = rows(data, shift=place)
        h = [1 / c for c in at["cells"]]
        ax.plot(h, [t - 0.2 for t in at["touch"]], "os"[place > 0], fillstyle="none", label=f"corner at {place:g} h")
    loglog(ax, "h", "time of touch - 0.2")
    slope(ax, (0.0125, 0.05), 0.007, 1)
    ticks(ax, (0.0125, 0.025, 0.05))
    ax.legend()
    return figure


@plot
def contact_rod():
    figure, ax = axes(2)
    data = read("contact_rod")
    for k, friction in enumerate((0, 0.3)):
        for h, line in ((1, "--"), (0.5, "-")):
            at = rows(data, h=h, friction=friction)
            ax[0].plot(at["t"], at["bored"], f"C{k}{line}", label=f"friction {friction:g}, h = {h:g} mm")
            means = [sum(at["pressure"][i:i + 10]) / 10 for i in range(0, len(at["t"]) - 9, 10)]
            ax[1].plot(at["t"][5::10][:len(means)], means, f"C{k}{line}")
    ax[1].axhline(148.4, color="k", linewidth=0.8, label="Prandtl, without friction")
    ax[1].set_ylim(0, 400)
    for panel, label in zip(ax, ("bored / mm", "mean pressure on the face / MPa")):
        panel.set_xlabel("t / us")
        panel.set_ylabel(label)
        panel.legend()
    return figure


@plot
def contact_methods():
    figure, ax = axes(2, width=6.0, height=4.2)
    data = read("contact_methods")
    scenes = list(dict.fromkeys(data["scene"]))
    for panel, key, gate, label in ((ax[0], "energy", 5e-4, "energy above that of the start / that"),
                                    (ax[1], "momentum", 1e-12, "momentum less impulses / all")):
        for k, scheme in enumerate(("USL", "USF", "MUSL")):
            at = [(scenes.index(c) + 0.2 * (k - 1), max(v, 1e-17)) for c, s, t, b, v in
                  zip(data["scene"], data["scheme"], data["transfer"], data["basis"], data[key])
                  if s == scheme and (b != "linear" or t == "FLIP")]
            panel.plot(*zip(*at), "o", markersize=3, label=scheme)
        panel.axhline(gate, color="k", linewidth=0.8)
        panel.set_yscale("log")
        panel.set_xticks(range(len(scenes)), scenes, rotation=40, ha="right")
        panel.set_ylabel(label)
        panel.legend()
    return figure
