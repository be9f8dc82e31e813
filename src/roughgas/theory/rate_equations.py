"""Energies that contacts exchange, the rate equations of the two temperatures, and relaxation.

v_n and v_t are the normal and tangential parts of v1 - v2 and v_r = -a (omega1 + omega2) x n is the
tangential velocity due to rotation, n pointing from particle 2 to particle 1. Squared velocities
are in a^2/T^2, energies in m a^2/T^2. Source: McNamara & Luding (1998).

The rate equations are Eqs. (deltaEt) and (deltaEr) there, averaged over the collisions of a
Maxwellian gas with eta = q (1 + beta)/[2 (1 + q)], nu collisions per particle per time:

    dT_tr/dt  = (nu/D) {-[(1-r^2) + 2(D-1) eta (1-eta)] T_tr + 2(D-1) (eta^2/q) T_rot} + drive
    dT_rot/dt = (2(D-1) nu/(2D-3)) {(eta^2/q) T_tr - (eta/q) (1-eta/q) T_rot} + drive

They are those of M. Huthmann & A. Zippelius, Phys. Rev. E 56, R6275 (1997) for spheres, and of
S. Luding et al., Phys. Rev. E 58, 3416 (1998) for disks, too.

A drive is described by `spin_share`, the share s in [0, 1] of its power that goes into spin: 0 is
translational, 1 rotational driving (R. Cafiero, S. Luding & H. J. Herrmann, Europhys. Lett. 60,
854, 2002), and None no drive: free cooling. A. Megias & A. Santos, Front. Phys. 10, 971671 (2022)
drive disks so with any share.

A Langevin bath has drag and noise, on velocities and on spins (`bath_temperatures`).

The equations are linear in (T_tr, T_rot) when time is counted in collisions per particle, n, so
their solution is exact: the part of the initial state off the stationary ratio fades as
exp(-Gamma n), Gamma the difference of the two eigenvalues; from there on, Haff's law. A drive is
taken to replace at each moment the energy that collisions dissipate. With one of constant power the
energy may settle more slowly than theta, at the same stationary R.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from roughgas.base import Interval
from roughgas.theory import arguments
from roughgas.theory.arguments import check, check_dimension, material, quotient, shares
from roughgas.theory.closed_forms import collision_frequency

STEP = 0.05
"""Of an integration, in mean free times of a gas all of whose energy is translational."""
LANGEVIN = "langevin_json"
"""The attribute of datasets that holds the settings of a Langevin bath."""
FAR, HALVINGS = 30.0, 110
"""Decades of T_tr, either way, in which a stationary state in a bath is looked for, and steps."""


def translational_energy_change(
    normal_squared, tangential_squared, tangential_dot_spin, spin_squared, r, beta, inertia
) -> np.ndarray:
    """Return the change of the pair's translational energy, N D Delta E_tr: Eq. (deltaEt).

    The first four arguments are v_n^2, v_t^2, v_t.v_r and v_r^2 before the collision, of one
    collision or averaged over collisions.
    """
    r, beta, _, q = material(r, beta, inertia=inertia)
    exchanged = (
        -(2 + q * (1 - beta)) * np.asarray(tangential_squared)
        - (2 - 2 * q * beta) * np.asarray(tangential_dot_spin)
        + q * (1 + beta) * np.asarray(spin_squared)
    )
    return -(1 - r) * (1 + r) / 4 * np.asarray(normal_squared) + _prefactor(beta, q) * exchanged


def rotational_energy_change(
    tangential_squared, tangential_dot_spin, spin_squared, beta, inertia
) -> np.ndarray:
    """Return the change of the pair's rotational energy, N (2D-3) Delta E_rot: Eq. (deltaEr).

    Arguments as in `translational_energy_change`; v_n does not matter.
    """
    beta, q = check("roughness beta", beta), check("inertia q", inertia)
    return _prefactor(beta, q) * (
        (1 + beta) * np.asarray(tangential_squared)
        - 2 * (q - beta) * np.asarray(tangential_dot_spin)
        - (2 * q + 1 - beta) * np.asarray(spin_squared)
    )


def mean_normal_squared(E_tr) -> np.ndarray:
    """Return <v_n^2> = 8 E_tr/m over the collisions of a Maxwellian gas, in 2D and 3D.

    E_tr is the translational energy per degree of freedom, >= 0. Below Eq. (Energybalance), as are
    the two averages that follow; <v_t.v_r> = 0, translation and spin being uncorrelated.
    """
    return 8 * check("energy E_tr", E_tr)


def mean_tangential_squared(E_tr, dimension=2) -> np.ndarray:
    """Return <v_t^2> = 4 (D-1) E_tr/m over the collisions of a Maxwellian gas."""
    return 4 * (check_dimension(dimension) - 1) * check("energy E_tr", E_tr)


def mean_spin_squared(E_rot, dimension, inertia) -> np.ndarray:
    """Return <v_r^2> = 4 (D-1) E_rot/(q m), for any isotropic, uncorrelated spins.

    E_rot is the rotational energy per degree of freedom, >= 0.
    """
    dimension, q = check_dimension(dimension), check("inertia q", inertia)
    return 4 * (dimension - 1) * check("energy E_rot", E_rot) / q


def _prefactor(beta, q) -> np.ndarray:
    """Return S = m q (1 + beta)/[4 (1 + q)^2], below Eq. (deltaEt)."""
    return q * (1 + beta) / (4 * (1 + q) ** 2)


class Rates(NamedTuple):
    """Coefficients of the rate equations, all >= 0, per collision per particle.

    With n counting collisions per particle: dT_tr/dn = -translational_loss T_tr +
    translational_gain T_rot and dT_rot/dn = rotational_gain T_tr - rotational_loss T_rot.
    """

    translational_loss: np.ndarray
    translational_gain: np.ndarray
    rotational_gain: np.ndarray
    rotational_loss: np.ndarray

    def changes(self, T_tr, T_rot, frequency=1.0) -> tuple[np.ndarray, np.ndarray]:
        """Return dT_tr/dt and dT_rot/dt at `frequency` collisions per particle per time."""
        return (
            frequency * (self.translational_gain * T_rot - self.translational_loss * T_tr),
            frequency * (self.rotational_gain * T_tr - self.rotational_loss * T_rot),
        )


def collision_rates(r, beta, dimension=2, inertia=None) -> Rates:
    """Return the coefficients of the rate equations."""
    gas = material(r, beta, dimension, inertia)
    (r, beta, dimension, q), eta = gas, gas.eta
    # 1 - eta and 1 - eta/q from sums of positive terms, exact towards beta = 1 and small q.
    kept = (2 + q * (1 - beta)) / (2 * (1 + q))
    kept_spin = (2 * q + 1 - beta) / (2 * (1 + q))
    tangential, spins = 2 * (dimension - 1), 2 * dimension - 3
    return Rates(
        translational_loss=((1 - r) * (1 + r) + tangential * eta * kept) / dimension,
        translational_gain=tangential * eta**2 / q / dimension,
        rotational_gain=tangential * eta**2 / q / spins,
        rotational_loss=tangential * (eta / q) * kept_spin / spins,
    )


def temperature_changes(
    T_tr, T_rot, r, beta, dimension=2, inertia=None, frequency=1.0
) -> tuple[np.ndarray, np.ndarray]:
    """Return dT_tr/dt and dT_rot/dt due to collisions; `frequency` is nu (`collision_frequency`).

    With the frequency 1 left as it is, they are per collision per particle.
    """
    T_tr, T_rot = check("temperature T_tr", T_tr), check("temperature T_rot", T_rot)
    nu = check("frequency", frequency)
    return collision_rates(r, beta, dimension, inertia).changes(T_tr, T_rot, nu)


def drive_changes(power, spin_share, dimension=2) -> tuple[np.ndarray, np.ndarray]:
    """Return dT_tr/dt and dT_rot/dt due to a drive of `power` per particle (m a^2/T^3)."""
    power, share = check("power", power), check("spin share of the drive", spin_share)
    dimension = check_dimension(dimension)
    return 2 * (1 - share) * power / dimension, 2 * share * power / (2 * dimension - 3)


def stationary_ratio(r, beta, dimension=2, inertia=None, spin_share=None) -> np.ndarray:
    """Return the stationary R = T_rot/(T_rot + T_tr).

    That is the theory of free cooling without a drive, Lun's formula at spin_share 0. At
    spin_share 1, theta is the loss over the gain of T_tr. In general, translation and spin lose
    energy to collisions in the ratio (1 - s) : s, for any power, even one that varies. If a drive
    takes out of one motion some of what it puts into the other, s lies below 0 or above 1; if it
    takes out more than collisions supply, R is 0 or 1. Limits at beta = -1 are those of beta -> -1
    (without a drive, see `cooling_ratio`).
    """
    return stationary_shares(r, beta, dimension, inertia, spin_share)[1][()]


def stationary_theta(r, beta, dimension=2, inertia=None, spin_share=None) -> np.ndarray:
    """Return the stationary theta = T_rot/T_tr; infinite where R = 1. See `stationary_ratio`."""
    translational, rotational = stationary_shares(r, beta, dimension, inertia, spin_share)
    return quotient(rotational, translational)


def stationary_shares(
    r, beta, dimension=2, inertia=None, spin_share=None
) -> tuple[np.ndarray, np.ndarray]:
    """Return the stationary T_tr and T_rot as shares of their sum: 1 - R and R."""
    r, beta, dimension, q = material(r, beta, dimension, inertia)
    return balanced_shares(collision_rates(r, beta, dimension, q), dimension, q, spin_share)


def balanced_shares(rates, dimension, q, spin_share=None) -> tuple[np.ndarray, np.ndarray]:
    """Return the same for `rates`, which other velocities than Maxwellian ones may have."""
    if spin_share is None:
        difference = rates.translational_loss - rates.rotational_loss
        rotational, translational = arguments.positive_root(
            rates.translational_gain, difference, rates.rotational_gain
        )
        return shares(translational, rotational, neither=0)
    s, spins = check("net spin share of the drive", spin_share), 2 * dimension - 3
    moved, turned = s * dimension, (1 - s) * spins
    rotational = moved * rates.translational_loss + turned * rates.rotational_gain
    translational = moved * rates.translational_gain + turned * rates.rotational_loss
    limit = np.clip(quotient(s * q, s * q + 1 - s), 0, 1)
    return shares(np.maximum(translational, 0), np.maximum(rotational, 0), neither=limit)


class Relaxation(NamedTuple):
    """Temperatures in units of the initial T_tr, and theta = T_rot/T_tr."""

    theta: np.ndarray
    T_tr: np.ndarray
    T_rot: np.ndarray


def relaxation_rate(r, beta, dimension=2, inertia=None, spin_share=None) -> np.ndarray:
    """Return Gamma, the rate at which theta relaxes, per collision per particle.

    From the linear stability of theta, and positive, except at beta = -1 (spin decoupled) where
    r = 1 or the drive is translational: theta then stays as it is and Gamma = 0.
    """
    rates = collision_rates(r, beta, dimension, inertia)
    if spin_share is None:
        difference = rates.translational_loss - rates.rotational_loss
        return np.sqrt(difference**2 + 4 * rates.translational_gain * rates.rotational_gain)
    s = check("spin share of the drive", spin_share)
    return s * (rates.translational_loss + rates.rotational_gain) + (1 - s) * (
        rates.rotational_loss + rates.translational_gain
    )


def relax(theta0, r, beta, collisions, dimension=2, inertia=None, spin_share=None) -> Relaxation:
    """Return the temperatures after `collisions` (>= 0) per particle, from theta0 (>= 0) on.

    Exact solution of the rate equations: a mixture of the initial and the stationary state, of
    positive terms only.
    """
    theta0, n = check("theta0", theta0), check("collisions", collisions)
    translational, rotational = stationary_shares(r, beta, dimension, inertia, spin_share)
    weight = _stationary_weight(theta0, translational, rotational, dimension, spin_share)
    passed = relaxation_rate(r, beta, dimension, inertia, spin_share) * n
    old, new = np.exp(-passed), -np.expm1(-passed) * weight
    T_tr, T_rot = old + new * translational, theta0 * old + new * rotational
    decay = slow_decay(r, beta, dimension, inertia) if spin_share is None else 0.0
    scale = np.exp(-decay * n)
    return Relaxation(quotient(T_rot, T_tr), scale * T_tr, scale * T_rot)


def driven_temperatures(
    time, T_tr, T_rot, r, beta, packing, power=0.0, spin_share=0.0, dimension=2, inertia=None
) -> tuple[np.ndarray, np.ndarray]:
    """Return T_tr and T_rot at each `time` (>= 0, rising, in T) since they had the values given.

    A drive of constant `power` per particle (m a^2/T^3), of which spin gets the share, in a gas
    with Enskog's collision frequency at `packing`: `temperature_changes` and `drive_changes`,
    integrated by the Runge-Kutta method of fourth order in steps of STEP mean free times or less.
    """
    time = np.atleast_1d(check("time", time))
    state = np.array([check("temperature T_tr", T_tr), check("temperature T_rot", T_rot)], float)
    rates = collision_rates(r, beta, dimension, inertia)
    unit = collision_frequency(1.0, packing, dimension)
    drive = np.array(drive_changes(power, spin_share, dimension))

    def change(state):
        return drive + rates.changes(*state, unit * np.sqrt(state[0]))

    found, now = [], 0.0
    for instant in time:
        while now < instant:
            step = min(instant - now, STEP / (unit * np.sqrt(state.sum())))
            state = runge_kutta(change, state, step)
            now = instant if instant - now <= step else now + step
        found.append(state)
    T_tr, T_rot = np.transpose(found)
    return T_tr, T_rot


def runge_kutta(
    change: Callable[[np.ndarray], np.ndarray], state: np.ndarray, step: float
) -> np.ndarray:
    """Return the state after a step, from the rate at which it changes: to fourth order."""
    one = change(state)
    two = change(state + 0.5 * step * one)
    three = change(state + 0.5 * step * two)
    four = change(state + step * three)
    return state + step / 6.0 * (one + 2.0 * (two + three) + four)


def collisions_to_relax(
    r, beta, tolerance=0.01, dimension=2, inertia=None, spin_share=None, theta0=0.0
) -> np.ndarray:
    """Return collisions per particle until R is within a fraction `tolerance` of its limit.

    The limit is the stationary R; at first T_rot/T_tr = theta0. Infinite if R never gets there, as
    in a cooling gas without spin at beta = -1.
    """
    tolerance, theta0 = check("tolerance", tolerance, Interval("(0, 1)")), check("theta0", theta0)
    translational, rotational = stationary_shares(r, beta, dimension, inertia, spin_share)
    weight = _stationary_weight(theta0, translational, rotational, dimension, spin_share)
    distance = np.abs(theta0 * translational - rotational)
    near = tolerance * rotational
    gamma = relaxation_rate(r, beta, dimension, inertia, spin_share)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        needed = np.log1p((distance - near * (1 + theta0)) / (near * weight)) / gamma
    return np.where(distance > near * (1 + theta0), needed, 0.0)[()]


def _stationary_weight(theta0, translational, rotational, dimension, spin_share):
    """Return the weight c of the stationary state in (1, theta0) = c (tr, rot) + c' (fast mode).

    The fast mode is (-rot, alpha tr) in a cooling gas, the product of the two theta that stay as
    they are being -alpha = -D/(2D-3); with a drive it is (-1, alpha), which carries no energy.
    """
    alpha = dimension / (2 * dimension - 3)
    one, other = (rotational, translational) if spin_share is None else (1.0, 1.0)
    scale = alpha * other * translational + one * rotational
    return (alpha * other + theta0 * one) / scale


def haff_temperature(time, T0, r, beta, frequency, dimension=2, inertia=None) -> np.ndarray:
    """Return T_tr = T0/(1 + t/t_h)^2 at `time` >= 0, from T_tr = T0 and the stationary R on.

    `frequency`: collisions per particle per time at T0, e.g. `collision_frequency(T0, packing)`.
    T_rot decays by the same factor.
    """
    time, T0 = check("time", time), check("temperature T0", T0)
    return T0 / (1 + time / haff_time(r, beta, frequency, dimension, inertia)) ** 2


def haff_time(r, beta, frequency, dimension=2, inertia=None) -> np.ndarray:
    """Return t_h = 2/(frequency * decay_rate), nu being ~ sqrt(T_tr); inf if nothing decays.

    `frequency` (> 0, 1/T) is that at the initial temperature.
    """
    decay = decay_rate(r, beta, dimension, inertia)
    return quotient(2.0, check("frequency", frequency) * decay)


def decay_rate(r, beta, dimension=2, inertia=None) -> np.ndarray:
    """Return -d ln T_tr/dn at the stationary R of a cooling gas, n in collisions per particle.

    At beta = -1 it is that of the smooth gas, (1 - r^2)/D, whose spin has no effect. The limit
    beta -> -1 would be 0, since spin, which hardly decays there, feeds translation.
    """
    r, beta, dimension, q = material(r, beta, dimension, inertia)
    smooth = (1 - r) * (1 + r) / dimension
    return np.where(beta == -1, smooth, slow_decay(r, beta, dimension, q))[()]


def slow_decay(r, beta, dimension=2, inertia=None) -> np.ndarray:
    """Return the decay rate of the slower mode of a cooling gas, per collision per particle.

    The product of both rates is a sum of positive terms, so nothing cancels.
    """
    r, beta, dimension, q = material(r, beta, dimension, inertia)
    rates = collision_rates(r, beta, dimension, q)
    spin_loss, spin_gain = rates.rotational_loss, rates.rotational_gain
    product = (1 - r) * (1 + r) * spin_loss + (dimension - 1) * (1 - beta) * spin_gain
    both = rates.translational_loss + spin_loss
    return quotient(2 * (product / dimension), both + relaxation_rate(r, beta, dimension, q))


def bath_temperatures(
    r,
    beta,
    packing,
    drag=0.0,
    temperature=0.0,
    spin_drag=0.0,
    spin_temperature=0.0,
    power=0.0,
    spin_power=0.0,
    dimension=2,
    inertia=None,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the stationary T_tr and T_rot of a gas in a Langevin bath.

    They solve dT_tr/dt = (collisions) + 2 gamma (T - T_tr) + 2 power/D, and the same for spins with
    2 spin_power/(2D-3), the collisions being those of a Maxwellian gas (`temperature_changes`) at
    the `collision_frequency` of T_tr and the packing. For smooth particles: M. G. Chamorro, F.
    Vega Reyes & V. Garzó, J. Stat. Mech. P07013 (2013). Drags are in 1/T, powers in
    m a^2/T^3 per particle; temperatures 0 where the bath gives nothing.
    """
    rates = collision_rates(r, beta, dimension, inertia)
    a, b, c, d = (np.asarray(rate) for rate in rates)
    loss, spin_loss = 2 * check("drag", drag), 2 * check("drag of spins", spin_drag)
    gain = loss * check("temperature T", temperature) + 2 * check("power", power) / dimension
    spin_gain = spin_loss * check("temperature of spins", spin_temperature)
    spin_gain = spin_gain + 2 * check("power of spins", spin_power) / (2 * dimension - 3)
    unit = collision_frequency(1.0, packing, dimension)

    def state(logarithm):
        """Return both temperatures that balance at the frequency which one of them sets."""
        nu = unit * 10.0 ** (logarithm / 2)
        out, spin_out = nu * a + loss, nu * d + spin_loss
        both = out * spin_out - nu**2 * b * c
        T_tr = quotient(gain * spin_out + spin_gain * nu * b, both)
        return T_tr, quotient(spin_gain * out + gain * nu * c, both)

    parts = a, loss, gain, spin_gain, spin_loss, unit
    low = np.full(np.broadcast_shapes(*(np.shape(part) for part in parts)), -FAR)
    high = -low
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        rises = state(middle)[0] > 10.0**middle
        low, high = np.where(rises, middle, low), np.where(rises, high, middle)
    given = (gain > 0) | (spin_gain > 0)
    T_tr, T_rot = state(low)
    return np.where(given, T_tr, 0.0)[()], np.where(given, T_rot, 0.0)[()]
