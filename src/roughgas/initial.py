"""Where a simulation starts: no overlap, Maxwellian velocities, no spin, no total momentum."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from roughgas.errors import InputError
from roughgas.kernel.layout import new_state
from roughgas.kernel.state import State
from roughgas.scene import DIAMETER, Scene

TEMPERATURE = 1.0  # m a^2/T^2
VACANCIES = 1.3  # lattice sites a particle, where there is room
LOOSE_PACKING = 0.2  # volume fraction of a gas with an open top
CLEARANCE = 1e-9  # relative distance beyond contact


def initial_state(scene: Scene, experiment: Mapping[str, Any], rng: np.random.Generator) -> State:
    """A random state of `experiment["particles"]` particles.

    They sit on random sites of a square (cubic) lattice, with Maxwellian velocities at temperature
    1 m a^2/T^2 relative to the mean flow and none of them spinning. Raises InputError where they do
    not fit.
    """
    number = experiment["particles"]
    sites = lattice(scene, experiment)
    position = sites[np.sort(rng.permutation(len(sites))[:number])]
    velocity = math.sqrt(TEMPERATURE) * rng.standard_normal(position.shape)
    velocity -= velocity.mean(axis=0)
    shear = scene.effects.shear
    if shear is not None:
        height = position[:, 1] - scene.middle
        velocity[:, 0] += shear.velocity / (2.0 * scene.middle) * height
    spin = np.zeros((number, 2 * position.shape[1] - 3))
    return new_state(scene, position, velocity, spin)


def lattice(scene: Scene, experiment: Mapping[str, Any]) -> np.ndarray:
    """Sites (M, D) of a lattice that fills the box, M >= the number of particles, in a."""
    number, dimension = experiment["particles"], len(scene.box)
    lengths, bottom = _room(scene, experiment)
    least = DIAMETER * (1.0 + CLEARANCE)
    spacing = max(least, (math.prod(lengths) / (VACANCIES * number)) ** (1.0 / dimension))
    counts = [max(1, math.floor(length / spacing)) for length in lengths]
    if math.prod(counts) < number:  # too dense for vacancies: as many sites as there is room for
        counts = [math.floor(length / least) for length in lengths]
    if math.prod(counts) < number:
        raise InputError("particles", number, f"be at most {math.prod(counts)} in this box")
    axes = [(np.arange(c) + 0.5) * (length / c) for c, length in zip(counts, lengths, strict=True)]
    axes[-1] = axes[-1] + bottom
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, dimension)


def _room(scene, experiment):
    """Lengths of the region to fill, and where it begins along the last axis."""
    lengths = [None if side == "open" else float(side) for side in experiment["box"]]
    if lengths[-1] is not None:
        return lengths, 0.0
    volume = math.pi if len(lengths) == 2 else 4.0 * math.pi / 3.0
    base = math.prod(lengths[:-1])
    height = experiment["particles"] * volume / (LOOSE_PACKING * base)
    lengths[-1] = math.ceil(height / DIAMETER + 1.0) * DIAMETER * (1.0 + CLEARANCE)
    return lengths, scene.effects.floor.amplitude
