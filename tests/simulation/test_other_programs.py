"""Runs that begin in a frame of another program: their energies, LAMMPS beside us, refusals."""

import json
import shlex

import numpy as np
import pytest
from brute_force import settings
from tests.entry import main, outcome
from tests.other_programs import FOLDER, disks_in_gas_units, spheres_in_gas_units

from roughgas import read_frame, simulate
from roughgas.base import InputError
from roughgas.data.point import read_point
from roughgas.data.trajectory import write_trajectory

BOX = [20, 16]
SECONDS = 0.45  # between frames of disks.dump, whose time is T
NO_ERRORS = {"kind": "stages", "sample_every": SECONDS}
FIRST_SAMPLE = NO_ERRORS | {"stages": [{"duration": SECONDS, "sample_start": True}]}
SPECIES = [
    {"name": "small", "number": 8},
    {"name": "large", "number": 4, "radius": 1.5},
]


def begun(initial, r=0.9, beta=0.5, box=BOX, schedule=FIRST_SAMPLE, **changes):
    """The dataset of a run of the disks in a frame."""
    arguments = settings("gas", 16, box) | {"schedule": schedule, "progress": False} | changes
    return simulate(r=r, beta=beta, initial=initial, **arguments)


def energies_of(frame, inertia):
    """(E_trans, E_rot) per degree of freedom of particles in gas units."""
    mass, spin, velocity = frame["mass"], frame["spin"], frame["velocity"]
    trans = 0.5 * np.sum(mass[:, None] * velocity**2) / velocity.size
    return trans, 0.5 * inertia * np.sum(mass[:, None] * spin**2) / spin.size


@pytest.mark.parametrize(
    ("name", "rounding"), [("disks.dump", 1e-13), ("disks.data", 1e-13), ("disks.xyz", 1e-7)]
)
def test_the_first_sample_has_the_energies_of_the_file(name, rounding):
    """Perfectly rough elastic disks keep their total, too; ASE writes eight digits."""
    point = begun(read_frame(FOLDER / name), r=1, beta=1)
    trans, rot = energies_of(disks_in_gas_units(-1), inertia=0.5)
    assert point.E_trans_series[0] == pytest.approx(trans, rel=rounding)
    assert point.E_rot_series[0] == pytest.approx(rot, rel=rounding)
    total = 2 * point.E_trans_series + point.E_rot_series
    assert point.collisions > 0
    assert total.values == pytest.approx(np.full(2, 2 * trans + rot), rel=rounding)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["spheres.dump", "spheres.data", "spheres.gsd"])
def test_spheres_of_two_species_begin_with_the_energies_of_the_file(name):
    experiment = {"particles": 12, "box": [12, 12, 12], "effects": {"spin": {"inertia": 0.4}}}
    experiment |= {"species": SPECIES, "schedule": FIRST_SAMPLE, "progress": False}
    initial = read_frame(FOLDER / name, unit_time=0.005)
    point = simulate(r=1, beta=1, initial=initial, **experiment)
    trans, rot = energies_of(spheres_in_gas_units(), inertia=0.4)
    assert point.E_trans_series[0] == pytest.approx(trans, rel=1e-12)
    assert point.E_rot_series[0] == pytest.approx(rot, rel=1e-12)


def test_disks_go_where_those_of_lammps_go():
    """Five contacts of r = 0.9, beta = 0.5 until the third frame, by soft forces in LAMMPS.

    Contacts there last 2e-4 T, in which particles move by 6e-4 a at the mean speed, 3 a/T; chaos
    makes the difference grow by about two with each contact. A wrong sign of the spin would turn
    velocities by more than 0.1.
    """
    point = begun(read_frame(FOLDER / "disks.dump", 0), keep_state=True)
    for frame, particle_contacts in ((1, 4), (2, 10)):
        expected = disks_in_gas_units(frame)
        apart = point.last_position.values[0] - expected["position"]
        apart -= BOX * np.round(apart / BOX)
        assert np.abs(apart).max() < 5e-3
        assert np.abs(point.last_velocity.values[0] - expected["velocity"]).max() < 2e-2
        assert np.abs(point.last_spin.values[0] - expected["spin"]).max() < 2e-2
        assert point.collisions * 2 == particle_contacts // frame + (frame - 1)
        point = begun(point, keep_state=True)
    start = disks_in_gas_units(0)
    assert np.abs(start["velocity"] - disks_in_gas_units(2)["velocity"]).max() > 1


# ----------------------------------------------------------------- the command


@pytest.fixture
def command(tmp_path, monkeypatch):
    """The words of a run from a frame of LAMMPS, in an empty folder."""
    monkeypatch.chdir(tmp_path)
    text = json.dumps(settings("gas", 16, BOX) | {"schedule": FIRST_SAMPLE})
    return ["run", "gas", "--settings", text, "--r=0.9", "--beta=0.5", "--from"]


def test_a_command_begins_in_a_frame_and_says_so(command):
    options = ["--frame", "-2", "--unit-time", "2", "--unit-length", "0.5"]
    assert main([*command, str(FOLDER / "disks.dump"), *options, "-o", "first.nc"]) == 0
    point = read_point("first.nc")
    trans, rot = energies_of(disks_in_gas_units(1), inertia=0.5)
    assert point.E_trans_series[0] == pytest.approx(4 * trans, rel=1e-13)
    assert point.E_rot_series[0] == pytest.approx(4 * rot, rel=1e-13)
    words = shlex.split(point.command)[1:]
    assert main([*words[:-1], "again.nc"]) == 0
    assert np.array_equal(read_point("again.nc").E_trans_series, point.E_trans_series)


DUMP = str(FOLDER / "disks.dump")
OF_FRAME = f"{DUMP}, frame -1: initial"
WALLS = ["effects.walls.restitution=1", "effects.walls.roughness=1"]
REFUSED = [
    (["--frame", "3"], f"frame = 3: must lie in [-3, 2]: {DUMP} has 3"),
    (["--frame", "last"], "--frame = last: must be a whole number: 0, 1, ..., or -1"),
    (["--unit-length", "0"], "--unit-length = 0.0: must lie in (0, inf)"),
    (["--unit-mass", "kg"], "--unit-mass = kg: must be a number"),
    (["--unit-length", "1"], f"{OF_FRAME}.box[0] = 10: must be 20, as in the settings"),
    (["--unit-mass", "1"], f"{OF_FRAME}.mass of particle 0 = 0.785398"),
    (["--seed", "2"], "seed = 2: must be left out: nothing in this scene is random"),
    (["--set", "particles=15"], f"{OF_FRAME}.position = of shape (16, 2): must have the shape"),
    (["--set", "box=[20,16,9]"], f"{OF_FRAME}.position = of shape (16, 2): must have the shape"),
    (["--set", "box=[20,17]"], f"{OF_FRAME}.box[1] = 16: must be 17, as in the settings"),
    (["--set", *WALLS], f"{OF_FRAME} position of particle"),
    (["--set", "species=[{number: 8}, {number: 8}]"], f"{OF_FRAME} = without species_of"),
]


@pytest.mark.parametrize(("options", "message"), REFUSED)
def test_what_does_not_fit_the_settings_is_refused_with_the_name_of_the_file(
    command, options, message
):
    status, errors = outcome([*command, DUMP, *options, "-o", "out.nc"])
    assert status == 2 and errors.startswith(f"roughgas: error: {message}")
    assert errors.count("\n") == 1


def test_options_of_other_programs_need_their_files(command):
    for option in (["--frame", "1"], ["--unit-time", "2"]):
        status, errors = outcome([*command[:-1], *option])
        legal = "must come with a file of another program: --from FILE"
        assert (status, errors) == (2, f"roughgas: error: {option[0]} = {option[1]}: {legal}\n")


def test_overlaps_are_refused_as_particles_of_the_file():
    frame = read_frame(FOLDER / "disks.dump")
    frame["position"][1] = frame.position[0] + 0.5
    with pytest.raises(InputError, match=r"disks.dump, frame -1: distance of particles 0 and 1 = "):
        begun(frame)


def test_species_of_a_file_must_be_those_of_the_settings():
    frame = read_frame(FOLDER / "spheres.gsd")
    experiment = {"particles": 12, "box": [12, 12, 12], "effects": {"spin": {"inertia": 0.4}}}
    experiment |= {"schedule": FIRST_SAMPLE, "progress": False, "initial": frame}
    first, second = SPECIES
    cases = {
        "initial.species = small, large: must be those of the experiment: small, big": [
            first,
            second | {"name": "big"},
        ],
        r"initial.species = \[8, 4\] particles of each: must be \[4, 8\] of each": [
            first | {"number": 4},
            second | {"number": 8},
        ],
        "initial.radius of particle 8, of species large = 1.5: must be one of its": [
            first,
            second | {"radius": 1.4},
        ],
        "initial.inertia of particle 8 = 0.4: must be 0.3, as in the settings": [
            first,
            second | {"inertia": 0.3},
        ],
        "initial.mass of particle 8 = 3.3.*: must be 3, as in the settings": [
            first,
            second | {"mass": 3},
        ],
    }
    for message, species in cases.items():
        with pytest.raises(InputError, match=f"spheres.gsd, frame -1: {message}"):
            simulate(r=1, beta=1, species=species, **experiment)
    with pytest.raises(
        InputError, match=r"frame -1: initial.species_of = there: must not be there"
    ):
        simulate(r=1, beta=1, **experiment)


def test_a_tilted_frame_of_a_sheared_gas_is_refused(tmp_path):
    from simulation.test_trajectory import sample

    path = tmp_path / "sheared.xyz"
    write_trajectory(path, sample("sheared"))
    with pytest.raises(InputError, match=r"Lattice = .*: must be a rectangular box, without tilt"):
        read_frame(path)
