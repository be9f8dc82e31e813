"""The film of a cooling gas: what it shows, and that an interruption cannot be seen in it."""

import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from tests.entry import main

from roughgas.data import checkpoint
from roughgas.data.film import read_film
from roughgas.simulation import clustering

SETTINGS = {
    "particles": 100,
    "box": [40.0, 50.0],
    "effects": {"spin": {"inertia": 0.5}},
    "r": "0.9",
    "beta": "0.2",
    "seed": 3,
    "thermalise": 5,
    "collisions": 60,
    "frames": 12,
    "cell": 5,
    "window": 30,
}
NEVER = 10**6


class Silent:
    """A watcher that remembers what it was told; it can stop the run at a frame."""

    def __init__(self, stop_at=None):
        self.told, self.why, self.stop_at = [], [], stop_at

    def fresh(self, why):
        self.why.append(why)

    def reached(self, frame, collisions, saved):
        self.told.append((frame, collisions, saved))
        if frame == self.stop_at:
            raise KeyboardInterrupt


def filmed(path, every=NEVER, watcher=None, **others):
    return clustering.run(SETTINGS | others, path, every, watcher or Silent())[0]


def same_bits(one, other):
    timeless = set(one) - {"kernel_seconds"}
    assert set(one) == set(other)
    return all(np.asarray(one[k]).tobytes() == np.asarray(other[k]).tobytes() for k in timeless)


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("undisturbed")
    film = filmed(folder / "c.npz")
    assert list(folder.iterdir()) == []
    return film


def test_the_frames_are_evenly_spaced_in_collisions(undisturbed):
    passed = undisturbed["collisions_per_particle"]
    assert passed == pytest.approx(np.linspace(0, 60, 13))
    assert undisturbed["collisions"] == 100 / 2 * (5 + 60)
    assert undisturbed["time"][0] == 0.0 and np.all(np.diff(undisturbed["time"]) > 0.0)
    assert np.all(np.diff(np.diff(undisturbed["time"])) > 0.0)  # it slows down


def test_every_particle_is_on_the_map(undisturbed):
    count = undisturbed["count"]
    assert count.shape == (13, 10, 8)
    assert np.all(count.sum(axis=(1, 2)) == 100)
    assert undisturbed["x"] == pytest.approx(2.5 + 5 * np.arange(8))
    assert undisturbed["y"] == pytest.approx(2.5 + 5 * np.arange(10))


def test_a_particle_that_rounding_folds_onto_the_far_edge_is_on_the_map():
    x = np.mod([-1e-20, 3.0], 40.0)
    assert x[0] == 40.0
    count = clustering._count(x, np.mod([7.0, -1e-20], 50.0), (40.0, 50.0), 5)
    assert count.sum() == count[1, 7] + count[9, 0] == 2


def test_disks_are_in_the_window_and_do_not_overlap(undisturbed):
    ends = np.cumsum(undisturbed["disks"])
    assert ends[-1] == len(undisturbed["disk_x"]) == len(undisturbed["disk_spin"])
    for frame, end in enumerate(ends):
        one = slice(end - undisturbed["disks"][frame], end)
        x, y = (undisturbed[name][one].astype(float) for name in ("disk_x", "disk_y"))
        assert 20 < len(x) < 100
        assert np.all(abs(x - 20) < 16) and np.all(abs(y - 25) < 16)
        distance = np.hypot(x[:, None] - x, y[:, None] - y) + 9.0 * np.eye(len(x))
        assert distance.min() > 2.0 - 1e-5


@pytest.mark.parametrize("every", [1, 5])
def test_checkpoints_change_no_bit(undisturbed, tmp_path, every):
    watcher = Silent()
    assert same_bits(filmed(tmp_path / "c.npz", every, watcher), undisturbed)
    frames, collisions, saved = zip(*watcher.told, strict=True)
    assert frames == tuple(range(13)) and list(collisions) == sorted(collisions)
    assert [frame for frame in frames if saved[frame]] == list(range(every, 12, every))


def test_a_run_that_is_stopped_several_times_gives_the_same_bits(undisturbed, tmp_path):
    path = tmp_path / "c.npz"
    for stop in (2, 7, 11):
        with pytest.raises(KeyboardInterrupt):
            filmed(path, 3, Silent(stop))
    watcher = Silent()
    assert same_bits(filmed(path, 3, watcher), undisturbed)
    assert watcher.told[0][0] == 9 and watcher.why == []


def stopped(path):
    with pytest.raises(KeyboardInterrupt):
        filmed(path, 2, Silent(5))


@pytest.mark.parametrize("others", [{"seed": 4}, {"r": "0.8"}, {"beta": "0"}, {"cell": 4}])
def test_a_checkpoint_of_other_settings_is_not_used(tmp_path, others):
    stopped(tmp_path / "c.npz")
    watcher = Silent()
    film = filmed(tmp_path / "c.npz", watcher=watcher, **others)
    assert watcher.told[0][0] == 0
    assert watcher.why == [f"{tmp_path / 'c.npz'} belongs to other settings or to other sources"]
    assert same_bits(film, filmed(tmp_path / "none.npz", **others))


def test_a_checkpoint_of_other_sources_is_not_used(tmp_path, monkeypatch):
    stopped(tmp_path / "c.npz")
    monkeypatch.setattr(clustering, "source_hash", lambda: "another")
    watcher = Silent()
    filmed(tmp_path / "c.npz", watcher=watcher)
    assert watcher.told[0][0] == 0 and "other sources" in watcher.why[0]


# ---------------------------------------------------------------- the command


def arguments(output, every=NEVER, **others):
    settings = json.dumps(SETTINGS | others)
    every = f"--checkpoint-every={every}"
    return ["clustering", "--settings", settings, every, "--output", str(output)]


def test_a_killed_command_goes_on_from_its_last_checkpoint_with_the_same_bits(tmp_path, capsys):
    long = {"frames": 1000, "collisions": 100}
    whole, killed = tmp_path / "whole.nc", tmp_path / "killed.nc"
    saved = tmp_path / "killed.nc.checkpoint.npz"
    assert main(arguments(whole, **long)) == 0
    step = [sys.executable, "-m", "roughgas.steps", *arguments(killed, 1, **long)]
    process = subprocess.Popen(step, stderr=subprocess.PIPE)
    deadline = time.monotonic() + 300
    while not saved.exists():
        assert process.poll() is None and time.monotonic() < deadline
        time.sleep(0.001)
    os.kill(process.pid, signal.SIGKILL)
    process.communicate()
    assert process.returncode == -signal.SIGKILL
    assert saved.exists() and not killed.exists()
    capsys.readouterr()
    assert main(arguments(killed, **long)) == 0
    assert capsys.readouterr().err.startswith(f"clustering: going on from {saved}\n")
    one, other = (read_film(path).drop_vars("kernel_seconds") for path in (whole, killed))
    assert one.attrs.pop("command") != other.attrs.pop("command")  # they name the output
    assert one.identical(other)
    assert {path.name for path in tmp_path.iterdir()} == {"whole.nc", "killed.nc"}


def test_an_interrupt_says_how_to_go_on(tmp_path, capsys, monkeypatch):
    save = checkpoint.save

    def save_once(*arguments):
        save(*arguments)
        monkeypatch.setattr(clustering.checkpoint, "save", interrupted)

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(clustering.checkpoint, "save", save_once)
    assert main(arguments(tmp_path / "a.nc", 4)) == 130
    said = capsys.readouterr().err.splitlines()
    assert said[-1] == ("roughgas: stopped: the same command goes on from frame 4 of 12")
    assert [path.name for path in tmp_path.iterdir()] == ["a.nc.checkpoint.npz"]
    assert main(arguments(tmp_path / "b.nc", 4)) == 130
    assert "no checkpoint written yet" in capsys.readouterr().err


def test_a_damaged_checkpoint_is_named_in_one_line(tmp_path, capsys):
    saved = tmp_path / "a.nc.checkpoint.npz"
    saved.write_bytes(b"PK not really")
    assert main(arguments(tmp_path / "a.nc")) == 0
    said = capsys.readouterr().err.splitlines()
    assert said[0] == f"clustering: {saved} is damaged: starting afresh"
    assert len(said) == 2 and not saved.exists()


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"r": "1.5"}, "--settings.r = '1.5': must lie in [0, 1]"),
        ({"frames": 0}, "--settings.frames = 0: must be a whole number >= 1"),
        ({"particles": 1000}, "particles = 1000: must be at most 540 in this box"),
        ({"every": 0}, "--checkpoint-every = 0: must be a whole number of frames >= 1"),
    ],
)
def test_bad_input_is_refused_in_one_line(tmp_path, capsys, changed, message):
    assert main(arguments(tmp_path / "a.nc", **changed)) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"roughgas: error: {message}") and said.count("\n") == 1
    assert list(tmp_path.iterdir()) == []
