"""What is off in a model of a freely cooling gas, and what the model costs.

Closed form, rate equations, direct simulation Monte Carlo and event-driven dynamics of the gas of
experiment `cooling` at one (r, beta); and, over (r, beta), how far the homogeneous gas is from the
closed form, whose velocities are Maxwellian and uncorrelated.
"""

import math
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from roughgas.accuracy import VARIABLES
from roughgas.statistics.errors import Estimate
from roughgas.statistics.fits import power_law
from roughgas.tasks import (
    along,
    cell,
    dataset,
    estimate,
    markdown,
    mean,
    over,
    stacked,
    stream,
    timed,
    variables,
)
from roughgas.tasks.free_cooling import (
    FreeCooling,
    corrected_ratio,
    event_driven,
    few_particles,
    homogeneous,
    rate_equations,
)
from roughgas.theory import cooling_ratio

METHODS = ("rate_equations", "dsmc", "event_driven")
SHARES = {
    "of_maxwellian": "Maxwellian, uncorrelated velocities",
    "of_number": "infinitely many particles",
    "of_dilution": "no density, no correlations of positions",
}
# Each kind of job draws from streams of its own
REFERENCE, EVENT_DRIVEN, DSMC, MAP, DENSITY = range(5)
SECONDS = 0.2  # of CPU, over which the time of one call is averaged
WARM = 2.0  # collisions per particle that are simulated beforehand, to have the code compiled


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """Return the names of the tasks, the longest first."""
    return [
        *(f"reference-{k}" for k in range(settings["reference"]["jobs"])),
        *(f"map-r{r}" for r in settings["map"]["r"]),
        *(f"density-r{r}-beta{beta}" for r, beta in settings["density"]["points"]),
        "event_driven",
        "dsmc",
        "theory",
    ]


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return what one task finds."""
    kind, _, place = task.partition("-")
    cooling = FreeCooling(experiments["cooling"], float(settings["r"]), float(settings["beta"]))
    jobs = {"map": _run_map, "density": _run_density, "reference": _reference, "theory": _theory}
    jobs |= {"event_driven": _event_driven, "dsmc": _dsmc}
    return xr.Dataset(*jobs[kind](cooling, settings, progress, place))


def _reference(cooling, settings, _, place):
    chosen = settings["reference"]
    event_driven(cooling, WARM, WARM, stream(settings, REFERENCE))
    length, seed = chosen["length"] / chosen["jobs"], stream(settings, REFERENCE, 1 + int(place))
    R, seconds = timed(event_driven, cooling, settings["segment"], length, seed)
    return ({"R": ("replica", R), "seconds": seconds},)


def _event_driven(cooling, settings, progress, _):
    one = partial(event_driven, cooling, settings["segment"])
    return _levels("event_driven", EVENT_DRIVEN, one, settings, progress)


def _dsmc(cooling, settings, progress, _):
    one = partial(few_particles, cooling)
    found, lengths = _levels("dsmc", DSMC, one, settings, progress)
    number, precision = settings["map"]["particles"], settings["density"]["precision"]
    many = homogeneous(cooling, number, precision, stream(settings, MAP, DSMC))
    return found | {f"homogeneous_{name}": x for name, x in many.items()}, lengths


def _levels(name, kind, one, settings, progress):
    """Return R and CPU seconds of every length and group; all have random numbers of their own."""
    lengths, groups = settings[name], settings["groups"]
    one(WARM, stream(settings, kind))
    values = np.empty((2, len(lengths), groups))
    for k, length in enumerate(lengths):
        for group in range(groups):
            R, seconds = timed(one, length, stream(settings, kind, 1 + k, group))
            values[:, k, group] = np.mean(R), seconds
            progress(k * groups + group + 1, len(lengths) * groups)
    dims = (f"{name}_length", "group")
    return {"R": (dims, values[0]), "seconds": (dims, values[1])}, {dims[0]: lengths}


def _theory(cooling, settings, progress, _):
    constants, lengths = cooling.constants, settings["rate_equations"]
    closed_R, closed_seconds = _averaged(lambda: float(cooling_ratio(*constants)))
    rates = []
    for k, length in enumerate(lengths):
        rates.append(_averaged(partial(rate_equations, length, *constants)))
        progress(k + 1, len(lengths))
    R, seconds = (("rate_equations_length", list(x)) for x in zip(*rates, strict=True))
    found = {"closed_form_R": closed_R, "closed_form_seconds": closed_seconds}
    return found | {"R": R, "seconds": seconds}, {"rate_equations_length": lengths}


def _averaged(function):
    """Return what a function returns, and the CPU seconds of a call, its mean over SECONDS."""
    calls, begin = 0, time.process_time()
    while (seconds := time.process_time() - begin) < SECONDS:
        found, calls = function(), calls + 1
    return found, seconds / calls


def _run_map(cooling, settings, progress, place):
    """The homogeneous gas at one r and every beta."""
    chosen, r, rows = settings["map"], place.removeprefix("r"), []
    row = [str(one) for one in chosen["r"]].index(r)
    homogeneous(cooling._replace(r=float(r), beta=1.0), 10, 1.0, 0)
    for k, beta in enumerate(chosen["beta"]):
        there = cooling._replace(r=float(r), beta=float(beta))
        seed = stream(settings, MAP, row, k)
        found = homogeneous(there, chosen["particles"], chosen["precision"], seed)
        explained = corrected_ratio(found["a20"], found["a11"], *there.constants)
        rows.append(found | {"theory": cooling_ratio(*there.constants), "explained": explained})
        progress(k + 1, len(chosen["beta"]))
    columns = {name: ("beta", [float(found[name]) for found in rows]) for name in rows[0]}
    return columns, {"beta": [float(one) for one in chosen["beta"]], "r": float(r)}


def _run_density(cooling, settings, _, place):
    """Event-driven dynamics at several packing fractions, and DSMC of as many particles and of
    many: their ratio tells what is due to the number."""
    chosen, (r, beta) = settings["density"], place.removeprefix("r").split("-beta")
    row = [[str(x) for x in one] for one in chosen["points"]].index([r, beta])
    cooling = cooling._replace(r=float(r), beta=float(beta))
    event_driven(cooling, WARM, WARM, stream(settings, DENSITY))
    runs = []
    for k, packing in enumerate(chosen["packings"]):
        there, seed = cooling.at_packing(packing), stream(settings, DENSITY, row, k)
        runs.append(timed(event_driven, there, settings["segment"], chosen["length"], seed))
    R, seconds = zip(*runs, strict=True)
    found = {"R": (("packing", "replica"), np.array(R)), "seconds": ("packing", list(seconds))}
    numbers = {"few": cooling.experiment["particles"], "many": settings["map"]["particles"]}
    seeds, dsmc_seconds = stream(settings, DENSITY, row, len(R)).spawn(2), 0.0
    for (name, number), seed in zip(numbers.items(), seeds, strict=True):
        one = homogeneous(cooling, number, chosen["precision"], seed)
        found |= {f"R_{name}": one["R"], f"R_{name}_stderr": one["R_stderr"]}
        dsmc_seconds += one["seconds"]
    found |= {"theory": float(cooling_ratio(*cooling.constants)), "dsmc_seconds": dsmc_seconds}
    return found, {"packing": list(chosen["packings"]), "r": float(r), "beta": float(beta)}


def combine(parts: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return errors and costs of all methods, and the map of what theory misses, from all tasks."""
    density = settings["density"]
    densities = [parts[f"density-r{r}-beta{beta}"] for r, beta in density["points"]]
    references = [parts[f"reference-{k}"] for k in range(settings["reference"]["jobs"])]
    reference = mean(np.concatenate([part.R.values for part in references]))
    closed = float(parts["theory"].closed_form_R)
    closed_stderr = closed / reference.value**2 * reference.stderr
    found = {
        "R_reference": reference,
        "reference_seconds": sum(float(part.seconds) for part in references),
        "reference_replicas": sum(part.sizes["replica"] for part in references),
        "closed_form_R": closed,
        "closed_form_error": Estimate(abs(closed / reference.value - 1), closed_stderr),
        "closed_form_seconds": float(parts["theory"].closed_form_seconds),
        **_methods(parts, settings, reference),
        **_shares(parts, reference),
        **_map([parts[f"map-r{r}"] for r in settings["map"]["r"]]),
        **stacked([_density(part) for part in densities]),
        "density_replicas": densities[0].sizes["replica"],
        "density_seconds": sum(float(part.seconds.sum() + part.dsmc_seconds) for part in densities),
        "map_r": np.array(settings["map"]["r"], float),
        "packing": np.array(density["packings"], float),
    }
    found["density_r"], found["density_beta"] = np.array(density["points"], float).T
    about = {"r": float(settings["r"]), "beta": float(settings["beta"]), "seed": settings["seed"]}
    known = variables(VARIABLES, "models")
    return dataset(known, found, **about).set_coords(["density_r", "density_beta"])


def error_bar(errors: np.ndarray, reference_stderr: float) -> np.ndarray:
    """Return the standard error of the rms over groups, axis -1, of Gaussian errors.

    It follows from their scatter about their mean, that mean, and the error of the reference, which
    is common to all.
    """
    groups = errors.shape[-1]
    square = np.mean(errors**2, axis=-1)
    scatter = errors.var(axis=-1, ddof=1) if groups > 1 else np.zeros(errors.shape[:-1])
    offset = np.maximum(square - scatter, 0.0)
    variance = (scatter**2 / 2 + offset * scatter) / groups + offset * reference_stderr**2
    return np.sqrt(variance / square)


def _methods(parts, settings, reference):
    """Return the rms relative error over groups of each length; rate equations have one group.

    The law is fitted to runs of whole segments: each of these has a transient to wait for.
    """
    found = {}
    for method in METHODS:
        part, lengths = parts.get(method, parts["theory"]), np.array(settings[method], float)
        R, seconds = (part[x].values.reshape(len(lengths), -1) for x in ("R", "seconds"))
        errors = R / reference.value - 1
        bar = error_bar(errors, reference.stderr / reference.value)
        found |= {
            f"{method}_length": lengths,
            f"{method}_R": R.mean(axis=-1),
            f"{method}_error": Estimate(np.sqrt(np.mean(errors**2, axis=-1)), bar),
            f"{method}_seconds": seconds.mean(axis=-1),
            f"{method}_groups": R.shape[1],
        }
    whole = np.array(settings["event_driven"]) >= settings["segment"]
    error, stderr, _ = found["event_driven_error"]
    weight = (error / stderr) ** 2
    law = power_law(found["event_driven_seconds"][whole], error[whole], weight[whole])
    found["event_driven_slope"] = Estimate(law.exponent, law.stderr)
    return found | {"event_driven_prefactor": law.prefactor}


def _shares(parts, reference):
    """Return what each approximation adds to the error of the closed form: factors whose product
    is that error, minus 1. Runs of DSMC are weighted by their lengths."""
    part = parts["dsmc"]
    many, R = estimate(part, "homogeneous_R"), part.R.values
    weights = np.broadcast_to(part.dsmc_length.values[:, np.newaxis], R.shape).astype(float)
    weights /= weights.sum()
    variances = R.var(axis=1, ddof=1)[:, np.newaxis]
    few = Estimate(np.sum(weights * R), np.sqrt(np.sum(weights**2 * variances)))
    closed, dilution = Estimate(float(parts["theory"].closed_form_R), 0.0), over(few, reference)
    factors = {"maxwellian": over(closed, many), "number": over(many, few), "dilution": dilution}
    return {
        "dsmc_floor": Estimate(abs(few.value / reference.value - 1), dilution.stderr),
        "dsmc_many_R": many,
        **{f"of_{name}": one._replace(value=one.value - 1) for name, one in factors.items()},
    }


def _map(rows: Sequence[xr.Dataset]):
    found = stacked([{str(k): one.values for k, one in row.data_vars.items()} for row in rows])
    theory, explained = found["theory"], found.pop("explained")
    found["gap"] = Estimate(found["R"] / theory - 1, found["R_stderr"] / theory)
    found["gap_explained"], found["beta"] = explained / theory - 1, rows[0].beta.values
    return {f"map_{name}": values for name, values in found.items()}


def _density(part: xr.Dataset):
    """Return R of an event-driven gas at each packing, and that over theory, its number of
    particles corrected for by DSMC."""
    many, few, theory = estimate(part, "R_many"), estimate(part, "R_few"), float(part.theory)
    rows = []
    for R in map(mean, part.R.values):
        gap = over(R, over(few, many))
        gap = Estimate(gap.value / theory - 1, gap.stderr / theory)
        rows.append({"density_R": R, "density_gap": gap})
    return stacked(rows)


def table(data: xr.Dataset) -> str:
    """Return what each model of a cooling gas tends to, and what the Maxwellian theory misses."""
    closed, floor = (f"{cell(data, x, '±', 100)} %" for x in ("closed_form_error", "dsmc_floor"))
    until = (0.01 / float(data.event_driven_prefactor)) ** (1 / float(data.event_driven_slope))
    # the shortest run of DSMC whose noise is down to its floor, within a third
    near = data.dsmc_seconds.values[data.dsmc_error.values < 4 / 3 * float(data.dsmc_floor)]
    rows = [
        ["closed form, the theory of free cooling", closed, f"{data.closed_form_seconds:.1e} s"],
        ["rate equations", closed, f"{data.rate_equations_seconds[-1]:.1e} s"],
        ["DSMC", floor, f"{near[0] if len(near) else math.nan:.2g} s"],
        ["event-driven", "none", f"{until:.2g} s for 1 %"],
    ]
    parts = [[what, f"{cell(data, name, '±', 100)} %"] for name, what in SHARES.items()]
    head = ["β", *(f"r = {r:g}" for r in data.map_r.values)]
    gaps = [
        [f"{row.map_beta:g}", *(cell(one, "map_gap", "±", 100) for one in along(row, "map_r"))]
        for row in along(data, "map_beta")
    ]
    return (
        f"## Model error (r = {data.attrs['r']:g}, β = {data.attrs['beta']:g})\n\n"
        f"Against events, R = {cell(data, 'R_reference', '.5f')}:\n\n"
        f"{markdown(['model', 'tends to an error of R of', 'CPU time'], rows)}\n"
        f"What the error of the closed form is made of:\n\n"
        f"{markdown(['assumption', 'changes R by'], parts)}\n"
        f"R of the homogeneous gas (DSMC) over R of the theory of free cooling, minus 1, in %:\n\n"
        f"{markdown(head, gaps)}"
    )
