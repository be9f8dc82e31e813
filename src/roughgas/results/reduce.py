"""From points to one reduced dataset for each experiment.

A reduced dataset has the dimensions (r, beta, seed), preceded by the parameter that the experiment
sweeps besides, if there is one (`third_axis`). The error bar pools the scatter over independent
seeds with the errors within them (statistics/errors.py), since a scatter over few seeds alone is
badly known; each of the two is kept beside it. What observables have watched is combined alike: a
point's file says itself what its observables are, by the attribute `observable`.
"""

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, NamedTuple

import netCDF4
import numpy as np

from roughgas.base import InputError
from roughgas.data import netcdf
from roughgas.data.netcdf import Content, DamagedError, opened, require, unit_of
from roughgas.data.point import Point, write_point
from roughgas.data.reduced import (
    GRID,
    OF_COOLING,
    OF_STAGES,
    POOLED,
    SCATTERED,
    SOUND,
    STAGED,
    VERDICTS,
    check_sound,
    read_reduced,
    third_axis,
)
from roughgas.data.variables import (
    CLOCKS,
    POINT,
    Array,
    Variable,
    described,
    errors_of,
    share_of_trust,
)
from roughgas.data.variables import POOLED as SEEDS
from roughgas.statistics.errors import NO, UNKNOWN, YES, pooled
from roughgas.statistics.steady_state import is_bimodal
from roughgas.theory.prediction import LANGEVIN, SPECIES, equation_of

if TYPE_CHECKING:
    import xarray

SAME = ("experiment", "scale", "dimension", "inertia", "spin_share", "mu", "particles", "swept")
OF_A_POINT = ("r", "beta", "seed", "r_label", "beta_label", "variant", "swept_value", "command")
PROVENANCE = ("roughgas_version", "numpy_version", "numba_version", "kernel_source_hash")
SAME_RUN = ("R", "E_trans", "E_rot", "collisions", "measured_from")
"""Results whose bits agree in copies of a run alone."""
SERIES = (*OF_COOLING, *(name for name in OF_STAGES if POINT[name].dims[0] == "sample"))
OF_SPECIES = [name for name, one in POINT.items() if one.dims == ("species",) and one.over_seeds]

Stored = Mapping[str, netCDF4.Variable]  # of an open file


class Summary(NamedTuple):
    """The scalars and attributes of one point's file, and where it is in the reduced dataset."""

    scalars: dict[str, Any]  # float, or (species,) of them
    attributes: dict[str, Any]
    place: tuple[Any, ...]  # (r, beta, seed), preceded by the value of what is swept besides
    replicas: np.ndarray  # R of each, of a cooling gas: else empty
    names: Mapping[str, tuple[str, ...]] = {}  # of species, and of what exchanges energy
    observed: Mapping[str, Array] = {}  # what observables have watched


def reduce_points(paths: Iterable[str | Path], output: str | Path, put_aside: bool = False) -> None:
    """Combine the points at `paths` (of one experiment, in any order) into the dataset `output`.

    A path is that of a dataset, or of a folder with a dataset for each seed. Seeds that are missing
    at an (r, beta) are NaN in R_seed, and do not count in n_seeds and the means.
    With `put_aside`, which is for workflows, a damaged point is renamed, so that it is made anew.
    Raises InputError if there are no paths, several experiments, the same point or the same run
    twice, a point whose numbers cannot be right, or a file that cannot be read.
    """
    folders = (path.glob("seed*.nc") if path.is_dir() else [path] for path in map(Path, paths))
    summary = _or_put_aside if put_aside else _summary
    points = [summary(file) for files in folders for file in sorted(files)]
    if not points:
        raise InputError("number of points to reduce", 0, "be at least 1")
    netcdf.write_netcdf(output, _combined(points))


def reduced_in_memory(points: Iterable[Point]) -> "xarray.Dataset":
    """Return the reduced dataset of points, as `reduce_points` and `read_reduced` make it of files.

    Raises InputError as these.
    """
    with TemporaryDirectory() as folder:
        for number, point in enumerate(points):
            write_point(Path(folder, f"seed{number}.nc"), point)
        output = Path(folder, "reduced.nc")
        reduce_points([folder], output)
        return read_reduced(output)


def _or_put_aside(path: Path) -> Summary:
    """Return a point; put a damaged file aside, so that the workflow makes it anew."""
    try:
        return _summary(path)
    except DamagedError as error:
        if path.suffix != ".nc":  # no workflow has made it
            raise
        path.replace(f"{path}.damaged")
        legal = f"{error.legal}, and now called {path.name}.damaged: run the same command again"
        raise DamagedError("point", path, legal) from error


def _summary(path: Path) -> Summary:
    with opened(path, netcdf.POINT) as file:
        file.set_auto_maskandscale(False)  # nothing is masked or packed: it need not search
        variables, attributes = file.variables, netcdf.attributes_of(file)
        require(attributes, ("swept_value",) if "swept" in attributes else (), path)
        found = [name for name, about in POINT.items() if not about.dims]
        scalars: dict[str, Any] = {
            name: netcdf.number_in(variables[name]) for name in found if name in variables
        }
        scalars |= {name: variables[name][...] for name in OF_SPECIES if name in variables}
        if "E_trans_species" in scalars:  # a ratio in each seed: what all species share is no error
            energy = scalars["E_trans_species"]
            scalars["T_ratio_species"] = energy / energy[0]
        scalars |= _series(variables)
        exchanged = ("source", "motion") if "stage_begin" in variables else ()
        named = [*exchanged, *(["species"] if "species" in variables else [])]
        names = {name: tuple(variables[name][...].tolist()) for name in named}
        for name in scalars.keys() & SOUND:
            check_sound(path, name, scalars[name])
        scalars["measured_for"], scalars["R_drift"] = _window(variables, scalars)
        observed = _observed(variables)
        replicas = variables["R_replica"][...] if "R_replica" in variables else np.empty(0)
    swept = (attributes["swept_value"],) if "swept" in attributes else ()
    r, beta, seed = (attributes[name] for name in (*GRID, "seed"))
    place = (*swept, float(r), float(beta), int(seed))
    return Summary(scalars, attributes, place, replicas, names, observed)


def _series(variables: Stored) -> dict[str, np.ndarray]:
    """Return what changes over time, of a cooling gas that has no R for all times, and of a gas
    through stages."""
    if "stage_begin" in variables:
        names = [name for name in (*SERIES, *OF_STAGES) if name in variables]
        series = {name: variables[name][...] for name in names}
        return {"time_series": variables["time"][...]} | series
    if "time_series" not in variables:
        return {}
    return {name: variables[name][...] for name in SERIES if name in variables}


def _observed(variables: Stored) -> dict[str, Array]:
    """Return the variables of observables in the file of a point."""
    found = {}
    for name, variable in variables.items():
        if "observable" in variable.ncattrs():
            about = {key: variable.getncattr(key) for key in variable.ncattrs()}
            kept = {key: about[key] for key in ("long_name", "observable")}
            values = np.asarray(variable[...])
            found[name] = Array(variable.dimensions, values, kept | {"units": unit_of(about)})
    return found


def _window(variables: Stored, scalars: Mapping[str, float]) -> tuple[float, float]:
    """Return the length of the measured window, and the drift of R between its halves."""
    clock = next((name for name in CLOCKS if name in variables), None)
    begin = scalars.get("measured_from", math.nan)
    if clock is None or "R_series" not in variables or math.isnan(begin):
        return math.nan, math.nan
    at, ratio = variables[clock][...], variables["R_series"][...]
    end = scalars.get("plateau_end", math.nan)
    inside = (at >= begin) & (at <= (at[-1] if math.isnan(end) else end))
    halves = np.array_split(ratio[inside], 2)
    if not halves[1].size:
        return math.nan, math.nan
    return float(np.ptp(at[inside])), float(halves[1].mean() - halves[0].mean())


def _combined(points: Sequence[Summary]) -> Content:
    """Return the reduced dataset of points of one experiment."""
    _refuse_copies(points)
    attributes = _common_attributes(points)
    columns = zip(*(point.place for point in points), strict=True)
    axes = [sorted(set(column), key=lambda x: (isinstance(x, str), x)) for column in columns]
    swept = third_axis(attributes)
    grid = GRID if swept is None else (swept, *GRID)
    stacks = _stacks(_of_one_length(points), axes)
    attributes["theory"] = equation_of(attributes, stacks).kind
    coordinates = dict(zip((*grid, "seed"), map(_coordinate, axes), strict=True))
    third = {}
    if swept is not None:
        about = {"long_name": f"swept setting: {attributes['swept']}"}
        third[swept] = Array((swept,), coordinates.pop(swept), about)
    values = _over_seeds(stacks) | coordinates | _names(points)
    mixed = _mixed(points, axes[:-1])
    for name in VERDICTS & values.keys():
        values[name] = _of_one_state(values[name], mixed)
    reduced = described("reduced", values, "plateau_end" in stacks, grid)
    seen = _observables(points, axes, grid, mixed)
    return Content(third | reduced | seen, attributes)


def _refuse_copies(points: Sequence[Summary]) -> None:
    """Raise InputError for two seeds whose runs began in the same state and went on alike: either
    to the last bit, or, as in a scene without random numbers, with the same results."""
    begun: dict[Any, Summary] = {}
    for point in points:
        exact = point.attributes.get("initial_exact") == 1
        alike = () if exact else tuple(map(str, map(point.scalars.get, SAME_RUN)))
        for state in filter(None, str(point.attributes.get("initial_digest", "")).split(",")):
            other = begun.setdefault((point.place[:-1], state, exact, alike), point)
            if other.place != point.place:
                seeds = f"{other.place[-1]} and {point.place[-1]}"
                legal = "be of runs that differ, and both go on alike from one state: use --reseed"
                raise InputError("seeds", seeds, legal)


def _names(points: Sequence[Summary]) -> dict[str, Any]:
    """Return the names of species, and of what exchanges energy, which all points share."""
    found = {}
    for kind in sorted({kind for point in points for kind in point.names}):
        names = {point.names.get(kind, ()) for point in points}
        if len(names) > 1:
            given = " and ".join(sorted(", ".join(one) or "(none)" for one in names))
            raise InputError(f"{kind} of the points", given, "be the same")
        found[kind] = list(points[0].names[kind])
    return found


def _mixed(points: Sequence[Summary], axes: Sequence[Sequence[Any]]) -> np.ndarray:
    """Return where replicas of all seeds rest at two different R: their mean is no steady state.

    Each seed may have too few of one kind to tell, or none.
    """
    mixed, ensembles = np.zeros(tuple(map(len, axes)), bool), defaultdict(list)
    for point in points:
        ensembles[point.place[:-1]].append(point.replicas)
    for place, found in ensembles.items():
        index = tuple(axis.index(value) for axis, value in zip(axes, place, strict=True))
        mixed[index] = is_bimodal(np.concatenate(found))
    return mixed


def _coordinate(values: Sequence[Any]) -> np.ndarray:
    """Return numbers as they are, or as text if some values are words."""
    if any(isinstance(value, str) for value in values):
        values = [value if isinstance(value, str) else f"{value:.10g}" for value in values]
    return np.array(values)


def _of_one_length(points: Sequence[Summary]) -> list[Summary]:
    """Return the points with series as long as the shortest of them."""
    lengths = [len(point.scalars[SERIES[0]]) for point in points if SERIES[0] in point.scalars]
    shortest, found = min(lengths, default=None), []
    for point in points:
        known = point.scalars.items()
        cut = {name: one[:shortest] if name in SERIES else one for name, one in known}
        found.append(point._replace(scalars=cut))
    return found


def _stacks(points: Sequence[Summary], axes: Sequence[Sequence[Any]]) -> dict[str, np.ndarray]:
    """Return every scalar over the axes, NaN where there is no point."""
    shape, seen = tuple(map(len, axes)), set()
    stacks = {
        name: np.full((*shape[:-1], *np.shape(value), shape[-1]), math.nan)
        for point in points
        for name, value in point.scalars.items()
    }
    for point in points:
        if point.place in seen:
            raise InputError("point (..., r, beta, seed)", point.place, "be given once")
        seen.add(point.place)
        index = tuple(axis.index(value) for axis, value in zip(axes, point.place, strict=True))
        for name, value in point.scalars.items():
            stacks[name][index[:-1]][..., index[-1]] = value
    return stacks


def _over_seeds(stacks: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return the variables of a reduced dataset by name."""
    reduced = {"n_seeds": np.isfinite(stacks["E_trans"]).sum(-1)}
    for name, values in stacks.items():
        how = POINT[name].over_seeds if name in POINT else "mean"
        if how:
            reduced[name] = np.nansum(values, -1) if how == "sum" else _mean(values)
        if name in VERDICTS:
            reduced[name] = _share(values)
        if name in SCATTERED or (name in STAGED and "stage_begin" in stacks):
            reduced[f"{name}_stderr"] = _standard_error(values)
    for name in POOLED:
        reduced |= _errors(name, stacks) if name in stacks else {}
    return reduced | _kinds_of_error(stacks) if "R" in stacks else reduced


def _errors(
    name: str, stacks: Mapping[str, np.ndarray], interval: bool = True
) -> dict[str, np.ndarray]:
    """Return the pooled error of a mean over seeds, its degrees of freedom, and its interval."""
    there = np.isfinite(stacks[name])
    given = [stacks[one] for one in (name, f"{name}_stderr", f"{name}_dof")]
    names = [f"{name}_{end}" for end in ("stderr", "dof", *["ci95"] * interval)]
    found = {one: np.full(there.shape[:-1], math.nan) for one in names}
    for place in zip(*np.nonzero(there.any(-1)), strict=True):
        error = pooled(*(values[place][there[place]] for values in given))
        half = [error.half_width(0.95)] if interval else []
        for one, value in zip(names, (*error, *half), strict=True):
            found[one][place] = value
    return found


def _observables(
    points: Sequence[Summary],
    axes: Sequence[Sequence[Any]],
    grid: tuple[str, ...],
    mixed: np.ndarray,
) -> dict[str, Array]:
    """Return what observables have watched: means over seeds, with pooled errors and shares of
    trust, and coordinates. No mean is trusted where replicas are `mixed` (see _mixed).

    Raises InputError where points have watched along different coordinates.
    """
    first = {name: one for point in reversed(points) for name, one in point.observed.items()}
    means = [name for name in first if f"{name}_stderr" in first]
    ends = ("", "_stderr", "_dof", "_trusted")
    several = {f"{name}{end}" for name in means for end in ends}
    found = {name: one for name, one in first.items() if name not in several}
    for name, one in ((name, one) for point in points for name, one in point.observed.items()):
        if one.values.shape != first[name].values.shape:
            legal = "have the same shape at all points"
            raise InputError(f"{name} of the points", one.values.shape, legal)
        if name in found and not np.array_equal(one.values, first[name].values):
            raise InputError(f"{name} of the points", "not the same", "be the same at all points")
    watched = [{n: one.values for n, one in p.observed.items() if n in several} for p in points]
    seen = [p._replace(scalars=one) for p, one in zip(points, watched, strict=True)]
    stacks = _stacks(seen, axes)
    for name in means:
        dims, about = (*grid, *first[name].dims), first[name].attrs
        mean = _mean(stacks[name])
        stderr, dof = _errors(name, stacks, interval=False).values()
        said, freedom, _ = (x.long_name for x in errors_of(name, SEEDS, Variable("")).values())
        found[name] = Array(dims, mean, about)
        found[f"{name}_stderr"] = Array(dims, stderr, about | {"long_name": said})
        found[f"{name}_dof"] = Array(dims, dof, about | {"long_name": freedom, "units": "1"})
        if f"{name}_trusted" in stacks:  # points of earlier versions have no such flags
            found[f"{name}_trusted"] = _trust(name, stacks, mixed, dims, about)
    return {name: found[name] for name in first}


def _of_one_state(share, mixed):
    """Return shares of seeds, NO where the seeds are a mixture of two states."""
    mixed = mixed.reshape(*mixed.shape, *[1] * (share.ndim - mixed.ndim))
    return np.where(mixed & (share > NO), float(NO), share)


def _trust(name, stacks, mixed, dims, about) -> Array:
    """Return the share of seeds whose error of a variable is trusted; none of a mixture of two."""
    share = _of_one_state(_share(stacks[f"{name}_trusted"]), mixed)
    return Array(dims, share, about | {"long_name": share_of_trust(name), "units": "1"})


def _kinds_of_error(stacks: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return R of each seed, and its errors from within the seeds and from their scatter."""
    there = np.isfinite(stacks["R"])
    count = there.sum(-1)
    square = np.where(there, stacks["R_stderr"] ** 2, 0.0).sum(-1)
    within = np.where(count > 0, np.sqrt(square) / np.maximum(count, 1), math.nan)
    over_seeds = _standard_error(stacks["R"])
    return {"R_stderr_within": within, "R_stderr_over_seeds": over_seeds, "R_seed": stacks["R"]}


def _mean(values: np.ndarray) -> np.ndarray:
    """Return the mean over the last axis of finite values, NaN if there are none."""
    count = np.isfinite(values).sum(-1)
    return np.where(count > 0, np.nansum(values, -1) / np.maximum(count, 1), math.nan)


def _share(verdicts: np.ndarray) -> np.ndarray:
    """Return the share of YES over the last axis; UNKNOWN where half of them or more are."""
    there = np.isfinite(verdicts)
    yes, unknown = (_mean(np.where(there, verdicts == one, math.nan)) for one in (YES, UNKNOWN))
    return np.where(unknown >= 0.5, float(UNKNOWN), yes)


def _standard_error(values: np.ndarray) -> np.ndarray:
    """Return the standard error of the mean over the last axis (ddof = 1), NaN below two values."""
    count = np.isfinite(values).sum(-1)
    square = np.nansum((values - _mean(values)[..., None]) ** 2, -1)
    return np.where(count > 1, np.sqrt(square / np.maximum(count * (count - 1), 1)), math.nan)


def _common_attributes(points: Sequence[Summary]) -> dict[str, Any]:
    """Return the attributes that all points share; of versions that differ, all."""
    shared = dict(points[0].attributes)
    swept = third_axis(shared)
    for name in (name for name in SAME if name != swept):
        values = {str(point.attributes.get(name, "(none)")) for point in points}
        if len(values) > 1:
            raise InputError(f"{name} of the points", " and ".join(sorted(values)), "be the same")
    for name in list(shared):
        values = {str(point.attributes.get(name, "")) for point in points}
        differ = len(values) > 1 and name not in (SPECIES, LANGEVIN)
        if differ and name in PROVENANCE:
            shared[name] = ", ".join(sorted(values))
        elif differ or name in (*OF_A_POINT, swept):
            del shared[name]
    over = "r and beta" if swept is None else f"{swept}, r and beta"
    return shared | netcdf.COMMON_ATTRIBUTES | {"title": f"{shared['experiment']}: R over {over}"}
