"""A point's trajectory, frame by frame: where its particles are, and how they have turned.

It is that of run_point with the same settings and seed, in a cooling gas that of the first replica:
between frames the state is only looked at. Units: particle radius a = mass m =
time unit T = 1.
"""

import math
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from roughgas.kernel.hooks import displacement
from roughgas.kernel.state import BASE, COLLISIONS, EXPONENT, NOW
from roughgas.scene import Scene, build
from roughgas.scene.initial import initial_state
from roughgas.simulation.cooling import SAMPLES_PER_REFRESH, elastic
from roughgas.simulation.energies import ratio, restored
from roughgas.simulation.recorder import Recorder
from roughgas.simulation.steady import fluctuations
from roughgas.theory.frequencies import collision_frequency

STRIDES = 200  # steps of a frame are of one collision up to so many particles, then of more
PATIENCE = 1_000_000  # particles times T that a movie waits for its gas to be stationary, at most
UNKNOWN_TRANSIENT = 1000.0  # T, where the schedule does not say how long to wait
PERIODS, FRAMES = 5, 125  # of a drive, and of a movie of a driven gas
TIME = 25.0  # T that is shown of a gas whose drive has no time of its own
COOLING = 0.0, 16.0, 160  # start and length in collisions per particle, frames


class Take(NamedTuple):
    """What is looked at: in T, or in collisions per particle of a cooling gas."""

    start: float  # since the beginning, or since a gas began to cool
    length: float
    frames: int


class Snapshot(NamedTuple):
    """The particles at an instant, in the order of the start, and what moves around them."""

    time: float  # T
    collisions: float  # per particle, since the beginning, or since the gas began to cool
    position: np.ndarray  # (N, D) in a, folded into the box
    spin: np.ndarray | None  # (N, 2 D - 3) surface velocities in a/T; None without spin
    angle: np.ndarray | None  # (N,) by which disks have turned; None in space
    E_trans: float  # m a^2/T^2 per degree of freedom; in a sheared gas without the mean flow
    E_rot: float | None
    R: float | None
    floor: float | None  # its height in a; None without one
    slide: float | None  # displacement of the image above a sheared gas, from 0 to L
    walls: float | None  # displacement of shaken walls


def usual_take(experiment: Mapping[str, Any], scene: Scene) -> Take:
    """What is worth looking at: a driven gas once it should be stationary, for some periods of its
    drive, or until its images have slid by a whole period; a cooling gas while R settles."""
    schedule, effects = experiment["schedule"], scene.effects
    if schedule["kind"] == "cooling":
        return Take(*COOLING)
    wait = schedule.get("equilibrate", UNKNOWN_TRANSIENT)
    drive = effects.floor or effects.shaken_walls
    length = TIME if drive is None else PERIODS * drive.period
    if effects.shear is not None:
        length = effects.shear.length / effects.shear.velocity
    return Take(min(wait, PATIENCE / experiment["particles"]), length, FRAMES)


def snapshots(
    experiment: Mapping[str, Any], r: float, beta: float, seed: int, take: Take
) -> Iterator[Snapshot]:
    """The snapshots of a take of the point, one after the other.

    Those of a driven gas are equally spaced, each in the middle of its interval, away from the
    instants at which a sawtooth falls back. Those of a cooling gas are so in scaled time: their
    interval is a fixed share of the mean free time (Enskog's, at the present E_trans), so that the
    take is about as long as asked for. Angles are exact but where a particle has two contacts
    within one step, of one collision in the gas for each 200 particles.

    Raises InputError for illegal values, CollapseError where contacts accumulate without end.
    """
    scene = build(experiment, r, beta)
    if experiment["schedule"]["kind"] == "cooling":
        yield from _cooling(scene, experiment, seed, take)
    else:
        yield from _driven(scene, experiment, seed, take)


def _driven(scene, experiment, seed, take):
    state = initial_state(scene, experiment, np.random.default_rng(seed))
    recorder = Recorder()
    if take.start > 0.0:
        samples = math.ceil(take.start / experiment["schedule"]["sample_every"])
        recorder.in_time(state, scene, take.start / samples, samples)
    watched = _Watched(state, scene, recorder)
    interval = take.length / take.frames
    for frame in range(take.frames):
        watched.go_on_to(take.start + (frame + 0.5) * interval)
        yield watched.snapshot()


def _cooling(scene, experiment, seed, take):
    schedule, number = experiment["schedule"], experiment["particles"]
    first = np.random.SeedSequence(seed).spawn(1)[0]
    state = initial_state(scene, experiment, np.random.default_rng(first))
    recorder = Recorder()
    thermal = math.ceil(number / 2 * schedule["thermalise"])
    recorder.in_collisions(state, elastic(scene), thermal, 1)
    every = max(1, round(number / 2 * schedule["sample_every"]))
    watched = _Watched(state, scene, recorder, SAMPLES_PER_REFRESH * every)
    watched.let_collide(round(number / 2 * take.start))
    packing = _packing(experiment)
    for frame in range(take.frames):
        if frame > 0:
            frequency = collision_frequency(
                2.0 * watched.energies().translational, packing, len(scene.box)
            )
            watched.go_on_to(watched.time + take.length / take.frames / float(frequency))
        yield watched.snapshot()


def _packing(experiment):
    number, box = experiment["particles"], experiment["box"]
    return number * {2: math.pi, 3: 4.0 * math.pi / 3.0}[len(box)] / math.prod(box)


class _Watched:
    """A simulation under way, and the angles by which its disks have turned since it is watched.

    A cooling gas is refreshed after each `refresh` collisions (0: never), as it is for its point.
    """

    def __init__(self, state, scene, recorder, refresh=0):
        self._state, self._scene, self._recorder = state, scene, recorder
        self._refresh = refresh
        self._begun = 0 if refresh == 0 else int(state.counts[COLLISIONS])
        self._stride = max(1, len(state.changes) // STRIDES)
        self._angle = np.zeros(len(state.changes)) if _turns(scene) else None
        self._sample = recorder.once(state, scene, 0.0, 0)

    @property
    def time(self):
        """T since the beginning."""
        return float(self._sample["time"][0])

    @property
    def collisions(self):
        """Collisions since the beginning, or since the gas began to cool."""
        return int(self._state.counts[COLLISIONS]) - self._begun

    def go_on_to(self, time):
        """Advance to an instant, in T."""
        wanted, made = self._stride, self._stride
        while made == wanted:
            unit = 2.0 ** int(self._state.counts[EXPONENT])  # of the inverse of time
            wanted, made = self._step((time - self.time) * unit)

    def let_collide(self, collisions):
        """Advance until so many collisions have been made since the gas began to cool."""
        while self.collisions < collisions:
            self._step(np.inf)

    def energies(self):
        """Energies in m a^2/T^2, as they are measured."""
        number = len(self._state.changes)
        present = fluctuations(self._scene, self._sample, number)
        return restored(present, self._sample["exponent"]).map(lambda part: part[0])

    def snapshot(self):
        """What there is to be seen at the present instant."""
        state, scene, effects = self._state, self._scene, self._scene.effects
        present, time = self.energies(), self.time
        slide = displacement(effects.shear, time)
        unit = 2.0 ** int(state.counts[EXPONENT])
        spin = None if state.spin is None else in_order(state, state.spin) * unit
        return Snapshot(
            time=time,
            collisions=2.0 * self.collisions / len(state.changes),
            position=in_order(state, positions(state, scene, slide or 0.0)),
            spin=spin,
            angle=None if self._angle is None else self._angle.copy(),
            E_trans=float(present.translational),
            E_rot=None if spin is None else float(present.rotational),
            R=None if spin is None else float(ratio(present)),
            floor=displacement(effects.floor, time),
            slide=slide,
            walls=displacement(effects.shaken_walls, time),
        )

    def _step(self, interval):
        """Advance by an interval of the kernel's, or some collisions: those wanted, and made."""
        state, before = self._state, self.collisions
        wanted = self._stride
        if self._refresh:
            wanted = min(wanted, self._refresh - before % self._refresh)
        begun, spin = _now(state), None if self._angle is None else in_order(state, state.spin)
        self._sample = self._recorder.once(state, self._scene, interval, wanted)
        if self._angle is not None:
            self._turn(begun, spin[:, 0])
        made = self.collisions - before
        if self._refresh and made and self.collisions % self._refresh == 0:
            self._sample = self._recorder.in_collisions(state, self._scene, 0, 1, refresh=1)
        return wanted, made

    def _turn(self, begun, spin):
        """Add what was turned since an instant at which spins were as given."""
        state, now = self._state, _now(self._state)
        path = in_order(state, state.clock[BASE] + state.trajectory[:, -1])
        changed = np.clip(path, begun, now)  # the instant of the last contact, if there was one
        self._angle += spin * (changed - begun) + in_order(state, state.spin)[:, 0] * (
            now - changed
        )


def _turns(scene):
    return scene.effects.spin is not None and len(scene.box) == 2


def _now(state):
    return state.clock[BASE] + state.clock[NOW]


def in_order(state, values: np.ndarray) -> np.ndarray:
    """A copy of `values` (N, ...), one of each particle, in the order of the start."""
    ordered = np.empty_like(values)
    ordered[state.label] = values
    return ordered


def positions(state, scene: Scene, slide: float) -> np.ndarray:
    """Where the particles (N, D) are at the present instant, in a, folded into the box; `slide`
    is the displacement of the image above."""
    dimension = len(scene.box)
    elapsed = state.clock[NOW] - state.trajectory[:, -1]
    position = state.trajectory[:, :dimension] + (
        state.trajectory[:, dimension:-1] * elapsed[:, None]
    )
    if scene.effects.gravity is not None:
        position[:, -1] -= 0.5 * scene.effects.gravity.acceleration * elapsed**2
    if scene.effects.shear is not None:
        position[:, 0] -= slide * np.floor(position[:, 1] / scene.box[1])
    for axis, length in enumerate(scene.box):
        if length is not None:
            position[:, axis] %= length
    return position
