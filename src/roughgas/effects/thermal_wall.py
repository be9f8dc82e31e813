"""Thermal walls: particles leave them as if they came from a gas at the wall's temperature.

Whatever a particle brings along, it leaves with the velocity and the spin of one that flies through
a plane in a Maxwellian gas: the component into the gas has the density v exp(-m v^2/(2 T)), all
others are Gaussian with the variance T/m, those of a w with T/(m q). The wall may move along
itself; that is then the mean velocity of what leaves.
"""

import math
from typing import NamedTuple

from roughgas.effects.plane import Place, normal_axis, predict
from roughgas.effects.settings import register
from roughgas.kernel import hooks
from roughgas.kernel.hooks import unless_absent
from roughgas.kernel.jit import jit, unrolled
from roughgas.kernel.mathematics import gaussian_vector, logarithm, uniform
from roughgas.kernel.particles import (
    book_spin,
    enter_box,
    mass_of,
    set_path,
    spin_mass_of,
    spin_of,
    turn_spin,
)
from roughgas.kernel.state import BOUNDARY_HITS, NOBODY
from roughgas.kernel.vectors import add_scaled, along_axis, dot, subtract


class ThermalWall(NamedTuple):
    """A wall that particles leave with Maxwellian velocities and spins."""

    place: Place
    temperature: float  # m a^2/T^2
    velocity: float  # along itself, in a/T

    axis = normal_axis


def make(place, settings, around):
    """Return the thermal wall that the settings describe."""
    return ThermalWall(place, settings["temperature"], settings["velocity"])


@jit
def resolve(wall, index, what, state, scene, i, time):
    place, mass = wall.place, mass_of(state.bodies, i)
    position, before = enter_box(state, scene, i, time)
    thermal = math.sqrt(wall.temperature / mass)
    outwards = place.inwards * thermal * math.sqrt(-2.0 * logarithm(1.0 - uniform(state.random)))
    random = gaussian_vector(state.random, before, thermal)
    after = _with_normal(random, place.axis, outwards)
    after = add_scaled(after, along_axis(scene.box, place.along, wall.velocity), 1.0)
    set_path(state, scene, i, position, after, time)
    gained = 0.5 * dot(subtract(after, before), add_scaled(before, after, 1.0))
    state.ledger[0, index, 0] += mass * gained
    _spin_anew(state.spin, wall, index, state, scene, i)
    state.changes[i] += 1
    hooks.after_contact(scene.effects, None, state, i, time)
    state.counts[BOUNDARY_HITS] += 1
    return NOBODY


@unrolled
def _with_normal(velocity, axis, normal):
    return tuple(normal if k == axis else velocity[k] for k in range(len(velocity)))


@unless_absent
def _spin_anew(spin, wall, index, state, scene, i):
    before = spin_of(spin, scene.box, i)
    deviation = math.sqrt(wall.temperature / spin_mass_of(state.bodies, scene.effects.spin, i))
    turn = subtract(gaussian_vector(state.random, before, deviation), before)
    turn_spin(spin, i, before, turn)
    book_spin(before, turn, scene.effects.spin, state.bodies, i, state.ledger[0, index])


register(ThermalWall, predict=predict, resolve=resolve, random=True, drives=True, closes=True)
