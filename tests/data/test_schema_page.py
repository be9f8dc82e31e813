"""Versions of the schema, and contents of files besides variables."""

import shutil
import time

import netCDF4
import pytest
import xarray as xr
from tests.files import combined_coverage, point

from roughgas.base import InputError
from roughgas.data.netcdf import read_netcdf
from roughgas.data.point import read_point, write_point
from roughgas.data.reduced import read_reduced
from roughgas.results.reduce import reduce_points


def test_a_file_holds_no_date(tmp_path):
    write_point(tmp_path / "a.nc", point())
    time.sleep(1.1)  # a second is as fine as HDF5 would note
    write_point(tmp_path / "b.nc", point())
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()


@pytest.mark.parametrize(
    ("kind", "read"),
    [
        ("point", read_point),
        ("point", lambda path: reduce_points([path], path.with_name("reduced.nc"))),
        ("reduced", read_reduced),
        ("studies", lambda path: read_netcdf(path, group="coverage")),
        ("task", lambda path: combined_coverage(path, path.with_name("studies.nc"))),
    ],
)
def test_every_reader_refuses_a_newer_schema_in_one_line(files, tmp_path, kind, read):
    newer = tmp_path / "newer.nc"
    shutil.copyfile(files["point"].with_name(f"{kind}.nc"), newer)
    read(newer)
    with netCDF4.Dataset(newer, "a") as file:
        file.schema_version = 3
    with pytest.raises(InputError, match=r"^schema_version of .*newer\.nc = 3: must be at most 2"):
        read(newer)


def test_a_file_of_the_first_version_is_read(files, tmp_path):
    older = xr.load_dataset(files["point"]).assign_attrs(schema_version=1)
    older.to_netcdf(tmp_path / "older.nc")
    assert read_point(tmp_path / "older.nc").R == older.R
    reduce_points([tmp_path / "older.nc"], tmp_path / "reduced.nc")
    assert read_reduced(tmp_path / "reduced.nc").schema_version == 2
