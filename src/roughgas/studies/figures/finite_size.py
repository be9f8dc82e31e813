"""The figure of how much of R in a cooling gas is due to the number of particles and to the box."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.show.style import GREY, LOOKS, THEORY, Look
from roughgas.studies.figures.panels import paired_panels
from roughgas.studies.tables import along

SIZE = (10.2, 8.2)  # inches
THIN: dict[str, Any] = {"ls": "none", "elinewidth": 0.8}
SIDESTEP = 0.014  # in beta, between kinds of gas at the same beta
LINEAR = 4.0  # per cent up to which the axis of deviations is linear
TYPICAL = "cooling_r0.9_beta0"  # the point whose R(t) is drawn, if it is there
APART = 1.19  # least ratio of the heights of two words at the end of series


def draw_figure(data: xr.Dataset) -> Figure:
    """Return the figure, from the study's dataset."""
    return paired_panels(PANELS, SIZE, *[data] * len(PANELS))


def draw_number(axes: Axes, data: xr.Dataset) -> None:
    """Draw R of the homogeneous gas over theory, minus 1, of the fewest and the most particles."""
    ends = data.particles.values[[0, -1]]
    for one, look, shift in _points(data):
        x = float(one.beta.item()) + shift
        few, many = (_percent(one.sel(particles=n), "dsmc_R") for n in ends)
        axes.plot([x, x], [few[0], many[0]], color=look.colour, lw=0.8)
        for (y, bar), fill in ((few, "white"), (many, look.colour)):
            about: dict[str, Any] = {"color": look.colour, "marker": look.marker, "mfc": fill}
            axes.errorbar(x, y, bar, **about, **THIN)
    for n, fill in zip(ends, ("white", GREY), strict=True):
        axes.plot([], [], "o", color=GREY, mfc=fill, label=f"$N = {n}$")
    _name_kinds(axes, data)
    axes.axhline(0.0, color=THEORY, lw=0.8, zorder=0)
    axes.set(xlabel=r"roughness $\beta$", ylabel=r"$R/R_\mathrm{theory} - 1$  (%)")
    low, high = axes.get_ylim()
    axes.set_ylim(low - 0.3 * (high - low), high)
    axes.legend(loc="lower right", ncols=2)


def draw_box(axes: Axes, data: xr.Dataset) -> None:
    """Draw R by events over R by DSMC of as many particles, minus 1, over the size of the box."""
    fills = ("white", None)
    for one, look, shift in _points(data):
        for place, fill in zip(along(one, "packing"), fills, strict=False):
            about: dict[str, Any] = {
                "color": look.colour,
                "marker": look.marker,
                "mfc": fill or look.colour,
            }
            y, bar = 100 * place.over_dsmc, 100 * place.over_dsmc_stderr
            axes.errorbar(place.box * (1 + 2 * shift), y, bar, **about, **THIN)
    for place, fill in zip(data.packing.values, fills, strict=False):
        axes.plot([], [], "o", color=GREY, mfc=fill or GREY, label=f"packing {place:g}")
    axes.axhline(0.0, color=THEORY, lw=0.8, zorder=0)
    axes.set_xscale("log")
    axes.set_yscale("symlog", linthresh=LINEAR, linscale=1.5)
    ticks = [-100, -50, -20, -10, -4, -2, 0, 2, 4, 8]
    axes.set_yticks(ticks, [f"{tick}".replace("-", "−") for tick in ticks])
    axes.minorticks_off()
    axes.set_ylim(-130, 10)
    axes.set(xlabel="side of the box / mean free path")
    axes.set_ylabel(r"$R_{\mathrm{events}}/R_{\mathrm{DSMC}} - 1$  (%), as many particles")
    axes.legend(loc="lower left")


def draw_time(axes: Axes, data: xr.Dataset) -> None:
    """Draw R over time at one point, each number of particles and packing, beside DSMC."""
    names = list(data.point.values)
    one = data.isel(point=names.index(TYPICAL) if TYPICAL in names else 0)
    for gas, look in zip(along(one, "particles"), LOOKS, strict=False):
        for place, fill in zip(along(gas, "packing"), ("white", look.colour), strict=False):
            middle = (place.part - float(place.part[0]) / 2) * place.length
            about: dict[str, Any] = {
                "color": look.colour,
                "marker": look.marker,
                "mfc": fill,
                "ms": 3.5,
            }
            label = f"$N = {int(gas.particles)}$" if fill != "white" else None
            axes.errorbar(
                middle, place.R_series, place.R_series_stderr, lw=0.8, label=label, **about
            )
    axes.axhline(float(one.dsmc_R[-1]), color=THEORY, lw=0.8, ls="--", zorder=0, label="DSMC")
    axes.set(xlabel="collisions per particle", ylabel="$R$")
    title = rf"{_kind(one)}, $r = {one.r.item()}$, $\beta = {one.beta.item()}$"
    axes.legend(loc="lower left", title=title)


def draw_tails(axes: Axes, data: xr.Dataset) -> None:
    """Draw the fourth cumulant of the spins over the number of particles."""
    number, dilute = data.particles.values, int(np.argmin(data.packing.values))
    for one, look, _ in _points(data):
        about: dict[str, Any] = {"color": look.colour, "marker": look.marker}
        bars: dict[str, Any] = {"lw": 0.8, "elinewidth": 0.8}
        axes.errorbar(number, one.dsmc_a02, one.dsmc_a02_stderr, **about, **bars)
        events = one.isel(packing=dilute)
        bar = events.a02_stderr
        axes.errorbar(1.1 * number, events.a02, bar, **about | {"mfc": "white"}, **THIN)
    _name_ends(axes, data)
    packing = f"{data.packing.values[dilute]:g}"
    for fill, label in ((GREY, "DSMC"), ("white", f"events, packing {packing}")):
        axes.plot([], [], "o", color=GREY, mfc=fill, label=label)
    axes.set(xscale="log", yscale="log", xlabel="number of particles $N$")
    axes.set_xticks(number, map(str, number))
    ticks = [0.003, 0.01, 0.03, 0.1, 0.3, 1, 3, 10]
    axes.set_yticks(ticks, map(str, ticks))
    axes.minorticks_off()
    axes.set_xlim(number[0] / 1.2, number[-1] * 2.2)
    low, high = data.dsmc_a02.values.min(), data.dsmc_a02.values.max()
    axes.set_ylim(max(low, ticks[0]) / 1.5, 2.5 * max(high, ticks[1]))
    axes.set_ylabel(r"fourth cumulant of spins, $a_{02}$")
    axes.legend(loc="upper left", ncols=2)


def _name_ends(axes, data):
    """Write beta at the end of each series, from below, none upon another."""
    x, below = data.particles.values[-1] * 1.3, 0.0
    points = sorted(_points(data), key=lambda point: float(point[0].dsmc_a02[-1]))
    for one, look, _ in points:
        below = max(APART * below, float(one.dsmc_a02[-1]))
        text = rf"$\beta = {one.beta.item()}$"
        axes.text(x, below, text, va="center", fontsize=7, color=look.colour)


PANELS = (
    (draw_number, "(a) the homogeneous gas (DSMC): number of particles"),
    (draw_box, "(b) what the box adds"),
    (draw_time, "(c) over time: open symbols denser, filled ones dilute"),
    (draw_tails, "(d) fourth cumulant of the spins"),
)


def _kinds(data):
    """Return the look of each (experiment, r), disks first."""
    found = set(zip(data.experiment.values, data.r.values, strict=True))
    kinds = sorted(found, key=lambda kind: (kind[0], -float(kind[1])))
    return dict(zip(kinds, LOOKS, strict=False))


def _kind(one):
    """Return what the particles of a point are."""
    return "spheres" if "spheres" in str(one.experiment.item()) else "disks"


def _points(data) -> list[tuple[xr.Dataset, Look, float]]:
    """Return each point, its look, and its sidestep in beta."""
    kinds = _kinds(data)
    order = list(kinds)
    points = []
    for one in along(data, "point"):
        kind = one.experiment.item(), one.r.item()
        shift = SIDESTEP * (order.index(kind) - (len(order) - 1) / 2)
        points.append((one, kinds[kind], shift))
    return points


def _name_kinds(axes, data):
    for (name, r), look in _kinds(data).items():
        kind = "spheres" if "spheres" in name else "disks"
        axes.plot([], [], look.marker, color=look.colour, label=f"{kind}, $r = {r}$")


def _percent(one, name):
    """Return R over that of the theory of free cooling, minus 1, and its error, in per cent."""
    theory = float(one.theory)
    return 100 * (float(one[name]) / theory - 1), 100 * float(one[f"{name}_stderr"]) / theory
