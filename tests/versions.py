"""The package alone, as users install it, with the versions that pyproject.toml allows.

    python -m tests.versions newest python3.12
    python -m tests.versions oldest python3.11

builds the wheel, installs it into a new environment, without extras and with the newest or
the oldest versions of its dependencies, and runs tests that need no more than these, some of them
once more with kernels compiled by numba's public functions alone. `coming` takes
pre-releases of numba, and Snakemake past its upper bound: it runs the tests of what is
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
    "tests/simulation/test_gas.py",
    "tests/statistics",
    "tests/test_bits.py",
)
"""Tests that need nothing but the package; those of bits compare numbers across all versions."""
PUBLIC = ("tests/kernel/test_collision_rule.py", "tests/test_bits.py")
"""Tests that are repeated with kernels compiled by numba's public functions alone."""
PRIVATE = ("tests/compiling", "tests/robustness/test_stopping.py")
"""Tests of what is used though it is private."""
QUICK = "not slow and not remedy and not campaign and not browser and not slurm"


def requirements(way, project):
    """Return pip's requirements for one of WAYS."""
    dependencies = list(project["dependencies"])
    if way == "oldest":
        return [re.sub(r">=([\w.]+).*", r"==\1", requirement) for requirement in dependencies]
    if way == "coming":
        dependencies += project["optional-dependencies"]["workflow"]
        return [requirement.partition(",")[0] for requirement in dependencies]
    return dependencies


def check(way, python):
    """Install the wheel in one of WAYS for a Python, and run the tests. Raises where one fails."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    environ = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    with tempfile.TemporaryDirectory() as folder:
        environ["ROUGHGAS_CACHE_DIR"] = f"{folder}/kernels"
        if way == "coming":
            environ["ROUGHGAS_PUBLIC_NUMBA"] = "0"  # its private parts are tested
        subprocess.run([python, "-m", "venv", f"{folder}/venv"], check=True)
        pip = [f"{folder}/venv/bin/python", "-m", "pip", "--disable-pip-version-check", "-q"]
        subprocess.run([*pip, "wheel", "--no-deps", "-w", folder, ROOT], check=True)
        (wheel,) = Path(folder).glob("*.whl")
        early = ["--pre"] if way == "coming" else []
        packages = [*requirements(way, project), *TOOLS]
        subprocess.run([*pip, "install", *early, *packages], check=True)
        subprocess.run([*pip, "install", "--no-deps", wheel], check=True)
        subprocess.run([*pip, "freeze"], check=True)
        run = [pip[0], "-m", "pytest", "-q", "-p", "no:cacheprovider", "-m", QUICK]
        tests = PRIVATE if way == "coming" else BASE
        subprocess.run([*run, *tests], cwd=ROOT, env=environ, check=True)
        if way != "coming":
            environ["ROUGHGAS_PUBLIC_NUMBA"] = "1"
            subprocess.run([*run, *PUBLIC], cwd=ROOT, env=environ, check=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("way", choices=WAYS)
    parser.add_argument("python")
    options = parser.parse_args()
    check(options.way, options.python)
