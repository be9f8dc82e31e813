"""Particles: periodic images, radii and masses, spins, and free flight.

Periodic images: `box` has for each axis its length in particle radii a, its period, or None where
it is open. Under Lees-Edwards shear (`image_shift` = (offset, velocity), else None) the images
above are displaced by the offset along the first axis and move with the velocity along it.
hooks.image_shift returns its value at the clock's base, `image_shift_at` its value at a given time.

Bodies: State.bodies is None in a gas of one species, whose radius and mass are 1, at no cost. With
bodies that happen to be equal, results have the same bits as without: for two equal numbers x, x/(x
+ x) is 1/2 exactly. All properties of a pair are symmetric in its particles, to the last bit.

Spins are surface velocities a w, with one component in the plane and three in space; None in a
scene without spin.
"""

from typing import Any, NamedTuple

import numpy as np

from roughgas.compiling.jit import jit
from roughgas.compiling.lanes import is_single, multiply_add
from roughgas.kernel import hooks
from roughgas.kernel.hooks import active
from roughgas.kernel.mathematics import add_scaled, dot, read, subtract, write

FIRST_LARGE_32, ONE_32 = np.float32(1.5 * 2.0**23), np.float32(1.0)
FIRST_LARGE_64 = 1.5 * 2.0**52


@jit
def periods(x, length):
    """Return x/length rounded to the nearest integer, ties to even; exact to 2^22 (2^51 in double).

    x is a coordinate, `length` a period of the box. Adding and subtracting a number whose spacing
    is 1 rounds by two additions, which every x86-64 machine has in vector form, with the same bits
    on all machines. The reciprocal of the length is computed once per loop.
    """
    large = FIRST_LARGE_32 if is_single(length) else FIRST_LARGE_64
    unity = ONE_32 if is_single(length) else 1.0
    return multiply_add(x, unity / length, large) - large


@jit
def image_shift_at(image_shift, time):
    """Return the image shift (offset, velocity) at `time` after the clock's base.

    `image_shift` is the shift at the base; None without shear.
    """
    return None if image_shift is None else (image_shift[0] + image_shift[1] * time, image_shift[1])


@jit
def image_numbers(x, box, image_shift):
    """Return the numbers of periods per axis to subtract from separation x for its nearest image.

    They are whole numbers, as floats. The image shift holds at the time of the separation. The
    number of an open axis is not used.
    """
    numbers = tuple(x[k] if box[k] is None else periods(x[k], box[k]) for k in range(len(box)))
    if image_shift is None:
        return numbers
    sheared = multiply_add(-numbers[1], image_shift[0], x[0])
    return (periods(sheared, box[0]),) + numbers[1:]


@jit
def _shift(x, numbers, box):
    """Return position or separation x less these numbers of periods along each periodic axis."""
    return tuple(
        x[k] if box[k] is None else multiply_add(-numbers[k], box[k], x[k]) for k in range(len(box))
    )


@jit
def shifted(x, u, numbers, box, image_shift):
    """Return separation x and relative velocity u of the image with these `numbers` of periods.

    The numbers are subtracted along each axis, as from image_numbers.
    """
    moved = _shift(x, numbers, box)
    if image_shift is None:
        return moved, u
    return (
        (multiply_add(-numbers[1], image_shift[0], moved[0]),) + moved[1:],
        (multiply_add(-numbers[1], image_shift[1], u[0]),) + u[1:],
    )


@jit
def fold_into_box(position, velocity, box, image_shift):
    """Return position and velocity of the image in the box, where periodic axes run from 0 to L.

    The image shift holds at the time of the position.
    """
    return shifted(position, velocity, _image_in_box(position, box, image_shift), box, image_shift)


@jit
def _image_in_box(position, box, image_shift):
    """Return the periods per axis to subtract from a position for its image in the box."""
    centred = _shift(position, tuple(0.5 for k in range(len(position))), box)
    return image_numbers(centred, box, image_shift)


@jit
def periods_outside(position, box, image_shift):
    """Return the whole numbers of periods per axis that `fold_into_box` subtracts, as floats.

    The number of an open axis, whose `box` entry is None, is 0. `image_shift` is (offset, velocity)
    of the image above at the time of the position, or None.
    """
    numbers = _image_in_box(position, box, image_shift)
    return tuple(0.0 if box[k] is None else numbers[k] for k in range(len(position)))


@jit
def single_image_limit(box, half, distance):
    """Return the squared relative speed below which a pair meets no second image.

    It holds for times within +-`half` of the instant whose nearest image is known; `distance` is
    the contact distance of the pair, or an upper bound of it. Includes a margin for rounding. None
    where no axis is periodic.
    """
    lengths = tuple(box[k] for k in range(len(box)) if box[k] is not None)
    if len(lengths) == 0:
        return None
    shortest = lengths[0]
    for k in range(1, len(lengths)):
        shortest = min(shortest, lengths[k])
    speed = (0.5 * shortest - 1.0005 * distance) / half
    return speed * speed


class Pair(NamedTuple):
    """Effective masses and friction of a contact of two particles, or of a particle with a wall.

    s = m q is a particle's moment of inertia over a^2. A tangential impulse P changes the slip
    velocity by P (1/m_i + 1/s_i + 1/m_j + 1/s_j), and the spin of i by P/s_i.
    """

    mass: float  # twice the reduced mass; at a wall the mass of the particle
    inertia: float  # mean q, weighted with the particles' shares of the spin change
    reduced_spin_mass: float  # twice the reduced s; at a wall the s of the particle
    spin_shares: tuple[float, float]  # twice the particles' shares of the spin change
    mu: Any  # coefficient of friction; None where particles are alike, NaN without friction


@jit
def identical_pair(spin):
    """Return the Pair of two particles of radius and mass 1; `spin` is the effect Spin, or None."""
    q = 0.0 if spin is None else spin.inertia
    return Pair(1.0, q, q, (1.0, 1.0), None)


@jit
def pair_of(bodies, spin, i, j):
    """Return the Pair of particles i and j, their effective masses and friction.

    `bodies` is State.bodies, `spin` the effect Spin, or None.
    """
    if bodies is None:
        return identical_pair(spin)
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
    """Return the Pair of particle i and a wall, its effective masses and friction.

    `bodies` is State.bodies, `spin` the effect Spin, or None.
    """
    if bodies is None:
        return identical_pair(spin)
    m, q = bodies.mass[i], bodies.inertia[i]
    return Pair(m, q, m * q, (1.0, 0.0), bodies.pairs[bodies.species[i], -1, 2])


@jit
def radius_of(bodies, i):
    """Return the radius of particle i, in particle radii a; `bodies` is State.bodies."""
    return 1.0 if bodies is None else bodies.radius[i]


@jit
def largest_of(bodies):
    """Return the largest radius of all particles, in particle radii a; `bodies` is State.bodies."""
    return 1.0 if bodies is None else bodies.largest[0]


@jit
def contact_distance(bodies, i, j):
    """Return the distance of the centres of i and j in contact, the sum of their radii.

    In particle radii a; `bodies` is State.bodies.
    """
    return radius_of(bodies, i) + radius_of(bodies, j)


@jit
def mass_of(bodies, i):
    """Return the mass of particle i, in particle masses m; `bodies` is State.bodies."""
    return 1.0 if bodies is None else bodies.mass[i]


@jit
def spin_mass_of(bodies, spin, i):
    """Return s = m q of particle i, whose rotational energy is s (a w)^2/2.

    q = I/(m a^2) is of its own mass and radius; `bodies` is State.bodies, `spin` the effect Spin.
    """
    return spin.inertia if bodies is None else bodies.mass[i] * bodies.inertia[i]


@jit
def material_of(bodies, scene, i, j):
    """Return (r, beta), normal restitution and roughness, of contacts of particles i and j.

    `bodies` is State.bodies.
    """
    if bodies is None or scene.effects.species.same_material:
        return scene.restitution, scene.roughness
    species_i, species_j = bodies.species[i], bodies.species[j]
    return bodies.pairs[species_i, species_j, 0], bodies.pairs[species_i, species_j, 1]


@jit
def spin_of(spin, box, i):
    """Return the spin a w of particle i, a tuple of 2 D - 3 components; None without spin.

    `spin` is State.spin; `box` has as many entries as there are axes.
    """
    return None if spin is None else tuple(spin[i, k] for k in range(2 * len(box) - 3))


@jit
def change_spin(spin, i, before, change):
    """Add `change` to particle i's spin, which was `before`; `spin` is State.spin."""
    write(spin, i, 0, add_scaled(before, change, 1.0))


@jit
def change_spin_and_book(state, scene, i, before, change, ledger_row):
    """Add `change` to particle i's spin, which was `before`, and enter the energy in the ledger.

    The rotational energy gained is m q [w.dw + dw.dw/2]. `ledger_row` is an account of the ledger,
    an array of translational and rotational energy.
    """
    change_spin(state.spin, i, before, change)
    gained = dot(before, change) + 0.5 * dot(change, change)
    ledger_row[1] += spin_mass_of(state.bodies, scene.effects.spin, i) * gained


@jit
def path_of(trajectory, i, box):
    """Return particle i's path, (position, velocity, time): both vectors hold at that time.

    `trajectory` is State.trajectory (N, 2 D + 1); `box` has as many entries as there are axes.
    """
    return (
        read(trajectory, i, 0, box),
        read(trajectory, i, len(box), box),
        trajectory[i, 2 * len(box)],
    )


@jit
def free_flight(path, time, gravity):
    """Return position and velocity at `time` in free flight on a path.

    The path is (position, velocity, time); `gravity` has the acceleration along each axis, None
    where it vanishes, or is None.
    """
    position, velocity, elapsed = path[0], path[1], time - path[2]
    moved = add_scaled(position, velocity, elapsed)
    if gravity is None:
        return moved, velocity
    return (
        tuple(
            moved[k] if gravity[k] is None else moved[k] + 0.5 * gravity[k] * elapsed * elapsed
            for k in range(len(position))
        ),
        tuple(
            velocity[k] if gravity[k] is None else velocity[k] + gravity[k] * elapsed
            for k in range(len(position))
        ),
    )


@jit
def position_and_velocity(state, scene, i, time):
    """Return position and velocity of particle i at `time`, in free flight.

    The position is not folded into the box.
    """
    path = path_of(state.trajectory, i, scene.box)
    return free_flight(path, time, hooks.acceleration(scene.effects))


@jit
def position_in_box(state, scene, i, time):
    """Return position and velocity of particle i's image in the box at `time`.

    Under shear the image's velocity differs from the particle's.
    """
    position, velocity = position_and_velocity(state, scene, i, time)
    image_shift = hooks.image_shift(scene.effects, state)
    return fold_into_box(position, velocity, scene.box, image_shift_at(image_shift, time))


@jit
def enter_box(state, scene, i, time):
    """Return position and velocity of particle i's image in the box at `time`, to begin an event.

    The result is as from `position_in_box`; the energy gained by the change of image is entered in
    the ledger. Every event of a particle begins here, before its path or spin changes.
    """
    landing, before = position_and_velocity(state, scene, i, time)
    position, velocity = position_in_box(state, scene, i, time)
    if active(scene.effects, "observe_flight"):
        image_shift = image_shift_at(hooks.image_shift(scene.effects, state), time)
        crossings = periods_outside(landing, scene.box, image_shift)
        elapsed = time - state.trajectory[i, 2 * len(scene.box)]
        hooks.observe_flight(scene.effects, state, i, crossings, elapsed)
    gained = subtract(velocity, before)
    work = dot(gained, add_scaled(before, gained, 0.5))
    if active(scene.effects, "acceleration"):
        work += _lift(hooks.acceleration(scene.effects), scene.box, landing, position)
    hooks.transfer(scene.effects, state, mass_of(state.bodies, i) * work)
    return position, velocity


@jit
def _lift(gravity, box, landing, position):
    """Return the potential energy, over the mass, that a particle gains where it enters the box.

    `landing` is its position and `position` its image's: they differ in height along periodic axes
    along which `gravity`, an acceleration as in `free_flight`, acts.
    """
    energy = 0.0
    for k in range(len(box)):
        if gravity[k] is not None and box[k] is not None:
            energy += gravity[k] * (landing[k] - position[k])
    return energy


@jit
def set_path(state, scene, i, position, velocity, time):
    """Store particle i's trajectory: free flight from this position and velocity at `time`."""
    write(state.trajectory, i, 0, position)
    write(state.trajectory, i, len(scene.box), velocity)
    state.trajectory[i, 2 * len(scene.box)] = time


@jit
def set_path_and_book(state, scene, i, position, before, after, time, ledger_row):
    """Store particle i's trajectory with the velocity `after`, and enter the energy in the ledger.

    The translational energy gained since the velocity was `before` is m (v'^2 - v^2)/2; position
    and new velocity hold at `time`. `ledger_row` is an account of the ledger, an array of
    translational and rotational energy.
    """
    set_path(state, scene, i, position, after, time)
    gained = 0.5 * dot(subtract(after, before), add_scaled(before, after, 1.0))
    ledger_row[0] += mass_of(state.bodies, i) * gained
