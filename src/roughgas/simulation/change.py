"""A gas that goes on under other settings: the change itself, and what it puts in.

All particles are brought to one instant under the old settings, the new ones take over, and the
kernel foresees every event anew, as it does after a gas was refreshed. Nothing else is touched: a
change that changes nothing is none, and leaves the bits of the run as they are.

What a change puts in is the jump of the energy: of the potential energy where gravity changes, of
the flow where the shear rate does, and of the motions where temperatures are set.
"""

import math
from typing import NamedTuple

import numpy as np

from roughgas.base import InputError
from roughgas.kernel import hooks
from roughgas.kernel.hooks import displacement
from roughgas.kernel.state import BASE, NOW, STARTED
from roughgas.scene import Scene, moves_along, shear_rate
from roughgas.scene.initial import GRAZE
from roughgas.simulation.gas import Gas
from roughgas.simulation.paths import end_flights, flown
from roughgas.simulation.restart import positions_and_velocities

LATER = 1e-9  # of a period: just after an instant at which a sawtooth falls back
NOT_TO_CHANGE = ("spin", "species")
"""What particles are, besides their r and beta."""


class Temperatures(NamedTuple):
    """What is set by scaling, in m a^2/T^2; None is left as it is."""

    translation: float | None = None
    rotation: float | None = None


AS_IT_IS = Temperatures()


def check_change(old: Scene, new: Scene, time: float, temperatures: Temperatures, key: str) -> None:
    """Raise InputError, whose key begins with `key`, where a gas cannot go on at `time` (T) in
    another scene: particles and kinds of effects stay, and a floor or piston must not jump."""
    for name, before, after in zip(old.effects._fields, old.effects, new.effects, strict=True):
        where = f"{key}.effects.{name}"
        if (name in NOT_TO_CHANGE and before != after) or _kind(before) != _kind(after):
            legal = "stay the kind that it is: a stage changes numbers only"
            raise InputError(where, "of another kind", legal)
        if getattr(after, "motion", None) is not None and before != after:
            heights = [_height(one, time) for one in (before, after)]
            if abs(heights[0] - heights[1]) > GRAZE:
                legal = f"change where it is at the same place before and after, at {time:g} T not"
                raise InputError(where, f"{heights[0]:g} and {heights[1]:g} a", legal)
    flows = new.effects.shear is not None or moves_along(new.effects)
    for name, one in zip(("temperature", "spin_temperature"), temperatures, strict=True):
        if one is not None and flows:
            raise InputError(f"{key}.{name}", one, "not be given where the gas flows")
    if temperatures.rotation is not None and new.effects.spin is None:
        legal = "not be given where particles do not spin"
        raise InputError(f"{key}.spin_temperature", temperatures.rotation, legal)


def _kind(part):
    """Return what the kernel is compiled for: the type of an effect, and those of its parts."""
    return type(part), *(map(_kind, part) if isinstance(part, tuple) else ())


def _height(wall, time):
    """Return how far a floor or piston is out just after `time`."""
    return displacement(wall, time + LATER * wall.motion.period)


def going_on(old: Scene, new: Scene, time: float) -> Scene:
    """Return the new scene with the images of a sheared gas where they are at `time` (T)."""
    before, after = old.effects.shear, new.effects.shear
    if before is None or after is None or before == after:
        return new
    return new._replace(effects=new.effects._replace(shear=after.going_on(before, time)))


def change(
    gas: Gas, scene: Scene, time: float, temperatures: Temperatures = AS_IT_IS
) -> np.ndarray:
    """Let a gas go on in another scene at `time` (T), which it has reached to rounding; return what
    this puts in, in m a^2/T^2: energy of translation and of rotation, (2,).

    Raises InputError where spins are to be scaled that are all zero.
    """
    state, old = gas.state, gas.scene
    if scene == old and temperatures == AS_IT_IS:
        return np.zeros(2)
    before = gas.balance()
    state.clock[NOW] = time - state.clock[BASE]
    _settle(state, old, time)
    _let_flow(state, shear_rate(scene) - shear_rate(old), scene.middle)
    for parts in zip(old.effects, scene.effects, state.moments, strict=True):
        _keep_kicks_apart(state, *parts)
    gas.scene = scene
    state.counts[STARTED] = 0
    if temperatures != AS_IT_IS:
        _scale(gas, temperatures)
    after = gas.balance()
    return after.energy - before.energy - (after.ledger - before.ledger).sum(axis=0)


def _settle(state, scene, time):
    """Bring all particles to the present and into the box; count the crossings of images, and book
    the energy that they give."""
    dimension = len(scene.box)
    position, velocity = positions_and_velocities(state, scene, time)
    end_flights(state, position, flown(state, scene)[0], scene)
    for part in hooks.present(scene.effects, "transfer"):
        mass = np.ones(1) if state.bodies is None else state.bodies.mass
        squares = (velocity**2 - state.trajectory[:, dimension:-1] ** 2).sum(axis=1)
        state.ledger[0, part.rank, 0] += 0.5 * np.sum(mass * squares)
    state.trajectory[:, :dimension] = position
    state.trajectory[:, dimension:-1] = velocity
    state.trajectory[:, -1] = state.clock[NOW]


def _let_flow(state, rate, middle):
    """Add a mean flow of this rate (1/T), as a gas has that starts under shear."""
    dimension = (state.trajectory.shape[1] - 1) // 2
    state.trajectory[:, dimension] += rate * (state.trajectory[:, 1] - middle)


def _keep_kicks_apart(state, old, new, due):
    """Let kicks or steps be evenly spaced in a new interval as they were in the old one."""
    if hasattr(new, "interval") and new.interval != old.interval:
        ahead = due - state.clock[NOW]
        due[:] = state.clock[NOW] + ahead * (new.interval / old.interval)


def _scale(gas, temperatures):
    """Scale velocities and spins, so that the gas has the temperatures, T = 2 E."""
    gas.look()
    present, state = gas.energies(gas.sample), gas.state
    dimension = len(gas.scene.box)
    parts = (state.trajectory[:, dimension:-1], state.spin)
    for wanted, energy, part in zip(temperatures, present, parts, strict=True):
        if wanted is None:
            continue
        if energy[0] == 0.0 < wanted:
            legal = "be 0 where nothing moves so: scaling changes nothing there"
            raise InputError("schedule.stages: temperature to be set", wanted, legal)
        part *= math.sqrt(wanted / (2.0 * energy[0])) if wanted else 0.0
    state.counts[STARTED] = 0
