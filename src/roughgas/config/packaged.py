"""The configuration, the studies and the workflow that come with the package."""

from pathlib import Path

from roughgas.base.files import PACKAGE

SHIPPED = PACKAGE / "config.yaml"
"""Configuration that comes with the package; in a clone of the repository, its config.yaml."""
STUDIES_FOLDER = "studies"
STUDIES_OF_ACCURACY = ("accuracy", "coverage")
"""Studies whose settings the key `accuracy` of a configuration changes."""
SHIPPED_STUDIES = ("paper", *STUDIES_OF_ACCURACY)
"""Studies of every configuration; the workflow's products are named after them."""


def shipped_path(name: str) -> Path:
    """Return the path of `name`, such as "studies", in the package, or else in its clone."""
    # two folders up: for a copy of a clone whose link to config.yaml has become a file
    folders = PACKAGE, SHIPPED.resolve().parent, PACKAGE.parents[1]
    return next((folder / name for folder in folders if (folder / name).exists()), PACKAGE / name)
