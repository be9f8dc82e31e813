"""A real Slurm on the loopback interface: a controller and two single-core nodes, all of them
processes on this machine, with all files in a temporary folder."""

import getpass
import os
import shutil
import socket
import subprocess
import tempfile
import time
from contextlib import suppress
from pathlib import Path

import psutil

NODES = ("n1", "n2")
CLIENTS = ("sbatch", "srun", "scancel", "squeue", "scontrol", "sinfo", "sacct", "sacctmgr")
NODE_VARIABLE = "SLURM_TEST_NODE"  # environment variable of a node's processes
CONFIGURATION = """\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket,cred_expire=10
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/%n.pid
SlurmdSpoolDir={folder}/%n
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/%n.log
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=2,batch_sched_delay=0
SlurmdTimeout=5
ReturnToService=2
KillWait=2
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[1]} CPUs=1 RealMemory=2000
NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[2]} CPUs=1 RealMemory=2000
PartitionName=debug Nodes=ALL Default=YES State=UP
"""


class Cluster:
    """A Slurm cluster that runs from `start` to `stop`, and leaves no files or processes."""

    def __init__(self):
        self.folder = Path(tempfile.mkdtemp(prefix="slurm"))  # short: paths of sockets are limited
        self.settings = self.folder / "slurm.conf"
        self.environment = os.environ | {
            "PATH": f"{self.folder}/bin{os.pathsep}{os.environ['PATH']}"
        }
        self._daemons = []

    def start(self):
        """Start all daemons; return when both nodes are idle."""
        self._write_settings()
        self._write_clients()
        munge = self.folder / "munge"
        files = {name: munge / name for name in ("socket", "key", "pid", "log", "seed")}
        files["key"].write_bytes(os.urandom(128))
        files["key"].chmod(0o400)
        options = [f"--{name}-file={files[name]}" for name in ("key", "pid", "log", "seed")]
        self._daemon("munged", "--foreground", f"--socket={files['socket']}", *options)
        until(files["socket"].exists, "munged listens")
        self._daemon("slurmctld", "-D", "-f", self.settings)
        for node in NODES:
            self.start_node(node)
        until(lambda: all(self.state(node) == "idle" for node in NODES), "both nodes are idle")

    def start_node(self, node):
        self._daemon(
            "slurmd", "-D", "-N", node, "-f", self.settings, **{NODE_VARIABLE: self._mark(node)}
        )

    def kill_node(self, node):
        """Kill the daemon and all processes of a node, as a power cut does."""
        while processes := self._processes(node):
            for process in processes:
                with suppress(psutil.NoSuchProcess):
                    process.kill()
            time.sleep(0.1)  # for processes that are just starting

    def stop(self):
        """End all daemons and jobs, and remove the folder."""
        for node in NODES:
            self.kill_node(node)
        for daemon in reversed(self._daemons):
            daemon.kill()
            daemon.wait()
        shutil.rmtree(self.folder)

    def __call__(self, client, *arguments):
        """Run a command of Slurm, and return its output."""
        process = subprocess.run(
            [client, *arguments], env=self.environment, capture_output=True, text=True
        )
        return process.stdout.strip()

    def state(self, node):
        """Return the state of a node: idle, allocated, down, ..."""
        return self("sinfo", "--noheader", "--nodes", node, "--format=%T").rstrip("*")

    def running(self):
        """Return (job, node) of all running jobs."""
        rows = self("squeue", "--noheader", "--states=R", "--format=%i %N")
        return {tuple(row.split()) for row in rows.splitlines()}

    def _write_settings(self):
        for name in ("munge", "state", "bin", *NODES):
            (self.folder / name).mkdir()
        for name in (".", "munge"):
            (self.folder / name).chmod(0o755)
        sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(3)]
        ports = [listener.getsockname()[1] for listener in sockets]
        for listener in sockets:
            listener.close()
        host, user = socket.gethostname().partition(".")[0], getpass.getuser()
        text = CONFIGURATION.format(folder=self.folder, ports=ports, host=host, user=user)
        self.settings.write_text(text)

    def _write_clients(self):
        """Write wrappers of Slurm's commands that set SLURM_CONF to this cluster.

        The plugin removes SLURM_CONF from the environment of jobs: real clusters have their
        settings in /etc.
        """
        for name in CLIENTS:
            client = self.folder / "bin" / name
            executable = shutil.which(name)
            client.write_text(f'#!/bin/sh\nSLURM_CONF={self.settings} exec {executable} "$@"\n')
            client.chmod(0o755)

    def _daemon(self, program, *arguments, **environment):
        log = open(self.folder / f"{program}.out", "a")
        path = f"{os.environ['PATH']}:/usr/sbin:/sbin"
        self._daemons.append(
            subprocess.Popen(
                [shutil.which(program, path=path), *map(str, arguments)],
                env=os.environ | {"SLURM_CONF": str(self.settings)} | environment,
                stdout=log,
                stderr=log,
                start_new_session=True,
            )
        )

    def _mark(self, node):
        return f"{self.folder}/{node}"

    def _processes(self, node):
        """Return the processes of a node: its daemon, its jobs, and their slurmstepd, whose
        environment is not readable."""
        processes = set()
        for process in psutil.process_iter():
            try:
                environment = process.environ()
                if environment.get(NODE_VARIABLE) == self._mark(node):
                    processes.add(process)
                elif (environment.get("SLURM_CONF"), environment.get("SLURMD_NODENAME")) == (
                    str(self.settings),
                    node,
                ):
                    keepers = (
                        parent for parent in process.parents() if parent.name() == "slurmstepd"
                    )
                    processes |= {process, *keepers}
            except psutil.Error:
                continue
        return processes


def until(condition, expectation, seconds=120):
    """Wait until `condition()` is true; fail after a number of seconds."""
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, f"not within {seconds} s: {expectation}"
        time.sleep(0.1)
