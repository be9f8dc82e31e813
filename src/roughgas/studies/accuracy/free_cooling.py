"""Four ways to R of a freely cooling gas: each gives R, and the CPU seconds that it took.

R is the mean over samples of R(t), one sample a collision per particle, once the gas has settled.
Simulations start at theory's stationary T_rot/T_tr, so that only what theory misses has to settle.
The rate equations start at equipartition, since they would else have nothing to find.
"""

import math
import time
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from roughgas import theory
from roughgas.scene import Scene, build
from roughgas.scene.initial import initial_state
from roughgas.simulation.energies import energies, ratio
from roughgas.simulation.recorder import Recorder
from roughgas.statistics.errors import blocking_stderr
from roughgas.studies import dsmc
from roughgas.studies.accuracy.cumulants import corrected_ratio

E_FOLDS = 10.0  # of theory's relaxation before R is measured
SHORTEST_TRANSIENT = 10.0  # collisions per particle, in which velocities forget to be Maxwellian
SAMPLES_PER_REFRESH = 4
MOST_SAMPLES = 10000  # of one run of a large gas


class Result(NamedTuple):
    """R of one run, and what it cost."""

    R: float
    seconds: float


class Homogeneous(NamedTuple):
    """A long run of a large gas: means over samples, with standard errors of R and its drift."""

    R: float
    R_stderr: float
    drift: float  # of R from the first to the second half of the run
    drift_stderr: float
    a20: float  # cumulants as in dsmc.Samples
    a02: float
    a11: float
    length: float  # collisions per particle
    seconds: float


class Point(NamedTuple):
    """Where in the plane of r and beta, and in which experiment."""

    experiment: Mapping[str, Any]
    r: float
    beta: float

    @property
    def scene(self) -> Scene:
        return build(self.experiment, self.r, self.beta)

    @property
    def theta(self) -> float:
        return float(theory.stationary_theta(self.r, self.beta, *self._kind))

    @property
    def transient(self) -> float:
        """Collisions per particle from theory's theta until R has settled."""
        rate = float(theory.relaxation_rate(self.r, self.beta, *self._kind))
        return max(SHORTEST_TRANSIENT, E_FOLDS / rate)

    @property
    def theory(self) -> float:
        """R of Eq. (K)."""
        return float(theory.cooling_ratio(self.r, self.beta, *self._kind))

    def with_cumulants(self, a20: float, a11: float) -> float:
        """R of Eq. (K), corrected for velocities that are not Maxwellian."""
        return float(corrected_ratio(self.r, self.beta, a20, a11, *self._kind))

    @property
    def _kind(self):
        return len(self.experiment["box"]), self.experiment["effects"]["spin"]["inertia"]


def closed_form(point: Point, calls: int) -> Result:
    """Eq. (K); the seconds are those of one of `calls` calls."""
    begin = time.process_time()
    for _ in range(calls):
        R = theory.cooling_ratio(point.r, point.beta, *point._kind)
    return Result(float(R), (time.process_time() - begin) / calls)


def rate_equations(point: Point, duration: float, calls: int, step: float = 0.1) -> Result:
    """The rate equations, integrated for `duration` collisions per particle from equipartition on;
    the seconds are those of one of `calls` calls."""
    begin = time.process_time()
    for _ in range(calls):
        T_tr, T_rot = integrate(1.0, point.r, point.beta, duration, step, *point._kind)
    return Result(T_rot / (T_tr + T_rot), (time.process_time() - begin) / calls)


def integrate(theta, r, beta, duration, step, dimension=2, inertia=None) -> tuple[float, float]:
    """(T_tr, T_rot) after `duration` collisions per particle from (1, theta) on.

    The rate equations in time, by the classical Runge-Kutta method; a step is `step` times the
    present mean time between two collisions of a particle (units: that at the start). Collisions
    are counted by an equation of their own, and the last step is shortened to end at `duration`.
    """
    loss, gain, spin_gain, spin_loss = map(
        float, theory.collision_rates(r, beta, dimension, inertia)
    )

    def slope(T_tr, T_rot, _):
        frequency = T_tr**0.5
        return (
            frequency * (gain * T_rot - loss * T_tr),
            frequency * (spin_gain * T_tr - spin_loss * T_rot),
            frequency,
        )

    state = (1.0, float(theta), 0.0)
    while state[2] < duration * (1.0 - 1e-12):
        h = min(step, duration - state[2]) / state[0] ** 0.5
        state = _runge_kutta(slope, state, h)
    return state[0], state[1]


def _runge_kutta(slope, state, h):
    def moved(k, h):
        return [x + h * dx for x, dx in zip(state, k, strict=True)]

    k1 = slope(*state)
    k2 = slope(*moved(k1, h / 2))
    k3 = slope(*moved(k2, h / 2))
    k4 = slope(*moved(k3, h))
    mean = [(a + 2 * b + 2 * c + d) / 6 for a, b, c, d in zip(k1, k2, k3, k4, strict=True)]
    return tuple(moved(mean, h))


def simulated(point: Point, length: float, rng: np.random.Generator) -> Result:
    """Direct simulation Monte Carlo of as many particles as the experiment has, in one run."""
    number = point.experiment["particles"]
    dimension, inertia = point._kind
    begin = time.process_time()
    gas = dsmc.new_gas(number, point.theta, rng, dimension, inertia)
    material = dsmc.material(point.r, point.beta, dimension, inertia)
    dsmc.run(gas, material, rng, 1, round(point.transient))
    R = dsmc.run(gas, material, rng, 1, round(length)).R.mean()
    return Result(float(R), time.process_time() - begin)


def homogeneous(
    point: Point, particles: int, precision: float, rng: np.random.Generator
) -> Homogeneous:
    """Direct simulation Monte Carlo of a large gas, as long as a relative error of R needs.

    The length is that of Gaussian fluctuations, (1 - R)^2 3/N of R^2 (disks), which live 1/Gamma,
    half as much again since they are larger, and at least five transients.
    """
    dimension, inertia = point._kind
    gas = dsmc.new_gas(particles, point.theta, rng, dimension, inertia)
    material = dsmc.material(point.r, point.beta, dimension, inertia)
    length = 1.5 * _gaussian_length(point, particles, precision)
    length = max(5.0 * point.transient, length)
    every = max(1.0, length / MOST_SAMPLES)
    begin = time.process_time()
    dsmc.run(gas, material, rng, 1, round(point.transient))
    samples = dsmc.run(gas, material, rng, every, round(length / every))
    seconds = time.process_time() - begin
    return _summary(samples, length, seconds)


def _gaussian_length(point, particles, precision):
    dimension, _ = point._kind
    R = point.theta / (1.0 + point.theta)
    variance = (1.0 - R) ** 2 * (2.0 / dimension + 2.0 / (2 * dimension - 3)) / particles
    e_folds = 2.0 * variance / precision**2
    return e_folds * point.transient / E_FOLDS


def _summary(samples, length, seconds):
    R, half = samples.R, len(samples.R) // 2
    early, late = R[:half], R[half:]
    return Homogeneous(
        R=R.mean(),
        R_stderr=blocking_stderr(R),
        drift=late.mean() - early.mean(),
        drift_stderr=np.hypot(blocking_stderr(early), blocking_stderr(late)),
        a20=samples.a20.mean(),
        a02=samples.a02.mean(),
        a11=samples.a11.mean(),
        length=length,
        seconds=seconds,
    )


def event_driven(
    point: Point, length: float, segment: float, seed: np.random.SeedSequence
) -> tuple[np.ndarray, float]:
    """R of each replica, shape (replicas,), and the CPU seconds of all.

    There are so many equal replicas of at most `segment` collisions per particle that they are
    `length` long together, the smooth elastic gas before and the transient not counted.
    """
    replicas = max(1, round(length / segment))
    begin = time.process_time()
    R = [_replica(point, length / replicas, child) for child in seed.spawn(replicas)]
    return np.array(R), time.process_time() - begin


def _replica(point, length, seed):
    scene, number = point.scene, point.experiment["particles"]
    rng, recorder = np.random.default_rng(seed), Recorder()
    q = scene.effects.spin.inertia
    state = initial_state(scene, point.experiment, rng)
    state.spin[:] = rng.standard_normal(state.spin.shape) * (point.theta / q) ** 0.5
    smooth = scene._replace(restitution=1.0, roughness=-1.0)
    thermal = round(point.experiment["schedule"]["thermalise"] * number / 2)
    recorder.in_collisions(state, smooth, max(1, thermal), 1)
    every, skipped = max(1, number // 2), round(point.transient)
    samples = skipped + max(1, round(length))
    rows = recorder.in_collisions(state, scene, every, samples, SAMPLES_PER_REFRESH)
    return float(ratio(energies(rows, number, q))[skipped:].mean())


def at_packing(experiment: Mapping[str, Any], packing: float) -> dict[str, Any]:
    """The experiment in a box of the same shape that its particles fill to `packing`."""
    box, number = experiment["box"], experiment["particles"]
    wanted = number / float(theory.number_density(packing, len(box)))
    factor = (wanted / math.prod(box)) ** (1.0 / len(box))
    return dict(experiment) | {"box": [factor * side for side in box]}
