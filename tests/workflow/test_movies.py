"""Movies and the film of a large gas as Snakemake makes them."""

import pytest
from PIL import Image

TINY = ("--config", "scale=tiny", "--")


@pytest.mark.slow
def test_a_movie_is_made_with_its_gif(project, tmp_path):
    copy = project.copy_to(tmp_path / "copy")
    committed = copy.folder / "figures/tiny/movies/cooling.gif"
    committed.parent.mkdir(parents=True)
    committed.touch()
    copy.succeed("-j1", *TINY, "figures/tiny/movies/cooling.mp4")
    with Image.open(copy.folder / "figures/tiny/movies/cooling.gif") as image:
        assert image.n_frames == 80 and image.width == 336


PRODUCTS = {f"figures/tiny/clustering.{kind}" for kind in ("pdf", "png", "mp4")}
RESULTS = ("tasks/film.nc", "data.nc", "data.md", "page.html")
PRODUCTS |= {f"results/tiny/clustering/{name}" for name in RESULTS}


@pytest.mark.slow
def test_a_film_of_a_large_gas_has_all_its_products(project, tmp_path):
    ran = project.copy_to(tmp_path / "ran")
    ran.succeed("-j1", *TINY, "clustering")
    products = {path for path in ran.files() if path.startswith(("figures", "results"))}
    assert products == PRODUCTS
    assert "Nothing to be done" in ran.succeed("-j1", *TINY, "clustering")
