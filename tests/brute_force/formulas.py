"""Textbook roots, roots that are looked for, and Coulomb's friction."""

import math

import numpy as np

INSTANTS = np.linspace(0.0, 1.0, 2001) ** 2  # at which what has no formula is looked for


def first_touch(gap, limit):
    """First time before `limit` at which a gap, as a function of time, closes; of arrays, too."""
    times = limit * INSTANTS
    closed = np.flatnonzero(gap(times[1:]) < 0.0)
    if len(closed) == 0:
        return math.inf
    above, below = times[closed[0]], times[closed[0] + 1]
    for _ in range(60):
        middle = 0.5 * (above + below)
        above, below = (above, middle) if gap(middle) < 0.0 else (middle, below)
    return below


def meeting_times(x, v, reach):
    """First root of |x + v t| = reach for each pair, if it approaches; overlapping is now."""
    b, vv, c = (x * v).sum(axis=-1), (v * v).sum(axis=-1), (x * x).sum(axis=-1) - reach**2
    discriminant = b * b - vv * c
    with np.errstate(invalid="ignore", divide="ignore"):
        root = np.maximum(0.0, (-b - np.sqrt(discriminant)) / vv)
    return np.where((b < 0.0) & (discriminant >= 0.0), root, np.inf)


def falling_time(gap, speed, gravity):
    """First time at which gap + speed t - gravity t^2/2 vanishes, from above."""
    if gap <= 1e-12 and speed < 0.0:
        return 0.0
    return (speed + math.sqrt(speed * speed + 2.0 * gravity * max(gap, 0.0))) / gravity


def cut_by_friction(mu, push, along):
    """The tangential impulse that would stick, cut to mu times the normal one if that is less."""
    if mu is None:
        return along
    most, size = mu * math.sqrt(push @ push), math.sqrt(along @ along)
    return along * (most / size) if size > most else along


def viscoelastic(r, speed, reference):
    """Restitution at a normal speed of what has r at the reference, 0 < r < 1: Ramirez et al. 1999.

    The root of a polynomial, and a power; the kernel has neither.
    """
    above, below = [2.583, 1.0], [0.326, 1.148, 2.983, 3.583, 1.0]
    roots = np.roots(np.polysub(np.multiply(r, below), above))
    (x,) = roots[(abs(roots.imag) < 1e-9) & (roots.real > 0.0)].real
    x *= (speed / reference) ** 0.2
    return np.polyval(above, x) / np.polyval(below, x)


def tabulated(r, speed, speeds, restitutions, reference):
    """Restitution at a normal speed of what has r at the reference, 1 - r going as the table's."""
    lost, whole = (1.0 - np.interp(v, speeds, restitutions) for v in (speed, reference))
    return max(0.0, 1.0 - (1.0 - r) * lost / whole)


def falling(r, speed, reference, exponent, least):
    """Restitution at a normal speed of what has r at the reference: Bizon et al. 1998."""
    return max(least if r > least else r, 1.0 - (1.0 - r) * (speed / reference) ** exponent)


def in_space(vector):
    """A vector in the plane or in space as one in space."""
    full = np.zeros(3)
    full[: len(vector)] = vector
    return full
