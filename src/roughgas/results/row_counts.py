"""The numbers that pages quote of published rows: verdicts, levels and biases, as text."""

import math
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from roughgas.base.text import with_minus_signs
from roughgas.results.comparison import TIERS, Row
from roughgas.results.row_verdicts import (
    AGREES,
    DIFFERS,
    FALSE_DISCOVERIES,
    NO_ERROR,
    NOT_KNOWN,
    NOT_TESTED,
    Judgement,
    biases,
    detectable_share,
    judge,
)
from roughgas.statistics.estimates import SIGNIFICANT
from roughgas.statistics.student import t_quantile

NAMES = {
    AGREES: "agree",
    DIFFERS: "differ",
    NO_ERROR: "no_error",
    NOT_TESTED: "not_tested",
    NOT_KNOWN: "not_known",
}
"""Names of verdicts in the marks of a page."""
FEW_DOF = {"exact": 5, "theory": 3}
"""Degrees of freedom whose limit of t the page quotes, by tier."""
BIASED = "megias_santos", "mpemba"
"""Studies whose mean t of simulated rows the page quotes."""


def row_counts(rows: Sequence[tuple[str, Row]]) -> dict[str, str]:
    """Return the counts and means of published rows, as texts by the mark that a page has for each.

    `rows` are (study, row) pairs.
    """
    judged = list(zip([row for _, row in rows], judge([row for _, row in rows]), strict=True))
    texts = {"rows": f"{len(rows)}", "false_discoveries": f"{100 * FALSE_DISCOVERIES:g}"}
    texts["sources"] = f"{len({row.source for row, _ in judged})}"
    texts |= {name: f"{_count(judged, verdict)}" for verdict, name in NAMES.items()}
    for tier in TIERS:
        texts |= _of_tier(tier, [(row, judgement) for row, judgement in judged if row.tier == tier])
    texts["without_chance"] = f"{sum(row.is_without_chance for row, _ in judged)}"
    unpublished = [(study, row) for study, row in rows if row.is_without_error]
    texts["without_error"] = f"{len(unpublished)}"
    texts["without_error.studies"] = f"{len({study for study, _ in unpublished})}"
    return texts | dict(_of_far_rows(judged)) | dict(_of_biases(rows))


def _count(judged: Iterable[tuple[Row, Judgement]], verdict: str) -> int:
    """Return the number of rows with a verdict."""
    return sum(judgement.verdict == verdict for _, judgement in judged)


def _of_tier(tier: str, judged: Sequence[tuple[Row, Judgement]]) -> dict[str, str]:
    """Return the numbers of the rows of a tier: counts, level, limit of t, median detectable."""
    if not judged:
        return {}
    texts = {f"{tier}.{name}": f"{_count(judged, verdict)}" for verdict, name in NAMES.items()}
    texts[f"{tier}.rows"] = f"{len(judged)}"
    chance = [pair for pair in judged if math.isfinite(pair[0].t) and not pair[0].is_without_chance]
    texts[f"{tier}.with_t"] = f"{len(chance)}"
    if not chance:
        return texts
    level = chance[0][1].level
    texts[f"{tier}.level"] = _probability_text(level)
    if tier in FEW_DOF:
        texts[f"{tier}.t"] = f"{t_quantile(level, FEW_DOF[tier]):.1f}"
    shares = [100 * detectable_share(*pair) for pair in chance]
    return texts | {f"{tier}.detectable": f"{np.median(shares):.2g}"}


def _of_far_rows(judged: Iterable[tuple[Row, Judgement]]) -> Iterator[tuple[str, str]]:
    """Yield numbers of the rows that agree, although abs(t) is SIGNIFICANT or more."""
    far = [
        row
        for row, judgement in judged
        if judgement.verdict == AGREES and abs(row.t) >= SIGNIFICANT
    ]
    yield "far", f"{len(far)}"
    yield "far.theory", f"{sum(row.tier == 'theory' for row in far)}"


def _of_biases(rows: Sequence[tuple[str, Row]]) -> Iterator[tuple[str, str]]:
    """Yield numbers of sources with a common bias, and the mean t of simulations of BIASED."""
    means = biases(rows)
    tests = [bias for bias in means if bias.tier != "theory"]
    yield "biases", f"{len(tests)}"
    yield "biases.common", f"{sum(bias.is_common for bias in tests)}"
    for bias in tests:
        if bias.tier == "simulation" and bias.study in BIASED:
            yield f"t.{bias.study}", with_minus_signs(f"{bias.mean.value:.2f}")
            yield f"t.{bias.study}.stderr", f"{bias.mean.stderr:.2f}"
            yield f"t.{bias.study}.probability", _probability_text(bias.mean.probability)
            yield f"t.{bias.study}.rows", f"{bias.mean.dof + 1:.0f}"


def _probability_text(probability: float) -> str:
    """Return a probability as text of two digits, such as 0.0021 or 3.1e−09."""
    return with_minus_signs(f"{probability:.2g}")  # marks take no hyphen for part of a number
