"""Arithmetic that has the same bits on every machine, of numbers, registers and vectors.

Double precision is rounded step by step: sums and products are never fused. Only the sieve
(sweep.py) uses single precision, where a b + c may be one instruction; its rounding shows in no
result.

Lanes are several particles at once, one to each lane of a vector register: values of compiled code
that never leave the registers (simd.py tells numba of them), and arrays where the kernel runs as
plain Python. + - * / < <= > >= == & | abs and the operations below take them lane by lane, with one
operand a scalar if need be. A machine with narrower registers takes several for one.

Vectors are tuples, of one to three numbers or lanes.

Every libm rounds sine, cosine and logarithm as it likes; here they are sums and products. Angles
are in turns, whose reduction to an eighth is exact.

Random numbers are those of SplitMix64, whose state is one word (G. L. Steele, D. Lea and
C. H. Flood, OOPSLA 2014, p. 453): integer arithmetic and exact products.
"""

import math

import numpy as np

from roughgas.kernel.jit import Primitive, compiled, jit, of_types

REGISTER = 0  # a count: as many as a register has, of doubles if not of the array's own numbers
BYTES = 64  # of a register, in plain Python


@of_types
def is_lanes(x):
    """Return whether x is lanes; in place of a value it may be a type of numba's."""
    return (hasattr(x, "count") and hasattr(x, "kind")) or isinstance(x, np.ndarray)


@of_types
def is_single(x):
    """Return whether x, or each lane of it, is in single precision; x may be a type, too."""
    return str(getattr(x, "kind", getattr(x, "dtype", x))) == "float32"


@Primitive
def load(array, row, first, count):
    """Return array[row, first:first + count], as lanes."""
    return array[row, first : first + (count or BYTES // array.itemsize)].copy()


@Primitive
def store(array, row, first, lanes):
    """Put lanes where `load` has them from."""
    array[row, first : first + len(lanes)] = lanes


@Primitive
def numbers_in(places, first, count):
    """Return places[first:first + count], which are 32-bit integers, each read by itself: what has
    just been written one by one, a read of all would have to wait for."""
    return places[first : first + (count or BYTES // 8)].copy()


@Primitive
def gather(array, column, numbers):
    """Return array[number, column], or array[number], for each number; singles are widened."""
    found = array[numbers] if array.ndim == 1 else array[numbers, column]
    return found.astype(float) if is_single(found) else found


@Primitive
def order(count):
    """Return 0, 1, 2, ..."""
    return np.arange(count or BYTES // 8)


@Primitive
def lanes_of(array):
    """Return how many of the array's numbers a register has."""
    return BYTES // array.itemsize


@Primitive
def bits(lanes):
    """Return lanes of booleans as an integer, the first lane its lowest bit."""
    return np.uint64(sum(1 << k for k, holds in enumerate(lanes) if holds))


@Primitive
def least(lanes):
    """Return the least of the lanes, whose number is a power of two."""
    return lanes.min()


@Primitive
def trailing_zeros(word):
    """Return the number of zeros below the lowest bit that is set."""
    return (int(word) & -int(word)).bit_length() - 1


@Primitive
def prefetch(array, row):
    """Have array[row] on its way to the cache."""


@Primitive
def index(number):
    """Return a number, promised not to count from the end of an array."""
    return number


@Primitive
def multiply_add(a, b, c):
    """Return a b + c; in single precision perhaps with one rounding."""
    return a * b + c


@Primitive
def select(condition, one, other):
    """Return `one` in the lanes where the condition holds, `other` elsewhere."""
    return np.where(condition, one, other)


@Primitive
def root(x):
    """Return the square root of a number, or of lanes."""
    return np.sqrt(x)


@Primitive
def larger(one, other):
    """Return the larger of two numbers, lane by lane if need be; the first if one is NaN."""
    return np.where(other > one, other, one)[()]


@Primitive
def smaller(one, other):
    """Return the smaller of two numbers, lane by lane if need be; the first if one is NaN."""
    return np.where(other < one, other, one)[()]


@jit
def choose(condition, one, other):
    """Return `one` where the condition holds, else `other`; lane by lane, where it is lanes."""
    if is_lanes(condition):
        return select(condition, one, other)
    return one if condition else other


@Primitive
def append(places, number, lanes, first):
    """Write the numbers, counted from `first`, of the lanes that hold into places[number:]; return
    how many places are taken then."""
    (found,) = np.nonzero(lanes)
    places[number : number + len(found)] = first + found
    return number + len(found)


# ------------------------------------------------------------------ vectors


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
def read(array, i, first, like):
    """Return the components array[i, first:first + len(like)] as a tuple."""
    return tuple(array[i, first + k] for k in range(len(like)))


@jit
def write(array, i, first, vector):
    """Store a tuple in array[i, first:first + len(vector)]."""
    for k in range(len(vector)):
        array[i, first + k] = vector[k]


@jit
def along_axis(like, axis, s):
    """Return the vector s along an axis, with as many components as `like`."""
    return tuple(s if k == axis else 0.0 for k in range(len(like)))


@jit
def spin_cross(w, n):
    """Return w x n; in the plane w has one component, along the third axis."""
    if len(w) == 1:
        return (-w[0] * n[1], w[0] * n[0])
    return (w[1] * n[2] - w[2] * n[1], w[2] * n[0] - w[0] * n[2], w[0] * n[1] - w[1] * n[0])


@jit
def cross_to_spin(n, g):
    """Return n x g as a spin: one component in the plane, three in space."""
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

TURN = 6.283185307179586  # 2 pi, and what that lacks
ROOT_HALF, LN_2 = 0.7071067811865476, 0.6931471805599453
REMAINDER = 2.4492935982947064e-16
# (-1)^k (2 pi)^n / n!, n = 2k + 1 for the sine and 2k for the cosine, from k = 1 on; what follows
# would add less than 3e-18 within an eighth of a turn
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
    """Return the polynomial in x with coefficients c, in an order that keeps the processor busy."""
    x2 = x * x
    low = (c[0] + c[1] * x) + (c[2] + c[3] * x) * x2
    high = (c[4] + c[5] * x) + (c[6] + c[7] * x) * x2
    return low + high * (x2 * x2)


@compiled
def logarithm(x):
    """Return ln x for 0 < x < inf, within 3e-16 of it, or of 1 where it is smaller.

    With x = m 2^k, m within a factor sqrt(2) of 1, and s = (m - 1)/(m + 1), it is
    k ln 2 + 2 (s + s^3/3 + s^5/5 + ...); what is left out is below 1e-18.
    """
    m, k = math.frexp(x)
    if m < ROOT_HALF:
        m, k = 2.0 * m, k - 1
    s = (m - 1.0) / (m + 1.0)
    square, series = s * s, 0.0
    for odd in range(23, 1, -2):
        series = square * (series + 1.0 / odd)
    return k * LN_2 + 2.0 * (s + s * series)


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


@jit
def random_vector(state, like, size):
    """Return a vector of as many components as `like`, each uniform in [-size, size]."""
    return tuple(_centred(state, size) for k in range(len(like)))


@jit
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
