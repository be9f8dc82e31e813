"""How far long work is, and how much longer it will take.

There is a bar on a terminal and in a notebook; elsewhere, as in a pipe or a log, a line now and
then of what takes longer than PATIENCE.
"""

import sys
import threading
import time
import warnings
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self, TypeVar

if TYPE_CHECKING:
    from roughgas.scene import Scene

BAR = "{desc}: {percentage:3.0f}%|{bar}| {n_fmt} of {total_fmt}{unit}, {remaining} left{postfix}"
SECONDS_BETWEEN = 0.1  # looks of a bar
PATIENCE, LONGEST_SILENCE = 10.0, 60.0  # seconds until the first line, and between lines at last
PLACING = "placing particles"
NOTEBOOK = "ipykernel"  # a notebook has imported it
Item = TypeVar("Item")


class Bar:
    """How much of a known amount of work is done."""

    def __init__(
        self,
        name: str,
        total: float | None,
        unit: str = "",
        stream: Any = None,
        quiet: bool = False,
    ) -> None:
        """`unit` is that of `total`, which is None where it is not known yet."""
        self._bar, self._stream = None, sys.stderr if stream is None else stream
        self._name, self._done, self._total, self._unit, self._note = name, 0.0, total, unit, ""
        self._quiet, self._over = quiet, threading.Event()
        if not quiet and (NOTEBOOK in sys.modules or self._stream.isatty()):
            self._bar = _tqdm()(
                desc=name,
                total=total,
                unit=f" {unit}" if unit else "",
                bar_format=BAR,
                file=self._stream,
                leave=False,
                mininterval=SECONDS_BETWEEN,
                miniters=1,  # looks at the clock at every call
                dynamic_ncols=True,
            )

    def __enter__(self) -> Self:
        if self._bar is None and not self._quiet:
            threading.Thread(target=self._say_now_and_then, daemon=True).start()
        return self

    def __exit__(self, *_: object) -> None:
        """Clear the line."""
        self._over.set()
        if self._bar is not None:
            self._bar.close()

    def reach(self, done: float, note: str = "", total: float | None = None) -> None:
        """Show how much is done; `total` where it has become known."""
        self._done, self._note = done, note
        self._total = self._total if total is None else total
        if self._bar is None:
            return
        self._bar.total = self._total
        self._bar.set_postfix_str(note, refresh=False)
        if done == self._bar.n and note:
            self._bar.refresh()
        self._bar.update(done - self._bar.n)

    def advance(self) -> None:
        """Show that one more is done."""
        self.reach(self._done + 1)

    def _say_now_and_then(self) -> None:
        begun, wait = time.perf_counter(), PATIENCE
        while not self._over.wait(wait):
            with suppress(OSError, ValueError):  # nobody reads, or the stream is closed
                self.say(f"{self._how_far()}, {time.perf_counter() - begun:.0f} s so far")
            wait = min(1.5 * wait, LONGEST_SILENCE)

    def _how_far(self) -> str:
        of = "at work" if self._total is None else f"{self._done:g} of {self._total:g}"
        note = f" ({self._note})" if self._note else ""
        return f"{self._name}: {of} {self._unit}".rstrip() + note

    def say(self, text: str) -> None:
        """Write a line that stays."""
        if self._bar is None:
            print(text, file=self._stream, flush=True)
        else:
            self._bar.write(text, file=self._stream)


class Progress(Bar):
    """How far the simulations of one point are, all replicas together.

    In T, or in collisions per particle if the gas cools.
    """

    def __init__(
        self,
        name: str,
        scene: "Scene",
        experiment: Mapping[str, Any],
        stream: Any = None,
        quiet: bool = False,
    ) -> None:
        from roughgas.simulation import schedule

        self._running = name
        self._particles, self._kind = experiment["particles"], schedule.of(experiment)
        self._before = self._now = 0.0  # lengths: of the simulations that are over, of this one
        total = round(self._kind.length(scene, experiment))
        super().__init__(f"{name} ({PLACING})", total, self._kind.UNIT, stream, quiet)

    def stage(self, doing: str) -> None:
        """Say what is done before the first simulation."""
        if self._name != self._running:
            self._call(f"{self._running} ({doing})")

    def expect(self, length: float) -> None:
        """Say that there will be more than the schedule says, or less."""
        self.reach(self._done, self._note, round(length))

    def _call(self, name: str, refresh: bool = True) -> None:
        self._name = name
        if self._bar is not None:
            self._bar.set_description_str(name, refresh=refresh)

    def __call__(self, simulated: float, collisions: int) -> None:
        """Report simulated time (T) and collisions of the present simulation so far."""
        if self._name != self._running:
            self._call(self._running, refresh=collisions == 0)
            if self._bar is not None:
                self._bar.unpause()  # how long compiling took says nothing of the simulation
        now = simulated if self._kind.DRIVEN else 2.0 * collisions / self._particles
        if now < self._now:  # another one has begun
            self._before += self._now
        self._now = now
        self.reach(round(self._before + now))


class FilmProgress(Bar):
    """How far a film is; where there is no terminal, as in a log, also at each checkpoint."""

    def __init__(self, checkpoint: Path, frames: int, stream: Any = None) -> None:
        super().__init__("clustering", frames, "frames", stream)
        self._checkpoint, self._frames = checkpoint, frames
        self._saved = 0  # the frame of the last checkpoint
        self._begun: tuple[int, float] | None = None

    def fresh(self, why: str) -> None:
        """Report that the run starts afresh although there is a checkpoint."""
        self.say(f"clustering: {why}: starting afresh")

    def reached(self, frame: int, collisions: int, saved: bool) -> None:
        """Report frames and collisions so far; `saved`: a checkpoint now holds them."""
        if self._begun is None:
            self._begun = frame, time.monotonic()
            if self._bar is not None:  # frames made earlier say nothing of the speed
                self._bar.n = self._bar.initial = self._bar.last_print_n = frame
            if frame:
                self._saved = frame
                self.say(f"clustering: going on from {self._checkpoint}")
        text = f"{collisions:,} collisions"
        if saved:
            self._saved = frame
            if self._bar is None:
                left = self._left(frame)
                self.say(f"clustering: frame {frame} of {self._frames}, {text}{left}")
        self.reach(frame, text)

    def how_to_go_on(self) -> str:
        """Return what to tell a user who interrupts the run."""
        if self._saved:
            return f"the same command goes on from frame {self._saved} of {self._frames}"
        return "no checkpoint written yet: the same command begins anew"

    def _left(self, frame: int) -> str:
        """Return the time that is left, by the frames that this process has made."""
        begun, since = self._begun or (frame, 0.0)
        if frame == begun:
            return ""
        left = (time.monotonic() - since) / (frame - begun) * (self._frames - frame)
        minutes, seconds = divmod(round(left), 60)
        return f", {minutes} min {seconds:02} s left" if minutes else f", {seconds} s left"


def watched(
    name: str, total: int, unit: str, items: Iterable[Item], quiet: bool = False
) -> Iterator[Item]:
    """Yield the same items, and show a bar of how many there have been."""
    with Bar(name, total, unit, quiet=quiet) as bar:
        for item in items:
            yield item
            bar.advance()


def _tqdm() -> Any:
    """Return the bar that suits a notebook or a terminal, whose import is quicker.

    Without widgets a notebook has a bar of characters, of which tqdm would warn.
    """
    if NOTEBOOK not in sys.modules:
        from tqdm import tqdm

        return tqdm
    with warnings.catch_warnings(category=Warning, action="ignore"):
        from tqdm.auto import tqdm
    return tqdm
