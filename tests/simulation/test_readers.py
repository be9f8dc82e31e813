"""Trajectories read by the programs named in docs/trajectories.md, if they are installed."""

import numpy as np
import pytest

from roughgas.data.trajectory import (
    ELEMENTS,
    NO_ELEMENT,
    file_frames,
    lengths_and_angles,
    write_trajectory,
)
from simulation.test_trajectory import KINDS, sample

pytestmark = [
    pytest.mark.readers,
    pytest.mark.filterwarnings("ignore"),  # raised by these programs
]
NAMES = ["bed", "sheared", "shaken", "spheres", "mixture"]


@pytest.fixture(params=NAMES)
def dataset(request):
    return sample(request.param)


def frames_of(dataset):
    """The frames of a trajectory dataset, as a list."""
    values = {name: variable.values for name, variable in dataset.variables.items()}
    return list(file_frames(values))


def symbols_of(dataset):
    """Chemical symbols of the particles in files."""
    if "species_of" not in dataset:
        return [NO_ELEMENT] * dataset.sizes["particle"]
    return [ELEMENTS[kind] for kind in dataset.species_of.values]


def mass_of(dataset):
    """Masses of the particles."""
    return dataset.mass.values if "mass" in dataset else np.ones(dataset.sizes["particle"])


def test_mdanalysis_reads_netcdf(dataset, tmp_path):
    reader = pytest.importorskip("MDAnalysis.coordinates.TRJ").NCDFReader
    write_trajectory(tmp_path / "gas.nc", dataset)
    with reader(str(tmp_path / "gas.nc")) as file:
        for shot, frame in zip(file, frames_of(dataset), strict=True):
            assert shot.time == pytest.approx(frame.time)
            assert shot.positions == pytest.approx(frame.position, rel=1e-6, abs=1e-6)
            assert shot.velocities == pytest.approx(frame.velocity, rel=1e-6, abs=1e-6)
            cell = np.concatenate(lengths_and_angles(frame.cell))
            assert shot.dimensions == pytest.approx(cell, rel=1e-6)


def test_ase_reads_netcdf(dataset, tmp_path):
    read = pytest.importorskip("ase.io").read
    write_trajectory(tmp_path / "gas.nc", dataset)
    shots = read(tmp_path / "gas.nc", index=":", format="netcdftrajectory")
    for atoms, frame in zip(shots, frames_of(dataset), strict=True):
        assert atoms.get_positions() == pytest.approx(frame.position)
        assert atoms.cell.cellpar() == pytest.approx(np.concatenate(lengths_and_angles(frame.cell)))


def test_ase_reads_masses_velocities_and_kinds_of_extended_xyz(dataset, tmp_path):
    read = pytest.importorskip("ase.io").read
    write_trajectory(tmp_path / "gas.xyz", dataset)
    shots = read(tmp_path / "gas.xyz", index=":", format="extxyz")
    for atoms, frame in zip(shots, frames_of(dataset), strict=True):
        assert np.array_equal(atoms.get_positions(), frame.position)
        assert np.array_equal(atoms.get_masses(), mass_of(dataset))
        assert atoms.get_velocities() == pytest.approx(frame.velocity, rel=1e-14)
        energy = 0.5 * np.sum(mass_of(dataset)[:, None] * frame.velocity**2)
        assert atoms.get_kinetic_energy() == pytest.approx(energy)
        assert atoms.get_chemical_symbols() == symbols_of(dataset)
        assert np.array_equal(atoms.cell.array, frame.cell)
    if "species_of" in dataset:
        assert len(set(symbols_of(dataset))) == len(KINDS)


@pytest.mark.parametrize("double", [False, True])
def test_freud_finds_no_overlap_in_gsd(dataset, tmp_path, double):
    freud = pytest.importorskip("freud")
    hoomd = pytest.importorskip("gsd.hoomd")
    write_trajectory(tmp_path / "gas.gsd", dataset, double=double)
    radius = dataset.radius.values
    with hoomd.open(tmp_path / "gas.gsd") as file:
        for shot in file:
            pairs = freud.locality.AABBQuery.from_system(shot)
            near = pairs.query(shot.particles.position, {"r_max": 2.5, "exclude_ii": True})
            for i, j, distance in near:
                # images through a wall are not images of the gas
                if distance < radius[i] + radius[j] - 1e-4:
                    separation = shot.particles.position[i] - shot.particles.position[j]
                    bounded = np.append(dataset.periodic.values == 0, False)[:3]
                    assert np.any(np.abs(separation[bounded]) > distance + 1e-4)
