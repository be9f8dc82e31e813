"""Rows of studies without tasks: published formulas, and corrections checked by random draws."""

import numpy as np
import pytest
from tests.study_modules import module_of_study
from tests.synthetic import mixed, reduced

from roughgas.results.row_verdicts import AGREES, DIFFERS, verdicts

mixtures, spheres = module_of_study("mixtures", "evidence"), module_of_study("spheres", "evidence")


@pytest.mark.parametrize(("shift", "verdict"), [(0.0, AGREES), (0.05, DIFFERS)])
def test_sheared_spheres_are_compared_with_the_formula_of_rings(shift, verdict):
    """The same as Lun's: R = 2 (1 + beta)/(14 - 3 (1 + beta))."""
    gas = reduced("sheared_spheres", lambda r, beta: shift + 0.0 * beta, (0.9,), (-0.5, 0.0, 1.0))
    gas["R"] = gas.R + gas.R * (1 - gas.R) / 160  # translation has D (N - 1) degrees of freedom
    rows = list(spheres.rows(gas))
    assert [row.theirs.value for row in rows] == pytest.approx([1 / 12.5, 2 / 11, 1 / 2])
    assert verdicts(rows) == 3 * [verdict]


def test_two_species_agree_with_theory():
    """R of both and their ratio; a gas on theory has a lower T_tr, as its momentum is fixed."""
    alike = [
        {"name": name, "fraction": 0.5, "radius": 1, "mass": 1} for name in ("first", "second")
    ]
    options = {"r": (0.9,), "beta": (0.0, 1.0), "species": alike}
    gas = mixed("cooling_masses", ("species.second.mass", (1.0, 4.0)), **options)
    rows = list(mixtures.rows(gas))
    assert len(rows) == 12 and {row.theirs.stderr for row in rows} == {0.0}
    equal = [row for row in rows if "mass = 1," in row.at and row.quantity.startswith("R")]
    for row in equal:  # translation has D (N - 1) degrees of freedom
        R, thermal = row.theirs.value, 1 - 1 / gas.attrs["particles"]
        assert row.ours.value == pytest.approx(R * thermal / (R * thermal + 1 - R))
    ratios = [row for row in rows if row.quantity.startswith("T_2")]
    assert all(abs(row.gap.value) < 0.03 for row in ratios)


def test_thermal_shares_of_two_species_without_momentum():
    """Random velocities with the centre of mass at rest; 4 sigma fail once in 8000."""
    rng, T, m, draws = np.random.default_rng(9), np.array([1.0, 1.5]), np.array([1.0, 4.0]), 40_000
    v = rng.standard_normal((draws, 2, 5)) * np.sqrt(T / m)[:, None]
    v -= (m[:, None] * v).sum(axis=(1, 2), keepdims=True) / (5 * m.sum())
    shares = np.mean(m[:, None] * v**2, axis=-1) / T
    expected = mixtures.thermal_share(T, 4.0, 10)
    error = shares.std(axis=0) / np.sqrt(draws)
    assert np.all(np.abs(shares.mean(axis=0) - expected) < 4 * error)
