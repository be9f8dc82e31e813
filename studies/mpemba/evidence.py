"""Where published temperatures cross, and what they are on the way, beside ours."""

from collections.abc import Iterator

import numpy as np
import xarray as xr

from roughgas.judging import Estimate, Row, place_of

from .curves import Crossing, expected, pairs, simulated

SOURCE = "Megias & Santos 2022, Front. Phys. 10, 971671, doi:10.3389/fphy.2022.971671"
RAW = "raw data: repository amegiasf/MpembaSplitting, commit f2d033c, folders SME and OME"
WHAT = {"crossing": "temperatures", "overshoot": "distances from T_st"}
INCOMPLETE = "our errors leave out the errors of T_st and of the frequency"
OF_CROSSING = f"their error is what scatters about a parabola; {INCOMPLETE}"
ALONG = f"{INCOMPLETE}, which all points of one curve share"
RATES = "rate equations, integrated numerically"
LAST = 2


def rows(*gases: xr.Dataset) -> Iterator[Row]:
    """Yield crossings and temperatures of pairs of gases, and the hump of the last one."""
    *paired, memory = gases
    for one in pairs(paired):
        quantity, at = f"time nu_st t/2 at which {WHAT[one.protocol]} cross", place_of(one.place)
        ours, found = (_time(one.crossing(curves)) for curves in (one.simulated, one.published))
        yield Row(quantity, at, "simulation", SOURCE, RAW, found, ours, "", OF_CROSSING)
        theory = Estimate(one.crossing(one.expected).time, 0.0)
        yield Row(quantity, at, "theory", SOURCE, RATES, theory, ours, "", INCOMPLETE)
        for name, curve in one.published.items():
            quantity = f"T/T_st, {one.protocol}, {name} gas"
            yield from _on_the_way(quantity, at, curve, one.simulated[name])
    curve = simulated(memory, LAST)
    wanted = expected(memory, curve, LAST).T
    lowest = int(np.nanargmin(wanted))
    ours = Estimate(float(curve.T[lowest]), float(curve.stderr[lowest]))
    theory = Estimate(float(wanted[lowest]), 0.0)
    quantity, at = "T/T_st in the hump of a gas that remembers its drive", "r = 0.7, beta = 0"
    yield Row(quantity, at, "theory", SOURCE, RATES, theory, ours, "", INCOMPLETE)


def _time(found: Crossing) -> Estimate:
    return Estimate(found.time, found.stderr)


def _on_the_way(quantity, material, theirs, ours) -> Iterator[Row]:
    """Yield a row for one in ten of the published instants that we have simulated."""
    last = ours.time[-1]
    for time, value in list(zip(theirs.time, theirs.T, strict=True))[4::10]:
        if time < last:
            own = (float(np.interp(time, ours.time, one)) for one in (ours.T, ours.stderr))
            unknown = Estimate(float(value), np.nan)
            at = f"{material}, nu_st t/2 = {time:.3g}"
            yield Row(quantity, at, "simulation", SOURCE, RAW, unknown, Estimate(*own), "", ALONG)
