"""A simulated mixture beside the mixture theory."""

import numpy as np
import pytest

from roughgas import simulate, theory
from roughgas.scene import build
from roughgas.simulation import cooling

SPECIES = [{"fraction": 0.5, "radius": 1, "mass": 1}, {"fraction": 0.5, "radius": 2, "mass": 4}]
GAS = {"particles": 160, "box": [100, 100], "effects": {"spin": {"inertia": 0.5}}}


def test_the_transient_is_that_of_the_slowest_ratio():
    experiment = GAS | {"species": SPECIES}
    scene = build(experiment, 0.9, 0.0)
    gas = theory.mixture(SPECIES, 0.9, 0.0)
    rate = theory.mixture_relaxation_rate(gas, 160 * np.pi * 2.5 / 1e4)
    assert cooling.rate_of(scene, experiment) == pytest.approx(rate, rel=1e-9)
    assert rate < theory.relaxation_rate(0.9, 0.0)
    assert cooling.transient_length(scene, 8.0, experiment) == pytest.approx(8 / rate)


def test_equal_species_wait_as_long_as_one():
    experiment = GAS | {"species": [{"fraction": 0.5}, {"fraction": 0.5, "name": "b"}]}
    scene, one = build(experiment, 0.9, 0.0), build(GAS, 0.9, 0.0)
    # the ratio of their temperatures settles, too, and here faster than R
    assert cooling.rate_of(scene, experiment) == pytest.approx(cooling.rate_of(one), rel=1e-4)


@pytest.mark.slow
def test_simulate_agrees_with_theory_where_it_is_nearly_maxwellian():
    """Dilute, and nearly elastic: temperatures and R of each species within errors or 3 %."""
    gas = simulate(
        "cooling",
        r=0.96,
        beta=0.9,
        box=[600, 600],
        species=SPECIES,
        schedule={"replicas": 30, "plateau": 100},
        progress=False,
    )
    mixed = theory.mixture(SPECIES, 0.96, 0.9)
    expected = theory.mixture_cooling(mixed, gas.attrs["packing"])
    ratio = gas.E_trans_species.values[1] / gas.E_trans_species.values[0]
    relative = gas.E_trans_species_stderr.values / gas.E_trans_species.values
    error = 4 * np.hypot(*relative) + 0.01
    # momentum is zero, which takes the share m_i/M of a particle's energy of translation
    of_few = (1 - 4 / 400) / (1 - 1 / 400)
    assert ratio == pytest.approx(of_few * expected.T_tr[1] / expected.T_tr[0], rel=error)
    tolerance = 4 * gas.R_species_stderr.values + 0.03 * expected.R
    assert (np.abs(gas.R_species.values - expected.R) < tolerance).all()
