"""The scene that the brute force simulates, its snapshots and its events."""

from typing import NamedTuple

import numpy as np

from brute_force.bodies import Bodies, Mixture
from brute_force.kicks import Drive
from brute_force.sides import Side


class World(NamedTuple):
    """The scene of a simulation; None and 0 stand for absent effects."""

    box: tuple[float | None, ...]  # periods; None is open, or closed by walls
    r: float
    beta: float
    q: float | None  # None: particles do not spin
    mu: float | None = None  # coefficient of friction; None: contacts never slide
    thermostat: dict | None = None  # settings of random kicks
    bath: dict | None = None  # settings of a Langevin bath, and whether it has noise
    delta: float = 0.0  # half the normal speed that contacts of pairs gain
    acceleration: tuple[float, ...] = ()  # of gravity along each axis; empty without gravity
    floor: tuple[float, float, float, float] | None = None  # amplitude, period, r, beta
    walls: tuple[float, float, float] | None = None  # width, r, beta; along the first axis
    shaken: tuple[float, float] | None = None  # amplitude, period of these walls' displacement
    shear: float = 0.0  # U: velocity, along the first axis, of the image above along the second
    slide: float = 0.0  # displacement of this image at time 0
    contact_time: float = 0.0
    wave: str = "sawtooth"  # of the floor
    mixture: Mixture | None = None  # None: one species
    sides: tuple[Side, ...] = ()  # walls on single sides of the box
    viscous: float = 0.0  # reference speed of viscoelastic contacts; 0: r is constant
    table: tuple[list, list, float] | None = None  # speeds, restitutions, reference speed
    power: tuple[float, float, float] | None = None  # reference speed, exponent, lowest r
    roughness_power: tuple[float, float] | None = None  # reference speed, exponent
    threshold: tuple[float, float] | None = (
        None  # speed, and restitution that slower contacts have at least
    )

    @property
    def gravity(self):
        """Downward acceleration along the last axis."""
        return -self.acceleration[-1] if self.acceleration else 0.0

    def fall(self, time):
        """Velocity (D,) that gravity gives a particle at rest in a time."""
        return np.array(self.acceleration or [0.0] * len(self.box)) * time


class Snapshot(NamedTuple):
    """All particles at an instant."""

    time: float  # absolute
    position: np.ndarray  # (N, D), in any image
    velocity: np.ndarray
    spin: np.ndarray | None  # (N, 2D - 3)
    drive: Drive | None = None
    bodies: Bodies | None = None  # None: all particles are identical
    word: int = 0  # state of the random generator; 0 without one


class Event(NamedTuple):
    """An event of a simulation."""

    time: float
    kind: str  # pair, floor, left, right, kick, or the name of a wall
    i: int
    j: int  # -1 but in events of pairs
