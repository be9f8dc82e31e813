"""Contacts of pairs and with walls, by the collision rule of the paper in its plainest form."""

import math

import numpy as np

from brute_force.formulas import (
    cut_by_friction,
    in_three_dimensions,
    power_law_restitution,
    tabulated_restitution,
    viscoelastic_restitution,
)


class Contacts:
    """The methods of a simulation that carry out contacts."""

    def _restitution(self, r, speed, *particles):
        """Restitution of a contact at a normal speed, of material with coefficient r.

        Applies the law of the world (viscoelastic, tabulated or a power), then the threshold, then
        the contact-time model.
        """
        world = self.world
        if world.viscous and 0.0 < r < 1.0:
            r = viscoelastic_restitution(r, speed, world.viscous)
        if world.table:
            r = tabulated_restitution(r, speed, *world.table)
        if world.power:
            r = power_law_restitution(r, speed, *world.power)
        if world.threshold and speed < world.threshold[0]:
            r = max(r, world.threshold[1])
        last_contact = max(self.last_contacts[k] for k in particles)
        soon = world.contact_time > 0.0 and self.time - last_contact < world.contact_time
        for k in particles:
            self.last_contacts[k] = self.time
        return 1.0 if soon else r

    def _roughness(self, beta, speed):
        """Roughness of a contact at a normal speed: 1 - beta grows as a power of it, up to 2."""
        if self.world.roughness_power is None:
            return beta
        reference, exponent = self.world.roughness_power
        return 1.0 - min(2.0, (1.0 - beta) * (speed / reference) ** exponent)

    def _collide(self, i, j):
        """Carry out a contact of a pair: the collision rule of the paper, term by term."""
        world = self.world
        x, v = self.x[i] - self.x[j], self.v[i] - self.v[j]
        shifts, drifts = self.images()
        nearest = np.argmin(((x + shifts) ** 2).sum(axis=1))
        n, v = in_three_dimensions(x + shifts[nearest]), in_three_dimensions(v + drifts[nearest])
        n /= math.sqrt(n @ n)
        r, beta, mu = self.material(i, j)
        r = self._restitution(r, abs(v @ n), i, j)
        beta = self._roughness(beta, abs(v @ n))
        v_n = (v @ n) * n
        mass, moment = self.mass[[i, j]], (self.mass * self.q)[[i, j]]
        energies_before = self.energies[[i, j]]
        impulse = ((1.0 + r) * v_n - 2.0 * world.delta * n) / (1.0 / mass).sum()
        if world.q is not None:
            v_t, v_r = v - v_n, -np.cross(self.w[i] + self.w[j], n)
            self._add_contact_sums(v_t, v_r, mass, moment)
            tangential = (1.0 + beta) * (v_t + v_r) / (1.0 / mass + 1.0 / moment).sum()
            tangential = cut_by_friction(mu, impulse, tangential)
            impulse = impulse + tangential
            self.w[i] += np.cross(n, tangential) / moment[0]
            self.w[j] += np.cross(n, tangential) / moment[1]
        self.carried_momentum += np.outer(-impulse, self.radius[[i, j]].sum() * n)
        self.v[i] -= impulse[: self.dimension] / mass[0]
        self.v[j] += impulse[: self.dimension] / mass[1]
        gained = self.energies[[i, j]] - energies_before
        self.carried_energy += (gained[0] - gained[1]) / 2.0 * self.radius[[i, j]].sum() * n

    @property
    def energies(self):
        """Kinetic energy of each particle, (N,)."""
        spins = 0.0 if self.world.q is None else (self.w**2).sum(axis=1) * self.q
        return self.mass * ((self.v**2).sum(axis=1) + spins) / 2.0

    def _add_contact_sums(self, v_t, v_r, mass, moment):
        """Add v_t^2, v_r^2 and v_t.v_r of a contact to the running sums."""
        if self.world.mixture is not None:  # sqrt(m v^2) and sqrt(m q v^2) of the reduced masses
            v_t, v_r = (
                velocity * math.sqrt(2.0 / (1.0 / inertia).sum())
                for velocity, inertia in ((v_t, mass), (v_r, moment))
            )
        self.contact_sums += v_t @ v_t, v_r @ v_r, v_t @ v_r

    def material(self, i, j):
        """Restitution, roughness and mu of contacts of particles i and j."""
        world = self.world
        if world.mixture is None:
            return world.r, world.beta, world.mu
        common = {"restitution": world.r, "roughness": world.beta, "mu": world.mu}
        contact_material = world.mixture.between(self.species[i], self.species[j], common)
        return (
            contact_material["restitution"],
            contact_material["roughness"],
            contact_material.get("mu"),
        )

    def _bounce(self, i, axis, direction, velocity, r, beta):
        """Carry out a contact of particle i with a wall, a partner of infinite mass.

        Both prefactors of the collision rule double. The wall moves at a velocity (3,).
        """
        world, n = self.world, np.zeros(3)
        n[axis] = direction
        g = in_three_dimensions(self.v[i]) - velocity - np.cross(self.w[i], n)
        r = self._restitution(r, abs(g @ n), i)
        beta = self._roughness(beta, abs(g @ n))
        normal_velocity = (g @ n) * n
        mass = self.mass[i]
        impulse = mass * (1.0 + r) * normal_velocity
        if world.q is not None:
            q, mu = self.q[i], world.mu
            if world.mixture is not None:
                mu = world.mixture.species[self.species[i]].get("mu", mu)
            tangential = cut_by_friction(
                mu, impulse, mass * q * (1.0 + beta) / (1.0 + q) * (g - normal_velocity)
            )
            impulse = impulse + tangential
            self.w[i] += np.cross(n, tangential) / (mass * q)
        self.v[i] -= impulse[: self.dimension] / mass
