"""Scenes that the tests share."""
import mpm


def block(dim=2, cells=12, per_cell=2, law="neo_hookean", context=None, law_of=None, **options):
    """A block in a box of unit length, at rest, in a stepper."""
    context = context or mpm.Context()
    grid = context.grid(dim=dim, cells=cells, spacing=1 / cells)
    if law_of:
        material = law_of(context)
    else:
        material = context.material(law, E=1e4, nu=0.3, density=1e3)
    one = context.particles(grid, material).fill_box([0.25] * dim, [0.75] * dim, per_cell)
    return one, context.stepper(grid, one, **options)
