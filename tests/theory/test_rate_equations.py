"""The rate equations: the paper's averages put into its energy changes, and their steady states."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from roughgas import theory

interior = {
    "r": st.floats(0, 1),
    "beta": st.floats(-0.999, 1),
    "q": st.floats(0.05, 1),
    "dimension": st.sampled_from([2, 3]),
}
share = st.floats(0, 1)


@settings(derandomize=True, deadline=None)
@given(**interior, T_tr=st.floats(0, 5), T_rot=st.floats(0, 5))
def test_rates_are_the_averaged_energy_changes(r, beta, q, dimension, T_tr, T_rot):
    v_t2 = theory.mean_tangential_squared(T_tr / 2, dimension)
    v_r2 = theory.mean_spin_squared(T_rot / 2, dimension, q)
    v_n2 = theory.mean_normal_squared(T_tr / 2)
    rate_tr, rate_rot = theory.temperature_changes(T_tr, T_rot, r, beta, dimension, q, 3.0)
    change_tr = theory.translational_energy_change(v_n2, v_t2, 0, v_r2, r, beta, q)
    change_rot = theory.rotational_energy_change(v_t2, 0, v_r2, beta, q)
    assert rate_tr == pytest.approx(3 * change_tr / dimension, abs=1e-12)
    assert rate_rot == pytest.approx(3 * change_rot / (2 * dimension - 3), abs=1e-11)


@settings(derandomize=True, deadline=None)
@given(**interior)
def test_free_cooling_is_stationary_at_equation_K(r, beta, q, dimension):
    R = theory.stationary_ratio(r, beta, dimension, q)
    assert pytest.approx(theory.cooling_ratio(r, beta, dimension, q), rel=1e-10) == R
    rate_tr, rate_rot = theory.temperature_changes(1 - R, R, r, beta, dimension, q)
    assert R * rate_tr == pytest.approx((1 - R) * rate_rot, abs=1e-14)


@settings(derandomize=True, deadline=None)
@given(**interior)
def test_translational_drive_is_equation_lun(r, beta, q, dimension):
    R = theory.stationary_ratio(r, beta, dimension, q, spin_share=0)
    assert pytest.approx(theory.lun_ratio(beta, q), rel=1e-13) == R


@settings(derandomize=True, deadline=None)
@given(**interior, s=share)
def test_drive_balances_collisions_where_stationary(r, beta, q, dimension, s):
    """With the power that the collisions dissipate, both temperatures stand still."""
    R = theory.stationary_ratio(r, beta, dimension, q, spin_share=s)
    by_collisions = theory.temperature_changes(1 - R, R, r, beta, dimension, q)
    power = -(dimension * by_collisions[0] + (2 * dimension - 3) * by_collisions[1]) / 2
    by_drive = theory.drive_changes(max(power, 0), s, dimension)
    assert np.add(by_collisions, by_drive) == pytest.approx(0, abs=1e-14)


@pytest.mark.parametrize("dimension", [2, 3])
def test_R_grows_with_the_share_of_spin_between_the_two_limits(dimension):
    shares = np.linspace(0, 1, 21)
    R = theory.stationary_ratio(0.9, -0.3, dimension, spin_share=shares)
    assert R[0] == pytest.approx(theory.lun_ratio(-0.3, theory.moment_of_inertia(dimension)))
    assert R[-1] > 0.5 > R[0]
    assert (np.diff(R) > 0).all()


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("s", [None, 0, 0.3, 1])
@pytest.mark.parametrize("r", [0.5, 1])
def test_smooth_limit_is_approached_from_above(dimension, s, r):
    at, near = theory.stationary_ratio(r, np.array([-1, -1 + 1e-10]), dimension, spin_share=s)
    assert at == pytest.approx(near, abs=1e-8)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_drive_may_take_rotation_out(dimension):
    """Then collisions must bring it there: their changes of the energies are as -(1 - s) : -s."""
    R = theory.stationary_ratio(0.9, 0.5, dimension, spin_share=-0.05)
    assert 0.0 < R < theory.stationary_ratio(0.9, 0.5, dimension, spin_share=0.0)
    translational, rotational = theory.temperature_changes(1 - R, R, 0.9, 0.5, dimension)
    lost = dimension * translational, (2 * dimension - 3) * rotational
    assert lost[1] / sum(lost) == pytest.approx(-0.05, rel=1e-12)
    assert theory.stationary_ratio(0.9, 0.5, 2, spin_share=-1.0) == 0.0


def test_theta_is_infinite_where_all_energy_is_spin():
    assert np.isinf(theory.stationary_theta(0.9, -1))
    assert theory.stationary_theta(0.9, -1, spin_share=0) == 0
