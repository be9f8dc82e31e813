"""The pipeline on a real Slurm: results survive a node that fails and returns, a cancelled job, and
an interrupt of Snakemake."""

import os
import re
import signal

import pytest
from cluster import until
from on_cluster import OnCluster
from project import Project

from roughgas.data.point import WALL_CLOCK, read_point

pytestmark = pytest.mark.slurm
SMALL = ("--config", "scale=small", "--")
WALLS = [f"vibrated_{walls}_walls/r0.9" for walls in ("rough", "particle", "smooth")]
AT_EACH_R = ("vibrated", "sheared", "cooling")
SWEPT_POINTS = [f"{name}/r{r}" for name in AT_EACH_R for r in ("0.99", "0.9", "0.8", "0.6")]
COMPILED = [f"results/small/{place}/compiled.txt" for place in WALLS + SWEPT_POINTS]
COOLING = (*SMALL, "results/small/cooling.nc")


def next_job_on(cluster, node):
    """Wait for the next job that starts on a node, and return it."""
    running_before = cluster.running()
    started = []

    def has_started():
        started[:] = [
            job for job, job_node in cluster.running() - running_before if job_node == node
        ]
        return started

    until(has_started, f"a job starts on {node}")
    return started[0]


@pytest.fixture(scope="module")
def local(tmp_path_factory):
    """A project with all kernels compiled."""
    local = Project(tmp_path_factory.mktemp("local"))
    local.succeed("-j2", *SMALL, *COMPILED)
    return local


@pytest.fixture(scope="module")
def disturbed(cluster, local, tmp_path_factory):
    """A run of the figures at the small scale: after the first points a job is cancelled, and a
    node is killed; it returns as soon as Slurm has noticed."""
    folder = tmp_path_factory.mktemp("cluster") / "disturbed"
    project = OnCluster(local.copy_to(folder).folder, cluster)
    with project.running(*SMALL, "figures") as running:
        until(project.points, "a first point", 300)
        cluster("scancel", next_job_on(cluster, "n2"))
        next_job_on(cluster, "n1")
        cluster.kill_node("n1")
        until(lambda: cluster.state("n1") == "down", "Slurm misses n1")
        cluster.start_node("n1")
        until(lambda: cluster.state("n1") != "down", "n1 is back")
        project.status = running.wait()
    return project


def test_the_run_succeeds(disturbed):
    assert disturbed.status == 0, disturbed.log()
    assert "Nothing to be done" in disturbed.succeed(*SMALL, "figures")


def test_interrupted_jobs_are_run_again(disturbed, cluster):
    assert re.search("Trying to restart", disturbed.log())
    assert "due to failure of node n1" in (cluster.folder / "slurmctld.log").read_text()


def test_results_have_the_bits_of_a_local_run(disturbed, local):
    """The cluster has all products of a local run, and points are identical except for times."""
    local.succeed("-j2", *SMALL, "figures")
    points = sorted(local.folder.glob("results/*/*/*/*/seed*.nc"))
    assert len(points) == len(disturbed.points()) == 122
    for path in points:
        local_point, cluster_point = (
            read_point(folder / path.relative_to(local.folder)).drop_vars(
                WALL_CLOCK, errors="ignore"
            )
            for folder in (local.folder, disturbed.folder)
        )
        assert local_point.identical(cluster_point), path
    products = {name for name in local.files() if name.startswith(("results", "figures"))}
    assert products <= disturbed.files()


def test_after_an_interrupt_the_same_command_continues(cluster, tmp_path):
    project = OnCluster(Project(tmp_path).folder, cluster)
    with project.running(*COOLING) as running:
        until(project.points, "a first point", 300)
        os.killpg(running.pid, signal.SIGINT)
        assert running.wait() != 0
    until(lambda: not cluster.running(), "no job is left")
    times_of_points = {path: path.stat().st_mtime_ns for path in project.points()}
    project.succeed(*COOLING)
    assert len(project.points()) == 32
    assert (
        sum(path.stat().st_mtime_ns == modified for path, modified in times_of_points.items())
        >= len(times_of_points) // 2
    )
