"""Pilots: the same twice, and right about what is to come."""

import math

import numpy as np
import pytest
from tests.planning.conftest import EXPERIMENTS

from roughgas.base.errors import InputError
from roughgas.planning.pilot import Pilot, read_pilot, write_pilot
from roughgas.planning.plan import explore, plan_point
from roughgas.planning.reach import completed
from roughgas.planning.steady import CHAINS, MEASURED, settling
from roughgas.scene import build
from roughgas.simulation.point import run_point

TIMES = ("seconds", "seconds_per_length")


def explored(experiment, beta):
    return explore(build(experiment, 0.9, beta), experiment)


@pytest.fixture(scope="module")
def pilots():
    """A pilot of each experiment at beta = 0."""
    return {name: explored(one, 0.0) for name, one in EXPERIMENTS.items()}


def test_the_same_pilot_twice(sheared, pilots):
    one, same = pilots["sheared"]._asdict(), explored(sheared, 0.0)._asdict()
    assert {k: one[k] for k in one if k not in TIMES} == {k: same[k] for k in one if k not in TIMES}


def test_a_driven_pilot_has_seen_enough(pilots):
    pilot = pilots["sheared"]
    assert pilot.settled and pilot.seconds > 0
    measured = pilot.length - CHAINS * pilot.transient
    assert measured >= MEASURED * pilot.autocorrelation_time
    # one relaxation of the shear flow's heating is some hundred T: neither none nor the whole run
    assert 10 < pilot.transient < pilot.length / CHAINS / 4


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_the_expected_error_and_collisions_are_those_of_independent_runs(name, pilots):
    """100 runs: their variance is known to 14 % (1 sigma), that of the pilot to about 23 %. Within
    a factor 2, 2.5 sigma on either side: fails by chance once in 80."""
    experiment, scene = EXPERIMENTS[name], build(EXPERIMENTS[name], 0.9, 0.0)
    plan = plan_point(scene, experiment, pilots[name])
    settings = completed(experiment, plan)
    found = [run_point(scene, settings, seed).variables for seed in range(100)]
    expected = plan.stderr**2 * plan.seeds
    assert expected / 2 < np.var([one["R"] for one in found], ddof=1) < 2 * expected
    made = np.mean([one["collisions"] for one in found]) * plan.seeds
    if name == "sheared":  # the cooling gas's are those of its schedule
        assert plan.collisions == pytest.approx(made, rel=0.1)


def chains(transient, noise, seed=1, count=10, periods=512):
    """Energies that decay to 1 with an e-fold of `transient`, with white noise."""
    time = np.arange(periods)
    decay = np.exp(-time / transient) if transient else np.zeros(periods)
    return 1 + decay + noise * np.random.default_rng(seed).standard_normal((count, periods))


def test_the_transient_is_where_the_energies_settle():
    """With 1 % of noise: after 3 to 6 e-folds, the windows growing by 30 %."""
    for e_fold in (4, 16):
        assert 3 * e_fold <= settling(chains(e_fold, 0.01)) <= 8 * e_fold
    assert settling(chains(0, 0.0)) == 0


def test_noise_is_seldom_taken_for_a_transient():
    """20 windows at 3 sigma: an alarm in one of 20 sets of chains."""
    alarms = [settling(chains(0, 0.3, seed)) > 64 for seed in range(60)]
    assert np.mean(alarms) < 0.15


def test_a_gas_that_nothing_makes_spin(sheared):
    """R is 0 for ever: no scatter, no memory, and the least that is ever run."""
    pilot = explored(sheared, -1.0)
    assert pilot.variance == 0 and pilot.autocorrelation_time == 1.0
    plan = plan_point(build(sheared, 0.9, -1.0), sheared, pilot)
    assert plan.stderr == 0 and plan.seeds == 1


def test_a_pilot_comes_back_as_written(tmp_path, sheared):
    pilot = Pilot(1.0, math.nan, 2.0, 9.0, 0.1, 1e-3, True, 100.0, 0.5)
    write_pilot(tmp_path / "new" / "pilot.json", pilot)
    assert str(read_pilot(tmp_path / "new" / "pilot.json")) == str(pilot)


@pytest.mark.parametrize("text", ["", "[1]", '{"transient": 1}'])
def test_what_is_no_pilot_is_refused(tmp_path, text):
    path = tmp_path / "pilot.json"
    path.write_text(text)
    with pytest.raises(InputError, match=r"pilot\.json: must be a file of `roughgas pilot`"):
        read_pilot(path)
