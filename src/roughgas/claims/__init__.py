"""The verdict on the paper: McNamara & Luding (1998), statement by statement, from the datasets."""

from collections.abc import Iterable
from pathlib import Path

from roughgas.atomic import write_text
from roughgas.claims import beyond, cooling, shear, vibration, walls
from roughgas.claims.evidence import load_all
from roughgas.claims.finding import Row, examine
from roughgas.claims.report import as_json, as_markdown
from roughgas.errors import InputError

STATEMENTS = (
    *vibration.STATEMENTS,
    *walls.STATEMENTS,
    *shear.STATEMENTS,
    *cooling.STATEMENTS,
    *beyond.STATEMENTS,
)


def judge(reduced: Iterable[str | Path], json_path: str | Path, md_path: str | Path) -> list[Row]:
    """Judge every statement on the reduced datasets, and write the verdicts as JSON and Markdown.

    Statements whose experiments are not among the datasets are "not tested".
    Raises InputError where the datasets are of several scales.
    """
    datasets = load_all(reduced)
    scales = sorted({data.attrs["scale"] for data in datasets.values()})
    if len(scales) != 1:
        raise InputError("scale of the datasets", " and ".join(scales) or "none", "be one")
    rows = [examine(statement, datasets) for statement in STATEMENTS]
    write_text(json_path, as_json(rows, datasets))
    write_text(md_path, as_markdown(rows, datasets))
    return rows
