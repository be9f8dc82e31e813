"""Mixtures: their structure, and the energy changes of contacts between species."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.theory.collisions import (
    after_contact,
    directions,
    energies,
    maxwellian_spins,
    maxwellian_velocities,
)

from roughgas import theory
from roughgas.base import InputError

SAMPLES = 60_000
UNLIKE = [
    {"fraction": 0.3, "radius": 1.0, "mass": 1.0, "inertia": 0.5},
    {"fraction": 0.7, "radius": 2.5, "mass": 5.0, "inertia": 0.3, "restitution": 0.7},
]
T_TR, T_ROT = np.array([1.0, 2.0]), np.array([0.6, 3.0])
dimensions = pytest.mark.parametrize("dimension", [2, 3])


def sampled_changes(gas, i, j, seed=0):
    """Return the mean energies that a particle of i gains from a contact with j, and their errors.

    Normals are uniform and velocities Maxwellian; pairs are weighted by their approach speed.
    """
    rng, D = np.random.default_rng(seed), gas.dimension
    n = directions(rng, SAMPLES, D)

    def particles(k):
        inertia = gas.inertia[k] * gas.mass[k] * gas.radius[k] ** 2
        v = maxwellian_velocities(rng, SAMPLES, D, np.sqrt(T_TR[k] / gas.mass[k]))
        w = maxwellian_spins(rng, SAMPLES, D, np.sqrt(T_ROT[k] / inertia))
        return [v, w, *(np.full(SAMPLES, x) for x in (gas.mass[k], inertia, gas.radius[k]))]

    first, second = particles(i), particles(j)
    weight = np.maximum(-np.sum((first[0] - second[0]) * n, axis=1), 0)
    rule = gas.restitution[i, j], gas.roughness[i, j], gas.friction[i, j]
    (v, w), _ = after_contact(n, first, second, *rule)
    before, after = energies(*first[:4]), energies(v, w, *first[2:4])
    weight = weight / weight.mean()
    gains = [weight * (new - old) for new, old in zip(after, before, strict=True)]
    return np.mean(gains, axis=1), np.std(gains, axis=1) / np.sqrt(SAMPLES)


@dimensions
@pytest.mark.parametrize(("beta", "mu"), [(0.4, np.inf), (-0.6, np.inf), (0.5, 0.4)])
def test_rates_are_those_of_sampled_contacts(dimension, beta, mu):
    gas = theory.mixture(UNLIKE, 0.9, beta, dimension, mu=mu)
    nu = theory.mixture_frequency(gas, T_TR, 0.1) / theory.mixture_density(gas, 0.1)
    expected, error = np.zeros((2, 2)), np.zeros((2, 2))
    for i in range(2):
        for j in range(2):
            energy, spread = sampled_changes(gas, i, j)
            expected[:, i] += nu[i, j] * energy
            error[:, i] += (nu[i, j] * spread) ** 2
    crowding = theory.mixture_contact_values(gas, 0.1)
    predicted = np.array(theory.mixture_changes(gas, T_TR, T_ROT, crowding))
    predicted *= np.array([[dimension], [2 * dimension - 3]]) / 2
    assert (np.abs(predicted - expected) < 4 * np.sqrt(error)).all()
    assert (np.sqrt(error) < 0.04 * np.abs(expected).max(axis=1, keepdims=True)).all()


def equal_species(number, **properties):
    shares = np.arange(1, number + 1) / (number * (number + 1) / 2)
    return [{"fraction": share} | properties for share in shares]


@settings(derandomize=True, deadline=None, max_examples=60)
@given(
    r=st.floats(0, 1),
    beta=st.floats(-0.999, 1),
    q=st.floats(0.05, 1),
    dimension=st.sampled_from([2, 3]),
    size=st.floats(0.1, 10),
    mu=st.sampled_from([np.inf, 1.0, 0.2]),
)
def test_equal_species_have_the_rates_of_a_single_species(r, beta, q, dimension, size, mu):
    gas = theory.mixture(equal_species(3, radius=size, mass=1 / size), r, beta, dimension, q, mu)
    changes = theory.mixture_changes(gas, np.full(3, 1.3), np.full(3, 0.7))
    nu = theory.mixture_frequency(gas, 1.3, 0.1)
    rate = theory.mixture_density(gas, 0.1) / nu.sum(axis=1)
    crowding = theory.mixture_contact_values(gas, 0.1)
    expected = theory.friction_changes(1.3, 0.7, r, beta, mu, dimension, q)
    for change, expected_change in zip(changes, expected, strict=True):
        assert change * rate * crowding[0, 0] == pytest.approx(
            np.full(3, expected_change), abs=1e-13
        )


@dimensions
@pytest.mark.parametrize("beta", [-1, 1])
def test_elastic_mixtures_keep_their_energy_and_share_it_equally(dimension, beta):
    elastic = [species | {"restitution": 1.0} for species in UNLIKE]
    gas = theory.mixture(elastic, 1, beta, dimension)
    tr, rot = theory.mixture_changes(gas, T_TR, T_ROT)
    assert np.abs(tr).min() > 0.1  # each species gains or loses
    change = gas.fraction @ (dimension * tr + (2 * dimension - 3) * rot)
    assert change == pytest.approx(0, abs=1e-12)
    changes = np.array(theory.mixture_changes(gas, [2, 2], [2, 2]))
    assert changes == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("kind", ["uniform", "lognormal"])
def test_a_distribution_has_its_moments(kind):
    """As sampled radii have; masses follow from one density, unless stated."""
    radius = {"distribution": kind, "deviation": 0.2, "mean": 1.5}
    species = [{"fraction": 0.4, "radius": radius}, {"fraction": 0.6, "mass": 3}]
    gas = theory.mixture(species, 0.9, 0)
    in_first = gas.species_of == 0
    share = gas.fraction[in_first] / 0.4
    rng = np.random.default_rng(1)
    width = np.sqrt(np.log(1.04))
    sampled_radii = {
        "uniform": 1.5 * (1 + np.sqrt(3) * 0.2 * rng.uniform(-1, 1, 400_000)),
        "lognormal": 1.5 * np.exp(width * rng.standard_normal(400_000) - width**2 / 2),
    }[kind]
    assert share.sum() == pytest.approx(1, rel=1e-14)
    for power in (1, 2, 3, 5):
        assert share @ gas.radius[in_first] ** power == pytest.approx(
            (sampled_radii**power).mean(), rel=0.01
        )
    assert share @ gas.mass[in_first] == pytest.approx(1.5**2 * 1.04, rel=1e-9)
    assert (gas.mass[~in_first] == 3).all()


def test_a_list_of_radii_is_a_distribution(tmp_path):
    gas = theory.mixture([{"fraction": 1, "radius": [1, 2, 2, 3]}], 0.9, 0)
    assert gas.radius == pytest.approx([1, 2, 3])
    assert gas.fraction == pytest.approx([0.25, 0.5, 0.25])
    (tmp_path / "radii").write_text("1\n3\n")
    of_file = {"distribution": "file", "file": str(tmp_path / "radii")}
    assert theory.mixture([{"fraction": 1, "radius": of_file}], 0.9, 0).radius == pytest.approx(
        [1, 3]
    )
    radii = np.linspace(1, 3, 1001)
    gas = theory.mixture([{"fraction": 1, "radius": radii.tolist()}], 0.9, 0)
    assert len(gas.radius) == 12
    assert gas.fraction @ gas.radius**2 == pytest.approx((radii**2).mean(), rel=1e-3)


def test_pairs_have_the_coefficients_stated_for_them():
    species = [{"fraction": 0.5, "name": "steel"}, {"fraction": 0.5, "name": "glass"}]
    pairs = [{"between": ["glass", "steel"], "restitution": 0.5}, {"between": [1, 1], "mu": 0.2}]
    gas = theory.mixture(species, 0.9, 0, pairs=pairs[:1])
    assert gas.restitution == pytest.approx(np.array([[0.9, 0.5], [0.5, 0.9]]))
    unnamed = [{"fraction": 0.5}, {"fraction": 0.5}]
    assert theory.mixture(unnamed, 0.9, 0, pairs=pairs[1:]).friction[1, 1] == 0.2
    with pytest.raises(InputError, match=r"species_pairs\.between = wood: must be one of st"):
        theory.mixture(species, 0.9, 0, pairs=[{"between": ["wood", "steel"]}])


def test_unlike_partners_have_mean_coefficients():
    species = [{"fraction": 0.5}, {"fraction": 0.5, "restitution": 0.7, "roughness": 1, "mu": 0.3}]
    gas = theory.mixture(species, 0.9, 0, mu=0.1)
    assert gas.restitution == pytest.approx(np.array([[0.9, 0.8], [0.8, 0.7]]))
    assert gas.roughness == pytest.approx(np.array([[0, 0.5], [0.5, 1]]))
    assert gas.friction == pytest.approx(np.array([[0.1, 0.2], [0.2, 0.3]]))


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
    contact_value = theory.contact_value(packing, dimension)
    contact_values = theory.mixture_contact_values(gas, packing)
    assert contact_values == pytest.approx(np.full((2, 2), contact_value), rel=1e-14)


@packings
def test_disks_obey_the_equation_of_santos_yuste_and_lopez_de_haro(packing):
    """Z = 1/(1-phi) + <a>^2/<a^2> [Z_1 - 1/(1-phi)], Z_1 of equal disks (Henderson)."""
    gas = elastic(2)
    equal_disks = 1 + 2 * packing * theory.contact_value(packing, 2)
    spread = (gas.fraction @ gas.radius) ** 2 / (gas.fraction @ gas.radius**2)
    expected = 1 / (1 - packing) + spread * (equal_disks - 1 / (1 - packing))
    assert theory.compressibility(gas, packing) == pytest.approx(expected, rel=1e-14)


@packings
def test_spheres_obey_the_equation_of_boublik_and_mansoori(packing):
    gas, free = elastic(3), 1 - packing
    m1, m2, m3 = (gas.fraction @ gas.radius**k for k in (1, 2, 3))
    expected = 1 / free + 3 * packing / free**2 * m1 * m2 / m3
    expected += packing**2 * (3 - packing) / free**3 * m2**3 / m3**2
    assert theory.compressibility(gas, packing) == pytest.approx(expected, rel=1e-14)


@dimensions
def test_the_contact_value_of_a_point_is_the_inverse_of_the_free_volume(dimension):
    """A point may be anywhere in the free volume: chi = 1/(1 - phi), exactly."""
    gas = elastic(dimension, [{"fraction": 0.5}, {"fraction": 0.5, "radius": 1e-12}])
    chi = theory.mixture_contact_values(gas, 0.4)[0, 1]
    assert chi == pytest.approx(1 / 0.6, rel=1e-10)


@dimensions
def test_third_virial_coefficient_of_points_and_disks_is_exact(dimension):
    """Contact values to first order in the density: 1 + n times the volume where a third particle
    touches both partners of a contact, here by sampling."""
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
