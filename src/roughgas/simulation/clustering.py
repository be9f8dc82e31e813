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
from roughgas.scene import DIAMETER, build
from roughgas.simulation.energies import restored
from roughgas.simulation.gas import Gas
from roughgas.simulation.recorder import Recorder

SHAPING = (
    "scene/composition.py",
    "scene/initial.py",
    "simulation/clustering.py",
    "simulation/energies.py",
    "simulation/gas.py",
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
    gas = Gas.start(scene, settings, np.random.default_rng(settings["seed"]))
    leg = gas.count(settings["collisions"] / settings["frames"])
    owner = belongs_to(settings)
    film = _resumed(path, owner, gas, watcher)
    if film is None:
        film = _begin(gas, settings)
    gas.cool(refresh_every=leg)
    first, last = sum(map(len, film["time"])), settings["frames"]
    watcher.reached(first - 1, gas.recorder.collisions, False)
    for frame in range(first, last + 1):
        gas.in_collisions(leg, 1)
        _add_frame(film, frame * leg, gas, settings)
        saved = frame % every == 0 and frame < last
        if saved:
            checkpoint.save(path, owner, gas.state, _joined(film) | _costs(gas.recorder))
        watcher.reached(frame, gas.recorder.collisions, saved)
    return _variables(film, gas, settings), _attributes(settings)


def belongs_to(settings: Mapping[str, Any]) -> str:
    """Text that is the same for runs that can go on from each other's checkpoints."""
    digest = hashlib.sha256()
    for name in SHAPING:
        digest.update((PACKAGE / name).read_bytes())
    about = {"settings": settings, "kernel": source_hash(), "sources": digest.hexdigest()}
    return as_text(about | {"numpy": np.__version__})


def _resumed(path, owner, gas, watcher) -> Film | None:
    """Return the film so far, and bring `gas` to its end; None without a checkpoint."""
    try:
        saved = checkpoint.restore(path, owner, gas.state)
    except FileNotFoundError:
        return None
    except checkpoint.UnusableCheckpoint as error:
        watcher.fresh(f"{path} {error}")
        return None
    for name in _costs(gas.recorder):
        setattr(gas.recorder, name, saved.pop(name).item())
    return {name: [array] for name, array in saved.items()}


def _begin(gas, settings) -> Film:
    """Return the frame of a gas in equilibrium as smooth elastic disks."""
    gas.thermalise(settings["thermalise"])
    gas.refresh()
    film: Film = {}
    _add_frame(film, 0, gas, settings)
    return film


def _add_frame(film, collisions, gas, settings) -> None:
    """Add the frame of a gas just refreshed, so many collisions since it began to cool."""
    box = gas.scene.box
    E_trans, E_rot = restored(gas.energies(gas.sample), gas.sample["exponent"])
    x, y = (np.mod(gas.state.trajectory[:, k], box[k]) for k in range(2))
    spin = gas.state.spin[:, 0]
    square = np.mean(spin**2)
    seen = _in_window(x, y, box, settings["window"])
    added = {
        "time": gas.sample["time"],
        "collisions_per_particle": np.array([collisions * 2.0 / gas.particles]),
        "E_trans": E_trans,
        "E_rot": E_rot,
        "count": _count(x, y, box, settings["cell"])[None],
        "disks": np.array([seen.sum()]),
        "disk_x": x[seen].astype(np.float32),
        "disk_y": y[seen].astype(np.float32),
        "disk_spin": (spin[seen] / np.sqrt(square) if square > 0.0 else spin[seen]).astype("f4"),
    }
    for name, values in added.items():
        film.setdefault(name, []).append(values)


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


def _costs(recorder: Recorder) -> dict[str, np.ndarray]:
    """Return what a recorder sums up over its runs."""
    return {
        name: np.array(getattr(recorder, name)) for name in ("seconds", "collisions", "touched")
    }


def _variables(film, gas, settings) -> dict[str, Any]:
    found, recorder = _joined(film), gas.recorder
    start = found["E_trans"][0]
    model = gas.scene.effects.contact_time
    for name, length in zip("xy", gas.scene.box, strict=True):
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
