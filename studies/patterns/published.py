"""The published patterns, and the quantities that we compare: C. Bizon, M. D. Shattuck, J. B.
Swift, W. D. McCormick and H. L. Swinney, Phys. Rev. Lett. 80, 57 (1998), Fig. 1.

Lengths are in diameters D = 2 a. Frames are one cycle of the floor apart; schedule.period is four.
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
CYCLES, STABILITY_DELAY = 4, 16
"""Cycles after which every published pattern repeats, and cycles over which a settled one stays."""
MINIMUM_CORRELATION, SETTLED_SHARE = 0.3, 0.8
"""Least correlation of heights CYCLES apart in a pattern, and the share of it that a settled
pattern has after STABILITY_DELAY."""
PERIODS, PERIOD_SHARE = (1, 2, 4), 0.9
FITS, FITS_WELL = 1.5, 2.0
"""Published wavelengths that a box must hold for its wavelength, and for its order."""


class Panel(NamedTuple):
    """A panel of the figure; unpublished values are NaN."""

    panel: str
    case: str
    gamma: float  # A (2 pi f)^2/g
    f_star: float  # f sqrt(H/g)
    pattern: str
    wavelength: float  # D
    repeats: int  # cycles
    settled: float  # cycles until it had settled
    fold: int | None  # m of Q_m
    order: float  # Q_m


def panels() -> list[Panel]:
    """Return the panels of the published figure."""
    with REFERENCE.open(encoding="utf-8") as file:
        return [_panel(**row) for row in csv.DictReader(file)]


def _panel(panel, case, pattern, repeats, fold, **numbers):
    values = {name: float(text) if text else math.nan for name, text in numbers.items()}
    fold_number = int(fold) if fold else None
    return Panel(panel, case, pattern=pattern, repeats=int(repeats), fold=fold_number, **values)


def layers_of_panels(layers: xr.Dataset) -> Iterator[tuple[Panel, xr.Dataset]]:
    """Yield each panel whose case is in our data, with the layer of this case."""
    for panel in panels():
        if panel.case in layers.case:
            yield panel, layers.sel(case=panel.case).isel(r=0, beta=0)


def panels_in(
    layers: xr.Dataset, without: xr.Dataset | None = None
) -> list[tuple[Panel, xr.Dataset]]:
    """Return panels and layers (`layers_of_panels`) of all cases that `without` lacks."""
    left_out = [] if without is None else without.case
    return [pair for pair in layers_of_panels(layers) if pair[0].case not in left_out]


def side(layer: xr.Dataset) -> float:
    """Return the side of the box in D."""
    return float(layer.cell_x[0] + layer.cell_x[-1]) / DIAMETER


def room(panel: Panel, layer: xr.Dataset) -> float:
    """Return the side of the box in published wavelengths."""
    return side(layer) / panel.wavelength


def cycles(panel: Panel, layer: xr.Dataset) -> float:
    """Return the number of cycles of the floor before the measurement; g = 1 a/T^2."""
    return float(layer.measured_from) * panel.f_star / math.sqrt(DEPTH * DIAMETER)


def wavelength(layer: xr.Dataset) -> Estimate:
    """Return the wavelength in D; its error is at least half a shell."""
    error = max(float(layer.wavelength_stderr), float(layer.wavelength_resolution))
    return Estimate(float(layer.wavelength) / DIAMETER, error / DIAMETER)


def order(layer: xr.Dataset, fold: int) -> Estimate:
    """Return Q_fold on the shell with most power."""
    shell = layer.sel(fold=fold)
    values = (shell.fold_order, shell.fold_order_stderr, shell.fold_order_dof)
    return Estimate(*map(float, values))


def correlation(layer: xr.Dataset, cycles: int) -> Estimate:
    """Return the correlation of heights `cycles` apart."""
    delayed = layer.isel(pattern_delay=cycles)
    values = (delayed.height_autocorrelation, delayed.height_autocorrelation_stderr)
    return Estimate(*map(float, values), float(delayed.height_autocorrelation_dof))


def settled(layer: xr.Dataset) -> bool:
    """Return whether there is a pattern that persists."""
    first, last = (correlation(layer, cycles).value for cycles in (CYCLES, STABILITY_DELAY))
    return first >= MINIMUM_CORRELATION and last >= SETTLED_SHARE * first


def period(layer: xr.Dataset) -> int:
    """Return the period of the pattern, in cycles."""
    correlations = {cycles: correlation(layer, cycles).value for cycles in range(1, CYCLES + 1)}
    return next(
        cycles
        for cycles in PERIODS
        if correlations[cycles] >= PERIOD_SHARE * max(correlations.values())
    )
