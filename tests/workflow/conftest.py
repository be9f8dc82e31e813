import pytest
from project import Project


@pytest.fixture(scope="session")
def project(tmp_path_factory):
    """A project in which nothing has been run, and which no test changes."""
    return Project(tmp_path_factory.mktemp("project"))
