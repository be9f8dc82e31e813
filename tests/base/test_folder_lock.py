"""The lock of a folder: messages name the process that holds it, its age, and remedies."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from contextlib import contextmanager

import pytest

from roughgas.base import folder_lock
from roughgas.base.folder_lock import HeldError, Holder

HOLD = "import sys, time\nfrom roughgas.base.folder_lock import lock\nfile = lock(sys.argv[1])\n"
WAIT = "print('held', flush=True)\ntime.sleep(600)\n"
FORK = "import os\nif os.fork():\n    print('held', flush=True)\n    os._exit(0)\ntime.sleep(600)\n"


@contextmanager
def process_that_holds(path, program):
    """Run a program that holds the lock at `path`; its process group is killed at the end."""
    command = [sys.executable, "-c", program, str(path)]
    running = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True
    )
    try:
        assert running.stdout.readline() == b"held\n"
        yield running
    finally:
        os.killpg(running.pid, signal.SIGKILL)
        running.communicate()


def refusal(path):
    """Return the message when the lock at `path` is held."""
    with pytest.raises(HeldError) as raised:
        folder_lock.lock(path)
    assert "\n" not in str(raised.value)
    return str(raised.value)


def test_the_process_that_holds_a_folder_is_named_with_its_age(tmp_path):
    path = tmp_path / "alive"
    with process_that_holds(path, HOLD + WAIT) as running:
        for _ in range(2):  # a refusal does not change the record
            text = refusal(path)
            assert f": process {running.pid}, which began " in text
            assert re.search(r"began \d+ s ago; ", text)
            assert f"`kill -INT {running.pid}`" in text and f"`kill -KILL {running.pid}`" in text
        assert folder_lock.is_held(path)
    assert not folder_lock.is_held(path)
    folder_lock.lock(path).close()  # the lock of a killed process is free


def test_a_child_that_outlives_the_holder_is_named(tmp_path):
    path = tmp_path / "alive"
    with process_that_holds(path, HOLD + FORK) as parent:
        parent.wait()
        child = int(re.search(r": process (\d+), ", refusal(path))[1])
        assert child != parent.pid and os.getpgid(child) == parent.pid


def test_an_unknown_holder_gets_advice(tmp_path, monkeypatch):
    path = tmp_path / "alive"
    with process_that_holds(path, HOLD + WAIT):
        path.write_text("")
        monkeypatch.setattr(
            folder_lock, "_opener", lambda path: None
        )  # as of another user's process
        assert "its process is not known" in refusal(path)
        assert "ps -ef | grep snakemake" in refusal(path)


def test_a_holder_on_another_machine_is_named_with_the_machine(tmp_path):
    path = tmp_path / "alive"
    elsewhere = Holder(1, "elsewhere", time.time() - 7500.0)
    with process_that_holds(path, HOLD + WAIT):
        path.write_text(json.dumps(elsewhere))
        assert "process 1 on elsewhere, which began 2 h 5 min ago" in refusal(path)


def test_a_reused_process_id_is_not_taken_for_the_holder():
    now = Holder.of_this_process()
    assert not now.is_gone()
    assert now._replace(begun=now.begun - 60.0).is_gone()


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(-1, "0 s"), (59.9, "59 s"), (200, "3 min"), (7500, "2 h 5 min"), (2e5, "2 d 7 h")],
)
def test_ages_are_rounded_down(seconds, text):
    assert folder_lock.duration_text(seconds) == text


def test_a_lock_of_snakemake_without_a_process_gets_advice(tmp_path):
    path = tmp_path / "alive"
    for _ in ("no file", "a file that nobody holds"):
        text = folder_lock.advice_on_snakemakes_lock(path)
        assert "no Snakemake is known" in text and "`snakemake --unlock`" in text
        path.touch()
    with process_that_holds(path, HOLD + WAIT) as running:
        assert f"process {running.pid}," in folder_lock.advice_on_snakemakes_lock(path)
