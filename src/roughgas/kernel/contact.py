"""What a contact does to velocities and spins.

McNamara & Luding (1998), Eq. (collrule), with n from particle 2 to particle 1 and the contact
velocity g = v1 - v2 - a (w1 + w2) x n:

    v1,2' = v1,2 -+ (1 + r)/2 g_n n -+ q (1 + beta)/(2 + 2q) g_t
    a w1,2' = a w1,2 + (1 + beta)/(2 + 2q) n x g_t

A wall is a partner of infinite mass: both prefactors double, and n points into the gas. How
particles that differ share the impulse and the turning is in bodies.py.
"""

import math

from roughgas.kernel import hooks
from roughgas.kernel.hooks import either
from roughgas.kernel.jit import jit, unrolled
from roughgas.kernel.particles import (
    book_spin,
    bulk_in,
    change_of_velocity,
    enter_box,
    image_numbers,
    inertia_in,
    mass_in,
    material_of,
    pair_of,
    pair_with_wall,
    reach_of,
    set_path,
    shifted,
    slid,
    spin_of,
    spin_sum,
    turn_of,
    turn_spin,
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
from roughgas.kernel.vectors import (
    add_scaled,
    cross_to_spin,
    divide,
    dot,
    scale,
    spin_cross,
    subtract,
)

# Where r leaves only rounding of the normal velocity, a pair would go on colliding forever:
# particles part at no less than this share of the typical speed
STICKING = 1e-10
SPLIT = 134217729.0  # 2^27 + 1: cuts the digits of a double in two


@jit
def collide(state, scene, i, j, time):
    """Carry out the contact of particles i and j at `time`."""
    box = scene.box
    position_i, velocity_i = enter_box(state, scene, i, time)
    position_j, velocity_j = enter_box(state, scene, j, time)
    slide = slid(hooks.sliding(scene.effects, None, state), time)
    x = subtract(position_i, position_j)
    between = subtract(velocity_i, velocity_j)
    x, v = shifted(x, between, image_numbers(x, box, slide), box, slide)
    bodies = state.bodies
    n = _normal(reach_of(bodies, i, j), x)
    w_i = spin_of(state.spin, box, i)
    w_j = spin_of(state.spin, box, j)
    effects = scene.effects
    r, beta = material_of(bodies, scene, i, j)
    material = _material(effects, r, beta, state, i, j, time, dot(v, n))
    w = spin_sum(w_i, w_j)
    pair = pair_of(bodies, i, j)
    push, turn = response(effects.spin, effects, material, n, v, w, 0.5, pair)
    least = STICKING * state.clock[TYPICAL_SPEED]
    push = _parted(push, n, v, 0.5 * mass_in(pair), least)
    state.counts[SPENT] += -dot(v, n) < least
    slowed, hastened = change_of_velocity(bodies, i, push), change_of_velocity(bodies, j, push)
    set_path(state, scene, i, position_i, subtract(velocity_i, slowed), time)
    set_path(state, scene, j, position_j, add_scaled(velocity_j, hastened, 1.0), time)
    turn_i, turn_j = turn_of(turn, pair, 0), turn_of(turn, pair, 1)
    turn_spin(state.spin, i, w_i, turn_i)
    turn_spin(state.spin, j, w_j, turn_j)
    # in the frame of the pair, where nothing large cancels
    account = state.ledger[0, state.ledger.shape[1] - 1]
    account[0] += dot(push, push) / mass_in(pair) - dot(v, push)
    book_spin(w_i, turn_i, effects.spin, bodies, i, account)
    book_spin(w_j, turn_j, effects.spin, bodies, j, account)
    hooks.transfer(effects, None, state, dot(push, subtract(v, between)))
    hooks.observe_contact(effects, None, state, i, j, n, v, w, push)
    _note_contact(state, effects, i, time)
    _note_contact(state, effects, j, time)
    state.counts[COLLISIONS] += 1
    state.counts[LAST_FIRST] = state.label[i]
    state.counts[LAST_SECOND] = state.label[j]


@jit
def collide_with_wall(state, scene, index, i, time, material, n, wall_velocity, least_departure):
    """Carry out the contact of particle i with a wall at `time`.

    Parameters: the effect's index in the ledger; material (r, beta); n the unit normal into the
    gas; the wall's velocity; least_departure: the particle leaves at no less than this normal
    speed, so that a bouncing particle makes finitely many bounces in a finite time.
    """
    position, velocity = enter_box(state, scene, i, time)
    w = spin_of(state.spin, scene.box, i)
    v = subtract(velocity, wall_velocity)
    effects = scene.effects
    material = _material(effects, material[0], material[1], state, i, NOBODY, time, dot(v, n))
    pair = pair_with_wall(state.bodies, i)
    push, turn = response(effects.spin, effects, material, n, v, w, 1.0, pair)
    push = _parted(push, n, v, mass_in(pair), least_departure)
    slowed = change_of_velocity(state.bodies, i, push)
    set_path(state, scene, i, position, subtract(velocity, slowed), time)
    turn_spin(state.spin, i, w, turn)
    account = state.ledger[0, index]
    account[0] += 0.5 * dot(push, slowed) - dot(velocity, push)
    book_spin(w, turn, effects.spin, state.bodies, i, account)
    _note_contact(state, effects, i, time)
    state.counts[BOUNDARY_HITS] += 1
    return NOBODY


@jit
def direction(x):
    """Return the unit vector along the separation x of a pair in contact.

    Where |x| is 2 but for some roundings, the root of x.x and its reciprocal lie midway between two
    doubles half of the time, and then always on the same side of the middle: x times 1/|x| would be
    too long on average, and an elastic gas would heat up. Half of x is exact, and what it lacks is
    too small for its own rounding to matter.
    """
    square = dot(x, x)
    length = math.sqrt(square)
    half = scale(x, 0.5)
    return add_scaled(half, half, (4.0 - square) / (length * (2.0 + length)))


def _along_reach(reach, x):
    """As `direction`, for |x| = reach. The rounding of reach^2, which would be on the same side in
    all contacts of two species, is added (T. J. Dekker, Numer. Math. 18, 224, 1971)."""
    square = dot(x, x)
    length = math.sqrt(square)
    upper = SPLIT * reach - (SPLIT * reach - reach)
    lower = reach - upper
    whole = reach * reach
    rest = ((upper * upper - whole) + 2.0 * upper * lower) + lower * lower
    part = divide(x, reach)
    return add_scaled(part, part, ((whole - square) + rest) / (length * (reach + length)))


_normal = either(_along_reach, lambda reach, x: direction(x))


@unrolled
def response(spin, effects, material, n, v, w, share, pair):
    """Return the momentum exchanged and the change of each spin a w in one contact, of mass 1.

    material = (r, beta); n the normal, v the relative velocity, w the sum of the spins; share =
    1/2 between particles and 1 at a wall; pair tells where particles differ, and the change is then
    the mean of both spins' (bodies.py). Without spin (None) only the normal part is there.
    """
    if spin is None:
        return _smooth(material, n, v, share * mass_in(pair))
    else:
        return _rough(spin, effects, material, n, v, w, share, pair)


@jit
def _smooth(material, n, v, share):
    return scale(n, share * (1.0 + material[0]) * dot(v, n)), None


@jit
def _rough(spin, effects, material, n, v, w, share, pair):
    r, beta = material
    speed = dot(v, n)
    slip = subtract(add_scaled(v, n, -speed), spin_cross(w, n))
    beta = hooks.roughness(effects, beta, r, speed, slip, pair)
    turn = share * (1.0 + beta) / (1.0 + inertia_in(pair, spin))
    along = bulk_in(pair, spin) * turn
    push = add_scaled(scale(n, share * mass_in(pair) * (1.0 + r) * speed), slip, along)
    return push, scale(cross_to_spin(n, slip), turn)


@jit
def _parted(push, n, v, share, least):
    """Return the push, large enough for the partners to part at `least` or more along n."""
    lacking = least - dot(add_scaled(v, push, -1.0 / share), n)
    return add_scaled(push, n, -share * max(0.0, lacking))


@jit
def _material(effects, r, beta, state, i, j, time, speed):
    effective = hooks.restitution(effects, r, state, i, j, time, speed)
    if effective != r:
        state.counts[TOUCHED] += 1
    return effective, beta


@jit
def _note_contact(state, effects, i, time):
    state.changes[i] += 1
    hooks.after_contact(effects, None, state, i, time)
