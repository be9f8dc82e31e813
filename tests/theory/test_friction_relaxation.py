"""How fast R of a cooling gas with friction settles."""

import numpy as np
import pytest

from roughgas import theory

GASES = [(0.9, 0.0, 2), (0.9, -0.5, 2), (0.8, 1.0, 2), (0.9, 0.5, 3)]


@pytest.mark.parametrize(("r", "beta", "dimension"), GASES)
def test_without_sliding_it_is_that_of_the_rate_equations(r, beta, dimension):
    found = theory.friction_relaxation_rate(r, beta, np.inf, dimension)
    assert found == pytest.approx(theory.relaxation_rate(r, beta, dimension), rel=1e-6)


@pytest.mark.parametrize("mu", [0.02, 0.15, 0.5, 2.0])
@pytest.mark.parametrize(("r", "beta", "dimension"), GASES)
def test_a_small_deviation_fades_at_this_rate(r, beta, dimension, mu):
    """Integrated in small steps: a deviation of theta, or 1/theta where R goes to 1."""
    rate = theory.friction_relaxation_rate(r, beta, mu, dimension)
    R = theory.friction_ratio(r, beta, mu, dimension)
    runaway = R == 1.0
    theta = 1e7 if runaway else 1.001 * R / (1 - R)
    steps, length = 500, 1.0 / rate
    for _ in range(steps):
        T_tr, T_rot = theory.friction_changes(1.0, theta, r, beta, mu, dimension)
        theta *= np.exp((T_rot / theta - T_tr) * length / steps)
    if runaway:
        assert np.log(theta / 1e7) == pytest.approx(1.0, abs=0.01)
    else:
        left = (theta * (1 - R) / R - 1.0) / 0.001
        assert left == pytest.approx(np.exp(-1.0), abs=0.01)


def test_decoupled_spin_does_not_relax():
    assert theory.friction_relaxation_rate(0.9, 0.0, 0.0) == 0.0
    assert theory.friction_relaxation_rate(0.9, -1.0, 0.5) == 0.0


@pytest.mark.parametrize(("r", "beta", "dimension"), GASES)
def test_spins_that_dominate_are_kept_up_to_the_critical_friction(r, beta, dimension):
    """d ln theta/dn at theta = 1e8, a little below mu_c and a little above."""
    critical = theory.critical_friction(r)
    for mu, kept in ((0.99 * critical, True), (1.01 * critical, False)):
        T_tr, T_rot = theory.friction_changes(1.0, 1e8, r, beta, mu, dimension)
        assert (T_rot / 1e8 > T_tr) == kept
