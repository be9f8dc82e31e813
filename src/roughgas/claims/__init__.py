"""The verdict on McNamara & Luding (1998), from the datasets: statement by statement on the paper's
own experiments, and on the questions that it leaves open."""

from collections.abc import Iterable
from pathlib import Path

from roughgas.base.errors import InputError
from roughgas.base.files import write_text
from roughgas.claims import beyond, cooling, shear, vibration, walls
from roughgas.claims.beyond.proportion import FAR, NEAR
from roughgas.claims.evidence import load_all
from roughgas.claims.finding import Row, examine
from roughgas.claims.report import Subject, as_json, as_markdown

REFERENCE = """\
S. McNamara and S. Luding, *Energy nonequipartition in systems of inelastic, rough spheres*,
Phys. Rev. E 58, 2247 (1998)"""

PAPER = Subject(
    "The verdict on the paper",
    f"""{REFERENCE}: each statement on its own experiments, computed from the datasets.
""",
    "The paper says",
    (*vibration.STATEMENTS, *walls.STATEMENTS, *shear.STATEMENTS, *cooling.STATEMENTS),
    "What the paper leaves open is answered in `open_questions.md`, beside this file, by "
    "`snakemake extensions`.",
)

OPEN_QUESTIONS = Subject(
    "What the paper leaves open",
    f"""{REFERENCE}: what it names as work to be done, says without showing it, or has
as a parameter of its theory alone, computed from datasets of experiments that it does not have.

That a statement holds means that theory does there, or what the paper expects. Theory is
Eqs. (lun), (Goldshtein) and (K), and where a drive puts in rotation, or friction acts, the rate
equations behind them. In brackets: what a quotation is tested on. Where R spans decades, with
friction and over the moment of inertia, it must follow theory in proportion, too: agreement is
qualified where more than a few points are off by {NEAR:.0%} of it, and fails where by {FAR:.0%}.
""",
    "In the words of the paper",
    beyond.STATEMENTS,
)


def judge(
    reduced: Iterable[str | Path],
    json_path: str | Path,
    md_path: str | Path,
    subject: Subject = PAPER,
) -> list[Row]:
    """Judge every statement of a subject on the reduced datasets, and write the verdicts as JSON
    and Markdown.

    Statements whose experiments are not among the datasets are "not tested".
    Raises InputError where the datasets are of several scales.
    """
    datasets = load_all(reduced)
    scales = sorted({data.attrs["scale"] for data in datasets.values()})
    if len(scales) != 1:
        raise InputError("scale of the datasets", " and ".join(scales) or "none", "be one")
    rows = [examine(statement, datasets) for statement in subject.statements]
    write_text(json_path, as_json(subject, rows, datasets))
    write_text(md_path, as_markdown(subject, rows, datasets))
    return rows
