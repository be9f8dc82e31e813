import numpy as np
import pytest
from synthetic import reduced

from roughgas.claims.verdicts import FAILS, HOLDS, NOT_TESTED, QUALIFIED


def sheared(direct=0.1, error=0.004, **others):
    """A sheared gas on Eq. (lun), whose un-subtracted R lies `direct` too low."""
    data = reduced("sheared", error=error, measured_for=5000.0, **others)
    data["R_unsubtracted"] = data.R - direct
    data["R_unsubtracted_stderr"] = data.R_stderr
    return data


@pytest.mark.parametrize(("shift", "expected"), [(0, HOLDS), (0.04, QUALIFIED), (0.1, FAILS)])
def test_follows_lun(verdicts, shift, expected):
    data = sheared(shift=lambda r, beta: shift + 0 * r * beta)
    assert verdicts(data)["sheared_follows_lun"].verdict == expected


@pytest.mark.parametrize(("direct", "expected"), [(0.1, HOLDS), (0.04, QUALIFIED), (0.0, FAILS)])
def test_fails_unsubtracted(verdicts, direct, expected):
    found = verdicts(sheared(direct, error=0.002))["shear_fails_unsubtracted"]
    assert found.verdict == expected and "rms difference" in found.reason


def test_unsubtracted_must_be_worse_than_subtracted(verdicts):
    data = sheared(direct=0.05, shift=lambda r, beta: 0.1 + 0 * r * beta)
    assert verdicts(data)["shear_fails_unsubtracted"].verdict == FAILS


def test_without_unsubtracted_values_nothing_is_said(verdicts):
    found = verdicts(reduced("sheared"))["shear_fails_unsubtracted"]
    assert found.verdict == NOT_TESTED and "no un-subtracted R" in found.reason


@pytest.mark.parametrize(
    ("error", "expected"),
    [(0.004, HOLDS), (0.0013, QUALIFIED), (0.001, QUALIFIED), (0.0005, FAILS)],
)
def test_noisier(verdicts, error, expected):
    found = verdicts(sheared(error=error), reduced(error=0.001))["shear_noisier"]
    assert found.verdict == expected
    log = found.numbers[0][1]
    assert log.value == pytest.approx(np.log(error / 0.001), abs=3 * log.stderr)


def test_noise_is_compared_at_the_papers_averaging_times(verdicts):
    short = sheared(error=0.004 * np.sqrt(10))
    short["measured_for"] = 0 * short.R + 500.0
    found = verdicts(short, reduced(error=0.001))["shear_noisier"]
    labels = [label for label, _ in found.numbers]
    assert "at the paper's averaging times" in labels[0] and "at equal times" in labels[1]
    values = [number.value for _, number in found.numbers]
    assert values[0] == pytest.approx(np.log(4), abs=0.3)
    assert values[1] - values[0] == pytest.approx(np.log(5000 / 2000) / 2)


def test_noise_from_few_points_is_not_tested(verdicts):
    places = {"r": (0.9,), "beta": (-0.5, 0.0, 0.5)}
    found = verdicts(sheared(error=0.003, **places), reduced(**places))["shear_noisier"]
    assert found.verdict == NOT_TESTED and "too uncertain" in found.reason


def test_noise_needs_several_seeds(verdicts):
    found = verdicts(sheared(seeds=1), reduced(seeds=1))["shear_noisier"]
    assert found.verdict == NOT_TESTED and "several seeds" in found.reason
