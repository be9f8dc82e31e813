"""Verdicts on viscoelastic gases and on Couette flow, with data whose R is known."""

import pytest
from synthetic import couette, reduced, viscoelastic
from tests.houses import part

from roughgas.claims import evidence
from roughgas.claims.verdicts import FAILS, HOLDS, QUALIFIED

materials = part("viscoelastic", "judges")


def judged(judge, *gases):
    return judge(*(evidence.beside_theory(gas) for gas in gases))


@pytest.mark.parametrize(
    ("exponent", "verdict"), [(5 / 3, HOLDS), (1.60, HOLDS), (1.85, QUALIFIED), (2.0, FAILS)]
)
def test_the_exponent_of_time(exponent, verdict):
    """At beta = 0, where roughness dissipates, it is another one, and does not count."""
    found = judged(materials.viscoelastic_exponent, viscoelastic(exponent=exponent))
    assert found.verdict == verdict
    assert found.numbers[0][1].value == pytest.approx(exponent - 5 / 3, abs=1e-9)


@pytest.mark.parametrize(("shift", "verdict"), [(0.0, HOLDS), (0.04, QUALIFIED), (-0.09, FAILS)])
def test_r_follows_the_present_restitution(shift, verdict):
    found = judged(materials.follows_present_restitution, viscoelastic(shift=shift))
    assert found.verdict == verdict
    assert found.numbers[0][1].value == pytest.approx(shift, abs=1e-9)


@pytest.mark.parametrize(("shift", "verdict"), [(0.0, HOLDS), (0.04, QUALIFIED), (0.09, FAILS)])
def test_couette_flow_beside_sliding_images(shift, verdict):
    gases = couette(shift), reduced("sheared", r=(0.9,), error=1e-6)
    found = judged(part("couette", "judges").couette_is_lees_edwards, *gases)
    assert found.verdict == verdict and "Shear rates are from" in found.reason


def test_other_gases_test_nothing():
    with pytest.raises(evidence.NotTestedError, match="how the energy falls"):
        judged(materials.viscoelastic_exponent, reduced("cooling"))
    with pytest.raises(evidence.NotTestedError, match="how the energy falls"):
        judged(materials.follows_present_restitution, reduced("cooling"))
