"""Jobs of a study with effects and observables: what they run, and when they run again."""

import shlex
import subprocess
import sys

import pytest
import snakemakes
import xarray as xr
from project import Project, jobs_by_rule
from study_code import CONFIG, EFFECTS, OBSERVABLES, add_study, study_in_present_folder

from roughgas import config
from roughgas.config import study_code
from roughgas.tasks.running import run_task
from roughgas.workflow.studies import Studies
from roughgas.workflow.sweeps import Sweeps
from roughgas.workflow.tasks import Tasks

EXPERIMENTS = ("mine.plain", "mine.observed", "mine.metal/yield_speed0.5", "cooling")


@pytest.fixture
def study(tmp_path, monkeypatch):
    """The folder of a study in the present folder."""
    yield from study_in_present_folder(tmp_path, monkeypatch)


def codes():
    """The fingerprints of the code of points, by experiment, as a new process finds them."""
    sweeps = Sweeps(config.load("config.yaml"), [])
    return {name: sweeps.point_code("paper", name) for name in EXPERIMENTS}


@pytest.mark.parametrize(
    ("file", "changed"),
    [
        ("effects", {"mine.metal/yield_speed0.5"}),
        ("observables", {"mine.observed"}),
        ("judges", set()),
    ],
)
def test_an_edit_changes_the_code_of_points_that_use_the_file(study, file, changed):
    path, before = study / f"{file}.py", codes()
    text = path.read_text() if path.exists() else ""
    path.write_text(text + "\nADDED = 1\n")
    after = codes()
    assert {name for name in EXPERIMENTS if after[name] != before[name]} == changed
    path.write_text(text)
    assert codes() == before


def test_jobs_get_the_folders_whose_code_they_need(study):
    sweeps = Sweeps(config.load("config.yaml"), [])
    options = {name: sweeps.study_options("paper", name) for name in EXPERIMENTS}
    needed = ["--studies", "studies/mine"]
    assert options == dict(zip(EXPERIMENTS, ([], needed, needed, []), strict=True))


def test_kernels_depend_on_the_sources_of_effects(study):
    def kinds():
        sweeps = Sweeps(config.load("config.yaml"), [])
        assert sweeps.minutes(1, 1, "paper", "mine.metal", "0.8") > 0
        return sweeps.kernel_kinds("paper", "mine.metal", "0.8")

    before = kinds()
    (study / "effects.py").write_text(EFFECTS + "\nADDED = 1\n")
    assert kinds() != before


TASKS = """
from roughgas.tasks import dataset, read_variables


def tasks(settings):
    return ["speed"]


def run(task, settings, experiments, progress):
    progress(1, 1)
    faster = experiments["metal"].changed({"effects": {"plasticity": {"yield_speed": 2.5}}})
    variables = read_variables(__file__.replace("tasks.py", "variables.yaml"))
    return dataset(variables, {"speed": faster.effects["plasticity"].yield_speed})
"""
COMBINING = "def combine(results, settings): ...\n\n\ndef table(data): ...\n"


def test_tasks_run_experiments_with_effects_of_the_study(study, tmp_path):
    configured = CONFIG + "tasks: {experiments: [metal], length: 1}\n"
    files = {"config.yaml": configured, "tasks.py": TASKS, "results.py": COMBINING}
    files["variables.yaml"] = '"":\n  speed / a/T: yield speed\n'
    for name, text in files.items():
        (study / name).write_text(text)

    def tasks():
        configuration = config.load("config.yaml")
        assert not configuration.refused
        return Tasks(Studies(configuration, Sweeps(configuration, [])))

    first = tasks()
    assert first.study_options("mine/tasks") == ["--studies", "studies/mine"]
    settings = first.settings("paper", "mine/tasks", "speed")
    study_code.use(())
    run_task("studies/mine", "speed", settings=settings, studies=["studies/mine"], output="data.nc")
    with xr.open_dataset("data.nc") as data:
        assert data.speed == 2.5
    code = first.code("paper", "mine/tasks", "speed")
    (study / "observables.py").write_text(OBSERVABLES + "\nADDED = 1\n")
    assert tasks().code("paper", "mine/tasks", "speed") == code
    (study / "effects.py").write_text(EFFECTS + "\nADDED = 1\n")
    assert tasks().code("paper", "mine/tasks", "speed") != code


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A project whose study has points, figures and a reduced dataset."""
    project = Project(tmp_path_factory.mktemp("project"))
    add_study(folder=project.folder)
    project.succeed("-j1", "--", *TARGETS)
    return project


TARGETS = [
    *("figures/mine.observed.png", "figures/mine.metal.png", "figures/mine.plain.png"),
    "results/paper/mine.metal/yield_speed0.25/r0.8/beta0/seed7.nc",
]


@pytest.mark.slow  # compiles two kernels
def test_the_workflow_makes_points_and_figures_and_reruns_those_of_an_edited_file(made):
    with xr.open_dataset(made.folder / "results/paper/mine.observed.nc") as data:
        assert (data.fast_stderr > 0.0).all() and data.squares.dims == ("r", "beta", "side")
    with xr.open_dataset(made.folder / "results/paper/mine.metal.nc") as data:
        assert data.yield_speed.values.tolist() == [0.5, 1.0]
    assert "Nothing to be done" in made.succeed("-n", "--", *TARGETS)
    jobs = {
        "observables": {"seeds": 1, "reduce": 1, "plot": 1},
        "effects": {"compile_kernel": 1, "seeds": 2, "point": 1, "reduce": 1, "plot": 1},
    }
    for file, expected in jobs.items():
        path = made.folder / f"studies/mine/{file}.py"
        text = path.read_text()
        path.write_text(text + "\nADDED = 1\n")
        assert jobs_by_rule(made.succeed("-n", "--", *TARGETS)) == expected
        path.write_text(text)


@pytest.mark.slow
def test_another_folder_runs_the_study_of_the_project(made, tmp_path):
    """The command that a point has makes the same point again."""
    point = "results/paper/mine.metal/yield_speed1/r0.8/beta0/seed1.nc"
    arguments = ["-j1", "-s", made.folder / "Snakefile", "--", point]
    status, output = snakemakes.run(tmp_path, made.environment(), arguments)
    assert status == 0, output
    with xr.open_dataset(tmp_path / point) as data, xr.open_dataset(made.folder / point) as same:
        xr.testing.assert_equal(data.drop_vars("kernel_seconds"), same.drop_vars("kernel_seconds"))
        assert f"--studies {made.folder}/studies/mine" in data.attrs["command"]
        command = shlex.split(same.attrs["command"])
    command = [sys.executable, "-m", *command[:-1], str(tmp_path / "again.nc")]
    subprocess.run(command, cwd=made.folder, env=made.environment(), check=True)
    with (
        xr.open_dataset(tmp_path / "again.nc") as data,
        xr.open_dataset(made.folder / point) as same,
    ):
        xr.testing.assert_equal(data.drop_vars("kernel_seconds"), same.drop_vars("kernel_seconds"))


@pytest.mark.slow
def test_a_broken_file_stops_its_study_alone(made):
    path = made.folder / "studies/mine/effects.py"
    text = path.read_text()
    path.write_text("broken(\n")
    try:
        status, output = made.snakemake("-n", "--", "results/paper/mine.plain.nc")
        line = "studies/mine/effects.py = SyntaxError: '(' was never closed (effects.py, line 1)"
        assert status != 0 and line in output
        assert "seeds" in jobs_by_rule(made.succeed("-n", "--", "results/paper/cooling.nc"))
    finally:
        path.write_text(text)
