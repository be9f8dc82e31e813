"""Contacts: how often particles touch, and the energy that it takes; of pairs of species, too.

    nu = 2 (contacts)/(N t),    nu_kl = (contacts of k with l)/(N_k t), twice those if k = l,

so that the sum of nu_kl over l is how often a particle of species k has a contact. All contacts of
pairs count. In equilibrium nu_kl is theory.mixture_frequency.
"""

from collections.abc import Mapping

import numpy as np

from roughgas.data.variables import ENERGY, MIXTURE, RATE, Variable
from roughgas.effects.contacts import COUNTS
from roughgas.observables.plugin import PAIR, SUFFIX, Frame, Observable, Values

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

    def look(self, frame: Frame) -> Values:
        """Return the contacts, and the energy that they take, per T: (species, species) each."""
        contacts, losses = np.moveaxis(2.0 * frame.of_pairs(COUNTS), -1, 0)  # each has two partners
        return {"contacts": contacts, "losses": losses}

    def combine(self, means: Values) -> Values:
        """Return frequencies and losses."""
        contacts, losses, system = means["contacts"], means["losses"], self.system
        found = {
            FREQUENCY: contacts.sum() / system.particles,
            LOSS: losses.sum() / contacts.sum(),
        }
        if system.species:
            numbers = np.array([[one.particles] for one in system.species])
            found |= {FREQUENCY + SUFFIX: contacts / numbers, LOSS + SUFFIX: losses / contacts}
        return found
