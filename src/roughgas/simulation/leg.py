"""Legs: consecutive sections of a run, each with one way of sampling and one scene."""

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from roughgas.kernel.record import Sampling
from roughgas.scene import Scene
from roughgas.simulation.gas import Gas

UNTIL_IT_ENDS = 2**62  # samples of a leg whose `sampling` function ends it
Changes = Mapping[str, np.ndarray]
"""Arrays by name that describe the changes at the beginning of a leg."""


class Leg(NamedTuple):
    """A stretch of a run with one sampling and one scene; a protocol lists the legs of each gas."""

    name: str
    sampling: Sampling | Callable[[Gas], Sampling | None]  # a function is called before each
    # sample, and returns None at the end of the leg
    samples: int
    scene: Scene
    begin: Callable[[Gas], Changes] | None = None  # changes the gas before the first sample
    timed: bool = False  # whether a gas whose sample has too many collisions is jammed
    preparation: bool = False  # whether its samples are not samples of the run
