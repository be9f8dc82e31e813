"""Coverage: its estimators on data of known law, and a corner from end to end."""

import math

import numpy as np
import pytest
from tests.studies.small_runs import combined, task_run
from tests.study_modules import module_of_study

from roughgas.statistics.estimates import Estimate

coverage = module_of_study("coverage", "coverage")
calibrate, one_run, table = coverage.calibrate, coverage.one_run, coverage.table
DOF = 8


def honest(rng, runs, excess=1.0, bias=0.0):
    """Return runs of unit scatter whose errors, with DOF degrees of freedom, are `excess` times too
    large."""
    stderr = excess * np.sqrt(rng.chisquare(DOF, runs) / DOF)
    return Estimate(rng.standard_normal(runs) + bias, stderr, np.full(runs, float(DOF)))


def calibrated(runs, seed=0):
    return calibrate(runs, Estimate(0.0, 0.0), (0.68, 0.95), 4, np.random.default_rng(seed))


@pytest.mark.slow
def test_honest_runs_are_found_honest():
    """At 4 sigma, 10 numbers: by chance once in 1600."""
    calibration = calibrated(honest(np.random.default_rng(1), 2000))
    off = calibration["coverage"].value - [0.68, 0.95]
    assert np.all(np.abs(off) < 4 * calibration["coverage"].stderr + 0.004)  # of the quantile
    assert abs(calibration["bias"].value) < 4 * calibration["bias"].stderr
    assert (
        abs(calibration["stated_over_true"].value - 1) < 4 * calibration["stated_over_true"].stderr
    )


def test_errors_that_are_too_small_and_a_bias_are_found():
    calibration = calibrated(honest(np.random.default_rng(2), 1000, excess=0.7, bias=0.3))
    assert calibration["stated_over_true"].value == pytest.approx(0.7, abs=0.06)
    assert calibration["bias"].value == pytest.approx(0.3, abs=0.13)
    assert np.all(calibration["coverage"].value[:, 1] < 0.90)


@pytest.mark.slow
def test_errors_of_the_coverage_match_its_scatter():
    """60 studies: each of four scatters has an error of 9 %; at 4 sigma by chance once in 4000."""
    studies = [calibrated(honest(np.random.default_rng((3, k)), 100), k) for k in range(60)]
    scatter = np.std([study["coverage"].value for study in studies], axis=0, ddof=1)
    stated = np.sqrt(np.mean(np.square([study["coverage"].stderr for study in studies]), axis=0))
    assert np.all(np.abs(scatter / stated - 1) < 0.36)


def test_runs_that_state_no_error_hold_no_truth():
    nothing = Estimate(np.zeros(3), np.full(3, math.nan), np.zeros(3))
    (share,) = one_run(nothing, 0.0, [0.95])
    assert share.value == 0.0
    assert share.stderr > 0.0


def test_every_corner_has_its_runs():
    data = combined("coverage.coverage")
    assert list(data.corner.values) == ["bed_r0.9_beta-0.5", "gas_r0.9_beta0"]
    assert np.all(data.repetitions == 8)
    assert np.all((data.coverage >= 0) & (data.coverage <= 1))
    assert np.all(data.cpu_seconds > 0)
    share = 100 * float(data.coverage.sel(corner="bed_r0.9_beta-0.5", way="one run", level=0.95))
    row = table(data).splitlines()[4].split(" | ")
    assert float(row[3].split(" ± ")[0]) == pytest.approx(share, abs=0.5)


def test_the_truth_is_measured_for_longer():
    bed = task_run("coverage.coverage", "bed_r0.9_beta-0.5").result
    assert bed.truth_R_stderr.max() < bed.R_stderr.mean()
