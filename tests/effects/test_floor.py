"""Floors that move as a sawtooth, a sine and a triangle; walls."""

import math

import mpmath
import numpy as np
import pytest
from brute_force import Beside, begin, run, scene_of, settings, snapshot
from compiled import from_python
from hard_cases.waves import DIGITS, exact

from roughgas.base import InputError
from roughgas.effects import floor as floors
from roughgas.effects import sine_floor
from roughgas.effects.floor import Floor
from roughgas.effects.settings import SceneContext, make
from roughgas.effects.sine_floor import SineFloor
from roughgas.effects.triangular_floor import TriangularFloor
from roughgas.kernel.hooks import CODES
from roughgas.kernel.memory import new_state
from roughgas.kernel.state import BASE, BOUNDARY_HITS, NOW

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


time_to_sine = from_python(sine_floor.time_to_floor)
WAVES = ["reversed_sawtooth", "triangle", "sine"]


SPIN = {"spin": {"inertia": 0.5}}


def from_settings(**chosen):
    stated = {"amplitude": 5, "period": 2, "restitution": "particles", "roughness": 0.5}
    around = SceneContext((50.0, None), 0.9, 0.2, SPIN)
    return make(Floor, "floor", stated | chosen, around)


def test_the_wave_is_chosen_by_name():
    assert (
        from_settings()
        == from_settings(wave=None)
        == from_settings(wave="sawtooth")
        == (5.0, 2.0, 0.9, 0.5)
    )
    assert isinstance(from_settings(), Floor)
    triangle, reverse, harmonic = (
        from_settings(wave=wave) for wave in ("triangle", "reversed_sawtooth", "sine")
    )
    assert isinstance(triangle, TriangularFloor) and isinstance(reverse, TriangularFloor)
    assert (triangle.rise, reverse.rise) == (0.5, 0.1)
    assert isinstance(harmonic, SineFloor)
    for floor in (triangle, reverse, harmonic):
        chosen = floor.amplitude, floor.period, floor.restitution, floor.roughness
        assert chosen == from_settings()


@pytest.mark.parametrize("wave", ["square", "Sine", 1, ["sine"]])
def test_an_unknown_wave_is_an_error_that_names_the_known_ones(wave):
    with pytest.raises(InputError, match=r"effects\.floor\.wave .*sawtooth.*triangle, sine"):
        from_settings(wave=wave)


@pytest.mark.parametrize("wave", WAVES)
def test_an_elastic_floor_reverses_the_velocity_relative_to_its_surface(wave):
    """Of twenty bounces, each in 40 digits; and the books hold what it gains."""
    scene, state = one_particle(21.3, (0.3, 0.0), wave=wave)
    floor = scene.effects.floor
    gained = 0.0
    run(state, scene, 1, interval=1e-9)  # has the first meeting foreseen
    with mpmath.workdps(DIGITS):
        for bounce in range(1, 21):
            _, y, _, v, time = map(float, state.trajectory[0])
            start = state.clock[BASE] + time
            while state.counts[BOUNDARY_HITS] < bounce:
                ahead = state.agenda.boundary_time[0] - state.clock[NOW]
                run(state, scene, 1, interval=ahead + 1e-6)
            assert state.counts[BOUNDARY_HITS] == bounce
            _, _, _, leaving, time = map(float, state.trajectory[0])
            truth = exact(floor, 1.0, y - 1.0, v, start % floor.period)
            wait = mpmath.mpf(state.clock[BASE] + time - start)
            assert abs(truth.gap(wait)) < 1e-14 * truth.lengths(wait)
            opens = leaving - truth.surface(wait)[1]
            assert opens == pytest.approx(float(-truth.speed(wait)), rel=1e-9)
            gained += 0.5 * float(leaving**2 - (v - wait) ** 2)
    there = [name for name, one in scene.effects._asdict().items() if one is not None]
    index = there.index("floor")
    assert state.ledger.sum(axis=0)[index] == pytest.approx([gained, 0.0], rel=1e-9)
    assert abs(gained) > 1.0


def test_a_particle_above_a_sine_looks_again_when_it_is_back():
    """What is foreseen then is the same meeting that a search from the start of its path finds."""
    scene, state = one_particle(21.3, (0.3, 0.0), wave="sine")
    floor, lowest = scene.effects.floor, 20.3
    run(state, scene, 1, interval=1e-9)
    back, code = state.agenda.boundary_time[0], state.agenda.boundary_code[0]
    assert back == pytest.approx(math.sqrt(2.0 * (lowest - floor.amplitude)), rel=1e-14)
    assert code % CODES == sine_floor.LOOK
    run(state, scene, 1, interval=back)
    assert state.agenda.boundary_code[0] % CODES == sine_floor.MEET
    meeting = state.clock[BASE] + state.agenda.boundary_time[0]
    assert meeting == pytest.approx(time_to_sine(floor, 1.0, lowest, 0.0, 0.0), rel=1e-14)
    assert state.counts[BOUNDARY_HITS] == 0 and state.changes[0] == 0


CASES = {
    "elastic": ({}, 0.8, 0.2),
    "inelastic and rough": ({"restitution": 0.8, "roughness": 0.5}, 0.9, -0.5),
    "small strokes": ({"amplitude": 0.3, "period": 0.2}, 0.7, 0.2),
}


@pytest.mark.parametrize("wave", WAVES)
@pytest.mark.parametrize("case", CASES)
def test_the_kernel_makes_the_same_collisions(wave, case):
    """The same 200 pairs, and hits of the floor between them, as the brute force."""
    floor, r, beta = CASES[case]
    experiment = settings("bed", 16, [10, "open"], floor={"wave": wave} | floor)
    _, world = scene_of(experiment, r, beta)
    scene, state = begin(experiment, r, beta, 9)
    beside = Beside(state, scene, world)
    beside.assert_same(20, 10)
    assert beside.events["floor"] > 10


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
