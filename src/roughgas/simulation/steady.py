"""A gas under steady driving: wait until it is stationary, then average over time."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from roughgas.effects import inertia
from roughgas.scene import Scene
from roughgas.scene.initial import initial_state
from roughgas.simulation.books import books, exchange
from roughgas.simulation.energies import (
    Energies,
    energies,
    fluctuation_energies,
    ratio,
    ratio_of_means,
)
from roughgas.statistics.averages import period_means
from roughgas.statistics.equilibration import detect_start, is_equilibrated
from roughgas.statistics.errors import autocorrelation_time, blocking
from roughgas.statistics.intervals import Error, degrees_of_freedom, is_trusted

LEAST_LEFT = 0.5  # share of the planned measurement below which a late start is not worth having


def run(scene: Scene, experiment: Mapping[str, Any], seed: int, recorder) -> dict[str, Any]:
    """Variables of the point (see roughgas.data.point), from one simulation.

    The schedule gives `equilibrate` and `measure` (T), `sample_every` (T), and `period` (T), over
    whole multiples of which averages are formed. The measurement begins later than planned where
    the energies say that the gas is not yet stationary, and the point is flagged where half of it
    would be lost or the energies drift in what is left.
    """
    schedule = experiment["schedule"]
    every, number = schedule["sample_every"], experiment["particles"]
    planned, length = (round(schedule[part] / every) for part in ("equilibrate", "measure"))
    per_period = samples_per_period(schedule)
    state = initial_state(scene, experiment, np.random.default_rng(seed))
    before = books(state, scene)
    rows = recorder.in_time(state, scene, every, planned + length)
    series = fluctuations(scene, rows, number)
    start, found = _start(series, planned, length, per_period)
    window = series.map(lambda part: part[start:])
    translational = period_means(window.translational, per_period)
    return {
        "E_trans": window.translational.mean(),
        "E_trans_stderr": blocking(translational)[0],
        **(_shared(window, per_period, every) if window.rotational is not None else {}),
        **_unsubtracted(scene, rows, number, start),
        **exchange(before, books(state, scene), scene, number),
        "equilibrated": found,
        "measured_from": start * every,
        "time": rows["time"][start:],
        "E_trans_series": window.translational,
    }


def _shared(window, per_period, every):
    """How the energy is shared between translation and rotation."""
    R = ratio(window)
    R_periods = period_means(R, per_period)
    stderr, blocks = blocking(R_periods)
    error, memory = Error(stderr, degrees_of_freedom(blocks)), autocorrelation_time(R_periods)
    return {
        "R": R.mean(),
        "R_stderr": error.stderr,
        "R_dof": error.dof,
        "R_ci95": error.half_width(0.95),
        "R_ci95_trusted": is_trusted(len(R_periods), memory),
        "R_ratio_of_means": ratio_of_means(window),
        "E_rot": window.rotational.mean(),
        "autocorrelation_time": memory * per_period * every,
        "R_series": R,
        "E_rot_series": window.rotational,
    }


def length(scene: Scene, schedule: Mapping[str, Any]) -> float:
    """T to be simulated."""
    return schedule["equilibrate"] + schedule["measure"]


def samples_per_period(schedule: Mapping[str, Any]) -> int:
    """Samples in a period of the drive; 1 where there is none."""
    return max(
        1, round(schedule.get("period", schedule["sample_every"]) / schedule["sample_every"])
    )


def fluctuations(scene: Scene, rows: Mapping[str, np.ndarray], number: int) -> Energies:
    """Energies of samples, in a sheared gas without the mean flow and the mean spin."""
    shear, q = scene.effects.shear, inertia(scene.effects)
    if shear is None:
        return energies(rows, number, q)
    return fluctuation_energies(rows, number, q, shear.velocity / (2.0 * scene.middle))


def _unsubtracted(scene, rows, number, start):
    """The sheared gas with its mean flow and mean spin left in, which is not what is meant by R."""
    if scene.effects.shear is None:
        return {}
    every = energies(rows, number, inertia(scene.effects))
    window = every.map(lambda part: part[start:])
    found = {"E_trans_unsubtracted": window.translational.mean()}
    if window.rotational is not None:
        found["E_rot_unsubtracted"] = window.rotational.mean()
        found["R_unsubtracted"] = ratio(window).mean()
    return found


def _start(series, planned, length, per_period):
    """First sample to be measured, a whole number of periods in, and whether the rest is steady."""
    means = [period_means(part, per_period) for part in series.there()]
    first = -(-planned // per_period) * per_period
    start = per_period * detect_start(*means, planned=first // per_period)
    if planned + length - start < LEAST_LEFT * length:
        return first, False
    return start, is_equilibrated(*means, start=start // per_period)
