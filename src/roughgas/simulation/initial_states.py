"""Initial states of runs: physical states, and optionally the kernel's memory.

Extents (D,) are the widths of the region that the particles occupied at the start of a run, in a.

A physical state consists of positions, velocities and spins at an instant. From these a run
continues to within rounding, in this version of the kernel or another, also with another r, beta or
drive.

The kernel's memory consists of all arrays of its State as bytes. Contacts predicted anew would have
other roundings than earlier predictions, and collisions are chaotic; with the memory a run
continues bit by bit as if it had not stopped. A memory belongs to one kernel and one scene, and is
not used for others.
"""

import hashlib
import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from roughgas.base import InputError
from roughgas.kernel.layout import new_state
from roughgas.kernel.state import BASE, COLLISIONS, EXPONENT, NOW, State
from roughgas.scene import Scene, build_bodies
from roughgas.scene.settings import SceneSettings
from roughgas.simulation.free_flight import begin_paths, in_starting_order, positions_and_velocities
from roughgas.simulation.run_failures import time_of
from roughgas.simulation.state_encoding import (
    UnusableCheckpoint,
    arrays_from_bytes,
    decode,
    state_bytes,
)

BODY_VARIABLES = {"radius": "radius", "species": "species_of"}
"""Quantities of particles of a mixture in an InitialState, and the names of their variables."""
CHECKED_QUANTITIES = ("mass", "inertia")
"""Quantities of particles in a dataset that must equal those of the settings."""
MEMORY_KEY = "initial.last_memory"
LARGEST_IN_HEADER = 2.0**50  # collisions before cooling, or extents in a
SEAL_BYTES = 32  # length of the checksum at the end of a memory
CARRIED, SEED, RESEED = "", "seed", "reseed"
"""Source of a run's noise: the seed of the earlier run (CARRIED), or the option of that name."""


class InitialState(NamedTuple):
    """A state at the start of a run: the particles' motion, and optionally the kernel's memory."""

    position: np.ndarray  # (N, D) in a
    velocity: np.ndarray  # (N, D) in a/T, of the images in the box
    spin: np.ndarray | None = None  # (N, 2 D - 3) in a/T; None without spin
    radius: np.ndarray | None = None  # (N,) in a; None if all particles are identical
    species: np.ndarray | None = None  # (N,) from 0
    time: float = 0.0  # T, which sets the phase of drives
    memory: bytes = b""  # of the kernel
    memory_owner: str = ""  # see memory_owner()
    names: tuple[str, ...] = ()  # of the species; empty: they are numbered as in the experiment
    of_settings: Mapping[str, np.ndarray] = {}  # (N,) each, to be checked: CHECKED_QUANTITIES
    seed: Any = 1  # of the run that ended in this state, as in its dataset
    noise: str = CARRIED  # or SEED, or RESEED
    box: np.ndarray | None = None  # (D,) in a, of a file of another program, to be checked
    file: str = ""  # of another program, and its frame

    def digest(self) -> str:
        """Return a checksum of all content that a run from this state depends on.

        It has 16 hexadecimal digits.
        """
        content = self.physics() + self.memory + self.memory_owner.encode()
        return hashlib.sha256(content).hexdigest()[:16]

    def bodies(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the radii and the species of the particles of a mixture, (N,) each."""
        assert self.radius is not None and self.species is not None
        return self.radius, self.species.astype(int)

    def physics(self) -> bytes:
        """Return the physical state as bytes, without the kernel's memory."""
        arrays = [np.asarray(array, float).tobytes() for array in self[:5] if array is not None]
        return b"".join(arrays) + repr(float(self.time)).encode()

    def generator(self, rng: np.random.Generator) -> np.random.Generator:
        """Return the random generator of a run that begins in this state.

        `rng` is the generator of the run's seed, and advances by one draw. Different states have
        different random numbers with the same seed, so that a loop which changes states between
        runs does not repeat its noise. The species numbers of the particles have no influence.
        """
        content = self._replace(species=None).physics()
        state = int.from_bytes(hashlib.sha256(content).digest()[:16], "little")
        return np.random.default_rng([int(rng.integers(2**63)), state])


def memory_owner(scene: Scene) -> str:
    """Return a hash of kernel and scene, equal for runs that can use each other's kernel memory."""
    from roughgas.compiling.cache_folders import SOURCE_HASH

    # paths do not influence the motion, and are not in a memory
    scene = scene._replace(effects=scene.effects._replace(paths=None))
    text = repr((SOURCE_HASH, np.__version__, scene))
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def is_memory_of(initial: InitialState, scene: Scene) -> bool:
    """Return whether a run of the scene can continue bit by bit with the memory of a state.

    Both the memory and the physical state must be unchanged: the kernel does not check its memory.
    """
    seal = _seal(initial.memory[:-SEAL_BYTES], initial)
    return initial.memory[-SEAL_BYTES:] == seal and initial.memory_owner == memory_owner(scene)


def _seal(memory: bytes, initial: InitialState) -> bytes:
    """Return the checksum of a kernel's memory and of the physical state that it belongs to."""
    return hashlib.sha256(memory + initial.physics()).digest()


def state_from(
    initial: InitialState, scene: Scene, experiment: SceneSettings, rng: np.random.Generator
) -> tuple[State, int | None, np.ndarray]:
    """Return the kernel's state at the start of a run, its collisions before cooling, and extents.

    `rng` is the generator of the run's seed. The number of collisions is None unless the run
    continues with the memory of the `initial` state. The layout of the kernel's arrays depends on
    the extents (D,) of the positions, in a. Raises InputError for an invalid memory.
    """
    if is_memory_of(initial, scene):
        state, collisions_before_cooling, extents = _state_from_memory(initial, scene, experiment)
        if initial.noise == RESEED:
            state.random[:] = initial.generator(rng).integers(2**64, dtype=np.uint64)
        return state, collisions_before_cooling, extents
    rng = initial.generator(rng)
    spin, bodies = initial.spin, None
    if spin is None:
        spin = np.zeros((len(initial.position), 2 * len(scene.box) - 3))
    if scene.effects.species is not None:
        bodies = build_bodies(scene, experiment, *initial.bodies())
    state = new_state(scene, initial.position, initial.velocity, spin, rng=rng, bodies=bodies)
    base = math.floor(initial.time)  # an integer, so that it stays exact as it advances
    now = initial.time - base
    state.clock[BASE], state.clock[NOW] = base, now
    state.trajectory[:, -1] = now
    for times in state.particle_times:
        if times is not None:
            times += now
    return state, None, np.ptp(initial.position, axis=0)


def initial_state_of(
    state: State, scene: Scene, collisions_before_cooling: int, extents: np.ndarray
) -> InitialState:
    """Return the present state of a kernel as an initial state of another run, with its memory.

    `collisions_before_cooling` is a number of collisions in the gas; `extents` (D,) in a determine
    the layout of the kernel's arrays.
    """
    unit, time = 2.0 ** int(state.counts[EXPONENT]), time_of(state)
    position, velocity = positions_and_velocities(state, scene, time)
    initial = InitialState(
        position=in_starting_order(state, position),
        velocity=in_starting_order(state, velocity * unit),
        spin=None if state.spin is None else in_starting_order(state, state.spin * unit),
        **_body_quantities(state),
        time=time,
        memory_owner=memory_owner(scene),
    )
    memory = _memory_bytes(state, collisions_before_cooling, extents)
    return initial._replace(memory=memory + _seal(memory, initial))


def _body_quantities(state):
    """Return radii and species (N,) of a mixture's particles by name; else nothing.

    They are in the order of the start.
    """
    if state.bodies is None:
        return {}
    return {name: in_starting_order(state, getattr(state.bodies, name)) for name in BODY_VARIABLES}


def _memory_bytes(state: State, collisions_before_cooling: int, extents: np.ndarray) -> bytes:
    """Return the kernel's memory without its checksum: a header, then all arrays of its state."""
    return np.array([collisions_before_cooling, *extents], float).tobytes() + state_bytes(state)


def _state_from_memory(initial, scene, experiment):
    """Return the kernel's state from its memory, its collisions before cooling, and extents.

    Extents (D,) are in a. Raises InputError for an invalid memory.
    """
    number, dimension = initial.position.shape
    memory, header_bytes = initial.memory[:-SEAL_BYTES], 8 * (1 + dimension)
    collisions_before_cooling, *extents = _read_header(memory[:header_bytes], 1 + dimension)
    position = np.zeros((number, dimension))
    position[0] = extents  # the layout depends only on extents
    spin = np.zeros((number, 2 * dimension - 3))
    bodies = None
    if scene.effects.species is not None:
        bodies = build_bodies(scene, experiment, *initial.bodies())
    state = new_state(scene, position, np.zeros_like(position), spin, bodies=bodies)
    try:
        saved_state = state._replace(paths=None)  # paths are counted from the start of each run
        decode(arrays_from_bytes(memory[header_bytes:], saved_state), saved_state, scene)
    except UnusableCheckpoint as error:
        raise InputError(MEMORY_KEY, f"(one that {error})", "be as a run has left it") from error
    if collisions_before_cooling not in range(int(state.counts[COLLISIONS]) + 1):
        legal = "begin with a number of collisions that the gas has made"
        raise InputError(MEMORY_KEY, collisions_before_cooling, legal)
    begin_paths(state)
    return state, int(collisions_before_cooling), np.array(extents)


def _read_header(content: bytes, length: int) -> list[float]:
    """Return the `length` numbers at the start of a memory: collisions before cooling, and extents.

    Raises InputError for other numbers than a run can have.
    """
    numbers = np.frombuffer(content[: len(content) // 8 * 8]).tolist()
    if len(numbers) != length or not all(0.0 <= number <= LARGEST_IN_HEADER for number in numbers):
        legal = f"begin with {length} numbers from 0 to {LARGEST_IN_HEADER:g}"
        raise InputError(MEMORY_KEY, numbers, legal)
    return numbers
