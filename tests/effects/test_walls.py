"""Side walls."""

import numpy as np
import pytest
from brute_force import begin, run, settings, snapshot

from roughgas.kernel.memory import new_state
from roughgas.kernel.state import BOUNDARY_HITS


def thrown(velocity, spin=0.0, **walls):
    """One particle 100 a above the floor of a bed 12 a wide."""
    scene, _ = begin(settings("walled", 1, [12, "open"], walls=walls), 0.9, 0.0)
    position = np.array([[6.0, 100.0]])
    return scene, new_state(scene, position, np.array([velocity]), np.array([[spin]]))


def test_a_smooth_elastic_wall_reflects():
    scene, state = thrown((3.0, 0.0), 0.8, restitution=1.0, roughness=-1.0)
    for k in range(1, 100):
        run(state, scene, 1, interval=0.1)
        shot = snapshot(state, scene)
        folded = (5.0 + 0.3 * k) % 20.0  # the particle's room is 10 a wide: x - 1 unfolds to that
        assert shot.position[0, 0] - 1.0 == pytest.approx(min(folded, 20.0 - folded), abs=1e-12)
        assert abs(shot.velocity[0, 0]) == pytest.approx(3.0, rel=1e-14)
        assert shot.spin[0, 0] == 0.8


def test_restitution_of_a_wall():
    scene, state = thrown((-8.0, 0.0), restitution=0.5, roughness=-1.0)
    run(state, scene, 1, interval=0.7)
    assert state.trajectory[0, 2] == 4.0 and state.counts[BOUNDARY_HITS] == 1


@pytest.mark.parametrize(("direction", "side"), [(-1.0, 1.0), (1.0, -1.0)])
def test_roughness_of_a_wall(direction, side):
    """A particle that rolls along neither side: g_y = v_y + (n_x = +-1) (-a w) is reflected."""
    q, beta = 0.5, 0.6
    v_y, w = 2.0, 0.7
    scene, state = thrown((5.0 * direction, v_y), w, restitution=1.0, roughness=beta)
    run(state, scene, 1, interval=1.5)
    time = state.trajectory[0, 4] + state.clock[0]
    falling = v_y - time  # at the moment of the contact
    slip = falling - w * side  # (w x n)_y = w n_x
    kick = q * (1 + beta) / (1 + q) * slip
    assert state.trajectory[0, 3] == pytest.approx(falling - kick, rel=1e-13)
    assert state.spin[0, 0] == pytest.approx(w + (1 + beta) / (1 + q) * side * slip, rel=1e-13)
