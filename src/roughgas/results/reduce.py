"""From points to one reduced dataset for each experiment.

A reduced dataset has the dimensions (r, beta, seed), preceded by the third axis, if there is one
(`third_axis`). The error bar pools the scatter over independent seeds with the errors within them
(statistics/errors.py), since the scatter over few seeds alone is uncertain; both errors are also
stored separately. Variables of observables are combined in the same way: in the file of a point
they have the attribute `observable`.

Here the position of a point is the tuple of its coordinates along these dimensions, `axes` are the
sorted coordinates along each, and `stacks` are the values of all points by variable: arrays (third
axis, r, beta, ..., seed), with NaN for missing points.
"""

import functools
import json
import math
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, NamedTuple

import netCDF4
import numpy as np

from roughgas.base import InputError, NamedValues, shared_entries, sorted_json
from roughgas.data import netcdf
from roughgas.data.netcdf import Content, DamagedError, opened, require, unit_of
from roughgas.data.point import Point, write_point
from roughgas.data.reduced import (
    COOLING_SERIES,
    GRID_DIMS,
    LEGAL_VALUES,
    POOLED,
    SCATTERED,
    SERIES_OF_SEEDS,
    STAGE_VARIABLES,
    STAGE_VARIABLES_WITH_ERRORS,
    VERDICTS,
    check_legal,
    read_reduced,
)
from roughgas.data.variables import (
    CLOCKS,
    POINT,
    POINT_COORDINATES,
    Array,
    Variable,
    described,
    errors_of,
    share_of_trust,
    third_axis,
)
from roughgas.data.variables import POOLED as POOLED_ORIGIN
from roughgas.results.axes import POINT_ATTRIBUTES, axes_of, coordinate, index_of, position_of
from roughgas.statistics.errors import pooled_error
from roughgas.statistics.sample_sizes import NO, UNKNOWN, YES
from roughgas.statistics.steady_state import is_bimodal
from roughgas.theory.prediction import LANGEVIN_ATTRIBUTE, SPECIES_ATTRIBUTE, equation_of

if TYPE_CHECKING:
    import xarray

COMMON_ATTRIBUTES = (
    "experiment",
    "scale",
    "dimension",
    "inertia",
    "spin_share",
    "mu",
    "particles",
    "swept",
)
PROVENANCE = ("roughgas_version", "numpy_version", "numba_version", "kernel_source_hash")
RUN_IDENTIFIERS = ("R", "E_trans", "E_rot", "collisions", "measured_from")
"""Results whose bits agree only in copies of the same run."""
SERIES = (*COOLING_SERIES, *(name for name in STAGE_VARIABLES if POINT[name].dims[0] == "sample"))
SPECIES_MEANS = [
    name
    for name, variable in POINT.items()
    if variable.dims == ("species",) and variable.over_seeds
]

Stored = Mapping[str, netCDF4.Variable]  # of an open file


class Summary(NamedTuple):
    """Variables and attributes of a point's file, and its position in the reduced dataset."""

    scalars: dict[str, Any]  # float, or arrays (species,) and series
    attributes: dict[str, Any]
    position: tuple[Any, ...]  # (r, beta, seed), preceded by the value on the third axis, if any
    replicas: np.ndarray  # R of each replica of a cooling gas; else empty
    names: Mapping[str, tuple[str, ...]] = {}  # of species, and of energy sources and motions
    observed: Mapping[str, Array] = {}  # variables of observables


def reduce_points(paths: Iterable[str | Path], output: str | Path, put_aside: bool = False) -> None:
    """Combine the points at `paths`, of one experiment, into the reduced dataset `output`.

    Their order is arbitrary. A path leads to a dataset, or to a folder with a dataset for each
    seed. Seeds that are missing at an (r, beta) are NaN in R_seed, and do not count in n_seeds and
    the means. With `put_aside`, for workflows, a damaged point is renamed, so that it is simulated
    again. Raises InputError without paths, for several experiments, for the same point or the same
    run twice, for impossible numbers, and for unreadable files.
    """
    folders = (path.glob("seed*.nc") if path.is_dir() else [path] for path in map(Path, paths))
    summary = _summary_or_put_aside if put_aside else _summary
    points = [summary(file) for files in folders for file in sorted(files)]
    if not points:
        raise InputError("number of points to reduce", 0, "be at least 1")
    netcdf.write_netcdf(output, _combined(points))


def reduced_in_memory(points: Iterable[Point]) -> "xarray.Dataset":
    """Return the reduced dataset of points, as `reduce_points` and `read_reduced` would give it.

    It is made in a temporary folder. Raises InputError as these do.
    """
    with TemporaryDirectory() as folder:
        for number, point in enumerate(points):
            write_point(Path(folder, f"seed{number}.nc"), point)
        output = Path(folder, "reduced.nc")
        reduce_points([folder], output)
        return read_reduced(output)


def _summary_or_put_aside(path: Path) -> Summary:
    """Return the summary of the point at `path`; rename a damaged file, to be made anew.

    Raises DamagedError after that, with a remedy.
    """
    try:
        return _summary(path)
    except DamagedError as error:
        if path.suffix != ".nc":  # not a file of the workflow
            raise
        path.replace(f"{path}.damaged")
        legal = f"{error.legal}, and now called {path.name}.damaged: run the same command again"
        raise DamagedError("point", path, legal) from error


def _summary(path: Path) -> Summary:
    """Return the summary of the point at `path`.

    Raises InputError for files of other types and for impossible numbers, OSError if it cannot be
    read.
    """
    with opened(path, netcdf.POINT) as file:
        file.set_auto_maskandscale(False)  # nothing is masked or packed; this saves the search
        variables, attributes = file.variables, netcdf.attributes_of(file)
        require(attributes, ("swept_value",) if "swept" in attributes else (), path)
        scalar_names = [
            name
            for name, variable in POINT.items()
            if not variable.dims and name not in POINT_COORDINATES
        ]
        scalars: dict[str, Any] = {
            name: netcdf.number_in(variables[name]) for name in scalar_names if name in variables
        }
        scalars |= {name: variables[name][...] for name in SPECIES_MEANS if name in variables}
        if "E_trans_species" in scalars:  # the ratio of each seed, free of common fluctuations
            energy = scalars["E_trans_species"]
            scalars["T_ratio_species"] = energy / energy[0]
        scalars |= _series(variables)
        exchanged = ("source", "motion") if "stage_begin" in variables else ()
        name_variables = [*exchanged, *(["species"] if "species" in variables else [])]
        names = {name: tuple(variables[name][...].tolist()) for name in name_variables}
        for name in scalars.keys() & LEGAL_VALUES:
            check_legal(path, name, scalars[name])
        scalars["measured_for"], scalars["R_drift"] = _window(variables, scalars)
        observed = _observed(variables)
        replicas = variables["R_replica"][...] if "R_replica" in variables else np.empty(0)
    return Summary(scalars, attributes, position_of(attributes), replicas, names, observed)


def _series(variables: Stored) -> dict[str, np.ndarray]:
    """Return the series of a cooling gas without a constant R, or of a gas through stages, by name.

    Other gases have none.
    """
    if "stage_begin" in variables:
        names = [name for name in (*SERIES, *STAGE_VARIABLES) if name in variables]
        series = {name: variables[name][...] for name in names}
        return {"time_series": variables["time"][...]} | series
    if "time_series" not in variables:
        return {}
    return {name: variables[name][...] for name in SERIES if name in variables}


def _observed(variables: Stored) -> dict[str, Array]:
    """Return the variables of observables in the file of a point, by name."""
    observed = {}
    for name, variable in variables.items():
        if "observable" in variable.ncattrs():
            attributes = {key: variable.getncattr(key) for key in variable.ncattrs()}
            description = {key: attributes[key] for key in ("long_name", "observable")}
            values = np.asarray(variable[...])
            observed[name] = Array(
                variable.dimensions, values, description | {"units": unit_of(attributes)}
            )
    return observed


def _window(variables: Stored, scalars: Mapping[str, float]) -> tuple[float, float]:
    """Return the length of the measured window, and R in its second half minus R in its first.

    R = E_rot/(E_rot + E_trans). The length is in units of the clock, T or collisions per particle.
    Both are NaN if the file has no series or no window.
    """
    clock = next((name for name in CLOCKS if name in variables), None)
    start = scalars.get("measured_from", math.nan)
    if clock is None or "R_series" not in variables or math.isnan(start):
        return math.nan, math.nan
    clock_values, ratio = variables[clock][...], variables["R_series"][...]
    end = scalars.get("plateau_end", math.nan)
    inside = (clock_values >= start) & (
        clock_values <= (clock_values[-1] if math.isnan(end) else end)
    )
    times, ratio = clock_values[inside], ratio[inside]
    halves = np.array_split(ratio, 2)
    if not halves[1].size:
        return math.nan, math.nan
    drift = float(halves[1].mean() - halves[0].mean())
    is_comparable = "stage_begin" not in variables or _are_even(times)
    return float(np.ptp(times)), drift if is_comparable else math.nan


def _are_even(times: np.ndarray) -> bool:
    """Return whether instants are equally spaced, up to rounding.

    Half of them then take half of the time.
    """
    intervals = np.diff(times)
    roundings = 1e-6 * intervals.mean() + 1e-15 * times[-1]
    return bool(np.ptp(intervals) <= roundings)


def _combined(points: Sequence[Summary]) -> Content:
    """Return the variables and attributes of the reduced dataset of points of one experiment.

    Raises InputError as `reduce_points` does.
    """
    _refuse_copies(points)
    attributes = _common_attributes(points)
    axes = axes_of(point.position for point in points)
    swept = third_axis(attributes)
    grid = GRID_DIMS if swept is None else (swept, *GRID_DIMS)
    stacks = _stacks(_of_one_length(points), axes)
    attributes["theory"] = equation_of(attributes, stacks).kind
    coordinates = dict(zip((*grid, "seed"), map(coordinate, axes), strict=True))
    third = {}
    if swept is not None:
        description = {"long_name": f"swept setting: {attributes['swept']}"}
        third[swept] = Array((swept,), coordinates.pop(swept), description)
    values = _over_seeds(stacks) | coordinates | _names(points)
    mixed = _mixtures(points, axes[:-1])
    for name in VERDICTS & values.keys():
        values[name] = _without_mixtures(values[name], mixed)
    reduced = described("reduced", values, "plateau_end" in stacks, grid)
    observed = _observables(points, axes, grid, mixed)
    _refuse_names(observed, third | reduced)
    return Content(third | reduced | observed, attributes)


def _refuse_copies(points: Sequence[Summary]) -> None:
    """Raise InputError for two seeds whose runs are copies of each other.

    They began in the same state and are either flagged as exact continuations or, as without random
    numbers, have the same results.
    """
    first_from: dict[Any, Summary] = {}
    for point in points:
        is_exact = point.attributes.get("initial_exact") == 1
        results = () if is_exact else tuple(map(str, map(point.scalars.get, RUN_IDENTIFIERS)))
        for state in filter(None, str(point.attributes.get("initial_digest", "")).split(",")):
            first = first_from.setdefault((point.position[:-1], state, is_exact, results), point)
            if first.position != point.position:
                seeds = f"{first.position[-1]} and {point.position[-1]}"
                legal = "be of runs that differ, and both go on alike from one state: use --reseed"
                raise InputError("seeds", seeds, legal)


def _names(points: Sequence[Summary]) -> NamedValues:
    """Return the names of species, energy sources and motions, by kind.

    Raises InputError unless all points share them.
    """
    names_by_kind = {}
    for kind in sorted({kind for point in points for kind in point.names}):
        variants = {point.names.get(kind, ()) for point in points}
        if len(variants) > 1:
            alternatives = " and ".join(
                sorted(", ".join(option) or "(none)" for option in variants)
            )
            raise InputError(f"{kind} of the points", alternatives, "be the same")
        names_by_kind[kind] = list(points[0].names[kind])
    return names_by_kind


def _mixtures(points: Sequence[Summary], axes: Sequence[Sequence[Any]]) -> np.ndarray:
    """Return a mask of points whose replicas, of all seeds, settle at two different R.

    It is over the grid, without seeds; `axes` are the coordinates. The mean of such replicas is no
    steady state, which a single seed may have too few replicas to show.
    """
    mixed, ensembles = np.zeros(tuple(map(len, axes)), bool), defaultdict(list)
    for point in points:
        ensembles[point.position[:-1]].append(point.replicas)
    for position, replicas in ensembles.items():
        mixed[index_of(position, axes)] = is_bimodal(np.concatenate(replicas))
    return mixed


def _of_one_length(points: Sequence[Summary]) -> list[Summary]:
    """Return the summaries with all series cut to the length of the shortest."""
    lengths = [len(point.scalars[SERIES[0]]) for point in points if SERIES[0] in point.scalars]
    shortest, shortened = min(lengths, default=None), []
    for point in points:
        scalars = point.scalars.items()
        shortened_scalars = {
            name: values[:shortest] if name in SERIES else values for name, values in scalars
        }
        shortened.append(point._replace(scalars=shortened_scalars))
    return shortened


def _stacks(points: Sequence[Summary], axes: Sequence[Sequence[Any]]) -> dict[str, np.ndarray]:
    """Return every variable of the summaries as an array (*grid, ..., seed), NaN at missing points.

    Raises InputError for a point that is given twice.
    """
    shape, positions = tuple(map(len, axes)), set()
    stacks = {
        name: np.full((*shape[:-1], *np.shape(value), shape[-1]), math.nan)
        for point in points
        for name, value in point.scalars.items()
    }
    for point in points:
        if point.position in positions:
            raise InputError("point (..., r, beta, seed)", point.position, "be given once")
        positions.add(point.position)
        index = index_of(point.position, axes)
        for name, value in point.scalars.items():
            stacks[name][index[:-1]][..., index[-1]] = value
    return stacks


def _over_seeds(stacks: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return means, sums, verdicts and errors over seeds, the last axis, by variable name.

    A verdict is the share of seeds with YES, or UNKNOWN.
    """
    reduced = {"n_seeds": np.isfinite(stacks["E_trans"]).sum(-1)}
    for name, values in stacks.items():
        combination = POINT[name].over_seeds if name in POINT else "mean"
        if combination:
            reduced[name] = np.nansum(values, -1) if combination == "sum" else _mean(values)
        if name in VERDICTS:
            reduced[name] = _share(values)
        if name in SCATTERED or (name in STAGE_VARIABLES_WITH_ERRORS and "stage_begin" in stacks):
            reduced[f"{name}_stderr"] = _standard_error(values)
        if name in SERIES_OF_SEEDS and "stage_begin" in stacks:
            reduced[f"{name}_seed"] = values
    for name in POOLED:
        reduced |= _errors(name, stacks) if name in stacks else {}
    return reduced | _kinds_of_error(stacks) if "R" in stacks else reduced


def _errors(
    name: str, stacks: Mapping[str, np.ndarray], interval: bool = True
) -> dict[str, np.ndarray]:
    """Return the pooled error of the mean of `name` over seeds, and its degrees of freedom.

    With `interval` they include the half width of the 95 % interval. They are by name,
    <name>_stderr, <name>_dof and <name>_ci95, over the grid.
    """
    is_finite = np.isfinite(stacks[name])
    columns = [stacks[column] for column in (name, f"{name}_stderr", f"{name}_dof")]
    names = [f"{name}_{end}" for end in ("stderr", "dof", *["ci95"] * interval)]
    errors = {error_name: np.full(is_finite.shape[:-1], math.nan) for error_name in names}
    for index in zip(*np.nonzero(is_finite.any(-1)), strict=True):
        error = pooled_error(*(values[index][is_finite[index]] for values in columns))
        half_width = [error.half_width(0.95)] if interval else []
        for error_name, value in zip(names, (*error, *half_width), strict=True):
            errors[error_name][index] = value
    return errors


def _observables(
    points: Sequence[Summary],
    axes: Sequence[Sequence[Any]],
    grid: tuple[str, ...],
    mixed: np.ndarray,
) -> dict[str, Array]:
    """Return the variables of observables: means over seeds, and coordinates, by name.

    Means have pooled errors and shares of trusted seeds. No mean is trusted at points that are
    `mixed` (see _mixtures). `grid` are the names of the grid's dimensions. Raises InputError if
    coordinates differ among points.
    """
    first_of = {
        name: variable for point in reversed(points) for name, variable in point.observed.items()
    }
    means = [name for name in first_of if f"{name}_stderr" in first_of]
    suffixes = ("", "_stderr", "_dof", "_trusted")
    combined_names = {f"{name}{end}" for name in means for end in suffixes}
    combined = {name: variable for name, variable in first_of.items() if name not in combined_names}
    for name, variable in (
        (name, variable) for point in points for name, variable in point.observed.items()
    ):
        if variable.values.shape != first_of[name].values.shape:
            legal = "have the same shape at all points"
            raise InputError(f"{name} of the points", variable.values.shape, legal)
        if name in combined and not np.array_equal(variable.values, first_of[name].values):
            raise InputError(f"{name} of the points", "not the same", "be the same at all points")
    scalars_of_points = [
        {
            label: variable.values
            for label, variable in point.observed.items()
            if label in combined_names
        }
        for point in points
    ]
    with_observables = [
        point._replace(scalars=scalars)
        for point, scalars in zip(points, scalars_of_points, strict=True)
    ]
    stacks = _stacks(with_observables, axes)
    for name in means:
        dims, attributes = (*grid, *first_of[name].dims), first_of[name].attrs
        mean = _mean(stacks[name])
        stderr, dof = _errors(name, stacks, interval=False).values()
        error_text, dof_text, _ = (
            description.long_name
            for description in errors_of(name, POOLED_ORIGIN, Variable("")).values()
        )
        combined[name] = Array(dims, mean, attributes)
        combined[f"{name}_stderr"] = Array(dims, stderr, attributes | {"long_name": error_text})
        combined[f"{name}_dof"] = Array(
            dims, dof, attributes | {"long_name": dof_text, "units": "1"}
        )
        if f"{name}_trusted" in stacks:  # points of earlier versions have no such flags
            combined[f"{name}_trusted"] = _trust(name, stacks, mixed, dims, attributes)
    return {name: combined[name] for name in first_of}


def _refuse_names(observed: Mapping[str, Array], others: Iterable[str]) -> None:
    """Raise InputError for a mean of an observable whose name another variable has already."""
    for name in sorted(observed.keys() & {*others}):
        if f"{name}_stderr" in observed:
            legal = "have a name that no other variable of the reduced dataset has"
            raise InputError(f"variable of {observed[name].attrs['observable']}", name, legal)


def _without_mixtures(share, mixed):
    """Return shares of seeds, with NO (0) where the mask `mixed` marks a mixture of two states."""
    mixed = mixed.reshape(*mixed.shape, *[1] * (share.ndim - mixed.ndim))
    return np.where(mixed & (share > NO), float(NO), share)


def _trust(name, stacks, mixed, dims, attributes) -> Array:
    """Return the share of seeds whose error of the variable `name` is trusted; NO for mixtures.

    `dims` and `attributes` belong to the variable.
    """
    share = _without_mixtures(_share(stacks[f"{name}_trusted"]), mixed)
    return Array(dims, share, attributes | {"long_name": share_of_trust(name), "units": "1"})


def _kinds_of_error(stacks: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return R of each seed, and the errors of R within the seeds and from their scatter.

    R = E_rot/(E_rot + E_trans). They are by name: R_seed, R_stderr_within and R_stderr_over_seeds.
    """
    is_finite = np.isfinite(stacks["R"])
    count = is_finite.sum(-1)
    square = np.where(is_finite, stacks["R_stderr"] ** 2, 0.0).sum(-1)
    within = np.where(count > 0, np.sqrt(square) / np.maximum(count, 1), math.nan)
    over_seeds = _standard_error(stacks["R"])
    return {"R_stderr_within": within, "R_stderr_over_seeds": over_seeds, "R_seed": stacks["R"]}


def _mean(values: np.ndarray) -> np.ndarray:
    """Return the mean of the finite values over the last axis, seeds; NaN without any."""
    count = np.isfinite(values).sum(-1)
    return np.where(count > 0, np.nansum(values, -1) / np.maximum(count, 1), math.nan)


def _share(verdicts: np.ndarray) -> np.ndarray:
    """Return the share of YES (1) over the last axis; UNKNOWN (-1) if at least half are unknown."""
    is_finite = np.isfinite(verdicts)
    yes, unknown = (
        _mean(np.where(is_finite, verdicts == verdict, math.nan)) for verdict in (YES, UNKNOWN)
    )
    return np.where(unknown >= 0.5, float(UNKNOWN), yes)


def _standard_error(values: np.ndarray) -> np.ndarray:
    """Return the standard error of the mean over the last axis, seeds; NaN below two values.

    The variance is divided by n - 1.
    """
    count = np.isfinite(values).sum(-1)
    square = np.nansum((values - _mean(values)[..., None]) ** 2, -1)
    return np.where(count > 1, np.sqrt(square / np.maximum(count * (count - 1), 1)), math.nan)


def _common_attributes(points: Sequence[Summary]) -> NamedValues:
    """Return the attributes that all `points` share, each attribute with versions of programs that
    differ as a list of them, and of settings that differ those that all share.

    Raises InputError for points that differ in any of COMMON_ATTRIBUTES.
    """
    shared = dict(points[0].attributes)
    swept = third_axis(shared)
    for name in (name for name in COMMON_ATTRIBUTES if name != swept):
        values = {str(point.attributes.get(name, "(none)")) for point in points}
        if len(values) > 1:
            raise InputError(f"{name} of the points", " and ".join(sorted(values)), "be the same")
    for name in list(shared):
        values = {str(point.attributes.get(name, "")) for point in points}
        differ = len(values) > 1 and name not in (SPECIES_ATTRIBUTE, LANGEVIN_ATTRIBUTE)
        if differ and name == "experiment_json":
            shared[name] = sorted_json(functools.reduce(shared_entries, map(json.loads, values)))
        elif differ and name in PROVENANCE:
            shared[name] = ", ".join(sorted(values))
        elif differ or name in (*POINT_ATTRIBUTES, swept):
            del shared[name]
    over = "r and beta" if swept is None else f"{swept}, r and beta"
    return shared | netcdf.COMMON_ATTRIBUTES | {"title": f"{shared['experiment']}: R over {over}"}
