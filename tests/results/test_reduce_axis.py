"""Reduced datasets and tables of experiments whose sweep has a third axis."""

import csv

import numpy as np
import pytest
from test_reduce import write

from roughgas import theory
from roughgas.base import InputError
from roughgas.cli import main
from roughgas.data.reduced import read_reduced
from roughgas.results.reduce import reduce_points
from roughgas.results.table import write_table


def variant(folder, key, value, seed=1, ratio=0.2, beta=0.0, **attributes):
    """A point of a variant on disk."""
    effect_parameter = key.rpartition(".")[2]
    label = value if isinstance(value, str) else f"{value:g}"
    about = {"swept": key, "swept_value": value, "variant": f"{effect_parameter}{label}"}
    folder = folder / f"{effect_parameter}{label}"
    return write(folder, 0.9, beta, seed, ratio, attributes=about | attributes)


def spun(folder, value, **others):
    return variant(folder, "spin.inertia", value, inertia=value, **others)


@pytest.fixture
def inertia(tmp_path):
    """Three values of inertia, at two beta, but for one place; two seeds."""
    places = [(1.0, -0.5), (0.02, -0.5), (0.5, -0.5), (1.0, 0.5), (0.02, 0.5)]
    paths = [
        spun(tmp_path, value, seed=seed, ratio=0.1 * value + 0.01 * seed, beta=beta)
        for value, beta in places
        for seed in (1, 2)
    ]
    reduce_points(paths, tmp_path / "spun.nc")
    return tmp_path / "spun.nc"


def test_the_parameter_is_a_dimension(inertia):
    data = read_reduced(inertia)
    assert data.R.dims == ("inertia", "r", "beta")
    assert data.R_seed.dims == ("inertia", "r", "beta", "seed")
    np.testing.assert_array_equal(data.inertia, [0.02, 0.5, 1.0])
    assert data.inertia.units == "1" and data.inertia.long_name.endswith(": spin.inertia")
    np.testing.assert_array_equal(data.n_seeds[:, 0], [[2, 2], [2, 0], [2, 2]])
    place = data.sel(inertia=1.0, r=0.9, beta=0.5)
    assert place.R.item() == pytest.approx(0.115)
    assert place.R_stderr_over_seeds.item() == pytest.approx(0.005)
    assert np.isnan(data.R.sel(inertia=0.5, r=0.9, beta=0.5))


@pytest.mark.parametrize("key", ["particles", "box", "schedule.measure"])
def test_a_number_of_the_settings_is_a_dimension_too(tmp_path, key, capsys):
    parameter = key.rpartition(".")[2]
    for value in (20, 40):
        own = {"particles": value} if key == "particles" else {}
        variant(tmp_path, key, value, beta=0.0, seed=1, ratio=0.2, **own)
    reduce_points(sorted(tmp_path.rglob("seed*.nc")), tmp_path / "swept.nc")
    data = read_reduced(tmp_path / "swept.nc")
    assert data.R.dims == (parameter, "r", "beta") and data.attrs["swept"] == key
    np.testing.assert_array_equal(data[parameter], [20, 40])
    assert main(["show", str(tmp_path / "swept.nc")]) == 0
    shown = capsys.readouterr().out
    assert ("20 to 40 disks" in shown) == (key == "particles") and f"over {parameter}, r" in shown


def test_words_come_in_alphabetical_order_after_numbers(tmp_path):
    for values, expected in (
        (["sine", "sawtooth", "triangle"], ["sawtooth", "sine", "triangle"]),
        (["particles", 1.0, -0.25], ["-0.25", "1", "particles"]),
    ):
        folder = tmp_path / values[0]
        paths = [variant(folder, "floor.wave", value) for value in values]
        reduce_points(paths, folder / "waves.nc")
        data = read_reduced(folder / "waves.nc")
        assert list(data.wave.values) == expected
        assert data.R.sel(wave=expected[-1]).item() == 0.2


def test_points_of_another_axis_or_of_none_are_refused(tmp_path):
    other = variant(tmp_path, "walls.roughness", 1.0)
    wave = variant(tmp_path, "floor.wave", "sine")
    none = write(tmp_path, 0.9, 0.0, 1, 0.2)
    for pair in ([wave, other], [wave, none], [none, wave]):
        with pytest.raises(InputError, match=r"swept of the points = .* must be the same"):
            reduce_points(pair, tmp_path / "out.nc")
    with pytest.raises(InputError, match="given once"):
        reduce_points([wave, wave], tmp_path / "out.nc")


def test_the_table_has_a_row_for_each_value(inertia, tmp_path):
    reduce_points([write(tmp_path, 0.9, 0.0, 1, 0.3)], tmp_path / "plain.nc")
    reduce_points([variant(tmp_path, "floor.wave", "sine")], tmp_path / "waves.nc")
    write_table([tmp_path / "plain.nc", inertia, tmp_path / "waves.nc"], output=tmp_path / "R.csv")
    rows = list(csv.DictReader(open(tmp_path / "R.csv", encoding="utf-8")))
    assert list(rows[0])[4:9] == ["inertia", "parameter", "value", "r", "beta"]
    assert [(row["parameter"], row["value"], row["inertia"], row["beta"]) for row in rows] == [
        ("", "", "0.5", "0"),
        ("inertia", "0.02", "0.02", "-0.5"),
        ("inertia", "0.02", "0.02", "0.5"),
        ("inertia", "0.5", "0.5", "-0.5"),
        ("inertia", "1", "1", "-0.5"),
        ("inertia", "1", "1", "0.5"),
        ("wave", "sine", "0.5", "0"),
    ]
    assert float(rows[2]["R_theory"]) == pytest.approx(theory.lun_ratio(0.5, 0.02))
