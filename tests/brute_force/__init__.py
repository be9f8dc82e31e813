"""A second, slow simulation of the same physics, and its comparison with the kernel."""

from brute_force.comparison import Comparison, compare, largest_overlap, snapshot
from brute_force.scenes import KERNELS, PLAIN, begin, kernels, refresh, run, scene_of, settings
from brute_force.simulation import BruteForce
from brute_force.world import Event, Snapshot, World

__all__ = [
    "KERNELS",
    "PLAIN",
    "BruteForce",
    "Comparison",
    "Event",
    "Snapshot",
    "World",
    "begin",
    "compare",
]
__all__ += ["kernels", "largest_overlap", "refresh", "run", "scene_of", "settings", "snapshot"]
