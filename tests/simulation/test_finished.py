"""Points that a command finished before it was killed are not made again."""

import json
import os
import signal
import time
from pathlib import Path

import pytest
from brute_force import settings
from raw import run_point
from schedules import TINY
from tests.entry import main
from tests.simulation.test_kills import PATIENCE, begun, content, ended, kill, names_in

from roughgas.base import CollapseError

OUTPUTS = ["1.nc", "2.nc", "3.nc"]
POINT = ["gas", "--r=0.9", "--beta=0.5"]
LONG = settings("heated", 60, [40, 40]) | {
    "schedule": {"kind": "steady", "equilibrate": 50, "measure": 2000, "sample_every": 0.5}
}


def run(*options, settings=TINY, outputs=OUTPUTS):
    """Run a command that makes a point per output, and return its status."""
    seeds = [str(number) for number, _ in enumerate(outputs, start=1)]
    arguments = [*POINT, "--seed", *seeds, *options]
    return main(["run", *arguments, "--settings", json.dumps(settings), "-o", *outputs])


def finished_files(folder):
    """Paths of the finished points stored in a folder, without drafts."""
    return sorted(path for path in folder.glob("*.finished.*") if path.suffix != ".tmp")


def test_a_point_that_is_finished_when_a_block_is_killed_is_not_made_again(tmp_path, monkeypatch):
    undisturbed, folder = tmp_path / "whole", tmp_path / "killed"
    for directory in (undisturbed, folder):
        directory.mkdir()
    monkeypatch.chdir(undisturbed)
    assert run(settings=LONG) == 0 and names_in(undisturbed) == OUTPUTS
    child = begun(lambda: run(settings=LONG), folder)
    deadline = time.monotonic() + PATIENCE
    while not finished_files(folder) and time.monotonic() < deadline:
        time.sleep(0.001)
    assert kill(child) == signal.SIGKILL and not (folder / "3.nc").exists()
    first = (folder / "1.nc").read_bytes()
    for name in OUTPUTS:  # as Snakemake does
        (folder / name).unlink(missing_ok=True)
    stored = finished_files(folder)[0]
    inode, begin = stored.stat().st_ino, time.time()
    assert ended(begun(lambda: run(settings=LONG), folder), PATIENCE) == 0
    assert names_in(folder) == OUTPUTS
    assert (folder / "1.nc").read_bytes() == first and (folder / "1.nc").stat().st_ino == inode
    assert (folder / "1.nc").stat().st_mtime >= begin - 1
    for name in OUTPUTS:
        assert content(folder / name) == content(undisturbed / name)
    output = Path(f"{folder}.said").read_text()
    assert f"1.nc is finished: it was kept in {stored.name}\n" in output
    assert "afresh" not in output and "Traceback" not in output


@pytest.fixture
def simulated(monkeypatch, tmp_path):
    """Simulate in an empty folder and record the seeds of points; `stop`, unless None, is raised at
    the second point."""
    monkeypatch.chdir(tmp_path)
    seeds = []

    def noted(scene, experiment, seed, *arguments):
        if seed == 2 and noted.stop:
            raise noted.stop
        seeds.append(seed)
        return run_point(scene, experiment, seed, *arguments)

    noted.stop = KeyboardInterrupt()
    noted.seeds = seeds
    monkeypatch.setattr("roughgas.simulation.run_points.run_point", noted)
    return noted


def finished_names():
    """Names of the finished points stored in the working folder."""
    return [*map(str, finished_files(Path()))]


@pytest.mark.parametrize("links", [True, False])
@pytest.mark.parametrize("delete", [True, False])
def test_points_finished_before_ctrl_c_are_used_with_and_without_hard_links(
    simulated, capsys, monkeypatch, links, delete
):
    if not links:

        def refused(source, target):
            raise OSError(95, "Operation not supported", source)

        monkeypatch.setattr(os, "link", refused)
    assert run() == 130
    message = "roughgas: stopped: 1 of 3 points are kept; the same command makes the others\n"
    assert capsys.readouterr().err.endswith(message)
    assert len(finished_names()) == 1 and os.stat("1.nc").st_nlink == 1 + links
    first = Path("1.nc").read_bytes()
    if delete:
        os.remove("1.nc")
    assert run() == 130 and simulated.seeds == [1]
    simulated.stop = None
    capsys.readouterr()
    assert run("--json") == 0 and simulated.seeds == [1, 2, 3]
    lines = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert names_in(Path()) == OUTPUTS and Path("1.nc").read_bytes() == first
    again = [f"again{name}" for name in OUTPUTS]
    assert run("--json", outputs=again) == 0
    for summary, line in zip(lines, capsys.readouterr().out.splitlines(), strict=True):
        repeated = json.loads(line) | {name: summary[name] for name in ("file", "kernel_seconds")}
        assert summary == repeated
    for name in OUTPUTS:
        (values, attributes), (values_again, attributes_again) = (
            content(name),
            content(f"again{name}"),
        )
        attributes_again["command"] = attributes_again["command"].replace("again", "")
        assert values == values_again and attributes == attributes_again


def flipped(path):
    """Flip a byte."""
    bytes_ = bytearray(path.read_bytes())
    bytes_[len(bytes_) // 2] ^= 1
    path.write_bytes(bytes_)


def cut(path):
    """Truncate a file."""
    path.write_bytes(path.read_bytes()[:1000])


def unsealed(path):
    """Remove the checksum of a file."""
    content = path.read_bytes()
    path.write_bytes(content[: content.rfind(b"\nroughgas sha256")])


@pytest.mark.parametrize("damage", [flipped, cut, unsealed])
def test_damaged_points_are_made_again(simulated, capsys, damage):
    assert run() == 130
    os.remove("1.nc")
    (path,) = map(Path, finished_names())
    damage(path)
    simulated.stop = None
    capsys.readouterr()
    assert run() == 0 and simulated.seeds == [1, 1, 2, 3] and names_in(Path()) == OUTPUTS
    messages = capsys.readouterr().err.splitlines()
    assert messages[0] == f"{path} is damaged: starting afresh" and len(messages) == 4


@pytest.mark.parametrize(
    "changes",
    [
        {"settings": TINY | {"particles": 6}},
        {"options": ["--scale=small"]},
        {"options": ["--keep-state"]},
        {"options": ["--set=particles=4"]},
    ],
)
def test_points_of_another_command_are_removed(simulated, capsys, changes):
    assert run() == 130
    (path,) = finished_names()
    simulated.stop = None
    capsys.readouterr()
    assert run(*changes.get("options", ()), settings=changes.get("settings", TINY)) == 0
    assert simulated.seeds == [1, 1, 2, 3] and names_in(Path()) == OUTPUTS
    messages = capsys.readouterr().err.splitlines()
    assert messages[0] == f"{path} belongs to other settings or to other sources: starting afresh"
    assert len(messages) == 4


def test_other_sources_make_points_again(simulated, monkeypatch):
    assert run() == 130
    simulated.stop = None
    monkeypatch.setattr("roughgas.simulation.run_points._sources", lambda *rooms: rooms)
    assert run() == 0 and simulated.seeds == [1, 1, 2, 3] and names_in(Path()) == OUTPUTS


def test_a_point_that_fails_leaves_what_is_finished(simulated):
    simulated.stop = CollapseError("inelastic collapse")
    assert run() == 1 and len(finished_names()) == 1
    assert run() == 1 and simulated.seeds == [1]


def test_a_single_point_is_not_kept(simulated, monkeypatch):
    monkeypatch.setattr(os, "link", pytest.fail)
    assert run(outputs=["1.nc"]) == 0 and names_in(Path()) == ["1.nc"]


def test_a_folder_in_place_of_a_finished_point_is_refused(simulated, capsys):
    os.mkdir("1.nc.finished.here")
    assert run() == 2
    message = "roughgas: error: finished point = 1.nc.finished.here: must be a file\n"
    assert capsys.readouterr().err == message


def test_a_point_that_cannot_be_stored_is_made_nevertheless(simulated, capsys, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    simulated.stop = None
    monkeypatch.setattr("roughgas.simulation.finished_points._link", full)
    assert run() == 0 and names_in(Path()) == OUTPUTS
    message = capsys.readouterr().err
    assert message.count(" cannot be kept for another run: No space left on device\n") == 3
