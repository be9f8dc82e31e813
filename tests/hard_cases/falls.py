"""Falls onto a vibrated floor that are hard to time, and the same falls in many digits.

A fall is (floor, gravity, height, speed, phase), as effects.motions.time_to_pieces takes it.
"""

import math

import mpmath

from hard_cases.waves import Fall
from roughgas.effects.motions import sawtooth


class Exact(Fall):
    """The same fall in many digits: `gap` above the stroke's surface, continued for ever, at t."""

    @property
    def fastest(self):
        return self.A / self.P

    def gap(self, t, stroke):
        return self.height(t) - self.fastest * (self.phase + t - stroke * self.P)

    def strokes(self, t):
        """Those up to t in which the floor may be met, with the times at which they begin and end:
        the particle is met by none that lasts while it is above where all strokes end."""
        first = int(mpmath.floor(self.phase / self.P))
        found = {first}
        for window in self._windows(t):
            one, last = (int(mpmath.floor((self.phase + x) / self.P)) for x in window)
            found |= set(range(max(first, one - 1), last + 1))
        for stroke in found:
            begin, end = stroke * self.P - self.phase, (stroke + 1) * self.P - self.phase
            yield stroke, max(mpmath.mpf(0), begin), min(end, t)

    def depth(self, t):
        """How far below a surface the lowest point has been by t: a gap is least at an end."""
        return max(-self.gap(x, k) for k, *ends in self.strokes(t) for x in ends)

    def miss(self, t):
        """Distance from the surface at t, or from that of another stroke and from when it is."""
        k = int(mpmath.floor((self.phase + t) / self.P))
        edges = {k - 1: k * self.P - self.phase, k: t, k + 1: (k + 1) * self.P - self.phase}
        fast = abs(self.v) + self.g * t + self.fastest
        return min(abs(self.gap(t, stroke)) + fast * abs(t - x) for stroke, x in edges.items())


def dyadic(rng):
    """A fall that ends exactly where a stroke does, or somewhat above or below."""
    floor = sawtooth(*(2.0 ** rng.integers(-3, 3, 2)))
    gravity, speed = 2.0 ** rng.integers(-4, 4), rng.integers(-64, 65) / 8.0
    phase = rng.integers(0, 64) / 16.0 * floor.period
    return _shortly_before_or_after(rng, floor, gravity, speed, phase)


def general(rng):
    floor = sawtooth(*(10.0 ** rng.uniform(-1, 1, 2)))
    gravity = 10.0 ** rng.uniform(-3, 2)
    speed = rng.choice((-1.0, 1.0)) * 10.0 ** rng.uniform(-1, 3)
    phase = rng.uniform(0.0, 100.0) * floor.period
    return _shortly_before_or_after(rng, floor, gravity, speed, phase)


def _shortly_before_or_after(rng, floor, gravity, speed, phase):
    """The height from which the end of a stroke is met, or somewhat more or less."""
    surface = floor.amplitude * (phase / floor.period % 1.0)
    flight = max(0.0, 2.0 * speed / gravity)  # until it is back at the height of the start
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
    """On the first stroke's surface, or so; half of the starts are exactly on it or below."""
    floor = sawtooth(10.0 ** rng.uniform(-1, 1), 2.0 ** rng.integers(10, 14))
    floor_speed, gravity = floor.amplitude / floor.period, 10.0 ** rng.uniform(-2, 2)
    phase = rng.choice((0.0, rng.uniform(0.0, 0.5) * floor.period))
    gap = rng.choice((0.0, -1e-16, 10.0 ** rng.uniform(-16, -10)))
    speed = floor_speed + rng.choice((-1.0, 0.0, 1.0)) * 10.0 ** rng.uniform(-16, -6)
    return floor, gravity, floor_speed * phase + gap, speed, phase
