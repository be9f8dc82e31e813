"""Walls on single sides of the box: at rest, moving, shaken along their normal, thermal."""

import math

import numpy as np
import pytest
from brute_force import KERNELS, begin, run, scene_of, settings, snapshot
from brute_force.comparison import brute_force_from
from brute_force.sides import DEFAULTS, Side
from raw import build

from roughgas.base import InputError
from roughgas.effects import motions
from roughgas.effects.motions import Sine, sawtooth, triangle
from roughgas.kernel.hooks import displacement
from roughgas.kernel.state import BASE, BOUNDARY_HITS, NOW
from roughgas.scene.initial import check_positions

DISKS = {"spin": {"inertia": 0.5}}
BED = DISKS | {
    "gravity": {"acceleration": 1.0},
    "floor": {"amplitude": 1.0, "period": 1.0, "restitution": 1.0, "roughness": -1.0},
}


def closed(effects, box, particles=12):
    """Settings of an experiment with these effects."""
    return {"particles": particles, "box": box, "effects": effects}


FORMS = {
    "sawtooth": sawtooth,
    "reversed_sawtooth": lambda *stroke: triangle(*stroke, 0.1),
    "triangle": lambda *stroke: triangle(*stroke, 0.5),
    "sine": Sine,
}


@pytest.mark.parametrize("wave", FORMS)
@pytest.mark.parametrize("weight", [0.0, -0.7, 0.9])
def test_strokes_are_met_as_brute_force_finds_them(wave, weight):
    """Particles without gravity, or pulled towards the wall or away from it."""
    motion = FORMS[wave](1.5, 1.1)
    meet = motions.law_of(motion).meet
    moving = DEFAULTS | {"amplitude": 1.5, "period": 1.1, "wave": wave}
    side, rng, meetings = Side("lid", 0, 1.0, 0.0, 0, moving), np.random.default_rng(1), 0
    for _ in range(6):
        gap, speed, phase = 1.5 + rng.uniform(0, 2), rng.normal() - 1.5, rng.uniform(0, 1.1)
        time_found, expected = meet(motion, weight, gap, speed, phase)[0], math.inf
        time, step = 0.0, 0.5
        while time < 4.0 and math.isinf(expected):
            present_gap = gap + speed * time - weight * time**2 / 2
            wait = side.wait(present_gap, speed - weight * time, weight, phase + time, step)
            expected = time + wait
            time += step
        if math.isfinite(expected):
            meetings += 1
            assert time_found == pytest.approx(expected, abs=1e-9)
        else:
            assert time_found > 3.9
    assert meetings > 1


@pytest.mark.parametrize("wave", FORMS)
@pytest.mark.parametrize(
    ("amplitude", "period", "weight"), [(1e-5, 1e-9, 0.0), (1e-5, 1e-9, 0.9), (0.0, 1.0, 0.9)]
)
def test_the_shortest_period_and_a_wall_at_rest_are_met_at_once(wave, amplitude, period, weight):
    """Within twenty periods after reaching the strokes, up to roundings of the time.

    Up to 1e12 periods pass before: a search by small steps would not return.
    """
    motion, rng = FORMS[wave](amplitude, period), np.random.default_rng(2)
    for gap in (1.1e-5, 1e-3, 1.0):
        for speed in (-1e-3, -1.0, -100.0):
            reached = motions.fall_time(gap - amplitude, speed, weight)
            phase = rng.uniform(0.0, period)
            met = motions.law_of(motion).meet(motion, weight, gap, speed, phase)[0]
            latest = 20.0 * period if amplitude else 0.0
            assert -1e-13 * reached <= met - reached <= latest + 1e-13 * reached


def displacements_of(effects, box, name):
    """Displacements of a wall at 400 instants of a period of 1.7, (400,)."""
    wall = getattr(build(closed(effects, box), 0.9, 0.0).effects, name)
    return np.array([displacement(wall, 1.7 * k / 400) for k in range(400)])


@pytest.mark.parametrize(
    ("name", "amplitude", "lowest"),
    [("floor", 3.0, 0.0), ("lid", 3.0, 0.0), ("shaken_walls", 1.5, -1.5)],
)
def test_half_stroke_means_the_same_for_all_shaken_walls(name, amplitude, lowest):
    """half_stroke = 1.5 is an excursion of 1.5 about the middle, whatever `amplitude` means.

    At phase 1/4 the sine is shifted by a quarter of the period.
    """
    other_effects, box = (BED, [20, "open"]) if name == "floor" else (DISKS, [20, 20])
    other_effects = other_effects | ({"bottom_wall": {}} if name == "lid" else {})
    material = {"restitution": 1.0, "roughness": 0.5, "period": 1.7}
    material |= {} if name == "shaken_walls" else {"wave": "sine"}
    new, old, late = (
        displacements_of(other_effects | {name: material | stroke}, box, name)
        for stroke in (
            {"half_stroke": 1.5},
            {"amplitude": amplitude},
            {"half_stroke": 1.5, "phase": 0.25},
        )
    )
    assert (new == old).all() and (new.min(), np.ptp(new)) == pytest.approx((lowest, 3.0))
    assert late == pytest.approx(np.roll(new, -100), abs=1e-12)


@pytest.mark.slow
def test_a_phase_of_shaken_walls_is_a_start_in_the_middle_of_a_period():
    """The same 200 collisions as of a brute force that starts at the later time."""
    experiment = settings("shaken", 16, [14, 14], shaken_walls={"period": 1.7})
    _, world = scene_of(experiment, 0.9, 0.2)
    experiment["effects"]["shaken_walls"]["phase"] = 0.3
    scene, state = begin(experiment, 0.9, 0.2, 5)
    for _ in range(20):
        shot = snapshot(state, scene)
        brute = brute_force_from(world, shot._replace(time=shot.time + 0.3 * 1.7))
        run(state, scene, 1, collisions=10)
        brute.run(10)
        shot = snapshot(state, scene)
        assert shot.velocity == pytest.approx(brute.v, abs=1e-8)
        assert shot.spin == pytest.approx(brute.w[:, -shot.spin.shape[1] :], abs=1e-8)


TINY = {"amplitude": 1e-5, "period": 1e-9}
FASTEST = {"left_wall": {"temperature": 1e8}, "lid": TINY}
SLOWEST = {"left_wall": {"temperature": 1e-300}, "lid": {"amplitude": 1e-300}}


@pytest.mark.parametrize(("walls", "lowest_hits"), [(FASTEST, 1000), (SLOWEST, 0)])
def test_runs_with_extreme_walls_end(walls, lowest_hits):
    """The hottest thermal wall and the fastest legal sine, and walls that hardly move.

    A search by small steps would not return.
    """
    scene, state = begin(settings("container", 12, [14, 16], **walls), 0.9, 0.2)
    run(state, scene, 1, interval=1.0)
    assert state.clock[BASE] + state.clock[NOW] == pytest.approx(1.0)
    assert state.counts[BOUNDARY_HITS] >= lowest_hits


def test_initial_positions_are_checked_against_every_wall():
    scene = build(closed(KERNELS["container"]["effects"], [20, 20]), 0.9, 0.0)
    check_positions(scene, np.array([[1.0, 1.0]]), 0.0)
    check_positions(scene, np.array([[19.0, 19.0]]), 0.0)
    with pytest.raises(InputError, match=r"= 19\.0: must lie in \[1, 18\]"):
        check_positions(scene, np.array([[10.0, 19.0]]), 1.0)  # the lid is at the end of its stroke
    with pytest.raises(InputError, match=r"= 0\.9: must lie in \[1, 19\]"):
        check_positions(scene, np.array([[0.9, 10.0]]), 0.0)
