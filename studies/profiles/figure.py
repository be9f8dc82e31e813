"""Figure of profiles across vibrated beds, averages of R, and sheared gases."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.plotting import FAINT, GREY, LINE_STYLES, THEORY, Style, key
from roughgas.tasks import slices_along
from roughgas.theory import lun_ratio

from .results import QUARTERS, point_label

SIZE = (7.0, 7.0)  # inches
DRAWN_SHARE = 5e-4
"""Least share of the particles in a slice that is drawn."""
DRAWN_SHARE_AT_CONTACTS = 1e-2
"""The same for quantities measured at contacts."""
AVERAGES = {
    "R": "mean of $R(t)$",
    "R_ratio_of_means": "ratio of mean energies",
    "R_weighted": "slices and phases,\nby their contacts",
    "R_level": "pairs at one height,\nby relative speed",
    "R_meeting": "those near,\napproaching",
    "R_collisional": "at contacts",
}
BARS: Style = {"capsize": 1.5, "elinewidth": 0.8}
LEGEND_ROOM = 0.45  # above the data, over their range


TITLES = (
    "(a) beds: R over height",
    "(b) beds: R over a period of the floor",
    "(c) beds: ways of averaging R",
    "(d) sheared gases, and a formula",
)


def draw(data: xr.Dataset) -> Figure:
    """Draw R over height and phase, averages of R, and sheared gases, from the data of all
    tasks."""
    beds = [point for point in slices_along(data, "point") if np.isnan(point.theta)]
    sheared = [point for point in slices_along(data, "point") if np.isfinite(point.theta)]
    figure = Figure(figsize=SIZE, layout="constrained")
    panels = figure.subplots(2, 2)
    draw_ratios(panels[0, 0], beds)
    draw_phases(panels[0, 1], beds)
    draw_averages(panels[1, 0], beds)
    draw_sheared(panels[1, 1], sheared)
    for title, axes in zip(TITLES, panels.flat, strict=True):
        axes.set_title(title, loc="left", fontsize=8.5)
    keys = [
        key(look.colour, point_label(bed), look.marker, "-", ms=4)
        for bed, look in zip(beds, LINE_STYLES, strict=False)
    ]
    figure.legend(handles=keys, loc="outside upper center", ncols=3, title="vibrated beds")
    return figure


def draw_ratios(axes: Axes, beds: Sequence[xr.Dataset]) -> None:
    """Draw R of the temperatures of slices as lines, and R at the contacts there as symbols."""
    for bed, look in zip(beds, LINE_STYLES, strict=False):
        axes.plot(*_profiles(bed, "R_slice"), color=look.colour, lw=1.4)
        height, at_contacts = _profiles(
            bed, "R_slice_collisional", minimum_share=DRAWN_SHARE_AT_CONTACTS
        )
        every = slice(None, None, 2)
        style: Style = {"color": look.colour, "ms": 2.8}
        axes.plot(height[every], at_contacts[every], look.marker, **style)
    axes.plot([], [], color=GREY, lw=1.4, label="of the temperatures")
    axes.plot([], [], "o", color=GREY, ms=2.8, label="at contacts")
    _draw_lun(axes, beds)
    axes.set(xlabel="height / $a$", ylabel="$R$ of a slice", xlim=0, ylim=(0, 0.95))
    axes.legend(loc="upper right")


def draw_phases(axes: Axes, beds: Sequence[xr.Dataset]) -> None:
    """Draw R of a whole bed over the phase of its floor, and R at contacts near that phase."""
    for bed, look in zip(beds, LINE_STYLES, strict=False):
        phase = np.append(bed.phase.values, 1.0)
        for name, width, line in (("R_phase", 1.4, "-"), ("R_collisional_phase", 0.9, ":")):
            values = bed[name].values
            axes.plot(phase, np.append(values, values[0]), line, lw=width, color=look.colour)
        quarters = slice(None, -1, bed.sizes["phase"] // QUARTERS)
        values = bed.R_phase.values[:: bed.sizes["phase"] // QUARTERS]
        axes.plot(phase[quarters], values, look.marker, color=look.colour)
    axes.plot([], [], color=GREY, lw=1.4, label="of the whole bed")
    axes.plot([], [], "o", color=GREY, label="at the paper's four phases")
    axes.plot([], [], color=GREY, lw=0.9, ls=":", label="at contacts")
    _draw_lun(axes, beds)
    axes.set(xlabel="phase of the floor, from its fall", ylabel="$R$", xlim=(-0.03, 1.03))
    axes.set_ylim(0, 0.95)
    axes.legend(loc="upper left")


def draw_averages(axes: Axes, beds: Sequence[xr.Dataset]) -> None:
    """Draw R of each bed by each average, minus Lun's formula."""
    rows = np.arange(len(AVERAGES))[::-1]
    for k, (bed, look) in enumerate(zip(beds, LINE_STYLES, strict=False)):
        R = np.array([float(bed[name]) for name in AVERAGES]) - float(bed.R_lun)
        bars = [float(bed[f"{name}_stderr"]) for name in AVERAGES]
        y = rows + 0.11 * ((len(beds) - 1) / 2 - k)
        axes.errorbar(R, y, xerr=bars, fmt=look.marker, color=look.colour, ms=4, **BARS)
    axes.axvline(0, color=THEORY, lw=0.8)
    axes.set_yticks(rows, AVERAGES.values(), fontsize=7.5)
    axes.tick_params(axis="y", which="both", left=False, right=False)
    axes.set_xlabel(r"$R - R_\mathrm{Lun}$")


def draw_sheared(axes: Axes, gases: Sequence[xr.Dataset]) -> None:
    """Draw theta of sheared gases over Lun's formula, against the factor of theory.transport."""
    top = 1.0
    for gas, look in zip(gases, LINE_STYLES, strict=False):
        lun = float(lun_ratio(float(str(gas.beta.values)), float(gas.inertia)))
        scale = (1 - lun) / lun
        value, bar = float(gas.theta) * scale, float(gas.theta_stderr) * scale
        label = point_label(gas)
        style: Style = {"xerr": float(gas.factor_stderr), "yerr": bar, "fmt": look.marker}
        axes.errorbar(float(gas.factor), value, color=look.colour, label=label, **style, **BARS)
        top = max(top, value + bar, float(gas.factor))
    ends = (1.0, 1.0 + 1.1 * (top - 1.0))
    axes.plot(ends, ends, color=THEORY, lw=0.8, zorder=0, label="if the formula were exact")
    axes.set_xlabel(FACTOR_LABEL)
    axes.set_ylabel(r"$\theta/\theta_\mathrm{Lun}$ of the simulation")
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + LEGEND_ROOM * (high - low))
    axes.legend(loc="upper left", title="sheared disks")


FACTOR_LABEL = r"$1 + (p^2 + d^2)/4 + \sqrt{\pi}\,gp/4 + g^2/4$"


def _profiles(point, *names, minimum_share=DRAWN_SHARE):
    """Return heights and values in the slices with at least the minimum share of particles; the
    last slice, which holds all that is above, is left out."""
    is_drawn = point.density.values / np.nansum(point.density.values) > minimum_share
    is_drawn[-1] = False
    return [point[name].values[is_drawn] for name in ("height", *names)]


def _draw_lun(axes, beds):
    for R in sorted({round(float(bed.R_lun), 4) for bed in beds}):
        axes.axhline(R, color=FAINT, lw=0.8, ls="--", zorder=0)
    axes.plot([], [], color=FAINT, lw=0.8, ls="--", label="Lun's formula")
