"""What contacts do, by the paper's collision rule and as one would write it first."""

import math

import numpy as np

from brute_force.formulas import cut_by_friction, falling, in_space, tabulated, viscoelastic


class Contacts:
    """The part of a simulation that carries contacts out."""

    def _restitution(self, r, speed, *particles):
        """Of a contact at a normal speed, from the restitution that its material has by itself."""
        world = self.world
        if world.viscous and 0.0 < r < 1.0:
            r = viscoelastic(r, speed, world.viscous)
        if world.table:
            r = tabulated(r, speed, *world.table)
        if world.power:
            r = falling(r, speed, *world.power)
        if world.threshold and speed < world.threshold[0]:
            r = max(r, world.threshold[1])
        recent = max(self.last[k] for k in particles)
        quick = world.contact_time > 0.0 and self.time - recent < world.contact_time
        for k in particles:
            self.last[k] = self.time
        return 1.0 if quick else r

    def _collide(self, i, j):
        """the collision rule of the paper, term by term."""
        world = self.world
        x, v = self.x[i] - self.x[j], self.v[i] - self.v[j]
        shifts, drifts = self.images()
        nearest = np.argmin(((x + shifts) ** 2).sum(axis=1))
        n, v = in_space(x + shifts[nearest]), in_space(v + drifts[nearest])
        n /= math.sqrt(n @ n)
        r, beta, mu = self.material(i, j)
        r = self._restitution(r, abs(v @ n), i, j)
        v_n = (v @ n) * n
        m, s = self.mass[[i, j]], (self.mass * self.q)[[i, j]]
        before = self.energies[[i, j]]
        push = (1.0 + r) * v_n / (1.0 / m).sum()
        if world.q is not None:
            v_t, v_r = v - v_n, -np.cross(self.w[i] + self.w[j], n)
            self._see(v_t, v_r, m, s)
            along = (1.0 + beta) * (v_t + v_r) / (1.0 / m + 1.0 / s).sum()
            along = cut_by_friction(mu, push, along)
            push = push + along
            self.w[i] += np.cross(n, along) / s[0]
            self.w[j] += np.cross(n, along) / s[1]
        self.carried += np.outer(-push, self.radius[[i, j]].sum() * n)
        self.v[i] -= push[: self.dimension] / m[0]
        self.v[j] += push[: self.dimension] / m[1]
        gained = self.energies[[i, j]] - before
        self.heat += (gained[0] - gained[1]) / 2.0 * self.radius[[i, j]].sum() * n

    @property
    def energies(self):
        """Energy of each particle."""
        spins = 0.0 if self.world.q is None else (self.w**2).sum(axis=1) * self.q
        return self.mass * ((self.v**2).sum(axis=1) + spins) / 2.0

    def _see(self, v_t, v_r, m, s):
        if self.world.contents is not None:  # sqrt(m v^2) and sqrt(m q v^2) instead, for m of both
            v_t, v_r = (x * math.sqrt(2.0 / (1.0 / y).sum()) for x, y in ((v_t, m), (v_r, s)))
        self.seen += v_t @ v_t, v_r @ v_r, v_t @ v_r

    def material(self, i, j):
        """Restitution, roughness and mu of two particles."""
        world = self.world
        if world.contents is None:
            return world.r, world.beta, world.mu
        common = {"restitution": world.r, "roughness": world.beta, "mu": world.mu}
        found = world.contents.between(self.species[i], self.species[j], common)
        return found["restitution"], found["roughness"], found.get("mu")

    def _bounce(self, i, axis, direction, velocity, r, beta):
        """As with a partner of infinite mass: both prefactors of the collision rule double.

        The partner moves at a velocity, in space.
        """
        world, n = self.world, np.zeros(3)
        n[axis] = direction
        g = in_space(self.v[i]) - velocity - np.cross(self.w[i], n)
        r = self._restitution(r, abs(g @ n), i)
        g_n = (g @ n) * n
        m = self.mass[i]
        push = m * (1.0 + r) * g_n
        if world.q is not None:
            q, mu = self.q[i], world.mu
            if world.contents is not None:
                mu = world.contents.species[self.species[i]].get("mu", mu)
            along = cut_by_friction(mu, push, m * q * (1.0 + beta) / (1.0 + q) * (g - g_n))
            push = push + along
            self.w[i] += np.cross(n, along) / (m * q)
        self.v[i] -= push[: self.dimension] / m
