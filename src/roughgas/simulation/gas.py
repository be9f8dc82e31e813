"""A gas: a scene, its state, and the methods that advance and sample it.

Here `per_particle` is a number of collisions per particle: each collision counts for both partners.
`Columns` are samples by column name (see roughgas.kernel.record.columns); a `Sampling` says when
the kernel takes samples. A batch holds the samples of one call of the kernel.

The caller of a Gas decides how far it advances and when it is sampled. Samples do not change the
state: the bits of a run do not depend on its division into calls of the kernel.
"""

import math
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple, Self

import numpy as np

from roughgas.base import NeedsError
from roughgas.kernel.loop import REACHED
from roughgas.kernel.record import RawFrames, Sampling, allocate_frames, columns, record
from roughgas.kernel.state import (
    ALTERED_RESTITUTIONS,
    COLLISIONS,
    EXPONENT,
    LAST_FIRST,
    LAST_SECOND,
    State,
)
from roughgas.scene import Scene, elastic
from roughgas.scene.initial import initial_state
from roughgas.scene.settings import SceneSettings
from roughgas.simulation import checkpoint
from roughgas.simulation.energies import CONTACT_SUMS, Columns, Energies, energies_of
from roughgas.simulation.energy_balance import EnergyBalance, balance
from roughgas.simulation.free_flight import positions_and_velocities
from roughgas.simulation.initial_states import InitialState, state_from
from roughgas.simulation.run_failures import (
    early_end_error,
    hit_limit,
    jam_error,
    jam_limit,
    time_of,
)

CALLS_PER_RUN = 50  # of the kernel, between which a run reports its progress
SHORTEST_CALL, LONGEST_CALL = 0.02, 0.5
"""Bounds of the duration of a call of the kernel, in seconds."""
PRESENT_SAMPLE = Sampling(0.0, 0, 0)
"""A sample of the present instant."""
FRAME_BYTES_PER_CALL = 2**21
"""Bytes of frames that a call may copy: larger amounts do not fit in the cache."""


def count(particles: int, per_particle: float) -> int:
    """Return the number of collisions in a gas that are `per_particle` per particle; at least one.

    `particles` is N.
    """
    return max(1, round(particles / 2 * per_particle))


class Costs(NamedTuple):
    """CPU time, number of collisions, and number of altered contacts of a simulation."""

    seconds: float = 0.0  # of CPU time in the kernel
    collisions: int = 0
    touched: int = 0  # contacts that the contact-time model made elastic

    @classmethod
    def of(cls, arrays: Mapping[str, np.ndarray]) -> "Costs":
        """Return the costs from their arrays by name, as in a checkpoint."""
        return cls(*(arrays[name].item() for name in cls._fields))

    def arrays(self) -> dict[str, np.ndarray]:
        """Return the costs as arrays by name."""
        return {name: np.array(cost) for name, cost in self._asdict().items()}

    def plus(self, other: "Costs") -> "Costs":
        """Return the sum of both costs."""
        return Costs(
            self.seconds + other.seconds,
            self.collisions + other.collisions,
            self.touched + other.touched,
        )


class Batch(NamedTuple):
    """The samples of one call of the kernel, the frames copied in it, and its costs."""

    rows: Columns  # name -> (samples,): see roughgas.kernel.record.columns
    frames: RawFrames
    costs: Costs
    taken: int = 0  # samples of the leg before these

    @property
    def samples(self) -> int:
        """Number of samples in the batch."""
        return len(self.rows["time"])

    @property
    def sample_of_frames(self) -> np.ndarray:
        """Number of the sample in its leg, from 1, for each frame, (k,)."""
        return self.taken + 1 + self.frames.rows


class Pace:
    """Adapts the number of samples per call of the kernel to its duration; no result depends on it.

    A call lasts at most about LONGEST_CALL, so that a run can be interrupted and reports progress.
    A run makes about CALLS_PER_RUN calls, or fewer that last SHORTEST_CALL.
    """

    def __init__(self) -> None:
        self._lengths: dict[Sampling, int] = {}  # samples of a call
        self._compiled: set[Scene] = set()

    def compile(self, state: State, scene: Scene) -> None:
        """Compile the kernel for a scene, or load it from the cache, before calls are timed."""
        if scene not in self._compiled:
            no_rows = np.empty((0, len(columns(scene))))
            record(state, scene, PRESENT_SAMPLE, no_rows, allocate_frames(state, 0))
            self._compiled.add(scene)

    def samples_of_call(self, sampling: Sampling, state: State) -> int:
        """Return the number of samples in the next call of the kernel with this sampling."""
        length = self._lengths.get(sampling, max(1, sampling.refresh))
        if not sampling.every:
            return length
        frame = sum(array.nbytes for array in allocate_frames(state, 1) if array is not None)
        return min(length, sampling.every * max(1, FRAME_BYTES_PER_CALL // frame))

    def adapt(self, sampling: Sampling, length: int, seconds: float, samples: int) -> None:
        """Adapt the length of calls to a call of `length` samples that took `seconds` (s).

        `samples` is the number of samples in the leg. The last call of a leg may have had fewer
        than `length`.
        """
        longer = length < samples and (
            seconds < SHORTEST_CALL or 2 * length * CALLS_PER_RUN <= samples
        )
        if seconds >= LONGEST_CALL:
            length = max(1, length // 2)
        self._lengths[sampling] = 2 * length if longer and seconds < LONGEST_CALL else length


class Gas:
    """A gas in a simulation: a scene, the kernel's state of its particles, and the costs.

    `sample` holds the columns of the last sample, arrays of length 1. A cooling gas is refreshed
    after every `refresh_every` collisions in the gas (0: never): its particles are advanced to one
    instant, and its velocities rescaled. `number` is the index of a replica of a point.
    """

    def __init__(self, scene: Scene, state: State) -> None:
        self.scene, self.state = scene, state
        self.costs, self.pace, self.number = Costs(), Pace(), 0
        self.sample: Columns = {}
        self.refresh_every = self.collisions_before_cooling = 0
        self._has_kernel_memory = False  # of an earlier run, which it continues
        self.extents = np.ptp(state.trajectory[:, : len(scene.box)], axis=0)

    @classmethod
    def start(
        cls,
        scene: Scene,
        experiment: SceneSettings,
        rng: np.random.Generator,
        initial: InitialState | None = None,
    ) -> Self:
        """Return a gas of the experiment's particles, in the `initial` state or on a lattice.

        `rng` draws the random numbers of the run. Raises InputError if the particles do not fit, or
        for an invalid memory in the initial state.
        """
        if initial is None:
            return cls(scene, initial_state(scene, experiment, rng))
        state, begun, extents = state_from(initial, scene, experiment, rng)
        gas = cls(scene, state)
        gas.extents = extents
        if begun is not None:
            gas.collisions_before_cooling, gas._has_kernel_memory = begun, True
        return gas

    @property
    def particles(self) -> int:
        """Number of particles, N."""
        return len(self.state.changes)

    @property
    def time(self) -> float:
        """Time since the start, in T."""
        return time_of(self.state)

    @property
    def collisions(self) -> int:
        """Number of collisions in the gas since the start, or since `cool` was called."""
        return int(self.state.counts[COLLISIONS]) - self.collisions_before_cooling

    def count(self, per_particle: float) -> int:
        """Return the collisions in the gas that are `per_particle` per particle; at least one."""
        return count(self.particles, per_particle)

    def batches(self, sampling: Sampling, samples: int, timed: bool = False) -> Iterator[Batch]:
        """Advance the gas by a number of `samples`, and yield the batch of each call of the kernel.

        `sampling.taken` is the number of earlier samples of the leg. Raises CollapseError if
        contacts accumulate without end, SilentError if particles no longer collide in a sample that
        lasts a number of collisions, JammedError if particles mostly hit walls, or if samples are
        `timed` and any of them has `sampling.collisions` or more.
        """
        self.pace.compile(self.state, self.scene)
        key = sampling._replace(taken=0)
        end = sampling.taken + samples
        while sampling.taken < end:
            length, begin = self.pace.samples_of_call(key, self.state), time.perf_counter()
            batch = self._call(sampling, min(length, end - sampling.taken), timed)
            if samples > 1:
                self.pace.adapt(key, length, time.perf_counter() - begin, samples)
            sampling = sampling._replace(taken=sampling.taken + batch.samples)
            yield batch

    def _call(self, sampling: Sampling, samples: int, timed: bool) -> Batch:
        """Call the kernel once, to take a number of `samples`, and return their batch.

        Raises the errors of `batches`.
        """
        state, scene = self.state, self.scene
        names, before = columns(scene), state.counts.copy()
        rows = np.empty((samples, len(names)))
        until = sampling.frames_until
        frames = allocate_frames(state, until(sampling.taken + samples) - until(sampling.taken))
        hits_allowed = hit_limit(samples, sampling.interval, self.particles)
        begin = time.process_time()
        ended, _ = record(state, scene, sampling._replace(hits=hits_allowed), rows, frames)
        seconds = time.process_time() - begin
        collisions, touched = (
            int(state.counts[k] - before[k]) for k in (COLLISIONS, ALTERED_RESTITUTIONS)
        )
        costs = Costs(seconds, collisions, touched)
        self.costs = self.costs.plus(costs)
        if ended != REACHED:
            raise early_end_error(ended, state, scene)
        if timed and collisions >= sampling.collisions:  # the sum over samples: test each
            if np.diff(rows[:, 1], prepend=before[COLLISIONS]).max() >= sampling.collisions:
                raise jam_error(state, sampling.interval)
        batch = Batch(dict(zip(names, rows.T, strict=True)), frames, costs)
        if samples:
            self.sample = {name: column[-1:] for name, column in batch.rows.items()}
        return batch

    def _columns_of(self, sampling: Sampling, samples: int, timed: bool = False) -> Columns:
        """Advance the gas by a number of `samples`, and return them as columns (samples,).

        `timed` and errors as in `batches`.
        """
        if samples == 0:
            self.pace.compile(self.state, self.scene)
            return {name: np.empty(0) for name in columns(self.scene)}
        return concatenated([batch.rows for batch in self.batches(sampling, samples, timed)])

    def thermalise(self, per_particle: float) -> None:
        """Advance the gas by `per_particle` collisions per particle, meanwhile smooth and elastic.

        Side walls are smooth and elastic, too.
        """
        scene, self.scene = self.scene, elastic(self.scene)
        try:
            self._columns_of(thermalisation_sampling(self.particles, per_particle), 1)
        finally:
            self.scene = scene

    def cool(self, refresh_every: int) -> None:
        """Start to cool: refresh the gas after every `refresh_every` collisions in the gas.

        `collisions` counts from here, unless the gas continues an earlier run.
        """
        self.refresh_every = refresh_every
        if not self._has_kernel_memory:
            self.collisions_before_cooling = int(self.state.counts[COLLISIONS])

    def in_time(self, interval: float, samples: int) -> Columns:
        """Advance the gas and return its samples, `interval` T apart, as columns (samples,).

        `samples` is their number. Raises the errors of `batches`.
        """
        return self._columns_of(timed_sampling(interval, self.particles), samples, timed=True)

    def in_collisions(self, collisions: int, samples: int) -> Columns:
        """Advance the gas and return its samples, a number of `collisions` apart, as columns.

        `collisions` in the gas must divide `refresh_every`; `samples` is the number of samples. The
        collisions to the next refresh count from the start of the call or, in the first call of a
        continued run, from the last refresh of the earlier run. A refresh changes the unit of
        velocity to 2^exponent a/T: see roughgas.simulation.energies.restored.
        """
        sampling = self.cooling_sampling(collisions)
        self._has_kernel_memory = False
        return self._columns_of(sampling, samples)

    def cooling_sampling(self, collisions: int) -> Sampling:
        """Return the sampling of a cooling gas, one sample after every `collisions` in the gas.

        A gas that continues an earlier run counts to its next refresh from the last one.
        """
        continues_refreshes = self._has_kernel_memory and self.refresh_every >= collisions
        collisions_since_refresh = (
            self.collisions % self.refresh_every if continues_refreshes else 0
        )
        samples_since_refresh = (
            0 if collisions_since_refresh % collisions else collisions_since_refresh // collisions
        )
        return Sampling(
            np.inf, collisions, self.refresh_every // collisions, taken=samples_since_refresh
        )

    def sample_now(self) -> None:
        """Take a sample of the present instant, and store it in `sample`."""
        self._columns_of(PRESENT_SAMPLE, 1)

    def refresh(self) -> None:
        """Take a sample, then bring all particles to the present instant, without momentum.

        Their total momentum is removed.
        """
        self._columns_of(Sampling(np.inf, 0, 1), 1)

    def step(self, until: float, collisions: int) -> bool:
        """Advance to the instant `until` (T) or by `collisions` in the gas, whichever comes first.

        A step also ends at the refresh of a cooling gas. Returns whether it ended by collisions.
        """
        initial_collisions, sampling = self.collisions, self.step_sampling(until, collisions)
        self._columns_of(sampling, 1)
        return self.collisions - initial_collisions == sampling.collisions

    def step_sampling(self, until: float, collisions: int) -> Sampling:
        """Return the sampling of one sample, at `until` (T) or after `collisions` if earlier.

        If a refresh of the gas is due earlier, the sample is taken there, and the refresh follows.
        """
        collisions_so_far, refresh_every = self.collisions, self.refresh_every
        limit = (
            min(collisions, refresh_every - collisions_so_far % refresh_every)
            if refresh_every
            else collisions
        )
        refreshes = bool(refresh_every) and (collisions_so_far + limit) % refresh_every == 0
        interval = (until - self.time) * 2.0 ** int(self.state.counts[EXPONENT])
        return Sampling(interval, limit, int(refreshes))

    def energies(self, columns: Columns) -> Energies:
        """Return the energies per degree of freedom of samples of this gas, (samples,).

        `columns` are the samples. Velocities are in the unit of the columns, 2^exponent a/T. In a
        sheared gas, and between walls that move along themselves, the mean flow and the mean spin
        are subtracted; in a bath whose medium rotates, the mean spin of each species.
        """
        return energies_of(columns, self.scene, self.state)

    def positions_and_velocities(self) -> tuple[np.ndarray, np.ndarray]:
        """Return copies of the present positions in a, folded into the box, and velocities.

        Both are (N, D). Velocities are in 2^exponent a/T, as in the sample. The order equals the
        order of `spins`; with many particles it changes during a run.
        """
        return positions_and_velocities(self.state, self.scene, self.time)

    def spins(self) -> np.ndarray:
        """Return a copy of the spins, surface velocities in 2^exponent a/T.

        Shape (N, 1) for disks, (N, 3) for spheres. Raises NeedsError if particles do not spin.
        """
        if self.state.spin is None:
            raise NeedsError("spins", "effects.spin")
        return self.state.spin.copy()

    def contact_sums(self) -> np.ndarray:
        """Return the sums of v_t^2, v_r^2 and v_t.v_r over all contacts since the start, (3,).

        v_t and v_r are the tangential velocity of the contact due to translation and to spin, in
        a/T. The sums end at the last sample. Raises NeedsError without the effect contact_averages,
        or before any sample.
        """
        if not set(CONTACT_SUMS) <= set(self.sample):
            raise NeedsError("contact sums", "effects.contact_averages, and a sample")
        return np.array([self.sample[name][0] for name in CONTACT_SUMS])

    def last_contact(self) -> tuple[int, int, np.ndarray]:
        """Return the partners i < j of the last contact, and their present positions (2, D) in a.

        i and j count in the order of `spins`. Right after a `step` of one collision the partners
        touch; the positions are not folded into the box.
        """
        numbers = self.state.counts[[LAST_FIRST, LAST_SECOND]]
        i, j = np.flatnonzero(np.isin(self.state.label, numbers))
        return int(i), int(j), self.state.trajectory[[i, j], : len(self.scene.box)]

    def save(self, path: str | Path, owner: str, record: Mapping[str, np.ndarray]) -> None:
        """Write the gas, its costs, and the caller's arrays `record` to `path` atomically.

        The record has arrays by name. `owner` identifies the run: no other one may `restore` the
        file. Raises OSError.
        """
        costs = checkpoint.with_prefix("costs", self.costs.arrays())
        checkpoint.save(path, owner, self.state, {**record, **costs})

    def restore(self, path: str | Path, owner: str) -> dict[str, np.ndarray]:
        """Restore a gas that has just started to its saved state, and return the record.

        The file at `path` was made by `save`. `owner` is the text given to `save`. If it cools,
        call `cool` again. Raises FileNotFoundError if the file is missing, and UnusableCheckpoint
        if it is damaged or forged, or belongs to another run or to another version of the format;
        the gas is then unchanged.
        """
        record = checkpoint.restore(path, owner, self.state, self.scene)
        self.costs = Costs.of(checkpoint.under_prefix("costs", record))
        for name in Costs._fields:
            del record[f"costs.{name}"]
        return record

    def balance(self) -> EnergyBalance:
        """Return the energy balance at the present instant, in m a^2/T^2."""
        return balance(self.state, self.scene)


def timed_sampling(interval: float, particles: int) -> Sampling:
    """Return the sampling of a gas at intervals of `interval` T.

    `particles` is N. A sample with `jam_limit` collisions or more ends early: the gas is jammed.
    """
    return Sampling(float(interval), jam_limit(interval, particles), 0)


def thermalisation_sampling(particles: int, per_particle: float) -> Sampling:
    """Return the sampling of one sample after `per_particle` collisions per particle.

    `particles` is N.
    """
    return Sampling(np.inf, math.ceil(particles / 2 * per_particle), 0)


def concatenated(stretches: Sequence[Columns]) -> Columns:
    """Return several consecutive stretches of samples as one, columns by name."""
    if len(stretches) == 1:
        return stretches[0]
    names = stretches[0]
    return {name: np.concatenate([rows[name] for rows in stretches]) for name in names}
