"""What the callbacks of a stepper are shown."""
from ._arrays import Batch, scalar, vector


class ParticleBatch(Batch):
    """Particles for which a vector is wanted: n, dim, t, dt, id (n,) (< 0: an inert slot), position and velocity (n, dim),
    reference_position or None, mass, volume; particles, the set; field(name)."""

    _arrays = {"id": scalar, "position": vector, "reference_position": vector, "velocity": vector, "mass": scalar,
               "volume": scalar}
    particles = None


class NodeBatch(Batch):
    """Active nodes: n, dim, t, dt, body, index and position (n, dim), mass and owned (n,)."""

    _arrays = {"index": vector, "position": vector, "mass": scalar, "owned": scalar}


class AdaptionBatch(Batch):
    """Particles that are to be split, or pairs that are to be merged: what (ADAPT_SPLIT or ADAPT_MERGE), n, dim, id (n,),
    other (n,) or None, the particles that go; position (n, dim)."""

    _arrays = {"id": scalar, "other": scalar, "position": vector}


class ContactBatch(Batch):
    """Nodes at which two bodies touch: body_a, body_b, n, dim, t, dt, position, normal and slip (n, dim), gap, area and
    pressure (n,)."""

    _arrays = {"position": vector, "normal": vector, "slip": vector, "gap": scalar, "area": scalar, "pressure": scalar}
