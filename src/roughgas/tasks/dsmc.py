"""Direct simulation Monte Carlo: a homogeneous gas of rough, inelastic disks or spheres.

Its particles have no positions. In Bird's no-time-counter scheme pairs are drawn at random, each
with a random normal n, and collide with the probability |g.n|/majorant, g being the relative
velocity. The collision frequency is that of particles with uniform, independent positions. Each
draw takes the mean time between two draws. G. A. Bird, Molecular Gas Dynamics and the Direct
Simulation of Gas Flows (Oxford, 1994), section 11.1.

Units: particle radius a = particle mass m = time unit T = 1; temperatures as in roughgas.theory.
All compiled code of the solver is in this file and in kernel/: edits there invalidate the cache of
numba.
"""

import math
from typing import NamedTuple

import numpy as np

from roughgas.base import InputError
from roughgas.compiling.jit import compiled, entry, jit
from roughgas.effects import Effects
from roughgas.effects.contacts import Friction, Spin
from roughgas.kernel.contact import impulse_and_spin_change
from roughgas.kernel.mathematics import add_scaled, dot, read, scale, subtract, write
from roughgas.kernel.particles import change_spin, identical_pair, spin_of
from roughgas.theory import arguments, moment_of_inertia

FIRST_MAJORANT = 5.0  # in standard deviations of the relative normal velocity; raised if exceeded
# Entries of HomogeneousGas.clock
TIME, WAITING_TIME, LOG_UNIT, MAJORANT = range(4)
# Entries of HomogeneousGas.counts
COLLISIONS, DRAWS = range(2)
ROW_COLUMNS = ("time", "collisions", "log_unit", "vv", "ww", "vvvv", "wwww", "vvww", "vwvw")


class CollisionModel(NamedTuple):
    """Collision rule and density of the gas."""

    restitution: float
    roughness: float
    effects: Effects  # spin and friction, which depend on the velocities of a contact only
    crowding: float  # number density times Enskog's factor chi, in a^-D


class HomogeneousGas(NamedTuple):
    """State of a simulation; velocities are in units of exp(clock[LOG_UNIT]) a/T."""

    velocity: np.ndarray  # (N, D)
    spin: np.ndarray  # (N, 2 D - 3) surface velocity a w
    clock: np.ndarray  # time, waiting time since then, log of the unit of velocity, majorant
    counts: np.ndarray  # collisions, pairs drawn
    axes: tuple[float, ...]  # D zeros: the compiler needs the dimension as a type


class Samples(NamedTuple):
    """Time series of a gas, arrays (samples,). Cumulants of Maxwellian velocities vanish.

    a20 = D <v^4>/[(D + 2) <v^2>^2] - 1, a02 the same of the spins and their n = 2 D - 3 components,
    a11 = <v^2 w^2>/(<v^2> <w^2>) - 1, alignment = 3 <(v.w)^2>/<v^2 w^2> - 1 (spheres; 0 for disks).
    Such cumulants of rough spheres were published by A. Santos, G. M. Kremer & M. dos Santos (Phys.
    Fluids 23, 030604, 2011), the alignment by N. V. Brilliantov et al. (Phys. Rev. Lett. 98,
    128001, 2007).
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


def material(r, beta, dimension=2, inertia=None, crowding=1.0, mu=None) -> CollisionModel:
    """Return the collision rule of particles with restitution r, roughness beta and `inertia` q.

    q = I/(m a^2) is by default its value for uniform disks or spheres. Contacts slide where they
    would exceed the coefficient of friction `mu`; None: they always stick. `crowding`, number
    density times chi (the pair distribution at contact), in a^-D, sets the unit of time only.
    Raises InputError.
    """
    r, beta, _, q = (
        float(parameter) for parameter in arguments.material(r, beta, dimension, inertia)
    )
    crowding = float(arguments.check("crowding", crowding))
    friction = None if mu is None else Friction(float(arguments.check("friction mu", mu)), q)
    return CollisionModel(r, beta, Effects(spin=Spin(q), friction=friction), crowding)


def new_gas(
    particles, theta, rng: np.random.Generator, dimension=2, inertia=None
) -> HomogeneousGas:
    """Return a gas with Maxwellian velocities, no total momentum, T_tr = 1 and T_rot = theta.

    `particles` is their number, `theta` T_rot/T_tr, `inertia` q = I/(m a^2), by default of uniform
    particles; `rng` draws the velocities. Both temperatures are exact. Raises InputError for fewer
    than two particles or theta < 0.
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
    gas: HomogeneousGas,
    material: CollisionModel,
    rng: np.random.Generator,
    every: float,
    samples: int,
):
    """Return `Samples` of a gas at intervals of `every` collisions per particle; change the gas.

    `material` is the CollisionModel, `samples` the number of samples. The same generator `rng` in
    the same state gives the same bits.
    """
    (number, dimension), spins = gas.velocity.shape, gas.spin.shape[1]
    spin = material.effects.spin
    assert spin is not None  # see `material`
    rows = np.empty((samples, len(ROW_COLUMNS)))
    record(gas, material, rng, max(1, round(every * number / 2)), rows)
    time, collisions, log_unit, vv, ww, vvvv, wwww, vvww, vwvw = rows.T
    T_tr, T_rot = vv / (number * dimension), spin.inertia * ww / (number * spins)
    return Samples(
        time=time,
        collisions_per_particle=2.0 * collisions / number,
        log_T_tr=np.log(T_tr) + 2.0 * log_unit,
        theta=T_rot / T_tr,
        a20=_ratio_or_one(number * dimension * vvvv, (dimension + 2) * vv**2) - 1.0,
        a02=_ratio_or_one(number * spins * wwww, (spins + 2) * ww**2) - 1.0,
        a11=_ratio_or_one(number * vvww, vv * ww) - 1.0,
        alignment=_ratio_or_one(3.0 * vwvw, vvww) - 1.0 if dimension == 3 else np.zeros(samples),
    )


def _ratio_or_one(a, b):
    """Return a/b, (samples,); 1 where b vanishes, as nothing spins."""
    return np.divide(a, b, out=np.ones(len(a)), where=b > 0.0)


@entry(cache=True)
def record(gas, material, rng, collisions, rows):
    """Simulate `collisions` before each sample; fill `rows`, shape (samples, ROW_COLUMNS).

    `collisions` is a total over all particles, `material` the CollisionModel. After each sample,
    and in between after every N collisions of N particles, the total momentum is removed and T_tr
    scaled to 1: otherwise the majorant would become too large for a cooled gas.
    """
    number = len(gas.velocity)
    for k in range(len(rows)):
        target = gas.counts[COLLISIONS] + collisions
        while gas.counts[COLLISIONS] + number < target:
            collide_until(gas, material, rng, gas.counts[COLLISIONS] + number)
            rescale(gas)
        collide_until(gas, material, rng, target)
        take_sample(gas, rows[k])
        rescale(gas)


@compiled
def collide_until(gas, material, rng, target):
    """Draw pairs up to a total of `target` collisions since the start, and advance the time.

    `material` is the CollisionModel.
    """
    while gas.counts[COLLISIONS] < target:
        draw_pair(gas, material, rng)
    clock, number = gas.clock, len(gas.velocity)
    pairs = 0.5 * (number - 1)  # per volume, with the density in `crowding`
    # half the surface of the contact sphere with radius 2 a: a pair approaches on half of it
    cross_section = 2.0 * math.pi if len(gas.axes) == 2 else 8.0 * math.pi
    draws = pairs * material.crowding * cross_section
    clock[TIME] += clock[WAITING_TIME] * math.exp(-clock[LOG_UNIT]) / draws
    clock[WAITING_TIME] = 0.0


@compiled
def draw_pair(gas, material, rng):
    """Draw two particles and the normal of a contact; let them collide with Bird's probability.

    `material` is the CollisionModel. The pair waits the mean time between two draws.
    """
    number, clock = len(gas.velocity), gas.clock
    scaled_number = number * rng.random()
    i = int(scaled_number)
    # the fraction has 53 bits less those of the number of particles: enough for the second particle
    j = int((scaled_number - i) * (number - 1))
    j += j >= i
    v = subtract(read(gas.velocity, i, 0, gas.axes), read(gas.velocity, j, 0, gas.axes))
    gas.counts[DRAWS] += 1
    clock[WAITING_TIME] += 1.0 / clock[MAJORANT]
    threshold = clock[MAJORANT] * rng.random()
    if dot(v, v) <= threshold * threshold:
        return  # no normal makes them collide
    n = random_direction(gas.axes, rng)
    speed = dot(v, n)
    clock[MAJORANT] = max(clock[MAJORANT], abs(speed))
    if abs(speed) > threshold:
        # from particle j to i, while they approach each other
        collide(gas, material, i, j, scale(n, -math.copysign(1.0, speed)), v)


@compiled
def collide(gas, material, i, j, n, v):
    """Change velocities and spins of particles i and j by a contact, as in event-driven runs.

    `material` is the CollisionModel, `n` the normal, a unit vector from j to i, and `v` the
    velocity of i relative to j.
    """
    axes, effects = gas.axes, material.effects
    w_i, w_j = spin_of(gas.spin, axes, i), spin_of(gas.spin, axes, j)
    restitutions = material.restitution, material.roughness
    spin_shares = identical_pair(effects.spin)
    push, turn = impulse_and_spin_change(
        effects, restitutions, n, v, add_scaled(w_i, w_j, 1.0), 0.5, spin_shares
    )
    write(gas.velocity, i, 0, subtract(read(gas.velocity, i, 0, axes), push))
    write(gas.velocity, j, 0, add_scaled(read(gas.velocity, j, 0, axes), push, 1.0))
    change_spin(gas.spin, i, w_i, turn)
    change_spin(gas.spin, j, w_j, turn)
    gas.counts[COLLISIONS] += 1


@compiled
def random_direction(axes, rng):
    """Return a random unit vector (a tuple of D numbers), with all directions equally probable.

    `axes` is a tuple of D zeros.
    """
    while True:
        x = _point_in_cube(axes, rng)
        square = dot(x, x)
        if 0.0 < square <= 1.0:
            return scale(x, 1.0 / math.sqrt(square))


@jit
def _point_in_cube(axes, rng):
    """Return a random point in the cube [-1, 1]^D; `axes` is a tuple of D zeros."""
    return tuple(2.0 * rng.random() - 1.0 for k in range(len(axes)))


@compiled
def take_sample(gas, row):
    """Fill a row (ROW_COLUMNS) with the clock and sums of moments over the particles.

    The gas is not changed.
    """
    row[:] = 0.0
    row[0], row[1], row[2] = gas.clock[TIME], gas.counts[COLLISIONS], gas.clock[LOG_UNIT]
    for i in range(len(gas.velocity)):
        v, w = read(gas.velocity, i, 0, gas.axes), spin_of(gas.spin, gas.axes, i)
        vv, ww, vw = dot(v, v), dot(w, w), _velocity_dot_spin(v, w)
        row[3] += vv
        row[4] += ww
        row[5] += vv * vv
        row[6] += ww * ww
        row[7] += vv * ww
        row[8] += vw * vw


@jit
def _velocity_dot_spin(v, w):
    """Return v.w of a particle with velocity v and spin w, which is 0 for disks."""
    if len(w) == 1:
        return 0.0
    else:
        return dot(v, w)


@compiled
def rescale(gas):
    """Remove the total momentum, a rounding error, and scale velocities and spins to T_tr = 1."""
    square = 0.0
    for component in gas.velocity.T:
        component -= component.mean()
        for speed in component:
            square += speed**2
    factor = math.sqrt(gas.velocity.size / square)
    for vectors in (gas.velocity, gas.spin):
        vectors *= factor
    gas.clock[LOG_UNIT] -= math.log(factor)
