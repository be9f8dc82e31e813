"""Lanes of vector registers do what numpy does with whole arrays."""

import math

import numpy as np
import pytest

from roughgas.kernel.jit import entry
from roughgas.kernel.mathematics import (
    REGISTER,
    append,
    bits,
    choose,
    gather,
    index,
    lanes_of,
    least,
    load,
    multiply_add,
    order,
    store,
    trailing_zeros,
)

EIGHT = 8
SPECIAL = np.array([0.0, -0.0, 1.5, -2.0, np.inf, -np.inf, np.nan, 1e-300])
OTHER = np.array([1.0, 0.0, -1.5, np.nan, np.inf, 3.0, 2.0, 1e300])


@entry
def _calculate(a, b, out):
    x, y = load(a, 0, 0, EIGHT), load(b, 0, 0, EIGHT)
    store(out, 0, 0, x + y)
    store(out, 1, 0, 2.0 - x)
    store(out, 2, 0, x * y)
    store(out, 3, 0, x / 3.0)
    store(out, 4, 0, -x)
    store(out, 5, 0, abs(x))
    store(out, 6, 0, math.sqrt(abs(y)))
    store(out, 7, 0, multiply_add(x, 2.0, y))
    store(out, 8, 0, max(x, y))
    store(out, 9, 0, min(x, 0.0))
    store(out, 10, 0, choose((x <= y) & (x > -2.0), x, 7.0))
    return bits((x < y) | (y == 3.0)), bits(order(EIGHT) >= 3)


@entry
def _greater_and_less(a, b, out):
    for k in range(EIGHT):
        out[8, k] = max(a[0, k], b[0, k])
        out[9, k] = min(a[0, k], 0.0)


def test_arithmetic_of_lanes_is_that_of_numbers():
    out, expected = np.empty((11, EIGHT)), np.empty((11, EIGHT))
    a, b = SPECIAL[None], OTHER[None]
    found, last = _calculate(a, b, out)
    x, y = SPECIAL, OTHER
    with np.errstate(all="ignore"):
        expected[:8] = x + y, 2 - x, x * y, x / 3, -x, abs(x), np.sqrt(abs(y)), x * 2 + y
        expected[10] = np.where((x <= y) & (x > -2.0), x, 7.0)
        _greater_and_less(a, b, expected)
        np.testing.assert_array_equal(out, expected)
        np.testing.assert_array_equal(np.signbit(out), np.signbit(expected))
        assert found == np.packbits((x < y) | (y == 3.0), bitorder="little")[0]
    assert last == 0b11111000


@entry
def _least_and_gather(a, rows, places, out):
    store(out, 0, 0, gather(rows, 1, places, 0, EIGHT))
    return least(load(a, 0, 0, EIGHT)), trailing_zeros(np.uint64(40)), index(3)


@pytest.mark.parametrize("kind", [np.float64, np.float32])
def test_least_of_lanes_and_lanes_from_rows(kind):
    rng = np.random.default_rng(1)
    a, rows = rng.normal(size=(1, EIGHT)), rng.normal(size=(20, 3)).astype(kind)
    places, out = rng.integers(20, size=EIGHT).astype(np.int32), np.empty((1, EIGHT))
    assert _least_and_gather(a, rows, places, out) == (a.min(), 3, 3)
    np.testing.assert_array_equal(out[0], rows[places, 1])


@entry
def _append_those_below(numbers, limit, places):
    taken = 0
    for first in range(0, numbers.shape[1], lanes_of(numbers)):
        below = load(numbers, 0, first, REGISTER) < limit
        taken = append(places, taken, below, first)
    return taken


def test_lanes_that_hold_are_listed_in_order():
    """Every pattern of eight comes up, in whatever registers the machine has."""
    patterns = (np.arange(256)[:, None] >> np.arange(8)) & 1 == 1
    numbers = np.where(patterns, 0, 2).astype(np.float32).reshape(1, -1)
    places = np.full(numbers.size + 16, -1, np.int32)
    taken = _append_those_below(numbers, np.float32(1.0), places)
    np.testing.assert_array_equal(places[:taken], np.flatnonzero(numbers[0] < 1.0))


@entry
def _number_of_lanes(double, single):
    return lanes_of(double), lanes_of(single)


def test_a_register_has_half_as_many_doubles():
    doubles, singles = _number_of_lanes(np.zeros(1), np.zeros(1, np.float32))
    assert singles == 2 * doubles and doubles in (4, 8)
