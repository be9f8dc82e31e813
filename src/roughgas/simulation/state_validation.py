"""Validation of a State from a file, so that it can neither crash nor hang the kernel.

An invalid state may end the process with a signal, or run for ever in compiled code that Ctrl-C
does not stop. Every integer has a range (kernel/state.py). Lists and queues hold each particle
once, and agree with the agenda. Numbers are small enough for exact integer parts. Times do not lie
in the far past, through which the kernel would have to advance; speeds and numbers of predictions
are limited, so that a span of the clock ends.

All limits are far from the values that runs reach. The physics is not checked: a state with
overlapping particles is valid.

Functions `_check_...` yield the faults that they find. The base of the clock moves on by whole
spans; a span is a power of two. The agenda holds each particle's next event. A path is the free
flight of a particle since its last event.
"""

import math
from collections.abc import Iterator, Mapping

import numpy as np

from roughgas.kernel import hooks
from roughgas.kernel.event_lists import LAST_DAY
from roughgas.kernel.layout import BLOCK
from roughgas.kernel.loop import CELLS_PER_SPAN
from roughgas.kernel.particles import (
    fold_into_box,
    free_flight,
    image_numbers,
    image_shift_at,
    shifted,
)
from roughgas.kernel.state import (
    ALIGNED,
    BASE,
    BOUNDARY,
    EXPONENT,
    EXTENT,
    INSTANT_END,
    LONGEST_HORIZON,
    NOBODY,
    NOTHING,
    NOW,
    ORIGIN,
    PREDICTIONS,
    SINCE_REBASE,
    SPAN,
    STARTED,
    TYPICAL_SPEED,
    Blocks,
    Calendar,
    Cells,
    State,
    integer_ranges,
)
from roughgas.scene import MIN_PERIOD, Scene, walls_of

MAX_NUMBER = 2.0**50  # its integer part is exact, and fits in an integer
MAX_SPEED = 2.0**40
MAX_STEPS_PER_SPAN = 2.0**20  # crossings of the extent, or other repeated steps, per clock span
MAX_SPANS_FROM_BASE = 2.0**40  # from the clock's base to the present
MAX_FLIGHT_SPANS = 2.0**24  # since the beginning of a flight
MIN_BODY = 2.0**-50  # radius, mass or inertia
MIN_DAYS_PER_SPAN, MAX_DAYS_PER_SPAN = 2.0**-30, 2.0**50  # of the calendar queue
MAX_CROWDING = 4.0  # ratio of particles in a cell to its capacity
MAX_PREDICTION_SPANS = 2.0**10  # far more than predictions with cells reach ahead
MIN_CONTACT_DISTANCE, MAX_CONTACT_DISTANCE = 0.5, 1.5  # over the sum of the radii
SCRATCH_ARRAYS = ("shortlist.when",)
TIME_ARRAYS = (
    *("agenda.key", "agenda.slot_time", "agenda.complete_until", "agenda.boundary_time"),
    *("queue.keys", "queue.least", "cells.leave"),
)
"""Arrays whose entries may be infinite."""
RESULT_ARRAYS = ("ledger", "log.rows")
"""Arrays without influence on motion, with finite numbers of any size, as the sums of effects."""
SEPARATELY_CHECKED_ARRAYS = ("clock", "bodies.pairs", "sweep.lines")
"""Arrays whose entries have specific bounds."""
EFFECTS_WITH_DUE_TIMES = ("thermostat", "langevin")
"""Effects whose moments are due times."""

Arrays = Mapping[str, np.ndarray]


def faults(state: State, arrays: Arrays, scene: Scene) -> Iterator[str]:
    """Yield the faults of the kernel's state, each as the name of an array with a reason.

    `arrays` are the arrays of the state by dotted name. Each check assumes that earlier checks have
    passed: only the first fault is certain.
    """
    with np.errstate(all="ignore"):
        yield from _check_integers(state, arrays)
        yield from _check_numbers(arrays)
        yield from _check_clock(state, scene)
        yield from _check_counts(state)
        yield from _check_padding(state)
        yield from _check_bodies(state, scene)
        yield from _check_effects(state, scene)
        yield from _check_motion(state, scene)
        if state.counts[STARTED]:  # else all events will be predicted anew
            yield from _check_agenda(state)
            yield from _check_due_times(state, scene)
            yield from _check_queue(state)
            yield from _check_cells(state.cells)
            yield from _check_contacts(state, scene)


# ------------------------------------------------------------------ each array for itself


def _check_integers(state: State, arrays: Arrays) -> Iterator[str]:
    """Check that integers are within their ranges, and that particle numbers are a permutation."""
    for name, (minimum, maximum) in integer_ranges(state).items():
        if name in arrays and ((arrays[name] < minimum).any() or (arrays[name] > maximum).any()):
            yield f"{name} is out of range"
    if not np.array_equal(np.sort(state.label), np.arange(len(state.label))):
        yield "label numbers a particle twice"


def _check_numbers(arrays: Arrays) -> Iterator[str]:
    """Check that the floating-point numbers of each array are within its bounds."""
    for name, array in arrays.items():
        if array.dtype.kind != "f" or name in SCRATCH_ARRAYS:
            continue
        if not _is_in_bounds(name, array):
            yield f"{name} has numbers out of bounds"


def _is_in_bounds(name: str, array: np.ndarray) -> bool:
    """Return whether all numbers of the array with this name are within its bounds."""
    if name in TIME_ARRAYS or name.startswith("moments."):
        return not np.isnan(array).any()
    if name in SEPARATELY_CHECKED_ARRAYS:
        return True
    if name in RESULT_ARRAYS or name.startswith("sums."):
        return bool(np.isfinite(array).all())
    return bool((np.abs(array) <= MAX_NUMBER).all())


def _check_clock(state: State, scene: Scene) -> Iterator[str]:
    """Check that the clock is finite, has a legal span, and shows a time near its base."""
    clock = state.clock
    span, now, horizon, speed = clock[[SPAN, NOW, LONGEST_HORIZON, TYPICAL_SPEED]]
    bounded = np.abs(clock[[BASE, NOW, SPAN, TYPICAL_SPEED, EXTENT, INSTANT_END]]) <= MAX_NUMBER
    if not (bounded.all() and np.isfinite(clock[ORIGIN])):
        yield "clock has numbers out of bounds"
    if not (span > 0.0 and math.frexp(span)[0] == 0.5):
        yield "clock has a span that is no power of two"
    if not -span <= now <= MAX_SPANS_FROM_BASE * span:
        yield "clock has a present that is far from its base"
    if not min(speed, clock[EXTENT]) >= 0.0:
        yield "clock has negative numbers"
    if state.counts[STARTED] and not horizon >= span / MAX_STEPS_PER_SPAN:
        yield "clock has a horizon that is too near"
    if state.counts[STARTED] and speed > 0.0 and span != _expected_span(speed, state, scene):
        yield "clock has another span than particles of its typical speed"


def _expected_span(speed: float, state: State, scene: Scene) -> float:
    """Return the span of the clock that the kernel chooses for particles of a typical `speed`."""
    distance = scene.extent
    if state.cells is not None:
        distance = min(distance, CELLS_PER_SPAN * max(state.cells.widths))
    return math.ldexp(0.5, math.frexp(distance / speed)[1])


def _check_counts(state: State) -> Iterator[str]:
    """Check that the counters of collisions and predictions are consistent and not too large."""
    counts = state.counts
    if counts[ALIGNED] > counts[PREDICTIONS]:
        yield "counts has more predictions before the last alignment than in all"
    if counts[SINCE_REBASE] > MAX_STEPS_PER_SPAN * len(state.changes):
        yield "counts has more collisions in a span than any run"


def _check_padding(state: State) -> Iterator[str]:
    """Check that the unused ends of arrays, longer than the number of particles, hold none."""
    particles = len(state.changes)
    if state.sweep is not None:
        lines = state.sweep.lines
        if state.counts[STARTED] and not (np.abs(lines[:, :particles]) <= MAX_NUMBER).all():
            yield "sweep.lines has numbers out of bounds"
        if not np.isnan(lines[:, particles:]).all():
            yield "sweep.lines has more particles than there are"
    if isinstance(state.queue, Blocks):
        keys, block_minima = state.queue.keys.ravel(), state.queue.least.ravel()
        padding = keys[particles:], block_minima[len(state.queue.keys) :]
        if not all((times == np.inf).all() for times in padding):
            yield "queue.keys has more particles than there are"
        if not np.array_equal(keys, state.agenda.key):
            yield "queue.keys differs from agenda.key"


# ------------------------------------------------------------------ particles and effects


def _check_bodies(state: State, scene: Scene) -> Iterator[str]:
    """Check radii, masses, inertias and contact coefficients of a mixture's particles."""
    bodies = state.bodies
    if bodies is None:
        return
    for name in ("radius", "mass", "inertia"):
        if not (getattr(bodies, name) >= MIN_BODY).all():
            yield f"bodies.{name} is not positive"
    if bodies.largest[0] != bodies.radius.max():
        yield "bodies.largest is not the largest radius"
    if not all(length is None or length >= MIN_PERIOD * bodies.largest[0] for length in scene.box):
        yield "bodies.radius is too large for the box"
    r, beta, mu = bodies.pairs[:, :-1, 0], bodies.pairs[:, :-1, 1], bodies.pairs[:, :, 2]
    if not (((r >= 0.0) & (r <= 1.0)).all() and (np.abs(beta) <= 1.0).all()):
        yield "bodies.pairs has restitutions or roughnesses out of range"
    if not (mu >= 0.0).all() and not (scene.effects.friction is None and np.isnan(mu).all()):
        yield "bodies.pairs has coefficients of friction out of range"
    if state.sweep is not None and state.sweep.sizes is not None:
        rounded_up = np.nextafter(bodies.radius.astype(np.float32), np.float32(np.inf))
        if not np.array_equal(state.sweep.sizes[0, : len(rounded_up)], rounded_up):
            yield "sweep.sizes differs from the radii"


def _check_effects(state: State, scene: Scene) -> Iterator[str]:
    """Check the effects' phases, running sums and times of due kicks."""
    effects, clock = scene.effects, state.clock
    for hook in hooks.active(effects, "phase"):
        phase = hook.function(effects[hook.effect_index], hook.account, clock[BASE])
        assert state.phase is not None
        if state.counts[STARTED] and not math.isclose(
            state.phase[hook.account], phase, abs_tol=1e-6
        ):
            yield "phase is another than at the base of the clock"
    for effect_index, powers in hooks.sums(effects).items():
        assert state.sums is not None
        if not np.array_equal(state.sums[effect_index][2], list(powers.values())):
            yield f"sums.{effects._fields[effect_index]} has other powers of velocity"
    for name in EFFECTS_WITH_DUE_TIMES:
        due = getattr(state.particle_times, name)
        if due is not None and not ((due >= clock[NOW] - clock[SPAN]) & (due <= MAX_NUMBER)).all():
            yield f"moments.{name} lies in the past"
    bath = effects.langevin
    if bath is not None:
        exponent = int(state.counts[EXPONENT])
        if exponent < 0 and math.ldexp(bath.interval, exponent) < clock[SPAN] / MAX_STEPS_PER_SPAN:
            yield "counts has an exponent with which steps of the bath take too long"


def _check_motion(state: State, scene: Scene) -> Iterator[str]:
    """Check speeds, distances and times of the particles' paths."""
    clock, dimension = state.clock, len(scene.box)
    now, span, begun = clock[NOW], clock[SPAN], state.trajectory[:, -1]
    fastest = min(MAX_SPEED, MAX_STEPS_PER_SPAN * scene.extent / span)
    if not (np.abs(state.trajectory[:, dimension:-1]) <= fastest).all():
        yield "trajectory has velocities out of bounds"
    if state.spin is not None and not (np.abs(state.spin) <= fastest).all():
        yield "spin is out of bounds"
    if not (begun <= now + span).all():
        yield "trajectory begins in the future"
    if (
        hooks.active(scene.effects, "predict")
        and not (begun >= now - MAX_FLIGHT_SPANS * span).all()
    ):
        yield "trajectory begins in the far past"
    image_motion = hooks.image_shift(scene.effects, state)
    for time in (now - span, now + span):
        path = free_flight(_paths(state, slice(None)), time, hooks.acceleration(scene.effects))
        if not (np.abs(path[0]) <= MAX_NUMBER).all():
            yield "trajectory leads far away"
        _, velocity = fold_into_box(*path, scene.box, image_shift_at(image_motion, time))
        if not (np.abs(velocity) <= fastest).all():
            yield "trajectory leads to images that are too fast"
    yield from _check_crowding(state, scene)
    yield from _check_walls(state, scene)
    if (
        clock[TYPICAL_SPEED] == 0.0
        and state.cells is None
        and not _have_similar_speeds(state.trajectory)
    ):
        yield "clock has no typical speed where particles of very unlike speeds move"
    if state.cells is not None and state.cells.neighbours is not None:
        position, velocity = state.cells.neighbours.frame
        if not abs(velocity) <= fastest or not abs(position + velocity * now) <= MAX_NUMBER:
            yield "cells.neighbours.frame is out of bounds"


def _have_similar_speeds(trajectory: np.ndarray) -> bool:
    """Return whether the speeds of all moving particles agree within a factor MAX_STEPS_PER_SPAN.

    Without a typical speed, each particle's own speed limits how far ahead contacts are predicted.
    """
    dimension = trajectory.shape[1] // 2
    speeds = np.sqrt((trajectory[:, dimension:-1] ** 2).sum(axis=1))
    moving = speeds[speeds > 0.0]
    return bool(moving.min(initial=np.inf) * MAX_STEPS_PER_SPAN >= moving.max(initial=0.0))


def _check_crowding(state: State, scene: Scene) -> Iterator[str]:
    """Check that no cell has more particles than fit there.

    The kernel tests all pairs in a cell, which would take too long.
    """
    cells = state.cells
    if cells is None:
        return
    now, dimension = state.clock[NOW], len(scene.box)
    path = free_flight(_paths(state, slice(None)), now, hooks.acceleration(scene.effects))
    image_shift = image_shift_at(hooks.image_shift(scene.effects, state), now)
    position, _ = fold_into_box(*path, cells.periods, image_shift)
    radius = 1.0 if state.bodies is None else state.bodies.radius.min()
    ball = math.pi if dimension == 2 else 4.0 * math.pi / 3.0
    fitting = math.prod(width / radius + 2.0 for width in cells.widths) / ball
    cell_of_particle = np.zeros(len(state.changes), np.int64)
    for k in reversed(range(dimension)):
        cell = np.floor(position[k] / cells.widths[k]).astype(np.int64)
        cell_of_particle = cell_of_particle * cells.counts[k] + cell % cells.counts[k]
    if np.bincount(cell_of_particle).max() > MAX_CROWDING * fitting:
        yield "trajectory has more particles at one place than fit there"


def _check_walls(state: State, scene: Scene) -> Iterator[str]:
    """Check that no particle's centre is behind a wall, at the start of its path or at present.

    Behind a shaken wall, the search for a hit may never end.
    """
    now, paths = state.clock[NOW], _paths(state, slice(None))
    for position in (paths[0], free_flight(paths, now, hooks.acceleration(scene.effects))[0]):
        for name, wall in walls_of(scene.effects).items():
            place, across = wall.side, position[wall.axis]
            gaps = [across, place.position - across]
            if place.inwards is not None:
                gaps = [place.inwards * (across - place.position)]
            if not all((gap >= 0.0).all() for gap in gaps):
                yield f"trajectory leads behind the effect {name}"


def _paths(state: State, particles: np.ndarray | slice) -> tuple:
    """Return the paths of particles: positions and velocities by axis, and times of the beginning.

    `particles` are indices of rows; each array has an entry per particle.
    """
    columns = state.trajectory[particles].T
    dimension = len(columns) // 2
    return tuple(columns[:dimension]), tuple(columns[dimension:-1]), columns[-1]


# ------------------------------------------------------------------ future events


def _check_agenda(state: State) -> Iterator[str]:
    """Check that each particle's next event agrees with the time under which it is queued."""
    agenda, number = state.agenda, len(state.changes)
    key, event = agenda.key[:number], agenda.kind
    contacts = np.flatnonzero(event >= 0)
    if not np.array_equal(agenda.slot_time[contacts, event[contacts]], key[contacts]):
        yield "agenda.key differs from the time of its slot"
    at_boundary = event == BOUNDARY
    if agenda.boundary_time is None:
        if at_boundary.any():
            yield "agenda.kind has boundaries where there are none"
    elif not np.array_equal(agenda.boundary_time[at_boundary], key[at_boundary]):
        yield "agenda.key differs from agenda.boundary_time"
    if not np.array_equal(event == NOTHING, key == np.inf):
        yield "agenda.kind has no event where agenda.key has a time"
    latest = MAX_NUMBER if state.cells is None else state.clock[NOW] + 2.0 * state.clock[SPAN]
    if not (key[event != NOTHING] <= latest).all():
        yield "agenda.key lies in the far future"


def _check_due_times(state: State, scene: Scene) -> Iterator[str]:
    """Check that no event of the agenda, and no departure from a cell, lies in the past."""
    agenda, earliest = state.agenda, state.clock[NOW] - state.clock[SPAN]
    for name in ("key", "slot_time", "complete_until", "boundary_time"):
        times = getattr(agenda, name)
        if times is not None and not (times >= earliest).all():
            yield f"agenda.{name} lies in the past"
    if state.cells is not None and not (state.cells.leave >= earliest).all():
        yield "cells.leave lies in the past"


def _check_queue(state: State) -> Iterator[str]:
    """Check that the queue holds each particle's next event once."""
    if isinstance(state.queue, Blocks):
        yield from _check_blocks(state.queue)
    else:
        yield from _check_calendar(state.queue, state.agenda.key, state.clock[SPAN])


def _check_blocks(queue: Blocks) -> Iterator[str]:
    """Check that the queue in blocks has the earliest event of each block."""
    keys, block_minima, minimum_owners = queue.keys, queue.least.ravel(), queue.whose
    blocks = len(keys)
    if not np.array_equal(block_minima[:blocks], keys.min(axis=1)):
        yield "queue.least differs from queue.keys"
    misplaced = minimum_owners // BLOCK != np.arange(blocks)
    if misplaced.any() or not np.array_equal(keys.ravel()[minimum_owners], block_minima[:blocks]):
        yield "queue.whose differs from queue.keys"


def _check_calendar(queue: Calendar, key: np.ndarray, span: float) -> Iterator[str]:
    """Check that the calendar queue lists each particle once, on the day of its event.

    `key` (N,) has the times of the events, and `span` is the span of the clock.
    """
    if not MIN_DAYS_PER_SPAN <= queue.pace[0] * span <= MAX_DAYS_PER_SPAN:
        yield "queue.pace is out of bounds"
    listed = key < np.inf
    days = np.minimum(key * queue.pace[0], LAST_DAY).astype(np.int64)
    if listed.any() and queue.today[0] > days[listed].min():
        yield "queue.today is after the day of an event"
    if not _are_lists(queue.first, queue.later, days & (len(queue.first) - 1), listed):
        yield "queue.first and queue.later do not list each particle once, on its day"


def _check_cells(cells: Cells | None) -> Iterator[str]:
    """Check that the lists of cells hold each particle once, in its own cell."""
    if cells is None:
        return
    everybody = np.ones(len(cells.home), bool)
    if not _are_lists(cells.first, cells.following, cells.home, everybody):
        yield "cells.first and cells.following do not list each particle once, at home"


def _are_lists(
    first: np.ndarray, following: np.ndarray, list_of_particle: np.ndarray, listed: np.ndarray
) -> bool:
    """Return whether linked lists hold each `listed` particle once, in its own list, and no other.

    `first` has the first particle of each list, `following` the successor of each particle; NOBODY
    ends a list. `list_of_particle` is the index of the list of each particle. If no particle has
    two predecessors, lists have no loops, but a loop may exist apart from all lists.
    """
    followers = following[listed]
    members = np.concatenate([first, followers])
    if not np.array_equal(np.bincount(members[members != NOBODY], minlength=len(listed)), listed):
        return False
    lists = np.flatnonzero(first != NOBODY)
    present, count = first[lists], 0
    while len(present):
        if not np.array_equal(list_of_particle[present], lists):
            return False
        count += len(present)
        successors = following[present]
        lists, present = lists[successors != NOBODY], successors[successors != NOBODY]
    return count == listed.sum()


def _check_contacts(state: State, scene: Scene) -> Iterator[str]:
    """Check that partners touch at the time of their contact, and that none is its own partner.

    Two particles at the same position have no normal direction.
    """
    agenda, box = state.agenda, scene.box
    latest = MAX_NUMBER
    if state.cells is not None:  # later contacts are predicted anew
        latest = state.clock[NOW] + MAX_PREDICTION_SPANS * state.clock[SPAN]
    due = (agenda.slot_time <= latest) & (agenda.kind >= 0)[:, None]
    due &= agenda.slot_change == state.changes[agenda.slot_partner]
    i, slot = np.nonzero(due)
    j, time = agenda.slot_partner[i, slot], agenda.slot_time[i, slot]
    gravity, image_motion = (
        hooks.acceleration(scene.effects),
        hooks.image_shift(scene.effects, state),
    )
    positions = [free_flight(_paths(state, particles), time, gravity)[0] for particles in (i, j)]
    separation = tuple(a - b for a, b in zip(*positions, strict=True))
    image_motion = image_shift_at(image_motion, time)
    separation, _ = shifted(
        separation, separation, image_numbers(separation, box, image_motion), box, image_motion
    )
    contact_distance = (
        2.0 if state.bodies is None else state.bodies.radius[i] + state.bodies.radius[j]
    )
    relative_distance = np.sqrt(sum(component**2 for component in separation)) / contact_distance
    if not (
        (relative_distance >= MIN_CONTACT_DISTANCE) & (relative_distance <= MAX_CONTACT_DISTANCE)
    ).all():
        yield "agenda.slot_partner has particles that do not touch at their contact"
