"""Times of contact by textbook roots and by search, Coulomb friction, and laws of restitution."""

import math

import numpy as np

SEARCH_TIMES = np.linspace(0.0, 1.0, 2001) ** 2  # in units of the limit


def first_touch(gap, limit):
    """The first time before `limit` when gap(time) closes; inf if none. `gap` takes arrays, too."""
    times = limit * SEARCH_TIMES
    closed = np.flatnonzero(gap(times[1:]) < 0.0)
    if len(closed) == 0:
        return math.inf
    earlier, later = times[closed[0]], times[closed[0] + 1]
    for _ in range(60):
        middle = 0.5 * (earlier + later)
        earlier, later = (earlier, middle) if gap(middle) < 0.0 else (middle, later)
    return later


def meeting_times(x, v, distance):
    """First root of |x + v t| = distance for each pair; inf if it recedes, 0 if it overlaps."""
    b, vv, c = (x * v).sum(axis=-1), (v * v).sum(axis=-1), (x * x).sum(axis=-1) - distance**2
    discriminant = b * b - vv * c
    with np.errstate(invalid="ignore", divide="ignore"):
        root = np.maximum(0.0, (-b - np.sqrt(discriminant)) / vv)
    return np.where((b < 0.0) & (discriminant >= 0.0), root, np.inf)


def falling_time(gap, speed, gravity):
    """The first time when gap + speed t - gravity t^2/2 vanishes from above."""
    if gap <= 1e-12 and speed < 0.0:
        return 0.0
    return (speed + math.sqrt(speed * speed + 2.0 * gravity * max(gap, 0.0))) / gravity


def cut_by_friction(mu, normal, tangential):
    """The tangential impulse of a sticking contact, cut to mu times the normal impulse."""
    if mu is None:
        return tangential
    limit, size = mu * math.sqrt(normal @ normal), math.sqrt(tangential @ tangential)
    return tangential * (limit / size) if size > limit else tangential


def viscoelastic_restitution(r, speed, reference):
    """Restitution at a normal speed of material with r at the reference speed, 0 < r < 1.

    Ramirez et al. (1999). It takes the root of a polynomial and a power; the kernel uses neither.
    """
    numerator, denominator = [2.583, 1.0], [0.326, 1.148, 2.983, 3.583, 1.0]
    roots = np.roots(np.polysub(np.multiply(r, denominator), numerator))
    (x,) = roots[(abs(roots.imag) < 1e-9) & (roots.real > 0.0)].real
    x *= (speed / reference) ** 0.2
    return np.polyval(numerator, x) / np.polyval(denominator, x)


def tabulated_restitution(r, speed, speeds, restitutions, reference):
    """Restitution at a normal speed of material with r at the reference; 1 - r scales a table."""
    loss, reference_loss = (1.0 - np.interp(v, speeds, restitutions) for v in (speed, reference))
    return max(0.0, 1.0 - (1.0 - r) * loss / reference_loss)


def power_law_restitution(r, speed, reference, exponent, lowest):
    """Restitution at a normal speed of material with r at the reference: Bizon et al. 1998."""
    return max(lowest if r > lowest else r, 1.0 - (1.0 - r) * (speed / reference) ** exponent)


def in_three_dimensions(vector):
    """A vector of two or three components, padded with zeros to three."""
    padded = np.zeros(3)
    padded[: len(vector)] = vector
    return padded
