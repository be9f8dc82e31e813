"""The workflow as it is really run: twice, in another order, killed, and a large sweep."""

import json
import os
import shlex
import subprocess
import sys
import time
import zipfile

import pytest
from bits import digest
from project import POINTS, SWEEP
from rocrate.rocrate import ROCrate

from roughgas.data.point import WALL_CLOCK, read_point

pytestmark = pytest.mark.slow
TARGET = ("--config", "scale=tiny", "--", "figures")


@pytest.fixture(scope="module")
def undisturbed(project, tmp_path_factory):
    ran = project.copy_to(tmp_path_factory.mktemp("runs") / "undisturbed")
    ran.succeed("-j2", *TARGET)
    return ran


def points(project):
    return sorted(project.folder.glob("results/tiny/*/*/*/*.nc"))


def same_numbers(first, second):
    """Return whether two files of points are equal to the last bit, apart from run times."""
    first, second = read_point(first), read_point(second)
    return first.drop_vars(WALL_CLOCK, errors="ignore").identical(
        second.drop_vars(WALL_CLOCK, errors="ignore")
    )


def test_a_run_makes_all_products_of_the_paper(undisturbed):
    assert len(points(undisturbed)) == POINTS
    products = {path for path in undisturbed.files() if path.startswith(("figures", "results"))}
    for figure in ("fig1a", "fig1b", "fig2a", "fig2b"):
        assert {f"figures/tiny/{figure}.pdf", f"figures/tiny/{figure}.png"} <= products
    for name in ("R.csv", "claims.json", "claims.md", "vibrated.nc", "sheared.nc", "cooling.nc"):
        assert f"results/tiny/{name}" in products
    assert not any(path.endswith(".tmp") for path in products)


def test_a_point_is_the_same_when_it_is_run_alone(undisturbed, tmp_path):
    path = undisturbed.folder / "results/tiny/cooling/r0.9/beta0/seed2.nc"
    program, *arguments = shlex.split(read_point(path).attrs["command"])
    assert program == "roughgas" and "--seed=2" in arguments
    arguments[-1] = str(tmp_path / "alone.nc")
    subprocess.run([sys.executable, "-m", "roughgas", *arguments], check=True)
    assert digest(path) == digest(tmp_path / "alone.nc")


def test_a_run_is_packed_with_all_that_it_takes_to_repeat_it(undisturbed, tmp_path):
    packed = undisturbed.copy_to(tmp_path / "packed")
    packed.succeed("-j1", "--config", "scale=tiny", "--", "crate")
    with zipfile.ZipFile(packed.folder / "results/tiny/crate.zip") as archive:
        archive.extractall(tmp_path / "crate")
    results = {file.id for file in ROCrate(tmp_path / "crate").dereference("#run")["result"]}
    assert {"results/tiny/R.csv", "results/tiny/claims.md", "figures/tiny/fig1a.png"} <= results
    configuration = json.loads((tmp_path / "crate/configuration.json").read_text())
    assert configuration["scale"] == "tiny" and configuration["scales"]["tiny"]
    # the contents of the crate alone reproduce a point
    point = points(undisturbed)[0]
    command = [sys.executable, "-m", *shlex.split(read_point(point).attrs["command"])]
    command[-1] = "point.nc"
    sources = {"PYTHONPATH": str(tmp_path / "crate/src")}
    subprocess.run(command, cwd=tmp_path, env=os.environ | sources, check=True)
    assert digest(point) == digest(tmp_path / "point.nc")


def test_after_a_kill_the_same_command_ends_with_the_same_numbers(project, undisturbed, tmp_path):
    killed = project.copy_to(tmp_path / "killed")
    running = killed.start("-j2", *TARGET)
    deadline = time.monotonic() + 300
    while len(points(killed)) < POINTS // 3 and running.poll() is None:
        assert time.monotonic() < deadline
        time.sleep(0.01)
    running.kill()
    running.wait()
    write_times = {path: path.stat().st_mtime_ns for path in points(killed)}
    assert 0 < len(write_times) < POINTS
    killed.succeed("-j1", *TARGET)
    unchanged = [path for path, when in write_times.items() if path.stat().st_mtime_ns == when]
    remade_limit = 2 * 2 * SWEEP["seeds"]  # two jobs at work, and two that may have finished since
    assert len(unchanged) >= len(write_times) - remade_limit
    for path in points(undisturbed):
        remade = killed.folder / path.relative_to(undisturbed.folder)
        assert same_numbers(path, remade), path
    assert "Nothing to be done" in killed.succeed("-j2", *TARGET)
