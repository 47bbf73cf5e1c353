"""Time series of output files."""
import os

from ._handles import Handle
from ._library import documented, lib


class Series(Handle):
    """A time series of output files (.pvd) for ParaView; its file is valid after every append."""

    _destroy = staticmethod(lib.mpm_series_close)

    def __init__(self, context, path):
        self._own(context, context._make(self._destroy, lib.mpm_series_open, context, os.fsencode(path)), context)

    @documented("mpm_series_append")
    def append(self, t, file):
        """Appends an output file at a time; its path is relative to the series' own file."""
        self._context._check(lib.mpm_series_append(self, t, os.fsencode(file)))
