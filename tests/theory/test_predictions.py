"""Predictions of theory for datasets; sheared and viscoelastic gases."""

import json
import math

import numpy as np
import pytest
from integration import integrate

from roughgas import theory
from roughgas.effects.restitution import pade, x_of
from roughgas.theory.closed_forms import shear_factor
from roughgas.theory.prediction import Equation, equation_of, predicted_ratio, species_at

DISKS, SPHERES = {"dimension": 2}, {"dimension": 3}
FRICTION = "rate equations with Coulomb friction"


@pytest.mark.parametrize(
    ("attributes", "variables", "equation"),
    [
        (DISKS, ("R",), ("lun", "Lun's formula")),
        (SPHERES, ("R",), ("lun", "Lun's formula")),
        (DISKS, ("R", "plateau_end"), ("K", "theory of free cooling")),
        (SPHERES | {"theory": "K"}, (), ("K", "theory of free cooling")),
        (DISKS | {"theory": "lun"}, ("plateau_end",), ("lun", "Lun's formula")),
        (DISKS | {"theory": "K", "mu": 0.0}, (), ("K", FRICTION)),
        (DISKS | {"theory": "lun", "swept": "friction.mu"}, (), ("lun", FRICTION)),
        (DISKS | {"theory": "K", "swept": "spin.inertia"}, (), ("K", "theory of free cooling")),
        (DISKS | {"spin_share": 0.0}, (), ("lun", "Lun's formula")),
        (DISKS | {"spin_share": 0.4}, (), ("lun", "rate equations, spin share 0.4")),
        (DISKS | {"swept": "thermostat.spin_share"}, (), ("lun", "rate equations")),
        (
            DISKS | {"swept": "thermostat.spin_share", "spin_share": 1.0},
            (),
            ("lun", "rate equations, spin share 1"),
        ),
    ],
)
def test_the_equation_follows_from_the_attributes_of_a_dataset(attributes, variables, equation):
    assert equation_of(attributes, variables) == Equation(*equation)


ALIKE = [{"fraction": 0.3}, {"fraction": 0.7, "name": "rest"}]
SPECIES = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 2, "mass": 4, "name": "heavy"}]


def attributes(species=SPECIES, kind="K", **changes):
    description = {"species": species, "species_pairs": [], "volume": 1e4}
    common = {"dimension": 2, "inertia": 0.5, "particles": 160, "theory": kind}
    return common | {"species_json": json.dumps(description)} | changes


@pytest.mark.parametrize("changes", [{}, {"mu": 0.4}, {"spin_share": 0.3}])
@pytest.mark.parametrize("kind", ["K", "lun"])
def test_equal_species_are_predicted_as_a_single_species(kind, changes):
    r, beta = np.meshgrid([0.8, 0.9], [-0.5, 0.0, 1.0])
    ratios = predicted_ratio(attributes(ALIKE, kind, **changes), r, beta)
    single = {"dimension": 2, "inertia": 0.5, "theory": kind} | changes
    assert ratios == pytest.approx(predicted_ratio(single, r, beta), rel=1e-8)


def test_kicks_without_a_steady_state_have_no_theory():
    """Kicks to the spins of smooth particles, and kicks to elastic particles of any species."""
    beta = np.array([-1.0, 0.0, 1.0])
    kicked = attributes(kind="lun", spin_share=0.3)
    assert np.isnan(predicted_ratio(kicked, 0.9, beta)).tolist() == [True, False, False]
    assert np.isnan(predicted_ratio(kicked, 1.0, beta)).tolist() == [True, False, True]


def test_a_cooling_mixture_is_predicted_at_its_packing():
    gas = theory.mixture(SPECIES, 0.9, 0.2)
    expected = theory.mixture_cooling(gas, 160 * np.pi * 2.5 / 1e4).overall_ratio(gas)
    assert predicted_ratio(attributes(), 0.9, 0.2) == pytest.approx(expected, rel=1e-12)


def test_swept_values_replace_those_of_the_species():
    swept = attributes(swept="species.heavy.mass", mass=np.array([1.0, 9.0]))
    ratios = predicted_ratio(swept, 0.9, 0.2)
    heavier = [SPECIES[0], SPECIES[1] | {"mass": 9.0}]
    assert ratios[1] == pytest.approx(predicted_ratio(attributes(heavier), 0.9, 0.2), rel=1e-12)
    spread = [{"fraction": 1, "radius": {"distribution": "uniform", "deviation": 0.1}}]
    swept = attributes(spread, swept="species.0.deviation", deviation=np.array([0.0, 0.2]))
    alike, apart = predicted_ratio(swept, 0.8, -0.5)
    assert alike == pytest.approx(theory.cooling_ratio(0.8, -0.5), rel=1e-9)
    assert apart - alike > 0.03


@pytest.mark.slow
def test_a_line_of_many_values_is_interpolated():
    beta = np.linspace(-0.3, 1, 801)
    line = predicted_ratio(attributes(), 0.9, beta)
    for k in (1, 333, 799):
        assert line[k] == pytest.approx(predicted_ratio(attributes(), 0.9, beta[k]), abs=1e-4)


def test_spins_of_a_driven_mixture_follow_its_temperatures():
    state = species_at(attributes(kind="lun"), {"r": 0.9, "beta": 0.0}, [1.0, 3.0])
    gas = theory.mixture(SPECIES, 0.9, 0.0)
    expected = theory.mixture_rotation(gas, np.array([1.0, 3.0]), 160 * np.pi * 2.5 / 1e4)
    assert state.T_rot == pytest.approx(expected, rel=1e-12)
    assert state.T_tr == pytest.approx([1, 3])


DIRECTIONS = 720


def flux_moments(mean, sigma):
    """Return <x> over x > 0, x ~ N(mean, sigma^2), and mean and mean square weighted by such x."""
    z = mean / sigma
    below = 0.5 * (1.0 + np.vectorize(math.erf)(z / math.sqrt(2.0)))
    density = np.exp(-z * z / 2.0) / math.sqrt(2.0 * math.pi)
    first = mean * below + sigma * density
    second = (mean**2 + sigma**2) * below + mean * sigma * density
    third = (mean**3 + 3.0 * mean * sigma**2) * below + (mean**2 + 2 * sigma**2) * sigma * density
    return first, second / first, third / first


def theta(beta, q, rate, stress, difference):
    """Return T_rot/T_tr from the spin balance at contacts, in all orders, by a sum over directions.

    Relative velocities are Gaussian with twice the tensor of temperatures, about the mean flow.
    """
    angle = (np.arange(DIRECTIONS) + 0.5) * 2.0 * math.pi / DIRECTIONS
    n = np.stack([np.cos(angle), np.sin(angle)])
    t = np.stack([-n[1], n[0]])
    tensor = 2.0 * np.array([[1.0 + difference, -stress], [-stress, 1.0 - difference]])
    nn, nt, tt = (np.einsum("ik,ij,jk->k", u, tensor, v) for u, v in ((n, n), (n, t), (t, t)))
    flow_n, flow_t = 2.0 * rate * n[1] * n[0], -2.0 * rate * n[1] ** 2
    weight, approach, square = flux_moments(-flow_n, np.sqrt(nn))
    weight /= weight.sum()
    thermal = -approach - flow_n  # mean of the normal velocity without the flow
    thermal_square = square + 2.0 * flow_n * approach + flow_n**2
    slope = nt / nn
    along = slope * thermal + flow_t
    v_t2 = slope**2 * thermal_square + tt - nt**2 / nn + 2.0 * slope * thermal * flow_t + flow_t**2
    spin = rate  # v_r due to the mean spin, -rate/2 of each partner
    c1, c2, c3 = 1.0 + beta, 2.0 * (q - beta), 1.0 + 2.0 * q - beta
    v_r2 = (c1 * (weight * v_t2).sum() - c2 * spin * (weight * along).sum()) / c3
    return (v_r2 - spin**2) * q / 2.0


def test_the_integral_without_flow_and_stress_is_eq_lun():
    assert shear_factor(0, 0, 0) == 1
    lun = theory.lun_ratio(0.3, 0.4)
    assert theta(0.3, 0.4, 0, 0, 0) == pytest.approx(lun / (1 - lun), rel=1e-12)


@pytest.mark.parametrize("beta", [-0.7, 0.0, 1.0])
@pytest.mark.parametrize("q", [0.1, 0.5, 1.0])
@pytest.mark.parametrize("direction", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (0.7, 1, -0.6)])
def test_the_shear_factor_is_the_second_order_of_the_integral(beta, q, direction):
    """The remainder falls at least with the third power of g, p and d."""
    lun = theory.lun_ratio(beta, q)
    remainders = []
    for size in (0.08, 0.04):
        g, p, d = size * np.array(direction)
        exact = theta(beta, q, g, p, d) * (1 - lun) / lun
        remainders.append(abs(exact - shear_factor(g, p, d)))
        assert remainders[-1] < 0.5 * size**3
    assert remainders[1] < remainders[0] / 7 + 1e-12


SPEEDS = np.geomspace(1e-4, 1e4, 9)


@pytest.mark.parametrize("r", [0.05, 0.5, 0.9, 0.9999])
def test_restitution_is_that_of_the_kernel(r):
    restitution = theory.viscoelastic_restitution(SPEEDS, r, 3.0)
    expected = [pade(x_of(r) * (g / 3.0) ** 0.2) for g in SPEEDS]
    assert restitution == pytest.approx(expected, rel=1e-12)
    assert theory.viscoelastic_restitution(3.0, r, 3.0) == pytest.approx(r, rel=1e-13)


def test_maxwellian_restitution_is_an_average_over_contacts():
    """Of a million normal speeds, whose squares over 4 T_tr are exponential."""
    T, r, speed = 2.3, 0.7, 0.5
    g = np.sqrt(4.0 * T * np.random.default_rng(1).exponential(size=10**6))
    losses = (1.0 - theory.viscoelastic_restitution(g, r, speed) ** 2) * g**2 / (4.0 * T)
    error = losses.std() / 1e3
    predicted_loss = 1.0 - theory.maxwellian_restitution(T, r, speed) ** 2
    assert abs(predicted_loss - losses.mean()) < 4.0 * error < 0.01 * predicted_loss


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_closed_form_solves_the_rate_equations_of_a_smooth_gas(dimension):
    T0, r, nu = 1.7, 1.0 - 1e-5, 0.4
    tau = theory.viscoelastic_time(T0, r, nu, dimension=dimension)
    gas = theory.viscoelastic_cooling(8e5, T0, r, -1.0, nu, dimension=dimension)[1:3]
    time, T_tr = (column[:: len(gas[0]) // 20] for column in gas)
    assert time[-1] > 10.0 * tau
    expected = theory.viscoelastic_temperature(time, T0, r, nu, dimension=dimension)
    assert T_tr == pytest.approx(expected, rel=2e-5)


@pytest.mark.parametrize("beta", [0.0, 1.0])
def test_cooling_is_integrated_to_many_digits(beta):
    gas = theory.viscoelastic_cooling(20.0, 1.0, 0.6, beta, 0.3, 2.0)

    def slope(state):
        r = theory.maxwellian_restitution(state[1], 0.6, 2.0)
        changes = theory.temperature_changes(*state[1:], r, beta)
        return np.array([1.0 / (0.3 * np.sqrt(state[1])), *changes])

    expected = integrate(slope, np.array([0.0, 1.0, 0.0]), [20.0], pieces=25)
    assert [column[-1] for column in gas[1:]] == pytest.approx(expected[:, 0], rel=1e-8)
