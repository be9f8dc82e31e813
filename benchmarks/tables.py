"""Markdown tables that can be read as they stand."""

from collections.abc import Iterable, Sequence


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table that can be read as it stands: numbers to the right, words to the left."""
    rows = [list(row) for row in rows]
    widths = [max(len(row[k]) for row in [heads, *rows]) for k in range(len(heads))]
    left = [
        not all(row[k][:1].isdigit() or row[k] == "nan" for row in rows) for k in range(len(heads))
    ]
    rule = [
        "-" * (width - 1) + ("-" if words else ":")
        for width, words in zip(widths, left, strict=True)
    ]
    lines = []
    for row in [heads, rule, *rows]:
        columns = zip(row, widths, left, strict=True)
        cells = [
            cell.ljust(width) if words else cell.rjust(width) for cell, width, words in columns
        ]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def short(rate: float) -> str:
    """A rate in three digits, such as 1.52e6."""
    return f"{rate:.2e}".replace("e+0", "e")
