"""One contact of soft spheres: r and beta, orders, conservation, an independent integration."""

import math

import numpy as np
import pytest

from accuracy.soft_spheres.pair import angular_momentum, collide, energy, momentum, shot

PHASES = np.linspace(0.03, 1.03, 12, endpoint=False)  # in steps: where in a step a contact begins
DIMENSIONS = [2, pytest.param(3, marks=pytest.mark.slow)]  # each compiles a kernel of its own
BETAS = [-1.0, -0.5, 0.0, 0.5, 1.0]


@pytest.mark.parametrize("dimension", DIMENSIONS)
@pytest.mark.parametrize("offset", [0.0, 1.0])
@pytest.mark.parametrize("beta", BETAS)
@pytest.mark.parametrize("r", [0.5, 0.75, 0.9, 1.0])
def test_restitution_and_roughness_to_a_millionth(r, beta, offset, dimension):
    """Small steps in a short contact: what is left of either error is less than 1e-6."""
    duration, steps = 1e-7, 2000
    found = collide(r, beta, duration, steps, shot(offset, dimension, 0.4 * duration / steps))
    assert found.r == pytest.approx(r, abs=1e-6)
    assert found.beta == pytest.approx(beta, abs=1e-6)


def errors(r, beta, duration, steps, offset=1.0):
    found = [
        collide(r, beta, duration, steps, shot(offset, 2, phase * duration / steps))
        for phase in PHASES
    ]
    return np.max([(abs(one.r - r), abs(one.beta - beta)) for one in found], axis=0)


@pytest.mark.parametrize(("r", "beta"), [(0.5, 0.0), (0.7, -0.5), (0.9, 0.5)])
def test_second_order_in_the_step(r, beta):
    """Wherever in a step a contact begins; from 10 to 160 steps errors fall as steps^-p, p > 1.7.

    The least r and beta tell: springs that are on for whole steps only would give p = 1.
    """
    coarse, fine = (errors(r, beta, 1e-8, steps) for steps in (10, 160))
    orders = np.log(coarse / fine) / math.log(16.0)
    assert np.all(orders > 1.7)


def test_first_order_in_the_duration():
    """The pair turns while it is in contact, by about t_c: an oblique contact is off by O(t_c)."""
    long, short = (errors(0.8, 0.3, duration, 1000) for duration in (1e-2, 1e-3))
    orders = np.log10(long / short)
    assert orders == pytest.approx(1.0, abs=0.05)


def test_a_central_contact_does_not_know_its_duration():
    long, short = (
        collide(0.8, -1.0, t_c, 50, shot(0.0, phase=0.3 * t_c / 50)) for t_c in (1, 1e-3)
    )
    assert long.r == pytest.approx(short.r, abs=1e-10)


@pytest.mark.parametrize("dimension", DIMENSIONS)
@pytest.mark.parametrize("steps", [3, 20])
def test_momentum_and_angular_momentum(steps, dimension):
    """To rounding, however long the contact and coarse the step."""
    found = collide(0.7, 0.3, 0.3, steps, shot(0.8, dimension, 0.01))
    for of in (momentum, angular_momentum):
        assert of(found.after) == pytest.approx(of(found.before), abs=2e-14)


@pytest.mark.parametrize("beta", [-1.0, 1.0])
def test_energy_of_elastic_spheres(beta):
    """Smooth ones conserve it for any t_c, with perfectly rough ones what is left in the spring is
    O(t_c^2); the step's part falls at least as its square."""
    duration = 0.1 if beta == -1.0 else 1e-6
    lost = [
        max(abs(energy(one.after) / energy(one.before) - 1.0) for one in shots)
        for shots in (
            [collide(1.0, beta, duration, n, shot(1.0, 2, p * duration / n)) for p in PHASES]
            for n in (10, 40, 160)
        )
    ]
    assert lost[0] < 2e-4 and lost[1] < lost[0] / 14.0 and lost[2] < lost[1] / 14.0
