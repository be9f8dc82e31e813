"""A sweep with a third axis, through the whole workflow."""

import shlex
import subprocess
import sys

import pytest
from project import Project
from test_targets import refusal

from roughgas.data.point import read_point
from roughgas.data.reduced import read_reduced

EXPERIMENTS = {
    "spun": {"extends": "sheared", "sweep": {"spin.inertia": ["1", "0.1"]}},
    # with and without the model: two kernels
    "modelled": {"extends": "sheared", "sweep": {"contact_time.below_r": ["1", "0.95", "0"]}},
    "walled": {
        "extends": "vibrated_rough_walls",
        "sweep": {"walls.roughness": ["particles", "-1"], "seeds": 1},
    },
}
SPUN = "results/tiny/spun"
LEGAL = [
    f"{SPUN}/inertia0.33/r0.87/beta-0.2/seed7.nc",
    "results/paper/spun/inertia1e-3/r0.5/beta1/seed1.nc",
    "results/small/walled/roughnessparticles/r0.9/beta0/seed1.nc",
    "results/paper/walled/roughness-.5/r0.9/beta0/seed1.nc",
]
ILLEGAL = [
    (
        f"{SPUN}/r0.9/beta0/seed1.nc",
        "experiment = 'spun': must be followed by a variant, such as spun/inertia1",
    ),
    (
        f"{SPUN}/inertia2/r0.9/beta0/seed1.nc",
        "spun/inertia2.effects.spin.inertia = 2.0: must be a number in [1e-06, 1]",
    ),
]


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """A project with experiments that have a third axis, in which nothing has been run."""
    project = Project(tmp_path_factory.mktemp("axis"))

    def change(config):
        config["experiments"] |= EXPERIMENTS

    project.configure(change)
    return project


@pytest.fixture(scope="module")
def ran(project, tmp_path_factory):
    """The same after one of these experiments has been run."""
    ran = project.copy_to(tmp_path_factory.mktemp("runs") / "ran")
    ran.succeed("-j2", "--config", "scale=tiny", "--", f"{SPUN}.nc")
    return ran


def sweep_inertia(*labels):
    """An edit of config.yaml."""
    return lambda config: config["experiments"]["spun"]["sweep"].update({"spin.inertia": labels})


def test_all_variants_are_run_and_compiled_together(project):
    planned = project.planned(f"{SPUN}.nc")
    assert planned == {"compile_kernel": 1, "seeds": 2, "reduce": 1}
    planned = project.planned("results/tiny/walled.nc")
    assert planned == {"compile_kernel": 1, "point": 2, "reduce": 1}


def test_any_legal_value_can_be_asked_for(project):
    assert project.planned(*LEGAL) == {"compile_kernel": len(LEGAL), "point": len(LEGAL)}


@pytest.mark.parametrize(("target", "message"), ILLEGAL)
def test_an_illegal_target_is_refused_in_one_line(project, target, message):
    assert message in refusal(project, target)


@pytest.mark.parametrize(
    "target",
    [
        "results/tiny/accuracy/inertia1/r0.9/beta0/seed1.nc",
        f"{SPUN}/inertia1.nc",
        f"{SPUN}/inertia1/r0.9/compiled.txt",
    ],
)
def test_other_folders_are_no_variants(project, target):
    status, output = project.snakemake("-n", target)
    assert status != 0 and "MissingRuleException" in output


def test_an_illegal_value_in_a_sweep_is_refused(project, tmp_path):
    changed = project.copy_to(tmp_path / "copy")
    changed.configure(sweep_inertia("1", "7"))
    line = refusal(changed, f"{SPUN}.nc")
    assert line.startswith("roughgas: error: config.yaml: experiments.spun/inertia7.effects.spin.")
    assert "inertia = 7.0: must be a number in [1e-06, 1]" in line


@pytest.mark.slow
def test_a_point_says_which_variant_it_is_of_and_how_to_make_it_again(ran, tmp_path):
    path = ran.folder / SPUN / "inertia0.1/r0.9/beta0/seed2.nc"
    point = read_point(path)
    about = {name: point.attrs[name] for name in ("experiment", "variant", "swept", "inertia")}
    assert about == {
        "experiment": "spun",
        "variant": "inertia0.1",
        "swept": "spin.inertia",
        "inertia": 0.1,
    }
    assert point.attrs["swept_value"] == 0.1
    _, *arguments = shlex.split(point.attrs["command"])
    arguments[-1] = str(tmp_path / "again.nc")
    subprocess.run([sys.executable, "-m", "roughgas", *arguments], check=True)
    again = read_point(tmp_path / "again.nc")
    assert again.R.item() == point.R.item()
    assert {name for name in point.attrs if again.attrs[name] != point.attrs[name]} == {"command"}


@pytest.mark.slow
def test_the_reduced_dataset_has_the_axis(ran):
    data = read_reduced(ran.folder / f"{SPUN}.nc")
    assert data.R.dims == ("inertia", "r", "beta") and list(data.inertia) == [0.1, 1.0]
    assert (data.n_seeds == 2).all() and data.attrs["swept"] == "spin.inertia"
    first = read_point(ran.folder / SPUN / "inertia1/r0.9/beta0/seed1.nc")
    assert data.R_seed.sel(inertia=1, r=0.9, beta=0, seed=1).item() == first.R.item()


@pytest.mark.slow
@pytest.mark.parametrize("labels", [("1", "0.1", "0.05"), ("0.05", "1", "0.1")])
def test_one_more_value_concerns_no_point_that_is_there(ran, tmp_path, labels):
    changed = ran.copy_to(tmp_path / "copy")
    changed.configure(sweep_inertia(*labels))
    assert changed.planned(f"{SPUN}.nc") == {"seeds": 1, "reduce": 1}


@pytest.mark.slow
def test_a_value_that_needs_another_kernel_is_compiled_before_it_is_run(project, tmp_path):
    changed = project.copy_to(tmp_path / "copy")
    target = "results/tiny/modelled.nc"
    changed.configure(
        lambda config: config["experiments"]["modelled"]["sweep"].update(
            {"contact_time.below_r": ["1", "0.95"]}
        )
    )
    changed.succeed("-j2", "--config", "scale=tiny", "--", target)
    assert list(read_reduced(changed.folder / target).below_r) == [0.95, 1]
    changed.configure(lambda config: config["experiments"].update(EXPERIMENTS))
    assert changed.planned(target)["compile_kernel"] == 1
