"""Means, standard errors, intervals, steady states, and fits of any series, without physics."""
