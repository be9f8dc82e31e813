"""Uniform gravity along the last axis."""

from typing import NamedTuple

from roughgas.effects.settings import number
from roughgas.kernel.jit import jit


class Gravity(NamedTuple):
    """Gravity, pointing down the last axis."""

    acceleration: float  # g > 0, in a/T^2

    @classmethod
    def from_settings(cls, settings, around):
        return cls(number(settings, "gravity", "acceleration"))


@jit
def acceleration(gravity, index, none):
    return gravity.acceleration
