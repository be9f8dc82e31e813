"""Figures of single datasets: of points over time, and of sweeps."""

import math

import numpy as np
import pytest
from matplotlib.colors import to_hex
from synthetic import reduced
from tests.show.figures.legibility import faults

from roughgas.cli import main
from roughgas.data.point import read_point
from roughgas.show.figures import sweep
from roughgas.theory.prediction import ratio_of_point
from show.page.conftest import write


@pytest.fixture(scope="module")
def points(tmp_path_factory):
    """Points of a cooling gas, of a gas without spin, and of a driven gas with an average of R over
    collisions."""
    folder = tmp_path_factory.mktemp("points")
    cooling = read_point(write(folder, "cooling", "0.9", "0.5", cooling=True))
    sheared = read_point(write(folder, "sheared", "0.9", "0.5"))
    smooth = cooling.drop_vars([name for name in cooling if name[:2] == "R_" or name == "R"])
    collided = sheared.assign(R_collisional=0.34, R_collisional_stderr=0.002)
    return {"cooling": cooling, "sheared": collided, "smooth": smooth.drop_vars("E_rot_series")}


def lines_by_label(axes):
    return {line.get_label().partition(":")[0]: line for line in axes.get_lines()}


@pytest.mark.parametrize("name", ["cooling", "sheared", "smooth"])
def test_the_figure_shows_the_data_of_the_point(points, name):
    point = points[name]
    theory = ratio_of_point(point) if "R" in point else math.nan
    assert faults(lambda: sweep.draw_point(point, theory)) == []
    *ratio, energies = sweep.draw_point(point, theory).axes
    cools = "plateau_end" in point
    clock = point.collisions_per_particle if cools else point.time
    assert energies.get_yscale() == ("log" if cools else "linear")
    assert energies.get_xlabel() == ("collisions per particle" if cools else "time / $T$")
    end = float(point.plateau_end) if cools else float(clock[-1])
    (shaded,) = [
        artist
        for artist in energies.patches
        if to_hex(artist.get_facecolor()) == sweep.WINDOW_COLOUR
    ]
    span = shaded.get_x(), shaded.get_x() + shaded.get_width()
    assert span == pytest.approx((float(point.measured_from), end))
    (E_trans,) = [artist for artist in energies.get_lines() if "trans" in artist.get_label()]
    block = math.ceil(clock.size / sweep.MAX_TIMES)
    assert block == 2
    assert E_trans.get_ydata()[0] == pytest.approx(point.E_trans_series.values[:block].mean())
    assert len(ratio) == ("R" in point)
    for axes in ratio:
        lines = lines_by_label(axes)
        assert set(lines["mean of $R(t)$"].get_ydata()) == {float(point.R)}
        assert ("over collisions" in lines) == (name == "sheared")
        band = axes.collections[-1].get_paths()[0].get_extents()
        R, half_width = float(point.R), float(point.R_ci95)
        assert (band.y0, band.y1) == pytest.approx((R - half_width, R + half_width))
        (theory_line,) = [
            line for label, line in lines.items() if "theory" in label or "Lun" in label
        ]
        assert np.unique(theory_line.get_ydata()) == [theory]


def test_the_command_draws_points_too(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    write(tmp_path, "sheared", "0.9", "0.5").rename("p.nc")
    assert main(["plot", "p.nc", "-o", "p.svg"]) == 0
    assert main(["plot", "p.nc", "--beta", "0.5", "-o", "q.svg"]) == 2
    message = "dataset = p.nc: must be a reduced one for --over, --r, --beta and --theory"
    assert message in capsys.readouterr().err


WAVES = ("reversed_sawtooth", "sawtooth", "sine", "triangle")
BETA = (-0.5, 0.0, 0.5, 1.0)
DATA = {
    "r and beta": (reduced("sheared"), 1, r"roughness $\beta$"),
    "particles": (
        reduced("more", r=(0.8, 0.9), beta=BETA, third=("particles", (40.0, 160.0, 2560.0))),
        2,
        "number of particles $N$",
    ),
    "a length": (
        reduced("longer", beta=BETA, r=(0.9,), third=("schedule.measure", (10.0, 20.0))),
        1,
        "measure",
    ),
    "words": (reduced("waves", beta=BETA, r=(0.9,), third=("floor.wave", WAVES)), 1, "wave"),
}


@pytest.mark.parametrize("kind", DATA)
def test_any_sweep_is_drawn_with_theory(kind):
    data, panels, label = DATA[kind]
    figure = sweep.draw(data)
    above, below = figure.axes[:panels], figure.axes[panels:]
    assert len(below) == panels and {axes.get_xlabel() for axes in below} == {label}
    assert all(axes.get_legend() is None for axes in above[:-1])
    point_lines = [line for line in above[0].lines if line.get_marker() not in ("None", None, "")]
    series = 3 if kind == "r and beta" else len(BETA)
    markers = {line.get_marker() for line in point_lines} - {"_", "|"}
    assert len(markers) >= min(series, 4)
    if kind == "words":
        assert [tick.get_text() for tick in below[0].get_xticklabels()][:2] == [
            "reversed\nsawtooth",
            "sawtooth",
        ]
    if kind == "particles":
        assert "$N = 40$ to $2560$" in above[0].get_title("left")
        assert below[0].get_xscale() == "log"
