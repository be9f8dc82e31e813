"""config.yaml: how each mistake is named."""

import copy
import json
from pathlib import Path

import pytest
from tests.tables import rows

from roughgas import config
from roughgas.config import schema
from roughgas.config.reading import read_yaml

CONFIG = Path(__file__).parents[1] / "experiments.yaml"
EXPERIMENTS = ", ".join(sorted(read_yaml(CONFIG)["experiments"]))


def changed(whole, path, value):
    """A copy of the configuration with another value at `path`, such as a.b.0, of an experiment, or
    such as /scale."""
    whole = copy.deepcopy(whole)
    path = path[1:] if path.startswith("/") else f"experiments.{path}"
    *parents, last = (int(key) if key.isdigit() else key for key in path.split("."))
    inner = whole
    for key in parents:
        inner = inner[key]
    if value == "(absent)":
        del inner[last]
    else:
        inner[last] = value
    return whole


MISTAKES = """
cooling.sweep.r | ['0.9', '1.5'] | sweep.r[1] = '1.5': must lie in [0, 1]
cooling.sweep.r | [.nan] | sweep.r[0] = nan: must lie in [0, 1]
cooling.sweep.beta | ['-1.1'] | sweep.beta[0] = '-1.1': must lie in [-1, 1]
cooling.sweep.beta | ['0.1', '0.10'] | sweep.beta = 0.10: must be given once
cooling.sweep.r | [] | sweep.r = []: must be a list that is not empty
cooling.sweep.seeds | 0 | sweep.seeds = 0: must be a whole number >= 1
cooling.schedule.target_stderr | 0 | schedule.target_stderr = 0: must be a number in (0, 0.1]
crate | {} | key of experiments = crate: must be another name: the work
accuracy | {} | key of experiments = accuracy: must be another name: the work
cooling.particles | 'many' | particles = 'many': must be a whole number in [1, 1
cooling.particles | 1.5 | particles = 1.5: must be a whole number in [1, 1
cooling.particles | true | particles = True: must be a whole number in [1, 1
cooling.particles | .nan | particles = nan: must be a whole number in [1, 1
cooling.box.0 | -1 | box[0] = -1: must be a number in (0, 10000
cooling.box | [50] | box = [50]: must be a list of 2 to 3 entries
cooling.effects.spin.inertia | 0 | effects.spin.inertia = 0: must be a number in [1e-06,
vibrated.effects.floor.roughness | 'rough' | effects.floor.roughness = 'rough': must be a number in
    [-1, 1] or be particles
cooling.effects.gravty | {acceleration: 1} | effects: key = 'gravty': must be one of back_wall,
    bottom_wall, contact_averages,
vibrated.effects.floor.height | 1 | effects.floor: key = 'height': must be one of amplitude,
    half_stroke, period, phase, restitution, roughness, wave
vibrated.effects.floor.period | (absent) | effects.floor.period = (nothing): must be given
vibrated.schedule.measure | -1 | schedule.measure = -1: must be a number in (0, 1000000000]
cooling.schedule.measure | 1 | schedule: key = 'measure': must be one of kind, replicas, thermalise,
    relaxation_times, plateau, sample_every
cooling.schedule.kind | 'heating' | schedule.kind = 'heating': must be one of steady, cooling
cooling.schedule | (absent) | schedule = (nothing): must be given
cooling | null | cooling = None: must be a mapping of keys to values
vibrated_smooth_walls.extends | 'foo' | must be one of cooling,
cooling.extends | 'cooling' | that does not itself build on this one
cooling.extends | 'cooling_spheres' | experiments.cooling_spheres.extends = cooling: must be an
    experiment that does not itself
No Name | {} | must consist of lower-case letters, digits and _, a letter first
/scales.small.foo | {} | key of scales.small = 'foo': must be one of accuracy, cooling,
    cooling_friction
/scales.small.cooling.extends | 'vibrated' | must not be given here
/scale | 'large' | config.yaml: scale = 'large': must be one of paper, small
/n_particles | 5 | config.yaml: key = 'n_particles': must be one of accuracy, betas_per_job,
    complete
"""


@pytest.mark.parametrize(("path", "value", "message"), rows(MISTAKES))
def test_a_mistake_is_named_in_one_line(paper, path, value, message, refusal):
    said = refusal(schema.check, changed(paper, path, value))
    assert said.startswith("config.yaml: ")
    assert message in said
    assert path.removeprefix("/").split(".")[0] in said


def test_the_first_mistake_in_the_file_is_named(paper, refusal):
    whole = changed(paper, "sheared.particles", 0)
    whole = changed(whole, "vibrated.particles", "x")
    assert "experiments.vibrated.particles = 'x'" in refusal(schema.check, whole)


def test_unknown_names(paper, refusal):
    said = refusal(config.experiment, paper, "foo", "paper")
    assert said == f"experiment = 'foo': must be one of {EXPERIMENTS}"
    said = refusal(config.experiment, paper, "cooling", "foo")
    assert said == "scale = 'foo': must be one of paper, small"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("scale: paper\nscale: small\n", "c.yaml: line 2 = 'scale': must be given once"),
        ("a: &x 1\nb: &x 2\n", "c.yaml = (not YAML): must be YAML: found duplicate anchor"),
        ("a: 1\n  b: 2\n", "c.yaml: line 2 = '  b: 2': must be YAML"),
        ("a: [1, 2\n", "c.yaml: line 2 = '': must be YAML"),
        ("- a\n", "c.yaml = ['a']: must hold the key experiments"),
        ("", "c.yaml = None: must hold the key experiments"),
        ("a: \0\n", "c.yaml = (not text): must be YAML in UTF-8"),
        ("a: !!python/object:os.system {}\n", "c.yaml: line 1"),
        ("a: !!bool 3\n", "c.yaml = (not YAML): must be YAML"),
    ],
)
def test_what_is_no_configuration(tmp_path, text, message, refusal):
    path = tmp_path / "c.yaml"
    path.write_text(text)
    assert refusal(config.load, path).startswith(message)


@pytest.mark.parametrize("text", ["{", "[]", json.dumps({"particles": 3}), '{"particles": NaN}'])
def test_settings_that_are_none(text, refusal):
    assert refusal(config.from_text, text, "--settings").startswith("--settings")


@pytest.mark.parametrize(
    ("read", "labels", "legal"),
    [
        (config.restitution, ["1.5", "-0.1", "nan", "", "x", "0_1", " 0.5", "1e", "١"], "[0, 1]"),
        (config.roughness, ["-1.01", "2", "nan", "--1"], "[-1, 1]"),
        (config.seed, ["-1", "x", "1.0", "", str(2**63)], "[0, 2^63 - 1]"),
    ],
)
def test_illegal_labels(read, labels, legal, refusal):
    for label in labels:
        said = refusal(read, label)
        assert f" = {label}: must " in said and said.endswith(f" in {legal}")
