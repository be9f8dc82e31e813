"""A point over time: what is drawn are its numbers, the window in which it is measured shaded."""

import math

import numpy as np
import pytest
from matplotlib.colors import to_hex
from tests.show.figures.legibility import faults

from roughgas.cli import main
from roughgas.data.point import read_point
from roughgas.show.figures import timeline
from roughgas.theory.prediction import ratio_of_point
from show.page.conftest import write


@pytest.fixture(scope="module")
def points(tmp_path_factory):
    """A cooling gas, one without spin, and a driven one with an average over collisions."""
    folder = tmp_path_factory.mktemp("points")
    cooling = read_point(write(folder, "cooling", "0.9", "0.5", cooling=True))
    sheared = read_point(write(folder, "sheared", "0.9", "0.5"))
    smooth = cooling.drop_vars([name for name in cooling if name[:2] == "R_" or name == "R"])
    collided = sheared.assign(R_collisional=0.34, R_collisional_stderr=0.002)
    return {"cooling": cooling, "sheared": collided, "smooth": smooth.drop_vars("E_rot_series")}


def drawn(axes):
    return {line.get_label().partition(":")[0]: line for line in axes.get_lines()}


@pytest.mark.parametrize("name", ["cooling", "sheared", "smooth"])
def test_what_is_drawn_is_the_point(points, name):
    point = points[name]
    theory = ratio_of_point(point) if "R" in point else math.nan
    assert faults(lambda: timeline.draw(point, theory)) == []
    *ratio, energies = timeline.draw(point, theory).axes
    cools = "plateau_end" in point
    clock = point.collisions_per_particle if cools else point.time
    assert energies.get_yscale() == ("log" if cools else "linear")
    assert energies.get_xlabel() == ("collisions per particle" if cools else "time / $T$")
    end = float(point.plateau_end) if cools else float(clock[-1])
    (shaded,) = [one for one in energies.patches if to_hex(one.get_facecolor()) == timeline.WINDOW]
    span = shaded.get_x(), shaded.get_x() + shaded.get_width()
    assert span == pytest.approx((float(point.measured_from), end))
    (E_trans,) = [one for one in energies.get_lines() if "trans" in one.get_label()]
    block = math.ceil(clock.size / timeline.MOST)
    assert block == 2
    assert E_trans.get_ydata()[0] == pytest.approx(point.E_trans_series.values[:block].mean())
    assert len(ratio) == ("R" in point)
    for axes in ratio:
        lines = drawn(axes)
        assert set(lines["mean of $R(t)$"].get_ydata()) == {float(point.R)}
        assert ("over collisions" in lines) == (name == "sheared")
        band = axes.collections[-1].get_paths()[0].get_extents()
        R, half = float(point.R), float(point.R_ci95)
        assert (band.y0, band.y1) == pytest.approx((R - half, R + half))
        (found,) = [line for label, line in lines.items() if "theory" in label or "Lun" in label]
        assert np.unique(found.get_ydata()) == [theory]


def test_a_verdict_without_evidence_is_said(points):
    unknown = points["cooling"].assign(R_ci95_trusted=-1)
    (band,) = timeline.draw(unknown, math.nan).axes[0].collections
    assert band.get_label() == "95 % interval, whether to trust it is not known"


def test_the_command_draws_points_too(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    write(tmp_path, "sheared", "0.9", "0.5").rename("p.nc")
    assert main(["plot", "p.nc", "-o", "p.svg"]) == 0
    assert main(["plot", "p.nc", "--beta", "0.5", "-o", "q.svg"]) == 2
    said = "dataset = p.nc: must be a reduced one for --over, --r and --beta"
    assert said in capsys.readouterr().err
