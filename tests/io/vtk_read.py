"""Reads what write_vtp.c and write_vti.c wrote with VTK and compares every number with what the library gave.

Usage: vtk_read.py directory; the times of the series come on standard input.
"""

import os
import sys
import xml.etree.ElementTree as ElementTree

from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLPolyDataReader, vtkXMLRectilinearGridReader

# Fields that take no memory until they are used: a file of all fields may leave them out.
OPTIONAL = {"acceleration", "velocity_gradient", "applied_force", "prescribed", "size", "image"}
VECTORS = {"velocity", "acceleration", "size", "reference_position", "applied_force", "position", "force", "reaction",
           "index"}
READERS = {".vtp": vtkXMLPolyDataReader, ".vti": vtkXMLImageDataReader, ".vtr": vtkXMLRectilinearGridReader}
SHOWN = {"F64": "double", "I64": ("long", "long long", "vtktypeint64"), "U8": "unsigned char"}


def fail(text):
    sys.exit("vtk_read.py: " + text)


def read(path):
    reader = READERS[path[-4:]]()
    errors = []
    reader.AddObserver("ErrorEvent", lambda *_: errors.append(path))
    reader.AddObserver("WarningEvent", lambda *_: errors.append(path))
    reader.SetFileName(path)
    if not reader.CanReadFile(path):
        fail(path + ": VTK cannot read it")
    reader.Update()
    if errors or reader.GetErrorCode():
        fail(path + ": VTK reports errors")
    return reader.GetOutput()


def expected(path):
    """Values by field: (type, [component][particle])."""
    fields = {}
    with open(path, encoding="ascii") as lines:
        for line in lines:
            name, kind, components, count, component, *words = line.split()
            values = [float.fromhex(w) if kind == "F64" else int(w) for w in words]
            if len(values) != int(count):
                fail(path + ": broken")
            rows = fields.setdefault(name, (kind, []))[1]
            if int(component) != len(rows) or int(component) >= int(components):
                fail(path + ": broken")
            rows.append(values)
    return fields


def same(a, b):
    return a == b or (a != a and b != b)


def compare(path, name, array, kind, rows, dim):
    shown = 3 if dim > 1 and name in VECTORS else len(rows)
    if array.GetNumberOfComponents() != shown:
        fail("%s: %s has %d components, not %d" % (path, name, array.GetNumberOfComponents(), shown))
    if array.GetDataTypeAsString() not in SHOWN[kind]:
        fail("%s: %s is %s" % (path, name, array.GetDataTypeAsString()))
    if array.GetNumberOfTuples() != len(rows[0]):
        fail("%s: %s has %d values" % (path, name, array.GetNumberOfTuples()))
    for i in range(array.GetNumberOfTuples()):
        for c in range(shown):
            # GetValue does not pass through double, which 64-bit numbers do not fit
            found, wanted = array.GetValue(i * shown + c), rows[c][i] if c < len(rows) else 0.0
            if not same(found, wanted):
                fail("%s: %s[%d] of point %d is %r, not %r" % (path, name, c, i, found, wanted))


def check_geometry(path, data, position):
    count = len(position[0])
    if data.GetNumberOfPoints() != count or data.GetNumberOfVerts() != count:
        fail("%s: %d points, %d vertices" % (path, data.GetNumberOfPoints(), data.GetNumberOfVerts()))
    if data.GetNumberOfCells() != count:
        fail(path + ": cells that are not vertices")
    for i in range(count):
        wanted = [row[i] for row in position] + [0.0] * (3 - len(position))
        if list(data.GetPoint(i)) != wanted:
            fail("%s: point %d is %r, not %r" % (path, i, data.GetPoint(i), wanted))
        cell = data.GetCell(i)
        if cell.GetNumberOfPoints() != 1 or cell.GetPointId(0) != i:
            fail("%s: vertex %d is not point %d" % (path, i, i))


def check_file(path):
    data, fields = read(path), expected(path + ".expect")
    position = fields["position"][1]
    check_geometry(path, data, position)
    arrays = data.GetPointData()
    found = {arrays.GetArrayName(i) for i in range(arrays.GetNumberOfArrays())}
    base = os.path.basename(path)
    everything = not base.startswith(("some", "one"))
    wanted = set(fields)
    if not base.startswith(("some", "one_position")):
        wanted.discard("position")  # the points
    if everything:
        if "stress" not in found or "id" not in found or "colour" not in found:
            fail(path + ": fields are missing: has " + ", ".join(sorted(found)))
    if found - wanted or wanted - found - (OPTIONAL if everything else set()):
        fail("%s: has %s, not %s" % (path, sorted(found), sorted(wanted)))
    for name in found:
        kind, rows = fields[name]
        compare(path, name, arrays.GetArray(name), kind, rows, len(position))
    return len(found), data.GetNumberOfPoints()


def check_point(path, data, i, position, index, dim):
    wanted = [position[k] if k < dim else 0.0 for k in range(3)]
    if max(abs(a - b) for a, b in zip(data.GetPoint(i), wanted)) > 1e-14:
        fail("%s: node %s is at %r, not %r" % (path, index, data.GetPoint(i), wanted))


def check_image(path):
    """The extent is the box of the nodes that the library lists; values at these, zeros elsewhere."""
    data, fields = read(path), expected(path + ".expect")
    index, position = fields["index"][1], fields["position"][1]
    dim, count = len(index), len(index[0])
    box = [(min(row), max(row)) for row in index] if count else [(0, -1)] * 3
    box += [(0, 0)] * (3 - len(box))
    if list(data.GetExtent()) != [n for pair in box for n in pair]:
        fail("%s: extent is %r, not %r" % (path, data.GetExtent(), box))
    arrays = data.GetPointData()
    found = {arrays.GetArrayName(i) for i in range(arrays.GetNumberOfArrays())}
    wanted = set(fields) - {"position"}
    if os.path.basename(path).startswith("some"):
        wanted = {"reaction", "position", "mass"}
    if found != wanted:
        fail("%s: has %s, not %s" % (path, sorted(found), sorted(wanted)))
    if not count:
        return len(found), 0
    sizes = [high - low + 1 for low, high in box]
    nodes = sizes[0] * sizes[1] * sizes[2]
    place = {}
    for i in range(count):
        at = [index[k][i] - box[k][0] if k < dim else 0 for k in range(3)]
        here = at[0] + sizes[0] * (at[1] + sizes[1] * at[2])
        place[here] = i
        check_point(path, data, here, [row[i] for row in position], at, dim)
    if len(place) != count or data.GetNumberOfPoints() != nodes:
        fail("%s: %d points for %d nodes" % (path, data.GetNumberOfPoints(), nodes))
    for name in found:
        kind, rows = fields[name]
        full = [[row[place[i]] if i in place else 0 for i in range(nodes)] for row in rows]
        compare(path, name, arrays.GetArray(name), kind, full, dim)
    return len(found), nodes - count


def check_series(directory, times):
    root = ElementTree.parse(os.path.join(directory, "run.pvd")).getroot()
    if root.tag != "VTKFile" or root.get("type") != "Collection":
        fail("run.pvd is not a collection")
    entries = root.find("Collection").findall("DataSet")
    if [float(e.get("timestep")) for e in entries] != times:
        fail("run.pvd: wrong times")
    for k, entry in enumerate(entries):
        if entry.get("file") != "a <run> & \"%d'.vtp" % k:
            fail("run.pvd: wrong file " + entry.get("file"))
        check_file(os.path.join(directory, entry.get("file")))
    return len(entries)


def main():
    directory = sys.argv[1]
    times = [float(line) for line in sys.stdin]
    files = sorted(name for name in os.listdir(directory) if name.endswith(".vtp"))
    checked = [check_file(os.path.join(directory, name)) for name in files]
    images = [check_image(os.path.join(directory, name))
              for name in sorted(os.listdir(directory)) if name.endswith((".vti", ".vtr"))]
    series = check_series(directory, times)
    if len(checked) < 50 or series != 3 or max(points for _, points in checked) < 1500:
        fail("too little to check")
    if len(images) < 24 or max(zeros for _, zeros in images) < 1000:
        fail("too few images to check")
    print("vtk_read.py: %d sets, %d images, %d arrays, a series of %d" % (
        len(checked), len(images), sum(a for a, _ in checked + images), series))


main()
