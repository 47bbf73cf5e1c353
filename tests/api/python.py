"""The sketch of docs/guide.md in Python: python.py LIBRARY < SKETCH, the code as printed."""
import ctypes
import sys

import numpy


def expect(what, condition):
    if not condition:
        sys.exit(f'python.py: {what}')


def refused(what, error, call):
    try:
        call()
    except error as reason:
        return str(reason)
    sys.exit(f'python.py: {what} was not refused')


class GridDesc(ctypes.Structure):
    _fields_ = [('struct_size', ctypes.c_uint32), ('dim', ctypes.c_int32), ('basis', ctypes.c_int32),
                ('boundary_basis', ctypes.c_int32), ('periodic', ctypes.c_int32 * 3), ('reserved', ctypes.c_int32),
                ('cells', ctypes.c_int64 * 3), ('origin', ctypes.c_double * 3), ('spacing', ctypes.c_double * 3),
                ('smoothing', ctypes.c_double)]


class Param(ctypes.Structure):
    _fields_ = [('name', ctypes.c_char_p), ('value', ctypes.c_double)]


lib = ctypes.CDLL(sys.argv[1])
lib.mpm_last_error.restype = ctypes.c_char_p
context, grid, material = ctypes.c_void_p(), ctypes.c_void_p(), ctypes.c_void_p()
block, empty, stepper = ctypes.c_void_p(), ctypes.c_void_p(), ctypes.c_void_p()


def check(status):
    if status:
        raise RuntimeError(lib.mpm_last_error(context).decode())


sketch = sys.stdin.read()
definitions, use = sketch.split('\nwith mapped')
use = 'with mapped' + use
check(lib.mpm_context_create(None, ctypes.byref(context)))
desc = GridDesc()
check(lib.mpm_grid_desc_init(ctypes.byref(desc), ctypes.c_uint32(ctypes.sizeof(desc))))
desc.dim = 2
desc.cells[0] = desc.cells[1] = 20
desc.spacing[0] = desc.spacing[1] = 0.05
check(lib.mpm_grid_create(context, ctypes.byref(desc), ctypes.byref(grid)))
params = (Param * 3)(Param(b'E', 1e5), Param(b'nu', 0.3), Param(b'density', 1e3))
check(lib.mpm_material_create(context, b'neo_hookean', params, 3, ctypes.byref(material)))
for made in (block, empty):
    check(lib.mpm_particles_create(context, grid, material, ctypes.byref(made)))
pair, ints = ctypes.c_double * 2, ctypes.c_int32 * 2
check(lib.mpm_particles_fill_box(block, pair(0.2, 0.2), pair(0.5, 0.5), ints(2, 2), None, None))
check(lib.mpm_particles_set_all(block, b'velocity', 1, 2, pair(1.0, 2.0)))
check(lib.mpm_stepper_create(context, grid, None, ctypes.byref(stepper)))
check(lib.mpm_stepper_add(stepper, block))
step = lambda: lib.mpm_step(stepper, ctypes.c_double(1e-5), None)
check(step())

exec(definitions)
exec(use)
with mapped(block, 'id') as ids, mapped(block, 'velocity') as velocity:
    alive = ids[0] >= 0
    expect('the sketch does not turn velocities round', numpy.allclose(velocity[:][:, alive].T, (1.0, -2.0)))
    expect('while views are out a step is made', step() != 0)
    text = refused('writing to a view for reading', ValueError, lambda: velocity.__setitem__(0, 1.0))
    expect(f'it says "{text}"', 'read-only' in text)
    kept = velocity[:]
for use_after in (lambda: velocity[0], lambda: velocity.__setitem__(0, 1.0)):
    expect('no word of release', 'released' in refused('use after release', ValueError, use_after))
check(step())
kept[:] = numpy.nan  # a copy: nobody minds
check(step())
with mapped(empty, 'position') as nothing, mapped(empty, 'id') as none:
    expect('an empty set has items', nothing[:].shape == (2, 0) and none[:].shape == (1, 0))


def bad_values():
    with mapped(block, 'velocity', READ | WRITE) as bad:
        bad[0] = numpy.nan


expect('no word of the value', 'finite' in refused('a velocity that is not a number', RuntimeError, bad_values))
expect('a set with bad values steps', step() != 0)
print('python.py: views of the guide are read-only, survive empty sets, and end with their release')
