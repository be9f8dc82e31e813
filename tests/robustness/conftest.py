"""Real processes on machines that are not as they should be."""

import json
import os
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from schedules import BRIEF, TINY

from roughgas.compiling.cache_folders import kernel_folder

ROOT = Path(__file__).parent.parent.parent
LONG_RUN = TINY | {"schedule": BRIEF | {"plateau": 5_000_000, "sample_every": 25}}
TMPFS = "mount -t tmpfs -o {options} none {folder} && exec {command}"


def environment(**changes):
    """Return this process's environment with the session's kernels and `changes`; None unsets."""
    variables = os.environ | {
        "PYTHONPATH": str(ROOT / "src"),
        "ROUGHGAS_CACHE_DIR": str(kernel_folder().parent),
    }
    return {name: value for name, value in (variables | changes).items() if value is not None}


def python(*arguments, cwd, mount=None, **changes):
    """Return a finished process of this Python; `mount` is options and folder of a private disk."""
    command = [sys.executable, *map(str, arguments)]
    if mount:
        options, folder = mount
        script = TMPFS.format(options=options, folder=folder, command=shlex.join(command))
        command = ["unshare", "--mount", "--map-root-user", "sh", "-c", script]
    return subprocess.run(
        command, cwd=cwd, env=environment(**changes), capture_output=True, text=True, timeout=300
    )


def roughgas(*arguments, **options):
    """Return a finished process of `roughgas`."""
    return python("-m", "roughgas", *arguments, **options)


def run_arguments(output, settings=TINY, seed=1):
    arguments = ["run", "cooling", "--r=0.9", "--beta=0", f"--seed={seed}"]
    return [*arguments, "--settings", json.dumps(settings), "--output", str(output)]


def handles_signal(process, number):
    for line in Path(f"/proc/{process.pid}/status").read_text().splitlines():
        if line.startswith("SigCgt:"):
            return bool(int(line.split()[1], 16) >> (number - 1) & 1)
    return False


def wait_until(condition, process=None):
    """Wait for `condition()`, at most as long as the process lives."""
    deadline = time.monotonic() + 120
    while not condition():
        assert time.monotonic() < deadline
        assert process is None or process.poll() is None
        time.sleep(0.02)


def interrupt(process, number=signal.SIGINT):
    """Send a signal to a process and its children, as a terminal does; return the output."""
    os.killpg(process.pid, number)
    output, _ = process.communicate(timeout=300)
    return output


@pytest.fixture(scope="session")
def mounts():
    trial = subprocess.run(
        ["unshare", "--mount", "--map-root-user", "mount", "-t", "tmpfs", "none", "/mnt"],
        capture_output=True,
        text=True,
    )
    if trial.returncode:
        pytest.skip(f"no disk can be mounted here: {trial.stderr.strip()}")
