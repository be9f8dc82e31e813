"""The published table of evidence: its closed forms, computed anew in thirty digits.

Each is written here from its source, and shares no code with the studies. Sources without a closed
form, raw data and theories that are solved numerically, are tested elsewhere.
"""

import functools
import re

import numpy as np
import pytest
from mpmath import atan, gamma, mp, mpf, pi, sqrt
from tests.studies.test_exact import evidence, measured

from roughgas.results.comparison import read_rows

mp.dps = 30
TABLE = {  # N. Clisby & B. M. McCoy (2006), Table 1: B_5 to B_10 over powers of B_2
    2: "0.33355604 0.1988425 0.1148728 0.0649930 0.0362193 0.0199537",
    3: "0.110252 0.03888198 0.01302354 0.0041832 0.0013094 0.0004035",
}
SHORT = {"theta": "theta", "beta": "beta", "r": "r", "q": "q", "packing": "x", "a2": "a2"}


def Z(d, x):
    """Return the virial series, with a geometric tail."""
    third = {2: mpf(4) / 3 - sqrt(3) / pi, 3: mpf(5) / 8}[d]
    fourth = {
        2: 2 - 9 * sqrt(3) / (2 * pi) + 10 / pi**2,
        3: 219 * sqrt(2) / (2240 * pi) - mpf(89) / 280 + 4131 * atan(sqrt(2)) / (2240 * pi),
    }[d]
    b = [mpf(1), third, fourth, *map(mpf, TABLE[d].split())]
    terms = [ratio * (2 ** (d - 1) * x) ** (k + 1) for k, ratio in enumerate(b)]
    return 1 + sum(terms) + terms[-1] ** 2 / (terms[-2] - terms[-1])


def contacts(d, r, beta, theta, q):
    """Return loss of T_tr and gain of T_rot per collision of a particle: Huthmann & Zippelius
    (1997)."""
    eta = q * (1 + beta) / (2 + 2 * q)
    loss = (1 - r**2) / 2 + (d - 1) * eta * (1 - eta - eta * theta / q)
    gain = (d - 1) * (eta**2 / q - eta * theta * (1 - eta / q) / q)
    return 2 * loss / d, 2 * gain / (2 * d - 3)


def decay(d, r, beta):
    """Return the decay rate at stationary theta, the ratio of both temperatures."""
    if beta == -1:
        return contacts(d, r, beta, 0, mpf(1))[0]
    q, low, high = {2: mpf(1) / 2, 3: mpf(2) / 5}[d], mpf(0), mpf(10)
    for _ in range(90):
        theta = (low + high) / 2
        loss, gain = contacts(d, r, beta, theta, q)
        low, high = (theta, high) if gain + theta * loss > 0 else (low, theta)
    return loss


def a2(d, r, denominator):
    return 16 * (1 - r) * (1 - 2 * r**2) / denominator


def loss_of_energy(d, r, a2):
    """Return mu_2, and the rate beta_1 of the loss of fast particles: van Noije & Ernst (1998)."""
    mu = (1 - r**2) * pi ** (mpf(d - 1) / 2) / (sqrt(2) * gamma(mpf(d) / 2)) * (1 + 3 * a2 / 16)
    return mu, pi ** (mpf(d - 1) / 2) / gamma(mpf(d + 1) / 2)


def tail(d, r, a2, power):
    mu, beta = loss_of_energy(d, r, a2)
    return d * beta / mu if power == 1 else 2 * sqrt(2 * d * beta / mu) / 3


Q2 = 0.5
"""Moment of inertia of disks."""
Q = {2: mpf(1) / 2, 3: mpf(2) / 5}
FORMULAS = {  # by beginnings of the quantity and of the source
    ("compressibility", "Clisby"): lambda d, x: Z(d, x),
    ("pair corr", "Clisby"): lambda d, x: (Z(d, x) - 1) / (2 ** (d - 1) * x),
    ("compressibility", "Henderson"): lambda d, x: (1 + x**2 / 8) / (1 - x) ** 2,
    ("compressibility", "Carnahan"): lambda d, x: (1 + x + x**2 - x**3) / (1 - x) ** 3,
    ("T_0/T", "Martin"): lambda r, mass: (1 + r) / (2 + (1 - r) / mass),
    ("first loss of T_tr from", "Huth"): lambda d, r, beta, theta: contacts(
        d, r, beta, theta, Q[d]
    )[0],
    ("first gain of T_rot from", "Huth"): lambda d, r, beta, theta: contacts(
        d, r, beta, theta, Q[d]
    )[1],
    ("decay rate", "Huth"): lambda d, r, beta: decay(d, r, beta),
    ("exponent p", "Haff"): lambda: mpf(2),
    ("g_t/g_n", "Walton"): lambda d: (1 + 1 / Q[d]) * mpf("0.3") * mpf("1.9") / mpf("1.2"),
    ("speed at which", "Coriolis"): lambda d: 1 / (1 + Q[d]),
    ("a2 of a smooth cool", "van N"): lambda d, r: a2(
        d, r, 9 + 24 * d + (8 * d - 41) * r + 30 * r**2 * (1 - r)
    ),
    ("a2 of a smooth cool", "Montanero"): lambda d, r: a2(
        d, r, 25 + 24 * d + (8 * d - 57) * r - 2 * r**2 * (1 - r)
    ),
    ("a2 of a smooth white", "van N"): lambda d, r: a2(
        d, r, 73 + 56 * d - 24 * d * r - 105 * r + 30 * r**2 * (1 - r)
    ),
    ("A of the tail exp(-A c)", "van N"): lambda d, r, a2: tail(d, r, a2, 1),
    ("A of the tail exp(-A c^", "van N"): lambda d, r, a2: tail(d, r, a2, 1.5),
    ("self-diffusion of perfectly rough", "Pidduck"): lambda d: {2: mpf(6) / 7, 3: mpf(7) / 9}[d],
    ("R of spheres under", "Morishima"): lambda beta: 2 * (1 + beta) / (14 - 3 * (1 + beta)),
    ("exponent of time in the cooling of visc", "Schwager"): lambda: mpf(5) / 3,
    ("exponent of time in the cooling of visc", "Haff"): lambda: mpf(2),
}
ROWS = [row for _, row in read_rows("figures/evidence.csv")]
ROWS += evidence.rows(measured())  # as computed now


def parameters_of(row):
    """Return the parameters of a row, such as {"d": 2, "r": 0.9}."""
    parameters = dict(re.findall(r"(\w+) (?:= )?(-?[0-9.]+)", row.at))
    dimension = {"disks": 2, "spheres": 3}.get(row.at.split(",")[0])
    return {"d": dimension} | {
        SHORT.get(name, name): mpf(text) for name, text in parameters.items()
    }


@pytest.mark.parametrize("key", FORMULAS)
def test_published_numbers_follow_from_their_equations(key):
    quantity, source = key
    formula = FORMULAS[key]
    names = formula.__code__.co_varnames[: formula.__code__.co_argcount]
    rows = [
        row for row in ROWS if row.quantity.startswith(quantity) and row.source.startswith(source)
    ]
    assert rows
    for row in rows:
        expected = formula(*(parameters_of(row)[name] for name in names))
        assert row.theirs.value == pytest.approx(float(expected), rel=5.1e-9)


def changes(x, r, beta):
    """Return the changes of <V^2>, <w^2>, <V^4>, <V^2 w^2>, <w^4> by contacts of disks: of
    Maxwellians and by a20, a11, a02, to first order, (moments, 1 + cumulants). Gauss's rules are
    exact here.

    T_tr = m = a = 1, <w^2> = x; the polynomials follow A. Megias & A. Santos (2023).
    """
    hermite, weights = np.polynomial.hermite_e.hermegauss(5)
    laguerre, falls = np.polynomial.laguerre.laggauss(5)
    g = 2 * np.sqrt(np.concatenate([laguerre, laguerre]))  # |g| exp(-g^2/4) dg, either sign
    g[5:] *= -1
    nodes = [hermite * np.sqrt(0.5), g, hermite, hermite, *2 * [hermite * np.sqrt(x)]]
    shares = [weights, np.concatenate([falls, falls]), *4 * [weights]]
    middle, g, t_1, t_2, w_1, w_2 = np.meshgrid(*nodes, indexing="ij", sparse=True)
    share = functools.reduce(np.multiply.outer, [axis / axis.sum() for axis in shares])
    n_1, n_2 = middle + g / 2, middle - g / 2
    eta, slip = Q2 * (1 + beta) / (2 + 2 * Q2), t_1 - t_2 - w_1 - w_2

    def moments(n, t, w):
        V2, w2 = n**2 + t**2, w**2
        return V2, w2, V2**2, V2 * w2, w2**2

    def polynomials(n, t, w):
        c2, u2 = (n**2 + t**2) / 2, w**2 / (2 * x)
        a20, a02 = 1 - 2 * c2 + c2**2 / 2, 3 / 8 - 3 / 2 * u2 + u2**2 / 2
        return a20, (1 - c2) * (1 / 2 - u2), a02

    before = moments(n_1, t_1, w_1)
    after = moments(n_1 - (1 + r) / 2 * g, t_1 - eta * slip, w_1 + eta / Q2 * slip)
    both = zip(polynomials(n_1, t_1, w_1), polynomials(n_2, t_2, w_2), strict=True)
    factors = [1.0, *(first + second for first, second in both)]
    change = [new - old for new, old in zip(after, before, strict=True)]
    return np.array([[np.sum(share * moment * factor) for factor in factors] for moment in change])


def state(r, beta, share=None):
    """Return R, a20, a11, a02 of disks: stationary with white noise, or in ratios for cooling."""

    def cumulants(x):
        """Return the cumulants at <w^2> = x, and the imbalance of both energies."""
        J = changes(x, r, beta)
        if share is None:  # <V^4> = 8 (1 + a20) falls as <V^2>^2, and so on
            fall = np.array([J[0], J[0] / 2 + J[1] / x, 2 * J[1] / x])
            rows = J[2:] - [[8], [2 * x], [3 * x**2]] * fall
            rows[:, 1:] -= np.diag([8, 2 * x, 3 * x**2] * fall[:, 0])
        else:  # noise gives back what <V^2> = 2 and <w^2> lose
            noise, turning = -J[0] / 2, -J[1]
            rows = J[2:] + np.array([16 * noise, 2 * x * noise + 2 * turning, 6 * x * turning])
        a = np.linalg.solve(rows[:, 1:], -rows[:, 0])
        V, w = J[:2] @ [1, *a]
        return a, V * x / 2 - w if share is None else share * (V + Q2 * w) - Q2 * w

    high = next(x for x in np.geomspace(1e-3, 1e3, 25) if cumulants(x)[1] >= 0)
    low = high / 2
    for _ in range(40):
        x = np.sqrt(low * high)
        low, high = (x, high) if cumulants(x)[1] < 0 else (low, x)
    return Q2 * x / (1 + Q2 * x), *cumulants(x)[0]


SONINE = [row for row in ROWS if row.source.startswith("Megias & Santos 2023")]


@pytest.mark.slow
@pytest.mark.parametrize("driven", [False, True])
def test_sonine_states_of_disks_by_gaussian_quadrature(driven):
    rows = [row for row in SONINE if ("white noise" in row.quantity) == driven]
    rows = [row for row in rows if "spheres" not in row.at]
    assert len(rows) > 10
    states = {}
    for row in rows:
        parameters_of_row = {
            name: float(value) for name, value in parameters_of(row).items() if value is not None
        }
        parameters = (
            parameters_of_row["r"],
            parameters_of_row["beta"],
            parameters_of_row.get("spin_share"),
        )
        if parameters not in states:
            states[parameters] = dict(
                zip(("R", "a20", "a11", "a02"), state(*parameters), strict=True)
            )
        expected = states[parameters][row.quantity.split()[0]]
        assert row.theirs.value == pytest.approx(expected, rel=1e-8, abs=1e-11)
