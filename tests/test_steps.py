"""Steps of the workflow: what they refuse, and that each is what a rule gives."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from schedules import TINY

from roughgas import steps
from roughgas.simulation.point import kernels

ROOT = Path(__file__).parents[1]
AXIS = {"r": ["0.9"], "beta": ["0"], "seeds": 1}


def test_a_mistake_ends_a_process_in_one_line(tmp_path):
    line = ["figure", "fig9", "x.nc", "--output", "f.png"]
    done = subprocess.run(
        [sys.executable, "-m", "roughgas.steps", *line],
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert done.stderr.startswith("roughgas: error: figure = fig9: must")
    assert list(tmp_path.iterdir()) == []


def test_each_step_is_what_a_rule_gives():
    rules = "".join(path.read_text() for path in (ROOT / "rules").glob("*.smk"))
    assert set(re.findall(r"roughgas\.steps (\w+)", rules)) == set(steps.STEPS)


@pytest.mark.parametrize(
    ("name", "sweep", "inertia"),
    [("spun", {"spin.inertia": ["1", "0.1"]}, [1, 0.1]), ("plain", {}, [0.5])],
)
def test_all_variants_are_compiled_at_once(monkeypatch, name, sweep, inertia):
    told = []
    kept = "roughgas.simulation.point.compile_kernels"
    monkeypatch.setattr(kept, lambda every, r: told.extend([*every, r]))
    settings = json.dumps(TINY | {"sweep": AXIS | sweep})
    assert steps.main(["compile_kernels", name, "--settings", settings, "--r=0.9"]) == 0
    assert told.pop() == 0.9
    assert [one["effects"]["spin"]["inertia"] for one in told] == inertia
    assert len(kernels(told, 0.9)) == 1
