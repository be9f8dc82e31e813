"""The article as a PDF: its Typst source with numbers, tables and figures from the results."""

import csv
import json
import math
import re
import shutil
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from roughgas.base import InputError, NamedValues, Record, __version__, import_extra, on_one_line
from roughgas.base.files import atomic_write
from roughgas.base.text import with_minus_signs
from roughgas.statistics.estimates import Estimate

TEXT = "article.typ"
QUOTED_NUMBER = re.compile(r'#n\("([^"]*)"\)')
TABLE_RESTITUTION, TABLE_ROUGHNESSES = 0.9, (-0.8, -0.4, 0.0, 0.4, 0.8)
"""r and beta of the table, which uses the closest values in the data."""
COLUMNS = {  # experiment -> columns of R.csv in the table
    "vibrated": ("R", "R_collisional", "R_theory"),
    "sheared": ("R", "R_collisional", "R_theory"),
    "cooling": ("R", "R_corrected", "R_theory"),
}
COLUMN_HEADS = {
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
    """Write the PDF of the files `source`, among them article.typ, which is compiled.

    It is compiled in a folder with the other files, the figures, and data.json, which has the
    quoted numbers, the rows of a table of R, and the verdicts. Raises InputError for an unknown
    quoted number, and for errors of Typst.
    """
    typst = import_extra("typst")
    texts = {name: Path(path).read_text("utf-8") for name, path in (("n", numbers), ("c", claims))}
    data, claims_content = (
        {"numbers": json.loads(texts["n"]), "version": __version__},
        json.loads(texts["c"]),
    )
    (text,) = [path for path in map(Path, source) if path.name == TEXT]
    check_quoted(text.read_text("utf-8"), data["numbers"])
    with open(table, newline="", encoding="utf-8") as file:
        data["table"] = excerpt(csv.DictReader(file))
    data |= {
        "scale": claims_content["scale"],
        "verdicts": [verdict(claim) for claim in claims_content["claims"]],
    }
    with tempfile.TemporaryDirectory() as folder, atomic_write(output) as draft:
        for path in (*source, *figures):
            shutil.copy(path, folder)
        Path(folder, "data.json").write_text(json.dumps(data), encoding="utf-8")
        options = {"root": folder, "ignore_system_fonts": True}
        try:
            draft.write_bytes(typst.compile(str(Path(folder, TEXT)), **options))
        except typst.TypstError as error:
            raise InputError(TEXT, on_one_line(str(error)), "be what Typst compiles") from error


def check_quoted(text: str, numbers: Mapping[str, str]) -> None:
    """Raise InputError for the first number quoted in Typst's source that is not in `numbers`."""
    for name in QUOTED_NUMBER.findall(text):
        if name not in numbers:
            raise InputError(f"number in {TEXT}", name, "be one that numbers.json holds")


def excerpt(rows: Iterable[Mapping[str, str]]) -> NamedValues:
    """Return a table of R over beta (roughness) from rows of R.csv: `r`, `head` and `rows`.

    All are texts. R = E_rot/(E_rot + E_trans). It is taken at the r closest to TABLE_RESTITUTION
    and the betas closest to TABLE_ROUGHNESSES, for the experiments in COLUMNS. Missing values are
    empty texts.
    """
    table_rows = [row for row in rows if row["experiment"] in COLUMNS]
    r = _nearest({float(row["r"]) for row in table_rows}, TABLE_RESTITUTION)
    row_at = {
        (row["experiment"], float(row["beta"])): row for row in table_rows if float(row["r"]) == r
    }
    betas = {beta for _, beta in row_at}
    shown_betas = sorted({_nearest(betas, beta) for beta in TABLE_ROUGHNESSES})
    lines = []
    for beta in shown_betas:
        cells = [
            _cell(row_at.get((name, beta), {}), column)
            for name, columns in COLUMNS.items()
            for column in columns
        ]
        lines.append([with_minus_signs(f"{beta:g}"), *cells])
    head = ["β", *(COLUMN_HEADS[column] for columns in COLUMNS.values() for column in columns)]
    return {"r": f"{r:g}", "head": head, "rows": lines}


def verdict(claim: Record) -> dict[str, str]:
    """Return the quotation, deciding number and verdict of an entry of claims.json, as texts."""
    number = claim["numbers"][0] if claim["numbers"] else None
    deciding = ""
    if number is not None and number["value"] is not None:
        error = math.nan if number["error"] is None else number["error"]
        deciding = with_minus_signs(f"{number['label']}: {Estimate(number['value'], error)}")
    quote = f"Ours: {claim['quote']}" if claim["ours"] else claim["quote"]
    return {"quote": quote, "deciding": deciding, "verdict": claim["verdict"]}


def _cell(row: Mapping[str, str], column: str) -> str:
    """Return the value of a column in a row of R.csv, with its error, as text; "" if missing."""
    if not row.get(column):
        return ""
    value, error = float(row[column]), row.get(f"{column}_stderr")
    return f"{Estimate(value, float(error))}" if error else f"{value:.4f}"


def _nearest(values: Iterable[float], target: float) -> float:
    """Return the value closest to the target, the lesser of two equally close."""
    return min(values, key=lambda value: (abs(value - target), value))
