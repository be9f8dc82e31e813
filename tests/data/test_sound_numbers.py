"""Numbers that cannot be right stop whoever reads them, in one line."""

import math

import pytest
from synthetic import reduced
from tests.entry import main
from tests.files import point

from roughgas.data.point import write_point


@pytest.mark.parametrize(
    ("name", "value", "legal"),
    [
        ("R", math.nan, "[0, 1]"),
        ("R", 1.5, "[0, 1]"),
        ("R_ratio_of_means", -0.1, "[0, 1]"),
        ("E_trans", math.inf, "[0, inf)"),
        ("E_rot", math.nan, "[0, inf)"),
        ("R_stderr", -1.0, "[0, inf]"),
        ("R_ci95", -1.0, "[0, inf]"),
        ("equilibrated", 7, "[-1, 1]"),
        ("R_ci95_trusted", -2, "[-1, 1]"),
        ("collisions", -3, "[0, inf)"),
        ("kernel_seconds", -0.5, "[0, inf)"),
    ],
)
def test_a_point_with_an_impossible_number_is_not_reduced(tmp_path, capsys, name, value, legal):
    made = point()
    write_point(tmp_path / "point.nc", made._replace(variables=made.variables | {name: value}))
    assert main(["reduce", str(tmp_path / "point.nc"), "-o", str(tmp_path / "all.nc")]) == 2
    message = f"{name} of {tmp_path}/point.nc = {value}: must lie in {legal}"
    assert capsys.readouterr().err == f"roughgas: error: {message}\n"
    assert [one.name for one in tmp_path.iterdir()] == ["point.nc"]


@pytest.mark.parametrize(
    ("name", "value", "legal"),
    [("beta", 5.0, "[-1, 1]"), ("r", -0.1, "[0, 1]"), ("seed", -1, "[0, inf)")],
)
def test_a_point_of_an_impossible_place_is_not_reduced(tmp_path, capsys, name, value, legal):
    made = point()
    made = made._replace(attributes=made.attributes | {name: value})
    write_point(tmp_path / "point.nc", made)
    for command in (["reduce"], ["show"]):
        output = ["-o", str(tmp_path / "all.nc")] if command == ["reduce"] else []
        assert main([*command, str(tmp_path / "point.nc"), *output]) == 2
        message = f"{name} of {tmp_path}/point.nc = {value}: must lie in {legal}"
        assert capsys.readouterr().err == f"roughgas: error: {message}\n"


@pytest.mark.parametrize(("name", "value"), [("R", math.nan), ("R", -0.1), ("E_trans", math.inf)])
@pytest.mark.parametrize("command", ["table {} -o out.csv", "figure fig2a {} -o out.png"])
def test_nothing_is_made_of_a_reduced_dataset_with_one(
    tmp_path, capsys, monkeypatch, command, name, value
):
    monkeypatch.chdir(tmp_path)
    data = reduced("sheared")
    data[name][1, 3] = value
    data.to_netcdf("sheared.nc")
    assert main(command.format("sheared.nc").split()) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert f"{name} of sheared.nc = {value}: must lie in" in line
    assert [one.name for one in tmp_path.iterdir()] == ["sheared.nc"]


def test_places_without_seeds_have_no_numbers(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    data = reduced("sheared")
    data["n_seeds"][1, 3], data["R"][1, 3] = 0, math.nan
    data.to_netcdf("sheared.nc")
    assert main(["table", "sheared.nc", "-o", "out.csv"]) == 0
