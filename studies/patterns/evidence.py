"""Published wavelengths, orders and periods of patterns beside ours."""

from collections.abc import Iterator

import xarray as xr

from roughgas.judging import Estimate, Row

from .published import (
    FITS,
    FITS_WELL,
    FOLDS,
    Panel,
    beside,
    order,
    period,
    room,
    settled,
    side,
    wavelength,
)

SOURCE = "Bizon et al. 1998, Phys. Rev. Lett. 80, 57, doi:10.1103/PhysRevLett.80.57"
READ = "Fig. 1 and its caption; 60 000 spheres in a box of 100 D"
REPEATS = "cycles after which it repeats"  # whole, and therefore exact
UNKNOWN = Estimate(float("nan"), float("nan"))


def rows(layers: xr.Dataset) -> Iterator[Row]:
    """Yield what is published of each panel; ours is NaN where the pattern has not settled."""
    cases = set()
    for panel, layer in beside(layers):
        again = panel.case in cases  # c and d are one layer, and differ in their orders
        cases.add(panel.case)
        for quantity, value, fits, ours, reason in _compared(panel, layer):
            if again and quantity != f"Q_{panel.fold}":
                continue
            theirs = Estimate(value, 0.0 if quantity == REPEATS else float("nan"))
            seen = room(panel, layer) >= fits and settled(layer)
            why = reason if seen else _why_not(panel, layer)
            at = f"panel {panel.panel}, {panel.pattern}"
            ours = ours if seen else UNKNOWN
            yield Row(quantity, at, "simulation", SOURCE, READ, theirs, ours, "", why)


def _compared(panel: Panel, layer: xr.Dataset):
    """Yield quantities: the published number, the wavelengths that a box must hold, and ours."""
    shell = f"ours is one of {side(layer):g} D/n: its error is half a shell, n = 2, 3, ..."
    yield "wavelength/D", panel.wavelength, FITS, wavelength(layer), shell
    few = (
        f"the study's claim allows 0.1; a box of {side(layer):g} D holds {room(panel, layer):.1f} "
        "wavelengths"
    )
    if panel.fold in FOLDS:
        yield f"Q_{panel.fold}", panel.order, FITS_WELL, order(layer, panel.fold), few
    cycles = Estimate(float(period(layer)) if settled(layer) else float("nan"), 0.0)
    yield REPEATS, float(panel.repeats), 0.0, cycles, ""


def _why_not(panel: Panel, layer: xr.Dataset) -> str:
    if not settled(layer):
        return "ours has not settled: not compared"
    return f"the box holds {room(panel, layer):.1f} wavelengths: not compared"
