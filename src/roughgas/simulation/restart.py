"""The particles at a time, the states from which a run starts again, and checkpoints.

A state is what physics knows: positions, velocities and spins at an instant. From these a run goes
on to rounding, in this version of the kernel or another, also with another r, beta or drive.

Beside it lies the kernel's memory: all arrays of its State as bytes. Contacts were foreseen earlier
with other roundings than if they were foreseen now, and what collisions do is chaotic; with its
memory a run goes on as if it had not stopped, to the last bit. It belongs to one kernel and one
scene, and is not used for others.

A checkpoint is a simulation under way, saved whole and resumed with the same bits: one .npz file
with every array of a State, what the run has recorded so far, and a text that says which run it
belongs to.
"""

import hashlib
import math
import zipfile
import zlib
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from roughgas.base import InputError
from roughgas.base.files import remove_dead_drafts, whole_file
from roughgas.kernel.hooks import displacement
from roughgas.kernel.memory import new_state
from roughgas.kernel.state import BASE, EXPONENT, NOW, State
from roughgas.scene import Scene, given_bodies
from roughgas.simulation.paths import begin_paths, flown, in_order

if TYPE_CHECKING:
    from roughgas.simulation.gas import Gas

OWNER, STATE, RECORD = "belongs to", "state.", "record."
DAMAGE = (OSError, EOFError, KeyError, ValueError, RuntimeError, zipfile.BadZipFile, zlib.error)
"""What zipfile and numpy raise; it depends on where a file is damaged."""


class UnusableCheckpoint(ValueError):
    """A checkpoint that a run cannot resume from; its text says why, as the end of a sentence."""


def save(path: str | Path, owner: str, state: Any, record: Mapping[str, np.ndarray]) -> None:
    """Write `state` and the arrays of `record` to `path`, whole or not at all.

    `owner` says which run this is: only the same one may resume from here. Raises OSError.
    """
    content = {STATE + name: array for name, array in arrays_of(state)}
    write(path, owner, content | {RECORD + name: array for name, array in record.items()})


def write(path: str | Path, owner: str, content: Mapping[str, np.ndarray]) -> None:
    """Write arrays by name, and whose they are, whole or not at all. Raises OSError."""
    arrays: dict[str, Any] = {OWNER: np.array(owner), **content}
    with whole_file(path) as draft, open(draft, "wb") as file:
        np.savez(file, **arrays)


def restore(path: str | Path, owner: str, state: Any) -> dict[str, np.ndarray]:
    """Fill `state`, a fresh one of the same scene and size, from `path`, and return the record.

    Values are copied into the existing arrays, so that those that share memory still do. Raises
    FileNotFoundError if there is no checkpoint, and UnusableCheckpoint if it is damaged or belongs
    to another run; `state` is then as it was.
    """
    content = read(path, owner)
    here = dict(arrays_of(state))
    saved = {name: content.get(STATE + name, np.empty(())) for name in here}
    if any(saved[name].shape != here[name].shape for name in here):
        raise UnusableCheckpoint("holds another kind of state")
    for name, array in here.items():
        array[...] = saved[name]
    return {
        name.removeprefix(RECORD): array
        for name, array in content.items()
        if name.startswith(RECORD)
    }


def discard(path: str | Path) -> None:
    """Remove a checkpoint that is no longer needed, and what killed writers of it have left."""
    Path(path).unlink(missing_ok=True)
    remove_dead_drafts(Path(path))


def arrays_of(state: Any, prefix: str = "") -> Iterator[tuple[str, np.ndarray]]:
    """Yield (dotted name, array) for every array in nested NamedTuples.

    None and plain tuples are left out: the latter hold what follows from the scene.
    """
    for name, part in zip(state._fields, state, strict=True):
        if isinstance(part, np.ndarray):
            yield prefix + name, part
        elif hasattr(part, "_fields"):
            yield from arrays_of(part, f"{prefix}{name}.")


def read(path: str | Path, owner: str) -> dict[str, np.ndarray]:
    """Return the arrays by name, after verifying their checksums.

    Raises FileNotFoundError, and UnusableCheckpoint if the file is damaged or is another's.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            if archive.testzip() is not None:
                raise UnusableCheckpoint("is damaged")
        with np.load(path, allow_pickle=False) as archive:
            content = {name: archive[name] for name in archive.files}
    except FileNotFoundError:
        raise
    except DAMAGE as error:
        raise UnusableCheckpoint("is damaged") from error
    if content.pop(OWNER, None) != owner:
        raise UnusableCheckpoint("belongs to other settings or to other sources")
    return content


def positions_and_velocities(
    state: State, scene: Scene, time: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return positions in a, folded into the box, and velocities now, (N, D) each.

    `time` is the present in T. Velocities are those of the images in the box, in the kernel's unit:
    2^exponent a/T. The order is that of the state's arrays.
    """
    shear = scene.effects.shear
    position, velocity = flown(state, scene)
    if shear is not None:
        images = np.floor(position[:, 1] / scene.box[1])
        position[:, 0] -= displacement(shear, time) * images
        velocity[:, 0] -= shear.velocity * images
    for axis, length in enumerate(scene.box):
        if length is not None:
            position[:, axis] %= length
    return position, velocity


OF_BODIES = {"radius": "radius", "species": "species_of"}
"""What an Initial has of each particle that differs, and what variables call it."""
OF_SETTINGS = ("mass", "inertia")
"""Quantities of a particle in a dataset that a run takes from its settings."""
SEAL = 32  # bytes at the end of a memory, a checksum
CARRIED, SEED, RESEED = "", "seed", "reseed"
"""Source of the noise of a run that begins in a state: the seed of the run before, or an option."""


class Initial(NamedTuple):
    """A state from which a run begins."""

    position: np.ndarray  # (N, D) in a
    velocity: np.ndarray  # (N, D) in a/T, of the images in the box
    spin: np.ndarray | None = None  # (N, 2 D - 3) in a/T; None: no particle spins
    radius: np.ndarray | None = None  # (N,) in a; None: all are alike
    species: np.ndarray | None = None  # (N,) from 0
    time: float = 0.0  # T: the phase of what drives the gas
    memory: bytes = b""  # of the kernel
    owner: str = ""  # whose memory it is
    names: tuple[str, ...] = ()  # of the species; empty: they are numbered as in the experiment
    of_settings: Mapping[str, np.ndarray] = {}  # (N,) each, to be checked: OF_SETTINGS
    seed: Any = 1  # of the run that ended in it, as its dataset has it
    noise: str = CARRIED  # or SEED, or RESEED

    def digest(self) -> str:
        """Return a checksum of all that shapes what comes of it."""
        content = self.physics() + self.memory + self.owner.encode()
        return hashlib.sha256(content).hexdigest()[:16]

    def bodies(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the radii and the species of the particles, where they differ."""
        assert self.radius is not None and self.species is not None
        return self.radius, self.species.astype(int)

    def physics(self) -> bytes:
        """Return all of it but the kernel's memory."""
        parts = [np.asarray(one, float).tobytes() for one in self[:5] if one is not None]
        return b"".join(parts) + repr(float(self.time)).encode()

    def generator(self, rng: np.random.Generator) -> np.random.Generator:
        """Return the generator of a run from this state; `rng` is the generator of its seed.

        Another state has other random numbers with the same seed, so that a loop which changes
        states between runs does not repeat its noise. The numbers of species do not matter.
        """
        content = self._replace(species=None).physics()
        state = int.from_bytes(hashlib.sha256(content).digest()[:16], "little")
        return np.random.default_rng([int(rng.integers(2**63)), state])


def owner(scene: Scene) -> str:
    """Return a text that is the same for all runs that understand each other's memory."""
    from roughgas.compiling.compiler import IMPORTED

    scene = scene._replace(effects=scene.effects._replace(paths=None))  # passive, not remembered
    about = repr((IMPORTED, np.__version__, scene))
    return hashlib.sha256(about.encode()).hexdigest()[:16]


def is_memory_of(initial: Initial, scene: Scene) -> bool:
    """Return whether a run of the scene goes on from a state to the last bit.

    Neither the memory nor the state beside it may have been changed since: the kernel takes what
    it remembers for granted.
    """
    seal = _seal(initial.memory[:-SEAL], initial)
    return initial.memory[-SEAL:] == seal and initial.owner == owner(scene)


def _seal(memory: bytes, initial: Initial) -> bytes:
    return hashlib.sha256(memory + initial.physics()).digest()


def state_from(
    initial: Initial, scene: Scene, experiment: Mapping[str, Any], rng: np.random.Generator
) -> tuple[State, int | None, np.ndarray]:
    """Return the state in which a run begins, and the extents (D,) that it is laid out for; between
    them, where it goes on with its memory, the collisions when it began to cool."""
    if is_memory_of(initial, scene):
        state, begun, extents = _remembered(initial, scene, experiment)
        if initial.noise == RESEED:
            state.random[:] = initial.generator(rng).integers(2**64, dtype=np.uint64)
        return state, begun, extents
    rng = initial.generator(rng)
    spin, bodies = initial.spin, None
    if spin is None:
        spin = np.zeros((len(initial.position), 2 * len(scene.box) - 3))
    if scene.effects.species is not None:
        bodies = given_bodies(scene, experiment, *initial.bodies())
    state = new_state(scene, initial.position, initial.velocity, spin, rng=rng, bodies=bodies)
    base = math.floor(initial.time)  # whole, so that it stays exact as it moves on
    now = initial.time - base
    state.clock[BASE], state.clock[NOW] = base, now
    state.trajectory[:, -1] = now
    for times in state.moments:
        if times is not None:
            times += now
    return state, None, np.ptp(initial.position, axis=0)


def final_states(gases: "Iterable[Gas]") -> dict[str, Any]:
    """Return variables of a point (see roughgas.data.point): the states that its runs end in."""
    states = [_last(gas) for gas in gases]
    found = {
        "last_time": [one.time for one in states],
        "last_position": [one.position for one in states],
        "last_velocity": [one.velocity for one in states],
        "last_memory": [np.frombuffer(one.memory, np.uint8) for one in states],
    }
    if states[0].spin is not None:
        found["last_spin"] = [one.spin for one in states]
    for name, variable in OF_BODIES.items() if states[0].species is not None else ():
        found[f"last_{variable}"] = [getattr(one, name) for one in states]
    return {name: np.array(values) for name, values in found.items()}


def _last(gas: "Gas") -> Initial:
    state, scene = gas.state, gas.scene
    unit = 2.0 ** int(state.counts[EXPONENT])
    position, velocity = positions_and_velocities(state, scene, gas.time)
    found = Initial(
        position=in_order(state, position),
        velocity=in_order(state, velocity * unit),
        spin=None if state.spin is None else in_order(state, state.spin * unit),
        **_bodies_of(state),
        time=gas.time,
        owner=owner(scene),
    )
    memory = _memory(gas)
    return found._replace(memory=memory + _seal(memory, found))


def _bodies_of(state):
    if state.bodies is None:
        return {}
    return {name: in_order(state, getattr(state.bodies, name)) for name in OF_BODIES}


def _memory(gas: "Gas") -> bytes:
    header = np.array([gas.begun, *gas.extents], float)
    arrays = (array for _, array in _remembered_arrays(gas.state))
    return b"".join(array.tobytes() for array in [header, *arrays])


def _remembered_arrays(state: State) -> Iterator[tuple[str, np.ndarray]]:
    """Yield (dotted name, array) of a memory: the paths that a run counts begin with the run."""
    return arrays_of(state._replace(paths=None))


def _remembered(initial, scene, experiment):
    number, dimension = initial.position.shape
    memory = np.frombuffer(initial.memory[:-SEAL], np.uint8)
    place = 8 * (1 + dimension)
    begun, *extents = memory[:place].view(float)
    position = np.zeros((number, dimension))
    position[0] = extents  # all that the layout asks of positions
    spin = np.zeros((number, 2 * dimension - 3))
    bodies = None
    if scene.effects.species is not None:
        bodies = given_bodies(scene, experiment, *initial.bodies())
    state = new_state(scene, position, np.zeros_like(position), spin, bodies=bodies)
    for _, array in _remembered_arrays(state):
        if place + array.nbytes <= len(memory):
            part = memory[place : place + array.nbytes].copy()
            array[...] = part.view(array.dtype).reshape(array.shape)
        place += array.nbytes
    if place != len(memory):
        raise InputError("initial.last_memory", f"{len(memory)} bytes", f"be {place} bytes long")
    begin_paths(state)
    return state, int(begun), np.array(extents)
