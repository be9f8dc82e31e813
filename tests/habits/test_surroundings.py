"""Streams, disks, locales and settings of the user's that are not as expected."""

import os
import subprocess
import sys

from schedules import TINY
from synthetic import reduced

from habits.conftest import environment, point, python, roughgas

HOSTILE_STYLE = "lines.linewidth: 9\naxes.facecolor: red\naxes.grid: True\nfont.size: 30\n"


def test_who_reads_only_the_beginning_sees_no_traceback(tmp_path):
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run(
        [sys.executable, "-m", "roughgas", "experiments"],
        stdout=writer,
        stderr=subprocess.PIPE,
        env=environment(ROUGHGAS_CACHE_DIR=str(tmp_path)),
    )
    os.close(writer)
    assert (done.returncode, done.stderr) == (141, b"")


def test_closed_streams(tmp_path):
    command = [sys.executable, "-m", "roughgas", *point("point.nc")]
    script = 'exec "$@" <&- >&- 2>&-'
    done = subprocess.run(["sh", "-c", script, "sh", *command], cwd=tmp_path, env=environment())
    assert done.returncode == 0
    assert [path.name for path in tmp_path.iterdir()] == ["point.nc"]


def test_no_setting_of_the_users_changes_a_figure(tmp_path):
    data = reduced("sheared")
    data.assign(R_unsubtracted=data.R - 0.1).to_netcdf(tmp_path / "sheared.nc", engine="netcdf4")
    (tmp_path / "home").mkdir()
    (tmp_path / "home" / "matplotlibrc").write_text(HOSTILE_STYLE)
    hostile = {
        "MPLBACKEND": "none such",
        "MPLCONFIGDIR": "/proc/none",
        "DISPLAY": ":99",
        "FONTCONFIG_FILE": "/nonexistent",
        "PATH": "/nonexistent",
        "LC_ALL": "tr_TR.UTF-8",
        "HOME": "/proc/none",
    }
    drawn = []
    for folder, changes in ((tmp_path, {}), (tmp_path / "home", hostile)):
        files = [folder / "fig2a.png", folder / "fig2a.pdf"]
        arguments = ["figure", "fig2a", tmp_path / "sheared.nc", "--output", *files]
        done = python("-m", "roughgas.steps", *arguments, cwd=folder, **changes)
        assert (done.returncode, done.stderr) == (0, "")
        drawn.append([file.read_bytes() for file in files])
    assert drawn[0] == drawn[1]


def test_where_nothing_can_be_written_is_said_at_once(tmp_path, mounts):
    done = roughgas(*point("disk/a/point.nc"), cwd=tmp_path, mount=("ro", "disk"))
    assert done.returncode != 0  # there is no such folder
    (tmp_path / "disk").mkdir()
    done = roughgas(*point("disk/point.nc"), cwd=tmp_path, mount=("ro", "disk"))
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == f"roughgas: error: {tmp_path / 'disk/point.nc'}: cannot be written\n"


def test_a_full_disk_is_said_in_one_line(tmp_path, mounts):
    (tmp_path / "disk").mkdir()
    done = roughgas(*point("disk/point.nc"), cwd=tmp_path, mount=("size=4k", "disk"))
    assert done.returncode == 1 and done.stderr.count("\n") == 1
    assert done.stderr.startswith("roughgas: error: cannot write disk/point.nc")
    assert "is the disk full" in done.stderr


def test_what_is_no_file_is_not_replaced(tmp_path):
    """A device, which root could replace, or here a pipe."""
    os.mkfifo(tmp_path / "pipe")
    done = roughgas(*point("pipe"), cwd=tmp_path)
    assert done.returncode == 1
    assert done.stderr == f"roughgas: error: {tmp_path / 'pipe'}: exists and is not a file\n"
    assert (tmp_path / "pipe").is_fifo()


def test_memory_that_runs_out(tmp_path):
    script = 'ulimit -v 2000000; exec "$@"'
    many = {"particles": 10**8, "box": [10**5, 10**5]}
    command = [sys.executable, "-m", "roughgas", *point("point.nc", TINY | many)]
    done = subprocess.run(
        ["sh", "-c", script, "sh", *command],
        cwd=tmp_path,
        env=environment(),
        capture_output=True,
        text=True,
    )
    assert done.returncode == 1
    said = [line for line in done.stderr.splitlines() if " so far" not in line]  # where it is slow
    assert len(said) == 1 and list(tmp_path.iterdir()) == []
    assert said[0].startswith("roughgas: error: out of memory. Unable to allocate")
