"""`snakedeploy deploy-workflow` from an address at GitHub, which git maps to a local repository."""

import json
import os
import re
import subprocess

import pytest
import snakemakes
from project import ROOT, jobs_by_rule
from repositories import commit_project

from roughgas.base.reading import read_yaml

pytestmark = pytest.mark.slow

SNAKEDEPLOY = ROOT / ".venv-slurm/bin/snakedeploy"
ADDRESS = "https://github.com/roughgas/roughgas"
MODULE = re.compile(r"github\(.*\)")
FIGURES = {"figures": 1, "figure": 4, "reduce": 6}
"""Number of jobs of some of the rules that make the figures of the paper."""
SMALL = ("-n", "--config", "scale=small", "--")


class Deployment:
    """A folder with the workflow deployed as a module."""

    def __init__(self, folder, repository):
        self.folder = folder
        self.repository = repository
        self.environment = os.environ | {
            "GIT_CONFIG_COUNT": "1",
            "GIT_CONFIG_KEY_0": f"url.file://{repository}.insteadOf",
            "GIT_CONFIG_VALUE_0": ADDRESS,
            "XDG_CACHE_HOME": str(folder.parent / "cache"),
        }
        command = [SNAKEDEPLOY, "deploy-workflow", ADDRESS, folder, "--branch", "main"]
        subprocess.run(command, env=self.environment, capture_output=True, check=True)

    def use_local_module(self):
        """Take the module from the folder of the repository instead of GitHub."""
        path = self.folder / "workflow/Snakefile"
        local = json.dumps(str(self.repository / "workflow/Snakefile"))
        path.write_text(MODULE.sub(local, path.read_text()))

    def plan(self, *arguments):
        """Return the number of jobs of each rule that a dry run lists."""
        status, output = snakemakes.run(self.folder, self.environment, arguments)
        assert status == 0, output
        assert "Nothing to be done" not in output
        return jobs_by_rule(output)


@pytest.fixture(scope="module")
def repository(tmp_path_factory):
    assert os.access(SNAKEDEPLOY, os.X_OK), "make .venv-slurm/ready"
    return commit_project(tmp_path_factory.mktemp("repository"))


@pytest.fixture(scope="module")
def remote(repository, tmp_path_factory):
    return Deployment(tmp_path_factory.mktemp("remote") / "gases", repository)


@pytest.fixture(scope="module")
def local(repository, tmp_path_factory):
    deployment = Deployment(tmp_path_factory.mktemp("local") / "gases", repository)
    deployment.use_local_module()
    return deployment


def commands_of_readme(folder):
    """Return the arguments of Snakemake in the section on deployment of config/README.md."""
    text = (folder / "config/README.md").read_text()
    section = text.partition("## Deployed\n")[2].partition("\n## ")[0]
    return [line.split()[1:] for line in section.splitlines() if line.startswith("    snakemake ")]


def test_a_deployment_holds_configuration_module_and_profile(remote):
    assert read_yaml(remote.folder / "config/config.yaml") == {"scale": "paper"}
    text = (remote.folder / "workflow/Snakefile").read_text()
    assert MODULE.search(text)[0].count("workflow/Snakefile") == 1
    assert (remote.folder / "profiles/slurm/batches.yaml").exists()


def test_the_module_of_an_address_plans_the_figures(remote):
    assert remote.plan(*SMALL, "figures").items() >= FIGURES.items()


def test_without_a_target_the_figures_are_planned(local):
    assert local.plan("-n", "--config", "scale=small").items() >= FIGURES.items()


def test_the_module_of_an_address_plans_the_commands_of_its_page(remote):
    commands = commands_of_readme(remote.folder)
    assert commands
    for arguments in commands:
        assert remote.plan("-n", *arguments)
