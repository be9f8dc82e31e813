"""Verdicts on rows of evidence: whether ours differs from the published number, of all rows.

A row alone has a probability. Its verdict depends on how many rows its tier has, since among
hundreds some are improbable by chance. All limits below were fixed before their first counts.
"""

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from roughgas.base import NamedValues
from roughgas.results.comparison import (
    DERIVED,
    STORED,
    TEXTS,
    TIERS,
    Row,
    number_cell,
    read_rows,
    row_cells,
    write_table,
)
from roughgas.statistics.estimates import SIGNIFICANCE, Estimate, mean_by_scatter
from roughgas.statistics.false_discovery import false_discovery_level

AGREES, DIFFERS, NO_ERROR = "agrees", "differs", "differs, no error published"
NOT_TESTED, NOT_KNOWN = "not tested", "not known"
VERDICTS = (AGREES, DIFFERS, NO_ERROR, NOT_TESTED, NOT_KNOWN)
COLUMNS = (*STORED, *DERIVED, "detectable", "detectable_share", "verdict", *TEXTS)
FALSE_DISCOVERIES = 0.01
"""Largest share, on average, of the differing rows of a tier that differ by chance. A convention:
near 3 sigma where half of the rows differ, near 4 where one of 300 does. Fixed before any count
by it."""
TESTED_SHARE = 0.1
"""Largest detectable deviation, as a share of the published number, of a row that is a test. A
convention, AGREE_RELATIVE. Fixed before any count by it."""
TESTED_SCALE = 0.1
"""Least size of a published number that TESTED_SHARE refers to; smaller ones count as this large.
R, cumulants and ratios have the scale 1. A convention. Fixed before any count by it."""


class Judgement(NamedTuple):
    """The verdict on a row, and what it rests on."""

    level: float  # the row differs if its probability is this or less; NaN if it has none
    detectable: float  # smallest deviation that would have differed, in the unit of the number
    verdict: str


class Bias(NamedTuple):
    """Mean of t over the rows of a source in a study and a tier, a test for a common deviation."""

    study: str
    tier: str
    source: str
    mean: Estimate  # its error is from the scatter of t over the rows
    is_common: bool  # whether it differs from 0, all sources taken into account


def judge(rows: Sequence[Row]) -> list[Judgement]:
    """Return the judgement on each row, in order.

    Rows of a tier share a level, by `false_discovery_level` at FALSE_DISCOVERIES. Rows
    whose errors are bounds of rounding, or 0, know no chance: their level is SIGNIFICANCE.
    """
    levels = {tier: _level([row for row in rows if row.tier == tier]) for tier in TIERS}
    return [
        _judged(row, SIGNIFICANCE if row.is_without_chance else levels[row.tier]) for row in rows
    ]


def verdicts(rows: Sequence[Row]) -> list[str]:
    """Return the verdict, one of VERDICTS, on each row, in order: see `judge`."""
    return [judgement.verdict for judgement in judge(rows)]


def combine(inputs: Iterable[str | Path], *, output: str | Path) -> None:
    """Write the rows of all studies with their verdicts as one CSV."""
    pairs = [pair for path in inputs for pair in read_rows(path)]
    judgements = judge([row for _, row in pairs])
    write_table(map(_cells, pairs, judgements), COLUMNS, output)


def detectable_share(row: Row, judgement: Judgement) -> float:
    """Return the detectable deviation of a row over the published number; inf if this is 0."""
    theirs = abs(row.theirs.value)
    return judgement.detectable / theirs if theirs > 0 else math.inf


def largest_undetected(row: Row) -> float:
    """Return the largest detectable deviation of a row that is a test, in the number's unit."""
    return TESTED_SHARE * max(abs(row.theirs.value), TESTED_SCALE)


def biases(rows: Sequence[tuple[str, Row]]) -> list[Bias]:
    """Return the mean of t of each source with two rows or more, per study and tier.

    `rows` are (study, row) pairs; rows without t or without chance do not count. Rows along one
    curve or of one gas are not independent, so the probability is a lower bound. Whether a bias is
    common is decided for all sources together, as `judge` does for rows.
    """
    t_by_source: dict[tuple[str, str, str], list[float]] = {}
    for study, row in rows:
        if math.isfinite(row.t) and not row.is_without_chance:
            t_by_source.setdefault((study, row.tier, row.source), []).append(row.t)
    means = {key: mean_by_scatter(np.array(t)) for key, t in t_by_source.items() if len(t) > 1}
    level = false_discovery_level([m.probability for m in means.values()], FALSE_DISCOVERIES)
    return [Bias(*key, mean, mean.probability <= level) for key, mean in means.items()]


def _cells(pair: tuple[str, Row], judgement: Judgement) -> NamedValues:
    """Return the cells of a (study, row) pair and of the judgement on it, by column."""
    study, row = pair
    cells = row_cells(study, row) | {"verdict": judgement.verdict}
    cells["detectable"] = number_cell(judgement.detectable)
    return cells | {"detectable_share": number_cell(detectable_share(row, judgement))}


def _level(rows: Sequence[Row]) -> float:
    """Return the level of the rows of a tier; NaN if none has a probability."""
    probabilities = [row.probability for row in rows if not row.is_without_chance]
    finite = [probability for probability in probabilities if math.isfinite(probability)]
    return false_discovery_level(finite, FALSE_DISCOVERIES)


def _judged(row: Row, level: float) -> Judgement:
    """Return the judgement on a row whose tier has this level."""
    if math.isnan(row.probability):
        return Judgement(math.nan, math.nan, NOT_KNOWN)
    detectable = row.gap.detectable_at(level)
    if row.probability <= level:
        verdict = NO_ERROR if row.is_without_error else DIFFERS
    else:
        verdict = AGREES if detectable <= largest_undetected(row) else NOT_TESTED
    return Judgement(level, detectable, verdict)
