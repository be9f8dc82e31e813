"""What the interactive page shows of an experiment, as plain data.

Numbers of points are those of the reduced dataset, to the last bit; curves and time series, which
are only looked at, are rounded.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from roughgas.base.errors import InputError
from roughgas.data.reduced import EQUILIBRATED, read_reduced, third_axis
from roughgas.show.page.numbers import exact, rounded
from roughgas.show.page.series import time_series
from roughgas.theory.prediction import equation_of, predicted_ratio

if TYPE_CHECKING:
    import xarray

Place = tuple[Any, ...]
"""(r, beta), before them the value on the third axis where there is one."""

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
    """Where a seed of a point is, and what its dataset says of itself."""

    path: Path
    about: dict[str, Any]


def experiment(reduced_path: str | Path, points: Path) -> dict[str, Any]:
    """An experiment with its points and their theory, from its reduced dataset and from seed 1 of
    each point, anywhere below `points`/EXPERIMENT.

    Raises InputError where nothing spins, so that there is no R, and where a point is not there.
    """
    data = read_reduced(reduced_path)
    name, swept = data.attrs["experiment"], third_axis(data.attrs)
    if "R" not in data:
        raise InputError("experiment", name, "be one whose particles spin, to have an R")
    runs = _runs(points / name)
    values = [None] if swept is None else data[swept].values.tolist()
    return {
        "name": name,
        "scale": data.attrs["scale"],
        "particles": int(data.attrs["particles"]),
        "dimension": int(data.attrs["dimension"]),
        "swept": data.attrs.get("swept"),
        "theory": equation_of(data.attrs).name,
        "variants": [_variant(data, swept, value, runs) for value in values],
    }


def _variant(
    data: "xarray.Dataset", swept: str | None, value: Any, runs: dict[Place, Run]
) -> dict[str, Any]:
    """One value on the third axis: a series over beta for each r, the most elastic first."""
    before: Place = ()
    if swept is not None:
        data, before = data.sel({swept: value}).assign_attrs({swept: value}), (value,)
    rows = [(r, data.sel(r=r)) for r in sorted(data.r.values.tolist(), reverse=True)]
    series = [_series(row, (*before, r), runs) for r, row in rows if row.n_seeds.any()]
    return {"name": series[0].pop("variant"), "series": series}


def _series(data: "xarray.Dataset", place: Place, runs: dict[Place, Run]) -> dict[str, Any]:
    """All points at one r, with the curve that theory has for them."""
    betas = data.beta.values[data.n_seeds.values > 0].tolist()
    found = [_run((*place, beta), runs) for beta in betas]
    places = [data.sel(beta=beta) for beta in betas]
    return {
        "r": found[0].about["r_label"],
        "variant": found[0].about.get("variant"),
        "curve": rounded(predicted_ratio(data.attrs, place[-1], GRID)),
        "points": [_point(one, run) for one, run in zip(places, found, strict=True)],
    }


def _point(data: "xarray.Dataset", run: Run) -> dict[str, Any]:
    numbers = {name: exact(data[column]) for name, column in NUMBERS.items()}
    touched = data["contact_time_fraction"] if "contact_time_fraction" in data else 0.0
    seeds = run.path.parent
    return numbers | {
        "beta": run.about["beta_label"],
        "theory": exact(predicted_ratio(data.attrs, data.r.item(), data.beta.item())),
        "steady": bool(data.equilibrated > EQUILIBRATED),
        "contact_time": exact(touched),
        "target": str(seeds if seeds.name == "seeds" else run.path),  # as Snakemake knows it
        "command": run.about["command"],
        "over_time": time_series(run.path),
    }


def _runs(folder: Path) -> dict[Place, Run]:
    """Seed 1 of all points in a folder."""
    import netCDF4

    found: dict[Place, Run] = {}
    for path in sorted(folder.rglob("seed1.nc")):
        with netCDF4.Dataset(path) as file:
            about = {name: file.getncattr(name) for name in file.ncattrs()}
        swept = [about["swept_value"]] if "swept" in about else []
        place = tuple(map(_number, (*swept, about["r"], about["beta"])))
        found.setdefault(place, Run(path, about))
    return found


def _run(place: Place, runs: dict[Place, Run]) -> Run:
    known = tuple(map(_number, place))
    if known not in runs:
        where = ", ".join(map(str, place))
        raise InputError("point (..., r, beta)", where, "have its seed 1 in the folder of points")
    return runs[known]


def _number(value: Any) -> Any:
    """A number as such, also where words beside it have made it one."""
    try:
        return float(value)
    except ValueError:
        return value
