"""Temperatures of gases that cool by the same drive, over time: which of two is the first."""

import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from roughgas.plotting import GREY, LOOKS, add_title

from .curves import Curve, crossing, expected, published, simulated

SIZE = (4.6, 8.4)  # inches
SPAN = (-0.6, 5.0)  # of time that is shown
TIME = r"time, $\nu_\mathrm{st}\, t/2$"
PAIRS = {"crossing": "The hotter one cools first", "overshoot": "The colder one overshoots"}
MESSAGE = "How energy was shared decides which gas cools first"


def draw(
    hot: xr.Dataset,
    cold: xr.Dataset,
    overshoot_hot: xr.Dataset,
    overshoot_cold: xr.Dataset,
    memory: xr.Dataset,
) -> Figure:
    """Draw the figure from the reduced datasets."""
    figure = Figure(figsize=SIZE, layout="constrained")
    panels = figure.subplots(3, 1, sharex=True)
    gases = {"crossing": (hot, cold), "overshoot": (overshoot_hot, overshoot_cold)}
    for axes, (protocol, title) in zip(panels, PAIRS.items(), strict=False):
        curves = []
        for name, gas, look in zip(("hot", "cold"), gases[protocol], LOOKS, strict=False):
            curves.append(_curve(axes, gas, 1, look.colour))
            known = published(protocol, name)
            few = slice(0, None, 3)
            axes.plot(
                known.time[few], known.T[few], "o", mfc="none", color=look.colour, ms=3, mew=0.7
            )
        at = crossing(*curves, protocol == "overshoot")
        axes.axvspan(at.time - at.stderr, at.time + at.stderr, color=GREY, alpha=0.3, lw=0)
        _name(axes, title)
    panels[0].legend(handles=_keys(), fontsize="small", loc="right")
    _curve(panels[2], memory, 2, LOOKS[2].colour)
    _name(panels[2], "Spins remember their drive")
    for axes in panels:
        axes.axhline(1.0, color=GREY, lw=0.6, zorder=0)
        axes.axvline(0.0, color=GREY, lw=0.6, ls=":", zorder=0)
        axes.set(ylabel=r"temperature $T/T_\mathrm{st}$", xlim=SPAN)
    panels[2].set_xlabel(TIME)
    panels[1].set_ylim(0.8, 1.3)
    panels[2].set_ylim(0.8, 1.3)
    add_title(panels[0], [hot], "Gases that cool by the same drive", MESSAGE)
    return figure


def _curve(axes, gas, stage, colour) -> Curve:
    """Draw a gas with its band, and the rate equations; return its curve."""
    curve = simulated(gas, stage)
    low, high = curve.T - curve.stderr, curve.T + curve.stderr
    axes.fill_between(curve.time, low, high, color=colour, alpha=0.25, lw=0)
    axes.plot(curve.time, curve.T, color=colour, lw=1.0)
    theory = expected(gas, curve, stage)
    axes.plot(theory.time, theory.T, color="black", lw=0.8, ls="--")
    return curve


def _name(axes, text):
    axes.text(0.98, 0.95, text, ha="right", va="top", transform=axes.transAxes)


def _keys():
    """Return what lines and symbols are."""
    return [
        Line2D([], [], color=LOOKS[0].colour, label="hotter"),
        Line2D([], [], color=LOOKS[1].colour, label="colder"),
        Line2D([], [], color=GREY, lw=3, alpha=0.4, label="where ours cross"),
        Line2D([], [], color=LOOKS[0].colour, lw=6, alpha=0.25, label="errors, at most"),
        Line2D([], [], ls="none", marker="o", mfc="none", color=GREY, ms=3, label="published"),
        Line2D([], [], color="black", lw=0.8, ls="--", label="rate equations"),
    ]
