"""Gases without positions (direct simulation Monte Carlo): one run each."""

import numpy as np

from roughgas.tasks import dsmc

from . import published

SETTLED = 20.0  # collisions per particle in which a smooth cooling gas forgets its Maxwellian
STEP = 0.1  # collisions per particle between two looks at velocities
KICK = 0.05  # collisions per particle between two kicks of white noise
SPEEDS = np.linspace(0.0, 10.0, 201)  # c between which velocities are counted
FEWEST = 30  # velocities in one such interval that count
STEEPER = 1.6, 1.2  # of a cooling gas, and of one that white noise drives
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


def rough(about, gas, seed) -> dict[str, float]:
    """Return R and cumulants of a rough gas that cools."""
    dimension, r, beta = gas
    rng, number = np.random.default_rng(seed), about["particles"]
    particles = dsmc.new_gas(number, 0.5, rng, dimension)
    material = dsmc.material(r, beta, dimension)
    dsmc.run(particles, material, rng, about["settle"], 1)
    samples = dsmc.run(particles, material, rng, 1.0, about["measure"])
    names = "R", "a20", "a11", "a02"
    return {name: float(getattr(samples, name).mean()) for name in names}


def tails(about, gas, seed) -> dict[str, float]:
    """Return -d ln f/dx of the velocities of a smooth gas at large c = v/sqrt(2 T/m): x is c if the
    gas cools, c^(3/2) if white noise drives it. Besides, d ln c/dx there, and a2.

    The tail is where a Maxwellian would fall STEEPER times as steeply as the law of the tail.
    """
    dimension, r, driven = gas
    rng, number = np.random.default_rng(seed), about["particles"]
    particles = dsmc.new_gas(number, 0.0, rng, dimension)
    material = dsmc.material(r, -1.0, dimension)
    a2, counts = [], np.zeros(len(SPEEDS) - 1)
    for k in range(round(SETTLED) + about["measure"]):
        (_noise if driven else dsmc.run)(particles, material, rng, 1.0, 1)
        if k >= SETTLED:
            square = np.sum(particles.velocity**2, axis=1)
            c = np.sqrt(0.5 * dimension * square / square.mean())
            counts += np.histogram(c, SPEEDS)[0]
            a2.append(dimension / (dimension + 2.0) * np.mean(square**2) / square.mean() ** 2 - 1.0)
    known = float(unbiased(np.mean(a2), number, dimension))
    slope, bend = fall(counts, dimension, driven, begin(dimension, r, known, driven))
    return {"tail": slope, "bend": bend, "a2": known}


def _noise(particles, material, rng, every, samples) -> None:
    """Let a gas collide, and give it by kicks what it loses."""
    for _ in range(round(samples * every / KICK)):
        before = particles.clock[dsmc.LOG_UNIT]
        dsmc.run(particles, material, rng, KICK, 1)
        left = min(1.0, np.exp(2.0 * (particles.clock[dsmc.LOG_UNIT] - before)))
        particles.velocity[:] *= np.sqrt(left)
        particles.velocity[:] += np.sqrt(1.0 - left) * rng.standard_normal(particles.velocity.shape)


def begin(dimension, r, a2, driven) -> float:
    """Return c from which on the tail is fitted: 2 c is STEEPER times A, or 3/2 A sqrt(c)."""
    slope = STEEPER[driven] * published.tail(dimension, r, a2, driven)
    return (0.75 * slope) ** 2 if driven else 0.5 * slope


def fall(counts, dimension, driven, begin) -> tuple[float, float]:
    """Return -d ln f/dx and d ln c/dx of the speeds counted beyond `begin`, by weighted lines."""
    middle = 0.5 * (SPEEDS[1:] + SPEEDS[:-1])
    own = (SPEEDS[:-1] >= begin) & (counts >= FEWEST)
    c, n = middle[own], counts[own]
    x, volume = c**1.5 if driven else c, np.diff(SPEEDS**dimension)[own]
    lines = np.polynomial.polynomial.polyfit(
        x, np.stack([np.log(n / volume), np.log(c)], axis=1), 1, w=np.sqrt(n)
    )
    return -float(lines[1, 0]), float(lines[1, 1])


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
