"""A pilot run: what must be known of a point before its cost and its error can be foreseen.

Lengths are in T for a driven gas, in collisions per particle for one that cools.
"""

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from roughgas.base.errors import InputError
from roughgas.base.files import write_text
from roughgas.config.labels import LARGEST_SEED
from roughgas.scene import Scene
from roughgas.simulation import cooling, schedule, steady
from roughgas.simulation.energies import Energies, ratio
from roughgas.simulation.recorder import Recorder
from roughgas.statistics.averages import period_means
from roughgas.statistics.errors import (
    autocorrelation_time,
    blocking,
    gaussian_sigmas,
    stderr_over_seeds,
)
from roughgas.statistics.intervals import degrees_of_freedom

SEED = LARGEST_SEED  # of pilots: none that a point would take
CHAINS = 10  # which the transient of a driven gas is seen with
SHORTEST = 64  # periods of a chain
LONGEST = 4000.0  # collisions per particle of a chain
MEASURED = 200.0  # autocorrelation times in all chains together
TRANSIENT_SHARE = 0.25  # of a chain, at most
GROWTH = 1.3  # of the windows in which the transient is looked for
NEGLIGIBLE, ALARM_SIGMAS = 0.01, 3.0  # deviations of an energy that are none
COOLING = {"replicas": 40, "relaxation_times": 16}
E_FOLDS = 10.0  # of R on the plateau of a cooling gas
PLATEAU = 50.0, 1000.0  # collisions per particle that it is kept between


class Pilot(NamedTuple):
    """What a pilot has measured, per run; see the module for the unit of lengths."""

    transient: float  # length until the energies are steady (cooling gas: R, by theory alone)
    autocorrelation_time: float  # of R, as a length
    variance: float  # of the mean of R over a length of one: error^2 is this over the length
    dof: float  # degrees of freedom of `variance`
    pace: float  # collisions per particle in a length of one
    seconds_per_length: float  # CPU time of the kernel
    settled: bool  # whether a steady state was found
    length: float  # that was simulated, in all chains
    seconds: float  # CPU time of the kernel that the pilot took


def explore(scene: Scene, experiment: Mapping[str, Any]) -> Pilot:
    """Run the pilot of a point. Apart from the times, the same settings give the same numbers.

    Raises InputError where particles do not fit, CollapseError where contacts accumulate without
    end.
    """
    explorers = {steady: _explore_driven, cooling: _explore_cooling}
    return explorers[schedule.of(experiment)](scene, experiment)


def write_pilot(path: str | Path, pilot: Pilot) -> None:
    """Write a pilot as JSON, whole or not at all."""
    write_text(path, json.dumps(pilot._asdict(), indent=1) + "\n")


def read_pilot(path: str | Path) -> Pilot:
    """The pilot at `path`. Raises InputError where that is none."""
    text = Path(path).read_text()
    try:
        return Pilot(**json.loads(text))
    except (TypeError, ValueError) as error:
        raise InputError("pilot", str(path), "be a file of `roughgas pilot`") from error


class Chains(NamedTuple):
    """Energies per degree of freedom and R of several chains, (chains, periods)."""

    E_trans: np.ndarray
    E_rot: np.ndarray
    R: np.ndarray


def _explore_driven(scene: Scene, experiment: Mapping[str, Any]) -> Pilot:
    """Chains that are made twice as long until they show a steady state and enough of it."""
    every = experiment["schedule"]["sample_every"]
    per_period = steady.samples_per_period(experiment["schedule"])
    recorder, number = Recorder(), experiment["particles"]
    streams = np.random.SeedSequence(SEED).spawn(CHAINS)
    gases = [steady.start(scene, experiment, stream, recorder) for stream in streams]
    known, periods = [[] for _ in gases], SHORTEST
    while True:
        for gas, pieces in zip(gases, known, strict=True):
            pieces.append(gas.energies(gas.in_time(every, periods * per_period)))
        chains = _together(known, per_period)
        length = chains.R.shape[1] * per_period * every
        pace = 2.0 * recorder.collisions / (number * CHAINS * length)
        pilot = _judged(chains, per_period * every, pace, recorder.seconds)
        if _is_enough(pilot) or pace * length >= LONGEST:
            return pilot
        periods = chains.R.shape[1]


def _together(known: list[list[Energies]], per_period: int) -> Chains:
    whole = [Energies(*map(np.concatenate, zip(*pieces, strict=True))) for pieces in known]
    series = ((*one, ratio(one)) for one in whole)
    means = ([period_means(part, per_period) for part in parts] for parts in series)
    return Chains(*map(np.array, zip(*means, strict=True)))


def _judged(chains: Chains, period: float, pace: float, seconds: float) -> Pilot:
    """The pilot that chains amount to, `period` being the length of one of their columns."""
    count, periods = chains.R.shape
    start = max(_settling(part) for part in (chains.E_trans, chains.E_rot))
    settled = start <= TRANSIENT_SHARE * periods
    measured = chains.R[:, min(start, periods // 2) :]
    blocks = [blocking(one) for one in measured]
    simulated = count * periods * period
    return Pilot(
        transient=start * period,
        autocorrelation_time=autocorrelation_time(measured) * period,
        variance=np.mean([one.stderr**2 for one in blocks]) * measured.shape[1] * period,
        dof=sum(degrees_of_freedom(one.blocks) for one in blocks),
        pace=pace,
        seconds_per_length=seconds / simulated,
        settled=settled,
        length=simulated,
        seconds=seconds,
    )


def _settling(series: np.ndarray) -> int:
    """Columns until the mean over chains of an energy, (chains, periods), is that of its second
    half: seen in windows that grow with time, within 1 % or within the noise between chains."""
    chains, periods = series.shape
    edges = np.unique(
        np.geomspace(1, periods // 2, math.ceil(math.log(periods, GROWTH))).astype(int)
    )
    late = series[:, periods // 2 :].mean(axis=1)
    start = 0
    for begin, end in zip([0, *edges[:-1]], edges, strict=True):
        off = series[:, begin:end].mean(axis=1) - late
        sigmas = gaussian_sigmas(off.mean() / (stderr_over_seeds(off) or math.inf), chains - 1)
        if abs(off.mean()) > NEGLIGIBLE * late.mean() and abs(sigmas) > ALARM_SIGMAS:
            start = end
    return int(start)


def _is_enough(pilot: Pilot) -> bool:
    measured = pilot.length - CHAINS * pilot.transient
    return pilot.settled and measured >= MEASURED * pilot.autocorrelation_time


def _explore_cooling(scene: Scene, experiment: Mapping[str, Any]) -> Pilot:
    """One point of the usual kind, long enough to be sure of the plateau and of how R varies on it:
    it remembers as long as it relaxes, twice the e-fold of theory (Ornstein and Uhlenbeck)."""
    recorder, number = Recorder(), experiment["particles"]
    e_fold = 1.0 / max(cooling.rate_of(scene), 1.0 / PLATEAU[1])
    plateau = min(max(E_FOLDS * e_fold, PLATEAU[0]), PLATEAU[1])
    tried = experiment | {"schedule": experiment["schedule"] | COOLING | {"plateau": plateau}}
    found = cooling.run(scene, tried, SEED, recorder)
    replicas = COOLING["replicas"]
    simulated = 2.0 * recorder.collisions / number
    measured = max(found["plateau_end"] - found["measured_from"], 1.0)
    return Pilot(
        transient=0.0,
        autocorrelation_time=np.fmax(found["autocorrelation_time"], 2.0 * e_fold),
        variance=found["R_stderr"] ** 2 * replicas * measured,
        dof=replicas - 1.0,
        pace=1.0,
        seconds_per_length=recorder.seconds / simulated,
        settled=bool(found["equilibrated"]),
        length=simulated,
        seconds=recorder.seconds,
    )
