"""Figures of single datasets: R of a reduced dataset over an axis, time series of a point, and
results of observables.

R = E_rot/(E_rot + E_trans), from energies per degree of freedom; r is the normal restitution, beta
the roughness. `over` is the name of the coordinate on the horizontal axis, `chosen` has values to
show by coordinate (r, beta).
"""

import math
import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from roughgas.base import InputError, Record, unknown_name_error
from roughgas.data.netcdf import unit_of
from roughgas.data.reduced import GRID_DIMS
from roughgas.data.variables import CLOCKS, third_axis
from roughgas.show.figures import panel
from roughgas.show.figures.panel import series
from roughgas.show.style import GREY, HEIGHT, LINE_STYLES, THEORY, TWO_WIDE, WIDTH, Style
from roughgas.statistics.errors import block_means
from roughgas.statistics.estimates import Estimate
from roughgas.theory.prediction import equation_of

MAX_SERIES, MAX_PANELS = len(LINE_STYLES), 2  # panels that fit on a page
AXES = {axis.name: axis for axis in (panel.BETA, panel.FRICTION, panel.INERTIA, panel.ROUGHNESS)}
LABELS = {
    "r": "normal restitution $r$",
    "particles": "number of particles $N$",
    "box": "width of the box / $a$",
    "spin_share": panel.SHARE_LABEL,
}
UNITS_OF_SETTINGS = (
    dict.fromkeys(("amplitude", "half_stroke", "radius"), "a")
    | dict.fromkeys(("period", "interval", "duration"), "T")
    | dict.fromkeys(("velocity", "speed", "spin_velocity", "reference"), "a/T")
    | dict.fromkeys(("drag", "spin_drag"), "1/T")
    | dict.fromkeys(("temperature", "spin_temperature"), "m a^2/T^2")
    | dict.fromkeys(("power", "spin_power"), "m a^2/T^3")
    | {"acceleration": "a/T^2", "mass": "m"}
)
"""Units of settings that a sweep may vary, by key; effects agree on them."""
MARGIN = 0.08  # beside the data, as a share of the axis
LEGEND_WIDTH = 1.6  # inches, beside the panels
WIDE_RANGE = 20.0  # ratio of largest to smallest value above which an axis is logarithmic


class Layout(NamedTuple):
    """Names of the coordinates of the horizontal axis, of series and of panels (None for a single
    panel), and the values of the last two by name."""

    over: str
    series: str
    panels: str | None
    values: Mapping[str, Sequence[Any]]


def draw(data: xr.Dataset, over: str | None = None, **chosen: Sequence[float]) -> Figure:
    """Draw R of a reduced dataset, or E_trans if particles do not spin, and return the figure.

    `over` is the horizontal axis, by default the third axis of the sweep, or else beta; `chosen`,
    values of r or beta to show. Raises InputError for axes and values that the data lack.
    """
    layout = layout_of(data, over, chosen)
    data = data.sel({layout.over: chosen_values(data, layout.over, chosen.get(layout.over))})
    numeric, axis = with_numeric_axis(data, layout.over)
    panels = layout.values[layout.panels] if layout.panels else [None]
    selections = [{layout.panels: value} if layout.panels else {} for value in panels]
    is_single = len(panels) == 1
    if "R" not in data:
        width = WIDTH if is_single else TWO_WIDE
        return _energy_figure(numeric, layout, axis, selections, width)
    contents = [
        _panel_content(numeric, layout, axis, selection, selection is selections[-1])
        for selection in selections
    ]
    contents[0] = contents[0]._replace(message=message_of(numeric, "R", layout.over))
    width = WIDTH + LEGEND_WIDTH if is_single else TWO_WIDE
    return panel.ratio_figure(*contents, width=width, rows=panel.rows_of(numeric))


def layout_of(data: xr.Dataset, over: str | None, chosen: Mapping[str, Sequence[float]]) -> Layout:
    """Return the layout of a figure of a reduced dataset: at most MAX_PANELS panels, of at most
    MAX_SERIES series each.

    Of more values an evenly spaced selection is drawn. Raises InputError as `draw`.
    """
    third = third_axis(data.attrs)
    names = [name for name in (third, *GRID_DIMS) if name]
    over = over or third or ("r" if data.sizes["beta"] == 1 < data.sizes["r"] else "beta")
    if over not in names:
        raise unknown_name_error("axis", over, names)
    other_axes = [name for name in ("beta", third, "r") if name and name != over]
    values = {name: chosen_values(data, name, chosen.get(name)) for name in other_axes}
    # the coordinate with more values becomes series, the other one panels
    other_axes.sort(key=lambda name: len(values[name]), reverse=True)
    chosen_few = {}
    for name, limit in zip(other_axes, (MAX_SERIES, MAX_PANELS), strict=False):
        chosen_few[name] = evenly_spaced(values[name], limit)
    return Layout(over, other_axes[0], other_axes[1] if len(other_axes) > 1 else None, chosen_few)


def evenly_spaced(values: Sequence[Any], number: int) -> list[Any]:
    """Return at most `number` values, evenly spaced among all, the first and the last included."""
    last = len(values) - 1
    return [values[k] for k in np.linspace(0, last, min(number, last + 1)).round().astype(int)]


def coordinates_not_shown(
    data: xr.Dataset, over: str | None, chosen: Mapping[str, Sequence[float]]
) -> list[str]:
    """Return a message for each coordinate of a reduced dataset whose values are not all drawn.
    Raises InputError as `draw`."""
    lines = []
    for name, drawn in layout_of(data, over, chosen).values.items():
        if len(drawn) < data.sizes[name]:
            values = ", ".join(value_text(value) for value in drawn)
            lines.append(f"{len(drawn)} of {data.sizes[name]} values of {name} are shown: {values}")
    return lines


def chosen_values(data: xr.Dataset, name: str, chosen: Sequence[float] | None) -> list[Any]:
    """Return the chosen values of the coordinate `name`, by default all. Raises InputError for
    values that the data lack."""
    available = data[name].values.tolist()
    for value in chosen or ():
        if value not in available:
            raise InputError(name, value, f"be one of {', '.join(map(value_text, available))}")
    return list(chosen or available)


def with_numeric_axis(data: xr.Dataset, over: str) -> tuple[xr.Dataset, panel.Axis]:
    """Return the data with words on the coordinate `over` replaced by their numbers, and the
    horizontal axis."""
    values, predefined = data[over].values, AXES.get(over)
    label = predefined.label if predefined else LABELS.get(over) or _label_of_setting(over)
    if values.dtype.kind not in "fiu":
        limits = -0.5, len(values) - 0.5
        numbered = data.assign_coords({over: np.arange(len(values))})
        return numbered, panel.Axis(over, label, limits, limits, words=values.tolist())
    if over == "beta":
        return data, panel.BETA
    low, high = float(values.min()), float(values.max())
    logarithmic = low > 0.0 and high / low > (
        1.0 if predefined and predefined.logarithmic else WIDE_RANGE
    )
    if logarithmic:
        limits = low * (low / high) ** MARGIN, high * (high / low) ** MARGIN
    else:
        margin = MARGIN * (high - low) or MARGIN * abs(high) or 1.0
        limits = low - margin, high + margin
    return data, panel.Axis(over, label, limits, (low, high) if high > low else limits, logarithmic)


def _label_of_setting(name: str) -> str:
    """Return the label of an axis over a setting: its name in words, and its unit."""
    return name.replace("_", " ") + _suffix_of(UNITS_OF_SETTINGS.get(name, ""))


def _panel_content(
    data: xr.Dataset, layout: Layout, axis: panel.Axis, selection: Record, last: bool
) -> panel.PanelContent:
    """Return the content of the panel at `selection`, values by coordinate; only the `last` panel
    has a legend."""
    drawn = [
        series(
            data, label_of(layout.series, value), line_style, **{layout.series: value}, **selection
        )
        for value, line_style in zip(layout.values[layout.series], LINE_STYLES, strict=False)
    ]
    options: Style = {
        "theories": f"lines: {equation_of(data.attrs).name}",
        "legend": {"loc": "outside"} if last else {},
        "axis": axis,
    }
    return panel.PanelContent(title_of_panel(data, selection), [data], drawn, **options)


def _energy_figure(data, layout, axis, selections, width) -> Figure:
    """Return a figure of E_trans of a gas whose particles do not spin, a panel for each of
    `selections`, values by coordinate.

    `axis` is the horizontal axis, `width` is in inches.
    """
    figure = Figure(figsize=(width, 0.7 * HEIGHT), layout="constrained")
    panels = figure.subplots(1, len(selections), sharey=True, squeeze=False)[0]
    for axes, selection in zip(panels, selections, strict=True):
        for value, line_style in zip(layout.values[layout.series], LINE_STYLES, strict=False):
            row = data.sel({layout.series: value, **selection})
            error = row.get("E_trans_stderr", np.nan * row.E_trans)
            style = {"color": line_style.colour, "fmt": line_style.marker, "capsize": 1.5}
            label = label_of(layout.series, value)
            axes.errorbar(row[layout.over], row.E_trans, error, label=label, **style)
        axis.prepare(axes)
        axes.legend()
        message = message_of(data, "Energy", layout.over) if selection is selections[0] else ""
        panel.add_title(axes, [data], title_of_panel(data, selection), message)
    panels[0].set_ylabel(r"$E_\mathrm{trans}$, per degree of freedom")
    return figure


def message_of(data: xr.Dataset, quantity: str, over: str) -> str:
    """Return the title of a figure, which names what is drawn: a quantity over the coordinate
    `over`, and the theory if the quantity is R."""
    theory = equation_of(data.attrs).name if quantity == "R" else ""
    return f"{quantity} over {panel.symbol_of(over)}" + (f", beside {theory}" if theory else "")


def title_of_panel(data: xr.Dataset, selection: Record) -> str:
    """Return the title of a panel: the experiment, and the values in `selection` by coordinate.

    An experiment of a study is called by its key, and by the study unless this has the same name.
    """
    study, _, key = data.attrs["experiment"].rpartition(".")
    if re.fullmatch(r"\D+_\d{4}", study):  # authors and year
        study = study.title()
    name = (key if study in ("", key) else f"{study}: {key}").replace("_", " ")
    return ", ".join(
        [
            f"{name[0].upper()}{name[1:]}",
            *(label_of(*coordinate) for coordinate in selection.items()),
        ]
    )


def label_of(name: str, value: Any) -> str:
    """Return a coordinate's name and value as a label; a value that is a word stands alone."""
    if isinstance(value, str):
        return value.replace("_", " ")
    symbol = panel.SYMBOLS.get(name)
    return rf"${symbol} = {value:g}$" if symbol else f"{name.replace('_', ' ')} {value:g}"


def value_text(value: Any) -> str:
    """Return the value of a coordinate, a number or a word, as text."""
    return value if isinstance(value, str) else f"{value:g}"


TIME_SERIES_SIZE, OBSERVABLE_SIZE = (6.0, 4.6), (6.0, 3.2)  # inches
MAX_TIMES = 400  # of a line; longer series are drawn as means over blocks
WINDOW_COLOUR = "#eeeeee"
ENERGIES = {"E_trans": r"$E_\mathrm{trans}$", "E_rot": r"$E_\mathrm{rot}$"}
SYMBOLS_OF_VARIABLES = ENERGIES | {
    "R": "$R$",
    "T_ratio_species": "$T_k/T_1$",
    "cos2_angle": r"$\langle\cos^2 \angle(V, \omega)\rangle$",
}
"""TeX of the symbols of variables."""
TRUST_NOTES = {0: ", not trusted", -1: ", whether to trust it is not known"}


def draw_point(point: xr.Dataset, theory: float) -> Figure:
    """Draw R and the energies of a point over time, with the window of the measurement shaded, and
    return the figure.

    `theory` is R of theory, NaN for none. Long series are drawn as means over blocks.
    """
    clock = next(name for name in CLOCKS[::-1] if name in point)
    cooling, spins = clock == "collisions_per_particle", "R_series" in point
    times = point[clock].values
    window = float(point.measured_from), float(point.get("plateau_end", times[-1]))
    block = math.ceil(times.size / MAX_TIMES)
    figure = Figure(figsize=TIME_SERIES_SIZE, layout="constrained")
    panels = figure.subplots(1 + spins, 1, sharex=True, squeeze=False)[:, 0]
    for axes in panels:
        axes.axvspan(*window, color=WINDOW_COLOUR, zorder=0)
        axes.set_xlim(
            times[0] - (times[-1] - times[0]) / 50, times[-1] + (times[-1] - times[0]) / 50
        )
    if spins:
        _ratio_over_time(panels[0], point, theory, times, block, window)
    _energies_over_time(panels[-1], point, times, block, cooling)
    panels[-1].set_xlabel("collisions per particle" if cooling else "time / $T$")
    title = f"{title_of_point(point)}\nshaded: where R is measured"
    averaged = f"; lines: means over {block} samples" if block > 1 else ""
    panels[0].set_title(title + averaged, fontsize=8)
    return figure


def _ratio_over_time(axes: Axes, point, theory, times, block, window) -> None:
    """Draw R over time into `axes`, with its mean, its 95 % interval, and R of theory (`theory`,
    NaN for none).

    `times` and R(t) are drawn as means over `block` samples; `window` has the first and the last
    time of the measurement.
    """
    line_style, R, half = LINE_STYLES[0], float(point.R), float(point.R_ci95)
    ratios = block_means(point.R_series.values, block)
    axes.plot(
        block_means(times, block), ratios, color=line_style.colour, linewidth=0.8, label="$R(t)$"
    )
    mean = Estimate(R, float(point.R_stderr))
    trust = TRUST_NOTES.get(int(point.get("R_ci95_trusted", 1)), "")
    axes.plot(window, (R, R), color=LINE_STYLES[1].colour, label=f"mean of $R(t)$: {mean}")
    band: Style = {"alpha": 0.3, "linewidth": 0.0, "label": f"95 % interval{trust}"}
    axes.fill_between(window, R - half, R + half, color=LINE_STYLES[1].colour, **band)
    if "R_collisional" in point:
        collisional = Estimate(float(point.R_collisional), float(point.R_collisional_stderr))
        style: Style = {"color": LINE_STYLES[2].colour, "linestyle": LINE_STYLES[2].line}
        axes.plot(window, [collisional.value] * 2, label=f"over collisions: {collisional}", **style)
    if math.isfinite(theory):
        name = equation_of(point.attrs, point).name
        axes.axhline(theory, color=THEORY, linestyle="--", label=f"{name}: {theory:.4f}")
    levels = [*ratios[np.isfinite(ratios)], R - half, R + half, theory]
    low, high = np.nanmin(levels), np.nanmax(levels)
    margin = 0.05 * ((high - low) or 0.1)
    axes.set(ylabel="$R$", ylim=(low - margin, high + margin))
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)


def _energies_over_time(axes: Axes, point, times, block, cooling) -> None:
    """Draw both energies of a point into `axes`, as means over `block` samples at `times`; on a
    logarithmic axis for a `cooling` gas."""
    for (name, label), line_style in zip(ENERGIES.items(), LINE_STYLES, strict=False):
        if f"{name}_series" in point:
            values = block_means(point[f"{name}_series"].values, block)
            style: Style = {
                "color": line_style.colour,
                "linestyle": line_style.line,
                "linewidth": 0.9,
            }
            axes.plot(block_means(times, block), values, label=label, **style)
    axes.set_ylabel(f"energy per degree of\nfreedom{unit_suffix(point.E_trans)}")
    axes.set_yscale("log" if cooling else "linear")
    if axes.lines:  # a shortened dataset may lack them
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)


def title_of_point(point: xr.Dataset) -> str:
    """Return a title: experiment, r, beta, number of particles and seed of a point."""
    attrs = point.attrs
    name = "/".join(attrs[key] for key in ("experiment", "variant") if key in attrs)
    position = rf"$r = {attrs['r']:g}$, $\beta = {attrs['beta']:g}$"
    return f"{name.replace('_', ' ')}: {position}, $N = {attrs['particles']}$, seed {attrs['seed']}"


def draw_observed(point: xr.Dataset, name: str) -> Figure:
    """Draw a point's variable `name` of an observable over its numeric coordinate, a line per
    species or pair, and return the figure.

    Bands are one standard error wide to either side, paler if the error is not trusted. Raises
    InputError for a variable without a numeric coordinate.
    """
    axes_of_variables = {
        str(variable): axis
        for variable in point.data_vars
        if (axis := _numeric_axis(point, variable))
    }
    if name not in axes_of_variables:
        observed = [variable for variable in axes_of_variables if f"{variable}_stderr" in point]
        raise unknown_name_error("--of", name, observed or axes_of_variables)
    axis = axes_of_variables[name]
    figure = Figure(figsize=OBSERVABLE_SIZE, layout="constrained")
    axes = figure.subplots()
    coordinate = point[axis].values
    values = point[name].transpose(..., axis)
    errors = point.get(f"{name}_stderr", values * np.nan).transpose(..., axis)
    trusted = panel.trusted(point, name).transpose(..., axis).values
    for number, index in enumerate(line_indices(values)):
        line_style = LINE_STYLES[number % len(LINE_STYLES)]
        line, error = values.values[index], errors.values[index]
        axes.plot(
            coordinate,
            line,
            color=line_style.colour,
            linestyle=line_style.line,
            label=line_label(values, index),
        )
        draw_errors(axes, coordinate, line, error, trusted[index], line_style.colour)
    axes.set(
        xlabel=f"{symbol_of_variable(axis)}{unit_suffix(point[axis])}",
        ylabel=f"{symbol_of_variable(name.removesuffix('_species'))}{unit_suffix(values)}",
    )
    axes.set_title(title_of_point(point), fontsize=8)
    if values.ndim > 1:
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    if not trusted.all():
        note = Patch(color=GREY, label=panel.key_of_trust().get_label(), **DOUBTFUL_BAND)
        figure.legend(handles=[note], loc="outside lower right")
    return figure


BAND: Style = {"alpha": 0.25, "linewidth": 0}
DOUBTFUL_BAND: Style = {"alpha": 0.08, "linewidth": 0}


def draw_errors(axes: Axes, coordinate, line, error, trusted, colour: str) -> None:
    """Draw a band of one standard error (`error`) to either side of the values `line`, paler next
    to values whose error is not trusted.

    `coordinate`, `line`, `error` and the mask `trusted` have equal shapes, (n,).
    """
    if not trusted.all():
        axes.fill_between(coordinate, line - error, line + error, color=colour, **DOUBTFUL_BAND)
    axes.fill_between(coordinate, line - error, line + error, where=trusted, color=colour, **BAND)


def _numeric_axis(point: xr.Dataset, name: Any) -> str | None:
    """Return the last dimension of the variable `name` of a point that has numeric coordinates;
    None without any."""
    dims = [str(dim) for dim in point[name].dims if dim in point.coords]
    return next((dim for dim in dims[::-1] if point[dim].dtype.kind in "fiu"), None)


def line_indices(values: xr.DataArray) -> list[tuple[int, ...]]:
    """Return the index of each line of a variable, over all dimensions but the last; pairs of
    species are in one order only."""
    indices, dims = np.ndindex(values.shape[:-1]), values.dims
    if "other" not in dims:
        return list(indices)
    first, second = dims.index("species"), dims.index("other")
    return [index for index in indices if index[first] <= index[second]]


def line_label(values: xr.DataArray, index: tuple[int, ...]) -> str:
    """Return the label of the line at `index` of a variable: its species, or other coordinates, by
    name or number."""
    names = ["species" if dim == "other" else dim for dim in values.dims[:-1]]
    pairs = zip(names, index, strict=True)
    return ", ".join(str(values[n].values[k]) if n in values.coords else str(k) for n, k in pairs)


def symbol_of_variable(name: str) -> str:
    """Return the symbol of a variable, such as a20 with indices, or else its name in words."""
    in_words = re.sub(r"^a(\d\d)\b", r"$a_{\1}$", name.replace("_", " "))
    return SYMBOLS_OF_VARIABLES.get(name, in_words)


def unit_suffix(values: xr.DataArray) -> str:
    """Return the unit of a variable as the end of an axis label, such as " / a"; "" without a
    unit."""
    return _suffix_of(unit_of(values.attrs))


def _suffix_of(unit: str) -> str:
    """Return a unit, with superscripts, as the end of an axis label; "" for a pure number."""
    if unit in ("", "1"):
        return ""
    text = re.sub(r"\^(-?\w+)", r"$^{\1}$", unit).replace("E_trans", ENERGIES["E_trans"])
    return f" / ({text})" if {" ", "/"} & {*unit} else f" / {text}"
