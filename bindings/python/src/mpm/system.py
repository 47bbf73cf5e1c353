"""The linear system of an implicit step, for solvers of the host."""
import ctypes

import numpy as np

from . import _api
from ._arrays import address
from ._library import error_of, lib


class System:
    """The linear system of an implicit step, for the time of a solve: matrix (indptr, indices, data), symmetric,
    positive_definite, block, node (rows,), component (rows,), position (rows, dim), apply(x)."""

    def __init__(self, operator, dim):
        self._operator = operator
        info = _api.operator_info(struct_size=ctypes.sizeof(_api.operator_info))
        _refuse(lib.mpm_operator_get_info(operator, ctypes.byref(info)))
        self.rows, self.block, self.pattern_id = info.rows, info.block, info.pattern_id
        self.symmetric, self.positive_definite = bool(info.symmetric), bool(info.positive_definite)
        copy = lambda at, kind, n: np.array((kind * n).from_address(at)) if n else np.empty(0, kind)
        self.node = copy(info.node, ctypes.c_int64, info.rows)
        self.component = copy(info.component, ctypes.c_int32, info.rows)
        self.position = copy(info.position, ctypes.c_double, dim * info.ld).reshape(dim, info.ld)[:, :info.rows].T

    def apply(self, x):
        """The matrix times a vector."""
        x, y = np.ascontiguousarray(x, np.float64), np.empty(self.rows)
        if x.shape != (self.rows,):
            raise ValueError(f"x of shape {x.shape} where {(self.rows,)} is wanted")
        _refuse(lib.mpm_operator_apply(self._operator, address(x), address(y)))
        return y

    @property
    def matrix(self):
        """The matrix by compressed rows, as copies (indptr, indices, data): what scipy.sparse.csr_matrix takes in the order
        (data, indices, indptr)."""
        start, column, value = (ctypes.c_void_p() for _ in range(3))
        _refuse(lib.mpm_operator_csr(self._operator, *(ctypes.addressof(x) for x in (start, column, value))))
        indptr = np.array((ctypes.c_int64 * (self.rows + 1)).from_address(start.value))
        count = int(indptr[-1])
        return (indptr, np.array((ctypes.c_int32 * count).from_address(column.value)),
                np.array((ctypes.c_double * count).from_address(value.value)))


def _refuse(status):
    if status:
        raise error_of(status, lib.mpm_status_text(status).decode())
