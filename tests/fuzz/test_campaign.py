"""The long campaigns, tried shortly: they still know all that they try."""

import subprocess
import sys

import pytest
from hard_cases import test_random_scenes
from hard_cases.watched import Worst
from tests.fuzz.campaign import Campaign, scenes

KINDS = ("configurations", "commands", "files", "scenes")


@pytest.mark.slow
def test_each_campaign_runs():
    options = [word for kind in KINDS for word in (f"--{kind}", "4")]
    command = [sys.executable, "-m", "tests.fuzz.campaign", *options]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("4 tried") == done.stdout.count("faults: 0") == len(KINDS)


def test_one_bad_scene_is_one_fault_and_can_be_tried_again(monkeypatch, capsys):
    def see(worst, experiment, r, beta, seed):
        worst.imbalance = 32.0 if seed == 3 else 0.1
        return "held" if seed == 5 else "run"

    monkeypatch.setattr(test_random_scenes, "fits", lambda *scene: True)
    monkeypatch.setattr(Worst, "see", see)
    assert not scenes(Campaign("scenes", 8, 1), None)
    said = capsys.readouterr().out
    assert "scenes: 8 tried with seed 1: 1 held, 6 run" in said and "faults: 1" in said
    assert "1 times AssertionError" in said and "\n    number 3: " in said
    assert "32 roundings of energy missing an exchange: number 3, ({'particles'" in said
