"""Arrays of numpy over the library's memory, and numbers of Python as the library wants them."""
import ctypes
import math

import numpy as np

from . import _api, _view
from ._library import lib

TYPES = {_api.F64: np.dtype(np.float64), _api.I64: np.dtype(np.int64), _api.U8: np.dtype(np.uint8)}
_FORMATS = {_api.F64: "d", _api.I64: "q", _api.U8: "B"}
_RELEASE = ctypes.cast(lib.mpm_view_release, ctypes.c_void_p).value


def doubles(values, *shape):
    """A contiguous array of doubles of a shape; one number stands for all of a vector."""
    array = np.asarray(values, np.float64)
    if array.ndim == 0 and len(shape) == 1:
        array = np.full(shape, float(array))
    if array.shape != shape:
        raise ValueError(f"an array of shape {array.shape} where {shape} is wanted")
    return np.ascontiguousarray(array)


def columns(values, components, n, dtype):
    """(n, components) numbers, or tensors (n, 3, 3), in the library's order [components][n]."""
    array = exactly(values, dtype)
    if array.ndim == 3:
        array = array.reshape(len(array), -1)
    if components == 1 and array.ndim == 1:
        array = array[:, None]
    if array.shape != (n, components):
        raise ValueError(f"values of shape {np.shape(values)} where {(n, components)} is wanted")
    return np.ascontiguousarray(array.T)


def vectors(values, dim):
    """Vectors (n, dim) in the library's order; one of them, or numbers in 1-D, may do without the other axis."""
    array = np.asarray(values, np.float64)
    if array.ndim < 2:
        array = array.reshape(-1, 1) if dim == 1 else array.reshape(1, -1)
    return columns(array, dim, len(array), np.float64)


def rows(array, tensor=False):
    """What the library has as [components][n] as (n, components): (n,) for one, (n, 3, 3) for a tensor."""
    if len(array) == 1 and not tensor:
        return array[0]
    if tensor and len(array) == 9:
        return array.reshape(3, 3, -1).transpose(2, 0, 1)
    return array.T


def exactly(values, dtype):
    """An array of a type that holds the values: numpy would cut fractions off, and let whole numbers wrap around."""
    array = np.asarray(values)
    made = array.astype(dtype, copy=False)
    if made.dtype.kind in "iu" and array.dtype != made.dtype and not np.array_equal(made, array):
        raise ValueError(f"values of {array.dtype} are not all held by {made.dtype}")
    return made


def whole(values, what):
    """Whole numbers as they are: a mask or a fraction would be taken for others."""
    array = np.atleast_1d(values)
    if array.size and array.dtype.kind not in "iu":
        raise TypeError(f"{what} are of {array.dtype}, must be whole numbers" +
                        (": of a mask, take numpy.flatnonzero" if array.dtype.kind == "b" else ""))
    return np.ascontiguousarray(array, np.int64)


def chosen(ids, count):
    """Ids for C and how many they are; of all `count` items where ids is None."""
    if ids is None:
        return None, count
    ids = whole(ids, "ids")
    return ids, len(ids)


def address(array):
    """The address of an array's memory, or None for None."""
    return None if array is None else array.ctypes.data


def lend(view, owner):
    """An array over a view that the library has just filled; the view ends with the last array that shows it. One that dies
    while a call is under way, in a callback, is still lent: it is given back later."""

    def give_back():
        status = lib.mpm_view_release(ctypes.byref(view))
        return status if view.owner else owner._given_back(status)

    def ended(status):
        if view.owner:
            owner._context._estate.leave(give_back)
        else:
            owner._given_back(status)

    dtype = TYPES[view.type]
    columns_there = view.components if view.components > 1 else 0
    lease = _view.Lease(view.data or 0, _FORMATS[view.type], dtype.itemsize, view.count, columns_there, view.item_stride,
                        view.component_stride, view.access & _api.WRITE, _RELEASE, ctypes.addressof(view), (owner, view), ended)
    return np.asarray(memoryview(lease))


class Batch:
    """Items that a callback is shown, in arrays (n, components): copies, which may be kept, because the library's memory
    is lent for the time of the call alone. Those that the callback fills are written back when it has returned."""

    #: components of the fields that are arrays, as a function of the batch; tensors are 3 x 3
    _arrays = {}
    _integers = ("id", "index", "component", "other")
    _bytes = ("owned",)

    #: those that the callback fills
    _written = ()

    def __init__(self, pointer, kinds=tuple):
        self._struct = pointer.contents
        self._filled = []
        self._kinds = kinds

    def __getattr__(self, name):
        at = getattr(self._struct, name)
        components = type(self)._arrays.get(name)
        if components is None:
            return at
        array = None
        if at:
            writable = name in self._written
            if components is tensor:
                array = self._raw(at, 9, writable=writable).reshape(3, 3, -1).transpose(2, 0, 1)
            else:
                kind = np.int64 if name in self._integers else np.uint8 if name in self._bytes else np.float64
                array = self._show(at, components(self._struct), kind, writable, components is not scalar)
        self.__dict__[name] = array  # one copy: what is written to a second one would be lost
        return array

    def _raw(self, at, components, dtype=np.float64, writable=False, stride=None):
        """What lies at an address as [components][n]."""
        dtype, n = np.dtype(dtype), self._struct.n
        place = at, components, n * dtype.itemsize, (stride or self._struct.ld) * dtype.itemsize
        copy = _view.copied(*place, writable)
        if writable:
            self._filled.append((copy, *place))
        return np.frombuffer(copy, dtype).reshape(components, n)

    def _show(self, at, components, dtype=np.float64, writable=False, wide=True):
        """The same as (n, components), or (n,) for one that is not wide."""
        array = self._raw(at, components, dtype, writable)
        return array.T if wide else array[0]

    def field(self, name):
        """A field of the set, built in or the host's own, aligned with the batch and with its stored components."""
        kinds = {kinds[name] for kinds in self._kinds() if name in kinds}
        if len(kinds) != 1:
            raise LookupError(f"no set here has a field '{name}'" if not kinds else
                              f"sets of this law have fields '{name}' of different types")
        kind, components = kinds.pop()
        data, stride = ctypes.c_void_p(), ctypes.c_int64()
        status = lib.mpm_batch_field(self._struct.lookup, name.encode(), ctypes.byref(data), ctypes.byref(stride))
        if status:
            raise LookupError(f"the set does not have '{name}' now ({_api.Status(status).name})")
        array = self._raw(data.value, components, TYPES[kind], stride=stride.value)
        return array[0] if components == 1 else array.T

    def _run(self, fn, *outputs):
        """Calls fn with the batch and with arrays (n, ...) of its outputs, (address, dtype, shape)."""
        arrays = []
        for at, dtype, *shape in outputs:
            array = self._raw(at, math.prod(shape), dtype, True).reshape(*shape, self._struct.n)
            arrays.append(np.moveaxis(array, -1, 0))
        try:
            said = fn(self, *arrays)
            for filled in self._filled:
                _view.put_back(*filled)
        finally:
            self.__dict__ = {"_struct": None}  # whoever keeps the batch has nothing to read
        return said


def tensor(_):
    """The components of a full tensor."""
    return 9


def scalar(_):
    return 1


def vector(struct):
    return struct.dim
