"""Faults that the tests notice: `python -m tests.mutants [ROOM ...]` makes one after the other.

mutants.json has the faults: a text in the source, its replacement, and its room. Each is made in a
copy of the project, and there the test runs that noticed it last time, and if that passes the tests
of the room, until one fails. A line is printed for each, and the exit status is 1 if a fault passes
that is not listed so. `before` and `after` in the file are what failed before and after the rooms
were moved.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
COPIED = ("config.yaml", "docs", "pyproject.toml", "README.md", "requirements.lock", "rules", "src")
COPIED += ("CHANGELOG.md", "CITATION.cff", "LICENSE", "Makefile", "Snakefile", "profiles")
COPIED += ("studies", "tests")
QUICK = "not (slow or remedy or campaign or browser or slurm)"
ELSEWHERE = {  # tests of a room that are not in its own folder
    "base": ["data", "cli/test_process.py", "robustness/test_surroundings.py"],
    "cli": ["robustness/test_surroundings.py", "test_refusals.py"],
    "config": ["test_refusals.py"],
    "doctor": ["robustness/test_surroundings.py"],
    "effects": [
        "kernel/test_against_brute_force.py",
        "kernel/test_collision_rule.py",
        "hard_cases",
    ],
    "kernel": ["hard_cases"],
    "library": ["test_library.py"],
    "scene": ["simulation/test_protocols.py", "test_refusals.py"],
    "tasks": ["accuracy", "studies"],
}


def tests_of(room):
    folders = [room] if (ROOT / "tests" / room).is_dir() else []
    return [f"tests/{name}" for name in folders + ELSEWHERE.get(room, [])]


def file_to_change(copy, old):
    """The only file of the source and of studies that holds a text, which it holds once."""
    sources = [path for root in ("src", "studies") for path in (copy / root).rglob("*.py")]
    matches = [path for path in sources if old in path.read_text()]
    if len(matches) != 1 or matches[0].read_text().count(old) != 1:
        raise SystemExit(f"must stand once in the source: {old!r}")
    return matches[0]


def killer(copy, mutant):
    """The first test that fails with a fault, or None."""
    path = file_to_change(copy, mutant["old"])
    text = path.read_text()
    path.write_text(text.replace(mutant["old"], mutant["new"]))
    last = mutant["after"].partition("[")[0]
    test = ("::" in last and failing(copy, [last])) or failing(copy, tests_of(mutant["room"]))
    path.write_text(text)
    return test


def failing(copy, tests):
    """The first of these tests that fails in a copy of the project, or None."""
    environment = os.environ | {"PYTHONPATH": f"{copy}/src:{copy}"}
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "-m", QUICK]
    done = subprocess.run(
        [*command, *tests], cwd=copy, env=environment, capture_output=True, text=True
    )
    if done.returncode not in (0, 1, 5):  # such as killed: nothing is known (5: no quick test)
        raise SystemExit(f"{' '.join(tests)}: pytest ended with {done.returncode}\n{done.stdout}")
    named = re.search(r"^(?:FAILED|ERROR) (\S+)", done.stdout, re.MULTILINE)
    return named and named[1]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("rooms", nargs="*", help="default: all")
    rooms = parser.parse_args().rooms
    mutants = json.loads((ROOT / "tests/mutants.json").read_text())
    missed = 0
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder)
        for name in COPIED:
            copied = shutil.copytree if (ROOT / name).is_dir() else shutil.copy2
            copied(ROOT / name, copy / name)
        for mutant in mutants:
            if rooms and mutant["room"] not in rooms:
                continue
            test = killer(copy, mutant)
            missed += test is None and not mutant.get("survives", False)
            print(f"{mutant['room']:11}{test or 'survives'}: {mutant['old']!r}", flush=True)
    return missed > 0


if __name__ == "__main__":
    raise SystemExit(main())
