"""Safeguards in the source, each without which a case of the catalogue fails."""

import json
import os
import resource
import shutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import roughgas
from hard_cases.catalogue import BEYOND, CASES, Remedy
from hard_cases.conftest import MEASURED, family_name

CASES_FOLDER, PACKAGE = Path(__file__).parent, Path(roughgas.__file__).parent
REMEDIES = json.loads((CASES_FOLDER / "remedies.json").read_text(encoding="utf-8"))
"""The case, its safeguard, the file, and the text (once in the file) with its replacement."""


def test_the_text_of_each_safeguard_stands_once_in_its_file():
    for remedy in REMEDIES:
        text = (PACKAGE / remedy["file"]).read_text(encoding="utf-8")
        assert text.count(remedy["old"]) == 1, remedy["remedy"]


def limit_cpu(seconds=900):
    """End this process after a CPU time in seconds; the clock would run on while others compute."""
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))


def marked():
    """Yield the remedies as parameters: the first of each file has the mark `remedy`, others the
    mark `campaign`, since each compiles a kernel."""
    files = set()
    for remedy in REMEDIES:
        mark = pytest.mark.campaign if remedy["file"] in files else pytest.mark.remedy
        files.add(remedy["file"])
        yield pytest.param(remedy, marks=mark, id=remedy["remedy"])


@pytest.mark.parametrize("remedy", [*marked()])
def test_a_case_fails_without_its_safeguard(remedy, tmp_path, request):
    """In a new process, a margin is beyond its limit."""
    package_copy = tmp_path / "roughgas"
    shutil.copytree(PACKAGE, package_copy, ignore=shutil.ignore_patterns("__pycache__"))
    source = package_copy / remedy["file"]
    text = source.read_text(encoding="utf-8")
    source.write_text(text.replace(remedy["old"], remedy["new"]), encoding="utf-8")
    variables = {"PYTHONPATH": str(tmp_path), "ROUGHGAS_CACHE_DIR": str(tmp_path / "cache")}
    environment = {
        name: value for name, value in os.environ.items() if name != "PYTEST_ADDOPTS"
    } | variables
    file, _, name = remedy["case"].partition("::")
    command = [sys.executable, "-m", "pytest", "-x", "-n0", "-p", "no:cacheprovider"]
    command.append(f"{CASES_FOLDER / file}.py::{name}")
    options = {
        "cwd": CASES_FOLDER.parents[1],
        "env": environment,
        "capture_output": True,
        "text": True,
    }
    process = subprocess.run(command, **options, preexec_fn=limit_cpu)
    assert process.returncode == pytest.ExitCode.TESTS_FAILED and BEYOND in process.stdout, (
        process.stdout
    )
    family = family_name(import_module(f"hard_cases.{file}"))
    row = Remedy(family, CASES[file][name]["title"], remedy["remedy"])
    request.config.stash[MEASURED]["remedies"].append(row._asdict())
