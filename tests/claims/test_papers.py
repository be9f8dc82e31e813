"""Judges of studies of other groups' papers, on data with a known answer."""

import math

import numpy as np
import pytest
from tests.study_modules import module_of_study
from tests.synthetic import reduced

from roughgas.claims.verdicts import FAILS, HOLDS, QUALIFIED, NotTestedError

GRID = {"r": (0.9,), "beta": (0.0, 0.5)}


def with_profiles(data, variables, coordinates):
    """Return a reduced dataset with variables of further `coordinates`, alike at all points.

    `variables` are arrays over these by name; errors are a hundredth of the largest value.
    """
    dims = tuple(coordinates)
    for name, values in variables.items():
        array = np.broadcast_to(values, (*data.R.shape, *np.shape(values)))
        error = np.full(array.shape, 0.01 * np.abs(values).max())
        data = data.assign(
            {
                name: ((*data.R.dims, *dims), array),
                f"{name}_stderr": ((*data.R.dims, *dims), error),
                f"{name}_dof": ((*data.R.dims, *dims), np.full(array.shape, 20.0)),
            }
        )
    return data.assign_coords(coordinates)


def channel(slip, equilibrated=1.0):
    """Return a channel whose flow at the walls is this share of the flow in the middle."""
    flow = np.array([slip, 0.7, 1.0, 0.7, slip])[:, np.newaxis] * [1.0, 0.0]
    coordinates = {"height": [1.0, 2.0, 3.0, 4.0, 5.0], "component": ["x", "y"]}
    data = reduced("vibrated", equilibrated=equilibrated, **GRID)
    return with_profiles(data, {"flow_profile": flow}, coordinates)


@pytest.mark.parametrize(("rough", "verdict"), [(0.3, HOLDS), (0.8, FAILS)])
def test_the_slip_at_rough_walls_is_less(rough, verdict):
    judge = module_of_study("vijayakumar_2007", "judges").rough_walls_slip_less
    finding = judge(channel(0.6), channel(rough))
    assert finding.verdict == verdict
    assert finding.numbers[0][1].value == pytest.approx(rough - 0.6)


def suspension(growth, equilibrated=1.0):
    """Return a suspension whose viscosity grows by this factor over its sweep."""
    third = ("shear.velocity", (1.0, 10.0))
    data = reduced("sheared", r=(0.9,), beta=(0.0,), third=third, equilibrated=equilibrated)
    coordinates = {"component": ["x", "y"], "along": ["x", "y"]}
    data = with_profiles(data, {"stress_kinetic": -np.ones((2, 2))}, coordinates)
    viscosity = data.velocity.copy(data=[1.0, growth])
    return data.assign(stress_kinetic=data.stress_kinetic * data.velocity * viscosity)


@pytest.mark.parametrize(("growth", "verdict"), [(3.0, HOLDS), (1.5, QUALIFIED), (0.5, FAILS)])
def test_a_suspension_thickens_if_its_viscosity_doubles(growth, verdict):
    judge = module_of_study("gomez_gonzalez_2020", "judges").suspension_thickens
    finding = judge(suspension(growth))
    assert finding.verdict == verdict
    assert finding.numbers[0][1].value == pytest.approx(growth - 1.0)


def spinners(tails, equilibrated=1.0):
    """Return spinners with Gaussian velocities, whose tails are multiplied by this factor."""
    velocity = np.linspace(-7.95, 7.95, 160)
    density = np.exp(-0.5 * velocity**2) / math.sqrt(2.0 * math.pi)
    density = np.where(np.abs(velocity) > 3.5, tails * density, density)
    data = reduced("vibrated", equilibrated=equilibrated, **GRID)
    coordinates = {"reduced_velocity": velocity, "component": ["x", "y"]}
    data = with_profiles(
        data, {"velocity_histogram": np.stack([density, density], axis=1)}, coordinates
    )
    return data.assign(velocity_histogram_stderr=data.velocity_histogram_stderr * 1e-3)


@pytest.mark.parametrize(("tails", "verdict"), [(2.0, HOLDS), (0.5, FAILS)])
def test_tails_are_compared_with_those_of_a_gaussian(tails, verdict):
    finding = module_of_study("scholz_2017", "judges").tails_are_overpopulated(spinners(tails))
    assert finding.verdict == verdict
    # bins of a tenth leave the integral of the Gaussian's tail within 2 %
    assert finding.numbers[0][1].value == pytest.approx(tails - 1.0, abs=0.02 * tails)


STEADY_ONLY = {
    ("vijayakumar_2007", "rough_walls_slip_less"): lambda *steady: (
        channel(0.6),
        channel(0.3, *steady),
    ),
    ("gomez_gonzalez_2020", "suspension_thickens"): lambda *steady: (suspension(3.0, *steady),),
    ("scholz_2017", "tails_are_overpopulated"): lambda *steady: (spinners(2.0, *steady),),
}
"""Judges, by study and name, and gases for which their statements hold."""


@pytest.mark.parametrize("equilibrated", [0.0, -1.0])
@pytest.mark.parametrize("key", STEADY_ONLY)
def test_gases_that_drift_or_are_not_known_to_be_steady_are_not_judged(key, equilibrated):
    study, name = key
    judge = getattr(module_of_study(study, "judges"), name)
    assert judge(*STEADY_ONLY[key]()).verdict == HOLDS
    with pytest.raises(NotTestedError, match="steady"):
        judge(*STEADY_ONLY[key](equilibrated))
