"""Strategies that spoil the values or the text of a configuration, and counts of their outcomes."""

import copy
import math
import os
from collections import Counter

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

NUMBERS = [0, -1, 1, 2, 0.5, -0.5, 1e-300, 5e-324, 1e300, math.inf, math.nan, 10**18, 2**63, 10**30]
WORDS = ["", " ", "x", "0.9", "open", "particles", "1:30:00", "2001-02-30", "../x", "a\nb"]
WORDS += ["<script>"]
OTHER_VALUES = [None, True, False, [], {}, [None], [1], ["0.9"], [True], [[[]]], {"a": 1}]
VALUES = st.sampled_from([*NUMBERS, *WORDS, *OTHER_VALUES])
SIGNS = "[ ] { } ' \" ~ \t \n \0 \x85 \u2028 é |\n".split(" ")
SCALARS = ["0x_", "0b_", "1:30:00", "2001-02-30", "9" * 5000, "null", ".nan", "<<: "]
STRUCTURE = ["!!bool ", "!!int ", "&a ", "*a", "? ", ": ", "- ", "# ", "[" * 500, "---\n", "...\n"]
YAML_TOKENS = st.sampled_from([*SIGNS, *SCALARS, *STRUCTURE, "%YAML 1.1\n---\n"])

TRIES = os.environ.get("FUZZ_TRIES")
QUICK, THOROUGH = (
    settings(
        max_examples=number,
        deadline=None,
        derandomize=TRIES is None,
        database=None,
        suppress_health_check=list(HealthCheck),
    )
    for number in (15, int(TRIES or 700))
)
"""Efforts of `make test` and of the extras; examples are the same unless FUZZ_TRIES is set."""
EACH_EFFORT = pytest.mark.parametrize(
    "effort", [QUICK, pytest.param(THOROUGH, marks=pytest.mark.slow)]
)
LEAST_SHARE = 0.2
"""Least share of examples that must be accepted: a program that refuses all of them is useless."""


def outcomes(effort, spoiled, attempt, legal=None):
    """Count the outcomes of `attempt` on spoiled examples, in turn with `legal` ones if given."""
    counts = Counter()

    @effort
    @given(spoiled, spoiled if legal is None else legal)
    def try_example(example, legal_example):
        counts[attempt(legal_example if counts.total() % 2 else example)] += 1

    try_example()
    return counts


def share(counts, outcome):
    """The share of an outcome among all examples."""
    return counts[outcome] / counts.total()


def paths_of_values(tree, path=()):
    """Yield the path of every value below the root."""
    entries = tree.items() if isinstance(tree, dict) else enumerate(tree)
    for key, value in entries:
        yield (*path, key)
        if isinstance(value, dict | list):
            yield from paths_of_values(value, (*path, key))


@st.composite
def spoiled_trees(draw, tree):
    """A copy of a tree of dictionaries and lists with one to three values changed, removed or
    added."""
    tree = copy.deepcopy(tree)
    for _ in range(draw(st.integers(1, 3))):
        *parents, last = draw(st.sampled_from(list(paths_of_values(tree))))
        parent = tree
        for key in parents:
            parent = parent[key]
        change = draw(st.sampled_from(["change", "change", "take away", "add"]))
        if change == "take away":
            del parent[last]
        elif change == "change":
            parent[last] = copy.deepcopy(draw(VALUES))  # later changes may reach into it
        elif isinstance(parent, dict):
            parent[draw(st.sampled_from(["x", "spin", "friction", "r", "", "a b"]))] = (
                copy.deepcopy(draw(VALUES))
            )
        else:
            parent.append(copy.deepcopy(draw(VALUES)))
    return tree


@st.composite
def legal_trees(draw, tree):
    """A legal configuration, with another description and number of particles of an experiment."""
    tree = copy.deepcopy(tree)
    experiment = tree["experiments"][draw(st.sampled_from(sorted(tree["experiments"])))]
    experiment["description"] = draw(st.sampled_from(WORDS))
    if "particles" in experiment:
        experiment["particles"] = draw(st.integers(2, 200))
    return tree


@st.composite
def spoiled_texts(draw, text):
    """A text with one to three tokens inserted, or stretches cut out."""
    for _ in range(draw(st.integers(1, 3))):
        begin = draw(st.integers(0, len(text)))
        end = begin + draw(st.sampled_from([0, 0, 0, 1, 5, 40]))
        text = text[:begin] + draw(YAML_TOKENS) + text[end:]
    return text
