"""R of dilute disks driven by white noise beside the data of Megias & Santos (2022)."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from roughgas.plotting import (
    ENERGY_RATIO,
    GREY,
    LOOKS,
    SPIN_SHARE,
    add_title,
    draw_theory,
    keys_of_steadiness,
    series,
)
from roughgas.plotting import Panel as Drawn

from .published import published

SIZE = (4.6, 6.0)  # inches
NAMES = {"DSMC": "s", "EDMD": "x"}
"""The published methods, and their markers."""


def draw(gas: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset: R, and R minus published R by DSMC."""
    figure = Figure(figsize=SIZE, layout="constrained")
    above, beneath = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    drawn = []
    places = [(r, beta) for r in gas.r.values[::-1] for beta in gas.beta.values[::-1]]
    for (r, beta), look in zip(places, LOOKS, strict=False):
        label = rf"$r = {r:g}$, $\beta = {beta:g}$"
        one = series(gas, label, look, r=r, beta=beta)
        reference, error = (part.sel(r=r, beta=beta).values for part in published("DSMC", gas.R))
        above.plot(one.at, one.data.R_corrected, look.marker, color=look.colour, ms=4)
        above.plot(one.at, reference, "s", mfc="none", color=GREY, ms=7, mew=0.8)
        away = one.data.R_corrected.values - reference
        both = np.hypot(one.data.R_stderr.values, error)
        how = {"color": look.colour, "ms": 4, "elinewidth": 0.9}
        beneath.errorbar(one.at, 1e3 * away, 1e3 * both, fmt=look.marker, **how)
        events = published("EDMD", gas.R)[0].sel(r=r, beta=beta).values - reference
        beneath.plot(one.at, 1e3 * events, "x", color=look.colour, ms=5)
        drawn.append(one)
    draw_theory(Drawn(above, [beneath], SPIN_SHARE), drawn)
    above.set(ylabel=ENERGY_RATIO, ylim=(-0.02, 1.02))
    above.legend(handles=_keys(drawn), loc="lower right")
    beneath.axhline(0.0, color=GREY, linewidth=0.8, zorder=0)
    beneath.set_ylabel("$R$ minus published $R$\n" r"(DSMC), in $10^{-3}$")
    SPIN_SHARE.prepare(beneath)
    message = "R beside another group's simulations"
    add_title(above, [gas], "Dilute disks driven by white noise", message)
    figure.align_ylabels()
    return figure


def _keys(drawn):
    """Return what colours and symbols are."""
    how = [(one.look.colour, one.look.marker, one.label) for one in drawn]
    keys = [Line2D([], [], ls="none", marker=m, color=c, label=label) for c, m, label in how]
    published_as = {"s": "published, DSMC", "x": "published, events (below)"}
    for marker, label in published_as.items():
        keys.append(Line2D([], [], ls="none", marker=marker, mfc="none", color=GREY, label=label))
    keys.append(Line2D([], [], color=GREY, label="rate equations, Maxwellian"))
    return keys + keys_of_steadiness(drawn)
