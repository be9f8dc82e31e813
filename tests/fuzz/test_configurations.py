"""Any content of config.yaml is accepted, or refused in one line."""

import json

import pytest
from hypothesis import strategies as st
from raw import protocols
from tests import configurations
from tests.fuzz.spoiling import (
    EACH_EFFORT,
    LEAST_SHARE,
    legal_trees,
    outcomes,
    share,
    spoiled_texts,
    spoiled_trees,
)

from roughgas import config
from roughgas.base import InputError
from roughgas.base.reading import read_yaml

CONFIGURATION = configurations.configuration()
EXPERIMENTS = {"vibrated", "vibrated_rough_walls", "cooling", "heated", "studies"}
BRIEF_CONFIGURATION = CONFIGURATION | {
    "experiments": {
        name: experiment
        for name, experiment in CONFIGURATION["experiments"].items()
        if name in EXPERIMENTS
    },
    "scales": {
        "paper": {},
        "small": {k: v for k, v in CONFIGURATION["scales"]["small"].items() if k in EXPERIMENTS},
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

LEGAL_TEXTS = st.integers(2, 10**4).map(lambda number: TEXT.replace("s: 20", f"s: {number}"))


def outcome(path):
    """Load a configuration and all its experiments: "taken", or "refused" in one line."""
    try:
        configuration = config.load(path)
        for scale in configuration.scales:
            for name in configuration.experiments:
                for variant in configuration.experiment(name, scale).every_variant(name).values():
                    protocols.check_experiment(variant.experiment(name))
    except InputError as error:
        assert "\n" not in str(error)
        return "refused"
    return "taken"


def outcome_of_values(path, tree):
    """The outcome of a configuration with these values."""
    path.write_text(json.dumps(tree))
    return outcome(path)


def outcome_of_text(path, text):
    """The outcome of reading a YAML file with this text."""
    path.write_text(text, encoding="utf-8")
    try:
        content = read_yaml(path)
    except InputError as error:
        assert "\n" not in str(error)
        return "refused"
    json.dumps(content)  # fails on other types than dictionaries, lists, text and numbers
    return "taken"


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return tmp_path_factory.mktemp("spoiled") / "config.yaml"


@EACH_EFFORT
def test_spoiled_values_are_accepted_or_refused_in_one_line(path, effort):
    counts = outcomes(
        effort,
        spoiled_trees(BRIEF_CONFIGURATION),
        lambda tree: outcome_of_values(path, tree),
        legal_trees(BRIEF_CONFIGURATION),
    )
    assert share(counts, "taken") > LEAST_SHARE


@EACH_EFFORT
def test_spoiled_text_is_accepted_or_refused_in_one_line(path, effort):
    counts = outcomes(
        effort, spoiled_texts(TEXT), lambda text: outcome_of_text(path, text), LEGAL_TEXTS
    )
    assert share(counts, "taken") > LEAST_SHARE
