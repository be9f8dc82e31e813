"""Fingerprints of code: as params of rules they make Snakemake repeat jobs that an edit may affect.

A fingerprint is a text of hashes, each of 16 hexadecimal digits. With the files as inputs, the
scheduler would check every file for every job, again and again.
"""

import functools
import hashlib
import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from roughgas.base import files
from roughgas.base.files import MAX_TABLE_BYTES, content_of

SIMULATING = ("simulation.point", "data.point")
RECORDING = ("cli.run", "simulation.run_points", "simulation.experiment_reader", "base.labels")
"""Modules that pass settings on and write results; their imports do not count."""
RUNNING = ("tasks.running",)
"""The module that runs tasks; its imports do not count."""
CHECKING = (
    "simulation.experiment",
    "simulation.experiment_reader",
    "simulation.protocols",
    "simulation.stages",
)
"""Modules that check a configuration; their imports do not affect it."""


def code_of_points() -> str:
    """Return the fingerprint of the code that simulates and writes points."""
    return files.code_of(*SIMULATING, alone=RECORDING)


def code_of_tasks(folder: str | Path, module: str) -> str:
    """Return the fingerprint of the code that runs the tasks of the study in `folder`.

    `module` is the name of its module with the tasks. Raises InputError for a module that is not in
    the folder, or is no Python.
    """
    return files.code_in(folder, module, alone=RUNNING)


def with_files(code: str, settings: str) -> str:
    """Return the fingerprint `code`, extended by the files of radii that are named in settings.

    `settings` is JSON. Raises InputError for a file that is too large, OSError if it cannot be
    read.
    """
    paths = _files(json.loads(settings)) if '"file"' in settings else ()
    return " ".join([code, *map(digest_of_file, paths)])


def _files(settings: Any) -> Iterator[str]:
    """Yield the paths of files of radii named anywhere in nested settings."""
    if isinstance(settings, dict):
        if settings.get("distribution") == "file":
            yield settings["file"]
            return
        settings = list(settings.values())
    if isinstance(settings, list):
        for inner in settings:
            yield from _files(inner)


@functools.cache
def digest_of_file(path: str | Path) -> str:
    """Return a hash of a file: 16 hexadecimal digits.

    Raises InputError and OSError as `content_of`.
    """
    return hashlib.sha256(content_of(path, str(path), MAX_TABLE_BYTES)).hexdigest()[:16]


def code_beside(folder: str | Path, patterns: Iterable[str], *modules: str) -> str:
    """Return the fingerprint of files in the folder of a study, and of modules of the package.

    The files match any of the glob `patterns`; names of `modules` are such as "show.gallery".
    """
    sources = [path for pattern in patterns for path in sorted(Path(folder).glob(pattern))]
    return " ".join([files.code_of(*modules), *map(digest_of_file, sources)])
