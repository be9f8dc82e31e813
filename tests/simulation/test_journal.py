"""A run that is stopped anywhere goes on from its journal, and ends with the same bits."""

import io
import itertools
import pickle

import numpy as np
import pytest
from schedules import TINY

from roughgas import config
from roughgas.base import InputError
from roughgas.scene import build
from roughgas.simulation import journal as journals
from roughgas.simulation.journal import Journal
from roughgas.simulation.observing import Seen
from roughgas.simulation.point import run_point

COSTS = {"kernel_seconds"}
DRIVEN = config.load_experiment(config.SHIPPED, "sheared", "small")
DRIVEN["schedule"] |= {"equilibrate": 20, "measure": 60, "sample_every": 0.5}
TARGET = {"target_stderr": 0.04, "sample_every": 2}
WATCHED = {"mean_square_displacement": {"lags": 3}, "cumulants": {"every": 7}}
RUNS = {
    "cooling": TINY | {"keep_state": True},
    "watched cooling": TINY | {"observables": {"cumulants": {"every": 3}}},
    "driven": DRIVEN | {"keep_state": True},
    "watched": DRIVEN | {"observables": WATCHED},
    "stages": DRIVEN
    | {
        "keep_state": True,
        "schedule": {
            "kind": "stages",
            "sample_every": 0.5,
            "stages": [{"duration": 10}, {"duration": 15, "effects": {"shear": {"velocity": 3}}}],
        },
    },
    "flow": DRIVEN | {"particles": 100, "box": [40, 40]},
    "target": DRIVEN | {"schedule": DRIVEN["schedule"] | TARGET},
}


class Killed(Exception):
    """What ends a run in these tests."""


def run(settings, journal=None):
    scene = build(settings, 0.9, 0.3)
    return run_point(scene, settings, 1, journal=journal).variables


@pytest.fixture
def killed_after(monkeypatch):
    """Let journals be written at each chance, and the run be killed at the n-th writing."""

    def arm(number):
        count = itertools.count(1)

        def write(self, *what):
            kept(self, *what)
            if next(count) == number:
                raise Killed

        monkeypatch.setattr(Journal, "write", write)

    kept = Journal.write
    monkeypatch.setattr(Journal, "due", lambda _: True)
    monkeypatch.setattr("roughgas.simulation.recorder.BRIEF", 0.0)  # as many calls as of a long run
    return arm


@pytest.mark.parametrize("name", RUNS)
def test_a_run_killed_again_and_again_ends_with_the_bits_of_an_undisturbed_one(
    tmp_path, killed_after, name
):
    settings, path, kills = RUNS[name], tmp_path / "journal", 0
    whole = run(settings)
    killed_after(3)
    while True:
        try:
            found = run(settings, Journal(path, "this"))
            break
        except Killed:
            kills += 1
            killed_after(3 + kills % 4)
    assert kills >= 3
    assert found.keys() == whole.keys()
    for key in whole.keys() - COSTS:
        np.testing.assert_array_equal(found[key], whole[key], key)


def test_a_journal_of_another_run_is_not_used(tmp_path, killed_after):
    killed_after(2)
    with pytest.raises(Killed):
        run(TINY, Journal(tmp_path / "journal", "one"))
    other = Journal(tmp_path / "journal", "another")
    assert other.refused == "belongs to other settings or to other sources" and not other.begun
    same = Journal(tmp_path / "journal", "one")
    assert same.begun and not same.refused


def test_a_damaged_journal_is_not_used(tmp_path, killed_after):
    path = tmp_path / "journal"
    killed_after(2)
    with pytest.raises(Killed):
        run(TINY, Journal(path, "one"))
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 255
    path.write_bytes(content)
    assert Journal(path, "one").refused == "is damaged"


def test_a_run_that_takes_less_than_minutes_writes_none(tmp_path):
    run(TINY, Journal(tmp_path / "journal", "this"))
    assert float(journals.USUAL) >= 60 and not list(tmp_path.iterdir())


def test_a_run_that_has_ended_is_not_made_again(tmp_path, killed_after, monkeypatch):
    killed_after(0)
    path = tmp_path / "journal"
    found = run(TINY, Journal(path, "this"))
    monkeypatch.setattr("roughgas.simulation.recorder.record", None)
    again = run(TINY, Journal(path, "this"))
    assert again["R"] == found["R"] and again["kernel_seconds"] == found["kernel_seconds"]


def test_seconds_that_are_none(tmp_path, monkeypatch):
    monkeypatch.setenv(journals.SECONDS, "often")
    with pytest.raises(
        InputError, match=r"^ROUGHGAS_CHECKPOINT_SECONDS.* often.* must lie in .*1e9"
    ):
        Journal(tmp_path / "journal", "this")


def test_what_observers_have_seen_can_run_nothing():
    with pytest.raises(pickle.UnpicklingError, match=r"builtins\.eval"):
        Seen(io.BytesIO(pickle.dumps(eval))).load()
