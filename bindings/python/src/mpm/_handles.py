"""Contexts, and what all handles share: who owns whom, and the end of both."""
import ctypes
import warnings
import weakref

from . import _api
from ._library import Error, documented, error_of, lib


class _Estate:
    """The handles of one context that are still to be destroyed. The garbage collector may end objects in any order; one
    that others still need is refused by the library, and tried again when they are gone."""

    def __init__(self):
        self.waiting = []

    def leave(self, destroy, address):
        self.waiting.append((destroy, address))
        self.settle()

    def settle(self):
        some = True
        while some and self.waiting:
            some = False
            for item in list(self.waiting):
                if item in self.waiting and item[0](item[1]) == 0:
                    self.waiting.remove(item)
                    some = True


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
        """Ends the object now. It is an Error (E_STATE) while others need it; then nothing has happened."""
        if not self._end.alive:
            return
        self._context._check(type(self)._destroy(self._address))
        self._end.detach()

    def _given_back(self, status):
        if status:
            text = lib.mpm_last_error(self._context._address).decode()
            warnings.warn(f"MPM_{_api.Status(status).name}: {text}", RuntimeWarning, stacklevel=2)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


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
                there[index] = one
        else:
            setattr(struct, name, value)
    return struct


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
        self._raised = None
        said = ctypes.create_string_buffer(1024)
        desc = descriptor(_api.context_desc, lib.mpm_context_desc_init,
                          dict(concurrency=concurrency, isa=isa, serial_callbacks=bool(serial_callbacks)), "Context")
        desc.error_text, desc.error_bytes = ctypes.addressof(said), len(said)
        self._log = log and _api.context_desc_log_fn(lambda user, level, text: self._tell(log, level, text))
        if self._log:
            desc.log = self._log
        out = ctypes.c_void_p()
        status = lib.mpm_context_create(ctypes.byref(desc), ctypes.byref(out))
        if status:
            raise error_of(status, said.value.decode())
        self._context, self._address = self, out
        self._end = weakref.finalize(self, self._estate.leave, lib.mpm_context_destroy, out.value)

    def _tell(self, log, level, text):
        try:
            log(_api.Log(level), text.decode())
        except BaseException as raised:  # it comes out of the call that is under way, when that ends
            self._raised = self._raised or raised

    def _check(self, status):
        """Raises what a callback has raised, or the library's error; returns a status 0."""
        raised, self._raised = self._raised, None
        if raised is not None:
            raise raised
        if status:
            raise error_of(status, lib.mpm_last_error(self._address).decode())
        if self._estate.waiting:
            self._estate.settle()
        return status

    def _guard(self, callback):
        """A function for the library that calls one of Python's: exceptions wait until the library's call has ended."""

        def call(*arguments):
            try:
                said = callback(*arguments)
                return 0 if said is None else int(said)
            except BaseException as raised:  # also KeyboardInterrupt
                self._raised = self._raised or raised
                return -1

        return call

    def _callback(self, kind, fn, call):
        """A function of one of the library's types: of None none, fn itself where it is compiled (mpm.numba), else call,
        which runs fn."""
        if fn is None:
            return kind()
        if not hasattr(fn, "address"):
            return kind(self._guard(call))
        made = ctypes.cast(fn.address, kind)
        made.compiled = fn  # whose code must not go before
        return made

    def _sink(self, file):
        """A function for the library that hands bytes to file.write()."""

        def take(_, data, count):
            file.write(ctypes.string_at(data, count))

        return _api.write_fn(self._guard(take))

    def _make(self, function, *arguments):
        """Calls a function whose last argument is the address of a new object."""
        out = ctypes.c_void_p()
        self._check(function(*arguments, ctypes.byref(out)))
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

