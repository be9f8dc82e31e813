"""What a person sees while a simulation runs: how far it is, in the terms of the simulation."""

import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Self

SECONDS_BETWEEN = 0.2


class Line:
    """A line on a terminal that is overwritten again and again, and cleared in the end."""

    def __init__(self, name: str, stream: Any = None) -> None:
        self._name = name
        self._stream = sys.stderr if stream is None else stream
        self._shown = self._stream.isatty()
        self._due = 0.0

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Clear the line."""
        if self._due:
            self._overwrite("")

    def show(self, text: str) -> None:
        """Overwrite the line with the name and `text`, unless it has only just been written."""
        now = time.monotonic()
        if self._shown and now >= self._due:
            self._due = now + SECONDS_BETWEEN
            self._overwrite(f"{self._name}: {text}")

    def say(self, text: str) -> None:
        """Write a line that stays."""
        self.__exit__()
        self._stream.write(f"{self._name}: {text}\n")
        self._stream.flush()

    def _overwrite(self, text: str) -> None:
        self._stream.write(f"\r\x1b[K{text}")
        self._stream.flush()


class Progress(Line):
    """How far one point is; silent where there is no terminal."""

    def __init__(self, name: str, schedule: Mapping[str, Any], stream: Any = None) -> None:
        """`schedule` is that of the experiment `name`; a steady one says when it will be over."""
        super().__init__(name, stream)
        self._end = ""
        if schedule["kind"] == "steady":
            self._end = f" of {schedule['equilibrate'] + schedule['measure']:,g}"

    def __call__(self, simulated: float, collisions: int) -> None:
        """Show that `simulated` (in T) and so many `collisions` are over."""
        self.show(f"t = {simulated:,.0f}{self._end} T, {collisions:,} collisions")


class FilmProgress(Line):
    """How far a film is and how long it will take: a line for each checkpoint where there is no
    terminal, such as in a log."""

    def __init__(self, checkpoint: Path, frames: int, stream: Any = None) -> None:
        super().__init__("clustering", stream)
        self._checkpoint, self._frames = checkpoint, frames
        self._saved = 0  # the frame of the last checkpoint
        self._begun: tuple[int, float] | None = None

    def fresh(self, why: str) -> None:
        """The run begins anew, although there is a checkpoint."""
        self.say(f"{why}: starting afresh")

    def reached(self, frame: int, collisions: int, saved: bool) -> None:
        """So many frames and collisions are over; `saved`: a checkpoint now holds them."""
        if self._begun is None:
            self._begun = frame, time.monotonic()
            if frame:
                self._saved = frame
                self.say(f"going on from {self._checkpoint}")
        text = f"frame {frame} of {self._frames}, {collisions:,} collisions{self._left(frame)}"
        if saved:
            self._saved = frame
            if not self._shown:
                self.say(text)
        self.show(text)

    def how_to_go_on(self) -> str:
        """What somebody who interrupts the run is told."""
        if self._saved:
            return f"the same command goes on from frame {self._saved} of {self._frames}"
        return "no checkpoint written yet: the same command begins anew"

    def _left(self, frame: int) -> str:
        """The time that is left, as far as the frames made by this process tell."""
        begun, since = self._begun
        if frame == begun:
            return ""
        left = (time.monotonic() - since) / (frame - begun) * (self._frames - frame)
        minutes, seconds = divmod(round(left), 60)
        return f", {minutes} min {seconds:02} s left" if minutes else f", {seconds} s left"
