"""A run that is stopped anywhere continues from its checkpoint, and ends with the same bits."""

import io
import itertools
import pickle

import numpy as np
import pytest
from raw import build, run_point, typed
from schedules import TINY
from slow_cases import slow_but

from roughgas import config
from roughgas import simulate as simulate_point
from roughgas.base import InputError
from roughgas.base.labels import grid_points
from roughgas.simulation import checkpoint as checkpoints
from roughgas.simulation.checkpoint import Checkpoint
from roughgas.simulation.observable_tracker import ObservableUnpickler
from roughgas.simulation.run_points import checkpoint_owner
from roughgas.simulation.tracker import Tracker

COSTS = {"kernel_seconds"}
DRIVEN = config.load_experiment(config.SHIPPED, "sheared", "small").raw
DRIVEN["schedule"] |= {"equilibrate": 20, "measure": 60, "sample_every": 0.5}
TARGET = {"target_stderr": 0.04, "sample_every": 2}
DRAWN_SPINS = {"duration": 3, "spin_temperature": 1.0}  # draws random spins
OBSERVABLES = {"mean_square_displacement": {"lags": 3}, "cumulants": {"every": 7}}
RUNS = {
    "cooling": TINY | {"keep_state": True},
    "watched cooling": TINY | {"observables": {"cumulants": {"every": 3}}},
    "driven": DRIVEN | {"keep_state": True},
    "watched": DRIVEN | {"observables": OBSERVABLES},
    "stages": DRIVEN
    | {
        "keep_state": True,
        "schedule": {
            "kind": "stages",
            "sample_every": 0.5,
            "stages": [{"duration": 10}, {"duration": 15, "effects": {"shear": {"velocity": 3}}}],
        },
    },
    "uneven stages": TINY
    | {
        "keep_state": True,
        "schedule": {
            "kind": "stages",
            "sample_every": 0.5,
            "stages": [
                DRAWN_SPINS | {"samples_per_decade": 3, "first_sample": 0.1, "sample_start": True},
                {"duration": 5, "sample_every": 0.25, "beta": -1.0, "spin_temperature": 0.0},
                DRAWN_SPINS | {"sample_at": [0, 1.5], "beta": 0.3},
            ],
        },
    },
    "flow": DRIVEN | {"particles": 100, "box": [40, 40]},
    "waiting": DRIVEN | {"schedule": DRIVEN["schedule"] | {"relaxation_times": 3}},
    "target": DRIVEN | {"schedule": DRIVEN["schedule"] | TARGET},
}


class Killed(Exception):
    """The exception that ends a run in these tests."""


def run(settings, checkpoint=None):
    """The variables of a point."""
    scene = build(settings, 0.9, 0.3)
    return run_point(scene, settings, 1, checkpoint=checkpoint).variables


@pytest.fixture
def killed_after(monkeypatch):
    """A function that lets checkpoints be written at each call, and raises Killed at the n-th."""

    def arm(number):
        count = itertools.count(1)

        def write(self, *arguments):
            write_checkpoint(self, *arguments)
            if next(count) == number:
                raise Killed

        monkeypatch.setattr(Checkpoint, "write", write)

    write_checkpoint = Checkpoint.write
    monkeypatch.setattr(Checkpoint, "due", lambda _: True)
    monkeypatch.setattr(
        "roughgas.simulation.gas.SHORTEST_CALL", 0.0
    )  # as many calls as of a long run
    return arm


@pytest.mark.parametrize("name", slow_but({"driven", "watched", "stages"}, RUNS))
def test_a_run_killed_again_and_again_ends_with_the_bits_of_an_undisturbed_one(
    tmp_path, killed_after, name
):
    settings, path, kills = RUNS[name], tmp_path / "checkpoint", 0
    undisturbed = run(settings)
    killed_after(3)
    while True:
        try:
            resumed = run(settings, Checkpoint(path, "this"))
            break
        except Killed:
            kills += 1
            killed_after(3 + kills % 4)
    assert kills >= 3
    assert resumed.keys() == undisturbed.keys()
    for key in undisturbed.keys() - COSTS:
        np.testing.assert_array_equal(resumed[key], undisturbed[key], key)


def test_a_checkpoint_of_another_run_is_not_used(tmp_path, killed_after):
    killed_after(2)
    with pytest.raises(Killed):
        run(TINY, Checkpoint(tmp_path / "checkpoint", "one"))
    of_another_run = Checkpoint(tmp_path / "checkpoint", "another")
    assert (
        of_another_run.refused == "belongs to other settings or to other sources"
        and not of_another_run.has_content
    )
    of_same_run = Checkpoint(tmp_path / "checkpoint", "one")
    assert of_same_run.has_content and not of_same_run.refused


def test_a_checkpoint_belongs_to_the_functions_that_observe():
    """Even if functions have the same names."""
    experiment, (grid_point,) = typed(TINY), grid_points([0.9], [0.3], [1])
    scene = build(TINY, 0.9, 0.3)

    def owner(function):
        return checkpoint_owner(scene, experiment, grid_point, [], {"name": function})

    first, second = (lambda frame: frame.time), (lambda frame: 2.0 * frame.time)
    assert owner(first) == owner(first) != owner(second)
    assert owner(first) != checkpoint_owner(scene, experiment, grid_point, [])


def test_a_damaged_checkpoint_is_not_used(tmp_path, killed_after):
    path = tmp_path / "checkpoint"
    killed_after(2)
    with pytest.raises(Killed):
        run(TINY, Checkpoint(path, "one"))
    content = bytearray(path.read_bytes())
    middle = len(content) // 2
    for byte in range(middle, middle + 64):  # more than the padding between two arrays
        content[byte] ^= 255
    path.write_bytes(content)
    assert Checkpoint(path, "one").refused == "is damaged"


def test_short_runs_write_no_checkpoint(tmp_path):
    run(TINY, Checkpoint(tmp_path / "checkpoint", "this"))
    assert float(checkpoints.DEFAULT_INTERVAL) >= 60 and not list(tmp_path.iterdir())


def test_a_run_that_has_ended_is_not_made_again(tmp_path, killed_after, monkeypatch):
    killed_after(0)
    path = tmp_path / "checkpoint"
    finished = run(TINY, Checkpoint(path, "this"))
    monkeypatch.setattr("roughgas.simulation.gas.record", None)
    again = run(TINY, Checkpoint(path, "this"))
    assert again["R"] == finished["R"] and again["kernel_seconds"] == finished["kernel_seconds"]


def test_invalid_checkpoint_intervals_are_refused(tmp_path, monkeypatch):
    monkeypatch.setenv(checkpoints.INTERVAL_VARIABLE, "often")
    with pytest.raises(
        InputError, match=r"^ROUGHGAS_CHECKPOINT_SECONDS.* often.* must lie in .*1e9"
    ):
        Checkpoint(tmp_path / "checkpoint", "this")


def forge_checkpoint(path):
    """Remove an array from a checkpoint and update its checksum."""
    with np.load(path) as archive:
        content = dict(archive)
    del content["costs.seconds"]
    owner = str(content.pop("belongs to"))
    content = {name: array for name, array in content.items() if name not in ("version", "sha256")}
    checkpoints.write(path, owner, content)


def simulate(path, **options):
    """Simulate TINY by the library, with a checkpoint at `path`."""
    settings = {name: TINY[name] for name in ("particles", "box", "schedule")}
    settings |= {"effects": {"contact_time": None}, "progress": False}
    return simulate_point("cooling", r=0.9, beta=0.3, **settings, checkpoint=path, **options)


def test_an_invalid_checkpoint_is_removed_unless_trackers_observe(tmp_path, killed_after, capsys):
    path, undisturbed = tmp_path / "kept", simulate(None)
    killed_after(4)
    with pytest.raises(Killed):
        simulate(path)
    forge_checkpoint(path)
    with pytest.raises(InputError, match=r"kept: must hold .*: remove it"):
        simulate(path, trackers=[Tracker()])
    assert path.exists()
    again = simulate(path)
    assert f"{path} holds what no run has kept: starting afresh" in capsys.readouterr().err
    assert again.R.item() == undisturbed.R.item() and not path.exists()


def test_an_error_of_a_function_of_a_user_does_not_start_a_run_afresh(tmp_path, killed_after):
    path, mistakes, raised = tmp_path / "kept", [], []

    def failing(frame):
        if mistakes:
            raised.append(frame.time)
            raise ValueError(*mistakes)
        return 1.0

    killed_after(4)
    with pytest.raises(Killed):
        simulate(path, observe={"failing": failing})
    mistakes.append("a mistake")
    with pytest.raises(ValueError, match="a mistake"):
        simulate(path, observe={"failing": failing})
    assert path.exists() and len(raised) == 1


def test_memories_of_observables_cannot_run_code():
    with pytest.raises(pickle.UnpicklingError, match=r"builtins\.eval"):
        ObservableUnpickler(io.BytesIO(pickle.dumps(eval))).load()
