"""Energies that contacts exchange, the rate equations of the two temperatures, and relaxation.

T_tr and T_rot are the temperatures of translation and rotation, theta = T_rot/T_tr and
R = theta/(1 + theta). r is the normal restitution, beta the roughness (tangential restitution),
`inertia` q = I/(m a^2), `dimension` D. v_n and v_t are the normal and tangential components of
v1 - v2, v_r = -a (omega1 + omega2) x n the tangential velocity due to rotation, n pointing from
particle 2 to particle 1. Squared velocities are in a^2/T^2, energies and temperatures in m a^2/T^2.
Source: McNamara & Luding (1998).

The rate equations are Eqs. (deltaEt) and (deltaEr) there, averaged over the collisions of a
Maxwellian gas with eta = q (1 + beta)/[2 (1 + q)], nu collisions per particle per time:

    dT_tr/dt  = (nu/D) {-[(1-r^2) + 2(D-1) eta (1-eta)] T_tr + 2(D-1) (eta^2/q) T_rot} + drive
    dT_rot/dt = (2(D-1) nu/(2D-3)) {(eta^2/q) T_tr - (eta/q) (1-eta/q) T_rot} + drive

M. Huthmann & A. Zippelius, Phys. Rev. E 56, R6275 (1997) published them for spheres, S. Luding et
al., Phys. Rev. E 58, 3416 (1998) for disks, too.

A drive is described by `spin_share`, the share s in [0, 1] of its power that goes into spin: 0 is
translational, 1 rotational driving (R. Cafiero, S. Luding & H. J. Herrmann, Europhys. Lett. 60,
854, 2002), and None no drive: free cooling. A. Megias & A. Santos, Front. Phys. 10, 971671 (2022)
have disks that are driven with any share.

A Langevin bath has drag and noise, on velocities and on spins (`bath_temperatures`). In the Delta
model contacts of pairs gain a normal speed (`delta_temperatures`).

The equations are linear in (T_tr, T_rot) when time is counted in collisions per particle, n, so
their solution is exact: the deviation from the stationary ratio fades as exp(-Gamma n), Gamma the
difference of the two eigenvalues; then Haff's law holds. A drive is assumed to replace at each
moment the energy that collisions dissipate. With constant power the energy may settle more slowly
than theta, at the same stationary R.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from roughgas.base import Interval
from roughgas.theory import arguments
from roughgas.theory.arguments import check, check_dimension, material, quotient, shares
from roughgas.theory.closed_forms import collision_frequency

RUNGE_KUTTA_STEP = 0.05
"""Largest step, in mean free times of a gas that has all its energy in translation."""
LANGEVIN_ATTRIBUTE = "langevin_json"
"""Attribute of datasets that holds the settings of a Langevin bath."""
FLOWS = "flows"
"""Key in LANGEVIN_ATTRIBUTE of a bath whose medium flows: these equations have no shear."""
SEARCHED_DECADES, BISECTIONS = 30.0, 110
"""The stationary T_tr in a bath is searched over this many decades above and below 1, in steps."""


def translational_energy_change(
    normal_squared, tangential_squared, tangential_dot_spin, spin_squared, r, beta, inertia
) -> np.ndarray:
    """Return the change N D Delta E_tr of a pair's translational energy by a collision (m a^2/T^2).

    It is given by Eq. (deltaEt) of McNamara & Luding (1998). `normal_squared`,
    `tangential_squared`, `tangential_dot_spin` and `spin_squared` are v_n^2, v_t^2, v_t.v_r and
    v_r^2 before the collision in a^2/T^2, of one collision or averaged over collisions: of the
    normal and tangential relative velocity, and of the tangential velocity v_r due to rotation.
    `inertia` is q = I/(m a^2).
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
    """Return the change N (2D-3) Delta E_rot of a pair's rotational energy by a collision.

    It is in m a^2/T^2, by Eq. (deltaEr) of McNamara & Luding (1998). `tangential_squared`,
    `tangential_dot_spin` and `spin_squared` are v_t^2, v_t.v_r and v_r^2 before the collision, as
    in `translational_energy_change`; v_n does not matter.
    """
    beta, q = check("roughness beta", beta), check("inertia q", inertia)
    return _prefactor(beta, q) * (
        (1 + beta) * np.asarray(tangential_squared)
        - 2 * (q - beta) * np.asarray(tangential_dot_spin)
        - (2 * q + 1 - beta) * np.asarray(spin_squared)
    )


def mean_normal_squared(E_tr) -> np.ndarray:
    """Return the mean square <v_n^2> = 8 E_tr/m of the normal velocity over collisions, in a^2/T^2.

    The gas is Maxwellian, in 2D or 3D. E_tr is the translational energy per degree of
    freedom, >= 0. Source: McNamara & Luding (1998), below Eq. (Energybalance), also for the next
    two averages; <v_t.v_r> = 0, as translation and spin are uncorrelated.
    """
    return 8 * check("energy E_tr", E_tr)


def mean_tangential_squared(E_tr, dimension=2) -> np.ndarray:
    """Return <v_t^2> = 4 (D-1) E_tr/m over the collisions of a Maxwellian gas, in a^2/T^2.

    v_t is the tangential velocity without spins, E_tr the translational energy per degree of
    freedom, >= 0.
    """
    return 4 * (check_dimension(dimension) - 1) * check("energy E_tr", E_tr)


def mean_spin_squared(E_rot, dimension, inertia) -> np.ndarray:
    """Return <v_r^2> = 4 (D-1) E_rot/(q m) over collisions, in a^2/T^2.

    v_r is the tangential velocity due to rotation. It holds for any isotropic, uncorrelated spins.
    E_rot is the rotational energy per degree of freedom, >= 0, and `inertia` q = I/(m a^2).
    """
    dimension, q = check_dimension(dimension), check("inertia q", inertia)
    return 4 * (dimension - 1) * check("energy E_rot", E_rot) / q


def _prefactor(beta, q) -> np.ndarray:
    """Return S = m q (1 + beta)/[4 (1 + q)^2], a factor given below Eq. (deltaEt)."""
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
        """Return dT_tr/dt and dT_rot/dt due to collisions, in the unit of T_tr over time.

        `frequency` is the number of collisions per particle per time. With 1, the default, the
        changes are per collision per particle.
        """
        return (
            frequency * (self.translational_gain * T_rot - self.translational_loss * T_tr),
            frequency * (self.rotational_gain * T_tr - self.rotational_loss * T_rot),
        )


def collision_rates(r, beta, dimension=2, inertia=None) -> Rates:
    """Return the coefficients of the rate equations, per collision per particle.

    The gas is Maxwellian, with restitution `r`, roughness `beta`, and `inertia` q = I/(m a^2).
    """
    gas = material(r, beta, dimension, inertia)
    (r, beta, dimension, q), eta = gas, gas.eta
    # 1 - eta and 1 - eta/q from sums of positive terms, exact towards beta = 1 and small q.
    one_minus_eta = (2 + q * (1 - beta)) / (2 * (1 + q))
    one_minus_eta_over_q = (2 * q + 1 - beta) / (2 * (1 + q))
    tangential, spins = 2 * (dimension - 1), 2 * dimension - 3
    return Rates(
        translational_loss=((1 - r) * (1 + r) + tangential * eta * one_minus_eta) / dimension,
        translational_gain=tangential * eta**2 / q / dimension,
        rotational_gain=tangential * eta**2 / q / spins,
        rotational_loss=tangential * (eta / q) * one_minus_eta_over_q / spins,
    )


def temperature_changes(
    T_tr, T_rot, r, beta, dimension=2, inertia=None, frequency=1.0
) -> tuple[np.ndarray, np.ndarray]:
    """Return dT_tr/dt and dT_rot/dt due to collisions, by the rate equations, in m a^2/T^3.

    `T_tr` and `T_rot` are in m a^2/T^2, `frequency` is nu in 1/T (`collision_frequency`). The
    changes are per collision per particle if `frequency` is 1, the default.
    """
    T_tr, T_rot = check("temperature T_tr", T_tr), check("temperature T_rot", T_rot)
    nu = check("frequency", frequency)
    return collision_rates(r, beta, dimension, inertia).changes(T_tr, T_rot, nu)


def drive_changes(power, spin_share, dimension=2) -> tuple[np.ndarray, np.ndarray]:
    """Return dT_tr/dt and dT_rot/dt due to a drive of `power` per particle, all in m a^2/T^3.

    `spin_share` in [0, 1] is the share of the power that goes into spin.
    """
    power, share = check("power", power), check("spin share of the drive", spin_share)
    dimension = check_dimension(dimension)
    return 2 * (1 - share) * power / dimension, 2 * share * power / (2 * dimension - 3)


def stationary_ratio(r, beta, dimension=2, inertia=None, spin_share=None) -> np.ndarray:
    """Return the stationary R = T_rot/(T_rot + T_tr), the share of rotational energy.

    It follows from the rate equations; theta = T_rot/T_tr. `spin_share` is the share s of the power
    of the drive that goes into spin. Without a drive (None) that is the theory of free cooling, at
    s = 0 Lun's formula. At s = 1, theta is the loss over the gain of T_tr. In general, translation
    and spin lose energy to collisions in the ratio (1 - s) : s, for any power, constant or not. If
    a drive adds energy to one motion and extracts energy from the other, s lies below 0 or above 1;
    if it extracts more than collisions supply, R is 0 or 1. At beta = -1 the limit beta -> -1 is
    returned (without a drive, see `cooling_ratio`).
    """
    return stationary_shares(r, beta, dimension, inertia, spin_share)[1][()]


def stationary_theta(r, beta, dimension=2, inertia=None, spin_share=None) -> np.ndarray:
    """Return the stationary theta = T_rot/T_tr; infinite where R = 1.

    The arguments are explained in `stationary_ratio`, which returns R = theta/(1 + theta).
    """
    translational, rotational = stationary_shares(r, beta, dimension, inertia, spin_share)
    return quotient(rotational, translational)


def stationary_shares(
    r, beta, dimension=2, inertia=None, spin_share=None
) -> tuple[np.ndarray, np.ndarray]:
    """Return the stationary T_tr and T_rot over their sum, 1 - R and R.

    The arguments are explained in `stationary_ratio`, which returns R alone.
    """
    r, beta, dimension, q = material(r, beta, dimension, inertia)
    return balanced_shares(collision_rates(r, beta, dimension, q), dimension, q, spin_share)


def balanced_shares(rates, dimension, q, spin_share=None) -> tuple[np.ndarray, np.ndarray]:
    """Return 1 - R and R of the stationary state for `rates`, of any velocity distribution.

    `rates` are the coefficients of the rate equations, `q` is I/(m a^2), and `spin_share` the share
    of the power of the drive that goes into spin, None without a drive.
    """
    if spin_share is None:
        difference = rates.translational_loss - rates.rotational_loss
        rotational, translational = arguments.positive_root(
            rates.translational_gain, difference, rates.rotational_gain
        )
        return shares(translational, rotational, second_if_both_zero=0)
    s, spins = check("net spin share of the drive", spin_share), 2 * dimension - 3
    translational_weight, rotational_weight = s * dimension, (1 - s) * spins
    rotational = (
        translational_weight * rates.translational_loss + rotational_weight * rates.rotational_gain
    )
    translational = (
        translational_weight * rates.translational_gain + rotational_weight * rates.rotational_loss
    )
    limit = np.clip(quotient(s * q, s * q + 1 - s), 0, 1)
    return shares(
        np.maximum(translational, 0), np.maximum(rotational, 0), second_if_both_zero=limit
    )


class Relaxation(NamedTuple):
    """A relaxing gas: theta = T_rot/T_tr, and its temperatures in units of the initial T_tr."""

    theta: np.ndarray
    T_tr: np.ndarray
    T_rot: np.ndarray


def relaxation_rate(r, beta, dimension=2, inertia=None, spin_share=None) -> np.ndarray:
    """Return Gamma, the relaxation rate of theta = T_rot/T_tr, per collision per particle.

    `spin_share` is the share of the power of the drive that goes into spin, None without a drive.
    From the linear stability of theta, and positive, except at beta = -1 (spin decoupled) where
    r = 1 or the drive is translational: theta is then constant and Gamma = 0.
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
    """Return theta and the temperatures after `collisions` (>= 0) per particle, starting at theta0.

    `theta0` >= 0 is the initial T_rot/T_tr, `spin_share` the share of the power of the drive that
    goes into spin, None without a drive. Exact solution of the rate equations: a combination of the
    initial and the stationary state with positive terms only.
    """
    theta0, n = check("theta0", theta0), check("collisions", collisions)
    translational, rotational = stationary_shares(r, beta, dimension, inertia, spin_share)
    weight = _stationary_weight(theta0, translational, rotational, dimension, spin_share)
    decay_exponent = relaxation_rate(r, beta, dimension, inertia, spin_share) * n
    initial_weight, stationary_weight = np.exp(-decay_exponent), -np.expm1(-decay_exponent) * weight
    T_tr, T_rot = (
        initial_weight + stationary_weight * translational,
        theta0 * initial_weight + stationary_weight * rotational,
    )
    decay = slow_decay(r, beta, dimension, inertia) if spin_share is None else 0.0
    scale = np.exp(-decay * n)
    return Relaxation(quotient(T_rot, T_tr), scale * T_tr, scale * T_rot)


def driven_temperatures(
    time, T_tr, T_rot, r, beta, packing, power=0.0, spin_share=0.0, dimension=2, inertia=None
) -> tuple[np.ndarray, np.ndarray]:
    """Return T_tr and T_rot of a driven gas at each `time`, two arrays (times,) in m a^2/T^2.

    `time` (>= 0, rising) is in units of T since the start, where the temperatures are the arguments
    `T_tr` and `T_rot`. The drive has constant `power` per particle (m a^2/T^3), of which the
    fraction `spin_share` goes into spin; the gas has Enskog's collision frequency at the packing
    fraction `packing`: `temperature_changes` and `drive_changes`, integrated by the Runge-Kutta
    method of fourth order in steps of RUNGE_KUTTA_STEP mean free times or less.
    """
    time = np.atleast_1d(check("time", time))
    state = np.array([check("temperature T_tr", T_tr), check("temperature T_rot", T_rot)], float)
    rates = collision_rates(r, beta, dimension, inertia)
    unit = collision_frequency(1.0, packing, dimension)
    drive = np.array(drive_changes(power, spin_share, dimension))

    def change(state):
        """Return the time derivative of the temperatures (T_tr, T_rot)."""
        return drive + rates.changes(*state, unit * np.sqrt(state[0]))

    states, reached = [], 0.0
    for instant in time:
        while reached < instant:
            step = min(instant - reached, RUNGE_KUTTA_STEP / (unit * np.sqrt(state.sum())))
            state = runge_kutta(change, state, step)
            reached = instant if instant - reached <= step else reached + step
        states.append(state)
    T_tr, T_rot = np.transpose(states)
    return T_tr, T_rot


def runge_kutta(
    change: Callable[[np.ndarray], np.ndarray], state: np.ndarray, step: float
) -> np.ndarray:
    """Return the state after a step of the Runge-Kutta method of fourth order.

    `change` returns the derivative of a state by time, `step` is a time, in the unit of the
    derivative.
    """
    first = change(state)
    second = change(state + 0.5 * step * first)
    third = change(state + 0.5 * step * second)
    fourth = change(state + step * third)
    return state + step / 6.0 * (first + 2.0 * (second + third) + fourth)


def collisions_to_relax(
    r, beta, tolerance=0.01, dimension=2, inertia=None, spin_share=None, theta0=0.0
) -> np.ndarray:
    """Return the collisions per particle until R is within a fraction `tolerance` of its limit.

    R is the share of rotational energy. The limit is the stationary R; initially T_rot/T_tr is
    `theta0`. `spin_share` is the share of the power of the drive that goes into spin, None without
    a drive. Infinite if R never approaches the limit, as in a cooling gas without spin at
    beta = -1.
    """
    tolerance, theta0 = check("tolerance", tolerance, Interval("(0, 1)")), check("theta0", theta0)
    translational, rotational = stationary_shares(r, beta, dimension, inertia, spin_share)
    weight = _stationary_weight(theta0, translational, rotational, dimension, spin_share)
    distance = np.abs(theta0 * translational - rotational)
    allowed_distance = tolerance * rotational
    gamma = relaxation_rate(r, beta, dimension, inertia, spin_share)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        collisions = (
            np.log1p((distance - allowed_distance * (1 + theta0)) / (allowed_distance * weight))
            / gamma
        )
    return np.where(distance > allowed_distance * (1 + theta0), collisions, 0.0)[()]


def _stationary_weight(theta0, translational, rotational, dimension, spin_share):
    """Return the weight c of the stationary state in (1, theta0) = c (tr, rot) + c' (fast mode).

    `translational` and `rotational` are the stationary shares 1 - R and R, `theta0` is the initial
    T_rot/T_tr, `spin_share` the share of the power of the drive that goes into spin, None without a
    drive. The fast mode is (-rot, alpha tr) in a cooling gas, as the product of the two constant
    theta is -alpha = -D/(2D-3); with a drive it is (-1, alpha), which has no energy.
    """
    alpha = dimension / (2 * dimension - 3)
    fast_translational, fast_rotational = (
        (rotational, translational) if spin_share is None else (1.0, 1.0)
    )
    norm = alpha * fast_rotational * translational + fast_translational * rotational
    return (alpha * fast_rotational + theta0 * fast_translational) / norm


def haff_temperature(time, T0, r, beta, frequency, dimension=2, inertia=None) -> np.ndarray:
    """Return Haff's T_tr = T0/(1 + t/t_h)^2 of a cooling gas at `time` t, in the unit of `T0`.

    It starts with T_tr = T0 at the stationary R; `time` >= 0 is in units of T. `frequency`:
    collisions per particle per time at T0, e.g. `collision_frequency(T0, packing)`. T_rot decays by
    the same factor.
    """
    time, T0 = check("time", time), check("temperature T0", T0)
    return T0 / (1 + time / haff_time(r, beta, frequency, dimension, inertia)) ** 2


def haff_time(r, beta, frequency, dimension=2, inertia=None) -> np.ndarray:
    """Return Haff's time t_h = 2/(frequency * decay_rate) in units of T; infinite without decay.

    `frequency` (> 0, 1/T) is the collision frequency nu ~ sqrt(T_tr) at the initial temperature.
    """
    decay = decay_rate(r, beta, dimension, inertia)
    return quotient(2.0, check("frequency", frequency) * decay)


def decay_rate(r, beta, dimension=2, inertia=None) -> np.ndarray:
    """Return -d ln T_tr/dn at the stationary R of a cooling gas, n in collisions per particle.

    At beta = -1 it is the rate of a smooth gas, (1 - r^2)/D, as spin has no effect. The limit
    beta -> -1 would be 0, since spin, which hardly decays near beta = -1, feeds translation.
    """
    r, beta, dimension, q = material(r, beta, dimension, inertia)
    smooth = (1 - r) * (1 + r) / dimension
    return np.where(beta == -1, smooth, slow_decay(r, beta, dimension, q))[()]


def slow_decay(r, beta, dimension=2, inertia=None) -> np.ndarray:
    """Return the decay rate of the slower mode of a cooling gas, per collision per particle.

    A mode is a combination of T_tr and T_rot that decays exponentially in collisions per particle.
    Computed from the product of both rates, a sum of positive terms, so that nothing cancels.
    """
    r, beta, dimension, q = material(r, beta, dimension, inertia)
    rates = collision_rates(r, beta, dimension, q)
    spin_loss, spin_gain = rates.rotational_loss, rates.rotational_gain
    product = (1 - r) * (1 + r) * spin_loss + (dimension - 1) * (1 - beta) * spin_gain
    total_loss = rates.translational_loss + spin_loss
    return quotient(2 * (product / dimension), total_loss + relaxation_rate(r, beta, dimension, q))


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
    """Return the stationary T_tr and T_rot of a gas in a Langevin bath, in m a^2/T^2.

    They solve 0 = (collisions) + 2 gamma (T - T_tr) + 2 power/D, gamma being `drag` and T
    `temperature`, and likewise for spins with `spin_drag`, `spin_temperature` and 2
    spin_power/(2D-3). The collision terms are `temperature_changes` at the `collision_frequency` of
    T_tr and the packing fraction `packing`. For smooth particles: M. G. Chamorro, F. Vega Reyes &
    V. Garzó, J. Stat. Mech. P07013 (2013). Drags are in 1/T, powers in m a^2/T^3 per particle;
    temperatures are 0 where the bath supplies no energy.
    """
    rates = collision_rates(r, beta, dimension, inertia)
    loss_rate, gain_rate, spin_gain_rate, spin_loss_rate = (np.asarray(rate) for rate in rates)
    drag_loss, spin_drag_loss = 2 * check("drag", drag), 2 * check("drag of spins", spin_drag)
    heating = (
        drag_loss * check("temperature T", temperature) + 2 * check("power", power) / dimension
    )
    spin_heating = spin_drag_loss * check("temperature of spins", spin_temperature)
    spin_heating = spin_heating + 2 * check("power of spins", spin_power) / (2 * dimension - 3)
    unit = collision_frequency(1.0, packing, dimension)

    def state(logarithm):
        """Return T_tr and T_rot that balance at the collision frequency of T_tr = 10^logarithm."""
        nu = unit * 10.0 ** (logarithm / 2)
        drain, spin_drain = nu * loss_rate + drag_loss, nu * spin_loss_rate + spin_drag_loss
        determinant = drain * spin_drain - nu**2 * gain_rate * spin_gain_rate
        T_tr = quotient(heating * spin_drain + spin_heating * nu * gain_rate, determinant)
        return T_tr, quotient(spin_heating * drain + heating * nu * spin_gain_rate, determinant)

    operands = loss_rate, drag_loss, heating, spin_heating, spin_drag_loss, unit
    low = np.full(
        np.broadcast_shapes(*(np.shape(operand) for operand in operands)), -SEARCHED_DECADES
    )
    high = -low
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        below_balance = state(middle)[0] > 10.0**middle
        low, high = np.where(below_balance, middle, low), np.where(below_balance, high, middle)
    heated = (heating > 0) | (spin_heating > 0)
    T_tr, T_rot = state(low)
    return np.where(heated, T_tr, 0.0)[()], np.where(heated, T_rot, 0.0)[()]


def delta_temperatures(r, beta, speed, dimension=2, inertia=None) -> tuple[np.ndarray, np.ndarray]:
    """Return the stationary T_tr and T_rot of a gas driven by the Delta model, in m a^2/T^2.

    A pair that approaches at the normal speed g parts at r g + 2 Delta, with Delta = `speed` (a/T).
    Averages over contacts of a Maxwellian gas are <g> = (pi T_tr/m)^(1/2) and <g^2> = 4 T_tr/m, so
    that with y = Delta (m/T_tr)^(1/2) the energy of translation is constant where

        1 - r^2 + (D-1) q (1-beta^2)/(1-beta+2q) = sqrt(pi) r y + y^2,

    at any density: the left-hand side is the loss of a gas whose rotation is stationary (Lun's
    formula, since the drive adds translational energy only). For smooth particles: R. Brito,
    D. Risso & R. Soto, Phys. Rev. E 87, 022209 (2013). Infinite where contacts lose no energy.
    """
    r, beta, dimension, q = material(r, beta, dimension, inertia)
    tangential = (dimension - 1) * quotient(q * (1 + beta) * (1 - beta), 1 - beta + 2 * q)
    loss = (1 - r) * (1 + r) + tangential
    reflected = np.sqrt(np.pi) * r
    root = np.sqrt(reflected**2 + 4 * loss)
    T_tr = (check("speed Delta", speed) * quotient(reflected + root, 2 * loss)) ** 2
    T_tr, theta = np.broadcast_arrays(T_tr, stationary_theta(r, beta, dimension, q, spin_share=0))
    return T_tr[()], np.multiply(T_tr, theta, out=np.zeros(T_tr.shape), where=theta > 0)[()]
