"""A freely cooling gas: many replicas of it, averaged where R has settled on its plateau."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from roughgas.initial import initial_state
from roughgas.measure.energies import Energies, energies, ratio, ratio_of_means, restored
from roughgas.measure.errors import autocorrelation_time
from roughgas.measure.intervals import Error
from roughgas.measure.plateau import find_plateau
from roughgas.protocols.books import Books, books, exchange
from roughgas.scene import Scene
from roughgas.theory import relaxation_rate

SAMPLES_PER_REFRESH = 4
TRANSIENT = 10.0, 1000.0  # collisions per particle: theory's estimate is kept between these


class Cooled(NamedTuple):
    """One replica, or several along the first axis; energies in units of E_trans at the start."""

    energies: Energies  # of each sample, over 4^exponent: they may fall below the smallest number
    exponent: np.ndarray
    before: Books
    after: Books


def run(scene: Scene, experiment: Mapping[str, Any], seed: int, recorder) -> dict[str, Any]:
    """Variables of the point (see roughgas.dataset), from `replicas` independent simulations.

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
    """The rate at which R relaxes, by the rate equations, per collision per particle."""
    q = scene.effects.spin.inertia
    return float(relaxation_rate(scene.restitution, scene.roughness, len(scene.box), q))


def _cool(state, scene, schedule, number, samples, recorder):
    """One replica, from when dissipation is switched on."""
    per_unit = number / 2  # a collision has two partners
    elastic = scene._replace(restitution=1.0, roughness=-1.0)
    thermal = math.ceil(per_unit * schedule["thermalise"])
    before = recorder.in_collisions(state, elastic, thermal, 1)
    start = energies(before, number, scene.effects.spin.inertia).translational[0]
    opened = books(state, scene)
    collisions = max(1, round(per_unit * schedule["sample_every"]))
    rows = recorder.in_collisions(state, scene, collisions, samples, SAMPLES_PER_REFRESH)
    present = energies(rows, number, scene.effects.spin.inertia)
    kept = (present, opened, books(state, scene))
    present, opened, closed = (type(one)(*(part / start for part in one)) for one in kept)
    return Cooled(present, rows["exponent"].astype(int), opened, closed)


def _together(runs):
    """All replicas as one: energies stacked, books averaged."""
    present, exponent, before, after = zip(*runs, strict=True)
    return Cooled(
        Energies(*(np.array(part) for part in zip(*present, strict=True))),
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
    E_trans, E_rot = (part.mean(axis=0) for part in restored(ensemble.energies, exponent))
    alike = restored(ensemble.energies, exponent - exponent.max(axis=0))
    return {
        "R": plateau.mean,
        "R_stderr": error.stderr,
        "R_dof": error.dof,
        "R_ci95": error.half_width(0.95),
        "R_ci95_trusted": plateau.found,
        "R_ratio_of_means": ratio_of_means(alike, axis=0)[inside].mean(),
        "E_trans": E_trans[first],
        "E_rot": E_rot[first],
        "equilibrated": plateau.found,
        "measured_from": plateau.start,
        "plateau_end": plateau.stop,
        "autocorrelation_time": autocorrelation_time(R[:, inside]) * every,
        "R_replica": plateau.per_replica,
        "collisions_per_particle": passed,
        "R_series": R.mean(axis=0),
        "R_series_stderr": R.std(axis=0, ddof=1) / math.sqrt(len(R)),
        "E_trans_series": E_trans,
        "E_rot_series": E_rot,
    }
