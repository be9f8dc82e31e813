"""A Langevin bath: drag and noise on velocities and on spins, each with a temperature of its own.

The velocity of a particle of mass m obeys dv = -gamma v dt + (2 gamma T/m)^(1/2) dW between its
contacts, its spin the same with a drag and a temperature of spins. Every particle takes an exact
step of this (G. E. Uhlenbeck & L. S. Ornstein, Phys. Rev. 36, 823 (1930)) once an `interval` h,

    v -> v e^(-gamma h) + [(1 - e^(-2 gamma h)) T/m]^(1/2) xi,    xi Gaussian of variance 1,

the particles in a random order and evenly spaced, and flies freely in between. So contacts stay
events. The Maxwellian at T stays as it is under a step, a flight and an elastic contact alike: an
elastic gas has exactly the temperature of its bath, whatever h is. What depends on h is how far a
particle gets: its diffusion coefficient T/(m gamma) is larger by (gamma h/2) coth(gamma h/2).

Noise without drag puts in a `power` in place of a temperature, as the thermostat does (drives.py),
but to single particles, so that their momentum is not conserved. Drag without noise drives nothing:
such a gas cools.
"""

import math
from typing import Any, NamedTuple

from roughgas.base import InputError
from roughgas.compiling.jit import jit
from roughgas.effects.drives import first_kicks
from roughgas.effects.settings import TEMPERATURE, Number, register
from roughgas.kernel.mathematics import add_scaled, gaussian_vector, scale
from roughgas.kernel.particles import (
    enter_box,
    mass_of,
    set_path_and_book,
    spin_mass_of,
    spin_of,
    turn_and_book,
)
from roughgas.kernel.state import EXPONENT, NOBODY

DRAG, POWER, BATH = "[0, 1e+09]", "[0, 1e+12]", TEMPERATURE.replace("(", "[")
SETTINGS = {
    "interval": Number("Time between the steps of a particle, in T.", "[0.0001, 1e+09]"),
    "drag": Number("Drag gamma on velocities, in 1/T.", DRAG, 0.0),
    "temperature": Number(
        "Temperature that drag and noise would lead to, in m a^2/T^2.", BATH, 0.0
    ),
    "power": Number(
        "In place of a temperature: what noise puts into the translation of a particle per time, "
        "in m a^2/T^3.",
        POWER,
        0.0,
    ),
    "spin_drag": Number("Drag on spins, in 1/T.", DRAG, 0.0),
    "spin_temperature": Number("Temperature of spins, as that of velocities.", BATH, 0.0),
    "spin_power": Number("What noise puts into the rotation of a particle per time.", POWER, 0.0),
}


class Drag(NamedTuple):
    """A bath without noise."""

    interval: float
    kept: float  # share of its velocity that a particle keeps in a step
    kept_spin: float
    noise: Any = None  # squared momentum per mass and component that a step adds; None: no noise
    spin_noise: Any = None


class Langevin(NamedTuple):
    """A Langevin bath: drag and noise on velocities and spins, each with its temperature."""

    interval: float
    kept: float
    kept_spin: float
    noise: float
    spin_noise: float

    @classmethod
    def from_settings(cls, settings, around):
        """Return the effect, or Drag; raise InputError where settings contradict each other."""
        if "shear" in around.effects:
            legal = "be without shear: its drag is that of a medium at rest"
            raise InputError("effects.langevin", "there", legal)
        dimension, interval = len(around.box), settings["interval"]
        kept, noise = _step(settings, "", dimension)
        kept_spin, spin_noise = _step(settings, "spin_", 2 * dimension - 3)
        if "spin" not in around.effects and (kept_spin < 1.0 or spin_noise > 0.0):
            key = next(k for k, value in settings.items() if k.startswith("spin_") and value)
            raise InputError(f"effects.langevin.{key}", settings[key], "be 0 where nothing spins")
        if noise == spin_noise == 0.0:
            if kept == kept_spin == 1.0:
                raise InputError("effects.langevin", settings, "have a drag or a power")
            return Drag(interval, kept, kept_spin)
        return cls(interval, kept, kept_spin, noise, spin_noise)


def _step(settings, of, components):
    """Return what a step of velocities, or of spins, keeps, and the variance that it adds."""
    names = f"{of}drag", f"{of}temperature", f"{of}power"
    drag, temperature, power = (settings[name] for name in names)
    if temperature and power:
        legal = f"be 0 beside {names[1]} {temperature:g}"
        raise InputError(f"effects.langevin.{names[2]}", power, legal)
    if temperature and not drag:
        legal = f"be 0 without {names[0]}: noise without drag has a power"
        raise InputError(f"effects.langevin.{names[1]}", temperature, legal)
    gone = 2.0 * drag * settings["interval"]
    decayed = -math.expm1(-gone)  # of a variance, in a step
    added = temperature * decayed
    if power:
        length = decayed / (2.0 * drag) if drag else settings["interval"]
        added = 2.0 * power / components * length
    return math.exp(-gone / 2.0), added


@jit
def predict_step(bath, index, state, scene, i):
    return state.moments.langevin[i], 0


@jit
def resolve_step(bath, index, what, state, scene, i, time):
    """Let particle i take a step of its Ornstein-Uhlenbeck process."""
    position, before = enter_box(state, scene, i, time)
    after = scale(before, bath.kept)
    if bath.noise is not None:
        size = math.sqrt(bath.noise / mass_of(state.bodies, i))
        noise = gaussian_vector(state.random, before, size)
        after = add_scaled(after, noise, 1.0)
    set_path_and_book(state, scene, i, position, before, after, time, state.ledger[0, index])
    if state.spin is not None:
        _turn(bath, index, state, scene, i)
    state.changes[i] += 1
    state.moments.langevin[i] += math.ldexp(bath.interval, int(state.counts[EXPONENT]))
    return NOBODY


@jit
def _turn(bath, index, state, scene, i):
    spin = scene.effects.spin
    before = spin_of(state.spin, scene.box, i)
    turn = scale(before, bath.kept_spin - 1.0)
    if bath.spin_noise is not None:
        size = math.sqrt(bath.spin_noise / spin_mass_of(state.bodies, spin, i))
        turn = add_scaled(turn, gaussian_vector(state.random, before, size), 1.0)
    turn_and_book(state, scene, i, before, turn, state.ledger[0, index])


STEPS = {"moment": first_kicks, "predict": predict_step, "resolve": resolve_step}
register(Drag, **STEPS)
register(Langevin, SETTINGS, random=True, drives=True, **STEPS)
