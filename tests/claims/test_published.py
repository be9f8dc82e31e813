"""Published stationary states: what is read of them, and what a judge says of gases beside them."""

import numpy as np
import pytest
from tests.pages import DOCS
from tests.synthetic import reduced

from roughgas.base.files import module_of
from roughgas.claims.evidence import FAILS, HOLDS, NOT_TESTED, QUALIFIED

STUDY = DOCS.parent / "studies" / "megias_santos"
SHARES = (0.0, 0.1, 0.25, 0.5, 0.8, 0.9, 1.0)
ERROR = 4e-4


@pytest.fixture(scope="module")
def published():
    return module_of(STUDY, "published").published


def gas(published, shift, shares=SHARES):
    """A gas whose corrected R lies off the published one by `shift` errors at one share."""
    swept = ("thermostat.spin_share", shares)
    data = reduced("dilute", r=(0.7, 0.9), beta=(-0.7, 0.0), third=swept, error=ERROR)
    values, _ = published("DSMC", data.R)
    off = np.where(data.spin_share == shares[1], shift, 0.0)
    return data.assign(R_corrected=(values.dims, values.values + off[:, None, None]))


def test_all_points_are_read(published):
    """Two of 28 by hand: theta = .2424406 and 60.71607, R = theta/(1 + theta)."""
    data = reduced(r=(0.7, 0.9), beta=(-0.7, 0.0), third=("thermostat.spin_share", SHARES))
    for method in ("DSMC", "EDMD"):
        values, errors = published(method, data.R)
        assert np.isfinite(values).all() and values.size == 28
        assert 0 < errors.min() and errors.max() < 3e-4
    values, _ = published("DSMC", data.R)
    places = [(0.9, 0.0, 0.0), (0.7, -0.7, 1.0)]
    found = [values.sel(r=r, beta=beta, spin_share=s).item() for r, beta, s in places]
    assert found == pytest.approx([0.195133, 0.983797], abs=1e-6)


@pytest.mark.parametrize(("shift", "verdict"), [(0.0, HOLDS), (0.002, QUALIFIED), (-0.004, FAILS)])
def test_a_gas_off_the_published_one_is_told(judged, published, shift, verdict):
    found = judged("stationary_states_are_published", gas(published, shift))
    assert found.verdict == verdict
    assert f"At {4 * (shift != 0.0)} of 28 points" in found.reason


def test_what_nobody_has_published_is_not_judged(judged, published):
    other = gas(published, 0.0, shares=(0.3, 0.4))
    assert judged("stationary_states_are_published", other).verdict == NOT_TESTED
