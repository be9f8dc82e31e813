"""Figures of accuracy: errors of R against CPU seconds, and deviations from Maxwellian theory."""

from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MultipleLocator

from roughgas.show.style import FAINT, GREY, LINE_STYLES, THEORY, LineStyle, Style
from roughgas.statistics.fits import power_law
from roughgas.tasks import slices_along, table_cell

Panel = tuple[Callable[[Axes, xr.Dataset], None], str]
SIZE = (7.0, 4.2)  # inches, of two panels
LINE_OF_WAY = {"length": "-", "seeds": "--"}
METHODS = {
    "closed_form": ("closed form (Maxwellian theory)", LineStyle(THEORY, "*", "none")),
    "rate_equations": ("rate equations, run longer and longer", LINE_STYLES[2]),
    "dsmc": ("DSMC", LINE_STYLES[1]),
    "event_driven": ("event-driven", LINE_STYLES[0]),
}
SHADED = 1 / 3  # lower end of the shaded band, over the error of the reference
LEGEND_ROOM = 0.4  # below the data, over their range
PACKING_MARKERS = ("X", "P", "d")
TOTAL_ERROR = np.sqrt(2.0)  # over the deviation, which equals the statistical error
RESOLVED = 2.0  # standard errors: smaller deviations are not drawn
PAPER_SEEDS, LEAST_WAIT = 4, 500.0  # T
LAST_E_FOLD = 5.0
TIME_MARKERS = {"autocorrelation_time": "^", "settling": "v"}
"""Markers of times along the lower and the upper axis."""
BARS: Style = {"elinewidth": 0.8, "capsize": 1.5}
THIN: Style = {"ls": "none", "elinewidth": 0.9}
LOG: Style = {"xscale": "log", "yscale": "log"}


def draw(statistical: xr.Dataset, models: xr.Dataset) -> Figure:
    """Return the figure of statistical errors and of models."""
    return _in_panels(PANELS[:2], statistical, models)


def draw_limits(discretisation: xr.Dataset, models: xr.Dataset) -> Figure:
    """Return the figure of springs and time steps, and of deviations from Maxwellian theory."""
    return _in_panels(PANELS[2:4], discretisation, models)


def draw_waiting(waiting: xr.Dataset) -> Figure:
    """Return the figure of beds that have not settled: bias of R, and lack of energy."""
    return _in_panels(PANELS[4:], waiting, waiting)


def _in_panels(panels: Sequence[Panel], *data: xr.Dataset) -> Figure:
    """Return a figure of two panels, each with its dataset, and r and beta in its title."""
    figure = Figure(figsize=SIZE, layout="constrained")
    all_axes = figure.subplots(1, len(panels))
    for axes, (panel, title), dataset in zip(all_axes, panels, data, strict=True):
        panel(axes, dataset)
        r, beta = (float(dataset.attrs.get(key, np.nan)) for key in ("r", "beta"))
        point = rf"$r = {r:g}$, $\beta = {beta:g}$"
        axes.set_title(title.format(point), loc="left", fontsize=8.5)
    return figure


def draw_statistical(axes: Axes, data: xr.Dataset) -> None:
    """Draw relative errors, their fits and marks of typical accuracies, from group
    `statistical`."""
    axes.set(xlabel="CPU seconds of measurement", ylabel="relative error of $R$ (rms)", **LOG)
    for look, name in zip(LINE_STYLES, data.scene.values, strict=False):
        scene = data.sel(scene=name)
        slopes = ", ".join(table_cell(scene.sel(way=way), "slope") for way in LINE_OF_WAY)
        label = f"{name}: {slopes}".replace("-", "\N{MINUS SIGN}")
        for way, line in LINE_OF_WAY.items():
            levels, R = scene.sel(way=way), float(scene.R)
            x, error, groups = levels.seconds.values, levels.error.values / R, levels.groups.values
            style: Style = {"color": look.colour, "marker": look.marker, "ls": "none", "zorder": 3}
            style |= {"label": label} if way == "length" else {"mfc": "white"}
            axes.errorbar(x, error, levels.error_stderr / R, mew=0.9, **style, **BARS)
            ends = np.array([x.min(), x.max()])
            law = power_law(x, error, groups, bias=-0.5 / groups)
            axes.plot(ends, law(ends), color=look.colour, ls=line, lw=0.9)
    axes.set_ylim(bottom=min(data.relative_error.values) / 4)  # leaves room for the legend
    grey: Style = {"color": GREY, "fontsize": 7.5}
    offset: Style = {"xytext": (3, 3), "textcoords": "offset points", "va": "bottom"}
    for accuracy in data.relative_error.values:
        axes.axhline(accuracy, color=FAINT, lw=0.6, ls=":", zorder=0)
        position: Style = {"xy": (0.0, accuracy), "xycoords": ("axes fraction", "data")}
        axes.annotate(f"{100 * accuracy:g} %", **position, **offset, **grey)
    title = "slope: longer runs (filled, full lines),\nmore seeds (open, dashed)"
    axes.legend(loc="lower left", title=title, alignment="left")


def draw_models(axes: Axes, data: xr.Dataset) -> None:
    """Draw the relative error of R against CPU seconds, log-log, by each method at one (r, beta).

    There is no line through symbols, since no run was made between two lengths.
    """
    axes.set(xlabel="CPU time of one run / s", ylabel="relative error of $R$", **LOG)
    for method, (label, look) in METHODS.items():
        x, (y, bar) = data[f"{method}_seconds"].values, _value_and_error(data, f"{method}_error")
        size: Style = {"markersize": 10} if look.marker == "*" else {}
        colours: Style = {"color": look.colour, "marker": look.marker}
        axes.errorbar(x, y, bar, label=label, zorder=3, **colours, **size, **THIN)
    seconds = data.event_driven_seconds.values
    fit = data.event_driven_prefactor.values * seconds**data.event_driven_slope.values
    label = "event-driven, fitted power law"
    axes.plot(seconds, fit, color=LINE_STYLES[0].colour, linewidth=0.8, zorder=1, label=label)
    _draw_floors(axes, data)
    axes.legend(loc="lower left")


def draw_map(axes: Axes, data: xr.Dataset) -> None:
    """Draw R of the homogeneous gas over theory, minus 1, against beta, a series for each r.

    Dashes are the prediction from its measured cumulants a20 and a11.
    """
    order = np.argsort(-data.map_r.values)
    for row, look in zip(order, LINE_STYLES, strict=False):
        series = data.isel(map_r=row)
        x, (y, bar) = series.map_beta.values, _value_and_error(series, "map_gap")
        label = f"$r = {float(series.map_r):g}$"
        style: Style = {"color": look.colour, "marker": look.marker, "label": label}
        axes.errorbar(x, 100 * y, 100 * bar, markersize=3.6, **style, **THIN)
        explained = 100 * series.map_gap_explained.values
        axes.plot(x, explained, "_", color=look.colour, ms=7, zorder=1)
        _draw_event_driven(axes, data, float(series.map_r), look.colour)
    for k, packing in enumerate(data.packing.values):
        axes.plot([], [], PACKING_MARKERS[k], color=GREY, label=f"events, packing {packing:g}")
    axes.plot([], [], "_", color=GREY, ms=7, label="$a_{20}$, $a_{11}$ to first order")
    axes.axhline(0, color=THEORY, linewidth=0.8, zorder=0)
    axes.set(xlim=(-1.04, 1.04), xlabel=r"roughness $\beta$")
    axes.set_ylabel(r"$R/R_\mathrm{theory} - 1$   (%)")
    axes.xaxis.set_major_locator(MultipleLocator(0.5))
    axes.xaxis.set_minor_locator(MultipleLocator(0.1))
    low, high = axes.get_ylim()
    axes.set_ylim(low - LEGEND_ROOM * (high - low), high)
    axes.legend(loc="lower center", ncols=2, title="homogeneous gas (DSMC)")


def draw_discretisation(axes: Axes, data: xr.Dataset) -> None:
    """Draw the error of R against CPU seconds, for soft spheres and for events."""
    axes.set(xlabel="CPU seconds", ylabel="relative error of $R$, r.m.s.", **LOG)
    _draw_events(axes, data)
    for look, steps in zip(LINE_STYLES, data.steps.values, strict=False):
        label = f"soft spheres, {steps} steps a contact"
        _draw_method(axes, data.sel(steps=steps), "soft", look, label)
    _name_contact_times(axes, data)
    _draw_method(axes, data, "model", LineStyle(THEORY, "x", ":"), "events, contact-time model")
    axes.set_ylim(bottom=axes.get_ylim()[0] / 3)  # room for the legend
    axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{100.0 * y:g} %"))
    axes.legend(loc="lower left")


def draw_bias(axes: Axes, data: xr.Dataset) -> None:
    """Draw the bias of R against the wait, over the standard error of the paper's mean."""
    shade: Style = {"color": FAINT, "alpha": 0.25, "linewidth": 0, "zorder": 0}
    axes.axhspan(-1.0, 1.0, label="paper's error", **shade)
    for look, bed in zip(LINE_STYLES, slices_along(data, "point"), strict=False):
        yardstick = paper_error(bed)
        bias, bar = (column / yardstick for column in _value_and_error(bed, "R_bias"))
        style: Style = {"color": look.colour, "marker": look.marker, "ls": "none"}
        axes.errorbar(bed.wait, bias, bar, markersize=3.6, label=_bed_name(bed), **style, **BARS)
        for name, height in (("autocorrelation_time", 0.0), ("settling", 1.0)):
            position = ([float(bed[name])], [height])
            across = {"transform": axes.get_xaxis_transform(), "clip_on": False, "zorder": 4}
            axes.plot(*position, TIME_MARKERS[name], color=look.colour, ms=6, **across)
    for name, label in (
        ("autocorrelation_time", "memory of $R$ (below)"),
        ("settling", "e-fold (above)"),
    ):
        axes.plot([], [], TIME_MARKERS[name], color=GREY, ms=6, label=label)
    floor = LEGEND_ROOM / (1.0 + LEGEND_ROOM)  # of the data, in shares of the axis
    axes.axvline(LEAST_WAIT, floor, color=GREY, lw=0.8, ls=":", label="least wait, lean")
    low, high = axes.get_ylim()
    axes.set(xscale="log", ylim=(low - LEGEND_ROOM * (high - low), high))
    axes.set(xlabel="wait / $T$", ylabel=r"bias of $R$ / error of the paper's mean")
    axes.legend(loc="lower center", ncols=2, framealpha=0.0)


def draw_lack(axes: Axes, data: xr.Dataset) -> None:
    """Draw the lack of translational energy against the time in e-folds of theory, log-linear."""
    hidden = 0
    for look, bed in zip(LINE_STYLES, slices_along(data, "point"), strict=False):
        lack, bar = _value_and_error(bed, "lack")
        shown = (lack > RESOLVED * bar) & (bed.time.values < LAST_E_FOLD * float(bed.settling))
        hidden += np.sum(~shown)
        time = bed.time.values[shown] / float(bed.settling)
        label = f"{_bed_name(bed)}: {float(bed.settling):.4g} $T$"
        style: Style = {"color": look.colour, "marker": look.marker, "ls": "none", "label": label}
        axes.errorbar(time, lack[shown], bar[shown], markersize=3.6, **style, **BARS)
    decay = np.array([0.0, LAST_E_FOLD])
    axes.plot(decay, np.exp(-decay), color=THEORY, lw=0.9, label="exponential", zorder=0)
    axes.set(
        xlabel="time since the start / e-fold by theory", yscale="log", xlim=(-0.2, LAST_E_FOLD)
    )
    axes.set_ylabel(r"$1 - E_\mathrm{trans}/$settled $E_\mathrm{trans}$")
    axes.set_ylim(np.exp(-LAST_E_FOLD) / 20.0, 2.0)  # room for the legend
    title = f"{hidden} points, later or within {RESOLVED:g} errors\nof 0, are not drawn; "
    title += "e-folds by theory:"
    axes.legend(loc="lower left", title=title, alignment="left")


def paper_error(bed: xr.Dataset) -> float:
    """Return the standard error of R of the paper's mean at a bed, from the scatter of its runs."""
    per_run = float(bed.R_stderr) * np.sqrt(float(bed.runs))
    length = float(bed.length - bed.settled) / bed.attrs["measure"]
    return per_run * np.sqrt(length / PAPER_SEEDS)


def _bed_name(bed: xr.Dataset) -> str:
    return rf"$r = {float(bed.r):g}$, $\beta = {float(bed.beta):g}$"


PANELS: tuple[Panel, ...] = (
    (draw_statistical, "(a) noise, {}"),
    (draw_models, "(b) models of a cooling gas, {}"),
    (draw_discretisation, "(c) springs and time steps, {}"),
    (draw_map, "(d) what Maxwellian theory misses"),
    (draw_bias, "(e) bias of $R$ after a wait, beds"),
    (draw_lack, "(f) beds from their start"),
)


def _value_and_error(data, name):
    return data[name].values, data[f"{name}_stderr"].values


def _draw_floors(axes, data):
    """Draw the error that each model tends to at any cost, and the error of the reference."""
    across = {"textcoords": "offset points", "fontsize": 7}
    coordinates = {"xycoords": axes.get_yaxis_transform()}
    for name, text, colour, x, side in (
        ("closed_form_error", "Maxwellian velocities", THEORY, 0.985, "right"),
        ("dsmc_floor", "no density, no correlations", LINE_STYLES[1].colour, 0.015, "left"),
    ):
        level = float(data[name])
        axes.axhline(level, color=colour, linewidth=0.7, linestyle=(0, (4, 2)), zorder=0)
        how = {"color": colour, "va": "bottom", "ha": side} | across | coordinates
        axes.annotate(text, (x, level), (0, 3), **how)
    reference_error = float(data.R_reference_stderr / data.R_reference)
    axes.axhspan(
        reference_error * SHADED, reference_error, color=FAINT, alpha=0.25, linewidth=0, zorder=0
    )
    axes.set_ylim(
        bottom=reference_error * SHADED * 0.02
    )  # room for the legend beneath the shaded band
    below = {"va": "top", "ha": "right", "color": GREY} | across | coordinates
    axes.annotate("error of the reference", (0.985, reference_error), (0, -3), **below)


def _draw_event_driven(axes, data, r, colour):
    """Draw the points at this r, with one symbol per packing fraction."""
    points = data.isel(density_point=np.flatnonzero(data.density_r.values == r))
    large = {"markersize": 7, "markeredgecolor": THEORY, "markeredgewidth": 0.6, "zorder": 4}
    for k in range(points.sizes["packing"] if points.sizes["density_point"] else 0):
        x = points.density_beta.values
        y, bar = _value_and_error(points.isel(packing=k), "density_gap")
        marker = PACKING_MARKERS[k]
        axes.errorbar(x, 100 * y, 100 * bar, color=colour, marker=marker, **large, **THIN)


def _draw_events(axes, data):
    """Draw the statistical error of the event-driven gas, its only error, and its law beyond the
    data."""
    seconds = data.statistical_seconds.values
    error = _value_and_error(data, "statistical_error")
    label = "events: statistical error"
    axes.errorbar(seconds, *error, fmt="o", color=THEORY, ms=3, label=label, **BARS)
    last = float(data.event_cpu_seconds), float(data.event_R_stderr / data.reference_R)
    scale = last[1] * np.sqrt(last[0])
    time_range = np.array([seconds[len(seconds) // 2], 10.0 * last[0]])
    law = scale / np.sqrt(time_range)
    axes.plot(time_range, law, color=THEORY, label="events: law of errors, (CPU s)$^{-1/2}$")


def _draw_method(axes, data, kind, look, label):
    """Draw sqrt(2) |deviation| against the CPU seconds after which the statistical error equals
    it."""
    deviation, stderr = _value_and_error(data, f"{kind}_deviation")
    resolved = _is_resolved(data, kind).values
    size, bar = TOTAL_ERROR * np.abs(deviation[resolved]), TOTAL_ERROR * stderr[resolved]
    seconds = data[f"{kind}_matched_seconds"].values[resolved]
    # both coordinates stem from one measured deviation: its error moves a point along a slanted bar
    (x0, y0), (x1, y1) = ((seconds / (1.0 + s * bar / size) ** 2, size + s * bar) for s in (-1, 1))
    axes.plot([x0, x1], [y0, y1], color=look.colour, linewidth=0.8)
    style = {"color": look.colour, "marker": look.marker, "linestyle": look.line}
    axes.plot(seconds, size, label=label, **style)


def _name_contact_times(axes, data):
    """Write t_c nu next to the outermost of the points that share it."""
    small = {"fontsize": 7, "color": GREY}
    resolved = _is_resolved(data, "soft")
    seconds = data.soft_matched_seconds.where(resolved, 0.0)
    for share in data.contact_time.values[resolved.any("steps").values]:
        steps = seconds.sel(contact_time=share).idxmax("steps")
        point = data.sel(contact_time=share, steps=steps)
        position = point.soft_matched_seconds.item(), TOTAL_ERROR * abs(point.soft_deviation.item())
        axes.annotate(f"{share:g}", position, (5, 4), textcoords="offset points", **small)
    corner = {"transform": axes.transAxes, "ha": "right", "va": "top"}
    hidden = int((~resolved).sum() + (~_is_resolved(data, "model")).sum())
    text = r"numbers: $t_c\nu$ of soft spheres"
    text += f"\n{hidden} points within {RESOLVED:g} errors of 0\nare not drawn"
    axes.text(0.98, 0.97, text, **corner, **small)


def _is_resolved(data, kind):
    """Return a mask of the points of a kind whose deviation from the reference is resolved."""
    return np.abs(data[f"{kind}_deviation"]) > RESOLVED * data[f"{kind}_deviation_stderr"]
