"""The study of runaway spins: escapes and their times, and agreement of two methods."""

import math

import numpy as np
import pytest
from raw import FreeCooling
from tests.studies.small_runs import combined, task_run
from tests.studies.small_studies import RUNAWAY
from tests.study_modules import module_of_study

from roughgas import theory
from roughgas.tasks import seed_sequence

runs, results = module_of_study("runaway", "tasks"), module_of_study("runaway", "results")
COOLING = FreeCooling(RUNAWAY.experiments["cooling"], 0.9, 0.0)


def test_participation():
    """One of ten particles spins; all spin alike; two energies of 1 and one of 2."""
    alone = np.zeros((10, 1))
    alone[3] = -2.0
    assert runs.participation(alone) == (1.0, 1.0)
    assert runs.participation(np.ones((10, 3))) == pytest.approx((0.1, 10.0))
    three = np.array([[1.0], [-1.0], [math.sqrt(2)]])
    assert runs.participation(three) == pytest.approx((0.5, 16 / 6))


def scripted(*R):
    remaining = iter(np.reshape(R, (-1, runs.STEP_LENGTH)))
    return lambda: (next(remaining), np.ones((4, 1)))


def test_an_escape_is_dated_by_the_collision():
    ratios = 0.1, 0.2, 0.3, 0.4, 0.5, 0.899, 0.91, 0.95
    assert runs.run_until_escape(scripted(*ratios), 100) == (7.0, 7.0, 0.25, 4.0)
    time, *final = runs.run_until_escape(scripted(*ratios), 4)
    assert math.isnan(time) and final == [4.0, 0.25, 4.0]
    R, share, number = runs.record_series(scripted(0.1, 0.2, 0.3, 0.4, 1, 1, 1, 1), 12)
    np.testing.assert_array_equal(R, [0.4, 1.0, np.nan])
    np.testing.assert_array_equal(share, [0.25, 0.25, np.nan])
    np.testing.assert_array_equal(number, [4.0, 4.0, np.nan])


def test_times_of_escape_are_unbiased_with_unfinished_runs():
    """Exponential times of mean 1000, ten runs each, ended after 800, of 2000 studies: the estimate
    has a known bias of a tenth here; the error covers the truth as one sigma."""
    rng = np.random.default_rng(4)
    time = rng.exponential(1000, (2000, 30))
    observed = np.minimum(time, 800)
    estimates = [
        results.time_of_escape(np.where(row <= 800, row, np.nan), length)[0]
        for row, length in zip(time, observed, strict=True)
    ]
    values, errors = np.array([estimate[:2] for estimate in estimates]).T
    assert values.mean() == pytest.approx(1000, rel=0.06)
    assert np.mean(np.abs(values - 1000) < errors) == pytest.approx(0.68, abs=0.05)


@pytest.mark.slow
def test_combined_results_follow_from_the_tasks():
    data, run = combined("runaway"), task_run("runaway", "dsmc-n400-mu0.1").result
    gas = data.sel(mu=0.1, dsmc_particles=400)
    assert gas.dsmc_escapes == np.isfinite(run.time).sum() == gas.dsmc_runs == 4
    assert gas.dsmc_time == pytest.approx(run.time.mean().item())
    assert gas.dsmc_largest_share == pytest.approx(np.median(run.largest_share))
    assert gas.predicted_time == pytest.approx(theory.runaway_time(400, 0.9, 0.0, 0.1))
    stays = data.sel(mu=0.5, dsmc_particles=40)
    assert stays.dsmc_escapes == 0 and stays.dsmc_bound == pytest.approx(3000 / math.log(20))
    assert np.isnan(stays.dsmc_time) and np.isnan(stays.dsmc_largest_share)
    events_gas = data.sel(mu=0.05, events_particles=40)
    both = events_gas.events_time / data.sel(mu=0.05, dsmc_particles=40).dsmc_time
    assert events_gas.events_escapes > 0 and events_gas.events_over_dsmc == pytest.approx(
        both.item()
    )
    exposed = 40 * 5 * 600 + 400 * 4 * 400
    assert data.rate_bound.sel(mu=0.5) == pytest.approx(math.log(20) / exposed)
    assert data.threshold.sel(mu=0.05) == 0 and np.isnan(data.rate.sel(mu=0.05))
    assert data.example_R.shape == (1, 10) and data.passed[-1] == 40


@pytest.mark.slow
def test_the_table_has_the_material_and_the_runs_that_escaped():
    table = results.table(combined("runaway"))
    assert table.startswith("## Runaway spins (r = 0.9, β = 0.0, packing 0.001)")
    assert "(0/5)" in table


@pytest.mark.slow
@pytest.mark.parametrize("particles, mu", [(100, 0.1), (600, 0.15)])
def test_events_and_dsmc_agree_where_the_gas_is_dilute(particles, mu):
    """The time of escape of 24 gases each: within 4 standard errors."""
    times = []
    for start, key in ((runs.without_positions, 0), (runs.by_events, 1)):
        seeds = seed_sequence(RUNAWAY.settings, 100 + key, particles).spawn(24)
        steps = (start(COOLING, RUNAWAY.settings, mu, particles, seed) for seed in seeds)
        time = np.array([runs.run_until_escape(step, 20000)[0] for step in steps])
        times.append(results.time_of_escape(time, time)[0])
    first, second = times
    assert first.value - second.value == pytest.approx(
        0, abs=4 * math.hypot(first.stderr, second.stderr)
    )
    assert math.hypot(first.stderr, second.stderr) < 0.35 * first.value
