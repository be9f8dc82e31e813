"""Projects in which nothing has been run, or all."""

import re

import pytest
from project import FINISHED, Project


@pytest.fixture(scope="session")
def project(tmp_path_factory):
    """A project in which nothing has been run, and which no test changes."""
    return Project(tmp_path_factory.mktemp("project"))


@pytest.fixture(scope="session")
def made(tmp_path_factory):
    """A project that Snakemake takes to be finished: its products are there, though empty."""
    made = Project(tmp_path_factory.mktemp("made"))

    def aim(config):
        config["experiments"]["aimed"] = {"extends": "sheared"}
        config["scales"]["tiny"]["aimed"] = {"target_stderr": 0.03}

    made.configure(aim)
    targets = ("--config", "scale=tiny", "--", *FINISHED)
    for line in made.succeed("--summary", *targets).splitlines():
        if re.match(r"(results|figures)/\S+\t", line):
            path = made.folder / line.split("\t")[0]
            if path.name == "seeds":
                path.mkdir(parents=True)
            else:
                path.parent.mkdir(parents=True, exist_ok=True)
                path.touch()
    made.succeed("-j1", "--touch", "--forceall", *targets)
    return made


@pytest.fixture
def finished(made, tmp_path):
    """A copy of `made` that a test may change."""
    return made.copy_to(tmp_path / "copy")
