"""A second, slow simulation of the same physics, and the means to run it beside the kernel."""

from brute_force.beside import Beside, compare, largest_overlap, snapshot
from brute_force.scenes import KERNELS, begin, kernels, run, scene_of, settings
from brute_force.simulation import BruteForce
from brute_force.world import Event, Snapshot, World

__all__ = ["KERNELS", "Beside", "BruteForce", "Event", "Snapshot", "World", "begin", "compare"]
__all__ += ["kernels", "largest_overlap", "run", "scene_of", "settings", "snapshot"]
