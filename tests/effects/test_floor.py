"""The vibrated floor, and free fall above it."""

import mpmath
import numpy as np
import pytest
from brute_force import begin, run, settings
from compiled import from_python

from roughgas.effects import floor as floors
from roughgas.effects.floor import Floor
from roughgas.kernel.memory import new_state
from roughgas.kernel.state import BOUNDARY_HITS

time_to_floor = from_python(floors.time_to_floor)


def floor_of(amplitude=5.0, period=1.0):
    return Floor(amplitude, period, 1.0, -1.0)


def test_a_particle_on_the_floor_that_leaves_it_does_not_meet_it_at_once():
    floor = floor_of()
    for phase in (0.0, 0.3, 0.999999, 1.0):
        surface = 5.0 * (phase % 1.0)
        for gap in (0.0, 1e-16, -1e-16, 1e-12, -1e-12):
            assert time_to_floor(floor, 1.0, surface + gap, 8.0, phase) > 0.1
            if gap <= 0.0 and phase != 1.0:
                assert time_to_floor(floor, 1.0, surface + gap, 4.0, phase) == 0.0
            if phase < 0.5:  # back after a hop, before the stroke ends
                hop = time_to_floor(floor, 1.0, surface + gap, 5.2, phase)
                assert hop == pytest.approx(0.4, rel=1e-10)


def one_particle(height, velocity, **floor):
    experiment = settings("bed", 1, [10, "open"], floor=floor)
    scene, _ = begin(experiment, 1.0, 0.0)
    position = np.array([[3.0, height]])
    return scene, new_state(scene, position, np.array([velocity]), np.zeros((1, 1)))


def test_a_parabola():
    scene, state = one_particle(50.0, (0.7, 12.0))
    for time in 0.25 * np.arange(1, 60):
        row = run(state, scene, 1, interval=0.25)
        assert row["y"] == pytest.approx(50.0 + 12.0 * time - time**2 / 2, abs=1e-12)
        assert row["vv_y"] == pytest.approx((12.0 - time) ** 2, abs=1e-11)
        assert row["vv_x"] == 0.7**2


@pytest.mark.parametrize("restitution", [1.0, 0.9])
def test_a_single_particle_bounces_by_the_closed_form(restitution):
    """Meeting the rising floor at w < 0 it leaves at V (1 + r) - r w, until the next meeting."""
    scene, state = one_particle(20.0, (0.0, 0.0), restitution=restitution)
    floor = floor_of()
    height, speed, time = mpmath.mpf(19), mpmath.mpf(0), mpmath.mpf(0)
    for bounce in range(1, 60):
        with mpmath.workdps(40):
            wait = exact_time_from(floor, height, speed, time)
            time += wait
            speed = 5 * (1 + mpmath.mpf(restitution)) - mpmath.mpf(restitution) * (speed - wait)
            height = 5 * (time - mpmath.floor(time))
        while state.counts[BOUNDARY_HITS] < bounce:
            run(state, scene, 1, interval=0.04)
        last = state.clock[0] + state.trajectory[0, 4]
        # every bounce multiplies a rounding by the slope of the map, which is above 1
        tolerance = 1e-13 * 3.0**bounce
        if tolerance > 1e-3:
            break
        assert last == pytest.approx(float(time), abs=tolerance)
        assert state.trajectory[0, 3] == pytest.approx(float(speed), abs=10.0 * tolerance)
        assert state.trajectory[0, 1] == pytest.approx(1.0 + float(height), abs=10.0 * tolerance)
    assert bounce > 20


def exact_time_from(floor, height, speed, time):
    """As exact_time, with arguments of any precision, from a point on or above the surface."""
    stroke = mpmath.floor(time)
    while True:
        gap = height - 5 * (time - stroke)
        relative = speed - 5
        square = relative**2 + 2 * gap
        root = relative + mpmath.sqrt(square)
        if max(stroke - time, mpmath.mpf(10) ** -30) <= root <= stroke + 1 - time:
            return root
        stroke += 1
