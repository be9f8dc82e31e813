"""Mixtures: contact values, equation of state, and stationary temperatures.

The packing phi is the fraction of the area or volume that particles fill; 0 is a dilute gas. M_k is
the mean of a^k over the particles.

Stationary temperatures: of a gas that cools or is driven, or by Lun's formula for mixtures. All
rates are computed by `mixtures`, and depend on the packing through the contact values alone.
Temperatures are in units of their mean over particles, <T_tr> = 1, unless stated otherwise. A gas
starts without spin: a species has T_rot = 0 if contacts never change its spin.

R = T_rot/(T_rot + T_tr) is the share of rotational energy; x_i, a_i, m_i, q_i, r_ij and other
symbols of species are defined in `mixtures`.
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

    `packing` is the packing fraction phi. With z = 2 a_i a_j M_(D-1)/[(a_i + a_j) M_D]: disks
    1/(1-phi) + 9 phi z/[16 (1-phi)^2] (J. T. Jenkins & F. Mancini, J. Appl. Mech. 54, 27, 1987),
    spheres 1/(1-phi) + 3 phi z/[2 (1-phi)^2] + phi^2 z^2/[2 (1-phi)^3] (T. Boublik, J. Chem. Phys.
    53, 471, 1970; E. W. Grundke & D. Henderson, Mol. Phys. 24, 269, 1972; L. L. Lee & D. Levesque,
    Mol. Phys. 26, 1351, 1973). Equal radii give `contact_value`.
    """
    phi, D = _checked_packing(gas, packing), gas.dimension
    relative = _mean_radius_power(gas, D - 1) / _mean_radius_power(gas, D)
    z = 2 * np.multiply.outer(gas.radius, gas.radius) / gas.distance * relative
    if D == 2:
        return 1 / (1 - phi) + 9 * phi * z / (16 * (1 - phi) ** 2)
    return 1 / (1 - phi) + 1.5 * phi * z / (1 - phi) ** 2 + (phi * z) ** 2 / (2 * (1 - phi) ** 3)


def mixture_density(gas: Mixture, packing) -> float:
    """Return the number density, particles per area or volume, in units of a^-D.

    `packing` is the packing fraction phi.
    """
    return float(
        _checked_packing(gas, packing)
        / (VOLUME[gas.dimension] * _mean_radius_power(gas, gas.dimension))
    )


def mixture_frequency(gas: Mixture, T_tr, packing) -> np.ndarray:
    """Return nu_ij, contacts of a particle of species i with particles of j per time, in 1/T.

    Shape (species, species). `T_tr` are the temperatures of the species, or a common temperature,
    in m a^2/T^2; `packing` is the packing fraction phi. The sum of nu_ij over j is the collision
    frequency of a particle of i. Equal species have `collision_frequency` in total.
    """
    T_tr, crowding = (
        _per_species("temperature T_tr", T_tr, gas),
        mixture_contact_values(gas, packing),
    )
    return mixture_density(gas, packing) * mixtures.contact_frequencies(gas, T_tr, crowding)


def compressibility(gas: Mixture, packing, T_tr=1.0) -> float:
    """Return the compressibility factor Z = p/(n <T_tr>): 1 + the virial of contacts.

    `packing` is the packing fraction. `T_tr` are the temperatures of the species, or a common
    temperature; only their ratios matter. Contacts contribute p - n <T_tr> = n^2 S_D/(2 D) sum x_i
    x_j chi_ij (a_i + a_j)^D (1 + r_ij) m_ij (s_i + s_j)/2, S_D as in `mixtures`, m_ij being the
    reduced mass and s = T_tr/m. In an elastic mixture that is the equation of state of A. Santos,
    S. B. Yuste & M. Lopez de Haro (Mol. Phys. 96, 1, 1999) for disks, which is Henderson's for
    equal disks, and of Boublik and of G. A. Mansoori, N. F. Carnahan, K. E. Starling & T. W. Leland
    (J. Chem. Phys. 54, 1523, 1971) for spheres.
    """
    T_tr = _per_species("temperature T_tr", T_tr, gas)
    speed_squared, D = T_tr / gas.mass, gas.dimension
    pair_weights = np.multiply.outer(gas.fraction, gas.fraction) * mixture_contact_values(
        gas, packing
    )
    impulse = gas.normal_impulse * np.add.outer(speed_squared, speed_squared) / 2
    virial = SURFACE[D] / (2 * D) * (pair_weights * gas.distance**D * impulse).sum()
    return float(1 + mixture_density(gas, packing) * virial / (gas.fraction @ T_tr))


def _per_species(key: str, value, gas: Mixture, legal: Interval | None = None) -> np.ndarray:
    """Return `value`, common or of each species, as an array (species,), checked.

    `key` is its name in error messages, `legal` the legal interval.
    """
    return np.broadcast_to(check(key, value, legal), gas.mass.shape)


def _mean_radius_power(gas: Mixture, power: int) -> float:
    """Return M_k, the mean of a_i^k over the particles, in a^k, k being `power`."""
    return gas.fraction @ gas.radius**power


def _checked_packing(gas: Mixture, packing) -> np.ndarray:
    """Return the packing fraction, checked: at most close packing if all radii are equal, else 1.

    Small particles fill the gaps between large ones.
    """
    equal_radii = (gas.radius == gas.radius[0]).all()
    interval = Interval(f"[0, {CLOSE_PACKING[gas.dimension]:.4f}]" if equal_radii else "[0, 1)")
    return check("packing", packing, interval)


RELATIVE_PRECISION = 1e-13
MAXIMUM_ITERATIONS = 1000
LOG_T_STEP = 1e-5  # of ln T, for a derivative
INITIAL_T_ROT = 1e-2  # of gases that start with hardly any spin
FIRST_STEP = 0.5  # in collisions per particle
STEP_FACTOR = 4.0  # ratio of successive steps
IMPLICIT_STEPS = 60
LARGEST_LOG_STEP = 1.0  # of ln T in a step


def mixture_cooling(gas: Mixture, packing=0.0) -> Temperatures:
    """Return the temperatures of a cooling gas, once all of them fall at the same rate.

    They are in units of <T_tr>; `packing` is the packing fraction. Starting with hardly any spin,
    the rate equations of the logarithms are integrated by implicit steps. These are short at first,
    so that a gas with friction takes the physical branch, and become Newton steps.
    """
    return _cooling(gas, mixture_contact_values(gas, packing))


def mixture_decay_rate(gas: Mixture, packing=0.0) -> float:
    """Return -d ln T/dn in the state of `mixture_cooling`, n in collisions per particle.

    All temperatures T fall at this rate. `packing` is the packing fraction. For a single species it
    is `decay_rate`.
    """
    crowding = mixture_contact_values(gas, packing)
    return -_log_growth_rates(gas, _cooling(gas, crowding), crowding)[0]


def mixture_relaxation_rate(gas: Mixture, packing=0.0) -> float:
    """Return the relaxation rate of temperature ratios in a cooling gas.

    It is per collision per particle, at the packing fraction `packing`, from the linear stability
    of `mixture_cooling`: its slowest mode, by central differences. For a single species it is
    `relaxation_rate`.
    """
    crowding = mixture_contact_values(gas, packing)
    state = np.concatenate(_cooling(gas, crowding))
    active = state > 0
    jacobian = _jacobian(
        lambda logs: _relative_growth_rates(gas, logs, active, crowding), np.log(state[active])
    )
    return float(-np.linalg.eigvals(jacobian).real.max()) if jacobian.size else 0.0


def mixture_driven(gas: Mixture, power, packing=0.0, spin_power=0.0) -> Temperatures:
    """Return the temperatures of a gas whose drive replaces the energy that collisions dissipate.

    They are in units of <T_tr>. `packing` is the packing fraction; `power` and `spin_power` are the
    powers per particle of each species, into translation and rotation: numbers, or (species,). Only
    their ratios matter. White noise with equal accelerations of all particles has a power in
    proportion to the mass; the effect `thermostat` has the power `kick_power`. Raises InputError
    for a gas that cannot dissipate the power.
    """
    given_powers = [_per_species("power", power, gas), _per_species("spin power", spin_power, gas)]
    crowding, D = mixture_contact_values(gas, packing), gas.dimension
    drive = np.concatenate([given_powers[0] / D, given_powers[1] / (2 * D - 3)])
    active = np.append(np.ones(len(gas.mass), bool), gas.rotates)
    if (
        not drive.any()
        or mixture_decay_rate(gas, packing) < RELATIVE_PRECISION
        or drive[~active].any()
    ):
        raise InputError(
            "power", given_powers[0].tolist(), "be what collisions can dissipate, and not 0"
        )

    def iterate(state: np.ndarray) -> np.ndarray:
        """Return a better estimate of the stationary temperatures `state`, T_tr and then T_rot."""
        T_tr, T_rot = np.split(state, 2)
        matrix = rate_matrix(gas, T_tr, T_rot, crowding)
        solution = _solve_active(-matrix, drive, active)
        # rates are proportional to sqrt(T): this step has the correct scale at once
        return np.cbrt(state * solution**2)

    start = np.append(np.ones(len(gas.mass)), np.where(gas.rotates, INITIAL_T_ROT, 0.0))
    return _in_mean_units(gas, _fixed_point(iterate, start))


def kick_power(gas: Mixture) -> np.ndarray:
    """Return the power of the effect `thermostat` per particle of each species, over its mean.

    Shape (species,). Kicks to pairs conserve momentum: particle i of a pair gets m_j/(m_i + m_j) of
    the energy of a kick, which is equal for all pairs. The power into spins is equal for all
    species.
    """
    return 2 * (gas.fraction * gas.reduced_mass).sum(axis=1) / gas.mass


def mixture_rotation(gas: Mixture, T_tr, packing=0.0) -> np.ndarray:
    """Return T_rot of each species, (species,), from all T_tr (> 0), by Lun's formula for mixtures.

    In steady states whose drive adds translational energy only, contacts conserve the rotational
    energy of each species on average. `T_tr` are the temperatures of the species, or a common
    temperature; T_rot has their units. `packing` is the packing fraction. r matters through
    friction only.
    """
    T_tr = _per_species("temperature T_tr", T_tr, gas, POSITIVE)
    crowding, size = mixture_contact_values(gas, packing), len(gas.mass)

    def iterate(T_rot: np.ndarray) -> np.ndarray:
        """Return T_rot (species,) in balance at the contact and sliding rates of `T_rot`."""
        matrix = rate_matrix(gas, T_tr, T_rot, crowding)[size:]
        return _solve_active(-matrix[:, size:], matrix[:, :size] @ T_tr, gas.rotates)

    return _fixed_point(iterate, np.where(gas.rotates, INITIAL_T_ROT * T_tr, 0.0))


def mimicry_masses(fraction, radius, dimension=2, packing=0.0) -> np.ndarray:
    """Return masses (species,) that give a cooling mixture the temperatures of a single species.

    `fraction` and `radius` (species,) have the number fractions and the radii in units of a,
    `packing` is the packing fraction. The mean mass is 1. Species of equal r, beta, mu and q then
    have equal temperatures T_tr and T_rot in a cooling gas, for all values of r, beta, mu and q: at
    equal temperatures a contact changes the energy of i in proportion to m_ij/m_i, m_ij being the
    reduced mass, so that sum_j x_j chi_ij (a_i + a_j)^(D-1) m_ij^(1/2)/m_i has to be equal for all
    species. A. Lasanta, F. Vega Reyes, V. Garzo & A. Santos (Phys. Fluids 31, 063306, 2019) call
    this mimicry.
    """
    pairs = zip(*np.broadcast_arrays(fraction, radius), strict=True)
    species = [{"fraction": float(x), "radius": float(a)} for x, a in pairs]
    gas = mixture(species, 1.0, 1.0, check_dimension(dimension))
    crowding = mixture_contact_values(gas, packing)

    def iterate(mass: np.ndarray) -> np.ndarray:
        """Return better masses (species,): each times the energy loss rate of its species."""
        nu = mixtures.contact_frequencies(gas._replace(mass=mass), np.ones(len(mass)), crowding)
        loss = (nu * gas._replace(mass=mass).reduced_mass).sum(axis=1) / mass
        mass = mass * loss
        return mass / (gas.fraction @ mass)

    return _fixed_point(iterate, np.ones(len(gas.mass)))


def _cooling(gas: Mixture, crowding: np.ndarray) -> Temperatures:
    """Return the temperatures of `mixture_cooling`, with the contact values `crowding` chi_ij."""
    state = np.append(np.ones(len(gas.mass)), np.where(gas.rotates, INITIAL_T_ROT, 0.0))
    active = state > 0
    logs = np.log(state[active])

    def growth(logs: np.ndarray) -> np.ndarray:
        """Return d ln(T/T_1)/dn of the temperatures whose logarithms are `logs`."""
        return _relative_growth_rates(gas, logs, active, crowding)

    for step in FIRST_STEP * STEP_FACTOR ** np.arange(IMPLICIT_STEPS if len(logs) > 1 else 0):
        log_step = np.linalg.solve(
            np.eye(len(logs) - 1) / step - _jacobian(growth, logs), growth(logs)
        )
        logs[1:] += np.clip(log_step, -LARGEST_LOG_STEP, LARGEST_LOG_STEP)
        if np.abs(log_step).max() < RELATIVE_PRECISION:
            break
    state[active] = np.exp(logs - logs.max())
    return _in_mean_units(gas, state)


def _relative_growth_rates(gas: Mixture, logs, active, crowding) -> np.ndarray:
    """Return d ln(T/T_1)/dn of all active temperatures except T_1, the first, (..., active - 1).

    `active` marks the temperatures that are not 0, among T_tr and then T_rot of all species; `logs`
    (..., active) has their logarithms, `crowding` is chi_ij, n counts collisions per particle.
    """
    state = np.zeros((*np.shape(logs)[:-1], len(active)))
    state[..., active] = np.exp(logs)
    rates = _log_growth_rates(gas, Temperatures(*np.split(state, 2, -1)), crowding)[..., active]
    return rates[..., 1:] - rates[..., :1]


def _jacobian(function: Callable[[np.ndarray], np.ndarray], point: np.ndarray) -> np.ndarray:
    """Return the derivatives of a function by all its arguments except the first, in columns.

    They are central differences at `point`, of a function that accepts several points along the
    first axis.
    """
    steps = LOG_T_STEP * np.eye(len(point))[1:]
    return (function(point + steps) - function(point - steps)).T / (2 * LOG_T_STEP)


def _log_growth_rates(gas: Mixture, state: Temperatures, crowding: np.ndarray) -> np.ndarray:
    """Return d ln T/dn of all T_tr, then all T_rot, (..., 2 species); 0 where T = 0.

    `state` has the temperatures, (..., species) each; n counts collisions per particle; `crowding`
    is chi_ij.
    """
    temperatures = np.concatenate(state, -1)
    change = (rate_matrix(gas, *state, crowding) @ temperatures[..., None])[..., 0]
    collisions = mixtures.contact_frequencies(gas, state.T_tr, crowding).sum(axis=-1) @ gas.fraction
    return change / np.where(temperatures > 0, temperatures, 1.0) / collisions[..., None]


def _solve_active(matrix: np.ndarray, rhs: np.ndarray, active: np.ndarray) -> np.ndarray:
    """Return the solution x of `matrix` x = `rhs` for the `active` elements; x is 0 elsewhere."""
    solution = np.zeros(len(rhs))
    solution[active] = np.linalg.solve(matrix[np.ix_(active, active)], rhs[active])
    return solution


def _fixed_point(iteration: Callable[[np.ndarray], np.ndarray], state: np.ndarray) -> np.ndarray:
    """Return the fixed point of an `iteration` that starts at `state` (>= 0).

    Iterates to RELATIVE_PRECISION, at most MAXIMUM_ITERATIONS times.
    """
    for _ in range(MAXIMUM_ITERATIONS):
        before, state = state, iteration(state)
        if np.all(np.abs(state - before) <= RELATIVE_PRECISION * np.abs(state)):
            break
    return state


def _in_mean_units(gas: Mixture, state: np.ndarray) -> Temperatures:
    """Return the temperatures of `state`, all T_tr and then all T_rot, in units of <T_tr>."""
    T_tr, T_rot = np.split(state, 2)
    mean = gas.fraction @ T_tr
    return Temperatures(T_tr / mean, T_rot / mean)
