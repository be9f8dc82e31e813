"""How far long work is, and how long it will go on: bars on a terminal and in a notebook, nothing
elsewhere."""

import sys
import time
import warnings
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self, TypeVar

if TYPE_CHECKING:
    from roughgas.scene import Scene

BAR = "{desc}: {percentage:3.0f}%|{bar}| {n_fmt} of {total_fmt}{unit}, {remaining} left{postfix}"
SECONDS_BETWEEN = 0.1  # looks of a bar
NOTEBOOK = "ipykernel"  # what is imported where there is one
Item = TypeVar("Item")


class Bar:
    """How much of a known amount of work is done; silent where nobody would see it."""

    def __init__(
        self,
        name: str,
        total: float | None,
        unit: str = "",
        stream: Any = None,
        quiet: bool = False,
    ) -> None:
        """`unit` is that of `total`; None where the amount is not known yet."""
        self._bar, self._stream = None, sys.stderr if stream is None else stream
        if not quiet and (NOTEBOOK in sys.modules or self._stream.isatty()):
            self._bar = _tqdm()(
                desc=name,
                total=total,
                unit=f" {unit}" if unit else "",
                bar_format=BAR,
                file=self._stream,
                leave=False,
                mininterval=SECONDS_BETWEEN,
                miniters=1,  # looks at the clock whenever it is told something
                dynamic_ncols=True,
            )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Clear the line."""
        if self._bar is not None:
            self._bar.close()

    @property
    def shown(self) -> bool:
        """Whether there is something to see it on."""
        return self._bar is not None

    def reach(self, done: float, note: str = "", total: float | None = None) -> None:
        """So much is done; `total` where it has become known."""
        if self._bar is None:
            return
        if total is not None:
            self._bar.total = total
        self._bar.set_postfix_str(note, refresh=False)
        self._bar.update(done - self._bar.n)

    def advance(self, note: str = "") -> None:
        """One more is done."""
        if self._bar is not None:
            self.reach(self._bar.n + 1, note)

    def call(self, name: str) -> None:
        """Give it another name; what was done before says nothing of how fast work goes."""
        if self._bar is not None:
            self._bar.set_description_str(name, refresh=False)
            self._bar.unpause()

    def begin(self, done: float) -> None:
        """So much was done before: it says nothing of how fast work goes."""
        if self._bar is not None:
            self._bar.n = self._bar.initial = self._bar.last_print_n = done

    def say(self, text: str) -> None:
        """Write a line that stays."""
        if self._bar is None:
            print(text, file=self._stream, flush=True)
        else:
            self._bar.write(text, file=self._stream)


class Progress(Bar):
    """How far the simulations of one point are: in T, or in collisions per particle, of all seeds
    and all replicas together."""

    def __init__(
        self,
        name: str,
        scene: "Scene",
        experiment: Mapping[str, Any],
        seeds: int = 1,
        stream: Any = None,
        quiet: bool = False,
    ) -> None:
        """`experiment` must be complete: its schedule says how long it runs."""
        from roughgas.simulation import schedule

        self._name, self._compiling = name, True
        self._particles, self._kind = experiment["particles"], schedule.of(experiment)
        self._before = self._now = 0.0  # lengths: of the simulations that are over, of this one
        total = round(seeds * self._kind.length(scene, experiment["schedule"]))
        super().__init__(f"{name} (compiling)", total, self._kind.UNIT, stream, quiet)

    def __call__(self, simulated: float, collisions: int) -> None:
        """Report simulated time (T) and collisions of the present simulation so far."""
        if self._compiling:
            self._compiling = False
            self.call(self._name)
        now = self._kind.passed(simulated, collisions, self._particles)
        if now < self._now:  # another one has begun
            self._before += self._now
        self._now = now
        self.reach(round(self._before + now))


def watched(name: str, total: int, unit: str, items: Iterable[Item]) -> Iterator[Item]:
    """The same items; a bar says how many there have been."""
    with Bar(name, total, unit) as bar:
        for item in items:
            yield item
            bar.advance()


def _tqdm() -> Any:
    """The bar that suits a notebook or a terminal; it takes a tenth of a short job's time.

    Without widgets a notebook has a bar of characters, of which tqdm would warn.
    """
    if NOTEBOOK not in sys.modules:
        from tqdm import tqdm

        return tqdm
    from tqdm import TqdmWarning

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", TqdmWarning)
        from tqdm.auto import tqdm
    return tqdm


class FilmProgress:
    """How far a film is and how long it will take: a line for each checkpoint where there is no
    terminal, such as in a log."""

    def __init__(self, checkpoint: Path, frames: int, stream: Any = None) -> None:
        self._bar = Bar("clustering", frames, "frames", stream)
        self._checkpoint, self._frames = checkpoint, frames
        self._saved = 0  # the frame of the last checkpoint
        self._begun: tuple[int, float] | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Clear the bar."""
        self._bar.__exit__()

    def fresh(self, why: str) -> None:
        """The run begins anew, although there is a checkpoint."""
        self._bar.say(f"clustering: {why}: starting afresh")

    def reached(self, frame: int, collisions: int, saved: bool) -> None:
        """So many frames and collisions are over; `saved`: a checkpoint now holds them."""
        if self._begun is None:
            self._begun = frame, time.monotonic()
            self._bar.begin(frame)
            if frame:
                self._saved = frame
                self._bar.say(f"clustering: going on from {self._checkpoint}")
        text = f"{collisions:,} collisions"
        if saved:
            self._saved = frame
            if not self._bar.shown:
                where = f"frame {frame} of {self._frames}"
                self._bar.say(f"clustering: {where}, {text}{self._left(frame)}")
        self._bar.reach(frame, text)

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
