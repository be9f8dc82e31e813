"""Steps of the workflow: their refusals, and that a rule calls each."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from raw import kernels
from schedules import TINY

from roughgas import steps

ROOT = Path(__file__).parents[1]
PAPER = str(ROOT / "studies" / "paper")
AXIS = {"r": ["0.9"], "beta": ["0"], "seeds": 1}


def test_a_mistake_ends_a_process_in_one_line(tmp_path):
    line = ["figure", PAPER, "fig9", "x.nc", "--shows", "x", "--output", "f.png"]
    done = subprocess.run(
        [sys.executable, "-m", "roughgas.steps", *line],
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert done.stderr.startswith("roughgas: error: studies/paper/figure.py = it: must have fig9()")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("sweep", "message"),
    [
        ({"particles": []}, "--settings.sweep.particles = []: must be a list that is not empty"),
        ({"lid.restitution": ["1"]}, "--settings.sweep: key = 'lid.restitution': must begin with"),
        ({"spin.inertia": ["2"]}, "--settings.effects.spin.inertia = 2"),
    ],
)
def test_what_is_compiled_is_checked(capsys, sweep, message):
    settings = json.dumps(TINY | {"sweep": AXIS | sweep})
    assert steps.main(["compile_kernels", "gas", "--settings", settings, "--r=0.9"]) == 2
    assert capsys.readouterr().err.startswith(f"roughgas: error: {message}")


def test_each_step_is_what_a_rule_gives():
    """Criteria are fixed by hand, before there are data, and by no rule."""
    rules = "".join(path.read_text() for path in (ROOT / "rules").glob("*.smk"))
    assert set(re.findall(r"roughgas\.steps (\w+)", rules)) == set(steps.STEPS) - {"fix_criteria"}


@pytest.mark.parametrize(
    ("name", "effects", "sweep", "inertia"),
    [
        ("spun", TINY["effects"], {"spin.inertia": ["1", "0.1"]}, [1, 0.1]),
        ("unspun", {"spin": {}}, {"spin.inertia": ["1", "0.1"]}, [1, 0.1]),
        ("plain", TINY["effects"], {}, [0.5]),
    ],
)
def test_all_variants_are_compiled_at_once(monkeypatch, name, effects, sweep, inertia):
    """Their third axis alone may give a setting that a point needs."""
    compiled_scenes = []
    compiler = "roughgas.simulation.point.compile_kernels"
    monkeypatch.setattr(compiler, lambda every, r: compiled_scenes.extend([*every, r]))
    settings = json.dumps(TINY | {"effects": effects, "sweep": AXIS | sweep})
    assert steps.main(["compile_kernels", name, "--settings", settings, "--r=0.9"]) == 0
    assert compiled_scenes.pop() == 0.9
    assert [experiment.effects["spin"].inertia for experiment in compiled_scenes] == inertia
    assert len(kernels(compiled_scenes, 0.9)) == 1
