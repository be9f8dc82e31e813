"""Published stationary states: reading of their table, and judges of gases with known
deviations."""

import numpy as np
import pytest
from tests.pages import DOCS
from tests.synthetic import reduced

from roughgas import theory
from roughgas.base.files import study_module
from roughgas.claims.verdicts import FAILS, HOLDS, NOT_TESTED, QUALIFIED

STUDY = DOCS.parent / "studies" / "megias_santos"
SHARES = (0.0, 0.1, 0.25, 0.5, 0.8, 0.9, 1.0)
ERROR = 4e-4
DEGREES_OF_FREEDOM = 25.0
CUMULANTS = "a20", "a11", "a02"


@pytest.fixture(scope="module")
def published():
    return study_module(STUDY, "published").published


def gas(published, shift, shares=SHARES, shifted="R"):
    """Return a gas whose corrected R, or a cumulant, is off the published one by `shift` at one
    share."""
    swept = ("thermostat.spin_share", shares)
    data = reduced("dilute", r=(0.7, 0.9), beta=(-0.7, 0.0), third=swept, error=ERROR)
    for name in ("R", *CUMULANTS):
        values, _ = published("DSMC", data.R, name)
        off = np.where(data.spin_share == shares[1], shift if name == shifted else 0.0, 0.0)
        variable = "R_corrected" if name == "R" else name
        data = data.assign({variable: (values.dims, values.values + off[:, None, None])})
        data[f"{name}_stderr"] = 0.0 * data.R + ERROR
        data[f"{name}_dof"] = 0.0 * data.R + DEGREES_OF_FREEDOM
    return data


def test_all_points_are_read(published):
    """Two of 28 by hand: theta = .2424406 and 60.71611, R = theta/(1 + theta)."""
    data = reduced(r=(0.7, 0.9), beta=(-0.7, 0.0), third=("thermostat.spin_share", SHARES))
    for method in ("DSMC", "EDMD"):
        values, errors = published(method, data.R)
        assert np.isfinite(values).all() and values.size == 28
        assert 0 < errors.min() and errors.max() < 3e-4
    values, _ = published("DSMC", data.R)
    states = [(0.9, 0.0, 0.0), (0.7, -0.7, 1.0)]
    values_by_hand = [values.sel(r=r, beta=beta, spin_share=s).item() for r, beta, s in states]
    assert values_by_hand == pytest.approx([0.195133, 0.983797], abs=1e-6)
    values_by_hand = [
        published("DSMC", data.R, name)[0].sel(r=0.9, beta=0.0, spin_share=0.0).item()
        for name in CUMULANTS
    ]
    assert values_by_hand == [-0.00981, 0.11139, 0.02973]


def test_the_sonine_approximation_predicts_published_states(published):
    """Theory without a fitted number: R five times nearer than Maxwellian theory, cumulants to a
    fifth of their size (root mean squares). So the columns are identified correctly."""
    data = reduced(r=(0.7, 0.9), beta=(-0.7, 0.0), third=("thermostat.spin_share", SHARES))
    axes = (data[name].broadcast_like(data.R).values for name in ("r", "beta", "spin_share"))
    r, beta, share = axes
    sonine = theory.sonine_state(r, beta, spin_share=share)
    exact = published("DSMC", data.R)[0].values
    off = [sonine.R - exact, theory.stationary_ratio(r, beta, spin_share=share) - exact]
    assert rms(off[0]) < rms(off[1]) / 5
    for name in CUMULANTS:
        values = published("DSMC", data.R, name)[0].values
        assert rms(getattr(sonine, name) - values) < rms(values) / 5


def rms(values):
    return np.sqrt(np.mean(values**2))


@pytest.mark.parametrize(("shift", "verdict"), [(0.0, HOLDS), (0.002, QUALIFIED), (-0.004, FAILS)])
def test_a_deviation_of_R_from_the_published_one_is_judged(judged, published, shift, verdict):
    finding = judged("stationary_states_are_published", gas(published, shift))
    assert finding.verdict == verdict
    assert f"At {4 * (shift != 0.0)} of 28 points" in finding.reason


@pytest.mark.parametrize(("shift", "verdict"), [(0.0, HOLDS), (0.008, QUALIFIED), (-0.02, FAILS)])
@pytest.mark.parametrize("name", CUMULANTS)
def test_deviations_of_cumulants_are_judged(judged, published, name, shift, verdict):
    finding = judged("cumulants_are_published", gas(published, shift, shifted=name))
    assert finding.verdict == verdict
    assert f"At {4 * (shift != 0.0)} of 84 points" in finding.reason


def test_unpublished_states_are_not_judged(judged, published):
    unpublished = gas(published, 0.0, shares=(0.3, 0.4))
    for name in ("stationary_states_are_published", "cumulants_are_published"):
        assert judged(name, unpublished).verdict == NOT_TESTED
