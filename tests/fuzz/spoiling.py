"""Strategies that spoil what is right: values of a configuration, and the text of one."""

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
OTHERS = [None, True, False, [], {}, [None], [1], ["0.9"], [True], [[[]]], {"a": 1}]
VALUES = st.sampled_from([*NUMBERS, *WORDS, *OTHERS])
SIGNS = "[ ] { } ' \" ~ \t \n \0 \x85 \u2028 é |\n".split(" ")
SCALARS = ["0x_", "0b_", "1:30:00", "2001-02-30", "9" * 5000, "null", ".nan", "<<: "]
STRUCTURE = ["!!bool ", "!!int ", "&a ", "*a", "? ", ": ", "- ", "# ", "[" * 500, "---\n", "...\n"]
PIECES = st.sampled_from([*SIGNS, *SCALARS, *STRUCTURE, "%YAML 1.1\n---\n"])

TRIES = os.environ.get("FUZZ_TRIES")
QUICK, LONG = (
    settings(
        max_examples=number,
        deadline=None,
        derandomize=TRIES is None,
        database=None,
        suppress_health_check=list(HealthCheck),
    )
    for number in (30, int(TRIES or 2000))
)
"""How often `make test` tries, and the extras: the same examples unless FUZZ_TRIES is set."""
OFTEN = pytest.mark.parametrize("often", [QUICK, pytest.param(LONG, marks=pytest.mark.slow)])
ENOUGH = 0.2
"""Least share of examples that are taken: what refuses everything is no program."""


def outcomes(often, spoiled, attempt, legal=None):
    """Count what came of the examples that `attempt` was given, every second one a `legal` one."""
    found = Counter()

    @often
    @given(spoiled, spoiled if legal is None else legal)
    def see(one, other):
        found[attempt(other if found.total() % 2 else one)] += 1

    see()
    return found


def share(found, outcome):
    return found[outcome] / found.total()


def places(tree, path=()):
    """Yield the path of every value below the root."""
    entries = tree.items() if isinstance(tree, dict) else enumerate(tree)
    for key, value in entries:
        yield (*path, key)
        if isinstance(value, dict | list):
            yield from places(value, (*path, key))


@st.composite
def spoiled_trees(draw, tree):
    """A copy of a tree of dictionaries and lists, with one to three values changed, taken away or
    added."""
    tree = copy.deepcopy(tree)
    for _ in range(draw(st.integers(1, 3))):
        *parents, last = draw(st.sampled_from(list(places(tree))))
        inner = tree
        for key in parents:
            inner = inner[key]
        what = draw(st.sampled_from(["change", "change", "take away", "add"]))
        if what == "take away":
            del inner[last]
        elif what == "change":
            inner[last] = copy.deepcopy(draw(VALUES))  # which may be changed in its turn
        elif isinstance(inner, dict):
            inner[draw(st.sampled_from(["x", "spin", "friction", "r", "", "a b"]))] = copy.deepcopy(
                draw(VALUES)
            )
        else:
            inner.append(copy.deepcopy(draw(VALUES)))
    return tree


@st.composite
def legal_trees(draw, tree):
    """A configuration of which an experiment has other words and numbers, as legal as before."""
    tree = copy.deepcopy(tree)
    chosen = tree["experiments"][draw(st.sampled_from(sorted(tree["experiments"])))]
    chosen["description"] = draw(st.sampled_from(WORDS))
    if "particles" in chosen:
        chosen["particles"] = draw(st.integers(2, 200))
    return tree


@st.composite
def spoiled_texts(draw, text):
    """A text with one to three pieces put in, or stretches taken out."""
    for _ in range(draw(st.integers(1, 3))):
        at = draw(st.integers(0, len(text)))
        end = at + draw(st.sampled_from([0, 0, 0, 1, 5, 40]))
        text = text[:at] + draw(PIECES) + text[end:]
    return text
