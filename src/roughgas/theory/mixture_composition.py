"""What a mixture consists of: species as in config.yaml, for theory."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from roughgas.base import InputError, Interval, not_one_of, shown
from roughgas.theory.arguments import (
    POSITIVE,
    check,
    check_dimension,
    moment_of_inertia,
)

SPECIES = "species_json"
"""Attribute of datasets of mixtures, from which theory knows them: see `prediction_of_mixtures`."""
AMOUNTS = "fraction", "number"
MATERIAL = {"restitution": "restitution r", "roughness": "roughness beta", "mu": "friction mu"}
KEYS = (*AMOUNTS, "radius", "mass", "inertia", "name", *MATERIAL)
SUM_OF_FRACTIONS = 1e-6
"""How far the fractions may be from adding up to 1."""
NODES = 6
"""Radii that stand for a distribution: they have its moments up to the eleventh."""
SEVERAL = "be a list of species, each with a fraction or a number"
SPREAD = "be a number, a list, or a mapping of distribution (uniform, lognormal, file), deviation"
WIDEST = {"uniform": Interval("[0, 0.5773]"), "lognormal": Interval("[0, 1)")}
SHARE = Interval("(0, 1]")


class Mixture(NamedTuple):
    """Species of a gas, arrays (species,), and of their pairs, (species, species).

    Species whose radii are spread are several here, which `part_of` numbers as they were given.
    """

    fraction: np.ndarray
    radius: np.ndarray
    mass: np.ndarray
    inertia: np.ndarray
    restitution: np.ndarray
    roughness: np.ndarray
    friction: np.ndarray
    dimension: int
    part_of: np.ndarray

    @property
    def reduced_mass(self) -> np.ndarray:
        """m_i m_j/(m_i + m_j)."""
        return 1 / np.add.outer(1 / self.mass, 1 / self.mass)

    @property
    def distance(self) -> np.ndarray:
        """Distance of two particles in contact, a_i + a_j."""
        return np.add.outer(self.radius, self.radius)

    @property
    def normal(self) -> np.ndarray:
        """m (1 + r), the normal impulse over the normal speed."""
        return self.reduced_mass * (1 + self.restitution)

    @property
    def tangential(self) -> np.ndarray:
        """Return k, the tangential impulse over the tangential speed of contacts that stick."""
        ease = 1 / (self.mass * self.inertia)
        return (1 + self.roughness) / (1 / self.reduced_mass + np.add.outer(ease, ease))

    @property
    def spins(self) -> np.ndarray:
        """Whether contacts ever change the spin of a species."""
        return np.asarray(((self.tangential > 0) & (self.friction > 0)).any(axis=1))


def mixture(species, r, beta, dimension=2, inertia=None, mu=np.inf, pairs=()) -> Mixture:
    """Return the mixture of some species, given as `species` in config.yaml.

    Each is a mapping with its `fraction` or `number`; `radius`, 1 by default, a list, or a
    distribution, for which some radii stand; `mass`, by default radius^D; and `inertia`,
    `restitution`, `roughness` and `mu`, by default those of the other arguments. In a contact of
    two species r, beta and mu are the means of theirs, unless `pairs` (`species_pairs` in
    config.yaml) has others.
    """
    dimension = check_dimension(dimension)
    inertia = moment_of_inertia(dimension) if inertia is None else inertia
    if not isinstance(species, Sequence) or isinstance(species, str) or not species:
        raise InputError("species", shown(species), SEVERAL)
    for one in species:
        _check_keys(one)
    spread = [_radii(one.get("radius", 1.0)) for one in species]
    part_of = np.repeat(np.arange(len(species)), [len(radii) for radii, _ in spread])
    radius, share = (np.concatenate(column) for column in zip(*spread, strict=True))
    own = _each(species, "mass", "species.mass", radius[0], POSITIVE)[part_of]
    heavy = np.array(["mass" in one for one in species])[part_of]
    given = {"restitution": r, "roughness": beta, "mu": mu}
    tables = {key: pair_means(_each(species, key, MATERIAL[key], x)) for key, x in given.items()}
    _put_pairs(tables, pairs, species)
    restitution, roughness, friction = (
        table[np.ix_(part_of, part_of)] for table in tables.values()
    )
    return Mixture(
        _fractions(species)[part_of] * share,
        radius,
        np.where(heavy, own, radius**dimension),
        _each(species, "inertia", "inertia q", inertia)[part_of],
        restitution,
        roughness,
        friction,
        dimension,
        part_of,
    )


def pair_means(values: np.ndarray) -> np.ndarray:
    """Return what a contact of two species has, (species, species): the mean of their values."""
    return np.add.outer(values, values) / 2


def _each(species, key: str, label: str, default: Any, legal: Interval | None = None) -> np.ndarray:
    """Return what each species has of a quantity, (species,), checked."""
    return np.array([float(check(label, one.get(key, default), legal)) for one in species])


def _radii(given: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return radii, and the shares of the species' particles that have them."""
    if not isinstance(given, Mapping):
        found = np.sort(np.atleast_1d(check("species.radius", given, POSITIVE)))
        few = len(np.unique(found)) <= 2 * NODES
        radii, counts = np.unique(found if few else _grouped(found), return_counts=True)
        return radii, counts / len(found)
    kind = given.get("distribution")
    if kind == "file" and "file" in given:
        return _radii(np.loadtxt(given["file"], ndmin=1))
    if kind not in WIDEST or "deviation" not in given:
        raise InputError("species.radius", shown(given), SPREAD)
    mean = float(check("species.radius.mean", given.get("mean", 1.0), POSITIVE))
    deviation = float(check("species.radius.deviation", given["deviation"], WIDEST[kind]))
    if deviation == 0:
        return np.array([mean]), np.ones(1)
    if kind == "uniform":
        nodes, weights = np.polynomial.legendre.leggauss(NODES)
        return mean * (1 + np.sqrt(3) * deviation * nodes), weights / 2
    width = np.sqrt(np.log1p(deviation**2))
    nodes, weights = np.polynomial.hermite_e.hermegauss(NODES)
    return mean * np.exp(width * nodes - width**2 / 2), weights / weights.sum()


def _grouped(radii: np.ndarray) -> np.ndarray:
    """Return sorted radii, each replaced by the mean of some neighbours: few values in all."""
    groups = np.array_split(radii, 2 * NODES)
    return np.concatenate([np.full(len(group), group.mean()) for group in groups])


def _put_pairs(tables: Mapping[str, np.ndarray], pairs, species) -> None:
    """Put into the tables what contacts of two species have in place of the means."""
    names = [str(one.get("name", k)) for k, one in enumerate(species)]
    for one in pairs:
        places = [str(name) for name in one["between"]]
        for name in places:
            if name not in names:
                raise not_one_of("species_pairs.between", name, names)
        k, other = map(names.index, places)
        for key, table in tables.items():
            if key in one:
                table[k, other] = table[other, k] = check(MATERIAL[key], one[key])


def _check_keys(one: Any) -> None:
    if not isinstance(one, Mapping):
        raise InputError("species", one, SEVERAL)
    for key in one:
        if key not in KEYS:
            raise not_one_of("species", key, KEYS)
    if sum(key in one for key in AMOUNTS) != 1:
        raise InputError("species", dict(one), "have either fraction or number")


def _fractions(species: Sequence[Mapping[str, Any]]) -> np.ndarray:
    """Return x_i, from fractions that add up to 1 or from numbers."""
    kinds = {key for one in species for key in AMOUNTS if key in one}
    if len(kinds) > 1:
        raise InputError("species", "fraction and number", "have one of them throughout")
    kind = kinds.pop()
    legal = Interval("(0, 1]") if kind == "fraction" else Interval("(0, inf)")
    amounts = np.array([float(check(f"species.{kind}", one[kind], legal)) for one in species])
    total = amounts.sum()
    if kind == "fraction" and abs(total - 1) > SUM_OF_FRACTIONS:
        raise InputError("species.fraction", f"{total:g} in all", "add up to 1")
    return amounts / total
