"""The simulation in fifty digits is right to nearly all of them."""

import numpy as np
import pytest
from brute_force import KERNELS, BruteForce, begin, compare, scene_of, settings, snapshot

from exact import exactly

TWO = [
    {"fraction": 0.5, "restitution": 0.9},
    {"fraction": 0.5, "radius": 1.5, "mass": 5.0, "inertia": 0.25, "roughness": -0.5},
]
SLIDING = {
    "spin": {"inertia": 0.5},
    "left_wall": {"velocity": 0.7, "roughness": 0.5},
    "right_wall": {"restitution": 0.9, "roughness": 1.0},
    "bottom_wall": {"velocity": -1.0, "roughness": 0.8},
    "lid": {"velocity": 1.0, "restitution": 0.8},
}
UNDER_A_LID = KERNELS["bed"]["effects"] | {"lid": {"restitution": 0.8, "roughness": 0.5}}
UNDER_A_LID.pop("contact_averages")
CASES = {
    # experiment, r, beta
    "gas": (settings("gas", 8, [12, 11]), 0.98, 0.2),
    "smallest box": (settings("gas", 3, [4.01, 8.0]), 0.99, 0.5),
    "smooth gas": (settings("smooth", 8, [12, 11]), 0.98, -1.0),
    "sheared": (settings("sheared", 8, [12, 11], shear={"velocity": 3.7}), 0.9, 0.2),
    "fast shear": (settings("sheared", 6, [9, 11], shear={"velocity": 50.0}), 0.9, 0.2),
    "bed": (settings("bed", 8, [9, "open"]), 0.8, 0.2),
    "walled": (settings("walled", 8, [9, "open"], contact_time={"duration": 0.05}), 0.8, 0.2),
    "spheres": (settings("spheres", 8, [6, 6.5, 7]), 0.98, 0.2),
    "two species": (settings("gas", 8, [14, 13]) | {"species": TWO}, 0.98, 0.2),
    "bed of two species": (settings("bed", 8, [12, "open"]) | {"species": TWO}, 0.8, 0.2),
    "viscoelastic": (settings("viscoelastic", 8, [12, 11], threshold={"speed": 0.2}), 0.8, 0.2),
    "sliding walls": ({"particles": 8, "box": [9, 10], "effects": SLIDING}, 0.9, 0.2),
    "sliding walls, two species": (
        {"particles": 8, "box": [12, 13], "effects": SLIDING, "species": TWO},
        0.9,
        0.2,
    ),
    "under a lid": ({"particles": 8, "box": [9, 14], "effects": UNDER_A_LID}, 0.9, 0.2),
    "tabulated": (settings("tabulated bed", 8, [9, "open"], floor={"restitution": 0.9}), 0.8, 0.2),
}


def start(experiment, r, beta, seed):
    """Return the exact simulation and the brute force of the same initial state."""
    scene, world = scene_of(experiment, r, beta)
    _, state = begin(experiment, r, beta, seed)
    shot = snapshot(state, scene)
    brute = BruteForce(world, shot.position, shot.velocity, shot.spin, bodies=shot.bodies)
    return exactly(state, scene, world), brute


@pytest.mark.parametrize("name", CASES)
def test_brute_force_makes_the_same_events(name):
    """Twenty collisions from each of three starts; differences are amplified rounding errors."""
    for seed in range(3):
        exact, brute = start(*CASES[name], seed)
        for _ in range(20):
            events, brute_events = exact.run(1), brute.run(1)
            assert [event[:3] for event in events] == [
                brute_event[1:] for brute_event in brute_events
            ]
        shot = as_snapshot(exact, brute.snapshot())
        assert compare(shot, brute) < 1e-7


def as_snapshot(exact, like):
    floats = [np.array(numbers, float) for numbers in (exact.x, exact.v, exact.w)]
    x, v, w = floats
    dimension = like.position.shape[1]
    spin = w[:, 6 - 2 * dimension :]
    return like._replace(
        time=float(exact.time), position=x[:, :dimension], velocity=v[:, :dimension], spin=spin
    )
