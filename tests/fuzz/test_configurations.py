"""Whatever a person may write into config.yaml is taken, or refused in one line."""

import json
from pathlib import Path

import pytest
from hypothesis import strategies as st
from tests.fuzz.spoiling import (
    ENOUGH,
    OFTEN,
    legal_trees,
    outcomes,
    share,
    spoiled_texts,
    spoiled_trees,
)

from roughgas import config
from roughgas.base import InputError
from roughgas.config.reading import read_yaml
from roughgas.simulation import schedule

WHOLE = read_yaml(Path(__file__).parents[1] / "experiments.yaml")
KEPT = {"vibrated", "vibrated_rough_walls", "cooling", "heated", "studies"}
BRIEF = WHOLE | {
    "experiments": {name: one for name, one in WHOLE["experiments"].items() if name in KEPT},
    "scales": {
        "paper": {},
        "small": {k: v for k, v in WHOLE["scales"]["small"].items() if k in KEPT},
    },
}
TEXT = """\
scale: paper
experiments:
  gas: &gas
    description: "A gas"
    particles: 20
    box: [20, 20.0]
    effects: {spin: {inertia: 0.5}}
    sweep: {r: ["0.9", '1'], beta: ["-1"], seeds: 2}
    schedule: {kind: cooling, replicas: 3, thermalise: 20, relaxation_times: 16, plateau: 10,
      sample_every: 1}
  other: *gas
scales: {paper: {}}
"""

NUMBERED = st.integers(2, 10**4).map(lambda number: TEXT.replace("s: 20", f"s: {number}"))


def outcome(path):
    """Whether a configuration is taken, all of it: "taken", or "refused" in one line."""
    try:
        found = config.load(path)
        for scale in found["scales"]:
            for name in found["experiments"]:
                chosen = config.experiment(found, name, scale)
                for variant in config.every_variant(name, chosen).values():
                    schedule.check(variant)
    except InputError as error:
        assert "\n" not in str(error)
        return "refused"
    return "taken"


def values_are_spoiled(path, tree):
    path.write_text(json.dumps(tree))
    return outcome(path)


def text_is_spoiled(path, text):
    path.write_text(text, encoding="utf-8")
    try:
        found = read_yaml(path)
    except InputError as error:
        assert "\n" not in str(error)
        return "refused"
    json.dumps(found)  # nothing but dictionaries, lists, text and numbers
    return "taken"


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return tmp_path_factory.mktemp("spoiled") / "config.yaml"


@OFTEN
def test_spoiled_values(path, often):
    found = outcomes(
        often, spoiled_trees(BRIEF), lambda tree: values_are_spoiled(path, tree), legal_trees(BRIEF)
    )
    assert share(found, "taken") > ENOUGH


@OFTEN
def test_spoiled_text(path, often):
    found = outcomes(often, spoiled_texts(TEXT), lambda text: text_is_spoiled(path, text), NUMBERED)
    assert share(found, "taken") > ENOUGH
