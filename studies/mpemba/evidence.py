"""Published crossings and temperatures against ours, as rows of evidence."""

from collections.abc import Iterator

import numpy as np
import xarray as xr

from roughgas.judging import Estimate, Row, point_text

from .curves import QUARTERS, Pair, hump, pairs
from .judges import MEMORY_STAGE, depth_of, time_of

SOURCE = "Megias & Santos 2022, Front. Phys. 10, 971671, doi:10.3389/fphy.2022.971671"
RAW = "raw data: repository amegiasf/MpembaSplitting, commit f2d033c, folders SME and OME"
COMPARED = {"crossing": "temperatures", "overshoot": "distances from T_st"}
REASON_CROSSING = "their error is what scatters about a parabola"
REASON_CURVE = "quarters of one curve share the errors of T_st and of the clock, which are included"
RATES = "rate equations, integrated numerically"
LOWEST = "lowest T/T_st of the colder gas, which overshoots"
QUARTER_NAMES = ("first", "second", "third", "last")


def rows(*gases: xr.Dataset) -> Iterator[Row]:
    """Yield crossings and temperatures of pairs of gases, and the hump of the last gas."""
    *paired, memory = gases
    for two in pairs(paired):
        quantity, at = (
            f"time nu_st t/2 at which {COMPARED[two.protocol]} cross",
            point_text(two.material),
        )
        crossings = two.simulated_crossing(), two.crossing(two.published)
        ours, theirs = map(time_of, crossings)
        yield Row(quantity, at, "simulation", SOURCE, RAW, theirs, ours, "", REASON_CROSSING)
        theory = Estimate(two.crossing(two.expected()).time, 0.0)
        yield Row(quantity, at, "theory", SOURCE, RATES, theory, ours)
        quantity = f"largest difference, in T_st, of {COMPARED[two.protocol]} that cross"
        ours, theirs = map(depth_of, crossings)
        yield Row(quantity, at, "simulation", SOURCE, RAW, theirs, ours, "", REASON_CROSSING)
        if two.is_overshoot:
            yield _lowest_row(two, at)
        for sample in two.published:
            yield from _quarter_rows(two, sample, at)
    _, T = hump(memory, MEMORY_STAGE)
    gap = T.estimate(2)  # ours minus theory, which begins in our measured state
    ours = Estimate(float(T.value[0]), gap.stderr, gap.dof)
    theory = Estimate(float(T.value[1]), 0.0)
    quantity, at = "T/T_st in the hump of a gas that remembers its drive", "r = 0.7, beta = 0"
    yield Row(quantity, at, "theory", SOURCE, RATES, theory, ours)


def _lowest_row(two: Pair, material: str) -> Row:
    """Return the row of T/T_st of the colder gas where the published curve is lowest."""
    cold = two.published["cold"]
    lowest = int(np.argmin(cold.T))
    index = list(two.published).index("cold")
    ours = two.gases.at(index, cold.time[lowest : lowest + 1]).estimate()
    theirs = Estimate(float(cold.T[lowest]), np.nan)
    return Row(LOWEST, material, "simulation", SOURCE, RAW, theirs, ours, "", REASON_CURVE)


def _quarter_rows(two: Pair, sample: str, material: str) -> Iterator[Row]:
    """Yield a row for the mean over each quarter of a published curve."""
    published, quarters = two.quarters(sample)
    quantity = f"mean of T/T_st, {two.protocol}, {sample} gas"
    for index, name in enumerate(QUARTER_NAMES[:QUARTERS]):
        theirs = Estimate(float(published[index]), np.nan)
        at = f"{material}, {name} quarter of the curve"
        ours = quarters.estimate(index)
        yield Row(quantity, at, "simulation", SOURCE, RAW, theirs, ours, "", REASON_CURVE)
