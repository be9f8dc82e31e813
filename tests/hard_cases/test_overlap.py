"""Overlap by rounding."""

import numpy as np
from brute_force import run, scene_of, settings

from roughgas.kernel.layout import new_state
from roughgas.kernel.state import COLLISIONS


def test_overlapping_pairs_collide_once_if_they_approach(margins):
    """Overlaps from 1e-16 to 1e-9 a: approaching pairs collide at once and only once."""
    pairs = margins.size(quick=200, full=5000)
    rng = np.random.default_rng(3)
    scene, _ = scene_of(settings("smooth", 2, [40, 40]), 0.9, -1.0)
    late = repeated = overlooked = 0
    for k in range(pairs):
        approaching = k % 2 == 0
        state = overlapping_pair(scene, approaching, rng)
        run(state, scene, 1, interval=2.0**-26)  # the longest delay by a rounded gap
        late += approaching and state.counts[COLLISIONS] == 0
        run(state, scene, 1, interval=1.0)
        repeated += max(0, int(state.counts[COLLISIONS]) - approaching)
        overlooked += approaching and state.counts[COLLISIONS] == 0
    margins.at_most("approaching pairs that do not collide at once", late, 0, pairs // 2, "pairs")
    margins.at_most("approaching pairs that never collide", overlooked, 0, pairs // 2, "pairs")
    margins.at_most("contacts of receding pairs", repeated, 0, pairs, "pairs")


def overlapping_pair(scene, approaching, rng):
    """A state of two overlapping particles, at a random position and angle."""
    angle = rng.uniform(0.0, 2.0 * np.pi)
    n, t = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    distance = 2.0 - 10.0 ** rng.uniform(-16, -9)
    # slow enough to stay inside the box, fast enough along n to move beyond rounding
    speed = 10.0 ** rng.uniform(-6, 0) * (-1.0 if approaching else 1.0)
    velocity = np.array([np.zeros(2), speed * n + rng.normal() * t])
    position = rng.uniform(4.0, 36.0, 2)
    return new_state(
        scene, np.array([position, position + distance * n]), velocity, np.zeros((2, 1))
    )
