"""`roughgas show --of` and `plot --of`: any variables of a sweep."""

import json

import pytest
from observed_sweep import observed_sweep
from tests.entry import main, outcome

from roughgas.data.netcdf import content_of, write_netcdf
from roughgas.show.style import METADATA


@pytest.fixture
def sweep(tmp_path):
    """The path of a reduced dataset with results of observables."""
    path = tmp_path / "sweep.nc"
    write_netcdf(path, content_of(observed_sweep(trusted=-1.0)))
    return str(path)


def test_variables_are_printed_over_the_sweep(sweep, capsys):
    """Variables of the same dimensions share a table; an error that is not trusted is marked."""
    assert main(["show", sweep, "--of", "fast", "E_trans", "squares"]) == 0
    _, header, scalars, squares, note = capsys.readouterr().out.rstrip("\n").split("\n\n")
    assert header.splitlines()[1:] == [
        "fast        share of fast particles",
        "E_trans     E_trans",
        "squares     mean squares, in a^2 T^-2",
    ]
    table = [line.split() for line in scalars.splitlines()]
    assert table[0] == ["r", "beta", "fast", "E_trans"] and len(table) == 7
    assert table[1] == ["0.8", "-0.5", "0.050(10)", "1"]
    assert table[2] == ["0.8", "0", "0.100(10)?", "1"]
    rows = [line.split() for line in squares.splitlines()]
    assert rows[0] == ["r", "beta", "side", "squares"] and len(rows) == 13
    assert rows[-1] == ["0.9", "0.5", "y", "0.300(10)"]
    assert note.startswith("?: ")


def test_variables_are_printed_as_json(sweep, capsys):
    assert main(["show", sweep, "--json", "--of", "fast", "squares"]) == 0
    points = json.loads(capsys.readouterr().out)["points"]
    assert len(points) == 6 and points[1]["r"] == 0.8 and points[1]["beta"] == 0.0
    assert points[1]["squares"] == pytest.approx([0.1, 0.2])
    assert points[1]["fast_stderr"] == pytest.approx(0.01)


def test_an_unknown_variable_is_refused(sweep, tmp_path):
    line = "roughgas: error: --of = fest: must be one of R, fast, squares, profile\n"
    for command in (
        ["show", sweep, "--of", "fest"],
        ["plot", sweep, "--of", "fest", "-o", "x.png"],
    ):
        status, errors = outcome(command)
        assert status == 2 and errors == line


def test_variables_of_other_datasets_are_refused(product):
    point = str(product / "beta0.5_1.nc")
    status, errors = outcome(["show", point, "--of", "R"])
    assert status == 2 and "must be a reduced one for --of" in errors
    status, errors = outcome(["plot", point, "--of", "R", "E_trans", "-o", "x.png"])
    assert status == 2 and "--of = R, E_trans: must be one variable of a point" in errors


def test_variables_are_drawn(sweep, product, tmp_path, capsys):
    """Of a sweep with observables R and their results, of others R."""
    for number, options in enumerate(([], ["--of", "R"], ["--of", "fast", "profile"])):
        output = tmp_path / f"{number}.png"
        assert main(["plot", sweep, *options, "-o", str(output)]) == 0
        assert output.stat().st_size > 0 and output.suffix in METADATA
    lines = capsys.readouterr().err.splitlines()
    assert "not shown: squares (--of names what to draw)" in lines
    reduced = str(product / "reduced.nc")
    files = [tmp_path / name for name in ("plain.png", "of_R.png")]
    assert main(["plot", reduced, "-o", str(files[0])]) == 0
    assert main(["plot", reduced, "--of", "R", "-o", str(files[1])]) == 0
    assert files[0].read_bytes() == files[1].read_bytes()
