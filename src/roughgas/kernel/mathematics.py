"""Arithmetic that has the same bits on every machine: vectors, functions, random numbers.

In double precision sums and products are rounded separately, never fused. Only the sieve (sweep.py)
uses single precision, where a b + c may be one instruction; its rounding affects no result.

Vectors are tuples, of one to three numbers or lanes (compiling/lanes.py).

Implementations of libm round sine, cosine and logarithm differently; here they consist of sums and
products. Angles are in turns, whose reduction to an eighth is exact.

Random numbers come from SplitMix64, whose state is one word (G. L. Steele, D. Lea and
C. H. Flood, OOPSLA 2014, p. 453): integer arithmetic and exact products.
"""

import math

import numpy as np

from roughgas.compiling.jit import compiled, jit
from roughgas.compiling.lanes import multiply_add


@jit
def dot(a, b):
    """Return the scalar product of two vectors of equal length."""
    total = a[0] * b[0]
    for k in range(1, len(a)):
        total = multiply_add(a[k], b[k], total)
    return total


@jit
def subtract(a, b):
    """Return the difference a - b of two vectors."""
    return tuple(a[k] - b[k] for k in range(len(a)))


@jit
def scale(a, s):
    """Return the vector a times the scalar s."""
    return tuple(a[k] * s for k in range(len(a)))


@jit
def divide(a, s):
    """Return the vector a over the scalar s."""
    return tuple(a[k] / s for k in range(len(a)))


@jit
def add_scaled(a, b, s):
    """Return a + s b, for vectors a and b and a scalar s."""
    return tuple(multiply_add(b[k], s, a[k]) for k in range(len(a)))


@jit
def quarter_power(x, quarters):
    """Return x >= 0 to the power quarters/4, for a whole number `quarters` >= 0, by roots and
    products."""
    root, power = math.sqrt(math.sqrt(x)), 1.0
    for _ in range(quarters):
        power *= root
    return power


@jit
def read(array, i, first, like):
    """Return the components array[i, first:first + len(like)] as a tuple.

    `like` is any tuple of as many components.
    """
    return tuple(array[i, first + k] for k in range(len(like)))


@jit
def write(array, i, first, vector):
    """Store a tuple in array[i, first:first + len(vector)]."""
    for k in range(len(vector)):
        array[i, first + k] = vector[k]


@jit
def along_axis(like, axis, s):
    """Return the vector of length s along an axis, with as many components as the tuple `like`."""
    return tuple(s if k == axis else 0.0 for k in range(len(like)))


@jit
def spin_cross(w, n):
    """Return w x n, for a spin w and a vector n.

    In the plane w has one component, along the third axis.
    """
    if len(w) == 1:
        return (-w[0] * n[1], w[0] * n[0])
    return (w[1] * n[2] - w[2] * n[1], w[2] * n[0] - w[0] * n[2], w[0] * n[1] - w[1] * n[0])


@jit
def cross_to_spin(n, g):
    """Return n x g, for two vectors, as a spin: one component in the plane, three in space."""
    if len(n) == 2:
        return (n[0] * g[1] - n[1] * g[0],)
    return spin_cross(n, g)


@jit
def cross_squared(a, b):
    """Return |a x b|^2, the square of the area that two vectors span."""
    if len(a) == 2:
        area = multiply_add(a[0], b[1], -(a[1] * b[0]))
        return area * area
    area = cross_to_spin(a, b)
    return dot(area, area)


# ------------------------------------------------------------------ functions

TURN = 6.283185307179586  # 2 pi in double precision; REMAINDER is the difference to 2 pi
ROOT_HALF, LN_2 = 0.7071067811865476, 0.6931471805599453
REMAINDER = 2.4492935982947064e-16
# (-1)^k (2 pi)^n / n!, n = 2k + 1 for the sine and 2k for the cosine, from k = 1 on; further terms
# are less than 3e-18 within an eighth of a turn
SINE = (
    -41.34170224039976,
    81.60524927607506,
    -76.70585975306139,
    42.058693944897655,
    -15.09464257682299,
    3.819952584848282,
    -0.7181223017785006,
    0.10422916220813984,
)
COSINE = (
    -19.739208802178716,
    64.9393940226683,
    -85.45681720669373,
    60.24464137187666,
    -26.4262567833744,
    7.903536371318469,
    -1.714390711088672,
    0.28200596845579123,
)


@compiled
def sine_and_cosine(turns):
    """Return (sin, cos) of 2 pi turns, each within 1.5e-16, for |turns| < 2^50."""
    quarters = math.floor(4.0 * turns + 0.5)
    x = turns - 0.25 * quarters  # exact, by Sterbenz's lemma; |x| <= 1/8
    square = x * x
    sine = TURN * x + x * (REMAINDER + square * _series(SINE, square))
    cosine = 1.0 + square * _series(COSINE, square)
    quarter = quarters & 3
    if quarter == 0:
        return sine, cosine
    if quarter == 1:
        return cosine, -sine
    if quarter == 2:
        return -sine, -cosine
    return -cosine, sine


@compiled
def _series(c, x):
    """Return the polynomial in x with coefficients c, in an order with few data dependencies."""
    x2 = x * x
    low = (c[0] + c[1] * x) + (c[2] + c[3] * x) * x2
    high = (c[4] + c[5] * x) + (c[6] + c[7] * x) * x2
    return low + high * (x2 * x2)


@compiled
def logarithm(x):
    """Return ln x for 0 < x < inf, with an error below 3e-16 max(1, |ln x|).

    With x = m 2^k, m within a factor sqrt(2) of 1, and s = (m - 1)/(m + 1), it is
    k ln 2 + 2 (s + s^3/3 + s^5/5 + ...); the truncated terms are below 1e-18.
    """
    m, k = math.frexp(x)
    if m < ROOT_HALF:
        m, k = 2.0 * m, k - 1
    s = (m - 1.0) / (m + 1.0)
    square, series = s * s, 0.0
    for odd in range(23, 1, -2):
        series = square * (series + 1.0 / odd)
    return k * LN_2 + 2.0 * (s + s * series)


INCREMENT = np.uint64(0x9E3779B97F4A7C15)
MULTIPLIER_1, MULTIPLIER_2 = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)


@jit
def uniform(state):
    """Draw a uniform random number in [0, 1), a multiple of 2^-53.

    `state` is State.random, the generator's word in an array (1,), which moves on.
    """
    state[0] += INCREMENT
    word = state[0]
    word = (word ^ (word >> np.uint64(30))) * MULTIPLIER_1
    word = (word ^ (word >> np.uint64(27))) * MULTIPLIER_2
    word ^= word >> np.uint64(31)
    return (word >> np.uint64(11)) * 2.0**-53


@jit
def random_vector(state, like, size):
    """Draw a vector of as many components as the tuple `like`, each uniform in [-size, size].

    `state` is State.random.
    """
    return tuple(_centred(state, size) for k in range(len(like)))


@jit
def gaussian_vector(state, like, size):
    """Draw a vector of as many components as `like`, each Gaussian with standard deviation `size`.

    `state` is State.random.
    """
    return tuple(size * gaussian(state) for k in range(len(like)))


@jit
def gaussian(state):
    """Draw a Gaussian number of mean 0 and variance 1: G. Marsaglia's polar method (1962).

    `state` is State.random.
    """
    while True:
        x, y = _centred(state, 1.0), _centred(state, 1.0)
        square = x * x + y * y
        if 0.0 < square < 1.0:
            return x * math.sqrt(-2.0 * logarithm(square) / square)


@jit
def _centred(state, size):
    """Draw a uniform random number in [-size, size]; `state` is State.random."""
    return size * (2.0 * uniform(state) - 1.0)
