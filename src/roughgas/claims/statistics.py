"""How far a number lies from what it is compared with, in size and in standard errors.

The standard error of a point comes from a few seeds, so it is itself uncertain: by 40 % with four.
Two things are done about that. The errors of one experiment are pooled: seeds calibrate the errors
that blocking gives within the files by one common factor, and a point's error is that, or its own
scatter over seeds where larger. And significances follow from Student's t with the degrees of
freedom of the pool, expressed as the sigma of a Gaussian with the same probability.
"""

import math
from typing import NamedTuple

import numpy as np

from roughgas.statistics.errors import gaussian_sigmas

SIGNIFICANT = 3.0
"""Sigma from which a difference counts as real."""


class Estimate(NamedTuple):
    """A number with its standard error, known with so many degrees of freedom."""

    value: float
    error: float
    freedom: float = math.inf

    @property
    def sigma(self) -> float:
        """How significantly it differs from 0, with its sign; NaN where the error is unknown."""
        if not math.isfinite(self.error) or self.error < 0:
            return math.nan
        if self.error == 0:
            return math.copysign(math.inf, self.value) if self.value else 0.0
        ratio = self.value / self.error
        return ratio if math.isinf(self.freedom) else float(gaussian_sigmas(ratio, self.freedom))

    @property
    def real(self) -> bool:
        """Whether it differs from 0 significantly."""
        return abs(self.sigma) >= SIGNIFICANT

    def minus(self, other: "Estimate") -> "Estimate":
        """The difference of two independent estimates."""
        error = math.hypot(self.error, other.error)
        return Estimate(self.value - other.value, error, min(self.freedom, other.freedom))


class Sample(NamedTuple):
    """Independent numbers with errors at points of a sweep, all 1-D and of one length.

    `places` has the coordinates of the points by name: r, beta, and what is swept besides.
    """

    places: dict[str, np.ndarray]
    value: np.ndarray
    error: np.ndarray
    freedom: float

    @property
    def size(self) -> int:
        """How many numbers."""
        return len(self.value)

    def at(self, index: int) -> Estimate:
        """The estimate at one place."""
        return Estimate(float(self.value[index]), float(self.error[index]), self.freedom)

    def where(self, mask: np.ndarray) -> "Sample":
        """The part of the sample where `mask` holds."""
        places = {name: column[mask] for name, column in self.places.items()}
        return Sample(places, self.value[mask], self.error[mask], self.freedom)

    def joined(self, other: "Sample") -> "Sample":
        """Both samples as one."""
        places = {
            name: np.concatenate([column, other.places[name]])
            for name, column in self.places.items()
        }
        value = np.concatenate([self.value, other.value])
        error = np.concatenate([self.error, other.error])
        return Sample(places, value, error, min(self.freedom, other.freedom))

    def sigma(self) -> np.ndarray:
        """Significance of each value's difference from 0."""
        return np.array([self.at(index).sigma for index in range(self.size)])

    def mean(self) -> Estimate:
        """Mean value, its error from the errors of the values."""
        error = math.sqrt(float(np.sum(self.error**2))) / self.size
        return Estimate(float(self.value.mean()), error, self.freedom)

    def rms(self) -> float:
        """Root mean square of the values."""
        return math.sqrt(float(np.mean(self.value**2)))

    def largest(self) -> tuple[Estimate, str]:
        """The value of largest size, and where it is."""
        index = int(np.argmax(np.abs(self.value)))
        return self.at(index), self.place(index)

    def place(self, index: int) -> str:
        """Such as "r = 0.9, beta = 0, mu = 0.1"."""
        pairs = ((name, column[index]) for name, column in self.places.items())
        return ", ".join(f"{name} = {written(value)}" for name, value in pairs)


def written(value: float | str) -> str:
    """A coordinate, which is a number or a word."""
    return value if isinstance(value, str) else f"{value:g}"


def pooled_errors(
    between: np.ndarray, within: np.ndarray, seeds: np.ndarray
) -> tuple[np.ndarray, float]:
    """Standard errors of the points of an experiment, and their degrees of freedom.

    `between`: from the scatter over seeds; `within`: from inside the files; `seeds`: how many.
    The common factor is the median of between/within, so that a few drifting points cannot set it.
    """
    freedom = np.maximum(seeds - 1, 0)
    usable = (freedom > 0) & (within > 0) & np.isfinite(between)
    if not usable.any():
        alone = freedom[freedom > 0]
        return between, float(np.median(alone)) if alone.size else math.inf
    typical = float(np.median(freedom[usable]))
    median_of_chi_square = (1 - 2 / (9 * typical)) ** 3  # over its freedom; Wilson and Hilferty
    square = np.median((between[usable] / within[usable]) ** 2)
    factor = math.sqrt(float(square) / median_of_chi_square)
    return np.fmax(between, factor * within), float(freedom[usable].sum())
