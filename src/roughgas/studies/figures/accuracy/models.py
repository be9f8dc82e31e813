"""Model error: R of a cooling gas by four methods against CPU time, and over (r, beta)."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import MultipleLocator

from roughgas.show.style import FAINT, GREY, LOOKS, THEORY, Look

METHODS = {
    "rate_equations": ("rate equations, run longer and longer", LOOKS[2]),
    "dsmc": ("DSMC", LOOKS[1]),
    "event_driven": ("event-driven", LOOKS[0]),
}
CLOSED_FORM = Look(THEORY, "*", "none")
LEAST = 1 / 3  # of the reference's own error, down to which the axis goes
SIDESTEP = 0.01  # in beta, between series at the same beta
ROOM = 0.4  # for the legend beneath, of the range of the data
PACKING_MARKERS = ("X", "P", "d")
BARS = {"linestyle": "none", "elinewidth": 0.9}


def draw(axes: Axes, data: xr.Dataset) -> None:
    """Draw the relative error of R against CPU seconds, log-log, by each method at one (r, beta).

    There is no line through symbols, since no run was made between two lengths.
    """
    axes.set(xscale="log", yscale="log")
    axes.set(xlabel="CPU time of one run / s", ylabel=r"relative error of $R$")
    shown = {"closed_form": ("closed form, Eq. (K)", CLOSED_FORM)} | METHODS
    for method, (label, look) in shown.items():
        x, y, bar = (data[f"{method}_{of}"].values for of in ("seconds", "error", "error_stderr"))
        size = {"markersize": 10} if look is CLOSED_FORM else {}
        colours = {"color": look.colour, "marker": look.marker}
        axes.errorbar(x, y, bar, label=label, zorder=3, **colours, **size, **BARS)
    seconds = data.event_driven_seconds.values
    fit = data.event_driven_prefactor.values * seconds**data.event_driven_slope.values
    axes.plot(seconds, fit, color=LOOKS[0].colour, linewidth=0.8, zorder=1)
    _floors(axes, data)
    title = f"cooling gas, $r = {data.attrs['r']:g}$, $\\beta = {data.attrs['beta']:g}$"
    axes.legend(loc="lower left", title=title)


def _floors(axes, data):
    """Draw what each model tends to, whatever is spent on it, and where the reference ends."""
    across = {"transform": axes.get_yaxis_transform(), "fontsize": 7}
    for name, text, colour, x, side in (
        ("closed_form_error", "Maxwellian velocities", THEORY, 0.985, "right"),
        ("dsmc_floor", "no density, no correlations", LOOKS[1].colour, 0.015, "left"),
    ):
        level = float(data[name])
        axes.axhline(level, color=colour, linewidth=0.7, linestyle=(0, (4, 2)), zorder=0)
        axes.text(x, 1.06 * level, text, color=colour, va="bottom", ha=side, **across)
    own = float(data.R_reference_stderr / data.R_reference)
    axes.axhspan(own * LEAST, own, color=FAINT, alpha=0.25, linewidth=0, zorder=0)
    axes.set_ylim(bottom=own * LEAST)
    below = {"va": "top", "ha": "right", "color": GREY} | across
    axes.text(0.985, 0.9 * own, "error of the reference", **below)


def draw_map(axes: Axes, data: xr.Dataset) -> None:
    """Draw R of the homogeneous gas over Eq. (K), minus 1, against beta, a series for each r.

    Lines are what its cumulants a20 and a11 explain.
    """
    order = np.argsort(-data.map_r.values)
    for place, (row, look) in enumerate(zip(order, LOOKS, strict=False)):
        one = data.isel(map_r=row)
        x, colour = one.map_beta.values, look.colour
        y, bar = 100 * one.map_gap.values, 100 * one.map_gap_stderr.values
        about = {"color": colour, "marker": look.marker, "label": f"$r = {float(one.map_r):g}$"}
        axes.errorbar(x + SIDESTEP * (place - 1.5), y, bar, markersize=3.6, **about, **BARS)
        explained = 100 * one.map_gap_explained.values
        axes.plot(x, explained, color=colour, linestyle=look.line, linewidth=0.8)
        _event_driven(axes, data, float(one.map_r), colour)
    for k, packing in enumerate(data.packing.values):
        axes.plot([], [], PACKING_MARKERS[k], color=GREY, label=f"event-driven, {packing:g} filled")
    axes.plot([], [], color=GREY, linewidth=0.8, label="first order in $a_{20}$ and $a_{11}$")
    axes.axhline(0, color=THEORY, linewidth=0.8, zorder=0)
    axes.set(xlim=(-1.04, 1.04), xlabel=r"tangential restitution $\beta$")
    axes.set_ylabel(r"$R/R_{\mathrm{Eq.\,(K)}} - 1$   (%)")
    axes.xaxis.set_major_locator(MultipleLocator(0.5))
    axes.xaxis.set_minor_locator(MultipleLocator(0.1))
    low, high = axes.get_ylim()
    axes.set_ylim(low - ROOM * (high - low), high)
    axes.legend(loc="lower center", ncols=2, title="homogeneous gas (DSMC), and what explains it")


def _event_driven(axes, data, r, colour):
    """Draw the points at this r, each packing fraction with a symbol of its own."""
    points = data.isel(density_point=np.flatnonzero(data.density_r.values == r))
    large = {"markersize": 7, "markeredgecolor": THEORY, "markeredgewidth": 0.6, "zorder": 4}
    for k in range(points.sizes["packing"] if points.sizes["density_point"] else 0):
        x = points.density_beta.values + 2.5 * SIDESTEP * (k - 0.5)
        y, bar = 100 * points.density_gap.values[:, k], 100 * points.density_gap_stderr.values[:, k]
        axes.errorbar(x, y, bar, color=colour, marker=PACKING_MARKERS[k], **large, **BARS)
