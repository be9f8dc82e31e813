"""`roughgas show`: a summary of any dataset that the pipeline writes.

R = E_rot/(E_rot + E_trans), from energies per degree of freedom; r is the normal restitution, beta
the roughness. A row of a table is a list of texts, one for each column.
"""

import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from xarray import Dataset

from roughgas import config
from roughgas.base import (
    Attributes,
    InputError,
    NamedValues,
    Record,
    as_json,
    columns,
    from_json,
    on_one_line,
)
from roughgas.base.files import study_module
from roughgas.config.study_folders import folders
from roughgas.config.written_study import WrittenStudy
from roughgas.data import netcdf
from roughgas.data.netcdf import read_netcdf, unit_of
from roughgas.data.reduced import (
    STEADY_SHARE,
    check_swept,
    observed_names,
    particles_of,
    sweep_axes,
)
from roughgas.data.variables import TRUSTED_SUFFIX, third_axis
from roughgas.effects.species import packing
from roughgas.results.tables import rows as rows_of
from roughgas.results.tables import wide_note
from roughgas.scene.settings import scene_settings
from roughgas.statistics.estimates import Estimate, decimals_of
from roughgas.statistics.sample_sizes import NO, UNKNOWN, YES
from roughgas.theory.prediction import (
    describe_collisional_average,
    equation_of,
    ratio_of_point,
    theory_averages_over_collisions,
)

CONTACT_TIME_TOLERANCE = 0.01
"""Largest share of contacts altered by the contact-time model at which R counts as independent of
it."""
SPECIES_AVERAGES = ("E_trans", "E_rot", "R")
SPECIES_DIMENSIONS = {"species", "other"}  # variables without other dimensions are shown in full
MAX_VALUES_LISTED = 4  # of a variable; the range of longer ones is shown
MAX_NAMES_LISTED = 4  # of variables with the same reason for doubt
DOUBT_MARK = "?"
FLAG_VALUES = {YES: True, NO: False, UNKNOWN: None}
REQUIRED_ATTRIBUTES = {
    netcdf.POINT: ("experiment_json", "command"),
    netcdf.TASK: ("settings_json",),
}
"""Attributes that the summary of each kind of dataset quotes."""
ENERGY_BALANCE = {"source", "motion", "energy_input", "energy_gain", "energy_imbalance"}
SHAPES = {2: "disks", 3: "spheres"}
BLOCK_CHARACTERS, PLOT_WIDTH = "▁▂▃▄▅▆▇█", 48
TRUST_NOTES = {
    YES: "",
    NO: " (not to be trusted: no steady state, or too short a run)",
    UNKNOWN: " (whether to trust it is not known: too little was measured)",
}
TARGET_NOTES = {YES: "met", NO: "NOT met", UNKNOWN: "not known: too little was measured"}
STEADY_NOTES = {
    YES: "yes",
    NO: "NOT found: energies or R still drift",
    UNKNOWN: "not known: too little was measured",
}


def print_summaries(paths: Iterable[str | Path], json: bool, of: Sequence[str] = ()) -> None:
    """Print the summary of each dataset, separated by empty lines; with `json`, its attributes and
    scalar variables as a line of JSON.

    `of` names variables of reduced datasets, which are printed in its place. Raises InputError for
    files of other programs and unknown variables, and OSError.
    """
    for number, path in enumerate(paths):
        if json:
            kind, data = _read(path)
            attributes = {"attributes": data.attrs} if hasattr(data, "attrs") else {}
            record = {"file": path, "kind": kind} | attributes
            print(as_json(record | _summaries(path, kind, of)[1](data), indent=None))
        else:
            print("\n" * (number > 0) + summary(path, of))


def summary(path: str | Path, of: Sequence[str] = ()) -> str:
    """Return the summary of the dataset at `path`, or of its variables `of`, as text.

    Raises InputError for files of other programs and unknown variables.
    """
    kind, data = _read(path)
    lines = f"{path}: {kind}\n\n{_summaries(path, kind, of)[0](data)}".split("\n")
    return "\n".join(map(on_one_line, lines))


def _summaries(
    path: str | Path, kind: str, of: Sequence[str]
) -> tuple[Callable[[Any], str], Callable[[Any], NamedValues]]:
    """Return the functions that summarise a kind of file, or its variables `of`: see SUMMARIES.

    Raises InputError, with the `path`, for variables of anything but a reduced dataset.
    """
    if not of:
        return SUMMARIES[kind]
    if kind != "reduced dataset":
        raise InputError("dataset", path, "be a reduced one for --of")
    return partial(_variables_text, names=of), partial(_variables_record, names=of)


def _read(path: str | Path) -> tuple[str, Any]:
    """Return the kind of the dataset at `path`, a key of SUMMARIES, and its content: a Dataset, or
    the Datasets of studies by name."""
    with netcdf.opened(path) as file:
        kind = netcdf.file_type_of(file)
        netcdf.require(netcdf.attributes_of(file), REQUIRED_ATTRIBUTES.get(kind or "", ()), path)
    data = (
        netcdf.read_groups(path)
        if kind == netcdf.STUDIES
        else _with_attributes_on_one_line(read_netcdf(path))
    )
    return (kind or "").removeprefix("a "), data


def _with_attributes_on_one_line(data: Dataset) -> Dataset:
    """Return a dataset with the control characters in its attributes escaped: other programs may
    have set them."""
    texts = {name: on_one_line(text) for name, text in data.attrs.items() if isinstance(text, str)}
    return data.assign_attrs(texts)


def _cost_row(data: Dataset) -> list[str]:
    """Return a row (title, text) on the number of collisions, the CPU time in s, and collisions per
    second."""
    collisions, seconds = int(data.collisions), float(data.kernel_seconds)
    rate = f", {float(f'{collisions / seconds:.2g}'):,.0f} a second" if seconds > 0.0 else ""
    return ["cost", f"{collisions:,} collisions in {seconds:.2f} s of CPU time{rate}"]


def _point_record(point: Dataset) -> NamedValues:
    """Return the scalar variables of a point by name; if particles spin, with R of theory and the
    residual, R minus R of theory."""
    variables = scalars(point.reset_coords(drop=True))  # the coordinates are attributes too
    if "R" in variables:
        expected = ratio_of_point(point)
        variables |= {"R_theory": expected, "residual": variables["R"] - expected}
    return {"variables": variables}


def _point_text(point: Dataset) -> str:
    """Return the summary of a point as text, to stand below a title."""
    attributes = point.attrs
    variant = f"/{attributes['variant']}" if "variant" in attributes else ""
    rows = [
        ["experiment", f"{attributes['experiment']}{variant}, scale {attributes['scale']}"],
        *_settings_rows(attributes),
        ["", ""],
        *(_ratio_rows(point) if "R" in point else []),
        *_measurement_rows(point),
        _cost_row(point),
    ]
    sections = (
        columns(rows),
        _species_table(point),
        observed_table(point),
        _energy_balance_table(point),
    )
    return "\n\n".join([*filter(None, sections), f"To make it again:\n{attributes['command']}"])


def _settings_rows(attributes: Attributes) -> Iterator[list[str]]:
    """Yield rows (title, text) on the settings in the attributes of a point: r, beta, seed, gas,
    effects, schedule."""
    experiment = from_json(attributes["experiment_json"], "settings of the dataset")
    netcdf.require(experiment, ("particles", "box", "effects"), "its settings")
    noise = ", fresh noise for a saved state" if attributes.get("reseeded") else ""
    point = (
        f"r = {attributes['r']:g}, beta = {attributes['beta']:g}, seed {attributes['seed']}{noise}"
    )
    yield ["point", point]
    box = " x ".join(f"{side:g}" if side != "open" else "open" for side in experiment["box"])
    has_volume = "open" not in experiment["box"]
    packing_text = ""
    if has_volume:  # effects change none, and may be of a study that is not here
        scene = scene_settings({**experiment, "effects": {}})
        packing_text = f", packing {packing(scene):.3g}"
    shape = SHAPES[len(experiment["box"])]
    yield ["gas", f"{experiment['particles']} {shape}, box {box} a{packing_text}"]
    if layer := experiment.get("layer"):
        yield ["layer", f"{_settings_text(layer)}, in diameters and cycles"]
    for number, (name, settings) in enumerate(experiment["effects"].items()):
        yield ["" if number else "effects", f"{name} ({_settings_text(settings)})"]
    if schedule := experiment.get("schedule"):
        yield ["schedule", _settings_text(schedule)]


def _settings_text(settings: Record) -> str:
    """Return settings as text: names and values, separated by commas."""
    return ", ".join(f"{name} {value}" for name, value in settings.items())


def _ratio_rows(point: Dataset) -> Iterator[list[str]]:
    """Yield rows (title, text) on R of a point: its averages with errors, theory, and a plot of R
    over time."""
    R, half_width = float(point.R), float(point.R_ci95)
    digits = decimals_of(half_width) if 0.0 < half_width < 1.0 else 4
    trust_note, over_time = TRUST_NOTES[int(point.R_ci95_trusted)], "R_collisional" in point
    yield ["R", f"{_estimate(point, 'R')}{', averaged over time' * over_time}"]
    has_interval = half_width > 0.0  # it is 0 if R never changes, as without contacts
    interval = (
        f"{R - half_width:.{digits}f} to {R + half_width:.{digits}f}"
        if has_interval
        else "not known"
    )
    yield ["95 % interval", f"{interval}{trust_note}"]
    if reason := point.R_ci95_trusted.attrs.get("comment"):
        yield ["lacking", reason]
    if "R_flow_shift" in point:
        note = f"by {float(point.R_flow_shift):+.4f} ({abs(float(point.R_flow_sigma)):.1f} sigma)"
        yield ["over the local flow", f"R is higher {note}"]
    if "R_corrected" in point:
        note = "of the mean energies, with D (N - 1) translational degrees of freedom"
        yield ["R_corrected", f"{float(point.R_corrected):.4f}, {note}"]
    if over_time:
        note = f"averaged over collisions, {describe_collisional_average(point.attrs, point)}"
        yield ["R_collisional", f"{_estimate(point, 'R_collisional')}, {note}"]
    if "target_met" in point:
        settings = from_json(point.attrs["experiment_json"], "settings of the dataset")
        target, lengthening = settings["schedule"]["target_stderr"], int(point.target_blocks)
        outcome = f"standard error {target:g}: {TARGET_NOTES[int(point.target_met)]}"
        yield ["target", outcome + f", in {lengthening} times the schedule" * (lengthening > 1)]
    yield ["theory", theory_comparison(point, R, ratio_of_point(point))]
    series = point.R_series.values[np.isfinite(point.R_series.values)]
    means = np.array(
        [block.mean() for block in np.array_split(series, min(PLOT_WIDTH, len(series)))]
    )
    low, high = means.min(), means.max()
    heights = (means - low) / ((high - low) or 1.0) * (len(BLOCK_CHARACTERS) - 1)
    blocks_of_time = "".join(BLOCK_CHARACTERS[round(height)] for height in heights)
    yield ["R(t)", f"{blocks_of_time}  {low:.3f} to {high:.3f}"]


def _measurement_rows(point: Dataset) -> Iterator[list[str]]:
    """Yield rows (title, text) on the energies of a point, its steady state, and altered and logged
    contacts."""
    time_note = ", as the measurement begins" if "plateau_end" in point else ""
    for name in ("E_trans", "E_rot"):
        if name in point:
            unit = unit_of(point[name].attrs)
            yield [name, f"{_estimate(point, name)} {unit}, per degree of freedom{time_note}"]
    yield ["steady state", _steady_text(point)]
    if "wait" in point:
        yield [
            "wait",
            f"{float(point.wait):g} T, {float(point.wait_relaxations):.3g} e-folds of theory",
        ]
    share = float(point.get("contact_time_fraction", 0.0))
    if share > 0.0:
        note = f"{100.0 * share:.2g} % of contacts were altered by the contact-time model"
        yield [
            "contact time",
            f"{note}: R depends on it" if share > CONTACT_TIME_TOLERANCE else note,
        ]
    if "contacts_lost" in point:
        logged, lost = point.sizes["contact"], int(point.contacts_lost)
        partial_log = f"the last {logged:,}; {lost:,} before them are lost"
        yield ["contacts logged", partial_log if lost else f"all {logged:,}"]


def _steady_text(point: Dataset) -> str:
    """Return in words whether the state of a point was steady, and the window of the measurement
    with its units."""
    outcome, collisions = (
        STEADY_NOTES[int(point.equilibrated)],
        float(point.get("measured_collisions", math.nan)),
    )
    end = f" to {float(point.plateau_end):g}" if "plateau_end" in point else " on"
    units = unit_of(point.measured_from.attrs)
    count_note = f" ({collisions:.4g} collisions per particle)" if "time" in point else ""
    return f"{outcome}; measured from {float(point.measured_from):g}{end}, in {units}{count_note}"


def _energy_balance_table(point: Dataset) -> str:
    """Return a table of the energy per particle that each source has put into each motion of a
    point; "" if it was not measured."""
    if not set(point.variables) >= ENERGY_BALANCE:
        return ""
    rows = [["energy put in, per particle", *point.motion.values]]
    for source, inputs in zip(point.source.values, point.energy_input.values, strict=True):
        rows.append([f"  {source}", *(f"{energy:.6g}" for energy in inputs)])
    rows.append(
        ["  what the gas has gained", *(f"{energy:.6g}" for energy in point.energy_gain.values)]
    )
    imbalance, units = float(point.energy_imbalance), unit_of(point.energy_gain.attrs)
    return f"{columns(rows, numbers=True)}\n  in {units}; energy balance closes to {imbalance:.1g}"


def _reduced_record(data: Dataset) -> NamedValues:
    """Return the results of each point of a reduced dataset, by name of the column, as a list under
    `points`."""
    rows = rows_of(data)
    return {"points": [{k: value for k, value in row.items() if value != ""} for row in rows]}


def _reduced_text(data: Dataset) -> str:
    """Return the summary of a reduced dataset as text: a row for each point, its means over
    seeds."""
    attributes, swept = data.attrs, third_axis(data.attrs)
    axes = [*([swept] if swept else []), "r", "beta"]
    result_columns = ["R", "95 %", "theory", "residual"] if "R" in data else ["E_trans"]
    result_columns += ["R_collisional"] * ("R_collisional" in data)
    table = [[*axes, "seeds", *result_columns, "steady"]]
    for row in rows_of(data):
        values = [row["value"], row["r"], row["beta"]][-len(axes) :]
        cells = [value if isinstance(value, str) else f"{value:g}" for value in values]
        steady = "not known" if row["equilibrated"] < 0 else "NO"
        steady = "yes" if row["equilibrated"] > STEADY_SHARE else steady
        table.append([*cells, f"{row['n_seeds']:.0f}", *_result_cells(row), steady])
    axes_text = f"{swept}, r and beta" if swept else "r and beta"
    packing_text = f", packing {attributes['packing']:.3g}" if "packing" in attributes else ""
    header = [
        ["experiment", f"{attributes['experiment']}, scale {attributes['scale']}"],
        ["gas", f"{particles_of(data)} {SHAPES[int(attributes['dimension'])]}{packing_text}"],
        ["points", f"{len(table) - 1} over {axes_text}"],
        _cost_row(data.sum()),
    ]
    notes = "Energies per degree of freedom; their error is the scatter over seeds."
    if "R" in data:
        notes = "95 %: half width of the interval; ?: it may be too narrow, as the run is short."
        notes += (
            f"{wide_note(data)}\nTheory: {equation_of(attributes).name}; residual: R minus theory."
        )
    if names := observed_names(data):
        notes += f"\nObserved: {_names_text(names)}; --of prints them."
    if "R_collisional" in data:
        average_note = describe_collisional_average(attributes, data)
        notes += f"\nR is averaged over time, R_collisional over collisions, {average_note}."
    return f"{columns(header)}\n\n{columns(table, numbers=True)}\n\n{notes}"


def _variables_text(data: Dataset, names: Sequence[str]) -> str:
    """Return tables of the variables `names` of a reduced dataset over its sweep, as text.

    Variables with the same further dimensions, such as the height of a profile, share a table.
    """
    tables: dict[tuple[str, ...], list[str]] = {}
    for name in names:
        check_swept(data, name)
        dims = tuple(str(dim) for dim in data[name].dims if dim not in sweep_axes(data))
        tables.setdefault(dims, []).append(name)
    header = [["experiment", f"{data.attrs['experiment']}, scale {data.attrs['scale']}"]]
    for name in names:
        unit = unit_of(data[name].attrs)
        meaning = data[name].attrs.get("long_name", name)
        header.append([name, meaning + (f", in {unit}" if unit not in ("", "1") else "")])
    parts = [columns(header), *(_variable_table(data, *table) for table in tables.items())]
    note = f"{DOUBT_MARK}: the error is not trusted, or not known to be right"
    return "\n\n".join([*parts, note] if any(DOUBT_MARK in part for part in parts) else parts)


def _variable_table(data: Dataset, dims: Sequence[str], names: Sequence[str]) -> str:
    """Return a table of variables over the sweep and the dimensions `dims`, which all have."""
    axes = [*sweep_axes(data), *dims]
    coordinates = [data[axis].values.tolist() for axis in axes]
    rows = [[*axes, *names]]
    for index in np.ndindex(*map(len, coordinates)):
        element = data.isel(dict(zip(axes, index, strict=True)))
        if int(element.n_seeds):
            position = [values[k] for values, k in zip(coordinates, index, strict=True)]
            cells = [value if isinstance(value, str) else f"{value:g}" for value in position]
            rows.append([*cells, *(_estimate(element, name) for name in names)])
    return columns(rows, numbers=True)


def _variables_record(data: Dataset, names: Sequence[str]) -> NamedValues:
    """Return the variables `names` at each point of a reduced dataset, with their errors, as a list
    under `points`; values of variables with further dimensions are nested lists."""
    for name in names:
        check_swept(data, name)
    axes = sweep_axes(data)
    shown = [key for name in names for key in (name, f"{name}_stderr") if key in data]
    points = []
    for index in np.ndindex(*(data.sizes[axis] for axis in axes)):
        point = data.isel(dict(zip(axes, index, strict=True)))
        if int(point.n_seeds):
            points.append({key: point[key].values.tolist() for key in (*axes, *shown)})
    return {"points": points}


def _result_cells(row: Record) -> list[str]:
    """Return the cells of a point's result as texts: R with error, 95 % interval, theory, residual
    and average over collisions; without spin E_trans alone.

    `row` has the variables of a point by name, "" for variables that the dataset lacks.
    """
    name = "R" if row["R"] != "" else "E_trans"
    value = f"{Estimate(row[name], row[f'{name}_stderr'] or math.nan)}"
    if name == "E_trans":
        return [value]
    interval = f"{row['R_ci95']:.4f}{'' if row['R_ci95_trusted'] == 1.0 else '?'}"
    collisional = row["R_collisional"], row["R_collisional_stderr"]
    collisional_cell = [] if "" in collisional else [f"{Estimate(*collisional)}"]
    return [value, interval, f"{row['R_theory']:.4f}", f"{row['residual']:+.4f}", *collisional_cell]


def theory_comparison(point: Dataset, R: float, expected: float) -> str:
    """Return in words R of theory (`expected`) with the deviation of the measured R of a point, or
    the reason why there is no theory (NaN)."""
    name = equation_of(point.attrs, point).name
    if "stages" in point.attrs:
        return f"none: settings change in {point.attrs['stages']} stages"
    if math.isnan(expected):
        reason = "not known for this gas"
        if float(point.attrs["beta"]) == -1.0:
            reason = "at beta = -1 contacts change no spin, and spins that are 0 stay so"
        return f"none ({name}): {reason}"
    comparison = f"{expected:.4f}, {name}: R is {_deviation(R, expected)} it"
    if "R_collisional" in point and theory_averages_over_collisions(point):
        comparison += f", R_collisional {_deviation(float(point.R_collisional), expected)}"
    return comparison


def _deviation(R: float, expected: float) -> str:
    """Return in words the distance of the measured R from R of theory (`expected`), above or
    below."""
    return f"{abs(R - expected):.4f} {'below' if R < expected else 'above'}"


def _species_table(point: Dataset) -> str:
    """Return a table of the averages in SPECIES_AVERAGES, a row for each species of a mixture; ""
    for a point without species."""
    if "species" not in point:
        return ""
    averages = [name for name in SPECIES_AVERAGES if f"{name}_species" in point]
    rows = [["species", "particles", *averages]]
    for k, name in enumerate(point.species.values):
        species_data = point.isel(species=k)
        cells = [_estimate(species_data, f"{name}_species") for name in averages]
        rows.append([str(name), str(int(species_data.species_particles)), *cells])
    return columns(rows, numbers=True)


def observed_table(point: Dataset) -> str:
    """Return a table of the results of a point's observables, with notes on errors that are not
    trusted; "" without observables.

    There is a row for each variable, with its dimensions, or for each species or pair of species if
    the variable has no other dimensions.
    """
    rows = [["observed", "value", "meaning"]]
    for key, variable in point.variables.items():
        if "observable" not in variable.attrs or f"{key}_stderr" not in point:
            continue
        if not SPECIES_DIMENSIONS >= {*variable.dims}:
            dimensions = ", ".join(f"{dim} ({point.sizes[dim]})" for dim in variable.dims)
            rows.append(
                [
                    str(key),
                    f"over {dimensions}{_doubtful_count(point, key)}",
                    variable.attrs["long_name"],
                ]
            )
            continue
        for index in np.ndindex(variable.shape):
            if list(index) == sorted(index):  # the order of a pair does not matter
                species = ", ".join(str(point.species.values[k]) for k in index)
                element = point.isel(dict(zip(variable.dims, index, strict=True)))
                name = f"{key} [{species}]" if species else str(key)
                rows.append([name, _estimate(element, str(key)), variable.attrs["long_name"]])
    return columns(rows) + _doubt_notes(point) if rows[1:] else ""


def _estimate(point: Dataset, name: str) -> str:
    """Return the variable `name` of a point with its standard error, such as 0.3565(30), marked if
    the error is not trusted."""
    value, stderr = float(point[name]), float(point.get(f"{name}_stderr", math.nan))
    return (
        f"{Estimate(value, stderr)}{DOUBT_MARK if point.get(f'{name}_trusted', YES) != YES else ''}"
    )


def _doubtful_count(point: Dataset, name: Any) -> str:
    """Return in words the number of values of the variable `name` whose errors are not trusted; ""
    if there are none."""
    flags = point.get(f"{name}_trusted")
    count = 0 if flags is None else int((flags != YES).sum())
    return f", {count} of {point[name].size} {DOUBT_MARK}" if count else ""


def _doubt_notes(point: Dataset) -> str:
    """Return a line for each reason why errors of variables of a point are not trusted, below a
    title; "" if all are trusted."""
    reasons: dict[str, list[str]] = {}
    for name, variable in point.variables.items():
        if (
            variable.attrs.get("observable")
            and str(name).endswith(TRUSTED_SUFFIX)
            and "comment" in variable.attrs
        ):
            for reason in variable.attrs["comment"].split("; "):
                reasons.setdefault(reason, []).append(str(name).removesuffix(TRUSTED_SUFFIX))
    lines = [f"  {reason}: {_names_text(names)}" for reason, names in reasons.items()]
    return "\n".join([f"\n{DOUBT_MARK}: the error may be too small", *lines]) if lines else ""


def _names_text(names: list[str]) -> str:
    """Return the first MAX_NAMES_LISTED of `names` as text, and the number of further ones."""
    remainder = (
        f" and {len(names) - MAX_NAMES_LISTED} more" if len(names) > MAX_NAMES_LISTED else ""
    )
    return ", ".join(names[:MAX_NAMES_LISTED]) + remainder


def scalars(data: Dataset) -> NamedValues:
    """Return the scalar variables of a dataset by name, as Python numbers or texts; flags are True,
    False, or None for not known."""
    return {
        str(name): FLAG_VALUES[int(variable)]
        if "flag_meanings" in variable.attrs
        else variable.values.item()
        for name, variable in data.variables.items()
        if not variable.dims
    }


def task_text(data: Dataset) -> str:
    """Return the summary of the dataset of a study's task as text: its settings, variables, and
    command."""
    attrs = data.attrs
    study_settings = json.loads(attrs["settings_json"])["study"]
    header = [
        [
            "task",
            f"{attrs['task']} of the study {attrs['study']}, scale {attrs['scale']}",
        ]
    ]
    header += [
        [key, str(value)]
        for key, value in study_settings.items()
        if not isinstance(value, dict | list)
    ]
    study = _study_of_module(attrs["study"])
    folder = f"{study.heading}/{attrs['study']}" if study else f"{attrs['study']}/tasks"
    path = f"results/{attrs['scale']}/{folder}/{attrs['task']}.nc"
    command = f"To make it again: snakemake -j1 {path}"
    return "\n\n".join([columns(header), variables_text(data), command])


def variables_text(data: Dataset) -> str:
    """Return a table of all variables of a dataset as text: name, dimensions with sizes, values."""
    table = [["variable", "over", "value"]]
    for name, variable in data.variables.items():
        dimensions = ", ".join(f"{dim} ({data.sizes[dim]})" for dim in variable.dims)
        table.append([str(name), dimensions, _values_text(variable.values)])
    return columns(table)


def _values_text(values: np.ndarray) -> str:
    """Return up to MAX_VALUES_LISTED values as text, or the range and the mean of more numbers."""
    if values.size <= MAX_VALUES_LISTED or values.dtype.kind not in "fiu":
        listed = values.ravel()[:MAX_VALUES_LISTED]
        return ", ".join(
            str(value) if isinstance(value, str) else f"{value:.5g}" for value in listed
        )
    finite = values[np.isfinite(values)]
    if not finite.size:
        return "nothing"
    return f"{finite.min():.5g} to {finite.max():.5g}, {finite.mean():.5g} on average"


def task_record(data: Dataset) -> NamedValues:
    """Return the sizes of the dimensions (`sizes`) and the scalar variables (`variables`) of the
    dataset of a task, by name."""
    return {"sizes": dict(data.sizes), "variables": scalars(data)}


def studies_record(studies: Mapping[str, Dataset]) -> NamedValues:
    """Return, under `studies`, the attributes, sizes and scalar variables of each study's results
    (`studies`, by name of the study)."""
    records = {
        name: {"attributes": data.attrs} | task_record(data) for name, data in studies.items()
    }
    return {"studies": records}


def studies_text(studies: Mapping[str, Dataset]) -> str:
    """Return the summaries of the results of all studies (`studies`, by name) as text, below their
    scale."""
    scales = {data.attrs["scale"] for data in studies.values()}
    tables = [_table_function(name)(data).strip() for name, data in studies.items()]
    return "\n\n".join([f"scale {', '.join(sorted(scales))}", *tables])


def _table_function(study: str) -> Callable[[Dataset], str]:
    """Return the function that makes a table, as text, of a dataset of `study`, the name of a study
    or of a module with tasks.

    It is `table` of that module, or of results.py of the study, or else `variables_text`.
    """
    table: Callable[[Dataset], str] = variables_text
    folder = folders(config.active_config_path()).get(study)
    if (study_of_module := _study_of_module(study)) is not None:
        table = study_module(study_of_module.folder, study).table
    elif folder is not None and (folder / "results.py").exists():
        table = study_module(folder, "results").table
    return table


def _study_of_module(module: str) -> WrittenStudy | None:
    """Return the study whose tasks the module named `module` runs; None if no study has the
    module."""
    folders_by_name = folders(config.active_config_path())
    for name, folder in folders_by_name.items():
        if (folder / f"{module}.py").exists():
            with suppress(InputError, OSError):  # skips a broken study
                study = WrittenStudy(name, folder, folders_by_name)
                if module in study.modules:
                    return study
    return None


SUMMARIES: dict[str, tuple[Callable[[Any], str], Callable[[Any], dict[str, Any]]]] = {
    "point": (_point_text, _point_record),
    "reduced dataset": (_reduced_text, _reduced_record),
    "task of a study": (task_text, task_record),
    "dataset of studies": (studies_text, studies_record),
}
"""Functions that summarise each kind of file: as text, and as a record for JSON."""
