"""Datasets: what files hold, how they are written and read.

Units are the particle radius a, the particle mass m and the time unit T. R = E_rot/(E_rot +
E_trans) is the share of rotation in the energy, r the normal restitution, beta the roughness. A
point is one combination of experiment, r, beta and seed, simulated; a reduced dataset combines all
points of an experiment.
"""
