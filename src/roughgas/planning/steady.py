"""The pilot and the plan of a driven gas; lengths in T."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from roughgas.base.errors import SilentError
from roughgas.effects import inertia_of_spin
from roughgas.planning.lengths import BIAS, FEWEST_SEEDS, relaxation, to_measure, whole
from roughgas.planning.pilot import SEED, Pilot
from roughgas.scene import Scene
from roughgas.simulation import steady
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
from roughgas.theory import lun_ratio

CHAINS = 10  # which show the transient
SHORTEST = 64  # periods of a chain
LONGEST = 4000.0  # collisions per particle of a chain
USUAL = LONGEST / 8.0  # the same of a pilot on average, over a sweep like those of the paper
MEASURED = 200.0  # autocorrelation times in all chains together
TRANSIENT_SHARE = 0.25  # of a chain, at most
GROWTH = 1.3  # of the windows in which the transient is looked for
NEGLIGIBLE, ALARM_SIGMAS = 0.01, 3.0  # a smaller deviation of an energy is none
TWICE = 2.0  # transients to wait for: whether a gas is steady is judged from half of that on
MEMORIES = 20.0  # autocorrelation times in a run, at least: its error is estimated from blocks


def explore(scene: Scene, experiment: Mapping[str, Any]) -> Pilot:
    """Run chains, and double them until they show a steady state and enough of it."""
    every = experiment["schedule"]["sample_every"]
    per_period = steady.samples_per_period(experiment["schedule"])
    recorder, number = Recorder(), experiment["particles"]
    streams = np.random.SeedSequence(SEED).spawn(CHAINS)
    gases = [steady.start(scene, experiment, stream, recorder) for stream in streams]
    known: list[list[Energies]] = [[] for _ in gases]
    periods = SHORTEST
    while True:
        for gas, pieces in zip(gases, known, strict=True):
            pieces.append(gas.energies(gas.in_time(every, periods * per_period)))
        chains = _together(known, per_period)
        periods = chains.shape[2]
        length = periods * per_period * every
        pace = 2.0 * recorder.collisions / (number * CHAINS * length)
        if pace == 0:
            raise SilentError(f"no particle has met another within {length:g} T: nothing to plan")
        pilot = _judged(chains, per_period * every, pace, recorder.seconds)
        if _is_enough(pilot) or pace * length >= LONGEST:
            return pilot


def effort(scene: Scene, experiment: Mapping[str, Any]) -> float:
    """Return about how long a pilot is, in T, where particles meet about once a T."""
    return CHAINS * USUAL


def choose(
    scene: Scene, experiment: Mapping[str, Any], pilot: Pilot, target: float
) -> dict[str, Any]:
    """Return the complete schedule of a run that belongs to a target."""
    given = experiment["schedule"]
    unit = given.get("period", given["sample_every"])
    final = float(lun_ratio(scene.roughness, inertia_of_spin(scene.effects)))
    relaxed = relaxation(scene, BIAS * target, final, 0.0) / pilot.pace
    transient = whole(max(relaxed, TWICE * pilot.transient), unit)
    measure = whole(to_measure(transient, FEWEST_SEEDS, target, MEMORIES, pilot), unit)
    return {**given, "equilibrate": transient, "measure": measure}


def _together(known: list[list[Energies]], per_period: int) -> np.ndarray:
    """Return E_trans, E_rot and R of each period of each chain, (3, chains, periods)."""
    series = [Energies(*map(np.concatenate, zip(*pieces, strict=True))) for pieces in known]
    means = [
        [period_means(part, per_period) for part in (*one.there(), ratio(one))] for one in series
    ]
    return np.array([*zip(*means, strict=True)])


def _judged(chains: np.ndarray, period: float, pace: float, seconds: float) -> Pilot:
    """Return the pilot that chains amount to, `period` being the length of one of their columns."""
    *energies, R = chains
    count, periods = R.shape
    start = max(map(settling, energies))
    window = R[:, min(start, periods // 2) :]
    blocks = [blocking(one) for one in window]
    simulated = count * periods * period
    return Pilot(
        transient=start * period,
        autocorrelation_time=autocorrelation_time(window) * period,
        variance=np.mean([one.stderr**2 for one in blocks]) * window.shape[1] * period,
        dof=sum(degrees_of_freedom(one.blocks) for one in blocks),
        pace=pace,
        seconds_per_length=seconds / simulated,
        settled=start <= TRANSIENT_SHARE * periods,
        length=simulated,
        seconds=seconds,
    )


def settling(series: np.ndarray) -> int:
    """Return the columns until an energy, (chains, periods), has the mean of its second half.

    Its mean over chains is seen in windows that grow with time: within 1 %, or within the noise
    between chains.
    """
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
    seen = pilot.length - CHAINS * pilot.transient
    return pilot.settled and seen >= MEASURED * pilot.autocorrelation_time
