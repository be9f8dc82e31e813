"""Whether error bars are honest: how far published numbers and ours are apart, in their errors."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.results.evidence import TIERS, Row
from roughgas.show.style import GREY, LOOKS, TWO_WIDE

END, BIN = 6.0, 0.5
"""End of the histograms, and width of their bars, in z."""
TESTS = "Tests of this program", [tier for tier in TIERS if tier != "theory"]
THEORIES = "How good theories are", ["theory"]


def draw(rows: Sequence[Row]) -> Figure:
    """Draw histograms of z, of what tests the program and of theories, beside that of chance."""
    figure = Figure(figsize=(TWO_WIDE, 3.3), layout="constrained")
    panels = figure.subplots(1, 2)
    for axes, (title, tiers) in zip(panels, (TESTS, THEORIES), strict=True):
        found = {tier: np.array([row.z for row in rows if row.tier == tier]) for tier in tiers}
        _histogram(axes, {tier: z[np.isfinite(z)] for tier, z in found.items()})
        axes.set_title(title, loc="left", fontsize=8.5, fontweight="bold")
    panels[0].set_ylabel("rows")
    label = "$z$ of ours minus theirs: Student's $t$ as a Gaussian $z$ of the same probability"
    figure.supxlabel(label, fontsize=10)
    return figure


def _histogram(axes: Axes, found: dict[str, np.ndarray]) -> None:
    """Draw bars of each tier that has any, one upon the other; the outermost hold all beyond."""
    edges = list(np.arange(-END, END + BIN, BIN))
    there = {tier: z for tier, z in found.items() if z.size}
    inside = [np.clip(z, -END + BIN / 2, END - BIN / 2) for z in there.values()]
    colours = [look.colour for look in LOOKS[: len(inside)]]
    labels = [f"{TIERS[tier]}: {z.size}" for tier, z in there.items()]
    if inside:
        axes.hist(inside, edges, stacked=True, color=colours, label=labels, ec="white", lw=0.4)
    at, number = np.linspace(-END, END, 400), sum(z.size for z in inside)
    chance = number * BIN * np.exp(-(at**2) / 2) / np.sqrt(2 * np.pi)
    axes.plot(at, chance, color=GREY, label="by chance alone")
    axes.set_xlim(-END, END)
    axes.set_ylim(0, 1.45 * max(1.0, axes.get_ylim()[1]))
    axes.legend(loc="upper left")
