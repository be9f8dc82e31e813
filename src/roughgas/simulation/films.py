"""Films: the snapshots of a take of a point, simulated leg by leg, resumable from a checkpoint.

A take is the choice of start, length and frames of a film. A leg is a stretch of a run with one
sampling and one scene. Times are in T, or in collisions per particle of a cooling gas.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from roughgas.base import InputError
from roughgas.base.labels import GridPoint
from roughgas.effects.paths import Paths
from roughgas.effects.species import packing
from roughgas.kernel.hooks import displacement
from roughgas.kernel.record import Sampling
from roughgas.kernel.state import EXPONENT, Bodies
from roughgas.scene import Scene, has_single_walls
from roughgas.scene.initial import bounds
from roughgas.simulation import cooling, protocols, stages
from roughgas.simulation.checkpoint import (
    UNKNOWN_CONTENT,
    Checkpoint,
    discard,
    resumable,
    under_prefix,
    with_prefix,
)
from roughgas.simulation.energies import Energies, ratio, restored
from roughgas.simulation.experiment import Experiment
from roughgas.simulation.free_flight import (
    in_starting_order,
    positions_and_velocities,
    rotations,
    unwrapped_positions,
)
from roughgas.simulation.gas import PRESENT_SAMPLE, Gas, timed_sampling
from roughgas.simulation.initial_checks import checked_initial_states
from roughgas.simulation.initial_states import InitialState
from roughgas.simulation.leg import UNTIL_IT_ENDS, Changes, Leg
from roughgas.simulation.run_points import checkpoint_owner
from roughgas.simulation.simulation import Simulation
from roughgas.simulation.stages import Stage
from roughgas.simulation.state_encoding import UnusableCheckpoint
from roughgas.simulation.tracker import Tracker
from roughgas.simulation.trajectory import Snapshot, Take
from roughgas.theory.closed_forms import collision_frequency

PARTICLES_PER_COOLING_STEP = 200  # particles per collision of a step of a cooling gas
DRIVEN_STEP = 100.0  # collisions per particle in a step of a driven gas


@contextmanager
def film(
    scene: Scene,
    experiment: Experiment[Any],
    grid_point: GridPoint,
    take: Take,
    initial: Sequence[InitialState],
    path: str | Path | None,
    say: Callable[[str], None],
) -> Iterator[Iterator[Snapshot]]:
    """Yield an iterator over the snapshots of a take, with a checkpoint at `path`.

    Without a path (None) there is no checkpoint. `grid_point` has the r, beta and seed of the
    point, `initial` the states of its gases, if any; `say` prints a line on the use of the
    checkpoint. The checkpoint is removed after the last snapshot was used.
    """
    owner = checkpoint_owner(scene, experiment, grid_point, initial, None, take) if path else ""
    with resumable(path, owner, say) as checkpoint:
        simulate = partial(snapshots, scene, experiment, grid_point.seed, take, initial, checkpoint)
        yield _restarting_snapshots(simulate, checkpoint, say)
    if path:
        discard(path)


def _restarting_snapshots(
    simulate: Callable[[], Iterator[Snapshot]],
    checkpoint: Checkpoint | None,
    say: Callable[[str], None],
) -> Iterator[Snapshot]:
    """Yield the snapshots that `simulate` makes, and restart it if the checkpoint makes it fail.

    The restarted run does not use the checkpoint, and snapshots that were already used are skipped.
    """
    used = 0
    try:
        for snapshot in simulate():
            yield snapshot
            del snapshot  # a film may be larger than the memory
            used += 1
    except Exception as error:
        if checkpoint is None or not checkpoint.may_have_caused(error):
            raise
        checkpoint.refuse(error, say)
        yield from islice(simulate(), used, None)


def snapshots(
    scene: Scene,
    experiment: Experiment,
    seed: int,
    take: Take,
    initial: Sequence[InitialState] = (),
    checkpoint: Checkpoint | None = None,
) -> Iterator[Snapshot]:
    """Simulate a point and yield the snapshots of a take, one after the other.

    The run begins in the first of the `initial` states, if any: the time of a driven gas continues
    from that state, the time of a cooling one restarts. A run that resumes from a `checkpoint`
    yields the earlier snapshots again; a take of more than LARGEST_CHECKPOINT bytes has none.

    Without times in the take, the frames of a driven gas are equally spaced, each in the middle of
    its interval, away from the instants when a sawtooth falls back. Frames of a cooling gas are
    equally spaced in scaled time: their interval is a fixed share of the mean free time (Enskog's,
    at the present E_trans), so that the take has about the requested length. The kernel counts the
    crossings of the box and the rotation of disks: both are exact for intervals of any length.

    Raises InputError for illegal values, CollapseError where contacts accumulate without end.
    """
    protocol = protocols.protocol_of(experiment)
    scene, experiment = _with_counted_paths(scene, experiment)
    if initial:
        initial = checked_initial_states(initial, experiment, scene, seed)
    gas = protocol.start(scene, experiment, seed, initial[:1])
    if bytes_of_snapshots(take, gas) > LARGEST_CHECKPOINT:
        checkpoint = None
    tracker = SnapshotTracker(gas.collisions, saves_all=checkpoint is not None)
    film = TakeLegs(take, gas, experiment, seed, tracker)
    route = film.legs()
    simulation = Simulation({"shots": tracker}, checkpoint)
    if checkpoint and checkpoint.has_content:
        tracker.check(gas, [leg.name for leg in route[: simulation.leg_index]])
    for leg in simulation.through(0, lambda: gas, lambda _: route):
        if leg.name.startswith(FRAME_PREFIX):
            yield tracker.snapshot_of(leg.name, gas)


LARGEST_CHECKPOINT = 2**28  # bytes of snapshots in a checkpoint
FRAME_PREFIX = "frame "
"""Prefix of the names of legs that end in a snapshot."""


def bytes_of_snapshots(take: Take, gas: Gas) -> int:
    """Return the size of all snapshots of a take, in bytes.

    It counts position, velocity, spin, path and angle of each particle.
    """
    return 8 * take.frames * gas.particles * (5 * len(gas.scene.box) + 1)


class SnapshotTracker(Tracker):
    """Takes a snapshot at the end of each leg whose name begins with FRAME_PREFIX."""

    def __init__(self, initial_collisions: int, saves_all: bool) -> None:
        """Count collisions from `initial_collisions`, at the start of the film.

        With `saves_all`, snapshots stay in memory after their use, for the checkpoint.
        """
        self.until = math.nan  # T: end of the present leg
        self._initial_collisions, self._saves_all = initial_collisions, saves_all
        self._start_angles: np.ndarray | None = None  # angles at the start of the take
        self._snapshots: dict[str, Snapshot] = {}

    def begin(self, gas: Gas, leg: Leg, changes: Changes) -> None:
        """Store the instant of the leg's end, from the array `until` in `changes`, in T."""
        self.until = float(changes.get("until", math.nan))

    def end(self, gas: Gas, leg: Leg) -> None:
        """Take a snapshot at the end of a frame; store the angles at the start of the take."""
        if leg.name == START_LEG:
            self._start_angles = rotations(gas.state)
        if leg.name.startswith(FRAME_PREFIX):
            self._snapshots[leg.name] = _snapshot(gas, self._initial_collisions, self._start_angles)

    def snapshot_of(self, name: str, gas: Gas) -> Snapshot:
        """Return the stored snapshot at the end of the leg `name`, with the bodies of the running
        `gas`."""
        snapshot = self._snapshots[name] if self._saves_all else self._snapshots.pop(name)
        return snapshot._replace(bodies=_bodies(gas.state))

    def arrays(self) -> dict[str, np.ndarray]:
        """Return the snapshots in memory as arrays by name, for a checkpoint.

        They include the end of the present leg and the angles at the start of the take.
        """
        arrays = {"until": np.array(self.until)}
        if self._start_angles is not None:
            arrays["turned"] = self._start_angles
        for name, snapshot in self._snapshots.items():
            values = snapshot._replace(bodies=None)._asdict()
            present_values = {
                key: np.array(value) for key, value in values.items() if value is not None
            }
            arrays |= with_prefix(name, present_values)
        return arrays

    def restore(self, arrays: Mapping[str, np.ndarray]) -> None:
        """Restore the snapshots from the arrays of a checkpoint."""
        self.until, self._start_angles = arrays["until"].item(), arrays.get("turned")
        names = {key.partition(".")[0] for key in arrays if key.startswith(FRAME_PREFIX)}
        self._snapshots = {
            name: _snapshot_from_arrays(under_prefix(name, arrays)) for name in names
        }

    def check(self, gas: Gas, finished_legs: Sequence[str]) -> None:
        """Raise UnusableCheckpoint unless the restored snapshots fit the run.

        Each frame among the finished legs must have a snapshot, with the shapes of a snapshot of
        `gas`, which is at its start. `finished_legs` are names of legs.
        """
        gas.sample_now()
        turned = rotations(gas.state)
        shapes = _value_shapes(_snapshot(gas, self._initial_collisions, turned))
        complete = all(_value_shapes(snapshot) == shapes for snapshot in self._snapshots.values())
        complete &= self._snapshots.keys() == {
            name for name in finished_legs if name.startswith(FRAME_PREFIX)
        }
        angle_shape = None if self._start_angles is None else self._start_angles.shape
        complete &= angle_shape == (
            None if turned is None or START_LEG not in finished_legs else turned.shape
        )
        if not complete:
            raise UnusableCheckpoint(UNKNOWN_CONTENT)


def _value_shapes(snapshot):
    """Return, by field, the shape of each value of a snapshot and whether its dtype is float."""
    values = snapshot._replace(bodies=None)._asdict()
    return {
        name: (np.shape(value), np.asarray(value).dtype == float) for name, value in values.items()
    }


def _snapshot_from_arrays(arrays):
    """Return a snapshot from its arrays in a checkpoint, by the name of the field."""
    values = {name: None for name in Snapshot._fields} | {
        name: array if array.ndim else array.item() for name, array in arrays.items()
    }
    return Snapshot(**values | {"planes": [tuple(pair) for pair in arrays["planes"].tolist()]})


START_LEG = "start"
"""Name of the leg that ends at the start of the take."""


class TakeLegs:
    """Makes the legs of a take: each ends at an instant, and is divided into steps.

    A film can be interrupted between two steps. The instants of a cooling gas depend on its steps
    through rounding errors.
    """

    def __init__(
        self, take: Take, gas: Gas, experiment: Experiment, seed: int, tracker: SnapshotTracker
    ) -> None:
        """Prepare the legs of `gas`, which is at its start; `tracker` gets the end of each leg."""
        self.take, self.gas, self.experiment, self.tracker = take, gas, experiment, tracker
        self.seed = seed
        self.scene, self.initial_collisions = gas.scene, gas.collisions

    def legs(self) -> list[Leg]:
        """Return all legs of the film, in order, for the experiment's kind of schedule."""
        if protocols.protocol_of(self.experiment) is cooling:
            return self.cooling_legs()
        if protocols.protocol_of(self.experiment) is stages:
            return self.staged_legs()
        return self.driven_legs()

    def driven_legs(self) -> list[Leg]:
        """Return the legs of a driven gas, stretches of time that end at a snapshot; it is sampled
        as in a run while it becomes steady."""
        legs = []
        if self.take.start > self.gas.time:
            wait = self.take.start - self.gas.time
            samples = math.ceil(wait / self.experiment.schedule.sample_every)
            sampling = timed_sampling(wait / samples, self.gas.particles)
            legs.append(Leg("wait", sampling, samples, self.scene, timed=True))
        legs += [self._present_leg(), self._leg_to_time(START_LEG, -math.inf)]
        return [*legs, *(self._leg_to_time(name, time) for name, time in self._frame_times())]

    def staged_legs(self) -> list[Leg]:
        """Return the legs of a gas with stages; a stage may begin between two frames."""
        legs, coming_stages = (
            [self._present_leg()],
            stages.course(self.scene, self.experiment, self.gas.time),
        )
        for name, instant in [(START_LEG, self.take.start), *self._frame_times()]:
            while coming_stages and coming_stages[0].begin <= instant:
                legs += self._legs_to_stage(coming_stages.pop(0))
            legs.append(self._leg_to_time(name, instant))
        return legs

    def _legs_to_stage(self, stage: Stage) -> list[Leg]:
        """Return the legs to the beginning of a stage, and the leg that starts with its change.

        A first leg ends halfway: from there the difference of the times is exact.
        """
        legs = [
            self._leg_to_time("towards a stage", lambda gas: 0.5 * (gas.time + stage.begin)),
            self._leg_to_time("until a stage", stage.begin),
        ]
        self.scene = stage.scene

        def begin(gas: Gas) -> Changes:
            """Switch the gas to the stage, and return the supplied energy by name."""
            return {"put_in": stage.enter(gas, self.seed)}

        return [*legs, self._present_leg()._replace(begin=begin)]

    def cooling_legs(self) -> list[Leg]:
        """Return the legs of a cooling gas."""
        legs = [self._present_leg(), self._leg_to_collisions(START_LEG, self.take.start)]
        if self.take.times:
            return legs + [
                self._leg_to_collisions(name, time) for name, time in self._frame_times()
            ]
        legs.append(self._leg_to_time(f"{FRAME_PREFIX}0", -math.inf))
        interval = self.take.length / self.take.frames

        def until(gas: Gas) -> float:
            """Return the time of the next frame in T, a fixed share of the mean free time later."""
            frequency = _collision_frequency(gas, self.experiment)
            if not frequency > 0.0:
                legal = "be so short that E_trans stays above the smallest number, 5e-324"
                raise InputError("length", self.take.length, legal)
            return gas.time + interval / frequency

        return legs + [
            self._leg_to_time(f"{FRAME_PREFIX}{k}", until) for k in range(1, self.take.frames)
        ]

    def _frame_times(self) -> list[tuple[str, float]]:
        """Return the leg's name and the time of each frame, in T or in collisions per particle."""
        take = self.take
        interval = take.length / take.frames
        times = take.times or [take.start + (k + 0.5) * interval for k in range(take.frames)]
        return [(f"{FRAME_PREFIX}{k}", time) for k, time in enumerate(times)]

    def _present_leg(self) -> Leg:
        """Return a leg with one sample of the present instant."""
        return Leg("look", PRESENT_SAMPLE, 1, self.scene)

    def _leg_to_time(self, name: str, until: float | Callable[[Gas], float]) -> Leg:
        """Return the leg `name` to the instant `until` (T), or to a function of the gas.

        The function is called as the leg begins.
        """
        stride = _step_collisions(self.gas, self.experiment)

        def begin(gas: Gas) -> Changes:
            """Return the end of the leg in T, as an array by name."""
            return {"until": np.array(until(gas) if callable(until) else until)}

        def sampling(gas: Gas) -> Sampling | None:
            """Return the sampling of the next step; None at the end of the leg."""
            remaining = self.tracker.until - gas.time
            tolerance = INSTANT_ROUNDING * max(1.0, abs(gas.time))
            return gas.step_sampling(self.tracker.until, stride) if remaining > tolerance else None

        return Leg(name, sampling, UNTIL_IT_ENDS, self.scene, begin)

    def _leg_to_collisions(self, name: str, per_particle: float) -> Leg:
        """Return the leg `name` until the gas has made `per_particle` collisions per particle.

        They are rounded to whole collisions in the gas, and count from the start of the film.
        """
        stride = _step_collisions(self.gas, self.experiment)
        target_collisions = self.initial_collisions + round(self.gas.particles / 2 * per_particle)

        def sampling(gas: Gas) -> Sampling | None:
            """Return the sampling of the next step; None at the end of the leg."""
            remaining = target_collisions - gas.collisions
            return gas.step_sampling(math.inf, min(stride, remaining)) if remaining > 0 else None

        return Leg(name, sampling, UNTIL_IT_ENDS, self.scene)


INSTANT_ROUNDING = 1e-11  # relative: closer instants count as reached


def _step_collisions(gas: Gas, experiment: Experiment) -> int:
    """Return the number of collisions in the gas during a step of a leg."""
    if protocols.protocol_of(experiment) is cooling:
        return max(1, gas.particles // PARTICLES_PER_COOLING_STEP)
    return gas.count(DRIVEN_STEP)


def _with_counted_paths(scene, experiment):
    """Return scene and settings with the effect `paths`, which does not change a run's bits."""
    effects = scene.effects._replace(paths=Paths())
    return scene._replace(effects=effects), experiment.with_effects({"paths": {}})


def _collision_frequency(gas, experiment):
    """Return Enskog's frequency of collisions of a particle at the present energy, in 1/T.

    For a mixture it is an estimate from means of radii and masses.
    """
    T, dimension, bodies = (
        2.0 * _energies(gas).translational,
        len(experiment.box),
        gas.state.bodies,
    )
    frequency = float(collision_frequency(T, packing(experiment), dimension))
    if bodies is None:
        return frequency
    size_factor = np.mean(bodies.radius) ** (dimension - 1) / np.mean(bodies.radius**dimension)
    return frequency * float(size_factor * np.sqrt(np.mean(1.0 / bodies.mass)))


def _snapshot(gas: Gas, initial_collisions: int, start_angles: np.ndarray | None) -> Snapshot:
    """Return the snapshot of a gas at the present instant, which must have been sampled.

    Collisions are counted from `initial_collisions`, and angles from `start_angles`, at the start
    of the take.
    """
    state, effects, present, time = gas.state, gas.scene.effects, _energies(gas), gas.time
    unit, spin = 2.0 ** int(state.counts[EXPONENT]), state.spin
    position, velocity = positions_and_velocities(state, gas.scene, time)
    unwrapped = unwrapped_positions(state, gas.scene)
    assert unwrapped is not None  # `_with_counted_paths`
    angle = None if start_angles is None else rotations(state) - start_angles
    if spin is not None:
        spin = in_starting_order(state, spin * unit)
    return Snapshot(
        time=time,
        collisions=2.0 * (gas.collisions - initial_collisions) / gas.particles,
        position=in_starting_order(state, position),
        velocity=in_starting_order(state, velocity * unit),
        spin=spin,
        unwrapped=unwrapped,
        angle=angle,
        E_trans=float(present.translational),
        E_rot=None if present.rotational is None else float(present.rotational),
        R=None if spin is None else float(ratio(present)),
        floor=displacement(effects.floor, time),
        slide=displacement(effects.shear, time),
        walls=displacement(effects.shaken_walls, time),
        bodies=_bodies(state),
        planes=bounds(effects, position.shape[1], time) if has_single_walls(effects) else (),
    )


def _bodies(state):
    """Return radii, masses and other constants of the particles in the order of the start.

    None if all particles are identical.
    """
    if state.bodies is None:
        return None
    *quantities, largest, pairs = state.bodies
    return Bodies(*(in_starting_order(state, values) for values in quantities), largest, pairs)


def _energies(gas: Gas) -> Energies:
    """Return the energies per degree of freedom of the last sample, numbers in m a^2/T^2."""
    present = restored(gas.energies(gas.sample), gas.sample["exponent"])
    return present.map(lambda energy: energy[0])
