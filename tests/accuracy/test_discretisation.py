"""The module `discretisation`: its jobs, at tiny settings, and the fits, on data of known law."""

import numpy as np
import pytest
from tests.studies.small_runs import combined, task_results
from tests.study_modules import module_of_study

from roughgas.statistics.fits import PowerLaw

discretisation = module_of_study("accuracy", "discretisation")
slowdown, statistical_error = discretisation.slowdown, discretisation.statistical_error
T = np.array([0.05, 0.02, 0.01, 0.005])


@pytest.mark.slow  # compiles two kernels
def test_values_from_the_jobs():
    results = task_results("accuracy.discretisation")
    for task, result in results.items():
        assert 0.15 < result.R < 0.4 and 0.0 < result.R_stderr < 0.05, task
        assert result.cpu_seconds > 0.0, task
    assert results["event"].R.item() == results["event"].R_series.values.mean()
    assert results["soft-5-0"].collisions == pytest.approx(600, rel=0.2)
    assert results["soft-10-1"].steps == pytest.approx(600 * 10 / 0.05, rel=0.02)
    assert results["model-0"].touched < 0.1 < 0.5 < results["model-1"].touched


@pytest.mark.slow
def test_results_follow_from_the_jobs():
    group = combined("accuracy.discretisation")
    assert group.soft_R.dims == ("steps", "contact_time") and group.reference_collisions == 12000
    assert np.all(np.isfinite(group.soft_matched_seconds))


def test_the_error_of_blocks_of_white_noise():
    """sigma/sqrt(n), within 3.5 of its errors."""
    series = 0.3 + 0.03 * np.random.default_rng(3).standard_normal(20000)
    lengths, (errors, spread, _) = statistical_error(series, 0.3)
    assert lengths[0] == 16 and len(series) // lengths[-1] >= 20
    assert np.all(np.abs(errors - 0.03 / np.sqrt(lengths)) < 3.5 * spread)


def test_slowdown_in_closed_form():
    """Deviation A t and cost c/t: the least of c/[t (1 - (A t/e)^2)] is 3 sqrt(3)/2 A c/e."""
    A, c, events = 1.5, 2e-6, 5e-5
    for target in (0.03, 0.01, 0.003):
        expected = 1.5 * np.sqrt(3.0) * A * c / target / events
        ratio = slowdown(target, T, c / T, PowerLaw(1.0, 0.0, -A, 1.0), events)
        assert ratio == pytest.approx(expected, rel=1e-3)
