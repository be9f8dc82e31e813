"""Published wavelengths, orders and periods of patterns against ours, as rows of evidence."""

from collections.abc import Iterator

import xarray as xr

from roughgas.judging import Estimate, Row

from .published import (
    FITS,
    FITS_WELL,
    FOLDS,
    Panel,
    layers_of_panels,
    order,
    period,
    room,
    settled,
    side,
    wavelength,
)

SOURCE = "Bizon et al. 1998, Phys. Rev. Lett. 80, 57, doi:10.1103/PhysRevLett.80.57"
READ = "Fig. 1 and its caption; 60 000 spheres in a box of 100 D"
PERIOD_QUANTITY = "cycles after which it repeats"  # an integer, and therefore exact
UNKNOWN = Estimate(float("nan"), float("nan"))


def rows(layers: xr.Dataset) -> Iterator[Row]:
    """Yield the published quantities of each panel; our value is NaN if the pattern has not
    settled."""
    cases = set()
    for panel, layer in layers_of_panels(layers):
        again = panel.case in cases  # c and d are the same layer, and differ in their orders
        cases.add(panel.case)
        for quantity, value, fits, ours, reason in _compared(panel, layer):
            if again and quantity != f"Q_{panel.fold}":
                continue
            theirs = Estimate(value, 0.0 if quantity == PERIOD_QUANTITY else float("nan"))
            is_compared = room(panel, layer) >= fits and settled(layer)
            explanation = reason if is_compared else _reason_to_skip(panel, layer)
            label = f"panel {panel.panel}, {panel.pattern}"
            ours = ours if is_compared else UNKNOWN
            yield Row(quantity, label, "simulation", SOURCE, READ, theirs, ours, "", explanation)


def _compared(panel: Panel, layer: xr.Dataset):
    """Yield quantities: name, published value, minimum box in wavelengths, our value, reason."""
    shell = f"ours is one of {side(layer):g} D/n: its error is half a shell, n = 2, 3, ..."
    yield "wavelength/D", panel.wavelength, FITS, wavelength(layer), shell
    claim = (
        f"the study's claim allows 0.1; a box of {side(layer):g} D holds {room(panel, layer):.1f} "
        "wavelengths"
    )
    if panel.fold in FOLDS:
        yield f"Q_{panel.fold}", panel.order, FITS_WELL, order(layer, panel.fold), claim
    cycles = Estimate(float(period(layer)) if settled(layer) else float("nan"), 0.0)
    yield PERIOD_QUANTITY, float(panel.repeats), 0.0, cycles, ""


def _reason_to_skip(panel: Panel, layer: xr.Dataset) -> str:
    if not settled(layer):
        return "ours has not settled: not compared"
    return f"the box holds {room(panel, layer):.1f} wavelengths: not compared"
