import math

import numpy as np
import pytest

from roughgas.claims.evidence import Sample

BETA = np.array([-0.5, 0.0, 0.5])


def sample(value, stderr, dof):
    places = {"r": np.full(3, 0.9), "beta": BETA, "wave": np.array(["sine", "triangle", "sine"])}
    return Sample(places, *(np.array(column, float) for column in (value, stderr, dof)))


def test_mean_and_largest():
    """The degrees of freedom of the mean are those of Welch and Satterthwaite."""
    found = sample([0.1, -0.3, 0.2], [1, 2, 2], [12, 4, 8])
    dof = 9**2 / (1 / 12 + 16 / 4 + 16 / 8)
    assert found.mean() == pytest.approx((0.0, 1.0, dof))
    largest, place = found.largest()
    assert largest == (-0.3, 2.0, 4) and place == "r = 0.9, beta = 0, wave = triangle"
    assert found.where(BETA > 0).place(0) == "r = 0.9, beta = 0.5, wave = sine"
    twice = found.joined(found)
    assert twice.size == 6 and twice.place(5) == found.place(2)


def test_significance_depends_on_the_degrees_of_freedom():
    """Four seeds alone need ten standard errors for three sigma."""
    found = sample([0.05, 0.05, 0.05], [0.01, 0.01, math.nan], [3, 100, 100])
    assert found.off(0.02).tolist() == [False, True, False]
    assert found.vague(0.02).tolist() == [True, False, True]
    assert not found.off(0.06).any() and not found.vague(0.06).any()
