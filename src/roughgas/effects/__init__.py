"""What a scene can be made of: one file an effect, each named once, here.

The order is that in which effects act where several have a say (see kernel/hooks.py).
"""

from typing import NamedTuple

from roughgas.effects.contact_time import ContactTime
from roughgas.effects.floor import Floor
from roughgas.effects.gravity import Gravity
from roughgas.effects.shear import Shear
from roughgas.effects.spin import Spin
from roughgas.effects.walls import Walls


class Effects(NamedTuple):
    """The effects of a scene; None is an effect that the scene does without."""

    spin: Spin | None = None
    gravity: Gravity | None = None
    floor: Floor | None = None
    walls: Walls | None = None
    shear: Shear | None = None
    contact_time: ContactTime | None = None
