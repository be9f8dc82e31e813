"""A ball that does not bounce, on the same floor: how long its flights are.

It leaves a floor at z = A sin(phase) when that falls away from it faster than g, from sin(phase) =
1/Gamma on, at once if it lands then (A. Mehta and J. M. Luck, Phys. Rev. Lett. 65, 393, 1990). A
flight takes one cycle for sqrt(1 + pi^2) <= Gamma <= sqrt(4 + pi^2); then a long and a short one
take turns, until one leaps over a whole cycle, and so on.
"""

import itertools
import math
from collections.abc import Iterator

import numpy as np

STEP, BISECTIONS = 1e-3, 50  # of the search for a landing, in radians
CYCLE = 2.0 * math.pi
WAIT = 200  # flights until they repeat


def flights(gamma: float) -> list[float]:
    """Return the lengths, in cycles, of the flights that repeat: one, or two that take turns."""
    *_, other, last = (length / CYCLE for _, length in itertools.islice(_leaps(gamma), WAIT))
    return [last] if math.isclose(last, other, rel_tol=1e-3) else sorted((last, other))


def path(gamma: float, phase: np.ndarray) -> np.ndarray:
    """Return heights of the ball over A, once its flights repeat, at rising phases of the floor."""
    height = np.sin(phase)
    leaps = list(itertools.islice(_leaps(gamma), WAIT))
    before = CYCLE * (leaps[WAIT // 2][0] // CYCLE)
    for start, length in leaps[WAIT // 2 - 1 :]:
        time = phase + before - start
        flies = (time > 0.0) & (time < length)
        flight = math.sin(start) + math.cos(start) * time - 0.5 * time**2 / gamma
        height = np.where(flies, flight, height)
    return height


def _leaps(gamma: float) -> Iterator[tuple[float, float]]:
    """Yield the phases at which flights begin, and how long they are, in radians."""
    first = phase = math.asin(1.0 / gamma)
    while True:
        length = _flight(phase, gamma)
        yield phase, length
        phase += length
        if math.sin(phase) <= 1.0 / gamma:  # it lies until the floor falls away
            phase = first + CYCLE * math.ceil((phase - first) / CYCLE)


def _flight(phase, gamma):
    """Return how long a flight takes that begins at a phase, in radians; A = 1."""

    def gap(time):
        fall = 0.5 * time**2 / gamma
        return math.sin(phase) + math.cos(phase) * time - fall - math.sin(phase + time)

    low = STEP * 20.0  # beyond the take-off, where the gap is less than its rounding
    while gap(low + STEP) > 0.0:
        low += STEP
    high = low + STEP
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if gap(middle) > 0.0 else (low, middle)
    return low
