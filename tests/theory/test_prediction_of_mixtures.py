"""What theory says of R of a mixture's dataset, from its attributes."""

import json

import numpy as np
import pytest

from roughgas import theory
from roughgas.theory.prediction import equation_of, predicted_ratio, species_at

ALIKE = [{"fraction": 0.3}, {"fraction": 0.7, "name": "rest"}]
SPECIES = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 2, "mass": 4, "name": "heavy"}]


def attributes(species=SPECIES, kind="K", **others):
    known = {"species": species, "species_pairs": [], "volume": 1e4}
    about = {"dimension": 2, "inertia": 0.5, "particles": 160, "theory": kind}
    return about | {"species_json": json.dumps(known)} | others


@pytest.mark.parametrize("others", [{}, {"mu": 0.4}, {"spin_share": 0.3}])
@pytest.mark.parametrize("kind", ["K", "lun"])
def test_equal_species_are_predicted_as_one(kind, others):
    r, beta = np.meshgrid([0.8, 0.9], [-0.5, 0.0, 1.0])
    found = predicted_ratio(attributes(ALIKE, kind, **others), r, beta)
    one = {"dimension": 2, "inertia": 0.5, "theory": kind} | others
    assert found == pytest.approx(predicted_ratio(one, r, beta), rel=1e-8)


def test_a_cooling_mixture_has_its_packing():
    gas = theory.mixture(SPECIES, 0.9, 0.2)
    expected = theory.mixture_cooling(gas, 160 * np.pi * 2.5 / 1e4).overall_ratio(gas)
    assert predicted_ratio(attributes(), 0.9, 0.2) == pytest.approx(expected, rel=1e-12)


def test_what_is_swept_is_put_in_its_place():
    swept = attributes(swept="species.heavy.mass", mass=np.array([1.0, 9.0]))
    found = predicted_ratio(swept, 0.9, 0.2)
    heavier = [SPECIES[0], SPECIES[1] | {"mass": 9.0}]
    assert found[1] == pytest.approx(predicted_ratio(attributes(heavier), 0.9, 0.2), rel=1e-12)
    spread = [{"fraction": 1, "radius": {"distribution": "uniform", "deviation": 0.1}}]
    swept = attributes(spread, swept="species.0.deviation", deviation=np.array([0.0, 0.2]))
    alike, apart = predicted_ratio(swept, 0.8, -0.5)
    assert alike == pytest.approx(theory.cooling_ratio(0.8, -0.5), rel=1e-9)
    assert apart - alike > 0.03


def test_a_line_of_many_values_is_interpolated():
    beta = np.linspace(-0.3, 1, 801)
    line = predicted_ratio(attributes(), 0.9, beta)
    for k in (1, 333, 799):
        assert line[k] == pytest.approx(predicted_ratio(attributes(), 0.9, beta[k]), abs=1e-4)


def test_smooth_limit_is_that_of_one_species():
    assert predicted_ratio(attributes(), 0.9, -1.0) == pytest.approx(1.0, abs=1e-6)
    assert predicted_ratio(attributes(kind="lun"), 0.9, -1.0) == 0.0


def test_spins_of_a_driven_mixture_follow_its_temperatures():
    state = species_at(attributes(kind="lun"), {"r": 0.9, "beta": 0.0}, [1.0, 3.0])
    gas = theory.mixture(SPECIES, 0.9, 0.0)
    expected = theory.mixture_rotation(gas, np.array([1.0, 3.0]), 160 * np.pi * 2.5 / 1e4)
    assert state.T_rot == pytest.approx(expected, rel=1e-12)
    assert state.T_tr == pytest.approx([1, 3])


def test_equations_have_names():
    assert equation_of(attributes()).name == "theory of free cooling of mixtures"
    assert equation_of(attributes(kind="lun")).name.startswith("Lun's formula for mixtures")
    driven = attributes(kind="lun", spin_share=0.0)
    assert equation_of(driven).name == "rate equations of mixtures"
