"""A dataset of each kind that the pipeline writes, small and made up, as files."""

import numpy as np
import xarray as xr

from roughgas.accuracy import coverage
from roughgas.accuracy.coverage import MEASURED
from roughgas.accuracy.running import combine
from roughgas.config import as_text
from roughgas.data.netcdf import content_of, write_netcdf
from roughgas.data.point import Point, write_point
from roughgas.results.reduce import reduce_points

ABOUT = {
    "experiment": "vibrated",
    "scale": "small",
    "r": 0.9,
    "beta": -0.5,
    "seed": 3,
    "dimension": 2,
    "inertia": 0.5,
    "particles": 40,
}


def write_all(folder):
    """The paths of the files, by kind."""
    paths = {kind: folder / f"{kind}.nc" for kind in ("point", "reduced", "studies")}
    write_point(paths["point"], point())
    reduce_points(_points(folder), paths["reduced"])
    write_studies(paths["studies"], folder)
    return paths


def _points(folder):
    for number, (wave, r) in enumerate((("sine", 0.9), ("sine", 0.8), ("saw", 0.9), ("saw", 0.8))):
        place = {"r": r, "swept": "floor.wave", "swept_value": wave}
        for seed in (1, 2):
            made = point(seed + 10 * number)
            path = folder / f"points/{wave}{r}_{seed}.nc"
            write_point(path, made._replace(attributes=ABOUT | place | {"seed": seed}))
            yield path


def point(seed=1):
    rng = np.random.default_rng(seed)
    return Point(
        {
            "R": 0.1 + 0.2 * rng.random(),
            "R_stderr": 1 / 3,
            "R_dof": 12.0,
            "R_ci95": 0.022,
            "R_ci95_trusted": 0,
            "R_ratio_of_means": 0.24,
            "E_trans": 1e-300,
            "E_rot": 1.0,
            "collisions": 2**60 + 1,
            "kernel_seconds": 0.5,
            "equilibrated": 1,
            "measured_from": np.nan,
            "R_replica": rng.random(5),
            "source": ["floor", "contacts"],
            "motion": ["translation", "rotation"],
            "energy_input": rng.standard_cauchy((2, 2)),
            "time": np.arange(50) / 3,
            "R_series": rng.random(50),
            "R_series_stderr": np.where(rng.random(50) < 0.5, np.nan, rng.random(50)),
        },
        ABOUT | {"title": "made up"},
    )


def write_studies(path, folder):
    """A study of coverage whose repetitions are random numbers."""
    corners = [{"experiment": "gas", "r": "0.9", "beta": "0"}]
    settings = {"seed": 1, "repetitions": 8, "pooled": 2, "corners": corners}
    rng = np.random.default_rng(3)
    parts = [
        {prefix + name: (dim, rng.random(count)) for name in MEASURED}
        for prefix, dim, count in (("", "run", 8), ("truth_", "long_run", 4))
    ]
    data = xr.Dataset(parts[0] | parts[1] | {"cpu_seconds": 1.0, "window": 1.0})
    (task,) = coverage.tasks(settings)
    text = as_text({"study": settings, "experiments": {}})
    about = {"study": "coverage", "task": task, "scale": "small", "settings_json": text}
    write_netcdf(folder / "task.nc", content_of(data.assign_attrs(about)))
    combine([folder / "task.nc"], output=path)
