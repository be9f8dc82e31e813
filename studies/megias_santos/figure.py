"""Dilute disks driven by white noise: R and cumulants beside data of Megias & Santos (2022)."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from roughgas.plotting import (
    ENERGY_RATIO,
    GREY,
    LOOKS,
    NOT_TRUSTED,
    SPIN_SHARE,
    THEORY,
    add_title,
    draw_theory,
    key,
    key_of_trust,
    keys_of_steadiness,
    series,
    trusted,
)
from roughgas.plotting import Panel as Drawn
from roughgas.theory import sonine_state, stationary_ratio

from .published import CUMULANTS, beside_published, published

SIZE = (8.4, 6.6)  # inches
ROWS = [["R", "a20"], ["R", "a11"], ["gap", "a02"]]
METHODS = {"DSMC": ("s", "published, DSMC"), "EDMD": ("x", "published, events")}
"""The published methods: their markers, and what the legend calls them."""
TIMES = 1e3
"""Small differences are drawn in thousandths."""


def draw(gas: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset: R, R minus published R by DSMC, and cumulants."""
    figure = Figure(figsize=SIZE, layout="constrained")
    axes = figure.subplot_mosaic(ROWS, sharex=True)
    drawn = []
    places = [{"r": r, "beta": beta} for r in gas.r[::-1].values for beta in gas.beta[::-1].values]
    for place, look in zip(places, LOOKS, strict=False):
        label = rf"$r = {place['r']:g}$, $\beta = {place['beta']:g}$"
        drawn.append(series(gas, label, look, **place))
        _ratio(axes["R"], axes["gap"], gas, place, drawn[-1])
        _cumulants(axes, gas, place, look)
    draw_theory(Drawn(axes["R"], [axes["gap"]], SPIN_SHARE), drawn)
    axes["R"].set(ylabel=ENERGY_RATIO, ylim=(-0.02, 1.02))
    axes["R"].legend(handles=_keys(drawn, gas), loc="lower right", fontsize=7)
    axes["gap"].set_ylabel("$R$ minus published $R$\n" r"(DSMC), in $10^{-3}$")
    for name, one in axes.items():
        SPIN_SHARE.prepare(one)
        if name not in ROWS[-1]:
            one.set_xlabel("")
        if name != "R":
            one.axhline(0.0, color=GREY, linewidth=0.8, zorder=0)
    for name in CUMULANTS:
        axes[name].set_ylabel(rf"$a_{{{name[1:]}}}$")
    _keys_of_gap(axes["gap"])
    message = "R and cumulants beside another group's simulations"
    add_title(axes["R"], [gas], "Dilute disks driven by white noise", message)
    figure.align_ylabels()
    return figure


def _ratio(above, beneath, gas, place, one) -> None:
    """Draw R, and beneath what it and theories differ from the published R by."""
    look, shares = one.look, gas.spin_share
    reference, events = (published(method, gas.R)[0].sel(place) for method in METHODS)
    above.plot(one.at, one.data.R_corrected, look.marker, color=look.colour, ms=4)
    above.plot(shares, reference, "s", mfc="none", color=GREY, ms=7, mew=0.8)
    gap, error = (TIMES * part.sel(place) for part in beside_published(gas))
    beneath.errorbar(shares, gap, error, fmt=look.marker, color=look.colour, ms=4, lw=0.9)
    beneath.plot(shares, TIMES * (events - reference), "x", color=look.colour, ms=5)
    given = place["r"], place["beta"], 2, None, shares.values
    for R, line in ((stationary_ratio(*given), ":"), (sonine_state(*given).R, "-")):
        beneath.plot(shares, TIMES * (R - reference), line, color=look.colour, lw=0.8)


def _cumulants(axes, gas, place, look) -> None:
    """Draw the cumulants, ours, paler where their errors are not trusted, theirs, and theory's."""
    shares, close = gas.spin_share, np.linspace(0.0, 1.0, 201)
    theory = sonine_state(place["r"], place["beta"], spin_share=close)
    for name in CUMULANTS:
        one, about = axes[name], {"color": look.colour, "ms": 4}
        row = gas.sel(place)
        for shown, style in _by_trust(row, name):
            bars = shown[f"{name}_stderr"]
            more = about | {"fmt": look.marker, "lw": 0.9} | style
            one.errorbar(shown.spin_share, shown[name], bars, **more)
        for method, (marker, _) in METHODS.items():
            values = published(method, gas.R, name)[0].sel(place)
            size, colour = (7, GREY) if marker == "s" else (5, look.colour)
            one.plot(shares, values, marker, mfc="none", color=colour, ms=size, mew=0.8)
        one.plot(close, getattr(theory, name), "-", color=look.colour, lw=0.8, zorder=1)


def _by_trust(row, name):
    """Return the points whose error is trusted and those whose is not, and how they are drawn."""
    sure = trusted(row, name).values
    return (row.isel(spin_share=sure), {}), (row.isel(spin_share=~sure), NOT_TRUSTED)


def _keys(drawn, gas):
    """Return what colours and symbols are."""
    keys = [key(one.look.colour, one.label, one.look.marker) for one in drawn]
    keys += [key(GREY, label, marker, mfc="none") for marker, label in METHODS.values()]
    keys.append(key(GREY, "theory: see below", "", "-"))
    if not all(trusted(gas, name).all() for name in CUMULANTS):
        keys.append(key_of_trust())
    return keys + keys_of_steadiness(drawn)


def _keys_of_gap(axes) -> None:
    """Say what lines are; those of cumulants are of the same theory."""
    lines = {":": "rate equations, Maxwellian", "-": "Sonine approximation, also right"}
    keys = [key(THEORY, label, "", line, lw=0.8) for line, label in lines.items()]
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.3 * (high - low))
    axes.legend(handles=keys, loc="upper right", fontsize=7)
