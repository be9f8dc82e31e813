"""Rotation of the particles, which makes their roughness felt."""

from typing import NamedTuple

from roughgas.effects.settings import number


class Spin(NamedTuple):
    """Particles that spin."""

    inertia: float  # q = I/(m a^2): 1/2 for disks, 2/5 for spheres

    @classmethod
    def from_settings(cls, settings, around):
        return cls(number(settings, "spin", "inertia", "(0, 1]"))
