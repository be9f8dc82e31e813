"""A dataset of each kind that the pipeline writes, small and made up, as files."""

import numpy as np
import xarray as xr
from tests.study_modules import ROOT, module_of_study

from roughgas.base import sorted_json
from roughgas.data.netcdf import content_of, write_netcdf
from roughgas.data.point import Point, write_point
from roughgas.results.reduce import reduce_points
from roughgas.tasks.running import combine

COVERAGE = ROOT / "studies" / "coverage"
COMBINE = f"combine {COVERAGE} {{}} --modules coverage -o out.nc --table out.md"
"""The command line that combines the task among the files."""
DRAW = f"figure {COVERAGE} coverage {{}} --shows coverage -o out.png"
"""The command line that draws the figure of coverage."""

ATTRIBUTES = {
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
        coordinates = {"r": r, "swept": "floor.wave", "swept_value": wave}
        for seed in (1, 2):
            new_point = point(seed + 10 * number)
            path = folder / f"points/{wave}{r}_{seed}.nc"
            write_point(
                path, new_point._replace(attributes=ATTRIBUTES | coordinates | {"seed": seed})
            )
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
        ATTRIBUTES | {"title": "made up"},
    )


def write_studies(path, folder):
    """A study of coverage whose repetitions are random numbers."""
    corners = [{"experiment": "gas", "r": "0.9", "beta": "0"}]
    settings = {"seed": 1, "repetitions": 8, "pooled": 2, "corners": corners}
    rng = np.random.default_rng(3)
    coverage = module_of_study("coverage", "coverage")
    datasets = [
        {prefix + name: (dim, rng.random(count)) for name in coverage.RUN_VARIABLES}
        for prefix, dim, count in (("", "run", 8), ("truth_", "long_run", 4))
    ]
    data = xr.Dataset(datasets[0] | datasets[1] | {"cpu_seconds": 1.0, "window": 1.0})
    (task,) = coverage.tasks(settings)
    text = sorted_json({"study": settings, "experiments": {}})
    attributes = {"study": "coverage", "task": task, "scale": "small", "settings_json": text}
    write_netcdf(folder / "task.nc", content_of(data.assign_attrs(attributes)))
    combined_coverage(folder / "task.nc", path)


def combined_coverage(task, path):
    """Write the dataset of coverage, whose only task lies at `task`, to `path`."""
    table = path.with_suffix(".md")
    combine(COVERAGE, [task], modules=["coverage"], output=path, table=table)
    table.unlink()
