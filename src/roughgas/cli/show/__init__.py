"""`roughgas show`: a summary of any dataset that the pipeline writes."""

from argparse import Namespace
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from roughgas.base.errors import InputError
from roughgas.base.layout import as_json

LEGAL = "be a dataset of roughgas: a point, a reduced one, a film, a study or a pilot.json"


class Kind(NamedTuple):
    """A kind of dataset: its name, its summary for a person, and what a script reads of it."""

    name: str
    text: Callable[[Any], str]
    record: Callable[[Any], dict[str, Any]]


def show(options: Namespace) -> None:
    """Print summaries, an empty line between them."""
    for number, path in enumerate(options.files):
        if options.json:
            kind, data = _read(path)
            attributes = {"attributes": data.attrs} if hasattr(data, "attrs") else {}
            about = {"file": path, "kind": kind.name} | attributes
            print(as_json(about | kind.record(data), indent=None))
        else:
            print("\n" * (number > 0) + summary(path))


def summary(path: str | Path) -> str:
    """Return the text about a dataset. Raises InputError for files of other programs."""
    kind, data = _read(path)
    return f"{path}: {kind.name}\n\n{kind.text(data)}"


def _read(path: str | Path) -> tuple[Kind, Any]:
    """Return the kind of a file, and what is in it."""
    from roughgas.cli.show import gas, sets
    from roughgas.data.netcdf import read_netcdf
    from roughgas.planning.pilot import read_pilot
    from roughgas.studies.accuracy.variables import read_studies

    if Path(path).suffix == ".json":
        return Kind("pilot of a point", sets.pilot_text, sets.pilot_record), read_pilot(path)
    try:
        if studies := read_studies(path):
            return Kind("studies of accuracy", sets.studies_text, sets.studies_record), studies
        data = read_netcdf(path)
    except FileNotFoundError:
        raise
    except OSError as error:
        raise InputError("file", path, LEGAL) from error
    if {"study", "task"} <= set(data.attrs):
        return Kind("task of a study of accuracy", sets.task_text, sets.task_record), data
    if "disk_spin" in data:
        return Kind("film of a cooling gas", gas.film_text, gas.film_record), data
    if "n_seeds" in data and "E_trans" in data:
        return Kind("reduced dataset", sets.reduced_text, sets.reduced_record), data
    if {"experiment", "seed"} <= set(data.attrs) and "E_trans" in data:
        return Kind("point", gas.point_text, gas.point_record), data
    raise InputError("file", path, LEGAL)
