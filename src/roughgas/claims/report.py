"""The verdicts as JSON, for programs, and as Markdown, for people; same data, same bytes."""

from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import xarray as xr

from roughgas.base import InputError, formatting
from roughgas.base.files import write_text
from roughgas.claims.evidence import load_all
from roughgas.claims.statements import Statement, Subject, examine
from roughgas.claims.verdicts import (
    AGREE,
    FAILS,
    FAR,
    FEW,
    HOLDS,
    LIMIT,
    NEAR,
    NOT_TESTED,
    QUALIFIED,
    TENDENCY,
    Finding,
    text,
)
from roughgas.statistics.errors import SIGNIFICANT

SCHEMA_VERSION = 1
TOLERANCES = {
    "agree": AGREE,
    "limit": LIMIT,
    "tendency": TENDENCY,
    "few": FEW,
    "near": NEAR,
    "far": FAR,
    "significant_sigma": SIGNIFICANT,
}
HOW_TO_READ = """\
How to read it. A number is "value ± standard error (sigma)". Significance and size count
separately: with small errors a theory that is 2 % off is 20 sigma off and still useful. R agrees
where it is within {agree:g}, and disagrees beyond {limit:g} where the difference is significant,
{significant_sigma:g} sigma or more. In between, agreement is qualified, and so it is where errors
are too large to tell at more than a few points ({few:.0%} of them). Where R spans decades it is
also judged relative to theory: agreement is qualified where more than a few points differ by
{near:.0%} of theory, and fails at {far:.0%}. A direction (above, below) needs {tendency:g} in R.
Points that are not in a steady state are set aside, and counted. docs/claims.md gives the reason
for each of these numbers, and says what was fixed before the data were seen.

Errors are those of the reduced datasets (`R_stderr`, with `R_dof` degrees of freedom), which pool
the scatter over seeds with the errors within the runs; `coverage.md` shows how often their
intervals hold the truth. Sigma is that of a Gaussian with the same probability as Student's t."""


def judge(
    reduced: Iterable[str | Path], json_path: str | Path, md_path: str | Path, subject: Subject
) -> list[Finding]:
    """Judge every statement of a subject on reduced datasets and studies; write JSON and Markdown.

    Statements whose experiments or studies are not among the datasets are "not tested".
    Raises InputError where the datasets are of several scales.
    """
    datasets = {name: data for path in reduced for name, data in load_all(path).items()}
    scales = sorted({data.attrs["scale"] for data in datasets.values()})
    if len(scales) != 1:
        raise InputError("scale of the datasets", " and ".join(scales) or "none", "be one")
    findings = [examine(statement, datasets) for statement in subject.statements]
    write_text(json_path, as_json(subject, findings, datasets, *scales))
    write_text(md_path, as_markdown(subject, findings, *scales))
    return findings


def as_json(
    subject: Subject, findings: list[Finding], datasets: dict[str, xr.Dataset], scale: str
) -> str:
    """Return all findings as JSON, with the tolerances used and the data they rest on."""
    content = {
        "schema_version": SCHEMA_VERSION,
        "title": subject.title,
        "scale": scale,
        "tolerances": TOLERANCES,
        "data": {name: _data(data) for name, data in sorted(datasets.items())},
        "claims": list(map(_claim, subject.statements, findings)),
    }
    return formatting.as_json(content, indent=1) + "\n"


def _data(data: xr.Dataset) -> dict[str, Any]:
    """Return what a verdict rests on, of one experiment or study."""
    if "experiment" not in data.attrs:
        return {"study": data.attrs["title"]}
    counts = {name: int(data.attrs[name]) for name in ("particles", "points", "set_aside")}
    swept = {name: data.attrs[name] for name in ("swept",) if name in data.attrs}
    return counts | {"seeds": int(data.n_seeds.max()), "theory": data.attrs["theory"]} | swept


def _claim(statement: Statement, finding: Finding) -> dict[str, Any]:
    numbers = [{"label": label} | value.record() for label, value in finding.numbers]
    deciding = numbers[0] if numbers else {}
    return {
        "id": statement.name,
        "quote": statement.quote,
        "criterion": statement.criterion,
        "fixed": statement.fixed,
        "experiments": list(statement.experiments),
        "verdict": finding.verdict,
        "reason": finding.reason,
        "deviation": deciding.get("value"),
        "error": deciding.get("error"),
        "sigma": deciding.get("sigma"),
        "numbers": numbers,
    }


def as_markdown(subject: Subject, findings: list[Finding], scale: str) -> str:
    """Return a table of all verdicts, then the reasons and numbers of each, as Markdown."""
    count = Counter(finding.verdict for finding in findings)
    summary = ", ".join(f"{one} {count[one]}" for one in (HOLDS, QUALIFIED, FAILS, NOT_TESTED))
    rows = [(i, *row) for i, row in enumerate(zip(subject.statements, findings, strict=True), 1)]
    head = ("#", subject.quotes, "Deciding number", "Verdict")
    parts = [
        f"# {subject.title}",
        f"{subject.about}\n",
        HOW_TO_READ.format(**TOLERANCES),
        f"Sizes and run lengths: those of the scale `{scale}` in config.yaml.",
        f"Of {len(rows)} statements: {summary}.",
        formatting.markdown(head, [_cells(*row) for row in rows]).rstrip(),
        *([subject.after] if subject.after else []),
        "## Reasons and numbers",
        *(_details(*row) for row in rows),
    ]
    return "\n\n".join(parts) + "\n"


def _cells(number: int, statement: Statement, finding: Finding) -> tuple[object, ...]:
    deciding = "".join(f"{label}: {text(value)}" for label, value in finding.numbers[:1])
    return number, f"“{statement.quote}”", deciding, f"**{finding.verdict}**"


def _details(number: int, statement: Statement, finding: Finding) -> str:
    numbers = "".join(f"\n- {label}: {text(value)}" for label, value in finding.numbers)
    return (
        f"### {number}. {statement.name}: {finding.verdict}\n\n> {statement.quote}\n\n"
        f"{finding.reason}\n\n- criterion: {statement.criterion} Fixed {statement.fixed}.\n"
        f"- data: {', '.join(statement.experiments)}{numbers}"
    )
