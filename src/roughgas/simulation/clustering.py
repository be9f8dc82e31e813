"""A cooling gas of many particles, filmed until it forms clusters.

The run is a series of equal legs, each of which ends with a frame. All that one leg hands over to
the next is in the State and in the film so far: this is what a checkpoint holds, and why a run that
goes on from it, or that never wrote one, gives the same bits.
"""

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from roughgas.base.version import __version__
from roughgas.config import as_text
from roughgas.data import checkpoint
from roughgas.kernel.cache import PACKAGE, source_hash
from roughgas.kernel.state import State
from roughgas.scene import DIAMETER, Scene, build
from roughgas.scene.initial import initial_state
from roughgas.simulation.energies import energies, restored
from roughgas.simulation.recorder import Recorder

SHAPING = (
    "scene/composition.py",
    "scene/initial.py",
    "simulation/clustering.py",
    "simulation/energies.py",
    "simulation/recorder.py",
)
"""Sources that shape a film besides those that are compiled."""

Film = dict[str, list[np.ndarray]]
"""By variable, arrays whose first axis is that of the frames, or of the disks in them."""


class Watcher(Protocol):
    """Whom a run tells how far it is."""

    def fresh(self, why: str) -> None:
        """The run begins anew, although there is a checkpoint."""

    def reached(self, frame: int, collisions: int, saved: bool) -> None:
        """So many frames and collisions are over; `saved`: a checkpoint now holds them."""


def run(
    settings: Mapping[str, Any], path: Path, every: int, watcher: Watcher
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Variables and attributes of a film (see roughgas.data.film), as `settings` describe it.

    Every so many frames a checkpoint is written to `path`, from which the same call goes on.
    Raises InputError for illegal values, CollapseError where contacts accumulate without end,
    OSError where the checkpoint cannot be written.
    """
    scene = build(settings, float(settings["r"]), float(settings["beta"]))
    recorder = Recorder()
    state = initial_state(scene, settings, np.random.default_rng(settings["seed"]))
    owner = belongs_to(settings)
    film = _resumed(path, owner, state, recorder, watcher)
    if film is None:
        film = _begin(state, scene, settings, recorder)
    first, last = sum(map(len, film["time"])), settings["frames"]
    watcher.reached(first - 1, recorder.collisions, False)
    for frame in range(first, last + 1):
        rows = recorder.in_collisions(state, scene, _leg(settings), 1, refresh=1)
        _add_frame(film, frame, rows, state, scene, settings)
        saved = frame % every == 0 and frame < last
        if saved:
            checkpoint.save(path, owner, state, _joined(film) | _books(recorder))
        watcher.reached(frame, recorder.collisions, saved)
    return _variables(film, scene, settings, recorder), _attributes(settings)


def belongs_to(settings: Mapping[str, Any]) -> str:
    """Text that is the same for runs that can go on from each other's checkpoints."""
    digest = hashlib.sha256()
    for name in SHAPING:
        digest.update((PACKAGE / name).read_bytes())
    about = {"settings": settings, "kernel": source_hash(), "sources": digest.hexdigest()}
    return as_text(about | {"numpy": np.__version__})


def _resumed(path, owner, state, recorder, watcher) -> Film | None:
    """The film so far, `state` and `recorder` as they were; None where there is none to go on."""
    try:
        saved = checkpoint.restore(path, owner, state)
    except FileNotFoundError:
        return None
    except checkpoint.UnusableCheckpoint as error:
        watcher.fresh(f"{path} {error}")
        return None
    for name in _books(recorder):
        setattr(recorder, name, saved.pop(name).item())
    return {name: [array] for name, array in saved.items()}


def _begin(state, scene, settings, recorder) -> Film:
    """A gas in equilibrium as smooth elastic disks, and its frame."""
    elastic = scene._replace(restitution=1.0, roughness=-1.0)
    thermal = max(1, round(settings["thermalise"] * settings["particles"] / 2))
    rows = recorder.in_collisions(state, elastic, thermal, 1, refresh=1)
    film: Film = {}
    _add_frame(film, 0, rows, state, scene, settings)
    return film


def _leg(settings) -> int:
    """Collisions from one frame to the next; a collision has two partners."""
    return max(1, round(settings["collisions"] * settings["particles"] / 2 / settings["frames"]))


def _add_frame(film, frame, rows, state, scene, settings) -> None:
    number = settings["particles"]
    present = energies(rows, number, scene.effects.spin.inertia)
    E_trans, E_rot = restored(present, rows["exponent"])
    x, y, spin = _particles(state, scene)
    square = np.mean(spin**2)
    seen = _in_window(x, y, scene.box, settings["window"])
    added = {
        "time": rows["time"],
        "collisions_per_particle": np.array([frame * _leg(settings) * 2.0 / number]),
        "E_trans": E_trans,
        "E_rot": E_rot,
        "count": _count(x, y, scene.box, settings["cell"])[None],
        "disks": np.array([seen.sum()]),
        "disk_x": x[seen].astype(np.float32),
        "disk_y": y[seen].astype(np.float32),
        "disk_spin": (spin[seen] / np.sqrt(square) if square > 0.0 else spin[seen]).astype("f4"),
    }
    for name, values in added.items():
        film.setdefault(name, []).append(values)


def _particles(state: State, scene: Scene) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """x, y, folded into the box, and spin of all particles, just refreshed: at one instant."""
    x, y = (np.mod(state.trajectory[:, k], scene.box[k]) for k in range(2))
    return x, y, state.spin[:, 0]


def _in_window(x, y, box, side) -> np.ndarray:
    """Which disks reach into the square of this side in the middle of the box."""
    reach = (side + DIAMETER) / 2
    return (abs(x - box[0] / 2) < reach) & (abs(y - box[1] / 2) < reach)


def cells(length: float, cell: float) -> int:
    """Number of cells, about as long as `cell`, that a box of some length is divided into."""
    return max(1, round(length / cell))


def _count(x, y, box, cell) -> np.ndarray:
    columns, lines = (cells(length, cell) for length in box)
    # rounding can fold a particle onto the far edge
    i = np.minimum((x * (columns / box[0])).astype(int), columns - 1)
    j = np.minimum((y * (lines / box[1])).astype(int), lines - 1)
    found = np.bincount(columns * j + i, minlength=columns * lines)
    return found.reshape(lines, columns).astype(np.uint16)


def _joined(film: Film) -> dict[str, np.ndarray]:
    return {name: np.concatenate(parts) for name, parts in film.items()}


def _books(recorder: Recorder) -> dict[str, np.ndarray]:
    """What a recorder sums up over its runs."""
    return {
        name: np.array(getattr(recorder, name)) for name in ("seconds", "collisions", "touched")
    }


def _variables(film, scene, settings, recorder) -> dict[str, Any]:
    found = _joined(film)
    start = found["E_trans"][0]
    model = scene.effects.contact_time
    for name, length in zip("xy", scene.box, strict=True):
        number = cells(length, settings["cell"])
        found[name] = (np.arange(number) + 0.5) * (length / number)
    return found | {
        "time": found["time"] - found["time"][0],
        "E_trans": found["E_trans"] / start,
        "E_rot": found["E_rot"] / start,
        "R": found["E_rot"] / (found["E_rot"] + found["E_trans"]),
        "E_trans_start": start,
        "contact_time": np.nan if model is None else model.duration,
        "contact_time_fraction": recorder.touched / max(1, recorder.collisions),
        "collisions": recorder.collisions,
        "kernel_seconds": recorder.seconds,
    }


def _attributes(settings) -> dict[str, Any]:
    area = settings["box"][0] * settings["box"][1]
    return {
        "r": float(settings["r"]),
        "beta": float(settings["beta"]),
        "seed": settings["seed"],
        "particles": settings["particles"],
        "inertia": settings["effects"]["spin"]["inertia"],
        "box": [float(length) for length in settings["box"]],
        "window": float(settings["window"]),
        "packing": np.pi * settings["particles"] / area,
        "settings_json": as_text(settings),
        "roughgas_version": __version__,
        "numpy_version": np.__version__,
        "kernel_source_hash": source_hash(),
    }
