"""Ctrl-C and SIGTERM: a clean stop, and a line on how to continue."""

import contextlib
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import snakemakes
import xarray as xr
from project import Project
from schedules import BRIEF, TINY

from robustness.conftest import (
    LONG_RUN,
    environment,
    handles_signal,
    interrupt,
    run_arguments,
    wait_until,
)

pytestmark = pytest.mark.slow

RUN_OF_SECONDS = TINY | {"schedule": BRIEF | {"plateau": 200_000, "sample_every": 25}}
STOPPED_LINE = "Stopped: the same command goes on from here."


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
    command = [sys.executable, "-m", "roughgas", *run_arguments("point.nc", LONG_RUN)]
    running = start(command, tmp_path)
    wait_until(lambda: handles_signal(running, signal.SIGTERM), running)
    time.sleep(after)
    output = interrupt(running, number)
    assert output == "roughgas: stopped: nothing is half-written; the same command begins anew\n"
    assert running.returncode == 130
    assert not [path for path in tmp_path.rglob("*") if path.is_file()]


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """A project at whose scale `long` points take a while; at `dense` they collapse."""
    project = Project(tmp_path_factory.mktemp("project"))
    sweep = {"r": ["0.9"], "beta": ["0"], "seeds": 2}
    long, lasting = LONG_RUN | {"sweep": sweep}, RUN_OF_SECONDS | {"sweep": sweep}
    dense = TINY | {"particles": 60, "box": [18, 18], "sweep": sweep | {"r": ["0.01"]}}
    dense["effects"] = dense["effects"] | {"contact_time": None}
    scales = {"long": {"cooling": long}, "dense": {"cooling": dense}}
    scales |= {"lasting": {"cooling": lasting}, "block": {"cooling": lasting}}
    project.configure(lambda config: config["scales"].update(scales))
    return project


def snakemake(project, scale):
    command = [sys.executable, "-m", "snakemake", "-j2", "--config", f"scale={scale}"]
    return start([*command, "--", f"results/{scale}/cooling.nc"], project.folder)


def test_a_workflow_stops_without_a_word_of_failure(project):
    snakemakes.server()  # ready by the time that the point runs
    running = snakemake(project, "long")
    log = project.folder / "logs/long/cooling/r0.9/beta0/seeds1-2.log"
    wait_until(log.exists, running)
    status, output = project.snakemake(
        "-j1", "--config", "scale=long", "--", "results/long/cooling.nc"
    )
    assert status != 0
    head = "roughgas: error: another Snakemake is at work in this folder: process"
    assert (
        f"{head} {running.pid}, which began " in output and f"`kill -INT {running.pid}`" in output
    )
    lines = interrupt(running).splitlines()
    assert lines[-1] == STOPPED_LINE
    assert not [line for line in lines if "rror" in line or "Traceback" in line]
    assert not list(project.folder.rglob("*.tmp"))
    planned = project.planned("results/long/cooling.nc")
    assert planned == {"point": 2, "reduce": 1}  # the kernel is not compiled again


TERMINATE_WITH_LOCK = """
import os
import signal
from snakemake.scheduling.job_scheduler import JobScheduler

def finish(scheduler, original=JobScheduler._finish_jobs):
    assert scheduler._lock.locked()
    os.kill(os.getpid(), signal.SIGTERM)
    original(scheduler)

JobScheduler._finish_jobs = finish
"""


def test_SIGTERM_while_the_scheduler_has_its_lock_stops_the_workflow(tmp_path):
    project = Project(tmp_path)
    project.append("Snakefile", TERMINATE_WITH_LOCK)
    command = [sys.executable, "-m", "snakemake", "-j1", "--config", "scale=tiny"]
    running = start([*command, "--", "results/tiny/cooling.nc"], project.folder)
    try:
        output, _ = running.communicate(timeout=60)
    except subprocess.TimeoutExpired:
        os.killpg(running.pid, signal.SIGKILL)
        pytest.fail(f"Snakemake hangs: {running.communicate()[0]}")
    assert running.returncode == 1
    assert output.splitlines()[-1] == STOPPED_LINE


def test_the_lock_of_a_killed_snakemake_gets_advice(tmp_path):
    """As of a workflow whose profile does not turn off Snakemake's own locks."""
    project = Project(tmp_path)
    target = "results/tiny/config.yaml"
    command = ["-j1", "--workflow-profile", "none", "--config", "scale=tiny", "--", target]
    folder = project.folder / ".snakemake/locks"
    folder.mkdir(parents=True)
    (folder / "0.output.lock").write_text(target + "\n")
    status, output = project.snakemake(*command)
    assert status == 1 and "Directory cannot be locked" in output
    assert "roughgas: error: no Snakemake is known to be at work in this folder" in output
    project.succeed("--workflow-profile", "none", "--unlock")
    project.succeed(*command)


def test_a_failed_job_shows_its_log_and_nothing_more(project):
    running = snakemake(project, "dense")
    lines = running.communicate(timeout=120)[0].splitlines()
    assert running.returncode == 1 and lines[-1] == STOPPED_LINE
    first = next(k for k, line in enumerate(lines) if line.startswith("Error in rule "))
    assert "    log: logs/dense/cooling/r0.01/beta0/seeds1-2.log (check log" in "\n".join(
        lines[first:]
    )
    assert [
        text for text in lines if text.startswith("roughgas: error: inelastic collapse at t = ")
    ]
    assert len(lines) < 60 and not [
        line for line in lines if "cksum" in line or "CalledProcessError" in line
    ]


def kill_at_checkpoint(command, cwd, checkpoint):
    """Start a command that always writes checkpoints, and kill it once a checkpoint exists."""
    running = start(command, cwd, ROUGHGAS_CHECKPOINT_SECONDS="0")
    wait_until(lambda: list(cwd.rglob(checkpoint)), running)
    os.killpg(running.pid, signal.SIGKILL)
    running.communicate(timeout=60)


def same_point(first_path, second_path):
    """Return whether two points have the same bits, apart from their run times."""
    with xr.open_dataset(first_path) as first, xr.open_dataset(second_path) as second:
        return first.drop_vars("kernel_seconds").equals(second.drop_vars("kernel_seconds"))


def test_a_killed_workflow_continues_within_a_point(project):
    folder, dataset = project.folder / "results/lasting", "results/lasting/cooling.nc"
    command = [sys.executable, "-m", "snakemake", "-j1", "--config", "scale=lasting", "--", dataset]
    kill_at_checkpoint(command, project.folder, "seed1.nc.checkpoint.npz")
    status, _ = project.snakemake("-j1", "--config", "scale=lasting", "--", dataset)
    assert status == 0 and not list(folder.rglob("*.npz"))
    log = project.folder / "logs/lasting/cooling/r0.9/beta0/seeds1-2.log"
    assert "going on from results/lasting/cooling/r0.9/beta0/seed1.nc.checkpoint" in log.read_text()
    alone = run_arguments(folder / "alone.nc", RUN_OF_SECONDS)
    start([sys.executable, "-m", "roughgas", *alone], folder).communicate(timeout=300)
    assert same_point(folder / "cooling/r0.9/beta0/seed1.nc", folder / "alone.nc")


def test_points_that_a_killed_job_has_finished_are_not_made_again(project):
    """Snakemake deletes the outputs of the job, which is killed while it makes its second point."""
    folder, dataset = project.folder / "results/block", "results/block/cooling.nc"
    command = ["-j1", "--config", "scale=block", "--", dataset]
    running = start([sys.executable, "-m", "snakemake", *command], project.folder)
    wait_until(lambda: list(folder.rglob("seed1.nc.finished.*")), running)
    (finished,) = folder.rglob("seed1.nc.finished.*")
    for job in run_processes(project.folder):
        os.kill(job, signal.SIGKILL)
    running.communicate(timeout=300)
    assert running.returncode == 1 and list(folder.rglob("*.nc*")) == [finished]
    inode = finished.stat().st_ino
    status, output = project.snakemake(*command)
    assert status == 0, output
    log = project.folder / "logs/block/cooling/r0.9/beta0/seeds1-2.log"
    assert f"is finished: it was kept in {finished.relative_to(project.folder)}" in log.read_text()
    assert finished.with_name("seed1.nc").stat().st_ino == inode and not list(
        folder.rglob("*.finish*")
    )
    assert (folder / "cooling.nc").exists()
    status, output = project.snakemake("-n", *command)
    assert status == 0 and "Nothing to be done" in output


def run_processes(folder):
    """Yield the process ids of `roughgas run` in a folder."""
    for process in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            words = (process / "cmdline").read_bytes().split(b"\0")
            if b"run" in words and (process / "cwd").resolve() == folder.resolve():
                yield int(process.name)
