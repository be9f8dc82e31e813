"""Rows of studies that have no tasks: published formulas, and corrections found by drawing."""

import numpy as np
import pytest
from tests.houses import part
from tests.synthetic import mixed, reduced

from roughgas.results.evidence import AGREES, DIFFERS

mixtures, spheres = part("mixtures", "evidence"), part("spheres", "evidence")


@pytest.mark.parametrize(("shift", "verdict"), [(0.0, AGREES), (0.05, DIFFERS)])
def test_sheared_spheres_stand_beside_the_formula_of_rings(shift, verdict):
    """The same as Lun's: R = 2 (1 + beta)/(14 - 3 (1 + beta))."""
    gas = reduced("sheared_spheres", lambda r, beta: shift + 0.0 * beta, (0.9,), (-0.5, 0.0, 1.0))
    gas["R"] = gas.R + gas.R * (1 - gas.R) / 160  # translation has D (N - 1) degrees of freedom
    found = list(spheres.rows(gas))
    assert [row.theirs.value for row in found] == pytest.approx([1 / 12.5, 2 / 11, 1 / 2])
    assert [row.verdict for row in found] == 3 * [verdict]


def test_two_species_stand_beside_theory():
    """R of both and their ratio; a gas as in theory has less of T_tr, as its momentum is fixed."""
    alike = [
        {"name": name, "fraction": 0.5, "radius": 1, "mass": 1} for name in ("first", "second")
    ]
    how = {"r": (0.9,), "beta": (0.0, 1.0), "species": alike}
    gas = mixed("cooling_masses", ("species.second.mass", (1.0, 4.0)), **how)
    found = list(mixtures.rows(gas))
    assert len(found) == 12 and {row.theirs.stderr for row in found} == {0.0}
    equal = [row for row in found if "mass = 1," in row.at and row.quantity.startswith("R")]
    for row in equal:  # translation has D (N - 1) degrees of freedom
        R, kept = row.theirs.value, 1 - 1 / gas.attrs["particles"]
        assert row.ours.value == pytest.approx(R * kept / (R * kept + 1 - R))
    ratios = [row for row in found if row.quantity.startswith("T_2")]
    assert all(abs(row.gap.value) < 0.03 for row in ratios)


def test_what_two_species_keep_without_momentum():
    """Velocities drawn, and the centre of mass brought to rest; 4 sigma fail once in 8000."""
    rng, T, m, draws = np.random.default_rng(9), np.array([1.0, 1.5]), np.array([1.0, 4.0]), 40_000
    v = rng.standard_normal((draws, 2, 5)) * np.sqrt(T / m)[:, None]
    v -= (m[:, None] * v).sum(axis=(1, 2), keepdims=True) / (5 * m.sum())
    seen = np.mean(m[:, None] * v**2, axis=-1) / T
    expected = mixtures.share_kept(T, 4.0, 10)
    error = seen.std(axis=0) / np.sqrt(draws)
    assert np.all(np.abs(seen.mean(axis=0) - expected) < 4 * error)
