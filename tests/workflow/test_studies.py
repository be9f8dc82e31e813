"""Studies as Snakemake makes them: copied, broken, minimal and hostile ones."""

import shutil

import hostile
import pytest
from hostile import ATTACK
from project import TINY as PROJECT_TINY

MINIMAL_STUDY = """\
experiments:
  steep:
    extends: vibrated
    description: The bed under twice the gravity.
    effects: {gravity: {acceleration: 2}}
scales:
  small:
    steep: {sweep: {seeds: 1}}
"""
JOBS_OF_STUDY = {"figure": 1, "table": 1, "claims": 1, "study_page": 1}
SMALL_COPY = {
    "mine.spheres": {
        "particles": 40,
        "sweep": {"beta": ["0", "0.5"], "seeds": 2},
        "schedule": {"replicas": 3, "plateau": 20, "relaxation_times": 2},
    }
}
TINY = ("--config", "scale=tiny", "--")


@pytest.fixture
def study_project(project, tmp_path):
    """A copy of the project, with a method `add` that adds a study."""
    copy = project.copy_to(tmp_path / "own")

    def add(name, text):
        folder = copy.folder / "studies" / name
        folder.mkdir()
        (folder / "config.yaml").write_text(text)

    copy.add = add
    return copy


def test_a_copied_study_is_planned_as_another(study_project):
    studies = study_project.folder / "studies"
    shutil.copytree(studies / "friction", studies / "mine")
    planned = study_project.planned("mine")
    assert {rule: planned[rule] for rule in JOBS_OF_STUDY} == JOBS_OF_STUDY
    assert planned["reduce"] == 2 and planned["mine"] == 1


@pytest.mark.slow  # compiles a kernel
def test_a_thirteenth_paper_is_added_by_copying_a_folder(study_project):
    """It has its figure, verdicts that are not judged yet, and a row in the table of papers."""
    studies = study_project.folder / "studies"
    others = [path.parent for path in studies.glob("*/config.yaml") if "paper:" in path.read_text()]
    shutil.copytree(studies / "brilliantov_2007", studies / "mine")
    for folder in others:  # all papers take minutes
        shutil.rmtree(folder)
    names = {folder.name for folder in others}
    tiny = {key: change for key, change in PROJECT_TINY.items() if key.split(".")[0] not in names}
    text = (studies / "mine" / "config.yaml").read_text()
    (studies / "mine" / "config.yaml").write_text(
        text.replace("paper: N. V.", "paper: Mine, N. V.")
    )
    study_project.configure(lambda config: config["scales"].update(tiny=tiny | SMALL_COPY))
    study_project.succeed("-j2", *TINY, "papers")
    table = (study_project.folder / "results/tiny/papers.csv").read_text().splitlines()
    assert len(others) == 12 and len(table) == 3
    assert all(row.startswith('mine,"Mine, N. V. Brilliantov') for row in table[1:])
    verdicts = (study_project.folder / "results/tiny/mine/claims.md").read_text()
    assert "**Not fixed before these data.**" in verdicts
    assert (study_project.folder / "figures/tiny/mine.spheres.png").stat().st_size > 10_000


@pytest.mark.slow
def test_a_broken_study_is_refused_in_one_line_and_all_others_are_made(study_project):
    study_project.add("broken", "experiments: {x: {extends: vibrated, particles: -3}}")
    study_project.add("unread", MINIMAL_STUDY)
    (study_project.folder / "studies" / "unread" / "figure.py").write_text("def draw(:\n")
    study_project.add("unnamed", "tasks: {experiments: [cooling]}")
    study_project.add("uncombined", "tasks: {experiments: [cooling]}")
    (study_project.folder / "studies" / "uncombined" / "tasks.py").write_text(
        "tasks = lambda settings: ['a']\n"
    )
    (study_project.folder / "studies" / "uncombined" / "results.py").write_text("def combine(:\n")
    for name in ("tasks", "results"):
        (study_project.folder / "studies" / "unnamed" / f"{name}.py").write_text("import absent\n")
    status, output = study_project.snakemake("-n", *TINY, "extensions")
    line = (
        "studies/unnamed/tasks.py = ModuleNotFoundError: No module named 'absent': must be Python"
    )
    assert status == 0 and f"{line} (left out; all else can be made)" in output
    assert "studies/uncombined/results.py = SyntaxError: " in output
    status, output = study_project.snakemake("-n", *TINY, "broken")
    line = "roughgas: error: studies/broken/config.yaml: experiments.x.particles = -3: must be"
    assert status == 1 and line in output and "Traceback" not in output


@pytest.mark.slow  # compiles a kernel
def test_a_minimal_study_has_data_a_figure_a_table_and_a_page(study_project):
    study_project.add("least", MINIMAL_STUDY)
    study_project.succeed("-j1", *TINY, "least")
    files = study_project.files()
    assert {"figures/tiny/least.steep.png", "results/tiny/least.steep.nc"} <= files
    assert {f"results/tiny/least/{name}" for name in ("R.csv", "page.html")} <= files
    page = (study_project.folder / "results/tiny/least/page.html").read_text()
    assert "<h1>Least</h1>" in page and "data:image/png" in page and "least.steep" in page


@pytest.mark.slow  # compiles a kernel
def test_texts_of_a_study_stay_text_in_the_report_of_snakemake(study_project):
    """Labels, captions and params stand within a script of the report."""
    report = hostile.report_of(study_project).read_text()
    assert ATTACK not in report and 'href=\\"javascript:alert' not in report
    assert "alert(1)" in report and not (study_project.folder / "harmed").exists()
    page = (study_project.folder / "results/tiny/hostile/page.html").read_text()
    assert ATTACK not in page and "alert(1)" in page
