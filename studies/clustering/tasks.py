"""A cooling gas of many particles, filmed until it forms clusters.

The run is a series of equal legs; a frame is taken after each. The state between two legs is the
gas and all frames to date. A checkpoint holds both, so that a resumed run gives the same bits as an
uninterrupted one.
"""

import sys
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from roughgas.gas import DIAMETER, Gas, SceneSettings, UnusableCheckpoint, build, restored
from roughgas.theory import packing_fraction

CHECKPOINT_INTERVAL = 10
"""Frames between two checkpoints."""
DIMS = {"count": ("frame", "y", "x"), "x": ("x",), "y": ("y",)}
DIMS |= dict.fromkeys(("disk_x", "disk_y", "disk_spin"), ("disk",))
FRAME_VARIABLES = ("time", "collisions_per_particle", "E_trans", "E_rot", "R", "disks")
DIMS |= dict.fromkeys(FRAME_VARIABLES, ("frame",))

Film = dict[str, list[np.ndarray]]
"""Arrays by variable; their first axis runs over the frames, or over the disks in them."""


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """Return the name of the only task."""
    return ["film"]


def run(
    task: str,
    settings: Mapping[str, Any],
    experiments: Mapping[str, SceneSettings],
    progress: Callable[[int, int], None],
    checkpoint: tuple,
) -> xr.Dataset:
    """Return the film: energies, maps of the particles, and single disks in the window.

    Raises InputError for illegal values, CollapseError if contacts accumulate without end, OSError
    if the checkpoint cannot be written.
    """
    experiment = experiments["gas"]
    scene = build(experiment, float(settings["r"]), float(settings["beta"]))
    gas = Gas.start(scene, experiment, np.random.default_rng(settings["seed"]))
    leg = gas.count(settings["collisions"] / settings["frames"])
    film = _film_so_far(gas, checkpoint)
    if not film:
        gas.thermalise(settings["thermalise"])
        gas.refresh()
        _add_frame(film, 0, gas, settings)
    gas.cool(refresh_every=leg)
    first, last = len(np.concatenate(film["time"])), settings["frames"]
    for frame in range(first, last + 1):
        gas.in_collisions(leg, 1)
        _add_frame(film, frame * leg, gas, settings)
        if frame % CHECKPOINT_INTERVAL == 0 and frame < last:
            gas.save(*checkpoint, _joined(film))
        progress(frame, last)
    values = _variables(film, gas, settings)
    columns = {name: (DIMS.get(name, ()), column) for name, column in values.items()}
    return xr.Dataset(columns, attrs=_attributes(settings, experiment))


def _film_so_far(gas: Gas, checkpoint: tuple) -> Film:
    """Return the film of an interrupted run, and restore `gas` at its end; {} without a
    checkpoint."""
    try:
        saved = gas.restore(*checkpoint)
    except FileNotFoundError:
        return {}
    except UnusableCheckpoint as error:
        print(f"{checkpoint[0]} {error}: starting afresh", file=sys.stderr)
        return {}
    print(f"going on from {checkpoint[0]}", file=sys.stderr)
    return {name: [array] for name, array in saved.items()}


def _joined(film: Film) -> dict[str, np.ndarray]:
    return {name: np.concatenate(arrays) for name, arrays in film.items()}


def _add_frame(film: Film, collisions: int, gas: Gas, settings: Mapping[str, Any]) -> None:
    """Add the frame of a gas just refreshed, `collisions` after the start of its cooling."""
    box = gas.scene.box
    E_trans, E_rot = restored(gas.energies(gas.sample), gas.sample["exponent"])
    x, y = gas.positions_and_velocities()[0].T
    spin = gas.spins()[:, 0]
    scale = np.sqrt(np.mean(spin**2)) or 1.0
    reach = (settings["window"] + DIAMETER) / 2
    visible = (abs(x - box[0] / 2) < reach) & (abs(y - box[1] / 2) < reach)
    frame_values = {
        "time": gas.sample["time"],
        "collisions_per_particle": np.array([collisions * 2.0 / gas.particles]),
        "E_trans": E_trans,
        "E_rot": E_rot,
        "count": count(x, y, box, settings["cell"])[None],
        "disks": np.array([visible.sum()], np.int32),
        "disk_x": x[visible].astype(np.float32),
        "disk_y": y[visible].astype(np.float32),
        "disk_spin": (spin[visible] / scale).astype(np.float32),
    }
    for name, values in frame_values.items():
        film.setdefault(name, []).append(values)


def _cells(length: float, cell: float) -> int:
    """Return the number of cells of about the length `cell` that divide a side of the box."""
    return max(1, round(length / cell))


def count(x: np.ndarray, y: np.ndarray, box: tuple, cell: float) -> np.ndarray:
    """Return the number of particles in each cell, (lines, columns)."""
    columns, lines = (_cells(length, cell) for length in box)
    # rounding can fold a particle onto the far edge
    i = np.minimum((x * (columns / box[0])).astype(int), columns - 1)
    j = np.minimum((y * (lines / box[1])).astype(int), lines - 1)
    counts = np.bincount(columns * j + i, minlength=columns * lines)
    return counts.reshape(lines, columns).astype(np.uint16)


def _variables(film: Film, gas: Gas, settings: Mapping[str, Any]) -> dict[str, Any]:
    values, costs, model = _joined(film), gas.costs, gas.scene.effects.contact_time
    start = values["E_trans"][0]
    for name, length in zip("xy", gas.scene.box, strict=True):
        number = _cells(length, settings["cell"])
        values[name] = (np.arange(number) + 0.5) * (length / number)
    return values | {
        "time": values["time"] - values["time"][0],
        "E_trans": values["E_trans"] / start,
        "E_rot": values["E_rot"] / start,
        "R": values["E_rot"] / (values["E_rot"] + values["E_trans"]),
        "E_trans_start": start,
        "contact_time": np.nan if model is None else model.duration,
        "contact_time_fraction": costs.touched / max(1, costs.collisions),
        "collisions": costs.collisions,
        "kernel_seconds": costs.seconds,
    }


def _attributes(settings: Mapping[str, Any], experiment: SceneSettings) -> dict[str, Any]:
    number, box = experiment.particles, list(experiment.box)
    attributes = {
        "r": float(settings["r"]),
        "beta": float(settings["beta"]),
        "seed": settings["seed"],
    }
    attributes |= {"particles": number, "inertia": experiment.effects["spin"].inertia, "box": box}
    attributes["window"] = float(settings["window"])
    return attributes | {"packing": packing_fraction(number, box)}
