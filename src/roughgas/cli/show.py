"""`roughgas show`: a summary of any dataset that the pipeline writes."""

import json
import math
from argparse import Namespace
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from xarray import Dataset

from roughgas.base.layout import as_json, columns, from_json
from roughgas.data import opening
from roughgas.data.netcdf import read_netcdf, unit_of
from roughgas.data.reduced import EQUILIBRATED, particles_of, third_axis
from roughgas.results.table import rows as rows_of
from roughgas.results.table import why_wide
from roughgas.statistics.estimate import Estimate, decimals_of
from roughgas.theory.prediction import equation_of, predicted_ratio

QUOTED = {
    opening.POINT: ("experiment_json", "command"),
    opening.FILM: ("settings_json", "packing", "r", "beta", "seed", "command"),
    opening.TASK: ("settings_json",),
}
"""Attributes of each kind that a summary quotes."""
BOOKS = {"source", "motion", "energy_input", "energy_gain", "energy_imbalance"}
SHAPES = {2: "disks", 3: "spheres"}
BLOCKS, WIDTH = "▁▂▃▄▅▆▇█", 48
FRAMES = 8  # of a film, that are shown
FILMED = ("collisions_per_particle", "time", "E_trans", "R")
MOST_VALUES = 4  # of a variable, that are all shown
UNIT = "T (cooling gas: collisions per particle)"
MEANING = {
    "transient": f"until energies are steady, in {UNIT}",
    "autocorrelation_time": f"of R, in {UNIT}",
    "variance": "of the mean of R over a length of one",
    "dof": "degrees of freedom of the variance",
    "pace": "collisions per particle in a length of one",
    "seconds_per_length": "s of CPU time",
    "settled": "whether a steady state was found",
    "length": f"that was simulated, in {UNIT}",
    "seconds": "s of CPU time that the pilot took",
}


def show(options: Namespace) -> None:
    """Print summaries, an empty line between them."""
    for number, path in enumerate(options.files):
        if options.json:
            kind, data = _read(path)
            attributes = {"attributes": data.attrs} if hasattr(data, "attrs") else {}
            about = {"file": path, "kind": kind} | attributes
            print(as_json(about | KINDS[kind][1](data), indent=None))
        else:
            print("\n" * (number > 0) + summary(path))


def summary(path: str | Path) -> str:
    """Return the text about a dataset. Raises InputError for files of other programs."""
    kind, data = _read(path)
    return f"{path}: {kind}\n\n{KINDS[kind][0](data)}"


def _read(path: str | Path) -> tuple[str, Any]:
    """Return the kind of a file, one of KINDS, and what is in it."""
    from roughgas.planning.pilot import read_pilot
    from roughgas.studies.variables import read_studies

    if Path(path).suffix == ".json":
        return "pilot of a point", read_pilot(path)
    with opening.opened(path) as file:
        kind = opening.kind_of(file)
        opening.require(opening.attributes_of(file), QUOTED.get(kind or "", ()), path)
    data = read_studies(path) if kind == opening.STUDIES else read_netcdf(path)
    return (kind or "").removeprefix("a "), data


def _scalars(data: Dataset) -> dict[str, Any]:
    """Return the single numbers of a dataset by name, flags as True and False."""
    return {
        str(name): bool(one) if "flag_meanings" in one.attrs else one.values.item()
        for name, one in data.variables.items()
        if not one.dims
    }


def _cost(data: Dataset) -> list[str]:
    collisions, seconds = int(data.collisions), float(data.kernel_seconds)
    rate = f", {float(f'{collisions / seconds:.2g}'):,.0f} a second" if seconds > 0.0 else ""
    return ["cost", f"{collisions:,} collisions in {seconds:.2f} s of CPU time{rate}"]


def _point_record(point: Dataset) -> dict[str, Any]:
    """Return the single numbers of a point, and those of theory where particles spin."""
    found = _scalars(point)
    if "R" in found:
        expected = _theory(point)
        found |= {"R_theory": expected, "residual": found["R"] - expected}
    return {"variables": found}


def _point_text(point: Dataset) -> str:
    about = point.attrs
    variant = f"/{about['variant']}" if "variant" in about else ""
    rows = [
        ["experiment", f"{about['experiment']}{variant}, scale {about['scale']}"],
        *_settings(about, about["experiment_json"]),
        ["", ""],
        *(_ratio(point) if "R" in point else []),
    ]
    for name in ("E_trans", "E_rot"):
        if name in point:
            value = Estimate(float(point[name]), float(point.get(f"{name}_stderr", math.nan)))
            rows.append([name, f"{value} {unit_of(point[name].attrs)}, per degree of freedom"])
    rows += [["steady state", _steady(point)], _cost(point)]
    books = [_books(point)] if BOOKS <= set(point.variables) else []
    return "\n\n".join([columns(rows), *books, f"To make it again:\n{about['command']}"])


def _film_text(film: Dataset) -> str:
    about, last = film.attrs, film.sizes["frame"] - 1
    head = [
        *_settings(about, about["settings_json"]),
        ["packing", f"{about['packing']:.4g}"],
        ["frames", f"{last + 1}, of {film.sizes['x']} x {film.sizes['y']} cells"],
        _cost(film),
    ]
    table = [["frame", "collisions per particle", "time / T", "E_trans / initial", "R"]]
    for k in sorted({round(k * last / (FRAMES - 1)) for k in range(FRAMES)}):
        table.append([str(k), *(f"{float(film[name][k]):.5g}" for name in FILMED)])
    again = f"To make it again:\n{about['command']}"
    return "\n\n".join([columns(head), columns(table, numbers=True), again])


def _settings(about: Mapping[str, Any], text: str) -> list[list[str]]:
    """Return rows with what was simulated, and for how long, from attributes and settings."""
    experiment = from_json(text, "settings of the dataset")
    opening.require(experiment, ("particles", "box", "effects"), "its settings")
    box = " x ".join(f"{side:g}" if side != "open" else "open" for side in experiment["box"])
    effects = [f"{name} ({_listed(one)})" for name, one in experiment["effects"].items()]
    rows = [
        ["point", f"r = {about['r']:g}, beta = {about['beta']:g}, seed {about['seed']}"],
        ["gas", f"{experiment['particles']} {SHAPES[len(experiment['box'])]}, box {box} a"],
        *(["" if k else "effects", one] for k, one in enumerate(effects)),
    ]
    schedule = experiment.get("schedule")  # a film has none
    return [*rows, ["schedule", _listed(schedule)]] if schedule else rows


def _listed(settings: Mapping[str, Any]) -> str:
    return ", ".join(f"{name} {value}" for name, value in settings.items())


def _theory(point: Dataset) -> float:
    about = point.attrs | {"theory": equation_of(point.attrs, point).kind}
    return float(predicted_ratio(about, about["r"], about["beta"]))


def _ratio(point: Dataset) -> list[list[str]]:
    R, half, expected = float(point.R), float(point.R_ci95), _theory(point)
    digits = decimals_of(half) if 0.0 < half < 1.0 else 4
    trust = "" if point.R_ci95_trusted else " (the run is too short to trust it)"
    off = f"{abs(R - expected):.4f} {'below' if R < expected else 'above'}"
    series = point.R_series.values[np.isfinite(point.R_series.values)]
    parts = np.array([part.mean() for part in np.array_split(series, min(WIDTH, len(series)))])
    low, high = parts.min(), parts.max()
    heights = (parts - low) / ((high - low) or 1.0) * (len(BLOCKS) - 1)
    blocks = "".join(BLOCKS[round(height)] for height in heights)
    return [
        ["R", f"{Estimate(R, float(point.R_stderr))}"],
        ["95 % interval", f"{R - half:.{digits}f} to {R + half:.{digits}f}{trust}"],
        ["theory", f"{expected:.4f}, {equation_of(point.attrs, point).name}: R is {off} it"],
        ["R(t)", f"{blocks}  {low:.3f} to {high:.3f}"],
    ]


def _steady(point: Dataset) -> str:
    found = "yes" if point.equilibrated else "NOT found: energies or R still drift"
    end = f" to {float(point.plateau_end):g}" if "plateau_end" in point else " on"
    units = unit_of(point.measured_from.attrs)
    return f"{found}; measured from {float(point.measured_from):g}{end}, in {units}"


def _books(point: Dataset) -> str:
    """Return what each source has put into each motion."""
    rows = [["energy put in, per particle", *point.motion.values]]
    for source, energies in zip(point.source.values, point.energy_input.values, strict=True):
        rows.append([f"  {source}", *(f"{one:.6g}" for one in energies)])
    rows.append(["  what the gas has gained", *(f"{one:.6g}" for one in point.energy_gain.values)])
    imbalance, units = float(point.energy_imbalance), unit_of(point.energy_gain.attrs)
    return f"{columns(rows, numbers=True)}\n  in {units}; energy balance closes to {imbalance:.1g}"


def _reduced_record(data: Dataset) -> dict[str, Any]:
    rows = rows_of(data)
    return {"points": [{k: value for k, value in row.items() if value != ""} for row in rows]}


def _reduced_text(data: Dataset) -> str:
    about, swept = data.attrs, third_axis(data.attrs)
    axes = [*([swept] if swept else []), "r", "beta"]
    found = ["R", "95 %", "theory", "residual"] if "R" in data else ["E_trans"]
    table = [[*axes, "seeds", *found, "steady"]]
    for row in rows_of(data):
        values = [row["value"], row["r"], row["beta"]][-len(axes) :]
        place = [value if isinstance(value, str) else f"{value:g}" for value in values]
        steady = "yes" if row["equilibrated"] > EQUILIBRATED else "NO"
        table.append([*place, f"{row['n_seeds']:.0f}", *_found(row), steady])
    over = f"{swept}, r and beta" if swept else "r and beta"
    head = [
        ["experiment", f"{about['experiment']}, scale {about['scale']}"],
        ["gas", f"{particles_of(data)} {SHAPES[int(about['dimension'])]}"],
        ["points", f"{len(table) - 1} over {over}"],
        _cost(data.sum()),
    ]
    note = "Energies per degree of freedom; their error is the scatter over seeds."
    if "R" in data:
        note = "95 %: half width of the interval; ?: it may be too narrow, as the run is short."
        note += f"{why_wide(data)}\nTheory: {equation_of(about).name}."
    return f"{columns(head)}\n\n{columns(table, numbers=True)}\n\n{note}"


def _found(row: dict[str, Any]) -> list[str]:
    """Return the cells of the result; a column that is not there is empty in `row`."""
    name = "R" if row["R"] != "" else "E_trans"
    value = f"{Estimate(row[name], row[f'{name}_stderr'] or math.nan)}"
    if name == "E_trans":
        return [value]
    half = f"{row['R_ci95']:.4f}{'' if row['R_ci95_trusted'] == 1.0 else '?'}"
    return [value, half, f"{row['R_theory']:.4f}", f"{row['residual']:+.4f}"]


def _task_text(data: Dataset) -> str:
    about = data.attrs
    chosen = json.loads(about["settings_json"])["study"]
    head = [["task", f"{about['task']} of the study {about['study']}, scale {about['scale']}"]]
    head += [[key, str(one)] for key, one in chosen.items() if not isinstance(one, dict | list)]
    table = [["variable", "over", "value"]]
    for name, one in data.variables.items():
        over = ", ".join(f"{dim} ({data.sizes[dim]})" for dim in one.dims)
        table.append([str(name), over, _values(one.values)])
    again = f"roughgas study {about['study']} {about['task']} --scale {about['scale']} -o task.nc"
    return "\n\n".join([columns(head), columns(table), f"To make it again: {again}"])


def _values(values: np.ndarray) -> str:
    """Return few values as they are, many as their range."""
    if values.size <= MOST_VALUES or values.dtype.kind not in "fiu":
        few = values.ravel()[:MOST_VALUES]
        return ", ".join(str(one) if isinstance(one, str) else f"{one:.5g}" for one in few)
    there = values[np.isfinite(values)]
    if not there.size:
        return "nothing"
    return f"{there.min():.5g} to {there.max():.5g}, {there.mean():.5g} on average"


def _task_record(data: Dataset) -> dict[str, Any]:
    return {"sizes": dict(data.sizes), "variables": _scalars(data)}


def _studies_record(studies: Mapping[str, Dataset]) -> dict[str, Any]:
    found = {name: {"attributes": one.attrs} | _task_record(one) for name, one in studies.items()}
    return {"studies": found}


def _studies_text(studies: Mapping[str, Dataset]) -> str:
    from roughgas.studies.tables import TABLES

    scales = {data.attrs["scale"] for data in studies.values()}
    parts = [TABLES[name](data).strip() for name, data in studies.items()]
    return "\n\n".join([f"scale {', '.join(sorted(scales))}", *parts])


def _pilot_text(pilot: Any) -> str:
    rows = []
    for name, value in pilot._asdict().items():
        shown = ("no", "yes")[value] if isinstance(value, bool) else f"{value:.5g}"
        rows.append([name, shown, MEANING[name]])
    error = f"{(pilot.variance / 1000.0) ** 0.5:.2g}"
    return f"{columns(rows)}\n\nA run that measures for a length of 1000 finds R to about {error}."


KINDS: dict[str, tuple[Callable[[Any], str], Callable[[Any], dict[str, Any]]]] = {
    "point": (_point_text, _point_record),
    "film of a cooling gas": (
        _film_text,
        lambda film: {"frames": film.sizes["frame"], "variables": _scalars(film)},
    ),
    "reduced dataset": (_reduced_text, _reduced_record),
    "task of a study": (_task_text, _task_record),
    "dataset of studies": (_studies_text, _studies_record),
    "pilot of a point": (_pilot_text, lambda pilot: {"variables": pilot._asdict()}),
}
"""The kinds of files: what a person reads of each, and what a script reads."""
