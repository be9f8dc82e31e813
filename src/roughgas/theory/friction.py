"""Rough gases with Coulomb friction: rates, the stationary R as a function of mu, runaway spins.

The contact is Walton's: beta = min(beta_0, -1 + mu (1+r)(1+1/q) |g_n|/|g_t|), so that the
tangential impulse is at most mu times the normal one. A contact slides if it reaches this bound,
and sticks otherwise. With eta = q (1 + beta)/[2 (1 + q)] this is eta = min(eta_0, mu (1+r)/2
|g_n|/|g_t|), and one collision changes the energies of its pair by the normal part -m (1-r^2)
g_n^2/4 and

    translation: m (eta^2 g_t^2 - eta g_t.v_t)      rotation: m (eta^2 g_t^2 - q eta g_t.v_r)/q.

In a Maxwellian gas v_t and v_r are on average T_tr : T_rot/q of g_t, whatever eta, so that only
the averages of eta g_t^2 and eta^2 g_t^2 are needed, and these are elementary (`moments`). Source
of the rule: O. R. Walton, in Particulate Two-Phase Flow, ed. M. C. Roco (1993). O. Herbst,
M. Huthmann & A. Zippelius (Granular Matter 2, 211, 2000) published rate equations with these
averages, and found that a cooling gas of spheres with weak friction may keep its spin while
translation dies out; Herbst et al. (Phys. Fluids 17, 107102, 2005) did so for driven disks. The
closed forms of this module were derived without access to these papers, and have not been compared
with theirs.

`beta` is beta_0 and `mu` >= 0 may be infinite: McNamara & Luding's gas, `rate_equations`.

These results hold for a homogeneous gas with Maxwellian velocities. When it cools, single particles
leave its stationary R < 1: they keep their spin while the gas cools around them. Such a spinner
slides at every contact. It then loses mu (1+r)|g_n|/(2q) of a w, however fast it spins; spheres
lose s_D times as much on average, as no contact changes the component of the spin along the normal.
The gas around it cools: per collision per particle its T_tr falls by the factor exp(-gamma), at
constant R. So the total loss of the spinner is finite,

    a w* = s_D mu (1+r)/(2q) <|g_n|> f (2/gamma),        s_2 = 1, s_3 = pi/4,

f being its collision frequency over the frequency of the gas. Beyond w* it never returns: in units
of sqrt(T_tr/m) the threshold is constant while the spin grows, and the spinner's share of the
energy grows as exp(gamma n).

Its translation differs from the gas, too: each contact pushes it aside by mu times the normal
impulse. With k = (1+r)/2 and Maxwellian velocities of temperature tau T_tr, <|g_n|> at its contacts
is sqrt(pi (1+tau) T_tr/(2 m)), f is sqrt((1+tau)/2), and tau is constant where

    (2 f/D) [2 k tau - k^2 (1+mu^2)(1+tau)] = gamma tau.

There is no such tau, and no threshold, if k (1+mu^2) >= 2: spinners are then heated without bound.
The theory of spinners was derived for this package; the gas has the rates of `friction_changes`, on
the branch R < 1.

R = T_rot/(T_rot + T_tr) is the share of rotational energy, theta = T_rot/T_tr; r is the normal
restitution, q = I/(m a^2), D the number of dimensions. n counts collisions per particle.
"""

import math
from functools import cache

import numpy as np

from roughgas.theory.arguments import Material, check, material, quotient, shares
from roughgas.theory.rate_equations import Rates, collision_rates, stationary_ratio

# Bisections, and steps of a ternary search, that shrink [0, 1] to the rounding of R
BISECTIONS = 60
TERNARY_STEPS = 90
LOG_THETA_STEP = 1e-4  # of ln theta, for central differences
R_MARGIN = 1e-9  # values of R within this of 1 count as 1: spin outlives translation


def sliding_fraction(T_tr, T_rot, r, beta, mu, dimension=2, inertia=None) -> np.ndarray:
    """Return the share of contacts that slide; 0 at beta = -1, where no friction acts.

    The gas is Maxwellian; of `T_tr` and `T_rot` only the ratio matters. `mu` is the coefficient of
    friction, `beta` the roughness of sticking contacts, `inertia` q = I/(m a^2), by default of
    uniform disks or spheres. Numbers or arrays, which broadcast.
    """
    T_tr, T_rot = check("temperature T_tr", T_tr), check("temperature T_rot", T_rot)
    gas, mu = material(r, beta, dimension, inertia), check("friction mu", mu)
    sticking = 1 / np.hypot(1, _slip_threshold(T_tr, T_rot, gas, mu))
    return (1 - sticking ** (gas.dimension - 1))[()]


def friction_changes(
    T_tr, T_rot, r, beta, mu, dimension=2, inertia=None, frequency=1.0
) -> tuple[np.ndarray, np.ndarray]:
    """Return dT_tr/dt and dT_rot/dt due to collisions with friction, in m a^2/T^3.

    `T_tr` and `T_rot` are in m a^2/T^2, `mu` is the coefficient of friction; `temperature_changes`
    at infinite mu. `frequency` is the number of collisions per particle per T. The changes are per
    collision per particle if `frequency` is 1, the default.
    """
    T_tr, T_rot = check("temperature T_tr", T_tr), check("temperature T_rot", T_rot)
    gas, mu = material(r, beta, dimension, inertia), check("friction mu", mu)
    return _rates(T_tr, T_rot, gas, mu).changes(T_tr, T_rot, check("frequency", frequency))


def friction_ratio(r, beta, mu, dimension=2, inertia=None, spin_share=None) -> np.ndarray:
    """Return the stationary R that a gas started without spin reaches, to 1e-13.

    R = T_rot/(T_rot + T_tr), theta = T_rot/T_tr; `beta` is the roughness of sticking contacts, `mu`
    the coefficient of friction. Without a drive (spin_share None), or driven with a share of its
    power into spin. At infinite mu it is `stationary_ratio`; at mu = 0, as at beta = -1, spin is
    decoupled, and R is the limit that `stationary_ratio` has at beta = -1.

    R = 1 where theta grows without bound: translational energy dies out faster than spin. Where a
    cooling gas has R < 1, single particles may still leave it (`runaway_spin`).

    - Without a drive a gas that spins fast enough reaches R = 1 for mu < mu_c = sqrt((1-r)/(1+r)),
      in 2D and 3D; a gas without initial spin for mu below some mu_s <= mu_c, where R jumps to 1.
      For nearly elastic disks mu_s is q (1-r)/(2-q), for spheres (2/pi) q (1-r)/(1-q), to leading
      order. For disks with (1 + beta)(2-q)/(1+q) <= 1 - r^2, mu_s = mu_c, and R does not jump.
    - Driven through rotation, spin_share 1, every gas reaches R = 1 for mu <= mu_c.
    - Otherwise a driven gas has one stationary R. At spin_share 0 theta is (1+r) mu for disks,
      (2/pi) (1+r) mu for spheres, to leading order in mu, and for disks at any mu
      2 q e/[1-e + sqrt((1-e)^2 + (q e/kappa)^2)], e = (1+beta)/(2+2q), kappa = mu (1+r)/2.
    """
    gas, mu = material(r, beta, dimension, inertia), check("friction mu", mu)
    share = None if spin_share is None else check("spin share of the drive", spin_share)
    decoupled = stationary_ratio(gas.r, -1, dimension, gas.inertia, share)
    shape = np.broadcast_shapes(gas.beta.shape, mu.shape, np.shape(decoupled))

    def growth(R):
        """Return d ln theta/dn, or its sign, at `R`: see `_theta_growth`."""
        return _theta_growth(R, gas, mu, share)

    # a driven gas has a single stationary state
    high = _ratio_of_fastest_fall(growth, shape) if share is None else np.ones(shape)
    low = np.zeros(shape)
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        grows = growth(middle) > 0
        low, high = np.where(grows, middle, low), np.where(grows, high, middle)
    return np.where((mu == 0) | (gas.beta == -1), decoupled, high)[()]


def critical_friction(r) -> np.ndarray:
    """Return mu_c = sqrt((1-r)/(1+r)), the largest mu at which a gas of fast spins keeps R = 1.

    mu is the coefficient of friction, R the share of rotational energy. There, sliding contacts add
    as much energy to translation as inelastic contacts dissipate, in 2D and 3D, for any beta and q,
    if all particles spin fast. A single fast spinner may escape at other mu: `runaway_spin`.
    """
    r = check("restitution r", r)
    return np.sqrt((1 - r) / (1 + r))[()]


def friction_relaxation_rate(r, beta, mu, dimension=2, inertia=None) -> np.ndarray:
    """Return the relaxation rate of R in a cooling gas with friction, per collision per particle.

    `mu` is the coefficient of friction. R relaxes to `friction_ratio`. From the linear stability of
    ln theta, theta = T_rot/T_tr, by a central difference; where R = 1, the final growth rate of
    theta. `relaxation_rate` at infinite mu; 0 where spin is decoupled.
    """
    gas, mu = material(r, beta, dimension, inertia), check("friction mu", mu)
    R = friction_ratio(r, beta, mu, dimension, inertia)
    bounded_R = np.where(R < 1 - R_MARGIN, R, 0.5)
    theta = bounded_R / (1 - bounded_R)
    below, above = theta * np.exp(-LOG_THETA_STEP), theta * np.exp(LOG_THETA_STEP)
    fall = _theta_growth(below / (1 + below), gas, mu, None) - _theta_growth(
        above / (1 + above), gas, mu, None
    )
    final = _theta_growth(np.asarray(1 - R_MARGIN), gas, mu, None)
    rate = np.where(R < 1 - R_MARGIN, fall / (2 * LOG_THETA_STEP), final)
    return np.where((mu == 0) | (gas.beta == -1), 0.0, rate)[()]


def _ratio_of_fastest_fall(growth, shape) -> np.ndarray:
    """Return the R where theta = T_rot/T_tr falls fastest in a cooling gas; 1 where it never falls.

    `growth` returns d ln theta/dn at R, an array of this `shape`. It lies beyond the stationary R.
    d ln theta/dn has no other minimum, being a function of `sticking` that is convex (2D; 3D in its
    square, q <= 1) or grows (3D, q > 1); so it changes sign once between R = 0 and this R.
    """
    low, high = np.zeros(shape), np.ones(shape)
    for _ in range(TERNARY_STEPS):
        third = (high - low) / 3
        lower_third, upper_third = low + third, high - third
        falls = growth(lower_third) > growth(upper_third)
        low, high = np.where(falls, lower_third, low), np.where(falls, high, upper_third)
    fastest = (low + high) / 2
    return np.where(growth(fastest) < 0, fastest, 1.0)


def _theta_growth(R, gas: Material, mu, share) -> np.ndarray:
    """Return d ln theta/dn without a drive; with a drive a number with the sign of d theta/dt.

    `mu` is the coefficient of friction, `share` the spin share of the power of the drive, None
    without a drive; n counts collisions per particle. With a drive, where T_tr + T_rot = 1, the
    number vanishes where collisions take energy out of spin and translation as share : 1 - share,
    and is positive where spin loses less than that.
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
    """Return the coefficients of the rate equations with friction, which depend on theta.

    `mu` is the coefficient of friction. They are the coefficients without friction times the second
    moment (`moments`), plus a loss of both energies at sliding contacts, which grows as the first
    moment less the second.
    """
    r, _, dimension, q = gas
    without_friction = collision_rates(*gas)
    first, second = moments(_slip_threshold(T_tr, T_rot, gas, mu), dimension)
    sliding_loss = 2 * (dimension - 1) * gas.eta * (first - second)
    inelastic = (1 - r) * (1 + r) / dimension
    return Rates(
        translational_loss=second * without_friction.translational_loss
        + (1 - second) * inelastic
        + sliding_loss / dimension,
        translational_gain=second * without_friction.translational_gain,
        rotational_gain=second * without_friction.rotational_gain,
        rotational_loss=second * without_friction.rotational_loss
        + sliding_loss / q / (2 * dimension - 3),
    )


def moments(threshold, dimension) -> tuple[np.ndarray, np.ndarray]:
    """Return <eta g_t^2>/(eta_0 <g_t^2>) and <eta^2 g_t^2>/(eta_0^2 <g_t^2>), both in [0, 1].

    `threshold` is the ratio x/y below which contacts slide. With x = g_n/sqrt(<g_n^2>/2) and y =
    |g_t|/sqrt(<g_t^2>/(D-1)), of density x y^(D-2) exp(-(x^2+y^2)/2), eta depends on
    c = y/sqrt(x^2+y^2) alone, whose density is (D-1) c^(D-2), and the averages weight c with c^D.
    Contacts with c below 1/sqrt(1 + threshold^2) stick.
    """
    sticking = 1 / np.hypot(1, threshold)
    if dimension == 2:
        return sticking, 2 * sticking**2 / (1 + sticking)
    # arctan(threshold)/threshold, which is 1 at 0
    angle_ratio = sticking / np.sinc(np.arctan(threshold) / np.pi)
    return (angle_ratio + sticking**2) / 2, sticking**2


def _slip_threshold(T_tr, T_rot, gas: Material, mu) -> np.ndarray:
    """Return the ratio x/y of `moments` below which contacts slide: scaled eta_0/[mu (1+r)/2].

    eta_0 = q (1 + beta)/[2 (1 + q)] describes sticking contacts, `mu` is the coefficient of
    friction; x/y is the normal over the slip velocity, each over its mean size, which depends on
    T_rot/T_tr.
    """
    normal = np.sqrt(shares(T_tr, T_rot / gas.inertia, second_if_both_zero=0)[0])
    return quotient(quotient(gas.eta, mu * (1 + gas.r) / 2), normal)


FINE_BISECTIONS = 100
NEGLIGIBLE_COOLING = 1e-14  # rounding of the cooling rate of a gas that conserves its energy
MEAN_SINE = {2: 1.0, 3: math.pi / 4}
"""Mean sine of the angle between a spin and the normal of a contact, by dimension."""
ERFCX_ASYMPTOTIC = 20.0
"""Argument from which erfcx is computed by its asymptotic expansion, accurate to 1e-5."""
RUNAWAY_R = 0.9
"""R from which spin counts as having outlived translation."""


def cooling_rate(r, beta, mu, dimension=2, inertia=None) -> np.ndarray:
    """Return gamma = -d ln T_tr/dn of a cooling gas with friction, at the stationary R < 1.

    `mu` is the coefficient of friction; n is counted in collisions per particle. NaN where spin
    outlives translation everywhere (see `friction_ratio`).
    """
    R = np.asarray(friction_ratio(r, beta, mu, dimension, inertia))
    is_stationary = R < 1 - R_MARGIN
    stationary_R = np.where(is_stationary, R, 0.5)
    change, _ = friction_changes(1 - stationary_R, stationary_R, r, beta, mu, dimension, inertia)
    return np.where(is_stationary, -change / (1 - stationary_R), np.nan)[()]


def spinner_temperature(r, beta, mu, dimension=2, inertia=None) -> np.ndarray:
    """Return tau, the translational temperature of a fast spinner over T_tr of the cooling gas.

    `mu` is the coefficient of friction. Infinite where contacts heat the spinner without bound; NaN
    where no gas has R < 1.
    """
    gas, mu = material(r, beta, dimension, inertia), check("friction mu", mu)
    gamma = np.asarray(cooling_rate(r, beta, mu, dimension, inertia))
    no_gas = np.isnan(gamma)
    k = (1 + gas.r) / 2
    push = k**2 * (1 + mu**2)
    finite = np.isfinite(gamma) & (push < 2 * k)
    gamma, push = np.where(finite, gamma, 1.0), np.where(finite, push, k)
    low, high = np.zeros(finite.shape), np.ones(finite.shape)  # of tau/(1 + tau)
    for _ in range(FINE_BISECTIONS):
        middle = (low + high) / 2
        # divided by 1 + tau: cooling of the spinner relative to the gas
        frequency = 1 / np.sqrt(2 * (1 - middle))
        cools = 2 * frequency / gas.dimension * (2 * k * middle - push) > gamma * middle
        low, high = np.where(cools, low, middle), np.where(cools, middle, high)
    tau = high / np.maximum(1 - high, np.finfo(float).tiny)
    return np.where(finite, tau, np.where(no_gas, np.nan, np.inf))[()]


def runaway_spin(r, beta, mu, dimension=2, inertia=None) -> np.ndarray:
    """Return the spin a w* from which on spinners escape, in units of sqrt(T_tr/m) of the gas.

    `mu` is the coefficient of friction; the gas cools. 0 where spin outlives translation in every
    gas, and without friction, where no contact changes spin; infinite for mu >= sqrt((3-r)/(1+r))
    and where nothing cools. Contacts of a spinner at the threshold are assumed to slide at all
    times.
    """
    gas, mu = material(r, beta, dimension, inertia), check("friction mu", mu)
    gamma = np.asarray(cooling_rate(r, beta, mu, dimension, inertia))
    tau = np.asarray(spinner_temperature(r, beta, mu, dimension, inertia))
    speed = math.sqrt(math.pi) / 2 * (1 + tau)  # f <|g_n|>
    loss = MEAN_SINE[gas.dimension] * mu * (1 + gas.r) / (2 * gas.inertia) * speed
    always_escapes = np.isnan(gamma) | (mu == 0) | (gas.beta == -1)
    cools = gamma > NEGLIGIBLE_COOLING
    threshold = np.where(cools, 2 * loss / np.where(cools, gamma, 1.0), np.inf)
    return np.where(always_escapes, 0.0, threshold)[()]


def maxwellian_share(r, beta, mu, dimension=2, inertia=None) -> np.ndarray:
    """Return the share of particles with spins beyond `runaway_spin`, if spins are Maxwellian.

    `mu` is the coefficient of friction. The tails of a cooling gas hold more particles by orders of
    magnitude: see `runaway_rate`.
    """
    dimension = material(r, beta, dimension, inertia).dimension
    x = np.asarray(runaway_spin(r, beta, mu, dimension, inertia))
    x = x / _spin_width(r, beta, mu, dimension, inertia)
    share = np.vectorize(math.erfc, otypes=[float])(x / math.sqrt(2))
    if dimension == 3:
        share = share + math.sqrt(2 / math.pi) * x * np.exp(-(x**2) / 2)
    return share[()]


def runaway_rate(r, beta, mu, dimension=2, inertia=None) -> np.ndarray:
    """Return the crossings of the threshold `runaway_spin` per particle and collision per particle.

    `mu` is the coefficient of friction. The rate is exp(-E), up to a factor that is not computed.
    While a particle has no collisions, or grazing ones only, its spin grows relative to the other
    spins: in units of sqrt(T_tr/m), w' = gamma w/2 between losses l. The probability of a large
    spin by chance is exp(-integral of p dw), with p of the Hamiltonian of such a process (large
    deviations),

        gamma p w/2 = f (1 - <exp(-p l)>)  or  w/w* = erfcx(y/sqrt(2)),  y = p l_0,

    where l_0 = s_D mu (1+r)/(2q) sqrt(1+tau) scales the losses of the density l exp(-l^2/2 l_0^2).
    The path starts at the spin w_0 where this is more likely than a draw from a Maxwellian of
    variance s^2: E = w_0^2/(2 s^2) + integral of p from w_0 to w*, w_0/s^2 = p(w_0). For large w*
    the rate falls as w*^(-2 f/gamma). For spheres the sine in the loss is replaced by its mean.
    """
    gas, mu = material(r, beta, dimension, inertia), check("friction mu", mu)
    threshold = np.asarray(runaway_spin(r, beta, mu, dimension, inertia))
    escapes_by_chance, never_escapes = (threshold > 0) & np.isfinite(threshold), np.isinf(threshold)
    threshold = np.where(escapes_by_chance, threshold, 1.0)
    tau = np.where(escapes_by_chance, spinner_temperature(r, beta, mu, dimension, inertia), 1.0)
    width = np.where(escapes_by_chance, _spin_width(r, beta, mu, dimension, inertia), 1.0)
    loss = MEAN_SINE[gas.dimension] * mu * (1 + gas.r) / (2 * gas.inertia) * np.sqrt(1 + tau)
    loss = np.where(escapes_by_chance, loss, 1.0)
    y, erfcx, integral = _erfcx_table()
    begin_y = np.interp(loss * threshold / width**2, y / erfcx, y)
    w = threshold * np.interp(begin_y, y, erfcx)
    integral_of_p = threshold / loss * (np.interp(begin_y, y, integral) - begin_y * w / threshold)
    rate = np.exp(-(w**2) / (2 * width**2) - integral_of_p)
    return np.where(escapes_by_chance, rate, np.where(never_escapes, 0.0, np.nan))[()]


def runaway_growth(particles, r, beta, mu, dimension=2, inertia=None) -> np.ndarray:
    """Return the collisions per particle until a spinner dominates the energy: R > RUNAWAY_R.

    `particles` is the number of particles, `mu` the coefficient of friction. The spinner starts
    from twice the threshold `runaway_spin`, and finally keeps half of its spin; at least 0. NaN
    where no gas has R < 1, or no spinner escapes.
    """
    gas, particles = material(r, beta, dimension, inertia), check("particles", particles)
    gamma = np.asarray(cooling_rate(r, beta, mu, dimension, inertia))
    threshold = np.asarray(runaway_spin(r, beta, mu, dimension, inertia))
    has_threshold = (threshold > 0) & np.isfinite(threshold)
    escape_energy = RUNAWAY_R / (1 - RUNAWAY_R) * gas.dimension * particles
    factor = escape_energy / np.where(has_threshold, gas.inertia * threshold**2, 1.0)
    return np.where(has_threshold, np.maximum(np.log(factor), 0.0) / gamma, np.nan)[()]


def runaway_time(particles, r, beta, mu, dimension=2, inertia=None) -> np.ndarray:
    """Return the collisions per particle until R > RUNAWAY_R, in order of magnitude.

    The first of N (`particles`) crosses the threshold after 1/(N `runaway_rate`), and then its
    share of the energy grows (`runaway_growth`). `mu` is the coefficient of friction.
    """
    rate = runaway_rate(r, beta, mu, dimension, inertia)
    growth = runaway_growth(particles, r, beta, mu, dimension, inertia)
    with np.errstate(divide="ignore"):
        return (growth + 1 / (check("particles", particles) * rate))[()]


def _spin_width(r, beta, mu, dimension, inertia) -> np.ndarray:
    """Return the standard deviation of a component of a w, in sqrt(T_tr/m); infinite at R = 1.

    The stationary gas has the coefficient of friction `mu`.
    """
    q = material(r, beta, dimension, inertia).inertia
    R = np.asarray(friction_ratio(r, beta, mu, dimension, inertia))
    return np.sqrt(quotient(R, q * np.where(R < 1 - R_MARGIN, 1 - R, 0.0)))


@cache
def _erfcx_table() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return y, e = erfcx(y/sqrt(2)) = exp(y^2/2) erfc(y/sqrt(2)), and its integral from 0.

    Three arrays of equal length, with y >= 0 rising.
    """
    y = np.concatenate([[0.0], np.geomspace(1e-4, 1e4, 4001)])
    z = y / math.sqrt(2)
    exact = np.array([math.exp(x**2) * math.erfc(x) for x in z[z < ERFCX_ASYMPTOTIC]])
    z_far = z[z >= ERFCX_ASYMPTOTIC]
    erfcx = np.append(exact, (1 - 1 / (2 * z_far**2)) / (z_far * math.sqrt(math.pi)))
    return y, erfcx, np.append(0.0, np.cumsum(np.diff(y) * (erfcx[1:] + erfcx[:-1]) / 2))
