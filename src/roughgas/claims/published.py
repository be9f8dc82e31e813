"""What published numbers and the datasets of a study say of the same gases, row by row."""

import csv
from collections.abc import Sequence
from pathlib import Path

from roughgas.base import InputError
from roughgas.base.files import module_of
from roughgas.claims.evidence import load_all
from roughgas.results.evidence import write_rows


def write(folder: str, inputs: list[str], *, shows: Sequence[str], output: str) -> None:
    """Write the rows of evidence of the study in `folder`, CSV.

    Its evidence.py has `rows`, which takes the datasets of what it `shows`, in that order, beside
    theory, and returns an iterable of `Row`. Raises InputError where it has not.
    """
    name = Path(folder).name
    function = getattr(module_of(folder, "evidence"), "rows", None)
    if function is None:
        raise InputError(f"studies/{name}/evidence.py", "it", "have rows()")
    known = {one: data for path in inputs for one, data in load_all(path).items()}
    datasets = [known[name if one == "tasks" else one] for one in shows]
    write_rows(name, function(*datasets), output)


def references(beside: str | Path) -> list[dict[str, str]]:
    """Return the rows of reference.csv beside a module of a study, cells by column, as text."""
    path = Path(beside).with_name("reference.csv")
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))
