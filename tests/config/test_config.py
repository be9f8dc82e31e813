"""config.yaml: the experiments that it resolves to."""

import copy
import json
import re
from functools import partial
from pathlib import Path

import pytest
from tests.configurations import EXPERIMENTS as CONFIG
from tests.configurations import checked, raw_configuration, unchecked

from roughgas import config, simulate
from roughgas.base import InputError, labels, merged, sorted_json
from roughgas.base.reading import read_yaml
from roughgas.cli import main
from roughgas.config import WrittenExperiment
from roughgas.config.forms import RESERVED
from roughgas.config.packaged import STUDIES_OF_ACCURACY
from roughgas.config.study_folders import task_settings, write_effective
from roughgas.show import catalogue
from roughgas.tasks.running import run_task

ROOT = Path(__file__).parents[2]


def test_an_experiment_inherits_what_it_does_not_set(paper):
    walls = paper.experiment("vibrated_rough_walls", "paper").raw
    vibrated = paper.experiment("vibrated", "paper").raw
    assert walls["effects"] == vibrated["effects"] | {"walls": {"restitution": 1, "roughness": 1}}
    assert walls["schedule"] == vibrated["schedule"]
    assert walls["sweep"]["r"] == ["0.9"] and walls["sweep"]["beta"][0] == "-1"
    assert "extends" not in walls


def test_a_parent_is_taken_at_the_same_scale(paper):
    walls = paper.experiment("vibrated_smooth_walls", "small").raw
    vibrated = paper.experiment("vibrated", "small").raw
    for key in ("particles", "box", "schedule"):
        assert walls[key] == vibrated[key] != paper.experiment("vibrated", "paper").raw[key]


def test_null_removes_an_effect():
    base = {"effects": {"spin": {"inertia": 0.5}, "walls": {"restitution": 1}}}
    assert merged(base, {"effects": {"walls": None}}) == {"effects": {"spin": {"inertia": 0.5}}}


def test_merging_changes_neither_part(paper):
    before = copy.deepcopy(paper)
    paper.experiment("vibrated_rough_walls", "small").raw["effects"]["spin"] = None
    merged(paper.experiments, {"cooling": {"particles": 2}})
    assert paper == before


def test_settings_of_a_point_survive_the_way_through_text(paper):
    settings = paper.experiment("vibrated", "paper").for_points().raw
    assert "sweep" not in settings
    assert WrittenExperiment.from_text(sorted_json(settings), "--settings").raw == settings


def test_numbers_may_stand_in_a_sweep_without_quotes():
    raw = raw_configuration()
    raw["experiments"]["cooling"]["sweep"]["r"] = [0.9, 1]
    configuration = checked(raw)
    points = set(configuration.experiment("cooling", "paper").points())
    assert ("0.9", "0", "1") in points and ("1", "0", "4") in points


@pytest.mark.parametrize(
    ("written", "label"),
    [
        (("0.9", ".9", "0.90", "9e-1", "+0.9", "00.9", 0.9), "0.9"),
        (("-0.5", "-.5", "-5E-1", -0.5), "-0.5"),
        (("1", "1.", "1.0", 1, 1.0), "1"),
        (("0", "-0", "-0.0", "0e9", 0, -0.0), "0"),
        (("1e-5", "0.00001", 1e-5), "0.00001"),
        (("0.1", "0.10000000000000000001"), "0.1"),
    ],
)
def test_a_number_has_one_label(written, label):
    for text in written:
        (point,) = labels.grid_points(["1"], [text], ["007"])
        assert point == (1.0, float(label), 7, ("1", label, "7"))
        raw = raw_configuration()
        raw["experiments"]["cooling"]["sweep"] |= {"r": [1], "beta": [text], "seeds": 1}
        cooling = unchecked(raw).experiment("cooling", "paper")
        assert list(cooling.points()) == [("1", label, "1")]
        assert cooling.blocks() == []


def test_swept_values_are_written_as_in_paths():
    configuration = config.load(ROOT / "config.yaml")
    assert not configuration.refused
    layers = configuration.experiments, *configuration.scales.values()
    for settings in (experiment for layer in layers for experiment in layer.values()):
        for key, values in settings.get("sweep", {}).items():
            if key not in (config.SEEDS, config.CASE):
                numbers = map(labels.PARSE.get(key, labels.level), values)
                assert list(map(labels.spelling, numbers)) == values


def test_numbers_are_read_as_a_person_means_them(tmp_path):
    path = tmp_path / "c.yaml"
    path.write_text("[1e-5, 1.0e-5, 2E3, -1e+2, 0.5, '1e-5', 1e]")
    assert read_yaml(path) == [1e-5, 1e-5, 2000.0, -100.0, 0.5, "1e-5", "1e"]


def test_one_experiment_is_read_without_checking_every_scale(tmp_path, refusal):
    """The form of the whole file is checked, but no mistake elsewhere that appears once merged."""
    path = tmp_path / "config.yaml"
    configuration = json.loads(CONFIG.read_text())
    configuration["scales"]["broken"] = {"cooling_inertia": {"sweep": {"spin.inertia": ["2"]}}}
    path.write_text(json.dumps(configuration))
    message = "at scale broken.effects.spin.inertia = 2.0: must be a number in [1e-06, "
    assert message in refusal(config.load, path)
    experiment = config.load_experiment(path, "cooling", "small").raw
    assert experiment == config.load(CONFIG).experiment("cooling", "small").raw
    assert message in refusal(config.load_experiment, path, "cooling_inertia", "broken")
    configuration["experiments"]["vibrated"]["particles"] = "few"
    path.write_text(json.dumps(configuration))
    assert "particles = 'few'" in refusal(config.load_experiment, path, "cooling", "small")


def test_no_experiment_is_called_as_a_rule_or_a_product(paper):
    """With the name of another target `snakemake NAME` would make that target."""
    files = [ROOT / "Snakefile", *(ROOT / "rules").glob("*.smk")]
    text = "".join(file.read_text() for file in files)
    names = {
        *re.findall(r"^ *rule (\w+):", text, re.M),
        *STUDIES_OF_ACCURACY,
        "point",
    }
    names |= {*catalogue.DOCUMENTS, *re.findall(r"results/\{(?:scale|SCALE)\}/([a-z]\w*)", text)}
    products = re.findall(r"product=\"(.*)\"", text)
    names |= {name for product in products for name in product.split("|")} - {"R"}
    names |= catalogue.FIGURES.keys() - paper.experiments.keys()
    assert len(names) > 50 and names - {*RESERVED} == set()


def test_experiments_alone_are_a_configuration(tmp_path, paper, refusal, monkeypatch):
    monkeypatch.chdir(tmp_path)  # without studies
    path = tmp_path / "mine.yaml"
    experiment = paper.experiment("cooling", "small").raw
    path.write_text(json.dumps({"experiments": {"mine": experiment}}))
    configuration = config.load(path)
    assert (
        configuration.experiment("mine", "paper").raw == experiment
        and config.default_scale(path) == "paper"
    )
    assert "scale = 'small': must be one of paper" in refusal(config.load, path, {"scale": "small"})
    settings = task_settings(configuration, "accuracy", "paper", "models").text
    folder = configuration.studies["accuracy"].folder
    run = partial(run_task, folder, "theory", module="models", settings=settings, output=path)
    assert refusal(run) == "experiment = cooling: must be one of mine"


def test_the_effective_configuration_replaces_the_complete_one(tmp_path, paper, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_effective(paper, "small", "config.yaml")
    effective = config.load("config.yaml")
    for name in paper.experiments:
        assert effective.experiment(name, "small").raw == paper.experiment(name, "small").raw
    assert effective.accuracy_at("small") == paper.accuracy_at("small")
    tiny = {"r": 0.9, "beta": 0, "schedule": {"replicas": 2, "plateau": 10}, "progress": False}
    by_effective = simulate("cooling", **tiny, config="config.yaml")
    by_scale = simulate("cooling", **tiny, config=CONFIG, scale="small")
    assert by_effective.R == by_scale.R and by_effective.scale == "small"
    assert main(["experiments"]) == 0


def test_a_scale_without_a_name_is_refused_in_a_line_that_lists_the_names():
    """An unset variable in `--config scale=$SCALE` removes the key."""
    without_scale = {key: value for key, value in read_yaml(CONFIG).items() if key != "scale"}
    with pytest.raises(InputError, match=r"scale = .*: must be .*small"):
        checked(without_scale)
