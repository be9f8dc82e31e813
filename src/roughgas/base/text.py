"""Text formats: tables for a terminal, in Markdown and as CSV, reStructuredText, and strict JSON,
which is also read.

Text from users and files is escaped: it never becomes markup or a formula.
"""

import json
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NoReturn

from roughgas.base.errors import InputError, on_one_line, short_repr
from roughgas.base.mappings import NamedValues, Record

MAX_INTEGER_DIGITS = 19  # decimal digits of a 64-bit integer
UNPRINTABLE = re.compile("[\x7f-\x9f\u200b-\u200f\u2028-\u202e\u2066-\u2069]")
"""Control characters that JSON may hold unescaped; some of them move a terminal's cursor."""
CONTROL_CHARACTERS = re.compile("[\x00-\x1f\x7f-\x9f]")
PLAIN_WORD = re.compile(r"[-+.]?[^\W_]+(?:[-+._][^\W_]+)*")
"""Names and numbers, which reStructuredText needs no escapes for."""
BOLD = re.compile(r"\*\*([^*]+)\*\*")
COMMENT_BEGIN, COMMENT_END = "<!--", "-->"
FORMULA_PREFIXES = ("=", "+", "-", "@", "\t")
"""First characters by which a spreadsheet takes a text for a formula."""


def columns(rows: Iterable[Sequence[str]], numbers: bool = False) -> str:
    """Return rows of cells as aligned columns; with `numbers` all but the first column align right.

    Control characters in cells are escaped, so that they cannot reach a terminal.
    """
    rows = [[on_one_line(cell) for cell in row] for row in rows]
    align = "<" + (">" if numbers else "<") * (len(rows[0]) - 1)
    return "\n".join("  ".join(row).rstrip() for row in _padded(rows, align))


def markdown(
    head: Iterable[str], rows: Iterable[Iterable[Any]], align: str = "", padded: bool = False
) -> str:
    """Return a Markdown table of a `head` and rows of cells, with a newline at its end.

    `align` has a character for each column, < (the default) or >. In a `padded` table all cells of
    a column have the same width, for readers of the source.
    """
    table = [[_markdown_cell(cell) for cell in row] for row in (head, *rows)]
    align = align or "<" * len(table[0])
    rule = ["---:" if side == ">" else "---" for side in align]
    if padded:
        table = _padded(table, align)
        rule = [f"{dashes[-1]:->{len(cell)}}" for cell, dashes in zip(table[0], rule, strict=True)]
    return "".join(f"| {' | '.join(row)} |\n" for row in (table[0], rule, *table[1:]))


def with_minus_signs(number: str) -> str:
    """Return the text of a number with minus signs, U+2212, for its hyphens."""
    return number.replace("-", "−")


def without_comments(text: str) -> str:
    """Return Markdown without its comments `<!--...-->`; one that does not end stays.

    No regular expression does it: it would follow each begin to the end of a text.
    """
    begin, *rest = text.split(COMMENT_BEGIN)
    pieces = (piece.partition(COMMENT_END) for piece in rest)
    return begin + "".join(
        after if end else COMMENT_BEGIN + comment for comment, end, after in pieces
    )


def in_csv(value: Any) -> Any:
    """Return a value as a cell of a CSV table, safe from spreadsheets.

    Text that a spreadsheet takes for a formula gets an apostrophe in front. Numbers, also as text,
    stay.
    """
    if not isinstance(value, str) or _is_number(value):
        return value
    text = value.replace("\r", " ")  # would end a row even inside quotes
    return f"'{text}" if text.startswith(FORMULA_PREFIXES) else text


def in_rst(text: str) -> str:
    """Return a text on one line, escaped so that reStructuredText shows it verbatim.

    Control characters are replaced by spaces: docutils uses some internally.
    """
    line = _single_line(text)
    return line if PLAIN_WORD.fullmatch(line) else re.sub(r"([^\w\s]|_)", r"\\\1", line)


def in_rst_with_bold(text: str) -> str:
    """Return paragraphs escaped for reStructuredText; only **bold** stays markup."""
    return "\n\n".join(filter(None, map(_paragraph, re.split(r"\n[^\S\n]*\n", text))))


def _paragraph(text: str) -> str:
    r"""Return a paragraph in reStructuredText, as plain and bold words.

    The invisible `\ ` delimits bold markup.
    """
    segments = BOLD.split(text.strip())
    bold = [rf"\ **{in_rst(words)}**\ " if _single_line(words) else "" for words in segments[1::2]]
    plain = [_with_outer_spaces(words) for words in segments[::2]]
    alternating = [words for pair in zip(plain, [*bold, ""], strict=True) for words in pair]
    return "".join(alternating).strip().removesuffix("\\")


def _with_outer_spaces(text: str) -> str:
    """Return a text escaped by `in_rst`, but keep a space at either end."""
    return " " * text[:1].isspace() + in_rst(text) + " " * text[-1:].isspace()


def all_in_rst(value: Any) -> Any:
    """Return nested mappings and lists with all their texts, also keys, escaped by `in_rst`."""
    if isinstance(value, Mapping):
        return {all_in_rst(key): all_in_rst(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [all_in_rst(inner) for inner in value]
    return in_rst(value) if isinstance(value, str) else value


def without_markup(text: str) -> str:
    """Return a text on one line that holds no HTML tag and no wildcard of Snakemake.

    An invisible word joiner follows each `<` or `{` that could begin one. Entities would not do:
    they show up wherever the text is not read as HTML.
    """
    return re.sub(r"<(?=[A-Za-z/!?])|\{", "\\g<0>\N{WORD JOINER}", _single_line(text))


def _single_line(text: str) -> str:
    """Return a text with control characters and runs of white space replaced by single spaces."""
    return " ".join(CONTROL_CHARACTERS.sub(" ", text).split())


def as_json(answer: Any, indent: int | None = 2) -> str:
    """Return strict JSON of mappings, lists, numbers, and numpy's scalars and arrays.

    Numbers that are not finite become null. All control characters are escaped. With `indent` None
    it is on one line.
    """
    text = json.dumps(_json_types(answer), indent=indent, ensure_ascii=False, allow_nan=False)
    return UNPRINTABLE.sub(lambda sign: f"\\u{ord(sign[0]):04x}", text)


def from_json(text: str, source: str) -> NamedValues:
    """Return the JSON object in `text` as a dictionary; messages call its origin `source`.

    Raises InputError for other JSON, for NaN and infinity, and for integers of more than 64 bits,
    which the kernel cannot hold.
    """
    try:
        content = json.loads(text, parse_constant=_refuse, parse_int=_integer)
    except (ValueError, RecursionError) as error:
        raise InputError(
            source, short_repr(text), "be JSON, with numbers of up to 64 bits"
        ) from error
    if not isinstance(content, dict):
        raise InputError(source, short_repr(content), 'be a JSON object, {"key": value, ...}')
    return content


def _refuse(constant: str) -> NoReturn:
    """Raise ValueError for a constant such as NaN, which JSON does not have."""
    raise ValueError(f"{constant} is not JSON")


def _integer(digits: str) -> int:
    """Return the integer of `digits`; raise ValueError for more than MAX_INTEGER_DIGITS."""
    if len(digits) > MAX_INTEGER_DIGITS:
        _refuse(digits)
    return int(digits)


def _is_number(text: str) -> bool:
    """Return whether a text is a finite number."""
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def _markdown_cell(cell: Any) -> str:
    """Return a cell of a Markdown table on one line, with vertical bars escaped."""
    return " ".join(str(cell).splitlines()).replace("|", "\\|")


def _padded(rows: Sequence[Sequence[str]], align: str) -> list[list[str]]:
    """Return rows with the cells of each column padded to the same width.

    `align` has a character for each column, < or >.
    """
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        [f"{cell:{side}{width}}" for cell, side, width in zip(row, align, widths, strict=True)]
        for row in rows
    ]


def _json_types(answer: Any) -> Any:
    """Return nested values as JSON types: arrays as lists, keys as text, NaN as None.

    Infinity becomes None, too.
    """
    if isinstance(answer, dict):
        return {str(key): _json_types(value) for key, value in answer.items()}
    if isinstance(answer, list | tuple):
        return [_json_types(value) for value in answer]
    if hasattr(answer, "tolist"):
        return _json_types(answer.tolist())
    if isinstance(answer, float) and not math.isfinite(answer):
        return None
    return answer


def sorted_json(settings: Record) -> str:
    """Return settings as JSON on one line with sorted keys: equal settings have equal texts."""
    return json.dumps(settings, sort_keys=True, separators=(",", ":"))
