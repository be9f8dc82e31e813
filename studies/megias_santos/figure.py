"""R of dilute disks driven by white noise beside the data of Megias & Santos (2022)."""

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

from .published import beside_published, published

SIZE = (4.6, 6.0)  # inches
METHODS = {"DSMC": ("s", "published, DSMC"), "EDMD": ("x", "published, events (below)")}
"""The published methods: their markers, and what the legend calls them."""


def draw(gas: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset: R, and R minus published R by DSMC."""
    figure = Figure(figsize=SIZE, layout="constrained")
    above, beneath = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    reference, events = (published(method, gas.R)[0] for method in METHODS)
    gap, error = beside_published(gas)
    drawn, shares = [], gas.spin_share
    places = [{"r": r, "beta": beta} for r in gas.r[::-1].values for beta in gas.beta[::-1].values]
    for place, look in zip(places, LOOKS, strict=False):
        label = rf"$r = {place['r']:g}$, $\beta = {place['beta']:g}$"
        one = series(gas, label, look, **place)
        above.plot(one.at, one.data.R_corrected, look.marker, color=look.colour, ms=4)
        above.plot(shares, reference.sel(place), "s", mfc="none", color=GREY, ms=7, mew=0.8)
        away, half = 1e3 * gap.sel(place), 1e3 * error.sel(place)
        beneath.errorbar(shares, away, half, fmt=look.marker, color=look.colour, ms=4, lw=0.9)
        beneath.plot(shares, 1e3 * (events - reference).sel(place), "x", color=look.colour, ms=5)
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
    for marker, label in METHODS.values():
        keys.append(Line2D([], [], ls="none", marker=marker, mfc="none", color=GREY, label=label))
    keys.append(Line2D([], [], color=GREY, label="rate equations, Maxwellian"))
    return keys + keys_of_steadiness(drawn)
