"""The fixtures of the catalogue, and the options by which the command runs all of it."""

import json
from pathlib import Path

import pytest

from hard_cases.catalogue import CASES, Margins

FOUND = pytest.StashKey[dict]()


def pytest_addoption(parser):
    parser.addoption("--full", action="store_true", help="try hard cases as often as the command")
    parser.addoption("--margins", metavar="FILE", help="write what hard cases measured, as JSON")


def pytest_configure(config):
    config.stash[FOUND] = {"margins": [], "remedies": [], "series": {}}


def pytest_sessionfinish(session):
    target = session.config.getoption("--margins", None)
    if target:
        Path(target).write_text(json.dumps(session.config.stash[FOUND], indent=1) + "\n")


def family_of(module):
    """The first line of a module's docstring, without its full stop."""
    return module.__doc__.splitlines()[0].rstrip(".")


@pytest.fixture
def margins(request):
    case = CASES[request.path.stem][request.node.originalname]
    full = bool(request.config.getoption("--full", False))
    measured = Margins(family_of(request.module), case["title"], case["danger"], full)
    yield measured
    assert measured.rows, "this case measured nothing"
    found = request.config.stash[FOUND]
    found["margins"] += [row._asdict() for row in measured.rows]
    found["series"] |= measured.series
