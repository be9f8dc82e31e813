"""Falls onto floors of any wave form, in many digits.

A fall is (floor, gravity, height, speed, phase), as effects.motions.time_to_sine takes it. The gap
to the floor is monotone between its stationary points and kinks: values at these bracket its first
root, which follows by bisection.
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
        """Height of the lowest point of the particle at t."""
        return self.y + self.v * t - self.g * t**2 / 2

    def gap(self, t):
        """Height of the particle above the floor at t."""
        return self.height(t) - self.surface(t)[0]

    def speed(self, t):
        """Rate of change of the gap."""
        return self.v - self.g * t - self.surface(t)[1]

    def lengths(self, t):
        """Sum of the lengths that enter the gap, the scale of its roundings."""
        return self.y + self.A + (abs(self.v) + self.g * t + self.fastest) * (abs(self.phase) + t)

    def depth(self, t):
        """Greatest depth of the particle below the floor up to t, beyond its initial depth.

        Of a particle that sinks on, a depth of more than a hundredth of the amplitude.
        """
        initial = min(self.gap(0), mpmath.mpf(0))
        lowest = min(self.gap(t), initial)
        for x in self.stations(t):
            lowest = min(lowest, self.gap(x))
            if lowest < initial - self.A / 100:
                break
        return initial - lowest

    def first(self):
        """Time of the first contact with the floor.

        A particle that starts on the floor, or below it by rounding, and leaves it meets it later.
        """
        level = min(self.gap(0), mpmath.mpf(0))
        if self.gap(0) <= level and self.speed(0) < 0:
            return mpmath.mpf(0)
        drop = self.v**2 + 2 * self.g * (self.y + abs(self.y) / 10**6 + mpmath.mpf(10) ** -9)
        end = (self.v + mpmath.sqrt(drop)) / self.g  # below the lowest point of the floor by then
        above = mpmath.mpf(0)
        for x in [*self.stations(end), end]:
            if self.gap(x) < level:
                return self._bisect(lambda t: self.gap(t) - level, above, x)
            above = x
        raise AssertionError("never below the floor")

    def stations(self, end):
        """The times up to `end` between which the gap is monotone, in order.

        Times when the particle is above all strokes are left out.
        """
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
        """Intervals of time when the particle is not above all strokes."""
        square = self.v**2 + 2 * self.g * (self.y - self.A)
        if square <= 0:
            return [(mpmath.mpf(0), end)]
        up, down = ((self.v + s * mpmath.sqrt(square)) / self.g for s in (-1, 1))
        windows = (mpmath.mpf(0), min(up, end)), (max(mpmath.mpf(0), down), end)
        return [(a, b) for a, b in windows if a < b]

    def _stationary(self, a, b):
        """The time between a and b when the gap is stationary, if any; its speed is monotone."""
        inside = (b - a) * mpmath.mpf(10) ** -30  # the speed is discontinuous at kinks
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
    """Share of a period during which a floor rises at constant speed; 1 for a sawtooth."""
    return (*floor.shares, 1.0)[1]


class SineFall(Fall):
    """A fall onto a sine."""

    @property
    def fastest(self):
        return self.A * mpmath.pi / self.P

    def surface(self, t):
        angle = 2 * mpmath.pi * (self.phase + t) / self.P
        return self.A * (1 - mpmath.cos(angle)) / 2, self.fastest * mpmath.sin(angle)

    def edges(self):
        """Shares of a period between which the acceleration of the floor plus g keeps its sign."""
        sharpest = self.A / 2 * (2 * mpmath.pi / self.P) ** 2
        if sharpest <= self.g:
            return [0, 1]
        turn = mpmath.acos(-self.g / sharpest) / (2 * mpmath.pi)
        return [0, turn, 1 - turn, 1]


class TriangularFall(Fall):
    """A fall onto a floor that rises and falls at constant speeds."""

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
    """The Fall in many digits."""
    return (SineFall if isinstance(floor, Sine) else TriangularFall)(floor, *fall)


def level(floor, phase):
    """Height of the surface of a floor at a phase, in double precision."""
    share = phase / floor.period % 1.0
    if isinstance(floor, Sine):
        return floor.amplitude * math.sin(math.pi * share) ** 2
    rise = rise_of(floor)
    return floor.amplitude * (share / rise if share < rise else (1.0 - share) / (1.0 - rise))
