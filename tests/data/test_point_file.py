import os
import subprocess
import sys

import netCDF4
import numpy as np
import pytest
from tests import files

from roughgas.base.files import write_text
from roughgas.data.netcdf import FIRST, number_in
from roughgas.data.point import Point, read_point, write_point

ATTRIBUTES = files.ABOUT | {"command": "roughgas run ..."}
CAPTURED = {"capture_output": True, "text": True, "check": True}


def point(**others) -> Point:
    known = files.point().variables | {"R": 0.25, "collisions": 2**40}
    return Point(known | others, dict(ATTRIBUTES))


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


@pytest.mark.parametrize("kind", [np.int8, np.int64, float])
def test_a_number_is_read_and_written_without_being_looked_for(tmp_path, kind):
    """By what netCDF4 keeps to itself: without it all would be as right, and slower."""
    with netCDF4.Dataset(tmp_path / "a.nc", "w") as file:
        number = file.createVariable("number", kind, ())
        number._put(np.array(100, kind), *FIRST)
        assert number_in(number) == number._get(*FIRST) == number[...] == 100
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
    ("others", "message"),
    [
        ({"R_serie": 1.0}, "unknown variables of a point: R_serie"),
        ({"R_series": 1.0}, "R_series has shape"),
        ({"E_rot_series": np.zeros(7)}, "E_rot_series has 7 values along sample, others 50"),
    ],
)
def test_what_the_table_does_not_know_is_refused(tmp_path, others, message):
    with pytest.raises(ValueError, match=message):
        write_point(tmp_path / "a.nc", point(**others))
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


def test_what_a_killed_run_left_behind_is_removed(tmp_path):
    gone = subprocess.run([sys.executable, "-c", "import os; print(os.getpid())"], **CAPTURED)
    (tmp_path / f"a.nc.{int(gone.stdout)}.tmp").write_bytes(b"half a file")
    write_point(tmp_path / "a.nc", point())
    assert os.listdir(tmp_path) == ["a.nc"]
    assert read_point(tmp_path / "a.nc").R.item() == 0.25


def test_what_a_process_has_left_is_removed_before_its_parent_notes_its_end(tmp_path):
    over = subprocess.Popen([sys.executable, "-c", ""])
    os.waitid(os.P_PID, over.pid, os.WEXITED | os.WNOWAIT)
    left = tmp_path / f"table.csv.{over.pid}.tmp"
    left.write_bytes(b"half a file")
    write_text(tmp_path / "table.csv", "whole")
    over.wait()
    assert not left.exists()
