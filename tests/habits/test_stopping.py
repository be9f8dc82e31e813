"""Ctrl-C and SIGTERM: a clean stop, and a line that says how to go on."""

import os
import signal
import subprocess
import sys
import time

import pytest
import snakemakes
import xarray as xr
from project import Project
from schedules import BRIEF, TINY

from habits.conftest import LONG, catches, environment, interrupt, point, wait_until

pytestmark = pytest.mark.slow

SECONDS_LONG = TINY | {"schedule": BRIEF | {"plateau": 200_000, "sample_every": 25}}
LAST = "Stopped: the same command goes on from here."


def start(command, cwd, **changes):
    return subprocess.Popen(
        command,
        cwd=cwd,
        env=environment(**changes),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )


@pytest.mark.parametrize(
    ("number", "after"), [(signal.SIGINT, 0.0), (signal.SIGTERM, 1.5)], ids=["Ctrl-C", "SIGTERM"]
)
def test_a_simulation_stops_in_one_line(tmp_path, number, after):
    command = [sys.executable, "-m", "roughgas", *point("point.nc", LONG)]
    running = start(command, tmp_path)
    wait_until(lambda: catches(running, signal.SIGTERM), running)
    time.sleep(after)
    said = interrupt(running, number)
    assert said == "roughgas: stopped: nothing is half-written; the same command begins anew\n"
    assert running.returncode == 130
    assert not [path for path in tmp_path.rglob("*") if path.is_file()]


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """A project at whose scale `long` points take a while; at `dense` they collapse."""
    project = Project(tmp_path_factory.mktemp("project"))
    sweep = {"r": ["0.9"], "beta": ["0"], "seeds": 2}
    long, lasting = LONG | {"sweep": sweep}, SECONDS_LONG | {"sweep": sweep}
    dense = TINY | {"particles": 60, "box": [18, 18], "sweep": sweep | {"r": ["0.01"]}}
    dense["effects"] = dense["effects"] | {"contact_time": None}
    scales = {"long": {"cooling": long}, "dense": {"cooling": dense}}
    scales["lasting"] = {"cooling": lasting}
    project.configure(lambda config: config["scales"].update(scales))
    return project


def snakemake(project, scale):
    command = [sys.executable, "-m", "snakemake", "-j2", "--config", f"scale={scale}"]
    return start([*command, "--", f"results/{scale}/cooling.nc"], project.folder)


def test_a_workflow_stops_without_a_word_of_failure(project):
    snakemakes.server()  # which is ready by the time that the point runs
    running = snakemake(project, "long")
    log = project.folder / "logs/long/cooling/r0.9/beta0/seeds1-2.log"
    wait_until(log.exists, running)
    status, said = project.snakemake(
        "-j1", "--config", "scale=long", "--", "results/long/cooling.nc"
    )
    assert status != 0
    assert "roughgas: error: another Snakemake is at work in this folder" in said
    lines = interrupt(running).splitlines()
    assert lines[-1] == LAST
    assert not [line for line in lines if "rror" in line or "Traceback" in line]
    assert not list(project.folder.rglob("*.tmp"))
    planned = project.planned("results/long/cooling.nc")
    assert planned == {"point": 2, "reduce": 1}  # the kernel is not compiled again


def test_a_job_that_fails_shows_what_it_said_and_no_more(project):
    running = snakemake(project, "dense")
    lines = running.communicate(timeout=120)[0].splitlines()
    assert running.returncode == 1 and lines[-1] == LAST
    place = next(k for k, line in enumerate(lines) if line.startswith("Error in rule "))
    assert "    log: logs/dense/cooling/r0.01/beta0/seeds1-2.log (check log" in "\n".join(
        lines[place:]
    )
    assert [one for one in lines if one.startswith("roughgas: error: inelastic collapse at t = ")]
    assert len(lines) < 60 and not [
        line for line in lines if "cksum" in line or "CalledProcessError" in line
    ]


def killed(command, cwd, checkpoint):
    """Start a command that writes checkpoints all the time, and kill it once there is one."""
    running = start(command, cwd, ROUGHGAS_CHECKPOINT_SECONDS="0")
    wait_until(lambda: list(cwd.rglob(checkpoint)), running)
    os.killpg(running.pid, signal.SIGKILL)
    running.communicate(timeout=60)


def same_point(one, other):
    """Whether two files have the same bits, but for the time that they took and where they are."""
    with xr.open_dataset(one) as here, xr.open_dataset(other) as there:
        return here.drop_vars("kernel_seconds").equals(there.drop_vars("kernel_seconds"))


def test_a_simulation_that_was_killed_goes_on(tmp_path):
    command = [sys.executable, "-m", "roughgas", *point("point.nc", SECONDS_LONG)]
    killed(command, tmp_path, "point.nc.checkpoint.npz")
    assert not (tmp_path / "point.nc").exists()
    again = start(command, tmp_path)
    said = again.communicate(timeout=300)[0]
    assert "going on from point.nc.checkpoint.npz" in said
    assert [path.name for path in tmp_path.iterdir()] == ["point.nc"]
    command[-1] = "undisturbed.nc"
    start(command, tmp_path).communicate(timeout=300)
    assert same_point(tmp_path / "point.nc", tmp_path / "undisturbed.nc")


def test_a_workflow_that_was_killed_goes_on_within_a_point(project):
    folder, dataset = project.folder / "results/lasting", "results/lasting/cooling.nc"
    command = [sys.executable, "-m", "snakemake", "-j1", "--config", "scale=lasting", "--", dataset]
    killed(command, project.folder, "seed1.nc.checkpoint.npz")
    status, _ = project.snakemake("-j1", "--config", "scale=lasting", "--", dataset)
    assert status == 0 and not list(folder.rglob("*.npz"))
    log = project.folder / "logs/lasting/cooling/r0.9/beta0/seeds1-2.log"
    assert "going on from results/lasting/cooling/r0.9/beta0/seed1.nc.checkpoint" in log.read_text()
    alone = point(folder / "alone.nc", SECONDS_LONG)
    start([sys.executable, "-m", "roughgas", *alone], folder).communicate(timeout=300)
    assert same_point(folder / "cooling/r0.9/beta0/seed1.nc", folder / "alone.nc")
