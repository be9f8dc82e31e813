"""`roughgas show`: a summary of any dataset that the pipeline writes.

A module for each kind of dataset has `read`, `text` for a person and `record` for a script.
"""

from argparse import Namespace
from pathlib import Path
from types import ModuleType

from roughgas.base.errors import InputError
from roughgas.base.layout import as_json

LEGAL = "be a dataset of roughgas: a point, a reduced one, a film, a study or a pilot.json"


def show(options: Namespace) -> None:
    """Print summaries, an empty line between them."""
    for number, path in enumerate(options.files):
        if options.json:
            kind, module = _kind_of(path)
            about = {"file": path, "kind": kind} | module.record(module.read(path))
            print(as_json(about, indent=None))
        else:
            print("\n" * (number > 0) + summary(path))


def summary(path: str | Path) -> str:
    """Return the text about a dataset. Raises InputError for files of other programs."""
    kind, module = _kind_of(path)
    return f"{path}: {kind}\n\n{module.text(module.read(path))}"


def _kind_of(path: str | Path) -> tuple[str, ModuleType]:
    """Return what a dataset is, and the module that shows it."""
    from roughgas.cli.show import film, pilot, point, reduced, studies, task

    if Path(path).suffix == ".json":
        return "pilot of a point", pilot
    names, attributes, groups = _outline(path)
    if groups and groups <= set(studies.STUDIES):
        return "studies of accuracy", studies
    if {"study", "task"} <= attributes:
        return "task of a study of accuracy", task
    if "disk_spin" in names:
        return "film of a cooling gas", film
    if {"n_seeds", "E_trans"} <= names:
        return "reduced dataset", reduced
    if {"experiment", "seed"} <= attributes and "E_trans" in names:
        return "point", point
    raise InputError("file", path, LEGAL)


def _outline(path: str | Path) -> tuple[set[str], set[str], set[str]]:
    """Return the names of variables, attributes and groups."""
    import netCDF4

    try:
        with netCDF4.Dataset(path) as file:
            return set(file.variables), set(file.ncattrs()), set(file.groups)
    except FileNotFoundError:
        raise
    except OSError as error:
        raise InputError("file", path, LEGAL) from error
