"""Means, standard errors, confidence intervals, steady states: of any series, without physics."""
