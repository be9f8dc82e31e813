"""Long times."""

import numpy as np
import pytest
from brute_force import Comparison, begin, run, scene_of, settings

from roughgas.kernel.state import BASE, COLLISIONS, NOW
from roughgas.simulation.state_encoding import arrays_of

LATE = 1_000_000_000  # T: a multiple of the periods of the floor and of sliding images
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
    scenes = {
        name: scene for name, scene in SCENES.items() if margins.full or name != "gas in cells"
    }
    for experiment in scenes.values():
        early, late = (_state_after(experiment, collisions, start) for start in (0.0, float(LATE)))
        late.clock[BASE] -= LATE
        changed += _differing_bytes(early, late)
        coarsest = max(coarsest, np.spacing(np.abs(late.trajectory[:, -1]).max()))
    tried = {"tried": len(scenes) * collisions, "unit": "collisions"}
    margins.at_most("bytes of the state that differ after a start at 1e9 T", changed, 0, **tried)
    # spans are tens or hundreds of T; absolute times would be resolved to 1e-7 T only
    margins.at_most("spacing of the particles' times at 1e9 T, in T", coarsest, 1e-11, **tried)


def _state_after(experiment, collisions, start):
    """The state after a number of collisions of a run whose clock starts at `start`."""
    # undriven gases are elastic: a cooling gas would soon be far beyond 1e9 T
    driven = {"shear", "floor"} & set(experiment["effects"])
    scene, state = begin(experiment, *((0.9, 0.2) if driven else (1.0, 1.0)))
    state.clock[BASE] = start
    run(state, scene, collisions // 100, collisions=100)
    return state


def _differing_bytes(first, second):
    """The number of bytes in which two states differ."""
    pairs = zip(arrays_of(first), arrays_of(second), strict=True)
    compared = [
        (a, b) for (name, a), (_, b) in pairs if name != "log.rows"
    ]  # times since the start
    return sum(np.sum(_bytes(a) != _bytes(b)) for a, b in compared)


def _bytes(array):
    """The bytes of an array, flat."""
    return np.ascontiguousarray(array).reshape(-1).view(np.uint8)


@pytest.mark.slow
def test_a_billion_collisions_wear_nothing_out(margins):
    collisions = margins.size(quick=500_000, full=1_000_000_000)
    # the fastest simulation: a few smooth elastic disks
    experiment = settings("smooth", 16, [14, 14])
    scene, world = scene_of(experiment, 1.0, -1.0)
    _, state = begin(experiment, 1.0, -1.0)
    comparison = Comparison(state, scene, world)
    before = _agreement(comparison)
    energy = _energies(state, scene, collisions, margins.progress)
    time = state.clock[BASE] + state.clock[NOW]
    mean_free = 0.5 * len(state.changes) * time / state.counts[COLLISIONS]
    drift = np.abs(energy / energy[0] - 1.0).max()
    tried = {"tried": state.counts[COLLISIONS], "unit": "collisions"}
    resolution = np.spacing(np.abs(state.trajectory[:, -1]).max()) / mean_free
    margins.at_most("spacing of times, in mean free times", resolution, 1e-14, **tried)
    # the length of n is off by a rounding or two, near 2 a with the same sign, so that each contact
    # changes the energy by (n.n - 1) g_n^2, on average 4 E/N
    drift_limit = collisions * 3.0 * ROUNDING * 4.0 / len(state.changes)
    margins.at_most("relative drift of the energy", drift, drift_limit, **tried)
    state.clock[BASE] = 0.0  # only the balance depends on it: the brute force would lose digits
    after = _agreement(comparison)
    tried = {"tried": SEGMENTS, "unit": f"segments of {SEGMENT} collisions"}
    quantity = "difference from brute force, in that expected, "
    margins.at_most(quantity + "at first", before, 3.0, **tried)
    margins.at_most(quantity + "at the end", after, 3.0, **tried)


def _energies(state, scene, collisions, progress):
    """Energy every PER_SAMPLE collisions, sampled in legs that fit in memory."""
    samples_left, energies = collisions // PER_SAMPLE, []
    while samples_left > 0:
        rows = run(state, scene, min(samples_left, 1000), collisions=PER_SAMPLE)
        energies.append(rows["vv_x"] + rows["vv_y"])
        samples_left -= 1000
        progress.reach(collisions - max(samples_left, 0) * PER_SAMPLE, collisions, "collisions")
    return np.concatenate(energies)


def _agreement(comparison):
    """Difference from the brute force, over the growth of roundings at its start.

    A median over segments: in some, a grazing contact multiplies errors.
    """
    differences = np.array([comparison.segment(SEGMENT) for _ in range(SEGMENTS)])
    return np.median(differences[:, 0] / differences[:, 1])
