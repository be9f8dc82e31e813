"""The version is the same wherever it stands."""

import tomllib
from pathlib import Path

import roughgas
from roughgas.base.version import __version__

PROJECT = Path(__file__).parents[2] / "pyproject.toml"


def test_the_package_has_the_version_of_the_project():
    assert tomllib.loads(PROJECT.read_text())["project"]["version"] == __version__
    assert roughgas.__version__ == __version__
