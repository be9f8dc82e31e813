"""`roughgas show`: a summary of any dataset that the pipeline writes."""

import json
import math
from argparse import Namespace
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from xarray import Dataset

from roughgas import config
from roughgas.base import as_json, columns, from_json, on_one_line
from roughgas.base.files import module_of
from roughgas.data import netcdf
from roughgas.data.netcdf import read_netcdf, unit_of
from roughgas.data.reduced import EQUILIBRATED, particles_of, third_axis
from roughgas.data.variables import TRUSTED
from roughgas.effects.species import packing
from roughgas.results.products import rows as rows_of
from roughgas.results.products import why_wide
from roughgas.statistics.errors import NO, UNKNOWN, YES, Estimate, decimals_of
from roughgas.theory.prediction import (
    equation_of,
    like_theory,
    over_collisions,
    ratio_of_point,
)

FEW = 0.01
"""Share of contacts altered by the contact-time model, above which a result depends on it."""
OF_SPECIES = ("E_trans", "E_rot", "R")
PARTS = {"species", "other"}  # what is over nothing else is shown value by value
MOST_VALUES = 4  # of a variable, that are all shown
MOST_NAMES = 4  # of variables with the same reason for doubt
MARK = "?"
FLAGS = {YES: True, NO: False, UNKNOWN: None}
QUOTED = {netcdf.POINT: ("experiment_json", "command"), netcdf.TASK: ("settings_json",)}
"""Attributes of each kind that a summary quotes."""
BOOKS = {"source", "motion", "energy_input", "energy_gain", "energy_imbalance"}
SHAPES = {2: "disks", 3: "spheres"}
BLOCKS, WIDTH = "▁▂▃▄▅▆▇█", 48
TRUST = {
    YES: "",
    NO: " (not to be trusted: no steady state, or too short a run)",
    UNKNOWN: " (whether to trust it is not known: too little was measured)",
}
MET = {YES: "met", NO: "NOT met", UNKNOWN: "not known: too little was measured"}
STEADY = {
    YES: "yes",
    NO: "NOT found: energies or R still drift",
    UNKNOWN: "not known: too little was measured",
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
    lines = f"{path}: {kind}\n\n{KINDS[kind][0](data)}".split("\n")
    return "\n".join(map(on_one_line, lines))


def _read(path: str | Path) -> tuple[str, Any]:
    """Return the kind of a file, one of KINDS, and what is in it."""
    with netcdf.opened(path) as file:
        kind = netcdf.kind_of(file)
        netcdf.require(netcdf.attributes_of(file), QUOTED.get(kind or "", ()), path)
    data = netcdf.read_groups(path) if kind == netcdf.STUDIES else _printable(read_netcdf(path))
    return (kind or "").removeprefix("a "), data


def _printable(data: Dataset) -> Dataset:
    """Return a dataset whose attributes are all on one line: another program may have set them."""
    words = {name: on_one_line(one) for name, one in data.attrs.items() if isinstance(one, str)}
    return data.assign_attrs(words)


def _cost(data: Dataset) -> list[str]:
    collisions, seconds = int(data.collisions), float(data.kernel_seconds)
    rate = f", {float(f'{collisions / seconds:.2g}'):,.0f} a second" if seconds > 0.0 else ""
    return ["cost", f"{collisions:,} collisions in {seconds:.2f} s of CPU time{rate}"]


def _point_record(point: Dataset) -> dict[str, Any]:
    """Return the single numbers of a point, and those of theory where particles spin."""
    found = scalars(point)
    if "R" in found:
        expected = ratio_of_point(point)
        found |= {"R_theory": expected, "residual": found["R"] - expected}
    return {"variables": found}


def _point_text(point: Dataset) -> str:
    about = point.attrs
    variant = f"/{about['variant']}" if "variant" in about else ""
    rows = [
        ["experiment", f"{about['experiment']}{variant}, scale {about['scale']}"],
        *_settings(about),
        ["", ""],
        *(_ratio(point) if "R" in point else []),
        *_measured(point),
        _cost(point),
    ]
    parts = columns(rows), _by_species(point), observed(point), _books(point)
    return "\n\n".join([*filter(None, parts), f"To make it again:\n{about['command']}"])


def _settings(about: Mapping[str, Any]) -> Iterator[list[str]]:
    """Yield rows with what was simulated, and for how long, from attributes."""
    experiment = from_json(about["experiment_json"], "settings of the dataset")
    netcdf.require(experiment, ("particles", "box", "effects"), "its settings")
    noise = ", fresh noise for a saved state" if about.get("reseeded") else ""
    point = f"r = {about['r']:g}, beta = {about['beta']:g}, seed {about['seed']}{noise}"
    yield ["point", point]
    box = " x ".join(f"{side:g}" if side != "open" else "open" for side in experiment["box"])
    filled = "" if "open" in experiment["box"] else f", packing {packing(experiment):.3g}"
    shape = SHAPES[len(experiment["box"])]
    yield ["gas", f"{experiment['particles']} {shape}, box {box} a{filled}"]
    if layer := experiment.get("layer"):
        yield ["layer", f"{_listed(layer)}, in diameters and cycles"]
    for number, (name, one) in enumerate(experiment["effects"].items()):
        yield ["" if number else "effects", f"{name} ({_listed(one)})"]
    if schedule := experiment.get("schedule"):
        yield ["schedule", _listed(schedule)]


def _listed(settings: Mapping[str, Any]) -> str:
    return ", ".join(f"{name} {value}" for name, value in settings.items())


def _ratio(point: Dataset) -> Iterator[list[str]]:
    """Yield rows on R: its averages, their errors, and theory."""
    R, half = float(point.R), float(point.R_ci95)
    digits = decimals_of(half) if 0.0 < half < 1.0 else 4
    trust, over_time = TRUST[int(point.R_ci95_trusted)], "R_collisional" in point
    yield ["R", f"{_estimate(point, 'R')}{', averaged over time' * over_time}"]
    known = half > 0.0  # it is 0 where R never changes, as without contacts
    interval = f"{R - half:.{digits}f} to {R + half:.{digits}f}" if known else "not known"
    yield ["95 % interval", f"{interval}{trust}"]
    if lack := point.R_ci95_trusted.attrs.get("comment"):
        yield ["lacking", lack]
    if "R_flow_shift" in point:
        said = f"by {float(point.R_flow_shift):+.4f} ({abs(float(point.R_flow_sigma)):.1f} sigma)"
        yield ["over the local flow", f"R is higher {said}"]
    if "R_corrected" in point:
        said = "of the mean energies, with D (N - 1) translational degrees of freedom"
        yield ["R_corrected", f"{float(point.R_corrected):.4f}, {said}"]
    if over_time:
        said = f"averaged over collisions, {over_collisions(point.attrs, point)}"
        yield ["R_collisional", f"{_estimate(point, 'R_collisional')}, {said}"]
    if "target_met" in point:
        settings = from_json(point.attrs["experiment_json"], "settings of the dataset")
        wanted, blocks = settings["schedule"]["target_stderr"], int(point.target_blocks)
        found = f"standard error {wanted:g}: {MET[int(point.target_met)]}"
        yield ["target", found + f", in {blocks} times the schedule" * (blocks > 1)]
    yield ["theory", theory_beside(point, R, ratio_of_point(point))]
    series = point.R_series.values[np.isfinite(point.R_series.values)]
    parts = np.array([part.mean() for part in np.array_split(series, min(WIDTH, len(series)))])
    low, high = parts.min(), parts.max()
    heights = (parts - low) / ((high - low) or 1.0) * (len(BLOCKS) - 1)
    blocks_of_time = "".join(BLOCKS[round(height)] for height in heights)
    yield ["R(t)", f"{blocks_of_time}  {low:.3f} to {high:.3f}"]


def _measured(point: Dataset) -> Iterator[list[str]]:
    """Yield rows on energies, the steady state, and contacts that were altered or logged."""
    when = ", as the measurement begins" if "plateau_end" in point else ""
    for name in ("E_trans", "E_rot"):
        if name in point:
            unit = unit_of(point[name].attrs)
            yield [name, f"{_estimate(point, name)} {unit}, per degree of freedom{when}"]
    yield ["steady state", _steady(point)]
    share = float(point.get("contact_time_fraction", 0.0))
    if share > 0.0:
        said = f"{100.0 * share:.2g} % of contacts were altered by the contact-time model"
        yield ["contact time", f"{said}: R depends on it" if share > FEW else said]
    if "contacts_lost" in point:
        logged, lost = point.sizes["contact"], int(point.contacts_lost)
        some = f"the last {logged:,}; {lost:,} before them are lost"
        yield ["contacts logged", some if lost else f"all {logged:,}"]


def _steady(point: Dataset) -> str:
    found, made = STEADY[int(point.equilibrated)], float(point.get("measured_collisions", math.nan))
    end = f" to {float(point.plateau_end):g}" if "plateau_end" in point else " on"
    units = unit_of(point.measured_from.attrs)
    counted = f" ({made:.4g} collisions per particle)" if "time" in point else ""
    return f"{found}; measured from {float(point.measured_from):g}{end}, in {units}{counted}"


def _books(point: Dataset) -> str:
    """Return what each source has put into each motion, where that is known."""
    if not set(point.variables) >= BOOKS:
        return ""
    rows = [["energy put in, per particle", *point.motion.values]]
    for source, put_in in zip(point.source.values, point.energy_input.values, strict=True):
        rows.append([f"  {source}", *(f"{one:.6g}" for one in put_in)])
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
    found += ["R_collisional"] * ("R_collisional" in data)
    table = [[*axes, "seeds", *found, "steady"]]
    for row in rows_of(data):
        values = [row["value"], row["r"], row["beta"]][-len(axes) :]
        place = [value if isinstance(value, str) else f"{value:g}" for value in values]
        steady = "not known" if row["equilibrated"] < 0 else "NO"
        steady = "yes" if row["equilibrated"] > EQUILIBRATED else steady
        table.append([*place, f"{row['n_seeds']:.0f}", *_found(row), steady])
    over = f"{swept}, r and beta" if swept else "r and beta"
    filled = f", packing {about['packing']:.3g}" if "packing" in about else ""
    head = [
        ["experiment", f"{about['experiment']}, scale {about['scale']}"],
        ["gas", f"{particles_of(data)} {SHAPES[int(about['dimension'])]}{filled}"],
        ["points", f"{len(table) - 1} over {over}"],
        _cost(data.sum()),
    ]
    note = "Energies per degree of freedom; their error is the scatter over seeds."
    if "R" in data:
        note = "95 %: half width of the interval; ?: it may be too narrow, as the run is short."
        note += f"{why_wide(data)}\nTheory: {equation_of(about).name}; residual: R minus theory."
    if "R_collisional" in data:
        said = over_collisions(about, data)
        note += f"\nR is averaged over time, R_collisional over collisions, {said}."
    return f"{columns(head)}\n\n{columns(table, numbers=True)}\n\n{note}"


def _found(row: dict[str, Any]) -> list[str]:
    """Return the cells of the result; a column that is not there is empty in `row`."""
    name = "R" if row["R"] != "" else "E_trans"
    value = f"{Estimate(row[name], row[f'{name}_stderr'] or math.nan)}"
    if name == "E_trans":
        return [value]
    half = f"{row['R_ci95']:.4f}{'' if row['R_ci95_trusted'] == 1.0 else '?'}"
    collisional = row["R_collisional"], row["R_collisional_stderr"]
    beside = [] if "" in collisional else [f"{Estimate(*collisional)}"]
    return [value, half, f"{row['R_theory']:.4f}", f"{row['residual']:+.4f}", *beside]


def theory_beside(point: Dataset, R: float, expected: float) -> str:
    """Return what theory says of R, and how far off R is; or why it says nothing."""
    name = equation_of(point.attrs, point).name
    if "stages" in point.attrs:
        return f"none: settings change in {point.attrs['stages']} stages"
    if math.isnan(expected):
        why = "not known for this gas"
        if float(point.attrs["beta"]) == -1.0:
            why = "at beta = -1 contacts change no spin, and spins that are 0 stay so"
        return f"none ({name}): {why}"
    found = f"{expected:.4f}, {name}: R is {_beside(R, expected)} it"
    if "R_collisional" in point and like_theory(point):
        found += f", R_collisional {_beside(float(point.R_collisional), expected)}"
    return found


def _beside(R: float, expected: float) -> str:
    return f"{abs(R - expected):.4f} {'below' if R < expected else 'above'}"


def _by_species(point: Dataset) -> str:
    """Return a row for each species of a mixture; nothing where particles are alike."""
    if "species" not in point:
        return ""
    there = [name for name in OF_SPECIES if f"{name}_species" in point]
    rows = [["species", "particles", *there]]
    for k, name in enumerate(point.species.values):
        one = point.isel(species=k)
        found = [_estimate(one, f"{name}_species") for name in there]
        rows.append([str(name), str(int(one.species_particles)), *found])
    return columns(rows, numbers=True)


def observed(point: Dataset) -> str:
    """Return a row for each result of an observable, and what it is over; one for each species, or
    pair of species, where it is over nothing else. Beneath, why errors are not trusted."""
    rows = [["observed", "value", "meaning"]]
    for key, about in point.variables.items():
        if "observable" not in about.attrs or f"{key}_stderr" not in point:
            continue
        if not PARTS >= {*about.dims}:
            over = ", ".join(f"{dim} ({point.sizes[dim]})" for dim in about.dims)
            rows.append([str(key), f"over {over}{_doubtful(point, key)}", about.attrs["long_name"]])
            continue
        for at in np.ndindex(about.shape):
            if list(at) == sorted(at):  # a pair is the same in either order
                kinds = ", ".join(str(point.species.values[k]) for k in at)
                one = point.isel(dict(zip(about.dims, at, strict=True)))
                name = f"{key} [{kinds}]" if kinds else str(key)
                rows.append([name, _estimate(one, str(key)), about.attrs["long_name"]])
    return columns(rows) + _doubts(point) if rows[1:] else ""


def _estimate(point: Dataset, name: str) -> str:
    value, stderr = float(point[name]), float(point.get(f"{name}_stderr", math.nan))
    return f"{Estimate(value, stderr)}{MARK if point.get(f'{name}_trusted', YES) != YES else ''}"


def _doubtful(point: Dataset, name: Any) -> str:
    """Return how many values of a variable have errors that are not trusted."""
    flags = point.get(f"{name}_trusted")
    count = 0 if flags is None else int((flags != YES).sum())
    return f", {count} of {point[name].size} {MARK}" if count else ""


def _doubts(point: Dataset) -> str:
    """Return a line on errors that are not trusted, and one for each reason, if there are any."""
    reasons: dict[str, list[str]] = {}
    for name, about in point.variables.items():
        if (
            about.attrs.get("observable")
            and str(name).endswith(TRUSTED)
            and "comment" in about.attrs
        ):
            for reason in about.attrs["comment"].split("; "):
                reasons.setdefault(reason, []).append(str(name).removesuffix(TRUSTED))
    lines = [f"  {reason}: {_few(names)}" for reason, names in reasons.items()]
    return "\n".join([f"\n{MARK}: the error may be too small", *lines]) if lines else ""


def _few(names: list[str]) -> str:
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return ", ".join(names[:MOST_NAMES]) + more


def scalars(data: Dataset) -> dict[str, Any]:
    """Return the single numbers of a dataset by name; flags are True, False, or None: unknown."""
    return {
        str(name): FLAGS[int(one)] if "flag_meanings" in one.attrs else one.values.item()
        for name, one in data.variables.items()
        if not one.dims
    }


def task_text(data: Dataset) -> str:
    """Return a table of the variables of a task."""
    from roughgas import accuracy

    about = data.attrs
    chosen = json.loads(about["settings_json"])["study"]
    head = [["task", f"{about['task']} of the study {about['study']}, scale {about['scale']}"]]
    head += [[key, str(one)] for key, one in chosen.items() if not isinstance(one, dict | list)]
    place = "accuracy/{study}" if about["study"] in accuracy.STUDIES else "{study}/tasks"
    file = f"results/{about['scale']}/{place.format(**about)}/{about['task']}.nc"
    again = f"To make it again: snakemake -j1 {file}"
    return "\n\n".join([columns(head), variables_text(data), again])


def variables_text(data: Dataset) -> str:
    """Return a table of the variables of a dataset."""
    table = [["variable", "over", "value"]]
    for name, one in data.variables.items():
        over = ", ".join(f"{dim} ({data.sizes[dim]})" for dim in one.dims)
        table.append([str(name), over, _values(one.values)])
    return columns(table)


def _values(values: np.ndarray) -> str:
    """Return few values as they are, many as their range."""
    if values.size <= MOST_VALUES or values.dtype.kind not in "fiu":
        few = values.ravel()[:MOST_VALUES]
        return ", ".join(str(one) if isinstance(one, str) else f"{one:.5g}" for one in few)
    there = values[np.isfinite(values)]
    if not there.size:
        return "nothing"
    return f"{there.min():.5g} to {there.max():.5g}, {there.mean():.5g} on average"


def task_record(data: Dataset) -> dict[str, Any]:
    """Return the sizes and single numbers of a task."""
    return {"sizes": dict(data.sizes), "variables": scalars(data)}


def studies_record(studies: Mapping[str, Dataset]) -> dict[str, Any]:
    """Return the same of each study, by name."""
    found = {name: {"attributes": one.attrs} | task_record(one) for name, one in studies.items()}
    return {"studies": found}


def studies_text(studies: Mapping[str, Dataset]) -> str:
    """Return the tables of all studies."""
    scales = {data.attrs["scale"] for data in studies.values()}
    parts = [_table_of(name)(data).strip() for name, data in studies.items()]
    return "\n\n".join([f"scale {', '.join(sorted(scales))}", *parts])


def _table_of(study: str) -> Callable[[Dataset], str]:
    """Return what shows the data of a study: of accuracy, or of a folder if that is there."""
    from roughgas import accuracy
    from roughgas.config.study_folders import folders

    if study in accuracy.STUDIES:
        return accuracy.study(study).table
    folder = folders(config.in_use()).get(study)
    if folder is None or not (folder / "results.py").exists():
        return variables_text
    return module_of(folder, "results").table


KINDS: dict[str, tuple[Callable[[Any], str], Callable[[Any], dict[str, Any]]]] = {
    "point": (_point_text, _point_record),
    "reduced dataset": (_reduced_text, _reduced_record),
    "task of a study": (task_text, task_record),
    "dataset of studies": (studies_text, studies_record),
}
"""The kinds of files: what a person reads of each, and what a script reads."""
