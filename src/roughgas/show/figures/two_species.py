"""T and R of two species over what they differ in: the form that figures of mixtures share."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from roughgas.show.figures import panel
from roughgas.show.style import FAINT, LOOKS, THEORY, Look, Style
from roughgas.theory.prediction_of_mixtures import species_at

SIZE = (7.6, 5.6)  # inches
LABELS = {"mass": "ratio of the masses", "radius": "ratio of the radii"}
FINE = 25
"""Ratios at which theory is drawn."""
ROOM = 1.15
"""Factor that an axis goes on beyond the data."""


class Column(NamedTuple):
    """One dataset of a figure, over `mass` or `radius` of its second species."""

    data: xr.Dataset
    title: str
    message: str = ""

    @property
    def axis(self) -> str:
        """What is swept."""
        return self.data.attrs["swept"].rpartition(".")[2]

    @property
    def names(self) -> list[str]:
        """What the species are called."""
        return [str(name) for name in self.data.species.values]


def columns_figure(columns: Sequence[Column], theories: str) -> Figure:
    """Draw T_2/T_1 above, R of both species beneath, a column for each dataset.

    Lines are theory: of a cooling gas `mixture_cooling`; of a driven one Lun's formula for
    mixtures, from the measured temperatures, at the points alone.
    """
    figure = Figure(figsize=SIZE, layout="constrained")
    above, beneath = figure.subplots(2, len(columns), sharex="col", sharey="row", squeeze=False)
    for upper, lower, column in zip(above, beneath, columns, strict=True):
        rows = column.data.sel(r=panel.RESTITUTION)
        for beta, look in zip(rows.beta.values, LOOKS, strict=False):
            row = rows.sel(beta=beta)
            _draw_temperatures(upper, row, look, column.axis)
            _draw_ratios(lower, row, look, column.axis)
        _finish(upper, lower, column)
    above[0].set_ylabel(r"$T_2/T_1$, translational")
    beneath[0].set_ylabel(r"$R$ of a species")
    above[0].legend(loc="upper left")
    beneath[0].legend(*_keys(columns[0].data), loc="upper left", ncols=2, title=theories)
    low, high = beneath[0].get_ylim()
    beneath[0].set_ylim(low, high + 0.35 * (high - low))
    figure.align_ylabels()
    return figure


def ratio_of(row: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Return T_2/T_1 along an axis, and its standard error, (n,) each."""
    first, second = (row.E_trans_species.isel(species=k).values for k in (0, 1))
    relative = [row.E_trans_species_stderr.isel(species=k).values for k in (0, 1)]
    ratio = second / first
    return ratio, ratio * np.hypot(relative[0] / first, relative[1] / second)


def _draw_temperatures(axes: Axes, row: xr.Dataset, look: Look, axis: str) -> None:
    ratio, error = ratio_of(row)
    label = rf"$\beta = {row.beta.item():g}$"
    axes.errorbar(row[axis], ratio, error, label=label, **_bars(look))
    if row.attrs["theory"] == "K":
        at = _fine(row[axis].values)
        found = np.array([_theory(row, {axis: x}).T_tr for x in at])
        axes.plot(at, found[:, 1] / found[:, 0], color=look.colour, linestyle=look.line)


def _draw_ratios(axes: Axes, row: xr.Dataset, look: Look, axis: str) -> None:
    for k, fill in ((0, look.colour), (1, "white")):
        one = row.isel(species=k)
        style = _bars(look, markerfacecolor=fill, zorder=3)
        axes.errorbar(row[axis], one.R_species, one.R_species_stderr, **style)
    cooling = row.attrs["theory"] == "K"
    at = _fine(row[axis].values) if cooling else row[axis].values
    found = np.array([_theory(row, {axis: x}).R for x in at])
    for k, line in ((0, "-"), (1, "--")):
        axes.plot(at, found[:, k], color=look.colour, linestyle=line, linewidth=0.9)


def _bars(look: Look, **more: Any) -> Style:
    return {"color": look.colour, "fmt": look.marker, "capsize": 1.5, "elinewidth": 0.8} | more


def _theory(row: xr.Dataset, place: dict[str, float]):
    measured = None
    if row.attrs["theory"] != "K":
        measured = 2 * row.E_trans_species.sel(place).values
    return species_at(row.attrs, {"r": row.r.item(), "beta": row.beta.item()} | place, measured)


def _fine(values: np.ndarray) -> np.ndarray:
    return np.geomspace(values.min(), values.max(), FINE)


def _finish(upper: Axes, lower: Axes, column: Column) -> None:
    values = column.data[column.axis].values
    upper.axhline(1, color=FAINT, linewidth=0.8, linestyle=panel.DOTS, zorder=0)
    lower.axhline(0.5, color=FAINT, linewidth=0.8, linestyle=panel.DOTS, zorder=0)
    lower.set_xscale("log")
    lower.set_xlim(values.min() / ROOM, values.max() * ROOM)
    lower.set_xticks(values, [f"{x:g}" for x in values])
    lower.minorticks_off()
    lower.set_xlabel(LABELS[column.axis])
    first, second = column.names
    title = f"{column.title}, $r = {panel.RESTITUTION:g}$, 1 {first}, 2 {second}"
    panel.add_title(upper, [column.data], title, column.message)


def _keys(data: xr.Dataset) -> tuple[list[Line2D], list[str]]:
    first, second = (str(name) for name in data.species.values)
    common: Style = {"color": THEORY, "marker": "o"}
    filled = Line2D([], [], linestyle="-", **common)
    hollow = Line2D([], [], linestyle="--", markerfacecolor="white", **common)
    return [filled, hollow], [f"1: {first} (small)", f"2: {second} (large)"]
