"""Beside exact arithmetic."""

import numpy as np
import pytest
from brute_force import begin, run, scene_of, settings
from exact import segment
from slow_cases import slow_but

TWO_SPECIES = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 1.5, "mass": 6.0, "inertia": 0.25}]
WALLED = {
    "floor": {"restitution": 0.9, "roughness": 0.5},
    "walls": {"restitution": 0.7, "roughness": -0.4},
    "contact_time": {"duration": 0.05},
}
SCENES = {
    # experiment, r, beta, seed
    "gas": (settings("gas", 8, [12, 11]), 1.0, 1.0, 1),
    "cooling gas": (settings("gas", 8, [12, 11]), 0.9, 0.2, 2),
    "smooth gas": (settings("smooth", 8, [12, 11]), 1.0, -1.0, 3),
    "sheared gas": (settings("sheared", 8, [12, 11], shear={"velocity": 3.7}), 0.9, 0.2, 4),
    "bed": (settings("bed", 8, [9, "open"], floor={"amplitude": 2.0}), 0.9, 0.2, 5),
    "bed between walls, contact time": (settings("walled", 8, [9, "open"], **WALLED), 0.8, 0.2, 6),
    "mixture": (settings("gas", 8, [14, 13]) | {"species": TWO_SPECIES}, 1.0, 1.0, 9),
    "viscoelastic gas": (settings("viscoelastic", 8, [12, 11]), 0.9, 1.0, 8),
    "spheres": (settings("spheres", 8, [6, 6.5, 7]), 1.0, 1.0, 7),
}
COOLING_SCENES = {"cooling gas", "viscoelastic gas"}
LASTING_SCENES = [name for name in SCENES if name not in COOLING_SCENES]
SMALL_SEPARATION = 1e-6  # separation below which both simulations make the same collisions
# The kernel rounds a few times for each rounding of the prediction, and their ratio is that of a
# normal deviate to the root mean square of eight, which exceeds 10 once in 100,000.
ROUNDINGS = 10.0


def compare(margins, name, state, scene, world, collisions):
    """Compare segments, each from the kernel's state, up to a total number of collisions."""
    segments, compared = [], 0
    while compared < collisions:
        segments.append(segment(state, scene, world))
        compared += len(segments[-1].separation) + 1
        margins.progress.reach(compared, collisions, "collisions")
    tried = {"tried": compared, "unit": "collisions"}
    quantity = f"{name}: separation, over what roundings make of themselves"
    margins.at_most(
        quantity,
        max(each_segment.ratio(SMALL_SEPARATION) for each_segment in segments),
        ROUNDINGS,
        **tried,
    )
    return segments, tried


@pytest.mark.parametrize(
    "name", slow_but({"cooling gas", "sheared gas", "bed", "mixture", "spheres"}, SCENES)
)
def test_the_kernel_separates_from_exact_arithmetic_by_chaos_alone(name, margins):
    """Thousands of collisions; the exact simulation starts anew once pairs differ.

    In about one of 1/s collisions, the pair misses by less than the separation s. Over thousands of
    collisions pairs may first differ at 1e-3, and at 1e-6 once in a thousand runs of all scenes.
    """
    *point, seed = SCENES[name]
    scene, world = scene_of(*point)
    _, state = begin(*point, seed)
    collision_limit = 400 if name in COOLING_SCENES else 10_000  # a cold gas moves as a lump
    collisions = min(collision_limit, margins.size(quick=120, full=10_000))
    segments, tried = compare(margins, name, state, scene, world, collisions)
    first = min(each_segment.parted for each_segment in segments)
    margins.at_least(
        f"{name}: separation from which pairs differ", first, SMALL_SEPARATION, **tried
    )
    first_segment = segments[0]
    margins.keep(
        f"separation, {name}",
        collision=np.arange(1, len(first_segment.separation) + 1),
        kernel=first_segment.separation,
        expected=first_segment.expected,
    )


@pytest.mark.parametrize("name", slow_but({"bed", "sheared gas"}, LASTING_SCENES))
def test_an_old_gas_is_as_close_to_exact_arithmetic(name, margins):
    """The exact simulation starts from the kernel's state after many collisions."""
    *point, seed = SCENES[name]
    scene, world = scene_of(*point)
    _, state = begin(*point, seed)
    age = margins.size(quick=100_000, full=5_000_000)
    while state.counts[0] < age:
        run(state, scene, 1, collisions=age - int(state.counts[0]))
    compare(margins, name, state, scene, world, margins.size(quick=60, full=1000))
