"""Falls onto a vibrated floor whose hits are hard to time, and the same falls in many digits.

A fall is (floor, gravity, height, speed, phase), as effects.motions.time_to_piecewise takes it.
"""

import math

import mpmath

from hard_cases.waves import Fall
from roughgas.effects.motions import sawtooth


class Exact(Fall):
    """A fall in many digits; `gap` is the height above the surface of a stroke without end."""

    @property
    def fastest(self):
        """The speed of the floor."""
        return self.A / self.P

    def gap(self, t, stroke):
        """Height of the particle above the surface of a stroke at t."""
        return self.height(t) - self.fastest * (self.phase + t - stroke * self.P)

    def strokes(self, t):
        """(stroke, begin, end) of the strokes up to t that may hit the particle.

        No stroke hits it while it is higher than the end of strokes.
        """
        first = int(mpmath.floor(self.phase / self.P))
        numbers = {first}
        for window in self._windows(t):
            earliest, latest = (int(mpmath.floor((self.phase + x) / self.P)) for x in window)
            numbers |= set(range(max(first, earliest - 1), latest + 1))
        for stroke in numbers:
            begin, end = stroke * self.P - self.phase, (stroke + 1) * self.P - self.phase
            yield stroke, max(mpmath.mpf(0), begin), min(end, t)

    def depth(self, t):
        """Greatest depth of the lowest point below a surface up to t: gaps are least at an end."""
        return max(-self.gap(x, k) for k, *ends in self.strokes(t) for x in ends)

    def miss(self, t):
        """Distance from the surface at t, or from the end or start of a neighbouring stroke."""
        k = int(mpmath.floor((self.phase + t) / self.P))
        edges = {k - 1: k * self.P - self.phase, k: t, k + 1: (k + 1) * self.P - self.phase}
        fast = abs(self.v) + self.g * t + self.fastest
        return min(abs(self.gap(t, stroke)) + fast * abs(t - x) for stroke, x in edges.items())


def dyadic(rng):
    """A fall of dyadic numbers that ends at the end of a stroke, or slightly above or below."""
    floor = sawtooth(*(2.0 ** rng.integers(-3, 3, 2)))
    gravity, speed = 2.0 ** rng.integers(-4, 4), rng.integers(-64, 65) / 8.0
    phase = rng.integers(0, 64) / 16.0 * floor.period
    return _fall_to_end_of_stroke(rng, floor, gravity, speed, phase)


def general(rng):
    """A fall of general numbers that ends near the end of a stroke."""
    floor = sawtooth(*(10.0 ** rng.uniform(-1, 1, 2)))
    gravity = 10.0 ** rng.uniform(-3, 2)
    speed = rng.choice((-1.0, 1.0)) * 10.0 ** rng.uniform(-1, 3)
    phase = rng.uniform(0.0, 100.0) * floor.period
    return _fall_to_end_of_stroke(rng, floor, gravity, speed, phase)


def _fall_to_end_of_stroke(rng, floor, gravity, speed, phase):
    """A fall from the height that leads to the end of a stroke, or slightly more or less."""
    surface = floor.amplitude * (phase / floor.period % 1.0)
    flight = max(0.0, 2.0 * speed / gravity)  # until it returns to the height of the start
    stroke = math.floor((phase + flight) / floor.period) + rng.integers(0, 3)
    while True:
        t = stroke * floor.period - phase
        height = floor.amplitude + 0.5 * gravity * t * t - speed * t
        if height > surface:
            break
        stroke += 1
    height *= 1.0 + rng.integers(-1, 2) * 10.0 ** rng.uniform(-16, -8)
    return floor, gravity, height, speed, phase


def nearly_at_rest(rng):
    """A start on the surface of the first stroke, or within rounding above or below it."""
    floor = sawtooth(10.0 ** rng.uniform(-1, 1), 2.0 ** rng.integers(10, 14))
    floor_speed, gravity = floor.amplitude / floor.period, 10.0 ** rng.uniform(-2, 2)
    phase = rng.choice((0.0, rng.uniform(0.0, 0.5) * floor.period))
    gap = rng.choice((0.0, -1e-16, 10.0 ** rng.uniform(-16, -10)))
    speed = floor_speed + rng.choice((-1.0, 0.0, 1.0)) * 10.0 ** rng.uniform(-16, -6)
    return floor, gravity, floor_speed * phase + gap, speed, phase
