"""The fixtures of the catalogue, and the options of the command that runs all of it."""

import json
import os
import signal
from pathlib import Path

import pytest

from hard_cases.catalogue import CASES, Margin, Margins, Progress
from hard_cases.checkpoint import FinishedCases, Lines, run_key
from roughgas.base.files import write_text
from roughgas.simulation.progress import ProgressBar

MEASURED, REMEDIES_BEFORE, PASSED = (
    pytest.StashKey[dict](),
    pytest.StashKey[int](),
    pytest.StashKey[bool](),
)
FINISHED, PROGRESS = pytest.StashKey[FinishedCases](), pytest.StashKey[Progress]()


def pytest_addoption(parser):
    parser.addoption("--full", action="store_true", help="try hard cases as often as the command")
    parser.addoption("--margins", metavar="FILE", help="write what hard cases measured, as JSON")
    checkpoint_help = (
        "keep finished cases and scenes in FILE, and go on from there; removed at the end"
    )
    parser.addoption("--checkpoint", metavar="FILE", type=Path, help=checkpoint_help)
    progress_help = "say once a minute on this file descriptor how far the cases are"
    parser.addoption("--progress", metavar="NUMBER", type=int, help=progress_help)


def pytest_configure(config):
    config.stash[MEASURED] = {"margins": [], "remedies": [], "series": {}}
    path = config.getoption("--checkpoint", None)
    config.stash[FINISHED] = (
        FinishedCases(path, run_key(*settings_of_run(config))) if path else FinishedCases()
    )
    config.stash[PROGRESS] = Progress()
    if path:  # a cluster or Snakemake stops a job by SIGTERM: as by Ctrl-C
        signal.signal(signal.SIGTERM, signal.default_int_handler)


def settings_of_run(config):
    """Options and variables, besides the code, that the margins depend on."""
    names = ("--full", "--hypothesis-seed", "--hypothesis-profile")
    return [str(config.getoption(name, None)) for name in names] + [os.environ.get("FUZZ_TRIES")]


def pytest_collection_finish(session):
    target, progress = session.config.getoption("--progress", None), session.config.stash[PROGRESS]
    progress.cases = len(session.items)
    if target is not None:
        families = sorted({item.path.stem.removeprefix("test_") for item in session.items})
        progress.name = f"hard cases: {', '.join(families)}"
        progress.bar = ProgressBar(progress.name, len(session.items), "cases", Lines(target))


def pytest_runtest_setup(item):
    item.stash[REMEDIES_BEFORE] = len(item.config.stash[MEASURED]["remedies"])


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem):
    """Take the margins of a case that an earlier run finished; run any other case."""
    finished, name = pyfuncitem.config.stash[FINISHED], case_name(pyfuncitem)
    if finished.path is None or name not in finished:
        return None
    pyfuncitem.config.stash[MEASURED]["remedies"] += finished[name]["remedies"]
    if margins := pyfuncitem.funcargs.get("margins"):
        margins.rows = [Margin(**row) for row in finished[name]["margins"]]
        margins.series = finished[name]["series"]
    return True


def pytest_runtest_makereport(item, call):
    """Store the margins of a case that passed."""
    if call.when != "call" or call.excinfo is not None:
        return
    item.stash[PASSED] = True
    finished, name, margins = (
        item.config.stash[FINISHED],
        case_name(item),
        item.funcargs.get("margins"),
    )
    if finished.path and name not in finished:
        finished[name] = {
            "margins": [row._asdict() for row in margins.rows] if margins else [],
            "series": margins.series if margins else {},
            "remedies": item.config.stash[MEASURED]["remedies"][item.stash[REMEDIES_BEFORE] :],
        }
    item.config.stash[PROGRESS].end_case()


def case_name(item):
    """The name of a case: module::test."""
    return f"{item.path.stem}::{item.name}"


def pytest_sessionfinish(session, exitstatus):
    """Write the margins, or, of an interrupted run, report how far it is."""
    target, finished = session.config.getoption("--margins", None), session.config.stash[FINISHED]
    if exitstatus in (pytest.ExitCode.INTERRUPTED, pytest.ExitCode.INTERNAL_ERROR):
        if finished.path:
            report_finished_cases(session.config.stash[PROGRESS], finished.path)
        return
    if target:
        write_text(target, json.dumps(session.config.stash[MEASURED], indent=1) + "\n")
    if exitstatus == pytest.ExitCode.OK:
        finished.remove()


def report_finished_cases(progress, path):
    """Print the number of finished cases; by its first words the workflow knows a stopped job."""
    text = f"{progress} are kept in {path}; the same command goes on from there"
    print(f"\nroughgas: stopped: {text}")
    if progress.bar:
        progress.bar.say(f"{progress.name}: stopped: {text}")


def family_name(module):
    """The first line of a module's docstring, without its full stop."""
    return module.__doc__.splitlines()[0].rstrip(".")


@pytest.fixture
def margins(request):
    """The Margins of a case, which must measure at least one."""
    case = CASES[request.path.stem][request.node.originalname]
    full = bool(request.config.getoption("--full", False))
    description = family_name(request.module), case["title"], case["danger"], full
    stash = request.config.stash
    case_margins = Margins(*description, stash[FINISHED], stash[PROGRESS])
    yield case_margins
    assert case_margins.rows or PASSED not in request.node.stash, "this case measured nothing"
    results = request.config.stash[MEASURED]
    results["margins"] += [row._asdict() for row in case_margins.rows]
    results["series"] |= case_margins.series
