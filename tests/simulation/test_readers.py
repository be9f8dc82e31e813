"""Trajectories in the programs that docs/trajectories.md names, as far as they are installed."""

import numpy as np
import pytest

from roughgas.data.trajectory import ELEMENTS, SPECIES, frames, lengths_and_angles, write_trajectory
from simulation.test_trajectory import KINDS, sample

pytestmark = [
    pytest.mark.readers,
    pytest.mark.filterwarnings("ignore"),  # of the programs
]
NAMES = ["bed", "sheared", "shaken", "spheres", "mixture"]


@pytest.fixture(params=NAMES)
def found(request):
    return sample(request.param)


def frames_of(found):
    values = {name: one.values for name, one in found.variables.items()}
    return list(frames(values))


def symbols_of(found):
    if "species_of" not in found:
        return [SPECIES] * found.sizes["particle"]
    return [ELEMENTS[kind] for kind in found.species_of.values]


def mass_of(found):
    return found.mass.values if "mass" in found else np.ones(found.sizes["particle"])


def test_mdanalysis_reads_netcdf(found, tmp_path):
    reader = pytest.importorskip("MDAnalysis.coordinates.TRJ").NCDFReader
    write_trajectory(tmp_path / "gas.nc", found)
    with reader(str(tmp_path / "gas.nc")) as file:
        for shot, frame in zip(file, frames_of(found), strict=True):
            assert shot.time == pytest.approx(frame.time)
            assert shot.positions == pytest.approx(frame.position, rel=1e-6, abs=1e-6)
            assert shot.velocities == pytest.approx(frame.velocity, rel=1e-6, abs=1e-6)
            cell = np.concatenate(lengths_and_angles(frame.cell))
            assert shot.dimensions == pytest.approx(cell, rel=1e-6)


def test_ase_reads_netcdf(found, tmp_path):
    read = pytest.importorskip("ase.io").read
    write_trajectory(tmp_path / "gas.nc", found)
    shots = read(tmp_path / "gas.nc", index=":", format="netcdftrajectory")
    for atoms, frame in zip(shots, frames_of(found), strict=True):
        assert atoms.get_positions() == pytest.approx(frame.position)
        assert atoms.cell.cellpar() == pytest.approx(np.concatenate(lengths_and_angles(frame.cell)))


def test_ase_reads_masses_velocities_and_kinds_of_extended_xyz(found, tmp_path):
    read = pytest.importorskip("ase.io").read
    write_trajectory(tmp_path / "gas.xyz", found)
    shots = read(tmp_path / "gas.xyz", index=":", format="extxyz")
    for atoms, frame in zip(shots, frames_of(found), strict=True):
        assert np.array_equal(atoms.get_positions(), frame.position)
        assert np.array_equal(atoms.get_masses(), mass_of(found))
        assert atoms.get_velocities() == pytest.approx(frame.velocity, rel=1e-14)
        energy = 0.5 * np.sum(mass_of(found)[:, None] * frame.velocity**2)
        assert atoms.get_kinetic_energy() == pytest.approx(energy)
        assert atoms.get_chemical_symbols() == symbols_of(found)
        assert np.array_equal(atoms.cell.array, frame.cell)
    if "species_of" in found:
        assert len(set(symbols_of(found))) == len(KINDS)


def test_freud_finds_no_overlap_in_gsd(found, tmp_path):
    freud = pytest.importorskip("freud")
    hoomd = pytest.importorskip("gsd.hoomd")
    write_trajectory(tmp_path / "gas.gsd", found)
    radius = found.radius.values
    with hoomd.open(tmp_path / "gas.gsd") as file:
        for shot in file:
            pairs = freud.locality.AABBQuery.from_system(shot)
            near = pairs.query(shot.particles.position, {"r_max": 2.5, "exclude_ii": True})
            for i, j, distance in near:
                # images through a bounded side are none of the gas
                if distance < radius[i] + radius[j] - 1e-4:
                    apart = shot.particles.position[i] - shot.particles.position[j]
                    bounded = np.append(found.periodic.values == 0, False)[:3]
                    assert np.any(np.abs(apart[bounded]) > distance + 1e-4)
