"""Waves, collisions, solids, fluids, and the transfers compared."""
import math

import matplotlib.pyplot as plt

from plot import axes, loglog, plot, read, slope


def rows(data, **wanted):
    """The rows of a table of columns where each named column has the value wanted."""
    keep = [all(data[k][i] == v for k, v in wanted.items()) for i in range(len(next(iter(data.values()))))]
    return {k: [v for v, kept in zip(values, keep) if kept] for k, values in data.items()}


def clouds(name, key, colour, text, form, size, width=3.2, height=3.2, label="{:g}"):
    """Particles at each value of `key`, coloured by `colour`; all panels have the same axes."""
    data = read(name)
    times = sorted(set(data[key]))
    x, y = form
    figure, ax = axes(len(times), width, height)
    ax = [ax] if len(times) == 1 else list(ax)
    bounds = [(min(data[axis]), max(data[axis])) for axis in form]
    room = 0.04 * max(high - low for low, high in bounds)
    top = sorted(data[colour])[int(0.99 * len(data[colour]))]
    for panel, t in zip(ax, times):
        at = rows(data, **{key: t})
        drawn = panel.scatter(at[x], at[y], c=at[colour], s=size, vmin=0, vmax=top, cmap="viridis", linewidths=0,
                              antialiased=False, rasterized=True)
        panel.set(aspect="equal", xlim=(bounds[0][0] - room, bounds[0][1] + room), ylim=(bounds[1][0] - room, bounds[1][1] + room))
        panel.set_title(label.format(t), fontsize=9)
    for panel in ax[1:]:
        panel.tick_params(labelleft=False)
    bar = figure.colorbar(drawn, ax=ax, label=text, shrink=0.8)
    bar.formatter.set_useMathText(True)
    return figure


@plot
def axial_vibration():
    figure, ax = axes(2)
    data, fine = read("axial_vibration"), read("axial_vibration_refinement")
    ax[0].plot(data["t"], data["v_exact"], "k-", linewidth=1, label="exact")
    ax[0].plot(data["t"], data["v_mean"], "C1.", markersize=2, label="13 cells")
    ax[0].set_xlabel("t")
    ax[0].set_ylabel("mean velocity")
    ax[0].legend()
    kh = [19 * math.pi / 2 / n for n in fine["cells"]]
    ax[1].plot(fine["cells"], fine["period_error"], "o-", label="mode 10")
    ax[1].plot(fine["cells"], [0.25 * v * v for v in kh], "k:", label=r"$(\beta h)^2 / 4$")
    loglog(ax[1], "cells", "relative error of the period")
    ax[1].legend()
    return figure


@plot
def pulse():
    figure, ax = axes(2)
    data, fine = read("pulse"), read("pulse_refinement")
    for i, t in enumerate((0.4, 1.2)):
        at = rows(data, t=t)
        ax[0].plot(at["x"], at["v_exact"], "k-", linewidth=1, label="exact" if i == 0 else None)
        ax[0].plot(at["x"], at["v"], f"C{i}.", markersize=2, label=f"t = {t:g}, h = 1/200")
    ax[0].set_xlabel("x")
    ax[0].set_ylabel("velocity")
    ax[0].legend()
    for key, text in (("v_0.4", "velocity, t = 0.4"), ("v_1.2", "velocity, t = 1.2"), ("stress_0.4", "stress, t = 0.4")):
        ax[1].plot(fine["cells"], fine[key], "o-", label=text)
    ax[1].axhline(0.05, color="k", linestyle="--", linewidth=0.8)
    slope(ax[1], (300, 800), 0.05, -2)
    loglog(ax[1], "cells", "relative L2 error")
    ax[1].legend()
    return figure


@plot
def wall_impact():
    figure, ax = axes(2)
    data, fine = read("wall_impact"), read("wall_impact_refinement")
    ax[0].plot([0, 0, 2, 2, 3], [0, 0.01, 0.01, 0, 0], "k-", linewidth=1, label="exact")
    ax[0].plot(data["t"], data["force"], "C1-", linewidth=0.8, label="200 cells")
    ax[0].set_xlabel("t")
    ax[0].set_ylabel("force of the wall")
    ax[0].legend()
    for key in ("stress", "duration", "rebound"):
        ax[1].plot(fine["cells"], [abs(v - 1) for v in fine[key]], "o-", label=key)
    ax[1].axhline(0.02, color="k", linestyle="--", linewidth=0.8)
    loglog(ax[1], "cells", "relative error")
    ax[1].legend()
    return figure


@plot
def contact_bars():
    figure, ax = axes()
    data = read("contact_bars")
    ax.plot([0, 0, 1.2, 1.2, 3], [0, 1, 1, 0, 0], "k-", linewidth=1, label="exact")
    ax.plot(data["t"], data["stress"], "C1-", linewidth=0.8, label="100 cells")
    ax.set_xlabel("t")
    ax.set_ylabel("stress between the bars / (density c v / 2)")
    ax.legend()
    return figure


@plot
def contact_implicit():
    figure, ax = axes(2)
    data, bars = read("contact_implicit"), read("contact_bars_table")
    for case, end, steps in (("cylinder", "-", ""), ("cylinder explicit", "", ", explicit")):
        at = rows(data, case=case)
        ax[0].plot(at["half_width"], at["width"], "C0o" + end, fillstyle="none" if steps else "full", label="width of contact" + steps)
        ax[0].plot(at["half_width"], at["traction"], "C1s" + end, fillstyle="none" if steps else "full", label="pressure in the middle" + steps)
        ax[0].plot(at["half_width"], at["stress"], "C2^" + end, fillstyle="none" if steps else "full", label="stress in the second cell" + steps)
    ax[0].axhline(1, color="k", linewidth=0.8)
    ax[0].set_xlabel("half the width by Hertz, cells")
    ax[0].set_ylabel("measured / Hertz")
    ax[0].legend()
    names = [n for n in bars["case"] if n.startswith(("unequal", "implicit"))]
    for i, key in enumerate(("stress", "energy")):
        values = [v for n, v in zip(bars["case"], bars[key]) if n in names]
        ax[1].plot(values, range(len(names)), "os"[i], label=("mean stress / exact", "largest energy / first")[i])
    ax[1].set_yticks(range(len(names)), names)
    ax[1].axvline(1, color="k", linewidth=0.8)
    ax[1].legend(loc="lower left")
    return figure


@plot
def contact_discs():
    figure, ax = axes(4, width=4.0)
    data, table = read("contact_discs"), read("contact_discs_table")
    fine = [(1 / n, 0.909 - r) for case, n, r in zip(table["case"], table["cells"], table["rebound"]) if case == "refinement"]
    ax[0].plot(*zip(*fine), "o-", label="0.909 - rebound")
    slope(ax[0], [fine[0][0], fine[-1][0]], fine[0][1], 1)
    loglog(ax[0], "h", "error of the rebound")
    ax[0].legend()
    for key in ("total", "kinetic", "strain"):
        scale = data["kinetic"][0] if key != "total" else 1
        ax[1].plot(data["t"], [v / scale for v in data[key]], label=key)
    ax[1].plot([2.104], [0.136 / 2.513274], "k+", markersize=9, label="least kinetic energy, FEM")
    ax[1].set_xlabel("t")
    ax[1].set_ylabel("energy / first")
    ax[1].legend()
    shifts = ("0.1, 0.3", "0.25, 0.25", "0.37, 0.11", "0.5, 0.5", "0.8, 0.6")
    for case, names in (("shifted", shifts), ("turned", ("0°", "20°", "33°", "45°"))):
        found = [r for c, r in zip(table["case"], table["rebound"]) if c == case]
        ax[2].plot([f"{n} h" if case == "shifted" else n for n in names], found, "o", label=case)
    ax[2].set_ylim(0.8, 0.92)
    ax[2].tick_params(axis="x", rotation=60)
    ax[2].set_ylabel("rebound / speed, h = 1/40")
    ax[2].legend()
    rigid = 0.1 * math.sqrt(2) / (3 * 0.2)
    for basis in ("quadratic", "cubic"):
        spins = {c: -s / rigid for c, n, s in zip(table["case"], table["cells"], table["spin"]) if n == 40}
        ax[3].plot(["0", "0.3", "10"], [spins[f"oblique with friction {f} ({basis})"] for f in ("0", "0.3", "10")], "o", label=basis)
    ax[3].plot(["0.3", "10"], [0.4475 / rigid, 0.3783 / rigid], "k+", markersize=9, label="FEM")
    ax[3].set_xlabel("friction")
    ax[3].set_ylabel("spin / that of rigid discs that stick")
    ax[3].legend()
    return figure


@plot
def contact_block():
    figure, ax = axes(2)
    data = read("contact_block")
    rows = list(zip(data["case"], data["name"], data["shift"], data["way"], data["exact"]))
    for basis in ("linear", "GIMP", "quadratic", "cubic"):
        slides = [(s, w / e) for case, b, s, w, e in rows if case == "slides" and b == basis]
        rests = [(s, 1000 * w) for case, b, s, w, e in rows if case == "rests" and b == basis]
        ax[0].plot(*zip(*slides), "o-", label=basis)
        ax[1].plot(*zip(*rests), "o-", label=basis)
    ax[0].axhline(1, color="k", linewidth=0.8)
    ax[0].set_ylabel("way / exact, friction 0.3")
    ax[1].set_ylabel("creep in 0.5 s / mm, friction 0.7")
    ax[1].set_yscale("log")
    for a in ax:
        a.set_xlabel("place of the floor in its cell / h")
        a.legend()
    return figure


@plot
def two_disks():
    figure, ax = axes()
    data = read("two_disks")
    for key in ("total", "kinetic", "strain"):
        ax.plot(data["t"], data[key], label=key)
    ax.plot([2.104], [0.136], "k+", markersize=9, label="least kinetic energy, FEM")
    ax.set_xlabel("t")
    ax.set_ylabel("energy")
    ax.legend()
    return figure


@plot
def two_disks_cloud():
    return clouds("two_disks_cloud", "t", "mises", "von Mises stress", ("x", "y"), 2, label="t = {:g}")


@plot
def cantilever():
    figure, ax = axes()
    data = read("cantilever")
    reference = rows(data, cells_per_metre=4.0)
    ax.plot(reference["t"], reference["fem"], "k-", linewidth=1, label="FEM")
    for i, (n, per_cell) in enumerate(((4.0, 2.0), (8.0, 2.0), (16.0, 4.0))):
        at = rows(data, cells_per_metre=n, per_cell=per_cell)
        ax.plot(at["t"], at["displacement"], "o^s"[i], label=f"h = 1/{n:g}, {per_cell:g} x {per_cell:g} per cell")
    ax.set_xlabel("t / s")
    ax.set_ylabel("displacement of the lower corner / m")
    ax.legend()
    return figure


@plot
def cantilever_cloud():
    return clouds("cantilever_cloud", "t", "speed", "speed / (m/s)", ("x", "y"), 4, 2.9, 3.2, "t = {:g} s")


@plot
def vortex():
    figure, ax = axes()
    data = rows(read("vortex"), transfer="FLIP")
    ax.plot(data["h"], data["error_0.5"], "o-", label="A = 0.1, t = 0.5")
    ax.plot(data["h"], data["error_1"], "s-", label="A = 0.1, t = 1")
    for name, marker in (("FLIP", "^-"), ("APIC", "v-")):
        strong = rows(read("vortex"), transfer=f"A = 1, {name}")
        ax.plot(strong["h"], strong["error_1"], marker, label=f"A = 1, t = 1, total Lagrangian, {name}")
    slope(ax, (0.1, 0.025), 7e-3, 2)
    loglog(ax, "h", "error of displacement, L2", 10)
    ax.legend()
    return figure


@plot
def vortex_cloud():
    return clouds("vortex_cloud", "t", "error", "error of displacement", ("x", "y"), 2, label="t = {:g}, h = 0.1")


def drawn(table, names, height, size):
    """Clouds of a bar that was drawn out, one below the other, coloured by the stretch."""
    figure, ax = plt.subplots(len(names), 1, figsize=(7.2, height), layout="constrained", sharex=True, sharey=True)
    data = read(table)
    for panel, name in zip(ax, names):
        at = rows(data, method=name)
        cloud = panel.scatter(at["x"], at["y"], c=at["F11"], s=size, cmap="viridis", vmin=1, vmax=4, linewidths=0,
                              antialiased=False, rasterized=True)
        panel.set_title(name.replace("; ", ", "), fontsize=8, loc="left")
        panel.set_aspect("equal")
        panel.set_ylim(0, 0.7)
    figure.colorbar(cloud, ax=ax, label="$F_{11}$")
    return figure


@plot
def drawn_bar():
    return drawn("drawn_bar_particles", ("total; quadratic; quasi-static", "updated; quadratic; quasi-static",
                                         "updated; quadratic; USL FLIP"), 3.4, 4)


@plot
def adaption():
    return drawn("adaption_bar", ("APIC_MLS; not split", "APIC_MLS; h = 1/8", "APIC_MLS; h = 1/16", "FLIP; h = 1/8"), 4.2, 3)


@plot
def heat():
    figure, ax = axes(3)
    data, fine, strip = read("heat_bar"), read("heat_refinement"), read("heat_strip")
    for sudden, name in ((0, "sine"), (1, "sudden ends")):
        at = rows(data, sudden=sudden)
        ax[0].plot(at["x"], at["exact"], "k-", linewidth=1)
        ax[0].plot(at["x"], at["T"], f"C{sudden}.", markersize=4, label=name)
    ax[0].set_xlabel("x")
    ax[0].set_ylabel("temperature")
    ax[0].legend()
    for way, name in enumerate(("linear", "quadratic", "cubic", "quadratic, implicit")):
        at = rows(fine, way=way)
        ax[1].plot(at["cells"], at["sine"], f"C{way}o-", markersize=3, label=name)
        ax[1].plot([1.25 * n for n in at["cells"]], at["sudden"], f"C{way}s:", markersize=3)
    loglog(ax[1], "cells", "error: sine (solid), sudden ends (dotted)")
    ax[1].legend()
    cloud = ax[2].scatter(strip["x"], strip["y"], c=strip["stress"], s=2, cmap="coolwarm", linewidths=0, rasterized=True)
    ax[2].set_xlabel("x")
    ax[2].set_ylabel("y")
    figure.colorbar(cloud, ax=ax[2], label="stress along x")
    return figure


@plot
def adaption_front():
    figure = plt.figure(figsize=(9.6, 3.4), layout="constrained")
    ax = figure.subplot_mosaic([["not split", "front"], ["split and merged", "front"]], width_ratios=(1.5, 1))
    name, methods = "Martin and Moyce; 2 a / 20", ("not split", "split and merged")
    cloud, front = read("adaption_front_cloud"), read("adaption_front")
    for method in methods:
        at, panel = rows(cloud, case=name, method=method), ax[method]
        drawn_there = panel.scatter([2 * x for x in at["x"]], [2 * y for y in at["y"]], c=at["mass"], s=4, cmap="viridis",
                                    vmin=0, vmax=1, linewidths=0, antialiased=False, rasterized=True)
        panel.set(aspect="equal", xlim=(0, 4.8), ylim=(0, 1.3), ylabel="y / a")
        panel.set_title(method, fontsize=8, loc="left")
        line = rows(front, case=name, method=method)
        ax["front"].plot(line["T"], [x / 0.05715 for x in line["front"]], label=method)
    ax[methods[0]].tick_params(labelbottom=False)
    ax[methods[1]].set_xlabel("x / a")
    figure.colorbar(drawn_there, ax=[ax[method] for method in methods], label="mass of a particle / first", location="left")
    ax["front"].plot(line["T"], [x / 0.05715 for x in line["due"]], "ko", label="Martin and Moyce")
    ax["front"].set(xlabel=r"$t \sqrt{2 g / a}$", ylabel="front / a")
    ax["front"].legend()
    return figure


@plot
def taylor_bar():
    figure, ax = axes(1, 4.0, 5.6)
    data = read("taylor_bar_cloud")
    drawn = ax.scatter(data["r"], data["z"], c=data["plastic_strain"], s=5, cmap="viridis", linewidths=0,
                       antialiased=False, rasterized=True)
    ax.plot([7.206], [0], "k<", label="radius, FEM")
    ax.plot([0], [21.58], "kv", label="length, FEM")
    ax.set_aspect("equal")
    ax.set_xlabel("r / mm")
    ax.set_ylabel("z / mm")
    ax.legend()
    figure.colorbar(drawn, label="plastic strain")
    return figure


@plot
def hydrostatic():
    figure, ax = axes()
    data = read("hydrostatic")
    ax.plot(data["p_exact"], data["y"], "k-", linewidth=1, label="exact")
    ax.plot(data["p"], data["y"], "C1.", label="20 cells")
    ax.set_xlabel("pressure")
    ax.set_ylabel("y")
    ax.legend()
    return figure


@plot
def couette():
    figure, ax = axes()
    data = read("couette")
    for i, t in enumerate(sorted(set(data["t"]))):
        at = rows(data, t=t)
        order = sorted({y: k for k, y in enumerate(at["y"])}.values(), key=lambda k: at["y"][k]) # one of each row
        ax.plot([at["u_exact"][k] for k in order], [at["y"][k] for k in order], "k-", linewidth=1)
        ax.plot([at["u"][k] for k in order], [at["y"][k] for k in order], f"C{i}.", markersize=3,
                label=rf"$\nu t / H^2$ = {t:g}")
    ax.set_xlabel("u / U")
    ax.set_ylabel("y / H")
    ax.legend()
    return figure


@plot
def water_column():
    figure, ax = axes(2)
    front, depth = read("water_column_front"), read("water_column_ritter")
    for i, n in enumerate(sorted(set(front["cells"]))):
        at = rows(front, cells=n)
        ax[0].plot(at["T"], at["front"], f"C{i}-", label=f"2 a / {n:g}")
    ax[0].plot(at["T"], at["measured"], "ko", label="Martin and Moyce")
    ax[0].set_xlabel(r"$t \sqrt{2 g / a}$")
    ax[0].set_ylabel("front / a")
    ax[0].legend()
    finest = max(depth["cells"])
    for i, T in enumerate(sorted(set(depth["T"]))):
        at = rows(depth, cells=finest, T=T)
        ax[1].plot(at["x"], at["depth_exact"], "k-", linewidth=1)
        ax[1].plot(at["x"], at["depth"], f"C{i}.", markersize=4, label=rf"$t \sqrt{{g / h_0}}$ = {T:g}")
    ax[1].set_xlabel("x / h0")
    ax[1].set_ylabel("depth / h0")
    ax[1].legend()
    return figure


@plot
def water_column_cloud():
    return clouds("water_column_cloud", "T", "speed", "speed / (m/s)", ("x", "y"), 5, 3.8, 1.7, "T = {:g}")


@plot
def transfers():
    figure, ax = axes(3, 4.0, 3.8)
    data = read("transfers")
    names = list(dict.fromkeys(data["transfer"]))
    panels = (("disks", "energy_end", "disks: energy left"), ("square", "angular_end", "square: angular momentum left"),
              ("bar", "energy_end", "bar: energy left"))
    for panel, (case, key, title) in zip(ax, panels):
        for i, scheme in enumerate(("USL", "USF", "MUSL")):
            at = rows(data, case=case, scheme=scheme)
            panel.plot(at[key], range(len(names)), "o^s"[i], color=f"C{i}", label=scheme, markersize=5)
        panel.axvline(1, color="k", linewidth=0.8)
        panel.set_yticks(range(len(names)), names if panel is ax[0] else [""] * len(names))
        panel.invert_yaxis()
        panel.set_title(title, fontsize=9)
    ax[0].legend()
    return figure


@plot
def transfers_square():
    figure, ax = axes()
    data = read("transfers_square")
    for name in ("FLIP", "TPIC"):
        at = rows(data, transfer=name)
        ax.plot(at["h"], at["loss"], "o-", label=name)
    slope(ax, (0.05, 0.00625), 5e-2, 2)
    loglog(ax, "h", "loss of angular momentum in one turn", 10)
    ax.legend()
    return figure


@plot
def tension():
    figure, ax = axes(3, width=3.2, height=3.6)
    data = read("tension")
    names = list(dict.fromkeys(data["transfer"]))
    for panel, stretch in zip(ax, (0.8, 1.05, 1.5)):
        for k, scheme in enumerate(("USL", "USF", "MUSL", "MUSL projected")):
            at = rows(data, stretch=stretch, scheme=scheme)
            panel.plot([b / a for a, b in zip(at["first"], at["last"])], range(len(names)), "osDx"[k], fillstyle="none", label=scheme)
        panel.axvline(1, color="k", linewidth=0.8)
        panel.set_xscale("log")
        panel.set_yticks(range(len(names)), names if panel is ax[0] else [])
        panel.set_xlabel(f"last / first, stretch {stretch:g}")
    ax[0].legend()
    return figure


@plot
def tension_growth():
    figure, ax = axes()
    data = read("tension_growth")
    for k, (key, text) in enumerate((("estimate", "formula"), ("library", "library"))):
        grow = [(x, y) for x, y in zip(data["linear"], data[key]) if x > 1e-3]
        ax.plot([x for x, _ in grow], [y for _, y in grow], "xo"[k], fillstyle="none", label=text)
    ends = [min(x for x in data["linear"] if x > 1e-3), max(data["linear"])]
    ax.plot(ends, ends, "k-", linewidth=0.8)
    loglog(ax, "growth per step, linear equations", "growth per step", 10)
    ax.legend()
    return figure


@plot
def linear_square():
    figure, ax = axes(4, width=2.6, height=3.6)
    data = read("linear_square")
    series = list(dict.fromkeys((s, t) for s, t in zip(data["series"], data["transfer"])))
    for panel, scheme in zip(ax, ("USL", "USF", "MUSL", "MUSL projected")):
        for k, share in enumerate((0.5, 0.3, 0.1, 0.02)):
            at = rows(data, scheme=scheme, share=share)
            whole = [(e, series.index((s, m)) + 0.14 * (k - 1.5)) for s, m, end, e in
                     zip(at["series"], at["transfer"], at["status"], at["end"]) if end == "MPM_OK"]
            panel.plot([e for e, _ in whole], [n for _, n in whole], "osDx"[k], fillstyle="none", label=f"share {share:g}")
        panel.axvline(1, color="k", linewidth=0.8)
        panel.set_yticks(range(len(series)), [f"{s}, {t}" for s, t in series] if panel is ax[0] else [])
        panel.set_ylim(len(series) - 0.5, -0.5)
        panel.set_xlim(0.65, 2.7)
        panel.set_title(scheme, fontsize=9)
        panel.set_xlabel("energy, last / first")
    ax[0].legend(fontsize=7)
    return figure


@plot
def stable_share():
    figure, ax = axes(4, width=2.6, height=3.6)
    data = read("stable_share")
    names = list(dict.fromkeys(data["basis"]))
    bodies = list(dict.fromkeys(data["body"]))
    for panel, scheme in zip(ax, ("USL", "USF", "MUSL", "MUSL projected")):
        for k, body in enumerate(bodies):
            least = [min(rows(data, basis=name, scheme=scheme, body=body)["share"]) for name in names]
            panel.plot(least, [n + 0.14 * (k - 2) for n in range(len(names))], "osD^x"[k], fillstyle="none", markersize=4, label=body)
        panel.set_xlim(0, 1.05)
        panel.set_yticks(range(len(names)), names if panel is ax[0] else [])
        panel.set_title(scheme, fontsize=9)
        panel.set_xlabel("share")
    ax[0].legend(fontsize=7)
    return figure
