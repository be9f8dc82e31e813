"""Trajectories and spins in single precision: contacts are found, energy nearly conserved."""

import numpy as np
import pytest
from brute_force import largest_overlap, run, scene_of, settings

from roughgas.scene.initial import initial_state

SINGLE = 2.0**-24  # half the spacing of single precision just above 1


@pytest.mark.parametrize(
    "number", [160, pytest.param(1000, marks=pytest.mark.slow)], ids=["swept", "in cells"]
)
def test_an_elastic_gas(number):
    """As in double precision: the frequency of collisions within 4 %, some 4 standard errors.

    Positions are off by roundings of the box's side, and so may be the places of contact; energy
    makes a random walk of such roundings.
    """
    side = np.sqrt(10.0 * np.pi * number)
    experiment = settings("gas", number, [side, side])
    scene, world = scene_of(experiment, 1.0, 1.0)
    elapsed = []
    for precision in (np.float32, np.float64):
        state = initial_state(scene, experiment, np.random.default_rng(1), precision)
        assert state.trajectory.dtype == state.spin.dtype == precision
        assert (state.cells is None) == (number == 160)
        rows = run(state, scene, 10, collisions=10 * number)
        energy = sum(rows[name] for name in ("vv_x", "vv_y")) + 0.5 * rows["ww"]
        rounding = SINGLE if precision is np.float32 else 2.0**-53
        assert np.ptp(energy) / energy[0] < 100.0 * rounding
        assert largest_overlap(state, scene, world) < 8.0 * side * rounding
        elapsed.append(rows["time"][-1] - rows["time"][0])
    assert elapsed[0] == pytest.approx(elapsed[1], rel=0.04)
    assert elapsed[0] != elapsed[1]
