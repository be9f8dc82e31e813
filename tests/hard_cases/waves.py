"""Falls onto floors of any wave form, in many digits.

A fall is (floor, gravity, height, speed, phase), as effects.motions.time_to_sine takes it. Between
the times at which the gap to the floor has a stationary point or a kink it is monotone: what it
does follows from its values there, and its first root from bisection.
"""

import itertools
import math

import mpmath

from roughgas.effects.motions import Sine

DIGITS = 40


class Fall:
    """The exact gap between a particle's lowest point and the floor."""

    def __init__(self, floor, gravity, height, speed, phase):
        self.floor = floor
        numbers = floor.amplitude, floor.period, gravity, height, speed, phase
        self.A, self.P, self.g, self.y, self.v, self.phase = map(mpmath.mpf, map(float, numbers))

    def height(self, t):
        return self.y + self.v * t - self.g * t**2 / 2

    def gap(self, t):
        return self.height(t) - self.surface(t)[0]

    def speed(self, t):
        """That at which the gap opens."""
        return self.v - self.g * t - self.surface(t)[1]

    def lengths(self, t):
        """The sum of the lengths that enter the gap: what roundings are relative to."""
        return self.y + self.A + (abs(self.v) + self.g * t + self.fastest) * (abs(self.phase) + t)

    def depth(self, t):
        """How far below the floor the particle has been by t, if more than at first; of one that
        sinks, so far that it shows."""
        first = min(self.gap(0), mpmath.mpf(0))
        least = min(self.gap(t), first)
        for x in self.stations(t):
            least = min(least, self.gap(x))
            if least < first - self.A / 100:
                break
        return first - least

    def first(self):
        """When the particle meets the floor; one that is on it, or below by rounding, and leaves
        it does so later."""
        level = min(self.gap(0), mpmath.mpf(0))
        if self.gap(0) <= level and self.speed(0) < 0:
            return mpmath.mpf(0)
        drop = self.v**2 + 2 * self.g * (self.y + abs(self.y) / 10**6 + mpmath.mpf(10) ** -9)
        end = (self.v + mpmath.sqrt(drop)) / self.g  # it would be below where the floor ever is
        above = mpmath.mpf(0)
        for x in [*self.stations(end), end]:
            if self.gap(x) < level:
                return self._bisect(lambda t: self.gap(t) - level, above, x)
            above = x
        raise AssertionError("never below the floor")

    def stations(self, end):
        """In order, the times up to `end` between which the gap is monotone, wherever the particle
        is not above all strokes."""
        yield mpmath.mpf(0)
        for begin, stop in self._windows(end):
            period = int(mpmath.floor((self.phase + begin) / self.P))
            while (start := period * self.P - self.phase) < stop:
                edges = [start + x * self.P for x in self.edges()]
                for a, b in itertools.pairwise(edges):
                    a, b = max(a, begin), min(b, stop)
                    if a < b:
                        yield a
                        yield from self._stationary(a, b)
                        yield b
                period += 1

    def _windows(self, end):
        """When the particle is not above all strokes."""
        square = self.v**2 + 2 * self.g * (self.y - self.A)
        if square <= 0:
            return [(mpmath.mpf(0), end)]
        up, down = ((self.v + s * mpmath.sqrt(square)) / self.g for s in (-1, 1))
        windows = (mpmath.mpf(0), min(up, end)), (max(mpmath.mpf(0), down), end)
        return [(a, b) for a, b in windows if a < b]

    def _stationary(self, a, b):
        """Where the gap, whose speed is monotone there, is stationary between a and b."""
        inside = (b - a) * mpmath.mpf(10) ** -30  # a kink has two speeds
        if self.speed(a + inside) * self.speed(b - inside) < 0:
            yield self._bisect(self.speed, a + inside, b - inside)

    @staticmethod
    def _bisect(function, a, b):
        rises = function(b) > 0
        for _ in range(110):
            middle = (a + b) / 2
            a, b = (a, middle) if (function(middle) > 0) == rises else (middle, b)
        return b


def rise_of(floor):
    """Share of a period in which a floor goes up at constant speed; 1 is a sawtooth."""
    return (*floor.shares, 1.0)[1]


class SineFall(Fall):
    @property
    def fastest(self):
        return self.A * mpmath.pi / self.P

    def surface(self, t):
        angle = 2 * mpmath.pi * (self.phase + t) / self.P
        return self.A * (1 - mpmath.cos(angle)) / 2, self.fastest * mpmath.sin(angle)

    def edges(self):
        """Shares of a period between which the floor's acceleration + g keeps its sign."""
        sharpest = self.A / 2 * (2 * mpmath.pi / self.P) ** 2
        if sharpest <= self.g:
            return [0, 1]
        turn = mpmath.acos(-self.g / sharpest) / (2 * mpmath.pi)
        return [0, turn, 1 - turn, 1]


class TriangularFall(Fall):
    @property
    def fastest(self):
        rise = rise_of(self.floor)
        return self.A / self.P / min(rise, 1 - rise)

    def surface(self, t):
        rise = mpmath.mpf(rise_of(self.floor))
        share = (self.phase + t) / self.P
        share -= mpmath.floor(share)
        if share < rise:
            return self.A * share / rise, self.A / (rise * self.P)
        return self.A * (1 - share) / (1 - rise), -self.A / ((1 - rise) * self.P)

    def edges(self):
        return [0, mpmath.mpf(rise_of(self.floor)), 1]


def exact(floor, *fall):
    """The same fall in many digits."""
    return (SineFall if isinstance(floor, Sine) else TriangularFall)(floor, *fall)


def level(floor, phase):
    """Height of the surface, in double precision."""
    share = phase / floor.period % 1.0
    if isinstance(floor, Sine):
        return floor.amplitude * math.sin(math.pi * share) ** 2
    rise = rise_of(floor)
    return floor.amplitude * (share / rise if share < rise else (1.0 - share) / (1.0 - rise))
