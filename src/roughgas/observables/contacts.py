"""Frequency of contacts, and the energy that they dissipate; also by pairs of species.

    nu = 2 (contacts)/(N t),    nu_kl = (contacts of k with l)/(N_k t), twice as many if k = l,

so that the sum of nu_kl over l is the contact frequency of a particle of species k. All contacts of
pairs count. In equilibrium nu_kl is theory.mixture_frequency.

Arrays (k, ...) are of the k instants of a FrameSeries.
"""

from collections.abc import Mapping

import numpy as np

from roughgas.data.variables import ENERGY, MIXTURE, RATE, Variable
from roughgas.effects.contacts import COUNTS
from roughgas.observables.averages import NamedArrays
from roughgas.observables.frames import FrameSeries
from roughgas.observables.plugin import PAIR, SUFFIX, Observable

FREQUENCY, LOSS = "contact_frequency", "contact_loss"


class Contacts(Observable):
    """How often a particle has a contact, and the energy that contacts take."""

    effects = ("contact_pairs",)
    variables: Mapping[str, Variable] = {
        FREQUENCY: Variable("contacts of a particle with others per time", RATE),
        LOSS: Variable("energy that a contact takes, on average", ENERGY),
        FREQUENCY + SUFFIX: Variable(
            "contacts of a particle of one species with those of another per time",
            RATE,
            PAIR,
            when=(MIXTURE,),
        ),
        LOSS + SUFFIX: Variable(
            "energy that a contact of two species takes, on average", ENERGY, PAIR, when=(MIXTURE,)
        ),
    }

    def observe_series(self, frames: FrameSeries) -> NamedArrays:
        """Return contacts and dissipated energy per T, (k, species, species) each.

        Each contact counts for both partners; so does its energy, in m a^2/T^2.
        """
        sums = 2.0 * frames.pair_rates(COUNTS)  # a contact has two partners
        contacts, losses = np.moveaxis(sums, -1, 0)
        return {"contacts": contacts, "losses": losses}

    def combine(self, means: NamedArrays) -> NamedArrays:
        """Return contact frequencies per particle, in 1/T, and energy losses per contact."""
        contacts, losses, system = means["contacts"], means["losses"], self.system
        results = {
            FREQUENCY: contacts.sum() / system.particles,
            LOSS: losses.sum() / contacts.sum(),
        }
        if system.species:
            numbers = np.array([[group.particles] for group in system.species])
            results |= {FREQUENCY + SUFFIX: contacts / numbers, LOSS + SUFFIX: losses / contacts}
        return results
