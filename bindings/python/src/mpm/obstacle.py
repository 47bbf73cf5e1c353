"""Obstacles: rigid bodies without particles."""
import ctypes

import numpy as np

from . import _api
from ._arrays import Batch, address, doubles, scalar, vector
from ._handles import Handle, descriptor
from ._library import documented, lib


def contact_desc(options):
    """A descriptor of contact from its options."""
    return descriptor(_api.contact_desc, lib.mpm_contact_desc_init, options, "contact")


class DistanceBatch(Batch):
    """Points whose distance from an obstacle is asked for: position (n, dim). To be filled: distance (n,), normal (n, dim),
    and velocity (n, dim) where that is not None."""

    _arrays = {"position": vector, "distance": scalar, "normal": vector, "velocity": vector}
    _written = ("distance", "normal", "velocity")


class Obstacle(Handle):
    """A rigid body that the material meets. shape is one of SHAPE_PLANE ... SHAPE_DISTANCE; the options are the fields of
    mpm_obstacle_desc: size, position, orientation, velocity, motion, mass, inertia, inside, lower, upper; contact is a dict
    of mpm_contact_desc (friction ...), distance a function of a DistanceBatch for SHAPE_DISTANCE."""

    _destroy = staticmethod(lib.mpm_obstacle_destroy)

    def __init__(self, context, shape, contact=None, distance=None, **options):
        for name in ("size", "position", "velocity", "angular_velocity", "lower", "upper"):
            if name in options and not hasattr(options[name], "__len__"):
                options[name] = [options[name]]
        if "inertia" in options:
            options["inertia"] = np.ravel(options["inertia"])
        desc = descriptor(_api.obstacle_desc, lib.mpm_obstacle_desc_init, dict(options, shape=shape), "Obstacle")
        self._contact = contact_desc(contact or {})
        desc.contact = ctypes.pointer(self._contact)

        def measure(_, batch):
            return DistanceBatch(batch)._run(distance)

        self._motion = None
        self._distance = desc.distance = context._callback(_api.distance_fn, distance, measure)
        self._own(context, context._make(self._destroy, lib.mpm_obstacle_create, context, ctypes.byref(desc)), context)

    @documented("mpm_obstacle_set_motion")
    def set_motion(self, motion):
        """Sets how an obstacle with MOTION_PRESCRIBED moves: motion(t, dt) gives the mean velocity (3,) and angular
        velocity (3,) of the step, or one of them as None to keep it. None takes the function away."""

        def call(_, t, dt, velocity, angular):
            for at, values in zip((velocity, angular), motion(t, dt)):
                if values is not None:
                    (ctypes.c_double * 3).from_address(at)[:] = list(doubles(values, 3))

        made = self._context._callback(_api.motion_fn, motion, call)
        self._context._check(lib.mpm_obstacle_set_motion(self, made, None))
        self._motion = made

    @documented("mpm_obstacle_set_contact")
    def set_contact(self, **options):
        """Sets how the obstacle meets the material: friction, friction_static, adhesion, offset, kind."""
        self._context._check(lib.mpm_obstacle_set_contact(self, ctypes.byref(contact_desc(options))))

    @documented("mpm_obstacle_set_pose")
    def set_pose(self, position=None, orientation=None, velocity=None, angular_velocity=None):
        """Puts the obstacle somewhere; what is not given stays."""
        arrays = [None if v is None else doubles(v, k)
                  for v, k in ((position, 3), (orientation, 4), (velocity, 3), (angular_velocity, 3))]
        self._context._check(lib.mpm_obstacle_set_pose(self, *(address(a) for a in arrays)))

    @documented("mpm_obstacle_set_load")
    def set_load(self, force=None, torque=None):
        """Sets what acts on a free obstacle beside gravity and contact."""
        arrays = [None if v is None else doubles(v, 3) for v in (force, torque)]
        self._context._check(lib.mpm_obstacle_set_load(self, *(address(a) for a in arrays)))

    def _pose(self):
        arrays = [np.empty(k) for k in (3, 4, 3, 3)]
        self._context._check(lib.mpm_obstacle_get_pose(self, *(address(a) for a in arrays)))
        return arrays

    @property
    def position(self):
        """Where the centre is, (3,)."""
        return self._pose()[0]

    @property
    def orientation(self):
        """The unit quaternion w, x, y, z from axes of the body to those of space."""
        return self._pose()[1]

    @property
    def velocity(self):
        """Velocity of the centre, (3,)."""
        return self._pose()[2]

    @property
    def angular_velocity(self):
        """Angular velocity in space, (3,)."""
        return self._pose()[3]

    @documented("mpm_obstacle_contact_info")
    def contact_info(self, body=_api.BODY_ANY):
        """What a body and the obstacle did to each other in the last step."""
        info = _api.contact_info(struct_size=ctypes.sizeof(_api.contact_info))
        self._context._check(lib.mpm_obstacle_contact_info(self, body, ctypes.byref(info)))
        return info
