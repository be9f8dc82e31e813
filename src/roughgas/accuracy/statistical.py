"""The statistical error of R against CPU seconds: how run length and number of seeds lower it.

R is estimated many times, from disjoint stretches of independent simulations ("chains"), each of
which is equilibrated once. The estimates of one kind are called a level: means over runs of one
length, or over several runs of the shortest length. Their root mean square distance from the mean
of other chains, the reference, is the observed error of the level. By the law of large numbers it
falls as t^(-1/2) with the time t of measurement, either way.
"""

import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from roughgas.accuracy import SCENES, VARIABLES
from roughgas.scene import build
from roughgas.simulation import schedule
from roughgas.simulation.energies import ratio
from roughgas.simulation.steady import samples_per_period
from roughgas.statistics.errors import Estimate, autocorrelation_time, period_means
from roughgas.statistics.fits import power_law
from roughgas.tasks import along, cell, dataset, markdown, mean, stacked, stream, timed, variables

WAYS = ("length", "seeds")
PARTS = ("reference", *WAYS)
RELATIVE_ERRORS = (0.01, 0.003, 0.001)
LENGTH_UNITS = {"vibrated": "T", "sheared": "T", "cooling": "collisions per particle"}
BLOCK = 50  # autocorrelation times: beyond ten of them no tail is left
GENEROSITY = 4
"""A level gets more groups than it must have until it costs a fourth of the longest one."""


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """Return the names of the tasks, the longest first."""
    return [f"{scene}-{part}" for part in PARTS for scene in SCENES]


class Chain:
    """One gas of an experiment, advanced piece by piece.

    Lengths are in T, in a cooling gas in collisions per particle. It starts from a lattice, a
    cooling gas with the experiment's thermalisation; `rng` draws the initial state.
    """

    def __init__(self, experiment: Mapping[str, Any], r, beta, equilibrate, rng) -> None:
        self.kind, self.schedule = schedule.of(experiment), experiment["schedule"]
        self.gas = self.kind.start(build(experiment, r, beta), experiment, rng)
        self._sample(equilibrate)

    def measure(self, length: float) -> np.ndarray:
        """Return R of each period (or sample) in the next `length` of the chain."""
        R = ratio(self.gas.energies(self._sample(length)))
        return period_means(R, samples_per_period(self.schedule))

    def _sample(self, length: float):
        every = self.schedule["sample_every"]
        return self.kind.sample(self.gas, every, round(length / every))


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return estimates of R and their costs.

    A reference has dimension (chain,), levels have (level, group), NaN where a level has fewer
    groups. `equilibration` is the CPU seconds until the first measurement of each chain.
    """
    scene, part = task.split("-")
    own, material = settings["scenes"][scene], (float(settings["r"]), float(settings["beta"]))
    streams = stream(settings, SCENES.index(scene), PARTS.index(part))
    start = partial(Chain, experiments[scene], *material, own["equilibrate"])

    def chains(count):
        for done, seed in enumerate(streams.spawn(count)):
            progress(done, count)
            yield timed(start, np.random.default_rng(seed))
        progress(count, count)

    start(np.random.default_rng(0)).measure(own["shortest"])  # compiles
    measured = _reference if part == "reference" else partial(_estimates, way=part)
    return xr.Dataset(measured(settings, own["shortest"], chains))


def time_from_blocks(series: np.ndarray, length: int) -> float:
    """Return the integrated autocorrelation time in samples, from means over `length` samples.

    Unlike an estimate with a window it misses no slow tail; known to (2 length/samples)^(1/2)
    only; too small by half of itself over `length`, relatively. NaN for fewer than two blocks.
    """
    if len(series) < 2 * length:
        return math.nan
    return float(length * period_means(series, length).var(ddof=1) / series.var())


def _reference(settings, shortest, chains) -> dict[str, tuple]:
    """Chains that are together `reference` times as long as the longest level."""
    total = settings["reference"] * 2 ** (settings["levels"] - 1)
    length = math.ceil(total / settings["chains"]) * shortest
    rows = []
    for chain, equilibration in chains(settings["chains"]):
        before = chain.gas.recorder.collisions
        R, seconds = timed(chain.measure, length)
        unit, windowed = length / len(R), autocorrelation_time(R)
        row = {
            "equilibration": equilibration,
            "R": R.mean(),
            "variance": R.var(),
            "autocorrelation_time": time_from_blocks(R, math.ceil(BLOCK * windowed)) * unit,
            "windowed_time": windowed * unit,
            "time": length,
            "seconds": seconds,
            "contacts": chain.gas.recorder.collisions - before,
        }
        rows.append(row)
    return {name: ("chain", [row[name] for row in rows]) for name in rows[0]}


def _estimates(settings, shortest, chains, way) -> dict[str, tuple]:
    """R and CPU seconds of the groups of all levels, NaN where a level has no more groups.

    At level k, a group is a run of 2^k times the shortest length, or 2^k runs of this length, each
    of another chain.
    """
    sizes = 2 ** np.arange(settings["levels"])
    stretches = np.maximum(1, sizes[::-1] // GENEROSITY)  # for each group that a level must have
    if way == "length":
        number, runs, lengths = settings["groups"], np.ones_like(sizes), sizes * shortest
    else:
        number, runs, lengths = sizes[-1], sizes, np.full_like(sizes, shortest, np.float64)
        stretches = -(-settings["groups"] * stretches * sizes // number)
    rows, equilibration = [], []
    for chain, seconds in chains(number):
        equilibration.append(seconds)
        parts = (timed(chain.measure, length) for length in np.repeat(lengths, stretches))
        rows.append([(R.mean(), seconds) for R, seconds in parts])
    measured = np.moveaxis(np.array(rows), 2, 0)  # (2, chains, stretches)
    filled = np.full((2, len(sizes), np.max(number * stretches // runs)), np.nan)
    for level, part in enumerate(np.split(measured, np.cumsum(stretches)[:-1], axis=2)):
        part = part if way == "length" else part.swapaxes(1, 2)
        R, seconds = part.reshape(2, -1, runs[level])
        filled[:, level, : len(R)] = R.mean(axis=1), seconds.sum(axis=1)
    dims = ("level", "group")
    found = {"R": (dims, filled[0]), "seconds": (dims, filled[1])}
    return {**found, "equilibration": ("chain", equilibration)}


def combine(parts: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return errors, slopes, autocorrelation times and what an accuracy costs, from all tasks."""
    found = stacked([_scene(scene, parts, settings) for scene in SCENES])
    found |= {"scene": list(SCENES), "length_unit": [LENGTH_UNITS[scene] for scene in SCENES]}
    found |= {"way": list(WAYS), "relative_error": list(RELATIVE_ERRORS)}
    about = {key: settings[key] for key in ("r", "beta", "seed")}
    return dataset(variables(VARIABLES, "statistical"), found, **about)


def observed(R: np.ndarray, seconds: np.ndarray, truth: float) -> dict[str, Any]:
    """Return errors of the estimates `R`, shape (levels, groups) with NaN where a level has fewer.

    K normal estimates know their root mean square error to (2 K)^(-1/2) of itself, and its
    logarithm, which is too small by 1/(2 K) on average, with the variance 1/(2 K).
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
    """Return the variance of R's mean times the length of the run, mean over levels.

    It is the variance of R times its integrated autocorrelation time, less the share tau/(2 length)
    that a short run of exponentially correlated samples misses.
    """
    average = float(np.average(error**2 * length, weights=groups))
    return Estimate(average, average * math.sqrt(2 / groups.sum()))


def _scene(scene, parts, settings) -> dict[str, Any]:
    """Return every variable of one scene; costs are those on one core, with one seed."""
    reference, *ways = (parts[f"{scene}-{part}"] for part in PARTS)
    R = mean(reference.R.values)
    levels = stacked([observed(part.R.values, part.seconds.values, R.value) for part in ways])
    sizes = 2.0 ** np.arange(settings["levels"])
    alone = np.ones_like(sizes)
    lengths = np.array([sizes, alone]) * settings["scenes"][scene]["shortest"]
    equilibration = np.concatenate([part.equilibration.values for part in (reference, *ways)])
    seconds = float(reference.seconds.sum())
    measured = seconds + sum(float(part.seconds.sum()) for part in ways)
    per_length, error = seconds / float(reference.time.sum()), levels["error"]
    spread = noise(error[0], levels["groups"][0], lengths[0])
    needed = spread.value / (np.array(RELATIVE_ERRORS) * R.value) ** 2
    measuring = per_length * needed
    return levels | {
        "R": R,
        "variance": float(reference.variance.mean()),
        "autocorrelation_time": mean(reference.autocorrelation_time.values),
        "windowed_time": float(reference.windowed_time.mean()),
        "noise": spread,
        "equilibration_seconds": equilibration.mean(),
        "seconds_per_length": per_length,
        "collisions_per_second": float(reference.contacts.sum()) / seconds,
        "cpu_seconds": measured + equilibration.sum(),
        "length": lengths,
        "seeds": np.array([alone, sizes]).astype(int),
        "length_needed": needed,
        "seconds_needed": Estimate(
            equilibration.mean() + measuring, measuring * spread.stderr / spread.value
        ),
    }


def table(data: xr.Dataset) -> str:
    """Return what an accuracy of R costs in each scene, and how errors fall with time."""
    head = ["scene", "R", "slope, longer runs", "slope, more seeds", "autocorrelation time"]
    costs = ["scene", "equilibration", *(f"{x:.1%}" for x in data.relative_error.values)]
    rows, prices = [], []
    for one in along(data, "scene"):
        scene, unit = one.scene.item(), one.length_unit.item()
        slopes = [cell(way, "slope", ".3f") for way in along(one, "way")]
        time = f"{cell(one, 'autocorrelation_time', '.2f')} {unit}"
        rows.append([scene, cell(one, "R", ".5f"), *slopes, time])
        unit = "T" if unit == "T" else "c.p.p."
        cells = [
            f"{cost.seconds_needed:.2g} ± {cost.seconds_needed_stderr:.1g} s"
            f" ({cost.length_needed:.3g} {unit})"
            for cost in along(one, "relative_error")
        ]
        prices.append([scene, f"{one.equilibration_seconds:.2g} s", *cells])
    at = f"r = {data.attrs['r']}, β = {data.attrs['beta']}"
    return (
        f"## Statistical error ({at})\n\n{markdown(head, rows)}\n"
        "CPU seconds of one core for a relative error of R, equilibration included, and how long"
        f" the run is:\n\n{markdown(costs, prices)}"
    )
