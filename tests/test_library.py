"""roughgas as a library: the same numbers, the same names and the same errors as the pipeline's."""

import doctest
import json
import shlex
import subprocess
import sys
import typing
from pathlib import Path

import numpy as np
import pytest
import tqdm
from schedules import STEADY
from slow_cases import slow_but

import roughgas
from roughgas import experiments, library, simulate, trajectory
from roughgas.base import InputError
from roughgas.cli import main
from roughgas.data.point import WALL_CLOCK, read_point
from roughgas.data.trajectory import write_trajectory
from roughgas.simulation import progress

ROOT = Path(__file__).parent.parent
POINT = {"r": 0.9, "beta": 0.5}
SHORT = {"equilibrate": 20, "measure": 40}
SCENE = {
    "particles": 20,
    "box": (25, 25),
    "effects": {"spin": {"inertia": 0.5}, "shear": {"velocity": 1}, "contact_averages": {}},
    "schedule": STEADY,
}
FEW = {"particles": 20, "box": (30, 30)}
CHANGED = {"particles": 20, "box": (12.5, "open"), "schedule": SHORT}
POINTS = {
    "as it is": ("cooling", {"scale": "small"}),
    "changed": ("vibrated", CHANGED | {"seed": 3, "effects": {"contact_time": None}}),
    "with an effect more": ("cooling", FEW | {"effects": {"friction": {"mu": 0.3}}}),
    "a variant": ("friction.cooling_friction/mu0.3", FEW),
    "of numpy's numbers": ("cooling", {"box": np.array([30, 30]), "particles": np.int64(20)}),
    "of one's own": (None, SCENE),
}


def assert_same(left, right):
    return left.drop_vars(WALL_CLOCK, errors="ignore").identical(
        right.drop_vars(WALL_CLOCK, errors="ignore")
    )


def test_a_trajectory_is_that_which_its_command_writes(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    gas = trajectory("cooling", **POINT, **FEW, times=[0, 2.5], progress=False)
    assert list(tmp_path.iterdir()) == []
    assert main(shlex.split(gas.command)[1:]) == 0
    write_trajectory("again.xyz", gas)
    assert Path("bed.xyz").read_bytes() == Path("again.xyz").read_bytes()
    assert gas.position.shape == (2, 20, 2) and gas.attrs["experiment"] == "cooling"
    with pytest.raises(InputError, match=r"frames = 1: must be a whole number in \[2, 10000\]"):
        trajectory("cooling", **POINT, frames=1)


@pytest.mark.parametrize(
    "name", slow_but(POINTS.keys() - {"with an effect more", "a variant"}, POINTS)
)
def test_a_dataset_is_that_of_the_file_which_its_command_writes(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    experiment, changes = POINTS[name]
    point = simulate(experiment, **POINT, **changes, progress=False)
    assert list(tmp_path.iterdir()) == []
    assert main(shlex.split(point.command)[1:]) == 0
    assert assert_same(point, read_point("point.nc"))
    assert point.R.attrs["long_name"] and point.E_trans.attrs["units"]


def test_an_experiment_of_another_configuration(tmp_path):
    text = (ROOT / "config.yaml").read_text()
    path = tmp_path / "mine.yaml"
    path.write_text(text.replace("experiments:\n", "experiments:\n  mine: {extends: cooling}\n"))
    small = {"particles": 10, "schedule": {"replicas": 2}, "progress": False}
    mine = simulate("mine", **POINT, config=path, **small)
    assert mine.experiment == "mine" and mine.R == simulate("cooling", **POINT, **small).R
    assert "mine" in experiments(path) and "mine" not in experiments()


def test_a_point_has_one_spelling_however_it_is_asked_for():
    settings = dict(box=[30, 30], particles=10, schedule=STEADY, seed=1, progress=False)
    from_text = simulate("sheared", r=".90", beta="-.5", **settings)
    from_numbers = simulate("sheared", r=0.9, beta=np.float32(-0.5), **settings)
    assert (
        (from_text.r_label, from_text.beta_label)
        == (from_numbers.r_label, from_numbers.beta_label)
        == ("0.9", "-0.5")
    )
    assert from_text.command == from_numbers.command


def test_lists_make_the_reduced_dataset_of_their_points(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    small = {"particles": 10, "packing": 0.1, "schedule": {"replicas": 2, "plateau": 10}}
    small |= {"progress": False, "observe": {"top": lambda frame: frame.position.max()}}
    several = {"beta": np.array([0.5, 0]), "seed": [1, 2], "keep_state": False}
    reduced = simulate("cooling", r=0.9, **several, **small)
    assert dict(reduced.sizes) == {"r": 1, "beta": 2, "seed": 2} and not list(tmp_path.iterdir())
    point = simulate("cooling", r=0.9, beta=0.5, seed=2, **small)
    assert reduced.R_seed.sel(r=0.9, beta=0.5, seed=2) == point.R
    assert reduced.R.sel(beta=0.5).item() == pytest.approx(
        reduced.R_seed.sel(beta=0.5).mean().item()
    )
    assert (
        reduced.attrs["packing"] == point.attrs["packing"] == 0.1 and reduced.top_stderr.min() > 0
    )
    sides = json.loads(point.experiment_json)["box"]
    assert 10 * np.pi / np.prod(sides) == pytest.approx(0.1)


class Bar(tqdm.tqdm):
    """A progress bar that remembers, and is interrupted at some share of its way."""

    instances: typing.ClassVar[list] = []
    interrupted_at = 2.0

    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **options)
        self.reached, self.closed = [], False
        self.instances.append(self)

    def update(self, by=1):
        super().update(by)
        self.reached.append(self.n / self.total)
        if self.reached[-1] > self.interrupted_at:
            raise KeyboardInterrupt

    def close(self):
        super().close()
        self.closed = True


@pytest.fixture
def bars(monkeypatch):
    """The progress bars that are shown, as on a terminal."""
    monkeypatch.setattr(progress, "_suitable_tqdm", lambda: Bar)
    monkeypatch.setattr(progress, "NOTEBOOK", "pytest")  # or stderr is none
    monkeypatch.setattr(Bar, "instances", [])
    return Bar.instances


def test_an_interrupt_leaves_nothing_behind(bars, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Bar, "interrupted_at", 0.5)
    with pytest.raises(KeyboardInterrupt):
        simulate(**POINT, **SCENE)
    (bar,) = bars
    assert bar.closed and 0.5 < bar.reached[-1] < 0.6
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_the_examples_in_docstrings():
    results = doctest.testmod(library)
    assert results.attempted > 5 and not results.failed


def test_importing_the_package_imports_none_of_what_it_needs():
    code = "import sys, roughgas; from roughgas import simulate, experiments; print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    heavy = {"numpy", "numba", "xarray", "netCDF4", "yaml", "tqdm", "roughgas.kernel"}
    assert "roughgas.library" in run.stdout.split() and not heavy & set(run.stdout.split())
    assert {"simulate", "experiments", "__version__"} <= set(dir(roughgas))
    with pytest.raises(AttributeError, match="module 'roughgas' has no attribute 'simulat'"):
        roughgas.simulat  # noqa: B018
