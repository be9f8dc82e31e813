"""The histograms of t: what is drawn and what is counted, and the distribution by chance."""

import math

import numpy as np
import pytest
from matplotlib.patches import Rectangle
from tests.show.figures.legibility import faults

from roughgas.results.comparison import Row
from roughgas.show.figures.evidence import BIN, END, NAMED_ROWS, draw, expected_counts
from roughgas.statistics.estimates import Estimate


def rows(source, tier, t, dof=math.inf):
    """Return a row for each t, with these degrees of freedom."""
    return [
        Row(
            "R", "r = 0.9", tier, source, "table", Estimate(1, 0), Estimate(1 + 0.01 * x, 0.01, dof)
        )
        for x in t
    ]


def pairs(study, members):
    return [(study, member) for member in members]


def legends(figure):
    """Return the texts of the legend of each panel."""
    return [[text.get_text() for text in axes.get_legend().get_texts()] for axes in figure.axes]


ROWS = [
    *pairs("exact", rows("A 1900, doi", "exact", np.linspace(-2, 2, 9), 5)),
    ("exact", Row("r", "", "exact", "W 1993", "", Estimate(1, 0), Estimate(1, 1e-12))),
    *pairs("hot", rows("B 2022, doi", "simulation", np.linspace(-1, 2, NAMED_ROWS))),
    *pairs("cold", rows("B 2022, doi", "simulation", np.linspace(-1, 2, NAMED_ROWS + 1))),
    *pairs("cold", rows("C 1998", "simulation", [1.0, math.nan, 99.0])),
    *pairs("exact", rows("D 1999", "theory", [9.0] * 3)),
]


def test_large_sources_and_rows_that_are_not_drawn_are_counted_apart():
    exact, simulations, theories = legends(draw(ROWS))
    assert "1 small source: 9, +0.0" in exact and "not drawn, without chance: 1" in exact
    assert (
        f"B 2022, hot: {NAMED_ROWS}, +0.5" in simulations
        and f"B 2022, cold: {NAMED_ROWS + 1}, +0.5" in simulations
    )
    few = "1 small source: 2, +50.0", "not drawn, without $t$: 1"
    assert {*few} <= {*simulations}
    assert "1 small source: 3, +9.0" in theories
    assert f"by chance alone: {2 * NAMED_ROWS + 3}, 0" in simulations


def _bars(axes):
    """Return the bars of a panel, without the curve by chance."""
    return [patch for patch in axes.patches if isinstance(patch, Rectangle)]


def test_the_outermost_bars_hold_all_beyond():
    heights = [
        sum(bar.get_height() for bar in _bars(axes) if bar.get_x() == END - BIN)
        for axes in draw(ROWS).axes
    ]
    assert heights == [0, 1, 3]


def test_expected_counts_are_those_of_random_values():
    """Of 4000 values for each row; 5 sigma in 24 bars, which fail by chance once in 70 000."""
    dof, draws = np.array([1.0, 3.0, 5.0, 50.0, math.inf]), 4000
    edges = np.arange(-END, END + BIN, BIN)
    expected = expected_counts(dof, edges)
    assert expected.sum() == pytest.approx(len(dof))
    np.testing.assert_allclose(expected, expected[::-1])
    rng = np.random.default_rng(8)
    t = np.array([rng.standard_t(min(n, 1e9), draws) for n in dof])
    counts = np.histogram(np.clip(t, -END, END), edges)[0] / draws
    assert np.all(np.abs(counts - expected) < 5 * np.sqrt(expected / draws))


@pytest.mark.slow  # 5 s
def test_the_figure_is_legible():
    assert faults(lambda: draw(ROWS)) == []
