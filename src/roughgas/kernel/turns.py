"""Sine and cosine of an angle that is given in turns, and logarithms, from sums and products alone.

A libm may round differently on every machine. In turns the reduction of the angle is exact, and
polynomials do the rest: the same bits on every machine.
"""

import math

from roughgas.kernel.jit import compiled

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
