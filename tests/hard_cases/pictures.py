"""Pictures of the hard cases: an overview of all margins, and pictures of some families."""

import math
from collections.abc import Callable, Mapping

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from hard_cases.catalogue import Margin
from roughgas.show.style import FAINT, GREY, LINE_STYLES, PARAMETERS, THEORY, TWO_WIDE
from roughgas.theory import cooling_ratio

Series = Mapping[str, Mapping[str, list[float]]]

FARTHEST = 1e5  # end of the axis of factors; numbers beyond it, and exact ones, are only counted
ROW = 0.24  # inches

matplotlib.rcParams.update(PARAMETERS)


def room(row: Margin) -> float:
    """Return the room of a margin: limit over number or its inverse, at least 1; inf if exact."""
    numerator, denominator = row.limit, row.measured
    if row.sense == "at least":
        numerator, denominator = denominator, numerator
    return numerator / denominator if denominator not in (0.0, numerator) else math.inf


def overview(margins: list[Margin]) -> Figure:
    """Draw a line per family, with a symbol at the room of each of its margins."""
    factors: dict[str, list[float]] = {}
    for row in margins:
        factors.setdefault(row.family, []).append(room(row))
    figure = Figure(figsize=(TWO_WIDE, ROW * len(factors) + 1.0), layout="constrained")
    axes = figure.subplots()
    for height, family_factors in enumerate(map(np.array, factors.values())):
        shown, beyond_axis = (
            family_factors[family_factors < FARTHEST],
            int(np.sum(family_factors >= FARTHEST)),
        )
        axes.plot(
            shown, np.full(shown.size, height), "o", color=LINE_STYLES[0].colour, ms=4, alpha=0.6
        )
        label_style = {
            "xytext": (4, 0),
            "textcoords": "offset points",
            "va": "center",
            "fontsize": 8,
        }
        axes.annotate(str(beyond_axis), (FARTHEST, height), **label_style)
    axes.set_xscale("log")
    axes.set(xlim=(0.7, FARTHEST), ylim=(len(factors) - 0.4, -0.6))
    axes.set_yticks(range(len(factors)), factors, fontsize=8)
    axes.tick_params(axis="y", which="both", left=False, right=False)
    axes.grid(axis="x", color=FAINT, linewidth=0.3)
    axes.axvline(1.0, color=THEORY)
    axes.set_xlabel(
        "margin: limit over measured number, or its inverse; 1: at the limit", fontsize=9
    )
    note = "a symbol: a measured number; right: how many lie beyond the axis, or are exact"
    axes.set_title(note, fontsize=8, color=GREY, loc="right", pad=5)
    return figure


def collapse(series: Series) -> Figure:
    """Draw the chain in which a bed collapses, and R with the contact-time model."""
    figure, (bed, model) = _pair(1.15, 1.0)
    _chain(bed, series["collapse_chain"])
    _contact_times(model, series["contact_time"])
    return figure


def chaos(series: Series) -> Figure:
    """Draw the growth of roundings: against exact arithmetic, and in reversed gases."""
    figure, (separation, return_error) = _pair(1.0, 1.0)
    _separation(separation, series["separation, gas"])
    _return_errors(return_error, series["time_reversal"])
    return figure


def cooling(series: Series) -> Figure:
    """Draw the energy and R of gases that cool by hundreds of orders of magnitude."""
    figure, (energy, ratio) = _pair(1.0, 1.0)
    columns = {name: np.array(numbers) for name, numbers in series["cooling_far"].items()}
    restitutions = [name.split()[1] for name in columns if name.startswith("R ")]
    for r, look in zip(restitutions, LINE_STYLES, strict=False):
        style = {"color": look.colour, "linestyle": look.line, "label": f"$r = {r}$"}
        energy.plot(columns["collisions"], columns[f"log10_energy {r}"], **style)
        ratio.plot(columns["collisions"], columns[f"R {r}"], **style)
    energy.axhline(-308, color=FAINT, lw=0.8, linestyle=(0, (1, 2)))
    at_rim = energy.get_yaxis_transform()
    energy.text(0.98, -262, "smallest double", transform=at_rim, ha="right", fontsize=7, color=GREY)
    for r, look in zip(restitutions, LINE_STYLES, strict=False):
        ratio.axhline(cooling_ratio(float(r), 0.0), color=look.colour, lw=0.5)
    energy.set_title("energy of cooling gases", fontsize=8, loc="left")
    ratio.set_title("their $R$; thin lines: theory of free cooling", fontsize=8, loc="left")
    energy.set_ylabel(r"$\log_{10} E_\mathrm{trans}$")
    ratio.set_ylabel("$R$, means of a hundredth of the run")
    ratio.set_ylim(0.2, 0.8)
    for axes in (energy, ratio):
        axes.set_xlabel("collisions per particle")
    energy.legend(loc="lower left")
    return figure


PICTURES: dict[str, Callable[[Series], Figure]] = {
    "collapse": collapse,
    "chaos": chaos,
    "cooling": cooling,
}


def _pair(*widths):
    figure = Figure(figsize=(TWO_WIDE, 0.48 * TWO_WIDE), layout="constrained")
    return figure, figure.subplots(1, 2, width_ratios=widths)


def _chain(axes, chain):
    """Draw the particles near the chain in their nearest images; `last`: time since contact."""
    x, y, last = (np.array(chain[name]) for name in ("x", "y", "last"))
    involved = last < 1e-6
    middle = np.median(x[involved]), np.median(y[involved])
    x = middle[0] + (x - middle[0] + 25.0) % 50.0 - 25.0
    for k in range(x.size):
        colour = LINE_STYLES[1].colour if involved[k] else "#DDDDDD"
        axes.add_patch(Circle((x[k], y[k]), 1.0, fc=colour, ec=GREY, lw=0.4))
    half = 13.0
    axes.set_xlim(middle[0] - half, middle[0] + half)
    axes.set_ylim(middle[1] - half, middle[1] + half)
    axes.set_aspect("equal")
    axes.set_xlabel("$x/a$")
    axes.set_ylabel("$y/a$")
    axes.set_title("disks in the last contacts of a bed, $r = 0.6$", fontsize=8, loc="left")


def _contact_times(axes, model):
    duration, R, error, touched = (
        np.array(model[name]) for name in ("duration", "R", "error", "touched")
    )
    axes.errorbar(
        duration, R, error, fmt=LINE_STYLES[0].marker, color=LINE_STYLES[0].colour, capsize=1.5
    )
    axes.set_xscale("log")
    axes.set_ylim(0.18, 0.3)
    axes.set_xlabel(r"contact time $t_c/T$")
    axes.set_ylabel("$R$", color=LINE_STYLES[0].colour)
    share = axes.twinx()
    share.plot(duration, touched, LINE_STYLES[1].marker + "--", color=LINE_STYLES[1].colour, ms=3.5)
    share.set_yscale("log")
    share.set_ylabel("share of contacts changed", color=LINE_STYLES[1].colour)
    axes.set_title(r"with the model, $r = 0.6$, $\beta = 0$", fontsize=8, loc="left")


def _separation(axes, columns):
    collision, kernel, expected = (
        np.array(columns[name]) for name in ("collision", "kernel", "expected")
    )
    axes.semilogy(collision, kernel, "o", color=LINE_STYLES[0].colour, ms=3, label="this program")
    axes.plot(collision, expected, color=THEORY, label="prediction from roundings")
    axes.set_xlabel("collisions of eight disks")
    axes.set_ylabel("distance from exact simulation")
    axes.legend(loc="upper left")
    axes.set_title("growth of rounding errors", fontsize=8, loc="left")


def _return_errors(axes, columns):
    length = np.array(columns["collisions"])
    names = [name.removeprefix("error of ") for name in columns if name.startswith("error of ")]
    for name, look in zip(names, LINE_STYLES, strict=False):
        error, prediction = (
            np.array(columns[f"{column} {name}"]) for column in ("error of", "prediction for")
        )
        axes.semilogy(length, error, look.marker, color=look.colour, ms=3, label=name)
        small = prediction < 1.0
        axes.plot(length[small], prediction[small], color=look.colour, linestyle=look.line, lw=0.9)
    axes.set_xlabel("collisions per particle until reversal")
    axes.set_ylabel("distance from the start")
    axes.legend(loc="lower right")
    axes.set_title("a reversed elastic gas (lines: predicted)", fontsize=8, loc="left")
