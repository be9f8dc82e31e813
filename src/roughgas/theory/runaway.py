"""Single particles that keep their spin while a gas with Coulomb friction cools around them.

A particle that spins fast slides at every contact. It then loses mu (1+r)|g_n|/(2q) of a w, however
fast it spins: for spheres, whose spin has a component along the normal that no contact touches, s_D
of that on average. The gas around it cools: per collision per particle its T_tr falls by the factor
exp(-gamma), at constant R. So all that the spinner is still to lose is finite,

    a w* = s_D mu (1+r)/(2q) <|g_n|> f (2/gamma),        s_2 = 1, s_3 = pi/4,

f being its collision frequency over that of the others. Beyond w* it never comes back: in units of
sqrt(T_tr/m) the threshold stays where it is while the spinner goes away from it, and its share of
the energy grows as exp(gamma n).

It moves otherwise than the gas, too: each contact pushes it aside by mu times the normal impulse.
With k = (1+r)/2 and Maxwellian velocities of temperature tau T_tr, <|g_n|> at its contacts is
sqrt(pi (1+tau) T_tr/(2 m)), f is sqrt((1+tau)/2), and tau stays as it is where

    (2 f/D) [2 k tau - k^2 (1+mu^2)(1+tau)] = gamma tau.

There is no such tau, and no threshold, if k (1+mu^2) >= 2: spinners are then heated for good. All
this was derived for this package. Rates of the gas are those of `friction`, on the branch R < 1.
"""

import math
from functools import cache

import numpy as np

from roughgas.theory.arguments import check, material, quotient
from roughgas.theory.friction import NEARLY, friction_changes, friction_ratio

HALVINGS = 100
ROUNDING = 1e-14  # of the cooling rate of a gas that keeps its energy
SINE = {2: 1.0, 3: math.pi / 4}
"""Mean sine of the angle between a spin and a normal."""
ASYMPTOTIC = 20.0
"""Argument from which erfcx is taken from its expansion, right to 1e-5."""
ESCAPED = 0.9
"""R from which spin is said to have outlived translation."""


def cooling_rate(r, beta, mu, dimension=2, inertia=None) -> np.ndarray:
    """Return gamma = -d ln T_tr/dn of a cooling gas at the stationary R < 1.

    n is counted in collisions per particle. NaN where spin outlives translation everywhere (see
    `friction_ratio`).
    """
    R = np.asarray(friction_ratio(r, beta, mu, dimension, inertia))
    there = R < 1 - NEARLY
    held = np.where(there, R, 0.5)
    change, _ = friction_changes(1 - held, held, r, beta, mu, dimension, inertia)
    return np.where(there, -change / (1 - held), np.nan)[()]


def spinner_temperature(r, beta, mu, dimension=2, inertia=None) -> np.ndarray:
    """Return tau, the translational temperature of a fast spinner over that of the gas around it.

    Infinite where contacts heat it for good; NaN where there is no gas at R < 1.
    """
    gas, mu = material(r, beta, dimension, inertia), check("friction mu", mu)
    gamma = np.asarray(cooling_rate(r, beta, mu, dimension, inertia))
    nowhere = np.isnan(gamma)
    k = (1 + gas.r) / 2
    push = k**2 * (1 + mu**2)
    finite = np.isfinite(gamma) & (push < 2 * k)
    gamma, push = np.where(finite, gamma, 1.0), np.where(finite, push, k)
    low, high = np.zeros(finite.shape), np.ones(finite.shape)  # of tau/(1 + tau)
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        # divided by 1 + tau: the cooling of the spinner relative to the gas, as a function of it
        frequency = 1 / np.sqrt(2 * (1 - middle))
        cools = 2 * frequency / gas.dimension * (2 * k * middle - push) > gamma * middle
        low, high = np.where(cools, low, middle), np.where(cools, middle, high)
    tau = high / np.maximum(1 - high, np.finfo(float).tiny)
    return np.where(finite, tau, np.where(nowhere, np.nan, np.inf))[()]


def runaway_spin(r, beta, mu, dimension=2, inertia=None) -> np.ndarray:
    """Return the threshold a w* in units of sqrt(T_tr/m) of the gas, from which spin is kept.

    0 where spin outlives translation anyhow, and without friction, where nothing takes spin away;
    infinite for mu >= sqrt((3-r)/(1+r)) and where nothing cools. Contacts of a spinner at the
    threshold are taken to slide at all times.
    """
    gas, mu = material(r, beta, dimension, inertia), check("friction mu", mu)
    gamma = np.asarray(cooling_rate(r, beta, mu, dimension, inertia))
    tau = np.asarray(spinner_temperature(r, beta, mu, dimension, inertia))
    speed = math.sqrt(math.pi) / 2 * (1 + tau)  # f <|g_n|>
    loss = SINE[gas.dimension] * mu * (1 + gas.r) / (2 * gas.inertia) * speed
    kept = np.isnan(gamma) | (mu == 0) | (gas.beta == -1)
    cools = gamma > ROUNDING
    threshold = np.where(cools, 2 * loss / np.where(cools, gamma, 1.0), np.inf)
    return np.where(kept, 0.0, threshold)[()]


def maxwellian_share(r, beta, mu, dimension=2, inertia=None) -> np.ndarray:
    """Return the share of particles of Maxwellian spins that are beyond `runaway_spin`.

    The tails of a cooling gas hold more by orders of magnitude: see `runaway_rate`.
    """
    dimension = material(r, beta, dimension, inertia).dimension
    x = np.asarray(runaway_spin(r, beta, mu, dimension, inertia))
    x = x / _spin_width(r, beta, mu, dimension, inertia)
    share = np.vectorize(math.erfc, otypes=[float])(x / math.sqrt(2))
    if dimension == 3:
        share = share + math.sqrt(2 / math.pi) * x * np.exp(-(x**2) / 2)
    return share[()]


def runaway_rate(r, beta, mu, dimension=2, inertia=None) -> np.ndarray:
    """Return how many particles cross the threshold per particle and collision of a particle.

    It is exp(-E), but for a factor that is not computed. While a particle meets nobody, or hardly
    touches those that it meets, its spin grows relative to that of the others: in units of
    sqrt(T_tr/m), w' = gamma w/2 between losses l. The probability of getting far by chance is
    exp(-integral of p dw), with p of the Hamiltonian of such a process (large deviations),

        gamma p w/2 = f (1 - <exp(-p l)>)  or  w/w* = erfcx(y/sqrt(2)),  y = p l_0,

    where l_0 = s_D mu (1+r)/(2q) sqrt(1+tau) scales the losses of the density l exp(-l^2/2 l_0^2).
    The way begins where that costs less than to be drawn from a Maxwellian of variance s^2: E =
    w_0^2/(2 s^2) + integral of p from w_0 to w*, w_0/s^2 = p(w_0). For large w* a power of it,
    w*^(-2 f/gamma), remains. For spheres the sine in the loss is replaced by its mean.
    """
    gas, mu = material(r, beta, dimension, inertia), check("friction mu", mu)
    threshold = np.asarray(runaway_spin(r, beta, mu, dimension, inertia))
    alone, never = (threshold > 0) & np.isfinite(threshold), np.isinf(threshold)
    threshold = np.where(alone, threshold, 1.0)
    tau = np.where(alone, spinner_temperature(r, beta, mu, dimension, inertia), 1.0)
    width = np.where(alone, _spin_width(r, beta, mu, dimension, inertia), 1.0)
    loss = SINE[gas.dimension] * mu * (1 + gas.r) / (2 * gas.inertia) * np.sqrt(1 + tau)
    loss = np.where(alone, loss, 1.0)
    y, falling, integral = _large_deviations()
    begin = np.interp(loss * threshold / width**2, y / falling, y)
    w = threshold * np.interp(begin, y, falling)
    path = threshold / loss * (np.interp(begin, y, integral) - begin * w / threshold)
    rate = np.exp(-(w**2) / (2 * width**2) - path)
    return np.where(alone, rate, np.where(never, 0.0, np.nan))[()]


def runaway_growth(particles, r, beta, mu, dimension=2, inertia=None) -> np.ndarray:
    """Return the collisions per particle in which one spinner outgrows a gas: R > ESCAPED.

    It starts from twice the threshold, so that half of its spin is left in the end; at least 0. NaN
    where no gas is at R < 1, or no spinner escapes.
    """
    gas, particles = material(r, beta, dimension, inertia), check("particles", particles)
    gamma = np.asarray(cooling_rate(r, beta, mu, dimension, inertia))
    threshold = np.asarray(runaway_spin(r, beta, mu, dimension, inertia))
    alone = (threshold > 0) & np.isfinite(threshold)
    wanted = ESCAPED / (1 - ESCAPED) * gas.dimension * particles
    factor = wanted / np.where(alone, gas.inertia * threshold**2, 1.0)
    return np.where(alone, np.maximum(np.log(factor), 0.0) / gamma, np.nan)[()]


def runaway_time(particles, r, beta, mu, dimension=2, inertia=None) -> np.ndarray:
    """Return the collisions per particle until R > ESCAPED, in order of magnitude.

    One of N particles crosses the threshold after 1/(N `runaway_rate`), and then grows.
    """
    rate = runaway_rate(r, beta, mu, dimension, inertia)
    growth = runaway_growth(particles, r, beta, mu, dimension, inertia)
    with np.errstate(divide="ignore"):
        return (growth + 1 / (check("particles", particles) * rate))[()]


def _spin_width(r, beta, mu, dimension, inertia) -> np.ndarray:
    """Return the standard deviation of a component of a w, in sqrt(T_tr/m); infinite at R = 1."""
    q = material(r, beta, dimension, inertia).inertia
    R = np.asarray(friction_ratio(r, beta, mu, dimension, inertia))
    return np.sqrt(quotient(R, q * np.where(R < 1 - NEARLY, 1 - R, 0.0)))


@cache
def _large_deviations() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return y, e = erfcx(y/sqrt(2)) = exp(y^2/2) erfc(y/sqrt(2)), and its integral from 0."""
    y = np.concatenate([[0.0], np.geomspace(1e-4, 1e4, 4001)])
    z = y / math.sqrt(2)
    near = np.array([math.exp(x**2) * math.erfc(x) for x in z[z < ASYMPTOTIC]])
    far = z[z >= ASYMPTOTIC]
    e = np.append(near, (1 - 1 / (2 * far**2)) / (far * math.sqrt(math.pi)))
    return y, e, np.append(0.0, np.cumsum(np.diff(y) * (e[1:] + e[:-1]) / 2))
