"""Files of an older roughgas are read with their numbers, or refused in one line; files of a newer
roughgas are refused in one line.

The folder of_9b3e2876 has files that commit 9b3e2876 wrote, and numbers that it read from them: a
point, a reduced dataset, a trajectory, and checkpoints of gases and of a run, without a version.
"""

import json
import shutil
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray as xr
from raw import build, start_gas
from schedules import TINY
from tests.entry import main
from tests.files import COMBINE, DRAW

from roughgas.base import InputError
from roughgas.data.formats import CHECKPOINT, DATASET
from roughgas.data.netcdf import opened
from roughgas.data.point import read_point
from roughgas.data.reduced import read_reduced
from roughgas.gas import UnusableCheckpoint, ratio
from roughgas.simulation.checkpoint import VERSION_KEY, Checkpoint
from roughgas.simulation.saved_states import initial_states_of
from roughgas.simulation.state_encoding import arrays_of

OLD = Path(__file__).with_name("of_9b3e2876")
NUMBERS, SETTINGS = (json.loads((OLD / f"{n}.json").read_text()) for n in ("numbers", "settings"))
READERS = {"point": read_point, "reduced": read_reduced}
PAPER = Path(__file__).parents[2] / "studies" / "paper"
COMMANDS = {
    "point": (
        "show {}",
        "show {} --json",
        "plot {} -o new.png",
        "reduce {} -o new.nc",
        "reduce {} -o new.nc --put-aside",
        "run vibrated --r 0.9 --beta 0.2 --from {} -o new.nc",
        "trajectory vibrated --r 0.9 --beta 0.2 --from {} -o new.xyz",
    ),
    "reduced": (
        "show {}",
        "plot {} -o new.png",
        "table {} -o new.csv",
        f"claims {PAPER} {{}} --title a --json new.json --markdown new.md",
        "explore {} --points points -o new.html",
        f"figure {PAPER} fig1a {{}} --shows vibrated -o new.png",
    ),
    "studies": (
        "show {}",
        f"claims {PAPER} {{}} --title a --json new.json --markdown new.md",
        DRAW.replace("out.", "new."),
    ),
    "task": ("show {}", COMBINE.replace("out.", "new.")),
}
KINDS_AND_COMMANDS = [
    (kind, command) for kind, commands in COMMANDS.items() for command in commands
]
NEWER_MESSAGE = (
    f"must be at most {DATASET.newest}: a newer roughgas has written the file; read it with"
)


@pytest.mark.parametrize("kind", READERS)
def test_older_datasets_have_the_numbers_that_they_were_written_with(kind):
    dataset = READERS[kind](OLD / f"{kind}.nc")
    numbers = {name: NUMBERS[name] for name in NUMBERS if name.startswith(f"{kind}.")}
    assert len(numbers) == 5
    assert {name: dataset[name.partition(".")[2]].item() for name in numbers} == numbers


@pytest.mark.parametrize("command", [*COMMANDS["point"][:4], *COMMANDS["reduced"][:3]])
def test_commands_take_older_datasets(tmp_path, monkeypatch, capsys, command):
    monkeypatch.chdir(tmp_path)
    kind = "point" if command in COMMANDS["point"][:4] else "reduced"
    shutil.copy(OLD / f"{kind}.nc", tmp_path)
    assert main(command.format(f"{kind}.nc").split()) == 0
    if command == "show {}":
        estimate = f"{NUMBERS[f'{kind}.R']:.3f}("
        assert estimate in capsys.readouterr().out


def test_runs_begin_in_older_states():
    (last,) = initial_states_of(read_point(OLD / "point.nc"))
    assert last.time == 60.0 and last.position.shape == (8, 2)
    frame = xr.load_dataset(OLD / "trajectory.nc").isel(frame=-1)
    (state,) = initial_states_of(frame)
    energies = np.mean(state.velocity**2) / 2, np.mean(state.spin**2) / 4  # q = 1/2
    assert energies[1] / sum(energies) == pytest.approx(NUMBERS["trajectory.R"][-1])
    assert np.array_equal(state.velocity, frame.velocity)


def start_named_gas(name):
    settings = SETTINGS[name]
    return start_gas(build(settings, 0.9, 0.2), settings, np.random.default_rng(1))


def test_an_older_gas_goes_on_with_the_same_bits():
    gas = start_named_gas("gas")
    assert gas.restore(OLD / "gas.npz", "mine")["seen"].tolist() == [0.0, 1.0, 2.0]
    gas.cool(gas.count(4))
    R = ratio(gas.energies(gas.in_collisions(gas.count(1), 40)))
    assert R.ravel().tolist()[::10] == NUMBERS["gas.R"]
    assert gas.costs.collisions == NUMBERS["gas.collisions"]


def content(gas):
    return {name: array.tobytes() for name, array in arrays_of(gas.state)}


def test_an_older_gas_with_other_arrays_is_refused():
    """Effects without an account had a phase."""
    gas = start_named_gas("bed")
    before = content(gas)
    with pytest.raises(UnusableCheckpoint, match=r"another kind of state.* another roughgas$"):
        gas.restore(OLD / "bed.npz", "me")
    assert content(gas) == before


def test_a_run_with_an_older_checkpoint_starts_afresh_and_says_so(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(OLD / "point.nc.checkpoint.npz", tmp_path / "new.nc.checkpoint.npz")
    assert run_again(capsys) == [
        "new.nc.checkpoint.npz belongs to other settings or to other sources: starting afresh"
    ]


def run_again(capsys):
    """Return the lines on checkpoints that a successful run prints."""
    settings = f"--settings={json.dumps(TINY)}"
    assert main(["run", "cooling", settings, "--r=0.9", "--beta=0.5", "-o", "new.nc"]) == 0
    assert "R" in read_point("new.nc")
    return [line for line in capsys.readouterr().err.splitlines() if "checkpoint" in line]


def copy_as_newer(path, source, version=DATASET.newest + 1):
    """Copy a dataset as a newer version may write it, with attributes of other types."""
    shutil.copy(source, path)
    with netCDF4.Dataset(path, "a") as file:
        file.schema_version, file.seed, file.r = version, "one of many", [0.8, 0.9]
    return path


@pytest.mark.parametrize(("kind", "command"), KINDS_AND_COMMANDS)
def test_commands_refuse_a_newer_version(files, tmp_path, monkeypatch, capsys, kind, command):
    monkeypatch.chdir(tmp_path)
    copy_as_newer(tmp_path / "newer.nc", files["point"].with_name(f"{kind}.nc"))
    assert main(command.format("newer.nc").split()) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert f"schema_version of newer.nc = 3: {NEWER_MESSAGE}" in line
    assert [path.name for path in tmp_path.iterdir()] == ["newer.nc"]


def test_a_state_of_a_newer_version_is_refused():
    point = read_point(OLD / "point.nc").assign_attrs(schema_version=DATASET.newest + 1)
    with pytest.raises(InputError, match=rf"^initial\.schema_version = 3: {NEWER_MESSAGE}"):
        initial_states_of(point)


def test_versions_of_other_programs_are_ignored():
    frame = xr.load_dataset(OLD / "trajectory.nc").isel(frame=-1)
    initial_states_of(frame.assign_attrs(source="another program", schema_version="2030-01"))


@pytest.mark.parametrize(
    ("version", "message"), [(0, "must be at least 1: an older"), (2.5, "must be a whole number")]
)
def test_impossible_versions_are_refused(tmp_path, version, message):
    path = copy_as_newer(tmp_path / "odd.nc", OLD / "point.nc", version)
    with pytest.raises(InputError, match=message), opened(path):
        pass


def copy_with_version(path, source, version):
    """Copy a checkpoint, with another version in it."""
    with np.load(source) as archive:
        np.savez(path, **{**archive, VERSION_KEY: np.array(version)})


def test_a_gas_of_a_newer_version_is_refused(tmp_path):
    path, gas = tmp_path / "gas.npz", start_named_gas("gas")
    gas.save(path, "mine", {})
    with np.load(path) as archive:
        assert archive[VERSION_KEY] == CHECKPOINT.newest
    before = content(gas)
    copy_with_version(path, path, CHECKPOINT.newest + 1)
    message = (
        "^is of version 3, which must be at most 2: a newer roughgas has written the file; only"
    )
    with pytest.raises(UnusableCheckpoint, match=message):
        gas.restore(path, "mine")
    assert content(gas) == before


@pytest.mark.parametrize("version", ["two", [1, 2], np.nan])
def test_a_checkpoint_without_a_legible_version_is_damaged(tmp_path, version):
    copy_with_version(tmp_path / "gas.npz", OLD / "gas.npz", version)
    with pytest.raises(UnusableCheckpoint, match=r"^is damaged$"):
        start_named_gas("gas").restore(tmp_path / "gas.npz", "mine")


def test_a_run_with_a_newer_checkpoint_starts_afresh_and_says_so(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "new.nc.checkpoint.npz"
    copy_with_version(path, OLD / "point.nc.checkpoint.npz", CHECKPOINT.newest + 1)
    assert "is of version 3" in Checkpoint(path, "any").refused
    (line,) = run_again(capsys)
    assert line.endswith("; only that one goes on from it: starting afresh")
