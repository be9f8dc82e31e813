"""What waiting costs: fits and errors on transients of known law, and judges of the statements."""

import numpy as np
import pytest
import xarray as xr
from tests.study_modules import module_of_study

from roughgas.claims.verdicts import FAILS, HOLDS, QUALIFIED, NotTestedError

waiting, judges = (module_of_study("accuracy", name) for name in ("waiting", "judges"))
TIMES = np.array([1.0, 2, 3, 5, 7, 10, 14, 20, 30, 50, 70, 100])
E_FOLD = 12.0


def test_an_e_fold_and_its_error_are_those_of_the_transient():
    """300 sets of 16 noisy runs: the mean to 1 % and four standard errors, the error to a fifth."""
    rng = np.random.default_rng(1)
    decay = 3.0 * (1.0 - np.exp(-TIMES / E_FOLD))
    fits = []
    for _ in range(300):
        early = decay + 0.05 * rng.standard_normal((16, len(TIMES)))
        settled = 3.0 + 0.05 * rng.standard_normal(16)
        fits.append(
            waiting.jackknife(
                early,
                settled,
                lambda early, settled: waiting.fitted_e_fold(
                    TIMES, waiting.lack_of_energy(early, settled)
                ),
            )
        )
    e_folds, errors = np.array(fits).T
    assert abs(e_folds.mean() - E_FOLD) < 4.0 * e_folds.std() / np.sqrt(300) + 0.01 * E_FOLD
    assert np.sqrt((errors**2).mean()) / e_folds.std() == pytest.approx(1.0, abs=0.2)


def test_noise_after_the_transient_does_not_count_and_too_few_times_give_no_e_fold():
    lack = np.exp(-TIMES / E_FOLD)
    noisy = np.where(TIMES > 40.0, 0.01, lack)
    noisy[-1] = 0.3
    assert waiting.fitted_e_fold(TIMES, noisy) == pytest.approx(E_FOLD)
    assert np.isnan(waiting.fitted_e_fold(TIMES, np.zeros(len(TIMES))))


def beds(bias=0.0, e_fold=200.0):
    """Data of three beds whose e-folds are 200 T by theory, and 2 T."""
    settling = np.array([200.0, 200.0, 2.0])
    of_point = {
        "r": [0.99, 0.99, 0.9],
        "beta": [1.0, -0.9, 0.0],
        "runs": [24, 48, 48],
        "settling": settling,
        "e_fold": np.where(settling > 100.0, e_fold, np.nan),
        "e_fold_stderr": 0.02 * settling,
    }
    variables = {name: ("point", np.array(column)) for name, column in of_point.items()}
    variables["R_bias"] = ("point", "wait"), np.full((3, 2), bias)
    variables["R_bias_stderr"] = ("point", "wait"), np.full((3, 2), 0.0003)
    return xr.Dataset(variables, coords={"wait": [100.0, judges.SHORT_WAIT]})


@pytest.mark.parametrize(("bias", "verdict"), [(0.0001, HOLDS), (0.004, QUALIFIED), (0.01, FAILS)])
def test_a_short_wait_suffices_unless_R_is_biased(bias, verdict):
    assert judges.short_wait_suffices(beds(bias)).verdict == verdict


@pytest.mark.parametrize(
    ("e_fold", "verdict"), [(180.0, HOLDS), (260.0, QUALIFIED), (320.0, FAILS)]
)
def test_beds_settle_as_theory_says_unless_their_e_folds_differ(e_fold, verdict):
    assert judges.beds_settle(beds(e_fold=e_fold)).verdict == verdict


def test_fast_beds_do_not_test_how_slow_beds_settle():
    with pytest.raises(NotTestedError, match="no bed has an e-fold"):
        judges.beds_settle(beds().isel(point=[2]))
