import os
import subprocess
import sys
from importlib.util import find_spec

import netCDF4
import numpy as np
import pytest
import xarray as xr
from tests import files

from roughgas.base.files import write_text
from roughgas.data.netcdf import SCALAR_SLICE, number_in
from roughgas.data.point import Point, as_dataset, read_point, write_point

ATTRIBUTES = files.ATTRIBUTES | {"command": "roughgas run ..."}
CAPTURED = {"capture_output": True, "text": True, "check": True}


def point(**changes) -> Point:
    variables = files.point().variables | {"R": 0.25, "collisions": 2**40}
    return Point(variables | changes, dict(ATTRIBUTES))


def test_a_point_comes_back_as_written(tmp_path):
    path = tmp_path / "new" / "folders" / "seed3.nc"
    write_point(path, point())
    data = read_point(path)
    assert data.R.item() == 0.25 and data.R.dtype == np.float64
    assert data.collisions.item() == 2**40 and data.collisions.dtype == np.int64
    assert data.equilibrated.dtype == np.int8
    np.testing.assert_array_equal(data.R_series, point().variables["R_series"])
    assert data.R_series.dims == ("sample",) and "time" in data.R_series.coords
    assert {name: data.attrs[name] for name in ATTRIBUTES} == ATTRIBUTES
    assert data.attrs["schema_version"] == 2 and data.attrs["Conventions"].startswith("CF-")


COORDINATES = {"r": 0.9, "beta": -0.5, "seed": 3}


@pytest.mark.parametrize(
    ("extra_attributes", "axis"),
    [
        ({}, {}),
        ({"swept": "spin.inertia", "swept_value": 0.3}, {"inertia": 0.3}),
        ({"swept": "floor.wave", "swept_value": "sine"}, {"wave": "sine"}),
        ({"swept": "box.sample", "swept_value": 0.3}, {}),  # a dimension has this name
        ({"swept": "case.R", "swept_value": 0.3}, {}),  # and a variable this one
    ],
)
def test_r_beta_and_seed_are_coordinates_of_points_in_old_files_too(
    tmp_path, extra_attributes, axis
):
    written = point()
    written.attributes.update(extra_attributes)
    write_point(tmp_path / "a.nc", written)
    data = read_point(tmp_path / "a.nc")
    assert {name: data[name].item() for name in (COORDINATES | axis)} == COORDINATES | axis
    assert {name for name, coordinate in data.coords.items() if not coordinate.dims} == (
        COORDINATES | axis
    ).keys()
    assert (data.r.dtype, data.beta.dtype, data.seed.dtype) == (float, float, np.int64)
    assert all(data[name].long_name and data[name].units == "1" for name in COORDINATES)
    assert {"r", "beta", "seed"} <= set(data.R_series.coords)
    assert as_dataset(written).identical(data)
    with xr.open_dataset(tmp_path / "a.nc") as opened:
        opened.drop_vars([*COORDINATES, *axis]).to_netcdf(tmp_path / "old.nc")
    with netCDF4.Dataset(tmp_path / "old.nc") as file:
        assert file.variables.keys().isdisjoint(COORDINATES | axis)
    assert read_point(tmp_path / "old.nc").identical(data)


def test_points_are_combined_by_xarray_alone(tmp_path):
    for r in (0.8, 0.9):
        for beta in (-0.5, 0.5):
            written = point(R=r * beta)
            written.attributes.update(r=r, beta=beta)
            write_point(tmp_path / f"r{r}/beta{beta}/seed3.nc", written)
    paths = sorted(tmp_path.glob("r*/beta*/seed3.nc"))
    combined = [xr.concat(map(read_point, paths), "point", coords="different", compat="equals")]
    if find_spec("dask"):
        files = {"combine": "nested", "concat_dim": "point", "coords": "all", "compat": "equals"}
        combined.append(xr.open_mfdataset(paths, **files).compute())
        assert combined[-1].seed.values.tolist() == [3] * 4
    for data in combined:
        assert data.r.values.tolist() == [0.8, 0.8, 0.9, 0.9]
        assert data.beta.values.tolist() == [-0.5, 0.5] * 2
        grid = data.drop_vars("seed").set_index(point=["r", "beta"]).unstack("point")
        assert grid.R.sel(r=0.9, beta=0.5) == 0.45 and grid.R_series.sizes["sample"] == 50


@pytest.mark.parametrize("kind", [np.int8, np.int64, float])
def test_numbers_are_read_and_written_by_private_methods_of_netcdf4(tmp_path, kind):
    """By private methods of netCDF4: public ones would give the same numbers, but more slowly."""
    with netCDF4.Dataset(tmp_path / "a.nc", "w") as file:
        number = file.createVariable("number", kind, ())
        number._put(np.array(100, kind), *SCALAR_SLICE)
        assert number_in(number) == number._get(*SCALAR_SLICE) == number[...] == 100
        file.createDimension("sample", 3)
        with pytest.raises(ValueError):
            number_in(file.createVariable("series", kind, ("sample",)))


def test_a_cooling_gas_counts_collisions_and_initial_energies(tmp_path):
    cooling = point(R_replica=np.array([0.2, 0.3]), plateau_end=40.0, contact_time=1e-4)
    cooling.variables["collisions_per_particle"] = cooling.variables.pop("time")
    write_point(tmp_path / "a.nc", cooling)
    data = read_point(tmp_path / "a.nc")
    counted = {data[name].reduced_units for name in ("measured_from", "plateau_end")}
    assert counted == {"collisions per particle"}
    assert data.contact_time.reduced_units == "T"
    assert data.E_rot.reduced_units == "initial E_trans" and "reduced_units" not in data.R.attrs
    assert data.R_replica.dims == ("replica",)
    assert "collisions_per_particle" in data.R_series.coords


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"R_serie": 1.0}, "unknown variables of a point: R_serie"),
        ({"R_series": 1.0}, "R_series has shape"),
        ({"E_rot_series": np.zeros(7)}, "E_rot_series has 7 values along sample, others 50"),
    ],
)
def test_unknown_or_misshapen_variables_are_refused(tmp_path, changes, message):
    with pytest.raises(ValueError, match=message):
        write_point(tmp_path / "a.nc", point(**changes))
    assert not list(tmp_path.iterdir())


def test_missing_variables_and_attributes_are_refused(tmp_path):
    incomplete = point()
    del incomplete.variables["E_rot"]
    with pytest.raises(ValueError, match="missing variables of a point: E_rot"):
        write_point(tmp_path / "a.nc", incomplete)
    incomplete = point()
    del incomplete.attributes["seed"]
    with pytest.raises(ValueError, match="missing attributes of a point: seed"):
        write_point(tmp_path / "a.nc", incomplete)


def test_a_write_that_fails_leaves_nothing(tmp_path, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space left"):
        write_point(tmp_path / "a.nc", point())
    assert not list(tmp_path.iterdir())


def test_a_failed_write_keeps_the_file_that_was_there(tmp_path, monkeypatch):
    write_point(tmp_path / "a.nc", point())
    before = (tmp_path / "a.nc").read_bytes()
    monkeypatch.setattr(os, "replace", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        write_point(tmp_path / "a.nc", point(R=0.3))
    assert (tmp_path / "a.nc").read_bytes() == before
    assert os.listdir(tmp_path) == ["a.nc"]


def test_files_left_by_a_killed_run_are_removed(tmp_path):
    gone = subprocess.run([sys.executable, "-c", "import os; print(os.getpid())"], **CAPTURED)
    (tmp_path / f"a.nc.{int(gone.stdout)}.tmp").write_bytes(b"half a file")
    write_point(tmp_path / "a.nc", point())
    assert os.listdir(tmp_path) == ["a.nc"]
    assert read_point(tmp_path / "a.nc").R.item() == 0.25


def test_files_left_by_a_process_are_removed_before_its_parent_reaps_it(tmp_path):
    ended = subprocess.Popen([sys.executable, "-c", ""])
    os.waitid(os.P_PID, ended.pid, os.WEXITED | os.WNOWAIT)
    left = tmp_path / f"table.csv.{ended.pid}.tmp"
    left.write_bytes(b"half a file")
    write_text(tmp_path / "table.csv", "whole")
    ended.wait()
    assert not left.exists()
