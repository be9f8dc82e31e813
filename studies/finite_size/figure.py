"""The figure of how much of R in a cooling gas is due to the number of particles and to the box."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from roughgas.plotting import GREY, LOOKS, THEORY, Look, Style
from roughgas.tasks import along

SIZE = (7.0, 7.6)  # inches
THIN: Style = {"ls": "none", "elinewidth": 0.8}
SMALL, LARGE = 3.0, 6.0
"""Marker sizes of the fewest and of the most particles."""
TYPICAL = "cooling_r0.9_beta0"  # the point whose R(t) is drawn, if it is there
TITLES = (
    "(a) the number of particles",
    "(b) fourth cumulant of the spins",
    "(c) a large box lowers R",
    "(d) the dense gas loses R over time",
)


def draw(data: xr.Dataset) -> Figure:
    """Return the figure, of what all tasks have found."""
    figure = Figure(figsize=SIZE, layout="constrained")
    rows, graphs = np.asarray(figure.subfigures(2, 1, height_ratios=(1.15, 1)))
    every = [*rows.subplots(1, 2, sharey=True), *graphs.subplots(1, 2)]
    panels = draw_number, draw_tails, draw_box, draw_time
    for axes, panel, title in zip(every, panels, TITLES, strict=True):
        panel(axes, data)
        axes.set_title(title, loc="left", fontsize=8.5)
    points = _points(data)
    every[0].set_yticks(range(len(points)), [_label(one) for one, _ in points], fontsize=7.5)
    every[0].set_ylim(len(points) - 0.4, -0.6)
    for axes in every[:2]:
        axes.tick_params(axis="y", which="both", left=False, right=False)
    return figure


def draw_number(axes: Axes, data: xr.Dataset) -> None:
    """Draw R of the homogeneous gas over theory, minus 1, of the fewest and the most particles, a
    row for each point."""
    _draw_ends(axes, data, lambda one: _percent(one, "dsmc_R"))
    axes.axvline(0.0, color=THEORY, lw=0.8, zorder=0)
    axes.set_xlabel(r"$R/R_\mathrm{theory} - 1$  (%), DSMC")
    ends = data.particles.values[[0, -1]]
    for n, size in zip(ends, (SMALL, LARGE), strict=True):
        axes.plot([], [], "o", color=GREY, ms=size, label=f"$N = {n}$")
    axes.legend(loc="upper left")


def draw_tails(axes: Axes, data: xr.Dataset) -> None:
    """Draw the fourth cumulant of the spins, of the fewest and the most particles."""
    dilute = int(np.argmin(data.packing.values))
    _draw_ends(axes, data, lambda one: (float(one.dsmc_a02), float(one.dsmc_a02_stderr)))
    for row, (one, look) in enumerate(_points(data)):
        for n, size in zip((0, -1), (SMALL, LARGE), strict=True):
            events = one.isel(packing=dilute, particles=n)
            about: Style = {"color": look.colour, "marker": "x", "ms": size, "mew": 0.9}
            axes.errorbar(events.a02, row + 0.35, xerr=events.a02_stderr, **about, **THIN)
    packing = f"{data.packing.values[dilute]:g}"
    for marker, label in (("o", "DSMC"), ("x", f"events, packing {packing}")):
        axes.plot([], [], marker, color=GREY, ms=4, label=label)
    axes.set_xscale("log")
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel(r"fourth cumulant of spins, $a_{02}$")
    axes.legend(loc="upper right")


def draw_box(axes: Axes, data: xr.Dataset) -> None:
    """Draw R by events over R by DSMC of as many particles, minus 1, over the size of the box."""
    fills = ("white", None)
    for one, look in _points(data):
        for place, fill in zip(along(one, "packing"), fills, strict=False):
            about: Style = {
                "color": look.colour,
                "marker": look.marker,
                "mfc": fill or look.colour,
                "ms": 4,
            }
            y, bar = 100 * place.over_dsmc, 100 * place.over_dsmc_stderr
            axes.errorbar(place.box, y, bar, **about, **THIN)
    for (name, r), look in _kinds(data).items():
        axes.plot([], [], look.marker, color=look.colour, ms=4, label=f"{_kind(name)}, $r = {r}$")
    for place, fill in zip(data.packing.values, fills, strict=False):
        axes.plot([], [], "o", color=GREY, mfc=fill or GREY, ms=4, label=f"packing {place:g}")
    axes.axhline(0.0, color=THEORY, lw=0.8, zorder=0)
    axes.set(xscale="log", xlabel="side of the box / mean free path")
    axes.set_ylabel(r"$R_{\mathrm{events}}/R_{\mathrm{DSMC}} - 1$  (%)")
    axes.legend(loc="lower left")


def draw_time(axes: Axes, data: xr.Dataset) -> None:
    """Draw R over time at one point, each number of particles and packing, beside DSMC."""
    names = list(data.point.values)
    one = data.isel(point=names.index(TYPICAL) if TYPICAL in names else 0)
    for gas, look in zip(along(one, "particles"), LOOKS, strict=False):
        for place, fill in zip(along(gas, "packing"), ("white", look.colour), strict=False):
            middle = (place.part - float(place.part[0]) / 2) * place.length
            about: Style = {"color": look.colour, "marker": look.marker, "mfc": fill, "ms": 3.5}
            about["label"] = f"$N = {int(gas.particles)}$" if fill != "white" else None
            axes.errorbar(middle, place.R_series, place.R_series_stderr, lw=0.8, **about)
    axes.axhline(float(one.dsmc_R[-1]), color=THEORY, lw=0.8, ls="--", zorder=0, label="DSMC")
    axes.set(xlabel="collisions per particle", ylabel="$R$")
    axes.legend(loc="lower left", title=f"{_label(one)}\nopen: denser, filled: dilute")


def _draw_ends(axes, data, number):
    """Draw a row for each point: a number, with its error, of the fewest and the most particles."""
    ends = data.particles.values[[0, -1]]
    for row, (one, look) in enumerate(_points(data)):
        found = [number(one.sel(particles=n)) for n in ends]
        axes.plot([x for x, _ in found], [row, row], color=look.colour, lw=0.8)
        for (x, bar), size in zip(found, (SMALL, LARGE), strict=True):
            axes.errorbar(x, row, xerr=bar, color=look.colour, marker="o", ms=size, **THIN)


def _kinds(data):
    """Return the look of each (experiment, r), disks first."""
    found = set(zip(data.experiment.values, data.r.values, strict=True))
    kinds = sorted(found, key=lambda kind: (kind[0], -float(kind[1])))
    return dict(zip(kinds, LOOKS, strict=False))


def _kind(experiment):
    """Return what the particles of an experiment are."""
    return "spheres" if "spheres" in str(experiment) else "disks"


def _points(data) -> list[tuple[xr.Dataset, Look]]:
    """Return each point and its look, kind by kind and from rough particles to smooth ones."""
    kinds = _kinds(data)
    order = list(kinds)
    points = [(one, (one.experiment.item(), one.r.item())) for one in along(data, "point")]
    points.sort(key=lambda point: (order.index(point[1]), -float(point[0].beta.item())))
    return [(one, kinds[kind]) for one, kind in points]


def _label(one):
    beta = str(one.beta.item()).replace("-", "\N{MINUS SIGN}")
    return rf"{_kind(one.experiment.item())}, $r = {one.r.item()}$, $\beta = {beta}$"


def _percent(one, name):
    """Return R over that of the theory of free cooling, minus 1, and its error, in per cent."""
    theory = float(one.theory)
    return 100 * (float(one[name]) / theory - 1), 100 * float(one[f"{name}_stderr"]) / theory
