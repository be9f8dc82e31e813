"""Mixtures of rough disks or spheres: composition, collision frequencies and rate equations.

Species i has the number fraction x_i, radius a_i, mass m_i, inertia q_i = I_i/(m_i a_i^2), and the
temperatures T_i = m_i <v^2>/D and tau_i = q_i m_i a_i^2 <omega^2>/(2D-3). A contact of i and j has
r_ij, beta_ij, mu_ij, the reduced mass m = m_i m_j/(m_i + m_j), and the impulse on i, with g =
v_i - v_j - (a_i omega_i + a_j omega_j) x n,

    J = -m (1 + r) g_n - k g_t,    k = (1 + beta)/[1/m + 1/(m_i q_i) + 1/(m_j q_j)],

or k = mu m (1 + r) |g_n|/|g_t| where that is less: the contact slides. With Maxwellian velocities
that are uncorrelated before contacts, s_i = T_i/m_i, w_i = tau_i/(m_i q_i), and kappa_1 k and
kappa_2 k^2 the averages of the k that acts (1 and 1 without friction; `friction`), a contact gives
to i, on average,

    D/2 dT_i = -2 m (1+r) s_i + [m (1+r)]^2 (s_i+s_j)/m_i
               + (D-1) [kappa_2 k^2 G/(2 m_i) - kappa_1 k s_i]
    (2D-3)/2 dtau_i = (D-1) [kappa_2 k^2 G/(2 q_i m_i) - kappa_1 k w_i]

with G = s_i + s_j + w_i + w_j, and one particle of i meets those of j

    nu_ij = S_D n_j chi_ij (a_i + a_j)^(D-1) [(s_i + s_j)/2 pi]^(1/2),    S_D = 2 pi or 4 pi,

times per time. That is the approximation of A. Santos, G. M. Kremer & V. Garzo
(Prog. Theor. Phys. Suppl. 184, 31, 2010) for spheres, of A. Santos (Phys. Rev. E 98, 012904, 2018)
for disks, and of A. Megias & A. Santos (AIP Conf. Proc. 2132, 080003, 2019) for both. It was
derived for this package without their formulae at hand; of one species it is `rate_equations`.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from roughgas.base import InputError, Interval, names_of, not_one_of, shown
from roughgas.theory.arguments import POSITIVE, check, check_dimension, moment_of_inertia, quotient
from roughgas.theory.friction import moments

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
    names = names_of({"species": species})
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


SURFACE = {2: 2 * np.pi, 3: 4 * np.pi}
"""Circumference of the unit circle and surface of the unit sphere, S_D."""


class Temperatures(NamedTuple):
    """Temperatures T_tr and T_rot of each species, arrays (species,)."""

    T_tr: np.ndarray
    T_rot: np.ndarray

    @property
    def R(self) -> np.ndarray:
        """R = T_rot/(T_rot + T_tr) of each species."""
        return self.T_rot / (self.T_rot + self.T_tr)

    def as_given(self, gas: Mixture) -> "Temperatures":
        """Return those of the species as they were given, means over their radii."""
        total = np.bincount(gas.part_of, gas.fraction)
        return Temperatures(*(np.bincount(gas.part_of, gas.fraction * T) / total for T in self))

    def overall_ratio(self, gas: Mixture) -> float:
        """Return R of the gas: of its energies per particle and degree of freedom."""
        translational, rotational = (gas.fraction @ T for T in self)
        return rotational / (rotational + translational)


def contact_frequencies(gas: Mixture, T_tr, crowding=1.0) -> np.ndarray:
    """Return nu_ij per time and number density: contacts of a particle of i with those of j.

    `crowding` is chi_ij, from `mixture_contact_values`; 1 in a dilute gas.
    """
    speed = _of_pairs(T_tr / gas.mass)
    area = SURFACE[gas.dimension] * gas.distance ** (gas.dimension - 1)
    return gas.fraction * crowding * area * np.sqrt(speed / (2 * np.pi))


def rate_matrix(gas: Mixture, T_tr, T_rot, crowding=1.0) -> np.ndarray:
    """Return A, (2 species, 2 species): d(T_tr, T_rot)/dt = A (T_tr, T_rot).

    Temperatures may have more axes before that of the species. Per time and number density, as
    `contact_frequencies`. It depends on the temperatures through
    frequencies and, with friction, through the share of contacts that slide. All that is off its
    diagonal is >= 0.
    """
    D, size = gas.dimension, len(gas.mass)
    first, second = _sliding(gas, T_tr, T_rot)
    nu = contact_frequencies(gas, T_tr, crowding)
    m, turned = gas.mass[:, None], (gas.mass * gas.inertia)[:, None]
    push, drag = gas.normal, (D - 1) * second * gas.tangential**2 / 2
    lost, eye = (D - 1) * first * gas.tangential, np.eye(size)

    def part(from_all: np.ndarray, own: np.ndarray, other: np.ndarray, spins: int) -> np.ndarray:
        """Return what squared velocities bring: of both partners, and of the particle itself."""
        both = nu * from_all
        total = both + eye * (both - nu * own).sum(axis=-1)[..., None]
        return 2 * total / (spins * other)

    into_velocity, into_spin = drag / m, drag / turned
    nothing = np.zeros((size, size))
    velocity = part(push**2 / m + into_velocity, 2 * push + lost, gas.mass, D)
    from_spin = part(into_velocity, nothing, gas.mass * gas.inertia, D)
    to_spin = part(into_spin, nothing, gas.mass, 2 * D - 3)
    spin = part(into_spin, lost, gas.mass * gas.inertia, 2 * D - 3)
    rows = [np.concatenate(pair, -1) for pair in ((velocity, from_spin), (to_spin, spin))]
    return np.concatenate(rows, -2)


def mixture_changes(gas: Mixture, T_tr, T_rot, crowding=1.0, density=1.0) -> Temperatures:
    """Return dT_tr/dt and dT_rot/dt of each species due to collisions.

    `density` is the number of particles per a^D, `crowding` as for `contact_frequencies`.
    """
    T_tr, T_rot = check("temperature T_tr", T_tr), check("temperature T_rot", T_rot)
    matrix = rate_matrix(gas, T_tr, T_rot, crowding)
    change = check("density", density) * matrix @ np.concatenate([T_tr, T_rot])
    return Temperatures(*np.split(change, 2))


def _of_pairs(values: np.ndarray) -> np.ndarray:
    """Return x_i + x_j, (..., species, species), of x (..., species)."""
    return values[..., :, None] + values[..., None, :]


def _sliding(gas: Mixture, T_tr, T_rot) -> tuple[np.ndarray, np.ndarray]:
    """Return kappa_1 and kappa_2 of each pair."""
    velocity, spin = T_tr / gas.mass, T_rot / (gas.mass * gas.inertia)
    speed = _of_pairs(velocity)
    slip = np.sqrt(quotient(speed + _of_pairs(spin), speed))
    return moments(quotient(gas.tangential, gas.friction * gas.normal) * slip, gas.dimension)
