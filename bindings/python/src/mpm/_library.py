"""The shared library: where it is found, its functions with prototypes, and what a status becomes in Python."""
import ctypes
import ctypes.util
import os
import re

from . import _api
from ._api import Status


def _candidates():
    chosen = os.environ.get("MPM_LIBRARY")
    if chosen:
        yield chosen
        return
    here = os.path.dirname(os.path.abspath(__file__))
    for name in ("libmpm.so.0", "libmpm.0.dylib", "libmpm.dylib", "mpm.dll", "libmpm.dll"):
        if os.path.exists(os.path.join(here, name)):
            yield os.path.join(here, name)
    yield "libmpm.so.0"
    found = ctypes.util.find_library("mpm")
    if found:
        yield found


def _load():
    tried = []
    for name in _candidates():
        try:
            return ctypes.CDLL(name)
        except OSError as reason:
            tried.append(str(reason))
    raise ImportError("the shared library of libmpm is not found: install it, or let MPM_LIBRARY be its path; tried: "
                      + "; ".join(tried))


def _bounded(kind):
    """An integer of C as an argument: ctypes would let numbers beyond it wrap around."""

    def from_param(cls, value):
        made = kind(value)
        if made.value != value:
            raise OverflowError(f"{value} is beyond an integer of {ctypes.sizeof(kind)} bytes")
        return made

    return type("Bounded", (kind,), {"from_param": classmethod(from_param)})


_INTEGERS = {kind: _bounded(kind) for kind in (ctypes.c_int32, ctypes.c_uint32, ctypes.c_int64, ctypes.c_uint64)}


#: The library as ctypes sees it, with the prototypes of all functions that this version has.
lib = _load()
for _name, (_result, _arguments) in _api.FUNCTIONS.items():
    try:
        _function = getattr(lib, _name)
    except AttributeError:
        continue
    _function.restype, _function.argtypes = _result, [_INTEGERS.get(kind, kind) for kind in _arguments]
    _function.__doc__ = _api.DOCS[_name]


class Error(Exception):
    """A call that the library refused or could not do. `status` is a Status, the text the library's sentence."""

    def __init__(self, status, text):
        try:
            status = Status(status)
            name = "MPM_" + status.name
        except ValueError:
            name = f"status {status}"
        super().__init__(f"{name}: {text}" if text else name)
        self.status = status
        self.text = text

    def __reduce__(self):
        return type(self), (self.status, self.text), self.__dict__


class StepError(Error):
    """A step that was not done; the state is as it was before it. Of `status` CUT_DT to SINGULAR a smaller dt may help.
    `info` is the StepInfo of the try, where there is one."""

    info = None

    @property
    def smaller_dt_may_do(self):
        return Status.CUT_DT <= self.status <= Status.SINGULAR


def error_of(status, text):
    return (StepError if status > 0 else Error)(status, text)


def documented(name):
    """Adds what the headers say about a function to the text of a method."""

    def add(method):
        method.__doc__ = (method.__doc__ or "").rstrip() + "\n\n" + re.sub("(?m)^", "        ", _api.DOCS[name])
        return method

    return add


def version():
    """The version of the library that runs, as a text."""
    number = lib.mpm_version()
    return f"{number >> 16}.{number >> 8 & 255}.{number & 255}"
