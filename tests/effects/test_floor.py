"""The vibrated floor, and free fall above it."""

import mpmath
import numpy as np
import pytest
from brute_force import begin, run, settings, snapshot
from compiled import from_python

from roughgas.effects import floor as floors
from roughgas.effects.floor import Floor
from roughgas.kernel.layout import new_state
from roughgas.kernel.state import BOUNDARY_HITS

time_to_floor = from_python(floors.time_to_floor)


def floor_of(amplitude=5.0, period=1.0):
    return Floor(amplitude, period, 1.0, -1.0)


def exact_time(floor, gravity, height, speed, phase):
    """Stroke by stroke in 40 digits: first time at which the lowest point is on the surface."""
    with mpmath.workdps(40):
        A, P, g, y, v, phase = (
            mpmath.mpf(float(c))
            for c in (floor.amplitude, floor.period, gravity, height, speed, phase)
        )
        stroke = int(mpmath.floor(phase / P))
        if y > A + 1:  # well above where any stroke ends: begin shortly before it is back there
            fall = (v + mpmath.sqrt(v**2 + 2 * g * (y - A))) / g
            stroke = max(stroke, int(mpmath.floor((phase + fall) / P)) - 2)
        while True:
            # gap(t) = y + v t - g t^2/2 - A/P (phase + t - stroke P)
            gap, relative = y - A / P * (phase - stroke * P), v - A / P
            root = (relative + mpmath.sqrt(relative**2 + 2 * g * gap)) / g
            begin, end = stroke * P - phase, (stroke + 1) * P - phase
            if max(begin, 0) <= root <= end:
                return root
            stroke += 1


@pytest.mark.parametrize("gravity", [1.0, 0.01, 50.0])
def test_time_to_floor_against_forty_digits(gravity):
    rng = np.random.default_rng(3)
    for _ in range(400):
        floor = floor_of(10.0 ** rng.uniform(-2, 1), 10.0 ** rng.uniform(-1, 1))
        phase = rng.uniform(0.0, 3.0) * floor.period
        surface = floor.amplitude * (phase / floor.period % 1.0)
        height = surface + 10.0 ** rng.uniform(-6, 2)
        speed = 5.0 * np.sqrt(gravity) * rng.standard_normal()
        time = time_to_floor(floor, gravity, height, speed, phase)
        exact = float(exact_time(floor, gravity, height, speed, phase))
        scale = (abs(speed) + floor.amplitude / floor.period) / gravity + exact
        assert time == pytest.approx(exact, rel=1e-13, abs=1e-14 * scale)


def test_hits_just_before_and_just_after_the_floor_returns():
    """Falling from rest at height h, for which the end of the stroke, at t = 1, matters."""
    floor = floor_of()
    top = 5.0 + 0.5  # meets the floor at its highest, at the very end of the stroke
    assert time_to_floor(floor, 1.0, top - 1e-9, 0.0, 0.0) == pytest.approx(1.0, abs=1e-9)
    missed = time_to_floor(floor, 1.0, top + 1e-9, 0.0, 0.0)
    assert missed == pytest.approx(float(exact_time(floor, 1.0, top + 1e-9, 0.0, 0.0)), rel=1e-12)
    assert 1.5 < missed < 2.0  # the next stroke meets it on its way up
    # the same from any stroke of a long simulation
    for strokes in (1, 7, 1000):
        assert time_to_floor(floor, 1.0, top + 1e-9, 0.0, strokes) == pytest.approx(missed)


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


def test_particles_stay_above_the_floor():
    scene, state = begin(settings("bed", 40, [12.5, "open"]), 0.8, 0.2, 3)
    for _ in range(400):
        run(state, scene, 1, interval=0.137)
        shot = snapshot(state, scene)
        surface = 5.0 * (shot.time % 1.0)
        assert shot.position[:, 1].min() > 1.0 + surface - 1e-11


def test_a_floor_without_restitution_is_hit_finitely_often():
    """A particle comes to rest on the rising floor, which then drops from under it."""
    scene, state = one_particle(10.0, (0.0, 0.0), restitution=0.0)
    run(state, scene, 20, interval=1.0)
    assert 20 < state.counts[BOUNDARY_HITS] < 1e8
    assert snapshot(state, scene).position[0, 1] > 1.0 - 1e-9
