"""The collision rule: changes of velocities and spins in a contact.

McNamara & Luding (1998), Eq. (collrule), with n from particle 2 to particle 1 and the contact
velocity g = v1 - v2 - a (w1 + w2) x n:

    v1,2' = v1,2 -+ (1 + r)/2 g_n n -+ q (1 + beta)/(2 + 2q) g_t
    a w1,2' = a w1,2 + (1 + beta)/(2 + 2q) n x g_t

A wall is a partner of infinite mass: both prefactors double, and n points into the gas. For
particles that differ, particles.Pair has the effective masses and the shares of the spin change.
"""

import math
from typing import Any, NamedTuple

from roughgas.compiling.jit import jit
from roughgas.kernel import hooks
from roughgas.kernel.hooks import active
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
    change_spin_and_book,
    contact_distance,
    enter_box,
    image_numbers,
    image_shift_at,
    mass_of,
    material_of,
    pair_of,
    pair_with_wall,
    set_path,
    shifted,
    spin_of,
)
from roughgas.kernel.state import (
    ALTERED_RESTITUTIONS,
    BOUNDARY_HITS,
    COLLISIONS,
    LAST_FIRST,
    LAST_SECOND,
    NOBODY,
    SLOW_CONTACTS,
    TYPICAL_SPEED,
)

# Particles part at no less than this share of the typical speed: if r left only rounding errors of
# the normal velocity, a pair would collide forever
STICKING = 1e-10
SPLIT = 134217729.0  # 2^27 + 1: splits the digits of a double in two halves


class Contact(NamedTuple):
    """A contact that has just been carried out, for hooks that observe it; vectors are tuples.

    Velocities and spins are in current units, the time counts from the clock's base.
    """

    i: int
    j: int  # NOBODY at a wall
    time: float
    n: Any  # unit vector from j to i, or from the wall into the gas
    v: Any  # relative velocity of i, before
    w: Any  # sum of the spins, before; None without spin
    impulse: Any  # the momentum transferred from i to j
    velocities: Any  # of i and of j before, of the images in the box
    spins: Any  # of i and of j before; at a wall of i, twice


@jit
def collide(state, scene, i, j, time):
    """Carry out the contact of particles i and j at `time`: change paths, spins and ledger."""
    box, effects, bodies, spin = scene.box, scene.effects, state.bodies, state.spin
    position_i, velocity_i = enter_box(state, scene, i, time)
    position_j, velocity_j = enter_box(state, scene, j, time)
    image_shift = image_shift_at(hooks.image_shift(effects, state), time)
    x = subtract(position_i, position_j)
    v_in_box = subtract(velocity_i, velocity_j)
    x, v = shifted(x, v_in_box, image_numbers(x, box, image_shift), box, image_shift)
    n = direction(contact_distance(bodies, i, j), x)
    w_i, w_j = spin_of(spin, box, i), spin_of(spin, box, j)
    w = None if spin is None else add_scaled(w_i, w_j, 1.0)

    pair = pair_of(bodies, effects.spin, i, j)
    material = material_of(bodies, scene, i, j)
    material = _effective_material(effects, material, state, i, j, time, dot(v, n))
    approach = v
    for hook in active(effects, "speed_gain"):
        gain = hook.function(effects[hook.effect_index], hook.account)
        approach = _with_speed_gain(v, n, gain, material[0])
    impulse, spin_change = impulse_and_spin_change(effects, material, n, approach, w, 0.5, pair)
    min_departure = STICKING * state.clock[TYPICAL_SPEED]
    impulse = _with_minimum_departure(impulse, n, v, 0.5 * pair.mass, min_departure)
    state.counts[SLOW_CONTACTS] += -dot(v, n) < min_departure

    # in the frame of the pair, where no large terms cancel
    ledger_row = state.ledger[0, state.ledger.shape[1] - 1]
    ledger_row[0] += dot(impulse, impulse) / pair.mass - dot(v, impulse)
    for hook in active(effects, "speed_gain"):
        gain = hook.function(effects[hook.effect_index], hook.account)
        energy = _energy_of_speed_gain(gain, pair.mass, material[0] * dot(v, n))
        state.ledger[0, hook.account, 0] += energy
        ledger_row[0] -= energy
    velocity_loss_i, velocity_gain_j = (
        divide(impulse, mass_of(bodies, i)),
        divide(impulse, mass_of(bodies, j)),
    )
    set_path(state, scene, i, position_i, subtract(velocity_i, velocity_loss_i), time)
    set_path(state, scene, j, position_j, add_scaled(velocity_j, velocity_gain_j, 1.0), time)
    if spin is not None:
        change_spin_and_book(
            state, scene, i, w_i, scale(spin_change, pair.spin_shares[0]), ledger_row
        )
        change_spin_and_book(
            state, scene, j, w_j, scale(spin_change, pair.spin_shares[1]), ledger_row
        )

    hooks.transfer(effects, state, dot(impulse, subtract(v, v_in_box)))
    velocities, spins = (velocity_i, velocity_j), (w_i, w_j)
    contact = Contact(i, j, time, n, v, w, impulse, velocities, spins)
    for hook in active(effects, "observe_contact"):
        hook.function(effects[hook.effect_index], hook.account, state, contact)
    note_contact(state, effects, i, time)
    note_contact(state, effects, j, time)
    state.counts[COLLISIONS] += 1
    state.counts[LAST_FIRST], state.counts[LAST_SECOND] = state.label[i], state.label[j]


@jit
def collide_with_wall(state, scene, account, i, time, material, n, wall_velocity, min_departure):
    """Carry out the contact of particle i with a wall at `time`; return NOBODY (-1) as the partner.

    `material` is (r, beta) of the wall, n its unit normal into the gas, `wall_velocity` the
    velocity of its surface. The particle's normal speed afterwards is at least `min_departure`, so
    that a bouncing particle makes finitely many bounces in a finite time. Its gain of energy is
    entered in the account with the index `account` of the ledger.
    """
    effects, bodies, spin = scene.effects, state.bodies, state.spin
    position, velocity = enter_box(state, scene, i, time)
    w = spin_of(spin, scene.box, i)
    v = subtract(velocity, wall_velocity)
    pair = pair_with_wall(bodies, effects.spin, i)
    material = _effective_material(effects, material, state, i, NOBODY, time, dot(v, n))
    impulse, spin_change = impulse_and_spin_change(effects, material, n, v, w, 1.0, pair)
    impulse = _with_minimum_departure(impulse, n, v, pair.mass, min_departure)
    velocity_loss = divide(impulse, mass_of(bodies, i))
    set_path(state, scene, i, position, subtract(velocity, velocity_loss), time)
    ledger_row = state.ledger[0, account]
    ledger_row[0] += 0.5 * dot(impulse, velocity_loss) - dot(velocity, impulse)
    if spin is not None:
        change_spin_and_book(state, scene, i, w, spin_change, ledger_row)
    velocities, spins = (velocity, wall_velocity), (w, w)
    contact = Contact(i, NOBODY, time, n, v, w, impulse, velocities, spins)
    for hook in active(effects, "observe_wall"):
        hook.function(effects[hook.effect_index], hook.account, state, contact)
    note_contact(state, effects, i, time)
    state.counts[BOUNDARY_HITS] += 1
    return NOBODY


@jit
def direction(distance, x):
    """Return the unit vector along the separation x of a pair in contact.

    |x| is the contact distance `distance`, to within rounding. For such x, sqrt(x.x) and its
    reciprocal lie midway between two doubles half of the time, and then always on the same side of
    the middle: x times 1/|x| would be too long on average, and an elastic gas would heat up.
    Instead x/distance is corrected by a term so small that its own rounding does not matter. The
    rounding error of distance^2, which has the same sign in all contacts of two species, is added
    (T. J. Dekker, Numer. Math. 18, 224, 1971); for a distance of 2 it is zero.
    """
    square = dot(x, x)
    length = math.sqrt(square)
    upper = SPLIT * distance - (SPLIT * distance - distance)
    lower = distance - upper
    product = distance * distance
    error = ((upper * upper - product) + 2.0 * upper * lower) + lower * lower
    scaled = divide(x, distance)
    return add_scaled(scaled, scaled, ((product - square) + error) / (length * (distance + length)))


@jit
def impulse_and_spin_change(effects, material, n, v, w, share, pair):
    """Return the momentum passed from i to j, and the change of each spin a w, in one contact.

    `material` is (r, beta); n the unit normal from j, or from a wall, to i; v the relative velocity
    of i, and w the sum of the spins, before the contact; `share` is 1/2 between particles and 1 at
    a wall. If the particles of the Pair differ, the change is the mean over both spins. Without
    spin (w is None) the momentum is normal, and the change None.
    """
    r, beta = material
    normal_speed = dot(v, n)
    impulse = scale(n, share * pair.mass * (1.0 + r) * normal_speed)
    if w is None:
        return impulse, None
    slip_velocity = subtract(add_scaled(v, n, -normal_speed), spin_cross(w, n))
    for hook in active(effects, "roughness"):
        beta = hook.function(
            effects[hook.effect_index], hook.account, beta, r, normal_speed, slip_velocity, pair
        )
    factor = share * (1.0 + beta) / (1.0 + pair.inertia)
    return add_scaled(impulse, slip_velocity, pair.reduced_spin_mass * factor), scale(
        cross_to_spin(n, slip_velocity), factor
    )


@jit
def _with_speed_gain(v, n, gain, r):
    """Return the relative velocity with which restitution alone would have the same impulse.

    v is the relative velocity before the contact, n its normal, r its restitution, and `gain` the
    speed that it adds to the normal speed of parting.
    """
    return add_scaled(v, n, -gain / (1.0 + r))


@jit
def _energy_of_speed_gain(gain, mass, reflected):
    """Return the energy that a pair gains as it parts at the normal speed `gain` - `reflected`.

    Without the gain it would part at -`reflected`, which is -r g_n; `mass` is twice the reduced
    mass.
    """
    return 0.25 * mass * gain * (gain - 2.0 * reflected)


@jit
def _with_minimum_departure(impulse, n, v, effective_mass, min_departure):
    """Return the impulse, increased if needed so that the partners part at a minimum speed along n.

    v is the relative velocity before, `effective_mass` the reduced mass of the partners, at a wall
    the mass of the particle; `min_departure` is the minimum speed.
    """
    missing_speed = min_departure - dot(add_scaled(v, impulse, -1.0 / effective_mass), n)
    return add_scaled(impulse, n, -effective_mass * max(0.0, missing_speed))


@jit
def _effective_material(effects, material, state, i, j, time, speed):
    """Return (r, beta) of a contact that sticks, after all effects that change either with speed.

    `material` is (r, beta) before; `speed` is the normal component of the relative velocity,
    negative where the partners approach; j is NOBODY at a wall. An altered r is counted.
    """
    unaltered, beta = material
    r = unaltered
    for hook in active(effects, "restitution"):
        r = hook.function(effects[hook.effect_index], hook.account, r, state, i, j, time, speed)
    if r != unaltered:
        state.counts[ALTERED_RESTITUTIONS] += 1
    for hook in active(effects, "sticking_roughness"):
        k = hook.effect_index
        beta = hook.function(effects[k], hook.account, beta, state, i, j, time, speed)
    return r, beta


@jit
def note_contact(state, effects, i, time):
    """Count a change of particle i's velocity at `time`, and call the after_contact hooks."""
    state.changes[i] += 1
    for hook in active(effects, "after_contact"):
        hook.function(effects[hook.effect_index], hook.account, state, i, time)
