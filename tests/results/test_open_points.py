"""Points as one dataset over r, beta and the seed: in memory, and with dask."""

import os
import shutil
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from tests import files

from roughgas import open_points
from roughgas.base import InputError
from roughgas.data.point import read_point, write_point
from roughgas.results import open_points as opening

EVERY = "r*/beta*/seed*.nc"
OLD = Path(__file__).parents[1] / "data/of_9b3e2876/point.nc"
NEEDS_DASK = pytest.mark.skipif(not find_spec("dask"), reason="dask is not installed")


@pytest.fixture(params=["in memory", pytest.param("with dask", marks=NEEDS_DASK)])
def lazy(request, monkeypatch):
    """Whether arrays stay in files."""
    has_dask = request.param == "with dask"
    monkeypatch.setattr(opening, "_has_dask", lambda: has_dask)
    return has_dask


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(r=0.9, beta=0.5, seed=1, changes=(), **variables):
    """Write a point to its path in the present folder, and return the path."""
    point = files.point(seed + round(100 * r + 10 * beta))
    variables_of_point = {
        name: value for name, value in (point.variables | variables).items() if value is not None
    }
    attributes = files.ATTRIBUTES | {"r": r, "beta": beta, "seed": seed, "r_label": f"{r:g}"}
    path = f"r{r:g}/beta{beta:g}/seed{seed}.nc"
    write_point(
        path, point._replace(variables=variables_of_point, attributes=attributes | dict(changes))
    )
    return path


def check(data, point):
    """Assert that a dataset has the numbers of a point, and NaN beyond the end of its series."""
    inside = data.sel({name: point.attrs[name] for name in ("r", "beta", "seed")})
    inside = inside.isel({dim: slice(length) for dim, length in point.sizes.items()})
    for name in point.data_vars:
        assert inside[name].dims == point[name].dims, name
        np.testing.assert_array_equal(inside[name], point[name], err_msg=name)
        assert inside[name].attrs.keys() == point[name].attrs.keys()


def test_a_dataset_has_the_numbers_of_each_point(folder, lazy):
    paths = [write(r, beta, seed) for r in (0.9, 0.8) for beta in (0.5, -1) for seed in (10, 9)]
    data = open_points(EVERY)
    assert list(data.R.dims) == ["r", "beta", "seed"] and (data.R_series.chunks is not None) == lazy
    assert data.r.values.tolist() == [0.8, 0.9] and data.beta.values.tolist() == [-1, 0.5]
    assert data.seed.values.tolist() == [9, 10] and data.seed.dtype == np.int64
    assert data.collisions.dtype == np.int64 and data.equilibrated.dtype == np.int8
    for path in paths:
        check(data, read_point(path))
    assert data.time.dims == ("sample",) and data.source.values.tolist() == ["floor", "contacts"]
    assert data.r.long_name and data.R_series.units == "1"
    assert data.attrs["experiment"] == "vibrated" and data.attrs.keys().isdisjoint({"r", "r_label"})
    assert open_points(Path(EVERY)).identical(data) and open_points(paths[::-1]).identical(data)
    data.to_netcdf("all.nc")
    assert xr.load_dataset("all.nc").identical(data.compute())


def test_missing_points_are_nan(folder, lazy):
    paths = [write(0.8, 0, 1), write(0.9, 0.5, 2), write(0.9, 0.5, 10)]
    data = open_points(EVERY)
    assert dict(data.R.sizes) == {"r": 2, "beta": 2, "seed": 3}
    for name, column in data.data_vars.items():
        present = ~np.isnan(column.sel(r=0.8, beta=0.5))
        assert not present.any(), name
    assert data.collisions.notnull().sum() == 3 and data.collisions.sel(r=0.8, beta=0, seed=1) > 0
    assert data.R_replica.notnull().sum() == 3 * 5
    for path in paths:
        check(data, read_point(path))


def test_series_that_are_not_equally_long_end_in_nan(folder, lazy):
    short = {name: np.arange(3.0) for name in ("time", "R_series", "R_series_stderr")}
    memory = {"last_memory": np.zeros((5, 7), "u1")}
    paths = [write(seed=1, **memory), write(seed=2, **short, last_memory=np.zeros((5, 8), "u1"))]
    data = open_points(EVERY)
    assert data.R_series.sizes["sample"] == 50 and "last_memory" not in data
    for path in paths:
        check(data.drop_vars("R_replica"), read_point(path).drop_vars(["last_memory", "R_replica"]))
    assert data.time.dims == ("r", "beta", "seed", "sample") and "time" in data.coords
    assert data.time.sel(seed=2).notnull().sum() == data.R_series.sel(seed=2).notnull().sum() == 3


def test_a_clock_that_goes_on_longer_is_shared(folder, lazy):
    short = {name: np.arange(4) / 3 for name in ("time", "R_series", "R_series_stderr")}
    paths = [write(seed=1, **short), write(seed=2)]
    data = open_points(EVERY)
    assert data.time.dims == ("sample",) and data.time.equals(
        read_point(paths[1]).time.drop_vars(["r", "beta", "seed"])
    )
    for path in paths:
        check(data, read_point(path))


def test_variables_along_different_words_are_left_out(folder, lazy):
    paths = [write(seed=1), write(seed=2, source=["walls", "contacts"])]
    data = open_points(paths)
    assert {"source", "energy_input"}.isdisjoint(data.variables)
    assert {"motion", "R", "R_series"} <= data.variables.keys()


def test_a_variable_that_one_point_has_is_nan_in_the_others(folder, lazy):
    data = open_points([write(seed=1), write(seed=2, target_met=1, E_rot_series=np.ones(50))])
    assert data.target_met.values.ravel().tolist() == pytest.approx([np.nan, 1], nan_ok=True)
    first, second = (data.E_rot_series.sel(seed=seed) for seed in (1, 2))
    assert np.isnan(first).all() and (second == 1).all()


@pytest.mark.parametrize("levels", [(0.5, 0.25), ("sine", "saw")])
def test_a_swept_parameter_is_the_first_axis(folder, lazy, levels):
    key = "floor.wave" if isinstance(levels[0], str) else "spin.inertia"
    paths = []
    for level in levels:
        attributes = {"swept": key, "swept_value": level, "variant": f"v{level}"}
        paths.append(shutil.move(write(changes=attributes), f"{level}.nc"))
    data, name = open_points(paths), key.partition(".")[2]
    assert data.R.dims == (name, "r", "beta", "seed")
    assert data[name].values.tolist() == sorted(levels) and data[name].long_name.endswith(key)
    for path, level in zip(paths, levels, strict=True):
        check(data.sel({name: level}), read_point(path))


def test_old_files_are_read_with_new_ones(folder, lazy):
    new = write(seed=1)
    with xr.open_dataset(write(seed=2)) as data:
        data.drop_vars(["r", "beta", "seed"]).to_netcdf("old.nc")
    data = open_points([new, "old.nc"])
    check(data, read_point(new))
    check(data, read_point("old.nc"))
    assert open_points(OLD).R.item() == read_point(OLD).R


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ("none*.nc", "points = 'none*.nc': must be files: there are none"),
        ("none.nc", "points = 'none.nc': must be files: there are none"),
        ([], "points = []: must be files: there are none"),
        (["first.nc", "first.nc"], "points = first.nc and first.nc: must differ in r, beta or se"),
        ("*.nc", "scale of the points = paper and small: must be one"),
        (["first.nc", "other.nc"], "experiment of the points = cooling and vibrated: must be one"),
        (["first.nc", "swept.nc"], "swept of the points = (none) and spin.inertia: must be one"),
        ("reduced*", "file = reduced.nc: must be a point, not a reduced dataset"),
        ("text*", "file = text.nc: must be a dataset of roughgas: it is of another program, or"),
        ("all*", "file = all.nc: must be a point"),
        (".", "file = .: must be a file"),
    ],
)
def test_files_that_are_no_set_of_points_are_refused_in_one_line(
    folder, files, lazy, points, message
):
    changes = {
        "other": {"experiment": "cooling"},
        "paper": {"scale": "paper"},
        "swept": {"swept": "spin.inertia", "swept_value": 0.5},
    }
    for seed, (name, attributes) in enumerate({"first": {}, **changes}.items()):
        os.replace(write(seed=seed, changes=attributes), f"{name}.nc")
    if points != "*.nc":
        shutil.copy(files["reduced"], "reduced.nc")
        Path("text.nc").write_text("text")
        open_points("first.nc").to_netcdf("all.nc")
    else:
        os.remove("other.nc")
        os.remove("swept.nc")
    with pytest.raises(InputError) as caught:
        open_points(points)
    assert str(caught.value).startswith(message) and "\n" not in str(caught.value)


@NEEDS_DASK
def test_with_dask_arrays_are_read_when_they_are_computed_each_file_once(folder, monkeypatch):
    for seed in range(8):
        write(seed=seed)
    data = open_points(EVERY)
    assert data.R_series.chunksizes["seed"] == (1,) * 8 and data.R.chunks is None
    read, opened = [], opening.opened

    def noted(path, kind):
        read.append(path)
        return opened(path, kind)

    monkeypatch.setattr(opening, "opened", noted)
    monkeypatch.chdir("/")
    data[["R_series", "R_replica"]].compute()
    assert len(read) == len(set(read)) == 8
    data.R_series.sel(seed=3).compute()
    assert len(read) == 9 and read[-1].endswith("seed3.nc")
