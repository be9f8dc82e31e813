"""Kicks of a thermostat and steps of a Langevin bath, and their random numbers, in plain integers
and lists."""

import math
from typing import NamedTuple

import numpy as np

WORD = 2**64


class SplitMix:
    """SplitMix64 (Steele, Lea and Flood, OOPSLA 2014, Fig. 13); `word` is the generator's state."""

    def __init__(self, word):
        self.word = int(word)

    def next_integer(self):
        """The next random integer in [0, 2^64)."""
        self.word = (self.word + 0x9E3779B97F4A7C15) % WORD
        z = self.word
        z = (z ^ (z // 2**30)) * 0xBF58476D1CE4E5B9 % WORD
        z = (z ^ (z // 2**27)) * 0x94D049BB133111EB % WORD
        return z ^ (z // 2**31)

    def gaussian(self):
        """A Gaussian random number of variance 1, by Marsaglia's polar method."""
        square = 0.0
        while not 0.0 < square < 1.0:
            x, y = 2.0 * self.uniform() - 1.0, 2.0 * self.uniform() - 1.0
            square = x * x + y * y
        return x * math.sqrt(-2.0 * math.log(square) / square)

    def uniform(self):
        """A random number in [0, 1), from the 53 leading bits of an integer."""
        return (self.next_integer() // 2**11) / 2**53


class Drive(NamedTuple):
    """The state of a thermostat or of a bath."""

    due: list  # absolute time of each particle's next kick or step
    word: int  # the generator's state
    order: list  # particles, in the order of the list that partners are drawn from


class Kicks:
    """The kicks of a thermostat, from its settings, which may grow as a power of the speed."""

    def __init__(self, thermostat, inertia, dimension, drive, bodies):
        self.bodies = bodies
        power, share, self.interval = (
            thermostat[key] for key in ("power", "spin_share", "interval")
        )
        self.speed, self.exponent = thermostat.get("speed", 1.0), thermostat.get("exponent", 0.0)
        self.inertia, self.dimension, self.spins = inertia, dimension, 2 * dimension - 3
        self.due, self.order = list(drive.due), list(drive.order)
        self.random = SplitMix(drive.word)
        energy = power * self.interval
        # a component that is uniform in [-k, k] has the mean square k^2/3, and two particles get it
        self.kick = math.sqrt((1.0 - share) * energy / dimension * 3.0)
        self.spin_kick = (
            math.sqrt(share * energy / (self.spins * inertia) * 3.0) if inertia else 0.0
        )

    def next_event(self, time):
        """(wait, kind, particle, -1) of the next kick."""
        due = min(self.due)
        return max(0.0, due - time), "kick", self.due.index(due), -1

    def apply(self, i, x, v, w):
        """Kick particle i and a random partner, in the arrays of velocities and of spins."""
        candidates = [k for k in self.order if k != i]
        j = candidates[math.floor(self.random.uniform() * len(candidates))]
        m = self.bodies.mass
        growth = (math.sqrt(v[i] @ v[i]) / self.speed) ** self.exponent
        # so that p^2/2 (1/m_i + 1/m_j) is the same for any pair
        size = growth * self.kick * math.sqrt(2.0 / (1.0 / m[i] + 1.0 / m[j]))
        for axis in range(self.dimension):
            kick = self._component(size)
            v[i, axis] += kick / m[i]
            v[j, axis] -= kick / m[j]
        if self.inertia:
            for k in (i, j):
                size = growth * self.spin_kick * math.sqrt(self.inertia / (m[k] * self.bodies.q[k]))
                for axis in range(3 - self.spins, 3):
                    w[k, axis] += self._component(size)
        self.due[i] += self.interval

    def _component(self, size):
        """A random number, uniform in [-size, size]."""
        return size * (2.0 * self.random.uniform() - 1.0)


class Bath:
    """The steps of drag and noise of a Langevin bath, from its settings."""

    def __init__(self, bath, inertia, dimension, drive, bodies):
        self.bath, self.bodies, self.due = bath, bodies, list(drive.due)
        self.rotates, self.dimension, self.spins = bool(inertia), dimension, 2 * dimension - 3
        self.random = SplitMix(drive.word)

    def next_event(self, time):
        """(wait, kind, particle, -1) of the next step."""
        due = min(self.due)
        return max(0.0, due - time), "kick", self.due.index(due), -1

    def apply(self, i, x, v, w):
        """Apply a step to particle i at x[i] in the box, in the arrays of velocities and spins."""
        m = self.bodies.mass[i]
        flow = np.zeros(self.dimension)
        if self.bath["shear"]:
            flow[0] = self.bath["shear"] * (x[i, 1] / self.bath["height"] - 0.5)
        self._step(v[i], flow, range(self.dimension), m, "")
        if self.rotates:
            target = np.zeros(3)
            target["xyz".index(self.bath.get("spin_axis", "z"))] = (
                self.bath["spin_velocities"][self.bodies.species[i]] * self.bodies.radius[i]
            )
            self._step(w[i], target, range(3 - self.spins, 3), m * self.bodies.q[i], "spin_")
        self.due[i] += self.bath["interval"]

    def _step(self, velocity, target, axes, mass, prefix):
        """Advance a velocity u by a step h of du = -g (u - u_0) dt + (2 D)^(1/2) dW.

        u(h) - u_0 has the mean (u - u_0) e^(-g h) and the variance D (1 - e^(-2 g h))/g.
        """
        g, h = self.bath.get(f"{prefix}drag", 0.0), self.bath["interval"]
        D = g * self.bath.get(f"{prefix}temperature", 0.0) / mass
        D += self.bath.get(f"{prefix}power", 0.0) / (len(axes) * mass)
        variance = D * (1.0 - math.exp(-2.0 * g * h)) / g if g else 2.0 * D * h
        for axis in axes:
            excess = velocity[axis] - target[axis]
            velocity[axis] = target[axis] + excess * math.exp(-g * h)
            if self.bath["noise"]:
                velocity[axis] += math.sqrt(variance) * self.random.gaussian()
