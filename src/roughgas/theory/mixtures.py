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

from typing import NamedTuple

import numpy as np

from roughgas.theory.arguments import check
from roughgas.theory.friction import moments
from roughgas.theory.mixture_composition import Mixture
from roughgas.theory.shares import quotient

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
