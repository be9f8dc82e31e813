"""Uniform gravity along the last axis."""

from typing import NamedTuple

from roughgas.effects.settings import Number, read
from roughgas.kernel.jit import jit

SETTINGS = {"acceleration": Number("g, in a/T^2.")}


class Gravity(NamedTuple):
    """Uniform gravity along the last axis, downwards."""

    acceleration: float

    @classmethod
    def from_settings(cls, settings, around):
        """The effect; raises InputError for illegal parameters."""
        return cls(**read(SETTINGS, "gravity", settings, around))


@jit
def acceleration(gravity, index, none):
    return gravity.acceleration
