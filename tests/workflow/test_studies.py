"""Studies as Snakemake makes them: copied, deleted, broken, and as short as can be."""

import shutil

import pytest

LEAST = """\
experiments:
  steep:
    extends: vibrated
    description: The bed under twice the gravity.
    effects: {gravity: {acceleration: 2}}
scales:
  small:
    steep: {sweep: {seeds: 1}}
"""
MADE = {"study_figure": 1, "study_table": 1, "study_claims": 1, "study_page": 1}
TINY = ("--config", "scale=tiny", "--")


@pytest.fixture
def own(project, tmp_path):
    """A project of one's own, and a function that adds a study to it."""
    copy = project.copy_to(tmp_path / "own")

    def add(name, text):
        folder = copy.folder / "studies" / name
        folder.mkdir()
        (folder / "config.yaml").write_text(text)

    copy.add = add
    return copy


def test_a_copy_of_a_study_is_another(own):
    studies = own.folder / "studies"
    shutil.copytree(studies / "friction", studies / "mine")
    planned = own.planned("mine")
    assert {rule: planned[rule] for rule in MADE} == MADE
    assert planned["reduce"] == 2 and planned["mine"] == 1


def test_a_broken_study_ends_in_one_line_and_keeps_nothing_else_from_being_made(own):
    own.add("broken", "experiments: {x: {extends: vibrated, particles: -3}}")
    own.add("unread", LEAST)
    (own.folder / "studies" / "unread" / "figure.py").write_text("def draw(:\n")
    own.add("unnamed", "tasks: {experiments: [cooling]}")
    own.add("uncombined", "tasks: {experiments: [cooling]}")
    (own.folder / "studies" / "uncombined" / "tasks.py").write_text(
        "tasks = lambda settings: ['a']\n"
    )
    (own.folder / "studies" / "uncombined" / "results.py").write_text("def combine(:\n")
    for name in ("tasks", "results"):
        (own.folder / "studies" / "unnamed" / f"{name}.py").write_text("import absent\n")
    status, output = own.snakemake("-n", *TINY, "extensions")
    line = (
        "studies/unnamed/tasks.py = ModuleNotFoundError: No module named 'absent': must be Python"
    )
    assert status == 0 and f"{line} (left out; all else can be made)" in output
    assert "studies/uncombined/results.py = SyntaxError: " in output
    status, output = own.snakemake("-n", *TINY, "broken")
    line = "roughgas: error: studies/broken/config.yaml: experiments.x.particles = -3: must be"
    assert status == 1 and line in output and "Traceback" not in output


@pytest.mark.slow  # compiles a kernel
def test_the_least_study_has_data_a_figure_a_table_and_a_page(own):
    own.add("least", LEAST)
    own.succeed("-j1", *TINY, "least")
    made = own.files()
    assert {"figures/tiny/least.steep.png", "results/tiny/least.steep.nc"} <= made
    assert {f"results/tiny/least/{name}" for name in ("R.csv", "page.html")} <= made
    page = (own.folder / "results/tiny/least/page.html").read_text()
    assert "<h1>Least</h1>" in page and "data:image/png" in page and "least.steep" in page
