"""Uniform shear through Lees-Edwards boundaries.

The box is periodic; its image above (along the second axis) moves along the first axis at the
velocity U, the one below at -U. What leaves at the top enters at the bottom with U less.

This is where the shear does its work: on particles that cross the boundary, and in contacts across
it, where the impulses on the two partners are opposite but the velocities at which they act differ.
"""

from typing import NamedTuple

from roughgas.base import NeedsError
from roughgas.effects.settings import Number, register
from roughgas.kernel.jit import jit

SETTINGS = {
    "velocity": Number("Velocity U of the images above relative to the box, in a/T.", "(0, 10000]")
}


class Shear(NamedTuple):
    """Lees-Edwards boundaries: images along the second axis slide along the first."""

    velocity: float
    length: float  # of the box along the first axis, in a

    @classmethod
    def from_settings(cls, settings, around):
        """Return the effect; raise InputError for a box that is not periodic."""
        if None in around.box[:2]:
            raise NeedsError("effects.shear", "a box periodic in both directions")
        return cls(**settings, length=around.box[0])


@jit
def phase(shear, index, base):
    """Return the offset of the image above at absolute time `base`, from 0 to L."""
    return shear.velocity * (base % (shear.length / abs(shear.velocity)))


@jit
def transfer(shear, index, none, state, work):
    state.ledger[0, index, 0] += work


@jit
def sliding(shear, index, none, state):
    return state.phase[index], shear.velocity


def displacement(shear, time):
    """Return the offset of the image above at `time`, from 0 to L, in a."""
    return (shear.velocity * time) % shear.length


register(
    Shear,
    SETTINGS,
    sliding=sliding,
    transfer=transfer,
    phase=phase,
    displacement=displacement,
    drives=True,
)
