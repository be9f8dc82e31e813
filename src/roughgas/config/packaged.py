"""The configurations and studies that come with the package."""

from pathlib import Path

from roughgas.base.files import PACKAGE

SHIPPED = PACKAGE / "config.yaml"
"""Configuration that comes with the package; in a clone of the repository, its config.yaml."""
STUDIES_FOLDER = "studies"
STUDIES_OF_ACCURACY = ("accuracy", "coverage")
"""Studies whose settings the key `accuracy` of a configuration changes."""
SHIPPED_STUDIES = ("paper", *STUDIES_OF_ACCURACY)
"""Studies of every configuration; the workflow's products are named after them."""


def shipped_studies() -> Path:
    """Return the folder of the studies that come with the package; in a clone, its studies/."""
    package_folder = PACKAGE / STUDIES_FOLDER
    # two folders up: for a copy of a clone whose link to config.yaml has become a file
    clone_folders = SHIPPED.resolve().parent / STUDIES_FOLDER, PACKAGE.parents[1] / STUDIES_FOLDER
    return next(
        (folder for folder in (package_folder, *clone_folders) if folder.is_dir()), package_folder
    )
