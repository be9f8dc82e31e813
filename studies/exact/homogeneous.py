"""Gases without positions (direct simulation Monte Carlo): one run each."""

import numpy as np

from roughgas.tasks import dsmc

SETTLED = 20.0  # collisions per particle in which a smooth cooling gas forgets its Maxwellian
STEP = 0.1  # collisions per particle between two looks at velocities
LONGEST = 5.0  # over which velocities are compared: collisions per particle and dimension


def cooling(about, gas, seed) -> dict[str, float]:
    """Return the cumulant a2 of a smooth gas that cools."""
    dimension, r = gas
    rng, number = np.random.default_rng(seed), about["particles"]
    particles = dsmc.new_gas(number, 0.0, rng, dimension)
    material = dsmc.material(r, -1.0, dimension)
    dsmc.run(particles, material, rng, SETTLED, 1)
    samples = dsmc.run(particles, material, rng, 1.0, about["measure"])
    return {"a2": float(unbiased(samples.a20, number, dimension).mean())}


def unbiased(a2, particles: int, dimension: int):
    """Return cumulants that were normalised by the sample's own energy, without the bias -2/(D N)
    that this has where velocities are Maxwellian."""
    return (1.0 + a2) * (1.0 + 2.0 / (dimension * (particles - 1))) - 1.0


def haff(about, gas, seed) -> dict[str, float]:
    """Return -d ln T/d ln t at long times, and -d ln T/dn, n in collisions per particle."""
    dimension, r, beta = gas
    rng = np.random.default_rng(seed)
    particles = dsmc.new_gas(about["particles"], 0.0, rng, dimension)
    material, length = dsmc.material(r, beta, dimension), about["measure"]
    late = dsmc.run(particles, material, rng, length, 2)
    fallen = -float(np.diff(late.log_T_tr)[0])
    return {
        "exponent": fallen / float(np.diff(np.log(late.time))[0]),
        "decay": fallen / float(np.diff(late.collisions_per_particle)[0]),
    }


def diffusion(about, gas, seed) -> dict[str, float]:
    """Return D nu/T of smooth elastic particles, nu being collisions per particle and time, and by
    how much it differs for perfectly rough ones of as much energy."""
    smooth, rough = (
        _diffusion(about, gas[0], beta, one)
        for beta, one in zip((-1.0, 1.0), seed.spawn(2), strict=True)
    )
    return {"smooth": smooth, "rough_over_smooth": rough / smooth}


def _diffusion(about, dimension, beta, seed):
    """Return the integral of the autocorrelation of velocities over collisions per particle.

    Without momentum each particle's velocity correlates with those of all others, together as -1/N.
    """
    rng, number = np.random.default_rng(seed), about["particles"]
    particles = dsmc.new_gas(number, 1.0, rng, dimension)
    material, lags = dsmc.material(1.0, beta, dimension), round(LONGEST * dimension / STEP)
    looks = []
    for _ in range(lags + round(about["measure"] / STEP)):
        dsmc.run(particles, material, rng, STEP, 1)
        looks.append(particles.velocity.astype(np.float32))
    path = np.array(looks).reshape(len(looks), -1)
    starts = np.arange(0, len(path) - lags, round(1.0 / STEP))
    products = [np.einsum("ij,ij->", path[starts], path[starts + lag]) for lag in range(lags)]
    correlation = np.array(products, float) / products[0] + 1.0 / number
    return float(STEP * (correlation.sum() - 0.5 * (correlation[0] + correlation[-1])))
