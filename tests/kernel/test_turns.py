"""Sine and cosine of an angle in turns."""

import math

import mpmath
import numpy as np
from compiled import from_python

from roughgas.kernel.mathematics import COSINE, REMAINDER, SINE, TURN, sine_and_cosine


def angles():
    """From within a turn and far beyond, quarters of quarters, and their neighbours."""
    rng = np.random.default_rng(0)
    edges = np.arange(-32, 33) / 16.0
    return np.concatenate(
        [
            rng.uniform(-1.0, 1.0, 3000),
            rng.uniform(-1e6, 1e6, 500),
            10.0 ** rng.uniform(-300, 0, 300),
            edges,
            np.nextafter(edges, 9.0),
            np.nextafter(edges, -9.0),
        ]
    )


def test_within_a_rounding_and_a_half_of_forty_digits():
    with mpmath.workdps(40):
        for x in angles():
            sine, cosine = sine_and_cosine(float(x))
            assert abs(sine - mpmath.sinpi(2 * mpmath.mpf(x))) < 1.5e-16
            assert abs(cosine - mpmath.cospi(2 * mpmath.mpf(x))) < 1.5e-16
            if abs(x) < 0.125:
                assert math.isclose(sine, mpmath.sinpi(2 * mpmath.mpf(x)), rel_tol=2.5e-16)


def test_coefficients_are_those_of_the_series_rounded_once():
    with mpmath.workdps(40):
        turn = 2 * mpmath.pi
        assert TURN == float(turn) and REMAINDER == float(turn - float(turn))
        for k in range(1, 9):
            even = (-1) ** k * turn ** (2 * k) / math.factorial(2 * k)
            assert COSINE[k - 1] == float(even)
            assert SINE[k - 1] == float(even * turn / (2 * k + 1))


def test_symmetries():
    for x in map(float, angles()):
        sine, cosine = sine_and_cosine(x)
        assert abs(sine * sine + cosine * cosine - 1.0) < 4e-16
        quarter, mirrored = sine_and_cosine(x + 0.25), sine_and_cosine(-x)
        # midway between two quarters either polynomial serves
        if abs(8.0 * x % 2.0 - 1.0) > 1e-9:
            assert mirrored == (-sine, cosine)
        assert max(abs(mirrored[0] + sine), abs(mirrored[1] - cosine)) < 2e-16
        assert abs(quarter[0] - cosine) < 4e-16 + 7.0 * math.ulp(x + 0.25)
        assert abs(quarter[1] + sine) < 4e-16 + 7.0 * math.ulp(x + 0.25)


def test_quarters_are_exact():
    for k in range(-8, 9):
        expected = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][k % 4]
        assert sine_and_cosine(0.25 * k) == expected


def test_compiled_code_gives_the_same_bits():
    compiled = from_python(sine_and_cosine)
    for x in map(float, angles()):
        assert compiled(x) == sine_and_cosine(x)
