"""A gas under way: the one loop that points, movies, films and studies drive.

A Gas is a scene and a state. Whoever drives it says how far it goes and when it is sampled. Samples
only look at the state: a run that is cut into pieces keeps its bits, if a cooling gas is refreshed
after the same collisions.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from roughgas.base import NeedsError
from roughgas.kernel.record import Sampling
from roughgas.kernel.state import COLLISIONS, EXPONENT, LAST_FIRST, LAST_SECOND, State
from roughgas.scene import Scene, elastic
from roughgas.scene.initial import initial_state
from roughgas.simulation import restart
from roughgas.simulation.energies import (
    SUMS,
    Columns,
    Energies,
    EnergyBalance,
    as_columns,
    balance,
    energies_of,
)
from roughgas.simulation.journal import COSTS
from roughgas.simulation.recorder import Recorder, most_in, now
from roughgas.simulation.restart import Initial, positions_and_velocities, state_from

if TYPE_CHECKING:
    from roughgas.simulation.observing import Observer


def count(particles: int, per_particle: float) -> int:
    """Return the collisions in a gas of so many particles; at least one."""
    return max(1, round(particles / 2 * per_particle))


class Gas:
    """A scene, the state that it has reached, and the recorder of what this has cost.

    `sample` holds the columns of the last sample, arrays of length 1. A cooling gas is refreshed
    after every `refresh_every` collisions (0: never). One that `keeps_books` has its energy balance
    in every sample.
    """

    def __init__(self, scene: Scene, state: State, recorder: Recorder | None = None) -> None:
        self.scene, self.state = scene, state
        self.recorder = Recorder() if recorder is None else recorder
        self.observer: Observer | None = None  # looks at it between samples
        self.sample: Columns = {}
        self.refresh_every = self.begun = 0
        self.keeps_books = False
        self._just_restarted = False  # with its memory, just now
        self._rows: list[Columns] | None = None  # of the present call
        self._ahead = 0  # samples since the observer looked, of a call that goes on
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
                gas.begun, gas._just_restarted = begun, True
        gas.recorder.begin(gas)
        return gas

    @property
    def particles(self) -> int:
        """Number of particles."""
        return len(self.state.changes)

    @property
    def time(self) -> float:
        """T since the start."""
        return now(self.state)

    @property
    def collisions(self) -> int:
        """Collisions since the start, or since `cool` was called."""
        return int(self.state.counts[COLLISIONS]) - self.begun

    def count(self, per_particle: float) -> int:
        """Return the collisions in the whole gas, each with two partners; at least one."""
        return count(self.particles, per_particle)

    def thermalise(self, per_particle: float) -> None:
        """Let particles, and side walls, collide as smooth elastic ones, so often per particle."""
        sampling = Sampling(np.inf, math.ceil(self.particles / 2 * per_particle), 0)
        self._call(1, lambda n: self._run(sampling, n, elastic(self.scene)))

    def cool(self, refresh_every: int) -> None:
        """Count collisions anew, unless a run goes on, and refresh the gas after each
        `refresh_every` of them."""
        self.refresh_every = refresh_every
        if not self._just_restarted:
            self.begun = int(self.state.counts[COLLISIONS])

    def in_time(self, interval: float, samples: int) -> Columns:
        """Return columns (name -> array of length `samples`), sampled every `interval` T."""
        sampling = Sampling(float(interval), most_in(interval, self.particles), 0)
        return self._observed(lambda n: self._run(sampling, n, timed=True), samples, lambda: 0, 1)

    def in_collisions(self, collisions: int, samples: int) -> Columns:
        """Return the same, sampled every so many collisions, a divisor of `refresh_every`.

        Refreshing is counted from the start of the call; in the first call after a run went on,
        from where it was counted before. It changes the unit of velocity, to 2^exponent a/T: see
        roughgas.simulation.energies.restored.
        """
        unit = max(1, self.refresh_every // collisions)
        rows = self._observed(
            lambda n: self._in_collisions(collisions, n),
            samples,
            lambda: unit - self._since_refresh(collisions) // collisions,
            unit,
        )
        self._just_restarted = False
        return rows

    def _in_collisions(self, collisions: int, samples: int) -> None:
        refresh, late = self.refresh_every // collisions, self._since_refresh(collisions)
        self._just_restarted = False
        left = (self.refresh_every - late) // collisions
        if not late or samples < left:
            self._run(Sampling(np.inf, collisions, 0 if late else refresh), samples)
            return
        self._run(Sampling(np.inf, collisions, left), left)
        if samples > left:
            self._run(Sampling(np.inf, collisions, refresh), samples - left)

    def _since_refresh(self, collisions: int) -> int:
        """Return the collisions since the last refresh, in the first call after a run went on."""
        refreshed = self._just_restarted and self.refresh_every >= collisions
        late = self.collisions % self.refresh_every if refreshed else 0
        return 0 if late % collisions else late

    def _observed(
        self,
        advance: Callable[[int], None],
        samples: int,
        first: Callable[[], int],
        unit: int,
    ) -> Columns:
        """Return samples, taken in pieces where an observer looks in between."""
        observer = self.observer
        if observer is None:
            return self._call(samples, advance)

        def in_pieces(left: int) -> None:
            ahead = self._ahead
            for length in observer.lengths(left + ahead, first(), unit):
                if length > ahead:
                    advance(length - ahead)
                ahead = 0
                self._seen += length
                observer.look(self, length)

        return self._call(samples, in_pieces)

    def _call(self, samples: int, advance: Callable[[int], None]) -> Columns:
        """Return so many samples, which `advance` takes or a journal of the run has."""
        journal = self.recorder.journal
        known = journal.recall(self) if journal else None
        self._rows, self._seen, self._ahead = [], 0, 0
        if known:
            self._rows, self.sample = [known.rows], _last(known.rows)
            self._seen, self._ahead = _length(known.rows) - known.ahead, known.ahead
        if not (known and known.finished):
            self._just_restarted |= known is not None
            advance(samples - sum(map(_length, self._rows)))
        rows, self._rows = joined(self._rows), None
        if journal and not (known and known.finished):
            journal.finish(self, rows)
        return rows

    def look(self) -> None:
        """Take a sample of the present instant."""
        if self._rows is None:
            self._call(1, lambda n: self._run(Sampling(0.0, 0, 0), n))
        else:  # for an observer, within a call
            self.sample = self.recorder.run(self.state, self.scene, Sampling(0.0, 0, 0), 1)

    def refresh(self) -> None:
        """Take a sample, then bring all particles to the present instant, without momentum."""
        self._call(1, lambda n: self._run(Sampling(np.inf, 0, 1), n))

    def step(self, until: float, collisions: int) -> bool:
        """Advance to an instant (T) or by so many collisions, whichever comes first.

        A step ends where a cooling gas is refreshed. Returns whether collisions ended it.
        """
        begun, every = self.collisions, self.refresh_every
        most = min(collisions, every - begun % every) if every else collisions
        interval = (until - self.time) * 2.0 ** int(self.state.counts[EXPONENT])
        self._call(1, lambda n: self._run(Sampling(interval, most, 0), n))
        made = self.collisions - begun
        if every and made and self.collisions % every == 0:
            self.refresh()
        return made == most

    def energies(self, columns: Columns) -> Energies:
        """Return the energies of samples, of a sheared gas without mean flow and mean spin.

        A gas between walls that move along themselves is one, too.
        """
        return energies_of(columns, self.scene, self.state)

    def positions_and_velocities(self) -> tuple[np.ndarray, np.ndarray]:
        """Return positions in a, folded into the box, and velocities of the present: copies.

        Shape (N, D) each. Velocities are in 2^exponent a/T, as those of the sample are. The order
        is that of `spins`; a run of many particles changes it now and then.
        """
        return positions_and_velocities(self.state, self.scene, self.time)

    def spins(self) -> np.ndarray:
        """Return a copy of the spins, in 2^exponent/T: (N, 1) of disks, (N, 3) of spheres.

        Raises NeedsError where particles do not spin.
        """
        if self.state.spin is None:
            raise NeedsError("spins", "effects.spin")
        return self.state.spin.copy()

    def contact_sums(self) -> np.ndarray:
        """Return the sums of v_t^2, v_r^2 and v_t.v_r over all contacts up to the last sample.

        v_t and v_r are the tangential velocity of the contact due to translation and to spin, in
        a/T. Raises NeedsError without the effect contact_averages.
        """
        if not set(SUMS) <= set(self.sample):
            raise NeedsError("contact sums", "effects.contact_averages, and a sample")
        return np.array([self.sample[name][0] for name in SUMS])

    def last_contact(self) -> tuple[int, int, np.ndarray]:
        """Return the partners i < j of the last contact, and where they are now: (2, D), in a.

        i and j count in the order of `spins`. Right after a `step` of one collision, that is where
        they touch, not folded into the box.
        """
        numbers = self.state.counts[[LAST_FIRST, LAST_SECOND]]
        i, j = np.flatnonzero(np.isin(self.state.label, numbers))
        return int(i), int(j), self.state.trajectory[[i, j], : len(self.scene.box)]

    def save(self, path: str | Path, owner: str, record: Mapping[str, np.ndarray]) -> None:
        """Write the gas, what it has cost, and arrays of a run's own, `record`, to `path`.

        `owner` says which run this is: only the same one may `restore` it. The file is there whole
        or not at all. Raises OSError.
        """
        costs = {f"costs.{name}": np.array(getattr(self.recorder, name)) for name in COSTS}
        restart.save(path, owner, self.state, {**record, **costs})

    def restore(self, path: str | Path, owner: str) -> dict[str, np.ndarray]:
        """Bring a gas that has just started to where it was saved, and return the record.

        Call `cool` again where it cools. Raises FileNotFoundError if there is no such file, and
        UnusableCheckpoint if it is damaged or of another run; the gas is then as it was.
        """
        record = restart.restore(path, owner, self.state)
        for name in COSTS:
            setattr(self.recorder, name, record.pop(f"costs.{name}").item())
        return record

    def balance(self) -> EnergyBalance:
        """Return the energy balance now."""
        return balance(self.state, self.scene)

    def _run(
        self, sampling: Sampling, samples: int, scene: Scene | None = None, timed: bool = False
    ) -> None:
        """Advance, within a call, and add samples to those of the call."""
        assert self._rows is not None
        if samples == 0 and self._rows:  # of a call that was stopped at its end
            return
        for piece in [1] * samples if self.keeps_books else [samples]:
            columns = self.recorder.run(
                self.state, scene or self.scene, sampling, piece, timed, self._keep
            )
            columns = self._with_books(columns)
            self.sample = _last(columns)
            self._rows.append(columns)

    def _with_books(self, columns: Columns) -> Columns:
        """Return a sample of the present instant with the energy balance, where that is kept."""
        return {**columns, **as_columns(self.balance())} if self.keeps_books else columns

    def _keep(self, columns: Columns) -> None:
        """Write into the journal how far the present call is, with these samples."""
        assert self._rows is not None and self.recorder.journal is not None
        rows = joined([*self._rows, self._with_books(columns)])
        self.recorder.journal.write(self, rows, _length(rows) - self._seen)


def _length(rows: Columns) -> int:
    return len(rows["time"])


def _last(rows: Columns) -> Columns:
    return {name: column[-1:] for name, column in rows.items()}


def joined(parts: Sequence[Columns]) -> Columns:
    """Return the samples of several pieces as those of one."""
    if len(parts) == 1:
        return parts[0]
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
