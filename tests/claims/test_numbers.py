"""Numbers that pages quote: from data whose answers are known, and in the page of results."""

import json

import pytest
from tests import pages
from tests.claims.gases import constant, walls
from tests.synthetic import reduced

from roughgas.claims import PAPER
from roughgas.claims.evidence import beside_theory
from roughgas.claims.numbers import IN_WORDS, WALLS, filled, numbers

AT_POINTS = (-0.95, -0.8, 0.0, 0.5)


def gas(name, shift=0.0, beta=AT_POINTS, **others):
    data = beside_theory(reduced(name, constant(shift), beta=beta, error=1e-6, **others))
    data["R_collisional"] = data.theory + 0.001
    data["R_collisional_stderr"] = data.R_stderr
    return data


def quoted_of(sheared):
    """What is quoted of gases that lie off theory by known shifts."""
    gases = dict(zip(("vibrated", *WALLS), walls(rough=0.1), strict=True))
    gases |= {name: gas(name, beta=one.beta.values, r=one.r.values) for name, one in gases.items()}
    gases["vibrated"] = gas("vibrated", 0.05, beta=gases["vibrated"].beta.values)
    gases |= {"sheared": sheared, "cooling": gas("cooling")}
    gases["drives.heated"] = gas("heated", -0.003).expand_dims(spin_share=[0.0])
    verdicts = [("holds", False), ("holds", True), ("holds", False), ("fails", False)]
    claims = [{"verdict": one, "ours": ours} for one, ours in verdicts]
    return numbers(gases, {"claims": claims})


@pytest.fixture(scope="module")
def found():
    return quoted_of(gas("sheared", 0.02))


def test_a_point_that_a_small_scale_lacks_is_a_dash(found):
    fewer = quoted_of(gas("sheared", 0.02, beta=AT_POINTS[1:]))
    missing = {name for name, one in fewer.items() if one == "–" != found[name]}
    assert fewer.keys() == found.keys()
    assert {name.split(".")[1] for name in missing} == {"r9_b95", "r8_b95"} and len(missing) == 6


def test_numbers_are_those_of_the_data(found):
    assert found["bed.time.most"] == "0.050"
    assert found["bed.collisions.most"] == "0.001"
    assert found["sheared.time.most"] == "0.020"
    assert found["walls.other"] == "0.050"
    assert found["sheared.r8_b95.theory"] == "0.0084"


def test_statements_of_the_paper_are_counted_without_ours(found):
    counts = [found[f"claims.{name}"] for name in ("all", "holds", "qualified", "fails")]
    assert counts == ["three", "two", "none", "one"]
    ours = [found[f"claims.ours.{name}"] for name in ("all", "holds", "qualified", "fails")]
    assert ours == ["one", "one", "none", "none"]


def test_the_page_of_results_quotes_the_last_results():
    assert pages.RESULTS.read_text(encoding="utf-8") == pages.quoted(), "python -m tests.pages"


def test_readme_counts_the_statements_as_the_verdicts_do():
    """The last verdicts are of all statements of the paper, and of ours."""
    known = json.loads((pages.DOCS.parent / "figures" / "numbers.json").read_text())
    words = IN_WORDS.split()
    ours = sum(one.ours for one in PAPER.statements)
    assert known["claims.all"] == words[len(PAPER.statements) - ours]
    assert known["claims.ours.all"] == words[ours]
    counts = [known[f"claims.{name}"] for name in ("all", "holds", "qualified", "fails")]
    said = "Of {} statements of the paper that are judged, {} hold, {} hold with a qualification, "
    said += "{} fails; {} of ours, on averages, hold:"
    readme = " ".join((pages.DOCS.parent / "README.md").read_text(encoding="utf-8").split())
    assert said.format(*counts, known["claims.ours.holds"]) in readme


def test_a_mark_fills_the_number_before_it_and_must_be_known(found):
    known = json.loads((pages.DOCS.parent / "figures" / "numbers.json").read_text())
    assert known.keys() == found.keys()
    page = "at most 0.5(2)<!--a.b--> (r = 7<!--c-->)"
    assert filled(page, {"a.b": "1.25(3)", "c": "0.9"}) == "at most 1.25(3) (r = 0.9)"
    with pytest.raises(KeyError):
        filled(page, {"c": "0.9"})
