"""From points to results: reduced datasets, tables, costs, and a run packed for others.

A point is one combination of experiment, r (normal restitution), beta (roughness) and seed,
simulated. R = E_rot/(E_rot + E_trans) is the share of rotation in the energy.
"""
