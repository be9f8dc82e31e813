"""Movies as Snakemake makes them: what is asked for, and one made."""

import pytest
from PIL import Image

from roughgas.simulation.snapshots import COOLING

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


def test_movies_need_no_point(project):
    assert project.planned("movies") == {"movie": len(NAMES), "movies": 1}
    assert project.planned(*(f"figures/movies/{name}.gif" for name in NAMES)) == {
        "movie": len(NAMES)
    }
    assert "movie" not in project.planned("figures")


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
