"""Mixtures of particles that have little in common."""

import math

import numpy as np
import pytest
import schemes
from brute_force import begin, largest_overlap, run, scene_of, settings

from roughgas.effects.species import UNIFORM
from roughgas.kernel import hierarchy
from roughgas.kernel.scheme import MIN_CELLS
from roughgas.kernel.state import COLLISIONS
from roughgas.simulation.energy_balance import balance

ROUNDING = 2.0**-53
# The reduced mass of two species is rounded once, and so with the same sign in all contacts;
# mass, impulse and both changes of velocity are rounded, too.
LARGEST_IMBALANCE = 4.0
SPREAD = {"distribution": UNIFORM, "deviation": 0.2}


def check_gas(margins, particles, box, species, collisions, r=1.0, beta=-1.0):
    """Run a gas of these species; measure overlaps, the energy balance and the momentum."""
    experiment = settings("gas", particles, box) | {"species": species}
    scene, world = scene_of(experiment, r, beta)
    _, state = begin(experiment, r, beta, 1)
    run(state, scene, 0)
    before = balance(state, scene)
    samples = run(state, scene, 10, collisions=collisions // 10)
    after, collisions_made = balance(state, scene), int(state.counts[COLLISIONS])
    tried = {"tried": collisions_made, "unit": "collisions"}
    largest = state.bodies.radius.max()
    if particles <= 2000:  # the brute force tries every pair
        overlap = largest_overlap(state, scene, world) / (ROUNDING * (max(box) + largest))
        margins.at_most("overlap, in roundings of the box", overlap, 100.0, **tried)
    imbalance = np.abs(
        after.energy - before.energy - (after.ledger - before.ledger).sum(axis=0)
    ).max()
    imbalance /= before.energy.sum() / particles * ROUNDING * (collisions_made + particles)
    quantity = "error of the energy balance, in roundings of a particle's energy per collision"
    margins.at_most(quantity, imbalance, LARGEST_IMBALANCE, **tried)
    if r == 1.0 and beta == -1.0:
        change = abs(after.energy.sum() / before.energy.sum() - 1.0)
        margins.at_most("change of the energy of an elastic gas, over it", change, 1e-11, **tried)
    thermal = math.sqrt(samples["vv_x"][-1] * state.bodies.mass.sum())
    momentum = max(abs(samples["p_x"]).max(), abs(samples["p_y"]).max()) / thermal
    margins.at_most("momentum gained, over that of thermal motion", momentum, 1e-12, **tried)
    assert np.isfinite(state.trajectory).all() and np.isfinite(state.spin).all()
    return state


def test_sizes_may_differ_a_hundredfold(margins):
    species = [{"number": 2, "radius": 100.0}, {"number": 300}]
    state = check_gas(margins, 302, [500, 450], species, margins.size(3000, 100_000), 0.99, 0.3)
    assert state.changes[state.bodies.species == 0].min() > 10


def test_masses_may_differ_by_1e9(margins):
    """In an elastic gas, and in an inelastic one until heavy particles enclose a light one."""
    species = [{"fraction": 0.5, "mass": 1.0}, {"fraction": 0.5, "mass": 1e9}]
    check_gas(margins, 100, [60, 60], species, margins.size(5000, 200_000))
    check_gas(margins, 100, [60, 60], species, 5000, 0.95, 0.3)


@pytest.mark.slow  # a kernel that no other test compiles
def test_a_lone_large_particle_meets_all_small_ones(margins, monkeypatch):
    """In a single grid, in full among a million, so that a cell has a thousand particles; and with
    a grid for each class of sizes."""
    number = margins.size(1500, 1_000_000)
    side = 4.0 * math.sqrt(number)
    radius = min(side / (2.1 * MIN_CELLS), 20.0)
    species = [{"number": 1, "radius": radius}, {"number": number}]
    schemes.use(monkeypatch, "cells")
    largest_cells = []
    for worthwhile in (0.0, math.inf):
        monkeypatch.setattr(hierarchy, "WORTHWHILE", worthwhile)
        state = check_gas(margins, number + 1, [side, side], species, 2000)
        largest_cells.append(np.bincount(state.cells.home).max())
    assert largest_cells[0] > 20 and state.cells.classes is not None


def test_a_packed_polydisperse_box_stays_without_overlap(margins):
    """Radii with a deviation of a fifth, at a packing of 0.74."""
    species = [{"fraction": 1, "radius": SPREAD}]
    check_gas(margins, 400, [42.0, 42.0], species, margins.size(20_000, 500_000))
