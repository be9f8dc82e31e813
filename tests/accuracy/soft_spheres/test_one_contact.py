"""One contact of soft spheres: r and beta, orders, conservation, an independent integration."""

import math

import numpy as np
import pytest

from accuracy.soft_spheres.pair import angular_momentum, collide, energy, momentum, shot

PHASES = np.linspace(0.03, 1.03, 12, endpoint=False)  # begin of the contact, in steps
DIMENSIONS = [2, pytest.param(3, marks=pytest.mark.slow)]  # compiles a kernel
BETAS = [-1.0, -0.5, 0.0, 0.5, 1.0]


@pytest.mark.parametrize("dimension", DIMENSIONS)
@pytest.mark.parametrize("offset", [0.0, 1.0])
@pytest.mark.parametrize("beta", BETAS)
@pytest.mark.parametrize("r", [0.5, 0.75, 0.9, 1.0])
def test_restitution_and_roughness_to_a_millionth(r, beta, offset, dimension):
    """Small steps in a short contact: the remaining errors of both are less than 1e-6."""
    duration, steps = 1e-7, 2000
    outcome = collide(r, beta, duration, steps, shot(offset, dimension, 0.4 * duration / steps))
    assert outcome.r == pytest.approx(r, abs=1e-6)
    assert outcome.beta == pytest.approx(beta, abs=1e-6)


def errors(r, beta, duration, steps, offset=1.0):
    outcomes = [
        collide(r, beta, duration, steps, shot(offset, 2, phase * duration / steps))
        for phase in PHASES
    ]
    return np.max([(abs(outcome.r - r), abs(outcome.beta - beta)) for outcome in outcomes], axis=0)


@pytest.mark.parametrize(("r", "beta"), [(0.5, 0.0), (0.7, -0.5), (0.9, 0.5)])
def test_second_order_in_the_step(r, beta):
    """At any phase of the step; from 10 to 160 steps errors fall as steps^-p, p > 1.7.

    The smallest r and beta are decisive: springs that act for whole steps would give p = 1.
    """
    coarse, fine = (errors(r, beta, 1e-8, steps) for steps in (10, 160))
    orders = np.log(coarse / fine) / math.log(16.0)
    assert np.all(orders > 1.7)


def test_first_order_in_the_duration():
    """The pair turns during the contact, by about t_c: an oblique contact has an error of
    O(t_c)."""
    long, short = (errors(0.8, 0.3, duration, 1000) for duration in (1e-2, 1e-3))
    orders = np.log10(long / short)
    assert orders == pytest.approx(1.0, abs=0.05)


def test_a_central_contact_does_not_depend_on_its_duration():
    long, short = (
        collide(0.8, -1.0, t_c, 50, shot(0.0, phase=0.3 * t_c / 50)) for t_c in (1, 1e-3)
    )
    assert long.r == pytest.approx(short.r, abs=1e-10)


@pytest.mark.parametrize("dimension", DIMENSIONS)
@pytest.mark.parametrize("steps", [3, 20])
def test_momentum_and_angular_momentum(steps, dimension):
    """Conserved to rounding, for long contacts and coarse steps."""
    outcome = collide(0.7, 0.3, 0.3, steps, shot(0.8, dimension, 0.01))
    for sum_of in (momentum, angular_momentum):
        assert sum_of(outcome.after) == pytest.approx(sum_of(outcome.before), abs=2e-14)


@pytest.mark.parametrize("beta", [-1.0, 1.0])
def test_energy_of_elastic_spheres(beta):
    """Smooth spheres conserve it for any t_c; for perfectly rough ones the spring retains O(t_c^2).
    The step's contribution falls at least as its square."""
    duration = 0.1 if beta == -1.0 else 1e-6
    lost = [
        max(abs(energy(outcome.after) / energy(outcome.before) - 1.0) for outcome in shots)
        for shots in (
            [collide(1.0, beta, duration, n, shot(1.0, 2, p * duration / n)) for p in PHASES]
            for n in (10, 40, 160)
        )
    ]
    assert lost[0] < 2e-4 and lost[1] < lost[0] / 14.0 and lost[2] < lost[1] / 14.0
