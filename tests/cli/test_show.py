"""`roughgas show`: summaries of points and reduced datasets."""

import json
import shutil

import netCDF4
import pytest
from tests.cli.conftest import GAS
from tests.entry import main

from roughgas import theory
from roughgas.data.point import read_point
from roughgas.data.reduced import read_reduced
from roughgas.statistics.estimates import Estimate
from roughgas.statistics.sample_sizes import YES


def show(capsys, *arguments):
    assert main(["show", *map(str, arguments)]) == 0
    return capsys.readouterr().out


def test_the_summary_of_a_point(product, capsys):
    path = product / "beta0.5_1.nc"
    text, point = show(capsys, path), read_point(path)
    expected = float(theory.cooling_ratio(0.9, 0.5))
    low, high = (float(point.R + sign * point.R_ci95) for sign in (-1, 1))
    rows = dict(line.split("  ", 1) for line in text.splitlines() if "  " in line.strip())
    rows = {name.strip(): value.strip() for name, value in rows.items()}
    assert text.startswith(f"{path}: point\n")
    assert rows["point"] == "r = 0.9, beta = 0.5, seed 1"
    assert rows["gas"] == "20 disks, box 20 x 20 a, packing 0.157"
    assert rows["E_trans"].endswith(
        "initial E_trans, per degree of freedom, as the measurement begins"
    )
    assert rows["R"] == f"{Estimate(float(point.R), float(point.R_stderr))}"
    interval, _, doubt = rows["95 % interval"].partition(" (")
    ends = [float(end) for end in interval.split(" to ")]
    assert ends == pytest.approx([low, high], abs=6e-4)
    assert point.R_ci95_trusted == -1 and "not known: too little" in doubt  # of four replicas
    assert rows["steady state"].startswith("not known: too little was measured; measured from")
    assert rows["theory"].startswith(f"{expected:.4f}, theory of free cooling: R is ")
    assert rows["cost"].startswith(f"{int(point.collisions):,} collisions in ")
    assert len(rows["R(t)"].split()[0]) == min(48, point.sizes["sample"])
    assert text.rstrip().endswith(point.attrs["command"])
    assert "\n  contacts " in text and "energy balance closes to" in text


@pytest.mark.parametrize(
    ("variables", "attributes", "lines"),
    [
        (
            {"R_collisional": 0.35, "R_collisional_stderr": 0.002},
            {},
            ["R_collisional  0.3500(20), averaged over collisions, as theory of free cooling"],
        ),
        (
            {"R_collisional": 0.35, "R_collisional_stderr": 0.002, "R_unsubtracted": 0.1},
            {},
            ["averaged over collisions, mean flow included, unlike theory"],
        ),
        ({"E_rot_stderr": 1e-5}, {}, ["E_rot          {}"]),
        ({"contact_time_fraction": 0.264}, {}, ["contact time   26 % of contacts were altered"]),
        ({"contact_time_fraction": 0.264}, {}, ["by the contact-time model: R depends on it\n"]),
        ({"contact_time_fraction": 3e-5}, {}, ["0.003 % of contacts were altered"]),
        ({}, {"beta": -1.0}, ["none (theory of free cooling): at beta = -1 contacts"]),
        (
            {},
            {"langevin_json": '{"interval": 1.0, "drag": 0.1}', "mu": 0.5},
            ["none (rate equations in a Langevin bath): not known for this gas"],
        ),
        ({}, {"command": "\x1b[31mred\n\x9bJR  1"}, ["red\\n\\x9bJR  1\n"]),
        ({}, {"scale": "a\x1b]0;b\x07"}, [r"cooling, scale a\x1b]0;b\x07"]),
    ],
)
def test_lines_of_optional_variables_and_attributes(
    product, tmp_path, capsys, variables, attributes, lines
):
    path = shutil.copy(product / "beta0.5_1.nc", tmp_path / "p.nc")
    with netCDF4.Dataset(path, "a") as file:
        file.setncatts(attributes)
        for name, value in variables.items():
            present = name in file.variables
            (file[name] if present else file.createVariable(name, "f8"))[...] = value
        E_rot = Estimate(file["E_rot"][...].item(), 1e-5)
    text = show(capsys, path)
    for line in lines:
        assert line.format(E_rot) in text
    for output in (text, show(capsys, path, "--json")):
        assert all(character.isprintable() for character in output.replace("\n", ""))


def test_the_summary_of_a_mixture_has_a_row_for_each_species(tmp_path, capsys):
    species = [{"name": name, "fraction": 0.5, "mass": mass} for name, mass in (("a", 1), ("b", 4))]
    settings = json.dumps(GAS | {"species": species, "swept": "species.b.mass"})
    run = ["run", "pair/mass4", f"--settings={settings}", "--r=0.9", "--beta=0.5"]
    assert main([*run, "-o", str(tmp_path / "p.nc")]) == 0
    point, text = read_point(tmp_path / "p.nc"), show(capsys, tmp_path / "p.nc")
    for k, name in enumerate("ab"):
        row = point.isel(species=k)
        cells = [
            f"{Estimate(float(row[f'{key}_species']), float(row[f'{key}_species_stderr']))}"
            f"{'' if int(row[f'{key}_species_trusted']) == YES else '?'}"
            for key in ("E_trans", "E_rot", "R")
        ]
        assert [name, "10", *cells] in [line.split() for line in text.splitlines()]
    assert "theory of free cooling of mixtures: R is " in text


def test_the_summary_of_a_reduced_dataset(product, capsys):
    path = product / "reduced.nc"
    text, data = show(capsys, path), read_reduced(path)
    rows = [line.split() for line in text.splitlines() if line.startswith("0.9 ")]
    assert [row[:3] for row in rows] == [["0.9", "-0.5", "2"], ["0.9", "0.5", "2"]]
    for row, R, stderr in zip(rows, data.R.values[0], data.R_stderr.values[0], strict=True):
        assert row[3] == f"{Estimate(R, stderr)}"
        expected = float(theory.cooling_ratio(0.9, float(row[1])))
        assert row[5:7] == [f"{expected:.4f}", f"{R - expected:+.4f}"]
    first, _ = json.loads(show(capsys, path, "--json"))["points"]
    assert (first["beta"], first["R"], first["theory"]) == (-0.5, data.R.values[0, 0], "K")


def test_the_interval_of_a_constant_ratio_is_not_known(tmp_path, capsys):
    """Without contacts spins stay 0, and R is 0 in all samples."""
    output = tmp_path / "thin.nc"
    changes = ("box=[1e6,1e6]", "schedule.equilibrate=1", "schedule.measure=20")
    options = [word for change in changes for word in ("--set", change)]
    point = ["run", "sheared", "--r", "0.9", "--beta", "0.5", "-o", str(output), *options]
    assert main(point) == 0, capsys.readouterr().err
    assert main(["show", str(output)]) == 0
    (line,) = [line for line in capsys.readouterr().out.splitlines() if "95 % interval" in line]
    assert "not known" in line and "0.0000 to 0.0000" not in line
