import numpy as np
import pytest
from synthetic import reduced

from roughgas import theory
from roughgas.claims.verdicts import FAILS, HOLDS, NOT_TESTED, QUALIFIED

ROUGH = tuple(round(0.1 * step, 1) for step in range(-5, 11))


def cooling(shift=0.0, **others):
    """A cooling gas on Eq. (K) but for a constant."""
    return reduced("cooling", lambda r, beta: shift + 0 * r * beta, beta=ROUGH, **others)


def cooling_as(ratio):
    """A cooling gas with R = ratio(r, beta), whatever Eq. (K) says."""

    def shift(r, beta):
        return ratio(r, beta) - theory.cooling_ratio(r, beta, 2, 0.5)

    return reduced("cooling", shift, beta=ROUGH)


def lun(r, beta):
    return theory.lun_ratio(beta, 0.5) + 0 * r


@pytest.mark.parametrize(
    ("shift", "expected"), [(0.0, HOLDS), (-0.012, HOLDS), (0.03, QUALIFIED), (-0.07, FAILS)]
)
def test_follows_k(verdicts, shift, expected):
    found = verdicts(cooling(shift))["cooling_follows_k"]
    assert found.verdict == expected and "Relative to Eq. (K), " in found.reason
    mean = found.numbers[1][1]
    assert mean.value == pytest.approx(shift, abs=0.001) and mean.real == (shift != 0)


@pytest.mark.parametrize(
    ("drift", "steady", "expected"),
    [
        (0.001, 1.0, HOLDS),
        (0.04, 1.0, QUALIFIED),
        (0.1, 1.0, FAILS),
        (0.001, [[0.0], [1.0], [1.0]], QUALIFIED),
        (0.001, [[0.0], [0.0], [1.0]], FAILS),
    ],
)
def test_reaches_a_constant(verdicts, drift, steady, expected):
    steady = np.broadcast_to(steady, (3, len(ROUGH)))
    data = cooling(equilibrated=steady, R_drift=drift, R_drift_stderr=0.001)
    found = verdicts(data)["cooling_reaches_a_constant"]
    assert found.verdict == expected and "A plateau was found at" in found.reason


def test_without_series_the_constant_is_not_tested(verdicts):
    found = verdicts(cooling().drop_vars("R_drift"))["cooling_reaches_a_constant"]
    assert found.verdict == NOT_TESTED


@pytest.mark.parametrize(("slope", "expected"), [(1.0, HOLDS), (0.2, QUALIFIED), (0.0, FAILS)])
def test_depends_on_restitution(verdicts, slope, expected):
    data = cooling_as(lambda r, beta: lun(r, beta) + slope * (1 - r))
    found = verdicts(data)["cooling_depends_on_r"]
    assert found.verdict == expected and "Eq. (K) expects" in found.reason


@pytest.mark.parametrize(("shift", "expected"), [(0.0, HOLDS), (0.04, QUALIFIED), (0.3, FAILS)])
def test_forcing_decides(verdicts, shift, expected):
    assert verdicts(cooling(shift), reduced())["forcing_decides"].verdict == expected


def test_forcing_does_not_decide_where_both_gases_agree(verdicts):
    assert verdicts(cooling_as(lun), reduced())["forcing_decides"].verdict == FAILS


@pytest.mark.parametrize(("slope", "expected"), [(0.0, HOLDS), (0.5, QUALIFIED), (1.0, FAILS)])
def test_restitution_matters_when_cooling(verdicts, slope, expected):
    data = cooling_as(lambda r, beta: lun(r, beta) + 1 - r)
    bed = reduced(shift=lambda r, beta: slope * (1 - r) + 0 * beta)
    assert verdicts(data, bed)["restitution_matters_when_cooling"].verdict == expected
