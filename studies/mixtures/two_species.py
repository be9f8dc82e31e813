"""T and R of two species over what they differ in: the form that figures of mixtures share."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.markers import TICKLEFT, TICKRIGHT

from roughgas import plotting
from roughgas.plotting import FAINT, LOOKS, THEORY, Look, key, species_at

SIZE = (7.0, 6.2)  # inches
LABELS = {
    "mass": "mass of heavy (2) / mass of light (1)",
    "radius": "radius of large (2) / radius of small (1)",
}
FINE = 25
"""Ratios at which theory is drawn."""
ROOM = 1.15
"""Factor that an axis goes on beyond the data."""
SMALL, LARGE = 3.0, 6.5
"""Marker sizes of the light or small species, and of the heavy or large one, which is paler."""
LINES = "-", "--"
DASHES = TICKLEFT, TICKRIGHT
"""What stands for theory, of each species: lines where it is known at any ratio, else dashes."""


class Column(NamedTuple):
    """One dataset of a figure, over `mass` or `radius` of its second species."""

    data: xr.Dataset
    title: str
    message: str = ""  # on T_2/T_1
    of_ratios: str = ""  # on R

    @property
    def axis(self) -> str:
        """What is swept."""
        return self.data.attrs["swept"].rpartition(".")[2]


def columns_figure(columns: Sequence[Column], theories: str) -> Figure:
    """Draw T_2/T_1 above, R of both species beneath, a column for each dataset.

    Theory is lines of a cooling gas, `mixture_cooling`; of a driven one dashes at the points, Lun's
    formula for mixtures from the measured temperatures.
    """
    figure = Figure(figsize=SIZE, layout="constrained")
    above, beneath = figure.subplots(2, len(columns), sharex="col", squeeze=False)
    every = []
    for upper, lower, column in zip(above, beneath, columns, strict=True):
        lower.sharey(beneath[0])
        rows = column.data.sel(r=plotting.RESTITUTION)
        for beta, look in zip(rows.beta.values, LOOKS, strict=False):
            row = rows.sel(beta=beta)
            both = [_series(row, k, look, column.axis) for k in (0, 1)]
            _draw_temperatures(upper, row, both[1], column.axis)
            _draw_ratios(lower, row, both, column.axis)
            every.append(both[1])
        _finish(upper, lower, column)
    above[0].set_ylabel(r"$T_2/T_1$, translational")
    beneath[0].set_ylabel(r"$R$ of a species")
    above[0].legend(handles=_keys_of_beta(every), loc="best")
    cooling = columns[0].data.attrs["theory"] == "K"
    figure.legend(handles=_keys_of_species(theories, cooling), loc="outside lower center", ncols=2)
    figure.align_ylabels()
    return figure


def _series(row: xr.Dataset, k: int, look: Look, axis: str) -> plotting.Series:
    """Return one species along the axis, without theory."""
    one = row.isel(species=k)
    one = one.isel({axis: np.isfinite(one.T_ratio_species.values)})
    return plotting.Series("", look, one, one[axis].values, np.empty(0), np.empty)


def _draw_temperatures(axes: Axes, row: xr.Dataset, second: plotting.Series, axis: str) -> None:
    ratio = second.data.T_ratio_species.values
    plotting.draw_points(axes, second, second.at, ratio, average="T_ratio_species")
    if row.attrs["theory"] == "K":
        at = _fine(row[axis].values)
        found = np.array([_theory(row, {axis: x}).T_tr for x in at])
        look = second.look
        axes.plot(at, found[:, 1] / found[:, 0], color=look.colour, linestyle=look.line)


def _draw_ratios(axes: Axes, row: xr.Dataset, both: list[plotting.Series], axis: str) -> None:
    small, large = both
    large = large._replace(look=large.look._replace(colour=_pale(large.look.colour)))
    for one, size in ((large, LARGE), (small, SMALL)):
        ratio = one.data.R_species.values
        plotting.draw_points(axes, one, one.at, ratio, size, average="R_species")
    cooling, colour = row.attrs["theory"] == "K", both[0].look.colour
    at = _fine(row[axis].values) if cooling else both[0].at
    found = np.array([_theory(row, {axis: x}).R for x in at])
    for ratio, line, dash in zip(found.T, LINES, DASHES, strict=True):
        if cooling:
            axes.plot(at, ratio, color=colour, linestyle=line, linewidth=0.9)
        else:
            axes.plot(at, ratio, linestyle="none", marker=dash, color=colour, ms=9, mew=1.2)


def _pale(colour: str) -> str:
    """Return what symbols of the second species have, on which those of the first are seen."""
    red, green, blue = (0.5 + 0.5 * part for part in to_rgb(colour))
    return to_hex((red, green, blue))


def _theory(row: xr.Dataset, place: dict[str, float]):
    measured = None
    if row.attrs["theory"] != "K":
        measured = 2 * row.E_trans_species.sel(place).values
    return species_at(row.attrs, {"r": row.r.item(), "beta": row.beta.item()} | place, measured)


def _fine(values: np.ndarray) -> np.ndarray:
    return np.geomspace(values.min(), values.max(), FINE)


def _finish(upper: Axes, lower: Axes, column: Column) -> None:
    values = column.data[column.axis].values
    upper.axhline(1, color=FAINT, linewidth=0.8, linestyle=plotting.DOTS, zorder=0)
    lower.axhline(0.5, color=FAINT, linewidth=0.8, linestyle=plotting.DOTS, zorder=0)
    lower.set_xscale("log")
    lower.set_xlim(values.min() / ROOM, values.max() * ROOM)
    lower.set_xticks(values, [f"{x:g}" for x in values])
    lower.minorticks_off()
    lower.set_xlabel(LABELS[column.axis])
    title = f"{column.title}, $r = {plotting.RESTITUTION:g}$"
    plotting.add_title(upper, [column.data], title, column.message)
    lower.set_title(column.of_ratios, fontsize=8.5, fontweight="bold", loc="left")


def _keys_of_beta(every: Sequence[plotting.Series]) -> list:
    """Return what colours are, and open symbols if there are any."""
    looks = {float(one.data.beta): one.look for one in every}
    keys = [key(look.colour, rf"$\beta = {beta:g}$", look.marker) for beta, look in looks.items()]
    return keys + plotting.keys_of_steadiness(every)


def _keys_of_species(theories: str, cooling: bool) -> list:
    """Return what stands for the species, and for theory of each."""
    looks = (SMALL, THEORY, "1: light or small"), (LARGE, _pale(THEORY), "2: heavy or large")
    keys = [key(colour, name, "o", ms=size) for size, colour, name in looks]
    for number, line, dash, side in zip((1, 2), LINES, DASHES, ("left", "right"), strict=True):
        label = f"{theories}, {number}"
        if cooling:
            keys.append(key(THEORY, label, "", line))
        else:
            keys.append(key(THEORY, f"{label}: dash to the {side}", dash, ms=9, mew=1.2))
    return keys
