"""Effects of a study act as those of the package, to the bit."""

import numpy as np
import pytest
import xarray as xr
from study_code import study_in_present_folder

import roughgas

POINT = {"r": 0.8, "beta": 0.0, "seed": 1, "progress": False, "config": "config.yaml"}


@pytest.fixture
def study(tmp_path, monkeypatch):
    """The folder of a study in the present folder."""
    yield from study_in_present_folder(tmp_path, monkeypatch)


SAME = {"particles": 20, "box": (25, 25), "schedule": {"plateau": 20, "replicas": 3}}
"""The gas of the study, without its effect."""


@pytest.mark.slow  # compiles three kernels
def test_plasticity_in_a_study_equals_the_threshold_of_the_package(study):
    """Both let slow contacts be elastic."""
    plastic = roughgas.simulate("mine.metal/yield_speed0.5", **POINT)
    threshold, without = (
        roughgas.simulate("cooling", effects={"contact_time": None} | law, **SAME, **POINT)
        for law in ({"threshold": {"speed": 0.5}}, {})
    )
    shared = plastic.drop_vars(["kernel_seconds", "yield_speed"])
    xr.testing.assert_equal(shared, threshold.drop_vars("kernel_seconds"))
    assert not np.array_equal(plastic.R_series, without.R_series)
    assert plastic.attrs["kernel_source_hash"].startswith(threshold.attrs["kernel_source_hash"])
    assert plastic.attrs["kernel_source_hash"] != threshold.attrs["kernel_source_hash"]
    assert "--studies studies/mine" in plastic.attrs["command"]
