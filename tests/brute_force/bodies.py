"""Bodies of particles that differ in size, mass or material, and the material of their contacts."""

from typing import NamedTuple

import numpy as np

QUANTITIES = ("restitution", "roughness", "mu")


class Bodies(NamedTuple):
    """Properties of the particles, in the order of the start."""

    radius: np.ndarray  # (N,)
    mass: np.ndarray  # (N,)
    q: np.ndarray  # (N,): moment of inertia over m a^2; unused where particles do not spin
    species: np.ndarray  # (N,): index of the species


class Mixture(NamedTuple):
    """The species of an experiment, and the pairs of species whose material it states."""

    species: list
    pairs: list

    def between(self, first, second, common):
        """Restitution, roughness and mu of contacts of two species, as a dictionary.

        `common` has the values of species that state none.
        """
        species_names = [kind.get("name") for kind in self.species]
        materials = [common | self.species[index] for index in (first, second)]
        material = {
            name: (materials[0][name] + materials[1][name]) / 2.0
            for name in QUANTITIES
            if common[name] is not None
        }
        for pair in self.pairs:
            indices = [
                species_names.index(name_or_index)
                if isinstance(name_or_index, str)
                else name_or_index
                for name_or_index in pair["between"]
            ]
            if sorted(indices) == sorted((first, second)):
                material |= {name: pair[name] for name in QUANTITIES if name in pair}
        return material


def identical_bodies(number, q):
    """Bodies of radius and mass 1, all of one species."""
    unit_values = np.ones(number)
    return Bodies(unit_values, unit_values, unit_values * (q or 1.0), np.zeros(number, int))


def bodies_of(state, order):
    """The Bodies of a kernel's state, in this order; None if its particles are identical."""
    if state.bodies is None:
        return None
    properties = (
        state.bodies.radius,
        state.bodies.mass,
        state.bodies.inertia,
        state.bodies.species,
    )
    return Bodies(*(values[order].copy() for values in properties))
