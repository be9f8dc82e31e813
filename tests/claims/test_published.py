"""Published stationary states: what is read of them, and what a judge says of gases beside them."""

import numpy as np
import pytest
from tests.pages import DOCS
from tests.synthetic import reduced

from roughgas import theory
from roughgas.base.files import module_of
from roughgas.claims.evidence import FAILS, HOLDS, NOT_TESTED, QUALIFIED

STUDY = DOCS.parent / "studies" / "megias_santos"
SHARES = (0.0, 0.1, 0.25, 0.5, 0.8, 0.9, 1.0)
ERROR = 4e-4
CUMULANTS = "a20", "a11", "a02"


@pytest.fixture(scope="module")
def published():
    return module_of(STUDY, "published").published


def gas(published, shift, shares=SHARES, shifted="R"):
    """A gas whose corrected R, or a cumulant, is off the published one by `shift` at one share."""
    swept = ("thermostat.spin_share", shares)
    data = reduced("dilute", r=(0.7, 0.9), beta=(-0.7, 0.0), third=swept, error=ERROR)
    for name in ("R", *CUMULANTS):
        values, _ = published("DSMC", data.R, name)
        off = np.where(data.spin_share == shares[1], shift if name == shifted else 0.0, 0.0)
        known = "R_corrected" if name == "R" else name
        data = data.assign({known: (values.dims, values.values + off[:, None, None])})
        data[f"{name}_stderr"] = 0.0 * data.R + ERROR
    return data


def test_all_points_are_read(published):
    """Two of 28 by hand: theta = .2424406 and 60.71611, R = theta/(1 + theta)."""
    data = reduced(r=(0.7, 0.9), beta=(-0.7, 0.0), third=("thermostat.spin_share", SHARES))
    for method in ("DSMC", "EDMD"):
        values, errors = published(method, data.R)
        assert np.isfinite(values).all() and values.size == 28
        assert 0 < errors.min() and errors.max() < 3e-4
    values, _ = published("DSMC", data.R)
    places = [(0.9, 0.0, 0.0), (0.7, -0.7, 1.0)]
    found = [values.sel(r=r, beta=beta, spin_share=s).item() for r, beta, s in places]
    assert found == pytest.approx([0.195133, 0.983797], abs=1e-6)
    found = [
        published("DSMC", data.R, name)[0].sel(r=0.9, beta=0.0, spin_share=0.0).item()
        for name in CUMULANTS
    ]
    assert found == [-0.00981, 0.11139, 0.02973]


def test_the_sonine_approximation_predicts_them(published):
    """Theory without a fitted number: R five times nearer than Maxwellian theory, cumulants to a
    fifth of their size (root mean squares). So the columns are what we take them for."""
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
def test_a_gas_off_the_published_one_is_told(judged, published, shift, verdict):
    found = judged("stationary_states_are_published", gas(published, shift))
    assert found.verdict == verdict
    assert f"At {4 * (shift != 0.0)} of 28 points" in found.reason


@pytest.mark.parametrize(("shift", "verdict"), [(0.0, HOLDS), (0.008, QUALIFIED), (-0.02, FAILS)])
@pytest.mark.parametrize("name", CUMULANTS)
def test_a_gas_of_other_cumulants_is_told(judged, published, name, shift, verdict):
    found = judged("cumulants_are_published", gas(published, shift, shifted=name))
    assert found.verdict == verdict
    assert f"At {4 * (shift != 0.0)} of 84 points" in found.reason


def test_what_nobody_has_published_is_not_judged(judged, published):
    other = gas(published, 0.0, shares=(0.3, 0.4))
    for name in ("stationary_states_are_published", "cumulants_are_published"):
        assert judged(name, other).verdict == NOT_TESTED
