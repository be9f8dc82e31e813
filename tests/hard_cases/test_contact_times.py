"""When two particles meet.

The doubles that go in are exact numbers to the 50 digits that the times are compared with.
"""

import mpmath
import numpy as np
from compiled import from_python

from roughgas.kernel import prediction

time_to_contact = from_python(prediction.time_to_contact)


def exact(*vectors):
    """Vectors of doubles in mpmath's precision of the moment."""
    return ([mpmath.mpf(float(c)) for c in vector] for vector in vectors)


def closest(x, u):
    """Least distance of two paths, in a."""
    with mpmath.workdps(50):
        x, u = exact(x, u)
        time = -mpmath.fdot(x, u) / mpmath.fdot(u, u)
        return mpmath.sqrt(sum((a + b * time) ** 2 for a, b in zip(x, u, strict=True)))


def gap_at(x, u, time):
    """Gap of a pair after `time`, in a."""
    with mpmath.workdps(50):
        x, u = exact(x, u)
        distance = mpmath.sqrt(sum((a + b * time) ** 2 for a, b in zip(x, u, strict=True)))
        return float(distance - 2)


def approach(x, u):
    """Normal velocity with which a touching pair approaches, over its relative velocity."""
    with mpmath.workdps(50):
        return float(-mpmath.fdot(*exact(x, u))) / (2.0 * float(np.linalg.norm(u)))


def exact_time(x, u):
    """The first time at which two paths that meet do so."""
    with mpmath.workdps(50):
        x, u = exact(x, u)
        b, uu = mpmath.fdot(x, u), mpmath.fdot(u, u)
        return (-b - mpmath.sqrt(b * b - uu * (mpmath.fdot(x, x) - 4))) / uu


def directions(rng, dimension):
    """Two random unit vectors at a right angle."""
    return np.linalg.qr(rng.standard_normal((dimension, 2)))[0].T


def decades(rng, least, most):
    """A random number whose logarithm is uniform between these powers of ten."""
    return 10.0 ** rng.uniform(least, most)


def heading(rng, dimension, gap, impact):
    """A pair so far apart along its path that misses a head-on contact by 2 impact a.

    As tuples of doubles (x, u), the relative speed being anything from 1e-8 to 1e8 a/T.
    """
    along, across = directions(rng, dimension)
    behind = gap + 2.0 * np.sqrt(max(0.0, 1.0 - impact**2))
    return floats(2.0 * impact * across - behind * along), floats(decades(rng, -8, 8) * along)


def floats(vector):
    """A vector as the kernel takes it."""
    return tuple(map(float, vector))


def test_grazing(margins):
    """Bounds: three roundings of the distance between the paths, each 2^-53 of the distance."""
    rng = np.random.default_rng(1)
    pairs_tried = margins.size(quick=3000, full=100_000)
    missed = invented = 0.0
    for k in range(pairs_tried):
        distance = decades(rng, 0.5, 4)
        impact = 1.0 + 0.5 * rng.normal() * decades(rng, -17, -13)
        x, u = heading(rng, 2 + k % 2, distance, impact)
        depth = float(2 - closest(x, u)) / np.linalg.norm(x)
        if time_to_contact(x, u, 2.0) < np.inf:
            invented = max(invented, -depth)
        else:
            missed = max(missed, depth)
    tried = {"tried": pairs_tried, "unit": "pairs"}
    margins.at_most("depth of a missed contact, over the distance", missed, 4e-16, **tried)
    margins.at_most("gap of an invented contact, over the distance", invented, 4e-16, **tried)


def test_close_pairs(margins):
    """Where a pair is at the time predicted: gaps from 1e-14 to 1e-6 a, head-on or up to grazing.

    Bounds: what x.x is rounded by, at or just above 4, is at most 4 (in space 6) times 2^-52, and a
    gap is a quarter of x.x - 4; all else is as small as the gap.
    """
    rng = np.random.default_rng(2)
    pairs_tried = margins.size(quick=4000, full=100_000)
    error = [0.0, 0.0]
    for k in range(pairs_tried):
        impact = rng.uniform(0.0, 1.0) if rng.random() < 0.5 else 0.0
        x, u = heading(rng, 2 + k % 2, decades(rng, -14, -6), impact)
        error[k % 2] = max(error[k % 2], abs(gap_at(x, u, time_to_contact(x, u, 2.0))))
    tried = {"tried": pairs_tried // 2, "unit": "pairs"}
    margins.at_most("gap at the predicted time, in the plane [a]", error[0], 2.3e-16, **tried)
    margins.at_most("gap at the predicted time, in space [a]", error[1], 3.4e-16, **tried)


def test_far_pairs(margins):
    """Gaps from 1 to 1e4 a, with any impact parameter up to grazing.

    Bounds: x.x, x.u and x cross u are each rounded by one or two times 2^-53 of their largest
    terms. In the time itself an oblique impact divides these by the square of its cosine.
    """
    rng = np.random.default_rng(3)
    pairs_tried = margins.size(quick=4000, full=100_000)
    gap = relative = 0.0
    for k in range(pairs_tried):
        impact = rng.uniform(0.0, 0.9) if k % 4 > 1 else 1.0 - decades(rng, -9, -1)
        x, u = heading(rng, 2 + k % 2, decades(rng, 0, 4), impact)
        time = time_to_contact(x, u, 2.0)
        gap = max(gap, abs(gap_at(x, u, time)) / np.linalg.norm(x))
        if impact < 0.9:
            relative = max(relative, abs(float(time / exact_time(x, u) - 1)))
    tried = {"tried": pairs_tried, "unit": "pairs"}
    margins.at_most("gap at the predicted time, over the distance", gap, 8e-16, **tried)
    tried["tried"] //= 2
    margins.at_most(
        "relative error of the time, impact parameters to 0.9", relative, 1e-15, **tried
    )


def test_overlapping_pairs(margins):
    """Overlaps from 0 to 1e-10 a, and normal velocities down to 1e-17 of the relative one.

    An approach is told from a recession up to the rounding of x.u, at |x| = 2 a. A contact that is
    now leaves an overlap as it is; one that closes a gap is bounded as in test_close_pairs, and
    where it grazes, the discriminant adds as much again.
    """
    rng = np.random.default_rng(4)
    pairs_tried = margins.size(quick=10_000, full=100_000)
    lost = again = moved = 0.0
    for k in range(pairs_tried):
        n, across = directions(rng, 2 + k % 2)
        overlap = rng.choice([0.0, 1.0, 1.0]) * decades(rng, -17, -10)
        normal = rng.choice([-1.0, 1.0]) * decades(rng, -17, 0)
        x = floats((2.0 - overlap) * n)
        u = floats(decades(rng, -8, 8) * (normal * n + across))
        time, gap = time_to_contact(x, u, 2.0), gap_at(x, u, 0)
        if time < np.inf:
            moved = max(moved, abs(gap_at(x, u, time) - min(gap, 0.0)))
            again = max(again, -approach(x, u))
        elif gap <= 0.0:
            lost = max(lost, approach(x, u))
    tried = {"tried": pairs_tried, "unit": "pairs"}
    speed = "over the relative one"
    margins.at_most(f"normal velocity of a contact that is lost, {speed}", lost, 4e-16, **tried)
    margins.at_most(f"normal velocity of one that is repeated, {speed}", again, 4e-16, **tried)
    margins.at_most("gap at the contact, or change of the overlap [a]", moved, 7e-16, **tried)
