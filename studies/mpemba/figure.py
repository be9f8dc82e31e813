"""Temperatures over time of gases that cool by the same drive, and their crossings."""

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from roughgas.plotting import GREY, LINE_STYLES, add_title, judged_title

from .curves import Curve, Gases, Pair, course, expected, pairs

SIZE = (7.0, 9.6)  # inches
TIME = r"time, $\nu_\mathrm{st}\, t/2$"
STATEMENTS = {
    "hot": "hotter_cools_first",
    "overshoot_hot": "overshoot",
    "hot_smoother": "hotter_cools_first_where_smoother",
    "overshoot_hot_smoother": "overshoot_where_smoother",
    "hot_smoother_inelastic": "hotter_cools_first_where_smoother_inelastic",
    "overshoot_hot_smoother_inelastic": "overshoot_where_smoother_inelastic",
    "hot_less_inelastic": "hotter_cools_first_where_less_inelastic",
    "overshoot_hot_less_inelastic": "overshoot_where_less_inelastic",
}
"""Statement that titles the panel of a pair where it holds, by the key of the hotter gas."""
PAIR, MEMORY = "Two gases, the same drive", "A gas with its final temperature"
"""Titles where the statements fail."""
MEMORY_STAGE = 2
"""Index of the stage in which a gas remembers its drive."""
SHOWN_TIME = 5.0  # of the gas that remembers
SHOWN_BEFORE, MARGIN = 0.12, 0.02  # time shown before 0 and after the last, over its span


def draw(*gases: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets: pairs of gases, and a gas that remembers its
    drive."""
    *paired, memory = gases
    figure = Figure(figsize=SIZE, layout="constrained")
    curves_of_pairs = pairs(paired)
    panels = figure.subplots(1 + len(curves_of_pairs) // 2, 2)
    gases_of_pairs = zip(paired[::2], paired[1::2], strict=True)
    for axes, two, gases_of_pair in zip(
        panels[:-1].flat, curves_of_pairs, gases_of_pairs, strict=True
    ):
        hotter = gases_of_pair[0].attrs["experiment"].rpartition(".")[2]
        _draw_pair(axes, two, judged_title(__file__, STATEMENTS[hotter], gases_of_pair, PAIR))
    curve = Gases([course(memory)], MEMORY_STAGE).simulated()
    rates = expected(memory, curve.time, MEMORY_STAGE)
    _draw_curves(panels[-1, 0], curve, rates, LINE_STYLES[2].colour)
    message = judged_title(__file__, "spins_are_remembered", [memory], MEMORY)
    _finish(panels[-1, 0], message, SHOWN_TIME)
    panels[-1, 1].axis("off")
    panels[-1, 1].legend(handles=_legend_keys(), loc="center")
    add_title(panels[0, 0], paired, "Gases that cool by the same drive", errors_as="Bands")
    return figure


def _draw_pair(axes: Axes, two: Pair, title: str) -> None:
    rates = two.expected()
    for name, look in zip(two.simulated, LINE_STYLES, strict=False):
        _draw_curves(axes, two.simulated[name], rates[name], look.colour)
        curve = two.published[name]
        every_few = slice(None, None, len(curve.time) // 20)
        axes.plot(
            curve.time[every_few],
            curve.T[every_few],
            "o",
            mfc="none",
            color=look.colour,
            ms=3,
            mew=0.7,
        )
    crossing = two.simulated_crossing()
    axes.axvspan(
        crossing.time - crossing.stderr,
        crossing.time + crossing.stderr,
        color=GREY,
        alpha=0.3,
        lw=0,
    )
    material = rf"$r = {two.material['r']:g}$, $\beta = {two.material['beta']:g}$"
    span = max(curve.time[-1] for curve in two.published.values())
    _finish(axes, f"{title}\n{material}", span)


def _draw_curves(axes: Axes, curve: Curve, rates: Curve, colour: str) -> None:
    """Draw the temperature of a gas with its error band, and the rate equations."""
    low, high = curve.T - curve.stderr, curve.T + curve.stderr
    axes.fill_between(curve.time, low, high, color=colour, alpha=0.25, lw=0)
    axes.plot(curve.time, curve.T, color=colour, lw=1.0)
    axes.plot(rates.time, rates.T, color="black", lw=0.8, ls="--")


def _finish(axes: Axes, text: str, span: float) -> None:
    """Write the text of a panel, and scale its axes to the time after 0."""
    axes.text(0.97, 0.95, text, ha="right", va="top", transform=axes.transAxes, fontsize=8)
    axes.axhline(1.0, color=GREY, lw=0.6, zorder=0)
    axes.axvline(0.0, color=GREY, lw=0.6, ls=":", zorder=0)
    limits = (-SHOWN_BEFORE * span, (1.0 + MARGIN) * span)
    later = [line.get_ydata()[line.get_xdata() >= 0.0] for line in axes.lines[:-2]]
    low, high = min(map(min, later)), max(map(max, later))
    axes.set(ylabel=r"temperature $T/T_\mathrm{st}$", xlabel=TIME, xlim=limits)
    axes.set_ylim(low - 0.1 * (high - low), high + 0.3 * (high - low))


def _legend_keys():
    """Return the legend's keys of lines and symbols."""
    return [
        Line2D([], [], color=LINE_STYLES[0].colour, label="hotter"),
        Line2D([], [], color=LINE_STYLES[1].colour, label="colder"),
        Line2D([], [], color=GREY, lw=3, alpha=0.4, label="where ours cross"),
        Line2D([], [], color=LINE_STYLES[2].colour, label="with a memory"),
        Line2D([], [], color=LINE_STYLES[0].colour, lw=6, alpha=0.25, label="standard error"),
        Line2D([], [], ls="none", marker="o", mfc="none", color=GREY, ms=3, label="published"),
        Line2D([], [], color="black", lw=0.8, ls="--", label="rate equations"),
    ]
