"""What settings of species mean, and what is refused in one line."""

import gzip
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from brute_force import begin, settings

from roughgas.base import InputError
from roughgas.config.schema import check_schema
from roughgas.effects.species import mixture_of, packing
from roughgas.scene import build
from roughgas.scene.initial import initial_state

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


SPREAD = {"distribution": "uniform"}
WRONG = [
    ([{"fraction": 0.5}, {"fraction": 0.4}], "sum of species.fraction = 0.9: must be 1 within"),
    ([{"number": 20}, {"number": 19}], "sum of species.number = 39: must be particles, 40"),
    ([{"fraction": 0.5}, {"number": 20}], "species[1].number = 20: must be a fraction"),
    ([{"radius": 2}], "species[0].fraction = (nothing): must be given, or number"),
    ([{"number": 40, "fraction": 1}], "species[0].fraction = 1: must not stand beside number"),
    ([{"fraction": 0.999}, {"fraction": 0.001}], "species[1].fraction = 0.001: must be large"),
    ([{"fraction": 1, "radius": 11}], "box[0] = 40.0: must be a number of at least 44.11"),
    ([{"fraction": 1, "mu": 0.1}], "species[0].mu needs effects.friction"),
    ([{"name": "a", "fraction": 0.5}] * 2, "species[1].name = a: must be given once"),
    ([{"fraction": 1, "radius": SPREAD}], "species[0].radius.deviation = (nothing): must be given"),
    (
        [{"fraction": 1, "radius": SPREAD | {"deviation": 0.6}}],
        "species[0].radius.deviation = 0.6: must lie in [0, 0.5774)",
    ),
    (
        [{"fraction": 1, "radius": {"distribution": "file", "file": "nowhere"}}],
        "species[0].radius.file = nowhere: must be a text file of radii, one per line",
    ),
]


OWN = [{"fraction": 0.5}, {"fraction": 0.5, "restitution": 0.5}]
WALLS = {"walls": {"restitution": "particles", "roughness": -1}}
WRONG = [(species, {}, message) for species, message in WRONG]
WRONG += [(OWN, {"effects": WALLS}, "effects.walls.restitution = particles: must be a number")]
WRONG += [
    (HALVES, {"pairs": [{"between": between, "restitution": 0.5} for between in pairs]}, message)
    for pairs, message in (
        ([["a", 0]], "species_pairs[0].between = 'a': must be one of 0, 1"),
        ([[0, 2]], "species_pairs[0].between = 2"),
        ([[0, 1], [1, 0]], "species_pairs[1].between"),
    )
]


@pytest.mark.parametrize(("species", "more", "message"), WRONG)
def test_what_makes_no_sense_is_one_line(species, more, message):
    with pytest.raises(InputError) as caught:
        build(gas(species, **more), 0.9, -1.0 if more.get("effects") else 0.3)
    assert str(caught.value).startswith(message) and "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("species", "message"),
    [
        ([{"fraction": 1, "radius": 0}], "radius = 0: must be a number"),
        ([{"fraction": 1, "radius": []}], "radius = []: must be"),
        ([{"fraction": 0.5}, {"fraction": 0.5, "mass": -1}], "species[1].mass = -1: must be"),
        ([], "species = []: must be a list that is not empty"),
        ([{"fraction": 1, "charge": 1}], "species[0]: key"),
    ],
)
def test_what_no_species_can_have(species, message):
    with pytest.raises(InputError) as caught:
        check_schema(gas(species), "gas", "experiment")
    assert message in str(caught.value) and "\n" not in str(caught.value)


def test_the_largest_that_is_drawn_must_fit():
    spread = {"distribution": "lognormal", "deviation": 0.5}
    experiment = gas([{"fraction": 1, "radius": spread}], particles=4, box=(5, 5))
    scene = build(experiment, 0.9, 0.3)
    with pytest.raises(InputError, match=r"box\[0\] = 5.0: must be a number of at least"):
        initial_state(scene, experiment, np.random.default_rng(3))
