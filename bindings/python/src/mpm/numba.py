"""Callbacks that numba compiles: they run at the speed of C, on several threads at once where the context permits it.

    @mpm.numba.particles
    def pull(batch, add):
        for i in range(batch.n):
            add[i, 1] -= batch.mass[i] * 0.05 * batch.position[i, 0]

    stepper.set_force(pull)

The functions take what their counterparts in Python take, in nopython mode: arrays of shape (n, components) by name. An
exception ends the step with E_CALLBACK; what it says is lost. Fields of the host are not reached from here.
"""
import collections

import numba
from numba import types
from numba.extending import intrinsic

from . import _api

ParticleItems = collections.namedtuple("ParticleItems", "n dim t dt id position reference_position velocity mass volume")
NodeItems = collections.namedtuple("NodeItems", "n dim body t dt index position mass owned")
MaterialItems = collections.namedtuple(
    "MaterialItems", "n t dt id F F_inc L stress state stress_new state_new wave_speed kinematic_viscosity energy")


def _pointer_to(kind):
    @intrinsic
    def cast(_, address):
        def make(context, builder, signature, arguments):
            return builder.inttoptr(arguments[0], context.get_value_type(signature.return_type))

        return types.CPointer(kind)(types.intp), make

    return cast


_doubles, _integers, _bytes, _words = (_pointer_to(kind) for kind in (types.float64, types.int64, types.uint8, types.int32))


def _readers(struct):
    """Functions that read the fields of a batch at its address."""
    at = {name: getattr(struct, name).offset for name, *_ in struct._fields_}

    def reader(cast):
        def read(name):
            offset = at[name]
            return numba.njit(lambda batch: numba.carray(cast(batch + offset), 1)[0])

        return read

    return reader(_words), reader(_integers), reader(_doubles)


@numba.njit
def _rows(at, components, n, ld):
    return numba.carray(_doubles(at), (components if at else 0, ld))[:, :n].T


@numba.njit
def _column(at, n):
    return numba.carray(_doubles(at), n if at else 0)


@numba.njit
def _tensors(at, n, ld):
    return numba.carray(_doubles(at), (3, 3, ld))[:, :, :n].transpose((2, 0, 1))


@numba.njit
def _numbers(at, n):
    return numba.carray(_integers(at), n)


@numba.njit
def _number_rows(at, components, n, ld):
    return numba.carray(_integers(at), (components, ld))[:, :n].T


@numba.njit
def _byte_rows(at, components, n, ld):
    return numba.carray(_bytes(at), (components, ld))[:, :n].T


def _particle_reader():
    word, integer, double = _readers(_api.particle_batch)
    dim, n, ld, t, dt, id_, position, reference, velocity, mass, volume = (
        word("dim"), integer("n"), integer("ld"), double("t"), double("dt"), integer("id"), integer("position"),
        integer("reference_position"), integer("velocity"), integer("mass"), integer("volume"))

    @numba.njit
    def read(batch):
        d, k, stride = dim(batch), n(batch), ld(batch)
        return ParticleItems(k, d, t(batch), dt(batch), _numbers(id_(batch), k), _rows(position(batch), d, k, stride),
                             _rows(reference(batch), d, k, stride), _rows(velocity(batch), d, k, stride),
                             _column(mass(batch), k), _column(volume(batch), k))

    return read, ld


def _node_reader():
    word, integer, double = _readers(_api.node_batch)
    dim, body, n, ld, t, dt, index, position, mass, owned = (
        word("dim"), word("body"), integer("n"), integer("ld"), double("t"), double("dt"), integer("index"),
        integer("position"), integer("mass"), integer("owned"))

    @numba.njit
    def read(batch):
        d, k, stride = dim(batch), n(batch), ld(batch)
        return NodeItems(k, d, body(batch), t(batch), dt(batch), _number_rows(index(batch), d, k, stride),
                         _rows(position(batch), d, k, stride), _column(mass(batch), k),
                         _byte_rows(owned(batch), 1, k, k)[:, 0])

    return read, ld


def _material_reader():
    word, integer, double = _readers(_api.material_batch)
    states, n, ld, t, dt = word("state_count"), integer("n"), integer("ld"), double("t"), double("dt")
    id_, F, F_inc, L, stress, state, stress_new, state_new, speed, viscosity, energy = (
        integer(name) for name in ("id", "F", "F_inc", "L", "stress", "state", "stress_new", "state_new", "wave_speed",
                                   "kinematic_viscosity", "energy"))

    @numba.njit
    def read(batch):
        k, stride, count = n(batch), ld(batch), states(batch)
        return MaterialItems(k, t(batch), dt(batch), _numbers(id_(batch), k), _tensors(F(batch), k, stride),
                             _tensors(F_inc(batch), k, stride), _tensors(L(batch), k, stride),
                             _rows(stress(batch), 6, k, stride), _rows(state(batch), count, k, stride),
                             _rows(stress_new(batch), 6, k, stride), _rows(state_new(batch), count, k, stride),
                             _column(speed(batch), k), _column(viscosity(batch), k), _column(energy(batch), k))

    return read, ld


_POINTERS = {count: types.int32(*(types.intp,) * count) for count in (2, 3, 4)}


@numba.njit
def _status(said):
    if said is None:
        return 0
    return said


def particles(fn):
    """Compiles fn(batch, add) for set_force, set_acceleration and set_motion."""
    inner, (read, ld) = numba.njit(fn), _particle_reader()

    @numba.cfunc(_POINTERS[3])
    def call(user, batch, add):
        try:
            items = read(batch)
            return _status(inner(items, _rows(add, items.dim, items.n, ld(batch))))
        except Exception:
            return -1

    call.serves = "particles"
    return call


def velocity_bc(fn):
    """Compiles fn(batch, prescribed, velocity) for set_velocity_bc."""
    inner, (read, ld) = numba.njit(fn), _node_reader()

    @numba.cfunc(_POINTERS[4])
    def call(user, batch, prescribed, velocity):
        try:
            items = read(batch)
            stride = ld(batch)
            return _status(inner(items, _byte_rows(prescribed, items.dim, items.n, stride),
                                 _rows(velocity, items.dim, items.n, stride)))
        except Exception:
            return -1

    call.serves = "velocity_bc"
    return call


def node_hook(fn):
    """Compiles fn(batch, velocity, force) for set_node_hook."""
    inner, (read, ld) = numba.njit(fn), _node_reader()

    @numba.cfunc(_POINTERS[4])
    def call(user, batch, velocity, force):
        try:
            items = read(batch)
            stride = ld(batch)
            return _status(inner(items, _rows(velocity, items.dim, items.n, stride), _rows(force, items.dim, items.n, stride)))
        except Exception:
            return -1

    call.serves = "node_hook"
    return call


def stress(fn):
    """Compiles fn(batch), a law, for Context.law()."""
    inner, (read, _) = numba.njit(fn), _material_reader()

    @numba.cfunc(_POINTERS[2])
    def call(user, batch):
        try:
            return _status(inner(read(batch)))
        except Exception:
            return -1

    call.serves = "stress"
    return call
