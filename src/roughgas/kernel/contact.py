"""What a contact does to velocities and spins.

McNamara & Luding (1998), Eq. (collrule), with n from particle 2 to particle 1 and the contact
velocity g = v1 - v2 - a (w1 + w2) x n:

    v1,2' = v1,2 -+ (1 + r)/2 g_n n -+ q (1 + beta)/(2 + 2q) g_t
    a w1,2' = a w1,2 + (1 + beta)/(2 + 2q) n x g_t

A wall is a partner of infinite mass: both prefactors double, and n points into the gas. How
particles that differ share the impulse and the turning is in particles.Pair.
"""

import math
from typing import Any, NamedTuple

from roughgas.compiling.jit import jit
from roughgas.kernel import hooks
from roughgas.kernel.hooks import present
from roughgas.kernel.mathematics import (
    add_scaled,
    cross_to_spin,
    divide,
    dot,
    scale,
    spin_cross,
    subtract,
)
from roughgas.kernel.particles import (
    enter_box,
    image_numbers,
    mass_of,
    material_of,
    pair_of,
    pair_with_wall,
    reach_of,
    set_path,
    shifted,
    slid,
    spin_of,
    turn_and_book,
)
from roughgas.kernel.state import (
    BOUNDARY_HITS,
    COLLISIONS,
    LAST_FIRST,
    LAST_SECOND,
    NOBODY,
    SPENT,
    TOUCHED,
    TYPICAL_SPEED,
)

# Where r leaves only rounding of the normal velocity, a pair would go on colliding forever:
# particles part at no less than this share of the typical speed
STICKING = 1e-10
SPLIT = 134217729.0  # 2^27 + 1: cuts the digits of a double in two


class Contact(NamedTuple):
    """A contact that has just been made, for hooks that look at it; vectors are tuples."""

    i: int
    j: int  # NOBODY at a wall
    time: float
    n: Any  # unit vector from j to i, or from the wall into the gas
    v: Any  # relative velocity of i, before
    w: Any  # sum of the spins, before; None without spin
    push: Any  # the momentum that has passed from i to j
    velocities: Any  # of i and of j before, of the images in the box
    spins: Any  # of i and of j before; at a wall twice that of i


@jit
def collide(state, scene, i, j, time):
    """Carry out the contact of particles i and j at `time`."""
    box, effects, bodies, spin = scene.box, scene.effects, state.bodies, state.spin
    position_i, velocity_i = enter_box(state, scene, i, time)
    position_j, velocity_j = enter_box(state, scene, j, time)
    slide = slid(hooks.sliding(effects, state), time)
    x = subtract(position_i, position_j)
    between = subtract(velocity_i, velocity_j)
    x, v = shifted(x, between, image_numbers(x, box, slide), box, slide)
    n = direction(reach_of(bodies, i, j), x)
    w_i, w_j = spin_of(spin, box, i), spin_of(spin, box, j)
    w = None if spin is None else add_scaled(w_i, w_j, 1.0)

    pair = pair_of(bodies, effects.spin, i, j)
    material = material_of(bodies, scene, i, j)
    material = _material(effects, material, state, i, j, time, dot(v, n))
    push, turn = response(effects, material, n, v, w, 0.5, pair)
    least = STICKING * state.clock[TYPICAL_SPEED]
    push = _parted(push, n, v, 0.5 * pair.mass, least)
    state.counts[SPENT] += -dot(v, n) < least

    # in the frame of the pair, where nothing large cancels
    account = state.ledger[0, state.ledger.shape[1] - 1]
    account[0] += dot(push, push) / pair.mass - dot(v, push)
    slowed, hastened = divide(push, mass_of(bodies, i)), divide(push, mass_of(bodies, j))
    set_path(state, scene, i, position_i, subtract(velocity_i, slowed), time)
    set_path(state, scene, j, position_j, add_scaled(velocity_j, hastened, 1.0), time)
    if spin is not None:
        turn_and_book(state, scene, i, w_i, scale(turn, pair.gives[0]), account)
        turn_and_book(state, scene, j, w_j, scale(turn, pair.gives[1]), account)

    hooks.transfer(effects, state, dot(push, subtract(v, between)))
    velocities, spins = (velocity_i, velocity_j), (w_i, w_j)
    contact = Contact(i, j, time, n, v, w, push, velocities, spins)
    for part in present(effects, "observe_contact"):
        part.own(effects[part.place], part.rank, state, contact)
    note_contact(state, effects, i, time)
    note_contact(state, effects, j, time)
    state.counts[COLLISIONS] += 1
    state.counts[LAST_FIRST], state.counts[LAST_SECOND] = state.label[i], state.label[j]


@jit
def collide_with_wall(state, scene, index, i, time, material, n, wall_velocity, least_departure):
    """Carry out the contact of particle i with a wall at `time`.

    Parameters: the effect's index in the ledger; material (r, beta); n the unit normal into the
    gas; the wall's velocity; least_departure: the particle leaves at no less than this normal
    speed, so that a bouncing particle makes finitely many bounces in a finite time.
    """
    effects, bodies, spin = scene.effects, state.bodies, state.spin
    position, velocity = enter_box(state, scene, i, time)
    w = spin_of(spin, scene.box, i)
    v = subtract(velocity, wall_velocity)
    pair = pair_with_wall(bodies, effects.spin, i)
    material = _material(effects, material, state, i, NOBODY, time, dot(v, n))
    push, turn = response(effects, material, n, v, w, 1.0, pair)
    push = _parted(push, n, v, pair.mass, least_departure)
    slowed = divide(push, mass_of(bodies, i))
    set_path(state, scene, i, position, subtract(velocity, slowed), time)
    account = state.ledger[0, index]
    account[0] += 0.5 * dot(push, slowed) - dot(velocity, push)
    if spin is not None:
        turn_and_book(state, scene, i, w, turn, account)
    velocities, spins = (velocity, wall_velocity), (w, w)
    contact = Contact(i, NOBODY, time, n, v, w, push, velocities, spins)
    for part in present(effects, "observe_wall"):
        part.own(effects[part.place], part.rank, state, contact)
    note_contact(state, effects, i, time)
    state.counts[BOUNDARY_HITS] += 1
    return NOBODY


@jit
def direction(reach, x):
    """Return the unit vector along the separation x of a pair in contact, |x| = reach but for some
    roundings.

    Of such x the root of x.x and its reciprocal lie midway between two doubles half of the time,
    and then always on the same side of the middle: x times 1/|x| would be too long on average, and
    an elastic gas would heat up. What x/reach lacks is too small for its own rounding to matter.
    That of reach^2, which would be on the same side in all contacts of two species, is added
    (T. J. Dekker, Numer. Math. 18, 224, 1971); for a reach of 2 there is none.
    """
    square = dot(x, x)
    length = math.sqrt(square)
    upper = SPLIT * reach - (SPLIT * reach - reach)
    lower = reach - upper
    whole = reach * reach
    rest = ((upper * upper - whole) + 2.0 * upper * lower) + lower * lower
    part = divide(x, reach)
    return add_scaled(part, part, ((whole - square) + rest) / (length * (reach + length)))


@jit
def response(effects, material, n, v, w, share, pair):
    """Return the momentum exchanged and the change of each spin a w in one contact.

    material = (r, beta); n the normal, v the relative velocity, w the sum of the spins; share =
    1/2 between particles and 1 at a wall. Where particles of the Pair differ, the change is the
    mean of both spins'. Without spin (w is None) only the normal part is there.
    """
    r, beta = material
    speed = dot(v, n)
    push = scale(n, share * pair.mass * (1.0 + r) * speed)
    if w is None:
        return push, None
    slip = subtract(add_scaled(v, n, -speed), spin_cross(w, n))
    for part in present(effects, "roughness"):
        beta = part.own(effects[part.place], part.rank, beta, r, speed, slip, pair)
    turn = share * (1.0 + beta) / (1.0 + pair.inertia)
    return add_scaled(push, slip, pair.bulk * turn), scale(cross_to_spin(n, slip), turn)


@jit
def _parted(push, n, v, share, least):
    """Return the push, large enough for the partners to part at `least` or more along n."""
    lacking = least - dot(add_scaled(v, push, -1.0 / share), n)
    return add_scaled(push, n, -share * max(0.0, lacking))


@jit
def _material(effects, material, state, i, j, time, speed):
    """Return (r, beta) as the effects have it that change a contact's restitution."""
    usual, beta = material
    r = usual
    for part in present(effects, "restitution"):
        r = part.own(effects[part.place], part.rank, r, state, i, j, time, speed)
    if r != usual:
        state.counts[TOUCHED] += 1
    return r, beta


@jit
def note_contact(state, effects, i, time):
    """Note that particle i has had a contact."""
    state.changes[i] += 1
    for part in present(effects, "after_contact"):
        part.own(effects[part.place], part.rank, state, i, time)
