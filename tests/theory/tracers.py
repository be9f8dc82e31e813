"""A slow, independent simulation of single spinners in a cooling gas: many of them side by side,
each meeting particles drawn from Maxwellians. The unit of velocity is sqrt(T_tr/m) of the gas, so
that the gas is stationary and the spinners gain energy."""

import numpy as np
from tests.theory.collisions import after_contact


def final_spins(spinners, start, gas, rate, tau, duration, seed, step=0.03):
    """Return |a w| of each spinner after `duration` collisions per particle of the gas, in units of
    the start, and the mean square of a component of their velocity on the way.

    `gas` is (r, beta, mu, theta, dimension), `rate` the cooling rate of its T_tr.
    """
    r, beta, mu, theta, dimension = gas
    rng, q = np.random.default_rng(seed), {2: 1 / 2, 3: 2 / 5}[dimension]
    moving, turning = ([0, 1], [2]) if dimension == 2 else ([0, 1, 2], [0, 1, 2])

    def gaussian_vectors(axes, width, number=spinners):
        vectors = np.zeros((number, 3))
        vectors[:, axes] = width * rng.standard_normal((number, len(axes)))
        return vectors

    v, w = gaussian_vectors(moving, np.sqrt(tau)), np.zeros((spinners, 3))
    w[:, 2] = start
    # a pair of the gas has |g.n| = 2/sqrt(pi) on average, for any normal
    share, gain, squares = step * np.sqrt(np.pi) / 2, np.exp(rate * step / 2), []
    for _ in range(round(duration / step)):
        partner_velocity, n = gaussian_vectors(moving, 1.0), gaussian_vectors(moving, 1.0)
        n /= np.linalg.norm(n, axis=1, keepdims=True)
        speed = np.sum((v - partner_velocity) * n, axis=1)
        hit = np.flatnonzero(np.abs(speed) * share > rng.random(spinners))
        n = n[hit] * -np.sign(speed[hit, None])
        partner_spin = gaussian_vectors(turning, np.sqrt(theta / q), len(hit))
        unit = np.ones(len(hit))
        spinner, partner = (
            (*x, unit, q * unit, unit)
            for x in ((v[hit], w[hit]), (partner_velocity[hit], partner_spin))
        )
        (v[hit], w[hit]), _ = after_contact(n, spinner, partner, r, beta, mu)
        v, w = gain * v, gain * w
        squares.append(np.sum(v**2) / spinners / dimension)
    return np.linalg.norm(w, axis=1) * np.exp(-rate * duration / 2), np.mean(squares)
