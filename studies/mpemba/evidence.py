"""Where published temperatures cross, and what they are on the way, beside ours."""

from collections.abc import Iterator

import numpy as np
import xarray as xr

from roughgas.judging import Estimate, Row

from .curves import Crossing, crossing, expected, published, simulated

SOURCE = "Megias & Santos 2022, Front. Phys. 10, 971671, doi:10.3389/fphy.2022.971671"
RAW = "raw data: repository amegiasf/MpembaSplitting, commit f2d033c, folders SME and OME"
SCATTER = "their error is what scatters about a parabola"
BOUND = "our errors are upper bounds"
ALONG = f"{BOUND}, and points of one curve are not independent"
RATES = "rate equations, integrated numerically"
LAST = 2


def rows(
    hot: xr.Dataset,
    cold: xr.Dataset,
    overshoot_hot: xr.Dataset,
    overshoot_cold: xr.Dataset,
    memory: xr.Dataset,
) -> Iterator[Row]:
    """Yield crossings and temperatures of both protocols, and the hump of the third gas."""
    protocols = {
        "crossing": ("temperatures", {"hot": hot, "cold": cold}),
        "overshoot": ("distances from T_st", {"hot": overshoot_hot, "cold": overshoot_cold}),
    }
    for protocol, (what, gases) in protocols.items():
        over = protocol == "overshoot"
        curves = {name: simulated(gas) for name, gas in gases.items()}
        theirs = {name: published(protocol, name) for name in gases}
        rates = {name: expected(gas, curves[name]) for name, gas in gases.items()}
        ours = _time(crossing(*curves.values(), over))
        quantity, at = f"time nu_st t/2 at which {what} cross", "r = 0.7, beta = 0"
        found = _time(crossing(*theirs.values(), over))
        yield Row(quantity, at, "simulation", SOURCE, RAW, found, ours, "", f"{SCATTER}; {BOUND}")
        theory = Estimate(crossing(*rates.values(), over).time, 0.0)
        yield Row(quantity, at, "theory", SOURCE, RATES, theory, ours, "", BOUND)
        for name, curve in theirs.items():
            yield from _on_the_way(f"T/T_st, {protocol}, {name} gas", curve, curves[name])
    curve = simulated(memory, LAST)
    wanted = expected(memory, curve, LAST).T
    lowest = int(np.nanargmin(wanted))
    ours = Estimate(float(curve.T[lowest]), float(curve.stderr[lowest]))
    theory = Estimate(float(wanted[lowest]), 0.0)
    quantity, at = "T/T_st in the hump of a gas that remembers its drive", "r = 0.7, beta = 0"
    yield Row(quantity, at, "theory", SOURCE, RATES, theory, ours, "", BOUND)


def _time(found: Crossing) -> Estimate:
    return Estimate(found.time, found.stderr)


def _on_the_way(quantity, theirs, ours) -> Iterator[Row]:
    """Yield a row for one in ten of the published instants that we have simulated."""
    last = ours.time[-1]
    for time, value in list(zip(theirs.time, theirs.T, strict=True))[4::10]:
        if time < last:
            own = (float(np.interp(time, ours.time, one)) for one in (ours.T, ours.stderr))
            at, unknown = f"nu_st t/2 = {time:.3g}", Estimate(float(value), np.nan)
            yield Row(quantity, at, "simulation", SOURCE, RAW, unknown, Estimate(*own), "", ALONG)
