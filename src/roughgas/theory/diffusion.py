"""Self-diffusion of rough particles, in first Sonine approximation.

A velocity is forgotten exponentially. With eta = q (1 + beta)/[2 (1 + q)],

    <v1 . dv1> = -[(1 + r)/2 <v_n^2> + eta <v_t^2>]/2,

and <v_n^2> = 4 T_tr/m, <v_t^2> = 2 (D - 1) T_tr/m in a Maxwellian gas: a collision takes the share
[(1 + r) + (D - 1) eta]/D of a particle's velocity, and (eta/q) (D - 1)/(2 D - 3) of its spin.

Smooth elastic spheres: S. Chapman & T. G. Cowling, The Mathematical Theory of Non-uniform Gases
(1970); perfectly rough ones, whose coefficient is (1 + q)/(1 + 2 q) times theirs: F. B. Pidduck,
Proc. R. Soc. A 101, 101 (1922); inelastic ones: J. J. Brey, M. J. Ruiz-Montero, D. Cubero & R.
Garcia-Rojo, Phys. Fluids 12, 876 (2000); rough ones: A. Bodrova & N. Brilliantov, Granular Matter
14, 85 (2012).
"""

import numpy as np

from roughgas.theory.arguments import check, material, quotient
from roughgas.theory.closed_forms import collision_frequency


def self_diffusion(T_tr, packing, r=1.0, beta=-1.0, dimension=2, inertia=None) -> np.ndarray:
    """Return D_s in a^2/T, of <(x - x0)^2> = 2 D_s t, at the present T_tr (m a^2/T^2).

    In a gas in a steady state, whose drive is uncorrelated in time; infinite at packing 0.
    """
    gas = material(r, beta, dimension, inertia)
    nu = collision_frequency(T_tr, packing, dimension)
    lost = ((1 + gas.r) + (gas.dimension - 1) * gas.eta) / gas.dimension
    return quotient(check("temperature T_tr", T_tr), nu * lost)


def rotational_diffusion(T_tr, T_rot, packing, beta, dimension=2, inertia=None) -> np.ndarray:
    """Return D_r in 1/T, of the angle through which a particle turns: <(phi - phi0)^2> = 2 D_r t.

    For spheres, of the time integral of a component of the spin. Infinite at beta = -1.
    """
    gas = material(1.0, beta, dimension, inertia)
    nu = collision_frequency(T_tr, packing, dimension)
    lost = gas.eta / gas.inertia * (gas.dimension - 1) / (2 * gas.dimension - 3)
    return quotient(check("temperature T_rot", T_rot) / gas.inertia, nu * lost)
