"""Prediction of contacts: none is missed, and the queue of events returns the earliest."""

import numpy as np
import pytest
import schemes
from brute_force import BruteForce, begin, run, scene_of, settings, snapshot
from compiled import from_python
from slow_cases import slow_but

from roughgas.kernel import event_lists
from roughgas.kernel.layout import new_state
from roughgas.kernel.state import LAST_FIRST, LAST_SECOND, LONGEST_HORIZON, NOW, TYPICAL_SPEED


def first_contact(scene, world, position, velocity, spin=None):
    """((pair, time) of the kernel's first contact, (pair, time) of the brute force's)."""
    spin = np.zeros((len(position), 2 * position.shape[1] - 3)) if spin is None else spin
    state = new_state(scene, position, velocity, spin)
    row = run(state, scene, 1, collisions=1)
    pair = {int(state.counts[LAST_FIRST]), int(state.counts[LAST_SECOND])}
    event = BruteForce(world, position, velocity, spin).run(1)[-1]
    return (pair, row["time"][0]), ({event.i, event.j}, event.time)


@pytest.mark.parametrize("number", [2, 3, 15, 16, 17, 31, 33, 48])
def test_the_first_contact_is_found_for_any_number_of_particles(number):
    """The sweep works on whole vector registers, whose padding is never taken for particles."""
    experiment = settings("gas", number, [30, 40])
    scene, world = scene_of(experiment, 1.0, 0.5)
    _, state = begin(experiment, 1.0, 0.5, number)
    state.trajectory[:, 2:4] *= 50.0  # so fast that several images are within the horizon
    state.trajectory[0, 2:4] *= 40.0
    shot = snapshot(state, scene)
    contact, expected = first_contact(scene, world, shot.position, shot.velocity, shot.spin)
    assert contact[0] == expected[0]
    assert contact[1] == pytest.approx(expected[1], rel=1e-9)


def tall_bed(rng):
    """Positions and velocities of fast particles hundreds of radii above a floor."""
    number, columns = 40, 12
    sites = rng.permutation(columns * 200)[:number]
    position = np.stack([4.0 * (sites % columns) + 2.0, 300.0 + 4.0 * (sites // columns)], axis=1)
    return position, rng.standard_normal((number, 2)) * [3.0, 30.0]


def jittered(rng, counts, spacing, slack):
    """Positions near sites of a lattice, off by up to `slack` along each axis, and velocities."""
    axes = [spacing * (np.arange(c) + 0.5) for c in counts]
    position = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, len(counts))
    position += rng.uniform(-slack, slack, position.shape)
    return position, rng.standard_normal(position.shape)


@pytest.mark.parametrize(
    "kind", ["tall bed", "dense", "dilute", "cold and hot", "shear", "spheres"]
)
def test_the_first_contact_is_found_in_random_states(kind):
    """40 states each: roundings of the sieve do not remove the first pair to meet."""
    rng = np.random.default_rng(len(kind))
    for _ in range(40):
        if kind == "tall bed":
            experiment = settings("bed", 40, [48, "open"])
            position, velocity = tall_bed(rng)
        elif kind == "spheres":
            experiment = settings("spheres", 64, [10, 10, 10])
            position, velocity = jittered(rng, (4, 4, 4), 2.5, 0.24)
        elif kind == "shear":
            speed = 10.0 ** rng.uniform(-1, 3)
            experiment = settings("sheared", 36, [18, 18], shear={"velocity": speed})
            position, velocity = jittered(rng, (6, 6), 3.0, 0.49)
            velocity[:, 0] += speed * (position[:, 1] / 18 - 0.5)
        else:
            spacing = 2.2 if kind == "dense" else 12.0
            experiment = settings("gas", 36, [6 * spacing] * 2)
            position, velocity = jittered(rng, (6, 6), spacing, spacing / 2 - 1.01)
            if kind == "cold and hot":
                velocity *= 10.0 ** rng.uniform(-4, 2, (36, 1))
        scene, world = scene_of(experiment, 0.9, 0.1)
        contact, expected = first_contact(scene, world, position, velocity)
        assert contact[0] == expected[0]
        assert contact[1] == pytest.approx(expected[1], rel=1e-9, abs=1e-12)


def test_a_seventh_contact_is_not_lost_when_the_first_six_fall_through():
    """A particle flies along a lane that six others leave before it comes, and one does not.

    A particle keeps a short list of contacts: others must be predicted again later.
    """
    lane = 3.0 * np.arange(6) + 20.0
    position = [(x, 100.0) for x in lane] + [(x, 102.5) for x in lane]
    position += [(10.0, 99.5), (45.0, 99.5), (7.8, 99.5)]
    velocity = [(0.0, 0.0)] * 6 + [(0.0, -1.0)] * 6 + [(0.0, 0.0), (0.0, 0.0), (1.0, 0.0)]
    scene, world = scene_of(settings("gas", 15, [200, 200]), 1.0, -1.0)
    state = new_state(scene, np.array(position), np.array(velocity), np.zeros((15, 1)))
    brute = BruteForce(world, position, velocity, None)
    assert brute.run(8)[-1][2:] == (12, 13)
    row = run(state, scene, 8, collisions=1)
    assert {int(state.counts[LAST_FIRST]), int(state.counts[LAST_SECOND])} == {12, 13}
    assert row["time"][-1] == pytest.approx(brute.time, rel=1e-12)


POINTS = {
    "gas": (settings("gas", 40, [25, 25]), 0.9, 0.2),
    "dense gas": (settings("gas", 100, [20.2, 20.2]), 0.95, -0.5),
    "sheared": (settings("sheared", 40, [25, 25]), 0.9, 0.2),
    "bed": (settings("bed", 40, [12.5, "open"]), 0.8, 0.2),
    "walled": (settings("walled", 40, [12.5, "open"]), 0.8, 0.2),
    "spheres": (settings("spheres", 100, [11, 11, 11]), 0.95, 0.2),
}


@pytest.mark.parametrize("name", POINTS)
def test_when_and_how_often_samples_are_taken_does_not_matter(name):
    """Bitwise, for a single sample, many samples, and samples in several calls."""
    instants = {}
    for interval, samples, calls in ((32.0, 1, 1), (0.25, 128, 1), (0.125, 64, 4), (1.0, 1, 32)):
        scene, state = begin(*POINTS[name], 5)
        for _ in range(calls):
            run(state, scene, samples, interval=interval)
        instants[interval] = (state.trajectory.tobytes(), state.spin.tobytes(), *state.counts[:2])
    assert len(set(instants.values())) == 1


@pytest.mark.parametrize("name", POINTS)
def test_how_far_ahead_contacts_are_foreseen_does_not_matter(name):
    """Four collisions per particle; later, chaos amplifies the few roundings that differ."""
    ends = []
    for horizon in (np.inf, 1.0, 0.1):
        scene, state = begin(*POINTS[name], 6)
        run(state, scene, 0)
        state.clock[LONGEST_HORIZON] = horizon
        # the longest horizon acts from each particle's next event on
        run(state, scene, 1, collisions=2 * len(state.changes))
        ends.append(snapshot(state, scene))
    for end in ends[1:]:
        assert end.time == pytest.approx(ends[0].time, rel=1e-9)
        assert end.velocity == pytest.approx(ends[0].velocity, abs=1e-7)
        assert end.spin == pytest.approx(ends[0].spin, abs=1e-7)


earliest, enter_in_queue, clear_calendar = map(
    from_python, (event_lists.earliest, event_lists.enter_in_queue, event_lists.clear_calendar)
)


@pytest.mark.parametrize("scheme", ["cells", "sweep"])
@pytest.mark.parametrize("spread", slow_but([1.0], [1e-3, 1.0, 1e6]))
def test_the_queue_returns_the_earliest_event(scheme, spread, monkeypatch):
    """Times within a day of the calendar, over a year and over many years; some coincide, some are
    infinite."""
    schemes.use(monkeypatch, scheme)
    _, state = begin(settings("gas", 300, [60, 60]), 0.9, 0.2)
    rng = np.random.default_rng(0)
    state.clock[TYPICAL_SPEED] = 1.0
    if scheme == "cells":
        clear_calendar(state)
    expected = np.full(300, np.inf)
    for step in range(2000):
        i = int(rng.integers(300)) if step < 600 else earliest(state)
        now = 0.0 if step < 600 else state.agenda.key[i]
        state.clock[NOW] = now
        time = now + rng.choice([spread * rng.exponential(), 0.5, np.inf], p=[0.96, 0.02, 0.02])
        if time == np.inf and np.isfinite(expected).sum() < 20:
            time = now + spread
        expected[i] = time
        enter_in_queue(state, i, time)
        if step > 400:
            assert state.agenda.key[earliest(state)] == expected.min()


@pytest.mark.parametrize("scheme", ["cells", "sweep"])
def test_a_queue_without_events_returns_infinity(scheme, monkeypatch):
    schemes.use(monkeypatch, scheme)
    _, state = begin(settings("gas", 300, [60, 60]), 0.9, 0.2)
    assert state.agenda.key[earliest(state)] == np.inf
