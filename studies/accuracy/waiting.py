"""What waiting costs: beds from their start, without spin, until they have settled.

R and E_trans after a wait are compared with those of the settled bed, long after the start, within
each run; errors come from the scatter of runs. Times are in T, R is the share of rotation.
"""

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from roughgas.base import NamedValues
from roughgas.base.fields import OwnSettings
from roughgas.gas import Gas, build, ratio
from roughgas.simulation import steady
from roughgas.simulation.experiment import Experiment
from roughgas.simulation.gas_memory import GasMemory, ThermalState, gas_memory
from roughgas.statistics.errors import autocorrelation_time, period_means
from roughgas.statistics.estimates import Estimate
from roughgas.tasks import (
    dataset,
    markdown,
    mean_estimate,
    read_variables,
    seed_sequence,
    slices_along,
    stack_rows,
    table_cell,
    timed,
)

VARIABLES = Path(__file__).with_name("variables.yaml")
INSTANT = 0.1  # length of a window that counts as an instant, over the time since the start
FITTED = 0.05, 0.4
"""Range of the lack of E_trans in which its e-fold is fitted, until it first falls below."""


class Series(NamedTuple):
    """Means of each period of the floor, and the contacts of a particle per T."""

    R: np.ndarray  # (periods,)
    E_trans: np.ndarray  # (periods,), m a^2/T^2
    E_rot: np.ndarray  # (periods,), m a^2/T^2
    frequency: float


def tasks(settings: OwnSettings) -> list[str]:
    """Return the names of the tasks, one per bed, the longest first."""
    points = sorted(settings["points"], key=lambda point: -point["runs"] * point["length"])
    return [task_name(point) for point in points]


def task_name(point: OwnSettings) -> str:
    """Return the name of the task of a point."""
    return f"waiting-r{point['r']}-beta{point['beta']}"


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return, for each run of a bed, its settled state and what it lacks after each wait.

    Dimensions are (run, wait); NaN stands for a measurement that would end in the settled bed.
    """
    names = [task_name(point) for point in settings["points"]]
    index = names.index(task)
    point, experiment = settings["points"][index], experiments["vibrated"]
    scene, rows = build(experiment, float(point["r"]), float(point["beta"])), []
    for done, seed in enumerate(seed_sequence(settings, index).spawn(point["runs"])):
        progress(done, point["runs"])
        gas = steady.start(scene, experiment, np.random.default_rng(seed))
        row, seconds = timed(followed, gas, experiment, settings, point)
        rows.append(row | {"seconds": seconds})
    progress(point["runs"], point["runs"])
    columns = stack_rows(rows)
    theory = memory_of_settled(scene, columns, experiment)
    dims = ("run", "wait")
    return xr.Dataset(
        {name: (dims[: column.ndim], column) for name, column in columns.items()}
        | {"memory": theory.of_R, "settling": theory.settling}
    )


def followed(gas: Gas, experiment: Experiment[Any], settings, point) -> NamedValues:
    """Simulate a run of a bed, and return the values of its row by name."""
    start = sampled(gas, experiment, point["settled"])
    settled = sampled(gas, experiment, point["length"] - point["settled"])
    waits, length = np.array(settings["waits"]), settings["measure"]
    R = settled.R.mean()
    return {
        "R": R,
        "E_trans": settled.E_trans.mean(),
        "E_rot": settled.E_rot.mean(),
        "frequency": settled.frequency,
        "autocorrelation_time": autocorrelation_time(settled.R) * period_of(experiment),
        "R_bias": np.array([window(start.R, wait, length, experiment) for wait in waits]) - R,
        "E_early": np.array(
            [window(start.E_trans, wait, instant(wait), experiment) for wait in waits]
        ),
    }


def sampled(gas: Gas, experiment: Experiment[Any], length: float) -> Series:
    """Advance a gas by `length` T, and return the means of each period."""
    every, before = experiment.schedule.sample_every, gas.costs.collisions
    energies = gas.energies(steady.sample(gas, every, round(length / every)))
    columns = ratio(energies), energies.translational, energies.rotational
    per_period = steady.samples_per_period(experiment.schedule)
    contacts = 2.0 * (gas.costs.collisions - before) / gas.particles
    return Series(*(period_means(column, per_period) for column in columns), contacts / length)


def period_of(experiment: Experiment[Any]) -> float:
    """Return the interval between two values of a Series, in T."""
    schedule = experiment.schedule
    return schedule.sample_every * steady.samples_per_period(schedule)


def instant(wait: float) -> float:
    """Return the length of the window after a wait that counts as an instant, in T."""
    return max(1.0, INSTANT * wait)


def window(series: np.ndarray, wait: float, length: float, experiment: Experiment[Any]) -> float:
    """Return the mean of a series over `length` T after a wait; NaN if it is too short."""
    period = period_of(experiment)
    first, last = round(wait / period), round((wait + length) / period)
    return float(series[first:last].mean()) if last <= len(series) else math.nan


def memory_of_settled(scene, columns: NamedValues, experiment: Experiment[Any]) -> GasMemory:
    """Return theory's times in the settled state, the mean over runs."""
    T_tr, T_rot = (np.array([2.0 * columns[name].mean()]) for name in ("E_trans", "E_rot"))
    lengths = tuple(math.inf if side is None else side for side in experiment.lengths)
    frequency = float(columns["frequency"].mean())
    return gas_memory(scene, ThermalState(T_tr, T_rot, frequency, experiment.particles, lengths))


def combine(task_results: Mapping[str, xr.Dataset], settings: OwnSettings) -> xr.Dataset:
    """Return the biases after each wait, and measured and theoretical times, from all tasks."""
    points, waits = settings["points"], np.array(settings["waits"], float)
    times = waits + 0.5 * np.array([instant(wait) for wait in waits])
    rows = [_bed(task_results[task_name(point)], times) for point in points]
    values = stack_rows(rows) | {"wait": waits, "time": times}
    for key in ("r", "beta"):
        values[key] = [float(point[key]) for point in points]
    for key in ("settled", "length", "runs"):
        values[key] = [point[key] for point in points]
    attributes = {key: settings[key] for key in ("measure", "seed")}
    return dataset(read_variables(VARIABLES, "waiting"), values, **attributes)


def _bed(data: xr.Dataset, times: np.ndarray) -> NamedValues:
    """Return the variables of a bed by name; `times` (waits,) are those of E_trans, in T."""
    biases = [mean_estimate(column) for column in data.R_bias.values.T]
    lack, lack_stderr = jackknife(data.E_early.values, data.E_trans.values, lack_of_energy)
    e_fold, e_fold_stderr = jackknife(
        data.E_early.values,
        data.E_trans.values,
        lambda early, settled: fitted_e_fold(times, lack_of_energy(early, settled)),
    )
    return {
        **{name: mean_estimate(data[name].values) for name in ("R", "E_trans", "frequency")},
        "autocorrelation_time": mean_estimate(data.autocorrelation_time.values),
        "memory": float(data.memory),
        "settling": float(data.settling),
        "e_fold": Estimate(float(e_fold), float(e_fold_stderr)),
        "R_bias": np.array([bias.value for bias in biases]),
        "R_bias_stderr": np.array([bias.stderr for bias in biases]),
        "lack": lack,
        "lack_stderr": lack_stderr,
        "seconds": float(data.seconds.sum()),
    }


def lack_of_energy(early: np.ndarray, settled: np.ndarray) -> np.ndarray:
    """Return 1 - E_trans after each wait over the settled one, (waits,).

    `early` (runs, waits) and `settled` (runs,) are E_trans.
    """
    return 1.0 - early.mean(axis=0) / settled.mean()


def fitted_e_fold(times: np.ndarray, lack: np.ndarray) -> float:
    """Return the e-fold of a lack that decays, while it is in FITTED; NaN for fewer than two times.

    `times` and `lack` are (waits,). Noise after the first time below FITTED has no influence.
    """
    last = np.argmax(lack < FITTED[0]) if (lack < FITTED[0]).any() else len(lack)
    inside = np.flatnonzero(lack[:last] < FITTED[1])
    if len(inside) < 2:
        return math.nan
    return float(-1.0 / np.polyfit(times[inside], np.log(lack[inside]), 1)[0])


def jackknife(early: np.ndarray, settled: np.ndarray, function: Callable) -> tuple[Any, Any]:
    """Return a function of all runs, and its standard error by leaving out one run at a time."""
    runs = np.arange(len(settled))
    without = np.array([function(early[runs != k], settled[runs != k]) for k in runs])
    return function(early, settled), math.sqrt(len(runs) - 1.0) * without.std(axis=0)


def table(data: xr.Dataset) -> str:
    """Return the times of each bed and the bias of R after its waits, Markdown."""
    head = ["bed", "R", "memory of R", "by theory", "e-fold of E_trans", "by theory", "CPU"]
    rows, biases = [], []
    for bed in slices_along(data, "point"):
        name = f"r = {float(bed.r):g}, β = {float(bed.beta):g}".replace("-", "\N{MINUS SIGN}")
        e_fold = f"{table_cell(bed, 'e_fold')} T" if np.isfinite(bed.e_fold) else "not known"
        memory, cpu = f"{table_cell(bed, 'autocorrelation_time')} T", f"{float(bed.seconds):.0f} s"
        theory = [f"{float(bed[key]):.4g} T" for key in ("memory", "settling")]
        rows.append([name, table_cell(bed, "R"), memory, theory[0], e_fold, theory[1], cpu])
        known = bed.isel(wait=np.flatnonzero(np.isfinite(bed.R_bias)))
        cells = [table_cell(after, "R_bias") for after in slices_along(known, "wait")]
        biases.append([name, *cells, *[""] * (data.sizes["wait"] - len(cells))])
    waits = ["bed", *(f"{wait:g} T" for wait in data.wait.values)]
    return (
        f"## Waits of beds\n\n{markdown(head, rows)}\n"
        f"Mean R of {data.attrs['measure']:g} T after a wait, minus R of the settled bed:\n\n"
        f"{markdown(waits, biases)}"
    )
