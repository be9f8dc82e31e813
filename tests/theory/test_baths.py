"""Closed forms of gases in a bath whose medium rotates."""

import numpy as np
import pytest
from tests.theory.collisions import maxwellian_pairs, sigmas

from roughgas import theory


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(("beta", "q"), [(0.3, 0.5), (1.0, 0.2), (-0.6, 1.0)])
def test_contacts_slow_the_mean_spin_by_the_collision_rule(dimension, beta, q):
    """100,000 random contacts, within 4 standard errors."""
    rng = np.random.default_rng(3)
    pairs = maxwellian_pairs(rng, 100_000, dimension, 0.7)
    mean = np.array([0.0, 0.0, 2.0])
    pairs = pairs._replace(w1=pairs.w1 + mean, w2=pairs.w2 + mean)
    after, weights = pairs.after(0.9, beta, q), pairs.approach()
    change = ((after.w1 - pairs.w1) + (after.w2 - pairs.w2))[:, 2] / 2.0
    expected = -2.0 * theory.mean_spin_decay(beta, dimension, q)
    assert sigmas(change, weights, expected) < 4.0


def test_smooth_spinners_turn_with_the_medium():
    assert theory.mean_spin_of_spinners(-1.0, 3.0, 0.1) == 1.0
    assert theory.mean_spin_of_spinners(0.3, 3.0, 0.0) == 0.0


def test_published_form_of_the_mean_spin():
    """1/[1 + nu (1 + beta)/((1 + q) g)] of disks, 2 nu/3 in place of nu of spheres."""
    disks = theory.mean_spin_of_spinners(0.2, 0.7, 0.3, 2, 0.4)
    spheres = theory.mean_spin_of_spinners(0.2, 1.05, 0.3, 3, 0.4)
    assert disks == pytest.approx(1.0 / (1.0 + 0.7 * 1.2 / (1.4 * 0.3)))
    assert spheres == pytest.approx(disks)
