"""Direct simulation Monte Carlo against other solvers of the same gas."""

import numpy as np
import pytest
from raw import FreeCooling
from schedules import COOLING
from tests.theory.collisions import Dsmc

from roughgas import theory
from roughgas.statistics.errors import blocking_stderr
from roughgas.tasks import dsmc
from roughgas.tasks.free_cooling import event_driven_ratios

EXPERIMENT = {
    "particles": 160,
    "box": [100, 100],
    "effects": {"spin": {"inertia": 0.5}},
    "schedule": COOLING | {"thermalise": 20},
}


def settled(r, beta, dimension, particles, samples, seed):
    R = settled_samples(r, beta, dimension, particles, samples, seed).R
    return R.mean(), blocking_stderr(R)


def settled_samples(r, beta, dimension, particles, samples, seed):
    """Return samples of a cooling gas in its stationary state."""
    rng = np.random.default_rng(seed)
    theta = theory.stationary_theta(r, beta, dimension)
    gas, material = (
        dsmc.new_gas(particles, theta, rng, dimension),
        dsmc.material(r, beta, dimension),
    )
    skipped = round(10 / theory.relaxation_rate(r, beta, dimension))
    samples_of_run = dsmc.run(gas, material, rng, 1, skipped + samples)
    return dsmc.Samples(*(column[skipped:] for column in samples_of_run))


def ratios(particles, r, beta, dimension, until, seed, mu=np.inf, theta=1.0):
    """Return collisions per particle and R every 0.12 of them, of a simulation that shares no code
    with the package: Nanbu's idea with Babovsky's pairs, in numpy."""
    alike = theory.mixture([{"fraction": 1}], r, beta, dimension, mu=mu)
    gas, passed, R = Dsmc(alike, particles, seed, theta), [0.0], []
    while passed[-1] < until:
        passed.append(passed[-1] + gas.collide(0.12))
        T_tr, T_rot = gas.temperatures()
        R.append(T_rot[0] / (T_tr[0] + T_rot[0]))
    return np.array(passed[1:]), np.array(R)


@pytest.mark.slow
@pytest.mark.parametrize("dimension", [2, 3])
def test_another_scheme_finds_the_same_gas(dimension):
    """Within 4 standard errors: by chance once in 16 000 times. The Maxwellian theory is refuted
    by each of the two."""
    r, beta = 0.6, 0.2
    R, error = settled(r, beta, dimension, 10_000, 300, 1)
    passed, series = ratios(4_000, r, beta, dimension, 120, 2)
    series = series[passed > 50]
    other_R, other_error = series.mean(), blocking_stderr(series)
    theoretical = theory.cooling_ratio(r, beta, dimension)
    assert R - other_R == pytest.approx(0.0, abs=4 * np.hypot(error, other_error))
    assert theoretical - R > 5 * error and theoretical - other_R > 5 * other_error


@pytest.mark.slow
def test_another_scheme_finds_the_same_gas_with_friction():
    """R during its rise from no spin, where most contacts slide, and later, before single particles
    run away. Within 4 standard errors of eight gases each."""
    r, beta, mu, seeds = 0.9, 0.0, 0.15, 8
    runs = np.empty((2, seeds, 3))
    for seed in range(seeds):
        rng = np.random.default_rng([7, seed])
        gas, sliding = dsmc.new_gas(4000, 0.1, rng), dsmc.material(r, beta, mu=mu)
        runs[0, seed] = dsmc.run(gas, sliding, rng, 1, 15).R[[0, 4, 14]]
        runs[1, seed] = np.interp((1, 5, 15), *ratios(4000, r, beta, 2, 16, [8, seed], mu, 0.1))
    means, errors = runs.mean(axis=1), runs.std(axis=1, ddof=1) / np.sqrt(seeds)
    assert np.all(errors < 0.01 * means)
    assert np.all(np.abs(means[0] - means[1]) < 4 * np.hypot(*errors))


@pytest.mark.parametrize(
    ("dimension", "r", "beta", "expected"),
    [
        (3, 0.8, 0.0, {"alignment": -0.084}),
        (3, 0.8, -0.5, {"alignment": -0.043}),
        (2, 0.9, 0.0, {"a20": -0.025, "a02": 0.12, "a11": 0.100}),
    ],
)
def test_another_program_finds_the_same_cumulants(dimension, r, beta, expected):
    """Published by a DSMC program that shares no code with this one, to two or three digits: half a
    unit of the last digit, and 4 standard errors of ours.

    Spins prefer to be perpendicular to velocities, as N. V. Brilliantov et al. found (2007).
    """
    samples = settled_samples(r, beta, dimension, 10_000, 100, 5)
    for name, value in expected.items():
        values, digit = getattr(samples, name), 0.005 if name == "a02" else 0.0005
        assert values.mean() == pytest.approx(value, abs=digit + 4 * blocking_stderr(values))


@pytest.mark.parametrize("dimension, r", [(2, 0.9), (3, 0.8)])
def test_the_sonine_approximation_explains_deviations_from_maxwellians(dimension, r):
    """Its error is at most a fifth of the error of Maxwellian theory, and a quarter of the
    cumulants, with 4 standard errors of the simulation."""
    samples = settled_samples(r, 0.0, dimension, 20_000, 100, 6)
    expected = theory.sonine_state(r, 0.0, dimension)
    missed = abs(expected.R - theory.cooling_ratio(r, 0.0, dimension))
    error = blocking_stderr(samples.R)
    assert missed > 8 * error
    assert samples.R.mean() == pytest.approx(expected.R, abs=missed / 5 + 4 * error)
    for name in ("a20", "a11", "a02", "alignment"):
        values, value = getattr(samples, name), getattr(expected, name)
        within = abs(value) / 4 + 4 * blocking_stderr(values)
        assert values.mean() == pytest.approx(value, abs=within)


@pytest.mark.slow
@pytest.mark.parametrize("r, beta", [(0.8, 0.0), (0.6, 0.2), (0.9, 0.5)])
def test_a_dilute_event_driven_gas_is_homogeneous(r, beta):
    """Within 4 standard errors, both of 160 particles, at a packing of 1e-4.

    Few particles share their energy unevenly: the mean of R differs from the R of mean energies,
    and the fixed momentum takes the degrees of freedom of one particle. That shifts R by some
    thousandths, in both alike. At a packing of 0.01 R is some thousandths higher still, since
    velocities of neighbours become correlated.
    """
    cooling = FreeCooling(EXPERIMENT, r, beta).at_packing(1e-4)
    R = event_driven_ratios(cooling, 400, 8000, np.random.SeedSequence(3))
    error = R.std(ddof=1) / np.sqrt(len(R))
    simulated, simulated_error = settled(r, beta, 2, 160, 50_000, 4)
    assert error < 4e-3 * R.mean()
    assert R.mean() - simulated == pytest.approx(0.0, abs=4 * np.hypot(error, simulated_error))
