"""Densities and boxes."""

import math

import numpy as np
import pytest
from brute_force import Comparison, begin, largest_overlap, run, scene_of, settings
from raw import build, check, run_point
from schedules import COOLING, STEADY

from roughgas.base import InputError

DISKS = (0.001, 0.01, 0.1, 0.3, 0.5, 0.7, 0.8)  # shares of the area
SPHERES = (0.001, 0.01, 0.1, 0.3, 0.5, 0.6)  # shares of the volume
ROUNDING = 2.0**-53
FLOOR_AT_REST = {"floor": {"amplitude": 0.0}}  # the gas on it keeps its energy
BETWEEN_WALLS = FLOOR_AT_REST | {"walls": {"restitution": 1.0, "roughness": -1.0}}


def lossless(kernel, particles, box, **effects):
    """An elastic smooth (experiment, r, beta), which neither collapses nor comes to rest."""
    return settings(kernel, particles, box, **effects), 1.0, -1.0


def check_run(margins, scenes, collisions):
    """Run each (experiment, r, beta), and measure overlaps and distances outside the box."""
    overlap = outside = 0.0
    for experiment, r, beta in scenes:
        scene, world = scene_of(experiment, r, beta)
        _, state = begin(experiment, r, beta, 1)
        run(state, scene, collisions // 50, collisions=50)
        size = max(np.ptp(state.trajectory[:, k]) for k in range(len(scene.box))) + scene.extent
        # positions are sums of lengths up to the size of the box, and overlaps squares of 2 a
        overlap = max(overlap, largest_overlap(state, scene, world) / (ROUNDING * size))
        outside = max(outside, _outside(state, experiment) / (ROUNDING * size))
        assert np.isfinite(state.trajectory).all() and state.counts[0] >= collisions
    tried = {"tried": len(scenes) * collisions, "unit": "collisions"}
    margins.at_most("overlap of two particles, in roundings of the box", overlap, 30.0, **tried)
    margins.at_most("way out of the box, likewise", outside, 30.0, **tried)


def _outside(state, experiment):
    """Greatest distance of a particle outside its box at its last event."""
    farthest = 0.0
    for axis, length in enumerate(experiment["box"]):
        x, edge = state.trajectory[:, axis], 0.0
        if axis == 0 and "walls" in experiment["effects"]:
            edge = 1.0
        above = -math.inf if length == "open" else np.max(x) - (length - edge)
        farthest = max(farthest, above, edge - np.min(x))
    return farthest


def check_against_brute_force(margins, scenes, segments, collisions):
    """Compare each (experiment, r, beta) with the brute force.

    The limit, as in Comparison.assert_same, is some hundred times the growth of roundings at the
    start of a segment, since grazing contacts multiply single errors.
    """
    largest_ratio = 0.0
    for experiment, r, beta in scenes:
        scene, world = scene_of(experiment, r, beta)
        _, state = begin(experiment, r, beta, 1)
        comparison = Comparison(state, scene, world)
        differences = np.array([comparison.segment(collisions) for _ in range(segments)])
        largest_ratio = max(
            largest_ratio, np.max(differences[:, 0] / (1e-12 + 300.0 * differences[:, 1]))
        )
    tried = {"tried": len(scenes) * segments, "unit": f"segments of {collisions} collisions"}
    margins.at_most(
        "difference from brute force, over what is tolerated", largest_ratio, 1.0, **tried
    )


@pytest.mark.slow
def test_gases_of_any_density_run_without_overlap(margins):
    collisions = margins.size(quick=2000, full=500_000)
    disks = [lossless("gas", 160, [math.sqrt(160 * math.pi / share)] * 2) for share in DISKS]
    volume = 4.0 * math.pi / 3.0
    spheres = [lossless("spheres", 108, [(108 * volume / s) ** (1 / 3)] * 3) for s in SPHERES]
    refused = sum(not _fits(experiment) for experiment, _, _ in disks + spheres)
    margins.at_most("densities refused", refused, 0, len(disks + spheres), "densities")
    check_run(margins, disks + spheres, collisions)
    segments = margins.size(quick=1, full=5)
    check_against_brute_force(margins, [disks[0], disks[-1], spheres[0], spheres[-1]], segments, 10)


FAST_SHEAR = {"shear": {"velocity": 50.0}}  # images slide past each other faster than particles fly


def _fits(experiment):
    """Whether an initial state fits into the box."""
    try:
        check(experiment)
    except InputError:
        return False
    return True


NARROW = {
    "sheared": [
        (settings("sheared", 30, [60, 4.1], **FAST_SHEAR), 0.9, 0.2),
        (settings("sheared", 30, [4.1, 60], **FAST_SHEAR), 0.9, 0.2),
    ],
    "gas": [
        lossless("gas", 3, [4.01, 4.01]),
        lossless("gas", 8, [5, 9]),
        lossless("gas", 30, [4.1, 60]),
    ],
    "bed": [lossless("bed", 8, [4.1, "open"], **FLOOR_AT_REST)],
    "spheres": [lossless("spheres", 12, [4.2, 4.2, 20])],
}


@pytest.mark.parametrize("kernel", NARROW)
def test_gases_in_narrow_boxes_stay_inside_without_overlap(margins, kernel):
    check_run(margins, NARROW[kernel], margins.size(quick=1000, full=20_000))
    check_against_brute_force(margins, NARROW[kernel], margins.size(quick=2, full=10), 10)


def test_particles_in_narrow_channels_stay_inside(margins):
    scenes = [lossless("walled", 4, [W, "open"], **BETWEEN_WALLS) for W in (2.05, 3.0, 3.99, 4.2)]
    check_run(margins, scenes, margins.size(quick=1000, full=20_000))
    check_run(margins, [lossless("walled", 3, [2.01, "open"], **BETWEEN_WALLS)], 100)
    check_against_brute_force(margins, scenes[1:], margins.size(quick=2, full=10), 10)


@pytest.mark.slow
def test_gases_in_long_boxes_stay_inside_without_overlap(margins):
    collisions = margins.size(quick=2000, full=200_000)
    scenes = [
        lossless(kernel, 160, box)
        for kernel in ("gas", "sheared")
        for box in ([10.0, 1000.0], [1000.0, 10.0])
    ]
    scenes.append(lossless("gas", 600, [720.0, 12.0]))  # too narrow for cells
    scenes.append(lossless("bed", 160, [1000.0, "open"], **FLOOR_AT_REST))
    check_run(margins, scenes, collisions)
    check_against_brute_force(margins, scenes[:4], margins.size(quick=1, full=5), 10)


SCENES_OF_FEW = {
    "a gas": settings("gas", 1, [10, 10]) | {"schedule": COOLING},
    "under shear": settings("sheared", 1, [10, 10]) | {"schedule": STEADY},
    "in a bed": settings("bed", 1, [10, "open"]) | {"schedule": STEADY},
}


def test_one_to_three_particles_give_numbers_or_are_refused(margins):
    points = without_numbers = refused = 0
    for gas in SCENES_OF_FEW.values():
        for number in (1, 2, 3):
            for r, beta in ((0.9, 0.2), (0.5, -0.5), (1.0, 1.0)):
                experiment = gas | {"particles": number}
                try:
                    variables = run_point(build(experiment, r, beta), experiment, 1).variables
                except InputError:
                    assert number == 1
                    refused += 1
                    continue
                points += 1
                without_numbers += not all(
                    np.isfinite(variables[x]) for x in ("R", "R_stderr", "E_trans")
                )
    margins.at_most("points without a number", without_numbers, 0, points, "points")
    margins.at_most("points refused: those of one undriven particle", refused, 6, points, "points")
