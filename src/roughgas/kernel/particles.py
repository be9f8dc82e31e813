"""Particles: where they are among periodic images, what bodies they have, how they spin and fly.

Periodic images: an axis of the box has a length, or is None and open.

Under Lees-Edwards shear (`slide` = (offset, velocity), else None) the images above are displaced
by the offset along the first axis and move with the velocity along it: the offset holds at the
clock's base (hooks.sliding) or, after `slid`, at the time in question.

What particles are where they differ; where they are alike, radius and mass are 1, at no cost.

The kernel's functions take State.bodies, which is None in a gas of one species. What they compute
for particles that happen to be alike has the same bits as without them: of two equal numbers x,
x/(x + x) is 1/2 exactly. All that belongs to a pair is symmetric in the two, to the last bit.

Spins of the particles, as surface velocities a w; in a scene without spin all of this is None.

A spin has one component in the plane, three in space.

Free flight between events, with or without gravity.
"""

from typing import NamedTuple

import numpy as np

from roughgas.kernel import hooks
from roughgas.kernel.hooks import either, unless_absent
from roughgas.kernel.jit import is_single, jit, overload, unrolled
from roughgas.kernel.mathematics import multiply_add
from roughgas.kernel.vectors import (
    add_scaled,
    divide,
    dot,
    read,
    scale,
    subtract,
    subtract_last,
    write,
)

FIRST_LARGE_32 = np.float32(1.5 * 2.0**23)
FIRST_LARGE_64 = 1.5 * 2.0**52


def periods(x, length):
    """Return x/length rounded to the nearest integer, ties to even; exact to 2^22 (2^51 in double).

    Adding and subtracting a number whose spacing is 1 rounds in two additions, which every x86-64
    machine has in vector form and which give the same bits on all of them.
    """
    large = FIRST_LARGE_32 if isinstance(x, np.float32) else FIRST_LARGE_64
    return multiply_add(x, type(x)(1) / length, large) - large


@overload(periods)
def _compiled_periods(x, length):
    large = FIRST_LARGE_32 if is_single(length) else FIRST_LARGE_64
    one = type(large)(1.0)
    # a loop over many divides once and multiplies
    return lambda x, length: multiply_add(x, one / length, large) - large


@unless_absent
def slid(slide, time):
    """Return the slide as it is at `time` after the clock's base."""
    return slide[0] + slide[1] * time, slide[1]


@jit
def _axis_number(x, length):
    if length is None:
        return x  # not used: an open axis has one image
    return periods(x, length)


@jit
def _axis_shift(x, number, length):
    if length is None:
        return x
    return multiply_add(-number, length, x)


@unrolled
def _numbers(x, box):
    return tuple(_axis_number(x[k], box[k]) for k in range(len(box)))


@unrolled
def _shift(x, numbers, box):
    return tuple(_axis_shift(x[k], numbers[k], box[k]) for k in range(len(box)))


@jit
def image_numbers(x, box, slide):
    """Return which periodic image brings the separation x closest to zero, in periods per axis."""
    numbers = _numbers(x, box)
    if slide is None:
        return numbers
    along = multiply_add(-numbers[1], slide[0], x[0])
    return (_axis_number(along, box[0]),) + numbers[1:]


@jit
def shifted(x, u, numbers, box, slide):
    """Return separation and relative velocity as that image has them."""
    moved = _shift(x, numbers, box)
    if slide is None:
        return moved, u
    return (
        (multiply_add(-numbers[1], slide[0], moved[0]),) + moved[1:],
        (multiply_add(-numbers[1], slide[1], u[0]),) + u[1:],
    )


@jit
def fold_into_box(position, velocity, box, slide):
    """Return the image of a particle in the box, whose periodic axes reach from 0 to L."""
    centred = _shift(position, _halves(position), box)
    return shifted(position, velocity, image_numbers(centred, box, slide), box, slide)


@unrolled
def _halves(like):
    return tuple(0.5 for k in range(len(like)))


@jit
def speed_limit(box, half, reach):
    """Return the square of the relative speed below which no second image is met within +-`half`.

    None where no axis is periodic. It has some room for rounding. `reach` is the distance of a pair
    in contact, or of any; None stands for 2.
    """
    return _limit(_lengths(box), half, _roomy(reach))


_roomy = either(lambda reach: 1.0005 * reach, lambda reach: 2.001)


@unrolled
def _lengths(box):
    return tuple(box[k] for k in range(len(box)) if box[k] is not None)


@unrolled
def _limit(lengths, half, reach):
    if len(lengths) == 0:
        return None
    else:
        shortest = lengths[0]
        for k in range(1, len(lengths)):
            shortest = min(shortest, lengths[k])
        speed = (0.5 * shortest - reach) / half
        return speed * speed


@unrolled
def exceeds(squared, limit):
    """Return whether the square of a relative speed is above a speed limit; NaN is not."""
    if limit is None:
        return False
    else:
        return squared > limit


class Pair(NamedTuple):
    """What decides what a contact does, of two particles or of one with a wall.

    s = m q is a particle's moment of inertia over a^2. The tangential impulse P moves the surfaces
    of a pair past each other by P (1/m_i + 1/s_i + 1/m_j + 1/s_j), and turns i by P/s_i.
    """

    mass: float  # twice the reduced mass; at a wall that of the particle
    inertia: float  # mean q, each weighted with the share of the turning that the particle takes
    bulk: float  # twice the reduced s; at a wall that of the particle
    gives: tuple[float, float]  # twice these shares
    mu: float  # coefficient of friction; NaN without friction


radius_of = either(lambda bodies, i: bodies.radius[i], lambda bodies, i: 1.0)
mass_of = either(lambda bodies, i: bodies.mass[i], lambda bodies, i: 1.0)

reach_of = unless_absent(lambda bodies, i, j: bodies.radius[i] + bodies.radius[j])
"""(bodies, i, j) -> the distance at which a pair touches; None stands for 2."""

widest_of = unless_absent(lambda bodies: 2.0 * bodies.largest[0])
"""(bodies) -> the largest distance at which any pair touches; None stands for 2."""

spin_mass_of = either(
    lambda bodies, spin, i: bodies.mass[i] * bodies.inertia[i], lambda bodies, spin, i: spin.inertia
)
"""(bodies, spin, i) -> s of a particle, which its energy of rotation is s (a w)^2/2 with."""

change_of_velocity = either(  # a product with 1/m would be rounded to the same side each time
    lambda bodies, i, push: divide(push, bodies.mass[i]), lambda bodies, i, push: push
)
"""(bodies, i, push) -> what an impulse changes the particle's velocity by."""

material_of = either(
    lambda bodies, scene, i, j: _of_species(bodies, scene, i, j),
    lambda bodies, scene, i, j: (scene.restitution, scene.roughness),
)
"""(bodies, scene, i, j) -> (r, beta) of a pair's contacts."""


@jit
def _of_species(bodies, scene, i, j):
    if scene.effects.species.alike:
        return scene.restitution, scene.roughness
    of_one, of_other = bodies.species[i], bodies.species[j]
    return bodies.pairs[of_one, of_other, 0], bodies.pairs[of_one, of_other, 1]


@unless_absent
def pair_of(bodies, i, j):
    """Return the Pair of two particles."""
    m_i, m_j = bodies.mass[i], bodies.mass[j]
    q_i, q_j = bodies.inertia[i], bodies.inertia[j]
    s_i, s_j = m_i * q_i, m_j * q_j
    share_i, share_j = s_j / (s_i + s_j), s_i / (s_i + s_j)
    return Pair(
        2.0 * m_i * m_j / (m_i + m_j),
        share_i * q_i + share_j * q_j,
        share_i * s_i + share_j * s_j,
        (2.0 * share_i, 2.0 * share_j),
        bodies.pairs[bodies.species[i], bodies.species[j], 2],
    )


@unless_absent
def pair_with_wall(bodies, i):
    """Return the Pair of a particle and a wall."""
    m, q = bodies.mass[i], bodies.inertia[i]
    return Pair(m, q, m * q, (1.0, 0.0), bodies.pairs[bodies.species[i], -1, 2])


mass_in = either(lambda pair: pair.mass, lambda pair: 1.0)
inertia_in = either(lambda pair, spin: pair.inertia, lambda pair, spin: spin.inertia)
bulk_in = either(lambda pair, spin: pair.bulk, lambda pair, spin: spin.inertia)


@unless_absent
def turn_of(turn, pair, k):
    """Return what the spin of a contact's partner (0 or 1) is changed by; turn is the mean."""
    return _given(pair, turn, k)


_given = either(lambda pair, turn, k: scale(turn, pair.gives[k]), lambda pair, turn, k: turn)


@unrolled
def spin_of(spin, box, i):
    """Return the spin of particle i."""
    if spin is None:
        return None
    else:
        return tuple(spin[i, k] for k in range(2 * len(box) - 3))


@unless_absent
def spin_sum(a, b):
    """Return the sum of two spins, which the contact velocity depends on."""
    return add_scaled(a, b, 1.0)


@unless_absent
def turn_spin(spin, i, before, turn):
    """Store particle i's spin after a contact."""
    write(spin, i, 0, add_scaled(before, turn, 1.0))


@unless_absent
def book_spin(before, turn, effect, bodies, i, account):
    """Enter the rotational energy gained, m q [w.dw + dw.dw/2], in an account of the ledger."""
    gained = dot(before, turn) + 0.5 * dot(turn, turn)
    account[1] += spin_mass_of(bodies, effect, i) * gained


@unrolled
def fallen(position, velocity, elapsed, gravity):
    """Return position and velocity after `elapsed`, falling along the last axis under gravity."""
    moved = add_scaled(position, velocity, elapsed)
    if gravity is None:
        return moved, velocity
    else:
        drop = 0.5 * gravity * elapsed * elapsed
        fall = gravity * elapsed
        return subtract_last(moved, drop), subtract_last(velocity, fall)


@jit
def path_of(trajectory, i, box):
    """Return particle i's path: position, velocity, and the time at which they hold."""
    return (
        read(trajectory, i, 0, box),
        read(trajectory, i, len(box), box),
        trajectory[i, 2 * len(box)],
    )


@jit
def along(path, time, gravity):
    """Return position and velocity at `time` on a path."""
    return fallen(path[0], path[1], time - path[2], gravity)


@jit
def position_and_velocity(state, scene, i, time):
    """Return position and velocity of particle i at `time`, on the continuation of its path."""
    path = path_of(state.trajectory, i, scene.box)
    return along(path, time, hooks.acceleration(scene.effects, None))


@jit
def position_in_box(state, scene, i, time):
    """Return position and velocity of particle i's image in the box at `time`."""
    position, velocity = position_and_velocity(state, scene, i, time)
    slide = hooks.sliding(scene.effects, None, state)
    return fold_into_box(position, velocity, scene.box, slid(slide, time))


@jit
def enter_box(state, scene, i, time):
    """Do as `position_in_box`, and book the energy that particle i gains as another image."""
    _, before = position_and_velocity(state, scene, i, time)
    position, velocity = position_in_box(state, scene, i, time)
    gained = subtract(velocity, before)
    work = dot(gained, add_scaled(before, gained, 0.5))
    hooks.transfer(scene.effects, None, state, mass_of(state.bodies, i) * work)
    return position, velocity


@jit
def set_path(state, scene, i, position, velocity, time):
    """Store particle i's trajectory."""
    write(state.trajectory, i, 0, position)
    write(state.trajectory, i, len(scene.box), velocity)
    state.trajectory[i, 2 * len(scene.box)] = time
