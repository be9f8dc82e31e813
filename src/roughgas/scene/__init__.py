"""What is simulated: box, material and effects, and the state that it starts from."""

from roughgas.effects.species import packing
from roughgas.scene.initial import bounds, check, check_places, initial_state
from roughgas.scene.scene import (
    DIAMETER,
    Scene,
    build,
    closed_axes,
    draw_bodies,
    elastic,
    for_theory,
    given_bodies,
    has_sides,
    moves_along,
    shear_rate,
)

__all__ = [
    "DIAMETER",
    "Scene",
    "bounds",
    "build",
    "check",
    "check_places",
    "closed_axes",
    "draw_bodies",
    "elastic",
    "for_theory",
    "given_bodies",
    "has_sides",
    "initial_state",
    "moves_along",
    "packing",
    "shear_rate",
]
