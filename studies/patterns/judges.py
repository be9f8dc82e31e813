"""Judges of the statements on patterns: in which of our layers they are as published."""

from collections.abc import Iterable

import xarray as xr

from roughgas.judging import Estimate, Finding, NotTestedError, grade

from .published import (
    FITS,
    FITS_WELL,
    FOLDS,
    beside,
    order,
    period,
    room,
    settled,
    side,
    wavelength,
)

MODES, ORDER = 1.0, 0.1
"""Wavelengths in a side, and order, by which ours may differ."""
HALF = 0.5

Compared = tuple[str, bool, str, Estimate]
"""A case or panel, whether it is as published, what is found, and our number."""


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
        close = abs(side(layer) / ours.value - room(panel, layer)) <= MODES
        said = f"{ours.value:.3g} D ({panel.wavelength:g} published)"
        yield panel.case, close, said, ours


def _orders(layers):
    for panel, layer in _settled(layers, FITS_WELL):
        if panel.fold in FOLDS:
            ours = order(layer, panel.fold)
            close = abs(ours.value - panel.order) <= ORDER
            yield panel.panel, close, f"Q_{panel.fold} = {ours} ({panel.order:g} published)", ours


def _periods(layers):
    for panel, layer in _settled(layers, 0.0):
        found = period(layer)
        said = f"{found} cycles ({panel.repeats} published)"
        yield panel.case, found == panel.repeats, said, Estimate(float(found), 0.0)


def _settled(layers, wavelengths):
    """Yield settled layers with their panels, of boxes that hold so many wavelengths."""
    for panel, layer in beside(layers):
        if settled(layer) and room(panel, layer) >= wavelengths:
            yield panel, layer


def _together(compared: Iterable[Compared], what: str) -> Finding:
    found = {name: rest for name, *rest in compared}  # c and d are one case
    if not found:
        raise NotTestedError(f"No case {what}")
    close = [right for right, _, _ in found.values()]
    verdict = grade(all(close), sum(close) >= HALF * len(close))
    reason = "; ".join(f"{name}: {said}" for name, (_, said, _) in found.items()) + "."
    return Finding(verdict, reason, tuple((name, ours) for name, (*_, ours) in found.items()))
