"""Whether error bars are honest: how far published numbers and ours are apart, in their errors."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from roughgas.results.evidence import TIERS, Row
from roughgas.show.style import GREY, LOOKS

END, BIN = 6.0, 0.5
"""Where the histogram ends, in combined standard errors, and how wide its bars are."""


def draw(rows: Sequence[Row]) -> Figure:
    """Draw the histogram of z, by what published numbers are, beside that of honest errors."""
    figure = Figure(figsize=(6.4, 3.6), layout="constrained")
    axes = figure.subplots()
    edges = np.arange(-END, END + BIN, BIN)
    found = {tier: np.array([row.z for row in rows if row.tier == tier]) for tier in TIERS}
    found = {tier: z[np.isfinite(z)] for tier, z in found.items() if np.isfinite(z).any()}
    labels = [f"{TIERS[tier]}: {z.size}" for tier, z in found.items()]
    inside = [np.clip(z, -END + BIN / 2, END - BIN / 2) for z in found.values()]
    colours = [look.colour for look in LOOKS[: len(inside)]]
    axes.hist(inside, list(edges), stacked=True, color=colours, label=labels, ec="white", lw=0.4)
    at, sizes = np.linspace(-END, END, 400), sum(z.size for z in inside)
    expected = sizes * BIN * np.exp(-(at**2) / 2) / np.sqrt(2 * np.pi)
    axes.plot(at, expected, color=GREY, label="if nothing but chance parted them")
    axes.set(xlabel="$z$: ours minus theirs, in combined standard errors", ylabel="rows")
    axes.set_xlim(-END, END)
    axes.legend(title=f"outermost bars: all with $|z| > {END - BIN:g}$", loc="upper left")
    axes.set_title(f"{sizes} published numbers beside ours", loc="left", fontsize=9)
    return figure
