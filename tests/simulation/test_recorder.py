"""The recorder: units, chunks, books, collapse."""

import numpy as np
import pytest
from brute_force import begin, run, settings

from roughgas.kernel.state import EXPONENT
from roughgas.scene import initial_state
from roughgas.simulation.energies import energies, restored
from roughgas.simulation.recorder import Recorder

GAS = settings("gas", 20, [25, 25])


def test_columns_are_those_of_the_kernel():
    for interval, collisions in ((0.5, None), (None, 10)):
        (scene, state), (_, same) = (begin(GAS, 0.9, 0.2, 1) for _ in range(2))
        if interval:
            rows = Recorder().in_time(state, scene, interval, 130)
            plain = run(same, scene, 130, interval=interval)
        else:
            rows = Recorder().in_collisions(state, scene, collisions, 130)
            plain = run(same, scene, 130, collisions=collisions)
        for name in rows:
            assert np.array_equal(rows[name], plain[name]), name


def test_energies_of_a_refreshed_gas_can_be_restored():
    """As far as chaos lets one compare: with and without refreshing."""
    ends = []
    for refresh in (0, 2):
        scene, state = begin(GAS, 0.5, 0.5, 2)
        rows = Recorder().in_collisions(state, scene, 10, 10, refresh)
        ends.append((rows, restored(energies(rows, 20, 0.5), rows["exponent"])))
    (plain, expected), (refreshed, found) = ends
    assert refreshed["exponent"][-1] < 0.0
    assert refreshed["time"] == pytest.approx(plain["time"], rel=1e-7)
    for one, other in zip(found, expected, strict=True):
        assert one == pytest.approx(other, rel=1e-6)


@pytest.mark.parametrize("samples", [10, 130, 230])
def test_a_gas_is_refreshed_however_its_run_is_cut_into_calls(samples):
    (scene, state), (_, same) = (begin(GAS, 0.5, 0.5, 2) for _ in range(2))
    rows = Recorder().in_collisions(state, scene, 10, samples, 4)
    assert np.array_equal(rows["time"], run(same, scene, samples, collisions=10, refresh=4)["time"])
    assert state.counts[EXPONENT] == same.counts[EXPONENT] < 0


def test_it_sums_up_over_runs():
    recorder = Recorder()
    for seed in (1, 2):
        scene, state = begin(GAS, 0.9, 0.2, seed)
        recorder.in_collisions(state, scene, 10, 7)
        recorder.in_collisions(state, scene, 5, 4)
    assert recorder.collisions == 2 * (70 + 20) and recorder.seconds > 0.0


def test_a_gas_that_never_collides_comes_to_an_end():
    """One particle, sampled by collisions: the samples are taken all the same."""
    scene, _ = begin(GAS, 0.9, 0.2)
    state = initial_state(scene, settings("gas", 1, [25, 25]), np.random.default_rng(0))
    rows = Recorder().in_collisions(state, scene, 10, 5)
    assert np.all(rows["collisions"] == 0) and np.all(np.diff(rows["time"]) > 0.0)
