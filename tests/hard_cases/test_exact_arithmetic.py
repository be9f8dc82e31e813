"""Beside exact arithmetic."""

import numpy as np
import pytest
from brute_force import begin, run, scene_of, settings
from exact import segment

TWO = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 1.5, "mass": 6.0, "inertia": 0.25}]
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
    "mixture": (settings("gas", 8, [14, 13]) | {"species": TWO}, 1.0, 1.0, 9),
    "viscoelastic gas": (settings("viscoelastic", 8, [12, 11]), 0.9, 1.0, 8),
    "spheres": (settings("spheres", 8, [6, 6.5, 7]), 1.0, 1.0, 7),
}
COLD = {"cooling gas", "viscoelastic gas"}
STEADY = [name for name in SCENES if name not in COLD]
SMALL = 1e-6  # separation up to which it only grows, without a say in who meets whom
# The kernel rounds a few times where the prediction does so once, and the ratio of the two is
# that of one normal deviate to the root mean square of eight, which is above 10 once in 100,000.
ROUNDINGS = 10.0


def compare(margins, name, state, scene, world, collisions):
    """Segment after segment, each from where the kernel stands, until so many collisions."""
    segments, compared = [], 0
    while compared < collisions:
        segments.append(segment(state, scene, world))
        compared += len(segments[-1].separation) + 1
    tried = {"tried": compared, "unit": "collisions"}
    what = f"{name}: separation, over what roundings make of themselves"
    margins.at_most(what, max(one.ratio(SMALL) for one in segments), ROUNDINGS, **tried)
    return segments, tried


@pytest.mark.parametrize("name", SCENES)
def test_separates_from_exact_arithmetic_as_chaos_demands(name, margins):
    """Thousands of collisions, the exact simulation beginning anew where pairs begin to differ.

    A pair misses by less than the separation s in about one of 1/s collisions. Over thousands of
    them pairs may first differ at 1e-3, and at 1e-6 once in a thousand runs of all scenes.
    """
    *point, seed = SCENES[name]
    scene, world = scene_of(*point)
    _, state = begin(*point, seed)
    most = 400 if name in COLD else 10_000  # a cold one only moves as a whole
    collisions = min(most, margins.size(quick=120, full=10_000))
    segments, tried = compare(margins, name, state, scene, world, collisions)
    first = min(one.parted for one in segments)
    margins.at_least(f"{name}: separation from which pairs differ", first, SMALL, **tried)
    one = segments[0]
    margins.keep(
        f"separation, {name}",
        collision=np.arange(1, len(one.separation) + 1),
        kernel=one.separation,
        expected=one.expected,
    )


@pytest.mark.parametrize("name", STEADY)
def test_an_old_gas_is_as_close_to_exact_arithmetic(name, margins):
    """The exact simulation begins where the kernel is after so many collisions."""
    *point, seed = SCENES[name]
    scene, world = scene_of(*point)
    _, state = begin(*point, seed)
    age = margins.size(quick=100_000, full=5_000_000)
    while state.counts[0] < age:
        run(state, scene, 1, collisions=age - int(state.counts[0]))
    compare(margins, name, state, scene, world, margins.size(quick=60, full=1000))
