"""How long a driven gas remembers, by theory: the length that a verdict rests on.

The memory that a run measures of itself is too short in just those runs whose error is too small:
to ask for a number of measured memories selects them. Theory knows the memory from the mean
energies and the frequency of contacts, which every run measures well, so that no luck of the run
decides how long is long enough.

The rates of all that relaxes temperatures add up: contacts (also with friction, or of several
species), the drag of a bath, and walls. Spin and heat from a wall take a while to
spread: hits and the diffusion to the wall are two steps, one after the other, whose times add up.
"""

import math
from typing import NamedTuple

import numpy as np

from roughgas.effects import inertia
from roughgas.effects.walls import Floor, Wall
from roughgas.scene import Scene, closed_axes, walls_of
from roughgas.theory import Mixture, collision_rates, friction_changes, temperature_changes
from roughgas.theory.mixture_states import kick_power, mixture_contact_values
from roughgas.theory.mixtures import contact_frequencies, rate_matrix
from roughgas.theory.relaxation import (
    hits_of_floor,
    hits_of_wall,
    ratio_relaxation,
    slopes,
    slowest_relaxation,
    thermal_wall_slopes,
    viscous_decay,
    wall_slopes,
)


class Memory(NamedTuple):
    """Times in T; infinite where a motion never forgets, 0 where nothing has to be forgotten."""

    of_R: float  # integrated autocorrelation time of R, 2 over its relaxation rate
    energies: float  # e-fold of the slowest combination of the temperatures
    flow: float  # e-fold of the longest flow, or of the total momentum in a bath


class Thermal(NamedTuple):
    """The measured state of a gas, in units of a, m and T."""

    T_tr: np.ndarray  # (species,)
    T_rot: np.ndarray | None  # (species,); None where spins are absent or never change
    frequency: float  # contacts of a particle per T
    particles: int
    lengths: tuple[float, ...]  # of the axes, infinite where the box is open


def memory(
    scene: Scene, state: Thermal, mixture: Mixture | None = None, packing: float = 0.0
) -> Memory:
    """Return the memory of a driven gas in a measured state.

    The state of a `mixture` has the temperatures of the species as settings list them; the
    `packing` of a periodic box gives its contact values. Without contacts a gas never forgets.
    """
    measured = np.isfinite(state.T_tr).all() and (state.T_tr > 0.0).all()
    if not (measured and state.frequency > 0.0):
        return Memory(math.inf, math.inf, math.inf)
    gas = RateEquations(scene, state, mixture, packing)
    relaxation = gas.contacts() + gas.walls() - np.diag(gas.drags())
    of_R = _time(2.0, ratio_relaxation(relaxation, gas.heating(), gas.capacity))
    slowest = slowest_relaxation(relaxation + gas.accelerated_contacts())
    return Memory(
        of_R=_with_total_momentum(of_R, scene, state),
        energies=_time(1.0, slowest),
        flow=_time(1.0, _flow_decay(scene, state)),
    )


def _time(numerator: float, rate: float) -> float:
    return numerator / rate if rate > 0.0 else math.inf


class RateEquations:
    """The rate equations of a gas at its measured state: T_tr of each species, then each T_rot."""

    def __init__(
        self, scene: Scene, state: Thermal, mixture: Mixture | None, packing: float
    ) -> None:
        self.scene, self.state, self.mixture = scene, state, mixture
        self.dimension, self.spin_axes = len(scene.box), 2 * len(scene.box) - 3
        species = np.zeros(1, int) if mixture is None else mixture.part_of
        self.fraction = np.ones(1) if mixture is None else mixture.fraction
        self.crowding = None if mixture is None else mixture_contact_values(mixture, packing)
        self.T_tr = state.T_tr[species]
        self.T_rot = np.zeros(len(species)) if state.T_rot is None else state.T_rot[species]
        self.turning = self.T_rot > 0.0
        translation, rotation = self.fraction * self.dimension, self.fraction * self.spin_axes
        self.capacity = np.append(translation, rotation[self.turning])
        """Energy per temperature, (temperatures,), half of it left out."""

    def contacts(self) -> np.ndarray:
        """Return the slopes per T due to contacts at a constant frequency, (temperatures,
        temperatures)."""
        friction = self.scene.effects.friction
        if self.mixture is None and friction is None:  # linear: no slope need be measured
            loss, gain, spin_gain, spin_loss = map(float, collision_rates(*self._material()))
            linear = np.array([[-loss, gain], [spin_gain, -spin_loss]])
        else:
            linear = slopes(self._changes, self._temperatures())
        size = len(self.capacity)
        return self.state.frequency * linear[:size, :size]

    def accelerated_contacts(self) -> np.ndarray:
        """Return the slopes due to the frequency of contacts, which grows as T_tr^(1/2).

        Zeros where the power of the drive grows alike: it replaces the energy that contacts lose.
        """
        size = len(self.capacity)
        if not _has_constant_power(self.scene):
            return np.zeros((size, size))
        frequency_slopes = np.zeros(size)
        frequency_slopes[: len(self.fraction)] = self.fraction / (2.0 * self.fraction @ self.T_tr)
        losses = self._changes(self._temperatures())
        return self.state.frequency * np.outer(losses, frequency_slopes)

    def walls(self) -> np.ndarray:
        """Return the slopes per T due to walls; zeros in a mixture."""
        size = len(self.capacity)
        total = np.zeros((size, size))
        if self.mixture is None:
            for wall in walls_of(self.scene.effects).values():
                total += len(wall.ends) * self._hits(wall) * self._per_hit(wall)[:size, :size]
        return total

    def drags(self) -> np.ndarray:
        """Return the rates of drag on all temperatures, per T, (temperatures,)."""
        drag, spin_drag = drags(self.scene)
        of_spins = np.full(np.count_nonzero(self.turning), 2.0 * spin_drag)
        return np.append(np.full(len(self.fraction), 2.0 * drag), of_spins)

    def heating(self) -> np.ndarray:
        """Return the changes of the temperatures by the drive, (temperatures,), in any unit."""
        share, power = spin_share(self.scene), np.ones(len(self.fraction))
        if self.mixture is not None and self.scene.effects.thermostat is not None:
            power = kick_power(self.mixture)
        of_spins = np.full(np.count_nonzero(self.turning), share / self.spin_axes)
        return np.append((1.0 - share) * power / self.dimension, of_spins)

    def _temperatures(self):
        return np.append(self.T_tr, self.T_rot[self.turning])

    def _changes(self, temperatures):
        """Return the changes of the temperatures per collision per particle."""
        species = len(self.fraction)
        T_tr, T_rot = temperatures[:species], np.zeros(species)
        T_rot[self.turning] = temperatures[species:]
        changes = self._alike(T_tr, T_rot) if self.mixture is None else self._mixed(T_tr, T_rot)
        return np.append(changes[:species], changes[species:][self.turning])

    def _alike(self, T_tr, T_rot):
        r, roughness, *axes_and_inertia = self._material()
        friction = self.scene.effects.friction
        if friction is None or roughness == -1.0:
            changes = temperature_changes(T_tr, T_rot, r, roughness, *axes_and_inertia)
        else:
            changes = friction_changes(T_tr, T_rot, r, roughness, friction.mu, *axes_and_inertia)
        return np.concatenate(changes)

    def _material(self):
        """Return r, beta, D and q of contacts; spins that never change make them smooth."""
        roughness = self.scene.roughness if self.turning.any() else -1.0
        q = inertia(self.scene.effects)
        return self.scene.restitution, roughness, self.dimension, q

    def _mixed(self, T_tr, T_rot):
        gas, temperatures = self.mixture, np.append(T_tr, T_rot)
        contacts = contact_frequencies(gas, T_tr, self.crowding).sum(axis=-1) @ gas.fraction
        return rate_matrix(gas, T_tr, T_rot, self.crowding) @ temperatures / contacts

    def _hits(self, wall: Wall) -> float:
        """Return the hits of a particle on a wall, per T, slowed by the diffusion to it."""
        T_tr, gravity = float(self.T_tr[0]), self.scene.effects.gravity
        if isinstance(wall, Floor) and gravity is not None:
            return hits_of_floor(T_tr, gravity.acceleration)
        length = self.state.lengths[wall.axis]
        if math.isinf(length):  # a lid on nothing
            return 0.0
        hits = hits_of_wall(T_tr, length)
        if gravity is not None:  # a shaken bed is stirred
            return hits
        return 1.0 / (1.0 / hits + 1.0 / viscous_decay(T_tr, self.state.frequency, 2.0 * length))

    def _per_hit(self, wall: Wall) -> np.ndarray:
        if wall.temperature is not None:
            return thermal_wall_slopes(self.dimension)
        roughness = wall.roughness if self.turning.any() else -1.0
        restitution = wall.restitution if wall.motion is None else 1.0  # else it is the drive
        return wall_slopes(restitution, roughness, self.dimension, inertia(self.scene.effects))


def drags(scene: Scene) -> tuple[float, float]:
    """Return the drag of a bath on velocities and on spins, in 1/T; zeros without a bath."""
    bath = scene.effects.langevin
    if bath is None:
        return 0.0, 0.0
    return -math.log(bath.kept) / bath.interval, -math.log(bath.kept_spin) / bath.interval


def spin_share(scene: Scene) -> float:
    """Return the share of rotation in what random kicks and noise put in; 0 for other drives."""
    axes, spin_axes = len(scene.box), 2 * len(scene.box) - 3
    kicks, bath, q = scene.effects.thermostat, scene.effects.langevin, inertia(scene.effects)
    translation = rotation = 0.0
    if kicks is not None:  # a component uniform in [-k, k] has the variance k^2/3, and two are hit
        translation += 2.0 * axes * kicks.push**2 / (3.0 * kicks.interval)
        rotation += 2.0 * spin_axes * (q or 0.0) * kicks.turn**2 / (3.0 * kicks.interval)
    if bath is not None:
        translation += axes * (bath.noise or 0.0) / bath.interval
        rotation += spin_axes * (bath.spin_noise or 0.0) / bath.interval
    return rotation / (translation + rotation) if rotation > 0.0 else 0.0


def _has_constant_power(scene: Scene) -> bool:
    effects = scene.effects
    bath = effects.langevin
    noise = bath is not None and bool(bath.noise or bath.spin_noise)
    thermal = any(wall.temperature is not None for wall in walls_of(effects).values())
    return effects.thermostat is not None or noise or thermal


def _with_total_momentum(of_R: float, scene: Scene, state: Thermal) -> float:
    """Return the memory of R, total momentum included, which only a bath brings to rest.

    The energy of the centre of mass fluctuates by (T_bath/T_tr)^2/N of the fluctuations of
    all particles; drag and noise alone would lead to the temperature T_bath.
    """
    bath = scene.effects.langevin
    drag, _ = drags(scene)
    if bath is None or not bath.noise or not drag > 0.0:
        return of_R
    T_bath = bath.noise / (1.0 - bath.kept**2)
    weight = (T_bath / float(state.T_tr.mean())) ** 2 / state.particles
    return (of_R + weight / drag) / (1.0 + weight)


def _flow_decay(scene: Scene, state: Thermal) -> float:
    """Return the decay rate of the longest flow, per T."""
    drag, _ = drags(scene)
    bath = scene.effects.langevin
    if bath is not None and bath.noise:
        return drag
    closed = closed_axes(scene.effects)
    waves = [
        length * (2.0 if axis in closed else 1.0)
        for axis, length in enumerate(state.lengths)
        if math.isfinite(length)
    ]
    return drag + viscous_decay(float(state.T_tr.mean()), state.frequency, max(waves))
