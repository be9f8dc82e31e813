"""Effects of a study act as those of the package, to the bit."""

import shutil

import numpy as np
import pytest
import xarray as xr
from study_code import ROOT, add_study

import roughgas
from roughgas.config import study_code

POINT = {"r": 0.8, "beta": 0.0, "seed": 1, "progress": False, "config": "config.yaml"}


@pytest.fixture
def study(tmp_path, monkeypatch):
    """The folder of a study in the present folder."""
    shutil.copy(ROOT / "config.yaml", tmp_path)
    monkeypatch.chdir(tmp_path)
    yield add_study()
    study_code.use(())


@pytest.mark.slow
def test_plasticity_in_a_study_equals_the_threshold_of_the_package(study):
    """`threshold` is the same law: slow contacts are elastic."""
    plastic = roughgas.simulate("mine.metal/yield_speed0.5", **POINT)
    same = {"plasticity": None, "threshold": {"speed": 0.5}}
    threshold = roughgas.simulate(
        "cooling",
        effects={"contact_time": None, "threshold": same["threshold"]},
        particles=20,
        box=(25, 25),
        schedule={"plateau": 20, "replicas": 3},
        **POINT,
    )
    elastic = roughgas.simulate(
        "cooling",
        effects={"contact_time": None},
        particles=20,
        box=(25, 25),
        schedule={"plateau": 20, "replicas": 3},
        **POINT,
    )
    without_times = "kernel_seconds"
    xr.testing.assert_equal(plastic.drop_vars(without_times), threshold.drop_vars(without_times))
    assert not np.array_equal(plastic.R_series, elastic.R_series)
    assert plastic.attrs["kernel_source_hash"].count("-") == 1
    assert "--studies studies/mine" in plastic.attrs["command"]
