"""The figures of accuracy: errors of R against CPU seconds, and how often intervals hold the truth.

A function a figure, by its name, of the datasets of the studies that it shows.
"""

from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MultipleLocator

from roughgas.accuracy import in_order
from roughgas.show.style import FAINT, GREY, LOOKS, THEORY, Look, Style
from roughgas.statistics.fits import power_law
from roughgas.tasks import along, cell, label

Panel = tuple[Callable[[Axes, xr.Dataset], None], str]
SIZE = (7.0, 4.2)  # inches, of two panels
WAYS = {"length": "-", "seeds": "--"}
METHODS = {
    "closed_form": ("closed form (Maxwellian theory)", Look(THEORY, "*", "none")),
    "rate_equations": ("rate equations, run longer and longer", LOOKS[2]),
    "dsmc": ("DSMC", LOOKS[1]),
    "event_driven": ("event-driven", LOOKS[0]),
}
LEAST = 1 / 3  # of the reference's own error, down to which the axis goes
ROOM = 0.4  # for the legend beneath, of the range of the data
PACKING_MARKERS = ("X", "P", "d")
BOTH = np.sqrt(2.0)  # statistical error and deviation being equal
RESOLVED = 2.0  # standard errors: deviations below are not told from zero
BARS: Style = {"elinewidth": 0.8, "capsize": 1.5}
THIN: Style = {"ls": "none", "elinewidth": 0.9}
LOG: Style = {"xscale": "log", "yscale": "log"}
LEGAL = (0.92, 0.98)
"""What share of the 95 % intervals has to hold the truth."""

COVERAGE_WIDTH = 7.4  # inches
COLOURS = {"vibrated": LOOKS[0], "sheared": LOOKS[1], "cooling": LOOKS[2]}
CORNER_BARS: Style = {"ls": "none", "capsize": 1.5, "elinewidth": 0.8, "mew": 0.9}
SHIFT = 0.17  # of the two ways off their corner's row


def accuracy(statistical: xr.Dataset, models: xr.Dataset) -> Figure:
    """Return the figure of noise and of models."""
    return _in_panels(PANELS[:2], statistical, models)


def accuracy_limits(discretisation: xr.Dataset, models: xr.Dataset) -> Figure:
    """Return the figure of springs and time steps, and of what Maxwellian theory misses."""
    return _in_panels(PANELS[2:], discretisation, models)


def coverage(data: xr.Dataset) -> Figure:
    """Return coverage at each corner, of intervals at 68 and 95 %."""
    corners = along(in_order(data), "corner")
    rows = len(corners)
    figure = Figure(figsize=(COVERAGE_WIDTH, 1.2 + 0.3 * rows), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    for axes, level in ((left, 0.68), (right, 0.95)):
        _corners(axes, corners, level)
        axes.tick_params(axis="y", which="both", left=False, right=False)
    right.axvspan(*LEGAL, color=FAINT, alpha=0.15, lw=0)
    left.set_yticks(range(rows), map(label, corners))
    left.set_ylim(rows - 0.5, -0.5)
    for way, fill in zip(data.way.values, (GREY, "white"), strict=True):
        left.plot([], [], "o", color=GREY, mfc=fill, label=str(way))
    figure.legend(loc="outside upper center", ncols=2)
    figure.supxlabel("share of intervals that hold the truth", fontsize="medium")
    return figure


def _in_panels(panels: Sequence[Panel], *data: xr.Dataset) -> Figure:
    """Return a figure of two panels, each of its dataset, with r and beta in their titles."""
    figure = Figure(figsize=SIZE, layout="constrained")
    every = figure.subplots(1, len(panels))
    for axes, (panel, title), one in zip(every, panels, data, strict=True):
        panel(axes, one)
        r, beta = (float(one.attrs[key]) for key in ("r", "beta"))
        place = rf"$r = {r:g}$, $\beta = {beta:g}$"
        axes.set_title(title.format(place), loc="left", fontsize=8.5)
    return figure


def draw_statistical(axes: Axes, data: xr.Dataset) -> None:
    """Draw relative errors, their fits and the marks of what accuracy, from group `statistical`."""
    axes.set(xlabel="CPU seconds of measurement", ylabel="relative error of $R$ (rms)", **LOG)
    for look, name in zip(LOOKS, data.scene.values, strict=False):
        scene = data.sel(scene=name)
        slopes = ", ".join(cell(scene.sel(way=way), "slope") for way in WAYS)
        label = f"{name}: {slopes}".replace("-", "\N{MINUS SIGN}")
        for way, line in WAYS.items():
            own, R = scene.sel(way=way), float(scene.R)
            x, error, groups = own.seconds.values, own.error.values / R, own.groups.values
            about: Style = {"color": look.colour, "marker": look.marker, "ls": "none", "zorder": 3}
            about |= {"label": label} if way == "length" else {"mfc": "white"}
            axes.errorbar(x, error, own.error_stderr / R, mew=0.9, **about, **BARS)
            ends = np.array([x.min(), x.max()])
            law = power_law(x, error, groups, bias=-0.5 / groups)
            axes.plot(ends, law(ends), color=look.colour, ls=line, lw=0.9)
    axes.set_ylim(bottom=min(data.relative_error.values) / 4)  # leaves room for the legend
    grey: Style = {"color": GREY, "fontsize": 7.5}
    beside: Style = {"xytext": (3, 3), "textcoords": "offset points", "va": "bottom"}
    for accuracy in data.relative_error.values:
        axes.axhline(accuracy, color=FAINT, lw=0.6, ls=":", zorder=0)
        place: Style = {"xy": (0.0, accuracy), "xycoords": ("axes fraction", "data")}
        axes.annotate(f"{100 * accuracy:g} %", **place, **beside, **grey)
    title = "slope: longer runs (filled), more seeds (open)"
    axes.legend(loc="lower left", title=title, alignment="left")


def draw_models(axes: Axes, data: xr.Dataset) -> None:
    """Draw the relative error of R against CPU seconds, log-log, by each method at one (r, beta).

    There is no line through symbols, since no run was made between two lengths.
    """
    axes.set(xlabel="CPU time of one run / s", ylabel="relative error of $R$", **LOG)
    for method, (text, look) in METHODS.items():
        x, (y, bar) = data[f"{method}_seconds"].values, _with_error(data, f"{method}_error")
        size: Style = {"markersize": 10} if look.marker == "*" else {}
        colours: Style = {"color": look.colour, "marker": look.marker}
        axes.errorbar(x, y, bar, label=text, zorder=3, **colours, **size, **THIN)
    seconds = data.event_driven_seconds.values
    fit = data.event_driven_prefactor.values * seconds**data.event_driven_slope.values
    axes.plot(seconds, fit, color=LOOKS[0].colour, linewidth=0.8, zorder=1)
    _floors(axes, data)
    axes.legend(loc="lower left")


def draw_map(axes: Axes, data: xr.Dataset) -> None:
    """Draw R of the homogeneous gas over theory, minus 1, against beta, a series for each r.

    Dashes are what its measured cumulants a20 and a11 explain.
    """
    order = np.argsort(-data.map_r.values)
    for row, look in zip(order, LOOKS, strict=False):
        one = data.isel(map_r=row)
        x, (y, bar) = one.map_beta.values, _with_error(one, "map_gap")
        label = f"$r = {float(one.map_r):g}$"
        about: Style = {"color": look.colour, "marker": look.marker, "label": label}
        axes.errorbar(x, 100 * y, 100 * bar, markersize=3.6, **about, **THIN)
        explained = 100 * one.map_gap_explained.values
        axes.plot(x, explained, "_", color=look.colour, ms=7, zorder=1)
        _event_driven(axes, data, float(one.map_r), look.colour)
    for k, packing in enumerate(data.packing.values):
        axes.plot([], [], PACKING_MARKERS[k], color=GREY, label=f"events, packing {packing:g}")
    axes.plot([], [], "_", color=GREY, ms=7, label="$a_{20}$, $a_{11}$ to first order")
    axes.axhline(0, color=THEORY, linewidth=0.8, zorder=0)
    axes.set(xlim=(-1.04, 1.04), xlabel=r"roughness $\beta$")
    axes.set_ylabel(r"$R/R_\mathrm{theory} - 1$   (%)")
    axes.xaxis.set_major_locator(MultipleLocator(0.5))
    axes.xaxis.set_minor_locator(MultipleLocator(0.1))
    low, high = axes.get_ylim()
    axes.set_ylim(low - ROOM * (high - low), high)
    axes.legend(loc="lower center", ncols=2, title="homogeneous gas (DSMC)")


def draw_discretisation(axes: Axes, data: xr.Dataset) -> None:
    """Draw error of R against CPU seconds, of soft spheres and events."""
    axes.set(xlabel="CPU seconds", ylabel="relative error of $R$, r.m.s.", **LOG)
    _events(axes, data)
    for look, steps in zip(LOOKS, data.steps.values, strict=False):
        label = f"soft spheres, {steps} steps a contact"
        _method(axes, data.sel(steps=steps), "soft", look, label)
    _name_contact_times(axes, data)
    _method(axes, data, "model", Look(THEORY, "x", ":"), "events, contact-time model")
    axes.set_ylim(bottom=axes.get_ylim()[0] / 3)  # room for the legend
    axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{100.0 * y:g} %"))
    axes.legend(loc="lower left")


PANELS: tuple[Panel, ...] = (
    (draw_statistical, "(a) noise, {}"),
    (draw_models, "(b) models of a cooling gas, {}"),
    (draw_discretisation, "(c) springs and time steps, {}"),
    (draw_map, "(d) what Maxwellian theory misses"),
)


def _with_error(data, name):
    return data[name].values, data[f"{name}_stderr"].values


def _floors(axes, data):
    """Draw what each model tends to, whatever is spent on it, and where the reference ends."""
    across = {"textcoords": "offset points", "fontsize": 7}
    place = {"xycoords": axes.get_yaxis_transform()}
    for name, text, colour, x, side in (
        ("closed_form_error", "Maxwellian velocities", THEORY, 0.985, "right"),
        ("dsmc_floor", "no density, no correlations", LOOKS[1].colour, 0.015, "left"),
    ):
        level = float(data[name])
        axes.axhline(level, color=colour, linewidth=0.7, linestyle=(0, (4, 2)), zorder=0)
        how = {"color": colour, "va": "bottom", "ha": side} | across | place
        axes.annotate(text, (x, level), (0, 3), **how)
    own = float(data.R_reference_stderr / data.R_reference)
    axes.axhspan(own * LEAST, own, color=FAINT, alpha=0.25, linewidth=0, zorder=0)
    axes.set_ylim(bottom=own * LEAST * 0.02)  # room for the legend beneath what is shaded
    below = {"va": "top", "ha": "right", "color": GREY} | across | place
    axes.annotate("error of the reference", (0.985, own), (0, -3), **below)


def _event_driven(axes, data, r, colour):
    """Draw the points at this r, each packing fraction with a symbol of its own."""
    points = data.isel(density_point=np.flatnonzero(data.density_r.values == r))
    large = {"markersize": 7, "markeredgecolor": THEORY, "markeredgewidth": 0.6, "zorder": 4}
    for k in range(points.sizes["packing"] if points.sizes["density_point"] else 0):
        x = points.density_beta.values
        y, bar = _with_error(points.isel(packing=k), "density_gap")
        marker = PACKING_MARKERS[k]
        axes.errorbar(x, 100 * y, 100 * bar, color=colour, marker=marker, **large, **THIN)


def _events(axes, data):
    """The event-driven gas has a statistical error alone; the law goes on beyond the data."""
    seconds = data.statistical_seconds.values
    error = _with_error(data, "statistical_error")
    axes.errorbar(seconds, *error, fmt="o", color=THEORY, ms=3, **BARS)
    last = float(data.event_cpu_seconds), float(data.event_R_stderr / data.reference_R)
    scale = last[1] * np.sqrt(last[0])
    reach = np.array([seconds[len(seconds) // 2], 10.0 * last[0]])
    axes.plot(reach, scale / np.sqrt(reach), color=THEORY, label="events: statistical error")


def _method(axes, data, kind, look, label):
    """sqrt(2) |deviation| against the CPU seconds after which the statistical error is as large."""
    deviation, stderr = _with_error(data, f"{kind}_deviation")
    seen = np.abs(deviation) > RESOLVED * stderr
    size, bar = BOTH * np.abs(deviation[seen]), BOTH * stderr[seen]
    seconds = data[f"{kind}_matched_seconds"].values[seen]
    # both coordinates stem from one measured deviation: its error moves a point along a slanted bar
    (x0, y0), (x1, y1) = ((seconds / (1.0 + s * bar / size) ** 2, size + s * bar) for s in (-1, 1))
    axes.plot([x0, x1], [y0, y1], color=look.colour, linewidth=0.8)
    about = {"color": look.colour, "marker": look.marker, "linestyle": look.line}
    axes.plot(seconds, size, label=label, **about)


def _name_contact_times(axes, data):
    """t_c nu beside the outermost of the points that share it."""
    small = {"fontsize": 7, "color": GREY}
    seen = np.abs(data.soft_deviation) > RESOLVED * data.soft_deviation_stderr
    seconds = data.soft_matched_seconds.where(seen, 0.0)
    for share in data.contact_time.values[seen.any("steps").values]:
        steps = seconds.sel(contact_time=share).idxmax("steps")
        point = data.sel(contact_time=share, steps=steps)
        place = point.soft_matched_seconds.item(), BOTH * abs(point.soft_deviation.item())
        axes.annotate(f"{share:g}", place, (5, 4), textcoords="offset points", **small)
    about = {"transform": axes.transAxes, "ha": "right", "va": "top"}
    axes.text(0.98, 0.97, r"numbers: $t_c\nu$ of soft spheres", **about, **small)


def _corners(axes: Axes, corners: Sequence[xr.Dataset], level: float) -> None:
    """Draw coverage of the intervals at `level`, a row a corner: of one run, of seeds pooled."""
    axes.axvline(level, color=GREY, lw=0.8, ls="--", zorder=0)
    for row, corner in enumerate(one.sel(level=level) for one in corners):
        look = COLOURS.get(str(corner.experiment.values), LOOKS[3])
        about: Style = CORNER_BARS | {"color": look.colour, "marker": look.marker}
        for way, (shift, fill) in enumerate(((-SHIFT, look.colour), (SHIFT, "white"))):
            share, stderr = corner.coverage[way], corner.coverage_stderr[way]
            axes.errorbar(share, row + shift, xerr=stderr, mfc=fill, **about)
    axes.set_xlabel(f"{100 * level:.0f} % intervals")
