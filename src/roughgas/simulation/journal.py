"""What a run has done so far, kept in a file beside its output, so that a killed run goes on.

Its settings and its seed determine the calls that a run makes of its gases: `Gas.in_time`,
`in_collisions`, `thermalise`, ... A journal has of each finished call the samples and the state of
the gas after it, and of the last, unfinished one the samples so far and the state now. The same
run, started again, gets the finished calls from the journal, goes on within the unfinished one, and
ends with the bits of a run that nothing has stopped.

The file is written every so many seconds: a run that takes less writes none.
"""

import json
import os
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from roughgas.base import Interval
from roughgas.simulation.energies import Columns
from roughgas.simulation.restart import UnusableCheckpoint, arrays_of, discard, read, write

if TYPE_CHECKING:
    from roughgas.simulation.gas import Gas
    from roughgas.simulation.recorder import Recorder

SECONDS = "ROUGHGAS_CHECKPOINT_SECONDS"  # in the environment: from one writing to the next
USUAL = "180"
LEGAL = Interval("[0, 1e9]")
COSTS = "seconds", "collisions", "touched"  # what a Recorder sums up
COUNTED = "ahead", "finished"


class Call(NamedTuple):
    """A call of a gas: what it has sampled, and what the gas is like after that."""

    rows: Columns
    state: Mapping[str, np.ndarray]
    looks: bytes  # what an observer has seen
    ahead: int  # samples since it looked last
    finished: bool


class Journal:
    """The calls of a run. What cannot be read, or is another run's, is not used: `refused` says
    why."""

    def __init__(self, path: str | Path, owner: str) -> None:
        """`owner` says which run this is, sources included. Raises InputError, OSError."""
        self.path, self.refused, self._owner = Path(path), "", owner
        self._every = _seconds(os.environ.get(SECONDS, USUAL))
        self._written = time.monotonic()
        self._calls: list[Call] = []
        self._costs: list[np.ndarray] = []
        self._next = 0
        try:
            self._read()
        except FileNotFoundError:
            pass
        except UnusableCheckpoint as error:
            self.refused = str(error)

    @property
    def begun(self) -> bool:
        """Whether a run has been on its way before."""
        return bool(self._calls)

    def recall(self, gas: "Gas") -> Call | None:
        """Bring a gas to where it was after its present call, and return that; None if the call
        has not been made before."""
        if self._next == len(self._calls):
            return None
        call = self._calls[self._next]
        for name, array in arrays_of(gas.state):
            array[...] = call.state[name]
        if gas.observer is not None and call.looks:
            gas.observer.restore(call.looks)
        self._next += 1
        if self._next == len(self._calls):
            for name, cost in zip(COSTS, self._costs, strict=True):
                setattr(gas.recorder, name, cost.item())
        if not call.finished:
            self._next -= 1
            self._calls.pop()
        return call

    def finish(self, gas: "Gas", rows: Columns) -> None:
        """Note that the present call has been made, and what it has sampled."""
        self._calls.append(_call(gas, rows, 0, finished=True))
        self._next += 1

    def due(self) -> bool:
        """Return whether it is time to write."""
        return time.monotonic() - self._written >= self._every

    def write(self, gas: "Gas", rows: Columns, ahead: int) -> None:
        """Write all calls, and the present one as far as it is. Raises OSError."""
        self._write(gas.recorder, [*self._calls, _call(gas, rows, ahead, finished=False)])

    def end(self, recorder: "Recorder") -> None:
        """Note the end of a run that has taken long: others of the same command may still be
        stopped. Raises OSError."""
        if self.path.exists():
            self._write(recorder, self._calls)

    def _write(self, recorder: "Recorder", calls: Sequence[Call]) -> None:
        content: dict[str, Any] = {f"costs.{name}": getattr(recorder, name) for name in COSTS}
        content |= {name: np.array([getattr(one, name) for one in calls]) for name in COUNTED}
        for number, call in enumerate(calls):
            content[f"{number}.looks"] = np.frombuffer(call.looks, np.uint8)
            content[f"{number}.columns"] = np.array(json.dumps(list(call.rows)))
            content[f"{number}.rows"] = np.array(list(call.rows.values()))
            content |= {f"{number}.state.{name}": one for name, one in call.state.items()}
        write(self.path, self._owner, content)
        self._written = time.monotonic()

    def discard(self) -> None:
        """Remove the file, which is no longer needed."""
        discard(self.path)

    def _read(self) -> None:
        content = read(self.path, self._owner)
        self._costs = [content[f"costs.{name}"] for name in COSTS]
        for number, counted in enumerate(zip(*(content[name] for name in COUNTED), strict=True)):
            names = json.loads(content[f"{number}.columns"].item())
            rows = dict(zip(names, content[f"{number}.rows"], strict=True))
            start = f"{number}.state."
            state = {
                name.removeprefix(start): array
                for name, array in content.items()
                if name.startswith(start)
            }
            looks = content[f"{number}.looks"].tobytes()
            self._calls.append(Call(rows, state, looks, *(one.item() for one in counted)))


def _seconds(text: str) -> float:
    try:
        return LEGAL.check(SECONDS, float(text))
    except ValueError:
        raise LEGAL.error(SECONDS, text) from None


def _call(gas, rows, ahead, finished):
    state = {name: array.copy() for name, array in arrays_of(gas.state)}
    looks = gas.observer.saved() if gas.observer else b""
    return Call(rows, state, looks, ahead, finished)
