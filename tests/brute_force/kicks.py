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

    def uniform(self):
        """A number in [0, 1), from the 53 leading bits."""
        return (self.next() // 2**11) / 2**53


class Drive(NamedTuple):
    """A thermostat: what it is to do, and where it stands."""

    due: list  # absolute time of each particle's next kick
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
