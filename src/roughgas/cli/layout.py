"""How numbers are shown: with their errors, in columns, or as JSON for a script."""

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

DIGITS = 2  # of an error


def with_error(value: float, error: float) -> str:
    """Such as 0.3565(30), the error in units of the last digit; six digits where it has none."""
    if not (math.isfinite(value) and math.isfinite(error) and error > 0.0):
        return f"{value:.6g}"
    exponent = _exponent(max(abs(value), error))
    if not -4 <= exponent < 6:
        scale = 10.0**exponent
        return f"{with_error(value / scale, error / scale)}e{exponent:+03}"
    decimals = decimals_of(error)
    if decimals < 0:
        return f"{round(value, decimals):.0f}({round(error, decimals):.0f})"
    shown = f"{error:.{decimals}f}" if error >= 1.0 else str(round(error * 10**decimals))
    return f"{value:.{decimals}f}({shown})"


def unit_of(attributes: Mapping[str, str]) -> str:
    """The unit of a variable with these attributes: of the gas's own ones, where it is in such."""
    return attributes.get("reduced_units", attributes["units"])


def decimals_of(error: float) -> int:
    """How many decimals of a number count that has this error, > 0; negative for tens and so on."""
    return DIGITS - 1 - _exponent(float(f"{error:.{DIGITS - 1}e}"))


def columns(rows: Iterable[Sequence[str]], numbers: bool = False) -> str:
    """Rows as aligned columns, all but the first to the right where they are `numbers`."""
    rows = list(rows)
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = []
    for row in rows:
        cells = [
            cell.rjust(width) if numbers and k else cell.ljust(width)
            for k, (cell, width) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append("  ".join(cells).rstrip())
    return "\n".join(lines)


def as_json(answer: Any, indent: int | None = 2) -> str:
    """Strict JSON of dictionaries, lists, numbers and numpy's scalars and arrays: what is not
    finite is null."""
    return json.dumps(_plain(answer), indent=indent, ensure_ascii=False, allow_nan=False)


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


def _exponent(number: float) -> int:
    return math.floor(math.log10(number))
