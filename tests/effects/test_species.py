"""Species: particles of several radii, masses, moments of inertia and materials."""

import pytest
from brute_force import Beside, begin, scene_of, settings

ALIKE = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 1, "mass": 1.0}]
UNLIKE = [
    {"name": "small", "fraction": 0.5, "radius": 0.7, "restitution": 0.95},
    {"name": "large", "fraction": 0.25, "radius": 1.5, "mass": 7.0, "roughness": 0.6},
    {"fraction": 0.25, "mass": 0.01, "inertia": 0.2},
]
PAIRS = [{"between": ["small", 2], "restitution": 0.8, "roughness": -0.3}]
RUBBED = [one | {"mu": 0.1 * (k + 1)} for k, one in enumerate(UNLIKE)]


def of_species(kernel, particles, box, species=UNLIKE, pairs=PAIRS, **effects):
    return settings(kernel, particles, box, **effects) | {
        "species": species,
        "species_pairs": pairs,
    }


SMOOTH = [{"fraction": 0.5, "radius": 0.5}, {"fraction": 0.5, "radius": 1.5}]
CASES = {
    # experiment, r, beta, seed
    "gas": (of_species("gas", 8, [14, 14]), 0.98, 0.2, 1),
    "smallest box": (of_species("gas", 3, [6.02, 9.0]), 0.99, 0.5, 2),
    "smooth gas": (of_species("smooth", 8, [14, 14], SMOOTH, []), 0.98, -1.0, 5),
    "sheared": (of_species("sheared", 8, [14, 14]), 0.9, 0.2, 6),
    "bed": (of_species("bed", 16, [12, "open"]), 0.8, 0.2, 9),
    "bed between walls, friction": (
        of_species(
            "rubbed bed", 16, [14, "open"], RUBBED, [*PAIRS, {"between": [0, 1], "mu": 0.4}]
        ),
        0.8,
        0.2,
        12,
    ),
    "between shaken walls": (of_species("shaken", 12, [14, 14]), 0.95, 0.2, 16),
    "heated": (of_species("heated", 12, [16, 16]), 0.9, 0.2, 17),
    "spheres, contact time": (
        of_species("spheres", 12, [9, 9, 9], contact_time={"duration": 0.05}),
        0.95,
        0.2,
        14,
    ),
}
RARE = {"smallest box", "smooth gas", "sheared", "between shaken walls", "spheres, contact time"}


@pytest.mark.parametrize(
    "case", [pytest.param(case, marks=[pytest.mark.slow] * (case in RARE)) for case in CASES]
)
def test_the_kernel_makes_the_same_collisions(case):
    """The same 200 pairs in the same order as a slow simulation makes."""
    *point, seed = CASES[case]
    scene, world = scene_of(*point)
    _, state = begin(*point, seed)
    beside = Beside(state, scene, world)
    beside.assert_same(20, 10)
    if world.floor:
        assert beside.events["floor"] > 2
    if world.walls:
        assert beside.events["left"] > 2 and beside.events["right"] > 2
