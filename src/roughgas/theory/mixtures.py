"""Mixtures of rough disks or spheres: composition, collision frequencies and rate equations.

Species i has the number fraction x_i, radius a_i, mass m_i, moment of inertia q_i = I_i/(m_i
a_i^2), and the temperatures T_i = m_i <v^2>/D of translation and tau_i = q_i m_i a_i^2
<omega^2>/(2D-3) of rotation, T_tr and T_rot in the code. A contact of i and j has the normal
restitution r_ij, the roughness beta_ij, the coefficient of friction mu_ij, the reduced mass m = m_i
m_j/(m_i + m_j), and the impulse on i, with g = v_i - v_j - (a_i omega_i + a_j omega_j) x n,

    J = -m (1 + r) g_n - k g_t,    k = (1 + beta)/[1/m + 1/(m_i q_i) + 1/(m_j q_j)],

or k = mu m (1 + r) |g_n|/|g_t| if that is less: the contact slides. With Maxwellian velocities that
are uncorrelated before contacts, s_i = T_i/m_i, w_i = tau_i/(m_i q_i), and kappa_1 k and
kappa_2 k^2 the averages of k and k^2 with sliding contacts included (`friction.moments`; kappa = 1
without friction), a contact changes the energies of i by, on average,

    D/2 dT_i = -2 m (1+r) s_i + [m (1+r)]^2 (s_i+s_j)/m_i
               + (D-1) [kappa_2 k^2 G/(2 m_i) - kappa_1 k s_i]
    (2D-3)/2 dtau_i = (D-1) [kappa_2 k^2 G/(2 q_i m_i) - kappa_1 k w_i]

with G = s_i + s_j + w_i + w_j, and a particle of i has contacts with particles of j at the rate

    nu_ij = S_D n_j chi_ij (a_i + a_j)^(D-1) [(s_i + s_j)/2 pi]^(1/2),    S_D = 2 pi or 4 pi.

That is the approximation of A. Santos, G. M. Kremer & V. Garzo (Prog. Theor. Phys. Suppl. 184, 31,
2010) for spheres, of A. Santos (Phys. Rev. E 98, 012904, 2018) for disks, and of A. Megias &
A. Santos (AIP Conf. Proc. 2132, 080003, 2019) for both. It was derived for this package without
access to their formulae; for a single species it is `rate_equations`.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from roughgas.base import InputError, Interval, Record, short_repr, unknown_name_error
from roughgas.base.labels import names_of
from roughgas.theory.arguments import POSITIVE, check, check_dimension, moment_of_inertia, quotient
from roughgas.theory.friction import moments

SPECIES_ATTRIBUTE = "species_json"
"""Attribute of datasets of mixtures that describes their species: see `prediction`."""
AMOUNTS = "fraction", "number"
MATERIAL = {"restitution": "restitution r", "roughness": "roughness beta", "mu": "friction mu"}
KEYS = (*AMOUNTS, "radius", "mass", "inertia", "name", *MATERIAL, "spin_velocity")
FRACTIONS_TOLERANCE = 1e-6
"""Largest deviation of the sum of fractions from 1."""
QUADRATURE_NODES = 6
"""Number of radii that represent a distribution: they have its moments up to the eleventh."""
LEGAL_SPECIES = "be a list of species, each with a fraction or a number"
LEGAL_RADIUS = (
    "be a number, a list, or a mapping of distribution (uniform, lognormal, file), deviation"
)
LEGAL_DEVIATIONS = {"uniform": Interval("[0, 0.5773]"), "lognormal": Interval("[0, 1)")}
SHARE = Interval("(0, 1]")


class Mixture(NamedTuple):
    """Properties of the components of a gas, arrays (components,), and of their pairs.

    Radii are in units of a, masses in m, `inertia` is q_i; `restitution`, `roughness` and
    `friction` have shape (components, components). A species whose radii are spread consists of
    several components; `species_of` is the index of the species of each component. Elsewhere
    "species" stands for components as well.
    """

    fraction: np.ndarray
    radius: np.ndarray
    mass: np.ndarray
    inertia: np.ndarray
    restitution: np.ndarray
    roughness: np.ndarray
    friction: np.ndarray
    dimension: int
    species_of: np.ndarray

    @property
    def reduced_mass(self) -> np.ndarray:
        """Reduced mass of each pair of species, m_i m_j/(m_i + m_j), (species, species)."""
        return 1 / np.add.outer(1 / self.mass, 1 / self.mass)

    @property
    def distance(self) -> np.ndarray:
        """Distance of the centres of two particles in contact, a_i + a_j, (species, species)."""
        return np.add.outer(self.radius, self.radius)

    @property
    def normal_impulse(self) -> np.ndarray:
        """Normal impulse over the normal relative velocity, m (1 + r), (species, species)."""
        return self.reduced_mass * (1 + self.restitution)

    @property
    def tangential_impulse(self) -> np.ndarray:
        """Tangential impulse over the slip velocity of sticking contacts, k, (species, species)."""
        ease = 1 / (self.mass * self.inertia)
        return (1 + self.roughness) / (1 / self.reduced_mass + np.add.outer(ease, ease))

    @property
    def rotates(self) -> np.ndarray:
        """Whether contacts ever change the spin of each species, (species,)."""
        return np.asarray(((self.tangential_impulse > 0) & (self.friction > 0)).any(axis=1))


def mixture(species, r, beta, dimension=2, inertia=None, mu=np.inf, pairs=()) -> Mixture:
    """Return the mixture of `species`, which have the format of `species` in config.yaml.

    Each species is a mapping with its `fraction` or `number`; `radius`, 1 by default, a list, or a
    distribution, which is represented by a few radii; `mass`, by default radius^D; and `inertia`,
    `restitution`, `roughness` and `mu`, which default to the arguments `inertia`, `r`, `beta` and
    `mu` (coefficient of friction). A contact of two species has the means of their r, beta and mu,
    unless `pairs` (`species_pairs` in config.yaml) has other values. A `spin_velocity`, of the
    medium of a bath, changes no contact. Raises InputError for illegal species.
    """
    dimension = check_dimension(dimension)
    inertia = moment_of_inertia(dimension) if inertia is None else inertia
    if not isinstance(species, Sequence) or isinstance(species, str) or not species:
        raise InputError("species", short_repr(species), LEGAL_SPECIES)
    for entry in species:
        _check_species(entry)
    radii_and_shares = [_radii_and_shares(entry.get("radius", 1.0)) for entry in species]
    species_of = np.repeat(np.arange(len(species)), [len(radii) for radii, _ in radii_and_shares])
    radius, radius_share = (
        np.concatenate(column) for column in zip(*radii_and_shares, strict=True)
    )
    given_masses = _column(species, "mass", "species.mass", radius[0], POSITIVE)[species_of]
    mass_given = np.array(["mass" in entry for entry in species])[species_of]
    defaults = {"restitution": r, "roughness": beta, "mu": mu}
    tables = {
        key: pair_means(_column(species, key, MATERIAL[key], x)) for key, x in defaults.items()
    }
    _override_pairs(tables, pairs, species)
    restitution, roughness, friction = (
        table[np.ix_(species_of, species_of)] for table in tables.values()
    )
    return Mixture(
        _fractions(species)[species_of] * radius_share,
        radius,
        np.where(mass_given, given_masses, radius**dimension),
        _column(species, "inertia", "inertia q", inertia)[species_of],
        restitution,
        roughness,
        friction,
        dimension,
        species_of,
    )


def pair_means(values: np.ndarray) -> np.ndarray:
    """Return the mean (values[i] + values[j])/2 of each pair of species, (species, species).

    `values` has a quantity of each species, (species,).
    """
    return np.add.outer(values, values) / 2


def _column(
    species, key: str, argument: str, default: Any, legal: Interval | None = None
) -> np.ndarray:
    """Return the quantity `key` of each species, (species,), checked.

    `default` is its value where a species lacks it, `argument` its name in error messages, `legal`
    the legal interval.
    """
    return np.array([float(check(argument, entry.get(key, default), legal)) for entry in species])


def _radii_and_shares(setting: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return radii of a species, and the share of its particles with each radius, (radii,) each.

    `setting` is the `radius` of a species: a number, numbers, or a mapping with a `distribution`.
    """
    if not isinstance(setting, Mapping):
        values = np.sort(np.atleast_1d(check("species.radius", setting, POSITIVE)))
        all_fit = len(np.unique(values)) <= 2 * QUADRATURE_NODES
        radii, counts = np.unique(values if all_fit else _group_means(values), return_counts=True)
        return radii, counts / len(values)
    distribution = setting.get("distribution")
    if distribution == "file" and "file" in setting:
        return _radii_and_shares(np.loadtxt(setting["file"], ndmin=1))
    if distribution not in LEGAL_DEVIATIONS or "deviation" not in setting:
        raise InputError("species.radius", short_repr(setting), LEGAL_RADIUS)
    mean = float(check("species.radius.mean", setting.get("mean", 1.0), POSITIVE))
    deviation = float(
        check("species.radius.deviation", setting["deviation"], LEGAL_DEVIATIONS[distribution])
    )
    if deviation == 0:
        return np.array([mean]), np.ones(1)
    if distribution == "uniform":
        nodes, weights = np.polynomial.legendre.leggauss(QUADRATURE_NODES)
        return mean * (1 + np.sqrt(3) * deviation * nodes), weights / 2
    width = np.sqrt(np.log1p(deviation**2))
    nodes, weights = np.polynomial.hermite_e.hermegauss(QUADRATURE_NODES)
    return mean * np.exp(width * nodes - width**2 / 2), weights / weights.sum()


def _group_means(radii: np.ndarray) -> np.ndarray:
    """Return sorted `radii`, each replaced by the mean of its group of neighbours, (radii,)."""
    groups = np.array_split(radii, 2 * QUADRATURE_NODES)
    return np.concatenate([np.full(len(group), group.mean()) for group in groups])


def _override_pairs(tables: Mapping[str, np.ndarray], pairs, species) -> None:
    """Replace means in `tables` by the values that `pairs` has for contacts of two species.

    `tables` has a matrix (species, species) of r, beta and mu by name; it is changed.
    """
    names = names_of(species)
    for pair in pairs:
        pair_names = [str(name) for name in pair["between"]]
        for name in pair_names:
            if name not in names:
                raise unknown_name_error("species_pairs.between", name, names)
        first, second = map(names.index, pair_names)
        for key, table in tables.items():
            if key in pair:
                table[first, second] = table[second, first] = check(MATERIAL[key], pair[key])


def _check_species(entry: Any) -> None:
    """Raise InputError unless `entry`, a species in settings, is a mapping with legal keys."""
    if not isinstance(entry, Mapping):
        raise InputError("species", entry, LEGAL_SPECIES)
    for key in entry:
        if key not in KEYS:
            raise unknown_name_error("species", key, KEYS)
    if sum(key in entry for key in AMOUNTS) != 1:
        raise InputError("species", dict(entry), "have either fraction or number")


def _fractions(species: Sequence[Record]) -> np.ndarray:
    """Return number fractions x_i (species,), from fractions that add up to 1 or from numbers."""
    keys = {key for entry in species for key in AMOUNTS if key in entry}
    if len(keys) > 1:
        raise InputError("species", "fraction and number", "have one of them throughout")
    amount_key = keys.pop()
    legal = Interval("(0, 1]") if amount_key == "fraction" else Interval("(0, inf)")
    amounts = np.array(
        [float(check(f"species.{amount_key}", entry[amount_key], legal)) for entry in species]
    )
    total = amounts.sum()
    if amount_key == "fraction" and abs(total - 1) > FRACTIONS_TOLERANCE:
        raise InputError("species.fraction", f"{total:g} in all", "add up to 1")
    return amounts / total


SURFACE = {2: 2 * np.pi, 3: 4 * np.pi}
"""Circumference of the unit circle and surface of the unit sphere, S_D."""


class Temperatures(NamedTuple):
    """Temperatures of translation and rotation of each species, arrays (species,)."""

    T_tr: np.ndarray
    T_rot: np.ndarray

    @property
    def R(self) -> np.ndarray:
        """Share of rotational energy of each species, R = T_rot/(T_rot + T_tr), (species,)."""
        return self.T_rot / (self.T_rot + self.T_tr)

    def averaged_over_radii(self, gas: Mixture) -> "Temperatures":
        """Return the temperatures of the species in settings, means over the radii of each.

        `gas` is the mixture whose components have these temperatures.
        """
        total = np.bincount(gas.species_of, gas.fraction)
        return Temperatures(*(np.bincount(gas.species_of, gas.fraction * T) / total for T in self))

    def overall_ratio(self, gas: Mixture) -> float:
        """Return R of the whole `gas`, the rotational share of energy per degree of freedom."""
        translational, rotational = (gas.fraction @ T for T in self)
        return rotational / (rotational + translational)


def contact_frequencies(gas: Mixture, T_tr, crowding=1.0) -> np.ndarray:
    """Return nu_ij over the number density, (species, species), in a^D/T.

    nu_ij is the number of contacts of a particle of species i with particles of j per time. `T_tr`
    has the translational temperatures (species,). `crowding` is chi_ij, from
    `mixture_contact_values`; 1 in a dilute gas.
    """
    speed = _pair_sums(T_tr / gas.mass)
    area = SURFACE[gas.dimension] * gas.distance ** (gas.dimension - 1)
    return gas.fraction * crowding * area * np.sqrt(speed / (2 * np.pi))


def rate_matrix(gas: Mixture, T_tr, T_rot, crowding=1.0) -> np.ndarray:
    """Return A, (2 species, 2 species), of the rate equations d(T_tr, T_rot)/dt = A (T_tr, T_rot).

    `T_tr` and `T_rot` have shape (..., species), A (..., 2 species, 2 species). Per time and number
    density, and with the same `crowding`, as `contact_frequencies`. A depends on the temperatures
    through frequencies and, with friction, through the share of sliding contacts. Its off-diagonal
    elements are >= 0.
    """
    D, size = gas.dimension, len(gas.mass)
    first_moment, second_moment = _friction_moments(gas, T_tr, T_rot)
    nu = contact_frequencies(gas, T_tr, crowding)
    mass, spin_mass = gas.mass[:, None], (gas.mass * gas.inertia)[:, None]
    normal_impulse, tangential_gain = (
        gas.normal_impulse,
        (D - 1) * second_moment * gas.tangential_impulse**2 / 2,
    )
    tangential_loss, identity = (D - 1) * first_moment * gas.tangential_impulse, np.eye(size)

    def block(
        pair_gain: np.ndarray, own_loss: np.ndarray, source_mass: np.ndarray, degrees: int
    ) -> np.ndarray:
        """Return a block of A: gains from both partners, less the loss of the particle itself.

        `pair_gain` and `own_loss` are energies per contact over s or w (module), (species, species)
        or broadcast; `source_mass` the mass or spin mass of the source of energy, `degrees` the
        degrees of freedom of the energy that changes.
        """
        from_partner = nu * pair_gain
        total = from_partner + identity * (from_partner - nu * own_loss).sum(axis=-1)[..., None]
        return 2 * total / (degrees * source_mass)

    into_velocity, into_spin = tangential_gain / mass, tangential_gain / spin_mass
    zeros = np.zeros((size, size))
    velocity = block(
        normal_impulse**2 / mass + into_velocity, 2 * normal_impulse + tangential_loss, gas.mass, D
    )
    from_spin = block(into_velocity, zeros, gas.mass * gas.inertia, D)
    to_spin = block(into_spin, zeros, gas.mass, 2 * D - 3)
    spin = block(into_spin, tangential_loss, gas.mass * gas.inertia, 2 * D - 3)
    rows = [np.concatenate(pair, -1) for pair in ((velocity, from_spin), (to_spin, spin))]
    return np.concatenate(rows, -2)


def mixture_changes(gas: Mixture, T_tr, T_rot, crowding=1.0, density=1.0) -> Temperatures:
    """Return dT_tr/dt and dT_rot/dt of each species due to collisions, in m a^2/T^3.

    `T_tr` and `T_rot` have shape (species,); `density` is the number of particles per a^D,
    `crowding` chi_ij as for `contact_frequencies`.
    """
    T_tr, T_rot = check("temperature T_tr", T_tr), check("temperature T_rot", T_rot)
    matrix = rate_matrix(gas, T_tr, T_rot, crowding)
    change = check("density", density) * matrix @ np.concatenate([T_tr, T_rot])
    return Temperatures(*np.split(change, 2))


def _pair_sums(values: np.ndarray) -> np.ndarray:
    """Return x_i + x_j, (..., species, species), of `values` x (..., species)."""
    return values[..., :, None] + values[..., None, :]


def _friction_moments(gas: Mixture, T_tr, T_rot) -> tuple[np.ndarray, np.ndarray]:
    """Return kappa_1 and kappa_2 of each pair, (..., species, species), averages of the module's k.

    They are the means of the tangential impulse and of its square over the means that sticking
    contacts have.
    """
    velocity, spin = T_tr / gas.mass, T_rot / (gas.mass * gas.inertia)
    speed = _pair_sums(velocity)
    slip = np.sqrt(quotient(speed + _pair_sums(spin), speed))
    return moments(
        quotient(gas.tangential_impulse, gas.friction * gas.normal_impulse) * slip, gas.dimension
    )
