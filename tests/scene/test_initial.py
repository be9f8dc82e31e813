"""Where simulations start."""

import numpy as np
import pytest
from brute_force import KERNELS, begin, largest_overlap, scene_of, settings

from roughgas.base import InputError

CASES = {
    **{name: settings(name) for name in KERNELS},
    "two in the smallest box": settings("gas", 2, [4.01, 4.01]),
    "dense": settings("gas", 100, [20.1, 20.1]),
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
def test_no_overlap_no_momentum_no_spin(case):
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
        assert np.abs(velocity.sum(axis=0) - flow(scene, position).sum(axis=0)).max() < 1e-11
        inside(experiment, position)


def flow(scene, position):
    mean = np.zeros_like(position)
    if scene.effects.shear:
        height = scene.box[1]
        mean[:, 0] = scene.effects.shear.velocity * (position[:, 1] / height - 0.5)
    return mean


def inside(experiment, position):
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
        squares.append(((velocity - flow(scene, position)) ** 2).sum() / (2 * 159))
    assert np.mean(squares) == pytest.approx(1.0, abs=4.0 / np.sqrt(20 * 159))


def test_seeds_differ_and_repeat():
    states = [begin(settings("gas"), 0.9, 0.0, seed)[1].trajectory for seed in (1, 1, 2)]
    assert np.array_equal(states[0], states[1]) and not np.array_equal(states[0], states[2])


@pytest.mark.parametrize(
    "most", [settings("gas", 108, [20.1, 20.1]), settings("spheres", 144, [10.1] * 3)]
)
def test_more_than_fit_are_refused(most):
    begin(most, 0.9, 0.0)
    with pytest.raises(InputError) as caught:
        begin(most | {"particles": most["particles"] + 1}, 0.9, 0.0)
    assert caught.value.key == "particles"
