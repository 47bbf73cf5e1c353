"""Contexts, and what all handles share: who owns whom, and the end of both."""
import collections
import ctypes
import threading
import warnings
import weakref

from . import _api
from ._guard import Guard
from ._library import Error, documented, error_of, lib


class _Estate:
    """The handles and views of one context that are still to be given up. The garbage collector may end objects in any order,
    on any thread and in callbacks; one that others still need, or that comes while a call is under way, is refused by the
    library, and tried again later. Each is taken out before it is tried, so that two threads never try the same."""

    def __init__(self):
        self.waiting = collections.deque()

    def leave(self, give_up, *what):
        """Calls give_up(*what), now or later, until it returns 0."""
        self.waiting.append((give_up, what))
        self.settle()

    def settle(self):
        some = True
        while some:
            some, refused = False, []
            try:
                while self.waiting:
                    try:
                        item = self.waiting.popleft()
                    except IndexError:  # another thread has taken the last
                        break
                    if item[0](*item[1]) == 0:
                        some = True
                    else:
                        refused.append(item)
            finally:
                self.waiting.extend(refused)


class Handle:
    """An object of the library, which is destroyed when Python has no use for it, or by close()."""

    _destroy = None

    def _own(self, context, address, *needs):
        """Takes the address of a new object; what it needs lives on with it."""
        self._context, self._address, self._needs = context, ctypes.c_void_p(address), needs
        self._end = weakref.finalize(self, context._estate.leave, type(self)._destroy, address)

    @property
    def context(self):
        """The context that this belongs to."""
        return self._context

    @property
    def _as_parameter_(self):
        if not self._end.alive:
            raise ValueError(f"this {type(self).__name__} is closed")
        return self._address

    def close(self):
        """Ends the object now. It is an Error (E_STATE) while others need it; then nothing has happened. At the end of a
        `with` it ends as soon as no other needs it."""
        if not self._end.alive:
            return
        self._context._check(type(self)._destroy(self._address))
        self._end.detach()

    def _given_back(self, status):
        if status:
            text = lib.mpm_last_error(self._context._address).decode()
            warnings.warn(f"MPM_{_api.Status(status).name}: {text}", RuntimeWarning, stacklevel=2)
        return 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._end()


def _put(write, read, where, value, what):
    """Writes a field, and sees that it is there: whole numbers of C wrap around without a word."""
    try:
        write(where, value)
    except TypeError as reason:
        raise TypeError(f"{what} = {value!r}: {reason}") from None
    there = read(where)
    if isinstance(there, int) and there != value:
        raise OverflowError(f"{what} = {value!r} is beyond what its type in C holds")


def fill(struct, options, what):
    """Sets the fields of a descriptor by name; an axis-wise field takes one number for all axes, too."""
    known = {name for name, *_ in struct._fields_} - {"struct_size", "reserved"}
    for name, value in options.items():
        if name not in known:
            raise TypeError(f"{what} has no option '{name}'; it has {', '.join(sorted(known))}")
        there = getattr(struct, name)
        if isinstance(there, ctypes.Array):
            values = list(value) if hasattr(value, "__len__") else [value] * len(there)
            if len(values) > len(there):
                raise TypeError(f"{what}: '{name}' has {len(values)} values where there are {len(there)}")
            for index, one in enumerate(values):
                _put(there.__setitem__, there.__getitem__, index, one, f"{what}: {name}[{index}]")
        else:
            _put(struct.__setattr__, struct.__getattribute__, name, value, f"{what}: {name}")
    return struct


def function(fn):
    """A function of the host, or None for none."""
    if fn is not None and not callable(fn):
        raise TypeError(f"{fn!r} is no function")
    return fn


def descriptor(kind, init, options, what):
    """A descriptor with the library's defaults and the options of a call."""
    struct = kind()
    status = init(ctypes.byref(struct), ctypes.sizeof(struct))
    if status:
        raise Error(status, lib.mpm_status_text(status).decode())
    return fill(struct, options, what)


class Context(Handle):
    """Services of the host: threads, instruction set, log. All objects are made with one, by its methods.

    concurrency, isa: as in mpm_context_desc. serial_callbacks is True here, because Python runs one thread at a time; with
    callbacks that are compiled (mpm.numba) it may be False. log takes (level, text).
    """

    def __init__(self, concurrency=1, isa=_api.ISA_BEST, serial_callbacks=True, log=None):
        self._estate = _Estate()
        self._raised = {}  # what callbacks have raised, by the thread on which they ran
        said = ctypes.create_string_buffer(1024)
        desc = descriptor(_api.context_desc, lib.mpm_context_desc_init,
                          dict(concurrency=concurrency, isa=isa, serial_callbacks=bool(serial_callbacks)), "Context")
        desc.error_text, desc.error_bytes = ctypes.addressof(said), len(said)
        if log is not None:
            def tell(_, level, text):
                log(_api.Log(level), text.decode())

            self._log = desc.log = _api.context_desc_log_fn(Guard(tell, self._raised))
        out = ctypes.c_void_p()
        status = lib.mpm_context_create(ctypes.byref(desc), ctypes.byref(out))
        if status:
            raise error_of(status, said.value.decode())
        self._context, self._address = self, out
        self._end = weakref.finalize(self, self._estate.leave, lib.mpm_context_destroy, out.value)
        self._check(0)  # the log may have raised

    def _taken(self, status):
        """What a callback of this thread's call has raised, if one has. Callbacks may have run on threads of the library."""
        raised = self._raised.pop(threading.get_ident(), None)
        if raised is None and status == _api.E_CALLBACK and self._raised:
            raised = self._raised.popitem()[1]
        return raised

    def _check(self, status):
        """Raises what a callback has raised, or the library's error; returns a status 0."""
        raised = self._taken(status) if self._raised else None
        if raised is None and status:
            raised = error_of(status, lib.mpm_last_error(self._address).decode())
        if self._estate.waiting:
            self._estate.settle()
        if raised is not None:
            raise raised
        return status

    def _callback(self, kind, fn, call, compiler=None):
        """A function of one of the library's types: of None none, fn itself where it is compiled (by that function of
        mpm.numba, or by another tool), else call, which runs fn."""
        if fn is None:
            return kind()
        if not hasattr(fn, "address"):
            return kind(Guard(call if function(fn) else None, self._raised))
        if getattr(fn, "serves", compiler) != compiler:
            raise TypeError(f"a function that mpm.numba.{fn.serves} has compiled is for another callback")
        made = ctypes.cast(fn.address, kind)
        made.compiled = fn  # whose code must not go before
        return made

    def _sink(self, file):
        """A function for the library that hands bytes to file.write()."""

        def take(_, data, count):
            left = memoryview(ctypes.string_at(data, count))
            while left:  # a raw file may write a part, and says how much
                said = file.write(left)
                left = left[len(left) if said is None else said:]

        return _api.write_fn(Guard(take, self._raised))

    def _make(self, destroy, function, *arguments):
        """Calls a function whose last argument is the address of a new object, which destroy() ends."""
        out = ctypes.c_void_p()
        status = function(*arguments, ctypes.byref(out))
        try:
            self._check(status)
        except BaseException:
            if out.value:  # the log has raised
                self._estate.leave(destroy, out.value)
            raise
        return out.value

    @documented("mpm_context_memory")
    def memory(self):
        """Bytes that the context and its objects hold now, and the most that they ever held."""
        now, most = ctypes.c_int64(), ctypes.c_int64()
        self._check(lib.mpm_context_memory(self, ctypes.byref(now), ctypes.byref(most)))
        return now.value, most.value

    def grid(self, **options):
        """A Grid; the options are the fields of mpm_grid_desc."""
        from .grid import Grid
        return Grid(self, **options)

    def material(self, model, **parameters):
        """A Material by the name and the parameters of a built-in law; see mpm.models()."""
        from .material import Material
        return Material(self, model, **parameters)

    def law(self, stress, density, **options):
        """A Material by a law that is written in Python; see mpm.Law."""
        from .material import Law
        return Law(self, stress, density, **options)

    def particles(self, grid, material):
        """An empty set of Particles."""
        from .particles import Particles
        return Particles(self, grid, material)

    def stepper(self, grid, *sets, **options):
        """A Stepper with sets of particles; the options are the fields of mpm_stepper_desc."""
        from .stepper import Stepper
        return Stepper(self, grid, *sets, **options)

    def obstacle(self, shape, **options):
        """An Obstacle; the options are the fields of mpm_obstacle_desc."""
        from .obstacle import Obstacle
        return Obstacle(self, shape, **options)

    def surface(self, grid, **options):
        """A Surface without markers; the options are the fields of mpm_surface_desc."""
        from .surface import Surface
        return Surface(self, grid, **options)

    def series(self, path):
        """A time Series of output files (.pvd)."""
        from .series import Series
        return Series(self, path)


Context._destroy = staticmethod(lib.mpm_context_destroy)

