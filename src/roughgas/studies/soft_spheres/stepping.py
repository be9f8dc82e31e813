"""Soft spheres stepped through time, and sampled."""

import math

from roughgas.kernel.jit import compiled, entry, jit
from roughgas.kernel.vectors import dot, read, subtract
from roughgas.studies.soft_spheres.contacts import act
from roughgas.studies.soft_spheres.gas import CONTACTS, DIAMETER, FASTEST, PAIRS, TRAVELLED
from roughgas.studies.soft_spheres.neighbours import keep_list, squares, survey

COLUMNS = ("vv", "ww", "contacts")
"""What `step` fills in: sums of v^2 and (a w)^2 over the particles, and contacts begun so far."""


@entry(cache=True)
def step(gas, spheres, dt, steps, temperature, rows):
    """Make `steps` steps of dt (T) for each of the rows, and fill these (see COLUMNS).

    After each row momentum is removed and all velocities are scaled so that m <v^2>/D is
    `temperature` (m a^2/T^2); 0 leaves the gas as it is. Returns the number of rows filled: fewer
    if the particles were so crowded that the list of neighbours was full.
    """
    for k in range(len(rows)):
        if not _advance(gas, spheres, dt, steps):
            return k
        rows[k, 0], rows[k, 1] = squares(gas.velocity), squares(gas.spin)
        rows[k, 2] = gas.counts[CONTACTS]
        if temperature > 0.0:
            _rescale(gas, temperature)
    return len(rows)


@jit
def _advance(gas, spheres, dt, steps):
    """Flights and the springs' action in turn; half a flight first and last. Second order."""
    half = 0.5 * dt
    for k in range(steps):
        _fly(gas, dt if k > 0 else half)
        if not keep_list(gas, spheres, half):
            return False
        _act_all(gas, spheres, half)
    _fly(gas, half)
    return True


@jit
def _fly(gas, time):
    position, velocity = gas.position.reshape(-1), gas.velocity.reshape(-1)
    for k in range(len(position)):
        position[k] += velocity[k] * time
    gas.reach[TRAVELLED] += gas.reach[FASTEST] * time


@jit
def _act_all(gas, spheres, half):
    """The springs of all pairs that may overlap within +-half."""
    box = spheres.box
    near = (DIAMETER + 2.0 * gas.reach[FASTEST] * half) ** 2
    for p in range(gas.counts[PAIRS]):
        x = subtract(
            read(gas.position, gas.pair[p, 0], 0, box), read(gas.position, gas.pair[p, 1], 0, box)
        )
        x = subtract(x, read(gas.image, p, 0, box))
        if dot(x, x) < near or gas.touching[p]:
            act(gas, spheres, p, x, half)


@compiled
def _rescale(gas, temperature):
    """Contacts under way are scaled with the rest, but for their overlap."""
    for component in gas.velocity.T:
        component -= component.mean()
    factor = math.sqrt(gas.velocity.size * temperature / squares(gas.velocity))
    for scaled in (gas.velocity, gas.spin, gas.stretch[: gas.counts[PAIRS]]):
        scaled *= factor
    survey(gas)
