"""Coverage: its estimators on numbers of known law, and a corner from end to end."""

import math

import numpy as np
import pytest
from brute_force import settings
from schedules import COOLING, STEADY
from tests.pages import check_study

from roughgas.accuracy import coverage
from roughgas.accuracy.coverage import calibrate, one_run, table
from roughgas.statistics.errors import Estimate

tasks = coverage.tasks


def run(task, settings, experiments, progress=lambda done, total: None):
    return coverage.run(task, settings, experiments, progress)


DOF = 8
EXPERIMENTS = {
    "bed": settings("bed", 10, [10, "open"]) | {"schedule": STEADY},
    "gas": settings("gas", 10, [20, 20]) | {"schedule": COOLING},
}
SETTINGS = {
    "seed": 1,
    "repetitions": 8,
    "pooled": 4,
    "reference": {"seeds": 2, "length": 20},
    "corners": [
        {"experiment": "bed", "r": "0.9", "beta": "-0.5", "schedule": {"measure": 30}},
        {"experiment": "gas", "r": "0.9", "beta": "0", "schedule": {"plateau": 30}},
    ],
}


def honest(rng, runs, excess=1.0, bias=0.0):
    """Runs of unit scatter whose errors, known with DOF degrees of freedom, are `excess` as big."""
    stderr = excess * np.sqrt(rng.chisquare(DOF, runs) / DOF)
    return Estimate(rng.standard_normal(runs) + bias, stderr, np.full(runs, float(DOF)))


def calibrated(runs, seed=0):
    return calibrate(runs, Estimate(0.0, 0.0), (0.68, 0.95), 4, np.random.default_rng(seed))


@pytest.mark.slow
def test_honest_runs_are_found_honest():
    """At 4 sigma, 10 numbers: by chance once in 1600."""
    found = calibrated(honest(np.random.default_rng(1), 2000))
    off = found["coverage"].value - [0.68, 0.95]
    assert np.all(np.abs(off) < 4 * found["coverage"].stderr + 0.004)  # of the quantile
    assert abs(found["bias"].value) < 4 * found["bias"].stderr
    assert abs(found["stated_over_true"].value - 1) < 4 * found["stated_over_true"].stderr


def test_errors_that_are_too_small_and_a_bias_are_found():
    found = calibrated(honest(np.random.default_rng(2), 1000, excess=0.7, bias=0.3))
    assert found["stated_over_true"].value == pytest.approx(0.7, abs=0.06)
    assert found["bias"].value == pytest.approx(0.3, abs=0.13)
    assert np.all(found["coverage"].value[:, 1] < 0.90)


@pytest.mark.slow
def test_the_errors_of_the_coverage_are_those_seen_over_many_studies():
    """60 studies: each of four scatters is known to 9 %; at 4 sigma by chance once in 4000."""
    studies = [calibrated(honest(np.random.default_rng((3, k)), 100), k) for k in range(60)]
    seen = np.std([one["coverage"].value for one in studies], axis=0, ddof=1)
    stated = np.sqrt(np.mean(np.square([one["coverage"].stderr for one in studies]), axis=0))
    assert np.all(np.abs(seen / stated - 1) < 0.36)


def test_runs_that_state_no_error_hold_no_truth():
    nothing = Estimate(np.zeros(3), np.full(3, math.nan), np.zeros(3))
    (share,) = one_run(nothing, 0.0, [0.95])
    assert share.value == 0.0
    assert share.stderr > 0.0


@pytest.fixture(scope="module")
def parts():
    return {task: run(task, SETTINGS, EXPERIMENTS) for task in tasks(SETTINGS)}


def test_every_corner_has_its_runs_and_its_truth(parts):
    data = coverage.combine(parts, SETTINGS)
    assert list(data.corner.values) == ["bed_r0.9_beta-0.5", "gas_r0.9_beta0"]
    assert np.all(data.repetitions == 8)
    assert np.all((data.coverage >= 0) & (data.coverage <= 1))
    assert np.all(data.cpu_seconds > 0)
    check_study("coverage", data)
    share = 100 * float(data.coverage.sel(corner="bed_r0.9_beta-0.5", way="one run", level=0.95))
    row = table(data).splitlines()[4].split(" | ")
    assert float(row[3].split(" ± ")[0]) == pytest.approx(share, abs=0.5)


def test_the_truth_is_measured_for_longer_and_from_other_seeds(parts):
    for part in parts.values():
        assert not np.isin(part.truth_R, part.R).any()
        assert len(np.unique(part.R)) == part.sizes["run"]
    bed = parts["bed_r0.9_beta-0.5"]
    assert bed.truth_R_stderr.max() < bed.R_stderr.mean()
