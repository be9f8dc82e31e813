"""Observables of a study, functions in its observables.py, in points and in reduced datasets."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from study_code import OBSERVABLES, study_in_present_folder

import roughgas
from roughgas.base import InputError
from roughgas.base.files import study_module
from roughgas.base.labels import grid_points
from roughgas.cli import main
from roughgas.data.netcdf import unit_of
from roughgas.scene import build
from roughgas.simulation.run_points import checkpoint_owner

POINT = {"r": 0.9, "beta": 0.5, "seed": 1, "progress": False, "config": "config.yaml"}
RUN = ["run", "mine.observed", "--r=0.9", "--beta=0.5", "-o", "point.nc"]


@pytest.fixture(autouse=True)
def study(tmp_path, monkeypatch):
    """The folder of a study in the present folder."""
    yield from study_in_present_folder(tmp_path, monkeypatch)


def test_results_are_described_and_have_errors(study):
    point = roughgas.simulate("mine.observed", **POINT)
    assert point.fast.attrs["long_name"] == "share of fast particles"
    assert point.squares.dims == ("side",) and point.side.values.tolist() == ["x", "y"]
    assert unit_of(point.squares.attrs) == "a^2 T^-2"
    assert float(point.fast_stderr) > 0.0 and (point.squares_stderr > 0.0).all()
    assert "--studies studies/mine" in point.attrs["command"]


def test_they_are_those_of_the_function_itself(study):
    """With `every` there are half of its observations."""
    functions = study_module(study, "observables")
    function = {"again": functions.fast}
    point = roughgas.simulate("mine.observed", observe=function, **POINT)
    assert point.fast != point.again  # every second observation
    settings = {"fast": {"every": 1}}
    point = roughgas.simulate("mine.observed", observe=settings | function, **POINT)
    for end in ("", "_stderr", "_dof"):
        assert float(point[f"fast{end}"]) == float(point[f"again{end}"])


def test_a_constant_leaves_the_bits_of_all_else():
    plain, constant = (roughgas.simulate(name, **POINT) for name in ("mine.plain", "mine.constant"))
    assert float(constant.constant) == 1.0 and float(constant.constant_stderr) == 0.0
    added = {f"constant{end}" for end in ("", "_stderr", "_dof", "_trusted")}
    assert {*constant.variables} - {*plain.variables} == added
    shared = constant.drop_vars(["kernel_seconds", *added])
    xr.testing.assert_equal(shared, plain.drop_vars("kernel_seconds"))


def test_reduced_datasets_have_errors_over_seeds():
    sweep = POINT | {"beta": [0.0, 0.5], "seed": [1, 2]}
    gas = roughgas.simulate("mine.observed", **sweep)
    assert gas.fast.dims == ("r", "beta") and gas.squares.dims == ("r", "beta", "side")
    points = [roughgas.simulate("mine.observed", **POINT | {"seed": seed}) for seed in (1, 2)]
    mean = np.mean([float(point.fast) for point in points])
    assert float(gas.fast.sel(r=0.9, beta=0.5)) == pytest.approx(mean, rel=1e-12)
    assert (gas.fast_stderr > 0.0).all() and (gas.fast_trusted == -1.0).all()


@pytest.mark.slow  # compiles a kernel of its own
def test_in_a_mixture_a_function_sees_all_particles(study):
    file = study / "observables.py"
    file.write_text(OBSERVABLES + "\n\ndef number(frame):\n    return len(frame.mass)\n")
    species = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 1.5}]
    gas = roughgas.simulate("mine.plain", observe=["number"], species=species, **POINT)
    assert float(gas.number) == 20.0 and "number_species" not in gas


@pytest.mark.parametrize(
    ("body", "line"),
    [
        ("1 / 0", "fast() = ZeroDivisionError: division by zero: must observe this frame"),
        ("None", "fast(): observe.fast = NoneType: must return a number, an array of numbers"),
        ("'much'", "fast(): observe.fast = str: must return a number"),
        ("[frame.time] * (1 + int(frame.time) % 7)", "fast(): observe.fast: shapes = {'fast': ("),
        ("{'R': 1.0}", "fast(): variable = R: must have a name that datasets do not have"),
        ("{'n_seeds': 1.0}", "fast(): variable = n_seeds: must have a name that datasets do not"),
    ],
)
def test_a_function_that_fails_ends_the_run_with_one_line(study, capsys, body, line):
    """It names the file, and nothing is written."""
    (study / "observables.py").write_text(
        OBSERVABLES + f"\n\ndef fast(frame):\n    return {body}\n"
    )
    assert main(RUN) == 2
    *_, error = capsys.readouterr().err.splitlines()
    assert error.startswith(f"roughgas: error: studies/mine/observables.py: {line}")
    assert not Path("point.nc").exists()


def test_settings_alone_need_the_folder(capsys):
    """A job of the workflow gets settings and folders; a point says how to make it again."""
    from roughgas import config

    settings = config.load_experiment("config.yaml", "mine.observed", "paper").text
    assert main([*RUN, "--settings", settings]) == 2
    assert "'fast'" in capsys.readouterr().err
    assert main([*RUN, "--settings", settings, "--studies", "studies/mine"]) == 0
    assert main([*RUN, "--studies", "studies/mine"]) == 2
    assert "--studies needs --settings" in capsys.readouterr().err
    with xr.open_dataset("point.nc") as point:
        assert " --studies studies/mine --settings " in point.attrs["command"]


def test_options_of_a_run_name_them():
    options = ["--observe", "constant", "--set", "particles=21", "-o", "other.nc"]
    assert main(["run", "mine.plain", "--r=0.9", "--beta=0.5", *options]) == 0
    with xr.open_dataset("other.nc") as point:
        assert point.constant == 1.0 and point.attrs["particles"] == 21


def test_a_checkpoint_belongs_to_the_text_of_the_file(study):
    def owner():
        from roughgas.config import experiment_of

        _, _, experiment = experiment_of("mine.observed", {}, path="config.yaml")
        (point,) = grid_points([0.9], [0.5], [1])
        return checkpoint_owner(build(experiment, 0.9, 0.5), experiment, point, ())

    before = owner()
    assert owner() == before
    (study / "observables.py").write_text(OBSERVABLES.replace("4 *", "9 *"))
    assert owner() != before


def test_a_variable_of_reduced_datasets_is_refused(study):
    named = "\n\ndef fast(frame):\n    return {'measured_for': 1.0}\n"
    (study / "observables.py").write_text(OBSERVABLES + named)
    with pytest.raises(InputError, match="variable of fast = measured_for: must have a name that"):
        roughgas.simulate("mine.observed", **POINT | {"seed": [1, 2]})
