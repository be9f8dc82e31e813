"""A gas under way: the one loop that points, pilots, movies, films and studies drive.

A Gas is a scene and a state. Whoever drives it says how far it goes and when it is sampled. Samples
only look at the state: a run that is cut into pieces keeps its bits, if a cooling gas is refreshed
after the same collisions.
"""

import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Protocol, Self

import numpy as np

from roughgas.base.errors import CollapseError, JammedError
from roughgas.kernel.clock import INSTANT
from roughgas.kernel.record import Sampling, columns, record
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
from roughgas.scene import Scene, initial_state
from roughgas.simulation.books import Books, books
from roughgas.simulation.by_species import energies_of
from roughgas.simulation.ends import Initial, state_from
from roughgas.simulation.energies import Columns, Energies

REPORTS = 50
SOON = 0.5  # seconds after which a call of the kernel should come back
JAMMED = 50_000  # collisions of each particle within a sample, or within a T if that is longer
NAMED = 8  # of the particles in a collapse


class Recorder:
    """Sums up what gases have cost together.

    CPU seconds in the kernel, collisions, and contacts that the contact-time model touched.
    `tell(time, collisions)` is called at least some fifty times a run, `begin(gas)` for each gas.
    """

    def __init__(
        self,
        tell: Callable[[float, int], None] | None = None,
        keep: bool = False,
        begin: "Callable[[Gas], None] | None" = None,
    ) -> None:
        self.seconds = 0.0
        self.collisions = 0
        self.touched = 0
        self.gases: list[Gas] = []  # all that it has seen begin, if it is to `keep` them
        self._tell, self._keep, self._begin = tell, keep, begin
        self._begun = 0.0, 0  # time and collisions at which the present gas has begun

    def begin(self, gas: "Gas") -> None:
        """Note that a gas begins."""
        self._begun = gas.time, int(gas.state.counts[COLLISIONS])
        if self._keep:
            self.gases.append(gas)
        if self._begin:
            self._begin(gas)

    def run(
        self, state: State, scene: Scene, sampling: Sampling, samples: int, timed: bool = False
    ) -> Columns:
        """Advance `state`; return columns (name -> array of length `samples`).

        Raises CollapseError if contacts accumulate without end, JammedError where samples are due
        at times and one of them takes `sampling.collisions`.
        """
        names = columns(scene)
        rows = np.empty((samples, len(names)))
        record(state, scene, sampling, rows[:0])  # compiles, or fetches the kernel from its cache
        begin, before = time.process_time(), state.counts.copy()
        first, length = 0, max(1, sampling.refresh)
        while first < samples:
            part, called = rows[first : first + length], time.perf_counter()
            made = int(state.counts[COLLISIONS])
            if record(state, scene, sampling, part) < len(part):
                raise _collapse(state, scene)
            if timed and np.diff(part[:, 1], prepend=made).max() >= sampling.collisions:
                raise _jam(state, sampling.interval)
            first += len(part)
            length = _next_length(length, time.perf_counter() - called, samples, sampling.refresh)
            if self._tell:
                time_begun, collisions_begun = self._begun
                self._tell(float(part[-1, 0] - time_begun), int(part[-1, 1]) - collisions_begun)
        self.seconds += time.process_time() - begin
        self.collisions += state.counts[COLLISIONS] - before[COLLISIONS]
        self.touched += state.counts[TOUCHED] - before[TOUCHED]
        return dict(zip(names, rows.T, strict=True))


class Watcher(Protocol):
    """Looks at the state before and after each step of a gas (see Gas.step), and changes nothing.

    When `after` is called, a cooling gas has not been refreshed yet.
    """

    def before(self, state: State) -> None: ...

    def after(self, state: State) -> None: ...


class Observer(Protocol):
    """Looks at a gas between samples (roughgas.simulation.observing)."""

    def lengths(self, samples: int, first: int, unit: int) -> Iterator[int]: ...

    def look(self, gas: "Gas", taken: int) -> None: ...


class Gas:
    """A scene, the state that it has reached, and the recorder of what this has cost.

    `sample` holds the columns of the last sample, arrays of length 1. A cooling gas is refreshed
    after every `refresh_every` collisions (0: never).
    """

    def __init__(self, scene: Scene, state: State, recorder: Recorder | None = None) -> None:
        self.scene, self.state = scene, state
        self.recorder = Recorder() if recorder is None else recorder
        self.watcher: Watcher | None = None
        self.observer: Observer | None = None
        self.sample: Columns = {}
        self.refresh_every = self.begun = 0
        self._resumed = False  # with its memory, just now
        self.extents = np.ptp(state.trajectory[:, : len(scene.box)], axis=0)

    @classmethod
    def start(
        cls,
        scene: Scene,
        experiment: Mapping[str, Any],
        rng: np.random.Generator,
        recorder: Recorder | None = None,
        initial: Initial | None = None,
    ) -> Self:
        """Return a gas of the experiment's particles, in the `initial` state or else on a lattice.

        Raises InputError.
        """
        if initial is None:
            gas = cls(scene, initial_state(scene, experiment, rng), recorder)
        else:
            state, begun, extents = state_from(initial, scene, experiment, rng)
            gas = cls(scene, state, recorder)
            gas.extents = extents
            if begun is not None:
                gas.begun, gas._resumed = begun, True
        gas.recorder.begin(gas)
        return gas

    @property
    def particles(self) -> int:
        """Number of particles."""
        return len(self.state.changes)

    @property
    def time(self) -> float:
        """T since the start."""
        return _now(self.state)

    @property
    def collisions(self) -> int:
        """Collisions since the start, or since `cool` was called."""
        return int(self.state.counts[COLLISIONS]) - self.begun

    def count(self, per_particle: float) -> int:
        """Return the collisions in the whole gas, each with two partners; at least one."""
        return max(1, round(self.particles / 2 * per_particle))

    def thermalise(self, per_particle: float) -> None:
        """Let particles, and side walls, collide as smooth elastic ones, so often per particle."""
        sampling = Sampling(np.inf, math.ceil(self.particles / 2 * per_particle), 0)
        self._run(sampling, 1, elastic(self.scene))

    def cool(self, refresh_every: int) -> None:
        """Count collisions anew, unless a run goes on, and refresh the gas after each
        `refresh_every` of them."""
        self.refresh_every = refresh_every
        if not self._resumed:
            self.begun = int(self.state.counts[COLLISIONS])

    def in_time(self, interval: float, samples: int) -> Columns:
        """Return columns (name -> array of length `samples`), sampled every `interval` T."""
        most = math.ceil(self.particles / 2 * JAMMED * max(1.0, interval))
        sampling = Sampling(float(interval), most, 0)
        return self._observed(lambda n: self._run(sampling, n, timed=True), samples, 0, 1)

    def in_collisions(self, collisions: int, samples: int) -> Columns:
        """Return the same, sampled every so many collisions, a divisor of `refresh_every`.

        Refreshing is counted from the start of the call; in the first call after a run went on,
        from where it was counted before. It changes the unit of velocity, to 2^exponent a/T: see
        roughgas.simulation.energies.restored.
        """
        unit = max(1, self.refresh_every // collisions)
        first = unit - self._late(collisions) // collisions
        return self._observed(lambda n: self._in_collisions(collisions, n), samples, first, unit)

    def _in_collisions(self, collisions: int, samples: int) -> Columns:
        refresh, late = self.refresh_every // collisions, self._late(collisions)
        self._resumed = False
        left = (self.refresh_every - late) // collisions
        if not late or samples < left:
            return self._run(Sampling(np.inf, collisions, 0 if late else refresh), samples)
        parts = [self._run(Sampling(np.inf, collisions, left), left)]
        if samples > left:
            parts.append(self._run(Sampling(np.inf, collisions, refresh), samples - left))
        return _joined(parts)

    def _late(self, collisions: int) -> int:
        """Return the collisions since the last refresh, in the first call after a run went on."""
        refreshed = self._resumed and self.refresh_every >= collisions
        late = self.collisions % self.refresh_every if refreshed else 0
        return 0 if late % collisions else late

    def _observed(
        self, advance: Callable[[int], Columns], samples: int, first: int, unit: int
    ) -> Columns:
        """Return samples, taken in pieces where an observer looks in between."""
        if self.observer is None:
            return advance(samples)
        parts = []
        for length in self.observer.lengths(samples, first, unit):
            if length:
                parts.append(advance(length))
            self.observer.look(self, length)
        return _joined(parts)

    def look(self) -> None:
        """Take a sample of the present instant."""
        self._run(Sampling(0.0, 0, 0), 1)

    def refresh(self) -> None:
        """Take a sample, then bring all particles to the present instant, without momentum."""
        self._run(Sampling(np.inf, 0, 1), 1)

    def step(self, until: float, collisions: int) -> bool:
        """Advance to an instant (T) or by so many collisions, whichever comes first.

        A step ends where a cooling gas is refreshed. Returns whether collisions ended it.
        """
        begun, every = self.collisions, self.refresh_every
        most = min(collisions, every - begun % every) if every else collisions
        if self.watcher:
            self.watcher.before(self.state)
        interval = (until - self.time) * 2.0 ** int(self.state.counts[EXPONENT])
        self._run(Sampling(interval, most, 0), 1)
        if self.watcher:
            self.watcher.after(self.state)
        made = self.collisions - begun
        if every and made and self.collisions % every == 0:
            self.refresh()
        return made == most

    def energies(self, columns: Columns) -> Energies:
        """Return the energies of samples, of a sheared gas without mean flow and mean spin."""
        return energies_of(columns, self.scene, self.state)

    def books(self) -> Books:
        """Return the books of energy at the present instant."""
        return books(self.state, self.scene)

    def _run(
        self, sampling: Sampling, samples: int, scene: Scene | None = None, timed: bool = False
    ) -> Columns:
        columns = self.recorder.run(self.state, scene or self.scene, sampling, samples, timed)
        self.sample = {name: column[-1:] for name, column in columns.items()}
        return columns


def _joined(parts: Sequence[Columns]) -> Columns:
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def elastic(scene: Scene) -> Scene:
    """Return the scene with smooth elastic particles, and side walls if it has any."""
    walls, species = scene.effects.walls, scene.effects.species
    if walls is not None:
        walls = walls._replace(restitution=1.0, roughness=-1.0)
    if species is not None:
        species = species._replace(alike=True)
    effects = scene.effects._replace(walls=walls, species=species)
    return scene._replace(restitution=1.0, roughness=-1.0, effects=effects)


def _next_length(length: int, took: float, samples: int, refresh: int) -> int:
    """Return how many samples the next call of the kernel makes: no bit depends on it.

    So many that it comes back soon, and that there are some REPORTS calls; a whole number of times
    `refresh`, which the kernel counts from the start of each call.
    """
    if took < SOON:
        return min(2 * length, max(1, refresh) * -(-samples // (REPORTS * max(1, refresh))))
    return max(1, length // 2) if refresh == 0 else max(refresh, length // 2 // refresh * refresh)


def _jam(state: State, interval: float) -> JammedError:
    limit = f"{JAMMED} collisions of each particle within {max(1.0, interval):g} T"
    remedy = "give it more room, raise r, or sample it more often"
    return JammedError(
        f"more than {limit}, at t = {_now(state):.6g} T: the gas is jammed: {remedy}"
    )


def _now(state: State) -> float:
    clock, unit = state.clock, 2.0 ** -int(state.counts[EXPONENT])
    return float(clock[ORIGIN] + (clock[BASE] + clock[NOW]) * unit)


def _collapse(state: State, scene: Scene) -> CollapseError:
    names = [str(label) for label in _collapsing(state)]
    others = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    effects, remedy = scene.effects, "raise r, or the duration of contact_time"
    if effects.contact_time is None:
        remedy = "add the contact_time effect to the experiment, or raise r"
    elif effects.floor is not None or effects.walls is not None:
        remedy = "raise r, or make floor or walls smoother, between which a particle may be held"
    where = f"at t = {_now(state):.6g} T of particles {', '.join(names[:NAMED])}{others}"
    return CollapseError(f"inelastic collapse {where}: {remedy}")


def _collapsing(state):
    """Return the numbers of particles whose last contact is simultaneous with the present instant.

    A refresh brings all particles to the present: just after it, those of the last contact.
    """
    last = state.clock[NOW] - INSTANT * state.clock[SPAN]
    found = state.label[state.trajectory[:, -1] >= last]
    refreshed = len(found) == len(state.label)
    return np.sort(state.counts[[LAST_FIRST, LAST_SECOND]] if refreshed else found)
