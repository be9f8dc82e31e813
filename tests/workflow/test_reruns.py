"""What an edit makes Snakemake run again: what it may change, and nothing else."""

import re

import pytest
from project import FINISHED, JOBS, Project, jobs_by_rule

from roughgas import config

EACH = JOBS // 6
AFTER_POINTS = {"claims": 1, "table": 1, "run_times": 1, "document": 2, "figures": 1}
CONFIGURED = {"effective_config": 1, "document": 1, "figures": 1}
AFTER_BOTH = AFTER_POINTS | CONFIGURED | {"document": 3}

FOLDERS = config.load("config.yaml")["folders"]
STUDIED, OF_TASKS_ALONE = (
    {
        figure
        for one in FOLDERS.values()
        for figure, shows in one["figures"].items()
        if (shows == ["tasks"]) == alone
    }
    for alone in (False, True)
)
OF_STUDIES = STUDIED | {"study_table", "study_claims", "study_page", "study_slides"}
FIGURES = {"fig1a", "fig1b", "fig2a", "fig2b"}
REDUCED = FIGURES | OF_STUDIES | {"reduce", "table", "claims", "run_times", "page", "document"}
POINTS = REDUCED | {"seeds", "point"}
COMPILED = POINTS | {"compile_kernel"}
FAMILIES = {"family", "catalogue", "document"}
FILM = {"clustering", "study_data", "study_movie", "study_page"}
ACCURACY = {"accuracy", "accuracy_limits", "accuracy_data", "accuracy_table", "document"}
COVERAGE = {"coverage", "accuracy_data", "accuracy_table", "document"}
OF_TASKS = {"study_data", "profiles", "finite_size", "runaway", "exact"}
OF_DSMC = {"exact", "finite_size", "runaway", "study_data", "study_claims", "study_page"}
STUDIES = ACCURACY | COVERAGE | OF_TASKS | {"statistical", "models", "discretisation"}
SIMULATED = COMPILED | FAMILIES | FILM | STUDIES | {"movie"}
OF_NO_PLATEAU = {"clustering", "discretisation", "exact", "profiles", "study_movie"}
EDITED = {  # file of the package: what an edit of its code runs again
    "statistics/steady_state.py": SIMULATED - OF_NO_PLATEAU,
    "theory/prediction.py": REDUCED | OF_TASKS_ALONE | {"study_movie", "study_data"},  # of exact
    "kernel/prediction.py": SIMULATED,
    "effects/walls.py": SIMULATED | {"effective_config", "living_page"},
    "scene/__init__.py": SIMULATED | {"living_page"},
    "config/schema.py": {"effective_config", "document", "living_page"},
    "results/products.py": {"table", "run_times", "document", "study_table", "study_page"},
    "claims/paper.yaml": {"claims", "document", "study_claims", "study_page"},
    "show/figures/paper.py": FIGURES,
    "show/page/explore.js": {"page"},
    "show/movies/__init__.py": {"movie"},
    "tasks/dsmc.py": ACCURACY | {"models"} | OF_DSMC,
    "cli/run.py": POINTS | FAMILIES,
}
TOGETHER = ("config/schema.py", "results/products.py", "show/figures/paper.py", "tasks/dsmc.py")
UNUSED = ("steps.py", "doctor.py", "library.py")


def project_made(folder, *targets):
    """A project that Snakemake takes to be finished: its products are there, though empty."""
    made = Project(folder)
    targets = ("--config", "scale=tiny", "--", *targets)
    for line in made.succeed("--summary", *targets).splitlines():
        if re.match(r"(results|figures)/\S+\t", line):
            path = made.folder / line.split("\t")[0]
            path.parent.mkdir(parents=True, exist_ok=True)
            path.touch()
    made.succeed("-j1", "--touch", "--forceall", *targets)
    return made


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """All of it, which takes long: its tests are slow, and in this file, which one worker runs."""
    return project_made(tmp_path_factory.mktemp("made"), *FINISHED)


@pytest.fixture(scope="module")
def drawn(tmp_path_factory):
    """The figures of the paper alone."""
    return project_made(tmp_path_factory.mktemp("drawn"), "figures")


@pytest.fixture
def finished(drawn, tmp_path):
    """A copy of `drawn` that a test may change."""
    return drawn.copy_to(tmp_path / "copy")


@pytest.mark.slow
def test_an_edit_of_a_file_of_radii(tmp_path):
    """Its points run again, and no others."""
    project = Project(tmp_path)
    radii = {"name": "disks", "radius": {"distribution": "file", "file": "radii.txt"}}
    listed = {"extends": "cooling", "species": [radii | {"fraction": 1}], "particles": 10}
    project.configure(
        lambda config: config["experiments"].update(listed=listed | {"box": [20, 20]})
    )
    points = [f"results/paper/{name}/r0.9/beta0/seed1.nc" for name in ("listed", "cooling")]
    project.append("radii.txt", "1\n" * 10)
    for path in points:
        (tmp_path / path).parent.mkdir(parents=True)
        (tmp_path / path).touch()
    project.succeed("-j1", "--touch", "--forceall", "--", *points)
    (tmp_path / "radii.txt").touch()
    assert "Nothing to be done" in project.succeed("-n", "--", *points)
    project.append("radii.txt", "1.5\n" * 10)
    assert jobs_by_rule(project.succeed("-n", "--", *points)) == {"compile_kernel": 1, "seeds": 1}


def test_only_contents_count_and_only_of_what_is_used(finished):
    for path in finished.folder.rglob("src/**/*.py"):
        path.touch()
    (finished.folder / "config.yaml").touch()
    for file in UNUSED:
        finished.append(f"src/roughgas/{file}")
    assert finished.planned() == {}


def rerun(made, edit):
    """What runs again after lines are added to files of the package: figures and studies by their
    names, jobs else by their rules. The files are then restored."""
    before = {made.folder / "src/roughgas" / file: line for file, line in edit.items()}
    before = {path: (path.read_bytes(), line) for path, line in before.items()}
    for path, (content, line) in before.items():
        path.write_bytes(content + line.encode())
    try:
        output = made.succeed("-n", "--config", "scale=tiny", "--", *FINISHED)
    finally:
        for path, (content, _) in before.items():
            path.write_bytes(content)
    if "Nothing to be done" in output:
        return set()
    named = re.findall(r"Job \d+: (?:draw tiny/|study )(\w+)", output)
    drawn = {"figure", "study_figure", "accuracy_figure"}
    targets = {*drawn, "accuracy_task", "study_task", *FINISHED}
    return {*jobs_by_rule(output), *named} - targets


def test_an_edit_of_the_kernel_makes_every_point_and_figure_anew(finished):
    finished.append("src/roughgas/kernel/prediction.py")
    made_again = {"compile_kernel": 6, "seeds": JOBS, "reduce": 6, "figure": 4}
    assert finished.planned() == made_again | AFTER_POINTS


@pytest.mark.slow
@pytest.mark.parametrize("file", EDITED)
def test_what_an_edit_in_each_room_runs_again(made, file):
    assert rerun(made, {file: "\nADDED = 1\n"}) == EDITED[file]


@pytest.mark.slow
def test_what_edits_in_several_rooms_run_again(made):
    expected = set().union(*(EDITED[file] for file in TOGETHER))
    assert rerun(made, dict.fromkeys(TOGETHER, "\nADDED = 1\n")) == expected


def test_an_edit_of_one_experiment_and_more_seeds_of_another(finished):
    """Two seeds more are a job, and one more a point."""

    def change(config):
        config["experiments"]["sheared"]["effects"]["shear"].update(velocity=3)
        config["seeds_per_job"] = 2  # so that the two that are there are a whole job
        config["scales"]["tiny"]["cooling"]["sweep"].update(seeds=5)

    finished.configure(change)
    again = {"seeds": EACH + 1, "point": 1, "reduce": 2, "figure": 2}
    assert finished.planned() == again | AFTER_BOTH


def test_which_job_has_made_a_point_does_not_matter(finished):
    def change(config):
        config.update(seeds_per_job=1, betas_per_job=25)
        config["experiments"]["sheared"]["betas_per_job"] = 1

    finished.configure(change)
    assert finished.planned() == CONFIGURED


@pytest.mark.slow  # compiles a kernel
def test_an_edit_is_not_forgotten_when_a_run_is_interrupted(finished):
    """What stands between the sources and the points is made again, the points are not yet."""
    finished.append("src/roughgas/statistics/steady_state.py")
    finished.succeed("-j1", "results/tiny/cooling/r0.9/compiled.txt")
    assert finished.planned("results/tiny/cooling.nc") == {"seeds": EACH, "reduce": 1}


@pytest.mark.slow
def test_an_edit_of_what_combines_the_tasks_of_a_study_and_of_the_settings_of_others(
    made, tmp_path
):
    """The tasks of the first, which has no movie, do not run again."""
    finished = made.copy_to(tmp_path / "copy")
    finished.append("studies/runaway/results.py")
    finished.configure(lambda config: config["scales"]["tiny"]["clustering.tasks"].update(seed=2))
    each = {"study_data": 2, "study_figure": 2, "study_page": 2, "runaway": 1, "clustering": 1}
    expected = each | {"study_claims": 1, "study_task": 1, "study_movie": 1}
    assert finished.planned("runaway", "clustering") == expected
