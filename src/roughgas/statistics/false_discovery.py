"""Significance among many tests, by the share of false ones among the significant."""

from collections.abc import Sequence

import numpy as np


def false_discovery_level(probabilities: Sequence[float], rate: float) -> float:
    """Return the level for many tests: those with this probability or less are significant.

    On average at most the share `rate` in (0, 1) of the significant tests is then so by chance;
    without any true deviation, this is the probability of any significant test. Step-up procedure
    of Y. Benjamini & Y. Hochberg, J. R. Stat. Soc. B 57, 289 (1995), for tests that are independent
    or positively dependent: with k significant tests among m the level is (k + 1) rate/m, which
    the next probability exceeds. NaN without `probabilities`.
    """
    ascending = np.sort(np.asarray(probabilities, dtype=float))
    number = len(ascending)
    if number == 0:
        return float("nan")
    below = np.flatnonzero(ascending <= rate * np.arange(1, number + 1) / number)
    significant = int(below[-1]) + 1 if below.size else 0
    return rate * min(significant + 1, number) / number
