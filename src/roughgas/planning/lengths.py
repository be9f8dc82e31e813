"""How long a run must be: until the transient is over, and then to measure R well enough."""

import math

from roughgas.effects import inertia_of_spin
from roughgas.planning.pilot import Pilot
from roughgas.scene import Scene
from roughgas.simulation.cooling import TRANSIENT
from roughgas.theory import collisions_to_relax

FEWEST_SEEDS = 2
BIAS = 0.1  # share of the target that may be left of the transient
CARE = 1.3  # theory's relaxation is followed within a few per cent
RESERVE = 0.9  # share of the target that is aimed at: noise in the error would ask for more seeds


def relaxation(scene: Scene, tolerated: float, final: float, spin_share: float | None) -> float:
    """Return the collisions per particle until R, from 0, is within `tolerated` of `final`.

    By the rate equations of a gas heated with `spin_share`, None for one that cools; 0 if R stays
    where it is.
    """
    if final <= tolerated:
        return 0.0
    r, beta, inertia = scene.restitution, scene.roughness, inertia_of_spin(scene.effects)
    left = tolerated / float(final)
    needed = collisions_to_relax(r, beta, left, len(scene.box), inertia, spin_share)
    return min(CARE * float(needed), TRANSIENT[1])


def to_measure(spent: float, seeds: float, target: float, memories: float, pilot: Pilot) -> float:
    """Return how long to measure: as long as was spent before, but no longer than `seeds` need.

    In any case many times as long as R remembers.
    """
    needed = pilot.variance / (seeds * (RESERVE * target) ** 2)
    return max(min(spent, needed), memories * pilot.autocorrelation_time)


def whole(length: float, unit: float) -> float:
    """Return the length in whole units, at least twenty, and short in writing."""
    return round(unit * max(20, math.ceil(length / unit)), 9)
