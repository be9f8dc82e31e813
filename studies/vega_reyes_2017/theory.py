"""Temperatures of the species of a cooling mixture, from its rate equations."""

from roughgas.judging import species_temperature_ratio as T_ratio_species

__all__ = ["T_ratio_species"]
