"""The cooling protocol: replicas of a freely cooling gas, and R averaged over its plateau.

Lengths of time are in collisions per particle. Every function takes the scene at the r and beta of
a point, and the settings of its experiment. An `ensemble` is a CooledRun of all replicas, whose
arrays have the replicas along the first axis.
"""

import math
from collections.abc import Sequence
from functools import partial
from typing import Annotated, Any

import numpy as np
from msgspec.structs import replace

from roughgas.base import InputError, NamedValues
from roughgas.base.fields import described, whole
from roughgas.effects import inertia, reference_speed
from roughgas.effects.species import packing
from roughgas.scene import Scene, elastic, theory_mixture
from roughgas.simulation.energies import Columns, ratio, restored
from roughgas.simulation.energy_averages import (
    cooling_species_averages,
    ratio_of_means,
    trust_of_means,
)
from roughgas.simulation.energy_balance import energy_exchange
from roughgas.simulation.error_target import TARGET_KEY, prolonged_until_met
from roughgas.simulation.experiment import (
    Duration,
    Experiment,
    Length,
    RelaxationTimes,
    ScheduleSettings,
    Target,
)
from roughgas.simulation.gas import PRESENT_SAMPLE, Gas, count, thermalisation_sampling
from roughgas.simulation.initial_states import InitialState
from roughgas.simulation.leg import Changes, Leg
from roughgas.simulation.replicas import COOLING_LEG, CooledReplicas, stacked_runs
from roughgas.simulation.simulation import Simulation
from roughgas.statistics.errors import StandardError, autocorrelation_time
from roughgas.statistics.sample_sizes import MINIMUM_SAMPLE_SIZE, UNKNOWN, SampleSize
from roughgas.statistics.steady_state import find_plateau
from roughgas.theory import friction_relaxation_rate, mixture_relaxation_rate, relaxation_rate

Replicas = Annotated[int, whole(2, 1_000_000, "Independent runs in one point.")]


class CoolingSettings(ScheduleSettings, frozen=True, kw_only=True, tag="cooling"):
    """A freely cooling gas; lengths are in collisions per particle."""

    replicas: Replicas
    thermalise: Annotated[
        Length,
        described("Collisions per particle as smooth elastic disks before cooling begins."),
    ]
    relaxation_times: RelaxationTimes
    plateau: Annotated[Duration, described("Collisions per particle on the plateau.")]
    target_stderr: Target | None = None


# see roughgas.simulation.protocols.RunProtocol
SETTINGS: type[ScheduleSettings] = CoolingSettings
DRIVEN, UNIT, LENGTH = False, "collisions per particle", "plateau"
SAMPLES_PER_REFRESH = 4
# Collisions per particle. Between refreshes, after four times this, velocities fall by a factor of
# 1e-9 at the strongest dissipation; after 400 collisions their roundings would exceed them.
LONGEST_INTERVAL = 25.0
# Bounds of the transient that theory estimates, in collisions per particle. At r <= 0.9 none is
# longer; nearly elastic disks or spheres can need a hundred times longer, close to beta = -1.
SHORTEST_TRANSIENT, LONGEST_TRANSIENT = 10.0, 2500.0


def length(scene: Scene, experiment: Experiment[CoolingSettings]) -> float:
    """Return the length of a point in collisions per particle, summed over its replicas."""
    schedule = experiment.schedule
    transient = transient_length(scene, schedule.relaxation_times, experiment)
    return schedule.replicas * (schedule.thermalise + transient + schedule.plateau)


def transient_length(
    scene: Scene, relaxation_times: float, experiment: Experiment[CoolingSettings] | None = None
) -> float:
    """Return the settling time of R by the rate equations, in collisions per particle.

    It is `relaxation_times` e-folds of R, within SHORTEST_TRANSIENT and LONGEST_TRANSIENT.
    `experiment` is needed for mixtures only.
    """
    rate = R_relaxation_rate(scene, experiment)
    return min(
        max(relaxation_times / rate if rate > 0.0 else math.inf, SHORTEST_TRANSIENT),
        LONGEST_TRANSIENT,
    )


def R_relaxation_rate(scene: Scene, experiment: Experiment[CoolingSettings] | None = None) -> float:
    """Return the relaxation rate of R by the rate equations, in e-folds per collision per particle.

    In a mixture it is the slowest relaxation rate of the temperatures; only then is `experiment`
    needed. Identical particles without spin have nothing to relax: infinity.
    """
    mixture = None if experiment is None else theory_mixture(scene, experiment)
    if experiment is not None and mixture is not None:
        return mixture_relaxation_rate(mixture, packing(experiment))
    q = inertia(scene.effects)
    if q is None:
        return math.inf
    r, beta, dimension = scene.restitution, scene.roughness, len(scene.box)
    friction = scene.effects.friction
    if friction is None:
        return float(relaxation_rate(r, beta, dimension, q))
    return float(friction_relaxation_rate(r, beta, friction.mu, dimension, q))


def interval(experiment: Experiment[CoolingSettings]) -> float:
    """Return the interval between two samples, in collisions per particle.

    It is `sample_every`, rounded to whole collisions in the gas, at least one.
    """
    number = experiment.particles
    return 2 * count(number, experiment.schedule.sample_every) / number


def check(scene: Scene, experiment: Experiment[CoolingSettings]) -> None:
    """Raise InputError if samples are too far apart.

    Either velocities would lose their digits between two samples, or the plateau is shorter than
    the interval between samples.
    """
    plateau, every = experiment.schedule.plateau, interval(experiment)
    if every > LONGEST_INTERVAL:
        legal = f"be at most {LONGEST_INTERVAL:g} collisions per particle in a cooling gas"
        raise InputError("schedule.sample_every", experiment.schedule.sample_every, legal)
    if plateau < every:
        legal = f"be at least schedule.sample_every, {every:g} collisions per particle"
        raise InputError("schedule.plateau", plateau, legal)


def start(
    scene: Scene,
    experiment: Experiment[CoolingSettings],
    seed: Any,
    initial: Sequence[InitialState] = (),
) -> Gas:
    """Return the first replica of a point, prepared, as it begins to cool.

    It is thermalised, or in its `initial` state. `seed` is the seed of the point, or a random
    generator, which is then used itself. `initial` has the states of all replicas; only the first
    is used.
    """
    stream = seed if isinstance(seed, np.random.Generator) else _streams(seed, 1)[0]
    gas = _replica(scene, experiment, stream, initial[:1])
    if initial:
        gas.sample_now()
    else:
        gas.thermalise(experiment.schedule.thermalise)
    gas.cool(_refresh_every(gas, experiment))
    return gas


def sample(gas: Gas, every: float, samples: int) -> Columns:
    """Advance a gas and return its samples as columns: name -> array of length `samples`.

    Samples are `every` collisions per particle apart.
    """
    return gas.in_collisions(gas.count(every), samples)


def samples_per_period(schedule: CoolingSettings) -> int:
    """Return 1, the number of samples in a period: nothing drives a cooling gas."""
    return 1


def phases(scene: Scene, schedule: CoolingSettings, every: int = 1) -> float:
    """Return infinity, the number of sampled phases of a drive: nothing drives a cooling gas."""
    return math.inf


def wait(scene: Scene, experiment: Experiment[CoolingSettings]) -> int:
    """Return the number of samples in the transient that theory predicts, to be discarded."""
    schedule = experiment.schedule
    transient = transient_length(scene, schedule.relaxation_times, experiment)
    return math.floor(transient / interval(experiment))


def run(
    scene: Scene,
    experiment: Experiment[CoolingSettings],
    seed: int,
    simulation: Simulation,
    initial: Sequence[InitialState] = (),
) -> NamedValues:
    """Simulate the replicas and return the variables of the point (see roughgas.data.point).

    Each replica starts as a smooth elastic gas, thermalised for `thermalise` collisions per
    particle, or in its `initial` state, and starts or continues to cool. Dissipation acts during
    the transient that the rate equations predict, `relaxation_times` e-folds of R, and for another
    `plateau` collisions per particle. With a target error, replicas are added until it is met.
    `initial` has one state per replica, or none. Raises InputError for a target error beside
    initial states.
    """
    schedule = experiment.schedule
    if initial and schedule.target_stderr is not None:
        legal = "not stand beside initial states, each of which begins one replica"
        raise InputError(f"schedule.{TARGET_KEY}", schedule.target_stderr, legal)
    transient = transient_length(scene, schedule.relaxation_times, experiment)
    samples = math.ceil((transient + schedule.plateau) / interval(experiment))
    replicas = simulation.track("replicas", CooledReplicas())
    legs = partial(_legs, experiment=experiment, samples=samples, goes_on=bool(initial))

    def run_to(longer):
        """Simulate all replicas of a longer schedule; return variables, and whether to stop."""
        simulation.expect(length(scene, replace(experiment, schedule=longer)))
        streams = _streams(seed, longer.replicas)
        for number in range(len(replicas.runs), len(streams)):
            states = initial[number : number + 1]
            replica = partial(_replica, scene, experiment, streams[number], states)
            simulation.follow(number, replica, legs)
        ensemble = stacked_runs(replicas.runs[: longer.replicas])
        variables = _point_variables(ensemble, scene, experiment, transient)
        return variables, longer.replicas >= MINIMUM_SAMPLE_SIZE.runs

    return prolonged_until_met(experiment.schedule, "replicas", run_to)


def _legs(
    gas: Gas, experiment: Experiment[CoolingSettings], samples: int, goes_on: bool
) -> list[Leg]:
    """Return the two legs of a replica: its preparation, and the cooling.

    The cooling has this number of `samples`. The preparation is thermalisation or, if the replica
    `goes_on` from an initial state, one sample.
    """
    every = gas.count(experiment.schedule.sample_every)
    refresh_every = _refresh_every(gas, experiment)
    gas.refresh_every = refresh_every
    sampling = gas.cooling_sampling(every)

    def cool(gas: Gas) -> Changes:
        """Start to cool a gas, and return its energy balance as arrays by name."""
        gas.cool(refresh_every)
        energy, ledger = gas.balance()
        return {"energy": energy, "ledger": ledger}

    if goes_on:
        first = Leg("look", PRESENT_SAMPLE, 1, gas.scene, preparation=True)
    else:
        until_thermal = thermalisation_sampling(gas.particles, experiment.schedule.thermalise)
        first = Leg("thermalise", until_thermal, 1, elastic(gas.scene), preparation=True)
    return [first, Leg(COOLING_LEG, sampling, samples, gas.scene, begin=cool)]


def _refresh_every(gas: Gas, experiment: Experiment[CoolingSettings]) -> int:
    """Return the number of collisions in the gas between two refreshes."""
    return SAMPLES_PER_REFRESH * gas.count(experiment.schedule.sample_every)


def _point_variables(ensemble, scene, experiment, transient):
    """Return the variables of a point from the ensemble of its replicas.

    `transient` is the predicted length of the transient, in collisions per particle.
    """
    every, collisions = interval(experiment), ensemble.collisions[0]  # equal in all replicas
    exchanged = energy_exchange(ensemble.before, ensemble.after, scene, experiment.particles)
    if reference_speed(scene.effects) is not None:  # the decay depends on the speeds
        exchanged |= _decay_over_time(ensemble)
    if scene.effects.spin is None:
        first = min(math.ceil(transient / every), len(collisions)) - 1
        return _energy_decay(ensemble, collisions, first) | exchanged
    rate = R_relaxation_rate(scene, experiment)
    return _plateau_variables(ensemble, collisions, transient, rate, every) | exchanged


def _streams(seed, replicas):
    """Return the seed sequences of a point's replicas, which the seed of the point determines."""
    return np.random.SeedSequence(seed).spawn(replicas)


def _replica(scene, experiment, stream, initial) -> Gas:
    """Return a replica at its start, with the random numbers of `stream`, a seed sequence.

    `initial` is a sequence of one state, or empty for particles on a lattice.
    """
    return Gas.start(scene, experiment, np.random.default_rng(stream), *initial)


def _decay_over_time(ensemble):
    """Return the variables `time_series`, the times of samples in T, and `decay_exponent`.

    The exponent x of E_trans ~ time^-x is fitted to the second half of the samples, at late times.
    """
    time = ensemble.time.mean(axis=0)
    E_trans = restored(ensemble.energies, ensemble.exponent).translational.mean(axis=0)
    later = slice(len(time) // 2, None)
    logarithms = np.log(time[later]), np.log(np.maximum(E_trans[later], np.finfo(float).tiny))
    return {"time_series": time, "decay_exponent": -np.polyfit(*logarithms, 1)[0]}


def _plateau_variables(ensemble, collisions, transient, rate, every):
    """Return the mean of R over its plateau, its error and verdict, and the energy decay, by name.

    `collisions` (samples,), `transient` and `every`, the interval between samples, are in
    collisions per particle; `rate` is the relaxation rate of R per collision per particle.
    """
    R = ratio(ensemble.energies)
    plateau = find_plateau(collisions, R, transient)
    inside = (collisions >= plateau.start) & (collisions <= plateau.stop)
    first = np.argmax(inside)
    length = plateau.stop - (collisions[first - 1] if first else 0.0)
    evidence = SampleSize(length, np.count_nonzero(inside), rate * plateau.start, runs=len(R))
    verdict = evidence.verdict(plateau.exists)
    error = StandardError(plateau.stderr, len(R) - 1.0)
    exponent = ensemble.exponent
    E_rot = restored(ensemble.energies, exponent).rotational
    same_unit = restored(ensemble.energies, exponent - exponent.max(axis=0))
    variables = _energy_decay(ensemble, collisions, first) | {
        "R": plateau.mean,
        "R_stderr": error.stderr,
        "R_dof": error.dof,
        "R_ci95": error.half_width(0.95),
        "R_ci95_trusted": verdict,
        "R_ratio_of_means": ratio_of_means(same_unit, axis=0)[inside].mean(),
        "E_rot": E_rot.mean(axis=0)[first],
        "E_rot_stderr": _stderr_of_replicas(E_rot)[first],
        "equilibrated": verdict,
        "measured_from": plateau.start,
        "measured_collisions": evidence.collisions,
        "plateau_end": plateau.stop,
        "autocorrelation_time": autocorrelation_time(R[:, inside]) * every,
        "R_replica": plateau.per_replica,
        "R_series": R.mean(axis=0),
        "R_series_stderr": _stderr_of_replicas(R),
        "E_rot_series": E_rot.mean(axis=0),
        **_species_averages(ensemble, inside),
    }
    return variables | trust_of_means(variables, verdict)


def _energy_decay(ensemble, collisions, first):
    """Return the variables of the decay of E_trans, and its value at the start of the measurement.

    `collisions` are the collisions per particle at each sample, `first` is the first measured
    sample.
    """
    E_trans = restored(ensemble.energies, ensemble.exponent).translational
    return {
        "E_trans": E_trans.mean(axis=0)[first],
        "E_trans_stderr": _stderr_of_replicas(E_trans)[first],
        "equilibrated": UNKNOWN,  # only R would show it
        "measured_from": collisions[first],
        "measured_collisions": collisions[-1] - (collisions[first - 1] if first else 0.0),
        "plateau_end": collisions[-1],
        "collisions_per_particle": collisions,
        "E_trans_series": E_trans.mean(axis=0),
        **_species_averages(ensemble, np.arange(len(collisions)) >= first),
    }


def _species_averages(ensemble, inside):
    """Return the averages of each species over the samples `inside` the plateau, by name.

    `inside` is (samples,).
    """
    return cooling_species_averages(ensemble.species, ensemble.energies, ensemble.exponent, inside)


def _stderr_of_replicas(values):
    """Return the standard error of the mean over replicas, the first axis of `values`."""
    return values.std(axis=0, ddof=1) / math.sqrt(len(values))
