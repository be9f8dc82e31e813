"""What a statement of the paper is, what is found about it, and the rules that findings share."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import xarray as xr

from roughgas.claims.evidence import NotTestedError
from roughgas.claims.statistics import SIGNIFICANT, Estimate, Sample, written
from roughgas.data.reduced import GRID

HOLDS = "holds"
QUALIFIED = "holds with a qualification"
FAILS = "fails"
NOT_TESTED = "not tested"

AGREE = 0.02
"""Difference in R up to which two values agree: a symbol's size in the paper's figures, about."""
LIMIT = 0.06
"""Difference in R beyond which they disagree; between the two, agreement is qualified."""
TENDENCY = 0.005
"""Difference in R from which a statement about a direction (above, below) has content."""
FEW = 0.1
"""Share of the points of a sweep that may be exceptions."""


class Finding(NamedTuple):
    """A verdict, the sentence that follows from the numbers, and these, the deciding one first."""

    verdict: str
    reason: str
    numbers: tuple[tuple[str, Estimate], ...] = ()


class Statement(NamedTuple):
    """A testable statement: `judge` gets the datasets of `experiments`, in that order."""

    name: str
    quote: str
    experiments: tuple[str, ...]
    judge: Callable[..., Finding]


class Row(NamedTuple):
    """A statement with its finding."""

    statement: Statement
    finding: Finding


def examine(statement: Statement, datasets: dict[str, xr.Dataset]) -> Row:
    """Judge `statement` on `datasets` (by experiment), or say why it cannot be judged."""
    missing = [name for name in statement.experiments if name not in datasets]
    try:
        if missing:
            raise NotTestedError(f"no data of {', '.join(missing)}")
        used = [datasets[name] for name in statement.experiments]
        finding = statement.judge(*used)
    except NotTestedError as lack:
        reason = str(lack)
        return Row(statement, Finding(NOT_TESTED, f"{reason[0].upper()}{reason[1:]}."))
    aside = sum(data.attrs["set_aside"] for data in used)
    if aside:
        note = f" {aside} {points(aside)} not in a steady state set aside."
        finding = finding._replace(reason=finding.reason + note)
    return Row(statement, finding)


def agreement(sample: Sample, other: str) -> Finding:
    """Whether the values of `sample`, differences from `other`, are as good as zero.

    A point disagrees where it differs significantly and by more than the tolerance. Fails: more
    than a few points differ by more than LIMIT. Holds: no point differs by more than AGREE.
    """
    size, real = np.abs(sample.value), np.abs(sample.sigma()) >= SIGNIFICANT
    off, far, vague = real & (size > AGREE), real & (size > LIMIT), ~real & (size > AGREE)
    if vague.mean() > 0.5:
        raise NotTestedError(f"the errors are too large at {vague.sum()} of {sample.size} points")
    verdict = QUALIFIED if off.any() or vague.mean() > FEW else HOLDS
    verdict = FAILS if far.mean() > FEW else verdict
    largest, place = sample.largest()
    mean = sample.mean()
    reason = (
        f"{int((size <= AGREE).sum())} of {sample.size} points within {AGREE:g} of {other}; "
        f"the largest difference is {text(largest)} at {place}, the mean {text(mean)}."
    )
    if vague.mean() > FEW:
        reason += f" At {vague.sum()} {points(vague.sum())} the errors are too large to tell."
    numbers = (("largest difference", largest), ("mean difference", mean), *_along(sample))
    return Finding(verdict, reason, numbers)


def _along(sample: Sample) -> list[tuple[str, Estimate]]:
    """The largest value at each step of what is swept besides r and beta, if anything is."""
    columns = ((name, column) for name, column in sample.places.items() if name not in GRID)
    return [
        (f"largest at {name} = {written(value)}", sample.where(column == value).largest()[0])
        for name, column in columns
        for value in np.unique(column)
    ]


def tendency(value: Estimate) -> str:
    """Verdict on the statement that `value` is positive: significantly, by more than a trifle.

    Raises NotTestedError where its error leaves the direction open.
    """
    if not value.real and not SIGNIFICANT * value.error < TENDENCY:
        raise NotTestedError(f"the errors are too large to tell a direction: {text(value)}")
    if value.real and value.value >= TENDENCY:
        return HOLDS
    return QUALIFIED if value.real and value.value > 0 else FAILS


def worse(*verdicts: str) -> str:
    """The least favourable of some verdicts."""
    return max(verdicts, key=(HOLDS, QUALIFIED, FAILS).index)


def text(number: Estimate) -> str:
    """Such as "+0.0213 ± 0.0014 (12.3 sigma)"; digits by the error."""
    if not np.isfinite(number.error):
        return f"{number.value:+.4f} (error unknown)"
    digits = 4 if number.error >= 0.001 else 5
    value = f"{number.value:+.{digits}f} ± {number.error:.{digits}f}"
    sigma = abs(number.sigma)
    return f"{value} ({'> 20' if sigma > 20 else f'{sigma:.1f}'} sigma)"


def points(count: int) -> str:
    """The word for so many points."""
    return "point" if count == 1 else "points"
