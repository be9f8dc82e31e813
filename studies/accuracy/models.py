"""Errors and costs of models of a freely cooling gas.

Closed form, rate equations, direct simulation Monte Carlo and event-driven dynamics of the gas of
experiment `cooling` at one (r, beta); and, over (r, beta), the difference between the homogeneous
gas and the closed form, which assumes Maxwellian and uncorrelated velocities.
"""

import math
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np
import xarray as xr

from roughgas.base.fields import OwnSettings
from roughgas.statistics.estimates import Estimate
from roughgas.statistics.fits import power_law
from roughgas.tasks import (
    dataset,
    estimate_of,
    estimate_ratio,
    markdown,
    mean_estimate,
    read_variables,
    seed_sequence,
    slices_along,
    stack_rows,
    table_cell,
    timed,
)
from roughgas.tasks.free_cooling import (
    FreeCooling,
    corrected_ratio,
    dsmc_means,
    dsmc_ratio,
    event_driven_ratios,
    rate_equation_ratio,
)
from roughgas.theory import cooling_ratio

VARIABLES = Path(__file__).with_name("variables.yaml")
METHODS = ("rate_equations", "dsmc", "event_driven")
ASSUMPTIONS = {
    "of_maxwellian": "Maxwellian, uncorrelated velocities",
    "of_number": "infinitely many particles",
    "of_dilution": "no density, no correlations of positions",
}
# First keys of random streams, by kind of job
REFERENCE, EVENT_DRIVEN, DSMC, MAP, DENSITY = range(5)
AVERAGING_SECONDS = 0.2  # CPU seconds over which the time of one call is averaged
WARM_UP = 2.0  # collisions per particle simulated beforehand, so that the code is compiled


def tasks(settings: OwnSettings) -> list[str]:
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
    """Return the dataset of one task."""
    kind, _, label = task.partition("-")
    cooling = FreeCooling(experiments["cooling"], float(settings["r"]), float(settings["beta"]))
    jobs = {"map": _run_map, "density": _run_density, "reference": _reference, "theory": _theory}
    jobs |= {"event_driven": _event_driven, "dsmc": _dsmc}
    return xr.Dataset(*jobs[kind](cooling, settings, progress, label))


def _reference(cooling, settings, progress, label):
    reference = settings["reference"]
    event_driven_ratios(cooling, WARM_UP, WARM_UP, seed_sequence(settings, REFERENCE))
    length, seed = (
        reference["length"] / reference["jobs"],
        seed_sequence(settings, REFERENCE, 1 + int(label)),
    )
    R, seconds = timed(event_driven_ratios, cooling, settings["segment"], length, seed)
    progress(1, 1)
    return ({"R": ("replica", R), "seconds": seconds},)


def _event_driven(cooling, settings, progress, _):
    solve = partial(event_driven_ratios, cooling, settings["segment"])
    return _levels("event_driven", EVENT_DRIVEN, solve, settings, progress)


def _dsmc(cooling, settings, progress, _):
    solve = partial(dsmc_ratio, cooling)
    values, lengths = _levels("dsmc", DSMC, solve, settings, progress)
    number, precision = settings["map"]["particles"], settings["density"]["precision"]
    many_particles = dsmc_means(cooling, number, precision, seed_sequence(settings, MAP, DSMC))
    return values | {f"homogeneous_{name}": x for name, x in many_particles.items()}, lengths


def _levels(name, kind, solve, settings, progress):
    """Return R and CPU seconds for each length and group, with independent random numbers."""
    lengths, groups = settings[name], settings["groups"]
    solve(WARM_UP, seed_sequence(settings, kind))
    values = np.empty((2, len(lengths), groups))
    for k, length in enumerate(lengths):
        for group in range(groups):
            R, seconds = timed(solve, length, seed_sequence(settings, kind, 1 + k, group))
            values[:, k, group] = np.mean(R), seconds
            progress(k * groups + group + 1, len(lengths) * groups)
    dims = (f"{name}_length", "group")
    return {"R": (dims, values[0]), "seconds": (dims, values[1])}, {dims[0]: lengths}


def _theory(cooling, settings, progress, _):
    constants, lengths = cooling.constants, settings["rate_equations"]
    closed_R, closed_seconds = _average_call(lambda: float(cooling_ratio(*constants)))
    rates = []
    for k, length in enumerate(lengths):
        rates.append(_average_call(partial(rate_equation_ratio, length, *constants)))
        progress(k + 1, len(lengths))
    R, seconds = (("rate_equations_length", list(x)) for x in zip(*rates, strict=True))
    values = {"closed_form_R": closed_R, "closed_form_seconds": closed_seconds}
    return values | {"R": R, "seconds": seconds}, {"rate_equations_length": lengths}


def _average_call(function):
    """Return the value of a function, and the CPU seconds of a call, averaged over
    AVERAGING_SECONDS."""
    calls, begin = 0, time.process_time()
    while (seconds := time.process_time() - begin) < AVERAGING_SECONDS:
        value, calls = function(), calls + 1
    return value, seconds / calls


def _run_map(cooling, settings, progress, label):
    """Run the homogeneous gas at one r and every beta."""
    map_settings, r, rows = settings["map"], label.removeprefix("r"), []
    row = [str(value) for value in map_settings["r"]].index(r)
    dsmc_means(cooling._replace(r=float(r), beta=1.0), 10, 1.0, 0)
    for k, beta in enumerate(map_settings["beta"]):
        gas = cooling._replace(r=float(r), beta=float(beta))
        seed = seed_sequence(settings, MAP, row, k)
        values = dsmc_means(gas, map_settings["particles"], map_settings["precision"], seed)
        explained = corrected_ratio(values["a20"], values["a11"], *gas.constants)
        rows.append(values | {"theory": cooling_ratio(*gas.constants), "explained": explained})
        progress(k + 1, len(map_settings["beta"]))
    columns = {name: ("beta", [float(values[name]) for values in rows]) for name in rows[0]}
    return columns, {"beta": [float(value) for value in map_settings["beta"]], "r": float(r)}


def _run_density(cooling, settings, progress, label):
    """Run events at several packing fractions, and DSMC with the same and with a large number of
    particles: the ratio of both corrects for the finite number."""
    density_settings, (r, beta) = settings["density"], label.removeprefix("r").split("-beta")
    row = [[str(x) for x in point] for point in density_settings["points"]].index([r, beta])
    cooling = cooling._replace(r=float(r), beta=float(beta))
    event_driven_ratios(cooling, WARM_UP, WARM_UP, seed_sequence(settings, DENSITY))
    runs = []
    for k, packing in enumerate(density_settings["packings"]):
        gas, seed = cooling.at_packing(packing), seed_sequence(settings, DENSITY, row, k)
        runs.append(
            timed(event_driven_ratios, gas, settings["segment"], density_settings["length"], seed)
        )
        progress(k + 1, len(density_settings["packings"]))
    R, seconds = zip(*runs, strict=True)
    values = {"R": (("packing", "replica"), np.array(R)), "seconds": ("packing", list(seconds))}
    numbers = {"few": cooling.experiment.particles, "many": settings["map"]["particles"]}
    seeds, dsmc_seconds = seed_sequence(settings, DENSITY, row, len(R)).spawn(2), 0.0
    for (name, number), seed in zip(numbers.items(), seeds, strict=True):
        dsmc = dsmc_means(cooling, number, density_settings["precision"], seed)
        values |= {f"R_{name}": dsmc["R"], f"R_{name}_stderr": dsmc["R_stderr"]}
        dsmc_seconds += dsmc["seconds"]
    values |= {"theory": float(cooling_ratio(*cooling.constants)), "dsmc_seconds": dsmc_seconds}
    return values, {
        "packing": list(density_settings["packings"]),
        "r": float(r),
        "beta": float(beta),
    }


def combine(task_results: Mapping[str, xr.Dataset], settings: OwnSettings) -> xr.Dataset:
    """Return errors and costs of all methods, and the map of deviations from theory, from all
    tasks."""
    density = settings["density"]
    densities = [task_results[f"density-r{r}-beta{beta}"] for r, beta in density["points"]]
    references = [task_results[f"reference-{k}"] for k in range(settings["reference"]["jobs"])]
    reference = mean_estimate(np.concatenate([data.R.values for data in references]))
    closed = float(task_results["theory"].closed_form_R)
    closed_stderr = closed / reference.value**2 * reference.stderr
    values = {
        "R_reference": reference,
        "reference_seconds": sum(float(data.seconds) for data in references),
        "reference_replicas": sum(data.sizes["replica"] for data in references),
        "closed_form_R": closed,
        "closed_form_error": Estimate(abs(closed / reference.value - 1), closed_stderr),
        "closed_form_seconds": float(task_results["theory"].closed_form_seconds),
        **_methods(task_results, settings, reference),
        **_assumption_shares(task_results, reference),
        **_map([task_results[f"map-r{r}"] for r in settings["map"]["r"]]),
        **stack_rows([_density(data) for data in densities]),
        "density_replicas": densities[0].sizes["replica"],
        "density_seconds": sum(float(data.seconds.sum() + data.dsmc_seconds) for data in densities),
        "map_r": np.array(settings["map"]["r"], float),
        "packing": np.array(density["packings"], float),
    }
    values["density_r"], values["density_beta"] = np.array(density["points"], float).T
    attributes = {
        "r": float(settings["r"]),
        "beta": float(settings["beta"]),
        "seed": settings["seed"],
    }
    descriptions = read_variables(VARIABLES, "models")
    return dataset(descriptions, values, **attributes).set_coords(["density_r", "density_beta"])


def error_bar(errors: np.ndarray, reference_stderr: float) -> np.ndarray:
    """Return the standard error of the rms over groups, axis -1, of Gaussian errors.

    It follows from their scatter about their mean, that mean, and the error of the reference, which
    is common to all groups.
    """
    groups = errors.shape[-1]
    square = np.mean(errors**2, axis=-1)
    scatter = errors.var(axis=-1, ddof=1) if groups > 1 else np.zeros(errors.shape[:-1])
    offset = np.maximum(square - scatter, 0.0)
    variance = (scatter**2 / 2 + offset * scatter) / groups + offset * reference_stderr**2
    return np.sqrt(variance / square)


def _methods(task_results, settings, reference):
    """Return the rms relative error over groups of each length; rate equations have one group.

    The law is fitted to runs of whole segments, as each of these includes a transient.
    """
    values = {}
    for method in METHODS:
        data, lengths = (
            task_results.get(method, task_results["theory"]),
            np.array(settings[method], float),
        )
        R, seconds = (data[x].values.reshape(len(lengths), -1) for x in ("R", "seconds"))
        errors = R / reference.value - 1
        bar = error_bar(errors, reference.stderr / reference.value)
        values |= {
            f"{method}_length": lengths,
            f"{method}_R": R.mean(axis=-1),
            f"{method}_error": Estimate(np.sqrt(np.mean(errors**2, axis=-1)), bar),
            f"{method}_seconds": seconds.mean(axis=-1),
            f"{method}_groups": R.shape[1],
        }
    whole_segments = np.array(settings["event_driven"]) >= settings["segment"]
    error, stderr, _ = values["event_driven_error"]
    weight = (error / stderr) ** 2
    law = power_law(
        values["event_driven_seconds"][whole_segments],
        error[whole_segments],
        weight[whole_segments],
    )
    values["event_driven_slope"] = Estimate(law.exponent, law.stderr)
    return values | {"event_driven_prefactor": law.prefactor}


def _assumption_shares(task_results, reference):
    """Return the contribution of each approximation to the error of the closed form: factors whose
    product is that error, minus 1. Runs of DSMC are weighted by their lengths."""
    dsmc = task_results["dsmc"]
    homogeneous_R, R = estimate_of(dsmc, "homogeneous_R"), dsmc.R.values
    weights = np.broadcast_to(dsmc.dsmc_length.values[:, np.newaxis], R.shape).astype(float)
    weights /= weights.sum()
    variances = R.var(axis=1, ddof=1)[:, np.newaxis]
    few_R = Estimate(np.sum(weights * R), np.sqrt(np.sum(weights**2 * variances)))
    closed, dilution = (
        Estimate(float(task_results["theory"].closed_form_R), 0.0),
        estimate_ratio(few_R, reference),
    )
    factors = {
        "maxwellian": estimate_ratio(closed, homogeneous_R),
        "number": estimate_ratio(homogeneous_R, few_R),
        "dilution": dilution,
    }
    return {
        "dsmc_floor": Estimate(abs(few_R.value / reference.value - 1), dilution.stderr),
        "dsmc_many_R": homogeneous_R,
        **{
            f"of_{name}": factor._replace(value=factor.value - 1)
            for name, factor in factors.items()
        },
    }


def _map(rows: Sequence[xr.Dataset]):
    columns = stack_rows(
        [{str(name): column.values for name, column in row.data_vars.items()} for row in rows]
    )
    theory, explained = columns["theory"], columns.pop("explained")
    columns["gap"] = Estimate(columns["R"] / theory - 1, columns["R_stderr"] / theory)
    columns["gap_explained"], columns["beta"] = explained / theory - 1, rows[0].beta.values
    return {f"map_{name}": values for name, values in columns.items()}


def _density(data: xr.Dataset):
    """Return R of an event-driven gas at each packing, and its ratio to theory minus 1, corrected
    by DSMC for the number of particles."""
    many_particles, same_number, theory = (
        estimate_of(data, "R_many"),
        estimate_of(data, "R_few"),
        float(data.theory),
    )
    rows = []
    for R in map(mean_estimate, data.R.values):
        gap = estimate_ratio(R, estimate_ratio(same_number, many_particles))
        gap = Estimate(gap.value / theory - 1, gap.stderr / theory)
        rows.append({"density_R": R, "density_gap": gap})
    return stack_rows(rows)


def table(data: xr.Dataset) -> str:
    """Return the limiting errors of models of a cooling gas, and the map of deviations,
    Markdown."""
    closed, floor = (
        f"{table_cell(data, x, '±', 100)} %" for x in ("closed_form_error", "dsmc_floor")
    )
    until = (0.01 / float(data.event_driven_prefactor)) ** (1 / float(data.event_driven_slope))
    # the shortest run of DSMC whose noise is down to its floor, within a third
    near = data.dsmc_seconds.values[data.dsmc_error.values < 4 / 3 * float(data.dsmc_floor)]
    rows = [
        ["closed form, the theory of free cooling", closed, f"{data.closed_form_seconds:.1e} s"],
        ["rate equations", closed, f"{data.rate_equations_seconds[-1]:.1e} s"],
        ["DSMC", floor, f"{near[0] if len(near) else math.nan:.2g} s"],
        ["event-driven", "none", f"{until:.2g} s for 1 %"],
    ]
    shares = [[text, f"{table_cell(data, name, '±', 100)} %"] for name, text in ASSUMPTIONS.items()]
    head = ["β", *(f"r = {r:g}" for r in data.map_r.values)]
    gaps = [
        [
            f"{row.map_beta:g}",
            *(table_cell(point, "map_gap", "±", 100) for point in slices_along(row, "map_r")),
        ]
        for row in slices_along(data, "map_beta")
    ]
    return (
        f"## Model error (r = {data.attrs['r']:g}, β = {data.attrs['beta']:g})\n\n"
        f"Against events, R = {table_cell(data, 'R_reference', '.5f')}:\n\n"
        f"{markdown(['model', 'tends to an error of R of', 'CPU time'], rows)}\n"
        f"What the error of the closed form is made of:\n\n"
        f"{markdown(['assumption', 'changes R by'], shares)}\n"
        f"R of the homogeneous gas (DSMC) over R of the theory of free cooling, minus 1, in %:\n\n"
        f"{markdown(head, gaps)}"
    )
