"""Stationary temperatures of mixtures: one species, conservation, and direct simulation."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.theory.collisions import Dsmc

from roughgas import theory
from roughgas.base import InputError

dimensions = pytest.mark.parametrize("dimension", [2, 3])
UNLIKE = [
    {"fraction": 0.5, "radius": 1, "mass": 1},
    {"fraction": 0.5, "radius": 2, "mass": 4, "inertia": 0.3},
]
one_species = {
    "r": st.floats(0, 1),
    "beta": st.floats(-0.99, 1),
    "q": st.floats(0.05, 1),
    "dimension": st.sampled_from([2, 3]),
}


def equal_species(r, beta, dimension=2, q=None, mu=np.inf):
    species = [{"fraction": share, "radius": 1.7, "mass": 0.4} for share in (0.2, 0.8)]
    return theory.mixture(species, r, beta, dimension, q, mu)


@settings(derandomize=True, deadline=None, max_examples=20)
@given(**one_species)
def test_equal_species_cool_like_a_single_species(r, beta, q, dimension):
    gas = equal_species(r, beta, dimension, q)
    state = theory.mixture_cooling(gas, 0.1)
    assert pytest.approx(np.ones(2), rel=1e-11) == state.T_tr
    R = theory.cooling_ratio(r, beta, dimension, q)
    assert pytest.approx(np.full(2, R), rel=1e-10) == state.R
    assert state.overall_ratio(gas) == pytest.approx(R, rel=1e-10)
    decay = theory.mixture_decay_rate(gas, 0.1)
    assert decay == pytest.approx(theory.decay_rate(r, beta, dimension, q), abs=1e-11)


@settings(derandomize=True, deadline=None, max_examples=15)
@given(**one_species)
def test_a_mixture_of_one_species_relaxes_like_a_gas(r, beta, q, dimension):
    gas = theory.mixture([{"number": 5}], r, beta, dimension, q)
    rate = theory.mixture_relaxation_rate(gas)
    assert rate == pytest.approx(theory.relaxation_rate(r, beta, dimension, q), rel=1e-4)


@settings(derandomize=True, deadline=None, max_examples=15)
@given(**one_species, share=st.floats(0, 1))
def test_equal_species_are_driven_like_a_single_species(r, beta, q, dimension, share):
    gas = equal_species(r, beta, dimension, q)
    if theory.mixture_decay_rate(gas) < 1e-9:
        return
    R = theory.stationary_ratio(r, beta, dimension, q, share)
    state = theory.mixture_driven(gas, 3 * (1 - share), spin_power=3 * share)
    assert pytest.approx(np.full(2, R), rel=1e-8) == state.R


@dimensions
@pytest.mark.parametrize("mu", [0.2, 0.5])
def test_equal_species_with_friction_are_like_a_single_species(dimension, mu):
    gas = equal_species(0.9, 0.4, dimension, mu=mu)
    gas_parameters = 0.9, 0.4, mu, dimension
    assert theory.mixture_cooling(gas).R == pytest.approx(
        theory.friction_ratio(*gas_parameters), rel=1e-9
    )
    driven = theory.friction_ratio(*gas_parameters, spin_share=0.0)
    assert theory.mixture_driven(gas, 1.0).R == pytest.approx(driven, rel=1e-9)
    T_rot = theory.mixture_rotation(gas, 1.0)
    assert T_rot / (1 + T_rot) == pytest.approx(driven, rel=1e-9)


compositions = st.lists(
    st.fixed_dictionaries(
        {
            "number": st.floats(0.01, 1),
            "radius": st.floats(0.2, 5),
            "mass": st.floats(1e-3, 1e3),
            "inertia": st.floats(0.05, 1),
            "restitution": st.floats(0, 0.999),
            "roughness": st.floats(-0.95, 1),
        }
    ),
    min_size=1,
    max_size=4,
)


@settings(derandomize=True, deadline=None, max_examples=20)
@given(species=compositions, dimension=st.sampled_from([2, 3]))
def test_stationary_states_of_mixtures_are_stationary(species, dimension):
    """In any mixture, growth rates of a cooling gas are equal, and drives balance losses."""
    gas = theory.mixture(species, 0.9, 0, dimension)
    cooling = theory.mixture_cooling(gas, 0.1)
    chi = theory.mixture_contact_values(gas, 0.1)
    changes = theory.mixture_changes(gas, *cooling, crowding=chi)
    growth = np.concatenate([change / T for change, T in zip(changes, cooling, strict=True)])
    assert growth.max() < 0
    scale = theory.mixture_frequency(gas, cooling.T_tr, 0.1).max()
    scale /= theory.mixture_density(gas, 0.1)
    assert growth == pytest.approx(growth.mean(), abs=1e-9 * scale, rel=1e-6)
    power = np.arange(1.0, len(species) + 1)
    driven = theory.mixture_driven(gas, power, 0.1)
    tr, rot = theory.mixture_changes(gas, *driven, crowding=chi)
    assert rot == pytest.approx(0, abs=1e-9 * scale * driven.T_tr.max())
    assert tr / power == pytest.approx((tr / power).mean(), rel=1e-8)
    # the same spins follow from the translational temperatures alone
    assert theory.mixture_rotation(gas, driven.T_tr, 0.1) == pytest.approx(driven.T_rot, rel=1e-8)


def test_kicks_give_the_same_power_to_every_pair():
    gas = theory.mixture(UNLIKE, 0.9, 0)
    power = theory.kick_power(gas)
    assert gas.fraction @ power == pytest.approx(1, rel=1e-14)
    # 1 : 4 in mass; half of the kicks are among equals, which get 1/2 each
    assert power == pytest.approx([0.5 + 0.8, 0.5 + 0.2], rel=1e-14)


@dimensions
def test_elastic_mixtures_reach_equipartition(dimension):
    gas = theory.mixture(UNLIKE, 1, 1, dimension)
    state = theory.mixture_cooling(gas)
    assert np.concatenate(state) == pytest.approx(1, rel=1e-12)
    assert theory.mixture_decay_rate(gas) == pytest.approx(0, abs=1e-14)
    with pytest.raises(InputError, match="must be what collisions can dissipate"):
        theory.mixture_driven(gas, 1)


def test_a_smooth_intruder_is_that_of_martin_and_piasecki():
    """A heavy smooth particle in an elastic gas at T = 1: contacts with the gas leave the energy of
    the intruder unchanged at T_2/T_1 = (1+r) m_2/[2 m_2 + (1-r) m_1] (P. A. Martin, J. Piasecki,
    Europhys. Lett. 46, 613, 1999)."""
    species = [{"fraction": 1 - 1e-9}, {"fraction": 1e-9, "mass": 7, "restitution": 0.4}]
    gas = theory.mixture(species, 1, -1, 3)
    r = gas.restitution[0, 1]
    ratio = (1 + r) / (2 * 7 + (1 - r)) * 7
    change = theory.mixture_changes(gas, np.array([1, ratio]), np.zeros(2)).T_tr
    assert change[1] == pytest.approx(0, abs=1e-7)


@dimensions
@pytest.mark.parametrize("packing", [0.0, 0.3])
def test_mimicry_masses_equalise_the_temperatures(dimension, packing):
    fraction, radius = np.array([0.5, 0.3, 0.2]), np.array([1.0, 2.0, 0.4])
    mass = theory.mimicry_masses(fraction, radius, dimension, packing)
    keys = ("fraction", "radius", "mass")
    species = [
        dict(zip(keys, properties, strict=True))
        for properties in zip(fraction, radius, mass, strict=True)
    ]
    for r, beta, mu in ((0.9, 0.3, np.inf), (0.6, -0.7, np.inf), (0.8, 1, 0.4)):
        gas = theory.mixture(species, r, beta, dimension, mu=mu)
        state = theory.mixture_cooling(gas, packing)
        R = theory.friction_ratio(r, beta, mu, dimension)
        assert pytest.approx(np.ones(3), rel=1e-9) == state.T_tr
        assert pytest.approx(np.full(3, R), rel=1e-8) == state.R
    uneven = [member | {"mass": 1.0} for member in species]
    state = theory.mixture_cooling(theory.mixture(uneven, 0.8, 0.3, dimension), packing)
    assert np.ptp(state.T_tr) > 0.05


def simulated_state(gas, seed=3):
    """Return T_2/T_1 of a cooling gas by direct simulation, and R of both species."""
    sample = Dsmc(gas, 3000, seed, T_rot=theory.mixture_cooling(gas).T_rot.mean())
    sample.collide(25)
    temperatures = []
    for _ in range(15):
        sample.collide(2)
        temperatures.append(np.concatenate(sample.temperatures()))
    T_tr, T_rot = np.split(np.mean(temperatures, axis=0), 2)
    return T_tr[1] / T_tr[0], T_rot / (T_rot + T_tr)


@pytest.mark.slow
@dimensions
def test_direct_simulation_has_the_predicted_temperatures(dimension):
    """If hardly any energy is lost, velocities are nearly Maxwellian."""
    gas = theory.mixture(UNLIKE, 0.96, 0.9, dimension)
    expected = theory.mixture_cooling(gas)
    ratio, R = simulated_state(gas)
    assert ratio == pytest.approx(expected.T_tr[1] / expected.T_tr[0], rel=0.05)
    assert pytest.approx(expected.R, rel=0.03) == R
