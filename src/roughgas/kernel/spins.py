"""Spins of the particles, as surface velocities a w; in a scene without spin all of this is None.

A spin has one component in the plane, three in space.
"""

from roughgas.kernel.bodies import spin_mass_of
from roughgas.kernel.hooks import unless_absent
from roughgas.kernel.unroll import unrolled
from roughgas.kernel.vectors import add_scaled, dot, write


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
