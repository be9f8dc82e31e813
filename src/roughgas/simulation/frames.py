"""Frames of a gas: what observables see of it at one or several instants.

The kernel copies the flight of each particle since its last event, in the order of memory
(kernel.record.RawFrames). This module computes positions, velocities and spins at each instant, in
the order of the start. The bits of a frame do not depend on the other frames.
"""

import math
from typing import Any

import numpy as np

from roughgas.kernel.hooks import displacement
from roughgas.kernel.record import RawFrames
from roughgas.kernel.state import BASE, COLLISIONS, EXPONENT, NOW, ORIGIN, State
from roughgas.observables import System
from roughgas.observables.frames import FrameSeries
from roughgas.scene import Scene
from roughgas.simulation.free_flight import (
    fold_positions,
    in_starting_order,
    is_in_starting_order,
    turned_since_events,
    unfolded_positions_and_velocities,
    unwrapped,
)
from roughgas.simulation.gas import Gas


def present_raw_frame(state: State) -> RawFrames:
    """Return the raw frame of a state at the present instant (k = 1), as views."""
    paths = state.paths
    return RawFrames(
        trajectory=state.trajectory[None],
        spin=None if state.spin is None else state.spin[None],
        label=state.label[None],
        crossings=None if paths is None else paths.crossings[None],
        rotation=None if paths is None or paths.rotation is None else paths.rotation[None],
        ledger=state.ledger[None],
        clock=state.clock[None],
        counts=state.counts[None],
        rows=np.zeros(1, np.int64),
        stored=np.ones(1, np.int64),
    )


def motions(raw: RawFrames, scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Return positions in a, folded into the box, and velocities of these images.

    Velocities are in the kernel's unit, 2^exponent a/T. Shape (k, N, D) each, in the order of
    memory.
    """
    position, velocity = unfolded_positions_and_velocities(raw, scene)
    fold_positions(position, velocity, scene, _times(raw.clock, raw.counts[:, EXPONENT]))
    return position, velocity


def frames_of(gas: Gas, raw: RawFrames, system: System) -> FrameSeries:
    """Return the frames that observables receive, at the k instants of the raw frames of `gas`.

    Velocities and spins are in a/T or, in a cooling gas, in units of sqrt(E_trans/m) at the
    instant. `rates` are empty.
    """
    scene, effects = gas.scene, gas.scene.effects
    radius, mass, inertia, species = _bodies(gas.state, system)
    exponent = raw.counts[:, EXPONENT]
    time = _times(raw.clock, exponent)
    position, velocity = unfolded_positions_and_velocities(raw, scene)
    if not is_in_starting_order(raw):  # a copy takes as long as all computations here
        position, velocity = in_starting_order(raw, position), in_starting_order(raw, velocity)
    unwrapped_position = (
        None if raw.crossings is None else unwrapped(position, raw.crossings, scene)
    )
    angle = None
    if raw.rotation is not None:
        angle = raw.rotation + turned_since_events(raw, radius)
    fold_positions(position, velocity, scene, time)
    unit = np.ldexp(1.0, exponent)
    scale = _per_thermal_speed(mass, velocity) if system.cooling else unit
    velocity *= scale[:, None, None]
    with np.errstate(divide="ignore"):  # of particles at rest
        speed_unit = np.where(scale == 0.0, math.nan, unit / scale)
    return FrameSeries(
        system=system,
        time=time,
        collisions=2.0
        * (raw.counts[:, COLLISIONS] - gas.collisions_before_cooling)
        / gas.particles,
        position=position,
        velocity=velocity,
        spin=None if raw.spin is None else in_starting_order(raw, raw.spin) * scale[:, None, None],
        radius=radius,
        mass=mass,
        inertia=inertia,
        image_shift=_displacements(effects.shear, time),
        rates={},
        species_of=species,
        speed_unit=speed_unit,
        floor=_displacements(effects.floor, time),
        unwrapped_position=unwrapped_position,
        angle=angle,
    )


def _bodies(state, system):
    """Return radius, mass, q and species number (N,) of the particles, in the order of the start.

    The species are None if all particles are identical.
    """
    if state.bodies is None:
        ones = np.ones(system.particles)
        return ones, ones, ones * (system.inertia or 0.0), None
    bodies = state.bodies
    quantities = bodies.radius, bodies.mass, bodies.inertia, bodies.species
    return tuple(in_starting_order(state, values) for values in quantities)


def _times(clock, exponent):
    """Return the times of k raw frames since the start, (k,) in T.

    `clock` and `exponent` have an entry per frame.
    """
    return clock[:, ORIGIN] + (clock[:, BASE] + clock[:, NOW]) * np.ldexp(1.0, -exponent)


def _per_thermal_speed(mass, velocity):
    """Return 1/sqrt(E_trans) (k,) in the unit of `velocity` (k, N, D), 0 if nothing moves.

    Here E_trans is the mean of m v^2/2 per degree of freedom, with `mass` (N,) in m.
    """
    squares = mass[:, None] * velocity**2
    energy = 0.5 * np.mean(squares.reshape(len(squares), -1), axis=1)
    return np.divide(1.0, np.sqrt(energy), out=np.zeros_like(energy), where=energy != 0.0)


def _displacements(effect: Any, times: np.ndarray) -> np.ndarray:
    """Return the displacement of an effect's boundary at the `times` (k,) in T, (k,) in a.

    It is 0 without the effect (None).
    """
    if effect is None:
        return np.zeros(len(times))
    return np.array([displacement(effect, time) for time in times.tolist()], float)
