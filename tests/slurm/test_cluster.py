"""The pipeline on a real Slurm: a node goes down and comes back, a job is cancelled, Snakemake is
interrupted, and nothing is lost."""

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
PLACES = [f"{name}/r{r}" for name in AT_EACH_R for r in ("0.99", "0.9", "0.8", "0.6")]
COMPILED = [f"results/small/{place}/compiled.txt" for place in WALLS + PLACES]
ONE = (*SMALL, "results/small/cooling.nc")


def just_started(cluster, node):
    """A job that this node has begun while we looked."""
    before = cluster.running()
    begun = []

    def looked():
        begun[:] = [job for job, where in cluster.running() - before if where == node]
        return begun

    until(looked, f"a job starts on {node}")
    return begun[0]


@pytest.fixture(scope="module")
def local(tmp_path_factory):
    """A project in which all is compiled."""
    local = Project(tmp_path_factory.mktemp("local"))
    local.succeed("-j2", *SMALL, *COMPILED)
    return local


@pytest.fixture(scope="module")
def disturbed(cluster, local, tmp_path_factory):
    """The figures at the small scale. When the first points are there a job is cancelled, and a
    node loses its power; it is back as soon as Slurm has seen that."""
    folder = tmp_path_factory.mktemp("cluster") / "disturbed"
    project = OnCluster(local.copy_to(folder).folder, cluster)
    with project.running(*SMALL, "figures") as running:
        until(project.points, "a first point", 300)
        cluster("scancel", just_started(cluster, "n2"))
        just_started(cluster, "n1")
        cluster.kill_node("n1")
        until(lambda: cluster.state("n1") == "down", "Slurm misses n1")
        cluster.start_node("n1")
        until(lambda: cluster.state("n1") != "down", "n1 is back")
        project.status = running.wait()
    return project


def test_the_run_ends_well(disturbed):
    assert disturbed.status == 0, disturbed.log()
    assert "Nothing to be done" in disturbed.succeed(*SMALL, "figures")


def test_jobs_that_were_cut_off_are_run_again(disturbed, cluster):
    assert re.search("Trying to restart", disturbed.log())
    assert "due to failure of node n1" in (cluster.folder / "slurmctld.log").read_text()


def test_nothing_is_lost(disturbed, local):
    """All that a run on this machine makes is there, with the same bits."""
    local.succeed("-j2", *SMALL, "figures")
    points = sorted(local.folder.glob("results/*/*/*/*/seed*.nc"))
    assert len(points) == len(disturbed.points()) == 122
    for path in points:
        one, other = (
            read_point(folder / path.relative_to(local.folder)).drop_vars(
                WALL_CLOCK, errors="ignore"
            )
            for folder in (local.folder, disturbed.folder)
        )
        assert one.identical(other), path
    made = {name for name in local.files() if name.startswith(("results", "figures"))}
    assert made <= disturbed.files()


def test_after_an_interrupt_the_same_command_goes_on(cluster, tmp_path):
    project = OnCluster(Project(tmp_path).folder, cluster)
    with project.running(*ONE) as running:
        until(project.points, "a first point", 300)
        os.killpg(running.pid, signal.SIGINT)
        assert running.wait() != 0
    until(lambda: not cluster.running(), "no job is left")
    kept = {path: path.stat().st_mtime_ns for path in project.points()}
    project.succeed(*ONE)
    assert len(project.points()) == 32
    assert sum(path.stat().st_mtime_ns == when for path, when in kept.items()) >= len(kept) // 2
