"""Theory beside the forms in which others have published it (docs/references.md)."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from roughgas import theory

anywhere = {"r": st.floats(0, 1), "beta": st.floats(-0.99, 1), "q": st.floats(0.05, 1)}


def huthmann_zippelius(r, beta, q, dimension):
    """A, B and C of Huthmann & Zippelius (1997); those of disks are in Luding et al. (1998).

    With a constant G they write dT_tr/dt = -G A T_tr^(3/2) + G B T_tr^(1/2) T_rot, and
    dT_rot/dt = k (G B T_tr^(3/2) - G C T_tr^(1/2) T_rot), k being 2 for disks and 1 for spheres.
    """
    eta = q * (1 + beta) / (2 + 2 * q)
    tangential = 0.5 if dimension == 2 else 1.0
    A = (1 - r**2) / 4 + tangential * eta * (1 - eta)
    return A, tangential * eta**2 / q, tangential * eta / q * (1 - eta / q)


@settings(derandomize=True, deadline=None)
@given(**anywhere, dimension=st.sampled_from([2, 3]))
def test_the_rate_equations_are_those_of_huthmann_and_zippelius(r, beta, q, dimension):
    A, B, C = huthmann_zippelius(r, beta, q, dimension)
    ours = theory.collision_rates(r, beta, dimension, q)
    scale, spins = (2, 2) if dimension == 2 else (4 / 3, 1)
    theirs = scale * np.array([A, B, spins * B, spins * C])
    assert np.array(ours) == pytest.approx(theirs, rel=1e-12, abs=1e-15)


@settings(derandomize=True, deadline=None)
@given(**anywhere)
def test_cooling_spheres_are_those_of_santos_kremer_and_dos_santos(r, beta, q):
    """The Maxwellian limit of Santos, Kremer & dos Santos (2011): theta = h + sqrt(1 + h^2)."""
    lost = 1 - r**2 - (1 - q) / (1 + q) * (1 - beta**2)
    h = (1 + q) ** 2 / (2 * q * (1 + beta) ** 2) * lost
    theta = h + np.hypot(1, h) if h > 0 else 1 / (np.hypot(1, h) - h)
    expected = pytest.approx(theta / (1 + theta), rel=1e-9)
    assert theory.cooling_ratio(r, beta, 3, q) == expected
    assert theory.goldshtein_ratio(r, beta, q) == expected


@settings(derandomize=True, deadline=None)
@given(beta=anywhere["beta"], q=anywhere["q"])
def test_heated_spheres_are_those_of_santos_kremer_and_dos_santos(beta, q):
    """Their white-noise thermostat, in the Maxwellian limit: theta = (1 + b)/(2 + (1 - b)/q)."""
    theta = (1 + beta) / (2 + (1 - beta) / q)
    assert theory.lun_ratio(beta, q) == pytest.approx(theta / (1 + theta), rel=1e-12)


@settings(derandomize=True, deadline=None)
@given(**anywhere)
def test_a_gas_driven_by_rotation_is_that_of_cafiero_luding_and_herrmann(r, beta, q):
    """Translation, which nothing drives, balances in itself: theta = A/B (2002)."""
    A, B, _ = huthmann_zippelius(r, beta, q, 2)
    assert theory.stationary_ratio(r, beta, 2, q, 1) == pytest.approx(A / (A + B), rel=1e-12)


@pytest.mark.parametrize(
    ("beta", "expected"), [(-0.5, 0.925), (0.0, 0.808), (0.5, 0.693), (1.0, 0.588)]
)
def test_a_gas_driven_by_rotation_in_numbers(beta, expected):
    """Computed elsewhere, by other code."""
    assert theory.stationary_ratio(0.9, beta, 2, 0.5, 1) == pytest.approx(expected, abs=5e-4)
