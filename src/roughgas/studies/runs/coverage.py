"""Points of the study of coverage, each repeated many times and measured a few times for longer."""

import zlib
from collections.abc import Callable

import numpy as np
import xarray as xr

from roughgas.scene import build
from roughgas.simulation import schedule
from roughgas.simulation.point import run_point
from roughgas.studies.tasks import corner_name
from roughgas.tasks import stream, timed

MEASURED = ("R", "R_stderr", "R_dof", "equilibrated", "autocorrelation_time", "measured_from")


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return what each repetition at a corner states, and each run of its reference (`truth_...`).

    A run of the reference goes by the experiment's own schedule, but is longer.
    """
    corner = next(one for one in settings["corners"] if corner_name(one) == task)
    experiment, reference = experiments[corner["experiment"]], settings["reference"]
    short, length = experiment["schedule"] | corner["schedule"], schedule.of(experiment).LENGTH
    long = experiment["schedule"] | {length: reference["length"] * short[length]}
    work = [short] * settings["repetitions"] + [long] * reference["seeds"]
    drawn = stream(settings, zlib.crc32(task.encode())).generate_state(len(work), "u8") >> 1
    _point(experiment, short, corner, 0)  # compiles
    rows, seconds = [], 0.0
    for one, seed in zip(work, drawn.tolist(), strict=True):
        row, passed = timed(_point, experiment, one, corner, seed)
        rows.append(row)
        seconds += passed
        progress(len(rows), len(work))
    parts = np.split(np.array(rows, float), [settings["repetitions"]])
    found = {"cpu_seconds": seconds, "window": short[length] * short.get("replicas", 1)}
    for prefix, dim, part in zip(("", "truth_"), ("run", "long_run"), parts, strict=True):
        found |= {prefix + name: (dim, x) for name, x in zip(MEASURED, part.T, strict=True)}
    return xr.Dataset(found)


def _point(experiment, own_schedule, corner, seed) -> list[float]:
    settings = experiment | {"schedule": own_schedule}
    scene = build(settings, float(corner["r"]), float(corner["beta"]))
    measured = run_point(scene, settings, seed).variables
    return [measured[name] for name in MEASURED]
