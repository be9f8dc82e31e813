"""A point's trajectory, frame by frame: where its particles are, and how far they have turned.

It is that of run_point with the same settings and seed; of a cooling gas, that of the first
replica. Units: particle radius a = mass m = time unit T = 1.
"""

import math
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from roughgas.kernel.hooks import displacement
from roughgas.kernel.state import BASE, EXPONENT, NOW, State
from roughgas.scene import Scene, build
from roughgas.simulation import cooling, schedule
from roughgas.simulation.energies import Energies, ratio, restored
from roughgas.simulation.gas import Gas
from roughgas.simulation.instant import in_order, whereabouts
from roughgas.theory.frequencies import collision_frequency, packing_fraction

STRIDES = 200  # steps are of one collision in the gas for each so many particles
PATIENCE = 1_000_000  # particles times T that a movie waits for its gas to be stationary, at most
UNKNOWN_TRANSIENT = 1000.0  # T, where the schedule does not say how long to wait
PERIODS, FRAMES = 5, 125  # of a drive, and of a movie of a driven gas
TIME = 25.0  # T shown of a gas whose drive has no period


class Take(NamedTuple):
    """What is filmed: in T, or in collisions per particle of a cooling gas."""

    start: float  # since the beginning, or since the gas began to cool
    length: float
    frames: int


COOLING = Take(0.0, 16.0, 160)


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
    """Return what is worth filming.

    That is a driven gas once it should be stationary, for some periods of its drive or until its
    images have slid by a whole period; or a cooling gas while R settles.
    """
    if schedule.of(experiment) is cooling:
        return COOLING
    wait = experiment["schedule"].get("equilibrate", UNKNOWN_TRANSIENT)
    shear, drive = scene.effects.shear, scene.effects.floor or scene.effects.shaken_walls
    length = PERIODS * drive.period if drive else TIME
    if shear is not None:
        length = shear.length / shear.velocity
    return Take(min(wait, PATIENCE / experiment["particles"]), length, FRAMES)


def snapshots(
    experiment: Mapping[str, Any], r: float, beta: float, seed: int, take: Take
) -> Iterator[Snapshot]:
    """Yield the snapshots of a take of the point, one after the other.

    Those of a driven gas are equally spaced, each in the middle of its interval, away from the
    instants at which a sawtooth falls back. Those of a cooling gas are equally spaced in scaled
    time: their interval is a fixed share of the mean free time (Enskog's, at the present E_trans),
    so that the take is about as long as asked for. Angles are exact unless a particle has two
    contacts within one step, of one collision in the gas for each 200 particles.

    Raises InputError for illegal values, CollapseError where contacts accumulate without end.
    """
    scene, kind = build(experiment, r, beta), schedule.of(experiment)
    gas = kind.start(scene, experiment, seed)
    stride = max(1, gas.particles // STRIDES)
    if kind is not cooling and take.start > 0.0:
        samples = math.ceil(take.start / experiment["schedule"]["sample_every"])
        gas.in_time(take.start / samples, samples)
    if scene.effects.spin is not None and len(scene.box) == 2:
        gas.watcher = Turning(gas.particles)
    gas.look()
    if kind is cooling:
        while gas.collisions < round(gas.particles / 2 * take.start):
            gas.step(math.inf, stride)
        yield _snapshot(gas)
    interval = take.length / take.frames
    for frame in range(1 if kind is cooling else 0, take.frames):
        until = take.start + (frame + 0.5) * interval
        if kind is cooling:
            until = gas.time + interval / _collision_frequency(gas, experiment["box"])
        while gas.step(until, stride):
            pass
        yield _snapshot(gas)


class Turning:
    """Watches a gas of disks: the angles (N,) by which they have turned, in the order of the start.

    A Watcher of roughgas.simulation.gas.
    """

    def __init__(self, particles: int) -> None:
        self.angle = np.zeros(particles)

    def before(self, state: State) -> None:
        """Note the instant, and the spins at it."""
        self._begun, self._spin = _now(state), in_order(state, state.spin)[:, 0]

    def after(self, state: State) -> None:
        """Add what was turned since then: with the old spin up to a contact, the new one after."""
        now = _now(state)
        path = in_order(state, state.clock[BASE] + state.trajectory[:, -1])
        contact = np.clip(path, self._begun, now)  # the last one, if there was one in this step
        spin = in_order(state, state.spin)[:, 0]
        self.angle += self._spin * (contact - self._begun) + spin * (now - contact)


def _collision_frequency(gas, box):
    packing = packing_fraction(gas.particles, box)
    return float(collision_frequency(2.0 * _energies(gas).translational, packing, len(box)))


def _snapshot(gas: Gas) -> Snapshot:
    """Return what there is to be seen at the present instant."""
    state, effects, present, time = gas.state, gas.scene.effects, _energies(gas), gas.time
    spin = state.spin
    if spin is not None:
        spin = in_order(state, spin * 2.0 ** int(state.counts[EXPONENT]))
    return Snapshot(
        time=time,
        collisions=2.0 * gas.collisions / gas.particles,
        position=in_order(state, whereabouts(state, gas.scene, time)[0]),
        spin=spin,
        angle=gas.watcher.angle.copy() if gas.watcher else None,
        E_trans=present.translational,
        E_rot=present.rotational,
        R=None if spin is None else float(ratio(present)),
        floor=displacement(effects.floor, time),
        slide=displacement(effects.shear, time),
        walls=displacement(effects.shaken_walls, time),
    )


def _energies(gas: Gas) -> Energies:
    """Return the energies of the last sample, in m a^2/T^2."""
    present = restored(gas.energies(gas.sample), gas.sample["exponent"])
    return present.map(lambda part: float(part[0]))


def _now(state):
    return state.clock[BASE] + state.clock[NOW]
