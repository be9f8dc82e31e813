"""The main loop: advances gases leg by leg, calls trackers, and writes checkpoints.

A gas has the number of its replica, or 0. A leg is a stretch of a run with one sampling and one
scene. A batch holds the samples of one call of the kernel.

A protocol (see roughgas.simulation.protocols) defines the gases and their legs. In a run that
resumes from a checkpoint, finished legs are skipped; the protocol repeats the same calls and does
not handle files.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TypeVar

import numpy as np

from roughgas.kernel.record import Sampling, columns
from roughgas.kernel.state import COLLISIONS
from roughgas.simulation.checkpoint import (
    STORED_KINDS,
    UNKNOWN_CONTENT,
    Checkpoint,
    restoring,
    under_prefix,
    with_prefix,
)
from roughgas.simulation.gas import Batch, Costs, Gas, Pace
from roughgas.simulation.leg import Leg
from roughgas.simulation.state_encoding import UnusableCheckpoint, decode, encode
from roughgas.simulation.tracker import Tracker

TrackerType = TypeVar("TrackerType", bound=Tracker)
GasFactory = Callable[[], Gas]
"""Makes a gas at its start."""
LegsFactory = Callable[[Gas], Sequence[Leg]]
"""Makes the legs of a started gas."""


class Simulation:
    """Advances the gases of a run through their legs, and calls its trackers.

    `trackers` are trackers by name; their names are prefixes of arrays in the checkpoint. `costs`
    is the sum over all gases.
    """

    def __init__(
        self,
        trackers: Mapping[str, Tracker] | None = None,
        checkpoint: Checkpoint | None = None,
    ) -> None:
        """Begin a run, or resume it from the content of a checkpoint.

        Raises UnusableCheckpoint.
        """
        self.trackers: dict[str, Tracker] = {}
        self.costs = Costs()
        self._checkpoint, self._pace = checkpoint, Pace()
        self._gas: Gas | None = None
        self._gas_number, self._leg_index, self._samples_taken, self._leg_has_begun = (
            -1,
            0,
            0,
            False,
        )
        self._is_last_leg = False  # whether the present leg is the last of its gas
        self._saved = dict(checkpoint.content) if checkpoint else {}
        if self._saved:
            with restoring():
                self._restore(self._saved)
        for name, tracker in (trackers or {}).items():
            self.track(name, tracker)

    def _restore(self, saved: Mapping[str, np.ndarray]) -> None:
        """Restore the position of the run (gas, leg, sample) and its costs from a checkpoint."""
        _require_valid(all(array.dtype.kind in STORED_KINDS for array in saved.values()))
        position = saved["position"]
        _require_valid(position.dtype.kind == "i" and bool((position >= 0).all()))
        self._gas_number, self._leg_index, self._samples_taken = map(int, position)
        self._leg_has_begun = True
        self.costs = Costs.of(under_prefix("costs", saved))
        _require_valid(all(math.isfinite(cost) and cost >= 0 for cost in self.costs))

    def track(self, name: str, tracker: TrackerType) -> TrackerType:
        """Add the tracker with this name, and return it.

        It is restored from its arrays in the checkpoint. Raises UnusableCheckpoint if it cannot be
        restored.
        """
        self.trackers[name] = tracker
        if self._saved:
            with restoring():
                tracker.restore(under_prefix(name, self._saved))
        return tracker

    @property
    def leg_index(self) -> int:
        """Index of the present leg of the present gas; a resumed run continues there."""
        return self._leg_index

    def expect(self, length: float) -> None:
        """Announce the total length of the run to the trackers, in T or collisions per particle."""
        for tracker in self.trackers.values():
            tracker.expect(length)

    def follow(self, number: int, start: GasFactory, legs: LegsFactory) -> Gas:
        """Advance the gas with this `number` to the end of its legs, and return it.

        `start` makes the gas, unless it is the present one; `legs` makes the legs of the started
        gas. The last leg of the present gas may be longer than in an earlier call. A gas that was
        finished before a run resumes is returned at its start.
        """
        if self._saved and number < self._gas_number:
            gas = start()
            gas.number = number
            return gas
        for _ in self.through(number, start, legs):
            pass
        return self._present_gas()

    def through(self, number: int, start: GasFactory, legs: LegsFactory) -> Iterator[Leg]:
        """Advance a gas through its legs, and yield each leg after its end.

        Arguments as in `follow`. Legs that were finished before a run resumes are yielded at once.
        """
        if self._gas is None or number != self._gas_number:
            self._gas = None  # free its memory before the next gas is made
            route = self._start_gas(number, start, legs)
        else:
            route = legs(self._gas)
        gas = self._present_gas()
        yield from route[: self._leg_index]
        while True:
            self._is_last_leg = self._leg_index + 1 == len(route)
            self._run_leg(gas, route[self._leg_index])
            yield route[self._leg_index]
            if self._is_last_leg:
                return
            self._leg_index, self._samples_taken, self._leg_has_begun = (
                self._leg_index + 1,
                0,
                False,
            )

    def finish(self) -> None:
        """Write the end of a run to its checkpoint, if it has one.

        The command of the run may be stopped later, in another point.
        """
        if self._gas and self._checkpoint and self._checkpoint.path.exists():
            self._checkpoint.write(self._content())

    def _present_gas(self) -> Gas:
        """Return the present gas, which must have been made."""
        assert self._gas is not None
        return self._gas

    def _start_gas(self, number, start, legs):
        """Make the gas with this `number`, restored if the run resumes in it, and return its legs.

        `start` and `legs` as in `follow`.
        """
        self._gas = gas = start()
        gas.number, gas.pace = number, self._pace
        route = legs(gas)
        if self._saved and number == self._gas_number:
            with restoring():
                gas.scene = route[self._leg_index].scene
                decode(under_prefix("state", self._saved), gas.state, gas.scene)
                gas.collisions_before_cooling, gas.sample = (
                    int(self._saved["begun"]),
                    under_prefix("sample", self._saved),
                )
                _check_gas(gas)
        else:
            _require_valid(not self._saved or number == self._gas_number + 1)
            self._gas_number, self._leg_index, self._samples_taken, self._leg_has_begun = (
                number,
                0,
                0,
                False,
            )
        self._saved = {}
        return route

    def _run_leg(self, gas: Gas, leg: Leg) -> None:
        """Advance a gas from its present sample to the end of a leg."""
        if not self._leg_has_begun:
            changes = leg.begin(gas) if leg.begin else {}
            gas.scene, self._leg_has_begun = leg.scene, True
            for tracker in self.trackers.values():
                tracker.begin(gas, leg, changes)
        while self._samples_taken < leg.samples:
            samples = leg.samples - self._samples_taken
            sampling: Sampling | None
            if isinstance(leg.sampling, Sampling):
                sampling = leg.sampling
            else:
                samples, sampling = 1, leg.sampling(gas)
            if sampling is None:
                self._end_leg(gas, leg)
                return
            sampling = self._with_frames(sampling, leg)
            sampling = sampling._replace(taken=sampling.taken + self._samples_taken)
            for batch in gas.batches(sampling, samples, leg.timed):
                self._dispatch(gas, leg, batch._replace(taken=self._samples_taken))

    def _dispatch(self, gas: Gas, leg: Leg, batch: Batch) -> None:
        """Pass a batch to the trackers, and write a checkpoint if one is due."""
        self._samples_taken += batch.samples
        self.costs = self.costs.plus(batch.costs)
        for tracker in self.trackers.values():
            tracker.take(gas, leg, batch)
        if self._samples_taken == leg.samples:
            self._end_leg(gas, leg)
        if self._checkpoint and self._checkpoint.due():
            self._checkpoint.write(self._content())

    def _end_leg(self, gas: Gas, leg: Leg) -> None:
        """Report the end of a leg, and of the gas after its last leg, to the trackers."""
        for tracker in self.trackers.values():
            tracker.end(gas, leg)
            if self._is_last_leg:
                tracker.finish(gas)

    def _with_frames(self, sampling: Sampling, leg: Leg) -> Sampling:
        """Return a leg's sampling with all frames that trackers request."""
        requests = [tracker.frames(leg) for tracker in self.trackers.values()]
        requests = [(first, every) for first, every in requests if every]
        if not requests:
            return sampling
        earliest = min(first for first, _ in requests)
        every = math.gcd(
            *(every for _, every in requests), *(first - earliest for first, _ in requests)
        )
        return sampling._replace(first=sampling.taken + earliest, every=every)

    def _content(self) -> dict[str, np.ndarray]:
        """Return the arrays of a checkpoint by name: position, gas, and trackers.

        The gas is the present one.
        """
        gas = self._present_gas()
        content = {
            "position": np.array([self._gas_number, self._leg_index, self._samples_taken]),
            "begun": np.array(gas.collisions_before_cooling),
            **with_prefix("costs", self.costs.arrays()),
            **with_prefix("sample", gas.sample),
            **with_prefix("state", encode(gas.state)),
        }
        for name, tracker in self.trackers.items():
            content |= with_prefix(name, tracker.arrays())
        return content


def _require_valid(holds: bool) -> None:
    """Raise UnusableCheckpoint unless a property of all valid checkpoints holds."""
    if not holds:
        raise UnusableCheckpoint(UNKNOWN_CONTENT)


def _check_gas(gas: Gas) -> None:
    """Raise UnusableCheckpoint for an impossible last sample or number of collisions."""
    _require_valid(0 <= gas.collisions_before_cooling <= int(gas.state.counts[COLLISIONS]))
    _require_valid(gas.sample.keys() == {*columns(gas.scene)})
    for column in gas.sample.values():
        _require_valid(column.shape == (1,) and column.dtype == float)
