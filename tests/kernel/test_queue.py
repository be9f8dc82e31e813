"""The earliest event, found by either queue, against the minimum of all."""

import numpy as np
import pytest
from brute_force import begin, settings
from compiled import from_python

from roughgas.kernel import event_lists, memory
from roughgas.kernel.state import NOW, TYPICAL_SPEED

earliest, enter_in_queue, clear_calendar = map(
    from_python, (event_lists.earliest, event_lists.enter_in_queue, event_lists.clear_calendar)
)


@pytest.mark.parametrize("few", [0, 10_000])
@pytest.mark.parametrize("spread", [1e-3, 1.0, 1e6])
def test_the_earliest_event(few, spread, monkeypatch):
    """Times within a day, over a year and over many of them; some at the same instant, some
    never."""
    monkeypatch.setattr(memory, "FEW", few)
    scene, state = begin(settings("gas", 300, [60, 60]), 0.9, 0.2)
    rng = np.random.default_rng(0)
    state.clock[TYPICAL_SPEED] = 1.0
    if few == 0:
        clear_calendar(state, state.cells, scene)
    expected = np.full(300, np.inf)
    for step in range(4000):
        i = int(rng.integers(300)) if step < 600 else earliest(state.cells, state)
        now = 0.0 if step < 600 else state.agenda.key[i]
        state.clock[NOW] = now
        time = now + rng.choice([spread * rng.exponential(), 0.5, np.inf], p=[0.96, 0.02, 0.02])
        if time == np.inf and np.isfinite(expected).sum() < 20:
            time = now + spread
        expected[i] = time
        enter_in_queue(state.cells, state, i, time)
        if step > 400:
            assert state.agenda.key[earliest(state.cells, state)] == expected.min()


@pytest.mark.parametrize("few", [0, 10_000])
def test_nothing_is_ever_going_to_happen(few, monkeypatch):
    monkeypatch.setattr(memory, "FEW", few)
    _, state = begin(settings("gas", 300, [60, 60]), 0.9, 0.2)
    assert state.agenda.key[earliest(state.cells, state)] == np.inf
