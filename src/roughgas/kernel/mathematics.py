"""Arithmetic, vector registers, trigonometry, random numbers: the same bits everywhere.

a b + c, and when the compiler may round it once instead of twice; and a choice without a branch.

Results are in double precision and rounded step by step, the same on every machine. Only
the sieve (sweep.py) uses single precision, and its rounding shows in no result: there a product and
a sum become one instruction where the machine has it.

Several particles at once, one to each lane of a vector register.

Lanes are values of compiled code that never leave the registers (registers.py tells numba of
them).
+ - * / < <= > >= == & | abs max min math.sqrt take them lane by lane, with one operand a scalar if
need be. A machine with narrower registers takes several for one.

| operation | returns |
| --- | --- |
| load(array, row, first, count) | array[row, first:first + count], as lanes |
| store(array, row, first, lanes) | nothing; the reverse of load |
| gather(array, column, places, first, count) | array[p, column] for each p in places[first:...] |
| numbers_in(places, first, count) | places[first:first + count], of 32-bit integers |
| order(count) | 0, 1, 2, ... |
| lanes_of(array) | how many of the array's numbers a register has |
| bits(lanes of booleans) | an integer, the first lane its lowest bit |
| least(lanes) | the least of them; their number is a power of two |
| append(places, number, lanes of booleans, first) | see operations.py |
| trailing_zeros(integer) | the number of zeros below its lowest bit |
| prefetch(array, row) | nothing; array[row] is on its way to the cache |
| index(number) | the number, promised not to count from the end of an array |

Sine and cosine of an angle that is given in turns, and logarithms, from sums and products alone.

A libm may round differently on every machine. In turns the reduction of the angle is exact, and
polynomials do the rest: the same bits on every machine.

Random numbers for effects that draw them: SplitMix64, whose state is one word.

G. L. Steele, D. Lea and C. H. Flood, OOPSLA 2014, p. 453. Integer arithmetic and exact products, so
that the same seed gives the same numbers on every machine.
"""

import math

import numpy as np

from roughgas.kernel.jit import Primitive, compiled, is_lanes, is_single, jit, overload, unrolled


def multiply_add(a, b, c):
    """Return a b + c; in single precision perhaps with one rounding."""
    return a * b + c


@overload(multiply_add)
def _compiled_multiply_add(a, b, c):
    from roughgas.kernel.operations import fused

    if is_single(a) and is_single(b) and is_single(c):
        return lambda a, b, c: fused(a, b, c)
    return lambda a, b, c: a * b + c


def choose(condition, one, other):
    """Return `one` where the condition holds, else `other`; lane by lane, where it is lanes."""
    return one if condition else other


@overload(choose)
def _compiled_choose(condition, one, other):
    from roughgas.kernel.operations import select

    if is_lanes(condition):
        return lambda condition, one, other: select(condition, one, other)
    return lambda condition, one, other: one if condition else other


REGISTER = 0  # a count: as many as a register has, of doubles if not of the array's own numbers

load = Primitive("load")
store = Primitive("store")
gather = Primitive("gather")
numbers_in = Primitive("numbers_in")
order = Primitive("order")
lanes_of = Primitive("lanes_of")
bits = Primitive("bits")
least = Primitive("least")
append = Primitive("append")
trailing_zeros = Primitive("trailing_zeros")
prefetch = Primitive("prefetch")
index = Primitive("index")


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
