"""Figures of any variables of a reduced dataset, a row of panels for each.

A variable is drawn over an axis of the sweep, with a series for each value of another axis, or, if
it has a numeric coordinate of its own, as a profile has its height, along this coordinate, with a
line for each value of the axis. Other dimensions, such as species, make further series and lines.

`over` and `chosen` are as in roughgas.show.figures.sweep.
"""

from collections.abc import Iterator, Mapping, Sequence
from textwrap import wrap
from types import MappingProxyType
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D

from roughgas.base import Record
from roughgas.data.reduced import check_swept, observed_names, sweep_axes
from roughgas.data.variables import third_axis
from roughgas.show.figures import panel, sweep
from roughgas.show.style import GREY, LINE_STYLES, TWO_WIDE, WIDTH, LineStyle, Style
from roughgas.theory.prediction import equation_of, predicted_ratio

BESIDE_POINTS: Style = {"marker": "_", "linestyle": "none", "ms": 11, "mew": 1.2}
BENEATH_LINES: Style = {"marker": "", "linestyle": ":", "lw": 2.6}
"""Styles of theory of a variable: dashes at the points of a sweep, since it is not known between
them, and dots along its own coordinate, wider than the line on them."""
THEORY = "_theory"
"""End of the names of variables that hold theory beside a variable."""
DECADES = 3
"""Powers of ten above which a vertical axis is logarithmic."""
MAX_ROWS = 5
COMPONENT_STYLES = (
    *LINE_STYLES,
    LineStyle(GREY, "P", (0, (3, 2))),
    LineStyle(GREY, "X", (0, (14, 3))),
    LineStyle(GREY, "<", (0, (8, 2, 2, 2))),
    LineStyle(GREY, ">", (0, (8, 2, 2, 2, 2, 2))),
    LineStyle(GREY, "*", (0, (3, 5))),
)
"""Markers and lines of the components of a variable, which have the colour of their series; a
variable with more components is drawn in part."""
ROW_HEIGHT, TITLE_HEIGHT = 1.75, 0.75  # inches: MAX_ROWS fit on a page
LETTERS_PER_INCH = 13  # of the title


Theories = Mapping[str, xr.DataArray]
"""Theory of variables, by their names: see roughgas.claims.variables."""


def drawn_by_default(data: xr.Dataset, theories: Theories = MappingProxyType({})) -> list[str]:
    """Return the variables of a figure of a reduced dataset for which none are named.

    They are those with `theories`, then R, or else E_trans, and the results of observables: first
    those that are drawn over the sweep.
    """
    observed = observed_names(data)
    observed.sort(key=lambda name: _coordinate(data, name) is not None)
    names = [*theories, "R" if "R" in data else "E_trans", *observed]
    return [*dict.fromkeys(names)][:MAX_ROWS]


def not_shown(
    data: xr.Dataset, names: Sequence[str], over: str | None, chosen: Mapping[str, Sequence[float]]
) -> list[str]:
    """Return a message for all that a figure of `names` leaves out of a reduced dataset."""
    lines = sweep.coordinates_not_shown(data, over, chosen)
    profiles = [name for name in names if _coordinate(data, name)]
    layout = sweep.layout_of(data, over, chosen)
    values = sweep.chosen_values(data, layout.over, chosen.get(layout.over))
    few = sweep.evenly_spaced(values, len(LINE_STYLES))
    if profiles and len(few) < len(values):
        count = f"{len(few)} of {len(values)} values of {layout.over}"
        texts = ", ".join(map(sweep.value_text, few))
        lines.append(f"{', '.join(profiles)}: {count} are shown: {texts}")
    if profiles and len(layout.values[layout.series]) > 1:
        value = sweep.value_text(_middle(layout.values[layout.series]))
        lines.append(f"{', '.join(profiles)}: {layout.series} = {value} alone is shown")
    if left_out := [name for name in observed_names(data) if name not in names]:
        lines.append(f"not shown: {', '.join(left_out)} (--of names what to draw)")
    return lines


def draw(
    data: xr.Dataset,
    names: Sequence[str],
    over: str | None = None,
    theories: Theories = MappingProxyType({}),
    **chosen: Sequence[float],
) -> Figure:
    """Draw the variables `names` of a reduced dataset, a row for each, and return the figure.

    `theories` are lines beside variables. Raises InputError for names, axes and values that the
    data lack.
    """
    for name in names:
        check_swept(data, name)
    layout = sweep.layout_of(data, over, chosen)
    values = sweep.chosen_values(data, layout.over, chosen.get(layout.over))
    data = data.assign({name + THEORY: line for name, line in theories.items()})
    data = data.sel({layout.over: values})
    numeric, axis = sweep.with_numeric_axis(data, layout.over)
    panels = layout.values[layout.panels] if layout.panels else [None]
    selections: list[Record] = [{layout.panels: value} if layout.panels else {} for value in panels]
    width = WIDTH + sweep.LEGEND_WIDTH if len(panels) == 1 else TWO_WIDE
    size = width, TITLE_HEIGHT + ROW_HEIGHT * len(names)
    beside_legends = 0.0, 0.0, 1.0 - sweep.LEGEND_WIDTH / width, 1.0
    figure = Figure(figsize=size, layout=ConstrainedLayoutEngine(rect=beside_legends))
    grid = figure.subplots(len(names), len(panels), sharey="row", squeeze=False)
    for row, name in zip(grid, names, strict=True):
        for axes, selection in zip(row, selections, strict=True):
            if coordinate := _coordinate(data, name):
                _draw_along(axes, data, name, coordinate, layout, selection)
            else:
                _draw_over(axes, numeric, name, axis, layout, selection)
        if _spans_decades(data[name]):
            row[0].set_yscale("log")  # of the whole row, which shares the axis
        label = sweep.symbol_of_variable(name)
        row[0].set_ylabel(f"{label}\n{sweep.unit_suffix(data[name])}".rstrip(), fontsize=8)
        legend = row[-1].legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
        legend.set_in_layout(False)  # beside the last column, whose width it leaves alone
    for axes, selection in zip(grid[0], selections, strict=True):
        panel.add_title(axes, [data], sweep.title_of_panel(data, selection))
    message = wrap(_message(data, names, layout.over, theories), int(width * LETTERS_PER_INCH))
    figure.suptitle("\n".join(message), x=0.01, ha="left", fontsize=8.5, fontweight="bold")
    figure.align_ylabels()
    if keys := [*_keys_of_theory(data, names), *_keys_of_trust(data, names)]:
        figure.legend(handles=keys, loc="outside lower right", ncols=min(len(keys), 2))
    return figure


def _keys_of_theory(data: xr.Dataset, names: Sequence[str]) -> list[Line2D]:
    """Return a legend key for each style of theory, which names the variables or the equation."""
    with_theory = [name for name in names if name + THEORY in data]
    along = [name for name in with_theory if _coordinate(data, name)]
    over = [name for name in with_theory if name not in along]
    styles = (("dashes", over, BESIDE_POINTS), ("dots", along, BENEATH_LINES))
    keys = [
        Line2D([], [], color=GREY, label=f"{mark}: theory of {_listed(group)}", **style)
        for mark, group, style in styles
        if group
    ]
    if "R" in names and "R" not in with_theory and _has_theory(data):
        keys.append(panel.key(GREY, f"lines: $R$ of {equation_of(data.attrs).name}", "", "-"))
    return keys


def _keys_of_trust(data: xr.Dataset, names: Sequence[str]) -> list[Line2D]:
    """Return a legend key of errors that are not trusted; [] if all are."""
    all_trusted = all(panel.trusted(data, name).all() for name in names)
    label = "paler bars or bands: not trusted"
    return [] if all_trusted else [panel.key(GREY, label, "|", ms=9, **panel.NOT_TRUSTED)]


def _coordinate(data: xr.Dataset, name: str) -> str | None:
    """Return the last numeric coordinate of a variable besides those of the sweep; None without.

    A dimension without coordinates counts as its indices.
    """
    dims = [str(dim) for dim in data[name].dims if dim not in sweep_axes(data)]
    return next((dim for dim in dims[::-1] if data[dim].dtype.kind in "fiu"), None)


def _draw_over(
    axes: Axes,
    data: xr.Dataset,
    name: str,
    axis: panel.Axis,
    layout: sweep.Layout,
    selection: Record,
) -> None:
    """Draw a variable with error bars over an axis of the sweep, at the `selection` of a panel.

    R is drawn with the lines of theory. Components have the colour of their series, and a key each.
    """
    axis.prepare(axes)
    components: dict[str, str] = {}
    for value, style in zip(layout.values[layout.series], LINE_STYLES, strict=False):
        label = sweep.label_of(layout.series, value)
        row = data.sel({layout.series: value, **selection})
        if name + THEORY in data:
            for line, *_ in _lines(row, name + THEORY, layout.over):
                common: Style = {"color": style.colour, "zorder": 1}
                axes.plot(row[layout.over].values, line, **common, **BESIDE_POINTS)
        elif name in panel.averages_of(data):
            curve = panel.series(data, label, style, **{layout.series: value}, **selection)
            panel.draw_theory(panel.Panel(axes, (), axis), [curve])
        for line, error, trusted, text, inner in _lines(row, name, layout.over):
            marked = style._replace(marker=inner.marker) if text else style
            components |= {text: inner.marker} if text else {}
            name_of_bars = "" if text else label
            _draw_bars(axes, row[layout.over].values, line, error, trusted, marked, name_of_bars)
        if components:
            axes.plot([], [], color=style.colour, lw=4, label=label)
    for text, marker in components.items():
        axes.plot([], [], marker, color=GREY, ms=3.6, label=text)


def _draw_bars(axes: Axes, x, values, errors, trusted, style: LineStyle, label: str) -> None:
    """Draw `values` at `x`, (n,), with error bars; bars that are not `trusted` are paler."""
    common: Style = {"color": style.colour, "capsize": 1.5, "elinewidth": 0.8}
    bars = np.where(trusted, errors, np.nan)
    axes.errorbar(x, values, bars, fmt=style.marker, ms=3.6, label=label, **common)
    if not trusted.all():
        bars = np.where(trusted, np.nan, errors)
        axes.errorbar(x, values, bars, fmt="none", **common, **panel.NOT_TRUSTED)


def _draw_along(
    axes: Axes,
    data: xr.Dataset,
    name: str,
    coordinate: str,
    layout: sweep.Layout,
    selection: Record,
) -> None:
    """Draw a variable along its own coordinate, a line for each of a few values of the sweep.

    These are values of the axis `over`, in the middle of the series of the figure, at the
    `selection` of a panel.
    """
    middle = {layout.series: _middle(layout.values[layout.series])}
    x = data[coordinate].values
    few = sweep.evenly_spaced(data[layout.over].values.tolist(), len(LINE_STYLES))
    first = few[0]
    for value, style in zip(few, LINE_STYLES, strict=False):
        label = sweep.label_of(layout.over, value)
        row = data.sel({layout.over: value, **middle, **selection})
        for number, (line, error, trusted, text, inner) in enumerate(_lines(row, name, coordinate)):
            # the first value explains the styles of lines, which other values share
            words = [label] * (number == 0) + [text] * bool(text and value == first)
            options: Style = {"color": style.colour, "linestyle": inner.line if text else "-"}
            axes.plot(x, line, label=", ".join(words) or None, **options)
            sweep.draw_errors(axes, x, line, error, trusted, style.colour)
        if name + THEORY in data:
            for line, *_ in _lines(row, name + THEORY, coordinate):
                axes.plot(x, line, color=style.colour, zorder=1, **BENEATH_LINES)
    label = sweep.symbol_of_variable(coordinate)
    axes.set_xlabel(f"{label}{sweep.unit_suffix(data[coordinate])}")


def _lines(
    row: xr.Dataset, name: str, along: str
) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray, str, LineStyle]]:
    """Yield values, errors and trust, (n,) each `along` a dimension, label and style of each line.

    The label names the other dimensions of the variable, as species; there are at most as many
    lines as COMPONENT_STYLES.
    """
    values = row[name].transpose(..., along)
    errors = row.get(f"{name}_stderr", values * np.nan).transpose(..., along).values
    trusted = panel.trusted(row, name).transpose(..., along).values
    for style, index in zip(COMPONENT_STYLES, sweep.line_indices(values), strict=False):
        label = sweep.line_label(values, index)
        yield values.values[index], errors[index], trusted[index], label, style


def _message(data: xr.Dataset, names: Sequence[str], over: str, theories: Theories) -> str:
    """Return the title of a figure, which names the variables, the axis, and the theory.

    Variables with `theories` of a study stand beside these, R without one beside the package's.
    """
    text = _listed(names)
    text = text[0].upper() + text[1:]
    if all(name in theories for name in names):
        return f"{text} over {panel.symbol_of(over)}, beside theory"
    with_theory = [name for name in names if name in theories]
    comparisons = [f"{_listed(with_theory)} beside theory"] if with_theory else []
    if "R" in names and "R" not in theories and _has_theory(data):
        comparisons.append(f"$R$ beside {equation_of(data.attrs).name}")
    return ", ".join([f"{text} over {panel.symbol_of(over)}", *comparisons])


def _listed(names: Sequence[str]) -> str:
    """Return the symbols of variables as a list in words."""
    *first, last = map(sweep.symbol_of_variable, names)
    return f"{', '.join(first)} and {last}" if first else last


def _spans_decades(values: xr.DataArray) -> bool:
    """Return whether values are positive and span more than DECADES."""
    low, high = float(values.min()), float(values.max())
    return 0.0 < low < high * 10.0**-DECADES


def _has_theory(data: xr.Dataset) -> bool:
    """Return whether the package has a theory of R of the last point of the sweep."""
    third = third_axis(data.attrs)
    swept = {third: data[third].values[-1]} if third else {}
    ratio = predicted_ratio(data.attrs | swept, data.r.values[-1:], data.beta.values[-1:])
    return bool(np.isfinite(ratio).all())


def _middle(values: Sequence[Any]) -> Any:
    """Return the value in the middle of a list."""
    return values[len(values) // 2]
