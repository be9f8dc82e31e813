"""The program as a process: exit statuses, messages, files."""

import io
import json
import shlex
import subprocess
import sys

import pytest
from raw import run_point
from schedules import TINY

from cli.conftest import GAS
from roughgas.base import CollapseError
from roughgas.cli import main
from roughgas.cli.show import summary
from roughgas.data.point import WALL_CLOCK, read_point
from roughgas.data.reduced import read_reduced


def run(output, experiment="cooling", r="0.9", beta="0", seed="1", **options):
    arguments = ["run", experiment, f"--r={r}", f"--beta={beta}", f"--seed={seed}"]
    arguments += [f"--{name}={value}" for name, value in options.items()]
    return main([*arguments, "--output", str(output)])


def test_a_process_has_one_thread_for_linear_algebra(monkeypatch):
    """With several threads the last bits of sums would depend on the number of cores."""
    monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    code = "import os, roughgas.cli as cli\n"
    code += "cli.main = lambda: print(os.environ['OPENBLAS_NUM_THREADS']) or 0\ncli.process()"
    process = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert process.stdout == "1\n"


def test_an_interrupt_ends_in_one_line(tmp_path, capsys, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("roughgas.simulation.run_points.run_point", interrupted)
    assert run(tmp_path / "point.nc") == 130
    message = "roughgas: stopped: nothing is half-written; the same command begins anew\n"
    assert capsys.readouterr().err == message
    assert list(tmp_path.iterdir()) == []


@pytest.fixture(scope="module")
def point(tmp_path_factory):
    path = tmp_path_factory.mktemp("point") / "point.nc"
    assert run(path, beta="-0.50", settings=json.dumps(TINY)) == 0
    return path


def test_a_point_says_how_to_run_it_again(point, tmp_path):
    dataset = read_point(point)
    assert dataset.attrs["experiment"] == "cooling"
    assert dataset.attrs["scale"] == "paper"
    assert dataset.attrs["beta"] == -0.5 and dataset.attrs["beta_label"] == "-0.5"
    assert json.loads(dataset.attrs["experiment_json"]) == TINY
    program, *arguments = shlex.split(dataset.attrs["command"])
    assert program == "roughgas"
    arguments[-1] = str(tmp_path / "again.nc")
    assert main(arguments) == 0
    again = read_point(tmp_path / "again.nc")
    assert dataset.drop_vars(WALL_CLOCK, errors="ignore").equals(
        again.drop_vars(WALL_CLOCK, errors="ignore")
    )


def run_seeds(folder, seeds, files):
    arguments = ["run", "cooling", "--r=0.9", "--beta=0", "--seed", *seeds]
    arguments += ["--settings", json.dumps(TINY), "--output"]
    return main([*arguments, *(str(folder / name) for name in files)])


def test_several_seeds_are_the_same_as_each_alone(tmp_path, capsys):
    assert run_seeds(tmp_path, "123", ["1.nc", "2.nc", "3.nc"]) == 0
    assert capsys.readouterr().err.count(": R = ") == 3
    for seed in "312":
        assert run_seeds(tmp_path, seed, ["alone.nc"]) == 0
        together, alone = read_point(tmp_path / f"{seed}.nc"), read_point(tmp_path / "alone.nc")
        assert together.attrs.pop("command") == alone.attrs.pop("command").replace("alone", seed)
        assert together.drop_vars(WALL_CLOCK, errors="ignore").identical(
            alone.drop_vars(WALL_CLOCK, errors="ignore")
        )


def test_points_to_reduce_are_read_from_standard_input(point, tmp_path, monkeypatch):
    for input, name in ((str(point), "named.nc"), ("-", "piped.nc")):
        monkeypatch.setattr("sys.stdin", io.StringIO(f"{point}\n"))
        assert main(["reduce", input, "--output", str(tmp_path / name)]) == 0
    assert (tmp_path / "named.nc").read_bytes() == (tmp_path / "piped.nc").read_bytes()


def test_finished_points_are_kept_when_a_later_seed_fails(tmp_path, monkeypatch):
    def second_collapses(scene, experiment, seed, *arguments):
        if seed == 2:
            raise CollapseError("inelastic collapse")
        return run_point(scene, experiment, seed, *arguments)

    monkeypatch.setattr("roughgas.simulation.run_points.run_point", second_collapses)
    assert run_seeds(tmp_path, "123", ["1.nc", "2.nc", "3.nc"]) == 1
    (finished,) = tmp_path.glob("*.finished.*")
    assert {path.name for path in tmp_path.iterdir()} == {"1.nc", finished.name}


def test_a_run_imports_no_slow_library(point, tmp_path):
    """Each would cost every job a tenth of a second; `point` has compiled the kernel."""
    script = (
        "import sys\nfrom roughgas.cli import main\n"
        "assert main(sys.argv[1:]) == 0\nprint(*sys.modules)\n"
    )
    arguments = ["run", "cooling", "--r=0.9", "--beta=0", "--seed=1"]
    arguments += [f"--settings={json.dumps(TINY)}", f"--output={tmp_path / 'point.nc'}"]
    process = subprocess.run(
        [sys.executable, "-c", script, *arguments], capture_output=True, text=True, check=True
    )
    loaded = set(process.stdout.split())
    assert loaded.isdisjoint({"scipy", "xarray", "pandas", "matplotlib", "snakemake"})
    assert loaded.isdisjoint({"tqdm", "argcomplete"})
    assert "numba.np.linalg" not in loaded  # the compiler was not initialised


POINT_OPTIONS = ("--r=0.9", "--beta=-0.50", f"--settings={json.dumps(GAS)}")


def test_a_default_name_has_the_coordinates_and_the_summary_is_printed(
    tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    assert main(["run", "cooling", *POINT_OPTIONS]) == 0
    output = capsys.readouterr()
    (path,) = tmp_path.iterdir()
    assert path.name == "cooling_r0.9_beta-0.5_seed1.nc"
    assert output.out == f"{summary(path.name)}\n" and output.err == ""
    command = ["run", "cooling", *POINT_OPTIONS, "--scale=small", "--seed", "3", "4"]
    assert main(command) == 0
    names = {path.name for path in tmp_path.iterdir()} - {path.name}
    assert names == {f"cooling_small_r0.9_beta-0.5_seed{seed}.nc" for seed in (3, 4)}


def test_a_run_continues_from_a_saved_state(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["run", "cooling", *POINT_OPTIONS, "--keep-state", "-o", "first.nc"]) == 0
    assert main(["run", "cooling", *POINT_OPTIONS, "--from", "first.nc", "-o", "second.nc"]) == 0
    first, second = read_point("first.nc"), read_point("second.nc")
    assert second.initial_exact == 1 and "last_position" not in second
    assert "--from first.nc" in second.command and "--seed" not in second.command
    assert second.seed == first.seed
    assert '"keep_state":true' in first.experiment_json
    command = shlex.split(second.command)[1:]
    assert main([*command[:-1], "again.nc"]) == 0 and read_point("again.nc").R == second.R
    capsys.readouterr()
    for arguments, message in (
        (
            ["--from", "second.nc"],
            "--from = second.nc: must be a point that has kept its last state",
        ),
        (["--from", "first.nc", "--seed", "1", "2"], "seed = 1: must be left out: nothing in this"),
        (["--from", "first.nc", "--reseed", "2"], "reseed = 2: must be left out: nothing in this"),
        (["--reseed", "2"], "reseed = 2: must come with a saved state: --from, or initial="),
        (["--from", "none.nc"], "none.nc: No such file"),
    ):
        assert main(["run", "cooling", *POINT_OPTIONS, *arguments]) != 0
        error = capsys.readouterr().err
        assert error.startswith(f"roughgas: error: {message}") and error.count("\n") == 1
    assert len(list(tmp_path.iterdir())) == 3
    assert main(["show", "first.nc"]) == 0


@pytest.mark.parametrize(
    ("target", "verdict", "share"),
    [(0.05, "met", 1.0), (1e-9, "NOT met, in 2 times the schedule", 0.0)],
)
def test_the_verdict_on_a_target_is_printed_and_reduced(
    tmp_path, monkeypatch, capsys, target, verdict, share
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("roughgas.simulation.error_target.BLOCK_LIMIT", 2)
    lengths = {"replicas": 40, "relaxation_times": 8, "target_stderr": target}
    changes = ["--set", *(f"schedule.{key}={value}" for key, value in lengths.items())]
    assert (
        main(["run", "cooling", *POINT_OPTIONS, *changes, "--seed", "1", "2", "-o", "1.nc", "2.nc"])
        == 0
    )
    assert capsys.readouterr().err.count(f", target {verdict.partition(',')[0]}, ") == 2
    assert f"target         standard error {target:g}: {verdict}\n" in f"{summary('1.nc')}\n"
    assert main(["reduce", "1.nc", "2.nc", "-o", "reduced.nc"]) == 0
    data = read_reduced("reduced.nc")
    assert data.target_met.item() == share and data.target_blocks.item() == 2.0 - share
