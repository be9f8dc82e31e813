"""Rotation of the particles, which makes their roughness felt."""

from typing import NamedTuple

from roughgas.effects.settings import Number, register

SETTINGS = {"inertia": Number("q = I/(m a^2), 1/2 for disks and 2/5 for spheres.", "[1e-06, 1]")}


class Spin(NamedTuple):
    """Particles spin; rough contacts exchange energy between translation and rotation."""

    inertia: float


register(Spin, SETTINGS)
