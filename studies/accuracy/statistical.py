"""Statistical error of R against CPU seconds: the gain by longer runs and by more seeds.

R is estimated many times, from disjoint stretches of independent simulations ("chains"), each of
which is equilibrated once. The estimates of one kind form a level: means over runs of one length,
or over several runs of the shortest length. Their root mean square distance from the mean of other
chains, the reference, is the observed error of the level. By the law of large numbers it falls as
t^(-1/2) with the time t of measurement, either way.
"""

import math
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from roughgas.base import NamedValues
from roughgas.base.fields import OwnSettings
from roughgas.scene import build
from roughgas.simulation import protocols
from roughgas.simulation.energies import ratio
from roughgas.simulation.experiment import Experiment
from roughgas.statistics.errors import autocorrelation_time, period_means
from roughgas.statistics.estimates import Estimate
from roughgas.statistics.fits import power_law
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
SCENES = ("vibrated", "sheared", "cooling")
WAYS = ("length", "seeds")
RUN_KINDS = ("reference", *WAYS)
RELATIVE_ERRORS = (0.01, 0.003, 0.001)
LENGTH_UNITS = {"vibrated": "T", "sheared": "T", "cooling": "collisions per particle"}
BLOCK_LENGTH = 50  # autocorrelation times; correlations have vanished after ten
EXTRA_GROUP_COST = 4
"""A level gets more groups than the minimum until it costs a fourth of the longest level."""


def tasks(settings: OwnSettings) -> list[str]:
    """Return the names of the tasks, the longest first."""
    return [f"{scene}-{kind}" for kind in RUN_KINDS for scene in SCENES]


class Chain:
    """A gas of an experiment, advanced stretch by stretch.

    Lengths are in T, in a cooling gas in collisions per particle. It starts from a lattice, a
    cooling gas with the experiment's thermalisation; `rng` draws the initial state.
    """

    def __init__(self, experiment: Experiment[Any], r, beta, equilibrate, rng) -> None:
        self.kind, self.schedule = protocols.protocol_of(experiment), experiment.schedule
        self.gas = self.kind.start(build(experiment, r, beta), experiment, rng)
        self._sample(equilibrate)

    def measure(self, length: float) -> np.ndarray:
        """Return R of each period (or sample) in the next `length` of the chain."""
        R = ratio(self.gas.energies(self._sample(length)))
        return period_means(R, self.kind.samples_per_period(self.schedule))

    def _sample(self, length: float):
        every = self.schedule.sample_every
        return self.kind.sample(self.gas, every, round(length / every))


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return estimates of R and their costs.

    A reference has dimension (chain,), levels have (level, group), NaN where a level has fewer
    groups. `equilibration` is the CPU seconds until the first measurement of each chain.
    """
    scene, kind = task.split("-")
    lengths, material = settings["scenes"][scene], (float(settings["r"]), float(settings["beta"]))
    streams = seed_sequence(settings, SCENES.index(scene), RUN_KINDS.index(kind))
    start = partial(Chain, experiments[scene], *material, lengths["equilibrate"])

    def chains(count):
        for done, seed in enumerate(streams.spawn(count)):
            progress(done, count)
            yield timed(start, np.random.default_rng(seed))
        progress(count, count)

    start(np.random.default_rng(0)).measure(lengths["shortest"])  # compiles
    measured = _reference if kind == "reference" else partial(_estimates, way=kind)
    return xr.Dataset(measured(settings, lengths["shortest"], chains))


def time_from_blocks(series: np.ndarray, length: int) -> float:
    """Return the integrated autocorrelation time in samples, from means over `length` samples.

    Unlike an estimate with a window it includes slow tails. Its relative error is (2
    length/samples)^(1/2), and its relative bias minus half of itself over `length`. NaN for fewer
    than two blocks.
    """
    if len(series) < 2 * length:
        return math.nan
    return float(length * period_means(series, length).var(ddof=1) / series.var())


def _reference(settings, shortest, chains) -> dict[str, tuple]:
    """Return R and costs of chains that together are `reference` times as long as the longest
    level."""
    total = settings["reference"] * 2 ** (settings["levels"] - 1)
    length = math.ceil(total / settings["chains"]) * shortest
    rows = []
    for chain, equilibration in chains(settings["chains"]):
        before = chain.gas.costs.collisions
        R, seconds = timed(chain.measure, length)
        unit, windowed = length / len(R), autocorrelation_time(R)
        row = {
            "equilibration": equilibration,
            "R": R.mean(),
            "variance": R.var(),
            "autocorrelation_time": time_from_blocks(R, math.ceil(BLOCK_LENGTH * windowed)) * unit,
            "windowed_time": windowed * unit,
            "time": length,
            "seconds": seconds,
            "contacts": chain.gas.costs.collisions - before,
        }
        rows.append(row)
    return {name: ("chain", [row[name] for row in rows]) for name in rows[0]}


def _estimates(settings, shortest, chains, way) -> dict[str, tuple]:
    """Return R and CPU seconds of the groups of all levels, NaN where a level has fewer groups.

    At level k, a group is a run of 2^k times the shortest length, or 2^k runs of this length, each
    of another chain.
    """
    sizes = 2 ** np.arange(settings["levels"])
    stretches = np.maximum(
        1, sizes[::-1] // EXTRA_GROUP_COST
    )  # for each group that a level must have
    if way == "length":
        number, runs, lengths = settings["groups"], np.ones_like(sizes), sizes * shortest
    else:
        number, runs, lengths = sizes[-1], sizes, np.full_like(sizes, shortest, np.float64)
        stretches = -(-settings["groups"] * stretches * sizes // number)
    rows, equilibration = [], []
    for chain, seconds in chains(number):
        equilibration.append(seconds)
        timings = (timed(chain.measure, length) for length in np.repeat(lengths, stretches))
        rows.append([(R.mean(), seconds) for R, seconds in timings])
    measured = np.moveaxis(np.array(rows), 2, 0)  # (2, chains, stretches)
    filled = np.full((2, len(sizes), np.max(number * stretches // runs)), np.nan)
    for level, level_values in enumerate(np.split(measured, np.cumsum(stretches)[:-1], axis=2)):
        level_values = level_values if way == "length" else level_values.swapaxes(1, 2)
        R, seconds = level_values.reshape(2, -1, runs[level])
        filled[:, level, : len(R)] = R.mean(axis=1), seconds.sum(axis=1)
    dims = ("level", "group")
    values = {"R": (dims, filled[0]), "seconds": (dims, filled[1])}
    return {**values, "equilibration": ("chain", equilibration)}


def combine(task_results: Mapping[str, xr.Dataset], settings: OwnSettings) -> xr.Dataset:
    """Return errors, slopes, autocorrelation times and the costs of an accuracy, from all tasks."""
    values = stack_rows([_scene(scene, task_results, settings) for scene in SCENES])
    values |= {"scene": list(SCENES), "length_unit": [LENGTH_UNITS[scene] for scene in SCENES]}
    values |= {"way": list(WAYS), "relative_error": list(RELATIVE_ERRORS)}
    attributes = {key: settings[key] for key in ("r", "beta", "seed")}
    return dataset(read_variables(VARIABLES, "statistical"), values, **attributes)


def observed(R: np.ndarray, seconds: np.ndarray, truth: float) -> NamedValues:
    """Return errors of the estimates `R`, shape (levels, groups) with NaN where a level has fewer.

    The root mean square error of K normal estimates has the relative error (2 K)^(-1/2); its
    logarithm has the variance 1/(2 K), and is too small by 1/(2 K) on average.
    """
    groups = np.isfinite(R).sum(axis=1)
    error, seconds = np.sqrt(np.nanmean((R - truth) ** 2, axis=1)), np.nanmean(seconds, axis=1)
    law = power_law(seconds, error, 2.0 * groups, bias=-0.5 / groups)
    return {
        "groups": groups,
        "seconds": seconds,
        "error": Estimate(error, error / np.sqrt(2 * groups)),
        "slope": Estimate(law.exponent, law.stderr),
    }


def noise(error: np.ndarray, groups: np.ndarray, length: np.ndarray) -> Estimate:
    """Return the variance of R's mean times the length of the run, averaged over levels.

    This is the variance of R times its integrated autocorrelation time, less the share tau/(2
    length) that a short run of exponentially correlated samples misses.
    """
    average = float(np.average(error**2 * length, weights=groups))
    return Estimate(average, average * math.sqrt(2 / groups.sum()))


def _scene(scene, task_results, settings) -> NamedValues:
    """Return every variable of one scene; costs are for one core and one seed."""
    reference, *ways = (task_results[f"{scene}-{kind}"] for kind in RUN_KINDS)
    R = mean_estimate(reference.R.values)
    levels = stack_rows([observed(way.R.values, way.seconds.values, R.value) for way in ways])
    sizes = 2.0 ** np.arange(settings["levels"])
    one_each = np.ones_like(sizes)
    lengths = np.array([sizes, one_each]) * settings["scenes"][scene]["shortest"]
    equilibration = np.concatenate([way.equilibration.values for way in (reference, *ways)])
    seconds = float(reference.seconds.sum())
    measured = seconds + sum(float(way.seconds.sum()) for way in ways)
    per_length, error = seconds / float(reference.time.sum()), levels["error"]
    spread = noise(error[0], levels["groups"][0], lengths[0])
    length_needed = spread.value / (np.array(RELATIVE_ERRORS) * R.value) ** 2
    measuring = per_length * length_needed
    return levels | {
        "R": R,
        "variance": float(reference.variance.mean()),
        "autocorrelation_time": mean_estimate(reference.autocorrelation_time.values),
        "windowed_time": float(reference.windowed_time.mean()),
        "noise": spread,
        "equilibration_seconds": equilibration.mean(),
        "seconds_per_length": per_length,
        "collisions_per_second": float(reference.contacts.sum()) / seconds,
        "cpu_seconds": measured + equilibration.sum(),
        "length": lengths,
        "seeds": np.array([one_each, sizes]).astype(int),
        "length_needed": length_needed,
        "seconds_needed": Estimate(
            equilibration.mean() + measuring, measuring * spread.stderr / spread.value
        ),
    }


def table(data: xr.Dataset) -> str:
    """Return the cost of an accuracy of R in each scene, and slopes of errors over time,
    Markdown."""
    head = ["scene", "R", "slope, longer runs", "slope, more seeds", "autocorrelation time"]
    costs = ["scene", "equilibration", *(f"{x:.1%}" for x in data.relative_error.values)]
    rows, prices = [], []
    for scene_data in slices_along(data, "scene"):
        scene, unit = scene_data.scene.item(), scene_data.length_unit.item()
        slopes = [table_cell(way, "slope", ".3f") for way in slices_along(scene_data, "way")]
        time = f"{table_cell(scene_data, 'autocorrelation_time', '.2f')} {unit}"
        rows.append([scene, table_cell(scene_data, "R", ".5f"), *slopes, time])
        unit = "T" if unit == "T" else "c.p.p."
        cells = [
            f"{cost.seconds_needed:.2g} ± {cost.seconds_needed_stderr:.1g} s"
            f" ({cost.length_needed:.3g} {unit})"
            for cost in slices_along(scene_data, "relative_error")
        ]
        prices.append([scene, f"{scene_data.equilibration_seconds:.2g} s", *cells])
    at = f"r = {data.attrs['r']}, β = {data.attrs['beta']}"
    return (
        f"## Statistical error ({at})\n\n{markdown(head, rows)}\n"
        "CPU seconds of one core for a relative error of R, equilibration included, and how long"
        f" the run is:\n\n{markdown(costs, prices)}"
    )
