"""Model error: R of a cooling gas by four methods against CPU time, and over (r, beta)."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.container import ErrorbarContainer
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


def draw(axes: Axes, data: xr.Dataset) -> None:
    """Relative error of R against CPU seconds, log-log, for each method at one (r, beta)."""
    axes.set(xscale="log", yscale="log")
    _points(axes, data, "closed_form", "closed form, Eq. (K)", CLOSED_FORM, size=10)
    for method, (label, look) in METHODS.items():
        _points(axes, data, method, label, look)
    seconds = data.event_driven_seconds.values
    fit = data.event_driven_prefactor.values * seconds**data.event_driven_slope.values
    axes.plot(seconds, fit, color=LOOKS[0].colour, linewidth=0.8, zorder=1)
    _floors(axes, data)
    axes.set_xlabel("CPU time of one run / s")
    axes.set_ylabel(r"relative error of $R$")
    axes.legend(loc="lower left", title=_title(data))


def _points(axes, data, method, label, look, size=None) -> ErrorbarContainer:
    """Symbols with bars; no line, since a run between two lengths was not made."""
    return axes.errorbar(
        data[f"{method}_seconds"].values,
        data[f"{method}_error"].values,
        data[f"{method}_error_stderr"].values,
        color=look.colour,
        marker=look.marker,
        markersize=size,
        linestyle="none",
        elinewidth=0.9,
        label=label,
        zorder=3,
    )


def _floors(axes, data):
    """What each model tends to, whatever is spent on it; and where the reference ends."""
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
    axes.text(
        0.985, 0.9 * own, "error of the reference", color=GREY, va="top", ha="right", **across
    )


def _title(data):
    return f"cooling gas, $r = {data.attrs['r']:g}$, $\\beta = {data.attrs['beta']:g}$"


def draw_map(axes: Axes, data: xr.Dataset) -> None:
    """R of the homogeneous gas over Eq. (K), minus 1, against beta, a series for each r.

    Lines are what its cumulants a20 and a11 explain.
    """
    order = np.argsort(-data.map_r.values)
    for place, (row, look) in enumerate(zip(order, LOOKS, strict=False)):
        one = data.isel(map_r=row)
        axes.errorbar(
            one.map_beta.values + SIDESTEP * (place - 1.5),
            100 * one.map_gap.values,
            100 * one.map_gap_stderr.values,
            color=look.colour,
            marker=look.marker,
            markersize=3.6,
            linestyle="none",
            elinewidth=0.9,
            label=f"$r = {float(one.map_r):g}$",
        )
        explained = 100 * one.map_gap_explained.values
        axes.plot(one.map_beta, explained, color=look.colour, linestyle=look.line, linewidth=0.8)
        _event_driven(axes, data, float(one.map_r), look.colour)
    for k, packing in enumerate(data.packing.values):
        axes.plot([], [], PACKING_MARKERS[k], color=GREY, label=f"event-driven, {packing:g} filled")
    axes.plot([], [], color=GREY, linewidth=0.8, label="first order in $a_{20}$ and $a_{11}$")
    axes.axhline(0, color=THEORY, linewidth=0.8, zorder=0)
    axes.set_xlabel(r"tangential restitution $\beta$")
    axes.set_ylabel(r"$R/R_{\mathrm{Eq.\,(K)}} - 1$   (%)")
    axes.set_xlim(-1.04, 1.04)
    axes.xaxis.set_major_locator(MultipleLocator(0.5))
    axes.xaxis.set_minor_locator(MultipleLocator(0.1))
    low, high = axes.get_ylim()
    axes.set_ylim(low - ROOM * (high - low), high)
    axes.legend(loc="lower center", ncols=2, title="homogeneous gas (DSMC), and what explains it")


def _event_driven(axes, data, r, colour):
    """The points at this r, each packing fraction with a symbol of its own."""
    points = data.isel(density_point=np.flatnonzero(data.density_r.values == r))
    for k in range(points.sizes["packing"] if points.sizes["density_point"] else 0):
        axes.errorbar(
            points.density_beta.values + 2.5 * SIDESTEP * (k - 0.5),
            100 * points.density_gap.values[:, k],
            100 * points.density_gap_stderr.values[:, k],
            color=colour,
            marker=PACKING_MARKERS[k],
            markersize=7,
            markeredgecolor=THEORY,
            markeredgewidth=0.6,
            linestyle="none",
            elinewidth=0.9,
            zorder=4,
        )
