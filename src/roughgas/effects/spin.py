"""Rotation of the particles, which makes their roughness felt."""

from typing import NamedTuple

from roughgas.effects.settings import Number, read

SETTINGS = {"inertia": Number("q = I/(m a^2), 1/2 for disks and 2/5 for spheres.", "(0, 1]")}


class Spin(NamedTuple):
    """Particles spin, which makes their roughness felt."""

    inertia: float

    @classmethod
    def from_settings(cls, settings, around):
        """The effect; raises InputError for illegal parameters."""
        return cls(**read(SETTINGS, "spin", settings, around))
