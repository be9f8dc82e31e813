"""Uniform gravity along the last axis."""

from typing import NamedTuple

from roughgas.effects.settings import Number, register
from roughgas.kernel.jit import jit

SETTINGS = {"acceleration": Number("g, in a/T^2.", "[1e-06, 1e+06]")}


class Gravity(NamedTuple):
    """Uniform gravity along the last axis, downwards."""

    acceleration: float


@jit
def acceleration(gravity, index, none):
    return gravity.acceleration


register(Gravity, SETTINGS, acceleration=acceleration)
