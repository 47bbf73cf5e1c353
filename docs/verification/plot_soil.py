"""Soils: collapse, limit loads, slopes, a cavity."""
from plot import axes, plot, read, ticks
from plot_cases import clouds, rows


@plot
def soil_column():
    figure, ax = axes(2)
    data = read("soil_column")
    for i, name in enumerate(dict.fromkeys(data["variant"])):
        at = rows(data, variant=name)
        ax[0].plot(at["t"], at["run_out"], f"C{i}-", label=name)
        ax[1].plot(at["t"], at["volume"], f"C{i}-")
    ax[0].axhspan(0.7 * 1.2, 1.3 * 1.2, color="k", alpha=0.08, linewidth=0)
    ax[0].axhline(1.2, color="k", linestyle="--", linewidth=0.8)
    ax[0].set_ylabel("run-out / L; experiments ± 30 % shaded")
    ax[1].set_ylabel("volume / first")
    for panel in ax:
        panel.set_xlabel(r"$t \sqrt{g / H}$")
    ax[0].legend(fontsize=6.5)
    return figure


@plot
def soil_column_film():
    figure = clouds("soil_column_film", "t", "plastic", "plastic shear strain", ("x", "y"), 2.5, width=2.9, height=1.7,
                    label=r"$t \sqrt{{g / H}}$ = {:g}")
    for panel in figure.axes[:-1]:
        panel.set_xlim(0, 2.9)
        panel.set_ylim(0, 1.05)
    return figure


@plot
def soil_footing():
    figure, ax = axes(3)
    data = read("soil_footing")
    variants = list(dict.fromkeys(data["variant"]))
    for panel, factor in zip(ax, "cq"):
        names = [n for n in variants if n.startswith(f"N_{factor}") and ("quadratic" in n or "20" in n) and "remedy" not in n]
        for i, name in enumerate(names):
            for cells, line in ((6, "-."), (8, "--"), (16, "-")):
                at = rows(data, variant=name, cells=float(cells))
                if at["load"]:
                    panel.plot([100 * s for s in at["settlement"]], at["load"], f"C{i}{line}",
                               label=f"{name[5:]}, B/{cells}".replace("phi", "φ"))
    names = [n for n in variants if n.startswith("N_q, phi = 30") and "quadratic" not in n and "steps" not in n]
    for name in names:
        at, i = rows(data, variant=name, cells=8.0), 2 * ("GIMP" in name) + ("drucker" in name)
        remedy = ", remedy" in name
        if at["load"]:
            ax[2].plot([100 * s for s in at["settlement"]], at["load"], f"C{i}{'-' if remedy else '--'}",
                       label=f"{name[5:]}, B/8".replace("phi", "φ"))
    for panel, factor in zip(ax, "cqq"):
        panel.axhline(1, color="k", linestyle=":", linewidth=0.8)
        panel.axvline(2, color="k", linestyle=":", linewidth=0.8)
        panel.set_xlim(0, 8)
        panel.set_ylim(0, 1.3)
        panel.set_xlabel("100 settlement / B")
        panel.set_ylabel(f"load / that of exact $N_{factor}$")
        panel.legend(fontsize=6)
    ax[2].set_ylim(0.8, 1.2)
    return figure


@plot
def soil_footing_cloud():
    return clouds("soil_footing_cloud", "variant", "plastic", "plastic strain / %", ("x", "y"), 2.5, width=4.6, height=2.2,
                  label="{}")


@plot
def soil_pressure():
    figure, ax = axes()
    data = read("soil_pressure")
    for i, (phi, K_a) in enumerate(((20.0, 0.490291), (30.0, 1 / 3))):
        for state, K in ((1.0, K_a), (2.0, 1 / K_a)):
            for law, form in (("mohr_coulomb", "-"), ("drucker_prager", "o")):
                at = rows(data, phi=phi, state=state, law=law)
                ax.plot(at["t"], at["ratio"], f"C{i}{form}", markersize=3,
                        label=f"φ = {phi:g}°, {law}" if state == 1 else None)
            ax.axhline(K, color="k", linestyle=":", linewidth=0.8)
    ax.set_xlabel("way of the wall / last")
    ax.set_ylabel("thrust / that of a fluid")
    ax.set_yscale("log", base=2)
    ax.legend(fontsize=7)
    return figure


@plot
def soil_slope():
    figure, ax = axes(2)
    data = read("soil_slope")
    for i, name in enumerate(dict.fromkeys(data["variant"])):
        at = rows(data, variant=name)
        slopes = sorted(set(at["slope"]))
        for slope, line in zip(slopes, ("--", "-")):
            part = rows(at, slope=slope)
            for panel, key in zip(ax, ("speed", "plastic")):
                panel.plot(part["t"], part[key], f"C{i}{line}", linewidth=1,
                           label=name.replace("phi", "φ").replace("psi", "ψ") if line == "-" else None)
    for panel, text in zip(ax, ("mean speed", "mean plastic strain")):
        panel.axvline(2, color="k", linestyle=":", linewidth=0.8)
        panel.set_xlabel("t")
        panel.set_ylabel(text)
    ax[0].legend(fontsize=6.5, title="1.02 of the limit (dashed: 0.98)", title_fontsize=7)
    return figure


@plot
def soil_cavity():
    figure, ax = axes(2)
    data, field = read("soil_cavity"), read("soil_cavity_field")
    for i, (h, text) in enumerate(((0.5, "h = 1/2"), (0.25, "h = 1/4"))):
        at = rows(data, h=h)
        # the coarse cells have two runs, of which the longer is drawn
        start = max(k for k, a in enumerate(at["a"]) if k == 0 or a < at["a"][k - 1])
        ax[0].plot(at["a"][start:], at["p"][start:], f"C{i}o-", markersize=2, label=text)
    longest = rows(data, h=0.5)
    order = sorted(range(len(longest["a"])), key=lambda k: longest["a"][k])
    ax[0].plot([longest["a"][k] for k in order], [longest["exact"][k] for k in order], "k-", linewidth=1, label="exact")
    ax[0].axhline(5.60517, color="k", linestyle="--", linewidth=0.8)
    ax[0].set_xlabel("radius / first")
    ax[0].set_ylabel(r"pressure / $c_u$; dashed: limit")
    ax[0].set_ylim(0, 6)
    ax[0].legend(fontsize=7)
    rings = {}
    for r, radial, exact in zip(field["r"], field["radial"], field["exact"]):
        rings.setdefault(int(r), []).append((r, radial, exact))
    means = [[sum(column) / len(ring) for column in zip(*ring)] for _, ring in sorted(rings.items())]
    r, radial, exact = zip(*means)
    ax[1].plot(r, radial, "C0o", markersize=3, label="mean of rings two cells wide, h = 1/2")
    ax[1].plot(r, exact, "k-", linewidth=1, label="exact")
    ax[1].set_xscale("log")
    ticks(ax[1], (3, 5, 10, 20, 30))
    ax[1].set_xlabel("r / first radius")
    ax[1].set_ylabel(r"radial pressure / $c_u$, a = 3")
    ax[1].legend(fontsize=7)
    return figure
