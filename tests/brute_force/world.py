"""What the brute force simulates, and what it tells."""

from typing import NamedTuple

import numpy as np

from brute_force.company import Company, Contents
from brute_force.kicks import Drive
from brute_force.sides import Side


class World(NamedTuple):
    """What is simulated; None and 0 stand for what is absent."""

    box: tuple[float | None, ...]  # periods; None is open, or closed by walls
    r: float
    beta: float
    q: float | None  # None: particles do not spin
    mu: float | None = None  # coefficient of friction; None: contacts never slide
    thermostat: tuple[float, float, float] | None = None  # power, share of spin, interval
    bath: dict | None = None  # settings of a Langevin bath, and whether it has noise
    gravity: float = 0.0  # along the last axis
    floor: tuple[float, float, float, float] | None = None  # amplitude, period, r, beta
    walls: tuple[float, float, float] | None = None  # width, r, beta; along the first axis
    shaken: tuple[float, float] | None = None  # amplitude, period of these walls' displacement
    shear: float = 0.0  # U: velocity, along the first axis, of the image above along the second
    slide: float = 0.0  # how far that image has slid at time 0
    contact_time: float = 0.0
    wave: str = "sawtooth"  # of the floor
    contents: Contents | None = None  # None: one species
    sides: tuple[Side, ...] = ()  # walls on single sides of the box
    viscous: float = 0.0  # normal speed at which viscoelastic contacts have their r; 0: not so
    table: tuple[list, list, float] | None = None  # speeds, restitutions, speed at which r is r
    power: tuple[float, float, float] | None = None  # speed at which r is r, exponent, least r
    threshold: tuple[float, float] | None = None  # slower contacts have this restitution, or more


class Snapshot(NamedTuple):
    """All particles at one instant."""

    time: float  # absolute
    position: np.ndarray  # (N, D), in any image
    velocity: np.ndarray
    spin: np.ndarray | None  # (N, 2D - 3)
    drive: Drive | None = None
    company: Company | None = None  # None: all particles are alike
    word: int = 0  # state of the random generator, where there is one


class Event(NamedTuple):
    time: float
    kind: str  # pair, floor, left, right, kick
    i: int
    j: int  # -1: none
