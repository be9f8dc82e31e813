"""A slow, independent computation of contacts of unlike particles, in three dimensions throughout:
disks move and meet in a plane, and spin about its normal."""

from typing import NamedTuple

import numpy as np


def directions(rng, size, dimension):
    """Return random unit vectors, (size, 3)."""
    n = np.zeros((size, 3))
    n[:, :dimension] = rng.standard_normal((size, dimension))
    return n / np.linalg.norm(n, axis=1, keepdims=True)


def maxwellian_velocities(rng, size, dimension, width):
    """Return Maxwellian velocities, (size, 3); `width`, (size,) or a number, is their deviation."""
    v = np.zeros((size, 3))
    v[:, :dimension] = rng.standard_normal((size, dimension))
    return v * np.reshape(width, (-1, 1))


def maxwellian_spins(rng, size, dimension, width):
    w = np.zeros((size, 3))
    w[:, 2 if dimension == 2 else slice(None)] = rng.standard_normal(
        size if dimension == 2 else (size, 3)
    )
    return w * np.reshape(width, (-1, 1))


def after_contact(n, first, second, r, beta, mu=np.inf):
    """Return (v, w) of both particles after a contact. `n` points from the second to the first.

    A particle is (v, w, mass, inertia I, radius). The impulse reverses the relative velocity at the
    contact, with r times its normal and beta times its tangential component; it follows from the
    compliance of both particles. The tangential impulse, along the slip, is at most mu times the
    normal one.
    """

    def velocity_at_contact(v, w, radius, sign):
        return v + np.cross(w, sign * radius[:, None] * n)

    def velocity_changes(impulse, mass, inertia, radius, sign):
        arm = sign * radius[:, None] * n
        return impulse / mass[:, None], np.cross(arm, impulse) / inertia[:, None]

    (v1, w1, m1, i1, a1), (v2, w2, m2, i2, a2) = first, second
    g = velocity_at_contact(v1, w1, a1, -1) - velocity_at_contact(v2, w2, a2, 1)
    speed = np.sum(g * n, axis=1, keepdims=True)
    slip = g - speed * n
    slip_direction = slip / np.maximum(np.linalg.norm(slip, axis=1, keepdims=True), 1e-300)

    def compliance(push):
        dv1, dw1 = velocity_changes(push, m1, i1, a1, -1)
        dv2, dw2 = velocity_changes(-push, m2, i2, a2, 1)
        return np.sum(
            (velocity_at_contact(dv1, dw1, a1, -1) - velocity_at_contact(dv2, dw2, a2, 1)) * push,
            axis=1,
        )

    normal = -(1 + r) * speed[:, 0] / compliance(n)
    tangential = -(1 + beta) * np.linalg.norm(slip, axis=1) / compliance(slip_direction)
    tangential = np.sign(tangential) * np.minimum(np.abs(tangential), mu * np.abs(normal))
    impulse = normal[:, None] * n + tangential[:, None] * slip_direction
    dv1, dw1 = velocity_changes(impulse, m1, i1, a1, -1)
    dv2, dw2 = velocity_changes(-impulse, m2, i2, a2, 1)
    return (v1 + dv1, w1 + dw1), (v2 + dv2, w2 + dw2)


def energies(v, w, mass, inertia):
    """Return the translational and the rotational energy of each particle."""
    return mass * np.sum(v**2, axis=1) / 2, inertia * np.sum(w**2, axis=1) / 2


class Pairs(NamedTuple):
    """Pairs of equal particles, m = a = 1, each (N, 3); `n` points from the second to the first."""

    v1: np.ndarray
    v2: np.ndarray
    w1: np.ndarray
    w2: np.ndarray
    n: np.ndarray

    def particles(self):
        return (self.v1, self.w1), (self.v2, self.w2)

    def approach(self):
        """Return the approach speed of each pair, the weight of its contact; 0 if it separates."""
        return np.maximum(0.0, -np.sum((self.v1 - self.v2) * self.n, axis=1))

    def after(self, r, beta, q, mu=np.inf):
        """Return the pairs after their contacts."""
        unit = np.ones(len(self.n))
        both = ((v, w, unit, q * unit, unit) for v, w in self.particles())
        (v1, w1), (v2, w2) = after_contact(self.n, *both, r, beta, mu)
        return self._replace(v1=v1, v2=v2, w1=w1, w2=w2)

    def energies(self, q):
        """Return the translational and the rotational energy of each pair, (2, N)."""
        return np.sum([energies(v, w, 1, q) for v, w in self.particles()], axis=0)


def maxwellian_pairs(rng, size, dimension, spin):
    """Return pairs of a gas with T_tr = 1 and mean square `spin` of spins along each axis."""
    v = [maxwellian_velocities(rng, size, dimension, 1.0) for _ in range(2)]
    w = [maxwellian_spins(rng, size, dimension, spin**0.5) for _ in range(2)]
    return Pairs(*v, *w, directions(rng, size, dimension))


def sigmas(samples, weights, expected):
    """Return the distance of the weighted mean from `expected`, in standard errors."""
    mean = np.average(samples, weights=weights)
    error = np.sqrt((weights**2 * (samples - mean) ** 2).sum()) / weights.sum()
    return abs(mean - expected) / max(error, 1e-12)


class Dsmc:
    """Direct simulation of a mixture: random pairs collide in proportion to their approach speed.

    `gas` is a `theory.Mixture`; only the properties of its particles are used.
    """

    def __init__(self, gas, number, seed, T_rot=0.0):
        self.rng, self.gas = np.random.default_rng(seed), gas
        counts = np.round(gas.fraction * number).astype(int)
        self.kind = np.repeat(np.arange(len(counts)), counts)
        self.mass, self.radius = gas.mass[self.kind], gas.radius[self.kind]
        self.inertia = gas.inertia[self.kind] * self.mass * self.radius**2
        size, D = len(self.kind), gas.dimension
        self.v = maxwellian_velocities(self.rng, size, D, 1 / np.sqrt(self.mass))
        self.w = maxwellian_spins(self.rng, size, D, np.sqrt(T_rot / self.inertia))

    def collide(self, per_particle):
        """Make about `per_particle` collisions per particle, and return their exact number.

        The translational energy is kept at 1."""
        done = 0.0
        while done < per_particle * len(self.kind):
            done += 2 * self._collide_random_pairs()
            self._rescale()
        return done / len(self.kind)

    def temperatures(self):
        """Return T_tr and T_rot of each species."""
        D, kinds = self.gas.dimension, np.arange(len(self.gas.mass))
        tr, rot = energies(self.v, self.w, self.mass, self.inertia)
        return [
            np.array([2 * e[self.kind == k].mean() / freedoms for k in kinds])
            for e, freedoms in ((tr, D), (rot, 2 * D - 3))
        ]

    def _collide_random_pairs(self):
        size, D = len(self.kind), self.gas.dimension
        order = self.rng.permutation(size)[: size // 2 * 2]
        i, j = order[::2], order[1::2]
        n = directions(self.rng, len(i), D)
        speed = np.sum((self.v[i] - self.v[j]) * n, axis=1)
        rate = np.abs(speed) * (self.radius[i] + self.radius[j]) ** (D - 1)
        hit = rate > self.rng.random(len(i)) * self._maximum_rate(i, j)
        i, j = i[hit], j[hit]
        columns = self.v, self.w, self.mass, self.inertia, self.radius
        first, second = ([column[k] for column in columns] for k in (i, j))
        tables = self.gas.restitution, self.gas.roughness, self.gas.friction
        rule = (table[self.kind[i], self.kind[j]] for table in tables)
        (self.v[i], self.w[i]), (self.v[j], self.w[j]) = after_contact(n[hit], first, second, *rule)
        return len(i)

    def _maximum_rate(self, i, j):
        fastest = np.sqrt((self.v**2).sum(axis=1).max())
        return 2 * fastest * (2 * self.radius.max()) ** (self.gas.dimension - 1)

    def _rescale(self):
        self.v -= (self.mass[:, None] * self.v).sum(axis=0) / self.mass.sum()
        tr = energies(self.v, self.w, self.mass, self.inertia)[0].mean()
        self.v, self.w = self.v / np.sqrt(tr), self.w / np.sqrt(tr)
