"""A ball that does not bounce, on the same floor: the lengths of its flights.

It leaves a floor at z = A sin(phase) when the floor falls away from it faster than g, from
sin(phase) = 1/Gamma on, at once if it lands where sin(phase) > 1/Gamma (A. Mehta and J. M. Luck,
Phys. Rev. Lett. 65, 393, 1990). A flight takes one cycle for sqrt(1 + pi^2) <= Gamma <= sqrt(4 +
pi^2); at larger Gamma a long and a short flight take turns, until one leaps over a full cycle, and
so on.
"""

import itertools
import math
from collections.abc import Iterator

import numpy as np

LANDING_STEP, BISECTIONS = 1e-3, 50  # of the search for a landing, in radians
CYCLE = 2.0 * math.pi
TRANSIENT_FLIGHTS = 200


def flights(gamma: float) -> list[float]:
    """Return the lengths, in cycles, of the flights that repeat: one, or two that take turns."""
    *_, next_to_last, last = (
        length / CYCLE for _, length in itertools.islice(_flights(gamma), TRANSIENT_FLIGHTS)
    )
    return (
        [last] if math.isclose(last, next_to_last, rel_tol=1e-3) else sorted((last, next_to_last))
    )


def ball_heights(gamma: float, phase: np.ndarray) -> np.ndarray:
    """Return heights of the ball over A, once its flights repeat, at rising phases of the floor."""
    height = np.sin(phase)
    all_flights = list(itertools.islice(_flights(gamma), TRANSIENT_FLIGHTS))
    before = CYCLE * (all_flights[TRANSIENT_FLIGHTS // 2][0] // CYCLE)
    for start, length in all_flights[TRANSIENT_FLIGHTS // 2 - 1 :]:
        time = phase + before - start
        flies = (time > 0.0) & (time < length)
        flight = math.sin(start) + math.cos(start) * time - 0.5 * time**2 / gamma
        height = np.where(flies, flight, height)
    return height


def _flights(gamma: float) -> Iterator[tuple[float, float]]:
    """Yield begin (phase) and length of each flight, in radians."""
    first = phase = math.asin(1.0 / gamma)
    while True:
        length = _flight_length(phase, gamma)
        yield phase, length
        phase += length
        if math.sin(phase) <= 1.0 / gamma:  # it lies until the floor falls away
            phase = first + CYCLE * math.ceil((phase - first) / CYCLE)


def _flight_length(phase, gamma):
    """Return the length of a flight that begins at `phase`, in radians; A = 1."""

    def gap(time):
        fall = 0.5 * time**2 / gamma
        return math.sin(phase) + math.cos(phase) * time - fall - math.sin(phase + time)

    low = LANDING_STEP * 20.0  # past the take-off, where the gap is less than its rounding
    while gap(low + LANDING_STEP) > 0.0:
        low += LANDING_STEP
    high = low + LANDING_STEP
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if gap(middle) > 0.0 else (low, middle)
    return low
