"""Samples: independent numbers with their errors at points of a sweep."""

from typing import NamedTuple

import numpy as np

from roughgas.statistics.estimate import SIGNIFICANT, Estimate
from roughgas.statistics.intervals import sum_error


class Sample(NamedTuple):
    """Independent numbers at points of a sweep, all columns 1-D and of one length.

    `places` has the coordinates of the points by name: r, beta, and any third parameter.
    """

    places: dict[str, np.ndarray]
    value: np.ndarray
    stderr: np.ndarray
    dof: np.ndarray

    @property
    def size(self) -> int:
        """Number of points."""
        return len(self.value)

    def at(self, index: int) -> Estimate:
        """Return the estimate at one point."""
        return Estimate(*(float(column[index]) for column in self[1:]))

    def where(self, mask: np.ndarray) -> "Sample":
        """Return the part of the sample where `mask` holds."""
        places = {name: column[mask] for name, column in self.places.items()}
        return Sample(places, *(column[mask] for column in self[1:]))

    def joined(self, other: "Sample") -> "Sample":
        """Return both samples as one."""
        places = {
            name: np.concatenate([column, other.places[name]])
            for name, column in self.places.items()
        }
        columns = zip(self[1:], other[1:], strict=True)
        return Sample(places, *(np.concatenate(pair) for pair in columns))

    def over(self, divisor: np.ndarray) -> "Sample":
        """Return the values in units of `divisor`, which is positive and exact."""
        return self._replace(value=self.value / divisor, stderr=self.stderr / divisor)

    def real(self) -> np.ndarray:
        """Return where the values differ from 0 significantly."""
        sigma = np.array([self.at(index).sigma for index in range(self.size)])
        return np.abs(sigma) >= SIGNIFICANT

    def off(self, tolerance: float) -> np.ndarray:
        """Return where the values differ from 0 significantly and by more than `tolerance`."""
        return self.real() & (np.abs(self.value) > tolerance)

    def vague(self, tolerance: float) -> np.ndarray:
        """Return where values larger than `tolerance` have errors too large to tell from 0."""
        return ~self.real() & (np.abs(self.value) > tolerance)

    def mean(self) -> Estimate:
        """Return the mean value, its error from the errors of the values."""
        stderr, dof = sum_error(self.stderr, self.dof)
        return Estimate(float(self.value.mean()), float(stderr) / self.size, float(dof))

    def rms(self) -> float:
        """Return the root mean square of the values."""
        return float(np.sqrt(np.mean(self.value**2)))

    def largest(self) -> tuple[Estimate, str]:
        """Return the value that is largest in size, and its place."""
        index = int(np.argmax(np.abs(self.value)))
        return self.at(index), self.place(index)

    def place(self, index: int) -> str:
        """Return such as "r = 0.9, beta = 0, mu = 0.1"."""
        pairs = ((name, column[index]) for name, column in self.places.items())
        return ", ".join(f"{name} = {written(value)}" for name, value in pairs)


def written(value: float | str) -> str:
    """Return a coordinate, a number or a word, as text."""
    return value if isinstance(value, str) else f"{value:g}"
