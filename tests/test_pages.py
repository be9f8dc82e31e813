"""The documentation's tables are those of the code, and its examples of effects work."""

import os
import re
import subprocess
import sys
from pathlib import Path
from shutil import copytree, ignore_patterns

import numpy as np
import pytest
import yaml
from tests import pages

import roughgas
from roughgas import config, theory
from roughgas.base import InputError
from roughgas.claims import evidence, paper
from roughgas.data.point import read_point
from roughgas.effects import KINDS
from roughgas.scene import build

ROOT, PACKAGE = Path(__file__).parents[1], Path(roughgas.__file__).parent
TABLES = pages.tables()
EFFECTS = (ROOT / "docs/effects.md").read_text(encoding="utf-8")
BEFORE_EXPERIMENTS = "\nexperiments:\n"  # in config.yaml


@pytest.mark.parametrize("name", TABLES, ids="-".join)
def test_the_tables_of_the_page_are_those_of_the_code(name):
    assert pages.written(*name) == TABLES[name], "write it anew: python -m tests.pages"


def test_no_tolerance_is_left_out():
    """Each number that a judge is in these files is in the page's table, or decides nothing."""
    for module in (evidence, paper):
        said = pages.said(module)
        numbers = {name for name in said if isinstance(getattr(module, name), float)}
        left = {name for name in numbers if pages.DECIDES.get(name) is not module}
        assert left <= {"NEAR"}, "a tolerance without its reason"


def section(heading):
    return EFFECTS.split(f"\n## {heading}\n")[1].split("\n## ")[0]


def block(text, language):
    (found,) = re.findall(rf"^```{language}\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    return found


def rows(text):
    """The cells of every row of the tables in a text, but for their heads."""
    lines = [line for line in text.splitlines() if line.startswith("| ")]
    cells = [[cell.strip() for cell in line[1:-1].split(" | ")] for line in lines]
    return [row for row in cells if row[0] != "---"][1:]


def config_with(experiment, folder):
    """A copy of config.yaml in a folder, with one experiment more; its path."""
    text = (ROOT / "config.yaml").read_text(encoding="utf-8")
    assert text.count(BEFORE_EXPERIMENTS) == 1
    changed = text.replace(BEFORE_EXPERIMENTS, f"{BEFORE_EXPERIMENTS}{experiment}\n")
    (folder / "config.yaml").write_text(changed, encoding="utf-8")
    return folder / "config.yaml"


def test_what_the_page_of_effects_says_is_refused():
    refused = [[cell.strip("`") for cell in row] for row in rows(section("What is refused"))]
    assert len(refused) > 5
    for settings, answer in refused:
        experiment = yaml.safe_load(f"{{{settings}}}")
        with pytest.raises(InputError) as caught:
            build(experiment, 0.9, 0.0 if "spin" in experiment["effects"] else -1.0)
        assert str(caught.value) == answer


def test_the_experiment_at_the_top_is_legal(tmp_path):
    file = config_with(block(EFFECTS.split("\n## ")[0], "yaml"), tmp_path)
    settings = config.experiment(config.load(file), "tilted_bed", "paper")
    there = {name for name, own in settings["effects"].items() if own is not None}
    chosen = {"spin", "gravity", "floor", "walls", "friction"}
    assert there == chosen | {"contact_averages"} <= set(KINDS)
    assert len(config.every_variant("tilted_bed", settings)) == 3


@pytest.mark.slow
def test_the_worked_example_is_one_file_and_one_line(tmp_path):
    """R is first the theory of free cooling's at the r that was set, and in the end that of r = 1.

    Velocities are correlated, which theory neglects: 4 % at most.
    """
    example, beta, package = section("A worked example"), -0.8, tmp_path / "roughgas"
    copytree(PACKAGE, package, ignore=ignore_patterns("__pycache__"))
    (package / "effects/plasticity.py").write_text(block(example, "python"), encoding="utf-8")
    listed, before = package / "effects/__init__.py", None
    text = listed.read_text(encoding="utf-8")
    for line in block(example, "diff").splitlines(keepends=True):
        if line.startswith("+"):
            assert text.count(before) == 1, before
            text = text.replace(before, before + line[1:])
        before = line[1:]
    listed.write_text(text, encoding="utf-8")
    own = {"PYTHONPATH": str(tmp_path), "ROUGHGAS_CACHE_DIR": str(tmp_path / "cache")}
    command = [sys.executable, "-m", "roughgas", "run", "cooling_plastic", "--r=0.8", "--seed=1"]
    command += [f"--beta={beta}", f"--config={config_with(block(example, 'yaml'), tmp_path)}"]
    command += [f"--output={tmp_path / 'point.nc'}"]
    subprocess.run(command, cwd=tmp_path, env=os.environ | own, check=True, timeout=300)
    point, shown = read_point(tmp_path / "point.nc"), rows(example)
    assert len(shown) == 2
    for passed, found, expected, r in (map(float, row) for row in shown):
        (k,) = np.flatnonzero(point["collisions_per_particle"] == passed)
        assert point["R_series"][k] == pytest.approx(found, abs=1e-4)
        assert theory.cooling_ratio(r, beta, 2, 0.5) == pytest.approx(expected, abs=1e-4)
        assert found == pytest.approx(expected, rel=0.04)
