"""The study of number and box: what it sees in a gas, all of it in small, what it should find."""

import numpy as np
import pytest
from brute_force import KERNELS
from matplotlib.figure import Figure
from tests.houses import check_variables, part, quietly
from tests.show.figures.legibility import faults

from roughgas import config, theory
from roughgas.scene import build
from roughgas.simulation.gas import Gas
from roughgas.tasks.free_cooling import FreeCooling

runs, results = part("finite_size", "tasks"), part("finite_size", "results")
draw = part("finite_size", "figure").draw
CONFIG = config.load("tests/experiments.yaml")
EXPERIMENTS = {
    name: config.experiment(CONFIG, name, "paper") for name in ("cooling", "cooling_spheres")
}
EXPERIMENTS["cooling_spheres"]["effects"] = KERNELS["spheres"]["effects"]  # others compile that
SETTINGS = {
    "seed": 1,
    "particles": [20, 40],
    "packings": [0.05, 0.001],
    "precision": 0.2,
    "points": {"cooling": [["0.9", "0"], ["0.8", "-0.3"]], "cooling_spheres": [["0.8", "0"]]},
}


@pytest.fixture(scope="module")
def parts():
    return {task: runs.run(task, SETTINGS, EXPERIMENTS, quietly) for task in runs.tasks(SETTINGS)}


@pytest.fixture(scope="module")
def data(parts):
    return results.combine(parts, SETTINGS)


def gas_of(sides, dimension):
    """A gas of `sides`^dimension particles on a lattice that fills its box, spinning alike."""
    number, effects = sides**dimension, {"spin": {"inertia": 0.5}}
    experiment = {"particles": number, "box": [4.0 * sides] * dimension, "effects": effects}
    gas = Gas.start(build(experiment, 0.9, 0.0), experiment, np.random.default_rng(1))
    places = np.indices([sides] * dimension).reshape(dimension, -1).T
    gas.state.trajectory[:, :dimension], gas.state.spin[:] = 4.0 * places, 1.0
    return gas


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_wave_is_told_from_noise(dimension):
    """A shear wave of the longest wavelength is all there is; half of it with as much of a wave
    along its own direction, and none where velocities alternate."""
    sides = 8
    gas = gas_of(sides, dimension)
    x, v = gas.state.trajectory[:, 0].copy(), gas.state.trajectory[:, dimension : 2 * dimension]
    wave = np.sin(2 * np.pi * x / (4.0 * sides) + 0.3)
    v[:] = 0.0
    v[:, 1] = wave
    assert runs.look(gas)[1] == pytest.approx(1.0)
    v[:, 0] = wave
    assert runs.look(gas)[1] == pytest.approx(0.5)
    v[:, 0], v[:, 1] = 0.0, np.cos(np.pi * x / 4.0 + 0.3)
    assert runs.look(gas)[1] == pytest.approx(0.0, abs=1e-12)


def test_runs_are_all_different(parts):
    R = np.concatenate([part.R.values.ravel() for part in parts.values()])
    assert len(set(R)) == len(R)


def test_results_are_what_they_are_made_of(parts, data):
    one, part = (
        data.isel(point=1).sel(particles=40, packing=0.001),
        parts["cooling_r0.8_beta-0.3-n40"],
    )
    late = part.R.values[1, :, 8:]
    assert one.theory == pytest.approx(theory.cooling_ratio(0.8, -0.3))
    assert one.R == pytest.approx(late.mean()) and one.replicas == len(late)
    assert one.R_stderr == pytest.approx(late.mean(axis=1).std(ddof=1) / np.sqrt(len(late)))
    assert one.over_dsmc == pytest.approx(late.mean() / float(part.dsmc_R) - 1)
    assert one.flow_of_noise == 0.05 and one.length == part.length
    assert one.R_series.sizes == {"part": 16}
    side = np.sqrt(40 * np.pi / 0.001)
    assert one.box == pytest.approx(side / theory.mean_free_path(0.001))
    assert data.box.isel(point=2, particles=0, packing=0) == pytest.approx(
        (20 * 4 * np.pi / 3 / 0.05) ** (1 / 3) / theory.mean_free_path(0.05, 3)
    )


@pytest.mark.slow
def test_it_is_documented_tabulated_and_drawn(data):
    check_variables("finite_size", data)
    table = results.table(data)
    assert table.count("\n| cooling, r = 0.8, β = −0.3 |") == 6
    assert table.count("\n## ") + table.startswith("## ") == 1
    figure = draw(data)
    assert isinstance(figure, Figure) and len(figure.axes) == 4
    number, _, box, _ = figure.axes
    assert len(number.get_yticklabels()) == data.sizes["point"] and box.get_yscale() == "linear"
    assert not any("printed at" in fault for fault in faults(lambda: draw(data)))


def test_a_run_that_collapses_is_unknown_from_there_on():
    plain = EXPERIMENTS["cooling"] | {"effects": {"spin": {"inertia": 0.5}}}
    gas = runs.at_density(FreeCooling(plain, 0.05, 0.0), 40, 0.4)
    seen = runs.follow(gas, 4, 8, np.random.SeedSequence(1))
    assert np.isfinite(seen[0]).all() and np.isnan(seen[-1]).all()
