"""Random numbers, sines and cosines, vector registers, single precision, and unrolled code."""

import math

import mpmath
import numpy as np
import pytest
from brute_force import largest_overlap, run, scene_of, settings
from brute_force.kicks import SplitMix
from compiled import from_python
from raw import initial_state

from roughgas.compiling.jit import entry, jit
from roughgas.compiling.lanes import (
    append,
    assume_nonnegative,
    bits,
    choose,
    gather,
    horizontal_min,
    iota,
    lanes_of,
    larger,
    load,
    load_scalars,
    multiply_add,
    smaller,
    sqrt,
    store,
    trailing_zeros,
)
from roughgas.kernel import mathematics
from roughgas.kernel.mathematics import sine_and_cosine

uniform = from_python(mathematics.uniform)
random_vector = from_python(mathematics.random_vector)


def word(seed):
    """The state of a random generator with a seed."""
    return np.array([seed], np.uint64)


def test_the_plain_generator_is_splitmix64():
    """The first numbers of the reference implementation (S. Vigna, splitmix64.c) for one seed."""
    generator = SplitMix(1234567)
    assert [generator.next_integer() for _ in range(5)] == [
        6457827717110365317,
        3203168211198807973,
        9817491932198370423,
        4593380528125082431,
        16408922859458223821,
    ]


@pytest.mark.parametrize("seed", [0, 1234567, 2**63, 2**64 - 1])
def test_uniform_numbers_are_those_of_plain_integers(seed):
    state, reference = word(seed), SplitMix(seed)
    for _ in range(1000):
        assert uniform(state) == reference.uniform()
        assert int(state[0]) == reference.word


@pytest.mark.parametrize("like", [(0.0,), (0.0, 0.0), (0.0, 0.0, 0.0)])
def test_random_vectors_draw_their_components_in_order(like):
    state, reference = word(7), SplitMix(7)
    for size in (0.0, 1.0, 1e-300, 1e10):
        expected = tuple(size * (2.0 * reference.uniform() - 1.0) for _ in like)
        assert random_vector(state, like, size) == expected


def angles():
    """Angles in turns: random ones near 0 and far off, sixteenths, and doubles next to these."""
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


def test_sines_and_cosines_are_within_a_rounding_and_a_half():
    with mpmath.workdps(40):
        for x in angles():
            sine, cosine = sine_and_cosine(float(x))
            assert abs(sine - mpmath.sinpi(2 * mpmath.mpf(x))) < 1.5e-16
            assert abs(cosine - mpmath.cospi(2 * mpmath.mpf(x))) < 1.5e-16
            if abs(x) < 0.125:
                assert math.isclose(sine, mpmath.sinpi(2 * mpmath.mpf(x)), rel_tol=2.5e-16)


def test_compiled_sines_and_cosines_have_the_bits_of_plain_python():
    compiled = from_python(sine_and_cosine)
    for x in map(float, angles()):
        assert compiled(x) == sine_and_cosine(x)


LANES = 8
FIRST_OPERANDS = np.array([0.0, -0.0, 1.5, -2.0, np.inf, -np.inf, np.nan, 1e-300])
SECOND_OPERANDS = np.array([1.0, 0.0, -1.5, np.nan, np.inf, 3.0, 2.0, 1e300])


@entry
def _calculate(a, b, out):
    x, y = load(a, 0, 0, LANES), load(b, 0, 0, LANES)
    store(out, 0, 0, x + y)
    store(out, 1, 0, 2.0 - x)
    store(out, 2, 0, x * y)
    store(out, 3, 0, x / 3.0)
    store(out, 4, 0, -x)
    store(out, 5, 0, abs(x))
    store(out, 6, 0, sqrt(abs(y)))
    store(out, 7, 0, multiply_add(x, 2.0, y))
    store(out, 8, 0, larger(x, y))
    store(out, 9, 0, smaller(x, 0.0))
    store(out, 10, 0, choose((x <= y) & (x > -2.0), x, 7.0))
    return bits((x < y) | (y == 3.0)), bits(iota(LANES) >= 3)


@entry
def _greater_and_less(a, b, out):
    for k in range(LANES):
        out[8, k] = max(a[0, k], b[0, k])
        out[9, k] = min(a[0, k], 0.0)


def test_arithmetic_of_lanes_is_that_of_numbers():
    out, expected = np.empty((11, LANES)), np.empty((11, LANES))
    a, b = FIRST_OPERANDS[None], SECOND_OPERANDS[None]
    comparison_bits, order_bits = _calculate(a, b, out)
    x, y = FIRST_OPERANDS, SECOND_OPERANDS
    with np.errstate(all="ignore"):
        expected[:8] = x + y, 2 - x, x * y, x / 3, -x, abs(x), np.sqrt(abs(y)), x * 2 + y
        expected[10] = np.where((x <= y) & (x > -2.0), x, 7.0)
        _greater_and_less(a, b, expected)
        np.testing.assert_array_equal(out, expected)
        np.testing.assert_array_equal(np.signbit(out), np.signbit(expected))
        assert comparison_bits == np.packbits((x < y) | (y == 3.0), bitorder="little")[0]
        assert _calculate.py_func(a, b, expected) == (comparison_bits, order_bits)
        np.testing.assert_array_equal(out, expected)
    assert order_bits == 0b11111000


@entry
def _least_and_gather(a, rows, rows_of_lanes, out):
    store(out, 0, 0, gather(rows, 1, load_scalars(rows_of_lanes, 0, LANES)))
    return (
        horizontal_min(load(a, 0, 0, LANES)),
        trailing_zeros(np.uint64(40)),
        assume_nonnegative(3),
    )


@pytest.mark.parametrize("kind", [np.float64, np.float32])
def test_lanes_have_their_least_number_and_gather_rows(kind):
    rng = np.random.default_rng(1)
    a, rows = rng.normal(size=(1, LANES)), rng.normal(size=(20, 3)).astype(kind)
    rows_of_lanes, out = rng.integers(20, size=LANES).astype(np.int32), np.empty((1, LANES))
    for function in (_least_and_gather, _least_and_gather.py_func):
        assert function(a, rows, rows_of_lanes, out) == (a.min(), 3, 3)
        np.testing.assert_array_equal(out[0], rows[rows_of_lanes, 1])
        out[:] = 0.0


@entry
def _append_lanes_below(numbers, limit, positions):
    count = 0
    for first in range(0, numbers.shape[1], lanes_of(numbers)):
        below = load(numbers, 0, first, lanes_of(numbers)) < limit
        count = append(positions, count, below, first)
    return count


def test_lanes_that_satisfy_a_condition_are_listed_in_order():
    """All patterns of eight lanes occur, whatever the width of the machine's registers."""
    patterns = (np.arange(256)[:, None] >> np.arange(8)) & 1 == 1
    numbers = np.where(patterns, 0, 2).astype(np.float32).reshape(1, -1)
    positions = np.full(numbers.size + 16, -1, np.int32)
    for function in (_append_lanes_below, _append_lanes_below.py_func):
        count = function(numbers, np.float32(1.0), positions)
        np.testing.assert_array_equal(positions[:count], np.flatnonzero(numbers[0] < 1.0))
        positions[:] = -1


SINGLE = 2.0**-24  # half the spacing of single precision just above 1


@pytest.mark.slow  # compiles kernels
@pytest.mark.parametrize("number", [160, 1000], ids=["swept", "in cells"])
def test_single_precision_conserves_the_energy_of_an_elastic_gas(number):
    """The frequency of collisions agrees with double precision to 4 %, some 4 standard errors.

    Positions, and so contacts, are off by roundings of the box's side; the energy makes a random
    walk of such roundings.
    """
    side = np.sqrt(10.0 * np.pi * number)
    experiment = settings("gas", number, [side, side])
    scene, world = scene_of(experiment, 1.0, 1.0)
    elapsed = []
    for precision in (np.float32, np.float64):
        state = initial_state(scene, experiment, np.random.default_rng(1), precision)
        assert state.trajectory.dtype == state.spin.dtype == precision
        assert (state.cells is None) == (number == 160)
        rows = run(state, scene, 10, collisions=10 * number)
        energy = sum(rows[name] for name in ("vv_x", "vv_y")) + 0.5 * rows["ww"]
        rounding = SINGLE if precision is np.float32 else 2.0**-53
        assert np.ptp(energy) / energy[0] < 100.0 * rounding
        assert largest_overlap(state, scene, world) < 8.0 * side * rounding
        elapsed.append(rows["time"][-1] - rows["time"][0])
    assert elapsed[0] == pytest.approx(elapsed[1], rel=0.04)
    assert elapsed[0] != elapsed[1]


@jit
def sum_over_pairs(box, x):
    """Nested loops with branches that types decide."""
    total = 0.0
    for k in range(len(x)):
        if box[k] is not None:
            for j in range(k + 1, len(x)):
                total += (k - 3 * j) * x[k] * x[j]
    return total, tuple(2.0 * x[k] for k in range(len(x)) if box[k] is None)


@jit
def add_box_in_place(box, x):
    for k in range(len(box)):
        if box[k] is not None:
            x[k] += box[k]


@pytest.mark.parametrize("box", [(None, 5.0), (5.0, None, 7.0), (5.0, 6.0, 7.0), (None, None)])
def test_unrolled_functions_do_the_same_as_plain_python(box):
    x = (1.5, -2.0, 0.25)[: len(box)]
    assert from_python(sum_over_pairs)(box, x) == sum_over_pairs(box, x)
    ends = np.zeros((2, 3))
    for function, end in zip((add_box_in_place, from_python(add_box_in_place)), ends, strict=True):
        function(box, end)
    assert np.array_equal(*ends)
