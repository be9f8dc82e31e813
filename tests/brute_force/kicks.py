"""Random kicks of a stochastic drive, and the numbers that they are drawn from, as one would write
them first: plain integers and lists."""

import math
from typing import NamedTuple

WORD = 2**64


class SplitMix:
    """Steele, Lea and Flood, OOPSLA 2014, Fig. 13; `word` is its state."""

    def __init__(self, word):
        self.word = int(word)

    def next(self):
        """The next of 2^64 integers."""
        self.word = (self.word + 0x9E3779B97F4A7C15) % WORD
        z = self.word
        z = (z ^ (z // 2**30)) * 0xBF58476D1CE4E5B9 % WORD
        z = (z ^ (z // 2**27)) * 0x94D049BB133111EB % WORD
        return z ^ (z // 2**31)

    def gaussian(self):
        """A Gaussian number of variance 1, by Marsaglia's polar method."""
        square = 0.0
        while not 0.0 < square < 1.0:
            x, y = 2.0 * self.uniform() - 1.0, 2.0 * self.uniform() - 1.0
            square = x * x + y * y
        return x * math.sqrt(-2.0 * math.log(square) / square)

    def uniform(self):
        """A number in [0, 1), from the 53 leading bits."""
        return (self.next() // 2**11) / 2**53


class Drive(NamedTuple):
    """A thermostat or a bath: where it stands."""

    due: list  # absolute time of each particle's next kick or step
    word: int  # the generator's state
    order: list  # the particles in the order in which a partner is drawn from them


class Kicks:
    """Kicks under way, of a thermostat (power, spin share, interval)."""

    def __init__(self, thermostat, inertia, dimension, drive, company):
        self.company = company
        power, share, self.interval = thermostat
        self.inertia, self.dimension, self.spins = inertia, dimension, 2 * dimension - 3
        self.due, self.order = list(drive.due), list(drive.order)
        self.random = SplitMix(drive.word)
        energy = power * self.interval
        # a component that is uniform in [-k, k] has the mean square k^2/3, and two particles get it
        self.push = math.sqrt((1.0 - share) * energy / dimension * 3.0)
        self.turn = math.sqrt(share * energy / (self.spins * inertia) * 3.0) if inertia else 0.0

    def next(self, time):
        """(wait, kind, particle, none) of the next kick."""
        due = min(self.due)
        return max(0.0, due - time), "kick", self.due.index(due), -1

    def give(self, i, v, w):
        """Kick particle i and one that is drawn, in the arrays of velocities and of spins."""
        others = [k for k in self.order if k != i]
        j = others[math.floor(self.random.uniform() * len(others))]
        m = self.company.mass
        # so that p^2/2 (1/m_i + 1/m_j) is as much for any two
        size = self.push * math.sqrt(2.0 / (1.0 / m[i] + 1.0 / m[j]))
        for axis in range(self.dimension):
            kick = self._component(size)
            v[i, axis] += kick / m[i]
            v[j, axis] -= kick / m[j]
        if self.inertia:
            for k in (i, j):
                size = self.turn * math.sqrt(self.inertia / (m[k] * self.company.q[k]))
                for axis in range(3 - self.spins, 3):
                    w[k, axis] += self._component(size)
        self.due[i] += self.interval

    def _component(self, size):
        return size * (2.0 * self.random.uniform() - 1.0)


class Bath:
    """Steps of drag and noise under way, of the settings of a Langevin bath."""

    def __init__(self, bath, inertia, dimension, drive, company):
        self.bath, self.company, self.due = bath, company, list(drive.due)
        self.rotates, self.dimension, self.spins = bool(inertia), dimension, 2 * dimension - 3
        self.random = SplitMix(drive.word)

    def next(self, time):
        """(wait, kind, particle, none) of the next step."""
        due = min(self.due)
        return max(0.0, due - time), "kick", self.due.index(due), -1

    def give(self, i, v, w):
        """Let particle i take a step, in the arrays of velocities and of spins."""
        m = self.company.mass[i]
        self._step(v[i], range(self.dimension), m, "")
        if self.rotates:
            self._step(w[i], range(3 - self.spins, 3), m * self.company.q[i], "spin_")
        self.due[i] += self.bath["interval"]

    def _step(self, u, axes, mass, of):
        """u(h) of du = -g u dt + (2 D)^(1/2) dW: mean u e^(-g h), variance D (1 - e^(-2 g h))/g."""
        g, h = self.bath.get(f"{of}drag", 0.0), self.bath["interval"]
        D = g * self.bath.get(f"{of}temperature", 0.0) / mass
        D += self.bath.get(f"{of}power", 0.0) / (len(axes) * mass)
        variance = D * (1.0 - math.exp(-2.0 * g * h)) / g if g else 2.0 * D * h
        for axis in axes:
            u[axis] *= math.exp(-g * h)
            if self.bath["noise"]:
                u[axis] += math.sqrt(variance) * self.random.gaussian()
