"""The workflow from other folders, as a module, and in folders with any name."""

import json
import os
import re
import subprocess
import sys

import pytest
import snakemakes
from project import ROOT, Project

from roughgas.config.reading import read_yaml

pytestmark = pytest.mark.slow

POINT = "results/tiny/cooling/r0.9/beta0/seed9.nc"
CONFIG = "results/tiny/config.yaml"
HOST = """
configfile: "config.yaml"


rule a_rule_of_the_host:
    output:
        touch("a.txt"),


module roughgas:
    snakefile:
        "{}/Snakefile"
    config:
        config
    prefix:
        "other folder"


use rule * from roughgas as roughgas_*
"""
REASONED = ("Mixed rules and functions",)
"""What snakemake --lint may say: docs/development.md has the reasons."""


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    return Project(tmp_path_factory.mktemp("source"))


def run(source, folder, *arguments):
    """Exit status and output of a Snakemake in another folder than that of the Snakefile."""
    return snakemakes.run(folder, source.environment(), arguments)


def succeed(*arguments):
    status, output = run(*arguments)
    assert status == 0, output
    return output


def test_a_snakefile_elsewhere_writes_here(source, tmp_path):
    told = ("-s", source.folder / "Snakefile", "--config", "scale=tiny", "--")
    succeed(source, tmp_path, "-j1", *told, POINT, CONFIG)
    assert read_yaml(tmp_path / CONFIG)["scale"] == "tiny" and (tmp_path / POINT).exists()
    assert not (source.folder / "results").exists()
    assert "Nothing to be done" in succeed(source, tmp_path, "-n", *told, POINT, CONFIG)
    for target in ("figures", "hard_cases", "accuracy", "explore", "movies"):
        succeed(source, tmp_path, "-n", *told, target)
    status, output = run(source, tmp_path, "-n", *told, "crate")
    assert status != 0 and f"folder = {tmp_path}: must be {source.folder}" in output


def test_the_configuration_of_the_working_folder_comes_first(source, tmp_path):
    own = read_yaml(source.folder / "config.yaml")
    own["experiments"]["mine"] = {"extends": "cooling", "particles": 30}
    for changes in own["scales"].values():  # of studies, which are not here
        for name in [one for one in changes if "." in one]:
            del changes[name]
    (tmp_path / "config.yaml").write_text(json.dumps(own))
    told = ("-s", source.folder / "Snakefile", "--directory", tmp_path, "--config", "scale=tiny")
    output = succeed(source, os.getcwd(), "-n", *told, "--", "results/tiny/mine.nc")
    assert "reduce" in output
    status, output = run(source, source.folder, "-n", "--", "results/tiny/mine.nc")
    assert status != 0 and "experiment = 'mine': must be one of" in output


@pytest.fixture
def host(source, tmp_path):
    """A workflow with a configuration of its own, of which the project is a module."""
    (tmp_path / "Snakefile").write_text(HOST.format(source.folder))
    own = {"samples": ["a"], "scale": "tiny", "seeds_per_job": 2}
    (tmp_path / "config.yaml").write_text(json.dumps(own))
    return tmp_path


def test_it_is_a_module_beside_its_hosts_configuration(source, host):
    status, output = snakemakes.run(host, source.environment(), ("-c1", f"other folder/{CONFIG}"))
    assert status == 0 and "of the host's config these are not read: samples\n" in output, output
    assert "localrules" not in output
    found = read_yaml(host / "other folder" / CONFIG)
    assert (found["scale"], found["seeds_per_job"]) == ("tiny", 2) and found["experiments"]


def test_a_module_with_a_prefix_finds_its_points_below_it(source, host):
    told = ("-n", "-p", "roughgas_figures", "roughgas_explore")
    status, output = snakemakes.run(host, source.environment(), told)
    assert status == 0 and "roughgas_reduce" in output and "roughgas_block_1" in output
    assert "--points 'other folder/results/tiny'" in output
    outputs = re.findall("--output (.*)", output)
    assert len(outputs) > 10 and all(one.startswith("'other folder/") for one in outputs)


def test_a_host_is_told_what_is_wrong_with_its_configuration(source, host):
    (host / "config.yaml").write_text('{"samples": ["a"], "scale": 3}')
    status, output = snakemakes.run(host, source.environment(), ("-n", "roughgas_figures"))
    (said,) = [line for line in output.splitlines() if "error" in line]
    assert status == 1 and said.startswith("roughgas: error: config.yaml with the command line's")
    assert "scale = 3: must" in said


def test_a_module_makes_points_and_pages_of_them(source, host):
    succeed(source, host, "-c1", f"other folder/{POINT}", "roughgas_explore")
    assert (host / "other folder" / POINT).exists()
    assert (host / "other folder/results/tiny/explore.html").exists()
    assert {path.name for path in host.iterdir()} <= {
        ".snakemake",
        "Snakefile",
        "config.yaml",
        "other folder",
    }


def test_every_rule_has_a_container_and_lint_says_nothing_without_a_reason():
    command = [sys.executable, "-m", "snakemake", "--lint"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    said = [line.strip() for line in (done.stdout + done.stderr).splitlines() if "    * " in line]
    others = [line for line in said if not line.removeprefix("* ").startswith(REASONED)]
    assert said and others == []
    reasons = (ROOT / "docs" / "development.md").read_text()
    assert all(reason in reasons for reason in REASONED)


def test_the_catalogue_finds_the_workflow_where_it_looks(tmp_path):
    """In workflow/Snakefile, which is the one above."""
    told = ("-n", "-s", ROOT / "workflow" / "Snakefile", "--config", "scale=small", "--", "living")
    status, output = snakemakes.run(tmp_path, os.environ, told)
    assert status == 0 and "results/small/living.html" in output


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


def run_here(project, folder, *arguments):
    """Exit status and output of Snakemake in a folder, with the project's Snakefile."""
    options = ("-c1", f"--snakefile={project.folder / 'Snakefile'}", "--config", "scale=tiny")
    return snakemakes.run(folder, project.environment(), (*options, *arguments))


def assert_runs(project, folder):
    status, output = run_here(project, folder, "--", *REAL)
    assert status == 0, output
    assert all((folder / made).exists() for made in REAL)


@pytest.mark.parametrize("name", [*NAMES, BRACES])
def test_one_works_in_it(tmp_path, name):
    project = project_in(tmp_path / name)
    if name == BRACES:  # from within alone
        assert_runs(project, project.folder)
    else:
        (tmp_path / "other" / name).mkdir(parents=True)
        assert_runs(project, tmp_path / "other" / name)
        status, output = run_here(project, tmp_path / "other" / name, "-n", "--", *DRY)
        assert status == 0, output
    assert not list(tmp_path.rglob("pwned"))


def test_what_snakemake_cannot_read_is_said_in_one_line(tmp_path):
    project = project_in(tmp_path / BRACES)
    status, output = run_here(project, tmp_path, "-n", "--", *REAL)
    (said,) = [line for line in output.splitlines() if "error" in line.lower()]
    assert status == 1 and said.startswith(
        f"roughgas: error: folder = {project.folder}: must have no "
    )


def test_apptainer_says_which_path_it_cannot_take(tmp_path):
    project = project_in(tmp_path / "a b")
    status, output = run_here(project, tmp_path, "-n", "--sdm", "apptainer", "--", *REAL)
    assert status == 1 and f"container = {project.folder}/roughgas.sif: must be a path" in output


def test_a_place_that_cannot_be_written_is_said_in_one_line(tmp_path):
    project = project_in(tmp_path / "project")
    (project.folder / ".snakemake").write_text("no folder")
    status, output = run_here(project, project.folder, "-n", "--", *REAL)
    (said,) = [line for line in output.splitlines() if "roughgas: error" in line]
    assert status == 1 and "Traceback" not in output
    assert said.startswith(f"roughgas: error: {project.folder / '.snakemake'}")


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
