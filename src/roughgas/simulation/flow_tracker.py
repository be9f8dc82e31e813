"""The tracker of deviations from the linear flow profile that R assumes in a sheared gas.

The energy of any other flow counts as temperature in R. A run therefore measures its local flow
from time to time, and by how much R would grow if that flow were subtracted.
"""

import math
from collections.abc import Mapping

import numpy as np

from roughgas.observables import System
from roughgas.observables.flow import (
    PARTICLES_PER_CELL,
    ParticleMotion,
    cell_counts,
    flow_corrected_energies,
)
from roughgas.scene import Scene, assumes_flow
from roughgas.simulation import protocols
from roughgas.simulation.experiment import Experiment
from roughgas.simulation.frames import motions
from roughgas.simulation.free_flight import in_starting_order
from roughgas.simulation.gas import Batch, Gas
from roughgas.simulation.leg import Changes, Leg
from roughgas.simulation.tracker import Tracker
from roughgas.statistics.estimates import Estimate, mean_by_scatter

FLOW_SAMPLES = 10
"""Flow samples in a measurement of the planned length."""
BATCH_PARTICLES = 20_000
"""Particles in stored frames at which these are reduced together."""


class FlowTracker(Tracker):
    """Measures the local flow of a driven gas from time to time, and the shift of R that it causes.

    A flow sample is a sample of the gas with such a measurement.
    """

    def __init__(self, system: System, wait: int, every: int) -> None:
        """Measure the flow after every `every` samples of the gas, from the sample `wait` on."""
        self._system, self._wait, self._every, self._start_time = system, wait, every, 0.0
        self._cells = cell_counts(system, PARTICLES_PER_CELL)
        unity = np.ones(system.particles)
        self._identical_bodies = unity, (system.inertia or 0.0) * unity, unity
        self._motions: list[tuple[int, ParticleMotion]] = []  # (sample number, unreduced frame)
        self._shifts: list[tuple[int, float]] = []  # (sample number, shift of R)

    def begin(self, gas: Gas, leg: Leg, changes: Changes) -> None:
        """Store the time of the gas at the start of its leg."""
        self._start_time = gas.time

    def frames(self, leg: Leg) -> tuple[int, int]:
        """Request a frame at each flow sample."""
        return self._wait + self._every, self._every

    def take(self, gas: Gas, leg: Leg, batch: Batch) -> None:
        """Store the velocities of the particles in the frames of a batch at due flow samples."""
        since = batch.sample_of_frames - self._wait
        due = np.flatnonzero((since > 0) & (since % self._every == 0))
        if not len(due):
            return
        frames = batch.frames.at(due)
        body_quantities: tuple[np.ndarray, ...] = self._identical_bodies
        if (bodies := gas.state.bodies) is not None:
            quantities = bodies.mass, bodies.inertia, bodies.radius
            body_quantities = tuple(in_starting_order(gas.state, values) for values in quantities)
        position, velocity = motions(frames, gas.scene)
        for k, taken in enumerate(batch.sample_of_frames[due].tolist()):
            bodies_of_frame = (values[frames.label[k]] for values in body_quantities)
            spin = None if frames.spin is None else frames.spin[k]
            motion = ParticleMotion(position[k], velocity[k], spin, *bodies_of_frame)
            self._motions.append((taken, motion))
        if len(self._motions) * self._system.particles >= BATCH_PARTICLES:
            self._reduce()

    def _reduce(self):
        """Compute the shifts of R from the stored motions, and free these."""
        if not self._motions:
            return
        taken, motions = zip(*self._motions, strict=True)
        values = flow_corrected_energies(motions, self._system, self._cells).shift
        self._shifts += zip(taken, values.tolist(), strict=True)
        self._motions.clear()

    def shifts(self) -> list[tuple[int, float]]:
        """Return (sample number, shift of R) of each flow sample until now."""
        self._reduce()
        return self._shifts

    def arrays(self) -> dict[str, np.ndarray]:
        """Return the shifts of R and the start time as arrays by name, for a checkpoint."""
        return {
            "shifts": np.array(self.shifts()).reshape(-1, 2),
            "begun": np.array(self._start_time),
        }

    def restore(self, arrays: Mapping[str, np.ndarray]) -> None:
        """Restore the shifts of R and the start time of the same gas from a checkpoint."""
        self._motions.clear()
        self._start_time = arrays["begun"].item()
        self._shifts = [(int(taken), shift) for taken, shift in arrays["shifts"].tolist()]

    def shift(self, start: float) -> Estimate:
        """Return the mean increase of R if the local flow is subtracted, from `start` (T) on.

        Flow samples are far apart and count as independent.
        """
        first = round((start - self._start_time) / self._system.interval)
        shifts = np.array([shift for taken, shift in self.shifts() if taken > first])
        if not len(shifts):
            return Estimate(math.nan, math.nan, 0.0)
        return mean_by_scatter(shifts)


def has_flow(scene: Scene, system: System, experiment: Experiment) -> bool:
    """Return whether R assumes a linear flow, and its deviations can be measured.

    The latter takes spin, a planned length of the measurement (a steady schedule), and at least two
    cells with enough particles.
    """
    flow_is_assumed = assumes_flow(scene.effects) and scene.effects.spin is not None
    has_planned_length = experiment.schedule.kind == "steady"
    return (
        flow_is_assumed
        and has_planned_length
        and math.prod(cell_counts(system, PARTICLES_PER_CELL)) > 1
    )


def flow_tracker_of(scene: Scene, system: System, experiment: Experiment) -> FlowTracker | None:
    """Return a new tracker of deviations from the flow; None unless the gas `has_flow`."""
    if not has_flow(scene, system, experiment):
        return None
    timing, wait = experiment.schedule, protocols.protocol_of(experiment).wait(scene, experiment)
    return FlowTracker(
        system, wait, max(1, int(timing.measure / timing.sample_every / FLOW_SAMPLES))
    )
