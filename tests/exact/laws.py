"""Restitution that depends on the normal speed, in fifty digits."""

from decimal import Decimal

ABOVE = (Decimal("2.583"), Decimal(1))  # of the Pade approximation, highest power first
BELOW = tuple(map(Decimal, ("0.326", "1.148", "2.983", "3.583", "1")))


def restitution(world, r, speed):
    """Return the restitution of a contact at a normal speed, from the restitution of its
    material."""
    if world.viscous and 0 < r < 1 and speed > 0:
        ratio = speed / Decimal(world.viscous)
        r = _pade(_x_of(r) * ratio ** Decimal("0.2"))
    if world.table:
        speeds, values = (tuple(map(Decimal, column)) for column in world.table[:2])
        loss, reference_loss = (
            1 - _between(speeds, values, v) for v in (speed, Decimal(world.table[2]))
        )
        r = max(Decimal(0), 1 - (1 - r) * loss / reference_loss)
    if world.threshold and speed < Decimal(world.threshold[0]):
        r = max(r, Decimal(world.threshold[1]))
    return r


def _pade(x):
    return _value(ABOVE, x) / _value(BELOW, x)


def _value(coefficients, x):
    total = Decimal(0)
    for coefficient in coefficients:
        total = total * x + coefficient
    return total


def _x_of(r):
    """Return the x at which the Pade approximation, which decreases, equals r, by bisection."""
    low, high = Decimal(0), Decimal(1)
    while _pade(high) > r:
        high *= 2
    for _ in range(170):  # to 2^-170, fifty digits
        middle = (low + high) / 2
        low, high = (middle, high) if _pade(middle) > r else (low, middle)
    return low


def _between(at, values, x):
    """Interpolate linearly between the values, with constants beyond them."""
    if x <= at[0]:
        return values[0]
    for k in range(1, len(at)):
        if x < at[k]:
            share = (x - at[k - 1]) / (at[k] - at[k - 1])
            return values[k - 1] + share * (values[k] - values[k - 1])
    return values[-1]
