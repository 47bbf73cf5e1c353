"""Implicit steps: vibration, equilibrium, locking, limit loads, and explicit steps beside them."""
import math

from plot import axes, loglog, plot, read, slope, ticks
from plot_cases import clouds, rows

LINEAR, QUADRATIC, CUBIC, GIMP, CPGIMP = 1.0, 2.0, 3.0, 16.0, 18.0


@plot
def free_vibration_implicit():
    figure, ax = axes(2)
    data = read("free_vibration_implicit")
    for cfl, gamma, h, text in ((1, 0.5, 1, "CFL 1"), (10, 0.5, 1, "CFL 10"), (1, 0.5, 0.5, "CFL 1, h = 1/2"),
                                (10, 0.6, 1, r"CFL 10, $\gamma$ = 0.6")):
        at = rows(data, basis=LINEAR, cfl=float(cfl), gamma=gamma, h=float(h))
        ax[0].plot(at["t"], at["energy"], "-" if cfl == 1 else "o-", label=text)
    ax[0].set_xlabel("t c / 4 L")
    for cfl in (100, 1000):
        at = rows(data, cfl=float(cfl))
        ax[1].plot(range(1, len(at["t"]) + 1), at["energy"], label=f"CFL {cfl}")
    ax[1].set_xlabel("steps")
    for panel in ax:
        panel.axhline(1, color="k", linewidth=0.8)
        panel.set_ylabel("energy / energy at the start")
        panel.set_ylim(0, 1.05)
        panel.legend()
    return figure


@plot
def weight_column():
    figure, ax = axes(2)
    data, profile = read("weight_column"), read("weight_column_profile")
    for name in ("linear", "GIMP", "cpGIMP", "quadratic", "cubic"):
        ax[0].plot(data["cells"], data[name], "o-", label=name)
    slope(ax[0], (100, 800), 2e-4, -1)
    loglog(ax[0], "cells", "mean error of the stress / largest stress")
    ax[0].legend()
    for i, (basis, name) in enumerate(((LINEAR, "linear"), (CPGIMP, "cpGIMP"))):
        at = rows(profile, basis=basis)
        ax[1].plot([-s / 1000 for s in at["stress"]], at["Y"], f"C{2 * i}.", markersize=4, label=f"{name}, 64 cells")
    ax[1].plot([-s / 1000 for s in at["exact"]], at["Y"], "k-", linewidth=1, label="exact")
    ax[1].set_xlabel("pressure / kPa")
    ax[1].set_ylabel("Y / m")
    ax[1].legend()
    return figure


@plot
def thick_cylinder():
    figure, ax = axes(2)
    at = rows(read("thick_cylinder"), basis=QUADRATIC, cells=10.0)
    ax[0].plot(at["r"], [u * 1000 for u in at["u_exact"]], "k-", linewidth=1, label="exact")
    ax[0].plot(at["r"], [u * 1000 for u in at["u"]], "C0o", label="h = a/10")
    ax[0].set_ylabel("displacement E / (a p)")
    ax[0].legend()
    for i, key in enumerate(("radial", "hoop")):
        ax[1].plot(at["r"], at[key + "_exact"], "k-", linewidth=1)
        ax[1].plot(at["r"], at[key], f"C{i}o", label=f"{key} stress / p")
    ax[1].legend()
    for panel in ax:
        panel.set_xlabel("r / a")
    return figure


@plot
def surface_cylinder():
    figure, ax = axes(2)
    data = read("surface_cylinder")
    for panel, radius in zip(ax, (1, 2)):
        for i, name in enumerate(("linear 10 shifted", "quadratic 5 shifted", "quadratic 10 shifted")):
            at = rows(data, variant=name)
            points = sorted((a, u / e) for r, a, u, e in zip(at["r"], at["angle"], at["u"], at["u_exact"])
                            if abs(r - radius) < 0.1)[::3]
            panel.plot([a for a, _ in points], [u for _, u in points], f"C{i}-", label=name.replace(" shifted", " cells"))
        panel.axhline(1, color="k", linewidth=0.8)
        panel.set_ylim(0.97, 1.05)
        panel.set_xlabel(f"angle at r = {radius}")
        panel.set_ylabel("displacement over exact")
        panel.legend()
    return figure


@plot
def surface_held():
    figure, ax = axes(3)
    data = read("surface_held")
    for i, name in enumerate(("5 shifted", "20 shifted")):
        at = rows(data, variant=name)
        ax[0].plot(at["r"], [1e6 * u for u in at["u"]], f"C{i}.", markersize=3, label=f"h = a/{name.split()[0]}")
    exact = sorted(zip(at["r"], at["u_exact"]))
    ax[0].plot([r for r, _ in exact], [1e6 * u for _, u in exact], "k-", linewidth=0.8, label="exact")
    ax[0].set_xlabel("r / a")
    ax[0].set_ylabel("radial displacement / 1e-6 a")
    data = read("surface_held_slope")
    for i, name in enumerate(("explicit", "implicit")):
        at = rows(data, variant=f"{name}, place 1")
        ax[1].semilogy(at["t"], at["largest_off"], f"C{i}-", label=name)
    ax[1].axhline(1e-3, color="k", linewidth=0.8)
    ax[1].set_xlabel("t / s")
    ax[1].set_ylabel("distance from the line / h")
    data = read("surface_held_bar")
    for i, name in enumerate(("explicit", "implicit")):
        at = rows(data, variant=f"bar, {name}, h = L/20")
        ax[2].plot(at["t"], at["energy"], f"C{i}-", label=f"{name}, 20 cells")
    ax[2].set_xlabel("t / period")
    ax[2].set_ylabel("energy over the first")
    for panel in ax:
        panel.legend()
    return figure


@plot
def ring_cylinder():
    figure, ax = axes(2)
    data = read("ring_cylinder")
    at = rows(data, method="quadratic", cells=10.0, shift=0.37)
    for i, key in enumerate(("radial", "hoop")):
        ax[0].plot(at["r"], at[key + "_exact"], "k-", linewidth=1)
        ax[0].plot(at["r"], at[key], f"C{i}o", markersize=4, label=f"{key} stress / p, h = a/10, nodes off the faces")
    for i, (shift, name) in enumerate(((0.0, "on"), (0.37, "off"))):
        sizes, errors = [5.0, 10.0, 20.0, 40.0], []
        for n in sizes:
            at = rows(data, method="quadratic", cells=n, shift=shift)
            errors.append(math.sqrt(sum((s - e) ** 2 for s, e in zip(at["radial"], at["radial_exact"])) / len(at["r"])))
        ax[1].loglog([1 / n for n in sizes], errors, f"C{i}o-", label=f"radial stress, nodes {name} the faces")
    ax[0].set_xlabel("r / a")
    ax[1].set_xlabel("h / a")
    ax[1].set_ylabel("rms error / p")
    for panel in ax:
        panel.legend()
    return figure


@plot
def cook():
    figure, ax = axes()
    data = read("cook")
    for i, name in enumerate(dict.fromkeys(data["variant"])):
        at = rows(data, variant=name)
        ax.plot(at["h"], [u / f for u, f in zip(at["displacement"], at["fem"])], "os^v<>D*"[i] + "-", label=name)
    ax.axhspan(0.97, 1.03, color="k", alpha=0.08)
    ax.set_xscale("log", base=2)
    ax.set_xlabel("h")
    ax.set_ylabel("displacement over FEM")
    ax.legend(fontsize=7)
    return figure


@plot
def cook_cloud():
    figure, ax = axes(2, 3.4, 3.2)
    data = read("cook_cloud")
    for panel, remedy, title in zip(ax, (0.0, 1.0), ("plain", "remedy")):
        at = rows(data, remedy=remedy)
        drawn = panel.scatter(at["x"], at["y"], c=at["pressure"], s=3, vmin=-0.4, vmax=0.4, cmap="coolwarm",
                              linewidths=0, antialiased=False, rasterized=True)
        panel.set_aspect("equal")
        panel.set_title(title, fontsize=9)
    figure.colorbar(drawn, ax=ax, label="pressure", shrink=0.8)
    return figure


@plot
def beam():
    figure, ax = axes()
    data = read("beam")
    for i, (basis, per_cell, name) in enumerate(((QUADRATIC, 3.0, "quadratic, 3 x 3"), (QUADRATIC, 6.0, "quadratic, 6 x 6"),
                                                 (GIMP, 4.0, "GIMP, 4 x 4"))):
        at = rows(data, basis=basis, per_cell=per_cell, quasi_static=1.0)
        for key in ("x", "y"):
            ax.plot(at["share"], [-u for u in at[key]], f"C{i}" + "-:"[key == "y"], label=f"{name}: -u_{key}")
    ax.plot([1, 1], [5.519, 8.244], "k+", markersize=9, label="FEM")
    ax.set_xlabel("load / 100 kN/m")
    ax.set_ylabel("displacement of the tip / m")
    ax.legend(fontsize=7)
    return figure


BEAMS = (("thick", (-0.21083, -0.87838)), ("slender", (-0.29426, -0.94597)))
UGIMP = 17.0


@plot
def own_weight():
    """Load against deflection, of all bases by all numbers of steps."""
    figure, ax = axes(2)
    data = read("own_weight")
    kinds = ((QUADRATIC, 4, 3, 0, "quadratic"), (CUBIC, 4, 3, 0, "cubic"), (GIMP, 4, 3, 0, "GIMP"), (UGIMP, 4, 3, 0, "uGIMP"),
             (LINEAR, 8, 4, 0, "linear, cells of half the size"), (LINEAR, 4, 2, 1, "linear, total Lagrangian"))
    for panel, (beam, tip) in zip(ax, BEAMS):
        for i, (basis, cells, per_cell, lagrangian, name) in enumerate(kinds):
            for steps, mark in ((10, "o"), (20, "s"), (40, "^"), (80, "-")):
                at = rows(data, beam=beam, basis=basis, cells=cells, per_cell=per_cell, lagrangian=lagrangian, remedy=0,
                          steps=steps, density=0)
                panel.plot([0.12 * i + t for t in (0, *at["t"])], [0] + [-y for y in at["y"]], f"C{i}{mark}", fillstyle="none",
                           markersize=3, linewidth=1, label=name if mark == "-" else None)
            panel.plot([0.12 * i + 1], [-tip[1]], "k+", markersize=9, label=None if i else "FEM")
        for steps, mark in ((10, "o"), (20, "s"), (40, "^"), (80, "-")):
            panel.plot([], [], f"k{mark}", fillstyle="none", markersize=3, linewidth=1, label=f"{steps} steps")
        panel.set_title(beam, fontsize=9)
        panel.set_xlabel("share of the weight; each basis 0.12 further to the right")
        panel.set_ylabel("way of the tip down")
        panel.legend(fontsize=6)
    return figure


@plot
def own_weight_drift():
    """Error at the end against the number of steps: smooth bases, the linear one, and slow motion."""
    figure, ax = axes(3)
    data = read("own_weight")

    def draw(panel, steps, basis, cells, per_cell, lagrangian, density, line, name):
        for (beam, tip), mark in zip(BEAMS, "os"):
            error = []
            for n in steps:
                at = rows(data, beam=beam, basis=basis, cells=cells, per_cell=per_cell, lagrangian=lagrangian, remedy=0, steps=n,
                          density=density)
                error.append(100 * math.hypot(at["x"][-1] - tip[0], at["y"][-1] - tip[1]) / math.hypot(*tip))
            panel.plot(steps, error, line + mark, fillstyle="none", linewidth=1, label=name if mark == "o" else None)

    still, short, moving = (10, 20, 40, 80), (10, 20, 40, 80, 320), (10, 40, 160)
    for i, (basis, name) in enumerate(((QUADRATIC, "quadratic"), (CUBIC, "cubic"), (GIMP, "GIMP"), (UGIMP, "uGIMP"))):
        for per_cell, style in ((2, ":"), (3, "--"), (4, "-")):
            draw(ax[0], still, basis, 4, per_cell, 0, 0, f"C{i}{style}", f"{name}, {per_cell} x {per_cell}")
    for i, (per_cell, lagrangian) in enumerate(((2, 0), (3, 0), (4, 0), (2, 1), (3, 1))):
        draw(ax[1], still if lagrangian else short, LINEAR, 8, per_cell, lagrangian, 0, f"C{i}" + "-:"[lagrangian],
             f"{'total Lagrangian' if lagrangian else 'updated'}, {per_cell} x {per_cell}")
    for i, (basis, name) in enumerate(((QUADRATIC, "quadratic"), (CUBIC, "cubic"), (GIMP, "GIMP"))):
        for per_cell, style in ((2, ":"), (3, "--")):
            draw(ax[2], moving, basis, 4, per_cell, 0, 1, f"C{i}{style}", f"{name}, {per_cell} x {per_cell}")
    for panel, steps, title in zip(ax, (still, short, moving), ("quasi-static, smooth bases", "quasi-static, linear, 8 cells deep",
                                                               "in slow motion")):
        panel.set_xscale("log")
        ticks(panel, steps)
        panel.axhspan(0, 3, color="k", alpha=0.08)
        panel.set_title(title + " (thick: o, slender: s)", fontsize=9)
        panel.set_xlabel("steps")
        panel.set_ylabel("error of the tip / its way, %")
        panel.set_ylim(bottom=0)
        panel.legend(fontsize=6)
    return figure


@plot
def plastic_cylinder():
    figure, ax = axes()
    data = read("plastic_cylinder")
    for i, (basis, remedy, n, name) in enumerate(((LINEAR, 0.0, 4.0, "linear, plain, a/4"),
                                                  (LINEAR, 1.0, 4.0, "linear, remedy, a/4"),
                                                  (LINEAR, 1.0, 16.0, "linear, remedy, a/16"),
                                                  (QUADRATIC, 0.0, 16.0, "quadratic, plain, a/16"))):
        at = rows(data, basis=basis, remedy=remedy, cells=n)
        ax.plot(at["u"], at["p"], f"C{i}-", label=name)
    ax.plot([0.0865, 0.1177, 0.1537, 0.1945], [139.21, 163.91, 180.13, 189.22], "k+", label="closed form")
    ax.axhline(192.09, color="k", linestyle="--", linewidth=0.8)
    ax.set_xlim(0, 0.4)
    ax.set_xlabel("displacement of the outer face / mm")
    ax.set_ylabel("pressure / MPa")
    ax.legend(fontsize=7)
    return figure


@plot
def footing():
    figure, ax = axes()
    data = read("footing")
    for i, (name, n) in enumerate((("linear, plain, smooth", 16), ("quadratic, remedy, rough", 16),
                                   ("linear, remedy, rough", 16), ("linear, remedy, smooth", 8),
                                   ("linear, remedy, smooth", 16), ("linear, remedy, smooth", 32))):
        at = rows(data, variant=name, cells=float(n))
        ax.plot([1000 * s for s in at["settlement"]], at["load"], f"C{i}-", label=f"{name}, B/{n}")
    ax.axhline(1, color="k", linestyle="--", linewidth=0.8)
    ax.set_xlabel("1000 settlement / B")
    ax.set_ylabel(r"load / $(2 + \pi) c$")
    ax.legend(fontsize=7)
    return figure


@plot
def clay():
    figure, ax = axes(2)
    data = read("clay")
    for panel, site, most in zip(ax, ("footing", "embankment"), (0.06, 0.015)):
        for i, name in enumerate(("linear, remedy", "quadratic", "cubic", "GIMP, remedy")):
            at = rows(data, site=site, setting=name)
            panel.plot([0] + [100 * s for s in at["settlement"]], [0] + at["load"], f"C{i}o-", markersize=2, label=name)
        panel.axhline(1, color="k", linestyle="--", linewidth=0.8)
        panel.set_xlim(0, 100 * most)
        panel.set_ylim(0, 1.2)
        panel.legend(fontsize=7)
    ax[0].set_xlabel("100 settlement / B")
    ax[0].set_ylabel(r"load / $(2 + \pi) c$")
    ax[1].set_xlabel("100 settlement of the crest / height")
    ax[1].set_ylabel("weight / that of slip circles")
    return figure


@plot
def clay_cloud():
    return clouds("clay_cloud", "setting", "plastic", "plastic strain / %", ("x", "y"), 5, width=3.4, height=2.2,
                  label="{}")


@plot
def resting_disc():
    figure, ax = axes(2)
    data = read("resting_disc")
    for i, name in enumerate(("quadratic", "linear, remedy", "cubic", "GIMP")):
        at = rows(data, floor=1.0, setting=name, per_cell=3.0, steps=40.0)
        ax[0].plot(at["share"], at["fall"], f"C{i}-", label=name)
        for steps, form in ((10.0, "s"), (40.0, "-")):
            at = rows(data, floor=1.0, setting=name, per_cell=3.0, steps=steps)
            ax[1].plot(at["share"], [f / t for f, t in zip(at["fall"], at["theory"])], f"C{i}{form}", markersize=3,
                       label=f"{name}, {steps:g} steps")
    ax[0].plot(at["share"], at["theory"], "k--", linewidth=0.8, label="linear elasticity")
    ax[0].set_ylabel("way of the top / R")
    ax[1].axhline(1, color="k", linestyle="--", linewidth=0.8)
    ax[1].set_ylim(0.8, 1.1)
    ax[1].set_ylabel("the same over linear elasticity")
    for panel in ax:
        panel.set_xlabel("share of the weight")
        panel.legend(fontsize=7)
    return figure


@plot
def resting_disc_cloud():
    figure = clouds("resting_disc_cloud", "floor", "pressure", "vertical pressure / E", ("x", "y"), 6, width=3.0, height=3.6)
    for panel, title in zip(figure.axes, ("on a body", "on a plane", "on a friction wall")):
        panel.set_title(title, fontsize=9)
        panel.axhline(0, color="k", linewidth=0.8)
    return figure


@plot
def explicit_against_implicit():
    figure, ax = axes(2)
    data = rows(read("explicit_against_implicit"), basis=CPGIMP)
    for i, scheme in enumerate(("MUSL", "Newmark")):
        at = rows(data, scheme=scheme)
        for panel, key in zip(ax, ("seconds", "displacement")):
            panel.plot(at["speed"], at[key], "os"[i] + "-", label=scheme)
    ax[0].set_yscale("log")
    ax[0].set_ylabel("seconds")
    ax[1].set_ylim(7, 8)
    ax[1].set_ylabel("displacement / cm")
    for panel in ax:
        panel.set_xlabel("speed of the platen / (cm/s)")
        panel.legend()
    return figure


# Finite elements, 40 x 40 biquadratic: compression, displacement in cm, force in dyn/cm.
BILLET = ((0.1, 1.0550, 3.028e7), (0.2, 2.2957, 6.978e7), (0.3, 3.7607, 1.2352e8), (0.4, 5.4453, 2.0722e8),
          (0.5, 7.292, 3.613e8))


@plot
def billet():
    figure, ax = axes(2)
    data = read("billet")
    for name in ("linear 4x4", "linear 2x2", "cpGIMP 2x2", "quadratic 4x4"):
        at = rows(data, variant=name)
        for panel, key in zip(ax, ("displacement", "force")):
            panel.plot([100 * c for c in at["compression"]], at[key], label=name)
    for k in (1, 2):
        ax[k - 1].plot([100 * row[0] for row in BILLET], [row[k] for row in BILLET], "ko", label="finite elements")
        ax[k - 1].set_xlabel("compression / %")
        ax[k - 1].legend()
    ax[0].set_ylabel("displacement of the corner / cm")
    ax[1].set_ylabel("force on half a platen / (dyn/cm)")
    return figure


@plot
def billet_particles():
    return clouds("billet_particles", "compression", "mises", "von Mises stress / (dyn/cm$^2$)", ("x", "y"), 8, width=3.6,
                  height=2.4, label="compression {:g}")
