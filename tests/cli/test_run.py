"""`roughgas run`, `plan` and `bench`: what people see of them, and scripts read."""

import json
import shlex
from pathlib import Path

import pytest

from cli.conftest import GAS
from roughgas.cli import main
from roughgas.cli.show import summary
from roughgas.data.point import read_point
from roughgas.simulation import speed
from roughgas.simulation.point import run_point

PLACE = ("--r=0.9", "--beta=-0.50", f"--settings={json.dumps(GAS)}")


def test_without_a_name_a_point_is_named_after_itself_and_shown(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["run", "cooling", *PLACE]) == 0
    said = capsys.readouterr()
    (path,) = tmp_path.iterdir()
    assert path.name == "cooling_r0.9_beta-0.50_seed1.nc"
    assert said.out == f"{summary(path.name)}\n" and said.err == ""
    again = ["run", "cooling", *PLACE, "--scale=small", "--seed", "3", "4"]
    assert main(again) == 0
    names = {path.name for path in tmp_path.iterdir()} - {path.name}
    assert names == {f"cooling_small_r0.9_beta-0.50_seed{seed}.nc" for seed in (3, 4)}


def test_a_run_goes_on_from_the_file_of_another(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["run", "cooling", *PLACE, "--keep-state", "-o", "first.nc"]) == 0
    assert main(["run", "cooling", *PLACE, "--from", "first.nc", "-o", "second.nc"]) == 0
    first, second = read_point("first.nc"), read_point("second.nc")
    assert second.initial_exact == 1 and "last_position" not in second
    assert "--from first.nc" in second.command and '"keep_state":true' in first.experiment_json
    again = shlex.split(second.command)[1:]
    assert main([*again[:-1], "again.nc"]) == 0 and read_point("again.nc").R == second.R
    capsys.readouterr()
    for arguments, message in (
        (["--from", "second.nc"], "initial = without position: must be in the dataset"),
        (["--from", "first.nc", "--seed", "1", "2"], "--seed = 1 2: must be one with --from"),
        (["--from", "none.nc"], "none.nc: No such file"),
    ):
        assert main(["run", "cooling", *PLACE, *arguments]) != 0
        said = capsys.readouterr().err
        assert said.startswith(f"roughgas: error: {message}") and said.count("\n") == 1
    assert len(list(tmp_path.iterdir())) == 3
    assert main(["export", "first.nc"]) == 0 and main(["show", "first.nc"]) == 0
    assert "last_velocity" in Path("first.about.csv").read_text()


def test_a_script_reads_a_line_for_each_seed_as_it_is_done(tmp_path, monkeypatch, capsys):
    told = []

    def watched(*arguments):
        told.append(capsys.readouterr().out)
        return run_point(*arguments)

    monkeypatch.setattr("roughgas.cli.run.run_point", watched)
    files = [str(tmp_path / name) for name in ("1.nc", "2.nc")]
    assert main(["run", "cooling", *PLACE, "--seed", "1", "2", "--json", "-o", *files]) == 0
    first, second = told[1], capsys.readouterr().out
    for number, path, line in zip((1, 2), files, (first, second), strict=True):
        found, point = json.loads(line), read_point(path)
        assert (found["file"], found["seed"], found["experiment"]) == (path, number, "cooling")
        assert (found["r"], found["beta"]) == (0.9, -0.5)
        names = {name for name, one in point.data_vars.items() if not one.dims}
        assert names <= found.keys()
        for name in ("R", "R_stderr", "collisions", "kernel_seconds"):
            assert found[name] == float(point[name])


def test_a_plan_for_a_script(product, monkeypatch, capsys, tmp_path):
    monkeypatch.chdir(product)
    command = ["plan", "cooling_inertia", "--scale=small", f"--pilots={tmp_path}", "--cores=2"]
    assert main([*command, "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert main(command) == 0
    table = [line.split("|") for line in capsys.readouterr().out.splitlines()[2:6]]
    for row, line in zip(rows, table, strict=True):
        name, _, points, seeds = (cell.strip() for cell in line[1:5])
        assert [row["experiment"], row["points"], row["seeds"]] == [name, int(points), int(seeds)]
        assert row["target"] is None and f"{row['collisions']:.2e}" == line[7].strip()
    assert rows[0]["points"] == 2 and rows[0]["wall_seconds"] <= rows[0]["cpu_seconds"]


@pytest.fixture
def in_a_moment(monkeypatch):
    monkeypatch.setattr(speed, "SECONDS", 0.01)


def test_the_speed_of_this_machine(product, monkeypatch, capsys, in_a_moment):
    monkeypatch.chdir(product)
    command = ["bench", "cooling", "sheared", "--scale=small", "--runs=3", "--r=0.8"]
    assert main([*command, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert {"processor", "versions"} <= found["machine"].keys()
    assert [one["experiment"] for one in found["speeds"]] == ["cooling", "sheared"]
    for one in found["speeds"]:
        assert sorted(one["rates"])[1] == one["collisions_per_second"]
        assert [one["slowest"], one["fastest"]] == [min(one["rates"]), max(one["rates"])]
        assert one["slowest"] > 1e4 and (one["r"], one["particles"]) == (0.8, 40)
    assert main(command) == 0
    rows = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert [row[:4] for row in rows[1:3]] == [
        ["cooling", "0.8", "0", "40"],
        ["sheared", "0.8", "0", "40"],
    ]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["cooling", "--runs=0"], "--runs = 0: must be a whole number >= 1"),
        (["cooling", "--r=2"], "restitution r = 2: must lie in [0, 1]"),
        (["foo"], "experiment = 'foo': must be one of cooling, "),
    ],
)
def test_what_cannot_be_timed_is_refused(product, monkeypatch, capsys, arguments, message):
    monkeypatch.chdir(product)
    assert main(["bench", *arguments]) == 2
    said = capsys.readouterr()
    assert said.out == "" and said.err.startswith(f"roughgas: error: {message}")
