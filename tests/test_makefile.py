"""What the Makefile says while packages are installed, with a pip that only talks."""

import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
MAKE = ["make", "--no-print-directory"]  # which is said within `make test`


def planned(*arguments):
    """The lines that make would carry out."""
    command = [*MAKE, "-n", *arguments]
    ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return ran.stdout.splitlines()


@pytest.mark.parametrize("target", ["figures", "report"])
def test_what_simulates_obeys_the_scale(target):
    said = "\n".join(planned("SCALE=small", target))
    assert "--config scale=small" in said and "results/small/" in said
    assert "scale=paper" not in said and "results/paper" not in said
