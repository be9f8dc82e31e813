"""How the kernel is called: in pieces, so that it stops soon; what gases have cost together.

A run with a target for the standard error of R goes on in blocks until the error is that small.
Blocks are whole: after k of them everything is computed anew from the whole run, which has the bits
of one that was asked for k times the length, or k times the replicas, from the start. To stop when
an estimated error is small selects runs whose error is underestimated; looks are therefore few: a
run goes on by as much as its error says, at most to twice its length.
"""

import math
import time
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.base import CollapseError, EndedEarlyError, JammedError, SilentError
from roughgas.kernel.loop import COLLAPSED, HELD, INSTANT, REACHED
from roughgas.kernel.record import UNLIMITED, Sampling, columns, record
from roughgas.kernel.state import (
    BASE,
    COLLISIONS,
    EXPONENT,
    LAST_FIRST,
    LAST_SECOND,
    NOW,
    ORIGIN,
    SPAN,
    TOUCHED,
    State,
)
from roughgas.scene import Scene, walls_of
from roughgas.simulation.energies import Columns
from roughgas.statistics.errors import LEAST, NO, UNKNOWN, YES

if TYPE_CHECKING:
    from roughgas.simulation.gas import Gas
    from roughgas.simulation.journal import Journal


KEY = "target_stderr"  # of a schedule
MOST_BLOCKS = 100  # so that the error falls by a factor of ten
MOST_SAMPLES = 10_000_000  # of all replicas together: they are kept in memory
LENGTHS = ("equilibrate", "measure", "plateau")

Schedule = Mapping[str, Any]


def samples_of(schedule: Schedule) -> float:
    """Return how many samples a schedule makes, but for those of a transient by theory."""
    lengths = sum(schedule[name] for name in LENGTHS if name in schedule)
    lengths += sum(stage["duration"] for stage in schedule.get("stages", ()))
    return schedule.get("replicas", 1) * lengths / schedule["sample_every"]


def until_met(
    schedule: Schedule, key: str, run_to: Callable[[Schedule], tuple[dict[str, Any], bool]]
) -> dict[str, Any]:
    """Return the variables of a run that has been prolonged, in `key`, until its target is met.

    `run_to(schedule)` takes the run on to a longer schedule, and returns its variables and whether
    its error rests on enough to stop. Without a target it is called once.
    """
    if KEY not in schedule:
        return run_to(schedule)[0]
    target, blocks = schedule[KEY], 1
    most = max(1, min(MOST_BLOCKS, int(MOST_SAMPLES / samples_of(schedule))))
    while True:
        found, enough = run_to({**schedule, key: blocks * schedule[key]})
        small, error = found["R_stderr"] <= target, found["R_stderr"]
        still = error == 0.0 and found["measured_collisions"] >= LEAST.collisions  # R never changes
        if blocks == most or (small and (enough or still)):
            known = YES if found["R_ci95_trusted"] == YES else UNKNOWN
            return found | {"target_met": known if small else NO, "target_blocks": blocks}
        blocks = min(most, 2 * blocks if small else _wanted(blocks, error / target))


def _wanted(blocks: int, excess: float) -> int:
    """Return how many blocks to go on to, by how many times the error is larger than its target."""
    needed = blocks * excess**2 if math.isfinite(excess) else math.inf
    return max(blocks + 1, min(2 * blocks, math.ceil(min(needed, 2.0 * blocks))))


REPORTS = 50  # of a run that is not over before anybody could read them
BRIEF, SOON = 0.02, 0.5  # seconds that a call of the kernel should take at least, and at most
JAMMED = 50_000  # collisions of each particle within a sample, or within a T if that is longer
MOST_HITS = 1_000_000  # of walls and floor by each particle within a T, or a shorter call
NAMED = 8  # of the particles in a collapse


class Recorder:
    """Sums up what gases have cost together.

    CPU seconds in the kernel, collisions, and contacts that the contact-time model touched.
    `tell(time, collisions)` is called some fifty times a run or more, where that is no oftener than
    after BRIEF; `begin(gas)` for each gas.
    """

    def __init__(
        self,
        tell: Callable[[float, int], None] | None = None,
        keep: float = 0,
        begin: "Callable[[Gas], None] | None" = None,
        journal: "Journal | None" = None,
    ) -> None:
        self.seconds = 0.0
        self.collisions = 0
        self.touched = 0
        self.gases: list[Gas] = []  # the first that it has seen begin, so many as it is to `keep`
        self.journal = journal  # where gases keep how far they are
        self._tell, self._keep, self._begin = tell, keep, begin
        self._begun = 0.0, 0  # time and collisions at which the present gas has begun
        self._told = True  # that the present gas begins
        self._compiled: set[Scene] = set()
        self._lengths: dict[Sampling, int] = {}  # samples that a call makes, by how they are taken

    def begin(self, gas: "Gas") -> None:
        """Note that a gas begins."""
        self._begun = gas.time, int(gas.state.counts[COLLISIONS])
        self._told = False
        if stage := getattr(self._tell, "stage", None):
            stage("compiling")
        if len(self.gases) < self._keep:
            self.gases.append(gas)
        if self._begin:
            self._begin(gas)

    def expect(self, length: float) -> None:
        """Say how long all of the run is going to be, as its kind of schedule counts it."""
        if expect := getattr(self._tell, "expect", None):
            expect(length)

    def run(
        self,
        state: State,
        scene: Scene,
        sampling: Sampling,
        samples: int,
        timed: bool = False,
        keep: Callable[[Columns], None] | None = None,
    ) -> Columns:
        """Advance `state`; return columns (name -> array of length `samples`).

        `keep(columns)` is called where the journal is to be written, with those so far.
        Raises CollapseError if contacts accumulate without end, SilentError if the collisions of a
        sample without an interval do not come, JammedError where particles do little but hit walls,
        or where samples are `timed` and one takes `sampling.collisions`.
        """
        names = columns(scene)
        rows = np.empty((samples, len(names)))
        if scene not in self._compiled:
            record(state, scene, sampling, rows[:0])  # compiles the kernel, or fetches it
            self._compiled.add(scene)
        if self._tell and not self._told:
            self._tell(0.0, 0)
        self._told = True
        first, length = 0, self._lengths.get(sampling, max(1, sampling.refresh))
        while first < samples:
            part, called = rows[first : first + length], time.perf_counter()
            begin, before = time.process_time(), state.counts.copy()
            most = _most_hits(len(part), sampling.interval, state)
            ended, _ = record(state, scene, sampling._replace(hits=most), part)
            self.seconds += time.process_time() - begin
            made = int(state.counts[COLLISIONS] - before[COLLISIONS])
            self.collisions += made
            self.touched += int(state.counts[TOUCHED] - before[TOUCHED])
            if ended != REACHED:
                raise _failure(ended, state, scene)
            if timed and made >= sampling.collisions:  # in all samples together: perhaps in one
                each = np.diff(part[:, 1], prepend=before[COLLISIONS])
                if each.max() >= sampling.collisions:
                    raise _jam(state, sampling.interval)
            first += len(part)
            length = _next_length(length, time.perf_counter() - called, samples, sampling.refresh)
            if self._tell:
                time_begun, collisions_begun = self._begun
                self._tell(float(part[-1, 0] - time_begun), int(part[-1, 1]) - collisions_begun)
            if keep and self.journal and self.journal.due():
                keep(dict(zip(names, rows[:first].T, strict=True)))
        if samples > 1:  # the next replica, or piece, begins with what has suited this one
            self._lengths[sampling] = length
        return dict(zip(names, rows.T, strict=True))


def most_in(interval: float, particles: int) -> int:
    """Return the collisions in a gas within a sample of `interval` T after which it is jammed."""
    return math.ceil(particles / 2 * JAMMED * max(1.0, interval))


def _most_hits(samples: int, interval: float, state: State) -> int:
    """Return the hits of walls and floor within a call after which particles are held there.

    A sample that has no interval counts as a T.
    """
    length = max(1.0, samples * (interval if math.isfinite(interval) else 1.0))
    return math.ceil(min(MOST_HITS * len(state.label) * length, UNLIMITED))


def _next_length(length: int, took: float, samples: int, refresh: int) -> int:
    """Return how many samples the next call of the kernel makes: no bit depends on it.

    So many that it comes back soon, and that there are some REPORTS calls or each is BRIEF; a whole
    number of times `refresh`, which the kernel counts from the start of each call.
    """
    unit = max(1, refresh)
    if took >= SOON:
        return max(unit, length // 2 // unit * unit)
    longer = length < samples and (took < BRIEF or 2 * length * REPORTS <= samples)
    return 2 * length if longer else length


def _failure(ended: int, state: State, scene: Scene) -> EndedEarlyError:
    """Return the error of a call of the kernel that ended early."""
    if ended == COLLAPSED:
        return _collapse(state, scene)
    if ended == HELD:
        return _held(state)
    made, remedy = int(state.counts[COLLISIONS]), "raise the packing, or the number of particles"
    where = f"at t = {now(state):.6g} T, after {made} collisions"
    return SilentError(f"particles do not meet any longer {where}: {remedy}")


def _jam(state: State, interval: float) -> JammedError:
    limit = f"{JAMMED} collisions of each particle within {max(1.0, interval):g} T"
    remedy = "give it more room, raise r, or sample it more often"
    return JammedError(f"more than {limit}, at t = {now(state):.6g} T: the gas is jammed: {remedy}")


def _held(state: State) -> JammedError:
    limit = f"{MOST_HITS} hits of walls and floor by each particle within a T"
    remedy = "make walls and floor smoother, or raise their r"
    return JammedError(f"more than {limit}, at t = {now(state):.6g} T: some are held: {remedy}")


def now(state: State) -> float:
    """Return T since the start."""
    clock, unit = state.clock, 2.0 ** -int(state.counts[EXPONENT])
    return float(clock[ORIGIN] + (clock[BASE] + clock[NOW]) * unit)


def _collapse(state: State, scene: Scene) -> CollapseError:
    names = [str(label) for label in _collapsing(state)]
    others = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    effects, remedy = scene.effects, "raise r, or the duration of contact_time"
    if effects.contact_time is None:
        remedy = "add the contact_time effect to the experiment, or raise r"
    elif walls_of(effects):
        remedy = "raise r, or make floor or walls smoother, between which a particle may be held"
    # so slow a gas may have no two instants that differ: none of its particles is the last
    partners = f" of particles {', '.join(names[:NAMED])}{others}" if names else ""
    return CollapseError(f"inelastic collapse at t = {now(state):.6g} T{partners}: {remedy}")


def _collapsing(state):
    """Return the numbers of particles whose last contact is simultaneous with the present instant.

    A refresh brings all particles to the present: just after it, those of the last contact.
    """
    last = state.clock[NOW] - INSTANT * state.clock[SPAN]
    found = state.label[state.trajectory[:, -1] >= last]
    refreshed = len(found) == len(state.label)
    return np.sort(state.counts[[LAST_FIRST, LAST_SECOND]] if refreshed else found)
