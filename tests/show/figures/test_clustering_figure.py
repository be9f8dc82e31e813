"""The picture and the movie of a film that is known beforehand."""

import numpy as np
import pytest
from matplotlib.image import imread
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar
from tests.entry import main
from tests.show.figures.legibility import faults

from roughgas import theory
from roughgas.base import InputError
from roughgas.data.film import FILM, read_film, write_film
from roughgas.show.figures import clustering

FRAMES, CELLS, SIDE, PER_CELL = 5, 30, 120.0, 3
BLOB = 21, 9  # (x, y) cell in which everything ends up
ATTRIBUTES = {
    "particles": PER_CELL * CELLS**2,
    "r": 0.8,
    "beta": 0.0,
    "inertia": 0.5,
    "packing": np.pi * PER_CELL * CELLS**2 / SIDE**2,
    "box": [SIDE, SIDE],
    "window": 100.0,
}


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """A film that follows theory, but for one dense spot on its last map."""
    rng = np.random.default_rng(1)
    passed = np.linspace(0.0, 40.0, FRAMES)
    haff = theory.relax(0.0, 0.8, 0.0, passed, 2, 0.5)
    count = np.full((FRAMES, CELLS, CELLS), PER_CELL)
    count[-1, BLOB[1], BLOB[0]] = 40
    disks = np.arange(3, 3 + FRAMES)
    middles = (np.arange(CELLS) + 0.5) * SIDE / CELLS
    variables = dict.fromkeys(FILM, 0.0) | {
        "x": middles,
        "y": middles,
        "time": passed**2,
        "collisions_per_particle": passed,
        "E_trans": haff.T_tr,
        "E_rot": haff.T_rot,
        "R": haff.theta / (1 + haff.theta),
        "count": count,
        "disks": disks,
        "disk_x": rng.uniform(10, 110, disks.sum()),
        "disk_y": rng.uniform(10, 110, disks.sum()),
        "disk_spin": rng.standard_normal(disks.sum()),
    }
    path = tmp_path_factory.mktemp("film") / "film.nc"
    write_film(path, variables, ATTRIBUTES)
    return path


def panels(figure):
    """Axes by the first letter of their title."""
    return {axes.get_title(loc="left")[:1]: axes for axes in figure.axes}


def test_the_picture_and_the_movie_are_drawn_the_same_each_time(path, tmp_path, monkeypatch):
    monkeypatch.setattr(clustering, "LAST_FRAME", 0.1)  # or it is drawn 18 times
    image, document, movie = outputs = [
        tmp_path / "figures" / f"c.{kind}" for kind in ("png", "pdf", "mp4")
    ]
    image.parent.mkdir()
    assert main(["film", str(path), "--output", *map(str, outputs)]) == 0
    assert set((tmp_path / "figures").iterdir()) == set(outputs)
    assert movie.read_bytes()[4:8] == b"ftyp" and movie.stat().st_size > 10_000
    assert document.read_bytes().startswith(b"%PDF")
    assert imread(image).shape[0] > 800 and imread(image).std() > 0.05
    clustering.draw(path, [tmp_path / "again.png"])
    assert (tmp_path / "again.png").read_bytes() == image.read_bytes()


def test_smoothing_keeps_the_particles(path):
    film = read_film(path)
    even, uneven = clustering.packing(film, 0), clustering.packing(film, -1)
    cell = (SIDE / CELLS) ** 2
    assert even == pytest.approx(np.full_like(even, np.pi * PER_CELL / cell))
    added = uneven - even
    assert added.sum() * cell == pytest.approx(np.pi * 37)
    assert np.unravel_index(added.argmax(), added.shape) == (BLOB[1], BLOB[0])
    spread = SIDE / CELLS * (np.arange(CELLS) - BLOB[0])
    assert (added.sum(0) @ spread**2) / added.sum() == pytest.approx(36, rel=0.1)


def test_the_square_lies_where_the_gas_is_densest_within_the_window(path):
    film = read_film(path)
    left, bottom, side = clustering.closeup(film)
    assert side == 100.0 and (left, bottom) == (10.0, 10.0)  # no room to choose
    film.attrs["window"] = 500.0
    assert clustering.closeup(film) == (0.0, 0.0, 120.0)


def test_a_gas_that_stays_homogeneous_lies_on_the_line_of_theory(path):
    drawn = panels(clustering.picture(read_film(path)))
    assert set("abcdefg") <= set(drawn)
    for letter, data, line in (("e", 0, 2), ("e", 1, 3), ("f", 0, 1)):
        x, y = drawn[letter].lines[data].get_data()
        theory_x, theory_y = drawn[letter].lines[line].get_data()
        assert np.interp(x, theory_x, theory_y) == pytest.approx(y, rel=1e-3), letter


def test_the_picture_can_be_read_and_says_how_long_lengths_are(path):
    film = read_film(path)
    assert faults(lambda: clustering.picture(film)) == []
    bars = [one.size_bar for one in clustering.picture(film).findobj(AnchoredSizeBar)]
    assert len(bars) == 4 and {bar.get_children()[0].get_width() for bar in bars} == {20.0}


def test_another_kind_of_file_is_refused(path, tmp_path):
    with pytest.raises(InputError, match=r"a\.gif: must end in \.pdf, \.png, \.svg, \.mp4"):
        clustering.draw(path, [tmp_path / "a.png", tmp_path / "a.gif"])
    assert list(tmp_path.iterdir()) == []
