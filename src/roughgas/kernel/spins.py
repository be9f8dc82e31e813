"""Spins of the particles, as surface velocities a w; in a scene without spin all of this is None.

One component in the plane, three in space.
"""

from numba.extending import overload

from roughgas.kernel.hooks import unless_absent
from roughgas.kernel.vectors import add_scaled, dot, read, write


def _axes(box):
    return (0.0,) * (2 * len(box) - 3)


@overload(_axes)
def _compiled_axes(box):
    axes = (0.0,) * (2 * len(box) - 3)
    return lambda box: axes


@unless_absent
def spin_of(spin, box, i):
    """Spin of particle i."""
    return read(spin, i, 0, _axes(box))


@unless_absent
def spin_sum(a, b):
    """Sum of two spins, which is what the contact velocity depends on."""
    return add_scaled(a, b, 1.0)


@unless_absent
def turn_spin(spin, i, before, turn):
    """Store particle i's spin after a contact."""
    write(spin, i, 0, add_scaled(before, turn, 1.0))


@unless_absent
def book_spin(before, turn, effect, account):
    """Enter the rotational energy gained, q [w.dw + dw.dw/2], in an account of the ledger."""
    account[1] += effect.inertia * (dot(before, turn) + 0.5 * dot(turn, turn))
