"""Runs that are killed (SIGKILL) at random moments end with the same bits when called again.

Each try is a fork of this process, which has imported and compiled everything, so that it simulates
from its first moments on.
"""

import contextlib
import json
import os
import signal
import time
import traceback
from pathlib import Path

import netCDF4
import numpy as np
import pytest
from brute_force import settings
from tests.entry import main

import roughgas
from roughgas.data.point import WALL_CLOCK
from roughgas.simulation.checkpoint import INTERVAL_VARIABLE

pytestmark = pytest.mark.slow

KILLS, KILLS_BESIDE_CHECKPOINT = 7, 5
"""Number of kills of each run, and the least number of kills with a checkpoint on the disk."""
KILL_TIMES = 0.0, 0.6
"""Range of times after which a try is killed, in lengths of an undisturbed run."""
TRIES = 60
PATIENCE = 60
"""Seconds after which a try counts as hung."""
OUTPUT = "out.nc"

HEATED = settings("heated", 60, [40, 40])
DRIVEN = HEATED | {
    "schedule": {"kind": "steady", "equilibrate": 50, "measure": 2000, "sample_every": 0.5},
    "observables": {
        "profiles": {},
        "mean_square_displacement": {"lags": 6},
        "autocorrelation": {"every": 1},
        "cumulants": {"every": 3},
    },
    "keep_state": True,
}
COOLING = settings("gas", 60, [60, 60]) | {
    "schedule": {
        "kind": "cooling",
        "replicas": 12,
        "thermalise": 20,
        "relaxation_times": 8,
        "plateau": 300,
        "sample_every": 1,
        "target_stderr": 0.002,
    },
    "observables": {"cumulants": {"every": 3}},
    "keep_state": True,
}
STAGED = HEATED | {
    "schedule": {
        "kind": "stages",
        "sample_every": 0.5,
        "stages": [
            {"duration": 300, "samples_per_decade": 20, "first_sample": 0.1, "sample_start": True},
            {"duration": 500, "sample_every": 0.25, "beta": 0.7, "spin_temperature": 0.5},
            {"duration": 300, "sample_at": [0, 0.5, 200], "effects": {"thermostat": {"power": 3}}},
            {"duration": 200},
        ],
    },
    "keep_state": True,
}
SHEARED = settings("sheared", 500, [90, 90]) | {
    "schedule": {"kind": "steady", "equilibrate": 1000, "measure": 10_000, "sample_every": 1}
}
FILMED_COOLING = {
    name: value for name, value in COOLING.items() if name not in ("observables", "keep_state")
}
FILMED_DRIVEN = DRIVEN | {"observables": {}, "keep_state": False}
FILMED_STAGED = STAGED | {"keep_state": False}
POINT = ["gas", "--r=0.9", "--beta=0.3"]


def run(experiment):
    """A function that makes a point by `roughgas run`."""
    return command("run", experiment)


def film(experiment, *take):
    """A function that makes a trajectory by `roughgas trajectory`."""
    return command("trajectory", experiment, *take)


def command(verb, experiment, *options):
    """A function that runs a command of roughgas on an experiment."""
    arguments = [verb, *POINT, *options, "--settings", json.dumps(experiment), "-o", OUTPUT]

    def run_command():
        return main(arguments)

    return run_command


def fastest(frame):
    """An observable of a user: the largest speed."""
    return np.sqrt((frame.velocity**2).sum(axis=1).max())


COOLING_DISKS = dict(r=0.9, beta=0.3, particles=60, box=(60, 60), progress=False)
COOLING_DISKS |= {"effects": {"contact_time": None}, "checkpoint": "kept"}


def simulated():
    """Make a point by `roughgas.simulate`, as in a script."""
    gas = roughgas.simulate(
        "cooling",
        schedule={"replicas": 12, "plateau": 600},
        observe={"fastest": fastest, "cumulants": {"every": 5}},
        **COOLING_DISKS,
    )
    gas.to_netcdf(OUTPUT)
    return 0


def filmed():
    """Make a trajectory by `roughgas.trajectory`, as in a script."""
    film = roughgas.trajectory("cooling", length=200, frames=100, **COOLING_DISKS)
    film.to_netcdf(OUTPUT)
    return 0


RUNS = {
    "driven": run(DRIVEN),
    "cooling": run(COOLING),
    "stages": run(STAGED),
    "sheared": run(SHEARED),
    "driven film": film(FILMED_DRIVEN, "--start=50", "--length=2000", "--frames=200"),
    "cooling film": film(FILMED_COOLING, "--start=5", "--length=200", "--frames=200"),
    "staged film": film(FILMED_STAGED, "--start=0", "--length=1300", "--frames=200"),
    "simulate": simulated,
    "trajectory": filmed,
}


AT_EACH_CALL, OFTEN = "0", "0.03"
"""Seconds between checkpoints; OFTEN for films, where a call may film a single collision."""


def begun(call, folder, **changes):
    """Fork this process to make a call in a folder, and return the process id.

    The child writes its output to the file FOLDER.said.
    """
    child = os.fork()
    if child:
        return child
    status = 70
    with contextlib.suppress(BaseException):
        os.chdir(folder)
        output = os.open(f"{folder}.said", os.O_WRONLY | os.O_CREAT | os.O_APPEND)
        os.dup2(output, 1)
        os.dup2(output, 2)
        os.environ |= changes
        try:
            with open(1, "w", closefd=False) as out, open(2, "w", closefd=False) as errors:
                with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
                    status = call()
        except BaseException as error:
            os.write(2, "".join(traceback.format_exception(error)).encode())
    os._exit(status)


def undisturbed(call, folder, seconds):
    """The duration of an undisturbed run, in seconds."""
    begin = time.monotonic()
    child = begun(call, folder, **{INTERVAL_VARIABLE: seconds})
    status = ended(child, PATIENCE)
    if status is None:
        kill(child)
    assert status == 0, Path(f"{folder}.said").read_text()
    return time.monotonic() - begin


def ended(child, seconds):
    """The wait status of a child if it ends within some seconds, else None."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return status
        time.sleep(0.002)
    return None


def kill(child):
    """Kill a child and return its wait status."""
    os.kill(child, signal.SIGKILL)
    return os.waitpid(child, 0)[1]


def content(path):
    """(variables, attributes) of a file by name, without CPU times."""
    with netCDF4.Dataset(path) as file:
        file.set_auto_maskandscale(False)
        variables = {
            name: (variable.dimensions, bits(variable))
            for name, variable in file.variables.items()
            if name not in WALL_CLOCK
        }
        return variables, {name: str(file.getncattr(name)) for name in file.ncattrs()}


def bits(variable):
    """The values of a variable as bytes, or as a list of texts."""
    values = variable[...]
    return values.tolist() if variable.dtype is str else values.tobytes()


def names_in(folder):
    """Names of the files in a folder."""
    return sorted(path.name for path in folder.iterdir())


def check(undisturbed_folder, folder):
    """Assert that a folder has only the output, with the bits of an undisturbed run."""
    assert names_in(folder) == [OUTPUT]
    assert content(folder / OUTPUT) == content(undisturbed_folder / OUTPUT)


@pytest.mark.parametrize("name", RUNS)
def test_a_run_killed_at_random_moments_ends_with_the_bits_of_an_undisturbed_one(
    tmp_path, name, monkeypatch
):
    call, rng = RUNS[name], np.random.default_rng([*name.encode()])
    seconds = OFTEN if name.endswith(("film", "trajectory")) else AT_EACH_CALL
    undisturbed_folder, folder = tmp_path / "whole", tmp_path / "killed"
    for directory in (undisturbed_folder, folder):
        directory.mkdir()
    monkeypatch.chdir(undisturbed_folder)
    assert call() == 0  # compiles the kernel, which forks have
    length = undisturbed(call, folder, seconds)
    check(undisturbed_folder, folder)
    (folder / OUTPUT).unlink()
    kills = midway = 0
    for _ in range(TRIES):
        child = begun(call, folder, **{INTERVAL_VARIABLE: seconds})
        status = ended(child, length * rng.uniform(*KILL_TIMES))
        if status is None and kill(child) == signal.SIGKILL:
            kills += 1
            midway += any(file.endswith(("kept", ".npz")) for file in names_in(folder))
        else:
            assert status in (None, 0), Path(f"{folder}.said").read_text()
            check(undisturbed_folder, folder)
        if kills >= KILLS and midway >= KILLS_BESIDE_CHECKPOINT:
            break
    undisturbed(call, folder, seconds)
    check(undisturbed_folder, folder)
    output = Path(f"{folder}.said").read_text()
    gone_on = output.count("going on from ")
    print(f"{name}: {length:.2f} s, {kills} kills, {midway} beside a checkpoint, {gone_on} gone on")
    assert kills >= KILLS and midway >= KILLS_BESIDE_CHECKPOINT
    assert "Traceback" not in output and "afresh" not in output
