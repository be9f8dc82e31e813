"""What each particle is, where they differ, and what their contacts are made of."""

from typing import NamedTuple

import numpy as np

QUANTITIES = ("restitution", "roughness", "mu")


class Company(NamedTuple):
    """The particles, in the order of the start."""

    radius: np.ndarray  # (N,)
    mass: np.ndarray  # (N,)
    q: np.ndarray  # (N,); anything where particles do not spin
    species: np.ndarray  # (N,) numbers


class Contents(NamedTuple):
    """The species as an experiment lists them, and their special pairs."""

    species: list
    pairs: list

    def between(self, k, other, common):
        """Restitution, roughness and mu of contacts of two species, by name; `common` are those of
        particles that have none of their own."""
        names = [one.get("name") for one in self.species]
        own = [common | self.species[number] for number in (k, other)]
        found = {
            name: (own[0][name] + own[1][name]) / 2.0
            for name in QUANTITIES
            if common[name] is not None
        }
        for pair in self.pairs:
            numbers = [names.index(x) if isinstance(x, str) else x for x in pair["between"]]
            if sorted(numbers) == sorted((k, other)):
                found |= {name: pair[name] for name in QUANTITIES if name in pair}
        return found


def alike(number, q):
    """Particles that do not differ."""
    ones = np.ones(number)
    return Company(ones, ones, ones * (q or 1.0), np.zeros(number, int))


def company_of(state, order):
    """The particles of a kernel's state, in this order; None where it takes them for alike."""
    if state.bodies is None:
        return None
    parts = (state.bodies.radius, state.bodies.mass, state.bodies.inertia, state.bodies.species)
    return Company(*(part[order].copy() for part in parts))
