"""What settings of species mean, and what is refused in one line."""

import gzip
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from brute_force import begin, settings

from roughgas.effects.species import mixture_of, packing

HALVES = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 2}]


def gas(species, pairs=None, particles=40, box=(40, 40), effects=None):
    found = settings("gas", particles, list(box)) | {"species": species}
    found |= {"species_pairs": pairs} if pairs else {}
    return found | {"effects": effects or found["effects"]}


def bodies(species, particles=40, **more):
    return begin(gas(species, particles=particles, **more), 0.9, 0.3, seed=1)[1].bodies


def test_mass_is_that_of_the_same_stuff_and_inertia_the_scenes():
    found = bodies([*HALVES[:1], {"fraction": 0.5, "radius": 2, "inertia": 0.3}])
    assert np.bincount(found.species).tolist() == [20, 20]
    assert np.array_equal(found.radius, 1.0 + found.species)
    assert np.array_equal(found.mass, found.radius**2)
    assert np.array_equal(found.inertia, np.where(found.species == 0, 0.5, 0.3))


def test_fractions_are_rounded_so_that_all_particles_have_a_species():
    numbers = [kind.number for kind in mixture_of(gas([{"fraction": 1 / 3}] * 3)).kinds]
    assert sorted(numbers) == [13, 13, 14]
    thirds = [{"fraction": f} for f in (0.1, 0.2, 0.7)]
    assert [kind.number for kind in mixture_of(gas(thirds, particles=10)).kinds] == [1, 2, 7]


def test_pairs_have_the_mean_unless_they_are_given():
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
def test_radii_that_are_drawn_have_the_mean_and_the_deviation(name, deviation):
    spread = {"distribution": name, "mean": 1.5, "deviation": deviation}
    species = [{"fraction": 1, "radius": spread}]
    one = bodies(species, particles=2000, box=(300, 300))
    found, error = one.radius / 1.5, deviation / np.sqrt(2000)
    assert abs(found.mean() - 1.0) < 4.0 * error
    assert abs(found.std() - deviation) < 4.0 * error
    again = bodies(species, particles=2000, box=(300, 300))
    assert np.array_equal(one.radius, again.radius)
    assert np.array_equal(one.mass, one.radius**2)
    expected = packing(gas(species, particles=2000, box=(300, 300)))
    covered = np.pi * np.sum(one.radius**2) / 300**2
    assert covered == pytest.approx(expected, rel=0.02)


def test_radii_from_a_list_and_from_a_file(tmp_path):
    listed = [0.5, 1.0, 1.25]
    (tmp_path / "radii").write_text("0.5\n1.0\n1.25\n")
    one = bodies([{"fraction": 1, "radius": listed}])
    file = {"distribution": "file", "file": str(tmp_path / "radii")}
    other = bodies([{"fraction": 1, "radius": file}])
    assert set(one.radius) == set(listed)
    assert np.array_equal(one.radius, other.radius)
    exactly = bodies([{"fraction": 1, "radius": listed}], particles=3)
    assert sorted(exactly.radius) == listed


@pytest.mark.parametrize("kind", ["endless", "pipe", "archive", "too large", "empty", "folder"])
def test_radii_come_from_text_files_of_an_end(tmp_path, kind):
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
