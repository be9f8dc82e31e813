"""What is simulated: box, material and effects, and the state that it starts from."""

from roughgas.scene.check import check
from roughgas.scene.composition import DIAMETER, Scene, build, check_company, is_closed
from roughgas.scene.initial import initial_state

__all__ = ["DIAMETER", "Scene", "build", "check", "check_company", "initial_state", "is_closed"]
