"""Uniform gravity, downwards or in any direction: beds, tilted beds, chutes and channels.

Gravity accelerates all particles alike, so that it drops out of their relative motion. Along an
axis that is closed, or that ends at a floor, it has a potential, which counts as energy of
translation. Along a periodic axis it has none: a particle that falls through the box enters it anew
at the height of its image, and the difference of the potential energies is the work of the force,
an energy input. Along such an axis the momentum of N particles grows by N m g per time, unless
walls or a bath take it away.
"""

import math
from typing import Annotated, NamedTuple

from roughgas.base import InputError, NeedsError
from roughgas.base.fields import Settings, number, numbers
from roughgas.compiling.jit import jit
from roughgas.effects.drives import transfer
from roughgas.effects.settings import register
from roughgas.effects.walls import SIDES

Direction = Annotated[
    tuple[Annotated[float, number("[-1e+06, 1e+06]")], ...],
    numbers(2, 3, "Vector of any length along which it acts; down the last axis if not given."),
]


class GravitySettings(Settings, frozen=True, kw_only=True):
    """Settings of `gravity`."""

    acceleration: Annotated[float, number("[1e-06, 1e+06]", "g, in a/T^2.")]
    direction: Direction | None = None


class Gravity(NamedTuple):
    """Uniform gravity, down the last axis or in another direction."""

    components: tuple[float | None, ...]  # of the acceleration along each axis, a/T^2; None is 0

    @property
    def acceleration(self) -> float:
        """The magnitude of the acceleration, in a/T^2."""
        return math.hypot(*(component or 0.0 for component in self.components))

    @property
    def direction(self) -> list[float]:
        """The unit vector along which it acts."""
        return [(component or 0.0) / self.acceleration for component in self.components]

    @property
    def along(self) -> dict[int, float]:
        """The components of the acceleration that are not 0, by axis, in a/T^2."""
        return {axis: value for axis, value in enumerate(self.components) if value is not None}

    @classmethod
    def from_settings(cls, settings, context):
        """Return the effect, or a BodyForce, from GravitySettings and a SceneContext.

        Raises InputError for a direction that the box does not have, and without a direction where
        there is no floor to fall onto.
        """
        if settings.direction is None and "floor" not in context.effects:
            raise NeedsError("effects.gravity", "a floor")
        force = cls(_components(settings, len(context.box)))
        closed = _closed_axes(context)
        return force if force.along.keys() <= closed else BodyForce(force.components)


class BodyForce(Gravity):
    """Gravity with a component along a periodic axis, where its work is an energy input."""


def _components(settings, dimension):
    """Return the components of the acceleration along each axis, in a/T^2; None where it vanishes.

    Raises InputError for a direction of another dimension, or of length zero.
    """
    key, direction = "effects.gravity.direction", settings.direction
    if direction is None:
        direction = (0.0,) * (dimension - 1) + (-1.0,)
    if len(direction) != dimension:
        raise InputError(key, list(direction), f"have {dimension} entries, as the box has")
    if not any(direction):
        raise InputError(key, list(direction), "have an entry that is not 0")
    length = math.hypot(*direction)
    return tuple(settings.acceleration * (d / length) if d else None for d in direction)


def _closed_axes(context):
    """Return the axes of a SceneContext, from 0, that walls or a floor close."""
    axes = {"walls": 0, "shaken_walls": 0, "floor": -1}
    axes |= {name: axis for name, (axis, _) in SIDES.items()}
    return {axis % len(context.box) for name, axis in axes.items() if name in context.effects}


@jit
def acceleration(gravity, account):
    """Return the components of the acceleration along each axis, in a/T^2; None stands for 0.

    Hook `acceleration` (kernel.hooks), which does without the account.
    """
    return gravity.components


register(Gravity, GravitySettings, acceleration=acceleration)
register(BodyForce, acceleration=acceleration, transfer=transfer, drives=True)
