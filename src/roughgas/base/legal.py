"""Which numbers are legal: intervals, and the one check of a value against them."""

from typing import Any

from roughgas.base.errors import InputError


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
        found["minimum" if self.text[0] == "[" else "exclusiveMinimum"] = _plain(self.low)
        if self.high < float("inf"):
            found["maximum" if self.text[-1] == "]" else "exclusiveMaximum"] = _plain(self.high)
        return found


def _plain(number: float) -> int | float:
    return int(number) if number == int(number) else number


RESTITUTION = Interval("[0, 1]")
"""Normal restitution r."""
ROUGHNESS = Interval("[-1, 1]")
"""Roughness beta: smooth at -1, perfectly rough at 1."""
