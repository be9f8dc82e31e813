"""Options, keys of schedules and environments at their edges: a slice of the campaign's walk."""

import pytest
from tests.fuzz import edges
from tests.fuzz.campaign import Campaign
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
        ("option", 100),
        ("schedule", 60),
        ("environment", 4),
        pytest.param("environment", 10**6, marks=pytest.mark.slow),
    ],
)
def test_a_slice_of(folder, monkeypatch, kind, number):
    whole = [one for one in CASES[kind] if one[1] not in edges.SLOW or number > len(CASES[kind])]
    campaign = Campaign(kind, number, number)
    assert campaign.walk(whole, lambda case: edges.attempt(folder, monkeypatch, case))
    assert share(campaign.outcomes, "done") > ENOUGH, campaign.outcomes


def test_a_walk_goes_on_after_a_fault(capsys):
    def attempt(case):
        if case in "bd":
            raise ValueError(f"of {case}")
        return "done"

    assert not Campaign("letters", 9, 1).walk("abcde", attempt)
    said = capsys.readouterr().out
    assert "letters: 5 tried" in said and "3 done" in said and "faults: 2" in said
    assert "of b" in said and "of d" in said
