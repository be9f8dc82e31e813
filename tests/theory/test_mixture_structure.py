"""Contact values and the equation of state of mixtures."""

import numpy as np
import pytest

from roughgas import theory
from roughgas.base import InputError

dimensions = pytest.mark.parametrize("dimension", [2, 3])
packings = pytest.mark.parametrize("packing", [0.0, 0.1, 0.5])
SPECIES = [
    {"fraction": 0.2, "radius": 0.3, "mass": 7},
    {"fraction": 0.5, "radius": 1, "mass": 1},
    {"fraction": 0.3, "radius": 2, "mass": 0.1},
]


def elastic(dimension, species=SPECIES):
    return theory.mixture(species, 1, 1, dimension)


@dimensions
@packings
def test_equal_radii_have_the_contact_value_of_one_species(dimension, packing):
    gas = elastic(dimension, [{"fraction": 0.3, "radius": 2}, {"fraction": 0.7, "radius": 2}])
    one = theory.contact_value(packing, dimension)
    found = theory.mixture_contact_values(gas, packing)
    assert found == pytest.approx(np.full((2, 2), one), rel=1e-14)


@packings
def test_disks_obey_the_equation_of_santos_yuste_and_lopez_de_haro(packing):
    """Z = 1/(1-phi) + <a>^2/<a^2> [Z_1 - 1/(1-phi)], Z_1 that of equal disks (Henderson)."""
    gas = elastic(2)
    one = 1 + 2 * packing * theory.contact_value(packing, 2)
    spread = (gas.fraction @ gas.radius) ** 2 / (gas.fraction @ gas.radius**2)
    expected = 1 / (1 - packing) + spread * (one - 1 / (1 - packing))
    assert theory.compressibility(gas, packing) == pytest.approx(expected, rel=1e-14)


@packings
def test_spheres_obey_the_equation_of_boublik_and_mansoori(packing):
    gas, free = elastic(3), 1 - packing
    m1, m2, m3 = (gas.fraction @ gas.radius**k for k in (1, 2, 3))
    expected = 1 / free + 3 * packing / free**2 * m1 * m2 / m3
    expected += packing**2 * (3 - packing) / free**3 * m2**3 / m3**2
    assert theory.compressibility(gas, packing) == pytest.approx(expected, rel=1e-14)


@dimensions
def test_a_tiny_particle_meets_walls_that_are_flat(dimension):
    """A point meets any other as often as there is room for it: chi = 1/(1 - phi), exactly."""
    gas = elastic(dimension, [{"fraction": 0.5}, {"fraction": 0.5, "radius": 1e-12}])
    chi = theory.mixture_contact_values(gas, 0.4)[0, 1]
    assert chi == pytest.approx(1 / 0.6, rel=1e-10)


@dimensions
def test_third_virial_coefficient_of_points_and_disks_is_exact(dimension):
    """Contact values to first order in the density: 1 + n times the room in which both partners of
    a contact touch a third particle, here by sampling."""
    gas, rng, size = elastic(dimension), np.random.default_rng(1), 400_000
    i, j, small = 1, 2, 1e-6
    third = gas.distance[i].max() * (2 * rng.random((size, dimension)) - 1)
    to_other = third - gas.distance[i, j] * np.eye(dimension)[0]
    room = [
        x
        * (np.hypot.reduce(third, axis=1) < gas.distance[i, k])
        * (np.hypot.reduce(to_other, axis=1) < gas.distance[j, k])
        for k, x in enumerate(gas.fraction)
    ]
    cube = (2 * gas.distance[i].max()) ** dimension
    expected = cube * np.sum(room, axis=0)
    chi = theory.mixture_contact_values(gas, small)[i, j]
    slope = (chi - 1) / theory.mixture_density(gas, small)
    error = expected.std() / np.sqrt(size)
    # disks: 9/16 stands for 4/3 - sqrt(3)/pi - ..., right to a per cent
    assert slope == pytest.approx(expected.mean(), abs=4 * error + 0.02 * expected.mean())


@dimensions
def test_a_hotter_species_presses_more(dimension):
    """At equal temperatures Z does not depend on them; what is lost at contacts lowers it."""
    gas = elastic(dimension)
    z = theory.compressibility(gas, 0.3)
    assert theory.compressibility(gas, 0.3, 5.0) == pytest.approx(z, rel=1e-14)
    assert theory.compressibility(gas, 0.3, [1, 1, 4]) > z
    sticky = theory.mixture(SPECIES, 0, 1, dimension)
    assert theory.compressibility(sticky, 0.3) - 1 == pytest.approx((z - 1) / 2, rel=1e-14)


def test_a_full_box_is_refused():
    with pytest.raises(InputError, match=r"packing = 1.0: must lie in \[0, 1\)"):
        theory.compressibility(elastic(2), 1)
    with pytest.raises(InputError, match=r"packing = 0.8: must lie in \[0, 0.7405\]"):
        theory.mixture_density(elastic(3, [{"fraction": 1}]), 0.8)
