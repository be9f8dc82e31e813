"""What a person sees while one point runs: how far it is, in the terms of the simulation."""

import sys
import time
from collections.abc import Mapping
from typing import Any, Self

SECONDS_BETWEEN = 0.2


class Progress:
    """A line on a terminal that is overwritten as the simulation goes on; silent elsewhere."""

    def __init__(self, name: str, schedule: Mapping[str, Any], stream: Any = None) -> None:
        """`schedule` is that of the experiment `name`; a steady one says when it will be over."""
        self._name, self._end = name, ""
        if schedule["kind"] == "steady":
            self._end = f" of {schedule['equilibrate'] + schedule['measure']:,g}"
        self._stream = sys.stderr if stream is None else stream
        self._shown = self._stream.isatty()
        self._due = 0.0

    def __call__(self, simulated: float, collisions: int) -> None:
        """Show that `simulated` (in T) and so many `collisions` are over."""
        now = time.monotonic()
        if self._shown and now >= self._due:
            self._due = now + SECONDS_BETWEEN
            reached = f"t = {simulated:,.0f}{self._end} T"
            self._overwrite(f"{self._name}: {reached}, {collisions:,} collisions")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Clear the line."""
        if self._due:
            self._overwrite("")

    def _overwrite(self, text: str) -> None:
        self._stream.write(f"\r\x1b[K{text}")
        self._stream.flush()
