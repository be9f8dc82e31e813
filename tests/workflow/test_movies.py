"""Movies and the film of a large gas as Snakemake makes them, and what a kill costs."""

import os
import signal
import time

import pytest
import xarray as xr
from PIL import Image

from roughgas.simulation.trajectory import COOLING

NAMES = (
    "vibrated",
    "roughness",
    "sheared",
    "cooling",
    "rough_walls",
    "drives",
    "mixtures",
    "spheres",
)
TINY = ("--config", "scale=tiny", "--")


def test_an_unknown_movie_is_refused_in_one_line(project):
    status, output = project.snakemake("-j1", "figures/movies/flow.gif")
    assert status != 0
    assert f"roughgas: error: movie = flow: must be one of {', '.join(NAMES)}" in output


@pytest.mark.slow
def test_one_is_made(project, tmp_path):
    copy = project.copy_to(tmp_path / "copy")
    copy.succeed("-j1", *TINY, "figures/tiny/movies/cooling.gif")
    with Image.open(copy.folder / "figures/tiny/movies/cooling.gif") as image:
        assert image.n_frames == COOLING.frames and image.width == 480


FILM = "results/tiny/clustering/tasks/film.nc"
CHECKPOINT = f"{FILM}.checkpoint.npz"
PRODUCTS = {f"figures/tiny/clustering.{kind}" for kind in ("pdf", "png", "mp4")}
PRODUCTS |= {
    FILM,
    *(f"results/tiny/clustering/{one}" for one in ("data.nc", "data.md", "page.html")),
}


@pytest.mark.slow
def test_the_products_are_there(project, tmp_path):
    ran = project.copy_to(tmp_path / "ran")
    ran.succeed("-j1", *TINY, "clustering")
    products = {path for path in ran.files() if path.startswith(("figures", "results"))}
    assert products == PRODUCTS
    assert "Nothing to be done" in ran.succeed("-j1", *TINY, "clustering")


@pytest.mark.slow
def test_after_a_kill_the_same_command_goes_on_from_the_checkpoint(project, tmp_path):
    whole = project.copy_to(tmp_path / "whole")
    long = {"frames": 3000, "collisions": 300}
    whole.configure(lambda config: config["scales"]["tiny"]["clustering.tasks"].update(long))
    killed = whole.copy_to(tmp_path / "killed")
    whole.succeed("-j1", *TINY, FILM)
    running = killed.start("-j1", *TINY, FILM)
    deadline = time.monotonic() + 300
    while not (killed.folder / CHECKPOINT).exists():
        assert running.poll() is None and time.monotonic() < deadline
        time.sleep(0.001)
    os.killpg(running.pid, signal.SIGKILL)  # its jobs, too
    running.wait()
    assert not (killed.folder / FILM).exists() and (killed.folder / CHECKPOINT).exists()
    killed.succeed("-j1", *TINY, FILM)
    log = (killed.folder / "logs/tiny/clustering/tasks/film.log").read_text()
    assert log.startswith(f"going on from {CHECKPOINT}\n")
    one, other = (xr.load_dataset(ran.folder / FILM) for ran in (whole, killed))
    assert one.drop_vars("kernel_seconds").identical(other.drop_vars("kernel_seconds"))
    assert not (killed.folder / CHECKPOINT).exists()
