"""Four ways to R of a freely cooling gas.

R is the mean over samples of R(t), one sample a collision per particle, once the gas has settled.
Simulations start at theory's stationary T_rot/T_tr, so that only what theory misses has to settle.
The rate equations start at equipartition, since there would be nothing to find otherwise.
"""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from roughgas import theory
from roughgas.effects import inertia
from roughgas.scene import build
from roughgas.simulation.cooling import SAMPLES_PER_REFRESH
from roughgas.simulation.energies import ratio
from roughgas.simulation.gas import Gas
from roughgas.statistics.errors import blocking_stderr
from roughgas.tasks import check_alike, dsmc, timed
from roughgas.theory.arguments import positive_root, shares

E_FOLDS = 10.0  # of theory's relaxation before R is measured
SHORTEST_TRANSIENT = 10.0  # collisions per particle, in which velocities forget to be Maxwellian
MOST_SAMPLES = 10000  # of one run of a large gas


class FreeCooling(NamedTuple):
    """Where in the plane of r and beta a gas cools, and in which experiment."""

    experiment: Mapping[str, Any]
    r: float
    beta: float

    @property
    def constants(self) -> tuple[float, float, int, float]:
        """(r, beta, dimension, inertia), as theory takes them."""
        check_alike(self.experiment)
        inertia = self.experiment["effects"]["spin"]["inertia"]
        return self.r, self.beta, len(self.experiment["box"]), inertia

    @property
    def theta(self) -> float:
        """T_rot/T_tr of theory."""
        return float(theory.stationary_theta(*self.constants))

    @property
    def transient(self) -> float:
        """Collisions per particle from theory's theta until R has settled."""
        return max(SHORTEST_TRANSIENT, E_FOLDS / self.rate)

    @property
    def rate(self) -> float:
        """Rate at which R relaxes, per collision per particle, by the rate equations."""
        return float(theory.relaxation_rate(*self.constants))

    def relative_variance(self, particles: int) -> float:
        """Variance of R over R^2: that of Gaussian fluctuations, (1 - R)^2 3/N (disks), and half as
        much again since they are larger."""
        dimension, R = len(self.experiment["box"]), self.theta / (1.0 + self.theta)
        components = 2.0 / dimension + 2.0 / (2 * dimension - 3)
        return 1.5 * (1.0 - R) ** 2 * components / particles

    def at_packing(self, packing: float) -> "FreeCooling":
        """Return the gas in a box of the same shape that its particles fill to `packing`."""
        box, number = self.experiment["box"], self.experiment["particles"]
        wanted = number / float(theory.number_density(packing, len(box)))
        factor = (wanted / math.prod(box)) ** (1.0 / len(box))
        box = [factor * side for side in box]
        return self._replace(experiment=dict(self.experiment) | {"box": box})


def corrected_ratio(a20, a11, r, beta, dimension=2, inertia=None) -> np.ndarray:
    """Return R of theory for a gas with the cumulants a20 and a11 (see dsmc.Samples); broadcasts.

    Fast particles collide more often than others. Averages over collisions therefore exceed those
    over particles: of v_n^2 and v_t^2 by the factor 1 + a20/4 beyond what a Maxwellian gas has, of
    the squared spin by 1 + a11/4 where fast particles spin faster. With these factors the rate
    equations are balanced again, as in theory, which is the case a20 = a11 = 0. First order in
    the cumulants, in any number of dimensions, but that spheres whose spin is not isotropic about
    their velocity have a further term, which is left out. Raises InputError.
    """
    rates = theory.collision_rates(r, beta, dimension, inertia)
    translation, rotation = 1 + np.asarray(a20) / 4, 1 + np.asarray(a11) / 4
    numerator, denominator = positive_root(
        rotation * rates.translational_gain,
        translation * rates.translational_loss - rotation * rates.rotational_loss,
        translation * rates.rotational_gain,
    )
    return shares(denominator, numerator, neither=0)[1][()]


def rate_equations(duration: float, *constants) -> float:
    """Return R after `duration` collisions per particle from equipartition on."""
    T_tr, T_rot = integrate(1.0, duration, 0.1, *constants)
    return T_rot / (T_tr + T_rot)


def integrate(theta, duration, step, r, beta, dimension=2, inertia=None) -> tuple[float, float]:
    """Return (T_tr, T_rot) after `duration` collisions per particle from (1, theta) on.

    The rate equations in time, by the classical Runge-Kutta method; a step is `step` times the
    present mean time between two collisions of a particle (units: that at the start). Collisions
    are counted by an equation of their own, and the last step is shortened to end at `duration`.
    """
    rates = theory.collision_rates(r, beta, dimension, inertia)
    loss, gain, spin_gain, spin_loss = map(float, rates)

    def slope(state):
        frequency = state[0] ** 0.5
        return (
            frequency * (gain * state[1] - loss * state[0]),
            frequency * (spin_gain * state[0] - spin_loss * state[1]),
            frequency,
        )

    state = [1.0, float(theta), 0.0]
    while state[2] < duration * (1.0 - 1e-12):
        h = min(step, duration - state[2]) / state[0] ** 0.5
        slopes = [slope(state)]
        for part in (0.5, 0.5, 1.0):
            slopes.append(slope(_moved(state, slopes[-1], h * part)))
        mean = [(a + 2 * b + 2 * c + d) / 6 for a, b, c, d in zip(*slopes, strict=True)]
        state = _moved(state, mean, h)
    return state[0], state[1]


def _moved(state, slope, h):
    return [x + h * dx for x, dx in zip(state, slope, strict=True)]


def few_particles(cooling: FreeCooling, length: float, seed: np.random.SeedSequence) -> float:
    """Return R by direct simulation Monte Carlo of as many particles as the experiment has."""
    number = cooling.experiment["particles"]
    return float(_without_positions(cooling, number, 1, round(length), seed).R.mean())


def homogeneous(
    cooling: FreeCooling, particles: int, precision: float, seed: np.random.SeedSequence
) -> dict[str, float]:
    """Return means over a long run of a large gas by direct simulation Monte Carlo, by name.

    R, its drift from the first to the second half of the run, and the standard errors of both; the
    cumulants of dsmc.Samples, and the standard error of a02; length in collisions per particle, and
    CPU seconds. The length is what a relative error `precision` of R needs, whose fluctuations live
    1/Gamma, and at least five transients.
    """
    e_folds = 2.0 * cooling.relative_variance(particles) / precision**2
    length = max(5.0 * cooling.transient, e_folds * cooling.transient / E_FOLDS)
    every = max(1.0, length / MOST_SAMPLES)
    run = cooling, particles, every, round(length / every), seed
    samples, seconds = timed(_without_positions, *run)
    early, late = np.split(samples.R, [len(samples.R) // 2])
    return {
        "R": samples.R.mean(),
        "R_stderr": blocking_stderr(samples.R),
        "drift": late.mean() - early.mean(),
        "drift_stderr": np.hypot(blocking_stderr(early), blocking_stderr(late)),
        **{name: getattr(samples, name).mean() for name in ("a20", "a02", "a11")},
        "a02_stderr": blocking_stderr(samples.a02),
        "length": length,
        "seconds": seconds,
    }


def _without_positions(cooling, particles, every, samples, seed):
    """Return dsmc.Samples of a gas that has settled."""
    rng, (_, _, *kind) = np.random.default_rng(seed), cooling.constants
    gas = dsmc.new_gas(particles, cooling.theta, rng, *kind)
    material = dsmc.material(*cooling.constants)
    dsmc.run(gas, material, rng, 1, round(cooling.transient))
    return dsmc.run(gas, material, rng, every, samples)


def event_driven(
    cooling: FreeCooling, segment: float, length: float, seed: np.random.SeedSequence
) -> np.ndarray:
    """Return R of each replica, shape (replicas,).

    Equal replicas of at most about `segment` collisions per particle are `length` long together,
    the smooth elastic gas before and the transient not counted.
    """
    replicas = max(1, round(length / segment))
    return np.array([_replica(cooling, length / replicas, one) for one in seed.spawn(replicas)])


def thermalised(cooling: FreeCooling, seed: np.random.SeedSequence) -> Gas:
    """Return a gas at theory's T_rot/T_tr, as dissipation is switched on."""
    scene = build(cooling.experiment, cooling.r, cooling.beta)
    rng = np.random.default_rng(seed)
    gas = Gas.start(scene, cooling.experiment, rng)
    spin, q = gas.state.spin, inertia(scene.effects)
    assert spin is not None and q is not None  # FreeCooling is of particles that spin
    spin[:] = rng.standard_normal(spin.shape) * (cooling.theta / q) ** 0.5
    gas.thermalise(cooling.experiment["schedule"]["thermalise"])
    gas.cool(SAMPLES_PER_REFRESH * gas.count(1.0))
    return gas


def _replica(cooling, length, seed):
    gas, skipped = thermalised(cooling, seed), round(cooling.transient)
    rows = gas.in_collisions(gas.count(1.0), skipped + max(1, round(length)))
    return float(ratio(gas.energies(rows))[skipped:].mean())
