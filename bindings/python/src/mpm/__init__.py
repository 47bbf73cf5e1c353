"""libmpm, the Material Point Method, for Python: the host program owns the time loop.

    import mpm
    context = mpm.Context(concurrency=0)
    grid = context.grid(dim=2, cells=40, spacing=0.025)
    jelly = context.material("neo_hookean", E=1e3, nu=0.3, density=1e3)
    ball = context.particles(grid, jelly).fill_ball((0.5, 0.5), 0.2)
    stepper = context.stepper(grid, ball, gravity=(0, -9.81)).wall(mpm.Y_MIN, mpm.WALL_FRICTION, 0.3)
    stepper.advance(0.2)
    print(ball["position"].mean(axis=0), stepper.info)

Constants have the names of the C library without MPM_. Every method's text ends with that of the C function it calls.
"""
from . import _api
from ._handles import Context
from ._library import Error, StepError, version
from .grid import Grid
from .material import Law, Material, models
from .obstacle import Obstacle
from .particles import Particles
from .series import Series
from .stepper import Stepper, StepInfo
from .surface import Surface

globals().update({name: getattr(_api, name) for name in _api.CONSTANTS})
__version__ = "0.2.0.dev0"
__all__ = ["Context", "Error", "Grid", "Law", "Material", "Obstacle", "Particles", "Series", "StepError", "StepInfo", "Stepper",
           "Surface", "models", "version", *_api.CONSTANTS]
