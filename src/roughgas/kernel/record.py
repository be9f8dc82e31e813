"""Driver of the kernel: advance a gas, and record sums over particles, and frames, at intervals.

A sample is a row of sums at an instant, a frame a copy of all particles; a leg is a stretch of a
run with one sampling.
"""

import math
from typing import NamedTuple

import numpy as np

from roughgas.compiling.jit import by_reference, compiled, entry, jit
from roughgas.kernel.hooks import sums as sums_of
from roughgas.kernel.loop import REACHED, advance, restart
from roughgas.kernel.mathematics import read, write
from roughgas.kernel.particles import (
    enter_box,
    mass_of,
    position_in_box,
    radius_of,
    set_path,
    spin_mass_of,
    spin_of,
)
from roughgas.kernel.state import (
    BASE,
    BOUNDARY_HITS,
    COLLISIONS,
    EXPONENT,
    INSTANT_END,
    NOW,
    ORIGIN,
    STARTED,
    State,
)

UNLIMITED = 2**62


class Sampling(NamedTuple):
    """When samples are taken: every `interval` of time or every `collisions`, the earlier of both.

    The interval is in current units of time. Samples are counted from the beginning of a leg. One
    call of the kernel covers a segment of the leg, of any length: results do not depend on where
    calls end, to the last bit.
    """

    interval: float
    collisions: int
    refresh: int  # samples between refreshes of a cooling gas, omitted where the last sample was
    # triggered by its interval; 0: never
    hits: int = UNLIMITED  # contacts with walls and floor in a call, above which it ends early
    taken: int = 0  # samples of the leg before this call
    first: int = 0  # the sample of the leg with the first frame
    every: int = 0  # samples between frames; 0: no frames

    def frames_until(self, taken: int) -> int:
        """Return the number of frames of a leg up to its sample number `taken`.

        A frame at the beginning of the leg does not count.
        """
        if self.every == 0 or taken < max(1, self.first):
            return 0
        at_beginning = 0 if self.first > 0 else 1  # which is no sample
        return (taken - self.first) // self.every + 1 - at_beginning


class RawFrames(NamedTuple):
    """Copies of the arrays of State that describe the particles, at k instants."""

    trajectory: np.ndarray  # (k, N, 2 D + 1)
    spin: np.ndarray | None  # (k, N, 2 D - 3); None without spin
    label: np.ndarray  # (k, N)
    crossings: np.ndarray | None  # (k, N, D); None without the effect paths
    rotation: np.ndarray | None  # (k, N); None as State.paths.rotation is
    ledger: np.ndarray  # (k, 2, accounts + 1, 2)
    clock: np.ndarray  # (k, 8)
    counts: np.ndarray  # (k, 13)
    rows: np.ndarray  # (k,) the row of `samples` of each frame
    stored: np.ndarray  # (1,) number of stored frames

    def at(self, numbers: np.ndarray) -> "RawFrames":
        """Return copies of the frames with these numbers, an array of indices from 0."""
        arrays = self._replace(stored=np.array([len(numbers)]))._asdict()
        copies = {
            name: array[numbers]
            for name, array in arrays.items()
            if array is not None and name != "stored"
        }
        return self._replace(**copies, stored=arrays["stored"])


def allocate_frames(state: State, frames: int) -> RawFrames:
    """Return uninitialised arrays for `frames` frames of a gas with this state."""

    def copies(array):
        """Return an array for `frames` copies of an array of the state; None for a missing one."""
        return None if array is None else np.empty((frames, *array.shape), array.dtype)

    paths = state.paths
    return RawFrames(
        trajectory=copies(state.trajectory),
        spin=copies(state.spin),
        label=copies(state.label),
        crossings=None if paths is None else copies(paths.crossings),
        rotation=None if paths is None else copies(paths.rotation),
        ledger=copies(state.ledger),
        clock=copies(state.clock),
        counts=copies(state.counts),
        rows=np.zeros(frames, np.int64),
        stored=np.zeros(1, np.int64),
    )


def columns(scene):
    """Return the names of the columns of samples that `record` fills, in order.

    Sums over all particles; then sums over each species, if there are several, as `vv_x[0]`; then
    running sums of effects since the start. `vv_x` sums v_x^2, `p_x` v_x, `y`, `yy` and `yv_x` sum
    h, h^2 and h v_x of the height h above Scene.middle along the second axis, `ww` (a w)^2, and `w`
    a w. Where particles differ, sums without spin are weighted with masses; with s = m q over the q
    of the scene, `ww` is the sum of s (a w)^2, and `w` the sum of s a (a w), which over a^2 is the
    angular momentum. Velocities are in current units, `exponent` is their power of two; time and
    running sums are in units of a and T.
    """
    dimension, effects = len(scene.box), scene.effects
    axes = "xyz"[:dimension]
    sums = [f"vv_{k}" for k in axes] + [f"p_{k}" for k in axes] + ["y", "yy", "yv_x"]
    if effects.spin is not None:
        sums += ["ww"] + (["w"] if dimension == 2 else ["w_x", "w_y", "w_z"])
    number_of_species = 0 if effects.species is None else effects.species.kinds
    return (
        ["time", "collisions", "exponent"]
        + sums
        + [f"{name}[{species}]" for species in range(number_of_species) for name in sums]
        + [name for names in sums_of(effects).values() for name in names]
    )


@entry(cache=True)
def record(state, scene, sampling, samples, frames):
    """Advance a gas; fill a row of `samples` at each sample, and store frames.

    `samples` is an array (rows, columns), with the columns of `columns`; `sampling` is a Sampling,
    `frames` RawFrames with room for the frames due. Returns the outcome (see `advance`) and the
    number of rows filled: all, if it is REACHED.
    """
    state, scene, frames = by_reference(state), by_reference(scene), by_reference(frames)
    if state.counts[STARTED] == 0:
        restart(state, scene)
        state.counts[STARTED] = 1
    hits = state.counts[BOUNDARY_HITS] + sampling.hits
    for k in range(len(samples)):
        now = state.clock[BASE] + state.clock[NOW]
        collisions = state.counts[COLLISIONS] + sampling.collisions
        outcome = advance(state, scene, now + sampling.interval, collisions, hits)
        if outcome != REACHED:
            return outcome, k
        take_sample(state, scene, samples, k)
        taken = sampling.taken + k + 1
        if sampling.refresh > 0 and taken % sampling.refresh == 0:
            if state.counts[COLLISIONS] >= collisions:
                refresh(state, scene)
        after_first = taken - sampling.first
        if sampling.every > 0 and after_first >= 0 and after_first % sampling.every == 0:
            store_frame(state, frames, k)
    return REACHED, len(samples)


@compiled
def store_frame(state, frames, row):
    """Copy the present state of the particles to the next free frame of RawFrames.

    `row` is the index of the sample at this instant.
    """
    frame = frames.stored[0]
    frames.stored[0] += 1
    frames.rows[frame] = row
    for i in range(len(state.changes)):
        frames.label[frame, i] = state.label[i]
        for k in range(state.trajectory.shape[1]):
            frames.trajectory[frame, i, k] = state.trajectory[i, k]
        if state.spin is not None:
            for k in range(state.spin.shape[1]):
                frames.spin[frame, i, k] = state.spin[i, k]
        if state.paths is not None:
            for k in range(state.paths.crossings.shape[1]):
                frames.crossings[frame, i, k] = state.paths.crossings[i, k]
            if state.paths.rotation is not None:
                frames.rotation[frame, i] = state.paths.rotation[i]
    for account in range(state.ledger.shape[1]):
        for k in range(2):
            frames.ledger[frame, 0, account, k] = state.ledger[0, account, k]
            frames.ledger[frame, 1, account, k] = state.ledger[1, account, k]
    for k in range(len(state.clock)):
        frames.clock[frame, k] = state.clock[k]
    for k in range(len(state.counts)):
        frames.counts[frame, k] = state.counts[k]


@compiled
def take_sample(state, scene, samples, row_index):
    """Fill row `row_index` of samples with sums over the particles at the present instant.

    `samples` is an array (rows, columns): see `columns`. Leaves the state as it is.
    """
    time, row = state.clock[NOW], samples[row_index]
    for k in range(len(row)):
        row[k] = 0.0
    unit = math.ldexp(1.0, -int(state.counts[EXPONENT]))
    row[0] = state.clock[ORIGIN] + (state.clock[BASE] + time) * unit
    row[1] = state.counts[COLLISIONS]
    row[2] = state.counts[EXPONENT]
    axes = len(scene.box)
    sums = tuple(0.0 for k in range(2 * axes + 3 if state.spin is None else 4 * axes + 1))
    for i in range(len(state.changes)):
        position, velocity = position_in_box(state, scene, i, time)
        sums = _with_particle(state, scene, i, position, velocity, sums)
        if state.bodies is not None:
            first = 3 + len(sums) * (1 + state.bodies.species[i])
            species_sums = read(samples, row_index, first, sums)
            species_sums = _with_particle(state, scene, i, position, velocity, species_sums)
            write(samples, row_index, first, species_sums)
    write(samples, row_index, 3, sums)
    _enter_sums(state.sums, state.counts[EXPONENT], row)


@jit
def _with_particle(state, scene, i, position, velocity, sums):
    """Return the tuple of sums over particles plus the terms of particle i.

    Position (in the box) and velocity are the particle's at the instant of the sample.
    """
    mass, n = mass_of(state.bodies, i), len(position)
    height = position[1] - scene.middle
    squares = tuple(sums[k] + mass * (velocity[k] * velocity[k]) for k in range(n))
    momenta = tuple(sums[n + k] + mass * velocity[k] for k in range(n))
    profile = (
        sums[2 * n] + mass * height,
        sums[2 * n + 1] + mass * (height * height),
        sums[2 * n + 2] + mass * (height * velocity[0]),
    )
    if state.spin is None:
        return squares + momenta + profile
    share = 1.0
    if state.bodies is not None:
        share = spin_mass_of(state.bodies, scene.effects.spin, i) / scene.effects.spin.inertia
    lever = share * radius_of(state.bodies, i)
    spin = spin_of(state.spin, scene.box, i)
    square = sums[2 * n + 3]
    for k in range(2 * n - 3):
        square += share * (spin[k] * spin[k])
    turning = tuple(sums[2 * n + 4 + k] + lever * spin[k] for k in range(2 * n - 3))
    return squares + momenta + profile + (square,) + turning


@jit
def _enter_sums(sums, exponent, row):
    """Write the running sums of all effects to the last columns of a row of samples.

    `sums` is State.sums, `exponent` State.counts[EXPONENT].
    """
    if sums is not None:
        end = len(row)
        for k in range(len(sums) - 1, -1, -1):
            if sums[k] is not None:
                end -= sums[k].shape[1]
                for column in range(sums[k].shape[1]):
                    row[end + column] = _running_sum(sums[k], column, exponent)


@jit
def _running_sum(sums, k, exponent):
    """Return running sum k in units of a and T; terms below the smallest double become zero.

    `sums` (3, sums) is an effect's entry in State.sums, `exponent` State.counts[EXPONENT].
    """
    return sums[1, k] + math.ldexp(sums[0, k], int(sums[2, k] * exponent))


@compiled
def refresh(state, scene):
    """Bring a cooling gas up to the present, remove its momentum, and rescale its velocities.

    Velocities become of the order of 1, by a power of two, which changes no digit;
    State.counts[EXPONENT] is the sum of the exponents. Each contact leaves a rounding error in the
    momentum. Velocities decay but these errors do not, and in the end the motion of the centre of
    mass would hold all the energy. Between walls momentum is not conserved, and not removed.
    """
    number, dimension = len(state.changes), len(scene.box)
    time = state.clock[NOW]
    for i in range(number):
        position, velocity = enter_box(state, scene, i, time)
        set_path(state, scene, i, position, velocity, time)
    square = 0.0
    for k in range(dimension, 2 * dimension):
        mean = _mean_velocity(state, k) if state.agenda.boundary_time is None else 0.0
        for i in range(number):
            state.trajectory[i, k] -= mean
            square += state.trajectory[i, k] * state.trajectory[i, k]
    if square > 0.0:
        rescale(state, scene, math.frexp(math.sqrt(square / number))[1])
    restart(state, scene)


@jit
def _mean_velocity(state, k):
    """Return a component of the velocity of the centre of mass: column k of the trajectories."""
    momentum, mass = 0.0, 0.0
    for i in range(len(state.trajectory)):
        momentum += mass_of(state.bodies, i) * state.trajectory[i, k]
        mass += mass_of(state.bodies, i)
    return momentum / mass


@jit
def rescale(state, scene, power):
    """Divide velocities by 2^power and multiply times by it, with all particles at one instant.

    `power` is an integer. The clock restarts from 0 at this instant; earlier energies and running
    sums are converted to units of a and T.
    """
    clock, dimension, particle_times = state.clock, len(scene.box), state.particle_times
    factor = math.ldexp(1.0, -power)
    unit = math.ldexp(1.0, -int(state.counts[EXPONENT]))
    clock[ORIGIN] += (clock[BASE] + clock[NOW]) * unit
    for i in range(len(state.changes)):
        state.trajectory[i, 2 * dimension] = 0.0
        for k in range(dimension, 2 * dimension):
            state.trajectory[i, k] *= factor
        if state.spin is not None:
            for k in range(state.spin.shape[1]):
                state.spin[i, k] *= factor
        for k in range(len(particle_times)):
            if particle_times[k] is not None:
                particle_times[k][i] = (particle_times[k][i] - clock[NOW]) / factor
    for account in range(state.ledger.shape[1]):
        for k in range(2):
            state.ledger[1, account, k] += state.ledger[0, account, k] / (unit * unit)
            state.ledger[0, account, k] = 0.0
    _carry_over_sums(state.sums, state.counts[EXPONENT])
    state.counts[EXPONENT] += power
    clock[BASE] = 0.0
    clock[NOW] = 0.0
    clock[INSTANT_END] = 0.0


@jit
def _carry_over_sums(sums, exponent):
    """Convert the running sums of all effects to units of a and T, before the exponent changes.

    `sums` is State.sums, `exponent` State.counts[EXPONENT].
    """
    if sums is not None:
        for k in range(len(sums)):
            if sums[k] is not None:
                for column in range(sums[k].shape[1]):
                    sums[k][1, column] = _running_sum(sums[k], column, exponent)
                    sums[k][0, column] = 0.0
