"""Random numbers for effects that draw them: SplitMix64, whose state is one word.

G. L. Steele, D. Lea and C. H. Flood, OOPSLA 2014, p. 453. Integer arithmetic and exact products, so
that the same seed gives the same numbers on every machine.
"""

import math

import numpy as np

from roughgas.kernel.jit import jit
from roughgas.kernel.turns import logarithm
from roughgas.kernel.unroll import unrolled

STEP = np.uint64(0x9E3779B97F4A7C15)
FIRST, SECOND = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)


@jit
def uniform(state):
    """Draw a number in [0, 1), a multiple of 2^-53; `state`, an array of one word, moves on."""
    state[0] += STEP
    word = state[0]
    word = (word ^ (word >> np.uint64(30))) * FIRST
    word = (word ^ (word >> np.uint64(27))) * SECOND
    word ^= word >> np.uint64(31)
    return (word >> np.uint64(11)) * 2.0**-53


@unrolled
def random_vector(state, like, size):
    """Return a vector of as many components as `like`, each uniform in [-size, size]."""
    return tuple(_centred(state, size) for k in range(len(like)))


@unrolled
def gaussian_vector(state, like, size):
    """Return a vector of as many components as `like`, each Gaussian with the deviation `size`."""
    return tuple(size * gaussian(state) for k in range(len(like)))


@jit
def gaussian(state):
    """Draw a Gaussian number of mean 0 and variance 1: G. Marsaglia's polar method (1962)."""
    while True:
        x, y = _centred(state, 1.0), _centred(state, 1.0)
        square = x * x + y * y
        if 0.0 < square < 1.0:
            return x * math.sqrt(-2.0 * logarithm(square) / square)


@jit
def _centred(state, size):
    return size * (2.0 * uniform(state) - 1.0)
