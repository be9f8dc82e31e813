"""docs/data.md tells what the files hold, which plain netCDF4 opens."""

import re
import shutil
import time

import netCDF4
import numpy as np
import pytest
import xarray as xr
from tests.data import schema_page as page
from tests.files import frames, point

from roughgas.base import InputError
from roughgas.data.film import read_film, write_film
from roughgas.data.netcdf import COMMON_ATTRIBUTES, read_netcdf, unit_attributes, unit_of
from roughgas.data.point import read_point, write_point
from roughgas.data.reduced import read_reduced
from roughgas.results.reduce import reduce_points
from roughgas.studies.files import combine

KINDS = ("point", "reduced", "film", "studies")
GROUP = {"studies": "coverage"}
GRID = ("wave", "r", "beta")
AXES = {*GRID, "seed"}


def on_grid(dims):
    """Dimensions as the page has them: those of a reduced dataset's grid as one."""
    return ("grid", *dims[len(GRID) :]) if dims[: len(GRID)] == GRID else dims


@pytest.mark.parametrize("kind", page.tables())
def test_the_tables_of_the_page_are_those_of_the_code(kind):
    table = page.tables()[kind]
    assert page.written(kind) == table, "write it anew: python -m tests.data.schema_page"


@pytest.mark.parametrize("kind", KINDS)
def test_plain_netcdf4_finds_what_the_page_says(files, kind):
    known = page.documented(GROUP.get(kind, kind))
    typed = dict(
        re.findall(
            r"^\| `(\w+)` \| [^|]* \| (str|[fiu]\d) \|", page.written(GROUP.get(kind, kind)), re.M
        )
    )
    with netCDF4.Dataset(files[kind]) as file:
        for name, value in COMMON_ATTRIBUTES.items():
            assert file.getncattr(name) == value
        assert file.schema_version == 2 and file.title
        group = file[GROUP[kind]] if kind in GROUP else file
        for name, variable in group.variables.items():
            variable[...]  # can be read
            if kind != "reduced" or name not in AXES:
                assert known[name] == (on_grid(variable.dimensions), variable.long_name), name
            words = variable.dtype is str
            assert words or variable.units in ("1", "s"), name
            if kind in ("point", "film"):
                assert typed[name] == ("str" if words else variable.dtype.str[1:]), name
            is_axis = name in variable.dimensions
            assert not is_axis or "_FillValue" not in variable.ncattrs(), name
            others = getattr(variable, "ancillary_variables", "").split()
            assert group.variables.keys() >= {*others}
        assert len(group.variables) > 10


def test_a_file_holds_no_date(tmp_path):
    write_point(tmp_path / "a.nc", point())
    time.sleep(1.1)  # a second is as fine as HDF5 would note
    write_point(tmp_path / "b.nc", point())
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()


def test_a_film_says_how_disks_belong_to_frames_and_lacks_nothing(files, tmp_path):
    with netCDF4.Dataset(files["film"]) as file:
        assert file["disks"].sample_dimension == "disk"
        assert file["count"].filters()["complevel"] == 4
    incomplete = {name: values for name, values in frames().items() if name != "disk_x"}
    with pytest.raises(ValueError, match="missing variables of a film: disk_x"):
        write_film(tmp_path / "film.nc", incomplete, {})


@pytest.mark.parametrize(
    ("unit", "attributes"),
    [
        ("", {}),
        ("s", {"units": "s"}),
        ("T", {"units": "1", "reduced_units": "T"}),
        ("s/T", {"units": "s", "reduced_units": "s/T"}),
    ],
)
def test_units_are_told_so_that_udunits_reads_them(unit, attributes):
    assert unit_attributes(unit) == attributes and unit_of(attributes) == unit


def test_numbers_that_miss_are_masked_for_those_who_read_masks(files):
    with netCDF4.Dataset(files["point"]) as file:
        assert np.ma.is_masked(file["measured_from"][...])
        assert np.ma.is_masked(file["R_series_stderr"][...])
        assert not np.ma.is_masked(file["R_series"][...])


@pytest.mark.parametrize(
    ("kind", "read"),
    [
        ("point", read_point),
        ("point", lambda path: reduce_points([path], path.with_name("reduced.nc"))),
        ("reduced", read_reduced),
        ("film", read_film),
        ("studies", lambda path: read_netcdf(path, group="coverage")),
        ("task", lambda path: combine([path], output=path.with_name("studies.nc"))),
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
