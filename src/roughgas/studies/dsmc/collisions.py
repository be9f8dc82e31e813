"""Bird's no-time-counter scheme for a homogeneous gas, compiled.

Pairs are drawn at random, each with a random normal n, and collide with the probability
|g.n|/majorant, g being the relative velocity: as often as if they were anywhere in the volume with
equal probability. Each draw takes the mean time between two draws. G. A. Bird, Molecular Gas
Dynamics and the Direct Simulation of Gas Flows (Oxford, 1994), section 11.1.

All compiled code of the solver is in this file and in kernel/, whose edits numba's cache notices.
"""

import math

from roughgas.kernel.contact import response
from roughgas.kernel.jit import compiled, entry
from roughgas.kernel.spins import spin_of, spin_sum, turn_spin
from roughgas.kernel.unroll import unrolled
from roughgas.kernel.vectors import add_scaled, dot, read, scale, subtract, write

# Entries of HomogeneousGas.clock
TIME, WAITED, LOG_UNIT, MAJORANT = range(4)
# Entries of HomogeneousGas.counts
COLLISIONS, DRAWS = range(2)
COLUMNS = ("time", "collisions", "log_unit", "vv", "ww", "vvvv", "wwww", "vvww", "vwvw")


@entry(cache=True)
def record(gas, material, rng, collisions, rows):
    """Let the gas make `collisions` before each of the `rows`, shape (samples, COLUMNS).

    After each sample, and in between after as many collisions as there are particles, the total
    momentum is removed and T_tr scaled to 1: otherwise the majorant would become too large for a
    gas that has cooled.
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
    """Draw pairs until there have been `target` collisions, and let the time of the draws pass."""
    while gas.counts[COLLISIONS] < target:
        draw(gas, material, rng)
    clock, number = gas.clock, len(gas.velocity)
    pairs = 0.5 * (number - 1)  # over the volume, with the density in `crowding`
    # half the surface of the sphere of contact, of two radii: a pair meets on half of it
    cross_section = 2.0 * math.pi if len(gas.axes) == 2 else 8.0 * math.pi
    draws = pairs * material.crowding * cross_section
    clock[TIME] += clock[WAITED] * math.exp(-clock[LOG_UNIT]) / draws
    clock[WAITED] = 0.0


@compiled
def draw(gas, material, rng):
    """Draw two particles and the normal of their contact, and let them collide or not."""
    number, clock = len(gas.velocity), gas.clock
    drawn = number * rng.random()
    i = int(drawn)
    # what is left of it has 53 bits less those of the number of particles: enough for another one
    j = int((drawn - i) * (number - 1))
    j += j >= i
    v = subtract(read(gas.velocity, i, 0, gas.axes), read(gas.velocity, j, 0, gas.axes))
    gas.counts[DRAWS] += 1
    clock[WAITED] += 1.0 / clock[MAJORANT]
    threshold = clock[MAJORANT] * rng.random()
    if dot(v, v) <= threshold * threshold:
        return  # whatever the normal
    n = random_direction(gas.axes, rng)
    speed = dot(v, n)
    clock[MAJORANT] = max(clock[MAJORANT], abs(speed))
    if abs(speed) > threshold:
        # from particle j to i, while they approach each other
        collide(gas, material, i, j, scale(n, -math.copysign(1.0, speed)), v)


@compiled
def collide(gas, material, i, j, n, v):
    """The contact of particles i and j, by the rule of the event-driven simulation."""
    axes, effects = gas.axes, material.effects
    w_i, w_j = spin_of(gas.spin, axes, i), spin_of(gas.spin, axes, j)
    both = material.restitution, material.roughness
    push, turn = response(effects.spin, effects, both, n, v, spin_sum(w_i, w_j), 0.5, None)
    write(gas.velocity, i, 0, subtract(read(gas.velocity, i, 0, axes), push))
    write(gas.velocity, j, 0, add_scaled(read(gas.velocity, j, 0, axes), push, 1.0))
    turn_spin(gas.spin, i, w_i, turn)
    turn_spin(gas.spin, j, w_j, turn)
    gas.counts[COLLISIONS] += 1


@compiled
def random_direction(axes, rng):
    """Return a unit vector, all directions being equally probable."""
    while True:
        x = _in_cube(axes, rng)
        square = dot(x, x)
        if 0.0 < square <= 1.0:
            return scale(x, 1.0 / math.sqrt(square))


@unrolled
def _in_cube(axes, rng):
    return tuple(2.0 * rng.random() - 1.0 for k in range(len(axes)))


@compiled
def take_sample(gas, row):
    """Sum over the particles; nothing is moved."""
    row[:] = 0.0
    row[0], row[1], row[2] = gas.clock[TIME], gas.counts[COLLISIONS], gas.clock[LOG_UNIT]
    for i in range(len(gas.velocity)):
        v, w = read(gas.velocity, i, 0, gas.axes), spin_of(gas.spin, gas.axes, i)
        vv, ww, vw = dot(v, v), dot(w, w), _along(v, w)
        row[3] += vv
        row[4] += ww
        row[5] += vv * vv
        row[6] += ww * ww
        row[7] += vv * ww
        row[8] += vw * vw


@unrolled
def _along(v, w):
    """Return v.w, which in the plane is 0."""
    if len(w) == 1:
        return 0.0
    else:
        return dot(v, w)


@compiled
def rescale(gas):
    """Remove the total momentum, which roundings leave, and undo the cooling: T_tr = 1."""
    square = 0.0
    for component in gas.velocity.T:
        component -= component.mean()
        for speed in component:
            square += speed**2
    factor = math.sqrt(gas.velocity.size / square)
    for scaled in (gas.velocity, gas.spin):
        scaled *= factor
    gas.clock[LOG_UNIT] -= math.log(factor)
