"""Falls onto a vibrated floor that are hard to time, and the same falls in many digits.

A fall is (floor, gravity, height, speed, phase), as effects.floor.time_to_floor takes it.
"""

import math

import mpmath

from roughgas.effects.floor import Floor


class Exact:
    """The same fall in 50 digits: `gap` above the stroke's surface, continued for ever, at t."""

    def __init__(self, floor, gravity, height, speed, phase):
        numbers = floor.amplitude, floor.period, gravity, height, speed, phase
        self.A, self.P, self.g, self.y, self.v, self.phase = map(mpmath.mpf, map(float, numbers))
        self.V = self.A / self.P

    def gap(self, t, stroke):
        fallen = self.y + self.v * t - self.g * t**2 / 2
        return fallen - self.V * (self.phase + t - stroke * self.P)

    def strokes(self, t):
        """Those up to t in which the floor may be met, with the times at which they begin and end:
        the particle is met by none that lasts while it is above where all strokes end."""
        first, last = (int(mpmath.floor((self.phase + x) / self.P)) for x in (0, t))
        square = max(self.v**2 + 2 * self.g * (self.y - self.A), mpmath.mpf(0))
        up, down = ((self.v + s * mpmath.sqrt(square)) / self.g for s in (-1, 1))
        rises, falls = (int(mpmath.floor((self.phase + x) / self.P)) for x in (up, down))
        before, after = range(first, min(last, rises) + 1), range(max(first, falls - 1), last + 1)
        for stroke in {*before, *after}:
            begin, end = stroke * self.P - self.phase, (stroke + 1) * self.P - self.phase
            yield stroke, max(mpmath.mpf(0), begin), min(end, t)

    def depth(self, t):
        """How far below a surface the lowest point has been by t: a gap is least at an end."""
        return max(-self.gap(x, k) for k, *ends in self.strokes(t) for x in ends)

    def lengths(self, t):
        """The sum of the lengths that enter the gap: what roundings are relative to."""
        return self.y + self.A + (abs(self.v) + self.g * t + self.V) * (self.phase + t)

    def miss(self, t):
        """Distance from the surface at t, or from that of another stroke and from when it is."""
        k = int(mpmath.floor((self.phase + t) / self.P))
        edges = {k - 1: k * self.P - self.phase, k: t, k + 1: (k + 1) * self.P - self.phase}
        fast = abs(self.v) + self.g * t + self.V
        return min(abs(self.gap(t, stroke)) + fast * abs(t - x) for stroke, x in edges.items())


def dyadic(rng):
    """A fall that ends exactly where a stroke does, or somewhat above or below."""
    floor = Floor(*(2.0 ** rng.integers(-3, 3, 2)), 1.0, -1.0)
    gravity, speed = 2.0 ** rng.integers(-4, 4), rng.integers(-64, 65) / 8.0
    phase = rng.integers(0, 64) / 16.0 * floor.period
    return _shortly_before_or_after(rng, floor, gravity, speed, phase)


def general(rng):
    floor = Floor(*(10.0 ** rng.uniform(-1, 1, 2)), 1.0, -1.0)
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
    floor = Floor(10.0 ** rng.uniform(-1, 1), 2.0 ** rng.integers(10, 14), 1.0, -1.0)
    floor_speed, gravity = floor.amplitude / floor.period, 10.0 ** rng.uniform(-2, 2)
    phase = rng.choice((0.0, rng.uniform(0.0, 0.5) * floor.period))
    gap = rng.choice((0.0, -1e-16, 10.0 ** rng.uniform(-16, -10)))
    speed = floor_speed + rng.choice((-1.0, 0.0, 1.0)) * 10.0 ** rng.uniform(-16, -6)
    return floor, gravity, floor_speed * phase + gap, speed, phase
