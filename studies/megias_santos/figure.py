"""Figure of dilute disks driven by white noise: R and cumulants against data of Megias & Santos
(2022)."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from roughgas.plotting import (
    ENERGY_RATIO,
    GREY,
    LINE_STYLES,
    NOT_TRUSTED,
    SPIN_SHARE,
    THEORY,
    TWO_WIDE,
    add_title,
    draw_theory,
    judged_title,
    key,
    key_of_trust,
    keys_of_steadiness,
    series,
    trusted,
)
from roughgas.plotting import Panel as ResidualPanel
from roughgas.theory import sonine_state, stationary_ratio

from .published import CUMULANTS, difference_from_published, published

SIZE = (TWO_WIDE, 6.0)  # inches
ROWS = [["R", "a20"], ["R", "a11"], ["gap", "a02"]]
METHODS = {"DSMC": ("s", "published, DSMC"), "EDMD": ("x", "published, events")}
"""Markers of the published methods, and their labels in the legend."""
THOUSAND = 1e3
"""Factor of small differences, which are drawn in units of 0.001."""


def draw(gas: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset: R, R minus R published by DSMC, and cumulants."""
    figure = Figure(figsize=SIZE, layout="constrained")
    axes = figure.subplot_mosaic(ROWS, sharex=True)
    drawn = []
    points = [{"r": r, "beta": beta} for r in gas.r[::-1].values for beta in gas.beta[::-1].values]
    for point, look in zip(points, LINE_STYLES, strict=False):
        label = rf"$r = {point['r']:g}$, $\beta = {point['beta']:g}$"
        drawn.append(series(gas, label, look, **point))
        _draw_ratio(axes["R"], axes["gap"], gas, point, drawn[-1])
        _draw_cumulants(axes, gas, point, look)
    draw_theory(ResidualPanel(axes["R"], [axes["gap"]], SPIN_SHARE), drawn)
    axes["R"].set(ylabel=ENERGY_RATIO, ylim=(-0.02, 1.02))
    axes["R"].legend(handles=_legend_keys(drawn, gas), loc="lower right", fontsize=7)
    axes["gap"].set_ylabel("$R$ minus published $R$\n" r"(DSMC), in $10^{-3}$")
    for name, panel in axes.items():
        SPIN_SHARE.prepare(panel)
        if name not in ROWS[-1]:
            panel.set_xlabel("")
        if name != "R":
            panel.axhline(0.0, color=GREY, linewidth=0.8, zorder=0)
    for name in CUMULANTS:
        axes[name].set_ylabel(rf"$a_{{{name[1:]}}}$")
    _add_keys_of_lines(axes["gap"])
    drawn = "R and cumulants beside another group's simulations"
    message = judged_title(__file__, "stationary_states_are_published", [gas], drawn)
    add_title(axes["R"], [gas], "Dilute disks driven by white noise", message)
    axes["a20"].set_title(
        "Cumulants of velocities and spins", fontsize=8.5, fontweight="bold", loc="left"
    )
    figure.align_ylabels()
    return figure


def _draw_ratio(above, beneath, gas, point, series) -> None:
    """Draw R, and beneath it the differences of R and of theories from R published by DSMC."""
    look, shares = series.line_style, gas.spin_share
    reference, events = (published(method, gas.R)[0].sel(point) for method in METHODS)
    above.plot(series.x, series.data.R_corrected, look.marker, color=look.colour, ms=4)
    above.plot(shares, reference, "s", mfc="none", color=GREY, ms=7, mew=0.8)
    differences = difference_from_published(gas)[:2]
    gap, error = (THOUSAND * values.sel(point) for values in differences)
    beneath.errorbar(shares, gap, error, fmt=look.marker, color=look.colour, ms=4, lw=0.9)
    beneath.plot(shares, THOUSAND * (events - reference), "x", color=look.colour, ms=5)
    parameters = point["r"], point["beta"], 2, None, shares.values
    for R, line in ((stationary_ratio(*parameters), ":"), (sonine_state(*parameters).R, "-")):
        beneath.plot(shares, THOUSAND * (R - reference), line, color=look.colour, lw=0.8)


def _draw_cumulants(axes, gas, point, look) -> None:
    """Draw the cumulants: ours (paler where their errors are not trusted), published ones, and
    theory."""
    shares, close = gas.spin_share, np.linspace(0.0, 1.0, 201)
    theory = sonine_state(point["r"], point["beta"], spin_share=close)
    for name in CUMULANTS:
        panel, look_style = axes[name], {"color": look.colour, "ms": 4}
        row = gas.sel(point)
        for shown, trust_style in _by_trust(row, name):
            bars = shown[f"{name}_stderr"]
            bar_style = look_style | {"fmt": look.marker, "lw": 0.9} | trust_style
            panel.errorbar(shown.spin_share, shown[name], bars, **bar_style)
        for method, (marker, _) in METHODS.items():
            values = published(method, gas.R, name)[0].sel(point)
            size, colour = (7, GREY) if marker == "s" else (5, look.colour)
            panel.plot(shares, values, marker, mfc="none", color=colour, ms=size, mew=0.8)
        panel.plot(close, getattr(theory, name), "-", color=look.colour, lw=0.8, zorder=1)


def _by_trust(row, name):
    """Return two pairs of points and style: points whose error is trusted, and all others."""
    is_trusted = trusted(row, name).values
    return (row.isel(spin_share=is_trusted), {}), (row.isel(spin_share=~is_trusted), NOT_TRUSTED)


def _legend_keys(drawn, gas):
    """Return the legend's keys of colours and symbols."""
    keys = [key(look.colour, label, look.marker, look.line) for label, look, *_ in drawn]
    keys += [key(GREY, label, marker, mfc="none") for marker, label in METHODS.values()]
    keys.append(key(GREY, "theory: see below", "", "-"))
    if not all(trusted(gas, name).all() for name in CUMULANTS):
        keys.append(key_of_trust())
    return keys + keys_of_steadiness(drawn)


def _add_keys_of_lines(axes) -> None:
    """Add the legend of lines; cumulants have lines of the same theory."""
    lines = {":": "rate equations, Maxwellian", "-": "Sonine approximation, also right"}
    keys = [key(THEORY, label, "", line, lw=0.8) for line, label in lines.items()]
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.3 * (high - low))
    axes.legend(handles=keys, loc="upper right", fontsize=7)
