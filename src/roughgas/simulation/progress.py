"""How far long work is, and how much longer it will take.

There is a bar of tqdm on a terminal and in a notebook; elsewhere, as in a pipe or a log, a line a
minute of what takes longer than PATIENCE. There tqdm is not imported, which would take 0.07 s.
"""

import math
import sys
import time
import warnings
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Self, TypeVar

if TYPE_CHECKING:
    from roughgas.scene import Scene

BAR = "{desc}: {percentage:3.0f}%|{bar}| {unit}, {remaining} left{postfix}"  # unit: see `_told`
SECONDS_BETWEEN = 0.1  # looks of a bar
PATIENCE, SILENCE = 10.0, 60.0  # seconds until the first line, and between lines
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
        self._stream = sys.stderr if stream is None else stream
        self._name, self._total, self._unit = name, total, f" {unit}" if unit else ""
        self._done = 0.0
        self._begun = time.monotonic()
        self._next = math.inf if quiet else self._begun + PATIENCE
        self._bar: Any = None
        if not quiet and (NOTEBOOK in sys.modules or self._stream.isatty()):
            self._bar = _tqdm()(
                desc=name,
                total=total,
                unit=self._told(),
                bar_format=BAR,
                file=self._stream,
                leave=False,
                mininterval=SECONDS_BETWEEN,
                miniters=0,  # looks at the clock at every call
                dynamic_ncols=True,
            )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Clear the line."""
        if self._bar is not None:
            self._bar.close()

    def say(self, text: str) -> None:
        """Print a line above the bar."""
        if self._bar is not None:
            self._bar.write(text, file=self._stream)
        else:
            self._print(text)

    def reach(
        self,
        done: float,
        note: str = "",
        total: float | None = None,
        share: float | None = None,
    ) -> None:
        """Show how much is done; `total` where it has become known, and the `share` of the work,
        where that is not done / total, as of parts that take unequal times. Work that exceeds its
        total is shown as all of it: the total was an estimate."""
        self._total = self._total if total is None else total
        known = self._total or 0.0
        self._done = done = min(done, known) if known else done
        if share is None:
            share = done / known if known else 0.0
        share = min(share, 1.0)
        if self._bar is not None:
            self._bar.total, self._bar.unit = self._total, self._told()
            self._bar.set_postfix_str(note, refresh=False)
            self._bar.update((share * known or done) - self._bar.n)
        elif (now := time.monotonic()) > self._next:
            self._next = now + SILENCE
            told, elapsed = f"{self._told()}{note and f' ({note})'}", now - self._begun
            left = f", about {elapsed * (1.0 - share) / share:.0f} s left" if share else ""
            percentage = f"{100 * share:.0f} %, " if share else ""
            self._print(f"{self._name}: {percentage}{told}, {elapsed:.0f} s so far{left}")

    def _told(self) -> str:
        total = "?" if self._total is None else f"{self._total:.0f}"
        return f"{self._done:.0f} of {total}{self._unit}"

    def _print(self, text: str) -> None:
        with suppress(OSError, ValueError):  # nobody reads, or the stream is closed
            print(text, file=self._stream, flush=True)


class Progress(Bar):
    """How far the simulation of one point is, all replicas together.

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

        self._running, self._before, self._now = False, 0.0, 0.0
        self._particles, self._kind = experiment["particles"], schedule.of(experiment)
        total = round(self._kind.length(scene, experiment))
        super().__init__(f"{name} (placing particles)", total, self._kind.UNIT, stream, quiet)
        self._name = name

    def stage(self, doing: str) -> None:
        """Say what is done before the first simulation."""
        if self._bar is not None and not self._running:
            self._bar.set_description_str(f"{self._name} ({doing})")

    def expect(self, length: float) -> None:
        """Say that there will be more than the schedule says, or less."""
        self.reach(self._done, total=round(length))

    def __call__(self, simulated: float, collisions: int) -> None:
        """Report simulated time (T) and collisions of the present simulation so far."""
        if self._bar is not None and not self._running:
            self._bar.set_description_str(self._name, refresh=collisions == 0)
            self._bar.unpause()  # how long compiling took says nothing of the simulation
        self._running = True
        now = simulated if self._kind.DRIVEN else 2.0 * collisions / self._particles
        if now < self._now:  # another one has begun
            self._before += self._now
        self._now = now
        self.reach(round(self._before + now))


def watched(
    name: str, total: int, unit: str, items: Iterable[Item], quiet: bool = False
) -> Iterator[Item]:
    """Yield the same items, and show a bar of how many there have been."""
    with Bar(name, total, unit, quiet=quiet) as bar:
        for done, item in enumerate(items, 1):
            yield item
            bar.reach(done)


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
