"""Rough gases with Coulomb friction: rates, the stationary R as a function of mu, runaway spins.

The contact is Walton's: beta = min(beta_0, -1 + mu (1+r)(1+1/q) |g_n|/|g_t|), so that the
tangential impulse is at most mu times the normal one; a contact where it is equal slides, any other
sticks. With eta = q (1 + beta)/[2 (1 + q)] this is eta = min(eta_0, mu (1+r)/2 |g_n|/|g_t|), and
one collision changes the energies of its pair by the normal part -m (1-r^2) g_n^2/4 and

    translation: m (eta^2 g_t^2 - eta g_t.v_t)      rotation: m (eta^2 g_t^2 - q eta g_t.v_r)/q.

In a Maxwellian gas v_t and v_r are on average T_tr : T_rot/q of g_t, whatever eta, so that only
the averages of eta g_t^2 and eta^2 g_t^2 are needed, and these are elementary (`moments`). Source
of the rule: O. R. Walton, in Particulate Two-Phase Flow, ed. M. C. Roco (1993). Rate equations with
these averages are those of O. Herbst, M. Huthmann & A. Zippelius (Granular Matter 2, 211, 2000),
who found that a cooling gas of spheres with weak friction may keep its spin while translation dies
out, and of Herbst et al. (Phys. Fluids 17, 107102, 2005) for driven disks. The closed forms here
were worked out without having these papers at hand, and have not been compared with theirs.

`beta` is beta_0 and `mu` >= 0 may be infinite: McNamara & Luding's gas, `rate_equations`.

All this is the homogeneous gas, its velocities Maxwellian. When it cools, single particles leave
its stationary R < 1: they keep their spin while the gas cools around them. One that spins fast
slides at every contact. It then loses mu (1+r)|g_n|/(2q) of a w, however fast it spins: for
spheres, whose spin has a component along the normal that no contact touches, s_D of that on
average. The gas around it cools: per collision per particle its T_tr falls by the factor
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

from roughgas.theory.arguments import Material, check, material, quotient, shares
from roughgas.theory.rate_equations import Rates, collision_rates, stationary_ratio

# Halvings of a bracket within [0, 1], and thirds taken off one, that leave a rounding of R
HALVINGS = 60
THIRDS = 90
STEP = 1e-4  # of ln theta, for a slope
NEARLY = 1e-9  # what R lacks to 1 where spin outlives translation, as good as nothing


def sliding_fraction(T_tr, T_rot, r, beta, mu, dimension=2, inertia=None) -> np.ndarray:
    """Return the share of contacts that slide; 0 for beta = -1, where there is no friction."""
    T_tr, T_rot = check("temperature T_tr", T_tr), check("temperature T_rot", T_rot)
    gas, mu = material(r, beta, dimension, inertia), check("friction mu", mu)
    sticking = 1 / np.hypot(1, _threshold(T_tr, T_rot, gas, mu))
    return (1 - sticking ** (gas.dimension - 1))[()]


def friction_changes(
    T_tr, T_rot, r, beta, mu, dimension=2, inertia=None, frequency=1.0
) -> tuple[np.ndarray, np.ndarray]:
    """Return dT_tr/dt and dT_rot/dt due to collisions: `temperature_changes` at infinite mu.

    With the frequency 1 left as it is, they are per collision per particle.
    """
    T_tr, T_rot = check("temperature T_tr", T_tr), check("temperature T_rot", T_rot)
    gas, mu = material(r, beta, dimension, inertia), check("friction mu", mu)
    return _rates(T_tr, T_rot, gas, mu).changes(T_tr, T_rot, check("frequency", frequency))


def friction_ratio(r, beta, mu, dimension=2, inertia=None, spin_share=None) -> np.ndarray:
    """Return the stationary R that a gas started without spin reaches, to 1e-13.

    Without a drive (spin_share None), or driven with a share of its power into spin. At infinite mu
    it is `stationary_ratio`; at mu = 0, as at beta = -1, spin is decoupled, and R the limit given
    there.

    R = 1 where theta grows without bound: translational energy dies out faster than spin. Where a
    cooling gas has R < 1, single particles leave it all the same (`runaway_spin`).

    - Without a drive a gas that spins fast enough goes there for mu < mu_c = sqrt((1-r)/(1+r)), in
      2D and 3D; one started without spin for mu below some mu_s <= mu_c, where R jumps to 1. For
      nearly elastic disks mu_s is q (1-r)/(2-q), for spheres (2/pi) q (1-r)/(1-q), to leading
      order. For disks with (1 + beta)(2-q)/(1+q) <= 1 - r^2, mu_s = mu_c, and there is no jump.
    - Driven through rotation, spin_share 1, every gas does for mu <= mu_c.
    - Otherwise a driven gas has one stationary R. At spin_share 0 theta is (1+r) mu for disks,
      (2/pi) (1+r) mu for spheres, to leading order in mu, and for disks at any mu
      2 q e/[1-e + sqrt((1-e)^2 + (q e/kappa)^2)], e = (1+beta)/(2+2q), kappa = mu (1+r)/2.
    """
    gas, mu = material(r, beta, dimension, inertia), check("friction mu", mu)
    share = None if spin_share is None else check("spin share of the drive", spin_share)
    decoupled = stationary_ratio(gas.r, -1, dimension, gas.inertia, share)
    shape = np.broadcast_shapes(gas.beta.shape, mu.shape, np.shape(decoupled))

    def growth(R):
        return _growth(R, gas, mu, share)

    # a drive leaves room for one stationary state only
    high = _fastest_fall(growth, shape) if share is None else np.ones(shape)
    low = np.zeros(shape)
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        grows = growth(middle) > 0
        low, high = np.where(grows, middle, low), np.where(grows, high, middle)
    return np.where((mu == 0) | (gas.beta == -1), decoupled, high)[()]


def critical_friction(r) -> np.ndarray:
    """Return mu_c = sqrt((1-r)/(1+r)), up to which a cooling gas of dominant spins keeps R = 1.

    There, sliding contacts add as much to translation as inelastic ones take, in 2D and 3D, for any
    beta and q, if all particles spin fast. It is no bound for single ones that do:
    `runaway_spin`.
    """
    r = check("restitution r", r)
    return np.sqrt((1 - r) / (1 + r))[()]


def friction_relaxation_rate(r, beta, mu, dimension=2, inertia=None) -> np.ndarray:
    """Return the rate at which R of a cooling gas relaxes, per collision per particle.

    R goes to `friction_ratio`. From the linear stability of ln theta, by a central difference;
    where R = 1, the rate at which theta grows in the end. `relaxation_rate` at infinite mu; 0 where
    spin is decoupled.
    """
    gas, mu = material(r, beta, dimension, inertia), check("friction mu", mu)
    R = friction_ratio(r, beta, mu, dimension, inertia)
    lasting = np.where(R < 1 - NEARLY, R, 0.5)
    theta = lasting / (1 - lasting)
    below, above = theta * np.exp(-STEP), theta * np.exp(STEP)
    fall = _growth(below / (1 + below), gas, mu, None) - _growth(above / (1 + above), gas, mu, None)
    final = _growth(np.asarray(1 - NEARLY), gas, mu, None)
    rate = np.where(R < 1 - NEARLY, fall / (2 * STEP), final)
    return np.where((mu == 0) | (gas.beta == -1), 0.0, rate)[()]


def _fastest_fall(growth, shape) -> np.ndarray:
    """Return R where theta falls fastest in a cooling gas, beyond the stationary R; 1 for nowhere.

    d ln theta/dn has no other minimum, being convex as a function of `sticking` (2D) or its square
    (3D, q <= 1), or growing with it (3D, q > 1); so it changes sign once between no spin and there.
    """
    low, high = np.zeros(shape), np.ones(shape)
    for _ in range(THIRDS):
        third = (high - low) / 3
        left, right = low + third, high - third
        falls = growth(left) > growth(right)
        low, high = np.where(falls, left, low), np.where(falls, high, right)
    fastest = (low + high) / 2
    return np.where(growth(fastest) < 0, fastest, 1.0)


def _growth(R, gas: Material, mu, share) -> np.ndarray:
    """Return a number with the sign of d theta/dt: d ln theta/dn without a drive.

    With one, the power that spin still lacks to lose energy as `share`, where T_tr + T_rot = 1.
    """
    T_tr, T_rot = 1 - R, R
    rates = _rates(T_tr, T_rot, gas, mu)
    if share is None:
        return (
            quotient(rates.rotational_gain * T_tr, T_rot)
            - quotient(rates.translational_gain * T_rot, T_tr)
            + (rates.translational_loss - rates.rotational_loss)
        )
    translational, rotational = rates.changes(T_tr, T_rot)
    D = gas.dimension
    return (1 - share) * (2 * D - 3) * rotational - share * D * translational


def _rates(T_tr, T_rot, gas: Material, mu) -> Rates:
    """Return the coefficients of the rate equations, which now depend on theta: see `Rates`.

    They are those without friction, times the second moment, plus a loss of both energies where
    contacts slide, the first moment exceeding the second.
    """
    r, _, dimension, q = gas
    sticking = collision_rates(*gas)
    first, second = moments(_threshold(T_tr, T_rot, gas, mu), dimension)
    slid = 2 * (dimension - 1) * gas.eta * (first - second)
    inelastic = (1 - r) * (1 + r) / dimension
    return Rates(
        translational_loss=second * sticking.translational_loss
        + (1 - second) * inelastic
        + slid / dimension,
        translational_gain=second * sticking.translational_gain,
        rotational_gain=second * sticking.rotational_gain,
        rotational_loss=second * sticking.rotational_loss + slid / q / (2 * dimension - 3),
    )


def moments(threshold, dimension) -> tuple[np.ndarray, np.ndarray]:
    """Return <eta g_t^2>/(eta_0 <g_t^2>) and <eta^2 g_t^2>/(eta_0^2 <g_t^2>), both in [0, 1].

    With x = g_n/sqrt(<g_n^2>/2) and y = |g_t|/sqrt(<g_t^2>/(D-1)), of density x y^(D-2)
    exp(-(x^2+y^2)/2), eta depends on c = y/sqrt(x^2+y^2) alone, whose density is (D-1) c^(D-2), and
    the averages weight c with c^D. Contacts with c below 1/sqrt(1 + threshold^2) stick.
    """
    sticking = 1 / np.hypot(1, threshold)
    if dimension == 2:
        return sticking, 2 * sticking**2 / (1 + sticking)
    # arctan(threshold)/threshold, which is 1 at 0
    angle_ratio = sticking / np.sinc(np.arctan(threshold) / np.pi)
    return (angle_ratio + sticking**2) / 2, sticking**2


def _threshold(T_tr, T_rot, gas: Material, mu) -> np.ndarray:
    """Return x/y (`moments`) below which contacts slide: eta_0/[mu (1+r)/2], scaled."""
    normal = np.sqrt(shares(T_tr, T_rot / gas.inertia, neither=0)[0])
    return quotient(quotient(gas.eta, mu * (1 + gas.r) / 2), normal)


FINE_HALVINGS = 100
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
    for _ in range(FINE_HALVINGS):
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
