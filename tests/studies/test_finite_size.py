"""The study of number and box: its observables of a gas, and all of it in small."""

import numpy as np
import pytest
from raw import FreeCooling, build, start_gas
from tests.studies.small_runs import combined, task_run
from tests.studies.small_studies import FINITE_SIZE
from tests.study_modules import module_of_study

from roughgas import theory

runs = module_of_study("finite_size", "tasks")
draw = module_of_study("finite_size", "figure").draw
EXPERIMENTS = FINITE_SIZE.experiments


def gas_of(sides, dimension):
    """Return a gas of `sides`^dimension particles on a lattice that fills its box, with equal
    spins."""
    number, effects = sides**dimension, {"spin": {"inertia": 0.5}}
    experiment = {"particles": number, "box": [4.0 * sides] * dimension, "effects": effects}
    gas = start_gas(build(experiment, 0.9, 0.0), experiment, np.random.default_rng(1))
    lattice = np.indices([sides] * dimension).reshape(dimension, -1).T
    gas.state.trajectory[:, :dimension], gas.state.spin[:] = 4.0 * lattice, 1.0
    return gas


@pytest.mark.parametrize("dimension", [2, 3])
def test_shear_waves_are_measured(dimension):
    """All energy is in a shear wave of the longest wavelength; half of it with an equal wave along
    its own direction; none if velocities alternate."""
    sides = 8
    gas = gas_of(sides, dimension)
    x, v = gas.state.trajectory[:, 0].copy(), gas.state.trajectory[:, dimension : 2 * dimension]
    wave = np.sin(2 * np.pi * x / (4.0 * sides) + 0.3)
    v[:] = 0.0
    v[:, 1] = wave
    assert runs.cumulant_and_flow(gas)[1] == pytest.approx(1.0)
    v[:, 0] = wave
    assert runs.cumulant_and_flow(gas)[1] == pytest.approx(0.5)
    v[:, 0], v[:, 1] = 0.0, np.cos(np.pi * x / 4.0 + 0.3)
    assert runs.cumulant_and_flow(gas)[1] == pytest.approx(0.0, abs=1e-12)


def test_results_follow_from_the_tasks():
    data, task = combined("finite_size"), "cooling_r0.8_beta-0.3-n40"
    result = task_run("finite_size", task).result
    gas = data.isel(point=1).sel(particles=40, packing=0.001)
    late = result.R.values[1, :, 8:]
    assert gas.theory == pytest.approx(theory.cooling_ratio(0.8, -0.3))
    assert gas.R == pytest.approx(late.mean()) and gas.replicas == len(late)
    assert gas.R_stderr == pytest.approx(late.mean(axis=1).std(ddof=1) / np.sqrt(len(late)))
    assert gas.over_dsmc == pytest.approx(late.mean() / float(result.dsmc_R) - 1)
    assert gas.flow_of_noise == 0.05 and gas.length == result.length
    assert gas.R_series.sizes == {"part": 16}
    side = np.sqrt(40 * np.pi / 0.001)
    assert gas.box == pytest.approx(side / theory.mean_free_path(0.001))
    assert data.box.isel(point=2, particles=0, packing=0) == pytest.approx(
        (20 * 4 * np.pi / 3 / 0.05) ** (1 / 3) / theory.mean_free_path(0.05, 3)
    )


@pytest.mark.slow
def test_the_figure_names_every_point():
    data = combined("finite_size")
    number, _, box, _ = draw(data).axes
    assert len(number.get_yticklabels()) == data.sizes["point"] and box.get_yscale() == "linear"


def test_a_run_is_unknown_after_its_collapse():
    plain = EXPERIMENTS["cooling"] | {"effects": {"spin": {"inertia": 0.5}}}
    gas = runs.gas_in_box(FreeCooling(plain, 0.05, 0.0), 40, 0.4)
    part_values = runs.run_by_events(gas, 4, 8, np.random.SeedSequence(1))
    assert np.isfinite(part_values[0]).all() and np.isnan(part_values[-1]).all()
