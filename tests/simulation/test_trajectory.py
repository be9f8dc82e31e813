"""Trajectories of points, and their files in each format."""

import functools
import itertools
import re
import shutil
from inspect import signature

import gsd.fl
import gsd.hoomd
import netCDF4
import numpy as np
import pytest
from brute_force import kernels, settings
from raw import build, chosen, cooling, run_point, snapshots, variables
from schedules import COOLING, STEADY

from roughgas import trajectory
from roughgas.base import InputError
from roughgas.data.point import as_dataset
from roughgas.data.trajectory import (
    FORMATS,
    as_trajectory,
    growing_trajectory,
    lengths_and_angles,
    write_trajectory,
)
from roughgas.data.trajectory import file_frames as frames_of_values
from roughgas.simulation.energies import restored
from roughgas.simulation.saved_states import initial_states_of
from roughgas.simulation.trajectory import Take

R, BETA, SEED = 0.9, 0.3, 7
DRIVEN = {
    "bed": settings("bed", 16, [10, "open"]),
    "sheared": settings("sheared", 16, [12, 12]),
    "shaken": settings("shaken", 16, [12, 12]),
}
NAMES = ["bed", "sheared", "shaken", "spheres"]
MIXTURE = pytest.param("mixture", marks=pytest.mark.slow)
INERTIA = {"bed": 0.5, "spheres": 0.4, "mixture": 0.5}  # in m a^2, of a mixture the small ones
KINDS = [
    {"name": "small", "fraction": 0.5},
    {"name": "large", "fraction": 0.5, "radius": 1.5, "mass": 5.0, "inertia": 0.25},
]


def experiment_of(name):
    """Settings of an experiment with its schedule."""
    if name == "spheres":
        return settings("spheres", 20, [9, 9, 9]) | {"schedule": COOLING}
    if name == "mixture":
        return settings("sheared", 16, [16, 16]) | {"species": KINDS, "schedule": STEADY}
    return DRIVEN[name] | {"schedule": STEADY}


def film(name, times):
    """(scene, trajectory dataset) of an experiment at these times."""
    experiment = experiment_of(name)
    scene = build(experiment, R, BETA)
    shots = list(snapshots(scene, experiment, SEED, Take.at(times)))
    return scene, as_trajectory(variables(scene, experiment, shots), {"title": name})


def frames(trajectory):
    """The frames of a trajectory dataset."""
    return frames_of_values(
        {name: variable.values for name, variable in trajectory.variables.items()}
    )


@functools.cache
def sample(name):
    """The trajectory dataset of an experiment at four instants."""
    return film(name, [1.0, 2.0, 4.0, 7.5])[1]


@pytest.mark.parametrize("name", kernels(*DRIVEN))
def test_energies_of_the_particles_are_those_of_the_point(name):
    experiment = experiment_of(name)
    point = run_point(build(experiment, R, BETA), experiment, SEED).variables
    scene, dataset = film(name, point["time"][:20])
    velocity, spin = dataset.velocity.values, dataset.spin.values
    if scene.effects.shear is not None:
        height = dataset.position.values[..., 1] - scene.middle
        velocity[..., 0] -= scene.effects.shear.velocity / (2 * scene.middle) * height
        spin = spin - spin.mean(axis=1, keepdims=True)
    E_trans = (velocity**2).sum(axis=(1, 2)) / (2 * 2 * 16)
    E_rot = scene.effects.spin.inertia * (spin**2).sum(axis=(1, 2)) / (2 * 16)
    # instants differ by roundings; chaos would amplify larger errors
    assert E_trans == pytest.approx(point["E_trans_series"][:20], rel=1e-9)
    assert E_rot == pytest.approx(point["E_rot_series"][:20], rel=1e-9)
    assert dataset.E_trans.values == pytest.approx(E_trans, rel=1e-12)


def test_frames_of_a_cooling_gas_are_at_the_requested_collisions():
    experiment = settings("gas", 20, [30, 30]) | {"schedule": COOLING}
    gas = cooling.start(build(experiment, R, BETA), experiment, SEED)
    rows = cooling.sample(gas, 1, 25)
    expected = restored(gas.energies(rows), rows["exponent"]).translational
    shots = snapshots(build(experiment, R, BETA), experiment, SEED, Take.at([0.0, *range(1, 26)]))
    assert [shot.E_trans for shot in shots][1:] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("name", ["sheared", "bed"])
def test_a_trajectory_goes_on_from_the_state_of_a_run(name):
    experiment = DRIVEN[name] | {"schedule": STEADY}
    scene = build(experiment, R, BETA)
    point = run_point(scene, experiment | {"keep_state": True}, SEED)
    attributes = {"experiment": "x", "scale": "small"} | point.attributes
    states = initial_states_of(as_dataset(point._replace(attributes=attributes)))
    times = [60.0, 61.0, 63.0]
    uninterrupted = list(snapshots(scene, experiment, SEED, Take.at(times)))
    request = chosen(experiment, scene, times=times, initial=states)
    for expected, shot in zip(
        uninterrupted, snapshots(scene, experiment, 99, request, states), strict=True
    ):
        assert shot.time == pytest.approx(expected.time, rel=1e-12)
        assert shot.position == pytest.approx(expected.position, abs=1e-9)
        assert shot.spin == pytest.approx(expected.spin, abs=1e-9)
        assert shot.angle == pytest.approx(expected.angle, abs=1e-9)
    assert np.abs(shot.angle).max() > 0.5
    assert chosen(experiment, scene, initial=states).start == states[0].time
    with pytest.raises(InputError, match=r"times = 59\.0: must be 60 or more, where the initial"):
        chosen(experiment, scene, times=[59.0, 61.0], initial=states)


def smallest_distance(cell, position, periodic):
    """The smallest distance of two particles or their images, over all neighbouring images."""
    images = itertools.product(*((-1, 0, 1) if is_periodic else (0,) for is_periodic in periodic))
    separations = position[:, None] - position[None]
    smallest_distances = []
    for image in images:
        distance = np.linalg.norm(separations + np.array(image) @ cell, axis=-1)
        smallest_distances.append(
            np.where(np.eye(len(position)) * (not any(image)), np.inf, distance).min()
        )
    return min(smallest_distances)


@pytest.mark.parametrize("name", kernels(*NAMES))
def test_no_two_particles_are_closer_than_a_diameter_in_the_cell_of_the_file(name):
    dataset = sample(name)
    periodic = [*dataset.periodic.values, 0][:3]
    smallest_distances = [
        smallest_distance(frame.cell, frame.position, periodic) for frame in frames(dataset)
    ]
    assert 2.0 - 1e-9 < min(smallest_distances) < 2.5
    if name == "sheared":  # without the offset of the image above there are overlaps
        rectangular_cells = [np.diag(np.diag(frame.cell)) for frame in frames(dataset)]
        shots = zip(rectangular_cells, frames(dataset), strict=True)
        assert min(smallest_distance(cell, frame.position, periodic) for cell, frame in shots) < 2.0


COMMENT_PATTERN = re.compile(
    r'Lattice="([^"]*)" Properties=(\S+) pbc="([^"]*)" Time=(\S+) source=roughgas'
)  # extended XYZ


def numbers_of_xyz(path):
    """Yield (comment, array of numbers) of each frame of an extended XYZ file."""
    lines = path.read_text().splitlines()
    while lines:
        number = int(lines[0])
        rows = [[float(word) for word in line.split()[1:]] for line in lines[2 : number + 2]]
        yield lines[1], np.array(rows)
        del lines[: number + 2]


@pytest.mark.parametrize("name", kernels(*NAMES))
def test_extended_xyz_has_every_digit(name, tmp_path):
    dataset, path = sample(name), tmp_path / "new" / "bed.xyz"
    write_trajectory(path, dataset)
    for frame, (comment, columns) in zip(frames(dataset), numbers_of_xyz(path), strict=True):
        assert np.array_equal(columns[:, :3], frame.position)
        assert np.array_equal(columns[:, 3:6], frame.velocity) and np.all(columns[:, 6] == 1.0)
        assert np.array_equal(columns[:, 7:10], frame.spin)
        cell, properties, pbc, time = COMMENT_PATTERN.fullmatch(comment).groups()
        assert list(map(float, cell.split())) == frame.cell.ravel().tolist()
        assert (
            pbc == {"bed": "T F F", "shaken": "F T F", "sheared": "T T F", "spheres": "T T T"}[name]
        )
        assert properties.startswith("species:S:1:pos:R:3:velo:R:3:radius:R:1:omega:R:3")
        assert sum(map(int, properties.split(":")[2::3])) == 1 + columns.shape[1]
        assert float(time) == frame.time
    assert [file.name for file in path.parent.iterdir()] == ["bed.xyz"]


@pytest.mark.parametrize("name", kernels(*NAMES))
def test_netcdf_follows_the_conventions_of_amber(name, tmp_path):
    dataset, path = sample(name), tmp_path / "bed.nc"
    write_trajectory(path, dataset)
    with netCDF4.Dataset(path) as file:
        assert (file.Conventions, file.ConventionVersion) == ("AMBER", "1.0")
        assert b"".join(file["spatial"][:]) == b"xyz" and file["time"][:].tolist() == [
            frame.time for frame in frames(dataset)
        ]
        for number, frame in enumerate(frames(dataset)):
            assert np.array_equal(file["coordinates"][number], frame.position)
            assert np.array_equal(file["velocities"][number], frame.velocity)
            lengths, angles = lengths_and_angles(frame.cell)
            assert np.array_equal(file["cell_lengths"][number], lengths)
            assert np.array_equal(file["cell_angles"][number], angles)


@pytest.mark.parametrize("name", kernels(*NAMES))
def test_gsd_has_particles_inside_a_centred_cell(name, tmp_path):
    dataset, path = sample(name), tmp_path / "bed.gsd"
    write_trajectory(path, dataset)
    periodic = [*dataset.periodic.values, 0][:3]
    with gsd.hoomd.open(path) as file:
        assert len(file) == 4
        for frame, shot in zip(frames(dataset), file, strict=True):
            lx, ly, lz, xy, *_ = shot.configuration.box
            cell = np.array([[lx, 0, 0], [xy * ly, ly, 0], [0, 0, lz or 1]])
            assert shot.configuration.dimensions == dataset.sizes["axis"] == 3 - (lz == 0)
            assert abs(xy * ly) <= lx / 2
            scaled_position = shot.particles.position @ np.linalg.inv(cell)
            assert np.all(np.abs(scaled_position) <= 0.5 + 1e-6)
            assert smallest_distance(cell, shot.particles.position, periodic) > 2.0 - 1e-5
            assert shot.particles.velocity == pytest.approx(frame.velocity, rel=1e-5, abs=1e-6)
            assert shot.log["time"].item() == frame.time
            assert (frame.image is None) == (name == "sheared")
            image = np.zeros((len(frame.position), 3)) if frame.image is None else frame.image
            assert np.array_equal(shot.particles.image, image)
    if name != "sheared":
        periods = image[:, : dataset.sizes["axis"]] * periods_of(dataset)
        path = dataset.position.values[-1] + periods
        assert path == pytest.approx(dataset.unwrapped_position.values[-1], abs=1e-9)


GSD_IS_DOUBLE = "precision" in signature(gsd.hoomd.open).parameters
OF_PARTICLES = "position velocity orientation angmom moment_inertia diameter mass".split()


@pytest.mark.skipif(not GSD_IS_DOUBLE, reason="gsd before 5 has single precision alone")
@pytest.mark.parametrize("name", kernels("bed", "sheared", "spheres"))
def test_gsd_in_double_precision_has_every_digit(name, tmp_path):
    """All floating-point numbers of the file, read by gsd and chunk by chunk."""
    dataset, path = sample(name), tmp_path / "gas.gsd"
    write_trajectory(path, dataset, double=True)
    with gsd.hoomd.open(path) as file:
        for frame, shot in zip(frames(dataset), file, strict=True):
            assert np.array_equal(shot.particles.velocity, frame.velocity)
            assert np.array_equal(shot.log["particles/omega"], frame.spin)
            box = shot.log["box"]
            assert box == pytest.approx(shot.configuration.box, rel=1e-7)
            tall = 2.0 if np.isnan(dataset.box.values[-1]) else 1.0
            assert np.array_equal(box[:2], np.diag(frame.cell)[:2] * [1.0, tall])
            differences = shot.particles.position[1:] - shot.particles.position[:-1]
            differences -= np.diff(frame.position, axis=0) * [1, 1, dataset.sizes["axis"] == 3]
            cell = np.array([[box[0], 0, 0], [box[3] * box[1], box[1], 0], [0, 0, box[2] or 1]])
            periods = differences @ np.linalg.inv(cell)
            assert np.abs(periods - np.rint(periods)).max() < 1e-13
    with gsd.fl.open(path, "r") as file:
        for key in (key for key in OF_PARTICLES if file.chunk_exists(0, f"particles/{key}")):
            assert file.read_chunk(0, f"particles/{key}").dtype == "f8", key


def test_an_older_gsd_is_refused_in_double_precision(tmp_path, monkeypatch):
    monkeypatch.setattr(gsd.hoomd, "open", lambda name, mode="r": None)
    with pytest.raises(InputError, match=r"^gsd = [\d.]+: must be 5 or newer, to write in double"):
        write_trajectory(tmp_path / "gas.gsd", sample("bed"), double=True)
    assert not list(tmp_path.iterdir())


def periods_of(trajectory):
    """Lengths of the box along periodic axes, 0 along other axes."""
    pairs = zip(trajectory.box.values, trajectory.periodic.values, strict=True)
    return [length if periodic else 0.0 for length, periodic in pairs]


def test_images_are_whole_periods_whatever_the_roundings_are():
    """Of 2000 synthetic positions; a quotient just below a whole number counts as that number."""
    rng, box = np.random.default_rng(3), np.array([7.3, np.nan])
    position, images = rng.uniform(0.0, 7.3, (1, 2000, 2)), rng.integers(-9, 10, (2000, 2))
    images[:, 1] = 0
    values = {
        "box": box,
        "periodic": np.array([1, 0]),
        "position": position,
        "unwrapped_position": position + images * np.array([7.3, 0.0]),
        "velocity": np.zeros_like(position),
        "radius": np.ones(2000),
        "time": np.zeros(1),
    }
    (frame,) = frames_of_values(values)
    assert np.array_equal(frame.image[:, :2], images)


@pytest.mark.parametrize("ending", FORMATS)
@pytest.mark.parametrize("name", kernels("bed", "sheared"))
def test_a_file_that_grows_has_each_frame_on_the_disk_and_the_bytes_of_the_whole(
    name, ending, tmp_path
):
    experiment, times = experiment_of(name), [1.0, 2.0, 4.0, 7.5]
    scene = build(experiment, R, BETA)
    grown, copy, complete = (tmp_path / f"{stem}{ending}" for stem in ("grown", "copy", "whole"))
    with growing_trajectory(grown, name) as write:
        for number, shot in enumerate(snapshots(scene, experiment, SEED, Take.at(times)), 1):
            write(variables(scene, experiment, [shot]))
            shutil.copy(grown, copy)  # the file if the program is killed now
            assert times_in(copy) == pytest.approx(times[:number], rel=1e-9)
    write_trajectory(complete, sample(name))
    assert grown.read_bytes() == complete.read_bytes()


def times_in(path):
    """Times of the frames of a file of any format."""
    if path.suffix == ".xyz":
        return [float(COMMENT_PATTERN.fullmatch(line)[4]) for line, _ in numbers_of_xyz(path)]
    if path.suffix == ".nc":
        with netCDF4.Dataset(path) as file:
            return file["time"][:].tolist()
    with gsd.hoomd.open(path) as file:
        return [shot.log["time"].item() for shot in file]


def test_the_floor_of_an_open_box_stays_where_it_is_in_gsd(tmp_path):
    dataset, path = sample("bed"), tmp_path / "bed.gsd"
    write_trajectory(path, dataset)
    with gsd.hoomd.open(path) as file:
        highest = 0.0
        for shot, position in zip(file, dataset.position.values, strict=True):
            highest = max(highest, position[:, 1].max() + 1.0)
            assert shot.particles.position[:, 1] == pytest.approx(position[:, 1], abs=1e-5)
            assert shot.configuration.box[1] == pytest.approx(2.0 * highest, rel=1e-6)


@pytest.mark.parametrize("name", kernels(*NAMES))
def test_netcdf_has_the_units_of_the_conventions_and_the_true_ones(name, tmp_path):
    """MDAnalysis refuses files without units, with other units or with stray scale factors."""
    write_trajectory(tmp_path / "gas.nc", sample(name))
    with netCDF4.Dataset(tmp_path / "gas.nc") as file:
        check_units(file)


@pytest.mark.slow
def test_netcdf_of_a_mixture_has_units_of_masses_and_kinds(tmp_path):
    write_trajectory(tmp_path / "gas.nc", sample("mixture"))
    with netCDF4.Dataset(tmp_path / "gas.nc") as file:
        check_units(file)
        assert (file["mass"].units, file["mass"].true_units) == ("dalton", "m")
        assert (file["kind"].units, file["kind"].true_units) == ("1", "1")


def check_units(file):
    """Assert that all quantities of a netCDF file have units."""
    quantities = {
        name: variable for name, variable in file.variables.items() if variable.dtype.kind == "f"
    }
    units = {name: (variable.units, variable.true_units) for name, variable in quantities.items()}
    expected = {
        "time": ("picosecond", "T"),
        "coordinates": ("angstrom", "a"),
        "velocities": ("angstrom/picosecond", "a/T"),
        "cell_lengths": ("angstrom", "a"),
        "cell_angles": ("degree", "degree"),
    }
    assert expected.items() <= units.items()
    scaled = {name for name, variable in quantities.items() if hasattr(variable, "scale_factor")}
    assert scaled == set(expected)
    assert all(quantities[name].scale_factor == 1.0 for name in scaled)


@pytest.mark.slow
def test_extended_xyz_has_masses_momenta_and_a_symbol_for_each_kind(tmp_path):
    """ASE reads masses and velocities from these columns, and refuses symbols of no element."""
    dataset, path = sample("mixture"), tmp_path / "gas.xyz"
    write_trajectory(path, dataset)
    lines = path.read_text().splitlines()[2 : 2 + dataset.sizes["particle"]]
    kinds = dataset.species_of.values
    assert [line.split()[0] for line in lines] == [["H", "He"][kind] for kind in kinds]
    assert set(kinds) == {0, 1}
    mass = dataset.mass.values[:, None]
    for frame, (comment, columns) in zip(frames(dataset), numbers_of_xyz(path), strict=True):
        assert comment.count("mass") == 1 and "masses:R:1:momenta:R:3 " in comment
        assert np.array_equal(columns[:, -4:], np.hstack([mass, mass * frame.velocity]))


@pytest.mark.parametrize("name", ["spheres", MIXTURE, "bed"])
def test_gsd_has_moments_of_inertia_and_angular_momenta(name, tmp_path):
    """L = q m a^2 w along the spin; HOOMD's angular momentum P is 2 q (0, L), q a quaternion."""
    dataset, path = sample(name), tmp_path / "gas.gsd"
    write_trajectory(path, dataset)
    radius, moment = dataset.radius.values, np.full(dataset.sizes["particle"], INERTIA[name])
    if name == "mixture":
        moment = dataset.inertia.values * dataset.mass.values * radius**2
        assert set(moment) == {INERTIA["mixture"], 0.25 * 5.0 * 1.5**2}
    with gsd.hoomd.open(path) as file:
        for frame, shot in zip(frames(dataset), file, strict=True):
            axes = [1, 1, 1] if name == "spheres" else [0, 0, 1]
            assert shot.particles.moment_inertia == pytest.approx(np.outer(moment, axes), rel=1e-6)
            momentum = moment[:, None] * frame.spin / radius[:, None]
            scalar, vector = body_frame_momenta(shot.particles.orientation, shot.particles.angmom)
            assert scalar == pytest.approx(0.0, abs=1e-5)
            assert vector == pytest.approx(momentum, rel=1e-5, abs=1e-5)
    assert name == "spheres" or np.abs(dataset.angle.values[-1]).max() > 0.5


def body_frame_momenta(q, P):
    """Scalar and vector of conj(q) P / 2: angular momenta in the body frames."""
    scalar = q[:, 0] * P[:, 0] + np.sum(q[:, 1:] * P[:, 1:], axis=1)
    vector = q[:, :1] * P[:, 1:] - P[:, :1] * q[:, 1:] - np.cross(q[:, 1:], P[:, 1:])
    return scalar / 2, vector / 2


@pytest.mark.slow
def test_a_film_of_a_gas_that_cools_to_nothing_is_refused_in_a_line():
    small = {"particles": 5, "box": (20, 20), "effects": {"contact_time": None}}
    with pytest.raises(InputError, match=r"^length = 20000.0: must be so short that E_trans"):
        trajectory("cooling", r=0.2, beta=-0.5, length=20_000, progress=False, **small)
