"""Simulations: one point of an experiment, run and measured from its settings to its numbers.

A point is one combination of an experiment, r, beta and a seed. Symbols in these modules: particle
radius a, mass m, time unit T; N particles in D dimensions; normal restitution r, roughness beta,
moment of inertia q = I/(m a^2), friction mu; angular velocity w, and spin a w (a surface velocity).
Energies are per degree of freedom, in m a^2/T^2: E_trans (also E_tr) of translation, E_rot of
rotation, R = E_rot/(E_rot + E_trans), and temperatures T_tr = 2 E_trans, T_rot = 2 E_rot. The
kernel's unit of velocity is 2^exponent a/T, and its unit of time T/2^exponent, so that the numbers
of a cooling gas stay near 1.
"""
