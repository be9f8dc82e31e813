"""Reduced datasets, with and without a third axis."""

import csv
import math
import random

import numpy as np
import pytest

from roughgas import theory
from roughgas.base import InputError
from roughgas.data.point import Point, write_point
from roughgas.data.reduced import read_reduced
from roughgas.results.reduce import _share, reduce_points
from roughgas.results.tables import write_table

ATTRIBUTES = {
    "experiment": "sheared",
    "scale": "small",
    "dimension": 2,
    "inertia": 0.5,
    "particles": 40,
}


def write(folder, r, beta, seed, ratio, cooling=False, attributes=None, **further_variables):
    """Write a point; R_series rises by 0.02 at the middle of the measured window."""
    clock = np.arange(0.0, 13.0)
    variables = {
        "R": ratio,
        "R_stderr": 0.01 * seed,
        "R_dof": 0.0,
        "R_ci95": math.nan,
        "R_ratio_of_means": ratio - 0.01,
        "E_trans": 2.0,
        "E_rot": 1.0,
        "collisions": 100,
        "kernel_seconds": 0.5,
        "equilibrated": 1,
        "measured_from": 3.0,
        "R_series": np.where(clock < 8, ratio, ratio + 0.02),
        "collisions_per_particle" if cooling else "time": clock,
    }
    attributes_of_point = ATTRIBUTES | {
        "r": r,
        "beta": beta,
        "seed": seed,
        "kernel_source_hash": "k",
    }
    attributes_of_point |= attributes or {}
    path = folder / f"r{r}" / f"beta{beta}" / f"seed{seed}.nc"
    write_point(path, Point(variables | further_variables, attributes_of_point))
    return path


@pytest.fixture
def paths(tmp_path):
    """Two r, two beta, and three seeds, two, one and none at the four points."""
    ratios = {1: 0.20, 2: 0.22, 3: 0.27}
    further = {seed: {"R_unsubtracted": 0.1 * seed} for seed in ratios}
    points = [write(tmp_path, 0.9, -0.5, seed, R, **further[seed]) for seed, R in ratios.items()]
    points += [
        write(tmp_path, 0.9, 0.5, seed, ratios[seed], equilibrated=seed % 2, **further[seed])
        for seed in (1, 2)
    ]
    return [*points, write(tmp_path, 0.8, 0.5, 3, 0.3, **further[3])]


def test_means_and_errors_over_seeds(paths, tmp_path):
    reduce_points(paths, tmp_path / "out" / "sheared.nc")
    data = read_reduced(tmp_path / "out" / "sheared.nc")
    assert list(data.r) == [0.8, 0.9] and list(data.beta) == [-0.5, 0.5]
    assert list(data.seed) == [1, 2, 3]
    full = data.sel(r=0.9, beta=-0.5)
    assert full.R.item() == pytest.approx(0.23)
    scatter = pytest.approx(np.std([0.2, 0.22, 0.27], ddof=1) / math.sqrt(3))
    assert full.R_stderr_over_seeds.item() == scatter
    # these runs state no error
    assert full.R_stderr.item() == scatter and full.R_dof.item() == 2
    assert full.R_ci95.item() == pytest.approx(4.303 * full.R_stderr.item(), rel=0.05)
    assert full.R_stderr_within.item() == pytest.approx(0.01 * math.sqrt(1 + 4 + 9) / 3)
    assert full.R_ratio_of_means.item() == pytest.approx(0.22)
    assert full.R_unsubtracted.item() == pytest.approx(0.2)
    assert full.R_unsubtracted_stderr.item() == pytest.approx(0.1 / math.sqrt(3))
    assert full.collisions.item() == 300 and full.collisions.dtype == np.int64
    assert full.kernel_seconds.item() == 1.5
    np.testing.assert_array_equal(full.R_seed, [0.2, 0.22, 0.27])


@pytest.mark.parametrize("runaways, equilibrated", [(0, 1.0), (1, 0.0)])
def test_a_mixture_of_replicas_over_all_seeds_is_no_steady_state(tmp_path, runaways, equilibrated):
    """Two replicas a seed are too few for a verdict by themselves; at the other point none runs
    away."""
    points = []
    for seed, beta in ((seed, beta) for seed in range(1, 7) for beta in (-0.5, 0.5)):
        replicas = 0.27 + 0.001 * np.array([seed, -seed])
        if seed == 3 and beta > 0:
            replicas[:runaways] = 1.0
        points.append(write(tmp_path, 0.9, beta, seed, 0.27, True, R_replica=replicas))
    reduce_points(points, tmp_path / "cooling.nc")
    assert list(read_reduced(tmp_path / "cooling.nc").equilibrated[0]) == [1.0, equilibrated]


def test_missing_seeds_and_points(paths, tmp_path):
    reduce_points(paths, tmp_path / "sheared.nc")
    data = read_reduced(tmp_path / "sheared.nc")
    np.testing.assert_array_equal(data.n_seeds, [[0, 1], [3, 2]])
    two = data.sel(r=0.9, beta=0.5)
    assert np.isnan(two.R_seed.sel(seed=3)) and two.R.item() == pytest.approx(0.21)
    assert two.equilibrated.item() == 0.5
    single = data.sel(r=0.8, beta=0.5)
    assert (
        single.R.item() == 0.3 and single.R_stderr.item() == single.R_stderr_within.item() == 0.03
    )
    none = data.sel(r=0.8, beta=-0.5)
    assert np.isnan(none.R) and np.isnan(none.R_stderr) and np.isnan(none.R_stderr_within)


def test_drift_and_length_of_the_measured_window(tmp_path):
    paths = [write(tmp_path, 0.9, 0.0, seed, 0.2) for seed in (1, 2)]
    reduce_points(paths, tmp_path / "sheared.nc")
    data = read_reduced(tmp_path / "sheared.nc")
    assert data.measured_for.item() == 9.0 and data.measured_for.reduced_units == "T"
    assert data.R_drift.item() == pytest.approx(0.02)
    plateau = [write(tmp_path, 0.8, 0.0, 1, 0.2, cooling=True, plateau_end=7.0)]
    reduce_points(plateau, tmp_path / "cooling.nc")
    data = read_reduced(tmp_path / "cooling.nc")
    assert data.measured_for.item() == 4.0
    assert data.measured_for.reduced_units == "collisions per particle"
    assert data.R_drift.item() == pytest.approx(0.0, abs=1e-15)


def test_the_order_of_the_points_does_not_matter(paths, tmp_path):
    reduce_points(paths, tmp_path / "a.nc")
    random.Random(1).shuffle(paths)
    reduce_points(paths, tmp_path / "b.nc")
    assert read_reduced(tmp_path / "a.nc").identical(read_reduced(tmp_path / "b.nc"))
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()


def test_unequal_points_are_refused(paths, tmp_path):
    out = tmp_path / "out.nc"
    with pytest.raises(InputError, match="number of points"):
        reduce_points([], out)
    with pytest.raises(InputError, match="given once"):
        reduce_points([*paths, paths[0]], out)
    cooling = write(tmp_path, 0.7, 0.0, 1, 0.2, attributes={"experiment": "cooling"})
    with pytest.raises(InputError, match="cooling and sheared: must be the same"):
        reduce_points([*paths, cooling], out)
    assert not out.exists()


def test_the_table_has_one_row_for_each_point_with_data(paths, tmp_path):
    reduce_points(paths, tmp_path / "sheared.nc")
    cooling = [write(tmp_path, 0.7, 0.0, 1, 0.3, True, {"experiment": "cooling"}, plateau_end=9.0)]
    reduce_points(cooling, tmp_path / "cooling.nc")
    write_table([tmp_path / "sheared.nc", tmp_path / "cooling.nc"], output=tmp_path / "R.csv")
    rows = list(csv.DictReader((tmp_path / "R.csv").read_text(encoding="utf-8").splitlines()))
    places = [(row["experiment"], row["r"], row["beta"]) for row in rows]
    assert places == [
        ("sheared", "0.8", "0.5"),
        ("sheared", "0.9", "-0.5"),
        ("sheared", "0.9", "0.5"),
        ("cooling", "0.7", "0"),
    ]
    row = rows[1]
    assert (row["particles"], row["n_seeds"], row["theory"]) == ("40", "3", "lun")
    assert float(row["R"]) == pytest.approx(0.23)
    assert float(row["residual"]) == pytest.approx(0.23 - theory.lun_ratio(-0.5, 0.5))
    assert float(row["R_unsubtracted"]) == pytest.approx(0.2) and "kernel_seconds" not in row
    assert rows[3]["R_unsubtracted"] == ""
    assert float(rows[3]["R_theory"]) == pytest.approx(theory.cooling_ratio(0.7, 0.0, 2, 0.5))


def variant(folder, key, value, seed=1, ratio=0.2, beta=0.0, **attributes):
    """Write a point of a variant."""
    effect_parameter = key.rpartition(".")[2]
    label = value if isinstance(value, str) else f"{value:g}"
    axis = {"swept": key, "swept_value": value, "variant": f"{effect_parameter}{label}"}
    folder = folder / f"{effect_parameter}{label}"
    return write(folder, 0.9, beta, seed, ratio, attributes=axis | attributes)


def spun(folder, value, **options):
    return variant(folder, "spin.inertia", value, inertia=value, **options)


@pytest.fixture
def inertia(tmp_path):
    """Three values of inertia, at two beta, except for one point; two seeds."""
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
    point = data.sel(inertia=1.0, r=0.9, beta=0.5)
    assert point.R.item() == pytest.approx(0.115)
    assert point.R_stderr_over_seeds.item() == pytest.approx(0.005)
    assert np.isnan(data.R.sel(inertia=0.5, r=0.9, beta=0.5))


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
    roughness = variant(tmp_path, "walls.roughness", 1.0)
    wave = variant(tmp_path, "floor.wave", "sine")
    none = write(tmp_path, 0.9, 0.0, 1, 0.2)
    for pair in ([wave, roughness], [wave, none], [none, wave]):
        with pytest.raises(InputError, match=r"swept of the points = .* must be the same"):
            reduce_points(pair, tmp_path / "out.nc")
    with pytest.raises(InputError, match="given once"):
        reduce_points([wave, wave], tmp_path / "out.nc")


def test_the_table_has_a_row_for_each_value(inertia, tmp_path):
    reduce_points([write(tmp_path, 0.9, 0.0, 1, 0.3)], tmp_path / "plain.nc")
    reduce_points([variant(tmp_path, "floor.wave", "sine")], tmp_path / "waves.nc")
    write_table([tmp_path / "plain.nc", inertia, tmp_path / "waves.nc"], output=tmp_path / "R.csv")
    rows = list(csv.DictReader((tmp_path / "R.csv").read_text(encoding="utf-8").splitlines()))
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


def test_the_share_of_trusted_seeds_is_that_of_all_seeds():
    """Of the seeds with a verdict; unknown if half of them or more have none."""
    verdicts = np.array([[1, 1, 1, -1, -1], [1, 1, -1, -1, np.nan], [1, 0, 0, 0, -1]], float)
    assert _share(verdicts) == pytest.approx([0.6, -1.0, 0.2])
