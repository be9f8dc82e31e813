"""Folders with any name: what a shell or Snakemake would read in it stays a part of a name. Folders
that cannot be written."""

import subprocess
import sys

import pytest
import snakemakes
from project import Project

READ_ONLY = (
    'mount --bind "$0" "$0" && mount -o remount,ro,bind "$0" && cd "$1" && shift && exec "$@"'
)
NAMES = ["a b 'c' \"d\" ä (e) [f] $(touch pwned);touch pwned||touch pwned& `g` #h *? ~ % =", "-x"]
BRACES = "a{scale}b"
DRY = ("hard_cases", "movies", "coverage", "explore")
REAL = ("results/tiny/config.yaml", "results/tiny/living.html")


def project_in(folder):
    folder.mkdir(parents=True)
    return Project(folder)


def run(project, folder, *arguments):
    """Exit status and output of Snakemake in a folder, with the project's Snakefile."""
    options = ("-c1", f"--snakefile={project.folder / 'Snakefile'}", "--config", "scale=tiny")
    return snakemakes.run(folder, project.environment(), (*options, *arguments))


def assert_runs(project, folder):
    status, output = run(project, folder, "--", *REAL)
    assert status == 0, output
    assert all((folder / made).exists() for made in REAL)


@pytest.mark.parametrize("name", NAMES)
def test_the_project_is_in_it_and_one_works_elsewhere(tmp_path, name):
    project = project_in(tmp_path / name)
    assert_runs(project, tmp_path)
    status, output = run(project, tmp_path, "-n", "--", *DRY)
    assert status == 0, output
    assert not list(tmp_path.rglob("pwned"))


@pytest.mark.parametrize("name", [*NAMES, BRACES])
def test_one_works_in_it(tmp_path, name):
    project = project_in(tmp_path / name)
    assert_runs(project, project.folder)
    (tmp_path / "other" / name).mkdir(parents=True)
    if name != BRACES:
        assert_runs(project, tmp_path / "other" / name)
    assert not list(tmp_path.rglob("pwned"))


def test_what_snakemake_cannot_read_is_said_in_one_line(tmp_path):
    project = project_in(tmp_path / BRACES)
    status, output = run(project, tmp_path, "-n", "--", *REAL)
    (said,) = [line for line in output.splitlines() if "error" in line.lower()]
    assert status == 1 and said.startswith(
        f"roughgas: error: folder = {project.folder}: must have no "
    )


def test_apptainer_says_which_path_it_cannot_take(tmp_path):
    project = project_in(tmp_path / "a b")
    status, output = run(project, tmp_path, "-n", "--sdm", "apptainer", "--", *REAL)
    assert status == 1 and f"container = {project.folder}/roughgas.sif: must be a path" in output


def test_a_place_that_cannot_be_written_is_said_in_one_line(tmp_path):
    project = project_in(tmp_path / "project")
    (project.folder / ".snakemake").write_text("no folder")
    status, output = run(project, project.folder, "-n", "--", *REAL)
    (said,) = [line for line in output.splitlines() if "roughgas: error" in line]
    assert status == 1 and "Traceback" not in output
    assert said.startswith(f"roughgas: error: {project.folder / '.snakemake'}")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("read_only", "place", "told"),
    [
        ("project", "work", ""),
        ("project", "project", "{}/.snakemake: Read-only file system"),
        ("work", "work", "{}/.snakemake: Read-only file system"),
        ("home", "work", "[Errno 30] Read-only file system: '{}/.cache'"),
    ],
)
def test_read_only_places(tmp_path, read_only, place, told):
    """The project as it is installed for all, one's home, the folder one works in."""
    project = project_in(tmp_path / "project")
    for name in ("work", "home"):
        (tmp_path / name).mkdir()
    command = ["unshare", "--mount", "--map-root-user", "sh", "-c", READ_ONLY]
    command += [tmp_path / read_only, tmp_path / place, sys.executable, "-m", "snakemake", "-c1"]
    command += ["-s", project.folder / "Snakefile", "--config", "scale=tiny", "--", *REAL]
    around = project.environment() | {"HOME": str(tmp_path / "home"), "XDG_CACHE_HOME": ""}
    done = subprocess.run(command, env=around, capture_output=True, text=True)
    if "mount" in done.stderr or "unshare" in done.stderr:
        pytest.skip(done.stderr)
    assert ("Traceback" in done.stderr) == (read_only == "home")  # Snakemake's, at its start
    assert (done.returncode == 0) == (told == ""), done.stderr
    assert told.format(tmp_path / read_only) in done.stderr
