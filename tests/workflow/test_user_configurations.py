"""A user's configuration is the same for `roughgas --config`, `simulate` and Snakemake's
--configfile: the examples of docs/experiments.md, each run by all three."""

import re
from pathlib import Path

import pytest
from project import ROOT, Project
from slow_cases import slow_but

from roughgas import config, simulate
from roughgas.base import sorted_json
from roughgas.base.reading import parse_yaml
from roughgas.cli import main
from roughgas.data.point import WALL_CLOCK, read_point

PAGE = (ROOT / "docs/experiments.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"```yaml\n(.*?)```", PAGE, re.S)
NAMES = [tuple(parse_yaml(example, "the page")) for example in EXAMPLES]
POINTS = {
    "vibrated_wide": "vibrated_wide",
    "vibrated_hollow": "vibrated_hollow/inertia0.3",
    "cooling_dense": "cooling_dense/box40",
    "vibrated_gently": "vibrated_gently/caselow",
    "quench": "quench/spin_share0.5",
}
"""Path of a variant of each experiment of the page; its point is outside the sweep."""
DIFFERENCES = [
    "  cooling: {effects: {contact_time: null}}\n",
    "  cooling: {particles: 50}\nscales: {small: {cooling: {particles: 30}}, tiny: {}}\n",
    "  cooling: {particles: 50}\n",
    "  vibrated_smooth_walls: {extends: cooling}\n",  # of another parent
    "  drives.heated: {particles: 50}\n",
    "  mine: {extends: sheared}\nscale: tiny\n",
]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder without a configuration."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(text, path="mine.yaml"):
    Path(path).write_text(f"experiments:\n{text}", encoding="utf-8")
    return path


def by_snakemake(path):
    """Return the configuration of the workflow with a file of --configfile."""
    written = config.WrittenConfiguration.from_file(path).over(config.WrittenConfiguration({}))
    return config.load(ROOT / "config.yaml", written.raw)


def test_the_page_has_these_examples():
    assert {name for names in NAMES for name in names} == {*POINTS}


@pytest.mark.parametrize("text", slow_but(EXAMPLES[:2], EXAMPLES), ids=map("-".join, NAMES))
def test_all_readers_agree_on_an_example(text, folder):
    by_library, by_workflow = config.load(write(text)), by_snakemake("mine.yaml")
    for name in parse_yaml(text, "the page"):
        for scale in ("paper", "small"):
            settings = by_library.experiment(name, scale).raw
            assert settings == by_workflow.experiment(name, scale).raw
            assert settings == config.load_experiment("mine.yaml", name, scale).raw


@pytest.mark.parametrize("text", slow_but(DIFFERENCES[:2], DIFFERENCES))
def test_a_file_may_hold_differences_alone(text, folder):
    by_library, by_workflow = config.load(write(text)), by_snakemake("mine.yaml")
    assert {**vars(by_library), "source": 0, "studies": 0} == {
        **vars(by_workflow),
        "source": 0,
        "studies": 0,
    }


def test_a_complete_experiment_replaces_the_shipped_one(folder):
    """The shipped experiment of the same name leaves no setting, at any scale."""
    shipped = config.load(ROOT / "config.yaml")
    settings = shipped.experiment("cooling", "paper").raw
    del settings["effects"]["contact_time"]
    for addition in ("", "  mine: {extends: sheared}\n"):  # alone, and over config.yaml
        text = sorted_json(settings)
        path = write(f"  cooling: {text}\n{addition}scales: {{paper: {{}}, small: {{}}}}\n")
        for configuration in (config.load(path), by_snakemake(path)):
            for scale in ("paper", "small"):
                assert configuration.experiment("cooling", scale).raw == settings


def test_a_file_that_stands_alone_needs_no_other(folder):
    Path("config.yaml").write_text("of: another program")
    settings = config.load(ROOT / "config.yaml").experiment("cooling", "paper").raw
    del settings["description"]
    path = write(f"  mine: {sorted_json(settings)}\n  wide: {{extends: mine}}\n")
    assert {*config.load(path).experiments} == {"mine", "wide"}
    assert config.load_experiment(path, "wide", "paper").raw == settings


def test_a_complete_file_excludes_shipped_experiments(folder):
    settings = config.load(ROOT / "config.yaml").experiment("cooling", "paper").raw
    path = write(f"  mine: {sorted_json(settings)}\ncomplete: true\n")
    for configuration in (config.load(path), by_snakemake(path)):
        assert {*configuration.experiments} == {"mine"} and {*configuration.scales} == {"paper"}


@pytest.mark.slow
def test_snakemake_reads_numbers_of_a_file_as_the_command_does(project):
    """Snakemake's reader takes 1e-4 for text."""
    point = "results/paper/cooling/r0.9/beta0.05/seed1.nc"
    output = project.succeed("-n", "--configfile", str(ROOT / "config.yaml"), "--", point)
    assert "cooling: --r=0.9 --beta=0.05" in output


@pytest.mark.slow
@pytest.mark.parametrize("text", EXAMPLES, ids=map("-".join, NAMES))
def test_an_example_is_run_by_all_three(text, tmp_path, monkeypatch):
    project = Project(tmp_path)
    monkeypatch.chdir(tmp_path)
    write(text)
    names = [POINTS[name] for name in parse_yaml(text, "the page")]
    paths = [f"results/small/{name}/r0.9/beta0.05/seed1.nc" for name in names]
    options = ["--configfile", "mine.yaml", "--config", "scale=small"]
    project.succeed("-j1", *options, "--", *paths)
    for name, path in zip(names, paths, strict=True):
        arguments = ["--r=0.9", "--beta=0.05", "--config=mine.yaml", "--scale=small", "-o=point.nc"]
        assert main(["run", name, *arguments]) == 0
        keywords = {"config": "mine.yaml", "scale": "small", "progress": False}
        gas = simulate(name, r=0.9, beta=0.05, **keywords)
        for dataset in (read_point(path), read_point("point.nc")):
            assert dataset.experiment_json == gas.experiment_json
            assert dataset.drop_vars(WALL_CLOCK).equals(gas.drop_vars(WALL_CLOCK))
