"""Fixtures of all tests; the file's location also lets them import `synthetic`."""

import math
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings
from yaml_cache import remember_yaml

remember_yaml()

# sums by several threads have other last bits; the command `roughgas` has one thread, too
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# a shell's job in the background ignores Ctrl-C, and so would every process that tests start
signal.signal(signal.SIGINT, signal.default_int_handler)

# how long an example takes says nothing where compilers and other jobs share the cores
SLOW = [HealthCheck.too_slow]
settings.register_profile("shared machine", deadline=None, suppress_health_check=SLOW)
settings.load_profile("shared machine")

SHORT = {"base", "claims", "config", "data", "results", "scene", "statistics", "theory"}
"""Folders in which no file takes more than some seconds."""
COMPLETE_RUNS = 20
"""How many folders, or files beside them, a run of all tests has at least."""


def folder_of(item):
    """Return the folder of a test, or its file if it is in none."""
    return item.path.relative_to(Path(__file__).parent).parts[0]


def pytest_collection_modifyitems(items):
    """Leave these to the end, where a long file would keep one worker busy and the other idle."""
    items.sort(key=lambda item: folder_of(item) in SHORT)


@pytest.fixture(scope="session", autouse=True)
def kernels(request, tmp_path_factory):
    """Compile the kernels of a run by several workers, each a share, in child processes: a compiler
    never gives back its gigabyte."""
    alone = "PYTEST_XDIST_WORKER" not in os.environ
    if alone or len({folder_of(item) for item in request.session.items}) < COMPLETE_RUNS:
        return
    folder = tmp_path_factory.getbasetemp().parent / "kernels"
    folder.mkdir(exist_ok=True)
    command = [sys.executable, "-m", "warm", str(folder)]
    subprocess.run(command, cwd=Path(__file__).parent, check=True)


@pytest.fixture(autouse=True)
def no_progress_lines(monkeypatch):
    """On a busy machine a command of a test takes ten seconds, after which it would show a line."""
    monkeypatch.setattr("roughgas.simulation.progress.FIRST_LINE_AFTER", math.inf)


@pytest.fixture(scope="session")
def files(tmp_path_factory):
    """The paths of a dataset of each kind (see files.py), which no test changes."""
    from tests.files import write_all

    return write_all(tmp_path_factory.mktemp("files"))
