"""Safeguards in the source, each without which a case of the catalogue fails."""

import json
import os
import shutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import roughgas
from hard_cases.catalogue import BEYOND, CASES, Remedy
from hard_cases.conftest import FOUND, family_of

HERE, PACKAGE = Path(__file__).parent, Path(roughgas.__file__).parent
REMEDIES = json.loads((HERE / "remedies.json").read_text(encoding="utf-8"))
"""The case, what the safeguard is, and the text (once in its file) that is replaced by another."""


def test_the_text_of_each_safeguard_stands_once_in_its_file():
    for one in REMEDIES:
        text = (PACKAGE / one["file"]).read_text(encoding="utf-8")
        assert text.count(one["old"]) == 1, one["remedy"]


@pytest.mark.remedy
@pytest.mark.parametrize("one", REMEDIES, ids=lambda one: one["remedy"])
def test_a_case_fails_without_its_safeguard(one, tmp_path, request):
    """In a process of its own, since a margin is beyond its limit."""
    copy = tmp_path / "roughgas"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    source = copy / one["file"]
    text = source.read_text(encoding="utf-8")
    source.write_text(text.replace(one["old"], one["new"]), encoding="utf-8")
    own = {"PYTHONPATH": str(tmp_path), "ROUGHGAS_CACHE_DIR": str(tmp_path / "cache")}
    around = {name: value for name, value in os.environ.items() if name != "PYTEST_ADDOPTS"} | own
    file, _, name = one["case"].partition("::")
    command = [sys.executable, "-m", "pytest", "-x", "-n0", "-p", "no:cacheprovider"]
    command.append(f"{HERE / file}.py::{name}")
    told = {"cwd": HERE.parents[1], "env": around, "capture_output": True, "text": True}
    done = subprocess.run(command, **told, timeout=900)
    assert done.returncode == pytest.ExitCode.TESTS_FAILED and BEYOND in done.stdout, done.stdout
    family = family_of(import_module(f"hard_cases.{file}"))
    found = Remedy(family, CASES[file][name]["title"], one["remedy"])
    request.config.stash[FOUND]["remedies"].append(found._asdict())
