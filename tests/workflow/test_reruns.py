"""What an edit makes Snakemake run again: what it may change, and nothing else."""

import subprocess
import sys

import pytest
from project import JOBS

EACH = JOBS // 6
AFTER_POINTS = {"claims": 1, "table": 1, "run_times": 1, "document": 2, "figures": 1}
CONFIGURED = {"effective_config": 1, "document": 1, "figures": 1}
AFTER_BOTH = AFTER_POINTS | CONFIGURED | {"document": 3}
ALL = {"compile_kernel": 6, "seeds": JOBS, "reduce": 6, "figure": 4} | AFTER_POINTS


def test_nothing_is_run_twice(made):
    assert made.planned() == {}


def test_only_contents_count(finished):
    for path in finished.folder.rglob("src/**/*.py"):
        path.touch()
    (finished.folder / "config.yaml").touch()
    assert finished.planned() == {}


@pytest.mark.parametrize(
    ("module", "expected"),
    [
        ("kernel/pairs.py", ALL),
        ("theory/relaxation.py", ALL),
        ("cli/run.py", ALL),
        ("results/reduce.py", {"reduce": 6, "figure": 4} | AFTER_POINTS),
        ("results/table.py", {"table": 1, "figures": 1}),
        ("show/style.py", {"figure": 4, "figures": 1}),
        ("claims/report.py", {"claims": 1, "document": 1, "figures": 1}),
        ("show/page/document.py", {"document": 3, "figures": 1}),
        ("config/__init__.py", CONFIGURED),
    ],
)
def test_an_edit_in_the_package(finished, module, expected):
    finished.append(f"src/roughgas/{module}")
    assert finished.planned() == expected


def test_a_new_module_of_the_kernel(finished):
    (finished.folder / "src/roughgas/kernel/added.py").write_text("")
    assert finished.planned() == ALL


def test_an_edit_of_one_experiment(finished):
    finished.configure(
        lambda config: config["experiments"]["sheared"]["effects"]["shear"].update(velocity=3)
    )
    expected = {"compile_kernel": 1, "seeds": EACH, "reduce": 1, "figure": 1} | AFTER_BOTH
    assert finished.planned() == expected


@pytest.mark.parametrize(("wanted", "jobs"), [(3, {"point": 1}), (4, {"seeds": 1})])
def test_more_seeds_are_added_to_those_that_are_there(finished, wanted, jobs):
    def change(config):
        config["seeds_per_job"] = 2  # so that the two that are there are a whole job
        config["scales"]["tiny"]["cooling"]["sweep"].update(seeds=wanted)

    finished.configure(change)
    assert finished.planned() == jobs | {"reduce": 1, "figure": 1} | AFTER_BOTH


@pytest.mark.parametrize("batch", [{"seeds_per_job": 1}, {"betas_per_job": 25}])
def test_which_job_has_made_a_point_does_not_matter(finished, batch):
    finished.configure(lambda config: config.update(batch))
    assert finished.planned() == CONFIGURED


def test_a_description_concerns_no_point(finished):
    finished.configure(
        lambda config: config["experiments"]["cooling"].update(description="colder and colder")
    )
    assert finished.planned() == CONFIGURED


def test_an_edit_is_not_forgotten_when_a_run_is_interrupted(finished):
    """What stands between the sources and the points is made again, the points are not yet."""
    finished.append("src/roughgas/statistics/plateau.py")
    finished.succeed("-j1", "results/tiny/cooling/r0.9/compiled.txt")
    assert finished.planned("results/tiny/cooling.nc") == {"seeds": EACH, "reduce": 1}


def test_an_edit_counts_where_what_was_compiled_has_been_deleted(finished):
    (finished.folder / "results/tiny/cooling/r0.9/compiled.txt").unlink()
    assert finished.planned() == {}
    finished.append("src/roughgas/statistics/plateau.py")
    assert finished.planned("results/tiny/cooling.nc")["seeds"] == EACH


def test_every_module_that_a_point_imports_counts(made):
    """Found out by importing, where the rules find out by reading the sources."""
    target = "results/tiny/vibrated/r0.9/compiled.txt"
    summary = made.succeed("--config", "scale=tiny", "--detailed-summary", "--", target)
    (row,) = (line for line in summary.splitlines() if line.startswith(target))
    script = "import sys, roughgas.simulation.point, roughgas.data.point; print(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    modules = {name for name in done.stdout.split() if name.startswith("roughgas.")}
    assert len(modules) > 10
    for name in modules:
        path = "src/" + name.replace(".", "/")
        assert f"{path}.py" in row or f"{path}/__init__.py" in row, name


def test_a_reduced_dataset_does_not_depend_on_the_kernel(made):
    target = "results/tiny/cooling.nc"
    summary = made.succeed("--config", "scale=tiny", "--detailed-summary", "--", target)
    (row,) = (line for line in summary.splitlines() if line.startswith(target))
    assert "src/roughgas/theory/closed_forms.py" in row  # imported inside a function
    assert "src/roughgas/kernel/" not in row


def test_an_edit_of_a_family_of_hard_cases_concerns_it_alone(finished):
    assert finished.planned("hard_cases") == {}
    finished.append("tests/hard_cases/test_ties.py")
    expected = {"family": 1, "catalogue": 1, "document": 1, "hard_cases": 1}
    assert finished.planned("hard_cases") == expected
