"""Movies and the showcase as Snakemake makes them, and what a kill costs."""

import os
import signal
import time

import pytest
from PIL import Image

from roughgas.data.film import read_film
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


FILM = "results/tiny/showcase/clustering.nc"
CHECKPOINT = f"{FILM}.checkpoint.npz"
PRODUCTS = {f"figures/tiny/clustering.{kind}" for kind in ("pdf", "png", "mp4")}
PAGE = "results/tiny/clustering.html"


@pytest.mark.parametrize(
    ("target", "change", "message"),
    [
        ("results/large/showcase/clustering.nc", {}, "scale = 'large': must be one of paper"),
        (FILM, {"box": [3, 3]}, "showcase at scale tiny: box[0] = 3"),
    ],
)
def test_what_cannot_be_filmed_is_refused_in_one_line(project, tmp_path, target, change, message):
    changed = project.copy_to(tmp_path / "copy")
    changed.configure(lambda config: config["scales"]["tiny"]["showcase"].update(change))
    status, output = changed.snakemake("-n", target)
    assert status != 0 and "Traceback" not in output
    (line,) = (line for line in output.splitlines() if "error" in line.lower())
    assert message in line


@pytest.mark.slow
def test_the_products_are_there(project, tmp_path):
    ran = project.copy_to(tmp_path / "ran")
    ran.succeed("-j1", *TINY, "showcase")
    products = {path for path in ran.files() if path.startswith(("figures", "results"))}
    assert products == PRODUCTS | {FILM, PAGE}
    assert "Nothing to be done" in ran.succeed("-j1", *TINY, "showcase")


@pytest.mark.slow
def test_after_a_kill_the_same_command_goes_on_from_the_checkpoint(project, tmp_path):
    whole = project.copy_to(tmp_path / "whole")
    long = {"frames": 3000, "collisions": 300}
    whole.configure(lambda config: config["scales"]["tiny"]["showcase"].update(long))
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
    log = (killed.folder / "logs/tiny/showcase/clustering.log").read_text()
    assert log.startswith(f"clustering: going on from {CHECKPOINT}\n")
    one, other = (read_film(ran.folder / FILM) for ran in (whole, killed))
    assert one.drop_vars("kernel_seconds").identical(other.drop_vars("kernel_seconds"))
    assert not (killed.folder / CHECKPOINT).exists()
