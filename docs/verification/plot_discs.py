"""Four discs that a striker hits: fringes by photoelasticity, velocities and momenta."""
import numpy as np

from plot import axes, plot, plt, read
from plot_cases import rows

FRINGES, FINER = 7, 6  # Guilkey & Weiss 2003, eq. 22; points drawn along a cell


def grown(values):
    """Cells beside those that have a value take the mean of their neighbours."""
    rows_, columns = values.shape
    padded = np.pad(values, 1, constant_values=np.nan)
    around = np.array([padded[a:a + rows_, b:b + columns] for a in range(3) for b in range(3)])
    count = (~np.isnan(around)).sum(axis=0)
    return np.where(np.isnan(values) & (count > 0), np.nansum(around, axis=0) / np.maximum(count, 1), values)


def finer(values):
    """Linear between the middles of cells, along the first axis."""
    at = np.clip((np.arange(FINER * len(values)) + 0.5) / FINER - 0.5, 0, len(values) - 1)
    low = np.minimum(at.astype(int), len(values) - 2)
    share = (at - low)[:, None]
    return (1 - share) * values[low] + share * values[low + 1]


def fringes(data, key):
    """Intensities of the whole row of discs, from the half above its axis; not a number outside."""
    h = 2 * min(data["y"])
    i, j = (np.round(np.array(data[k]) / h - 0.5).astype(int) for k in ("x", "y"))
    stress = np.full((j.max() + 1, i.max() + 1), np.nan)
    stress[j, i] = data[key]
    fine = finer(finer(np.nan_to_num(grown(grown(stress)))).T).T
    y, x = ((np.arange(n) + 0.5) * h / FINER for n in fine.shape)
    inside = np.hypot(x[None, :] % 1 - 0.5, y[:, None]) < 0.5
    half = np.where(inside, np.cos(2 * np.pi * FRINGES * fine), np.nan)
    return np.vstack((half[::-1], half))


def fringe_pictures(file):
    data = read(file)
    gray = plt.get_cmap("gray").copy()
    gray.set_bad("#c4d2e4")
    figure, ax = plt.subplots(3, 2, figsize=(9.6, 4.2), layout="constrained")
    for k, key in enumerate(list(data)[2:]):
        panel = ax[k % 3][k // 3]
        panel.imshow(fringes(data, key), cmap=gray, vmin=-1, vmax=1, origin="lower", extent=(0, 4, -0.5, 0.5),
                     interpolation="none", rasterized=True)
        panel.set_axis_off()
        panel.set_title("{}, t = {}".format(*key.rsplit(" ", 1)), fontsize=9)
    return figure


@plot
def four_discs_fringes():
    return fringe_pictures("four_discs_fringes")


@plot
def four_discs_apart():
    return fringe_pictures("four_discs_apart")


@plot
def four_discs():
    figure, ax = axes(2)
    data = read("four_discs")
    for scheme, cells, line in (("MUSL", 50, "-"), ("Newmark", 50, "."), ("MUSL", 80, "--"), ("bodies by MUSL", 50, ":")):
        at = rows(data, scheme=scheme, cells=float(cells))
        style = {"linewidth": 0.8, "markersize": 3}
        for k in range(4):
            for panel, key in zip(ax, "vp"):
                panel.plot(at["t"], at[f"{key}{k + 1}"], f"C{k}{line}", **style)
        ax[1].plot([], [], f"k{line}", label=f"{scheme}, {cells} cells", **style)
    for k in range(4):
        ax[0].axvline(k + 0.5, color=f"C{k}", linewidth=0.6)
    for panel, text in zip(ax, ("velocity of the centre / of the striker", "momentum / of a disc as fast as the striker")):
        panel.set_xlabel("time / transit of a disc")
        panel.set_ylabel(text)
    ax[1].legend()
    return figure
