"""Mean square displacements: they do not depend on how often a gas is observed.

Statistical assertions are by Student's t, and fail by chance once in 10 000 choices of seeds.
"""

import math

import numpy as np
import pytest

from roughgas import simulate
from roughgas.statistics.errors import Error

DISKS = {"spin": {"inertia": 0.5}}
HEATED = DISKS | {"thermostat": {"power": 1.0, "spin_share": 0.5, "interval": 0.5}}
BED = DISKS | {
    "gravity": {"acceleration": 1.0},
    "floor": {"amplitude": 5.0, "period": 1.0, "restitution": 1.0, "roughness": -1.0},
}
EVERY = 0.0625  # T
STEADY = {"kind": "steady", "equilibrate": 40, "measure": 320, "sample_every": EVERY}
HOTTER = {"thermostat": {"power": 3.0}}
STAGES = [
    {"duration": 40, "measure": False},
    {"duration": 160},
    {"duration": 160, "effects": HOTTER},
]
GASES = {
    "periodic": {"effects": HEATED, "schedule": STEADY | {"period": EVERY}},
    "sheared": {
        "effects": DISKS | {"shear": {"velocity": 16.0}},
        "schedule": STEADY | {"period": EVERY},
    },
    "bed": {"effects": BED, "box": [12, "open"], "schedule": STEADY | {"period": 1}},
    "stages": {
        "effects": HEATED,
        "schedule": {"kind": "stages", "stages": STAGES, "sample_every": EVERY},
    },
}
FAR = 256  # samples
SURE = 0.9999


def observed(gas, **observables):
    usual = {"particles": 16, "box": [12, 12], "r": 0.9, "beta": 0.3, "seed": 3, "progress": False}
    return simulate(**usual | gas, observe=observables)


@pytest.mark.parametrize("name", GASES)
def test_a_gas_observed_at_every_sample_and_at_each_256th_gets_as_far(name):
    """Both runs have the same particles at the same instants; the averages differ in their first
    instants alone, so that the error of the sparse one covers their difference by far."""
    dense = observed(GASES[name], mean_square_displacement={"lags": 9})
    sparse = observed(GASES[name], mean_square_displacement={"lags": 1, "every": FAR})
    assert float(dense.lag[-1]) == float(sparse.lag[0]) == FAR * EVERY
    assert float(dense.R) == float(sparse.R)
    long, short = dense.mean_square_displacement[-1], sparse.mean_square_displacement[0]
    error, dof = sparse.mean_square_displacement_stderr[0], sparse.mean_square_displacement_dof[0]
    for one, other, width, freedom in zip(long, short, error, dof, strict=True):
        limit = Error(float(width), float(freedom)).half_width(SURE)
        assert abs(float(one - other)) < limit
    across = sparse.moving.values[0]
    assert float(short.sel(moving=across)) > 12.0**2 / 10  # particles leave the box


def test_the_displacement_is_twice_the_integral_of_the_velocity_autocorrelation():
    """MSD(t) = 2 int_0^t (t - s) C(s) ds: by Simpson's rule, over independent seeds.

    With 430 kicks a T samples see the gas at all phases of the kicks. Kicks at each 1/32 T,
    every other one just before a sample, make C .5 % too large; here the bias is at most .1 %. The
    test sees a deviation of .5 %.
    """
    kicks = {"power": 1.0, "spin_share": 0.5, "interval": 0.0371}
    schedule = STEADY | {"period": EVERY, "measure": 200}
    gas = {"effects": DISKS | {"thermostat": kicks}, "schedule": schedule}
    lags, ratios = 5, []
    weights = EVERY / 3.0 * np.array([1, *[4, 2] * (2 ** (lags - 2) - 1), 4, 1])
    for seed in range(8):
        seen = {"mean_square_displacement": {"lags": lags}, "autocorrelation": {"delays": 17}}
        run = observed(gas | {"seed": seed}, **seen)
        assert float(run.lag[-1]) == float(run.delay[-1])
        remaining = (run.delay[-1] - run.delay).values
        integral = 2.0 * np.sum(weights * remaining * run.velocity_autocorrelation.values)
        ratios.append(float(run.mean_square_displacement[-1].mean()) / integral)
    error = Error(np.std(ratios, ddof=1) / math.sqrt(len(ratios)), len(ratios) - 1.0)
    assert abs(np.mean(ratios) - 1.0) < 1e-3 + error.half_width(SURE)
    assert error.half_width(SURE) < 4e-3


def test_a_cooling_gas_gets_as_far_at_its_usual_samples_as_at_dense_ones():
    """Looks 4 and 1 collisions per particle apart; guessed images gave 40 % more at the former."""
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
    limit = Error(math.hypot(far_error, near_error), dof).half_width(SURE)
    assert abs(far - near) < limit < 0.2 * near


def test_an_observable_sees_the_same_beside_another_of_another_interval():
    """Every 3 samples alone, and beside another every 2, which shares each sixth sample."""
    gas = {"effects": HEATED, "schedule": STEADY | {"period": EVERY, "measure": 20}}
    wanted = {"mean_square_displacement": {"lags": 3, "every": 3}}
    alone = observed(gas, **wanted)
    beside = observed(gas, **wanted, cumulants={"every": 2})
    assert np.array_equal(alone.mean_square_displacement, beside.mean_square_displacement)
