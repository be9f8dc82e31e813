"""When two particles meet.

References are computed in 50 digits from the exact values of the same doubles.
"""

import mpmath
import numpy as np
import pytest
from compiled import from_python

from roughgas.kernel import prediction

time_to_contact = from_python(prediction.time_to_contact)


def exact(*vectors):
    """Vectors of doubles as lists of mpmath numbers."""
    return ([mpmath.mpf(float(c)) for c in vector] for vector in vectors)


def closest(x, u):
    """Smallest distance of two paths, in a."""
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
    """Normal velocity of approach of a touching pair, over its relative velocity."""
    with mpmath.workdps(50):
        return float(-mpmath.fdot(*exact(x, u))) / (2.0 * float(np.linalg.norm(u)))


def exact_time(x, u):
    """The time of the first contact of two paths that meet."""
    with mpmath.workdps(50):
        x, u = exact(x, u)
        b, uu = mpmath.fdot(x, u), mpmath.fdot(u, u)
        return (-b - mpmath.sqrt(b * b - uu * (mpmath.fdot(x, x) - 4))) / uu


def directions(rng, dimension):
    """Two random unit vectors at a right angle."""
    return np.linalg.qr(rng.standard_normal((dimension, 2)))[0].T


def decades(rng, lowest, highest):
    """A random number, log-uniform between these powers of ten."""
    return 10.0 ** rng.uniform(lowest, highest)


def heading(rng, dimension, gap, impact):
    """Relative position x and velocity u, tuples, of a pair with this gap along its path and with
    an impact parameter of 2 impact a.

    The relative speed is between 1e-8 and 1e8 a/T.
    """
    along, across = directions(rng, dimension)
    behind = gap + 2.0 * np.sqrt(max(0.0, 1.0 - impact**2))
    return floats(2.0 * impact * across - behind * along), floats(decades(rng, -8, 8) * along)


def floats(vector):
    """A vector as a tuple of doubles."""
    return tuple(map(float, vector))


def test_grazing_contacts_are_neither_missed_nor_invented(margins):
    """Bounds: three roundings of the distance between the particles, each 2^-53 of it."""
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


def test_close_pairs_touch_at_the_predicted_time(margins):
    """Gaps at the predicted time, of pairs 1e-14 to 1e-6 a apart, head-on or up to grazing.

    Bounds: x.x, at or just above 4, is rounded by at most 4 (in space 6) times 2^-52, and a gap is
    a quarter of x.x - 4; all other errors are as small as the gap.
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


def test_far_pairs_touch_at_the_predicted_time(margins):
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


@pytest.mark.slow
def test_overlapping_pairs_touch_if_they_approach(margins):
    """Overlaps from 0 to 1e-10 a, and normal velocities down to 1e-17 of the relative one.

    Approach and recession are distinguished up to the rounding of x.u, at |x| = 2 a. A contact at
    once does not change the overlap; a contact that closes a gap is bounded as in
    test_close_pairs_touch_at_the_predicted_time, and if it grazes, the discriminant doubles this.
    """
    rng = np.random.default_rng(4)
    pairs_tried = margins.size(quick=10_000, full=100_000)
    missed = repeated = displaced = 0.0
    for k in range(pairs_tried):
        n, across = directions(rng, 2 + k % 2)
        overlap = rng.choice([0.0, 1.0, 1.0]) * decades(rng, -17, -10)
        normal = rng.choice([-1.0, 1.0]) * decades(rng, -17, 0)
        x = floats((2.0 - overlap) * n)
        u = floats(decades(rng, -8, 8) * (normal * n + across))
        time, gap = time_to_contact(x, u, 2.0), gap_at(x, u, 0)
        if time < np.inf:
            displaced = max(displaced, abs(gap_at(x, u, time) - min(gap, 0.0)))
            repeated = max(repeated, -approach(x, u))
        elif gap <= 0.0:
            missed = max(missed, approach(x, u))
    tried = {"tried": pairs_tried, "unit": "pairs"}
    speed = "over the relative one"
    margins.at_most(f"normal velocity of a contact that is lost, {speed}", missed, 4e-16, **tried)
    margins.at_most(f"normal velocity of one that is repeated, {speed}", repeated, 4e-16, **tried)
    margins.at_most("gap at the contact, or change of the overlap [a]", displaced, 7e-16, **tried)
