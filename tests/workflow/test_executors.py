"""The workflow with executors other than Slurm: a script starts the jobs, in the same folder or,
with all files in an S3 storage, in separate folders. Tests of Slurm are in tests/slurm."""

import os
import re
import shutil
import socket
import subprocess
import time
import urllib.request
from contextlib import contextmanager, suppress

import pytest
from project import ROOT, Project
from repositories import git

pytestmark = pytest.mark.slow

BIN = ROOT / ".venv-slurm/bin"
REDUCED = "results/tiny/cooling.nc"
POINTS = [f"results/tiny/cooling/r0.9/beta0/seed{seed}.nc" for seed in (1, 2)]
SUBMITTING = """\
#!/bin/sh
echo "$1 minutes, $2 MB" >> requests
nohup "$3" > "$3.log" 2>&1 &
echo $!
"""
SUBMITTING_ELSEWHERE = """\
#!/bin/sh
# a job gets an empty folder, as on a machine of its own
node=$(mktemp -d "$(dirname "$0")/node.XXXXXX")
cp "$1" "$node/job.sh"
cd "$node"
(sh ./job.sh > log 2>&1; echo $? > status) > /dev/null 2>&1 &
echo "$node"
"""
STATUS = """\
#!/bin/sh
case $(cat "$1/status" 2> /dev/null) in
    "") echo running ;;
    0) echo success ;;
    *) echo failed ;;
esac
"""
PLUGIN = """\
from dataclasses import replace

import snakemake_executor_plugin_cluster_generic as generic
from snakemake_executor_plugin_cluster_generic import Executor, ExecutorSettings

common_settings = replace(
    generic.common_settings, implies_no_shared_fs=True, job_deploy_sources=True
)
"""
"""The generic executor with nothing shared: jobs fetch the sources, as with Kubernetes."""


class ProjectWithExecutor(Project):
    """A copy of the project whose jobs an executor of .venv-slurm starts."""

    def run(self, *arguments, **environment):
        """Return the output of Snakemake, which must succeed."""
        assert os.access(BIN / "snakemake", os.X_OK), "make .venv-slurm/ready"
        command = [BIN / "snakemake", "--jobs", "2", "--seconds-between-status-checks", "1"]
        command += [*map(str, arguments), "--config", "scale=tiny", "--", REDUCED]
        done = subprocess.run(
            command,
            cwd=self.folder,
            env=self.environment() | environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        assert done.returncode == 0, done.stdout
        return done.stdout


def write_script(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    path.chmod(0o755)
    return path


def submitted_jobs(output):
    """Return the number of jobs that the executor has submitted."""
    return len(re.findall("Submitted job", output))


@pytest.fixture
def project(tmp_path):
    (tmp_path / "project").mkdir()
    return ProjectWithExecutor(tmp_path / "project")


def test_a_script_starts_the_jobs(project, tmp_path):
    script = write_script(tmp_path / "submit", SUBMITTING)
    command = f"{script} {{resources.runtime}} {{resources.mem_mb}}"
    options = ("--executor", "cluster-generic", "--cluster-generic-submit-cmd", command)
    options += ("--default-resources", "runtime=120", "mem_mb=1000")
    output = project.run(*options)
    assert submitted_jobs(output) == 3  # kernel, points, reduced dataset
    requests = (project.folder / "requests").read_text().splitlines()
    assert len(requests) == 3 and "120 minutes, 1000 MB" in requests
    assert all((project.folder / path).exists() for path in (*POINTS, REDUCED))
    assert "Nothing to be done" in project.run("-n")


class Storage:
    """An S3 storage on this machine, with an empty bucket `gases`."""

    def __init__(self, port):
        self.address = f"http://127.0.0.1:{port}"
        self._request("PUT", "gases")

    def keys(self):
        """Return the keys of all objects in the bucket."""
        listing = self._request("GET", "gases?list-type=2")
        return set(re.findall("<Key>(.*?)</Key>", listing))

    def _request(self, method, path):
        request = urllib.request.Request(f"{self.address}/{path}", method=method)
        with urllib.request.urlopen(request, timeout=60) as answer:
            return answer.read().decode()


@contextmanager
def s3_server(log):
    """Run a server of S3 on the loopback interface; yield its port once it listens."""
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    command = [BIN / "moto_server", "-H", "127.0.0.1", "-p", str(port)]
    with open(log, "w") as output:
        server = subprocess.Popen(command, stdout=output, stderr=output)
    try:
        deadline = time.monotonic() + 60
        while True:
            with suppress(OSError), socket.create_connection(("127.0.0.1", port), 1):
                break
            assert time.monotonic() < deadline and server.poll() is None, log.read_text()
            time.sleep(0.1)
        yield port
    finally:
        server.kill()
        server.wait()


@pytest.fixture
def storage(tmp_path):
    assert os.access(BIN / "moto_server", os.X_OK), "make .venv-slurm/ready"
    with s3_server(tmp_path / "s3.log") as port:
        yield Storage(port)


def test_with_nothing_shared_all_files_are_in_the_storage(project, storage, tmp_path):
    """Jobs get the files that git tracks, and no other file of the project's folder."""
    git(project.folder, "init", "--quiet")
    git(project.folder, "add", "--all")
    git(project.folder, "commit", "--quiet", "--message", "The project")
    (project.folder / "untracked.yaml").touch()
    nodes = tmp_path / "nodes"
    submit = write_script(nodes / "submit", SUBMITTING_ELSEWHERE)
    status = write_script(nodes / "status", STATUS)
    plugin = tmp_path / "plugin/snakemake_executor_plugin_separate/__init__.py"
    write_script(plugin, PLUGIN)
    options = ("--executor", "separate", "--separate-submit-cmd", submit)
    options += ("--separate-status-cmd", status, "--default-storage-provider", "s3")
    options += ("--default-storage-prefix", "s3://gases", "--shared-fs-usage", "none")
    environment = {
        "PYTHONPATH": os.pathsep.join([str(project.folder / "src"), str(plugin.parents[1])]),
        "SNAKEMAKE_STORAGE_S3_ENDPOINT_URL": storage.address,
        "SNAKEMAKE_STORAGE_S3_REGION": "us-east-1",
        "SNAKEMAKE_STORAGE_S3_ACCESS_KEY": "name",
        "SNAKEMAKE_STORAGE_S3_SECRET_KEY": "secret",
    }
    assert submitted_jobs(project.run(*options, **environment)) == 3
    assert {*POINTS, REDUCED} <= storage.keys()
    assert not (project.folder / "results").exists()
    folders = sorted(nodes.glob("node.*"))
    assert len(folders) == 3 and all((folder / "Snakefile").exists() for folder in folders)
    assert not list(nodes.glob("node.*/untracked.yaml"))


def test_a_machine_without_slurm_says_so_in_one_line(project):
    """Nothing is submitted: each job would fail at every attempt for a missing file."""
    programs = project.folder.parent / "programs"
    programs.mkdir()
    (programs / "python").symlink_to(BIN / "python")
    for name in ("bash", "sh", "which"):  # the plugin for Slurm looks for sacct by `which`
        (programs / name).symlink_to(shutil.which(name))
    command = [BIN / "snakemake", "--workflow-profile", "profiles/slurm", "--", REDUCED]
    environment = project.environment() | {"PATH": str(programs)}
    done = subprocess.run(
        command, cwd=project.folder, env=environment, capture_output=True, text=True
    )
    assert done.returncode != 0
    lines = [line for line in done.stderr.splitlines() if line.startswith("roughgas: error")]
    assert len(lines) == 1 and "executor = slurm: must be on this machine, which lacks" in lines[0]
    assert "Submitted job" not in done.stdout + done.stderr
