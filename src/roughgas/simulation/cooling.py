"""A freely cooling gas: many replicas of it, averaged where R has settled on its plateau."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from roughgas.effects import inertia
from roughgas.scene import Scene
from roughgas.scene.initial import initial_state
from roughgas.simulation.books import Books, books, exchange
from roughgas.simulation.energies import Energies, energies, ratio, ratio_of_means, restored
from roughgas.statistics.errors import autocorrelation_time
from roughgas.statistics.intervals import Error
from roughgas.statistics.plateau import find_plateau
from roughgas.theory import friction_relaxation_rate, relaxation_rate

SAMPLES_PER_REFRESH = 4
TRANSIENT = 10.0, 1000.0  # collisions per particle: theory's estimate is kept between these


class Cooled(NamedTuple):
    """One replica, or several along the first axis; energies in units of E_trans at the start."""

    energies: Energies  # of each sample, over 4^exponent: they may fall below the smallest number
    exponent: np.ndarray
    before: Books
    after: Books


def run(scene: Scene, experiment: Mapping[str, Any], seed: int, recorder) -> dict[str, Any]:
    """Variables of the point (see roughgas.data.point), from `replicas` independent simulations.

    Each starts as a smooth elastic gas, thermalised for `thermalise` collisions per particle. Then
    dissipation is switched on for the time that the rate equations say R needs to settle,
    `relaxation_times` of its e-folds, and for `plateau` collisions per particle more.
    """
    schedule, number = experiment["schedule"], experiment["particles"]
    transient = transient_length(scene, schedule["relaxation_times"])
    every = schedule["sample_every"]
    samples = math.ceil((transient + schedule["plateau"]) / every)
    seeds = np.random.SeedSequence(seed).spawn(schedule["replicas"])
    runs = []
    for one in seeds:
        state = initial_state(scene, experiment, np.random.default_rng(one))
        runs.append(_cool(state, scene, schedule, number, samples, recorder))
    ensemble = _together(runs)
    passed = every * np.arange(1, samples + 1)
    exchanged = exchange(ensemble.before, ensemble.after, scene, number)
    if scene.effects.spin is None:
        first = min(math.ceil(transient / every), samples) - 1
        return _decay(ensemble, passed, first) | exchanged
    return _measure(ensemble, passed, transient, every) | exchanged


def length(scene: Scene, schedule: Mapping[str, Any]) -> float:
    """Collisions per particle to be simulated, in all replicas together."""
    transient = transient_length(scene, schedule["relaxation_times"])
    return schedule["replicas"] * (schedule["thermalise"] + transient + schedule["plateau"])


def transient_length(scene: Scene, relaxation_times: float) -> float:
    """Collisions per particle that R needs to settle, by the rate equations."""
    rate = rate_of(scene)
    return min(max(relaxation_times / rate if rate > 0.0 else math.inf, TRANSIENT[0]), TRANSIENT[1])


def rate_of(scene: Scene) -> float:
    """The rate at which R relaxes, by the rate equations, per collision per particle; without spin
    there is nothing to relax."""
    q = inertia(scene.effects)
    if q is None:
        return math.inf
    r, beta, dimension = scene.restitution, scene.roughness, len(scene.box)
    friction = scene.effects.friction
    if friction is None:
        return float(relaxation_rate(r, beta, dimension, q))
    return float(friction_relaxation_rate(r, beta, friction.mu, dimension, q))


def _cool(state, scene, schedule, number, samples, recorder):
    """One replica, from when dissipation is switched on."""
    per_unit = number / 2  # a collision has two partners
    thermal = math.ceil(per_unit * schedule["thermalise"])
    before = recorder.in_collisions(state, elastic(scene), thermal, 1)
    q = inertia(scene.effects)
    start = energies(before, number, q).translational[0]
    opened = books(state, scene)
    collisions = max(1, round(per_unit * schedule["sample_every"]))
    rows = recorder.in_collisions(state, scene, collisions, samples, SAMPLES_PER_REFRESH)
    present = energies(rows, number, q).map(lambda part: part / start)
    opened, closed = (Books(*(part / start for part in b)) for b in (opened, books(state, scene)))
    return Cooled(present, rows["exponent"].astype(int), opened, closed)


def elastic(scene: Scene) -> Scene:
    """The scene with smooth elastic particles, and side walls if it has any."""
    walls = scene.effects.walls
    if walls is not None:
        walls = walls._replace(restitution=1.0, roughness=-1.0)
    effects = scene.effects._replace(walls=walls)
    return scene._replace(restitution=1.0, roughness=-1.0, effects=effects)


def _together(runs):
    """All replicas as one: energies stacked, books averaged."""
    present, exponent, before, after = zip(*runs, strict=True)
    return Cooled(
        Energies(*map(np.array, zip(*(one.there() for one in present), strict=True))),
        np.array(exponent),
        *(
            Books(*(np.mean(part, axis=0) for part in zip(*one, strict=True)))
            for one in (before, after)
        ),
    )


def _measure(ensemble, passed, transient, every):
    R = ratio(ensemble.energies)
    plateau = find_plateau(passed, R, transient)
    inside = (passed >= plateau.start) & (passed <= plateau.stop)
    first = np.argmax(inside)
    error = Error(plateau.stderr, len(R) - 1.0)
    exponent = ensemble.exponent
    E_rot = restored(ensemble.energies, exponent).rotational.mean(axis=0)
    alike = restored(ensemble.energies, exponent - exponent.max(axis=0))
    return _decay(ensemble, passed, first) | {
        "R": plateau.mean,
        "R_stderr": error.stderr,
        "R_dof": error.dof,
        "R_ci95": error.half_width(0.95),
        "R_ci95_trusted": plateau.found,
        "R_ratio_of_means": ratio_of_means(alike, axis=0)[inside].mean(),
        "E_rot": E_rot[first],
        "equilibrated": plateau.found,
        "measured_from": plateau.start,
        "plateau_end": plateau.stop,
        "autocorrelation_time": autocorrelation_time(R[:, inside]) * every,
        "R_replica": plateau.per_replica,
        "R_series": R.mean(axis=0),
        "R_series_stderr": _scatter(R),
        "E_rot_series": E_rot,
    }


def _decay(ensemble, passed, first):
    """How the translational energy decays, and what it is when the measurement begins."""
    E_trans = restored(ensemble.energies, ensemble.exponent).translational
    return {
        "E_trans": E_trans.mean(axis=0)[first],
        "E_trans_stderr": _scatter(E_trans)[first],
        "equilibrated": True,
        "measured_from": passed[first],
        "plateau_end": passed[-1],
        "collisions_per_particle": passed,
        "E_trans_series": E_trans.mean(axis=0),
    }


def _scatter(values):
    """Standard error over replicas, those along the first axis."""
    return values.std(axis=0, ddof=1) / math.sqrt(len(values))
