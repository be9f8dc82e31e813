"""The verdicts as JSON, for programs, and as Markdown, for people; same data, same bytes."""

import json
import math
from collections import Counter
from typing import Any, NamedTuple

import xarray as xr

from roughgas.claims.finding import (
    AGREE,
    FAILS,
    FEW,
    HOLDS,
    LIMIT,
    NOT_TESTED,
    QUALIFIED,
    TENDENCY,
    Finding,
    Row,
    Statement,
    text,
)
from roughgas.claims.statistics import SIGNIFICANT, Estimate

SCHEMA_VERSION = 1
TOLERANCES = {
    "agree": AGREE,
    "limit": LIMIT,
    "tendency": TENDENCY,
    "few": FEW,
    "significant_sigma": SIGNIFICANT,
}
HOW_TO_READ = """\
How to read it. A number is "value ± standard error (sigma)". Statistics and size count separately:
with small errors a theory that is 2 % off is 20 sigma off and still useful. R agrees where it is
within {agree:g} (about a symbol's size in the paper's figures), and disagrees beyond {limit:g}
where the difference is significant, {significant_sigma:g} sigma or more. In between, agreement is
qualified, and so it is where errors are too large to tell at more than a few points ({few:.0%} of
them). A direction (above, below) needs {tendency:g} in R. Points that are not in a steady state are
set aside, and counted.

Sigma is that of a Gaussian with the same probability as Student's t. The errors come from few
seeds, so those of an experiment are pooled: seeds calibrate the blocking errors by one common
factor, and a point whose own seeds scatter more keeps that larger error.
"""


class Subject(NamedTuple):
    """What a table of verdicts is about: its texts, and its statements."""

    title: str
    about: str  # a paragraph
    quotes: str  # what the column of quotations is called
    statements: tuple[Statement, ...]
    after: str = ""  # a line below the table


def as_json(subject: Subject, rows: list[Row], datasets: dict[str, xr.Dataset]) -> str:
    """All rows, with the tolerances used and the data they rest on."""
    content = {
        "schema_version": SCHEMA_VERSION,
        "title": subject.title,
        "scale": _scale(datasets),
        "tolerances": TOLERANCES,
        "data": {name: _data(data) for name, data in sorted(datasets.items())},
        "claims": [_row(row) for row in rows],
    }
    return json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def as_markdown(subject: Subject, rows: list[Row], datasets: dict[str, xr.Dataset]) -> str:
    """A table of all verdicts, then the reasons and numbers of each."""
    how = HOW_TO_READ.format(**TOLERANCES)
    count = Counter(row.finding.verdict for row in rows)
    verdicts = (HOLDS, QUALIFIED, FAILS, NOT_TESTED)
    summary = ", ".join(f"{verdict} {count[verdict]}" for verdict in verdicts)
    lines = [f"# {subject.title}", "", subject.about, how]
    lines += [f"Scale: {_scale(datasets)}. Of {len(rows)} statements: {summary}.", ""]
    lines += [f"| # | {subject.quotes} | Deciding number | Verdict |"]
    lines += ["| --- | --- | --- | --- |"]
    lines += [_line(number, row) for number, row in enumerate(rows, 1)]
    lines += ["", subject.after] if subject.after else []
    lines += ["", "## Reasons and numbers", ""]
    for number, row in enumerate(rows, 1):
        lines += _details(number, row)
    return "\n".join(lines).rstrip() + "\n"


def _line(number: int, row: Row) -> str:
    deciding = "; ".join(f"{label}: {text(value)}" for label, value in row.finding.numbers[:1])
    return f"| {number} | “{row.statement.quote}” | {deciding} | **{row.finding.verdict}** |"


def _details(number: int, row: Row) -> list[str]:
    statement, finding = row
    lines = [f"### {number}. {statement.name}: {finding.verdict}", "", f"> {statement.quote}", ""]
    lines += [finding.reason, "", f"- data: {', '.join(statement.experiments)}"]
    return [*lines, *(f"- {label}: {text(value)}" for label, value in finding.numbers), ""]


def _row(row: Row) -> dict[str, Any]:
    statement, finding = row
    return {
        "id": statement.name,
        "quote": statement.quote,
        "experiments": list(statement.experiments),
        "verdict": finding.verdict,
        "reason": finding.reason,
        **_deciding(finding),
        "numbers": [{"label": label, **_estimate(value)} for label, value in finding.numbers],
    }


def _deciding(finding: Finding) -> dict[str, float | None]:
    """Size, error and sigma of the number that decides, null where nothing was tested."""
    if not finding.numbers:
        return {"deviation": None, "error": None, "sigma": None}
    numbers = _estimate(finding.numbers[0][1])
    return {"deviation": numbers.pop("value"), **numbers}


def _estimate(number: Estimate) -> dict[str, float | None]:
    values = {"value": number.value, "error": number.error, "sigma": number.sigma}
    return {name: _short(value) for name, value in values.items()}


def _short(value: float) -> float | None:
    """Six significant digits; null for what JSON cannot hold."""
    return float(f"{value:.6g}") if math.isfinite(value) else None


def _data(data: xr.Dataset) -> dict[str, Any]:
    names = ("particles", "points", "set_aside")
    about = {name: int(data.attrs[name]) for name in names}
    about |= {"seeds": int(data.n_seeds.max()), "theory": data.attrs["theory"]}
    return about | ({"swept": data.attrs["swept"]} if "swept" in data.attrs else {})


def _scale(datasets: dict[str, xr.Dataset]) -> str:
    return next(iter(datasets.values())).attrs["scale"]
