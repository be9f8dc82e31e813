"""What the interactive page shows of an experiment, as plain data.

Numbers of points are those of the reduced dataset, to the last bit; curves and time series, which
are only looked at, are rounded.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from roughgas.base.errors import InputError
from roughgas.data.netcdf import read_netcdf
from roughgas.data.reduced import EQUILIBRATED, read_reduced, third_axis
from roughgas.show.page.series import exact, rounded, time_series
from roughgas.theory.prediction import equation_of, predicted_ratio

if TYPE_CHECKING:
    import xarray

NUMBERS = {
    "R": "R",
    "stderr": "R_stderr",
    "ci95": "R_ci95",
    "seeds": "n_seeds",
    "collisions": "collisions",
    "seconds": "kernel_seconds",
}
"""What is shown of a point: its name in the page, and in the reduced dataset."""
GRID = np.linspace(-1.0, 1.0, 161)
"""Roughness at which theory is drawn as a curve."""


class Run(NamedTuple):
    """Where a seed of a point is, and the attributes of its dataset."""

    path: Path
    about: dict[str, Any]


Runs = dict[tuple[Any, ...], Run]
"""Seed 1 of each point, by its value on the third axis (None without one), r, and beta."""


def experiment(reduced_path: str | Path, points: Path) -> dict[str, Any]:
    """Return an experiment with its points and their theory.

    They are read from its reduced dataset, and from seed 1 of each point, anywhere below
    `points`/EXPERIMENT. Raises InputError where nothing spins, so that there is no R, and where a
    point is not there.
    """
    data = read_reduced(reduced_path)
    name, swept = data.attrs["experiment"], third_axis(data.attrs)
    if "R" not in data:
        raise InputError("experiment", name, "be one whose particles spin, to have an R")
    runs, variants = _first_seeds(points / name), {None: data}
    if swept is not None:
        variants = {one: data.sel({swept: one}) for one in data[swept].values.tolist()}
    return {
        "name": name,
        "scale": data.attrs["scale"],
        "particles": int(data.attrs["particles"]),
        "dimension": int(data.attrs["dimension"]),
        "swept": data.attrs.get("swept"),
        "theory": equation_of(data.attrs).name,
        "variants": [
            _variant(one.assign_attrs({swept: value} if swept else {}), value, runs)
            for value, one in variants.items()
        ],
    }


def _variant(data: "xarray.Dataset", value: Any, runs: Runs) -> dict[str, Any]:
    """Return one value on the third axis: a series for each r, the most elastic first."""
    rows = [data.sel(r=r) for r in sorted(data.r.values.tolist(), reverse=True)]
    series = [_series(row, value, runs) for row in rows if row.n_seeds.any()]
    return {"name": series[0].pop("variant"), "series": series}


def _series(data: "xarray.Dataset", value: Any, runs: Runs) -> dict[str, Any]:
    """Return all points at one r, over beta, with the curve that theory has for them."""
    r, places = data.r.item(), [data.sel(beta=beta) for beta in data.beta[data.n_seeds > 0]]
    found = [_run(runs, value, r, place.beta.item()) for place in places]
    return {
        "r": found[0].about["r_label"],
        "variant": found[0].about.get("variant"),
        "curve": rounded(predicted_ratio(data.attrs, r, GRID)),
        "points": [_point(*one) for one in zip(places, found, strict=True)],
    }


def _point(data: "xarray.Dataset", run: Run) -> dict[str, Any]:
    seeds = run.path.parent
    return {name: exact(data[column]) for name, column in NUMBERS.items()} | {
        "beta": run.about["beta_label"],
        "theory": exact(predicted_ratio(data.attrs, data.r.item(), data.beta.item())),
        "steady": bool(data.equilibrated > EQUILIBRATED),
        "contact_time": exact(data.get("contact_time_fraction", 0.0)),
        "target": str(seeds if seeds.name == "seeds" else run.path),  # as Snakemake knows it
        "command": run.about["command"],
        "over_time": time_series(read_netcdf(run.path)),
    }


def _first_seeds(folder: Path) -> Runs:
    """Find seed 1 of all points in a folder."""
    import netCDF4

    found: Runs = {}
    for path in sorted(folder.rglob("seed1.nc")):
        with netCDF4.Dataset(path) as file:
            about = {name: file.getncattr(name) for name in file.ncattrs()}
        found.setdefault(
            _place(about.get("swept_value"), about["r"], about["beta"]), Run(path, about)
        )
    return found


def _run(runs: Runs, *place: Any) -> Run:
    if _place(*place) not in runs:
        where = ", ".join(str(part) for part in place if part is not None)
        raise InputError("point (..., r, beta)", where, "have its seed 1 in the folder of points")
    return runs[_place(*place)]


def _place(value: Any, r: float, beta: float) -> tuple[Any, ...]:
    """Return the place of a point; a number is one even if words beside it made it a word."""
    try:
        return float(value), float(r), float(beta)
    except (TypeError, ValueError):
        return value, float(r), float(beta)
