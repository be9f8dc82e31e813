"""The article as a PDF: its Typst source, filled with numbers, tables and figures of results."""

import csv
import json
import math
import re
import shutil
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from roughgas.base import InputError, __version__, on_one_line, required
from roughgas.base.files import whole_file
from roughgas.statistics.errors import Estimate

TEXT = "article.typ"
QUOTED = re.compile(r'#n\("([^"]*)"\)')
RESTITUTION, ROUGHNESSES = 0.9, (-0.8, -0.4, 0.0, 0.4, 0.8)
"""Where the table has its values, or as near as the data have one."""
COLUMNS = {  # experiment -> the columns of R.csv that are shown
    "vibrated": ("R", "R_collisional", "R_theory"),
    "sheared": ("R", "R_collisional", "R_theory"),
    "cooling": ("R", "R_corrected", "R_theory"),
}
HEADS = {
    "R": "over time",
    "R_collisional": "over coll.",
    "R_corrected": "corrected",
    "R_theory": "theory",
}


def write_article(
    source: list[str | Path],
    *,
    numbers: str | Path,
    claims: str | Path,
    table: str | Path,
    figures: Sequence[str | Path],
    output: str | Path,
) -> None:
    """Write the PDF of the files `source`, of which article.typ is compiled.

    It finds the others and the figures beside it, and in data.json the quoted numbers, the rows of
    a table of R, and the verdicts. Raises InputError for a quoted number that is not known, and for
    what Typst refuses.
    """
    typst = required("typst")
    read = {name: Path(path).read_text("utf-8") for name, path in (("n", numbers), ("c", claims))}
    data, judged = {"numbers": json.loads(read["n"]), "version": __version__}, json.loads(read["c"])
    (text,) = [path for path in map(Path, source) if path.name == TEXT]
    check_quoted(text.read_text("utf-8"), data["numbers"])
    with open(table, newline="", encoding="utf-8") as file:
        data["table"] = excerpt(csv.DictReader(file))
    data |= {"scale": judged["scale"], "verdicts": [verdict(one) for one in judged["claims"]]}
    with tempfile.TemporaryDirectory() as folder, whole_file(output) as draft:
        for path in (*source, *figures):
            shutil.copy(path, folder)
        Path(folder, "data.json").write_text(json.dumps(data), encoding="utf-8")
        told = {"root": folder, "ignore_system_fonts": True}
        try:
            draft.write_bytes(typst.compile(str(Path(folder, TEXT)), **told))
        except typst.TypstError as error:
            raise InputError(TEXT, on_one_line(str(error)), "be what Typst compiles") from error


def check_quoted(text: str, numbers: Mapping[str, str]) -> None:
    """Raise InputError for the first number that the text quotes and that is not known."""
    for name in QUOTED.findall(text):
        if name not in numbers:
            raise InputError(f"number in {TEXT}", name, "be one that numbers.json holds")


def excerpt(rows: Iterable[Mapping[str, str]]) -> dict[str, Any]:
    """Return a table of R over beta, a row of texts each, from the rows of R.csv.

    At the restitution `r` next to RESTITUTION, and the roughnesses next to ROUGHNESSES, of each
    experiment in COLUMNS. What a row lacks is an empty text.
    """
    found = [row for row in rows if row["experiment"] in COLUMNS]
    r = _nearest({float(row["r"]) for row in found}, RESTITUTION)
    here = {(row["experiment"], float(row["beta"])): row for row in found if float(row["r"]) == r}
    betas = {beta for _, beta in here}
    shown = sorted({_nearest(betas, beta) for beta in ROUGHNESSES})
    lines = []
    for beta in shown:
        cells = [
            _cell(here.get((name, beta), {}), column)
            for name, columns in COLUMNS.items()
            for column in columns
        ]
        lines.append([f"{beta:g}".replace("-", "−"), *cells])
    head = ["β", *(HEADS[column] for columns in COLUMNS.values() for column in columns)]
    return {"r": f"{r:g}", "head": head, "rows": lines}


def verdict(claim: Mapping[str, Any]) -> dict[str, str]:
    """Return of a verdict in claims.json what the article says of it."""
    first = claim["numbers"][0] if claim["numbers"] else None
    deciding = ""
    if first is not None and first["value"] is not None:
        error = math.nan if first["error"] is None else first["error"]
        deciding = f"{first['label']}: {Estimate(first['value'], error)}".replace("-", "−")
    quote = f"Ours: {claim['quote']}" if claim["ours"] else claim["quote"]
    return {"quote": quote, "deciding": deciding, "verdict": claim["verdict"]}


def _cell(row: Mapping[str, str], column: str) -> str:
    if not row.get(column):
        return ""
    value, error = float(row[column]), row.get(f"{column}_stderr")
    return f"{Estimate(value, float(error))}" if error else f"{value:.4f}"


def _nearest(values: Iterable[float], wanted: float) -> float:
    return min(values, key=lambda one: (abs(one - wanted), one))
