"""Haff's law: how the energy of a freely cooling gas decays once R is stationary."""

import numpy as np

from roughgas.theory.arguments import Choice, Numbers, check, material
from roughgas.theory.rate_equations import collision_rates
from roughgas.theory.shares import quotient


def haff_temperature(
    time: Numbers,
    T0: Numbers,
    r: Numbers,
    beta: Numbers,
    frequency: Numbers,
    dimension: int = 2,
    inertia: Choice = None,
) -> np.ndarray:
    """Return T_tr = T0/(1 + t/t_h)^2 at `time` >= 0, from T_tr = T0 and the stationary R on.

    `frequency`: collisions per particle per time at T0, e.g. `collision_frequency(T0, packing)`.
    T_rot decays by the same factor. All arguments but D broadcast. Raises InputError.
    """
    time, T0 = check("time", time), check("temperature T0", T0)
    return T0 / (1 + time / haff_time(r, beta, frequency, dimension, inertia)) ** 2


def haff_time(
    r: Numbers, beta: Numbers, frequency: Numbers, dimension: int = 2, inertia: Choice = None
) -> np.ndarray:
    """Return t_h = 2/(frequency * decay_rate), nu being ~ sqrt(T_tr); inf if nothing decays.

    `frequency` (> 0, 1/T) is that at the initial temperature.
    """
    frequency = check("frequency", frequency)
    return quotient(2.0, frequency * decay_rate(r, beta, dimension, inertia))


def decay_rate(r: Numbers, beta: Numbers, dimension: int = 2, inertia: Choice = None) -> np.ndarray:
    """Return -d ln T_tr/dn at the stationary R of a cooling gas, n in collisions per particle.

    At beta = -1 it is that of the smooth gas, (1 - r^2)/D, whose spin has no effect. The limit
    beta -> -1 would be 0, since spin, which hardly decays there, feeds translation.
    """
    r, beta, dimension, q = material(r, beta, dimension, inertia)
    smooth = (1 - r) * (1 + r) / dimension
    return np.where(beta == -1, smooth, slow_decay(r, beta, dimension, q))[()]


def slow_decay(r: Numbers, beta: Numbers, dimension: int = 2, inertia: Choice = None) -> np.ndarray:
    """Return the decay rate of the slower mode of a cooling gas, per collision per particle.

    The product of both rates is a sum of positive terms, so nothing cancels. Raises InputError.
    """
    r, beta, dimension, q = material(r, beta, dimension, inertia)
    rates = collision_rates(r, beta, dimension, q)
    loss, spin_loss = rates.translational_loss, rates.rotational_loss
    product = (
        (1 - r) * (1 + r) * spin_loss + (dimension - 1) * (1 - beta) * rates.rotational_gain
    ) / dimension
    gains = rates.translational_gain * rates.rotational_gain
    total = loss + spin_loss
    return quotient(2 * product, total + np.sqrt((loss - spin_loss) ** 2 + 4 * gains))
