"""Species: particles of several sizes, masses, moments of inertia and materials.

A scene has this effect if its experiment has the key `species`. What the kernel makes of particles
that differ is in kernel/particles.py; here is what the settings mean. Units: a is the radius and m
the mass of a particle that is not of a species.

Contacts of two species have the arithmetic mean of their restitutions, of their roughnesses and of
their coefficients of friction, unless the experiment has others for them under `species_pairs`. A
species without a value of its own has that of the point.
"""

import math
import zlib
from collections.abc import Mapping, Sequence
from io import StringIO
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from roughgas.base import RESTITUTION, ROUGHNESS, InputError, Interval, NeedsError, shown
from roughgas.effects.settings import register
from roughgas.theory.closed_forms import packing_fraction

SIZE, MASS, INERTIA = Interval("[1e-06, 1e+06]"), Interval("[1e-12, 1e+12]"), Interval("[1e-06, 1]")
MATERIAL = {"restitution": RESTITUTION, "roughness": ROUGHNESS, "mu": Interval("[0, inf)")}
SUM = 1e-9  # by how much the sum of all fractions may miss 1
LARGEST_FILE = 100_000_000  # bytes of a file of radii
UNIFORM, LOGNORMAL, FILE = "uniform", "lognormal", "file"


class Species(NamedTuple):
    """Particles of several species."""

    kinds: int  # how many
    composition: int  # a checksum of the settings: scenes of other species are other scenes
    alike: bool = False  # all contacts have the scene's material, as while a gas is thermalised


class Kind(NamedTuple):
    """One species."""

    name: str
    number: int  # of its particles
    radius: tuple[float, ...]  # in a: one of all, or those that its particles have
    spread: tuple[str, float] | None  # the distribution of radii, and their relative deviation
    mass: float | None  # in m; None: radius^D
    inertia: float | None  # q; None: the scene's
    material: dict[str, float]  # what it has of its own: restitution, roughness, mu

    def radii(self, rng: np.random.Generator) -> np.ndarray:
        """Return the radii of its particles, drawn where they are not all given."""
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
        """Return whether a particle of it can have each of these radii (N,), to a relative
        tolerance."""
        mean = np.array(self.radius)
        if self.spread is None:
            nearest = mean[np.abs(radii[:, None] - mean).argmin(axis=1)]
            return np.isclose(radii, nearest, rtol=tolerance, atol=0.0)
        name, deviation = self.spread
        width = math.sqrt(3.0) * deviation if name == UNIFORM else math.inf
        return np.abs(radii / mean - 1.0) <= width + tolerance

    def mean_power(self, power: int) -> float:
        """Return the mean of radius^2 or radius^3, as it is expected."""
        mean = float(np.mean(np.array(self.radius) ** power))
        if self.spread is None:
            return mean
        name, deviation = self.spread
        if name == UNIFORM:
            return mean * (1.0 + (2 * power - 3) * deviation**2)
        return mean * (1.0 + deviation**2) ** (power * (power - 1) / 2)


class Mixture(NamedTuple):
    """All species of an experiment, and what is special about contacts of two of them."""

    kinds: tuple[Kind, ...]
    pairs: dict[tuple[int, int], dict[str, float]]  # both orders

    def effect(self) -> Species:
        """Return what the scene has of it."""
        return Species(len(self.kinds), zlib.crc32(repr(self).encode()))

    def largest(self) -> float:
        """Return the largest radius, as far as it is known before any are drawn."""
        return max(max(kind.radius) for kind in self.kinds)

    def mean_volume(self, dimension: int) -> float:
        """Return the mean of radius^D; of radii that are drawn, what it is on average."""
        total = sum(kind.number for kind in self.kinds)
        return sum(kind.number * kind.mean_power(dimension) for kind in self.kinds) / total

    def own(self, quantity: str) -> list[float]:
        """Return what any species or pair has in place of the point's restitution or the like."""
        parts = [*(kind.material for kind in self.kinds), *self.pairs.values()]
        return [part[quantity] for part in parts if quantity in part]

    def table(self, common: Mapping[str, float]) -> np.ndarray:
        """Return restitution, roughness and mu of pairs, as State.bodies has them; `common` are
        those of the point."""
        own = np.array(
            [[kind.material.get(name, common[name]) for name in MATERIAL] for kind in self.kinds]
        )
        found = 0.5 * (own[:, None] + own)
        for (k, other), special in self.pairs.items():
            for place, name in enumerate(MATERIAL):
                found[k, other, place] = special.get(name, found[k, other, place])
        return np.concatenate([found, own[:, None]], axis=1)


def mixture_of(experiment: Mapping[str, Any]) -> Mixture | None:
    """Return the species of an experiment, None without any.

    Raises InputError for settings that are illegal or contradict each other, and where a file of
    radii cannot be read.
    """
    if not experiment.get("species"):
        if experiment.get("species_pairs"):
            raise NeedsError("species_pairs", "species")
        return None
    settings = experiment["species"]
    numbers = _numbers(settings, experiment["particles"])
    kinds = tuple(
        _kind(f"species[{k}]", k, number, one, experiment["effects"])
        for k, (number, one) in enumerate(zip(numbers, settings, strict=True))
    )
    names = [kind.name for kind in kinds]
    for k, name in enumerate(names):
        if name in names[:k]:
            raise InputError(f"species[{k}].name", name, "be given once")
    pairs = {}
    for number, one in enumerate(experiment.get("species_pairs") or []):
        key = f"species_pairs[{number}]"
        k, other = (_index(f"{key}.between", name, names) for name in one["between"])
        if (k, other) in pairs:
            raise InputError(f"{key}.between", shown(one["between"]), "be given once")
        pairs[k, other] = pairs[other, k] = _material(key, one, experiment["effects"])
    return Mixture(kinds, pairs)


def packing(experiment: Mapping[str, Any]) -> float:
    """Return the packing fraction of a closed box; of radii that are drawn, the expected one."""
    mixture, box = mixture_of(experiment), experiment["box"]
    volume = 1.0 if mixture is None else mixture.mean_volume(len(box))
    return volume * packing_fraction(experiment["particles"], box)


def _numbers(settings, particles):
    """Return the number of particles of each species: fractions are rounded so that all add up."""
    given = "number" if "number" in settings[0] else "fraction"
    for k, one in enumerate(settings):
        if ("number" in one) == ("fraction" in one):
            legal = "be given, or number" if "number" not in one else "not stand beside number"
            raise InputError(f"species[{k}].fraction", one.get("fraction", "(nothing)"), legal)
        if given not in one:
            other = "fraction" if given == "number" else "number"
            legal = f"be a {given}, as that of species[0]"
            raise InputError(f"species[{k}].{other}", one[other], legal)
    parts = [one[given] for one in settings]
    total = sum(parts)
    if given == "number":
        if total != particles:
            raise InputError("sum of species.number", total, f"be particles, {particles}")
        return parts
    if abs(total - 1.0) > SUM:
        raise InputError("sum of species.fraction", total, f"be 1 within {SUM:g}")
    shares = [part / total * particles for part in parts]
    numbers = [math.floor(share + SUM) for share in shares]
    rest = sorted(range(len(parts)), key=lambda k: numbers[k] - shares[k])
    for k in rest[: particles - sum(numbers)]:
        numbers[k] += 1
    for k, number in enumerate(numbers):
        if number == 0:
            legal = f"be large enough for one of {particles} particles"
            raise InputError(f"species[{k}].fraction", parts[k], legal)
    return numbers


def _kind(key, index, number, settings, effects):
    radius, spread = _radius(f"{key}.radius", settings.get("radius", 1.0))
    if "inertia" in settings and "spin" not in effects:
        legal = "not be given where particles do not spin"
        raise InputError(f"{key}.inertia", settings["inertia"], legal)
    return Kind(
        settings.get("name", str(index)),
        number,
        radius,
        spread,
        _own(key, "mass", settings, MASS),
        _own(key, "inertia", settings, INERTIA),
        _material(key, settings, effects),
    )


def _own(key, name, settings, interval):
    return interval.check(f"{key}.{name}", settings[name]) if name in settings else None


def _radius(key, given):
    """Return a species' radii, and how they are spread."""
    if not isinstance(given, Mapping):
        many = given if isinstance(given, Sequence) else [given]
        return tuple(SIZE.check(key, one) for one in many), None
    name = given["distribution"]
    part, *others = ("file",) if name == FILE else ("deviation", "mean")
    for one in given:
        if one not in ("distribution", part, *others):
            raise InputError(f"{key}.{one}", given[one], f"not be given with {name}")
    if part not in given:
        raise InputError(f"{key}.{part}", "(nothing)", f"be given with {name}")
    if name == FILE:
        return _radii_in(f"{key}.file", given["file"]), None
    most = 1.0 / math.sqrt(3.0) if name == UNIFORM else 1.0
    deviation = Interval(f"[0, {most:.4g})").check(f"{key}.deviation", given["deviation"])
    return (SIZE.check(f"{key}.mean", given.get("mean", 1.0)),), (name, deviation)


def _radii_in(key, path):
    legal = f"be a text file of radii, one per line, of at most {LARGEST_FILE:.0e} bytes"
    try:
        # nothing that waits, such as a pipe, or has no end, such as /dev/zero
        if not Path(path).is_file() or not 0 < Path(path).stat().st_size <= LARGEST_FILE:
            raise InputError(key, path, legal)
        # as text: numpy would decompress an archive
        numbers = np.loadtxt(StringIO(Path(path).read_text("utf-8")), ndmin=1)
    except InputError:
        raise
    except (OSError, ValueError) as error:
        raise InputError(key, path, legal) from error
    if numbers.ndim != 1 or not numbers.size:
        raise InputError(key, path, legal)
    return tuple(SIZE.check(f"radius in {path}", one) for one in numbers.tolist())


def _material(key, settings, effects):
    """Return what a species, or a pair of them, has of its own."""
    for name, effect in (("roughness", "spin"), ("mu", "friction")):
        if name in settings and effect not in effects:
            raise NeedsError(f"{key}.{name}", f"effects.{effect}")
    found = {name: _own(key, name, settings, legal) for name, legal in MATERIAL.items()}
    return {name: value for name, value in found.items() if value is not None}


def _index(key, name, names):
    """Return the index of a species that is named, or given by its index."""
    if isinstance(name, str) and name in names:
        return names.index(name)
    if isinstance(name, int) and 0 <= name < len(names):
        return name
    legal = f"be one of {', '.join(names)}, or an index below {len(names)}"
    raise InputError(key, shown(name), legal)


register(Species, {})
