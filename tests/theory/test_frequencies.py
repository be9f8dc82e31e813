"""Collision frequencies and mean free paths against values known otherwise."""

import numpy as np
import pytest

from roughgas import theory


def test_dilute_limits():
    """nu = 2 n sigma sqrt(pi T) and 4 n sigma^2 sqrt(pi T), with the diameter sigma = 2."""
    phi = 1e-9
    n2, n3 = theory.number_density(phi, 2), theory.number_density(phi, 3)
    nu2, nu3 = theory.collision_frequency(4.0, phi, 2), theory.collision_frequency(4.0, phi, 3)
    assert nu2 == pytest.approx(2 * n2 * 2 * np.sqrt(4 * np.pi), rel=1e-8)
    assert nu3 == pytest.approx(4 * n3 * 4 * np.sqrt(4 * np.pi), rel=1e-8)
    free2, free3 = theory.mean_free_path(phi, 2), theory.mean_free_path(phi, 3)
    assert free2 == pytest.approx(1 / (2 * np.sqrt(2) * n2 * 2), rel=1e-8)
    assert free3 == pytest.approx(1 / (np.sqrt(2) * np.pi * n3 * 4), rel=1e-8)


def test_contact_values_follow_the_virial_series():
    """chi = 1 + b phi + ..., b = 25/16 for Henderson's disks (exact: 1.564) and 5/2 for spheres."""
    assert theory.contact_value(0, 2) == theory.contact_value(0, 3) == 1
    assert (theory.contact_value(1e-7, 2) - 1) / 1e-7 == pytest.approx(25 / 16, rel=1e-5)
    assert (theory.contact_value(1e-7, 3) - 1) / 1e-7 == pytest.approx(5 / 2, rel=1e-5)


def test_box_of_the_cooling_experiment():
    """160 disks in a box of (100 a)^2."""
    phi = 160 * np.pi / 100**2
    assert theory.number_density(phi) == pytest.approx(0.016, rel=1e-14)
    chi = (1 - 7 * phi / 16) / (1 - phi) ** 2
    expected = 4 * 0.016 * chi * np.sqrt(np.pi)
    assert theory.collision_frequency(1.0, phi) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize("dimension", [2, 3])
def test_frequency_grows_with_packing_and_root_of_temperature(dimension):
    nu = theory.collision_frequency([[1.0], [4.0]], np.linspace(0, 0.7, 8), dimension)
    assert nu.shape == (2, 8)
    assert (nu[:, 0] == 0).all()
    assert (np.diff(nu[0]) > 0).all()
    assert nu[1] == pytest.approx(2 * nu[0], rel=1e-15)


@pytest.mark.parametrize("dimension", [2, 3])
def test_no_collisions_in_empty_space(dimension):
    assert np.isinf(theory.mean_free_path(0, dimension))


def test_a_box_is_as_full_as_its_particles_are_dense():
    for box in ([10.0, 30.0], [8.0, 9.0, 10.0]):
        phi = theory.packing_fraction(12, box)
        assert theory.number_density(phi, len(box)) == pytest.approx(12 / np.prod(box))
