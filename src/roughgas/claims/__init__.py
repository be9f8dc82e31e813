"""The verdict on McNamara & Luding (1998), from the datasets: statement by statement on the paper's
own experiments, and on the questions that it leaves open."""

from collections.abc import Iterable
from pathlib import Path

from roughgas.base.errors import InputError
from roughgas.base.files import write_text
from roughgas.claims.evidence import load
from roughgas.claims.report import as_json, as_markdown
from roughgas.claims.statements import Subject, examine, read_subject
from roughgas.claims.verdicts import Finding

PAPER, OPEN_QUESTIONS = read_subject("paper"), read_subject("open_questions")


def judge(
    reduced: Iterable[str | Path],
    json_path: str | Path,
    md_path: str | Path,
    subject: Subject = PAPER,
) -> list[Finding]:
    """Judge every statement of a subject on the reduced datasets; write JSON and Markdown.

    Statements whose experiments are not among the datasets are "not tested".
    Raises InputError where the datasets are of several scales.
    """
    loaded = [load(path) for path in reduced]
    datasets = {data.attrs["experiment"]: data for data in loaded}
    scales = sorted({data.attrs["scale"] for data in datasets.values()})
    if len(scales) != 1:
        raise InputError("scale of the datasets", " and ".join(scales) or "none", "be one")
    findings = [examine(statement, datasets) for statement in subject.statements]
    write_text(json_path, as_json(subject, findings, datasets))
    write_text(md_path, as_markdown(subject, findings, datasets))
    return findings
