"""With any input file a command has a result or one line of error, and does not change the file."""

import contextlib
import multiprocessing
import os
import resource
import shutil
import signal
import stat
import traceback
from collections import Counter
from functools import partial
from pathlib import Path

import netCDF4
import numpy as np
import pytest
from campaigns import tries
from schedules import TINY
from tests.entry import outcome
from tests.forgeries import GAS, NAMES, forge, forge_sealed, real_files, stopped

import roughgas
from roughgas.base import InputError, sorted_json
from roughgas.data.netcdf import POINT as A_POINT
from roughgas.data.netcdf import DamagedError, is_of_type, opened, read_groups, read_netcdf
from roughgas.data.point import read_point
from roughgas.data.reduced import read_by_name, read_reduced
from roughgas.simulation.checkpoint import Checkpoint, read
from roughgas.simulation.saved_states import initial_states_of
from roughgas.simulation.state_encoding import UnusableCheckpoint

STUDIES = Path(__file__).parents[2] / "studies"
FOLDERS = {"STUDY": str(STUDIES / "clustering"), "COVERAGE": str(STUDIES / "coverage")}
SEED = 20
SAMPLE, BATCH, FORGERIES = 25, 100, tries(300)
READER_LIMIT = 30
"""Time limit of a reader, in seconds."""
HDF5_LIMIT = 5
"""Time limit of HDF5 to open a file, in seconds."""
GIVEN_UP = "given up by HDF5"
CRASHED = "HDF5 crashed"
MOST_CRASHES = 1
"""Crashes of HDF5 in a batch of files whose checksums were made anew after the damage; none of
985 such files crashed it in a trial, and one of some ten thousand on the machines of CI."""
SIGNALS_OF_CRASHES = {-signal.SIGSEGV, -signal.SIGBUS, -signal.SIGABRT, -signal.SIGFPE}
MEMORY_LIMIT = 3e9
"""Bytes that a campaign may add to the process."""
PAPER = Path(__file__).parents[2] / "studies" / "paper"
COMMANDS = [
    "show {}",
    "show --json {}",
    f"figure {PAPER} fig2a {{}} --shows sheared -o out.png",
    "experiments --config {}",
]
COMMANDS += ["reduce {} -o out.nc", "reduce --put-aside {} -o out.nc", "table {} -o out.csv"]
COMMANDS += [
    f"claims {PAPER} {{}} --title a --json out.json --markdown out.md",
    "run_times {} -o out.md",
]
COMMANDS += [
    "document {} -o out.html",
    "combine COVERAGE {} --modules coverage -o out.nc --table out.md",
]
COMMANDS += ["combine STUDY {} -o out.nc --table out.md", "run GAS --from {} -o out.nc"]
COMMANDS += ["trajectory GAS --from {} --times 1 -o out.xyz"]
DRAWING = ["plot {} -o out.png", "figure COVERAGE coverage {} --shows coverage -o out.png"]
DRAWING += ["explore {} --points . -o out.html"]
"""Command lines, {} being the file, GAS a tiny gas, STUDY and COVERAGE folders."""
READERS = {
    "read_point": read_point,
    "read_reduced": read_reduced,
    "read_by_name": read_by_name,
    "open_points": lambda path: roughgas.open_points([path]),
    "read_groups": read_groups,
    "is_of_type": lambda path: is_of_type(path, A_POINT),
    "initial_states_of": lambda path: initial_states_of(read_netcdf(path)),
    "checkpoint": lambda path: read(path, "of another run"),
    "checkpoint of a run": lambda path: Checkpoint(path, "of another run"),
}


class Hangs(BaseException):
    """Raised in a reader or command beyond its time limit."""


@pytest.fixture(scope="module")
def real(tmp_path_factory):
    with pytest.MonkeyPatch.context() as monkeypatch:
        return real_files(tmp_path_factory.mktemp("real"), monkeypatch)


@contextlib.contextmanager
def alarm():
    def ring(*_):
        raise Hangs

    before = signal.signal(signal.SIGALRM, ring)
    signal.alarm(READER_LIMIT)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def folder_contents(folder):
    """Return mode, inode, size, time of writing and bytes of each file in a folder, by name."""
    entries = {}
    for path in folder.iterdir():
        status = path.lstat()
        is_readable = stat.S_ISREG(status.st_mode) and status.st_size < 10**8
        content = path.read_bytes() if is_readable else b""
        entries[path.name] = (
            status.st_mode,
            status.st_ino,
            status.st_size,
            status.st_mtime_ns,
            content,
        )
    return entries


def command_words(command, name):
    """Return the words of a command line for a file of this name."""
    words = []
    for word in command.split():
        words += GAS if word == "GAS" else [FOLDERS.get(word, word).replace("{}", name)]
    return words


def is_provably_damaged(path):
    """Return whether a checksum proves that a point of the workflow is damaged."""
    try:
        with opened(path, A_POINT):
            return False
    except DamagedError:
        return path.suffix == ".nc"
    except (InputError, OSError):
        return False


def outcomes_of_commands(folder, name, commands):
    """Count the outcomes of commands, and assert that they leave the folder unchanged."""
    before, outcomes = folder_contents(folder), Counter()
    for command in commands:
        with alarm():
            status, errors = outcome(command_words(command, name))
        assert status in (0, 1, 2), command
        if status:
            (line,) = errors.splitlines()
            assert line.startswith("roughgas: error: "), (command, line)
        aside = folder / f"{name}.damaged"
        if os.path.lexists(aside):
            assert "--put-aside" in command
            aside.rename(folder / name)
            assert is_provably_damaged(folder / name), command
            status = "put aside"
        for path in folder.glob("out*"):
            assert status == 0, command
            path.unlink()
        assert folder_contents(folder) == before, command
        outcomes[OUTCOMES.get(status, status)] += 1
    return outcomes


OUTCOMES = {0: "taken", 1: "refused: status 1", 2: "refused: status 2"}
REFUSALS = (InputError, OSError, UnusableCheckpoint)


def outcomes_of_readers(path):
    """Count the outcomes of the library's readers, up to the first that gives HDF5 up."""
    outcomes = Counter()
    for name, reader in READERS.items():
        with alarm():
            try:
                reader(path)
                outcomes["read"] += 1
            except REFUSALS as error:
                assert "\n" not in str(error) or isinstance(error, OSError), name
                if f"HDF5 reads it for {HDF5_LIMIT} s" in str(error):
                    return Counter({GIVEN_UP: 1})
                outcomes[f"{type(error).__name__} of a reader"] += 1
    return outcomes


def all_outcomes(path, commands):
    """Count the outcomes of readers and commands; at most a reader and a command give HDF5 up."""
    outcomes = outcomes_of_readers(path)
    commands = commands[:1] if GIVEN_UP in outcomes else commands
    return outcomes + outcomes_of_commands(path.parent, path.name, commands)


def in_child_process(work, is_sealed):
    """Return the outcomes that `work` counts in a fork of this process.

    HDF5 may crash the fork only at a file that `is_sealed`: only its damage passes the checksum.
    """
    context = multiprocessing.get_context("fork")
    receiver, sender = context.Pipe(duplex=False)

    def send():
        try:
            sender.send(work())
        except BaseException as error:
            sender.send("".join(traceback.format_exception(error)))

    child = context.Process(target=send, daemon=True)
    child.start()
    sender.close()
    try:
        answer = receiver.recv()
    except EOFError:
        child.join()
        if is_sealed and child.exitcode in SIGNALS_OF_CRASHES:
            return Counter({CRASHED: 1})
        answer = f"a child that ended with {child.exitcode}"
    child.kill()
    child.join()
    assert isinstance(answer, Counter), answer
    return answer


@pytest.fixture
def forged(real, tmp_path, monkeypatch):
    """A function that makes a forged file in an empty folder, and returns its path and kind."""
    monkeypatch.setattr("roughgas.data.netcdf.OPENING_TIMEOUT", HDF5_LIMIT)

    def make(number, name=None):
        folder = tmp_path / f"{number}"
        folder.mkdir()
        monkeypatch.chdir(folder)
        rng = np.random.default_rng([SEED, number])
        path = folder / (name or NAMES[rng.integers(len(NAMES))])
        return path, forge(rng, real, path)

    return make


def commands_for(number, often):
    """Return all command lines, with drawing at every third file, or, unless `often`, three."""
    if not often:
        return [COMMANDS[(number + step) % len(COMMANDS)] for step in range(3)]
    return COMMANDS + (DRAWING if number % 3 == 0 else [])


def count_outcomes(forged, numbers, often=True):
    """Count the outcomes of the files of these numbers."""
    outcomes, before = Counter(), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for number in numbers:
        path, how = forged(number)
        try:
            trial = partial(all_outcomes, path, commands_for(number, often))
            is_sealed = how.startswith("damaged and sealed")
            is_damaged = how.startswith("damaged")
            outcomes += in_child_process(trial, is_sealed) if is_damaged else trial()
        except BaseException as error:
            error.add_note(f"file {number}, {path.name}: {how}")
            raise
        shutil.rmtree(path.parent)
    after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    assert 1024 * (after - before) < MEMORY_LIMIT
    print(dict(outcomes))
    assert outcomes[CRASHED] <= MOST_CRASHES
    assert outcomes["taken"] and outcomes["read"] and outcomes["refused: status 2"]
    return outcomes


@pytest.mark.slow
def test_forged_files_are_read_or_refused_in_one_line_and_left_alone(forged):
    count_outcomes(forged, range(SAMPLE), often=False)


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, FORGERIES, BATCH))
def test_all_forged_files_are_read_refused_or_put_aside(forged, first):
    assert count_outcomes(forged, range(first, first + BATCH))["put aside"]


@pytest.fixture(scope="module")
def undisturbed(real):
    return read_point(real["state"])["R"].item()


CHECKPOINTS = [range(20), pytest.param(range(20, tries(300)), marks=pytest.mark.slow)]


@pytest.mark.parametrize("numbers", CHECKPOINTS)
def test_a_run_with_a_forged_checkpoint_has_undisturbed_results_or_is_refused(
    forged, undisturbed, numbers
):
    statuses = Counter()
    for number in numbers:
        path, how = forged(number, "out.nc.checkpoint.npz")
        before = folder_contents(path.parent)
        with alarm():
            status, errors = outcome(["run", *GAS, "-o", "out.nc"])
        assert status in (0, 1, 2) and "Traceback" not in errors, (number, how, errors)
        if status:
            assert len(errors.splitlines()) == 1, (number, how, errors)
            assert folder_contents(path.parent) == before, (number, how)
        else:
            assert read_point("out.nc")["R"].item() == undisturbed, (number, how)
        statuses[status] += 1
        shutil.rmtree(path.parent)
    print(dict(statuses))
    assert statuses[0] and statuses[2]


OBSERVABLES = {"cumulants": {"every": 2}, "autocorrelation": {"every": 1}, "profiles": {}}
OBSERVED = TINY | {"keep_state": True, "observables": OBSERVABLES}
SHEARED = {
    "particles": 100,
    "box": [40, 40],
    "effects": {"spin": {"inertia": 0.5}, "shear": {"velocity": 2}, "contact_log": {"most": 50}},
}
STEADY = {"kind": "steady", "equilibrate": 5, "measure": 20, "sample_every": 0.5}
STAGES = [{"duration": 3, "sample_at": [0.1, 1]}, {"duration": 5}]
STAGED = {"kind": "stages", "sample_every": 0.5, "stages": STAGES}
POINT_ARGUMENTS = ["gas", "--r=0.9", "--beta=0"]
STOPPED = {  # command, and its writes that stop it
    "watched": (["run", *POINT_ARGUMENTS, "--settings", sorted_json(OBSERVED)], (2, 5, 9)),
    "film": (["trajectory", *GAS, "--times", "1", "2", "3", "4"], (3, 6, 9)),
    "flow": (
        ["run", *POINT_ARGUMENTS, "--settings", sorted_json(SHEARED | {"schedule": STEADY})],
        (3, 8),
    ),
    "stages": (
        [
            "run",
            *POINT_ARGUMENTS,
            "--settings",
            sorted_json(SHEARED | {"schedule": STAGED, "keep_state": True}),
        ],
        (2, 4),
    ),
}


def bits_in(path):
    """Return the bits of all variables of a file except CPU times."""
    with netCDF4.Dataset(path) as file:
        file.set_auto_maskandscale(False)
        names = {*file.variables} - {"kernel_seconds"}
        return {name: np.array(file[name][...]).astype(object).tolist() for name in names}


@pytest.mark.parametrize(
    ("names", "numbers"),
    [
        (("watched", "film"), range(20)),
        pytest.param([*STOPPED], range(20, 340), marks=pytest.mark.slow),
    ],
)
def test_a_checkpoint_that_is_forged_and_sealed_is_refused_in_a_line_or_taken(
    tmp_path, monkeypatch, names, numbers
):
    """If it is refused, the run has the bits of an undisturbed run."""
    sources, undisturbed_bits, outcomes = [], {}, Counter()
    for name in names:
        command, writings = STOPPED[name]
        command = [*command, "-o", "out.nc"]
        for writing in writings:
            folder = tmp_path / f"{name}{writing}"
            folder.mkdir()
            sources.append((name, command, stopped(folder, monkeypatch, command, writing)))
        (tmp_path / name).mkdir()
        monkeypatch.chdir(tmp_path / name)
        assert outcome(command)[0] == 0
        undisturbed_bits[name] = repr(bits_in("out.nc"))
    for number in numbers:
        rng = np.random.default_rng([SEED, number])
        name, command, source = sources[number % len(sources)]
        folder = tmp_path / f"{number}"
        folder.mkdir()
        monkeypatch.chdir(folder)
        how = number, source, forge_sealed(rng, source, folder / "out.nc.checkpoint.npz")
        try:
            with alarm():
                status, errors = outcome(command)
        except BaseException as error:
            error.add_note(f"{how}")
            raise
        lines = [line for line in errors.splitlines() if not line.startswith(("going", "out.nc:"))]
        assert status in (0, 1, 2) and len(lines) <= 1, (how, errors)
        if status:
            assert lines[0].startswith("roughgas: error: "), (how, errors)
            outcomes["refused"] += 1
            continue
        assert [path.name for path in folder.iterdir()] == ["out.nc"], how
        if lines:
            assert lines[0].endswith(": starting afresh"), (how, errors)
            assert repr(bits_in("out.nc")) == undisturbed_bits[name], (how, errors)
        outcomes["afresh" if lines else "taken"] += 1
    print(dict(outcomes))
    assert outcomes["afresh"] > len(numbers) / 2
