"""Histograms of Student's t of our numbers minus published ones: a check of error bars."""

import math
from collections import Counter
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.results.comparison import Row
from roughgas.show.style import GREY, LINE_STYLES, TWO_WIDE, Style
from roughgas.statistics.student import t_probability

END, BIN = 6.0, 0.5
"""Largest |t| of the histograms, and width of their bars, in t."""
TITLE = "$t$, ours minus published in combined standard errors; outermost bars hold all beyond"
LEGEND_TITLE = "number of rows, and median of $t$:"
MINUS = "\N{MINUS SIGN}"
NAMED_ROWS = 20
"""Number of rows in a panel from which a source has a colour of its own."""
PANELS = {
    "Exact results": ("exact",),
    "Simulations of other groups": ("simulation", "experiment"),
    "Approximate theories": ("theory",),
}
"""Titles of the panels, and the tiers of the rows in each."""


def draw(rows: Sequence[tuple[str, Row]]) -> Figure:
    """Return a figure of histograms of t, with the distribution by chance for the errors there are.

    `rows` are (study, row) pairs. Rows without chance, such as single contacts, and rows without t
    are counted in the legend of a panel, which also has the median of t of each source.
    """
    figure = Figure(figsize=(TWO_WIDE, 4.2), layout="constrained")
    panels = figure.subplots(1, len(PANELS))
    for axes, (title, tiers) in zip(panels, PANELS.items(), strict=True):
        _panel(axes, [(study, row) for study, row in rows if row.tier in tiers])
        axes.set_title(title, loc="left", fontsize=8.5, fontweight="bold")
    panels[0].set_ylabel("rows")
    figure.suptitle(TITLE, fontsize=9)
    return figure


def _panel(axes: Axes, rows: Sequence[tuple[str, Row]]) -> None:
    """Draw into `axes` stacked bars of t of (study, row) pairs, a colour for each large source."""
    certain = [row for _, row in rows if row.is_without_chance]
    random = [(s, row) for s, row in rows if not row.is_without_chance and math.isfinite(row.t)]
    rows_by_source = _by_source(random)
    edges = np.arange(-END, END + BIN, BIN)
    samples = [
        np.clip([row.t for row in members], -END + BIN / 2, END - BIN / 2)
        for members in rows_by_source.values()
    ]
    colours = [style.colour for style in LINE_STYLES[: len(samples)]]
    medians = [
        round(np.median([row.t for row in members]), 1) for members in rows_by_source.values()
    ]
    labels = [
        f"{name}: {len(members)}, {median or 0.0:+.1f}".replace("-", MINUS)
        for (name, members), median in zip(rows_by_source.items(), medians, strict=True)
    ]
    if samples:
        axes.hist(
            samples, edges.tolist(), stacked=True, color=colours, label=labels, ec="white", lw=0.3
        )
        chance = expected_counts(np.array([row.gap.dof for _, row in random]), edges)
        axes.stairs(chance, edges, color=GREY, label=f"by chance alone: {len(random)}, 0", lw=1.2)
    not_drawn = {
        "without chance": len(certain),
        "without $t$": len(rows) - len(random) - len(certain),
    }
    for name, number in not_drawn.items():
        if number:
            axes.plot([], [], " ", label=f"not drawn, {name}: {number}")
    axes.set_xlim(-END, END)
    axes.set_xlabel("$t$")
    position: Style = {"loc": "upper left", "bbox_to_anchor": (-0.05, -0.16), "borderpad": 0}
    position |= {"handlelength": 1.0, "handletextpad": 0.5}
    axes.legend(title=LEGEND_TITLE, title_fontsize=7, fontsize=7, alignment="left", **position)


def _by_source(rows: Sequence[tuple[str, Row]]) -> dict[str, list[Row]]:
    """Return rows by the names of their sources, the largest first; small sources are together.

    `rows` are (study, row) pairs. A source with NAMED_ROWS rows is named, as long as
    colours suffice.
    """
    studies: dict[str, set[str]] = {}
    for study, row in rows:
        studies.setdefault(row.source, set()).add(study)
    names = [_name(study, row, len(studies[row.source]) > 1) for study, row in rows]
    largest = Counter(names).most_common(len(LINE_STYLES) - 1)
    rows_by_source: dict[str, list[Row]] = {name: [] for name, n in largest if n >= NAMED_ROWS}
    few = len({*names} - {*rows_by_source})
    rest = f"{few} small {'source' if few == 1 else 'sources'}"
    for name, (_, row) in zip(names, rows, strict=True):
        rows_by_source.setdefault(name if name in rows_by_source else rest, []).append(row)
    return rows_by_source


def _name(study: str, row: Row, with_study: bool) -> str:
    """Return authors and year of the source of a row, and on demand the study that compares it."""
    name = row.source.split(",")[0].split(";")[0]
    return f"{name}, {study}" if with_study else name


def expected_counts(dof: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Return the expected numbers of values of t between `edges`, (bins,), by chance alone.

    `dof` are the degrees of freedom of each value, (values,). The outermost bins hold all beyond.
    """
    two_sided = t_probability(edges[1:-1], dof[:, np.newaxis])
    above = np.where(edges[1:-1] > 0, two_sided / 2, 1 - two_sided / 2).sum(0)
    return -np.diff([len(dof), *above, 0.0])
