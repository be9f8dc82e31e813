"""Rows of evidence of a study, published numbers beside its datasets, and their references."""

import csv
from collections.abc import Sequence
from pathlib import Path

from roughgas.base import InputError
from roughgas.base.files import study_module
from roughgas.claims.verdicts import load_all
from roughgas.results import long_table
from roughgas.results.comparison import write_rows


def write(folder: str, inputs: list[str], *, shows: Sequence[str], output: str) -> None:
    """Write the rows of evidence of the study in `folder`, CSV.

    `rows` in its evidence.py takes the datasets, with theory, of the experiments in `shows`, in
    that order, and returns an iterable of `Row`. Raises InputError without this function.
    """
    rows = _function(folder, "evidence", "rows")
    write_rows(Path(folder).name, rows(*_datasets(folder, inputs, shows)), output)


def write_long(folder: str, inputs: list[str], *, shows: Sequence[str], output: str) -> None:
    """Write the table of long simulations of the study in `folder`, CSV.

    `long_table` in its long.py takes the datasets of the experiments in `shows`, in that order, and
    returns an iterable of `LongRow`. Raises InputError without this function.
    """
    rows = _function(folder, "long", "long_table")
    long_table.write_long_rows(rows(*_datasets(folder, inputs, shows)), output)


def _function(folder, module, name):
    """Return the function `name` of a module of the study in `folder`.

    Raises InputError if it is missing.
    """
    function = getattr(study_module(folder, module), name, None)
    if function is None:
        raise InputError(f"studies/{Path(folder).name}/{module}.py", "it", f"have {name}()")
    return function


def _datasets(folder, inputs, shows):
    """Return the datasets in the files `inputs`, by their names in `shows`.

    "tasks" stands for the dataset of the tasks of the study in `folder`.
    """
    by_name = {name: data for path in inputs for name, data in load_all(path).items()}
    return [by_name[Path(folder).name if name == "tasks" else name] for name in shows]


def references(module_path: str | Path) -> list[dict[str, str]]:
    """Return the rows of reference.csv, published numbers, in the folder of a module.

    `module_path` is the module's `__file__`. Cells are texts by column.
    """
    path = Path(module_path).with_name("reference.csv")
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))
