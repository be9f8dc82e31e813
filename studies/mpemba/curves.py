"""Mean temperatures over time, ours, published, and those of the rate equations.

The mean temperature of disks is T = (2 T_tr + T_rot)/3, here over the stationary one. Time is that
of Megias & Santos, Front. Phys. 10, 971671 (2022): half the collisions of a particle at the
stationary frequency, from when the last drive has begun.
"""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from roughgas import theory

REFERENCE = Path(__file__).with_name("reference.csv")
SOURCE = 3
"""Lines of that file that say where its numbers are from."""
NEAR = 0.3  # of a crossing: what a parabola is fitted to


class Curve(NamedTuple):
    """Arrays over time: half the collisions of a particle, T over the stationary T, its error.

    Our `stderr` adds the errors of both energies at each time as if they were the same. It leaves
    out the errors of the stationary temperature, the unit of T, and of the frequency, the unit of
    time, which all points of a curve share. Errors of published curves are unknown (zero).
    """

    time: np.ndarray
    T: np.ndarray
    stderr: np.ndarray


class Crossing(NamedTuple):
    """Where a difference becomes negative, and how far below zero it gets."""

    time: float
    stderr: float
    deepest: float  # in standard errors


class Pair(NamedTuple):
    """A hot and a cold gas that get the same drive, by a protocol of the paper: curves by gas."""

    protocol: str  # crossing or overshoot
    place: dict[str, float]  # r and beta
    simulated: dict[str, Curve]
    published: dict[str, Curve]
    expected: dict[str, Curve]

    def crossing(self, curves: Mapping[str, Curve]) -> Crossing:
        """Return where curves of this pair cross, or their distances from the stationary one."""
        return crossing(*curves.values(), self.protocol == "overshoot")


def pair(hot: xr.Dataset, cold: xr.Dataset) -> Pair:
    """Return the curves of two reduced datasets."""
    gases = {"hot": hot, "cold": cold}
    protocol = "overshoot" if "overshoot" in hot.attrs["experiment"] else "crossing"
    place = {"r": float(hot.r[0]), "beta": float(hot.beta[0])}
    ours = {name: simulated(gas) for name, gas in gases.items()}
    theirs = {name: published(protocol, name, **place) for name in gases}
    rates = {name: expected(gas, ours[name]) for name, gas in gases.items()}
    return Pair(protocol, place, ours, theirs, rates)


def pairs(gases: Sequence[xr.Dataset]) -> list[Pair]:
    """Return the pairs of hot and cold gases in turn."""
    return [pair(*two) for two in zip(gases[::2], gases[1::2], strict=True)]


def simulated(gas: xr.Dataset, stage: int = 1) -> Curve:
    """Return the curve of a reduced dataset from the beginning of a stage on.

    Means over the last stage are its units, and count as exact: their errors are left out.
    """
    one, begins = _point(gas)
    time = one.time_series.values
    steady = time > begins[-1]
    T = (4.0 * one.E_trans_series + 2.0 * one.E_rot_series).values / 3.0
    error = (4.0 * one.E_trans_series_stderr + 2.0 * one.E_rot_series_stderr).values / 3.0
    made, at = one.collisions_series.values[steady], time[steady]
    frequency, unit = (made[-1] - made[0]) / (at[-1] - at[0]), T[steady].mean()
    return Curve(0.5 * frequency * (time - begins[stage]), T / unit, error / unit)


def expected(gas: xr.Dataset, curve: Curve, stage: int = 1) -> Curve:
    """Return what the rate equations make of the state that a stage begins in, at the same times;
    NaN before."""
    one, begins = _point(gas)
    settings = json.loads(gas.attrs["experiment_json"])
    effects = [
        part["effects"]["thermostat"]
        for part in settings["schedule"]["stages"][1:]
        if "effects" in part
    ]
    drive = {**settings["effects"]["thermostat"]}
    for part in effects[:stage]:
        drive |= part
    r, beta, packing = float(gas.r[0]), float(gas.beta[0]), gas.attrs["packing"]
    power, share = drive["power"], drive["spin_share"]
    state = settings["schedule"]["stages"][stage]
    if "temperature" in state:
        begun = state["temperature"], state["spin_temperature"]
    else:
        last = int(np.searchsorted(one.time_series, begins[stage] + 1e-6)) - 1
        begun = tuple(2.0 * float(one[f"E_{name}_series"][last]) for name in ("trans", "rot"))
    unit, frequency = _stationary(r, beta, packing, power, share)
    later = curve.time >= 0.0
    T_tr, T_rot = theory.driven_temperatures(
        curve.time[later] / frequency, *begun, r, beta, packing, power, share
    )
    T = np.full(len(curve.time), np.nan)
    T[later] = (2.0 * T_tr + T_rot) / 3.0 / unit
    return curve._replace(T=T, stderr=np.zeros(len(T)))


def _stationary(r, beta, packing, power, share):
    """Return the stationary mean temperature, and half the collision frequency."""
    theta = theory.stationary_theta(r, beta, spin_share=share)
    frequency = theory.collision_frequency(1.0, packing)
    losses = theory.temperature_changes(1.0, theta, r, beta, frequency=frequency)
    T_tr = (-power / (losses[0] + 0.5 * losses[1])) ** (2.0 / 3.0)  # of disks, E = T_tr + T_rot/2
    return T_tr * (2.0 + theta) / 3.0, 0.5 * float(theory.collision_frequency(T_tr, packing))


def _point(gas):
    one = gas.isel(r=0, beta=0)
    return one, one.stage_begin.values


def published(protocol: str, sample: str, r: float, beta: float) -> Curve:
    """Return a published curve."""
    rows = np.genfromtxt(
        REFERENCE, delimiter=",", names=True, dtype=None, encoding="utf-8", skip_header=SOURCE
    )
    rows = rows[(rows["protocol"] == protocol) & (rows["sample"] == sample)]
    rows = rows[(rows["r"] == r) & (rows["beta"] == beta)]
    return Curve(rows["time"], rows["T"], np.zeros(len(rows)))


def crossing(hot: Curve, cold: Curve, overshoot: bool = False) -> Crossing:
    """Return where the hotter gas gets colder than the other one, or, if that one overshoots,
    nearer to the stationary temperature.

    Without errors, what scatters about the fitted parabola is taken for the error.
    """
    time = hot.time[(hot.time >= 0.0) & (hot.time < cold.time[-1])]
    parts = [np.interp(time, one.time, one.T) - overshoot for one in (hot, cold)]
    difference = np.abs(parts[0]) - np.abs(parts[1])
    error = np.hypot(*(np.interp(time, one.time, one.stderr) for one in (hot, cold)))
    below = np.flatnonzero(difference < 0.0)
    if not len(below):
        return Crossing(np.nan, np.nan, np.nan)
    first = time[below[0]]
    near = np.abs(time - first) < NEAR
    fit = np.polyfit(time[near] - first, difference[near], 2)
    roots = np.roots(fit)
    root = float(np.real(roots[np.argmin(np.abs(roots))]))
    scatter = np.std(difference[near] - np.polyval(fit, time[near] - first))
    here = error[below[0]] or scatter
    error = np.where(error > 0.0, error, scatter)
    slope = abs(float(np.polyval(np.polyder(fit), root)))
    return Crossing(first + root, float(here / slope), float(np.max(-difference / error)))
