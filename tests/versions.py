"""The package alone, as users install it, with the versions that pyproject.toml allows.

    python -m tests.versions newest python3.12
    python -m tests.versions oldest python3.11

builds the wheel, installs it into an environment of its own, without extras and with the newest or
the oldest versions of what it needs, and runs tests that need no more than that. `coming` takes
pre-releases, past the upper bounds as well, and Snakemake besides: it runs the tests of what is
used of numba and Snakemake though it is private to them. `make versions` does all that it can here.
"""

import argparse
import os
import re
import subprocess
import tempfile
import tomllib
from pathlib import Path

ROOT = Path(__file__).parent.parent
WAYS = ("newest", "oldest", "coming")
TOOLS = ("pytest", "hypothesis", "mpmath")
BASE = (
    "tests/data/test_point_file.py",
    "tests/kernel/test_collision_rule.py",
    "tests/compiling",
    "tests/observables/test_each.py",
    "tests/observables/test_each.py",
    "tests/simulation/test_gas.py",
    "tests/statistics",
    "tests/test_bits.py",
)
"""Tests that need nothing but the package; those of bits compare numbers across all versions."""
PRIVATE = ("tests/compiling", "tests/habits/test_stopping.py")
"""Tests of what is used though it is private."""
QUICK = "not slow and not remedy and not browser and not slurm"


def requirements(way, project):
    """What to install for one of WAYS: requirements as pip has them."""
    needed = list(project["dependencies"])
    if way == "oldest":
        return [re.sub(r">=([\w.]+).*", r"==\1", one) for one in needed]
    if way == "coming":
        needed += project["optional-dependencies"]["workflow"]
        return [one.partition(",")[0] for one in needed]
    return needed


def check(way, python):
    """Install the wheel in one of WAYS for a Python, and run the tests. Raises where one fails."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    around = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    with tempfile.TemporaryDirectory() as folder:
        around["ROUGHGAS_CACHE_DIR"] = f"{folder}/kernels"
        subprocess.run([python, "-m", "venv", f"{folder}/venv"], check=True)
        pip = [f"{folder}/venv/bin/python", "-m", "pip", "--disable-pip-version-check", "-q"]
        subprocess.run([*pip, "wheel", "--no-deps", "-w", folder, ROOT], check=True)
        (wheel,) = Path(folder).glob("*.whl")
        early = ["--pre"] if way == "coming" else []
        needed = [*requirements(way, project), *TOOLS]
        subprocess.run([*pip, "install", *early, *needed], check=True)
        subprocess.run([*pip, "install", "--no-deps", wheel], check=True)
        subprocess.run([*pip, "freeze"], check=True)
        tests = PRIVATE if way == "coming" else BASE
        run = [pip[0], "-m", "pytest", "-q", "-p", "no:cacheprovider", "-m", QUICK, *tests]
        subprocess.run(run, cwd=ROOT, env=around, check=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("way", choices=WAYS)
    parser.add_argument("python")
    options = parser.parse_args()
    check(options.way, options.python)
