"""A thermal floor under an open bed: particles leave it as if from a gas at its temperature.

The effect gives the scene's `floor`, which has to be at rest, a temperature. It has the floor's
events, to the bit, and acts before it, so that the floor itself is never met.
"""

import roughgas
from roughgas.base import InputError, NeedsError
from roughgas.base.fields import Settings
from roughgas.effects.motions import PiecewiseLinear
from roughgas.effects.settings import register
from roughgas.effects.walls import EVENT_HOOKS, MOTION_HOOKS, Floor, Temperature


class ThermalFloorSettings(Settings, frozen=True, kw_only=True):
    """Settings of `thermal_floor`."""

    temperature: Temperature


class ThermalFloor(Floor):
    """A temperature of the floor, which particles leave with Maxwellian velocities and spins."""

    @classmethod
    def from_settings(cls, settings, context):
        """Return the effect from ThermalFloorSettings and a SceneContext.

        Raises InputError without a floor, and for a floor that moves or has a sine as wave form.
        """
        if "floor" not in context.effects:
            raise NeedsError("effects.thermal_floor", "a floor")
        floor = Floor.from_settings(context.effects["floor"], context._replace(name="floor"))
        if floor.amplitude > 0.0:
            key, legal = "effects.floor.amplitude", "be 0 where the floor has a temperature"
            raise InputError(key, floor.amplitude, legal)
        if not isinstance(floor.motion, PiecewiseLinear):
            raise InputError("effects.floor.wave", "sine", "be sawtooth where the floor is thermal")
        return cls(*floor)._replace(temperature=settings.temperature)


register(ThermalFloor, ThermalFloorSettings, random=True, **EVENT_HOOKS, **MOTION_HOOKS)
roughgas.register_effect("thermal_floor", ThermalFloor, before="floor")
