"""The workflow from other folders: by -s, by --directory, and as a module of another workflow."""

import json
import os
import subprocess
import sys

import pytest
from project import ROOT, Project

from roughgas.config.reading import read_yaml

POINT = "results/tiny/cooling/r0.9/beta0/seed9.nc"
CONFIG = "results/tiny/config.yaml"
MODULE = """
module roughgas:
    snakefile:
        "{}/Snakefile"
    config:
        {{"scale": "tiny"}}


use rule * from roughgas as roughgas_*
"""
REASONED = ("Mixed rules and functions", "Environment variable PATH used")
"""What snakemake --lint may say: docs/development.md has the reasons."""


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    return Project(tmp_path_factory.mktemp("source"))


def run(source, folder, *arguments):
    """Exit status and output of a Snakemake in another folder than that of the Snakefile."""
    command = [sys.executable, "-m", "snakemake", *map(str, arguments)]
    around = source.environment()
    done = subprocess.run(command, cwd=folder, env=around, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def succeed(*arguments):
    status, output = run(*arguments)
    assert status == 0, output
    return output


@pytest.mark.slow
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


@pytest.mark.slow
def test_the_configuration_of_the_working_folder_comes_first(source, tmp_path):
    own = read_yaml(source.folder / "config.yaml")
    own["experiments"]["mine"] = {"extends": "cooling", "particles": 30}
    (tmp_path / "config.yaml").write_text(json.dumps(own))
    told = ("-s", source.folder / "Snakefile", "--directory", tmp_path, "--config", "scale=tiny")
    output = succeed(source, os.getcwd(), "-n", *told, "--", "results/tiny/mine.nc")
    assert "reduce" in output
    status, output = run(source, source.folder, "-n", "--", "results/tiny/mine.nc")
    assert status != 0 and "experiment = 'mine': must be one of" in output


@pytest.mark.slow
def test_it_is_a_module_of_another_workflow(source, tmp_path):
    (tmp_path / "Snakefile").write_text(MODULE.format(source.folder))
    succeed(source, tmp_path, "-c1", POINT, CONFIG)
    assert (tmp_path / POINT).exists() and read_yaml(tmp_path / CONFIG)["scale"] == "tiny"
    output = succeed(source, tmp_path, "-n", "-c1", "roughgas_figures")
    assert "roughgas_reduce" in output and "roughgas_cooling_block_1" in output


@pytest.mark.slow
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
    command = [sys.executable, "-m", "snakemake", "-n", "-s", ROOT / "workflow" / "Snakefile"]
    told = [*command, "--config", "scale=small", "--", "living"]
    done = subprocess.run(told, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0 and "results/small/living.html" in done.stdout + done.stderr


def test_the_catalogue_of_workflows_is_told_how_it_is_used():
    usage = read_yaml(ROOT / ".snakemake-workflow-catalog.yml")["usage"]
    assert usage["software-stack-deployment"]["apptainer"] and usage["report"]
    assert (ROOT / "Apptainer.def").exists() and (ROOT / "config" / "README.md").exists()
    keys = read_yaml(ROOT / "config.yaml")
    page = (ROOT / "config" / "README.md").read_text()
    assert [key for key in keys if f"`{key}`" not in page] == []
