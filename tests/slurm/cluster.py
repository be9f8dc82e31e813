"""A real Slurm on the loopback interface: a controller and two nodes of one core, all of them
processes of this machine that live in one folder."""

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
MARK = "SLURM_TEST_NODE"  # in the environment of a node's processes
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
    """Slurm, from `start` to `stop`, which leaves nothing behind."""

    def __init__(self):
        self.folder = Path(tempfile.mkdtemp(prefix="slurm"))  # short, as paths of sockets must be
        self.settings = self.folder / "slurm.conf"
        self.environment = os.environ | {
            "PATH": f"{self.folder}/bin{os.pathsep}{os.environ['PATH']}"
        }
        self._daemons = []

    def start(self):
        """Start all daemons; returns when both nodes wait for work."""
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
        self._daemon("slurmd", "-D", "-N", node, "-f", self.settings, **{MARK: self._mark(node)})

    def kill_node(self, node):
        """As a power cut does: its daemon, and all that runs there, at once."""
        while processes := self._processes(node):
            for process in processes:
                with suppress(psutil.NoSuchProcess):
                    process.kill()
            time.sleep(0.1)  # for what was just starting

    def stop(self):
        """End all daemons and jobs, and remove the folder."""
        for node in NODES:
            self.kill_node(node)
        for daemon in reversed(self._daemons):
            daemon.kill()
            daemon.wait()
        shutil.rmtree(self.folder)

    def __call__(self, client, *arguments):
        """What one of Slurm's commands prints."""
        done = subprocess.run(
            [client, *arguments], env=self.environment, capture_output=True, text=True
        )
        return done.stdout.strip()

    def state(self, node):
        """Of a node: idle, allocated, down, ..."""
        return self("sinfo", "--noheader", "--nodes", node, "--format=%T").rstrip("*")

    def running(self):
        """(job, node) of all that is running."""
        rows = self("squeue", "--noheader", "--states=R", "--format=%i %N")
        return {tuple(row.split()) for row in rows.splitlines()}

    def _write_settings(self):
        for name in ("munge", "state", "bin", *NODES):
            (self.folder / name).mkdir()
        for name in (".", "munge"):
            (self.folder / name).chmod(0o755)
        sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(3)]
        ports = [one.getsockname()[1] for one in sockets]
        for one in sockets:
            one.close()
        host, user = socket.gethostname().partition(".")[0], getpass.getuser()
        text = CONFIGURATION.format(folder=self.folder, ports=ports, host=host, user=user)
        self.settings.write_text(text)

    def _write_clients(self):
        """Slurm's commands, told of this cluster: in jobs, the plugin takes SLURM_CONF from the
        environment, as a cluster has its settings in /etc."""
        for name in CLIENTS:
            client = self.folder / "bin" / name
            found = shutil.which(name)
            client.write_text(f'#!/bin/sh\nSLURM_CONF={self.settings} exec {found} "$@"\n')
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
        """Those of a node: its daemon, the jobs there, and Slurm's keepers of these, whose own
        environment cannot be read."""
        found = set()
        for process in psutil.process_iter():
            try:
                environment = process.environ()
                if environment.get(MARK) == self._mark(node):
                    found.add(process)
                elif (environment.get("SLURM_CONF"), environment.get("SLURMD_NODENAME")) == (
                    str(self.settings),
                    node,
                ):
                    keepers = (one for one in process.parents() if one.name() == "slurmstepd")
                    found |= {process, *keepers}
            except psutil.Error:
                continue
        return found


def until(condition, what, seconds=120):
    """Wait until `condition()` holds; fail after so many seconds."""
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, f"not within {seconds} s: {what}"
        time.sleep(0.1)
