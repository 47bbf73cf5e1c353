"""Grids."""
import ctypes

from . import _api
from ._handles import Handle, descriptor
from ._library import lib


class Grid(Handle):
    """The background grid: a box of equal cells with a basis. The options are the fields of mpm_grid_desc: dim, cells,
    spacing, origin, basis, boundary_basis, periodic, smoothing; one number stands for all axes."""

    _destroy = staticmethod(lib.mpm_grid_destroy)

    def __init__(self, context, **options):
        desc = descriptor(_api.grid_desc, lib.mpm_grid_desc_init, options, "Grid")
        self._own(context, context._make(self._destroy, lib.mpm_grid_create, context, ctypes.byref(desc)), context)
        self.dim = desc.dim
        self.basis = _api.Basis(desc.basis)
        self.cells = tuple(desc.cells)[:desc.dim]
        self.spacing = tuple(desc.spacing)[:desc.dim]
        self.origin = tuple(desc.origin)[:desc.dim]
        self.periodic = tuple(bool(p) for p in desc.periodic)[:desc.dim]
