"""Direct simulation Monte Carlo of a homogeneous gas that white noise drives.

Collisions are those of roughgas.tasks.dsmc. All particles are kicked together, at times a step
apart, by Gaussian numbers; samples are taken in the middle between two kicks, so that the error of
a finite step is of second order (G. Strang, SIAM J. Numer. Anal. 5, 506 (1968)). Kicks conserve the
total momentum, which is zero, and supply on average exactly the prescribed power.

Units: particle radius a = particle mass m = time unit T = 1.
"""

import math
from typing import NamedTuple

import numpy as np

from roughgas import theory
from roughgas.base import InputError
from roughgas.compiling.jit import compiled, entry
from roughgas.tasks.dsmc import (
    COLLISIONS,
    MAJORANT,
    ROW_COLUMNS,
    WAITING_TIME,
    CollisionModel,
    HomogeneousGas,
    draw_pair,
    material,
    take_sample,
)

UNIT_CROWDING = 0.25 / math.sqrt(math.pi)
"""Density of disks, times chi, at which a particle collides once per T at the temperature 1."""
SUMS = 3  # index of the first sum over particles in a row of dsmc.take_sample


class WhiteNoise(NamedTuple):
    """Drive of a homogeneous gas."""

    velocity: float  # standard deviation of the kick to each component of a velocity, a/T
    spin: float  # the same of a spin, as surface velocity
    interval: float  # time between two kicks of a particle, T


class StationaryTemperatures(NamedTuple):
    """Temperatures of a gas of N particles in D dimensions, averaged over samples.

    T_tr has D (N - 1) degrees of freedom, since the total momentum vanishes, T_rot (2 D - 3) N. R =
    T_rot/(T_tr + T_rot) is of these means. `collisions` are per particle.
    """

    T_tr: float
    T_rot: float
    collisions: float

    @property
    def R(self) -> float:
        """Share of rotation in the energy per degree of freedom."""
        return self.T_rot / (self.T_tr + self.T_rot)


def disks_at_unit_temperature(
    r: float, beta: float, spin_share: float, interval: float
) -> tuple[CollisionModel, WhiteNoise, float]:
    """Return material and drive of disks, and theta = T_rot/T_tr, by the rate equations.

    Normal restitution r, roughness beta; `spin_share` of the power goes into spins. By these
    equations T_tr is 1, and a particle collides once per T; `interval` is the time between two
    kicks in T. Raises InputError.
    """
    theta = float(theory.stationary_theta(r, beta, spin_share=spin_share))
    changes = theory.temperature_changes(1.0, theta, r, beta, frequency=1.0)
    power = -float(changes[0] + 0.5 * changes[1])  # of a disk, whose energy is T_tr + T_rot/2
    inertia = theory.moment_of_inertia(2)
    kicks = (
        math.sqrt(power * (1.0 - spin_share) * interval),
        math.sqrt(2.0 * power * spin_share * interval / inertia),
    )
    return material(r, beta, crowding=UNIT_CROWDING), WhiteNoise(*kicks, interval), theta


def run(
    gas: HomogeneousGas,
    model: CollisionModel,
    noise: WhiteNoise,
    rng: np.random.Generator,
    steps: int,
    every: int = 1,
) -> StationaryTemperatures:
    """Return temperatures averaged over `steps` steps of the drive; change the gas.

    A sample is taken after every `every` steps. `model` is the material, a step has the length
    noise.interval. The same generator `rng` in the same state gives the same bits. Raises
    InputError for fewer steps than one sample needs.
    """
    if not 1 <= every <= steps:
        raise InputError("steps", steps, f"be at least {every}")
    number, dimension = gas.velocity.shape
    spins, spin = gas.spin.shape[1], model.effects.spin
    assert spin is not None  # see dsmc.material
    before = gas.counts[COLLISIONS]
    rows = np.empty((steps // every, len(ROW_COLUMNS)))
    drive(gas, model, noise, rng, every, rows)
    vv, ww = rows[:, SUMS : SUMS + 2].T
    return StationaryTemperatures(
        T_tr=float(vv.mean()) / (dimension * (number - 1)),
        T_rot=spin.inertia * float(ww.mean()) / (number * spins),
        collisions=2.0 * float(gas.counts[COLLISIONS] - before) / number,
    )


@entry(cache=True)
def drive(gas, model, noise, rng, every, rows):
    """Advance the gas by `every` steps of the drive before each sample; fill `rows`.

    `rows` has the shape (samples, dsmc.ROW_COLUMNS), `model` is the CollisionModel.
    """
    for k in range(len(rows)):
        for _ in range(every):
            collide_for(gas, model, rng, 0.5 * noise.interval)
            kick(gas.velocity, noise.velocity, rng, True)
            kick(gas.spin, noise.spin, rng, False)
            collide_for(gas, model, rng, 0.5 * noise.interval)
        take_sample(gas, rows[k])


@compiled
def collide_for(gas, model, rng, duration):
    """Draw pairs for a time `duration` (T); the waiting time beyond it counts for the next call.

    `model` is the CollisionModel; the unit of velocity is a/T.
    """
    number, clock = len(gas.velocity), gas.clock
    # half the surface of the contact sphere with radius 2 a, for each pair
    cross_section = 2.0 * math.pi if len(gas.axes) == 2 else 8.0 * math.pi
    end = duration * 0.5 * (number - 1) * model.crowding * cross_section
    while clock[WAITING_TIME] + 1.0 / clock[MAJORANT] <= end:
        draw_pair(gas, model, rng)
    clock[WAITING_TIME] -= end


@compiled
def kick(vectors, size, rng, conserves_mean):
    """Add Gaussian numbers of standard deviation `size` to all components of vectors, (N, ...).

    With `conserves_mean` the mean kick is subtracted, and kicks are larger by sqrt(N/(N - 1)),
    which keeps their mean energy per particle.
    """
    number = len(vectors)
    factor = size * math.sqrt(number / (number - 1.0)) if conserves_mean else size
    for axis in range(vectors.shape[1]):
        total = 0.0
        for i in range(number):
            change = factor * rng.standard_normal()
            vectors[i, axis] += change
            total += change
        if conserves_mean:
            for i in range(number):
                vectors[i, axis] -= total / number
