"""The long campaigns, tried shortly: they still know all that they try."""

import subprocess
import sys

import pytest

KINDS = ("configurations", "commands", "files", "scenes")


@pytest.mark.slow
def test_each_campaign_runs():
    options = [word for kind in KINDS for word in (f"--{kind}", "4")]
    command = [sys.executable, "-m", "tests.fuzz.campaign", *options]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("4 tried") == done.stdout.count("faults: 0") == len(KINDS)
