"""Mixtures: their structure, and stationary temperatures.

How dense mixtures of disks and spheres are packed: contact values and the equation of state. The
packing phi is the fraction of the area or volume that particles fill; at 0 a gas is dilute. M_k is
the mean of a^k over the particles.

Stationary temperatures are those of a gas that cools or is driven, or by Lun's formula for
mixtures. All rates are those of `mixtures`, at a packing that matters through the contact values
alone. Temperatures come in units of their mean over particles, <T_tr> = 1, unless said otherwise. A
gas whose contacts never change the spin of a species has T_rot = 0 there, as it starts without
spin.
"""

from collections.abc import Callable

import numpy as np

from roughgas.base import InputError, Interval
from roughgas.theory import mixtures
from roughgas.theory.arguments import POSITIVE, check, check_dimension
from roughgas.theory.closed_forms import CLOSE_PACKING, VOLUME
from roughgas.theory.mixtures import SURFACE, Mixture, Temperatures, mixture, rate_matrix


def mixture_contact_values(gas: Mixture, packing) -> np.ndarray:
    """Return chi_ij, the pair distribution at contact, (species, species).

    With z = 2 a_i a_j M_(D-1)/[(a_i + a_j) M_D]: disks 1/(1-phi) + 9 phi z/[16 (1-phi)^2] (J. T.
    Jenkins & F. Mancini, J. Appl. Mech. 54, 27, 1987), spheres 1/(1-phi) + 3 phi z/[2 (1-phi)^2] +
    phi^2 z^2/[2 (1-phi)^3] (T. Boublik, J. Chem. Phys. 53, 471, 1970; E. W. Grundke & D. Henderson,
    Mol. Phys. 24, 269, 1972; L. L. Lee & D. Levesque, Mol. Phys. 26, 1351, 1973). Equal radii give
    `contact_value`.
    """
    phi, D = _packing(gas, packing), gas.dimension
    relative = _mean_power(gas, D - 1) / _mean_power(gas, D)
    z = 2 * np.multiply.outer(gas.radius, gas.radius) / gas.distance * relative
    if D == 2:
        return 1 / (1 - phi) + 9 * phi * z / (16 * (1 - phi) ** 2)
    return 1 / (1 - phi) + 1.5 * phi * z / (1 - phi) ** 2 + (phi * z) ** 2 / (2 * (1 - phi) ** 3)


def mixture_density(gas: Mixture, packing) -> float:
    """Return particles per area or volume, in units of a^-D."""
    return float(_packing(gas, packing) / (VOLUME[gas.dimension] * _mean_power(gas, gas.dimension)))


def mixture_frequency(gas: Mixture, T_tr, packing) -> np.ndarray:
    """Return nu_ij, (species, species): contacts of a particle of i with those of j per time.

    `T_tr` are the temperatures of the species, or one of all. Their sum over j is how often a
    particle of i collides. Equal species give `collision_frequency` in all.
    """
    T_tr, crowding = _of_each("temperature T_tr", T_tr, gas), mixture_contact_values(gas, packing)
    return mixture_density(gas, packing) * mixtures.contact_frequencies(gas, T_tr, crowding)


def compressibility(gas: Mixture, packing, T_tr=1.0) -> float:
    """Return Z = p/(n <T_tr>) of the gas: 1 + the virial of its contacts.

    At contacts, p - n <T_tr> = n^2 S_D/(2 D) sum x_i x_j chi_ij (a_i + a_j)^D (1 + r_ij) m_ij (s_i
    + s_j)/2, S_D as in `mixtures`, m_ij being the reduced mass and s = T_tr/m. In an elastic
    mixture that is the equation of state of A. Santos, S. B. Yuste & M. Lopez de Haro (Mol. Phys.
    96, 1, 1999) for disks, with Henderson's for equal ones, and of Boublik and of G. A. Mansoori,
    N. F. Carnahan, K. E. Starling & T. W. Leland (J. Chem. Phys. 54, 1523, 1971) for spheres.
    """
    T_tr = _of_each("temperature T_tr", T_tr, gas)
    speed, D = T_tr / gas.mass, gas.dimension
    met = np.multiply.outer(gas.fraction, gas.fraction) * mixture_contact_values(gas, packing)
    push = gas.normal * np.add.outer(speed, speed) / 2
    virial = SURFACE[D] / (2 * D) * (met * gas.distance**D * push).sum()
    return float(1 + mixture_density(gas, packing) * virial / (gas.fraction @ T_tr))


def _of_each(key: str, value, gas: Mixture, legal: Interval | None = None) -> np.ndarray:
    """Return a number, or one of each species, as (species,), checked."""
    return np.broadcast_to(check(key, value, legal), gas.mass.shape)


def _mean_power(gas: Mixture, power: int) -> float:
    return gas.fraction @ gas.radius**power


def _packing(gas: Mixture, packing) -> np.ndarray:
    """Check a packing fraction: smaller ones fill gaps, so that only a full box is too dense."""
    one = (gas.radius == gas.radius[0]).all()
    interval = Interval(f"[0, {CLOSE_PACKING[gas.dimension]:.4f}]" if one else "[0, 1)")
    return check("packing", packing, interval)


ROUNDING = 1e-13
SWEEPS = 1000
SLOPE = 1e-5  # of ln T, for a derivative
BEGIN = 1e-2  # T_rot of gases that start with hardly any spin
FIRST, GROWTH, STEPS = 0.5, 4.0, 60  # first step in collisions per particle, the next over it
FARTHEST = 1.0  # of ln T in a step


def mixture_cooling(gas: Mixture, packing=0.0) -> Temperatures:
    """Return the temperatures of a gas that cools, once all of them fall at the same rate.

    Starting with hardly any spin, the rate equations of the logarithms are followed by implicit
    steps, short at first, so that a gas with friction goes where it would go, and at last Newton's.
    """
    return _cooling(gas, mixture_contact_values(gas, packing))


def mixture_decay_rate(gas: Mixture, packing=0.0) -> float:
    """Return -d ln T/dn of that state, n in collisions per particle; see `decay_rate`."""
    crowding = mixture_contact_values(gas, packing)
    return -_growth(gas, _cooling(gas, crowding), crowding)[0]


def mixture_relaxation_rate(gas: Mixture, packing=0.0) -> float:
    """Return how fast ratios of temperatures settle when the gas cools, per collision per particle.

    From the linear stability of `mixture_cooling`: the slowest of its modes, by central
    differences. For one species it is `relaxation_rate`.
    """
    crowding = mixture_contact_values(gas, packing)
    found = np.concatenate(_cooling(gas, crowding))
    moves = found > 0
    slopes = _slopes(lambda logs: _drift(gas, logs, moves, crowding), np.log(found[moves]))
    return float(-np.linalg.eigvals(slopes).real.max()) if slopes.size else 0.0


def mixture_driven(gas: Mixture, power, packing=0.0, spin_power=0.0) -> Temperatures:
    """Return the temperatures of a gas whose drive replaces what collisions dissipate.

    `power` and `spin_power` are what a particle of each species gets per time, in translation and
    rotation: numbers, or (species,). Only their ratios matter. White noise that accelerates all
    particles alike gives in proportion to the mass; `kick_power` is that of the effect thermostat.
    Raises InputError for a gas that cannot dissipate what it is given.
    """
    powers = [_of_each("power", power, gas), _of_each("spin power", spin_power, gas)]
    crowding, D = mixture_contact_values(gas, packing), gas.dimension
    drive = np.concatenate([powers[0] / D, powers[1] / (2 * D - 3)])
    moves = np.append(np.ones(len(gas.mass), bool), gas.spins)
    if not drive.any() or mixture_decay_rate(gas, packing) < ROUNDING or drive[~moves].any():
        raise InputError("power", powers[0].tolist(), "be what collisions can dissipate, and not 0")

    def sweep(state: np.ndarray) -> np.ndarray:
        trans, rot = np.split(state, 2)
        matrix = rate_matrix(gas, trans, rot, crowding)
        found = _solved(-matrix, drive, moves)
        # rates go with the root of the temperature: so its scale is there at once
        return np.cbrt(state * found**2)

    start = np.append(np.ones(len(gas.mass)), np.where(gas.spins, BEGIN, 0.0))
    return _in_units(gas, _settled(sweep, start))


def kick_power(gas: Mixture) -> np.ndarray:
    """Return what the effect `thermostat` gives to each species, over its mean, (species,).

    Kicks to pairs leave momentum as it is: of a pair, i gets m_j/(m_i + m_j) of the energy, which
    is the same for all pairs. To spins they give the same, whatever the species.
    """
    return 2 * (gas.fraction * gas.reduced_mass).sum(axis=1) / gas.mass


def mixture_rotation(gas: Mixture, T_tr, packing=0.0) -> np.ndarray:
    """Return T_rot of each species from all T_tr (> 0): Lun's formula for mixtures, (species,).

    Steady states whose drive adds translational energy only leave the energy of each species' spin
    as it is, on average over its contacts, whatever they do to translation. Units are those of
    T_tr. r matters through friction alone.
    """
    T_tr = _of_each("temperature T_tr", T_tr, gas, POSITIVE)
    crowding, size = mixture_contact_values(gas, packing), len(gas.mass)

    def sweep(T_rot: np.ndarray) -> np.ndarray:
        matrix = rate_matrix(gas, T_tr, T_rot, crowding)[size:]
        return _solved(-matrix[:, size:], matrix[:, :size] @ T_tr, gas.spins)

    return _settled(sweep, np.where(gas.spins, BEGIN * T_tr, 0.0))


def mimicry_masses(fraction, radius, dimension=2, packing=0.0) -> np.ndarray:
    """Return the masses with which a mixture looks like one component, their mean 1.

    Species of equal r, beta, mu and q then have equal temperatures T_tr and T_rot in a cooling gas,
    those of one species, whatever r, beta, mu and q are: at equal temperatures a contact changes
    the energy of i by m_ij/m_i times the same number, m_ij being the reduced mass, so that sum_j
    x_j chi_ij (a_i + a_j)^(D-1) m_ij^(1/2)/m_i has to be the same for all. The effect is that of A.
    Lasanta, F. Vega Reyes, V. Garzo & A. Santos (Phys. Fluids 31, 063306, 2019).
    """
    pairs = zip(*np.broadcast_arrays(fraction, radius), strict=True)
    species = [{"fraction": float(x), "radius": float(a)} for x, a in pairs]
    gas = mixture(species, 1.0, 1.0, check_dimension(dimension))
    crowding = mixture_contact_values(gas, packing)

    def sweep(mass: np.ndarray) -> np.ndarray:
        nu = mixtures.contact_frequencies(gas._replace(mass=mass), np.ones(len(mass)), crowding)
        loss = (nu * gas._replace(mass=mass).reduced_mass).sum(axis=1) / mass
        mass = mass * loss
        return mass / (gas.fraction @ mass)

    return _settled(sweep, np.ones(len(gas.mass)))


def _cooling(gas: Mixture, crowding: np.ndarray) -> Temperatures:
    """Return the temperatures of `mixture_cooling`."""
    state = np.append(np.ones(len(gas.mass)), np.where(gas.spins, BEGIN, 0.0))
    moves = state > 0
    logs = np.log(state[moves])

    def drift(logs: np.ndarray) -> np.ndarray:
        return _drift(gas, logs, moves, crowding)

    for step in FIRST * GROWTH ** np.arange(STEPS if len(logs) > 1 else 0):
        change = np.linalg.solve(np.eye(len(logs) - 1) / step - _slopes(drift, logs), drift(logs))
        logs[1:] += np.clip(change, -FARTHEST, FARTHEST)
        if np.abs(change).max() < ROUNDING:
            break
    state[moves] = np.exp(logs - logs.max())
    return _in_units(gas, state)


def _drift(gas: Mixture, logs, moves, crowding) -> np.ndarray:
    """Return d ln(T/T_1)/dn of all temperatures that move but the first, T_1, (..., moving - 1)."""
    state = np.zeros((*np.shape(logs)[:-1], len(moves)))
    state[..., moves] = np.exp(logs)
    growth = _growth(gas, Temperatures(*np.split(state, 2, -1)), crowding)[..., moves]
    return growth[..., 1:] - growth[..., :1]


def _slopes(function: Callable[[np.ndarray], np.ndarray], at: np.ndarray) -> np.ndarray:
    """Return the derivatives of a function by all its arguments but the first, in columns."""
    steps = SLOPE * np.eye(len(at))[1:]
    return (function(at + steps) - function(at - steps)).T / (2 * SLOPE)


def _growth(gas: Mixture, state: Temperatures, crowding: np.ndarray) -> np.ndarray:
    """Return d ln T/dn of T_tr and T_rot, n in collisions per particle; 0 where T = 0."""
    together = np.concatenate(state, -1)
    change = (rate_matrix(gas, *state, crowding) @ together[..., None])[..., 0]
    collisions = mixtures.contact_frequencies(gas, state.T_tr, crowding).sum(axis=-1) @ gas.fraction
    return change / np.where(together > 0, together, 1.0) / collisions[..., None]


def _solved(matrix: np.ndarray, right: np.ndarray, moves: np.ndarray) -> np.ndarray:
    """Return x of matrix x = right among what moves; 0 elsewhere."""
    found = np.zeros(len(right))
    found[moves] = np.linalg.solve(matrix[np.ix_(moves, moves)], right[moves])
    return found


def _settled(sweep: Callable[[np.ndarray], np.ndarray], state: np.ndarray) -> np.ndarray:
    """Return what a sweep leaves as it is, reached from `state` (>= 0)."""
    for _ in range(SWEEPS):
        before, state = state, sweep(state)
        if np.all(np.abs(state - before) <= ROUNDING * np.abs(state)):
            break
    return state


def _in_units(gas: Mixture, state: np.ndarray) -> Temperatures:
    T_tr, T_rot = np.split(state, 2)
    mean = gas.fraction @ T_tr
    return Temperatures(T_tr / mean, T_rot / mean)
