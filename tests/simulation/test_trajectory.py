"""Trajectories: what the files hold is the trajectory of the point, in the form of each format."""

import functools
import itertools
import re
import shutil

import gsd.hoomd
import netCDF4
import numpy as np
import pytest
from brute_force import kernels, settings
from schedules import COOLING, STEADY

from roughgas.base import InputError
from roughgas.data.point import as_dataset
from roughgas.data.trajectory import (
    FORMATS,
    as_trajectory,
    growing_trajectory,
    lengths_and_angles,
    write_trajectory,
)
from roughgas.data.trajectory import frames as frames_of_values
from roughgas.scene import build
from roughgas.simulation import cooling
from roughgas.simulation.energies import restored
from roughgas.simulation.point import run_point
from roughgas.simulation.saved import initial_of
from roughgas.simulation.trajectory import Frames, chosen, snapshots, variables

R, BETA, SEED = 0.9, 0.3, 7
DRIVEN = {
    "bed": settings("bed", 16, [10, "open"]),
    "sheared": settings("sheared", 16, [12, 12]),
    "shaken": settings("shaken", 16, [12, 12]),
}
NAMES = ["bed", "sheared", "shaken", "spheres"]
INERTIA = {"bed": 0.5, "spheres": 0.4, "mixture": 0.5}  # in m a^2, of a mixture the small ones
KINDS = [
    {"name": "small", "fraction": 0.5},
    {"name": "large", "fraction": 0.5, "radius": 1.5, "mass": 5.0, "inertia": 0.25},
]


def experiment_of(name):
    if name == "spheres":
        return settings("spheres", 20, [9, 9, 9]) | {"schedule": COOLING}
    if name == "mixture":
        return settings("sheared", 16, [16, 16]) | {"species": KINDS, "schedule": STEADY}
    return DRIVEN[name] | {"schedule": STEADY}


def taken(name, times):
    experiment = experiment_of(name)
    scene = build(experiment, R, BETA)
    shots = list(snapshots(scene, experiment, SEED, Frames.at(times)))
    return scene, as_trajectory(variables(scene, experiment, shots), {"title": name})


def frames(trajectory):
    return frames_of_values({name: one.values for name, one in trajectory.variables.items()})


@functools.cache
def sample(name):
    return taken(name, [1.0, 2.0, 4.0, 7.5])[1]


@pytest.mark.parametrize("name", kernels(*DRIVEN))
def test_energies_of_the_particles_are_those_of_the_point(name):
    experiment = experiment_of(name)
    point = run_point(build(experiment, R, BETA), experiment, SEED).variables
    scene, found = taken(name, point["time"][:20])
    velocity, spin = found.velocity.values, found.spin.values
    if scene.effects.shear is not None:
        height = found.position.values[..., 1] - scene.middle
        velocity[..., 0] -= scene.effects.shear.velocity / (2 * scene.middle) * height
        spin = spin - spin.mean(axis=1, keepdims=True)
    E_trans = (velocity**2).sum(axis=(1, 2)) / (2 * 2 * 16)
    E_rot = scene.effects.spin.inertia * (spin**2).sum(axis=(1, 2)) / (2 * 16)
    # roundings of the instants, and nothing else: chaos would make any more of it
    assert E_trans == pytest.approx(point["E_trans_series"][:20], rel=1e-9)
    assert E_rot == pytest.approx(point["E_rot_series"][:20], rel=1e-9)
    assert found.E_trans.values == pytest.approx(E_trans, rel=1e-12)


def test_a_cooling_gas_is_seen_after_the_collisions_asked_for():
    experiment = settings("gas", 20, [30, 30]) | {"schedule": COOLING}
    gas = cooling.start(build(experiment, R, BETA), experiment, SEED)
    rows = cooling.sample(gas, 1, 25)
    known = restored(gas.energies(rows), rows["exponent"]).translational
    shots = snapshots(build(experiment, R, BETA), experiment, SEED, Frames.at([0.0, *range(1, 26)]))
    assert [shot.E_trans for shot in shots][1:] == pytest.approx(known, rel=1e-12)


@pytest.mark.parametrize("name", ["sheared", "bed"])
def test_it_goes_on_from_the_state_of_a_run(name):
    experiment = DRIVEN[name] | {"schedule": STEADY}
    scene = build(experiment, R, BETA)
    point = run_point(scene, experiment | {"keep_state": True}, SEED)
    about = {"experiment": "x", "scale": "small"} | point.attributes
    states = initial_of(as_dataset(point._replace(attributes=about)))
    at = [60.0, 61.0, 63.0]
    whole = list(snapshots(scene, experiment, SEED, Frames.at(at)))
    take = chosen(experiment, scene, times=at, initial=states)
    for one, other in zip(whole, snapshots(scene, experiment, 99, take, states), strict=True):
        assert other.time == pytest.approx(one.time, rel=1e-12)
        assert other.position == pytest.approx(one.position, abs=1e-9)
        assert other.spin == pytest.approx(one.spin, abs=1e-9)
        assert other.angle == pytest.approx(one.angle, abs=1e-9)
    assert np.abs(other.angle).max() > 0.5
    assert chosen(experiment, scene, initial=states).start == states[0].time
    with pytest.raises(InputError, match=r"times = 59\.0: must be 60 or more, where the initial"):
        chosen(experiment, scene, times=[59.0, 61.0], initial=states)


def least_distance(cell, position, periodic):
    """Of two particles or images of them, by brute force."""
    images = itertools.product(*((-1, 0, 1) if one else (0,) for one in periodic))
    apart = position[:, None] - position[None]
    found = []
    for image in images:
        distance = np.linalg.norm(apart + np.array(image) @ cell, axis=-1)
        found.append(np.where(np.eye(len(position)) * (not any(image)), np.inf, distance).min())
    return min(found)


@pytest.mark.parametrize("name", kernels(*NAMES))
def test_no_two_particles_are_closer_than_a_diameter_in_the_cell_of_the_file(name):
    found = sample(name)
    periodic = [*found.periodic.values, 0][:3]
    least = [least_distance(one.cell, one.position, periodic) for one in frames(found)]
    assert 2.0 - 1e-9 < min(least) < 2.5
    if name == "sheared":  # the image above has slid, or there would be overlaps
        square = [np.diag(np.diag(one.cell)) for one in frames(found)]
        shots = zip(square, frames(found), strict=True)
        assert min(least_distance(cell, one.position, periodic) for cell, one in shots) < 2.0


HEAD = re.compile(r'Lattice="([^"]*)" Properties=(\S+) pbc="([^"]*)" Time=(\S+)')  # extended XYZ


def numbers_of_xyz(path):
    """Comment and numbers of each frame of an extended XYZ file."""
    lines = path.read_text().splitlines()
    while lines:
        number = int(lines[0])
        rows = [[float(word) for word in line.split()[1:]] for line in lines[2 : number + 2]]
        yield lines[1], np.array(rows)
        del lines[: number + 2]


@pytest.mark.parametrize("name", kernels(*NAMES))
def test_text_has_every_digit(name, tmp_path):
    found, path = sample(name), tmp_path / "new" / "bed.xyz"
    write_trajectory(path, found)
    for one, (comment, columns) in zip(frames(found), numbers_of_xyz(path), strict=True):
        assert np.array_equal(columns[:, :3], one.position)
        assert np.array_equal(columns[:, 3:6], one.velocity) and np.all(columns[:, 6] == 1.0)
        assert np.array_equal(columns[:, 7:10], one.spin)
        cell, properties, pbc, time = HEAD.fullmatch(comment).groups()
        assert list(map(float, cell.split())) == one.cell.ravel().tolist()
        assert (
            pbc == {"bed": "T F F", "shaken": "F T F", "sheared": "T T F", "spheres": "T T T"}[name]
        )
        assert properties.startswith("species:S:1:pos:R:3:velo:R:3:radius:R:1:omega:R:3")
        assert sum(map(int, properties.split(":")[2::3])) == 1 + columns.shape[1]
        assert float(time) == one.time
    assert [file.name for file in path.parent.iterdir()] == ["bed.xyz"]


@pytest.mark.parametrize("name", kernels(*NAMES))
def test_netcdf_follows_the_conventions_of_amber(name, tmp_path):
    found, path = sample(name), tmp_path / "bed.nc"
    write_trajectory(path, found)
    with netCDF4.Dataset(path) as file:
        assert (file.Conventions, file.ConventionVersion) == ("AMBER", "1.0")
        assert b"".join(file["spatial"][:]) == b"xyz" and file["time"][:].tolist() == [
            one.time for one in frames(found)
        ]
        for number, one in enumerate(frames(found)):
            assert np.array_equal(file["coordinates"][number], one.position)
            assert np.array_equal(file["velocities"][number], one.velocity)
            lengths, angles = lengths_and_angles(one.cell)
            assert np.array_equal(file["cell_lengths"][number], lengths)
            assert np.array_equal(file["cell_angles"][number], angles)


@pytest.mark.parametrize("name", kernels(*NAMES))
def test_gsd_has_particles_inside_a_centred_cell(name, tmp_path):
    found, path = sample(name), tmp_path / "bed.gsd"
    write_trajectory(path, found)
    periodic = [*found.periodic.values, 0][:3]
    with gsd.hoomd.open(path) as file:
        assert len(file) == 4
        for one, shot in zip(frames(found), file, strict=True):
            lx, ly, lz, xy, *_ = shot.configuration.box
            cell = np.array([[lx, 0, 0], [xy * ly, ly, 0], [0, 0, lz or 1]])
            assert shot.configuration.dimensions == found.sizes["axis"] == 3 - (lz == 0)
            assert abs(xy * ly) <= lx / 2
            within = shot.particles.position @ np.linalg.inv(cell)
            assert np.all(np.abs(within) <= 0.5 + 1e-6)
            assert least_distance(cell, shot.particles.position, periodic) > 2.0 - 1e-5
            assert shot.particles.velocity == pytest.approx(one.velocity, rel=1e-5, abs=1e-6)
            assert shot.log["time"].item() == one.time
            assert (one.image is None) == (name == "sheared")
            image = np.zeros((len(one.position), 3)) if one.image is None else one.image
            assert np.array_equal(shot.particles.image, image)
    if name != "sheared":
        periods = image[:, : found.sizes["axis"]] * periods_of(found)
        path = found.position.values[-1] + periods
        assert path == pytest.approx(found.unwrapped_position.values[-1], abs=1e-9)


def periods_of(trajectory):
    """Lengths of the periodic axes, 0 of the others."""
    pairs = zip(trajectory.box.values, trajectory.periodic.values, strict=True)
    return [length if periodic else 0.0 for length, periodic in pairs]


def test_images_are_whole_periods_whatever_the_roundings_are():
    """Of 2000 made-up positions; a quotient just below a whole number is that number."""
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
    experiment, at = experiment_of(name), [1.0, 2.0, 4.0, 7.5]
    scene = build(experiment, R, BETA)
    grown, copy, whole = (tmp_path / f"{one}{ending}" for one in ("grown", "copy", "whole"))
    with growing_trajectory(grown, name) as write:
        for number, shot in enumerate(snapshots(scene, experiment, SEED, Frames.at(at)), 1):
            write(variables(scene, experiment, [shot]))
            shutil.copy(grown, copy)  # what is left if the program is killed now
            assert times_in(copy) == pytest.approx(at[:number], rel=1e-9)
    write_trajectory(whole, sample(name))
    assert grown.read_bytes() == whole.read_bytes()


def times_in(path):
    if path.suffix == ".xyz":
        return [float(HEAD.fullmatch(line)[4]) for line, _ in numbers_of_xyz(path)]
    if path.suffix == ".nc":
        with netCDF4.Dataset(path) as file:
            return file["time"][:].tolist()
    with gsd.hoomd.open(path) as file:
        return [shot.log["time"].item() for shot in file]


def test_the_floor_of_an_open_box_stays_where_it_is_in_gsd(tmp_path):
    found, path = sample("bed"), tmp_path / "bed.gsd"
    write_trajectory(path, found)
    with gsd.hoomd.open(path) as file:
        reached = 0.0
        for shot, position in zip(file, found.position.values, strict=True):
            reached = max(reached, position[:, 1].max() + 1.0)
            assert shot.particles.position[:, 1] == pytest.approx(position[:, 1], abs=1e-5)
            assert shot.configuration.box[1] == pytest.approx(2.0 * reached, rel=1e-6)


@pytest.mark.parametrize("name", kernels(*NAMES))
def test_netcdf_has_the_units_of_the_conventions_and_the_true_ones(name, tmp_path):
    """MDAnalysis reads no file without units, nor one with other units or stray scale factors."""
    write_trajectory(tmp_path / "gas.nc", sample(name))
    with netCDF4.Dataset(tmp_path / "gas.nc") as file:
        check_units(file)


def test_netcdf_of_a_mixture_has_units_of_masses_and_kinds(tmp_path):
    write_trajectory(tmp_path / "gas.nc", sample("mixture"))
    with netCDF4.Dataset(tmp_path / "gas.nc") as file:
        check_units(file)
        assert (file["mass"].units, file["mass"].true_units) == ("dalton", "m")
        assert (file["kind"].units, file["kind"].true_units) == ("1", "1")


def check_units(file):
    quantities = {name: one for name, one in file.variables.items() if one.dtype.kind == "f"}
    units = {name: (one.units, one.true_units) for name, one in quantities.items()}
    expected = {
        "time": ("picosecond", "T"),
        "coordinates": ("angstrom", "a"),
        "velocities": ("angstrom/picosecond", "a/T"),
        "cell_lengths": ("angstrom", "a"),
        "cell_angles": ("degree", "degree"),
    }
    assert expected.items() <= units.items()
    scaled = {name for name, one in quantities.items() if hasattr(one, "scale_factor")}
    assert scaled == set(expected)
    assert all(quantities[name].scale_factor == 1.0 for name in scaled)


def test_extended_xyz_has_masses_momenta_and_a_symbol_for_each_kind(tmp_path):
    """ASE takes masses and velocities from these columns, and refuses symbols of no element."""
    found, path = sample("mixture"), tmp_path / "gas.xyz"
    write_trajectory(path, found)
    lines = path.read_text().splitlines()[2 : 2 + found.sizes["particle"]]
    kinds = found.species_of.values
    assert [line.split()[0] for line in lines] == [["H", "He"][kind] for kind in kinds]
    assert set(kinds) == {0, 1}
    mass = found.mass.values[:, None]
    for one, (comment, columns) in zip(frames(found), numbers_of_xyz(path), strict=True):
        assert comment.count("mass") == 1 and "masses:R:1:momenta:R:3 " in comment
        assert np.array_equal(columns[:, -4:], np.hstack([mass, mass * one.velocity]))


@pytest.mark.parametrize("name", ["spheres", "mixture", "bed"])
def test_gsd_has_moments_of_inertia_and_angular_momenta(name, tmp_path):
    """L = q m a^2 w along the spin; an angular momentum P of HOOMD is 2 q (0, L)."""
    found, path = sample(name), tmp_path / "gas.gsd"
    write_trajectory(path, found)
    radius, moment = found.radius.values, np.full(found.sizes["particle"], INERTIA[name])
    if name == "mixture":
        moment = found.inertia.values * found.mass.values * radius**2
        assert set(moment) == {INERTIA["mixture"], 0.25 * 5.0 * 1.5**2}
    with gsd.hoomd.open(path) as file:
        for one, shot in zip(frames(found), file, strict=True):
            axes = [1, 1, 1] if name == "spheres" else [0, 0, 1]
            assert shot.particles.moment_inertia == pytest.approx(np.outer(moment, axes), rel=1e-6)
            momentum = moment[:, None] * one.spin / radius[:, None]
            scalar, vector = of_bodies(shot.particles.orientation, shot.particles.angmom)
            assert scalar == pytest.approx(0.0, abs=1e-5)
            assert vector == pytest.approx(momentum, rel=1e-5, abs=1e-5)
    assert name == "spheres" or np.abs(found.angle.values[-1]).max() > 0.5


def of_bodies(q, P):
    """Scalar and vector of conj(q) P / 2: angular momenta in the frames of the bodies."""
    scalar = q[:, 0] * P[:, 0] + np.sum(q[:, 1:] * P[:, 1:], axis=1)
    vector = q[:, :1] * P[:, 1:] - P[:, :1] * q[:, 1:] - np.cross(q[:, 1:], P[:, 1:])
    return scalar / 2, vector / 2
