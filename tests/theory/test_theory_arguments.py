"""Illegal arguments are named in one line, by whichever function gets them."""

import pickle

import numpy as np
import pytest

from roughgas import theory
from roughgas.base import InputError

TAKES_R_AND_BETA = [
    theory.goldshtein_ratio,
    theory.cooling_ratio,
    theory.cooling_K,
    theory.collision_rates,
    theory.stationary_ratio,
    theory.stationary_theta,
    theory.relaxation_rate,
    theory.collisions_to_relax,
    theory.decay_rate,
    lambda r, beta: theory.a_G(r, beta, 0.5),
    lambda r, beta: theory.translational_energy_change(1, 1, 0, 1, r, beta, 0.5),
    lambda r, beta: theory.temperature_changes(1, 1, r, beta),
    lambda r, beta: theory.relax(0, r, beta, 1),
    lambda r, beta: theory.haff_time(r, beta, 1),
    lambda r, beta: theory.haff_temperature(1, 1, r, beta, 1),
]
TAKES_DIMENSION = [
    theory.moment_of_inertia,
    lambda dimension: theory.cooling_ratio(0.9, 0, dimension),
    lambda dimension: theory.collision_rates(0.9, 0, dimension),
    lambda dimension: theory.relax(0, 0.9, 0, 1, dimension),
    lambda dimension: theory.collision_frequency(1, 0.1, dimension),
    lambda dimension: theory.mean_spin_squared(1, dimension, 0.5),
]
TAKES_INERTIA = [
    lambda q: theory.lun_ratio(0, q),
    lambda q: theory.correlated_ratio(0, q, 0),
    lambda q: theory.goldshtein_ratio(0.9, 0, q),
    lambda q: theory.cooling_ratio(0.9, 0, 2, q),
    lambda q: theory.stationary_theta(0.9, 0, 2, q),
    lambda q: theory.rotational_energy_change(1, 0, 1, 0, q),
]
OTHERS = [
    (lambda: theory.relax(-1, 0.9, 0, 1), "theta0 = -1.0: must be a number >= 0"),
    (lambda: theory.relax(1, 0.9, 0, [1, -2]), "collisions = -2.0: must be a number >= 0"),
    (lambda: theory.collisions_to_relax(0.9, 0, 1), "tolerance = 1.0: must lie in (0, 1)"),
    (
        lambda: theory.correlated_ratio(0, 0.5, 1.1),
        "correlation at contacts = 1.1: must lie in [-1, 1]",
    ),
    (lambda: theory.haff_time(0.9, 0, np.inf), "frequency = inf: must be a number >= 0"),
    (lambda: theory.collision_frequency(1, 0.8, 3), "packing = 0.8: must lie in [0, 0.7405]"),
    (
        lambda: theory.stationary_ratio(0.9, 0, spin_share=2.1),
        "net spin share of the drive = 2.1: must lie in [-1, 2]",
    ),
]


@pytest.mark.parametrize("bad", [1.5, -0.1, np.nan, np.inf, "0.5", None, True, 1j])
@pytest.mark.parametrize("function", TAKES_R_AND_BETA)
def test_restitution_outside_its_range(function, bad):
    with pytest.raises(InputError) as caught:
        function(bad, 0)
    assert str(caught.value) == f"restitution r = {bad}: must lie in [0, 1]"


@pytest.mark.parametrize("bad", [1.5, -1.1, np.nan])
@pytest.mark.parametrize("function", TAKES_R_AND_BETA)
def test_roughness_outside_its_range(function, bad):
    with pytest.raises(InputError) as caught:
        function(0.9, np.array([0, bad, 1]))
    assert str(caught.value) == f"roughness beta = {bad}: must lie in [-1, 1]"


@pytest.mark.parametrize("bad", [0, 1, 4, 2.5, np.nan, "2", None])
@pytest.mark.parametrize("function", TAKES_DIMENSION)
def test_dimension_other_than_2_and_3(function, bad):
    with pytest.raises(InputError, match="must be 2 or 3"):
        function(bad)


@pytest.mark.parametrize("bad", [0.0, -0.5, np.nan, np.inf])
@pytest.mark.parametrize("function", TAKES_INERTIA)
def test_inertia_not_positive(function, bad):
    with pytest.raises(InputError) as caught:
        function(bad)
    assert str(caught.value) == f"inertia q = {bad}: must be a positive number"


@pytest.mark.parametrize(("call", "text"), OTHERS)
def test_other_arguments(call, text):
    with pytest.raises(InputError) as caught:
        call()
    assert str(caught.value) == text


def test_error_is_a_value_error_that_survives_a_process_boundary():
    error = pickle.loads(pickle.dumps(InputError("restitution r", 1.5, "lie in [0, 1]")))
    assert isinstance(error, ValueError)
    assert (error.key, error.value, error.legal) == ("restitution r", 1.5, "lie in [0, 1]")
    assert str(error) == "restitution r = 1.5: must lie in [0, 1]"
