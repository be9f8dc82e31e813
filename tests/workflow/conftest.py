import pytest
from project import Project


@pytest.fixture(scope="session")
def project(tmp_path_factory):
    """A copy of the project without results, which no test changes."""
    return Project(tmp_path_factory.mktemp("project"))
