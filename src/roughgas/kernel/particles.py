"""Particles: where they are among periodic images, what bodies they have, how they spin and fly.

Periodic images: an axis of the box has a length, or is None and open. Under Lees-Edwards shear
(`slide` = (offset, velocity), else None) the images above are displaced by the offset along the
first axis and move with the velocity along it: the offset holds at the clock's base (hooks.sliding)
or, after `slid`, at the time in question.

Bodies: State.bodies is None in a gas of one species, whose radius and mass are 1, at no cost. What
is computed for particles that happen to be alike has the same bits as without them: of two equal
numbers x, x/(x + x) is 1/2 exactly. All that belongs to a pair is symmetric in the two, to the last
bit.

Spins are surface velocities a w, of one component in the plane and three in space; in a scene
without spin they are None.
"""

from typing import Any, NamedTuple

import numpy as np

from roughgas.compiling.jit import jit
from roughgas.compiling.lanes import is_single, multiply_add
from roughgas.kernel import hooks
from roughgas.kernel.hooks import present
from roughgas.kernel.mathematics import add_scaled, dot, read, subtract, write

FIRST_LARGE_32, ONE_32 = np.float32(1.5 * 2.0**23), np.float32(1.0)
FIRST_LARGE_64 = 1.5 * 2.0**52


@jit
def periods(x, length):
    """Return x/length rounded to the nearest integer, ties to even; exact to 2^22 (2^51 in double).

    Adding and subtracting a number whose spacing is 1 rounds in two additions, which every x86-64
    machine has in vector form and which give the same bits on all of them. A loop over many divides
    once and multiplies.
    """
    large = FIRST_LARGE_32 if is_single(length) else FIRST_LARGE_64
    one = ONE_32 if is_single(length) else 1.0
    return multiply_add(x, one / length, large) - large


@jit
def slid(slide, time):
    """Return the slide as it is at `time` after the clock's base."""
    return None if slide is None else (slide[0] + slide[1] * time, slide[1])


@jit
def image_numbers(x, box, slide):
    """Return which periodic image brings the separation x closest to zero, in periods per axis.

    That of an open axis, which has one image, is not used.
    """
    numbers = tuple(x[k] if box[k] is None else periods(x[k], box[k]) for k in range(len(box)))
    if slide is None:
        return numbers
    along = multiply_add(-numbers[1], slide[0], x[0])
    return (periods(along, box[0]),) + numbers[1:]


@jit
def _shift(x, numbers, box):
    return tuple(
        x[k] if box[k] is None else multiply_add(-numbers[k], box[k], x[k]) for k in range(len(box))
    )


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
    return shifted(position, velocity, _image_in_box(position, box, slide), box, slide)


@jit
def _image_in_box(position, box, slide):
    centred = _shift(position, tuple(0.5 for k in range(len(position))), box)
    return image_numbers(centred, box, slide)


@jit
def periods_outside(position, box, slide):
    """Return the periods of each axis by which `fold_into_box` moves a position; 0 if open."""
    numbers = _image_in_box(position, box, slide)
    return tuple(0.0 if box[k] is None else numbers[k] for k in range(len(position)))


@jit
def speed_limit(box, half, reach):
    """Return the square of the relative speed below which no second image is met within +-`half`.

    None where no axis is periodic. It has some room for rounding. `reach` is the distance of a pair
    in contact, or of any.
    """
    lengths = tuple(box[k] for k in range(len(box)) if box[k] is not None)
    if len(lengths) == 0:
        return None
    shortest = lengths[0]
    for k in range(1, len(lengths)):
        shortest = min(shortest, lengths[k])
    speed = (0.5 * shortest - 1.0005 * reach) / half
    return speed * speed


class Pair(NamedTuple):
    """What decides what a contact does, of two particles or of one with a wall.

    s = m q is a particle's moment of inertia over a^2. The tangential impulse P moves the surfaces
    of a pair past each other by P (1/m_i + 1/s_i + 1/m_j + 1/s_j), and turns i by P/s_i.
    """

    mass: float  # twice the reduced mass; at a wall that of the particle
    inertia: float  # mean q, each weighted with the share of the turning that the particle takes
    bulk: float  # twice the reduced s; at a wall that of the particle
    gives: tuple[float, float]  # twice these shares
    mu: Any  # coefficient of friction; None where particles are alike, NaN without friction


@jit
def alike(spin):
    """Return the Pair of particles that are alike; `spin` is the effect, or None."""
    q = 0.0 if spin is None else spin.inertia
    return Pair(1.0, q, q, (1.0, 1.0), None)


@jit
def pair_of(bodies, spin, i, j):
    """Return the Pair of two particles."""
    if bodies is None:
        return alike(spin)
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


@jit
def pair_with_wall(bodies, spin, i):
    """Return the Pair of a particle and a wall."""
    if bodies is None:
        return alike(spin)
    m, q = bodies.mass[i], bodies.inertia[i]
    return Pair(m, q, m * q, (1.0, 0.0), bodies.pairs[bodies.species[i], -1, 2])


@jit
def radius_of(bodies, i):
    """Return the radius of a particle."""
    return 1.0 if bodies is None else bodies.radius[i]


@jit
def largest_of(bodies):
    """Return the largest radius."""
    return 1.0 if bodies is None else bodies.largest[0]


@jit
def reach_of(bodies, i, j):
    """Return the distance at which a pair touches."""
    return radius_of(bodies, i) + radius_of(bodies, j)


@jit
def mass_of(bodies, i):
    """Return the mass of a particle."""
    return 1.0 if bodies is None else bodies.mass[i]


@jit
def spin_mass_of(bodies, spin, i):
    """Return s of a particle: s (a w)^2/2 is its energy of rotation; `spin` is the effect."""
    return spin.inertia if bodies is None else bodies.mass[i] * bodies.inertia[i]


@jit
def material_of(bodies, scene, i, j):
    """Return (r, beta) of a pair's contacts."""
    if bodies is None or scene.effects.species.alike:
        return scene.restitution, scene.roughness
    of_one, of_other = bodies.species[i], bodies.species[j]
    return bodies.pairs[of_one, of_other, 0], bodies.pairs[of_one, of_other, 1]


@jit
def spin_of(spin, box, i):
    """Return the spin of particle i."""
    return None if spin is None else tuple(spin[i, k] for k in range(2 * len(box) - 3))


@jit
def turn_spin(spin, i, before, turn):
    """Let particle i's spin change by `turn`."""
    write(spin, i, 0, add_scaled(before, turn, 1.0))


@jit
def turn_and_book(state, scene, i, before, turn, account):
    """Let particle i's spin change by `turn`, and enter the rotational energy gained,
    m q [w.dw + dw.dw/2], in an account of the ledger."""
    turn_spin(state.spin, i, before, turn)
    gained = dot(before, turn) + 0.5 * dot(turn, turn)
    account[1] += spin_mass_of(state.bodies, scene.effects.spin, i) * gained


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
    """Return position and velocity at `time` on a path; gravity pulls down the last axis."""
    position, velocity, elapsed = path[0], path[1], time - path[2]
    moved = add_scaled(position, velocity, elapsed)
    if gravity is None:
        return moved, velocity
    drop, fall, last = 0.5 * gravity * elapsed * elapsed, gravity * elapsed, len(position) - 1
    return (
        tuple(moved[k] - drop if k == last else moved[k] for k in range(len(position))),
        tuple(velocity[k] - fall if k == last else velocity[k] for k in range(len(position))),
    )


@jit
def position_and_velocity(state, scene, i, time):
    """Return position and velocity of particle i at `time`, on the continuation of its path."""
    path = path_of(state.trajectory, i, scene.box)
    return along(path, time, hooks.acceleration(scene.effects))


@jit
def position_in_box(state, scene, i, time):
    """Return position and velocity of particle i's image in the box at `time`."""
    position, velocity = position_and_velocity(state, scene, i, time)
    slide = hooks.sliding(scene.effects, state)
    return fold_into_box(position, velocity, scene.box, slid(slide, time))


@jit
def enter_box(state, scene, i, time):
    """Do as `position_in_box`, and book the energy that particle i gains as another image.

    Every event of a particle begins here, before its path or spin changes.
    """
    landing, before = position_and_velocity(state, scene, i, time)
    position, velocity = position_in_box(state, scene, i, time)
    if present(scene.effects, "observe_flight"):
        slide = slid(hooks.sliding(scene.effects, state), time)
        crossings = periods_outside(landing, scene.box, slide)
        elapsed = time - state.trajectory[i, 2 * len(scene.box)]
        hooks.observe_flight(scene.effects, state, i, crossings, elapsed)
    gained = subtract(velocity, before)
    work = dot(gained, add_scaled(before, gained, 0.5))
    hooks.transfer(scene.effects, state, mass_of(state.bodies, i) * work)
    return position, velocity


@jit
def set_path(state, scene, i, position, velocity, time):
    """Store particle i's trajectory."""
    write(state.trajectory, i, 0, position)
    write(state.trajectory, i, len(scene.box), velocity)
    state.trajectory[i, 2 * len(scene.box)] = time


@jit
def set_path_and_book(state, scene, i, position, before, after, time, account):
    """Store particle i's trajectory, whose velocity was `before`, and enter the translational
    energy gained, m (v'^2 - v^2)/2, in an account of the ledger."""
    set_path(state, scene, i, position, after, time)
    gained = 0.5 * dot(subtract(after, before), add_scaled(before, after, 1.0))
    account[0] += mass_of(state.bodies, i) * gained
