"""The trajectory of a point: takes, snapshots of particles, and the variables of its dataset.

It belongs to the run of run_point with the same settings and seed, or to its first replica if the
gas cools. Units: particle radius a = mass m = time unit T = 1.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple, Self

import numpy as np

from roughgas.base import InputError, Interval, NamedValues
from roughgas.effects import inertia_of_spin
from roughgas.kernel.state import Bodies
from roughgas.scene import Scene
from roughgas.simulation import cooling, protocols, stages, steady
from roughgas.simulation.energies import species_names
from roughgas.simulation.experiment import Experiment
from roughgas.simulation.initial_states import InitialState

MAX_WAIT = 1_000_000  # particles times T: limit of the wait for a stationary gas
DEFAULT_WAIT = 1000.0  # T, if the schedule has no wait
PERIODS, FRAMES = 5, 125  # periods of a drive, and frames, in a take of a driven gas
DEFAULT_LENGTH = 25.0  # T, for a drive without period

FRAME_COUNTS = range(2, 10_001)
TAKE_TIMES = {"start": Interval("[0, 1e9]"), "length": Interval("(0, 1e9]")}


class Take(NamedTuple):
    """The start, length and frames of a film.

    Times are in T, or in collisions per particle of a cooling gas.
    """

    start: float  # since the beginning, or since the gas began to cool
    length: float
    frames: int
    times: tuple[float, ...] = ()  # instants in rising order, in place of equal intervals

    @classmethod
    def at(cls, times: Sequence[float]) -> Self:
        """Return the take whose frames are at these instants, rising."""
        return cls(times[0], times[-1] - times[0], len(times), tuple(times))

    def options(self) -> list[str]:
        """Return the command-line options that request this take."""
        if self.times:
            return ["--times", *map(repr, self.times)]
        return [f"--start={self.start}", f"--length={self.length}", f"--frames={self.frames}"]


COOLING_TAKE = Take(0.0, 16.0, 160)


class Snapshot(NamedTuple):
    """The particles at an instant, in the order of the start, and the positions of boundaries."""

    time: float  # T
    collisions: float  # per particle, since the beginning, or since the gas began to cool
    position: np.ndarray  # (N, D) in a, folded into the box
    velocity: np.ndarray  # (N, D) in a/T, of the images in the box
    spin: np.ndarray | None  # (N, 2 D - 3) surface velocities in a/T; None without spin
    unwrapped: np.ndarray  # (N, D) positions in a along continuous paths; NaN along a shear flow
    angle: np.ndarray | None  # (N,) rotation of disks in rad; None in space
    E_trans: float  # m a^2/T^2 per degree of freedom; in a sheared gas without the mean flow
    E_rot: float | None
    R: float | None
    floor: float | None  # height in a; None without a floor
    slide: float | None  # displacement of the image above a sheared gas, from 0 to L
    walls: float | None  # displacement of shaken walls
    bodies: Bodies | None = None  # of each particle; None if all are identical
    # (low, high) of each axis, in a: the surfaces of walls on single sides; inf without a wall
    planes: Sequence[tuple[float, float]] = ()

    def radius(self) -> np.ndarray:
        """Return the radii of the particles, (N,) in a."""
        return np.ones(len(self.position)) if self.bodies is None else self.bodies.radius


def requested_take(
    experiment: Experiment,
    scene: Scene,
    start: float | None = None,
    length: float | None = None,
    frames: int | None = None,
    times: Sequence[float] | None = None,
    initial: Sequence[InitialState] = (),
) -> Take:
    """Return the requested take; options that are None have the values of `default_take`.

    `start`, `length` and `times` are in T, or in collisions per particle of a cooling gas; `frames`
    is the number of frames. Without `start` the take begins at the time of an `initial` state.
    Raises InputError for illegal or contradictory options.
    """
    options = {"start": start, "length": length, "frames": frames}
    given_options: dict[str, Any] = {
        name: value for name, value in options.items() if value is not None
    }
    for name, legal in TAKE_TIMES.items():
        if name in given_options:
            given_options[name] = legal.check(name, given_options[name])
    if frames is not None and not (frames == int(frames) and frames in FRAME_COUNTS):
        raise InputError(
            "frames", frames, f"be a whole number in [{FRAME_COUNTS[0]}, {FRAME_COUNTS[-1]}]"
        )
    start_time = initial[0].time if initial and protocols.protocol_of(experiment).DRIVEN else 0.0
    if times is None:
        default = default_take(experiment, scene)
        take = (default._replace(start=start_time) if initial else default)._replace(
            **given_options
        )
        _check_start("start", take.start, start_time)
        return take
    times = [TAKE_TIMES["start"].check("times", float(time)) for time in times]
    if times:
        _check_start("times", times[0], start_time)
    if given_options or not times or times != sorted(set(times)):
        raise InputError("times", times, "rise, and stand without start, length and frames")
    return Take.at(times)


def _check_start(key: str, start: float, earliest: float) -> None:
    """Raise InputError for a take that starts before `earliest`; `key` is the option's name."""
    if start < earliest:
        raise InputError(key, start, f"be {earliest:g} or more, where the initial state is")


def default_take(experiment: Experiment, scene: Scene) -> Take:
    """Return the default take of an experiment.

    A driven gas is filmed once it should be stationary, for some periods of its drive or until its
    images have shifted by a period; a cooling gas is filmed while R settles.
    """
    if protocols.protocol_of(experiment) is cooling:
        return COOLING_TAKE
    if protocols.protocol_of(experiment) is stages:
        return Take(0.0, stages.length(scene, experiment), FRAMES)
    wait = getattr(experiment.schedule, "equilibrate", DEFAULT_WAIT)
    shear, periods = scene.effects.shear, steady.drive_periods(scene).values()
    length = PERIODS * max(periods) if periods else DEFAULT_LENGTH
    if shear is not None:
        length = shear.length / shear.velocity
    return Take(min(wait, MAX_WAIT / experiment.particles), length, FRAMES)


SNAPSHOT_FIELDS = {
    **{"image_shift": "slide", "floor_height": "floor", "wall_displacement": "walls"},
    "unwrapped_position": "unwrapped",
}
"""Fields of a Snapshot for variables of a trajectory with different names."""
SAME_NAMES = ("time", "position", "velocity", "spin", "angle", "E_trans", "E_rot", "R")


def trajectory_variables(
    scene: Scene, experiment: Experiment, snapshots: Sequence[Snapshot]
) -> NamedValues:
    """Return the variables of a trajectory by name, from its snapshots.

    They are defined in roughgas.data.trajectory.
    """
    dimension = len(scene.box)
    names = {name: name for name in SAME_NAMES} | SNAPSHOT_FIELDS
    names["collisions_per_particle"] = "collisions"
    columns = {
        name: [getattr(snapshot, field) for snapshot in snapshots] for name, field in names.items()
    }
    lengths = [np.nan if side is None else side for side in experiment.lengths]
    return {name: np.array(column) for name, column in columns.items() if column[0] is not None} | {
        "axis": list("xyz"[:dimension]),
        "radius": snapshots[0].radius(),
        **_particle_variables(snapshots[0], experiment),
        **_moment_variables(snapshots[0], scene),
        "box": np.array(lengths),
        "periodic": np.array([length is not None for length in scene.box], "i1"),
    }


def _particle_variables(snapshot: Snapshot, experiment: Experiment) -> NamedValues:
    """Return species names, and mass, q and species of each particle, by name.

    The result is empty if all particles are identical.
    """
    if snapshot.bodies is None:
        return {}
    return species_names(experiment) | {
        "mass": snapshot.bodies.mass,
        "inertia": snapshot.bodies.inertia,
        "species_of": snapshot.bodies.species,
    }


def _moment_variables(snapshot: Snapshot, scene: Scene) -> dict[str, np.ndarray]:
    """Return the moments of inertia (N,) in m a^2 of particles that spin, by name; else nothing."""
    if snapshot.spin is None:
        return {}
    bodies = snapshot.bodies
    if bodies is None:
        moments = np.full(len(snapshot.position), inertia_of_spin(scene.effects))
    else:
        moments = bodies.inertia * bodies.mass * bodies.radius**2
    return {"moment_of_inertia": moments}
