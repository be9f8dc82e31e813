"""Absent effects are absent: no code, no memory, no events, nothing in the dataset."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from brute_force import KERNELS, begin, kernels, run, settings
from machine_code import checksums, sections
from schedules import COOLING, STEADY

from roughgas.data.point import read_point, write_point
from roughgas.data.variables import POINT
from roughgas.effects import KINDS
from roughgas.effects.walls import SIDES
from roughgas.kernel import mathematics
from roughgas.kernel.state import BOUNDARY, BOUNDARY_HITS
from roughgas.scene import build
from roughgas.simulation.point import run_point

PROGRAM = Path(__file__).parent.parent / "machine_code.py"
DRIVES = {"floor", "shaken_walls", "shear", "thermostat", "langevin"}
DRIVES |= {"bottom_wall", "front_wall"}
FLOWS = {"shear", "bottom_wall", "front_wall"}  # of the sides, those that slide across the flow
SMALL = {2: (16, [20, 20]), 3: (16, [12, 12, 12])}


def small(kernel):
    """Settings of a kernel with 16 particles."""
    box = KERNELS[kernel]["box"]
    number, lengths = SMALL[len(box)]
    top = "open" if box[-1] == "open" else lengths[-1]
    return settings(kernel, number, [*lengths[:-1], top])


def poisoned(folder, kernel, *effects):
    """What a kernel is compiled to, in a process of its own, while all absent effects and those

    named cannot be compiled.
    """
    environment = os.environ | {"ROUGHGAS_CACHE_DIR": str(folder)}
    environment["PYTHONPATH"] = os.pathsep.join(path for path in sys.path if path)
    command = [sys.executable, str(PROGRAM), kernel, *effects]
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=600)


EVERY_EFFECT = ["sheared", "walled", "shaken", "heated spheres", "viscoelastic", "tabulated bed"]
EVERY_EFFECT += ["bath", "container", "closed spheres", "layer"]
"""Kernels in which each effect is there at least once; from the barest one all are absent."""


@pytest.mark.slow  # compiles without the cache; the quick tests below see what code there is
@pytest.mark.parametrize("kernel", ["smooth", *EVERY_EFFECT])
def test_the_machine_code_is_the_same_where_absent_effects_could_not_be_compiled(kernel, tmp_path):
    """Every byte of the instructions and the constants of a scene."""
    result = poisoned(tmp_path, kernel)
    assert result.returncode == 0, result.stderr
    found = json.loads(result.stdout)
    assert found == checksums(kernel)
    assert set(KINDS) == {name for one in EVERY_EFFECT for name in KERNELS[one]["effects"]}
    assert sum(length for name, (length, _) in found.items() if "text" in name) > 10_000


@pytest.mark.slow
def test_an_effect_that_is_there_could_not_be_compiled_so(tmp_path):
    """What the test above rests on."""
    result = poisoned(tmp_path, "friction", "friction")
    assert result.returncode != 0 and "no_such_thing" in result.stderr


@pytest.mark.parametrize("kernel", ["smooth", "gas", "friction", "heated"])
def test_the_multipliers_of_random_numbers_are_where_they_are_drawn(kernel):
    """SplitMix64's constants, which are in nothing else."""
    code = b"".join(sections(kernel).values())
    heated = "thermostat" in KERNELS[kernel]["effects"]
    for number in (mathematics.STEP, mathematics.FIRST, mathematics.SECOND):
        assert (np.uint64(number).tobytes() in code) == heated


@pytest.mark.parametrize("kernel", ["smooth", "gas", "heated", "spheres", "walled"])
def test_a_state_has_room_for_effects_that_are_there_alone(kernel):
    """Spins, running sums, times of each particle, a log, and a word of random numbers."""
    there = set(KERNELS[kernel]["effects"])
    _, state = begin(small(kernel), 0.9, -1.0)
    kept = [part._asdict() for part in (state.sums, state.moments) if part is not None]
    assert {name for part in kept for name, one in part.items() if one is not None} <= there
    assert (state.spin is not None) == ("spin" in there)
    assert (state.log is not None) == ("contact_log" in there)
    assert (state.paths is not None) == ("paths" in there)
    assert (state.random is not None) == ("thermostat" in there)


@pytest.mark.parametrize("kernel", ["smooth", "gas", "sheared", "friction", "heated"])
def test_no_events_of_absent_effects_are_foreseen(kernel):
    """At any of 300 instants; with a thermostat, only what is its own."""
    scene, state = begin(small(kernel), 0.9, -1.0, 1)
    kicks = 0
    for _ in range(300):
        run(state, scene, 1, collisions=1)
        kicks += np.count_nonzero(state.agenda.kind == BOUNDARY)
    assert state.counts[BOUNDARY_HITS] == 0
    if kernel != "heated":
        assert kicks == 0
    else:
        assert kicks > 0
        rank = 1  # the second of the effects that are there
        assert set(state.agenda.boundary_code) == {8 * rank}


def test_smooth_disks_move_as_rough_ones_at_beta_minus_1():
    """The same positions and velocities, to the last bit."""
    trajectories = []
    for name in ("gas", "smooth"):
        scene, state = begin(small(name), 0.9, -1.0, 3)
        run(state, scene, 10, collisions=10)
        trajectories.append(state.trajectory.tobytes())
    assert trajectories[0] == trajectories[1]


OF_SPIN = {
    *("R", "R_stderr", "R_dof", "R_ci95", "R_ci95_trusted", "R_ratio_of_means", "R_replica"),
    *("R_series", "R_series_stderr", "E_rot", "E_rot_series", "autocorrelation_time"),
}
OF_SHEAR = {"R_unsubtracted", "E_trans_unsubtracted", "E_rot_unsubtracted"}
OF_CONTACTS = {f"R_collisional{end}" for end in ("", "_stderr", "_dof", "_ci95")} | {
    f"contact_correlation{end}" for end in ("", "_stderr", "_dof", "_ci95")
}
OF_CONTACT_TIME = {"contact_time", "contact_time_fraction"}
# what does work has an account
WORK = ("floor", "walls", "shaken_walls", *SIDES, "shear", "thermostat", "langevin")


@pytest.mark.parametrize("kernel", kernels())
def test_a_point_holds_nothing_of_absent_effects(kernel, tmp_path):
    """By whatever protocol fits; written and read."""
    there = set(KERNELS[kernel]["effects"])
    driven = there & DRIVES
    experiment = small(kernel) | {"schedule": STEADY if driven else COOLING}
    point = run_point(build(experiment, 0.9, 0.2 if "spin" in there else -1.0), experiment, 1)
    found = set(point.variables)
    assert found <= set(POINT)
    assert not [name for name in found if "species" in name]
    assert bool(found & OF_SPIN) == ("spin" in there)
    assert bool(found & OF_CONTACT_TIME) == ("contact_time" in there)
    assert bool(found & {"contacts_lost", "logged_time"}) == ("contact_log" in there)
    assert bool(found & OF_CONTACTS) == ("contact_averages" in there and bool(driven))
    wanted = OF_SHEAR & found
    slides = {name for name, own in KERNELS[kernel]["effects"].items() if "velocity" in own}
    assert bool(wanted) == bool(slides & FLOWS)
    assert ("inertia" in point.attributes) == ("spin" in there)
    sources = [name for name in WORK if name in there]
    assert point.variables["source"] == [*sources, "contacts"]
    assert point.variables["energy_imbalance"] < 1e-12

    point.attributes.update(experiment="one", scale="small")
    write_point(tmp_path / "point.nc", point)
    data = read_point(tmp_path / "point.nc")
    assert set(data.variables) == found
    if "spin" not in there:
        assert np.all(data.energy_input.sel(motion="rotation") == 0.0)
