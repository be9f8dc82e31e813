"""Where particles are between events, against brute force, which keeps all of them at one time."""

import numpy as np
import pytest
from brute_force import run, scene_of, settings, snapshot
from brute_force.beside import brute_force_from

from roughgas.scene.initial import initial_state
from roughgas.simulation.instant import in_order, whereabouts

TINY = 1e-9
SCENES = {"bed": settings("bed", 16, [10, "open"]), "sheared": settings("sheared", 16, [12, 12])}


@pytest.mark.parametrize("name", SCENES)
def test_particles_move_as_brute_force_has_them(name):
    """A chaotic gas amplifies roundings by far less than 1e6 within 1.5 T."""
    scene, world = scene_of(SCENES[name], 0.9, 0.3)
    state = initial_state(scene, SCENES[name], np.random.default_rng(7))
    brute = brute_force_from(world, snapshot(state, scene))
    for _ in range(12):
        run(state, scene, 1, interval=0.125)
        brute.run_until(brute.time + 0.125)
        position, velocity = (
            in_order(state, values) for values in whereabouts(state, scene, brute.time)
        )
        # a particle on the edge of the box may be folded either way, and moves with its image
        apart = [
            np.abs(position - brute.x + s).max(axis=1) + np.abs(velocity - brute.v + d).max(axis=1)
            for s, d in brute.images()
        ]
        assert np.min(apart, axis=0).max() < TINY
