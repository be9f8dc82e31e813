"""config.yaml: what it resolves to."""

import copy
import json
import re
from functools import partial
from pathlib import Path

import pytest

from roughgas import accuracy, config, simulate
from roughgas.accuracy.running import run_task
from roughgas.base import InputError
from roughgas.cli import main
from roughgas.config import schema
from roughgas.config.reading import read_yaml
from roughgas.config.study_folders import write_effective
from roughgas.show import catalogue

ROOT = Path(__file__).parents[2]
CONFIG = ROOT / "tests" / "experiments.yaml"


def test_an_experiment_inherits_what_it_does_not_set(paper):
    walls = config.experiment(paper, "vibrated_rough_walls", "paper")
    vibrated = config.experiment(paper, "vibrated", "paper")
    assert walls["effects"] == vibrated["effects"] | {"walls": {"restitution": 1, "roughness": 1}}
    assert walls["schedule"] == vibrated["schedule"]
    assert walls["sweep"]["r"] == ["0.9"] and walls["sweep"]["beta"][0] == "-1"
    assert "extends" not in walls


def test_what_is_extended_is_taken_at_the_same_scale(paper):
    walls = config.experiment(paper, "vibrated_smooth_walls", "small")
    vibrated = config.experiment(paper, "vibrated", "small")
    for key in ("particles", "box", "schedule"):
        assert walls[key] == vibrated[key] != config.experiment(paper, "vibrated", "paper")[key]


def test_null_removes_an_effect():
    base = {"effects": {"spin": {"inertia": 0.5}, "walls": {"restitution": 1}}}
    assert config.merged(base, {"effects": {"walls": None}}) == {
        "effects": {"spin": {"inertia": 0.5}}
    }


def test_merging_changes_neither_part(paper):
    before = copy.deepcopy(paper)
    config.experiment(paper, "vibrated_rough_walls", "small")["effects"]["spin"] = None
    config.merged(paper, {"experiments": {"cooling": {"particles": 2}}})
    assert paper == before


def test_settings_of_a_point_survive_the_way_through_text(paper):
    settings = config.point_settings(config.experiment(paper, "vibrated", "paper"))
    assert "sweep" not in settings
    assert config.from_text(config.as_text(settings), "--settings") == settings


def test_numbers_may_stand_in_a_sweep_without_quotes(paper):
    whole = copy.deepcopy(paper)
    whole["experiments"]["cooling"]["sweep"]["r"] = [0.9, 1]
    schema.check(whole)
    points = set(config.sweep(config.experiment(whole, "cooling", "paper")))
    assert ("0.9", "0", "1") in points and ("1", "0", "4") in points


def test_numbers_are_read_as_a_person_means_them(tmp_path):
    path = tmp_path / "c.yaml"
    path.write_text("[1e-5, 1.0e-5, 2E3, -1e+2, 0.5, '1e-5', 1e]")
    assert read_yaml(path) == [1e-5, 1e-5, 2000.0, -100.0, 0.5, "1e-5", "1e"]


def test_one_experiment_is_read_without_checking_every_scale(tmp_path, refusal):
    """The form of the whole file is checked, but nothing that is wrong elsewhere once merged."""
    path = tmp_path / "config.yaml"
    broken = '  broken: {cooling_inertia: {sweep: {spin.inertia: ["2"]}}}'
    text = CONFIG.read_text().replace("\nscales:\n", f"\nscales:\n{broken}\n")
    path.write_text(text)
    message = "at scale broken.effects.spin.inertia = 2.0: must be a number in [1e-06, "
    assert message in refusal(config.load, path)
    found = config.load_experiment(path, "cooling", "small")
    assert found == config.experiment(config.load(CONFIG), "cooling", "small")
    assert message in refusal(config.load_experiment, path, "cooling_inertia", "broken")
    path.write_text(text.replace("particles: 160", "particles: few", 1))
    assert "particles = 'few'" in refusal(config.load_experiment, path, "cooling", "small")


def test_no_experiment_is_called_as_a_rule_or_a_product(paper):
    """Of a name that stands for something else `snakemake NAME` would make that."""
    files = [ROOT / "Snakefile", *(ROOT / "rules").glob("*.smk")]
    text = "".join(file.read_text() for file in files)
    names = {
        *re.findall(r"^ *rule (\w+):", text, re.M),
        *accuracy.DATASETS,
        *accuracy.FIGURES,
        "point",
    }
    names |= {*catalogue.DOCUMENTS, *re.findall(r"results/\{(?:scale|SCALE)\}/([a-z]\w*)", text)}
    products = re.findall(r"product=\"(.*)\"", text)
    names |= {one for some in products for one in some.split("|")} - {"R"}
    names |= catalogue.FIGURES.keys() - paper["experiments"].keys()
    assert len(names) > 50 and names - {*schema.RESERVED} == set()


def test_experiments_alone_are_a_configuration(tmp_path, paper, refusal, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where there are no studies
    path = tmp_path / "mine.yaml"
    own = config.experiment(paper, "cooling", "small")
    path.write_text(json.dumps({"experiments": {"mine": own}}))
    whole = config.load(path)
    assert config.experiment(whole, "mine", "paper") == own and config.usual_scale(path) == "paper"
    assert "scale = 'small': must be one of paper" in refusal(config.load, path, {"scale": "small"})
    settings = config.as_text(config.study(whole, "models", "paper"))
    run = partial(run_task, "models", "theory", settings=settings, output=path)
    assert refusal(run) == "experiment = cooling: must be one of mine"


def test_the_effective_configuration_stands_in_place_of_the_whole(tmp_path, paper, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_effective(paper, "small", "config.yaml")
    found = config.load("config.yaml")
    for name in paper["experiments"]:
        assert config.experiment(found, name, "small") == config.experiment(paper, name, "small")
    assert config.accuracy(found, "small") == config.accuracy(paper, "small")
    tiny = {"r": 0.9, "beta": 0, "schedule": {"replicas": 2, "plateau": 10}, "progress": False}
    here = simulate("cooling", **tiny, config="config.yaml")
    there = simulate("cooling", **tiny, config=CONFIG, scale="small")
    assert here.R == there.R and here.scale == "small"
    assert main(["experiments"]) == 0


def test_a_scale_without_a_name_is_refused_in_a_line_that_lists_the_names():
    """An unset variable in `--config scale=$SCALE` removes the key."""
    given = {key: value for key, value in read_yaml(CONFIG).items() if key != "scale"}
    with pytest.raises(InputError, match=r"scale = .*: must be .*small"):
        schema.check_file(given, "config.yaml")
