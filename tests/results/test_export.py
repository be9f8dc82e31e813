"""Datasets as CSV: every number comes back with the same bits."""

import csv
import json

import netCDF4
import numpy as np
import xarray as xr
from tests.entry import main

from roughgas.theory.prediction import predicted_ratio


def columns(path):
    """The columns of a CSV file, as text."""
    with open(path, newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    return dict(zip(head, map(list, zip(*rows, strict=True)), strict=True))


def numbers(texts, dtype=float):
    return np.array([float(text or "nan") for text in texts]).astype(dtype)


def exported(path, folder):
    assert main(["export", str(path), "-o", str(folder / "out.csv")]) == 0
    tables = {file.name: columns(file) for file in folder.glob("*.csv")}
    packages = [json.loads(file.read_text()) for file in folder.glob("*.datapackage.json")]
    described = {one["path"]: one for package in packages for one in package["resources"]}
    assert set(described) == set(tables)
    for name, one in described.items():
        assert [field["name"] for field in one["schema"]["fields"]] == list(tables[name])
    return tables


def agrees(dataset, tables, base="out"):
    """Every variable is in the table that the description names, to the last bit."""
    about = tables[f"{base}.about.csv"]
    seen = set()
    for name, file, value, units in zip(*(about[key] for key in list(about)[:4]), strict=True):
        if name in dataset.variables:
            found = tables[file][name] if file else [value]
            variable = dataset[name]
            seen.add(name)
            assert units == variable.attrs.get("reduced_units", variable.attrs.get("units", ""))
            if variable.dtype.kind in "OU":
                assert set(found) == set(variable.values.flat)
            elif variable.dtype.kind == "i" and not variable.dims:
                assert int(value) == variable.item()
            elif name not in dataset.dims:
                here = variable.values.ravel().astype(float)
                there = numbers(found, variable.dtype).astype(float)
                np.testing.assert_array_equal(there, here, strict=True)
    assert seen == set(dataset.variables)


def test_a_data_package_tells_types_and_units(files, tmp_path):
    exported(files["point"], tmp_path)
    package = json.loads((tmp_path / "out.datapackage.json").read_text())
    assert package["profile"] == "tabular-data-package" and package["name"] == "out"
    names = [one["name"] for one in package["resources"]]
    assert names == ["out", "out.replica", "out.source-motion", "out.about"]
    fields = {one["name"]: one for one in package["resources"][0]["schema"]["fields"]}
    assert fields["sample"]["type"] == "integer"
    assert fields["time"] == {
        "name": "time",
        "type": "number",
        "title": "time since the start",
        "unit": "T",
    }


def test_a_point(files, tmp_path):
    tables = exported(files["point"], tmp_path)
    assert set(tables) == {
        "out.csv",
        "out.replica.csv",
        "out.source-motion.csv",
        "out.about.csv",
    }
    assert list(tables["out.csv"]) == ["sample", "time", "R_series", "R_series_stderr"]
    agrees(xr.load_dataset(files["point"]), tables)
    about = dict(
        zip(tables["out.about.csv"]["name"], tables["out.about.csv"]["value"], strict=True)
    )
    assert about["collisions"] == "1152921504606846977" and about[":experiment"] == "vibrated"
    assert about["measured_from"] == ""


def test_a_reduced_dataset_is_the_table_of_the_pipeline_in_full_precision(files, tmp_path):
    data = xr.load_dataset(files["reduced"])
    tables = exported(files["reduced"], tmp_path)
    agrees(data, tables)
    assert main(["table", str(files["reduced"]), "-o", str(tmp_path / "table.csv")]) == 0
    table, grid = columns(tmp_path / "table.csv"), tables["out.csv"]
    assert list(grid)[: len(table)] == list(table)
    np.testing.assert_allclose(numbers(grid["residual"]), numbers(table["residual"]), rtol=1e-9)
    theory = predicted_ratio(data.attrs, numbers(grid["r"]), numbers(grid["beta"]))
    np.testing.assert_array_equal(numbers(grid["R_theory"]), theory)


def test_a_film(files, tmp_path):
    tables = exported(files["film"], tmp_path)
    agrees(xr.load_dataset(files["film"]), tables)
    assert tables["out.disk.csv"]["frame"] == list("011222")


def test_studies(files, tmp_path):
    tables = exported(files["studies"], tmp_path)
    data = xr.load_dataset(files["studies"], group="coverage")
    agrees(data, tables, "out.coverage")
    assert set(tables) == {
        "out.coverage.corner-way-level.csv",
        "out.coverage.corner.csv",
        "out.coverage.about.csv",
    }


def test_what_is_no_dataset_of_the_pipeline_is_refused(files, tmp_path, capsys):
    xr.Dataset({"R": 1.0}).to_netcdf(tmp_path / "other.nc")
    (tmp_path / "text.nc").write_text("no dataset")
    newer = tmp_path / "newer.nc"
    newer.write_bytes(files["film"].read_bytes())
    with netCDF4.Dataset(newer, "a") as file:
        file.schema_version = 3
    for name, status, words in (
        ("other.nc", 2, "must be a dataset of roughgas"),
        ("newer.nc", 2, "= 3: must be at most 2: a newer roughgas"),
        ("text.nc", 2, "text.nc"),
        ("none.nc", 1, "none.nc"),
    ):
        assert main(["export", str(tmp_path / name)]) == status
        (line,) = capsys.readouterr().err.splitlines()
        assert words in line
    assert main(["export", str(files["film"]), "-o", "out.txt"]) == 2
    assert "--output = out.txt: must end in .csv" in capsys.readouterr().err
    assert not list(tmp_path.glob("*.csv"))
