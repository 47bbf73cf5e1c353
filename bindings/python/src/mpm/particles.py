"""Sets of particles: filled, changed, read by id, or seen where they lie."""
import ctypes
import os

import numpy as np

from . import _api
from ._arrays import TYPES, address, chosen, columns, doubles, exactly, lend, rows, vectors, whole
from ._guard import Guard
from ._handles import Handle
from ._library import documented, lib

_TENSORS = ("deformation_gradient", "velocity_gradient")
_STORED = {"deformation_gradient": (1, 5, 9), "velocity_gradient": (1, 4, 9), "stress": (3, 4, 6)}
_NAMES = {np.dtype(np.float64): _api.F64, np.dtype(np.int64): _api.I64, np.dtype(np.uint8): _api.U8,
          np.dtype(bool): _api.U8}


class Particles(Handle):
    """A set of particles of one material on one grid.

    set["velocity"] is a copy by ascending id, (n, components), or (n, 3, 3) for a tensor; set["velocity"] = values sets it,
    for all particles to one value where the values have no item axis. view() shows the library's own memory.
    """

    _destroy = staticmethod(lib.mpm_particles_destroy)

    def __init__(self, context, grid, material):
        self._own(context, context._make(self._destroy, lib.mpm_particles_create, context, grid, material), context, grid, material)
        self.grid, self.material, self.dim = grid, material, grid.dim
        self._look()
        material._sets.add(self)

    def _look(self):
        """Learns which fields there are: their types, and the components of copies and of what is stored."""
        self._fields, self._kinds = {}, {}
        name = ctypes.c_char_p()
        kind, components, writable = (ctypes.c_int32() for _ in range(3))
        index = 0
        while lib.mpm_particles_field_info(self, index, ctypes.addressof(name), ctypes.addressof(kind),
                                           ctypes.addressof(components), ctypes.addressof(writable)) == 0:
            text = name.value.decode()
            self._fields[text] = (kind.value, components.value, bool(writable.value))
            stored = _STORED[text][self.dim - 1] if text in _STORED else components.value
            self._kinds[text] = (kind.value, stored)
            index += 1

    @property
    def fields(self):
        """The fields by name: (dtype, components of copies, whether they may be written)."""
        return {name: (TYPES[kind], components, writable) for name, (kind, components, writable) in self._fields.items()}

    def __len__(self):
        return lib.mpm_particles_count(self)

    @documented("mpm_particles_total")
    def total(self):
        """How many particles all parts of the problem have."""
        n = ctypes.c_int64()
        self._context._check(lib.mpm_particles_total(self, ctypes.byref(n)))
        return n.value

    def __bool__(self):
        return True

    @documented("mpm_particles_add")
    def add(self, position, volume, velocity=None, size=None, ids=None):
        """Adds particles at position (n, dim), with volume (n,) or one for all. Returns the range of ids, where the library
        gives them."""
        position = vectors(position, self.dim)
        n = position.shape[1]

        def each(values):
            """Vectors of all particles: one, or a number for all components, stands for all."""
            if values is None:
                return None
            values = np.asarray(values, np.float64)
            return columns(np.broadcast_to(values, (n, self.dim)) if values.ndim < 2 else values, self.dim, n, np.float64)

        velocity, size = each(velocity), each(size)
        volume = np.ascontiguousarray(np.broadcast_to(np.asarray(volume, np.float64), (n,)))
        ids = None if ids is None else whole(ids, "ids")
        if ids is not None and ids.shape != (n,):
            raise ValueError(f"{ids.shape} ids for {n} particles")
        first = ctypes.c_int64()
        self._context._check(lib.mpm_particles_add(self, n, address(position), address(velocity), address(volume),
                                                   address(size), address(ids), ctypes.addressof(first)))
        return range(first.value, first.value + n) if ids is None else ids

    def _fill(self, function, *arguments):
        first, count = ctypes.c_int64(), ctypes.c_int64()
        self._context._check(function(self, *arguments, ctypes.addressof(first), ctypes.addressof(count)))
        return self

    def _per_cell(self, per_cell):
        return np.ascontiguousarray(np.broadcast_to(exactly(whole(per_cell, "per_cell"), np.int32), (self.dim,)))

    @documented("mpm_particles_fill_box")
    def fill_box(self, lower, upper, per_cell=2):
        """Fills a box with per_cell particles along each axis of a cell; returns the set."""
        lower, upper, per_cell = doubles(lower, self.dim), doubles(upper, self.dim), self._per_cell(per_cell)
        return self._fill(lib.mpm_particles_fill_box, address(lower), address(upper), address(per_cell))

    @documented("mpm_particles_fill_ball")
    def fill_ball(self, centre, radius, per_cell=2):
        """Fills a ball; returns the set."""
        centre, per_cell = doubles(centre, self.dim), self._per_cell(per_cell)
        return self._fill(lib.mpm_particles_fill_ball, address(centre), radius, address(per_cell))

    @documented("mpm_particles_fill_mesh")
    def fill_mesh(self, position, corner, per_cell=2):
        """Fills what a mesh encloses; position is (n, dim), corner (elements, dim) of numbers of points; returns the set."""
        at = np.asarray(position, float)
        elements = np.asarray(corner)
        if at.ndim != 2 or at.shape[1] != self.dim:
            raise ValueError(f"position is {at.shape}, must be (n, {self.dim})")
        if elements.ndim != 2 or elements.shape[1] != self.dim or elements.dtype.kind not in "iu":
            raise ValueError(f"corner is {elements.shape} of {elements.dtype}, must be integers (elements, {self.dim})")
        at, elements = np.ascontiguousarray(at.T), np.ascontiguousarray(elements, np.int64)
        per_cell = self._per_cell(per_cell)
        return self._fill(lib.mpm_particles_fill_mesh, at.shape[1], address(at), len(elements), address(elements), address(per_cell))

    @documented("mpm_particles_fill")
    def fill(self, lower, upper, inside, per_cell=2):
        """Fills what of a box the function inside(x) accepts: x is (n, dim), the answer (n,) of bool; returns the set."""
        lower, upper, per_cell = doubles(lower, self.dim), doubles(upper, self.dim), self._per_cell(per_cell)

        def ask(_, dim, n, ld, position, answer):
            points = np.ctypeslib.as_array((ctypes.c_double * (dim * ld)).from_address(position))
            told = np.ascontiguousarray(inside(points.reshape(dim, ld)[:, :n].T.copy()), bool)
            if told.shape != (n,):
                raise ValueError(f"inside() gave {told.shape} answers for {n} points")
            ctypes.memmove(answer, address(told), n)  # told is held until here

        callback = _api.inside_fn(Guard(ask, self._context._raised))
        return self._fill(lib.mpm_particles_fill, address(lower), address(upper), address(per_cell), callback, None)

    @documented("mpm_particles_remove")
    def remove(self, ids):
        """Removes particles by id."""
        ids = whole(ids, "ids")
        self._context._check(lib.mpm_particles_remove(self, len(ids), address(ids)))

    @documented("mpm_particles_pack")
    def pack(self, ids=None):
        """All particles by ascending id, or those with the given ids, as bytes that unpack() takes."""
        ids, n = chosen(ids, len(self))
        count = ctypes.c_int64()
        self._context._check(lib.mpm_particles_packed_size(self, n, ctypes.byref(count)))
        buffer = ctypes.create_string_buffer(count.value)
        self._context._check(lib.mpm_particles_pack(self, n, address(ids), buffer, count.value))
        return buffer.raw

    @documented("mpm_particles_unpack")
    def unpack(self, packed):
        """Adds particles that pack() has given, of this set or of another."""
        packed = bytes(packed)
        self._context._check(lib.mpm_particles_unpack(self, packed, len(packed)))

    @property
    def ids(self):
        """The ids of all particles, ascending."""
        return self["id"]

    def _field(self, name):
        if name not in self._fields:
            self._look()
        if name not in self._fields:  # let the library say it, with the nearest names
            self._context._check(lib.mpm_particles_get(self, name.encode(), _api.F64, 1, 0, None, None))
            raise KeyError(name)
        return self._fields[name]

    @documented("mpm_particles_get")
    def get(self, field, ids=None):
        """Copies a field, of all particles by ascending id or of those with the given ids."""
        kind, components, _ = self._field(field)
        ids, n = chosen(ids, len(self))
        out = np.empty((components, n), TYPES[kind])
        self._context._check(lib.mpm_particles_get(self, field.encode(), kind, components, n, address(ids), address(out)))
        return rows(out, tensor=field in _TENSORS)

    @documented("mpm_particles_get_f32")
    def get_f32(self, *fields, order=_api.BY_ID):
        """Packs fields into floats, (n, components of all), without inert slots: what renderers want. LIBRARY_ORDER is faster
        than by ascending id."""
        width = sum(self._field(name)[1] for name in fields)
        out = np.empty((len(self), width), np.float32)
        names = (ctypes.c_char_p * max(len(fields), 1))(*(name.encode() for name in fields))
        self._context._check(lib.mpm_particles_get_f32(self, len(fields), ctypes.addressof(names), order, len(out), address(out)))
        return out

    @documented("mpm_particles_set")
    def set(self, field, values, ids=None):
        """Sets a field of all particles by ascending id, or of those with the given ids; one value stands for all."""
        kind, components, _ = self._field(field)
        dtype, values = TYPES[kind], np.asarray(values)
        ids, n = chosen(ids, len(self))
        alone = values.ndim == 0 or (values.ndim == 1 and components > 1) or (values.ndim == 2 and field in _TENSORS)
        if alone:
            value = np.broadcast_to(values.ravel() if values.ndim == 2 else values, (components,))
            value = np.ascontiguousarray(exactly(value, dtype))
            if ids is None:
                self._context._check(lib.mpm_particles_set_all(self, field.encode(), kind, components, address(value)))
                return
            values = np.broadcast_to(value, (n, components))
        array = columns(values, components, n, dtype)
        self._context._check(lib.mpm_particles_set(self, field.encode(), kind, components, n, address(ids), address(array)))

    def __getitem__(self, field):
        return self.get(field)

    def __setitem__(self, field, values):
        self.set(field, values)

    @documented("mpm_particles_add_field")
    def add_field(self, field, components=1, dtype=np.float64):
        """Adds a field of the host's own, of float64, int64, uint8 or bool."""
        kind = _NAMES.get(np.dtype(dtype))
        if kind is None:
            raise TypeError(f"fields are of float64, int64 or uint8, not of {np.dtype(dtype)}")
        self._context._check(lib.mpm_particles_add_field(self, field.encode(), kind, components))
        self._look()

    @documented("mpm_particles_set_extensive")
    def set_extensive(self, field, extensive=True):
        """Says that values of a field of the host are amounts, which parts of a particle share."""
        self._context._check(lib.mpm_particles_set_extensive(self, field.encode(), extensive))

    @documented("mpm_particles_map")
    def view(self, field, write=False):
        """Shows a field where it lies: (slots, components) in library order with the stored components, inert slots
        (id < 0) among them. Steps are refused until the last array over the view has died; values that are written and bad
        are reported by a RuntimeWarning then, and by the next step."""
        view = _api.view(struct_size=ctypes.sizeof(_api.view))
        access = _api.READ | (_api.WRITE if write else 0)
        self._context._check(lib.mpm_particles_map(self, field.encode(), access, ctypes.byref(view)))
        return lend(view, self)

    @documented("mpm_particles_set_geostatic")
    def set_geostatic(self, axis, gravity, surface, K0, surcharge=0.0):
        """Gives all particles the stress of ground at rest below a level surface."""
        self._context._check(lib.mpm_particles_set_geostatic(self, axis, gravity, surface, K0, surcharge))

    @documented("mpm_particles_reset_reference")
    def reset_reference(self):
        """Makes the present state the one from which deformation counts."""
        self._context._check(lib.mpm_particles_reset_reference(self))

    @documented("mpm_write_particles")
    def write(self, path, *fields):
        """Writes the set for ParaView (.vtp), with the named fields or all in use. path may be a file that is open for
        binary writing, or another object with write()."""
        names = (ctypes.c_char_p * max(len(fields), 1))(*(f.encode() for f in fields))
        where = len(fields), ctypes.addressof(names)
        if hasattr(path, "write"):
            self._context._check(lib.mpm_write_particles_to(self, self._context._sink(path), None, *where))
        else:
            self._context._check(lib.mpm_write_particles(self, os.fsencode(path), *where))
