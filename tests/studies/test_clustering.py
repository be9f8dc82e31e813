"""The film of a cooling gas: what it shows, and that an interruption cannot be seen in it."""

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
from tests.houses import ROOT, part, quietly
from tests.show.figures.legibility import faults

from roughgas import theory
from roughgas.config import as_text, experiment, load
from roughgas.data.netcdf import read_groups

FOLDER = ROOT / "studies" / "clustering"
SETTINGS = {"r": "0.9", "beta": "0.2", "seed": 3, "thermalise": 5, "collisions": 60, "frames": 12}
SETTINGS |= {"cell": 5, "window": 30}
tasks, results, figure, movie = (
    part("clustering", name) for name in ("tasks", "results", "figure", "movie")
)


@pytest.fixture(scope="module")
def gas():
    found = experiment(load(ROOT / "config.yaml"), "clustering.gas", "small")
    effects = {"spin": {"inertia": 0.5}}
    return found | {"particles": 100, "box": [40.0, 50.0], "effects": effects}


def filmed(gas, path, every=5, **others):
    """The film of a run that keeps checkpoints at `path`."""
    tasks.EVERY = every
    settings = SETTINGS | others
    return tasks.run("film", settings, {"gas": gas}, quietly, (path, f"{settings}"))


@pytest.fixture(scope="module")
def undisturbed(gas, tmp_path_factory):
    folder = tmp_path_factory.mktemp("undisturbed")
    film = filmed(gas, folder / "c.npz", every=10**6)
    assert list(folder.iterdir()) == []
    return film


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


def test_disks_are_in_the_window_and_do_not_overlap(undisturbed, gas, tmp_path):
    assert undisturbed.disks.values.sum() == undisturbed.sizes["disk"]
    for frame in range(13):
        x, y, _ = (one.astype(float) for one in figure._disks(undisturbed, frame))
        assert 20 < len(x) < 100
        assert np.all(abs(x - 20) < 16) and np.all(abs(y - 25) < 16)
        distance = np.hypot(x[:, None] - x, y[:, None] - y) + 9.0 * np.eye(len(x))
        assert distance.min() > 2.0 - 1e-5
    film = filmed(gas, tmp_path / "c.npz", window=60, frames=2, collisions=4)
    assert list(film.disks.values) == [100, 100, 100]
    spins = film.disk_spin.values.reshape(3, 100)
    assert np.mean(spins[1:] ** 2, axis=1) == pytest.approx(1.0)


@pytest.mark.slow
def test_a_killed_step_goes_on_from_its_checkpoint_with_the_same_bits(gas, tmp_path, capsys):
    settings = SETTINGS | {"frames": 1000, "collisions": 100}
    settings = as_text({"study": settings, "experiments": {"gas": gas}})
    whole, killed = tmp_path / "whole.nc", tmp_path / "killed.nc"
    saved = tmp_path / "killed.nc.checkpoint.npz"
    step = ["study_task", str(FOLDER), "film", "--settings", settings, "-o"]
    assert main([*step, str(whole)]) == 0
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
    one, other = map(xr.load_dataset, (whole, killed))
    assert one.drop_vars("kernel_seconds").identical(other.drop_vars("kernel_seconds"))
    assert {path.name for path in tmp_path.iterdir()} == {"whole.nc", "killed.nc"}
    combined, table = tmp_path / "data.nc", tmp_path / "data.md"
    told = ["-o", str(combined), "--table", str(table)]
    assert main(["study_data", str(FOLDER), str(whole), *told]) == 0
    film = read_groups(combined)["clustering"]
    assert film["count"].dtype == np.uint16 and film.disk_x.dtype == np.float32
    assert all(one.attrs["long_name"] for one in film.variables.values())
    assert "## A cooling gas of 100 disks" in table.read_text()


# ---------------------------------------------------------------- the picture and the movie

FRAMES, CELLS, SIDE, PER_CELL = 5, 30, 120.0, 3
BLOB = 21, 9  # (x, y) cell in which everything ends up


@pytest.fixture(scope="module")
def film():
    """A film that follows theory, but for one dense spot on its last map."""
    rng, passed = np.random.default_rng(1), np.linspace(0.0, 40.0, FRAMES)
    haff = theory.relax(0.0, 0.8, 0.0, passed, 2, 0.5)
    count = np.full((FRAMES, CELLS, CELLS), PER_CELL)
    count[-1, BLOB[1], BLOB[0]] = 40
    disks = np.arange(3, 3 + FRAMES)
    middles = (np.arange(CELLS) + 0.5) * SIDE / CELLS
    found = {"x": middles, "y": middles, "time": passed**2, "collisions_per_particle": passed}
    found |= {"E_trans": haff.T_tr, "E_rot": haff.T_rot, "R": haff.theta / (1 + haff.theta)}
    found |= {"count": count, "disks": disks, "disk_spin": rng.standard_normal(disks.sum())}
    found |= {name: rng.uniform(10, 110, disks.sum()) for name in ("disk_x", "disk_y")}
    about = {"particles": PER_CELL * CELLS**2, "r": 0.8, "beta": 0.0, "inertia": 0.5}
    about |= {"packing": np.pi * PER_CELL * CELLS**2 / SIDE**2, "box": [SIDE, SIDE]}
    columns = {name: (tasks.DIMS[name], values) for name, values in found.items()}
    return xr.Dataset(columns, attrs=about | {"window": 100.0})


def panels(film):
    return {axes.get_title(loc="left")[:1]: axes for axes in figure.draw(film).axes}


@pytest.mark.slow
def test_the_movie_is_drawn(film, tmp_path, monkeypatch):
    monkeypatch.setattr(movie, "LAST_FRAME", 0.1)  # or it is drawn 18 times
    movie.draw(film, tmp_path / "c.mp4")
    assert (tmp_path / "c.mp4").read_bytes()[4:8] == b"ftyp"


def test_the_picture_can_be_read_and_says_how_long_lengths_are(film):
    assert faults(lambda: figure.draw(film)) == []
    bars = [one.size_bar for one in figure.draw(film).findobj(AnchoredSizeBar)]
    assert len(bars) == 4 and {bar.get_children()[0].get_width() for bar in bars} == {20.0}
    (disks,) = panels(film)["d"].collections
    assert np.all(disks.get_widths() == 2.0) and len(disks.get_offsets()) == 7
