"""A project to start from: a Snakefile, a configuration and a study."""

from pathlib import Path

from roughgas.base import InputError
from roughgas.base.files import write_text

TEMPLATE = Path(__file__).with_name("project_files")
"""Folder of the files that a new project consists of."""


def write_project(folder: str | Path) -> None:
    """Write the files of a new project to `folder`, which need not exist.

    Raises InputError if `folder` is a file or is not empty, OSError where it cannot be written.
    """
    folder = Path(folder)
    if folder.exists() and not (folder.is_dir() and not any(folder.iterdir())):
        raise InputError("FOLDER", folder, "be new or empty")
    for file in sorted(path for path in TEMPLATE.rglob("*") if path.is_file()):
        write_text(folder / file.relative_to(TEMPLATE), file.read_text(encoding="utf-8"))
