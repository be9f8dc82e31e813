"""Particles sorted into cells make the same collisions as without cells."""

import numpy as np
import pytest
import schemes
from brute_force import Comparison, begin, run, scene_of, settings, snapshot
from slow_cases import slow_but

from roughgas.kernel import layout
from roughgas.kernel.cells import ORIGIN
from roughgas.kernel.event_lists import _rows_around
from roughgas.kernel.loop import restart
from roughgas.kernel.particles import position_and_velocity
from roughgas.kernel.state import PREDICTIONS

LISTS = {"neighbours": "lists"}
FALLING = settings("smooth", 24, [17, 19])
FALLING["effects"] = {
    "spin": {"inertia": 0.5},
    "gravity": {"acceleration": 0.3, "direction": [2, 1]},
}
CASES = {
    # experiment, r, beta, seed
    "gas": (settings("gas", 24, [17, 19]), 0.98, 0.2, 1),
    "dense gas": (settings("gas", 56, [17, 17]), 0.98, -0.6, 2),
    "dilute gas": (settings("gas", 8, [60, 50]), 1.0, 1.0, 3),
    "sheared": (settings("sheared", 24, [17, 19]), 0.9, 0.2, 4),
    "fast shear": (settings("sheared", 24, [17, 19], shear={"velocity": 80.0}), 0.9, 0.2, 5),
    "slow gas, fast shear": (
        settings("sheared", 12, [17, 19], shear={"velocity": 2e3}),
        0.5,
        1.0,
        6,
    ),
    "bed between rough walls": (settings("walled", 40, [20, "open"]), 0.8, 0.2, 7),
    "bed on lists": (settings("walled", 40, [20, "open"]) | LISTS, 0.8, 0.2, 7),
    "chute": (settings("chute", 40, [20, "open"]), 0.8, 0.2, 7),
    "chute on lists": (settings("chute", 40, [20, "open"]) | LISTS, 0.8, 0.2, 7),
    "falling gas": (FALLING, 0.9, 0.2, 1),
    "spheres": (settings("spheres", 40, [17, 17, 17]), 0.98, 0.2, 8),
    "spheres on lists": (settings("spheres", 80, [22, 22, 22]) | LISTS, 0.98, 0.2, 8),
}
SEGMENTS, COLLISIONS = 20, 10


def sheared_or_slow(cases):
    """Cases as parameters of a test; all but a few, which exercise most of the code, are slow."""
    quick = ("sheared", "fast shear", "slow gas, fast shear", "bed on lists", "walled, on lists")
    return slow_but(quick, cases)


@pytest.fixture
def smallest_cells(monkeypatch):
    """Sort particles into the smallest possible cells, however few they are."""
    schemes.use_smallest_cells(monkeypatch)


@pytest.mark.parametrize("case", sheared_or_slow(CASES))
def test_the_kernel_makes_the_same_collisions(case, smallest_cells):
    """As the brute force, from a common state every ten collisions."""
    *point, seed = CASES[case]
    scene, world = scene_of(*point)
    _, state = begin(*point, seed)
    assert state.cells is not None and state.sweep is None
    Comparison(state, scene, world).assert_same(SEGMENTS, COLLISIONS)


THREE_SPECIES = [
    {"fraction": 0.5, "radius": 0.7, "restitution": 0.95},
    {"fraction": 0.25, "radius": 1.5, "mass": 7.0, "roughness": 0.6},
    {"fraction": 0.25, "mass": 0.01, "inertia": 0.2},
]
LARGE_GASES = {
    "gas": (settings("gas", 400, [60, 60]), 0.9, 0.2),
    "sheared": (settings("sheared", 400, [60, 60], shear={"velocity": 5.0}), 0.9, 0.2),
    "walled": (settings("walled", 400, [50, "open"]), 0.9, 0.2),
    "walled, on lists": (settings("walled", 400, [50, "open"]) | LISTS, 0.9, 0.2),
    "spheres": (settings("spheres", 600, [22, 22, 22]), 0.95, 0.2),
    "species": (settings("gas", 400, [80, 80]) | {"species": THREE_SPECIES}, 0.9, 0.3),
    "species, on lists": (
        settings("walled", 400, [80, "open"]) | {"species": THREE_SPECIES} | LISTS,
        0.9,
        0.3,
    ),
    "species, sheared": (settings("sheared", 400, [80, 80]) | {"species": THREE_SPECIES}, 0.9, 0.3),
}


@pytest.mark.parametrize("name", sheared_or_slow(LARGE_GASES))
def test_both_schemes_make_the_same_collisions(name, monkeypatch):
    """The same 2,000 pairs in the same order; later, chaos amplifies roundings of the clock."""
    schemes.use(monkeypatch, "cells")
    experiment, r, beta = LARGE_GASES[name]
    _, many = begin(experiment, r, beta, 3)
    scene, few = begin(experiment | {"neighbours": "sweep"}, r, beta, 3)
    states = [many, few]
    assert states[0].cells is not None and states[1].cells is None
    # light particles are fast
    schemes.assert_same_pairs(states, scene, 500 if "species" in name else 2000)
    in_cells, swept = (snapshot(state, scene) for state in states)
    assert in_cells.time == pytest.approx(swept.time, rel=1e-9)
    assert in_cells.velocity == pytest.approx(swept.velocity, abs=1e-6)
    assert in_cells.spin == pytest.approx(swept.spin, abs=1e-6)


@pytest.fixture
def with_cells(monkeypatch):
    """Sort particles into cells, however few they are."""
    schemes.use(monkeypatch, "cells")


@pytest.mark.slow
@pytest.mark.parametrize("name", ["gas", "spheres"])
def test_the_cells_that_are_fetched_ahead_are_around_the_next_event(name, with_cells):
    """Cells around a particle's next contact, or around its position just outside its cell."""
    scene, state = begin(*LARGE_GASES[name], 5)
    run(state, scene, 1, collisions=500)
    cells, agenda, tested = state.cells, state.agenda, {True: 0, False: 0}
    counts = np.array(cells.counts)
    strides = np.cumprod([1, *counts[:-1]])
    neighbour_offsets = np.indices([3] * len(counts)).reshape(len(counts), -1).T - 1
    for i in range(len(state.label)):
        leaves = bool(agenda.key[i] == cells.leave[i])
        position, _ = position_and_velocity(state, scene, i, agenda.key[i] + 1e-9 * leaves)
        cell = np.floor(np.array(position) / cells.widths - ORIGIN).astype(int) % counts
        inside = np.all((cell > 0) & (cell < counts - 1))
        if inside and (leaves or agenda.kind[i] >= 0):
            fetched = {begin + k for begin in _rows_around(state, i) for k in range(3)}
            assert fetched == set((cell + neighbour_offsets) @ strides)
            tested[leaves] += 1
    assert min(tested.values()) > 50


def test_particles_are_put_into_the_order_of_their_cells(with_cells):
    scene, state = begin(*LARGE_GASES["sheared"], 4)
    run(state, scene, 0)  # which sorts the particles
    assert np.all(np.diff(state.cells.home) >= 0)
    labels = state.label.copy()
    run(state, scene, 40, collisions=200)
    assert sorted(state.label) == list(range(400))
    assert not np.array_equal(state.label, labels)


def test_every_particle_is_listed_once_in_its_cell_and_on_its_day(with_cells):
    scene, state = begin(*LARGE_GASES["sheared"], 5)
    run(state, scene, 20, collisions=100)
    cells, queue = state.cells, state.queue
    assert members(cells.first, cells.following) == {
        cell: set(np.flatnonzero(cells.home == cell)) for cell in set(cells.home)
    }
    days = np.floor(state.agenda.key * queue.pace[0]).astype(int) % len(queue.first)
    assert members(queue.first, queue.later) == {
        day: set(np.flatnonzero(days == day)) for day in set(days)
    }


@pytest.mark.parametrize("skin", [layout.BED_SKIN, 4.0])  # lists of such a wide skin overflow
def test_neighbour_lists_have_all_regions_within_reach(skin, with_cells, monkeypatch):
    """By the distances between all regions; lists that overflow are left out."""
    monkeypatch.setattr(layout, "BED_SKIN", skin)
    scene, state = begin(*LARGE_GASES["walled, on lists"], 6)
    full_lists = 0
    for _ in range(20):
        run(state, scene, 1, collisions=100)
        lists = state.cells.neighbours
        gaps = np.abs(lists.middle[:, None] - lists.middle) - lists.sides
        near = (np.maximum(gaps, 0.0) ** 2).sum(axis=2) < layout.MIN_CELL_WIDTH**2
        np.fill_diagonal(near, False)
        for i, count in enumerate(lists.number):
            if count <= layout.LIST_CAPACITY:
                assert sorted(lists.members[i, :count]) == list(np.flatnonzero(near[i]))
        full_lists += (lists.number > layout.LIST_CAPACITY).sum()
    assert (full_lists > 0) == (skin == 4.0)


def test_the_regions_of_lists_move_as_the_particles_do(with_cells):
    """Particles that fall together keep their lists: only contacts make them predict anew."""
    scene, state = begin(*LARGE_GASES["walled, on lists"], 7)
    run(state, scene, 0)
    state.trajectory[:, 2:4] = [0.0, 50.0]
    restart(state, scene)
    before = state.counts[PREDICTIONS]
    run(state, scene, 1, 1.0)
    assert state.counts[PREDICTIONS] - before < 5 * len(state.changes)


def members(heads, following):
    """The particles on each list, by its index; without empty lists."""
    lists = {}
    for head, particle in enumerate(heads):
        listed = []
        while particle >= 0:
            listed.append(particle)
            particle = following[particle]
        if listed:
            assert len(set(listed)) == len(listed)
            lists[head] = set(listed)
    return lists


def test_many_particles_take_little_memory():
    """At most 150 bytes per particle, without the lists of the cells."""
    _, state = begin(settings("gas", 10_000, [400, 400]), 0.9, 0.2)
    bytes_of_state = bytes_in_arrays(
        state._replace(cells=state.cells._replace(first=None), shortlist=())
    )
    assert state.cells is not None
    assert bytes_of_state / 10_000 <= 150.0


def bytes_in_arrays(state):
    """Number of bytes in the arrays of nested tuples."""
    if isinstance(state, np.ndarray):
        return state.nbytes
    return sum(map(bytes_in_arrays, state)) if isinstance(state, tuple) else 0
