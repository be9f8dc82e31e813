"""Initial positions and velocities."""

import numpy as np
import pytest
from brute_force import KERNELS, begin, largest_overlap, scene_of, settings

from roughgas.scene import initial
from roughgas.scene.initial import check_positions, random_positions

CASES = {
    **{name: settings(name) for name in KERNELS},
    "two in the smallest box": settings("gas", 2, [4.01, 4.01]),
    "dense": settings("gas", 100, [20.1, 20.1]),
    "as many as fit": settings("gas", 108, [20.1, 20.1]),
    "as many spheres as fit": settings("spheres", 144, [10.1, 10.1, 10.1]),
    "narrow": settings("gas", 30, [4.5, 300]),
    "dense spheres": settings("spheres", 125, [10.1, 10.1, 10.1]),
    "one in a bed": settings("bed", 1, [10, "open"]),
    "on a floor at rest": settings("bed", floor={"amplitude": 0}),
    "narrow bed": settings("walled", 30, [4.1, "open"]),
    "single file": settings("walled", 30, [2.01, "open"]),
    "denser than a square lattice": settings("gas", 160, [25.1, 25.1]),
    "denser than a cubic lattice": settings("spheres", 247, [12, 12, 12]),
    "cells longer than wide": settings("spheres", 143, [10, 10, 10]),
    "dense and sheared": settings("sheared", 95, [40, 9.4]),
    "dense and narrow": settings("gas", 48, [5.1, 40]),
    "fast shear": settings("sheared", 40, [25, 20], shear={"velocity": 100.0}),
}


@pytest.mark.parametrize("case", CASES)
def test_particles_start_without_overlap_momentum_or_spin(case):
    experiment = CASES[case]
    for seed in range(3):
        beta = 0.0 if "spin" in experiment["effects"] else -1.0
        scene, state = begin(experiment, 0.9, beta, seed)
        _, world = scene_of(experiment, 0.9, beta)
        number, dimension = experiment["particles"], len(scene.box)
        position, velocity = np.split(state.trajectory[:, :-1], 2, axis=1)
        assert position.shape == (number, dimension)
        if number > 1:
            assert largest_overlap(state, scene, world) < 0.0
        if state.spin is not None:
            assert state.spin.shape == (number, 2 * dimension - 3) and np.all(state.spin == 0.0)
        assert np.abs(velocity.sum(axis=0) - mean_flow(scene, position).sum(axis=0)).max() < 1e-11
        assert_inside_box(experiment, position)


def mean_flow(scene, position):
    """Velocity of the mean shear flow at each position, (N, D)."""
    velocity = np.zeros_like(position)
    if scene.effects.shear:
        height = scene.box[1]
        velocity[:, 0] = scene.effects.shear.velocity * (position[:, 1] / height - 0.5)
    return velocity


def assert_inside_box(experiment, position):
    """Assert that all particles are inside the box, above the floor and between the walls."""
    effects = experiment["effects"]
    for axis, length in enumerate(experiment["box"]):
        if length != "open":
            assert np.all((position[:, axis] >= 0.0) & (position[:, axis] <= length))
    if "floor" in effects:
        assert position[:, -1].min() > 1.0 + effects["floor"]["amplitude"]
    if "walls" in effects:
        x = position[:, 0]
        assert x.min() >= 1.0 and x.max() <= experiment["box"][0] - 1.0


def test_the_temperature_is_one():
    """Of 160 disks, 20 seeds: T = <v^2>/2 per particle but one, within 4 sigma of 1."""
    squares = []
    for seed in range(20):
        scene, state = begin(settings("sheared"), 0.9, 0.0, seed)
        position, velocity = np.split(state.trajectory[:, :-1], 2, axis=1)
        squares.append(((velocity - mean_flow(scene, position)) ** 2).sum() / (2 * 159))
    assert np.mean(squares) == pytest.approx(1.0, abs=4.0 / np.sqrt(20 * 159))


SPREAD = {"distribution": "uniform", "deviation": 0.2}
BED = settings("bed")["effects"]
WALLS = {"walls": {"restitution": 1.0, "roughness": -1.0}}
CROWDED = {
    "ratio 100": ([{"number": 1, "radius": 100}, {"number": 500}], [450, 450], {}),
    "packed": ([{"number": 200, "radius": SPREAD}], [30, 30], {}),  # 0.7 of the box
    "two sizes, packed": ([{"fraction": 0.5}, {"fraction": 0.5, "radius": 2}], [70, 70], {}),
    "between walls": ([{"number": 3, "radius": 8}, {"number": 160}], [50, 50], WALLS),
    "spheres": ([{"number": 2, "radius": 6}, {"number": 500}], [30, 30, 30], {}),
    "a bed": ([{"number": 3, "radius": 8}, {"number": 160}], [50, "open"], BED),
    "a bed between walls": (
        [{"number": 2, "radius": 3}, {"number": 58, "radius": 0.3}],
        [20, "open"],
        BED | WALLS,
    ),
}


@pytest.mark.parametrize("case", CROWDED)
def test_particles_of_crowded_mixtures_start_without_overlap(case):
    species, box, effects = CROWDED[case]
    number = sum(kind.get("number", 200) for kind in species)
    experiment = {"particles": number, "box": box, "effects": effects, "species": species}
    scene, state = begin(experiment, 0.9, 0.3 if "spin" in effects else -1.0, 1)
    positions, radius = state.trajectory[:, : len(box)], state.bodies.radius
    check_positions(scene, positions, 0.0, radius)
    assert np.bincount(state.bodies.species).tolist() == [
        kind.get("number", 200) for kind in species
    ]
    if case == "packed":
        assert 0.65 < np.pi * np.sum(radius**2) / 900.0
    if case == "a bed":
        assert np.ptp(positions[:, 1]) < 250.0  # denser than a lattice of the largest


def test_a_narrow_box_with_a_periodic_axis_is_filled():
    """The first axis is periodic, the second is not; a box that is too narrow has no solution."""
    radius, rng = np.full(6, 1.0), np.random.default_rng(0)
    positions = random_positions(
        radius, [11.5, 3.5], [True, False], rng
    )  # a lattice has five sites
    assert positions[:, 1].min() >= 1.0 and positions[:, 1].max() <= 2.5
    assert random_positions(radius, [11.5, 1.6], [True, False], rng) is None


def test_particles_without_a_site_lie_between_the_walls():
    """The last of 19 particles finds no site; a random position may overlap a wall alone."""
    radius = np.array([1.5, 1.0] * 9 + [1.0])
    lengths, outside = [28.1, 6.9], 0.0
    for seed in range(40):
        position = random_positions(radius, lengths, [False, False], np.random.default_rng(seed))
        gaps = np.minimum(position, lengths - position) - radius[:, None]
        outside = min(outside, gaps.min())
    assert outside >= -1e-12


def test_a_giant_among_dwarfs_takes_no_lattice_of_dwarfs(monkeypatch):
    """A lattice of the smallest particles would have 2.5e9 sites."""
    monkeypatch.setattr(initial, "MOST_OF_A_CLASS", 40_000)
    radius = np.array([10.0, *[0.001] * 99])
    positions = random_positions(radius, [100.0, 100.0], [True, True], np.random.default_rng(1))
    separations = positions[1:] - positions[0]
    separations -= 100.0 * np.round(separations / 100.0)
    assert len(positions) == 100 and np.hypot(*separations.T).min() > 10.001
    assert np.ptp(positions, axis=0).min() > 50.0
