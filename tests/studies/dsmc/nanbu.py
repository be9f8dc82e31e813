"""An independent simulation of a homogeneous gas: Nanbu's idea with Babovsky's pairs, in numpy.

In each step all particles are paired at random, and each pair collides with the probability
|g.n| dt for a random n, g being the relative velocity. Vectors of three components throughout,
the collision rule from the conservation laws, the tangential impulse at most mu times the normal.
"""

import numpy as np

MAJORANT = 9.0  # of |g.n|, at T_tr = 1: six and a half standard deviations
TINY = 1e-300


def ratios(particles, r, beta, dimension, steps, seed, mu=np.inf, theta=1.0):
    """Collisions per particle and R after each step, shape (steps,), from T_rot/T_tr = theta on;
    T_tr is kept at 1."""
    rng = np.random.default_rng(seed)
    q = {2: 1 / 2, 3: 2 / 5}[dimension]
    moving, turning = ([0, 1], [2]) if dimension == 2 else ([0, 1, 2], [0, 1, 2])
    v, w, R = np.zeros((particles, 3)), np.zeros((particles, 3)), np.empty(steps)
    passed = np.empty(steps)
    v[:, moving] = rng.standard_normal((particles, dimension))
    w[:, turning] = rng.standard_normal((particles, len(turning))) * np.sqrt(theta / q)
    for k in range(steps):
        first, second = rng.permutation(particles).reshape(2, -1)
        n = np.zeros((len(first), 3))
        n[:, moving] = rng.standard_normal((len(first), dimension))
        n /= np.linalg.norm(n, axis=1, keepdims=True)
        speed = np.sum((v[first] - v[second]) * n, axis=1)
        hit = np.abs(speed) > MAJORANT * rng.random(len(first))
        _collide(v, w, first[hit], second[hit], n[hit] * -np.sign(speed[hit, None]), r, beta, q, mu)
        v[:, moving] -= v[:, moving].mean(axis=0)
        T_tr, T_rot = np.sum(v**2) / dimension, q * np.sum(w**2) / len(turning)
        passed[k] = 2 * hit.sum() / particles
        R[k] = T_rot / (T_tr + T_rot)
        scale = np.sqrt(particles / T_tr)
        v *= scale
        w *= scale
    return np.cumsum(passed), R


def _collide(v, w, i, j, n, r, beta, q, mu):
    """The impulse that turns the contact velocity into -r times its normal part and -beta times
    the rest: along n the two particles resist with half a mass, across it with less, since they
    turn: 1/m + a^2/I each. A contact slides where that would take more than Coulomb's friction."""
    g = v[i] - v[j] - np.cross(w[i] + w[j], n)
    normal = np.sum(g * n, axis=1, keepdims=True) * n
    push, drag = -(1 + r) / 2 * normal, -(1 + beta) / (2 + 2 / q) * (g - normal)
    most, needed = (np.linalg.norm(part, axis=1, keepdims=True) for part in (push, drag))
    impulse = push + np.minimum(1.0, mu * most / np.maximum(needed, TINY)) * drag
    v[i] += impulse
    v[j] -= impulse
    # the contact point is at -n from the one and at +n from the other
    w[i] -= np.cross(n, impulse) / q
    w[j] -= np.cross(n, impulse) / q
