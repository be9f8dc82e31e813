"""A Langevin bath: drag and noise on velocities and on spins, with separate temperatures.

The velocity of a particle of mass m obeys dv = -gamma v dt + (2 gamma T/m)^(1/2) dW between its
contacts, its spin the same equation with the drag and temperature of spins. Every particle takes an
exact step of this process (G. E. Uhlenbeck & L. S. Ornstein, Phys. Rev. 36, 823 (1930)) once per
`interval` h,

    v -> v e^(-gamma h) + [(1 - e^(-2 gamma h)) T/m]^(1/2) xi,    xi Gaussian of variance 1,

the particles in a random order and evenly spaced, and flies freely in between, so that contacts
remain events. Steps, flights and elastic contacts all leave the Maxwellian at T invariant: an
elastic gas has exactly the temperature of its bath, for any h. The diffusion coefficient depends on
h: it is T/(m gamma) times (gamma h/2) coth(gamma h/2).

Noise without drag has a `power` in place of a temperature, as in the thermostat (drives.py), but
acts on single particles, so that momentum is not conserved. Drag without noise drives nothing: such
a gas cools.

Spinners. Where the medium rotates, drag leads spins to its angular velocity Omega: a step is
w -> Omega + (w - Omega) e^(-gamma h) plus noise. The medium of each species may rotate differently.

Under shear the medium flows with the rate G of the images, v_x = G (y - L/2), and drag acts on the
velocity relative to it where the particle is; the image of a particle in the box has the flow of
its own height. A medium that flows rotates with -G/2. Flight between steps shears the relative
velocity c exactly, dc_x/dt = -G c_y, so that steps and flights have a stationary state in closed
form without contacts (theory.pressure_in_sheared_bath): its stress differs from the limit of small
h by a share (gamma h)^2/3.
"""

import math
from typing import Annotated, Any, Literal, NamedTuple

from msgspec.structs import asdict

from roughgas.base import InputError
from roughgas.base.fields import Settings, described, number
from roughgas.compiling.jit import jit
from roughgas.effects.drives import first_kick_times
from roughgas.effects.settings import SPIN_VELOCITY_RANGE, TEMPERATURE_RANGE, register
from roughgas.kernel.mathematics import add_scaled, along_axis, gaussian_vector, scale, subtract
from roughgas.kernel.particles import (
    change_spin_and_book,
    enter_box,
    mass_of,
    radius_of,
    set_path_and_book,
    spin_mass_of,
    spin_of,
)
from roughgas.kernel.state import EXPONENT, NOBODY

BATH_TEMPERATURES = TEMPERATURE_RANGE.replace("(", "[")


class LangevinSettings(Settings, frozen=True, kw_only=True):
    """Settings of `langevin`."""

    interval: Annotated[
        float, number("[0.0001, 1e+09]", "Time between the steps of a particle, in T.")
    ]
    drag: Annotated[float, number("[0, 1e+09]", "Drag gamma on velocities, in 1/T.")] = 0.0
    temperature: Annotated[
        float,
        number(BATH_TEMPERATURES, "Temperature that drag and noise would lead to, in m a^2/T^2."),
    ] = 0.0
    power: Annotated[
        float,
        number(
            "[0, 1e+12]",
            "In place of a temperature: energy per time that noise puts into the translation of a "
            "particle, in m a^2/T^3.",
        ),
    ] = 0.0
    spin_drag: Annotated[float, number("[0, 1e+09]", "Drag on spins, in 1/T.")] = 0.0
    spin_temperature: Annotated[
        float, number(BATH_TEMPERATURES, "Temperature of spins, in m a^2/T^2, as `temperature`.")
    ] = 0.0
    spin_power: Annotated[
        float, number("[0, 1e+12]", "Energy per time that noise puts into a particle's rotation.")
    ] = 0.0
    spin_velocity: (
        Annotated[
            float,
            number(
                SPIN_VELOCITY_RANGE,
                "Angular velocity of the medium times a, to which drag leads spins, in a/T; if not "
                "given, 0, or under shear minus half of the shear rate.",
            ),
        ]
        | None
    ) = None
    spin_axis: Annotated[
        Literal["x", "y", "z"],
        described("Axis about which the medium rotates; in the plane z, normal to it."),
    ] = "z"


class Rotation(NamedTuple):
    """Rotation of a bath's medium about an axis."""

    spin_velocity: tuple[float, ...]  # (species,) angular velocity times a, in a/T
    axis: int  # component of spins that is about this axis


class Drag(NamedTuple):
    """A bath without noise: velocities and spins decay by a constant factor in each step."""

    interval: float  # between the steps of a particle, in T
    velocity_factor: float  # velocity after a step over that before
    spin_factor: float  # the same of the spin
    noise: Any = None  # variance of the momentum over the mass, per component and step; None: 0
    spin_noise: Any = None  # the same of the spin
    rotation: Any = None  # Rotation of the medium; None: spins decay to 0
    shear_rate: Any = None  # of the medium, in 1/T; None: velocities decay to 0


class RotatingMedium(Drag):
    """A bath without noise whose medium rotates, and supplies energy to spins."""


class Langevin(NamedTuple):
    """A Langevin bath: drag and noise on velocities and spins, each with its temperature."""

    interval: float
    velocity_factor: float
    spin_factor: float
    noise: float
    spin_noise: float
    rotation: Any = None
    shear_rate: Any = None

    @classmethod
    def from_settings(cls, settings, context):
        """Return the effect from LangevinSettings and a SceneContext; without noise a Drag.

        Raises InputError for settings that contradict each other or the scene.
        """
        dimension, interval = len(context.box), settings.interval
        velocity_factor, noise = _step_factors(settings, "", dimension)
        spin_factor, spin_noise = _step_factors(settings, "spin_", 2 * dimension - 3)
        if "spin" not in context.effects and (spin_factor < 1.0 or spin_noise > 0.0):
            values = asdict(settings).items()
            key, value = next(pair for pair in values if pair[0].startswith("spin_") and pair[1])
            raise InputError(f"effects.langevin.{key}", value, "be 0 where nothing spins")
        shear_rate = _shear_rate(context)
        medium = _rotation(settings, context, shear_rate), shear_rate if settings.drag else None
        if noise == spin_noise == 0.0:
            if velocity_factor == spin_factor == 1.0:
                raise InputError("effects.langevin", asdict(settings), "have a drag or a power")
            is_driven = medium[0] is not None and any(medium[0].spin_velocity)
            kind = RotatingMedium if is_driven else Drag
            return kind(interval, velocity_factor, spin_factor, None, None, *medium)
        return cls(interval, velocity_factor, spin_factor, noise, spin_noise, *medium)


def _step_factors(settings, prefix, components):
    """Return the factor of velocities or spins in a step, and the variance that noise adds.

    `prefix` of the keys in settings is "" for velocities and "spin_" for spins; `components` is the
    number of components of the velocity or spin. The variance is of one component, times the mass,
    in m a^2/T^2. Raises InputError for a power beside a temperature, and a temperature without
    drag.
    """
    keys = f"{prefix}drag", f"{prefix}temperature", f"{prefix}power"
    drag, temperature, power = (getattr(settings, name) for name in keys)
    if temperature and power:
        legal = f"be 0 beside {keys[1]} {temperature:g}"
        raise InputError(f"effects.langevin.{keys[2]}", power, legal)
    if temperature and not drag:
        legal = f"be 0 without {keys[0]}: noise without drag has a power"
        raise InputError(f"effects.langevin.{keys[1]}", temperature, legal)
    exponent = 2.0 * drag * settings.interval
    removed_share = -math.expm1(-exponent)  # share of a variance that a step removes
    variance = temperature * removed_share
    if power:
        duration = removed_share / (2.0 * drag) if drag else settings.interval
        variance = 2.0 * power / components * duration
    return math.exp(-exponent / 2.0), variance


def _shear_rate(context):
    """Return the shear rate of the scene that has this SceneContext, in 1/T; None without shear."""
    shear = context.effects.get("shear")
    return None if shear is None else shear.velocity / context.box[1]


def _rotation(settings, context, shear_rate):
    """Return the Rotation of the medium; None where it has no spin velocity.

    Species without one have the bath's, which under shear is by default the vorticity's, minus half
    of the `shear_rate`. Raises InputError for a spin velocity without drag on spins, and for
    another axis than z in the plane and under shear.
    """
    common, of_species = settings.spin_velocity, context.spin_velocity_of_species
    keys = "effects.langevin", *(f"species[{k}]" for k in range(len(of_species)))
    for key, velocity in zip(keys, (common, *of_species), strict=True):
        if velocity and not settings.spin_drag:
            raise InputError(
                f"{key}.spin_velocity", velocity, "be 0 without effects.langevin.spin_drag"
            )
    axis, is_plane = settings.spin_axis, len(context.box) == 2
    if axis != "z" and (is_plane or shear_rate is not None):
        legal = f"be z {'in two dimensions' if is_plane else 'under shear, as its vorticity'}"
        raise InputError("effects.langevin.spin_axis", axis, legal)
    if common is None and shear_rate is not None:
        common = -0.5 * shear_rate
    velocities = [common if velocity is None else velocity for velocity in of_species or (None,)]
    if not settings.spin_drag or velocities == [None] * len(velocities):
        return None
    return Rotation(
        tuple(float(velocity or 0.0) for velocity in velocities),
        0 if is_plane else "xyz".index(axis),
    )


@jit
def predict_step(bath, account, state, scene, i):
    """Return the time of particle i's next step in the bath, and 0, its only event code.

    Hook `predict` (kernel.hooks), which does without the account.
    """
    return state.particle_times.langevin[i], 0


@jit
def resolve_step(bath, account, code, state, scene, i, time):
    """Let particle i take a step of its Ornstein-Uhlenbeck process at `time`; return NOBODY (-1).

    Hook `resolve` (kernel.hooks): the energy gained is entered in the effect's account, whose index
    is `account`; the code is always 0.
    """
    position, before = enter_box(state, scene, i, time)
    if bath.shear_rate is None:
        after = scale(before, bath.velocity_factor)
    else:
        flow = along_axis(before, 0, bath.shear_rate * (position[1] - scene.middle))
        after = add_scaled(flow, subtract(before, flow), bath.velocity_factor)
    if bath.noise is not None:
        size = math.sqrt(bath.noise / mass_of(state.bodies, i))
        noise = gaussian_vector(state.random, before, size)
        after = add_scaled(after, noise, 1.0)
    set_path_and_book(state, scene, i, position, before, after, time, state.ledger[0, account])
    if state.spin is not None:
        _step_spin(bath, account, state, scene, i)
    state.changes[i] += 1
    state.particle_times.langevin[i] += math.ldexp(bath.interval, int(state.counts[EXPONENT]))
    return NOBODY


@jit
def _step_spin(bath, account, state, scene, i):
    """Let particle i's spin take a step of its Ornstein-Uhlenbeck process; enter the energy."""
    spin = scene.effects.spin
    before = spin_of(state.spin, scene.box, i)
    if bath.rotation is None:
        spin_change = scale(before, bath.spin_factor - 1.0)
    else:
        target = _spin_of_medium(bath.rotation, state.bodies, before, i)
        spin_change = scale(subtract(before, target), bath.spin_factor - 1.0)
    if bath.spin_noise is not None:
        size = math.sqrt(bath.spin_noise / spin_mass_of(state.bodies, spin, i))
        spin_change = add_scaled(spin_change, gaussian_vector(state.random, before, size), 1.0)
    change_spin_and_book(state, scene, i, before, spin_change, state.ledger[0, account])


@jit
def _spin_of_medium(rotation, bodies, like, i):
    """Return the spin of particle i if it rotates with the medium, a vector like `like`, in a/T.

    `bodies` is State.bodies. The surface velocity of a larger particle is larger.
    """
    species = 0 if bodies is None else bodies.species[i]
    return along_axis(like, rotation.axis, rotation.spin_velocity[species] * radius_of(bodies, i))


STEPS = {"particle_times": first_kick_times, "predict": predict_step, "resolve": resolve_step}
register(Drag, **STEPS)
register(RotatingMedium, drives=True, **STEPS)
register(Langevin, LangevinSettings, random=True, drives=True, **STEPS)
