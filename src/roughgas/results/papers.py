"""Papers of other groups, reproduced by studies: their statements with verdicts, lines, CPU time.

A study of a paper names it in its config.yaml. The table has a row for each statement; the page has
a row for each study, and the statements below.
"""

import csv
import json
import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from roughgas.base import from_json, markdown
from roughgas.base.files import write_text
from roughgas.base.text import with_minus_signs
from roughgas.data.reduced import read_reduced
from roughgas.results.comparison import write_table
from roughgas.statistics.estimates import Estimate

EXPERIMENTS = re.compile(r"^experiments:\n((?: .*\n|\n)*)", re.MULTILINE)
"""The experiments in config.yaml of a study: a block up to the next key."""
TITLE = "# Other people's papers\n\n"


class PaperRow(NamedTuple):
    """A statement of a paper with its verdict, and the study of the paper; all cells are text."""

    study: str
    paper: str  # authors, journal
    lines: str  # of experiments in config.yaml, without comments
    seconds: str  # CPU time of the study's simulations
    statement: str
    verdict: str
    label: str  # of the deciding number
    value: str
    error: str
    detectable: str  # smallest deviation that the test could have seen

    @property
    def seen(self) -> str:
        """The smallest deviation that the test could have seen, with two digits."""
        return f"{float(self.detectable):.2g}" if self.detectable else ""

    @property
    def deciding(self) -> str:
        """The deciding number with its error."""
        if not self.value:
            return ""
        error = float(self.error) if self.error else float("nan")
        return with_minus_signs(f"{Estimate(float(self.value), error)}")


def write(
    claims: Sequence[str], *, data: Sequence[str], studies: str, table: str, page: str
) -> None:
    """Write the table and the page of all papers.

    `claims` are the paths of claims.json in a folder named after the study, `data` those of all
    reduced datasets; `studies` is JSON, the paper and the folder of each study by name.
    """
    seconds: dict[str, float] = defaultdict(float)
    for gas in map(read_reduced, data):
        seconds[gas.attrs["experiment"].partition(".")[0]] += float(gas.kernel_seconds.sum())
    rows: list[PaperRow] = []
    texts = from_json(studies, "--studies")
    for path in map(Path, claims):
        name = path.parent.name
        verdicts = json.loads(path.read_text(encoding="utf-8"))["claims"]
        rows += rows_of_study(name, texts[name], verdicts, seconds[name])
    write_table([row._asdict() for row in rows], PaperRow._fields, table)
    write_text(page, TITLE + as_markdown(rows))


def rows_of_study(
    study: str, text: Mapping[str, str], claims: Iterable[Mapping], seconds: float
) -> list[PaperRow]:
    """Return the rows of a study, from its paper and folder, its verdicts and its CPU seconds."""
    about = (study, text["paper"], f"{experiment_lines(text['folder'])}", f"{seconds:.1f}")
    return [PaperRow(*about, *_verdict_cells(claim)) for claim in claims]


def _verdict_cells(claim: Mapping) -> list[str]:
    """Return the cells of an entry of claims.json, from `statement` on."""
    numbers = claim["numbers"]
    cells = [claim["id"].replace("_", " "), claim["verdict"]]
    deciding = (numbers[0]["label"], claim["deviation"], claim["error"]) if numbers else ("",) * 3
    return [*cells, *(_text(cell) for cell in (*deciding, claim["detectable"]))]


def _text(cell: object) -> str:
    """Return a text or number of JSON as a cell; "" for null."""
    return "" if cell is None else cell if isinstance(cell, str) else f"{cell:.6g}"


def experiment_lines(folder: str | Path) -> int:
    """Return the number of lines of experiments in config.yaml of the study in `folder`.

    Blank lines and comments do not count.
    """
    text = Path(folder, "config.yaml").read_text(encoding="utf-8")
    block = EXPERIMENTS.search(text)
    lines = block[1].splitlines() if block else ()
    return sum(1 for line in lines if line.strip() and not line.lstrip().startswith("#"))


def read(path: str | Path) -> list[PaperRow]:
    """Return the rows of a table of papers."""
    with open(path, newline="", encoding="utf-8") as file:
        return [PaperRow(**row) for row in csv.DictReader(file)]


def as_markdown(rows: Sequence[PaperRow]) -> str:
    """Return a table of the studies, and a table of the statements of each, Markdown."""
    sections = [
        f"## {study}\n\n{table_of_statements([row for row in rows if row.study == study])}"
        for study in dict.fromkeys(row.study for row in rows)
    ]
    return "\n".join([table_of_studies(rows), *sections])


def table_of_studies(rows: Sequence[PaperRow], link: str = "") -> str:
    """Return a table with a row for each study: paper, lines, verdicts, CPU seconds."""
    cells = []
    for study in dict.fromkeys(row.study for row in rows):
        own = [row for row in rows if row.study == study]
        counts = Counter(row.verdict for row in own)
        verdicts = ", ".join(f"{count} {verdict}" for verdict, count in counts.items())
        name = f"[{study}]({link.format(study=study)})" if link else study
        cells.append([name, own[0].paper, own[0].lines, verdicts, f"{float(own[0].seconds):.0f}"])
    head = ["study", "paper", "lines", "statements", "CPU seconds"]
    return markdown(head, cells)


def table_of_statements(rows: Sequence[PaperRow]) -> str:
    """Return a table with a row for each statement: its deciding number, its verdict."""
    cells = [[row.statement, row.label, row.deciding, row.seen, row.verdict] for row in rows]
    head = ["statement", "deciding number", "", "could have seen", "verdict"]
    return markdown(head, cells)
