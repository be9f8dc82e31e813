"""Transport of made-up gases: coefficients, judges and rows of evidence."""

import itertools

import numpy as np
import pytest
import xarray as xr
from tests.pages import DOCS

from roughgas import simulate, theory
from roughgas.base.files import study_module
from roughgas.claims.verdicts import FAILS, HOLDS, QUALIFIED
from roughgas.judging import Estimate, NotTestedError
from roughgas.results import long_table
from roughgas.results.row_verdicts import AGREES, verdicts

STUDY = DOCS.parent / "studies" / "transport"
PACKING, T = 0.01, 0.6


@pytest.fixture(scope="module")
def coefficients():
    return study_module(STUDY, "coefficients")


def gas(kind, points, over=lambda r, beta: 1.0, dimension=2, error=1e-3):
    """Return a gas with the velocity memory of theory, and D multiplied by `over`; the same for
    spins."""
    q = theory.moment_of_inertia(dimension)
    nu = theory.collision_frequency(1.0, PACKING, dimension)
    temperature = 2.0 if kind == "K" else T
    unit = 1.0 if kind == "K" else nu * temperature**0.5
    per = {"K": 1.0 / nu**2, "lun": temperature**0.5 / nu}[kind]  # D_s over D*
    lag, delay = 0.16 * 2.0 ** np.arange(8) / unit, 0.16 * np.arange(91) / unit
    r, beta = (sorted({point[k] for point in points}) for k in range(2))
    shape = len(r), len(beta)
    squares, memory, spins = (np.empty((*shape, n)) for n in (8, 91, 91))
    for i, j in np.ndindex(shape):
        parameters = r[i], beta[j], dimension, q
        D = theory.self_diffusion(1.0, PACKING, *parameters) * nu * over(r[i], beta[j])
        x, n = lag * unit / D, delay * unit
        squares[i, j] = 2.0 * D * per * D * (x - 1.0 + np.exp(-x)) / unit
        memory[i, j] = temperature * np.exp(-n / D)
        spin_diffusion = (
            theory.rotational_diffusion(1.0, 1.0, PACKING, beta[j], dimension, q) * nu * q
        )
        spins[i, j] = temperature / q * np.exp(-n / spin_diffusion)
    grid = ("r", "beta")
    variables = {
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
        del variables["spin_autocorrelation"]
    for name in list(variables)[2:]:
        dims, values = variables[name]
        variables[f"{name}_stderr"] = dims, error * np.abs(values)
        variables[f"{name}_dof"] = dims, np.full(values.shape, 40.0)
    coordinates = {"r": r, "beta": beta, "lag": lag, "delay": delay}
    attributes = {"packing": PACKING, "dimension": dimension, "theory": kind}
    attributes |= {"inertia": q} if "spin_autocorrelation" in variables else {}
    return xr.Dataset(
        variables, coordinates, attributes | {"experiment": "made up", "particles": 500}
    )


def elastic(error=1e-3):
    """Return rough and smooth disks, then rough and smooth spheres."""
    gases = [(beta, dimension) for dimension in (2, 3) for beta in (1.0, -1.0)]
    return [gas("K", [(1.0, b)], dimension=dimension, error=error) for b, dimension in gases]


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("kind", ["K", "lun"])
def test_exponential_memories_give_their_coefficient(coefficients, kind, dimension):
    for beta in (-1.0, 0.3, 1.0):
        point = gas(kind, [(1.0, beta)], dimension=dimension).isel(r=0, beta=0)
        D = coefficients.expected(point)
        assert coefficients.by_displacement(point).value == pytest.approx(D, rel=3e-3)
        diffusion = coefficients.by_memory(point, "velocity_autocorrelation")
        assert diffusion.value == pytest.approx(D, rel=5e-3)  # a trapezium of 0.16 collisions
        if beta > -1.0:
            diffusion = coefficients.by_memory(point, "spin_autocorrelation")
            assert diffusion.value == pytest.approx(coefficients.expected_of_spins(point), rel=2e-2)


def test_a_memory_that_outlives_its_times_gives_no_coefficient(coefficients):
    point = gas("lun", [(0.9, 0.3)]).isel(r=0, beta=0)
    complete = coefficients.by_memory(point, "velocity_autocorrelation")
    cut = coefficients.by_memory(point.isel(delay=slice(20)), "velocity_autocorrelation")
    assert np.isfinite(complete.stderr) and np.isnan(cut.stderr)
    assert cut.value < 0.97 * complete.value


@pytest.mark.parametrize(("over", "verdict"), [(1.0, HOLDS), (1.015, QUALIFIED), (1.05, FAILS)])
def test_the_ratio_of_rough_and_smooth_is_judged(over, verdict):
    judges = study_module(STUDY, "judges")
    rough = gas("K", [(1.0, 1.0)], lambda r, beta: over, error=2e-4)
    gases = rough, *elastic(error=2e-4)[1:]
    assert judges.rough_diffuse_less(*gases).verdict == verdict


def without_positions(over=None, error=1e-3):
    """Return the dataset of tasks whose coefficients over first approximations are `over` by
    (quantity, kind, q) or (r, beta), else published or 1; of smooth gases (q = 0) and of rough
    ones, by both methods, and of driven disks."""
    dilute, over = study_module(STUDY, "dilute"), over or {}
    rows = []
    for quantity, kind in itertools.product(("viscosity", "conductivity"), ("disks", "spheres")):
        for q, method in itertools.product((0.0, 0.4), ("equilibrium", "forced")):
            published = dilute.PUBLISHED[quantity, kind]
            expected = dilute.corrected(quantity, kind, q) if q else published
            value = over.get((quantity, kind, q), over.get((quantity, kind, q, method), expected))
            small = (0, 0.0) if method == "equilibrium" else (1000, 0.0)
            material = (1.0, 1.0 if q else -1.0, q or 0.4)
            rows.append((quantity, method, kind, *material, *small, value))
    for point in itertools.product((0.7, 0.9), (-0.5, 1.0)):
        value = over.get(point, 0.98)
        rows.append(("diffusion", "driven", "disks", *point, 0.5, 1000, 0.0, value))
    names = ("quantity", "method", "kind", "r", "beta", "inertia", "particles", "force", "value")
    columns = {
        name: ("row", list(x)) for name, x in zip(names, zip(*rows, strict=True), strict=True)
    }
    columns |= {"value_stderr": ("row", [error] * len(rows))}
    columns |= {"value_dof": ("row", [40.0] * len(rows)), "seconds": ("row", [1.0] * len(rows))}
    return xr.Dataset(columns, attrs={"scale": "small"})


@pytest.mark.parametrize(
    ("over", "verdict"), [(0.98, HOLDS), (0.96, QUALIFIED), (1.04, QUALIFIED), (0.9, FAILS)]
)
def test_a_driven_gas_is_judged_at_every_point(over, verdict):
    judges = study_module(STUDY, "judges")
    data = without_positions({(0.7, 1.0): over})
    assert judges.driven_gas_diffuses(data).verdict == verdict
    driven = gas("lun", [(r, b) for r in (0.7, 0.9) for b in (-0.5, 1.0)], lambda r, b: over)
    data = without_positions({(r, b): over for r in (0.7, 0.9) for b in (-0.5, 1.0)})
    assert judges.events_diffuse_as_dsmc(driven, data).verdict == HOLDS
    shifted = without_positions({(r, b): over + 0.015 for r in (0.7, 0.9) for b in (-0.5, 1.0)})
    assert judges.events_diffuse_as_dsmc(driven, shifted).verdict == QUALIFIED


VISCOSITY, CONDUCTIVITY = ("viscosity", "spheres", 0.4), ("conductivity", "spheres", 0.4)
DISKS = "conductivity", "disks", 0.4


@pytest.mark.parametrize(
    ("judge", "over", "verdict"),
    [
        ("smooth_spheres_carry", {}, HOLDS),
        ("smooth_disks_carry", {("viscosity", "disks", 0.0): 1.03}, QUALIFIED),
        ("smooth_disks_carry", {("viscosity", "disks", 0.0): 1.0}, FAILS),
        ("rough_gases_carry", {VISCOSITY: 1.02, CONDUCTIVITY: 0.98, DISKS: 1.0}, HOLDS),
        ("rough_gases_carry", {VISCOSITY: 1.045, CONDUCTIVITY: 1.0, DISKS: 1.0}, QUALIFIED),
        ("rough_gases_carry", {}, FAILS),
        ("correlated_spins_carry", {}, HOLDS),
        ("correlated_spins_carry", {CONDUCTIVITY: 1.11}, QUALIFIED),
        ("correlated_spins_carry", {CONDUCTIVITY: 1.15}, FAILS),
        ("methods_agree_on_conductivity", {}, HOLDS),
        ("methods_agree_on_viscosity", {(*VISCOSITY, "forced"): 1.07}, QUALIFIED),
        ("methods_agree_on_viscosity", {(*VISCOSITY, "forced"): 1.0}, FAILS),
    ],
)
def test_gases_without_positions_are_judged(judge, over, verdict):
    function = getattr(study_module(STUDY, "judges"), judge)
    assert function(without_positions(over)).verdict == verdict
    with pytest.raises(NotTestedError, match="an error is"):
        function(without_positions(over, error=0.02))


def test_spins_are_not_judged_where_nothing_is_to_be_explained():
    data = without_positions({VISCOSITY: 1.0, CONDUCTIVITY: 1.0, DISKS: 1.0})
    with pytest.raises(NotTestedError, match="within 3 % everywhere"):
        study_module(STUDY, "judges").correlated_spins_carry(data)


@pytest.mark.parametrize(("over", "verdict"), [(1.0, HOLDS), (1.04, QUALIFIED), (1.1, FAILS)])
def test_events_are_judged_beside_the_gas_without_positions(over, verdict):
    judges = study_module(STUDY, "judges")
    data = without_positions({VISCOSITY: 1.0, CONDUCTIVITY: 1.0})
    gases = fluxes(1.0, 3, 1.0), fluxes(1.0, 3, over).assign_attrs(particles=800)
    assert judges.events_carry_as_dsmc(data, *gases[::-1]).verdict == verdict
    with pytest.raises(NotTestedError):
        judges.events_carry_as_dsmc(data, fluxes(1.0, 3, over, error=0.03))


def test_limits_are_extrapolated():
    """Lines through exact points are met exactly; the error of two equal ones is sqrt(17)/3."""
    results = study_module(STUDY, "results")
    points = [(1 / n, Estimate(1.0 - 2.0 / n, 0.01, 50.0)) for n in (30, 120)]
    assert results.extrapolated(points) == pytest.approx((1.0, 0.01 * 17**0.5 / 3, 50.0))
    three = [*points, (1 / 60, Estimate(1.0 - 2.0 / 60, 0.01, 50.0))]
    assert results.extrapolated(three).value == pytest.approx(1.0)
    assert results.extrapolated(three).stderr < results.extrapolated(points).stderr


def test_the_long_table_has_every_row(tmp_path):
    """Of tasks and of event-driven gases; what is written is what is read."""
    long, data = study_module(STUDY, "long"), without_positions()
    rows = list(long.long_table(data, fluxes(1.0, 3, 1.1)))
    assert len(rows) == data.sizes["row"] + 2
    long_table.write_long_rows(rows, tmp_path / "long.csv")
    for row, written in zip(rows, long_table.read_long_rows(tmp_path / "long.csv"), strict=True):
        assert written[:2] == row[:2] and tuple(written.estimate) == pytest.approx(
            tuple(row.estimate), rel=1e-5
        )
        assert written.cpu_hours == pytest.approx(row.cpu_hours, rel=1e-5)
    assert rows[-1].parameters["packing"] == PACKING and rows[-1].parameters["kind"] == "spheres"


BOX_LENGTH = 100.0
ATTRIBUTES = {"packing": PACKING, "dimension": 2, "inertia": 0.5, "particles": 500, "theory": "lun"}
ATTRIBUTES |= {"experiment": "made up"}


def strained(over, error=1e-3):
    """Return sheared gases with `over(r, beta)` times theory's viscosity, and less at a higher
    rate."""
    r, beta, velocity = [0.7, 0.9], [-0.5, 1.0], [0.2, 0.4]
    n, power = theory.number_density(PACKING, 2), np.empty((2, 2, 2))
    hot = np.array([T, 1.1 * T])
    for k, i, j in np.ndindex(power.shape):
        expected = theory.shear_viscosity(hot[k], 0.3, PACKING, r[i], beta[j], 2, 0.5)
        rate = velocity[k] / BOX_LENGTH
        power[k, i, j] = over(r[i], beta[j]) * expected * (1 - 3e4 * rate**2 / hot[k]) * rate**2 / n
    grid = ("velocity", "r", "beta")
    energy = np.broadcast_to(hot[:, None, None] * 499 / 1000, power.shape)
    values = {"R": (grid, np.full(power.shape, 0.4)), "E_trans": (grid, energy)}
    values |= {"E_rot": (grid, np.full(power.shape, 0.15)), "shear_power": (grid, power)}
    values |= {"shear_power_stderr": (grid, error * power)}
    values |= {"shear_power_dof": (grid, np.full(power.shape, 40.0))}
    rate = np.array(velocity)[:, None, None] / BOX_LENGTH
    stress = np.zeros((*power.shape, 2, 2))
    stress[..., 0, 1] = -n * power / rate
    for term, share in (("kinetic", 0.9), ("collisional", 0.1)):
        values[f"stress_{term}"] = (*grid, "component", "along"), share * stress
    axes = {"component": ["x", "y"], "along": ["x", "y"]}
    return xr.Dataset(values, {"velocity": velocity, "r": r, "beta": beta, **axes}, ATTRIBUTES)


def fluxes(beta, dimension, over, error=1e-3):
    """Return an elastic gas in equilibrium with exponential memories, of 1 collision and of 2."""
    q = None if beta == -1.0 else theory.moment_of_inertia(dimension)
    passed = 0.2 * np.arange(80)
    delay = passed / theory.collision_frequency(T, PACKING, dimension)
    last = {
        "viscosity": theory.shear_viscosity(T, T, PACKING, 1.0, beta, dimension, q),
        "conductivity": theory.thermal_conductivity(T, dimension, PACKING, q),
    }
    grid = ("r", "beta", "delay")
    values = {"E_trans": (grid[:2], [[T * 499 / 1000]]), "kernel_seconds": 36.0}
    for (name, coefficient), memory in zip(last.items(), (1.0, 2.0), strict=True):
        until = over * coefficient * (1 - np.exp(-passed / memory))
        values[f"{name}_until"] = grid, until[None, None]
        values[f"{name}_until_stderr"] = grid, np.full((1, 1, 80), error * coefficient)
        values[f"{name}_until_dof"] = grid, np.full((1, 1, 80), 40.0)
    attributes = ATTRIBUTES | {
        "dimension": dimension,
        "inertia": q,
        "experiment": f"{dimension} {beta}",
    }
    attributes = {name: value for name, value in attributes.items() if name != "inertia" or q}
    return xr.Dataset(values, {"r": [1.0], "beta": [beta], "delay": delay}, attributes)


def walled(beta, over, dimension=2, error=1e-3):
    """Return an elastic gas with heat flowing down from a hot lid, in Fourier's profile."""
    q = None if beta == -1.0 else theory.moment_of_inertia(dimension)
    height = BOX_LENGTH * (np.arange(40) + 0.5) / 40
    profile, packing = (1.0 + height / BOX_LENGTH) ** (2 / 3), np.zeros(40)
    # kappa ~ T^(1/2)
    flux = over * theory.thermal_conductivity(1.0, dimension, 0.0, q) * 2 / 3 / BOX_LENGTH
    flux *= (BOX_LENGTH - 2.0) / BOX_LENGTH
    grid, axes = ("r", "beta"), list("xyz"[:dimension])
    values = {"heat_flux": ((*grid, "component"), [[[0.0] * (dimension - 1) + [-flux]]])}
    values["heat_flux_stderr"] = (*grid, "component"), [[[error * flux] * dimension]]
    values["heat_flux_dof"] = (*grid, "component"), [[[40.0] * dimension]]
    layers = np.broadcast_to(profile[:, None], (1, 1, 40, dimension))
    values["temperature_profile"] = (*grid, "height", "component"), layers
    values["temperature_profile_stderr"] = (*grid, "height", "component"), 1e-4 * layers
    values["packing_profile"] = (*grid, "height"), packing[None, None]
    coordinates = {"r": [1.0], "beta": [beta], "height": height, "component": axes}
    attributes = {name: value for name, value in ATTRIBUTES.items() if name != "inertia"}
    attributes |= {"inertia": q} if q else {}
    attributes |= {"experiment": f"walls {beta} {dimension}", "dimension": dimension}
    return xr.Dataset(values, coordinates, attributes)


def test_made_up_gases_give_their_viscosity_and_conductivity(coefficients):
    """Exactly in shear, by extrapolation to rate 0; to 1e-3 by memory, whose tail is added; to
    1e-4 between walls."""
    slow, fast, none = coefficients.in_shear(strained(lambda r, beta: 1.1).sel(r=0.7, beta=1.0))
    assert none.value == pytest.approx(1.1, rel=1e-9)
    assert fast.value < slow.value < 1.1 and none.stderr > slow.stderr
    for dimension, beta in np.ndindex(2, 2):
        point = fluxes([-1.0, 1.0][beta], dimension + 2, 1.1).isel(r=0, beta=0)
        for name in coefficients.MEMORY_LENGTHS:
            assert coefficients.in_equilibrium(point, name)[-1].value == pytest.approx(
                1.1, rel=1e-3
            )
    for beta, dimension in itertools.product((-1.0, 1.0), (2, 3)):
        conductivity = coefficients.between_walls(walled(beta, 1.1, dimension).isel(r=0, beta=0))
        assert conductivity.value == pytest.approx(1.1, rel=1e-4)


@pytest.mark.parametrize(("over", "verdict"), [(1.0, HOLDS), (1.06, QUALIFIED), (1.2, FAILS)])
def test_viscosity_and_conductivity_are_judged(over, verdict):
    judges = study_module(STUDY, "judges")
    driven = strained(lambda r, beta: over if (r, beta) == (0.7, 1.0) else 1.0)
    assert judges.driven_gas_is_viscous(driven).verdict == verdict
    finding = judges.heat_flows_between_walls(walled(-1.0, over), walled(1.0, 1.0))
    assert finding.verdict == verdict
    pairs = walled(-1.0, 0.9), walled(-1.0, 0.9 * over), *[walled(1.0, 1.1, 3)] * 2
    assert judges.walls_do_not_matter(*pairs).verdict == verdict


def test_every_point_has_its_rows():
    gases = *elastic(), gas("lun", [(0.9, -0.5), (0.9, 1.0)]), strained(lambda r, beta: 1.0)
    elastic_gases = fluxes(1.0, 2, 1.0), walled(1.0, 1.0)
    data = without_positions()
    rows = list(study_module(STUDY, "evidence").rows(*gases, *elastic_gases, data))
    # two ways of each point, spins where they change, two ratios, and viscosity and conductivity;
    # without positions smooth and rough gases, spins correlated or not, and driven disks
    assert len(rows) == 2 * (2 + 2 + 1) + 2 + 2 * 3 + 4 + 2 + 1 + (4 + 4 + 4) + 4
    named = "D of perfectly", "viscosity of driven", "between walls"
    judged = zip(rows, verdicts(rows), strict=True)
    assert {verdict for row, verdict in judged if any(x in row.quantity for x in named)} == {AGREES}


@pytest.mark.slow  # compiles a kernel
def test_gases_between_walls_have_a_row():
    """As they are simulated, in a box given by its lengths or by its packing."""
    schedule = {"equilibrate": 10, "measure": 300, "sample_every": 5}
    evidence = study_module(STUDY, "evidence")
    for room in ({}, {"box": (30, 40)}):
        gas_between_walls = simulate(
            "transport.rough_disks_between_walls", r=[1.0], beta=[1.0], seed=[1, 2],
            scale="small", schedule=schedule, particles=20, progress=False, **room,
        )  # fmt: skip
        (row,) = evidence._elastic_rows(gas_between_walls.isel(r=0, beta=0))
        assert row.quantity == "conductivity of rough elastic disks between walls over theory"
        assert "N = 20" in row.at and np.isfinite(row.ours.stderr)
