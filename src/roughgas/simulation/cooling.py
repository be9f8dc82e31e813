"""A freely cooling gas: many replicas of it, averaged where R has settled on its plateau."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from roughgas.base import InputError
from roughgas.effects import inertia, speed_of_r
from roughgas.effects.species import packing
from roughgas.scene import Scene, for_theory
from roughgas.simulation.energies import (
    Columns,
    Energies,
    EnergyBalance,
    cooling_species,
    energies_of_each,
    energy_exchange,
    ratio,
    ratio_of_means,
    restored,
    verdicts_on_means,
)
from roughgas.simulation.gas import Gas, count
from roughgas.simulation.recorder import KEY, Recorder, until_met
from roughgas.simulation.restart import Initial
from roughgas.statistics.errors import LEAST, UNKNOWN, Error, Evidence, autocorrelation_time
from roughgas.statistics.steady_state import find_plateau
from roughgas.theory import friction_relaxation_rate, mixture_relaxation_rate, relaxation_rate

# see roughgas.simulation.schedule.Kind
DRIVEN, UNIT, LENGTH = False, "collisions per particle", "plateau"
SAMPLES_PER_REFRESH = 4
# Collisions per particle. Without a refresh for four times as many, velocities fall to 1e-9 of what
# they were at the strongest dissipation; after 400 their roundings would be as large as they are.
LONGEST_INTERVAL = 25.0
# Collisions per particle that theory's estimate of the transient is kept between. At r <= 0.9 none
# is longer; nearly elastic disks or spheres can need a hundred times as many, close to beta = -1.
TRANSIENT = 10.0, 2500.0


class Cooled(NamedTuple):
    """One replica, or several along the first axis; energies in units of E_trans at the start."""

    energies: Energies  # of each sample, over 4^exponent: they may fall below the smallest number
    exponent: np.ndarray
    collisions: np.ndarray  # of each particle since the samples began
    time: np.ndarray  # of each sample, in T since dissipation was switched on
    before: EnergyBalance
    after: EnergyBalance
    species: list[Energies]  # as `energies`, of each species


def length(scene: Scene, experiment: Mapping[str, Any]) -> float:
    """Return the collisions per particle that a point simulates, in all replicas together."""
    schedule = experiment["schedule"]
    transient = transient_length(scene, schedule["relaxation_times"], experiment)
    return schedule["replicas"] * (schedule["thermalise"] + transient + schedule["plateau"])


def transient_length(
    scene: Scene, relaxation_times: float, experiment: Mapping[str, Any] | None = None
) -> float:
    """Return the collisions per particle that R needs to settle, by the rate equations.

    `experiment` need not be given where particles are alike.
    """
    rate = rate_of(scene, experiment)
    return min(max(relaxation_times / rate if rate > 0.0 else math.inf, TRANSIENT[0]), TRANSIENT[1])


def rate_of(scene: Scene, experiment: Mapping[str, Any] | None = None) -> float:
    """Return the rate at which R relaxes, by the rate equations, per collision per particle.

    That is the slowest at which any temperatures of a mixture do. Of particles that are alike and
    without spin there is nothing to relax: infinity.
    """
    settings = experiment or {}
    mixture = for_theory(scene, settings)
    if mixture is not None:
        return mixture_relaxation_rate(mixture, packing(settings))
    q = inertia(scene.effects)
    if q is None:
        return math.inf
    r, beta, dimension = scene.restitution, scene.roughness, len(scene.box)
    friction = scene.effects.friction
    if friction is None:
        return float(relaxation_rate(r, beta, dimension, q))
    return float(friction_relaxation_rate(r, beta, friction.mu, dimension, q))


def interval(experiment: Mapping[str, Any]) -> float:
    """Return the collisions per particle between two samples: whole ones in the gas, at least one,
    so that `sample_every` may not be what it is."""
    number = experiment["particles"]
    return 2 * count(number, experiment["schedule"]["sample_every"]) / number


def check(scene: Scene, experiment: Mapping[str, Any]) -> None:
    """Raise InputError for samples so far apart that velocities would be lost between them, or for
    a plateau that is shorter than the interval between samples."""
    plateau, every = experiment["schedule"]["plateau"], interval(experiment)
    if every > LONGEST_INTERVAL:
        legal = f"be at most {LONGEST_INTERVAL:g} collisions per particle in a cooling gas"
        raise InputError("schedule.sample_every", experiment["schedule"]["sample_every"], legal)
    if plateau < every:
        legal = f"be at least schedule.sample_every, {every:g} collisions per particle"
        raise InputError("schedule.plateau", plateau, legal)


def start(scene: Scene, experiment: Mapping[str, Any], seed: Any, recorder=None, initial=()) -> Gas:
    """Return the first replica of a point, thermalised, as dissipation is switched on.

    A random generator as `seed` is used as it is.
    """
    stream = seed if isinstance(seed, np.random.Generator) else _streams(seed, 1)[0]
    return _replica(scene, experiment, stream, recorder, *initial[:1])


def sample(gas: Gas, every: float, samples: int) -> Columns:
    """Return columns, sampled every so many collisions per particle."""
    return gas.in_collisions(gas.count(every), samples)


def samples_per_period(schedule: Mapping[str, Any]) -> int:
    """Return 1: nothing drives a cooling gas."""
    return 1


def phases(scene: Scene, schedule: Mapping[str, Any], every: int = 1) -> float:
    """Return infinity: nothing drives a cooling gas."""
    return math.inf


def wait(scene: Scene, experiment: Mapping[str, Any]) -> int:
    """Return the samples before any counts, of the transient that theory expects."""
    schedule = experiment["schedule"]
    transient = transient_length(scene, schedule["relaxation_times"], experiment)
    return math.floor(transient / interval(experiment))


def run(
    scene: Scene,
    experiment: Mapping[str, Any],
    seed: int,
    recorder: Recorder,
    initial: Sequence[Initial] = (),
) -> dict[str, Any]:
    """Return the variables of the point (see roughgas.data.point), from `replicas` simulations.

    Each starts as a smooth elastic gas, thermalised for `thermalise` collisions per particle, or in
    an `initial` state of its own, in which it begins to cool or goes on to. Then dissipation is
    switched on for the time that the rate equations say R needs to settle,
    `relaxation_times` of its e-folds, and for `plateau` collisions per particle more. With a target
    there are as many replicas as it takes, numbered on from the last.
    """
    schedule = experiment["schedule"]
    if initial and KEY in schedule:
        legal = "not stand beside initial states, each of which begins one replica"
        raise InputError(f"schedule.{KEY}", schedule[KEY], legal)
    transient = transient_length(scene, schedule["relaxation_times"], experiment)
    every = interval(experiment)
    samples = math.ceil((transient + schedule["plateau"]) / every)
    runs: list[Cooled] = []

    def run_to(longer):
        recorder.expect(length(scene, {**experiment, "schedule": longer}))
        streams = _streams(seed, longer["replicas"])
        for one in range(len(runs), len(streams)):
            gas = _replica(scene, experiment, streams[one], recorder, *initial[one : one + 1])
            runs.append(_cool(gas, every, samples))
        return _found(_together(runs), scene, experiment, transient), len(runs) >= LEAST.runs

    return until_met(schedule, "replicas", run_to)


def _found(ensemble, scene, experiment, transient):
    """Return the variables of a point from all its replicas."""
    every, passed = interval(experiment), ensemble.collisions[0]  # as in all replicas
    exchanged = energy_exchange(ensemble.before, ensemble.after, scene, experiment["particles"])
    if speed_of_r(scene.effects) is not None:  # how it cools depends on how fast it is
        exchanged |= _over_time(ensemble)
    if scene.effects.spin is None:
        first = min(math.ceil(transient / every), len(passed)) - 1
        return _decay(ensemble, passed, first) | exchanged
    rate = rate_of(scene, experiment)
    return _measure(ensemble, passed, transient, rate, every) | exchanged


def _streams(seed, replicas):
    return np.random.SeedSequence(seed).spawn(replicas)


def _replica(scene, experiment, stream, recorder, initial=None):
    schedule = experiment["schedule"]
    gas = Gas.start(scene, experiment, np.random.default_rng(stream), recorder, initial)
    if initial is None:
        gas.thermalise(schedule["thermalise"])
    else:
        gas.look()
    gas.cool(SAMPLES_PER_REFRESH * gas.count(schedule["sample_every"]))
    return gas


def _cool(gas, every, samples):
    """Return what one replica does from when dissipation is switched on."""
    unit, exponent = gas.energies(gas.sample).translational[0], int(gas.sample["exponent"][0])
    before, begun, made = gas.balance(), gas.time, gas.sample["collisions"]
    rows = sample(gas, every, samples)
    present = gas.energies(rows).map(lambda part: part / unit)
    energy = math.ldexp(unit, 2 * exponent)
    before, after = (EnergyBalance(*(part / energy for part in b)) for b in (before, gas.balance()))
    parts = energies_of_each(rows, gas.scene, gas.state)
    parts = [one.map(lambda part: part / unit) for one in parts]
    exponents = rows["exponent"].astype(int) - exponent
    passed = 2 * (rows["collisions"] - made) / gas.particles
    return Cooled(present, exponents, passed, rows["time"] - begun, before, after, parts)


def _over_time(ensemble):
    """Return when the samples were taken, and by which power of time the energy falls: over the
    second half of them, where the time is long against that of the first."""
    time = ensemble.time.mean(axis=0)
    E_trans = restored(ensemble.energies, ensemble.exponent).translational.mean(axis=0)
    later = slice(len(time) // 2, None)
    known = np.log(time[later]), np.log(np.maximum(E_trans[later], np.finfo(float).tiny))
    return {"time_series": time, "decay_exponent": -np.polyfit(*known, 1)[0]}


def _together(runs):
    """Return all replicas as one: energies stacked, energy balances averaged."""
    present, exponent, passed, time, *balances, species = zip(*runs, strict=True)
    stacked, parts = _stacked(present), [_stacked(one) for one in zip(*species, strict=True)]
    means = (
        EnergyBalance(*(np.mean(part, axis=0) for part in zip(*one, strict=True)))
        for one in balances
    )
    return Cooled(stacked, *map(np.array, (exponent, passed, time)), *means, parts)


def _stacked(runs):
    return Energies(*map(np.array, zip(*(one.there() for one in runs), strict=True)))


def _measure(ensemble, passed, transient, rate, every):
    """Return R on its plateau, and how the energies decay."""
    R = ratio(ensemble.energies)
    plateau = find_plateau(passed, R, transient)
    inside = (passed >= plateau.start) & (passed <= plateau.stop)
    first = np.argmax(inside)
    length = plateau.stop - (passed[first - 1] if first else 0.0)
    evidence = Evidence(length, np.count_nonzero(inside), rate * plateau.start, runs=len(R))
    found = evidence.verdict(plateau.found)
    error = Error(plateau.stderr, len(R) - 1.0)
    exponent = ensemble.exponent
    E_rot = restored(ensemble.energies, exponent).rotational
    alike = restored(ensemble.energies, exponent - exponent.max(axis=0))
    variables = _decay(ensemble, passed, first) | {
        "R": plateau.mean,
        "R_stderr": error.stderr,
        "R_dof": error.dof,
        "R_ci95": error.half_width(0.95),
        "R_ci95_trusted": found,
        "R_ratio_of_means": ratio_of_means(alike, axis=0)[inside].mean(),
        "E_rot": E_rot.mean(axis=0)[first],
        "E_rot_stderr": _scatter(E_rot)[first],
        "equilibrated": found,
        "measured_from": plateau.start,
        "measured_collisions": evidence.collisions,
        "plateau_end": plateau.stop,
        "autocorrelation_time": autocorrelation_time(R[:, inside]) * every,
        "R_replica": plateau.per_replica,
        "R_series": R.mean(axis=0),
        "R_series_stderr": _scatter(R),
        "E_rot_series": E_rot.mean(axis=0),
        **_of_species(ensemble, inside),
    }
    return variables | verdicts_on_means(variables, found)


def _decay(ensemble, passed, first):
    """Return how the translational energy decays, and what it is when the measurement begins."""
    E_trans = restored(ensemble.energies, ensemble.exponent).translational
    return {
        "E_trans": E_trans.mean(axis=0)[first],
        "E_trans_stderr": _scatter(E_trans)[first],
        "equilibrated": UNKNOWN,  # nothing but R would show it
        "measured_from": passed[first],
        "measured_collisions": passed[-1] - (passed[first - 1] if first else 0.0),
        "plateau_end": passed[-1],
        "collisions_per_particle": passed,
        "E_trans_series": E_trans.mean(axis=0),
        **_of_species(ensemble, np.arange(len(passed)) >= first),
    }


def _of_species(ensemble, inside):
    return cooling_species(ensemble.species, ensemble.energies, ensemble.exponent, inside)


def _scatter(values):
    """Return the standard error over replicas, those along the first axis."""
    return values.std(axis=0, ddof=1) / math.sqrt(len(values))
