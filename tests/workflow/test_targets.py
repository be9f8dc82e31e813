"""Legal targets of Snakemake, and refusals of illegal ones."""

import pytest
from project import BEYOND, JOBS, Project

ILLEGAL = {
    ("figures/fig9.png",): "figure = 'fig9': must be a figure or an experiment, such as fig2b, fi",
    ("figures/movies/flow.gif",): "movie = flow: must be one of vibrated, ",
    ("--config", "n_particles=5"): "key = 'n_particles': must be one of accuracy, betas_per_job,",
}

QUICK = (("figures/fig9.png",), ("--config", "n_particles=5"))
"""Fast cases; all others are refused by the same code, and are slow."""


def refusal(project, *arguments):
    """Return the single error line of a refusal by Snakemake."""
    before = project.files()
    status, output = project.snakemake("-j1", *arguments)
    assert status != 0
    assert "Traceback" not in output
    assert project.files() == before
    (line,) = (line for line in output.splitlines() if "error" in line.lower())
    return line


def test_the_default_are_the_figures_which_need_every_point_of_the_sweep_once(project):
    assert project.planned() == {
        "compile_kernel": 6,
        "seeds": JOBS,
        "reduce": 6,
        "figure": 4,
        "table": 1,
        "claims": 1,
        "run_times": 1,
        "effective_config": 1,
        "document": 3,
        "figures": 1,
    }


@pytest.mark.slow
def test_a_job_makes_several_points_and_leftover_points_are_single_jobs(tmp_path):
    """Five seeds of cooling; of sheared three values of beta and one outside its sweep. Both r of
    sheared, of a second together, run the same kernel in the same job."""
    project = Project(tmp_path)

    def change(config):
        config.update(seeds_per_job=2, betas_per_job=1)
        config["experiments"]["sheared"]["betas_per_job"] = 2  # overrides the global setting
        tiny = config["scales"]["tiny"]
        tiny["cooling"]["sweep"].update(seeds=5)
        tiny["sheared"]["sweep"] |= {"r": ["0.9", "0.8"], "beta": ["-0.5", "0", "0.5"]}

    project.configure(change)
    paths = "cooling.nc", "sheared.nc", "sheared/r0.8/beta0.1/seed1.nc"
    planned = project.planned(*(f"results/tiny/{path}" for path in paths))
    assert planned == {"compile_kernel": 2, "seeds": 2 + 2, "point": 1 + 1, "reduce": 2}


@pytest.mark.slow
def test_everything_has_films_and_added_experiments(tmp_path):
    project = Project(tmp_path)
    project.configure(
        lambda config: config["experiments"].update(
            wide={"extends": "cooling", "box": [200, 50], "sweep": {"seeds": 1}}
        )
    )
    planned = project.planned("everything")
    jobs = {rule: planned[rule] for rule in ("seeds", "point", "study_movie", "movie")}
    single_points = 1 + 7 + 2  # `wide`, and the cases of patterns, have one seed
    seeds = JOBS + len(BEYOND) - 2
    assert jobs == {"seeds": seeds, "point": single_points, "study_movie": 1, "movie": 9}


@pytest.mark.slow
def test_products_that_a_clone_brings_along_are_made_again(tmp_path):
    project = Project(tmp_path)
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs/results.md").touch()
    (tmp_path / "figures/tiny").mkdir(parents=True)
    for product in ("evidence.csv", "numbers.json"):
        (tmp_path / "figures/tiny" / product).write_text("of another machine")
    planned = project.planned("evidence", "numbers")
    assert planned["quoted_by_documentation"] == 2
    assert planned["reduce"] > 0


def test_figures_and_experiments_are_targets_by_their_names(project):
    planned = project.planned("fig1b", "fig2a", "waves", "waves.waves", "vibrated")
    assert planned["figure"] == 3 and planned["plot"] == 2
    status, output = project.snakemake("-n", "--", "figg2a")
    assert status == 1 and "target = 'figg2a': must be a path of a file, or a name" in output
    assert "such as fig2a, " in output


@pytest.mark.parametrize(
    "arguments",
    [pytest.param(target, marks=[pytest.mark.slow] * (target not in QUICK)) for target in ILLEGAL],
)
def test_illegal_targets_are_refused_in_one_line(project, arguments):
    assert ILLEGAL[arguments] in refusal(project, *arguments)


def test_a_mistake_in_the_configuration_is_refused(tmp_path):
    project = Project(tmp_path)
    project.configure(lambda config: config["experiments"]["cooling"].update(particles=100_000))
    line = refusal(project, "results/paper/cooling.nc")
    assert line.startswith("roughgas: error: config.yaml: ")
    assert "experiments.cooling at scale paper: particles = 100000: must" in line
