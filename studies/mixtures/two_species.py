"""T and R of two species over the ratio of their masses or radii: the form of the figures of
mixtures."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.markers import TICKLEFT, TICKRIGHT

from roughgas import plotting
from roughgas.plotting import FAINT, LINE_STYLES, THEORY, LineStyle, key, species_at

SIZE = (7.0, 6.2)  # inches
LABELS = {
    "mass": "mass of heavy (2) / mass of light (1)",
    "radius": "radius of large (2) / radius of small (1)",
}
THEORY_POINTS = 25
"""Number of ratios at which theory is drawn."""
AXIS_MARGIN = 1.15
"""Factor by which an axis extends beyond the data."""
SMALL_MARKER, LARGE_MARKER = 3.0, 6.5
"""Marker sizes of the light or small species, and of the heavy or large one, which is paler."""
LINES = "-", "--"
DASHES = TICKLEFT, TICKRIGHT
"""Marks of theory for each species: LINES if it is known at any ratio, else dashes."""


class Column(NamedTuple):
    """One dataset of a figure, swept over `mass` or `radius` of its second species."""

    data: xr.Dataset
    title: str
    message: str = ""  # above the title

    @property
    def axis(self) -> str:
        """Name of the swept dimension."""
        return self.data.attrs["swept"].rpartition(".")[2]


def columns_figure(columns: Sequence[Column], theories: str) -> Figure:
    """Draw T_2/T_1 above, R of both species beneath, a column for each dataset.

    Theory of a cooling gas is drawn as lines, `mixture_cooling`; theory of a driven gas as dashes
    at the points, Lun's formula for mixtures at the measured temperatures.
    """
    figure = Figure(figsize=SIZE, layout="constrained")
    above, beneath = figure.subplots(2, len(columns), sharex="col", squeeze=False)
    second_species = []
    for upper, lower, column in zip(above, beneath, columns, strict=True):
        lower.sharey(beneath[0])
        rows = column.data.sel(r=plotting.RESTITUTION)
        for beta, look in zip(rows.beta.values, LINE_STYLES, strict=False):
            row = rows.sel(beta=beta)
            pair = [_series(row, k, look, column.axis) for k in (0, 1)]
            _draw_temperatures(upper, row, pair[1], column.axis)
            _draw_ratios(lower, row, pair, column.axis)
            second_species.append(pair[1])
        _finish(upper, lower, column)
    above[0].set_ylabel(r"$T_2/T_1$, translational")
    beneath[0].set_ylabel(r"$R$ of a species")
    cooling = columns[0].data.attrs["theory"] == "K"
    above[0].legend(handles=_keys_of_beta(second_species, cooling), loc="best")
    keys = _keys_of_species(theories, cooling)
    figure.legend(handles=keys, loc="outside lower center", ncols=2)
    figure.align_ylabels()
    return figure


def _series(row: xr.Dataset, k: int, look: LineStyle, axis: str) -> plotting.Series:
    """Return the series of one species along the axis, without theory."""
    species_data = row.isel(species=k)
    species_data = species_data.isel({axis: np.isfinite(species_data.T_ratio_species.values)})
    return plotting.Series("", look, species_data, species_data[axis].values, np.empty(0), np.empty)


def _draw_temperatures(axes: Axes, row: xr.Dataset, second: plotting.Series, axis: str) -> None:
    ratio = second.data.T_ratio_species.values
    plotting.draw_points(axes, second, second.x, ratio, average="T_ratio_species")
    if row.attrs["theory"] == "K":
        ratios = _theory_axis(row[axis].values)
        temperatures = np.array([_theory(row, {axis: x}).T_tr for x in ratios])
        look = second.line_style
        axes.plot(
            ratios, temperatures[:, 1] / temperatures[:, 0], color=look.colour, linestyle=look.line
        )


def _draw_ratios(axes: Axes, row: xr.Dataset, pair: list[plotting.Series], axis: str) -> None:
    small, large = pair
    large = large._replace(
        line_style=large.line_style._replace(colour=_pale_colour(large.line_style.colour))
    )
    for series, size in ((large, LARGE_MARKER), (small, SMALL_MARKER)):
        ratio = series.data.R_species.values
        plotting.draw_points(axes, series, series.x, ratio, size, average="R_species")
    cooling, colour = row.attrs["theory"] == "K", pair[0].line_style.colour
    ratios = _theory_axis(row[axis].values) if cooling else pair[0].x
    R = np.array([_theory(row, {axis: x}).R for x in ratios])
    for ratio, line, dash in zip(R.T, LINES, DASHES, strict=True):
        if cooling:
            axes.plot(ratios, ratio, color=colour, linestyle=line, linewidth=0.9)
        else:
            axes.plot(ratios, ratio, linestyle="none", marker=dash, color=colour, ms=9, mew=1.2)


def _pale_colour(colour: str) -> str:
    """Return a paler colour for the symbols of the second species, which lie behind the first."""
    red, green, blue = (0.5 + 0.5 * channel for channel in to_rgb(colour))
    return to_hex((red, green, blue))


def _theory(row: xr.Dataset, point: dict[str, float]):
    measured = None
    if row.attrs["theory"] != "K":
        measured = 2 * row.E_trans_species.sel(point).values
    return species_at(row.attrs, {"r": row.r.item(), "beta": row.beta.item()} | point, measured)


def _theory_axis(values: np.ndarray) -> np.ndarray:
    return np.geomspace(values.min(), values.max(), THEORY_POINTS)


def _finish(upper: Axes, lower: Axes, column: Column) -> None:
    values = column.data[column.axis].values
    upper.axhline(1, color=FAINT, linewidth=0.8, linestyle=plotting.DOTS, zorder=0)
    lower.axhline(0.5, color=FAINT, linewidth=0.8, linestyle=plotting.DOTS, zorder=0)
    lower.set_xscale("log")
    lower.set_xlim(values.min() / AXIS_MARGIN, values.max() * AXIS_MARGIN)
    lower.set_xticks(values, [f"{x:g}" for x in values])
    lower.minorticks_off()
    lower.set_xlabel(LABELS[column.axis])
    title = f"{column.title}, $r = {plotting.RESTITUTION:g}$"
    plotting.add_title(upper, [column.data], title, column.message)


def _keys_of_beta(drawn: Sequence[plotting.Series], cooling: bool) -> list:
    """Return the keys of colours, with lines of theory if it is known at any ratio, and of open
    symbols if there are any."""
    looks = {float(series.data.beta): series.line_style for series in drawn}
    keys = [
        key(look.colour, rf"$\beta = {beta:g}$", look.marker, look.line if cooling else "none")
        for beta, look in looks.items()
    ]
    return keys + plotting.keys_of_steadiness(drawn)


def _keys_of_species(theories: str, cooling: bool) -> list:
    """Return the legend's keys of the species, and of theory for each."""
    looks = (
        (SMALL_MARKER, THEORY, "1: light or small"),
        (LARGE_MARKER, _pale_colour(THEORY), "2: heavy or large"),
    )
    keys = [key(colour, name, "o", ms=size) for size, colour, name in looks]
    keys.append(key(FAINT, "equipartition", "", plotting.DOTS))
    for number, line, dash, side in zip((1, 2), LINES, DASHES, ("left", "right"), strict=True):
        label = f"{theories}, {number}"
        if cooling:
            keys.append(key(THEORY, label, "", line))
        else:
            keys.append(key(THEORY, f"{label}: dash to the {side}", dash, ms=9, mew=1.2))
    return keys
