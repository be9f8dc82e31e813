"""What the Makefile says while packages are installed, with a pip that only talks."""

import os
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
MAKE = ["make", "--no-print-directory"]  # which is said within `make test`
PACKAGES = 60
PIP = """#!/bin/sh
echo "$@" > told
for k in $(seq {packages}); do echo "Collecting package$k==1.0"; echo "  Downloading it"; done
echo "Installing collected packages: all"
{end}
"""


@pytest.fixture
def install(tmp_path):
    """A function that installs what the documentation needs, by make, with a pip that ends so."""
    (tmp_path / "requirements").mkdir()
    (tmp_path / ".venv").mkdir()
    lock = "".join(f"package{k}==1.0 --hash=sha256:0\n" for k in range(PACKAGES))
    for name in ("requirements/docs.lock", "requirements.lock", "pyproject.toml"):
        (tmp_path / name).write_text(lock)
        os.utime(tmp_path / name, (1, 1))
    (tmp_path / ".venv/ready").touch()

    def run(end):
        pip = tmp_path / "pip"
        pip.write_text(PIP.format(packages=PACKAGES, end=end))
        pip.chmod(0o755)
        command = [*MAKE, "-f", ROOT / "Makefile", ".venv/with-docs", "PIP=./pip"]
        ran = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
        return ran, tmp_path / ".venv/with-docs", (tmp_path / "told").read_text()

    return run


def test_it_says_in_a_few_lines_how_far_it_is(install):
    ran, ready, told = install("exit 0")
    assert ran.returncode == 0 and ready.exists()
    assert ran.stdout.splitlines() == [
        "Installing what `docs` needs into .venv, once.",
        "  25 of 60 packages",
        "  50 of 60 packages",
        "  installing all of them",
    ]
    assert "--require-hashes --requirement requirements/docs.lock" in told


def test_of_a_failure_it_says_all(install):
    ran, ready, _ = install("echo 'ERROR: hashes differ' >&2; exit 1")
    assert ran.returncode != 0 and not ready.exists()
    for line in ("Collecting package7==1.0", "ERROR: hashes differ", "pip has failed"):
        assert line in ran.stdout.splitlines()


def planned(*arguments):
    """The lines that make would carry out."""
    command = [*MAKE, "-n", *arguments]
    ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return ran.stdout.splitlines()


TARGETS = re.findall(r"^([a-z]+):.*## ", (ROOT / "Makefile").read_text(), re.M)


@pytest.mark.parametrize("target", ["figures", "report"])
def test_what_simulates_obeys_the_scale(target):
    said = "\n".join(planned("SCALE=small", target))
    assert "--config scale=small" in said and "results/small/" in said
    assert "scale=paper" not in said and "results/paper" not in said


@pytest.mark.parametrize("target", sorted({*TARGETS} - {"help", "notebook"}))
def test_every_target_ends_by_saying_where_to_look_or_what_is_done(target):
    assert planned(target)[-1].startswith("echo ")
