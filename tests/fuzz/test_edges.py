"""Options, keys of schedules and environments at their edges: a slice of all of them."""

import random
from collections import Counter

import pytest
from tests.fuzz import edges
from tests.fuzz.spoiling import ENOUGH, share

CASES = {kind: [one for one in edges.cases() if one[0] == kind] for kind, *_ in edges.cases()}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return edges.write_folder(tmp_path_factory.mktemp("edges") / "files")


def test_every_command_is_walked(folder, monkeypatch):
    """And what is right for it is taken."""
    assert set(edges.RIGHT) | edges.LEFT_OUT == set(edges.PARSERS)
    for name in set(edges.RIGHT) - edges.SLOW:
        assert edges.check(folder, monkeypatch, [name, *edges.RIGHT[name]]) == "done", name


@pytest.mark.parametrize(
    ("kind", "number"),
    [
        ("option", 60),
        ("schedule", 60),
        ("environment", 4),
        pytest.param("environment", 10**6, marks=pytest.mark.slow),
    ],
)
def test_a_slice_of(folder, monkeypatch, kind, number):
    whole = [one for one in CASES[kind] if one[1] not in edges.SLOW or number > len(CASES[kind])]
    chosen = random.Random(number).sample(whole, min(number, len(whole)))
    found = Counter(edges.attempt(folder, monkeypatch, case) for case in chosen)
    assert share(found, "done") > ENOUGH, found
