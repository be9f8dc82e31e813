"""Points at the edges of what is legal say what they know, and no more."""

import math

import numpy as np
import pytest
from brute_force import settings
from schedules import COOLING, STEADY

from roughgas.scene import build
from roughgas.simulation.point import VOUCHED, _withdrawn, run_point
from roughgas.statistics.errors import NO, UNKNOWN, YES

SHEARED = settings("sheared", 20, [20, 20]) | {"schedule": STEADY}
GAS = settings("gas", 20, [20, 20]) | {"schedule": COOLING}


def point(experiment, r, beta):
    return run_point(build(experiment, r, beta), experiment, 1).variables


@pytest.mark.parametrize("experiment", [SHEARED, GAS], ids=["driven", "cooling"])
def test_smooth_particles_have_an_R_that_is_known_for_certain(experiment):
    found = point(experiment, 0.9, -1.0)
    assert found["R"] == found["R_stderr"] == found["R_ci95"] == 0.0 and found["R_ci95_trusted"]
    assert found["autocorrelation_time"] == 1.0  # one sample, or one period


@pytest.mark.parametrize("inertia", [1e-6, 1.0])
def test_any_legal_moment_of_inertia_gives_numbers(inertia):
    experiment = SHEARED | {"effects": SHEARED["effects"] | {"spin": {"inertia": inertia}}}
    found = point(experiment, 0.9, 0.5)
    assert all(np.isfinite(found[name]) for name in VOUCHED["R_ci95_trusted"])
    assert found["energy_imbalance"] < 1e-11


def test_no_verdict_vouches_for_a_number_that_is_not_finite():
    sound = dict.fromkeys(VOUCHED, YES) | dict.fromkeys(VOUCHED["R_ci95_trusted"], 0.5)
    assert _withdrawn(sound) == {}
    assert _withdrawn(sound | {"R_stderr": math.nan}) == {"R_ci95_trusted": UNKNOWN}
    assert _withdrawn(sound | {"R": math.nan}) == dict.fromkeys(VOUCHED, UNKNOWN)
    drifting = sound | {"R": math.nan, "equilibrated": NO}  # which R does not unsay
    assert _withdrawn(drifting) == {"R_ci95_trusted": UNKNOWN}
    smooth = {"E_trans": math.inf, "equilibrated": YES}  # where nothing spins
    assert _withdrawn(smooth) == {"equilibrated": UNKNOWN}
