"""Numbers quoted in pages: from made-up data with known answers, and in these pages."""

import json
import math

import pytest
import xarray as xr
from tests import pages
from tests.claims.gases import constant, walls
from tests.study_modules import subject
from tests.synthetic import reduced

from roughgas.claims.numbers import IN_WORDS, WALLS, _beside_theory, filled, numbers, quoted
from roughgas.claims.pages import numbers_of_pages
from roughgas.claims.verdicts import beside_theory
from roughgas.quoting import in_words, mean_of, rounded, with_error
from roughgas.statistics.estimates import Estimate

STUDIES_THAT_QUOTE = sorted(path.parent.name for path in pages.STUDIES.glob("*/quoted.py"))
AT_POINTS = (-0.95, -0.9, -0.8, 0.0, 0.5)


def gas(name, shift=0.0, beta=AT_POINTS, **options):
    data = beside_theory(reduced(name, constant(shift), beta=beta, error=1e-6, **options))
    data["R_collisional"] = data.theory + 0.001
    data["R_collisional_stderr"] = data.R_stderr
    return data


def quoted_of(sheared):
    """Return the quoted numbers of gases that deviate from theory by known shifts."""
    gases = dict(zip(("vibrated", *WALLS), walls(rough=0.1), strict=True))
    gases |= {
        name: gas(name, beta=data.beta.values, r=data.r.values) for name, data in gases.items()
    }
    gases[WALLS[0]] = gases[WALLS[0]].assign(vertical_share=gases[WALLS[0]].R * 0 + 0.55)
    gases[WALLS[0]] = gases[WALLS[0]].assign(E_rot=gases[WALLS[0]].R * 0 + 1.2)
    gases["vibrated"] = gas("vibrated", 0.05, beta=gases["vibrated"].beta.values)
    gases |= {"sheared": sheared, "cooling": gas("cooling")}
    gases["drives.heated"] = gas("heated", -0.003).expand_dims(spin_share=[0.0])
    verdicts = [("holds", False), ("holds", True), ("holds", False), ("fails", False)]
    claims = [{"verdict": verdict, "ours": ours} for verdict, ours in verdicts]
    return numbers(gases, {"claims": claims})


@pytest.fixture(scope="module")
def quoted_numbers():
    return quoted_of(gas("sheared", 0.02))


@pytest.fixture(scope="module")
def last():
    """The numbers of all pages, from the last results."""
    return numbers_of_pages(pages.ROOT)


def test_a_point_that_a_small_scale_lacks_is_a_dash(quoted_numbers):
    fewer = quoted_of(gas("sheared", 0.02, beta=AT_POINTS[2:]))
    missing = {name for name, text in fewer.items() if text == "–" != quoted_numbers[name]}
    assert fewer.keys() == quoted_numbers.keys()
    assert {name.split(".")[1] for name in missing} == {"r9_b95", "r8_b90"} and len(missing) == 6


def test_a_point_that_is_not_known_to_be_steady_is_a_dash(quoted_numbers):
    sheared = gas("sheared", 0.02)
    unsteady = (sheared.r == 0.8) & (sheared.beta == -0.9)
    steady_alone = _beside_theory(sheared.assign(equilibrated=xr.where(unsteady, 0.0, 1.0)))
    texts = quoted_of(steady_alone)
    changed = {name for name, text in texts.items() if text != quoted_numbers[name]}
    assert {texts[name] for name in changed} == {"–"}
    assert changed == {"sheared.r8_b90.time", "sheared.r8_b90.collisions"}


def test_numbers_are_those_of_the_data(quoted_numbers):
    assert quoted_numbers["bed.time.most"] == "0.050"
    assert quoted_numbers["bed.collisions.most"] == "0.001"
    assert quoted_numbers["sheared.time.most"] == "0.020"
    assert quoted_numbers["walls.other"] == "0.050"
    # E_vertical : E_rot : E_horizontal = 1.1 : 1.2 : 0.9
    smooth = {"R_vertical": "0.524", "anisotropy": "1.22", "spin": "1.09"}
    assert {name: quoted_numbers[f"walls.smooth.{name}"] for name in smooth} == smooth
    assert quoted_numbers["sheared.r8_b90.theory"] == "0.0169"


def test_statements_of_the_paper_are_counted_without_ours(quoted_numbers):
    counts = [quoted_numbers[f"claims.{name}"] for name in ("all", "holds", "qualified", "fails")]
    assert counts == ["three", "two", "none", "one"]
    ours = [
        quoted_numbers[f"claims.ours.{name}"] for name in ("all", "holds", "qualified", "fails")
    ]
    assert ours == ["one", "one", "none", "none"]


@pytest.mark.parametrize("page", pages.QUOTING, ids=lambda page: "-".join(page.parts[-2:]))
def test_pages_quote_the_last_results(page, last):
    written = page.read_text(encoding="utf-8")
    assert written == pages.with_numbers(page, last), "python -m tests.pages"


@pytest.mark.parametrize("study", STUDIES_THAT_QUOTE)
def test_a_readme_quotes_all_numbers_of_its_study(study, last):
    page = (pages.STUDIES / study / "README.md").read_text(encoding="utf-8")
    assert quoted(page) == {name for name in last if name.partition(".")[0] == study}


def test_texts_of_numbers_have_a_minus_sign_and_their_errors():
    assert with_error(Estimate(-0.0227, 0.0045), 100.0) == "−2.27(45)"
    assert rounded(-0.126, 2) == "−0.13"
    assert [in_words(count) for count in (0, 2, 20, 21)] == ["none", "two", "twenty", "21"]
    mean = mean_of([Estimate(1.0, 0.3, 5.0), Estimate(3.0, 0.4, math.inf)])
    assert mean == pytest.approx((2.0, 0.25, 5.0 * (0.25 / 0.09) ** 2))


def test_readme_counts_the_statements_as_the_verdicts_do():
    """The last verdicts are of all statements of the paper, and of ours."""
    committed = json.loads((pages.DOCS.parent / "figures" / "numbers.json").read_text())
    words = IN_WORDS.split()
    statements = subject("paper").statements
    ours = sum(statement.ours for statement in statements)
    assert committed["claims.all"] == words[len(statements) - ours]
    assert committed["claims.ours.all"] == words[ours]
    counts = [committed[f"claims.{name}"] for name in ("all", "holds", "qualified", "fails")]
    sentence = (
        "Of {} statements of the paper that are judged, {} hold, {} hold with a qualification, "
    )
    sentence += "{} fails; {} of ours, on averages, hold:"
    readme = " ".join((pages.DOCS.parent / "README.md").read_text(encoding="utf-8").split())
    assert sentence.format(*counts, committed["claims.ours.holds"]) in readme


def test_a_mark_fills_the_number_before_it_and_must_be_known(quoted_numbers):
    committed = json.loads((pages.DOCS.parent / "figures" / "numbers.json").read_text())
    assert committed.keys() == quoted_numbers.keys()
    page = "at most +0.5(2)<!--a.b--> (r = 7(2.1)<!--c-->)"
    assert filled(page, {"a.b": "−1.25(3)", "c": "0.9"}) == "at most −1.25(3) (r = 0.9)"
    with pytest.raises(KeyError):
        filled(page, {"c": "0.9"})
