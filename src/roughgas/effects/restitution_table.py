"""Restitution from a table over the normal speed, as it was measured, or made by any function.

Between the table's speeds the restitution is on straight lines, beyond them it stays as it is at
the ends. What the table has for the particles also says how other contacts depend on the speed:
1 - r of each is in proportion to the table's, and r is what it is at the speed `reference`.
"""

import math
from itertools import pairwise
from typing import NamedTuple

from roughgas.base import InputError
from roughgas.effects.settings import Number, Numbers, register
from roughgas.kernel.jit import jit, unrolled
from roughgas.kernel.state import EXPONENT

MOST = 32  # entries: a table that is shorter is filled up, so that all have the same machine code
SETTINGS = {
    "speed": Numbers("Normal speeds, increasing, in a/T.", "[0, inf)", 2, MOST),
    "restitution": Numbers("Restitution at each speed.", "[0, 1]", 2, MOST),
    "reference": Number(
        "Normal speed at which contacts have their restitution r, in a/T.", "[0, inf)", 1.0
    ),
}


class RestitutionTable(NamedTuple):
    """A table gives the restitution at each normal speed."""

    speed: float  # the reference, at which contacts have the r of their material, in a/T
    lowest: float  # 1 - r at the lowest speed, over that at the reference
    begins: tuple[float, ...]  # speeds at which the straight lines begin,
    widths: tuple[float, ...]  # over how much of speed they go,
    slopes: tuple[float, ...]  # and how steeply the share of 1 - r rises

    @classmethod
    def from_settings(cls, settings, around):
        """Return the effect; raise InputError for columns that are no table."""
        speeds, values, reference = settings.values()
        _check(speeds, values)
        losses = [1.0 - value for value in values]
        whole = share(*_lines(speeds, losses), reference)
        if not whole > 0.0:
            key = "effects.restitution_table.reference"
            raise InputError(key, reference, "be a speed at which the table has less than 1")
        return cls(reference, *_lines(speeds, [loss / whole for loss in losses]))


def _check(speeds, values):
    key = "effects.restitution_table"
    if len(values) != len(speeds):
        legal = f"have as many entries as speed, {len(speeds)}"
        raise InputError(f"{key}.restitution", list(values), legal)
    if any(later <= sooner for sooner, later in pairwise(speeds)):
        raise InputError(f"{key}.speed", list(speeds), "increase")


def _lines(speeds, values):
    """Return the value at the lowest speed, and begins, widths and slopes of the straight lines."""
    widths = [high - low for low, high in pairwise(speeds)]
    rises = [high - low for low, high in pairwise(values)]
    slopes = [rise / width for rise, width in zip(rises, widths, strict=True)]
    filled = (tuple(x) + (0.0,) * (MOST - 1 - len(x)) for x in (speeds[:-1], widths, slopes))
    return values[0], *filled


@unrolled
def share(lowest, begins, widths, slopes, speed):
    """Return the value at a speed: the sum of what each straight line adds up to it."""
    found = lowest
    for k in range(len(begins)):
        found += slopes[k] * min(max(speed - begins[k], 0.0), widths[k])
    return found


@jit
def restitution(table, index, r, state, i, j, time, speed):
    speed = math.ldexp(abs(speed), state.counts[EXPONENT])
    lost = (1.0 - r) * share(table.lowest, table.begins, table.widths, table.slopes, speed)
    return 1.0 - min(max(lost, 0.0), 1.0)


register(RestitutionTable, SETTINGS, restitution=restitution)
