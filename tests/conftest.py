"""What all tests share; its being here also lets them import `synthetic`."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import settings
from remembered import remember_yaml

remember_yaml()

# sums by several threads have other last bits; the command `roughgas` has one thread, too
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# a shell's job in the background ignores Ctrl-C, and so would every process that tests start
signal.signal(signal.SIGINT, signal.default_int_handler)

# how long an example takes says nothing where compilers and other jobs share the cores
settings.register_profile("shared machine", deadline=None)
settings.load_profile("shared machine")

SHORT = {"base", "claims", "config", "data", "results", "scene", "statistics", "theory"}
"""Folders in which no file takes more than some seconds."""
WHOLE = 20
"""How many folders, or files beside them, a run of all tests has at least."""


def folder_of(item):
    """The folder of a test, or its file where that is in none."""
    return item.path.relative_to(Path(__file__).parent).parts[0]


def pytest_collection_modifyitems(items):
    """Leave these to the end, where a long file would keep one worker busy and the other idle."""
    items.sort(key=lambda item: folder_of(item) in SHORT)


@pytest.fixture(scope="session", autouse=True)
def kernels(request, tmp_path_factory):
    """Kernels for a run of all tests by several workers, which share out compiling them, in
    processes of their own: a compiler never gives back its gigabyte."""
    alone = "PYTEST_XDIST_WORKER" not in os.environ
    if alone or len({folder_of(item) for item in request.session.items}) < WHOLE:
        return
    folder = tmp_path_factory.getbasetemp().parent / "kernels"
    folder.mkdir(exist_ok=True)
    command = [sys.executable, "-m", "warm", str(folder)]
    subprocess.run(command, cwd=Path(__file__).parent, check=True)


@pytest.fixture(scope="session")
def files(tmp_path_factory):
    """The paths of a dataset of each kind (see files.py), which no test changes."""
    from tests.files import write_all

    return write_all(tmp_path_factory.mktemp("files"))
