"""Files of several parts are read with VTK: read_vtk.py FOLDER PROCESSES, after test_files. Particles are those that each part
has written alone; nodes are those of one image."""
import sys

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import (vtkXMLImageDataReader, vtkXMLPImageDataReader, vtkXMLPolyDataReader,
                                 vtkXMLPPolyDataReader)

folder, processes = sys.argv[1], int(sys.argv[2])


def read(reader, name):
    reader.SetFileName(f"{folder}/{name}")
    reader.Update()
    assert not reader.GetErrorCode(), name
    return reader.GetOutput()


def arrays(data):
    points = data.GetPointData()
    return {points.GetArrayName(k): vtk_to_numpy(points.GetArray(k)) for k in range(points.GetNumberOfArrays())}


def same(a, b, what):
    assert a.shape == b.shape and a.tobytes() == b.tobytes(), what


shown = read(vtkXMLPPolyDataReader(), "shown.pvtp")
found, at = arrays(shown), 0
for part in range(processes):
    alone = read(vtkXMLPolyDataReader(), f"alone_{part}.vtp")
    n = alone.GetNumberOfPoints()
    if not n:
        continue
    expected = arrays(alone)
    assert set(expected) == set(found), (sorted(expected), sorted(found))
    for name, values in expected.items():
        same(found[name][at:at + n], values, name)
    same(vtk_to_numpy(shown.GetPoints().GetData())[at:at + n], vtk_to_numpy(alone.GetPoints().GetData()), "points")
    at += n
assert at == shown.GetNumberOfPoints() == shown.GetNumberOfVerts() > 0

shown, whole = read(vtkXMLPImageDataReader(), "shown.pvti"), read(vtkXMLImageDataReader(), "shown_whole.vti")
assert shown.GetExtent() == whole.GetExtent() and shown.GetOrigin() == whole.GetOrigin()
assert shown.GetSpacing() == whole.GetSpacing()
found, expected = arrays(shown), arrays(whole)
assert set(found) == set(expected) and len(found) > 3
for name in expected:
    same(found[name], expected[name], name)
