"""Protocols of steady and cooling gases."""

import numpy as np
import pytest
from brute_force import begin, run, settings
from raw import build, cooling, expected_collisions, packing, steady

from roughgas import theory
from roughgas.effects.contacts import STRESSES, columns_of_pairs
from roughgas.simulation.simulation import Simulation

BED = settings("bed", 40, [12.5, "open"]) | {
    "schedule": {
        "kind": "steady",
        "equilibrate": 100.25,
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


def test_a_steady_bed_is_measured_from_a_full_period_on():
    """test_small_scale.py compares R with theory, here and of a cooling gas."""
    scene, _ = begin(BED, 0.9, 0.0)
    measured = steady.run(scene, BED, 1, Simulation())
    assert measured["equilibrated"]
    assert measured["measured_from"] >= 100.25
    assert measured["measured_from"] == round(measured["measured_from"])  # whole periods
    assert measured["time"][0] == pytest.approx(measured["measured_from"] + 0.25)
    assert len(measured["R_series"]) == len(measured["time"]) == len(measured["E_rot_series"])


@pytest.mark.parametrize("name", ["bed", "sheared"])
def test_the_number_of_collisions_of_a_point_is_predicted(name):
    """At r = 0.8 a bed makes a third more collisions than at 0.99, a sheared gas fewer."""
    box = [12.5, "open"] if name == "bed" else [25, 25]
    experiment = settings(name, 40, box) | {"schedule": BED["schedule"]}
    counted, expected = [], []
    for r in (0.8, 0.99):
        simulation = Simulation()
        steady.run(begin(experiment, r, 0.0)[0], experiment, 1, simulation)
        counted.append(simulation.costs.collisions)
        expected.append(expected_collisions(experiment, r, 0.0))
    assert max(counted) > 1.33 * min(counted)
    assert np.argmax(counted) == np.argmax(expected) == (name == "sheared")
    assert expected == pytest.approx(counted, rel=0.5)


KICKED_GASES = {
    "kicks": {"thermostat": {"power": 0.02, "spin_share": 0.0, "interval": 1.0}},
    "bath": {"langevin": {"interval": 1.0, "drag": 0.05, "temperature": 2.0}},
}


@pytest.mark.parametrize("drive", KICKED_GASES)
def test_collisions_and_kicks_of_a_heated_gas_are_predicted(drive):
    """A particle gets a kick per T, which counts as half a collision."""
    experiment = settings("heated", 80, [60, 60]) | {
        "effects": {"spin": {"inertia": 0.5}, **KICKED_GASES[drive]},
        "schedule": {"kind": "steady", "equilibrate": 50, "measure": 200, "sample_every": 1},
    }
    simulation = Simulation()
    steady.run(begin(experiment, 0.8, 0.0)[0], experiment, 1, simulation)
    kicks = 80 * 250
    contacts = expected_collisions(experiment, 0.8, 0.0) - 0.5 * kicks
    assert contacts == pytest.approx(simulation.costs.collisions, rel=0.5)


def test_a_bed_that_is_hardly_shaken_makes_few_collisions():
    """The square of its floor's speed underflows."""
    floor = BED["effects"]["floor"] | {"amplitude": 1e-200}
    assert (
        expected_collisions(BED | {"effects": BED["effects"] | {"floor": floor}}, 0.9, 0.0) == 0.0
    )


def test_a_start_that_would_leave_less_than_half_is_not_taken():
    """A small step just after the middle of a run without equilibration."""
    series = 1.0 + 0.001 * np.random.default_rng(1).standard_normal(104)
    series[:54] += 0.005
    assert steady._measurement_start([series], 0, 104, 1) == (0, False)
    assert steady._measurement_start([series], 40, 64, 1) == (54, True)


def test_R_over_collisions_does_not_depend_on_the_phases_of_samples():
    """R depends on the phases of samples; R over collisions, and the length of series, do not."""
    measured = []
    for every in (0.05, 0.25):
        bed = BED | {"schedule": BED["schedule"] | {"equilibrate": 100, "sample_every": every}}
        measured.append(steady.run(begin(bed, 0.8, 0.0)[0], bed, 2, Simulation()))
    twenty, four = measured
    for variables in measured:
        assert (
            len(variables["R_series"])
            == len(variables["time"])
            == 4 * (400 - variables["measured_from"])
        )
        assert variables["R"] == pytest.approx(variables["R_series"].mean(), rel=1e-12)
    assert twenty["R_collisional"] == pytest.approx(four["R_collisional"], rel=1e-6)
    assert twenty["contact_correlation"] == pytest.approx(four["contact_correlation"], rel=1e-6)
    assert twenty["R"] > four["R"] + 0.002  # by 0.0050(1) in the bed of the paper
    expected = theory.lun_ratio(0.0, 0.5)
    assert abs(twenty["R_collisional"] - expected) < 0.01 < twenty["R"] - expected


def test_a_cooling_gas_averages_over_its_replicas():
    scene, _ = begin(COOLING, 0.9, 0.0)
    measured = cooling.run(scene, COOLING, 1, Simulation())
    assert measured["R_replica"].shape == (8,)
    assert measured["R"] == pytest.approx(measured["R_replica"].mean())
    assert np.all(np.diff(measured["E_trans_series"]) < 0.0)
    assert 0.5 < measured["E_trans_series"][0] < 1.0  # in units of the gas before it cooled
    assert measured["collisions_per_particle"][0] == 1.0
    assert measured["measured_from"] >= cooling.transient_length(scene, 8)


def heated(kernel, **thermostat):
    """Settings of a steady heated gas."""
    steady = {"kind": "steady", "equilibrate": 40, "measure": 960, "sample_every": 0.5}
    return settings(kernel, 40, [50, 50], thermostat=thermostat) | {"schedule": steady}


def test_a_steady_heated_gas_has_R_of_the_rate_equations():
    """Within four of its errors, .0056 by the scatter of 40 seeds, whose mean is .0006(9) below.

    No period is needed.
    """
    experiment = heated("heated", spin_share=0.5)
    scene, _ = begin(experiment, 0.9, 0.2)
    measured = steady.run(scene, experiment, 1, Simulation())
    assert measured["equilibrated"]
    expected = theory.stationary_ratio(0.9, 0.2, 2, 0.5, 0.5)
    assert abs(measured["R"] - expected) < 4.0 * 0.0056 and measured["R_stderr"] < 2.0 * 0.0056
    assert measured["source"] == ["thermostat", "contacts"]
    put_in = measured["energy_input"][0].sum() / 1000.0
    assert put_in == pytest.approx(1.0, abs=4.0 * 0.021)  # the scatter of 40 seeds


def test_a_cooling_gas_without_spin_follows_haff():
    """Its energy decays exponentially, by a share (1 - r^2)/2 per collision per particle."""
    experiment = COOLING | settings("smooth", 40, [50, 50])
    scene, _ = begin(experiment, 0.95, -1.0)
    assert cooling.transient_length(scene, 8) == cooling.SHORTEST_TRANSIENT
    measured = cooling.run(scene, experiment, 1, Simulation())
    assert not [name for name in measured if name.startswith("R")] and "E_rot" not in measured
    assert measured["measured_from"] == 10.0 and measured["equilibrated"]
    E, n = measured["E_trans_series"], measured["collisions_per_particle"]
    rate = -np.log(E[-1] / E[0]) / (n[-1] - n[0])
    assert rate == pytest.approx((1.0 - 0.95**2) / 2.0, rel=0.05)


SPECIES = [{"fraction": 0.5, "radius": 1, "mass": 1}, {"fraction": 0.5, "radius": 2, "mass": 4}]
GAS = {"particles": 160, "box": [100, 100], "effects": {"spin": {"inertia": 0.5}}}


def test_the_transient_is_that_of_the_slowest_ratio():
    experiment = GAS | {"species": SPECIES}
    scene = build(experiment, 0.9, 0.0)
    gas = theory.mixture(SPECIES, 0.9, 0.0)
    rate = theory.mixture_relaxation_rate(gas, 160 * np.pi * 2.5 / 1e4)
    assert cooling.R_relaxation_rate(scene, experiment) == pytest.approx(rate, rel=1e-9)
    assert rate < theory.relaxation_rate(0.9, 0.0)
    assert cooling.transient_length(scene, 8.0, experiment) == pytest.approx(8 / rate)


@pytest.mark.slow
@pytest.mark.parametrize("box", [[75, 75], [30, 30, 30]], ids=["disks", "spheres"])
def test_the_pressure_of_an_elastic_mixture_is_that_of_its_equation_of_state(box):
    species = [{"fraction": 0.6, "mass": 1}, {"fraction": 0.4, "radius": 2, "mass": 3}]
    mixed = {"particles": 300, "box": box, "species": species}
    mixed["effects"] = {"contact_stress": {}}
    scene, state = begin(mixed, 1.0, -1.0, 5)
    before, after = (run(state, scene, 1, collisions=number) for number in (10_000, 100_000))
    trace = [name for name in columns_of_pairs(STRESSES, 2) if name[2] == name[6]]
    virial = sum(after[name][0] - before[name][0] for name in trace)
    elapsed = after["time"][0] - before["time"][0]
    square = sum(after[f"vv_{axis}"][0] for axis in "xyz"[: len(box)])
    mixture = theory.mixture(species, 1.0, -1.0, dimension=len(box))
    expected = theory.compressibility(mixture, packing(mixed))
    assert 1.0 + virial / (elapsed * square) == pytest.approx(expected, rel=0.01)
