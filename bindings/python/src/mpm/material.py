"""Materials: laws that are built in, by name, and laws that are written in Python."""
import ctypes
import functools
import weakref

import numpy as np

from . import _api
from ._arrays import Batch, address, doubles, scalar, tensor
from ._handles import Handle, descriptor
from ._library import documented, lib


def models():
    """The built-in laws: a dict of their names, each with a dict of parameters: unit, text, default (None where it must be
    given), low, high; and with a tuple of state variables (name, unit, text) under the key None."""
    out = {}
    for index in range(lib.mpm_material_model_count()):
        model = lib.mpm_material_model_name(index)
        out[model.decode()] = parameters = {}
        texts = [ctypes.c_char_p() for _ in range(3)]
        numbers = [ctypes.c_double() for _ in range(3)]
        at = 0
        while lib.mpm_material_model_param(model, at, *(ctypes.addressof(x) for x in texts),
                                           *(ctypes.addressof(x) for x in numbers)) == 0:
            name, unit, text = (x.value.decode() for x in texts)
            default, low, high = (x.value for x in numbers)
            parameters[name] = {"unit": unit, "text": text, "default": None if default != default else default, "low": low,
                                "high": high}
            at += 1
        states = []
        for at in range(max(lib.mpm_material_state_count(model), 0)):
            lib.mpm_material_state_name(model, at, *(ctypes.addressof(x) for x in texts))
            states.append(tuple(x.value.decode() for x in texts))
        parameters[None] = tuple(states)
    return out


class Response:
    """What Material.update() gives, one row an item: stress (n, 6) as xx yy zz xy yz xz, state (n, k), wave_speed,
    kinematic_viscosity, energy per initial volume, and, where it was asked for, tangent (n, 3, 3, 3, 3) and symmetric."""


class Material(Handle):
    """A constitutive law with its parameters, as the table of mpm_material_create() lists them. Any number of sets share
    it."""

    _destroy = staticmethod(lib.mpm_material_destroy)

    def __init__(self, context, model, **parameters):
        for name, value in parameters.items():
            if isinstance(value, str) or not hasattr(value, "__float__"):
                raise TypeError(f"{model}: {name} = {value!r} is no number")
        named = (_api.param * len(parameters))(*((name.encode(), float(value)) for name, value in parameters.items()))
        self._own(context, context._make(self._destroy, lib.mpm_material_create, context, model.encode(), named, len(named)), context)
        self.model, self.parameters = model, dict(parameters)
        self.state_count = lib.mpm_material_state_count(model.encode())
        self._sets = weakref.WeakSet()

    @documented("mpm_material_update")
    def update(self, F, F_inc, stress=None, state=None, dt=1.0, t=0.0, tangent=False):
        """Runs the law without a grid. F and F_inc are (n, 3, 3) or one (3, 3), stress (n, 6), state (n, state_count);
        stress and state are zeros where they are not given. The result is a Response."""
        F = np.asarray(F, np.float64)
        n = 1 if F.ndim == 2 else len(F)
        order = lambda values: np.ascontiguousarray(np.broadcast_to(values, (n, 3, 3)).reshape(n, 9).T, np.float64)
        F, F_inc = order(F), order(np.asarray(F_inc, np.float64))
        flat = lambda values, k: np.zeros((k, n)) if values is None else \
            np.ascontiguousarray(doubles(np.broadcast_to(values, (n, k)), n, k).T)
        stress, state = flat(stress, 6), flat(state, self.state_count)
        new_stress, new_state = np.zeros_like(stress), np.zeros_like(state)
        speed, viscosity, energy = np.zeros(n), np.zeros(n), np.full(n, np.nan)
        c = np.zeros((81, n)) if tangent else None
        symmetric = ctypes.c_int32()
        batch = _api.material_batch(struct_size=ctypes.sizeof(_api.material_batch), state_count=self.state_count, n=n, ld=n,
                                    t=t, dt=dt)
        for name, array in dict(F=F, F_inc=F_inc, stress=stress, state=state, stress_new=new_stress, state_new=new_state,
                                wave_speed=speed, kinematic_viscosity=viscosity, energy=energy).items():
            setattr(batch, name, address(array) if array.size else None)
        self._context._check(lib.mpm_material_update(self, ctypes.byref(batch), address(c), ctypes.byref(symmetric)))
        out = Response()
        out.stress, out.state = new_stress.T, new_state.T
        out.wave_speed, out.kinematic_viscosity, out.energy = speed, viscosity, energy
        if tangent:
            out.tangent = c.reshape(3, 3, 3, 3, n).transpose(4, 0, 1, 2, 3)
            out.symmetric = bool(symmetric.value)
        return out


class MaterialBatch(Batch):
    """Particles that a law is asked about: n, dt, t, id (< 0: an inert slot), F, F_inc and L (n, 3, 3), stress (n, 6),
    state (n, state_count), position (n, dim). To be filled: stress_new, state_new, wave_speed, and where the law has them
    kinematic_viscosity and energy."""

    _arrays = {"id": scalar, "F": tensor, "F_inc": tensor, "L": tensor, "stress": lambda s: 6, "stress_new": lambda s: 6,
               "state": lambda s: s.state_count, "state_new": lambda s: s.state_count, "wave_speed": scalar,
               "kinematic_viscosity": scalar, "energy": scalar}
    _written = ("stress_new", "state_new", "wave_speed", "kinematic_viscosity", "energy")

    @functools.cached_property
    def state(self):
        return self._states("state", False)

    @functools.cached_property
    def state_new(self):
        return self._states("state_new", True)

    def _states(self, name, writable):
        if not self._struct.state_count:
            raise LookupError("the law has no state variables")
        return self._show(getattr(self._struct, name), self._struct.state_count, writable=writable)

    @functools.cached_property
    def position(self):
        """Positions at the start of the step, (n, dim)."""
        dims = {kinds["position"][1] for kinds in self._kinds()} or {3}
        if len(dims) != 1:
            raise LookupError("sets of this law have different dimensions")
        return self._show(self._struct.position, dims.pop()) if self._struct.position else None


class Law(Material):
    """A law that is written in Python, or compiled.

    stress(batch) fills batch.stress_new, batch.state_new and batch.wave_speed from a MaterialBatch; it may return 1 to ask
    for a smaller dt. tangent(batch, c), for implicit steps, fills c, which is (n, 3, 3, 3, 3), or (n, 6, 6) with
    tangent_form = TANGENT_MINOR_SYMMETRIC, and returns whether it has major symmetry; without it stresses are differenced.
    state_initial has the state of a new particle. Functions of mpm.numba run without Python in the way.
    """

    def __init__(self, context, stress, density, tangent=None, state_count=0, state_initial=None,
                 tangent_form=_api.TANGENT_GENERAL):
        self._sets = weakref.WeakSet()
        initial = None if state_initial is None else np.ascontiguousarray(state_initial, np.float64).ravel()
        if initial is not None:
            state_count = state_count or len(initial)
            initial = doubles(initial, state_count)
        desc = descriptor(_api.material_desc, lib.mpm_material_desc_init,
                          dict(density=density, state_count=state_count, tangent_form=tangent_form), "Law")
        kinds = weakref.WeakMethod(self._kinds)
        shape = (3, 3, 3, 3) if tangent_form == _api.TANGENT_GENERAL else (6, 6)

        def find_stress(_, batch):
            return MaterialBatch(batch, kinds())._run(stress)

        def find_tangent(_, batch, c, symmetric):
            answer = MaterialBatch(batch, kinds())._run(tangent, (c, np.float64, *shape))
            ctypes.c_int32.from_address(symmetric).value = bool(answer)

        self._callbacks = (context._callback(_api.stress_fn, stress, find_stress, "stress"),
                           context._callback(_api.tangent_fn, tangent, find_tangent))
        desc.stress, desc.tangent = self._callbacks
        desc.state_initial = address(initial)
        made = context._make(self._destroy, lib.mpm_material_create_custom, context, ctypes.byref(desc))
        self._own(context, made, context)
        self.model, self.parameters, self.state_count = None, {"density": density}, state_count

    def _kinds(self):
        return [one._kinds for one in self._sets]
