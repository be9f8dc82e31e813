"""The workflow from other folders, as a module, and in folders with any name."""

import json
import os
import re
import subprocess
import sys

import pytest
import snakemakes
from project import ROOT, Project

from roughgas.base.reading import read_yaml

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


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    return Project(tmp_path_factory.mktemp("source"))


def run(source, folder, *arguments):
    """Return exit status and output of Snakemake, run in `folder` with the project's sources."""
    return snakemakes.run(folder, source.environment(), arguments)


def succeed(*arguments):
    status, output = run(*arguments)
    assert status == 0, output
    return output


def test_a_snakefile_elsewhere_writes_to_the_working_folder(source, tmp_path):
    options = ("-s", source.folder / "Snakefile", "--config", "scale=tiny", "--")
    succeed(source, tmp_path, "-j1", *options, POINT, CONFIG)
    assert read_yaml(tmp_path / CONFIG)["scale"] == "tiny" and (tmp_path / POINT).exists()
    assert not (source.folder / "results").exists()
    assert "Nothing to be done" in succeed(source, tmp_path, "-n", *options, POINT, CONFIG)
    for target in ("figures", "hard_cases", "accuracy", "explore", "movies"):
        succeed(source, tmp_path, "-n", *options, target)
    status, output = run(source, tmp_path, "-n", *options, "crate")
    assert status != 0 and f"folder = {tmp_path}: must be {source.folder}" in output


def test_the_configuration_of_the_working_folder_comes_first(source, tmp_path):
    configuration = read_yaml(source.folder / "config.yaml")
    configuration["experiments"]["mine"] = {"extends": "cooling", "particles": 30}
    for changes in configuration["scales"].values():  # of studies, which this folder lacks
        for name in [key for key in changes if "." in key]:
            del changes[name]
    (tmp_path / "config.yaml").write_text(json.dumps(configuration))
    options = ("-s", source.folder / "Snakefile", "--directory", tmp_path, "--config", "scale=tiny")
    output = succeed(source, os.getcwd(), "-n", *options, "--", "results/tiny/mine.nc")
    assert "reduce" in output
    status, output = run(source, source.folder, "-n", "--", "results/tiny/mine.nc")
    assert status != 0 and "experiment = 'mine': must be one of" in output


@pytest.fixture
def host(source, tmp_path):
    """A folder with a configured workflow that uses the project as a module."""
    (tmp_path / "Snakefile").write_text(HOST.format(source.folder))
    configuration = {"samples": ["a"], "scale": "tiny", "seeds_per_job": 2}
    (tmp_path / "config.yaml").write_text(json.dumps(configuration))
    return tmp_path


def test_a_module_reads_its_keys_of_the_hosts_configuration(source, host):
    status, output = snakemakes.run(host, source.environment(), ("-c1", f"other folder/{CONFIG}"))
    assert status == 0 and "of the host's config these are not read: samples\n" in output, output
    assert "localrules" not in output
    used = read_yaml(host / "other folder" / CONFIG)
    assert (used["scale"], used["seeds_per_job"]) == ("tiny", 2) and used["experiments"]


def test_a_module_with_a_prefix_finds_its_points_below_it(source, host):
    arguments = ("-n", "-p", "roughgas_figures", "roughgas_explore")
    status, output = snakemakes.run(host, source.environment(), arguments)
    assert status == 0 and "roughgas_reduce" in output and "roughgas_vibrated_block1" in output
    assert "--points 'other folder/results/tiny'" in output
    outputs = re.findall("--output (.*)", output)
    assert len(outputs) > 10 and all(path.startswith("'other folder/") for path in outputs)


def test_a_wrong_configuration_of_a_host_is_refused_in_one_line(source, host):
    (host / "config.yaml").write_text('{"samples": ["a"], "scale": 3}')
    status, output = snakemakes.run(host, source.environment(), ("-n", "roughgas_figures"))
    (refusal,) = [line for line in output.splitlines() if "error" in line]
    assert status == 1 and refusal.startswith(
        "roughgas: error: config.yaml with the command line's"
    )
    assert "scale = 3: must" in refusal


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


def test_every_rule_has_a_container_and_passes_lint():
    command = [sys.executable, "-m", "snakemake", "--lint"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    assert "Congratulations" in done.stdout + done.stderr


READ_ONLY = (
    'mount --bind "$0" "$0" && mount -o remount,ro,bind "$0" && cd "$1" && shift && exec "$@"'
)
FOLDERS = ["a b 'c' \"d\" ä (e) [f] $(touch pwned);touch pwned||touch pwned& `g` #h *? ~ % =", "-x"]
NAME_WITH_BRACES = "a{scale}b"
PLANNED_TARGETS = ("hard_cases", "movies", "coverage", "explore")
BUILT_TARGETS = ("results/tiny/config.yaml", "results/tiny/living.html")


def project_in(folder):
    folder.mkdir(parents=True)
    return Project(folder)


def run_here(project, folder, *arguments):
    """Return exit status and output of Snakemake in a folder, with the project's Snakefile."""
    options = ("-c1", f"--snakefile={project.folder / 'Snakefile'}", "--config", "scale=tiny")
    return snakemakes.run(folder, project.environment(), (*options, *arguments))


def assert_runs(project, folder):
    status, output = run_here(project, folder, "--", *BUILT_TARGETS)
    assert status == 0, output
    assert all((folder / target).exists() for target in BUILT_TARGETS)


@pytest.mark.parametrize("name", [*FOLDERS, NAME_WITH_BRACES])
def test_folders_with_odd_names_work(tmp_path, name):
    project = project_in(tmp_path / name)
    if name == NAME_WITH_BRACES:  # in its folder alone
        assert_runs(project, project.folder)
    else:
        (tmp_path / "other" / name).mkdir(parents=True)
        assert_runs(project, tmp_path / "other" / name)
        status, output = run_here(project, tmp_path / "other" / name, "-n", "--", *PLANNED_TARGETS)
        assert status == 0, output
    assert not list(tmp_path.rglob("pwned"))


def test_folders_that_snakemake_cannot_read_are_refused_in_one_line(tmp_path):
    project = project_in(tmp_path / NAME_WITH_BRACES)
    status, output = run_here(project, tmp_path, "-n", "--", *BUILT_TARGETS)
    (refusal,) = [line for line in output.splitlines() if "error" in line.lower()]
    assert status == 1 and refusal.startswith(
        f"roughgas: error: folder = {project.folder}: must have no "
    )


def test_paths_that_apptainer_cannot_take_are_refused(tmp_path):
    project = project_in(tmp_path / "a b")
    status, output = run_here(project, tmp_path, "-n", "--sdm", "apptainer", "--", *BUILT_TARGETS)
    assert status == 1 and f"container = {project.folder}/roughgas.sif: must be a path" in output


def test_folders_that_cannot_be_written_are_refused_in_one_line(tmp_path):
    project = project_in(tmp_path / "project")
    (project.folder / ".snakemake").write_text("no folder")
    status, output = run_here(project, project.folder, "-n", "--", *BUILT_TARGETS)
    (refusal,) = [line for line in output.splitlines() if "roughgas: error" in line]
    assert status == 1 and "Traceback" not in output
    assert refusal.startswith(f"roughgas: error: {project.folder / '.snakemake'}")


@pytest.mark.parametrize(
    ("read_only", "folder", "refusal"),
    [
        ("project", "work", ""),
        ("project", "project", "{}/.snakemake: Read-only file system"),
        ("work", "work", "{}/.snakemake: Read-only file system"),
        ("home", "work", "[Errno 30] Read-only file system: '{}/.cache'"),
    ],
)
def test_a_read_only_project_runs_elsewhere_alone(tmp_path, read_only, folder, refusal):
    """A project installed for all users, the home folder, the working folder."""
    project = project_in(tmp_path / "project")
    for name in ("work", "home"):
        (tmp_path / name).mkdir()
    command = ["unshare", "--mount", "--map-root-user", "sh", "-c", READ_ONLY]
    command += [tmp_path / read_only, tmp_path / folder, sys.executable, "-m", "snakemake", "-c1"]
    command += ["-s", project.folder / "Snakefile", "--config", "scale=tiny", "--", *BUILT_TARGETS]
    environment = project.environment() | {"HOME": str(tmp_path / "home"), "XDG_CACHE_HOME": ""}
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    if "mount" in done.stderr or "unshare" in done.stderr:
        pytest.skip(done.stderr)
    assert ("Traceback" in done.stderr) == (read_only == "home")  # Snakemake's, at its start
    assert (done.returncode == 0) == (refusal == ""), done.stderr
    assert refusal.format(tmp_path / read_only) in done.stderr
