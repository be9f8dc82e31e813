"""The figure of how often stated intervals hold the truth, and its table."""

import math

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.plotting.style import FAINT, GREY, LOOKS

LEGAL = (0.92, 0.98)
"""What share of the 95 % intervals has to hold the truth."""

WIDTH = 7.4  # inches
COLOURS = {"vibrated": LOOKS[0], "sheared": LOOKS[1], "cooling": LOOKS[2]}
SHIFT = 0.17  # of the two ways off their corner's row


def draw_figure(data: xr.Dataset) -> Figure:
    """Coverage at each corner, of intervals at 68 and 95 %, from group `coverage`."""
    data = _in_order(data)
    rows = data.sizes["corner"]
    figure = Figure(figsize=(WIDTH, 1.2 + 0.3 * rows), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    for axes, level in ((left, 0.68), (right, 0.95)):
        draw(axes, data, level)
        axes.tick_params(axis="y", which="both", left=False, right=False)
    right.axvspan(*LEGAL, color=FAINT, alpha=0.15, lw=0)
    left.set_yticks(range(rows), [_label(data, k) for k in range(rows)])
    left.set_ylim(rows - 0.5, -0.5)
    for way, fill in zip(data.way.values, (GREY, "white"), strict=True):
        left.plot([], [], "o", color=GREY, mfc=fill, label=str(way))
    figure.legend(loc="outside upper center", ncols=2)
    figure.supxlabel("share of intervals that hold the truth", fontsize="medium")
    return figure


def draw(axes: Axes, data: xr.Dataset, level: float) -> None:
    """Coverage of the intervals at `level`, one row a corner: of one run, and of seeds pooled."""
    axes.axvline(level, color=GREY, lw=0.8, ls="--", zorder=0)
    for row in range(data.sizes["corner"]):
        corner = data.isel(corner=row).sel(level=level)
        look = COLOURS[str(corner.experiment.values)]
        for way, (shift, fill) in enumerate(((-SHIFT, look.colour), (SHIFT, "white"))):
            axes.errorbar(
                *(corner.coverage[way], row + shift),
                xerr=corner.coverage_stderr[way],
                **{"color": look.colour, "marker": look.marker, "mfc": fill, "ls": "none"},
                **{"capsize": 1.5, "elinewidth": 0.8, "mew": 0.9},
            )
    axes.set_xlabel(f"{100 * level:.0f} % intervals")


def table(data: xr.Dataset) -> list[str]:
    """The rows of a table in Markdown, its head first: a corner each, with standard errors."""
    data = _in_order(data)
    head = ["corner", "runs", "68 %, one run", "95 %, one run", "68 %, pooled", "95 %, pooled"]
    head += ["bias / scatter", "stated / true error", "window / τ"]
    rows = [head, ["---"] * len(head)]
    for k in range(data.sizes["corner"]):
        corner = data.isel(corner=k)
        shares = zip(
            *(corner[n].values.ravel() for n in ("coverage", "coverage_stderr")), strict=True
        )
        rows.append([_label(data, k), f"{int(corner.repetitions)}"])
        rows[-1] += [_with_error(100 * value, 100 * stderr) for value, stderr in shares]
        rows[-1] += [_with_error(float(corner[n]), float(corner[f"{n}_stderr"])) for n in JUDGED]
        rows[-1].append(f"{float(corner.window / corner.autocorrelation_time):.0f}")
    return [f"| {' | '.join(row)} |" for row in rows]


JUDGED = ("bias", "stated_over_true")


def _in_order(data: xr.Dataset) -> xr.Dataset:
    """The corners by experiment, and there from weak to strong dissipation."""
    scene = [list(COLOURS).index(name) for name in data.experiment.values]
    r, beta = data.r.values.astype(float), data.beta.values.astype(float)
    return data.isel(corner=np.lexsort((-beta, -r, scene)))


def _with_error(value: float, stderr: float) -> str:
    digits = max(0, 1 - math.floor(math.log10(stderr))) if stderr > 0 else 2
    return f"{value:.{digits}f} ± {stderr:.{digits}f}"


def _label(data: xr.Dataset, k: int) -> str:
    corner = data.isel(corner=k)
    beta = str(np.asarray(corner.beta)).replace("-", "−")
    return f"{corner.experiment.values}, r = {corner.r.values}, β = {beta}"
