"""Mean square displacements: they do not depend on how often a gas is observed.

Statistical assertions are by Student's t, and fail by chance once in 10 000 choices of seeds.
"""

import math

import numpy as np
import pytest
from brute_force import settings

from roughgas import simulate
from roughgas.statistics.errors import StandardError

DISKS = {"spin": {"inertia": 0.5}}
HEATED = settings("heated")["effects"]
BED = DISKS | {
    "gravity": {"acceleration": 1.0},
    "floor": {"amplitude": 5.0, "period": 1.0, "restitution": 1.0, "roughness": -1.0},
}
SAMPLE_EVERY = 0.0625  # T
STEADY = {"kind": "steady", "equilibrate": 40, "measure": 320, "sample_every": SAMPLE_EVERY}
HOTTER = {"thermostat": {"power": 3.0}}
STAGES = [
    {"duration": 40, "measure": False},
    {"duration": 160},
    {"duration": 160, "effects": HOTTER},
]
GASES = {
    "periodic": {"effects": HEATED, "schedule": STEADY | {"period": SAMPLE_EVERY}},
    "sheared": {
        "effects": DISKS | {"shear": {"velocity": 16.0}},
        "schedule": STEADY | {"period": SAMPLE_EVERY},
    },
    "bed": {"effects": BED, "box": [12, "open"], "schedule": STEADY | {"period": 1}},
    "stages": {
        "effects": HEATED,
        "schedule": {"kind": "stages", "stages": STAGES, "sample_every": SAMPLE_EVERY},
    },
}
SPARSE_EVERY = 256  # samples
CONFIDENCE = 0.9999


def observed(gas, **observables):
    usual = {"particles": 16, "box": [12, 12], "r": 0.9, "beta": 0.3, "seed": 3, "progress": False}
    return simulate(**usual | gas, observe=observables)


SLOW = [pytest.param(name, marks=pytest.mark.slow) for name in ("sheared", "bed")]


@pytest.mark.parametrize("name", ["periodic", "stages", *SLOW])
def test_displacements_agree_between_every_sample_and_each_256th(name):
    """Both runs have the same particles at the same instants; the averages differ in their first
    instants alone, so that the error of the sparse one exceeds their difference by far."""
    dense = observed(GASES[name], mean_square_displacement={"lags": 9})
    sparse = observed(GASES[name], mean_square_displacement={"lags": 1, "every": SPARSE_EVERY})
    assert float(dense.lag[-1]) == float(sparse.lag[0]) == SPARSE_EVERY * SAMPLE_EVERY
    assert float(dense.R) == float(sparse.R)
    dense_msd, sparse_msd = dense.mean_square_displacement[-1], sparse.mean_square_displacement[0]
    error, dof = sparse.mean_square_displacement_stderr[0], sparse.mean_square_displacement_dof[0]
    for dense_value, sparse_value, width, freedom in zip(
        dense_msd, sparse_msd, error, dof, strict=True
    ):
        limit = StandardError(float(width), float(freedom)).half_width(CONFIDENCE)
        assert abs(float(dense_value - sparse_value)) < limit
    across = sparse.moving.values[0]
    assert float(sparse_msd.sel(moving=across)) > 12.0**2 / 10  # particles leave the box


@pytest.mark.slow
def test_the_displacement_is_twice_the_integral_of_the_velocity_autocorrelation():
    """MSD(t) = 2 int_0^t (t - s) C(s) ds: by Simpson's rule, over independent seeds.

    With 430 kicks a T samples see the gas at all phases of the kicks. Kicks at each 1/32 T,
    every other one just before a sample, make C .5 % too large; here the bias is at most .1 %. The
    test sees a deviation of .5 %.
    """
    kicks = {"power": 1.0, "spin_share": 0.5, "interval": 0.0371}
    schedule = STEADY | {"period": SAMPLE_EVERY, "measure": 200}
    gas = {"effects": DISKS | {"thermostat": kicks}, "schedule": schedule}
    lags, ratios = 5, []
    weights = SAMPLE_EVERY / 3.0 * np.array([1, *[4, 2] * (2 ** (lags - 2) - 1), 4, 1])
    for seed in range(8):
        observables = {
            "mean_square_displacement": {"lags": lags},
            "autocorrelation": {"delays": 17},
        }
        run = observed(gas | {"seed": seed}, **observables)
        assert float(run.lag[-1]) == float(run.delay[-1])
        remaining = (run.delay[-1] - run.delay).values
        integral = 2.0 * np.sum(weights * remaining * run.velocity_autocorrelation.values)
        ratios.append(float(run.mean_square_displacement[-1].mean()) / integral)
    error = StandardError(np.std(ratios, ddof=1) / math.sqrt(len(ratios)), len(ratios) - 1.0)
    assert abs(np.mean(ratios) - 1.0) < 1e-3 + error.half_width(CONFIDENCE)
    assert error.half_width(CONFIDENCE) < 4e-3


def test_displacements_of_a_cooling_gas_agree_between_usual_and_dense_samples():
    """Samples are 4 and 1 collisions per particle apart; guessed images gave 40 % more at 4."""
    name, point = "cooling", {"r": 0.9, "beta": 0.5, "seed": 2, "scale": "small"}
    watched = point | {"observe": ["mean_square_displacement"], "progress": False}
    usual = simulate(name, **watched).sel(lag=4.0)
    dense = simulate(name, **watched, schedule={"sample_every": 0.25}).sel(lag=4.0)
    pairs = [
        [
            float(run[f"mean_square_displacement{end}"].mean("moving"))
            for end in ("", "_stderr", "_dof")
        ]
        for run in (usual, dense)
    ]
    (far, far_error, dof), (near, near_error, _) = pairs
    limit = StandardError(math.hypot(far_error, near_error), dof).half_width(CONFIDENCE)
    assert abs(far - near) < limit < 0.2 * near


def test_an_observable_is_unchanged_by_another_of_another_interval():
    """Every 3 samples alone, and with cumulants every 2, which share each sixth sample."""
    gas = {"effects": HEATED, "schedule": STEADY | {"period": SAMPLE_EVERY, "measure": 20}}
    displacements = {"mean_square_displacement": {"lags": 3, "every": 3}}
    alone = observed(gas, **displacements)
    together = observed(gas, **displacements, cumulants={"every": 2})
    assert np.array_equal(alone.mean_square_displacement, together.mean_square_displacement)
