"""Figure of R in a cooling gas against the number of particles and the size of the box."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from roughgas.plotting import GREY, LINE_STYLES, THEORY, LineStyle, Style
from roughgas.tasks import slices_along

SIZE = (7.0, 7.6)  # inches
BETA_MARKERS = "osD^v<>"
ERROR_BARS: Style = {"ls": "none", "elinewidth": 0.8}
SMALL_MARKER, LARGE_MARKER = 3.0, 6.0
"""Marker sizes of the smallest and of the largest number of particles."""
POINT_OVER_TIME = "cooling_r0.9_beta0"  # the point whose R(t) is drawn, if the data hold it
TITLES = (
    "(a) the number of particles",
    "(b) fourth cumulant of the spins",
    "(c) the size of the box",
    "(d) R over time, dense and dilute",
)


def draw(data: xr.Dataset) -> Figure:
    """Draw the figure from the dataset of all tasks."""
    figure = Figure(figsize=SIZE, layout="constrained")
    rows, graphs = np.asarray(figure.subfigures(2, 1, height_ratios=(1.15, 1)))
    panels_axes = [*rows.subplots(1, 2, sharey=True), *graphs.subplots(1, 2)]
    panels = draw_number, draw_tails, draw_box, draw_time
    for axes, panel, title in zip(panels_axes, panels, TITLES, strict=True):
        panel(axes, data)
        axes.set_title(title, loc="left", fontsize=8.5)
    points = _points_with_looks(data)
    panels_axes[0].set_yticks(
        range(len(points)), [_point_label(point) for point, _ in points], fontsize=7.5
    )
    panels_axes[0].set_ylim(len(points) - 0.4, -0.6)
    for axes in panels_axes[:2]:
        axes.tick_params(axis="y", which="both", left=False, right=False)
    return figure


def draw_number(axes: Axes, data: xr.Dataset) -> None:
    """Draw R of the homogeneous gas over theory, minus 1, for the smallest and the largest number
    of particles, one row per point."""
    _draw_ends(axes, data, lambda gas: _percent_of_theory(gas, "dsmc_R"))
    axes.axvline(0.0, color=THEORY, lw=0.8, zorder=0)
    axes.set_xlabel(r"$R/R_\mathrm{theory} - 1$  (%), DSMC")
    ends = data.particles.values[[0, -1]]
    for n, size in zip(ends, (SMALL_MARKER, LARGE_MARKER), strict=True):
        axes.plot([], [], "o", color=GREY, ms=size, label=f"$N = {n}$")
    axes.legend(loc="upper left")


def draw_tails(axes: Axes, data: xr.Dataset) -> None:
    """Draw the fourth cumulant of the spins, for the smallest and the largest number of
    particles."""
    dilute = int(np.argmin(data.packing.values))
    _draw_ends(axes, data, lambda gas: (float(gas.dsmc_a02), float(gas.dsmc_a02_stderr)))
    for row, (point, look) in enumerate(_points_with_looks(data)):
        for n, size in zip((0, -1), (SMALL_MARKER, LARGE_MARKER), strict=True):
            events = point.isel(packing=dilute, particles=n)
            style: Style = {"color": look.colour, "marker": "x", "ms": size, "mew": 0.9}
            axes.errorbar(events.a02, row + 0.35, xerr=events.a02_stderr, **style, **ERROR_BARS)
    packing = f"{data.packing.values[dilute]:g}"
    for marker, label in (("o", "DSMC"), ("x", f"events, packing {packing}")):
        axes.plot([], [], marker, color=GREY, ms=4, label=label)
    axes.set_xscale("log")
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel(r"fourth cumulant of spins, $a_{02}$")
    axes.legend(loc="upper right")


def draw_box(axes: Axes, data: xr.Dataset) -> None:
    """Draw R by events over R by DSMC at equal numbers of particles, minus 1, over the size of the
    box."""
    fills = ("white", None)
    betas = sorted({str(beta) for beta in data.beta.values}, key=float, reverse=True)
    markers = dict(zip(betas, BETA_MARKERS, strict=False))
    for point, look in _points_with_looks(data):
        for gases, fill in zip(slices_along(point, "packing"), fills, strict=False):
            style: Style = {
                "color": look.colour,
                "marker": markers[str(point.beta.item())],
                "mfc": fill or look.colour,
                "ms": 4,
            }
            y, bar = 100 * gases.over_dsmc, 100 * gases.over_dsmc_stderr
            axes.errorbar(gases.box, y, bar, **style, **ERROR_BARS)
    for beta, marker in markers.items():
        label = rf"$\beta = {beta}$".replace("-", "\N{MINUS SIGN}")
        axes.plot([], [], marker, color=GREY, ms=4, label=label)
    for value, fill in zip(data.packing.values, fills, strict=False):
        axes.plot([], [], "o", color=GREY, mfc=fill or GREY, ms=4, label=f"packing {value:g}")
    axes.axhline(0.0, color=THEORY, lw=0.8, zorder=0)
    axes.set(xscale="log", xlabel="side of the box / mean free path")
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_ylabel(r"$R_{\mathrm{events}}/R_{\mathrm{DSMC}} - 1$  (%)")
    axes.legend(loc="lower left", title="colours as in (a)", alignment="left")


def draw_time(axes: Axes, data: xr.Dataset) -> None:
    """Draw R over time at one point, for each number of particles and packing, and R by DSMC."""
    names = list(data.point.values)
    point = data.isel(point=names.index(POINT_OVER_TIME) if POINT_OVER_TIME in names else 0)
    for gas, look in zip(slices_along(point, "particles"), LINE_STYLES, strict=False):
        for series, fill in zip(slices_along(gas, "packing"), ("white", look.colour), strict=False):
            middle = (series.part - float(series.part[0]) / 2) * series.length
            style: Style = {"color": look.colour, "marker": look.marker, "mfc": fill, "ms": 3.5}
            style["label"] = f"$N = {int(gas.particles)}$" if fill != "white" else None
            axes.errorbar(middle, series.R_series, series.R_series_stderr, lw=0.8, **style)
    axes.axhline(float(point.dsmc_R[-1]), color=THEORY, lw=0.8, ls="--", zorder=0, label="DSMC")
    axes.set(xlabel="collisions per particle", ylabel="$R$")
    axes.legend(loc="lower left", title=f"{_point_label(point)}\nopen: denser, filled: dilute")


def _draw_ends(axes, data, number):
    """Draw `number`, with its error, for the smallest and the largest number of particles, one row
    per point."""
    ends = data.particles.values[[0, -1]]
    for row, (point, look) in enumerate(_points_with_looks(data)):
        estimates = [number(point.sel(particles=n)) for n in ends]
        axes.plot([x for x, _ in estimates], [row, row], color=look.colour, lw=0.8)
        for (x, bar), size in zip(estimates, (SMALL_MARKER, LARGE_MARKER), strict=True):
            axes.errorbar(x, row, xerr=bar, color=look.colour, marker="o", ms=size, **ERROR_BARS)


def _looks(data):
    """Return the look of each (experiment, r), disks first."""
    experiments = set(zip(data.experiment.values, data.r.values, strict=True))
    keys = sorted(experiments, key=lambda kind: (kind[0], -float(kind[1])))
    return dict(zip(keys, LINE_STYLES, strict=False))


def _particle_shape(experiment):
    """Return the shape of an experiment's particles."""
    return "spheres" if "spheres" in str(experiment) else "disks"


def _points_with_looks(data) -> list[tuple[xr.Dataset, LineStyle]]:
    """Return each point and its look, sorted by look, and from rough particles to smooth ones."""
    looks = _looks(data)
    order = list(looks)
    points = [(row, (row.experiment.item(), row.r.item())) for row in slices_along(data, "point")]
    points.sort(key=lambda point: (order.index(point[1]), -float(point[0].beta.item())))
    return [(row, looks[key]) for row, key in points]


def _point_label(point):
    beta = str(point.beta.item()).replace("-", "\N{MINUS SIGN}")
    return rf"{_particle_shape(point.experiment.item())}, $r = {point.r.item()}$, $\beta = {beta}$"


def _percent_of_theory(gas, name):
    """Return R over the theory of free cooling, minus 1, and its error, in per cent."""
    theory = float(gas.theory)
    return 100 * (float(gas[name]) / theory - 1), 100 * float(gas[f"{name}_stderr"]) / theory
