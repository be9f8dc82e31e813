"""A homogeneous gas of rough, inelastic disks or spheres, as particles without positions.

Units: particle radius a = particle mass m = time unit T = 1; temperatures as in roughgas.theory.
"""

import math
from typing import NamedTuple

import numpy as np

from roughgas.base import InputError
from roughgas.effects import Effects
from roughgas.effects.friction import Friction
from roughgas.effects.spin import Spin
from roughgas.studies.dsmc.collisions import COLUMNS, record
from roughgas.theory import arguments, moment_of_inertia

FIRST_MAJORANT = 5.0  # standard deviations of the relative normal velocity; it rises where exceeded


class Colliding(NamedTuple):
    """What the particles are, and how close to each other."""

    restitution: float
    roughness: float
    effects: Effects  # only those that a contact's velocities decide on: spin and friction
    crowding: float  # number density times Enskog's factor chi, in a^-D


class HomogeneousGas(NamedTuple):
    """Everything that a simulation changes; velocities in units of exp(clock[LOG_UNIT]) a/T."""

    velocity: np.ndarray  # (N, D)
    spin: np.ndarray  # (N, 2 D - 3) surface velocity a w
    clock: np.ndarray  # time, time since then, the logarithm of the unit of velocity, majorant
    counts: np.ndarray  # collisions, pairs drawn
    axes: tuple[float, ...]  # D zeros: their number is the dimension that is compiled for


class Samples(NamedTuple):
    """A gas over time, arrays (samples,). The cumulants vanish where velocities are Maxwellian.

    a20 = D <v^4>/[(D + 2) <v^2>^2] - 1, a02 the same of the spins and their n = 2 D - 3 components,
    a11 = <v^2 w^2>/(<v^2> <w^2>) - 1, alignment = 3 <(v.w)^2>/<v^2 w^2> - 1 (spheres; 0 for disks).
    Of rough spheres A. Santos, G. M. Kremer & M. dos Santos (Phys. Fluids 23, 030604, 2011) give
    such cumulants, and N. V. Brilliantov et al. (Phys. Rev. Lett. 98, 128001, 2007) the alignment.
    """

    time: np.ndarray  # T
    collisions_per_particle: np.ndarray
    log_T_tr: np.ndarray  # natural logarithm: a cooling gas falls below the smallest number
    theta: np.ndarray  # T_rot/T_tr
    a20: np.ndarray
    a02: np.ndarray
    a11: np.ndarray
    alignment: np.ndarray

    @property
    def R(self) -> np.ndarray:
        """Share of rotation in the energy, E_rot/(E_rot + E_tr)."""
        return self.theta / (1.0 + self.theta)


def material(r, beta, dimension=2, inertia=None, crowding=1.0, mu=None) -> Colliding:
    """Return particles of restitution r, roughness beta and `inertia` q, by default uniform ones.

    Contacts slide where they would exceed the coefficient of friction `mu`; None: they always
    stick. `crowding`, number density times chi, sets the unit of time only. Raises InputError.
    """
    r, beta, _, q = (float(one) for one in arguments.material(r, beta, dimension, inertia))
    crowding = float(arguments.check("crowding", crowding))
    friction = None if mu is None else Friction(float(arguments.check("friction mu", mu)), q)
    return Colliding(r, beta, Effects(spin=Spin(q), friction=friction), crowding)


def new_gas(
    particles, theta, rng: np.random.Generator, dimension=2, inertia=None
) -> HomogeneousGas:
    """Return particles of Maxwellian velocities without total momentum, T_tr = 1, T_rot = theta.

    Both temperatures are exact. Raises InputError for fewer than two particles or theta < 0.
    """
    if particles < 2:
        raise InputError("particles", particles, "be at least 2")
    q = moment_of_inertia(dimension) if inertia is None else inertia
    velocity = rng.standard_normal((particles, dimension))
    velocity -= velocity.mean(axis=0)
    velocity /= math.sqrt(np.mean(velocity**2))
    spin = rng.standard_normal((particles, 2 * dimension - 3))
    spin *= math.sqrt(arguments.check("theta", theta) / (q * np.mean(spin**2)))
    clock = np.array([0.0, 0.0, 0.0, FIRST_MAJORANT * math.sqrt(2.0)])
    return HomogeneousGas(velocity, spin, clock, np.zeros(2, np.int64), (0.0,) * dimension)


def run(
    gas: HomogeneousGas, material: Colliding, rng: np.random.Generator, every: float, samples: int
):
    """Return the `Samples` of a gas, one every `every` collisions per particle; change the gas.

    The same generator in the same state gives the same bits.
    """
    (number, dimension), spins = gas.velocity.shape, gas.spin.shape[1]
    spin = material.effects.spin
    assert spin is not None  # see `material`
    rows = np.empty((samples, len(COLUMNS)))
    record(gas, material, rng, max(1, round(every * number / 2)), rows)
    time, collisions, log_unit, vv, ww, vvvv, wwww, vvww, vwvw = rows.T
    T_tr, T_rot = vv / (number * dimension), spin.inertia * ww / (number * spins)
    return Samples(
        time=time,
        collisions_per_particle=2.0 * collisions / number,
        log_T_tr=np.log(T_tr) + 2.0 * log_unit,
        theta=T_rot / T_tr,
        a20=_quotient(number * dimension * vvvv, (dimension + 2) * vv**2) - 1.0,
        a02=_quotient(number * spins * wwww, (spins + 2) * ww**2) - 1.0,
        a11=_quotient(number * vvww, vv * ww) - 1.0,
        alignment=_quotient(3.0 * vwvw, vvww) - 1.0 if dimension == 3 else np.zeros(samples),
    )


def _quotient(a, b):
    """Return a/b; 1 where nothing spins."""
    return np.divide(a, b, out=np.ones(len(a)), where=b > 0.0)
