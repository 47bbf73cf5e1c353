"""The manufactured bar and cube of Steffen et al. 2008."""
from plot import axes, loglog, plot, read, slope


@plot
def bar_convergence():
    figure, ax = axes()
    data = read("bar_convergence")
    cells = data.pop("cells")
    for (name, error), marker in zip(data.items(), "osD^v<>"):
        ax.plot(cells, error, marker + "-", label=name)
    slope(ax, (32, 512), 3e-4, -2)
    loglog(ax, "cells", "largest error of position")
    ax.legend(fontsize=7)
    return figure
