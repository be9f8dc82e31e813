"""The module `discretisation`: its jobs, at tiny settings, and the fits, on data of known law."""

import numpy as np
import pytest
from matplotlib.figure import Figure
from tests.pages import check_study
from tests.study_modules import module_of_study

from roughgas.statistics.fits import PowerLaw
from roughgas.tasks.running import Experiments

discretisation = module_of_study("accuracy", "discretisation")
slowdown, statistical_error = discretisation.slowdown, discretisation.statistical_error
draw = module_of_study("accuracy", "figure").draw_discretisation
SETTINGS = {
    "seed": 3,
    "r": 0.9,
    "beta": 0.0,
    "packing": 0.1,
    "contact_times": [0.2, 0.05],
    "steps": [5, 10],
    "soft_collisions": 600,
    "model_contact_times": [0.01, 1.0],
    "model_collisions": 300,
    "event_collisions": 4000,
    "reference_runs": 2,
    "reference_collisions": 6000,
}
COOLING = {"particles": 40, "box": [50, 50], "effects": {"spin": {"inertia": 0.5}}}
T = np.array([0.05, 0.02, 0.01, 0.005])


def run(task, settings=SETTINGS):
    calls = []
    experiments = Experiments({"cooling": COOLING})
    result = discretisation.run(task, settings, experiments, lambda *a: calls.append(a))
    assert calls and all(0 <= done < total for done, total in calls)
    return result


@pytest.fixture(scope="module")
def task_results():
    return {task: run(task) for task in discretisation.tasks(SETTINGS)}


@pytest.fixture(scope="module")
def group(task_results):
    return discretisation.combine(task_results, SETTINGS)


@pytest.mark.slow  # compiles two kernels
def test_values_from_the_jobs(task_results):
    for task, result in task_results.items():
        assert 0.15 < result.R < 0.4 and 0.0 < result.R_stderr < 0.05, task
        assert result.cpu_seconds > 0.0, task
    assert task_results["event"].R.item() == task_results["event"].R_series.values.mean()
    assert task_results["soft-5-0"].collisions == pytest.approx(600, rel=0.2)
    assert task_results["soft-10-1"].steps == pytest.approx(600 * 10 / 0.05, rel=0.02)
    assert task_results["model-0"].touched < 0.1 < 0.5 < task_results["model-1"].touched


@pytest.mark.slow
def test_jobs_are_independent(task_results):
    values = [result.R.item() for result in task_results.values()]
    assert len(set(values)) == len(values)


@pytest.mark.slow
def test_everything_in_the_group_is_described(group):
    for name, values in group.variables.items():
        assert values.attrs["long_name"] and values.attrs["units"], name
    check_study("discretisation", group)
    draw(Figure().subplots(), group)
    assert group.soft_R.dims == ("steps", "contact_time") and group.attrs["seed"] == 3
    assert group.reference_collisions == 12000
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
