"""Long times."""

import numpy as np
from brute_force import Beside, begin, run, scene_of, settings

from roughgas.kernel.state import BASE, COLLISIONS, NOW
from roughgas.simulation.restart import arrays_of

LATE = 1_000_000_000  # T: a whole number of strokes, and of times in which images come round
SCENES = {
    "gas": settings("gas"),
    "gas in cells": settings("gas", 1000, [120, 120]),
    "sheared gas": settings("sheared"),
    "sheared gas in cells": settings("sheared", 1000, [100, 100]),
    "bed": settings("bed"),
    "bed between walls": settings("walled"),
    "spheres": settings("spheres"),
}
ROUNDING = 2.0**-53
PER_SAMPLE = 10_000  # collisions
SEGMENTS, SEGMENT = 20, 40  # comparisons with the brute force, and collisions in each


def test_an_offset_of_the_clock_changes_no_bit(margins):
    collisions = margins.size(quick=2000, full=500_000)
    changed, coarsest = 0, 0.0
    scenes = {name: one for name, one in SCENES.items() if margins.full or name != "gas in cells"}
    for experiment in scenes.values():
        early, late = (_after(experiment, collisions, start) for start in (0.0, float(LATE)))
        late.clock[BASE] -= LATE
        changed += _differing_bytes(early, late)
        coarsest = max(coarsest, np.spacing(np.abs(late.trajectory[:, -1]).max()))
    tried = {"tried": len(scenes) * collisions, "unit": "collisions"}
    margins.at_most("bytes of the state that differ after a start at 1e9 T", changed, 0, **tried)
    # spans are tens or hundreds of T; absolute times would be 1e-7 T apart
    margins.at_most("spacing of the particles' times at 1e9 T, in T", coarsest, 1e-11, **tried)


def _after(experiment, collisions, start):
    # what nothing drives keeps its energy: a gas that cools would soon outlive 1e9 T by far
    driven = {"shear", "floor"} & set(experiment["effects"])
    scene, state = begin(experiment, *((0.9, 0.2) if driven else (1.0, 1.0)))
    state.clock[BASE] = start
    run(state, scene, collisions // 100, collisions=100)
    return state


def _differing_bytes(one, other):
    pairs = zip(arrays_of(one), arrays_of(other), strict=True)
    kept = [(a, b) for (name, a), (_, b) in pairs if name != "log.rows"]  # times since the start
    return sum(np.sum(_bytes(a) != _bytes(b)) for a, b in kept)


def _bytes(array):
    return np.ascontiguousarray(array).reshape(-1).view(np.uint8)


def test_a_billion_collisions_wear_nothing_out(margins):
    collisions = margins.size(quick=500_000, full=1_000_000_000)
    # the quickest of all: a few smooth elastic disks
    experiment = settings("smooth", 16, [14, 14])
    scene, world = scene_of(experiment, 1.0, -1.0)
    _, state = begin(experiment, 1.0, -1.0)
    beside = Beside(state, scene, world)
    before = _agreement(beside)
    energy = _energies(state, scene, collisions)
    time = state.clock[BASE] + state.clock[NOW]
    mean_free = 0.5 * len(state.changes) * time / state.counts[COLLISIONS]
    drift = np.abs(energy / energy[0] - 1.0).max()
    tried = {"tried": state.counts[COLLISIONS], "unit": "collisions"}
    resolution = np.spacing(np.abs(state.trajectory[:, -1]).max()) / mean_free
    margins.at_most("spacing of times, in mean free times", resolution, 1e-14, **tried)
    # n errs by a rounding or two in its length, which next to 2 a go in one direction, so that each
    # contact changes the energy by (n.n - 1) g_n^2, on average 4 E/N
    most = collisions * 3.0 * ROUNDING * 4.0 / len(state.changes)
    margins.at_most("relative drift of the energy", drift, most, **tried)
    state.clock[BASE] = 0.0  # which only the books know: the brute force would lose digits with it
    after = _agreement(beside)
    tried = {"tried": SEGMENTS, "unit": f"segments of {SEGMENT} collisions"}
    what = "difference from brute force, in that expected, "
    margins.at_most(what + "at first", before, 3.0, **tried)
    margins.at_most(what + "at the end", after, 3.0, **tried)


def _energies(state, scene, collisions):
    """Energy every PER_SAMPLE collisions, for so many collisions, in legs that fit in memory."""
    left, found = collisions // PER_SAMPLE, []
    while left > 0:
        rows = run(state, scene, min(left, 1000), collisions=PER_SAMPLE)
        found.append(rows["vv_x"] + rows["vv_y"])
        left -= 1000
    return np.concatenate(found)


def _agreement(beside):
    """Difference from the brute force, over what roundings at its start make of themselves.

    A median over segments: in one or the other a grazing contact multiplies either.
    """
    differences = np.array([beside.segment(SEGMENT) for _ in range(SEGMENTS)])
    return np.median(differences[:, 0] / differences[:, 1])
