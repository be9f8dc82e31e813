"""README's first exercise, "Change it", word by word: its settings, verdicts, titles and page."""

import base64
import difflib
import html
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from project import ROOT, Project
from tests.study_modules import module_of_study

from roughgas import config
from roughgas.base import sorted_json
from roughgas.base.files import study_module
from roughgas.claims.verdicts import EXCEPTIONS
from roughgas.data.reduced import read_reduced
from roughgas.workflow.figures import Figures
from roughgas.workflow.studies import Studies
from roughgas.workflow.sweeps import Sweeps

README = (ROOT / "README.md").read_text(encoding="utf-8")
(EXERCISE,) = re.findall(r"## Change it\n.*?```console\n(.*?)```", README, re.S)
COMMANDS = [line.removeprefix("$ ") for line in EXERCISE.splitlines()]
EDITS = [line for line in COMMANDS if line.startswith(("cp ", "sed "))]
GASES = ("vibrated_friction", "cooling_friction")
NUMBERS = {"three": 3, "four": 4, "six": 6}
FINDING = "A bed follows the rate equations. A cooling gas does"


def shell(commands, folder):
    """Type commands in a folder, where this environment's programs and the package are found."""
    environment = {
        "PYTHONPATH": str(folder / "src"),
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
    }
    script = ["bash", "-e", "-c", "\n".join(commands)]
    run = subprocess.run(
        script, cwd=folder, env=os.environ | environment, capture_output=True, text=True
    )
    assert run.returncode == 0, run.stderr[-3000:]
    return run.stdout


def test_it_changes_what_it_says_at_the_scale_it_uses(tmp_path, monkeypatch):
    """As many lines as it says, all of r; at its scale r differs from friction's, nothing else."""
    (tmp_path / "studies").mkdir()
    (tmp_path / "config.yaml").write_text((ROOT / "config.yaml").read_text())
    shell([f"cp -r '{ROOT}/studies/friction' studies/friction", *EDITS], tmp_path)
    before, after = (
        (tmp_path / "studies" / name / "config.yaml").read_text().splitlines()
        for name in ("friction", "mine")
    )
    changed = [line for line in difflib.ndiff(before, after) if line.startswith("+ ")]
    (lines,) = re.findall(r"the restitution r in (\w+) lines of its `config.yaml`", README)
    assert len(changed) == NUMBERS[lines] and all('r: ["0.8"]' in line for line in changed)
    monkeypatch.chdir(tmp_path)
    configuration = config.load("config.yaml")
    (scale,) = re.findall(r"--config scale=(\w+)", EXERCISE)
    for gas in GASES:
        for name in ("paper", scale):
            original, mine = (
                configuration.experiment(f"{study}.{gas}", name).raw
                for study in ("friction", "mine")
            )
            assert mine["sweep"]["r"] == ["0.8"] and original["sweep"]["r"] == ["0.9"]
            mine["sweep"]["r"] = ["0.9"]
            assert sorted_json(mine) == sorted_json(original)
    drawings = Figures(Studies(configuration, Sweeps(configuration, [])))
    caption = drawings.caption("mine")
    assert caption.startswith("Not judged yet. ") and "data of another study" in caption
    assert "What to notice" in drawings.caption("friction")


@pytest.fixture(scope="module")
def typed(tmp_path_factory):
    """The project in which every command of the exercise has been typed, and all it printed."""
    folder = Project(tmp_path_factory.mktemp("typed")).folder
    return folder, shell(COMMANDS, folder)


def claims_of(folder):
    return json.loads((folder / "results/small/mine/claims.json").read_text())


@pytest.mark.slow
def test_its_data_are_of_the_changed_settings(typed):
    folder, printed = typed
    assert "0.8" in printed
    for gas in GASES:
        data = read_reduced(folder / f"results/small/mine.{gas}.nc")
        assert data.r.values.tolist() == [0.8] and (data.n_seeds > 0).all()
        assert data.attrs["scale"] == "small"


@pytest.mark.slow
def test_its_titles_say_what_its_verdicts_say(typed):
    """The picture is drawn from these data by these functions, so that its titles are theirs.

    Where more than a few points are not steady, the title states no conclusion.
    """
    folder, _ = typed
    datasets = [read_reduced(folder / f"results/small/mine.{gas}.nc") for gas in GASES]
    figure = study_module(folder / "studies" / "mine", "figure").draw(*datasets)
    verdicts = {claim["id"]: claim["verdict"] for claim in claims_of(folder)["claims"]}
    drawn = module_of_study("friction", "figure")
    for axes, data, (statement, neutral), conclusion in zip(
        figure.axes,
        datasets,
        (drawn.BED, drawn.COOLING),
        ("A bed follows the rate equations", "A cooling gas follows the rate equations"),
        strict=False,
    ):
        few_set_aside = float((data.equilibrated <= 0.5).mean()) <= EXCEPTIONS
        title = conclusion if verdicts[statement] == "holds" and few_set_aside else neutral
        assert title in [text.get_text() for text in axes.texts]


@pytest.mark.slow
def test_its_verdicts_are_by_criteria_of_another_study(typed):
    folder, _ = typed
    sentence = "Findings and criteria were written for the data of another study, friction."
    assert claims_of(folder)["reservation"] == sentence
    text = (folder / "results/small/mine/claims.md").read_text()
    assert "Fixed before its data" not in text and text.count(sentence) == 4


@pytest.mark.slow
def test_its_page_has_its_picture_and_no_findings_of_friction(typed):
    folder, _ = typed
    page = html.unescape((folder / "results/small/mine/page.html").read_text())
    picture = (folder / "figures/small/mine.png").read_bytes()
    assert base64.b64encode(picture).decode() in page
    assert "Not judged yet" in page and "How does R depend on the" in page
    for stale in (FINDING, "What to notice", "Fixed before its data", "Single particles escape"):
        assert stale not in page
    friction = (ROOT / "studies/friction/README.md").read_text()
    assert FINDING in friction and "What to notice" in friction
