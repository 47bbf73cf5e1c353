"""The time loop: steps, walls, forces and other callbacks, contact, saved states."""
import ctypes
import os

import numpy as np

from . import _api
from ._arrays import address, lend
from ._guard import Guard
from ._handles import Handle, descriptor, fill, function
from ._library import documented, lib
from .batches import AdaptionBatch, ContactBatch, NodeBatch, ParticleBatch
from .obstacle import Obstacle, contact_desc
from .surface import Surface
from .system import System

_VECTORS = ("momentum", "angular_momentum", "force", "torque", "impulse")


class StepInfo:
    """What a step did, or the state as it is: the fields of mpm_step_info as attributes; vectors are arrays."""

    def __init__(self, struct):
        self._struct = struct

    def __getattr__(self, name):
        if name == "_struct":  # not there yet: a copy is being made
            raise AttributeError(name)
        value = getattr(self._struct, name)
        return np.array(value) if name in _VECTORS else value

    def __dir__(self):
        return [name for name, *_ in self._struct._fields_ if name not in ("struct_size", "reserved")]

    def __repr__(self):
        return f"<StepInfo step={self.step} t={self.t:g} kinetic_energy={self.kinetic_energy:g} strain_energy={self.strain_energy:g}>"


class Stepper(Handle):
    """A time loop over sets of particles on a grid. The options are the fields of mpm_stepper_desc: scheme, transfer, flip,
    gravity, locking_remedy and so on."""

    _destroy = staticmethod(lib.mpm_stepper_destroy)

    def __init__(self, context, grid, *sets, **options):
        self._options = descriptor(_api.stepper_desc, lib.mpm_stepper_desc_init, options, "Stepper")
        made = context._make(self._destroy, lib.mpm_stepper_create, context, grid, ctypes.byref(self._options))
        self._callbacks, self._held, self._adapting, self._heated = {}, {}, {}, {}
        self._own(context, made, context, grid)
        self.grid, self.dim, self._sets, self._obstacles = grid, grid.dim, [], []
        self._surfaces = []
        self.set_progress(None)
        self.add(*sets)

    # ---- what takes part ----

    @property
    def sets(self):
        """The sets of particles, in order of adding."""
        return tuple(self._sets)

    @property
    def obstacles(self):
        """The obstacles, in order of adding."""
        return tuple(self._obstacles)

    @property
    def surfaces(self):
        """The surfaces, in order of adding."""
        return tuple(self._surfaces)

    def _place(self, thing):
        """What adds and removes things of a kind, and the list of those that are here."""
        if isinstance(thing, Obstacle):
            return lib.mpm_stepper_add_obstacle, lib.mpm_stepper_remove_obstacle, self._obstacles
        if isinstance(thing, Surface):
            return lib.mpm_stepper_add_surface, lib.mpm_stepper_remove_surface, self._surfaces
        return lib.mpm_stepper_add, lib.mpm_stepper_remove, self._sets

    def add(self, *things):
        """Adds sets of particles, obstacles and surfaces; returns the stepper."""
        for one in things:
            add, _, there = self._place(one)
            self._context._check(add(self, one))
            there.append(one)
        return self

    def remove(self, thing):
        """Takes a set, an obstacle or a surface out."""
        _, remove, there = self._place(thing)
        self._context._check(remove(self, thing))
        there.remove(thing)
        for kept in (self._held, self._adapting, self._heated):
            kept.pop(id(thing), None)

    @documented("mpm_stepper_configure")
    def configure(self, **options):
        """Changes options between steps; those that are not named stay."""
        desc = _api.stepper_desc.from_buffer_copy(self._options)
        fill(desc, options, "Stepper")
        self._context._check(lib.mpm_stepper_configure(self, ctypes.byref(desc)))
        self._options = desc

    def option(self, name):
        """The present value of an option."""
        value = getattr(self._options, name)
        return tuple(value) if isinstance(value, ctypes.Array) else value

    @documented("mpm_stepper_set_wall")
    def wall(self, face, kind, friction=0.0):
        """Sets what a face of the grid does; returns the stepper."""
        self._context._check(lib.mpm_stepper_set_wall(self, face, kind, friction))
        return self

    @documented("mpm_stepper_set_body")
    def set_body(self, particles, body):
        """Puts a set into a body, which has a velocity field of its own."""
        self._context._check(lib.mpm_stepper_set_body(self, particles, body))

    def body(self, particles):
        """The body of a set."""
        out = ctypes.c_int32()
        self._context._check(lib.mpm_stepper_body(self, particles, ctypes.addressof(out)))
        return out.value

    @documented("mpm_stepper_set_contact")
    def set_contact(self, body_a=_api.BODY_ANY, body_b=_api.BODY_ANY, **options):
        """Sets how two bodies meet, by the fields of mpm_contact_desc: friction, friction_static, kind, normal ..."""
        desc = contact_desc(options)
        self._context._check(lib.mpm_stepper_set_contact(self, body_a, body_b, ctypes.byref(desc)))

    @documented("mpm_stepper_contact_info")
    def contact_info(self, body_a, body_b):
        """What two bodies did to each other in the last step."""
        info = _api.contact_info(struct_size=ctypes.sizeof(_api.contact_info))
        self._context._check(lib.mpm_stepper_contact_info(self, body_a, body_b, ctypes.byref(info)))
        return info

    # ---- adaption ----

    @documented("mpm_stepper_set_adaption")
    def set_adaption(self, particles, accept=None, **options):
        """Describes how a set adapts, by the fields of mpm_adaption_desc: split_edge, min_per_cell, max_per_cell, every ...;
        without any it adapts no longer. accept(batch, accept) writes 0 for what an AdaptionBatch is to leave as it is."""

        def call(_, batch, accept_):
            return AdaptionBatch(batch)._run(accept, (accept_, np.uint8))

        made = self._context._callback(_api.adaption_fn, accept, call)
        desc = descriptor(_api.adaption_desc, lib.mpm_adaption_desc_init, options, "adaption")
        if accept is not None:
            desc.accept = made
        self._context._check(lib.mpm_stepper_set_adaption(self, particles, ctypes.byref(desc) if options else None))
        self._adapting[id(particles)] = (particles, made)

    @documented("mpm_stepper_adapt")
    def adapt(self):
        """Adapts all sets that are described, now."""
        self._context._check(lib.mpm_stepper_adapt(self))

    @documented("mpm_stepper_adaption_info")
    def adaption_info(self, particles):
        """What adaption has done to a set."""
        info = _api.adaption_info(struct_size=ctypes.sizeof(_api.adaption_info))
        self._context._check(lib.mpm_stepper_adaption_info(self, particles, ctypes.byref(info)))
        return info

    # ---- heat ----

    @documented("mpm_stepper_set_heat")
    def set_heat(self, particles, source=None, **options):
        """Describes the heat of a set, by the fields of mpm_heat_desc: specific_heat, conductivity, expansion ...; without
        any it has none any more. source(batch, power) writes power per volume of a ParticleBatch to power (n,)."""

        def call(_, batch, power):
            return self._shown(batch)._run(source, (power, np.float64))

        made = self._context._callback(_api.heat_fn, source, call)
        desc = descriptor(_api.heat_desc, lib.mpm_heat_desc_init, options, "heat")
        if source is not None:
            desc.source = made
        self._context._check(lib.mpm_stepper_set_heat(self, particles, ctypes.byref(desc) if options else None))
        self._heated[id(particles)] = (particles, made)
        particles._look()

    @documented("mpm_stepper_set_conduction")
    def set_conduction(self, conduction, tolerance=1e-9):
        """CONDUCTION_EXPLICIT or CONDUCTION_IMPLICIT, with the tolerance of its solver."""
        self._context._check(lib.mpm_stepper_set_conduction(self, conduction, tolerance))

    @documented("mpm_stepper_set_heat_wall")
    def set_heat_wall(self, face, kind, temperature=0.0):
        """HEAT_WALL_INSULATED or HEAT_WALL_TEMPERATURE for a face."""
        self._context._check(lib.mpm_stepper_set_heat_wall(self, face, kind, temperature))

    @documented("mpm_stepper_heat_info")
    def heat_info(self):
        """Where heat came from."""
        info = _api.heat_info(struct_size=ctypes.sizeof(_api.heat_info))
        self._context._check(lib.mpm_stepper_heat_info(self, ctypes.byref(info)))
        return info

    @documented("mpm_stepper_set_balance")
    def set_balance(self, **options):
        """Sets how blocks are given to parts, by the fields of mpm_balance_desc: measure, limit, block_weight."""
        desc = descriptor(_api.balance_desc, lib.mpm_balance_desc_init, options, "balance")
        self._context._check(lib.mpm_stepper_set_balance(self, ctypes.byref(desc)))

    @documented("mpm_stepper_parallel_info")
    def parallel_info(self, reset=False):
        """What this part does of a problem in several, and what that costs."""
        info = _api.parallel_info(struct_size=ctypes.sizeof(_api.parallel_info))
        self._context._check(lib.mpm_stepper_parallel_info(self, reset, ctypes.byref(info)))
        return info

    # ---- callbacks ----

    def _shown(self, batch):
        at = batch.contents.particles
        one = next(one for one in self._sets if one._address.value == at)
        shown = ParticleBatch(batch, lambda: [one._kinds])
        shown.particles = one
        return shown

    def _particle_callback(self, fn):
        def call(_, batch, add):
            return self._shown(batch)._run(fn, (add, np.float64, self.dim))

        return self._context._callback(_api.particle_fn, fn, call, "particles")

    def _set(self, key, setter, made, *before):
        """Sets a callback, and keeps it alive as long as the library may call it."""
        self._context._check(setter(self, *before, made, None))
        self._callbacks[key] = made

    @documented("mpm_stepper_set_force")
    def set_force(self, fn):
        """fn(batch, add) adds forces on the particles of a ParticleBatch to add (n, dim). It may return 1 to ask for a
        smaller dt. A function of mpm.numba runs without Python in the way; None takes it away."""
        self._set("force", lib.mpm_stepper_set_force, self._particle_callback(fn))

    @documented("mpm_stepper_set_acceleration")
    def set_acceleration(self, fn):
        """fn(batch, add) adds accelerations of the particles of a ParticleBatch to add (n, dim)."""
        self._set("acceleration", lib.mpm_stepper_set_acceleration, self._particle_callback(fn))

    @documented("mpm_stepper_set_motion")
    def set_motion(self, particles, fn):
        """fn(batch, add) adds the mean velocities of the coming step for the prescribed particles of a set."""
        made = self._particle_callback(fn)
        self._context._check(lib.mpm_stepper_set_motion(self, particles, made, None))
        self._held[id(particles)] = (particles, made)

    @documented("mpm_stepper_set_velocity_bc")
    def set_velocity_bc(self, fn):
        """fn(batch, prescribed, velocity) prescribes velocities of the nodes of a NodeBatch: it sets prescribed (n, dim) to
        1 and velocity (n, dim)."""

        def call(_, batch, prescribed, velocity):
            return NodeBatch(batch)._run(fn, (prescribed, np.uint8, self.dim), (velocity, np.float64, self.dim))

        self._set("velocity_bc", lib.mpm_stepper_set_velocity_bc, self._context._callback(_api.velocity_fn, fn, call, "velocity_bc"))

    @documented("mpm_stepper_set_node_hook")
    def set_node_hook(self, stage, fn):
        """fn(batch, velocity, force) reads and changes velocity and force (n, dim) of the nodes at a stage: AFTER_P2G,
        AFTER_FORCES or AFTER_VELOCITY."""

        def call(_, batch, velocity, force):
            return NodeBatch(batch)._run(fn, (velocity, np.float64, self.dim), (force, np.float64, self.dim))

        made = self._context._callback(_api.node_fn, fn, call, "node_hook")
        self._set(("hook", int(stage)), lib.mpm_stepper_set_node_hook, made, stage)

    @documented("mpm_stepper_set_friction")
    def set_friction(self, fn):
        """fn(batch, friction) changes the coefficients of friction (n,) at the nodes of a ContactBatch."""

        def call(_, batch, friction):
            return ContactBatch(batch)._run(fn, (friction, np.float64))

        self._set("friction", lib.mpm_stepper_set_friction, self._context._callback(_api.friction_fn, fn, call))

    @documented("mpm_stepper_set_linear_solver")
    def set_linear_solver(self, fn):
        """fn(system, rhs, guess, tolerance) solves an implicit step's System: it returns the solution, or (solution,
        iterations), or None if it has none. For linear_solver = SOLVER_HOST."""

        def call(_, operator, rhs, solution, tolerance, iterations):
            system = System(operator, self.dim)
            vector_at = lambda at: np.ctypeslib.as_array((ctypes.c_double * system.rows).from_address(at))
            try:
                said = fn(system, vector_at(rhs).copy(), vector_at(solution).copy(), tolerance)
            finally:
                system._operator = None  # it is gone; the library refuses calls on none
            if said is None:
                return 1
            answer, count = said if isinstance(said, tuple) else (said, 1)
            vector_at(solution)[:] = answer
            ctypes.c_int64.from_address(iterations).value = int(count)
            return 0

        self._set("solver", lib.mpm_stepper_set_linear_solver, self._context._callback(_api.solve_fn, fn, call))

    @documented("mpm_stepper_set_progress")
    def set_progress(self, fn):
        """fn(info) watches steps; True ends the call. Without one Python still looks for signals in every step, so that
        Ctrl-C ends a long call with the state of the last committed step."""

        def call(_, info):
            return 1 if fn(StepInfo(_api.step_info.from_buffer_copy(info.contents))) else 0

        watch = Guard(call if function(fn) else None, self._context._raised)
        self._set("progress", lib.mpm_stepper_set_progress, _api.progress_fn(watch))

    # ---- steps ----

    def _info(self):
        return _api.step_info(struct_size=ctypes.sizeof(_api.step_info))

    def _ended(self, status, info):
        try:
            self._context._check(status)
        except Exception as error:
            if hasattr(error, "info"):
                error.info = StepInfo(info)
            raise
        return StepInfo(info)

    @documented("mpm_step")
    def step(self, dt):
        """Makes one step; returns its StepInfo. A StepError has left the state as it was."""
        info = self._info()
        return self._ended(lib.mpm_step(self, dt, ctypes.byref(info)), info)

    @documented("mpm_advance")
    def advance(self, t_end, **options):
        """Steps to a time; the options are the fields of mpm_advance_desc: cfl, dt_max, max_steps ... Returns the StepInfo
        of the last step."""
        desc = descriptor(_api.advance_desc, lib.mpm_advance_desc_init, dict(options, t_end=t_end), "advance")
        info = self._info()
        return self._ended(lib.mpm_advance(self, ctypes.byref(desc), ctypes.byref(info)), info)

    @property
    def info(self):
        """The StepInfo of the state as it is."""
        info = self._info()
        self._context._check(lib.mpm_stepper_info(self, ctypes.byref(info)))
        return StepInfo(info)

    @property
    def t(self):
        """The time of the state."""
        return self.info.t

    @documented("mpm_stable_dt")
    def stable_dt(self):
        """The stable dt at CFL number 1."""
        dt = ctypes.c_double()
        self._context._check(lib.mpm_stable_dt(self, ctypes.addressof(dt)))
        return dt.value

    @documented("mpm_stepper_set_time")
    def set_time(self, t, step=0):
        """Sets time and number of steps; sums over steps start anew."""
        self._context._check(lib.mpm_stepper_set_time(self, t, step))

    @documented("mpm_step_begin")
    def begin(self, dt):
        """Makes the first part of a step in parts; update_grid() and end() follow, or abort()."""
        self._context._check(lib.mpm_step_begin(self, dt))

    @documented("mpm_step_grid")
    def update_grid(self):
        """Makes the second part: nodal velocities, walls, prescribed velocities."""
        self._context._check(lib.mpm_step_grid(self))

    @documented("mpm_step_end")
    def end(self):
        """Makes the last part, and commits; returns the StepInfo."""
        info = self._info()
        return self._ended(lib.mpm_step_end(self, ctypes.byref(info)), info)

    @documented("mpm_step_abort")
    def abort(self):
        """Drops the step that was begun."""
        self._context._check(lib.mpm_step_abort(self))

    @documented("mpm_grid_map")
    def nodes(self, field, body=0, write=False):
        """Shows a field of the active nodes, (nodes, components). Steps are refused until the last array has died."""
        view = _api.view(struct_size=ctypes.sizeof(_api.view))
        access = _api.READ | (_api.WRITE if write else 0)
        self._context._check(lib.mpm_grid_map(self, body, field.encode(), access, ctypes.byref(view)))
        return lend(view, self)

    # ---- reports ----

    def _vector(self, function, *arguments):
        out = np.empty(self.dim)
        self._context._check(function(self, *arguments, address(out)))
        return out

    @documented("mpm_stepper_wall_reaction")
    def wall_reaction(self, face):
        """Force of a wall on the material in the last step."""
        return self._vector(lib.mpm_stepper_wall_reaction, face)

    @documented("mpm_stepper_wall_impulse")
    def wall_impulse(self, face):
        """Impulse of a wall on the material over all steps."""
        return self._vector(lib.mpm_stepper_wall_impulse, face)

    @documented("mpm_stepper_particles_reaction")
    def particles_reaction(self, particles):
        """Force of a set's prescribed particles on the material in the last step."""
        return self._vector(lib.mpm_stepper_particles_reaction, particles)

    @documented("mpm_stepper_particles_impulse")
    def particles_impulse(self, particles):
        """Impulse of a set's prescribed particles on the material over all steps."""
        return self._vector(lib.mpm_stepper_particles_impulse, particles)

    @documented("mpm_stepper_surface_reaction")
    def surface_reaction(self, surface):
        """Force of what a surface prescribes on the material in the last step."""
        return self._vector(lib.mpm_stepper_surface_reaction, surface)

    @documented("mpm_stepper_surface_impulse")
    def surface_impulse(self, surface):
        """Impulse of what a surface prescribes on the material over all steps."""
        return self._vector(lib.mpm_stepper_surface_impulse, surface)

    @documented("mpm_stepper_residuals")
    def residuals(self):
        """The history of the last implicit step's residual."""
        count = ctypes.c_int32()
        self._context._check(lib.mpm_stepper_residuals(self, 0, None, ctypes.addressof(count)))
        out = np.empty(count.value)
        self._context._check(lib.mpm_stepper_residuals(self, len(out), address(out), ctypes.addressof(count)))
        return out

    @documented("mpm_stepper_profile")
    def profile(self, reset=False):
        """Seconds spent in steps, by stage: a dict."""
        out = _api.profile(struct_size=ctypes.sizeof(_api.profile))
        self._context._check(lib.mpm_stepper_profile(self, bool(reset), ctypes.byref(out)))
        return {name: getattr(out, name) for name, *_ in out._fields_ if name not in ("struct_size", "reserved")}

    # ---- states and files ----

    @documented("mpm_state_save")
    def save(self, path=None):
        """Saves the state into a file by its path, into one that is open for binary writing, or as bytes that are
        returned."""
        if hasattr(path, "write"):
            self._context._check(lib.mpm_state_save_to(self, self._context._sink(path), None))
            return None
        if path is not None:
            self._context._check(lib.mpm_state_save_file(self, os.fsencode(path)))
            return None
        count = ctypes.c_int64()
        self._context._check(lib.mpm_state_size(self, ctypes.addressof(count)))
        buffer = ctypes.create_string_buffer(count.value)
        self._context._check(lib.mpm_state_save(self, buffer, count.value))
        return buffer.raw

    @documented("mpm_state_load")
    def load(self, state):
        """Replaces the state by one from a file, by its path or open for binary reading, or by one that save() has returned as
        bytes."""
        if hasattr(state, "read"):
            state = state.read()
        if isinstance(state, (bytes, bytearray, memoryview)):
            state = bytes(state)
            self._context._check(lib.mpm_state_load(self, state, len(state)))
        else:
            self._context._check(lib.mpm_state_load_file(self, os.fsencode(state)))
        for one in self._sets:
            one._look()

    @documented("mpm_state_load_pieces")
    def load_pieces(self, pieces):
        """Replaces the state by one in pieces, as each part's save() has returned them: those of this part, in order."""
        pieces = [bytes(piece) for piece in pieces]
        data = (ctypes.c_char_p * len(pieces))(*pieces)
        count = (ctypes.c_int64 * len(pieces))(*map(len, pieces))
        self._context._check(
            lib.mpm_state_load_pieces(self, len(pieces), ctypes.addressof(data), ctypes.addressof(count)))
        for one in self._sets:
            one._look()

    @property
    def hash(self):
        """The hash of the state."""
        out = ctypes.c_uint64()
        self._context._check(lib.mpm_state_hash(self, ctypes.addressof(out)))
        return out.value

    @documented("mpm_write_body_grid")
    def write_grid(self, path, *fields, body=0):
        """Writes nodal fields of the last step for ParaView (.vti, or .vtr with open knots). path may be a file that is
        open for binary writing."""
        names = (ctypes.c_char_p * max(len(fields), 1))(*(f.encode() for f in fields))
        where = len(fields), ctypes.addressof(names)
        if hasattr(path, "write"):
            self._context._check(lib.mpm_write_grid_to(self, body, self._context._sink(path), None, *where))
        else:
            self._context._check(lib.mpm_write_body_grid(self, body, os.fsencode(path), *where))
