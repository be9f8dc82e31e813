"""Switch of a gas to another scene or temperature during a run, and the energy that it supplies.

All particles are brought to one instant under the old settings; under the new ones the kernel then
predicts every event anew, as after a refresh. A switch without changes is skipped and leaves the
bits of the run as they are.

The supplied energy is the jump of the energy: of the potential energy if gravity changes, of the
flow if the shear rate changes, and of the motions if temperatures are set.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from roughgas.base import InputError
from roughgas.kernel import hooks
from roughgas.kernel.hooks import displacement
from roughgas.kernel.state import BASE, NOW, STARTED
from roughgas.scene import Scene, shear_rate, walls_drive_flow
from roughgas.scene.initial import GRAZE, random_spins
from roughgas.simulation.energy_balance import potential_energy
from roughgas.simulation.free_flight import (
    end_flights,
    in_starting_order,
    positions_and_velocities,
    unfolded_positions_and_velocities,
)
from roughgas.simulation.gas import Gas

SAWTOOTH_OFFSET = 1e-9  # of a period: from the jump of a sawtooth to just after it
UNCHANGEABLE_EFFECTS = ("spin", "species")
"""Effects that define particles; of these properties only r and beta can change."""


class TargetTemperatures(NamedTuple):
    """Temperatures to be set by scaling velocities, in m a^2/T^2; None: no change."""

    translation: float | None = None
    rotation: float | None = None


UNCHANGED = TargetTemperatures()


def check_scene_switch(
    old: Scene, new: Scene, time: float, temperatures: TargetTemperatures, key: str
) -> None:
    """Raise InputError if a gas cannot switch from the scene `old` to `new` at `time` (T).

    Particles and types of effects must stay the same, and a floor or piston must not jump; the
    `temperatures` to be set must suit the new scene. The key of the error begins with `key`.
    """
    for name, before, after in zip(old.effects._fields, old.effects, new.effects, strict=True):
        where = f"{key}.effects.{name}"
        if (name in UNCHANGEABLE_EFFECTS and before != after) or kernel_types(
            before
        ) != kernel_types(after):
            legal = "stay the kind that it is: a stage changes numbers only"
            raise InputError(where, "of another kind", legal)
        if getattr(after, "motion", None) is not None and before != after:
            displacements = [_displacement_after(effect, time) for effect in (before, after)]
            if abs(displacements[0] - displacements[1]) > GRAZE:
                legal = f"change where it is at the same place before and after, at {time:g} T not"
                raise InputError(where, f"{displacements[0]:g} and {displacements[1]:g} a", legal)
    has_flow = new.effects.shear is not None or walls_drive_flow(new.effects)
    for name, temperature in zip(("temperature", "spin_temperature"), temperatures, strict=True):
        if temperature is not None and has_flow:
            raise InputError(f"{key}.{name}", temperature, "not be given where the gas flows")
    if temperatures.rotation is not None and new.effects.spin is None:
        legal = "not be given where particles do not spin"
        raise InputError(f"{key}.spin_temperature", temperatures.rotation, legal)


def kernel_types(effect: Any) -> tuple[Any, ...]:
    """Return the type of an effect and, nested, of its fields: the kernel is compiled for these."""
    return type(effect), *(map(kernel_types, effect) if isinstance(effect, tuple) else ())


def _displacement_after(wall, time):
    """Return the displacement in a of a floor or piston just after `time` (T)."""
    return displacement(wall, time + SAWTOOTH_OFFSET * wall.motion.period)


def with_images_continued(old: Scene, new: Scene, time: float) -> Scene:
    """Return the new scene, with images of a sheared gas that do not jump at `time` (T)."""
    before, after = old.effects.shear, new.effects.shear
    if before is None or after is None or before == after:
        return new
    return new._replace(effects=new.effects._replace(shear=after.continuing(before, time)))


def switch_scene(
    gas: Gas,
    scene: Scene,
    time: float,
    temperatures: TargetTemperatures = UNCHANGED,
    rng: np.random.Generator | None = None,
) -> np.ndarray:
    """Switch a gas to another scene at `time` (T), and return the supplied energy.

    `time` is the present time to within rounding. The energy is (2,) of translation and rotation,
    in m a^2/T^2. If all spins are zero and get a temperature, they are drawn with `rng`, by default
    with a fixed seed. Raises InputError if velocities to be scaled are all zero.
    """
    state, old = gas.state, gas.scene
    if scene == old and temperatures == UNCHANGED:
        return np.zeros(2)
    before = gas.balance()
    state.clock[NOW] = time - state.clock[BASE]
    _end_all_flights(state, old, time)
    _add_mean_flow(state, shear_rate(scene) - shear_rate(old), scene.middle)
    for effects_and_times in zip(old.effects, scene.effects, state.particle_times, strict=True):
        _rescale_kick_times(state, *effects_and_times)
    gas.scene = scene
    state.counts[STARTED] = 0
    if temperatures != UNCHANGED:
        _set_temperatures(gas, temperatures, np.random.default_rng(0) if rng is None else rng)
    after = gas.balance()
    return after.energy - before.energy - (after.ledger - before.ledger).sum(axis=0)


def _end_all_flights(state, scene, time):
    """Bring all particles to the present instant and into the box; `time` is the present in T.

    Crossings of images are counted, and their energy is booked in the ledger.
    """
    dimension = len(scene.box)
    position, velocity = positions_and_velocities(state, scene, time)
    end_flights(state, position, unfolded_positions_and_velocities(state, scene)[0], scene)
    for hook in hooks.active(scene.effects, "transfer"):
        mass = np.ones(1) if state.bodies is None else state.bodies.mass
        squares = (velocity**2 - state.trajectory[:, dimension:-1] ** 2).sum(axis=1)
        gained = 0.5 * np.sum(mass * squares)
        if scene.effects.gravity is not None:
            height_changes = position - state.trajectory[:, :dimension]
            gained += potential_energy(scene.effects.gravity, mass, height_changes)
        state.ledger[0, hook.account, 0] += gained
    state.trajectory[:, :dimension] = position
    state.trajectory[:, dimension:-1] = velocity
    state.trajectory[:, -1] = state.clock[NOW]


def _add_mean_flow(state, rate, middle):
    """Add a mean flow of the shear rate `rate` (1/T), as at the start of a sheared gas.

    The flow is zero at the height `middle` (a).
    """
    dimension = (state.trajectory.shape[1] - 1) // 2
    state.trajectory[:, dimension] += rate * (state.trajectory[:, 1] - middle)


def _rescale_kick_times(state, old, new, due):
    """Rescale the waiting times of kicks if an effect's interval changes, in place.

    `old` and `new` are the effect before and after the switch, and `due` (N,) the times of each
    particle's next kick or step.
    """
    if hasattr(new, "interval") and new.interval != old.interval:
        ahead = due - state.clock[NOW]
        due[:] = state.clock[NOW] + ahead * (new.interval / old.interval)


def _set_temperatures(gas, temperatures, rng):
    """Scale velocities and spins to the target temperatures, T = 2 E; `rng` draws absent spins.

    Raises InputError if velocities to be scaled are all zero.
    """
    if temperatures.rotation and not gas.state.spin.any():
        _draw_spins(gas, rng)
    gas.sample_now()
    energies, state = gas.energies(gas.sample), gas.state
    dimension = len(gas.scene.box)
    velocities = (state.trajectory[:, dimension:-1], state.spin)
    for temperature, energy, velocity in zip(temperatures, energies, velocities, strict=True):
        if temperature is None:
            continue
        if energy[0] == 0.0 < temperature:
            legal = "be 0 where nothing moves so: scaling changes nothing there"
            raise InputError("schedule.stages: temperature to be set", temperature, legal)
        velocity *= math.sqrt(temperature / (2.0 * energy[0])) if temperature else 0.0
    state.counts[STARTED] = 0


def _draw_spins(gas, rng):
    """Draw spins of the particles from a Maxwellian, with zero mean angular velocity.

    Their temperature is about 1 m a^2/T^2; `rng` draws them.
    """
    state, spin = gas.state, gas.scene.effects.spin
    mass, q, radius = (np.full(gas.particles, number) for number in (1.0, spin.inertia, 1.0))
    if state.bodies is not None:
        bodies = (state.bodies.mass, state.bodies.inertia, state.bodies.radius)
        mass, q, radius = (in_starting_order(state, values) for values in bodies)
    spins = random_spins(mass * q, state.spin.shape[1], 1.0, rng)
    if gas.particles > 1:  # the spin of a single particle is the mean
        moment, radius = (mass * q * radius)[:, None], radius[:, None]
        spins -= radius * ((moment * spins).sum(axis=0) / (moment * radius).sum())
    state.spin[:] = spins[state.label]
