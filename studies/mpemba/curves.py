"""Mean temperatures over time: ours, published ones, and those from the rate equations.

The mean temperature of disks is T = (2 T_tr + T_rot)/3, here over the stationary one. Time is as in
Megias & Santos, Front. Phys. 10, 971671 (2022): half the collisions of a particle at the stationary
frequency, from the begin of the last drive. Both units are means over the last stage of all gases
with the same drive. They are measured, too: all errors are by jackknife over seeds, in which each
mean changes curve and units together.
"""

import json
import math
from collections.abc import Mapping, Sequence
from functools import cache, partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from roughgas import theory

from .jackknife import GasOfSeeds, Jackknife, jackknife

REFERENCE = Path(__file__).with_name("reference.csv")
HEADER_LINES = 4
"""Lines at the top of that file that name the origin of its values."""
FIT_RANGE = 0.3  # time around a crossing, fitted by a parabola
QUARTERS = 4  # quarters of a published curve whose means are compared


class Curve(NamedTuple):
    """Arrays over time: half the collisions of a particle, T over the stationary T, its error.

    Errors of our curves include those of both units, and are thus correlated along a curve. Errors
    of published curves are unknown (zero).
    """

    time: np.ndarray
    T: np.ndarray
    stderr: np.ndarray


class Crossing(NamedTuple):
    """Begin of a negative difference of two curves, and its lowest value."""

    time: float
    stderr: float
    dof: float
    deepest: float  # in standard errors
    depth: float
    depth_stderr: float  # at the time of the lowest value


class Course(NamedTuple):
    """A gas through stages: what its curve is made of."""

    time: np.ndarray  # T, (samples,)
    begins: np.ndarray  # begins of the stages
    seeds: GasOfSeeds

    @property
    def is_last_stage(self) -> np.ndarray:
        """Whether a sample is in the last stage, which is stationary."""
        return self.time > self.begins[-1]

    def units(self, mean: GasOfSeeds) -> tuple[float, float]:
        """Return the stationary T and half the collision frequency of means over seeds."""
        last = self.is_last_stage
        collisions, time = mean.collisions[last], self.time[last]
        frequency = (collisions[-1] - collisions[0]) / (time[-1] - time[0])
        return float(mean.T[last].mean()), 0.5 * float(frequency)


class Gases(NamedTuple):
    """Gases with the same last drive, and the stage of each that begins with it."""

    courses: Sequence[Course]
    stage: int = 1

    def curves(self, means: Sequence[GasOfSeeds]) -> list[tuple[np.ndarray, np.ndarray]]:
        """Return time and T of each gas, in the units of all, from its means over seeds."""
        units = [course.units(mean) for course, mean in zip(self.courses, means, strict=True)]
        unit, frequency = np.mean(units, axis=0)
        return [
            (frequency * (course.time - course.begins[self.stage]), mean.T / unit)
            for course, mean in zip(self.courses, means, strict=True)
        ]

    def at(self, index: int, times: np.ndarray) -> Jackknife:
        """Return T over the stationary T of a gas at `times`, with covariances."""

        def statistic(means):
            return np.interp(times, *self.curves(means)[index])

        return self.jackknife(statistic)

    def jackknife(self, statistic) -> Jackknife:
        """Return the numbers `statistic(means over seeds)` with covariances."""
        return jackknife(statistic, [course.seeds for course in self.courses])

    def simulated(self, index: int = 0) -> Curve:
        """Return the curve of a gas, with its errors."""
        means = [GasOfSeeds(*(s.mean(axis=0) for s in course.seeds)) for course in self.courses]
        time, T = self.curves(means)[index]
        return Curve(time, T, self.at(index, time).stderr)


class Pair(NamedTuple):
    """Curves of a hot and a cold gas with the same drive, in a protocol of the paper."""

    protocol: str  # crossing or overshoot
    material: dict[str, float]  # r and beta
    gases: Gases
    simulated: dict[str, Curve]
    published: dict[str, Curve]
    datasets: dict[str, xr.Dataset]

    def expected(self) -> dict[str, Curve]:
        """Return the curves of the rate equations."""
        return {
            name: expected(gas, self.simulated[name].time) for name, gas in self.datasets.items()
        }

    @property
    def is_overshoot(self) -> bool:
        """Whether distances from the stationary temperature are compared."""
        return self.protocol == "overshoot"

    def crossing(self, curves: Mapping[str, Curve]) -> Crossing:
        """Return the crossing of two curves without errors, or of their distances from the
        stationary temperature."""
        return crossing_of_published(*curves.values(), self.is_overshoot)

    def simulated_crossing(self) -> Crossing:
        """Return the crossing of our curves."""
        return simulated_crossing(self.gases, self.is_overshoot)

    def quarters(self, sample: str) -> tuple[np.ndarray, Jackknife]:
        """Return the published and our means of T over quarters of a curve, (QUARTERS,).

        A quarter has a fourth of the published instants within our simulated time.
        """
        theirs, ours = self.published[sample], self.simulated[sample]
        within = theirs.time < ours.time[-1]
        quarters = np.array_split(np.flatnonzero(within), QUARTERS)
        index = list(self.published).index(sample)

        def statistic(means):
            T = np.interp(theirs.time, *self.gases.curves(means)[index])
            return np.array([T[quarter].mean() for quarter in quarters])

        published_means = np.array([theirs.T[quarter].mean() for quarter in quarters])
        return published_means, self.gases.jackknife(statistic)


def pair(hot: xr.Dataset, cold: xr.Dataset) -> Pair:
    """Return the curves of two reduced datasets."""
    datasets = {"hot": hot, "cold": cold}
    protocol = "overshoot" if "overshoot" in hot.attrs["experiment"] else "crossing"
    material = {"r": float(hot.r[0]), "beta": float(hot.beta[0])}
    gases = Gases([course(gas) for gas in datasets.values()])
    ours = {name: gases.simulated(index) for index, name in enumerate(datasets)}
    theirs = {name: published(protocol, name, **material) for name in datasets}
    return Pair(protocol, material, gases, ours, theirs, datasets)


def pairs(gases: Sequence[xr.Dataset]) -> list[Pair]:
    """Return the pairs of hot and cold gases in turn."""
    return [pair(*two) for two in zip(gases[::2], gases[1::2], strict=True)]


def course(gas: xr.Dataset) -> Course:
    """Return the series of all seeds of a reduced dataset."""
    point = gas.isel(r=0, beta=0)
    names = ("E_trans_series_seed", "E_rot_series_seed", "collisions_series_seed")
    E_tr, E_rot, collisions = (point[name].transpose("seed", "sample").values for name in names)
    seeds = GasOfSeeds(2.0 * E_tr, 2.0 * E_rot, collisions)
    return Course(point.time_series.values, point.stage_begin.values, seeds)


def expected(
    gas: xr.Dataset, times: np.ndarray, stage: int = 1, mean: GasOfSeeds | None = None
) -> Curve:
    """Return the curve of the rate equations at `times`, NaN before 0, from the begin of a stage.

    It begins in the state that the stage sets, else in the measured state: of `mean`, by default
    the mean over all seeds.
    """
    settings = json.loads(gas.attrs["experiment_json"])
    effects = [
        stage_settings["effects"]["thermostat"]
        for stage_settings in settings["schedule"]["stages"][1:]
        if "effects" in stage_settings
    ]
    drive = {**settings["effects"]["thermostat"]}
    for change in effects[:stage]:
        drive |= change
    r, beta, packing = float(gas.r[0]), float(gas.beta[0]), gas.attrs["packing"]
    power, share = drive["power"], drive["spin_share"]
    state = settings["schedule"]["stages"][stage]
    if "temperature" in state:
        initial = state["temperature"], state["spin_temperature"]
    else:
        gas_course = course(gas)
        mean = mean or GasOfSeeds(*(series.mean(axis=0) for series in gas_course.seeds))
        last = int(np.searchsorted(gas_course.time, gas_course.begins[stage] + 1e-6)) - 1
        initial = float(mean.T_tr[last]), float(mean.T_rot[last])
    unit, frequency = _stationary(r, beta, packing, power, share)
    later = times >= 0.0
    T_tr, T_rot = theory.driven_temperatures(
        times[later] / frequency, *initial, r, beta, packing, power, share
    )
    T = np.full(len(times), np.nan)
    T[later] = (2.0 * T_tr + T_rot) / 3.0 / unit
    return Curve(times, T, np.zeros(len(T)))


def _stationary(r, beta, packing, power, share):
    """Return the stationary mean temperature, and half the collision frequency."""
    theta = theory.stationary_theta(r, beta, spin_share=share)
    frequency = theory.collision_frequency(1.0, packing)
    changes = theory.temperature_changes(1.0, theta, r, beta, frequency=frequency)
    T_tr = (-power / (changes[0] + 0.5 * changes[1])) ** (2.0 / 3.0)  # of disks, E = T_tr + T_rot/2
    return T_tr * (2.0 + theta) / 3.0, 0.5 * float(theory.collision_frequency(T_tr, packing))


@cache
def _reference():
    """Return the rows of REFERENCE as a structured array."""
    return np.genfromtxt(
        REFERENCE, delimiter=",", names=True, dtype=None, encoding="utf-8", skip_header=HEADER_LINES
    )


def published(protocol: str, sample: str, r: float, beta: float) -> Curve:
    """Return a published curve."""
    rows = _reference()
    rows = rows[(rows["protocol"] == protocol) & (rows["sample"] == sample)]
    rows = rows[(rows["r"] == r) & (rows["beta"] == beta)]
    return Curve(rows["time"], rows["T"], np.zeros(len(rows)))


def hump(gas: xr.Dataset, stage: int) -> tuple[float, Jackknife]:
    """Return the time at which the rate equations from a stage on have their lowest T, and T there.

    The three numbers are ours, that of the rate equations, and their difference; the rate equations
    begin in the measured state.
    """
    gases = Gases([course(gas)], stage)
    time = gases.simulated().time
    lowest = int(np.nanargmin(expected(gas, time, stage).T))
    instants = time[lowest : lowest + 1]
    # equations are integrated from 0 on: an instant needs a start
    times = np.append(0.0, instants)

    def statistic(means):
        (ours,) = np.interp(instants, *gases.curves(means)[0])
        rates = float(expected(gas, times, stage, means[0]).T[-1])
        return np.array([ours, rates, ours - rates])

    return float(time[lowest]), gases.jackknife(statistic)


def simulated_crossing(gases: Gases, overshoot: bool) -> Crossing:
    """Return the crossing of the curves of two gases, or of their distances from the stationary
    temperature; NaN where there is none."""
    hot, cold = (gases.simulated(index) for index in range(2))
    times = hot.time[(hot.time >= 0.0) & (hot.time < cold.time[-1])]
    difference = gases.jackknife(partial(_difference, gases, times, overshoot))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratios = -difference.value / difference.stderr
    deepest = int(np.nanargmax(ratios)) if np.isfinite(ratios).any() else 0
    time = gases.jackknife(lambda means: _root(times, _difference(gases, times, overshoot, means)))
    estimate, lowest = time.estimate(), int(np.argmin(difference.value))
    return Crossing(
        *estimate,
        float(ratios[deepest]),
        float(-difference.value[lowest]),
        float(difference.stderr[lowest]),
    )


def _difference(gases, times, overshoot, means):
    """Return T of the first gas minus T of the second, or of their distances from 1, at `times`."""
    first, second = (np.interp(times, *curve) - overshoot for curve in gases.curves(means))
    return np.abs(first) - np.abs(second)


def _root(times, difference):
    """Return the time, as an array (1,), at which a difference becomes negative; NaN without one.

    A parabola is fitted around the first negative value.
    """
    below = np.flatnonzero(difference < 0.0)
    if not len(below):
        return np.array([math.nan])
    fit, first = _parabola(times, difference, times[below[0]])
    roots = np.roots(fit)
    return np.array([first + float(np.real(roots[np.argmin(np.abs(roots))]))])


def _parabola(times, difference, first):
    """Return a parabola through a difference around the time `first`, from which it counts."""
    in_fit = np.abs(times - first) < FIT_RANGE
    return np.polyfit(times[in_fit] - first, difference[in_fit], 2), first


def crossing_of_published(hot: Curve, cold: Curve, overshoot: bool = False) -> Crossing:
    """Return the crossing of published curves, whose errors are unknown, or of theoretical ones.

    The scatter about the fitted parabola is taken as the error of a difference; it leaves out
    errors that all points of a curve share.
    """
    times = hot.time[(hot.time >= 0.0) & (hot.time < cold.time[-1])]
    curves = (hot, cold)
    distances = [np.interp(times, curve.time, curve.T) - overshoot for curve in curves]
    difference = np.abs(distances[0]) - np.abs(distances[1])
    root = float(_root(times, difference)[0])
    if math.isnan(root):
        return Crossing(*[math.nan] * 6)
    fit, first = _parabola(times, difference, times[np.flatnonzero(difference < 0.0)[0]])
    in_fit = np.abs(times - first) < FIT_RANGE
    scatter = float(np.std(difference[in_fit] - np.polyval(fit, times[in_fit] - first)))
    slope = abs(float(np.polyval(np.polyder(fit), root - first)))
    depth = -float(difference.min())
    return Crossing(root, scatter / slope, math.inf, depth / scatter, depth, scatter)
