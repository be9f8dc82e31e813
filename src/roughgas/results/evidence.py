"""Published numbers beside ours: rows of evidence, their verdicts, and the tables of them.

A row is a CSV line, so that each can be held against its source. All rows stay, whatever they say.
"""

import csv
import math
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from roughgas.base import InputError, in_csv, markdown
from roughgas.base.files import whole_file, write_text
from roughgas.statistics.errors import SIGNIFICANT, Estimate

TIERS = {
    "exact": "exact result",
    "simulation": "another group's simulation",
    "experiment": "experiment",
    "theory": "approximate theory",
    "own": "second code of our own",
}
"""What published numbers are, the weightiest first."""
AGREES, DIFFERS, NOT_KNOWN = "agrees", "differs", "not known"
VERDICTS = (AGREES, DIFFERS, NOT_KNOWN)
HEAD = (
    *("study", "quantity", "at", "tier", "source", "read", "theirs", "theirs_stderr"),
    *("ours", "ours_stderr", "ours_dof", "z", "verdict", "corrections", "reason"),
)


class Row(NamedTuple):
    """A published number beside ours, of a gas with the parameters `at`, such as "r = 0.9".

    An exact number has the error 0; the error that a source does not give is NaN.
    """

    quantity: str
    at: str
    tier: str  # a key of TIERS
    source: str  # authors, year, DOI
    read: str  # from which equation, figure, table or file, and how
    theirs: Estimate
    ours: Estimate
    corrections: str = ""  # that ours has had, for size or packing, and how large they are
    reason: str = ""  # what is known of why the numbers differ

    @property
    def gap(self) -> Estimate:
        """Ours minus theirs; an error that the source does not give counts as 0."""
        error = np.nan_to_num(self.theirs.stderr)
        return self.ours.minus(self.theirs._replace(stderr=float(error)))

    @property
    def z(self) -> float:
        """Student's t of the gap, as the Gaussian z of the same probability; NaN without our error.

        The degrees of freedom of the combined error follow Welch and Satterthwaite, and published
        errors have infinitely many. z equals the gap in combined standard errors only if
        the degrees of freedom are many: with 3 of them, 9.8 errors are z = 3.
        """
        return self.gap.sigma

    @property
    def is_lenient(self) -> bool:
        """Whether the numbers agree in z, but are SIGNIFICANT combined standard errors apart."""
        gap = self.gap
        return self.verdict == AGREES and abs(gap.value) >= SIGNIFICANT * gap.stderr > 0.0

    @property
    def verdict(self) -> str:
        """Whether abs(z) is below SIGNIFICANT: a lack of evidence, not equality.

        Numbers without a published error agree if they do by our error alone. Otherwise the verdict
        is not known: such a row never differs.
        """
        if math.isnan(self.z):
            return NOT_KNOWN
        if abs(self.z) < SIGNIFICANT:
            return AGREES
        return NOT_KNOWN if math.isnan(self.theirs.stderr) else DIFFERS


def write_rows(study: str, rows: Iterable[Row], output: str | Path) -> None:
    """Write the rows of a study as CSV; raise ValueError for a tier that there is not."""
    _write([_cells(study, row) for row in rows], output)


def combine(inputs: Iterable[str | Path], *, output: str | Path) -> None:
    """Write the rows of all studies as one CSV."""
    _write([row for path in inputs for row in _read(path)], output)


def write_page(input: str | Path, *, output: str | Path) -> None:
    """Write the rows in a CSV as a page of tables, Markdown."""
    title = "# Published numbers beside ours"
    write_text(output, f"{title}\n\n{as_markdown(read_rows(input))}")


def read_rows(path: str | Path) -> list[tuple[str, Row]]:
    """Return the rows in a CSV, each behind the name of its study."""
    return [(cells["study"], _row(cells)) for cells in _read(path)]


def as_markdown(rows: Sequence[tuple[str, Row]]) -> str:
    """Return the counts of verdicts, a line for each comparison, and every row, as Markdown."""
    groups: dict[tuple[str, str, str], list[Row]] = {}
    for _, row in rows:
        groups.setdefault((row.quantity, row.tier, row.source), []).append(row)
    parts = [
        _counts([row for _, row in rows]),
        "## Comparison by comparison",
        markdown(*_summary(groups.items())),
        "## Every row",
        *(_table(key, members) for key, members in groups.items()),
    ]
    return "\n\n".join(part.rstrip() for part in parts) + "\n"


def _counts(rows: Sequence[Row]) -> str:
    """Return how many rows there are of each tier and verdict."""
    count = Counter((row.tier, row.verdict) for row in rows)
    sources = len({row.source for row in rows})
    of_sources = f"{sources} {'source' if sources == 1 else 'sources'}"
    lines = [
        [text, sum(of := [count[tier, one] for one in VERDICTS]), *of]
        for tier, text in TIERS.items()
        if any(row.tier == tier for row in rows)
    ]
    total = [sum(column) for column in zip(*(line[1:] for line in lines), strict=True)]
    head = ("What the published number is", "Rows", *VERDICTS)
    legend = f"{len(rows)} rows from {of_sources}. {_meaning_of_verdicts(rows)}"
    return f"{legend}\n\n{markdown(head, [*lines, ['all', *total]], '<>>>>')}"


def _meaning_of_verdicts(rows: Sequence[Row]) -> str:
    """Return sentences on z, and the numbers of rows whose verdict says little."""
    lenient = sum(row.is_lenient for row in rows)
    unpublished = sum(math.isnan(row.theirs.stderr) for row in rows)
    return (
        f"A row differs from |z| = {SIGNIFICANT:g} on; by chance one of 370 does. z is Student's t "
        "of ours minus theirs, as the Gaussian z of the same probability. "
        f"Rows that agree in z, but are {SIGNIFICANT:g} combined standard errors or more apart, by "
        f"errors with few degrees of freedom: {lenient}. "
        f"Rows without a published error, which agree or are not known, and never differ: "
        f"{unpublished}."
    )


def _summary(
    groups: Iterable[tuple[tuple[str, str, str], list[Row]]],
) -> tuple[Sequence[str], list[Sequence[Any]]]:
    head = ("Quantity", "Source", "Tier", "Rows", "Agree", "RMS z", "Combined error, median")
    lines: list[Sequence[Any]] = []
    for (quantity, tier, source), rows in groups:
        z = np.array([row.z for row in rows])
        rms = math.sqrt(np.mean(z**2)) if np.isfinite(z).all() else math.nan
        error = float(np.median([row.gap.stderr for row in rows]))
        agree = sum(row.verdict == AGREES for row in rows)
        lines.append((quantity, source, tier, len(rows), agree, f"{rms:.2f}", f"{error:.2g}"))
    return head, lines


def _table(key: tuple[str, str, str], rows: Sequence[Row]) -> str:
    """Return the rows of one comparison as a table below its heading."""
    quantity, tier, source = key
    shared = {part: _shared(rows, part) for part in ("read", "corrections", "reason")}
    said = "; ".join(text for text in (TIERS[tier], source, *shared.values()) if text)
    own = [part for part, text in shared.items() if text is None]
    head = ("At", "Theirs", "Ours", "z", "Verdict", *(part.capitalize() for part in own))
    lines = []
    for row in rows:
        numbers = f"{row.theirs}", f"{row.ours}", f"{row.z:+.1f}"
        lines.append([row.at, *numbers, row.verdict, *(getattr(row, part) for part in own)])
    return f"### {quantity}\n\n{said}.\n\n{markdown(head, lines, '<>>><' + '<' * len(own))}"


def _shared(rows: Sequence[Row], part: str) -> str | None:
    """Return the text that all rows share; None where they do not."""
    texts = {getattr(row, part) for row in rows}
    return texts.pop() if len(texts) == 1 else None


def _cells(study: str, row: Row) -> dict[str, Any]:
    if row.tier not in TIERS:
        raise ValueError(f"tier {row.tier!r} of {row.quantity}: must be one of {', '.join(TIERS)}")
    numbers = {
        "theirs": row.theirs.value,
        "theirs_stderr": row.theirs.stderr,
        "ours": row.ours.value,
        "ours_stderr": row.ours.stderr,
        "ours_dof": row.ours.dof,
        "z": row.z,
    }
    shown = {name: f"{float(one):.9g}" for name, one in numbers.items()}
    return row._asdict() | {"study": study, "verdict": row.verdict} | shown


def _row(cells: dict[str, str]) -> Row:
    theirs = Estimate(float(cells["theirs"]), float(cells["theirs_stderr"]))
    ours = Estimate(*(float(cells[name]) for name in ("ours", "ours_stderr", "ours_dof")))
    texts = {name: cells[name] for name in Row._fields if name not in ("theirs", "ours")}
    return Row(theirs=theirs, ours=ours, **texts)


def _write(rows: Iterable[dict[str, Any]], output: str | Path) -> None:
    with whole_file(output) as draft, open(draft, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(HEAD)
        table.writerows([in_csv(row[name]) for name in HEAD] for row in rows)


def _read(path: str | Path) -> Iterator[dict[str, str]]:
    with open(path, newline="", encoding="utf-8") as file:
        table = csv.DictReader(file)
        if tuple(table.fieldnames or ()) != HEAD:
            raise InputError("table of evidence", path, f"have the columns {', '.join(HEAD)}")
        yield from ({key: text.removeprefix("'") for key, text in row.items()} for row in table)
