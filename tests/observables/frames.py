"""Frames of particles that the tests put together."""

import numpy as np

from roughgas.observables import Frame, System


def system_of(box, **changes):
    """Return a system of 30 disks or spheres in a periodic box, with `changes`."""
    system = System(
        particles=30,
        box=tuple(map(float, box)),
        periodic=(True,) * len(box),
        inertia=0.5 if len(box) == 2 else 0.4,
        shear_rate=0.0,
        interval=1.0,
        cooling=False,
    )
    return system._replace(**changes)


def frame_of(system, position=None, velocity=None, spin=None, **changes):
    """Return a frame of `system`; without arguments, positions, velocities and spins are random."""
    rng = np.random.default_rng(7)
    shape = system.particles, system.dimension
    position = rng.uniform(0, 1, shape) * system.box if position is None else position
    frame = Frame(
        system=system,
        time=0.0,
        collisions=0.0,
        position=position,
        unwrapped_position=position,
        velocity=rng.standard_normal(shape) if velocity is None else velocity,
        spin=rng.standard_normal((shape[0], 2 * shape[1] - 3)) if spin is None else spin,
        radius=np.ones(shape[0]),
        mass=np.ones(shape[0]),
        inertia=np.full(shape[0], system.inertia),
        image_shift=0.0,
        rates={},
    )
    return frame._replace(**changes)
