"""Pictures of particles by matplotlib: their domains in 2-D, shaded points in 3-D."""
import numpy as np


def domains(particles):
    """The corners of the particles' domains in 2-D, (n, 4, 2): squares of the initial size, deformed by F."""
    size = particles["size"]
    F = particles["deformation_gradient"][:, :2, :2]
    corners = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
    edges = corners[None] * size[:, None]
    return particles["position"][:, None] + np.einsum("nij,nkj->nki", F, edges)


def colour(particles, by):
    """Numbers to colour by: "speed", "pressure", "mises", the name of a field, or values of one's own, (n,)."""
    if not isinstance(by, str):
        return np.asarray(by, float)
    if by == "speed":
        return np.linalg.norm(particles["velocity"].reshape(len(particles), -1), axis=1)
    if by in ("pressure", "mises"):
        s = particles["stress"]
        mean = s[:, :3].mean(axis=1)
        if by == "pressure":
            return -mean
        return np.sqrt(1.5 * (((s[:, :3] - mean[:, None]) ** 2).sum(axis=1) + 2 * (s[:, 3:] ** 2).sum(axis=1)))
    values = particles[by].reshape(len(particles), -1)
    return values[:, 0] if values.shape[1] == 1 else np.linalg.norm(values, axis=1)


def draw(*sets, by="speed", ax=None, limits=None, cmap="viridis", label=None):
    """Draws sets of particles and returns the axes; all share one scale of colours, which is labelled.

    by: see colour(); ax: axes of matplotlib, made where there are none; limits: of the colours."""
    import matplotlib.pyplot as plt
    from matplotlib.collections import PolyCollection

    dim, grid = sets[0].dim, sets[0].grid
    sets = [one for one in sets if len(one)]
    values = [colour(one, by) for one in sets]
    if limits is None and sets:
        limits = min(v.min() for v in values), max(v.max() for v in values)
    if ax is None:
        _, ax = plt.subplots(subplot_kw={"projection": "3d"} if dim == 3 else {}, layout="constrained")
    shown = None
    for one, value in zip(sets, values):
        x = one["position"].reshape(len(one), dim)
        if dim == 2:
            shown = PolyCollection(domains(one), array=value, cmap=cmap, clim=limits, edgecolors="face", linewidths=0.2)
            ax.add_collection(shown)
        elif dim == 3:
            shown = ax.scatter(*x.T, c=value, s=4, cmap=cmap, vmin=limits[0], vmax=limits[1])
        else:
            shown = ax.scatter(x[:, 0], value, c=value, s=6, cmap=cmap, vmin=limits[0], vmax=limits[1])
    low = np.array(grid.origin)
    high = low + np.array(grid.cells) * np.array(grid.spacing)
    ax.set_xlim(low[0], high[0])
    if dim > 1:
        ax.set_ylim(low[1], high[1])
        ax.set_aspect("equal")
    if dim == 3:
        ax.set_zlim(low[2], high[2])
    if shown is not None:
        ax.figure.colorbar(shown, ax=ax, label=label or (by if isinstance(by, str) else None), shrink=0.8)
    return ax
