"""Absent effects leave no code, no memory, no events and no variables in the dataset."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from brute_force import KERNELS, begin, kernels, run, settings
from machine_code import checksums, sections
from raw import build, run_point
from schedules import COOLING, STEADY

from roughgas.data.point import read_point, write_point
from roughgas.data.variables import POINT, POINT_COORDINATES
from roughgas.effects import EFFECTS
from roughgas.effects.walls import SIDES
from roughgas.kernel import mathematics
from roughgas.kernel.state import BOUNDARY, BOUNDARY_HITS

PROGRAM = Path(__file__).parent.parent / "machine_code.py"
DRIVES = {"floor", "shaken_walls", "shear", "thermostat", "langevin", "delta"}
DRIVES |= {"bottom_wall", "front_wall"}
FLOWS = {"shear", "bottom_wall", "front_wall"}  # walls of sides that may slide across the flow
SMALL_BOXES = {2: (16, [20, 20]), 3: (16, [12, 12, 12])}


def small_settings(kernel):
    """Settings of a kernel with 16 particles."""
    box = KERNELS[kernel]["box"]
    number, lengths = SMALL_BOXES[len(box)]
    height = "open" if box[-1] == "open" else lengths[-1]
    return settings(kernel, number, [*lengths[:-1], height])


def compiled_without(folder, kernel, *effects):
    """Compile a kernel in a new process, with broken hooks of its absent and of the named effects.

    Returns the finished process, whose output has the checksums of the machine code.
    """
    environment = os.environ | {"ROUGHGAS_CACHE_DIR": str(folder)}
    environment["PYTHONPATH"] = os.pathsep.join(path for path in sys.path if path)
    command = [sys.executable, str(PROGRAM), kernel, *effects]
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=600)


EVERY_EFFECT = ["sheared", "walled", "shaken", "heated spheres", "viscoelastic", "tabulated bed"]
EVERY_EFFECT += ["bath", "monolayer", "container", "closed spheres", "layer"]
"""Kernels that together have every effect; `smooth` has none."""


@pytest.mark.slow  # compiles without the cache; the quick tests below read machine code
@pytest.mark.parametrize("kernel", ["smooth", *EVERY_EFFECT])
def test_the_machine_code_is_the_same_where_absent_effects_could_not_be_compiled(kernel, tmp_path):
    """All bytes of the instructions and the constants of a scene."""
    result = compiled_without(tmp_path, kernel)
    assert result.returncode == 0, result.stderr
    section_checksums = json.loads(result.stdout)
    assert section_checksums == checksums(kernel)
    assert set(EFFECTS) == {
        name for other_kernel in EVERY_EFFECT for name in KERNELS[other_kernel]["effects"]
    }
    assert sum(length for name, (length, _) in section_checksums.items() if "text" in name) > 10_000


@pytest.mark.slow
def test_a_present_effect_with_broken_hooks_cannot_be_compiled(tmp_path):
    """So the test above would notice code of an absent effect."""
    result = compiled_without(tmp_path, "friction", "friction")
    assert result.returncode != 0 and "no_such_thing" in result.stderr


@pytest.mark.parametrize("kernel", kernels("smooth", "gas", "friction", "heated"))
def test_machine_code_has_the_multipliers_of_random_numbers_only_where_they_are_drawn(kernel):
    """SplitMix64's constants, which no other code has."""
    code = b"".join(sections(kernel).values())
    heated = "thermostat" in KERNELS[kernel]["effects"]
    for number in (mathematics.INCREMENT, mathematics.MULTIPLIER_1, mathematics.MULTIPLIER_2):
        assert (np.uint64(number).tobytes() in code) == heated


@pytest.mark.parametrize("kernel", ["smooth", "gas", "heated", "spheres", "walled"])
def test_a_state_has_arrays_of_present_effects_only(kernel):
    """Spins, running sums, times of particles, the log of contacts, and the random generator."""
    effects = set(KERNELS[kernel]["effects"])
    _, state = begin(small_settings(kernel), 0.9, -1.0)
    effect_arrays = [
        arrays._asdict() for arrays in (state.sums, state.particle_times) if arrays is not None
    ]
    assert {
        name for arrays in effect_arrays for name, array in arrays.items() if array is not None
    } <= effects
    assert (state.spin is not None) == ("spin" in effects)
    assert (state.log is not None) == ("contact_log" in effects)
    assert (state.paths is not None) == ("paths" in effects)
    assert (state.random is not None) == ("thermostat" in effects)


@pytest.mark.parametrize("kernel", kernels("smooth", "gas", "sheared", "friction", "heated"))
def test_no_events_of_absent_effects_are_predicted(kernel):
    """At 300 instants; with a thermostat, only its own events."""
    scene, state = begin(small_settings(kernel), 0.9, -1.0, 1)
    kicks = 0
    for _ in range(300):
        run(state, scene, 1, collisions=1)
        kicks += np.count_nonzero(state.agenda.kind == BOUNDARY)
    assert state.counts[BOUNDARY_HITS] == 0
    if kernel != "heated":
        assert kicks == 0
    else:
        assert kicks > 0
        rank = 1  # of the thermostat among the present effects
        assert set(state.agenda.boundary_code) == {8 * rank}


def test_smooth_disks_move_as_rough_ones_at_beta_minus_1():
    """The same positions and velocities, to the last bit."""
    trajectories = []
    for name in ("gas", "smooth"):
        scene, state = begin(small_settings(name), 0.9, -1.0, 3)
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
# effects that do work have a source in the energy balance
WORK = ("floor", "walls", "shaken_walls", *SIDES, "shear", "thermostat", "langevin", "delta")


@pytest.mark.parametrize("kernel", kernels())
def test_a_point_holds_nothing_of_absent_effects(kernel, tmp_path):
    """Simulated by the protocol that fits, written and read."""
    effects = set(KERNELS[kernel]["effects"])
    driven = effects & DRIVES
    experiment = small_settings(kernel) | {"schedule": STEADY if driven else COOLING}
    point = run_point(build(experiment, 0.9, 0.2 if "spin" in effects else -1.0), experiment, 1)
    variables = set(point.variables)
    assert variables <= set(POINT)
    assert not [name for name in variables if "species" in name]
    assert bool(variables & OF_SPIN) == ("spin" in effects)
    assert bool(variables & OF_CONTACT_TIME) == ("contact_time" in effects)
    assert bool(variables & {"contacts_lost", "logged_time"}) == ("contact_log" in effects)
    assert bool(variables & OF_CONTACTS) == ("contact_averages" in effects and bool(driven))
    unsubtracted = OF_SHEAR & variables
    moving = {
        name for name, parameters in KERNELS[kernel]["effects"].items() if "velocity" in parameters
    }
    assert bool(unsubtracted) == bool(moving & FLOWS)
    assert ("inertia" in point.attributes) == ("spin" in effects)
    sources = ["gravity"] if "direction" in KERNELS[kernel]["effects"].get("gravity", {}) else []
    sources += [name for name in WORK if name in effects]
    assert point.variables["source"] == [*sources, "contacts"]
    assert point.variables["energy_imbalance"] < 1e-12

    point.attributes.update(experiment="one", scale="small")
    write_point(tmp_path / "point.nc", point)
    data = read_point(tmp_path / "point.nc")
    assert set(data.variables) == variables | POINT_COORDINATES.keys()
    if "spin" not in effects:
        assert np.all(data.energy_input.sel(motion="rotation") == 0.0)
