"""The interactive page: one HTML file that holds its data and its program, and loads nothing.

Numbers of points are those of the reduced dataset, to the last bit; curves and time series, which
are only looked at, are rounded.
"""

import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from roughgas.base import InputError, from_json
from roughgas.base.files import PACKAGE
from roughgas.config.reading import read_yaml
from roughgas.data.netcdf import POINT, attributes_of, opened, require
from roughgas.data.point import read_point
from roughgas.data.reduced import EQUILIBRATED, particles_of, read_reduced, third_axis
from roughgas.data.variables import CLOCKS
from roughgas.show import pages
from roughgas.show.style import LOOKS
from roughgas.statistics.errors import block_means
from roughgas.theory.prediction import equation_of, over_collisions, predicted_ratio

DASHES: dict[Any, list[int]] = {"-": [0], "--": [6, 4], "-.": [6, 3, 1, 3]}  # in pixels
NUMBERS = {
    "R": "R",
    "stderr": "R_stderr",
    "ci95": "R_ci95",
    "collisional": "R_collisional",
    "collisional_stderr": "R_collisional_stderr",
    "seeds": "n_seeds",
    "collisions": "collisions",
    "seconds": "kernel_seconds",
}
"""What is shown of a point: its name in the page, and in the reduced dataset, if it is there."""
GRID = -np.cos(np.linspace(0.0, np.pi, 241))
"""Roughness at which theory is drawn as a curve, closest where it is steepest: at the ends."""
PROGRAM = ("uplot/uPlot.iife.min.js", "picture.js", "plots.js", "explore.js")
LONGEST, LEAST = 200, 40
"""The most values that are shown of a time series, and the fewest where there are many points."""
PLACES = 60_000
"""Values of all time series together, about: with them the page has less than 3 MB."""
DIGITS = 5


def write_page(
    inputs: Iterable[str | Path],
    *,
    points: str | Path,
    output: str | Path,
    config: str | Path | None = None,
) -> None:
    """Write the page of the experiments whose reduced datasets are `inputs`, in this order.

    The folder `points` has seed 1 of each of their points, as the pipeline leaves it; `config` (by
    default the package's own) describes them. Raises InputError where a point is missing, where
    nothing spins, and for several scales at once.
    """
    known = read_yaml(config or PACKAGE / "config.yaml")["experiments"]
    paths = list(inputs)
    number = sum(int((read_reduced(path).n_seeds > 0).sum()) for path in paths)
    longest = min(LONGEST, max(LEAST, PLACES // max(number, 1)))
    experiments = [experiment(path, Path(points), longest) for path in paths]
    for one in experiments:
        described = known.get(one["name"], {}).get("description", one["name"].replace("_", " "))
        one["description"] = described.rstrip(".")
    scales = sorted({one["scale"] for one in experiments})
    if len(scales) != 1:
        raise InputError("scale of the datasets", " and ".join(scales) or "none", "be one")
    looks = [
        {"colour": one.colour, "symbol": one.marker, "dash": DASHES.get(one.line) or one.line[1]}
        for one in LOOKS
    ]
    data = {"scale": scales[0], "grid": rounded(GRID), "looks": looks, "experiments": experiments}
    pages.write_page(
        output,
        "page/explore.html",
        ["page/uplot/uPlot.min.css", "page/explore.css"],
        [pages.text_of(f"page/{name}") for name in PROGRAM],
        scale=scales[0],
        data=pages.markup(pages.data_of(data)),
    )


def experiment(reduced_path: str | Path, points: Path, longest: int = LONGEST) -> dict[str, Any]:
    """Return an experiment with its points and their theory, and `longest` values of each series.

    They are read from its reduced dataset, and from seed 1 of each point, anywhere below
    `points`/EXPERIMENT. Raises InputError where nothing spins, so that there is no R, and where a
    point is not there.
    """
    data = read_reduced(reduced_path)
    name, swept = data.attrs["experiment"], third_axis(data.attrs)
    if "R" not in data:
        raise InputError("experiment", name, "be one whose particles spin, to have an R")
    runs, variants = _first_seeds(points / name), [(None, data)]
    if swept is not None:
        values = data[swept].values.tolist()
        variants = [(one, data.sel({swept: one}).assign_attrs({swept: one})) for one in values]
    about: dict[str, Any] = next((about for _, about in runs.values()), {})
    settings = from_json(about.get("experiment_json", "{}"), "settings")
    size = {"box": settings.get("box"), "packing": about.get("packing")}
    return {
        "name": name,
        "scale": data.attrs["scale"],
        "particles": particles_of(data),
        **(dict.fromkeys(size) if swept in ("box", "packing", "particles") else size),
        "dimension": int(data.attrs["dimension"]),
        "swept": data.attrs.get("swept"),
        "theory": equation_of(data.attrs).name,
        "over_collisions": over_collisions(data.attrs, data),
        "effects": list(settings.get("effects", {})),
        "variants": [_variant(one, value, runs, longest) for value, one in variants],
    }


def _variant(data, value, runs, longest):
    """Return one value on the third axis: a series for each r, the most elastic first."""
    rows = [data.sel(r=r) for r in sorted(data.r.values.tolist(), reverse=True)]
    series = [_series(row, value, runs, longest) for row in rows if row.n_seeds.any()]
    return {"name": series[0].pop("variant"), "series": series}


def _series(data, value, runs, longest):
    """Return all points at one r, over beta, with the curve that theory has for them."""
    r, places = data.r.item(), [data.sel(beta=beta) for beta in data.beta[data.n_seeds > 0]]
    found = [_run(runs, value, r, place.beta.item()) for place in places]
    _, about = found[0]
    return {
        "r": about["r_label"],
        "variant": about.get("variant"),
        "curve": rounded(predicted_ratio(data.attrs, r, GRID)),
        "points": [_point(*one, longest) for one in zip(places, found, strict=True)],
    }


def _point(data, run, longest):
    path, about = run
    shown = {name: exact(data[column]) for name, column in NUMBERS.items() if column in data}
    return shown | {
        "beta": about["beta_label"],
        "theory": exact(predicted_ratio(data.attrs, data.r.item(), data.beta.item())),
        # None where there is too little to tell
        "steady": None if data.equilibrated < 0 else bool(data.equilibrated > EQUILIBRATED),
        "contact_time": exact(data.get("contact_time_fraction", 0.0)),
        # as Snakemake knows it
        "target": str(path.parent if path.parent.name == "seeds" else path),
        "command": about["command"],
        "over_time": time_series(read_point(path), longest),
    }


def _first_seeds(folder):
    """Return where seed 1 of each point in a folder is, and the attributes of its dataset, by the
    point's place: its value on the third axis (None without one), r, and beta."""
    found = {}
    for path in sorted(folder.rglob("seed1.nc")):
        with opened(path, POINT) as file:
            about = attributes_of(file)
        require(about, ("r_label", "beta_label", "command"), path)
        place = _place(about.get("swept_value"), about["r"], about["beta"])
        found.setdefault(place, (path, about))
    return found


def _run(runs, *place):
    if _place(*place) not in runs:
        where = ", ".join(str(part) for part in place if part is not None)
        raise InputError("point (..., r, beta)", where, "have its seed 1 in the folder of points")
    return runs[_place(*place)]


def _place(value, r, beta):
    """Return the place of a point; a number is one even if words beside it made it a word."""
    try:
        return float(value), float(r), float(beta)
    except (TypeError, ValueError):
        return value, float(r), float(beta)


def time_series(seed: Any, longest: int = LONGEST) -> dict[str, Any]:
    """Return R and both energies of a seed (a Dataset) over time, as means over blocks, at most
    `longest` of them.

    `clock` is "time", in T, or "collisions_per_particle"; `block` is the number of samples in a
    mean; `measured` is the window in which R is measured, its ends None where they are unknown.
    """
    clock = next(name for name in CLOCKS[::-1] if name in seed)
    columns = {"at": seed[clock].values} | {
        name: seed[f"{name}_series"].values for name in ("R", "E_trans", "E_rot")
    }
    window = [exact(seed.get(name, math.nan)) for name in ("measured_from", "plateau_end")]
    block = math.ceil(columns["at"].size / longest)
    thinned = {name: rounded(block_means(values, block)) for name, values in columns.items()}
    return {"clock": clock, "block": block, "measured": window} | thinned


def exact(value: Any) -> float | int | None:
    """Return a number as it is, to the last bit; None if it is not finite."""
    number = np.asarray(value).item()
    return number if math.isfinite(number) else None


def rounded(values: Any) -> list[float | None]:
    """Return numbers to DIGITS digits, for what is only looked at; None if one is not finite."""
    return [float(f"{x:.{DIGITS}g}") if math.isfinite(x) else None for x in np.asarray(values)]
