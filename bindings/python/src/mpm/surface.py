"""Surfaces: markers without mass that carry loads on the boundary of the material, or prescribe how it moves."""
import ctypes

import numpy as np

from . import _api
from ._arrays import TYPES, Batch, address, chosen, columns, doubles, rows, scalar, vector, vectors, whole
from ._handles import Handle, descriptor, fill
from ._library import documented, lib

_SCALARS = ("id", "reference_area", "pressure")
_VECTORS = ("traction", "dead_traction", "velocity")


class MarkerBatch(Batch):
    """Markers for which tractions or velocities are wanted: n, dim, t, dt, id (n,), position, area (out of the material), displacement and
    velocity (n, dim), reference_area (n,)."""

    _arrays = {"id": scalar, "position": vector, "area": vector, "reference_area": scalar, "displacement": vector,
               "velocity": vector}


class Surface(Handle):
    """Markers that the material carries along, and that load it. The options are the fields of mpm_surface_desc, which load
    all markers: pressure (force/area against the normal), traction (force per present area) and dead_traction (force per
    area at the time of adding), both (dim,); body, max_spacing (length). With prescribes = PRESCRIBES_VELOCITY or
    PRESCRIBES_NORMAL markers move with velocity (dim,), and the material there does, or along the area vectors alone; penalty
    and modulus (force/area) are those of the springs of implicit steps.

    surface["force"] is a copy by ascending id, (n, dim), or (n,) for what has one component; surface["pressure"] = values
    sets it, for all markers to one value where the values have no item axis. Area vectors, area times normal, point out of
    the material; they and forces are per thickness in 2-D, and of one radian on a grid that is AXISYMMETRIC. A stepper to
    which it was added keeps it alive.
    """

    _destroy = staticmethod(lib.mpm_surface_destroy)

    def __init__(self, context, grid, **options):
        self.grid, self.dim, self._traction, self._velocity = grid, grid.dim, None, None
        self._options = descriptor(_api.surface_desc, lib.mpm_surface_desc_init, self._along(options), "Surface")
        self._own(context, context._make(self._destroy, lib.mpm_surface_create, context, grid, ctypes.byref(self._options)), context, grid)

    def _along(self, options):
        """The options with vectors that have as many components as the grid has dimensions."""
        return {name: list(doubles(value, self.dim)) if name in _VECTORS else value for name, value in options.items()}

    # ---- loads ----

    @documented("mpm_surface_configure")
    def configure(self, **options):
        """Changes loads and options between steps; those that are not named stay."""
        desc = _api.surface_desc.from_buffer_copy(self._options)
        fill(desc, self._along(options), "Surface")
        self._context._check(lib.mpm_surface_configure(self, ctypes.byref(desc)))
        self._options = desc

    def option(self, name):
        """The present value of an option."""
        value = getattr(self._options, name)
        return tuple(value)[:self.dim] if isinstance(value, ctypes.Array) else value

    @documented("mpm_surface_set_traction")
    def set_traction(self, fn):
        """fn(batch, add) adds forces per present area of the markers of a MarkerBatch to add (n, dim). It may return 1 to
        ask for a smaller dt; what it raises comes out of the step. None takes it away."""

        def call(_, batch, add):
            return MarkerBatch(batch)._run(fn, (add, np.float64, self.dim))

        made = self._context._callback(_api.traction_fn, fn, call)
        self._context._check(lib.mpm_surface_set_traction(self, made, None))
        self._traction = made

    @documented("mpm_surface_set_velocity")
    def set_velocity(self, fn):
        """fn(batch, add) adds velocities of the markers of a MarkerBatch to add (n, dim), where the surface prescribes. It
        may return 1 to ask for a smaller dt; what it raises comes out of the step. None takes it away."""

        def call(_, batch, add):
            return MarkerBatch(batch)._run(fn, (add, np.float64, self.dim))

        made = self._context._callback(_api.marker_velocity_fn, fn, call)
        self._context._check(lib.mpm_surface_set_velocity(self, made, None))
        self._velocity = made

    @documented("mpm_surface_set_heat")
    def set_heat(self, flux=0.0, film=0.0, ambient=0.0):
        """Heats what lies below, per area: flux + film (ambient - temperature)."""
        self._context._check(lib.mpm_surface_set_heat(self, flux, film, ambient))

    # ---- markers ----

    @documented("mpm_surface_add")
    def add(self, position, area=None):
        """Adds markers at position (n, dim), with area vectors (n, dim), or one for all, or without area. Returns the range
        of their ids."""
        position = vectors(position, self.dim)
        n = position.shape[1]
        if area is not None:
            area = vectors(area, self.dim)
            area = np.ascontiguousarray(np.broadcast_to(area, (self.dim, n)))
        first = ctypes.c_int64()
        self._context._check(lib.mpm_surface_add(self, n, address(position), address(area), ctypes.addressof(first)))
        return range(first.value, first.value + n)

    def _added(self, function, *arguments):
        first, count = ctypes.c_int64(), ctypes.c_int64()
        self._context._check(function(self, *arguments, ctypes.addressof(first), ctypes.addressof(count)))
        return range(first.value, first.value + count.value)

    @documented("mpm_surface_add_polyline")
    def add_polyline(self, position, spacing, closed=False):
        """Adds markers along the line through points (n, 2), with the material on its left. Returns the range of their
        ids."""
        at = columns(position, 2, len(position), np.float64)
        return self._added(lib.mpm_surface_add_polyline, at.shape[1], address(at), bool(closed), spacing)

    @documented("mpm_surface_add_triangles")
    def add_triangles(self, position, corner, spacing):
        """Adds markers on triangles: position is (n, 3), corner (triangles, 3) of numbers of points, counter-clockwise as
        seen from outside. Returns the range of their ids."""
        at, triangles = columns(position, 3, len(position), np.float64), np.asarray(corner)
        if triangles.ndim != 2 or triangles.shape[1] != 3 or triangles.dtype.kind not in "iu":
            raise ValueError(f"corner is {triangles.shape} of {triangles.dtype}, must be integers (triangles, 3)")
        triangles = np.ascontiguousarray(triangles, np.int64)
        return self._added(lib.mpm_surface_add_triangles, at.shape[1], address(at), len(triangles), address(triangles), spacing)

    @documented("mpm_surface_remove")
    def remove(self, ids):
        """Removes markers by id: all or none."""
        ids = whole(ids, "ids")
        self._context._check(lib.mpm_surface_remove(self, len(ids), address(ids)))

    @documented("mpm_surface_refine")
    def refine(self, spacing):
        """Splits markers until no edge is longer than spacing. Returns how many came."""
        added = ctypes.c_int64()
        self._context._check(lib.mpm_surface_refine(self, spacing, ctypes.addressof(added)))
        return added.value

    def __len__(self):
        return lib.mpm_surface_count(self)

    def __bool__(self):
        return True

    @property
    def ids(self):
        """The ids of all markers, ascending."""
        return self["id"]

    def _field(self, name):
        return _api.I64 if name == "id" else _api.F64, 1 if name in _SCALARS else self.dim

    @documented("mpm_surface_get")
    def get(self, field, ids=None):
        """Copies a field, of all markers by ascending id or of those with the given ids."""
        kind, components = self._field(field)
        ids, n = chosen(ids, len(self))
        out = np.empty((components, n), TYPES[kind])
        self._context._check(lib.mpm_surface_get(self, field.encode(), kind, components, n, address(ids), address(out)))
        return rows(out)

    @documented("mpm_surface_set")
    def set(self, field, values, ids=None):
        """Sets a field of all markers by ascending id, or of those with the given ids; one value stands for all."""
        kind, components = self._field(field)
        dtype, values = TYPES[kind], np.asarray(values)
        ids, n = chosen(ids, len(self))
        if values.ndim == 0 or (values.ndim == 1 and components > 1):
            values = np.broadcast_to(values, (n, components))
        array = columns(values, components, n, dtype)
        self._context._check(lib.mpm_surface_set(self, field.encode(), kind, components, n, address(ids), address(array)))

    def __getitem__(self, field):
        return self.get(field)

    def __setitem__(self, field, values):
        self.set(field, values)
