"""What `python -m tests.versions` installs; `make versions` runs it."""

import re
import tomllib

from packaging.requirements import Requirement
from tests.versions import BASE, PRIVATE, ROOT, requirements

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
WORKFLOW = (ROOT / ".github/workflows/versions.yml").read_text(encoding="utf-8")


def test_the_oldest_are_the_lower_bounds():
    for one, given in zip(requirements("oldest", PROJECT), PROJECT["dependencies"], strict=True):
        (pinned,) = Requirement(one).specifier
        assert pinned.operator == "==" and f">={pinned.version}" in given


def test_what_is_coming_has_no_upper_bound():
    found = {Requirement(one).name: one for one in requirements("coming", PROJECT)}
    assert {"numba", "snakemake"} <= set(found) and not any("<" in one for one in found.values())
    assert "<" in "".join(one for one in PROJECT["dependencies"] if one.startswith("numba"))


def test_all_tests_that_it_runs_are_there():
    assert all((ROOT / path).exists() for path in (*BASE, *PRIVATE))


def test_every_python_that_the_package_promises_is_tried():
    promised = re.findall(r"Python :: (3\.\d+)", "\n".join(PROJECT["classifiers"]))
    assert re.findall(r'"(3\.\d+)"', WORKFLOW.split("matrix:")[1].split("include:")[0]) == promised
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    assert f"for python in {' '.join(f'python{one}' for one in promised)};" in makefile
