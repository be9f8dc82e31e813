"""The data that findings and criteria of a study belong to."""

import re
import shutil
from pathlib import Path

import pytest
from tests.study_modules import FOLDERS, ROOT

from roughgas import config
from roughgas.base import InputError
from roughgas.config import findings

CONFIGURATION = ROOT / "config.yaml"


@pytest.fixture(scope="module")
def shipped():
    return config.load(CONFIGURATION)


@pytest.mark.parametrize("name", [folder.name for folder in FOLDERS])
def test_the_findings_of_shipped_studies_are_of_their_data(shipped, name):
    """If experiments, tasks or criteria have changed, `fixed` in claims.yaml must say so.

    So must README.md. Then `python -m roughgas.steps fix_criteria config.yaml NAME`.
    """
    assert findings.reservation(shipped, name) == ""


@pytest.fixture
def load_mine(tmp_path, monkeypatch):
    """Return a function that loads a copy of the study of friction, studies/mine, after edits of
    its files, (file, old text, new text) each."""
    shutil.copy(CONFIGURATION, tmp_path)
    shutil.copytree(ROOT / "studies" / "friction", tmp_path / "studies" / "mine")
    monkeypatch.chdir(tmp_path)

    def load(*edits):
        for file, old, new in edits:
            path = Path("studies", "mine", file)
            text = path.read_text()
            assert old in text
            path.write_text(text.replace(old, new))
        return config.load("config.yaml")

    return load


SIGNED = "findings.yaml", "study: friction", "study: mine"
EDITS = {
    "r": ("config.yaml", 'r: ["0.9"]', 'r: ["0.8"]'),
    "schedule": ("config.yaml", "measure: 1000", "measure: 999"),
    "criterion": ("claims.yaml", "is compatible with zero", "vanishes"),
    "judge": ("claims.yaml", "judge: keeps_spin_when_weak", "judge: follows_rates"),
}
WITHOUT_EFFECT = {
    "scale": ("config.yaml", 'beta: ["0", "1"]', 'beta: ["0"]'),
    "description": ("config.yaml", "description: The vibrated bed", "description: A vibrated bed"),
    "time": ("claims.yaml", "tries: 2", "tries: 3"),
    "remark": ("config.yaml", "# Coulomb friction", "# Friction"),
}


def test_a_copied_study_has_no_findings(load_mine):
    sentence = findings.reservation(load_mine(), "mine")
    assert sentence == "Findings and criteria were written for the data of another study, friction."


@pytest.mark.slow
@pytest.mark.parametrize("name", EDITS)
def test_an_edited_study_has_no_findings_until_its_criteria_are_fixed(load_mine, name):
    configuration = load_mine(SIGNED, EDITS[name])
    assert "other experiments or criteria" in findings.reservation(configuration, "mine")
    assert re.fullmatch("[0-9a-f]{16}", findings.write(configuration, "mine"))
    assert findings.reservation(load_mine(), "mine") == ""


@pytest.mark.slow
@pytest.mark.parametrize("file", ["effects.py", "observables.py", "laws.py"])
def test_findings_are_of_the_effects_and_observables_of_the_study(load_mine, file):
    """And of files that these import; an edit of a figure changes no data."""
    study = Path("studies", "mine")
    (study / "laws.py").write_text("SPEED = 1.0\n")
    (study / "observables.py").write_text("from .laws import SPEED\n")
    (study / "effects.py").write_text("\n")
    findings.write(load_mine(SIGNED), "mine")
    (study / "figure.py").write_text("\n")
    assert findings.reservation(load_mine(), "mine") == ""
    (study / file).write_text((study / file).read_text() + "ADDED = 1\n")
    assert "other experiments or criteria" in findings.reservation(load_mine(), "mine")


@pytest.mark.slow
@pytest.mark.parametrize("name", WITHOUT_EFFECT)
def test_findings_survive_edits_that_change_no_data(load_mine, name):
    """The copy has other experiments' names alone; scales other than the paper's do not count."""
    assert findings.reservation(load_mine(SIGNED), "mine") == ""
    assert findings.reservation(load_mine(WITHOUT_EFFECT[name]), "mine") == ""


@pytest.mark.slow
def test_what_an_experiment_inherits_counts(load_mine):
    """The bed of friction extends the root's."""
    configuration = load_mine(SIGNED)
    assert findings.reservation(configuration, "mine") == ""
    root = Path("config.yaml")
    root.write_text(root.read_text().replace("particles: 160", "particles: 161"))
    assert "other experiments" in findings.reservation(load_mine(), "mine")
    paper = config.load("config.yaml", {"scales": {"paper": {"cooling": {"box": [90, 90]}}}})
    assert "other experiments" in findings.reservation(paper, "paper")


@pytest.mark.slow
def test_a_study_without_the_file_or_its_scale_is_not_judged(load_mine):
    path = Path("studies/mine/findings.yaml")
    content = path.read_text()
    path.unlink()
    assert findings.reservation(load_mine(), "mine").startswith("No findings.yaml says")
    path.write_text(content + "more: 1\n")
    message = "studies/mine/findings.yaml: key = 'more': must be one of digest, study"
    assert message in str(InputError(*load_mine().refused["mine"]))
