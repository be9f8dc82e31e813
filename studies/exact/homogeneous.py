"""Gases without positions (direct simulation Monte Carlo), one run per function."""

import numpy as np

from roughgas.tasks import dsmc

from . import published

SETTLING = 20.0  # collisions per particle until a smooth cooling gas has left its Maxwellian
SAMPLING_INTERVAL = 0.1  # collisions per particle between two samples of velocities
KICK_INTERVAL = 0.05  # collisions per particle between two kicks of white noise
SPEEDS = np.linspace(0.0, 10.0, 201)  # edges of bins of c
MINIMUM_COUNT = 30  # velocities in a bin that is used
STEEPNESS = 1.6, 1.2  # at the begin of the tail: of a cooling, and of a driven gas
LONGEST_LAG = 5.0  # of the velocity autocorrelation: collisions per particle and dimension


def cooling(settings, gas, seed) -> dict[str, float]:
    """Return the cumulant a2 of a smooth gas that cools."""
    dimension, r = gas
    rng, number = np.random.default_rng(seed), settings["particles"]
    particles = dsmc.new_gas(number, 0.0, rng, dimension)
    material = dsmc.material(r, -1.0, dimension)
    dsmc.run(particles, material, rng, SETTLING, 1)
    samples = dsmc.run(particles, material, rng, 1.0, settings["measure"])
    return {"a2": float(unbiased(samples.a20, number, dimension).mean())}


def rough(settings, gas, seed) -> dict[str, float]:
    """Return R and cumulants of a rough gas that cools."""
    dimension, r, beta = gas
    rng, number = np.random.default_rng(seed), settings["particles"]
    particles = dsmc.new_gas(number, 0.5, rng, dimension)
    material = dsmc.material(r, beta, dimension)
    dsmc.run(particles, material, rng, settings["settle"], 1)
    samples = dsmc.run(particles, material, rng, 1.0, settings["measure"])
    names = "R", "a20", "a11", "a02"
    return {name: float(getattr(samples, name).mean()) for name in names}


def tails(settings, gas, seed) -> dict[str, float]:
    """Return the slope -d ln f/dx of the velocity distribution of a smooth gas at large c =
    v/sqrt(2 T/m), where x is c if the gas cools, c^(3/2) if white noise drives it; d ln c/dx there
    (`bend`); and a2.

    The tail begins where a Maxwellian would fall STEEPNESS times as steeply as the law of the tail.
    """
    dimension, r, driven = gas
    rng, number = np.random.default_rng(seed), settings["particles"]
    particles = dsmc.new_gas(number, 0.0, rng, dimension)
    material = dsmc.material(r, -1.0, dimension)
    a2, counts = [], np.zeros(len(SPEEDS) - 1)
    for k in range(round(SETTLING) + settings["measure"]):
        (_run_driven if driven else dsmc.run)(particles, material, rng, 1.0, 1)
        if k >= SETTLING:
            square = np.sum(particles.velocity**2, axis=1)
            c = np.sqrt(0.5 * dimension * square / square.mean())
            counts += np.histogram(c, SPEEDS)[0]
            a2.append(dimension / (dimension + 2.0) * np.mean(square**2) / square.mean() ** 2 - 1.0)
    cumulant = float(unbiased(np.mean(a2), number, dimension))
    slope, bend = tail_slope(counts, dimension, driven, tail_begin(dimension, r, cumulant, driven))
    return {"tail": slope, "bend": bend, "a2": cumulant}


def _run_driven(particles, material, rng, every, samples) -> None:
    """Let a gas collide, and restore the lost energy by kicks."""
    for _ in range(round(samples * every / KICK_INTERVAL)):
        before = particles.clock[dsmc.LOG_UNIT]
        dsmc.run(particles, material, rng, KICK_INTERVAL, 1)
        retained = min(1.0, np.exp(2.0 * (particles.clock[dsmc.LOG_UNIT] - before)))
        particles.velocity[:] *= np.sqrt(retained)
        particles.velocity[:] += np.sqrt(1.0 - retained) * rng.standard_normal(
            particles.velocity.shape
        )


def tail_begin(dimension, r, a2, driven) -> float:
    """Return the c at the begin of the fitted tail: 2 c is STEEPNESS times A, or 3/2 A sqrt(c)."""
    slope = STEEPNESS[driven] * published.tail(dimension, r, a2, driven)
    return (0.75 * slope) ** 2 if driven else 0.5 * slope


def tail_slope(counts, dimension, driven, tail_begin) -> tuple[float, float]:
    """Return -d ln f/dx and d ln c/dx of the speeds counted beyond `begin`, by weighted linear
    fits."""
    middle = 0.5 * (SPEEDS[1:] + SPEEDS[:-1])
    in_tail = (SPEEDS[:-1] >= tail_begin) & (counts >= MINIMUM_COUNT)
    c, n = middle[in_tail], counts[in_tail]
    x, volume = c**1.5 if driven else c, np.diff(SPEEDS**dimension)[in_tail]
    lines = np.polynomial.polynomial.polyfit(
        x, np.stack([np.log(n / volume), np.log(c)], axis=1), 1, w=np.sqrt(n)
    )
    return -float(lines[1, 0]), float(lines[1, 1])


def unbiased(a2, particles: int, dimension: int):
    """Return cumulants normalised by the sample's own energy, corrected for the bias -2/(D N) of
    this normalisation for Maxwellian velocities."""
    return (1.0 + a2) * (1.0 + 2.0 / (dimension * (particles - 1))) - 1.0


def haff(settings, gas, seed) -> dict[str, float]:
    """Return -d ln T/d ln t at long times, and -d ln T/dn, n in collisions per particle."""
    dimension, r, beta = gas
    rng = np.random.default_rng(seed)
    particles = dsmc.new_gas(settings["particles"], 0.0, rng, dimension)
    material, length = dsmc.material(r, beta, dimension), settings["measure"]
    samples = dsmc.run(particles, material, rng, length, 2)
    log_decay = -float(np.diff(samples.log_T_tr)[0])
    return {
        "exponent": log_decay / float(np.diff(np.log(samples.time))[0]),
        "decay": log_decay / float(np.diff(samples.collisions_per_particle)[0]),
    }


def diffusion(settings, gas, seed) -> dict[str, float]:
    """Return D nu/T of smooth elastic particles, nu being collisions per particle and time, and its
    ratio for perfectly rough particles of the same energy."""
    smooth, rough = (
        _velocity_memory(settings, gas[0], beta, seed_of_run)
        for beta, seed_of_run in zip((-1.0, 1.0), seed.spawn(2), strict=True)
    )
    return {"smooth": smooth, "rough_over_smooth": rough / smooth}


def _velocity_memory(settings, dimension, beta, seed):
    """Return the integral of the velocity autocorrelation over collisions per particle.

    As the total momentum is zero, each particle's velocity correlates with the velocities of all
    other particles, in sum by -1/N.
    """
    rng, number = np.random.default_rng(seed), settings["particles"]
    particles = dsmc.new_gas(number, 1.0, rng, dimension)
    material, lags = (
        dsmc.material(1.0, beta, dimension),
        round(LONGEST_LAG * dimension / SAMPLING_INTERVAL),
    )
    samples = []
    for _ in range(lags + round(settings["measure"] / SAMPLING_INTERVAL)):
        dsmc.run(particles, material, rng, SAMPLING_INTERVAL, 1)
        samples.append(particles.velocity.astype(np.float32))
    velocities = np.array(samples).reshape(len(samples), -1)
    starts = np.arange(0, len(velocities) - lags, round(1.0 / SAMPLING_INTERVAL))
    products = [
        np.einsum("ij,ij->", velocities[starts], velocities[starts + lag]) for lag in range(lags)
    ]
    correlation = np.array(products, float) / products[0] + 1.0 / number
    return float(SAMPLING_INTERVAL * (correlation.sum() - 0.5 * (correlation[0] + correlation[-1])))
