"""The two ways of running an experiment, on gases whose R is known well enough."""

import numpy as np
import pytest
from brute_force import begin, settings

from roughgas import theory
from roughgas.protocols import cooling, steady
from roughgas.protocols.recorder import Recorder

BED = settings("bed", 40, [12.5, "open"]) | {
    "schedule": {
        "kind": "steady",
        "equilibrate": 100,
        "measure": 300,
        "sample_every": 0.25,
        "period": 1,
    }
}
COOLING = settings("gas", 40, [50, 50]) | {
    "schedule": {
        "kind": "cooling",
        "replicas": 8,
        "thermalise": 20,
        "relaxation_times": 8,
        "plateau": 60,
        "sample_every": 1,
    }
}


def test_a_steady_bed():
    """R near Eq. (lun), within the paper's 0.06 and four standard errors."""
    scene, _ = begin(BED, 0.9, 0.0)
    measured = steady.run(scene, BED, 1, Recorder())
    assert measured["equilibrated"]
    assert measured["measured_from"] >= 100.0
    assert measured["measured_from"] == round(measured["measured_from"])  # whole periods
    assert measured["time"][0] == pytest.approx(measured["measured_from"] + 0.25)
    assert len(measured["R_series"]) == len(measured["time"]) == len(measured["E_rot_series"])
    expected = theory.lun_ratio(0.0, 0.5)
    assert abs(measured["R"] - expected) < 0.06 + 4.0 * measured["R_stderr"]


def test_a_cooling_gas():
    """R near Eq. (K), within 8 % and four standard errors of 8 replicas of 40 disks."""
    scene, _ = begin(COOLING, 0.9, 0.0)
    measured = cooling.run(scene, COOLING, 1, Recorder())
    expected = theory.cooling_ratio(0.9, 0.0)
    assert abs(measured["R"] - expected) < 0.08 * expected + 4.0 * measured["R_stderr"]
    assert measured["R_replica"].shape == (8,)
    assert measured["R"] == pytest.approx(measured["R_replica"].mean())
    assert np.all(np.diff(measured["E_trans_series"]) < 0.0)
    assert 0.5 < measured["E_trans_series"][0] < 1.0  # in units of the gas before it cooled
    assert measured["collisions_per_particle"][0] == 1.0
    assert measured["measured_from"] >= cooling.transient_length(scene, 8)


def test_the_transient_is_that_of_the_rate_equations_within_limits():
    gas = settings("gas")
    for r, beta in ((0.9, -0.6), (0.9, 0.5), (0.9999, -0.9999), (0.5, 1.0)):
        rate = theory.relaxation_rate(r, beta)
        expected = np.clip(8.0 / rate, *cooling.TRANSIENT)
        assert cooling.transient_length(begin(gas, r, beta)[0], 8) == pytest.approx(expected)
