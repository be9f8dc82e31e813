"""Corrections by cumulants, against a gas whose averages are known exactly: a Maxwellian half with
T_tr (1 + e) and spins of (1 + d) times the mean square, and another with (1 - e) and (1 - d). It
has a20 = e^2 and a11 = e d."""

import numpy as np
import pytest

from roughgas import theory
from roughgas.tasks.free_cooling import corrected_ratio

R_BETA = [(0.9, 0.5), (0.6, -0.2), (0.8, 0.0)]


def balance(r, beta, e, d, dimension):
    """Return the R at which T_tr and T_rot of this gas decay alike, from averages over its
    collisions.

    Relative velocities of a pair are Gaussian with variance T1 + T2; its collision frequency is
    proportional to the square root of this.
    """
    T, spin, share = np.array([1 + e, 1 - e]), np.array([1 + d, 1 - d]), np.full((2, 2), 0.25)
    sums = T[:, None] + T
    weights = share * np.sqrt(sums) / np.sum(share * np.sqrt(sums))
    translation = np.sum(weights * sums) / 2
    rotation = np.sum(weights * (spin[:, None] + spin)) / 2
    loss, gain, spin_gain, spin_loss = theory.collision_rates(r, beta, dimension)
    low, high = 0.0, 1.0
    for _ in range(60):  # bisection: theta rises where R is too small
        R = (low + high) / 2
        T_tr, T_rot = (1 - R) * translation, R * rotation
        rises = (spin_gain * T_tr - spin_loss * T_rot) / R > (gain * T_rot - loss * T_tr) / (1 - R)
        low, high = (R, high) if rises else (low, R)
    return R


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("r, beta", R_BETA)
def test_without_cumulants_it_is_the_closed_form(r, beta, dimension):
    expected = theory.cooling_ratio(r, beta, dimension)
    assert corrected_ratio(0.0, 0.0, r, beta, dimension) == pytest.approx(expected, rel=1e-13)
    assert balance(r, beta, 0.0, 0.0, dimension) == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("r, beta", R_BETA)
@pytest.mark.parametrize("e, d", [(0.1, 0.0), (0.1, 0.2), (-0.1, 0.2)])
def test_it_is_the_first_order(r, beta, e, d, dimension):
    """The remainder is of second order: a hundredth of the first for these cumulants."""
    closed = theory.cooling_ratio(r, beta, dimension)
    exact = balance(r, beta, e, d, dimension) - closed
    first = corrected_ratio(e**2, e * d, r, beta, dimension) - closed
    assert abs(exact) > 1e-5
    assert first == pytest.approx(exact, rel=0.03)
