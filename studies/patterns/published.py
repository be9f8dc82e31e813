"""The published patterns, and what ours are held against them by: C. Bizon, M. D. Shattuck, J. B.
Swift, W. D. McCormick and H. L. Swinney, Phys. Rev. Lett. 80, 57 (1998), Fig. 1.

Lengths are in diameters D = 2 a. Looks are one cycle of the floor apart, four in schedule.period.
"""

import csv
import math
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import xarray as xr

from roughgas.judging import Estimate

REFERENCE = Path(__file__).with_name("reference.csv")
DIAMETER = 2.0  # a
DEPTH = 5.42  # H/D
FOLDS = (2, 4, 6)
REPEATS, FAR = 4, 16
"""Cycles after which every published pattern is the same, and those that show whether it stays."""
LEAST, STAYS = 0.3, 0.8
"""Correlation of heights REPEATS cycles apart from which on there is a pattern, and the share of it
that a settled one has FAR cycles apart."""
PERIODS, SAME = (1, 2, 4), 0.9
FITS, FITS_WELL = 1.5, 2.0
"""Published wavelengths that a box must hold for its wavelength, and for its order."""


class Panel(NamedTuple):
    """A panel of the figure; NaN is what it does not say."""

    panel: str
    case: str
    gamma: float  # A (2 pi f)^2/g
    f_star: float  # f sqrt(H/g)
    pattern: str
    wavelength: float  # D
    repeats: int  # cycles
    settled: float  # cycles after which it was seen to be settled
    fold: int | None  # m of Q_m
    order: float  # Q_m


def panels() -> list[Panel]:
    """Return the panels of the published figure."""
    with REFERENCE.open(encoding="utf-8") as file:
        return [_panel(**row) for row in csv.DictReader(file)]


def _panel(panel, case, pattern, repeats, fold, **numbers):
    known = {name: float(text) if text else math.nan for name, text in numbers.items()}
    whole = int(fold) if fold else None
    return Panel(panel, case, pattern=pattern, repeats=int(repeats), fold=whole, **known)


def beside(layers: xr.Dataset) -> Iterator[tuple[Panel, xr.Dataset]]:
    """Yield each panel with our layer of its case, where there is one."""
    for panel in panels():
        if panel.case in layers.case:
            yield panel, layers.sel(case=panel.case).isel(r=0, beta=0)


def side(layer: xr.Dataset) -> float:
    """Return the side of the box in D."""
    return float(layer.cell_x[0] + layer.cell_x[-1]) / DIAMETER


def room(panel: Panel, layer: xr.Dataset) -> float:
    """Return how many published wavelengths the box holds."""
    return side(layer) / panel.wavelength


def cycles(panel: Panel, layer: xr.Dataset) -> float:
    """Return how many cycles of the floor went by before the measurement; g = 1 a/T^2."""
    return float(layer.measured_from) * panel.f_star / math.sqrt(DEPTH * DIAMETER)


def wavelength(layer: xr.Dataset) -> Estimate:
    """Return the wavelength in D; its error is no less than half a shell."""
    error = max(float(layer.wavelength_stderr), float(layer.wavelength_resolution))
    return Estimate(float(layer.wavelength) / DIAMETER, error / DIAMETER)


def order(layer: xr.Dataset, fold: int) -> Estimate:
    """Return Q_fold on the shell with most power."""
    one = layer.sel(fold=fold)
    found = (one.fold_order, one.fold_order_stderr, one.fold_order_dof)
    return Estimate(*map(float, found))


def correlation(layer: xr.Dataset, cycles: int) -> Estimate:
    """Return the correlation of heights so many cycles apart."""
    one = layer.isel(pattern_delay=cycles)
    found = (one.height_autocorrelation, one.height_autocorrelation_stderr)
    return Estimate(*map(float, found), float(one.height_autocorrelation_dof))


def settled(layer: xr.Dataset) -> bool:
    """Return whether there is a pattern that stays as it is."""
    near, far = (correlation(layer, cycles).value for cycles in (REPEATS, FAR))
    return near >= LEAST and far >= STAYS * near


def period(layer: xr.Dataset) -> int:
    """Return after how many cycles the pattern repeats."""
    found = {cycles: correlation(layer, cycles).value for cycles in range(1, REPEATS + 1)}
    return next(cycles for cycles in PERIODS if found[cycles] >= SAME * max(found.values()))
