"""Extreme values of options, keys of schedules and environments: random samples of edges.cases."""

import random
from collections import Counter

import pytest
from tests.fuzz import edges
from tests.fuzz.spoiling import LEAST_SHARE, share

CASES = {kind: [case for case in edges.cases() if case[0] == kind] for kind, *_ in edges.cases()}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return edges.write_folder(tmp_path_factory.mktemp("edges") / "files")


def test_every_command_accepts_its_valid_arguments(folder, monkeypatch):
    """All commands are listed as tested or as skipped."""
    assert set(edges.VALID_ARGUMENTS) | edges.SKIPPED_COMMANDS == set(edges.PARSERS)
    for name in set(edges.VALID_ARGUMENTS) - edges.SLOW_COMMANDS:
        assert edges.check(folder, monkeypatch, [name, *edges.VALID_ARGUMENTS[name]]) == "done", (
            name
        )


@pytest.mark.parametrize(
    ("kind", "number"),
    [
        ("option", 60),
        ("schedule", 60),
        pytest.param("environment", 10**6, marks=pytest.mark.slow),
    ],
)
def test_random_cases_are_carried_out_or_refused_in_one_line(folder, monkeypatch, kind, number):
    cases = [
        candidate
        for candidate in CASES[kind]
        if candidate[1] not in edges.SLOW_COMMANDS or number > len(CASES[kind])
    ]
    sample = random.Random(number).sample(cases, min(number, len(cases)))
    counts = Counter(edges.attempt(folder, monkeypatch, case) for case in sample)
    assert share(counts, "done") > LEAST_SHARE, counts
