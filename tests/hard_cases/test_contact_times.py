"""When two particles meet."""

import mpmath
import numpy as np
from compiled import from_python

from hard_cases.catalogue import hard_case
from roughgas.kernel import pairs

time_to_contact = from_python(pairs.time_to_contact)


def closest(x, u):
    """Least distance of two paths in 50 digits, in a."""
    with mpmath.workdps(50):
        x, u = ([mpmath.mpf(float(c)) for c in vector] for vector in (x, u))
        time = -mpmath.fdot(x, u) / mpmath.fdot(u, u)
        return mpmath.sqrt(sum((a + b * time) ** 2 for a, b in zip(x, u, strict=True)))


@hard_case(
    "grazing contacts",
    "a discriminant within rounding of zero takes the wrong sign: particles pass through each "
    "other, or collide without having met",
)
def test_grazing(margins):
    rng = np.random.default_rng(1)
    pairs_tried = margins.size(quick=2000, full=100_000)
    missed = invented = 0.0
    for _ in range(pairs_tried):
        angle, distance = rng.uniform(0, 2 * np.pi), 10.0 ** rng.uniform(0.5, 2)
        direction, across = (np.cos(angle), np.sin(angle)), (-np.sin(angle), np.cos(angle))
        miss = 2.0 + rng.normal() * 10.0 ** rng.uniform(-17, -13)
        x = tuple(-distance * d + miss * c for d, c in zip(direction, across, strict=True))
        depth = float(2 - closest(x, direction)) / distance
        if time_to_contact(x, direction) < np.inf:
            invented = max(invented, -depth)
        else:
            missed = max(missed, depth)
    tried = {"tried": pairs_tried, "unit": "pairs"}
    margins.at_most("depth of a missed contact, over the distance", missed, 1e-15, **tried)
    margins.at_most("gap of an invented contact, over the distance", invented, 1e-15, **tried)


def test_without_the_cross_product(without):
    without(
        "a discriminant from the cross product",
        test_grazing,
        "kernel/pairs.py",
        "discriminant = DIAMETER * DIAMETER * dot(u, u) - cross_squared(x, u)",
        "discriminant = b * b - dot(u, u) * c",
    )
