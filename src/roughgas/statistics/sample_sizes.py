"""Sample sizes of a measured window, and the minimum that verdicts on the window need.

A verdict is YES, NO or UNKNOWN. Theory decides by the length of the window; the noise of the run
may only veto.
"""

import math
from typing import Any, NamedTuple

import numpy as np

YES, NO, UNKNOWN = 1, 0, -1
"""The values of a verdict; UNKNOWN if the sample size is too small for one."""


class SampleSize(NamedTuple):
    """Amounts of data in a measured window, numbers or arrays; MINIMUM_SAMPLE_SIZE bounds them."""

    collisions: Any = math.inf  # per particle within the window
    samples: Any = math.inf  # number of samples; of period means if the drive has a period
    relaxations: Any = math.inf  # decay of a transient before the window, in e-folds of theory
    memories: Any = math.inf  # length in autocorrelation times of theory
    runs: Any = math.inf  # number of independent runs, of an average over runs
    phases: Any = math.inf  # phases of a periodic drive in the samples
    times: Any = math.inf  # length in measured autocorrelation times
    effective_samples: Any = math.inf  # see the function `effective_samples`

    def suffices(self, minimum: "SampleSize | None" = None) -> np.ndarray:
        """Return whether all amounts reach `minimum`, by default MINIMUM_SAMPLE_SIZE.

        A boolean array in the broadcast shape of the amounts.
        """
        sufficient: Any = True
        for number, limit in zip(
            self, MINIMUM_SAMPLE_SIZE if minimum is None else minimum, strict=True
        ):
            if number is not math.inf:  # which reaches any limit
                sufficient = sufficient & np.greater_equal(number, limit)
        return np.asarray(sufficient)

    def verdict(self, holds: bool, minimum: "SampleSize | None" = None) -> int:
        """Return YES if a statement `holds`, else NO; UNKNOWN if this sample size is too small.

        It is too small if it does not reach `minimum`, by default MINIMUM_SAMPLE_SIZE.
        """
        return int(holds) if self.suffices(minimum) else UNKNOWN


# Ten collisions per particle are a few e-folds of R where it relaxes fastest. Relaxations: the
# 95 % interval of a plateau that begins after three holds the truth in 87 % only (`find_plateau`).
# Memories: from twelve on the interval of R holds the truth in 92 to 98 % (docs/trust.md). Runs:
# the spread of fewer is too badly known to show a drift. Phases: R of a bed with 16 is within
# 0.0005 of R with 80. Times and effective samples are measured in the data, which may only veto:
# valid series pass.
MINIMUM_SAMPLE_SIZE = SampleSize(
    collisions=10,
    samples=12,
    relaxations=5,
    memories=12,
    runs=5,
    phases=16,
    times=6,
    effective_samples=12,
)


SHORTFALL_TEXTS = {
    "collisions": "{} collisions per particle",
    "samples": "{} samples",
    "relaxations": "{} e-folds of the slowest temperature",
    "memories": "window of {} memories",
    "runs": "{} replicas",
    "phases": "{} phases of the drive",
    "times": "window of {} measured autocorrelation times",
}


def describe_shortfall(sample_size: SampleSize, minimum: SampleSize) -> str:
    """Return in words the amounts of `sample_size` that do not reach `minimum`.

    An empty text if all do.
    """
    return "; ".join(
        f"{text.format(_floor(getattr(sample_size, name)))}, {getattr(minimum, name):g} needed"
        for name, text in SHORTFALL_TEXTS.items()
        if not getattr(sample_size, name) >= getattr(minimum, name)
    )


def _floor(number: float) -> int:
    """Return the number rounded down; 0 unless it is finite."""
    return math.floor(number) if math.isfinite(number) else 0


def verdict(
    steady: int, sample_size: SampleSize, minimum: SampleSize = MINIMUM_SAMPLE_SIZE
) -> np.ndarray:
    """Return whether confidence intervals are valid: hold the truth with the stated probability.

    Flags (int8: YES, NO or UNKNOWN) in the shape of the amounts of `sample_size`: `steady`, the
    flag of a steady state, if it is not YES; else YES where `minimum` is reached, and UNKNOWN
    elsewhere. Theory decides by the length of the window. The noise of the run can only veto, never
    confirm.
    """
    enough = sample_size.suffices(minimum)
    return np.where(enough | (steady != YES), steady, UNKNOWN).astype(np.int8)
