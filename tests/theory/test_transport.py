"""Transport coefficients: published limits, and averages over pairs as they collide."""

import numpy as np
import pytest
from slow_cases import slow_but
from tests.theory.collisions import maxwellian_pairs

from roughgas import theory

BATCHES = 16


def batches(dimension, T_rot, q, size=20_000):
    """Yield BATCHES independent samples of pairs."""
    for seed in range(BATCHES):
        yield maxwellian_pairs(np.random.default_rng((3, seed)), size, dimension, T_rot / q)


def contact_changes(pairs, r, beta, q):
    """Return the impulse on the second particle, the change of both spins, the approach speed."""
    after = pairs.after(r, beta, q)
    return pairs.v1 - after.v1, after.w1 - pairs.w1, pairs.approach()


def mean_agrees(estimates, expected, within):
    """Return whether the mean of `estimates` is within five errors of `expected`: by chance it is
    not in 2 of 10 000 cases. The error must be less than the share `within` of it."""
    error = np.std(estimates, axis=0, ddof=1) / np.sqrt(BATCHES)
    assert np.all(error < within * np.abs(expected))
    return np.all(np.abs(np.mean(estimates, axis=0) - expected) < 5.0 * error)


@pytest.mark.parametrize(
    ("dimension", "smooth"), [(2, 1 / (2 * np.sqrt(np.pi))), (3, 3 / (8 * np.sqrt(np.pi)))]
)
def test_self_diffusion_of_elastic_particles_has_the_published_limits(dimension, smooth):
    """sqrt(T/m)/(n (2a)^(D-1)) times 1/(2 sqrt(pi)) or 3/(8 sqrt(pi)); Pidduck's rough spheres."""
    n = theory.number_density(1e-6, dimension)
    diffusion = theory.self_diffusion(4.0, 1e-6, dimension=dimension)
    assert diffusion == pytest.approx(smooth * 2.0 / (n * 2 ** (dimension - 1)), rel=1e-5)
    q = np.array([0.1, 0.4, 2 / 3])
    rough = theory.self_diffusion(4.0, 1e-6, 1.0, 1.0, dimension, q) / diffusion
    assert rough == pytest.approx((1 + q) / (1 + (dimension + 1) / 2 * q), rel=1e-12)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("packing", [0.0, 0.2])
def test_viscosity_and_conductivity_of_smooth_elastic_particles_are_enskogs(dimension, packing):
    """Gass 1971 (disks) and Chapman & Cowling 1970, 16.4 (spheres), in first approximation:
    the coefficient is (1 + c y chi)^2/chi + e y^2 chi times the dilute limit, with y = 2 or 4 times
    the packing."""
    chi = theory.contact_value(packing, dimension)
    y = 2 ** (dimension - 1) * packing
    dilute = {2: (1 / 4, 1), 3: (5 / 64, 75 / 256)}[dimension]
    numbers = {2: ((1 / 2, 2), (3 / 4, 1)), 3: ((2 / 5, 48 / 25), (3 / 5, 32 / 25))}[dimension]
    coefficients = (
        theory.shear_viscosity(4.0, 0.0, packing, dimension=dimension),
        theory.thermal_conductivity(4.0, dimension, packing),
    )
    for coefficient, first, (c, e) in zip(coefficients, dilute, numbers, strict=True):
        enskog = (1 + c * y * chi) ** 2 / chi + e / np.pi * y**2 * chi
        assert coefficient == pytest.approx(2.0 * first / np.sqrt(np.pi) * enskog, rel=1e-12)


def test_coefficients_of_rough_elastic_spheres_are_pidducks():
    """Chapman & Cowling 1970, 11.6, with K = q."""
    q = np.array([0.01, 0.4, 2 / 3])
    viscosity = theory.shear_viscosity(1.0, 1.0, 0.0, 1.0, 1.0, 3, q)
    expected = 15 / 8 * (1 + q) ** 2 / (6 + 13 * q) / 4 / np.sqrt(np.pi)
    assert viscosity == pytest.approx(expected, rel=1e-12)
    top, below = 37 + 151 * q + 50 * q**2, 12 + 75 * q + 101 * q**2 + 102 * q**3
    expected = 9 / 16 * (1 + q) ** 2 * top / below / 4 / np.sqrt(np.pi)
    assert theory.thermal_conductivity(1.0, 3, 0.0, q) == pytest.approx(expected, rel=1e-12)


def test_the_viscosity_of_a_rough_inelastic_gas_relaxes_as_kremer_santos_and_garzo_have_it():
    """nu_s/nu of spheres is 4/5 times a (2 - a) + eta^2 theta/(6 q), a = alpha + eta."""
    r, beta, q, theta = 0.8, 0.3, 0.4, 0.7
    alpha, eta = (1 + r) / 2, q * (1 + beta) / (2 * (1 + q))
    a = alpha + eta
    smooth = theory.shear_viscosity(1.0, 0.0, 0.0, dimension=3)
    relative_rate = smooth / theory.shear_viscosity(1.0, theta, 0.0, r, beta, 3, q)
    assert relative_rate == pytest.approx(a * (2 - a) + eta**2 * theta / (6 * q), rel=1e-12)


MATERIALS = [(0.8, 0.3), (0.6, -0.5), (1.0, 1.0)]


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(("r", "beta"), MATERIALS)
def test_diffusion_is_that_of_random_pairs(dimension, r, beta):
    q, T_rot, packing = 0.4, 0.7, 0.1
    estimates = []
    for pairs in batches(dimension, T_rot, q):
        push, turn, approach = contact_changes(pairs, r, beta, q)
        lost = np.sum(pairs.v1 * push, axis=1) / dimension, -np.sum(pairs.w1 * turn, axis=1)
        estimates.append(np.average(lost, axis=1, weights=approach))
    D, D_r = (
        theory.self_diffusion(1.0, packing, r, beta, dimension, q),
        theory.rotational_diffusion(1.0, T_rot, packing, beta, dimension, q),
    )
    nu, components = theory.collision_frequency(1.0, packing, dimension), 2 * dimension - 3
    expected = 1 / (nu * D), components * (T_rot / q) ** 2 / (nu * D_r)
    assert mean_agrees(estimates, expected, 0.02)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(
    ("r", "beta"),
    slow_but(MATERIALS[-1:], MATERIALS),
)
def test_viscosity_is_that_of_random_pairs(dimension, r, beta):
    q, T_rot, packing = 0.4, 1.0 if r == 1.0 else 0.7, 0.1
    estimates = [viscosity(pairs, r, beta, q, packing) for pairs in batches(dimension, T_rot, q)]
    expected = theory.shear_viscosity(1.0, T_rot, packing, r, beta, dimension, q)
    assert mean_agrees(estimates, expected, 0.02)


def viscosity(pairs, r, beta, q, packing):
    """Return the viscosity from the loss of v v in collisions and its transfer from centre to
    centre, in a gas with disturbed v v, and in a strained gas."""
    D = 2 if not pairs.n[:, 2].any() else 3
    nu, n = theory.collision_frequency(1.0, packing, D), theory.number_density(packing, D)
    g, both = pairs.v1 - pairs.v2, (D - 1) * (D + 2)  # <A_xy B_xy> = <A : B>/both

    def traceless(a, b):
        product = (a[:, :D, None] * b[:, None, :D] + b[:, :D, None] * a[:, None, :D]) / 2
        return product - np.eye(D) * np.trace(product, axis1=1, axis2=2)[:, None, None] / D

    def change(push):
        return 2 * traceless(push, push) - 2 * traceless(g, push)

    push, _, approach = contact_changes(pairs, r, beta, q)
    gg, total = traceless(g, g), approach.sum()
    lost = -nu / 4 * np.sum(change(push) * gg, axis=(1, 2)) / both @ approach / total
    k = -nu / 2 * np.sum(traceless(pairs.n, push) * gg, axis=(1, 2)) / both @ approach / total
    gained = bulk = 0.0
    for strain in (0.01, -0.01):  # v_x of a flow over y; centres are 2 a apart
        shift = np.zeros_like(g)
        shift[:, :2] = strain * pairs.n[:, [1, 0]]
        push, _, approach = contact_changes(pairs._replace(v1=pairs.v1 + shift), r, beta, q)
        gained += nu / 2 * change(push)[:, 0, 1] @ approach / total / (2 * strain)
        bulk += -n * nu * traceless(pairs.n, push)[:, 0, 1] @ approach / total / (2 * strain)
    return n / lost * (1 + k) * (1 - gained) - bulk


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("q", [0.1, 0.5])
def test_the_conductivity_of_rough_elastic_particles_is_that_of_random_pairs(dimension, q):
    packing = 0.1
    estimates = [conductivity(pairs, q, packing) for pairs in batches(dimension, 1.0, q)]
    expected = theory.thermal_conductivity(1.0, dimension, packing, q)
    assert mean_agrees(estimates, expected, 0.04)


def conductivity(pairs, q, packing):
    """Return the conductivity from the loss of the fluxes of translational and rotational energy
    in collisions, and from the energy transfer from centre to centre."""
    D = 2 if not pairs.n[:, 2].any() else 3
    nu, n = theory.collision_frequency(1.0, packing, D), theory.number_density(packing, D)
    push, turn, approach = contact_changes(pairs, 1.0, 1.0, q)
    weight = approach / approach.sum()

    def energies(v, w):
        return np.array([np.sum(v**2, axis=1), q * np.sum(w**2, axis=1)]) / 2

    def fluxes(v, w):
        means = np.array([(D + 2) / 2, (2 * D - 3) / 2])
        return (energies(v, w) - means[:, None])[:, :, None] * v

    first, second = energies(pairs.v1, pairs.w1), energies(pairs.v2, pairs.w2)
    before = fluxes(pairs.v1, pairs.w1) + fluxes(pairs.v2, pairs.w2)
    v1, v2, w1, w2 = pairs.v1 - push, pairs.v2 + push, pairs.w1 + turn, pairs.w2 + turn
    after = fluxes(v1, w1) + fluxes(v2, w2)
    M = nu / 2 * np.einsum("p,xpd,ypd->xy", weight, before - after, before) / D
    gained = (energies(v1, w1) - first).sum(axis=0)  # by the first
    k = nu * np.einsum("p,pd,xpd->x", weight * gained, pairs.n, before) / D
    bulk = -nu * (weight * gained) @ (first - second).sum(axis=0) / D
    s = np.array([(D + 2) / 2, (2 * D - 3) / 2]) + k
    return n * (s @ np.linalg.solve(M, s) + bulk)


@pytest.mark.parametrize(("dimension", "q"), [(2, 0.5), (3, 0.1), (3, 0.5)])
def test_spin_corrections_are_the_ones_of_random_pairs(dimension, q):
    """Viscosity and conductivity over their values without the terms of `correlated_terms`."""
    estimates = [correlated_terms(pairs, q) for pairs in batches(dimension, 1.0, q, 8_000)]
    assert mean_agrees(estimates, theory.spin_corrections(q, dimension), 0.02)


def test_light_rims_feel_the_heat_flux_alone():
    """q -> 0: spins of spheres align with the heat flux, but no longer with the stress."""
    viscosity, conductivity = theory.spin_corrections(1e-9)
    assert viscosity == pytest.approx(1.0, abs=1e-8)
    # M = ((4, 0, 0), (0, 3, 2), (0, 2, 11)) and N = (5, 3, 0)
    expected = (25 / 4 + 9 * 11 / 29) / (25 / 4 + 9 / 3)
    assert conductivity == pytest.approx(expected, rel=1e-7)
    assert theory.spin_corrections(1e-9, 2) == pytest.approx((1.0, 1.0), abs=1e-8)


def correlated_terms(pairs, q):
    """Return viscosity and conductivity of rough particles with all terms up to the third degree,
    over the same with Pidduck's terms, from losses in collisions."""
    D = 3 if pairs.n[:, 2].any() else 2
    push, turn, approach = contact_changes(pairs, 1.0, 1.0, q)
    weight, plane = approach / approach.sum(), np.diag([1.0, 1.0, D - 2.0])
    v, w = (pairs.v1, pairs.v2), (pairs.w1, pairs.w2)
    after = (v[0] - push, v[1] + push), (w[0] + turn, w[1] + turn)

    def traceless(a, b):
        product = (a[:, :, None] * b[:, None, :] + b[:, :, None] * a[:, None, :]) / 2
        trace = np.trace(product, axis1=1, axis2=2)[:, None, None]
        return (product - plane * trace / D).reshape(-1, 9)

    def stresses(v, w):
        aligned = [traceless(w, w)] if D == 3 else []
        return [traceless(v, v), *aligned, traceless(v, np.cross(v, w))]

    def heats(v, w):
        v2, w2, vw = (np.sum(a * b, axis=1, keepdims=True) for a, b in ((v, v), (w, w), (v, w)))
        isotropic = [(v2 - D - 2) / 2 * v, (q * w2 - 2 * D + 3) / 2 * v]
        aligned = [w * vw - w2 * v / 3] if D == 3 else []
        return [*isotropic, *aligned, np.cross(v, w)]

    ratios = []
    for terms, source in ((stresses, [1.0]), (heats, {2: [4.0, 1.0], 3: [7.5, 4.5]}[D])):
        before = sum(np.array(terms(*pair)) for pair in zip(v, w, strict=True))
        change = sum(np.array(terms(*pair)) for pair in zip(*after, strict=True)) - before
        M = -np.einsum("p,xpd,ypd->xy", weight, change, before)
        first = len(source)
        N = np.pad(source, (0, len(M) - first))
        isotropic = N[:first] @ np.linalg.solve(M[:first, :first], N[:first])
        ratios.append(N @ np.linalg.solve(M, N) / isotropic)
    return np.array(ratios)
