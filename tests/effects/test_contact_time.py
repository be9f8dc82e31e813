"""The contact-time model against inelastic collapse."""

import numpy as np
import pytest
from brute_force import begin, run, settings

from roughgas.kernel.memory import new_state
from roughgas.kernel.record import Sampling, columns, record
from roughgas.kernel.state import COLLISIONS, TOUCHED

BED = settings(
    "walled",
    40,
    [12.5, "open"],
    walls={"roughness": -1.0},
    contact_time={"duration": 1e-5},
)


def test_it_keeps_a_bed_from_collapsing():
    """r = 0.6, beta = 0: the bed of the issue at a quarter of its size, 60 T."""
    scene, state = begin(BED, 0.6, 0.0, 1)
    run(state, scene, 240, interval=0.25)
    touched, collisions = state.counts[TOUCHED], state.counts[COLLISIONS]
    assert 0 < touched < 0.9 * collisions
    assert collisions < 1e7


def in_a_row(spacing, number=3):
    """Spheres on a line at rest; the first comes flying at speed 1."""
    position = np.full((number, 3), 6.0)
    position[:, 0] = 2.0 + (2.0 + spacing) * np.arange(number)
    velocity = np.zeros((number, 3))
    velocity[0, 0] = 1.0
    return position, velocity, np.zeros((number, 3))


@pytest.mark.parametrize(("duration", "second"), [(0.4, 0.5), (0.6, 1.0)])
def test_a_contact_soon_after_another_is_elastic(duration, second):
    """The middle sphere is hit at speed 1 and moves on at (1 + r)/2 = 0.75 over a gap of 0.375.

    0.5 T later it hits the third, which is elastic if t_c is longer than that.
    """
    experiment = settings("spheres", 3, [40, 12, 12], contact_time={"duration": duration})
    scene, _ = begin(experiment, 0.5, 0.0)
    position, velocity, spin = in_a_row(0.375)
    state = new_state(scene, position, velocity, spin)
    run(state, scene, 2, collisions=1)
    restitution = 2.0 * state.trajectory[2, 3] / 0.75 - 1.0
    assert restitution == pytest.approx(second, rel=1e-12)
    assert state.counts[TOUCHED] == (second == 1.0)


def test_roughness_is_left_as_it_is():
    """Two oblique contacts of a pair in quick succession, by beta = 0.4 both."""
    experiment = settings("spheres", 3, [40, 12, 12], contact_time={"duration": 10.0})
    scene, _ = begin(experiment, 0.5, 0.4)
    position, velocity, spin = in_a_row(0.375)
    spin[2] = [0.0, 0.0, 1.0]
    state = new_state(scene, position, velocity, spin)
    run(state, scene, 2, collisions=1)
    assert state.counts[TOUCHED] == 1
    # g_t = -(w x n): turned by (1 + beta)/(2 + 2q) n x g_t, q = 2/5
    assert state.spin[2, 2] == pytest.approx(1.0 - 1.4 / 2.8, rel=1e-12)


def test_t_c_is_a_time_however_slow_the_gas_has_become():
    """A cooling gas is refreshed: its velocities are doubled, its clock is not the user's.

    The contact that follows the previous one by 0.5 T is beyond t_c = 0.4 T and within 0.6 T,
    whatever power of two the velocities have been divided by. Here the gas is 2^-20 as fast, after
    which the contacts are 2^20 T/2 apart: t_c touches none of them.
    """
    slow = 2.0**-20
    for duration, touched in ((0.4, 0), (0.6, 0), (0.4 / slow, 0), (0.6 / slow, 1)):
        experiment = settings("spheres", 4, [40, 12, 12], contact_time={"duration": duration})
        scene, _ = begin(experiment, 0.5, 0.0)
        position, velocity, spin = in_a_row(0.375, 4)
        # the fourth, far off, keeps the total momentum zero
        position[3], velocity[3] = [30.0, 2.0, 2.0], -velocity[0]
        state = new_state(scene, position, slow * velocity, spin)
        run(state, scene, 1, interval=2.0**-10, refresh=1)
        rows = np.empty((2, len(columns(scene))))
        record(state, scene, Sampling(np.inf, 1, 0), rows)
        assert state.counts[TOUCHED] == touched, duration
