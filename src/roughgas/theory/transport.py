"""Transport coefficients of rough particles, in first Sonine approximation, and heat flux.

Collisions are those of Maxwellian gases that are slightly disturbed. With alpha = (1 + r)/2,
eta = q (1 + beta)/[2 (1 + q)] and nu collisions per particle per time:

Self-diffusion. A velocity is forgotten exponentially, as

    <v1 . dv1> = -[alpha <v_n^2> + eta <v_t^2>]/2,

and <v_n^2> = 4 T_tr/m, <v_t^2> = 2 (D - 1) T_tr/m in a Maxwellian gas: a collision takes the share
[(1 + r) + (D - 1) eta]/D of a particle's velocity, and (eta/q) (D - 1)/(2 D - 3) of its spin.

Viscosity. Where velocities are distributed as f_M (1 + A v_x v_y), collisions take v_x v_y away at
the rate nu_s, and those of a sheared gas carry momentum from centre to centre:

    viscosity = (1 + k) (1 + k') n T_tr/nu_s + [4 alpha/D + eta] n m a^2 nu/(D + 2),
    k = [2 alpha/D + eta] x/(D + 2),    x = nu a sqrt(pi m/T_tr),
    k' = [2 alpha (alpha - 1) + 2 eta (1 - eta) - eta^2 s^2 + (2 alpha - 1) (2 alpha + D eta)]
         x/[D (D + 2)],    s^2 = 2 T_rot/(q T_tr),

in a steady state that white noise drives. The collisional part has the mean spin of the flow, -1/2
of its shear rate.

Conductivity. With S = (m v^2/2 - (D + 2) T/2) v and S' = (m q a^2 w^2/2 - n_r T/2) v, M the rates
at which elastic collisions take S and S' away, and k, k' of what they carry from centre to centre,

    conductivity = (N + k) . M^-1 (N + k) n/m + b n a^2 nu,    N = (<S^2>, <S'^2>)/(D T^3).

Smooth elastic spheres: S. Chapman & T. G. Cowling, The Mathematical Theory of Non-uniform Gases
(1970), chapters 10 and 16; disks: D. M. Gass, J. Chem. Phys. 54, 1898 (1971). Perfectly rough
dilute spheres: F. B. Pidduck, Proc. R. Soc. A 101, 101 (1922), whose coefficient of diffusion is
(1 + q)/(1 + 2 q) times the smooth one's; Chapman & Cowling, chapter 11. Inelastic ones: J. J.
Brey, M. J. Ruiz-Montero, D. Cubero & R. Garcia-Rojo, Phys. Fluids 12, 876 (2000); rough ones: A.
Bodrova & N. Brilliantov, Granular Matter 14, 85 (2012); their viscosity: G. M. Kremer, A. Santos &
V. Garzo, Phys. Rev. E 90, 022205 (2014), whose nu_s is this one. These are of cooling spheres,
whose coefficients have terms of the cooling. Rough disks, driven particles, and what rough ones
carry from centre to centre, are derived anew; tests draw pairs that collide.

Heat flows through a gas at rest between two thermal walls. Where the mean free path is much longer
than the gap, particles fly from wall to wall. They leave a wall of temperature T with the velocity
component v across the gap distributed as v exp(-m v^2/(2 T)), so that a flight takes
gap sqrt(pi m/(2 T)) on average and carries the energy [(D + 1)/2 + n_r/2] T, n_r = 2 D - 3 where
they spin. Where it is much shorter, Fourier's law holds. Fluxes are in m/T^3 (times a^(3-D)):
energy per time and per length or area of a wall.
"""

import math

import numpy as np

from roughgas.theory.arguments import POSITIVE, check, check_dimension, material, quotient
from roughgas.theory.closed_forms import collision_frequency, contact_value, number_density


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


def shear_viscosity(
    T_tr, T_rot, packing, r=1.0, beta=-1.0, dimension=2, inertia=None
) -> np.ndarray:
    """Return the shear viscosity in m a^(2-D)/T, at the present temperatures (m a^2/T^2).

    In a gas in a steady state, whose drive is uncorrelated in time. T_rot of smooth particles makes
    no difference.
    """
    gas = material(r, beta, dimension, inertia)
    T_tr, T_rot = check("temperature T_tr", T_tr), check("temperature T_rot", T_rot)
    D, alpha, eta = gas.dimension, (1 + gas.r) / 2, gas.eta
    spin = 2 * quotient(T_rot, gas.inertia * T_tr) * eta**2
    lost = _shear_lost(D, alpha, eta, spin)
    per_density, n = _frequency(packing, D), number_density(packing, D)
    x = np.sqrt(np.pi) * per_density * n
    carried = (2 * alpha / D + eta) * x / (D + 2)
    gained = 2 * alpha * (alpha - 1) + 2 * eta * (1 - eta) - spin
    gained = (gained + (2 * alpha - 1) * (2 * alpha + D * eta)) * x / (D * (D + 2))
    kinetic = (1 + carried) * (1 + gained) / (lost * per_density)
    return np.sqrt(T_tr) * (kinetic + (4 * alpha / D + eta) * n**2 * per_density / (D + 2))


def _shear_lost(D, alpha, eta, spin):
    """Return nu_s/nu; `spin` is eta^2 times the variance of a component of a (w1 + w2), over T_tr.

    With the impulse J and the relative velocity g of a pair, T_tr = 1, a collision changes the
    traceless part of g g by 2 J J - g J - J g.
    """
    d = D - 1
    gJ = 8 * (D + 3) * alpha + 4 * d * (D + 3) * eta  # <g^2 (g.J)>
    square = 32 * alpha**2 + 16 * d * alpha * eta + 4 * d * (D + 1) * eta**2 + 2 * d * spin
    J2 = 8 * (D + 3) * alpha**2 + 4 * d * (D + 3) * eta**2 + d * (2 * D + 2) * spin  # <g^2 J^2>
    return (d * gJ / D - square + J2 / D) / (2 * d * (D + 2))


def thermal_conductivity(T, dimension=2, packing=0.0, inertia=None) -> np.ndarray:
    """Return the conductivity of elastic disks or spheres in equilibrium, in a^(2-D)/T.

    `inertia` is q of perfectly rough ones; None stands for smooth ones.
    """
    T, D = check("temperature T", T), check_dimension(dimension)
    per_density, n = _frequency(packing, D), number_density(packing, D)
    x = np.sqrt(np.pi) * per_density * n
    if inertia is None:
        kinetic = D * (D + 2) ** 2 / (8 * (D - 1)) * (1 + 3 * x / (D * (D + 2))) ** 2
        bulk = 2 / D
    else:
        kinetic, bulk = _of_rough(D, check("inertia q", inertia), x), {2: 3 / 2, 3: 4 / 3}[D]
    return np.sqrt(T) * (kinetic / per_density + bulk * n**2 * per_density)


def _of_rough(D, q, x):
    """Return (N + k) . M^-1 (N + k) nu of perfectly rough elastic particles, T = 1."""
    if D == 2:
        first = 2 + x * (q + 3 / 4) / (q + 1)
        second = 1 / 2 + x / (4 * (q + 1))
        aa, ab, bb = (7 * q + 2) / 2, -q, (3 * q**2 + 2 * q + 1) / 4
    else:
        first = 5 / 2 + x * (5 * q + 3) / (6 * (q + 1))
        second = 3 / 2 + x / (3 * (q + 1))
        aa, ab, bb = (17 * q + 4) / 3, -5 * q / 3, 2 * q**2 + 2 * q + 1
    square = bb * first**2 - 2 * ab * first * second + aa * second**2
    return (1 + q) ** 2 * square / (aa * bb - ab**2)


def _frequency(packing, dimension):
    """Return nu/n at T_tr = 1, which is finite at packing 0."""
    per_speed = {2: 4, 3: 16}[dimension] * math.sqrt(math.pi)
    return per_speed * contact_value(packing, dimension)


def free_molecular_flux(hot, cold, particles, gap, dimension=2, spins=False) -> np.ndarray:
    """Return the flux from the wall at temperature `hot` to the one at `cold`, without collisions.

    `particles` is their number per length (2D) or area (3D) of a wall, in a^(1-D); `gap` the room
    that their centres have between the walls, in a. `spins`: they have spins that walls change.
    """
    hot, cold = check("temperature hot", hot, POSITIVE), check("temperature cold", cold, POSITIVE)
    dimension, gap = check_dimension(dimension), check("gap", gap, POSITIVE)
    carried = (dimension + 1 + (2 * dimension - 3 if spins else 0)) / 2 * (hot - cold)
    round_trip = gap * math.sqrt(math.pi / 2) * (1 / np.sqrt(hot) + 1 / np.sqrt(cold))
    return check("particles", particles) * carried / round_trip


def fourier_flux(hot, cold, gap, dimension=2) -> np.ndarray:
    """Return the flux by Fourier's law between walls with a gap of many mean free paths, in a.

    As kappa goes as T^(1/2), it is the difference of 2/3 kappa T at the walls, over the gap.
    """
    hot, cold = check("temperature hot", hot), check("temperature cold", cold)
    one, other = (thermal_conductivity(T, dimension) * T for T in (hot, cold))
    return 2 / 3 * (one - other) / check("gap", gap, POSITIVE)


def heat_flux(hot, cold, particles, gap, dimension=2) -> np.ndarray:
    """Return the flux of smooth elastic particles for any gap, between the limits above.

    1/q = 1/q_free + 1/q_Fourier: F. S. Sherman, in Rarefied Gas Dynamics (1963), vol. 2, p. 228;
    within some per cent of measurements.
    """
    free = free_molecular_flux(hot, cold, particles, gap, dimension)
    fourier = fourier_flux(hot, cold, gap, dimension)
    return free * fourier / (free + fourier)
