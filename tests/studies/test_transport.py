"""Diffusion of exponentials: coefficients, judges and rows of evidence of made-up gases."""

import numpy as np
import pytest
import xarray as xr
from tests.pages import DOCS

from roughgas import theory
from roughgas.base.files import module_of
from roughgas.claims.evidence import FAILS, HOLDS, QUALIFIED

STUDY = DOCS.parent / "studies" / "transport"
PACKING, T = 0.01, 0.6


@pytest.fixture(scope="module")
def coefficients():
    return module_of(STUDY, "coefficients")


def gas(kind, points, over=lambda r, beta: 1.0, dimension=2, error=1e-3):
    """A gas whose velocities are remembered as theory has it, D times `over`; spins as well."""
    q = theory.moment_of_inertia(dimension)
    nu = theory.collision_frequency(1.0, PACKING, dimension)
    temperature = 2.0 if kind == "K" else T
    unit = 1.0 if kind == "K" else nu * temperature**0.5
    per = {"K": 1.0 / nu**2, "lun": temperature**0.5 / nu}[kind]  # D_s over D*
    lag, delay = 0.16 * 2.0 ** np.arange(8) / unit, 0.16 * np.arange(91) / unit
    r, beta = (sorted({one[k] for one in points}) for k in range(2))
    shape = len(r), len(beta)
    squares, memory, spins = (np.empty((*shape, n)) for n in (8, 91, 91))
    for i, j in np.ndindex(shape):
        about = r[i], beta[j], dimension, q
        D = theory.self_diffusion(1.0, PACKING, *about) * nu * over(r[i], beta[j])
        x, n = lag * unit / D, delay * unit
        squares[i, j] = 2.0 * D * per * D * (x - 1.0 + np.exp(-x)) / unit
        memory[i, j] = temperature * np.exp(-n / D)
        lost = theory.rotational_diffusion(1.0, 1.0, PACKING, beta[j], dimension, q) * nu * q
        spins[i, j] = temperature / q * np.exp(-n / lost)
    grid = ("r", "beta")
    found = {
        "R": (grid, np.full(shape, 0.4)),
        "E_trans": (grid, np.full(shape, temperature / 2.0)),
        "mean_square_displacement": (
            (*grid, "lag", "moving"),
            np.repeat(squares[..., None], dimension, axis=-1),
        ),
        "velocity_autocorrelation": ((*grid, "delay"), memory),
        "spin_autocorrelation": ((*grid, "delay"), spins),
    }
    if points == [(1.0, -1.0)]:  # smooth particles do not spin
        del found["spin_autocorrelation"]
    for name in list(found)[2:]:
        dims, values = found[name]
        found[f"{name}_stderr"] = dims, error * np.abs(values)
        found[f"{name}_dof"] = dims, np.full(values.shape, 40.0)
    coordinates = {"r": r, "beta": beta, "lag": lag, "delay": delay}
    about = {"packing": PACKING, "dimension": dimension, "theory": kind}
    about |= {"inertia": q} if "spin_autocorrelation" in found else {}
    return xr.Dataset(found, coordinates, about | {"experiment": "made up", "particles": 500})


def elastic(error=1e-3):
    """Rough and smooth disks, then rough and smooth spheres."""
    places = [(beta, dimension) for dimension in (2, 3) for beta in (1.0, -1.0)]
    return [gas("K", [(1.0, b)], dimension=dimension, error=error) for b, dimension in places]


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("kind", ["K", "lun"])
def test_exponentials_have_the_coefficient_that_they_were_made_with(coefficients, kind, dimension):
    for beta in (-1.0, 0.3, 1.0):
        one = gas(kind, [(1.0, beta)], dimension=dimension).isel(r=0, beta=0)
        D = coefficients.expected(one)
        assert coefficients.by_displacement(one).value == pytest.approx(D, rel=3e-3)
        found = coefficients.by_memory(one, "velocity_autocorrelation")
        assert found.value == pytest.approx(D, rel=5e-3)  # a trapezium of 0.16 collisions
        if beta > -1.0:
            found = coefficients.by_memory(one, "spin_autocorrelation")
            assert found.value == pytest.approx(coefficients.expected_of_spins(one), rel=2e-2)


def test_a_memory_that_outlives_its_times_gives_no_coefficient(coefficients):
    one = gas("lun", [(0.9, 0.3)]).isel(r=0, beta=0)
    whole = coefficients.by_memory(one, "velocity_autocorrelation")
    cut = coefficients.by_memory(one.isel(delay=slice(20)), "velocity_autocorrelation")
    assert np.isfinite(whole.stderr) and np.isnan(cut.stderr)
    assert cut.value < 0.97 * whole.value


@pytest.mark.parametrize(("over", "verdict"), [(1.0, HOLDS), (1.015, QUALIFIED), (1.05, FAILS)])
def test_the_ratio_of_rough_and_smooth_is_judged(over, verdict):
    judges = module_of(STUDY, "judges")
    rough = gas("K", [(1.0, 1.0)], lambda r, beta: over, error=2e-4)
    gases = rough, *elastic(error=2e-4)[1:]
    assert judges.rough_diffuse_less(*gases).verdict == verdict


@pytest.mark.parametrize(("over", "verdict"), [(1.0, HOLDS), (1.06, QUALIFIED), (1.2, FAILS)])
def test_a_driven_gas_is_judged_at_every_point(over, verdict):
    judges = module_of(STUDY, "judges")
    points = [(r, beta) for r in (0.7, 0.9) for beta in (-0.5, 1.0)]
    one = gas("lun", points, lambda r, beta: over if (r, beta) == (0.7, 1.0) else 1.0)
    assert judges.driven_gas_diffuses(one).verdict == verdict


def test_every_point_has_its_rows():
    gases = *elastic(), gas("lun", [(0.9, -0.5), (0.9, 1.0)])
    rows = list(module_of(STUDY, "evidence").rows(*gases))
    # two ways of each point, spins where they change, and two ratios
    assert len(rows) == 2 * (2 + 2 + 1) + 2 + 2 * 3
    assert all(row.verdict == "agrees" for row in rows if "D of" in row.quantity)
