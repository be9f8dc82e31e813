"""Tables for a terminal, in Markdown and as CSV, and strict JSON, written and read.

Texts of people and of files stay texts: in none of these do they become markup or a formula.
"""

import json
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NoReturn

from roughgas.base import InputError, on_one_line, shown

DIGITS = 19  # of a whole number: what 64 bits can hold
UNPRINTABLE = re.compile("[\x7f-\x9f\u200b-\u200f\u2028-\u202e\u2066-\u2069]")
"""Control characters that JSON may hold as they are; some of them move a terminal's cursor."""
FORMULAS = ("=", "+", "-", "@", "\t")
"""How a text begins that a spreadsheet takes for a formula."""


def columns(rows: Iterable[Sequence[str]], numbers: bool = False) -> str:
    """Return rows as aligned columns, all but the first to the right if they are `numbers`.

    A terminal gets no control characters from cells: they are escaped.
    """
    rows = [[on_one_line(cell) for cell in row] for row in rows]
    align = "<" + (">" if numbers else "<") * (len(rows[0]) - 1)
    return "\n".join("  ".join(row).rstrip() for row in _padded(rows, align))


def markdown(
    head: Iterable[str], rows: Iterable[Iterable[Any]], align: str = "", padded: bool = False
) -> str:
    """Return a Markdown table, with a newline at its end.

    `align` has a character for each column, < (the default) or >. A `padded` table can be read as
    it stands: cells of a column have one width.
    """
    table = [[_in_markdown(cell) for cell in row] for row in (head, *rows)]
    align = align or "<" * len(table[0])
    rule = ["---:" if side == ">" else "---" for side in align]
    if padded:
        table = _padded(table, align)
        rule = [f"{dashes[-1]:->{len(cell)}}" for cell, dashes in zip(table[0], rule, strict=True)]
    return "".join(f"| {' | '.join(row)} |\n" for row in (table[0], rule, *table[1:]))


def in_csv(value: Any) -> Any:
    """Return a value as a cell of a CSV table: a text that is a formula, behind an apostrophe."""
    if not isinstance(value, str) or _is_number(value):
        return value
    text = value.replace("\r", " ")  # which ends a row even where it is not quoted
    return f"'{text}" if text.startswith(FORMULAS) else text


def in_rst(text: str) -> str:
    """Return a text on one line that reStructuredText shows as it is."""
    return re.sub(r"([^\w\s])", r"\\\1", " ".join(text.split()))


def as_json(answer: Any, indent: int | None = 2) -> str:
    """Return strict JSON of dictionaries, lists, numbers, and numpy's scalars and arrays.

    Numbers that are not finite become null. Control characters, all of them, are escaped.
    """
    text = json.dumps(_plain(answer), indent=indent, ensure_ascii=False, allow_nan=False)
    return UNPRINTABLE.sub(lambda sign: f"\\u{ord(sign[0]):04x}", text)


def from_json(text: str, source: str) -> dict[str, Any]:
    """Return the JSON object that `text` is; `source` says in messages where it comes from.

    Raises InputError for anything else, for NaN and infinity, and for numbers beyond those of the
    kernel's 64 bits.
    """
    try:
        found = json.loads(text, parse_constant=_refuse, parse_int=_whole)
    except (ValueError, RecursionError) as error:
        raise InputError(source, shown(text), "be JSON, with numbers of up to 64 bits") from error
    if not isinstance(found, dict):
        raise InputError(source, shown(found), 'be a JSON object, {"key": value, ...}')
    return found


def _refuse(constant: str) -> NoReturn:
    raise ValueError(f"{constant} is not JSON")


def _whole(digits: str) -> int:
    if len(digits) > DIGITS:
        _refuse(digits)
    return int(digits)


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def _in_markdown(cell: Any) -> str:
    """Return a cell on one line; a bar would end it."""
    return " ".join(str(cell).splitlines()).replace("|", "\\|")


def _padded(rows: Sequence[Sequence[str]], align: str) -> list[list[str]]:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        [f"{cell:{side}{width}}" for cell, side, width in zip(row, align, widths, strict=True)]
        for row in rows
    ]


def _plain(answer: Any) -> Any:
    if isinstance(answer, dict):
        return {str(key): _plain(value) for key, value in answer.items()}
    if isinstance(answer, list | tuple):
        return [_plain(value) for value in answer]
    if hasattr(answer, "tolist"):
        return _plain(answer.tolist())
    if isinstance(answer, float) and not math.isfinite(answer):
        return None
    return answer


def as_text(settings: Mapping[str, Any]) -> str:
    """Return settings as JSON on one line, the same for equal settings."""
    return json.dumps(settings, sort_keys=True, separators=(",", ":"))
