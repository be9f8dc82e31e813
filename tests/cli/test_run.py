"""`roughgas run`: what people see of it, and scripts read."""

import json
import shlex

import pytest

from cli.conftest import GAS
from roughgas.cli import main
from roughgas.cli.show import summary
from roughgas.data.point import read_point
from roughgas.data.reduced import read_reduced

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
        (
            ["--from", "second.nc"],
            "--from = second.nc: must be a point that has kept its last state",
        ),
        (["--from", "first.nc", "--seed", "1", "2"], "--seed = 1 2: must be one with --from"),
        (["--from", "none.nc"], "none.nc: No such file"),
    ):
        assert main(["run", "cooling", *PLACE, *arguments]) != 0
        said = capsys.readouterr().err
        assert said.startswith(f"roughgas: error: {message}") and said.count("\n") == 1
    assert len(list(tmp_path.iterdir())) == 3
    assert main(["show", "first.nc"]) == 0


@pytest.mark.parametrize(
    ("target", "said", "share"),
    [(0.05, "met", 1.0), (1e-9, "NOT met, in 2 times the schedule", 0.0)],
)
def test_a_target_and_whether_it_was_met(tmp_path, monkeypatch, capsys, target, said, share):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("roughgas.simulation.target.MOST_BLOCKS", 2)
    lengths = {"replicas": 40, "relaxation_times": 8, "target_stderr": target}
    changes = ["--set", *(f"schedule.{key}={value}" for key, value in lengths.items())]
    assert main(["run", "cooling", *PLACE, *changes, "--seed", "1", "2", "-o", "1.nc", "2.nc"]) == 0
    assert capsys.readouterr().err.count(f", target {said.partition(',')[0]}, ") == 2
    assert f"target         standard error {target:g}: {said}\n" in f"{summary('1.nc')}\n"
    assert main(["reduce", "1.nc", "2.nc", "-o", "reduced.nc"]) == 0
    data = read_reduced("reduced.nc")
    assert data.target_met.item() == share and data.target_blocks.item() == 2.0 - share
