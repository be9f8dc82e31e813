"""Four methods to compute R of a freely cooling gas.

R = T_rot/(T_rot + T_tr) is the share of rotational energy, theta = T_rot/T_tr; r is the normal
restitution, beta the roughness. The methods are the closed form of theory (with measured cumulants:
`corrected_ratio`), the rate equations, direct simulation Monte Carlo, and event-driven simulation.

R is the mean over samples of R(t), a sample per collision per particle, after a transient.
Simulations start at the stationary T_rot/T_tr of theory, so that only deviations from theory have
to relax. The rate equations start at equipartition, as they would not change otherwise.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from roughgas import theory
from roughgas.effects import inertia
from roughgas.scene import build
from roughgas.simulation.cooling import SAMPLES_PER_REFRESH
from roughgas.simulation.energies import ratio
from roughgas.simulation.experiment import Experiment
from roughgas.simulation.gas import Gas
from roughgas.statistics.errors import blocking_stderr
from roughgas.tasks import dsmc, require_single_species, timed
from roughgas.theory.arguments import positive_root, shares

TRANSIENT_E_FOLDS = 10.0  # of the relaxation by theory, before R is measured
SHORTEST_TRANSIENT = 10.0  # collisions per particle, for initially Maxwellian velocities to relax
MAXIMUM_SAMPLES = 10000  # of a run of a large gas


class FreeCooling(NamedTuple):
    """A freely cooling gas: its experiment, restitution r and roughness beta."""

    experiment: Experiment[Any]
    r: float
    beta: float

    @property
    def constants(self) -> tuple[float, float, int, float]:
        """Arguments (r, beta, dimension, inertia) of functions of theory.

        Raises InputError for an experiment with several species.
        """
        require_single_species(self.experiment)
        inertia = self.experiment.effects["spin"].inertia
        return self.r, self.beta, len(self.experiment.box), inertia

    @property
    def theta(self) -> float:
        """Stationary theta = T_rot/T_tr by theory."""
        return float(theory.stationary_theta(*self.constants))

    @property
    def transient(self) -> float:
        """Collisions per particle to omit, while deviations of R from theory relax.

        The gas starts at the stationary T_rot/T_tr of theory, but with Maxwellian velocities. The
        transient lasts TRANSIENT_E_FOLDS of the relaxation by theory, at least SHORTEST_TRANSIENT.
        """
        return max(SHORTEST_TRANSIENT, TRANSIENT_E_FOLDS / self.rate)

    @property
    def rate(self) -> float:
        """Relaxation rate of R, per collision per particle, by the rate equations."""
        return float(theory.relaxation_rate(*self.constants))

    def relative_variance(self, particles: int) -> float:
        """Estimate of the variance of R over R^2 in a gas of `particles`.

        R(t) varies in time. The estimate is 1.5 times the Gaussian value, (1 - R)^2 3/N for disks,
        as fluctuations exceed it.
        """
        dimension, R = len(self.experiment.box), self.theta / (1.0 + self.theta)
        inverse_degrees = 2.0 / dimension + 2.0 / (2 * dimension - 3)
        return 1.5 * (1.0 - R) ** 2 * inverse_degrees / particles

    def at_packing(self, packing: float) -> "FreeCooling":
        """Return the gas in a box of the same shape with the packing fraction `packing`."""
        box = [side for side in self.experiment.lengths if side is not None]
        number = self.experiment.particles
        volume = number / float(theory.number_density(packing, len(box)))
        factor = (volume / math.prod(box)) ** (1.0 / len(box))
        sides = [factor * side for side in box]
        return self._replace(experiment=self.experiment.changed({"box": sides}))


def corrected_ratio(a20, a11, r, beta, dimension=2, inertia=None) -> np.ndarray:
    """Return R of theory, the share of rotational energy, of a gas with the cumulants a20 and a11.

    They are defined in dsmc.Samples; all arguments broadcast. Fast particles collide more often.
    Averages of v_n^2 and v_t^2 over collisions therefore exceed their values in a Maxwellian gas by
    the factor 1 + a20/4, and averages of the squared spin by 1 + a11/4 if fast particles spin
    faster. With these factors the rate equations are balanced again; theory is the case
    a20 = a11 = 0. First order in the cumulants, in any number of dimensions. A further term of
    spheres whose spin is not isotropic about their velocity is omitted. Raises InputError.
    """
    rates = theory.collision_rates(r, beta, dimension, inertia)
    translation, rotation = 1 + np.asarray(a20) / 4, 1 + np.asarray(a11) / 4
    numerator, denominator = positive_root(
        rotation * rates.translational_gain,
        translation * rates.translational_loss - rotation * rates.rotational_loss,
        translation * rates.rotational_gain,
    )
    return shares(denominator, numerator, second_if_both_zero=0)[1][()]


def rate_equation_ratio(duration: float, *constants) -> float:
    """Return R, the share of rotational energy, after `duration` collisions per particle.

    The rate equations are integrated from equipartition on; `constants` are the arguments r, beta,
    dimension and inertia.
    """
    T_tr, T_rot = integrate(1.0, duration, 0.1, *constants)
    return T_rot / (T_tr + T_rot)


def integrate(theta, duration, step, r, beta, dimension=2, inertia=None) -> tuple[float, float]:
    """Return (T_tr, T_rot) after `duration` collisions per particle, starting at (1, `theta`).

    Integrates the rate equations in time by the classical Runge-Kutta method; a step is `step`
    times the present mean time between two collisions of a particle (the unit of time is its
    initial value). A further equation counts collisions, and the last step is shortened to end at
    `duration`. `inertia` is q = I/(m a^2), by default of uniform particles.
    """
    rates = theory.collision_rates(r, beta, dimension, inertia)
    loss, gain, spin_gain, spin_loss = map(float, rates)

    def slope(state):
        """Return the derivatives by time of (T_tr, T_rot, collisions per particle)."""
        frequency = state[0] ** 0.5
        return (
            frequency * (gain * state[1] - loss * state[0]),
            frequency * (spin_gain * state[0] - spin_loss * state[1]),
            frequency,
        )

    state = [1.0, float(theta), 0.0]
    while state[2] < duration * (1.0 - 1e-12):
        step_size = min(step, duration - state[2]) / state[0] ** 0.5
        slopes = [slope(state)]
        for fraction in (0.5, 0.5, 1.0):
            slopes.append(slope(_advanced(state, slopes[-1], step_size * fraction)))
        mean_slope = [(a + 2 * b + 2 * c + d) / 6 for a, b, c, d in zip(*slopes, strict=True)]
        state = _advanced(state, mean_slope, step_size)
    return state[0], state[1]


def _advanced(state, slope, h):
    """Return the state, a list of numbers, after an Euler step of size h along `slope`."""
    return [x + h * dx for x, dx in zip(state, slope, strict=True)]


def dsmc_ratio(cooling: FreeCooling, length: float, seed: np.random.SeedSequence) -> float:
    """Return R, the share of rotational energy, by direct simulation Monte Carlo.

    It is the mean over `length` collisions per particle after the transient of the gas `cooling`,
    with the particle number of its experiment; `seed` is the seed of all random numbers.
    """
    number = cooling.experiment.particles
    return float(_dsmc_samples(cooling, number, 1, round(length), seed).R.mean())


def dsmc_means(
    cooling: FreeCooling, particles: int, precision: float, seed: np.random.SeedSequence
) -> dict[str, float]:
    """Return means over a long run of a large gas by direct simulation Monte Carlo, by name.

    R, the share of rotational energy, its drift from the first to the second half of the run, and
    the standard errors of both; the cumulants of dsmc.Samples, and the standard error of a02;
    length in collisions per particle, and CPU seconds. `particles` is the number of particles. The
    length is chosen for a relative error `precision` of R, whose fluctuations decay in 1/Gamma, and
    is at least five transients.
    """
    e_folds = 2.0 * cooling.relative_variance(particles) / precision**2
    length = max(5.0 * cooling.transient, e_folds * cooling.transient / TRANSIENT_E_FOLDS)
    every = max(1.0, length / MAXIMUM_SAMPLES)
    run = cooling, particles, every, round(length / every), seed
    samples, seconds = timed(_dsmc_samples, *run)
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


def _dsmc_samples(cooling, particles, every, samples, seed):
    """Return dsmc.Samples of the gas with the parameters `cooling` (FreeCooling) after its
    transient.

    `particles` and `samples` are numbers, `every` the collisions per particle between samples.
    """
    rng, (_, _, *dimension_and_inertia) = np.random.default_rng(seed), cooling.constants
    gas = dsmc.new_gas(particles, cooling.theta, rng, *dimension_and_inertia)
    material = dsmc.material(*cooling.constants)
    dsmc.run(gas, material, rng, 1, round(cooling.transient))
    return dsmc.run(gas, material, rng, every, samples)


def event_driven_ratios(
    cooling: FreeCooling, segment: float, length: float, seed: np.random.SeedSequence
) -> np.ndarray:
    """Return the mean R of each replica by event-driven simulation, shape (replicas,).

    The replicas of the gas `cooling` have independent seeds from `seed`. R is the share of
    rotational energy. Equal replicas of at most about `segment` collisions per particle have the
    total length `length`, without the initial smooth elastic gas and the transient.
    """
    replicas = max(1, round(length / segment))
    return np.array(
        [
            _replica_ratio(cooling, length / replicas, replica_seed)
            for replica_seed in seed.spawn(replicas)
        ]
    )


def thermalised_gas(cooling: FreeCooling, seed: np.random.SeedSequence) -> Gas:
    """Return a gas with T_rot/T_tr of theory, at the moment when dissipation is switched on.

    It has the settings of `cooling`. Before, it was simulated with smooth elastic particles, as the
    experiment's `schedule.thermalise` asks.
    """
    scene = build(cooling.experiment, cooling.r, cooling.beta)
    rng = np.random.default_rng(seed)
    gas = Gas.start(scene, cooling.experiment, rng)
    spin, q = gas.state.spin, inertia(scene.effects)
    assert spin is not None and q is not None  # FreeCooling is of particles that spin
    spin[:] = rng.standard_normal(spin.shape) * (cooling.theta / q) ** 0.5
    gas.thermalise(cooling.experiment.schedule.thermalise)
    gas.cool(SAMPLES_PER_REFRESH * gas.count(1.0))
    return gas


def _replica_ratio(cooling, length, seed):
    """Return the mean R of a replica over `length` collisions per particle after the transient."""
    gas, skipped = thermalised_gas(cooling, seed), round(cooling.transient)
    rows = gas.in_collisions(gas.count(1.0), skipped + max(1, round(length)))
    return float(ratio(gas.energies(rows))[skipped:].mean())
