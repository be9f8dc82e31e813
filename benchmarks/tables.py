"""Tables of measurements, in Markdown that is readable as plain text."""

from collections.abc import Iterable, Sequence

from roughgas.base import markdown


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table, with numbers aligned to the right and words to the left."""
    rows = [list(row) for row in rows]
    columns = zip(*rows, strict=True)
    numbers = [all(cell[:1].isdigit() or cell == "nan" for cell in column) for column in columns]
    align = "".join(">" if number else "<" for number in numbers)
    return markdown(head, rows, align, padded=True).rstrip()


def short(rate: float) -> str:
    """Return a rate with three digits, such as 1.52e6."""
    return f"{rate:.2e}".replace("e+0", "e")
