"""Species: particles of several sizes, masses, moments of inertia and materials.

A scene has this effect if its experiment has the key `species`. This file interprets the settings;
kernel/particles.py has the properties of pairs of unlike particles. Units: radius a and mass m of a
particle without species.

Contacts of two species have the arithmetic mean of their restitutions, of their roughnesses and of
their coefficients of friction mu, unless `species_pairs` in the experiment sets other values. A
species that sets no value has the value of the point (r, beta).
"""

import math
import zlib
from collections.abc import Mapping, Sequence
from io import StringIO
from typing import Annotated, Any, Literal, NamedTuple, Protocol

import numpy as np
from msgspec import Meta
from msgspec.structs import asdict

from roughgas.base import RESTITUTION, ROUGHNESS, InputError, Interval, NeedsError, short_repr
from roughgas.base.fields import NAME, Settings, described, number, numbers, whole
from roughgas.base.files import MAX_TABLE_BYTES, content_of
from roughgas.effects.settings import SPIN_VELOCITY_RANGE, register
from roughgas.theory.closed_forms import packing_fraction

SIZE = Interval("[1e-06, 1e+06]")
MATERIAL = ("restitution", "roughness", "mu")
SUM_TOLERANCE = 1e-9  # of the sum of all fractions, which is 1
UNIFORM, LOGNORMAL, FILE = "uniform", "lognormal", "file"


Name = Annotated[
    str,
    NAME,
    described("Its name in datasets, `species_pairs` and sweeps; its index from 0 if not given."),
]
Radius = Annotated[
    float,
    number(SIZE.text, "Radius in a; or radii to draw from, by a list or a distribution."),
]
Radii = Annotated[tuple[Radius, ...], numbers(1, None, "Radii that are drawn from, in a.")]
SpeciesRestitution = Annotated[
    float, number(RESTITUTION.text, "Restitution; that of the point if not given.")
]
SpeciesRoughness = Annotated[
    float, number(ROUGHNESS.text, "Roughness; that of the point if not given.")
]
Friction = Annotated[
    float,
    number("[0, inf)", "Coefficient of friction mu; that of `friction` if not given."),
]
Fraction = Annotated[
    float, number("(0, 1]", "Fraction of all particles; all fractions add up to 1.")
]
Number = Annotated[
    int,
    whole(
        1,
        100_000_000,
        "In place of a fraction: number of its particles; all numbers add up to `particles`.",
    ),
]
Mass = Annotated[
    float,
    number("[1e-12, 1e+12]", "Mass in m; radius^D if not given, as of one density."),
]
Inertia = Annotated[
    float,
    number(
        "[1e-06, 1]",
        "q = I/(m a^2), of its own mass and radius; that of `spin` if not given.",
    ),
]
SpinVelocity = Annotated[
    float,
    number(
        SPIN_VELOCITY_RANGE,
        "Angular velocity of its medium times a, to which drag of `langevin` leads its spins, in "
        "a/T; that of `langevin` if not given.",
    ),
]


class RadiiSettings(Settings, frozen=True, kw_only=True):
    """A distribution of radii."""

    distribution: Annotated[
        Literal["uniform", "lognormal", "file"], described("Its form; `file` takes radii from one.")
    ]
    mean: Annotated[float, number(SIZE.text, "Mean radius in a; 1 if not given.")] | None = None
    deviation: Annotated[float, number("[0, 1]", "Standard deviation over the mean.")] | None = None
    file: Annotated[str, Meta(min_length=1, description="Path of a text of radii.")] | None = None


class MaterialSettings(Settings, frozen=True, kw_only=True):
    """Material that a species, or a pair of species, has in place of the point's."""

    restitution: SpeciesRestitution | None = None
    roughness: SpeciesRoughness | None = None
    mu: Friction | None = None


class SpeciesSettings(MaterialSettings, frozen=True, kw_only=True):
    """A species, with its fraction of all particles or its number of particles."""

    name: Name | None = None
    fraction: Fraction | None = None
    number: Number | None = None
    radius: Radius | Radii | RadiiSettings = 1.0
    mass: Mass | None = None
    inertia: Inertia | None = None
    spin_velocity: SpinVelocity | None = None


class PairSettings(MaterialSettings, frozen=True, kw_only=True):
    """The material of contacts of two species, in place of the mean of theirs."""

    between: Annotated[
        tuple[int | str, ...],
        numbers(2, 2, "Two species, each by its name or its index from 0; or the same one twice."),
    ]


class Composition(Protocol):
    """Settings that define the particles of a scene."""

    @property
    def particles(self) -> int:
        """Number of particles."""

    @property
    def box(self) -> Sequence[Any]:
        """Sides of the box along each axis, in particle radii a; "open" without an upper end."""

    @property
    def effects(self) -> Mapping[str, Settings]:
        """Settings of the active effects, by name."""

    @property
    def species(self) -> Sequence[SpeciesSettings]:
        """The species' settings; empty if all particles are alike."""

    @property
    def species_pairs(self) -> Sequence[PairSettings]:
        """Materials of contacts of two species."""


class Species(NamedTuple):
    """Particles of several species."""

    kinds: int  # number of species
    composition: int  # checksum of the settings: distinguishes scenes of different species
    same_material: bool = False  # all contacts have the scene's material, as in a thermalisation


class Kind(NamedTuple):
    """A species of an experiment, as read from settings."""

    name: str
    number: int  # of particles
    radius: tuple[float, ...]  # in a: common, or to draw from, or one per particle
    spread: tuple[str, float] | None  # distribution of radii, and their relative deviation
    mass: float | None  # in m; None: radius^D
    inertia: float | None  # q; None: the scene's
    material: dict[str, float]  # restitution, roughness, mu, as far as the species sets them

    def radii(self, rng: np.random.Generator) -> np.ndarray:
        """Return the radii of the species' particles, (number,) in particle radii a.

        They are drawn from its distribution, unless the settings have a common radius or one per
        particle.
        """
        mean = np.array(self.radius)
        if self.spread is not None:
            name, deviation = self.spread
            if name == UNIFORM:
                return mean * (1.0 + math.sqrt(3.0) * deviation * rng.uniform(-1, 1, self.number))
            width = math.sqrt(math.log(1.0 + deviation**2))
            return mean * np.exp(width * rng.standard_normal(self.number) - 0.5 * width**2)
        if len(mean) in (1, self.number):
            return np.broadcast_to(mean, self.number)
        return rng.choice(mean, self.number)

    def admits(self, radii: np.ndarray, tolerance: float) -> np.ndarray:
        """Return a flag for each of these radii (N,): whether the species can have it.

        `tolerance` is relative to the radius; the radii are in particle radii a.
        """
        mean = np.array(self.radius)
        if self.spread is None:
            nearest = mean[np.abs(radii[:, None] - mean).argmin(axis=1)]
            return np.isclose(radii, nearest, rtol=tolerance, atol=0.0)
        name, deviation = self.spread
        width = math.sqrt(3.0) * deviation if name == UNIFORM else math.inf
        return np.abs(radii / mean - 1.0) <= width + tolerance

    def mean_power(self, power: int) -> float:
        """Return the expectation value of radius^power, in a^power, for the power 2 or 3."""
        mean = float(np.mean(np.array(self.radius) ** power))
        if self.spread is None:
            return mean
        name, deviation = self.spread
        if name == UNIFORM:
            return mean * (1.0 + (2 * power - 3) * deviation**2)
        return mean * (1.0 + deviation**2) ** (power * (power - 1) / 2)


class Mixture(NamedTuple):
    """All species of an experiment, and the materials set for contacts of pairs of them."""

    kinds: tuple[Kind, ...]
    pairs: dict[tuple[int, int], dict[str, float]]  # both orders

    def effect(self) -> Species:
        """Return the effect of a scene with these species."""
        return Species(len(self.kinds), zlib.crc32(repr(self).encode()))

    def largest(self) -> float:
        """Return the largest radius in the settings, in particle radii a.

        Radii that are drawn may be larger.
        """
        return max(max(kind.radius) for kind in self.kinds)

    def mean_volume(self, dimension: int) -> float:
        """Return the mean of radius^D over all particles, in a^D, for D = `dimension`.

        For drawn radii it is the expected mean.
        """
        total = sum(kind.number for kind in self.kinds)
        return sum(kind.number * kind.mean_power(dimension) for kind in self.kinds) / total

    def values_set(self, quantity: str) -> list[float]:
        """Return the values of a material's quantity that species or pairs of species set.

        The quantity is "restitution", "roughness" or "mu".
        """
        materials = [*(kind.material for kind in self.kinds), *self.pairs.values()]
        return [material[quantity] for material in materials if quantity in material]

    def table(self, common: Mapping[str, float]) -> np.ndarray:
        """Return restitution, roughness and mu of pairs of species, as in State.bodies.pairs.

        The shape is (species, species + 1, 3), the last column for walls. `common` has the values,
        by name, of species that set none.
        """
        materials = np.array(
            [[kind.material.get(name, common[name]) for name in MATERIAL] for kind in self.kinds]
        )
        pairs = 0.5 * (materials[:, None] + materials)
        for (k, m), special in self.pairs.items():
            for column, name in enumerate(MATERIAL):
                pairs[k, m, column] = special.get(name, pairs[k, m, column])
        return np.concatenate([pairs, materials[:, None]], axis=1)


def mixture_of(settings: Composition) -> Mixture | None:
    """Return the mixture of the species in settings; None without species.

    Raises InputError for settings that contradict each other, and where a file of radii cannot be
    read.
    """
    if not settings.species:
        if settings.species_pairs:
            raise NeedsError("species_pairs", "species")
        return None
    numbers = _particle_numbers(settings.species, settings.particles)
    kinds = tuple(
        _build_kind(f"species[{k}]", k, number, species, settings.effects)
        for k, (number, species) in enumerate(zip(numbers, settings.species, strict=True))
    )
    names = [kind.name for kind in kinds]
    for k, name in enumerate(names):
        if name in names[:k]:
            raise InputError(f"species[{k}].name", name, "be given once")
    pairs = {}
    for n, pair in enumerate(settings.species_pairs):
        key = f"species_pairs[{n}]"
        k, m = (_species_index(f"{key}.between", name, names) for name in pair.between)
        if (k, m) in pairs:
            raise InputError(f"{key}.between", short_repr(list(pair.between)), "be given once")
        pairs[k, m] = pairs[m, k] = _material_set(key, pair, settings.effects)
    return Mixture(kinds, pairs)


def packing(settings: Composition) -> float:
    """Return the packing fraction, the share of a closed box that particles fill.

    For drawn radii it is the expectation value.
    """
    mixture, box = mixture_of(settings), settings.box
    volume = 1.0 if mixture is None else mixture.mean_volume(len(box))
    return volume * packing_fraction(settings.particles, box)


def _particle_numbers(species, particles):
    """Return the number of particles of each species, all together `particles`.

    Fractions are rounded so that all add up. Raises InputError for species that do not all have a
    fraction, or all a number, and for sums that are not 1 or `particles`.
    """
    key = "fraction" if species[0].number is None else "number"
    for k, kind in enumerate(species):
        if (kind.number is None) == (kind.fraction is None):
            legal = "be given, or number" if kind.number is None else "not stand beside number"
            value = "(nothing)" if kind.fraction is None else kind.fraction
            raise InputError(f"species[{k}].fraction", value, legal)
        if getattr(kind, key) is None:
            other_key = "fraction" if key == "number" else "number"
            legal = f"be a {key}, as that of species[0]"
            raise InputError(f"species[{k}].{other_key}", getattr(kind, other_key), legal)
    amounts = [getattr(kind, key) for kind in species]
    total = sum(amounts)
    if key == "number":
        if total != particles:
            raise InputError("sum of species.number", total, f"be particles, {particles}")
        return amounts
    if abs(total - 1.0) > SUM_TOLERANCE:
        raise InputError("sum of species.fraction", total, f"be 1 within {SUM_TOLERANCE:g}")
    shares = [amount / total * particles for amount in amounts]
    numbers = [math.floor(share + SUM_TOLERANCE) for share in shares]
    by_remainder = sorted(range(len(amounts)), key=lambda k: numbers[k] - shares[k])
    for k in by_remainder[: particles - sum(numbers)]:
        numbers[k] += 1
    for k, count in enumerate(numbers):
        if count == 0:
            legal = f"be large enough for one of {particles} particles"
            raise InputError(f"species[{k}].fraction", amounts[k], legal)
    return numbers


def _build_kind(key, index, number, species, effects):
    """Return the Kind of a species from its settings; `key` names them in errors.

    `effects` are the settings of the active effects; raises InputError where these do without the
    species' properties.
    """
    radius, spread = _radii_and_spread(f"{key}.radius", species.radius)
    if species.inertia is not None and "spin" not in effects:
        legal = "not be given where particles do not spin"
        raise InputError(f"{key}.inertia", species.inertia, legal)
    if species.spin_velocity is not None and "langevin" not in effects:
        raise NeedsError(f"{key}.spin_velocity", "effects.langevin")
    return Kind(
        str(index) if species.name is None else species.name,
        number,
        radius,
        spread,
        species.mass,
        species.inertia,
        _material_set(key, species, effects),
    )


def _radii_and_spread(key, radius):
    """Return the radii of a species, and its (distribution, relative deviation) or None.

    `radius` is the setting: a number, a tuple, or RadiiSettings; `key` names it in errors.
    """
    if not isinstance(radius, RadiiSettings):
        return radius if isinstance(radius, tuple) else (radius,), None
    distribution = radius.distribution
    required_key, *optional_keys = ("file",) if distribution == FILE else ("deviation", "mean")
    for name, value in asdict(radius).items():
        if value is not None and name not in ("distribution", required_key, *optional_keys):
            raise InputError(f"{key}.{name}", value, f"not be given with {distribution}")
    if getattr(radius, required_key) is None:
        raise InputError(f"{key}.{required_key}", "(nothing)", f"be given with {distribution}")
    if distribution == FILE:
        return _radii_in(f"{key}.file", radius.file), None
    max_deviation = 1.0 / math.sqrt(3.0) if distribution == UNIFORM else 1.0
    deviation = Interval(f"[0, {max_deviation:.4g})").check(f"{key}.deviation", radius.deviation)
    return (1.0 if radius.mean is None else radius.mean,), (distribution, deviation)


def _radii_in(key, path):
    """Return the radii in the text file at `path`, in particle radii a.

    Raises InputError for a file that is no list of radii; `key` names the setting in errors.
    """
    legal = f"be a text file of radii, one per line, of at most {MAX_TABLE_BYTES:.0e} bytes"
    try:
        content = content_of(path, key, MAX_TABLE_BYTES)
        if not content:
            raise InputError(key, path, legal)
        # as text: numpy would decompress an archive
        numbers = np.loadtxt(StringIO(content.decode("utf-8"), newline=None), ndmin=1)
    except (OSError, ValueError) as error:
        raise InputError(key, path, legal) from error
    if numbers.ndim != 1 or not numbers.size:
        raise InputError(key, path, legal)
    return tuple(SIZE.check(f"radius in {path}", radius) for radius in numbers.tolist())


def _material_set(key, settings, effects):
    """Return the quantities of material by name that a species, or a pair of species, sets.

    Raises InputError for quantities that the active effects do without; `key` names the settings.
    """
    for name, effect in (("roughness", "spin"), ("mu", "friction")):
        if getattr(settings, name) is not None and effect not in effects:
            raise NeedsError(f"{key}.{name}", f"effects.{effect}")
    values = {name: getattr(settings, name) for name in MATERIAL}
    return {name: value for name, value in values.items() if value is not None}


def _species_index(key, name, names):
    """Return the index of a species from its name or index; raise InputError for any other.

    `names` are the names of all species; `key` names the setting in errors.
    """
    if isinstance(name, str) and name in names:
        return names.index(name)
    if isinstance(name, int) and 0 <= name < len(names):
        return name
    legal = f"be one of {', '.join(names)}, or an index below {len(names)}"
    raise InputError(key, short_repr(name), legal)


register(Species, None)
