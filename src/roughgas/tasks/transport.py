"""Transport coefficients of a homogeneous gas by direct simulation Monte Carlo.

The gas (`roughgas.tasks.dsmc`) has no positions: its particles are as dilute as Boltzmann's
equation assumes, and only their velocities transport momentum and energy. Three methods:

Equilibrium (M. S. Green, J. Chem. Phys. 22, 398, 1954; R. Kubo, J. Phys. Soc. Jpn. 12, 570, 1957).
Viscosity and conductivity are time integrals of autocorrelations, per particle at T = 1,

    viscosity nu/n = tau_P,    conductivity nu/n = c tau_q,    tau_J = int <J(0) J(t)>/<J^2> nu dt,

of the kinetic stress P_xy = sum v_x v_y, with all traceless components averaged, and of the flux
q = sum (v^2 + q w^2) v/2 of translational and rotational energy; c = (D + 2)/2 + n_r/2, with the
n_r = 2 D - 3 spin components of rough particles, is <q_x^2>/N of many particles. The stress by
collisions, antisymmetric parts included, vanishes with the density.

Uniform shear. Velocities are relative to a flow a y along x: v_x falls by a v_y dt. A thermostat
scales velocities and spins to a constant energy. viscosity = -<P_xy>/a, with a correction of the
order a^2.

Self-diffusion of a gas that weak random kicks drive, from the autocorrelation of velocities.

Density and Enskog's factor are such that nu = 1 at T_tr = 1 in a Maxwellian gas: time is in
collisions per particle. m = a = 1. The number N of particles changes results by the order 1/N,
since energy and momentum are conserved and collisions correlate particles: extrapolate in 1/N.
"""

import math
from typing import NamedTuple

import numpy as np

from roughgas import theory
from roughgas.compiling.jit import compiled, entry
from roughgas.kernel.mathematics import dot, read
from roughgas.kernel.particles import spin_of
from roughgas.statistics.estimates import Estimate
from roughgas.tasks import dsmc, mean_estimate
from roughgas.tasks.dsmc import COLLISIONS, TIME, collide_until

STRESS_COMPONENTS = {2: 2, 3: 5}
"""Number of independent traceless symmetric components of the stress, by dimension."""
DILUTE = 1e-12
"""Packing fraction of a gas without transport from centre to centre."""
WINDOW_SHARES = {"viscosity": 0.75, "conductivity": 1.0}
"""Share of the observed delays over which a memory is integrated: stress forgets faster."""
SLOWEST_DECAY = 0.5
"""Largest factor by which an autocorrelation may fall in a quarter of the longest time: noise may
pretend slower ones, whose tails would be infinite."""


class GasProperties(NamedTuple):
    """Restitution r, roughness beta, dimension and q = I/(m a^2) of the particles of a gas."""

    r: float
    beta: float
    dimension: int
    inertia: float

    @property
    def spins(self) -> int:
        """Number of spin components that collisions change: 2 D - 3, or 0 at beta = -1."""
        return 0 if self.beta == -1.0 else 2 * self.dimension - 3

    @property
    def material(self) -> dsmc.CollisionModel:
        """Collision rule of a gas with one collision per particle and time at T_tr = 1."""
        per_density = theory.collision_frequency(1.0, DILUTE, self.dimension)
        per_density /= theory.number_density(DILUTE, self.dimension)
        crowding = float(1.0 / per_density)
        return dsmc.material(self.r, self.beta, self.dimension, self.inertia, crowding)

    def new_gas(self, particles: int, rng: np.random.Generator) -> dsmc.HomogeneousGas:
        """Return a gas at T_tr = 1 and, if its particles are rough, at T_rot = 1."""
        theta = 1.0 if self.spins else 0.0
        return dsmc.new_gas(particles, theta, rng, self.dimension, self.inertia)

    def first_approximation(self, name: str) -> float:
        """Return `viscosity` or `conductivity` nu/n of the elastic gas, in first Sonine
        approximation.
        """
        unit = theory.collision_frequency(1.0, DILUTE, self.dimension)
        unit /= theory.number_density(DILUTE, self.dimension)
        q = self.inertia if self.spins else None
        if name == "viscosity":
            value = theory.shear_viscosity(1.0, 1.0, DILUTE, 1.0, self.beta, self.dimension, q)
        else:
            value = theory.thermal_conductivity(1.0, self.dimension, DILUTE, q)
        return float(unit * value)


# ---------------------------------------------------------------------- equilibrium


def correlations(
    properties: GasProperties, particles: int, block: tuple[int, int, int], blocks: int, seed
) -> dict[str, np.ndarray]:
    """Compute autocorrelations of stress and heat flux of an elastic gas, each (blocks, delays).

    `block` is (samples, collisions between two of them, delays), `seed` a SeedSequence. Rows
    are means over a block, of all components, over N; they are under the names of the coefficients,
    `viscosity` and `conductivity`.
    """
    samples, collisions, delays = block
    rng, material = np.random.default_rng(seed), properties.material
    gas, D = properties.new_gas(particles, rng), properties.dimension
    fluxes = np.empty((samples, STRESS_COMPONENTS[D] + D))
    record_fluxes(gas, material, rng, properties.inertia, collisions, fluxes[:100])
    means = np.empty((2, blocks, delays))
    for k in range(blocks):
        record_fluxes(gas, material, rng, properties.inertia, collisions, fluxes)
        products = autocorrelation(fluxes, delays) / particles
        products_of_fluxes = np.split(products, [STRESS_COMPONENTS[D]], axis=1)
        means[:, k] = [flux_products.mean(axis=1) for flux_products in products_of_fluxes]
    return {"viscosity": means[0], "conductivity": means[1]}


@entry(cache=True)
def record_fluxes(gas, material, rng, q, collisions, fluxes):
    """Simulate `collisions` before each row of `fluxes`, (samples, stress components and D).

    `q` is I/(m a^2). Rows are the traceless kinetic stress, then the heat flux, sums over all
    particles. Each component of the stress has the same mean square.
    """
    for k in range(len(fluxes)):
        collide_until(gas, material, rng, gas.counts[COLLISIONS] + collisions)
        add_fluxes(gas, q, fluxes[k])


@compiled
def add_fluxes(gas, q, row):
    """Fill `row`, (stress components and D,), with the fluxes of a gas; `q` is I/(m a^2)."""
    row[:] = 0.0
    for i in range(len(gas.velocity)):
        v, w = read(gas.velocity, i, 0, gas.axes), spin_of(gas.spin, gas.axes, i)
        energy = 0.5 * (dot(v, v) + q * dot(w, w))
        row[0] += v[0] * v[1]
        row[1] += 0.5 * (v[0] * v[0] - v[1] * v[1])
        if len(gas.axes) == 2:
            row[2] += energy * v[0]
            row[3] += energy * v[1]
        else:
            row[2] += v[0] * v[2]
            row[3] += v[1] * v[2]
            row[4] += (3.0 * v[2] * v[2] - dot(v, v)) / math.sqrt(12.0)
            row[5] += energy * v[0]
            row[6] += energy * v[1]
            row[7] += energy * v[2]


def autocorrelation(series: np.ndarray, delays: int) -> np.ndarray:
    """Compute mean products of `series`, (samples, components), with itself delayed.

    The delays are 0, 1, ... samples; the result has shape (delays, components). By fast Fourier
    transforms of the series, padded by zeros.
    """
    length = len(series)
    transform = np.fft.rfft(series, n=length + delays, axis=0)
    products = np.fft.irfft(abs(transform) ** 2, n=length + delays, axis=0)[:delays]
    return products / (length - np.arange(delays))[:, np.newaxis]


def memory_time(correlation: np.ndarray, interval: float) -> float:
    """Compute int_0^inf C(t)/C(0) dt of a mean autocorrelation C, shape (delays,), its tail added.

    `interval` is the time between two of its values. Integrals by Simpson's rule up to three times
    in equal steps give the tail (`exponential_tail`). Raises ValueError for an even number of
    delays, or fewer than nine.
    """
    last = len(correlation) - 1
    if last % 2 or last < 8:
        raise ValueError(f"{len(correlation)} delays are not odd, or below 9")
    ends = last - 2 * (last // 8) * np.arange(2, -1, -1)
    integrals = [_simpson(correlation[: end + 1]) for end in ends]
    return float(interval * (integrals[-1] + exponential_tail(*integrals)) / correlation[0])


def exponential_tail(first: float, second: float, third: float) -> float:
    """Compute what an integral up to a time lacks if its integrand then falls exponentially.

    `third` is the integral up to this time, the others end one and two equal steps before
    (Aitken's rule). The fall in a step is at most to SLOWEST_DECAY.
    """
    rise, next_rise = second - first, third - second
    decay = min(max(next_rise / rise, 0.0), SLOWEST_DECAY) if rise else 0.0
    return next_rise * decay / (1.0 - decay)


def _simpson(values):
    """Return the integral of `values`, an odd number of them, in units of their distance."""
    return (values[0] + 4.0 * values[1::2].sum() + 2.0 * values[2:-1:2].sum() + values[-1]) / 3.0


def integrated(blocks: np.ndarray, interval: float) -> tuple[Estimate, Estimate]:
    """Compute the memory time of autocorrelations, (blocks, delays), and the effect of the cut.

    The error of the first result is by the jackknife over the blocks, which are independent. The
    second is the change of the result if its longest time is a quarter shorter: it bounds the error
    of the extrapolated tail, and contains noise of its own, which its error states.
    """
    cut = 2 * (3 * (blocks.shape[1] - 1) // 8) + 1
    total, count = blocks.sum(axis=0), len(blocks)
    rows = [blocks.mean(axis=0), *(total - blocks) / (count - 1)]
    pairs = [(memory_time(row, interval), memory_time(row[:cut], interval)) for row in rows]
    times, changes = np.array([(full, full - shorter) for full, shorter in pairs]).T
    return _jackknife(times), _jackknife(changes)


def _jackknife(values):
    """Return the Estimate of the first of `values`; the others lack one of the blocks each."""
    count = len(values) - 1
    error = np.sqrt((count - 1) * np.var(values[1:]))
    return Estimate(float(values[0]), float(error), count - 1.0)


def coefficients_in_equilibrium(
    properties: GasProperties, means: dict[str, np.ndarray], interval: float
) -> dict[str, Estimate]:
    """Compute viscosity and conductivity over their first Sonine approximation, by name.

    `means` and `interval` are of `correlations`. The error includes the change by a shorter cut,
    insofar as it exceeds its noise.
    """
    D, results = properties.dimension, {}
    for name, blocks in means.items():
        longest = round(WINDOW_SHARES[name] * (blocks.shape[1] - 1))
        time, change = integrated(blocks[:, : longest + 1], interval)
        excess = math.sqrt(max(0.0, change.value**2 - change.stderr**2))
        flux = 1.0 if name == "viscosity" else (D + 2 + properties.spins) / 2.0
        error = math.hypot(time.stderr, excess)
        unit = flux / properties.first_approximation(name)
        results[name] = Estimate(time.value, error, time.dof).scaled(unit)
    return results


# ---------------------------------------------------------------------- small forces


def forced_coefficients(
    properties: GasProperties, particles: int, force: float, length: float, seed
) -> dict[str, Estimate]:
    """Compute viscosity and conductivity of an elastic gas over their first approximation, by name.

    The gas is in a steady state under a shear of the rate `force` and a heat force FORCE_RATIO
    times as strong, in units of T = 1 and collisions per particle. `length` is the number of
    collisions per particle that are measured, after 50. Errors are from BLOCKS blocks.
    """
    rng, material = np.random.default_rng(seed), properties.material
    gas = properties.new_gas(particles, rng)
    collisions = max(1, round(particles * STEP / 2))
    forces = properties.inertia, force, FORCE_RATIO * force, collisions
    record_forced(gas, material, rng, *forces, np.empty((round(50 / STEP), 3)))
    rows = np.empty((BLOCKS, round(length / STEP / BLOCKS), 3))
    for block in rows:
        record_forced(gas, material, rng, *forces, block)
    stress, heat, T = rows.mean(axis=1).T
    T = T * particles / (particles - 1)  # momentum is conserved
    responses = {
        "viscosity": -stress / (force * np.sqrt(T)),
        "conductivity": heat / (FORCE_RATIO * force * T**1.5),
    }
    factor = {name: 1.0 / properties.first_approximation(name) for name in responses}
    return {name: mean_estimate(values).scaled(factor[name]) for name, values in responses.items()}


STEP = 0.1
"""Collisions per particle between two changes of velocities by forces or by kicks."""
BLOCKS = 40
"""Number of blocks of a run, whose scatter is its error."""
FORCE_RATIO = 0.25
"""Heat force over shear rate; the gas is then about as far from equilibrium by either."""


@entry(cache=True)
def record_forced(gas, material, rng, q, shear, heat, collisions, rows):
    """Fill `rows`, (samples, 3), with <v_x v_y>, the heat flux along x over N, and T_tr.

    Before each row the gas has `collisions`. For the time that they take it is then subject to a
    flow `shear` y along x and to the force `heat` (e - <e>) along x on a particle of the energy e;
    velocities and spins are scaled to the initial energy. Both fluxes are means of their values
    before and after the forces. `q` is I/(m a^2).
    """
    number, dimension = gas.velocity.shape
    initial = energy_of(gas, q)
    for k in range(len(rows)):
        start = gas.clock[TIME]
        collide_until(gas, material, rng, gas.counts[COLLISIONS] + collisions)
        time = gas.clock[TIME] - start
        add_to_row(gas, q, rows[k], 0.0)
        for i in range(number):
            v, w = read(gas.velocity, i, 0, gas.axes), spin_of(gas.spin, gas.axes, i)
            excess = 0.5 * (dot(v, v) + q * dot(w, w) - initial / number)
            gas.velocity[i, 0] += time * (heat * excess - shear * v[1])
        add_to_row(gas, q, rows[k], 1.0)
        for column in range(3):
            rows[k, column] /= 2.0 * number
        rows[k, 2] /= dimension
        factor = math.sqrt(initial / energy_of(gas, q))
        for vectors in (gas.velocity, gas.spin):
            vectors *= factor


@compiled
def add_to_row(gas, q, row, weight):
    """Add sums over particles of v_x v_y, heat flux along x, and v^2 to `weight` times `row`, (3,).

    `q` is I/(m a^2).
    """
    for column in range(3):
        row[column] = weight * row[column] if weight > 0.0 else 0.0
    for i in range(len(gas.velocity)):
        v, w = read(gas.velocity, i, 0, gas.axes), spin_of(gas.spin, gas.axes, i)
        row[0] += v[0] * v[1]
        row[1] += 0.5 * (dot(v, v) + q * dot(w, w)) * v[0]
        row[2] += dot(v, v)


@compiled
def energy_of(gas, q):
    """Return twice the energy of a gas; `q` is I/(m a^2)."""
    total = 0.0
    for i in range(len(gas.velocity)):
        v, w = read(gas.velocity, i, 0, gas.axes), spin_of(gas.spin, gas.axes, i)
        total += dot(v, v) + q * dot(w, w)
    return total


# ---------------------------------------------------------------------- self-diffusion


def driven_diffusion(
    properties: GasProperties, particles: int, length: float, windows: int, seed
) -> Estimate:
    """Compute the coefficient of self-diffusion of a driven gas over its first approximation.

    Kicks after every STEP collisions per particle keep T_tr near 1. Autocorrelations of velocities
    are observed over `windows` windows of `length` collisions per particle, a multiple of 8 STEP;
    the first fifth of the windows, in which the gas relaxes, is left out. The approximation is of
    Maxwellian velocities at the measured temperature; the error is by the jackknife.
    """
    rng, material = np.random.default_rng(seed), properties.material
    R = float(theory.lun_ratio(properties.beta, properties.inertia))
    theta = R / (1.0 - R)
    gas = dsmc.new_gas(particles, theta, rng, properties.dimension, properties.inertia)
    rates = theory.collision_rates(*properties)
    kick = math.sqrt(STEP * (rates.translational_loss - rates.translational_gain * theta))
    collisions = max(1, round(particles * STEP / 2))
    rows, times = np.empty((windows, round(length / STEP) + 1)), np.empty(windows)
    for k in range(windows):
        start = gas.clock[TIME]
        record_memory(gas, material, rng, kick, collisions, gas.velocity.copy(), rows[k])
        times[k] = (gas.clock[TIME] - start) / (rows.shape[1] - 1)
    stationary = slice(windows // 5, None)
    time, _ = integrated(rows[stationary], float(times[stationary].mean()))
    T = float(rows[stationary, 0].mean()) / properties.dimension
    unit = theory.collision_frequency(1.0, DILUTE, properties.dimension)
    first = theory.self_diffusion(1.0, DILUTE, *properties) * unit
    return time.scaled(float(math.sqrt(T) / first))


@entry(cache=True)
def record_memory(gas, material, rng, kick, collisions, initial, row):
    """Fill `row`, (delays,), with <v(0) . v(t)> of a gas with the `initial` velocities, (N, D).

    Between two delays each velocity component gets a Gaussian `kick` of this standard deviation,
    without a change of the total momentum, and then the gas has `collisions`.
    """
    number = len(initial)
    row[0] = mean_product(initial, gas.velocity)
    for k in range(1, len(row)):
        for component in gas.velocity.T:
            for i in range(number):
                component[i] += kick * rng.standard_normal()
            component -= component.mean()
        collide_until(gas, material, rng, gas.counts[COLLISIONS] + collisions)
        row[k] = mean_product(initial, gas.velocity)


@compiled
def mean_product(first, second):
    """Return the mean scalar product of the rows of two arrays, (N, D)."""
    total = 0.0
    for i in range(len(first)):
        for axis in range(first.shape[1]):
            total += first[i, axis] * second[i, axis]
    return total / len(first)
