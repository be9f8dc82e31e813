"""Profiles: against sums by brute force, in exact limits, and from end to end."""

import numpy as np
import pytest
from brute_force import scene_of, settings, snapshot
from brute_force.comparison import brute_force_from
from raw import initial_state
from schedules import STEADY
from tests.studies.small_runs import combined, task_results
from tests.studies.small_studies import BED, PROFILES
from tests.study_modules import module_of_study, quietly

from roughgas.simulation.gas import Gas
from roughgas.tasks.running import Experiments

runs, results = module_of_study("profiles", "tasks"), module_of_study("profiles", "results")
draw = module_of_study("profiles", "figure").draw
CONTACTS, SUMS = runs.CONTACTS, runs.SUMS
SETTINGS, EXPERIMENTS = PROFILES.settings, PROFILES.experiments


def gas_of(experiment, r=0.9, beta=0.3):
    scene, world = scene_of(experiment, r, beta)
    return Gas(scene, initial_state(scene, experiment, np.random.default_rng(7))), world


def counted_plainly(world, brute, phases, periods, width, slices):
    """Return SUMS and contacts in slices at phases, (names, phases, slices), event by event."""
    sums, contacts = np.zeros((len(SUMS), phases, slices)), np.zeros((4, phases, slices))
    rate = world.shear / world.box[1] if world.shear else 0.0
    for number in range(1, phases * periods + 1):
        event = True
        while event is not None:
            before = brute.contact_sums.copy()
            event = brute.step(number / phases)
            if event is not None and event.kind == "pair":
                middle = (brute.x[event.i, 1] + brute.x[event.j, 1]) / 2.0
                indices = round(event.time * phases) % phases, min(int(middle / width), slices - 1)
                contacts[(slice(None), *indices)] += np.array([1.0, *(brute.contact_sums - before)])
        for y, (vx, vy), w in zip(brute.x[:, 1], brute.v, brute.w[:, 2], strict=True):
            u = vx - rate * (y - world.box[1] / 2.0) if rate else vx
            row = [1.0, u, vy, u * u, vy * vy, u * vy, w, w * w]
            sums[:, number % phases, min(int(y / width), slices - 1)] += row
    return sums, contacts


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_sums_agree_with_brute_force(name):
    gas, world = gas_of(EXPERIMENTS[name])
    brute = brute_force_from(world, snapshot(gas.state, gas.scene))
    phases, periods, width, slices = 4, 2, 1.5, 12
    profile = runs.Profile(gas, {"slice": width, "period": 1}, phases, slices)
    for number in range(phases * periods):
        profile.sample_next_phase(number)
    sums, contacts = counted_plainly(world, brute, phases, periods, width, slices)
    assert contacts[0].sum() >= 10
    assert np.array_equal(profile.sums[0], sums[0])
    assert profile.sums == pytest.approx(sums, abs=1e-6)  # of chaos; numbers are of order 10
    if name == "gas":  # the same everywhere, and counted when the next phase begins
        contacts, profile.contacts = (array.sum((1, 2)) for array in (contacts, profile.contacts))
    assert profile.contacts == pytest.approx(contacts, abs=1e-6)


@pytest.mark.slow
def test_an_elastic_gas_at_rest_is_barometric():
    """On a floor at rest, n(y) of an ideal gas of N disks with a fixed energy E and no momentum
    along x is (1 - g y/E)^(2 N - 5/2); its temperature is the same at all heights.

    The bottom is filled to 0.6 %, which changes the density by about a per cent. 4 sigma, from the
    scatter over 8 runs, in some 8 slices.
    """
    number, width, g = 20, 1500.0, 0.1
    floor = {"amplitude": 0.0, "period": 1.0}
    experiment = settings("bed", number, [width, "open"], floor=floor, gravity={"acceleration": g})
    experiment |= {"schedule": STEADY}
    point = BED | {"r": "1", "beta": "-1", "slice": 2.0, "period": 8, "equilibrate": 2000}
    point |= {"measure": 3200}
    settings_of_run = SETTINGS | {"runs": 8, "phases": 2, "slices": 40, "points": [point]}
    results_of_tasks = {
        task: runs.run(task, settings_of_run, Experiments({"bed": experiment}), quietly)
        for task in runs.tasks(settings_of_run)
    }
    data = results.combine(results_of_tasks, settings_of_run).isel(point=0)
    kinetic = 2 * number * float(data.E_trans_phase.mean())
    energy = kinetic * (2 * number - 0.5) / (number - 0.5)
    edges = g * (2.0 * np.arange(41) - 1.0).clip(0.0) / energy  # the floor is met at height 1
    above = (1 - edges.clip(max=1.0)) ** (2 * number - 1.5)
    expected = number * -np.diff(above) / (width * 2.0)
    filled = expected * width * 2.0 > 0.5
    off = np.abs(data.density - expected)[filled]
    assert filled.sum() > 5
    assert np.all(off < 4 * data.density_stderr[filled] + 0.02 * expected[filled])
    temperature = kinetic / number
    for name in ("T_across", "T_along"):
        difference = np.abs(data[name] - temperature)[filled]
        assert np.all(difference < 4 * data[f"{name}_stderr"][filled])


def test_slices_have_the_energy_of_the_gas_and_every_collision():
    for run in task_results("profiles").values():
        assert results.imbalance(run) < 1e-12
        assert np.all(run.particles.sum("slice") == 16 * run.samples)
        assert set(CONTACTS) <= set(run) and run.contacts.sum() == run.collisions > 10


def test_every_point_has_its_profiles():
    data = combined("profiles")
    assert list(data.point.values) == ["bed_r0.9_beta0.3", "gas_r0.8_beta1"]
    assert list(np.isfinite(data.theta.values)) == [False, True]
    bed = data.isel(point=0)
    counted = (bed.density * 1.5 * 10).sum()
    assert float(counted) == pytest.approx(16)
    mean = bed.density_at_phase.mean("phase")
    assert mean.values == pytest.approx(bed.density.values)
    assert np.all(bed.R_phase > 0) and float(bed.R) == pytest.approx(float(bed.R_phase.mean()))
    assert float(bed.R_quarters) == pytest.approx(float(bed.R_phase[::2].mean()))


def test_the_figure_shows_every_point():
    _, _, averages, sheared = draw(combined("profiles")).axes
    assert len(averages.containers) == len(sheared.containers) == 1
