"""The numbers in the page are those of the datasets, its theory is that of the figures."""

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
from roughgas.show.explore import GRID, LONGEST, NUMBERS, experiment, write_page
from roughgas.theory.prediction import predicted_ratio
from show.page.conftest import SAMPLES, write

pytestmark = pytest.mark.slow

EXPERIMENTS = ("sheared", "cooling", "cooling_friction")


def data_in(page):
    text = page.read_text("utf-8")
    (found,) = re.findall(r'<script id="data" type="application/json">(.*?)</script>', text, re.S)
    return json.loads(found)


def places(found):
    """Every point of an experiment with its (value on the third axis, r, beta)."""
    for variant in found["variants"]:
        value = None if variant["name"] is None else float(variant["name"].removeprefix("mu"))
        for series in variant["series"]:
            for point in series["points"]:
                yield (value, float(series["r"]), float(point["beta"])), series, point


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_every_number_is_that_of_the_reduced_dataset(points, name):
    data = read_reduced(points / f"{name}.nc")
    found = list(places(experiment(points / f"{name}.nc", points)))
    assert len(found) == np.count_nonzero(data.n_seeds)
    for (mu, r, beta), _, point in found:
        place = data.sel(r=r, beta=beta) if mu is None else data.sel(mu=mu, r=r, beta=beta)
        for shown, column in NUMBERS.items():
            if column in data:
                assert point[shown] == place[column].item(), (shown, mu, r, beta)
            assert (shown in point) == (column in data)
        assert point["steady"] is True


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_theory_is_predicted_ratio_at_the_points_and_along_the_curve(points, name):
    attributes = read_reduced(points / f"{name}.nc").attrs
    for (mu, r, beta), series, point in places(experiment(points / f"{name}.nc", points)):
        about = attributes if mu is None else attributes | {"mu": mu}
        assert point["theory"] == float(predicted_ratio(about, r, beta))
        curve = np.array(series["curve"], float)
        np.testing.assert_allclose(curve, predicted_ratio(about, r, GRID), rtol=6e-5)


def test_a_point_is_found_by_its_labels_and_says_how_to_run_it_again(points):
    (variant,) = experiment(points / "sheared.nc", points)["variants"]
    (series,) = variant["series"]
    assert (series["r"], [one["beta"] for one in series["points"]]) == ("0.9", ["-0.5", "0.50"])
    point = series["points"][1]
    path = points / "sheared/r0.9/beta0.50/seed1.nc"
    assert point["target"] == str(path)
    assert point["command"] == read_point(path).attrs["command"]


def test_time_series_are_means_over_blocks(points):
    (variant,) = experiment(points / "cooling.nc", points)["variants"]
    shown = variant["series"][0]["points"][0]["over_time"]
    whole = read_point(points / "cooling/r1/beta-0.5/seed1.nc")
    assert shown["clock"] == "collisions_per_particle" and shown["measured"] == [100.0, 400.0]
    assert shown["block"] == 3 and len(shown["at"]) == SAMPLES / 3 <= LONGEST
    for name in ("R", "E_trans", "E_rot"):
        expected = whole[f"{name}_series"].values.reshape(-1, 3).mean(1)
        np.testing.assert_allclose(shown[name], expected, rtol=6e-5)


def test_a_verdict_without_evidence_the_size_and_fewer_samples(points, tmp_path, monkeypatch):
    settings = {"box": [20, "open"], "effects": {}}
    more = {"experiment_json": json.dumps(settings), "packing": 0.25}
    made = write(tmp_path, "sheared", "0.9", "0.5", **more)
    with netCDF4.Dataset(made, "a") as file:
        file["equilibrated"][...] = -1
    reduce_points([made], tmp_path / "sheared.nc")
    with netCDF4.Dataset(tmp_path / "sheared.nc", "a") as file:
        file["equilibrated"][...] = -1.0
    monkeypatch.setattr("roughgas.show.explore.PLACES", 50)
    write_page([tmp_path / "sheared.nc"], points=tmp_path, output=tmp_path / "e.html")
    (found,) = data_in(tmp_path / "e.html")["experiments"]
    assert (found["box"], found["packing"], found["particles"]) == ([20, "open"], 0.25, "40")
    (shown,) = found["variants"][0]["series"][0]["points"]
    assert shown["steady"] is None and len(shown["over_time"]["R"]) == 50


def test_the_page_holds_its_data_and_asks_for_nothing(points, tmp_path):
    reduced = [str(points / f"{name}.nc") for name in EXPERIMENTS]
    page = tmp_path / "explore.html"
    assert main(["explore", *reduced, "--points", str(points), "--output", str(page)]) == 0
    found = data_in(page)
    described = [one.pop("description") for one in found["experiments"]]
    assert described[0].startswith("A gas under uniform shear") and described[0][-1] != "."
    assert found["experiments"] == [experiment(path, points) for path in reduced]
    assert [one["theory"] for one in found["experiments"]] == [
        "Lun's formula",
        "theory of free cooling",
        "rate equations with Coulomb friction",
    ]
    text = page.read_text("utf-8")
    assert not re.search(r'<(script|link|img|iframe)[^>]*(src|href)="(?!data:)', text)


def test_what_is_not_there_is_named_in_one_line(points, tmp_path, capsys):
    (points / "cooling/r1/beta0.50/seed1.nc").unlink()
    page = tmp_path / "explore.html"
    assert main(["explore", str(points / "cooling.nc"), f"--points={points}", f"-o={page}"]) == 2
    assert capsys.readouterr().err == (
        "roughgas: error: point (..., r, beta) = 1.0, 0.5: must have its seed 1 in the folder of"
        " points\n"
    )
    assert not page.exists()


def test_several_scales_do_not_mix(points, tmp_path):
    other = read_reduced(points / "sheared.nc").assign_attrs(scale="paper")
    other.to_netcdf(tmp_path / "other.nc")
    with pytest.raises(InputError, match="scale of the datasets = paper and small: must be one"):
        write_page(
            [points / "cooling.nc", tmp_path / "other.nc"],
            points=points,
            output=tmp_path / "page.html",
        )
