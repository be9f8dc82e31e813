"""The kernel's random numbers."""

import numpy as np
import pytest
from brute_force.kicks import SplitMix
from compiled import from_python

from roughgas.kernel import mathematics

uniform = from_python(mathematics.uniform)
random_vector = from_python(mathematics.random_vector)


def word(seed):
    return np.array([seed], np.uint64)


def test_the_plain_generator_is_splitmix64():
    """The first numbers of the reference implementation (S. Vigna, splitmix64.c) for one seed."""
    plain = SplitMix(1234567)
    assert [plain.next() for _ in range(5)] == [
        6457827717110365317,
        3203168211198807973,
        9817491932198370423,
        4593380528125082431,
        16408922859458223821,
    ]


@pytest.mark.parametrize("seed", [0, 1234567, 2**63, 2**64 - 1])
def test_numbers_are_those_of_plain_integers(seed):
    state, plain = word(seed), SplitMix(seed)
    for _ in range(1000):
        assert uniform(state) == plain.uniform()
        assert int(state[0]) == plain.word


@pytest.mark.parametrize("like", [(0.0,), (0.0, 0.0), (0.0, 0.0, 0.0)])
def test_vectors_take_their_components_in_order(like):
    state, plain = word(7), SplitMix(7)
    for size in (0.0, 1.0, 1e-300, 1e10):
        expected = tuple(size * (2.0 * plain.uniform() - 1.0) for _ in like)
        assert random_vector(state, like, size) == expected


def test_numbers_are_uniform_and_independent():
    """Mean, variance and the next one's correlation within 4 sigma (chance of failure 2e-4)."""
    state, count = word(11), 100_000
    x = np.array([uniform(state) for _ in range(count)])
    assert x.min() >= 0.0 and x.max() < 1.0
    assert abs(x.mean() - 1 / 2) < 4.0 * np.sqrt(1 / 12 / count)
    assert abs(x.var() - 1 / 12) < 4.0 * np.sqrt(1 / 180 / count)
    assert abs(np.corrcoef(x[1:], x[:-1])[0, 1]) < 4.0 / np.sqrt(count)


def test_the_largest_number_names_no_particle_that_is_not_there():
    """A partner is drawn as int(uniform * others): the product must not be rounded up to `others`.

    2^53 - 1 times 2^-53 is the largest number that there is.
    """
    largest = 1.0 - 2.0**-53
    for others in (*range(1, 5000), *(2**k + d for k in range(13, 31) for d in (-1, 0, 1))):
        assert int(largest * others) == others - 1
