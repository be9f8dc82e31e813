"""Verdicts, and the rules that findings share."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
import xarray as xr

from roughgas.claims.evidence import (
    NotTestedError,
    Sample,
    deviation,
    deviation_in_proportion,
    written,
)
from roughgas.data.reduced import GRID
from roughgas.statistics.errors import SIGNIFICANT, Estimate

HOLDS = "holds"
QUALIFIED = "holds with a qualification"
FAILS = "fails"
NOT_TESTED = "not tested"

AGREE = 0.02
"""Difference in R up to which two values agree. Lun's formula and the theory of free cooling differ
by 0.12 at r = 0.9, beta = 0; this is a sixth of that. Where R < 0.02 the criterion is empty, so
such ranges are also judged relative to theory. Fixed before any data; justified later."""
LIMIT = 0.06
"""Difference in R beyond which they disagree; between the two, agreement is qualified. Half of that
0.12: beyond it the other theory may be nearer. Fixed before any data; justified later."""
TENDENCY = 0.005
"""Difference in R from which a statement about a direction (above, below) has content. A
convention: a quarter of AGREE. Fixed before any data."""
FEW = 0.1
"""Share of the points of a sweep that may be exceptions. A convention: two of the 21 values of beta
at one r. Fixed before any data."""
NEAR = 0.1
"""Fraction of R up to which a value agrees relative to theory. AGREE over the R of a driven
gas in mid-range, Lun's formula at beta = 0. Fixed before the data of friction and inertia; for beds
and sheared gases (Figs. 1a, 2a, 3) after their data."""
FAR = 0.5
"""Fraction beyond which it disagrees; between the two, agreement is qualified. A convention: theory
is then wrong by a factor of 1.5 to 2. Fixed as NEAR was."""


class Finding(NamedTuple):
    """A verdict, the sentence that follows from the numbers, and these, the deciding one first."""

    verdict: str
    reason: str
    numbers: tuple[tuple[str, Estimate], ...] = ()

    def with_note(self, sentence: str) -> "Finding":
        """Return the finding with one more sentence to its reason."""
        return self._replace(reason=f"{self.reason} {sentence}")


def agreement(sample: Sample, other: str) -> Finding:
    """Judge whether the values of `sample`, differences from `other`, are compatible with zero.

    A point disagrees where it differs significantly and by more than the tolerance. Fails: more
    than a few points differ by more than LIMIT. Holds: no point differs by more than AGREE.
    """
    off, far, vague = sample.off(AGREE), sample.off(LIMIT), sample.vague(AGREE)
    if vague.mean() > 0.5:
        raise NotTestedError(f"the errors are too large at {vague.sum()} of {sample.size} points")
    verdict = grade(not off.any() and vague.mean() <= FEW, far.mean() <= FEW)
    (largest, place), mean = sample.largest(), sample.mean()
    reason = (
        f"{int((np.abs(sample.value) <= AGREE).sum())} of {sample.size} points within {AGREE:g} of "
        f"{other}; the largest difference is {text(largest)} at {place}, the mean {text(mean)}."
    )
    if vague.mean() > FEW:
        reason += f" At {points(vague.sum())} the errors are too large to tell."
    numbers = (("largest difference", largest), ("mean difference", mean), *_along(sample))
    return Finding(verdict, reason, numbers)


def _along(sample: Sample) -> list[tuple[str, Estimate]]:
    """Return the largest value at each step of the third parameter, if there is one."""
    return [
        (f"largest at {name} = {written(value)}", sample.where(column == value).largest()[0])
        for name, column in sample.places.items()
        if name not in GRID
        for value in np.unique(column)
    ]


def agreement_in_proportion(gas: xr.Dataset, theory: str) -> Finding:
    """Judge whether R - theory is compatible with zero, and so is its ratio to theory at all but a
    few points: where R spans decades, a small R must follow theory, too."""
    found, relative = agreement(deviation(gas), theory), deviation_in_proportion(gas)
    off, far, vague = relative.off(NEAR), relative.off(FAR), relative.vague(NEAR)
    verdict = grade(off.mean() <= FEW and vague.mean() <= FEW, far.mean() <= FEW)
    near = int((np.abs(relative.value) <= NEAR).sum())
    reason = f"Relative to theory, {near} of {relative.size} points are within {NEAR:.0%}"
    numbers: tuple[tuple[str, Estimate], ...] = ()
    if off.any():
        largest, place = relative.where(off).largest()
        reason += f"; the largest significant difference is {text(largest)} of {theory} at {place}"
        numbers = ((f"largest significant difference over {theory}", largest),)
    if vague.any():
        reason += f"; at {points(vague.sum())} the errors are too large to tell"
    reason, numbers = f"{found.reason} {reason}.", found.numbers + numbers
    return Finding(worse(found.verdict, verdict), reason, numbers)


def together(findings: Iterable[tuple[str, Finding]]) -> Finding:
    """Return findings on several gases, by name, as one: the worst verdict, and the numbers and
    reasons of all, the one with the largest deciding number first."""
    found = sorted(findings, key=lambda pair: -abs(pair[1].numbers[0][1].value))
    numbers = [(f"{name}: {label}", x) for name, one in found for label, x in one.numbers]
    reason = " ".join(f"{name}: {one.reason}" for name, one in found)
    return Finding(worse(*(one.verdict for _, one in found)), reason, tuple(numbers))


def tendency(value: Estimate) -> str:
    """Return the verdict on the statement that `value` is positive, significantly and not
    trivially.

    Raises NotTestedError where its error leaves the direction open.
    """
    if not value.real and not SIGNIFICANT * value.stderr < TENDENCY:
        raise NotTestedError(f"the errors are too large to tell a direction: {text(value)}")
    if value.real and value.value >= TENDENCY:
        return HOLDS
    return QUALIFIED if value.real and value.value > 0 else FAILS


def grade(full: bool, partly: bool) -> str:
    """Return the verdict on a statement that holds in full, with a qualification, or not."""
    return HOLDS if full else QUALIFIED if partly else FAILS


def worse(*verdicts: str) -> str:
    """Return the least favourable of some verdicts."""
    return max(verdicts, key=(HOLDS, QUALIFIED, FAILS).index)


def text(number: Estimate) -> str:
    """Return such as "+0.0213 ± 0.0014 (12.3 sigma)"; the error decides the number of digits."""
    if not np.isfinite(number.stderr):
        return f"{number:+.4f}"
    shown, sigma = f"{number:+.{4 if number.stderr >= 0.001 else 5}f}", abs(number.sigma)
    return f"{shown} ({'> 20' if sigma > 20 else f'{sigma:.1f}'} sigma)"


def points(count: int) -> str:
    """Return such as "2 points"."""
    return f"{count} {'point' if count == 1 else 'points'}"
