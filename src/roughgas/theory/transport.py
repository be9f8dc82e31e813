"""Transport coefficients of rough particles, in first Sonine approximation, and heat flux.

Gases are assumed to be slightly disturbed Maxwellian gases. With alpha = (1 + r)/2,
eta = q (1 + beta)/[2 (1 + q)] and nu collisions per particle per time:

Self-diffusion. The autocorrelation of a velocity decays exponentially, as

    <v1 . dv1> = -[alpha <v_n^2> + eta <v_t^2>]/2,

and <v_n^2> = 4 T_tr/m, <v_t^2> = 2 (D - 1) T_tr/m in a Maxwellian gas: a collision takes the share
[(1 + r) + (D - 1) eta]/D of a particle's velocity, and (eta/q) (D - 1)/(2 D - 3) of its spin.

Viscosity. If velocities are distributed as f_M (1 + A v_x v_y), v_x v_y relaxes by collisions at
the rate nu_s; in a sheared gas collisions carry momentum from centre to centre:

    viscosity = (1 + k) (1 + k') n T_tr/nu_s + [4 alpha/D + eta] n m a^2 nu/(D + 2),
    k = [2 alpha/D + eta] x/(D + 2),    x = nu a sqrt(pi m/T_tr),
    k' = [2 alpha (alpha - 1) + 2 eta (1 - eta) - eta^2 s^2 + (2 alpha - 1) (2 alpha + D eta)]
         x/[D (D + 2)],    s^2 = 2 T_rot/(q T_tr),

in a steady state that white noise drives. The collisional contribution assumes the mean spin of the
flow, -1/2 of its shear rate.

Conductivity. With S = (m v^2/2 - (D + 2) T/2) v and S' = (m q a^2 w^2/2 - n_r T/2) v, M the matrix
of relaxation rates of S and S' by elastic collisions, and k, k' for the transport from centre to
centre,

    conductivity = (N + k) . M^-1 (N + k) n/m + b n a^2 nu,    N = (<S^2>, <S'^2>)/(D T^3).

These leave out correlations of spins with velocities in rough gases, which are polynomials of the
same or a lower degree. Spins of spheres align with the stress (a term w w of the distribution) and
in a flow of heat (w (v.w) - w^2 v/3). Particles are turned aside by their spins (v x w, and v v x
w): terms that are odd in w couple to the others since the reversal of all spins is no symmetry of
collisions. `spin_corrections` has their effect. For Maxwell particles, A. Santos & G. M. Kremer
(arXiv:2311.15440) have couplings of this kind; D. W. Condiff, W.-K. Lu & J. S. Dahler, J. Chem.
Phys. 42, 3445 (1965), treat rough spheres, whose numbers were not available for a comparison.

Smooth elastic spheres: S. Chapman & T. G. Cowling, The Mathematical Theory of Non-uniform Gases
(1970), chapters 10 and 16; disks: D. M. Gass, J. Chem. Phys. 54, 1898 (1971). Perfectly rough
dilute spheres: F. B. Pidduck, Proc. R. Soc. A 101, 101 (1922), whose coefficient of diffusion is
(1 + q)/(1 + 2 q) times the smooth one's; Chapman & Cowling, chapter 11. Inelastic ones: J. J.
Brey, M. J. Ruiz-Montero, D. Cubero & R. Garcia-Rojo, Phys. Fluids 12, 876 (2000); rough ones: A.
Bodrova & N. Brilliantov, Granular Matter 14, 85 (2012); their viscosity: G. M. Kremer, A. Santos &
V. Garzo, Phys. Rev. E 90, 022205 (2014), with the same nu_s. These papers have cooling spheres,
whose coefficients have terms due to the cooling. The results for rough disks, for driven particles,
and for the transport from centre to centre by rough particles were derived for this package; tests
compare them with averages over random colliding pairs.

Heat flows through a gas at rest between two thermal walls. If the mean free path is much longer
than the gap, particles fly from wall to wall. They leave a wall of temperature T with the velocity
component v across the gap distributed as v exp(-m v^2/(2 T)), so that a flight takes
gap sqrt(pi m/(2 T)) on average and carries the energy [(D + 1)/2 + n_r/2] T, n_r = 2 D - 3 if they
spin, else 0. If it is much shorter, Fourier's law holds. Fluxes are in m/T^3 (times a^(3-D)):
energy per time and per length or area of a wall.

r is the normal restitution, beta the roughness, `inertia` q = I/(m a^2), and `packing` the
fraction phi of the area or volume that particles fill.
"""

import math

import numpy as np

from roughgas.theory.arguments import POSITIVE, check, check_dimension, material, quotient
from roughgas.theory.closed_forms import collision_frequency, contact_value, number_density


def self_diffusion(T_tr, packing, r=1.0, beta=-1.0, dimension=2, inertia=None) -> np.ndarray:
    """Return the coefficient of self-diffusion D_s in a^2/T, <(x - x0)^2> = 2 D_s t.

    x is a coordinate of a particle. The gas has the temperature `T_tr` (m a^2/T^2) and the packing
    fraction `packing`, and is in a steady state, whose drive is uncorrelated in time; infinite at
    packing 0.
    """
    gas = material(r, beta, dimension, inertia)
    nu = collision_frequency(T_tr, packing, dimension)
    velocity_loss = ((1 + gas.r) + (gas.dimension - 1) * gas.eta) / gas.dimension
    return quotient(check("temperature T_tr", T_tr), nu * velocity_loss)


def rotational_diffusion(T_tr, T_rot, packing, beta, dimension=2, inertia=None) -> np.ndarray:
    """Return the rotational diffusion coefficient D_r in 1/T, <(phi - phi0)^2> = 2 D_r t.

    phi is the angle of a disk; for spheres the time integral of a component of the spin. `T_tr` and
    `T_rot` are in m a^2/T^2, `packing` is the packing fraction. Infinite at beta = -1.
    """
    gas = material(1.0, beta, dimension, inertia)
    nu = collision_frequency(T_tr, packing, dimension)
    spin_loss = gas.eta / gas.inertia * (gas.dimension - 1) / (2 * gas.dimension - 3)
    return quotient(check("temperature T_rot", T_rot) / gas.inertia, nu * spin_loss)


def shear_viscosity(
    T_tr, T_rot, packing, r=1.0, beta=-1.0, dimension=2, inertia=None
) -> np.ndarray:
    """Return the shear viscosity in m a^(2-D)/T, at the temperatures T_tr and T_rot (m a^2/T^2).

    For a gas of the packing fraction `packing` in a steady state, whose drive is uncorrelated in
    time. T_rot of smooth particles has no effect.
    """
    gas = material(r, beta, dimension, inertia)
    T_tr, T_rot = check("temperature T_tr", T_tr), check("temperature T_rot", T_rot)
    D, alpha, eta = gas.dimension, (1 + gas.r) / 2, gas.eta
    spin = 2 * quotient(T_rot, gas.inertia * T_tr) * eta**2
    relaxation = _shear_relaxation(D, alpha, eta, spin)
    per_density, n = _frequency_per_density(packing, D), number_density(packing, D)
    x = np.sqrt(np.pi) * per_density * n
    collisional_stress = (2 * alpha / D + eta) * x / (D + 2)
    collisional_transfer = 2 * alpha * (alpha - 1) + 2 * eta * (1 - eta) - spin
    collisional_transfer = (
        (collisional_transfer + (2 * alpha - 1) * (2 * alpha + D * eta)) * x / (D * (D + 2))
    )
    kinetic = (1 + collisional_stress) * (1 + collisional_transfer) / (relaxation * per_density)
    return np.sqrt(T_tr) * (kinetic + (4 * alpha / D + eta) * n**2 * per_density / (D + 2))


def _shear_relaxation(D, alpha, eta, spin):
    """Return nu_s/nu, the relaxation rate of the kinetic stress over the collision frequency.

    D is the number of dimensions, `alpha` (1 + r)/2, `eta` q (1 + beta)/[2 (1 + q)]; `spin` is
    eta^2 times the variance of a component of a (w1 + w2), over T_tr. With the impulse J and the
    relative velocity g of a pair, T_tr = 1, a collision changes the traceless g g by the traceless
    2 J J - g J - J g.
    """
    d = D - 1
    gJ = 8 * (D + 3) * alpha + 4 * d * (D + 3) * eta  # <g^2 (g.J)>
    square = 32 * alpha**2 + 16 * d * alpha * eta + 4 * d * (D + 1) * eta**2 + 2 * d * spin
    J2 = 8 * (D + 3) * alpha**2 + 4 * d * (D + 3) * eta**2 + d * (2 * D + 2) * spin  # <g^2 J^2>
    return (d * gJ / D - square + J2 / D) / (2 * d * (D + 2))


def thermal_conductivity(T, dimension=2, packing=0.0, inertia=None) -> np.ndarray:
    """Return the thermal conductivity of elastic disks or spheres in equilibrium, in a^(2-D)/T.

    `T` is the temperature in m a^2/T^2, `packing` the packing fraction. `inertia` is q of perfectly
    rough particles; None stands for smooth ones.
    """
    T, D = check("temperature T", T), check_dimension(dimension)
    per_density, n = _frequency_per_density(packing, D), number_density(packing, D)
    x = np.sqrt(np.pi) * per_density * n
    if inertia is None:
        kinetic = D * (D + 2) ** 2 / (8 * (D - 1)) * (1 + 3 * x / (D * (D + 2))) ** 2
        bulk = 2 / D
    else:
        kinetic, bulk = (
            _rough_conductivity(D, check("inertia q", inertia), x),
            {2: 3 / 2, 3: 4 / 3}[D],
        )
    return np.sqrt(T) * (kinetic / per_density + bulk * n**2 * per_density)


def _rough_conductivity(D, q, x):
    """Return (N + k) . M^-1 (N + k) nu (module) of perfectly rough elastic particles at T = 1.

    D is the number of dimensions, `q` I/(m a^2), and `x` nu a sqrt(pi m/T).
    """
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


def spin_corrections(inertia, dimension=3) -> tuple[np.ndarray, np.ndarray]:
    """Compute the factors by which spins change viscosity and conductivity beyond Pidduck's terms.

    The coefficients of dilute, perfectly rough, elastic particles of `inertia` q with all terms of
    the third degree in v and w, at most, over `shear_viscosity` and `thermal_conductivity`
    (module). Derived for this package; tests compare the matrices with averages over random
    colliding pairs. Raises InputError.
    """
    q, terms = check("inertia q", inertia), {2: _terms_of_disks, 3: _terms_of_spheres}
    viscosity, conductivity = (
        _response(rates, source, twist) / _response(isotropic, source[: len(isotropic)])
        for rates, isotropic, source, twist in terms[check_dimension(dimension)](q)
    )
    return viscosity, conductivity


def _terms_of_spheres(q):
    """Yield matrix, matrix without aligned spins, source and twist for viscosity, conductivity.

    The matrices have (1 + q)^2 times the relaxation rates of v v and w w, and of S, S' and
    w (v.w) - w^2 v/3, by rows. The twist is the coupling to v (v x w), and to v x w.
    """
    stress = ((8 + 52 * q / 3, 20 * q / 3), (20 * q / 3, 4 + 40 * q / 3))
    norm = np.sqrt(np.pi * q * (1 + q) / (20 + 76 * q + 92 * q**2 + 20 * q**3))
    yield stress, ((stress[0][0],),), (1, 0), (norm * (1 - 5 * q), norm * 2)
    heat = (
        (4 + 17 * q, -5 * q, 10 * q / 3),
        (-5 * q, 3 + 6 * q + 6 * q**2, 2 + 4 * q),
        (10 * q / 3, 2 + 4 * q, 11 + 23 * q + 40 * q**2 / 3),
    )
    norm = np.sqrt(np.pi * q / 8)
    isotropic = heat[0][:2], heat[1][:2]
    yield heat, isotropic, (5, 3, 0), (0 * q, norm, -5 / 3 * norm)


def _terms_of_disks(q):
    """Yield matrix (twice, as spins of disks cannot align), source and twist as for spheres.

    The twist is the coupling to v (v x w) and to v x w, w being normal to the plane.
    """
    stress = ((4 + 6 * q,),)
    norm = np.sqrt(np.pi * q * (1 + q) / (31 / 4 + 53 * q / 2 + 123 * q**2 / 4 + 6 * q**3))
    yield stress, stress, (1,), (norm * 2 * q,)
    heat = ((2 + 7 * q, -2 * q), (-2 * q, (1 + 2 * q + 3 * q**2) / 2))
    norm = np.sqrt(np.pi * q * (1 + q) / (4 + 3 * q))
    yield heat, heat, (4, 1), (0 * q, -norm / 2)


def _response(rates, source, twist=None):
    """Return N . (M + t t)^-1 N for a matrix M of `rates`, N = `source` and t = `twist`.

    Entries are arrays of the shape of q. Terms that are odd in the spins couple to even ones with
    opposite signs in both directions, so that their elimination adds t t.
    """
    twist = twist or [np.zeros(())] * len(source)
    t = np.stack(np.broadcast_arrays(*twist), axis=-1)
    rows = [np.stack(np.broadcast_arrays(*row), axis=-1) for row in rates]
    M = np.stack(np.broadcast_arrays(*rows), axis=-2) + t[..., :, None] * t[..., None, :]
    N = np.broadcast_to(np.array(source, float)[:, None], (*M.shape[:-1], 1))
    return (np.swapaxes(N, -1, -2) @ np.linalg.solve(M, N))[..., 0, 0]


def _frequency_per_density(packing, dimension):
    """Return nu/n at T_tr = 1, collision frequency over density; finite at packing 0."""
    per_speed = {2: 4, 3: 16}[dimension] * math.sqrt(math.pi)
    return per_speed * contact_value(packing, dimension)


def free_molecular_flux(hot, cold, particles, gap, dimension=2, spins=False) -> np.ndarray:
    """Return the heat flux between two thermal walls without collisions, in m/T^3 (times a^(3-D)).

    `hot` and `cold` are the temperatures of the walls, in m a^2/T^2. `particles` is their number
    per length (2D) or area (3D) of a wall, in a^(1-D); `gap` the distance between the walls that is
    available to centres, in particle radii a. `spins`: whether particles have spins that walls
    change.
    """
    hot, cold = check("temperature hot", hot, POSITIVE), check("temperature cold", cold, POSITIVE)
    dimension, gap = check_dimension(dimension), check("gap", gap, POSITIVE)
    carried = (dimension + 1 + (2 * dimension - 3 if spins else 0)) / 2 * (hot - cold)
    round_trip = gap * math.sqrt(math.pi / 2) * (1 / np.sqrt(hot) + 1 / np.sqrt(cold))
    return check("particles", particles) * carried / round_trip


def fourier_flux(hot, cold, gap, dimension=2) -> np.ndarray:
    """Return the heat flux by Fourier's law between two thermal walls, in m/T^3 (times a^(3-D)).

    `hot` and `cold` are the temperatures of the walls, in m a^2/T^2; their distance `gap`, in
    particle radii a, is many mean free paths of a dilute smooth gas. As kappa is proportional to
    T^(1/2), the flux is the difference of 2/3 kappa T at the walls, over the gap.
    """
    hot, cold = check("temperature hot", hot), check("temperature cold", cold)
    hot_integral, cold_integral = (thermal_conductivity(T, dimension) * T for T in (hot, cold))
    return 2 / 3 * (hot_integral - cold_integral) / check("gap", gap, POSITIVE)


def heat_flux(hot, cold, particles, gap, dimension=2) -> np.ndarray:
    """Return the heat flux of smooth elastic particles for any gap, in m/T^3 (times a^(3-D)).

    Arguments as in `free_molecular_flux`. It interpolates between `free_molecular_flux` and
    `fourier_flux`: 1/q = 1/q_free + 1/q_Fourier, F. S. Sherman, in Rarefied Gas Dynamics (1963),
    vol. 2, p. 228; within some per cent of measurements.
    """
    free = free_molecular_flux(hot, cold, particles, gap, dimension)
    fourier = fourier_flux(hot, cold, gap, dimension)
    return free * fourier / (free + fourier)
