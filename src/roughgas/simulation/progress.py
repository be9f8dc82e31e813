"""Progress of long work, with an estimate of the remaining time.

It is a bar of tqdm on a terminal and in a notebook; elsewhere, as in a pipe or a log, a line a
minute for work longer than FIRST_LINE_AFTER, without importing tqdm, which takes 0.07 s.
"""

import math
import sys
import time
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Self, TypeVar

import numpy as np

from roughgas.simulation.tracker import Tracker

if TYPE_CHECKING:
    from roughgas.scene import Scene
    from roughgas.simulation.experiment import Experiment
    from roughgas.simulation.gas import Batch, Gas
    from roughgas.simulation.leg import Changes, Leg

BAR_FORMAT = "{desc}: {percentage:3.0f}%|{bar}| {unit}, {remaining} left{postfix}"
BAR_INTERVAL = 0.1  # seconds between updates of a bar
FIRST_LINE_AFTER, LINE_INTERVAL = 10.0, 60.0  # seconds until the first line, and between lines
FIRST_ESTIMATE = 0.02  # share of the work before which compiling may have taken most of the time
NOTEBOOK = "ipykernel"  # module that is imported in notebooks
Item = TypeVar("Item")


class ProgressBar:
    """Shows the progress of work with a known total, as a bar or as lines."""

    def __init__(
        self,
        name: str,
        total: float | None,
        unit: str = "",
        stream: Any = None,
        quiet: bool = False,
    ) -> None:
        """Begin the display of work that is called `name`; `quiet` shows nothing.

        `total` is the amount of work, in the `unit` that the display names, and None if it is not
        known yet. `stream` is the text stream to write to, by default stderr.
        """
        self._stream = sys.stderr if stream is None else stream
        self._name, self._total, self._unit = name, total, f" {unit}" if unit else ""
        self._done = 0.0
        self._begun = time.monotonic()
        self._next = math.inf if quiet else self._begun + FIRST_LINE_AFTER
        self._bar: Any = None
        if not quiet and (NOTEBOOK in sys.modules or self._stream.isatty()):
            self._bar = _suitable_tqdm()(
                desc=name,
                total=total,
                unit=self._progress_text(),
                bar_format=BAR_FORMAT,
                file=self._stream,
                leave=False,
                mininterval=BAR_INTERVAL,
                miniters=0,  # looks at the clock at every call
                dynamic_ncols=True,
            )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Remove the bar from the terminal."""
        if self._bar is not None:
            self._bar.close()

    def say(self, text: str) -> None:
        """Print a line of text above the bar."""
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
        """Show that the amount `done` of the `total` is finished, with a `note` in words.

        `total` replaces an earlier one. `share` is the finished share of the time, by default done
        / total; it differs if parts of the work take unequal times. The total may be an estimate:
        work beyond it is shown as 100 %.
        """
        self._total = self._total if total is None else total
        known_total = self._total or 0.0
        self._done = done = min(done, known_total) if known_total else done
        if share is None:
            share = done / known_total if known_total else 0.0
        share = min(share, 1.0)
        if self._bar is not None:
            self._bar.total, self._bar.unit = self._total, self._progress_text()
            self._bar.set_postfix_str(note, refresh=False)
            self._bar.update((share * known_total or done) - self._bar.n)
        elif (now := time.monotonic()) > self._next:
            self._next = now + LINE_INTERVAL
            progress_text, elapsed = (
                f"{self._progress_text()}{note and f' ({note})'}",
                now - self._begun,
            )
            is_estimated = share >= FIRST_ESTIMATE
            left = f", about {elapsed * (1.0 - share) / share:.0f} s left" if is_estimated else ""
            percentage = f"{100 * share:.0f} %, " if share else ""
            self._print(f"{self._name}: {percentage}{progress_text}, {elapsed:.0f} s so far{left}")

    def _progress_text(self) -> str:
        """Return the finished amount of the total, with its unit, as text."""
        total = "?" if self._total is None else f"{self._total:.0f}"
        return f"{self._done:.0f} of {total}{self._unit}"

    def _print(self, text: str) -> None:
        """Print a line of text without a bar."""
        print_line(text, self._stream)


class RunProgress(ProgressBar, Tracker):
    """Shows the progress of the simulation of a point, averaged over its replicas.

    `name` is the title of the display; `stream` and `quiet` as in ProgressBar. The unit is T, or
    collisions per particle if the gas cools.
    """

    def __init__(
        self,
        name: str,
        scene: "Scene",
        experiment: "Experiment",
        stream: Any = None,
        quiet: bool = False,
    ) -> None:
        from roughgas.simulation import protocols

        self._running, self._before, self._now = False, 0.0, 0.0
        self._start = 0.0, 0  # time and collisions of the present gas as it starts
        self._gas = -1  # number of the present gas
        self._particles, self._kind = experiment.particles, protocols.protocol_of(experiment)
        self._length = self._kind.length(scene, experiment)  # summed over replicas, as `_before`
        self._has_replicas = hasattr(experiment.schedule, "replicas")
        replicas = experiment.schedule.replicas if self._has_replicas else 1
        self._length_of_gas = self._length / replicas
        title, unit = f"{name} (placing particles)", self._kind.UNIT
        super().__init__(title, round(self._length_of_gas), unit, stream, quiet)
        self._name = name

    def expect(self, length: float) -> None:
        """Replace the length of the schedule, summed over replicas, of which there may be more."""
        if not self._has_replicas:
            self._length_of_gas = length
        self._length = length
        self._show()

    def _show(self) -> None:
        """Show the finished length, averaged over replicas."""
        done = self._length_of_gas * (self._before + self._now) / self._length
        self.reach(round(done), total=round(self._length_of_gas))

    def begin(self, gas: "Gas", leg: "Leg", changes: "Changes") -> None:
        """Show that the kernel is compiled; count the time of a new gas from its start."""
        if self._bar is not None and not self._running:
            self._bar.set_description_str(f"{self._name} (compiling)")
        if gas.number != self._gas:
            self._gas, self._start = (
                gas.number,
                (gas.time, gas.collisions_before_cooling + gas.collisions),
            )
            self._before += self._now
            self._now = 0.0

    def take(self, gas: "Gas", leg: "Leg", batch: "Batch") -> None:
        """Show the progress of the run after a batch of samples."""
        if self._bar is not None and not self._running:
            self._bar.set_description_str(self._name, refresh=False)
            self._bar.unpause()  # the time of compiling does not count in estimates
        self._running = True
        time, collisions = self._start
        if self._kind.DRIVEN:
            self._now = float(batch.rows["time"][-1]) - time
        else:
            collisions_made = int(batch.rows["collisions"][-1]) - collisions
            self._now = 2.0 * collisions_made / self._particles
        self._show()

    def arrays(self) -> dict[str, np.ndarray]:
        """Return the progress of the run as arrays by name, for a checkpoint."""
        return {"run": np.array([self._before, self._now, *self._start, self._gas], float)}

    def restore(self, arrays: Mapping[str, np.ndarray]) -> None:
        """Restore the progress of the run from its arrays in a checkpoint."""
        self._before, self._now, time, collisions, number = arrays["run"].tolist()
        self._start, self._gas = (time, int(collisions)), int(number)


def print_line(text: str, stream: Any = None) -> None:
    """Print a line to a stream, by default stderr; ignore a closed stream or pipe."""
    with suppress(OSError, ValueError):  # the pipe has no reader, or the stream is closed
        print(text, file=sys.stderr if stream is None else stream, flush=True)


def with_progress_bar(
    name: str, total: int, unit: str, items: Iterable[Item], quiet: bool = False
) -> Iterator[Item]:
    """Yield the items, and show their number as progress towards `total`.

    `name` is the title of the display, and `unit` the name of an item in it.
    """
    with ProgressBar(name, total, unit, quiet=quiet) as bar:
        for done, item in enumerate(items, 1):
            yield item
            bar.reach(done)


def _suitable_tqdm() -> Any:
    """Return the class of bars for a notebook, or for a terminal."""
    if NOTEBOOK in sys.modules:
        from roughgas.simulation.notebook_bar import NotebookBar

        return NotebookBar
    from tqdm import tqdm

    return tqdm
