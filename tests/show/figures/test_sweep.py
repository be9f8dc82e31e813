"""`roughgas plot`: any reduced dataset as a figure."""

import json

import numpy as np
import pytest
from matplotlib.image import imread
from synthetic import reduced

from roughgas.base import InputError
from roughgas.cli import main
from roughgas.show.figures import sweep

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
    "words": (
        reduced("waves", beta=BETA, r=(0.9,), third=("floor.wave", WAVES)),
        1,
        "wave",
    ),
}


@pytest.mark.parametrize("kind", DATA)
def test_any_sweep_is_drawn_beside_theory(kind):
    data, panels, label = DATA[kind]
    figure = sweep.draw(data)
    above, below = figure.axes[:panels], figure.axes[panels:]
    assert len(below) == panels and {axes.get_xlabel() for axes in below} == {label}
    assert all(axes.get_legend() is None for axes in above[:-1])
    drawn = [line for line in above[0].lines if line.get_marker() not in ("None", None, "")]
    series = 3 if kind == "r and beta" else len(BETA)
    markers = {line.get_marker() for line in drawn} - {"_", "|"}
    assert len(markers) >= min(series, 4)
    if kind == "words":
        assert [tick.get_text() for tick in below[0].get_xticklabels()][:2] == [
            "reversed\nsawtooth",
            "sawtooth",
        ]
    if kind == "particles":
        assert "$N = 40$ to $2560$" in above[0].get_title("left")
        assert below[0].get_xscale() == "log"


def test_of_many_series_some_are_shown_and_the_rest_named(tmp_path, capsys):
    path = tmp_path / "inertia.nc"
    reduced("inertia", r=(0.9,), third=("spin.inertia", (0.1, 1.0))).to_netcdf(path)
    assert main(["plot", str(path), "-o", str(tmp_path / "my.png"), str(tmp_path / "my.svg")]) == 0
    assert "5 of 21 values of beta are shown: -0.95, " in capsys.readouterr().err
    assert imread(tmp_path / "my.png").std() > 0.05 and "<svg" in (tmp_path / "my.svg").read_text()
    chosen = ["plot", str(path), "--beta", "0", "1", "--over", "inertia", "-o"]
    assert main([*chosen, str(tmp_path / "two.png")]) == 0
    assert "2 of 21 values of beta are shown: 0, 1" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"over": "mu"}, "axis = mu: must be one of r, beta"),
        ({"beta": [0.05]}, "beta = 0.05: must be one of -0.95, -0.9"),
    ],
)
def test_what_the_data_lack_is_refused(asked, message):
    with pytest.raises(InputError, match=message):
        sweep.draw(reduced("sheared"), **asked)


def test_where_nothing_spins_energy_is_drawn():
    data = reduced("smooth", beta=(-1.0,), r=(0.8, 0.9))
    data = data.drop_vars([name for name in data if name.startswith("R")])
    data["E_trans"] = data.E_trans + np.array([[1.0], [2.0]])
    (axes,) = sweep.draw(data, over="r").axes
    assert axes.get_ylabel().startswith(r"$E_\mathrm{trans}$")
    assert list(axes.containers[0][0].get_ydata()) == [2.0, 3.0]


def test_experiments_are_listed(capsys):
    assert main(["experiments", "--scale", "small"]) == 0
    text = capsys.readouterr().out
    assert "vibrated_rough_walls\n  The vibrated bed between" in text
    assert "5 points: 1 r, 5 beta; extends vibrated" in text
    assert main(["experiments", "--json"]) == 0
    waves = json.loads(capsys.readouterr().out)["waves.waves"]
    assert waves["points"] == 72 and waves["sweep"]["floor.wave"][0] == "sawtooth"
