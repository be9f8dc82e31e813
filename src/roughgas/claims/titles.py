"""Titles of figures: the conclusion of a statement only where it holds in the data drawn."""

from collections.abc import Sequence
from pathlib import Path

import xarray as xr

from roughgas.base import InputError, check_one_of
from roughgas.claims import examine, read_study
from roughgas.claims.verdicts import EXCEPTIONS, HOLDS, beside_theory

COUNTS = ("points", "set_aside")
"""Attributes of datasets beside theory: numbers of points, and of points that are not steady."""


def judged_title(
    module_path: str | Path, statement: str, datasets: Sequence[xr.Dataset], drawn: str
) -> str:
    """Return the conclusion of a statement if it holds in the data of a figure, else `drawn`.

    It is `drawn`, too, if more than a few of the points (EXCEPTIONS) were set aside, since the
    figure shows them. Gases through stages do not count: they are drawn over time, and no steady
    state is expected of them.

    The statement is judged here, on the same `datasets` (reduced, or of the study's tasks) that the
    figure shows. `module_path` is `__file__` of the study's figure.py, beside claims.yaml with the
    `statement` of this name, and `drawn` the title that names what is drawn. Without claims.yaml
    the title is `drawn`. Raises InputError for an unknown statement, or for one without a
    conclusion.
    """
    folder = Path(module_path).parent
    if not (folder / "claims.yaml").exists():
        return drawn
    by_name = {data.attrs.get("experiment", folder.name): data for data in datasets}
    key = f"studies/{folder.name}/claims.yaml"
    statements = {row.name: row for row in read_study(folder, "", by_name).statements}
    check_one_of(f"{key}: statement of a title", statement, statements)
    if not statements[statement].conclusion:
        raise InputError(f"{key}: {statement}.conclusion", "(nothing)", "be given for a title")
    with_theory = {
        name: beside_theory(data) if "experiment" in data.attrs else data
        for name, data in by_name.items()
    }
    of_points = [data.attrs for data in with_theory.values() if "stages" not in data.attrs]
    counts = {key: sum(attributes.get(key, 0) for attributes in of_points) for key in COUNTS}
    judged = examine(statements[statement], with_theory).verdict == HOLDS
    is_borne_out = judged and counts["set_aside"] <= EXCEPTIONS * counts["points"]
    return statements[statement].conclusion if is_borne_out else drawn
