"""Walls on single sides of the box: at rest, moving, shaken along their normal, thermal."""

import math

import numpy as np
import pytest
from brute_force import KERNELS, Beside, begin, run, scene_of, settings
from brute_force.sides import ALIKE, Side

from roughgas.base import InputError
from roughgas.effects import floor, piston, sine_floor, thermal_wall, triangular_floor
from roughgas.scene import build
from roughgas.scene.initial import check_places
from roughgas.simulation.energy_balance import balance

DISKS = {"spin": {"inertia": 0.5}}
BED = DISKS | {
    "gravity": {"acceleration": 1.0},
    "floor": {"amplitude": 1.0, "period": 1.0, "restitution": 1.0, "roughness": -1.0},
}
SHAKEN = {"amplitude": 1.0, "period": 1.7}


def closed(effects, box, particles=12):
    return {"particles": particles, "box": box, "effects": effects}


# ---------------------------------------------------------------------- collision by collision

WITH_PISTONS = DISKS | {
    "bottom_wall": SHAKEN | {"restitution": 0.9},
    "lid": SHAKEN | {"wave": "triangle", "period": 1.0},
}
UNDER_A_LID = BED | {
    "lid": {"temperature": 3.0},
    "left_wall": {"velocity": 2.0, "roughness": 0.4},
    "right_wall": {"shaken": "along", "wave": "triangle", "roughness": 0.4} | SHAKEN,
}
TWO = [
    {"fraction": 0.5},
    {"fraction": 0.5, "radius": 1.5, "mass": 5.0, "inertia": 0.25, "roughness": -0.5},
]
IN_SPACE = KERNELS["closed spheres"]["effects"]
CASES = {
    # experiment, r, beta, seed
    "one of each kind": (settings("container", 12, [12, 14]), 0.95, 0.2, 1),
    "pistons": (closed(WITH_PISTONS, [14, 16]), 0.95, 0.2, 1),
    "under a lid": (closed(UNDER_A_LID, [14, 16]), 0.95, 0.2, 1),
    "under an inelastic lid": (
        closed(BED | {"lid": {"restitution": 0.8, "roughness": 0.3}}, [14, 12]),
        0.95,
        0.2,
        1,
    ),
    "two species": (settings("container", 12, [14, 16]) | {"species": TWO}, 0.95, 0.2, 1),
    "in space": (settings("closed spheres", 12, [8, 9, 10]), 0.95, 0.2, 1),
}


@pytest.mark.parametrize(
    "name",
    [pytest.param(one, marks=[pytest.mark.slow] * (one != "one of each kind")) for one in CASES],
)
def test_the_kernel_makes_the_same_collisions(name):
    """Beside brute force; every wall is met, and thermal walls draw the same random numbers."""
    *point, seed = CASES[name]
    scene, world = scene_of(*point)
    _, state = begin(*point, seed)
    beside = Beside(state, scene, world)
    beside.assert_same(40, 10)
    assert {side.name for side in world.sides} <= set(beside.events)


# ---------------------------------------------------------------------- when walls are met

SOLVERS = {
    "sawtooth": (floor.Floor, {}, floor.time_to_floor),
    "reversed_sawtooth": (triangular_floor.TriangularFloor, {"rise": 0.1}, None),
    "triangle": (triangular_floor.TriangularFloor, {"rise": 0.5}, None),
    "sine": (sine_floor.SineFloor, {}, sine_floor.time_to_floor),
}


@pytest.mark.parametrize("wave", SOLVERS)
@pytest.mark.parametrize("weight", [0.0, -0.7, 0.9])
def test_strokes_are_met_as_brute_force_finds_them(wave, weight):
    """Particles that nothing pulls, or gravity towards the wall, or away from it."""
    kind, more, solve = SOLVERS[wave]
    solve = solve or (lambda *way: triangular_floor.time_to_floor(*way)[0])
    motion = kind(amplitude=1.5, period=1.1, restitution=1.0, roughness=-1.0, **more)
    moving = ALIKE | {"amplitude": 1.5, "period": 1.1, "wave": wave}
    side, rng, met = Side("lid", 0, 1.0, 0.0, 0, moving), np.random.default_rng(1), 0
    for _ in range(6):
        gap, speed, phase = 1.5 + rng.uniform(0, 2), rng.normal() - 1.5, rng.uniform(0, 1.1)
        found, expected = solve(motion, weight, gap, speed, phase), math.inf
        time, step = 0.0, 0.5
        while time < 4.0 and math.isinf(expected):
            here = gap + speed * time - weight * time**2 / 2
            wait = side.wait(here, speed - weight * time, weight, phase + time, step)
            expected = time + wait
            time += step
        if math.isfinite(expected):
            met += 1
            assert found == pytest.approx(expected, abs=1e-9)
        else:
            assert found > 3.9
    assert met > 1


# ---------------------------------------------------------------------- energy, places


def test_the_books_close_wall_by_wall():
    """What each wall has put in is all that was gained, to rounding."""
    scene, state = begin(settings("container", 40, [25, 25]), 0.9, 0.3, 2)
    begun = balance(state, scene)
    run(state, scene, 1, collisions=3000)
    now = balance(state, scene)
    booked, gain = now.ledger - begun.ledger, now.energy - begun.energy
    assert booked.sum(axis=0) == pytest.approx(gain, abs=1e-11 * np.abs(booked).sum())
    assert np.all(np.abs(booked[1:]).sum(axis=1) > 1.0)  # four walls and the contacts


def test_initial_places_are_checked_against_every_wall():
    scene = build(closed(KERNELS["container"]["effects"], [20, 20]), 0.9, 0.0)
    check_places(scene, np.array([[1.0, 1.0]]), 0.0)
    check_places(scene, np.array([[19.0, 19.0]]), 0.0)
    with pytest.raises(InputError, match=r"= 19\.0: must lie in \[1, 18\]"):
        check_places(scene, np.array([[10.0, 19.0]]), 1.0)  # the lid is at the end of its stroke
    with pytest.raises(InputError, match=r"= 0\.9: must lie in \[1, 19\]"):
        check_places(scene, np.array([[0.9, 10.0]]), 0.0)


# ---------------------------------------------------------------------- what settings mean

LID = DISKS | {"bottom_wall": {}}
REFUSED = {
    "effects.lid needs bottom_wall": DISKS | {"lid": {}},
    "effects.front_wall = in the plane: must be bottom_wall or lid there": {"front_wall": {}},
    "effects.lid.restitution = 0.5: must not be given where the wall has a temperature": LID
    | {"lid": {"temperature": 1.0, "restitution": 0.5}},
    "effects.lid.period = (nothing): must be given where the wall is shaken": LID
    | {"lid": {"amplitude": 1.0}},
    "effects.lid.velocity = 1.0: must be 0 where the wall is shaken": LID
    | {"lid": SHAKEN | {"velocity": 1.0}},
    "effects.lid.temperature = 0: must be a number in (0, 1e+08]": LID
    | {"lid": {"temperature": 0}},
    "effects = walls and left_wall: must not close the same axis twice": DISKS
    | {"walls": {"restitution": 1, "roughness": 1}, "left_wall": {}, "right_wall": {}},
    "effects = bottom_wall and shear: must not close the axis along which images slide past each "
    "other": LID | {"lid": {}, "shear": {"velocity": 1.0}},
    "box[1] = 20.0: must be a number of at least 20.01": LID | {"lid": SHAKEN | {"amplitude": 18}},
}


@pytest.mark.parametrize("message", REFUSED)
def test_what_is_refused(message):
    with pytest.raises(InputError) as caught:
        build(closed(REFUSED[message], [20, 20]), 0.9, 0.0 if "spin" in REFUSED[message] else -1.0)
    assert str(caught.value) == message


def test_a_bottom_wall_under_gravity_is_a_floor():
    with pytest.raises(InputError, match=r"bottom_wall = with gravity: must be a floor there"):
        build(closed(BED | {"bottom_wall": {}, "lid": {}}, [20, 20]), 0.9, 0.0)
    with pytest.raises(InputError, match=r"lid needs a length"):
        build(closed(BED | {"lid": {}}, [20, "open"]), 0.9, 0.0)


def test_walls_are_what_their_parameters_say():
    chosen = closed(IN_SPACE | {"lid": SHAKEN | {"wave": "sine"}}, [8, 9, 10])
    effects = build(chosen, 0.9, 0.0).effects
    assert effects.front_wall == thermal_wall.ThermalWall((1, 1.0, 0.0, 0), 2.0, -0.5)
    assert effects.back_wall.place == (1, -1.0, 9.0, 0) and effects.back_wall.velocity == 1.0
    assert effects.bottom_wall == ((2, 1.0, 0.0, 0), 0.9, -1.0)
    assert build(closed(IN_SPACE, [8, 9, 10]), 0.9, 0.0).effects.lid.rise == 0.0
    assert isinstance(effects.lid, piston.SinePiston) and effects.lid.place[:3] == (2, -1.0, 10.0)
