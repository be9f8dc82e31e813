"""Many particles, sorted into cells: nothing of it can be seen in the results."""

import numpy as np
import pytest
from brute_force import Beside, begin, run, scene_of, settings, snapshot

from roughgas.kernel import memory
from roughgas.kernel.cells import ORIGIN
from roughgas.kernel.event_lists import _rows_around
from roughgas.kernel.loop import start
from roughgas.kernel.particles import position_and_velocity
from roughgas.kernel.state import LAST_FIRST, LAST_SECOND, PREDICTIONS

LISTS = {"neighbours": "lists"}
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
    "spheres": (settings("spheres", 40, [17, 17, 17]), 0.98, 0.2, 8),
    "spheres on lists": (settings("spheres", 80, [20, 20, 20]) | LISTS, 0.98, 0.2, 8),
}
SEGMENTS, COLLISIONS = 20, 10


def sheared_or_slow(cases):
    """Parameters of a test; others than the sheared gas, in which most of it acts, are slow."""
    quick = ("sheared", "fast shear", "slow gas, fast shear", "bed on lists", "walled, on lists")
    return [pytest.param(case, marks=[pytest.mark.slow] * (case not in quick)) for case in cases]


@pytest.fixture
def cells(monkeypatch):
    """However few they are, the particles are sorted into cells, as small as these may be."""
    monkeypatch.setattr(memory, "FEW", 0)
    monkeypatch.setattr(memory, "PER_CELL", {2: 0.0, 3: 0.0})


@pytest.mark.parametrize("case", sheared_or_slow(CASES))
def test_the_kernel_makes_the_same_collisions(case, cells):
    """As brute force does, from the same state every ten collisions."""
    *point, seed = CASES[case]
    scene, world = scene_of(*point)
    _, state = begin(*point, seed)
    assert state.cells is not None and state.sweep is None
    Beside(state, scene, world).assert_same(SEGMENTS, COLLISIONS)


UNLIKE = [
    {"fraction": 0.5, "radius": 0.7, "restitution": 0.95},
    {"fraction": 0.25, "radius": 1.5, "mass": 7.0, "roughness": 0.6},
    {"fraction": 0.25, "mass": 0.01, "inertia": 0.2},
]
MANY = {
    "gas": (settings("gas", 400, [60, 60]), 0.9, 0.2),
    "sheared": (settings("sheared", 400, [60, 60], shear={"velocity": 5.0}), 0.9, 0.2),
    "walled": (settings("walled", 400, [50, "open"]), 0.9, 0.2),
    "walled, on lists": (settings("walled", 400, [50, "open"]) | LISTS, 0.9, 0.2),
    "spheres": (settings("spheres", 600, [22, 22, 22]), 0.95, 0.2),
    "species": (settings("gas", 400, [80, 80]) | {"species": UNLIKE}, 0.9, 0.3),
    "species, on lists": (
        settings("walled", 400, [80, "open"]) | {"species": UNLIKE} | LISTS,
        0.9,
        0.3,
    ),
    "species, sheared": (settings("sheared", 400, [80, 80]) | {"species": UNLIKE}, 0.9, 0.3),
}


@pytest.mark.parametrize("name", sheared_or_slow(MANY))
def test_both_schemes_make_the_same_collisions(name, monkeypatch):
    """The same 2,000 pairs in the same order; later, chaos shows the roundings of the clock."""
    states = []
    for few in (0, 10_000):
        monkeypatch.setattr(memory, "FEW", few)
        scene, state = begin(*MANY[name], 3)
        states.append(state)
    assert states[0].cells is not None and states[1].cells is None
    for _ in range(500 if "species" in name else 2000):  # light particles are fast
        pairs = []
        for state in states:
            run(state, scene, 1, collisions=1)
            pairs.append({int(state.counts[LAST_FIRST]), int(state.counts[LAST_SECOND])})
        assert pairs[0] == pairs[1]
    one, other = (snapshot(state, scene) for state in states)
    assert one.time == pytest.approx(other.time, rel=1e-9)
    assert one.velocity == pytest.approx(other.velocity, abs=1e-6)
    assert one.spin == pytest.approx(other.spin, abs=1e-6)


@pytest.fixture
def many(monkeypatch):
    monkeypatch.setattr(memory, "FEW", 0)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["gas", "spheres"])
def test_the_cells_that_are_fetched_ahead_are_around_the_next_event(name, many):
    """Around where a particle makes its next contact, or is when it has just left its cell."""
    scene, state = begin(*MANY[name], 5)
    run(state, scene, 1, collisions=500)
    cells, agenda, tested = state.cells, state.agenda, {True: 0, False: 0}
    counts = np.array(cells.counts)
    strides = np.cumprod([1, *counts[:-1]])
    around = np.indices([3] * len(counts)).reshape(len(counts), -1).T - 1
    for i in range(len(state.label)):
        leaves = bool(agenda.key[i] == cells.leave[i])
        position, _ = position_and_velocity(state, scene, i, agenda.key[i] + 1e-9 * leaves)
        place = np.floor(np.array(position) / cells.widths - ORIGIN).astype(int) % counts
        inside = np.all((place > 0) & (place < counts - 1))
        if inside and (leaves or agenda.kind[i] >= 0):
            fetched = {begin + k for begin in _rows_around(state, i) for k in range(3)}
            assert fetched == set((place + around) @ strides)
            tested[leaves] += 1
    assert min(tested.values()) > 50


def test_particles_are_put_into_the_order_of_their_cells(many):
    scene, state = begin(*MANY["sheared"], 4)
    run(state, scene, 0)  # starts it
    assert np.all(np.diff(state.cells.home) >= 0)
    labels = state.label.copy()
    run(state, scene, 40, collisions=200)
    assert sorted(state.label) == list(range(400))
    assert not np.array_equal(state.label, labels)


def test_every_particle_is_listed_once_in_its_cell_and_on_its_day(many):
    scene, state = begin(*MANY["sheared"], 5)
    run(state, scene, 20, collisions=100)
    cells, queue = state.cells, state.queue
    assert members(cells.first, cells.following) == {
        cell: set(np.flatnonzero(cells.home == cell)) for cell in set(cells.home)
    }
    days = np.floor(state.agenda.key * queue.pace[0]).astype(int) % len(queue.first)
    assert members(queue.first, queue.later) == {
        day: set(np.flatnonzero(days == day)) for day in set(days)
    }


@pytest.mark.parametrize("skin", [memory.SKIN, 4.0])  # such a wide one has more than there is room
def test_lists_have_all_that_can_be_met(skin, many, monkeypatch):
    """Which is told by the distances of all regions; and what is met is what brute force says."""
    monkeypatch.setattr(memory, "SKIN", skin)
    scene, state = begin(*MANY["walled, on lists"], 6)
    full = 0
    for _ in range(20):
        run(state, scene, 1, collisions=100)
        lists = state.cells.neighbours
        apart = np.abs(lists.middle[:, None] - lists.middle) - lists.sides
        near = (np.maximum(apart, 0.0) ** 2).sum(axis=2) < memory.NARROWEST**2
        np.fill_diagonal(near, False)
        for i, count in enumerate(lists.number):
            if count <= memory.ROOM:
                assert sorted(lists.members[i, :count]) == list(np.flatnonzero(near[i]))
        full += (lists.number > memory.ROOM).sum()
    assert (full > 0) == (skin == 4.0)


def test_the_regions_of_lists_move_as_the_particles_do(many):
    """All that fall together keep their lists: nobody looks around anew but after contacts."""
    scene, state = begin(*MANY["walled, on lists"], 7)
    run(state, scene, 0)
    state.trajectory[:, 2:4] = [0.0, 50.0]
    start(state, scene)
    before = state.counts[PREDICTIONS]
    run(state, scene, 1, 1.0)
    assert state.counts[PREDICTIONS] - before < 5 * len(state.changes)


def members(first, following):
    """What is on each list that is not empty."""
    lists = {}
    for k, i in enumerate(first):
        found = []
        while i >= 0:
            found.append(i)
            i = following[i]
        if found:
            assert len(set(found)) == len(found)
            lists[k] = set(found)
    return lists


def test_many_particles_take_little_memory():
    """At most 150 bytes a particle, but for the cells' own lists."""
    _, state = begin(settings("gas", 10_000, [400, 400]), 0.9, 0.2)
    whole = owned(state._replace(cells=state.cells._replace(first=None), shortlist=()))
    assert state.cells is not None
    assert whole / 10_000 <= 150.0


def owned(part):
    """Bytes in the arrays of nested tuples."""
    if isinstance(part, np.ndarray):
        return part.nbytes
    return sum(map(owned, part)) if isinstance(part, tuple) else 0
