"""How often the intervals that datasets state hold the truth.

At each corner (experiment, r, beta) a short point is repeated many times through the protocol that
every point goes through, each time with another seed. The truth is the mean of a few long runs with
the experiment's own equilibration and other seeds. An interval at 95 % should hold it in 95 of 100
repetitions: that of one run, and that of several seeds pooled.
"""

import time
import zlib
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.studies.accuracy.calibration import Runs, calibrate

if TYPE_CHECKING:
    import xarray

LEVELS = (0.68, 0.95)
WAYS = ("one run", "pooled seeds")
CORNER, WAY, LEVEL = "corner", "way", "level"
MEASURED = ("R", "R_stderr", "R_dof", "equilibrated", "autocorrelation_time", "measured_from")
LENGTH = {"steady": "measure", "cooling": "plateau"}
"""Which key of a schedule says how long R is measured."""


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """The corners by name, in the order of the settings: put long ones first."""
    return [_name(corner) for corner in settings["corners"]]


def run(
    task: str,
    settings: Mapping[str, Any],
    experiments: Mapping[str, Mapping[str, Any]],
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> "xarray.Dataset":
    """One corner: what each repetition states, and what each run of its reference (`truth_...`).

    Raises InputError for settings that are illegal, CollapseError as a simulation does.
    """
    import xarray

    corner = next(one for one in settings["corners"] if _name(one) == task)
    stream = np.random.SeedSequence(settings["seed"], spawn_key=(zlib.crc32(task.encode()),))
    seeds = stream.generate_state(settings["repetitions"] + settings["reference"]["seeds"], "u8")
    seeds = (seeds >> 1).tolist()
    experiment = experiments[corner["experiment"]]
    short, long = _schedules(experiment["schedule"], corner["schedule"], settings["reference"])
    work = [short] * settings["repetitions"] + [long] * settings["reference"]["seeds"]
    _point(experiment, short, corner, 0)  # compiles
    begin = time.process_time()
    rows = []
    for schedule, seed in zip(work, seeds, strict=True):
        rows.append(_point(experiment, schedule, corner, seed))
        progress(len(rows), len(work))
    seconds = time.process_time() - begin
    parts = np.split(np.array(rows, float), [settings["repetitions"]])
    variables = {
        prefix + name: (dimension, values)
        for prefix, dimension, part in zip(("", "truth_"), ("run", "long_run"), parts, strict=True)
        for name, values in zip(MEASURED, part.T, strict=True)
    }
    window = short[LENGTH[short["kind"]]] * short.get("replicas", 1)
    return xarray.Dataset(variables | {"cpu_seconds": ((), seconds), "window": ((), window)})


def combine(parts: Mapping[str, "xarray.Dataset"], settings: Mapping[str, Any]) -> "xarray.Dataset":
    """Coverage, bias and the size of the stated errors at every corner (dimensions as named here).

    `parts` holds the result of every job of `tasks`.
    """
    import xarray

    rows = [_summary(parts[name], settings) for name in tasks(settings)]
    variables = {
        name: ((CORNER, *dims), np.array([row[name] for row in rows]), _attributes(about, units))
        for name, (dims, about, units) in ABOUT.items()
    }
    coordinates = {CORNER: tasks(settings), WAY: list(WAYS), LEVEL: list(LEVELS)}
    attributes = {"seed": settings["seed"], "unit_of_length": UNIT}
    dataset = xarray.Dataset(variables, coordinates, attributes)
    for name, about in AXES.items():
        dataset[name].attrs["long_name"] = about
    for key, about in NAMED.items():
        labels = [corner[key] for corner in settings["corners"]]
        dataset[key] = (CORNER, labels, _attributes(about, ""))
    return dataset


NAMED = {
    "experiment": "experiment",
    "r": "normal restitution, as written in the settings",
    "beta": "tangential restitution, as written in the settings",
}
AXES = {
    CORNER: "experiment, r and beta",
    WAY: "how the interval is found",
    LEVEL: "share of the intervals that should hold the truth",
}
UNIT = "T; in a cooling gas a collision per particle"
ABOUT = {
    "coverage": ((WAY, LEVEL), "share of the intervals that hold the truth", "1"),
    "coverage_stderr": ((WAY, LEVEL), "standard error of the coverage", "1"),
    "bias": ((), "mean of R minus the truth, in standard deviations of a run's R", "1"),
    "bias_stderr": ((), "standard error of the bias, in the same", "1"),
    "stated_over_true": ((), "root mean square of R_stderr over the scatter of R", "1"),
    "stated_over_true_stderr": ((), "its standard error", "1"),
    "truth": ((), "R of the reference", "1"),
    "truth_stderr": ((), "standard error of R of the reference", "1"),
    "scatter": ((), "standard deviation of R over the repetitions", "1"),
    "dof": ((), "degrees of freedom that a run's error is known with, median", "1"),
    "repetitions": ((), "number of repetitions", "1"),
    "equilibrated": ((), "share of the repetitions found in a steady state", "1"),
    "autocorrelation_time": ((), "integrated autocorrelation time of R", "length"),
    "window": ((), "length of a run's measurement, of all replicas together", "length"),
    "cpu_seconds": ((), "CPU time of all of the simulations", "s"),
}


def _attributes(about, units):
    return {"long_name": about, "units": units}


def _name(corner: Mapping[str, Any]) -> str:
    return f"{corner['experiment']}_r{corner['r']}_beta{corner['beta']}"


def _schedules(usual, changes, reference):
    """The schedule of a repetition, and that of a run of the reference: as usual, but longer."""
    short, length = usual | changes, LENGTH[usual["kind"]]
    return short, usual | {length: reference["length"] * short[length]}


def _point(experiment, schedule, corner, seed) -> list[float]:
    from roughgas.scene import build
    from roughgas.simulation.point import run_point

    settings = {**experiment, "schedule": schedule}
    scene = build(settings, float(corner["r"]), float(corner["beta"]))
    measured = run_point(scene, settings, seed).variables
    return [measured[name] for name in MEASURED]


def _summary(part, settings) -> dict[str, Any]:
    """Every variable of one corner by name."""
    from roughgas.statistics.intervals import pooled

    long = [part[f"truth_{name}"].values for name in ("R", "R_stderr", "R_dof")]
    truth, truth_stderr = float(long[0].mean()), pooled(*long).stderr
    runs = Runs(*(part[name].values for name in ("R", "R_stderr", "R_dof")))
    rng = np.random.default_rng(np.random.SeedSequence(settings["seed"], spawn_key=(0,)))
    return calibrate(runs, truth, truth_stderr, LEVELS, settings["pooled"], rng) | {
        "truth": truth,
        "truth_stderr": truth_stderr,
        "dof": float(np.median(runs.dof)),
        "repetitions": len(runs.R),
        "equilibrated": float(part.equilibrated.mean()),
        "autocorrelation_time": float(part.truth_autocorrelation_time.mean()),
        "window": float(part.window),
        "cpu_seconds": float(part.cpu_seconds),
    }
