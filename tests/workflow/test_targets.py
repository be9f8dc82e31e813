"""What can be asked for, and how the rest is refused."""

import pytest
from project import BEYOND, JOBS, Project

ILLEGAL = {
    ("results/paper/cooling/r1.5/beta0/seed1.nc",): "restitution r = 1.5: must lie in [0, 1]",
    ("results/paper/heating/r0.9/beta0/seed1.nc",): "experiment = 'heating': must be one of clu",
    ("figures/fig9.png",): "figure = 'fig9': must be a figure or an experiment, such as fig2b, fi",
    ("figures/movies/flow.gif",): "movie = flow: must be one of vibrated, ",
    ("--config", "n_particles=5"): "key = 'n_particles': must be one of accuracy, betas_per_job,",
}

QUICK = (("figures/fig9.png",), ("--config", "n_particles=5"))
"""The others are refused in the same way, and are slow."""


def refusal(project, *arguments):
    """The one line in which Snakemake refuses."""
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


def test_a_job_makes_several_seeds_and_betas_and_what_fills_none_is_a_point(tmp_path):
    """Of cooling five seeds, of sheared three values of beta, and one that is not swept; both r of
    the latter run the same kernel."""
    project = Project(tmp_path)

    def change(config):
        config.update(seeds_per_job=2, betas_per_job=1)
        config["experiments"]["sheared"]["betas_per_job"] = 2  # which counts more
        tiny = config["scales"]["tiny"]
        tiny["cooling"]["sweep"].update(seeds=5)
        tiny["sheared"]["sweep"] |= {"r": ["0.9", "0.8"], "beta": ["-0.5", "0", "0.5"]}

    project.configure(change)
    paths = "cooling.nc", "sheared.nc", "sheared/r0.8/beta0.1/seed1.nc"
    planned = project.planned(*(f"results/tiny/{path}" for path in paths))
    assert planned == {"compile_kernel": 2, "seeds": 2 + 2 * 2, "point": 1 + 1, "reduce": 2}


@pytest.mark.slow
def test_everything_has_films_and_the_experiments_that_were_added(tmp_path):
    project = Project(tmp_path)
    project.configure(
        lambda config: config["experiments"].update(
            wide={"extends": "cooling", "box": [200, 50], "sweep": {"seeds": 1}}
        )
    )
    planned = project.planned("everything")
    found = {rule: planned[rule] for rule in ("seeds", "point", "study_movie", "movie")}
    one_by_one = 1 + 7  # `wide`, and the cases of patterns, have one seed
    seeds = JOBS + len(BEYOND) - 1
    assert found == {"seeds": seeds, "point": one_by_one, "study_movie": 1, "movie": 9}


@pytest.mark.slow
def test_what_a_clone_brings_along_is_made_anew(tmp_path):
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
    assert planned["figure"] == 2 and planned["plot"] == 2 and planned["study_figure"] == 1
    status, output = project.snakemake("-n", "--", "figg2a")
    assert status == 1 and "target = 'figg2a': must be a path of a file, or a name" in output
    assert "such as fig2a, " in output


@pytest.mark.parametrize(
    "arguments",
    [pytest.param(one, marks=[pytest.mark.slow] * (one not in QUICK)) for one in ILLEGAL],
)
def test_what_is_illegal_is_refused_in_one_line(project, arguments):
    assert ILLEGAL[arguments] in refusal(project, *arguments)


def test_a_mistake_in_the_configuration_is_refused(tmp_path):
    project = Project(tmp_path)
    project.configure(lambda config: config["experiments"]["cooling"].update(particles=100_000))
    line = refusal(project, "results/paper/cooling.nc")
    assert line.startswith("roughgas: error: config.yaml: ")
    assert "experiments.cooling at scale paper: particles = 100000: must" in line
