"""A sweep with a third axis, through the whole workflow."""

import pytest
from project import Project
from slow_cases import slow_but

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
    "results/tiny/vibrated_rough_walls/r0.001/beta0.5/seed1.nc",
    "results/paper/vibrated_particle_walls/r0.9/beta0/seed1.nc",
    "results/paper/vibrated_smooth_walls/r0/beta0/seed1.nc",
    f"{SPUN}/inertia0.33/r0.87/beta-0.2/seed7.nc",
    "results/paper/spun/inertia0.001/r0.5/beta1/seed1.nc",
    "results/small/walled/roughnessparticles/r0.9/beta0/seed1.nc",
    "results/paper/walled/roughness-0.5/r0.9/beta0/seed1.nc",
]
POINT = "results/paper/cooling/r0.9/beta-0.33/seed1.nc"
RESPELLED = {
    "results/paper/cooling/r0.90/beta-.33/seed1.nc": POINT,
    "results/paper/cooling/r9e-1/beta-0.33/seed01.nc": POINT,
    "results/paper/cooling/r0.90/compiled.txt": "results/paper/cooling/r0.9/compiled.txt",
    "results/paper/spun/inertia.30/r1.0/beta-0.0/seed1.nc": (
        "results/paper/spun/inertia0.3/r1/beta0/seed1.nc"
    ),
}
"""Paths with other spellings of numbers, each with the path that results use."""


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """A project without results, with experiments that have a third axis."""
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


@pytest.mark.slow
def test_any_legal_point_is_a_target(project):
    assert project.planned(*LEGAL) == {"compile_kernel": len(LEGAL), "point": len(LEGAL)}


@pytest.mark.parametrize(
    "path",
    slow_but([*RESPELLED][:2], RESPELLED),
)
def test_a_path_with_another_spelling_is_refused_with_the_legal_one(project, path):
    status, output = project.snakemake("-n", "--", path)
    assert status == 1 and "Traceback" not in output
    assert f"roughgas: error: path = {path}: must be {RESPELLED[path]}: a number has" in output


@pytest.mark.slow
def test_numbers_of_a_sweep_get_the_same_paths_however_they_are_written(project, tmp_path):
    changed = project.copy_to(tmp_path / "copy")

    def change(config):
        sweep = config["experiments"]["spun"]["sweep"]
        sweep |= {"r": [".90", 1.0], "beta": ["-.5", "+5e-1", -0.0], "seeds": 1}
        sweep["spin.inertia"] = ["1.00", "1e-1"]

    changed.configure(change)
    paths = [
        f"{SPUN}/inertia{q}/r{r}/beta{beta}/seed1.nc"
        for q in ("1", "0.1")
        for r in ("0.9", "1")
        for beta in ("-0.5", "0.5", "0")
    ]
    assert changed.planned(*paths) == {"compile_kernel": 1, "seeds": 2}  # none outside the sweep


@pytest.mark.slow
@pytest.mark.parametrize("labels", [("1", "0.1", "0.05"), ("0.05", "1", "0.1")])
def test_an_added_value_reruns_no_finished_point(ran, tmp_path, labels):
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
