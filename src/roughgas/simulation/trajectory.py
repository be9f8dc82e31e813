"""A point's trajectory, frame by frame: where its particles are, and how far they have turned.

It is that of run_point with the same settings and seed; of a cooling gas, that of the first
replica. Units: particle radius a = mass m = time unit T = 1.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple, Self

import numpy as np

from roughgas.base import InputError, Interval
from roughgas.effects import inertia_of_spin
from roughgas.effects.paths import Paths
from roughgas.effects.species import packing
from roughgas.kernel.hooks import displacement
from roughgas.kernel.state import EXPONENT, Bodies
from roughgas.scene import Scene, has_sides
from roughgas.scene.initial import bounds
from roughgas.simulation import cooling, schedule, stages, steady
from roughgas.simulation.change import change
from roughgas.simulation.energies import Energies, ratio, restored, species_names
from roughgas.simulation.gas import Gas
from roughgas.simulation.paths import in_order, rotations, unwrapped_positions
from roughgas.simulation.restart import Initial, positions_and_velocities
from roughgas.simulation.stages import Stage
from roughgas.simulation.starts import prepared
from roughgas.theory.closed_forms import collision_frequency

STRIDES = 200  # particles for each collision of a step of a cooling gas
LONG = 100.0  # collisions per particle, of the steps of a driven gas
PATIENCE = 1_000_000  # particles times T that a movie waits for its gas to be stationary, at most
UNKNOWN_TRANSIENT = 1000.0  # T, where the schedule does not say how long to wait
PERIODS, FRAMES = 5, 125  # of a drive, and of a movie of a driven gas
TIME = 25.0  # T shown of a gas whose drive has no period

NUMBERS = range(2, 10_001)  # of frames
LEGAL = {"start": Interval("[0, 1e9]"), "length": Interval("(0, 1e9]")}


class Frames(NamedTuple):
    """What is filmed: in T, or in collisions per particle of a cooling gas."""

    start: float  # since the beginning, or since the gas began to cool
    length: float
    frames: int
    times: tuple[float, ...] = ()  # instants in rising order, in place of equal intervals

    @classmethod
    def at(cls, times: Sequence[float]) -> Self:
        """Return the take of these instants."""
        return cls(times[0], times[-1] - times[0], len(times), tuple(times))

    def options(self) -> list[str]:
        """Return the options of a command that mean this take."""
        if self.times:
            return ["--times", *map(repr, self.times)]
        return [f"--start={self.start}", f"--length={self.length}", f"--frames={self.frames}"]


COOLING = Frames(0.0, 16.0, 160)


class Snapshot(NamedTuple):
    """The particles at an instant, in the order of the start, and what moves around them."""

    time: float  # T
    collisions: float  # per particle, since the beginning, or since the gas began to cool
    position: np.ndarray  # (N, D) in a, folded into the box
    velocity: np.ndarray  # (N, D) in a/T, of the images in the box
    spin: np.ndarray | None  # (N, 2 D - 3) surface velocities in a/T; None without spin
    unwrapped: np.ndarray  # (N, D) positions in a along continuous paths; NaN along a shear flow
    angle: np.ndarray | None  # (N,) rad by which disks have turned; None in space
    E_trans: float  # m a^2/T^2 per degree of freedom; in a sheared gas without the mean flow
    E_rot: float | None
    R: float | None
    floor: float | None  # its height in a; None without one
    slide: float | None  # displacement of the image above a sheared gas, from 0 to L
    walls: float | None  # displacement of shaken walls
    bodies: Bodies | None = None  # what each particle is; None where all are alike
    # (low, high) of each axis, in a: the surfaces of walls on single sides; inf where there is none
    planes: Sequence[tuple[float, float]] = ()

    def radius(self) -> np.ndarray:
        """Return the radii of the particles, (N,) in a."""
        return np.ones(len(self.position)) if self.bodies is None else self.bodies.radius


def chosen(
    experiment: Mapping[str, Any],
    scene: Scene,
    start: float | None = None,
    length: float | None = None,
    frames: int | None = None,
    times: Sequence[float] | None = None,
    initial: Sequence[Initial] = (),
) -> Frames:
    """Return the take that is asked for; what is None is as usual, but that it begins where an
    `initial` state is. Raises InputError."""
    given = {"start": start, "length": length, "frames": frames}
    asked: dict[str, Any] = {name: value for name, value in given.items() if value is not None}
    for name, legal in LEGAL.items():
        if name in asked:
            asked[name] = legal.check(name, asked[name])
    if frames is not None and not (frames == int(frames) and frames in NUMBERS):
        raise InputError("frames", frames, f"be a whole number in [{NUMBERS[0]}, {NUMBERS[-1]}]")
    begun = initial[0].time if initial and schedule.of(experiment).DRIVEN else 0.0
    if times is None:
        usual = usual_take(experiment, scene)
        take = (usual._replace(start=begun) if initial else usual)._replace(**asked)
        _check_start("start", take.start, begun)
        return take
    times = [LEGAL["start"].check("times", float(time)) for time in times]
    if times:
        _check_start("times", times[0], begun)
    if asked or not times or times != sorted(set(times)):
        raise InputError("times", times, "rise, and stand without start, length and frames")
    return Frames.at(times)


def _check_start(key: str, start: float, begun: float) -> None:
    if start < begun:
        raise InputError(key, start, f"be {begun:g} or more, where the initial state is")


def usual_take(experiment: Mapping[str, Any], scene: Scene) -> Frames:
    """Return what is worth filming.

    That is a driven gas once it should be stationary, for some periods of its drive or until its
    images have slid by a whole period; or a cooling gas while R settles.
    """
    if schedule.of(experiment) is cooling:
        return COOLING
    if schedule.of(experiment) is stages:
        return Frames(0.0, stages.length(scene, experiment), FRAMES)
    wait = experiment["schedule"].get("equilibrate", UNKNOWN_TRANSIENT)
    shear, periods = scene.effects.shear, steady.drive_periods(scene).values()
    length = PERIODS * max(periods) if periods else TIME
    if shear is not None:
        length = shear.length / shear.velocity
    return Frames(min(wait, PATIENCE / experiment["particles"]), length, FRAMES)


def snapshots(
    scene: Scene,
    experiment: Mapping[str, Any],
    seed: int,
    take: Frames,
    initial: Sequence[Initial] = (),
) -> Iterator[Snapshot]:
    """Yield the snapshots of a take of a point, one after the other.

    It begins in the first of the `initial` states, if there are any: times of a driven gas go on
    from there, those of a cooling one begin anew.

    Where the take names no times, those of a driven gas are equally spaced, each in the middle of
    its interval, away from the instants at which a sawtooth falls back. Those of a cooling gas are
    equally spaced in scaled time: their interval is a fixed share of the mean free time (Enskog's,
    at the present E_trans), so that the take is about as long as asked for. The kernel counts the
    crossings of the box and the rotation of disks: both are exact, however long the intervals are.

    Raises InputError for illegal values, CollapseError where contacts accumulate without end.
    """
    kind = schedule.of(experiment)
    scene, experiment = _with_paths(scene, experiment)
    if initial:
        initial = prepared(initial, experiment, scene, seed)
    gas = kind.start(scene, experiment, seed, None, initial[:1])
    before = gas.collisions
    changes = stages.course(scene, experiment, gas.time) if kind is stages else []
    if kind is steady and take.start > gas.time:
        wait = take.start - gas.time
        samples = math.ceil(wait / experiment["schedule"]["sample_every"])
        gas.in_time(wait / samples, samples)
    # the instants of a cooling gas follow from its steps, to their roundings
    stride = max(1, gas.particles // STRIDES) if kind is cooling else gas.count(LONG)
    gas.look()

    def reach(instant: float) -> None:
        if kind is cooling:
            _make_collisions(gas, instant, stride, before)
        else:
            _let_pass(gas, instant, stride, changes)

    if kind is not steady:
        reach(take.start)
    turned = rotations(gas.state)
    for time in take.times:
        reach(time)
        yield _snapshot(gas, before, turned)
    if take.times:
        return
    if kind is cooling:
        yield _snapshot(gas, before, turned)
    interval = take.length / take.frames
    for frame in range(1 if kind is cooling else 0, take.frames):
        until = take.start + (frame + 0.5) * interval
        if kind is cooling:
            until = gas.time + interval / _collision_frequency(gas, experiment)
        _let_pass(gas, until, stride, changes)
        yield _snapshot(gas, before, turned)


def _with_paths(scene, experiment):
    """Return a scene and its settings with the effect `paths`, which changes no bit of a run."""
    effects = scene.effects._replace(paths=Paths())
    settings = {**experiment, "effects": {**experiment["effects"], "paths": {}}}
    return scene._replace(effects=effects), settings


def _let_pass(gas: Gas, until: float, stride: int, changes: list[Stage]) -> None:
    """Advance a gas to an instant (T), so many collisions at a time, and let stages begin."""
    while changes and changes[0].begin <= until:
        stage = changes.pop(0)
        # by way of the middle, from where the difference of the times is exact
        for instant in (0.5 * (gas.time + stage.begin), stage.begin):
            _let_pass(gas, instant, stride, [])
        change(gas, stage.scene, stage.begin, stage.temperatures)
    while gas.time < until and gas.step(until, stride):
        pass


def _make_collisions(gas: Gas, per_particle: float, stride: int, before: int) -> None:
    """Advance a gas to so many collisions per particle, rounded to whole ones in the gas, more than
    there were before."""
    wanted = before + round(gas.particles / 2 * per_particle)
    while gas.collisions < wanted:
        gas.step(math.inf, min(stride, wanted - gas.collisions))


def _collision_frequency(gas, experiment):
    """Return Enskog's; of a mixture about what it would be, from means of radii and masses."""
    T, dimension, bodies = (
        2.0 * _energies(gas).translational,
        len(experiment["box"]),
        gas.state.bodies,
    )
    found = float(collision_frequency(T, packing(experiment), dimension))
    if bodies is None:
        return found
    wide = np.mean(bodies.radius) ** (dimension - 1) / np.mean(bodies.radius**dimension)
    return found * float(wide * np.sqrt(np.mean(1.0 / bodies.mass)))


def _snapshot(gas: Gas, before: int, turned: np.ndarray | None) -> Snapshot:
    """Return the snapshot of the present instant.

    Collisions are counted from `before` on, and angles from `turned`, those at the take's start.
    """
    state, effects, present, time = gas.state, gas.scene.effects, _energies(gas), gas.time
    unit, spin = 2.0 ** int(state.counts[EXPONENT]), state.spin
    position, velocity = positions_and_velocities(state, gas.scene, time)
    unwrapped = unwrapped_positions(state, gas.scene)
    assert unwrapped is not None  # `_with_paths`
    angle = None if turned is None else rotations(state) - turned
    if spin is not None:
        spin = in_order(state, spin * unit)
    return Snapshot(
        time=time,
        collisions=2.0 * (gas.collisions - before) / gas.particles,
        position=in_order(state, position),
        velocity=in_order(state, velocity * unit),
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
        planes=bounds(effects, position.shape[1], time) if has_sides(effects) else (),
    )


def _bodies(state):
    if state.bodies is None:
        return None
    *of_each, largest, pairs = state.bodies
    return Bodies(*(in_order(state, values) for values in of_each), largest, pairs)


def _energies(gas: Gas) -> Energies:
    """Return the energies of the last sample, in m a^2/T^2."""
    present = restored(gas.energies(gas.sample), gas.sample["exponent"])
    return present.map(lambda part: part[0])


MOVED = {
    **{"image_shift": "slide", "floor_height": "floor", "wall_displacement": "walls"},
    "unwrapped_position": "unwrapped",
}
"""Variables of a trajectory that have other names in a Snapshot."""
OF_EACH = ("time", "position", "velocity", "spin", "angle", "E_trans", "E_rot", "R")


def variables(
    scene: Scene, experiment: Mapping[str, Any], shots: Sequence[Snapshot]
) -> dict[str, Any]:
    """Return the variables of a trajectory (see roughgas.data.trajectory) with these snapshots."""
    dimension = len(scene.box)
    names = {name: name for name in OF_EACH} | MOVED
    names["collisions_per_particle"] = "collisions"
    parts = {name: [getattr(shot, field) for shot in shots] for name, field in names.items()}
    lengths = [np.nan if side == "open" else float(side) for side in experiment["box"]]
    return {name: np.array(part) for name, part in parts.items() if part[0] is not None} | {
        "axis": list("xyz"[:dimension]),
        "radius": shots[0].radius(),
        **_particles_of(shots[0], experiment),
        **_moments_of(shots[0], scene),
        "box": np.array(lengths),
        "periodic": np.array([length is not None for length in scene.box], "i1"),
    }


def _particles_of(shot: Snapshot, experiment: Mapping[str, Any]) -> dict[str, Any]:
    """Return what else each particle is, where they differ."""
    if shot.bodies is None:
        return {}
    return species_names(experiment) | {
        "mass": shot.bodies.mass,
        "inertia": shot.bodies.inertia,
        "species_of": shot.bodies.species,
    }


def _moments_of(shot: Snapshot, scene: Scene) -> dict[str, np.ndarray]:
    """Return the moments of inertia (N,) in m a^2 of particles that spin."""
    if shot.spin is None:
        return {}
    bodies = shot.bodies
    if bodies is None:
        moments = np.full(len(shot.position), inertia_of_spin(scene.effects))
    else:
        moments = bodies.inertia * bodies.mass * bodies.radius**2
    return {"moment_of_inertia": moments}
