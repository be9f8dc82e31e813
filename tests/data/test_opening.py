"""Files that are opened: damaged ones, those of others, and numbers that cannot be."""

import math
import shutil

import netCDF4
import pytest
from synthetic import reduced
from tests.entry import main

from roughgas.accuracy.running import read_studies
from roughgas.base import InputError
from roughgas.data.netcdf import DamagedError, opened, read_netcdf
from roughgas.data.point import read_point
from roughgas.data.reduced import read_reduced

READERS = {"point": read_point, "reduced": read_reduced, "studies": read_studies}


@pytest.mark.parametrize("wanted", READERS)
@pytest.mark.parametrize("kind", READERS)
def test_a_reader_takes_its_own_kind_alone(files, kind, wanted):
    if kind == wanted:
        READERS[wanted](files[kind])
    else:
        with pytest.raises(InputError, match=r"must be a .*, not a "):
            READERS[wanted](files[kind])


@pytest.mark.parametrize("kind", READERS)
def test_every_flipped_byte_and_every_cut_is_noticed(files, kind, tmp_path):
    content = files[kind].read_bytes()
    path = tmp_path / "spoiled.nc"
    for at in range(0, len(content) - 100, max(1, len(content) // 50)):
        path.write_bytes(content[:at] + bytes([content[at] ^ 0x10]) + content[at + 1 :])
        with pytest.raises(DamagedError), opened(path):
            pass
        path.write_bytes(content[:at])
        with pytest.raises(DamagedError), opened(path):
            pass


def test_a_file_that_claims_to_be_huge_is_refused_before_it_is_read(tmp_path):
    with netCDF4.Dataset(tmp_path / "huge.nc", "w") as file:
        file.createDimension("x", 10**12)
        file.createVariable("x", "f8", ("x",), chunksizes=(1000,))
    assert (tmp_path / "huge.nc").stat().st_size < 100_000
    with pytest.raises(InputError, match=r"size of .*huge\.nc = 8e\+12 bytes: must be at most"):
        read_netcdf(tmp_path / "huge.nc")


def test_a_damaged_point_is_put_aside_and_named(files, tmp_path, capsys):
    path = tmp_path / "seed1.nc"
    path.write_bytes(files["point"].read_bytes()[:-200])
    command = ["reduce", str(path), "-o", str(tmp_path / "all.nc")]
    assert main(command) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert f"{path}" in line and "seed1.nc.damaged: run the same command again" in line
    assert sorted(one.name for one in tmp_path.iterdir()) == ["seed1.nc.damaged"]


def test_a_dataset_without_what_a_summary_quotes_is_refused(files, tmp_path, capsys):
    unquoted = tmp_path / "task.nc"
    shutil.copyfile(files["point"].with_name("task.nc"), unquoted)
    with netCDF4.Dataset(unquoted, "a") as file:
        file.delncattr("settings_json")
    assert main(["show", str(unquoted)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "attribute settings_json of" in line and line.endswith("must be given")


@pytest.mark.parametrize(("name", "value"), [("R", math.nan), ("R", -0.1), ("E_trans", math.inf)])
@pytest.mark.parametrize("command", ["table {} -o out.csv", "figure fig2a {} -o out.png"])
def test_nothing_is_made_of_a_reduced_dataset_with_one(
    tmp_path, capsys, monkeypatch, command, name, value
):
    monkeypatch.chdir(tmp_path)
    data = reduced("sheared")
    data[name][1, 3] = value
    data.to_netcdf("sheared.nc")
    assert main(command.format("sheared.nc").split()) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert f"{name} of sheared.nc = {value}: must lie in" in line
    assert [one.name for one in tmp_path.iterdir()] == ["sheared.nc"]


def test_places_without_seeds_have_no_numbers(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    data = reduced("sheared")
    data["n_seeds"][1, 3], data["R"][1, 3] = 0, math.nan
    data.to_netcdf("sheared.nc")
    assert main(["table", "sheared.nc", "-o", "out.csv"]) == 0
