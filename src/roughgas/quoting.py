"""Building blocks for quoted.py of a study: the numbers and tables that its README.md quotes.

quoted.py has the functions `numbers` and `tables` of all rows of evidence, which return texts by
name; roughgas.claims.pages collects them.
"""

from collections import Counter
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path

import numpy as np

from roughgas import config
from roughgas.base import Record
from roughgas.base.text import with_minus_signs
from roughgas.claims.numbers import in_words
from roughgas.claims.pages import Evidence
from roughgas.results.comparison import Row
from roughgas.results.row_verdicts import AGREES, DIFFERS, NOT_TESTED, verdicts
from roughgas.statistics.estimates import Estimate, mean_with_error


@cache
def settings_at_paper_scale(folder: Path, experiment: str) -> Record:
    """Return the settings of an experiment of the study in `folder`, at the scale `paper`.

    `folder` is studies/NAME of a checkout. Raises InputError.
    """
    configuration = config.load(folder.parents[1] / "config.yaml")
    return configuration.experiment(f"{folder.name}.{experiment}", config.PAPER).raw


def rows_of(evidence: Evidence, study: str, quantity: str, tier: str = "") -> Mapping[str, Row]:
    """Return the rows of a quantity of a study by their state `at`, of all tiers or of one."""
    return {
        row.at: row
        for name, row in evidence
        if (name, row.quantity) == (study, quantity) and tier in ("", row.tier)
    }


def verdict_counts(evidence: Evidence, study: str) -> Counter[str]:
    """Return the numbers of rows of a study by verdict; verdicts depend on all rows of evidence."""
    judged = zip(evidence, verdicts([row for _, row in evidence]), strict=True)
    return Counter(verdict for (name, _), verdict in judged if name == study)


def relative(row: Row) -> Estimate:
    """Return ours over theirs, which count as exact."""
    return row.ours.scaled(1.0 / row.theirs.value)


def mean_of(estimates: Iterable[Estimate]) -> Estimate:
    """Return the mean of independent estimates, with the error that follows from their errors."""
    return mean_with_error(*np.array(list(estimates)).T)


def rounded(value: float, decimals: int = 0) -> str:
    """Return a number as text with so many decimals, and with a minus sign, no hyphen."""
    return with_minus_signs(f"{value:.{decimals}f}")


def with_error(estimate: Estimate, scale: float = 1.0) -> str:
    """Return an estimate times `scale` as text, such as −0.0012(3)."""
    return with_minus_signs(f"{estimate.scaled(scale)}")
