"""Opening of damaged files, of files of other programs, and of impossible numbers."""

import fcntl
import math
import shutil
import subprocess
import sys
import threading
from pathlib import Path

import netCDF4
import pytest
from synthetic import reduced
from tests.entry import main

from roughgas.base import InputError
from roughgas.data.netcdf import DamagedError, append_checksum, opened, read_groups, read_netcdf
from roughgas.data.point import read_point
from roughgas.data.reduced import read_reduced

PAPER = Path(__file__).parents[2] / "studies" / "paper"
READERS = {"point": read_point, "reduced": read_reduced, "studies": read_groups}


@pytest.mark.parametrize("expected", READERS)
@pytest.mark.parametrize("kind", READERS)
def test_a_reader_takes_its_kind_of_file_alone(files, kind, expected):
    if kind == expected:
        READERS[expected](files[kind])
    else:
        with pytest.raises(InputError, match=r"must be a .*, not a "):
            READERS[expected](files[kind])


@pytest.mark.parametrize("kind", READERS)
def test_every_flipped_byte_and_every_cut_is_noticed(files, kind, tmp_path):
    content = files[kind].read_bytes()
    path = tmp_path / "spoiled.nc"
    for index in range(0, len(content) - 100, max(1, len(content) // 50)):
        path.write_bytes(content[:index] + bytes([content[index] ^ 0x10]) + content[index + 1 :])
        with pytest.raises(DamagedError), opened(path):
            pass
        path.write_bytes(content[:index])
        with pytest.raises(InputError), opened(path):
            pass


def test_a_file_that_claims_to_be_huge_is_refused_before_it_is_read(tmp_path):
    with netCDF4.Dataset(tmp_path / "huge.nc", "w") as file:
        file.createDimension("x", 10**12)
        file.createVariable("x", "f8", ("x",), chunksizes=(1000,))
    assert (tmp_path / "huge.nc").stat().st_size < 100_000
    with pytest.raises(InputError, match=r"size of .*huge\.nc = 8e\+12 bytes: must be at most"):
        read_netcdf(tmp_path / "huge.nc")


def write_damaged(files, path):
    """Write a point whose checksum proves a changed byte, and return its path."""
    content = bytearray(files["point"].read_bytes())
    content[len(content) // 2] ^= 0x10
    path.write_bytes(content)
    return path


def test_a_workflow_puts_a_damaged_point_aside(files, tmp_path, capsys):
    path = write_damaged(files, tmp_path / "seed1.nc")
    command = ["reduce", str(path), "-o", str(tmp_path / "all.nc"), "--put-aside"]
    assert main(command) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert f"{path}" in line and "seed1.nc.damaged: run the same command again" in line
    assert sorted(file.name for file in tmp_path.iterdir()) == ["seed1.nc.damaged"]


def foreign(files, path):
    """Write a dataset of another program."""
    with netCDF4.Dataset(path, "w") as file:
        file.createDimension("x", 3)


def cut_off(files, path):
    path.write_bytes(files["point"].read_bytes()[:-200])


def no_file(files, path):
    """Make a folder in place of a file."""
    path.mkdir()


@pytest.mark.parametrize("spoil", [foreign, cut_off, no_file])
@pytest.mark.parametrize("options", [[], ["--put-aside"]])
def test_nothing_is_renamed_without_a_checksum_that_proves_the_damage(
    files, tmp_path, capsys, options, spoil
):
    path = tmp_path / "seed1.nc"
    spoil(files, path)
    assert main(["reduce", str(path), "-o", str(tmp_path / "all.nc"), *options]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1
    assert [file.name for file in tmp_path.iterdir()] == ["seed1.nc"]


def test_outside_a_workflow_nothing_is_renamed(files, tmp_path, capsys):
    path = write_damaged(files, tmp_path / "seed1.nc")
    assert main(["reduce", str(path), "-o", str(tmp_path / "all.nc")]) == 2
    assert "it is damaged" in capsys.readouterr().err
    assert path.exists()


@pytest.fixture
def holder(files, tmp_path):
    """A point, and the process that holds it open for writing, as an editor of netCDF does."""
    path = tmp_path / "seed1.nc"
    shutil.copyfile(files["point"], path)
    code = "import netCDF4, sys; f = netCDF4.Dataset(sys.argv[1], 'r+'); print(); input()"
    pipe = subprocess.PIPE
    command = [sys.executable, "-c", code, str(path)]
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True) as process:
        process.stdout.readline()
        yield path, process.pid
        process.kill()


@pytest.mark.parametrize("options", [[], ["--put-aside"]])
def test_a_point_that_is_locked_is_read(files, tmp_path, options):
    """Reading takes no lock, which a disk without locks would refuse, too."""
    path, output = tmp_path / "seed1.nc", tmp_path / "all.nc"
    shutil.copyfile(files["point"], path)
    with path.open("r+b") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        assert read_point(path).equals(read_point(files["point"]))
        assert main(["reduce", str(path), "-o", str(output), *options]) == 0
    assert sorted(file.name for file in tmp_path.iterdir()) == ["all.nc", "seed1.nc"]


@pytest.mark.skipif(not Path("/proc/locks").exists(), reason="locks are listed on Linux")
def test_a_point_that_another_process_may_be_writing_is_left_alone(holder, tmp_path, capsys):
    """HDF5 changes a file as soon as it opens it for writing."""
    path, process = holder
    assert main(["reduce", str(path), "-o", str(tmp_path / "all.nc"), "--put-aside"]) == 2
    assert f"process {process} holds it" in capsys.readouterr().err
    assert [file.name for file in tmp_path.iterdir()] == ["seed1.nc"]


def test_a_dataset_without_the_settings_of_its_summary_is_refused(files, tmp_path, capsys):
    unquoted = tmp_path / "task.nc"
    shutil.copyfile(files["point"].with_name("task.nc"), unquoted)
    with netCDF4.Dataset(unquoted, "a") as file:
        file.delncattr("settings_json")
    assert main(["show", str(unquoted)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "attribute settings_json of" in line and line.endswith("must be given")


@pytest.mark.parametrize(("name", "value"), [("R", math.nan), ("R", -0.1), ("E_trans", math.inf)])
@pytest.mark.parametrize(
    "command", ["table {} -o out.csv", f"figure {PAPER} fig2a {{}} --shows sheared -o out.png"]
)
def test_nothing_is_made_of_a_reduced_dataset_with_an_impossible_number(
    tmp_path, capsys, monkeypatch, command, name, value
):
    monkeypatch.chdir(tmp_path)
    data = reduced("sheared")
    data[name][1, 3] = value
    data.to_netcdf("sheared.nc")
    assert main(command.format("sheared.nc").split()) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert f"{name} of sheared.nc = {value}: must lie in" in line
    assert [file.name for file in tmp_path.iterdir()] == ["sheared.nc"]


def test_grid_points_without_seeds_need_no_numbers(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    data = reduced("sheared")
    data["n_seeds"][1, 3], data["R"][1, 3] = 0, math.nan
    data.to_netcdf("sheared.nc")
    assert main(["table", "sheared.nc", "-o", "out.csv"]) == 0


def test_a_file_that_hdf5_reads_for_ever_is_given_up(files, monkeypatch):
    """HDF5 follows some chains of damaged blocks in a circle."""
    never = threading.Event()
    monkeypatch.setattr(netCDF4, "Dataset", lambda *_, **__: never.wait())
    monkeypatch.setattr("roughgas.data.netcdf.OPENING_TIMEOUT", 0.1)
    with pytest.raises(
        InputError, match=r"must be a dataset of roughgas: HDF5 reads it for 0\.1 s"
    ):
        read_point(files["point"])
    never.set()


def test_a_file_with_unreadable_attributes_is_no_dataset(files, monkeypatch):
    """netCDF reads them late, and has an AttributeError for them."""

    def fail(file):
        raise AttributeError("NetCDF: Can't open HDF5 attribute")

    monkeypatch.setattr("roughgas.data.netcdf.attributes_of", fail)
    with pytest.raises(InputError, match="be a dataset of roughgas: it is of another program, or"):
        read_point(files["point"])


def write_edited(files, kind, path, edit):
    """Write an edited dataset with its new checksum."""
    shutil.copyfile(files[kind], path)
    with netCDF4.Dataset(path, "a") as file:
        edit(file)
    append_checksum(path)


@pytest.mark.parametrize("kind", READERS)
def test_a_dataset_that_cannot_be_decoded_is_refused(files, tmp_path, kind):
    def edit(file):
        group = next(iter(file.groups.values()), file)
        next(iter(group.variables.values())).setncattr("scale_factor", "x")

    write_edited(files, kind, tmp_path / "file.nc", edit)
    with pytest.raises(InputError, match=r"file\.nc: must hold what can be decoded: "):
        READERS[kind](tmp_path / "file.nc")


def test_a_fault_over_an_intact_dataset_states_its_location(files, tmp_path, capsys):
    path = tmp_path / "studies.nc"
    write_edited(files, "studies", path, lambda file: file["coverage"].delncattr("title"))
    outputs = [f"--{ending}={tmp_path / ending}" for ending in ("json", "markdown")]
    assert main(["claims", str(PAPER), str(path), "--title", "a", *outputs]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "as it wrote it: KeyError: 'title' (__init__.py:" in line
    assert line.endswith("; if it does, report this line)")
    assert [entry.name for entry in tmp_path.iterdir()] == ["studies.nc"]


def test_errors_of_any_type_over_a_dataset_end_in_one_line(files, monkeypatch, capsys):
    """Such as errors of pandas, over an axis with a duplicate value."""

    class InvalidIndexError(Exception):
        pass

    def fail(*_):
        raise InvalidIndexError("twice")

    monkeypatch.setattr("roughgas.cli.show.print_summaries", fail)
    assert main(["show", str(files["reduced"])]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "InvalidIndexError: twice (test_opening.py:" in line


def test_a_fault_without_a_dataset_shows_its_trace(monkeypatch):
    monkeypatch.setattr("roughgas.cli.experiments.print_experiments", lambda *_: {}["x"])
    with pytest.raises(KeyError):
        main(["experiments"])


@pytest.mark.parametrize("name", ["R", "n_seeds"])
def test_numbers_that_are_text_are_refused(tmp_path, name):
    data = reduced("sheared")
    data[name].astype(str).to_dataset().to_netcdf(tmp_path / "sheared.nc")
    data.drop_vars(name).to_netcdf(tmp_path / "sheared.nc", mode="a")
    with pytest.raises(InputError, match=rf"^{name} of .* = of type .*: must be real numbers"):
        read_reduced(tmp_path / "sheared.nc")
