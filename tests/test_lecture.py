"""The numbers in docs/lecture.md are computed, here, from the library's theory."""

import math
from pathlib import Path

import pytest

from roughgas import theory

PAGE = " ".join((Path(__file__).parents[1] / "docs" / "lecture.md").read_text("utf-8").split())
Q = 0.5


def contact(beta):
    """What goes into spin, stays in translation and is lost, in shares of the sliding energy."""
    into_spin = 4 * theory.rotational_energy_change(1.0, 0.0, 0.0, beta, Q)
    stays = 1 + 4 * theory.translational_energy_change(0.0, 1.0, 0.0, 0.0, 1.0, beta, Q)
    return into_spin, stays, 1 - into_spin - stays


def listed(values):
    """Values as a sentence lists them."""
    *others, last = [f"{value:.3f}" for value in values]
    return f"{', '.join(others)} and {last}"


@pytest.mark.parametrize("beta", [-1, 0, 1])
def test_one_contact(beta):
    shares = contact(beta)
    row = " | ".join(f"{abs(share):.3f}" for share in shares)
    assert f"| {str(beta).replace('-', '−')} | {row} |" in PAGE
    assert shares[2] == pytest.approx((1 - beta**2) * Q / (1 + Q), abs=1e-15)


def test_lun():
    values = [theory.lun_ratio(beta, Q) for beta in (-0.5, 0, 0.5, 1)]
    assert f"(1 + β)/(5 − β): {listed(values)}. R = 1/4 at β = 0.2." in PAGE
    assert theory.lun_ratio(0.2, Q) == pytest.approx(0.25)


def test_the_cooling_gas():
    said = [f"{theory.cooling_ratio(r, -0.8):.3f} at r = {r}" for r in (0.8, 0.9, 0.99)]
    assert f"R = {said[0]}, {said[1]}, and {said[2]}." in PAGE


def test_how_fast_it_cools():
    half = [
        math.log(2) / theory.collision_rates(r, -1.0, 2, Q).translational_loss for r in (0.9, 0.99)
    ]
    assert f"= {half[0]:.1f} collisions per disk; at r = 0.99 after {half[1]:.1f}." in PAGE


def test_rings_and_disks():
    values = [theory.lun_ratio(0, q) for q in (1, 0.5, 0.1)]
    assert f"R = q/(1 + 3q): {listed(values)}." in PAGE
