"""A sweep with a third axis, through the whole workflow."""

import pytest
from project import Project

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
    "results/paper/cooling/r0.87/beta-0.33/seed7.nc",
    "results/paper/vibrated/r1/beta1/seed0.nc",
    "results/small/sheared/r0.5/beta-1/seed123.nc",
    "results/tiny/vibrated_rough_walls/r1e-3/beta.5/seed1.nc",
    "results/paper/vibrated_particle_walls/r0.90/beta0.0/seed1.nc",
    "results/paper/vibrated_smooth_walls/r0/beta0/seed1.nc",
    f"{SPUN}/inertia0.33/r0.87/beta-0.2/seed7.nc",
    "results/paper/spun/inertia1e-3/r0.5/beta1/seed1.nc",
    "results/small/walled/roughnessparticles/r0.9/beta0/seed1.nc",
    "results/paper/walled/roughness-.5/r0.9/beta0/seed1.nc",
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
    ran = project.copy_to(tmp_path_factory.mktemp("runs") / "ran")
    ran.succeed("-j2", "--config", "scale=tiny", "--", f"{SPUN}.nc")
    return ran


def sweep_inertia(*labels):
    return lambda config: config["experiments"]["spun"]["sweep"].update({"spin.inertia": labels})


def test_any_legal_point_can_be_asked_for(project):
    assert project.planned(*LEGAL) == {"compile_kernel": len(LEGAL), "point": len(LEGAL)}


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
