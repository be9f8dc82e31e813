"""Errors, intervals of legal numbers, the version, optional packages, and texts.

Texts are tables for a terminal, in Markdown and as CSV, and strict JSON, written and read. What
people and files say stays text: in none of these does it become markup or a formula.
"""

import json
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from importlib import import_module
from types import ModuleType
from typing import Any, NoReturn

LONGEST = 60  # characters of a value in a message
SIMILAR = 0.8  # from 0 to 1: how alike a name must be to one that is suggested instead


class InputError(ValueError):
    """An illegal value: `key` names it, `legal` completes the sentence "it must ...".

    Its text is one line: `restitution r = 1.5: must lie in [0, 1]`.
    """

    def __init__(self, key: str, value: object, legal: str) -> None:
        super().__init__(key, value, legal)
        self.key = key
        self.value = value
        self.legal = legal

    def __str__(self) -> str:
        return f"{self.key} = {self.value}: must {self.legal}"


class NeedsError(InputError):
    """A setting without another one that it needs, `needed`; its text: `effects.gravity needs a
    floor`."""

    def __init__(self, key: str, needed: str) -> None:
        super().__init__(key, "alone", f"come with {needed}")
        self.needed = needed

    def __str__(self) -> str:
        return f"{self.key} needs {self.needed}"


def shown(value: object) -> str:
    """Return a value as a message quotes it: as Python writes it, on one line, not too long."""
    text = " ".join(repr(value).split())
    return text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."


def on_one_line(text: str) -> str:
    """Return a text with newlines, and all else that cannot be printed, as Python writes them."""
    return "".join(sign if sign.isprintable() else repr(sign)[1:-1] for sign in text)


def not_one_of(key: str, value: object, known: Iterable[str]) -> InputError:
    """Return the error of a value that is not among the `known` ones, with a suggestion."""
    import difflib

    known = list(known)
    legal = f"be one of {', '.join(known)}"
    meant = difflib.get_close_matches(str(value).strip("'"), known, 1, SIMILAR)
    return InputError(key, value, f"{legal}; did you mean {meant[0]}?" if meant else legal)


class EndedEarlyError(RuntimeError):
    """A run that ended before it had made what was asked of it. Its text is one line."""


class CollapseError(EndedEarlyError):
    """Inelastic collapse: infinitely many contacts in a finite time."""


class JammedError(CollapseError):
    """A gas so dense that time hardly goes on."""


class SilentError(EndedEarlyError):
    """A gas so dilute, or so slow, that the collisions that were asked for do not come."""


class Interval:
    """An interval as text such as `[0, 1]` or `(0, inf)`; a round bracket leaves out the end."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.low, self.high = (float(end) for end in text[1:-1].split(","))

    def __str__(self) -> str:
        return self.text

    def holds(self, value: Any) -> Any:
        """Return whether `value`, or each element of an array, lies in the interval; NaN never."""
        above = value >= self.low if self.text[0] == "[" else value > self.low
        below = value <= self.high if self.text[-1] == "]" else value < self.high
        return above & below

    def check(self, key: str, value: Any) -> float:
        """Return `value` as a float; raise InputError where it is not a number in the interval."""
        if not self.holds(value):
            raise self.error(key, value)
        return float(value)

    def error(self, key: str, value: Any) -> InputError:
        """Return the error of a `value` outside the interval."""
        return InputError(key, value, self.legal)

    @property
    def legal(self) -> str:
        """The end of a message "it must ..."."""
        return f"lie in {self}"

    def schema(self) -> dict[str, Any]:
        """Return the interval as a JSON schema."""
        found: dict[str, Any] = {"type": "number"}
        found["minimum" if self.text[0] == "[" else "exclusiveMinimum"] = _as_whole(self.low)
        if self.high < float("inf"):
            found["maximum" if self.text[-1] == "]" else "exclusiveMaximum"] = _as_whole(self.high)
        return found


def _as_whole(number: float) -> int | float:
    return int(number) if number == int(number) else number


RESTITUTION = Interval("[0, 1]")
"""Normal restitution r."""
ROUGHNESS = Interval("[-1, 1]")
"""The roughness beta, from smooth (-1) to perfectly rough (1)."""


__version__ = "0.1.0"


EXTRAS = {
    "workflow": ("snakemake",),
    "figures": ("matplotlib",),
    "movies": ("imageio_ffmpeg",),
    "report": ("markdown_it", "jinja2"),
    "crate": ("rocrate",),
    "article": ("typst",),
    "trajectories": ("gsd",),
}
"""The packages, as they are imported, that each extra brings."""


class MissingExtra(ImportError):
    """A package that an extra would bring is not installed; the text is one line."""


def required(module: str) -> ModuleType:
    """Return a module of a package that an extra brings. Raises MissingExtra."""
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        said = remedy(error)
        if said is None:
            raise
        raise MissingExtra(said, name=error.name) from error


def remedy(error: ImportError) -> str | None:
    """Return what to install where an extra is missing; None for other errors."""
    package = (error.name or "").partition(".")[0]
    extra = next((name for name, brought in EXTRAS.items() if package in brought), None)
    if extra is None or not isinstance(error, ModuleNotFoundError | MissingExtra):
        return None
    return f"{package} is not installed: pip install 'roughgas[{extra}]'"


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


def merged(
    base: Mapping[str, Any], changes: Mapping[str, Any], removing: bool = True
) -> dict[str, Any]:
    """Return `base` with `changes` merged in at every depth.

    A change to None removes a key, unless `base` consists of changes, too, and None is to stay.
    """
    result = dict(base)
    for key, change in changes.items():
        if change is None and removing:
            result.pop(key, None)
        elif isinstance(change, Mapping):
            inner = result.get(key)
            result[key] = merged(inner if isinstance(inner, Mapping) else {}, change, removing)
        else:
            result[key] = change
    return result


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


SPECIES = "species."
OF_RADII = "mean", "deviation"
"""Keys of a distribution of radii."""


def names_of(settings: Mapping[str, Any]) -> list[str]:
    """Return what the species are called: by their index where they have no name."""
    return [str(one.get("name", k)) for k, one in enumerate(settings.get("species") or [])]


def holder(settings: Mapping[str, Any], part: str, key: str = "") -> dict[str, Any] | None:
    """Return what has a key of the species that `part`, such as species.heavy, names by name or by
    index: its distribution of radii, or itself; None without such a species."""
    named = dict(zip(names_of(settings), settings.get("species") or [], strict=True))
    one = named.get(part.removeprefix(SPECIES))
    radius = one.get("radius") if one else None
    return radius if key in OF_RADII and isinstance(radius, dict) else one
