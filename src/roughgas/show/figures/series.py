"""Measured R along one axis, beside theory: what figures of R draw."""

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from roughgas.data.reduced import EQUILIBRATED
from roughgas.show.style import LOOKS, Look
from roughgas.theory.prediction import predicted_ratio

RESTITUTION = 0.9
"""The r of figures that show only one, where it is in the data."""


class Series(NamedTuple):
    """Measured R along an axis, beside theory, and how it is drawn."""

    label: str
    look: Look
    data: xr.Dataset  # (n,) along the axis
    at: np.ndarray  # (n,) where it is drawn
    theory: np.ndarray  # (n,) predicted R
    predict: Callable[..., np.ndarray]  # R of theory at other values of the axis, given by name

    @property
    def residual(self) -> np.ndarray:
        """Measured minus predicted R, (n,)."""
        return self.residual_of("R")

    def residual_of(self, average: str) -> np.ndarray:
        """Return the same of another average of R, called so in the data."""
        return self.data[average].values - self.theory

    def error_of(self, average: str) -> np.ndarray:
        """Return its standard errors, (n,); NaN where the data have none."""
        return self.data.get(f"{average}_stderr", math.nan * self.data.R).values

    @property
    def steady(self) -> np.ndarray:
        """Whether a steady state was found, (n,)."""
        return self.data.equilibrated.values > EQUILIBRATED

    @property
    def known(self) -> np.ndarray:
        """Whether there was evidence to tell, (n,)."""
        return self.data.equilibrated.values >= 0

    @property
    def touched(self) -> np.ndarray:
        """Whether the contact-time model acted, (n,)."""
        return self.data.get("contact_time_fraction", 0 * self.data.R).values > 0


def series(data: xr.Dataset, label: str, look: Look, **place: Any) -> Series:
    """Return the points that hold data along the one axis that `place` leaves, beside theory.

    Raises KeyError where it leaves more, or is not in the data.
    """
    row = data.sel(place)
    axis, *others = row.R.dims
    if others:
        raise KeyError(f"one axis besides {', '.join(place)}")
    row = row.isel({axis: np.isfinite(row.R.values)})

    def predict(**others):
        settings = data.attrs | place | others
        return predicted_ratio(settings, settings["r"], settings["beta"])

    at = row[axis].values
    return Series(label, look, row, at, predict(**{axis: at}), predict)


def restitution_of(data: xr.Dataset) -> float:
    """Return the r that figures of only one show: RESTITUTION, or else the largest."""
    return RESTITUTION if RESTITUTION in data.r else float(data.r.max())


def series_for_each(
    data: xr.Dataset, name: str, symbol: str = r"\beta", looks: Sequence[Look] = LOOKS
) -> list[Series]:
    """Return one series for each r, from nearly elastic downwards; or for each other value of the
    coordinate `name` at one r (`restitution_of`), the smallest first."""
    place = {} if name == "r" else {"r": restitution_of(data)}
    values = sorted(data[name].values, reverse=name == "r")
    return [
        series(data, f"${symbol} = {value:g}$", looks[i % len(looks)], **{name: value}, **place)
        for i, value in enumerate(values)
    ]
