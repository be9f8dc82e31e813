"""Self-diffusion: published limits, and the loss of memory in single collisions."""

import numpy as np
import pytest

from roughgas import theory


@pytest.mark.parametrize(
    ("dimension", "smooth"), [(2, 1 / (2 * np.sqrt(np.pi))), (3, 3 / (8 * np.sqrt(np.pi)))]
)
def test_limits_of_elastic_particles(dimension, smooth):
    """sqrt(T/m)/(n (2a)^(D-1)) times 1/(2 sqrt(pi)) or 3/(8 sqrt(pi)); Pidduck's rough spheres."""
    n = theory.number_density(1e-6, dimension)
    found = theory.self_diffusion(4.0, 1e-6, dimension=dimension)
    assert found == pytest.approx(smooth * 2.0 / (n * 2 ** (dimension - 1)), rel=1e-5)
    q = np.array([0.1, 0.4, 2 / 3])
    rough = theory.self_diffusion(4.0, 1e-6, 1.0, 1.0, dimension, q) / found
    assert rough == pytest.approx((1 + q) / (1 + (dimension + 1) / 2 * q), rel=1e-12)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(("r", "beta"), [(0.8, 0.3), (0.6, -0.5), (1.0, 1.0)])
def test_memory_is_lost_as_in_collisions_of_random_pairs(dimension, r, beta):
    """The collision rule itself, by 200 000 pairs that are drawn as they collide; 4 sigma."""
    rng, number, q = np.random.default_rng(3), 200_000, 0.4
    T_tr, T_rot, spins = 1.3, 0.7, 2 * dimension - 3
    v1, v2 = (T_tr**0.5 * rng.standard_normal((number, 3)) for _ in range(2))
    if dimension == 2:
        v1[:, 2] = v2[:, 2] = 0.0
    w1, w2 = (np.zeros((number, 3)) for _ in range(2))
    for w in (w1, w2):
        w[:, 3 - spins :] = (T_rot / q) ** 0.5 * rng.standard_normal((number, spins))
    n = np.zeros((number, 3))
    n[:, :dimension] = rng.standard_normal((number, dimension))
    n /= np.linalg.norm(n, axis=1)[:, None]
    g = v1 - v2
    weight = np.maximum(0.0, -np.sum(g * n, axis=1))  # pairs meet as fast as they approach
    normal = np.sum(g * n, axis=1)[:, None] * n
    surface = g - normal - np.cross(w1 + w2, n)
    eta = q * (1 + beta) / (2 * (1 + q))
    push = (1 + r) / 2 * normal + eta * surface  # of 1 to 2
    turn = np.cross(n, push) / q
    for before, after, expected in (
        (v1, v1 - push, ((1 + r) + (dimension - 1) * eta) * T_tr),
        (w1, w1 + turn, eta / q * (dimension - 1) * T_rot / q),
    ):
        lost = np.sum(before * (before - after), axis=1)
        mean = np.average(lost, weights=weight)
        error = np.sqrt(np.average((lost - mean) ** 2 * weight / weight.mean(), weights=weight))
        assert abs(mean - expected) < 4.0 * error / np.sqrt(number)
