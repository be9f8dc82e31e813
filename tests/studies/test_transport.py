"""Transport of made-up gases: coefficients, judges and rows of evidence."""

import itertools

import numpy as np
import pytest
import xarray as xr
from tests.pages import DOCS

from roughgas import simulate, theory
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


SHEARED = 100.0  # length of the box
ABOUT = {"packing": PACKING, "dimension": 2, "inertia": 0.5, "particles": 500, "theory": "lun"}
ABOUT |= {"experiment": "made up"}


def strained(over, error=1e-3):
    """Gases in shear, of `over(r, beta)` times theory's viscosity and less at a higher rate."""
    r, beta, velocity = [0.7, 0.9], [-0.5, 1.0], [0.2, 0.4]
    n, found = theory.number_density(PACKING, 2), np.empty((2, 2, 2))
    hot = np.array([T, 1.1 * T])
    for k, i, j in np.ndindex(found.shape):
        expected = theory.shear_viscosity(hot[k], 0.3, PACKING, r[i], beta[j], 2, 0.5)
        rate = velocity[k] / SHEARED
        found[k, i, j] = over(r[i], beta[j]) * expected * (1 - 3e4 * rate**2 / hot[k]) * rate**2 / n
    grid = ("velocity", "r", "beta")
    energy = np.broadcast_to(hot[:, None, None] * 499 / 1000, found.shape)
    values = {"R": (grid, np.full(found.shape, 0.4)), "E_trans": (grid, energy)}
    values |= {"E_rot": (grid, np.full(found.shape, 0.15)), "shear_power": (grid, found)}
    values |= {"shear_power_stderr": (grid, error * found)}
    values |= {"shear_power_dof": (grid, np.full(found.shape, 40.0))}
    rate = np.array(velocity)[:, None, None] / SHEARED
    stress = np.zeros((*found.shape, 2, 2))
    stress[..., 0, 1] = -n * found / rate
    for part, share in (("kinetic", 0.9), ("collisional", 0.1)):
        values[f"stress_{part}"] = (*grid, "component", "along"), share * stress
    axes = {"component": ["x", "y"], "along": ["x", "y"]}
    return xr.Dataset(values, {"velocity": velocity, "r": r, "beta": beta, **axes}, ABOUT)


def fluxes(beta, dimension, over, error=1e-3):
    """An elastic gas in equilibrium whose memories are exponentials, of 1 collision and of 2."""
    q = None if beta == -1.0 else theory.moment_of_inertia(dimension)
    passed = 0.2 * np.arange(80)
    delay = passed / theory.collision_frequency(T, PACKING, dimension)
    last = {
        "viscosity": theory.shear_viscosity(T, T, PACKING, 1.0, beta, dimension, q),
        "conductivity": theory.thermal_conductivity(T, dimension, PACKING, q),
    }
    grid = ("r", "beta", "delay")
    values = {"E_trans": (grid[:2], [[T * 499 / 1000]])}
    for (name, one), memory in zip(last.items(), (1.0, 2.0), strict=True):
        until = over * one * (1 - np.exp(-passed / memory))
        values[f"{name}_until"] = grid, until[None, None]
        values[f"{name}_until_stderr"] = grid, np.full((1, 1, 80), error * one)
        values[f"{name}_until_dof"] = grid, np.full((1, 1, 80), 40.0)
    about = ABOUT | {"dimension": dimension, "inertia": q, "experiment": f"{dimension} {beta}"}
    about = {name: one for name, one in about.items() if name != "inertia" or q}
    return xr.Dataset(values, {"r": [1.0], "beta": [beta], "delay": delay}, about)


def walled(beta, over, dimension=2, error=1e-3):
    """An elastic gas through which heat flows down from a hot lid, in Fourier's profile."""
    q = None if beta == -1.0 else theory.moment_of_inertia(dimension)
    height = SHEARED * (np.arange(40) + 0.5) / 40
    profile, packing = (1.0 + height / SHEARED) ** (2 / 3), np.zeros(40)
    # kappa ~ T^(1/2)
    flux = over * theory.thermal_conductivity(1.0, dimension, 0.0, q) * 2 / 3 / SHEARED
    flux *= (SHEARED - 2.0) / SHEARED
    grid, axes = ("r", "beta"), list("xyz"[:dimension])
    values = {"heat_flux": ((*grid, "component"), [[[0.0] * (dimension - 1) + [-flux]]])}
    values["heat_flux_stderr"] = (*grid, "component"), [[[error * flux] * dimension]]
    values["heat_flux_dof"] = (*grid, "component"), [[[40.0] * dimension]]
    layers = np.broadcast_to(profile[:, None], (1, 1, 40, dimension))
    values["temperature_profile"] = (*grid, "height", "component"), layers
    values["temperature_profile_stderr"] = (*grid, "height", "component"), 1e-4 * layers
    values["packing_profile"] = (*grid, "height"), packing[None, None]
    coordinates = {"r": [1.0], "beta": [beta], "height": height, "component": axes}
    about = {name: one for name, one in ABOUT.items() if name != "inertia"}
    about |= {"inertia": q} if q else {}
    about |= {"experiment": f"walls {beta} {dimension}", "dimension": dimension}
    return xr.Dataset(values, coordinates, about)


def test_made_up_gases_have_the_viscosity_and_conductivity_that_they_were_made_with(coefficients):
    """Exactly in shear, where what a rate changes is extrapolated; to 2 % by memory, which is cut
    off and integrated in trapezia; to 1e-4 between walls."""
    slow, fast, none = coefficients.in_shear(strained(lambda r, beta: 1.1).sel(r=0.7, beta=1.0))
    assert none.value == pytest.approx(1.1, rel=1e-9)
    assert fast.value < slow.value < 1.1 and none.stderr > slow.stderr
    for dimension, beta in np.ndindex(2, 2):
        one = fluxes([-1.0, 1.0][beta], dimension + 2, 1.1).isel(r=0, beta=0)
        for name in coefficients.REMEMBERED:
            assert coefficients.in_equilibrium(one, name)[-1].value == pytest.approx(1.1, rel=0.02)
    for beta, dimension in itertools.product((-1.0, 1.0), (2, 3)):
        found = coefficients.between_walls(walled(beta, 1.1, dimension).isel(r=0, beta=0))
        assert found.value == pytest.approx(1.1, rel=1e-4)


@pytest.mark.parametrize(("over", "verdict"), [(1.0, HOLDS), (1.06, QUALIFIED), (1.2, FAILS)])
def test_viscosity_and_conductivity_are_judged(over, verdict):
    judges = module_of(STUDY, "judges")
    one = strained(lambda r, beta: over if (r, beta) == (0.7, 1.0) else 1.0)
    assert judges.driven_gas_is_viscous(one).verdict == verdict
    two = fluxes(-1.0, 2, 1.0), fluxes(1.0, 3, over)
    assert judges.elastic_gases_carry(*two).verdict == verdict
    found = judges.heat_flows_between_walls(walled(-1.0, over), walled(1.0, 1.0))
    assert found.verdict == verdict
    pairs = walled(-1.0, 0.9), walled(-1.0, 0.9 * over), *[walled(1.0, 1.1, 3)] * 2
    assert judges.walls_do_not_matter(*pairs).verdict == verdict


def test_every_point_has_its_rows():
    gases = *elastic(), gas("lun", [(0.9, -0.5), (0.9, 1.0)]), strained(lambda r, beta: 1.0)
    others = fluxes(1.0, 2, 1.0), walled(1.0, 1.0)
    rows = list(module_of(STUDY, "evidence").rows(*gases, *others))
    # two ways of each point, spins where they change, two ratios, and viscosity and conductivity
    assert len(rows) == 2 * (2 + 2 + 1) + 2 + 2 * 3 + 4 + 2 + 1
    named = "D of", "viscosity of driven", "between walls"
    assert all(row.verdict == "agrees" for row in rows if any(x in row.quantity for x in named))


@pytest.mark.slow  # compiles a kernel
def test_gases_between_walls_have_a_row():
    """As they are simulated, in a box that is given by its lengths or by its packing."""
    schedule = {"equilibrate": 10, "measure": 300, "sample_every": 5}
    evidence = module_of(STUDY, "evidence")
    for room in ({}, {"box": (30, 40)}):
        one = simulate(
            "transport.rough_disks_between_walls", r=[1.0], beta=[1.0], seed=[1, 2],
            scale="small", schedule=schedule, particles=20, progress=False, **room,
        )  # fmt: skip
        (row,) = evidence._of_elastic(one.isel(r=0, beta=0))
        assert row.quantity == "conductivity of rough elastic disks between walls over theory"
        assert "N = 20" in row.at and np.isfinite(row.ours.stderr)
