"""A target instead of run lengths, through the whole workflow."""

import copy

import pytest
from project import TINY, Project

from roughgas.data.point import read_point
from roughgas.data.reduced import read_reduced

pytestmark = pytest.mark.slow
NAMES = ("sheared", "cooling")
PLACE = "results/aimed/sheared/r0.9/beta0"


@pytest.fixture(scope="module")
def aimed(tmp_path_factory):
    """A project in which two experiments have been run to a target."""
    project = Project(tmp_path_factory.mktemp("aimed"))

    def change(config):
        scale = copy.deepcopy(TINY)
        for name in NAMES:
            scale[name] = {key: scale[name][key] for key in ("particles", "box")}
            scale[name] |= {"target_stderr": 0.03, "sweep": {"r": ["0.9"], "beta": ["0", "0.5"]}}
        config["scales"]["aimed"] = scale

    project.configure(change)
    targets = [f"results/aimed/{name}.nc" for name in NAMES]
    project.succeed("-j2", "--config", "scale=aimed", "--", *targets, "costs")
    return project


@pytest.mark.parametrize("name", NAMES)
def test_every_point_meets_its_target(aimed, name):
    data = read_reduced(aimed.folder / f"results/aimed/{name}.nc")
    assert (data.R_stderr <= 0.03).all() and (data.target_stderr == 0.03).all()
    assert (data.n_seeds >= 2).all()


def test_what_was_planned_stands_beside_what_happened(aimed):
    text = (aimed.folder / "results/aimed/costs.md").read_text()
    assert "| sheared | 2 | 0.03 | 2 |" in text and "| cooling | 2 | 0.03 | 2 |" in text


def test_a_single_seed_is_the_one_of_its_point(aimed):
    """Its lengths are worked out anew, from a pilot of its own."""
    aimed.succeed("-j1", "--config", "scale=aimed", "--", f"{PLACE}/seed2.nc")
    alone = read_point(aimed.folder / PLACE / "seed2.nc")
    together = read_point(aimed.folder / PLACE / "seeds" / "seed2.nc")
    assert alone.R.item() == together.R.item()


def test_a_second_run_does_nothing(aimed):
    targets = [f"results/aimed/{name}.nc" for name in NAMES]
    assert "Nothing to be done" in aimed.succeed("-j1", "--config", "scale=aimed", "--", *targets)


def test_another_target_takes_other_seeds_but_no_other_pilot(aimed, tmp_path):
    changed = aimed.copy_to(tmp_path / "changed")
    changed.configure(
        lambda config: config["scales"]["aimed"]["sheared"].update(target_stderr=0.02)
    )
    output = changed.succeed("-n", "--config", "scale=aimed", "--", "results/aimed/sheared.nc")
    assert "reach" in output and "pilot of" not in output
