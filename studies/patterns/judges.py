"""Judges of the statements on patterns: agreement of our layers with the published ones."""

from collections.abc import Iterable

import xarray as xr

from roughgas.judging import Estimate, Finding, NotTestedError, grade

from .published import (
    FITS,
    FITS_WELL,
    FOLDS,
    layers_of_panels,
    order,
    period,
    room,
    settled,
    side,
    wavelength,
)

MODES, ORDER = 1.0, 0.1
"""Tolerances: wavelengths in a side, and order."""
HALF = 0.5

Compared = tuple[str, bool, str, Estimate]
"""Case or panel, whether it agrees with the published value, text of our finding, and our value."""


def the_wavelength_is_published(layers: xr.Dataset) -> Finding:
    """As many wavelengths are in a side as published, within one."""
    return _together(_wavelengths(layers), f"has settled in a box of {FITS:g} wavelengths")


def the_order_is_published(layers: xr.Dataset) -> Finding:
    """Q_m is the published one within 0.1."""
    return _together(_orders(layers), f"has settled in a box of {FITS_WELL:g} wavelengths")


def it_repeats_when_published(layers: xr.Dataset) -> Finding:
    """Heights come back after the published number of cycles."""
    return _together(_periods(layers), "has settled")


def _wavelengths(layers):
    for panel, layer in _settled(layers, FITS):
        ours = wavelength(layer)
        published = room(panel, layer)
        close = abs(side(layer) / ours.value - published) <= MODES
        blind = "; one wave across the box would agree, too" if published - 1.0 <= MODES else ""
        text = f"{ours.value:.3g} D ({panel.wavelength:g} published{blind})"
        yield panel.case, close, text, ours


def _orders(layers):
    for panel, layer in _settled(layers, FITS_WELL):
        if panel.fold in FOLDS:
            ours = order(layer, panel.fold)
            close = abs(ours.value - panel.order) <= ORDER
            yield panel.panel, close, f"Q_{panel.fold} = {ours} ({panel.order:g} published)", ours


def _periods(layers):
    for panel, layer in _settled(layers, 0.0):
        cycles = period(layer)
        text = f"{cycles} cycles ({panel.repeats} published)"
        yield panel.case, cycles == panel.repeats, text, Estimate(float(cycles), 0.0)


def _settled(layers, wavelengths):
    """Yield panels and settled layers whose box holds at least `wavelengths` published
    wavelengths."""
    for panel, layer in layers_of_panels(layers):
        if settled(layer) and room(panel, layer) >= wavelengths:
            yield panel, layer


def _together(compared: Iterable[Compared], condition: str) -> Finding:
    by_name = {name: rest for name, *rest in compared}  # c and d are one case
    if not by_name:
        raise NotTestedError(f"No case {condition}")
    close = [agrees for agrees, _, _ in by_name.values()]
    verdict = grade(all(close), sum(close) >= HALF * len(close))
    reason = "; ".join(f"{name}: {text}" for name, (_, text, _) in by_name.items()) + "."
    return Finding(verdict, reason, tuple((name, ours) for name, (*_, ours) in by_name.items()))
