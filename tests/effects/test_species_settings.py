"""Settings of species and their meaning; files of radii that are refused."""

import gzip
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from brute_force import begin, settings
from raw import mixture_of, packing

HALVES = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 2}]


def gas(species, pairs=None, particles=40, box=(40, 40), effects=None):
    """Settings of a gas of these species."""
    experiment = settings("gas", particles, list(box)) | {"species": species}
    experiment |= {"species_pairs": pairs} if pairs else {}
    return experiment | {"effects": effects or experiment["effects"]}


def bodies(species, particles=40, **changes):
    """The bodies of the initial state of a gas of these species."""
    return begin(gas(species, particles=particles, **changes), 0.9, 0.3, seed=1)[1].bodies


def test_masses_default_to_equal_density_and_inertia_to_the_scene():
    mixture = bodies([*HALVES[:1], {"fraction": 0.5, "radius": 2, "inertia": 0.3}])
    assert np.bincount(mixture.species).tolist() == [20, 20]
    assert np.array_equal(mixture.radius, 1.0 + mixture.species)
    assert np.array_equal(mixture.mass, mixture.radius**2)
    assert np.array_equal(mixture.inertia, np.where(mixture.species == 0, 0.5, 0.3))


def test_fractions_are_rounded_so_that_all_particles_have_a_species():
    numbers = [kind.number for kind in mixture_of(gas([{"fraction": 1 / 3}] * 3)).kinds]
    assert sorted(numbers) == [13, 13, 14]
    thirds = [{"fraction": f} for f in (0.1, 0.2, 0.7)]
    assert [kind.number for kind in mixture_of(gas(thirds, particles=10)).kinds] == [1, 2, 7]


def test_pairs_have_the_mean_material_unless_they_state_their_own():
    species = [
        {"name": "a", "fraction": 0.5, "restitution": 0.7},
        {"fraction": 0.5, "roughness": 1},
    ]
    pairs = [{"between": ["a", 1], "roughness": -0.5}]
    table = mixture_of(gas(species, pairs)).table({"restitution": 0.9, "roughness": 0.2, "mu": 0.1})
    assert table[0, 0].tolist() == [0.7, 0.2, 0.1]
    assert table[0, 1] == pytest.approx([0.8, -0.5, 0.1])
    assert table[1, 0].tolist() == table[0, 1].tolist()
    assert table[1, 1].tolist() == [0.9, 1.0, 0.1]


@pytest.mark.parametrize(("name", "deviation"), [("uniform", 0.2), ("lognormal", 0.1)])
def test_random_radii_have_the_stated_mean_and_deviation(name, deviation):
    spread = {"distribution": name, "mean": 1.5, "deviation": deviation}
    species = [{"fraction": 1, "radius": spread}]
    drawn = bodies(species, particles=2000, box=(300, 300))
    relative_radii, error = drawn.radius / 1.5, deviation / np.sqrt(2000)
    assert abs(relative_radii.mean() - 1.0) < 4.0 * error
    assert abs(relative_radii.std() - deviation) < 4.0 * error
    again = bodies(species, particles=2000, box=(300, 300))
    assert np.array_equal(drawn.radius, again.radius)
    assert np.array_equal(drawn.mass, drawn.radius**2)
    expected = packing(gas(species, particles=2000, box=(300, 300)))
    covered = np.pi * np.sum(drawn.radius**2) / 300**2
    assert covered == pytest.approx(expected, rel=0.02)


def test_radii_are_read_from_a_list_and_from_a_file(tmp_path):
    listed = [0.5, 1.0, 1.25]
    (tmp_path / "radii").write_text("0.5\n1.0\n1.25\n")
    from_list = bodies([{"fraction": 1, "radius": listed}])
    file = {"distribution": "file", "file": str(tmp_path / "radii")}
    from_file = bodies([{"fraction": 1, "radius": file}])
    assert set(from_list.radius) == set(listed)
    assert np.array_equal(from_list.radius, from_file.radius)
    of_three = bodies([{"fraction": 1, "radius": listed}], particles=3)
    assert sorted(of_three.radius) == listed


@pytest.mark.parametrize("kind", ["endless", "pipe", "archive", "too large", "empty", "folder"])
def test_files_of_radii_must_be_text_of_limited_size(tmp_path, kind):
    path = Path("/dev/zero") if kind == "endless" else tmp_path / "radii.gz"
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "archive":
        path.write_bytes(gzip.compress(b"1.0\n" * 40))
    elif kind == "folder":
        path.mkdir()
    elif kind != "endless":
        path.touch()
        os.truncate(path, 10**12 if kind == "too large" else 0)
    code = f"from roughgas.effects.species import _radii_in; _radii_in('file', {str(path)!r})"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    legal = f"{path}: must be a text file of radii, one per line, of at most 1e+08 bytes\n"
    assert done.stderr.endswith(legal)
