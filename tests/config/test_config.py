"""config.yaml: what it resolves to, and how each mistake is named."""

import copy
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from roughgas import config
from roughgas.base.errors import InputError
from roughgas.config import checking
from roughgas.config.reading import read_yaml

CONFIG = Path(__file__).parents[2] / "config.yaml"
NAN, INF = float("nan"), float("inf")
EXPERIMENTS = ", ".join(sorted(read_yaml(CONFIG)["experiments"]))


@pytest.fixture(scope="module")
def paper():
    return config.load(CONFIG)


def refusal(function, *arguments):
    with pytest.raises(InputError) as caught:
        function(*arguments)
    message = str(caught.value)
    assert "\n" not in message
    return message


def changed(whole, path, value):
    """A copy of the configuration with another value at `path`, such as a.b.0"""
    whole = copy.deepcopy(whole)
    *parents, last = (int(key) if key.isdigit() else key for key in path.split("."))
    inner = whole
    for key in parents:
        inner = inner[key]
    if value is KeyError:
        del inner[last]
    else:
        inner[last] = value
    return whole


# ---------------------------------------------------------------- what it resolves to


def test_the_paper_as_data(paper):
    vibrated = config.experiment(paper, "vibrated", "paper")
    assert vibrated["particles"] == 160
    assert vibrated["box"] == [50, "open"]
    assert vibrated["effects"]["floor"] == {
        "amplitude": 5,
        "period": 1,
        "restitution": 1,
        "roughness": -1,
    }
    assert vibrated["schedule"]["equilibrate"] + vibrated["schedule"]["measure"] == 7000
    assert vibrated["sweep"]["r"] == ["0.99", "0.9", "0.8", "0.6"]
    assert len(list(config.sweep(vibrated))) == 4 * 21 * 4
    assert config.experiment(paper, "sheared", "paper")["effects"]["shear"] == {"velocity": 2}
    assert config.experiment(paper, "cooling", "paper")["box"] == [100, 100]


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


@pytest.mark.parametrize("name", ["vibrated", "sheared", "cooling"])
def test_small_has_the_density_of_paper(paper, name):
    def density(scale):
        settings = config.experiment(paper, name, scale)
        area = [1 if side == "open" else side for side in settings["box"]]
        return settings["particles"] / (area[0] * area[1])

    assert density("small") == density("paper")


@pytest.mark.parametrize("name", ["vibrated", "cooling", "vibrated_rough_walls"])
def test_a_target_replaces_lengths_and_seeds(paper, name):
    settings = config.experiment(paper, name, "fine")
    plain = config.experiment(paper, name, "paper")
    assert settings["target_stderr"] == 0.002 and "target_stderr" not in plain
    assert settings["sweep"] == {key: plain["sweep"][key] for key in ("r", "beta")}
    assert set(settings["schedule"]) <= {"kind", "sample_every", "period", "thermalise"}
    assert settings["effects"] == plain["effects"]


def test_a_target_of_what_is_extended_counts_before_own_seeds(paper):
    whole = copy.deepcopy(paper)
    whole["experiments"]["wide"] = {"extends": "cooling", "sweep": {"seeds": 1}}
    checking.check(whole)
    assert config.experiment(whole, "wide", "paper")["sweep"]["seeds"] == 1
    assert "seeds" not in config.experiment(whole, "wide", "fine")["sweep"]


def test_a_study_has_its_settings_and_those_of_the_experiments(paper):
    found = config.study(paper, "statistical", "small")
    assert found["experiments"]["sheared"]["particles"] == 40
    assert set(found["experiments"]) == set(paper["experiments"])
    assert found["study"] != config.study(paper, "statistical", "paper")["study"]
    with pytest.raises(InputError, match="study = 'none': must be one of"):
        config.study(paper, "none", "small")


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


def test_an_override_from_the_command_line():
    assert config.load(CONFIG, {"scale": "small"})["scale"] == "small"


def test_settings_of_a_point_survive_the_way_through_text(paper):
    settings = config.point_settings(config.experiment(paper, "vibrated", "paper"))
    assert "sweep" not in settings
    assert config.from_text(config.as_text(settings), "--settings") == settings


def test_numbers_may_stand_in_a_sweep_without_quotes(paper):
    whole = changed(paper, "experiments.cooling.sweep.r", [0.9, 1])
    checking.check(whole)
    points = set(config.sweep(config.experiment(whole, "cooling", "paper")))
    assert ("0.9", "0", "1") in points and ("1", "0", "4") in points


# ---------------------------------------------------------------- how mistakes are named

MISTAKES = [
    ("experiments.cooling.sweep.r", ["0.9", "1.5"], "sweep.r[1] = '1.5': must lie in [0, 1]"),
    ("experiments.cooling.sweep.r", [NAN], "sweep.r[0] = nan: must lie in [0, 1]"),
    ("experiments.cooling.sweep.r", ["nan"], "sweep.r[0] = 'nan': must lie in [0, 1]"),
    ("experiments.cooling.sweep.beta", ["-1.1"], "sweep.beta[0] = '-1.1': must lie in [-1, 1]"),
    ("experiments.cooling.sweep.beta", ["abc"], "sweep.beta[0] = 'abc': must lie in [-1, 1]"),
    ("experiments.cooling.sweep.beta", ["0.1", "0.10"], "sweep.beta = '0.10': must be given once"),
    ("experiments.cooling.sweep.r", [], "sweep.r = []: must be a list of at least 1"),
    ("experiments.cooling.sweep.seeds", 0, "sweep.seeds = 0: must be a whole number >= 1"),
    ("experiments.cooling.target_stderr", 0, "target_stderr = 0: must be a number in (0, 0.1]"),
    (
        "experiments.cooling.target_stderr",
        0.01,
        "experiments.cooling.sweep.seeds = 4: must not stand beside target_stderr",
    ),
    (
        "scales.fine.cooling.schedule",
        {"plateau": 10},
        "scales.fine.cooling.schedule.plateau = 10: must not stand beside target_stderr",
    ),
    ("experiments.studies", {}, "key of experiments = studies: must be another name"),
    ("experiments.cooling.particles", 0, "particles = 0: must be a whole number in [1, 1"),
    (
        "experiments.cooling.particles",
        "many",
        "particles = 'many': must be a whole number in [1, 1",
    ),
    ("experiments.cooling.particles", 1.5, "particles = 1.5: must be a whole number in [1, 1"),
    ("experiments.cooling.particles", True, "particles = True: must be a whole number in [1, 1"),
    ("experiments.cooling.particles", NAN, "particles = nan: must be a whole number in [1, 1"),
    ("experiments.cooling.box.0", -1, "box[0] = -1: must be a number in (0, 10000"),
    ("experiments.cooling.box.1", INF, "box[1] = inf: must be a number in (0, 10000"),
    ("experiments.cooling.box", [50], "box = [50]: must be a list of 2 to 3 entries"),
    (
        "experiments.cooling.effects.spin.inertia",
        0,
        "effects.spin.inertia = 0: must be a number in [1e-06, ",
    ),
    (
        "experiments.vibrated.effects.floor.roughness",
        "rough",
        "effects.floor.roughness = 'rough': must be a number in [-1, 1] or be particles",
    ),
    (
        "experiments.cooling.effects.gravty",
        {"acceleration": 1},
        "effects: key = 'gravty': must be one of contact_averages, contact_time, floor, ",
    ),
    (
        "experiments.vibrated.effects.floor.height",
        1,
        "effects.floor: key = 'height': must be one of amplitude, period, restitution, roughness",
    ),
    (
        "experiments.vibrated.effects.floor.period",
        KeyError,
        "effects.floor.period = (nothing): must be given",
    ),
    (
        "experiments.vibrated.schedule.measure",
        -1,
        "schedule.measure = -1: must be a number > 0",
    ),
    (
        "experiments.cooling.schedule.measure",
        1,
        "schedule: key = 'measure': must be one of kind, replicas, thermalise, "
        "relaxation_times, plateau, sample_every",
    ),
    (
        "experiments.cooling.schedule.kind",
        "heating",
        "schedule.kind = 'heating': must be one of steady, cooling",
    ),
    ("experiments.cooling.schedule", KeyError, "schedule = (nothing): must be given"),
    ("experiments.cooling.sweep", KeyError, "sweep = (nothing): must be given"),
    ("experiments.cooling", None, "cooling = None: must be a mapping of keys to values"),
    ("experiments.vibrated_smooth_walls.extends", "foo", f"must be one of {EXPERIMENTS}"),
    ("experiments.cooling.extends", "cooling", "that does not itself build on this one"),
    ("experiments.No Name", {}, "must be made of lower-case letters, digits and _, a letter first"),
    (
        "scales.small.foo",
        {},
        "key of scales.small = 'foo': must be one of cooling, cooling_friction, cooling_i",
    ),
    ("scales.small.showcase.frames", 0, "scales.small.showcase.frames = 0: must be a whole number"),
    ("showcase.beta", "2", "showcase.beta = '2': must lie in [-1, 1]"),
    ("showcase.box", [10, "open"], "showcase.box[1] = 'open': must be a number > 0"),
    (
        "showcase.effects.spin",
        None,
        "showcase at scale paper.effects.spin = None: must be a mapping",
    ),
    ("showcase.window", KeyError, "showcase at scale paper.window = (nothing): must be given"),
    ("experiments.showcase", {}, "key of experiments = showcase: must be another name"),
    ("scales.small.cooling.extends", "vibrated", "must not be given here"),
    ("scales.small.cooling.particles", 0, "particles = 0: must be a whole number in [1, 1"),
    ("scale", "large", "config.yaml: scale = 'large': must be one of coarse, fine, paper, small"),
    (
        "n_particles",
        5,
        "config.yaml: key = 'n_particles': must be one of betas_per_job, experiments",
    ),
]


@pytest.mark.parametrize(("path", "value", "message"), MISTAKES)
def test_a_mistake_is_named_in_one_line(paper, path, value, message):
    said = refusal(checking.check, changed(paper, path, value))
    assert said.startswith("config.yaml: ")
    assert message in said
    assert path.split(".")[0] in said


def test_the_first_mistake_in_the_file_is_named(paper):
    whole = changed(paper, "experiments.sheared.particles", 0)
    whole = changed(whole, "experiments.vibrated.particles", "x")
    assert "experiments.vibrated.particles = 'x'" in refusal(checking.check, whole)


def test_a_long_value_is_shortened(paper):
    whole = changed(paper, "experiments.cooling.particles", list(range(1000)))
    assert len(refusal(checking.check, whole)) < 150


def test_unknown_names(paper):
    said = refusal(config.experiment, paper, "foo", "paper")
    assert said == f"experiment = 'foo': must be one of {EXPERIMENTS}"
    said = refusal(config.experiment, paper, "cooling", "foo")
    assert said == "scale = 'foo': must be one of coarse, fine, paper, small"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("scale: paper\nscale: small\n", "c.yaml: line 2 = 'scale': must be given once"),
        ("a: 1\n  b: 2\n", "c.yaml: line 2 = '  b: 2': must be YAML"),
        ("a: [1, 2\n", "c.yaml: line 2 = '': must be YAML"),
        ("- a\n", "c.yaml = ['a']: must hold the keys scale, experiments, scales"),
        ("", "c.yaml = None: must hold the keys scale, experiments, scales"),
        ("a: \0\n", "c.yaml = (not text): must be YAML in UTF-8"),
        ("a: !!python/object:os.system {}\n", "c.yaml: line 1"),
    ],
)
def test_what_is_no_configuration(tmp_path, text, message):
    path = tmp_path / "c.yaml"
    path.write_text(text)
    assert refusal(config.load, path).startswith(message)


def test_numbers_are_read_as_a_person_means_them(tmp_path):
    path = tmp_path / "c.yaml"
    path.write_text("[1e-5, 1.0e-5, 2E3, -1e+2, 0.5, '1e-5', 1e]")
    assert read_yaml(path) == [1e-5, 1e-5, 2000.0, -100.0, 0.5, "1e-5", "1e"]


@pytest.mark.parametrize("text", ["{", "[]", json.dumps({"particles": 3}), '{"particles": NaN}'])
def test_settings_that_are_none(text):
    assert refusal(config.from_text, text, "--settings").startswith("--settings")


@pytest.mark.parametrize(
    ("read", "labels", "message"),
    [
        (
            config.restitution,
            ["1.5", "-0.1", "nan", "inf", "", "x", "0_1", " 0.5", "1e", "١"],
            "restitution r = {}: must lie in [0, 1]",
        ),
        (
            config.roughness,
            ["-1.01", "2", "nan", "--1"],
            "roughness beta = {}: must lie in [-1, 1]",
        ),
        (
            config.seed,
            ["-1", "x", "1.0", "", str(2**63)],
            "seed = {}: must be a whole number in [0, 2^63 - 1]",
        ),
    ],
)
def test_illegal_labels(read, labels, message):
    for label in labels:
        assert refusal(read, label) == message.format(label)


def test_legal_labels():
    labels = {"0": 0, "1": 1, "0.90": 0.9, ".5": 0.5, "1e-3": 0.001, "-0": 0}
    assert {label: config.restitution(label) for label in labels} == labels
    assert config.seed(str(2**63 - 1)) == 2**63 - 1


def test_checking_needs_no_compiler_and_writes_nothing(tmp_path):
    code = f"import sys; from roughgas import config; config.load({str(CONFIG)!r}); "
    code += "sys.exit(bool({'numba', 'xarray', 'netCDF4'} & {*sys.modules}))"
    home = os.environ | {"HOME": str(tmp_path), "XDG_CACHE_HOME": str(tmp_path)}
    assert subprocess.run([sys.executable, "-B", "-c", code], env=home).returncode == 0
    assert not list(tmp_path.iterdir())


def test_one_experiment_is_read_without_checking_every_scale(tmp_path):
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
