"""What two replicas in one loop would gain: one could use what the other waits for.

    python -m benchmarks.replicas

Two states of each scene, N = 160, are taken through the same number of events one after the other
(a thousand each in turn), event by event in turn, and step by step in turn: both contacts, both
sweeps, both decisions. Collisions per second of both, medians of RUNS in turns. The machine's width
is all that this can use: instructions of both are in flight at once, as far as its window reaches.
"""

import time

import numpy as np

from benchmarks.scenes import CASES, steady
from roughgas.kernel import hooks
from roughgas.kernel.event_lists import choose_next, clear_contacts, earliest
from roughgas.kernel.jit import by_reference, entry, jit
from roughgas.kernel.loop import execute_event, predict_events, renew
from roughgas.kernel.mathematics import index
from roughgas.kernel.prediction import decide
from roughgas.kernel.state import COLLISIONS, NOW, PREDICTIONS, SPAN
from roughgas.kernel.sweep import draw_line, horizon, line_of, list_candidates, singles

NUMBER, EVENTS, RUNS, IN_TURN = 160, 500_000, 7, 1000


@jit
def _execute(state, scene):
    i = index(earliest(state))
    time = state.agenda.key[i]
    state.clock[NOW] = time
    affected = execute_event(state, scene, i, int(state.agenda.kind[i]), time)
    return affected[0], affected[1], time


@jit
def _predict(state, scene, i, time):
    if i >= 0:
        predict_events(state, scene, index(i), time)


@jit
def _renew_if_due(state, scene, time):
    if time >= state.clock[SPAN]:
        renew(state, scene)


@jit
def _event(state, scene):
    i, j, time = _execute(state, scene)
    _predict(state, scene, i, time)
    _predict(state, scene, j, time)
    _renew_if_due(state, scene, time)


@jit
def _sweep(state, scene, i, time):
    """The first half of predict_events."""
    agenda = state.agenda
    state.counts[PREDICTIONS] += 1
    if agenda.boundary_time is not None:
        boundary = hooks.next_boundary(scene.effects, state, scene, i)
        agenda.boundary_time[i], agenda.boundary_code[i] = boundary
    start, velocity = line_of(state, scene, i)
    end = time + horizon(state, scene, i)
    half = 0.5 * (end - time)
    number = list_candidates(state, scene, i, singles(start), singles(velocity), time + half, half)
    draw_line(state, i, start, velocity)
    return number, end


@jit
def _decide(state, scene, i, time, number, end):
    """The second half of predict_events."""
    clear_contacts(state.agenda, i, end)
    decide(state, scene, i, number, time, end, end)
    choose_next(state, i)


@jit
def _predict_both(one, other, scene, i, j, time, other_time):
    if i >= 0 and j >= 0:
        number, end = _sweep(one, scene, index(i), time)
        other_number, other_end = _sweep(other, scene, index(j), other_time)
        _decide(one, scene, index(i), time, number, end)
        _decide(other, scene, index(j), other_time, other_number, other_end)
        return
    _predict(one, scene, i, time)
    _predict(other, scene, j, other_time)


@entry
def one_after_the_other(one, other, scene, events):
    one, other, scene = by_reference(one), by_reference(other), by_reference(scene)
    for _ in range(events // IN_TURN):
        for _ in range(IN_TURN):
            _event(one, scene)
        for _ in range(IN_TURN):
            _event(other, scene)


@entry
def event_by_event(one, other, scene, events):
    one, other, scene = by_reference(one), by_reference(other), by_reference(scene)
    for _ in range(events):
        _event(one, scene)
        _event(other, scene)


@entry
def step_by_step(one, other, scene, events):
    one, other, scene = by_reference(one), by_reference(other), by_reference(scene)
    for _ in range(events):
        i, j, time = _execute(one, scene)
        k, m, other_time = _execute(other, scene)
        _predict_both(one, other, scene, i, k, time, other_time)
        _predict_both(one, other, scene, j, m, time, other_time)
        _renew_if_due(one, scene, time)
        _renew_if_due(other, scene, other_time)


def main() -> None:
    """Print rates, and their ratios to that of one after the other."""
    loops = one_after_the_other, event_by_event, step_by_step
    print(f"{'':24}" + "".join(f"{loop.__name__:>24}" for loop in loops))
    for case in CASES:
        (scene, one), (_, other) = steady(case, NUMBER), steady(case, NUMBER)
        rates = np.array([[_rate(loop, one, other, scene) for loop in loops] for _ in range(RUNS)])
        gains = np.median(rates / rates[:, :1], axis=0)
        print(
            f"{case.title:24}"
            + "".join(
                f"{rate:12.3g} (x {gain:.2f})".rjust(24)
                for rate, gain in zip(np.median(rates, axis=0), gains, strict=True)
            ),
            flush=True,
        )


def _rate(loop, one, other, scene) -> float:
    loop(one, other, scene, IN_TURN)  # compiles
    before, begin = one.counts[COLLISIONS] + other.counts[COLLISIONS], time.process_time()
    loop(one, other, scene, EVENTS)
    made = one.counts[COLLISIONS] + other.counts[COLLISIONS] - before
    return float(made) / (time.process_time() - begin)


if __name__ == "__main__":
    main()
