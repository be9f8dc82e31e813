"""Jobs of a study with effects and observables: what they run, and when they run again."""

import shutil

import pytest
from study_code import EFFECTS, ROOT, add_study

from roughgas import config
from roughgas.config import study_code
from roughgas.workflow.sweeps import Sweeps

EXPERIMENTS = ("mine.plain", "mine.observed", "mine.metal/yield_speed0.5", "cooling")


@pytest.fixture
def study(tmp_path, monkeypatch):
    """The folder of a study in the present folder."""
    shutil.copy(ROOT / "config.yaml", tmp_path)
    monkeypatch.chdir(tmp_path)
    yield add_study()
    study_code.use(())


def codes():
    """The fingerprints of the code of points, by experiment, as a new process finds them."""
    sweeps = Sweeps(config.load("config.yaml"), [])
    return {name: sweeps.point_code("paper", name) for name in EXPERIMENTS}


@pytest.mark.parametrize(
    ("file", "changed"),
    [
        ("effects", {"mine.metal/yield_speed0.5"}),
        ("observables", {"mine.observed"}),
        ("judges", set()),
    ],
)
def test_an_edit_changes_the_code_of_points_that_use_the_file(study, file, changed):
    path, before = study / f"{file}.py", codes()
    text = path.read_text() if path.exists() else ""
    path.write_text(text + "\nADDED = 1\n")
    after = codes()
    assert {name for name in EXPERIMENTS if after[name] != before[name]} == changed
    path.write_text(text)
    assert codes() == before


def test_jobs_get_the_folders_whose_code_they_need(study):
    sweeps = Sweeps(config.load("config.yaml"), [])
    options = {name: sweeps.study_options("paper", name) for name in EXPERIMENTS}
    needed = ["--studies", "studies/mine"]
    assert options == dict(zip(EXPERIMENTS, ([], needed, needed, []), strict=True))


def test_kernels_depend_on_the_sources_of_effects(study):
    def kinds():
        sweeps = Sweeps(config.load("config.yaml"), [])
        assert sweeps.minutes(1, 1, "paper", "mine.metal", "0.8") > 0
        return sweeps.kernel_kinds("paper", "mine.metal", "0.8")

    before = kinds()
    (study / "effects.py").write_text(EFFECTS + "\nADDED = 1\n")
    assert kinds() != before
