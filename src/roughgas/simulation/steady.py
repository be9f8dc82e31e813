"""A gas under steady driving: wait until it is stationary, then average over time."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from roughgas.base import InputError
from roughgas.effects import inertia
from roughgas.scene import Scene, moves_along
from roughgas.simulation.energies import (
    Columns,
    EnergyBalance,
    contact_averages,
    driven_species,
    energies,
    energies_of_each,
    energy_exchange,
    ratio,
    ratio_of_means,
    shear_rates,
)
from roughgas.simulation.gas import Gas, joined
from roughgas.simulation.recorder import KEY, Recorder, until_met
from roughgas.simulation.restart import Initial
from roughgas.statistics.errors import (
    UNKNOWN,
    YES,
    Error,
    Evidence,
    autocorrelation_time,
    blocking,
    degrees_of_freedom,
    is_trusted,
    of_all,
    period_means,
)
from roughgas.statistics.steady_state import detect_start, is_equilibrated

# see roughgas.simulation.schedule.Kind
DRIVEN, UNIT, LENGTH, SAMPLES_PER_REFRESH = True, "T", "measure", 1
KEPT = 4  # values in a period that the stored series have
LEAST_LEFT = 0.5  # share of the planned measurement below which a late start is not worth having
# of a periodic drive, that samples must show: with 16 a bed has R within 0.0005 of that with 80
LEAST_PHASES = 16
WHOLE = 1e-6  # by which a number of samples, or of periods, may miss a whole one


def length(scene: Scene, experiment: Mapping[str, Any]) -> float:
    """Return the T that a point simulates."""
    schedule = experiment["schedule"]
    return schedule["equilibrate"] + schedule["measure"]


def start(scene: Scene, experiment: Mapping[str, Any], seed: Any, recorder=None, initial=()) -> Gas:
    """Return the gas of a point as it begins; `seed` may be a random generator."""
    rng = np.random.default_rng(seed)
    return Gas.start(scene, experiment, rng, recorder, *initial)


def sample(gas: Gas, every: float, samples: int) -> Columns:
    """Return columns, sampled every so many T."""
    return gas.in_time(every, samples)


def interval(experiment: Mapping[str, Any]) -> float:
    """Return the T between two samples."""
    return experiment["schedule"]["sample_every"]


def check(scene: Scene, experiment: Mapping[str, Any]) -> None:
    """Raise InputError for lengths that make no whole period, or samples that miss phases of it."""
    schedule = experiment["schedule"]
    measure, every = schedule["measure"], schedule["sample_every"]
    period = schedule.get("period", every)
    for name, own in drive_periods(scene).items():
        if "period" not in schedule or not is_whole(period / own):
            found = schedule.get("period", "(none)")
            legal = f"be a whole multiple of that of {name}, {own:g} T"
            raise InputError("schedule.period", found, legal)
    if not is_whole(period / every):
        legal = f"divide schedule.period, {period:g} T, into whole samples"
        raise InputError("schedule.sample_every", every, legal)
    if sum(_planned(schedule)) < wait(scene, experiment) + samples_per_period(schedule):
        legal = f"hold a whole period, {period:g} T, after the whole ones of equilibrate"
        raise InputError("schedule.measure", measure, legal)
    if KEY in schedule and phases(scene, schedule) < LEAST_PHASES:
        legal = f"divide a period of the drive into {LEAST_PHASES} samples beside schedule.{KEY}"
        raise InputError("schedule.sample_every", every, legal)


def drive_periods(scene: Scene) -> dict[str, float]:
    """Return the period (T) of each effect that drives a gas periodically, by name."""
    found = scene.effects._asdict().items()
    periods = {name: getattr(one, "period", math.inf) for name, one in found}
    return {name: period for name, period in periods.items() if period < math.inf}


def phases(scene: Scene, schedule: Mapping[str, Any]) -> float:
    """Return how many phases of the drive samples show; infinity where it has no period."""
    per_period = samples_per_period(schedule)
    of_each = [
        per_period // math.gcd(per_period, round(schedule["period"] / period))
        for period in drive_periods(scene).values()
    ]
    return min(of_each, default=math.inf)


def _planned(schedule):
    """Return the samples of the wait and of the measurement."""
    every = schedule["sample_every"]
    return tuple(round(schedule[part] / every) for part in ("equilibrate", "measure"))


def is_whole(number: float) -> bool:
    """Return whether a quotient of lengths is a whole number, at least 1."""
    return number > 0.5 and abs(number - round(number)) <= WHOLE * number


def samples_per_period(schedule: Mapping[str, Any]) -> int:
    """Return the samples in a period of the drive; 1 if it has none."""
    every = schedule["sample_every"]
    return max(1, round(schedule.get("period", every) / every))


def wait(scene: Scene, experiment: Mapping[str, Any]) -> int:
    """Return the samples before any counts: whole periods."""
    schedule = experiment["schedule"]
    planned, _ = _planned(schedule)
    return -(-planned // samples_per_period(schedule)) * samples_per_period(schedule)


def run(
    scene: Scene,
    experiment: Mapping[str, Any],
    seed: int,
    recorder: Recorder,
    initial: Sequence[Initial] = (),
) -> dict[str, Any]:
    """Return the variables of the point (see roughgas.data.point), from one simulation.

    The schedule gives `equilibrate` and `measure` (T), `sample_every` (T), and `period` (T), over
    whole multiples of which averages are formed. The measurement begins later than planned if the
    energies say that the gas is not yet stationary, and the point is flagged if half of it would be
    lost or the energies drift in what is left. R is vouched for only in a steady state, and where
    samples show enough phases of a periodic drive. With a target, the measurement is prolonged.
    """
    gas = start(scene, experiment, seed, recorder, initial)
    if initial:
        gas.look()  # at running sums that others have begun
    begun = Begun(gas.time, gas.sample, gas.balance(), gas.begun + gas.collisions)
    rows: Columns = {"time": np.empty(0)}

    def run_to(schedule):
        nonlocal rows
        recorder.expect(length(scene, {"schedule": schedule}))
        more = gas.in_time(schedule["sample_every"], sum(_planned(schedule)) - len(rows["time"]))
        rows = joined([rows, more]) if len(rows["time"]) else more
        found = _measure(gas, schedule, rows, begun)
        return found, found.get("R_ci95_trusted") == YES

    return until_met(experiment["schedule"], LENGTH, run_to)


class Begun(NamedTuple):
    """A gas as its time begins to count: the time, running sums, energy balance and collisions."""

    time: float
    sums: Columns
    balance: EnergyBalance
    collisions: int


def _measure(gas: Gas, schedule: Mapping[str, Any], rows: Columns, begun: Begun) -> dict[str, Any]:
    """Return the variables of a run, `rows` being its samples since it began."""
    scene, every, per_period = gas.scene, schedule["sample_every"], samples_per_period(schedule)
    planned, length = _planned(schedule)
    series = gas.energies(rows)
    first, found = _start(series, planned, length, per_period)
    made = rows["collisions"][-1] - (rows["collisions"][first - 1] if first else begun.collisions)
    window = series.map(lambda part: part[first:])
    periods = len(window.translational) // per_period
    evidence = Evidence(2 * made / gas.particles, periods)
    steady = evidence.verdict(found)
    shown = phases(scene, schedule) >= LEAST_PHASES
    vouched = steady if shown or steady != YES else UNKNOWN
    return {
        **averages(window, per_period, every, vouched),
        **contact_averages(rows, first, per_period, inertia_of_sums(scene), begun.sums),
        **_unsubtracted(gas, rows, first),
        **_of_species(gas, rows, first, per_period),
        **energy_exchange(begun.balance, gas.balance(), scene, gas.particles),
        "equilibrated": steady,
        "measured_from": begun.time + first * every,
        "measured_collisions": evidence.collisions,
        **over_time(rows["time"][first:], window, max(1, per_period // KEPT)),
    }


def _start(series, planned, length, per_period):
    """Return the first sample to measure, after whole periods, and whether the rest is steady."""
    means = [period_means(part, per_period) for part in series.there()]
    first = -(-planned // per_period) * per_period
    start = per_period * detect_start(*means, planned=first // per_period)
    if planned + length - start < LEAST_LEFT * length:
        return first, False
    return start, is_equilibrated(*means, start=start // per_period)


def averages(window, per_period, every, steady):
    """Return the energies, and how they are shared between translation and rotation, steady or
    not."""
    found = {
        "E_trans": window.translational.mean(),
        "E_trans_stderr": blocking(period_means(window.translational, per_period))[0],
    }
    if window.rotational is None:
        return found
    R = ratio(window)
    R_periods = period_means(R, per_period)
    stderr, blocks = blocking(R_periods)
    error, memory = Error(stderr, degrees_of_freedom(blocks)), autocorrelation_time(R_periods)
    return found | {
        "R": R.mean(),
        "R_stderr": error.stderr,
        "R_dof": error.dof,
        "R_ci95": error.half_width(0.95),
        "R_ci95_trusted": of_all(steady, is_trusted(len(R_periods), memory)),
        "R_ratio_of_means": ratio_of_means(window),
        "E_rot": window.rotational.mean(),
        "E_rot_stderr": blocking(period_means(window.rotational, per_period))[0],
        "autocorrelation_time": memory * per_period * every,
    }


def over_time(time, window, together):
    """Return what is stored over time: means of so many samples each."""
    found = {"time": time, "E_trans_series": window.translational}
    if window.rotational is not None:
        found |= {"R_series": ratio(window), "E_rot_series": window.rotational}
    return {name: period_means(values, together) for name, values in found.items()}


def inertia_of_sums(scene: Scene) -> float:
    """Return the q that sums over contacts belong to."""
    q = inertia(scene.effects)
    return 1.0 if q is None or scene.effects.species is not None else q


def _of_species(gas, rows, first, per_period):
    """Return the energies and R of each species."""
    parts = energies_of_each(rows, gas.scene, gas.state)
    parts = [part.map(lambda values: values[first:]) for part in parts]
    return driven_species(parts, per_period, max(1, per_period // KEPT))


def _unsubtracted(gas, rows, first):
    """Return energies of a sheared gas with its mean flow and mean spin left in, not meant by R."""
    effects, found = gas.scene.effects, {}
    if effects.shear is None and not moves_along(effects):
        return {}
    if effects.shear is None:
        found["shear_rate"] = shear_rates(rows, gas.state)[first:].mean()
    series = energies(rows, gas.particles, inertia(effects))
    window = series.map(lambda part: part[first:])
    found["E_trans_unsubtracted"] = window.translational.mean()
    if window.rotational is not None:
        found["E_rot_unsubtracted"] = window.rotational.mean()
        found["R_unsubtracted"] = ratio(window).mean()
    return found
