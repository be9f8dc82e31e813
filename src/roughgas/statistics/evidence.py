"""Verdicts of three values, and the evidence that a measurement must show before it gets one."""

import math
from typing import NamedTuple

YES, NO, UNKNOWN = 1, 0, -1
"""The values of a verdict; UNKNOWN stands for a lack of evidence."""


class Evidence(NamedTuple):
    """What a measured window rests on; every number must reach that of LEAST."""

    collisions: float  # of each particle, made within it
    samples: int  # that its mean is made of; where a drive has a period, means over periods
    relaxations: float = math.inf  # e-folds of R, by theory, made before it
    runs: float = math.inf  # independent ones that it is averaged over, where it is over such

    def verdict(self, found: bool) -> int:
        """Return what was found as YES or NO; UNKNOWN if this is too little to rest on."""
        enough = all(have >= least for have, least in zip(self, LEAST, strict=True))
        return int(found) if enough else UNKNOWN


# Ten collisions per particle are a few e-folds of R where it relaxes fastest. Relaxations: the
# 95 % interval of a plateau that begins after three holds the truth in 87 % only (plateau.py).
# Runs: the spread of fewer is too badly known to show a drift.
LEAST = Evidence(collisions=10, samples=12, relaxations=5, runs=5)


def of_all(verdict: int, further: bool) -> int:
    """Return a verdict that also needs something further, which counts where the first is YES."""
    return (YES if further else NO) if verdict == YES else verdict
