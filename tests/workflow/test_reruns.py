"""Snakemake runs those jobs again whose results an edit may change, and no others."""

import re

import pytest
from project import FINISHED, JOBS, Project, jobs_by_rule

from roughgas import config

EXPERIMENT_JOBS = JOBS // 6
AFTER_POINTS = {"claims": 1, "table": 1, "run_times": 1, "document": 2, "figures": 1}
CONFIGURED = {"effective_config": 1, "document": 1, "figures": 1}
AFTER_BOTH = AFTER_POINTS | CONFIGURED | {"document": 3}

FOLDERS = config.load("config.yaml").studies
STUDIED, OF_TASKS_ALONE = (
    {
        figure
        for study in FOLDERS.values()
        if not study.modules
        for figure, shows in study.figures.items()
        if (shows == ["tasks"]) == alone
    }
    for alone in (False, True)
)
WITHOUT_FIGURES = {name for name, study in FOLDERS.items() if not study.figures}
"""Studies without figure.py, whose experiments have the general figure."""
OF_STUDIES = STUDIED | WITHOUT_FIGURES | {"study_page", "study_slides", "plot"}
OF_STUDIES |= {"table_of_papers", "quoted_by_documentation"}
FIGURES = {"fig1a", "fig1b", "fig2a", "fig2b"}
TABLES = {"table", "table_of_extensions", "run_times"}
JUDGED = {"claims", "page_of_verdicts"}
REDUCED = FIGURES | OF_STUDIES | TABLES | JUDGED | {"reduce", "page", "document"}
POINTS = REDUCED | {"seeds", "point"}
COMPILED = POINTS | {"compile_kernel"}
FAMILIES = {"family", "catalogue", "document"}
FILM = {"clustering", "combine", "study_movie", "study_page"}
ACCURACY_FIGURES = {"accuracy", "accuracy_limits", "accuracy_waiting"}
ACCURACY = ACCURACY_FIGURES | {"combine", "claims", "document"}
COVERAGE = {"coverage", "combine", "document"}
OF_TASKS = {"combine", "profiles", "finite_size", "runaway", "exact"}
OF_DSMC = {"exact", "finite_size", "runaway", "megias_santos"}
OF_DSMC |= JUDGED | {"combine", "study_page"}
STUDIES = ACCURACY | COVERAGE | OF_TASKS
STUDIES |= {"statistical", "models", "discretisation", "waiting"}
SIMULATED = COMPILED | FAMILIES | FILM | STUDIES | {"movie"}
OF_NO_PLATEAU = {"clustering", "discretisation", "exact", "profiles", "study_movie"}
PAPER_FIGURE = "../../studies/paper/figure.py"
DRAWN_OF_TASKS = OF_TASKS_ALONE | {*ACCURACY_FIGURES, "coverage"}
EDITED = {  # file of the package: rules, figures and studies that rerun after an edit
    "statistics/steady_state.py": SIMULATED - OF_NO_PLATEAU,
    "theory/prediction.py": REDUCED | DRAWN_OF_TASKS | {"study_movie", "combine"},  # of exact
    "kernel/prediction.py": SIMULATED,
    "effects/walls.py": SIMULATED | {"effective_config", "living_page", "transport_inertia"},
    "scene/__init__.py": SIMULATED | {"effective_config", "living_page"},
    "config/forms.py": {"effective_config", "document", "living_page"},
    "results/tables.py": TABLES | {"document", "study_page"},
    "../../studies/paper/claims.yaml": FIGURES | JUDGED | {"document"},  # which it titles
    PAPER_FIGURE: FIGURES | JUDGED | {"document"},
    "show/page/explore.js": {"page"},
    "show/movies/__init__.py": {"movie"},
    "tasks/dsmc.py": ACCURACY | {"models", "transport", "transport_inertia"} | OF_DSMC,
    "cli/run.py": POINTS | FAMILIES,
}
COMMENT = "\n# added\n"
UNUSED = ("steps.py", "doctor.py", "library.py")


def finished_project(folder, *targets):
    """Return a project that Snakemake takes to be finished: its products exist, but are empty."""
    project = Project(folder)
    targets = ("--config", "scale=tiny", "--", *targets)
    for line in project.succeed("--summary", *targets).splitlines():
        if re.match(r"(results|figures)/\S+\t", line):
            path = project.folder / line.split("\t")[0]
            path.parent.mkdir(parents=True, exist_ok=True)
            path.touch()
    project.succeed("-j1", "--touch", "--forceall", *targets)
    return project


@pytest.fixture(scope="module")
def complete_project(tmp_path_factory):
    """A finished project with all targets, for slow tests: one worker runs them, in this file."""
    return finished_project(tmp_path_factory.mktemp("made"), *FINISHED)


@pytest.fixture(scope="module")
def paper_project(tmp_path_factory):
    """A finished project with the figures of the paper alone."""
    return finished_project(tmp_path_factory.mktemp("drawn"), "figures")


@pytest.fixture
def finished(paper_project, tmp_path):
    """A copy of `paper_project` that a test may change."""
    return paper_project.copy_to(tmp_path / "copy")


@pytest.mark.slow
def test_an_edit_of_a_file_of_radii_reruns_its_points(tmp_path):
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


@pytest.mark.slow
def test_only_contents_of_used_files_count(finished):
    for path in finished.folder.rglob("src/**/*.py"):
        path.touch()
    (finished.folder / "config.yaml").touch()
    for file in UNUSED:
        finished.append(f"src/roughgas/{file}")
    assert finished.planned() == {}


def rerun(project, edit):
    """Return the names of jobs that run again after lines are added to files of the package.

    Figures and studies have their names, other jobs those of their rules. The files are restored.
    """
    before = {project.folder / "src/roughgas" / file: line for file, line in edit.items()}
    before = {path: (path.read_bytes(), line) for path, line in before.items()}
    for path, (content, line) in before.items():
        path.write_bytes(content + line.encode())
    try:
        output = project.succeed("-n", "--config", "scale=tiny", "--", *FINISHED)
    finally:
        for path, (content, _) in before.items():
            path.write_bytes(content)
    if "Nothing to be done" in output:
        return set()
    named = re.findall(r"Job \d+: (?:draw tiny/|study (?:accuracy/)?)(\w+)", output)
    targets = {"figure", "task", *FINISHED}
    return {*jobs_by_rule(output), *named} - targets


@pytest.mark.slow
def test_an_edit_of_the_kernel_reruns_every_point_and_figure(finished):
    finished.append("src/roughgas/kernel/prediction.py")
    jobs = {"compile_kernel": 6, "seeds": JOBS, "reduce": 6, "figure": 4}
    assert finished.planned() == jobs | AFTER_POINTS


@pytest.mark.slow
@pytest.mark.parametrize("file", EDITED)
def test_an_edit_reruns_the_products_of_its_file(complete_project, file):
    assert rerun(complete_project, {file: COMMENT}) == EDITED[file]


@pytest.mark.slow
def test_an_edited_experiment_and_added_seeds_run_and_no_others(finished):
    """Two seeds more are a job, and one more a point."""

    def change(config):
        config["experiments"]["sheared"]["effects"]["shear"].update(velocity=3)
        config["seeds_per_job"] = 2  # so that the two finished seeds fill a job
        config["scales"]["tiny"]["cooling"]["sweep"].update(seeds=5)

    finished.configure(change)
    jobs = {"seeds": EXPERIMENT_JOBS + 1, "point": 1, "reduce": 2, "figure": 2}
    assert finished.planned() == jobs | AFTER_BOTH


@pytest.mark.slow
def test_which_job_has_made_a_point_does_not_matter(finished):
    def change(config):
        config.update(seeds_per_job=1, betas_per_job=25)
        config["experiments"]["sheared"]["betas_per_job"] = 1

    finished.configure(change)
    assert finished.planned() == CONFIGURED


@pytest.mark.slow  # compiles a kernel
def test_an_edit_is_not_forgotten_when_a_run_is_interrupted(finished):
    """The run makes the compiled kernel again, but not yet the points."""
    finished.append("src/roughgas/statistics/steady_state.py")
    finished.succeed("-j1", "results/tiny/cooling/r0.9/compiled.txt")
    assert finished.planned("results/tiny/cooling.nc") == {"seeds": EXPERIMENT_JOBS, "reduce": 1}


@pytest.mark.slow
def test_an_edited_combination_reruns_no_task_and_edited_settings_rerun_theirs(
    complete_project, tmp_path
):
    """The tasks of `runaway`, which has no movie, do not run again."""
    finished = complete_project.copy_to(tmp_path / "copy")
    finished.append("studies/runaway/results.py")
    finished.configure(lambda config: config["scales"]["tiny"]["clustering.tasks"].update(seed=2))
    jobs = {"combine": 2, "figure": 2, "study_page": 2, "runaway": 1, "clustering": 1}
    expected = jobs | {"claims": 1, "task": 1, "study_movie": 1}
    assert finished.planned("runaway", "clustering") == expected
