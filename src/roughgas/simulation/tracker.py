"""The base class of trackers, which receive the samples and frames of a run.

A leg is a stretch of a run with one sampling; a frame is a copy of the particles at an instant; a
batch holds the samples and frames of one call of the kernel.
"""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from roughgas.simulation.gas import Batch, Gas
    from roughgas.simulation.leg import Changes, Leg


class Tracker:
    """Receives the samples and frames of the gases of a run without changing them.

    Subclasses override some methods, which are called in this order: `begin` at the beginning of a
    leg, `take` after each call of the kernel, `end` after the last sample of a leg, and `finish`
    after the last sample of the last leg. The number of samples per call depends on the speed of
    the machine: no result may depend on it.
    """

    def expect(self, length: float) -> None:
        """Receive the total length of the run, in T or in collisions per particle."""

    def begin(self, gas: "Gas", leg: "Leg", changes: "Changes") -> None:
        """Receive the beginning of a leg; `changes` are arrays that describe its changes."""

    def frames(self, leg: "Leg") -> tuple[int, int]:
        """Return the first sample of a leg that needs a frame, and the interval of frames.

        Samples count from 1, and the interval is in samples; (0, 0) if no frame is needed. Batches
        may also have frames of other trackers: see `Batch.sample_of_frames`.
        """
        return 0, 0

    def take(self, gas: "Gas", leg: "Leg", batch: "Batch") -> None:
        """Receive the samples and frames of a call of the kernel, in a batch."""

    def end(self, gas: "Gas", leg: "Leg") -> None:
        """Receive the end of a leg, after its last sample; a target may prolong the last leg."""

    def finish(self, gas: "Gas") -> None:
        """Receive a gas at the end of its last leg."""

    def arrays(self) -> Mapping[str, np.ndarray]:
        """Return the arrays of the tracker by name, for a checkpoint."""
        return {}

    def restore(self, arrays: Mapping[str, np.ndarray]) -> None:
        """Restore the tracker from its arrays in a checkpoint; raise any error for invalid ones."""
