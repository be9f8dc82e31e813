"""The page of published numbers beside ours: verdicts counted, sources tested for a bias, rows."""

from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from roughgas.base import markdown
from roughgas.base.files import write_text
from roughgas.results.comparison import TIERS, Row, read_rows
from roughgas.results.row_verdicts import (
    FALSE_DISCOVERIES,
    NO_ERROR,
    TESTED_SCALE,
    TESTED_SHARE,
    VERDICTS,
    Judgement,
    biases,
    detectable_share,
    judge,
)
from roughgas.statistics.estimates import POWER

Group = tuple[str, str, str]
"""Quantity, tier and source that the rows of a comparison share."""


class JudgedRow(NamedTuple):
    """A row of evidence and the judgement on it."""

    row: Row
    judgement: Judgement

    @property
    def verdict_text(self) -> str:
        """The verdict; with the difference in per cent if no error is published."""
        if self.judgement.verdict != NO_ERROR:
            return self.judgement.verdict
        theirs, ours = self.row.theirs.value, self.row.ours.value
        return f"differs by {100 * abs(ours / theirs - 1):.2g} %, no error published"


def write_page(input: str | Path, *, output: str | Path) -> None:
    """Write the rows in a CSV as a page of tables, Markdown."""
    title = "# Published numbers beside ours"
    write_text(output, f"{title}\n\n{as_markdown(read_rows(input))}")


def as_markdown(rows: Sequence[tuple[str, Row]]) -> str:
    """Return counts of verdicts, biases of sources, a summary of comparisons, and all rows.

    `rows` are (study, row) pairs; a comparison is made of the rows with the same quantity, tier and
    source. The text is Markdown.
    """
    all_rows = [row for _, row in rows]
    judged = [JudgedRow(*pair) for pair in zip(all_rows, judge(all_rows), strict=True)]
    groups: dict[Group, list[JudgedRow]] = {}
    for entry in judged:
        row = entry.row
        groups.setdefault((row.quantity, row.tier, row.source), []).append(entry)
    sections = [
        _counts(judged),
        "## Source by source",
        _biases(rows),
        "## Comparison by comparison",
        markdown(*_summary(groups.items())),
        "## Every row",
        *(_table(group, members) for group, members in groups.items()),
    ]
    return "\n\n".join(section.rstrip() for section in sections) + "\n"


def _counts(judged: Sequence[JudgedRow]) -> str:
    """Return a table of the numbers of rows by tier and verdict, below sentences on them."""
    count = Counter((entry.row.tier, entry.judgement.verdict) for entry in judged)
    sources = len({entry.row.source for entry in judged})
    lines: list[list[Any]] = []
    for tier, text in TIERS.items():
        members = [entry for entry in judged if entry.row.tier == tier]
        if members:
            by_verdict = [count[tier, verdict] for verdict in VERDICTS]
            levels = [m.judgement.level for m in members if not m.row.is_without_chance]
            lines.append([text, len(members), *by_verdict, _number(levels)])
    total = [sum(column) for column in zip(*(line[1:-1] for line in lines), strict=True)]
    head = ("What the published number is", "Rows", *VERDICTS, "level")
    table = markdown(head, [*lines, ["all", *total, ""]], "<>>>>>>>")
    return (
        f"{len(judged)} rows from {sources} {'source' if sources == 1 else 'sources'}. t is ours "
        "minus theirs in combined standard errors. A row differs if its probability by Student's "
        "t is at most the level of its tier, such that on average at most "
        f"{100 * FALSE_DISCOVERIES:g} % of the differing rows do so by chance (Benjamini & "
        f"Hochberg). Detectable is the smallest deviation found with probability {POWER:g}; where "
        f"it exceeds {100 * TESTED_SHARE:g} % of the published number, or "
        f"{TESTED_SHARE * TESTED_SCALE:g} for numbers below {TESTED_SCALE:g}, a row is not tested "
        f"unless it differs. It is not known without an error of ours.\n\n{table}"
    )


def _number(levels: Iterable[float]) -> str:
    """Return the level that the rows of a tier share, as text; empty if none has one."""
    finite = [level for level in levels if np.isfinite(level)]
    return f"{finite[0]:.2g}" if finite else ""


def _biases(rows: Sequence[tuple[str, Row]]) -> str:
    """Return a table with the mean of t over the rows of each source, below sentences on it."""
    head = ("Study", "Tier", "Source", "Rows", "Mean t", "Probability", "Common bias")
    lines = [
        (
            bias.study,
            bias.tier,
            bias.source,
            int(bias.mean.dof) + 1,
            f"{bias.mean:+.2f}",
            f"{bias.mean.probability:.2g}",
            "yes" if bias.is_common else "no",
        )
        for bias in biases(rows)
    ]
    return (
        "Mean of t over the rows of a source, with its error from their scatter, and the "
        "probability of such a mean by chance if the rows are independent. Rows along one curve "
        "or of one gas are not, so that the true probability is larger. Single contacts are left "
        "out.\n\n" + markdown(head, lines, "<<<>>><")
    )


def _summary(
    groups: Iterable[tuple[Group, list[JudgedRow]]],
) -> tuple[Sequence[str], list[Sequence[Any]]]:
    """Return head and lines of a table with a line for each comparison in `groups`."""
    head = ("Quantity", "Source", "Tier", "Rows", *map(str.capitalize, VERDICTS), "RMS t")
    head = (*head, "Detectable, median")
    lines: list[Sequence[Any]] = []
    for (quantity, tier, source), entries in groups:
        count = Counter(entry.judgement.verdict for entry in entries)
        t = np.array([entry.row.t for entry in entries])
        rms = float(np.sqrt(np.mean(t**2)))
        shares = [detectable_share(entry.row, entry.judgement) for entry in entries]
        median = f"{100 * float(np.median(shares)):.2g} %"
        counts = [count[verdict] for verdict in VERDICTS]
        lines.append((quantity, source, tier, len(entries), *counts, f"{rms:.2f}", median))
    return head, lines


def _table(group: Group, entries: Sequence[JudgedRow]) -> str:
    """Return a heading and a table of the rows of a comparison.

    A field with the same text in all rows stands above the table.
    """
    quantity, tier, source = group
    rows = [entry.row for entry in entries]
    shared = {field: _shared(rows, field) for field in ("read", "corrections", "reason")}
    description = "; ".join(text for text in (TIERS[tier], source, *shared.values()) if text)
    varying = [field for field, text in shared.items() if text is None]
    head = ("At", "Theirs", "Ours", "t", "Dof", "Probability", "Detectable", "Verdict")
    lines = [
        (
            row.at,
            f"{row.theirs}",
            f"{row.ours}",
            f"{row.t:+.1f}",
            f"{row.gap.dof:.3g}",
            f"{row.probability:.2g}",
            f"{100 * detectable_share(row, entry.judgement):.2g} %",
            entry.verdict_text,
            *(getattr(row, field) for field in varying),
        )
        for row, entry in zip(rows, entries, strict=True)
    ]
    columns = (*head, *(field.capitalize() for field in varying))
    table = markdown(columns, lines, "<>>>>>><" + "<" * len(varying))
    return f"### {quantity}\n\n{description}.\n\n{table}"


def _shared(rows: Sequence[Row], field: str) -> str | None:
    """Return the text of a field, given by its name, if all rows share it, else None."""
    texts = {getattr(row, field) for row in rows}
    return texts.pop() if len(texts) == 1 else None
