"""Frames of LAMMPS, extended XYZ and GSD: their particles in units of a gas, and refusals.

tests/data/other_programs/README.md says how its files were made.
"""

import re
import shutil
import subprocess
from pathlib import Path

import gsd.hoomd
import numpy as np
import pytest
import xarray
from tests.other_programs import FOLDER, disks_in_gas_units, spheres_in_gas_units

from roughgas import read_frame
from roughgas.base import InputError
from roughgas.data.other_programs import is_of_other_program
from roughgas.data.trajectory import write_trajectory

DISKS = ("disks.dump", "disks.data", "disks.xyz")
SPHERES = ("spheres.dump", "spheres.data", "spheres.gsd")
NO_FORMAT = r"^file = .*: must be a LAMMPS data or dump file, extended XYZ, or GSD"
EXACT = {"disks.dump", "spheres.dump"}
EIGHT_DIGITS = 2e-7  # of data files (of LAMMPS) 17, of extended XYZ (of ASE) 8, of boxes of GSD 7


def assert_alike(dataset, expected, name):
    tolerance = 1e-14 if name in EXACT else EIGHT_DIGITS
    for key, values in expected.items():
        assert dataset[key].values == pytest.approx(values, rel=tolerance, abs=tolerance), key


@pytest.mark.parametrize("name", DISKS)
def test_disks_have_positions_from_the_corner_in_radii_and_velocities_of_surfaces(name):
    dataset = read_frame(FOLDER / name)
    assert_alike(dataset, disks_in_gas_units(-1), name)
    assert "species_of" not in dataset and dataset.position.shape == (16, 2)


@pytest.mark.parametrize("name", SPHERES)
def test_spheres_of_two_species_are_read_in_a_stated_unit_of_time(name):
    dataset = read_frame(FOLDER / name, unit_time=0.005)
    assert_alike(dataset, spheres_in_gas_units(), name)
    if name == "spheres.gsd":  # whose particles have turned by 90 degrees
        assert dataset.species.values.tolist() == ["small", "large"]
        assert dataset.inertia.values == pytest.approx(0.4, rel=1e-12)


def test_a_frame_is_chosen_by_number():
    for frame in (0, 1, 2, -1, -3):
        assert_alike(
            read_frame(FOLDER / "disks.dump", frame), disks_in_gas_units(frame), "disks.dump"
        )
    first, last = (read_frame(FOLDER / "disks.xyz", frame) for frame in (0, 1))
    assert np.array_equal(first.velocity, -last.velocity)


def test_stated_units_scale_everything():
    plain = read_frame(FOLDER / "disks.dump")
    scaled = read_frame(FOLDER / "disks.dump", unit_length=0.25, unit_mass=np.pi, unit_time=3)
    factors = {"position": 2, "velocity": 6, "spin": 6, "radius": 2, "box": 2, "mass": 0.25}
    for name, factor in factors.items():
        assert scaled[name].values == pytest.approx(factor * plain[name].values, rel=1e-14)


# ----------------------------------------------------------------- round trips


def own_trajectory(dimension, mixture, open_top=False):
    """A trajectory of two frames with random numbers, such as roughgas makes."""
    rng, N = np.random.default_rng(dimension), 7
    box = np.array([6.0, 7.0, 8.0])[:dimension]
    position = rng.uniform(0, 1, (2, N, dimension)) * box
    radius = np.where(np.arange(N) < 3, 1.5, 1.0) if mixture else np.ones(N)
    inertia = 0.5 if dimension == 2 else 0.4
    dims, spins = ("frame", "particle", "axis"), ("frame", "particle", "spin_axis")
    values = {
        "time": (("frame",), np.array([1.0, 2.0])),
        "position": (dims, position),
        "unwrapped_position": (dims, position),
        "velocity": (dims, rng.normal(size=(2, N, dimension))),
        "spin": (spins, rng.normal(size=(2, N, 2 * dimension - 3))),
        "radius": (("particle",), radius),
        "moment_of_inertia": (("particle",), inertia * radius ** (dimension + 2)),
        "box": (("axis",), np.append(box[:-1], np.nan if open_top else box[-1])),
        "periodic": (("axis",), np.append(np.ones(dimension - 1, int), int(not open_top))),
    }
    if dimension == 2:
        values["angle"] = (("frame", "particle"), rng.uniform(0, 6, (2, N)))
    if mixture:
        values["mass"] = (("particle",), radius**dimension)
        values["species_of"] = (("particle",), np.where(radius > 1, 1, 0))
        values["species"] = (("species",), np.array(["A", "B"]))
    return xarray.Dataset(values, attrs={"title": "random"})


CASES = [(2, False), (3, False), (2, True), (3, True)]


@pytest.mark.parametrize("open_top", [False, True])
@pytest.mark.parametrize(("dimension", "mixture"), CASES)
@pytest.mark.parametrize("suffix", [".xyz", ".gsd"])
def test_trajectories_of_roughgas_come_back(suffix, dimension, mixture, open_top, tmp_path):
    path, trajectory = tmp_path / f"gas{suffix}", own_trajectory(dimension, mixture, open_top)
    write_trajectory(path, trajectory, double=True)
    # positions of GSD are relative to the middle, and its spins are angular momenta
    tolerance = {} if suffix == ".xyz" else {"rtol": 2e-15, "atol": 4e-15}
    for frame in (0, 1, -1):
        written, dataset = trajectory.isel(frame=frame), read_frame(path, frame, unit_length=1)
        for name in ("position", "velocity", "spin"):
            np.testing.assert_allclose(dataset[name], written[name], **{"rtol": 0} | tolerance)
        assert np.array_equal(dataset.radius, written.radius)
        assert not mixture or np.array_equal(dataset.species_of, written.species_of)
        sides = slice(None, -1) if open_top else slice(None)
        assert np.array_equal(dataset.box[sides], written.box[sides])


def test_a_dump_in_any_order_of_columns_and_particles_has_every_digit(tmp_path):
    rng, N = np.random.default_rng(5), 9
    vectors = {name: rng.normal(size=(N, 3)) for name in ("v*", "omega*")}
    vectors["*u"] = rng.uniform(-30, 30, (N, 3))  # unwrapped: far outside the box
    columns = {
        stem.replace("*", axis): values[:, k]
        for stem, values in vectors.items()
        for k, axis in enumerate("xyz")
    }
    columns |= {
        "id": rng.permutation(N) + 3,
        "diameter": np.full(N, 2.0),
        "c_pressure": np.zeros(N),
    }
    names = list(rng.permutation([*columns]))
    rows = [" ".join(repr(columns[name][k].item()) for name in names) for k in range(N)]
    header = ["ITEM: TIMESTEP", "7", "ITEM: NUMBER OF ATOMS", str(N)]
    header += ["ITEM: BOX BOUNDS xy xz yz pp ff ss", "-8 8 0", "-2 6 0.0", "0 9 0"]
    path = tmp_path / "gas"
    path.write_text("\n".join([*header, f"ITEM: ATOMS {' '.join(names)}", *rows, ""]))
    dataset, order = read_frame(path), np.argsort(columns["id"])
    assert np.array_equal(dataset.position, vectors["*u"][order] - [-8, -2, 0])
    assert np.array_equal(dataset.velocity, vectors["v*"][order])
    assert np.array_equal(dataset.spin, vectors["omega*"][order])
    assert "mass" not in dataset and dataset.box.values.tolist() == [16, 8, 9]


def test_a_file_without_radii_or_spins_is_read_in_a_stated_unit(tmp_path):
    path = tmp_path / "gas.xyz"
    header = 'Lattice="9 0 0 0 9 0 0 0 9" Origin="-1 0 0" Properties=pos:R:2:vel:R:2'
    path.write_text(f"2\n{header}\n0 1 2 3\n4 5 6 7\n")
    dataset = read_frame(path, unit_length=0.5)
    assert dataset.position.values.tolist() == [[2, 2], [10, 10]]
    assert dataset.velocity.values.tolist() == [[4, 6], [12, 14]]
    assert dataset.radius.values.tolist() == [1, 1] and "spin" not in dataset
    with pytest.raises(
        InputError, match=r"^unit_length = \(nothing\): must be given: .* no radii$"
    ):
        read_frame(path)


# ----------------------------------------------------------------- docs/coming_from.md

PAGE = (Path(__file__).parents[2] / "docs" / "coming_from.md").read_text()


def block(begin):
    """The code of the page that begins so."""
    blocks = re.findall(r"^```.*?\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    return next(text for text in blocks if text.startswith(begin))


def test_the_page_has_the_input_of_lammps_with_the_springs_of_its_formulas():
    text = (FOLDER / "disks.in").read_text()
    assert block("# 16 rough inelastic disks") == text
    words = re.search(r"gran/hooke/history (.*)", text)[1].split()
    normal, tangential, damping, *limits = map(float, words)
    r, beta, q, M = 0.9, 0.5, 0.5, np.pi / 8
    contact_time = np.pi * np.sqrt(M / normal * (1 + (np.log(r) / np.pi) ** 2))
    assert damping == pytest.approx(-2 * np.log(r) / contact_time, rel=1e-12)
    expected = q * M / (1 + q) * (np.arccos(-beta) / contact_time) ** 2
    assert tangential == pytest.approx(expected, rel=1e-12) and limits == [0, 1e4, 0]


DYNAMO = """<?xml version="1.0"?>
<DynamOconfig version="1.5.0"><Simulation><SimulationSize x="6" y="7" z="8"/></Simulation>
<ParticleData OrientationData="Y">
<Pt ID="0"><P x="-3" y="1" z="2"/><V x="1" y="2" z="3"/><O x=".1" y=".2" z=".3"/>
<U w="1" x="0" y="0" z="0"/></Pt>
<Pt ID="1"><P x="1" y="-3.5" z="0"/><V x="4" y="5" z="6"/><O x="0" y="0" z="0"/>
<U w="1" x="0" y="0" z="0"/></Pt>
</ParticleData></DynamOconfig>
"""
MERCURY = """2 0 -1 0 0 5 6 7
0 1 2 3 4 5 .5 0 0 0 .1 .2 .3 0
4 4 4 -3 -4 -5 .5 0 0 0 0 0 0 0
2 0.5 -1 0 0 5 6 7
1 1 2 3 4 5 .5 0 0 0 .1 .2 .3 0
4 3 4 -3 -4 -5 .5 0 0 0 0 0 0 0
"""


@pytest.mark.parametrize("spins", [True, False])
def test_a_configuration_of_dynamo_becomes_extended_xyz(spins, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = DYNAMO if spins else re.sub(r"<O .*?/>", "", DYNAMO)
    Path("config.xml").write_text(text)
    exec(compile(block("from xml.etree"), "page", "exec"), {})
    frame = read_frame("gas.xyz")
    assert frame.position.values.tolist() == [[0, 9, 12], [8, 0, 8]]
    assert frame.velocity.values.tolist() == [[2, 4, 6], [8, 10, 12]]
    assert frame.box.values.tolist() == [12, 14, 16]
    if spins:  # a w/a
        assert frame.spin.values.tolist() == [[0.1, 0.2, 0.3], [0, 0, 0]]
    assert spins == ("spin" in frame)


@pytest.mark.skipif(not shutil.which("awk"), reason="there is no awk")
def test_a_data_file_of_mercurydpm_becomes_a_dump(tmp_path):
    (tmp_path / "gas.data").write_text(MERCURY)
    subprocess.run(block("awk"), shell=True, check=True, cwd=tmp_path)
    first, second = (read_frame(tmp_path / "gas.dump", number) for number in (0, 1))
    assert first.position.values.tolist() == [[2, 2, 4], [10, 8, 8]]
    assert first.spin.values.tolist() == [[0.1, 0.2, 0.3], [0, 0, 0]]
    assert first.box.values.tolist() == [12, 12, 14]
    assert (second.position - first.position).values.tolist() == [[2, 0, 0], [0, -2, 0]]


# ----------------------------------------------------------------- refusals

ROWS = [
    tuple(cell.strip(" ") for cell in row.split(" |"))
    for row in (FOLDER / "refusals.txt").read_text().splitlines()
    if " | " in row
]


@pytest.mark.parametrize(("name", "pattern", "replacement", "message"), ROWS)
def test_what_does_not_fit_is_refused_in_one_line(name, pattern, replacement, message, tmp_path):
    path, text = tmp_path / name, (FOLDER / name).read_text()
    changed = re.sub(pattern, replacement, text)
    assert changed != text
    path.write_text(changed)
    expected = message.replace("F", re.escape(str(path)), 1)
    with pytest.raises(InputError, match=f"^{expected}") as refusal:
        read_frame(path)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"frame": 3}, r"frame = 3: must lie in \[-3, 2\]: .*disks.dump has 3"),
        ({"frame": -4}, r"frame = -4: must lie in \[-3, 2\]: .*disks.dump has 3"),
        ({"unit_length": 0}, r"unit_length = 0: must lie in \(0, inf\)"),
        ({"unit_mass": -1}, r"unit_mass = -1: must lie in \(0, inf\)"),
        ({"unit_time": np.nan}, r"unit_time = nan: must lie in \(0, inf\)"),
    ],
)
def test_frames_and_units_out_of_range_are_refused(arguments, message):
    with pytest.raises(InputError, match=f"^{message}$"):
        read_frame(FOLDER / "disks.dump", **arguments)


def test_several_radii_of_the_first_species_need_a_unit(tmp_path):
    path = tmp_path / "disks.dump"
    text = (FOLDER / "disks.dump").read_text()
    path.write_text(text.replace("\n2 1 0.5", "\n2 1 0.6"))
    with pytest.raises(
        InputError, match=r"^unit_length = \(nothing\): must be given: values of the"
    ):
        read_frame(path)
    dataset = read_frame(path, unit_length=0.5)
    assert dataset.radius[1] == 1.2 and not dataset.species_of.any()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"box": [9, 9, 9, 0.1, 0, 0]}, "box = .*: must be positive sides, without tilt"),
        (
            {"position": np.full((2, 3), np.nan)},
            r"position of particle 0 = \[nan, nan, nan\]: must be",
        ),
        ({"diameter": [1, 0]}, "diameter of particle 1 = 0.0: must be positive"),
        (
            {"moment_inertia": [[1, 1, 1], [1, 1, 2]]},
            "moment_inertia of particle 1 = .*: must be posit",
        ),
        ({"typeid": [0, 3]}, "typeid of particle 1 = 3: must be below 1, the number of types"),
    ],
)
def test_frames_of_hoomd_that_do_not_fit_are_refused(change, message, tmp_path):
    frame, path = gsd.hoomd.Frame(), tmp_path / "gas.gsd"
    frame.configuration.box, frame.configuration.dimensions = [9, 9, 9, 0, 0, 0], 3
    frame.particles.N, frame.particles.types = 2, ["A"]
    for name, value in change.items():
        setattr(frame.configuration if name == "box" else frame.particles, name, value)
    with gsd.hoomd.open(path, "w") as file:
        file.append(frame)
    with pytest.raises(InputError, match=f"^{re.escape(str(path))}, {message}"):
        read_frame(path)


def test_other_content_is_of_no_format(tmp_path):
    path = tmp_path / "gas.dump"
    for content in (b"", b"text\n", b"\x89HDF\r\n", b"3\ncomment\nH 0 0 0\n"):
        path.write_bytes(content)
        assert not is_of_other_program(path)
        with pytest.raises(InputError, match=NO_FORMAT):
            read_frame(path)
    with pytest.raises(InputError, match=NO_FORMAT):
        read_frame(tmp_path)


# ----------------------------------------------------------------- spoiled files


def spoiled(content, rng):
    """A copy of bytes with one to three of them flipped, replaced or cut out."""
    content = bytearray(content)
    for _ in range(rng.integers(1, 4)):
        start = rng.integers(len(content))
        damage = rng.choice(["flip", "replace", "cut"])
        if damage == "flip":
            content[start] ^= 1 << rng.integers(8)
        elif damage == "replace":
            content[start] = rng.choice(list(b'-+.eE nN0\n\t:"=#'))
        else:
            del content[start : start + rng.integers(1, 30)]
    return bytes(content)


@pytest.mark.parametrize("name", [*DISKS, *SPHERES])
def test_a_cut_file_is_refused_and_a_spoiled_one_is_read_or_refused_in_one_line(name, tmp_path):
    content, path = (FOLDER / name).read_bytes(), tmp_path / name
    rng = np.random.default_rng(62)
    cuts = [content[:length] for length in range(1, len(content) - 1, 53)]
    for case, changed in enumerate([*cuts, *(spoiled(content, rng) for _ in range(120))]):
        path.write_bytes(changed)
        try:
            dataset = read_frame(path)
        except InputError as refusal:
            assert "\n" not in str(refusal)
        else:  # a file that ends with a complete frame
            assert case >= len(cuts) or name.endswith((".dump", ".xyz"))
            assert np.isfinite(dataset.position).all()
    shutil.copy(FOLDER / name, path)
    assert read_frame(path).sizes["particle"] in (12, 16)
