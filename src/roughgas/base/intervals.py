"""Intervals of legal numbers."""

from typing import Any

from roughgas.base.errors import InputError


class Interval:
    """An interval from text such as `[0, 1]` or `(0, inf)`; a round bracket excludes the end.

    `low` and `high` are its ends.
    """

    def __init__(self, text: str) -> None:
        """Read the ends from `text`, which is taken to be well-formed."""
        self.text = text
        self.low, self.high = (float(end) for end in text[1:-1].split(","))

    def __str__(self) -> str:
        """Return the interval as text, such as `[0, 1]`."""
        return self.text

    def holds(self, value: Any) -> Any:
        """Return whether `value` lies in the interval, for each element of an array (NaN: no)."""
        above = value >= self.low if self.text[0] == "[" else value > self.low
        below = value <= self.high if self.text[-1] == "]" else value < self.high
        return above & below

    def check(self, key: str, value: Any) -> float:
        """Return `value` as a float; raise InputError, with this `key`, if it lies outside."""
        if not self.holds(value):
            raise self.error(key, value)
        return float(value)

    def error(self, key: str, value: Any) -> InputError:
        """Return the InputError, with this `key`, of a `value` outside the interval."""
        return InputError(key, value, self.legal)

    @property
    def legal(self) -> str:
        """The end of a message "it must ...": "lie in [0, 1]"."""
        return f"lie in {self}"


RESTITUTION = Interval("[0, 1]")
"""Normal restitution r."""
ROUGHNESS = Interval("[-1, 1]")
"""Roughness beta, from smooth (-1) to perfectly rough (1)."""
