"""Projects in which nothing has been run, or all."""

import re

import pytest
from project import Project


@pytest.fixture(scope="session")
def project(tmp_path_factory):
    """A project in which nothing has been run, and which no test changes."""
    return Project(tmp_path_factory.mktemp("project"))


@pytest.fixture(scope="session")
def made(tmp_path_factory):
    """A project that Snakemake takes to be finished: its products are there, though empty."""
    made = Project(tmp_path_factory.mktemp("made"))
    output = made.succeed("--config", "scale=tiny", "--detailed-summary", "--", "everything")
    for line in output.splitlines():
        if re.match(r"(results|figures)/\S+\t", line):
            path = made.folder / line.split("\t")[0]
            path.parent.mkdir(parents=True, exist_ok=True)
            path.touch()
    made.succeed("-j1", "--touch", "--forceall", "--config", "scale=tiny", "--", "everything")
    return made


@pytest.fixture
def finished(made, tmp_path):
    """A copy of `made` that a test may change."""
    return made.copy_to(tmp_path / "copy")
