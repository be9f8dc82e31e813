"""Saved states: valid ones continue with the same bits; states that would crash or hang the kernel
are refused in one line."""

import functools
import os
import signal
from collections import Counter

import numpy as np
import pytest
from brute_force import begin, run, settings
from forged_states import forge
from raw import build, run_point
from slow_cases import slow_but
from tests.bits import recorded_hashes
from tests.configurations import EXPERIMENTS
from tests.test_bits import point_of_path

from roughgas import config
from roughgas.base import EndedEarlyError
from roughgas.kernel.hooks import CODES
from roughgas.kernel.layout import LIST_CAPACITY
from roughgas.kernel.state import (
    ALIGNED,
    BASE,
    BOUNDARY,
    COLLISIONS,
    EXPONENT,
    LAST_FIRST,
    LONGEST_HORIZON,
    NOTHING,
    NOW,
    SIMULTANEOUS_EVENTS,
    SINCE_REBASE,
    SPAN,
    STARTED,
    TYPICAL_SPEED,
    integer_ranges,
)
from roughgas.simulation import gas as gases
from roughgas.simulation.gas import Gas
from roughgas.simulation.state_encoding import (
    UnusableCheckpoint,
    arrays_from_bytes,
    arrays_of,
    decode,
    encode,
    state_bytes,
)
from roughgas.simulation.state_validation import faults

SECONDS = 60
"""Seconds after which a forged gas counts as hung."""
MIXTURE = {
    "species": [
        {"fraction": 0.5},
        {"fraction": 0.5, "radius": 1.5, "mass": 2.0, "restitution": 0.8},
    ]
}
SIZES = {"species": [{"number": 12, "radius": 10.0}, {"number": 588}]}


IN_CELLS = {"neighbours": "cells"}
GASES = {
    "gas": settings("gas", 40, [25, 25]),
    "gas in cells": settings("gas", 600, [190, 190]) | IN_CELLS,
    "sheared": settings("sheared", 40, [25, 25]),
    "sheared in cells": settings("sheared", 600, [100, 100]) | IN_CELLS,
    "bed": settings("bed", 40, [12.5, "open"]),
    "bed in cells": settings("bed", 600, [100, "open"]) | IN_CELLS,
    "layer": settings("layer", 600, [24, 24, "open"]) | {"neighbours": "lists"},
    "spheres": settings("spheres"),
    "bath": settings("bath", 40, [50, 50]),
    "heated in cells": settings("heated", 600, [190, 190]) | IN_CELLS,
    "mixture": settings("gas", 40, [30, 30]) | MIXTURE,
    "mixture in cells": settings("gas", 600, [220, 220]) | MIXTURE | IN_CELLS,
    "sizes in cells": settings("gas", 600, [170, 170]) | SIZES | IN_CELLS,
    "walled": settings("walled", 40, [20, "open"]),
    "viscoelastic": settings("viscoelastic", 40, [50, 50]),
    "shaken": settings("shaken", 40, [25, 25]),
    "friction": settings("friction", 40, [50, 50]),
    "container": settings("container", 40, [25, 25]),
    "heated spheres": settings("heated spheres"),
    "closed spheres": settings("closed spheres"),
}
QUICK_GASES = ("gas", "sheared", "bed")  # whose kernels other tests compile as well
ALL_GASES = slow_but(QUICK_GASES, GASES)


def fresh(name, seed=5):
    """Scene and initial state of a gas."""
    scene, state = begin(GASES[name], 0.9, 0.3, seed)
    return scene, state


def advance(name, scene, state, stage):
    """Advance by some collisions (refreshing a cooling gas) or by some time; samples by name."""
    cools = set(GASES[name]["effects"]) == {"spin"}
    if stage == 0:
        return run(state, scene, 0)
    if stage % 3 == 0:
        return run(state, scene, 2, interval=0.37)
    return run(state, scene, 4, collisions=len(state.label) // 5, refresh=2 if cools else 0)


STAGES = 6
MIDDLE_STAGE = 4
"""The stage of the states that are forged, when most particles have predicted contacts."""


@functools.cache
def reached(name):
    """(scene, encoded states after each stage of a run, the initial state first)."""
    scene, state = fresh(name, 4)
    states = [encode(state)]
    for stage in range(STAGES):
        advance(name, scene, state, stage)
        states.append(encode(state))
    return scene, states


def content(state):
    """Name -> bytes of the arrays of a state."""
    return {name: array.tobytes() for name, array in arrays_of(state)}


@pytest.mark.parametrize("name", ALL_GASES)
def test_a_state_that_is_decoded_goes_on_with_the_same_bits(name):
    """From each stage of a run to the next."""
    scene, states = reached(name)
    for stage, saved in enumerate(states[:-1]):
        _, state = fresh(name)
        decode(saved, state, scene)
        assert content(state) == {key: array.tobytes() for key, array in saved.items()}
        advance(name, scene, state, stage)
        assert content(state) == {key: a.tobytes() for key, a in states[stage + 1].items()}


POINTS = [name for name in recorded_hashes() if name.startswith("small/")]


@pytest.mark.slow
@pytest.mark.parametrize("name", POINTS)
def test_all_states_of_a_point_are_sound(name, monkeypatch):
    """The states after each call of the kernel by the points of bits.json."""
    record, calls = gases.record, []

    def watched(state, scene, *how):
        ended = record(state, scene, *how)
        assert not [*faults(state, dict(arrays_of(state)), scene)]
        calls.append(ended)
        return ended

    monkeypatch.setattr(gases, "record", watched)
    monkeypatch.setattr(gases, "SHORTEST_CALL", 0.0)  # as many calls as of a long run
    scale, folders, r, beta, seed = point_of_path(name)
    experiment = config.load(EXPERIMENTS).experiment(folders, scale).raw
    scene = build(experiment, float(r.removeprefix("r")), float(beta.removeprefix("beta")))
    run_point(scene, experiment, int(seed.removeprefix("seed")))
    assert len(calls) > 5


@pytest.mark.parametrize("name", ALL_GASES)
def test_every_array_of_integers_has_a_range(name):
    _, state = fresh(name)
    integers = {key for key, array in arrays_of(state) if array.dtype.kind in "iu"}
    assert integers <= set(integer_ranges(state))


@pytest.mark.parametrize("name", QUICK_GASES)
def test_bytes_of_a_state_are_its_arrays_without_paths(name):
    scene, states = reached(name)
    _, state = fresh(name)
    decode(states[-1], state, scene)
    expected = {key: a for key, a in states[-1].items() if not key.startswith("paths.")}
    assert state_bytes(state) == b"".join(array.tobytes() for array in expected.values())
    arrays = arrays_from_bytes(state_bytes(state), state)
    assert list(arrays) == list(expected)
    for key, array in expected.items():
        assert arrays[key].dtype == array.dtype and arrays[key].tobytes() == array.tobytes()
    for truncated in (state_bytes(state)[:-1], state_bytes(state) + b"x"):
        with pytest.raises(UnusableCheckpoint, match=r"^has \d+ bytes in place of \d+$"):
            arrays_from_bytes(truncated, state)


# ------------------------------------------------------------------ one forgery for each check


def set_entry(name, index, value):
    """A forgery that sets an entry, or several."""

    def change(saved):
        saved[name][index] = value

    return change


def scaled(name, factor):
    """A forgery that multiplies an array."""

    def change(saved):
        saved[name] *= factor

    return change


def clock_entry(entry, value):
    """A forgery of an entry of the clock."""
    return set_entry("clock", entry, value)


def counter(entry, value):
    """A forgery of a counter."""
    return set_entry("counts", entry, value)


def combined(*changes):
    """A forgery made of several."""

    def change(saved):
        for forge_entry in changes:
            forge_entry(saved)

    return change


def event_times(index, value):
    """A forgery of the time of a particle's next event, in the agenda and in the queue."""
    return combined(
        set_entry("agenda.key", index, value), set_entry("queue.keys", divmod(index, 16), value)
    )


def particle_before_contact(saved):
    """Index of the first particle whose next event is a contact."""
    return np.flatnonzero(saved["agenda.kind"] >= 0)[0]


def with_itself(saved):
    """Make a particle the partner of its own contact."""
    i = particle_before_contact(saved)
    saved["agenda.slot_partner"][i, :] = i
    saved["agenda.slot_change"][i, :] = saved["changes"][i]


def later_slot(saved):
    """Delay the contact in a slot, but not the key of the event."""
    i = particle_before_contact(saved)
    saved["agenda.slot_time"][i, saved["agenda.kind"][i]] += 0.01


def loop_in_list(first, following):
    """A forgery that makes a particle of a list its own successor."""

    def change(saved):
        heads = saved[first]
        i = heads[heads >= 0][0]
        saved[following][i] = i

    return change


def detached(saved):
    """Make a particle that is alone in its cell its own successor, outside any list."""
    first, following = saved["cells.first"], saved["cells.following"]
    alone = next(i for i in first if i >= 0 and following[i] < 0)
    first[first == alone] = -1
    following[alone] = alone


def far_horizon(saved):
    """Move the next prediction of a particle far into the future."""
    saved["agenda.key"][np.flatnonzero(saved["agenda.kind"] < 0)[0]] = 1e6


def at_one_place(saved):
    """Put all particles at the same position."""
    saved["trajectory"][:] = saved["trajectory"][0]


def at_rest_but_some(saved):
    """Remove the typical speed, as if all particles rested, while some move slowly."""
    saved["clock"][TYPICAL_SPEED] = 0.0
    saved["trajectory"][::2, 2:4] *= 1e-9


def removed(saved):
    """Remove an array."""
    del saved["label"]


def added(saved):
    """Add an array."""
    saved["more"] = np.zeros(3)


def retyped(saved):
    """Change the type of an array."""
    saved["label"] = saved["label"].astype(np.int64)


def reshaped(saved):
    """Shorten an array."""
    saved["label"] = saved["label"][:-1]


def swapped_homes(saved):
    """Swap the cells of two particles, but not their lists."""
    home = saved["cells.home"]
    particle = np.flatnonzero(home != home[0])[0]
    home[[0, particle]] = home[[particle, 0]]


def another_day(saved):
    """Change the length of a day of the calendar."""
    saved["queue.pace"] *= 1.5


def no_event(saved):
    """Remove the event of a particle that has a time."""
    saved["agenda.kind"][0] = NOTHING


def without_wall(saved):
    """Make all predictions hits of boundaries."""
    saved["agenda.kind"][saved["agenda.kind"] < 0] = BOUNDARY


def at_boundary(saved):
    """Delay the hit of a boundary, but not the key of the event."""
    saved["agenda.kind"][0] = BOUNDARY
    saved["agenda.boundary_time"][0] = saved["agenda.key"][0] + 0.01


FORGERIES = [
    ("gas", removed, "another kind of state"),
    ("gas", added, "another kind of state"),
    ("gas", retyped, "another kind of state"),
    ("gas", reshaped, "another kind of state"),
    ("gas", set_entry("label", 0, -1996488696), "label is out of range"),
    ("gas", set_entry("label", slice(2), 1), "label numbers a particle twice"),
    ("gas", set_entry("agenda.slot_partner", 0, 40), "agenda.slot_partner is out of range"),
    ("gas", set_entry("agenda.kind", 0, 8), "agenda.kind is out of range"),
    ("gas", set_entry("changes", 0, -1), "changes is out of range"),
    ("gas", set_entry("shortlist.found", 0, -1), "shortlist.found is out of range"),
    ("gas", set_entry("queue.whose", 0, -1), "queue.whose is out of range"),
    ("gas", counter(COLLISIONS, 2**62), "counts is out of range"),
    ("gas", counter(LAST_FIRST, 40), "counts is out of range"),
    ("gas", counter(EXPONENT, 2**20), "counts is out of range"),
    ("gas", counter(SIMULTANEOUS_EVENTS, -1), "counts is out of range"),
    ("gas", counter(STARTED, 2), "counts is out of range"),
    ("gas", counter(SINCE_REBASE, 2**59), "counts has more collisions in a span than any run"),
    ("gas", counter(ALIGNED, 2**59), "counts has more predictions before the last alignment"),
    ("gas", set_entry("trajectory", (0, 0), np.nan), "trajectory has numbers out of bounds"),
    ("gas", set_entry("trajectory", (0, 2), 1e30), "trajectory has numbers out of bounds"),
    ("gas", set_entry("trajectory", (0, 2), 1e12), "trajectory has velocities out of bounds"),
    ("gas", set_entry("trajectory", (0, 4), 1e9), "trajectory begins in the future"),
    (
        "gas",
        set_entry("trajectory", (0, slice(2, 5)), (9.0, 0.0, -1e15)),
        "trajectory leads far away",
    ),
    (
        "sheared",
        set_entry("trajectory", (0, 1), 1e12),
        "trajectory leads to images that are too fast",
    ),
    ("bed", set_entry("trajectory", (0, 1), -9.0), "trajectory leads behind the effect floor"),
    ("bed", set_entry("trajectory", (0, 4), -1e12), "trajectory begins in the far past"),
    ("gas", set_entry("spin", (0, 0), -1e12), "spin is out of bounds"),
    ("gas", set_entry("ledger", (0, 0, 0), np.nan), "ledger has numbers out of bounds"),
    ("gas", clock_entry(BASE, np.inf), "clock has numbers out of bounds"),
    ("gas", clock_entry(SPAN, -1.0), "clock has a span that is no power of two"),
    ("gas", clock_entry(SPAN, 0.0), "clock has a span that is no power of two"),
    ("gas", clock_entry(SPAN, 3.0), "clock has a span that is no power of two"),
    (
        "gas",
        clock_entry(SPAN, 2.0**-20),
        "clock has another span than particles of its typical speed",
    ),
    ("gas", clock_entry(NOW, -1e6), "clock has a present that is far from its base"),
    ("gas", clock_entry(NOW, 2.0**49), "clock has a present that is far from its base"),
    ("gas", clock_entry(TYPICAL_SPEED, -1.0), "clock has negative numbers"),
    ("gas", at_rest_but_some, "clock has no typical speed where particles of very unlike speeds"),
    ("gas in cells", at_one_place, "trajectory has more particles at one place than fit there"),
    ("gas", clock_entry(LONGEST_HORIZON, np.nan), "clock has a horizon that is too near"),
    ("gas", clock_entry(LONGEST_HORIZON, -np.inf), "clock has a horizon that is too near"),
    ("gas", clock_entry(LONGEST_HORIZON, 1e-12), "clock has a horizon that is too near"),
    ("gas", set_entry("sweep.lines", (0, 0), np.nan), "sweep.lines has numbers out of bounds"),
    (
        "gas",
        set_entry("sweep.lines", (0, 40), 1.0),
        "sweep.lines has more particles than there are",
    ),
    ("gas", event_times(40, 1e6), "queue.keys has more particles than there are"),
    ("gas", set_entry("queue.least", (0, 3), 1.0), "queue.keys has more particles than there are"),
    ("gas", set_entry("agenda.key", 0, 0.0), "queue.keys differs from agenda.key"),
    ("gas", event_times(0, np.nan), "agenda.key has numbers out of bounds"),
    ("gas", set_entry("queue.least", (0, 0), 0.0), "queue.least differs from queue.keys"),
    ("gas", set_entry("queue.whose", 0, 20), "queue.whose differs from queue.keys"),
    ("gas", later_slot, "agenda.key differs from the time of its slot"),
    ("gas", with_itself, "agenda.slot_partner has particles that do not touch"),
    ("gas", without_wall, "agenda.kind has boundaries where there are none"),
    ("gas", no_event, "agenda.kind has no event where agenda.key has a time"),
    (
        "gas",
        set_entry("agenda.slot_time", slice(None), -1e6),
        "agenda.(key differs|slot_time lies)",
    ),
    ("gas", set_entry("agenda.complete_until", 0, -1e6), "agenda.complete_until lies in the past"),
    ("bed", at_boundary, "agenda.key differs from agenda.boundary_time"),
    (
        "bed",
        set_entry("agenda.boundary_code", 0, 100 * CODES),
        "agenda.boundary_code is out of range",
    ),
    ("bed", set_entry("phase", slice(None), 3.7), "phase is another than at the base of the clock"),
    ("sheared", set_entry("sums.contact_averages", (2, 0), 7.0), "sums.contact_averages has other"),
    (
        "sheared",
        set_entry("phase", slice(None), 1e9),
        "phase is another than at the base of the clock",
    ),
    ("gas in cells", set_entry("cells.home", 0, -1), "cells.home is out of range"),
    ("gas in cells", set_entry("cells.heading", 0, 4), "cells.heading is out of range"),
    ("gas in cells", set_entry("queue.events", 0, -(2**62)), "queue.events is out of range"),
    ("gas in cells", set_entry("queue.today", 0, -(2**63)), "queue.today is out of range"),
    (
        "gas in cells",
        set_entry("queue.today", 0, 2**61),
        "queue.today is after the day of an event",
    ),
    ("gas in cells", set_entry("queue.pace", 0, -1.0), "queue.pace is out of bounds"),
    ("gas in cells", set_entry("queue.pace", 0, 1e-30), "queue.pace is out of bounds"),
    ("gas in cells", another_day, "queue.first and queue.later do not list each particle once"),
    (
        "gas in cells",
        loop_in_list("queue.first", "queue.later"),
        "queue.first and queue.later do not",
    ),
    (
        "gas in cells",
        loop_in_list("cells.first", "cells.following"),
        "cells.first and cells.following",
    ),
    ("gas in cells", detached, "cells.first and cells.following do not list each particle once"),
    ("gas in cells", swapped_homes, "cells.first and cells.following do not list each"),
    ("gas in cells", far_horizon, "agenda.key lies in the far future"),
    ("gas in cells", set_entry("cells.leave", 0, -1e6), "cells.leave lies in the past"),
    (
        "layer",
        set_entry("cells.neighbours.members", (0, 15), 600),
        "cells.neighbours.members is out",
    ),
    (
        "layer",
        set_entry("cells.neighbours.number", 0, LIST_CAPACITY + 2),
        "cells.neighbours.number is out of range",
    ),
    (
        "layer",
        set_entry("cells.neighbours.frame", 1, 1e12),
        "cells.neighbours.frame is out of bounds",
    ),
    ("mixture", set_entry("bodies.mass", 0, 0.0), "bodies.mass is not positive"),
    ("mixture", set_entry("bodies.radius", 0, -1.0), "bodies.radius is not positive"),
    ("mixture", set_entry("bodies.species", 0, 2), "bodies.species is out of range"),
    ("mixture", set_entry("bodies.largest", 0, 1.0), "bodies.largest is not the largest radius"),
    ("mixture", set_entry("bodies.pairs", (0, 0, 0), np.nan), "bodies.pairs has restitutions or"),
    ("mixture", set_entry("bodies.pairs", (0, 0, 0), 1e9), "bodies.pairs has restitutions or"),
    (
        "mixture",
        set_entry("bodies.pairs", (0, 0, 2), -1.0),
        "bodies.pairs has coefficients of friction",
    ),
    ("mixture", set_entry("sweep.sizes", (0, 0), 0.0), "sweep.sizes differs from the radii"),
    ("mixture", scaled("bodies.radius", 9.0), "bodies.largest is not"),
    (
        "mixture",
        combined(scaled("bodies.radius", 9.0), scaled("bodies.largest", 9.0)),
        "bodies.radius is too large for the box",
    ),
    ("bath", set_entry("moments.langevin", 0, -1e9), "moments.langevin lies in the past"),
    ("bath", counter(EXPONENT, -40), "counts has an exponent with which steps of the bath"),
    (
        "heated in cells",
        set_entry("moments.thermostat", 0, -np.inf),
        "moments.thermostat lies in the",
    ),
    ("heated in cells", set_entry("log.made", 0, -1), "log.made is out of range"),
    ("container", set_entry("trajectory", (0, 1), 1e12), "trajectory leads behind the effect lid"),
    ("shaken", set_entry("trajectory", (0, 0), -9.0), "leads behind the effect shaken_walls"),
    (
        "spheres",
        set_entry("moments.contact_time", 0, np.nan),
        "moments.contact_time has numbers out of",
    ),
    (
        "spheres",
        set_entry("paths.crossings", 0, np.inf),
        "paths.crossings has numbers out of bounds",
    ),
]


@pytest.mark.parametrize(
    ("name", "change", "message"),
    slow_but([forgery for forgery in FORGERIES if forgery[0] in QUICK_GASES], FORGERIES),
)
def test_each_forgery_is_refused_in_one_line_and_changes_nothing(name, change, message):
    scene, states = reached(name)
    saved = {key: array.copy() for key, array in states[MIDDLE_STAGE].items()}
    change(saved)
    _, state = fresh(name)
    before = content(state)
    with pytest.raises(UnusableCheckpoint, match=message) as refusal:
        decode(saved, state, scene)
    assert "\n" not in str(refusal.value)
    assert content(state) == before


# ------------------------------------------------------------------ at random


FAILED, ENDED_EARLY, WENT_ON = 1, 2, 3
"""Exit statuses of a child process."""
OUTCOMES = {
    WENT_ON: "went on",
    ENDED_EARLY: "ended early in one line",
    FAILED: "ended in another error",
    -signal.SIGALRM: "hung",
}


def go_on(gas):
    """Make 200 more collisions; return the outcome as the status of a process."""
    try:
        gas.in_collisions(10, 20)
    except EndedEarlyError as error:
        return ENDED_EARLY if "\n" not in str(error) else FAILED
    return WENT_ON


def in_a_child(gas):
    """The outcome of running a gas in a fork of this process, which the kernel may crash."""
    child = os.fork()
    if child == 0:
        status = FAILED
        try:
            signal.signal(signal.SIGALRM, signal.SIG_DFL)
            signal.alarm(SECONDS)
            status = go_on(gas)
        finally:
            os._exit(status)
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    return OUTCOMES.get(status, f"signal {-status}")


def outcome_of(number, names):
    """(outcome, description) of forged state number `number`: refused, or run by a gas."""
    rng = np.random.default_rng([7, number])
    name = names[number % len(names)]
    scene, states = reached(name)
    forged, description = forge(rng, states[rng.integers(len(states))])
    _, state = fresh(name)
    try:
        decode(forged, state, scene)
    except UnusableCheckpoint as refusal:
        assert "\n" not in str(refusal)
        return "refused", description
    return in_a_child(Gas(scene, state)), f"{name}: {description}"


def campaign(numbers, names):
    """Assert that no forged state of these numbers crashes or hangs the kernel."""
    counts, failures = Counter(), []
    for number in numbers:
        outcome, description = outcome_of(number, names)
        counts[outcome] += 1
        if outcome not in ("refused", OUTCOMES[WENT_ON], OUTCOMES[ENDED_EARLY]):
            failures.append(f"{number}, {description}: {outcome}")
    print(dict(counts))
    assert not failures, "\n".join(failures)
    assert counts["refused"] and counts[OUTCOMES[WENT_ON]]


def test_forged_states_neither_crash_nor_hang_the_kernel():
    campaign(range(100), QUICK_GASES)


@pytest.mark.slow
@pytest.mark.parametrize("first", range(100, 4100, 1000))
def test_forged_states_of_all_gases_neither_crash_nor_hang_the_kernel(first):
    campaign(range(first, first + 1000), list(GASES))
