"""Size classes: the choice of grids, near cells, and the same collisions as the brute force."""

import itertools
import math

import numpy as np
import pytest
import schemes
from brute_force import Comparison, begin, scene_of, settings, snapshot
from slow_cases import slow_but

from roughgas.kernel import hierarchy, layout, scheme
from roughgas.kernel.cells import ALL_AXES, assign_cell
from roughgas.kernel.size_classes import grid_of_cell, indices_in, list_near_cells


def species(*numbers_and_radii):
    """Settings of species, from a number and a radius of each."""
    return {"species": [{"number": n, "radius": radius} for n, radius in numbers_and_radii]}


def binary(large, small, ratio):
    """Settings of particles of radius 1, and of large ones that are `ratio` times larger."""
    return {"particles": large + small} | species((large, ratio), (small, 1.0))


POLYDISPERSE = {
    "species": [{"fraction": 1.0, "radius": {"distribution": "lognormal", "deviation": 0.9}}]
}
CASES = {
    # experiment, r, beta, seed
    "disks, 1:5": (settings("gas", box=[60, 70]) | binary(4, 50, 5.0), 0.95, 0.2, 1),
    "disks, 1:20": (settings("gas", box=[150, 130]) | binary(2, 60, 20.0), 0.95, 0.2, 2),
    "polydisperse": (settings("gas", 60, [80, 90]) | POLYDISPERSE, 0.95, 0.2, 3),
    "heated, 1:5": (settings("heated", box=[60, 60]) | binary(4, 50, 5.0), 0.9, 0.2, 4),
    "bed between walls, 1:5": (
        settings("walled", box=[40, "open"]) | binary(3, 40, 5.0),
        0.9,
        0.2,
        5,
    ),
    "bed between walls, 1:20": (
        settings("walled", box=[100, "open"]) | binary(2, 50, 20.0),
        0.9,
        0.2,
        6,
    ),
    "spheres, 1:5": (settings("spheres", box=[40, 40, 40]) | binary(3, 60, 5.0), 0.95, 0.2, 7),
    "spheres, 1:20": (settings("spheres", box=[120, 120, 120]) | binary(2, 80, 20.0), 0.95, 0.2, 8),
}
SEGMENTS, COLLISIONS = 20, 10


@pytest.fixture
def in_classes(monkeypatch):
    """Sort particles into size classes, with small cells, however few they are."""
    schemes.use(monkeypatch, "cells")
    monkeypatch.setattr(scheme, "PER_CELL", {2: (0.05, 0.05), 3: (0.003, 0.003)})
    monkeypatch.setattr(hierarchy, "WORTHWHILE", math.inf)


@pytest.mark.parametrize("case", slow_but((), CASES))
def test_the_kernel_makes_the_same_collisions(case, in_classes):
    """As the brute force, from a common state every ten collisions."""
    *point, seed = CASES[case]
    scene, world = scene_of(*point)
    _, state = begin(*point, seed)
    assert len(state.cells.classes.level) > 1
    Comparison(state, scene, world).assert_same(SEGMENTS, COLLISIONS)


LARGE_GASES = {
    "disks": (settings("gas", box=[130, 130]) | binary(12, 400, 7.0), 0.9, 0.2),
    "spheres": (settings("spheres", box=[84, 84, 84]) | binary(8, 1500, 5.0), 0.95, 0.2),
    "walled": (settings("walled", box=[100, "open"]) | binary(12, 400, 6.0), 0.9, 0.2),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", LARGE_GASES)
def test_classes_and_a_single_grid_make_the_same_collisions(name, in_classes, monkeypatch):
    """The same 1,000 pairs in the same order, while particles change cells many times."""
    states = []
    for worthwhile in (0.0, math.inf):
        monkeypatch.setattr(hierarchy, "WORTHWHILE", worthwhile)
        scene, state = begin(*LARGE_GASES[name], 3)
        states.append(state)
    assert states[0].cells.classes is None and states[1].cells.classes is not None
    schemes.assert_same_pairs(states, scene, 1000)
    single, classes = (snapshot(state, scene) for state in states)
    assert classes.velocity == pytest.approx(single.velocity, abs=1e-6)


def cells_around(cells, cell, axis=ALL_AXES, step=0):
    """Indices of the cells that a particle in a cell lists: each cell holds its own index."""
    grid, numbered = grid_of_cell(cells, cell), cells._replace(first=np.arange(cells.first.size))
    candidates = np.zeros(cells.first.size + 1, np.int64)
    home = indices_in(grid, cell)
    # the adjacent cells of the finest grid are listed elsewhere
    end = list_near_cells(numbered, candidates, 0, home, grid.size_class, axis, step)
    listed = candidates[:end].tolist()
    assert len(set(listed)) == len(listed)
    return set(listed)


def gaps(cells, cell, other):
    """The gap between two cells along each axis, to the nearest image; negative if they overlap."""
    centres, halves = [], []
    for number in (cell, other):
        grid = grid_of_cell(cells, number)
        width = np.array(grid.widths)
        centres.append(width * (np.array(indices_in(grid, number)) + grid.origin + 0.5))
        halves.append(0.5 * width)
    periods = np.array(cells.periods)
    separation = centres[0] - centres[1]
    separation -= periods * np.round(separation / periods)
    return np.abs(separation) - halves[0] - halves[1]


@pytest.mark.parametrize("case", ["disks, 1:5", "polydisperse", "spheres, 1:5"])
def test_near_cells_are_all_within_contact_and_see_each_other(case, in_classes):
    """Between all classes, but not within the smallest; from cells at random."""
    _, state = begin(*CASES[case][:3], CASES[case][3])
    cells, rng = state.cells, np.random.default_rng(1)
    ends = [*cells.classes.first_cell, cells.first.size]
    for k, m in itertools.product(range(len(ends) - 1), repeat=2):
        if k == m == 0:
            continue
        reach = cells.classes.radius[k] + cells.classes.radius[m]
        for cell in rng.integers(ends[k], ends[k + 1], 3).tolist():
            near = {n for n in cells_around(cells, cell) if ends[m] <= n < ends[m + 1]}
            others = [*rng.choice(sorted(near), 20), *rng.integers(ends[m], ends[m + 1], 20)]
            for other in others:
                gap = np.maximum(gaps(cells, cell, other), 0.0)
                assert other in near or gap @ gap > reach**2
                assert (other in near) == (cell in cells_around(cells, other))


@pytest.mark.parametrize("case", ["disks, 1:5", "polydisperse", "spheres, 1:5"])
def test_a_change_of_cell_lists_the_cells_that_become_near(case, in_classes):
    """Between all classes but the smallest, in each direction."""
    _, state = begin(*CASES[case][:3], CASES[case][3])
    cells, rng = state.cells, np.random.default_rng(2)
    for cell in rng.integers(0, cells.first.size, 10).tolist():
        grid = grid_of_cell(cells, cell)
        strides = np.cumprod([1, *grid.counts[:-1]])
        for axis, step in itertools.product(range(len(grid.counts)), (-1, 1)):
            index = indices_in(grid, cell)[axis]
            moved = (index + step) % grid.counts[axis] - index
            entered = cell + int(moved * strides[axis])
            new = cells_around(cells, entered) - cells_around(cells, cell)
            assert cells_around(cells, entered, axis, step) == new


def test_particles_have_a_cell_of_their_class(in_classes):
    """In the grid of the class, at the position of the particle; smaller ones in finer cells."""
    scene, state = begin(*CASES["polydisperse"][:3], 1)
    state.cells.first[:] = -1
    for i in range(len(state.label)):
        assign_cell(state, scene, i, 0.0)
        grid = grid_of_cell(state.cells, state.cells.home[i])
        radius, classes = state.bodies.radius[i], state.cells.classes
        assert grid.size_class == np.searchsorted(classes.radius, radius)
        index = np.array(indices_in(grid, state.cells.home[i]))
        offset = state.trajectory[i, :2] / grid.widths - grid.origin - index - 0.5
        offset -= np.array(grid.counts) * np.round(offset / grid.counts)
        assert (np.abs(offset) <= 0.5 + 1e-9).all()
    assert len(set(classes.level.tolist())) > 1


def classes_of(experiment):
    """SizeClasses of a gas of the experiment at packing 0.2; None for a single grid."""
    _, state = begin(experiment, 1.0, -1.0)
    assert state.cells is not None
    return state.cells.classes


def gas_of_equal_areas(ratio, particles=2000, packing=0.2, kernel="smooth"):
    """Settings of disks of two sizes that fill equal areas."""
    large = max(1, round(particles / (1.0 + ratio**2)))
    side = math.sqrt(math.pi * (large * ratio**2 + particles - large) / packing)
    return settings(kernel, box=[side, side]) | binary(large, particles - large, ratio)


@pytest.mark.parametrize(("ratio", "classes"), [(1.0, 1), (2.0, 1), (8.0, 2), (20.0, 2)])
def test_classes_are_made_where_sizes_differ_much(ratio, classes):
    chosen = classes_of(gas_of_equal_areas(ratio))
    assert (1 if chosen is None else len(chosen.level)) == classes


def test_sliding_images_and_neighbour_lists_have_a_single_grid():
    assert classes_of(gas_of_equal_areas(8.0, kernel="sheared")) is None
    assert classes_of(gas_of_equal_areas(8.0) | {"neighbours": "lists"}) is None


def test_the_choice_does_not_depend_on_the_order_of_the_particles():
    scene, state = begin(gas_of_equal_areas(10.0), 1.0, -1.0)
    bodies, order = state.bodies, np.random.default_rng(1).permutation(2000)
    shuffled = bodies._replace(radius=bodies.radius[order], mass=bodies.mass[order])
    gas, narrowest = scheme.filling(state.trajectory[:, :2], bodies.radius), 2.002 * 10.0
    grids = [layout._grids(scene, gas, b, narrowest, False) for b in (bodies, shuffled)]
    for array, array_of_shuffled in zip(grids[0].classes, grids[1].classes, strict=True):
        assert np.array_equal(array, array_of_shuffled)
    assert grids[0].grid == grids[1].grid and grids[0].cells == grids[1].cells
