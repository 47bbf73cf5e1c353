"""The manufactured bar and cube of Steffen et al. 2008, and the figures of their section 4."""
import math

from plot import axes, ticks, loglog, plot, read, slope

MARKERS = "osD^v<>ph*"


def series(ax, data, key):
    """All columns against one, with gaps where a run failed."""
    x = data.pop(key)
    for i, ((name, values), marker) in enumerate(zip(data.items(), MARKERS)):
        ax.plot(x, [v if math.isfinite(v) else math.nan for v in values], marker + "-", label=name,
                markerfacecolor="none", markersize=max(4, 9 - 0.6 * i)) # open, so that equal curves show


def convergence(name, reference, order, label="largest error of position"):
    figure, ax = axes()
    data = read(name)
    cells = data["cells"]
    series(ax, data, "cells")
    for ends, start, p in zip(reference[::2], reference[1::2], order):
        slope(ax, ends, start, -p)
    loglog(ax, "cells along an axis", label)
    ticks(ax, cells)
    ax.legend(fontsize=7)
    return figure


@plot
def bar_convergence():
    return convergence("bar_convergence", ((32, 256), 2.6e-4), (2,))


@plot
def bar_boundaries():
    return convergence("bar_boundaries", ((32, 128), 8e-3, (32, 128), 3e-4), (1, 2))


@plot
def cube_convergence():
    return convergence("cube_convergence", ((12, 32), 2.4e-2, (12, 32), 2.2e-3), (1, 2))


@plot
def bar_smoothing():
    figure, ax = axes()
    data = read("bar_smoothing")
    length = data.pop("length")
    for i, (name, error) in enumerate(data.items()):
        ax.semilogy(length, [e if e < 0.05 else math.nan for e in error], "-", color=f"C{i}", label=name)
        ax.axvline(1 / int(name.split()[0]), color=f"C{i}", linestyle=":", linewidth=1)
    ax.set(xlabel="smoothing length l / h (dotted: width of the particles)", ylabel="largest error of position")
    ax.legend(fontsize=7)
    return figure


@plot
def bar_cfl():
    figure, both = axes(2, 4.0)
    for ax, per_cell in zip(both, (4, 8)):
        data = read(f"bar_cfl_{per_cell}")
        cfl = data.pop("cfl")
        for (name, error), marker in zip(data.items(), MARKERS):
            ax.semilogy(cfl, [e if e < 0.05 else math.nan for e in error], marker + "-", label=name, markersize=3)
        ax.set(title=f"{per_cell} per cell", xlabel="CFL number", ylim=(2e-6, 5e-2))
    both[0].set_ylabel("largest error of position")
    both[0].legend(fontsize=7)
    return figure


@plot
def bar_schemes():
    figure, ax = axes()
    data = read("bar_schemes")
    cfl = list(data["cfl"])
    series(ax, data, "cfl")
    loglog(ax, "CFL number", "largest error of position")
    ticks(ax, cfl)
    ax.legend(fontsize=7)
    return figure


@plot
def force_quadrature():
    figure, ax = axes()
    series(ax, read("force_quadrature"), "spacing")
    slope(ax, (0.006, 0.06), 1.5e-2, 1)
    slope(ax, (0.006, 0.06), 5e-6, 2)
    loglog(ax, "particle spacing / h", "r.m.s. error of internal force", 10)
    ax.legend(fontsize=7)
    return figure


@plot
def boundary_density():
    figure, ax = axes()
    data = read("boundary_density")
    x = data.pop("x")
    for (name, density), style in zip(data.items(), ("k-", "C0--", "C1-", "C2-.")):
        ax.plot(x, density, style, label=name, linewidth=1.2)
    ax.set(xlabel="x (h = 0.1)", ylabel="projected density", xlim=(-0.4, 0.4))
    ax.legend(fontsize=7)
    return figure
