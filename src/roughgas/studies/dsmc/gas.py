"""A homogeneous gas of rough, inelastic disks or spheres, as particles without positions.

Units: particle radius a = particle mass m = time unit T = 1; temperatures as in roughgas.theory.
"""

import math
from typing import NamedTuple

import numpy as np

from roughgas.base.errors import InputError
from roughgas.effects import Effects
from roughgas.effects.spin import Spin
from roughgas.studies.dsmc.collisions import COLUMNS, record
from roughgas.theory import moment_of_inertia
from roughgas.theory.arguments import check, check_restitution, check_roughness

FIRST_MAJORANT = 5.0  # standard deviations of the relative normal velocity; it rises where exceeded


class Material(NamedTuple):
    """What the particles are, and how close to each other."""

    restitution: float
    roughness: float
    effects: Effects  # only those that a contact's velocities decide on: spin
    crowding: float  # number density times Enskog's factor chi, in a^-D


class Gas(NamedTuple):
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


def material(r, beta, dimension=2, inertia=None, crowding=1.0) -> Material:
    """Particles of restitution r and roughness beta; `inertia` q is that of uniform ones if None.

    `crowding`, number density times chi, sets the unit of time only. Raises InputError.
    """
    spin = Spin(float(moment_of_inertia(dimension) if inertia is None else inertia))
    crowding = float(check("crowding", crowding))
    r, beta = float(check_restitution(r)), float(check_roughness(beta))
    return Material(r, beta, Effects(spin=spin), crowding)


def new_gas(particles, theta, rng: np.random.Generator, dimension=2, inertia=None) -> Gas:
    """`particles` of Maxwellian velocities without total momentum, T_tr = 1 and T_rot = theta.

    Both temperatures are exact. Raises InputError for fewer than two particles or theta < 0.
    """
    if particles < 2:
        raise InputError("particles", particles, "be at least 2")
    q = moment_of_inertia(dimension) if inertia is None else inertia
    velocity = rng.standard_normal((particles, dimension))
    velocity -= velocity.mean(axis=0)
    velocity /= math.sqrt(np.mean(velocity**2))
    spin = rng.standard_normal((particles, 2 * dimension - 3))
    spin *= math.sqrt(check("theta", theta) / (q * np.mean(spin**2)))
    clock = np.array([0.0, 0.0, 0.0, FIRST_MAJORANT * math.sqrt(2.0)])
    return Gas(velocity, spin, clock, np.zeros(2, np.int64), (0.0,) * dimension)


def run(gas: Gas, material: Material, rng: np.random.Generator, every: float, samples: int):
    """The `Samples` of a gas, one every so many collisions per particle; the gas is changed.

    The same generator in the same state gives the same bits.
    """
    number, dimension = gas.velocity.shape
    rows = np.empty((samples, len(COLUMNS)))
    record(gas, material, rng, max(1, round(every * number / 2)), rows)
    sums = dict(zip(COLUMNS, rows.T, strict=True))
    return _samples(sums, number, dimension, material.effects.spin.inertia)


def _samples(sums, number, dimension, inertia):
    spins = 2 * dimension - 3
    T_tr, T_rot = sums["vv"] / (number * dimension), inertia * sums["ww"] / (number * spins)
    return Samples(
        time=sums["time"],
        collisions_per_particle=2.0 * sums["collisions"] / number,
        log_T_tr=np.log(T_tr) + 2.0 * sums["log_unit"],
        theta=T_rot / T_tr,
        a20=_quotient(number * dimension * sums["vvvv"], (dimension + 2) * sums["vv"] ** 2) - 1.0,
        a02=_quotient(number * spins * sums["wwww"], (spins + 2) * sums["ww"] ** 2) - 1.0,
        a11=_quotient(number * sums["vvww"], sums["vv"] * sums["ww"]) - 1.0,
        alignment=_quotient(3.0 * sums["vwvw"], sums["vvww"]) - 1.0
        if dimension == 3
        else np.zeros(len(T_tr)),
    )


def _quotient(a, b):
    """a/b; 1 where nothing spins."""
    return np.divide(a, b, out=np.ones(len(a)), where=b > 0.0)
