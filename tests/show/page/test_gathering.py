"""The interactive page has the numbers of the datasets, and the theory of the figures."""

import json
import re

import netCDF4
import numpy as np
import pytest
from tests.entry import main

from roughgas.base import InputError
from roughgas.data.point import read_point
from roughgas.data.reduced import read_reduced
from roughgas.results.reduce import reduce_points
from roughgas.show.explore import (
    GRID,
    MAX_SERIES_LENGTH,
    NUMBERS,
    experiment,
    time_series,
    write_page,
)
from roughgas.theory.prediction import predicted_ratio
from show.page.conftest import SAMPLES, write

pytestmark = pytest.mark.slow

EXPERIMENTS = ("sheared", "cooling", "cooling_friction")


def data_in(page):
    text = page.read_text("utf-8")
    (json_text,) = re.findall(
        r'<script id="data" type="application/json">(.*?)</script>', text, re.S
    )
    return json.loads(json_text)


def points_of_record(record):
    """Yield (value on the third axis, r, beta), series and point of all points in a record."""
    for variant in record["variants"]:
        value = None if variant["name"] is None else float(variant["name"].removeprefix("mu"))
        for series in variant["series"]:
            for point in series["points"]:
                yield (value, float(series["r"]), float(point["beta"])), series, point


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_every_number_comes_from_the_reduced_dataset(points, name):
    data = read_reduced(points / f"{name}.nc")
    points_of_page = list(points_of_record(experiment(points / f"{name}.nc", points)))
    assert len(points_of_page) == np.count_nonzero(data.n_seeds)
    for (mu, r, beta), _, point in points_of_page:
        reduced_point = data.sel(r=r, beta=beta) if mu is None else data.sel(mu=mu, r=r, beta=beta)
        for name_in_page, column in NUMBERS.items():
            if column in data:
                assert point[name_in_page] == reduced_point[column].item(), (
                    name_in_page,
                    mu,
                    r,
                    beta,
                )
            assert (name_in_page in point) == (column in data)
        assert point["steady"] is True


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_theory_is_predicted_ratio_at_the_points_and_along_the_curve(points, name):
    attributes = read_reduced(points / f"{name}.nc").attrs
    for (mu, r, beta), series, point in points_of_record(experiment(points / f"{name}.nc", points)):
        settings = attributes if mu is None else attributes | {"mu": mu}
        assert point["theory"] == float(predicted_ratio(settings, r, beta))
        curve = np.array(series["curve"], float)
        np.testing.assert_allclose(curve, predicted_ratio(settings, r, GRID), rtol=6e-5)


def test_a_point_has_its_labels_its_target_and_its_command(points):
    (variant,) = experiment(points / "sheared.nc", points)["variants"]
    (series,) = variant["series"]
    assert (series["r"], [point_record["beta"] for point_record in series["points"]]) == (
        "0.9",
        ["-0.5", "0.50"],
    )
    point = series["points"][1]
    path = points / "sheared/r0.9/beta0.50/seed1.nc"
    assert point["target"] == str(path)
    assert point["command"] == read_point(path).attrs["command"]


def test_time_series_are_means_over_blocks(points):
    (variant,) = experiment(points / "cooling.nc", points)["variants"]
    record = variant["series"][0]["points"][0]["over_time"]
    seed = read_point(points / "cooling/r1/beta-0.5/seed1.nc")
    assert record["clock"] == "collisions_per_particle" and record["measured"] == [100.0, 400.0]
    assert record["block"] == 3 and len(record["at"]) == SAMPLES / 3 <= MAX_SERIES_LENGTH
    for name in ("R", "E_trans", "E_rot"):
        expected = seed[f"{name}_series"].values.reshape(-1, 3).mean(1)
        np.testing.assert_allclose(record[name], expected, rtol=6e-5)


def test_a_last_block_that_is_shorter_is_left_out(points):
    seed = read_point(points / "cooling/r1/beta-0.5/seed1.nc")
    record = time_series(seed, length=SAMPLES // 7)
    block = record["block"]
    assert SAMPLES % block > 0 and len(record["R"]) == SAMPLES // block
    last = seed.R_series.values[: SAMPLES // block * block][-block:]
    np.testing.assert_allclose(record["R"][-1], last.mean(), rtol=6e-5)


def test_an_undecided_verdict_the_size_and_shorter_series(points, tmp_path, monkeypatch):
    settings = {"box": [20, "open"], "effects": {}}
    attributes = {"experiment_json": json.dumps(settings), "packing": 0.25}
    path = write(tmp_path, "sheared", "0.9", "0.5", **attributes)
    with netCDF4.Dataset(path, "a") as file:
        file["equilibrated"][...] = -1
    reduce_points([path], tmp_path / "sheared.nc")
    with netCDF4.Dataset(tmp_path / "sheared.nc", "a") as file:
        file["equilibrated"][...] = -1.0
    monkeypatch.setattr("roughgas.show.explore.MAX_SERIES_VALUES", 50)
    write_page([tmp_path / "sheared.nc"], points=tmp_path, output=tmp_path / "e.html")
    (record,) = data_in(tmp_path / "e.html")["experiments"]
    assert (record["box"], record["packing"], record["particles"]) == ([20, "open"], 0.25, "40")
    (point_record,) = record["variants"][0]["series"][0]["points"]
    assert point_record["steady"] is None and len(point_record["over_time"]["R"]) == 50


def test_the_page_contains_its_data_and_loads_nothing(points, tmp_path):
    reduced = [str(points / f"{name}.nc") for name in EXPERIMENTS]
    page = tmp_path / "explore.html"
    assert main(["explore", *reduced, "--points", str(points), "--output", str(page)]) == 0
    data = data_in(page)
    descriptions = [record.pop("description") for record in data["experiments"]]
    assert descriptions[0].startswith("A gas under uniform shear") and descriptions[0][-1] != "."
    assert data["experiments"] == [experiment(path, points) for path in reduced]
    assert [record["theory"] for record in data["experiments"]] == [
        "Lun's formula",
        "theory of free cooling",
        "rate equations with Coulomb friction",
    ]
    text = page.read_text("utf-8")
    assert not re.search(r'<(script|link|img|iframe)[^>]*(src|href)="(?!data:)', text)


def test_a_missing_point_is_named_in_one_line(points, tmp_path, capsys):
    (points / "cooling/r1/beta0.50/seed1.nc").unlink()
    page = tmp_path / "explore.html"
    assert main(["explore", str(points / "cooling.nc"), f"--points={points}", f"-o={page}"]) == 2
    assert capsys.readouterr().err == (
        "roughgas: error: point (..., r, beta) = 1.0, 0.5: must have its seed 1 in the folder of"
        " points\n"
    )
    assert not page.exists()


def test_several_scales_are_refused(points, tmp_path):
    paper_data = read_reduced(points / "sheared.nc").assign_attrs(scale="paper")
    paper_data.to_netcdf(tmp_path / "other.nc")
    with pytest.raises(InputError, match="scale of the datasets = paper and small: must be one"):
        write_page(
            [points / "cooling.nc", tmp_path / "other.nc"],
            points=points,
            output=tmp_path / "page.html",
        )
