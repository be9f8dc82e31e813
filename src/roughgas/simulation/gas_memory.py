"""Relaxation and autocorrelation times of a driven gas by theory, on which verdicts are based.

T_tr and T_rot are the temperatures of translation and rotation, in m a^2/T^2. In this module the
`temperatures` are T_tr of each species, then T_rot of each species whose spins change; a matrix of
relaxation has the derivatives of their rates of change.

The memory that a run measures itself is too short in exactly the runs whose error is too small, so
that a criterion in measured memories would select them. Theory computes the memory from the mean
energies and the frequency of contacts, which every run measures well: the criterion then does not
depend on chance.

A dilute bed that is open above rises with its temperature: its potential energy is T_tr per
particle, as of two degrees of freedom more, and its contacts become rarer as T_tr^(-1/2). A floor
that rises at a constant speed, a sawtooth, supplies the weight times this speed at any temperature.
Both slow its transient down, by up to four. Other floors supply less to a hotter bed, so that its
transient lasts half as long.

The rates of all relaxation processes add up: contacts (also with friction, or of several species),
the drag of a bath, and walls. Spin and heat from a wall spread slowly: hits and the diffusion to
the wall are consecutive steps, whose times add up.
"""

import math
from typing import NamedTuple

import numpy as np

from roughgas.effects import inertia
from roughgas.effects.walls import Floor, Wall
from roughgas.scene import Scene, closed_axes, rotation_of_medium, walls_of
from roughgas.theory import (
    Mixture,
    collision_rates,
    friction_changes,
    mean_spin_decay,
    temperature_changes,
)
from roughgas.theory.mixture_states import kick_power, mixture_contact_values
from roughgas.theory.mixtures import contact_frequencies, rate_matrix
from roughgas.theory.relaxation import (
    floor_hit_frequency,
    ratio_relaxation,
    slopes,
    slowest_relaxation,
    thermal_wall_slopes,
    viscous_decay,
    wall_hit_frequency,
    wall_slopes,
)


class GasMemory(NamedTuple):
    """Memory times of a gas in T; infinite if a motion never relaxes, 0 if nothing has to relax."""

    of_R: float  # integrated autocorrelation time of R, 2 over its relaxation rate
    energies: float  # e-fold of the slowest combination of the temperatures
    flow: float  # e-fold of the longest flow, or of the total momentum in a bath
    settling: float  # e-fold of the slowest transient: of the energies, in a bed as it rises


class ThermalState(NamedTuple):
    """The measured state of a gas, in units of a, m and T."""

    T_tr: np.ndarray  # (species,)
    T_rot: np.ndarray | None  # (species,); None if spins are absent or never change
    frequency: float  # contacts of a particle per T
    particles: int
    lengths: tuple[float, ...]  # of the axes; infinite along an open axis


def gas_memory(
    scene: Scene, state: ThermalState, mixture: Mixture | None = None, packing: float = 0.0
) -> GasMemory:
    """Return the memory times of a driven gas in a measured state, by theory.

    The rate equations are linearised at this `state`. The state of a `mixture` has the temperatures
    of the species in the order of the settings; the `packing` fraction of a periodic box determines
    its contact values. Without contacts all times are infinite.
    """
    measured = np.isfinite(state.T_tr).all() and (state.T_tr > 0.0).all()
    if not (measured and state.frequency > 0.0):
        return GasMemory(math.inf, math.inf, math.inf, math.inf)
    gas = RateEquations(scene, state, mixture, packing)
    relaxation = gas.contacts() + gas.walls() + np.diag(gas.speed_gain_rates() - gas.drag_rates())
    spin_decay = _mean_spin_decay(scene, state)
    ratio_decay = min(ratio_relaxation(relaxation, gas.heating(), gas.capacity), spin_decay)
    slowest = min(slowest_relaxation(relaxation + gas.accelerated_contacts()), spin_decay)
    settling = slowest
    if _is_open_bed(scene, state):
        rising = slowest_relaxation(relaxation - gas.contacts_by_frequency())
        settling = rising / (1.0 + 2.0 / float(gas.capacity.sum()))
    return GasMemory(
        of_R=_with_total_momentum(_decay_time(2.0, ratio_decay), scene, state),
        energies=_decay_time(1.0, slowest),
        flow=_decay_time(1.0, _flow_decay(scene, state)),
        settling=_decay_time(1.0, settling),
    )


def _decay_time(numerator: float, rate: float) -> float:
    """Return `numerator` over `rate` (1/T), in T; infinity for a rate that is not positive."""
    return numerator / rate if rate > 0.0 else math.inf


class RateEquations:
    """The rate equations of a gas, linearised at its measured state, for all its temperatures.

    Arguments as in `gas_memory`.
    """

    def __init__(
        self, scene: Scene, state: ThermalState, mixture: Mixture | None, packing: float
    ) -> None:
        self.scene, self.state, self.mixture = scene, state, mixture
        self.dimension, self.spin_axes = len(scene.box), 2 * len(scene.box) - 3
        species = np.zeros(1, int) if mixture is None else mixture.species_of
        self.fraction = np.ones(1) if mixture is None else mixture.fraction
        self.contact_values = None if mixture is None else mixture_contact_values(mixture, packing)
        self.T_tr = state.T_tr[species]
        self.T_rot = np.zeros(len(species)) if state.T_rot is None else state.T_rot[species]
        self.has_spin = self.T_rot > 0.0
        translation, rotation = self.fraction * self.dimension, self.fraction * self.spin_axes
        self.capacity = np.append(translation, rotation[self.has_spin])
        """Heat capacities (temperatures,): twice the energy per temperature."""

    def contacts(self) -> np.ndarray:
        """Return the relaxation matrix due to contacts at constant frequency, in 1/T.

        Shape (temperatures, temperatures).
        """
        friction = self.scene.effects.friction
        if self.mixture is None and friction is None:  # linear: the coefficients are exact
            loss, gain, spin_gain, spin_loss = map(
                float, collision_rates(*self._contact_material())
            )
            linear = np.array([[-loss, gain], [spin_gain, -spin_loss]])
        else:
            linear = slopes(self._changes, self._temperatures())
        size = len(self.capacity)
        return self.state.frequency * linear[:size, :size]

    def accelerated_contacts(self) -> np.ndarray:
        """Return the relaxation matrix due to the frequency of contacts, in 1/T.

        The matrix, (temperatures, temperatures), is zero if the power of the drive grows as the
        frequency does, and replaces the energy lost in contacts.
        """
        size = len(self.capacity)
        if not _has_constant_power(self.scene):
            return np.zeros((size, size))
        return self.contacts_by_frequency()

    def contacts_by_frequency(self) -> np.ndarray:
        """Return the change of the losses in contacts with a frequency that grows as T_tr^(1/2).

        Shape (temperatures, temperatures), in 1/T.
        """
        frequency_slopes = np.zeros(len(self.capacity))
        frequency_slopes[: len(self.fraction)] = self.fraction / (2.0 * self.fraction @ self.T_tr)
        losses = self._changes(self._temperatures())
        return self.state.frequency * np.outer(losses, frequency_slopes)

    def walls(self) -> np.ndarray:
        """Return the relaxation matrix due to walls, in 1/T; zeros in a mixture.

        Shape (temperatures, temperatures).
        """
        size = len(self.capacity)
        total = np.zeros((size, size))
        if self.mixture is None:
            for wall in walls_of(self.scene.effects).values():
                total += (
                    len(wall.ends) * self._hit_rate(wall) * self._slopes_per_hit(wall)[:size, :size]
                )
        return total

    def drag_rates(self) -> np.ndarray:
        """Return the decay rates of the temperatures due to drag, (temperatures,) in 1/T."""
        drag, spin_drag = drag_rates(self.scene)
        spin_rates = np.full(np.count_nonzero(self.has_spin), 2.0 * spin_drag)
        return np.append(np.full(len(self.fraction), 2.0 * drag), spin_rates)

    def speed_gain_rates(self) -> np.ndarray:
        """Return the growth rates of the temperatures in the Delta model, (temperatures,) in 1/T.

        A collision per particle adds m (Delta/D) [r (pi T_tr/m)^(1/2) + Delta] to T_tr, the more
        the hotter the gas; in a mixture, to the T_tr of each species, as if particles were alike.
        """
        rates, delta = np.zeros(len(self.capacity)), self.scene.effects.delta
        if delta is not None:
            share = self.scene.restitution * delta.speed / self.dimension
            rates[: len(self.fraction)] = share * np.sqrt(math.pi / self.T_tr) / 2.0
        return self.state.frequency * rates

    def heating(self) -> np.ndarray:
        """Return the rates of heating of the temperatures by the drive, (temperatures,).

        They are defined up to a common factor.
        """
        rotational_share, power = spin_share(self.scene), np.ones(len(self.fraction))
        if self.mixture is not None and self.scene.effects.thermostat is not None:
            power = kick_power(self.mixture)
        of_spins = np.full(np.count_nonzero(self.has_spin), rotational_share / self.spin_axes)
        return np.append((1.0 - rotational_share) * power / self.dimension, of_spins)

    def _temperatures(self):
        """Return the measured temperatures, (temperatures,) in m a^2/T^2."""
        return np.append(self.T_tr, self.T_rot[self.has_spin])

    def _changes(self, temperatures):
        """Return the changes of the temperatures by one collision per particle, (temperatures,).

        `temperatures` may differ from the measured ones.
        """
        species = len(self.fraction)
        T_tr, T_rot = temperatures[:species], np.zeros(species)
        T_rot[self.has_spin] = temperatures[species:]
        changes = (
            self._changes_identical(T_tr, T_rot)
            if self.mixture is None
            else self._changes_mixed(T_tr, T_rot)
        )
        return np.append(changes[:species], changes[species:][self.has_spin])

    def _changes_identical(self, T_tr, T_rot):
        """Return the changes of T_tr and T_rot by one collision per particle, (2,).

        All particles are identical.
        """
        r, roughness, *axes_and_inertia = self._contact_material()
        friction = self.scene.effects.friction
        if friction is None or roughness == -1.0:
            changes = temperature_changes(T_tr, T_rot, r, roughness, *axes_and_inertia)
        else:
            changes = friction_changes(T_tr, T_rot, r, roughness, friction.mu, *axes_and_inertia)
        return np.concatenate(changes)

    def _contact_material(self):
        """Return r, beta, D and q for contacts; beta is -1 (smooth) if spins never change."""
        roughness = self.scene.roughness if self.has_spin.any() else -1.0
        q = inertia(self.scene.effects)
        return self.scene.restitution, roughness, self.dimension, q

    def _changes_mixed(self, T_tr, T_rot):
        """Return the changes of a mixture's temperatures by one collision per particle.

        All T_tr come first, then all T_rot. `T_tr` and `T_rot` are (species,).
        """
        gas, temperatures = self.mixture, np.append(T_tr, T_rot)
        contacts = contact_frequencies(gas, T_tr, self.contact_values).sum(axis=-1) @ gas.fraction
        return rate_matrix(gas, T_tr, T_rot, self.contact_values) @ temperatures / contacts

    def _hit_rate(self, wall: Wall) -> float:
        """Return the rate of a particle's hits on a wall, in 1/T.

        It is limited by the diffusion to the wall.
        """
        T_tr, effects = float(self.T_tr[0]), self.scene.effects
        if isinstance(wall, Floor):
            assert effects.gravity is not None
            return floor_hit_frequency(T_tr, -effects.gravity.along[wall.axis])
        length = self.state.lengths[wall.axis]
        if math.isinf(length):  # a lid above an open box
            return 0.0
        hits = wall_hit_frequency(T_tr, length)
        if effects.floor is not None:  # shaking mixes a bed
            return hits
        return 1.0 / (1.0 / hits + 1.0 / viscous_decay(T_tr, self.state.frequency, 2.0 * length))

    def _slopes_per_hit(self, wall: Wall) -> np.ndarray:
        """Return the derivatives (2, 2) of the changes of T_tr and T_rot by a hit on a wall.

        They are with respect to T_tr and T_rot.
        """
        if wall.temperature is not None:
            return thermal_wall_slopes(self.dimension)
        roughness = wall.roughness if self.has_spin.any() else -1.0
        # the work of a moving wall is part of the drive
        restitution = wall.restitution if wall.motion is None else 1.0
        return wall_slopes(restitution, roughness, self.dimension, inertia(self.scene.effects))


def drag_rates(scene: Scene) -> tuple[float, float]:
    """Return the drag rates of a bath on velocities and on spins, in 1/T; zeros without a bath."""
    bath = scene.effects.langevin
    if bath is None:
        return 0.0, 0.0
    return -math.log(bath.velocity_factor) / bath.interval, -math.log(
        bath.spin_factor
    ) / bath.interval


def _mean_spin_decay(scene: Scene, state: ThermalState) -> float:
    """Return the decay rate of the mean spin (1/T) in a bath whose medium rotates; else infinity.

    In a mixture, and with friction, it is the rate due to drag alone, a lower bound.
    """
    effects, (_, spin_drag) = scene.effects, drag_rates(scene)
    if rotation_of_medium(effects) is None:
        return math.inf
    if effects.species is not None or effects.friction is not None:
        return spin_drag
    per_contact = mean_spin_decay(scene.roughness, len(scene.box), inertia(effects))
    return spin_drag + state.frequency * float(per_contact)


def spin_share(scene: Scene) -> float:
    """Return the rotational share of the power of random kicks and noise, from 0 to 1.

    It is 0 for other drives.
    """
    axes, spin_axes = len(scene.box), 2 * len(scene.box) - 3
    kicks, bath, q = scene.effects.thermostat, scene.effects.langevin, inertia(scene.effects)
    translation = rotation = 0.0
    if kicks is not None:
        # components uniform in [-k, k] have the variance k^2/3; a kick hits two particles
        translation += 2.0 * axes * kicks.push**2 / (3.0 * kicks.interval)
        rotation += 2.0 * spin_axes * (q or 0.0) * kicks.turn**2 / (3.0 * kicks.interval)
    if bath is not None:
        translation += axes * (bath.noise or 0.0) / bath.interval
        rotation += spin_axes * (bath.spin_noise or 0.0) / bath.interval
    return rotation / (translation + rotation) if rotation > 0.0 else 0.0


def _has_constant_power(scene: Scene) -> bool:
    """Return whether kicks, noise or thermal walls drive the gas.

    Their power does not depend on the temperatures of the gas.
    """
    effects = scene.effects
    bath = effects.langevin
    noise = bath is not None and bool(bath.noise or bath.spin_noise)
    thermal = any(wall.temperature is not None for wall in walls_of(effects).values())
    return effects.thermostat is not None or noise or thermal


def _with_total_momentum(of_R: float, scene: Scene, state: ThermalState) -> float:
    """Return the memory time of R (T) corrected for the total momentum, which only a bath damps.

    `of_R` is the memory time without it. The energy of the centre of mass fluctuates by
    (T_bath/T_tr)^2/N of the fluctuations of all particles; T_bath is the temperature due to drag
    and noise alone.
    """
    bath = scene.effects.langevin
    drag, _ = drag_rates(scene)
    if bath is None or not bath.noise or not drag > 0.0:
        return of_R
    T_bath = bath.noise / (1.0 - bath.velocity_factor**2)
    weight = (T_bath / float(state.T_tr.mean())) ** 2 / state.particles
    return (of_R + weight / drag) / (1.0 + weight)


def _is_open_bed(scene: Scene, state: ThermalState) -> bool:
    """Return whether gravity acts along an axis that is open above."""
    gravity = scene.effects.gravity
    return gravity is not None and any(math.isinf(state.lengths[axis]) for axis in gravity.along)


def _flow_decay(scene: Scene, state: ThermalState) -> float:
    """Return the decay rate of the longest flow in the box, in 1/T."""
    drag, _ = drag_rates(scene)
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
