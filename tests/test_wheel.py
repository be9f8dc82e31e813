"""The wheel in an environment of its own and an empty folder: every command for people works."""

import json
import os
import shlex
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

from roughgas.cli.commands import COMMANDS

ROOT = Path(__file__).parent.parent
POINT = "cooling --scale small --r 0.9 --beta 0.5"
LINES = {
    "run": f"run {POINT} -o point.nc",
    "movie": f"movie {POINT} --length 2 --frames 3 -o gas.gif",
    "trajectory": f"trajectory {POINT} --times 0 1 -o gas.xyz",
    "show": "show point.nc",
    "reduce": "reduce point.nc -o cooling.nc",
    "plot": "plot cooling.nc -o R.png",
    "experiments": "experiments",
    "theory": "theory --r 0.9 --beta 0.5",
    "doctor": "doctor",
    "completion": "completion bash",
}


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """The command `roughgas` of a wheel, in an environment that lends libraries from this one."""
    folder = tmp_path_factory.mktemp("wheel")
    build = f"from flit_core.buildapi import build_wheel; print(build_wheel({str(folder)!r}))"
    told = [sys.executable, "-c", build]
    made = subprocess.run(told, cwd=ROOT, capture_output=True, text=True, check=True)
    subprocess.run([sys.executable, "-m", "venv", folder / "venv"], check=True)
    python = folder / "venv" / "bin" / "python"
    wheel = folder / made.stdout.split()[-1]
    command = [python, "-m", "pip", "install", "-q", "--no-index", "--no-deps", wheel]
    subprocess.run(command, check=True)
    home = Path(
        subprocess.check_output(
            [python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"], text=True
        ).strip()
    )
    (home / "lent.pth").write_text(sysconfig.get_path("purelib"))  # whose own .pth are not read
    return folder / "venv" / "bin" / "roughgas"


def ran(installed, told, folder):
    around = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    around["ROUGHGAS_CACHE_DIR"] = str(installed.parents[2] / "kernels")
    return subprocess.run(told, cwd=folder, env=around, capture_output=True, text=True)


def roughgas(installed, line, folder):
    return ran(installed, [installed, *shlex.split(line)], folder)


@pytest.mark.slow
def test_every_command_works_in_an_empty_folder(installed, tmp_path):
    assert set(COMMANDS) - {"crate"} == set(LINES)
    for name, line in LINES.items():
        done = roughgas(installed, line, tmp_path)
        assert done.returncode == 0, (name, done.stderr)
    made = {"point.nc", "gas.gif", "gas.xyz"}
    assert made <= {path.name for path in tmp_path.iterdir()}
    found = json.loads(roughgas(installed, "doctor --json", tmp_path).stdout)
    assert str(installed.parents[1]) in found["configuration"]["said"]
    done = roughgas(installed, "crate point.nc -o run.zip", tmp_path)
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert "must be one with the workflow" in done.stderr
    (tmp_path / "config.yaml").write_text("scale: paper\n")
    done = roughgas(installed, f"run {POINT}", tmp_path)
    assert done.returncode == 2 and done.stderr.startswith("roughgas: error: config.yaml")


@pytest.mark.slow
def test_with_a_clone_of_the_workflow_it_runs(installed, tmp_path):
    python = [installed.parent / "python", "-m", "snakemake"]
    told = [*python, "-j1", "-s", ROOT / "Snakefile", "--config", "scale=small", "--", "living"]
    done = ran(installed, told, tmp_path)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "results/small/living.html").exists()
