"""The film of a cooling gas: its content, and its continuation after an interruption."""

import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import xarray as xr
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar
from tests.entry import main
from tests.show.figures.legibility import faults
from tests.studies.small_runs import task_run
from tests.studies.small_studies import CLUSTERING
from tests.study_modules import ROOT, module_of_study, quietly

from roughgas import theory
from roughgas.base import sorted_json
from roughgas.data.netcdf import read_groups
from roughgas.tasks.running import Experiments

FOLDER = ROOT / "studies" / "clustering"
SETTINGS, GAS = CLUSTERING.settings, CLUSTERING.experiments["gas"]
tasks, results, figure, movie = (
    module_of_study("clustering", name) for name in ("tasks", "results", "figure", "movie")
)


@pytest.fixture(scope="module")
def undisturbed():
    return task_run("clustering", "film").result


def test_the_frames_are_evenly_spaced_in_collisions(undisturbed):
    assert undisturbed.collisions_per_particle.values == pytest.approx(np.linspace(0, 60, 13))
    assert undisturbed.collisions == 100 / 2 * (5 + 60)
    passed = undisturbed.time.values
    assert passed[0] == 0.0 and np.all(np.diff(np.diff(passed)) > 0.0)  # it slows down


def test_every_particle_is_on_the_map(undisturbed):
    count = undisturbed["count"].values
    assert count.shape == (13, 10, 8) and np.all(count.sum(axis=(1, 2)) == 100)
    assert undisturbed.x.values == pytest.approx(2.5 + 5 * np.arange(8))
    x = np.mod([-1e-20, 3.0], 40.0)
    assert x[0] == 40.0  # rounding folds it onto the far edge
    count = tasks.count(x, np.mod([7.0, -1e-20], 50.0), (40.0, 50.0), 5)
    assert count.sum() == count[1, 7] + count[9, 0] == 2


def test_disks_are_in_the_window_and_do_not_overlap(undisturbed):
    assert undisturbed.disks.values.sum() == undisturbed.sizes["disk"]
    for frame in range(13):
        x, y, _ = (column.astype(float) for column in figure._disks_in_window(undisturbed, frame))
        assert 20 < len(x) < 100
        assert np.all(abs(x - 20) < 16) and np.all(abs(y - 25) < 16)
        distance = np.hypot(x[:, None] - x, y[:, None] - y) + 9.0 * np.eye(len(x))
        assert distance.min() > 2.0 - 1e-5


def test_a_window_wider_than_the_box_has_all_disks(tmp_path):
    """A film of fewer frames than CHECKPOINT_INTERVAL writes no checkpoint."""
    settings = SETTINGS | {"window": 60, "frames": 2, "collisions": 4}
    checkpoint = tmp_path / "c.npz", "film"
    film = tasks.run("film", settings, Experiments({"gas": GAS}), quietly, checkpoint)
    assert list(film.disks.values) == [100, 100, 100] and list(tmp_path.iterdir()) == []
    spins = film.disk_spin.values.reshape(3, 100)
    assert np.mean(spins[1:] ** 2, axis=1) == pytest.approx(1.0)


@pytest.mark.slow
def test_a_killed_step_goes_on_from_its_checkpoint_with_the_same_bits(tmp_path, capsys):
    settings = SETTINGS | {"frames": 1000, "collisions": 100}
    settings = sorted_json({"study": settings, "experiments": {"gas": GAS}})
    uninterrupted, killed = tmp_path / "whole.nc", tmp_path / "killed.nc"
    saved = tmp_path / "killed.nc.checkpoint.npz"
    step = ["task", str(FOLDER), "film", "--settings", settings, "-o"]
    assert main([*step, str(uninterrupted)]) == 0
    process = subprocess.Popen([sys.executable, "-m", "roughgas.steps", *step, str(killed)])
    deadline = time.monotonic() + 300
    while not saved.exists():
        assert process.poll() is None and time.monotonic() < deadline
        time.sleep(0.001)
    os.kill(process.pid, signal.SIGKILL)
    assert process.wait() == -signal.SIGKILL and saved.exists() and not killed.exists()
    capsys.readouterr()
    assert main([*step, str(killed)]) == 0
    assert capsys.readouterr().err.startswith(f"going on from {saved}\n")
    first, second = map(xr.load_dataset, (uninterrupted, killed))
    assert first.drop_vars("kernel_seconds").identical(second.drop_vars("kernel_seconds"))
    assert {path.name for path in tmp_path.iterdir()} == {"whole.nc", "killed.nc"}
    combined, table = tmp_path / "data.nc", tmp_path / "data.md"
    options = ["-o", str(combined), "--table", str(table)]
    assert main(["combine", str(FOLDER), str(uninterrupted), *options]) == 0
    film = read_groups(combined)["clustering"]
    assert film["count"].dtype == np.uint16 and film.disk_x.dtype == np.float32
    assert all(column.attrs["long_name"] for column in film.variables.values())
    assert "## A cooling gas of 100 disks" in table.read_text()


# ---------------------------------------------------------------- the picture and the movie

FRAMES, CELLS, SIDE, PER_CELL = 5, 30, 120.0, 3
BLOB = 21, 9  # (x, y) of the densest cell of the last map


@pytest.fixture(scope="module")
def film():
    """A film on theory, except for one dense spot on its last map."""
    rng, passed = np.random.default_rng(1), np.linspace(0.0, 40.0, FRAMES)
    haff = theory.relax(0.0, 0.8, 0.0, passed, 2, 0.5)
    count = np.full((FRAMES, CELLS, CELLS), PER_CELL)
    count[-1, BLOB[1], BLOB[0]] = 40
    disks = np.arange(3, 3 + FRAMES)
    middles = (np.arange(CELLS) + 0.5) * SIDE / CELLS
    values = {"x": middles, "y": middles, "time": passed**2, "collisions_per_particle": passed}
    values |= {"E_trans": haff.T_tr, "E_rot": haff.T_rot, "R": haff.theta / (1 + haff.theta)}
    values |= {"count": count, "disks": disks, "disk_spin": rng.standard_normal(disks.sum())}
    values |= {name: rng.uniform(10, 110, disks.sum()) for name in ("disk_x", "disk_y")}
    attributes = {"particles": PER_CELL * CELLS**2, "r": 0.8, "beta": 0.0, "inertia": 0.5}
    attributes |= {"packing": np.pi * PER_CELL * CELLS**2 / SIDE**2, "box": [SIDE, SIDE]}
    columns = {name: (tasks.DIMS[name], column) for name, column in values.items()}
    return xr.Dataset(columns, attrs=attributes | {"window": 100.0})


def panels(film):
    return {axes.get_title(loc="left")[:1]: axes for axes in figure.draw(film).axes}


@pytest.mark.slow
def test_the_movie_is_drawn(film, tmp_path, monkeypatch):
    monkeypatch.setattr(movie, "LAST_FRAME", 0.1)  # or it is drawn 18 times
    movie.draw(film, tmp_path / "c.mp4")
    assert (tmp_path / "c.mp4").read_bytes()[4:8] == b"ftyp"


@pytest.mark.slow
def test_the_picture_is_legible_and_has_scale_bars(film):
    assert faults(lambda: figure.draw(film)) == []
    bars = [bar.size_bar for bar in figure.draw(film).findobj(AnchoredSizeBar)]
    assert len(bars) == 4 and {bar.get_children()[0].get_width() for bar in bars} == {20.0}
    (disks,) = panels(film)["d"].collections
    assert np.all(disks.get_widths() == 2.0) and len(disks.get_offsets()) == 7
