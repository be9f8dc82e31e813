"""A project whose Snakemake submits its jobs to a cluster."""

import subprocess
from contextlib import contextmanager
from pathlib import Path

from cluster import Cluster
from project import ROOT, Project

SNAKEMAKE = ROOT / ".venv-slurm/bin/snakemake"
# waits of seconds, instead of minutes on a real cluster
IMPATIENT = ("--slurm-init-seconds-before-status-checks", "2", "--latency-wait", "10")


class OnCluster(Project):
    """The project in `folder`, run on a cluster by the Slurm profile."""

    def __init__(self, folder: Path, cluster: Cluster):
        self.folder = folder
        self.cluster = cluster

    def start(self, *arguments):
        """Start Snakemake, and return its process; output is appended to the file `log`."""
        with open(self.folder / "log", "a") as log:
            return subprocess.Popen(
                self._command(arguments),
                cwd=self.folder,
                env=self.cluster.environment,
                stdout=log,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )

    @contextmanager
    def running(self, *arguments):
        """Start Snakemake for the duration of a block: at its end the process is killed."""
        process = self.start(*arguments)
        try:
            yield process
        finally:
            process.kill()
            process.wait()

    def snakemake(self, *arguments):
        length_before = len(self.log())
        status = self.start(*arguments).wait()
        return status, self.log()[length_before:]

    def log(self):
        path = self.folder / "log"
        return path.read_text() if path.exists() else ""

    def points(self):
        return sorted(self.folder.glob("results/*/*/*/*/seed*.nc"))

    def _command(self, arguments):
        return [str(SNAKEMAKE), "--workflow-profile", "profiles/slurm", *IMPATIENT, *arguments]
