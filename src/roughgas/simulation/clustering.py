"""A cooling gas of many particles, filmed until it forms clusters.

The run is a series of equal legs, each of which ends with a frame. All that one leg hands over to
the next is in the State and in the film so far. A checkpoint holds these, so a run that goes on
from one gives the same bits as a run that never wrote any.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from roughgas.base import __version__
from roughgas.base.files import code_of
from roughgas.base.formatting import as_text
from roughgas.data import checkpoint
from roughgas.kernel.compiler import source_hash
from roughgas.scene import DIAMETER, build
from roughgas.simulation.energies import restored
from roughgas.simulation.gas import Gas
from roughgas.simulation.progress import FilmProgress
from roughgas.theory import packing_fraction

COSTS = ("seconds", "collisions", "touched")  # what a Recorder sums up

Film = dict[str, list[np.ndarray]]
"""By variable, arrays whose first axis is that of the frames, or of the disks in them."""


def run(
    settings: Mapping[str, Any], path: Path, every: int, progress: FilmProgress
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return variables and attributes of a film (see roughgas.data.film) with these settings.

    Every so many frames a checkpoint is written to `path`, from which the same call goes on.
    Raises InputError for illegal values, CollapseError if contacts accumulate without end, OSError
    if the checkpoint cannot be written.
    """
    scene = build(settings, float(settings["r"]), float(settings["beta"]))
    gas = Gas.start(scene, settings, np.random.default_rng(settings["seed"]))
    leg = gas.count(settings["collisions"] / settings["frames"])
    owner = belongs_to(settings)
    film = _just_restarted(path, owner, gas, progress)
    if not film:
        gas.thermalise(settings["thermalise"])
        gas.refresh()
        _add_frame(film, 0, gas, settings)
    gas.cool(refresh_every=leg)
    first, last = len(np.concatenate(film["time"])), settings["frames"]
    progress.reached(first - 1, gas.recorder.collisions, False)
    for frame in range(first, last + 1):
        gas.in_collisions(leg, 1)
        _add_frame(film, frame * leg, gas, settings)
        saved = frame % every == 0 and frame < last
        if saved:
            costs = {name: np.array(getattr(gas.recorder, name)) for name in COSTS}
            checkpoint.save(path, owner, gas.state, _joined(film) | costs)
        progress.reached(frame, gas.recorder.collisions, saved)
    return _variables(film, gas, settings), _attributes(settings)


def belongs_to(settings: Mapping[str, Any]) -> str:
    """Return a text shared by all runs that can go on from each other's checkpoints."""
    about = {"kernel": source_hash(), "sources": code_of("simulation.clustering")}
    return as_text({"settings": settings, "numpy": np.__version__} | about)


def _just_restarted(path, owner, gas, progress) -> Film:
    """Return the film so far, and bring `gas` to its end; an empty one without a checkpoint."""
    try:
        saved = checkpoint.restore(path, owner, gas.state)
    except FileNotFoundError:
        return {}
    except checkpoint.UnusableCheckpoint as error:
        progress.fresh(f"{path} {error}")
        return {}
    for name in COSTS:
        setattr(gas.recorder, name, saved.pop(name).item())
    return {name: [array] for name, array in saved.items()}


def _joined(film: Film) -> dict[str, np.ndarray]:
    return {name: np.concatenate(parts) for name, parts in film.items()}


def _add_frame(film, collisions, gas, settings) -> None:
    """Add the frame of a gas just refreshed, so many collisions since it began to cool."""
    box = gas.scene.box
    E_trans, E_rot = restored(gas.energies(gas.sample), gas.sample["exponent"])
    x, y = (np.mod(gas.state.trajectory[:, k], box[k]) for k in range(2))
    spin = gas.state.spin[:, 0]
    scale = np.sqrt(np.mean(spin**2)) or 1.0
    reach = (settings["window"] + DIAMETER) / 2
    seen = (abs(x - box[0] / 2) < reach) & (abs(y - box[1] / 2) < reach)
    added = {
        "time": gas.sample["time"],
        "collisions_per_particle": np.array([collisions * 2.0 / gas.particles]),
        "E_trans": E_trans,
        "E_rot": E_rot,
        "count": _count(x, y, box, settings["cell"])[None],
        "disks": np.array([seen.sum()]),
        "disk_x": x[seen].astype(np.float32),
        "disk_y": y[seen].astype(np.float32),
        "disk_spin": (spin[seen] / scale).astype(np.float32),
    }
    for name, values in added.items():
        film.setdefault(name, []).append(values)


def _cells(length: float, cell: float) -> int:
    """Return the number of cells, each about as long as `cell`, that divide a side of the box."""
    return max(1, round(length / cell))


def _count(x, y, box, cell) -> np.ndarray:
    """Return the number of particles in each cell, (lines, columns)."""
    columns, lines = (_cells(length, cell) for length in box)
    # rounding can fold a particle onto the far edge
    i = np.minimum((x * (columns / box[0])).astype(int), columns - 1)
    j = np.minimum((y * (lines / box[1])).astype(int), lines - 1)
    found = np.bincount(columns * j + i, minlength=columns * lines)
    return found.reshape(lines, columns).astype(np.uint16)


def _variables(film, gas, settings) -> dict[str, Any]:
    found, recorder, model = _joined(film), gas.recorder, gas.scene.effects.contact_time
    start = found["E_trans"][0]
    for name, length in zip("xy", gas.scene.box, strict=True):
        number = _cells(length, settings["cell"])
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
    return {
        "r": float(settings["r"]),
        "beta": float(settings["beta"]),
        "seed": settings["seed"],
        "particles": settings["particles"],
        "inertia": settings["effects"]["spin"]["inertia"],
        "box": [float(length) for length in settings["box"]],
        "window": float(settings["window"]),
        "packing": packing_fraction(settings["particles"], settings["box"]),
        "settings_json": as_text(settings),
        "roughgas_version": __version__,
        "numpy_version": np.__version__,
        "kernel_source_hash": source_hash(),
    }
