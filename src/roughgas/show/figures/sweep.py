"""Any dataset as a figure: R of a reduced one over an axis, or a point over time, beside theory;
what observables have found in a point."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from roughgas.base import InputError, not_one_of
from roughgas.data.netcdf import unit_of
from roughgas.data.reduced import GRID, third_axis
from roughgas.data.variables import CLOCKS, ENERGY, START
from roughgas.show.figures import panel
from roughgas.show.figures.panel import series
from roughgas.show.style import GREY, HEIGHT, LOOKS, THEORY, TWO_WIDE, WIDTH, Style
from roughgas.statistics.errors import Estimate, block_means
from roughgas.theory.prediction import equation_of

MOST_SERIES, MOST_PANELS = len(LOOKS), 3
KNOWN = {axis.name: axis for axis in (panel.BETA, panel.FRICTION, panel.INERTIA, panel.ROUGHNESS)}
LABELS = {
    "r": "normal restitution $r$",
    "particles": "number of particles $N$",
    "box": "width of the box / $a$",
    "spin_share": panel.SHARE_LABEL,
}
SYMBOLS = {"r": "r", "beta": r"\beta", "mu": r"\mu", "inertia": "q", "particles": "N"}
MARGIN = 0.08  # of an axis, beside the data
LEGEND = 1.6  # inches beside the panels
WIDE_RANGE = 20.0  # between the ends of an axis that is logarithmic


class Layout(NamedTuple):
    """What is drawn along the axis, as series, and as panels; and the chosen values of the rest."""

    over: str
    series: str
    panels: str | None
    values: Mapping[str, Sequence[Any]]


def draw(data: xr.Dataset, over: str | None = None, **chosen: Sequence[float]) -> Figure:
    """Draw R of a reduced dataset, or E_trans where nothing spins.

    `over` is the horizontal axis: the third axis of the sweep if there is one, else beta. `chosen`
    are values of r or beta to show. Raises InputError for axes and values that the data lack.
    """
    layout = arranged(data, over, chosen)
    data = data.sel({layout.over: _picked(data, layout.over, chosen.get(layout.over))})
    shown, axis = _numbered(data, layout.over)
    panels = layout.values[layout.panels] if layout.panels else [None]
    places = [{layout.panels: value} if layout.panels else {} for value in panels]
    width = WIDTH if len(panels) == 1 else 0.5 * TWO_WIDE * len(panels)
    if "R" not in data:
        return _energies(shown, layout, axis, places, width)
    parts = [_content(shown, layout, axis, place, place is places[-1]) for place in places]
    figure = panel.ratio_figure(*parts, width=width + LEGEND, averages=panel.averages_of(shown))
    _name_words(figure, data, layout.over)
    return figure


def arranged(data: xr.Dataset, over: str | None, chosen: Mapping[str, Sequence[float]]) -> Layout:
    """Return how a dataset is drawn: at most MOST_SERIES series in each of MOST_PANELS panels.

    Where there are more, those shown are spread evenly over all.
    """
    third = third_axis(data.attrs)
    names = [name for name in (third, *GRID) if name]
    over = over or third or "beta"
    if over not in names:
        raise not_one_of("axis", over, names)
    rest = [name for name in ("beta", third, "r") if name and name != over]
    values = {name: _picked(data, name, chosen.get(name)) for name in rest}
    # the one with most values as series, the other as panels
    rest.sort(key=lambda name: len(values[name]), reverse=True)
    few = {}
    for name, most in zip(rest, (MOST_SERIES, MOST_PANELS), strict=False):
        last = len(values[name]) - 1
        chosen_ones = np.linspace(0, last, min(most, last + 1)).round().astype(int)
        few[name] = [values[name][k] for k in chosen_ones]
    return Layout(over, rest[0], rest[1] if len(rest) > 1 else None, few)


def left_out(
    data: xr.Dataset, over: str | None, chosen: Mapping[str, Sequence[float]]
) -> list[str]:
    """Return a line for each coordinate of which not all values are drawn. Raises InputError."""
    lines = []
    for name, shown in arranged(data, over, chosen).values.items():
        if len(shown) < data.sizes[name]:
            some = ", ".join(_text(value) for value in shown)
            lines.append(f"{len(shown)} of {data.sizes[name]} values of {name} are shown: {some}")
    return lines


def _picked(data: xr.Dataset, name: str, wanted: Sequence[float] | None) -> list[Any]:
    """Return the values on an axis that are wanted, by default all."""
    known = data[name].values.tolist()
    for value in wanted or ():
        if value not in known:
            raise InputError(name, value, f"be one of {', '.join(map(_text, known))}")
    return list(wanted or known)


def _numbered(data: xr.Dataset, over: str) -> tuple[xr.Dataset, panel.Axis]:
    """Return the data with numbers along the axis, in place of words, and the axis."""
    values, known = data[over].values, KNOWN.get(over)
    label = known.label if known else LABELS.get(over, over.replace("_", " "))
    if values.dtype.kind not in "fiu":
        ends = -0.5, len(values) - 0.5
        numbered = data.assign_coords({over: np.arange(len(values))})
        return numbered, panel.Axis(over, label, ends, ends)
    if over == "beta":
        return data, panel.BETA
    low, high = float(values.min()), float(values.max())
    wide = low > 0.0 and high / low > (1.0 if known and known.logarithmic else WIDE_RANGE)
    if wide:
        ends = low * (low / high) ** MARGIN, high * (high / low) ** MARGIN
    else:
        room = MARGIN * (high - low) or MARGIN * abs(high) or 1.0
        ends = low - room, high + room
    return data, panel.Axis(over, label, ends, (low, high) if high > low else ends, wide)


def _name_words(figure: Figure, data: xr.Dataset, over: str) -> None:
    """Write the words of an axis below it, in place of their numbers."""
    words = data[over].values
    if words.dtype.kind in "fiu":
        return
    for axes in figure.axes:
        axes.set_xticks(range(len(words)), [word.replace("_", "\n") for word in words])
        axes.xaxis.minorticks_off()


def _content(
    data: xr.Dataset, layout: Layout, axis: panel.Axis, place: Mapping[str, Any], last: bool
) -> panel.PanelContent:
    drawn = [
        series(data, _label(layout.series, value), look, **{layout.series: value}, **place)
        for value, look in zip(layout.values[layout.series], LOOKS, strict=False)
    ]
    how: Style = {
        "theories": f"lines: {equation_of(data.attrs).name}",
        "legend": {"loc": "outside"} if last else {},
        "axis": axis,
    }
    return panel.PanelContent(_title(data, place), [data], drawn, **how)


def _energies(data, layout, axis, places, width) -> Figure:
    """Draw the energy of a gas whose particles do not spin."""
    figure = Figure(figsize=(width, 0.7 * HEIGHT), layout="constrained")
    every = figure.subplots(1, len(places), sharey=True, squeeze=False)[0]
    for axes, place in zip(every, places, strict=True):
        for value, look in zip(layout.values[layout.series], LOOKS, strict=False):
            row = data.sel({layout.series: value, **place})
            error = row.get("E_trans_stderr", np.nan * row.E_trans)
            style = {"color": look.colour, "fmt": look.marker, "capsize": 1.5}
            label = _label(layout.series, value)
            axes.errorbar(row[layout.over], row.E_trans, error, label=label, **style)
        axis.prepare(axes)
        axes.legend()
        panel.add_title(axes, [data], _title(data, place))
    every[0].set_ylabel(r"$E_\mathrm{trans}$, per degree of freedom")
    return figure


def _title(data: xr.Dataset, place: Mapping[str, Any]) -> str:
    name = data.attrs["experiment"].replace("_", " ")
    return ", ".join([f"{name[0].upper()}{name[1:]}", *(_label(*one) for one in place.items())])


def _label(name: str, value: Any) -> str:
    if isinstance(value, str):
        return value.replace("_", " ")
    symbol = SYMBOLS.get(name)
    return rf"${symbol} = {value:g}$" if symbol else f"{name.replace('_', ' ')} {value:g}"


def _text(value: Any) -> str:
    return value if isinstance(value, str) else f"{value:g}"


TIMELINE, LINES = (6.0, 4.6), (6.0, 3.2)  # inches
MOST_PLACES = 400  # places along a line
WINDOW = "#eeeeee"
ENERGIES = {"E_trans": r"$E_\mathrm{trans}$", "E_rot": r"$E_\mathrm{rot}$"}
UNITS = {START: r"initial $E_\mathrm{trans}$", ENERGY: r"($m a^2/T^2$)"}
TRUST = {0: ", not trusted", -1: ", whether to trust it is not known"}


def draw_point(point: xr.Dataset, theory: float) -> Figure:
    """Draw the time series of a point, the window in which it is measured shaded.

    `theory` is R of theory; NaN for none. A series of many samples is drawn as means over blocks.
    """
    clock = next(name for name in CLOCKS[::-1] if name in point)
    cooling, spins = clock == "collisions_per_particle", "R_series" in point
    at = point[clock].values
    window = float(point.measured_from), float(point.get("plateau_end", at[-1]))
    block = math.ceil(at.size / MOST_PLACES)
    figure = Figure(figsize=TIMELINE, layout="constrained")
    every = figure.subplots(1 + spins, 1, sharex=True, squeeze=False)[:, 0]
    for axes in every:
        axes.axvspan(*window, color=WINDOW, zorder=0)
        axes.set_xlim(at[0] - (at[-1] - at[0]) / 50, at[-1] + (at[-1] - at[0]) / 50)
    if spins:
        _ratio_over_time(every[0], point, theory, at, block, window)
    _energies_over_time(every[-1], point, at, block, cooling)
    every[-1].set_xlabel("collisions per particle" if cooling else "time / $T$")
    title = f"{title_of_point(point)}\nshaded: where R is measured"
    averaged = f"; lines: means over {block} samples" if block > 1 else ""
    every[0].set_title(title + averaged, fontsize=8)
    return figure


def _ratio_over_time(axes: Axes, point, theory, at, block, window) -> None:
    look, R, half = LOOKS[0], float(point.R), float(point.R_ci95)
    shown = block_means(point.R_series.values, block)
    axes.plot(block_means(at, block), shown, color=look.colour, linewidth=0.8, label="$R(t)$")
    mean = Estimate(R, float(point.R_stderr))
    trust = TRUST.get(int(point.get("R_ci95_trusted", 1)), "")
    axes.plot(window, (R, R), color=LOOKS[1].colour, label=f"mean of $R(t)$: {mean}")
    band: Style = {"alpha": 0.3, "linewidth": 0.0, "label": f"95 % interval{trust}"}
    axes.fill_between(window, R - half, R + half, color=LOOKS[1].colour, **band)
    if "R_collisional" in point:
        found = Estimate(float(point.R_collisional), float(point.R_collisional_stderr))
        about: Style = {"color": LOOKS[2].colour, "linestyle": LOOKS[2].line}
        axes.plot(window, [found.value] * 2, label=f"over collisions: {found}", **about)
    if math.isfinite(theory):
        name = equation_of(point.attrs, point).name
        axes.axhline(theory, color=THEORY, linestyle="--", label=f"{name}: {theory:.4f}")
    levels = [*shown[np.isfinite(shown)], R - half, R + half, theory]
    low, high = np.nanmin(levels), np.nanmax(levels)
    room = 0.05 * ((high - low) or 0.1)
    axes.set(ylabel="$R$", ylim=(low - room, high + room))
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)


def _energies_over_time(axes: Axes, point, at, block, cooling) -> None:
    for (name, label), look in zip(ENERGIES.items(), LOOKS, strict=False):
        if f"{name}_series" in point:
            values = block_means(point[f"{name}_series"].values, block)
            style: Style = {"color": look.colour, "linestyle": look.line, "linewidth": 0.9}
            axes.plot(block_means(at, block), values, label=label, **style)
    unit = UNITS.get(unit_of(point.E_trans.attrs), "1")
    axes.set_ylabel(f"energy per degree of\nfreedom / {unit}")
    axes.set_yscale("log" if cooling else "linear")
    if axes.lines:  # a point that was shortened may have none
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)


def title_of_point(point: xr.Dataset) -> str:
    """Return what a point is of."""
    about = point.attrs
    name = "/".join(about[key] for key in ("experiment", "variant") if key in about)
    place = rf"$r = {about['r']:g}$, $\beta = {about['beta']:g}$"
    return f"{name.replace('_', ' ')}: {place}, $N = {about['particles']}$, seed {about['seed']}"


def draw_observed(point: xr.Dataset, name: str) -> Figure:
    """Draw what an observable has found in a point over a coordinate, a line for each species or
    pair, with one standard error to either side, paler where that is not trusted.

    Raises InputError for a variable that is over no numbers.
    """
    known = {str(one): axis for one in point.data_vars if (axis := _axis(point, one))}
    if name not in known:
        shown = [one for one in known if f"{one}_stderr" in point]
        raise not_one_of("--of", name, shown or known)
    axis = known[name]
    figure = Figure(figsize=LINES, layout="constrained")
    axes = figure.subplots()
    at = point[axis].values
    values = point[name].transpose(..., axis)
    errors = point.get(f"{name}_stderr", values * np.nan).transpose(..., axis)
    trusted = panel.trusted(point, name).transpose(..., axis).values
    for number, place in enumerate(_places_of(values)):
        look = LOOKS[number % len(LOOKS)]
        line, error = values.values[place], errors.values[place]
        axes.plot(at, line, color=look.colour, linestyle=look.line, label=_line(values, place))
        _draw_errors(axes, at, line, error, trusted[place], look.colour)
    over, said = (one.replace("_", " ") for one in (axis, name.removesuffix("_species")))
    axes.set(xlabel=f"{over}{_unit(point[axis])}", ylabel=f"{said}{_unit(values)}")
    axes.set_title(title_of_point(point), fontsize=8)
    if values.ndim > 1:
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    if not trusted.all():
        note = Patch(color=GREY, label=panel.key_of_trust().get_label(), **DOUBTFUL)
        figure.legend(handles=[note], loc="outside lower right")
    return figure


BAND: Style = {"alpha": 0.25, "linewidth": 0}
DOUBTFUL: Style = {"alpha": 0.08, "linewidth": 0}


def _draw_errors(axes: Axes, at, line, error, trusted, colour: str) -> None:
    """Draw one standard error to either side of a line; paler from a value whose error is not
    trusted to the next."""
    if not trusted.all():
        axes.fill_between(at, line - error, line + error, color=colour, **DOUBTFUL)
    axes.fill_between(at, line - error, line + error, where=trusted, color=colour, **BAND)


def _axis(point: xr.Dataset, name: Any) -> str | None:
    """Return the last dimension of a variable that has numbers along it, None without any."""
    dims = [str(dim) for dim in point[name].dims if dim in point.coords]
    return next((dim for dim in dims[::-1] if point[dim].dtype.kind in "fiu"), None)


def _places_of(values: xr.DataArray) -> list[tuple[int, ...]]:
    """Return the index of each line; of a pair of species in one of the two orders."""
    places, dims = np.ndindex(values.shape[:-1]), values.dims
    if "other" not in dims:
        return list(places)
    one, other = dims.index("species"), dims.index("other")
    return [place for place in places if place[one] <= place[other]]


def _line(values: xr.DataArray, place: tuple[int, ...]) -> str:
    names = ["species" if dim == "other" else dim for dim in values.dims[:-1]]
    pairs = zip(names, place, strict=True)
    return ", ".join(str(values[n].values[k]) if n in values.coords else str(k) for n, k in pairs)


def _unit(values: xr.DataArray) -> str:
    unit = unit_of(values.attrs)
    return "" if unit in ("", "1") else f" / ({unit})" if " " in unit else f" / {unit}"
