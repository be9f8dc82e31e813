"""What is simulated: box, material and effects, and the state that it starts from."""

from roughgas.scene.composition import DIAMETER, Scene, build, is_closed
from roughgas.scene.initial import check, check_places, initial_state
from roughgas.scene.mixture import draw_bodies, for_theory, given_bodies, packing

__all__ = [
    "DIAMETER",
    "Scene",
    "build",
    "check",
    "check_places",
    "draw_bodies",
    "for_theory",
    "given_bodies",
    "initial_state",
    "is_closed",
    "packing",
]
