"""The interactive page: an HTML file that contains its data and its program, and loads nothing.

Results of points have all bits of the reduced dataset; curves and time series, which are only
plotted, are rounded. Functions called *_record return a dictionary for JSON, in the form that the
page's program reads.

R = E_rot/(E_rot + E_trans), from energies per degree of freedom; r is the normal restitution, beta
the roughness. The coordinates of a point are its value on the third axis of the sweep (None without
a third axis), r, and beta.
"""

import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from roughgas.base import InputError, NamedValues, from_json
from roughgas.base.files import PACKAGE
from roughgas.base.reading import read_yaml
from roughgas.data.netcdf import POINT, attributes_of, opened, require
from roughgas.data.point import read_point
from roughgas.data.reduced import STEADY_SHARE, particles_of, read_reduced
from roughgas.data.variables import CLOCKS, third_axis
from roughgas.show import pages
from roughgas.show.style import LINE_STYLES
from roughgas.statistics.errors import block_means
from roughgas.theory.prediction import describe_collisional_average, equation_of, predicted_ratio

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
"""Results of a point: names in the page, and in the reduced dataset, which may lack some."""
GRID = -np.cos(np.linspace(0.0, np.pi, 241))
"""Roughness along curves of theory, densest at the ends, where the curves are steepest."""
PROGRAM = ("uplot/uPlot.iife.min.js", "picture.js", "plots.js", "explore.js")
MAX_SERIES_LENGTH, MIN_SERIES_LENGTH = 200, 40
"""Largest length of a time series in the page, and its length if there are many points."""
MAX_SERIES_VALUES = 60_000
"""Approximate length of all time series together; it keeps the page below 3 MB."""
DIGITS = 5


def write_page(
    inputs: Iterable[str | Path],
    *,
    points: str | Path,
    output: str | Path,
    config: str | Path | None = None,
) -> None:
    """Write the page of the experiments whose reduced datasets are `inputs`, in this order.

    The folder `points` has the datasets of seed 1 of all points, laid out as by the pipeline.
    Descriptions of experiments are in `config`, by default the package's configuration. Raises
    InputError if a point is missing, if particles do not spin, and for several scales.
    """
    descriptions = read_yaml(config or PACKAGE / "config.yaml")["experiments"]
    paths = list(inputs)
    number = sum(int((read_reduced(path).n_seeds > 0).sum()) for path in paths)
    length = min(MAX_SERIES_LENGTH, max(MIN_SERIES_LENGTH, MAX_SERIES_VALUES // max(number, 1)))
    experiments = [experiment(path, Path(points), length) for path in paths]
    for record in experiments:
        description = descriptions.get(record["name"], {}).get(
            "description", record["name"].replace("_", " ")
        )
        record["description"] = description.rstrip(".")
    scales = sorted({record["scale"] for record in experiments})
    if len(scales) != 1:
        raise InputError("scale of the datasets", " and ".join(scales) or "none", "be one")
    looks = [
        {
            "colour": style.colour,
            "symbol": style.marker,
            "dash": DASHES.get(style.line) or style.line[1],
        }
        for style in LINE_STYLES
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


def experiment(
    reduced_path: str | Path, points: Path, length: int = MAX_SERIES_LENGTH
) -> NamedValues:
    """Return a dictionary for JSON of an experiment: its settings, theory, and points, with time
    series of up to `length` values.

    It is read from the reduced dataset at `reduced_path`, and from seed 1 of each point below
    `points`/EXPERIMENT. Raises InputError if particles do not spin, so that there is no R, and if a
    point is missing.
    """
    data = read_reduced(reduced_path)
    name, swept = data.attrs["experiment"], third_axis(data.attrs)
    if "R" not in data:
        raise InputError("experiment", name, "be one whose particles spin, to have an R")
    runs, variants = _first_seeds(points / name), [(None, data)]
    if swept is not None:
        values = data[swept].values.tolist()
        variants = [
            (value, data.sel({swept: value}).assign_attrs({swept: value})) for value in values
        ]
    attributes: dict[str, Any] = next((attributes for _, attributes in runs.values()), {})
    settings = from_json(attributes.get("experiment_json", "{}"), "settings")
    size = {"box": settings.get("box"), "packing": attributes.get("packing")}
    return {
        "name": name,
        "scale": data.attrs["scale"],
        "particles": particles_of(data),
        **(dict.fromkeys(size) if swept in ("box", "packing", "particles") else size),
        "dimension": int(data.attrs["dimension"]),
        "swept": data.attrs.get("swept"),
        "theory": equation_of(data.attrs).name,
        "over_collisions": describe_collisional_average(data.attrs, data),
        "effects": list(settings.get("effects", {})),
        "variants": [_variant_record(variant, value, runs, length) for value, variant in variants],
    }


def _variant_record(data, third_value, first_seeds, max_length):
    """Return the results at a single value on the third axis: points and theory for each r, in
    decreasing order of r.

    `data` is the part of the reduced dataset at `third_value`, `first_seeds` the result of
    `_first_seeds`; time series have up to `max_length` values.
    """
    rows = [data.sel(r=r) for r in sorted(data.r.values.tolist(), reverse=True)]
    series = [
        _series_record(row, third_value, first_seeds, max_length)
        for row in rows
        if row.n_seeds.any()
    ]
    return {"name": series[0].pop("variant"), "series": series}


def _series_record(data, third_value, first_seeds, max_length):
    """Return the results at a single r: its points over beta, and the curve of theory.

    `data` is the part of the reduced dataset at this r and at `third_value`, `first_seeds` the
    result of `_first_seeds`; time series have up to `max_length` values.
    """
    r, points = data.r.item(), [data.sel(beta=beta) for beta in data.beta[data.n_seeds > 0]]
    seed_runs = [_first_seed_at(first_seeds, third_value, r, point.beta.item()) for point in points]
    _, attributes = seed_runs[0]
    return {
        "r": attributes["r_label"],
        "variant": attributes.get("variant"),
        "curve": rounded(predicted_ratio(data.attrs, r, GRID)),
        "points": [
            _point_record(*pair, max_length) for pair in zip(points, seed_runs, strict=True)
        ],
    }


def _point_record(data, first_seed, max_length):
    """Return the results at a point: averages, theory, command, and time series of its seed 1.

    `data` is the part of the reduced dataset at this point, `first_seed` the path and attributes of
    its seed 1; time series have up to `max_length` values.
    """
    path, attributes = first_seed
    shown = {name: exact(data[column]) for name, column in NUMBERS.items() if column in data}
    return shown | {
        "beta": attributes["beta_label"],
        "theory": exact(predicted_ratio(data.attrs, data.r.item(), data.beta.item())),
        # None if too little was measured to decide
        "steady": None if data.equilibrated < 0 else bool(data.equilibrated > STEADY_SHARE),
        "contact_time": exact(data.get("contact_time_fraction", 0.0)),
        # the path that Snakemake makes
        "target": str(path.parent if path.parent.name == "seeds" else path),
        "command": attributes["command"],
        "over_time": time_series(read_point(path), max_length),
    }


def _first_seeds(folder):
    """Return the path and the attributes of seed 1 of each point in a folder, by the coordinates of
    the point."""
    first_seeds = {}
    for path in sorted(folder.rglob("seed1.nc")):
        with opened(path, POINT) as file:
            attributes = attributes_of(file)
        require(attributes, ("r_label", "beta_label", "command"), path)
        coordinates = _coordinates(
            attributes.get("swept_value"), attributes["r"], attributes["beta"]
        )
        first_seeds.setdefault(coordinates, (path, attributes))
    return first_seeds


def _first_seed_at(first_seeds, *coordinates):
    """Return the path and attributes of seed 1 of the point at `coordinates`, from `first_seeds`.
    Raises InputError if it is missing."""
    if _coordinates(*coordinates) not in first_seeds:
        coordinates_text = ", ".join(
            str(coordinate) for coordinate in coordinates if coordinate is not None
        )
        raise InputError(
            "point (..., r, beta)", coordinates_text, "have its seed 1 in the folder of points"
        )
    return first_seeds[_coordinates(*coordinates)]


def _coordinates(third_value, r, beta):
    """Return the coordinates of a point as numbers; only a `third_value` that is no number stays a
    word, or None.

    A third axis with both numbers and words stores its numbers as text.
    """
    try:
        return float(third_value), float(r), float(beta)
    except (TypeError, ValueError):
        return third_value, float(r), float(beta)


def time_series(seed: Any, length: int = MAX_SERIES_LENGTH) -> NamedValues:
    """Return R and both energies of a seed (a Dataset) over time, as means over at most `length`
    blocks, without the samples after the last whole block.

    The result has lists of equal length: `at`, the times, `R`, `E_trans` and `E_rot`. `clock` is
    the kind of times, "time", in T, or "collisions_per_particle"; `block` is the number of samples
    in a mean; `measured` is the window of the measurement, with None for unknown ends. Energies are
    per degree of freedom, in m a^2/T^2, of a cooling gas in units of its initial E_trans.
    """
    clock = next(name for name in CLOCKS[::-1] if name in seed)
    columns = {"at": seed[clock].values} | {
        name: seed[f"{name}_series"].values for name in ("R", "E_trans", "E_rot")
    }
    window = [exact(seed.get(name, math.nan)) for name in ("measured_from", "plateau_end")]
    size = columns["at"].size
    block = math.ceil(size / length)
    end = size // block * block  # a shorter last block would be noisier than the others
    thinned = {name: rounded(block_means(values[:end], block)) for name, values in columns.items()}
    return {"clock": clock, "block": block, "measured": window} | thinned


def exact(value: Any) -> float | int | None:
    """Return a scalar as a Python number with all its bits; None if it is not finite."""
    number = np.asarray(value).item()
    return number if math.isfinite(number) else None


def rounded(values: Any) -> list[float | None]:
    """Return numbers rounded to DIGITS significant digits; None for infinite ones and NaN."""
    return [float(f"{x:.{DIGITS}g}") if math.isfinite(x) else None for x in np.asarray(values)]
