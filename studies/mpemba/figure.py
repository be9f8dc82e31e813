"""Temperatures of gases that cool by the same drive, over time: which of two is the first."""

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from roughgas.plotting import GREY, LOOKS, add_title

from .curves import Curve, Pair, expected, pairs, simulated

SIZE = (7.2, 7.8)  # inches
TIME = r"time, $\nu_\mathrm{st}\, t/2$"
TITLES = {"crossing": "The hotter one cools first", "overshoot": "The colder one overshoots"}
MESSAGE = "How energy was shared decides which gas cools first"
LAST = 2
"""The stage in which a gas remembers."""
SPAN = 5.0  # of time that it is shown
BEFORE = 0.12  # of what is shown, before time 0


def draw(*gases: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets: pairs of gases, and one that remembers."""
    *paired, memory = gases
    figure = Figure(figsize=SIZE, layout="constrained")
    panels = figure.subplots(3, 2)
    for axes, one in zip(panels[:2].T.flat, pairs(paired), strict=True):
        _draw_pair(axes, one)
    curve = simulated(memory, LAST)
    _draw_curves(panels[2, 0], curve, expected(memory, curve, LAST), LOOKS[2].colour)
    _finish(panels[2, 0], "Spins remember their drive", SPAN)
    panels[2, 1].axis("off")
    panels[2, 1].legend(handles=_keys(), loc="center")
    add_title(panels[0, 0], paired, "Gases that cool by the same drive")
    figure.suptitle(MESSAGE, fontsize=8.5, fontweight="bold")
    return figure


def _draw_pair(axes: Axes, one: Pair) -> None:
    for name, look in zip(one.simulated, LOOKS, strict=False):
        _draw_curves(axes, one.simulated[name], one.expected[name], look.colour)
        known = one.published[name]
        few = slice(None, None, len(known.time) // 20)
        axes.plot(known.time[few], known.T[few], "o", mfc="none", color=look.colour, ms=3, mew=0.7)
    at = one.crossing(one.simulated)
    axes.axvspan(at.time - at.stderr, at.time + at.stderr, color=GREY, alpha=0.3, lw=0)
    material = rf"$r = {one.place['r']:g}$, $\beta = {one.place['beta']:g}$"
    _finish(axes, f"{TITLES[one.protocol]}\n{material}", one.published["hot"].time[-1])


def _draw_curves(axes: Axes, curve: Curve, rates: Curve, colour: str) -> None:
    """Draw a gas with its band, and the rate equations."""
    low, high = curve.T - curve.stderr, curve.T + curve.stderr
    axes.fill_between(curve.time, low, high, color=colour, alpha=0.25, lw=0)
    axes.plot(curve.time, curve.T, color=colour, lw=1.0)
    axes.plot(rates.time, rates.T, color="black", lw=0.8, ls="--")


def _finish(axes: Axes, text: str, span: float) -> None:
    """Say what a panel shows, and show what is after time 0."""
    axes.text(0.97, 0.95, text, ha="right", va="top", transform=axes.transAxes, fontsize=8)
    axes.axhline(1.0, color=GREY, lw=0.6, zorder=0)
    axes.axvline(0.0, color=GREY, lw=0.6, ls=":", zorder=0)
    shown = (-BEFORE * span, span)
    later = [line.get_ydata()[line.get_xdata() >= 0.0] for line in axes.lines[:-2]]
    low, high = min(map(min, later)), max(map(max, later))
    axes.set(ylabel=r"temperature $T/T_\mathrm{st}$", xlabel=TIME, xlim=shown)
    axes.set_ylim(low - 0.1 * (high - low), high + 0.3 * (high - low))


def _keys():
    """Return what lines and symbols are."""
    return [
        Line2D([], [], color=LOOKS[0].colour, label="hotter"),
        Line2D([], [], color=LOOKS[1].colour, label="colder"),
        Line2D([], [], color=GREY, lw=3, alpha=0.4, label="where ours cross"),
        Line2D([], [], color=LOOKS[0].colour, lw=6, alpha=0.25, label="errors of the energies"),
        Line2D([], [], ls="none", marker="o", mfc="none", color=GREY, ms=3, label="published"),
        Line2D([], [], color="black", lw=0.8, ls="--", label="rate equations"),
    ]
