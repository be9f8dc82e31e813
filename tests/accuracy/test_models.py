"""The module `models` of the accuracy studies: its solvers, error bars, and all of it in small."""

import numpy as np
import pytest
from matplotlib.figure import Figure
from raw import FreeCooling
from tests.studies.small_runs import combined, task_results
from tests.studies.small_studies import MODELS
from tests.study_modules import module_of_study

from roughgas import theory
from roughgas.tasks.free_cooling import integrate

models, plotting = module_of_study("accuracy", "models"), module_of_study("accuracy", "figure")
METHODS, error_bar = models.METHODS, models.error_bar
EXPERIMENT = MODELS.experiments["cooling"]


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("duration", [0.05, 3.0, 40.0])
def test_integrated_rate_equations_agree_with_the_exact_solution(dimension, duration):
    r, beta, theta = 0.7, 0.2, 0.3
    exact = theory.relax(theta, r, beta, duration, dimension)
    T_tr, T_rot = integrate(theta, duration, 0.1, r, beta, dimension)
    assert T_tr == pytest.approx(exact.T_tr, rel=1e-6)
    assert T_rot == pytest.approx(exact.T_rot, rel=1e-6)


def test_a_box_is_scaled_to_the_packing():
    moved = FreeCooling(EXPERIMENT, 0.8, 0.0).at_packing(0.01)
    assert 40 * np.pi / np.prod(moved.experiment.box) == pytest.approx(0.01)
    assert EXPERIMENT["box"] == [50, 50]


def test_error_bars_are_the_scatter_of_rms_errors():
    """Over 4000 repetitions the scatter of an rms has an error of 1.1 %; the Gaussian formula for
    16 groups is good to some per cent."""
    rng = np.random.default_rng(1)
    for offset, common in ((0.0, 0.0), (3.0, 0.0), (3.0, 0.5)):
        shift = offset + common * rng.standard_normal((4000, 1))
        errors = shift + rng.standard_normal((4000, 16))
        observed = np.sqrt(np.mean(errors**2, axis=1)).std()
        assert np.median(error_bar(errors, common)) == pytest.approx(observed, rel=0.07)


def test_the_map_shows_the_gaps():
    data, axes = combined("accuracy.models"), Figure().subplots()
    plotting.draw_map(axes, data)
    curve = next(c for c in axes.containers if c.get_label() == "$r = 0.6$")
    assert np.array_equal(curve.lines[0].get_ydata(), 100 * data.map_gap.sel(map_r=0.6))


def test_results_follow_from_the_tasks():
    results, data = task_results("accuracy.models"), combined("accuracy.models")
    reference = np.concatenate([results[f"reference-{k}"].R for k in range(2)]).mean()
    assert float(data.R_reference) == pytest.approx(reference) and data.reference_replicas == 20
    assert float(data.closed_form_R) == pytest.approx(theory.cooling_ratio(0.8, 0.0))
    # rate equations end at the theory of free cooling
    assert data.rate_equations_R.values[-1] == pytest.approx(float(data.closed_form_R), rel=1e-4)
    first = results["event_driven"].R.values[0] / reference - 1
    assert data.event_driven_error.values[0] == pytest.approx(np.sqrt(np.mean(first**2)))
    factors = [1 + float(data[name]) for name in ("of_maxwellian", "of_number", "of_dilution")]
    assert np.prod(factors) == pytest.approx(float(data.closed_form_R) / reference)
    assert data.map_gap.sel(map_r=0.6, map_beta=1.0) == pytest.approx(
        results["map-r0.6"].R.values[1] / theory.cooling_ratio(0.6, 1.0) - 1
    )
    density = results["density-r0.8-beta-0.3"]
    corrected = density.R.values.mean(axis=1) * float(density.R_many / density.R_few)
    assert data.density_gap.values[0] == pytest.approx(
        corrected / theory.cooling_ratio(0.8, -0.3) - 1
    )


def test_everything_has_an_error_bar_and_takes_time():
    data = combined("accuracy.models")
    for method in METHODS:
        for quantity in ("error", "error_stderr", "seconds"):
            values = data[f"{method}_{quantity}"].values
            assert np.all(np.isfinite(values)) and np.all(values > 0), (method, quantity)
    assert np.all(data.map_gap_stderr > 0) and np.all(data.density_gap_stderr > 0)
    assert 0 < data.closed_form_seconds < data.event_driven_seconds[0]
