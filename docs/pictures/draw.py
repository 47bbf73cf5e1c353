#!/usr/bin/python3
"""Draws indenter.png beside this file from what examples/indenter has written. Needs Debian's python3-vtk9 and
python3-matplotlib.

    draw.py DIRECTORY
"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy
from matplotlib.collections import PolyCollection
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

RADIUS = 20.0  # of the sphere, mm


def read(path):
    """Positions and fields of the particles, by name."""
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    fields = {"position": vtk_to_numpy(data.GetPoints().GetData())}
    for k in range(data.GetPointData().GetNumberOfArrays()):
        array = data.GetPointData().GetArray(k)
        values = vtk_to_numpy(array)
        fields[array.GetName()] = values.reshape(-1, 3, 3) if array.GetNumberOfComponents() == 9 else values
    return fields


def von_mises(stress):
    xx, yy, zz, xy, yz, xz = stress.T
    return numpy.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * (xy ** 2 + yz ** 2 + xz ** 2))


def tiles(block, size):
    """The layer of particles along the plane y = 0: corners of their domains in x and z, and which they are."""
    F = block["deformation_gradient"]
    layer = block["position"][:, 1] < size * F[:, 1, 1]
    centre = block["position"][layer][:, [0, 2]]
    edges = 0.5 * size * F[layer][:, [0, 2]][:, :, [0, 2]]  # columns: where the edges along x and z go
    corners = [centre + a * edges[:, :, 0] + b * edges[:, :, 1] for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return 1e3 * numpy.stack(corners, axis=1), layer


def main(directory):
    directory = pathlib.Path(directory)
    first = read(directory / "block_0000.vtp")
    last = read(sorted(directory.glob("block_*.vtp"))[-1])
    with open(directory / "force.csv", newline="") as file:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    corners, layer = tiles(last, 2.0 * first["position"][:, 1].min())
    height = 1e3 * (first["position"][:, 2].max() + first["position"][:, 1].min())
    stress = 1e-3 * von_mises(last["stress"][layer])

    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False})
    figure, (cut, curve) = plt.subplots(1, 2, figsize=(9.6, 3.6), layout="constrained", width_ratios=(1.6, 1))
    for side in (1.0, -1.0):
        shown = PolyCollection(corners * (side, 1.0), array=stress, cmap="viridis", edgecolors="face", linewidths=0.2)
        shown.set_clim(0.0, numpy.percentile(stress, 99.5))
        cut.add_collection(shown)
    cut.add_patch(plt.Circle((0.0, height + RADIUS - rows[-1]["depth_mm"]), RADIUS, color="#c8ccd2"))
    cut.set(aspect="equal", xlim=(-50, 50), ylim=(0, 50), xlabel="mm", ylabel="mm")
    figure.colorbar(shown, ax=cut, label="von Mises stress / kPa", extend="max", shrink=0.8)
    depth = [row["depth_mm"] for row in rows]
    for key, line, label in (("steel_N", "C0-", "steel"), ("steel_hertz_N", "C0:", "Hertz"), ("rubber_N", "C1-", "rubber"),
                             ("rubber_hertz_N", "C1:", "Hertz, both soft")):
        curve.plot(depth, [row[key] for row in rows], line, label=label)
    curve.set(xlabel="depth / mm", ylabel="force on the quarter / N", ylim=(0, None))
    curve.legend()
    figure.savefig(pathlib.Path(__file__).with_name("indenter.png"), dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
